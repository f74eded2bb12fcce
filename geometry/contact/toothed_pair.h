// Two gears that stand on their tooth spaces, whatever their types, rolled as rigid bodies: what tooth_contact does for
// a face gear and the pinion of its shaper.
//
// A place of the gear's flank, turned into the frame of its mate, has a radius, a place along the axis and an azimuth
// there. Where the mate's flank has a place with the same two, the difference of the azimuths is the turn at which it
// reaches the place: no equation of meshing, one Newton in the parameters of the mate's flank. Edges of both are
// contacts like any other place. Derivation: docs/contact.md 5.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geometry/contact/pattern_place.h"
#include "geometry/tooth_space/exact_space.h"
#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::contact {

/// A flank of space 0 as a grid of exact places with deviations; row 0 lies where it ends at its fillet, the last row
/// at the tip; column 0 at the inner or lower end. Lives as long as its space.
struct SpaceFlank {
  const tooth_space::ToothSpace* space = nullptr;
  tooth_space::Piece piece = tooth_space::Piece::flank_plus;
  int zone = 0, side = 1;
  int rows = 0, columns = 0;
  std::vector<double> us, vs;         ///< row-major
  std::vector<double> deviation_mm;   ///< along the normal, > 0 material left; all 0 on the exact flank
  std::vector<Vec3> points, normals;  ///< nominal
  std::vector<double> low_mm;         ///< h where the flank ends, one a column of evenly spread s; of exact flanks

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool exact() const;
  [[nodiscard]] const std::vector<double>& u() const { return us; }
  [[nodiscard]] const std::vector<double>& v() const { return vs; }
  /// Place and normal; NaN where the kernel has none.
  [[nodiscard]] tooth_space::PatchPoint at(double u, double v) const;
  /// Along the teeth as messages tell it (radius, z, cone distance), and height in the chart.
  [[nodiscard]] Vec2 meridian(const Vec3& p) const;
  /// Share of the face from column 0, and of the height from where the flank ends to the tip. Of exact flanks.
  [[nodiscard]] Vec2 shares(double s, double h) const;
  /// How far inside its ends, its tip and its lower end, mm; below 0 outside. Of exact flanks.
  [[nodiscard]] double inside_by(double s, double h) const;
  /// Its place at (s, h); nothing where it has none. Of exact flanks.
  [[nodiscard]] std::optional<tooth_space::PiecePlace> place(double s, double h) const;

 private:
  [[nodiscard]] double low(double station) const;  ///< h where it ends
  [[nodiscard]] double column_share(double station) const;
};
/// Refused: a flank that does not reach from its fillet to its tip surface.
[[nodiscard]] Result<SpaceFlank> space_flank(const tooth_space::ToothSpace& space, int zone, int side, int rows,
                                             int columns);
/// The same flank on measured places: nominal points in rows along the profile, either way round, and their deviations.
/// Refused: a point that is not on the flank.
[[nodiscard]] Result<SpaceFlank> measured_flank(const SpaceFlank& exact, int rows, int columns,
                                                const std::vector<Vec3>& nominal,
                                                const std::vector<double>& deviation_mm);

/// The frame of the mate in that of the gear where the gear stands at turn 0.
struct MatePlace {
  Mat3 axes = Mat3::Identity();  ///< x, y, z of the mate
  Vec3 origin = Vec3::Zero();
  int sense = -1;  ///< +1: both turn alike, each about its own z
  [[nodiscard]] Vec3 to_mate(const Vec3& p) const { return axes.transpose() * (p - origin); }
};

/// The frame of the gear in that of its mate.
[[nodiscard]] inline MatePlace seen_from_mate(const MatePlace& place) {
  return {place.axes.transpose(), -(place.axes.transpose() * place.origin), place.sense};
}

/// Gears that mesh from outside, cylindrical and bevel gears alike: mates stand at azimuth 0 of each other.
struct OutsideShafts {
  double angle_rad = 0;                         ///< between both z; 0: parallel
  double distance_mm = 0;                       ///< of the axes, along x where they are parallel, else along y
  bool skew = false;                            ///< of cylindrical gears: turned about the line of centres, x
  double gear_axial_mm = 0, mate_axial_mm = 0;  ///< each along its own z
};
/// `moved`: the distance of the axes, their angle about the common perpendicular, both gears along their own z.
[[nodiscard]] MatePlace outside_place(const OutsideShafts& shafts, const Misalignment& moved = {});
/// A pinion on a face gear: its z = 0 in the reference section of the gear's shaper, its azimuth 0 towards the gear.
[[nodiscard]] MatePlace pinion_place(const face_gear::FaceGearSurface<double>& gear, int pinion_teeth,
                                     const Misalignment& moved = {});

/// A flank of the gear with the flank of the mate that it touches.
struct ToothedMember {
  SpaceFlank flank;
  std::shared_ptr<const SpaceFlank> mate;
  MatePlace place;
  int gear_teeth = 0, mate_teeth = 0;
  double mesh_rad = 0;    ///< turn of the gear at which the middle of the flank is in mesh, about
  double turned_rad = 0;  ///< turn of the mate there beyond the ratio: from here its turns are counted

  // What rolling.h asks of it; places in the housing.
  static constexpr bool kEvenLever = false;
  [[nodiscard]] double pitch() const { return kTwoPi / gear_teeth; }
  [[nodiscard]] double ratio() const { return double(mate_teeth) / gear_teeth; }
  [[nodiscard]] int teeth_of_mate() const { return mate_teeth; }
  [[nodiscard]] double near_turn(std::size_t k) const;
  [[nodiscard]] double inside_by(const Vec3& point) const;
  [[nodiscard]] double asked_turn(const Vec3& point, double phi_2) const;
  [[nodiscard]] double lever_mm(const Vec3& point, const Vec3& normal) const;
  [[nodiscard]] Vec2 on_mate(const Vec3& point) const;
  [[nodiscard]] std::optional<ToPinion> approach(const Vec3& point, const Vec3& normal, double phi_2) const;
};

struct PairGrid {
  int rows = 21, columns = 25;            ///< of the gear's flanks
  int mate_rows = 17, mate_columns = 33;  ///< from which places of the mate's are sought
};

/// Both gears as they roll. Parts must outlive it.
struct ToothedPair {
  const tooth_space::ToothedPart* gear = nullptr;
  const tooth_space::ToothedPart* mate = nullptr;
  MatePlace place;
};
/// Flanks of one side of the gear, a member for each zone that meets one of the mate. Refused: as space_flank; flanks
/// that do not come to each other in any turn.
[[nodiscard]] Result<std::vector<ToothedMember>> toothed_members(const ToothedPair& pair, int side,
                                                                 const PairGrid& grid = {});

/// As of face gears.
[[nodiscard]] Result<RollResult> roll(const std::vector<ToothedMember>& members, const RollOptions& options = {});
[[nodiscard]] Result<EaseOff> ease_off(const std::vector<ToothedMember>& members);
[[nodiscard]] PatternPlace pattern_place(const ToothedMember& member, const EaseOffMap& map,
                                         const FlankPattern& pattern, double compound_mm, double margin);

}  // namespace toothpath::contact
