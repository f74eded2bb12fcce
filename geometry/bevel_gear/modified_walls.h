// The modifications of a bevel gear as its finger mill makes them: what the profile of the mill takes off all walls
// alike, and what its path takes off each. mm. Derivation: docs/modifications.md, section 6.
#pragma once

#include <memory>
#include <optional>

#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel_gear {

/// What the profile of every mill of this gear takes; null: nothing, or what
/// is refused.
[[nodiscard]] std::shared_ptr<const ProfileLaw> profile_law(const BevelGearParameters& parameters);

/// What the path of one wall takes; null: nothing. Precondition: the modifications are not refused.
/// @param zone  half of the gear  @param on  its rectangle
/// @param cutter  whose normal at the pitch cone turns amounts into ways of the path
[[nodiscard]] std::shared_ptr<const LeadLaw> lead_law(const BevelGearParameters& parameters, int sigma, int zone,
                                                      const modification::Rectangle& on,
                                                      const FingerProfile<double>& cutter);

/// Where modifications of a half are counted: twice the addendum deep, along its face.
[[nodiscard]] modification::Rectangle rectangle_of(const BevelGearParameters& parameters, double from, double to);

/// Of a half of a gear: its face without its share of the relief groove.
[[nodiscard]] modification::Rectangle rectangle_of(const BevelGear& gear, int zone);

/// Modifications that do not fit a half, or that one mill on its path does not make.
[[nodiscard]] std::optional<Refusal> refused_modification(const BevelGearParameters& parameters, int zone, int zones,
                                                          const modification::Rectangle& on);

/// What the profile of a modified mill makes impossible: it folds, turns too far, leans inwards.
[[nodiscard]] std::optional<Refusal> refused_profile(const FingerProfile<double>& cutter);

/// What a modified path makes impossible: it turns too far, or the mill no longer fits between both walls.
/// @param R_from, R_to  face of the half
[[nodiscard]] std::optional<Refusal> refused_path(const BevelTrace<double>& trace, double R_from, double R_to);

/// Greatest removal and turn of the normal by profile and paths.
[[nodiscard]] ModifiedForm modified_form(const BevelGear& gear);

}  // namespace toothpath::bevel_gear
