#include "postproc/joints/time.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "postproc/joints/words.h"

namespace toothpath::joints {
namespace {

constexpr const char* kAcceleration = "acceleration";
constexpr double kRuled = 1.01;  // a feed block that takes longer than this share of its time is ruled by acceleration
constexpr double kLeastShare = 1e-9;   // of a corner: two blocks that could not be joined at all
constexpr double kLeastBlockMs = 1.0;  // of a control that states none

using Speeds = std::array<double, 5>;

Speeds limits_of(const machines::KinematicChain& chain) {
  Speeds a{};
  for (std::size_t i = 0; i < 3; ++i) a[i] = chain.linear[i].max_acceleration;
  for (std::size_t k = 0; k < 2; ++k) a[3 + k] = k < chain.rotary_count() ? chain.rotary(k).max_acceleration : 1;
  return a;
}

/// Least acceleration / |speed| over the axes that move.
double least_share(const Speeds& acceleration, const Speeds& v) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < 5; ++j)
    if (v[j] != 0) least = std::min(least, acceleration[j] / std::abs(v[j]));
  return least;
}

/// Time of a block of `minutes` whose share of its speed goes from s0 to s1, growing or falling by at most `rate` a
/// minute.
double block_time(double minutes, double s0, double s1, double rate) {
  if (!std::isfinite(rate)) return minutes;
  const double peak2 = std::min(1.0, 0.5 * (s0 * s0 + s1 * s1) + rate * minutes);
  const double peak = std::max({std::sqrt(peak2), s0, s1});
  const double rest = std::max(0.0, minutes - (2 * peak * peak - s0 * s0 - s1 * s1) / (2 * rate));
  return std::max(minutes, (2 * peak - s0 - s1) / rate + rest / peak);
}

}  // namespace

double time_from_rest(double distance, double speed, double acceleration) {
  const double way = std::abs(distance);
  if (way == 0) return 0;
  return way * acceleration >= speed * speed ? way / speed + speed / acceleration : 2 * std::sqrt(way / acceleration);
}

std::vector<double> accelerated_times(const std::vector<AxisBlock>& blocks, const AxisBlock& start,
                                      const AxisProgram& program, double tool_length_mm,
                                      const machines::Machine& machine) {
  const machines::KinematicChain& chain = machine.chain;
  AxisWords words(chain, program.format, program.work_offset_at_mm);
  words.set_length(tool_length_mm);
  const Speeds limits = limits_of(chain);
  const double tau = (machine.min_block_ms > 0 ? machine.min_block_ms : kLeastBlockMs) / 60000;
  const std::size_t n = blocks.size();
  std::vector<Speeds> v(n);
  std::vector<double> rate(n), share(n + 1, 0.0);
  machines::Joints before = words.joints(start);
  for (std::size_t i = 0; i < n; ++i) {
    const machines::Joints now = words.joints(blocks[i]);
    const double t = blocks[i].minutes;
    if (t > 0) {
      for (int k = 0; k < 3; ++k) v[i][static_cast<std::size_t>(k)] = (now.linear_mm[k] - before.linear_mm[k]) / t;
      for (std::size_t k = 0; k < 2; ++k) v[i][3 + k] = (now.rotary_rad[k] - before.rotary_rad[k]) / t;
    }
    rate[i] = least_share(limits, v[i]);
    before = now;
  }
  // Greatest share at every corner, then what can be reached from the left and from the right.
  for (std::size_t i = 1; i < n; ++i) {
    if (blocks[i].kind != BlockKind::feed || blocks[i - 1].kind != BlockKind::feed) continue;
    Speeds jump{};
    for (std::size_t j = 0; j < 5; ++j) jump[j] = v[i][j] - v[i - 1][j];
    const double corner = std::min(1.0, tau * least_share(limits, jump));
    share[i] = corner < kLeastShare ? 0 : corner;
  }
  const auto reach = [&](std::size_t i, double s) {
    return std::isfinite(rate[i]) ? std::sqrt(s * s + 2 * rate[i] * blocks[i].minutes)
                                  : std::numeric_limits<double>::infinity();
  };
  for (std::size_t i = 0; i < n; ++i) share[i + 1] = std::min(share[i + 1], reach(i, share[i]));
  for (std::size_t i = n; i-- > 0;) share[i] = std::min(share[i], reach(i, share[i + 1]));
  std::vector<double> times(n);
  for (std::size_t i = 0; i < n; ++i) times[i] = block_time(blocks[i].minutes, share[i], share[i + 1], rate[i]);
  return times;
}

void estimate_times(AxisProgram& program, const machines::Machine& machine) {
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
    for (const auto& tooth : op.teeth) {
      if (tooth.blocks.empty()) continue;
      if (!known) stands = tooth.blocks.front();
      known = true;
      const auto first = accelerated_times(tooth.blocks, stands, program, op.tool_length_mm, machine);
      // In a loop the other teeth begin where the one before has ended; the turn of the index is counted below.
      const auto times = copies > 1
                             ? accelerated_times(tooth.blocks, tooth.blocks.back(), program, op.tool_length_mm, machine)
                             : first;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const AxisBlock& b = tooth.blocks[i];
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
    if (program.loop && cut > 1 && index > 1e-12) {
      const machines::RotaryAxis& axis = machine.chain.table[0];
      const int turns = cut - 1;
      op.accelerated.rapid +=
          turns * time_from_rest(index * axis.max_speed / turns, axis.max_speed, axis.max_acceleration);
    }
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
