#include "app/report/sections/sections.h"
#include "app/report/sheet/setup_travel.h"

namespace toothpath::sections {

/// Room in the travels, and where there is most of it.
report::Section travels(const SectionInput& input) {
  if (!input.job.setup || !input.program.offer) return {};
  return sheet::travel_section(input.program, *input.job.setup);
}

}  // namespace toothpath::sections
