// Unloaded contact of a face gear with a pinion as rigid bodies: transmission error, touching pairs, contact pattern.
//
// For a place on the gear's flank the turn at which the pinion's flank reaches it is closed form (Pinion::turn_at). The
// gear at phi_2 stops the pinion at the first of these turns, over all places and teeth; how far the pinion's flank
// then is from each place is the gap, and where the least gap of a whole mesh is below the thickness of the marking
// compound the flank is coloured. No equation of meshing, no search for common normals: contact on edges and on cut
// surfaces with their deviations is found the same way. Derivation: docs/contact.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/contact/path.h"
#include "geometry/face_gear/gear.h"
#include "geometry/face_gear/space_sheet.h"

namespace toothpath::contact {

/// One flank of the gear as a grid of exact places with deviations. Row 0 lies at the fillet line, the last row at the
/// tip; column 0 at the inner end of the ring.
struct ContactFlank {
  face_gear::FaceGearSurface<double> surface;
  std::shared_ptr<const face_gear::SpaceSheet> modified;  ///< null: the flank is plain
  int zone = 0, side = 1;
  int rows = 0, columns = 0;
  std::vector<double> theta, B;       ///< row-major
  std::vector<double> deviation_mm;   ///< along the normal, > 0 material left; all 0 on the exact flank
  std::vector<Vec3> points, normals;  ///< nominal, gear frame, tooth 0

  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  [[nodiscard]] bool exact() const;  ///< no deviation anywhere
  [[nodiscard]] const std::vector<double>& u() const { return theta; }
  [[nodiscard]] const std::vector<double>& v() const { return B; }
  /// Radius and height of a place.
  [[nodiscard]] static Vec2 meridian(const Vec3& p) { return {std::hypot(p.x(), p.y()), p.z()}; }
  /// The nominal flank at its parameters, modification and all.
  [[nodiscard]] face_gear::SurfacePointT<double> at(double theta_at, double B_at) const {
    return modified ? modified->flank(side, theta_at, B_at) : surface.flank(side, theta_at, B_at);
  }
};

/// The flank of the drawing of a ring between its radii, from the fillet line (or the end of the involute) to the tip
/// surface. Refused: fewer than 3 x 3 places; a radius that the flank does not reach.
[[nodiscard]] Result<ContactFlank> exact_flank(const face_gear::FaceGear& gear, int zone, int side, int rows = 41,
                                               int columns = 49);

/// A flank from measured places: nominal points in rows along the profile (either way round, any tooth), deviations
/// along the normal. Refused: sizes that do not fit; a point that is not on the flank.
[[nodiscard]] Result<ContactFlank> measured_flank(const face_gear::FaceGear& gear, int zone, int side, int rows,
                                                  int columns, const std::vector<Vec3>& nominal,
                                                  const std::vector<double>& deviation_mm);

struct ToPinion;
/// A flank with the pinion that runs on it. Two rings of a double helical gear run with the two halves of one pinion.
struct ContactMember {
  ContactFlank flank;
  Pinion<double> pinion;
  std::shared_ptr<const modification::Field> on_pinion = nullptr;  ///< its modification; null: plain flanks
  [[nodiscard]] bool modified() const { return flank.modified != nullptr || on_pinion != nullptr; }

  // What rolling.h asks of it; places in the housing.
  static constexpr bool kEvenLever = true;
  [[nodiscard]] double pitch() const { return flank.surface.pitch; }
  [[nodiscard]] double ratio() const { return pinion.ratio; }
  [[nodiscard]] int teeth_of_mate() const { return pinion.teeth; }
  /// Where the shaper cut the place.
  [[nodiscard]] double near_turn(std::size_t k) const {
    return flank.surface.i * flank.surface.flank_phi(flank.side, flank.theta[k], flank.B[k]);
  }
  [[nodiscard]] double inside_by(const Vec3& point) const {
    const double radius = pinion.place(point).radius;
    return std::min(pinion.r_a - radius, radius - pinion.r_b);
  }
  [[nodiscard]] double asked_turn(const Vec3& point, double phi_2 = 0) const;
  [[nodiscard]] double lever_mm(const Vec3&, const Vec3&) const { return pinion.r_b * pinion.cos_bb; }
  [[nodiscard]] Vec2 on_mate(const Vec3& point) const {
    const auto place = pinion.place(point);
    return {place.radius, place.Z};
  }
  [[nodiscard]] std::optional<ToPinion> approach(const Vec3& point, const Vec3&, double phi_2) const;
};

/// Depths and sections of a pinion over which its modifications are counted: from its tip cylinder down twice the
/// addendum; along its axis between the sections whose pitch line meets the ends of the ring.
[[nodiscard]] modification::Rectangle rectangle_of(const Pinion<double>& pinion, const face_gear::FaceGearRing& ring);

/// A flank with its pinion where that stands, and those of its modifications that meet the flank.
/// Precondition: they are not `modification::refused` on its rectangle.
[[nodiscard]] ContactMember make_member(const face_gear::FaceGear& gear, ContactFlank flank, int pinion_teeth,
                                        const Misalignment& moved,
                                        const std::vector<modification::Modification>& on_pinion);

/// How far modifications set the pinion's flank back along the normal that goes through a place beside it, mm.
/// @param side  of the gear that the flank runs on
[[nodiscard]] double set_back(const Pinion<double>& pinion, const modification::Field& field, int side,
                              const Pinion<double>::Place& place);

/// From a place to the pinion's flank along the normal of its helicoid that goes through the place, and where that
/// ends.
struct ToPinion {
  double distance_mm = 0;          ///< > 0: the flank has not reached the place
  double radius_mm = 0, Z_mm = 0;  ///< of the plain flank's place, from the pinion's axis and along it
};
/// Nothing beyond the pinion's involute. @param field  its modification; null: plain. @param phi  its turn
[[nodiscard]] std::optional<ToPinion> to_pinion(const Pinion<double>& pinion, const modification::Field* field,
                                                int side, const Pinion<double>::Place& place, double phi);

struct RollOptions {
  int steps = 48;              ///< positions a pitch
  double compound_mm = 0.006;  ///< thickness of the marking compound
  double touch_mm = 1e-6;      ///< pairs with a smaller gap count as touching
  int widest_pitches = 12;     ///< how far from the pitch point a pair is followed at most, pitches
};

/// One position of the mesh cycle.
struct RollPosition {
  double phi_1 = 0, phi_2 = 0;  ///< turns, rad
  double error_rad = 0;         ///< phi_2 - phi_1 N_p/N_2
  int member = 0, tooth = 0;    ///< what touches: index of the member; pair, counted from the one at the pitch point
  double radius_mm = 0, height_mm = 0;  ///< place of contact on the gear: along the teeth and up
  int touching = 0;                     ///< teeth whose gap is below touch_mm (in any member)
  int marking = 0;                      ///< teeth whose gap is below the compound
  void stand_at(const Vec2& meridian) { radius_mm = meridian.x(), height_mm = meridian.y(); }
};

/// What rolling leaves on one flank.
struct FlankPattern {
  std::vector<double> gap_mm;  ///< least gap at every place of the grid; a large number where the pinion never comes
  std::vector<double> pinion_radius_mm, pinion_Z_mm;  ///< place on the pinion at that moment
  std::vector<RollPosition> path;  ///< contact of one pair through its whole mesh, only while it touches
  double marked_share = 0;         ///< part of the flank's area below the compound
  double inner_mm = 0, outer_mm = 0, low_mm = 0, high_mm = 0;  ///< extent of the marked part: radii and heights z
  double centre_radius_mm = 0, centre_height_mm = 0;
  double inclination_rad = 0;  ///< of the pattern's long axis against the tip line, in the plane of radius and profile
  double length_mm = 0, width_mm = 0;  ///< along and across that axis: four times the root of the second moments
  bool at_inner_end = false, at_outer_end = false, at_tip = false,
       at_fillet = false;  ///< does the pattern run out there
};

struct RollResult {
  std::vector<RollPosition> cycle;  ///< one pitch
  /// One pair alone, through all of its mesh and on its edges: turns, error and place.
  std::vector<RollPosition> pair;
  double error_mean_rad = 0,
         error_range_rad = 0;  ///< mean; peak to peak, also where one pair takes over from another between positions
  double contact_ratio = 0;    ///< mean number of touching teeth
  int least_touching = 0, most_touching = 0;
  double marking_ratio = 0;  ///< the same with the compound's thickness
  int least_marking = 0, most_marking = 0;
  std::vector<FlankPattern> patterns;  ///< one a member
};

/// Where one pair takes over from another between two positions, as if their curves were straight there: the value of
/// both. a, b: the pair that bears before and the one that bears after; 0, 1: at the two positions. Nothing where they
/// do not cross.
[[nodiscard]] inline std::optional<double> handover(double a_0, double a_1, double b_0, double b_1) {
  const double before = b_0 - a_0, after = b_1 - a_1;
  if (!(before * after < 0)) return std::nullopt;
  return a_0 + (a_1 - a_0) * before / (before - after);
}

/// Highest value of a motion curve, also where one pair takes over between two positions. Of flanks that lag where the
/// curve is high: of all pairs the lowest bears.
/// @param pair  of one pair alone, position by position; where it does not touch 1e300, or NaN: no hand-over there
/// @param bears  a position of one pitch each: which position of `pair` bears then  @param highest  at the positions
[[nodiscard]] inline double with_handovers(const std::vector<double>& pair, const std::vector<int>& bears,
                                           double highest) {
  const int steps = static_cast<int>(bears.size()), turns = static_cast<int>(pair.size());
  const auto at = [&](int k) { return pair[static_cast<std::size_t>(k)]; };
  for (int n = 0; n < steps; ++n) {
    const int a = bears[static_cast<std::size_t>(n)], b = bears[static_cast<std::size_t>((n + 1) % steps)];
    if (a + 1 == b || a + 1 >= turns || b >= turns || b < 1) continue;
    if (const auto over = handover(at(a), at(a + 1), at(b - 1), at(b))) highest = std::max(highest, *over);
  }
  return highest;
}

/// Rolls the members (same side, same gear) through one pitch. Refused: no position in which they meet.
[[nodiscard]] Result<RollResult> roll(const std::vector<ContactMember>& members, const RollOptions& options = {});

/// Turn at which the pinion's flank touches the gear's when the gear stands at phi_2, for tooth 0 alone; with the
/// place. Nothing if the pinion's flank does not reach the tooth. |error| <= 1e-12 rad where contact is inside the
/// flank.
struct TouchPlace {
  double phi_1 = 0;
  double lever_mm = 0;         ///< distance of the flanks a turn of the pinion
  double row = 0, column = 0;  ///< in the grid
  Vec3 point = Vec3::Zero();   ///< gear frame, tooth 0
};
[[nodiscard]] std::optional<TouchPlace> touch(const ContactMember& member, double phi_2);

/// Part of a path of contact that lies on both flanks: inside the ring, below the tip, above the fillet line, on the
/// pinion's involute. Nothing where the path misses the flank.
struct PathRange {
  double theta_1_from = 0,
         theta_1_to = 0;  ///< the pinion's roll parameter, low to high: from the gear's tip to the pinion's
  double ratio = 0;       ///< its length in pitches
};
[[nodiscard]] std::optional<PathRange> path_on_flanks(const ContactPath<double>& path, const ContactMember& member);

}  // namespace toothpath::contact
