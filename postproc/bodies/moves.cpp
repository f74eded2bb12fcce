#include "postproc/bodies/moves.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::bodies {
namespace {

constexpr std::size_t kChunk = std::size_t(1) << 14;  // spans that are looked at together
constexpr std::size_t kFirstLooks = 32;               // of them that are measured ahead of the others
constexpr std::size_t kKeptTeeth = 3;                 // of an operation, for others to repeat
constexpr std::size_t kKeptSpans = 8 * kChunk;        // of all of them
constexpr double kFinestThatMayPass = 2e-4;      // mm: ways that are halved where the gap at their middle is enough
constexpr double kRise = 1, kHighestRise = 400;  // mm: heights that are tried where bodies meet
constexpr int kLooksOfASpan = 200;               // there
constexpr double kRoundOff = 1e-9;               // mm: of places of bodies, and of sums of gaps
constexpr double kAlike = 1e-6;                  // mm: places of linear axes that count as the same
constexpr double kAlikeTurn = 1e-10;             // rad: turns of the work; kAlike beyond 10 m of reach

machines::Joints joints_of(const std::array<double, 5>& q) { return {Vec3(q[0], q[1], q[2]), {q[3], q[4]}}; }

std::array<double, 5> in_radians(const std::array<double, 5>& words) {
  return {words[0], words[1], words[2], radians(words[3]), radians(words[4])};
}

/// Greatest distance of a tip from a rotary axis of the table, whatever the rotaries do.
double reach_of(const machines::KinematicChain& chain, const Vec3& tip) {
  double reach = 0, arm = 0;
  for (std::size_t k = 0; k < chain.table.size(); ++k) {
    if (k > 0) arm += (chain.table[k].point_mm - chain.table[k - 1].point_mm).norm();
    reach = (tip - chain.table.front().point_mm).norm() + arm;
  }
  return reach;
}

/// From the tip to the farthest rotary axis of the head.
double head_arm(const machines::KinematicChain& chain, double length) {
  double arm = length;
  for (const auto& axis : chain.head) arm += 2 * axis.point_mm.norm();
  return chain.head.empty() ? 0 : arm;
}

}  // namespace

MovesJudge::MovesJudge(const machines::Machine& machine, std::vector<Body> bodies, std::map<int, double> tool_length_mm,
                       const MovesOptions& options)
    : machine_(machine),
      scene_(machine.chain, std::move(bodies)),
      lengths_(std::move(tool_length_mm)),
      options_(options),
      states_(scene_.pairs().size(), State{options.look_mm, options.look_mm, std::nullopt, std::nullopt, 0}) {
  if (const machines::Links& links = scene_.links(); links.bed() > 0 && links.joints().front().rotary)
    turn_ = 3 + links.joints().front().axis;
  any_turned_ = std::any_of(scene_.pairs().begin(), scene_.pairs().end(), [&](const Pair& p) { return turns(p); });
}

bool MovesJudge::turns(const Pair& pair) const {
  return turn_ < 5 && scene_.bodies()[pair.first].link == 0 && pair.reach.front() > 0;
}

double MovesJudge::aim(const State& state) const {
  return std::max(options_.required_mm, options_.share * state.measured - options_.apart_mm);
}

void MovesJudge::add(const readback::ExecutedMove& move) {
  if (scene_.pairs().empty()) return;
  const bool other_tooth = last_ && (move.operation != last_->operation || move.tooth != last_->tooth);
  const bool comes_round = last_ && move.tooth < 0 && move.line <= last_->line;  // a loop, or the next call
  if (tooth_.size() >= kChunk || other_tooth || comes_round || move.tool != tool_) end_tooth();
  if (move.tool != tool_) flush();
  tool_ = move.tool;
  ++moves_;
  const double before = machine_z_;
  if (move.machine) machine_z_ = std::max(machine_z_, move.joints[2]);
  if (!last_ || !move.known) {
    unjudged_ += move.known ? 0 : 1;
    before_.reset();
    last_ = move;
    return;
  }
  Span span = span_to(move);
  span.machine_place = span.from[2] == before || span.to[2] == machine_z_;
  tooth_.push_back(span);
  if (before_ && (move.corner_share > 0 || last_->corner_share > 0)) tooth_.push_back(corner_before(move, span));
  before_ = last_;
  last_ = move;
}

MovesJudge::Span MovesJudge::span_to(const readback::ExecutedMove& move) const {
  Span span;
  span.from = in_radians(last_->joints);
  span.to = in_radians(move.joints);
  span.line = move.line;
  span.operation = move.operation;
  span.tooth = move.tooth;
  span.rapid = move.rapid;
  span.machine = move.machine;
  const auto moves = [&](std::size_t k) { return span.from[k] != span.to[k]; };
  span.box =
      move.rapid && !move.tcp && int(moves(0)) + int(moves(1)) + int(moves(2)) + int(moves(3)) + int(moves(4)) > 1;
  const auto length = lengths_.find(move.tool);
  const double tool = length == lengths_.end() ? 0 : length->second;
  span.off_rad = double(move.blend_axis_rad);
  span.off_mm = kRoundOff + 3 * kAlike + double(move.blend_mm) + readback::length_off_mm(move, machine_.tool_check);
  if (span.off_rad > 0) {
    const Vec3 tip = move.tcp ? move.tip : machine_.chain.forward(joints_of(span.to), tool).tip_mm;
    span.off_mm += 2 * span.off_rad * (reach_of(machine_.chain, tip) + head_arm(machine_.chain, tool));
  }
  if (move.tcp && (moves(3) || moves(4))) {
    span.tcp = true;
    span.length = tool;
    span.tip_from = machine_.chain.forward(joints_of(span.from), tool).tip_mm;
    span.tip_to = machine_.chain.forward(joints_of(span.to), tool).tip_mm;
  }
  return span;
}

/// A corner that the control may leave within a share of the blocks: every axis stays within its pieces of both.
MovesJudge::Span MovesJudge::corner_before(const readback::ExecutedMove& move, const Span& after) const {
  const Five from = in_radians(before_->joints);
  Span corner = after;
  corner.box = true;
  corner.tcp = false;
  double turned = 0, moved = 0;
  for (std::size_t k = 0; k < 5; ++k) {
    const double off = std::max(double(last_->corner_share) * std::abs(after.from[k] - from[k]),
                                double(move.corner_share) * std::abs(after.to[k] - after.from[k]));
    corner.from[k] = after.from[k] - off;
    corner.to[k] = after.from[k] + off;
    (k < 3 ? moved : turned) += off;
  }
  if (move.tcp || last_->tcp) {  // the pieces are of the tip; the linear axes follow
    const auto length = lengths_.find(move.tool);
    const double tool = length == lengths_.end() ? 0 : length->second;
    const Vec3 tip = machine_.chain.forward(joints_of(after.from), tool).tip_mm;
    corner.off_mm += moved + 2 * turned * (reach_of(machine_.chain, tip) + head_arm(machine_.chain, tool) + moved);
  }
  return corner;
}

/// Does what is proven of `a` hold of `b`, where the turn of the work moves no gap? With TCP the whole of `b` is then
/// `a` turned with the work: tips, and with them the ways of the linear axes.
bool MovesJudge::alike(const Span& a, const Span& b) const {
  for (std::size_t k = 0; k < 5; ++k) {
    if (k < 3 && (std::abs(a.from[k] - b.from[k]) > kAlike || std::abs(a.to[k] - b.to[k]) > kAlike)) return false;
    if (k >= 3 && k != turn_ && (a.from[k] != b.from[k] || a.to[k] != b.to[k])) return false;
  }
  if (a.tcp && turn_ < 5 && std::abs((a.to[turn_] - a.from[turn_]) - (b.to[turn_] - b.from[turn_])) > kAlikeTurn)
    return false;
  return b.off_mm <= a.off_mm + kAlike && b.off_rad <= a.off_rad && a.box == b.box && a.tcp == b.tcp &&
         a.length == b.length;
}

bool MovesJudge::repeats() {
  if (turn_ >= 5 || tooth_.size() >= kChunk) return false;
  auto& kept = kept_[tooth_.front().operation];
  for (const std::vector<Span>& other : kept)
    if (other.size() == tooth_.size() && std::equal(other.begin(), other.end(), tooth_.begin(),
                                                    [&](const Span& a, const Span& b) { return alike(a, b); }))
      return true;
  if (kept.size() < kKeptTeeth && kept_spans_ + tooth_.size() <= kKeptSpans) {
    kept.push_back(tooth_);
    kept_spans_ += tooth_.size();
  }
  return false;
}

void MovesJudge::end_tooth() {
  if (tooth_.empty()) return;
  const auto append = [&](Batch& batch, bool turned) {
    if (batch.spans.size() + tooth_.size() > kChunk) flush(batch, turned);
    batch.spans.insert(batch.spans.end(), tooth_.begin(), tooth_.end());
  };
  if (any_turned_) append(all_, true);
  if (repeats()) repeated_ += tooth_.size();
  else append(fresh_, false);
  tooth_.clear();
}

MovesJudge::Range MovesJudge::range_of(const Span& span) const {
  Range range;
  for (std::size_t k = 0; k < 5; ++k) {
    range.low[k] = std::min(span.from[k], span.to[k]);
    range.high[k] = std::max(span.from[k], span.to[k]);
  }
  range.off_mm = span.off_mm;
  range.off_rad = span.off_rad;
  if (!span.tcp) return range;
  const double w = std::abs(span.to[3] - span.from[3]) + std::abs(span.to[4] - span.from[4]);
  const double reach = std::max(reach_of(machine_.chain, span.tip_from), reach_of(machine_.chain, span.tip_to)) +
                       head_arm(machine_.chain, span.length);
  range.off_mm += (w * w * reach + 2 * w * (span.tip_to - span.tip_from).norm()) / 8;
  return range;
}

double MovesJudge::way(const Pair& pair, const Range& range) const {
  const std::size_t from = scene_.bodies()[pair.first].link;
  double squares = 0, sum = range.off_mm;
  for (std::size_t k = 0; k < pair.reach.size(); ++k) {
    const machines::Joint& joint = scene_.links().joints()[from + k];
    const std::size_t axis = joint.rotary ? 3 + joint.axis : joint.axis;
    const double half = (range.high[axis] - range.low[axis]) / 2;
    if (joint.rotary) sum += pair.reach[k] * (half + range.off_rad);
    else squares += half * half;
  }
  return sum + std::sqrt(squares);
}

Meeting MovesJudge::meeting(std::size_t pair, const Span& span, const Five& at, const Gap& gap) const {
  const Pair& p = scene_.pairs()[pair];
  Meeting m;
  m.first = scene_.bodies()[p.first].name;
  m.second = scene_.bodies()[p.second].name;
  m.first_kind = scene_.bodies()[p.first].kind;
  m.second_kind = scene_.bodies()[p.second].kind;
  m.neighbours = scene_.bodies()[p.second].link == scene_.bodies()[p.first].link + 1;
  m.proven_mm = gap.proven;
  m.measured_mm = gap.measured;
  m.line = span.line;
  m.operation = span.operation;
  m.tooth = span.tooth;
  m.tool = tool_;
  m.rapid = span.rapid;
  m.machine_place = span.machine_place;
  m.joints = joints_of(at);
  return m;
}

bool MovesJudge::passes(std::size_t pair, const Range& range, const Span* on_way) {
  State& state = states_[pair];
  const Pair& p = scene_.pairs()[pair];
  Five middle{};
  for (std::size_t k = 0; k < 5; ++k) middle[k] = (range.low[k] + range.high[k]) / 2;
  if (on_way && on_way->tcp) {
    const auto q =
        machine_.chain.linear_for((on_way->tip_from + on_way->tip_to) / 2, {middle[3], middle[4]}, on_way->length);
    for (int k = 0; k < 3; ++k) middle[std::size_t(k)] = q.linear_mm[k];
  }
  double far = way(p, range);
  if (on_way && on_way->tcp) far += range.off_mm;  // the middle may stand beside that of the chord
  const Gap gap = scene_.gap_of(p, joints_of(middle), aim(state) + far + kRoundOff);
  if (on_way && gap.measured < state.measured) {
    state.measured = gap.measured;
    state.nearest = meeting(pair, *on_way, middle, gap);
  }
  const double proven = gap.proven - far;
  if (proven > 0 && proven >= aim(state)) {
    state.proven = std::min(state.proven, proven);
    return true;
  }
  if (!on_way) return false;
  // What halving does not make less.
  const Range still{middle, middle, on_way->off_mm, on_way->off_rad};
  const double rest = way(p, still) + (on_way->tcp ? on_way->off_mm : 0);
  const bool may_pass = gap.proven - rest >= options_.required_mm;
  if (far - rest <= (may_pass ? kFinestThatMayPass : options_.finest_mm) || gap.measured <= 0) {
    if (proven > 0 && proven >= options_.required_mm) {
      state.proven = std::min(state.proven, proven);
      return true;
    }
    Meeting m = meeting(pair, *on_way, middle, gap);
    m.proven_mm = std::max(0.0, proven);
    if (gap.measured <= 0) {
      const Overlap o = scene_.overlap_of(p, m.joints);
      m.depth_mm = o.depth_mm;
      m.direction = o.direction;
    }
    state.failed = m;
    state.proven = m.proven_mm;
  }
  return false;
}

std::pair<MovesJudge::Span, MovesJudge::Span> MovesJudge::halves(std::size_t pair, const Span& span) const {
  Span a = span, b = span;
  if (span.box) {  // across the joint that moves the gap most
    const Pair& p = scene_.pairs()[pair];
    const std::size_t from = scene_.bodies()[p.first].link;
    std::size_t widest = 0;
    double most = -1;
    for (std::size_t k = 0; k < p.reach.size(); ++k) {
      const machines::Joint& joint = scene_.links().joints()[from + k];
      const std::size_t axis = joint.rotary ? 3 + joint.axis : joint.axis;
      if (const double moved = p.reach[k] * std::abs(span.to[axis] - span.from[axis]); moved > most) {
        most = moved;
        widest = axis;
      }
    }
    a.to[widest] = b.from[widest] = (span.from[widest] + span.to[widest]) / 2;
    return {a, b};
  }
  for (std::size_t k = 0; k < 5; ++k) a.to[k] = b.from[k] = (span.from[k] + span.to[k]) / 2;
  if (span.tcp) {
    a.tip_to = b.tip_from = (span.tip_from + span.tip_to) / 2;
    const auto q = machine_.chain.linear_for(a.tip_to, {a.to[3], a.to[4]}, span.length);
    for (int k = 0; k < 3; ++k) a.to[std::size_t(k)] = b.from[std::size_t(k)] = q.linear_mm[k];
  }
  return {a, b};
}

void MovesJudge::look_closer(std::size_t pair, const Span& whole) {
  std::vector<Span> open = {whole};
  while (!open.empty() && !states_[pair].failed) {
    const Span span = open.back();
    open.pop_back();
    if (passes(pair, range_of(span), &span) || states_[pair].failed) continue;
    auto [a, b] = halves(pair, span);
    open.push_back(b);
    open.push_back(a);
  }
}

void MovesJudge::Batch::build(const MovesJudge& judge, std::size_t node, std::size_t first, std::size_t last) {
  if (node >= nodes.size()) nodes.resize(node + 1);
  if (last - first == 1) {
    nodes[node] = judge.range_of(spans[first]);
    return;
  }
  const std::size_t middle = (first + last) / 2;
  build(judge, 2 * node + 1, first, middle);
  build(judge, 2 * node + 2, middle, last);
  const Range a = nodes[2 * node + 1], b = nodes[2 * node + 2];
  Range& out = nodes[node];
  for (std::size_t k = 0; k < 5; ++k) {
    out.low[k] = std::min(a.low[k], b.low[k]);
    out.high[k] = std::max(a.high[k], b.high[k]);
  }
  out.off_mm = std::max(a.off_mm, b.off_mm);
  out.off_rad = std::max(a.off_rad, b.off_rad);
}

void MovesJudge::look(std::size_t pair, const Batch& batch, std::size_t node, std::size_t first, std::size_t last) {
  if (states_[pair].failed) return;
  if (last - first == 1) return look_closer(pair, batch.spans[first]);
  if (passes(pair, batch.nodes[node], nullptr)) return;
  const std::size_t middle = (first + last) / 2;
  look(pair, batch, 2 * node + 1, first, middle);
  look(pair, batch, 2 * node + 2, middle, last);
}

void MovesJudge::look_at(std::size_t pair, const Batch& batch) {
  const Pair& p = scene_.pairs()[pair];
  for (const std::size_t k : {p.first, p.second})
    if (scene_.bodies()[k].kind == Kind::tool && scene_.bodies()[k].tool != tool_) return;
  State& state = states_[pair];
  if (state.failed) return raise(pair, batch);
  // Something near to begin with: what is farther need not be looked at closely.
  const std::size_t count = batch.spans.size(), step = std::max<std::size_t>(1, count / kFirstLooks);
  for (std::size_t k = 0; k < count; k += step) {
    const Span& span = batch.spans[k];
    const Gap gap = scene_.gap_of(p, joints_of(span.to), state.measured);
    if (span.box || !(gap.measured < state.measured) || gap.measured <= 0) continue;
    state.measured = gap.measured;
    state.nearest = meeting(pair, span, span.to, gap);
  }
  look(pair, batch, 0, 0, count);
  if (state.failed) raise(pair, batch);
}

void MovesJudge::raise(std::size_t pair, const Batch& batch) {
  const Pair& p = scene_.pairs()[pair];
  double& higher = states_[pair].higher;
  if (scene_.bodies()[p.first].kind == Kind::work || scene_.bodies()[p.second].kind == Kind::work) higher = INFINITY;
  const auto length = lengths_.find(tool_);
  const double tool = length == lengths_.end() ? 0 : length->second;
  const auto stands_at = [&](const Span& span, double t) {
    Five at{};
    for (std::size_t k = 0; k < 5; ++k) at[k] = (1 - t) * span.from[k] + t * span.to[k];
    machines::Joints joints = joints_of(at);
    if (higher > 0 && !span.machine) {
      const Vec3 tip = machine_.chain.forward(joints, tool).tip_mm + Vec3(0, 0, higher);
      joints = machine_.chain.linear_for(tip, joints.rotary_rad, tool);
      for (int i = 0; i < 3; ++i) {
        const auto& axis = machine_.chain.linear[std::size_t(i)];
        const double margin = machine_.limit_margin.linear_mm;
        const double within = std::clamp(joints.linear_mm[i], axis.min_mm + margin, axis.max_mm - margin);
        if (within != joints.linear_mm[i] && !span.rapid && t == 1) return false;
        joints.linear_mm[i] = within;  // what stands at the end of a travel stays there
      }
    }
    return scene_.gap_of(p, joints, options_.required_mm + 2 * kRise).proven >= options_.required_mm + kRise;
  };
  for (const Span& span : batch.spans) {
    const double far = (joints_of(span.to).linear_mm - joints_of(span.from).linear_mm).norm();
    const int looks = span.machine ? 1 : std::clamp(int(far / kRise), 1, kLooksOfASpan);
    for (int k = 1; k <= looks; ++k)
      while (higher <= kHighestRise && !stands_at(span, double(k) / looks)) higher += kRise;
  }
}

void MovesJudge::flush(Batch& batch, bool turned) {
  if (batch.spans.empty()) return;
  batch.nodes.clear();
  batch.nodes.reserve(4 * batch.spans.size());
  batch.build(*this, 0, 0, batch.spans.size());
  tbb::parallel_for(std::size_t(0), states_.size(), [&](std::size_t pair) {
    if (turns(scene_.pairs()[pair]) == turned) look_at(pair, batch);
  });
  batch.spans.clear();
}

void MovesJudge::flush() {
  end_tooth();
  flush(fresh_, false);
  flush(all_, true);
}

MovesFound MovesJudge::finish() {
  flush();
  MovesFound found;
  for (const Body& body : scene_.bodies()) found.stated += body.kind == Kind::machine ? 1 : 0;
  found.pairs = scene_.pairs().size();
  found.moves = moves_;
  found.unjudged = unjudged_;
  found.repeated = repeated_;
  found.bearing = scene_.bearing();
  found.required_mm = options_.required_mm;
  found.look_mm = options_.look_mm;
  for (const State& state : states_) {
    if (state.failed) {
      found.failed.push_back(*state.failed);
      if (state.higher > 0 && state.higher <= kHighestRise) found.failed.back().higher_mm = state.higher;
    } else if (state.nearest) {
      found.nearest.push_back(*state.nearest);
      found.nearest.back().proven_mm = state.proven;
    }
  }
  std::stable_sort(found.failed.begin(), found.failed.end(),
                   [](const Meeting& a, const Meeting& b) { return a.line < b.line; });
  std::stable_sort(found.nearest.begin(), found.nearest.end(),
                   [](const Meeting& a, const Meeting& b) { return a.proven_mm < b.proven_mm; });
  return found;
}

}  // namespace toothpath::bodies
