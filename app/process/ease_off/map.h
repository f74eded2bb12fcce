// Ease-off maps of a pair as CSV, JSON, a line of text and drawings.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/process/ease_off/words.h"
#include "app/report/page/study_page.h"
#include "geometry/contact/ease_off.h"

namespace toothpath::ease_off {

/// The grid of one flank, as its map has it.
struct MappedFlank {
  int zone = 0, rows = 0, columns = 0;
  std::vector<double> x, y;  ///< mm, row by row: along the face and across it, as the words of the pair call them
  [[nodiscard]] std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
};

/// The flanks of one side of the teeth with their ease-off. What it points at must outlive it.
struct SideMap {
  const PairWords* words = nullptr;
  std::string side;  ///< first cell of a line of ease_off.csv, or its first two: with the surface ahead
  std::vector<MappedFlank> flanks;
  const contact::EaseOff* found = nullptr;  ///< null: no place has a common normal
};

/// ease_off.csv: every place of every flank.
[[nodiscard]] std::string map_csv(const std::vector<SideMap>& sides);
/// Least, greatest and a grid of at most 11 x 13 places a ring; null without a map.
[[nodiscard]] nlohmann::ordered_json map_json(const SideMap& side);
/// For the screen: a line.
[[nodiscard]] std::string map_summary(const SideMap& side);
/// One a ring. @param name of the flank, for the captions
[[nodiscard]] std::vector<page::StudyPage::Figure> map_figures(const SideMap& side, const std::string& name);

}  // namespace toothpath::ease_off
