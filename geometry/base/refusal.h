// A refused number: which key it was written under, so that whoever read it can add file, line and column.
#pragma once

#include <string>

#include "geometry/base/diagnostic.h"

namespace toothpath {

struct Refusal {
  std::string key;  ///< as in the job file, within what was asked to be made: "module" and "zone[0].inner_radius" of a
                    ///< gear, "stick_out" of a tool, "modification[0].length" of a flank
  Diagnostic diagnostic;
};

}  // namespace toothpath
