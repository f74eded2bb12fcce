#include "app/report/sheet/length_tolerance.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace toothpath::sheet {
namespace {

constexpr double kSameAxis = 5e-3;  // rad: axes nearer than this to one that was kept are counted as that one
constexpr double kLeastShare =
    1e-3;  // a tool that cuts with its side alone: its length hardly matters, and its tolerance ends here

/// Axes of the feed records, by zone.
std::map<int, std::vector<Vec3>> axes_of(const path::ClPath& path) {
  std::map<int, std::vector<Vec3>> out;
  for (const auto& r : path.records) {
    if (r.kind != path::MoveKind::feed) continue;
    auto& kept = out[r.zone];
    const auto near = [&](const Vec3& u) { return (u - r.axis).norm() < kSameAxis; };
    if (kept.empty() || (!near(kept.back()) && std::none_of(kept.begin(), kept.end(), near))) kept.push_back(r.axis);
  }
  return out;
}

double largest_share(const std::vector<Vec3>& axes, const proof::SurfaceGrid& grid) {
  double share = 0;
  for (std::size_t k = 0; k < grid.points.size(); ++k) {
    if (k < grid.reachable.size() && grid.reachable[k] == 0) continue;
    for (const Vec3& u : axes) share = std::max(share, std::abs(u.dot(grid.normals[k])));
  }
  return std::min(1.0, share + (axes.size() > 1 ? kSameAxis : 0.0));
}

}  // namespace

std::vector<report::LengthTolerance> length_tolerances(const job::Job& job, const proof::ProofLimits& limits,
                                                       const report::RunReport& report,
                                                       std::span<const path::ClPath* const> paths,
                                                       const std::vector<proof::SurfaceGrid>& grids,
                                                       const OtherSurface& other) {
  std::vector<report::LengthTolerance> out;
  if (!report.gouge || grids.empty()) return out;
  const double spare = report.gouge_tolerance_mm - std::max(0.0, report.gouge->bound_mm);
  for (const path::ClPath* path : paths) {
    const auto& operation = job.operations[static_cast<std::size_t>(path->operation)];
    report::LengthTolerance t;
    t.operation = path->operation;
    t.tool_number = job.tools[static_cast<std::size_t>(operation.tool)].number;
    t.share = other.share;
    t.flank_share = 0;
    const auto axes = axes_of(*path);
    for (const auto& grid : grids) {
      const auto zone = axes.find(grid.zone);
      if (zone == axes.end()) continue;
      const double share = largest_share(zone->second, grid);
      t.share = std::max(t.share, share);
      if (!below_the_flanks(grid.patch)) t.flank_share = std::max(t.flank_share, share);
    }
    if (axes.empty()) continue;
    const double by = std::max(kLeastShare, t.share);
    double stock = 0;  // that this operation leaves: a longer tool eats it first
    for (const auto& after : report.excess)
      if (after.operation == path->operation && operation.allowance_mm > 0) stock = std::max(0.0, after.min_mm);
    t.too_long_mm = std::max(0.0, spare + stock) / by;
    const bool last = path->operation + 1 == static_cast<int>(job.operations.size());
    const bool finishes =
        operation.type == path::OperationType::finishing || operation.type == path::OperationType::finger_finishing;
    if (last && finishes && report.finished && limits.left_mm) {
      const double limit = *limits.left_mm;
      const double left = limit - report.finished->bound_mm;
      t.too_short_mm = std::max(0.0, left > 0 ? left : limit - report.finished->max_mm) / by;
    }
    out.push_back(t);
  }
  return out;
}

}  // namespace toothpath::sheet
