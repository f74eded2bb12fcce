#include "app/report/sections/sections.h"

#include <algorithm>

#include "app/base/units.h"

namespace toothpath::sections {
namespace {

/// The least that is left of the limits of an operation with this tool where its length is off; as text.
std::string left_of(const report::RunReport& report, int tool, int sister_of) {
  std::optional<double> least;
  for (const report::LengthTolerance& t : report.length_tolerances) {
    if (t.tool_number != tool && t.tool_number != sister_of) continue;
    const double both = std::min(t.too_long_mm, t.too_short_mm.value_or(t.too_long_mm));
    least = std::min(least.value_or(both), both);
  }
  return least ? fmt::format("{:.2f} um", *least * app::kUm) : "not known";
}

const char* where_text(text::ToolChecks when) {
  switch (when) {
    case text::ToolChecks::none: break;
    case text::ToolChecks::tool_changes: return "where a tool has come and where it goes";
    case text::ToolChecks::operations: return "where a tool has come and where it goes, and ahead of every operation";
    case text::ToolChecks::teeth: return "where a tool has come and where it goes, and between teeth";
  }
  return "";
}

}  // namespace

/// Tools whose length the program checks at the setter.
report::Section tool_checks(const SectionInput& input) {
  report::Section section;
  const auto& check = input.machine.tool_check;
  if (input.report.tool_checks.empty() || !check) return section;
  section.title = "Checks of the tools";
  section.id = "tool-checks";
  section.columns = {"T", "checks", "stops where the length is off by more than", "the proof leaves for it"};
  for (const report::ToolCheckUse& use : input.report.tool_checks) {
    int sister_of = 0;
    for (const joints::AxisOperation& op : input.program.operations)
      if (op.tool_number == use.tool) sister_of = op.sister_of;
    section.rows.push_back({fmt::format("T{}", use.tool), std::to_string(use.checks),
                            fmt::format("{:g} mm", use.tolerance_mm), left_of(input.report, use.tool, sister_of)});
  }
  const text::TextWishes& wishes = input.job.program.text;
  section.note = fmt::format(
      "The program takes the tool to the setter, X {:g} Y {:g} Z {:g} mm machine, {}{}. {} The way there is proven "
      "down to {:g} mm above the setter; what is below is meant to be touched.",
      check->position_mm.x(), check->position_mm.y(), check->position_mm.z(), where_text(wishes.checks),
      wishes.checks == text::ToolChecks::teeth ? fmt::format(", every {} at most", wishes.teeth_between_checks) : "",
      check->uncertainty_mm
          ? fmt::format("The control takes the length that is measured; that it is off by {:g} mm counts in the proof.",
                        *check->uncertainty_mm)
          : "The length is compared and not changed: a check finds a tool that is broken or was exchanged. What it "
            "lets pass beyond what the proof leaves would still cut too deep, or too little.",
      check->clearance_mm);
  return section;
}

}  // namespace toothpath::sections
