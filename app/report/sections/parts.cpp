#include <fmt/ranges.h>

#include "app/report/sections/sections.h"
#include "postproc/joints/tooth_order.h"

namespace toothpath::sections {

std::string teeth_words(const report::RunReport& report, int first_place, int end_place) {
  if (end_place - first_place == report.teeth) return "all teeth";
  const auto tooth = [&](int place) { return joints::tooth_of_place(place, report.tooth_stride, report.teeth); };
  if (end_place - first_place == 1) return fmt::format("tooth {}", tooth(first_place));
  if (report.tooth_stride == 1) return fmt::format("teeth {} to {}", first_place, end_place - 1);
  std::vector<int> teeth;
  for (int n = first_place; n < end_place; ++n) teeth.push_back(tooth(n));
  return fmt::format("teeth {}", fmt::join(teeth, ", "));
}

/// Programs that hold a part each: in which order they are run, and what each takes as done.
report::Section parts(const SectionInput& input) {
  report::Section section;
  if (input.report.parts.empty()) return section;
  section.title = "Programs in parts";
  section.id = "parts";
  section.columns = {"run as",  "file",  "name on the control", "operation", "cuts", "T",
                     "cutting", "total", "takes as done"};
  for (const report::PartReport& p : input.report.parts) {
    const int n = p.part.number;
    section.rows.push_back({fmt::format("{} of {}", n, p.part.count), p.file, p.name_on_control,
                            fmt::format("{} {}", p.part.operation, p.type),
                            teeth_words(input.report, p.part.first_place, p.part.end_place),
                            fmt::format("T{}", fmt::join(p.tools, ", T")), report::readable_minutes(p.feed_minutes),
                            report::readable_minutes(p.total_minutes),
                            n == 1   ? "nothing"
                            : n == 2 ? "part 1"
                                     : fmt::format("parts 1 to {}", n - 1)});
  }
  section.note = fmt::format(
      "Run one after the other they make the moves of {}, which is proven; each was compared with it move for move, "
      "and its own beginning and end were proven. Each begins with nothing taken over but what its parts before have "
      "cut.",
      input.report.program_file.empty() ? "the whole program" : input.report.program_file);
  return section;
}

}  // namespace toothpath::sections
