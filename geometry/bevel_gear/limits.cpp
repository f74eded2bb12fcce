#include "geometry/bevel_gear/limits.h"

#include "geometry/base/angle.h"

namespace toothpath::bevel_gear {

namespace {

/// Flank error that an early end of a pass may cost, mm.
constexpr double kCuspLossLimit = 1e-3;

template <typename... Args>
void refuse(std::vector<Refusal>& list, std::string key, fmt::format_string<Args...> text, Args&&... args) {
  list.push_back({std::move(key), fail(text, std::forward<Args>(args)...)});
}

void range(std::vector<Refusal>& list, const char* key, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  const std::string name = std::string(key).substr(std::string(key).rfind('.') + 1);
  refuse(list, key, "{} = {:.6g} {} is outside {:.6g} to {:.6g}", name, value, unit, low, high);
}

}  // namespace

double bevel_pitch_angle(const BevelGearParameters& p) {
  if (p.mate_teeth == 0) return p.pitch_angle_rad;
  const double u = static_cast<double>(p.mate_teeth) / p.teeth;
  return std::atan2(std::sin(p.shaft_angle_rad), u + std::cos(p.shaft_angle_rad));
}

void check_bevel_ranges(const BevelGearParameters& p, const FingerCutterData& c, std::vector<Refusal>& list) {
  range(list, "teeth", p.teeth, 3, 2000, "");
  if (p.mate_teeth != 0) {
    range(list, "mate_teeth", p.mate_teeth, 3, 2000, "");
    range(list, "shaft_angle", degrees(p.shaft_angle_rad), 0.02, 179, "deg");
  }
  if (list.empty()) {
    const double delta = degrees(bevel_pitch_angle(p));
    if (!(delta >= 0.0099999 && delta <= 90 + 1e-12))
      refuse(list, p.mate_teeth != 0 ? "shaft_angle" : "pitch_angle",
             "the pitch angle is {:.6g} deg; it must lie between 0.01 and 90", delta);
  }
  range(list, "outer_transverse_module", p.outer_transverse_module_mm, 1e-3, 1e4, "mm");
  range(list, "pressure_angle", degrees(p.pressure_angle_rad), 5, 45, "deg");
  range(list, "outer_spiral_angle", degrees(p.outer_spiral_angle_rad), 0, 70, "deg");
  const double m = p.outer_transverse_module_mm;
  range(list, "addendum", p.addendum_mm, 1e-3 * m, 3 * m, "mm");
  range(list, "dedendum", p.dedendum_mm, 1e-3 * m, 3 * m, "mm");
  if (!(p.face_width_mm > 0)) refuse(list, "face_width", "face_width = {:.4f} must be positive", p.face_width_mm);
  if (!(p.backlash_mm >= 0)) refuse(list, "backlash", "backlash = {:.4f} must not be negative", p.backlash_mm);
  if (p.hand != 1 && p.hand != -1) refuse(list, "hand", "hand = {} must be +1 (right) or -1 (left)", p.hand);
  range(list, "tool.module", c.module_mm, 1e-3 * m, 2 * m, "mm");
  range(list, "tool.tip_radius", c.tip_radius_mm, 1e-4 * m, m, "mm");
  range(list, "tool.rack_depth", c.rack_depth_mm, 1e-3 * m, 3 * m, "mm");
  if (!(c.profile_height_mm >= p.addendum_mm))
    refuse(list, "tool.profile_height",
           "profile_height = {:.4f} is below the addendum {:.4f}: the cylinder of the cutter would cut the flank",
           c.profile_height_mm, p.addendum_mm);
}

namespace {

double largest_tip_radius_not_pointed(const FingerProfile<double>& c) {
  return c.line_radius(-c.h_f) * c.cos_phi / (1 - c.sin_phi);
}

}  // namespace

double largest_tip_radius(const FingerProfile<double>& c) {
  const double below_C = (c.x_C + c.h_f) / (1 - c.sin_phi);
  return std::min(largest_tip_radius_not_pointed(c), below_C);
}

double face_width_for_module(const BevelGear& g, double module) {
  return g.R_e() - std::cbrt(std::pow(module * g.parameters().teeth / (2 * g.sin_delta()), 2) * g.R_0());
}

double bevel_top_land(const BevelGear& g, double R) {
  const auto& p = g.parameters();
  const double k = g.kappa_v(), h = p.addendum_mm, cos_a = std::cos(p.pressure_angle_rad);
  // Normal tooth thickness on the pitch cone: the space takes 2 e_h of the pitch.
  const double cos_b = std::sqrt(R / g.R_0());
  const double s = R * g.sin_delta() * cos_b * (g.pitch() - 2 * g.e_h());
  if (k < 1e-12 / g.R_0()) return s - 2 * h * std::tan(p.pressure_angle_rad);
  // inv(alpha_a) - inv(alpha_n) of the equivalent gear, times 2 (r_v + h).
  const double alpha_a = std::atan2(std::sqrt(std::max(0.0, (1 + k * h) * (1 + k * h) - cos_a * cos_a)), cos_a);
  return (1 + k * h) * (s - 2 * tan_minus_angle_difference(alpha_a, p.pressure_angle_rad) / k);
}

namespace {

/// False, with a refusal: the face is so wide that the widest cutter that fits the small end has no tip left.
bool tip_is_left(const BevelGear& g, const BevelLimits& lim, std::vector<Refusal>& list) {
  const auto& p = g.parameters();
  const auto& d = g.cutter_data();
  const auto tip_of = [&](double module) {
    return make_finger_profile<double>(p.pressure_angle_rad, g.kappa_v(), p.dedendum_mm, module, 0.0, d.rack_depth_mm,
                                       d.profile_height_mm)
        .line_radius(-p.dedendum_mm);
  };
  if (tip_of(lim.module_limit_mm) > 0) return true;
  double low = lim.module_limit_mm, high = 4 * p.outer_transverse_module_mm;
  for (int k = 0; k < 200; ++k) {
    const double mid = 0.5 * (low + high);
    (tip_of(mid) > 0 ? high : low) = mid;
  }
  refuse(list, "face_width",
         "face_width = {:.4f} makes the cutter pointed: the space at the small end is too narrow for dedendum = "
         "{:.4f}; the largest possible face width is {:.4f}",
         p.face_width_mm, p.dedendum_mm, face_width_for_module(g, high / 0.99));
  return false;
}

void check_module(const BevelGear& g, const BevelLimits& lim, std::vector<Refusal>& list) {
  const auto& d = g.cutter_data();
  if (!(d.module_mm > lim.module_limit_mm)) return;
  const double m_i = lim.module_at_small_end_mm, over = 0.5 * kPi * (d.module_mm - m_i);
  if (over > 0)
    refuse(list, "tool.module",
           "module = {:.4f} exceeds {:.4f} (0.99 of the normal module {:.4f} at the small end): the cutter over-cuts "
           "the small end by {:.1f} um; the largest face width for it is {:.4f}",
           d.module_mm, lim.module_limit_mm, m_i, 1000 * over, lim.largest_face_width_mm);
  else
    refuse(list, "tool.module",
           "module = {:.4f} exceeds {:.4f} (0.99 of the normal module {:.4f} at the small end); the largest face width "
           "for it is {:.4f}",
           d.module_mm, lim.module_limit_mm, m_i, lim.largest_face_width_mm);
}

/// Depth, tip and corner of the profile, each by itself.
void check_form(const BevelGear& g, const FingerProfile<double>& c, const BevelLimits& lim, std::vector<Refusal>& list,
                std::vector<std::string>& warnings) {
  const auto& d = g.cutter_data();
  if (c.phi < 0)
    refuse(list, "tool.rack_depth",
           "rack_depth = {:.4f}: the straight of the cutter leans inwards ({:.4f} deg, must not be negative), so it "
           "could not be retracted along its axis",
           d.rack_depth_mm, degrees(c.phi));
  if (!(c.x_C + c.h_f > 0))
    refuse(list, "tool.rack_depth",
           "rack_depth = {:.4f}: the involute reaches {:.4f} below the pitch cone, deeper than the dedendum {:.4f}",
           d.rack_depth_mm, -c.x_C, c.h_f);
  else if (!(c.line_radius(-c.h_f) > 0))
    refuse(
        list, "tool.module",
        "module = {:.4f} makes the cutter pointed above its tip (radius {:.4f} at dedendum = {:.4f}, must be positive)",
        d.module_mm, c.line_radius(-c.h_f), c.h_f);
  else if (d.tip_radius_mm > lim.tip_radius_limit_mm)
    refuse(list, "tool.tip_radius", "tip_radius = {:.4f} exceeds {:.4f}, where {}", d.tip_radius_mm,
           lim.tip_radius_limit_mm,
           lim.tip_radius_limit_mm < largest_tip_radius_not_pointed(c) ? "the corner arc reaches the involute"
                                                                       : "the cutter gets pointed");
  if (c.base_circle_clips_C)
    warnings.push_back(
        fmt::format("point C of the cutter sits on the base circle: rack_depth = {:.4f} is not reached, only {:.4f}",
                    d.rack_depth_mm, -c.x_C));
}

void check_top_land(const BevelGear& g, const BevelLimits& lim, std::vector<Refusal>& list) {
  const auto& p = g.parameters();
  const double land = lim.top_land_mm;
  if (land >= 0) return;
  // The land shrinks by (r_v + h_a)/r_v * R cos(beta)/(2 R_e) per mm of backlash.
  const double per_mm = (1 + g.kappa_v() * p.addendum_mm) * g.R_i() * std::sqrt(g.R_i() / g.R_0()) / (2 * g.R_e());
  const double limit = p.backlash_mm + land / per_mm;
  if (limit > 0)
    refuse(list, "backlash", "backlash = {:.4f} eats the top land at the small end ({:.4f}); it must be below {:.4f}",
           p.backlash_mm, land, limit);
  else
    refuse(list, "addendum",
           "addendum = {:.4f}: the tooth is pointed at the small end (top land {:.4f}, must be positive)",
           p.addendum_mm, land);
}

}  // namespace

void check_bevel_cutter(const BevelGear& g, const FingerProfile<double>& c, BevelLimits& lim,
                        std::vector<Refusal>& list, std::vector<std::string>& warnings) {
  const double m_i = g.normal_module(g.R_i());
  lim.module_at_small_end_mm = m_i;
  lim.module_limit_mm = 0.99 * m_i;
  lim.space_width_mm = 2 * g.R_i() * g.e_h() * g.sin_delta() * std::sqrt(g.R_i() / g.R_0());
  lim.top_land_mm = bevel_top_land(g, g.R_i());
  lim.tip_flat_mm = c.rho_o;
  lim.line_angle_rad = c.phi;
  lim.tip_radius_limit_mm = largest_tip_radius(c);
  lim.largest_face_width_mm = face_width_for_module(g, g.cutter_data().module_mm / 0.99);

  if (!tip_is_left(g, lim, list)) return;
  check_module(g, lim, list);
  check_form(g, c, lim, list, warnings);
  check_top_land(g, lim, list);
}

void warn_of_thin_tips(const BevelLimits& lim, std::vector<std::string>& warnings) {
  if (lim.top_land_mm < 0.2 * lim.module_at_small_end_mm)
    warnings.push_back(fmt::format("top land at the small end is {:.4f} mm, below 0.2 of the normal module {:.4f}",
                                   lim.top_land_mm, lim.module_at_small_end_mm));
}

void check_bevel_cusp(const BevelGear& g, std::vector<Refusal>& list, std::vector<std::string>& warnings) {
  const double loss = g.limits().cusp_loss_mm;
  if (loss <= 0) return;
  const double r_0 = g.cutter().r_0;
  // R_e <= R_lim: R_e = R_0 cos^2(beta_e), so sin(beta_e) >= 0.6 r_0 / R_0.
  const double least = degrees(std::asin(std::min(1.0, 0.6 * r_0 / g.R_0())));
  if (loss > kCuspLossLimit)
    refuse(list, "outer_spiral_angle",
           "outer_spiral_angle = {:.4f} puts the cusp of the cutter path inside the face (flank error {:.2f} um, limit "
           "{:.2f}); it must be at least {:.4f}",
           degrees(g.parameters().outer_spiral_angle_rad), 1000 * loss, 1000 * kCuspLossLimit, least);
  else
    warnings.push_back(fmt::format(
        "the cutter path leaves the trace at {:.4f} mm, before its cusp; flank error up to {:.2f} um at the large end",
        g.halves().back().walls[0].trace.R_lim(), 1000 * loss));
}

}  // namespace toothpath::bevel_gear
