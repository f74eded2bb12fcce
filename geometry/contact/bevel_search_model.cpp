#include "geometry/contact/bevel_search_model.h"

#include <array>
#include <cmath>

#include "geometry/bevel_gear/modified_walls.h"

namespace toothpath::contact {
namespace {

using modification::Kind;

constexpr double kOfDepth[] = {0.2, 0.3, 0.4, 0.5, 0.65, 0.8}, kOfFace[] = {0.2, 0.3, 0.4, 0.5};  // lengths of reliefs

/// Where the mill makes a place of a wall: what laws count from, and how much of what the path takes at the pitch cone
/// it takes here.
struct MillPlace {
  double depth = 0, along = 0, of_path = 1;
};

MillPlace made_at(const bevel_gear::BevelGear& gear, const bevel_gear::BevelWall<double>& wall, double beta, double p) {
  const auto q = wall.cutter.at(p);
  const double R = wall.trace.R_0 * std::cos(beta) * std::cos(beta),
               psi_0 = wall.cutter.alpha_n + wall.cutter.kappa_v * wall.cutter.r_0;
  return {gear.parameters().addendum_mm - q.x, R, q.cos_psi / std::cos(psi_0)};
}

/// The mated places of the pinion a step before, then, and after; straight on where its flank ends between.
std::array<MillPlace, 3> mates_at(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelWall<double>& wall,
                                  const std::array<bevel_gear::BevelInverse, 3>& mates) {
  std::array<MillPlace, 3> out;
  for (std::size_t when = 0; when < 3; ++when)
    if (!std::isnan(mates[when].beta)) out[when] = made_at(pinion, wall, mates[when].beta, mates[when].p);
  for (const std::size_t when : {0u, 2u}) {
    if (!std::isnan(mates[when].beta)) continue;
    const MillPlace other = std::isnan(mates[2 - when].beta) ? out[1] : out[2 - when];
    out[when] = {2 * out[1].depth - other.depth, 2 * out[1].along - other.along, out[1].of_path};
  }
  return out;
}

bool made_by_path(Kind kind) {
  return kind == Kind::lead_crowning || kind == Kind::helix_angle_slope || kind == Kind::end_relief;
}

double in_hundredths(double length) { return std::round(length * 100) / 100; }

}  // namespace

std::vector<SearchedModification> searched_of_mill(const bevel_gear::BevelGear& gear, bool on_pinion) {
  std::vector<double> of_depth;
  for (const double share : kOfDepth) of_depth.push_back(in_hundredths(share * 2 * gear.parameters().addendum_mm));
  std::vector<SearchedModification> list = {{on_pinion, Kind::profile_crowning, {}, false, {}},
                                            {on_pinion, Kind::pressure_angle_slope, {}, true, {}},
                                            {on_pinion, Kind::tip_relief, {}, false, of_depth},
                                            {on_pinion, Kind::root_relief, {}, false, of_depth}};
  for (auto& s : list) s.from_far = s.kind != Kind::pressure_angle_slope;
  const int halves = static_cast<int>(gear.halves().size());
  for (int half = 0; half < halves; ++half) {
    std::vector<double> of_face;
    for (const double share : kOfFace)
      of_face.push_back(in_hundredths(share * bevel_gear::rectangle_of(gear, half).face()));
    for (const int side : {1, -1})
      for (const Kind kind : {Kind::lead_crowning, Kind::helix_angle_slope, Kind::end_relief}) {
        SearchedModification s{on_pinion, kind, {}, kind == Kind::helix_angle_slope, {}};
        if (halves > 1) s.zone = half;
        if (modification::is_relief(kind)) s.lengths_mm = of_face;
        s.side = side;
        list.push_back(std::move(s));
      }
  }
  return list;
}

Result<SearchModel> bevel_search_model(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel,
                                       int sigma, const Misalignment& moved,
                                       const std::vector<SearchedModification>& searched,
                                       const SearchOptions& options) {
  const auto pair = BevelPair::make(pinion, wheel, assembly_of(moved));
  if (!pair) return pair.error();
  const auto map = bevel_ease_off(*pair, sigma, options.rows, options.columns);
  if (!map) return map.error();
  std::vector<SearchFlank> flanks;
  for (std::size_t h = 0; h < map->grids.size(); ++h) {
    const BevelPattern& grid = map->grids[h];
    const EaseOffMap& of_half = map->found.maps[h];
    std::vector<BeyondMargins> margins;
    std::vector<MillPlace> on_wheel;
    std::array<std::vector<MillPlace>, 3> on_pinion;
    for (std::size_t k = 0; k < grid.places.size(); ++k) {
      margins.push_back(bevel_beyond_margins(*pair, grid, of_half, k, options.margin, {}));
      on_wheel.push_back(made_at(wheel, wheel.halves()[h].wall(sigma), grid.places[k].beta, grid.places[k].p));
      const auto mates = mates_at(pinion, pinion.halves()[h].wall(sigma), map->mates[h][k]);
      for (std::size_t when = 0; when < 3; ++when) on_pinion[when].push_back(mates[when]);
    }
    SearchFlank flank(grid.rows, grid.columns, of_half, margins, pinion.R_m() * pinion.sin_delta());
    flank.reach = 5;
    const auto removal = [&](const modification::Modification& m, bool of_pinion, int when) {
      const bevel_gear::BevelGear& gear = of_pinion ? pinion : wheel;
      const modification::Field field({m}, side_of_wall(sigma), grid.half, bevel_gear::rectangle_of(gear, grid.half));
      const auto& places = of_pinion ? on_pinion[static_cast<std::size_t>(when + 1)] : on_wheel;
      std::vector<double> taken(places.size());
      for (std::size_t k = 0; k < taken.size(); ++k)
        if (!std::isnan(of_half.gap_mm[k]))
          taken[k] = field.removal(places[k].depth, places[k].along) * (made_by_path(m.kind) ? places[k].of_path : 1);
      return taken;
    };
    flank.add_removals(searched, side_of_wall(sigma), map->step_rad, removal);
    flanks.push_back(std::move(flank));
  }
  return SearchModel(std::move(flanks), wheel.pitch(), options.steps);
}

}  // namespace toothpath::contact
