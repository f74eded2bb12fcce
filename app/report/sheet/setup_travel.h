// What the set-up sheet says of the room in the travels, of the place of the part with the most room, and of the run
// time.
#pragma once

#include <string>

#include "app/report/run_report.h"
#include "postproc/joints/program.h"
#include "postproc/joints/setup.h"

namespace toothpath::sheet {

/// Room of X Y Z now and at the place with the most room: origin and work offset there, and what it means for the
/// fixture. The section has no rows where no place was looked for.
[[nodiscard]] report::Section travel_section(const joints::AxisProgram& program, const joints::Setup& setup);

/// Times of the program and with the accelerations of the axes, or that the machine file states none; which term ruled
/// the blocks; poles that the program passes.
[[nodiscard]] report::Section time_section(const joints::AxisProgram& program,
                                           const std::optional<report::PolesReport>& poles);

/// What a place means for the fixture: "needs a riser of 12.000 mm", "needs the part 3.000 mm lower", or nothing.
[[nodiscard]] std::string riser_text(const choice::TravelOffer& offer);

}  // namespace toothpath::sheet
