// Rapids of a program that was read back: one group of axes a move, and the whole tool clear of the part and its
// fixture at every moment. A rapid is followed as motions of the tip in W (postproc/readback/motion.cpp); each is
// proven by cam/proof/rapid_clearance.h.
#include <algorithm>
#include <cmath>

#include "cam/proof/rapid_clearance.h"
#include "cam/tool/body.h"
#include "postproc/readback/reader.h"

namespace toothpath::readback {
namespace {

constexpr std::size_t kTogether = 4096;  // rapids that are followed at a time
constexpr double kFarEnd = 0.005;  // mm: turns at the far end of the tool, and 50 times as much (MotionTolerances)

/// More than one of Z, XY and the rotaries moves.
bool mixes_axes(const ExecutedMove& a, const ExecutedMove& b) {
  const bool xy = a.joints[0] != b.joints[0] || a.joints[1] != b.joints[1];
  const bool z = a.joints[2] != b.joints[2];
  const bool rotary = a.joints[3] != b.joints[3] || a.joints[4] != b.joints[4];
  return int{xy} + int{z} + int{rotary} > 1;
}

/// Nothing is known of a tool without a description but its length: its tip is checked as a point.
tool::ToolAssembly bare_tip(int number) {
  tool::ToolAssembly t;
  t.number = number;
  return t;
}

}  // namespace

bool mixes_axis_groups(const ExecutedMove& from, const ExecutedMove& to) {
  return to.rapid && to.known && !to.tcp && mixes_axes(from, to);
}

Status check_axis_groups(const OperationTrace& trace) {
  for (std::size_t i = 1; i < trace.moves.size(); ++i)
    if (mixes_axis_groups(trace.moves[i - 1], trace.moves[i]))
      return fail_as(DiagnosticKind::verification, "line {}: a rapid moves more than one group of axes",
                     trace.moves[i].line);
  return Ok{};
}

Status check_rapids_outside(const OperationTrace& trace, const NcControl& control, const machines::Machine& machine,
                            const joints::Setup& setup, const proof::RapidObstacle& obstacle,
                            std::span<const tool::ToolAssembly> tools) {
  const auto found =
      std::find_if(tools.begin(), tools.end(), [&](const tool::ToolAssembly& t) { return t.number == trace.tool; });
  const tool::ToolAssembly tool = found != tools.end() ? *found : bare_tip(trace.tool);
  double reach = tool.length_mm;  // from the tip; a holder that goes on above the gauge line is the machine's
  for (const tool::Frustum& body : tool::shank_and_holder(tool))
    reach = std::max(reach, std::hypot(body.to, std::max(body.radius_from, body.radius_to)));
  const double axis_rad = kFarEnd / std::max(reach, 5.0);
  // Rapids that follow one another, with the moves on either side that their corners lie on.
  const std::size_t behind = trace.moves.size() - trace.after;
  for (std::size_t i = trace.before; i < behind;) {
    if (!trace.moves[i].rapid) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < behind && trace.moves[end].rapid && end - i < kTogether) ++end;
    OperationTrace stretch{trace.operation, trace.tool, trace.kept_teeth, 0, {}};
    stretch.moves.assign(trace.moves.begin() + std::ptrdiff_t(i < 2 ? 0 : i - 2),
                         trace.moves.begin() + std::ptrdiff_t(std::min(end + 1, trace.moves.size())));
    const auto motions = tool_motions(stretch, {}, control, machine, setup, 1, {0.001, axis_rad});
    if (!motions) return motions.error();
    for (const auto& m : *motions) {
      if (!m.rapid) continue;
      const auto proof = proof::prove_rapid(m, tool, obstacle);
      if (!proof.clear)
        return fail_as(DiagnosticKind::verification,
                       "line {}: a rapid passes through the part: the {} of the tool, tip at r {:.3f} z {:.3f} mm",
                       m.line, proof.body, proof.tip.head<2>().norm(), proof.tip.z());
    }
    i = end;
  }
  return Ok{};
}

Status check_rapids(const OperationTrace& trace, const NcControl& control, const machines::Machine& machine,
                    const joints::Setup& setup, const joints::ClearanceBody& body,
                    std::span<const tool::ToolAssembly> tools) {
  if (const auto single = check_axis_groups(trace); !single) return single;
  return check_rapids_outside(trace, control, machine, setup, obstacle_of(body), tools);
}

}  // namespace toothpath::readback
