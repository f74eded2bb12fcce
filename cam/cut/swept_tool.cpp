#include "cam/cut/swept_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace toothpath::cut {
namespace {

constexpr int kMomentSteps = 40;   // of the bracket of a moment; each at least halves it every second time
constexpr double kMoment = 1e-12;  // share of a motion
constexpr int kMostStretches = 12;
constexpr std::size_t kSeen = 64;  // bodies in motion that were looked at last: each has several boxes

/// The distance at a moment and its rate.
struct AtMoment {
  double distance = 0, rate = 0;
};
AtMoment at_moment(const Vec3& p, const tool::RoundedFrustum& body, const path::ToolMotion& m, double t) {
  const Vec3 blend = (1 - t) * m.axis_from + t * m.axis_to, a = t == 0   ? m.axis_from
                                                                : t == 1 ? m.axis_to
                                                                         : Vec3(blend.normalized());
  const Vec3 d = p - path::tip_at(m, t);
  const double h = d.dot(a);
  const Vec3 across = d - h * a;
  const double rho = across.norm();
  const auto s = tool::rounded_slope(Vec3(rho, 0, h), body);
  // d(h) and d(rho) along the motion; the tip moves straight, the axis turns about it.
  const Vec3 v = m.tip_to - m.tip_from, step = m.axis_to - m.axis_from, turn = (step - step.dot(a) * a) / blend.norm();
  const double dh = d.dot(turn) - v.dot(a), drho = rho > 0 ? (-v.dot(across) - h * turn.dot(across)) / rho : 0;
  return {s.distance, s.gradient.x() * drho + s.gradient.z() * dh};
}

/// Where the cutting part may be during a motion, below `top`: every stretch of every body about as long as it is wide.
/// `owners`: the motion of each box, times the number of bodies, and the body.
std::vector<analytic::Box> boxes_of(const std::vector<path::ToolMotion>& motions,
                                    const std::vector<tool::RoundedFrustum>& cutting, double top,
                                    std::vector<std::size_t>& owners) {
  std::vector<analytic::Box> boxes;
  for (std::size_t k = 0; k < motions.size(); ++k)
    for (std::size_t part = 0; part < cutting.size(); ++part) {
      const auto& body = cutting[part];
      const tool::Frustum& core = body.core;
      const double length = core.to - core.from;
      const int stretches = std::clamp(int(std::ceil(length / (2 * body.widest()))), 1, kMostStretches);
      for (int n = 0; n < stretches; ++n) {
        const double low = core.from + length * n / stretches, high = core.from + length * (n + 1) / stretches;
        const auto at = [&](double h) {
          return length > 0 ? core.radius_from + (core.radius_to - core.radius_from) * (h - core.from) / length
                            : std::max(core.radius_from, core.radius_to);
        };
        analytic::Box box;
        const double radius = std::max(at(low), at(high)) + body.round;
        for (const auto& [tip, axis] :
             {std::pair{motions[k].tip_from, motions[k].axis_from}, std::pair{motions[k].tip_to, motions[k].axis_to}})
          for (const double h : {low, high}) {
            const double arc = 0.125 * (motions[k].axis_to - motions[k].axis_from).squaredNorm() * h;  // of a turn
            const Vec3 c = tip + h * axis, r = Vec3::Constant(radius + arc);
            box.add(c - r);
            box.add(c + r);
          }
        if (box.low.z() > top && n > 0) continue;
        box.high.z() = std::max(std::min(box.high.z(), top), box.low.z());
        boxes.push_back(box);
        owners.push_back(k * cutting.size() + part);
      }
    }
  return boxes;
}

}  // namespace

MotionReach::MotionReach(const path::ToolMotion& m) : way((m.tip_to - m.tip_from).norm()) {
  const double half = std::min(0.5 * (m.axis_to - m.axis_from).norm(), 0.9999);
  turn = 2 * half / std::sqrt(1 - half * half);
}

double least_distance(const Vec3& p, const tool::RoundedFrustum& body, const path::ToolMotion& m,
                      const MotionReach& reach, double enough, double near) {
  // Seen from the tool, the place goes no farther than `way` + turn arm, and leaves the tangent of its way by no more
  // than `bends`; the distance is convex in the place, with a slope of 1 at most.
  const double way = reach.way, turn = reach.turn;
  const Vec3 d = p - m.tip_from;
  const double h = d.dot(m.axis_from), arm = d.norm() + way;
  // Most places are beyond a cylinder about the body, all the way.
  const tool::Frustum& core = body.core;
  const double beyond =
      std::max({(d - h * m.axis_from).norm() - body.widest(), core.from - body.round - h, h - core.to - body.round}) -
      way - turn * arm;
  if (beyond > enough) return beyond;
  const AtMoment first = at_moment(p, body, m, 0);
  const double bends = 0.5 * (turn * turn * std::sqrt(1 + turn * turn) * arm + 2 * turn * way);
  if (first.distance + std::max(std::min(first.rate, 0.0) - bends, -way - turn * arm) > enough) return first.distance;
  if (first.distance < near) return first.distance;
  const AtMoment last = at_moment(p, body, m, 1);
  double least = std::min(first.distance, last.distance);
  if (first.rate >= 0 || last.rate <= 0 || least < near) return least;
  // A tangent from either end bounds it from below.
  const double meet = (last.distance - last.rate - first.distance) / (first.rate - last.rate);
  if (first.distance + first.rate * meet - bends > enough) return least;
  double a = 0, fa = first.rate, b = 1, fb = last.rate;
  for (int k = 0; k < kMomentSteps && b - a > kMoment; ++k) {
    double x = k % 3 == 2 ? 0.5 * (a + b) : a + (b - a) * fa / (fa - fb);
    x = std::clamp(x, a, b);
    const AtMoment q = at_moment(p, body, m, x);
    least = std::min(least, q.distance);
    if (least < near || std::abs(q.rate) * (b - a) < 1e-10) break;
    (q.rate < 0 ? a : b) = x;
    (q.rate < 0 ? fa : fb) = q.rate;
  }
  return least;
}

SweptTool::SweptTool(std::vector<path::ToolMotion> motions, std::vector<tool::RoundedFrustum> cutting, double top_mm)
    : motions_(std::move(motions)),
      cutting_(std::move(cutting)),
      reaches_(motions_.begin(), motions_.end()),
      index_(boxes_of(motions_, cutting_, top_mm, owners_)) {}

double SweptTool::excess(const Vec3& p, double cap, std::size_t* answered) const {
  const std::size_t bodies = cutting_.size(), all = motions_.size() * bodies;
  double best = cap;
  std::size_t nearest = SIZE_MAX;
  const auto look = [&](std::size_t owner) {
    const double d = distance_from(owner, p, best);
    if (!(d < best)) return;
    best = d;
    nearest = owner;
  };
  if (answered && *answered < all)
    for (const std::size_t owner : {*answered, *answered + bodies, *answered - bodies})
      if (owner < all) look(owner);
  std::array<std::size_t, kSeen> seen;
  seen.fill(SIZE_MAX);
  index_.near(p, std::max(best, 0.0), [&](std::size_t box, double) {
    const std::size_t owner = owners_[box];
    if (std::exchange(seen[owner % kSeen], owner) != owner) look(owner);
    return std::max(best, 0.0);
  });
  if (answered && nearest != SIZE_MAX) *answered = nearest;
  return best;
}

bool SweptTool::comes_within(std::size_t count, const Vec3& p, double near_mm, std::size_t* answered) const {
  const std::size_t bodies = cutting_.size(), all = std::min(count, motions_.size()) * bodies;
  const auto comes = [&](std::size_t owner) { return distance_from(owner, p, near_mm, near_mm) < near_mm; };
  if (answered && *answered < all)
    for (const std::size_t owner : {*answered, *answered + bodies, *answered - bodies})
      if (owner < all && comes(owner)) {
        *answered = owner;
        return true;
      }
  bool near = false;
  std::array<std::size_t, kSeen> seen;
  seen.fill(SIZE_MAX);
  index_.near(p, std::max(near_mm, 0.0), [&](std::size_t box, double radius) {
    const std::size_t owner = owners_[box];
    if (near || owner >= all || std::exchange(seen[owner % kSeen], owner) == owner) return radius;
    near = comes(owner);
    if (near && answered) *answered = owner;
    return near ? 0.0 : radius;
  });
  return near;
}

Removed::Removed(std::vector<path::ToolMotion> motions, const tool::ProofTool& tool, double top_mm) {
  std::erase_if(motions, [](const path::ToolMotion& m) { return m.rapid; });
  if (!tool.ball_mill) {
    tool_ = std::make_unique<SweptTool>(std::move(motions), tool.cutting, top_mm);
    return;
  }
  const double R = tool.ball_mill->radius_mm();
  std::vector<BallMove> moves;
  for (const auto& m : motions) moves.push_back({m.tip_from + R * m.axis_from, m.tip_to + R * m.axis_to});
  balls_ = std::make_unique<SweptPath>(std::move(moves), R);
}

double Removed::excess(const Vec3& p, double cap, std::size_t* answered) const {
  double e = balls_ ? balls_->excess(p, cap) : tool_->excess(p, cap, answered);
  for (const Removed* other : others_) e = other->excess(p, e);
  return e;
}

bool Removed::comes_within(const Vec3& p, double near_mm, std::size_t* answered) const {
  return (balls_ ? balls_->excess(p, near_mm) < near_mm : tool_->comes_within(SIZE_MAX, p, near_mm, answered)) ||
         std::any_of(others_.begin(), others_.end(), [&](const Removed* r) { return r->comes_within(p, near_mm); });
}

}  // namespace toothpath::cut
