#include "app/report/sheet/restart_section.h"

#include <algorithm>

namespace toothpath::sheet {
namespace {

constexpr std::size_t kMostTeeth = 400;

std::string place(const restart::RestartLine& at) {
  return at.number < 0 ? fmt::format("line {}", at.line) : fmt::format("line {} (block {})", at.line, at.number);
}

std::string active(const report::OperationReport& o, const job::Job& job) {
  return fmt::format("T{}, its length, {}, S{:g}, all modal codes; Z at its top before anything turns", o.tool_number,
                     job.setup->work_offset, o.speed_rpm);
}

std::string how_to_set_the_tooth(const restart::RestartOperation& op, const report::RunReport& report) {
  const std::string tool =
      op.tool_before > 0 ? fmt::format("fetch T{} by hand first, the operation goes on with it; ", op.tool_before) : "";
  if (op.first_tooth.line != 0)
    return fmt::format("{}set in {}{}", tool, place(op.first_tooth),
                       report.tooth_stride == 1 ? "" : ": the place of the tooth, see below");
  return fmt::format("{}run to {}, then go on at the line of the tooth", tool, place(op.opening_end));
}

/// Pairs "tooth line" in columns.
void tooth_table(Sheet& sheet, const std::string& title,
                 const std::vector<std::pair<std::string, std::string>>& pairs) {
  sheet.raw(fmt::format("<p class=small>{}</p><div class=pairs>", svg::html_escape(title)));
  const std::size_t step = (pairs.size() + kMostTeeth - 1) / kMostTeeth;
  for (std::size_t n = 0; n < pairs.size(); n += step)
    sheet.raw(
        fmt::format("<span><b>{}</b> {}</span>", svg::html_escape(pairs[n].first), svg::html_escape(pairs[n].second)));
  sheet.raw("</div>\n");
}

}  // namespace

void restart_section(Sheet& sheet, const job::Job& job, const report::RunReport& report) {
  if (!report.restart_menu) return;
  const restart::RestartMenu& menu = *report.restart_menu;
  sheet.heading("Start and restart");
  sheet.begin_table({"point", "begin at", "active from there", "first tooth"});
  sheet.row({"start", "line 1", "nothing is taken over from an earlier program",
             fmt::format("as written: {}", report.restart ? report.restart->tooth : 0)});
  for (const auto& op : menu.operations) {
    const auto found = std::find_if(report.operations.begin(), report.operations.end(), [&](const auto& o) {
      return o.operation == op.operation && o.tool_number == op.tool;
    });
    const bool piece = found != report.operations.end() && found->places;
    sheet.row(
        {fmt::format(
             "op {} {}{}", op.operation, op.type,
             piece ? fmt::format(", T{}, places {} to {}", op.tool, found->places->first, found->places->second - 1)
                   : ""),
         place(op.at), found == report.operations.end() ? "" : active(*found, job), how_to_set_the_tooth(op, report)});
  }
  sheet.end_table();
  sheet.raw(fmt::format(
      "<p class=small>After a tool break: measure the new tool, then <code>toothpath run {} --restart OP:TOOTH --out "
      "DIR</code> writes and proves a program that begins there. By hand: run from line 1 to {} (units, modal codes, "
      "work offset), go on where the operation begins, and set the first tooth as the table says. A tooth that was not "
      "finished is cut again from its beginning. Put a changed first tooth back afterwards.</p>\n",
      svg::html_escape(job.file.substr(job.file.find_last_of('/') + 1)), place(menu.start_end)));
  sheet.raw("<p class=small>The lines of all teeth stand in the appendix.</p>\n");
}

void restart_appendix(Sheet& sheet, const report::RunReport& report) {
  if (!report.restart_menu) return;
  const restart::RestartMenu& menu = *report.restart_menu;
  const bool listed = std::any_of(menu.operations.begin(), menu.operations.end(),
                                  [](const auto& op) { return op.first_tooth.line == 0 && !op.teeth.empty(); });
  if (!listed && report.tooth_stride == 1) return;
  sheet.raw("<div class=appendix>\n");
  sheet.heading("Appendix: lines of the teeth, for a restart");
  if (report.tooth_stride != 1)
    sheet.raw(fmt::format("<p class=small>Tooth order: spread. Place n cuts tooth n &times; {} mod {}.</p>\n",
                          report.tooth_stride, report.teeth));
  bool places_shown = false;
  for (const auto& op : menu.operations) {
    std::vector<std::pair<std::string, std::string>> pairs;
    if (op.first_tooth.line == 0) {
      for (const auto& t : op.teeth)
        pairs.emplace_back(std::to_string(t.tooth), t.at.number < 0 ? std::to_string(t.at.line)
                                                                    : fmt::format("{} ({})", t.at.line, t.at.number));
      tooth_table(sheet,
                  fmt::format("Op {}, first line of every tooth{}:", op.operation,
                              pairs.size() > kMostTeeth ? " (equally spaced ones)" : ""),
                  pairs);
    } else if (report.tooth_stride != 1 && !places_shown) {
      places_shown = true;
      for (const auto& t : op.teeth) pairs.emplace_back(std::to_string(t.tooth), std::to_string(t.place));
      std::sort(pairs.begin(), pairs.end(),
                [](const auto& a, const auto& b) { return std::stoi(a.first) < std::stoi(b.first); });
      tooth_table(sheet,
                  fmt::format("Place of every tooth in the order{}:",
                              pairs.size() > kMostTeeth ? " (equally spaced ones)" : ""),
                  pairs);
    }
  }
  sheet.raw("</div>\n");
}

}  // namespace toothpath::sheet
