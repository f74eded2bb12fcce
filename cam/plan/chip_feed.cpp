#include "cam/plan/chip_feed.h"

#include <algorithm>
#include <cmath>

#include "cam/ball/plan.h"
#include "cam/force/engagement.h"
#include "cam/tool/cutters.h"

namespace toothpath::plan {
namespace {

/// Of a smaller share along the normal the points of `engagement_along` may see nothing.
const double kLeastSeen = std::sin(cut::kEngagementStep);

/// Greatest share of the feed along the normal in even stock; 1 where the stock is not known, or too much for a model.
double steepest_in(const std::vector<path::MillingOperation>& operations, const std::vector<tool::ToolAssembly>& tools,
                   std::size_t n, double contact_top_mm) {
  const path::MillingOperation& op = operations[n];
  const tool::ToolAssembly& tool = tools[std::size_t(op.tool)];
  const double stock = ball::stock_before(operations, tools, n);
  if (!(stock > 0 && stock < tool.radius_mm())) return 1;
  const tool::Profile mill = tool::profile_of(tool);
  const auto cut =
      op.type == path::OperationType::line_milling
          ? force::side_engagement(mill, mill.cutting().pieces().front().to[0], contact_top_mm, stock)
          : force::ball_engagement(tool.radius_mm(), stock, force::step_of_scallop(tool.radius_mm(), op.scallop_mm));
  return cut ? std::clamp(cut->steepest, kLeastSeen, 1.0) : 1;
}

}  // namespace

BesideSlots beside_slots(const path::ClPath& path, const std::vector<cut::Engaged>& engaged,
                         const ball::OperationPlan& plan) {
  BesideSlots out;
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const path::ClRecord& to = path.records[k];
    if (to.kind != path::MoveKind::feed) continue;
    const bool opens =
        std::find(plan.openings.begin(), plan.openings.end(), std::pair(to.zone, to.pass)) != plan.openings.end();
    if (opens) out.opening_mm += (to.tip - path.records[k - 1].tip).norm();
    else out.engaged_rad = std::max(out.engaged_rad, engaged[k - 1].loaded_rad);
  }
  return out;
}

double widest_step_mm(const tool::Meridian& cutting, double step_down_mm, double angle_rad) {
  const double radius = cutting.radius(std::clamp(step_down_mm, cutting.from(), cutting.to()));
  return radius * (1 - std::cos(angle_rad));
}

EngagementTrack feed_by_engagement(path::ClPath& path, const std::vector<cut::Engaged>& engaged,
                                   const path::MillingOperation& operation, int teeth) {
  EngagementTrack track;
  track.operation = path.operation;
  double way = 0;
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    path::ClRecord& to = path.records[k];
    if (to.kind != path::MoveKind::feed) continue;
    const cut::Engaged& e = engaged[k - 1];
    const double feed = operation.feed_for(std::max(e.steepest, kLeastSeen), teeth);
    to.feed_mm_min *= feed / operation.feed_mm_min;
    way += (to.tip - path.records[k - 1].tip).norm();
    track.way_mm.push_back(way);
    track.engaged_rad.push_back(e.angle_rad);
    track.chip_mm.push_back(feed / (operation.speed_rpm * teeth) * e.steepest);
    track.feed_mm_min.push_back(feed);
  }
  return track;
}

void feed_by_stock(path::ClPath& path, const std::vector<path::MillingOperation>& operations,
                   const std::vector<tool::ToolAssembly>& tools, std::size_t n, double contact_top_mm) {
  const path::MillingOperation& op = operations[n];
  const double feed = op.feed_for(steepest_in(operations, tools, n, contact_top_mm), tools[std::size_t(op.tool)].teeth);
  for (path::ClRecord& to : path.records)
    if (to.kind == path::MoveKind::feed) to.feed_mm_min *= feed / op.feed_mm_min;
}

}  // namespace toothpath::plan
