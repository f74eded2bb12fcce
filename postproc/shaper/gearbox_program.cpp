#include "postproc/shaper/gearbox_program.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <string_view>

#include "geometry/base/angle.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::shaper {
namespace {

constexpr std::int64_t kMostTurnsT = 1000, kMostTurnsL = 21;       // Fanuc G81.5 T and L
constexpr std::int64_t kMostPulses = 999999999, kMostDegrees = 99999;  // Fanuc G81.5 P, and C with three decimals in eight digits

struct Numbers {
  int length_decimals, angle_decimals;
  bool point;
  [[nodiscard]] std::string text(double value, int decimals) const {
    std::string out;
    numbers::append_fixed(out, numbers::to_fixed(value, decimals), decimals, point);
    return out;
  }
  [[nodiscard]] std::string length(double mm) const { return text(mm, length_decimals); }
  /// Never less than asked: clear heights.
  [[nodiscard]] std::string length_up(double mm) const {
    std::string out;
    const double scale = std::pow(10.0, length_decimals);
    numbers::append_fixed(out, static_cast<std::int64_t>(std::ceil(mm * scale - 1e-6)), length_decimals, point);
    return out;
  }
  [[nodiscard]] std::string feed(double value) const { return text(value, point ? 3 : 5); }
};

bool siemens(const machines::ShaperMachine& m) { return m.dialect == "siemens"; }

std::string comment(const machines::ShaperMachine& m, std::string_view text) {
  std::string out = siemens(m) ? "; " : "(";
  for (const char c : text.substr(0, 70)) {
    if (c == '(' || c == ')') out += c == '(' ? '[' : ']';
    else if (c >= 'a' && c <= 'z') out += static_cast<char>(c - 'a' + 'A');
    else out += c >= ' ' && c <= '~' && c != ';' && c != '%' ? c : '?';
  }
  return out + (siemens(m) ? "\n" : ")\n");
}

/// The cutter's angle after a share of the way through double stroke counts, in units of the last printed digit, rounded upwards so that the
/// whole turn is never short; from whole numbers.
std::int64_t cutter_units(const ShaperSetup& s, std::int64_t strokes_times, std::int64_t strokes_of, int decimals) {
  const __int128 numerator = __int128{360} * numbers::power_of_ten(decimals) * s.work_teeth * strokes_times;
  const __int128 denominator = __int128{s.cutter_teeth} * s.strokes_turn * strokes_of;
  return static_cast<std::int64_t>((numerator + denominator - 1) / denominator);
}

class Writer {
 public:
  explicit Writer(const ShaperSetup& s)
      : s_(s), m_(s.machine), box_(*s.machine.gearbox), n_(siemens(m_) ? Numbers{5, 6, false} : Numbers{3, 3, true}) {}

  std::string run() {
    header();
    const double clear = s_.depth_mm + m_.relief_mm;
    const std::string slow = n_.feed(std::min(kApproachFeed, m_.axes.at('X').max_speed));
    out_ += comment(m_, "clear first, then offset slide, then ram and turns");
    line(siemens(m_) ? "SUPA G0 X" + n_.length_up(clear) + " D0" : "G53 G0 X" + n_.length_up(clear));
    line("G0 Y" + n_.length(s_.slide_mm));
    line("G0 Z" + n_.length(s_.start_mm));
    if (siemens(m_)) line("G0 " + box_.cutter_axis + "=0 " + box_.work_axis + "=0");
    else line("G0 " + box_.cutter_axis + "0. " + box_.work_axis + "0.");
    couple();
    stroke_on();
    line("G1 X" + n_.length(s_.depth_mm) + " F" + slow);
    infeed();
    turn();
    stroke_off();
    line("G1 X" + n_.length_up(clear) + " F" + slow);
    if (siemens(m_)) {
      line("EGOFS(" + box_.work_axis + ")");
      line("EGDEL(" + box_.work_axis + ")");
      line("M30");
    } else {
      line("G80.5 " + box_.work_axis + "0.");
      line("M30");
      out_ += "%\n";
    }
    return std::move(out_);
  }

 private:
  void line(const std::string& text) { out_ += text + "\n"; }

  void header() {
    if (siemens(m_)) {
      out_ += comment(m_, s_.job_name);
      line("G17 G40 G90 G94 G710 G64 G500");
    } else {
      line("%");
      std::string name = comment(m_, std::string_view(s_.job_name).substr(0, 30));
      out_ += "O2001 " + name;
      line("G21 G17 G90 G94 G40 G49 G80 G69");
    }
    out_ += comment(m_, "gear shaper with electronic gearbox, machine " + m_.name);
    for (const auto& name : m_.assumed_keys) out_ += comment(m_, "assumed, confirm before cutting: " + name);
    out_ += comment(m_, "all words are machine coordinates: no work offset may be active");
    out_ += comment(m_, fmt::format("cutter {} teeth, work {} teeth, sense {:+}", s_.cutter_teeth, s_.work_teeth, s_.sense));
    out_ += comment(m_, fmt::format("{} double strokes/min, {} infeed, {} one turn", s_.strokes_set, s_.strokes_infeed, s_.strokes_turn));
  }

  /// At rest, with the cutter clear of the work.
  void couple() {
    const auto g = std::gcd(std::int64_t{s_.cutter_teeth}, std::int64_t{s_.work_teeth});
    const std::int64_t top = s_.cutter_teeth / g, bottom = s_.work_teeth / g;  // work turns over cutter turns
    const char* sign = s_.sense < 0 ? "-" : "";
    if (siemens(m_)) {
      line(fmt::format("EGDEF({},{},1)", box_.work_axis, box_.cutter_axis));
      line(fmt::format("EGON({},\"FINE\",{},{}{},{})", box_.work_axis, box_.cutter_axis, sign, top, bottom));
    } else if (bottom <= kMostTurnsT && top <= kMostTurnsL) {
      line(fmt::format("G81.5 T{} {}0. L{}{}", bottom, box_.work_axis, sign, top));
    } else {
      line(fmt::format("G81.5 P{} {}{}{}.", bottom * box_.pulses_per_turn, box_.work_axis, sign, 360 * top));
    }
  }

  void stroke_on() {
    line(box_.relief_on);
    const double speed = 2 * s_.length_mm * s_.strokes_set;  // mean speed, mm/min
    if (siemens(m_)) {
      line("OSP1[Z]=" + n_.length(s_.start_mm) + " OSP2[Z]=" + n_.length(s_.end_mm));
      line("FA[Z]=" + n_.feed(speed) + " OSCTRL[Z]=(1,0) OSE[Z]=" + n_.length(s_.start_mm));
      line("OS[Z]=1");
    } else {
      // Q from the printed start to the printed end.
      const auto from = numbers::to_fixed(s_.start_mm, n_.length_decimals), to = numbers::to_fixed(s_.end_mm, n_.length_decimals);
      std::string q;
      numbers::append_fixed(q, to - from, n_.length_decimals, true);
      line("G81.1 Z" + n_.length(s_.start_mm) + " Q" + q + " R0. F" + n_.feed(speed));
    }
  }

  void stroke_off() {
    if (siemens(m_)) {
      line("OS[Z]=0");
      line("WAITP(Z)");
    } else {
      line("G80");
    }
    line(box_.relief_off);
  }

  [[nodiscard]] std::string cutter_word(std::int64_t units) const {
    std::string out = siemens(m_) ? box_.cutter_axis + "=" : box_.cutter_axis;
    numbers::append_fixed(out, units, n_.angle_decimals, n_.point);
    return out;
  }

  void infeed() {
    const int parts = std::max(1, static_cast<int>(std::ceil(s_.infeed_min)));
    out_ += comment(m_, "infeed while cutter and work turn");
    for (int k = 1; k <= parts; ++k)
      line("G93 G1 X" + n_.length(s_.depth_mm * (parts - k) / parts) + " " +
           cutter_word(cutter_units(s_, std::int64_t{s_.strokes_infeed} * k, parts, n_.angle_decimals)) + " F" + n_.feed(parts / s_.infeed_min));
  }

  void turn() {
    out_ += comment(m_, "one turn of the work at full depth");
    const auto end = cutter_units(s_, std::int64_t{s_.strokes_total()}, 1, n_.angle_decimals) + 1;
    const double way = degrees(2 * kPi) * s_.work_teeth / s_.cutter_teeth;
    line("G94 G1 " + cutter_word(end) + " F" + n_.feed(way / s_.generating_min));
  }

  const ShaperSetup& s_;
  const machines::ShaperMachine& m_;
  const machines::ElectronicGearbox& box_;
  Numbers n_;
  std::string out_;
};

}  // namespace

const char* shaper_program_extension(const machines::ShaperMachine& machine) {
  return machine.dialect == "siemens" ? ".mpf" : machine.dialect == "fanuc" ? ".nc" : ".ngc";
}

Status check_gearbox(const machines::ShaperMachine& machine, int cutter_teeth, int work_teeth) {
  if (!machine.gearbox || machine.dialect != "fanuc") return Ok{};
  const std::int64_t g = std::gcd(cutter_teeth, work_teeth), top = cutter_teeth / g, bottom = work_teeth / g;
  if (bottom <= kMostTurnsT && top <= kMostTurnsL) return Ok{};
  const std::int64_t pulses = bottom * machine.gearbox->pulses_per_turn, turned = 360 * top;
  if (pulses > kMostPulses)
    return fail("the ratio {}/{} needs P = {} pulses for {} turns of the cutter axis, G81.5 of {} takes {}", top, bottom, pulses, bottom, machine.name,
                kMostPulses);
  if (turned > kMostDegrees)
    return fail("the ratio {}/{} needs C = {} deg for {} turns of the work, G81.5 of {} takes {}", top, bottom, turned, top, machine.name, kMostDegrees);
  return Ok{};
}

std::string shaper_gearbox_text(const ShaperSetup& setup) {
  assert(setup.machine.gearbox);
  return Writer(setup).run();
}

}  // namespace toothpath::shaper
