#include "app/report/setup_sheet.h"

#include <algorithm>

#include "app/report/html_text.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr std::string_view kStyle = R"(@page{size:A4;margin:14mm}
body{font:10.5pt/1.35 sans-serif;color:#111;background:#fff;max-width:182mm;margin:6mm auto}
h1{font-size:16pt;margin:0 0 1mm}h2{font-size:11.5pt;margin:4mm 0 1mm;border-bottom:.3mm solid #888;break-after:avoid}
table{border-collapse:collapse;width:100%}th,td{border:.2mm solid #999;padding:.6mm 1.6mm;text-align:left;vertical-align:top}
th{background:#eee;font-weight:600}td.n{text-align:right;font-variant-numeric:tabular-nums}tr,svg{break-inside:avoid}
.no{border:.8mm solid #b00;padding:2mm;color:#b00;font-weight:700}.yes{border:.4mm solid #070;padding:1.5mm}
.assumed{border:.5mm dashed #a60;padding:1.5mm}.assumed ul{columns:3 46mm;column-gap:5mm}@media print{body{margin:0}}ul{margin:1mm 0;padding-left:5mm}svg{max-width:100%}
)";

class Sheet {
 public:
  void heading(std::string_view text) { out_ += fmt::format("<h2>{}</h2>\n", html_escape(text)); }
  void begin_table(const std::vector<std::string>& columns) {
    out_ += "<table><thead><tr>";
    for (const auto& column : columns) out_ += fmt::format("<th>{}</th>", html_escape(column));
    out_ += "</tr></thead><tbody>\n";
  }
  /// Cells that begin with a digit or a minus sign are set to the right.
  void row(const std::vector<std::string>& cells) {
    out_ += "<tr>";
    for (const auto& cell : cells) {
      const bool number = !cell.empty() && (cell[0] == '-' || (cell[0] >= '0' && cell[0] <= '9'));
      out_ += fmt::format("<td{}>{}</td>", number ? " class=n" : "", html_escape(cell));
    }
    out_ += "</tr>\n";
  }
  void end_table() { out_ += "</tbody></table>\n"; }
  void list(const std::vector<std::string>& items, std::string_view css_class) {
    out_ += fmt::format("<div class={}><ul>", css_class);
    for (const auto& item : items) out_ += fmt::format("<li>{}</li>", html_escape(item));
    out_ += "</ul></div>\n";
  }
  void raw(std::string_view html) { out_ += html; }
  [[nodiscard]] std::string finish() && { return std::move(out_) + "</body></html>\n"; }

 private:
  std::string out_;
};

std::string millimetres(double value) { return fmt::format("{:.3f}", value == 0 ? 0.0 : value); }
std::string triple(const Vec3& v) {
  return fmt::format("X {}  Y {}  Z {}", millimetres(v.x()), millimetres(v.y()), millimetres(v.z()));
}

/// Part in the X-Z plane of the machine, with its origin, the work offset and the rotary axes that the table carries.
std::string part_sketch(const Setup& setup, const PartOutline& part, const Machine& machine) {
  const auto [r_in, r_out, top, root, bottom] = part;
  const double up = setup.axis_up ? 1.0 : -1.0;
  const Vec3 at = setup.origin_mm, offset = setup.work_offset_at_mm;
  const auto z_of = [&](double z) { return at.z() + up * z; };
  // View box in machine mm, Z upwards.
  std::vector<double> xs = {at.x() - r_out, at.x() + r_out, offset.x()};
  std::vector<double> zs = {z_of(top), z_of(bottom), at.z(), offset.z()};
  for (const auto& axis : machine.chain.table) {
    xs.push_back(axis.point_mm.x());
    zs.push_back(axis.point_mm.z());
  }
  const auto [x_min, x_max] = std::minmax_element(xs.begin(), xs.end());
  const auto [z_min, z_max] = std::minmax_element(zs.begin(), zs.end());
  const double margin = 0.12 * std::max(*x_max - *x_min, *z_max - *z_min) + 1;
  const double width = *x_max - *x_min + 2 * margin, height = *z_max - *z_min + 2 * margin, unit = width / 100;
  const auto px = [&](double x) { return x - *x_min + margin; };
  const auto py = [&](double z) { return *z_max - z + margin; };
  std::string svg = fmt::format("<svg viewBox='0 0 {:.3f} {:.3f}' role=img aria-label='part in the machine, X to the right, Z up' "
                                "style='width:100%;max-height:62mm' font-size='{:.3f}' font-family='sans-serif'>", width, height, 2.4 * unit);
  const auto body = [&](double x1, double x2, double z1, double z2, const char* fill) {
    svg += fmt::format("<rect x='{:.3f}' y='{:.3f}' width='{:.3f}' height='{:.3f}' fill='{}' stroke='#333' stroke-width='{:.3f}'/>",
                       px(x1), py(std::max(z1, z2)), x2 - x1, std::abs(z2 - z1), fill, 0.2 * unit);
  };
  body(at.x() - r_out, at.x() + r_out, z_of(root), z_of(bottom), "#ddd");
  for (const double side : {-1.0, 1.0}) {
    const double a = at.x() + side * r_in, b = at.x() + side * r_out;
    body(std::min(a, b), std::max(a, b), z_of(top), z_of(root), "#9ab");
  }
  std::vector<std::pair<Vec3, std::string>> marks = {{at, "gear origin"}, {offset, setup.work_offset}};
  for (const auto& axis : machine.chain.table) marks.emplace_back(axis.point_mm, fmt::format("axis {}", axis.letter));
  std::stable_sort(marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.first.z() > b.first.z(); });
  double free = 0;  // names of places at nearly the same height stand below one another
  for (const auto& [p, name] : marks) {
    const double x = px(p.x()), y = py(p.z()), r = 1.4 * unit;
    svg += fmt::format("<path d='M{0:.3f} {1:.3f}h{2:.3f}M{3:.3f} {4:.3f}v{2:.3f}' stroke='#b00' stroke-width='{5:.3f}'/>", x - r, y, 2 * r, x,
                       y - r, 0.3 * unit);
    const double line = std::max(y + 0.8 * unit, free);
    svg += fmt::format("<text x='{:.3f}' y='{:.3f}' fill='#b00'>{}</text>", x + 1.9 * unit, line, html_escape(name));
    free = line + 2.7 * unit;
  }
  svg += fmt::format("<text x='{:.3f}' y='{:.3f}'>X right, Z up, outer diameter {:.3f} mm</text></svg>\n", unit, 3 * unit, 2 * r_out);
  return svg;
}

/// Cutter, shank and holder from the side, tip at the bottom.
std::string tool_sketch(const ToolAssembly& tool) {
  double holder_height = 0, widest = std::max(tool.diameter_mm, tool.shank_diameter_mm);
  for (const auto& segment : tool.holder) {
    holder_height += segment.height_mm;
    widest = std::max({widest, segment.lower_diameter_mm, segment.upper_diameter_mm});
  }
  const double height = std::max(tool.length_mm, tool.stick_out_mm + holder_height);
  std::string svg = fmt::format("<svg viewBox='{:.3f} {:.3f} {:.3f} {:.3f}' style='height:34mm' role=img aria-label='tool {}'>", -widest / 2 - 1,
                                -height - 1, widest + 2, height + 2, tool.number);
  const auto cone = [&](double z1, double d1, double z2, double d2, const char* fill) {
    svg += fmt::format("<path d='M{:.3f} {:.3f}L{:.3f} {:.3f}L{:.3f} {:.3f}L{:.3f} {:.3f}Z' fill='{}' stroke='#333' stroke-width='.3'/>", -d1 / 2,
                       -z1, d1 / 2, -z1, d2 / 2, -z2, -d2 / 2, -z2, fill);
  };
  // A finger mill is drawn by its widest and its tip.
  const bool finger = tool.type == CutterType::finger_mill;
  if (finger) cone(0, tool.module_mm / 2, tool.flute_length_mm, tool.shank_diameter_mm, "#e8c66a");
  const double r = tool.radius_mm();
  if (!finger) cone(r, 2 * r, tool.flute_length_mm, 2 * r, "#e8c66a");
  if (!finger)
    svg += fmt::format("<path d='M{0:.3f} {1:.3f}A{2:.3f} {2:.3f} 0 0 0 {2:.3f} {1:.3f}Z' fill='#e8c66a' stroke='#333' stroke-width='.3'/>", -r, -r, r);
  cone(tool.flute_length_mm, tool.shank_diameter_mm, tool.stick_out_mm, tool.shank_diameter_mm, "#bbb");
  double z = tool.stick_out_mm;
  for (const auto& part : tool.holder) {
    cone(z, part.lower_diameter_mm, z + part.height_mm, part.upper_diameter_mm, "#888");
    z += part.height_mm;
  }
  return svg + "</svg>\n";
}

void machine_section(Sheet& sheet, const Job& job, const Machine& machine, const RunReport& report) {
  const Setup& setup = *job.setup;
  sheet.heading("Machine and work offset");
  sheet.begin_table({"what", "value"});
  sheet.row({"machine", fmt::format("{} ({})", machine.name, job.machine.file)});
  sheet.row({"control", machine.dialect});
  sheet.row({"program", report.program_file.empty() ? "none: the run is not verified" : report.program_file});
  if (!report.program_sha256.empty()) sheet.row({"SHA-256", report.program_sha256});
  sheet.row({"work offset", fmt::format("{} = machine {}", setup.work_offset, triple(setup.work_offset_at_mm))});
  sheet.row({"gear origin, machine", triple(setup.origin_mm)});
  sheet.row({"gear origin, " + setup.work_offset, triple(setup.origin_mm - setup.work_offset_at_mm)});
  sheet.row({"gear axis", setup.axis_up ? "up: teeth towards the spindle, gear X along machine X" : "down: turned by 180 deg about X"});
  sheet.row({"coolant", to_string(job.coolant)});
  sheet.end_table();
}

std::string cutter_name(const ToolAssembly& tool) {
  if (tool.type == CutterType::finger_mill)
    return fmt::format("finger mill, module {:g}, tip radius {:g}, rack depth {:g}, profile height {:g}", tool.module_mm, tool.tip_radius_mm,
                       tool.rack_depth_mm, tool.profile_height_mm);
  return fmt::format("ball end mill, dia {:g}", tool.diameter_mm);
}

void tool_section(Sheet& sheet, const Job& job, const RunReport& report) {
  sheet.heading("Tools");
  sheet.begin_table({"T", "cutter", "length: gauge line to tip", "stick-out", "flute", "shank", "teeth", "run time"});
  for (const auto& tool : job.tools) {
    double minutes = 0;
    for (const auto& operation : report.operations)
      if (operation.tool_number == tool.number) minutes += operation.feed_minutes + operation.rapid_minutes;
    sheet.row({std::to_string(tool.number), cutter_name(tool), millimetres(tool.length_mm),
               millimetres(tool.stick_out_mm), millimetres(tool.flute_length_mm), fmt::format("dia {:g}", tool.shank_diameter_mm),
               std::to_string(tool.teeth), readable_minutes(minutes)});
  }
  sheet.end_table();
  sheet.raw("<p>");
  for (const auto& tool : job.tools) sheet.raw(fmt::format("T{} {} &nbsp; ", tool.number, tool_sketch(tool)));
  sheet.raw("</p>\n");
}

/// How the tool axis stands in an operation: with all its zones fixed, or turning in some.
std::string tilt_of(const RunReport& report, int operation) {
  std::string text;
  for (const auto& d : report.directions) {
    if (d.operation != operation || d.fixed) continue;
    if (d.passes == 0) return "simultaneous";
    text += fmt::format("{}zone {}: SIMULTANEOUS, lean {:.1f} to {:.1f} deg, turns in {} of {} passes", text.empty() ? "" : "; ", d.zone,
                        degrees(d.least_lean_rad), degrees(d.greatest_lean_rad), d.turning_passes, d.passes);
  }
  return text.empty() ? "fixed" : text;
}

void operation_section(Sheet& sheet, const RunReport& report) {
  sheet.heading("Operations");
  sheet.begin_table({"op", "type", "T", "S 1/min", "feed mm/min", "cutting", "rapids", "tool axis"});
  for (const auto& o : report.operations)
    sheet.row({std::to_string(o.operation), o.type, std::to_string(o.tool_number), fmt::format("{:g}", o.speed_rpm), fmt::format("{:g}", o.feed_mm_min),
               readable_minutes(o.feed_minutes), readable_minutes(o.rapid_minutes), tilt_of(report, o.operation)});
  sheet.row({"", "all", "", "", "", readable_minutes(report.feed_minutes), readable_minutes(report.total_minutes - report.feed_minutes), ""});
  sheet.end_table();
  sheet.heading("Axis ranges, machine coordinates");
  sheet.begin_table({"axis", "least", "greatest", "lower limit", "upper limit", "unit"});
  for (const auto& axis : report.axes) {
    const double f = axis.rotary ? degrees(1.0) : 1.0;
    sheet.row({std::string(1, axis.letter), millimetres(axis.min * f), millimetres(axis.max * f), millimetres(axis.lower_limit * f),
               millimetres(axis.upper_limit * f), axis.rotary ? "deg" : "mm"});
  }
  sheet.end_table();
}

}  // namespace

std::string setup_sheet(const Job& job, const FaceGear& gear, const Machine& machine, const RunReport& report) {
  const double root = gear.lowest_root();
  return setup_sheet(job, PartOutline{gear.inner_radius(), gear.outer_radius(), gear.blank_top(), root, root - 2.5 * gear.parameters().module_mm},
                     machine, report);
}

std::string setup_sheet(const Job& job, const PartOutline& part, const Machine& machine, const RunReport& report) {
  Sheet sheet;
  const std::string title = html_escape(job.name);
  sheet.raw(fmt::format("<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport content='width=device-width'><title>Set-up sheet: {}</title>"
                        "<style>{}</style></head><body>\n<h1>Set-up sheet: {}</h1>\n", title, kStyle, title));
  if (report.verified && report.gouge)
    sheet.raw(fmt::format("<div class=yes>Verified: worst gouge {:.2f} um, proven below {:.2f} um, tolerance {:.2f} um.</div>\n",
                          std::max(0.0, report.gouge->measured_mm) * 1000, std::max(0.0, report.gouge->bound_mm) * 1000,
                          report.gouge_tolerance_mm * 1000));
  else sheet.raw("<div class=no>NOT VERIFIED: do not cut.</div>\n");
  if (!report.reasons.empty()) sheet.list(report.reasons, "no");
  machine_section(sheet, job, machine, report);
  sheet.raw(part_sketch(*job.setup, part, machine));
  tool_section(sheet, job, report);
  operation_section(sheet, report);
  if (!report.assumed.empty()) {
    sheet.heading("Assumed values: measure before the first cut");
    sheet.list(report.assumed, "assumed");
  }
  if (!report.warnings.empty()) {
    sheet.heading("Warnings");
    sheet.list(report.warnings, "plain");
  }
  return std::move(sheet).finish();
}

}  // namespace toothpath
