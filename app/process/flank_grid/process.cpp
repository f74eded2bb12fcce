#include "app/process/flank_grid/process.h"

#include <algorithm>
#include <utility>

#include "app/process/flank_grid/limits.h"
#include "app/process/milled/toothed_process.h"
#include "geometry/flank_grid/gear.h"

namespace toothpath::flank_grid {
namespace {

constexpr int kStations = 129;  // at which meridians that bend are looked at

std::string gear_words(const FlankGridGear& gear) {
  const FlankGridParameters& p = gear.parameters();
  const auto& ring = gear.space().outline();
  const auto [from, to] = ring.told(ring.s_from, ring.s_to);
  return fmt::format("gear by points, z {}, {} x {} and {} x {} points, fillet radius {:g} mm, {} {:.3f} to {:.3f} mm",
                     p.teeth, p.plus.rows, p.plus.columns, p.minus.rows, p.minus.columns, p.fillet_radius_mm,
                     ring.along, from, to);
}

sheet::DataGroup gear_data(const FlankGridGear& gear) {
  const FlankGridParameters& p = gear.parameters();
  const auto& ring = gear.space().outline();
  const double tip_from = gear.space().tip(ring.s_from), tip_to = gear.space().tip(ring.s_to);
  return {"Gear by points",
          {sheet::data_number("z", "number of teeth", p.teeth),
           sheet::data_length("m_t", "transverse module half way up the teeth, larger end", gear.module_mm()),
           {"", "points of the flanks",
            fmt::format("{} x {} and {} x {}", p.plus.rows, p.plus.columns, p.minus.rows, p.minus.columns)},
           sheet::data_length("rho_f", "radius of the ball in the fillets", p.fillet_radius_mm),
           sheet::data_length("b", "length of the teeth", ring.s_to - ring.s_from),
           sheet::data_length("d_a", fmt::format("tip diameter, {} end", ring.from),
                              2 * ring.chart.r(ring.s_from, tip_from)),
           sheet::data_length("d_a", fmt::format("tip diameter, {} end", ring.to), 2 * ring.chart.r(ring.s_to, tip_to)),
           sheet::data_length("d_f", fmt::format("root diameter, {} end", ring.from),
                              2 * ring.chart.r(ring.s_from, gear.root(ring.s_from))),
           sheet::data_length("d_f", fmt::format("root diameter, {} end", ring.to),
                              2 * ring.chart.r(ring.s_to, gear.root(ring.s_to)))}};
}

milled::ToothedGear toothed(FlankGridGear made) {
  const auto owner = std::make_shared<const FlankGridGear>(std::move(made));
  const FlankGridGear& gear = *owner;
  const FlankGridParameters& p = gear.parameters();
  const GridSpace& space = gear.space();
  const auto& ring = space.outline();
  const auto& chart = ring.chart;
  milled::ToothedGear out;
  out.part = part_of(gear);
  out.solid = drawn_solid(gear);
  out.owner = owner;
  // Over the teeth and the body behind them.
  double outer = 0, inner = INFINITY, root_low = INFINITY, root_high = -INFINITY, z_low = INFINITY, z_high = -INFINITY;
  const bool bent = !space.kernel().root.bent.straight() || !space.kernel().tip_line.straight();
  const int stations = bent ? kStations : 2;
  for (int k = 0; k < stations; ++k) {
    const double s = k + 1 < stations ? ring.s_from + (ring.s_to - ring.s_from) * k / (stations - 1) : ring.s_to;
    const double tip = space.tip(s), root = gear.root(s), z = chart.z(s, root);
    outer = std::max({outer, chart.r(s, tip), chart.r(s, root)});
    inner = std::min(inner, chart.r(s, root));
    root_low = std::min(root_low, z);
    root_high = std::max(root_high, z);
    z_low = std::min({z_low, z, chart.z(s, tip)});
    z_high = std::max({z_high, z, chart.z(s, tip)});
  }
  double low = z_low, high = z_high;
  for (const Vec2& corner : gear.body()) {
    low = std::min(low, corner.y());
    high = std::max(high, corner.y());
  }
  out.facts = {p.teeth, 2 * outer, 2 * outer, {}};
  out.body = {{outer, low, high}, {outer, 0, high, low}};
  if (chart.cosine != 0 && chart.sine != 0) out.body.rapids.roof = proof::Roof(*out.part);
  if (chart.cosine == 0) out.outline = {inner, outer, z_high, z_low, z_low, gear_words(gear), true};
  else if (chart.cosine > 0) out.outline = {inner, outer, z_high, root_low, low, gear_words(gear)};
  else out.outline = {inner, outer, z_low, root_high, high, gear_words(gear)};
  out.subtitle = fmt::format("gear by points z {}, {} x {} points a flank", p.teeth, p.plus.rows, p.plus.columns);
  out.data = {gear_data(gear)};
  out.limits_json = [owner] { return limits_json(*owner); };
  out.limit_charts = {limit_chart(gear)};
  out.ledger = point_ledger(gear);
  return out;
}

}  // namespace

process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job) {
  auto made = process::make_flank_grid_gear(job);
  if (auto* errors = made.refused()) return std::move(*errors);
  return milled::toothed_process(job, toothed(std::move(made).value()));
}

}  // namespace toothpath::flank_grid
