// What a program for an electronic gearbox makes the machine do, against the set-up that it was written for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace toothpath::shaper {

struct ShaperSetup;

/// Everything in which the program, read back, differs from the set-up: the ratio as an equality of whole numbers,
/// stroke ends and offset slide to half a printed digit, infeed to full depth and one whole turn of the work there
/// (whole numbers again), senses, times to 0.2 %. Empty: proven.
[[nodiscard]] std::vector<std::string> gearbox_program_faults(std::string_view text, const ShaperSetup& setup);

}  // namespace toothpath::shaper
