#include "geometry/flank_grid/meridian.h"

#include <algorithm>

namespace toothpath::flank_grid {

RoundedLine::RoundedLine(const std::vector<Vec2>& points, const std::vector<double>& half) {
  const auto slope = [&](std::size_t k) {
    return (points[k + 1].y() - points[k].y()) / (points[k + 1].x() - points[k].x());
  };
  curve_.begin(points.front().x());
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    const Vec2 &a = points[k], &b = points[k + 1];
    const double m = slope(k), from = k > 0 ? half[k] : 0, to = k + 2 < points.size() ? half[k + 1] : 0;
    // What corners leave of the chord.
    if (from + to < b.x() - a.x()) curve_.add(b.x() - to)[0] = {a.y() + m * from, m, 0, 0};
    if (!(to > 0)) continue;
    const double w = to, turn = slope(k + 1) - m, y = b.y() - m * w;
    corners_.push_back({b.x(), turn, w});
    curve_.add(b.x())[0] = {y, m, 0, turn / (6 * w * w)};
    curve_.add(b.x() + w)[0] = {b.y() + turn * w / 6, m + 0.5 * turn, 0.5 * turn / w, -turn / (6 * w * w)};
  }
}

double Meridian::foot(const Vec2& rz) const {
  constexpr int kSteps = 60;
  const Vec2 c = local(rz);
  double x = c.x();
  if (bent.straight()) return x - (bent.at(x) - c.y()) * bent.at(x, 1) / (1 + std::pow(bent.at(x, 1), 2));
  // (x - c_x) + (y - c_y) y' = 0: its slope is kept positive, where the place lies above a hollow's centre, too.
  double best = x, least = INFINITY;
  for (int k = 0; k < kSteps; ++k) {
    const double y = bent.at(x), m = bent.at(x, 1), lack = (x - c.x()) + (y - c.y()) * m,
                 rate = 1 + m * m + (y - c.y()) * bent.at(x, 2);
    if (std::abs(lack) < least) least = std::abs(lack), best = x;
    const double step = lack / std::max(rate, 0.25);
    x -= step;
    if (std::abs(step) <= 1e-15 * (1 + std::abs(x))) break;
  }
  return best;
}

}  // namespace toothpath::flank_grid
