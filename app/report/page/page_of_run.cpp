#include "app/report/page/page_of_run.h"

#include <algorithm>

#include "app/base/units.h"
#include "app/report/page/tool_body.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/turned_text.h"
#include "geometry/base/angle.h"

namespace toothpath::page {
namespace {

KeyFigure::State state_of(const report::Finding& f) {
  switch (f.state) {
    case report::Finding::State::plain: return KeyFigure::State::plain;
    case report::Finding::State::good: return KeyFigure::State::good;
    case report::Finding::State::bad: return KeyFigure::State::bad;
  }
  return KeyFigure::State::plain;
}

std::vector<KeyFigure> key_figures(const report::RunReport& r) {
  using State = KeyFigure::State;
  std::vector<KeyFigure> figures;
  const auto um = [](double mm) { return fmt::format("{:.2f}", mm * 1000); };
  if (r.gouge)
    figures.push_back(
        {"worst gouge", um(std::max(0.0, r.gouge->measured_mm)), "\u00b5m",
         fmt::format("proven below {}, tolerance {}", um(std::max(0.0, r.gouge->bound_mm)), um(r.gouge_tolerance_mm)),
         r.gouge->bound_mm <= r.gouge_tolerance_mm ? State::good : State::bad});
  if (r.finished)
    figures.push_back({"worst left material", um(r.finished->max_mm), "\u00b5m",
                       "proven below " + um(r.finished->bound_mm), State::plain});
  if (r.gouge)
    figures.push_back({"least clearance", app::least_text(r.gouge->clearance_mm, r.gouge->clearance_at_least()), "mm",
                       fmt::format("required {:.3f}", r.gouge->required_clearance_mm),
                       r.gouge->clearance_mm >= r.gouge->required_clearance_mm ? State::good : State::bad});
  if (!r.operations.empty()) {
    figures.push_back({"cutting time", report::readable_minutes(r.feed_minutes), "",
                       fmt::format("with rapids {}{}", report::readable_minutes(r.total_minutes),
                                   r.has_acceleration ? "" : ", no accelerations stated"),
                       State::plain});
    figures.push_back(
        {"NC blocks", std::to_string(r.blocks), "", fmt::format("{} CL points a tooth", r.cl_points), State::plain});
  }
  for (const report::Finding& f : r.findings)
    if (!f.label.empty())
      figures.push_back({f.label, f.value_text(), f.unit == "um" ? "\u00b5m" : f.unit, f.limit_text(), state_of(f)});
  return figures;
}

PageTable axis_table(const report::RunReport& r) {
  PageTable table{"Axes",
                  {"axis", "least", "greatest", "lower limit", "upper limit", "unit"},
                  {},
                  "Machine coordinates, over the whole program."};
  for (const auto& axis : r.axes) {
    const auto number = [&](double value) {
      return axis.rotary ? svg::turned_text(degrees(value)) : fmt::format("{:.3f}", value);
    };
    const auto limit = [&](double value) {
      return axis.endless() ? "rolls over" : fmt::format("{:.3f}", axis.rotary ? degrees(value) : value);
    };
    table.rows.push_back({std::string(1, axis.letter), number(axis.min), number(axis.max), limit(axis.lower_limit),
                          limit(axis.upper_limit), axis.rotary ? "deg" : "mm"});
  }
  if (r.poles) table.note += " " + report::poles_text(*r.poles);
  return table;
}

std::string readable_type(std::string type) {
  std::replace(type.begin(), type.end(), '_', ' ');
  return type;
}

PageTable operation_table(const report::RunReport& r) {
  PageTable table{
      "Operations", {"op", "type", "tool", "S 1/min", "feed mm/min", "CL points", "cutting", "rapids"}, {}, ""};
  for (const auto& o : r.operations)
    table.rows.push_back({std::to_string(o.operation), readable_type(o.type), fmt::format("T{}", o.tool_number),
                          fmt::format("{:g}", o.speed_rpm), fmt::format("{:g}", o.feed_mm_min),
                          std::to_string(o.cl_points), report::readable_minutes(o.feed_minutes),
                          report::readable_minutes(o.rapid_minutes)});
  if (!r.operations.empty()) table.note = "Times: " + report::times_text(r) + ".";
  return table;
}

PageTable correction_table(const report::RunReport& r) {
  PageTable table{
      "Correction",
      {"zone", "flank", "measured max um", "measured rms um", "not followed max um", "not followed rms um", "degrees"},
      {},
      "The target of this program: nominal flanks moved by minus the smooth part of the measured deviations (products "
      "of Chebyshev polynomials along profile and face). Deviations in this report are from that target."};
  for (const auto& c : r.correction)
    table.rows.push_back(
        {std::to_string(c.zone), fmt::format("{:+}", c.side), fmt::format("{:.2f}", c.fit.measured_max_mm * 1000),
         fmt::format("{:.2f}", c.fit.measured_rms_mm * 1000), fmt::format("{:.2f}", c.fit.residual_max_mm * 1000),
         fmt::format("{:.2f}", c.fit.residual_rms_mm * 1000),
         fmt::format("{} x {}", c.fit.profile_degree, c.fit.lead_degree)});
  return table;
}

PageTable index_table(const report::RunReport& r) {
  PageTable table{
      "Pitch and run-out, measured",
      {"zone", "flank", "radius mm", "measured", "f_p um", "F_p um", "F_r um"},
      {},
      "From where the middle of each flank stands; the correction above leaves them out. Where not all teeth "
      "were measured, the true values may be larger."};
  for (const auto& p : r.index.pitch)
    table.rows.push_back({std::to_string(p.zone), fmt::format("{:+}", p.side), fmt::format("{:.3f}", p.radius_mm),
                          fmt::format("{} teeth", p.teeth),
                          p.pairs ? fmt::format("{:.2f}", p.single_mm * app::kUm) : std::string(),
                          fmt::format("{:.2f}", p.total_mm * app::kUm), ""});
  for (const auto& f : r.index.run_out)
    table.rows.push_back({std::to_string(f.zone), "", fmt::format("{:.3f}", f.radius_mm),
                          fmt::format("{} spaces", f.spaces), "", "", fmt::format("{:.2f}", f.run_out_mm * app::kUm)});
  return table;
}

PageTable pass_table(const report::RunReport& r) {
  PageTable table{"Passes",
                  {"op", "zone", "pass", "name", "direction", "length mm", "points"},
                  {},
                  "One tooth space; the convex side of a herringbone is one pass through both zones."};
  for (const auto& p : r.passes)
    table.rows.push_back({std::to_string(p.operation), std::to_string(p.zone), std::to_string(p.pass), p.name,
                          p.outward ? "outwards" : "inwards", fmt::format("{:.3f}", p.length_mm),
                          std::to_string(p.points)});
  return table;
}

}  // namespace

ReportPage page_of_run(const GearOnPage& gear, const report::RunReport& r, std::span<const path::ClPath* const> paths,
                       std::string_view program) {
  ReportPage page;
  page.title = r.job_name;
  page.subtitle = gear.subtitle;
  page.verified = r.verified;
  page.verdict = report::verdict_text(r);
  page.unfinished = report::unfinished_text(r);
  page.reasons = r.reasons;
  for (const auto& help : r.would_help) page.reasons.push_back("Would help: " + help);
  page.warnings = r.warnings;
  page.assumed = r.assumed;
  page.figures = key_figures(r);
  page.summary = {
      {"job", r.job_file}, {"machine", fmt::format("{} ({})", r.machine_name, r.machine_file)}, {"control", r.dialect}};
  if (!r.program_sha256.empty()) page.summary.emplace_back("SHA-256 of the program", r.program_sha256);
  for (const path::ClPath* path : paths) page.paths.push_back({*path, {}});
  page.tools = gear.tools;
  page.gouge = r.gouge;
  page.gouge_tolerance_mm = r.gouge_tolerance_mm;
  page.nc_file = r.program_file;
  if (r.gouge && !program.empty()) {
    std::vector<int> lines;
    for (const auto& place : r.gouge->worst) lines.push_back(place.line);
    page.listing = nc_excerpts(program, lines);
  }
  if (r.block_times) page.block_times = report::block_time_chart(*r.block_times);
  page.excess = r.excess;
  page.finished = r.finished;
  page.ledger = r.ledger;
  page.directions = r.directions;
  page.stage_seconds = r.stages;
  for (const report::Section& section : r.sections)
    if (!section.id.empty()) page.sections.push_back(section);
  if (!r.operations.empty()) page.tables = {operation_table(r), axis_table(r)};
  if (!r.correction.empty()) page.tables.push_back(correction_table(r));
  if (!r.index.pitch.empty()) page.tables.push_back(index_table(r));
  if (!r.passes.empty()) page.tables.push_back(pass_table(r));
  return page;
}

}  // namespace toothpath::page
