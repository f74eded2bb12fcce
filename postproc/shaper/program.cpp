#include "postproc/shaper/program.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "geometry/base/angle.h"
#include "postproc/numbers/comment.h"

namespace toothpath::shaper {
namespace {

constexpr int kLengthDecimals = 5;

/// Fixed decimals without the zeros at the end and without a negative zero.
std::string number(double value, int decimals) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text == "-0" ? "0" : text;
}
std::string length(double mm) { return number(mm, kLengthDecimals); }

/// 1e-5 deg as deg, without ever being a floating-point number.
std::string angle(std::int64_t units) {
  const std::int64_t u = std::abs(units);
  std::string text = fmt::format("{}{}.{:05}", units < 0 ? "-" : "", u / 100000, u % 100000);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

/// What may stand between parentheses: printable ASCII in upper case.
std::string comment(std::string_view text) { return "(" + numbers::comment_text(text).substr(0, 200) + ")\n"; }

void write_header(std::string& out, const ShaperSetup& s) {
  out += comment(fmt::format("{} - gear shaper, explicit strokes", s.job_name));
  out += comment(fmt::format("machine {}", s.machine.name));
  for (const auto& name : s.machine.assumed_keys) out += comment("assumed, confirm before cutting: " + name);
  out += comment("all words are machine coordinates: the active work offset must be zero in every axis");
  out += comment(fmt::format("x infeed, 0 = full depth {}   y offset {}   z stroke {} .. {}", length(s.depth_mm),
                             length(s.slide_mm), length(s.start_mm), length(s.end_mm)));
  out +=
      comment(fmt::format("a cutter {} teeth   c work {} teeth   sense {:+}", s.cutter_teeth, s.work_teeth, s.sense));
  out += comment(fmt::format("double strokes {} infeed + {} one turn, {} per minute", s.strokes_infeed, s.strokes_turn,
                             number(s.strokes_set, 6)));
}

}  // namespace

std::string shaper_program_text(const ShaperSetup& s) {
  const StrokeTiming part = choose_timing(s).timing;
  const auto rate = [&](double share) { return number(s.strokes_set / share, 6); };
  const std::string f_cut = rate(part.cutting), f_lift = rate(part.lift), f_back = rate(part.back),
                    f_approach = rate(part.approach);
  const std::string start = length(s.start_mm), end = length(s.end_mm);
  const double relief = s.machine.relief_mm, clear = s.depth_mm + relief;
  // Rounded upwards, so that the rapids stay at or above the depth in the last digit too.
  const double scale = std::pow(10, kLengthDecimals);
  const std::string x_clear = length(std::ceil(clear * scale - 1e-6) / scale);
  const std::string slow = number(std::min(kApproachFeed, s.machine.axes.at('X').max_speed), 6);

  std::string out;
  out.reserve(128 * static_cast<std::size_t>(s.strokes_total()) + 4096);
  out += "G21 G17 G90 G94 G40 G49 G80\n";
  write_header(out, s);
  out += comment("infeed slide clear first, then offset slide, then stroke and turns");
  out += fmt::format("G53 G0 X{}\n", x_clear);
  out += fmt::format("G0 Y{}\n", length(s.slide_mm));
  out += fmt::format("G0 Z{}\n", start);
  out += "G0 A0 C0\n";
  out += fmt::format("G1 X{} F{}\n", length(s.x_at_stroke(1)), slow);
  out += "G93\n";
  auto to = std::back_inserter(out);
  for (int j = 1; j <= s.strokes_total(); ++j) {
    if (j == 1) out += comment("infeed");
    if (j == s.strokes_infeed + 1) out += comment("one turn at full depth");
    const ShaperAngles at = angles_after_stroke(s, j);
    const double x = s.x_at_stroke(j);
    fmt::format_to(to, "G1 Z{} A{} C{} F{}\n", end, angle(at.cutter), angle(at.work), f_cut);
    fmt::format_to(to, "G1 X{} F{}\n", length(x + relief), f_lift);
    fmt::format_to(to, "G1 Z{} F{}\n", start, f_back);
    fmt::format_to(to, "G1 X{} F{}\n", length(s.x_at_stroke(j + 1)), f_approach);
  }
  out += comment(fmt::format("{} double strokes done: clear of the work", s.strokes_total()));
  out += fmt::format("G94\nG1 X{} F{}\n", x_clear, slow);
  out += "M2\n";
  return out;
}

}  // namespace toothpath::shaper
