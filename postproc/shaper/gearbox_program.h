// Programs for gear shapers with an electronic gearbox: the control couples the work to the cutter by whole numbers, moves the ram by
// itself, and the program moves infeed and cutter only.
#pragma once

#include <string>

#include "geometry/base/result.h"
#include "postproc/shaper/setup.h"

namespace toothpath::shaper {

/// ".mpf", ".nc" or ".ngc" by the machine's dialect.
[[nodiscard]] const char* shaper_program_extension(const machines::ShaperMachine& machine);

/// Can the control's gearbox hold N_s/N_2 exactly? Fanuc: `G81.5 T L` with cutter turns up to 1000 and work turns up to 21, else `G81.5 P C` with
/// pulses up to 999999999 and degrees up to 99999. Refused with value and limit.
[[nodiscard]] Status check_gearbox(const machines::ShaperMachine& machine, int cutter_teeth, int work_teeth);

/// The program's text, ASCII, LF; words are machine coordinates, mm and deg. X infeed slide (0 at full depth), Y offset slide, Z stroke.
///
/// Order: infeed slide clear, offset slide, ram to the start, turns at zero; coupling on while clear and at rest; relief and stroke on; infeed in
/// parts of at most one minute with the cutter turning (G93, so that the time is exact); the rest of one work turn and more at full depth in
/// deg/min; stroke off, infeed slide clear, coupling off. Precondition: a machine with a gearbox that check_gearbox accepts.
[[nodiscard]] std::string shaper_gearbox_text(const ShaperSetup& setup);

}  // namespace toothpath::shaper
