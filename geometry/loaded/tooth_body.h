// The teeth of gears as elastic bodies, those of a face gear and of its pinion: bricks on the exact surfaces, and what
// a real tooth adds to a half-space. Derivation: docs/loaded_contact.md 3, 4.
#pragma once

#include <array>
#include <vector>

#include "geometry/contact/pinion.h"
#include "geometry/elastic/tooth_compliance.h"

namespace toothpath::loaded {

/// The free ends of a face: surfaces at which a strip is mirrored.
struct FreeEnds {
  /// Cylinders about the axis, at these radii; planes across it, at these heights; cones about it, square to a pitch
  /// cone with its apex at the origin, at these cone distances.
  enum class Kind { cylinders, planes, cones };
  Kind kind = Kind::cylinders;
  std::array<double, 2> at{};  ///< mm
  Vec3 origin = Vec3::Zero(), axis = Vec3::UnitZ();
  double sin_delta = 0, cos_delta = 1;  ///< of the pitch cone
  /// The image of a point at one end: the same distance beyond it.
  [[nodiscard]] Vec3 mirrored(const Vec3& p, std::size_t end) const;
};

/// The pinion's transverse profile: involute, below the base circle radial, a circle as fillet, root circle. mm, rad.
struct PinionProfile {
  double r_b = 0, r_a = 0, r_f = 0;  ///< base, tip and root circle
  double fillet = 0;                 ///< radius of the fillet; smaller where two of them would not fit a space
  double start = 0;                  ///< radius at which the fillet begins
  double least_theta = 0;            ///< roll parameter at which the involute begins; 0: at the base circle
  double half_base = 0;              ///< half tooth angle at the base circle
  double centre = 0;                 ///< angle of the fillet's centre from the middle of the tooth
  /// Half angle of the tooth at radius R >= start.
  [[nodiscard]] double half_angle(double R) const;
};
/// @param fillet_mm  wanted radius of the fillet
[[nodiscard]] PinionProfile pinion_profile(const contact::Pinion<double>& pinion, double dedendum_mm, double fillet_mm);

/// A body under its stations: a half-space and the smooth remainder R.
struct ToothBody {
  elastic::Sector sector;
  FreeEnds ends;  ///< in the frame of the sector
  double face_from = 0, face_to = 0;
  std::vector<double> top, foot;  ///< heights of the first and last row of stations, a column each
  /// Remainder of the tooth o pitches on, o = -reach..reach, mm/N: what C has beyond the half-space. Symmetric:
  /// R[-o] = R[o]^T.
  std::vector<Eigen::MatrixXd> remainder;
  int reach = 0;
  double reciprocity = 0;  ///< of the elements, before it is made symmetric
  int fillet_bricks = 0;

  /// Bilinear weights of the stations around a place; beyond the flank those of its rim.
  struct Weights {
    std::array<int, 4> station{};
    std::array<double, 4> weight{};
  };
  [[nodiscard]] Weights weights(double face, double height) const;
  /// Smooth displacement at one place under a force at another, `offset` pitches back.
  [[nodiscard]] double remainder_at(const Weights& place, const Weights& force, int offset) const;
};

struct BodyPlan {
  elastic::SectorPlan bricks;
  int teeth = 5;  ///< of the clamped row
  double E = 210000, nu = 0.3;
};

/// The bricks of both alone, without the remainder: for other solvers. Refused as below.
[[nodiscard]] Result<ToothBody> gear_bricks(const face_gear::FaceGearSurface<double>& f, int side, double inner_mm,
                                            double outer_mm, const elastic::SectorPlan& plan);
[[nodiscard]] Result<ToothBody> pinion_bricks(const contact::Pinion<double>& pinion, const PinionProfile& profile,
                                              int side, double Z_from, double Z_to, const elastic::SectorPlan& plan);

/// The tooth of a gear, loaded on its flank `side`. Refused: undercut, bricks that fold, a rim that does not fit.
[[nodiscard]] Result<ToothBody> gear_body(const face_gear::FaceGearSurface<double>& f, int side, double inner_mm,
                                          double outer_mm, const BodyPlan& plan);

/// The tooth of the pinion between two sections, loaded on the flank that meets side `side` of the gear. Its frame: x
/// along d, y along b, z along the axis; its tooth 0 is turned onto the x axis at section L0.
[[nodiscard]] Result<ToothBody> pinion_body(const contact::Pinion<double>& pinion, const PinionProfile& profile,
                                            int side, double Z_from, double Z_to, const BodyPlan& plan);

/// Fills in what the body's bricks have beyond the half-space of its stations. Refused: a stiffness that is not
/// positive definite.
[[nodiscard]] Status add_remainder(ToothBody& body, const BodyPlan& plan);

/// Displacement of the stations of a half-space under the hats of the stations: H_ik = integral of hat_k/distance, over
/// its area, 1/mm; with its images at the free ends.
[[nodiscard]] Eigen::MatrixXd hat_influence(const elastic::Sector& sector, const FreeEnds& ends);

}  // namespace toothpath::loaded
