#include "app/report/sections/sections.h"

namespace toothpath::sections {
namespace {

std::string stretches_of(const joints::ToolUse& use, const report::RunReport& report) {
  std::string text;
  for (const auto& s : use.stretches)
    text += fmt::format("{}op {}: {}", text.empty() ? "" : "; ", s.operation,
                        teeth_words(report, s.first_place, s.end_place));
  return text;
}

}  // namespace

/// Tools whose life is stated: what each cuts, and how much of its life that takes.
report::Section tool_life(const SectionInput& input) {
  report::Section section;
  if (input.report.tool_uses.empty()) return section;
  section.title = "Tool life";
  section.id = "tool-life";
  section.columns = {"T", "cuts", "minutes of cutting", "of its life", "left"};
  for (const joints::ToolUse& use : input.report.tool_uses)
    section.rows.push_back(
        {use.sister_of == 0 ? fmt::format("T{}", use.tool) : fmt::format("T{}, sister of T{}", use.tool, use.sister_of),
         stretches_of(use, input.report), fmt::format("{:.2f}", use.minutes()), fmt::format("{:g}", use.life_min),
         fmt::format("{:.2f}", use.life_min - use.minutes())});
  section.note =
      "Of the whole program: all its feed moves count. A tool is changed between two teeth, before the one that would "
      "not fit into its life any more. Every sister has the form of the tool in whose place it goes on, and a length "
      "of its own in the control, under its own number.";
  return section;
}

}  // namespace toothpath::sections
