#include "postproc/choice/solution.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "geometry/base/angle.h"

namespace toothpath::choice {
namespace {

constexpr double kLargestStep = radians(170);  // beyond it the sense of a turn is ambiguous on a rollover axis
constexpr double kPoleStep = radians(30);      // C in one block that only a pole explains ..
constexpr double kPoleStepRatio = 4;           // .. when it is this much more than the axis itself turns
constexpr double kTiltWeight = 1e-6;           // minutes per rad: decides ties only
constexpr double kTurnWeight = 1e-9;
constexpr int kNearTurns = 3;  // whole turns about zero that are always candidates

struct Run {
  std::size_t first = 0, last = 0;  // records [first, last)
};

/// One way through a run: the commands at its records before whole turns are added.
struct Chain {
  int pair = 1;
  std::vector<RotaryPair> angles;
  RotaryPair least{}, greatest{};
};

struct State {
  std::size_t chain = 0;
  std::array<int, 2> turns{};
  double cost = 0;
  int from = -1;
};

std::vector<Run> runs_of(const path::ClPath& path) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < path.records.size(); ++i) {
    if (i == 0 || path.records[i].kind == path::MoveKind::rapid) runs.push_back({i, i});
    runs.back().last = i + 1;
  }
  return runs;
}

class Chooser {
 public:
  Chooser(const path::ClPath& path, const Mat3& rotation, const machines::KinematicChain& chain,
          const std::array<RotaryRange, 2>& ranges, machines::PoleOption pole, const std::vector<char>& switches,
          int only_pair)
      : path_(path),
        rotation_(rotation),
        chain_(chain),
        ranges_(ranges),
        pole_(pole),
        switches_(switches),
        only_pair_(only_pair),
        count_(chain.rotary_count()) {}

  Result<std::vector<RotaryPair>> choose() {
    const auto runs = runs_of(path_);
    std::vector<std::vector<Chain>> chains(runs.size());
    std::vector<std::vector<State>> states(runs.size());
    for (std::size_t r = 0; r < runs.size(); ++r) {
      Diagnostic why;
      for (const int pair : {1, 2}) {
        if (only_pair_ != 0 && pair != only_pair_) continue;
        auto chain = follow(runs[r], pair, why);
        if (chain) chains[r].push_back(std::move(*chain));
      }
      if (chains[r].empty()) return why;
      states[r] = states_of(chains[r], r == 0 ? nullptr : &chains[r - 1], r == 0 ? nullptr : &states[r - 1]);
      if (states[r].empty()) return outside(runs[r], chains[r]);
    }
    return trace_back(runs, chains, states);
  }

 private:
  Result<std::vector<machines::JointSolution>> solutions(std::size_t record) {
    const Vec3& axis = path_.records[record].axis;
    if (!cached_ || axis != cached_axis_) {
      auto s = chain_.rotary_solutions(rotation_ * axis);
      if (!s) return fail("operation {} record {}: {}", path_.operation, record, s.error().message);
      cached_ = std::move(*s);
      cached_axis_ = axis;
    }
    return *cached_;
  }

  /// Where a rotary stands through a run that leaves it free: at its zero, or where that is outside its range at the
  /// nearest tenth of a degree inside, else at the nearest command.
  double free_angle(double zero, std::size_t k) const {
    const RotaryRange& range = ranges_[k];
    if (chain_.rotary(k).rollover || range.lower > range.upper) return zero;
    const double nearest = std::clamp(zero, range.lower, range.upper);
    if (nearest == zero) return zero;
    const double tenths = degrees(nearest) * 10;
    const double even = radians((zero < nearest ? std::ceil(tenths) : std::floor(tenths)) / 10);
    return std::clamp(even, range.lower, range.upper) == even ? even : nearest;
  }
  /// One pair followed through a run. Rotaries that a pole leaves free take the angle of the neighbour.
  std::optional<Chain> follow(const Run& run, int pair, Diagnostic& why) {
    Chain chain;
    chain.pair = pair;
    std::size_t free_until[2] = {run.first, run.first};  // leading records with this rotary free
    bool exists = false;
    int wanted = pair;
    for (std::size_t i = run.first; i < run.last; ++i) {
      if (!switches_.empty() && switches_[i] != 0) wanted = 3 - wanted;
      auto list = solutions(i);
      if (!list) {
        why = list.error();
        return std::nullopt;
      }
      const machines::JointSolution* chosen = nullptr;
      for (const auto& s : *list)
        if (s.pair == wanted) chosen = &s;
      exists = exists || chosen != nullptr;
      if (chosen == nullptr) chosen = &list->front();
      RotaryPair angles = chosen->joints.rotary_rad;
      for (std::size_t k = 0; k < count_; ++k) {
        const bool is_free = chosen->free_rotary == static_cast<int>(k);
        if (i > run.first && free_until[k] < i)
          angles[k] = is_free ? chain.angles.back()[k] : nearest_turn(angles[k], chain.angles.back()[k]);
        else if (is_free) {
          angles[k] = free_angle(angles[k], k);
          free_until[k] = i + 1;
        } else
          for (auto& before : chain.angles) before[k] = angles[k];
      }
      chain.angles.push_back(angles);
    }
    if (!exists) return std::nullopt;
    for (std::size_t i = run.first + 1; i < run.last; ++i)
      if (auto problem = step_problem(i, chain.angles[i - run.first - 1], chain.angles[i - run.first])) {
        why = *problem;
        return std::nullopt;
      }
    chain.least = chain.greatest = chain.angles.front();
    for (const auto& a : chain.angles)
      for (std::size_t k = 0; k < count_; ++k) {
        chain.least[k] = std::min(chain.least[k], a[k]);
        chain.greatest[k] = std::max(chain.greatest[k], a[k]);
      }
    return chain;
  }

  std::optional<Diagnostic> step_problem(std::size_t record, const RotaryPair& a, const RotaryPair& b) const {
    const Vec3 &u = path_.records[record - 1].axis, &v = path_.records[record].axis;
    const double turn = std::atan2(u.cross(v).norm(), u.dot(v));
    for (std::size_t k = 0; k < count_; ++k) {
      const double step = std::abs(b[k] - a[k]);
      if (step >= kLargestStep)
        return fail("operation {} record {}: {} turns by {:.3f} deg in one block, limit {:.0f}", path_.operation,
                    record, chain_.rotary(k).letter, degrees(step), degrees(kLargestStep));
      if (step > kPoleStep && step > kPoleStepRatio * turn && pole_ != machines::PoleOption::slow)
        return fail(
            "operation {} record {}: the tool axis passes the pole, {} turns by {:.3f} deg in one block, limit {:.0f}",
            path_.operation, record, chain_.rotary(k).letter, degrees(step), degrees(kPoleStep));
    }
    return std::nullopt;
  }

  /// Whole turns that keep the run inside the range of rotary k. Of an axis that rolls over all are the same.
  std::pair<int, int> turns(const Chain& c, std::size_t k) const {
    if (k >= count_ || chain_.rotary(k).rollover) return {0, 0};
    return turns_within(c, k, ranges_[k]);
  }
  static std::pair<int, int> turns_within(const Chain& c, std::size_t k, const RotaryRange& range) {
    constexpr double slack = 1e-9;  // rad: a command on the limit itself is inside
    const double lowest = std::ceil((range.lower - slack - c.least[k]) / kTwoPi);
    const double highest = std::floor((range.upper + slack - c.greatest[k]) / kTwoPi);
    return {static_cast<int>(std::clamp(lowest, -1e6, 1e6)), static_cast<int>(std::clamp(highest, -1e6, 1e6))};
  }
  /// Where nothing but the margin keeps rotary k from a run: the words that name it.
  std::string margin_alone(const Chain& c, std::size_t k) const {
    const machines::RotaryAxis& axis = chain_.rotary(k);
    const auto [low, high] = turns_within(c, k, {axis.min_rad, axis.max_rad});
    return low <= high ? machines::margin_words(true, ranges_[k].lower - axis.min_rad) : "";
  }

  std::vector<State> states_of(const std::vector<Chain>& chains, const std::vector<Chain>* chains_before,
                               const std::vector<State>* before) const {
    std::vector<State> list;
    for (std::size_t c = 0; c < chains.size(); ++c) {
      const auto [low0, high0] = turns(chains[c], 0);
      const auto [low1, high1] = turns(chains[c], 1);
      std::set<int> first;
      const int near_zero = static_cast<int>(std::lround(-chains[c].angles.front()[0] / kTwoPi));
      for (int t = near_zero - kNearTurns; t <= near_zero + kNearTurns; ++t)
        first.insert(std::clamp(t, low0, std::max(low0, high0)));
      first.insert({low0, high0});  // the most room to wind up again
      if (before != nullptr)
        for (const auto& s : *before) {
          const double end = (*chains_before)[s.chain].angles.back()[0] + kTwoPi * s.turns[0];
          const int t = static_cast<int>(std::lround((end - chains[c].angles.front()[0]) / kTwoPi));
          if (t >= low0 && t <= high0) first.insert(t);
        }
      for (int t1 = std::max(low1, -1); t1 <= std::min(high1, 1); ++t1)
        for (const int t0 : first)
          if (t0 >= low0 && t0 <= high0) list.push_back({c, {t0, t1}, 0, -1});
    }
    const auto start = [&](const State& s, std::size_t k) {
      return chains[s.chain].angles.front()[k] + kTwoPi * s.turns[k];
    };
    std::stable_sort(list.begin(), list.end(), [&](const State& a, const State& b) {
      const double ta = std::abs(start(a, 1)), tb = std::abs(start(b, 1));
      if (std::abs(ta - tb) > 1e-12) return ta < tb;
      const double ca = std::abs(start(a, 0)), cb = std::abs(start(b, 0));
      return std::abs(ca - cb) > 1e-12 ? ca < cb : chains[a.chain].pair < chains[b.chain].pair;
    });
    for (auto& s : list) {
      const double own = kTiltWeight * std::abs(start(s, 1)) + kTurnWeight * std::abs(start(s, 0));
      s.cost = own;
      if (before == nullptr) continue;
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t p = 0; p < before->size(); ++p) {
        double reposition = 0;
        for (std::size_t k = 0; k < count_; ++k) {
          const double end = (*chains_before)[(*before)[p].chain].angles.back()[k] + kTwoPi * (*before)[p].turns[k];
          const double turn = start(s, k) - end;
          reposition = std::max(reposition, std::abs(chain_.rotary(k).rollover ? std::remainder(turn, kTwoPi) : turn) /
                                                chain_.rotary(k).max_speed);
        }
        const double cost = (*before)[p].cost + reposition;
        if (cost < best) {
          best = cost;
          s.from = static_cast<int>(p);
        }
      }
      s.cost = own + best;
    }
    return list;
  }

  Diagnostic outside(const Run& run, const std::vector<Chain>& chains) const {
    std::string text;
    for (const auto& c : chains)
      for (std::size_t k = 0; k < count_; ++k) {
        const auto [low, high] = turns(c, k);
        if (low <= high) continue;
        text += text.empty() ? "" : "; the other solution ";
        text += fmt::format("{} = {:.4f} .. {:.4f} deg outside [{:.4f}, {:.4f}]{}", chain_.rotary(k).letter,
                            degrees(c.least[k]), degrees(c.greatest[k]), degrees(ranges_[k].lower),
                            degrees(ranges_[k].upper), margin_alone(c, k));
        break;
      }
    return fail_as(DiagnosticKind::verification, "operation {} records {} to {}: {}", path_.operation, run.first,
                   run.last - 1, text);
  }

  std::vector<RotaryPair> trace_back(const std::vector<Run>& runs, const std::vector<std::vector<Chain>>& chains,
                                     const std::vector<std::vector<State>>& states) const {
    std::vector<RotaryPair> out(path_.records.size());
    if (runs.empty()) return out;
    const auto& last = states.back();
    int s = static_cast<int>(
        std::min_element(last.begin(), last.end(), [](const State& a, const State& b) { return a.cost < b.cost; }) -
        last.begin());
    for (std::size_t r = runs.size(); r-- > 0;) {
      const State& state = states[r][static_cast<std::size_t>(s)];
      for (std::size_t i = runs[r].first; i < runs[r].last; ++i)
        for (std::size_t k = 0; k < count_; ++k)
          out[i][k] = chains[r][state.chain].angles[i - runs[r].first][k] + kTwoPi * state.turns[k];
      s = state.from;
    }
    // An axis that rolls over goes on from where it stands.
    for (std::size_t r = 1; r < runs.size(); ++r)
      for (std::size_t k = 0; k < count_; ++k) {
        if (!chain_.rotary(k).rollover) continue;
        const double shift = whole_turns(out[runs[r].first][k], out[runs[r].first - 1][k]);
        for (std::size_t i = runs[r].first; i < runs[r].last; ++i) out[i][k] += shift;
      }
    return out;
  }

  const path::ClPath& path_;
  Mat3 rotation_;
  const machines::KinematicChain& chain_;
  std::array<RotaryRange, 2> ranges_;
  machines::PoleOption pole_;
  const std::vector<char>& switches_;
  int only_pair_;
  std::size_t count_;
  std::optional<std::vector<machines::JointSolution>> cached_;
  Vec3 cached_axis_ = Vec3::Zero();
};

}  // namespace

double whole_turns(double angle, double reference) { return kTwoPi * std::round((reference - angle) / kTwoPi); }

double nearest_turn(double angle, double reference) { return angle + whole_turns(angle, reference); }

Result<std::vector<RotaryPair>> choose_rotaries(const path::ClPath& path, const Mat3& table_from_gear,
                                                const machines::KinematicChain& chain,
                                                const std::array<RotaryRange, 2>& ranges, machines::PoleOption pole,
                                                const std::vector<char>& switches, int only_pair) {
  return Chooser(path, table_from_gear, chain, ranges, pole, switches, only_pair).choose();
}

}  // namespace toothpath::choice
