// The tensor cubic spline through a grid of points: twice continuous, not-a-knot at all four ends. Its last cubics go
// on beyond the grid by a share of its length; from there it goes on straight, which is no part of any gear.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "geometry/base/vec.h"
#include "geometry/flank_grid/lifted.h"

namespace toothpath::flank_grid {

/// By how much of its length the last cubic goes on.
inline constexpr double kMostBeyond = 0.1;

class TensorSpline {
 public:
  TensorSpline() = default;
  /// @param points  row by row: one row for each u, in it one point for each v
  TensorSpline(std::vector<double> u, std::vector<double> v, const std::vector<Vec3>& points);

  [[nodiscard]] const std::vector<double>& u() const { return u_; }
  [[nodiscard]] const std::vector<double>& v() const { return v_; }
  /// Where pieces begin and end, besides the first and the last, which have no end.
  [[nodiscard]] const std::vector<double>& breaks_v() const { return break_v_; }
  [[nodiscard]] double height() const { return u_.back() - u_.front(); }
  [[nodiscard]] double length() const { return v_.back() - v_.front(); }

  /// Derivatives up to an order, at a place or enclosed over a box.
  template <typename B>
  [[nodiscard]] Partials<B> partials(const B& u, const B& v, int order) const {
    Partials<B> out;
    const std::size_t i0 = piece_of(break_u_, low_of(u)), i1 = piece_of(break_u_, high_of(u)),
                      j0 = piece_of(break_v_, low_of(v)), j1 = piece_of(break_v_, high_of(v));
    for (std::size_t i = i0; i <= i1; ++i)
      for (std::size_t j = j0; j <= j1; ++j) {
        const Partials<B> here = of_piece<B>(i, j, u, v, order);
        const bool first = i == i0 && j == j0;
        for (std::size_t a = 0; a <= std::size_t(order); ++a)
          for (std::size_t b = 0; a + b <= std::size_t(order); ++b)
            for (int k = 0; k < 3; ++k)
              if (first) out.d[a][b][k] = here.d[a][b][k];
              else widen(out.d[a][b][k], here.d[a][b][k]);
      }
    return out;
  }
  [[nodiscard]] Vec3 at(double u, double v) const { return partials(u, v, 0).d[0][0]; }

 private:
  /// c[a][b] of (u - origin)^a (v - origin)^b.
  using Patch = std::array<std::array<Vec3, 4>, 4>;

  [[nodiscard]] static std::size_t piece_of(const std::vector<double>& breaks, double x) {
    return std::size_t(std::upper_bound(breaks.begin(), breaks.end(), x) - breaks.begin());
  }
  /// The part of a number's range that lies in a piece, from the origin of that piece.
  template <typename B>
  [[nodiscard]] static B local(const B& x, const std::vector<double>& breaks, std::size_t piece, double origin) {
    return within(x, piece == 0 ? -INFINITY : breaks[piece - 1], piece == breaks.size() ? INFINITY : breaks[piece]) -
           B(origin);
  }
  template <typename B>
  [[nodiscard]] Partials<B> of_piece(std::size_t i, std::size_t j, const B& u, const B& v, int order) const {
    const B x = local(u, break_u_, i, origin_u_[i]), y = local(v, break_v_, j, origin_v_[j]);
    const Patch& c = patches_[i * origin_v_.size() + j];
    Partials<B> out;
    for (int k = 0; k < 3; ++k) {
      std::array<std::array<B, 4>, 4> row;  // [b][a]: derivative b by v of the coefficient of x^a
      for (std::size_t a = 0; a < 4; ++a)
        for (int b = 0; b <= order; ++b)
          row[std::size_t(b)][a] =
              cubic_derivative<B>({B(c[a][0][k]), B(c[a][1][k]), B(c[a][2][k]), B(c[a][3][k])}, y, b);
      for (int b = 0; b <= order; ++b)
        for (int a = 0; a + b <= order; ++a)
          out.d[std::size_t(a)][std::size_t(b)][k] = cubic_derivative<B>(row[std::size_t(b)], x, a);
    }
    return out;
  }

  std::vector<double> u_, v_;
  std::vector<double> break_u_, break_v_, origin_u_, origin_v_;
  std::vector<Patch> patches_;
};

}  // namespace toothpath::flank_grid
