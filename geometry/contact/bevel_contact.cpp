#include "geometry/contact/bevel_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/base/angle.h"
#include "geometry/contact/touch_search.h"

namespace toothpath::contact {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr int kHalvings = 14;  // of the grid's steps: some tenths of a micrometre along the flank

/// One wall of the pair on a grid of the wheel.
class Roll {
 public:
  Roll(const BevelPair& pair, int sigma, const BevelContactOptions& options)
      : pair_(pair), sigma_(sigma), options_(options) {
    tau_ = pair.wheel().pitch();
    step_ = tau_ / options.steps;
    for (std::size_t h = 0; h < pair.wheel().halves().size(); ++h)
      patterns_.push_back(wheel_grid(pair, static_cast<int>(h), sigma, options.rows, options.columns));
  }

  Result<BevelContact> run() {
    if (!meet()) return never();
    BevelContact out;
    out.sigma = sigma_;
    pair_error();
    cycle(out);
    gaps(out);
    mismatch(out);
    out.patterns = std::move(patterns_);
    return out;
  }

  Result<std::vector<double>> mismatch_alone() {
    if (!meet()) return never();
    BevelContact unused;
    mismatch(unused);
    std::vector<double> all;
    for (const BevelPattern& g : patterns_) all.insert(all.end(), g.mismatch_mm.begin(), g.mismatch_mm.end());
    return all;
  }

 private:
  struct Meeting {
    int first = 0;              ///< index of the first position [steps from 0]
    std::vector<double> error;  ///< sigma (phi_1 - nominal) at every position; NaN: not on the pinion's flank
    double least = kNothing;    ///< over all turns of the wheel, between the positions too
    double at = 0;              ///< turn of the wheel there
  };
  struct Least {
    double error = std::numeric_limits<double>::infinity();
    int half = 0;
    double ell = 0, height = 0;
  };

  std::optional<double> error(int half, const Vec3& point, double phi_2, bevel_gear::BevelInverse& start) const {
    return pair_.error_at(half, sigma_, point, phi_2, start);
  }

  [[nodiscard]] Diagnostic never() const { return fail("the walls of sigma = {:+d} never meet", sigma_); }

  /// When and how far from the pinion every place is: about the turn at which it passes the pitch plane. False:
  /// nowhere.
  bool meet() {
    const int window = static_cast<int>(std::ceil(1.4 * options_.steps));
    for (const BevelPattern& g : patterns_) {
      std::vector<Meeting> of_places;
      for (const BevelPlace& place : g.places) {
        Meeting m;
        if (place.point.allFinite()) {
          const int middle = static_cast<int>(std::lround(-std::atan2(place.point.y(), place.point.x()) / step_));
          m.first = middle - window;
          bevel_gear::BevelInverse start;
          for (int k = m.first; k <= middle + window; ++k)
            m.error.push_back(error(g.half, place.point, k * step_, start).value_or(kNothing));
          refine(g, place, m);
          first_ = std::min(first_, m.first);
          last_ = std::max(last_, middle + window);
        }
        of_places.push_back(std::move(m));
      }
      meetings_.push_back(std::move(of_places));
    }
    return first_ <= last_;
  }

  /// Least error over all turns, about the best position. Nothing where the pinion's flank ends before.
  void refine(const BevelPattern& g, const BevelPlace& place, Meeting& m) const {
    std::size_t best = m.error.size();
    for (std::size_t k = 0; k < m.error.size(); ++k)
      if (!std::isnan(m.error[k]) && (best == m.error.size() || m.error[k] < m.error[best])) best = k;
    if (best == m.error.size()) return;
    m.at = (m.first + static_cast<int>(best)) * step_;
    if (best == 0 || best + 1 == m.error.size() || std::isnan(m.error[best - 1]) || std::isnan(m.error[best + 1]))
      return;
    bevel_gear::BevelInverse start;
    const auto early = [&](double s) { return -error(g.half, place.point, s, start).value_or(-kNever); };
    m.at = highest_place(early, m.at - step_, m.at + step_);
    m.least = -early(m.at);
  }

  /// Least error of one pair at every position: grid, then between the grid's places.
  void pair_error() {
    std::vector<BevelNear> grid;
    for (int k = first_; k <= last_; ++k) {
      Least best;
      for (std::size_t h = 0; h < meetings_.size(); ++h) {
        grid.clear();
        for (std::size_t p = 0; p < meetings_[h].size(); ++p) {
          const BevelPlace& place = patterns_[h].places[p];
          grid.push_back({error_of(meetings_[h][p], k), place.ell, place.height});
        }
        const auto first = pair_.first_met(static_cast<int>(h), sigma_, k * step_, grid, options_.columns, kHalvings);
        if (first.error < best.error) best = {first.error, static_cast<int>(h), first.ell, first.height};
      }
      pair_least_.push_back(best);
    }
  }
  /// Of a place at a position; infinite where it is not on the pinion's flank.
  static double error_of(const Meeting& m, int k) {
    const int at = k - m.first;
    const bool known = at >= 0 && at < static_cast<int>(m.error.size());
    const double e = known ? m.error[static_cast<std::size_t>(at)] : kNothing;
    return std::isnan(e) ? std::numeric_limits<double>::infinity() : e;
  }

  [[nodiscard]] const Least* pair_at(int k) const {
    if (k < first_ || k > last_) return nullptr;
    const Least& l = pair_least_[static_cast<std::size_t>(k - first_)];
    return std::isinf(l.error) ? nullptr : &l;
  }

  [[nodiscard]] BevelPosition position(int k, const Least& l, int tooth) const {
    BevelPosition at;
    at.phi_2 = k * step_;
    at.phi_1 = pair_.nominal_turn(at.phi_2) + sigma_ * l.error;
    at.error_rad = l.error, at.half = l.half, at.tooth = tooth, at.ell = l.ell, at.height = l.height;
    return at;
  }

  /// All pairs: pair j stands where pair 0 stands j pitches later.
  void cycle(BevelContact& out) {
    const double lever = mean_lever();
    double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0, marking = 0;
    out.least_marking = std::numeric_limits<int>::max();
    std::vector<int> bears;  // counted from first_
    for (int k = 0; k < options_.steps; ++k) {
      const Least* first = nullptr;
      int tooth = 0;
      const int most = (last_ - first_) / options_.steps + 2;
      for (int j = -most; j <= most; ++j)
        if (const Least* l = pair_at(k + j * options_.steps); l && (!first || l->error < first->error))
          first = l, tooth = j;
      BevelPosition at = position(k, first ? *first : Least{}, tooth);
      for (int j = -most; j <= most; ++j)
        if (const Least* l = pair_at(k + j * options_.steps);
            l && (l->error - at.error_rad) * lever <= options_.compound_mm)
          ++at.marking;
      bears.push_back(k + tooth * options_.steps - first_);
      low = std::min(low, at.error_rad), high = std::max(high, at.error_rad);
      sum += at.error_rad, marking += at.marking;
      out.least_marking = std::min(out.least_marking, at.marking);
      out.most_marking = std::max(out.most_marking, at.marking);
      out.cycle.push_back(at);
    }
    std::vector<double> alone;
    for (int k = first_; k <= last_; ++k) {
      const Least* l = pair_at(k);
      alone.push_back(l ? l->error : kNothing);
      if (l) out.pair.push_back(position(k, *l, 0));
    }
    out.error_range_rad = with_handovers(alone, bears, high) - low;
    out.error_mean_rad = sum / options_.steps;
    out.error_range_mm = out.error_range_rad * pair_.pinion().R_m() * pair_.pinion().sin_delta();
    out.marking_ratio = marking / options_.steps;
  }

  double mean_lever() const {
    const auto& g = patterns_.front();
    const auto& place = g.places[g.places.size() / 2];
    return pair_.lever(place, -std::atan2(place.point.y(), place.point.x()));
  }

  void gaps(const BevelContact& out) {
    for (std::size_t h = 0; h < patterns_.size(); ++h) {
      BevelPattern& g = patterns_[h];
      std::size_t marked = 0;
      for (std::size_t p = 0; p < g.places.size(); ++p) {
        const Meeting& m = meetings_[h][p];
        double least = kNothing;
        int then = 0;
        for (std::size_t k = 0; k < m.error.size(); ++k) {
          if (std::isnan(m.error[k])) continue;
          const int at = (((m.first + static_cast<int>(k)) % options_.steps) + options_.steps) % options_.steps;
          const double gap = m.error[k] - out.cycle[static_cast<std::size_t>(at)].error_rad;
          if (!(gap > least)) least = gap, then = m.first + static_cast<int>(k);
        }
        const bool met = !std::isnan(least);
        const auto on = met ? pair_.on_pinion(g.places[p].point, then * step_) : bevel_gear::ConePoint{};
        g.pinion_ell_mm.push_back(met ? on.ell : kNothing);
        g.pinion_height_mm.push_back(met ? on.height : kNothing);
        if (met) least = std::max(0.0, least) * pair_.lever(g.places[p], m.at);
        g.gap_mm.push_back(least);
        if (least <= options_.compound_mm) ++marked;
      }
      g.marked_share = static_cast<double>(marked) / static_cast<double>(g.places.size());
    }
  }

  void mismatch(BevelContact& out) {
    double sum = 0, square = 0;
    std::size_t count = 0;
    for (std::size_t h = 0; h < patterns_.size(); ++h)
      for (std::size_t p = 0; p < patterns_[h].places.size(); ++p) {
        const Meeting& m = meetings_[h][p];
        const double value = std::isnan(m.least) ? kNothing : m.least * pair_.lever(patterns_[h].places[p], m.at);
        patterns_[h].mismatch_mm.push_back(value);
        if (!std::isnan(value)) sum += value, ++count;
      }
    const double mean = sum / static_cast<double>(std::max<std::size_t>(count, 1));
    out.mismatch_min_mm = std::numeric_limits<double>::infinity();
    out.mismatch_max_mm = -out.mismatch_min_mm;
    for (auto& g : patterns_)
      for (double& value : g.mismatch_mm) {
        value -= mean;
        if (std::isnan(value)) continue;
        out.mismatch_min_mm = std::min(out.mismatch_min_mm, value);
        out.mismatch_max_mm = std::max(out.mismatch_max_mm, value);
        square += value * value;
      }
    out.mismatch_rms_mm = std::sqrt(square / static_cast<double>(std::max<std::size_t>(count, 1)));
  }

  const BevelPair& pair_;
  int sigma_;
  BevelContactOptions options_;
  double tau_ = 0, step_ = 0;
  std::vector<BevelPattern> patterns_;
  std::vector<std::vector<Meeting>> meetings_;
  int first_ = std::numeric_limits<int>::max(), last_ = std::numeric_limits<int>::min();
  std::vector<Least> pair_least_;
};

}  // namespace

BevelPattern wheel_grid(const BevelPair& pair, int half, int sigma, int rows, int columns) {
  BevelPattern g;
  g.half = half;
  g.rows = rows;
  g.columns = columns;
  const auto& h = pair.wheel().halves()[static_cast<std::size_t>(half)];
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double height = pair.lowest(half) + (pair.highest() - pair.lowest(half)) * i / (rows - 1);
      const double ell = h.ell_from + (h.ell_to - h.ell_from) * j / (columns - 1);
      const auto place = pair.wheel_place(half, sigma, ell, height);
      g.places.push_back(place ? *place : BevelPlace{ell, height, Vec3::Constant(kNothing), Vec3::Constant(kNothing)});
    }
  return g;
}

namespace {

std::optional<Diagnostic> problem_of(const BevelContactOptions& options) {
  if (options.rows >= 3 && options.columns >= 3 && options.steps >= 4) return std::nullopt;
  return fail("grid of {} x {} places and {} positions: at least 3 x 3 and 4 are needed", options.rows, options.columns,
              options.steps);
}

}  // namespace

Result<BevelContact> bevel_contact(const BevelPair& pair, int sigma, const BevelContactOptions& options) {
  if (auto problem = problem_of(options)) return *std::move(problem);
  return Roll(pair, sigma, options).run();
}

Result<std::vector<double>> bevel_mismatch(const BevelPair& pair, int sigma, const BevelContactOptions& options) {
  if (auto problem = problem_of(options)) return *std::move(problem);
  return Roll(pair, sigma, options).mismatch_alone();
}

}  // namespace toothpath::contact
