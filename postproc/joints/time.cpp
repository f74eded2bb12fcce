#include "postproc/joints/time.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/joints/words.h"
#include "postproc/timing/model_text.h"
#include "postproc/timing/path_timer.h"

namespace toothpath::joints {
namespace {

constexpr const char* kAcceleration = "acceleration";
constexpr double kRuled = 1.01;  // a feed block that takes longer than this share of its time is ruled by acceleration
constexpr double kLeastIndex = 1e-12;  // min: less is the rounding of a sum

/// Steps of the axes, mm and deg, from the place of one block to that of the next.
class Steps {
 public:
  Steps(const AxisProgram& program, double tool_length_mm, const machines::Machine& machine, bool plans_words)
      : words_(machine.chain, program.format, program.work_offset_at_mm), plans_words_(plans_words) {
    words_.set_length(tool_length_mm);
  }

  [[nodiscard]] std::array<double, 5> between(const AxisBlock& a, const AxisBlock& b) const {
    const machines::Joints from = words_.joints(a), to = words_.joints(b);
    const Vec3 linear =
        plans_words_ && a.tip && b.tip ? Vec3(words_.tip(b) - words_.tip(a)) : Vec3(to.linear_mm - from.linear_mm);
    return {linear.x(), linear.y(), linear.z(), degrees(to.rotary_rad[0] - from.rotary_rad[0]),
            degrees(to.rotary_rad[1] - from.rotary_rad[1])};
  }

 private:
  AxisWords words_;
  bool plans_words_;
};

/// Turns of the index by `minutes` of its greatest speed in all, `turns` of them, each from rest to rest.
double index_minutes(double minutes, int turns, const machines::Machine& machine) {
  const timing::AxisLimits limits = timing::limits_of(machine);
  timing::Block turn;
  turn.minutes = minutes / turns;
  turn.step[3] = turn.minutes * limits.speed[3];
  turn.rapid = true;
  return turns * timing::times_of(std::span(&turn, 1), limits, timing::control_of(machine)).front();
}

}  // namespace

std::vector<double> accelerated_times(const std::vector<AxisBlock>& blocks, const AxisBlock& start,
                                      const AxisProgram& program, double tool_length_mm,
                                      const machines::Machine& machine) {
  const timing::PathControl control = timing::control_of(machine);
  const Steps steps(program, tool_length_mm, machine, control.plans_words);
  std::vector<double> times;
  times.reserve(blocks.size());
  timing::PathTimer timer(timing::limits_of(machine), control, [&times](double minutes) { times.push_back(minutes); });
  const AxisBlock* before = &start;
  for (const AxisBlock& b : blocks) {
    timer.add({steps.between(*before, b), b.minutes, b.kind != BlockKind::feed});
    before = &b;
  }
  timer.finish();
  return times;
}

void estimate_times(AxisProgram& program, const machines::Machine& machine) {
  program.time_model = timing::model_text(machine);
  if (!machine.has_acceleration()) return;
  program.has_acceleration = true;
  program.accelerated = {};
  std::size_t ruled = 0;
  std::fill(program.time_ruled.begin(), program.time_ruled.end(), std::size_t{0});
  AxisBlock stands;  // rotaries at zero, X and Y where the first block finds them: the first moves of the program are
                     // not known
  bool known = false;
  for (auto& op : program.operations) {
    op.accelerated = {};
    const int cut = program.teeth - op.first_place, copies = program.loop ? cut : 1;
    for (auto& tooth : op.teeth) {
      if (tooth.blocks.empty()) continue;
      if (!known) stands = tooth.blocks.front();
      known = true;
      const auto first = accelerated_times(tooth.blocks, stands, program, op.tool_length_mm, machine);
      // In a loop the other teeth begin where the one before has ended; the turn of the index is counted below.
      const auto times = copies > 1
                             ? accelerated_times(tooth.blocks, tooth.blocks.back(), program, op.tool_length_mm, machine)
                             : first;
      for (std::size_t i = 0; i < times.size(); ++i) {
        AxisBlock& b = tooth.blocks[i];
        b.run_minutes = times[i];
        (b.kind == BlockKind::feed ? op.accelerated.feed : op.accelerated.rapid) += first[i] + (copies - 1) * times[i];
        if (b.kind != BlockKind::feed) continue;
        if (times[i] > kRuled * b.minutes) ++ruled;
        else ++program.time_ruled[b.ruler];
      }
      stands = tooth.blocks.back();
    }
    // What the operation's rapids hold beside those of the blocks: the turns of the index.
    double blocks = 0;
    for (const auto& tooth : op.teeth)
      for (const auto& b : tooth.blocks) blocks += b.kind == BlockKind::feed ? 0 : copies * b.minutes;
    const double index = std::max(0.0, op.rapid_minutes - blocks);
    if (program.loop && cut > 1 && index > kLeastIndex) op.accelerated.rapid += index_minutes(index, cut - 1, machine);
    program.accelerated.feed += op.accelerated.feed;
    program.accelerated.rapid += op.accelerated.rapid;
  }
  if (program.time_rulers.empty() ||
      program.time_rulers.back() != kAcceleration) {  // else the program is part of one that has been timed
    program.time_rulers.emplace_back(kAcceleration);
    program.time_ruled.push_back(0);
  }
  program.time_ruled.back() = ruled;
}

}  // namespace toothpath::joints
