#include "app/process/bevel/cut_walls.h"

#include <algorithm>
#include <map>
#include <memory>

#include "app/base/units.h"
#include "geometry/inspection/bevel_grid.h"

namespace toothpath::bevel {
namespace {

constexpr int kLeastRows = 5, kLeastColumns = 9;  // of a measured grid, for its fit

/// The deviation of one wall over columns of equal cone distance, each from the root to the tip.
struct WallMap {
  std::vector<double> ell;
  std::vector<std::vector<double>> height, deviation_mm;  ///< a column each
};

/// Index and share of a value among rising ones; beyond them the end.
std::pair<std::size_t, double> place_among(const std::vector<double>& rising, double x) {
  const auto above = std::upper_bound(rising.begin() + 1, rising.end() - 1, x) - rising.begin();
  const auto low = static_cast<std::size_t>(above) - 1;
  return {low, std::clamp((x - rising[low]) / (rising[low + 1] - rising[low]), 0.0, 1.0)};
}

double deviation_at(const WallMap& map, const bevel_gear::ConePoint& at) {
  const auto [column, across] = place_among(map.ell, at.ell);
  double sum = 0;
  for (const std::size_t k : {column, column + 1}) {
    const auto [row, up] = place_among(map.height[k], at.height);
    sum +=
        (k == column ? 1 - across : across) * ((1 - up) * map.deviation_mm[k][row] + up * map.deviation_mm[k][row + 1]);
  }
  return sum;
}

Result<WallMap> map_of(const bevel_gear::BevelGear& gear, const process::CutFlanks::Flank& flank) {
  WallMap map;
  for (int c = 0; c < flank.columns; ++c) {
    std::vector<double> height, deviation;
    double ell = 0;
    for (int r = 0; r < flank.rows; ++r) {
      const auto k =
          static_cast<std::size_t>(r) * static_cast<std::size_t>(flank.columns) + static_cast<std::size_t>(c);
      if (!flank.reached.empty() && flank.reached[k] == 0) continue;
      const auto at = bevel_gear::cone_point(flank.nominal[k], gear.sin_delta(), gear.cos_delta());
      if (!height.empty() && !(at.height > height.back())) continue;
      ell = at.ell;
      height.push_back(at.height);
      deviation.push_back(flank.deviation_mm[k]);
    }
    if (height.size() < 2)
      return fail("half {}, wall {}: column {} of the cut surface has {} places, at least 2 are needed", flank.zone,
                  flank.side > 0 ? "L" : "U", c, height.size());
    map.ell.push_back(ell);
    map.height.push_back(std::move(height));
    map.deviation_mm.push_back(std::move(deviation));
  }
  return map;
}

const char* letter_of(int side) { return side > 0 ? "L" : "U"; }

}  // namespace

Result<CutWalls> walls_as_cut(const bevel_gear::BevelGear& gear, const process::CutFlanks& cut) {
  auto maps = std::make_shared<std::map<std::pair<int, int>, WallMap>>();
  for (const auto& flank : cut.flanks) {
    auto map = map_of(gear, flank);
    if (!map) return map.error();
    (*maps)[{flank.zone, flank.side}] = std::move(*map);
  }
  for (int half = 0; half < static_cast<int>(gear.halves().size()); ++half)
    for (const int side : {1, -1})
      if (!maps->contains({half, side}))
        return fail("the cut surface has no wall {} of half {}", letter_of(side), half);
  return CutWalls{cut.route,
                  [maps](int half, int sigma, const bevel_gear::ConePoint& at) {
                    return deviation_at(maps->at({half, sigma}), at);
                  },
                  process::notes_of(cut)};
}

Result<CutWalls> walls_as_measured(const bevel_gear::BevelGear& gear, const job::MeasuredInput& measured) {
  job::GridOfGear grid;
  grid.zones = gear.halves().size(), grid.walls = true;
  grid.nominal = [&](int rows, int columns) -> Result<std::vector<inspection::InspectionPoint>> {
    if (rows < kLeastRows || columns < kLeastColumns)
      return fail("{} rows x {} columns; at least {} x {} are needed", rows, columns, kLeastRows, kLeastColumns);
    return inspection::bevel_inspection_grid(gear, {rows, columns, inspection::kBevelInspection.margin});
  };
  grid.place = [&](const inspection::InspectionPoint& point) {
    const auto at = bevel_gear::cone_point(point.p, gear.sin_delta(), gear.cos_delta());
    return Vec2(at.ell, at.height);
  };
  grid.foot = [&](int) { return gear.cutter().x_B; };
  auto fitted = job::fit_measured(measured, grid);
  if (!fitted) return fitted.error();
  CutWalls out{"measured", {}, {}};
  for (const auto& f : fitted->flanks) {
    const auto& r = f.residual;
    out.notes.push_back(
        fmt::format("half {}, wall {}: {} measured places up to {:.2f} um off, met by the fit within "
                    "{:.2f} um",
                    f.zone, letter_of(f.side), r.points, r.measured_max_mm * app::kUm, r.residual_max_mm * app::kUm));
  }
  out.left = [fit = std::move(*fitted)](int half, int sigma, const bevel_gear::ConePoint& at) {
    return fit.deviation_mm(half, sigma, {at.ell, at.height});
  };
  return out;
}

Result<process::CutFlanks> flanks_of(const bevel_gear::BevelGear& gear, const CutWalls& walls) {
  constexpr int kRows = 21, kColumns = 25;
  const auto places = inspection::bevel_inspection_grid(gear, {kRows, kColumns, 0});
  if (!places) return places.error();
  process::CutFlanks out;
  out.route = walls.route;
  out.warnings = walls.notes;
  for (int half = 0; half < int(gear.halves().size()); ++half)
    for (const int side : {1, -1}) {
      process::CutFlanks::Flank flank{half, side, kRows, kColumns, {}, {}, {}};
      for (const inspection::InspectionPoint& at : *places) {
        if (at.zone != half || at.side != side) continue;
        flank.nominal.push_back(at.p);
        flank.normals.push_back(at.n);
        flank.deviation_mm.push_back(
            walls.left(half, side, bevel_gear::cone_point(at.p, gear.sin_delta(), gear.cos_delta())));
      }
      out.flanks.push_back(std::move(flank));
    }
  return out;
}

contact::BevelLeft left_on_pair(const CutWalls& walls, bool of_pinion) {
  return [left = walls.left, of_pinion](int half, int sigma, const bevel_gear::ConePoint& on_wheel,
                                        const bevel_gear::ConePoint& on_pinion) {
    return left(half, sigma, of_pinion ? on_pinion : on_wheel);
  };
}

}  // namespace toothpath::bevel
