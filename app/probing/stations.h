// Touches of the gear frame as places of a machine.
#pragma once

#include <array>
#include <vector>

#include "geometry/inspection/touches.h"
#include "machines/machine.h"
#include "postproc/joints/setup.h"
#include "postproc/probing/probing.h"

namespace toothpath::probing {

/// Way beyond a touch in which it must come, mm.
inline constexpr double kBeyondTouch = 1.5;

/// How a part stands for each touch of a plan: rotary angles at which the stem is upright.
class Stations {
 public:
  /// Refused: a part whose teeth look away from the spindle, a touch for which no rotary angles within the travels set
  /// the stem upright, and a spindle that stands aslant then.
  [[nodiscard]] static Result<Stations> make(const inspection::TouchPlan& plan, const joints::Setup& setup,
                                             const machines::Machine& machine);

  /// A place of the gear frame in the work offset while the machine stands for touch `number`, and back.
  [[nodiscard]] Vec3 in_work_offset(int number, const Vec3& p) const;
  [[nodiscard]] Vec3 in_gear(int number, const Vec3& w) const;

  /// Fills in touches, clear height and the height to come and go of a program whose probe is there already. Refused: a
  /// place beyond the travels, with the axis.
  [[nodiscard]] Status place(const inspection::TouchPlan& plan, ProbeProgram& program) const;

 private:
  Stations(const joints::Setup& setup, const machines::Machine& machine) : setup_(setup), machine_(machine) {}
  [[nodiscard]] Status holds(const Vec3& in_work, const ProbeTouch& touch, double length) const;
  [[nodiscard]] double clear(const inspection::TouchPlan& plan, double ball_mm) const;

  const joints::Setup& setup_;
  const machines::Machine& machine_;
  std::vector<std::array<double, 2>> rotary_rad_;  ///< of every touch
};

}  // namespace toothpath::probing
