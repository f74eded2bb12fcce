#include "postproc/shaper/setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/base/angle.h"
#include "postproc/shaper/control.h"

namespace toothpath::shaper {
namespace {

/// Quotients of decimal numbers that are whole on paper must not be rounded up because of their last bits.
constexpr double kQuotientSlack = 1e-12;
/// Longest program that is written: 4 blocks each.
constexpr double kMaxDoubleStrokes = 500000;

int ceil_quotient(double a, double b) { return static_cast<int>(std::ceil(a / b * (1 - kQuotientSlack))); }

using Refusals = std::vector<Refusal>;
template <typename... Args>
void refuse(Refusals& list, std::string key, fmt::format_string<Args...> text, Args&&... args) {
  list.push_back({std::move(key), fail(text, std::forward<Args>(args)...)});
}

/// What the straight stroke and the formulas of the set-up cannot do.
void check_kind(const ShaperWork& work, Refusals& refusals) {
  const auto& gear = work.gear;
  if (gear.zones.size() != 1)
    refuse(refusals, "gear.zone[1]", "{} zones: a straight-stroke shaper set-up is for one zone; shape them one by one",
           gear.zones.size());
  for (std::size_t k = 0; k < gear.zones.size(); ++k)
    if (gear.zones[k].helix_angle_rad != 0)
      refuse(refusals, fmt::format("gear.zone[{}].helix_angle", k),
             "helix_angle = {:.4f} deg: a helix needs a helical guide, the straight stroke cuts 0 only",
             degrees(gear.zones[k].helix_angle_rad));
  if (std::abs(gear.shaft_angle_rad - kPi / 2) > 1e-12)
    refuse(refusals, "gear.shaft_angle", "shaft_angle = {:.4f} deg: the stroke of this set-up is for 90 deg",
           degrees(gear.shaft_angle_rad));
  const auto& s = work.shaping;
  const auto positive = [&](const char* key, double value) {
    if (!(value > 0)) refuse(refusals, fmt::format("shaping.{}", key), "{} = {} must be above 0", key, value);
  };
  positive("cutting_speed", s.cutting_speed_m_min);
  positive("circular_feed", s.circular_feed_mm);
  positive("radial_feed", s.radial_feed_mm);
  if (!(s.over_run_mm >= 0)) refuse(refusals, "shaping.over_run", "over_run = {} must not be below 0", s.over_run_mm);
  if (!gear.zones.empty()) {
    const auto tip = face_gear::check_shaper(gear, gear.zones[0].helix_angle_rad);
    if (!tip) refuse(refusals, "gear.shaper_tip_radius", "{}", tip.error().message);
    if (!(gear.zones[0].inner_radius_mm > std::abs(gear.offset_mm)))
      refuse(refusals, "gear.zone[0].inner_radius", "inner_radius = {:.4f} must exceed the offset {:.4f}",
             gear.zones[0].inner_radius_mm, std::abs(gear.offset_mm));
  }
}

void set_offset(ShaperSetup& s, Refusals& refusals) {
  switch (s.shaping.offset_reference) {
    case Shaping::OffsetReference::outer_radius: s.offset_reference_mm = s.outer_radius_mm; break;
    case Shaping::OffsetReference::mean_radius:
      s.offset_reference_mm = (s.inner_radius_mm + s.outer_radius_mm) / 2;
      break;
    case Shaping::OffsetReference::given: s.offset_reference_mm = s.shaping.offset_reference_mm; break;
  }
  const double E = s.slide_mm, L = s.offset_reference_mm;
  if (!(L > 0) || std::abs(E) > L) {
    refuse(refusals, "shaping.offset_reference", "offset_reference = {:.4f} must be at least the offset {:.4f}", L,
           std::abs(E));
    return;
  }
  s.angle_tan_rad = std::atan(E / L);
  s.angle_sin_rad = std::asin(E / L);
}

void set_stroke(ShaperSetup& s, Refusals& refusals) {
  const double E = s.slide_mm, o = s.shaping.over_run_mm;
  const double L_in = std::sqrt((s.inner_radius_mm - E) * (s.inner_radius_mm + E));
  const double L_out = std::sqrt((s.outer_radius_mm - E) * (s.outer_radius_mm + E));
  s.face_mm = L_out - L_in;
  s.start_mm = L_out + o;
  s.end_mm = L_in - o;
  s.length_mm = s.start_mm - s.end_mm;
  if (!(s.length_mm <= s.machine.max_stroke_mm))
    refuse(refusals, "shaping.over_run",
           "stroke = {:.4f} mm (face {:.4f} and twice the over-run {:.4f}) exceeds {:.4f}, the longest stroke of {}",
           s.length_mm, s.face_mm, o, s.machine.max_stroke_mm, s.machine.name);
  if (!(s.end_mm > -L_in))
    refuse(refusals, "shaping.over_run",
           "over_run = {:.4f} drives the stroke through the teeth on the far side; limit {:.4f}", o, 2 * L_in);
}

void set_speed(ShaperSetup& s, Refusals& refusals) {
  const double v = s.shaping.cutting_speed_m_min, l = s.length_mm;
  const bool mean = s.shaping.speed_basis == Shaping::SpeedBasis::mean;
  s.strokes_wanted = 1000 * v / ((mean ? 2 : kPi) * l);
  double lowest = 0;
  for (const double step : s.machine.stroke_steps) {
    if (step <= s.strokes_wanted * (1 + kQuotientSlack)) s.strokes_set = std::max(s.strokes_set, step);
    lowest = lowest == 0 ? step : std::min(lowest, step);
  }
  if (s.strokes_set <= 0) {
    refuse(refusals, "shaping.cutting_speed",
           "cutting_speed = {:.4f} m/min asks for {:.4f} strokes/min, below {:.4f}, the slowest step of {}", v,
           s.strokes_wanted, lowest, s.machine.name);
    return;
  }
  s.speed_mean_m_min = 2 * l * s.strokes_set / 1000;
  s.speed_peak_m_min = kPi * l * s.strokes_set / 1000;
}

void set_generating(ShaperSetup& s, Refusals& refusals) {
  s.generating = reduced({s.cutter_teeth, s.work_teeth});
  s.sense = s.machine.axes.at('A').sign * s.machine.axes.at('C').sign;
  const double s_c = s.shaping.circular_feed_mm, around = kPi * s.pitch_diameter_mm;
  s.cutter_per_stroke_rad = 2 * kPi * s_c / around;
  s.strokes_per_cutter_turn = around / s_c;
  s.strokes_per_work_turn = s.strokes_per_cutter_turn * s.work_teeth / s.cutter_teeth;
  const double infeed = s.depth_mm / s.shaping.radial_feed_mm;
  if (!(s.strokes_per_work_turn + infeed <= kMaxDoubleStrokes)) {
    refuse(refusals, s.strokes_per_work_turn > infeed ? "shaping.circular_feed" : "shaping.radial_feed",
           "{:.0f} double strokes in all exceed {:.0f}; a larger feed is needed", s.strokes_per_work_turn + infeed,
           kMaxDoubleStrokes);
    return;
  }
  s.strokes_turn = static_cast<int>(std::ceil(s.strokes_per_work_turn));
  s.strokes_infeed = ceil_quotient(s.depth_mm, s.shaping.radial_feed_mm);
  s.infeed_per_stroke_mm = s.depth_mm / s.strokes_infeed;
  if (s.strokes_turn < s.work_teeth)
    refuse(refusals, "shaping.circular_feed", "circular_feed = {:.4f} mm is more than one tooth a stroke ({:.4f})", s_c,
           around / s.cutter_teeth);
}

void set_gears(ShaperSetup& s, Refusals& refusals) {
  const auto& m = s.machine;
  if (m.gearbox) {  // the control couples by the ratio itself, and turns as asked
    s.index_target = s.generating;
    s.feed_target = s.shaping.circular_feed_mm / s.pitch_diameter_mm;
    s.circular_feed_set_mm = s.shaping.circular_feed_mm;
    if (const auto& control = shaper_control(m); control.accepts)
      if (const auto fits = control.accepts(m, s.cutter_teeth, s.work_teeth); !fits)
        refuse(refusals, "gear.shaper_teeth", "{}", fits.error().message);
    return;
  }
  const WheelSet wheels{m.gears, m.mesh_margin};
  s.index_target = reduced({m.index_constant.numerator * s.cutter_teeth, m.index_constant.denominator * s.work_teeth});
  auto index = exact_train(wheels, s.index_target);
  if (!index) {
    const auto nearest = nearest_train(wheels, s.index_target.value());
    const std::string hint =
        nearest ? fmt::format("the nearest is {} = {:.9f}, {:+.3g} relative: never used", nearest->text(),
                              nearest->ratio().value(), nearest->ratio().value() / s.index_target.value() - 1)
                : std::string("the machine has fewer than two wheels");
    refuse(refusals, "gear.shaper_teeth", "no exact index gears for {}/{} = {:.9f} among the {} wheels of {}; {}",
           s.index_target.numerator, s.index_target.denominator, s.index_target.value(), m.gears.size(), m.name, hint);
    return;
  }
  s.index_gears = *index;
  s.feed_target = m.feed_constant.value() * s.shaping.circular_feed_mm / s.pitch_diameter_mm;
  const auto feed = nearest_train(without(wheels, s.index_gears), s.feed_target);
  if (!feed) {
    refuse(refusals, "machine.file", "no two wheels are left for the feed after the index gears {}",
           s.index_gears.text());
    return;
  }
  s.feed_gears = *feed;
  s.circular_feed_set_mm = s.pitch_diameter_mm * feed->ratio().value() / m.feed_constant.value();
  const double off = s.circular_feed_set_mm / s.shaping.circular_feed_mm - 1;
  if (std::abs(off) > 0.05)
    s.warnings.push_back(
        fmt::format("the nearest feed gears give {:.5f} mm per double stroke, {:+.1f} % off the wanted {:.5f}",
                    s.circular_feed_set_mm, 100 * off, s.shaping.circular_feed_mm));
}

/// Every position of the program against the travels.
void check_travel(const ShaperSetup& s, Refusals& refusals) {
  const auto need = [&](char axis, double lo, double hi, const char* key, double unit) {
    const machines::ShaperAxis& a = s.machine.axes.at(axis);
    if (lo < a.min || hi > a.max)
      refuse(refusals, key, "axis {} needs {:.4f} .. {:.4f}, outside {:.4f} .. {:.4f} of {}", axis, lo * unit,
             hi * unit, a.min * unit, a.max * unit, s.machine.name);
  };
  need('X', 0, s.depth_mm + s.machine.relief_mm, "machine.file", 1);
  need('Y', s.slide_mm, s.slide_mm, "gear.offset", 1);
  need('Z', s.end_mm, s.start_mm, "gear.zone[0].outer_radius", 1);
  const auto last = angles_after_stroke(s, s.strokes_total());
  const double A = radians(double(last.cutter) * 1e-5), C = radians(double(last.work) * 1e-5), deg = 180 / kPi;
  need('A', std::min(0.0, A), std::max(0.0, A), "machine.file", deg);
  need('C', std::min(0.0, C), std::max(0.0, C), "machine.file", deg);
  if (s.machine.gearbox) {
    const double ram = kPi * s.length_mm * s.strokes_set, limit = s.machine.axes.at('Z').max_speed;
    if (ram > limit)
      refuse(refusals, "shaping.cutting_speed",
             "at {:.4f} double strokes/min the ram needs {:.4f} mm/min at its peak, limit {:.4f} of {}", s.strokes_set,
             ram, limit, s.machine.name);
    return;
  }
  const auto choice = choose_timing(s);
  if (choice.least > 1)
    refuse(refusals, "shaping.cutting_speed",
           "at {:.4f} double strokes/min axis {} is too slow: the axes need {:.4f} of the time of one double stroke, "
           "limit 1",
           s.strokes_set, choice.axis, choice.least);
}

void set_passes(ShaperSetup& s) {
  s.inspection_radius_mm = (s.inner_radius_mm + s.outer_radius_mm) / 2;
  int before = 0;
  for (const double part : {0.25, 0.5, 0.75, 0.9, 1.0}) {
    const int stroke = std::max(1, static_cast<int>(std::ceil(part * s.strokes_infeed - 1e-9)));
    if (stroke == before) continue;
    before = stroke;
    ShaperPass pass;
    pass.stroke = stroke;
    pass.x_mm = s.x_at_stroke(stroke);
    pass.depth_mm = s.depth_mm - pass.x_mm;
    pass.minutes = stroke / s.strokes_set;
    if (const auto arcs = tip_arcs_at_depth(s.surface, s.inspection_radius_mm, pass.x_mm)) {
      pass.tooth_thickness_mm = arcs->tooth_mm;
      pass.space_width_mm = arcs->space_mm;
    }
    s.passes.push_back(pass);
  }
}

/// round(numerator/denominator), halves away from zero; both positive.
std::int64_t rounded_quotient(__int128 numerator, __int128 denominator) {
  return static_cast<std::int64_t>((2 * numerator + denominator) / (2 * denominator));
}

}  // namespace

double ShaperSetup::x_at_stroke(int j) const {
  return j >= strokes_infeed ? 0.0 : depth_mm * (strokes_infeed - j) / strokes_infeed;
}

ShaperAngles angles_after_stroke(const ShaperSetup& s, std::int64_t j) {
  constexpr std::int64_t kTurn = 36000000;  // 360 deg in 1e-5 deg
  ShaperAngles at;
  at.work = s.sense * rounded_quotient(__int128{kTurn} * j, s.strokes_turn);
  at.cutter = rounded_quotient(__int128{kTurn} * j * s.work_teeth, __int128{s.cutter_teeth} * s.strokes_turn);
  return at;
}

TimingChoice choose_timing(const ShaperSetup& s) {
  const auto speed = [&](char axis) { return s.machine.axes.at(axis).max_speed; };
  const double n = s.strokes_set, per_stroke_work = 2 * kPi / s.strokes_turn;
  const double per_stroke_cutter = per_stroke_work * s.work_teeth / s.cutter_teeth;
  // Words are rounded: a step of the angle may be one unit of the last digit longer.
  const double unit = radians(1e-5);
  const std::array<std::pair<double, const char*>, 3> cutting = {{{s.length_mm / speed('Z'), "Z"},
                                                                  {(per_stroke_cutter + unit) / speed('A'), "A"},
                                                                  {(per_stroke_work + unit) / speed('C'), "C"}}};
  const auto slowest =
      *std::max_element(cutting.begin(), cutting.end(), [](const auto& p, const auto& q) { return p.first < q.first; });
  // Parts of the double stroke that the axes need at least.
  const double cut = slowest.first * n, lift = s.machine.relief_mm / speed('X') * n,
               back = s.length_mm / speed('Z') * n;
  const double approach = (s.machine.relief_mm + s.infeed_per_stroke_mm) / speed('X') * n;
  TimingChoice choice;
  choice.least = cut + lift + back + approach;
  choice.axis = cut >= back ? slowest.second : "Z";
  if (lift + approach > cut + back) choice.axis = "X";
  constexpr StrokeTiming kUsual{0.5, 0.05, 0.4, 0.05};
  if (cut <= kUsual.cutting && lift <= kUsual.lift && back <= kUsual.back && approach <= kUsual.approach) {
    choice.timing = kUsual;
  } else {
    choice.timing = {cut / choice.least, lift / choice.least, back / choice.least, approach / choice.least};
  }
  return choice;
}

Expected<ShaperSetup, std::vector<Refusal>> plan_shaper_setup(const ShaperWork& work,
                                                              const machines::ShaperMachine& machine) {
  Refusals refusals;
  check_kind(work, refusals);
  if (!refusals.empty()) return refusals;
  ShaperSetup s;
  s.job_name = work.job_name;
  s.machine_file = work.machine_file;
  s.machine = machine;
  s.shaping = work.shaping;
  const auto& zone = work.gear.zones.front();
  s.surface = face_gear::make_surface<double>(work.gear, zone.helix_angle_rad);
  s.inner_radius_mm = zone.inner_radius_mm;
  s.outer_radius_mm = zone.outer_radius_mm;
  s.depth_mm = (2 * work.gear.addendum_coefficient + work.gear.clearance_coefficient) * work.gear.module_mm;
  s.cutter_teeth = work.gear.shaper_teeth;
  s.work_teeth = work.gear.teeth;
  s.pitch_diameter_mm = s.surface.shaper.m_t * work.gear.shaper_teeth;
  s.slide_mm = work.gear.offset_mm;
  set_offset(s, refusals);
  set_stroke(s, refusals);
  set_speed(s, refusals);
  set_generating(s, refusals);
  set_gears(s, refusals);
  if (refusals.empty()) check_travel(s, refusals);
  if (!refusals.empty()) return refusals;
  s.infeed_min = s.strokes_infeed / s.strokes_set;
  s.generating_min = s.strokes_turn / s.strokes_set;
  set_passes(s);
  s.relief = back_stroke_clearance(s, machine.relief_mm);
  if (s.relief.flank_mm <= 0)
    s.warnings.push_back(
        fmt::format("the lifted cutter rubs on the finished flanks by {:.4f} mm on the back stroke: {:.4f} mm of "
                    "relief are too little",
                    -s.relief.flank_mm, machine.relief_mm));
  if (s.relief.stock_mm <= 0)
    s.warnings.push_back(
        fmt::format("on the back stroke the lifted cutter touches stock of the next stroke by {:.4f} mm; more relief "
                    "or a smaller circular feed spares its edge",
                    -s.relief.stock_mm));
  return s;
}

}  // namespace toothpath::shaper
