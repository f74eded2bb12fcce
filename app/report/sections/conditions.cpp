#include "app/report/sections/sections.h"
#include "geometry/base/angle.h"

namespace toothpath::sections {
namespace {

std::string at(const readback::ValueAt& v) {
  return v.line == 0 ? std::string("-") : fmt::format("{:.6g} (line {})", v.value, v.line);
}

std::string coolants_of(const readback::ConditionsOfOperation& c) {
  std::string out;
  for (const machines::Coolant coolant : machines::kCoolants)
    if (is_on(c.coolants, coolant)) out += (out.empty() ? "" : ", ") + std::string(to_string(coolant));
  return out.empty() ? "off" : out;
}

}  // namespace

/// The job's values beside those of the text.
report::Section conditions(const job::Job& job, const machines::Machine& machine, const report::RunReport& report) {
  report::Section section;
  section.title = "Feeds, speeds, tool and coolant";
  section.id = "conditions";
  section.columns = {"op", "T", "job", "S 1/min", "job", "cut mm/min", "job", "any feed mm/min", "coolant"};
  const readback::ConditionsFound& found = *report.conditions;
  for (const auto& [n, c] : found.operations) {
    const auto k = static_cast<std::size_t>(n);
    const path::MillingOperation* o = n >= 0 && k < job.operations.size() ? &job.operations[k] : nullptr;
    section.rows.push_back(
        {n < 0 ? "-" : std::to_string(n), fmt::format("T{}", c.tool),
         o == nullptr ? "-" : fmt::format("T{}", job.tools[static_cast<std::size_t>(o->tool)].number),
         c.least_rpm.value == c.greatest_rpm.value
             ? fmt::format("{:g}", c.greatest_rpm.value)
             : fmt::format("{:g} to {:g}", c.least_rpm.value, c.greatest_rpm.value),
         o == nullptr ? "-" : fmt::format("{:g}", o->speed_rpm), at(c.cut_mm_min),
         o == nullptr ? "-" : fmt::format("{:g}", o->feed_mm_min), at(c.any_mm_min), coolants_of(c)});
  }
  section.note =
      fmt::format("Feeds are the quickest of the tip, where it may cut and anywhere; limits.cutting_feed is {:g}. ",
                  machine.max_cutting_feed);
  for (std::size_t a = 0; a < report.axes.size() && a < found.axis_speed.size(); ++a) {
    if (found.axis_speed[a].line == 0) continue;
    const double most = a < 3 ? machine.chain.linear[a].max_speed : degrees(machine.chain.rotary(a - 3).max_speed);
    section.note += fmt::format("{} is asked for {} of {:g} {}/min. ", report.axes[a].letter, at(found.axis_speed[a]),
                                most, a < 3 ? "mm" : "deg");
  }
  if (found.shortest_ms.line > 0)
    section.note +=
        fmt::format("Shortest block {} ms, limits.min_block_ms is {:g}. ", at(found.shortest_ms), machine.min_block_ms);
  section.note += !report.hash          ? "The program has no line HASH."
                  : report.hash->fits() ? "The line HASH fits the text."
                                        : "The line HASH does not fit the text.";
  return section;
}

}  // namespace toothpath::sections
