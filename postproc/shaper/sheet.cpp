#include "postproc/shaper/sheet.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "geometry/base/angle.h"
#include "postproc/shaper/chart.h"
#include "postproc/shaper/control.h"

namespace toothpath::shaper {
namespace {

constexpr std::string_view kStyle =
    "@page{size:A4 portrait;margin:9mm}*{box-sizing:border-box}body{font:8.6pt/1.28 'Liberation "
    "Sans',Arial,sans-serif;color:#111;background:#fff;max-width:192mm;margin:0 "
    "auto;padding:2mm}h1{font-size:13pt;margin:0 0 1mm}h2{font-size:9.6pt;margin:2.2mm 0 .8mm;border-bottom:.3mm solid "
    "#111}p{margin:.6mm 0}ol{margin:0;padding-left:5.5mm}li{margin:.5mm "
    "0}b.v{font-size:9.6pt;white-space:nowrap}table{border-collapse:collapse;width:100%}td,th{border:.2mm solid "
    "#777;padding:.3mm "
    "1.2mm;text-align:right}th{background:#eee;font-weight:600}.l{text-align:left}.a{font-size:7pt;font-weight:700;"
    "color:#8a3b00;border:.2mm solid #8a3b00;padding:0 .7mm;border-radius:.6mm;white-space:nowrap}.k "
    "td:first-child{white-space:nowrap;width:1%}.w{border:.4mm solid #b00;padding:.8mm 1.6mm;margin:1mm "
    "0}.two{display:grid;grid-template-columns:1fr 1fr;gap:0 "
    "5mm}.box{display:inline-block;width:3.2mm;height:3.2mm;border:.3mm solid "
    "#111;margin-right:1mm;vertical-align:-.4mm}tr,li,.w{break-inside:avoid}@media screen and "
    "(max-width:700px){body{font-size:11pt;padding:3mm}.two{grid-template-columns:minmax(0,1fr)}.k,.two "
    "table{display:block;overflow-x:auto}b.v{white-space:normal}svg{max-width:100%;height:auto}}";

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? '?' : c;
    }
  }
  return out;
}

std::string value(double v, int decimals, const char* unit = "") {
  std::string text = fmt::format("{:.{}f}", v, decimals);
  if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
  return fmt::format("<b class=v>{}{}{}</b>", text, *unit ? "&nbsp;" : "", unit);
}
/// 253 or 62.5: a number as the name plate has it.
std::string shortest(double v) { return fmt::format("{}", v); }

/// The mark behind a value of the machine file whose key, or a table above or below it, is in the list of assumed keys.
std::string mark(const ShaperSetup& s, std::string_view key) {
  for (const auto& name : s.machine.assumed_keys) {
    const auto covers = [](std::string_view table, std::string_view inner) {
      return inner.substr(0, table.size()) == table && (inner.size() == table.size() || inner[table.size()] == '.');
    };
    if (covers(name, key) || covers(key, name)) return " <span class=a>assumed</span>";
  }
  return "";
}

std::string list_of(const std::vector<double>& numbers) {
  std::string out;
  for (const double n : numbers) out += (out.empty() ? "" : ", ") + shortest(n);
  return out;
}
std::string list_of(const std::vector<int>& numbers) {
  std::string out;
  for (const int n : numbers) out += fmt::format("{}{}", out.empty() ? "" : ", ", n);
  return out;
}

std::string gears_text(const GearTrain& train) {
  const auto& w = train.wheels;
  std::string out = fmt::format("<b class=v>a&nbsp;=&nbsp;{} &nbsp;b&nbsp;=&nbsp;{}", w[0], w[1]);
  if (w.size() == 4) out += fmt::format(" &nbsp;c&nbsp;=&nbsp;{} &nbsp;d&nbsp;=&nbsp;{}", w[2], w[3]);
  return out + "</b>";
}

std::string header(const ShaperSetup& s) {
  std::string out = fmt::format("<h1>Gear shaper set-up: {}</h1>\n", escaped(s.job_name));
  out += fmt::format(
      "<p>Machine: {} ({}) &middot; face gear {} teeth, face {} .. {} mm radius, tooth height {} &middot; cutter {} "
      "teeth, pitch diameter {}, serial number ____________</p>\n",
      escaped(s.machine.name), escaped(s.machine_file), s.work_teeth, shortest(s.inner_radius_mm),
      shortest(s.outer_radius_mm), value(s.depth_mm, 3, "mm"), s.cutter_teeth, value(s.pitch_diameter_mm, 3, "mm"));
  if (!s.machine.assumed_keys.empty())
    out +=
        "<p class=w><b>Values marked <span class=a>assumed</span> are not from this machine's name plate. Confirm each "
        "of them at the machine before cutting.</b></p>\n";
  for (const auto& warning : s.warnings) out += "<p class=w>Warning: " + escaped(warning) + "</p>\n";
  return out;
}

/// Long because it is the list of the sheet, step after step.
std::string steps(const ShaperSetup& s) {
  const auto step = [](const std::string& text) { return "<li><span class=box></span>" + text + "</li>\n"; };
  std::string out = "<h2>Steps</h2>\n<ol>\n";
  out += step(fmt::format("Mount cutter ({} teeth) and blank; check run-out. Cutter axis at 90&deg; to the gear axis.",
                          s.cutter_teeth));
  const char* toward = s.slide_mm > 0 ? ", towards +Y" : s.slide_mm < 0 ? ", towards -Y" : "";
  out += step(
      fmt::format("Offset slide E = {}{}. Angle of the offset with reference {} mm: {} if the reference lies along the "
                  "cutter axis (tan = E/L), {} if it is a radius (sin = E/&rho;). The slide value rules.",
                  value(s.slide_mm, 4, "mm"), toward, shortest(s.offset_reference_mm),
                  value(degrees(s.angle_tan_rad), 4, "&deg;"), value(degrees(s.angle_sin_rad), 4, "&deg;")));
  out += step(fmt::format(
      "Stroke length {} (face {} along the cutter axis and over-run {} at each end); from {} (outside) to {} (inside), "
      "from the foot of the common perpendicular. Longest stroke of the machine {} mm{}.",
      value(s.length_mm, 3, "mm"), value(s.face_mm, 3), value(s.shaping.over_run_mm, 3), value(s.start_mm, 3, "mm"),
      value(s.end_mm, 3, "mm"), shortest(s.machine.max_stroke_mm), mark(s, "stroke.max_length")));
  out += step(fmt::format(
      "Double strokes per minute {}: next lower step of {}{}; wanted {:.1f} for {} m/min ({}). Cutting speed then {} "
      "mean, {} peak.",
      value(s.strokes_set, s.strokes_set == std::floor(s.strokes_set) ? 0 : 2), list_of(s.machine.stroke_steps),
      mark(s, "stroke.steps"), s.strokes_wanted, shortest(s.shaping.cutting_speed_m_min),
      s.shaping.speed_basis == Shaping::SpeedBasis::mean ? "mean of the stroke" : "peak of a crank stroke",
      value(s.speed_mean_m_min, 2, "m/min"), value(s.speed_peak_m_min, 2, "m/min")));
  if (const auto& box = s.machine.gearbox)
    out += step(fmt::format(
        "Electronic gearbox{}: work axis {} follows cutter axis {}, work turns : cutter turns = {}{}/{}, exact whole "
        "numbers ({}). Lift on the back stroke by {}, off by {}.",
        mark(s, "gearbox"), box->work_axis, box->cutter_axis, s.sense < 0 ? "-" : "", s.generating.numerator,
        s.generating.denominator, shaper_control(s.machine).coupling_words, box->relief_on, box->relief_off));
  else
    out += step(
        fmt::format("Index gears {} &nbsp;(a/b&middot;c/d = {}/{} &times; {}/{} = {}/{}, exact; constant{}, wheels{}).",
                    gears_text(s.index_gears), s.machine.index_constant.numerator, s.machine.index_constant.denominator,
                    s.cutter_teeth, s.work_teeth, s.index_target.numerator, s.index_target.denominator,
                    mark(s, "index.constant"), mark(s, "gears.teeth")));
  if (s.machine.gearbox)
    out += step(
        fmt::format("Circular feed {} per double stroke on the cutter's pitch circle, as the program turns the cutter.",
                    value(s.circular_feed_set_mm, 5, "mm")));
  else
    out += step(fmt::format(
        "Feed gears {} &nbsp;for {:.6f} wanted (constant {}/{}{}): circular feed {} per double stroke on the cutter's "
        "pitch circle, wanted {}.",
        gears_text(s.feed_gears), s.feed_target, s.machine.feed_constant.numerator, s.machine.feed_constant.denominator,
        mark(s, "feed.constant"), value(s.circular_feed_set_mm, 5, "mm"), shortest(s.shaping.circular_feed_mm)));
  out += step(fmt::format(
      "Turning senses: {} (C_work/C_cutter = {}{}/{}). Cutter turns {} per double stroke, {:.1f} double strokes per "
      "cutter turn, {:.1f} per work turn. Try a few strokes clear of the work.",
      s.sense > 0 ? "cutter and work words of the same sign" : "cutter and work words of opposite sign",
      s.sense > 0 ? "+" : "-", s.generating.numerator, s.generating.denominator,
      value(degrees(s.cutter_per_stroke_rad), 6, "&deg;"), s.strokes_per_cutter_turn, s.strokes_per_work_turn));
  out += step(fmt::format(
      "Relief on the back stroke {}{}: lifted cutter stays {} clear of the finished flanks; from stock not yet cut {}.",
      value(s.machine.relief_mm, 3, "mm"), mark(s, "stroke.relief"), value(s.relief.flank_mm, 3, "mm"),
      value(s.relief.stock_mm, 3, "mm")));
  out +=
      step(fmt::format("Touch the tip surface of the blank with the cutter: infeed slide X = {}. Full depth is X = 0. "
                       "Radial infeed {} per double stroke, {} double strokes.",
                       value(s.depth_mm, 3, "mm"), value(s.infeed_per_stroke_mm, 5, "mm"), s.strokes_infeed));
  out +=
      step(fmt::format("At full depth stop the infeed and let the work make one whole turn ({} double strokes), then "
                       "withdraw. CNC shaper: shaper_program{} does the same; work offsets must be zero.",
                       s.strokes_turn, shaper_control(s.machine).extension));
  return out + "</ol>\n";
}

std::string pass_table(const ShaperSetup& s) {
  std::string out = fmt::format(
      "<div><h2>Passes and inspection</h2>\n<p>Arcs on the tip surface at radius {} after a whole turn at that "
      "depth.</p>\n<table><tr><th scope=col>double stroke<th scope=col>X mm<th scope=col>depth mm<th scope=col>time "
      "min<th scope=col>tooth mm<th scope=col>space mm</tr>\n",
      value(s.inspection_radius_mm, 3, "mm"));
  for (const auto& p : s.passes)
    out += fmt::format("<tr><td>{}<td>{:.3f}<td>{:.3f}<td>{:.2f}<td>{:.3f}<td>{:.3f}</tr>\n", p.stroke, p.x_mm,
                       p.depth_mm, p.minutes, p.tooth_thickness_mm, p.space_width_mm);
  out += fmt::format("<tr><td>{}<td>0.000<td>{:.3f}<td>{:.2f}<td class=l colspan=2>end of the turn</tr>\n",
                     s.strokes_total(), s.depth_mm, s.total_min());
  return out + "</table></div>\n";
}

std::string study_table(const ShaperSetup& s, const std::vector<FeedStudyRow>& study) {
  std::string out = fmt::format(
      "<div><h2>Time and error</h2>\n<p>Infeed {}, one turn {}, total {} without set-up.</p>\n<table><tr><th "
      "scope=col>circular "
      "feed mm<th scope=col>time min<th scope=col>left on flanks &micro;m, largest of {} "
      "places<th scope=col>rms</tr>\n",
      value(s.infeed_min, 2, "min"), value(s.generating_min, 2, "min"), value(s.total_min(), 2, "min"),
      study.empty() ? 0 : study.front().deviation.points);
  for (const auto& row : study)
    out += fmt::format("<tr><td>{:.4f}<td>{:.2f}<td>{:.3f}<td>{:.3f}</tr>\n", row.circular_feed_mm, row.minutes,
                       row.deviation.max_left_um, row.deviation.rms_um);
  return out + "</table>" + feed_study_charts(study, s.shaping.circular_feed_mm) +
         "<p>Simulated strokes with the cutter's involute against the exact flank; cutter without error.</p></div>\n";
}

std::string constants_table(const ShaperSetup& s) {
  const auto row = [](const std::string& name, const std::string& text, const std::string& m) {
    return fmt::format("<tr><td class=l>{}<td class=l>{}{}</tr>\n", name, text, m);
  };
  std::string out = "<h2>Machine values used</h2>\n<table class=k>\n";
  out += row("stroke steps, 1/min", list_of(s.machine.stroke_steps), mark(s, "stroke.steps"));
  if (s.machine.gearbox) {
    const auto& box = *s.machine.gearbox;
    std::string names = fmt::format("cutter {}, work {}, relief {} / {}", box.cutter_axis, box.work_axis, box.relief_on,
                                    box.relief_off);
    if (box.pulses_per_turn > 0) names += fmt::format(", {} pulses per cutter turn", box.pulses_per_turn);
    out += row("electronic gearbox", names, mark(s, "gearbox"));
  } else {
    out += row("index constant",
               fmt::format("{}/{}", s.machine.index_constant.numerator, s.machine.index_constant.denominator),
               mark(s, "index.constant"));
    out += row("feed constant",
               fmt::format("{}/{}", s.machine.feed_constant.numerator, s.machine.feed_constant.denominator),
               mark(s, "feed.constant"));
    out += row("change gears, each once", list_of(s.machine.gears), mark(s, "gears.teeth"));
    out += row("mesh margin, teeth", fmt::format("{}", s.machine.mesh_margin), mark(s, "gears.mesh_margin"));
  }
  out += row("relief, longest stroke, mm",
             fmt::format("{}, {}", shortest(s.machine.relief_mm), shortest(s.machine.max_stroke_mm)),
             mark(s, "stroke.relief"));
  std::string travels;
  for (const auto& [letter, axis] : s.machine.axes) {
    const double unit = letter == 'A' || letter == 'C' ? 180 / kPi : 1;
    travels +=
        fmt::format("{}{} {:.10g} .. {:.10g}", travels.empty() ? "" : "; ", letter, axis.min * unit, axis.max * unit);
    if (unit != 1) travels += fmt::format(" (sign {:+})", axis.sign);
  }
  out += row("axis ranges, mm, deg", travels, mark(s, "axes"));
  out += "</table>\n";
  if (!s.machine.assumed_keys.empty()) {
    std::string names;
    for (const auto& name : s.machine.assumed_keys) names += (names.empty() ? "" : ", ") + escaped(name);
    out += "<p>Assumed keys of the machine file: " + names + ".</p>\n";
  }
  return out;
}

}  // namespace

std::vector<double> compared_feeds(const ShaperSetup& s) {
  std::vector<double> feeds;
  for (const double factor : {0.5, 1.0, 2.0, 4.0, 8.0}) {
    const double feed = factor * s.shaping.circular_feed_mm;
    if (factor == 1 || feed < kPi * s.pitch_diameter_mm / s.cutter_teeth / 4) feeds.push_back(feed);
  }
  return feeds;
}

std::string shaper_html(const ShaperSetup& s, const std::vector<FeedStudyRow>& study) {
  std::string out =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>Gear shaper set-up: " +
      escaped(s.job_name) + "</title>\n<style>" + std::string(kStyle) + "</style></head><body>\n";
  out += header(s) + steps(s);
  out += "<div class=two>\n" + pass_table(s) + study_table(s, study) + "</div>\n";
  out += constants_table(s);
  return out + "</body></html>\n";
}

}  // namespace toothpath::shaper
