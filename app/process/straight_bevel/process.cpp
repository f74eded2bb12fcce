#include "app/process/straight_bevel/process.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/process/milled/toothed_process.h"
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

milled::ToothedGear toothed(StraightBevelGear made) {
  const auto owner = std::make_shared<const StraightBevelGear>(std::move(made));
  const StraightBevelGear& gear = *owner;
  const StraightBevelParameters& p = gear.parameters();
  const CrownSpace& space = gear.space();
  const auto& ring = space.outline();
  const auto r = [&](double s, double h) { return ring.chart.r(s, h); };
  const auto z = [&](double s, double h) { return ring.chart.z(s, h); };
  const double tip_from = space.tip(ring.s_from), tip_to = space.tip(ring.s_to),
               root = ring.s_to * std::tan(space.kernel().theta_f);
  const double outer = std::max(r(ring.s_from, tip_from), r(ring.s_to, tip_to)),
               top = std::min(z(ring.s_from, tip_from), z(ring.s_to, tip_to)), bottom = body_ends(gear)[1];
  milled::ToothedGear out;
  out.part = part_of(gear);
  out.solid = drawn_solid(gear);
  out.owner = owner;
  out.facts = {p.teeth, 2 * outer, 2 * outer, {}};
  out.body = {{outer, top, bottom}, {outer, 0, bottom, top, proof::Roof(*out.part)}};
  out.outline = {r(ring.s_to, root), outer, top, z(ring.s_from, -p.dedendum_mm), bottom, gear_words(gear)};
  out.subtitle = fmt::format("straight bevel gear z {}, outer module {} mm, {}, pitch angle {:.4f} deg", p.teeth,
                             svg::short_number(p.outer_transverse_module_mm), form_of(p), degrees(p.pitch_angle_rad));
  out.limits_json = [owner] { return limits_json(*owner); };
  out.limit_charts = {limit_chart(gear)};
  return out;
}

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_straight_bevel_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return milled::toothed_process(job, toothed(std::move(made).value()));
}

}  // namespace toothpath::straight_bevel
