#include "app/process/milled/ring_limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "geometry/tooth_space/limits.h"

namespace toothpath::milled {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kPoints = 41;

Json mid_flank(const tooth_space::ToothSpace& space, int side) {
  const auto& ring = space.outline();
  const double s = 0.5 * (ring.s_from + ring.s_to);
  const auto at = tooth_space::middle_of_flank(space, side, s);
  if (!at) return nullptr;
  const auto k = tooth_space::principal_curvatures(*at);
  std::string station = ring.along;
  std::replace(station.begin(), station.end(), ' ', '_');
  return Json{{station, ring.sign * s}, {"curvatures", {k.least, k.most}}, {"gauss", k.least * k.most}};
}

}  // namespace

Json ring_zone(const tooth_space::ToothSpace& space) {
  const auto& ring = space.outline();
  Json flanks = Json::array();
  const double stations[] = {ring.s_from, 0.5 * (ring.s_from + ring.s_to), ring.s_to};
  double ball = INFINITY, land = INFINITY;
  // s of a station in the root.
  const auto s_root = [&](double station) {
    const auto v = tooth_space::v_at_station(space, tooth_space::Piece::root, 0.5, station);
    const auto q = v && ring.leaning ? space.point(tooth_space::Piece::root, 0.5, *v) : std::nullopt;
    return q ? ring.chart.along(q->p) : station;
  };
  for (const double station : stations) {
    ball = std::min(ball, tooth_space::root_ball_radius_mm(space, s_root(station)));
    land = std::min(land, tooth_space::top_land_mm(space, space.tip_s(station)));
  }
  for (const int side : {1, -1}) {
    double fillet = INFINITY;
    for (const double station : stations)
      fillet = std::min(fillet, tooth_space::fillet_radius_min_mm(space, s_root(station), side));
    flanks.push_back({{"side", side},
                      {"fillet_radius_min", fillet},
                      {"root_ball", ball},
                      {"top_land", land},
                      {"undercut", nullptr},
                      {"mid_flank", mid_flank(space, side)}});
  }
  const auto [from, to] = ring.told(ring.s_from, ring.s_to);
  return {{"zone", 0}, {"from", from}, {"to", to}, {"flanks", std::move(flanks)}};
}

svg::LineChart land_chart(const tooth_space::ToothSpace& space, const std::function<double(double s)>& root_land,
                          std::string note) {
  const auto& ring = space.outline();
  svg::LineChart chart;
  chart.title = fmt::format("Lands over the {}", ring.along);
  chart.x_label = fmt::format("{} [mm]", ring.along);
  chart.y_label = "arc [mm]";
  svg::ChartSeries top{"top land", {}, {}}, root{"root land", {}, {}};
  const auto [from, to] = ring.told(ring.s_from, ring.s_to);
  for (int k = 0; k < kPoints; ++k) {
    const double x = from + (to - from) * k / (kPoints - 1), s = ring.sign * x;
    top.x.push_back(x);
    top.y.push_back(tooth_space::top_land_mm(space, s));
    root.x.push_back(x);
    root.y.push_back(root_land(s));
  }
  chart.series = {std::move(top), std::move(root)};
  chart.note = std::move(note);
  return chart;
}

}  // namespace toothpath::milled
