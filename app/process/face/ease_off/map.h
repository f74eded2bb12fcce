// Ease-off maps of a pair as CSV, JSON, a line of text and drawings.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/report/page/study_page.h"
#include "geometry/contact/ease_off.h"

namespace toothpath::ease_off {

/// The flanks of one side of the teeth with their ease-off. What it points at must outlive it.
struct SideMap {
  int side = 1;
  std::string surface;  ///< "exact" or "cut"
  const std::vector<contact::ContactMember>* members = nullptr;
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
