#include "postproc/timing/model_text.h"

#include <fmt/format.h>

namespace toothpath::timing {

std::string model_text(const machines::Machine& machine, Corners corners) {
  if (!machine.has_acceleration())
    return "without accelerations, the machine file states none (max_acceleration): the machine takes longer";
  const std::string limits =
      fmt::format("with speeds, accelerations{} of the axes{}", machine.has_jerk() ? " and jerks" : "",
                  machine.has_jerk() ? "" : ", no jerk stated");
  const PathControl control = control_of(machine, corners);
  if (control.corners == Corners::exact)
    return fmt::format("{}, corners by the rules of LinuxCNC 2.9, servo period {:g} ms assumed", limits,
                       control.period_min * 60000);
  if (control.corners == Corners::stop)
    return fmt::format("{}, a stop at every corner (G61), its wait for the position of the axes not counted", limits);
  if (is_bounded(control.corners))
    return fmt::format(
        "{}, assumed: corners are parabolas within the contour tolerance of the text, or every axis jumps by what it "
        "accelerates in {:g} ms (min_block_ms)",
        limits, control.jump_min * 60000);
  return fmt::format("{}, assumed: at corners every axis may jump by what it accelerates in {:g} ms (min_block_ms)",
                     limits, control.jump_min * 60000);
}

}  // namespace toothpath::timing
