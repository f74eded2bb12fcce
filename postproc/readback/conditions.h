// Feed, speed, tool and coolant of an executed program, against what its job asks and its machine can. What is not kept
// is a reason (the program is not proven) or, where it may be a choice, a warning; both name the line.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "postproc/readback/reader.h"

namespace toothpath::readback {

/// What a job asks of an operation.
struct AskedCut {
  int tool = 0;  ///< T
  double speed_rpm = 0;
  double feed_mm_min = 0;         ///< greatest of the tip that the job means
  std::vector<int> sisters = {};  ///< T that may stand in its place
};

/// What a job asks of a program.
struct AskedConditions {
  std::vector<AskedCut> operations;          ///< by their number
  std::optional<machines::Coolant> coolant;  ///< stated by the job; nothing: whatever the program does
  bool tool_checks = false;                  ///< every tool is checked when it has come
};

/// A greatest or least value and the line where it stands.
struct ValueAt {
  double value = 0;
  int line = 0;  ///< 0: there is none
};

/// What an operation was seen to do.
struct ConditionsOfOperation {
  int tool = 0;        ///< T of its first cut
  ValueAt cut_mm_min;  ///< quickest of the tip where it may cut
  ValueAt any_mm_min;  ///< of all its feeds, in the air too
  ValueAt least_rpm, greatest_rpm;
  std::uint8_t coolants = 0;  ///< machines::bit_of: on in all its feeds
};

struct ConditionsFound {
  std::map<int, ConditionsOfOperation> operations;  ///< -1: feeds that belong to none
  std::array<ValueAt, 5> axis_speed;                ///< greatest in feeds, mm/min and deg/min
  ValueAt shortest_ms;                              ///< of feed blocks
  std::vector<std::string> reasons, warnings;       ///< in the order of the kinds below; each kind once an operation
};

/// Takes executed moves in order.
///
/// Where a feed may cut: everywhere but on the way that a link takes. Such a way begins with a rapid or along the tool
/// axis out of the work, and ends along the axis into it; its last move down is a cut again. A block no quicker than
/// a cut ends it too, but for one that no F could make quicker. So a quick block in the middle of a cut is one whatever
/// F its neighbours have.
///
/// Reasons: a cut more than `feed_factor` times as fast as asked, or a last way down; a feed above
/// `limits.cutting_feed`; an axis faster than its `max_speed`; S above `spindle.max_speed`, or off the job's by more
/// than `speed_factor`; another tool than the job's; the job's coolant not on. Warnings: a cut more than 1.5 times as
/// fast as asked (or `feed_factor`, if that is less); S off the job's; a coolant that the job has off; cuts in which a
/// rotary stands that the machine could hold and the program does not; cuts behind a stop that may have ended spindle
/// and coolant; cuts with a tool that no check has met, where the job asks for checks; cuts from a work offset at whose
/// turn and rotaries the program could look and does not; a dwell in a cut; blocks shorter than `limits.min_block_ms`.
class ConditionJudge {
 public:
  /// All must outlive it.
  ConditionJudge(const machines::Machine& machine, const NcControl& control, const AskedConditions& asked);
  void add(const ExecutedMove& move);
  [[nodiscard]] ConditionsFound finish();

 private:
  /// One thing that is told once an operation: the worst place, the first line, how many.
  struct Fault {
    double worst = 0;
    int line = 0;  ///< of the worst
    std::size_t blocks = 0;
  };
  enum class Kind {
    cut_feed,
    way_down,
    machine_feed,
    axis_speed,
    spindle_most,
    spindle_off_job,
    tool,
    coolant,  // reasons
    quick_cut,
    spindle_near_job,
    other_coolant,
    stop_in_doubt,
    unclamped,
    unchecked,
    offset_unseen,
    dwell,
    short_block  // warnings
  };
  struct Step;

  void feed(const ExecutedMove& m, const Step& step, ConditionsOfOperation& operation);
  void speed_of_cut(const ExecutedMove& m, const Step& step, ConditionsOfOperation& operation);
  void axes(const ExecutedMove& m);
  void spindle(const ExecutedMove& m, ConditionsOfOperation& operation);
  void coolant(const ExecutedMove& m, ConditionsOfOperation& operation);
  void clamps(const ExecutedMove& m);
  [[nodiscard]] Step step_to(const ExecutedMove& m) const;
  [[nodiscard]] bool as_quick_as_can_be(const ExecutedMove& m) const;
  [[nodiscard]] const AskedCut* asked(int operation) const;
  void note(Kind kind, int detail, const ExecutedMove& m, double value, int line = 0);
  [[nodiscard]] std::string text(Kind kind, int operation, int detail, const Fault& fault) const;

  const machines::Machine& machine_;
  const NcControl& control_;
  const AskedConditions& asked_;
  double most_share_, told_share_;  ///< of the job's feed
  ConditionsFound found_;
  std::map<std::array<int, 3>, Fault> faults_;  ///< by kind, operation, detail (an axis, a tool, a coolant)
  ExecutedMove before_;
  /// Cuts of one stretch between links in which a rotary stood and was not held; none once it has turned there.
  struct Loose {
    std::vector<ExecutedMove> first;  ///< none or one
    std::size_t blocks = 0;
    bool turned = false;
  };
  std::array<Loose, 5> loose_;
  void end_of_stretch();
  bool any_ = false;
  bool up_ = false;   ///< on the way of a link
  ValueAt way_down_;  ///< the last way down was that quick
};

}  // namespace toothpath::readback
