#include "app/process/spiral_bevel/limits.h"

#include <nlohmann/json.hpp>

#include "app/process/milled/bevel_gear.h"
#include "app/process/milled/ring_limits.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::spiral_bevel {

std::string limits_json(const SpiralBevelGear& gear) {
  const SpiralBevelParameters& p = gear.parameters();
  nlohmann::ordered_json out = {{"schema", 1},
                                {"pitch_angle", degrees(p.pitch_angle_rad)},
                                {"root_angle", degrees(p.cuts.front().root_angle_rad)},
                                {"outer_cone_distance", p.outer_cone_distance_mm},
                                {"inner_cone_distance", p.outer_cone_distance_mm - p.face_width_mm},
                                {"outer_transverse_module", gear.body().module_mm},
                                {"mean_space_width", gear.space_width_mm()}};
  milled::add_blank(out, gear.space());
  nlohmann::ordered_json zone = milled::ring_zone(gear.space());
  for (auto& flank : zone["flanks"]) flank["spiral_angle"] = degrees(gear.spiral_angle(flank["side"].get<int>()));
  out["zones"] = nlohmann::ordered_json::array({std::move(zone)});
  return json_text(out, 2) + "\n";
}

svg::LineChart limit_chart(const SpiralBevelGear& gear) {
  return milled::land_chart(
      gear.space(), [&](double s) { return root_land_mm(gear.space(), s); },
      "Fillets keep about the rounding of the cutter along the whole tooth: the narrower root rules the tools.");
}

}  // namespace toothpath::spiral_bevel
