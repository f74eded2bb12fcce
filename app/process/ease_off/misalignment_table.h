// A pair that stands off its place, one quantity at a time: where its pattern lies then, and its transmission error.
#pragma once

#include <array>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/ease_off/words.h"
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

/// Places inside the box, the same every time: what a search of its corners never saw.
[[nodiscard]] std::vector<NamedMisalignment> random_misalignments(const contact::Misalignment& stands,
                                                                  const contact::Misalignment& box, int count);

/// Rolls one side of a pair where it then stands; sides 0 and 1 as the words of the pair name them.
using RollSide = std::function<Result<contact::MisalignedContact>(std::size_t side, const contact::Misalignment&)>;

struct MisalignmentRow {
  NamedMisalignment at;
  std::array<contact::MisalignedContact, 2> sides;
};
struct MisalignmentTable {
  const PairWords* words = nullptr;
  contact::Misalignment box;
  double margin = 0, compound_mm = 0, pitch_radius_mm = 0;
  std::vector<MisalignmentRow> rows;
};
/// Refused: a pinion out of reach where it then stands; the name of the misalignment is told.
[[nodiscard]] Result<std::vector<MisalignmentRow>> roll_rows(const RollSide& roll,
                                                             const std::vector<NamedMisalignment>& list);

/// "inside", or the edges that the pattern of a ring reaches: "tip, inner end".
[[nodiscard]] std::string reached_text(const contact::PatternPlace& at_edges, double compound_mm);

/// Centre, extent and edges of the pattern of one ring.
[[nodiscard]] nlohmann::ordered_json place_json(std::size_t zone, const contact::PatternPlace& at_edges,
                                                double compound_mm);
[[nodiscard]] nlohmann::ordered_json table_json(const MisalignmentTable& table);
[[nodiscard]] page::PageTable table_page(const MisalignmentTable& table, const std::string& title);
/// The way of the pattern's centre over the flank.
[[nodiscard]] svg::LineChart centre_chart(const MisalignmentTable& table);

}  // namespace toothpath::ease_off
