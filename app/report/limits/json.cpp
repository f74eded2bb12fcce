#include "app/report/limits/json.h"

#include <nlohmann/json.hpp>

#include "app/report/limits/chart.h"
#include "geometry/base/json_text.h"

namespace toothpath::limits {
namespace {

constexpr int kFilletPoints = 9;

}  // namespace

std::string limits_json(const face_gear::FaceGear& gear) {
  using Json = nlohmann::ordered_json;
  const auto radius = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json zones = Json::array();
  for (std::size_t i = 0; i < gear.rings().size(); ++i) {
    const face_gear::FaceGearRing& ring = gear.rings()[i];
    Json flanks = Json::array();
    for (const face_gear::FlankLimits& flank : ring.limits.flanks) {
      Json fillet = Json::array();
      for (int k = 0; k < kFilletPoints; ++k) {
        const double r = ring.zone.inner_radius_mm +
                         (ring.zone.outer_radius_mm - ring.zone.inner_radius_mm) * k / (kFilletPoints - 1);
        fillet.push_back(
            {{"radius", r}, {"height", radius(face_gear::fillet_line_height(ring.surface, flank.side, r))}});
      }
      flanks.push_back({{"side", flank.side},
                        {"undercut_radius", radius(flank.undercut_radius)},
                        {"involute_start_radius", radius(flank.involute_start_radius)},
                        {"pointing_radius", radius(ring.limits.pointing_radius)},
                        {"land_radius", radius(ring.limits.land_radius)},
                        {"undercut_height", radius(flank.undercut_height)},
                        {"fillet_line", std::move(fillet)}});
    }
    zones.push_back({{"zone", i},
                     {"inner_radius", ring.zone.inner_radius_mm},
                     {"outer_radius", ring.zone.outer_radius_mm},
                     {"inner_limit", ring.limits.inner_limit},
                     {"inner_limit_name", ring.limits.inner_limit_name},
                     {"governing", governing_limit(ring.limits)},
                     {"land_radius", radius(ring.limits.land_radius)},
                     {"practical_land", ring.limits.practical_land_mm},
                     {"flanks", std::move(flanks)}});
  }
  return json_text(Json{{"schema", 1}, {"zones", std::move(zones)}}, 2) + "\n";
}

}  // namespace toothpath::limits
