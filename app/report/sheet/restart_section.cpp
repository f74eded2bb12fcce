#include "app/report/sheet/restart_section.h"

#include <algorithm>

namespace toothpath::sheet {
namespace {

constexpr std::size_t kMostTeeth = 400;
constexpr std::size_t kMostRuns = 4;  // of teeth, in the words of a cell

std::string place(const restart::RestartLine& at) {
  return at.number < 0 ? fmt::format("line {}", at.line) : fmt::format("line {} (block {})", at.line, at.number);
}

/// Teeth whose lines follow one another by the same step, in the order of the program.
struct LinesOfTeeth {
  int first = 0, last = 0;                     ///< places
  int line = 0, number = -1;                   ///< of the first
  int lines_a_tooth = 0, numbers_a_tooth = 0;  ///< 0: it is one tooth

  [[nodiscard]] bool goes_on(const restart::RestartTooth& next) const {
    if (next.place != last + 1) return false;
    if (first == last) return true;
    return next.at.line == line + lines_a_tooth * (next.place - first) &&
           next.at.number == (number < 0 ? -1 : number + numbers_a_tooth * (next.place - first));
  }
};

std::vector<LinesOfTeeth> lines_of_teeth(const restart::RestartOperation& op) {
  std::vector<LinesOfTeeth> runs;
  for (const auto& t : op.teeth) {
    if (runs.empty() || !runs.back().goes_on(t)) {
      runs.push_back({t.place, t.place, t.at.line, t.at.number, 0, 0});
      continue;
    }
    LinesOfTeeth& run = runs.back();
    if (run.first == run.last) {
      run.lines_a_tooth = t.at.line - run.line;
      run.numbers_a_tooth = t.at.number < 0 ? 0 : t.at.number - run.number;
    }
    run.last = t.place;
  }
  return runs;
}

/// "36 + 3 k": what stands at `first` if the step is `step`.
std::string at_tooth(int first, int start, int step) {
  const int at_0 = start - step * first;
  return at_0 == 0 ? fmt::format("{} k", step) : fmt::format("{} {} {} k", at_0, step < 0 ? '-' : '+', std::abs(step));
}

std::string words_of(const LinesOfTeeth& run, const std::string& tooth) {
  if (run.first == run.last) return fmt::format("{} {}: {}", tooth, run.first, place({run.line, run.number}));
  const std::string block =
      run.number < 0 ? "" : fmt::format(" (block {})", at_tooth(run.first, run.number, run.numbers_a_tooth));
  return fmt::format("{} k, {} to {}: line {}{}", tooth, run.first, run.last,
                     at_tooth(run.first, run.line, run.lines_a_tooth), block);
}

bool in_appendix(const restart::RestartOperation& op) {
  return op.first_tooth.line == 0 && lines_of_teeth(op).size() > kMostRuns;
}

/// Where the first tooth is set, or the line at which each begins.
std::string first_tooth(const restart::RestartOperation& op, const report::RunReport& report) {
  const std::string tooth = report.tooth_stride == 1 ? "tooth" : "place";
  if (op.first_tooth.line != 0) return fmt::format("set {} in {}", tooth, place(op.first_tooth));
  if (in_appendix(op)) return "see the appendix";
  std::string text;
  for (const LinesOfTeeth& run : lines_of_teeth(op)) text += (text.empty() ? "" : "; ") + words_of(run, tooth);
  return text;
}

std::string run_first(const restart::RestartOperation& op) {
  const std::string tool = op.tool_before > 0 ? fmt::format("fetch T{}", op.tool_before) : "";
  if (op.opening_end.line == 0) return tool;
  return fmt::format("{}{}to {}", tool, tool.empty() ? "" : ", then ", place(op.opening_end));
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
  sheet.begin_table({"point", "begin at", "run first", "first tooth"});
  sheet.row({"start", "line 1", "", fmt::format("as written: {}", report.restart ? report.restart->tooth : 0)});
  for (const auto& op : menu.operations) {
    const auto found = std::find_if(report.operations.begin(), report.operations.end(), [&](const auto& o) {
      return o.operation == op.operation && o.tool_number == op.tool;
    });
    const bool piece = found != report.operations.end() && found->places;
    sheet.row(
        {fmt::format("op {} {}, T{}{}", op.operation, op.type, op.tool,
                     piece ? fmt::format(", places {} to {}", found->places->first, found->places->second - 1) : ""),
         place(op.at), run_first(op), first_tooth(op, report)});
  }
  sheet.end_table();
  sheet.raw(fmt::format(
      "<p class=small>After a tool break: measure the new tool, then run <code>toothpath run {} --restart OP:TOOTH "
      "--out DIR</code>. It writes and proves a program that begins there. By hand: run from line 1 to {} (units, "
      "modal codes, work offset). Go on where the operation begins: T, its length, {}, S and all modal codes are set "
      "there, and Z goes to its top before anything turns. Set the first tooth, or run to the line that the table "
      "names and go on at the line of the tooth. A tooth that was not finished is cut again from its beginning. Put a "
      "changed first tooth back afterwards.</p>\n",
      svg::html_escape(job.file.substr(job.file.find_last_of('/') + 1)), place(menu.start_end),
      svg::html_escape(job.setup->work_offset)));
  if (report.tooth_stride != 1)
    sheet.raw(
        fmt::format("<p class=small>Tooth order: spread. Place n cuts tooth n &times; {} mod {}; the appendix "
                    "has the place of every tooth.</p>\n",
                    report.tooth_stride, report.teeth));
}

void restart_appendix(Sheet& sheet, const report::RunReport& report) {
  if (!report.restart_menu) return;
  const restart::RestartMenu& menu = *report.restart_menu;
  const bool listed = std::any_of(menu.operations.begin(), menu.operations.end(), in_appendix);
  if (!listed && report.tooth_stride == 1) return;
  sheet.raw("<div class=appendix>\n");
  sheet.heading("Appendix: teeth, for a restart");
  const auto many = [](std::size_t size) { return size > kMostTeeth ? " (equally spaced ones)" : ""; };
  for (const auto& op : menu.operations) {
    if (!in_appendix(op)) continue;
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const auto& t : op.teeth)
      pairs.emplace_back(std::to_string(t.tooth),
                         t.at.number < 0 ? std::to_string(t.at.line) : fmt::format("{} ({})", t.at.line, t.at.number));
    tooth_table(sheet, fmt::format("Op {}, first line of every tooth{}:", op.operation, many(pairs.size())), pairs);
  }
  if (report.tooth_stride != 1 && !menu.operations.empty()) {
    std::vector<std::pair<int, int>> places;
    for (const auto& op : menu.operations)
      if (op.operation == menu.operations.front().operation)
        for (const auto& t : op.teeth) places.emplace_back(t.tooth, t.place);
    std::sort(places.begin(), places.end());
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const auto& [tooth, at] : places) pairs.emplace_back(std::to_string(tooth), std::to_string(at));
    tooth_table(sheet, fmt::format("Place of every tooth in the order{}:", many(pairs.size())), pairs);
  }
  sheet.raw("</div>\n");
}

}  // namespace toothpath::sheet
