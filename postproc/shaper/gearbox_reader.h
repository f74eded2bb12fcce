// Reads a program for an electronic gearbox back and says what the machine would do: ratio, strokes, infeed, turns, times. Written from the
// words of the two controls; shares no code with the writer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace toothpath::shaper {

/// Places that agree [mm]: half of the third decimal, the coarser of both controls.
inline constexpr double kPlace = 5.1e-4;

/// Work turns over cutter turns, as the program says them, with its sign.
struct GearboxRatio {
  std::int64_t work_turns = 0, cutter_turns = 0;
};

/// One infeed or turning move while ram and gearbox run.
struct GeneratingMove {
  int line = 0;
  double x_from_mm = 0, x_to_mm = 0;
  std::int64_t cutter_from = 0, cutter_to = 0;  ///< in units of 1e-6 deg
  double minutes = 0;
};

struct GearboxReading {
  std::optional<GearboxRatio> ratio;
  double stroke_start_mm = 0, stroke_end_mm = 0, strokes_per_minute = 0;
  double slide_mm = 0;         ///< Y while cutting
  double clear_before_mm = 0;  ///< X when the coupling goes on
  double clear_after_mm = 0;   ///< X when it goes off
  std::vector<GeneratingMove> moves;
  std::vector<std::string> problems;  ///< words or orders that are wrong whatever the job, "line n: what"
};

/// What the two controls need to be told apart, from the machine file.
struct GearboxWords {
  bool siemens = true;
  std::string cutter_axis = "C1", work_axis = "C2";
  std::string relief_on, relief_off;
  std::int64_t pulses_per_turn = 0;
};

/// Any text gives a reading; what is not understood is a problem.
[[nodiscard]] GearboxReading read_gearbox_program(std::string_view text, const GearboxWords& words);

}  // namespace toothpath::shaper
