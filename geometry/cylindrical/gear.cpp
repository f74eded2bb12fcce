#include "geometry/cylindrical/gear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/base/refusals.h"
#include "geometry/tooth_space/limits.h"

template class toothpath::tooth_space::KernelSpace<toothpath::cylindrical::InvoluteKernel<double>>;

namespace toothpath::cylindrical {
namespace {

constexpr int kLeastTeeth = 5, kMostTeeth = 2000;
constexpr double kSameRadius = 1e-9;      // of the reference radius, between two zones
constexpr double kGrooveBelowRoot = 0.5;  // modules

/// Gathers what is wrong with a gear.
class Inspection : public Refusals {
 public:
  explicit Inspection(const CylindricalParameters& gear) : gear_(gear) {}

  void numbers() {
    integer_range("teeth", gear_.teeth, kLeastTeeth, kMostTeeth);
    range("module", gear_.module_mm, 0.05, 100, " mm");
    range("pressure_angle", degrees(gear_.pressure_angle_rad), 5, 45, " deg");
    range("profile_shift", gear_.profile_shift, -5, 5, "");
    range("addendum_coefficient", gear_.addendum_coefficient, 0.1, 3, "");
    range("dedendum_coefficient", gear_.dedendum_coefficient, 0.1, 3, "");
    range("root_radius_coefficient", gear_.root_radius_coefficient, 0, 1, "");
    range("thickness_allowance", gear_.thickness_allowance_mm, -gear_.module_mm, 0, " mm");
    range("least_land", gear_.least_land, 0, 2, "");
    if (gear_.tip_diameter_mm) positive("tip_diameter", *gear_.tip_diameter_mm);
    not_negative("bore_diameter", gear_.bore_diameter_mm);
  }

  void zone_numbers() {
    const auto& zones = gear_.zones;
    zone_count(zones.size());
    for (std::size_t k = 0; k < zones.size(); ++k) {
      const auto& z = zones[k];
      helix_angle(k, z.helix_angle_rad);
      if (!(std::abs(z.from_mm) < 1e5))
        refuse(zone_key(k, "from"), "from = {:.6g} mm is outside (-100000, 100000) mm", z.from_mm);
      if (!(z.to_mm > z.from_mm && z.to_mm < 1e5))
        refuse(zone_key(k, "to"), "to = {:.6g} mm is not above from = {:.6g} mm", z.to_mm, z.from_mm);
      if (k == 0) continue;
      if (!(z.from_mm > zones[k - 1].to_mm))
        refuse(zone_key(k, "from"),
               "from = {:.6g} mm is not above the end of zone {} at {:.6g} mm: zones rise in z, with a groove between",
               z.from_mm, k - 1, zones[k - 1].to_mm);
    }
  }

  /// Limits of the profile; the same for zones of one helix angle.
  void profile(std::size_t k, const InvoluteKernel<double>& w) {
    const auto& zone = gear_.zones[k];
    if (k > 0 && std::abs(w.r - InvoluteKernel<double>(gear_, gear_.zones[0]).r) > kSameRadius * w.r) {
      refuse(zone_key(k, "helix_angle"),
             "helix_angle = {:.6g} deg gives a reference diameter of {:.4f} mm, zone 0 with {:.6g} deg one of {:.4f} "
             "mm; they must be equal: use equal or opposite helix angles",
             degrees(zone.helix_angle_rad), 2 * w.r, degrees(gear_.zones[0].helix_angle_rad),
             2 * InvoluteKernel<double>(gear_, gear_.zones[0]).r);
      return;
    }
    if (!(w.r_f > 0)) {
      refuse("dedendum_coefficient",
             "dedendum_coefficient = {:.4f}: the root diameter is {:.4f} mm, limit 0; less than {:.4f} would do",
             gear_.dedendum_coefficient, 2 * w.r_f, gear_.dedendum_coefficient + w.r_f / w.m);
      return;
    }
    if (!(w.w_t > 0)) {
      refuse(
          "dedendum_coefficient",
          "dedendum_coefficient = {:.4f}: the tip of the basic rack is {:.4f} mm wide, limit 0; {:.4f} or less would "
          "do",
          gear_.dedendum_coefficient, 2 * w.w_t,
          std::floor(1e4 * (gear_.dedendum_coefficient + w.w_t / (w.m * std::tan(w.alpha_n)))) / 1e4);
      return;
    }
    if (w.v_c < 0)
      refuse("root_radius_coefficient",
             "root_radius_coefficient = {:.4f} exceeds {:.4f} (full-radius tip of this rack); use {:.4f} or less",
             gear_.root_radius_coefficient, largest_root_radius_coefficient(gear_, zone),
             std::floor(1e4 * largest_root_radius_coefficient(gear_, zone)) / 1e4);
    if (w.theta_f < 0) {
      refuse("profile_shift",
             "profile_shift = {:.4f} is below {:.4f}: the rack undercuts the involute of {} teeth; use {:.4f} or more",
             gear_.profile_shift, least_profile_shift(gear_, zone), gear_.teeth,
             std::ceil(1e4 * least_profile_shift(gear_, zone)) / 1e4);
      return;
    }
    tip(w);
  }

  void bodies(const InvoluteKernel<double>& w, double groove) {
    if (gear_.bore_diameter_mm > 0 && !(gear_.bore_diameter_mm < std::min(2 * w.r_f, groove)))
      refuse("bore_diameter", "bore_diameter = {:.4f} mm is not below {:.4f} mm, the {} diameter",
             gear_.bore_diameter_mm, std::min(2 * w.r_f, groove), groove < 2 * w.r_f ? "groove" : "root");
    if (!gear_.groove_diameter_mm) return;
    if (gear_.zones.size() < 2)
      refuse("groove_diameter", "groove_diameter = {:.4f} mm, but the gear has one zone: a groove lies between two",
             *gear_.groove_diameter_mm);
    else if (!(groove > 0 && groove <= 2 * w.r_f))
      refuse("groove_diameter", "groove_diameter = {:.4f} mm is outside (0, {:.4f}] mm, the root diameter", groove,
             2 * w.r_f);
  }

 private:
  void tip(const InvoluteKernel<double>& w) {
    const double form = w.r_b * std::sqrt(1 + w.theta_f * w.theta_f);
    const char* name = gear_.tip_diameter_mm ? "tip_diameter" : "addendum_coefficient";
    const std::string tip = gear_.tip_diameter_mm
                                ? fmt::format("tip_diameter = {:.4f} mm", 2 * w.r_a)
                                : fmt::format("addendum_coefficient = {:.4f}: the tip diameter {:.4f} mm",
                                              gear_.addendum_coefficient, 2 * w.r_a);
    if (!(w.r_a > form)) {
      refuse(name, "{} is not above {:.4f} mm, where the involute begins", tip, 2 * form);
      return;
    }
    const double land = 2 * w.r_a * (kPi / gear_.teeth - w.eta(w.theta_a)), least = gear_.least_land * gear_.module_mm;
    if (land >= least) return;
    const auto most = tip_diameter_of_land(w, least);
    refuse(name, "{} leaves a top land of {:.4f} mm, the least is {:.4f} mm ({:g} modules); {}", tip, land, least,
           gear_.least_land,
           most ? fmt::format("a tip_diameter of {:.4f} mm or less would do", std::floor(1e4 * *most) / 1e4)
                : std::string("no tip diameter would do: less profile_shift is needed"));
  }

  const CylindricalParameters& gear_;
};

}  // namespace

double least_profile_shift(const CylindricalParameters& gear, const CylindricalZone& zone) {
  const InvoluteKernel<double> w(gear, zone);
  const double s = std::sin(w.alpha_t);
  return gear.dedendum_coefficient - gear.root_radius_coefficient * (1 - std::sin(w.alpha_n)) -
         gear.teeth * w.m_t * s * s / (2 * w.m);
}

double largest_root_radius_coefficient(const CylindricalParameters& gear, const CylindricalZone& zone) {
  const InvoluteKernel<double> w(gear, zone);
  return w.w_t * std::cos(w.alpha_n) / (1 - std::sin(w.alpha_n)) / w.m;
}

std::optional<double> tip_diameter_of_land(const InvoluteKernel<double>& w, double land_mm) {
  const auto land = [&](double theta) {
    return 2 * w.r_b * std::sqrt(1 + theta * theta) * (kPi / w.teeth - w.eta(theta)) - land_mm;
  };
  // The land shrinks outwards, but for its arc near the base cylinder.
  double low = w.theta_f, high = w.theta_a;
  if (!(land(low) > 0)) return {};
  while (land(high) > 0) high *= 2;
  for (int k = 0; k < 100; ++k) {
    const double middle = 0.5 * (low + high);
    (land(middle) > 0 ? low : high) = middle;
  }
  return 2 * w.r_b * std::sqrt(1 + low * low);
}

Expected<CylindricalGear, std::vector<Refusal>> CylindricalGear::make(const CylindricalParameters& parameters) {
  Inspection inspection(parameters);
  inspection.numbers();
  inspection.zone_numbers();
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);
  CylindricalGear gear;
  gear.parameters_ = parameters;
  for (std::size_t k = 0; k < parameters.zones.size(); ++k) {
    const InvoluteKernel<double> kernel(parameters, parameters.zones[k]);
    inspection.profile(k, kernel);
    gear.spaces_.push_back(std::make_shared<const InvoluteSpace>(kernel));
  }
  const auto& w = gear.space(0).kernel();
  const double groove = parameters.groove_diameter_mm.value_or(
      parameters.zones.size() > 1 ? 2 * w.r_f - kGrooveBelowRoot * parameters.module_mm : 2 * w.r_f);
  if (inspection.refusals.empty()) inspection.bodies(w, groove);
  if (!inspection.refusals.empty()) return std::move(inspection.refusals);
  if (parameters.zones.size() > 1) gear.groove_diameter_mm_ = groove;
  return gear;
}

CylindricalLimits limits_of(const InvoluteSpace& space) {
  const auto& w = space.kernel();
  const double s = -0.5 * (w.z_from + w.z_to);
  CylindricalLimits out;
  out.form_diameter_mm = 2 * w.r_b * std::sqrt(1 + w.theta_f * w.theta_f);
  out.top_land_mm = 2 * w.r_a * (kPi / w.teeth - w.eta(w.theta_a));
  out.fillet_radius_min_mm = tooth_space::fillet_radius_min_mm(space, s, -1);
  out.root_ball_radius_mm = tooth_space::root_ball_radius_mm(space, s);
  const double half_way = w.theta_at(0.5 * (0.5 * out.form_diameter_mm + w.r_a));
  out.mid_flank_radius_mm = w.r_b * half_way / w.cos_bb;
  return out;
}

}  // namespace toothpath::cylindrical
