// The refusals of gears, each by another calculation: closed forms, and the solid shaper or finger mill swept past
// points.
#pragma once

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>

#include "app/job/job.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "tests/support/brute_force_bevel_gear.h"
#include "tests/support/brute_force_face_gear.h"

namespace toothpath::test {

/// Radius of a full round tip: its centre lies on the middle of the shaper's tooth, as far from the involute as from
/// the tip circle.
inline double full_round_tip(const face_gear::FaceGearParameters& p) {
  const double n = p.shaper_teeth, pitch = 0.5 * p.module_mm * n, base = pitch * std::cos(p.pressure_angle_rad),
               tip = pitch + (p.addendum_coefficient + p.clearance_coefficient) * p.module_mm;
  const auto involute = [](double angle) { return std::tan(angle) - angle; };
  double low = 0, high = tip - base;
  for (int k = 0; k < 100; ++k) {
    const double rho = 0.5 * (low + high);
    const double room =
        kPi / (2 * n) + involute(p.pressure_angle_rad) - involute(std::acos(base / (tip - rho))) - rho / base;
    (room > 0 ? low : high) = rho;
  }
  return low;
}

class FaceRefusals {
 public:
  explicit FaceRefusals(const face_gear::FaceGearParameters& p) : p_(p) {}

  /// Is what the message says true? Messages of other kinds are not.
  [[nodiscard]] bool confirm(const std::string& message) const {
    const auto number = [&](const char* pattern) {
      std::smatch found;
      return std::regex_search(message, found, std::regex(pattern)) ? std::stod(found[1]) : NAN;
    };
    if (const double limit = number("the full round tip has ([0-9.]+) mm"); !std::isnan(limit))
      return p_.shaper_tip_radius_mm > limit && std::abs(full_round_tip(p_) - limit) < 1e-4;
    const double inner = number("inner_radius = ([0-9.]+) mm"), outer = number("outer_radius = ([0-9.]+) mm");
    if (const double limit = number("the gear's base radius ([0-9.]+) mm"); !std::isnan(limit))
      return inner <= limit && std::abs(base_radius(zone_with(inner, true)) - limit) < 1e-4;
    if (message.find("lies inside the undercut limit") != std::string::npos)
      return undercut(zone_with(inner, true), int(number("flank side ([+-]1)")));
    if (message.find("exceeds the pointing limit") != std::string::npos) return pointed(zone_with(outer, false));
    return false;
  }

 private:
  [[nodiscard]] const face_gear::FaceGearZone& zone_with(double radius, bool inner) const {
    const face_gear::FaceGearZone* nearest = &p_.zones.front();
    const auto off = [&](const face_gear::FaceGearZone& z) {
      return std::abs((inner ? z.inner_radius_mm : z.outer_radius_mm) - radius);
    };
    for (const auto& zone : p_.zones)
      if (off(zone) < off(*nearest)) nearest = &zone;
    return *nearest;
  }
  /// A normal of the involute has the moment r_b cos(base helix) about the shaper's axis, and N_2 / N_s of it about the
  /// gear's; no unit vector has more than its distance.
  [[nodiscard]] double base_radius(const face_gear::FaceGearZone& zone) const {
    const double base = 0.5 * p_.module_mm * p_.shaper_teeth * std::cos(p_.pressure_angle_rad);
    return base * BruteForceFaceGear(p_, zone.helix_angle_rad).cos_base_helix() * p_.teeth / p_.shaper_teeth;
  }
  /// The fillet as it would begin at the inner radius is cut away by the shaper in another position, or there is none.
  [[nodiscard]] bool undercut(const face_gear::FaceGearZone& zone, int side) const {
    const auto surface = face_gear::make_surface<double>(p_, zone.helix_angle_rad);
    const BruteForceFaceGear sweep(p_, zone.helix_angle_rad);
    const double start = surface.shaper.A_t + 1e-9;
    for (const auto& flank : face_gear::zone_limits(surface, p_.module_mm).flanks) {
      if (flank.side != side || !flank.undercut_radius) continue;
      const double cusp = surface.flank_Z(side, surface.shaper.theta_t, *flank.undercut_B);
      const double below = zone.inner_radius_mm - *flank.undercut_radius;
      const auto z = face_gear::fillet_Z_at_radius(surface, side, start, zone.inner_radius_mm, cusp + below);
      return !z || sweep.least_clearance(surface.fillet(side, start, *z).p) < -1e-7;
    }
    return false;
  }
  /// No place of the tip surface at the outer radius is left.
  [[nodiscard]] bool pointed(const face_gear::FaceGearZone& zone) const {
    const auto surface = face_gear::make_surface<double>(p_, zone.helix_angle_rad);
    const BruteForceFaceGear sweep(p_, zone.helix_angle_rad);
    const double r = zone.outer_radius_mm;
    for (int k = 0; k < 400; ++k) {
      const double azimuth = surface.pitch * k / 400;
      if (sweep.least_clearance({r * std::cos(azimuth), r * std::sin(azimuth), surface.z_tip(r)}) > 0) return false;
    }
    return true;
  }

  const face_gear::FaceGearParameters& p_;
};

inline FingerMill mill_of(const tool::ToolAssembly& t) {
  return {t.module_mm, t.tip_radius_mm, t.rack_depth_mm, t.profile_height_mm};
}

inline bool confirms_bevel(const std::string& message, const bevel_gear::BevelGearParameters& p,
                           const FingerMill& mill) {
  const BruteForceBevelGear gear(p, mill);
  std::smatch m;
  const auto says = [&](const char* pattern) { return std::regex_search(message, m, std::regex(pattern)); };
  const auto is = [&](std::size_t group, double value) {
    return std::abs(std::stod(m[group]) - value) < 2e-4 * (1 + value);
  };
  if (says("relief_half_width = ([0-9.]+) is below ([0-9.]+), the reach of the corner fillet"))
    return is(2, gear.corner_reach()) && p.relief_half_width_mm < gear.corner_reach();
  if (says("leaves a half narrower than ([0-9.]+), twice the reach")) {
    const double half = std::min(p.apex_cone_distance_mm - gear.inner(), gear.outer() - p.apex_cone_distance_mm);
    return is(1, 2 * gear.corner_reach()) && half < 2 * gear.corner_reach();
  }
  if (says("face_width = ([0-9.]+) is below ([0-9.]+), four times the reach"))
    return is(2, 4 * gear.corner_reach()) && p.face_width_mm < 4 * gear.corner_reach();
  if (says(R"(module = ([0-9.]+) exceeds ([0-9.]+) \(0.99 of the normal module)"))
    return is(2, 0.99 * gear.normal_module(gear.inner())) && mill.module > 0.99 * gear.normal_module(gear.inner());
  if (says("tip_radius = ([0-9.]+) exceeds ([0-9.]+), where (the cutter gets pointed)?")) {
    const double largest = gear.mill().largest_tip_radii()[m[3].matched ? 0 : 1];
    return is(2, largest) && mill.tip_radius > largest;
  }
  return false;
}

/// Is what a message says about the gear of a job true? Messages of other kinds are not.
inline bool refused_for_a_reason(const std::string& message, const job::Job& job) {
  if (const auto* gear = job.face_gear()) return FaceRefusals(*gear).confirm(message);
  return confirms_bevel(message, *job.bevel_gear(), mill_of(job.tools.front()));
}

}  // namespace toothpath::test
