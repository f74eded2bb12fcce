// The meridian of a surface of revolution: a line through points, straight or bent in rounded corners.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "geometry/base/base_of.h"
#include "geometry/base/vec.h"
#include "geometry/flank_grid/cubic_curve.h"

namespace toothpath::flank_grid {

/// A line y(x) through points that rise in x, its corners rounded: around a corner at x_k where the slope grows by D,
/// y'' = (D/w) (1 - |x - x_k|/w) for |x - x_k| < w. So y is twice continuous, leaves the corner by |D| w/6 and bends by
/// |D|/w at most.
class RoundedLine {
 public:
  struct Corner {
    double x = 0, turn = 0, half = 0;  ///< place, D, w
    [[nodiscard]] double off() const { return std::abs(turn) * half / 6; }
  };
  RoundedLine() = default;
  /// @param half  w of every point but the first and the last; no two neighbours together above the way between them
  RoundedLine(const std::vector<Vec2>& points, const std::vector<double>& half);

  [[nodiscard]] const std::vector<Corner>& corners() const { return corners_; }
  [[nodiscard]] bool straight() const { return corners_.empty(); }
  void raise(double by) { curve_.shift(0, by); }
  /// y, or a derivative of it; it goes on straight beyond the points.
  template <typename S>
  [[nodiscard]] S at(const S& x, std::size_t order = 0) const {
    return lifted(curve_.derivatives(base_of(x), kDepth<S> + int(order), 0, 1), x, order, 0);
  }

 private:
  std::vector<Corner> corners_;
  CubicCurve<1> curve_;
};

/// x runs along the straight line from the first point to the last, y out of the body.
struct Meridian {
  Vec2 start = Vec2::Zero();                           ///< (r, z)
  Vec2 along = Vec2::UnitX(), normal = Vec2::UnitY();  ///< of length 1; normal: out of the body
  RoundedLine bent;                                    ///< y(x)
  [[nodiscard]] Vec2 local(const Vec2& rz) const { return {along.dot(rz - start), normal.dot(rz - start)}; }
  template <typename S>
  [[nodiscard]] std::array<S, 2> place(const S& x) const {
    const S y = bent.at(x);
    return {S(start[0]) + S(along[0]) * x + S(normal[0]) * y, S(start[1]) + S(along[1]) * x + S(normal[1]) * y};
  }
  /// Out of the body, of length 1.
  template <typename S>
  [[nodiscard]] std::array<S, 2> outwards(const S& x) const {
    using std::sqrt;
    const S slope = bent.at(x, 1), length = sqrt(S(S(1.0) + slope * slope));
    return {(S(normal[0]) - S(along[0]) * slope) / length, (S(normal[1]) - S(along[1]) * slope) / length};
  }
  /// x of the place below (r, z), above which that stands square.
  [[nodiscard]] double foot(const Vec2& rz) const;
  /// By how much it bends at x, 1/mm: positive where it is hollow.
  [[nodiscard]] double curvature(double x) const {
    return bent.at(x, 2) / std::pow(1 + std::pow(bent.at(x, 1), 2), 1.5);
  }
  /// Distance of (r, z), positive above.
  [[nodiscard]] double height(const Vec2& rz) const {
    const double x = foot(rz);
    const auto p = place(x), n = outwards(x);
    return n[0] * (rz[0] - p[0]) + n[1] * (rz[1] - p[1]);
  }
};

}  // namespace toothpath::flank_grid
