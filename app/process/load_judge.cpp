#include "app/process/load_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "app/process/proof_limits.h"
#include "app/process/tooth_copies.h"
#include "cam/cut/engagement.h"
#include "geometry/base/angle.h"

namespace toothpath::process {
namespace {

constexpr double kApart = 0.5, kCloser = 0.25;  // radii: angle and stock rise and fall over one
constexpr double kSameCut = 0.02;  // mm, at the tip and at the top of the cutting part: cuts this close meet the same

/// Motions of one operation.
std::vector<path::ToolMotion> of_operation(std::span<const path::ToolMotion> motions, std::size_t n) {
  std::vector<path::ToolMotion> own;
  for (const path::ToolMotion& m : motions)
    if (m.operation == int(n)) own.push_back(m);
  return own;
}

/// Takes the operations one after the other, each with what those before it have left, as long as they have motions.
/// @param take  gets number, motions and stock; false: no more are wanted
template <typename Take>
void for_operations(std::span<const path::ToolMotion> one_space, const LoadQuery& q, const Take& take) {
  std::vector<std::unique_ptr<cut::Removed>> removed;
  std::vector<const cut::Removed*> before;
  for (std::size_t n = 0; n < q.mills.size(); ++n) {
    std::vector<path::ToolMotion> motions = of_operation(one_space, n);
    if (motions.empty()) return;  // told elsewhere
    const cut::EngagementQuery stock{q.mills[n], q.bodies[n].cutting, before, q.in_blank, q.top_mm, 1, q.chart};
    if (!take(n, motions, stock) || n + 1 == q.mills.size()) return;
    removed.push_back(std::make_unique<cut::Removed>(std::move(motions), q.bodies[n], q.top_mm));
    before.push_back(removed.back().get());
  }
}

/// Are these the cuts of a plan, one by one, up to rounding and what a control that moves its joints leaves of a line?
/// A motion may come in pieces.
bool same_cuts(std::span<const path::ToolMotion> pieces, std::span<const path::ToolMotion> plan, double arm_mm) {
  const auto cuts = [](const path::ToolMotion& m) { return !m.rapid && m.tip_from != m.tip_to; };
  const auto near = [&](const Vec3& tip, const Vec3& axis, const path::ToolMotion& m, double t) {
    return (tip - path::tip_at(m, t)).norm() + arm_mm * (axis - path::axis_at(m, t)).norm() <= kSameCut;
  };
  const auto on = [&](const Vec3& tip, const Vec3& axis, const path::ToolMotion& m) {
    const Vec3 way = m.tip_to - m.tip_from;
    return near(tip, axis, m, std::clamp((tip - m.tip_from).dot(way) / way.squaredNorm(), 0.0, 1.0));
  };
  auto piece = std::find_if(pieces.begin(), pieces.end(), cuts);
  for (const path::ToolMotion& m : plan) {
    if (!cuts(m)) continue;
    for (bool ended = false; !ended; piece = std::find_if(piece + 1, pieces.end(), cuts)) {
      if (piece == pieces.end() || !on(piece->tip_from, piece->axis_from, m) || !on(piece->tip_to, piece->axis_to, m))
        return false;
      ended = near(piece->tip_to, piece->axis_to, m, 1);
    }
  }
  return piece == pieces.end();
}

/// So many motions of the median way lie within this: one in so many is looked at, of longer ones too; what links meet
/// shows their chip.
std::size_t one_of(const std::vector<path::ToolMotion>& motions, double apart_mm) {
  std::vector<double> ways;
  for (const path::ToolMotion& m : motions)
    if (const double way = (m.tip_to - m.tip_from).norm(); !m.rapid && way > 0) ways.push_back(way);
  if (ways.empty()) return 1;
  const auto half = ways.begin() + std::ptrdiff_t(ways.size() / 2);
  std::nth_element(ways.begin(), half, ways.end());
  return std::size_t(std::clamp(apart_mm / *half, 1.0, double(motions.size())));
}

/// The same question of motions so many radii apart.
cut::EngagementQuery thinned(cut::EngagementQuery query, const std::vector<path::ToolMotion>& motions,
                             double radii_apart) {
  query.one_of = one_of(motions, radii_apart * query.mill.cutting().largest_radius());
  return query;
}

/// The most that motions are engaged by, where they are loaded, and the line of it.
std::pair<double, int> most_engaged(const std::vector<path::ToolMotion>& motions, const cut::EngagementQuery& query) {
  const std::vector<cut::Engaged> engaged = cut::engagement_along(motions, query);
  std::pair<double, int> most{0, 0};
  for (std::size_t k = 0; k < engaged.size(); ++k)
    if (engaged[k].loaded_rad > most.first) most = {engaged[k].loaded_rad, motions[k].line};
  return most;
}

}  // namespace

std::vector<path::ToolMotion> in_space_0(std::vector<path::ToolMotion> motions, int teeth) {
  for (path::ToolMotion& m : motions) {
    if (m.tooth == 0) continue;
    const Mat3 back = Eigen::AngleAxisd(-2 * kPi * m.tooth / teeth, Vec3::UnitZ()).toRotationMatrix();
    for (Vec3* v : {&m.tip_from, &m.tip_to, &m.axis_from, &m.axis_to}) *v = back * *v;
    m.tooth = 0;
  }
  return motions;
}

std::vector<path::ToolMotion> first_in_space_0(const std::vector<path::ToolMotion>& motions, int teeth) {
  const std::map<int, int> first = first_teeth(motions);
  std::vector<path::ToolMotion> own;
  for (const path::ToolMotion& m : motions)
    if (const auto found = first.find(m.operation); found != first.end() && found->second == m.tooth) own.push_back(m);
  return in_space_0(std::move(own), teeth);
}

PlanAnew planned_once(std::function<PlannedMotions(std::size_t)> plan) {
  const auto kept = std::make_shared<std::optional<PlannedMotions>>();
  return [plan = std::move(plan), kept](std::size_t operations) -> const PlannedMotions& {
    if (!*kept) *kept = plan(operations);
    return **kept;
  };
}

/// The first operation meets the blank, whatever its text lacks.
bool LoadJudge::asks_plan(std::size_t n) const {
  const path::OperationType type = q_.job.operations[n].type;
  return n > 0 && type != path::OperationType::roughing && type != path::OperationType::finger_roughing &&
         !(q_.stock_before_mm[n] < INFINITY);
}

/// The side of a mill is not planned for itself: that takes as long as all the rest.
std::size_t LoadJudge::planned_operations() const {
  std::size_t count = 0;
  for (std::size_t n = 0; n < q_.mills.size(); ++n)
    if (asks_plan(n)) count = q_.job.operations[n].type == path::OperationType::line_milling ? n : n + 1;
  return count;
}

double LoadJudge::planned_stock(std::span<const path::ToolMotion> plan, std::size_t of) const {
  double stock = cut::kLeastStock;
  for_operations(plan, q_, [&](std::size_t n, const auto& motions, const cut::EngagementQuery& query) {
    if (n < of) return true;
    const cut::AskedLoad least{INFINITY, 0, cut::kLeastStock / cut::kLoadFactor};
    stock = std::max(stock, cut::overload_along(motions, thinned(query, motions, kCloser), least).stock_mm);
    return false;
  });
  return stock;
}

double LoadJudge::planned_rad(std::span<const path::ToolMotion> plan, std::size_t of, double radii_apart) const {
  double most = 0;
  for_operations(plan, q_, [&](std::size_t n, const auto& motions, const cut::EngagementQuery& query) {
    if (n < of) return true;
    most = most_engaged(motions, thinned(query, motions, radii_apart)).first;
    return false;
  });
  return most + cut::kEngagementStep;
}

/// Where the text leaves the plan, or an operation ahead did: the teeth against the greatest that they are engaged in
/// the plan. Where few of its motions do not show as much, more of them are looked at.
void LoadJudge::judge_engagement(std::span<const path::ToolMotion> plan, std::size_t n,
                                 const std::vector<path::ToolMotion>& motions, const cut::EngagementQuery& query,
                                 std::vector<std::string>& reasons) const {
  const auto [engaged, line] = most_engaged(motions, thinned(query, motions, kApart));
  if (engaged <= cut::kLoadFactor * planned_rad(plan, n, kApart)) return;
  const double planned = planned_rad(plan, n, kCloser);
  if (engaged <= cut::kLoadFactor * planned) return;
  reasons.push_back(
      fmt::format("operation {}: at line {} its teeth are in the material over {:.0f} deg, in a plan of this job "
                  "over {:.0f} deg at most, limit {:.1f} times that: a cut of the operations ahead is missing",
                  n, line, degrees(engaged), degrees(planned), cut::kLoadFactor));
}

void LoadJudge::judge_stock(std::size_t n, const cut::Overload& load, double stock, std::vector<std::string>& reasons) {
  if (load.stock_mm > 0)
    reasons.push_back(fmt::format(
        "operation {}: at line {} the chip lies {:.3f} mm or more below what was free before, the operations ahead "
        "leave {:.3f} mm, limit {:.1f} times that: a cut of theirs is missing",
        n, load.stock_line, load.stock_mm, stock, cut::kLoadFactor));
}

void LoadJudge::judge(std::span<const path::ToolMotion> one_space, std::vector<std::string>& reasons) const {
  const readback::AskedConditions asked = asked_conditions(q_.job);
  for_operations(one_space, q_, [&](std::size_t n, const auto& motions, const cut::EngagementQuery& query) {
    const double step_down = q_.job.operations[n].step_down_mm, stock = q_.stock_before_mm[n];
    const cut::Overload load = cut::overload_along(motions, query, {asked.operations[n].feed_mm_min, step_down, stock});
    if (load.chip_share > 0)
      reasons.push_back(fmt::format(
          "operation {}: at line {} the tool runs through what stands there with a chip of {:.2f} times the feed per "
          "tooth that the job asks, limit {:.1f} times: a cut ahead of it is missing, or the feed is too quick",
          n, load.chip_line, load.chip_share, cut::kLoadFactor));
    if (load.depth_mm > 0)
      reasons.push_back(
          fmt::format("operation {}: at line {} the chip reaches {:.3f} mm or more above the lowest place of the mill, "
                      "step_down = {:g} mm, limit {:.1f} times that: a cut of the layer above is missing",
                      n, load.depth_line, load.depth_mm, step_down, cut::kLoadFactor));
    judge_stock(n, load, stock, reasons);
    return true;
  });
}

void LoadJudge::judge_by_plan(std::span<const path::ToolMotion> one_space, std::vector<std::string>& reasons,
                              std::vector<std::string>& warnings) const {
  const std::size_t count = planned_operations();
  if (count == 0 || !q_.plan || !reasons.empty()) return;
  const PlannedMotions& planned = q_.plan(count);
  if (!planned) {
    const std::string why =
        "what operations leave for later ones is judged by the job alone, it has no plan: " + planned.error().message;
    if (std::find(warnings.begin(), warnings.end(), why) == warnings.end()) warnings.push_back(why);
    return;
  }
  std::vector<path::ToolMotion> plan = *planned;
  std::copy_if(one_space.begin(), one_space.end(), std::back_inserter(plan),
               [&](const path::ToolMotion& m) { return m.operation >= int(count); });
  bool as_planned = true;
  for_operations(one_space, q_, [&](std::size_t n, const auto& motions, const cut::EngagementQuery& query) {
    as_planned = as_planned && same_cuts(motions, of_operation(plan, n), q_.bodies[n].cutting.back().core.to);
    if (as_planned || !asks_plan(n)) return true;
    const double stock = planned_stock(plan, n);
    const auto load = cut::overload_along(motions, thinned(query, motions, kApart), {INFINITY, 0, stock});
    judge_stock(n, load, stock, reasons);
    if (reasons.empty()) judge_engagement(plan, n, motions, query, reasons);
    return true;
  });
}

LoadedOtherwise::LoadedOtherwise(const ProgramProof& program, const GearCheck& gear) : gear_(gear) {
  if (program.others_text) firsts_ = first_teeth(program.motions);
}

void LoadedOtherwise::see(const std::vector<path::ToolMotion>& motions, std::span<const proof::LikeMotion> likes) {
  if (firsts_.empty()) return;
  auto like = likes.begin();
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const path::ToolMotion& m = motions[k];
    if (like != likes.end() && like->motion == k) ++like;
    else if (!m.rapid && m.tooth != firsts_.at(m.operation) && !teeth_.contains(m.tooth) && gear_.may_cut(m))
      teeth_.insert(m.tooth);
  }
}

void LoadedOtherwise::judge(ProgramProof& program, const LoadJudge& load) const {
  std::size_t refused = 0;
  for (auto& [tooth, cuts] : cuts_of(program, teeth_)) {
    if (refused > kTeethTold) break;  // it is not verified at any rate
    std::vector<std::string> reasons;
    const std::vector<path::ToolMotion> own = in_space_0(std::move(cuts), gear_.teeth());
    load.judge(own, reasons);
    if (program.reasons.empty()) load.judge_by_plan(own, reasons, program.warnings);
    if (!reasons.empty() && ++refused <= kTeethTold)
      for (const std::string& reason : reasons) program.reasons.push_back(fmt::format("tooth {}: {}", tooth, reason));
  }
  if (refused > kTeethTold) program.reasons.emplace_back("so it is with more teeth");
}

}  // namespace toothpath::process
