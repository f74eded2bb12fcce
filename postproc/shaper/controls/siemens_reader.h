// Reads what a program for the electronic gearbox of Siemens 840D sl makes the machine do.
#pragma once

#include <string_view>

#include "postproc/shaper/gearbox_reader.h"

namespace toothpath::shaper {

[[nodiscard]] GearboxReading read_siemens_gearbox(std::string_view text, const GearboxWords& words);

}  // namespace toothpath::shaper
