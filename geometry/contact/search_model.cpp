#include "geometry/contact/modification_search.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <type_traits>

namespace toothpath::contact {
namespace {

constexpr int kWidestReach = 5;

/// Least of a function known at three neighbours with the least in the middle.
double vertex(double below, double at, double above) {
  const double bend = below - 2 * at + above;
  return bend > 0 ? at - (above - below) * (above - below) / (8 * bend) : at;
}

/// A list of a map, row by row, column by column.
template <typename T>
std::vector<T> by_columns(const std::vector<T>& by_rows, int rows, int columns) {
  std::vector<T> out;
  for (int c = 0; c < columns; ++c)
    for (int r = 0; r < rows; ++r)
      out.push_back(
          by_rows[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(c)]);
  return out;
}

}  // namespace

SearchFlank::SearchFlank(int rows_of_map, int columns_of_map, const EaseOffMap& map,
                         const std::vector<BeyondMargins>& margins, double motion_lever)
    : rows(rows_of_map),
      columns(columns_of_map),
      gap(by_columns(map.gap_mm, rows, columns)),
      phi(by_columns(map.phi_2, rows, columns)),
      bend(by_columns(map.bend_mm, rows, columns)) {
  const auto beyond = by_columns(margins, rows, columns);
  for (std::size_t k = 0; k < beyond.size(); ++k)
    if (const auto edge = std::find_if(beyond[k].begin(), beyond[k].end(), [](double by) { return by <= 0; });
        edge != beyond[k].end())
      in_margins.push_back({k, k, 0, Edge(edge - beyond[k].begin())});
  const auto bounds = margin_bounds(rows, columns, beyond);
  in_margins.insert(in_margins.end(), bounds.begin(), bounds.end());
  for (std::size_t k = 0; k < gap.size(); ++k)
    if (std::isnan(gap[k])) unmet.push_back(k);
  if (map.lever_mm.empty()) return;
  per_motion = by_columns(map.lever_mm, rows, columns);
  for (std::size_t k = 0; k < per_motion.size(); ++k) {
    per_motion[k] /= motion_lever;
    gap[k] /= per_motion[k];
    bend[k] /= per_motion[k];
  }
}

void SearchFlank::add_removals(const std::vector<SearchedModification>& searched, int side, double step,
                               const Removal& removal) {
  for (const auto& s : searched)
    for (const double way : {1.0, -1.0}) {
      auto& of_way = way > 0 ? up : down;
      of_way.emplace_back();
      if (s.side != 0 && s.side != side) continue;
      for (std::size_t n = 0; n < std::max<std::size_t>(1, s.lengths_mm.size()); ++n) {
        const auto m = modification_of(s, way, static_cast<int>(n), side);
        const auto asked = [&](int when) {
          auto list = by_columns(removal(m, s.on_pinion, when), rows, columns);
          for (std::size_t k = 0; k < list.size(); ++k)
            list[k] = std::isnan(gap[k]) ? 0 : list[k] / distance_per_motion(k);
          return list;
        };
        Taken taken{asked(0), {}, {}};
        if (step > 0 && s.on_pinion) {
          const auto before = asked(-1), after = asked(1);
          for (std::size_t k = 0; k < before.size(); ++k) {
            taken.slope.push_back((after[k] - before[k]) / (2 * step));
            taken.bend.push_back((after[k] - 2 * taken.value[k] + before[k]) / (step * step));
          }
        }
        of_way.back().push_back(std::move(taken));
      }
    }
}

SearchModel::SearchModel(std::vector<SearchFlank> flanks, double pitch, int steps)
    : flanks_(std::move(flanks)), step_(pitch / steps), steps_(steps) {
  double low = kUnmet, high = -kUnmet;
  for (const SearchFlank& flank : flanks_)
    for (const double phi : flank.phi) {
      if (std::isnan(phi)) continue;
      low = std::min(low, phi);
      high = std::max(high, phi);
    }
  start_ = low;
  turns_ = static_cast<int>((high - low) / step_) + 2;
  for (SearchFlank& flank : flanks_) place_turns(flank);
}

void SearchModel::place_turns(SearchFlank& flank) const {
  for (int k = 0; k < turns_; ++k)
    for (int c = 0; c < flank.columns; ++c) {
      int best = -1;
      double nearest = kUnmet;
      for (int r = 0; r < flank.rows; ++r) {
        const auto n = static_cast<std::size_t>(c * flank.rows + r);
        const double away = std::abs(flank.phi[n] - (start_ + step_ * k));
        if (away < nearest) nearest = away, best = r;  // a NaN is not below
      }
      flank.nearest_row.push_back(best);
    }
}

SearchModel::Sums SearchModel::sums(const std::vector<double>& amounts_mm, const std::vector<int>& lengths) const {
  Sums out;
  for (const SearchFlank& flank : flanks_) out.push_back({flank.gap, {}, {}});
  for (std::size_t s = 0; s < amounts_mm.size(); ++s) add(out, s, amounts_mm[s], lengths[s], 1);
  return out;
}

void SearchModel::add(Sums& to, std::size_t s, double amount_mm, int length, double times) const {
  for (std::size_t m = 0; m < flanks_.size(); ++m) {
    const SearchFlank::Taken* taken = flanks_[m].taken(s, amount_mm, length);
    if (taken == nullptr) continue;
    const double size = times * std::abs(amount_mm);
    auto& [gap, slope, bend] = to[m];
    for (std::size_t k = 0; k < gap.size(); ++k) gap[k] += size * taken->value[k];
    if (taken->slope.empty()) continue;
    if (slope.empty()) slope.assign(gap.size(), 0), bend = flanks_[m].bend;
    for (std::size_t k = 0; k < gap.size(); ++k) {
      slope[k] += size * taken->slope[k];
      bend[k] += size * taken->bend[k];
    }
  }
}

SearchModel::Removal SearchModel::removal(const std::vector<double>& amounts_mm, const std::vector<int>& lengths,
                                          const std::vector<SearchedModification>& searched) const {
  Removal out;
  for (const SearchFlank& flank : flanks_)
    for (const bool on_pinion : {false, true}) {
      std::vector<double> sum(flank.gap.size(), 0);
      for (std::size_t s = 0; s < amounts_mm.size(); ++s) {
        const auto* taken = searched[s].on_pinion == on_pinion ? flank.taken(s, amounts_mm[s], lengths[s]) : nullptr;
        if (taken == nullptr) continue;
        for (std::size_t k = 0; k < sum.size(); ++k)
          sum[k] += std::abs(amounts_mm[s]) * taken->value[k] * flank.distance_per_motion(k);
      }
      const double most = *std::max_element(sum.begin(), sum.end());
      out.sum_mm += most;
      out.most_mm = std::max(out.most_mm, most);
    }
  return out;
}

/// The motion curve of a candidate, turn by turn as it is asked for.
class SearchModel::Curve {
 public:
  Curve(const SearchModel& model, const Sums& sums)
      : model_(model),
        pair_(static_cast<std::size_t>(model.turns_), kUnmet),
        curve_(static_cast<std::size_t>(model.steps_), kUnmet),
        bears_(static_cast<std::size_t>(model.steps_), -1) {
    for (std::size_t m = 0; m < sums.size(); ++m) flanks_.push_back(changed(model.flanks_[m], sums[m]));
  }

  /// At turn n of a pitch: of all pairs, tooth j stands where tooth 0 stands j pitches later.
  double at(int n) {
    double& least = curve_[static_cast<std::size_t>(n)];
    int& bears = bears_[static_cast<std::size_t>(n)];
    if (bears >= 0) return least;
    bears = 0;
    for (int k = n; k < model_.turns_; k += model_.steps_) {
      double& own = pair_[static_cast<std::size_t>(k)];
      for (std::size_t m = 0; m < flanks_.size(); ++m) own = std::min(own, motion(m, k));
      if (own < least) least = own, bears = k;
    }
    if (least < low_) low_ = least, worst_.low = n;
    if (least > high_) high_ = least, worst_.high = n;
    return least;
  }
  /// Peak to peak of what was asked for so far.
  [[nodiscard]] double range() const { return high_ > low_ ? high_ - low_ : 0; }
  /// After all turns: where one pair takes over from another, too.
  [[nodiscard]] double whole_range() const { return with_handovers(pair_, bears_, high_) - low_; }

  /// What a place in the margins of a flank keeps above the curve; kUnmet where nothing meets it.
  double gap_in_margins(std::size_t m, std::size_t n) {
    const MarginBound& at = model_.flanks_[m].in_margins[n];
    const double within = gap(m, at.within);
    if (at.share == 0 || within == kUnmet) return within;
    const double beyond = gap(m, at.beyond);
    return beyond == kUnmet ? kUnmet : within + at.share * (beyond - within);
  }
  /// The same of any place.
  double gap(std::size_t m, std::size_t k) {
    const SearchFlank& flank = model_.flanks_[m];
    const double own = flanks_[m].gap[k];
    if (std::isnan(flank.gap[k])) return kUnmet;
    double place = (flanks_[m].phi[k] - model_.start_) / model_.step_;
    while (place < 0) place += model_.steps_;
    const int whole = static_cast<int>(place);
    const double share = place - whole, here = at(whole % model_.steps_), next = at((whole + 1) % model_.steps_);
    return (own - (here + share * (next - here))) * flank.distance_per_motion(k);
  }
  [[nodiscard]] const Worst& worst() const { return worst_; }

 private:
  /// A flank with what a candidate takes.
  struct Changed {
    std::vector<double> gap, phi, bend;
  };
  static Changed changed(const SearchFlank& flank, const FlankSums& sums) {
    Changed out{sums.gap, flank.phi, sums.slope.empty() ? flank.bend : sums.bend};
    // e + r + r' t + b/2 t^2 at t = turn - phi is nearest elsewhere, and there by less. A third of the bend stays.
    for (std::size_t k = 0; k < sums.slope.size(); ++k) {
      const double bend = std::max(sums.bend[k], flank.bend[k] / 3), slope = sums.slope[k];
      out.bend[k] = bend;
      out.gap[k] -= slope * slope / (2 * bend);
      out.phi[k] -= slope / bend;
    }
    for (const std::size_t k : flank.unmet) out.gap[k] = kUnmet, out.phi[k] = out.bend[k] = 0;
    return out;
  }

  /// Least of N places of a column, between them by a parabola.
  template <int N>
  static double least_of(const double* gap, const double* phi, const double* bend, double turn) {
    using Places = Eigen::Array<double, N, 1>;
    using On = Eigen::Map<const Places>;
    const Places away = turn - On(phi), value = On(gap) + 0.5 * On(bend) * away * away;
    int low = 0;
    const double least = value.minCoeff(&low);
    return low > 0 && low + 1 < N && value[low - 1] < kUnmet && value[low + 1] < kUnmet
               ? vertex(value[low - 1], least, value[low + 1])
               : least;
  }
  /// Least of a column at turn k, about its row that is nearest on the flank as it stands.
  [[nodiscard]] double of_column(std::size_t m, int c, int k) const {
    const SearchFlank& flank = model_.flanks_[m];
    const int middle = flank.nearest_row[static_cast<std::size_t>(k * flank.columns + c)];
    if (middle < 0) return kUnmet;
    const double turn = model_.start_ + model_.step_ * k;
    const auto least = [&]<int N>(std::integral_constant<int, N>) {
      const int first = std::clamp(middle - flank.reach, 0, flank.rows - N);
      const auto at = static_cast<std::size_t>(c * flank.rows + first);
      return least_of<N>(flanks_[m].gap.data() + at, flanks_[m].phi.data() + at, flanks_[m].bend.data() + at, turn);
    };
    constexpr int kWide = 2 * kWidestReach + 2, kNarrow = 6;  // even: two at a time
    if (flank.reach > kNarrow / 2 && flank.rows >= kWide) return least(std::integral_constant<int, kWide>{});
    if (flank.rows >= kNarrow) return least(std::integral_constant<int, kNarrow>{});
    return least(std::integral_constant<int, 3>{});  // of the smallest grid
  }
  /// Least of a flank at turn k, between its columns by a parabola.
  [[nodiscard]] double motion(std::size_t m, int k) const {
    double before = kUnmet, last = kUnmet, best = kUnmet;
    for (int c = 0; c < model_.flanks_[m].columns; ++c) {
      const double here = of_column(m, c, k);
      if (last < kUnmet && last <= before && last <= here)
        best = std::min(best, before < kUnmet && here < kUnmet ? vertex(before, last, here) : last);
      before = last, last = here;
    }
    return std::min(best, last);
  }

  const SearchModel& model_;
  std::vector<Changed> flanks_;
  std::vector<double> pair_, curve_;
  std::vector<int> bears_;
  double low_ = kUnmet, high_ = -kUnmet;
  Worst worst_;
};

SearchModel::Judged SearchModel::judge(const Sums& sums, Worst& worst, const Enough& enough) const {
  Curve curve(*this, sums);
  Judged judged;
  judged.margin_gap_mm = kUnmet;
  // What was worst last time.
  curve.at(worst.low);
  curve.at(worst.high);
  if (worst.place != Worst::kNowhere) judged.margin_gap_mm = curve.gap_in_margins(worst.flank, worst.place);
  judged.error_mm = curve.range();
  if (enough(judged.error_mm, judged.margin_gap_mm)) return judged;
  for (const int stride : {4, 1}) {
    for (int n = 0; n < steps_; n += stride) curve.at(n);
    judged.error_mm = stride > 1 ? curve.range() : curve.whole_range();
    if (enough(judged.error_mm, judged.margin_gap_mm)) return judged;
  }
  const Worst before = worst;
  worst = curve.worst();
  worst.flank = before.flank, worst.place = before.place;
  judged.margin_gap_mm = kUnmet;
  for (std::size_t m = 0; m < flanks_.size(); ++m)
    for (std::size_t k = 0; k < flanks_[m].in_margins.size(); ++k) {
      const double gap = curve.gap_in_margins(m, k);
      if (gap >= judged.margin_gap_mm) continue;
      judged.margin_gap_mm = gap;
      worst.flank = m, worst.place = k;
      judged.nearest = flanks_[m].in_margins[k].edge;
    }
  return judged;
}

SearchModel::Judged SearchModel::judge(const std::vector<double>& amounts_mm, const std::vector<int>& lengths) const {
  Worst worst;
  return judge(sums(amounts_mm, lengths), worst, [](double, double) { return false; });
}

}  // namespace toothpath::contact
