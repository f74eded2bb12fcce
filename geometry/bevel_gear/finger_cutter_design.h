// Designs the finger mill of an equal-base-circle bevel gear and judges one that is there already.
//
// Design: module 0.97 .. 0.99 of the normal module at the small end, straight BC down to the depth that the mate's rack
// reaches, tip radius 0.8 of what the tip allows, involute up to 10 .. 15 % above the addendum. Judgement: every
// condition as a number against its limit, the deviation that the mill leaves on the walls when its own module is used
// for the path, and what it cuts off the opposite wall at the small end. mm, rad. Derivation: docs/bevel_gear.md,
// section 4.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel_gear {

enum class Verdict { met, remark, broken };

/// One design condition with its numbers. Angles are in degrees where `unit` says so.
struct CutterCondition {
  std::string name;      ///< "width at the small end"
  std::string quantity;  ///< what the value is: "m_nj / m_n(R_i)"
  double value = 0, limit = 0;
  bool at_least = false;           ///< value must be at least the limit; else at most
  std::string unit;                ///< "mm", "deg", "um" or empty
  Verdict verdict = Verdict::met;  ///< remark: usable, but worth knowing
  std::string meaning;             ///< what happens where it is not met

  [[nodiscard]] std::string text()
      const;  ///< "width at the small end: m_nj / m_n(R_i) = 1.0328, limit <= 0.9900, broken"
};

/// Normal deviation of a wall from the designed gear [mm]; > 0: material left.
struct WallDeviation {
  int half = 0, sigma = 1;
  double least_mm = 0, least_ell = 0, least_height = 0;
  double greatest_mm = 0, greatest_ell = 0, greatest_height = 0;
  int points = 0, missing = 0;  ///< grid points compared, and those where this mill forms no wall
};

struct CutterJudgement {
  FingerCutterData data;
  FingerProfile<double> profile;
  std::vector<CutterCondition> conditions;
  std::vector<WallDeviation> walls;  ///< empty where the profile itself is impossible
  double small_end_overcut_mm = 0;   ///< deepest cut into a wall by the pass of the opposite wall, brute force; 0: none
  double small_end_estimate_mm = 0;  ///< pi (m_nj - m_n(R_i)) / 2; negative: room
  double ridge_mm = 0;               ///< height left on the root at the large end by both walls and the middle pass
  double free_width_small_mm = 0, free_width_large_mm = 0;  ///< of the space beside the mill, normal, pitch cone

  [[nodiscard]] bool usable() const;         ///< no condition is broken
  [[nodiscard]] double deepest_mm() const;   ///< smallest deviation of all walls
  [[nodiscard]] double proudest_mm() const;  ///< largest deviation of all walls
};

/// The mill by the rules above, module and tip radius rounded to what can be ordered. The numbers may be impossible
/// where the gear is; BevelGear::make says why.
[[nodiscard]] FingerCutterData finger_cutter_for(const BevelGearParameters& parameters);

struct FingerCutterDesign {
  FingerCutterData data;
  BevelGear gear;  ///< made with it
};
/// Refused: a gear that no finger mill of these rules makes; "tool." keys speak of the designed mill.
[[nodiscard]] Expected<FingerCutterDesign, std::vector<Refusal>> design_finger_cutter(
    const BevelGearParameters& parameters);

struct JudgementOptions {
  int rows = 9, columns = 13;  ///< of the walls
};
/// Judges a mill on the gear of a design. Its path uses its own r_0.
[[nodiscard]] CutterJudgement judge_finger_cutter(const BevelGear& designed, const FingerCutterData& data,
                                                  const JudgementOptions& options = {});

/// The same for a profile that was made for another gear: other equivalent radius, pressure angle or depth.
[[nodiscard]] CutterJudgement judge_finger_profile(const BevelGear& designed, const FingerCutterData& data,
                                                   const FingerProfile<double>& profile,
                                                   const JudgementOptions& options = {});

/// Where the tip land of one side of the mill would end: x of the profile's parts for drawing and tables.
struct ProfileSample {
  char part = 'A';  ///< 'F' flat, 'R' corner arc, 'S' straight, 'I' involute, 'Z' cylinder
  double p = 0;     ///< running parameter; of flat and cylinder the nearest end
  double from_tip = 0, x = 0, rho = 0, psi_rad = 0;
  double curvature = 0;  ///< of the meridian, 1/mm; > 0: round (arc), < 0: hollow (involute)
};
/// Points from the axis at the tip to the cylinder, every part with its ends; the chords of the involute depart from it
/// by at most `chord_mm`, and so do those of the arc.
[[nodiscard]] std::vector<ProfileSample> sample_profile(const FingerProfile<double>& profile, double chord_mm);

}  // namespace toothpath::bevel_gear
