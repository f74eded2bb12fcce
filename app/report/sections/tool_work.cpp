#include <set>

#include "app/report/sections/sections.h"

namespace toothpath::sections {
namespace {

/// Way of the tip in feed moves over one tooth space.
double feed_way_mm(const path::ClPath& path) {
  double way = 0;
  for (std::size_t k = 1; k < path.records.size(); ++k)
    if (path.records[k].kind == path::MoveKind::feed) way += (path.records[k].tip - path.records[k - 1].tip).norm();
  return way;
}

/// What one tool does in the program.
struct ToolWork {
  std::string operations;
  double way_mm = 0, feed_minutes = 0, turns = 0;  ///< all teeth
};

ToolWork work_of(int tool_number, const SectionInput& input) {
  ToolWork work;
  for (const report::OperationReport& o : input.report.operations) {
    if (o.tool_number != tool_number) continue;
    work.operations += fmt::format("{}{}", work.operations.empty() ? "" : ", ", o.operation);
    work.feed_minutes += o.feed_minutes;
    work.turns += o.feed_minutes * o.speed_rpm;
    for (const path::ClPath* path : input.paths)
      if (path->operation == o.operation) work.way_mm += o.share * input.report.teeth * feed_way_mm(*path);
  }
  return work;
}

/// The deepest place of the program, in the row of the tool that cuts it.
std::string deepest_of(int tool_number, const SectionInput& input) {
  if (!input.report.gouge) return {};
  const proof::WorstPlace& place = input.report.gouge->deepest;
  for (const report::OperationReport& o : input.report.operations)
    if (o.operation == place.operation && o.tool_number == tool_number)
      return fmt::format("line {}, r {:.3f} mm, z {:.3f} mm: {:.2f} um", place.line, place.radius_mm, place.height_mm,
                         place.depth_mm * 1000);
  return {};
}

}  // namespace

/// How much every tool cuts: for its life, and for where to look at the part. Left out of a program that begins in the
/// middle: its times are not those of whole operations.
report::Section tool_work(const SectionInput& input) {
  report::Section section;
  if (input.report.restart) return section;
  section.title = "Work of the tools";
  section.id = "tool-work";
  section.sheet_rows = 0;
  section.columns = {"T",
                     "operations",
                     "in the cut m",
                     "in the cut min",
                     "mean feed mm/min",
                     "thousand turns",
                     "deepest place of the program"};
  std::set<int> seen;
  for (const report::OperationReport& o : input.report.operations) {
    if (!seen.insert(o.tool_number).second) continue;
    const ToolWork work = work_of(o.tool_number, input);
    section.rows.push_back({std::to_string(o.tool_number), work.operations, fmt::format("{:.2f}", work.way_mm / 1000),
                            fmt::format("{:.1f}", work.feed_minutes),
                            work.feed_minutes > 0 ? fmt::format("{:.0f}", work.way_mm / work.feed_minutes) : "",
                            fmt::format("{:.1f}", work.turns / 1000), deepest_of(o.tool_number, input)});
  }
  section.note =
      "Way of the tip in feed moves, without engaging and drawing back; all teeth, for the life of the tool. Negative "
      "depth: the cutter stays that far away from the finished surface.";
  return section;
}

}  // namespace toothpath::sections
