// The turned body of a milled gear, as far as the way from its operations to a verdict asks for it.
#pragma once

#include <functional>

#include "cam/proof/rapid_clearance.h"
#include "geometry/base/vec.h"
#include "postproc/joints/program.h"

namespace toothpath::milled {

struct GearBody {
  int teeth = 0;
  double outer_radius_mm = 0;                 ///< of the finished teeth
  double blank_top_mm = 0;                    ///< highest place of the uncut blank, out of the body
  joints::ClearanceBody links;                ///< the blank as a cylinder about the gear axis: links keep clear of it
  proof::RapidObstacle rapids;                ///< the blank: what rapids keep clear of
  std::function<bool(const Vec3&)> in_blank;  ///< does the uncut blank hold this place?
};

}  // namespace toothpath::milled
