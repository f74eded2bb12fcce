// The contact of a gear and its pinion for people: patterns drawn on both members, transmission error, pairs in
// contact.
#pragma once

#include <string>
#include <vector>

#include "app/process/face/contact_analysis.h"
#include "app/report/page/report_page.h"

namespace toothpath::face {

/// A finished drawing with its words.
struct ContactFigure {
  std::string caption, svg, note;
};

/// "flank +1, exact"; of a cut flank its route.
[[nodiscard]] std::string name_of(const ContactAnalysis& analysis, const ContactOfSide& side);

/// Patterns on gear and pinion of every side, exact and as cut.
[[nodiscard]] std::vector<ContactFigure> contact_patterns(const ContactAnalysis& analysis);
/// Transmission error and number of pairs over one pitch.
[[nodiscard]] std::vector<svg::LineChart> contact_charts(const ContactAnalysis& analysis);
/// One row a side and ring.
[[nodiscard]] page::PageTable contact_table(const ContactAnalysis& analysis);

/// Body of the contact section of a run's report page: key numbers, charts and patterns as markup.
[[nodiscard]] std::string contact_section_body(const ContactAnalysis& analysis);

}  // namespace toothpath::face
