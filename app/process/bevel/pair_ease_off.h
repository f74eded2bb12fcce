// Ease-off, motion curve and misalignment of a bevel pair for `toothpath contact`: what stands in its report beside the
// mismatch.
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/process/bevel/searched_pair.h"
#include "app/process/ease_off/map.h"
#include "app/process/ease_off/motion.h"
#include "app/process/ease_off/optimiser.h"
#include "geometry/contact/bevel_pattern_place.h"

namespace toothpath::bevel {

struct PairEaseOff {
  double compound_mm = 0;
  std::array<std::optional<contact::BevelEaseOff>, 2> walls;  ///< L, U; none: no place has a common normal
  std::array<std::vector<contact::PatternPlace>, 2> places;   ///< of the patterns, one a half
  std::array<ease_off::MotionCurve, 2> motion;
  ease_off::Misaligned misaligned;
};
/// @param rolled  walls L and U of the pair as it stands
/// Refused: what `misalign` refuses; --write of keys that belong to the mate.
[[nodiscard]] process::ValueOrErrors<PairEaseOff> analyse_ease_off(const BevelPairAsked& pair,
                                                                   const contact::BevelPair& stands,
                                                                   const std::vector<contact::BevelContact>& rolled,
                                                                   const process::ContactAsked& asked,
                                                                   app::StageClock& clock);

/// Joins ease_off, motion_curve and zones of wall `side` to its entry.
void add_wall(nlohmann::ordered_json& wall, const PairEaseOff& found, std::size_t side);
/// Drawings, tables and words of the page.
void add_to_page(page::StudyPage& page, const PairEaseOff& found);
/// For the screen.
[[nodiscard]] std::string ease_off_summary(const PairEaseOff& found);
/// ease_off.csv.
[[nodiscard]] std::string ease_off_csv(const PairEaseOff& found);

}  // namespace toothpath::bevel
