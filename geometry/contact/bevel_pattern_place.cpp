#include "geometry/contact/bevel_pattern_place.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/contact/nearest_turn.h"

namespace toothpath::contact {
namespace {

/// One place of the wheel's wall with the pinion, at the exact ratio.
class WallApproach {
 public:
  WallApproach(const BevelPair& pair, int half, int sigma, const BevelPlace& place)
      : pair_(pair), half_(half), sigma_(sigma), place_(place) {}

  /// How near the pinion is, mm: a turn times the lever.
  double operator()(double phi_2) const {
    const auto turn = pair_.turn_at(half_, sigma_, place_.point, phi_2, at_);
    if (!turn) return kNever;
    return -sigma_ * wrapped(*turn - pair_.nominal_turn(phi_2)) * pair_.pinion_lever(half_, sigma_, at_);
  }
  /// On the pinion's wall, of the turn that was asked last.
  [[nodiscard]] const bevel_gear::BevelInverse& mate() const { return at_; }

 private:
  const BevelPair& pair_;
  int half_, sigma_;
  const BevelPlace& place_;
  mutable bevel_gear::BevelInverse at_;  ///< where the next inversion starts
};

/// Lowest height on the pinion that is flank, not corner.
double lowest_of_pinion(const BevelPair& pair, int half) {
  return pair.pinion().halves()[static_cast<std::size_t>(half)].walls[0].cutter.x_B;
}

/// The edge of the pinion's half that a place of it is nearest to.
Edge nearest_end(const BevelPair& pair, int half, const bevel_gear::ConePoint& at) {
  const auto& own = pair.pinion().halves()[static_cast<std::size_t>(half)];
  const double tip = pair.pinion().parameters().addendum_mm, root = lowest_of_pinion(pair, half),
               face = own.ell_to - own.ell_from;
  const std::pair<double, Edge> ends[] = {{(tip - at.height) / (tip - root), Edge::pinion_tip},
                                          {(at.height - root) / (tip - root), Edge::pinion_root},
                                          {(at.ell - own.ell_from) / face, Edge::inner_end},
                                          {(own.ell_to - at.ell) / face, Edge::outer_end}};
  return std::min_element(std::begin(ends), std::end(ends),
                          [](const auto& a, const auto& b) { return a.first < b.first; })
      ->second;
}

}  // namespace

BevelAssembly assembly_of(const Misalignment& moved) {
  return {moved.angle_rad, moved.offset_mm, moved.axial_mm, moved.gear_axial_mm};
}

Result<BevelEaseOff> bevel_ease_off(const BevelPair& pair, int sigma, int rows, int columns) {
  BevelEaseOff out;
  out.step_rad = pair.wheel().pitch() / kStepsAPitch;
  std::vector<EaseOffMap> maps;
  for (int half = 0; half < static_cast<int>(pair.wheel().halves().size()); ++half) {
    out.grids.push_back(wheel_grid(pair, half, sigma, rows, columns));
    const auto& places = out.grids.back().places;
    EaseOffMap map(places.size());
    map.lever_mm.assign(places.size(), 1);
    std::vector<std::array<bevel_gear::BevelInverse, 3>> mates(places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (!places[k].point.allFinite()) continue;
      const WallApproach approach(pair, half, sigma, places[k]);
      const double pitch_plane = -std::atan2(places[k].point.y(), places[k].point.x());
      const auto top = nearest_turn(approach, pitch_plane, pair.wheel().pitch());
      if (!top) continue;
      map.gap_mm[k] = -approach(top->phi_2);
      map.phi_2[k] = top->phi_2;
      map.bend_mm[k] = top->bend;
      map.lever_mm[k] = pair.pinion_lever(half, sigma, approach.mate());
      const auto on = pair.on_pinion(places[k].point, top->phi_2);
      map.pinion_across_mm[k] = on.height;
      map.pinion_along_mm[k] = on.ell;
      mates[k].fill(approach.mate());
      for (const std::size_t when : {0u, 2u}) {
        const WallApproach beside(pair, half, sigma, places[k]);
        const bool there = beside(top->phi_2 + (double(when) - 1) * out.step_rad) > kNever;
        mates[k][when] = beside.mate();
        if (!there) mates[k][when].beta = std::nan("");
      }
    }
    maps.push_back(std::move(map));
    out.mates.push_back(std::move(mates));
  }
  auto found = brought_to_touch(std::move(maps));
  if (!found) return found.error();
  out.found = std::move(*found);
  return out;
}

BeyondMargins bevel_beyond_margins(const BevelPair& pair, const BevelPattern& grid, const EaseOffMap& map,
                                   std::size_t place, double margin, const bevel_gear::ConePoint& beside) {
  const int row = static_cast<int>(place) / grid.columns, column = static_cast<int>(place) % grid.columns;
  BeyondMargins out = beyond_own_margins(grid.rows, grid.columns, row, column, margin);
  const auto lower = [&](Edge edge, double to) {
    double& own = out[static_cast<std::size_t>(edge)];
    own = std::min(own, to);
  };
  if (std::isnan(map.gap_mm[place])) {
    lower(nearest_end(pair, grid.half, beside), 0);
    return out;
  }
  const auto& own = pair.pinion().halves()[static_cast<std::size_t>(grid.half)];
  const double tip = pair.pinion().parameters().addendum_mm, face = own.ell_to - own.ell_from;
  const bevel_gear::ConePoint on{map.pinion_along_mm[place], map.pinion_across_mm[place], 0};
  lower(Edge::pinion_tip, (tip - on.height) / (2 * tip) - margin);
  lower(Edge::pinion_root, (on.height - lowest_of_pinion(pair, grid.half)) / (2 * tip) - margin);
  lower(Edge::inner_end, (on.ell - own.ell_from) / face - margin);
  lower(Edge::outer_end, (own.ell_to - on.ell) / face - margin);
  if (beside_the_end(map, grid.rows, grid.columns, row, column)) lower(nearest_end(pair, grid.half, on), 0);
  return out;
}

PatternPlace bevel_pattern_place(const BevelPair& pair, const BevelPattern& rolled, const EaseOffMap& map,
                                 double compound_mm, double margin) {
  RolledGrid grid{rolled.rows, rolled.columns, {}, {}, {}};
  for (std::size_t k = 0; k < rolled.places.size(); ++k) {
    grid.points.emplace_back(rolled.places[k].ell, rolled.places[k].height, 0);
    grid.gap_mm.push_back(std::isnan(rolled.gap_mm[k]) ? kUnmet : rolled.gap_mm[k]);
    grid.margins.push_back(
        bevel_beyond_margins(pair, rolled, map, k, margin, {rolled.pinion_ell_mm[k], rolled.pinion_height_mm[k], 0}));
  }
  return pattern_place(grid, compound_mm);
}

Result<MisalignedContact> bevel_misaligned_contact(const bevel_gear::BevelGear& pinion,
                                                   const bevel_gear::BevelGear& wheel, int sigma,
                                                   const Misalignment& moved, const BevelContactOptions& options,
                                                   double margin) {
  const auto pair = BevelPair::make(pinion, wheel, assembly_of(moved));
  if (!pair) return pair.error();
  const auto rolled = bevel_contact(*pair, sigma, options);
  if (!rolled) return rolled.error();
  const auto map = bevel_ease_off(*pair, sigma, options.rows, options.columns);
  if (!map) return map.error();
  MisalignedContact found = MisalignedContact::at(moved);
  found.error_mean_rad = rolled->error_mean_rad;
  found.error_range_rad = rolled->error_range_rad;
  for (std::size_t h = 0; h < rolled->patterns.size(); ++h) {
    const auto place_with = [&](double width) {
      return bevel_pattern_place(*pair, rolled->patterns[h], map->found.maps[h], options.compound_mm, width);
    };
    found.add_ring(rolled->patterns[h].half, place_with(0), place_with(margin));
  }
  return found;
}

}  // namespace toothpath::contact
