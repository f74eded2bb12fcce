#include "app/report/sections/sections.h"
#include "app/report/sheet/setup_travel.h"

namespace toothpath::sections {

/// Times of the program, and what rules them.
report::Section times(const SectionInput& input) { return sheet::time_section(input.program, input.report.poles); }

}  // namespace toothpath::sections
