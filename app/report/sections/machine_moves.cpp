#include <algorithm>

#include "app/report/machine_moves.h"
#include "app/report/sections/sections.h"

namespace toothpath::sections {
namespace {

constexpr std::size_t kMostRows = 12;
constexpr std::size_t kNearestOnSheet = 3;  // behind those that fail

std::string number(int value) { return value < 0 ? "" : std::to_string(value); }

}  // namespace

report::Section machine_moves_of(const machines::Machine& machine, const report::RunReport& report) {
  report::Section section;
  if (!report.machine_moves || report.machine_moves->stated == 0) return section;
  const bodies::MovesFound& found = *report.machine_moves;
  section.title = "Bodies of the machine";
  section.id = "machine-moves";
  section.columns = {"bodies", "least clearance mm", "measured mm", "line", "op", "tooth", "tool", "joints"};
  const auto add = [&](const bodies::Meeting& m, bool failed) {
    if (section.rows.size() >= kMostRows) return;
    const std::string least = !failed             ? fmt::format("{:.2f}", m.proven_mm)
                              : m.measured_mm > 0 ? fmt::format("{:.4f}, too near", m.proven_mm)
                                                  : fmt::format("collision, {:.2f} deep", m.depth_mm);
    section.rows.push_back({fmt::format("{}, {}", m.second, m.first), least, fmt::format("{:.2f}", m.measured_mm),
                            std::to_string(m.line), number(m.operation), number(m.tooth), fmt::format("T{}", m.tool),
                            report::joints_text(machine, m.joints)});
  };
  for (const bodies::Meeting& m : found.failed) add(m, true);
  section.sheet_rows = section.rows.size() + kNearestOnSheet;
  for (const bodies::Meeting& m : found.nearest) add(m, false);
  section.note = fmt::format(
      "Simple bodies of the machine file, the part, what holds it, and the tool, against each other: {} pairs on all "
      "{} "
      "moves of the program, proven between the blocks. Pairs that stay more than {:g} mm apart are not listed.",
      found.pairs, found.moves, found.look_mm);
  if (!found.bearing.empty())
    section.note += fmt::format(" Not looked at, for they bear on one another: {}.", fmt::join(found.bearing, "; "));
  if (found.unjudged > 0)
    section.note += fmt::format(" {} moves begin where the program does not tell: not judged.", found.unjudged);
  return section;
}

/// How near the bodies of the machine come to each other.
report::Section machine_moves(const SectionInput& input) { return machine_moves_of(input.machine, input.report); }

}  // namespace toothpath::sections
