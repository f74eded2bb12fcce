// Limits of the equal-base-circle bevel gear and of its finger mill: every refusal names value and limit.
#pragma once

#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel_gear {

/// Pitch cone angle [rad]: from the mate and the shaft angle, or as given.
[[nodiscard]] double bevel_pitch_angle(const BevelGearParameters& p);

/// Ranges that each number must keep on its own.
void check_bevel_ranges(const BevelGearParameters& p, const FingerCutterData& c, std::vector<Refusal>& refusals);

/// Design checks of the cutter against the gear (width, point C, tip, arc, retraction, top land, face width). Fills the
/// numbers that belong to them. The gear's blank must be known, its halves need not.
void check_bevel_cutter(const BevelGear& gear, const FingerProfile<double>& cutter, BevelLimits& limits,
                        std::vector<Refusal>& refusals, std::vector<std::string>& warnings);

/// What the early end before the cusp of an equidistant costs on the flank.
void check_bevel_cusp(const BevelGear& gear, std::vector<Refusal>& refusals, std::vector<std::string>& warnings);

/// Remark where the tips of the teeth are thin.
void warn_of_thin_tips(const BevelLimits& limits, std::vector<std::string>& warnings);

/// Largest tip radius of a profile with this straight: not pointed and the arc below C, mm.
[[nodiscard]] double largest_tip_radius(const FingerProfile<double>& cutter);

/// Face width at which m_n(R_i) falls to `module` [mm].
[[nodiscard]] double face_width_for_module(const BevelGear& gear, double module);

/// Normal top land of the equivalent gear at cone distance R, backlash taken off, mm; negative: pointed below the tip.
/// What the cut walls leave is BevelLimits::top_land_mm.
[[nodiscard]] double bevel_top_land(const BevelGear& gear, double R);

}  // namespace toothpath::bevel_gear
