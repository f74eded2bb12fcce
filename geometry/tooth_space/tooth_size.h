// The measures of a tooth that a drawing states and a shop takes: thickness by a caliper, a ball in the space; from the
// exact flanks of any gear.
#pragma once

#include <optional>

#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// A place of a flank with its parameters.
struct FlankPlace {
  double u = 0, v = 0;
  PatchPoint at;
};
/// The place of the flank of a side at s and at h of the chart, between its fillet and the tip surface; nothing where
/// the flank does not reach that height.
[[nodiscard]] std::optional<FlankPlace> flank_at(const ToothSpace& space, int side, double s, double h);

/// Tooth 1, which stands between the minus flank of space 0 and the plus flank of space 1. mm
struct ToothThickness {
  double arc_mm = 0;  ///< on the circle of s and h about the axis: transverse
  double chord_mm =
      0;  ///< shortest chord between both flanks at that height, as far before s as behind it: normal to the tooth
  double height_mm = 0;  ///< from the middle of that chord up to the tip surface, along h
};
/// At s and h; nothing where a flank does not reach that height.
[[nodiscard]] std::optional<ToothThickness> tooth_thickness(const ToothSpace& space, double s, double h);

/// A ball that touches both flanks of space 0, its centre at s. Gear frame, mm.
struct BallInSpace {
  double diameter_mm = 0;
  Vec3 centre = Vec3::Zero();
  double touch_h[2] = {0, 0};  ///< h of the chart at which it touches the plus and the minus flank
};
/// Nothing where a ball of this diameter does not touch both flanks between their fillets and the tip surface.
/// |distance of the centre from each flank - radius| <= 1e-11 of the diameter.
[[nodiscard]] std::optional<BallInSpace> ball_in_space(const ToothSpace& space, double s, double diameter_mm);
/// Of the usual diameters (steps of 0.05 mm below 2 mm, of 0.25 mm below 10 mm, of 1 mm above) that stand above the
/// tips the one that touches the flanks nearest to the height h; nothing where none does.
[[nodiscard]] std::optional<BallInSpace> measuring_ball(const ToothSpace& space, double s, double h);

}  // namespace toothpath::tooth_space
