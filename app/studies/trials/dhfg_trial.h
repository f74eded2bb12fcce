// One double helical face gear of a parameter study: limits, feasible halves, contact with its pinion, forces, milling
// time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/studies/trials/dhfg_loaded.h"
#include "cam/path/operation.h"
#include "cam/tool/assembly.h"
#include "geometry/contact/face_gear_forces.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::trials {

/// What all trials of a study share.
struct DhfgStudy {
  std::string name, file;
  face_gear::FaceGearParameters
      base;  ///< module, reading, pressure angle, coefficients, tip radius; teeth and zones come from the trial
  std::vector<double> pinion_teeth, ratio, helix_angle_rad;  ///< three levels each
  double half_face_mm = 0;                    ///< radial width of each half beside the groove; 0: all that is feasible
  double groove_width_mm = 8, margin_mm = 1;  ///< between the halves; kept clear of R1 and R2'
  double torque_nmm = 532e3;                  ///< on the face gear
  double held_share =
      0.65;  ///< torque share of the outer half when the pinion is held along its axis and one half bears first
  LoadedEffort effort;
  std::vector<tool::ToolAssembly> tools;
  std::vector<path::MillingOperation> operations;  ///< none: no milling time
  double rapid_mm_min = 10000;                     ///< for the time of rapids
};

/// Rows of the orthogonal array L9(3^4), levels 0 to 2 of teeth, ratio and helix angle; the fourth column is the error
/// group.
struct TrialLevels {
  int number = 0, teeth = 0, ratio = 0, helix = 0, blank = 0;
};
[[nodiscard]] const std::vector<TrialLevels>& l9_trials();

struct MillingTime {
  double cutting_minutes = 0,
         rapid_minutes = 0;   ///< all teeth: the planned path at its feeds; no acceleration, no tool changes
  std::size_t cl_points = 0;  ///< one tooth space
  std::string refusal;        ///< not empty: what the planner said instead
};

struct DhfgTrial {
  TrialLevels levels;
  int pinion_teeth = 0, teeth = 0;
  double helix_angle_rad = 0;
  // Limits of either half: equal by the mirror identity.
  double R1_mm = 0, R2_mm = 0, land_mm = 0, L_p_mm = 0;  ///< R1, pointing R2, R2' at a land of 0.2 m
  std::string R1_name;
  double inner_mm = 0, groove_mm = 0,
         outer_mm = 0;      ///< R_in, R_g, R_out as chosen: band less margins, groove in the middle
  double feasible_mm = 0;   ///< largest radial width of each half; <= 0: not feasible
  double half_face_mm = 0;  ///< as chosen
  std::string refusal;      ///< why there is no gear
  // Contact with the pinion of as many teeth as the shaper: line contact.
  double overlap_halves[2] = {0, 0}, overlap = 0;  ///< contact ratio of inner and outer half; of the V-teeth
  int least_pairs = 0, most_pairs = 0;
  double error_range_rad = 0;
  double marked_share = 0;  ///< of the flanks, by the compound of a rolling tester; of the less marked half
  // Forces: rigid statics.
  contact::DoubleMeshForce balanced, held;
  LoadedTrial loaded;
  MillingTime milling;
};

/// A trial with its limits alone, and its gear where nothing refuses it.
struct TrialGear {
  DhfgTrial trial;
  std::optional<face_gear::FaceGear> gear;
};
[[nodiscard]] TrialGear trial_gear(const DhfgStudy& study, const TrialLevels& levels);

/// The trial's gear with halves of this width around the same groove, under load.
[[nodiscard]] LoadedTrial load_with_halves(const DhfgStudy& study, const TrialLevels& levels, double half_face_mm,
                                           const LoadedEffort& effort);

/// Computes one trial. Nothing is refused: what does not work stands in `refusal` of the trial or of its milling.
[[nodiscard]] DhfgTrial dhfg_trial(const DhfgStudy& study, const TrialLevels& levels);

}  // namespace toothpath::trials
