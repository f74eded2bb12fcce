#include "geometry/contact/modification_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

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

/// The search on the models of all sides.
class Search {
 public:
  Search(const std::vector<SearchedSide>& sides, const std::vector<SearchedModification>& searched,
         const SearchOptions& options)
      : sides_(sides), searched_(searched), options_(options), spoils_(sides.size(), 0) {}

  /// Micrometres of error, ten for every one that the margins lack, summed over the sides; a thousandth for every one
  /// that is taken. Judges the sides that `changed` [which, or 0: all] belongs to; the others are as they were.
  double score(Candidate& c, int changed, double at_least) {
    ++judged;
    amounts_.clear();
    double taken = 0;
    for (const int u : c.units) {
      amounts_.push_back(u * options_.unit_mm);
      taken += std::abs(u) * options_.unit_mm;
    }
    c.sides.resize(sides_.size());
    const auto touched = [&](std::size_t s) { return changed == 0 || sides_[s].side == changed; };
    for (std::size_t s = 0; s < sides_.size(); ++s)
      if (touched(s)) c.sides[s] = {};
    const auto now = [&] {
      OfSide sum;
      for (const OfSide& side : c.sides) sum.error += side.error, sum.lack += side.lack;
      return 1e3 * (sum.error + 10 * sum.lack + 1e-3 * taken);
    };
    for (std::size_t s = 0; s < sides_.size(); ++s)
      if (touched(s) && !judge_side(s, c, now, at_least)) break;
    return now();
  }

  void descend(Candidate& c) {
    const auto n = c.units.size();
    for (int step = 64; step > 0; step /= 2)
      for (bool better = true; better;) {
        better = false;
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
      }
  }

  long judged = 0;

 private:
  /// False: the candidate is as bad as `at_least` already.
  template <typename Now>
  bool judge_side(std::size_t s, Candidate& c, const Now& now, double at_least) {
    const auto& models = sides_[s].models;
    for (std::size_t n = 0; n < models.size(); ++n) {
      // The one that spoilt the last candidate first: most are spoilt by the same.
      const std::size_t m = n == 0 ? spoils_[s] : n <= spoils_[s] ? n - 1 : n;
      const auto found = models[m].judge(amounts_, c.lengths);
      c.sides[s].error = std::max(c.sides[s].error, found.error_mm);
      c.sides[s].lack = std::max(c.sides[s].lack, sides_[s].wanted_gap_mm - found.margin_gap_mm);
      if (now() < at_least) continue;
      spoils_[s] = m;
      return false;
    }
    return true;
  }
  [[nodiscard]] bool fits(std::size_t s, int units) const {
    const int largest = largest_of(searched_[s], options_);
    return units <= largest && units >= (searched_[s].both_ways ? -largest : 0);
  }
  bool moved(Candidate& c, std::size_t i, int by_i, std::size_t j, int by_j) {
    Candidate next = c;
    next.units[i] += by_i;
    next.units[j] += by_j;
    return fits(i, next.units[i]) && fits(j, next.units[j]) && taken(c, std::move(next), of_both(i, j));
  }
  bool lengthened(Candidate& c, std::size_t i, int way) {
    Candidate next = c;
    next.lengths[i] += way;
    if (next.lengths[i] < 0 || next.lengths[i] >= static_cast<int>(searched_[i].lengths_mm.size())) return false;
    return c.units[i] != 0 && taken(c, std::move(next), searched_[i].side);
  }
  /// The side that both belong to; 0: all.
  [[nodiscard]] int of_both(std::size_t i, std::size_t j) const {
    return searched_[i].side == searched_[j].side ? searched_[i].side : 0;
  }
  bool taken(Candidate& c, Candidate next, int changed) {
    next.score = score(next, changed, c.score);
    if (!(next.score < c.score)) return false;
    c = std::move(next);
    return true;
  }

  const std::vector<SearchedSide>& sides_;
  const std::vector<SearchedModification>& searched_;
  const SearchOptions& options_;
  std::vector<std::size_t> spoils_;
  std::vector<double> amounts_;
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

constexpr std::size_t kStarts = 4;

}  // namespace

SearchResult search_modifications(const std::vector<SearchedSide>& sides,
                                  const std::vector<SearchedModification>& searched, const SearchOptions& options,
                                  const SearchResult* known) {
  std::vector<Candidate> starts = lattice(searched, options);
  if (known != nullptr) starts = {{known->units, known->lengths, kUnmet, {}}};
  std::vector<long> judged(starts.size());
  tbb::parallel_for(std::size_t(0), starts.size(), [&](std::size_t k) {
    Search search(sides, searched, options);
    starts[k].score = search.score(starts[k], 0, kUnmet);
    judged[k] = search.judged;
  });
  std::stable_sort(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
  starts.resize(std::min(starts.size(), kStarts));
  tbb::parallel_for(std::size_t(0), starts.size(), [&](std::size_t k) {
    Search search(sides, searched, options);
    search.descend(starts[k]);
    judged[k] += search.judged;
  });
  const Candidate& best =
      *std::min_element(starts.begin(), starts.end(), [](const auto& a, const auto& b) { return a.score < b.score; });
  SearchResult result;
  result.units = best.units;
  result.lengths = best.lengths;
  result.score = best.score;
  for (const long n : judged) result.judged += n;
  std::vector<double> amounts;
  for (const int u : best.units) amounts.push_back(u * options.unit_mm);
  result.margin_gap_mm = kUnmet;
  result.inside = true;
  for (const SearchedSide& side : sides)
    for (std::size_t m = 0; m < side.models.size(); ++m) {
      const auto found = side.models[m].judge(amounts, best.lengths);
      result.error_mm = std::max(result.error_mm, found.error_mm);
      if (found.margin_gap_mm < side.wanted_gap_mm) result.inside = false;
      if (found.margin_gap_mm >= result.margin_gap_mm) continue;
      result.margin_gap_mm = found.margin_gap_mm;
      result.limiting = m;
      result.nearest = found.nearest;
    }
  return result;
}

}  // namespace toothpath::contact
