// Programs for gear shapers with an electronic gearbox: the control couples the work to the cutter by whole numbers,
// moves the ram by itself, and the program moves infeed and cutter only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "postproc/shaper/setup.h"

namespace toothpath::shaper {

/// Digits and brackets of a control.
struct GearboxFormat {
  int length_decimals = 3, angle_decimals = 3;
  int feed_decimals = 3;
  bool point = true;  ///< stands in whole numbers too
  const char *comment_open = "(", *comment_close = ")";
};

/// Writes a program in the order that every control shares; a control says its own words.
///
/// Order: infeed slide clear, offset slide, ram to the start, turns at zero; coupling on while clear and at rest;
/// relief and stroke on; infeed in parts of at most one minute with the cutter turning (G93, so that the time is
/// exact); the rest of one work turn and more at full depth in deg/min; stroke off, infeed slide clear, coupling off.
/// Words are machine coordinates, mm and deg: X infeed slide (0 at full depth), Y offset slide, Z stroke. Precondition:
/// a machine with a gearbox whose control accepts the ratio.
class GearboxWriter {
 public:
  GearboxWriter(const ShaperSetup& setup, const GearboxFormat& format);
  virtual ~GearboxWriter() = default;
  /// The text, ASCII, LF. Once.
  [[nodiscard]] std::string run();

 protected:
  /// Safe start, with the job's name.
  virtual void begin() = 0;
  /// What must be 0 so that all words are machine coordinates.
  [[nodiscard]] virtual std::string zero_offsets() const = 0;
  /// Rapid of the infeed slide in machine coordinates.
  [[nodiscard]] virtual std::string clear_block(const std::string& x) const = 0;
  /// A word of cutter or work.
  [[nodiscard]] virtual std::string turn_word(const std::string& axis, const std::string& number) const = 0;
  /// `top` work turns in `bottom` cutter turns; sign "-" or "".
  virtual void couple(const char* sign, std::int64_t top, std::int64_t bottom) = 0;
  /// The ram between start and end; mean speed mm/min.
  virtual void ram_on(double speed) = 0;
  virtual void ram_off() = 0;
  /// Coupling off and the end of the program.
  virtual void finish() = 0;

  void line(const std::string& text) { out_ += text + "\n"; }
  [[nodiscard]] std::string comment(std::string_view text) const;
  [[nodiscard]] std::string number(std::int64_t units, int decimals) const;
  [[nodiscard]] std::string length(double mm) const;
  /// Never less than asked: clear heights.
  [[nodiscard]] std::string length_up(double mm) const;
  [[nodiscard]] std::string feed(double value) const;

  const ShaperSetup& s_;
  const machines::ElectronicGearbox& box_;
  const GearboxFormat format_;
  std::string out_;

 private:
  void remarks();
  void infeed();
  void turn();
  [[nodiscard]] std::int64_t cutter_units(std::int64_t strokes_times, std::int64_t strokes_of) const;
};

}  // namespace toothpath::shaper
