// Cusp heights that would be planned for minutes: passes and places are counted before one is laid.
#pragma once

#include <optional>

#include "cam/ball/finishing.h"
#include "geometry/base/refusal.h"

namespace toothpath::ball {

/// Of one tooth space: plan, text and proof of so many take about a minute, and 300 bytes each until they are a
/// program.
inline constexpr std::size_t kMostPlaces = 200'000;

/// About how many places finishing lays.
[[nodiscard]] double finishing_places(const tooth_space::OffsetSheet& sheet, const FinishingOptions& options);

/// Cusps that make more than `kMostPlaces` of one tooth space: "scallop" where all regions ask for the same height,
/// else "scallop.flank" or another, the region with the most passes; with the least that does. Nothing: they make
/// fewer. Counted by curvatures alone, as the planner begins: it may need some more passes, no fewer.
[[nodiscard]] std::optional<Refusal> cusps_too_small(const tooth_space::OffsetSheet& sheet,
                                                     const FinishingOptions& options);

}  // namespace toothpath::ball
