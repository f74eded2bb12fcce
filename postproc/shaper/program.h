// The explicit stroke program of a shaper: every double stroke is written out, for LinuxCNC without kinematics.
#pragma once

#include <string>

#include "postproc/shaper/setup.h"

namespace toothpath::shaper {

/// The program's text, ASCII, LF. X infeed slide (0 at full depth, positive away from the work), Y offset slide, Z
/// stroke along the cutter axis, A cutter, C work; words are machine coordinates, mm and deg. Same set-up, same bytes.
///
/// One double stroke j: `G1 Z(end) A C F`, `G1 X(x + relief) F`, `G1 Z(start) F`, `G1 X(x of j + 1) F` in G93; the four
/// times add up to 1/strokes_set. Only the first block turns cutter and work; infeed happens at `start`. Rapids only at
/// X >= depth.
[[nodiscard]] std::string shaper_program_text(const ShaperSetup& setup);

}  // namespace toothpath::shaper
