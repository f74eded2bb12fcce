#include "cam/finger/obstacles.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "geometry/base/angle.h"
#include "geometry/base/golden_section.h"

namespace toothpath::finger {
namespace {

constexpr int kDirections = 48;
constexpr int kMostHalvings = 7;
constexpr double kNear = 0.5;  // mm: a smaller gap is looked for in all directions
constexpr int kGoldenSteps = 24;
constexpr double kTie = 2e-4;    // mm: rims that reach as far as each other, to the precision of a direction
constexpr double kEnough = 5.0;  // mm: a gap that nobody asks to know better

/// The rims once, for all directions: how high the body reaches along n.
double support(const std::vector<Vec2>& rims, const Vec3& n) {
  const double across = std::hypot(n.x(), n.y());
  double top = -std::numeric_limits<double>::infinity();
  for (const Vec2& rim : rims) top = std::max(top, rim.x() * across + rim.y() * n.z());
  return top;
}

double lowest(const ToolHull& tool, const Vec3& tip, const Vec3& axis, const Vec3& n) {
  const double along = n.dot(axis), across = std::sqrt(std::max(0.0, 1 - along * along));
  double low = std::numeric_limits<double>::infinity();
  for (const Vec2& rim : tool.rims) low = std::min(low, rim.x() * along - rim.y() * across);
  return n.dot(tip) + low;
}

/// Largest distance of a point of the tool from its tip.
double farthest(const ToolHull& tool) {
  double far = 0;
  for (const Vec2& rim : tool.rims) far = std::max(far, rim.norm());
  return far;
}

double gap_along(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m, const Vec3& n) {
  return std::min(lowest(tool, m.tip_from, m.axis_from, n), lowest(tool, m.tip_to, m.axis_to, n)) -
         support(body.rims, n);
}

/// Place of the greatest value between a and b, of a function that rises and then falls.
template <typename F>
double highest(const F& at, double a, double b, int steps) {
  auto search = golden_section<std::greater_equal<>>(a, b, at);
  for (int k = 0; k < steps; ++k) search.step();
  return search.best().first;
}

struct Direction {
  double gap = 0;
  Vec3 n = Vec3::UnitZ();
};

/// Best of the directions in the axial plane through the middle of the tool.
Direction in_axial_plane(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m) {
  const Vec3 axis = path::axis_at(m, 0.5);
  Vec3 outwards(axis.x(), axis.y(), 0);
  if (outwards.norm() < 1e-9) outwards = Vec3(m.tip_from.x() + m.tip_to.x(), m.tip_from.y() + m.tip_to.y(), 0);
  outwards = outwards.norm() < 1e-9 ? Vec3(1, 0, 0) : Vec3(outwards.normalized());
  const auto direction = [&](double angle) -> Vec3 {
    return std::cos(angle) * outwards + std::sin(angle) * Vec3::UnitZ();
  };
  const auto at = [&](double angle) { return gap_along(tool, body, m, direction(angle)); };
  double best = -std::numeric_limits<double>::infinity(), where = 0;
  const double step = 2 * kPi / kDirections;
  for (int k = 0; k < kDirections; ++k)
    if (const double gap = at(k * step); gap > best) best = gap, where = k * step;
  const double finer = highest(at, where - step, where + step, 40);
  if (at(finer) > best) where = finer;
  return {at(where), direction(where)};
}

/// Best of the directions about `start`. The gap along n is a minimum of linear functions of n; where it is positive,
/// gap / |n| rises and then falls along every line, and so does its maximum over parallel lines. Bodies that meet are
/// moved apart for the search.
Direction about(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m, const Direction& start,
                double range, double least_mm) {
  const Vec3 t1 = start.n.unitOrthogonal(), t2 = start.n.cross(t1);
  const double apart = std::max(0.0, least_mm - start.gap);
  const auto direction = [&](double a, double b) -> Vec3 { return (start.n + a * t1 + b * t2).normalized(); };
  const auto at = [&](double a, double b) {
    const Vec3 n = direction(a, b);
    return gap_along(tool, body, m, n) + apart * n.dot(start.n);
  };
  const auto along = [&](double a) { return highest([&](double b) { return at(a, b); }, -range, range, kGoldenSteps); };
  const double a = highest([&](double u) { return at(u, along(u)); }, -range, range, kGoldenSteps), b = along(a);
  const Vec3 n = direction(a, b);
  const double gap = gap_along(tool, body, m, n);
  return gap > start.gap ? Direction{gap, n} : start;
}

/// Best of all directions near `start`: in ever smaller circles, ever less apart.
Direction in_space(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m, Direction best) {
  for (const auto& [range, apart] : {std::pair{1.0, 0.05}, {0.3, 0.02}, {0.1, 0.005}, {0.03, 0.001}, {0.01, 0.0002}})
    best = about(tool, body, m, best, range, apart);
  return best;
}

/// A piece of line that reaches farthest along some direction; two equal ends: a point.
struct Reach {
  double far = -std::numeric_limits<double>::infinity();
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  void add(double value, const Vec3& p) {
    if (value > far + kTie) far = value, a = b = p;
    else if (value > far - kTie) b = p;
  }
};

/// Where the body of the gear is met, for the direction n in which both come nearest.
Vec3 meeting_place(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m, const Vec3& n) {
  Reach part, low;
  const double across = std::hypot(n.x(), n.y());
  const Vec3 radial = across > 1e-12 ? Vec3(n.x() / across, n.y() / across, 0) : Vec3(0, 0, 0);
  for (const Vec2& rim : body.rims)
    part.add(rim.x() * across + rim.y() * n.z(), rim.x() * radial + rim.y() * Vec3::UnitZ());
  for (const double t : {0.0, 1.0}) {
    const Vec3 axis = path::axis_at(m, t), side = n - n.dot(axis) * axis;
    const Vec3 down = side.norm() > 1e-12 ? Vec3(-side.normalized()) : Vec3(0, 0, 0);
    for (const Vec2& rim : tool.rims) {
      const Vec3 p = path::tip_at(m, t) + rim.x() * axis + rim.y() * down;
      low.add(-n.dot(p), p);
    }
  }
  // Of both pieces of line, the point of the first that is nearest to the second: alternating projections.
  const auto onto = [](const Vec3& p, const Reach& r) -> Vec3 {
    const Vec3 d = r.b - r.a;
    const double l = d.squaredNorm();
    return l > 0 ? Vec3(r.a + std::clamp((p - r.a).dot(d) / l, 0.0, 1.0) * d) : r.a;
  };
  Vec3 place = 0.5 * (part.a + part.b);
  for (int k = 0; k < 50; ++k) place = onto(onto(place, low), part);
  return place;
}

ObstacleGap gap_by_halves(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m, double off,
                          int depth) {
  // A point of the tool swings about the tip: it leaves the straight line between its ends by an eighth of the angle's
  // square.
  const double swing = 2 * std::asin(std::min(1.0, 0.5 * (m.axis_to - m.axis_from).norm()));
  const double loss = off + farthest(tool) * swing * swing / 8;
  Direction best = in_axial_plane(tool, body, m);
  const bool last = depth == 0 || (m.tip_to - m.tip_from).norm() < 0.05;
  if (best.gap - loss <= kEnough && !last) {
    path::ToolMotion first = m, second = m;
    first.tip_to = second.tip_from = path::tip_at(m, 0.5);
    first.axis_to = second.axis_from = path::axis_at(m, 0.5);
    const ObstacleGap a = gap_by_halves(tool, body, first, off, depth - 1),
                      b = gap_by_halves(tool, body, second, off, depth - 1);
    const ObstacleGap& less = a.gap < b.gap ? a : b;
    if (less.gap >= best.gap - loss) return less;
  }
  if (best.gap < kNear) best = in_space(tool, body, m, best);
  return {best.gap - loss, best.gap < kNear ? meeting_place(tool, body, m, best.n) : Vec3(Vec3::Zero())};
}

}  // namespace

std::vector<CoaxialBody> bodies_beside_teeth(const bevel_gear::BevelGear& g) {
  const auto& p = g.parameters();
  const double sd = g.sin_delta(), cd = g.cos_delta();
  std::vector<CoaxialBody> bodies;
  const auto add = [&](const char* name, double diameter, double from, double to) {
    if (!(diameter > 0)) return;
    bodies.push_back({name, {Vec2(diameter / 2, from), Vec2(diameter / 2, to)}});
  };
  const double back = g.R_e() * cd + p.dedendum_mm * sd, front = g.R_i() * cd + p.dedendum_mm * sd;
  add("hub", p.hub_diameter_mm, back, back + p.hub_length_mm);
  add("shaft", p.shaft_diameter_mm, front - p.shaft_length_mm, front);
  return bodies;
}

std::vector<ToolHull> tool_hulls(const tool::Profile& tool) {
  std::vector<ToolHull> hulls;
  for (const auto& [body, part] :
       {std::pair{tool::Body::flute, &tool.cutting()}, std::pair{tool::Body::shank, &tool.shank()},
        std::pair{tool::Body::holder, &tool.holder()}})
    if (!part->empty()) hulls.push_back({body, part->corners()});
  return hulls;
}

ObstacleGap nearest_obstacle(const ToolHull& tool, const CoaxialBody& body, const path::ToolMotion& m) {
  const double off = m.deviation_mm + m.axis_deviation * farthest(tool);
  return gap_by_halves(tool, body, m, off, kMostHalvings);
}

CoaxialBody blank_body(const bevel_gear::BevelGear& g) {
  const double h_a = g.parameters().addendum_mm,
               low = -g.parameters().dedendum_mm - 2 * g.parameters().outer_transverse_module_mm;
  CoaxialBody blank{"blank", {}};
  for (const double ell : {g.R_i(), g.R_e()})
    for (const double height : {h_a, low})
      blank.rims.emplace_back(std::max(0.0, ell * g.sin_delta() + height * g.cos_delta()),
                              ell * g.cos_delta() - height * g.sin_delta());
  return blank;
}

double blank_support(const bevel_gear::BevelGear& g, const Vec3& n) { return support(blank_body(g).rims, n); }

Vec3 blank_place(const bevel_gear::BevelGear& g, const Vec3& n, const Vec3& near) {
  const double across = std::hypot(n.x(), n.y()), h_a = g.parameters().addendum_mm, sd = g.sin_delta(),
               cd = g.cos_delta();
  const Vec3 radial = across > 1e-12 ? Vec3(n.x() / across, n.y() / across, 0) : Vec3(0, 0, 0);
  const auto reach = [&](double ell) { return (ell * sd + h_a * cd) * across + (ell * cd - h_a * sd) * n.z(); };
  double ell = std::clamp(bevel_gear::cone_point(near, sd, cd).ell, g.R_i(), g.R_e());
  if (std::abs(reach(g.R_e()) - reach(g.R_i())) > kTie) ell = reach(g.R_e()) > reach(g.R_i()) ? g.R_e() : g.R_i();
  return (ell * sd + h_a * cd) * radial + (ell * cd - h_a * sd) * Vec3::UnitZ();
}

}  // namespace toothpath::finger
