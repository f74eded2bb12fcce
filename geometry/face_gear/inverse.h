// From a point back to the flank's parameters, and the exact signed distance that follows from it.
#pragma once

#include <optional>

#include "geometry/base/angle.h"
#include "geometry/face_gear/surface.h"

namespace toothpath::face_gear {

/// Beyond this B [rad] Z runs away: no practical flank.
inline constexpr double kMaxB = radians(80.0);

/// Parameters of a flank point and its regularity.
struct FlankCoordinates {
  double theta = 0, B = 0;
  double J = 0;  ///< > 0 on the sheet that is cut
  int iterations =
      0;  ///< Newton steps of the whole way, filled in by invert_flank; 0 when a bracketing search found it
};

/// B at which searches on the line of this theta begin: that of the pitch point, s alpha_t, and where the fold of the
/// undercut lies outside it (J <= 0: low pressure angles, few teeth against the shaper's) the next one outwards in
/// steps of 0.02 rad with J > 0.
[[nodiscard]] double regular_start_B(const FaceGearSurface<double>& surface, int side, double theta);

/// (r, z) -> (theta, B) on the regular sheet of side s. Start: any point of the same sheet; the pitch point, or what
/// regular_start_B gives for its theta, is taken when `start` is empty. Newton along a straight (r, z) path in short
/// steps; on failure a bracketing search over B. Position error <= 1e-12 r. Nothing is returned where the sheet does
/// not reach (r, z) (r <= M2, beyond J = 0).
[[nodiscard]] std::optional<FlankCoordinates> invert_flank(const FaceGearSurface<double>& surface, int side, double r,
                                                           double z, const std::optional<FlankCoordinates>& start = {});

/// Azimuth of the flank of side s of tooth 0 at (theta, B), unwrapped (not reduced to one turn), rad.
[[nodiscard]] double flank_azimuth(const FaceGearSurface<double>& surface, int side, const FlankCoordinates& at);

/// Exact signed distance of a point to the continued flank of side s of tooth 0, positive outside the material, and its
/// foot. Parallel surfaces of a face gear flank are rotations of it: d = s M2 (azimuth - Theta_s(r, z)).
struct FlankDistance {
  double distance = 0;
  FlankCoordinates foot;
};
[[nodiscard]] std::optional<FlankDistance> flank_distance(const FaceGearSurface<double>& surface, int side,
                                                          const Vec3& point,
                                                          const std::optional<FlankCoordinates>& start = {});

/// B of the flank point with this theta at radius r on the regular sheet: by continuation from `start_B`, and where
/// that does not arrive by a bracketing search from the outside up to the fold. |radius - r| <= 1e-11 r.
[[nodiscard]] std::optional<double> flank_B_at_radius(const FaceGearSurface<double>& surface, int side, double theta,
                                                      double r, double start_B);

/// Section Z of the fillet (or edge of the root) at normal angle A whose point has radius r, on the outermost sheet: by
/// secant from `start_Z`, and where that does not arrive by a bracketing search from the outside. |radius - r| <= 1e-12
/// r. Nothing where the edge does not reach r.
[[nodiscard]] std::optional<double> fillet_Z_at_radius(const FaceGearSurface<double>& surface, int side, double A,
                                                       double r, double start_Z);

}  // namespace toothpath::face_gear
