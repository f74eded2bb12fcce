// Fanuc with electronic gearbox: coupling by G81.5, T and L where they hold the ratio, else P and C; the ram by G81.1.
#include <numeric>

#include <fmt/format.h>

#include "postproc/numbers/fixed_point.h"
#include "postproc/shaper/control.h"
#include "postproc/shaper/controls/fanuc_reader.h"
#include "postproc/shaper/gearbox_writer.h"

namespace toothpath::shaper {
namespace {

constexpr std::int64_t kMostTurnsT = 1000, kMostTurnsL = 21;  // G81.5 T and L
constexpr std::int64_t kMostPulses = 999999999,
                       kMostDegrees = 99999;  // G81.5 P, and C with three decimals in eight digits

class FanucWriter : public GearboxWriter {
 public:
  explicit FanucWriter(const ShaperSetup& setup) : GearboxWriter(setup, {3, 3, 3, true, "(", ")"}) {}

 private:
  void begin() override {
    line("%");
    out_ += "O2001 " + comment(std::string_view(s_.job_name).substr(0, 30));
    line("G21 G17 G90 G94 G40 G49 G80 G69 G54");
  }
  [[nodiscard]] std::string zero_offsets() const override { return "G54 and EXT must be 0 in every axis"; }
  [[nodiscard]] std::string clear_block(const std::string& x) const override { return "G53 G0 X" + x; }
  [[nodiscard]] std::string turn_word(const std::string& axis, const std::string& number) const override {
    return axis + number;
  }
  void couple(const char* sign, std::int64_t top, std::int64_t bottom) override {
    if (bottom <= kMostTurnsT && top <= kMostTurnsL)
      line(fmt::format("G81.5 T{} {}0. L{}{}", bottom, box_.work_axis, sign, top));
    else line(fmt::format("G81.5 P{} {}{}{}.", bottom * box_.pulses_per_turn, box_.work_axis, sign, 360 * top));
  }
  /// Q from the printed start to the printed end.
  void ram_on(double speed) override {
    const auto from = numbers::to_fixed(s_.start_mm, format_.length_decimals),
               to = numbers::to_fixed(s_.end_mm, format_.length_decimals);
    line("G81.1 Z" + length(s_.start_mm) + " Q" + number(to - from, format_.length_decimals) + " R0. F" + feed(speed));
  }
  void ram_off() override { line("G80"); }
  void finish() override {
    line("G80.5 " + box_.work_axis + "0.");
    line("M30");
    line("%");
  }
};

/// `G81.5 T L` with cutter turns up to 1000 and work turns up to 21, else `G81.5 P C` with pulses up to 999999999 and
/// degrees up to 99999.
Status fanuc_accepts(const machines::ShaperMachine& machine, int cutter_teeth, int work_teeth) {
  const std::int64_t g = std::gcd(cutter_teeth, work_teeth), top = cutter_teeth / g, bottom = work_teeth / g;
  if (bottom <= kMostTurnsT && top <= kMostTurnsL) return Ok{};
  const std::int64_t pulses = bottom * machine.gearbox->pulses_per_turn, turned = 360 * top;
  if (pulses > kMostPulses)
    return fail("the ratio {}/{} needs P = {} pulses for {} turns of the cutter axis, G81.5 of {} takes {}", top,
                bottom, pulses, bottom, machine.name, kMostPulses);
  if (turned > kMostDegrees)
    return fail("the ratio {}/{} needs C = {} deg for {} turns of the work, G81.5 of {} takes {}", top, bottom, turned,
                top, machine.name, kMostDegrees);
  return Ok{};
}

}  // namespace

ShaperControl fanuc() {
  ShaperControl c;
  c.dialect = {"fanuc", machines::ShaperGears::pulses};
  c.extension = ".nc";
  c.coupling_words = "G81.5, G80.5";
  c.program = [](const ShaperSetup& setup) { return FanucWriter(setup).run(); };
  c.accepts = fanuc_accepts;
  c.read = read_fanuc_gearbox;
  return c;
}

}  // namespace toothpath::shaper
