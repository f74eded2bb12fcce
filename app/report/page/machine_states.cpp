#include "app/report/page/machine_states.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "geometry/base/angle.h"

namespace toothpath::page {
namespace {

constexpr double kTurnWay = 200;                   // mm for each rad, where moves are thinned
constexpr std::size_t kStates = 420;               // of one tooth of every operation
constexpr std::size_t kOtherStates = 6000;         // of teeth that repeat none
constexpr std::size_t kKeptTeeth = 3;              // of an operation
constexpr std::size_t kMostMoves = 400000;         // of loops that wait, and of a tooth
constexpr double kSame = 0.002, kSameTurn = 2e-5;  // mm, rad: nobody sees it

double way_between(const SceneState& a, const SceneState& b) {
  double way = 0;
  for (std::size_t k = 0; k < 5; ++k) way += std::abs(b.joints[k] - a.joints[k]) * (k < 3 ? 1 : kTurnWay);
  return way;
}

/// Of one stretch of the program, its ends and places between them at equal ways; at least one move apart.
void add_thinned(const std::vector<SceneState>& stretch, std::size_t most, std::vector<SceneState>& out) {
  double whole = 0;
  for (std::size_t k = 1; k < stretch.size(); ++k) whole += way_between(stretch[k - 1], stretch[k]);
  // Half of them by way, half by number: rapids are long, cuts are many.
  double since = 0;
  for (std::size_t k = 0; k < stretch.size(); ++k) {
    const double step = k == 0 ? 0 : way_between(stretch[k - 1], stretch[k]);
    since += 0.5 * double(most) * (step / std::max(whole, 1e-9) + 1.0 / double(stretch.size()));
    if (k > 0 && k + 1 < stretch.size() && since < 1) continue;
    since = 0;
    out.push_back(stretch[k]);
  }
}

/// What the rotaries of `b` have on top of those of `a`, where all else is the same.
std::optional<std::array<double, 2>> turn_between(const std::vector<SceneState>& a, const std::vector<SceneState>& b) {
  if (a.size() != b.size() || a.empty()) return std::nullopt;
  const std::array<double, 2> turn = {b[0].joints[3] - a[0].joints[3], b[0].joints[4] - a[0].joints[4]};
  const int lines = b[0].line - a[0].line;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (b[i].line - a[i].line != lines || b[i].tool != a[i].tool) return std::nullopt;
    for (std::size_t k = 0; k < 5; ++k) {
      const double off = b[i].joints[k] - a[i].joints[k] - (k < 3 ? 0 : turn[k - 3]);
      if (std::abs(off) > (k < 3 ? kSame : kSameTurn)) return std::nullopt;
    }
  }
  return turn;
}

}  // namespace

StateRecorder::StateRecorder(std::vector<int> tool_numbers, std::size_t operations, std::size_t tooth_spaces)
    : tool_numbers_(std::move(tool_numbers)),
      each_(std::max<std::size_t>(12, kStates / std::max<std::size_t>(1, operations))),
      others_(std::clamp<std::size_t>(kOtherStates / std::max<std::size_t>(1, tooth_spaces), 4, each_)) {}

void StateRecorder::add(const readback::ExecutedMove& m) {
  if (m.operation != operation_ || m.piece != piece_ || m.tooth != tooth_ || m.tool != tool_) end_stretch();
  if (m.piece != piece_) in_piece_ = 0;
  operation_ = m.operation;
  piece_ = m.piece;
  tooth_ = m.tooth;
  tool_ = m.tool;
  if (!m.known || open_.size() >= kMostMoves) return;
  SceneState s;
  s.joints = {m.joints[0], m.joints[1], m.joints[2], radians(m.joints[3]), radians(m.joints[4])};
  s.operation = m.operation;
  s.line = m.line;
  const auto tool = std::find(tool_numbers_.begin(), tool_numbers_.end(), int(m.tool));
  s.tool = tool == tool_numbers_.end() ? -1 : int(tool - tool_numbers_.begin());
  open_.push_back(s);
}

void StateRecorder::end_stretch() {
  if (open_.empty()) return;
  if (operation_ >= 0 && tooth_ < 0 && looped_ + open_.size() <= kMostMoves) {
    looped_ += open_.size();
    const std::size_t count = open_.size();
    loops_.push_back({std::move(open_), out_.stretches.size(), operation_, piece_, in_piece_});
    in_piece_ += count;
  } else {
    add_stretch(open_, operation_, tooth_);
  }
  open_.clear();
}

bool StateRecorder::add_repeated(const Moves& moves, int operation, int tooth) {
  for (const Kept& kept : kept_[operation])
    if (const auto turn = turn_between(kept.whole, moves)) {
      out_.stretches.push_back(
          {kept.first, kept.count, operation, tooth, *turn, moves.front().line - kept.whole.front().line});
      return true;
    }
  return false;
}

void StateRecorder::add_stretch(const Moves& moves, int operation, int tooth) {
  if (moves.empty() || (tooth >= 0 && add_repeated(moves, operation, tooth))) return;
  auto& kept = kept_[operation];
  const bool keep = tooth >= 0 && kept.size() < kKeptTeeth;
  const std::size_t first = out_.states.size();
  add_thinned(moves, keep || tooth < 0 ? each_ : others_, out_.states);
  out_.stretches.push_back({first, out_.states.size() - first, operation, tooth, {}, 0});
  if (keep) kept.push_back({moves, first, out_.states.size() - first});
}

void StateRecorder::add_loop(const readback::ReadBack& read, const Loop& loop, std::size_t piece) {
  const Moves& moves = loop.moves;
  const auto trace = std::find_if(read.operations.begin(), read.operations.end(),
                                  [&](const auto& o) { return o.operation == loop.operation; });
  const auto copies = std::find_if(read.copies.operations.begin(), read.copies.operations.end(),
                                   [&](const auto& o) { return o.operation == loop.operation; });
  if (!read.copies.copies || trace == read.operations.end() || copies == read.copies.operations.end() ||
      piece >= copies->pieces.size())
    return add_stretch(moves, loop.operation, -1);
  const std::size_t lead = copies->pieces[piece].lead, ahead = std::min(loop.ahead, lead);
  std::size_t at = std::min(lead - ahead, moves.size());
  const std::size_t step = copies->moves_per_tooth;
  const auto part = [&](std::size_t from, std::size_t to) {
    return Moves(moves.begin() + std::ptrdiff_t(from), moves.begin() + std::ptrdiff_t(to));
  };
  add_stretch(part(0, at), loop.operation, -1);
  for (std::size_t k = copies->pieces[piece].copies; k < copies->turns.size() && step > 0 && at + step <= moves.size();
       ++k, at += step)
    add_stretch(part(at, at + step), loop.operation, copies->turns[k]);
  add_stretch(part(at, moves.size()), loop.operation, -1);
}

SceneStates StateRecorder::finish(const readback::ReadBack& read) {
  end_stretch();
  std::vector<SceneStretch> labelled = std::move(out_.stretches), all;
  std::size_t next = 0;
  const auto take = [&](std::size_t to) {
    for (; next < to; ++next) all.push_back(labelled[next]);
  };
  std::map<int, std::pair<int, std::size_t>> piece;  // of an operation: the last one, and its number among its own
  for (const Loop& loop : loops_) {
    take(loop.at);
    out_.stretches.clear();
    const auto [last, first_seen] = piece.try_emplace(loop.operation, loop.piece, 0);
    if (!first_seen && last->second.first != loop.piece) last->second = {loop.piece, last->second.second + 1};
    add_loop(read, loop, last->second.second);
    all.insert(all.end(), out_.stretches.begin(), out_.stretches.end());
  }
  take(labelled.size());
  out_.stretches = std::move(all);
  return std::move(out_);
}

}  // namespace toothpath::page
