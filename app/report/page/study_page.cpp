#include "app/report/page/study_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/report/page/assets.h"
#include "app/report/svg/html_text.h"
#include "app/report/svg/plot.h"

namespace toothpath::page {
namespace {

/// The light colours of the report page as plain values: viewers of single SVG files do not all know CSS variables.
constexpr std::string_view kSvgStyle =
    "<style>text{font:13px "
    "sans-serif;fill:#5a6570}.ax{stroke:#5a6570;fill:none}.grid{stroke:#d5dbe0;fill:none}.minor{stroke:#eef1f3}.lim{"
    "stroke:#a4202c;stroke-dasharray:6 "
    "4}.cv{fill:none;stroke-width:1.5}line[class^=s]{stroke-width:3}.s0{stroke:#1f6fb2}.s1{stroke:#d0681c}.s2{stroke:#"
    "2a8560}.s3{stroke:#8a4c9f}.s4{stroke:#a07c12}.s5{stroke:#b8415b}.s6{stroke:#4f6d8a}.s7{stroke:#6b7a1f}.dot{fill:#"
    "fff;stroke-width:1.6}</style><rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>";

constexpr std::size_t kLongestCell = 48;       // characters that stand in one line
constexpr std::size_t kMostLooseColumns = 10;  // more of them stand closer

/// Characters on the screen, not bytes: every byte of UTF-8 that begins a character.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

bool numeric(std::string_view cell) {
  return !cell.empty() && cell.find_first_not_of("0123456789.+-e") == std::string_view::npos &&
         cell.find_first_of("0123456789") != std::string_view::npos;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// A column as a reader writes it: "left_bound_um" of a CSV file is "left bound [um]". "F_t [kN]" is one already.
std::string heading_of(std::string column) {
  const auto of_a_file = [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  if (!std::all_of(column.begin(), column.end(), of_a_file) || column.find('_') < 2) return column;
  for (const std::string_view unit : {"_um", "_mm", "_s", "_deg", "_min"})
    if (column.ends_with(unit))
      return heading_of(column.substr(0, column.size() - unit.size())) + " [" + std::string(unit.substr(1)) + "]";
  std::replace(column.begin(), column.end(), '_', ' ');
  return column;
}

/// The last column holds sentences: each stands in a row of its own, as wide as the table.
bool ends_in_sentences(const PageTable& table) {
  return std::any_of(table.rows.begin(), table.rows.end(),
                     [](const auto& row) { return !row.empty() && width_of(row.back()) > kLongestCell; });
}

std::string table_html(const PageTable& table) {
  const bool sentences = ends_in_sentences(table);
  const std::size_t columns = table.columns.size() - (sentences ? 1 : 0);
  std::string out = fmt::format("<div class=\"table{}\"><table><caption>{}</caption><thead><tr>",
                                columns > kMostLooseColumns ? " dense" : "", svg::html_escape(table.title));
  for (std::size_t k = 0; k < columns; ++k)
    out += fmt::format("<th scope=col>{}</th>", svg::html_escape(heading_of(table.columns[k])));
  out += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    const bool said = sentences && !row.back().empty();
    out += said ? "<tr class=said>" : "<tr>";
    for (std::size_t k = 0; k < std::min(columns, row.size()); ++k)
      out += fmt::format("<td{}>{}</td>",
                         numeric(row[k])                    ? " class=n"
                         : width_of(row[k]) <= kLongestCell ? " class=t"
                                                            : "",
                         svg::html_escape(row[k]));
    out += "</tr>\n";
    if (said) out += fmt::format("<tr><td class=said colspan={}>{}</td></tr>\n", columns, svg::html_escape(row.back()));
  }
  out += "</tbody></table></div>\n";
  if (!table.note.empty()) out += fmt::format("<p class=note>{}</p>\n", svg::html_escape(table.note));
  return out;
}

}  // namespace

std::string study_page_html(const StudyPage& page) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
      "content=\"width=device-width\"><title>{}</title><style>{}</style></head><body>\n",
      svg::html_escape(page.title), kReportStyle);
  out += fmt::format("<header><div class=name><h1>{}</h1><p>{}</p></div><div class=\"verdict {}\">{}</div></header>\n",
                     svg::html_escape(page.title), svg::html_escape(page.subtitle), page.good ? "good" : "bad",
                     svg::html_escape(page.verdict));
  out += "<section>\n";
  for (const auto& paragraph : page.introduction) out += fmt::format("<p>{}</p>\n", svg::html_escape(paragraph));
  out += "</section>\n";
  if (!page.charts.empty() || !page.figures.empty()) {
    out += "<section><div class=plots>\n";
    for (const auto& chart : page.charts) {
      out += fmt::format("<figure><figcaption>{}</figcaption>{}", svg::html_escape(chart.title),
                         svg::svg_line_chart(chart));
      if (!chart.note.empty()) out += fmt::format("<p class=note>{}</p>", svg::html_escape(chart.note));
      out += "</figure>\n";
    }
    for (const auto& figure : page.figures) {
      out += fmt::format("<figure><figcaption>{}</figcaption>{}", svg::html_escape(figure.caption), figure.svg);
      if (!figure.note.empty()) out += fmt::format("<p class=note>{}</p>", svg::html_escape(figure.note));
      out += "</figure>\n";
    }
    out += "</div></section>\n";
  }
  for (const auto& table : page.tables) out += "<section>" + table_html(table) + "</section>\n";
  return out + "</body></html>\n";
}

std::string standalone_svg(const svg::LineChart& chart) {
  std::string svg = svg::svg_line_chart(chart);
  const auto open = svg.find("<svg "), end = svg.find('>', open);
  if (open == std::string::npos || end == std::string::npos) return {};
  svg.insert(end + 1, kSvgStyle);
  svg.insert(open + 5, "xmlns=\"http://www.w3.org/2000/svg\" ");
  return svg + "\n";
}

std::string table_csv(const PageTable& table) {
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) out += (k ? "," : "") + csv_cell(cells[k]);
    out += "\n";
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
  return out;
}

std::string table_text(const PageTable& table) {
  std::vector<std::size_t> widths;
  for (const auto& column : table.columns) widths.push_back(width_of(column));
  for (const auto& row : table.rows)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], width_of(row[k]));
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const std::string pad(widths[k] - width_of(cells[k]), ' ');
      const bool last = k + 1 == cells.size();
      out += numeric(cells[k]) ? pad + cells[k] : cells[k] + (last ? "" : pad);
      out += last ? "\n" : "  ";
    }
  };
  line(table.columns);
  for (const auto& row : table.rows) line(row);
  return out;
}

}  // namespace toothpath::page
