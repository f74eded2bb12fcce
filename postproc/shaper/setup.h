// The set-up of a gear shaper for a face gear: offset slide, stroke, speed, generating, infeed, change gears, times.
// mm and rad inside; strokes per minute; times in min.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "geometry/base/refusal.h"
#include "geometry/face_gear/surface.h"
#include "machines/shaper_machine.h"
#include "postproc/shaper/change_gears.h"
#include "postproc/shaper/shaping.h"
#include "postproc/shaper/simulation.h"

namespace toothpath::shaper {

/// Feed of programs from the clear height down to the work and back [mm/min], unless the axis is slower.
inline constexpr double kApproachFeed = 200;

/// What is to be shaped, and how; the gear's limits have been checked by `FaceGear::make`.
struct ShaperWork {
  std::string job_name;
  std::string machine_file;  ///< as the job names it
  face_gear::FaceGearParameters gear;
  Shaping shaping;
};

/// A mark on the way of the infeed: what is measured if the work makes one full turn at this depth.
struct ShaperPass {
  double x_mm = 0;                                    ///< infeed slide, 0 = full depth
  double depth_mm = 0;                                ///< of the tooth space below the tip surface
  int stroke = 0;                                     ///< the first double stroke at this depth or deeper
  double minutes = 0;                                 ///< from the first stroke
  double tooth_thickness_mm = 0, space_width_mm = 0;  ///< arcs on the tip surface at the inspection radius
};

/// Everything that `shaper.json` states. Signs and symbols: docs of the shaper output.
struct ShaperSetup {
  std::string job_name, machine_file;
  machines::ShaperMachine machine;
  Shaping shaping;
  face_gear::FaceGearSurface<double> surface;
  double inner_radius_mm = 0, outer_radius_mm = 0, depth_mm = 0;
  int cutter_teeth = 0, work_teeth = 0;
  double pitch_diameter_mm = 0;  ///< d_s = m_t N_s

  double slide_mm = 0, offset_reference_mm = 0;  ///< E; L or rho
  double angle_tan_rad = 0, angle_sin_rad = 0;   ///< atan(E/L), asin(E/rho)

  double face_mm = 0, length_mm = 0, start_mm = 0, end_mm = 0;  ///< along the cutter axis
  double strokes_wanted = 0, strokes_set = 0;                   ///< 1/min
  double speed_mean_m_min = 0, speed_peak_m_min = 0;

  machines::Ratio generating;  ///< N_s/N_2 = C_work/C_cutter, without sign
  int sense = 1;
  double cutter_per_stroke_rad = 0;
  double strokes_per_cutter_turn = 0, strokes_per_work_turn = 0;

  int strokes_infeed = 0, strokes_turn = 0;
  double infeed_per_stroke_mm = 0;

  machines::Ratio index_target;
  GearTrain index_gears;
  double feed_target = 0, circular_feed_set_mm = 0;
  GearTrain feed_gears;

  double infeed_min = 0, generating_min = 0;
  std::vector<std::string> warnings;

  double inspection_radius_mm = 0;
  std::vector<ShaperPass> passes;
  BackStrokeClearance relief;

  [[nodiscard]] int strokes_total() const { return strokes_infeed + strokes_turn; }
  [[nodiscard]] double total_min() const { return infeed_min + generating_min; }
  /// Infeed slide in double stroke j = 1, 2, ..: depth (1 - j/strokes_infeed), then 0.
  [[nodiscard]] double x_at_stroke(int j) const;
};

/// Computes the set-up. The gear must have passed `FaceGear::make`. Refused: more than one zone, a helix (needs a
/// guide), a shaft angle other than 90 deg, no stroke step slow enough, a stroke longer than the machine's, travels, no
/// exact index gears (the nearest is named) or a ratio that the electronic gearbox cannot hold, a pointed cutter tip.
/// All refusals that can be found are returned.
Expected<ShaperSetup, std::vector<Refusal>> plan_shaper_setup(const ShaperWork& work,
                                                              const machines::ShaperMachine& machine);

/// Rotations of A (cutter) and C (work) after stroke j, as words in 1e-5 deg: from whole numbers, each rounded on its
/// own (halves away from zero). The work: sense 360 j / strokes_turn; the cutter: 360 j N_2 / (N_s strokes_turn).
struct ShaperAngles {
  std::int64_t cutter = 0, work = 0;
};
[[nodiscard]] ShaperAngles angles_after_stroke(const ShaperSetup& setup, std::int64_t j);

/// How one double stroke's time 1/strokes_set is shared among cutting, lifting, return and approach; the parts add up
/// to 1.
struct StrokeTiming {
  double cutting = 0, lift = 0, back = 0, approach = 0;
};
/// The usual split 0.5, 0.05, 0.4, 0.05 if every axis can follow; else in proportion to what the axes need at least.
/// Nothing if they need more than the whole double stroke; then `least` > 1 is that need.
struct TimingChoice {
  StrokeTiming timing;
  double least = 0;       ///< time that the axes need, as part of the double stroke's time
  const char* axis = "";  ///< which axis rules the longest part
};
[[nodiscard]] TimingChoice choose_timing(const ShaperSetup& setup);

}  // namespace toothpath::shaper
