#include "app/process/bevel/files.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cam/finger/bodies.h"
#include "cam/finger/milling.h"
#include "cam/finger/obstacles.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::bevel {
namespace {

std::string gear_words(const bevel_gear::BevelGearParameters& p) {
  return fmt::format("bevel gear, z {}, {}outer transverse module {:g} mm", p.teeth,
                     p.mate_teeth > 0 ? fmt::format("mate z {}, ", p.mate_teeth) : "", p.outer_transverse_module_mm);
}

}  // namespace

joints::ClearanceBody clearance_body(const bevel_gear::BevelGear& g) {
  const auto& p = g.parameters();
  const double below = p.dedendum_mm + 2 * p.outer_transverse_module_mm;
  joints::ClearanceBody body{g.R_e() * g.sin_delta() + p.addendum_mm * g.cos_delta(),
                             g.R_i() * g.cos_delta() - p.addendum_mm * g.sin_delta(),
                             g.R_e() * g.cos_delta() + below * g.sin_delta()};
  for (const finger::CoaxialBody& beside : finger::bodies_beside_teeth(g))
    for (const Vec2& rim : beside.rims) {
      body.radius_mm = std::max(body.radius_mm, rim.x());
      body.z_min_mm = std::min(body.z_min_mm, rim.y());
      body.z_max_mm = std::max(body.z_max_mm, rim.y());
    }
  return body;
}

joints::ClearanceBody link_body(const bevel_gear::BevelGear& g, const std::vector<tool::ToolAssembly>& tools,
                                const machines::Machine& machine) {
  joints::ClearanceBody body = clearance_body(g);
  if (machine.tcp == machines::TcpMode::none) return body;
  double below = 0;  // the tip; every axis stands at 90 deg + delta to the gear axis
  for (const auto& tool : tools) {
    const auto own = finger::gear_for_finger_mill(g, tool);
    if (!own) continue;  // its operation is refused
    for (const auto& part : finger::finger_bodies(own->cutter(), tool))
      for (const tool::Frustum& f : part.pieces)
        below = std::max({below, f.radius_from * g.cos_delta() - f.from * g.sin_delta(),
                          f.radius_to * g.cos_delta() - f.to * g.sin_delta()});
  }
  body.z_min_mm -= below;
  return body;
}

sheet::PartOutline outline(const bevel_gear::BevelGear& g) {
  const auto& p = g.parameters();
  const joints::ClearanceBody body = clearance_body(g);
  const double inner = std::max(0.0, g.R_i() * g.sin_delta() - p.dedendum_mm * g.cos_delta());
  return {inner,         body.radius_mm, body.z_min_mm, g.R_e() * g.cos_delta() + p.dedendum_mm * g.sin_delta(),
          body.z_max_mm, gear_words(p)};
}

std::string limits_json(const bevel_gear::BevelGear& g) {
  const bevel_gear::BevelLimits& l = g.limits();
  nlohmann::ordered_json j = {{"schema", 1},
                              {"top_land", l.top_land_mm},
                              {"space_width", l.space_width_mm},
                              {"module_limit", l.module_limit_mm},
                              {"module_at_small_end", l.module_at_small_end_mm},
                              {"tip_flat", l.tip_flat_mm},
                              {"tip_radius_limit", l.tip_radius_limit_mm},
                              {"cutter_line_angle", degrees(l.line_angle_rad)},
                              {"corner_fillet_reach", l.fillet_reach_mm},
                              {"largest_face_width", l.largest_face_width_mm},
                              {"least_regularity", l.least_regularity},
                              {"cusp_speed_ratio", l.cusp_speed_ratio},
                              {"cusp_loss", l.cusp_loss_mm},
                              {"pitch_angle", degrees(g.delta())},
                              {"outer_cone_distance", g.R_e()},
                              {"inner_cone_distance", g.R_i()},
                              {"trace_end", g.R_0()}};
  return json_text(j, 2) + "\n";
}

}  // namespace toothpath::bevel
