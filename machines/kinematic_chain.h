// A machine as a chain of joints: three linear axes and up to two rotary axes, each in the table or in the head.
//
//   work - T1 - T2 - bed - X Y Z - ram - H1 - H2 - spindle - tool        (T1 carries the work, H2 carries the spindle)
//
// The **table frame** is fixed to the work's table and coincides with the machine axes when every rotary axis stands
// at its zero. The gauge point G is the centre of the spindle nose; the tool tip lies L below it along the spindle.
// A rotary command theta turns the tool relative to the work by Rot(direction, sign * (theta - zero)): sign = +1 is
// the sense of ISO 841, for table and head axes alike; -1 is reversed (LinuxCNC's trt kinematics).
// Source: R. M. Murray, Z. Li, S. S. Sastry, A Mathematical Introduction to Robotic Manipulation, 1994, 3.2
// (Paden-Kahan subproblems), in a form that keeps its digits at the pole.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::machines {

struct LinearAxis {
  double min_mm = 0.0;
  double max_mm = 0.0;
  double max_speed = 0.0;         ///< mm/min
  double max_acceleration = 0.0;  ///< mm/min^2; 0: not stated
  double max_jerk = 0.0;          ///< mm/min^3; 0: not stated
};

/// What holds a rotary axis where it stands, by words of the builder.
struct RotaryClamp {
  std::string on, off;             ///< words of a program: "M10" clamps, "M11" releases
  double on_min = 0, off_min = 0;  ///< what they take, minutes; 0: not stated
};

struct RotaryAxis {
  char letter = 'C';               ///< A, B or C
  Vec3 direction = Vec3::UnitZ();  ///< unit vector, machine axes, all rotaries at zero
  Vec3 point_mm = Vec3::Zero();  ///< on the axis. Table: machine coordinates. Head: from the gauge point, all rotaries
                                 ///< at zero; its z is the pivot length (pivot above the gauge point)
  int sign = 1;                  ///< +1: ISO sense; -1: reversed
  double zero_rad = 0.0;         ///< command at which the axis stands at its zero
  double min_rad = 0.0;
  double max_rad = 0.0;
  bool rollover = false;   ///< the control counts it within one turn and it has no ends: min and max are infinite
  double max_speed = 0.0;  ///< rad/min
  double max_acceleration = 0.0;  ///< rad/min^2; 0: not stated
  double max_jerk = 0.0;          ///< rad/min^3; 0: not stated
  std::optional<RotaryClamp> clamp = std::nullopt;

  [[nodiscard]] double pivot_length_mm() const { return point_mm.z(); }  ///< head axes only
  /// Rot(direction, sign * (command - zero)).
  [[nodiscard]] Mat3 rotation(double command_rad) const;
};

/// Tool tip and unit tool axis (tip to holder) in the table frame.
struct TablePose {
  Vec3 tip_mm = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();
};

/// Commanded axis positions. `rotary_rad[k]` belongs to `KinematicChain::rotary(k)`; unused entries are 0.
struct Joints {
  Vec3 linear_mm = Vec3::Zero();  ///< X Y Z of the gauge point, machine coordinates
  std::array<double, 2> rotary_rad = {0.0, 0.0};
};

/// One branch of the inverse. Angles lie within half a turn of the axis' zero; `windings` gives the other turns.
struct JointSolution {
  Joints joints;
  int pair = 1;  ///< 1 or 2, the columns "pair 1" and "pair 2" of an AC, BC or AB machine; see rotary_solutions
  int free_rotary =
      -1;  ///< index of the rotary axis that this pose leaves free (a pole); it is set to its zero. -1: none
};

/// A joint outside its range.
struct LimitViolation {
  char letter = 'X';
  bool rotary = false;
  double value = 0.0;   ///< mm or rad
  double limit = 0.0;   ///< the limit that is exceeded, margin already subtracted; mm or rad
  bool above = true;    ///< value lies above the limit; else below it
  double margin = 0.0;  ///< that was subtracted; mm or rad
  /// "Y = 212.4183 mm exceeds 200.0000" or "A = 131.2000 deg is below -120.0000"; of a value that only the margin
  /// excludes, the margin's key.
  [[nodiscard]] std::string text() const;
};

/// How close to a limit a command may come.
struct LimitMargin {
  double linear_mm = 0.1;
  double rotary_rad = radians(0.01);
};

/// The bed among the letters of `KinematicChain::order`.
inline constexpr char kBedMark = '-';

struct KinematicChain {
  std::array<LinearAxis, 3> linear{};  ///< X, Y, Z
  std::vector<RotaryAxis> table;       ///< from the work outwards: T1, T2
  std::vector<RotaryAxis> head;        ///< from the ram outwards: H1, H2
  /// Letters of all axes from the work to the tool with '-' for the bed, where the file says it: "CA-XYZ" if it does
  /// not. For bodies of the machine (machines/links.h): the tool over the work moves in the same way whatever it says.
  std::string order = {};

  /// Number of rotary axes, 0 to 2.
  [[nodiscard]] std::size_t rotary_count() const { return table.size() + head.size(); }
  /// Rotary axis k: first the table's, then the head's. The tool axis in the table frame is R(0) R(1) e_z.
  [[nodiscard]] const RotaryAxis& rotary(std::size_t k) const {
    return k < table.size() ? table[k] : head[k - table.size()];
  }
  [[nodiscard]] bool in_table(std::size_t k) const { return k < table.size(); }
  /// Index of the rotary axis with this letter; empty when the chain has none.
  [[nodiscard]] std::optional<std::size_t> rotary_index(char letter) const;
  /// Letters of all axes in the order of the joints, e.g. "XYZCA".
  [[nodiscard]] std::string letters() const;

  /// Tip and axis in the table frame.
  /// @param tool_length_mm gauge point to tip, > 0
  [[nodiscard]] TablePose forward(const Joints& joints, double tool_length_mm) const;

  /// Tool axis in machine coordinates (only head axes move it).
  [[nodiscard]] Vec3 tool_axis_in_machine(const std::array<double, 2>& rotary_rad) const;

  /// A point of the table frame, in machine coordinates at these table angles.
  [[nodiscard]] Vec3 table_to_machine(const Vec3& point_mm, const std::array<double, 2>& rotary_rad) const;

  /// Rotary angles that give the tool this axis, limits ignored: 1 or 2 solutions, closed form.
  ///
  /// Pair 1 is the one with positive tilt when the spindle can be parallel to the plane of both rotary axes (AC, BC),
  /// else the one on the spindle's own side of that plane (AB: |b| <= 90 deg). Exact to 1e-12 rad against the closed
  /// forms of AC, BC and AB; no digits are lost at the pole. At a pole (axis within 1e-13 rad of the first rotary axis)
  /// one solution per tilt, `free_rotary` set. `joints.linear_mm` is not filled in.
  /// @param axis unit vector, table frame
  /// Errors: the axis is no unit vector (to 1e-9); no angle reaches it; the message names the rotary axis and the angle
  /// by which it is missed.
  [[nodiscard]] Result<std::vector<JointSolution>> rotary_solutions(const Vec3& axis) const;

  /// Joints for a tip position, the rotary angles given (any winding, any branch).
  [[nodiscard]] Joints linear_for(const Vec3& tip_mm, const std::array<double, 2>& rotary_rad,
                                  double tool_length_mm) const;

  /// All solutions for a pose, limits ignored, windings not expanded. forward(inverse) is the identity to 1e-12 rad and
  /// 1e-9 mm (coordinates up to 1 m). Errors: as rotary_solutions.
  [[nodiscard]] Result<std::vector<JointSolution>> inverse(const TablePose& pose, double tool_length_mm) const;

  /// inverse with every winding of 360 deg inside the rotary limits (`windings`), joints outside their limits left out;
  /// ordered by pair, then by angle. A free rotary axis stands at the allowed angle nearest to `free_angle_rad` and is
  /// not wound. An empty list does not occur. Errors: as inverse; no candidate inside the limits (the message names
  /// axis, value, limit and the value of the other solution).
  [[nodiscard]] Result<std::vector<JointSolution>> candidates(const TablePose& pose, double tool_length_mm,
                                                              const LimitMargin& margin = {},
                                                              double free_angle_rad = 0.0) const;

  /// Every joint outside its range minus margin, in the order of `letters()`.
  [[nodiscard]] std::vector<LimitViolation> violations(const Joints& joints, const LimitMargin& margin = {}) const;

 private:
  Vec3 gauge_shift(const std::array<double, 2>& rotary_rad) const;  ///< h of the head angles: gauge point minus J
  Result<std::vector<JointSolution>> one_rotary(const Vec3& axis) const;
};

/// Names the key of a margin, mm or rad, for a command that stands inside the limits of its axis but within the margin:
/// ": inside the limit, but nearer to it than limits.limit_margin_angle = 0.01 deg".
[[nodiscard]] std::string margin_words(bool rotary, double margin);

/// command_rad + k * 360 deg for every whole k that lies in the limits minus margin, ascending; empty when there is
/// none. Of an axis that rolls over: the one within half a turn of its zero.
[[nodiscard]] std::vector<double> windings(const RotaryAxis& axis, double command_rad, double margin_rad = 0.0);

/// Refuses chains that no inverse can serve: more than two rotary axes, a direction that is no unit vector, two
/// parallel rotary axes, a second rotary axis parallel to the spindle (it turns the tool about itself and cannot tilt
/// it).
[[nodiscard]] Status check_chain(const KinematicChain& chain);

}  // namespace toothpath::machines
