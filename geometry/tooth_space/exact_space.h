// A tooth space whose places and normals are known with their second derivatives, and over boxes: what flanks that are
// moved along their normals are made of (modified_part.h).
#pragma once

#include <optional>

#include "geometry/base/dual.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

/// Value, first and second derivatives by (u, v).
using Second = Dual<Dual<double, 2>, 2>;

/// The first or second of them.
[[nodiscard]] inline Second second_variable(double x, int k) {
  Second s;
  s.v = Dual<double, 2>::variable(x, k);
  s.d[std::size_t(k)] = Dual<double, 2>(1);
  return s;
}

/// A place with its normal, and where it lies in the chart.
template <typename S>
struct Skin {
  Vec3T<S> p, n;
  S along{};  ///< s
  S depth{};  ///< h below the tip surface at s
};

class ExactSpace : public ToothSpace {
 public:
  [[nodiscard]] virtual std::optional<Skin<Second>> second(Piece piece, double u, double v) const = 0;
  [[nodiscard]] virtual std::optional<Skin<BoxSecond>> boxed(Piece piece, const PatchFrame& frame, double half_a,
                                                             double half_b) const = 0;
  /// The most by which u and v go in one step of a search.
  [[nodiscard]] virtual Vec2 longest_steps(Piece piece) const = 0;
};

/// Point, normal and their first derivatives of a surface p(u, v), the normal on the side of `towards`.
[[nodiscard]] PatchPoint patch_of(const Vec3T<Second>& p, const Vec3& towards);

/// Newton for ToothSpace::foot. @param most  of u and v in one step
[[nodiscard]] std::optional<PatchFoot> search_foot(const ToothSpace& space, Piece piece, const Vec3& c, double u,
                                                   double v, const Vec2& most);
/// A place of a piece with its parameters.
struct PiecePlace {
  double u = 0, v = 0;
  PatchPoint at;
};
/// Newton for the place of a piece at (s, h) of the chart. @param start  (u, v)
[[nodiscard]] std::optional<PiecePlace> search_place(const ToothSpace& space, Piece piece, double s, double h,
                                                     const Vec2& start);
/// Newton for ToothSpace::tip_edge. @param start  (u, v)
[[nodiscard]] std::optional<EdgePlace> search_tip_edge(const ToothSpace& space, int side, double s, const Vec2& start,
                                                       const std::optional<EdgePlace>& near);

}  // namespace toothpath::tooth_space
