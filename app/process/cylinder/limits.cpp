#include "app/process/cylinder/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/tooth_space/curvature.h"

namespace toothpath::cylinder {
namespace {

using Json = nlohmann::ordered_json;
using tooth_space::Piece;

constexpr int kPoints = 121;
constexpr double kBeyondTip = 0.6;  // of the module: how far the charts go on

/// Half way up the flank between form and tip circle, in the middle of the face.
Json mid_flank(const cylindrical::InvoluteSpace& space, Piece flank) {
  const auto& w = space.kernel();
  const double form = w.r_b * std::sqrt(1 + w.theta_f * w.theta_f), r = 0.5 * (form + w.r_a);
  const auto at = space.at(flank, w.theta_at(r), 0.5 * (w.z_from + w.z_to));
  if (!at) return nullptr;
  const auto k = tooth_space::principal_curvatures(*at);
  return Json{{"radius", r}, {"height", w.r_a - form}, {"curvatures", {k.least, k.most}}, {"gauss", k.least * k.most}};
}

/// Radius at which the teeth come to a point, as far as a chart goes.
double end_of_chart(const cylindrical::InvoluteKernel<double>& w) {
  return std::min(cylindrical::tip_diameter_of_land(w, 0).value_or(2 * w.r_a) / 2, w.r_a + kBeyondTip * w.m);
}

}  // namespace

std::string limits_json(const cylindrical::CylindricalGear& gear) {
  Json zones = Json::array();
  for (int zone = 0; zone < gear.zones(); ++zone) {
    const cylindrical::InvoluteSpace& space = gear.space(zone);
    const auto& w = space.kernel();
    const cylindrical::CylindricalLimits limits = cylindrical::limits_of(space);
    Json flanks = Json::array();
    for (const Piece flank : {Piece::flank_plus, Piece::flank_minus})
      flanks.push_back({{"side", side_of(flank)},
                        {"fillet_radius_min", limits.fillet_radius_min_mm},
                        {"root_ball", limits.root_ball_radius_mm},
                        {"top_land", limits.top_land_mm},
                        {"undercut", nullptr},
                        {"form_diameter", limits.form_diameter_mm},
                        {"mid_flank", mid_flank(space, flank)}});
    zones.push_back({{"zone", zone},
                     {"from", w.z_from},
                     {"to", w.z_to},
                     {"helix_angle", degrees(std::atan2(w.sin_b, w.cos_b))},
                     {"flanks", std::move(flanks)}});
  }
  const auto& w = gear.space(0).kernel();
  Json out = {
      {"schema", 1},
      {"reference_diameter", 2 * w.r},
      {"base_diameter", 2 * w.r_b},
      {"root_diameter", gear.root_diameter()},
      {"tip_diameter", gear.tip_diameter()},
      {"least_profile_shift", cylindrical::least_profile_shift(gear.parameters(), gear.parameters().zones.front())},
      {"largest_root_radius_coefficient",
       cylindrical::largest_root_radius_coefficient(gear.parameters(), gear.parameters().zones.front())}};
  if (const auto pointed = cylindrical::tip_diameter_of_land(w, 0)) out["pointed_tip_diameter"] = *pointed;
  if (gear.zones() > 1) out["groove_diameter"] = gear.groove_diameter();
  out["zones"] = std::move(zones);
  return json_text(out, 2) + "\n";
}

std::vector<svg::LineChart> limit_charts(const cylindrical::CylindricalGear& gear) {
  std::vector<svg::LineChart> out;
  for (int zone = 0; zone < gear.zones(); ++zone) {
    const auto& w = gear.space(zone).kernel();
    const double form = w.r_b * std::sqrt(1 + w.theta_f * w.theta_f), end = end_of_chart(w);
    svg::LineChart chart;
    chart.title = fmt::format("Teeth and spaces over the radius, zone {}", zone);
    chart.x_label = "radius [mm]";
    chart.y_label = "arc in the transverse plane [mm]";
    svg::ChartSeries tooth{"tooth thickness", {}, {}}, space{"space width", {}, {}};
    for (int k = 0; k < kPoints; ++k) {
      const double r = form + (end - form) * k / (kPoints - 1), eta = w.eta(w.theta_at(r));
      tooth.x.push_back(r);
      tooth.y.push_back(2 * r * (kPi / w.teeth - eta));
      space.x.push_back(r);
      space.y.push_back(2 * r * eta);
    }
    const double most = std::max(*std::max_element(tooth.y.begin(), tooth.y.end()), space.y.back());
    chart.series = {std::move(tooth),
                    std::move(space),
                    {"form circle", {form, form}, {0, most}},
                    {"reference circle", {w.r, w.r}, {0, most}},
                    {"tip circle", {w.r_a, w.r_a}, {0, most}}};
    const double land = gear.parameters().least_land * gear.parameters().module_mm;
    chart.limits = {{fmt::format("least land {:g} mm", land), land}};
    chart.note = fmt::format(
        "The involute ends at the form circle, {:.4f} mm; below it the rack's rounding cuts the fillet.", form);
    out.push_back(std::move(chart));
  }
  return out;
}

}  // namespace toothpath::cylinder
