#include "app/process/spiral_bevel/process.h"

#include <cmath>
#include <utility>

#include "app/process/milled/bevel_gear.h"
#include "app/process/spiral_bevel/limits.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"
#include "geometry/spiral_bevel/gear.h"

namespace toothpath::spiral_bevel {
namespace {

const char* way_of(const SpiralBevelParameters& p) {
  if (p.cuts.size() == 1)
    return p.cuts[0].generated ? "both flanks in one generated cut" : "both flanks in one Formate cut";
  return p.cuts[0].generated ? "two generated cuts" : "two Formate cuts";
}

std::string gear_words(const SpiralBevelGear& gear) {
  const SpiralBevelParameters& p = gear.parameters();
  return fmt::format(
      "spiral bevel gear, z {}, {} hand, {}, outer transverse module {:.4f} mm, pitch angle {:.4f} deg, shaft angle "
      "{:g} deg, cone distance {:.3f} to {:.3f} mm, mean spiral angle {:.2f} deg",
      p.teeth, p.hand > 0 ? "right" : "left", way_of(p), gear.body().module_mm, degrees(p.pitch_angle_rad),
      degrees(p.shaft_angle_rad), p.outer_cone_distance_mm - p.face_width_mm, p.outer_cone_distance_mm,
      degrees(0.5 * (gear.spiral_angle(1) + gear.spiral_angle(-1))));
}

sheet::DataGroup gear_data(const SpiralBevelGear& gear) {
  const SpiralBevelParameters& p = gear.parameters();
  const double spiral = 0.5 * (gear.spiral_angle(1) + gear.spiral_angle(-1)),
               mean_module = gear.body().module_mm * p.mean_cone_distance() / p.outer_cone_distance_mm;
  sheet::DataGroup out{fmt::format("Spiral bevel gear, ISO 23509, {}", way_of(p)),
                       {sheet::data_number("z", "number of teeth", p.teeth),
                        sheet::data_length("m_et", "outer transverse module", gear.body().module_mm),
                        sheet::data_length("m_mn", "mean normal module", mean_module * std::cos(spiral)),
                        sheet::data_helix("beta_m", "mean spiral angle", p.hand * spiral, "zerol"),
                        sheet::data_angle("Sigma", "shaft angle", p.shaft_angle_rad)}};
  for (const Cut& cut : p.cuts)
    for (const Cuts side : {Cuts::concave, Cuts::convex})
      if (cut.makes(side)) {
        const Blade& blade = cut.blades[side == Cuts::concave ? 0 : 1];
        const std::string name = side == Cuts::concave ? "concave" : "convex";
        out.rows.push_back(
            sheet::data_angle("alpha", "blade angle of the " + name + " flank", blade.pressure_angle_rad));
        out.rows.push_back(sheet::data_length("r_0", "point radius of its blade", blade.point_radius_mm));
        out.rows.push_back(sheet::data_length("rho_a0", "edge radius of its blade", blade.edge_radius_mm));
      }
  for (auto& row :
       milled::bevel_blank_data(gear.space(), p.pitch_angle_rad, p.cuts.front().root_angle_rad, -gear.body().root_back))
    out.rows.push_back(std::move(row));
  out.rows.push_back(sheet::data_length("e_m", "space width on the mean pitch circle", gear.space_width_mm()));
  return out;
}

milled::ToothedGear toothed(SpiralBevelGear made) {
  const auto gear = std::make_shared<const SpiralBevelGear>(std::move(made));
  const SpiralBevelParameters& p = gear->parameters();
  milled::ToothedGear out =
      milled::bevel_gear(gear, part_of(*gear), drawn_solid(*gear), gear->body(), gear_words(*gear));
  out.subtitle = fmt::format("spiral bevel gear z {}, {} hand, outer module {} mm, {}, pitch angle {:.4f} deg", p.teeth,
                             p.hand > 0 ? "right" : "left", svg::short_number(gear->body().module_mm), way_of(p),
                             degrees(p.pitch_angle_rad));
  out.data = {gear_data(*gear)};
  const auto& ring = gear->space().outline();
  out.measured_at = {{0, 0.5 * (ring.s_from + ring.s_to), 0, "mean pitch circle"}};
  out.limits_json = [gear] { return limits_json(*gear); };
  out.limit_charts = {limit_chart(*gear)};
  return out;
}

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_spiral_bevel_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return milled::toothed_process(job, toothed(std::move(made).value()));
}

}  // namespace toothpath::spiral_bevel
