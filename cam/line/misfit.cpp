#include "cam/line/misfit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace toothpath::line {
namespace {

constexpr int kHeights = 64;

/// Over the feet that lie in the strip and in the ring.
double largest_at(const LineFit& fit, const LineRecord& record) {
  const FlankTask& flank = fit.flank();
  const auto start =
      face_gear::invert_flank(flank.surface, flank.side, record.anchor.head<2>().norm(), record.anchor.z());
  if (!start) return 0;
  const Place<double> place{start->theta, start->B};
  const double t_start = (record.anchor - record.axis.c_0).dot(record.axis.a);
  const auto gap = fit.gap_along(record.axis, t_start, place);
  if (!gap || !gap->in_ring()) return 0;
  double most = 0;
  for (int k = 0; k <= kHeights; ++k) {
    const double t = gap->ring_from + (gap->ring_to - gap->ring_from) * k / kHeights;
    const auto& near = *std::min_element(gap->nodes.begin(), gap->nodes.end(), [&](const GapNode& a, const GapNode& b) {
      return std::abs(a.t - t) < std::abs(b.t - t);
    });
    const auto node = fit.gap_at(record.axis, t, near.at);
    if (!node) continue;
    const Strip& strip = fit.strip();
    if (node->z_foot > strip.top || (strip.bottom && node->z_foot < *strip.bottom)) continue;
    most = std::max(most, node->e);
  }
  return most;
}

}  // namespace

double largest_gap(const face_gear::FaceGear& gear, const tool::Profile& tool, const LinePlan& plan) {
  std::vector<double> most(plan.passes.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, plan.passes.size(), [&](std::size_t k) {
    const LinePass& pass = plan.passes[k];
    const auto flank = flank_task(gear, pass.zone, pass.side);
    if (!flank) return;
    const LineFit fit(*flank, *tool.law(), strips_of(*flank, plan.strips)[std::size_t(pass.strip)]);
    for (const LineRecord& record : pass.records) most[k] = std::max(most[k], largest_at(fit, record));
  });
  return *std::max_element(most.begin(), most.end());
}

}  // namespace toothpath::line
