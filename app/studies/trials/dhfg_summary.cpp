#include "app/studies/trials/dhfg_summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/report/page/study_page.h"
#include "app/studies/trials/dhfg_article.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"

namespace toothpath::trials {
namespace {

std::string minutes(double m) { return fmt::format("{:.0f}", m); }

page::PageTable geometry_table(const std::vector<DhfgTrial>& trials) {
  page::PageTable t{"Limits and feasible halves",
                    {"trial", "N_p", "N_2", "helix deg", "R1 mm", "governed by", "R2 mm", "R2' mm", "R_in mm", "R_g mm",
                     "R_out mm", "half mm", "feasible mm", "remark"},
                    {},
                    ""};
  t.note =
      "R1: largest inner limit of both flanks; R2: pointed; R2': top land 0.2 m. The halves take the band less the "
      "margins on both sides of the groove.";
  for (const auto& r : trials)
    t.rows.push_back({std::to_string(r.levels.number), std::to_string(r.pinion_teeth), std::to_string(r.teeth),
                      fmt::format("{:g}", degrees(r.helix_angle_rad)), fmt::format("{:.3f}", r.R1_mm), r.R1_name,
                      fmt::format("{:.3f}", r.R2_mm), fmt::format("{:.3f}", r.land_mm),
                      fmt::format("{:.3f}", r.inner_mm), fmt::format("{:.3f}", r.groove_mm),
                      fmt::format("{:.3f}", r.outer_mm), fmt::format("{:.3f}", r.half_face_mm),
                      fmt::format("{:.3f}", r.feasible_mm), r.refusal});
  return t;
}

page::PageTable mesh_table(const StudyFacts& s, const std::vector<DhfgTrial>& trials) {
  page::PageTable t{
      "Contact and forces",
      {"trial", "ratio inner", "ratio outer", "ratio V-teeth", "pairs", "error urad", "normal N", "axial single N",
       "axial halves N", "axial balanced N", "axial held N", "held/single %", "radial N", "gear axial N"},
      {},
      ""};
  t.note = fmt::format(
      "Torque on the gear {:g} N m. Single: the same torque on one helix. Halves: axial force of each half of the "
      "balanced pinion, opposite signs. Held: a pinion that cannot float, {:g} % of the torque on the outer half. "
      "Radial: pushes the pinion off the gear; gear axial: presses the gear on its seat; neither is balanced by the "
      "second helix.",
      s.torque_nmm / 1000, s.held_share * 100);
  for (const auto& r : trials) {
    const auto n = [](double v) { return fmt::format("{:.1f}", std::abs(v) < 1e-6 ? 0.0 : v); };
    t.rows.push_back(
        {std::to_string(r.levels.number), fmt::format("{:.3f}", r.overlap_halves[0]),
         fmt::format("{:.3f}", r.overlap_halves[1]), fmt::format("{:.3f}", r.overlap),
         fmt::format("{} to {}", r.least_pairs, r.most_pairs), fmt::format("{:.6f}", r.error_range_rad * 1e6),
         n(r.balanced.inner.normal_n + r.balanced.outer.normal_n), n(r.balanced.single_axial_n),
         n(r.balanced.outer.pinion_axial_n), n(r.balanced.axial_n), n(r.held.axial_n),
         r.balanced.single_axial_n != 0 ? fmt::format("{:.1f}", 100 * r.held.axial_n / r.balanced.single_axial_n) : "",
         n(r.balanced.inner.pinion_radial_n + r.balanced.outer.pinion_radial_n),
         n(r.balanced.inner.gear_axial_n + r.balanced.outer.gear_axial_n)});
  }
  return t;
}

page::PageTable milling_table(const StudyFacts& s, const std::vector<DhfgTrial>& trials) {
  page::PageTable t{s.quick ? "Milling, coarse tolerances" : "Milling",
                    {"trial", "cutting min", "rapid min", "cutting h", "CL points a space", "remark"},
                    {},
                    ""};
  t.note = fmt::format(
      "Planned paths of all teeth at their feeds, rapids at {:g} mm/min; no acceleration, no tool changes, no gouge "
      "proof. ",
      s.rapid_mm_min);
  if (s.quick)
    t.note += fmt::format(
        "Quick form: scallops {:g} times, chord tolerances {:g} times and roughing steps {:g} times those of the study "
        "file, so the times are those of a coarse surface: compare them among the trials, not with a finished gear.",
        kQuickScallop, kQuickChord, kQuickStep);
  for (const auto& r : trials)
    t.rows.push_back({std::to_string(r.levels.number), minutes(r.milling.cutting_minutes),
                      minutes(r.milling.rapid_minutes), fmt::format("{:.1f}", r.milling.cutting_minutes / 60),
                      std::to_string(r.milling.cl_points), r.milling.refusal});
  return t;
}

/// Mean of a quantity over the three trials of every level of every factor: what the orthogonal array is for.
struct Quantity {
  const char* name;
  double (*of)(const DhfgTrial&);
  bool of_milling = false;
};
constexpr Quantity kQuantities[] = {
    {"feasible half mm", [](const DhfgTrial& t) { return t.feasible_mm; }},
    {"contact ratio", [](const DhfgTrial& t) { return t.overlap; }},
    {"single-helix axial N", [](const DhfgTrial& t) { return std::abs(t.balanced.single_axial_n); }},
    {"stiffness 1e6 N/mm", [](const DhfgTrial& t) { return t.loaded.stiffness.mean / 1e6; }},
    {"loaded error p-p urad", [](const DhfgTrial& t) { return t.loaded.error_rad * 1e6; }},
    {"peak pressure MPa", [](const DhfgTrial& t) { return t.loaded.pressure; }},
    {"held remainder %", [](const DhfgTrial& t) { return t.loaded.remainder.mean * 100; }},
    {"cutting min", [](const DhfgTrial& t) { return t.milling.cutting_minutes; }, true},
};
page::PageTable range_table(const StudyFacts& s, const std::vector<DhfgTrial>& trials) {
  page::PageTable t{"Means of the levels",
                    {"quantity", "factor", "level 1", "level 2", "level 3", "range"},
                    {},
                    "Each cell is the mean of the three trials with that level. A range near that of the blank column "
                    "says nothing about its factor."};
  for (const auto& q : kQuantities) {
    if (q.of_milling && !s.milled) continue;
    for (int factor = 0; factor < 4; ++factor) {
      double mean[3] = {0, 0, 0};
      for (const auto& r : trials) {
        const int level = factor == 0   ? r.levels.teeth
                          : factor == 1 ? r.levels.ratio
                          : factor == 2 ? r.levels.helix
                                        : r.levels.blank;
        mean[level] += q.of(r) / 3;
      }
      const auto name = [&]() -> std::string {
        const auto levels = [&](const std::vector<double>& v, double f) {
          return fmt::format(" {:g}/{:g}/{:g}", v[0] * f, v[1] * f, v[2] * f);
        };
        if (factor == 0) return "pinion teeth" + levels(s.pinion_teeth, 1);
        if (factor == 1) return "ratio" + levels(s.ratio, 1);
        if (factor == 2) return "helix deg" + levels(s.helix_angle_rad, degrees(1));
        return "blank";
      }();
      const auto [low, high] = std::minmax({mean[0], mean[1], mean[2]});
      t.rows.push_back({q.name, name, fmt::format("{:.3f}", mean[0]), fmt::format("{:.3f}", mean[1]),
                        fmt::format("{:.3f}", mean[2]), fmt::format("{:.3f}", high - low)});
    }
  }
  return t;
}

std::vector<svg::LineChart> charts_of(const StudyFacts& s, const std::vector<DhfgTrial>& trials) {
  const auto chart = [&](std::string title, std::string y,
                         std::vector<std::pair<std::string, double (*)(const DhfgTrial&)>> series, std::string note) {
    svg::LineChart c;
    c.title = std::move(title), c.x_label = "trial", c.y_label = std::move(y), c.markers = true,
    c.note = std::move(note);
    for (const auto& [name, of] : series) {
      svg::ChartSeries line{name, {}, {}};
      for (const auto& t : trials) line.x.push_back(t.levels.number), line.y.push_back(of(t));
      c.series.push_back(std::move(line));
    }
    return c;
  };
  std::vector<svg::LineChart> charts = {
      chart("Contact ratio", "pairs (mean)",
            {{"V-teeth", [](const DhfgTrial& t) { return t.overlap; }},
             {"inner half", [](const DhfgTrial& t) { return t.overlap_halves[0]; }},
             {"outer half", [](const DhfgTrial& t) { return t.overlap_halves[1]; }}},
            "A V-tooth is in contact while one of its halves is."),
      chart("Axial force on the pinion", "force [N]",
            {{"single helix", [](const DhfgTrial& t) { return std::abs(t.balanced.single_axial_n); }},
             {"held pinion", [](const DhfgTrial& t) { return std::abs(t.held.axial_n); }},
             {"floating pinion", [](const DhfgTrial& t) { return std::abs(t.balanced.axial_n); }}},
            "Statics of rigid bodies: zero for a pinion that floats."),
      chart("Face of each half", "radial width [mm]",
            {{"chosen", [](const DhfgTrial& t) { return t.half_face_mm; }},
             {"feasible", [](const DhfgTrial& t) { return t.feasible_mm; }}},
            "")};
  if (s.milled)
    charts.push_back(chart("Milling time", "cutting time [min]",
                           {{"all teeth", [](const DhfgTrial& t) { return t.milling.cutting_minutes; }}}, ""));
  return charts;
}

std::vector<std::string> introduction_of(const StudyFacts& s) {
  std::vector<std::string> text = {
      fmt::format("Nine trials of the orthogonal array L9: three levels of pinion teeth, ratio and helix angle, module "
                  "{:g} mm in the {} reading, as the study of X. Chu and F. Chen (Machines 2025, 13, 912) lists them. "
                  "Shaper and pinion have the same number of teeth, so the exact flanks touch along lines.",
                  s.module_mm, s.normal_module ? "normal" : "transverse"),
      "Limits, contact ratio, rigid transmission error and the forces of the second table are kinematics and statics "
      "of rigid "
      "bodies. Under load the teeth are elastic: lines of contact in closed form, bricks on the exact surfaces, load "
      "shared over "
      "all pairs and both halves, without friction (docs/loaded_contact.md). The literature took its overlap of two to "
      "three "
      "pairs, mesh stiffness, loaded transmission error, contact stress and an axial force lowered by about 70 % from "
      "finite "
      "elements; the last table puts its statements beside what is found here.",
      "The rigid transmission error is zero in every trial. The axial force of a floating pinion is zero at any helix "
      "angle; a "
      "remainder appears when the halves share the torque unequally: a remainder of 30 % means a share of 65 to 35.",
      "The torque is that of the face gear, as in the article: its gear shaft is loaded, on the rig by a hydraulic "
      "motor. "
      "It prints no face widths, groove or L0: here the groove lies in the middle of the band, and the halves take all "
      "that the limits leave unless the study file gives half_face. Wider halves mean more overlap."};
  if (!s.milled)
    text.emplace_back(
        "Milling times need tools and operations, which a study file states (STUDY.toml): this study has none.");
  return text;
}

nlohmann::ordered_json loaded_json(const LoadedTrial& l) {
  if (!l.refusal.empty() || l.normal_n == 0) return {{"refusal", l.refusal}};
  const auto range = [](const Range& r, double scale) {
    return nlohmann::ordered_json{{"least", r.least * scale}, {"most", r.most * scale}, {"mean", r.mean * scale}};
  };
  return {{"normal_N", l.normal_n},
          {"approach_um", range(l.approach_mm, 1e3)},
          {"stiffness_N_mm", range(l.stiffness, 1)},
          {"line_mm", range(l.line_mm, 1)},
          {"outer_share", range(l.outer_share, 1)},
          {"axial_remainder", range(l.remainder, 1)},
          {"floating_axial_N", l.floating_axial_n},
          {"pairs", {l.least_pairs, l.most_pairs}},
          {"error_range_urad", l.error_rad * 1e6},
          {"floating_error_range_urad", l.floating_error_rad * 1e6},
          {"pressure_MPa", l.pressure},
          {"end_pressure_MPa", l.end_pressure},
          {"mean_pairs", l.mean_pairs},
          {"stiffness_falls_a_pitch", l.stiffness_falls},
          {"friction_axial_N", l.friction_axial_n},
          {"friction_torque_part", l.friction_torque},
          {"outer_share_change_per_um", l.share_per_um}};
}

nlohmann::ordered_json json_of(const StudyFacts& s, const std::vector<DhfgTrial>& trials) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["command"] = "study dhfg";
  json["study"] = s.name;
  json["quick"] = s.quick;
  json["torque_Nm"] = s.torque_nmm / 1000;
  json["trials"] = nlohmann::ordered_json::array();
  for (const auto& r : trials)
    json["trials"].push_back(
        {{"trial", r.levels.number},
         {"pinion_teeth", r.pinion_teeth},
         {"teeth", r.teeth},
         {"helix_deg", degrees(r.helix_angle_rad)},
         {"R1", r.R1_mm},
         {"R1_governed_by", r.R1_name},
         {"R2", r.R2_mm},
         {"R2_land", r.land_mm},
         {"R_in", r.inner_mm},
         {"R_g", r.groove_mm},
         {"R_out", r.outer_mm},
         {"half_face", r.half_face_mm},
         {"feasible_half_face", r.feasible_mm},
         {"refusal", r.refusal},
         {"contact_ratio", {{"inner", r.overlap_halves[0]}, {"outer", r.overlap_halves[1]}, {"v_teeth", r.overlap}}},
         {"pairs", {r.least_pairs, r.most_pairs}},
         {"error_range_urad", r.error_range_rad * 1e6},
         {"marked_share", r.marked_share},
         {"axial_N",
          {{"single_helix", r.balanced.single_axial_n},
           {"inner_half", r.balanced.inner.pinion_axial_n},
           {"outer_half", r.balanced.outer.pinion_axial_n},
           {"balanced", r.balanced.axial_n},
           {"held", r.held.axial_n}}},
         {"loaded", loaded_json(r.loaded)},
         {"milling",
          {{"cutting_minutes", r.milling.cutting_minutes},
           {"rapid_minutes", r.milling.rapid_minutes},
           {"cl_points", r.milling.cl_points},
           {"refusal", r.milling.refusal}}}});
  return json;
}

/// @param of_trials how many of them have a row a trial, at the beginning
std::vector<page::PageTable> tables_of(const StudyFacts& s, const StudyFound& found, std::size_t& of_trials) {
  const std::vector<DhfgTrial>& trials = found.trials;
  std::vector<page::PageTable> tables = {geometry_table(trials), mesh_table(s, trials), loaded_trials_table(trials)};
  if (s.milled) tables.push_back(milling_table(s, trials));
  of_trials = tables.size();
  tables.push_back(range_table(s, trials));
  if (!found.equal.trials.empty()) tables.push_back(equal_halves_table(found.equal));
  if (!found.efforts.empty()) tables.push_back(effort_table(found.efforts, trials[kMiddleTrial].levels.number));
  if (auto article = article_table(s, found); !article.rows.empty()) tables.push_back(std::move(article));
  return tables;
}

/// One line a trial.
page::PageTable side_by_side(const std::vector<page::PageTable>& tables, std::size_t of_trials) {
  page::PageTable all;
  all.rows.resize(tables.front().rows.size());
  for (std::size_t n = 0; n < of_trials; ++n)
    for (std::size_t c = n == 0 ? 0 : 1; c < tables[n].columns.size(); ++c) {
      all.columns.push_back(tables[n].columns[c] == "remark" && n == 3 ? "milling remark" : tables[n].columns[c]);
      for (std::size_t k = 0; k < all.rows.size(); ++k) all.rows[k].push_back(tables[n].rows[k][c]);
    }
  return all;
}

}  // namespace

DhfgSummary summary_of(const StudyFacts& facts, const StudyFound& found) {
  const std::vector<DhfgTrial>& trials = found.trials;
  std::size_t of_trials = 0;
  const std::vector<page::PageTable> tables = tables_of(facts, found, of_trials);
  const auto feasible = std::count_if(trials.begin(), trials.end(), [](const auto& t) { return t.refusal.empty(); });
  page::StudyPage page;
  page.title = facts.name + ": double helical face gears";
  page.subtitle = fmt::format("nine orthogonal trials, torque {:g} N m on the gear", facts.torque_nmm / 1000);
  page.good = feasible == 9;
  page.verdict = fmt::format("{} of 9 trials feasible", feasible);
  page.introduction = introduction_of(facts);
  page.charts = charts_of(facts, trials);
  page.tables = tables;
  DhfgSummary out;
  out.json = json_text(json_of(facts, trials), 2) + "\n";
  out.text = page.title + "\n";
  for (const auto& table : tables) out.text += "\n" + table.title + "\n" + page::table_text(table) + table.note + "\n";
  for (const auto& paragraph : page.introduction) out.text += "\n" + paragraph + "\n";
  out.files = {{kDhfgFiles[0], page::table_csv(side_by_side(tables, of_trials))},
               {kDhfgFiles[1], out.json},
               {kDhfgFiles[2], page::study_page_html(page)}};
  return out;
}

}  // namespace toothpath::trials
