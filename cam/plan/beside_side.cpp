#include "cam/plan/beside_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cam/ball/tool_direction.h"

namespace toothpath::plan {
namespace {

constexpr double kKeySpacing = 0.05;  // mm of radius, at least, between two keys

/// Keys of one pass; `aside` is added to their lean to the side.
std::vector<path::ToolAxisKey> keys_of(const line::LinePass& pass, const tooth_space::Outline& ring,
                                       const ball::PitchFrame& frame, double aside) {
  std::vector<path::ToolAxisKey> keys;
  for (const line::LineRecord& record : pass.records) {
    // A pose that is lifted lies on the axis of one that is not, farther out or in: not at its own radius.
    if (record.lift > 0) continue;
    const Vec3& a = record.axis.a;
    const double up = a.dot(frame.up);
    keys.push_back({ring.sign * ring.chart.along(record.axis.c_0), std::atan(a.dot(frame.outwards) / up),
                    std::atan(a.dot(frame.side) / up) + aside});
  }
  std::stable_sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.radius_mm < b.radius_mm; });
  std::vector<path::ToolAxisKey> apart;
  for (const auto& key : keys)
    if (apart.empty() || key.radius_mm > apart.back().radius_mm + kKeySpacing) apart.push_back(key);
  return apart;
}

}  // namespace

ball::Leading beside_side(const analytic::GearDistance& part, const line::LinePlan& side, int operation) {
  ball::Leading out;
  out.words = fmt::format("beside the poses of operation {}", operation);
  for (int zone = 0; zone < part.zones(); ++zone) {
    const ball::PitchFrame frame = ball::pitch_frame(part, zone);
    const tooth_space::Outline& ring = part.space(zone).outline();
    auto& trials = out.zones.emplace_back();
    for (const double off : kOffFlank) {
      ball::LedAxes led;
      for (const line::LinePass& pass : side.passes) {
        if (pass.zone != zone || pass.strip + 1 != pass.strips) continue;
        if (pass.side > 0) led.plus = keys_of(pass, ring, frame, off);
        else led.minus = keys_of(pass, ring, frame, -off);
      }
      if (!led.plus.empty() && !led.minus.empty()) trials.push_back(std::move(led));
    }
  }
  return out;
}

}  // namespace toothpath::plan
