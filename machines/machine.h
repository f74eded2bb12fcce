// A milling machine as its file describes it: kinematic chain, limits, control and what of it is assumed.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/base/diagnostic.h"
#include "machines/body.h"
#include "machines/coolant.h"
#include "machines/kinematic_chain.h"
#include "machines/tool_check.h"

namespace toothpath::machines {

enum class MachineKind { five_axis, gear_shaper };

/// What the control does with the tool tip during a block.
enum class TcpMode {
  none,     ///< nothing: the five joints move linearly
  angles,   ///< keeps the tip on the chord, rotary words are angles (G43.4, TRAORI + ORIAXES, TCPM ... AXIS)
  vectors,  ///< keeps the tip on the chord, tool axis as a vector (G43.5, TRAORI + ORIVECT, TCPM ... VECTOR)
};

/// What tool length and programmed point refer to (ball tools).
enum class LengthReference { tip, centre };

/// What the post does where the tool axis comes parallel to the first rotary axis.
enum class PoleOption { error, tilt, hold, through, slow, retract };

/// Lines of the shop that programs carry; templates with the names of docs/dialects.md in braces.
struct OwnLines {
  std::vector<std::string> start;                       ///< behind the start of the control
  std::optional<std::vector<std::string>> tool_change;  ///< instead of the lines that fetch a tool
  std::vector<std::string> between_teeth;               ///< behind every tooth of an operation
  std::vector<std::string> end;                         ///< ahead of the end of the program
};

/// Preferences of this machine; what is empty is left to the dialect.
struct PostSettings {
  std::optional<int> linear_decimals;  ///< digits after the point of X Y Z, 0..9
  std::optional<int> rotary_decimals;  ///< of A B C in degrees, 0..9
  std::optional<bool> index_loop;      ///< tooth indexing as a loop or sub-program (true) or written out (false)
  /// A work offset that programs may overwrite: with TCP they turn it to every tooth (LinuxCNC). Empty: they may none.
  std::string index_offset;
  /// The control is set so that its transformation takes the rotary offset of the frame in force when it is switched on
  /// (Siemens, 24590 TRAFO5_ROT_OFFSET_FROM_FRAME): the part's frame turns with a moved zero.
  bool transformation_takes_rotary_offset = false;
  std::vector<std::string> tcp_on;   ///< blocks that switch TCP on, e.g. {"M428"}
  std::vector<std::string> tcp_off;  ///< and off
  /// Blocks that switch the control's own smoothing on ahead of the teeth of an operation and off behind them; empty:
  /// the dialect's way.
  std::vector<std::string> smoothing_on, smoothing_off;
  std::optional<double>
      smoothing_tolerance_mm;  ///< stated by the shop: the tip leaves the path by no more while it is on
  std::optional<double>
      smoothing_axis_tolerance_rad;           ///< the same of the tool axis; not stated: no cut may turn a rotary
  std::optional<double> corner_tolerance_mm;  ///< the tip is off a corner by no more: LinuxCNC in exact path mode,
                                              ///< Fanuc and the like in G64
  std::map<Coolant, CoolantWords>
      coolant;  ///< words of the builder, instead of those of the control or where it has none
  /// Where G28 and G30 (G75 FP=1 and FP=2, the zero of M92) take the axes, machine coordinates: X Y Z [mm], then the
  /// rotaries in the order of their letters in the file [deg]. Empty: not said.
  std::array<std::vector<double>, 2> reference_positions;
  bool retracts_to_reference = false;  ///< G28 takes Z to its top, to where `reference_positions[0]` is; else G53
  OwnLines own_lines;
  LengthReference length_reference = LengthReference::tip;
  PoleOption pole = PoleOption::error;
  std::optional<double> pole_angle_rad;  ///< `tilt`: least angle kept from the pole; `hold`, `through`, `retract`:
                                         ///< greatest change of the axis
};

struct Machine {
  std::string name;
  std::string file;  ///< path as it was opened, for messages
  MachineKind kind = MachineKind::five_axis;
  std::string dialect;  ///< "linuxcnc", "fanuc", ...: lower case; which ones exist is the post's business
  TcpMode tcp = TcpMode::none;
  bool assumed = false;  ///< true: at least one value is assumed
  std::vector<std::string>
      assumed_keys;               ///< dotted names, `axes.A.point`; of `assumed = true`, every value of the file
  int max_simultaneous_axes = 5;  ///< axes that the control interpolates in one block

  double max_spindle_speed = 0.0;          ///< 1/min
  std::optional<double> tool_change_min;   ///< from cut to cut, when stated
  double max_cutting_feed = 0.0;           ///< mm/min
  double table_diameter_mm = 0.0;          ///< largest circle that fits on the table
  std::optional<double> table_face_mm;     ///< Z of its face, machine coordinates, rotaries at zero, when stated
  std::optional<double> part_diameter_mm;  ///< largest part that turns on the rotary table, when stated
  std::optional<double> max_part_mass_kg;  ///< when stated
  double min_block_ms = 1.0;               ///< shortest block that the control keeps up with
  double feed_factor = 2.0;                ///< a program that is checked may cut so many times as fast as its job says
  double speed_factor = 1.25;              ///< and its spindle may be so many times as fast or as slow
  LimitMargin limit_margin;

  /// Place of every table and key of the file by its dotted name, `post.corner_tolerance`: for those who judge them
  /// later.
  std::map<std::string, SourcePosition, std::less<>> positions;

  KinematicChain chain;
  std::vector<MachineBody> bodies;  ///< in the order of the file; empty: none is stated
  PostSettings post;
  std::optional<ToolCheck> tool_check;  ///< not stated: no program checks a tool

  /// Place of a key that stands in the file, else the file alone.
  [[nodiscard]] SourcePosition where(std::string_view key) const;
  /// How far the tip may be off a corner that the control takes exactly [mm]: `post.corner_tolerance` if stated, else
  /// 0.0005 or, if the axes have accelerations, what those leave at the rim of the largest part and a servo period of 1
  /// ms if that is more (LinuxCNC, docs/dialects.md).
  [[nodiscard]] double exact_corner_mm() const;
  /// Z to which programs retract, machine coordinates of the gauge line [mm]: the end of its travel less
  /// `limit_margin`, or that of the reference position where `post.retract` says so.
  [[nodiscard]] double top_mm() const;
  /// Every axis of the chain has an acceleration.
  [[nodiscard]] bool has_acceleration() const;
  /// Every axis of the chain has a jerk.
  [[nodiscard]] bool has_jerk() const;
  /// Highest place, straight below `at` (machine coordinates, joints at zero), of the boxes and upright cylinders and
  /// cones that carry the work; mm. Nothing: none is stated there.
  [[nodiscard]] std::optional<double> top_under(const Vec3& at) const;
  /// Middle of the table's face, all rotaries at zero: of the first rotary axis under the work the place at
  /// `table_face_mm`, or its point where no face is stated. Only where a rotary axis carries the work.
  [[nodiscard]] Vec3 table_middle_mm() const;
  /// Largest part that turns on the table: `part_diameter_mm` if stated, else `table_diameter_mm`.
  [[nodiscard]] double largest_part_mm() const { return part_diameter_mm.value_or(table_diameter_mm); }
};

/// Refuses a part whose outside diameter [mm] does not fit the machine.
[[nodiscard]] Status check_part_fits(const Machine& machine, double part_diameter_mm);

}  // namespace toothpath::machines
