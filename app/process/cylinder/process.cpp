#include "app/process/cylinder/process.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/process/cylinder/limits.h"
#include "app/process/milled/toothed_process.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"
#include "geometry/cylindrical/span.h"

namespace toothpath::cylinder {
namespace {

using cylindrical::CylindricalGear;
using cylindrical::CylindricalParameters;

std::string gear_words(const CylindricalGear& gear) {
  const CylindricalParameters& p = gear.parameters();
  std::string text = fmt::format(
      "cylindrical gear, z {}, {} module {:g} mm, pressure angle {:g} deg, "
      "profile shift {:g}, tip diameter {:.3f} mm",
      p.teeth, p.module_plane == ModulePlane::normal ? "normal" : "transverse", p.module_mm,
      degrees(p.pressure_angle_rad), p.profile_shift, gear.tip_diameter());
  for (const auto& zone : p.zones)
    text += fmt::format(
        "; z {:g} to {:g} mm, {}", zone.from_mm, zone.to_mm,
        zone.helix_angle_rad == 0 ? std::string("spur") : fmt::format("helix {:g} deg", degrees(zone.helix_angle_rad)));
  return text;
}

std::vector<sheet::DataGroup> gear_data(const CylindricalGear& gear) {
  using sheet::data_angle, sheet::data_length, sheet::data_number;
  const CylindricalParameters& p = gear.parameters();
  const auto& w = gear.space(0).kernel();
  sheet::DataGroup whole{
      "Cylindrical gear, ISO 21771",
      {data_number("z", "number of teeth", p.teeth), data_length("m_n", "normal module", w.m_n),
       data_angle("alpha_n", "normal pressure angle", w.alpha_n),
       data_number("x",
                   p.module_plane == ModulePlane::normal ? "profile shift coefficient"
                                                         : "profile shift coefficient, of the transverse module",
                   p.profile_shift),
       data_length("m_t", "transverse module", w.m_t), data_angle("alpha_t", "transverse pressure angle", w.alpha_t),
       data_length("d", "reference diameter", 2 * w.r), data_length("d_b", "base diameter", 2 * w.r_b),
       data_length("d_a", "tip diameter", gear.tip_diameter()),
       data_length("d_f", "root diameter", gear.root_diameter()),
       data_length("d_Ff", "root form diameter", cylindrical::limits_of(gear.space(0)).form_diameter_mm),
       data_length("h", "tooth depth", 0.5 * (gear.tip_diameter() - gear.root_diameter())),
       data_length("rho_fP", "root radius of the basic rack", w.rho), data_length("p_n", "normal pitch", kPi * w.m_n),
       data_length("p_bt", "transverse base pitch", kTwoPi * w.r_b / p.teeth),
       data_length("A_s", "thickness allowance", p.thickness_allowance_mm),
       data_length("s_n", "normal tooth thickness on the reference circle",
                   2 * w.r * (kPi / p.teeth - w.eta(w.theta_at(w.r))) * w.cos_b)}};
  std::vector<sheet::DataGroup> out{std::move(whole)};
  for (int zone = 0; zone < gear.zones(); ++zone) {
    const auto& k = gear.space(zone).kernel();
    const double beta = std::atan2(k.sin_b, k.cos_b), b = k.z_to - k.z_from;
    const cylindrical::Span span = cylindrical::usual_span(k);
    sheet::DataGroup ring{gear.zones() > 1 ? fmt::format("Zone {}", zone) : std::string("Ring of teeth"),
                          {data_length("Z", "lower end along the gear axis", k.z_from),
                           data_length("Z", "upper end along the gear axis", k.z_to), data_length("b", "face width", b),
                           sheet::data_helix("beta", "helix angle", beta),
                           data_angle("beta_b", "base helix angle", std::atan2(std::abs(k.sin_bb), k.cos_bb)),
                           data_number("k", "teeth spanned", span.teeth)}};
    if (beta != 0) ring.rows.push_back(data_length("p_z", "lead", kTwoPi / std::abs(k.kappa)));
    if (b > span.least_face_mm)
      ring.rows.push_back(data_length("W_k", "base tangent length over k teeth", span.length_mm));
    else
      ring.rows.push_back({"W_k", "base tangent length over k teeth",
                           fmt::format("the face is too narrow: {:.4f} mm need a face of {:.4f} mm", span.length_mm,
                                       span.least_face_mm)});
    out.push_back(std::move(ring));
  }
  return out;
}

double lower_end(const CylindricalGear& gear) { return gear.parameters().zones.front().from_mm; }
double upper_end(const CylindricalGear& gear) { return gear.parameters().zones.back().to_mm; }

/// Links and rapids keep clear of the blank: a cylinder, its bore closed.
milled::GearBody body_of(const CylindricalGear& gear) {
  const double r = 0.5 * gear.tip_diameter();
  return {{r, lower_end(gear), upper_end(gear)}, {r, 0, upper_end(gear), lower_end(gear)}};
}

const char* kind_of(const CylindricalParameters& p) {
  if (p.zones.size() > 1) return "double helical";
  return p.zones.front().helix_angle_rad == 0 ? "spur" : "helical";
}

milled::ToothedGear toothed(CylindricalGear made) {
  const auto owner = std::make_shared<const CylindricalGear>(std::move(made));
  const CylindricalGear& gear = *owner;
  const CylindricalParameters& p = gear.parameters();
  milled::ToothedGear out;
  out.part = cylindrical::part_of(gear);
  out.solid = drawn_solid(gear);
  out.owner = owner;
  out.facts = {p.teeth, gear.tip_diameter(), gear.tip_diameter(), {}};
  out.least_land_mm = p.least_land * p.module_mm;
  out.body = body_of(gear);
  out.outline = {0.5 * gear.root_diameter(),
                 0.5 * gear.tip_diameter(),
                 upper_end(gear),
                 lower_end(gear),
                 lower_end(gear),
                 gear_words(gear)};
  out.outline.around = true;
  out.subtitle =
      fmt::format("cylindrical gear z {}, module {} mm, {}", p.teeth, svg::short_number(p.module_mm), kind_of(p));
  out.data = gear_data(gear);
  for (int zone = 0; zone < gear.zones(); ++zone) {
    const auto& k = gear.space(zone).kernel();
    out.measured_at.push_back({zone, -0.5 * (k.z_from + k.z_to), k.r, "reference circle, middle of the face"});
  }
  out.limits_json = [owner] { return limits_json(*owner); };
  out.limit_charts = limit_charts(gear);
  return out;
}

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_cylindrical_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return milled::toothed_process(job, toothed(std::move(made).value()));
}

}  // namespace toothpath::cylinder
