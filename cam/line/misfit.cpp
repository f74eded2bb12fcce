#include "cam/line/misfit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cam/cut/swept_tool.h"
#include "geometry/base/golden_section.h"

namespace toothpath::line {
namespace {

constexpr int kHeights = 64, kBlockHeights = 16;
constexpr int kBlockPlaces = 8;     // pieces of a block
constexpr int kSections = 12;       // golden ones about the largest: a 150th of a piece
constexpr int kEndPlaces = 96;      // pieces of an end of the ring, from the tip to the fillet line
constexpr double kFound = 1e-7;     // mm: of what stands along a normal
constexpr double kSag = 1e-5;       // mm: of bodies that stand for a side that bulges or was measured
constexpr double kOnBorder = 1e-9;  // mm: of a strip

/// A place of the flank and the gap that a pose leaves there; by others less may stand.
struct Foot {
  Vec3 p, n;
  double gap = 0;
};

/// Those in the strip and in the ring, the largest gaps between the heights among them.
std::vector<Foot> feet_of(const LineFit& fit, const AxisLine<double>& axis, const Vec3& anchor, const Place& at,
                          int heights) {
  const auto line = fit.gap_along(axis, (anchor - axis.c_0).dot(axis.a), at);
  if (!line || !line->in_ring()) return {};
  std::vector<GapNode> nodes;
  const auto look = [&](double t, const Place& near) {
    const auto node = fit.gap_at(axis, t, near);
    if (!node) return;
    const Strip& strip = fit.strip();
    if (node->depth < strip.top || (strip.bottom && node->depth > *strip.bottom)) return;
    nodes.push_back(*node);
  };
  for (int k = 0; k <= heights; ++k) {
    const double t = line->ring_from + (line->ring_to - line->ring_from) * k / heights;
    look(t, std::min_element(line->nodes.begin(), line->nodes.end(), [&](const GapNode& a, const GapNode& b) {
              return std::abs(a.t - t) < std::abs(b.t - t);
            })->at);
  }
  for (std::size_t k = 1, n = nodes.size(); k + 1 < n; ++k)
    if (nodes[k].e >= nodes[k - 1].e && nodes[k].e > nodes[k + 1].e)
      look(vertex(nodes[k - 1], nodes[k], nodes[k + 1]), nodes[k].at);
  std::vector<Foot> out;
  for (const GapNode& q : nodes)
    out.push_back({axis.at(q.t) - (q.e + fit.law().rho(q.t) + fit.flank().allowance_mm) * q.n, q.n, q.e});
  return out;
}

/// `x` blocks from the first record. Tip and axis of a block go straight.
std::vector<Foot> feet_of(const LineFit& fit, const LinePass& pass, double x) {
  const std::size_t k = std::min(std::size_t(x), pass.records.size() - 2);
  const LineRecord &a = pass.records[k], &b = pass.records[k + 1];
  const double w = x - double(k), r_0 = fit.law().r_0;
  AxisLine<double> axis;
  axis.a = ((1 - w) * a.axis.a + w * b.axis.a).normalized();
  axis.c_0 = (1 - w) * (a.axis.c_0 - r_0 * a.axis.a) + w * (b.axis.c_0 - r_0 * b.axis.a) + r_0 * axis.a;
  return feet_of(fit, axis, (1 - w) * a.anchor + w * b.anchor, between(a.at, b.at, w),
                 w == 0 || w == 1 ? kHeights : kBlockHeights);
}

/// The largest of f over [0, pieces]: at every whole number, then about the largest of these.
template <typename F>
double largest_of(std::size_t pieces, const F& f) {
  std::vector<double> at(pieces + 1, 0.0);
  tbb::parallel_for(std::size_t{0}, at.size(), [&](std::size_t k) { at[k] = f(double(k)); });
  const auto top = std::max_element(at.begin(), at.end());
  const double from = std::max(double(top - at.begin()) - 1, 0.0);
  auto search = golden_section<std::greater<>>(from, std::min(from + 2, double(pieces)), f);
  double found = std::max(*top, search.best().second);
  for (int k = 0; k < kSections; ++k) {
    search.step();
    found = std::max(found, search.best().second);
  }
  return found;
}

/// What a mill in motion leaves above the allowance of a flank.
class Standing {
 public:
  Standing(const FlankTask& flank, const tool::Profile& tool, std::vector<path::ToolMotion> motions)
      : removed_(std::move(motions), tool::proof_tool(tool, 1, kSag).cutting, INFINITY),
        flank_(flank),
        allowance_(flank.allowance_mm),
        cap_(flank.module_mm) {}

  /// Along the normal, no less than `least` and no more than a module.
  [[nodiscard]] double at(const Vec3& p, const Vec3& n, double least) const {
    double h = least;
    for (double step = cap_; step > kFound && h < cap_; h += std::max(step, 0.0))
      step = removed_.excess(p + (allowance_ + h) * n, cap_);
    return std::min(h, cap_);
  }
  /// The most of it at the feet of a pass.
  [[nodiscard]] double at_feet(const LineFit& fit, const LinePass& pass, double least) const {
    const std::size_t pieces = (pass.records.size() - 1) * kBlockPlaces;
    std::vector<double> gaps(pieces + 1, 0.0);
    // First where a pose leaves most: hardly another foot can be more, then.
    least = largest_of(pieces, [&](double x) {
      const auto feet = feet_of(fit, pass, x / kBlockPlaces);
      const auto most =
          std::max_element(feet.begin(), feet.end(), [](const Foot& a, const Foot& b) { return a.gap < b.gap; });
      if (most == feet.end()) return least;
      if (std::floor(x) == x) gaps[std::size_t(x)] = most->gap;
      return most->gap > least ? at(most->p, most->n, least) : least;
    });
    return largest_of(pieces, [&](double x) {
      double most = least;
      if (std::floor(x) == x && gaps[std::size_t(x)] <= least) return most;
      for (const Foot& foot : feet_of(fit, pass, x / kBlockPlaces))
        if (foot.gap > most) most = at(foot.p, foot.n, most);
      return most;
    });
  }
  /// The most of it at an end of the ring, between two depths.
  [[nodiscard]] double across(double s, double top, double bottom, double least) const {
    const auto edge = flank_.space->tip_edge(flank_.side, s);
    if (!edge) return least;
    return largest_of(kEndPlaces, [&](double x) {
      const auto on = flank_.at_u(s, edge->u + (flank_.u_end - edge->u) * x / kEndPlaces);
      const double depth = on ? flank_.depth_of(s, on->p) : NAN;
      return depth >= top - kOnBorder && depth <= bottom + kOnBorder ? at(on->p, on->n, least) : least;
    });
  }
  /// And along the fillet line.
  [[nodiscard]] double along_fillet(std::size_t pieces, double least) const {
    return largest_of(pieces, [&](double x) {
      const auto on = flank_.at_u(flank_.s_from + (flank_.s_to - flank_.s_from) * x / double(pieces), flank_.u_end);
      return on ? at(on->p, on->n, least) : least;
    });
  }

 private:
  cut::SweptTool removed_;
  const FlankTask& flank_;
  double allowance_, cap_;
};

path::ToolMotion motion(const AxisLine<double>& from, const AxisLine<double>& to, double r_0) {
  path::ToolMotion m;
  m.tip_from = from.c_0 - r_0 * from.a;
  m.tip_to = to.c_0 - r_0 * to.a;
  m.axis_from = from.a;
  m.axis_to = to.a;
  return m;
}

/// Planned to stand at an end of the ring where the pose of `record` has its feet before it: by that pose alone.
double unpassed(const LineFit& fit, const tool::Profile& tool, const LineRecord& record, double end) {
  const auto gap = fit.gap_along(record.axis, (record.anchor - record.axis.c_0).dot(record.axis.a), record.at);
  if (!gap || !gap->in_ring()) return 0;
  double top = INFINITY, bottom = -INFINITY;
  for (const GapNode& node : gap->nodes)
    if (node.t >= gap->ring_from && node.t <= gap->ring_to) {
      top = std::min(top, node.depth);
      bottom = std::max(bottom, node.depth);
    }
  const Standing standing(fit.flank(), tool, {motion(record.axis, record.axis, fit.law().r_0)});
  const Strip& strip = fit.strip();
  return standing.across(end, std::max(top, strip.top), std::min(bottom, strip.bottom.value_or(INFINITY)), 0) + kFound;
}

}  // namespace

void measure_left(const FlankTask& flank, const tool::Profile& tool, std::span<LinePass> strips) {
  std::vector<path::ToolMotion> motions;
  for (const LinePass& pass : strips)
    for (std::size_t k = 1; k < pass.records.size(); ++k)
      motions.push_back(motion(pass.records[k - 1].axis, pass.records[k].axis, tool.law()->r_0));
  const Standing standing(flank, tool, std::move(motions));
  const auto cuts = strips_of(flank, int(strips.size()));
  for (std::size_t k = 0; k < strips.size(); ++k) {
    LinePass& pass = strips[k];
    if (pass.records.size() < 2) continue;
    const LineFit fit(flank, *tool.law(), cuts[k]);
    if (pass.shortened_mm > 0)
      pass.unpassed_mm = std::max(unpassed(fit, tool, pass.records.front(), flank.s_from),
                                  unpassed(fit, tool, pass.records.back(), flank.s_to));
    double left = 0;
    for (const double end : {flank.s_from, flank.s_to})
      left = standing.across(end, cuts[k].top, cuts[k].bottom.value_or(INFINITY), left);
    const bool lifted = std::any_of(pass.records.begin(), pass.records.end(), [](const auto& r) { return r.lift > 0; });
    if (lifted && !cuts[k].bottom) left = standing.along_fillet((pass.records.size() - 1) * kBlockPlaces, left);
    pass.left_mm = kPlacesSee * standing.at_feet(fit, pass, left);
  }
}

}  // namespace toothpath::line
