#include "app/process/milled/bevel_gear.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

namespace toothpath::milled {

ToothedGear bevel_gear(std::shared_ptr<const void> owner, std::shared_ptr<const tooth_space::ToothedPart> part,
                       tooth_space::ToothedSolid solid, const tooth_space::BevelBody& body, const std::string& words) {
  const tooth_space::ToothSpace& space = part->space(0);
  const auto& ring = space.outline();
  const auto r = [&](double s, double h) { return ring.chart.r(s, h); };
  const auto z = [&](double s, double h) { return ring.chart.z(s, h); };
  const double tip_from = space.tip(ring.s_from), tip_to = space.tip(ring.s_to);
  const double outer = std::max(r(ring.s_from, tip_from), r(ring.s_to, tip_to)),
               top = std::min(z(ring.s_from, tip_from), z(ring.s_to, tip_to)),
               bottom = tooth_space::body_ends(space, body)[1];
  ToothedGear out;
  out.facts = {body.teeth, 2 * outer, 2 * outer, {}};
  out.body = {{outer, top, bottom}, {outer, 0, bottom, top, proof::Roof(*part)}};
  out.outline = {r(ring.s_to, body.root_front), outer, top, z(ring.s_from, body.root_back), bottom, words};
  out.part = std::move(part);
  out.solid = std::move(solid);
  out.owner = std::move(owner);
  return out;
}

void add_blank(nlohmann::ordered_json& limits, const tooth_space::ToothSpace& space) {
  const auto& ring = space.outline();
  const double tip = space.tip(ring.s_from);
  limits["outside_diameter"] = 2 * ring.chart.r(ring.s_from, tip);
  limits["apex_to_crown"] = ring.chart.z(ring.s_from, tip);
}

}  // namespace toothpath::milled
