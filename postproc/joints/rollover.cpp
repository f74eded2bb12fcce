#include "postproc/joints/rollover.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::joints {
namespace {
constexpr double kLongest = radians(170);  // the nearer way must stay the nearer one, whatever the last digits are
}  // namespace

bool rolls_over(const machines::KinematicChain& chain) {
  for (std::size_t k = 0; k < chain.rotary_count(); ++k)
    if (chain.rotary(k).rollover) return true;
  return false;
}

void roll_to(const machines::KinematicChain& chain, const RotaryPair& from, std::vector<RotaryPair>& angles) {
  if (angles.empty()) return;
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
    if (!chain.rotary(k).rollover) continue;
    const double shift = choice::whole_turns(angles.front()[k], from[k]);
    if (shift != 0)
      for (auto& a : angles) a[k] += shift;
  }
}

std::vector<AxisBlock> blocks_of_turn(const machines::KinematicChain& chain, const AxisWords& words,
                                      const RotaryPair& from, const AxisBlock& to) {
  const RotaryPair goal = {words.word_angle(to.words[3]), words.word_angle(to.words[4])};
  std::vector<RotaryPair> start = {from};
  roll_to(chain, goal, start);
  std::size_t n = 1;
  for (std::size_t k = 0; k < chain.rotary_count(); ++k)
    if (chain.rotary(k).rollover)
      n = std::max(n, static_cast<std::size_t>(std::ceil(std::abs(goal[k] - start.front()[k]) / kLongest)));
  std::vector<AxisBlock> blocks(n, to);
  for (std::size_t i = 1; i < n; ++i)
    for (std::size_t k = 0; k < chain.rotary_count(); ++k)
      blocks[i - 1].words[3 + k] = words.rotary_word(
          start.front()[k] + (goal[k] - start.front()[k]) * static_cast<double>(i) / static_cast<double>(n));
  return blocks;
}

std::array<std::int64_t, 2> loop_entry(const std::vector<AxisBlock>& tooth, const AxisProgram& program) {
  const int digits = program.format.rotary_decimals;
  const std::int64_t turn = 360 * numbers::power_of_ten(digits);
  const auto first =
      std::find_if(tooth.begin(), tooth.end(), [](const AxisBlock& b) { return b.kind == BlockKind::rapid_rotary; });
  const AxisBlock &goal = first == tooth.end() ? tooth.front() : *first, &end = tooth.back();
  std::array<std::int64_t, 2> entry{};
  for (std::size_t k = 0; k < 2; ++k) {
    entry[k] = end.words[3 + k];
    if (static_cast<int>(3 + k) == program.index_axis)
      entry[k] -=
          numbers::ratio_to_fixed(std::int64_t{360} * program.tooth_stride * program.index_sign, program.teeth, digits);
    const double turns = std::round(static_cast<double>(goal.words[3 + k] - entry[k]) / static_cast<double>(turn));
    if (program.rollover[3 + k]) entry[k] += turn * static_cast<std::int64_t>(turns);
  }
  return entry;
}

std::int64_t within_turn(std::int64_t word, std::int64_t turn) {
  const std::int64_t rest = word % turn;
  return rest < 0 ? rest + turn : rest;
}

}  // namespace toothpath::joints
