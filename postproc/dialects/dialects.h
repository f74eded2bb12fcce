// The list of dialects: a new one adds its two lines here.
#pragma once

#include "postproc/nc_dialect.h"

namespace toothpath {

[[nodiscard]] NcDialect siemens_dialect();
[[nodiscard]] NcDialect heidenhain_dialect();
[[nodiscard]] NcDialect apt_dialect();
[[nodiscard]] NcDialect mitsubishi_m80_dialect();

inline constexpr NcDialect (*kDialects[])() = {linuxcnc_dialect, fanuc_dialect, siemens_dialect, heidenhain_dialect, apt_dialect,
                                               mitsubishi_m80_dialect};

}  // namespace toothpath
