// From proven cutter location data to the words of the machine's axes: solution choice, safe sequences, subdivision
// of the non-linear error, block times, the index loop over the teeth, travel check. Still free of any dialect.
//
// CL records are tooth space 0 in the gear frame W; space k is the same turned by 2 pi k / z about gear z. Where the
// gear axis is the axis of the rotary that carries the work, space k is the same blocks with that rotary k * 360 / z
// further on, and the program holds one tooth and the loop. Everywhere else all teeth are written out.
//
// Words are kept as integers (multiples of the last printed digit), so that what is checked here is what is printed.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cam/proof/checked_cl_path.h"
#include "cam/tool/assembly.h"
#include "cam/tool/cutters.h"
#include "geometry/base/result.h"
#include "machines/machine.h"
#include "postproc/choice/travel_offer.h"
#include "postproc/joints/setup.h"
#include "postproc/timing/path_timer.h"

namespace toothpath::joints {

/// Decimals of the printed words: mm and degrees. A property of the dialect.
struct WordFormat {
  int linear_decimals = 4, rotary_decimals = 5;
};

/// Part and fixture as a cylinder about the gear axis, W, mm. Rapids in X and Y stay above it; rotaries turn above
/// everything that it sweeps.
struct ClearanceBody {
  double radius_mm = 0, z_min_mm = 0, z_max_mm = 0;
};

struct AxisOptions {
  WordFormat format;
  double chord_mm = 5e-4;          ///< greatest distance of the tip from the CL chord inside a block (spec section 3)
  double axis_rad = 1e-3;          ///< greatest deviation of the tool axis inside a block
  double nc_step_mm = 2e-3;        ///< greatest error of the tip that rounding the words may cause; else refused
  double clearance_margin_mm = 5;  ///< between the clearance body and the tool tip on rapids
  double max_inverse_time =
      0;  ///< greatest F in G93 that the control takes, 1/min; 0: no limit. Faster blocks are slowed
  bool index_is_rounded = false;  ///< the angle of a tooth is printed, with the last digit of a rotary
  bool search_origin = true;      ///< look for the set-up with the most room in the travels
  bool expand_teeth = false;      ///< write every tooth out even where the loop would do
  bool pack_teeth = false;        ///< of teeth that are written out hold the first one as blocks, the others packed
  int tooth_stride = 1;           ///< place n of the order cuts tooth n * stride mod z (tooth_order.h); 1: the sequence
  bool tcp_starts_at_zero =
      false;  ///< TCP freezes the table frame where it is switched on: only with the rotaries at zero
  bool cutter_locations =
      false;  ///< the text has tips and tool axes alone: it does not say how the top of Z is reached
  timing::Corners corners = timing::Corners::jump;  ///< how the control joins feed blocks
  /// While TCP is on the dialect can turn the frame of a loop about the gear axis.
  bool tcp_loop = false;
  bool tcp_frame_is_table = false;  ///< .. and that frame is the table's at the angle of the tooth
  /// Why not, where it cannot.
  const char* no_tcp_loop = "with TCP this control has no frame that a program could turn about the gear axis";
  /// Cuts stand in tilted planes of the control, without TCP; the place that asks for it. A tool that stands along the
  /// first rotary has no plane: its words stay joints.
  std::optional<SourcePosition> tilted_planes = std::nullopt;
};

/// Tilted planes of a table whose rotaries turn about Z and about X or Y, as their words say them: a plane is turned by
/// the first rotary about Z, then tilted by the second about its own X or Y. X Y Z of its blocks are coordinates of the
/// tip in it, from its origin.
struct PlaneForm {
  Vec3 origin_mm = Vec3::Zero();       ///< seen from the work offset, all rotaries at zero; as it is printed
  std::array<std::int64_t, 2> zero{};  ///< words of the rotaries at their zeros
  int turn_sign = 1;                   ///< +1: a greater word of the first one turns the plane right-handed about +Z
  int tilt_sign = 1;                   ///< the same of the second one about +X or +Y
  bool about_y = false;                ///< it tilts about Y

  /// The words of these blocks are those of a plane.
  [[nodiscard]] bool tilted(const std::array<std::int64_t, 5>& words) const { return words[4] != zero[1]; }
};

/// Planes of a machine, their origin that of the work offset.
/// Errors: the table has no two rotaries, one about Z and the other about X or Y, or the head has one.
[[nodiscard]] Result<PlaneForm> plane_form_of(const machines::KinematicChain& chain, const WordFormat& format);

enum class BlockKind : std::uint8_t {
  feed,          ///< G1, all axes; inverse time without TCP, feed of the tip with it
  rapid_z,       ///< G0, Z alone
  rapid_xy,      ///< G0, X and Y
  rapid_rotary,  ///< G0, both rotaries, no linear word
  tcp_on,        ///< switches TCP on; with `tcp_starts_at_zero` it moves Z to its word, else nothing moves
  tcp_off,       ///< switches TCP off; with `tcp_starts_at_zero` Z goes to its top, else nothing moves
  rapid_tip,     ///< G0 with TCP: the tip goes straight, the rotaries stand
  turn,          ///< G1 with TCP, rotary words alone: the tip stands still on the table
};

/// One block. Words: X Y Z [10^-linear_decimals mm, work coordinates with tool length compensation on], then the two
/// rotaries in the order of the machine's axes [10^-rotary_decimals deg]. In a loop the index rotary is that of tooth
/// 0. With TCP the linear words are the tip in the table frame, seen from the work offset.
struct AxisBlock {
  std::array<std::int64_t, 5> words{};
  double minutes = 0;         ///< that the machine needs or is told, from the rounded words
  double run_minutes = 0;     ///< the same with the accelerations of the axes; 0: the machine states none
  double per_minute = 0;      ///< with TCP: feed of the tip, mm/min; of the rotaries where the tip stands, deg/min
  Vec3 axis = Vec3::UnitZ();  ///< with TCP: tool axis at the end of the block, table frame
  std::int32_t record = -1;   ///< index of the CL record that the block goes to; -1: a link
  BlockKind kind = BlockKind::feed;
  std::uint8_t ruler = 0;  ///< feed blocks: the entry of `time_rulers` that decided the time
  bool forced = false;     ///< print every word of the kind: first block after a break
  bool tip = false;        ///< the linear words are the tip in the table frame (TCP is on)
};

/// Blocks in a fifth of the room, all but their `run_minutes`. Rulers are below 8.
class PackedBlocks {
 public:
  void pack(const std::vector<AxisBlock>& blocks);
  void unpack(std::vector<AxisBlock>& blocks) const;
  [[nodiscard]] bool empty() const { return count_ == 0; }

 private:
  std::vector<unsigned char> bytes_;
  std::size_t count_ = 0;
};

/// The blocks of one tooth of one operation. Starts and ends at a height where the rotaries may turn.
struct ToothBlocks {
  int tooth = 0;  ///< space index; in a loop 0
  std::vector<AxisBlock> blocks;
  std::string remark = {};  ///< stands in the text instead of "TOOTH k"; empty: that
  bool pause = false;       ///< the program stops behind the blocks until it is started again
  /// Of a program without a loop: the words of its `index_axis` count from here, deg, until those of another tooth do
  /// not. TCP is off where it changes.
  std::optional<double> zero_deg = {};
  PackedBlocks packed = {};  ///< instead of `blocks`, where the options ask for it

  void pack();
  void unpack();
  void release();  ///< no blocks, and no room for them
  /// The blocks, however they are held. @param room  for those that are packed
  [[nodiscard]] const std::vector<AxisBlock>& all(std::vector<AxisBlock>& room) const;
};

/// Some feed block of a tooth moves a rotary.
[[nodiscard]] bool turns_in_cut(const std::vector<AxisBlock>& blocks);

/// How far a control may leave the path of one operation: the tip, and every rotary with TCP.
struct CornerGrant {
  double mm = 0, axis_deg = 0;
};

/// Run time over all teeth.
struct TimedMinutes {
  double feed = 0, rapid = 0;
};

struct AxisOperation {
  int operation = 0;  ///< index in the job
  std::string type;
  int tool_number = 0;
  double tool_length_mm = 0;
  std::string tool_name;                  ///< what cutter it is, for the header comment
  std::vector<std::string> shop_names;    ///< what the shop calls tool and holder, for comments
  std::optional<tool::AptCutter> cutter;  ///< for cutter location data
  double spindle_rpm = 0;
  std::optional<CornerGrant> wide_corners;  ///< a later operation takes what these leave; none: those of the program
  double corner_tolerance_mm = 0;           ///< what `wide_corners` makes of AxisProgram::corner_tolerance_mm; 0: that
  std::vector<ToothBlocks> teeth;           ///< one entry in a loop, else one a tooth in the order of the program
  int first_place = 0;  ///< where the order begins; not 0 only where the operation stands here in part
  int end_place = -1;   ///< behind its last place; -1: the order ends
  double feed_minutes = 0, rapid_minutes = 0;  ///< over all teeth
  TimedMinutes accelerated;           ///< the same with the accelerations of the axes, where the machine states them
  std::vector<double> tooth_minutes;  ///< .. and of every entry of `teeth` what its G1 take
  int sister_of = 0;                  ///< T in whose place the tool goes on; 0: it is the job's
  [[nodiscard]] int end_of(int teeth_of_gear) const { return end_place < 0 ? teeth_of_gear : end_place; }
  [[nodiscard]] int places(int teeth_of_gear) const { return end_of(teeth_of_gear) - first_place; }
  double clamp_minutes = 0;  ///< on top: what clamping the rotaries takes (text::note_clamp_times)
  /// The tool is checked ahead of the teeth, behind them (text::note_tool_checks).
  bool check_ahead = false, check_behind = false;
  double check_tolerance_mm = 0;  ///< .. and the program stops where its length is further off
  double check_minutes = 0;       ///< .. on top of all times
};

/// Least and greatest position of one axis over all teeth, against its limits [mm or rad, machine coordinates].
struct AxisRange {
  char letter = '?';
  bool rotary = false;
  double min = 0, max = 0, lower_limit = 0, upper_limit = 0;
  /// The rotary rolls over: its positions go on beyond a turn and it has no limits.
  [[nodiscard]] bool endless() const { return std::isinf(upper_limit); }
};

/// Where a program begins that leaves out what was cut before.
struct ProgramRestart {
  int operation = 0, tooth = 0;
};

/// One of several programs that are run one after the other: teeth of one operation.
struct ProgramPart {
  int number = 1, count = 1;  ///< the first is 1
  int operation = 0;
  int first_place = 0, end_place = 0;  ///< in the order of the teeth
};

/// A tool that lasts so long, as a program uses it.
struct ToolUse {
  int tool = 0, sister_of = 0;  ///< T; `sister_of` 0: it is the job's
  double life_min = 0;
  struct Stretch {
    int operation = 0, first_place = 0, end_place = 0;  ///< in the order of the teeth
    double minutes = 0;                                 ///< of its G1
  };
  std::vector<Stretch> stretches;
  [[nodiscard]] double minutes() const {
    double sum = 0;
    for (const Stretch& s : stretches) sum += s.minutes;
    return sum;
  }
};

struct AxisProgram {
  WordFormat format;
  std::array<char, 5> letters{};   ///< X Y Z and the two rotaries; 0: no such axis
  std::array<bool, 5> rollover{};  ///< the control counts the rotary within one turn; words here go on beyond it
  int teeth = 1;
  bool loop = false;                      ///< one tooth is held; the index rotary turns it
  const char* no_loop = "";               ///< why every tooth is written out though the options ask for a loop
  int tooth_stride = 1;                   ///< as in the options
  std::optional<ProgramRestart> restart;  ///< the program begins there, not at its beginning
  std::optional<ProgramPart> part;        ///< it holds that alone
  std::vector<ToolUse> tool_uses;         ///< of tools whose life is stated, in the order of the whole program
  int index_axis = -1;                    ///< 3 or 4: which word is shifted by the index
  int index_sign = 1;                     ///< word of tooth k = word + index_sign * k * 360 / z
  machines::TcpMode tcp = machines::TcpMode::none;  ///< how the blocks of a cut are meant
  std::optional<PlaneForm> planes;                  ///< cuts stand in tilted planes
  bool turns_in_cuts = false;                       ///< some feed block moves a rotary; the index does not count
  double tip_reach_mm = 0;  ///< greatest distance of the tip from a rotary axis in blocks that turn, without TCP
  bool tcp_starts_at_zero = false;  ///< as in the options
  int frame_sign = 1;       ///< loop with TCP: the frame of tooth k is turned by frame_sign * k * 360 / z about +Z
  double retract_z_mm = 0;  ///< G53 Z, machine coordinates of the gauge line
  std::string work_offset = "G54";
  Vec3 work_offset_at_mm = Vec3::Zero();
  std::vector<AxisOperation> operations;
  std::vector<AxisRange> ranges;         ///< over all teeth and operations, G53 retract included
  std::vector<std::string> time_rulers;  ///< names of the terms of the block time
  std::vector<std::size_t> time_ruled;   ///< how many feed blocks each of them decided (one tooth in a loop)
  std::vector<std::string> assumed;      ///< machine data that nobody measured
  double minutes = 0, feed_minutes = 0;  ///< over all teeth, tool changes left out
  double rounding_bound_mm = 0;          ///< proven: rounding the words moves the tip by no more (section 4)
  double chord_bound_mm = 0;             ///< proven: the tip leaves the CL chord inside a block by no more (section 3)
  double axis_bound_rad = 0;             ///< the same for the tool axis
  std::vector<path::ClPath>
      followed;                   ///< the paths where poles were handled by changing them (tooth 0); empty: as given
  std::size_t pole_passages = 0;  ///< of tooth 0, handled
  double pole_axis_rad = 0;       ///< proven: handling poles moves the tool axis by no more ..
  double pole_tip_mm = 0;         ///< .. and the tip, about the centre of the ball, which stays
  bool has_acceleration = false;  ///< the machine states them: `accelerated` is filled in
  timing::Corners corners = timing::Corners::jump;  ///< as in the options, or as the text says
  double corner_tolerance_mm = 0;                   ///< of `round` and `way`
  std::string time_model;                           ///< what the times hold and assume
  TimedMinutes accelerated;                         ///< over all operations
  double clamp_minutes = 0;                         ///< on top of all times, over all operations
  double check_minutes = 0;                         ///< the same of checks of the tools
  double check_uncertainty_mm = 0;                  ///< a checked tool has the length that was measured, off by so much
  std::optional<choice::TravelOffer> offer;         ///< empty: not looked for, or too many directions of the part
  std::size_t inserted_blocks = 0;                  ///< by the subdivision
  std::size_t dropped_blocks = 0;                   ///< all words equal to those before
};

/// Builds the program for one set-up. `tools` are indexed by ClPath::tool; `teeth` = z >= 1.
///
/// Errors (kind verification for travel, refused_input for the rest): pose that the machine cannot reach, travel
/// exceeded (record, tooth, axis, value, limit, and the shift of the set-up that would fit, if there is one), rotary
/// reposition with no safe height, no continuous solution inside a pass, rounding coarser than nc_step_mm.
[[nodiscard]] Result<AxisProgram> build_axis_program(std::span<const proof::CheckedClPath> paths,
                                                     std::span<const tool::ToolAssembly> tools, const Setup& setup,
                                                     const machines::Machine& machine, int teeth,
                                                     const ClearanceBody& body, const AxisOptions& options = {});

/// For tests of this folder alone: the same from paths that no check has passed.
struct AxisProgramTestAccess {
  static Result<AxisProgram> build(std::span<const path::ClPath> paths, std::span<const tool::ToolAssembly> tools,
                                   const Setup& setup, const machines::Machine& machine, int teeth,
                                   const ClearanceBody& body, const AxisOptions& options = {});
};

}  // namespace toothpath::joints
