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

sheet::DataGroup gear_data(const bevel_gear::BevelGear& g) {
  using sheet::data_angle, sheet::data_length, sheet::data_number;
  const auto& p = g.parameters();
  const double h_a = p.addendum_mm;
  const auto tip_r = [&](double R) { return R * g.sin_delta() + h_a * g.cos_delta(); };
  const auto tip_z = [&](double R) { return R * g.cos_delta() - h_a * g.sin_delta(); };
  sheet::DataGroup out{g.herringbone() ? "Equal-base-circle bevel gear, herringbone" : "Equal-base-circle bevel gear",
                       {data_number("z", "number of teeth", p.teeth),
                        data_length("m_te", "outer transverse module", p.outer_transverse_module_mm),
                        data_angle("alpha_n", "normal pressure angle", p.pressure_angle_rad),
                        {"", g.herringbone() ? "hand of the inner half" : "hand", p.hand > 0 ? "right" : "left"},
                        data_angle("beta_e", "spiral angle at the large end", p.outer_spiral_angle_rad),
                        data_angle("delta", "pitch angle, face and root cones parallel to it", g.delta()),
                        data_length("R_e", "outer cone distance", g.R_e()),
                        data_length("R_m", "mean cone distance", g.R_m()),
                        data_length("R_i", "inner cone distance", g.R_i()),
                        data_length("b", "face width", p.face_width_mm),
                        data_length("m_mn", "mean normal module", g.normal_module(g.R_m())),
                        data_length("d_e", "outer pitch diameter", 2 * g.R_e() * g.sin_delta()),
                        data_length("d_ae", "outside diameter", 2 * tip_r(g.R_e())),
                        data_length("d_ai", "outside diameter at the small end", 2 * tip_r(g.R_i())),
                        data_length("t_xo", "pitch apex to crown, along the axis", tip_z(g.R_e())),
                        data_length("h_a", "addendum", h_a),
                        data_length("h_f", "dedendum", p.dedendum_mm),
                        data_length("h", "whole depth", h_a + p.dedendum_mm),
                        data_length("j_t", "backlash of the pair on the outer pitch circle", p.backlash_mm)}};
  if (p.mate_teeth > 0) {
    out.rows.push_back(data_number("z_2", "teeth of the mate", p.mate_teeth));
    out.rows.push_back(data_angle("Sigma", "shaft angle", p.shaft_angle_rad));
  }
  return out;
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
