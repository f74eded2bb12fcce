// The exact outline of tooth space 0 on one cylinder r = const: what every row of a tooth mesh is made of.
#pragma once

#include <array>
#include <optional>

#include "geometry/face_gear/space_sheet.h"
#include "geometry/mesh/tooth_mesh.h"

namespace toothpath::mesh {

/// The pieces of the outline, in the order of growing azimuth from the middle of the top land of tooth 0 to that of
/// tooth 1. Flanks run from the tip to the fillet on the left, from the fillet to the tip on the right.
enum class Segment : std::uint8_t { land_left, flank_plus, fillet_plus, root, fillet_minus, flank_minus, land_right };
inline constexpr std::size_t kSegmentCount = 7;

[[nodiscard]] Piece segment_patch(std::size_t segment);

/// A point of the outline and its patch coordinates (see `Piece`).
struct SectionPoint {
  Vec3 p = Vec3::Zero();
  Vec2 uv = Vec2::Zero();
};

class ToothSection {
 public:
  /// Outline at radius r [mm] of one ring of a gear with `teeth` teeth; the sheet outlives it. `near`: a section of the
  /// same ring close by, from which the solution is continued. Refused where a flank does not reach the tip surface or
  /// its fillet, where the fillets overlap and where the two flanks of a tooth have crossed below the tip surface.
  static Result<ToothSection> at(const face_gear::SpaceSheet& sheet, int teeth, double r,
                                 const ToothSection* near = nullptr);

  /// Point at `fraction` in [0, 1] of a segment, in the direction of growing azimuth. Both neighbours give the same
  /// bits at a common end. Nothing where an inner solution fails.
  [[nodiscard]] std::optional<SectionPoint> point(std::size_t segment, double fraction) const;

  [[nodiscard]] double radius() const { return r_; }
  /// Arc width of the top land and of the root land, mm.
  [[nodiscard]] double land_width() const { return 2 * half_land_ * r_; }
  [[nodiscard]] double root_width() const { return root_width_ * r_; }
  /// Height of the root land, mm in z.
  [[nodiscard]] double root_height() const { return root_edge_[0].z(); }

 private:
  /// One flank with its fillet.
  struct Side {
    int s = 1;
    double theta_tip = 0, B_tip = 0;  ///< where it meets the tip surface
    double B_t = 0;                   ///< at theta_t
    double Z_t = 0, Z_e = 0;          ///< fillet at A_t and A_e
  };
  static Result<Side> make_side(const face_gear::SpaceSheet& sheet, int s, double r, const Side* near);
  [[nodiscard]] Vec3 placed(const Vec3& p, int s) const { return s > 0 ? p : turned_by_pitches(p, 1, teeth_); }
  [[nodiscard]] std::optional<SectionPoint> flank_point(const Side& side, double from_tip) const;
  [[nodiscard]] std::optional<SectionPoint> fillet_point(const Side& side, double from_flank) const;

  const face_gear::SpaceSheet* sheet_ = nullptr;
  int teeth_ = 0;
  double r_ = 0;
  std::array<Side, 2> sides_;                                  ///< +1, -1
  double mid_azimuth_ = 0;                                     ///< middle of the land of tooth 0
  double half_land_ = 0;                                       ///< half its angle
  double root_width_ = 0;                                      ///< angle of the root land
  std::array<Vec3, 2> root_edge_{Vec3::Zero(), Vec3::Zero()};  ///< both ends of the root land, placed
};

}  // namespace toothpath::mesh
