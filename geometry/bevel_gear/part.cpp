#include "geometry/bevel_gear/part.h"

#include <algorithm>

namespace toothpath::bevel_gear {
BevelPart::BevelPart(BevelGear gear) : gear_(std::move(gear)) {
  for (std::size_t half = 0; half < gear_.halves().size(); ++half) spaces_.emplace_back(WallKernel(gear_, half));
}

std::optional<double> BevelPart::groove_floor() const {
  return zones() < 2 ? std::nullopt : std::optional(lowest_root());
}

bool in_blank(const BevelGear& gear, const Vec3& p) {
  const tooth_space::Chart chart{-gear.sin_delta(), gear.cos_delta()};
  const double ell = -chart.along(p), h = chart.up(p);
  if (ell < gear.R_i() || ell > gear.R_e() || h > gear.parameters().addendum_mm) return false;
  const auto& halves = gear.halves();
  return halves.size() < 2 || ell <= halves[0].ell_to || ell >= halves[1].ell_from ||
         h <= -gear.parameters().dedendum_mm;
}

bool BevelPart::in_blank(const Vec3& p) const { return bevel_gear::in_blank(gear_, p); }

std::optional<Refusal> BevelPart::refusal(int zone) const {
  const double turn = space(zone).kernel().least_turn();
  if (turn >= WallKernel::kLeastTurn) return {};
  return Refusal{"outer_spiral_angle",
                 fail("outer_spiral_angle: in half {} the path of the mill that defines the flanks runs along the "
                      "generatrix (its turn is {:.2g}, at least {:g} is needed): the fillets have no single end "
                      "there; more spiral angle, or a finger mill would do",
                      zone, turn, WallKernel::kLeastTurn)};
}

double underside_height(const BevelGear& g) {
  // Below the root by two modules, but no nearer to the axis than a third of the radius there.
  const auto& p = g.parameters();
  const double depth =
      std::min(2 * p.outer_transverse_module_mm,
               (g.R_i() * g.sin_delta() - p.dedendum_mm * g.cos_delta()) / (1.5 * std::max(1e-9, g.cos_delta())));
  return -p.dedendum_mm - depth;
}

tooth_space::ToothedSolid drawn_solid(const BevelPart& part) {
  const BevelGear& gear = part.gear();
  tooth_space::ToothedSolid out;
  out.teeth = part.teeth();
  out.module_mm = part.module_mm();
  out.lowest_root = part.lowest_root();
  out.ways_out = {"less addendum or backlash leaves a wider land", "a mill of less module leaves a wider root", ""};
  const double root = part.lowest_root(), under = underside_height(gear);
  for (int zone = part.zones(); zone-- > 0;) {  // s rises inwards
    out.rings.push_back({&part.space(zone), zone});
    std::vector<Vec2>& corners = out.corners.emplace_back();
    if (zone > 0) corners = {{part.space(zone).outline().s_to, root}, {part.space(zone - 1).outline().s_from, root}};
    else corners = {{-gear.R_i(), under}, {part.space(part.zones() - 1).outline().s_from, under}};
  }
  return out;
}

}  // namespace toothpath::bevel_gear
