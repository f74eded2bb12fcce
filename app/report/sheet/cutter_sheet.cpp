#include "app/report/sheet/cutter_sheet.h"

#include <fmt/format.h>

#include <cmath>

#include "app/report/svg/html_text.h"
#include "geometry/base/angle.h"

namespace toothpath::sheet {
namespace {

constexpr const char* kCutterStyle =
    "@page{size:A4;margin:11mm 12mm}*{box-sizing:border-box}html{background:#fff}body{margin:0 "
    "auto;max-width:188mm;padding:6mm 0;background:#fff;color:#16191c;font:8.8pt/1.34 system-ui,'Segoe "
    "UI',Roboto,'Liberation Sans',Arial,sans-serif;font-variant-numeric:tabular-nums}@media "
    "print{body{padding:0}}h1{font-size:15pt;margin:0}h2{font-size:9.6pt;margin:0 0 "
    "1mm}p{margin:0}header{display:flex;justify-content:space-between;align-items:flex-end;gap:6mm;border-bottom:.5mm "
    "solid #16191c;padding-bottom:1.6mm;margin-bottom:2.4mm}header "
    "p{color:#4d565e}.verdict{font-weight:650;border:.35mm solid;border-radius:.6mm;padding:.5mm "
    "2.6mm;white-space:nowrap}.good{color:#1d6b45}.bad{color:#a4202c}.warn{color:#8a5a00}.two{display:grid;gap:5mm;"
    "align-items:start}.top{grid-template-columns:minmax(0,1fr) 50mm}.low{grid-template-columns:minmax(0,1fr) "
    "74mm;margin-top:2.4mm}svg{display:block;max-width:100%;height:auto}table{border-collapse:collapse;width:100%}th,"
    "td{text-align:left;vertical-align:top;padding:.32mm 1.6mm .32mm 0;border-bottom:.15mm solid #d3d8dc}thead "
    "th{font-weight:500;color:#4d565e;border-bottom-color:#8a949c}.n{text-align:right;white-space:nowrap}.small{font-"
    "size:7.9pt;line-height:1.24}.note{color:#4d565e;font-size:7.9pt;margin-top:1mm}section.tools{margin-top:2.4mm}."
    "tools p+p{margin-top:.6mm}";

std::string number(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "none";
  return unit == "um" ? fmt::format("{:.2f}", value) : fmt::format("{:.4f}", value);
}

std::string order_table(const bevel_gear::CutterJudgement& j) {
  const auto& c = j.profile;
  std::string out = "<table class=small><tbody>";
  const auto row = [&](const char* name, const std::string& value) {
    out += fmt::format("<tr><td>{}</td><td class=n>{}</td></tr>", name, value);
  };
  row("module m<sub>nj</sub>", fmt::format("{:.4f}", j.data.module_mm));
  row("pressure angle", fmt::format("{:.4f}\u00b0", degrees(c.alpha_n)));
  row("equivalent radius r<sub>v</sub>",
      c.kappa_v > 0 ? fmt::format("{:.4f}", 1 / c.kappa_v) : std::string("straight"));
  if (c.law) row("flank", "modified: profile table and DXF say it");
  row("tip to pitch line h<sub>f</sub>", fmt::format("{:.4f}", c.h_f));
  row("tip radius r<sub>t</sub>", fmt::format("{:.4f}", c.r_t));
  row("flat of the tip", fmt::format("\u00d8{:.4f}", 2 * c.rho_o));
  row("B from the tip", fmt::format("{:.4f}", c.x_B + c.h_f));
  row("B diameter", fmt::format("\u00d8{:.4f}", 2 * c.rho_B));
  row("C from the tip", fmt::format("{:.4f}", c.x_C + c.h_f));
  row("C diameter", fmt::format("\u00d8{:.4f}", 2 * c.rho_C));
  row("angle of BC to the axis", fmt::format("{:.4f}\u00b0", degrees(c.phi)));
  row("arc at pitch line 2 r<sub>0</sub>", fmt::format("{:.4f}", 2 * c.r_0));
  row("D from the tip", fmt::format("{:.4f}", c.x_D + c.h_f));
  row("D diameter", fmt::format("\u00d8{:.4f}", 2 * c.rho_D));
  return out + "</tbody></table>";
}

std::string conditions_table(const bevel_gear::CutterJudgement& j) {
  std::string out =
      "<table class=small><thead><tr><th>condition</th><th>quantity</th><th class=n>value</th><th "
      "class=n>limit</th><th>verdict</th></tr></thead><tbody>";
  for (const auto& c : j.conditions) {
    const char* css[] = {"good", "warn", "bad"};
    const char* words[] = {"met", "remark", "broken"};
    out +=
        fmt::format("<tr><td>{}</td><td>{}{}</td><td class=n>{}</td><td class=n>{} {}</td><td class={}>{}</td></tr>\n",
                    svg::html_escape(c.name), svg::html_escape(c.quantity),
                    c.unit.empty() ? ""
                                   : " [" +
                                         svg::html_escape(c.unit == "um"    ? "\u00b5m"
                                                          : c.unit == "deg" ? "\u00b0"
                                                                            : c.unit) +
                                         "]",
                    number(c.value, c.unit), c.at_least ? "\u2265" : "\u2264", number(c.limit, c.unit),
                    css[static_cast<int>(c.verdict)], words[static_cast<int>(c.verdict)]);
  }
  return out + "</tbody></table>";
}

std::string part_name(char part) {
  switch (part) {
    case 'F': return "flat";
    case 'R': return "arc";
    case 'S': return "straight";
    case 'I': return "involute";
    default: return "cylinder";
  }
}

/// A table that fits the sheet: ends of all parts and eight steps of the involute at even distances.
std::string profile_table(const bevel_gear::FingerProfile<double>& c) {
  std::string out =
      "<table class=small><thead><tr><th>part</th><th class=n>from tip</th><th class=n>diameter</th><th class=n>to "
      "axis</th></tr></thead><tbody>";
  const auto row = [&](const std::string& part, double x, double rho, double psi) {
    out +=
        fmt::format("<tr><td>{}</td><td class=n>{:.4f}</td><td class=n>{:.4f}</td><td class=n>{:.3f}\u00b0</td></tr>",
                    part, x + c.h_f, 2 * rho, degrees(psi));
  };
  row("A, end of the flat", -c.h_f, c.rho_o, kPi / 2);
  for (int k = 1; k <= 2; ++k) {
    const auto q = c.at(c.p_A + (c.p_B - c.p_A) * k / 3);
    row("arc", q.x, q.rho, std::atan2(q.sin_psi, q.cos_psi));
  }
  row("B, arc to straight", c.x_B, c.rho_B, c.phi);
  constexpr int kSteps = 11;
  for (int k = 0; k <= kSteps; ++k) {
    const auto q = c.flank(c.p_C + (c.p_D - c.p_C) * k / kSteps);
    row(k == 0        ? (c.law ? "C, straight to flank" : "C, straight to involute")
        : k == kSteps ? (c.law ? "D, flank to cylinder" : "D, involute to cylinder")
                      : (c.law ? "modified flank" : "involute"),
        q.x, q.rho, std::atan2(q.sin_psi, q.cos_psi));
  }
  return out + "</tbody></table>";
}

std::string tool_paragraph(const JudgedCutter& tool) {
  const auto& j = tool.judgement;
  std::string out = fmt::format(
      "<p><b>{}</b> (m<sub>nj</sub> {:.4f}, r<sub>t</sub> {:.4f}, h<sub>C</sub> {:.4f}, x<sub>D</sub> {:.4f}): <span "
      "class={}>{}</span></p>",
      svg::html_escape(tool.name), j.data.module_mm, j.data.tip_radius_mm, j.data.rack_depth_mm,
      j.data.profile_height_mm, j.usable() ? "good" : "bad", svg::html_escape(judgement_line(j)));
  for (const auto& c : j.conditions)
    if (c.verdict != bevel_gear::Verdict::met)
      out += fmt::format("<p class=note>{}: {}</p>", svg::html_escape(c.text()), svg::html_escape(c.meaning));
  return out;
}

}  // namespace

std::string judgement_line(const bevel_gear::CutterJudgement& j) {
  if (j.walls.empty()) return "not usable: the profile is impossible";
  std::string line = j.usable() ? "usable" : "not usable";
  line += fmt::format("; walls {:+.3f} .. {:+.3f} um against the designed gear (+: material left)",
                      1000 * j.deepest_mm(), 1000 * j.proudest_mm());
  line += j.small_end_overcut_mm > 0
              ? fmt::format("; over-cut at the small end {:.2f} um", 1000 * j.small_end_overcut_mm)
              : "; no over-cut at the small end";
  for (const auto& w : j.walls)
    if (w.missing > 0)
      line += fmt::format("; wall {} of half {} is not formed at {} of {} points", w.sigma > 0 ? "L" : "U", w.half + 1,
                          w.missing, w.missing + w.points);
  return line;
}

std::string cutter_csv(const bevel_gear::FingerProfile<double>& profile, double chord_mm) {
  std::string out = "part,p,from_tip,x,radius,diameter,inclination_deg,curvature\n";
  for (const auto& s : bevel_gear::sample_profile(profile, chord_mm))
    out += fmt::format("{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}\n", part_name(s.part), s.p,
                       s.from_tip, s.x, s.rho, 2 * s.rho, degrees(s.psi_rad), s.curvature);
  return out;
}

std::string cutter_sheet_html(const CutterSheet& sheet) {
  const auto& j = sheet.drawn.judgement;
  std::optional<bevel_gear::FingerProfile<double>> compared;
  if (!sheet.others.empty()) compared = sheet.others.front().judgement.profile;
  const double scale = cutter_drawing_scale(j.profile, sheet.length_mm, 104, 92);
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width\"><title>Finger mill {}</title><style>{}</style></head><body>\n",
      svg::html_escape(sheet.job_name), kCutterStyle);
  out += fmt::format(
      "<header><div><h1>Finger mill, {}</h1><p>{}</p><p>job {}; lengths in mm</p></div><div class=\"verdict "
      "{}\">{}</div></header>\n",
      svg::html_escape(sheet.drawn.name), svg::html_escape(sheet.gear_line), svg::html_escape(sheet.job_name),
      j.usable() ? "good" : "bad", j.usable() ? "all conditions met" : "not usable");
  out += "<div class=\"two top\"><div>" + cutter_svg(j.profile, sheet.length_mm, scale, compared, false);
  out += fmt::format(
      "<p class=note>Solid: {}.{} The contour turned about the axis is the cutting envelope of all "
      "edges.</p></div><div><h2>Order data</h2>",
      svg::html_escape(sheet.drawn.name),
      sheet.others.empty()
          ? ""
          : fmt::format(" Dashed: {}, on the same pitch line.", svg::html_escape(sheet.others.front().name)));
  out += order_table(j) + "</div></div>\n";
  out += "<div class=\"two low\"><div><h2>Conditions</h2>" + conditions_table(j) + "</div><div><h2>Profile</h2>" +
         profile_table(j.profile);
  out += fmt::format(
      "<p class=note>cutter.csv has the whole profile, cutter.dxf the contour 1:1 (chord error of the involute {:.2f} "
      "nm, outside the hollow flank).</p></div></div>\n",
      1e6 * sheet.dxf_chord_mm);
  out += fmt::format(
      "<section class=tools><h2>What mills leave on this gear</h2><p>{}: {}. Free space beside the mill {:.3f} mm at "
      "the small end, {:.3f} mm at the large end; both walls and the middle pass leave a ridge of about {:.2f} mm "
      "there.</p>\n",
      svg::html_escape(sheet.drawn.name), svg::html_escape(judgement_line(j)), j.free_width_small_mm,
      j.free_width_large_mm, j.ridge_mm);
  for (const auto& tool : sheet.others) out += tool_paragraph(tool);
  for (const auto& warning : sheet.warnings)
    out += fmt::format("<p class=\"note warn\">{}</p>", svg::html_escape(warning));
  return out + "</section></body></html>\n";
}

}  // namespace toothpath::sheet
