// What a mill with a ball end and a conical side leaves of a flank, the plain way: the flank as points found by
// sweeping the solid shaper, the tool as the union of balls about its axis, its motion sampled densely and the nearest
// moment improved. Shares no formula with cam.
#pragma once

#include <functional>
#include <vector>

#include "geometry/base/vec.h"
#include "tests/support/brute_force_face_gear.h"

namespace toothpath::test {

/// Points of the flank whose azimuth at (r, z) is near `azimuth(r, z)`, on a grid: columns over the radii, rows from
/// `z_low(r)` to `z_high(r)`; all borders included. Each lies on the swept surface to 1e-10 mm.
[[nodiscard]] std::vector<Vec3> swept_flank(const BruteForceFaceGear& brute, double r_from, double r_to,
                                            const std::function<double(double)>& z_low,
                                            const std::function<double(double)>& z_high,
                                            const std::function<double(double, double)>& azimuth, int columns,
                                            int rows);

/// Tip and unit axis, tip to holder.
struct BrutePose {
  Vec3 tip, axis;
};

struct BruteConicalMill {
  double r_0 = 0, half_angle = 0;        ///< mm, rad
  double thicker = 0, thicker_from = 0;  ///< planted: rho is larger by this from this height above the ball's centre on
  /// Distance from a point to the mill in this pose, negative inside; the cone has no end.
  [[nodiscard]] double distance(const Vec3& point, const BrutePose& pose) const;
};

/// Least distance from a point to the mill over all moments of its way: straight in the tip, normalised linear in the
/// axis.
[[nodiscard]] double least_distance(const Vec3& point, const BruteConicalMill& mill, const std::vector<BrutePose>& way);

/// Over a set of surface points: the largest least distance (what is left) and minus the smallest (how deep it is cut).
struct BruteSwept {
  double left = -INFINITY, gouge = -INFINITY;
  Vec3 left_at = Vec3::Zero(), gouge_at = Vec3::Zero();
};
[[nodiscard]] BruteSwept swept(const std::vector<Vec3>& points, const BruteConicalMill& mill,
                               const std::vector<BrutePose>& way);

}  // namespace toothpath::test
