// The turned body of a milled gear, as links and rapids see it.
#pragma once

#include <optional>

#include "cam/proof/rapid_clearance.h"
#include "postproc/joints/program.h"

namespace toothpath::milled {

struct GearBody {
  joints::ClearanceBody links;       ///< the blank as a cylinder about the gear axis, as wide as the finished teeth
  proof::RapidObstacle rapids;       ///< the blank: what rapids keep clear of
  std::optional<double> web_z = {};  ///< gear frame, mm: beside the teeth a web stands up to here; no tool comes lower
};

}  // namespace toothpath::milled
