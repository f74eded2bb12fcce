#include "postproc/text/clamps.h"

namespace toothpath::text {
namespace {

bool is_link_turn(const joints::AxisBlock& b) {
  return b.kind == joints::BlockKind::rapid_rotary || b.kind == joints::BlockKind::turn;
}

}  // namespace

void NcClamps::change(std::size_t rotary, State to, std::vector<std::string>& lines) {
  const machines::RotaryClamp& clamp = *dialect_.clamps[rotary];
  lines.push_back(to == State::clamped ? clamp.on : clamp.off);
  if (state_[rotary] != to) minutes_ += to == State::clamped ? clamp.on_min : clamp.off_min;
  state_[rotary] = to;
}

std::vector<std::string> NcClamps::opening() {
  std::vector<std::string> lines;
  state_.fill(State::unknown);
  for (std::size_t k = 0; k < 2; ++k)
    if (dialect_.clamps[k]) change(k, State::released, lines);
  stood_.reset();
  return lines;
}

void NcClamps::enter(const std::vector<joints::AxisBlock>& tooth, bool looped) {
  if (tooth.empty()) return;
  if (looped) stood_ = {tooth.back().words[3], tooth.back().words[4]};
  for (std::size_t k = 0; k < 2; ++k) {
    said_[k] = false;
    says_[k] = looped;
    // The text of a loop is that of all its teeth; vectors leave a rotary beside its word by its last digits.
    const bool always = looped && (stops_ || program_.index_axis == 3 + static_cast<int>(k) ||
                                   program_.tcp == machines::TcpMode::vectors);
    enters_[k] =
        always || (!looped && state_[k] == State::unknown) || !stood_ || (*stood_)[k] != tooth.front().words[3 + k];
  }
  stood_ = {tooth.back().words[3], tooth.back().words[4]};
}

bool NcClamps::turns(const std::vector<joints::AxisBlock>& tooth, std::size_t block, std::size_t rotary) const {
  const bool may_turn = is_link_turn(tooth[block]) || (block == 0 && tooth[0].kind == joints::BlockKind::feed);
  if (may_turn && enters_[rotary]) return true;
  return block > 0 && tooth[block].words[3 + rotary] != tooth[block - 1].words[3 + rotary];
}

/// From behind this block up to the next link that turns it there is a cut, and it turns in none. Of tool vectors the
/// control makes angles of its own, which may differ by their last digits.
bool NcClamps::stands_in_cuts(const std::vector<joints::AxisBlock>& tooth, std::size_t block,
                              std::size_t rotary) const {
  if (program_.tcp == machines::TcpMode::vectors) return false;
  bool cuts = false;
  for (std::size_t i = block + 1; i < tooth.size(); ++i) {
    const bool turned = tooth[i].words[3 + rotary] != tooth[i - 1].words[3 + rotary];
    if (turned) return cuts && is_link_turn(tooth[i]);
    cuts = cuts || tooth[i].kind == joints::BlockKind::feed;
  }
  return cuts;
}

std::vector<std::string> NcClamps::ahead(const std::vector<joints::AxisBlock>& tooth, std::size_t block) {
  std::vector<std::string> lines;
  for (std::size_t k = 0; k < 2 && any(); ++k)
    if (dialect_.clamps[k] && (says_[k] || state_[k] != State::released) && turns(tooth, block, k)) {
      change(k, State::released, lines);
      says_[k] = false;
    }
  if (is_link_turn(tooth[block])) enters_.fill(false);
  return lines;
}

std::vector<std::string> NcClamps::behind(const std::vector<joints::AxisBlock>& tooth, std::size_t block) {
  std::vector<std::string> lines;
  if (!any() || !is_link_turn(tooth[block])) return lines;
  for (std::size_t k = 0; k < 2; ++k) {
    if (!dialect_.clamps[k] || (state_[k] == State::clamped && said_[k]) || !stands_in_cuts(tooth, block, k)) continue;
    change(k, State::clamped, lines);
    said_[k] = true;
  }
  return lines;
}

void note_clamp_times(joints::AxisProgram& program, const NcDialect& dialect, bool stops) {
  NcClamps clamps(program, dialect, stops);
  program.clamp_minutes = 0;
  if (!clamps.any()) return;
  std::vector<joints::AxisBlock> room;
  for (joints::AxisOperation& op : program.operations) {
    const double before = clamps.minutes();
    double first_tooth = 0;
    (void)clamps.opening();
    const int times = program.loop ? 2 : 1;  // in a loop the second tooth stands for all others
    for (int n = 0; n < times; ++n)
      for (const joints::ToothBlocks& tooth : op.teeth) {
        const std::vector<joints::AxisBlock>& blocks = tooth.all(room);
        clamps.enter(blocks, program.loop);
        for (std::size_t i = 0; i < blocks.size(); ++i) {
          (void)clamps.ahead(blocks, i);
          (void)clamps.behind(blocks, i);
        }
        clamps.leave();
        if (n == 0) first_tooth = clamps.minutes() - before;
      }
    double minutes = clamps.minutes() - before;
    if (program.loop) minutes = first_tooth + (minutes - first_tooth) * (op.places(program.teeth) - 1);
    op.clamp_minutes = minutes;
    program.clamp_minutes += minutes;
  }
}

}  // namespace toothpath::text
