#include "app/process/straight_bevel/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/tooth_space/limits.h"

namespace toothpath::straight_bevel {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPoints = 41;

Json mid_flank(const CrownSpace& space, int side) {
  const auto& ring = space.outline();
  const double s = 0.5 * (ring.s_from + ring.s_to);
  const auto at = tooth_space::middle_of_flank(space, side, s);
  if (!at) return nullptr;
  const auto k = tooth_space::principal_curvatures(*at);
  return Json{{"cone_distance", -s}, {"curvatures", {k.least, k.most}}, {"gauss", k.least * k.most}};
}

}  // namespace

std::string limits_json(const StraightBevelGear& gear) {
  const CrownSpace& space = gear.space();
  const auto& w = space.kernel();
  const auto& ring = space.outline();
  Json flanks = Json::array();
  for (const int side : {1, -1}) {
    double fillet = INFINITY, ball = INFINITY, land = INFINITY;
    for (const double s : {ring.s_from, 0.5 * (ring.s_from + ring.s_to), ring.s_to}) {
      const tooth_space::SpaceLimits limits = tooth_space::limits_at(space, s, side);
      fillet = std::min(fillet, limits.fillet_radius_min_mm);
      ball = std::min(ball, limits.root_ball_radius_mm);
      land = std::min(land, top_land_mm(space, s));
    }
    flanks.push_back({{"side", side},
                      {"fillet_radius_min", fillet},
                      {"root_ball", ball},
                      {"top_land", land},
                      {"undercut", nullptr},
                      {"mid_flank", mid_flank(space, side)}});
  }
  const Json zone = {{"zone", 0}, {"from", w.R_i}, {"to", w.R_e}, {"flanks", std::move(flanks)}};
  const Json out = {{"schema", 1},
                    {"pitch_angle", degrees(gear.parameters().pitch_angle_rad)},
                    {"root_angle", degrees(gear.root_angle())},
                    {"outer_cone_distance", w.R_e},
                    {"inner_cone_distance", w.R_i},
                    {"outside_diameter", 2 * ring.chart.r(ring.s_from, space.tip(ring.s_from))},
                    {"apex_to_crown", ring.chart.z(ring.s_from, space.tip(ring.s_from))},
                    {"zones", Json::array({zone})}};
  return json_text(out, 2) + "\n";
}

svg::LineChart limit_chart(const StraightBevelGear& gear) {
  const CrownSpace& space = gear.space();
  const auto& w = space.kernel();
  svg::LineChart chart;
  chart.title = "Lands over the cone distance";
  chart.x_label = "cone distance [mm]";
  chart.y_label = "arc [mm]";
  svg::ChartSeries top{"top land", {}, {}}, root{"root land", {}, {}};
  for (int k = 0; k < kPoints; ++k) {
    const double R = w.R_i + (w.R_e - w.R_i) * k / (kPoints - 1);
    top.x.push_back(R);
    top.y.push_back(top_land_mm(space, -R));
    root.x.push_back(R);
    root.y.push_back(2 * w.psi_f * R * std::sin(gear.root_angle()));
  }
  chart.series = {std::move(top), std::move(root)};
  chart.note = "All widths but the top land shrink with the cone distance, fillets too: the small end rules the tools.";
  return chart;
}

}  // namespace toothpath::straight_bevel
