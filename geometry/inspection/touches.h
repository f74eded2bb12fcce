// Touching a blank, or teeth that are already there: where a probe's ball meets the exact surfaces, and where the gear
// stands by what it met.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/face_gear/gear.h"

namespace toothpath::inspection {

/// What touches, and what it must keep away from; mm.
struct TouchOptions {
  double ball_diameter_mm = 0;  ///< > 0; it must fit between the flanks
  double allowance_mm = 0;      ///< that still stands on the flanks
  double approach_mm = 1;       ///< way to a touch, at most: where the space is narrow it is shorter
  double least_gap_mm = 0.05;   ///< of ball and stem from everything that is not touched
  int spaces = 4;               ///< tooth spaces, evenly around, 3 or more
};

enum class Touched : std::uint8_t { flank, top, rim };

/// One touch; gear frame.
struct Touch {
  int number = 0;  ///< from 1
  Touched what = Touched::flank;
  int zone = 0, side = 1, tooth = 0;
  Vec3 centre = Vec3::Zero();   ///< of the ball when it touches
  Vec3 normal = Vec3::UnitZ();  ///< out of the material: the ball comes from there
  double approach_mm = 0;       ///< way of the ball to it
  [[nodiscard]] Vec3 start() const { return centre + approach_mm * normal; }
};

struct TouchPlan {
  std::vector<Touch> touches;
  double clear_z_mm = 0;  ///< from here downwards only the way to a touch
  double gap_mm = 0;      ///< least gap of ball and stem that was found, but for what is touched
};

/// Both flanks of the asked spaces, at half their height: at a quarter and three quarters of the face, or in the middle
/// of each of two zones. The ball goes down from above to the start of the touch, to the touch and back; on all of this
/// way and with its stem above it, it keeps the gap from the other flank, the root and the tops.
/// Refused: options outside their range, a ball that is too large for the space, with the largest that fits.
[[nodiscard]] Result<TouchPlan> plan_touches(const face_gear::FaceGear& gear, const TouchOptions& options);

/// The turned blank instead: its top in `spaces` places at the middle radius of the outer ring, and its rim below each
/// of them. That places the gear, but for the turn of teeth that are not there yet.
/// Refused: options outside their range, a shaft angle other than 90 deg, whose blank has no flat top.
[[nodiscard]] Result<TouchPlan> plan_blank_touches(const face_gear::FaceGear& gear, const TouchOptions& options);

/// One result: the centre of the ball as the control logged it, turned and moved into the gear frame of the job.
struct TouchResult {
  int number = 0;  ///< of the plan
  Vec3 centre = Vec3::Zero();
  SourcePosition at;
};

/// Where the gear stands against the gear frame of the job.
struct Placement {
  Vec3 moved_mm = Vec3::Zero();  ///< of its origin
  double clocking_rad = 0;       ///< turn about z; 0 where no teeth were touched
  Vec2 tilt_rad = Vec2::Zero();  ///< turn about x and y that the touches show beside; not part of the place
  double residual_mm = 0;        ///< largest that the place leaves of a touch
  double rms_mm = 0;
  Vec3 moved_sigma_mm = Vec3::Zero();  ///< standard deviations by the scatter of the touches
  double clocking_sigma_rad = 0;
};

/// A gear may stand so far off the place that the job states, mm: farther off it is another set-up.
inline constexpr double kFarthestMoved = 5;
/// A touch may lie so far off what all of them together say, mm.
inline constexpr double kWorstTouch = 0.03;
/// A lean of the axis may cost so much at the outer radius, mm: the program cannot follow it.
inline constexpr double kMostLean = 0.02;

/// Least squares on exact distances: the place of the gear that puts all centres at ball radius and allowance above
/// their flanks. Refused, at the file or the touch: touches that are missing, twice or not of the plan; a place farther
/// than 5 mm off; an axis that leans; touches that do not agree, naming the one without which the others do.
[[nodiscard]] Result<Placement> place_of_gear(const face_gear::FaceGear& gear, const TouchPlan& plan,
                                              const TouchOptions& options, const std::vector<TouchResult>& results,
                                              const std::string& file);

}  // namespace toothpath::inspection
