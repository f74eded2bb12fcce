// A pair that stands off its place, one quantity at a time: where its pattern lies then, and its transmission error.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/report/page/study_page.h"
#include "geometry/contact/pattern_place.h"

namespace toothpath::ease_off {

struct NamedMisalignment {
  std::string name;  ///< "as it stands", "offset -0.02 mm"
  contact::Misalignment moved;
};
/// The pair as it stands, then each quantity of the box that is not zero, less and more by its amount.
[[nodiscard]] std::vector<NamedMisalignment> single_misalignments(const contact::Misalignment& stands,
                                                                  const contact::Misalignment& box);
/// The corners of the box.
[[nodiscard]] std::vector<NamedMisalignment> corner_misalignments(const contact::Misalignment& stands,
                                                                  const contact::Misalignment& box);

/// Both sides of the teeth, +1 first.
using PairSides = std::array<contact::PairSide, 2>;

struct MisalignmentRow {
  NamedMisalignment at;
  std::array<contact::MisalignedContact, 2> sides;  ///< +1, -1
};
struct MisalignmentTable {
  contact::Misalignment box;
  double margin = 0, compound_mm = 0, pitch_radius_mm = 0;
  std::vector<MisalignmentRow> rows;
};
/// Refused: a pinion out of reach where it then stands; the name of the misalignment is told.
[[nodiscard]] Result<std::vector<MisalignmentRow>> roll_rows(const PairSides& pair,
                                                             const std::vector<NamedMisalignment>& list,
                                                             const contact::RollOptions& options, double margin);

/// "inside", or the edges that the pattern of a ring reaches: "tip, inner end".
[[nodiscard]] std::string reached_text(const contact::PatternPlace& at_edges, double compound_mm);

[[nodiscard]] nlohmann::ordered_json table_json(const MisalignmentTable& table);
[[nodiscard]] page::PageTable table_page(const MisalignmentTable& table, const std::string& title);
/// The way of the pattern's centre over the flank.
[[nodiscard]] svg::LineChart centre_chart(const MisalignmentTable& table);

}  // namespace toothpath::ease_off
