#include "geometry/modification/smooth_curve.h"

#include <cmath>
#include <optional>

namespace toothpath::modification {
namespace {

/// A polynomial over [from, to], by its Taylor series about the middle: its terms with rounding, their sum as wide as
/// the interval makes it.
Interval over(const SmoothCurve::Piece& p, double from, double to, std::size_t order) {
  constexpr std::size_t n = SmoothCurve::kMostTerms;
  const double middle = 0.5 * from + 0.5 * to;
  std::array<Interval, n> c;
  for (std::size_t k = 0; k < n; ++k) c[k] = Interval(p.c[k]);
  const Interval shift = Interval(middle) - Interval(p.origin);
  for (std::size_t first = 0; first + 1 < n; ++first)  // shifted by repeated division
    for (std::size_t k = n - 1; k-- > first;) c[k] = c[k] + shift * c[k + 1];
  const Interval reach = Interval(from, to) - Interval(middle);
  Interval sum(0);
  for (std::size_t k = n; k-- > order;) {
    double factor = 1;
    for (std::size_t m = 0; m < order; ++m) factor *= double(k - m);
    sum = sum * reach + Interval(factor) * c[k];
  }
  return sum;
}

}  // namespace

Interval SmoothCurve::derivative(const Interval& x, std::size_t order) const {
  if (!x.finite()) return Interval::whole();
  std::optional<Interval> all;
  const auto add = [&](const Interval& part) { all = all ? hull(*all, part) : part; };
  const auto add_beyond = [&](const Interval& off, double end, const Piece& p) {
    const Interval slope = over(p, end, end, 1);
    if (order == 0) add(over(p, end, end, 0) + slope * off);
    else add(order == 1 ? slope : Interval(0));
  };
  if (x.low < knots_.front())
    add_beyond(Interval(x.low, std::min(x.high, knots_.front())) - Interval(knots_.front()), knots_.front(),
               pieces_.front());
  if (x.high > knots_.back())
    add_beyond(Interval(std::max(x.low, knots_.back()), x.high) - Interval(knots_.back()), knots_.back(),
               pieces_.back());
  const auto first = std::upper_bound(knots_.begin(), knots_.end(), x.low);
  std::size_t k = first == knots_.begin() ? 0 : std::size_t(first - knots_.begin()) - 1;
  if (k > 0) --k;  // a knot itself belongs to both
  for (; k < pieces_.size() && knots_[k] <= x.high; ++k)
    if (knots_[k + 1] >= x.low)
      add(over(pieces_[k], std::max(x.low, knots_[k]), std::min(x.high, knots_[k + 1]), order));
  return *all;
}

SmoothCurve SmoothCurve::spline(const std::vector<double>& x, const std::vector<double>& y) {
  const std::size_t n = x.size();
  // Second derivatives at the knots, 0 at both ends: a tridiagonal system, solved from the left and back.
  std::vector<double> bend(n, 0.0), share(n, 0.0);
  for (std::size_t k = 1; k + 1 < n; ++k) {
    const double a = x[k] - x[k - 1], b = x[k + 1] - x[k], pivot = 2 * (a + b) - a * share[k - 1];
    share[k] = b / pivot;
    bend[k] = (6 * ((y[k + 1] - y[k]) / b - (y[k] - y[k - 1]) / a) - a * bend[k - 1]) / pivot;
  }
  for (std::size_t k = n - 1; k-- > 1;) bend[k] -= share[k] * bend[k + 1];
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double h = x[k + 1] - x[k];
    pieces.push_back({x[k],
                      {y[k], (y[k + 1] - y[k]) / h - h * (2 * bend[k] + bend[k + 1]) / 6, bend[k] / 2,
                       (bend[k + 1] - bend[k]) / (6 * h)}});
  }
  return {x, std::move(pieces)};
}

SmoothCurve SmoothCurve::hermite(std::vector<double> x, const std::vector<double>& y,
                                 const std::vector<double>& slopes) {
  std::vector<Piece> pieces;
  for (std::size_t k = 0; k + 1 < x.size(); ++k) {
    const double step = x[k + 1] - x[k], v = y[k], d = slopes[k], e = slopes[k + 1], rise = (y[k + 1] - v) / step;
    pieces.push_back({x[k], {v, d, (3 * rise - 2 * d - e) / step, (d + e - 2 * rise) / (step * step)}});
  }
  return {std::move(x), std::move(pieces)};
}

double SmoothCurve::bent_to() const {
  for (std::size_t k = pieces_.size(); k-- > 0;)
    for (std::size_t n = 2; n < kMostTerms; ++n)
      if (pieces_[k].c[n] != 0) return knots_[k + 1];
  return knots_.front();
}

SmoothCurve SmoothCurve::mirrored(double sum) const {
  std::vector<double> knots;
  std::vector<Piece> pieces;
  for (std::size_t k = knots_.size(); k-- > 0;) knots.push_back(sum - knots_[k]);
  for (std::size_t k = pieces_.size(); k-- > 0;) {
    Piece p = pieces_[k];
    p.origin = sum - p.origin;
    for (std::size_t n = 1; n < kMostTerms; n += 2) p.c[n] = -p.c[n];
    pieces.push_back(p);
  }
  return {std::move(knots), std::move(pieces)};
}

SmoothCurve SmoothCurve::times(double factor) const {
  SmoothCurve out = *this;
  for (Piece& p : out.pieces_)
    for (double& c : p.c) c *= factor;
  return out;
}

}  // namespace toothpath::modification
