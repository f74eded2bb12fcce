#include "geometry/contact/modification_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numeric>

#include "geometry/base/work_share.h"

namespace toothpath::contact {

modification::Modification modification_of(const SearchedModification& searched, double amount_mm, int length,
                                           int side) {
  modification::Modification m;
  m.kind = searched.kind;
  m.amount_mm = amount_mm;
  m.zone = searched.zone;
  m.flanks = side == 0  ? modification::Flanks::both
             : side > 0 ? modification::Flanks::right
                        : modification::Flanks::left;
  if (modification::is_relief(m.kind)) m.length_mm = searched.lengths_mm[static_cast<std::size_t>(length)];
  return m;
}

namespace {

/// In units.
int largest_of(const SearchedModification& searched, const SearchOptions& options) {
  return static_cast<int>(std::floor(std::min(options.largest_mm, searched.largest_mm) / options.unit_mm + 1e-9));
}

/// What the models of one side make of a candidate, mm.
struct OfSide {
  double error = 0;  ///< the greatest
  double lack = 0;   ///< of the margins
};

struct Candidate {
  std::vector<int> units, lengths;
  double score = kUnmet;
  std::vector<OfSide> sides;
};

/// What is made least. Either the errors and what the margins lack, or the removal of candidates that stay within
/// limits.
struct Goal {
  double of_taken = 1e-3;           ///< micrometres for every one that is taken, beside those of the errors
  std::vector<OfSide> limits = {};  ///< of every side: the removal is made least
  [[nodiscard]] bool removal() const { return !limits.empty(); }
};

constexpr double kSure = 1e-9;             // mm: margins keep so much more, above rounding
constexpr int kLongest = 64, kMiddle = 8;  // units of a step
constexpr double kOfAmounts = 0.05;        // of the amounts themselves, beside the removal

/// The search on the models of all sides. Steps go on from one candidate, whose sums are kept.
class Search {
 public:
  Search(const std::vector<SearchedSide>& sides, const std::vector<SearchedModification>& searched,
         const SearchOptions& options, Goal goal)
      : sides_(sides), searched_(searched), options_(options), goal_(std::move(goal)) {
    for (const SearchedSide& side : sides) {
      sums_.emplace_back(side.models.size());
      next_.emplace_back(side.models.size());
      worst_.emplace_back(side.models.size());
      order_.emplace_back(side.models.size());
      std::iota(order_.back().begin(), order_.back().end(), std::size_t(0));
    }
  }

  /// Begins with a candidate: its score.
  double start(Candidate& c) {
    const auto amounts = amounts_of(c);
    for (std::size_t s = 0; s < sides_.size(); ++s)
      for (std::size_t m = 0; m < sums_[s].size(); ++m) next_[s][m] = sides_[s].models[m].sums(amounts, c.lengths);
    c.score = score(c, nullptr, {}, kUnmet);
    std::swap(sums_, next_);
    return c.score;
  }

  /// From where it began, by steps of these units and ever less.
  void descend(Candidate& c, int longest, int shortest, WorkShare& share) {
    for (int step = longest; step >= shortest; step /= 2) {
      while (stepped(c, step)) {}
      share.add();
    }
  }
  /// Leaves out what need not be, the largest first.
  bool dropped(Candidate& c) {
    std::vector<std::size_t> order(c.units.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return std::abs(c.units[a]) > std::abs(c.units[b]); });
    bool any = false;
    for (const std::size_t i : order)
      if (c.units[i] != 0) any |= moved(c, i, -c.units[i], i, 0);
    return any;
  }

  long judged = 0;

 private:
  /// A round of steps of one and two amounts, and of lengths. False: none was better.
  bool stepped(Candidate& c, int step) {
    const auto n = c.units.size();
    bool better = false;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i; j < n; ++j) {
        if (searched_[i].side * searched_[j].side < 0) continue;  // neither knows of the other
        for (const auto& [a, b] : {std::pair(1, 1), {-1, -1}, {1, -1}, {-1, 1}}) {
          if (i == j && a != b) continue;
          while (moved(c, i, a * step, j, i == j ? 0 : b * step)) better = true;
        }
      }
    for (std::size_t i = 0; i < n; ++i)
      for (const int way : {1, -1})
        while (lengthened(c, i, way)) better = true;
    return better;
  }

  [[nodiscard]] double amount(int units) const { return units * options_.unit_mm; }
  [[nodiscard]] std::vector<double> amounts_of(const Candidate& c) const {
    std::vector<double> amounts;
    for (const int u : c.units) amounts.push_back(amount(u));
    return amounts;
  }

  /// Of a candidate that differs from `from` [null: from nothing, the sums are made] in these modifications. Given up
  /// when it is as bad as `at_least`.
  double score(Candidate& c, const Candidate* from, std::array<std::size_t, 2> differs, double at_least) {
    ++judged;
    double taken = 0;
    for (const int u : c.units) taken += std::abs(amount(u));
    if (goal_.removal()) {
      double removal = kOfAmounts * taken;
      for (const SearchedSide& side : sides_)
        removal += side.models.front().removal(amounts_of(c), c.lengths, searched_).sum_mm;
      if (removal >= at_least) return removal;
      for (std::size_t s = 0; s < sides_.size(); ++s)
        if (touched(s, from, differs) && !keeps_limits(s, c, from, differs)) return kUnmet;
      return removal;
    }
    c.sides.resize(sides_.size());
    for (std::size_t s = 0; s < sides_.size(); ++s)
      if (touched(s, from, differs)) c.sides[s] = {};
    const auto now = [&] {
      double sum = goal_.of_taken * taken;
      for (const OfSide& side : c.sides) sum += side.error + 10 * side.lack;
      return sum;
    };
    for (std::size_t s = 0; s < sides_.size(); ++s) {
      if (!touched(s, from, differs)) continue;
      OfSide& side = c.sides[s];
      const bool all = judge_side(s, c, from, differs, [&](double error, double gap) {
        const OfSide before = side;
        side = {std::max(side.error, error), std::max(side.lack, wanted(s) - gap)};
        const bool enough = now() >= at_least;
        if (!enough) side = before;
        return enough;
      });
      if (!all) break;
    }
    return now();
  }
  [[nodiscard]] double wanted(std::size_t s) const { return sides_[s].wanted_gap_mm + kSure; }
  [[nodiscard]] bool touched(std::size_t s, const Candidate* from, std::array<std::size_t, 2> differs) const {
    const auto belongs = [&](std::size_t n) { return searched_[n].side == 0 || searched_[n].side == sides_[s].side; };
    return from == nullptr || belongs(differs[0]) || belongs(differs[1]);
  }
  bool keeps_limits(std::size_t s, Candidate& c, const Candidate* from, std::array<std::size_t, 2> differs) {
    const OfSide limit = goal_.limits[s];
    return judge_side(s, c, from, differs,
                      [&](double error, double gap) { return error > limit.error || wanted(s) - gap > limit.lack; });
  }

  /// Judges the models of one side, those first that spoilt the candidates before. False: `enough` ended it.
  /// @param enough  told the error and the gap of a model when they are known, and before what they are at best
  template <typename Enough>
  bool judge_side(std::size_t s, Candidate& c, const Candidate* from, std::array<std::size_t, 2> differs,
                  const Enough& enough) {
    auto& order = order_[s];
    for (std::size_t n = 0; n < order.size(); ++n) {
      const std::size_t m = order[n];
      const SearchModel& model = sides_[s].models[m];
      if (from != nullptr) {
        next_[s][m] = sums_[s][m];
        for (std::size_t k = 0; k < 2; ++k) {
          const std::size_t i = differs[k];
          if (k == 1 && i == differs[0]) continue;
          model.add(next_[s][m], i, amount(from->units[i]), from->lengths[i], -1);
          model.add(next_[s][m], i, amount(c.units[i]), c.lengths[i], 1);
        }
      }
      const auto found = model.judge(next_[s][m], worst_[s][m], enough);
      const bool ended = enough(found.error_mm, found.margin_gap_mm);
      if (!ended) {
        known(s, c, found);
        continue;
      }
      std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n),
                  order.begin() + static_cast<std::ptrdiff_t>(n) + 1);
      return false;
    }
    return true;
  }
  void known(std::size_t s, Candidate& c, const SearchModel::Judged& found) const {
    if (goal_.removal()) return;
    c.sides[s] = {std::max(c.sides[s].error, found.error_mm),
                  std::max(c.sides[s].lack, wanted(s) - found.margin_gap_mm)};
  }

  [[nodiscard]] bool fits(std::size_t s, int units) const {
    const int largest = largest_of(searched_[s], options_);
    return units <= largest && units >= (searched_[s].both_ways ? -largest : 0);
  }
  bool moved(Candidate& c, std::size_t i, int by_i, std::size_t j, int by_j) {
    Candidate next = c;
    next.units[i] += by_i;
    next.units[j] += by_j;
    return fits(i, next.units[i]) && fits(j, next.units[j]) && taken(c, std::move(next), {i, j});
  }
  bool lengthened(Candidate& c, std::size_t i, int way) {
    Candidate next = c;
    next.lengths[i] += way;
    if (next.lengths[i] < 0 || next.lengths[i] >= static_cast<int>(searched_[i].lengths_mm.size())) return false;
    return c.units[i] != 0 && taken(c, std::move(next), {i, i});
  }
  bool taken(Candidate& c, Candidate next, std::array<std::size_t, 2> differs) {
    next.score = score(next, &c, differs, c.score);
    if (!(next.score < c.score)) return false;
    for (std::size_t s = 0; s < sides_.size(); ++s)
      if (touched(s, &c, differs)) std::swap(sums_[s], next_[s]);
    c = std::move(next);
    return true;
  }

  const std::vector<SearchedSide>& sides_;
  const std::vector<SearchedModification>& searched_;
  const SearchOptions& options_;
  const Goal goal_;
  std::vector<std::vector<SearchModel::Sums>> sums_, next_;  ///< of every side and model
  std::vector<std::vector<SearchModel::Worst>> worst_;
  std::vector<std::vector<std::size_t>> order_;  ///< of every side: its models
};

constexpr int kFar = 7;  // compounds

/// Multiples of the compound from which the search starts: crownings, slopes, reliefs. What belongs to one side or one
/// of many flanks starts as the first of its kind does.
std::vector<Candidate> lattice(const std::vector<SearchedModification>& searched, const SearchOptions& options) {
  const int unit = std::max(1, static_cast<int>(std::lround(options.compound_mm / options.unit_mm)));
  std::vector<Candidate> all(1);
  for (std::size_t n = 0; n < searched.size(); ++n) {
    const auto& s = searched[n];
    const auto first = std::find_if(searched.begin(), searched.begin() + static_cast<std::ptrdiff_t>(n),
                                    [&](const auto& o) { return o.side != 0 && o.kind == s.kind; });
    if (const auto as = static_cast<std::size_t>(first - searched.begin()); s.side != 0 && as < n) {
      for (Candidate& c : all) {
        c.units.push_back(c.units[as]);
        c.lengths.push_back(c.lengths[as]);
      }
      continue;
    }
    const int largest = largest_of(s, options);
    std::vector<int> levels = {0, 2 * unit};
    if (s.kind == modification::Kind::lead_crowning) levels = {unit, 3 * unit};
    if (s.both_ways) levels = {-2 * unit, 0, 2 * unit};
    if (s.from_far) levels.push_back(kFar * unit);
    std::vector<Candidate> next;
    for (const Candidate& c : all)
      for (const int level : levels) {
        next.push_back(c);
        next.back().units.push_back(std::clamp(level, -largest, largest));
        next.back().lengths.push_back(static_cast<int>(s.lengths_mm.size()) / 2);
      }
    all = std::move(next);
  }
  all.push_back(all.front());  // nothing at all
  std::fill(all.back().units.begin(), all.back().units.end(), 0);
  return all;
}

constexpr std::size_t kStarts = 4, kFine = 3;
constexpr double kThrifty[] = {3e-3, 1e-2};  // micrometres of error for every one that is taken
constexpr double kLatticeWorth = 4;          // steps of a descent

int halvings(int longest, int shortest) {
  int n = 1;
  for (; longest > shortest; longest /= 2) ++n;
  return n;
}

/// All that is searched, and how far it has come.
class Rounds {
 public:
  Rounds(const std::vector<SearchedSide>& sides, const std::vector<SearchedModification>& searched,
         const SearchOptions& options, std::vector<Candidate> starts)
      : sides_(sides),
        searched_(searched),
        options_(options),
        all_(std::move(starts)),
        kept_(std::min(all_.size(), kStarts)),
        fine_(std::min(all_.size(), kFine)),
        share_(kLatticeWorth + double(kept_) * halvings(kLongest, kMiddle) + double(fine_) * halvings(kMiddle / 2, 1) +
               double(2 * std::size(kThrifty) + fine_) * halvings(kLongest, 1)) {}

  /// The best; `least` gets the one with the least errors.
  Candidate run(Candidate& least) {
    rate();
    all_.resize(kept_);
    descend(all_, {}, kLongest, kMiddle);
    sort();
    all_.resize(fine_);
    descend(all_, {}, kMiddle / 2, 1);
    sort();
    least = all_.front();
    std::vector<Candidate> thrifty(std::size(kThrifty), all_.front());
    each(thrifty, [&](std::size_t k, Candidate& c) {
      Search search(sides_, searched_, options_, {kThrifty[k]});
      search.start(c);
      search.descend(c, kLongest, 1, share_);
      return search.judged;
    });
    all_.insert(all_.end(), thrifty.begin(), thrifty.end());
    return least_removal(least.sides);
  }
  [[nodiscard]] long judged() const { return judged_; }

 private:
  /// Does something with each of a list, in parallel; it returns how many candidates it judged.
  template <typename Work>
  void each(std::vector<Candidate>& list, const Work& work) {
    std::vector<long> judged(list.size());
    tbb::parallel_for(std::size_t(0), list.size(), [&](std::size_t k) { judged[k] = work(k, list[k]); });
    for (const long n : judged) judged_ += n;
  }
  void rate() {
    const double worth = kLatticeWorth / double(all_.size());
    each(all_, [&](std::size_t, Candidate& c) {
      Search search(sides_, searched_, options_, {});
      search.start(c);
      share_.add(worth);
      return search.judged;
    });
    sort();
  }
  void descend(std::vector<Candidate>& list, const Goal& goal, int longest, int shortest) {
    each(list, [&](std::size_t, Candidate& c) {
      Search search(sides_, searched_, options_, goal);
      search.start(c);
      search.descend(c, longest, shortest, share_);
      return search.judged;
    });
  }
  void sort() {
    std::stable_sort(all_.begin(), all_.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
  }
  /// From each candidate whose errors are nearly equal to the least ones: what takes least off.
  Candidate least_removal(const std::vector<OfSide>& least) {
    Goal goal;
    for (const OfSide& side : least)
      goal.limits.push_back({options_.nearly_equal_to(side.error), side.lack > 0 ? side.lack + 2 * kSure : 0});
    each(all_, [&](std::size_t, Candidate& c) {
      Search search(sides_, searched_, options_, goal);
      if (search.start(c) == kUnmet) {
        share_.add(halvings(kLongest, 1));
        return search.judged;
      }
      search.dropped(c);
      search.descend(c, kLongest, 1, share_);
      WorkShare again(share_, 1, 0);
      while (search.dropped(c)) search.descend(c, kMiddle, 1, again);
      return search.judged;
    });
    return *std::min_element(all_.begin(), all_.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
  }

  const std::vector<SearchedSide>& sides_;
  const std::vector<SearchedModification>& searched_;
  const SearchOptions& options_;
  std::vector<Candidate> all_;
  std::size_t kept_, fine_;
  long judged_ = 0;
  WorkShare share_;
};

/// The models of all sides on a candidate.
void judge_all(const std::vector<SearchedSide>& sides, const std::vector<double>& amounts,
               const std::vector<int>& lengths, SearchResult& result) {
  result.margin_gap_mm = kUnmet;
  result.error_mm = 0;
  result.inside = true;
  result.side_error_mm.assign(sides.size(), 0);
  for (std::size_t s = 0; s < sides.size(); ++s)
    for (std::size_t m = 0; m < sides[s].models.size(); ++m) {
      const auto found = sides[s].models[m].judge(amounts, lengths);
      result.side_error_mm[s] = std::max(result.side_error_mm[s], found.error_mm);
      result.error_mm = std::max(result.error_mm, found.error_mm);
      if (found.margin_gap_mm < sides[s].wanted_gap_mm) result.inside = false;
      if (found.margin_gap_mm >= result.margin_gap_mm) continue;
      result.margin_gap_mm = found.margin_gap_mm;
      result.limiting = m;
      result.nearest = found.nearest;
    }
}

}  // namespace

SearchResult search_modifications(const std::vector<SearchedSide>& sides,
                                  const std::vector<SearchedModification>& searched, const SearchOptions& options,
                                  const SearchResult* known) {
  std::vector<Candidate> starts = lattice(searched, options);
  if (known != nullptr)
    starts = {{known->units, known->lengths, kUnmet, {}}, {known->least_units, known->least_lengths, kUnmet, {}}};
  Rounds rounds(sides, searched, options, std::move(starts));
  Candidate least;
  const Candidate best = rounds.run(least);
  SearchResult result;
  result.units = best.units;
  result.lengths = best.lengths;
  result.judged = rounds.judged();
  result.least_units = least.units;
  result.least_lengths = least.lengths;
  for (const OfSide& side : least.sides) result.lack_mm += side.lack;
  std::vector<double> amounts;
  for (const int u : best.units) amounts.push_back(u * options.unit_mm);
  for (const SearchedSide& side : sides) {
    const auto removal = side.models.front().removal(amounts, best.lengths, searched);
    result.removal.sum_mm += removal.sum_mm;
    result.removal.most_mm = std::max(result.removal.most_mm, removal.most_mm);
  }
  judge_all(sides, amounts, best.lengths, result);
  for (std::size_t s = 0; s < sides.size(); ++s)
    result.least_error_mm.push_back(std::min(least.sides[s].error, result.side_error_mm[s]));
  for (std::size_t n = 0; n < amounts.size(); ++n) {
    if (amounts[n] == 0) continue;
    SearchResult without;
    auto rest = amounts;
    rest[n] = 0;
    judge_all(sides, rest, best.lengths, without);
    result.without.push_back({n, without.error_mm, without.margin_gap_mm});
  }
  return result;
}

bool preferred(const SearchResult& a, const SearchResult& b, const SearchOptions& options) {
  if (a.inside != b.inside) return a.inside;
  const auto least = [](const SearchResult& r) {
    return std::accumulate(r.least_error_mm.begin(), r.least_error_mm.end(), 10 * r.lack_mm);
  };
  if (!a.inside) return least(a) < least(b);
  bool near_a = true, near_b = true;
  for (std::size_t s = 0; s < a.side_error_mm.size(); ++s) {
    const double most = options.nearly_equal_to(std::min(a.least_error_mm[s], b.least_error_mm[s]));
    near_a = near_a && a.side_error_mm[s] <= most;
    near_b = near_b && b.side_error_mm[s] <= most;
  }
  if (near_a != near_b) return near_a;
  return near_a ? a.removal.sum_mm < b.removal.sum_mm : least(a) < least(b);
}

}  // namespace toothpath::contact
