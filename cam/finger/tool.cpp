#include "cam/finger/tool.h"

#include <algorithm>
#include <cmath>

#include "cam/finger/finger_profile.h"

namespace toothpath::finger {
namespace {

/// Flanks of another mill on its own paths: how far it cuts beyond ours, mm.
double shape_difference(const bevel_gear::BevelGear& own, const bevel_gear::BevelGear& gear) {
  const auto &a = own.cutter_data(), &b = gear.cutter_data();
  if (a.module_mm == b.module_mm && a.tip_radius_mm == b.tip_radius_mm && a.rack_depth_mm == b.rack_depth_mm) return 0;
  double worst = 0;
  const double low = -gear.parameters().dedendum_mm, high = gear.parameters().addendum_mm;
  for (std::size_t i = 0; i < gear.halves().size(); ++i)
    for (int k = 0; k < 2; ++k)
      for (int c = 0; c <= 16; ++c)
        for (int r = 0; r <= 32; ++r) {
          const auto& half = gear.halves()[i];
          const double ell = half.ell_from + (half.ell_to - half.ell_from) * c / 16.0;
          const double height = low + (high - low) * (r + 0.05) / 32.05;
          const auto ours = bevel_gear::bevel_inverse(half.walls[k], ell, height),
                     theirs = bevel_gear::bevel_inverse(own.halves()[i].walls[k], ell, height);
          if (!ours || !theirs) continue;
          const double lateral = half.walls[k].sigma * (ours->azimuth - theirs->azimuth) *
                                 (ell * gear.sin_delta() + height * gear.cos_delta());
          worst = std::max(worst, lateral);
        }
  return worst;
}

}  // namespace

FingerRadiusTable::FingerRadiusTable(const bevel_gear::FingerSolid& solid)
    : low_(solid.profile().x_B), high_(solid.profile().x_D) {
  const auto n = static_cast<std::size_t>(kCells);
  for (std::size_t i = 0; i <= n; ++i)
    radius_[i] = solid.radius(low_ + (high_ - low_) * static_cast<double>(i) / kCells);
  double slope = 0;
  for (std::size_t i = 0; i < n; ++i)
    slope = std::max(slope, std::atan((radius_[i + 1] - radius_[i]) / ((high_ - low_) / kCells)));
  shrink_ = std::cos(slope);
  radius_end_ = solid.largest_radius();
  for (std::size_t i = 0; i <= n; ++i) lower_[i] = solid.lower_surface(radius_end_ * static_cast<double>(i) / kCells);
}

double FingerRadiusTable::floor_below(double rho) const {
  return lower_[static_cast<std::size_t>(std::clamp(rho / radius_end_, 0.0, 1.0) * kCells)];
}

double FingerRadiusTable::lower_bound(double x, double rho) const {
  const double s = std::clamp((x - low_) / (high_ - low_), 0.0, 1.0) * kCells;
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(s), kCells - 1);
  return (rho - radius_[i + 1]) * shrink_;  // the next node: the radius never falls with x
}

FingerTool::FingerTool(const bevel_gear::BevelGear& own, const bevel_gear::BevelGear& finished,
                       const tool::ToolAssembly& tool)
    : gear(own),
      solid(own.cutter()),
      table(solid),
      walls{WallReference(own, 1), WallReference(own, -1)},
      shape_mm(shape_difference(own, finished)),
      depth_mm(own.parameters().dedendum_mm + own.parameters().addendum_mm),
      shank_from_mm(finger_flute_end(own.cutter(), tool)),
      holder_from_mm(tool.holder.empty() ? 1e6 : tool.stick_out_mm) {}

double least_distance(const Vec3& p, const path::ToolMotion& m, const FingerTool& tool, double best) {
  const double h_f = tool.gear.parameters().dedendum_mm;
  const auto meridian = [&](double t) {
    const Vec3 u = path::axis_at(m, t), w = p - path::tip_at(m, t);
    const double s = w.dot(u);
    return Vec2(s - h_f, (w - s * u).norm());
  };
  const double length = (m.tip_to - m.tip_from).norm() + (m.axis_to - m.axis_from).norm() * tool.depth_mm;
  const Vec2 mid = meridian(0.5);
  if (tool.table.lower_bound(mid[0], mid[1]) - 0.5 * length > best) return best;
  const auto distance = [&](double t) {
    const Vec2 q = meridian(t);
    return tool.solid.signed_distance(q[0], q[1]);
  };
  const double middle = tool.solid.signed_distance(mid[0], mid[1]);
  if (middle - 0.5 * length > best) return best;
  // Near the contact the distance is a smooth bowl: successive parabolas through the best three.
  double a = 0, fa = distance(0), c = 1, fc = distance(1), b = 0.5, fb = middle;
  double least = std::min({best, fa, fb, fc});
  for (int k = 0; k < 6; ++k) {
    const double d1 = (fb - fa) / (b - a), d2 = (fc - fb) / (c - b), bend = (d2 - d1) / (c - a);
    if (!(bend > 0)) break;
    const double t = std::clamp(0.5 * (a + b) - 0.5 * d1 / bend, a, c);
    const double expected = fb + (t - b) * (d1 + bend * (t - a));
    if (expected > least - 1e-9 || std::abs(t - b) < 1e-6) break;
    const double f = distance(t);
    least = std::min(least, f);
    if (t < b) {
      if (f < fb) c = b, fc = fb, b = t, fb = f;
      else a = t, fa = f;
    } else {
      if (f < fb) a = b, fa = fb, b = t, fb = f;
      else c = t, fc = f;
    }
    if (!(b > a) || !(c > b)) break;
  }
  return least;
}

double covering_height(const FingerTool& tool, const Vec3& foot, const Vec3& normal, const path::ToolMotion& m,
                       double best) {
  const double h_f = tool.gear.parameters().dedendum_mm, rho_max = tool.solid.largest_radius();
  // Closest approach of the axis to the foot point.
  const Vec3 u = path::axis_at(m, 0.5), w = foot - m.tip_from, d = m.tip_to - m.tip_from;
  const Vec3 wp = w - w.dot(u) * u, dp = d - d.dot(u) * u;
  const double d2 = dp.squaredNorm();
  // Down moves: the lower end.
  double t = d2 > 1e-16 ? std::clamp(wp.dot(dp) / d2, 0.0, 1.0) : (d.dot(u) < 0 ? 1.0 : 0.0);
  const double nearest = (wp - t * dp).norm();
  if (nearest > rho_max + 1) return best;
  // Even straight above the nearest place the cutter is higher than what is left already. The normal leans by rho/r_v
  // against the axis, which shifts the radius by less than 0.2 mm over the depth of a tooth.
  if (tool.table.floor_below(std::max(0.0, nearest - 0.2)) + h_f - 0.05 > best) return best;
  const Vec3 axis = path::axis_at(m, t), tip = path::tip_at(m, t);
  double h = 0;
  for (int k = 0; k < 12; ++k) {
    const Vec3 v = foot + h * normal - tip;
    const double s = v.dot(axis), rho = (v - s * axis).norm();
    if (rho > rho_max) return best;
    const double step = tool.solid.lower_surface(rho) - (s - h_f);
    h += step / std::max(0.2, axis.dot(normal));
    if (std::abs(step) < 1e-9) break;
  }
  return std::min(best, h);
}

}  // namespace toothpath::finger
