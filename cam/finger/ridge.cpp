#include "cam/finger/ridge.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "geometry/base/golden_section.h"

namespace toothpath::finger {

namespace {
/// The cuts that come within `reach` of a cone distance.
std::vector<FingerCut> cuts_near(const bevel_gear::BevelGear& gear, std::span<const FingerCut> cuts, double ell,
                                 double reach) {
  std::vector<FingerCut> near;
  for (const FingerCut& cut : cuts) {
    const double a = cone_pose(gear, cut.motion->tip_from, cut.motion->axis_from, 0.0).R_c;
    const double b = cone_pose(gear, cut.motion->tip_to, cut.motion->axis_to, 0.0).R_c;
    if (std::min(a, b) < ell + reach && std::max(a, b) > ell - reach) near.push_back(cut);
  }
  return near;
}
}  // namespace

RidgeResult highest_ridge(const bevel_gear::BevelGear& gear, std::span<const FingerCut> cuts,
                          const FingerTool& reference, int columns, int rows_across) {
  RidgeResult out;
  const double sd = gear.sin_delta(), cd = gear.cos_delta(), h_f = gear.parameters().dedendum_mm;
  struct Row {
    double height = 0, azimuth = 0, ell = 0;
    std::size_t points = 0;
  };
  std::vector<double> stations;
  for (const auto& half : gear.halves()) {
    const int n = std::max(2, static_cast<int>(columns / gear.halves().size()));
    for (int i = 0; i < n; ++i) stations.push_back(half.ell_from + (half.ell_to - half.ell_from) * i / (n - 1));
  }
  std::vector<Row> rows(stations.size());
  tbb::parallel_for(std::size_t{0}, stations.size(), [&](std::size_t i) {
    const double ell = stations[i];
    const std::vector<FingerCut> near = cuts_near(gear, cuts, ell, reference.solid.largest_radius());
    const double e_L = reference.walls[0].theta_at(ell) / sd, e_U = reference.walls[1].theta_at(ell) / sd;
    const auto left = [&](double e) {
      const Vec3 foot = bevel_gear::blank_point(ell, -h_f, e, sd, cd), normal = gear.axis(e);
      double best = gear.parameters().addendum_mm + h_f;
      for (const FingerCut& cut : near) best = covering_height(*cut.tool, foot, normal, *cut.motion, best);
      return best;
    };
    Row& row = rows[i];
    row.ell = ell;
    double at = 0;
    const int n = rows_across;
    for (int j = 0; j < n; ++j) {
      const double e = e_L + (e_U - e_L) * j / (n - 1), h = left(e);
      ++row.points;
      if (j == 0 || h > row.height) row.height = h, at = j;
    }
    // A ridge is a kink: narrow down on it.
    const double a = e_L + (e_U - e_L) * std::max(0.0, at - 1) / (n - 1),
                 b = e_L + (e_U - e_L) * std::min(n - 1.0, at + 1) / (n - 1);
    auto search = golden_section<std::greater<>>(a, b, left);
    row.azimuth = e_L + (e_U - e_L) * at / (n - 1);
    for (int k = 0; k < 22; ++k) search.step();
    if (const auto [azimuth, height] = search.best(); height > row.height) row.height = height, row.azimuth = azimuth;
    row.points += 24;
  });
  out.least_mm = rows.front().height;
  for (const auto& row : rows) {
    out.points += row.points;
    out.least_mm = std::min(out.least_mm, row.height);
    if (row.height > out.reached_mm)
      out.reached_mm = row.height, out.cone_distance_mm = row.ell, out.azimuth_rad = row.azimuth;
  }
  return out;
}

}  // namespace toothpath::finger
