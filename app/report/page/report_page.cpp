#include "app/report/page/report_page.h"

#include <algorithm>
#include <fstream>
#include <system_error>

#include "app/report/page/assets.h"
#include "app/report/page/data.h"
#include "app/report/page/sections.h"
#include "app/report/svg/html_text.h"

namespace toothpath::page {
namespace {

struct Part {
  std::string_view mark;
  std::string text;
};

/// The template with every mark replaced once; what is put in is not searched again.
std::string filled(std::string_view text, const std::vector<Part>& parts) {
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t mark = text.find("@@", at);
    const std::size_t end = mark == std::string_view::npos ? mark : text.find("@@", mark + 2);
    if (end == std::string_view::npos) return out.append(text.substr(at));
    out.append(text.substr(at, mark - at));
    const std::string_view name = text.substr(mark + 2, end - mark - 2);
    const auto part = std::find_if(parts.begin(), parts.end(), [&](const Part& p) { return p.mark == name; });
    assert(part != parts.end());
    out += part->text;
    at = end + 2;
  }
  return out;
}

/// A section of the page: its anchor, its link at the top, and what it says; empty where it has nothing to say.
struct Shown {
  std::string id, link, text;
};

/// Everything below the 3D view, in its order.
std::vector<Shown> sections_of(const ReportPage& page) {
  std::vector<Shown> out = {{"job", "Job", job_section(page)},
                            {"gouge", "Gouge", gouge_section(page)},
                            {"deviation", "Deviation", deviation_section(page)},
                            {"ledger", "Ledger", ledger_section(page)},
                            {"direction", "Tool direction", direction_section(page)},
                            {"motion", "Axes", motion_section(page)},
                            {"contact", "Contact", contact_section(page)},
                            {"limits", "Limits", limits_section(page)},
                            {"work-precision", "Error against run time", work_precision_section(page)}};
  for (const report::Section& s : page.sections)
    out.push_back({s.id, svg::html_escape(s.title), section_of_the_report(s)});
  out.push_back({"stages", "Computing time", stages_section(page)});
  out.push_back({"tables", "Tables", tables_section(page)});
  return out;
}

/// Links to the sections that are there.
std::string contents(const std::vector<Shown>& sections, bool view) {
  std::string out = "<nav>";
  if (view) out += "<a href=\"#space\">3D view</a>";
  for (const Shown& s : sections)
    if (!s.text.empty()) out += fmt::format("<a href=\"#{}\">{}</a>", s.id, s.link);
  return out + "</nav>\n";
}

std::string_view line_of(std::string_view& rest) {
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace

std::vector<NcExcerpt> nc_excerpts(std::string_view program, const std::vector<int>& lines, int around) {
  std::vector<int> wanted;
  for (const int line : lines)
    if (line > 0) wanted.push_back(line);
  std::sort(wanted.begin(), wanted.end());
  const auto total = static_cast<int>(std::count(program.begin(), program.end(), '\n')) +
                     (program.empty() || program.back() == '\n' ? 0 : 1);
  std::vector<NcExcerpt> excerpts;
  std::size_t next = 0;
  std::string_view rest = program;
  for (int number = 1; number <= total; ++number) {
    const std::string_view line = line_of(rest);
    while (next < wanted.size() && number - wanted[next] > around) ++next;
    if (next == wanted.size()) break;
    if (wanted[next] > total) break;
    if (wanted[next] - number > around) continue;
    if (excerpts.empty() || excerpts.back().first_line + static_cast<int>(excerpts.back().lines.size()) != number)
      excerpts.push_back({number, {}});
    excerpts.back().lines.emplace_back(line);
  }
  return excerpts;
}

Result<std::string> render_report_page(const ReportPage& page) {
  if (auto status = check_report_page(page); !status) return status.error();
  const bool view =
      std::any_of(page.surface.begin(), page.surface.end(),
                  [](const proof::SurfaceGrid& g) { return g.rows > 1 && g.columns > 1; }) ||
      std::any_of(page.paths.begin(), page.paths.end(), [](const PagePath& p) { return !p.cl.records.empty(); });
  const std::vector<Shown> sections = sections_of(page);
  std::string text;
  for (const Shown& s : sections) text += s.text;
  return filled(
      kReportTemplate,
      {{"TITLE", svg::html_escape(page.title)},
       {"STYLE", std::string(kReportStyle)},
       {"HEADER", page_header(page) + contents(sections, view)},
       {"OVERVIEW", overview_section(page)},
       {"VIEW_HIDDEN", view ? "" : " hidden"},
       {"SECTIONS", text},
       {"FOOTER", "<footer>Toothpath report. Lengths in mm and \u00b5m in the gear frame; tooth space 0.</footer>"},
       {"DATA", report_data_json(page)},
       {"VIEW", std::string(kReportView)},
       {"SCRIPT", std::string(kReportScript)}});
}

Status write_report_page(const ReportPage& page, const std::filesystem::path& file) {
  auto text = render_report_page(page);
  if (!text) return text.error();
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) return fail_as(DiagnosticKind::file_access, "{}: cannot be opened for writing", file.string());
  out.write(text->data(), static_cast<std::streamsize>(text->size()));
  out.close();
  if (out) return Ok{};
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  return fail_as(DiagnosticKind::file_access, "{}: cannot be written", file.string());
}

}  // namespace toothpath::page
