#include "cam/line/misfit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace toothpath::line {
namespace {

constexpr int kHeights = 64, kBlockHeights = 16;
constexpr int kBlockPlaces = 8;  // pieces of a block

/// Over the feet that lie in the strip and in the ring.
double largest_at(const LineFit& fit, const AxisLine<double>& axis, const Vec3& anchor, const Place& at, int heights) {
  const auto gap = fit.gap_along(axis, (anchor - axis.c_0).dot(axis.a), at);
  if (!gap || !gap->in_ring()) return 0;
  double most = 0;
  for (int k = 0; k <= heights; ++k) {
    const double t = gap->ring_from + (gap->ring_to - gap->ring_from) * k / heights;
    const auto& near = *std::min_element(gap->nodes.begin(), gap->nodes.end(), [&](const GapNode& a, const GapNode& b) {
      return std::abs(a.t - t) < std::abs(b.t - t);
    });
    const auto node = fit.gap_at(axis, t, near.at);
    if (!node) continue;
    const Strip& strip = fit.strip();
    if (node->depth < strip.top || (strip.bottom && node->depth > *strip.bottom)) continue;
    most = std::max(most, node->e);
  }
  return most;
}

/// Tip and axis of a block go straight.
double largest_between(const LineFit& fit, const LineRecord& a, const LineRecord& b, double w) {
  const double r_0 = fit.law().r_0;
  AxisLine<double> axis;
  axis.a = ((1 - w) * a.axis.a + w * b.axis.a).normalized();
  axis.c_0 = (1 - w) * (a.axis.c_0 - r_0 * a.axis.a) + w * (b.axis.c_0 - r_0 * b.axis.a) + r_0 * axis.a;
  return largest_at(fit, axis, (1 - w) * a.anchor + w * b.anchor, between(a.at, b.at, w), kBlockHeights);
}

}  // namespace

double largest_gap(const LineFit& fit, const LinePass& pass) {
  std::vector<double> most(pass.records.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, most.size(), [&](std::size_t k) {
    const LineRecord& here = pass.records[k];
    most[k] = largest_at(fit, here.axis, here.anchor, here.at, kHeights);
    for (int piece = 1; piece < kBlockPlaces && k > 0; ++piece)
      most[k] = std::max(most[k], largest_between(fit, pass.records[k - 1], here, double(piece) / kBlockPlaces));
  });
  return most.empty() ? 0 : *std::max_element(most.begin(), most.end());
}

}  // namespace toothpath::line
