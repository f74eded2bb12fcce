#include "cam/finger/walls.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "cam/finger/poses.h"

namespace toothpath::finger {
namespace {

constexpr double kUntouched = 1e6;  // mm of "excess" where nothing came near
constexpr double kEndSlack = 2e-3;  // mm along a pass: rounded words may end it short of its last point
constexpr std::size_t kBins = 1500;
constexpr std::size_t kHistogram = 32;

/// What one motion leaves of a stretch of a wall path.
struct Cover {
  double from = 0, to = 0;  ///< R_c
  double side_mm = kUntouched;
};

Cover cover_of(const bevel_gear::BevelGear& gear, const FingerTool& tool, const WallReference& wall,
               const path::ToolMotion& m, double from, double to) {
  Cover cover{1e300, -1e300, 0};
  const PoseSampling sampling = pose_sampling(gear, tool, m);
  for (int j = 0; j <= sampling.intervals; ++j) {
    const double t = static_cast<double>(j) / sampling.intervals;
    const ConePose pose = cone_pose(gear, path::tip_at(m, t), path::axis_at(m, t), 0.0);
    if (pose.lift > 0.05 || pose.R_c < from - 1 || pose.R_c > to + 1) return {};
    cover.from = std::min(cover.from, pose.R_c);
    cover.to = std::max(cover.to, pose.R_c);
    cover.side_mm =
        std::max(cover.side_mm, std::abs(wall.offset(pose.R_c, pose.theta)) * wall.leverage() + std::abs(pose.lift));
  }
  if (cover.side_mm > 0.2) return {};
  cover.side_mm += sampling.extra_mm;
  return cover;
}

}  // namespace

std::vector<WallPoint> wall_points(const bevel_gear::BevelGear& gear, int rows, int columns) {
  std::vector<WallPoint> points;
  const double h_a = gear.parameters().addendum_mm;
  for (std::size_t i = 0; i < gear.halves().size(); ++i)
    for (int k = 0; k < 2; ++k) {
      const auto& half = gear.halves()[i];
      const auto& w = half.walls[k];
      double p_top = w.cutter.p_D;
      const double low = w.cutter.p_A;
      // Profile parameter that reaches h_a at the middle of the half; rows end there.
      if (const auto at = bevel_gear::bevel_inverse(w, 0.5 * (half.ell_from + half.ell_to), h_a)) p_top = at->p;
      for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
          const double ell = half.ell_from + (half.ell_to - half.ell_from) * c / (columns - 1);
          const double p = low + (p_top - low) * (r + 0.25) / (rows - 0.75);
          WallPoint q;
          q.half = static_cast<int>(i), q.wall = k, q.row = r, q.column = c;
          std::optional<bevel_gear::BevelFlankPoint<double>> f;
          if (r + 1 == rows) {
            if (const auto at = bevel_gear::bevel_inverse(w, ell, h_a)) f = w.point(at->beta, at->p);
          } else if (const auto beta = bevel_gear::bevel_beta_at(w, ell, p)) {
            f = w.point(*beta, p);
          }
          if (f) q.p = f->p, q.n = f->n;
          else if (q.row = -1; !points.empty()) q.p = points.back().p, q.n = points.back().n;
          points.push_back(q);
        }
    }
  return points;
}

WallExcess measure_walls(std::span<const WallPoint> points, std::span<const std::vector<FingerCut>> by_operation,
                         double most_mm) {
  WallExcess out;
  out.after.assign(by_operation.size(), std::vector<double>(points.size(), most_mm));
  out.deepest.assign(points.size(), nullptr);
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    if (points[i].row < 0) return;
    double best = most_mm;
    for (std::size_t op = 0; op < by_operation.size(); ++op) {
      for (const FingerCut& cut : by_operation[op]) {
        const double d = least_distance(points[i].p, *cut.motion, *cut.tool, best);
        if (d < best) best = d, out.deepest[i] = cut.motion;
      }
      out.after[op][i] = best;
    }
  });
  return out;
}

proof::ExcessResult summary_of(std::span<const WallPoint> points, std::span<const double> excess, int operation) {
  proof::ExcessResult e;
  e.operation = operation;
  e.max_mm = -kUntouched;
  e.min_mm = kUntouched;
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].row < 0) continue;
    e.max_mm = std::max(e.max_mm, excess[i]);
    e.min_mm = std::min(e.min_mm, excess[i]);
    sum += excess[i] * excess[i];
    ++e.points;
  }
  if (e.points == 0) return {};
  e.rms_mm = std::sqrt(sum / static_cast<double>(e.points));
  e.bound_mm = e.max_mm;
  e.histogram_from_mm = e.min_mm;
  e.histogram_step_mm = e.max_mm > e.min_mm ? (e.max_mm - e.min_mm) / kHistogram : 1e-6;
  e.histogram.assign(kHistogram, 0);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].row >= 0)
      ++e.histogram[std::min(kHistogram - 1, static_cast<std::size_t>((excess[i] - e.min_mm) / e.histogram_step_mm))];
  return e;
}

std::vector<proof::SurfaceGrid> wall_grids(std::span<const WallPoint> points, const WallExcess& excess, int rows,
                                           int columns) {
  std::vector<proof::SurfaceGrid> grids;
  const auto per_wall = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  for (std::size_t begin = 0; begin + per_wall <= points.size(); begin += per_wall) {
    proof::SurfaceGrid grid;
    grid.zone = points[begin].half;
    grid.patch = points[begin].wall == 0 ? tooth_space::Piece::wall_l : tooth_space::Piece::wall_u;
    grid.rows = rows;
    grid.columns = columns;
    grid.excess_um.resize(excess.after.size());
    for (std::size_t i = begin; i < begin + per_wall; ++i) {
      grid.points.push_back(points[i].p);
      grid.normals.push_back(points[i].n);
      grid.reachable.push_back(points[i].row >= 0 ? 1 : 0);
      for (std::size_t op = 0; op < excess.after.size(); ++op)
        grid.excess_um[op].push_back(static_cast<float>(1000 * excess.after[op][i]));
    }
    grids.push_back(std::move(grid));
  }
  return grids;
}

double left_bound(const bevel_gear::BevelGear& gear, const FingerTool& tool, std::span<const FingerCut> cuts) {
  double left = 0;
  for (const WallReference& wall : tool.walls)
    for (std::size_t half = 0; half < gear.halves().size(); ++half) {
      const double from = wall.R_c_from(half), to = wall.R_c_to(half), width = (to - from) / static_cast<double>(kBins);
      std::vector<double> bin(kBins, kUntouched);
      for (const FingerCut& cut : cuts) {
        if (cut.tool != &tool) continue;
        const Cover cover = cover_of(gear, tool, wall, *cut.motion, from, to);
        if (!(cover.side_mm < kUntouched)) continue;
        // At the end of a pass the wall differs by the square of the slack.
        const double first = std::ceil((cover.from - kEndSlack - from) / width),
                     last = std::floor((cover.to + kEndSlack - from) / width);
        for (double b = std::max(0.0, first); b <= std::min(last, static_cast<double>(kBins - 1)); b += 1)
          bin[static_cast<std::size_t>(b)] = std::min(bin[static_cast<std::size_t>(b)], cover.side_mm);
      }
      for (const double b : bin) left = std::max(left, b);
    }
  return left;
}

}  // namespace toothpath::finger
