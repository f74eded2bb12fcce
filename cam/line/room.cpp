#include "cam/line/room.h"

#include <cmath>
#include <memory>
#include <optional>

#include "cam/analytic/body_sweep.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::line {
namespace {

constexpr double kStockProof = 1e-3;  // mm: to which stock is decided
constexpr double kTouchProof = 1e-4;  // mm: to which a pose in contact is decided

path::ToolMotion standing(const AxisLine<double>& axis, double r_0) {
  path::ToolMotion m;
  m.tip_from = m.tip_to = axis.c_0 - r_0 * axis.a;
  m.axis_from = m.axis_to = axis.a;
  return m;
}

}  // namespace

Room room_of(const analytic::GearDistance& part, const tool::Profile& profile, const RoomOptions& options) {
  const auto tool = std::make_shared<const tool::ProofTool>(tool::proof_tool(profile, 0));
  const double r_0 = profile.law() ? profile.law()->r_0 : 0;
  return [&part, tool, r_0, options](const AxisLine<double>& axis) -> std::optional<Blocked> {
    if (part.refusal()) return Blocked{"flute", "inside", -INFINITY, 0, Blocked::Need::touch};
    const auto m = standing(axis, r_0);
    analytic::SweptGapOptions cutting;
    cutting.touching = true;
    cutting.enough_mm = 0.01;
    cutting.contact_mm = 0.01;
    cutting.contact_proof_mm = kTouchProof;
    cutting.settled_mm = -options.touch_mm;
    for (const auto& body : tool->cutting)
      if (const auto gap = analytic::swept_gap(part, body, m, cutting); gap.proven_mm < -options.touch_mm)
        return Blocked{to_string(body.core.body), gap.patch, gap.measured_mm, -options.touch_mm, Blocked::Need::touch};
    if (options.stock_mm > 0) {
      cutting.flanks_only = true;
      cutting.enough_mm = options.stock_mm + 0.05;
      cutting.contact_mm = options.stock_mm + 0.01;
      cutting.contact_proof_mm = kStockProof;
      cutting.settled_mm = options.stock_mm;
      for (const auto& body : tool->cutting)
        if (const auto gap = analytic::swept_gap(part, body, m, cutting); gap.proven_mm < options.stock_mm)
          return Blocked{to_string(body.core.body), gap.patch, gap.measured_mm, options.stock_mm, Blocked::Need::stock};
    }
    analytic::SweptGapOptions beside;
    beside.enough_mm = options.clearance_mm + 0.01;
    beside.settled_mm = options.clearance_mm;
    for (const auto& body : tool->bodies)
      if (const auto gap = analytic::swept_gap(part, body, m, beside); gap.proven_mm < options.clearance_mm)
        return Blocked{to_string(body.body), gap.patch, gap.measured_mm, options.clearance_mm,
                       Blocked::Need::clearance};
    return {};
  };
}

}  // namespace toothpath::line
