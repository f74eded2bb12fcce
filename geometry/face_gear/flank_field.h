// What displaces a flank along the normals of the plain one: the drawing's modification, and a correction that answers
// a measurement; their sum is one exact flank.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "geometry/base/refusal.h"
#include "geometry/face_gear/surface.h"
#include "geometry/modification/flank_correction.h"
#include "geometry/modification/modification.h"
#include "geometry/tooth_space/modified_form.h"

namespace toothpath::face_gear {

/// Modifications of both flanks of one ring.
struct RingModification {
  modification::Field plus, minus;  ///< sides +1 and -1
  [[nodiscard]] const modification::Field& side(int s) const { return s > 0 ? plus : minus; }
};

struct FaceGearRing;

/// Of the drawing: a correction does not count. Precondition: the ring has a modification.
[[nodiscard]] tooth_space::ModifiedForm modified_form(const FaceGearParameters& gear, const FaceGearRing& ring);

/// The modifications of a gear on one of its zones; null where nothing is modified. Refused: as modification::refused.
[[nodiscard]] Expected<std::shared_ptr<const RingModification>, Refusal> ring_modification(
    const FaceGearParameters& gear, const FaceGearSurface<double>& surface, int zone);

/// Depths and radii of a ring over which modifications are counted: from the tip surface, square to it, to where the
/// tip of a pinion of full addendum reaches; from its inner radius to its outer one.
[[nodiscard]] inline modification::Rectangle rectangle_of(const FaceGearSurface<double>& f, const FaceGearZone& zone) {
  return {2 * f.shaper.h_a, zone.inner_radius_mm, zone.outer_radius_mm};
}

/// The fields of one flank; each may be missing.
struct FlankField {
  const modification::Field* drawn = nullptr;
  const modification::FlankCorrection* measured = nullptr;
  [[nodiscard]] bool none() const { return drawn == nullptr && measured == nullptr; }

  /// Below the tip surface, square to it, at a place of the plain flank; any frame that is the gear's turned about z.
  template <typename S>
  static S depth(const FaceGearSurface<S>& f, const Vec3T<S>& p, const S& r) {
    return (f.z_tip(r) - p[2]) * f.Sg;
  }
  /// Offset along the normal out of the material at the plain place p = P(theta, B), mm.
  template <typename S>
  [[nodiscard]] S offset(const FaceGearSurface<S>& f, const S& theta, const Vec3T<S>& p) const {
    using std::sqrt;
    const S r = sqrt(S(p[0] * p[0] + p[1] * p[1]));
    S c(0);
    if (drawn) c = c - drawn->removal(depth(f, p, r), r);
    if (measured) c = c + measured->offset(theta, r);
    return c;
  }
};

}  // namespace toothpath::face_gear
