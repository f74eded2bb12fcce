#include "app/studies/trials/dhfg_loaded.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/studies/trials/dhfg_trial.h"
#include "geometry/loaded/friction.h"

namespace toothpath::trials {
namespace {

using loaded::LoadedPosition;

Range range_over(const loaded::LoadedCycle& cycle, double (*of)(const LoadedPosition&)) {
  Range r;
  for (const auto& p : cycle.positions) {
    const double value = of(p);
    r.least = std::min(r.least, value), r.most = std::max(r.most, value);
    r.mean += value / static_cast<double>(cycle.positions.size());
  }
  return r;
}

loaded::PairOptions options_of(double module_mm, const LoadedEffort& effort, double segment_mm, double rim_mm,
                               int row_teeth) {
  loaded::PairOptions options;
  for (auto* body : {&options.gear, &options.pinion}) {
    body->bricks.across = effort.across, body->bricks.flank = effort.flank, body->bricks.face = effort.face;
    body->bricks.rim_mm = rim_mm;
    body->teeth = row_teeth;
  }
  options.segment_mm = segment_mm;
  options.pinion_fillet_mm = 0.24 * module_mm;
  return options;
}

/// How often a pitch the stiffness falls and rises again by more than a hundredth of its mean.
int falls_of(const loaded::LoadedCycle& cycle) {
  const auto& p = cycle.positions;
  const auto n = p.size();
  std::size_t highest = 0;
  double mean = 0;
  for (std::size_t k = 0; k < n; ++k) {
    if (p[k].stiffness > p[highest].stiffness) highest = k;
    mean += p[k].stiffness / double(n);
  }
  int falls = 0;
  bool falling = false;
  double turn = p[highest].stiffness;  // the last extreme
  for (std::size_t k = 1; k <= n; ++k) {
    const double here = p[(highest + k) % n].stiffness;
    if (falling ? here < turn : here > turn) turn = here;
    if (std::abs(here - turn) <= 0.01 * mean) continue;
    falls += falling ? 0 : 1;
    falling = !falling, turn = here;
  }
  return falls;
}

LoadedTrial load_with(const face_gear::FaceGear& gear, double torque_nmm, const loaded::PairOptions& options,
                      int positions) {
  LoadedTrial trial;
  const face_gear::FaceGearParameters& p = gear.parameters();
  const auto pair = loaded::make_loaded_pair(gear, 1, p.shaper_teeth, options);
  if (!pair) {
    trial.refusal = pair.error().message;
    return trial;
  }
  loaded::Load load;
  load.torque_nmm = torque_nmm;
  load.positions = positions;
  const auto held = loaded::loaded_cycle(*pair, load);
  load.axial = loaded::PinionAxial::floating;
  const auto floating = loaded::loaded_cycle(*pair, load);
  for (const auto* cycle : {&held, &floating})
    if (!*cycle) {
      trial.refusal = cycle->error().message;
      return trial;
    }
  const auto error = [](const LoadedPosition& x) { return x.error_rad; };
  const auto peak = [](const LoadedPosition& x) { return x.pressure; };
  trial.normal_n = held->normal_n;
  trial.single_axial_n = held->single_axial_n;
  trial.approach_mm = range_over(*held, [](const LoadedPosition& x) { return x.approach_mm; });
  trial.stiffness = range_over(*held, [](const LoadedPosition& x) { return x.stiffness; });
  trial.line_mm = range_over(*held, [](const LoadedPosition& x) { return x.line_mm; });
  trial.outer_share = range_over(*held, [](const LoadedPosition& x) {
    return x.ring_force.back() / (x.ring_force.front() + x.ring_force.back());
  });
  trial.remainder = range_over(*held, [](const LoadedPosition& x) { return std::abs(x.axial_n); });
  for (double* v : {&trial.remainder.least, &trial.remainder.most, &trial.remainder.mean}) *v /= trial.single_axial_n;
  const Range pairs = range_over(*held, [](const LoadedPosition& x) { return double(x.pairs); });
  trial.least_pairs = static_cast<int>(pairs.least), trial.most_pairs = static_cast<int>(pairs.most);
  trial.mean_pairs = pairs.mean;
  trial.stiffness_falls = falls_of(*held);
  const Range lag = range_over(*held, error), free_lag = range_over(*floating, error);
  trial.error_rad = lag.most - lag.least;
  trial.floating_error_rad = free_lag.most - free_lag.least;
  trial.floating_axial_n = range_over(*floating, [](const LoadedPosition& x) { return std::abs(x.axial_n); }).most;
  trial.pressure = range_over(*held, peak).most;
  trial.end_pressure = range_over(*held, [](const LoadedPosition& x) { return x.end_pressure; }).most;
  trial.share_per_um = range_over(*held, [](const LoadedPosition& x) { return x.share_per_mm / kUm; }).mean;
  for (const LoadedPosition& x : held->positions) {
    const auto friction = loaded::friction_of(*pair, x, kArticleFriction);
    trial.friction_axial_n = std::max(trial.friction_axial_n, std::abs(friction.axial_n));
    trial.friction_torque = std::max(trial.friction_torque, std::abs(friction.torque_part));
  }
  return trial;
}

}  // namespace

LoadedTrial load_trial(const face_gear::FaceGear& gear, double torque_nmm, const LoadedEffort& effort) {
  const double m = gear.parameters().module_mm;
  return load_with(gear, torque_nmm, options_of(m, effort, 0.3 * m, 5 * m, 5), effort.positions);
}

std::vector<EffortRow> effort_rows(double module_mm, bool quick) {
  const double m = module_mm;
  std::vector<EffortRow> rows = {{"coarse bricks", {3, 4, 5, 4}, 0.3 * m, 5 * m, 5, {}, 0},
                                 {"default", {4, 6, 8, 4}, 0.3 * m, 5 * m, 5, {}, 0},
                                 {"fine bricks", {4, 10, 14, 4}, 0.3 * m, 5 * m, 5, {}, 0},
                                 {"short pieces of line", {4, 6, 8, 4}, 0.15 * m, 5 * m, 5, {}, 0},
                                 {"half the rim", {4, 6, 8, 4}, 0.3 * m, 2.5 * m, 5, {}, 0},
                                 {"twice the rim", {4, 6, 8, 4}, 0.3 * m, 10 * m, 5, {}, 0},
                                 {"row of three teeth", {4, 6, 8, 4}, 0.3 * m, 5 * m, 3, {}, 0}};
  if (quick) rows.resize(2);
  return rows;
}

void load_effort(const face_gear::FaceGear& gear, double torque_nmm, EffortRow& row) {
  const auto start = std::chrono::steady_clock::now();
  const double m = gear.parameters().module_mm;
  row.found = load_with(gear, torque_nmm, options_of(m, row.effort, row.segment_mm, row.rim_mm, row.row_teeth),
                        row.effort.positions);
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

page::PageTable loaded_trials_table(const std::vector<DhfgTrial>& trials) {
  page::PageTable t{
      "Under load",
      {"trial", "loaded normal N", "approach um", "LTE p-p urad", "floating LTE p-p urad", "stiffness 1e6 N/mm",
       "line mm", "peak MPa", "at line ends MPa", "outer half", "loaded V-teeth", "axial one helix N",
       "held remainder %", "mean %", "floating axial N", "share a um", "load remark"},
      {},
      ""};
  t.note =
      "Elastic teeth of steel, all pairs and both halves at once, no friction; pinion held at its exact place unless "
      "it says "
      "floating. LTE: turn of the gear, peak to peak over a pitch. Peak: line contact of Hertz without the first and "
      "last piece "
      "of a line, which stand apart: an edge has no finite pressure. Remainder: axial force of the held pinion, part "
      "of that of "
      "one helix. Share a um: by how much the outer half's share changes when the pinion shifts by a micrometre along "
      "its axis.";
  for (const auto& r : trials) {
    const LoadedTrial& l = r.loaded;
    std::vector<std::string> row = {std::to_string(r.levels.number)};
    if (!l.refusal.empty() || l.normal_n == 0) row.resize(t.columns.size() - 1);
    else
      row.insert(row.end(),
                 {fmt::format("{:.0f}", l.normal_n),
                  fmt::format("{:.3f} to {:.3f}", l.approach_mm.least * kUm, l.approach_mm.most * kUm),
                  fmt::format("{:.3f}", l.error_rad * kMicro), fmt::format("{:.3f}", l.floating_error_rad * kMicro),
                  fmt::format("{:.3f} to {:.3f}", l.stiffness.least / 1e6, l.stiffness.most / 1e6),
                  fmt::format("{:.0f} to {:.0f}", l.line_mm.least, l.line_mm.most), fmt::format("{:.0f}", l.pressure),
                  fmt::format("{:.0f}", l.end_pressure),
                  fmt::format("{:.3f} to {:.3f}", l.outer_share.least, l.outer_share.most),
                  fmt::format("{} to {}", l.least_pairs, l.most_pairs), fmt::format("{:.1f}", l.single_axial_n),
                  fmt::format("{:.1f} to {:.1f}", l.remainder.least * 100, l.remainder.most * 100),
                  fmt::format("{:.1f}", l.remainder.mean * 100),
                  fmt::format("{:.1f}", l.floating_axial_n < 1e-6 ? 0.0 : l.floating_axial_n),
                  fmt::format("{:.2f}", std::abs(l.share_per_um))});
    row.push_back(l.refusal);
    t.rows.push_back(std::move(row));
  }
  return t;
}

page::PageTable equal_halves_table(const EqualHalves& equal) {
  page::PageTable t{fmt::format("Under load, all halves {:.3f} mm wide", equal.half_face_mm),
                    {"trial", "LTE p-p urad", "stiffness 1e6 N/mm", "mean", "peak MPa", "at line ends MPa",
                     "loaded V-teeth", "mean remainder %"},
                    {},
                    "The narrowest feasible half of the nine, beside the same grooves; coarse bricks, pinion held."};
  for (std::size_t k = 0; k < equal.trials.size(); ++k) {
    const LoadedTrial& l = equal.trials[k];
    if (!l.refusal.empty()) {
      t.rows.push_back({std::to_string(k + 1), "", "", "", "", "", "", l.refusal});
      continue;
    }
    t.rows.push_back({std::to_string(k + 1), fmt::format("{:.3f}", l.error_rad * kMicro),
                      fmt::format("{:.3f} to {:.3f}", l.stiffness.least / 1e6, l.stiffness.most / 1e6),
                      fmt::format("{:.3f}", l.stiffness.mean / 1e6), fmt::format("{:.0f}", l.pressure),
                      fmt::format("{:.0f}", l.end_pressure), fmt::format("{} to {}", l.least_pairs, l.most_pairs),
                      fmt::format("{:.1f}", l.remainder.mean * 100)});
  }
  return t;
}

page::PageTable effort_table(const std::vector<EffortRow>& rows, int trial) {
  page::PageTable t{
      "What the effort changes",
      {"of trial " + std::to_string(trial), "bricks", "piece mm", "rim mm", "teeth of the row", "stiffness 1e6 N/mm",
       "LTE p-p urad", "peak MPa", "at line ends MPa", "seconds"},
      {},
      "Four positions. Bricks: across the tooth, along the flank, along the face. What holds the rim is an "
      "assumption, not an error of the mesh; it moves the stiffness most. Seconds: of a "
      "study in one piece; shards do not tell them."};
  for (const auto& r : rows) {
    if (!r.found.refusal.empty()) {
      t.rows.push_back({r.name, "", "", "", "", "", "", "", "", r.found.refusal});
      continue;
    }
    t.rows.push_back({r.name, fmt::format("{}, {}, {}", r.effort.across, r.effort.flank, r.effort.face),
                      fmt::format("{:g}", r.segment_mm), fmt::format("{:g}", r.rim_mm), std::to_string(r.row_teeth),
                      fmt::format("{:.3f} to {:.3f}", r.found.stiffness.least / 1e6, r.found.stiffness.most / 1e6),
                      fmt::format("{:.3f}", r.found.error_rad * kMicro), fmt::format("{:.0f}", r.found.pressure),
                      fmt::format("{:.0f}", r.found.end_pressure),
                      r.seconds > 0 ? fmt::format("{:.1f}", r.seconds) : ""});
  }
  return t;
}

}  // namespace toothpath::trials
