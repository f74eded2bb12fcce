#include "app/commands/cutter.h"

#include <nlohmann/json.hpp>

#include "app/job/file.h"
#include "app/process/gear_of_job.h"
#include "app/process/opening_and_end.h"
#include "app/report/page/study_page.h"
#include "app/report/sheet/cutter_sheet.h"
#include "cam/finger/milling.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "geometry/bevel_gear/forces.h"
#include "geometry/bevel_gear/limits.h"
#include "geometry/bevel_gear/modified_walls.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kCutterOutputs = {"cutter.csv", "cutter.svg", "cutter.dxf", "cutter.html",
                                                 "cutter.json"};
constexpr double kDxfChord = 2e-4;  // mm
constexpr double kCsvChord = 1e-5;  // mm

/// Design for the gear of a job; refusals with their place. What speaks of the designed mill belongs to the gear.
process::ValueOrErrors<bevel_gear::FingerCutterDesign> design_for(const job::Job& job) {
  const bevel_gear::BevelGearParameters* p = job.bevel_gear();
  if (!p)
    return std::vector{fail_at(job.where("gear.type"),
                               "type = \"{}\", but a finger mill makes an equal_base_circle_bevel_gear",
                               job.gear_type())};
  auto made = bevel_gear::design_finger_cutter(*p);
  if (auto* design = made.value_if()) return std::move(*design);
  std::vector<Diagnostic> errors;
  for (auto& refusal : made.error()) {
    const bool mill = refusal.key.starts_with("tool.");
    Diagnostic d = process::located(job, mill ? "gear" : "gear." + refusal.key, std::move(refusal.diagnostic));
    if (mill) d.message = "no finger mill by the design rules: " + d.message;
    errors.push_back(std::move(d));
  }
  return errors;
}

nlohmann::ordered_json json_of(const sheet::JudgedCutter& cutter) {
  const auto& j = cutter.judgement;
  const auto& c = j.profile;
  nlohmann::ordered_json out = {{"name", cutter.name},
                                {"module", j.data.module_mm},
                                {"tip_radius", j.data.tip_radius_mm},
                                {"rack_depth", j.data.rack_depth_mm},
                                {"profile_height", j.data.profile_height_mm},
                                {"half_width", c.r_0},
                                {"tip_depth", c.h_f},
                                {"tip_flat_radius", c.rho_o},
                                {"line_angle", degrees(c.phi)},
                                {"B", {c.x_B, c.rho_B}},
                                {"C", {c.x_C, c.rho_C}},
                                {"D", {c.x_D, c.rho_D}},
                                {"usable", j.usable()}};
  if (c.law) out["modified"] = true;
  auto& conditions = out["conditions"] = nlohmann::ordered_json::array();
  const char* verdicts[] = {"met", "remark", "broken"};
  for (const auto& k : j.conditions)
    conditions.push_back({{"name", k.name},
                          {"quantity", k.quantity},
                          {"value", k.value},
                          {"limit", k.limit},
                          {"relation", k.at_least ? ">=" : "<="},
                          {"unit", k.unit},
                          {"verdict", verdicts[static_cast<int>(k.verdict)]},
                          {"meaning", k.meaning}});
  auto& walls = out["walls"] = nlohmann::ordered_json::array();
  for (const auto& w : j.walls)
    walls.push_back({{"half", w.half},
                     {"wall", w.sigma > 0 ? "L" : "U"},
                     {"least_um", 1000 * w.least_mm},
                     {"least_at", {w.least_ell, w.least_height}},
                     {"greatest_um", 1000 * w.greatest_mm},
                     {"greatest_at", {w.greatest_ell, w.greatest_height}},
                     {"points", w.points},
                     {"missing", w.missing}});
  out["small_end_overcut_um"] = 1000 * j.small_end_overcut_mm;
  out["small_end_estimate_um"] = 1000 * j.small_end_estimate_mm;
  out["free_width_small_end"] = j.free_width_small_mm;
  out["free_width_large_end"] = j.free_width_large_mm;
  out["ridge_three_passes"] = j.ridge_mm;
  return out;
}

std::string gear_line(const bevel_gear::BevelGear& g) {
  const auto& p = g.parameters();
  const char* hand = p.hand > 0 ? "right" : "left";
  return fmt::format("z {}{}, m_te {:g}, alpha_n {:g}\u00b0, beta_e {:g}\u00b0, b {:g}, pitch angle {:.4f}\u00b0, {}",
                     p.teeth, p.mate_teeth > 0 ? fmt::format("/{}", p.mate_teeth) : "", p.outer_transverse_module_mm,
                     degrees(p.pressure_angle_rad), degrees(p.outer_spiral_angle_rad), p.face_width_mm,
                     degrees(g.delta()),
                     g.herringbone() ? fmt::format("herringbone, inner half {}, R_J {:g}", hand, g.R_ref())
                                     : fmt::format("{} hand", hand));
}

/// Mills of the job, and those of another job with the profile that its own gear gives them.
std::vector<sheet::JudgedCutter> judge_mills(const bevel_gear::BevelGear& gear, const job::Job& job,
                                             const job::Job* other) {
  std::vector<sheet::JudgedCutter> mills;
  for (const auto& tool : job.tools)
    if (tool::serves(tool, tool::CutterUse::tooth_form))
      mills.push_back({fmt::format("tool {}", tool.number),
                       bevel_gear::judge_finger_cutter(gear, finger::finger_cutter_data(tool))});
  if (!other) return mills;
  const bevel_gear::BevelGearParameters& p = *other->bevel_gear();
  const double delta = bevel_gear::bevel_pitch_angle(p),
               R_e = p.teeth * p.outer_transverse_module_mm / (2 * std::sin(delta));
  const double R_0 = R_e / std::pow(std::cos(p.outer_spiral_angle_rad), 2),
               kappa_v = std::abs(delta - kPi / 2) < 1e-15 ? 0.0 : std::cos(delta) / (R_0 * std::sin(delta));
  for (const auto& tool : other->tools) {
    if (!tool::serves(tool, tool::CutterUse::tooth_form)) continue;
    const bevel_gear::FingerCutterData d = finger::finger_cutter_data(tool);
    mills.push_back({fmt::format("tool {} of {}", tool.number, other->name),
                     judge_finger_profile(gear, d,
                                          bevel_gear::make_finger_profile<double>(
                                              {p.pressure_angle_rad, kappa_v, p.dedendum_mm, d.module_mm,
                                               d.tip_radius_mm, d.rack_depth_mm, d.profile_height_mm},
                                              bevel_gear::profile_law(p)))});
  }
  return mills;
}

page::PageTable summary_table_of(const std::vector<sheet::JudgedCutter>& mills) {
  page::PageTable table{
      "Mills", {"mill", "m_nj", "r_t", "h_C", "x_D", "walls [um]", "small end [um]", "ridge [mm]", "verdict"}, {}, ""};
  for (const auto& m : mills) {
    const auto& j = m.judgement;
    table.rows.push_back(
        {m.name, fmt::format("{:.4f}", j.data.module_mm), fmt::format("{:.4f}", j.data.tip_radius_mm),
         fmt::format("{:.4f}", j.data.rack_depth_mm), fmt::format("{:.4f}", j.data.profile_height_mm),
         j.walls.empty() ? "" : fmt::format("{:+.3f} .. {:+.3f}", 1000 * j.deepest_mm(), 1000 * j.proudest_mm()),
         fmt::format("{:.2f}", 1000 * j.small_end_overcut_mm), fmt::format("{:.3f}", j.ridge_mm),
         j.usable() ? "usable" : "not usable"});
  }
  return table;
}

/// The other job whose mills are judged, if one is named.
process::ValueOrErrors<std::optional<job::Job>> read_other(const CutterRequest& request, app::StageClock& clock) {
  if (request.other_job.empty()) return std::optional<job::Job>();
  auto read = clock.run("job", [&] { return job::read_job_file(request.other_job); });
  if (auto* errors = read.refused()) return std::move(*errors);
  job::Job& other = read.value();
  if (!other.bevel_gear())
    return std::vector{fail_at(other.where("gear.type"),
                               "type = \"{}\", but a finger mill makes an equal_base_circle_bevel_gear",
                               other.gear_type())};
  return std::optional<job::Job>(std::move(other));
}

/// Index of the mill that the sheet describes: the designed one, or the tool that is asked for.
Result<std::size_t> drawn_mill(std::optional<int> tool_number, const std::vector<sheet::JudgedCutter>& mills,
                               const job::Job& job) {
  if (!tool_number) return std::size_t{0};
  const std::string name = fmt::format("tool {}", *tool_number);
  std::size_t drawn = 0;
  while (drawn < mills.size() && mills[drawn].name != name) ++drawn;
  if (drawn == mills.size())
    return fail_at(job.where("tool"), "--tool = {} is not a finger mill of the job", *tool_number);
  if (mills[drawn].judgement.walls.empty())
    return fail_at(job.where("tool"), "tool {} cannot be drawn: its profile is impossible", *tool_number);
  return drawn;
}

sheet::CutterSheet sheet_about(const job::Job& job, const bevel_gear::BevelGear& gear,
                               const std::vector<sheet::JudgedCutter>& mills, std::size_t drawn) {
  sheet::CutterSheet sheet;
  sheet.job_name = job.name;
  sheet.job_file = job.file;
  sheet.gear_line = gear_line(gear);
  sheet.warnings = job.warnings;
  sheet.warnings.insert(sheet.warnings.end(), gear.warnings().begin(), gear.warnings().end());
  for (std::size_t i = 0; i < mills.size(); ++i)
    if (i != drawn) sheet.others.push_back(mills[i]);
  sheet.drawn = mills[drawn];
  const auto& profile = sheet.drawn.judgement.profile;
  sheet.length_mm = profile.h_f + profile.x_D + 0.5 * profile.rho_D;
  return sheet;
}

sheet::CutterDxf dxf_of(const sheet::CutterSheet& sheet) {
  const auto& data = sheet.drawn.judgement.data;
  return sheet::cutter_dxf(
      sheet.drawn.judgement.profile, sheet.length_mm,
      {fmt::format("finger mill ({}), job {}", sheet.drawn.name, sheet.job_name),
       fmt::format("module {:.6g}, tip radius {:.6g}, rack depth {:.6g}, profile height {:.6g}", data.module_mm,
                   data.tip_radius_mm, data.rack_depth_mm, data.profile_height_mm)},
      kDxfChord);
}

/// Where the axial force of a herringbone gear does not change with its sense.
std::optional<double> balanced_apex_distance_of(const bevel_gear::BevelGear& g) {
  if (!g.herringbone()) return std::nullopt;
  return bevel_gear::balanced_apex_distance(g.R_i(), g.R_e(), g.R_0(), g.parameters().relief_half_width_mm);
}

std::string mills_summary(const std::vector<sheet::JudgedCutter>& mills, const std::vector<std::string>& warnings) {
  std::string out = page::table_text(summary_table_of(mills));
  for (const auto& mill : mills)
    for (const auto& c : mill.judgement.conditions)
      if (c.verdict != bevel_gear::Verdict::met) out += fmt::format("{}: {}\n", mill.name, c.text());
  for (const auto& warning : warnings) out += "warning: " + warning + "\n";
  return out;
}

}  // namespace

CommandOutcome run_cutter(const CutterRequest& request) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, kCutterOutputs, {request.job_file, request.other_job});
  if (!output) return failed(output.error());
  auto read = clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job& job = read.value();
  auto other = read_other(request, clock);
  if (auto* errors = other.refused()) return failed(std::move(*errors));
  auto made = clock.run("design", [&] { return design_for(job); });
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  const bevel_gear::FingerCutterDesign& design = made.value();

  std::vector<sheet::JudgedCutter> mills = {{"designed", bevel_gear::judge_finger_cutter(design.gear, design.data)}};
  const job::Job* mills_of = other.value() ? &*other.value() : nullptr;
  for (auto& mill : clock.run("judgement", [&] { return judge_mills(design.gear, job, mills_of); }))
    mills.push_back(std::move(mill));
  const auto drawn = drawn_mill(request.tool_number, mills, job);
  if (!drawn) return failed(drawn.error());
  sheet::CutterSheet sheet = sheet_about(job, design.gear, mills, *drawn);
  const auto& profile = sheet.drawn.judgement.profile;
  const sheet::CutterDxf dxf = dxf_of(sheet);
  sheet.dxf_chord_mm = dxf.chord_error_mm;

  nlohmann::ordered_json json = {{"schema", 1}, {"command", "cutter"}, {"job", job.file}, {"drawn", sheet.drawn.name}};
  json["dxf"] = {{"chord_error_um", 1000 * dxf.chord_error_mm}, {"involute_vertices", dxf.vertices}};
  json["mills"] = nlohmann::ordered_json::array();
  for (const auto& mill : mills) json["mills"].push_back(json_of(mill));
  const auto R_J = balanced_apex_distance_of(design.gear);
  if (R_J) json["balanced_apex_cone_distance"] = *R_J;
  json["warnings"] = sheet.warnings;

  CommandOutcome outcome;
  outcome.report_json = json_text(json, 2) + "\n";
  std::optional<bevel_gear::FingerProfile<double>> compared;
  if (!sheet.others.empty()) compared = sheet.others.front().judgement.profile;
  const std::string svg = sheet::cutter_svg(
      profile, sheet.length_mm, sheet::cutter_drawing_scale(profile, sheet.length_mm, 160, 240), compared, true);
  const process::NamedFiles files = {{"cutter.csv", sheet::cutter_csv(profile, kCsvChord)},
                                     {"cutter.svg", svg},
                                     {"cutter.dxf", dxf.text},
                                     {"cutter.html", sheet::cutter_sheet_html(sheet)},
                                     {"cutter.json", outcome.report_json}};
  outcome.summary = mills_summary(mills, sheet.warnings);
  if (R_J)
    outcome.summary += fmt::format(
        "axial force is the same in both senses at apex_cone_distance = {:.4f} (now {:.4f}; uniform line load)\n", *R_J,
        design.gear.R_ref());
  outcome.summary += "files in " + request.out_dir + "\n";
  progress.clear();
  return process::finished(*output, files, std::move(outcome));
}

void add_cutter(Commands& commands) {
  commands.push_back(command_of<CutterRequest>(
      "cutter", "designs the finger mill of a bevel gear and judges the mills that are there",
      [](OptionSet& set, CutterRequest& request) {
        job_options(set, request);
        set.examples({"cutter pinion.toml", "cutter pinion.toml --cutter-of wheel.toml"});
        set.whole_number("--tool", request.tool_number, "draw this tool of the job instead of the designed mill",
                         job::kToolNumber);
        set.text("--cutter-of", request.other_job,
                 "judge the mills of this other job too, as they were made for its gear", "JOB");
      },
      run_cutter));
}

}  // namespace toothpath::commands
