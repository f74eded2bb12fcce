#include "geometry/contact/modification_search.h"

#include <algorithm>
#include <array>
#include <cmath>

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
                         const std::vector<Edges>& edges_of_map, double motion_lever)
    : rows(rows_of_map),
      columns(columns_of_map),
      gap(by_columns(map.gap_mm, rows, columns)),
      phi(by_columns(map.phi_2, rows, columns)),
      bend(by_columns(map.bend_mm, rows, columns)),
      edges(by_columns(edges_of_map, rows, columns)) {
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

SearchModel::Changed SearchModel::changed(const SearchFlank& flank, const std::vector<double>& amounts_mm,
                                          const std::vector<int>& lengths) {
  Changed out{flank.gap, {}, {}};
  auto& [gap, phi, bend] = out;
  std::vector<double> slope;
  for (std::size_t s = 0; s < amounts_mm.size(); ++s) {
    const double size = std::abs(amounts_mm[s]);
    if (size == 0) continue;
    const auto& of_way = (amounts_mm[s] > 0 ? flank.up : flank.down)[s];
    if (of_way.empty()) continue;
    const auto& taken = of_way[static_cast<std::size_t>(lengths[s])];
    for (std::size_t k = 0; k < gap.size(); ++k) gap[k] += size * taken.value[k];
    if (taken.slope.empty()) continue;
    if (slope.empty()) slope.assign(gap.size(), 0), bend = flank.bend;
    for (std::size_t k = 0; k < gap.size(); ++k) {
      slope[k] += size * taken.slope[k];
      bend[k] += size * taken.bend[k];
    }
  }
  if (!slope.empty()) {
    // e + r + r' t + b/2 t^2 at t = turn - phi is nearest elsewhere, and there by less. A third of the bend stays.
    phi = flank.phi;
    for (std::size_t k = 0; k < gap.size(); ++k) {
      bend[k] = std::max(bend[k], flank.bend[k] / 3);
      gap[k] -= slope[k] * slope[k] / (2 * bend[k]);
      phi[k] -= slope[k] / bend[k];
    }
  }
  return out;
}

double SearchModel::motion(const SearchFlank& flank, const Changed& changed, int k) const {
  const auto &gap = changed.gap, &phi = changed.phi.empty() ? flank.phi : changed.phi,
             &bend = changed.bend.empty() ? flank.bend : changed.bend;
  const double turn = start_ + step_ * k;
  double before = kUnmet, last = kUnmet, best = kUnmet;
  for (int c = 0; c < flank.columns; ++c) {
    const int middle = flank.nearest_row[static_cast<std::size_t>(k * flank.columns + c)];
    double of_column = kUnmet;
    if (middle >= 0) {
      std::array<double, 2 * kWidestReach + 1> value;
      value.fill(kUnmet);
      for (int n = -flank.reach; n <= flank.reach; ++n) {
        const int r = middle + n;
        if (r < 0 || r >= flank.rows) continue;
        const auto at = static_cast<std::size_t>(c * flank.rows + r);
        if (std::isnan(phi[at])) continue;
        const double away = turn - phi[at];
        value[static_cast<std::size_t>(n + kWidestReach)] = gap[at] + 0.5 * bend[at] * away * away;
      }
      const auto low = static_cast<std::size_t>(std::min_element(value.begin(), value.end()) - value.begin());
      of_column = low > 0 && low + 1 < value.size() && value[low - 1] < kUnmet && value[low + 1] < kUnmet
                      ? vertex(value[low - 1], value[low], value[low + 1])
                      : value[low];
    }
    if (last < kUnmet && last <= before && last <= of_column)
      best = std::min(best, before < kUnmet && of_column < kUnmet ? vertex(before, last, of_column) : last);
    before = last, last = of_column;
  }
  return std::min(best, last);
}

SearchModel::Judged SearchModel::judge(const std::vector<double>& amounts_mm, const std::vector<int>& lengths) const {
  std::vector<Changed> flanks;
  for (const SearchFlank& flank : flanks_) flanks.push_back(changed(flank, amounts_mm, lengths));
  // The motion curve of one pair, then that of all pairs: tooth j stands where tooth 0 stands j pitches later.
  std::vector<double> pair(static_cast<std::size_t>(turns_), kUnmet), curve(static_cast<std::size_t>(steps_), kUnmet);
  std::vector<int> bears(static_cast<std::size_t>(steps_), 0);
  for (int k = 0; k < turns_; ++k) {
    double& least = pair[static_cast<std::size_t>(k)];
    for (std::size_t m = 0; m < flanks_.size(); ++m) least = std::min(least, motion(flanks_[m], flanks[m], k));
    const auto n = static_cast<std::size_t>(k % steps_);
    if (least < curve[n]) curve[n] = least, bears[n] = k;
  }
  Judged judged;
  const auto [low, high] = std::minmax_element(curve.begin(), curve.end());
  judged.error_mm = with_handovers(pair, bears, *high) - *low;
  judged.margin_gap_mm = kUnmet;
  for (std::size_t m = 0; m < flanks_.size(); ++m)
    for (std::size_t k = 0; k < flanks_[m].gap.size(); ++k) {
      const SearchFlank& flank = flanks_[m];
      const double own = flanks[m].gap[k];
      if (flank.edges[k] == 0 || std::isnan(own)) continue;
      double place = ((flanks[m].phi.empty() ? flank.phi : flanks[m].phi)[k] - start_) / step_;
      while (place < 0) place += steps_;
      const int whole = static_cast<int>(place);
      const double share = place - whole, here = curve[static_cast<std::size_t>(whole % steps_)],
                   next = curve[static_cast<std::size_t>((whole + 1) % steps_)];
      const double gap = (own - (here + share * (next - here))) * flank.distance_per_motion(k);
      if (gap >= judged.margin_gap_mm) continue;
      judged.margin_gap_mm = gap;
      int edge = 0;
      while ((flank.edges[k] >> edge & 1) == 0) ++edge;
      judged.nearest = Edge(edge);
    }
  return judged;
}

}  // namespace toothpath::contact
