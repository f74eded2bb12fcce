// How far the side of a mill stands off the flank where its records put it: looked at more densely than it was planned.
#pragma once

#include "cam/line/plan.h"

namespace toothpath::line {

/// Largest gap over the strips, at all records of all passes and 64 heights each, mm: the bias that the poses keep is
/// in it. `plan` of the same gear and tool.
[[nodiscard]] double largest_gap(const face_gear::FaceGear& gear, const tool::Profile& tool, const LinePlan& plan);

}  // namespace toothpath::line
