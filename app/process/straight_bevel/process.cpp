#include "app/process/straight_bevel/process.h"

#include <utility>

#include "app/process/milled/bevel_gear.h"
#include "app/process/straight_bevel/limits.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"
#include "geometry/straight_bevel/gear.h"

namespace toothpath::straight_bevel {
namespace {

const char* form_of(const StraightBevelParameters& p) {
  return p.form == Form::octoid ? "octoid" : "spherical involute";
}

std::string gear_words(const StraightBevelGear& gear) {
  const StraightBevelParameters& p = gear.parameters();
  const auto& w = gear.space().kernel();
  return fmt::format(
      "straight bevel gear, z {}, outer transverse module {:g} mm, pressure angle {:g} deg, {}, pitch angle {:.4f} "
      "deg, "
      "cone distance {:.3f} to {:.3f} mm",
      p.teeth, p.outer_transverse_module_mm, degrees(p.pressure_angle_rad), form_of(p), degrees(p.pitch_angle_rad),
      w.R_i, w.R_e);
}

sheet::DataGroup gear_data(const StraightBevelGear& gear) {
  const StraightBevelParameters& p = gear.parameters();
  sheet::DataGroup out{fmt::format("Straight bevel gear, ISO 23509, {}", form_of(p)),
                       {sheet::data_number("z", "number of teeth", p.teeth),
                        sheet::data_length("m_et", "outer transverse module", p.outer_transverse_module_mm),
                        sheet::data_angle("alpha_n", "pressure angle of the crown gear", p.pressure_angle_rad),
                        sheet::data_number("x_sm", "thickness modification coefficient", p.thickness_shift),
                        sheet::data_length("j_et", "backlash of the pair on the outer pitch circle", p.backlash_mm),
                        sheet::data_length("rho_e", "fillet radius of the crown gear, outer end", p.fillet_radius_mm)}};
  for (auto& row : milled::bevel_blank_data(gear.space(), p.pitch_angle_rad, gear.root_angle(), p.dedendum_mm))
    out.rows.push_back(std::move(row));
  return out;
}

milled::ToothedGear toothed(StraightBevelGear made) {
  const auto gear = std::make_shared<const StraightBevelGear>(std::move(made));
  const StraightBevelParameters& p = gear->parameters();
  milled::ToothedGear out =
      milled::bevel_gear(gear, part_of(*gear), drawn_solid(*gear), gear->body(), gear_words(*gear));
  out.least_land_mm = p.least_land * p.outer_transverse_module_mm;
  out.subtitle = fmt::format("straight bevel gear z {}, outer module {} mm, {}, pitch angle {:.4f} deg", p.teeth,
                             svg::short_number(p.outer_transverse_module_mm), form_of(p), degrees(p.pitch_angle_rad));
  out.data = {gear_data(*gear)};
  const auto& ring = gear->space().outline();
  out.measured_at = {{0, ring.s_from, 0, "outer pitch circle"},
                     {0, 0.5 * (ring.s_from + ring.s_to), 0, "mean pitch circle"}};
  out.limits_json = [gear] { return limits_json(*gear); };
  out.limit_charts = {limit_chart(*gear)};
  return out;
}

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_straight_bevel_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return milled::toothed_process(job, toothed(std::move(made).value()));
}

}  // namespace toothpath::straight_bevel
