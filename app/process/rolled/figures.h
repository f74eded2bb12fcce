// The contact of a gear and its pinion for people: patterns drawn on both members, transmission error, pairs in
// contact.
#pragma once

#include <string>
#include <vector>

#include "app/process/rolled/pair.h"
#include "app/report/page/report_page.h"

namespace toothpath::rolled {

/// A finished drawing with its words.
struct ContactFigure {
  std::string caption, svg, note;
};

/// "flank +1, exact"; of a cut flank its route.
[[nodiscard]] std::string name_of(const RolledPair& analysis, const RolledSide& side);

/// Patterns on gear and pinion of every side, exact and as cut.
[[nodiscard]] std::vector<ContactFigure> contact_patterns(const RolledPair& analysis);
/// Transmission error and number of pairs over one pitch.
[[nodiscard]] std::vector<svg::LineChart> contact_charts(const RolledPair& analysis);
/// One row a side and ring.
[[nodiscard]] page::PageTable contact_table(const RolledPair& analysis);

/// The page of the pair. @param about  what can be said of such flanks
[[nodiscard]] std::string contact_page(const RolledPair& pair, const std::string& about);
/// contact.csv, ease_off.csv, transmission.csv, contact.json and that page.
[[nodiscard]] process::NamedFiles contact_files(const RolledPair& pair, const std::string& about);

/// Body of the contact section of a run's report page: key numbers, charts and patterns as markup.
[[nodiscard]] std::string contact_section_body(const RolledPair& analysis);

}  // namespace toothpath::rolled
