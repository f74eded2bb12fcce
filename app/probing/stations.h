// Touches of the gear frame as places of a machine.
#pragma once

#include "geometry/inspection/touches.h"
#include "machines/machine.h"
#include "postproc/joints/setup.h"
#include "postproc/probing/probing.h"

namespace toothpath::probing {

/// Way beyond a touch in which it must come, mm.
inline constexpr double kBeyondTouch = 1.5;

/// A place of the gear frame in the work offset, and back; all rotaries at zero.
[[nodiscard]] inline Vec3 in_work_offset(const joints::Setup& setup, const Vec3& p) {
  return setup.origin_mm + setup.rotation() * p - setup.work_offset_at_mm;
}
[[nodiscard]] inline Vec3 in_gear(const joints::Setup& setup, const Vec3& w) {
  return setup.rotation().transpose() * (w + setup.work_offset_at_mm - setup.origin_mm);
}

/// Fills in touches, rotaries, clear height and the height to come and go of a program whose probe is there already.
/// Refused: a gear whose teeth look away from the spindle, a spindle that stands aslant with all rotaries at zero, and
/// a place beyond the travels, with the axis.
[[nodiscard]] Status place_touches(const inspection::TouchPlan& plan, const joints::Setup& setup,
                                   const machines::Machine& machine, ProbeProgram& program);

}  // namespace toothpath::probing
