#include "app/process/ease_off/motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/base/units.h"
#include "geometry/base/angle.h"

namespace toothpath::ease_off {

nlohmann::ordered_json transmission_error_json(double mean_rad, double range_rad, double lever_mm) {
  return {{"mean_urad", mean_rad * app::kMicro},
          {"range_urad", range_rad * app::kMicro},
          {"range_arcsec", degrees(range_rad) * 3600},
          {"range_um", range_rad * lever_mm * app::kUm}};
}

nlohmann::ordered_json motion_json(const MotionCurve& curve, std::size_t stride) {
  nlohmann::ordered_json json = {{"pitches", nlohmann::ordered_json::array()},
                                 {"urad", nlohmann::ordered_json::array()}};
  std::size_t least = 0;
  for (std::size_t k = 1; k < curve.phi_2.size(); ++k)
    if (curve.lags * curve.error_rad[k] < curve.lags * curve.error_rad[least]) least = k;
  for (std::size_t k = 0; k < curve.phi_2.size(); k += stride) {
    json["pitches"].push_back((curve.phi_2[k] - curve.phi_2[least]) / curve.pitch);
    json["urad"].push_back((curve.error_rad[k] - curve.mean_rad) * app::kMicro);
  }
  return json;
}

svg::LineChart motion_chart(const std::vector<MotionCurve>& curves) {
  svg::LineChart motion;
  motion.title = "Motion curves of the pairs";
  motion.x_label = "gear turn [pitches]";
  motion.y_label = "error less its mean [\u00b5rad]";
  motion.note =
      "Each pair as if it were alone, through its whole mesh and on its edges; of all pairs the one that lags least "
      "bears, and where two curves cross one takes over from the other.";
  for (const MotionCurve& curve : curves)
    for (const int tooth : {-1, 0, 1}) {
      svg::ChartSeries series{fmt::format("{}, pair {:+}", curve.name, tooth), {}, {}};
      for (std::size_t k = 0; k < curve.phi_2.size(); ++k) {
        const double value = curve.error_rad[k] - curve.mean_rad;
        if (std::abs(value) > 4 * curve.range_rad) continue;
        series.x.push_back((curve.phi_2[k] - curve.start) / curve.pitch + tooth);
        series.y.push_back(value * app::kMicro);
      }
      if (!series.x.empty()) motion.series.push_back(std::move(series));
    }
  return motion;
}

}  // namespace toothpath::ease_off
