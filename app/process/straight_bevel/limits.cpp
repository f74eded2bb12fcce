#include "app/process/straight_bevel/limits.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "app/process/milled/bevel_gear.h"
#include "app/process/milled/ring_limits.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::straight_bevel {

std::string limits_json(const StraightBevelGear& gear) {
  const auto& w = gear.space().kernel();
  nlohmann::ordered_json out = {{"schema", 1},
                                {"pitch_angle", degrees(gear.parameters().pitch_angle_rad)},
                                {"root_angle", degrees(gear.root_angle())},
                                {"outer_cone_distance", w.R_e},
                                {"inner_cone_distance", w.R_i}};
  milled::add_blank(out, gear.space());
  out["zones"] = nlohmann::ordered_json::array({milled::ring_zone(gear.space())});
  return json_text(out, 2) + "\n";
}

svg::LineChart limit_chart(const StraightBevelGear& gear) {
  const double per_s = -2 * gear.space().kernel().psi_f * std::sin(gear.root_angle());
  return milled::land_chart(
      gear.space(), [&](double s) { return per_s * s; },
      "All widths but the top land shrink with the cone distance, fillets too: the small end rules the tools.");
}

}  // namespace toothpath::straight_bevel
