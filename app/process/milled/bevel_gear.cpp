#include "app/process/milled/bevel_gear.h"

#include <algorithm>
#include <cmath>
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

std::vector<sheet::DataRow> bevel_blank_data(const tooth_space::ToothSpace& space, double pitch_angle_rad,
                                             double root_angle_rad, double root_depth_outer_mm) {
  using sheet::data_angle, sheet::data_length;
  const auto& ring = space.outline();
  const double outer = -ring.s_from, inner = -ring.s_to, tip_e = space.tip(ring.s_from), tip_i = space.tip(ring.s_to);
  const double r_e = ring.chart.r(ring.s_from, tip_e), r_i = ring.chart.r(ring.s_to, tip_i),
               z_e = ring.chart.z(ring.s_from, tip_e), z_i = ring.chart.z(ring.s_to, tip_i);
  return {data_angle("delta", "pitch angle", pitch_angle_rad),
          data_angle("delta_a", "face angle", std::atan2(r_e - r_i, z_e - z_i)),
          data_angle("delta_f", "root angle", root_angle_rad),
          data_length("R_e", "outer cone distance", outer),
          data_length("R_m", "mean cone distance", 0.5 * (outer + inner)),
          data_length("R_i", "inner cone distance", inner),
          data_length("b", "face width", outer - inner),
          data_length("d_e", "outer pitch diameter", 2 * outer * std::sin(pitch_angle_rad)),
          data_length("d_ae", "outside diameter", 2 * r_e),
          data_length("d_ai", "outside diameter at the small end", 2 * r_i),
          data_length("t_xo", "pitch apex to crown, along the axis", z_e),
          data_length("b_x", "face width along the axis, crown to front crown", z_e - z_i),
          data_length("h_ae", "outer addendum", tip_e),
          data_length("h_fe", "outer dedendum", root_depth_outer_mm),
          data_length("h_e", "outer whole depth", tip_e + root_depth_outer_mm)};
}

void add_blank(nlohmann::ordered_json& limits, const tooth_space::ToothSpace& space) {
  const auto& ring = space.outline();
  const double tip = space.tip(ring.s_from);
  limits["outside_diameter"] = 2 * ring.chart.r(ring.s_from, tip);
  limits["apex_to_crown"] = ring.chart.z(ring.s_from, tip);
}

}  // namespace toothpath::milled
