// Reads an NC program back: an interpreter of the two dialects that we write, the machine's forward kinematics, and
// the comparison with the path that was asked for. It shares no code with the writer.
//
// The interpreter executes every tooth of an index loop; what is kept is the first tooth of each operation when the
// others are proven to be turned copies (same linear words bit for bit, the index rotary further by k * 360 / z), and
// the link from the first tooth to the second.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cam/path/cl_path.h"
#include "cam/path/tool_motion.h"
#include "cam/proof/rapid_clearance.h"
#include "cam/tool/assembly.h"
#include "cam/tool/cutters.h"
#include "geometry/base/result.h"
#include "machines/machine.h"
#include "postproc/joints/program.h"
#include "postproc/joints/setup.h"
#include "postproc/timing/path_timer.h"

namespace toothpath::readback {

struct NcControl;
struct ExecutedMove;
using MoveSink = std::function<void(const ExecutedMove&)>;

/// Reader of a language: executes `text` and hands every move to `sink`. It shares no code with a writer, and refuses
/// what is not in its subset with line and column.
using NcExecute = Status (*)(std::string_view text, const std::string& file, const NcControl& control,
                             const MoveSink& sink);

/// What the control knows beside the text. Made by controls::control_of.
struct NcControl {
  NcExecute execute = nullptr;    ///< reader of its language
  bool cutter_locations = false;  ///< the text has places of the tool: a post processor makes the moves of the axes
  std::array<char, 5> letters{};  ///< X Y Z and the rotaries in the machine's order; 0: none
  std::array<double, 5> rapid_speed{};                         ///< mm/min and deg/min
  std::array<std::optional<machines::RotaryClamp>, 5> clamps;  ///< of the rotaries that the builder can hold
  std::array<bool, 5> rollover{};                              ///< the control counts this rotary within one turn
  std::map<int, double> tool_length_mm;                        ///< by T and H number
  std::map<int, tool::AptCutter> cutters;    ///< by T number; of those that cutter location data can state
  std::map<std::string, Vec3> work_offsets;  ///< "G54" -> origin, machine coordinates, mm
  double rotary_rounding_deg = 0.5e-5;       ///< half the last digit that the dialect prints
  double linear_rounding_mm = 0.5e-4;        ///< the same of the linear words
  std::optional<machines::KinematicChain>
      chain;  ///< of a machine with TCP: the control knows it; empty: TCP is refused
  /// Of a machine whose control turns tilted planes into angles of its rotaries; empty: its planes are refused.
  std::optional<machines::KinematicChain> plane_chain;
  double shortest_feed_minutes = 0;  ///< of a block with the largest F of G93; 0: F has no limit
  double exact_path_mm = 0.0005;     ///< LinuxCNC: the tip is off a corner by no more under G61 and G61.1
  std::optional<double> corner_mm;   ///< the machine file states it: the tip is off a corner by no more under G64
  /// Where G28 and G30 take the axes, machine coordinates, mm and deg; nothing: the machine file does not say.
  std::array<std::optional<std::array<double, 5>>, 2> reference;
  /// Lines that check a tool, and the tolerance of its length by T; nothing: the machine has no such check.
  std::optional<machines::ToolCheck> tool_check;
  std::map<int, double> check_tolerance_mm;
  double top_mm = 0;  ///< highest Z, machine coordinates of the gauge line
  /// TCP takes the zeros of rotaries as its own where its rules ask (PostSettings).
  bool transformation_takes_rotary_offset = false;
  std::string index_offset;                  ///< work offset that programs may write (LinuxCNC); empty: none
  std::vector<std::string> tcp_on, tcp_off;  ///< codes of the site that switch TCP (LinuxCNC)
  /// Lines of the machine file that switch the control's own smoothing on and off, and what the shop states for it.
  std::vector<std::string> smoothing_on, smoothing_off;
  double smoothing_mm = 0;
  std::optional<double> smoothing_axis_rad;  ///< not stated: no cut may turn a rotary while it is on
  std::vector<std::string> coolant_words;    ///< M words of the builder that switch coolants, on and off
  std::map<machines::Coolant, machines::CoolantWords> coolants;  ///< all that can be switched, and by which words
  timing::Corners corners = timing::Corners::jump;               ///< how it joins feed blocks
  /// Sees the blank that the text states for the graphics, and its line; may be empty.
  std::function<void(const joints::GraphicsBlank&, std::int32_t line)> blank;
  bool dry_run = false;  ///< feed moves with a standing spindle are meant: a program that runs in air
  /// Executed blocks before the program is refused as endless; `execute_nc` allows a text of few lines fewer: 8192 for
  /// each line, but 2 000 000 at least.
  std::size_t max_steps = 50'000'000;
  std::size_t max_idle = 2'000'000;  ///< of them in a row without a move

  [[nodiscard]] bool switches_coolant(std::string_view word) const {
    return std::find(coolant_words.begin(), coolant_words.end(), word) != coolant_words.end();
  }
  /// The axis that a word clamps or releases, 3 or 4; nothing: it does neither.
  [[nodiscard]] std::optional<std::size_t> clamped_by(std::string_view word) const {
    for (std::size_t a = 3; a < 5; ++a)
      if (clamps[a] && (clamps[a]->on == word || clamps[a]->off == word)) return a;
    return std::nullopt;
  }
};

/// End of one executed move: joints in machine coordinates, gauge line (mm) and rotaries as words (deg); those that
/// roll over go on beyond a turn, the same place in two turns differs by a multiple of 360 exactly.
struct ExecutedMove {
  std::array<double, 5> joints{};
  Vec3 tip = Vec3::Zero();  ///< with `tcp`: table frame
  double minutes = 0;
  std::int32_t line = 0;        ///< of the text, from 1
  std::int16_t operation = -1;  ///< from the (OP n type) comment; -1 before the first
  std::int16_t tool = 0;        ///< T in the spindle
  bool rapid = false;
  std::uint8_t commanded = 0;  ///< bit a: the block has a word for axis a
  /// The path mode where the text says it, with P of G64, T of cycle 32, ADIS in tolerance_mm.
  timing::Corners corners = timing::Corners::exact;
  bool tcp = false;          ///< the tip goes straight to `tip`, the rotaries are linear, the other joints follow
  float blend_mm = 0;        ///< the control may leave the corners of the path by this much (G64 P)
  float blend_axis_rad = 0;  ///< the same of the tool axis (TA of cycle 32)
  float corner_path_mm =
      0;  ///< every axis may leave the path within this way ahead of and behind a corner (G641 ADIS) ..
  float corner_share = 0;   ///< .. which is this part of the block, a half at most
  std::int16_t tooth = -1;  ///< from a (TOOTH k) comment, where the teeth are written out; -1: none
  std::int16_t piece = -1;  ///< how many comments of operations stand ahead of that of `operation`
  float tolerance_mm = 0;
  float dwell_min = 0;             ///< the program waits ahead of the move
  bool machine : 1 = false;        ///< G53, or the block that switches tool length compensation on
  bool known : 1 = false;          ///< all joints were known before and after
  bool in_doubt : 1 = false;       ///< a stop ahead may have ended spindle and coolant: the builder's business
  bool plane : 1 = false;          ///< in a tilted plane, or the turn of the rotaries to it
  bool offset_unseen : 1 = false;  ///< turn and rotaries of the work offset are taken as 0, the program did not look
  bool checked : 1 = false;        ///< the tool was checked since it came into the spindle
  std::uint8_t clamped = 0;        ///< bit a: the rotary is held
  std::uint8_t coolants = 0;       ///< machines::bit_of: it is on
  float speed_rpm = 0;             ///< of the spindle; 0: it stands
  std::uint64_t vector_print = 0;  ///< of the words of a tool vector, FNV-1a over their bytes; 0: rotary words
};

/// How far the length of the tool may be off in this move: where a check ahead has let the control measure it, mm.
[[nodiscard]] inline double length_off_mm(const ExecutedMove& move, const std::optional<machines::ToolCheck>& check) {
  return move.checked && check ? check->uncertainty_mm.value_or(0) : 0;
}

/// Executes `text` and hands every move to `sink`, in order. Stops with a located error (line and column of `file`) at
/// anything that is not in the subset, at an undefined tool, offset, label or parameter, at a feed move without F or
/// without spindle, at G1 in G94 with rotary and linear words whose time is not exact, and beyond max_steps.
[[nodiscard]] Status execute_nc(std::string_view text, const std::string& file, const NcControl& control,
                                const MoveSink& sink);

/// What is said of a program that has executed so many blocks and does not end.
[[nodiscard]] std::string too_many_blocks(std::size_t limit);

/// Joints inside a block whose tip goes straight, every half degree of the rotaries.
void follow_tip(const ExecutedMove& from, const ExecutedMove& to, const NcControl& control,
                const machines::KinematicChain& chain, const std::function<void(const std::array<double, 5>&)>& sink);

/// Are the teeth of every operation turned copies of its first one?
struct TurnedCopies {
  bool copies = false;
  int line = 0;                ///< first place that differs, of the text; 0 when copies
  std::string difference;      ///< what differs there
  double worst_shift_deg = 0;  ///< greatest distance of an index word from k * 360 / z
  struct Operation {
    int operation = 0;
    std::size_t moves_per_tooth = 0;  ///< G53 retracts before and after left out
    std::vector<int> turns;           ///< copy number -> tooth space
    /// An operation that is taken up again, with another tool: where its teeth begin among its moves, and how many
    /// copies stand ahead of them. One piece where it is not.
    struct Piece {
      std::size_t begin = 0, copies = 0;
      std::size_t lead = 0;  ///< machine moves of the piece ahead of them
    };
    std::vector<Piece> pieces;
    /// Tooth space of a move of the operation; there is a copy at least.
    [[nodiscard]] int turn_of(std::size_t move) const {
      std::size_t copy = 0;
      for (const Piece& p : pieces)
        if (move >= p.begin) copy = p.copies + (move - p.begin) / moves_per_tooth;
      return turns[std::min(copy, turns.size() - 1)];
    }
  };
  std::vector<Operation> operations;
};

/// Moves kept of one operation.
struct OperationTrace {
  int operation = 0;
  int tool = 0;                ///< T
  std::size_t kept_teeth = 0;  ///< 1 when the others are proven copies, else all
  std::size_t lead = 0;        ///< moves before the first tooth (retracts)
  std::vector<ExecutedMove> moves;
  std::size_t before = 0, after = 0;  ///< of the moves, at both ends: those of the neighbours, there for their corners
};

struct ReadBack {
  TurnedCopies copies;
  /// The teeth are written out, named and one behind the other: of every operation the first one is kept, with what
  /// stands ahead of it. walk_teeth() has all.
  bool first_teeth = false;
  std::vector<OperationTrace> operations;
  /// What else is executed: moves ahead of the first operation, from one to the next, and behind the last tooth where
  /// the teeth are copies. Each stretch begins with where it starts from and has one tool.
  std::vector<OperationTrace> between;
  std::array<double, 5> least{}, greatest{};  ///< joints over all executed moves, mm and deg
  std::size_t executed = 0;
  double minutes = 0, feed_minutes = 0;             ///< as the text asks
  timing::Corners corners = timing::Corners::jump;  ///< of the control
  joints::TimedMinutes accelerated;       ///< with the accelerations of the axes; without them as the text asks
  std::map<int, double> cutting_minutes;  ///< of tools whose life was asked about: T -> of its feeds
  struct WornOut {
    int tool = 0, line = 0;  ///< where its life ends
  };
  std::vector<WornOut> worn_out;  ///< of these, those that cut for longer
  /// Largest tolerance of path blending in the feeds of every operation, of all teeth where they are no copies.
  std::map<int, double> blend_mm;
  double length_off_mm = 0;  ///< the same of the lengths that checks of the tools have measured
  int mixed_rapid = 0;  ///< line of the first rapid that moves more than one group of axes, of all executed moves; 0:
                        ///< none does, or cutter locations
};

/// Of the moves that are kept of a program, and again of its motions.
inline constexpr std::size_t kMostKeptBytes = std::size_t(1) << 30;

struct ReadBackOptions {
  int teeth = 1;
  bool keep_all = false;     ///< keep every tooth although they are copies
  bool first_teeth = false;  ///< of teeth that are no copies keep the first ones alone, where walk_teeth() can find all
  std::function<void(const ExecutedMove&)> watch = {};  ///< sees every executed move once, in order; may be empty
  std::map<int, double> life_min = {};                  ///< T -> minutes of cutting that it lasts
  /// A program that needs more moves is refused by their number, before any is kept.
  std::size_t max_kept = kMostKeptBytes / sizeof(ExecutedMove);
};

/// Executes the program to count, to compare the teeth where they may be copies, and where they are not to keep them.
[[nodiscard]] Result<ReadBack> read_back(std::string_view text, const std::string& file, const NcControl& control,
                                         const machines::Machine& machine, const joints::Setup& setup,
                                         const ReadBackOptions& options);

/// All teeth of a program of which the first ones were kept (`read.first_teeth`), in the order of the text, which is
/// executed again. A trace is one tooth of one operation, the first one with what stands ahead of it; each but the
/// first begins where the one before ends.
using TraceSink = std::function<void(OperationTrace&&)>;
[[nodiscard]] Status walk_teeth(std::string_view text, const std::string& file, const NcControl& control,
                                const ReadBack& read, const TraceSink& sink);

/// How far the motion of a cut may leave the straight one that stands for it; 50 times as far in rapids.
struct MotionTolerances {
  double tip_mm = 0, axis_rad = 0;                               ///< above 0
  std::size_t most = kMostKeptBytes / sizeof(path::ToolMotion);  ///< motions; a trace that needs more is refused
};

/// Moves of a trace as straight motions of the tip in W. Moves that turn the axes are cut until the proven distance
/// from the straight motion is within the tolerances; the bound stands in each motion. `tool_length_mm` by T number.
/// Moves whose start is not known (before the machine was positioned) are left out.
[[nodiscard]] Result<std::vector<path::ToolMotion>> tool_motions(const OperationTrace& trace,
                                                                 const TurnedCopies& copies, const NcControl& control,
                                                                 const machines::Machine& machine,
                                                                 const joints::Setup& setup, int teeth,
                                                                 const MotionTolerances& tolerances);

/// The same, put behind `motions`: of a long program there need be only one list.
struct Followed {
  const NcControl& control;
  const machines::Machine& machine;
  const joints::Setup& setup;
  int teeth = 1;
  MotionTolerances tolerances;
  enum class Moves : std::uint8_t { all, rapids, feeds } moves = Moves::all;  ///< that are wanted
  /// Where tool T truly stands at commanded joints, table frame; empty: where the machine file puts it. Moves are cut
  /// into pieces, and pieces bounded, by the file; the ends of the pieces are moved.
  std::function<machines::TablePose(const machines::Joints&, int tool)> truly = {};
};
[[nodiscard]] Status add_tool_motions(const OperationTrace& trace, const TurnedCopies& copies, const Followed& by,
                                      std::vector<path::ToolMotion>& motions);

/// Leaves the moves of the first tooth of every operation, where the teeth are labelled; moves without a label stay.
void keep_first_teeth(ReadBack& read);

/// Every CL record of tooth space 0 met in order by the motions of tooth 0 of the same operation.
struct ClComparison {
  bool complete = false;      ///< every record was met
  double worst_mm = 0;        ///< greatest distance of a record from the motion that meets it
  double worst_axis_rad = 0;  ///< the same for the axis
  double worst_extra_mm =
      0;                     ///< greatest distance of a feed motion from the CL polyline (blocks that nobody asked for)
  double fastest_ratio = 0;  ///< greatest mean tip speed between two records, as a multiple of the record's feed
  int missed_operation = -1;  ///< first record that is not met
  std::size_t missed_record = 0;
  int line = 0;  ///< near it
  std::string message;
};
[[nodiscard]] ClComparison compare_with_cl(std::span<const path::ToolMotion> motions,
                                           std::span<const path::ClPath* const> paths, double tolerance_mm,
                                           double axis_tolerance_rad);

/// A rapid without TCP that moves more than one group of axes (Z, or XY, or rotaries): which arrives first is not
/// known. With TCP the tip goes straight, whatever the joints do.
[[nodiscard]] bool mixes_axis_groups(const ExecutedMove& from, const ExecutedMove& to);
/// No rapid of the trace does that. The refusal names the line.
[[nodiscard]] Status check_axis_groups(const OperationTrace& trace);
/// A body as rapids see it: all of the cylinder.
[[nodiscard]] inline proof::RapidObstacle obstacle_of(const joints::ClearanceBody& body) {
  return {body.radius_mm, 0, body.z_max_mm, body.z_min_mm};
}
/// In every rapid of the trace every body of the tool is clear of `obstacle` (about the gear axis in W) at every
/// moment, proven. `tools`: the job's; without them only the tip is looked at.
[[nodiscard]] Status check_rapids_outside(const OperationTrace& trace, const NcControl& control,
                                          const machines::Machine& machine, const joints::Setup& setup,
                                          const proof::RapidObstacle& obstacle,
                                          std::span<const tool::ToolAssembly> tools);

/// Both of these.
[[nodiscard]] Status check_rapids(const OperationTrace& trace, const NcControl& control,
                                  const machines::Machine& machine, const joints::Setup& setup,
                                  const joints::ClearanceBody& body, std::span<const tool::ToolAssembly> tools = {});

}  // namespace toothpath::readback
