// Unloaded contact of two equal-base-circle bevel gears as their mills leave them: rigid bodies, exact envelopes, no
// equation of meshing.
//
// Nothing proves that the two envelopes are conjugate; here it is measured. For a place on the wheel's wall and a turn
// of the wheel, the turn at which the pinion's wall passes through that place is closed form but for one inversion
// (bevel_inverse). The pinion stops at the first of these turns over all places and teeth; the rest are gaps. The least
// value over a whole mesh, for every place, is the mismatch of the two flanks at the exact ratio: zero everywhere if
// and only if they are conjugate. Wall L of the pinion runs on wall L of the wheel, U on U. mm and rad. Derivation:
// docs/bevel_gear.md, section "Contact of the pair".
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::contact {

/// How the pair stands against its drawing; all zero: both apexes in one point, shafts at their angle.
struct BevelAssembly {
  double shaft_angle_rad = 0;  ///< added to the angle between the axes
  double offset_mm = 0;        ///< wheel axis moved along the pinion's direction of growing azimuth at the pitch line
  double pinion_axial_mm = 0;  ///< pinion away from its apex
  double wheel_axial_mm = 0;   ///< wheel away from its apex
};

/// How the pinion is cut otherwise than its drawing says: what could bring the pair closer to conjugate flanks.
struct PinionChange {
  /// Index 0: walls with eps = -sigma h = -1 ("convex" at the large end), 1: eps = +1. One mill for all walls has equal
  /// numbers in both.
  std::array<double, 2> pressure_angle_rad{};  ///< added to that of the mill's profile
  std::array<double, 2> equivalent_radius{};   ///< share added to r_v of the mill's profile: its hollow becomes flatter
  std::array<double, 2> spiral_angle_rad{};  ///< added to beta_e of the trace that the wall follows; theta(R_ref) stays
};

/// What stands on the drawn walls of both gears together, along their normals, mm: > 0 material left, < 0 missing. Of
/// wall sigma of a half, at a place of the wheel and the one of the pinion that meets it. Empty: nothing.
using BevelLeft = std::function<double(int half, int sigma, const bevel_gear::ConePoint& on_wheel,
                                       const bevel_gear::ConePoint& on_pinion)>;

/// A place on wall sigma of one half of a gear.
struct BevelPlace {
  double ell = 0, height = 0;                        ///< generatrix coordinates, mm
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero();  ///< blank frame, space 0; out of the material
  double beta = 0, p = 0;                            ///< its parameters: along the trace, on the profile of the mill
};

/// Where the pinion's wall, continued beyond its edges, passes through a point.
struct BevelTouch {
  double turn = 0;             ///< of the pinion, rad
  double ell = 0, height = 0;  ///< generatrix coordinates on the pinion, mm
  bool on_flank = false;       ///< within its face, below its tip, above its root
};

/// A place on the wheel's flank and how early the pinion meets it.
struct BevelNear {
  double error = 0;            ///< sigma (phi_1 - nominal), rad
  double ell = 0, height = 0;  ///< on the wheel, mm
};

/// Two gears in mesh. Keeps references: both gears outlive it.
class BevelPair {
 public:
  /// Refused: numbers of teeth that do not fit the pitch angles, cone distances R_0 that differ by more than 2 %, other
  /// halves, equal hands.
  [[nodiscard]] static Result<BevelPair> make(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
                                              const BevelAssembly& assembly = {}, const PinionChange& change = {},
                                              BevelLeft left = {});

  /// Turn of the pinion at which its wall sigma passes through a point of the wheel [wheel's blank frame] when the
  /// wheel stands at phi_2. Positive turns are right-handed about each gear's own axis; phi_1 = phi_2 = 0: a pinion
  /// tooth in the middle of wheel space 0. Empty: the point is not within the flank of the pinion's half. @param start
  /// of the inversion, updated
  [[nodiscard]] std::optional<double> turn_at(int half, int sigma, const Vec3& point, double phi_2,
                                              bevel_gear::BevelInverse& start) const;

  /// The same with the place on the pinion, and beyond the edges of its flank as far as its wall can be continued.
  [[nodiscard]] std::optional<BevelTouch> touch(int half, int sigma, const Vec3& point, double phi_2,
                                                bevel_gear::BevelInverse& start) const;

  /// sigma times the turn of the pinion beyond the exact ratio at which it meets a point of the wheel. Empty: as
  /// turn_at.
  [[nodiscard]] std::optional<double> error_at(int half, int sigma, const Vec3& point, double phi_2,
                                               bevel_gear::BevelInverse& start) const;
  /// The place of the wheel's flank that the pinion meets first: down from every place of a grid about which none is
  /// met earlier, since flanks come near at several places, such as both ends of a tooth. Edges of both flanks lie
  /// askew to each other, so steps that leave a flank slide along its edge: what touches first is mostly a corner of
  /// such edges.
  /// @param grid      row-major from the lowest row; error infinite: the pinion does not meet it
  /// @param halvings  of the grid's steps: to such a part of them the place is found
  /// Error infinite: it meets none.
  [[nodiscard]] BevelNear first_met(int half, int sigma, double phi_2, const std::vector<BevelNear>& grid, int columns,
                                    int halvings) const;

  /// Place on the wheel's wall; empty outside of it.
  [[nodiscard]] std::optional<BevelPlace> wheel_place(int half, int sigma, double ell, double height) const;

  /// Moment of the unit normal about the pinion axis, mm: turns of the pinion times this are gaps.
  [[nodiscard]] double lever(const BevelPlace& place, double phi_2) const;
  /// The same of the pinion's own normal, where its wall is: a turn times this is the distance square to the pinion.
  [[nodiscard]] double pinion_lever(int half, int sigma, const bevel_gear::BevelInverse& at) const;

  /// Where the pinion's flanks pass a point of the wheel, whatever the pinion's turn: generatrix coordinates of the
  /// pinion.
  [[nodiscard]] bevel_gear::ConePoint on_pinion(const Vec3& point, double phi_2) const;

  /// A point, and a direction, of the wheel's blank frame in the fixed frame while the wheel stands at phi_2: the
  /// pinion's blank frame at phi_1 = 0, z along its axis, away from its apex.
  [[nodiscard]] Vec3 to_pinion(const Vec3& point, double phi_2) const;
  [[nodiscard]] Vec3 turned_to_pinion(const Vec3& direction, double phi_2) const;
  [[nodiscard]] Vec3 wheel_axis() const { return placed_.col(2); }  ///< fixed frame, away from the wheel's apex
  [[nodiscard]] const Vec3& wheel_apex() const { return shift_; }   ///< fixed frame

  /// phi_1 at the exact ratio.
  [[nodiscard]] double nominal_turn(double phi_2) const { return -phi_2 * ratio_; }
  [[nodiscard]] double ratio() const { return ratio_; }  ///< z_2/z_1
  [[nodiscard]] const bevel_gear::BevelGear& pinion() const { return *pinion_; }
  [[nodiscard]] const bevel_gear::BevelGear& wheel() const { return *wheel_; }

  /// Heights on the wheel that can touch: above the corner arc of its mill, up to the tip.
  [[nodiscard]] double lowest(int half) const;
  [[nodiscard]] double highest() const { return wheel_->parameters().addendum_mm; }

 private:
  BevelPair() = default;
  struct Starts {
    bevel_gear::BevelInverse wheel, pinion;
  };
  /// The search down from a low place, as far as it has come.
  struct Descent {
    BevelNear at;
    Vec2 step;
    int halved = 0;   ///< how often the steps of the grid are
    double rise = 0;  ///< greatest difference to the places about it, a step away: lower ones lie kBelow times it below
    Starts starts{};
  };
  [[nodiscard]] std::optional<BevelTouch> touch_of(int half, int sigma, const Vec3& point,
                                                   const bevel_gear::ConePoint& q, bool on_flank,
                                                   bevel_gear::BevelInverse& start) const;
  /// error_at of the place (ell, height) of the wheel; one beyond an edge of either flank moves onto it first. Empty:
  /// there is none.
  /// @param starts  of the inversions, updated
  [[nodiscard]] std::optional<double> error_within(int half, int sigma, double phi_2, Vec2& place,
                                                   Starts& starts) const;
  /// From a low place on until its steps are halved so often in all.
  void downhill(int half, int sigma, double phi_2, Descent& from, int halvings) const;
  [[nodiscard]] bool within_edges(const bevel_gear::BevelHalf& half, const bevel_gear::ConePoint& q) const;
  const bevel_gear::BevelGear *pinion_ = nullptr, *wheel_ = nullptr;
  std::vector<bevel_gear::BevelHalf> pinion_halves_;  ///< with the change
  BevelLeft left_;
  double ratio_ = 1;
  Mat3 placed_ = Mat3::Identity();
  Vec3 shift_ = Vec3::Zero();
};

struct BevelContactOptions {
  int columns = 21;            ///< places along the face of a half
  int rows = 17;               ///< along the profile
  int steps = 32;              ///< positions of the wheel a pitch
  double compound_mm = 0.006;  ///< thickness of the marking compound
};

/// The places of one half of a wall with what the roll found there; row-major, row 0 lowest, column 0 at the inner end.
struct BevelPattern {
  int half = 0;
  int rows = 0, columns = 0;
  std::vector<BevelPlace> places;
  /// Along the normal at the exact ratio, mean 0 over the wall; > 0: a gap. NaN: the flanks have no common normal here,
  /// because the pinion's flank ends before.
  std::vector<double> mismatch_mm;
  std::vector<double> gap_mm;                           ///< least gap while the pair rolls; NaN: the pinion never comes
  std::vector<double> pinion_ell_mm, pinion_height_mm;  ///< place on the pinion at that moment
  double marked_share = 0;                              ///< part of the places below the compound
};

/// One position of the mesh cycle.
struct BevelPosition {
  double phi_2 = 0, phi_1 = 0;
  double error_rad = 0;        ///< phi_1 - nominal_turn, times sigma: < 0 the pinion is held back. Of the pinion
  int half = 0, tooth = 0;     ///< what touches; pair counted from the one in the middle
  double ell = 0, height = 0;  ///< on the wheel
  int marking = 0;             ///< pairs within the compound of touching
};

struct BevelContact {
  int sigma = 1;
  std::vector<BevelPosition> cycle;  ///< one pitch of the wheel
  std::vector<BevelPosition> pair;   ///< one pair alone, through all of its mesh and on its edges
  double error_range_rad = 0;        ///< peak to peak, also where one pair takes over from another between positions
  double error_mean_rad = 0;
  double error_range_mm = 0;  ///< at the mean pitch circle of the pinion
  double marking_ratio = 0;   ///< mean number of pairs within the compound
  int least_marking = 0, most_marking = 0;
  double mismatch_max_mm = 0, mismatch_min_mm = 0,
         mismatch_rms_mm = 0;          ///< over all places of both halves; rms about the mean
  std::vector<BevelPattern> patterns;  ///< one a half
};

/// The grid of one half of the wheel's wall: lowest to highest, over its face. Places that are not on the wall have a
/// NaN point.
[[nodiscard]] BevelPattern wheel_grid(const BevelPair& pair, int half, int sigma, int rows, int columns);

/// Rolls wall sigma of the pair through one pitch. Refused: walls that never meet.
[[nodiscard]] Result<BevelContact> bevel_contact(const BevelPair& pair, int sigma,
                                                 const BevelContactOptions& options = {});

/// BevelContact::patterns' mismatch_mm of all halves, one after the other, and nothing else: a small part of the work.
[[nodiscard]] Result<std::vector<double>> bevel_mismatch(const BevelPair& pair, int sigma,
                                                         const BevelContactOptions& options = {});

/// What one change does to the mismatch of both walls together; a constant of each wall (play) does not count.
struct MismatchChange {
  std::string name, unit;
  double amount = 0;  ///< best in the sense of least squares, in `unit`
  double rms_before_mm = 0, rms_after_mm = 0;
  bool measured = false;  ///< the changed pair was rolled again; else first order
};
/// Changes of the pinion's mill, of its traces and of the assembly one at a time (first order); then the best amounts
/// of mill and traces together, and of a mill of its own for the walls of each eps with the traces, measured with the
/// changed pinion. Refused: as bevel_contact.
[[nodiscard]] Result<std::vector<MismatchChange>> mismatch_changes(const bevel_gear::BevelGear& pinion,
                                                                   const bevel_gear::BevelGear& wheel,
                                                                   const BevelContactOptions& options = {});

/// The mate of a gear by the rules of the pair: teeth exchanged, hands opposite, everything else and the mill equal.
/// Refused: as BevelGear::make; a gear that names no mate.
[[nodiscard]] Result<bevel_gear::BevelGear> bevel_mate(const bevel_gear::BevelGear& gear);

}  // namespace toothpath::contact
