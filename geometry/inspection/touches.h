// Touching a blank, or teeth that are already there: where a probe's ball meets the exact surfaces, and where the gear
// stands by what it met.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::inspection {

/// What touches, and what it must keep away from; mm.
struct TouchOptions {
  double ball_diameter_mm = 0;  ///< > 0; it must fit between the flanks
  double allowance_mm = 0;      ///< that still stands on the flanks
  double approach_mm = 1;       ///< way to a touch, at most: where the space is narrow it is shorter
  double least_gap_mm = 0.05;   ///< of ball and stem from everything that is not touched
  int spaces = 4;               ///< tooth spaces, evenly around, 3 or more
};

/// `top` and `rim` of a blank; `end`: the end face of a tooth, on which no allowance stands.
enum class Touched : std::uint8_t { flank, top, rim, end };

/// One touch; gear frame.
struct Touch {
  int number = 0;  ///< from 1
  Touched what = Touched::flank;
  int zone = 0, side = 1;
  int space = 0;                ///< tooth space that the ball is in
  std::string remark;           ///< what is touched: ASCII, upper case
  Vec3 surface = Vec3::Zero();  ///< the place of the part that is touched
  Vec3 centre = Vec3::Zero();   ///< of the ball when it touches
  Vec3 normal = Vec3::UnitZ();  ///< out of the material: the ball comes from there
  Vec3 up = Vec3::UnitZ();      ///< from the ball along the stem
  double approach_mm = 0;       ///< way of the ball to it
  [[nodiscard]] Vec3 start() const { return centre + approach_mm * normal; }
};

/// A cylinder about z that holds a part.
struct PartReach {
  double low_mm = 0, high_mm = 0, radius_mm = 0;
};

struct TouchPlan {
  std::vector<Touch> touches;
  PartReach reach;    ///< above it a probe goes freely
  double gap_mm = 0;  ///< least gap of ball and stem that was found, but for what is touched
};

/// A part whose surfaces are touched, as planning and placing ask for it; gear frame, mm.
class TouchedPart {
 public:
  TouchedPart() = default;
  TouchedPart(const TouchedPart&) = delete;
  TouchedPart& operator=(const TouchedPart&) = delete;
  virtual ~TouchedPart() = default;

  [[nodiscard]] virtual int teeth() const = 0;
  [[nodiscard]] virtual PartReach reach() const = 0;
  /// Places of both flanks of the asked spaces, without ball and approach; where flanks alone do not show the place
  /// along the axis, ends of teeth, too.
  [[nodiscard]] virtual Result<std::vector<Touch>> flank_places(int spaces) const = 0;
  /// The same of the turned blank: those show the place of the part, but for its turn.
  [[nodiscard]] virtual Result<std::vector<Touch>> blank_places(int spaces) const = 0;
  /// Signed distance of a place from the surface of a touch, > 0 outside; nothing: none belongs to it.
  [[nodiscard]] virtual std::optional<double> distance(const Touch& touch, const Vec3& x) const = 0;
  /// The same from the flank of a side of the space that the touch is in, which goes on above the tops; below all
  /// numbers where the place cannot be judged.
  [[nodiscard]] virtual double flank(const Touch& touch, int side, const Vec3& x) const = 0;
  /// Height above the root of that space.
  [[nodiscard]] virtual double above_root(const Touch& touch, const Vec3& x) const = 0;
  /// Way up from a place to above the tops, 0 where it is there.
  [[nodiscard]] virtual double below_tops(const Touch& touch, const Vec3& x) const = 0;
};

/// Touches of both flanks. The ball goes down to the start of a touch, to the touch and back; on all of this way and
/// with its stem above it, it keeps the gap from the other flank, the root and, but for the touch, the flank itself.
/// Refused: options outside their range, a ball that is too large for the space, with the largest that fits; what the
/// part refuses.
[[nodiscard]] Result<TouchPlan> plan_touches(const TouchedPart& part, const TouchOptions& options);
/// The turned blank instead.
[[nodiscard]] Result<TouchPlan> plan_blank_touches(const TouchedPart& part, const TouchOptions& options);

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

/// Least squares on exact distances: the place of the part that puts all centres at ball radius and allowance above
/// their surfaces. Refused, at the file or the touch: touches that are missing, twice or not of the plan; a place
/// farther than 5 mm off; an axis that leans; touches that do not agree, naming the one without which the others do.
[[nodiscard]] Result<Placement> place_of_part(const TouchedPart& part, const TouchPlan& plan,
                                              const TouchOptions& options, const std::vector<TouchResult>& results,
                                              const std::string& file);

}  // namespace toothpath::inspection
