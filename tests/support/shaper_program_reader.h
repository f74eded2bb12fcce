// Reads a shaper's stroke program (a small subset of LinuxCNC) back into moves, and finds what breaks its rules.
// Written from the rules of the output alone; shares no code with the writer.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace toothpath::test {

enum ShaperAxisIndex { kX, kY, kZ, kA, kC };

/// One motion block. Words: mm and deg.
struct ShaperMove {
  int line = 0;
  bool rapid = false, inverse_time = false, machine_coordinates = false;
  double feed = 0;  ///< 0: no F word in this block
  std::array<bool, 5> said{};
  std::array<double, 5> from{}, to{};
};

struct ShaperProgramText {
  std::string first_line;
  std::vector<ShaperMove> moves;
  std::vector<std::string> problems;  ///< what the reader could not make sense of
  bool ended = false;                 ///< M2 met, nothing after it
};
[[nodiscard]] ShaperProgramText read_shaper_program(const std::string& text);

/// What the program has to do, from the job and not from the writer.
struct ShaperFacts {
  double depth = 0, relief = 0, slide = 0, start = 0, end = 0, strokes_per_minute = 0;
  int cutter_teeth = 0, work_teeth = 0, strokes_infeed = 0, strokes_turn = 0, sense = 1;
};

/// One cutting block as it was read.
struct ReadStroke {
  int line = 0;
  double x = 0, z_from = 0, z_to = 0, a_from = 0, a_to = 0, c_from = 0, c_to = 0;
};
[[nodiscard]] std::vector<ReadStroke> cutting_strokes(const ShaperProgramText& program, const ShaperFacts& facts);

/// Every broken rule, "line n: what"; empty if the program is right. Stops after 20.
[[nodiscard]] std::vector<std::string> shaper_program_faults(const ShaperProgramText& program,
                                                             const ShaperFacts& facts);

}  // namespace toothpath::test
