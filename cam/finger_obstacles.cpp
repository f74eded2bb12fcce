#include "cam/finger_obstacles.h"

#include <algorithm>
#include <cmath>

#include "cam/finger_tool.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr int kArcPieces = 16;
constexpr int kDirections = 48;
constexpr int kMostHalvings = 7;
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

double gap_along(const ToolHull& tool, const CoaxialBody& body, const ToolMotion& m, const Vec3& n) {
  return std::min(lowest(tool, m.tip_from, m.axis_from, n), lowest(tool, m.tip_to, m.axis_to, n)) - support(body.rims, n);
}

/// Best of the directions in the axial plane through the middle of the tool; the gap is a concave function of the angle near it.
double best_gap(const ToolHull& tool, const CoaxialBody& body, const ToolMotion& m) {
  const Vec3 axis = motion_axis(m, 0.5);
  Vec3 outwards(axis.x(), axis.y(), 0);
  if (outwards.norm() < 1e-9) outwards = Vec3(m.tip_from.x() + m.tip_to.x(), m.tip_from.y() + m.tip_to.y(), 0);
  outwards = outwards.norm() < 1e-9 ? Vec3(1, 0, 0) : Vec3(outwards.normalized());
  const auto at = [&](double angle) { return gap_along(tool, body, m, std::cos(angle) * outwards + std::sin(angle) * Vec3::UnitZ()); };
  double best = -std::numeric_limits<double>::infinity(), where = 0;
  const double step = 2 * kPi / kDirections;
  for (int k = 0; k < kDirections; ++k)
    if (const double gap = at(k * step); gap > best) best = gap, where = k * step;
  double a = where - step, b = where + step;
  constexpr double gold = 0.6180339887498949;
  double x1 = b - gold * (b - a), x2 = a + gold * (b - a), f1 = at(x1), f2 = at(x2);
  for (int k = 0; k < 40; ++k) {
    if (f1 < f2) a = x1, x1 = x2, f1 = f2, x2 = a + gold * (b - a), f2 = at(x2);
    else b = x2, x2 = x1, f2 = f1, x1 = b - gold * (b - a), f1 = at(x1);
  }
  return std::max({best, f1, f2});
}

double gap_by_halves(const ToolHull& tool, const CoaxialBody& body, const ToolMotion& m, double off, int depth) {
  // A point of the tool swings about the tip: it leaves the straight line between its ends by an eighth of the angle's square.
  const double swing = 2 * std::asin(std::min(1.0, 0.5 * (m.axis_to - m.axis_from).norm()));
  const double whole = best_gap(tool, body, m) - off - farthest(tool) * swing * swing / 8;
  if (whole > kEnough || depth == 0 || (m.tip_to - m.tip_from).norm() < 0.05) return whole;
  ToolMotion first = m, second = m;
  first.tip_to = second.tip_from = motion_tip(m, 0.5);
  first.axis_to = second.axis_from = motion_axis(m, 0.5);
  return std::max(whole, std::min(gap_by_halves(tool, body, first, off, depth - 1), gap_by_halves(tool, body, second, off, depth - 1)));
}

}  // namespace

std::vector<CoaxialBody> bodies_beside_teeth(const BevelGear& g) {
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

std::vector<ToolHull> tool_hulls(const FingerProfile<double>& c, const ToolAssembly& tool) {
  ToolHull flute{"flute", {}}, shank{"shank", {}}, holder{"holder", {}};
  // Corners of tangents around the arc, from the flat (psi = 90 deg) to the straight (phi).
  const double step = (kPi / 2 - c.phi) / kArcPieces, out = c.r_t / std::cos(0.5 * step);
  for (int k = 0; k < kArcPieces; ++k) {
    const double psi = kPi / 2 - (k + 0.5) * step;
    flute.rims.emplace_back(c.x_o - out * std::sin(psi) + c.h_f, c.rho_o + out * std::cos(psi));
  }
  // The flank is hollow: its chord encloses it.
  flute.rims.emplace_back(c.x_D + c.h_f, c.rho_D);
  const double shank_from = tool.flute_length_mm > 0 ? tool.flute_length_mm : c.h_f + c.x_D;
  flute.rims.emplace_back(std::max(shank_from, c.x_D + c.h_f), c.rho_D);
  shank.rims = {Vec2(shank_from, tool.shank_diameter_mm / 2), Vec2(tool.stick_out_mm, tool.shank_diameter_mm / 2)};
  double z = tool.stick_out_mm;
  for (const auto& part : tool.holder) {
    holder.rims.emplace_back(z, part.lower_diameter_mm / 2);
    z += part.height_mm;
    holder.rims.emplace_back(z, part.upper_diameter_mm / 2);
  }
  std::vector<ToolHull> hulls{std::move(flute), std::move(shank)};
  if (!holder.rims.empty()) hulls.push_back(std::move(holder));
  return hulls;
}

double body_gap(const ToolHull& tool, const CoaxialBody& body, const ToolMotion& m) {
  const double off = m.deviation_mm + m.axis_deviation * farthest(tool);
  return gap_by_halves(tool, body, m, off, kMostHalvings);
}

double blank_support(const BevelGear& g, const Vec3& n) {
  const double h_a = g.parameters().addendum_mm, low = -g.parameters().dedendum_mm - 2 * g.parameters().outer_transverse_module_mm;
  double top = -std::numeric_limits<double>::infinity();
  for (const double ell : {g.R_i(), g.R_e()})
    for (const double height : {h_a, low}) {
      const double r = std::max(0.0, ell * g.sin_delta() + height * g.cos_delta()), z = ell * g.cos_delta() - height * g.sin_delta();
      top = std::max(top, r * std::hypot(n.x(), n.y()) + z * n.z());
    }
  return top;
}

}  // namespace toothpath
