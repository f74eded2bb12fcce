#include "app/report/sheet/setup_sheet.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "app/report/sheet/part_swing.h"
#include "app/report/sheet/restart_section.h"
#include "app/report/sheet/setup_drawings.h"
#include "app/report/sheet/sheet_html.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/turned_text.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"
#include "machines/assumed.h"
#include "postproc/controls/of_machine.h"

namespace toothpath::sheet {
namespace {

constexpr std::size_t kMostAssumed = 200, kAssumedWidth = 90;

std::string coordinates(const Vec3& v) {
  return fmt::format("X {}  Y {}  Z {}", millimetres(v.x()), millimetres(v.y()), millimetres(v.z()));
}

/// What cools, and the words that the operator finds in the program.
std::string coolant_text(machines::Coolant coolant, const machines::Machine& machine) {
  const auto dialect = controls::dialect_of(machine);
  const auto words = dialect && coolant != machines::Coolant::off ? text::coolant_words(*dialect, coolant)
                                                                  : Result<machines::CoolantWords>(Diagnostic{});
  return words ? fmt::format("{}: on with {}, off with {}", to_string(coolant), words->on, words->off)
               : to_string(coolant);
}

/// What must hold of the work offset beside its place.
std::string offset_text(const std::string& work_offset, const machines::Machine& machine) {
  const auto dialect = controls::dialect_of(machine);
  return dialect ? text::offset_trust(*dialect, work_offset, controls::axis_letters(machine)) : std::string();
}

/// What the control must hold besides for TCP.
std::string tcp_text(const machines::Machine& machine) {
  const auto dialect = controls::dialect_of(machine);
  return dialect ? fmt::format("{}", fmt::join(dialect->tcp_notes, "; ")) : std::string();
}

void machine_section(Sheet& sheet, const job::Job& job, const PartOutline& part, const machines::Machine& machine,
                     const report::RunReport& report) {
  const joints::Setup& setup = *job.setup;
  sheet.heading("Gear, machine and work offset");
  sheet.begin_table({"what", "value"});
  sheet.row({"gear", part.words});
  sheet.row({"heights, gear Z", fmt::format("{} {}, {} {}, both from the gear origin",
                                            part.around ? "upper end face" : "tooth tops", millimetres(part.tooth_top),
                                            part.around ? "lower end face" : "deepest root", millimetres(part.root))});
  sheet.row({"machine", fmt::format("{} ({})", machine.name, job.machine.file)});
  sheet.row({"control", machine.dialect});
  sheet.row({"program", report.program_file.empty() ? "none: the run is not verified" : report.program_file});
  if (!report.name_on_control.empty()) sheet.row({"name on the control", report.name_on_control});
  if (!report.program_sha256.empty()) sheet.row({"SHA-256", report.program_sha256});
  sheet.row({"work offset", fmt::format("{} = machine {}", setup.work_offset, coordinates(setup.work_offset_at_mm))});
  if (const std::string trust = offset_text(setup.work_offset, machine); !trust.empty())
    sheet.row({"work offset, besides", trust});
  if (machine.tcp != machines::TcpMode::none && !job.program.tilted_planes)
    if (const std::string notes = tcp_text(machine); !notes.empty()) sheet.row({"TCP of the control", notes});
  sheet.row({"gear origin, machine", coordinates(setup.origin_mm)});
  sheet.row({"gear origin, " + setup.work_offset, coordinates(setup.origin_mm - setup.work_offset_at_mm)});
  sheet.row({"gear axis", !setup.axis_up ? "down: turned by 180 deg about X"
                          : part.around  ? "up: gear Z along machine Z, gear X along machine X"
                                         : "up: teeth towards the spindle, gear X along machine X"});
  if (!setup.measured_file.empty())
    sheet.row({"part", fmt::format("stands as measured in {}: teeth turned by {:.4f} deg about gear Z",
                                   setup.measured_file, degrees(setup.clocking_rad))});
  sheet.row({"coolant", coolant_text(job.coolant, machine)});
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
    if (const auto& axis = machine.chain.rotary(k); axis.clamp)
      sheet.row({fmt::format("clamp of {}", axis.letter),
                 fmt::format("{} clamps, {} releases", axis.clamp->on, axis.clamp->off)});
  sheet.end_table();
}

/// The times of a tool stand where the operations tell them: not of a program that was only read.
void tool_table(Sheet& sheet, const job::Job& job, const report::RunReport& report) {
  std::vector<std::string> columns = {"T", "cutter", "length mm", "stick-out mm", "flute mm", "shank mm", "teeth"};
  const bool timed = !report.operations.empty();
  if (timed) columns.insert(columns.end(), {"cutting", "rapids", "total"});
  sheet.begin_table(columns);
  for (const auto& tool : job.tools) {
    std::vector<std::string> row = {
        std::to_string(tool.number),
        tool::cutter_text(tool) + (tool.sister_of == 0 ? "" : fmt::format(", sister of T{}", tool.sister_of)),
        millimetres(tool.length_mm),
        millimetres(tool.stick_out_mm),
        millimetres(tool.flute_length_mm),
        fmt::format("dia {:g}", tool.shank_diameter_mm),
        std::to_string(tool.teeth)};
    double feed = 0, rapid = 0;
    for (const auto& operation : report.operations) {
      if (operation.tool_number != tool.number) continue;
      feed += operation.feed_minutes;
      rapid += operation.rapid_minutes;
    }
    if (timed)
      row.insert(row.end(), {report::readable_minutes(feed), report::readable_minutes(rapid),
                             report::readable_minutes(feed + rapid)});
    sheet.row(row);
  }
  sheet.end_table();
}

/// How often the tool is changed, and whether the times hold it.
void change_line(Sheet& sheet, const report::RunReport& report) {
  int changes = 0, before = -1;
  for (const auto& operation : report.operations) {
    changes += operation.tool_number != before ? 1 : 0;
    before = operation.tool_number;
  }
  const std::string changing = report.tool_change_minutes
                                   ? fmt::format("they take {}, which no tool's times hold",
                                                 report::readable_minutes(*report.tool_change_minutes))
                                   : "changes are not in the times";
  sheet.raw(fmt::format("<p class=small>{} tool change{}, the first tool included; {}.</p>\n", changes,
                        changes == 1 ? "" : "s", changing));
}

void tool_section(Sheet& sheet, const job::Job& job, const report::RunReport& report) {
  sheet.heading("Tools");
  tool_table(sheet, job, report);
  if (!report.operations.empty()) change_line(sheet, report);
  sheet.raw("<div class=tools>");
  for (const auto& tool : job.tools)
    if (tool.sister_of == 0) sheet.raw(tool_sketch(tool));
  sheet.raw("</div>\n");
}

std::string microns(double mm) { return mm < 0.1 ? fmt::format("{:.2f} um", mm * 1000) : fmt::format("{:.3f} mm", mm); }

/// What the flanks could bear if nothing else were cut.
std::string flanks_alone(const report::LengthTolerance& t) {
  if (t.flank_share <= 0) return "no flank";
  const double by = t.share / t.flank_share;
  return microns(t.too_long_mm * by) + (t.too_short_mm ? ", " + microns(*t.too_short_mm * by) : "");
}

void length_section(Sheet& sheet, const report::RunReport& report) {
  if (report.length_tolerances.empty()) return;
  sheet.heading("Tool length: how exactly it must be set");
  sheet.begin_table({"op", "T", "too long by at most", "too short by at most", "flanks alone: long, short",
                     "share of the error", "share on the flanks"});
  for (const auto& t : report.length_tolerances)
    sheet.row({std::to_string(t.operation), std::to_string(t.tool_number), microns(t.too_long_mm),
               t.too_short_mm ? microns(*t.too_short_mm) : "finished later", flanks_alone(t),
               fmt::format("{:.3f}", t.share), fmt::format("{:.3f}", t.flank_share)});
  sheet.end_table();
  sheet.raw(
      "<p class=small>A length error d moves the cut surface by d (u &middot; n) along its normal n, u being the tool "
      "axis; the share is the largest |u &middot; n| on what the operation cuts. Too long: what is left of the gouge "
      "tolerance beyond the proven bound, and the stock that the operation leaves. Too short: what the scallop and "
      "chord of the last operation allow beyond what is left; \"finished later\" stands where another operation "
      "finishes. An error of the work offset along the tool axis adds to it.</p>\n");
}

/// How the tool axis stands in an operation: fixed in all its zones, or with the leans of those in which it turns.
std::string tilt_of(const report::RunReport& report, int operation) {
  double least = INFINITY, greatest = -INFINITY;
  for (const auto& d : report.directions) {
    if (d.operation != operation || d.fixed) continue;
    if (d.passes == 0) return "simultaneous";
    least = std::min(least, d.least_lean_rad);
    greatest = std::max(greatest, d.greatest_lean_rad);
  }
  return least > greatest ? "fixed"
                          : fmt::format("simultaneous, lean {:.1f} to {:.1f} deg", degrees(least), degrees(greatest));
}

void operation_section(Sheet& sheet, const report::RunReport& report) {
  const double rapids = report.total_minutes - report.feed_minutes - report.tool_change_minutes.value_or(0);
  const std::string times = svg::html_escape(report::times_text(report));
  if (report.operations.empty()) {  // of a program that was only read: its feeds and speeds are its own
    sheet.heading("Times");
    sheet.raw(fmt::format("<p>Cutting {}, rapids {}.</p>\n<p class=small>Times: {}.</p>\n",
                          report::readable_minutes(report.feed_minutes), report::readable_minutes(rapids), times));
    return;
  }
  sheet.heading("Operations");
  sheet.begin_table({"op", "type", "T", "S 1/min", "feed mm/min", "cutting", "rapids", "tool axis"});
  for (const auto& o : report.operations)
    sheet.row({std::to_string(o.operation), o.type, std::to_string(o.tool_number), fmt::format("{:g}", o.speed_rpm),
               fmt::format("{:g}", o.feed_mm_min), report::readable_minutes(o.feed_minutes),
               report::readable_minutes(o.rapid_minutes), tilt_of(report, o.operation)});
  sheet.row(
      {"", "all", "", "", "", report::readable_minutes(report.feed_minutes), report::readable_minutes(rapids), ""});
  sheet.end_table();
  sheet.raw(fmt::format("<p class=small>Times: {}.</p>\n", times));
}

void axis_section(Sheet& sheet, const report::RunReport& report) {
  sheet.heading("Axis ranges, machine coordinates");
  sheet.begin_table({"axis", "least", "greatest", "lower limit", "upper limit", "unit"});
  for (const auto& axis : report.axes) {
    const auto number = [&](double value) {
      return axis.rotary ? svg::turned_text(degrees(value)) : millimetres(value);
    };
    const auto limit = [&](double value) {
      return axis.endless() ? "rolls over" : millimetres(axis.rotary ? degrees(value) : value);
    };
    sheet.row({std::string(1, axis.letter), number(axis.min), number(axis.max), limit(axis.lower_limit),
               limit(axis.upper_limit), axis.rotary ? "deg" : "mm"});
  }
  sheet.end_table();
}

void table_section(Sheet& sheet, const report::Section& section) {
  if (section.sheet_rows == 0) return;
  const std::size_t rows = std::min(section.rows.size(), section.sheet_rows), more = section.rows.size() - rows;
  sheet.heading(section.title);
  sheet.begin_table(section.columns);
  for (std::size_t n = 0; n < rows; ++n) sheet.row(section.rows[n]);
  sheet.end_table();
  if (more > 0) sheet.raw(fmt::format("<p class=small>{} more stand in report.html.</p>\n", more));
  if (!section.note.empty()) sheet.raw(fmt::format("<p class=small>{}</p>\n", svg::html_escape(section.note)));
}

}  // namespace

std::string setup_sheet(const job::Job& job, const PartOutline& part, const machines::Machine& machine,
                        const report::RunReport& report) {
  Sheet sheet;
  const std::string title = svg::html_escape(job.name);
  sheet.raw(
      fmt::format("<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
                  "content='width=device-width'><title>Set-up sheet: "
                  "{}</title><style>{}</style></head><body>\n<h1>Set-up sheet: {}</h1>\n",
                  title, kSheetStyle, title));
  const std::string left = report::unfinished_text(report), verdict = report::verdict_text(report);
  if (report.verified && report.gouge)
    sheet.raw(
        fmt::format("<div class={}>{}: worst gouge {:.2f} um, proven below {:.2f} um, tolerance {:.2f} um.{}</div>\n",
                    verdict == "verified" ? "yes" : "part", svg::html_escape(svg::sentence(verdict)),
                    std::max(0.0, report.gouge->measured_mm) * 1000, std::max(0.0, report.gouge->bound_mm) * 1000,
                    report.gouge_tolerance_mm * 1000,
                    left.empty() ? "" : fmt::format("<br>Not finished: {}.", svg::html_escape(left))));
  else sheet.raw("<div class=no>NOT VERIFIED: do not cut.</div>\n");
  if (!report.reasons.empty()) sheet.list(report.reasons, "no");
  if (report.command == "check")
    sheet.raw(
        "<p class=small>Of a program that was read, not made. How exactly its tool lengths must be set and where it "
        "can "
        "be taken up again stand on the sheet of the run that made it.</p>\n");
  if (report.restart)
    sheet.raw(
        fmt::format("<p class=no>This program begins at operation {}, tooth {}. What the whole program cuts before "
                    "that is taken as done: look before you start.</p>\n",
                    report.restart->operation, report.restart->tooth));
  if (!report.warnings.empty()) sheet.list(report.warnings, "part");
  machine_section(sheet, job, part, machine, report);
  sheet.raw(part_sketch(*job.setup, part, machine));
  tool_section(sheet, job, report);
  length_section(sheet, report);
  operation_section(sheet, report);
  axis_section(sheet, report);
  restart_section(sheet, job, report);
  const BlankCylinder blank{part.outer_radius, std::min(part.bottom, part.tooth_top),
                            std::max(part.bottom, part.tooth_top)};
  if (!report.axes.empty()) table_section(sheet, swing_section(part_swing(blank, *job.setup, machine, report.axes)));
  for (const auto& section : report.sections) table_section(sheet, section);
  if (!report.assumed.empty()) {
    sheet.heading("Assumed values: measure before the first cut");
    sheet.list(machines::grouped_keys(report.assumed, kMostAssumed, kAssumedWidth), "assumed");
  }
  restart_appendix(sheet, report);
  return std::move(sheet).finish();
}

}  // namespace toothpath::sheet
