#include "geometry/loaded_bevel/bevel_root_stress.h"

#include "geometry/loaded_bevel/bevel_body.h"

namespace toothpath::loaded_bevel {
namespace {

const char* name_of(bool on_wheel) { return on_wheel ? "wheel" : "pinion"; }

}  // namespace

Result<loaded::RootBody> root_body(const LoadedBevelPair& pair, std::size_t half, bool on_wheel,
                                   const elastic::SectorPlan& plan) {
  const bevel_gear::BevelGear& gear = on_wheel ? pair.pair.wheel() : pair.pair.pinion();
  auto bricks = bevel_bricks(gear, static_cast<int>(half), pair.sigma, plan);
  if (!bricks) return fail("half {} of the {}: {}", half, name_of(on_wheel), bricks.error().message);
  return loaded::with_stress({std::move(*bricks), on_wheel, on_wheel ? 1 : -1,
                              [sin_delta = gear.sin_delta(), cos_delta = gear.cos_delta()](const Vec3& p) {
                                const auto at = bevel_gear::cone_point(p, sin_delta, cos_delta);
                                return Vec2(at.ell, at.height);
                              }},
                             on_wheel ? pair.options.wheel : pair.options.pinion);
}

Result<loaded::RootStress> root_stress(const LoadedBevelPair& pair, const loaded::LoadedCycle& cycle) {
  for (const bool on_wheel : {true, false}) {
    const auto& gear = on_wheel ? pair.pair.wheel() : pair.pair.pinion();
    if (const double rho = gear.cutter_data().tip_radius_mm; !(rho > 0))
      return fail(
          "tip_radius = {:g} mm of the {}'s mill is not above 0: a fillet without a radius has no finite stress", rho,
          name_of(on_wheel));
  }
  loaded::RootBodies of;
  for (std::size_t half = 0; half < pair.halves.size(); ++half) of.rings.push_back(static_cast<int>(half));
  of.rim_mm = {pair.options.wheel.bricks.rim_mm, pair.options.pinion.bricks.rim_mm};
  of.across = {6, 8};  // corner arcs of mills are small beside the tooth: 4 across miss a tenth
  of.make = [&](std::size_t half, bool on_wheel, const elastic::SectorPlan& plan) {
    return root_body(pair, half, on_wheel, plan);
  };
  return loaded::root_stress(of, cycle);
}

}  // namespace toothpath::loaded_bevel
