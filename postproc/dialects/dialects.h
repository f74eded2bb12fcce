// The list of dialects: a new one adds its line here.
#pragma once

#include "postproc/nc_dialect.h"

namespace toothpath {

inline constexpr NcDialect (*kDialects[])() = {linuxcnc_dialect, fanuc_dialect};

}  // namespace toothpath
