#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/base/units.h"
#include "app/report/machine_moves.h"
#include "app/report/run_report.h"
#include "app/report/svg/turned_text.h"
#include "geometry/base/angle.h"
#include "machines/assumed.h"

namespace toothpath::report {
namespace {

void row(std::string& out, std::string_view name, const std::string& value) {
  out += fmt::format("  {:<20}{}\n", name, value);
}

std::string tools_text(const RunReport& report) {
  std::string text;
  std::vector<int> seen;
  for (const auto& operation : report.operations) {
    if (std::find(seen.begin(), seen.end(), operation.tool_number) != seen.end()) continue;
    seen.push_back(operation.tool_number);
    double minutes = 0;
    for (const auto& other : report.operations)
      if (other.tool_number == operation.tool_number) minutes += other.feed_minutes + other.rapid_minutes;
    text += fmt::format("{}T{} {}", text.empty() ? "" : ", ", operation.tool_number, readable_minutes(minutes));
  }
  return text;
}

void axis_rows(std::string& out, const RunReport& report) {
  for (const auto& axis : report.axes) {
    const double f = axis.rotary ? degrees(1.0) : 1.0;
    const char* unit = axis.rotary ? "deg" : "mm";
    const bool stands = axis.max - axis.min < 1e-9;
    const auto place = [&](double value) {
      return axis.rotary ? svg::turned_text(degrees(value)) : fmt::format("{:.3f}", value);
    };
    const std::string moves = stands
                                  ? fmt::format("{:>10} {:<16}", place(axis.min), std::string(unit) + ", stands still")
                                  : fmt::format("{:>10} .. {:>9} {:<3}", place(axis.min), place(axis.max), unit);
    const std::string limits =
        axis.endless() ? "rolls over" : fmt::format("limits {:g} .. {:g}", axis.lower_limit * f, axis.upper_limit * f);
    row(out, fmt::format("axis {}", axis.letter), fmt::format("{}   {}", moves, limits));
  }
}

void proof_rows(std::string& out, const RunReport& report) {
  if (report.gouge)
    row(out, "worst gouge",
        fmt::format("{:.2f} um, proven below {:.2f} um (tolerance {:.2f} um)",
                    std::max(0.0, report.gouge->measured_mm) * app::kUm,
                    std::max(0.0, report.gouge->bound_mm) * app::kUm, report.gouge_tolerance_mm * app::kUm));
  if (report.finished)
    row(out, "worst left material",
        fmt::format("{:.2f} um, proven below {:.2f} um", report.finished->max_mm * app::kUm,
                    report.finished->bound_mm * app::kUm));
  for (const Finding& f : report.findings)
    if (!f.label.empty() && f.unfinished.empty()) row(out, f.label, f.row_text());
  if (report.gouge)
    row(out, "least clearance",
        fmt::format("{} mm (neck, shank, holder)",
                    app::least_text(report.gouge->clearance_mm, report.gouge->clearance_at_least())));
  if (report.machine_moves) row(out, "machine bodies", machine_moves_text(*report.machine_moves));
  for (const auto& v : report.scene) {
    const std::string place = v.nearest ? fmt::format("{}, op {}, tooth {}, line {}", v.nearest->body,
                                                      v.nearest->operation, v.nearest->tooth, v.nearest->line)
                                        : "";
    row(out, v.name,
        !v.nearest
            ? fmt::format("clear by more than {:.3f} mm", v.look_mm)
            : fmt::format("{}: least gap {:.3f} mm proven ({}), clearance {:.3f} mm", v.clear() ? "clear" : "NOT clear",
                          std::max(0.0, v.nearest->gap_mm), place, v.required_mm));
    for (const auto& m : v.meshes)
      row(out, "",
          fmt::format("{}: X {:.6g} to {:.6g}, Y {:.6g} to {:.6g}, Z {:.6g} to {:.6g} mm, {:.3f} mm from the gear",
                      m.file, m.low.x(), m.high.x(), m.low.y(), m.high.y(), m.low.z(), m.high.z(), m.to_gear_mm));
  }
}

/// Where the results are, and what to open first.
void results_row(std::string& out, const RunReport& report) {
  if (report.directory.empty() || report.files.empty()) return;
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path here = fs::current_path(error);  // proximate() alone throws where it was deleted
  fs::path directory = error ? fs::path() : fs::proximate(report.directory, here, error);  // where it is below here
  if (error || directory.empty() || *directory.begin() == "..") directory = report.directory;
  const auto name_of = [&](std::initializer_list<std::string_view> names) -> std::string {
    for (const std::string_view name : names)
      if (std::find(report.files.begin(), report.files.end(), name) != report.files.end())
        return (directory / name).lexically_normal().string();
    return {};
  };
  const std::string page = name_of({"report.html", "limits.html"}), sheet = name_of({"setup.html", "setup_check.html"});
  std::string text = page.empty() ? report.directory : "open " + page + " first";
  if (!sheet.empty()) text += fmt::format("; for the machine: {}", sheet);
  if (report.verified && report.command == "run") text += fmt::format(" and {}", report.program_file);
  row(out, "results", text);
}

/// What was made beside the program.
void made_rows(std::string& out, const RunReport& report) {
  if (report.modified)
    row(out, "modified flanks",
        fmt::format("up to {:.2f} um are taken off the plain ones; what is nominal here is the modified flank",
                    report.modified->most_removed_mm() * app::kUm));
  for (const auto& c : report.correction)
    row(out, "correction",
        fmt::format(
            "zone {}, flank {:+}: measured max {:.2f} um, rms {:.2f} um; not followed max {:.2f} um, rms {:.2f} um",
            c.zone, c.side, c.fit.measured_max_mm * app::kUm, c.fit.measured_rms_mm * app::kUm,
            c.fit.residual_max_mm * app::kUm, c.fit.residual_rms_mm * app::kUm));
  for (const auto& p : report.index.pitch)
    row(out, "pitch",
        fmt::format("zone {}, flank {:+}, radius {:.3f} mm: f_p {}, F_p {:.2f} um; {} teeth measured{}", p.zone, p.side,
                    p.radius_mm,
                    p.pairs ? fmt::format("{:.2f} um (teeth {} to {})", p.single_mm * app::kUm, p.single_tooth,
                                          p.single_tooth + 1)
                            : "unknown (no neighbours)",
                    p.total_mm * app::kUm, p.teeth, p.complete ? "" : ": not all, F_p may be larger"));
  for (const auto& r : report.index.run_out)
    row(out, "run-out",
        fmt::format("zone {}, radius {:.3f} mm: F_r {:.2f} um; {} spaces measured{}", r.zone, r.radius_mm,
                    r.run_out_mm * app::kUm, r.spaces, r.complete ? "" : ": not all, F_r may be larger"));
  if (const auto& cad = report.cad)
    row(out, "solid",
        fmt::format(
            "{}: {} faces, {:.1f} MB; worst deviation from the exact surface {:.3f} um ({}), {:g} um is the most",
            cad->file, cad->faces, double(cad->bytes) * 1e-6, cad->worst_mm * app::kUm, cad->worst_at,
            cad->asked_mm * app::kUm));
  if (const auto& roughed = report.roughed)
    row(out, "roughed part",
        fmt::format("{}: {} facets, {:.1f} MB; nothing that stands is missing, what is gone stands at most {:.3f} mm "
                    "thick (grid of {:.3f} mm)",
                    roughed->file, roughed->triangles, double(roughed->bytes) * 1e-6, roughed->thick_mm,
                    roughed->cell_mm));
}

}  // namespace

std::string readable_minutes(double minutes) { return app::duration_text(minutes * 60); }

std::string times_text(const RunReport& report) {
  return report.time_model + (report.tool_change_minutes
                                  ? fmt::format(", tool changes of {}", readable_minutes(*report.tool_change_minutes))
                                  : ", without tool changes");
}

std::string unfinished_text(const RunReport& report) {
  for (const Finding& f : report.findings)
    if (!f.unfinished.empty()) return f.unfinished;
  return {};
}

namespace {

/// What qualifies a verdict of yes.
std::string with(const RunReport& report, std::string yes) {
  if (!unfinished_text(report).empty()) yes += ", root not finished";
  if (report.gouge && report.gouge->sampled_patches > 0)
    yes += fmt::format("; {} of {} patches by sampling", report.gouge->sampled_patches, report.gouge->patches);
  return yes;
}

}  // namespace

std::string verdict_text(const RunReport& report) {
  return report.verified ? with(report, "verified") : "not verified";
}

std::string summary_table(const RunReport& report, bool color) {
  std::string out = report.job_name + "\n";
  const std::string left = unfinished_text(report);
  const std::string verdict = report.verified ? with(report, "yes") : "NO";
  const char* paint = !report.verified ? "\033[31m" : !left.empty() ? "\033[33m" : "\033[32m";
  if (report.command != "surface") row(out, "verified", color ? fmt::format("{}{}\033[0m", paint, verdict) : verdict);
  for (const auto& reason : report.reasons) row(out, "  because", reason);
  for (const auto& help : report.would_help) row(out, "  would help", help);
  if (!left.empty()) row(out, "not finished", left);
  results_row(out, report);
  proof_rows(out, report);
  if (!report.operations.empty()) {
    row(out, "cutting time",
        fmt::format("{} (with rapids {})", readable_minutes(report.feed_minutes),
                    readable_minutes(report.total_minutes)));
    row(out, "times are", times_text(report));
    row(out, "time by tool", tools_text(report));
  }
  for (const auto& d : report.directions)
    if (!d.fixed && d.passes > 0)
      row(out, "tool axis",
          fmt::format("operation {}, zone {}: simultaneous, lean {:.1f} to {:.1f} deg, turns in {} of {} passes",
                      d.operation, d.zone, degrees(d.least_lean_rad), degrees(d.greatest_lean_rad), d.turning_passes,
                      d.passes));
  axis_rows(out, report);
  if (report.travel_room) {
    const auto& [offer, origin, work] = *report.travel_room;
    row(out, "room in travels",
        fmt::format("X {:.1f}  Y {:.1f}  Z {:.1f} mm; most with the origin at [{:.3f}, {:.3f}, {:.3f}]: X {:.1f}  Y "
                    "{:.1f}  Z {:.1f} mm",
                    offer.room_now_mm[0], offer.room_now_mm[1], offer.room_now_mm[2], origin.x(), origin.y(),
                    origin.z(), offer.room_then_mm[0], offer.room_then_mm[1], offer.room_then_mm[2]));
  }
  if (!report.machine_name.empty()) row(out, "machine", report.machine_name);
  if (!report.assumed.empty()) row(out, "assumed", machines::counted_keys(report.assumed));
  if (!report.program_file.empty())
    row(out, "program", fmt::format("{}, {} blocks", report.program_file, report.blocks));
  if (report.verified && !report.parts.empty())
    row(out, "programs in parts",
        fmt::format("{} to {}: to be run one after the other in the place of {}", report.parts.front().file,
                    report.parts.back().file, report.program_file));
  made_rows(out, report);
  for (const auto& warning : report.warnings) row(out, "warning", warning);
  if (report.command == "surface")
    for (const auto& file : report.files) row(out, "written", file);
  double seconds = 0;
  for (const auto& stage : report.stages) seconds += stage.second;
  row(out, "computed in", fmt::format("{:.1f} s", seconds));
  return out;
}

std::string poles_text(const PolesReport& poles) {
  return fmt::format(
      "Poles passed: {} a tooth (pole = \"{}\"); the tool axis moves by at most {:.4f} deg for it, the tip by {:.4f} "
      "mm about the centre of the ball.",
      poles.passages, poles.option, degrees(poles.axis_rad), poles.tip_mm);
}

}  // namespace toothpath::report
