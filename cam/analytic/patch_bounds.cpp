#include "cam/analytic/patch_bounds.h"

#include <algorithm>
#include <cmath>

namespace toothpath::analytic {
namespace {

constexpr double kUnit = 1 + 1e-14;  // covers the rounding of a few operations
constexpr double kLooseSag = 0.005;  // mm
constexpr int kSlices = 24;

/// Nothing where a component is not finite.
std::optional<VectorBound> bound_of(const std::array<Interval, 3>& x) {
  VectorBound bound;
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!x[k].finite()) return {};
    bound.middle[int(k)] = x[k].middle();
    sum += x[k].radius() * x[k].radius();
  }
  bound.spread = std::sqrt(sum) * kUnit;
  return bound;
}

/// Is what a bend may be across a cell mostly what the intervals add, and more than distances are wanted to?
bool loose(const PatchBend& bend) { return 0.125 * bend.spread_aa > kLooseSag && bend.spread_aa > 2 * bend.aa.norm(); }

}  // namespace

double PatchBend::above(const Vec3& g, double da, double db) const {
  return 0.125 * (std::max(0.0, g.dot(aa) + spread_aa) * da * da + 2 * (std::abs(g.dot(ab)) + spread_ab) * da * db +
                  std::max(0.0, g.dot(bb) + spread_bb) * db * db);
}

double PatchBend::sag(double da, double db) const {
  return 0.125 * ((aa.norm() + spread_aa) * da * da + 2 * (ab.norm() + spread_ab) * da * db +
                  (bb.norm() + spread_bb) * db * db);
}

std::optional<PatchBend> PatchBend::of(const std::array<std::array<Interval, 3>, 3>& second) {
  const auto aa = bound_of(second[0]), ab = bound_of(second[1]), bb = bound_of(second[2]);
  if (!aa || !ab || !bb) return {};
  return PatchBend{aa->middle, ab->middle, bb->middle, aa->spread, ab->spread, bb->spread};
}

std::optional<PatchBend> patch_bend(const tooth_space::ToothSpace& space, tooth_space::Piece piece,
                                    const PatchFrame& frame, double half_a, double half_b) {
  const auto jet = space.enclosure(piece, frame, half_a, half_b);
  if (!jet) return {};
  const auto whole = PatchBend::of(jet->second);
  if (!whole || !loose(*whole)) return whole;
  // What intervals add to the truth shrinks with the box: the hull of slices tells better.
  const auto sliced = sliced_bend(space, piece, frame, half_a, half_b);
  return sliced ? sliced : whole;
}

std::optional<PatchBend> sliced_bend(const tooth_space::ToothSpace& space, tooth_space::Piece piece,
                                     const PatchFrame& frame, double half_a, double half_b) {
  std::array<std::array<Interval, 3>, 3> second;
  for (int k = 0; k < kSlices; ++k) {
    PatchFrame slice = frame;
    slice.origin += frame.along_a * (half_a * (2.0 * k + 1 - kSlices) / kSlices);
    const auto part = space.enclosure(piece, slice, half_a / kSlices * kUnit, half_b);
    if (!part) return {};
    for (std::size_t n = 0; n < second.size(); ++n)
      for (std::size_t c = 0; c < 3; ++c)
        second[n][c] = k == 0 ? part->second[n][c] : hull(second[n][c], part->second[n][c]);
  }
  return PatchBend::of(second);
}

std::optional<VectorBound> end_curve_bend(const tooth_space::ToothSpace& space, tooth_space::Piece piece,
                                          const PatchFrame& frame, double half_a, double half_b) {
  const auto p = space.enclosure(piece, frame, half_a, half_b);
  if (!p) return {};
  const tooth_space::Chart& chart = space.outline().chart;
  const tooth_space::BoxCoordinate s(*p, chart.cosine, -chart.sine);
  const Interval b1 = -s.first[0] / s.first[1];
  if (!(b1.magnitude() * half_a <= half_b)) return {};  // it might leave the box
  const Interval b2 = -tooth_space::along(s.second[0], s.second[1], s.second[2], Interval(1), b1) / s.first[1];
  std::array<Interval, 3> second;
  for (std::size_t k = 0; k < 3; ++k)
    second[k] =
        tooth_space::along(p->second[0][k], p->second[1][k], p->second[2][k], Interval(1), b1) + p->first[1][k] * b2;
  return bound_of(second);
}

}  // namespace toothpath::analytic
