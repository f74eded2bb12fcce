// Extreme face gears of the documentation, in double and in 50 digits.
#include <algorithm>
#include <cmath>
#include <limits>

#include "app/studies/stability_exact.h"
#include "app/studies/stability_rows.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/gear.h"
#include "geometry/face_gear/swept_solid.h"

namespace toothpath::studies {
namespace {

constexpr double kSweptPerModule = 1e-9;  // what the minimum over a sampled roll angle can resolve

struct GearCase {
  const char* name;
  int shaper_teeth, teeth;
  double module_mm, alpha_deg, beta_deg = 0, offset_mm = 0, gamma_deg = 90, addendum = 1;
  bool transverse = false;

  [[nodiscard]] face_gear::FaceGearParameters parameters() const {
    face_gear::FaceGearParameters g;
    g.shaper_teeth = shaper_teeth;
    g.teeth = teeth;
    g.module_mm = module_mm;
    g.module_plane = transverse ? face_gear::ModulePlane::transverse : face_gear::ModulePlane::normal;
    g.pressure_angle_rad = radians(alpha_deg);
    g.addendum_coefficient = addendum;
    g.shaft_angle_rad = radians(gamma_deg);
    g.offset_mm = offset_mm;
    return g;
  }
};

constexpr GearCase kOffsetGear{"25/88 m3, E 15", 25, 88, 3, 20, 0, 15};
constexpr GearCase kCases[] = {
    {"25/88 m3 spur", 25, 88, 3, 20},
    {"helix 1e-6 deg", 25, 88, 3, 20, 1e-6},
    {"helix 1e-10 deg", 25, 88, 3, 20, 1e-10},
    {"helix 45 deg, 20/100 m2", 20, 100, 2, 20, 45},
    {"10/30 m2", 10, 30, 2, 20},
    {"10/30 m2, 25 deg, low", 10, 30, 2, 25, 0, 0, 90, 0.6},
    {"60/720 m1, helix 20", 60, 720, 1, 20, 20},
    {"60/180 m1", 60, 180, 1, 20},
    {"m0.2, 18/72, 25 deg", 18, 72, 0.2, 25},
    {"m30, 16/96, helix 10", 16, 96, 30, 20, 10},
    {"14.5 deg, 30/150 m2", 30, 150, 2, 14.5},
    {"25 deg, helix 25, 14/42 m4", 14, 42, 4, 25, 25},
    {"25/88 m3, E 45", 25, 88, 3, 20, 0, 45},
    {"25/88 m3, E -45", 25, 88, 3, 20, 0, -45},
    {"25/88 m3, E 90", 25, 88, 3, 20, 0, 90},
    {"25/88 m3, shaft 60 deg", 25, 88, 3, 20, 0, 0, 60},
    {"25/88 m3, shaft 120 deg", 25, 88, 3, 20, 0, 0, 120},
    {"22/75 m2, helix 15, shaft 75, E 6", 22, 75, 2, 25, 15, 6, 75},
    {"28/112 m2.5, helix -20, shaft 110, E -10", 28, 112, 2.5, 20, -20, -10, 110},
    {"30/180 m5 transverse, helix 30", 30, 180, 5, 20, 30, 0, 90, 1, true},
    {"30/180 m5 normal, helix 30", 30, 180, 5, 20, 30},
    kOffsetGear,
};

double mixed(double a, double b, double t) { return a + t * (b - a); }

/// Flanks of both sides between R1 and R2', fillet line and tip surface.
StabilityRow flank_row(const GearCase& c, const face_gear::FaceGearSurface<double>& f,
                       const face_gear::ZoneLimits& limits, const ExactFaceGear& exact) {
  constexpr int kRadii = 7, kHeights = 5;
  StabilityRow row{"face gear flank", c.name};
  const double hair = 1e-3 * c.module_mm;
  row.limit_mm = kRounding * kEps * *limits.land_radius;
  for (int n = 0; n < kRadii; ++n) {
    const double r = mixed(limits.inner_limit + hair, *limits.land_radius, double(n) / (kRadii - 1)), top = f.z_tip(r);
    for (const int side : {1, -1}) {
      const auto low = face_gear::fillet_line_height(f, side, r);
      if (!low) {
        row.error_mm = NAN, row.reason = fmt::format("no fillet line at r = {:.4f}, side {:+d}", r, side);
        continue;
      }
      for (int k = 0; k < kHeights; ++k) {
        const double z = mixed(*low + hair, top, double(k) / (kHeights - 1));
        const auto at = face_gear::invert_flank(f, side, r, z);
        const auto from_position = at ? exact.inverse(f, side, r, z, *at) : std::nullopt;
        if (!from_position || !(from_position->J > 0) || from_position->theta < -1e-9) {
          row.error_mm = NAN,
          row.reason = fmt::format("no flank point at r = {:.4f}, z = {:.4f}, side {:+d}", r, z, side);
          continue;
        }
        const auto closed = exact.kernel(f, side, at->theta, at->B);
        row.error_mm =
            std::max({row.error_mm, closed.position_mm, from_position->position_mm, closed.normal * c.module_mm});
        row.condition = std::max(row.condition, from_position->condition);
        row.iterations = std::max(row.iterations, at->iterations);
        row.swept_mm =
            std::max(row.swept_mm, std::abs(face_gear::swept_clearance(f, f.flank(side, at->theta, at->B).p)));
        ++row.points;
      }
    }
  }
  judge(row, kSweptPerModule * c.module_mm);
  return row;
}

/// Fillets with a rounding of 0.4 of the largest, from a start that no neighbour gave.
StabilityRow fillet_row(const GearCase& c) {
  auto g = c.parameters();
  g.shaper_tip_radius_mm = 0.4 * largest_tip_radius(g, radians(c.beta_deg));
  const auto f = face_gear::make_surface<double>(g, radians(c.beta_deg));
  const auto limits = face_gear::zone_limits(f, c.module_mm);
  const ExactFaceGear exact(g, radians(c.beta_deg));
  StabilityRow row{"face gear fillet", c.name};
  row.limit_mm = kRounding * kEps * *limits.land_radius;
  for (const double t : {0.001, 0.1, 0.5, 1.0}) {
    const double r = mixed(limits.hard_inner_limit, *limits.land_radius, t);
    const double start = (std::sqrt(r * r - f.E * f.E) + f.shaper.r_a * f.Cg) / f.Sg;
    for (const int side : {1, -1})
      for (const double u : {0.01, 0.3, 0.6, 0.99}) {
        const double A = mixed(f.shaper.A_t, f.shaper.A_e, u);
        const auto Z = face_gear::fillet_Z_at_radius(f, side, A, r, start);
        const auto compared = Z ? exact.fillet(f, side, A, r, *Z) : std::nullopt;
        if (!compared) {
          row.error_mm = NAN, row.reason = fmt::format("no fillet point at r = {:.4f}, side {:+d}", r, side);
          continue;
        }
        row.error_mm = std::max(row.error_mm, compared->position_mm);
        row.swept_mm = std::max(row.swept_mm, std::abs(face_gear::swept_clearance(f, f.fillet(side, A, *Z).p)));
        ++row.points;
      }
  }
  judge(row, kSweptPerModule * c.module_mm);
  return row;
}

std::optional<face_gear::FlankCoordinates> on_tip(const face_gear::FaceGearSurface<double>& f, int side, double r) {
  return face_gear::invert_flank(f, side, r, f.z_tip(r));
}

/// R1c, R2 and R2' as radii.
StabilityRow limits_row(const GearCase& c, const face_gear::FaceGearSurface<double>& f,
                        const face_gear::ZoneLimits& limits, const ExactFaceGear& exact) {
  StabilityRow row{"face gear limits", c.name};
  row.limit_mm = 1e-9;  // as documented for the limits
  const auto note = [&](const std::optional<double>& error, const char* what) {
    if (!error || !std::isfinite(*error))
      row.error_mm = NAN, row.reason = fmt::format("{} has no counterpart in 50 digits", what);
    else row.error_mm = std::max(row.error_mm, std::abs(*error));
    ++row.points;
  };
  for (const auto& flank : limits.flanks)
    if (flank.undercut_radius) note(exact.undercut_error(flank.side, *flank.undercut_B, *flank.undercut_radius), "R1c");
  for (const auto& [radius, land] :
       {std::pair{limits.pointing_radius, 0.0}, {limits.land_radius, limits.practical_land_mm}}) {
    if (!radius) continue;
    const auto plus = on_tip(f, 1, *radius), minus = on_tip(f, -1, *radius);
    if (!plus || !minus) {
      note({}, "a flank on the tip surface");
      continue;
    }
    const double step = 1e-3 * c.module_mm;
    const auto here = exact.land_minus(*radius, land, *plus, *minus),
               inside = exact.land_minus(*radius - step, land, *plus, *minus);
    if (!here || !inside) note({}, "the top land");
    else note(*here / ((*inside - *here) / step), "the top land");
  }
  judge(row, 0);
  return row;
}

/// Is the gear accepted between its limits?
StabilityRow accepted_row(const GearCase& c, const face_gear::ZoneLimits& limits) {
  StabilityRow row{"face gear accepted", c.name};
  auto g = c.parameters();
  g.zones = {{radians(c.beta_deg), limits.inner_limit + 1e-3 * c.module_mm, *limits.land_radius}};
  const auto made = face_gear::FaceGear::make(g);
  const auto* refusals = made.refused();
  judge_refusal(row, Expected::accept, refusals ? refusals->front().diagnostic.message : "");
  return row;
}

/// Towards the cusp of the offset gear the parameters become uncertain; the position must not.
void near_undercut(std::vector<StabilityRow>& rows) {
  const auto g = kOffsetGear.parameters();
  const auto f = face_gear::make_surface<double>(g, 0);
  const auto limits = face_gear::zone_limits(f, 3);
  const auto& flank = limits.flanks[1];
  const ExactFaceGear exact(g, 0);
  for (const double distance : {1e-1, 1e-3, 1e-6, 1e-9}) {
    StabilityRow row{"near undercut", fmt::format("R1c + {:g} mm", distance)};
    const double r = *flank.undercut_radius + distance;
    row.limit_mm = kRounding * kEps * r;
    const auto B = face_gear::flank_B_at_radius(f, -1, f.shaper.theta_t, r, *flank.undercut_B - 0.02);
    const double z = B ? f.flank_housing(-1, f.shaper.theta_t, *B).z() : NAN;
    if (const auto at = face_gear::invert_flank(f, -1, r, z)) {
      const auto closed = exact.kernel(f, -1, f.shaper.theta_t, *B);
      row.error_mm = std::max(
          {closed.position_mm, exact.kernel(f, -1, at->theta, at->B).position_mm, exact.residual_mm(-1, r, z, *at)});
      row.condition = closed.condition;
      row.iterations = at->iterations;
      row.points = 1;
      row.reason = fmt::format("J = {:.2e} mm2", closed.J);
    } else {
      row.error_mm = NAN;
      row.reason = "no flank point";
    }
    judge(row, 0);
    rows.push_back(row);
  }
}

void near_pointing(std::vector<StabilityRow>& rows) {
  const auto g = kOffsetGear.parameters();
  const auto f = face_gear::make_surface<double>(g, 0);
  const ExactFaceGear exact(g, 0);
  const double R2 = face_gear::zone_limits(f, 3).pointing_radius.value_or(NAN);
  for (const double distance : {1e-3, 1e-6, 1e-9}) {
    StabilityRow row{"near pointing", fmt::format("R2 - {:g} mm", distance)};
    const double r = R2 - distance;
    row.limit_mm = kRounding * kEps * r;
    const auto land = face_gear::tip_thickness(f, r);
    const auto plus = on_tip(f, 1, r), minus = on_tip(f, -1, r);
    const auto error = land && plus && minus ? exact.land_minus(r, *land, *plus, *minus) : std::nullopt;
    row.error_mm = error ? std::abs(*error) : NAN;
    row.iterations = plus && minus ? std::max(plus->iterations, minus->iterations) : 0;
    row.points = 1;
    if (land) row.reason = fmt::format("land {:.4e} mm", *land);
    judge(row, 0);
    rows.push_back(row);
  }
}

/// Gears without an answer: refused with quantity, value and limit, never NaN.
void refused(std::vector<StabilityRow>& rows) {
  struct Bad {
    const char* name;
    GearCase gear;
    double tip_radius, inner, outer;
  };
  const Bad list[] = {
      {"inside the undercut", kOffsetGear, 0, 129, 147},
      {"beyond pointing", kOffsetGear, 0, 130, 152},
      {"inside the base cylinder", kOffsetGear, 0, 124, 147},
      {"pointed shaper of few teeth", {"", 10, 30, 2, 20, 0, 0, 90, 1.3}, 0, 34, 36},
      {"pointed shaper", {"", 25, 88, 3, 20, 0, 15, 90, 1.9}, 0, 130, 147},
      {"rounding too large", kOffsetGear, 1.3, 130, 147},
      {"offset beyond the face", {"", 25, 88, 3, 20, 0, 140}, 0, 130, 147},
      {"undercut that runs outwards",
       {"", 54, 107, 1.30447, 19.8215, -43.8004, 12.6251, 103.368, 0.847233, true},
       0.307558,
       86.748,
       88.7},
      {"fillet up to the tip, outside", {"", 58, 527, 4, 14.3, 41.9, 322.9, 84.5, 0.335, true}, 2.387, 860, 930},
      {"module nan", {"", 25, 88, NAN, 20}, 0, 130, 147},
  };
  for (const Bad& bad : list) {
    StabilityRow row{"face gear refused", bad.name};
    auto g = bad.gear.parameters();
    g.shaper_tip_radius_mm = bad.tip_radius;
    g.zones = {{radians(bad.gear.beta_deg), bad.inner, bad.outer}};
    const auto made = face_gear::FaceGear::make(g);
    const auto* refusals = made.refused();
    judge_refusal(row, Expected::refuse, refusals ? refusals->front().diagnostic.message : "");
    rows.push_back(row);
  }
}

}  // namespace

std::vector<StabilityRow> face_gear_rows() {
  std::vector<StabilityRow> rows;
  for (const GearCase& c : kCases) {
    const double beta = radians(c.beta_deg);
    const auto g = c.parameters();
    const auto f = face_gear::make_surface<double>(g, beta);
    const auto limits = face_gear::zone_limits(f, c.module_mm);
    if (!limits.land_radius || !limits.pointing_radius || *limits.land_radius <= limits.inner_limit) {
      StabilityRow row{"face gear flank", c.name};
      judge_refusal(row, Expected::accept, "no band between the limits");
      rows.push_back(row);
      continue;
    }
    const ExactFaceGear exact(g, beta);
    rows.push_back(flank_row(c, f, limits, exact));
    rows.push_back(fillet_row(c));
    rows.push_back(limits_row(c, f, limits, exact));
    rows.push_back(accepted_row(c, limits));
  }
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.group < b.group; });
  near_undercut(rows);
  near_pointing(rows);
  refused(rows);
  return rows;
}

}  // namespace toothpath::studies
