// The blocks of one tooth: links between the passes with their safe sequences, and the blocks of the cut with
// subdivision and times. Used by build_axis_program alone, which decides about angles, loop and operations.
//
// Without TCP every block is straight in the joints. With TCP the blocks of a cut carry the tip, which the control
// keeps on its chord; links stay in the joints (TCP is switched off before the first of them), except where the control
// can switch TCP on at rotary zero only: there TCP stays on for the whole tooth, and links rise along the tool axis
// above the clearance body, turn there with the tip standing still, cross, and go down along the tool axis. Where the
// tool comes in from the side they leave the clearance body sideways, along the tool axis, and stay outside its radius.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cam/tool/proof_tool.h"
#include "postproc/joints/clearance.h"
#include "postproc/joints/pole.h"
#include "postproc/joints/program.h"
#include "postproc/joints/travel.h"
#include "postproc/joints/words.h"

namespace toothpath::joints {

/// Terms of the block time.
enum TimeTerm { kFeed, kFeedLimit, kLinearSpeed, kRotarySpeed, kBlockTime, kInverseTime, kTimeTerms };
inline constexpr const char* kTimeNames[kTimeTerms] = {"feed of the path",       "largest cutting feed",
                                                       "speed of a linear axis", "speed of a rotary axis",
                                                       "shortest block",         "largest F"};

/// What all teeth share.
struct AxisJob {
  const machines::Machine& machine;
  ClearanceBody body;
  AxisOptions options;
  int teeth = 1;
  GearPlacement gear;
  bool coincident = false;  ///< the first rotary of the table turns the gear about its own axis
};

/// A path with the rotaries of its records.
struct FollowedPath {
  const path::ClPath* planned = nullptr;
  std::optional<PolePath> changed;  ///< where poles had to be handled: followed instead
  std::vector<RotaryPair> angles;
  double ball_radius_mm = 0;  ///< in the cone about a pole the tool turns about this centre

  [[nodiscard]] const path::ClPath& path() const { return changed ? changed->path : *planned; }
  [[nodiscard]] std::int32_t record(std::size_t i) const {
    return changed ? changed->source[i] : static_cast<std::int32_t>(i);
  }
  [[nodiscard]] bool in_cone(std::size_t i) const { return changed && changed->in_cone[i] != 0; }
};

class ToothBuilder {
 public:
  ToothBuilder(const AxisJob& job, AxisProgram& program, TravelRecord& travel, const Vec3& work_offset_mm);

  /// A new tool: the machine stands at the top of Z.
  void begin(AxisOperation& operation, const tool::ToolAssembly& tool);
  /// Blocks of one tooth. @param rotation table frame from the gear frame of this tooth; @param next_start rotaries of
  /// the next
  void tooth(const FollowedPath& path, const RotaryPair& next_start, int k, const Mat3& rotation,
             std::vector<AxisBlock>& blocks);
  /// Where the rotaries stand when the links of the next tooth begin [rad].
  [[nodiscard]] RotaryPair start_rotaries() const;
  /// Counts blocks that were made by turning those of another tooth.
  void take_over(const std::vector<AxisBlock>& blocks, int k);

  [[nodiscard]] const std::optional<Diagnostic>& error() const { return error_; }
  [[nodiscard]] const AxisWords& words() const { return words_; }
  /// By how much the tip rises too little for the links of `error`; 0: it is another error.
  [[nodiscard]] double lack_mm() const { return lack_; }

 private:
  // postproc/joints/tooth.cpp: state of the sequence.
  void push(AxisBlock b);
  [[nodiscard]] double linear_time(const machines::Joints& a, const machines::Joints& b) const;
  [[nodiscard]] double rotary_time(const machines::Joints& a, const machines::Joints& b) const;
  void note_position(const machines::Joints& j);
  [[nodiscard]] bool stays_in_tcp() const {
    return program_.tcp != machines::TcpMode::none && program_.tcp_starts_at_zero;
  }
  [[nodiscard]] int copies() const { return program_.loop ? job_.teeth : 1; }
  /// Joint times of a block whose tip goes straight, and the travel inside it.
  struct TipTimes {
    double linear = 0, rotary = 0;
  };
  TipTimes follow_tip(const AxisBlock& from, const AxisBlock& to);

  // postproc/joints/links.cpp: joint form.
  void rapid_to(const machines::TablePose& target, const RotaryPair& rotaries);
  void rise_to(double height);
  void push_rapid(AxisBlock b, bool forced);
  void push_rotaries(const AxisBlock& b, bool forced);
  void too_low(double height);
  [[nodiscard]] double height_of(const AxisBlock& b) const;
  [[nodiscard]] double retract_height() const { return program_.retract_z_mm - words_.length(); }
  [[nodiscard]] double tip_height_for_turn(const RotaryPair& to) const;
  void tcp_on();
  void tcp_off();
  void end_on_angles();

  // postproc/joints/tip_links.cpp: with TCP.
  void start_at_zero(const Vec3& over, const RotaryPair& first);
  void tip_link_to(const machines::TablePose& target, const RotaryPair& rotaries);
  void link_over(const machines::TablePose& target, const RotaryPair& rotaries);
  void link_beside(const machines::TablePose& target, const RotaryPair& rotaries);
  [[nodiscard]] bool lies_down(const Vec3& axis);
  void rise_along_tool(double height);
  /// The tool comes in from the side somewhere in a tooth: its links go beside the part.
  [[nodiscard]] bool comes_from_the_side(const FollowedPath& path, const Mat3& rotation) const;
  [[nodiscard]] double from_gear_axis(const Vec3& p) const;
  [[nodiscard]] double beside_radius() const;
  std::optional<Vec3> beside(const Vec3& tip, const Vec3& axis, double radius);
  void push_turn_beside(const RotaryPair& rotaries);
  /// Of two positions of the rotaries: the first with that rotary of the second which stands the tool upright; none
  /// does.
  [[nodiscard]] std::optional<RotaryPair> one_upright(const RotaryPair& from, const RotaryPair& to) const;
  void rise_beside();
  void leave_to_top();
  void push_tip(const Vec3& tip);
  void push_turn(const RotaryPair& rotaries);
  void push_turn_block(const RotaryPair& rotaries);
  [[nodiscard]] RotaryPair zero_rotaries() const;
  /// Height over the part, table frame, at which the whole tool passes while the rotaries go from one pair to the
  /// other.
  [[nodiscard]] double link_height(const RotaryPair& from, const RotaryPair& to) const;
  /// Least height of the tip over the part while the tool axis rises by `up` or more.
  [[nodiscard]] double room_over_part(double up) const;

  // postproc/joints/feed.cpp
  void feed_to(const machines::TablePose& from, const RotaryPair& from_angles, const machines::TablePose& to,
               const RotaryPair& to_angles, double feed, int depth);
  struct Middle {
    machines::TablePose pose;
    RotaryPair angles;
  };
  std::optional<Middle> middle_of(const machines::TablePose& from, const RotaryPair& from_angles,
                                  const machines::TablePose& to, const RotaryPair& to_angles);
  std::optional<RotaryPair> angles_between(const Vec3& axis, const RotaryPair& a, const RotaryPair& b);
  void note_bounds(const machines::Joints& a, const machines::Joints& b, const machines::TablePose& from,
                   const machines::TablePose& to, double axis_error);
  void push_feed(const machines::TablePose& to, const RotaryPair& rotaries, double feed);
  void set_time(AxisBlock& pushed, const AxisBlock& before, double feed);
  [[nodiscard]] double turn_minutes(double turned_deg) const;

  const AxisJob& job_;
  const machines::KinematicChain& chain_;
  AxisProgram& program_;
  TravelRecord& travel_;
  AxisWords words_;
  std::optional<Diagnostic> error_;
  double lack_ = 0;
  AxisOperation* operation_ = nullptr;
  tool::ProofTool tool_;
  std::vector<AxisBlock>* blocks_ = nullptr;
  AxisBlock last_;
  int tooth_ = 0;
  std::int32_t record_ = 0;
  bool at_retract_ = true, start_of_tooth_ = true, broken_ = true;
  bool positioned_ = false;          // X and Y have been commanded
  bool tcp_ = false;                 // switched on
  bool beside_ = false;              // links of this tooth go beside the part
  std::optional<double> cone_ball_;  // the step lies in the cone about a pole: ball radius, 0 for other tools
};

}  // namespace toothpath::joints
