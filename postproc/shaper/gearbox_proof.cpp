#include "postproc/shaper/gearbox_proof.h"

#include <cmath>

#include <fmt/format.h>

#include "postproc/shaper/control.h"

namespace toothpath::shaper {
namespace {

constexpr double kTime = 2e-3;  // relative

/// The way of infeed slide and cutter: approach at rest, infeed with turning, a whole turn at full depth, retract.
struct Way {
  double infeed_min = 0, turn_min = 0;
  std::int64_t at_depth_from = 0, at_depth_to = 0;  ///< places of the cutter
  bool depth_reached = false;
};
Way way_of(const GearboxReading& r, const ShaperSetup& s, std::vector<std::string>& faults) {
  Way way;
  double x = NAN;
  const auto wrong = [&](int line, const char* what) { faults.push_back(fmt::format("line {}: {}", line, what)); };
  for (const auto& m : r.moves) {
    if (!std::isnan(x) && m.x_from_mm != x) wrong(m.line, "the infeed slide jumps");
    x = m.x_to_mm;
    if (m.cutter_to < m.cutter_from) wrong(m.line, "the cutter turns backwards");
    if (m.cutter_to == m.cutter_from) {
      if (std::min(m.x_from_mm, m.x_to_mm) < s.depth_mm - kPlace && m.x_to_mm < m.x_from_mm)
        wrong(m.line, "infeed without turning");
      continue;
    }
    if (m.x_to_mm > m.x_from_mm) wrong(m.line, "the infeed slide goes back while the cutter turns");
    const bool full = std::abs(m.x_from_mm) <= kPlace && std::abs(m.x_to_mm) <= kPlace;
    (full ? way.turn_min : way.infeed_min) += m.minutes;
    if (full) {
      if (!way.depth_reached) way.at_depth_from = m.cutter_from;
      way.depth_reached = true;
      way.at_depth_to = m.cutter_to;
    }
  }
  return way;
}

}  // namespace

std::vector<std::string> gearbox_program_faults(std::string_view text, const ShaperSetup& s) {
  const auto& box = *s.machine.gearbox;
  const auto r = shaper_control(s.machine).read(
      text, {box.cutter_axis, box.work_axis, box.relief_on, box.relief_off, box.pulses_per_turn});
  std::vector<std::string> faults = r.problems;
  const auto wrong = [&]<typename... A>(fmt::format_string<A...> format, A&&... a) {
    faults.push_back(fmt::format(format, std::forward<A>(a)...));
  };
  if (!r.ratio) {
    wrong("no coupling");
    return faults;
  }
  const auto [work, cutter] = *r.ratio;
  if (__int128{work} * s.work_teeth != __int128{cutter} * s.sense * s.cutter_teeth)
    wrong("coupling {}/{} is not {:+} times {}/{}", work, cutter, s.sense, s.cutter_teeth, s.work_teeth);
  const auto place = [&](const char* what, double is, double wanted) {
    if (std::abs(is - wanted) > kPlace) wrong("{} = {:.6f} mm, must be {:.6f} mm", what, is, wanted);
  };
  const auto near = [&](const char* what, double is, double wanted) {
    if (!(std::abs(is - wanted) <= kTime * wanted)) wrong("{} = {:.6f}, must be {:.6f}", what, is, wanted);
  };
  place("stroke start", r.stroke_start_mm, s.start_mm);
  place("stroke end", r.stroke_end_mm, s.end_mm);
  place("offset slide", r.slide_mm, s.slide_mm);
  near("strokes per minute", r.strokes_per_minute, s.strokes_set);
  const double clear = s.depth_mm + s.machine.relief_mm - 1e-9;
  if (r.clear_before_mm < clear) wrong("coupled at X = {:.4f} mm, inside {:.4f} mm", r.clear_before_mm, clear);
  if (r.clear_after_mm < clear) wrong("uncoupled at X = {:.4f} mm, inside {:.4f} mm", r.clear_after_mm, clear);

  const Way way = way_of(r, s, faults);
  if (!way.depth_reached) {
    wrong("full depth X = 0 is not reached");
    return faults;
  }
  // Work turn = cutter turn * ratio >= 360 deg, in whole numbers of 1e-6 deg.
  const __int128 turned = __int128{way.at_depth_to - way.at_depth_from} * std::abs(work),
                 needed = __int128{360000000} * cutter;
  if (turned < needed)
    wrong("at full depth the work turns {:.6f} deg, must be 360 or more",
          double(way.at_depth_to - way.at_depth_from) * 1e-6 * double(std::abs(work)) / double(cutter));
  near("minutes of the infeed", way.infeed_min, s.infeed_min);
  near("minutes at full depth", way.turn_min, s.generating_min);
  return faults;
}

}  // namespace toothpath::shaper
