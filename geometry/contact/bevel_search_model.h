// The model of the search (modification_search.h) of a bevel pair: what its mills can take, by profile and by path.
//
// What the profile of a mill takes meets all walls alike, so both walls are searched together; what its path takes
// belongs to one wall of one half. Derivation: docs/ease_off.md 5.
#pragma once

#include "geometry/contact/bevel_pattern_place.h"
#include "geometry/contact/modification_search.h"

namespace toothpath::contact {

/// Side of the teeth by which modifications call wall sigma: right, +1, is wall U.
[[nodiscard]] constexpr int side_of_wall(int sigma) { return -sigma; }

/// Crowning, slope and reliefs of the profile of one member's mill; crowning, slope and end relief of its path, each
/// wall of each half. Reliefs of the profile are up to three quarters of the depth long: the walls of a pair mate over
/// less than their depth.
[[nodiscard]] std::vector<SearchedModification> searched_of_mill(const bevel_gear::BevelGear& gear, bool on_pinion);

/// Of wall sigma: ease-off as the pair stands, with what both gears take already. Motion is counted at the mean pitch
/// circle of the pinion. Refused: as BevelPair::make; no place with a common normal.
[[nodiscard]] Result<SearchModel> bevel_search_model(const bevel_gear::BevelGear& pinion,
                                                     const bevel_gear::BevelGear& wheel, int sigma,
                                                     const Misalignment& moved,
                                                     const std::vector<SearchedModification>& searched,
                                                     const SearchOptions& options);

}  // namespace toothpath::contact
