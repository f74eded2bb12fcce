#include "app/studies/trials/dhfg_loaded.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/studies/trials/dhfg_trial.h"

namespace toothpath::trials {
namespace {

using loaded::LoadedPosition;

constexpr double kMicro = 1e6, kUm = 1e3;

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
  load.axial = loaded::PinionAxial::held;
  load.torque_nmm = torque_nmm * p.teeth / p.shaper_teeth;
  const auto pinion = loaded::loaded_cycle(*pair, load);
  for (const auto* cycle : {&held, &floating, &pinion})
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
  const Range lag = range_over(*held, error), free_lag = range_over(*floating, error);
  trial.error_rad = lag.most - lag.least;
  trial.floating_error_rad = free_lag.most - free_lag.least;
  trial.floating_axial_n = range_over(*floating, [](const LoadedPosition& x) { return std::abs(x.axial_n); }).most;
  trial.pressure = range_over(*held, peak).most;
  trial.end_pressure = range_over(*held, [](const LoadedPosition& x) { return x.end_pressure; }).most;
  trial.share_per_um = range_over(*held, [](const LoadedPosition& x) { return x.share_per_mm / kUm; }).mean;
  trial.pinion_torque_pressure = range_over(*pinion, peak).most;
  return trial;
}

double mean_of_level(const std::vector<DhfgTrial>& trials, int factor, int level, double (*of)(const LoadedTrial&)) {
  double sum = 0;
  for (const auto& t : trials) {
    const int at = factor == 0 ? t.levels.teeth : factor == 1 ? t.levels.ratio : t.levels.helix;
    if (at == level) sum += of(t.loaded) / 3;
  }
  return sum;
}
std::array<double, 3> levels_of(const std::vector<DhfgTrial>& trials, int factor, double (*of)(const LoadedTrial&)) {
  return {mean_of_level(trials, factor, 0, of), mean_of_level(trials, factor, 1, of),
          mean_of_level(trials, factor, 2, of)};
}
bool falls(const std::array<double, 3>& v) { return v[0] > v[1] && v[1] > v[2]; }
std::string three(const std::array<double, 3>& v, double scale, int digits) {
  return fmt::format("{:.{}f}, {:.{}f}, {:.{}f}", v[0] * scale, digits, v[1] * scale, digits, v[2] * scale, digits);
}

constexpr const char* kFactors[] = {"teeth", "ratio", "helix"};

/// Is every trial of one group softer than every one of the next? Those that are not.
std::string out_of_order(const std::vector<DhfgTrial>& trials) {
  const std::vector<std::vector<int>> groups = {{1, 4, 7, 8}, {2, 3, 5}, {6, 9}};
  const auto stiffness = [&](int number) { return trials[static_cast<std::size_t>(number - 1)].loaded.stiffness.mean; };
  const auto wrong = [&](const std::vector<int>& without) {
    for (std::size_t a = 0; a + 1 < groups.size(); ++a)
      for (const int low : groups[a])
        for (const int high : groups[a + 1])
          if (stiffness(low) >= stiffness(high) && std::count(without.begin(), without.end(), low) == 0 &&
              std::count(without.begin(), without.end(), high) == 0)
            return true;
    return false;
  };
  if (!wrong({})) return "reproduced";
  for (int one = 1; one <= 9; ++one)
    if (!wrong({one}))
      return fmt::format("reproduced but for trial {}: the order is that of the length of the lines", one);
  return "differs: the order here is that of the length of the lines, and with it of the chosen face widths";
}

/// Least and most of a quantity over the trials.
Range whole(const std::vector<DhfgTrial>& trials, double (*of)(const LoadedTrial&)) {
  Range r;
  for (const auto& x : trials) r.least = std::min(r.least, of(x.loaded)), r.most = std::max(r.most, of(x.loaded));
  return r;
}

void judge_stiffness(const std::vector<DhfgTrial>& trials, page::PageTable& t) {
  const Range low = whole(trials, [](const LoadedTrial&l) { return l.stiffness.least; }),
              high = whole(trials, [](const LoadedTrial&l) { return l.stiffness.most; });
  const LoadedTrial& four = trials[3].loaded;
  t.rows.push_back({"stiffness 0.5 to 30e4 N/mm, a spread of 60",
                    fmt::format("{:.2f} to {:.2f}e6 N/mm", low.least / 1e6, high.most / 1e6),
                    fmt::format("differs: 0.5 to 2.5e4 N/mm in trial 4 would mean {:.0f} to {:.0f} um of approach "
                                "under {:.0f} N; nine gears "
                                "of one module have no cause for a spread of 60",
                                four.normal_n / 5e3 * kUm, four.normal_n / 2.5e4 * kUm, four.normal_n)});
  std::vector<int> order = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return trials[static_cast<std::size_t>(a - 1)].loaded.stiffness.mean <
           trials[static_cast<std::size_t>(b - 1)].loaded.stiffness.mean;
  });
  t.rows.push_back({"order by stiffness: 1 4 7 8, then 2 3 5, then 6 9", fmt::format("{}", fmt::join(order, " ")),
                    out_of_order(trials)});
  const auto error = [](const LoadedTrial& l) { return l.error_rad; };
  for (int f = 0; f < 3; ++f) {
    const auto v = levels_of(trials, f, error);
    t.rows.push_back({fmt::format("transmission error falls with {}", kFactors[f]),
                      "level means " + three(v, kMicro, 3) + " urad",
                      falls(v) ? "reproduced" : "differs: not at every level"});
  }
}

void judge_contact(const std::vector<DhfgTrial>& trials, const EqualHalves& equal, page::PageTable& t) {
  const Range most_pairs = whole(trials, [](const LoadedTrial&l) { return double(l.most_pairs); }),
              least_pairs = whole(trials, [](const LoadedTrial&l) { return double(l.least_pairs); });
  int least_equal = 99, most_equal = 0;
  for (const auto& l : equal.trials)
    least_equal = std::min(least_equal, l.least_pairs), most_equal = std::max(most_equal, l.most_pairs);
  t.rows.push_back({"2 to 3 pairs in contact",
                    fmt::format("{:g} to {:g} V-teeth; {} to {} with halves of {:.1f} mm", least_pairs.least,
                                most_pairs.most, least_equal, most_equal, equal.half_face_mm),
                    least_equal >= 2 && most_equal <= 3
                        ? "reproduced with narrow halves; more where they take the whole feasible width. Load adds none"
                        : "differs"});
  const auto peak = [](const LoadedTrial& l) { return l.pressure; };
  const Range p = whole(trials, peak),
              pinion = whole(trials, [](const LoadedTrial&l) { return l.pinion_torque_pressure; });
  t.rows.push_back(
      {"stress 850 to 1150 MPa, 500 to 650 in trials 5 and 8",
       fmt::format("{:.0f} to {:.0f} MPa, torque on the pinion {:.0f} to {:.0f}", p.least, p.most, pinion.least,
                   pinion.most),
       p.most < 850 ? "differs: line contact of this load has less; edges and nodes have more" : "within reach"});
  for (const int f : {0, 2}) {
    const auto v = levels_of(trials, f, peak);
    t.rows.push_back({fmt::format("stress falls with {}", kFactors[f]), "level means " + three(v, 1, 0) + " MPa",
                      falls(v) ? "reproduced" : "differs: not at every level"});
  }
}

void judge_mesh_and_balance(const std::vector<DhfgTrial>& trials, const std::vector<EffortRow>& rows,
                            page::PageTable& t) {
  const auto coarse = std::find_if(rows.begin(), rows.end(), [](const EffortRow&r) { return r.name == "default"; }),
             finer = std::find_if(rows.begin(), rows.end(),
                                  [](const EffortRow&r) { return r.name == "short pieces of line"; });
  if (coarse != rows.end() && finer != rows.end())
    t.rows.push_back({"refinement changes the largest stress by less than 2 %",
                      fmt::format("pieces half as long: inside {:+.1f} %, line ends {:+.1f} %",
                                  100 * (finer->found.pressure / coarse->found.pressure - 1),
                                  100 * (finer->found.end_pressure / coarse->found.end_pressure - 1)),
                      "differs at edges: their pressure is a property of the mesh"});
  const auto rest = [](const LoadedTrial& l) { return l.remainder.mean; };
  const Range remainder = whole(trials, rest);
  t.rows.push_back({"axial force about 70 % lower",
                    fmt::format("floating pinion 100 % lower; held at its exact place {:.0f} to {:.0f} % (means)",
                                100 * (1 - remainder.most), 100 * (1 - remainder.least)),
                    fmt::format("differs: a remainder of 30 % is a pinion about {:.1f} um off its place along its axis",
                                0.15 / std::abs(trials[3].loaded.share_per_um))});
  const auto v = levels_of(trials, 2, rest);
  t.rows.push_back({"a helix of 25 deg is best", "remainder at the levels " + three(v, 100, 1) + " %",
                    v[1] < v[0] && v[1] < v[2]
                        ? "reproduced for a held pinion; a floating one has no remainder at any angle"
                        : "differs: no such optimum; a floating pinion has no remainder at any angle"});
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
       "line mm", "peak MPa", "at line ends MPa", "peak, torque on pinion", "outer half", "loaded V-teeth",
       "axial one helix N", "held remainder %", "mean %", "floating axial N", "share a um", "load remark"},
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
                  fmt::format("{:.0f}", l.end_pressure), fmt::format("{:.0f}", l.pinion_torque_pressure),
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

page::PageTable article_table(const std::vector<DhfgTrial>& trials, const EqualHalves& equal,
                              const std::vector<EffortRow>& rows) {
  page::PageTable t{"Against the article", {"statement", "here", "verdict"}, {}, ""};
  t.note =
      "Machines 2025, 13, 912. It prints no face widths, groove, place of the pinion, nor whose torque 532 N m is: its "
      "figures cannot be matched, only their order. Nothing was fitted to it.";
  for (const auto& r : trials)
    if (!r.loaded.refusal.empty() || r.loaded.normal_n == 0) return t;
  judge_stiffness(trials, t);
  judge_contact(trials, equal, t);
  judge_mesh_and_balance(trials, rows, t);
  t.rows.push_back({"simulation agrees with the rig", "", "cannot be judged: no figures of the rig are printed"});
  return t;
}

}  // namespace toothpath::trials
