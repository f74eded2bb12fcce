// The exact outline of tooth space 0 at one station s = const: what every row of a tooth mesh and of a solid's patches
// is made of.
#pragma once

#include <array>
#include <optional>

#include "geometry/base/result.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::mesh {

using tooth_space::Piece;

/// The pieces of the outline, in the order of growing azimuth from the middle of the top land of tooth 0 to that of
/// tooth 1. Flanks run from the tip to the fillet on the left, from the fillet to the tip on the right.
enum class Segment : std::uint8_t { land_left, flank_plus, fillet_plus, root, fillet_minus, flank_minus, land_right };
inline constexpr std::size_t kSegmentCount = 7;

[[nodiscard]] Piece segment_patch(std::size_t segment);

/// A point of the outline and its parameters: those of the piece, of the tip surface (azimuth, s).
struct SectionPoint {
  Vec3 p = Vec3::Zero();
  Vec2 uv = Vec2::Zero();
};

/// The way of a piece along one station, from one u to another: v with its slope at even nodes.
struct SectionLine {
  static constexpr int kSteps = 8;
  struct Node {
    double v = 0, dv = 0;  ///< and dv/du
    double sv = 0;         ///< of the station by v, across the line
  };
  double u_from = 0, u_to = 0;
  std::array<Node, kSteps + 1> nodes;
  [[nodiscard]] double u(double share) const {
    return share >= 1 ? u_to : share <= 0 ? u_from : u_from + share * (u_to - u_from);
  }
};

class ToothSection {
 public:
  /// Outline at station s [mm] (tooth_space.h: s where the ends are square); the space outlives it. `near`: a section
  /// of the same ring close by, from which the solution is continued. Refused where a flank does not reach the tip
  /// surface or its fillet, where the fillets overlap and where the two flanks of a tooth have crossed below the tip
  /// surface.
  static Result<ToothSection> at(const tooth_space::ToothSpace& space, double s, const ToothSection* near = nullptr);

  /// Point at `fraction` in [0, 1] of a segment, in the direction of growing azimuth. Both neighbours give the same
  /// bits at a common end. Nothing where an inner solution fails.
  [[nodiscard]] std::optional<SectionPoint> point(std::size_t segment, double fraction) const;

  /// The same at a u of the flank of a side.
  [[nodiscard]] std::optional<SectionPoint> flank_at(int side, double u) const;
  /// u of a flank where it ends at the fillet and where it meets the tip surface.
  [[nodiscard]] std::array<double, 2> flank_ends(int side) const {
    const Side& of = sides_[side > 0 ? 0 : 1];
    return {of.flank.u_to, of.flank.u_from};
  }

  [[nodiscard]] double s() const { return s_; }
  /// The same in words.
  [[nodiscard]] std::string station() const;
  /// Arc width of the top land and of the root land, mm.
  [[nodiscard]] double land_width() const { return 2 * half_land_ * radius(tip_edge_[0]); }
  [[nodiscard]] double root_width() const { return root_width_ * radius(root_edge_[0]); }
  /// Height of the root land, mm in h.
  [[nodiscard]] double root_height() const { return space_->outline().chart.up(root_edge_[0]); }

 private:
  /// One flank with its fillet.
  struct Side {
    int s = 1;
    tooth_space::EdgePlace tip;
    SectionLine flank;   ///< from the tip surface to the fillet
    SectionLine fillet;  ///< on to the root
  };
  static Result<Side> make_side(const tooth_space::ToothSpace& space, int side, double s, const ToothSection* near);
  [[nodiscard]] std::optional<SectionPoint> on_line(Piece piece, const SectionLine& line, double share) const;
  [[nodiscard]] std::optional<SectionPoint> flank_point(const Side& side, double from_tip) const;
  [[nodiscard]] std::optional<SectionPoint> fillet_point(const Side& side, double from_flank) const;
  [[nodiscard]] std::optional<SectionPoint> root_point(double fraction) const;
  [[nodiscard]] SectionPoint land_point(double azimuth) const;

  const tooth_space::ToothSpace* space_ = nullptr;
  double s_ = 0, s_tip_ = 0;                                   ///< station, and s of the tip surface there
  std::array<Side, 2> sides_;                                  ///< +1, -1
  double mid_azimuth_ = 0;                                     ///< middle of the land of tooth 0
  double half_land_ = 0;                                       ///< half its angle
  double root_width_ = 0;                                      ///< angle of the root land
  double root_v_ = 0, root_sv_ = 0;                            ///< in its middle, with the station's slope by v
  std::array<Vec3, 2> tip_edge_{Vec3::Zero(), Vec3::Zero()};   ///< where the flanks meet the tip surface
  std::array<Vec3, 2> root_edge_{Vec3::Zero(), Vec3::Zero()};  ///< both ends of the root land
};

}  // namespace toothpath::mesh
