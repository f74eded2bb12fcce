// What both studies write: a table as CSV, a page with plots and tables, a plot as a file of its own.
#pragma once

#include <string>
#include <vector>

#include "app/report/page/report_page.h"
#include "app/report/svg/chart.h"

namespace toothpath::page {

/// A page without script: opens from disk, prints, follows light and dark.
struct StudyPage {
  std::string title, subtitle, verdict;
  bool good = true;                       ///< colour of the verdict
  std::vector<std::string> introduction;  ///< paragraphs: what the study did and how to read it
  std::vector<svg::LineChart> charts;
  struct Figure {
    std::string caption, svg, note;  ///< svg as finished element
  };
  std::vector<Figure> figures;  ///< after the charts
  std::vector<PageTable> tables;
};
[[nodiscard]] std::string study_page_html(const StudyPage& page);

/// The plot as an SVG file that needs no style sheet (white ground, the colours of the light page).
[[nodiscard]] std::string standalone_svg(const svg::LineChart& chart);

/// Rows as CSV (comma, line feed, cells with a comma or a quote quoted).
[[nodiscard]] std::string table_csv(const PageTable& table);

/// Columns set to width, for the screen.
[[nodiscard]] std::string table_text(const PageTable& table);

}  // namespace toothpath::page
