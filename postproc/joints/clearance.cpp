#include "postproc/joints/clearance.h"

#include <algorithm>
#include <cmath>

namespace toothpath::joints {
namespace {

constexpr int kSamples = 48;

double distance_to_line(const Vec3& p, const Vec3& on_line, const Vec3& direction) {
  return (p - on_line).cross(direction).norm();
}

}  // namespace

double body_top(const machines::KinematicChain& chain, const GearPlacement& gear, const ClearanceBody& body,
                const std::array<double, 2>& rotaries) {
  const auto machine = [&](const Vec3& p_W) {
    return chain.table_to_machine(gear.rotation * p_W + gear.origin, rotaries);
  };
  const Vec3 low = machine(Vec3(0, 0, body.z_min_mm)), high = machine(Vec3(0, 0, body.z_max_mm));
  const double g_z = (machine(Vec3::UnitZ()) - machine(Vec3::Zero())).z();
  return std::max(low.z(), high.z()) + body.radius_mm * std::sqrt(std::max(0.0, 1 - g_z * g_z));
}

double swept_top(const machines::KinematicChain& chain, const GearPlacement& gear, const ClearanceBody& body,
                 const std::array<double, 2>& from, const std::array<double, 2>& to, bool index_is_gear_axis) {
  // Farthest point of the body from each table axis, with the others at any angle.
  double reach[2] = {0, 0};
  const double half = std::max(std::abs(body.z_min_mm), std::abs(body.z_max_mm));
  const double body_radius = std::hypot(body.radius_mm, half);
  double travel[2] = {0, 0};
  for (std::size_t k = 0; k < chain.table.size(); ++k) {
    if (k == 0 && index_is_gear_axis) continue;
    reach[k] = distance_to_line(gear.origin, chain.table[k].point_mm, chain.table[k].direction) + body_radius;
    if (k == 1) reach[k] += 2 * distance_to_line(gear.origin, chain.table[0].point_mm, chain.table[0].direction);
    travel[k] = to[k] - from[k];
  }
  const int n0 = travel[0] != 0 ? kSamples : 0, n1 = travel[1] != 0 ? kSamples : 0;
  double top = -1e300;
  for (int i = 0; i <= n0; ++i)
    for (int j = 0; j <= n1; ++j) {
      const double s = n0 > 0 ? static_cast<double>(i) / n0 : 0, t = n1 > 0 ? static_cast<double>(j) / n1 : 0;
      top = std::max(top, body_top(chain, gear, body, {from[0] + s * travel[0], from[1] + t * travel[1]}));
    }
  double rise = 0;
  if (n0 > 0) rise += reach[0] * std::abs(travel[0]) / (2 * n0);
  if (n1 > 0) rise += reach[1] * std::abs(travel[1]) / (2 * n1);
  return top + rise;
}

std::optional<double> room_at_start(const machines::Machine& machine, const GearPlacement& gear,
                                    const ClearanceBody& body, const AxisOptions& options, double tool_length_mm) {
  const machines::KinematicChain& chain = machine.chain;
  if (!chain.head.empty() && std::any_of(chain.table.begin(), chain.table.end(), [](const machines::RotaryAxis& axis) {
        return std::abs(axis.direction.z()) < 1;
      }))
    return {};
  std::array<double, 2> start{};
  if (machine.tcp != machines::TcpMode::none && options.tcp_starts_at_zero && !options.tilted_planes)
    for (std::size_t k = 0; k < chain.rotary_count(); ++k) start[k] = chain.rotary(k).zero_rad;
  const double top = machine.top_mm();
  return top - tool_length_mm - body_top(chain, gear, body, start) - options.clearance_margin_mm;
}

}  // namespace toothpath::joints
