// The pieces of a face gear's tooth space over boxes of their parameters, by interval arithmetic in the kernels that
// make the surface. Proven, of displaced rings, too.
#pragma once

#include "geometry/face_gear/flank_field.h"
#include "geometry/face_gear/parameters.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::face_gear {

class FilletBlend;
class SpaceSheet;

class SpaceEnclosures {
 public:
  using First = tooth_space::BoxFirst;
  using Second = tooth_space::BoxSecond;

  SpaceEnclosures(const FaceGearParameters& gear, double helix_angle_rad);

  [[nodiscard]] tooth_space::Jet over(const SpaceSheet& space, tooth_space::Piece piece,
                                      const tooth_space::BoxParameters& box) const;
  /// Derivatives of the tip surface's height by the radius.
  [[nodiscard]] tooth_space::CurveBend tip(double r_from, double r_to) const;
  /// As ToothSpace::tip_azimuth: sharper than what follows from `over`, since the turn is no part of radius and height.
  [[nodiscard]] std::optional<tooth_space::CurveBend> tip_azimuth(const FlankField& field, int side,
                                                                  const tooth_space::EdgePlace& from, double r_from,
                                                                  const tooth_space::EdgePlace& to, double r_to) const;

 private:
  [[nodiscard]] tooth_space::Jet fillet(int side, const Second& A, const Second& Z) const;
  [[nodiscard]] Vec3T<Second> flank_offset(const FlankField& field, int side, const Second& theta,
                                           const Second& B) const;
  [[nodiscard]] Vec3T<Second> fillet_offset(const FilletBlend& blend, int side, const Second& A, const Second& Z) const;
  [[nodiscard]] Vec3T<Second> placed(const Vec3T<Second>& v, int side) const;

  FaceGearSurface<Second> f2;
  FaceGearSurface<First> f1;
};

}  // namespace toothpath::face_gear
