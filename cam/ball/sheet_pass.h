// One pass of a ball along the tooth: a curve on the sheet of ball centres, from end to end of the ring, with its
// run-outs.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "cam/ball/finishing.h"

namespace toothpath::ball {

/// What is asked of a pass. `sigma`: its place across the sheet over the radius of the ball centre (0 to 5,
/// geometry/tooth_space/offset_sheet.h).
struct SheetPassAsked {
  std::function<double(double)> sigma;
  std::function<double(double)> other;  ///< along a corner the ball touches here, too: the pass is as long as either
                                        ///< contact lies on the ring; may be empty
  bool plus = true;                     ///< fed as a pass of the plus flank
  double r_low = -INFINITY,
         r_high = INFINITY;  ///< a corner that begins or ends inside the ring: the pass is as long as the corner, mm
};

struct SheetPass {
  BallPass pass;              ///< without points where nothing of the curve is asked
  double worst_chord_mm = 0;  ///< largest sag found while placing points
};

/// The piece of the curve whose contact lies on the ring, with the run-out at both ends. Fails where the flank ends
/// inside the ring (undercut) or the sheet cannot be followed.
[[nodiscard]] Result<SheetPass> make_sheet_pass(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options,
                                                const SheetPassAsked& asked);

/// Distance of a ball centre from the finished surface, mm.
using DistanceToPart = std::function<double(const Vec3& centre)>;

/// Where a ball would cut deeper than may be.
struct DeepPlace {
  Vec3 centre = Vec3::Zero();
  double cut_mm = 0;
};
/// The first touching point of the first pass at which a ball cuts deeper than `limit_mm`; the distance is asked on all
/// threads.
[[nodiscard]] std::optional<DeepPlace> first_deep_place(const std::vector<BallPass>& passes, double ball_radius_mm,
                                                        double limit_mm, const DistanceToPart& distance);
/// The same of the straight ways between the points, the deepest place of the first such way: a sheet that jumps from
/// one wall of a corner to another is no way for a ball.
[[nodiscard]] std::optional<DeepPlace> first_deep_way(const std::vector<BallPass>& passes, double ball_radius_mm,
                                                      double limit_mm, const DistanceToPart& distance);

}  // namespace toothpath::ball
