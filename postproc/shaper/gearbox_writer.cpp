#include "postproc/shaper/gearbox_writer.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "geometry/base/angle.h"
#include "postproc/numbers/comment.h"
#include "postproc/numbers/fixed_point.h"

namespace toothpath::shaper {

GearboxWriter::GearboxWriter(const ShaperSetup& setup, const GearboxFormat& format)
    : s_(setup), box_(*setup.machine.gearbox), format_(format) {}

std::string GearboxWriter::run() {
  begin();
  remarks();
  const double clear = s_.depth_mm + s_.machine.relief_mm;
  const std::string slow = feed(std::min(kApproachFeed, s_.machine.axes.at('X').max_speed)),
                    zero = format_.point ? "0." : "0";
  out_ += comment("clear first, then offset slide, then ram and turns");
  line(clear_block(length_up(clear)));
  line("G0 Y" + length(s_.slide_mm));
  line("G0 Z" + length(s_.start_mm));
  line("G0 " + turn_word(box_.cutter_axis, zero) + " " + turn_word(box_.work_axis, zero));
  // At rest, with the cutter clear of the work.
  const auto g = std::gcd(std::int64_t{s_.cutter_teeth}, std::int64_t{s_.work_teeth});
  couple(s_.sense < 0 ? "-" : "", s_.cutter_teeth / g, s_.work_teeth / g);
  line(box_.relief_on);
  ram_on(2 * s_.length_mm * s_.strokes_set);
  line("G1 X" + length(s_.depth_mm) + " F" + slow);
  infeed();
  turn();
  ram_off();
  line(box_.relief_off);
  line("G1 X" + length_up(clear) + " F" + slow);
  finish();
  return std::move(out_);
}

std::string GearboxWriter::comment(std::string_view text) const {
  return format_.comment_open + numbers::comment_text(text).substr(0, 70) + format_.comment_close + "\n";
}

std::string GearboxWriter::number(std::int64_t units, int decimals) const {
  std::string out;
  numbers::append_fixed(out, units, decimals, format_.point);
  return out;
}

std::string GearboxWriter::length(double mm) const {
  return number(numbers::to_fixed(mm, format_.length_decimals), format_.length_decimals);
}

std::string GearboxWriter::length_up(double mm) const {
  const double scale = std::pow(10.0, format_.length_decimals);
  return number(static_cast<std::int64_t>(std::ceil(mm * scale - 1e-6)), format_.length_decimals);
}

std::string GearboxWriter::feed(double value) const {
  return number(numbers::to_fixed(value, format_.feed_decimals), format_.feed_decimals);
}

void GearboxWriter::remarks() {
  out_ += comment("gear shaper with electronic gearbox, machine " + s_.machine.name);
  for (const auto& name : s_.machine.assumed_keys) out_ += comment("assumed, confirm before cutting: " + name);
  out_ += comment("all words are machine coordinates: " + zero_offsets());
  out_ += comment(fmt::format("cutter {} teeth, work {} teeth, sense {:+}", s_.cutter_teeth, s_.work_teeth, s_.sense));
  out_ += comment(
      fmt::format("{} double strokes/min, {} infeed, {} one turn", s_.strokes_set, s_.strokes_infeed, s_.strokes_turn));
}

/// The cutter's angle after a share of the way through double stroke counts, in units of the last printed digit,
/// rounded upwards so that the whole turn is never short; from whole numbers.
std::int64_t GearboxWriter::cutter_units(std::int64_t strokes_times, std::int64_t strokes_of) const {
  const __int128 numerator =
      __int128{360} * numbers::power_of_ten(format_.angle_decimals) * s_.work_teeth * strokes_times;
  const __int128 denominator = __int128{s_.cutter_teeth} * s_.strokes_turn * strokes_of;
  return static_cast<std::int64_t>((numerator + denominator - 1) / denominator);
}

void GearboxWriter::infeed() {
  const int parts = std::max(1, static_cast<int>(std::ceil(s_.infeed_min)));
  out_ += comment("infeed while cutter and work turn");
  for (int k = 1; k <= parts; ++k)
    line("G93 G1 X" + length(s_.depth_mm * (parts - k) / parts) + " " +
         turn_word(box_.cutter_axis,
                   number(cutter_units(std::int64_t{s_.strokes_infeed} * k, parts), format_.angle_decimals)) +
         " F" + feed(parts / s_.infeed_min));
}

void GearboxWriter::turn() {
  out_ += comment("one turn of the work at full depth");
  const auto end = cutter_units(std::int64_t{s_.strokes_total()}, 1) + 1;
  const double way = degrees(2 * kPi) * s_.work_teeth / s_.cutter_teeth;
  line("G94 G1 " + turn_word(box_.cutter_axis, number(end, format_.angle_decimals)) + " F" +
       feed(way / s_.generating_min));
}

}  // namespace toothpath::shaper
