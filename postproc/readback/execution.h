// What a control does with a block once it is understood: modes, tools, offsets, TCP, and where the joints stand. The
// same for every dialect; the readers of the dialects turn text into calls of this and give errors their place.
//
// With TCP the linear words are the tip in the table frame (seen from the work offset, and turned with it where the
// program turns its frame); the tip goes straight, the rotaries are linear in time, the other joints follow.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "postproc/readback/reader.h"

namespace toothpath::readback {

/// What M0, and M1 where the switch is on, do beside waiting for the start button.
enum class ProgramStop : std::uint8_t {
  waits,         ///< spindle and coolant go on
  in_doubt,      ///< the builder of the machine decides about both
  ends_spindle,  ///< spindle and coolant are off behind it, until the program switches them on again
};

/// Modal group of an M word, in the order in which those of one block act: tool, spindle, coolants, calls, stops.
inline constexpr int kCoolants = 8, kCalls = 98, kStops = 99;
[[nodiscard]] int group_of_m(int m);
/// What two M words of one block do together would depend on their order.
[[nodiscard]] bool clash_of_m(const NcControl& control, int one, int other);

/// How a control differs in what it does, not in how it is written.
struct NcRules {
  /// TCP may be switched on with the rotaries at zero only; one whose zero the program has moved, and which carries the
  /// work, stands there at that zero, and the table frame is the one that then lies along the machine axes.
  bool tcp_needs_zero = false;
  /// Whether TCP takes the moved zero of the rotary that carries the work as the table's own, so that the frame turns
  /// with it, is for NcControl::transformation_takes_rotary_offset to say.
  bool tcp_may_take_zero = false;
  double least_rate = 0;          ///< G93 blocks are raised to this rate, mm/min or deg/min
  bool per_minute_turns = false;  ///< G94 with rotary words without TCP has a defined time
  /// Work offsets have a turn about Z of their own, and another one may be taken while TCP is on: it changes what words
  /// mean and nothing else.
  bool offsets_turn = false;
  bool sign_is_sense =
      false;  ///< the sign of a word says which way a rotary that rolls over turns; else the nearer way is taken
  bool turns_need_axis_blend =
      false;  ///< a tolerance of the tip leaves that of the rotaries to the machine: it must be said too
  ProgramStop stop = ProgramStop::in_doubt;
  /// A tool length stays in force behind a move of Z to a reference position; else it must be said again, which is the
  /// safe side where the control drops it.
  bool reference_keeps_length = false;
};

/// One rigid transform: from the words to the table frame, seen from the work offset.
struct TiltedPlane {
  Vec3 origin_mm = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();
  enum class State : std::uint8_t { defined, turning, turned } state = State::defined;
  std::array<double, 2> at_deg{};  ///< turned: the rotaries, within half a turn of zero, stand the tool upright on it
  double cosine = 1, sine = 0;     ///< .. and turn X Y of the words to those of the machine
  Vec3 zero_mm = Vec3::Zero();     ///< .. where the tip of the words X0 Y0 Z0 is, machine coordinates
};

/// A work offset that the program writes: NcControl::index_offset.
struct WrittenOffset {
  Vec3 at_mm = Vec3::Zero();  ///< machine coordinates
  double turn_deg = 0;        ///< of its X and Y about Z
};

class NcExecution {
 public:
  using Problem = std::optional<std::string>;

  struct Move {
    std::array<double, 5> axis{};  ///< words, mm and deg
    std::array<bool, 5> has{};
    std::optional<Vec3> vector;  ///< tool axis instead of rotary words, work frame
    bool rapid = false;
    bool machine_frame = false;  ///< words are joints: no offset, no tool length
    bool compensation = false;   ///< the block switches tool length compensation on
    bool own_feed = false;       ///< F stands in the block
    bool to_reference = false;   ///< a piece of the way to a reference position
  };

  NcExecution(const NcControl& control, const NcRules& rules, const std::function<void(const ExecutedMove&)>& sink);

  // Place in the program.
  void begin_operation(int operation);
  void begin_tooth(int tooth) { tooth_ = tooth; }
  [[nodiscard]] int operation() const { return operation_; }
  [[nodiscard]] int tool() const { return tool_; }  ///< in the spindle; -1: none

  // Modes.
  void set_unit() { unit_ = true; }                              ///< the program has said that its words are mm
  void set_absolute() { distance_ = Distance::absolute; }        ///< the program has said that its words are positions
  void set_incremental() { distance_ = Distance::incremental; }  ///< or steps: read on the way to a reference alone
  enum class Feed { none, inverse_time, per_minute };
  void set_feed_mode(Feed mode);
  [[nodiscard]] Feed feed_mode() const { return feed_mode_; }
  Problem set_feed(double f);
  Problem set_speed(double s);
  Problem choose_tool(double number);
  Problem change_tool();
  Problem spindle_on();
  void spindle_off() { spindle_ = false; }
  /// M0, or M1, which may stop like it.
  void stop();
  /// What is wrong with a check of the tool, in which of its lines (0: its comment) and column.
  struct CheckFault {
    std::size_t line = 0;
    int column = 1;
    std::string text;
  };
  /// The tool goes to the setter, and the program stops where its length is not that of the list within a tolerance.
  /// What the lines do beyond that is not known: all modes must be said again behind them, and Z goes to its top first.
  /// @param tool  of the comment  @param lines  behind it, as many as the machine has, or up to the end of the text
  std::optional<CheckFault> check_tool(int tool, std::span<const std::string_view> lines, std::int32_t line);
  /// How many lines a check has; 0: the machine has none.
  [[nodiscard]] std::size_t check_lines() const { return control_.tool_check ? control_.tool_check->lines.size() : 0; }
  /// Waits [min]; counts with the next move.
  Problem dwell(double minutes);
  /// Waits for so many turns of the spindle.
  Problem dwell_turns(double turns);
  /// A word that switches a coolant on or off; one that belongs to none changes nothing.
  void switch_coolant(std::string_view word);
  /// A word of the builder that clamps a rotary or releases it. @returns it is one
  bool switch_clamp(std::string_view word);
  // Work offsets and moved zeros (postproc/readback/frames.cpp).
  Problem select_offset(const std::string& name);
  /// Writes NcControl::index_offset, which must not be in force. @param at_mm nothing: it stays where it was written
  Problem write_offset(const std::optional<Vec3>& at_mm, double turn_deg);
  /// What the work offset turns and moves of the rotaries is taken as 0, and the program has not looked.
  void set_offset_unseen(bool unseen) { offset_unseen_ = unseen; }
  Problem set_length(int tool);  ///< tool length compensation with the length of this tool
  void drop_length() { length_.reset(); }
  /// The control may leave corners by this. @param linear_only it does not hold for rotaries: feed blocks must not turn
  /// them
  void set_blend(double mm, bool linear_only = false) {
    blend_mm_ = mm;
    blend_is_linear_ = linear_only;
    contour_cycle_ = false;
    corner_way_.reset();
  }
  /// A cycle bounds the tip, and with TCP each rotary where it says so; it bounds no rotary else.
  void set_contour(double mm, std::optional<double> rad) {
    set_blend(mm);
    blend_axis_rad_ = rad;
    contour_cycle_ = true;
    set_path_mode(timing::Corners::round, mm);
  }
  /// How the path goes on at corners, where the text says it; P of G64, or the tolerance.
  void set_path_mode(timing::Corners corners, double tolerance_mm) {
    path_mode_ = corners;
    path_tolerance_mm_ = tolerance_mm;
  }
  /// Every axis may leave the path within this way ahead of and behind a corner, mm (G641).
  void set_corner_way(double mm) {
    set_blend(0);
    corner_way_ = mm;
    set_path_mode(timing::Corners::way, mm);
  }
  /// What the way is measured over: mm for each mm or degree of an axis. Nothing: what the machine data say.
  void set_path_weights(std::optional<std::array<double, 5>> weights) { path_weights_ = weights; }
  /// How far the control may turn a rotary off its way with TCP, rad. Nothing: not said.
  void set_blend_axis(std::optional<double> rad) { blend_axis_rad_ = rad; }
  /// A line that the machine file states for the control's own smoothing, blanks around it left out: takes its effect.
  /// @returns it is one
  bool site_smoothing(std::string_view line);
  [[nodiscard]] bool in_site_smoothing() const { return site_smoothing_; }
  Problem tcp_on();
  Problem tcp_off();
  [[nodiscard]] bool tcp() const { return tcp_; }
  /// Turns the frame of the words by this angle about Z through the work offset.
  void turn_frame(double degrees) { frame_deg_ = degrees; }
  /// Words of a rotary count from here, machine degrees, until the program says otherwise. @param axis 3 or 4  @param
  /// word of the control, for messages
  Problem move_zero(std::size_t axis, double degrees, std::string_view word);
  /// The zeros of all rotaries are those of the machine.
  Problem clear_zeros();
  /// Both: a line that moves one and clears the others. Said again it changes nothing, with TCP on, too.
  Problem replace_zeros(std::size_t axis, double degrees, std::string_view word);
  [[nodiscard]] bool zero_is_moved() const { return zero_[3] != 0 || zero_[4] != 0; }

  // A tilted plane, without TCP (postproc/readback/frames.cpp): words are coordinates in it, their Z along the tool.
  /// Which of the two pairs of rotary angles stands the tool upright on a plane: by the angle of the second rotary of
  /// the table, which tilts.
  enum class PlanePair : std::uint8_t { not_below_zero, not_above_zero };
  /// Words count from `origin_mm` along the columns of `rotation`, both seen from the work offset, all rotaries at
  /// zero. Nothing moves yet. @param word of the control, for messages
  Problem define_plane(const Vec3& origin_mm, const Mat3& rotation, std::string_view word);
  /// The rotaries go to the pair, each into the turn nearest to where it stands, within its travel.
  Problem turn_to_plane(PlanePair pair, std::string_view word, std::int32_t line);
  /// Words are those of the work offset again; nothing moves.
  void reset_plane() { plane_.reset(); }
  [[nodiscard]] bool in_plane() const { return plane_.has_value(); }
  Problem end_program(bool inside_call);

  /// Of a reader without NcFlow, at every block: too many, or too many in a row without a move.
  Problem next_block();
  /// A block with axis words; `line` from 1.
  Problem move(const Move& m, std::int32_t line);
  /// The axes that `m` names go with a rapid to reference position 1 or 2 (NcControl::reference). @param word of the
  /// control, "G28", for messages  @param by_way the words of `m` are a place on the way
  Problem to_reference(const Move& m, std::size_t which, std::string_view word, bool by_way, std::int32_t line);
  /// The place of a reference position, mm and deg; refused where the machine file does not say it.
  Result<std::array<double, 5>> reference(std::size_t which, std::string_view word) const;

 private:
  Problem may_check() const;
  std::optional<CheckFault> check_says(std::span<const std::string_view> lines) const;
  Problem check_ways(std::int32_t line);
  void forget_modes();
  Problem move_to(const Move& m, std::int32_t line);
  void set_zero(std::size_t axis, double degrees);
  Problem zeros_allow_end() const;
  Problem roll(Move& m);
  [[nodiscard]] bool at_zero(std::size_t axis) const;
  Problem clamps_allow(const std::array<double, 5>& goal, std::uint8_t commanded) const;
  Problem goal_of(const Move& m, std::array<double, 5>& joints, Vec3& tip, std::uint8_t& commanded) const;
  Problem tip_goal(const Move& m, std::array<double, 5>& joints, Vec3& tip, std::uint8_t& commanded) const;
  Problem plane_goal(const Move& m, std::array<double, 5>& joints, std::uint8_t& commanded) const;
  [[nodiscard]] double turn_within_travel(std::size_t rotary, double deg) const;
  Problem corners(const std::array<double, 5>& goal, const Vec3& tip, ExecutedMove& e) const;
  Problem feed_minutes(const Move& m, const std::array<double, 5>& joints, const Vec3& tip, double& minutes) const;
  [[nodiscard]] std::array<double, 2> angles_of(double r0, double r1) const;
  [[nodiscard]] Vec3 in_words(const Vec3& tip) const;
  [[nodiscard]] Vec3 from_words(const Vec3& words) const;
  [[nodiscard]] Vec3 as_frozen(const Vec3& point, bool back) const;
  [[nodiscard]] Vec3 tip_of(const std::array<double, 5>& joints) const;
  [[nodiscard]] std::array<double, 5> joints_for(const Vec3& tip, double r0, double r1) const;

  const NcControl& control_;
  NcRules rules_;
  const std::function<void(const ExecutedMove&)>& sink_;
  std::array<double, 5> joints_{};
  Vec3 tip_ = Vec3::Zero();  // with TCP: table frame
  bool tcp_ = false;
  std::array<double, 5> zero_{};      // of the words of the rotaries, deg
  bool zeros_cleared_ = false;        // by the program
  std::optional<double> frozen_deg_;  // first rotary where TCP froze the table frame, or whose zero it has taken
  // Rotaries that roll over by the sign of their words: as the control adds them up, from the zero of their words.
  std::array<double, 5> rolled_{};
  double frame_deg_ = 0;
  std::optional<TiltedPlane> plane_;
  int operation_ = -1, piece_ = -1, tooth_ = -1, tool_ = -1, next_tool_ = -1;
  Feed feed_mode_ = Feed::none;
  std::optional<double> feed_, length_;
  std::optional<Vec3> offset_;
  std::optional<WrittenOffset> written_;
  bool in_written_ = false;  // words count from it
  bool offset_unseen_ = false;
  timing::Corners path_mode_ = timing::Corners::exact;
  double path_tolerance_mm_ = 0;
  double blend_mm_ = 0;
  bool blend_is_linear_ = false, site_smoothing_ = false, contour_cycle_ = false;
  std::optional<double> corner_way_, blend_axis_rad_;
  std::optional<std::array<double, 5>> path_weights_;
  bool spindle_ = false, spindle_set_ = false, retracted_ = false;
  double speed_ = 0;    // S, 1/min
  int length_of_ = -1;  // the tool whose length counts
  std::uint8_t coolants_ = 0;
  enum class Clamp : std::uint8_t { unknown, released, clamped };
  std::array<Clamp, 5> clamps_{};
  enum class Distance : std::uint8_t { unsaid, absolute, incremental } distance_ = Distance::unsaid;
  bool unit_ = false;
  bool spindle_doubt_ = false, coolant_doubt_ = false;  ///< a stop may have ended them
  bool checked_ = false;                                // the tool, since it came
  double dwell_min_ = 0;                                ///< until the next move
  std::int32_t last_line_ = 0;                          ///< of a move
  std::size_t steps_ = 0, idle_ = 0;
};

}  // namespace toothpath::readback
