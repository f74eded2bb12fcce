#include "cam/line/pose.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "cam/line/minimax.h"
#include "geometry/base/angle.h"

namespace toothpath::line {
namespace {

constexpr int kStripNodes = 25, kNodesAbove = 11;  // Chebyshev points of the strip, and of what lies above it
constexpr int kWalkSteps = 14;                     // over the height of the flank
constexpr double kExactEnd = 1e-9;                 // mm: ends of the domain and heights of the ball end
constexpr double kStandsStill = 1e-8;              // mm: predicted gain at which the best pose is found
constexpr int kLinearisations = 30;
constexpr double kFirstTrust = 0.1;  // rad of lean in one step; a quarter of it in eps

/// Root of g in [a, b] to `kExactEnd`; ga and gb differ in sign.
template <typename F>
double root_between(const F& g, double a, double ga, double b, double gb) {
  if (ga == 0) return a;
  if (gb == 0) return b;
  std::uintmax_t steps = 60;
  const auto near = [](double x, double y) { return std::abs(x - y) <= kExactEnd; };
  const auto bracket = a < b ? boost::math::tools::toms748_solve(g, a, b, ga, gb, near, steps)
                             : boost::math::tools::toms748_solve(g, b, a, gb, ga, near, steps);
  return 0.5 * (bracket.first + bracket.second);
}

/// Vertex of the parabola through three nodes, or the middle one where they do not bend.
double vertex(const GapNode& a, const GapNode& b, const GapNode& c) {
  const double d0 = (b.e - a.e) / (b.t - a.t), d1 = (c.e - b.e) / (c.t - b.t), bend = (d1 - d0) / (c.t - a.t);
  return bend == 0 ? b.t : std::clamp(0.5 * (a.t + b.t - d0 / bend), a.t, c.t);
}

}  // namespace

Result<FlankTask> flank_task(const face_gear::FaceGear& gear, int zone, int side) {
  const auto& ring = gear.rings()[std::size_t(zone)];
  const auto& p = gear.parameters();
  if (std::abs(p.shaft_angle_rad - kPi / 2) > 1e-12)
    return fail(
        "shaft_angle = {:.4f} deg: line milling is known for 90 deg only, where the tips lie in a plane and all that "
        "is above it is free",
        degrees(p.shaft_angle_rad));
  FlankTask t;
  t.surface = ring.surface;
  t.zone = zone;
  t.side = side;
  t.inner_radius = ring.zone.inner_radius_mm;
  t.outer_radius = ring.zone.outer_radius_mm;
  const double middle = 0.5 * (t.inner_radius + t.outer_radius);
  t.z_tip = ring.surface.z_tip(middle);
  t.theta_end = ring.surface.shaper.theta_t;
  const auto z_end = face_gear::fillet_line_height(ring.surface, side, middle);
  if (!z_end || !(*z_end < t.z_tip))
    return fail("zone {}: flank {:+d} has no fillet line below the tips at radius {:.3f} mm", zone, side, middle);
  t.z_end = *z_end;
  t.module_mm = p.module_mm;
  if (ring.displaced()) t.displaced = std::make_shared<const face_gear::SpaceSheet>(p, ring);
  return t;
}

std::vector<Strip> strips_of(const FlankTask& flank, int n) {
  std::vector<Strip> out;
  const double height = (flank.z_tip - flank.z_end) / n;
  for (int k = 0; k < n; ++k) {
    Strip s;
    s.top = flank.z_tip - k * height;
    const bool lowest = k + 1 == n;
    if (!lowest) s.bottom = s.top - height;
    s.anchor = s.top - (n > 1 && lowest ? 0.15 : 0.5) * height;
    out.push_back(s);
  }
  return out;
}

std::optional<LineFit::Anchor> LineFit::anchor(double r) const {
  const auto at = face_gear::invert_flank(flank_.surface, flank_.side, r, strip_.anchor);
  if (!at || !(at->J > 0)) return {};
  const auto on = flank_.surface.flank(flank_.side, at->theta, at->B);
  return Anchor{{at->theta, at->B}, on.p, tangent_frame<double>(flank_.side, on.n)};
}

std::optional<GapNode> LineFit::gap_at(const AxisLine<double>& axis, double t, const Place<double>& start) const {
  const Vec3 x = axis.at(t);
  const auto foot = flank_foot<double>(flank_.surface, flank_.side, x, start);
  if (!foot) return {};
  if (flank_.displaced) return displaced_gap(x, t, *foot);
  const Vec3 touched = x - foot->d * foot->n;
  return GapNode{t, foot->d - law_.rho(t), touched.head<2>().norm(), touched.z(), foot->theta_foot, foot->at, foot->n};
}

/// On a modified or corrected flank: from the foot on the plain one, hundredths of a millimetre away.
std::optional<GapNode> LineFit::displaced_gap(const Vec3& x, double t, const face_gear::FlankFoot<double>& near) const {
  const Turn to_space(flank_.side > 0 ? 0.0 : flank_.surface.pitch);
  const auto foot = flank_.displaced->foot(tooth_space::flank_of(flank_.side), to_space(x), near.theta_foot, near.at.B);
  if (!foot) return {};
  return GapNode{t,       foot->distance - law_.rho(t), foot->at.p.head<2>().norm(), foot->at.p.z(), foot->u,
                 near.at, to_space.back(foot->at.n)};
}

/// How far a foot lies inside the trimmed flank and a rim beyond the ends of the ring; negative outside. mm
double LineFit::inside(const GapNode& q, double rim) const {
  const double to_fillet = (flank_.theta_end - q.theta_foot) * flank_.surface.shaper.r_b / flank_.surface.shaper.cos_bb;
  return std::min(
      {to_fillet, flank_.z_tip - q.z_foot, q.r_foot - flank_.inner_radius + rim, flank_.outer_radius + rim - q.r_foot});
}

double LineFit::above_bottom(const GapNode& q) const {
  if (strip_.bottom) return q.z_foot - *strip_.bottom;
  return (flank_.theta_end - q.theta_foot) * flank_.surface.shaper.r_b / flank_.surface.shaper.cos_bb;
}

/// Does a foot count for what is left: within the strip and the ring?
bool LineFit::in_strip(const GapNode& q) const {
  return q.z_foot <= strip_.top + 10 * kExactEnd && above_bottom(q) >= -10 * kExactEnd &&
         q.r_foot >= flank_.inner_radius - 10 * kExactEnd && q.r_foot <= flank_.outer_radius + 10 * kExactEnd;
}

/// Feet from the ball end up to the first above the tips, in even steps; fewer where the regular sheet ends.
std::vector<GapNode> LineFit::walk(const AxisLine<double>& axis, double t_start, const Place<double>& start) const {
  const double step = (flank_.z_tip - flank_.z_end) / axis.a.z() / kWalkSteps;
  const auto first = gap_at(axis, t_start, start);
  if (!first) return {};
  std::vector<GapNode> out{*first};
  while (out.back().t > 0) {
    const auto q = gap_at(axis, std::max(0.0, out.back().t - step), out.back().at);
    if (!q) break;
    out.push_back(*q);
  }
  std::reverse(out.begin(), out.end());
  while (out.back().z_foot < flank_.z_tip) {
    const auto q = gap_at(axis, out.back().t + step, out.back().at);
    if (!q) break;
    out.push_back(*q);
  }
  return out;
}

/// Height on the axis between two feet where g of the foot vanishes; it differs in sign at both.
template <typename F>
double LineFit::crossing(const AxisLine<double>& axis, const GapNode& a, const GapNode& b, const F& g) const {
  return root_between(
      [&](double t) {
        const auto q = gap_at(axis, t, a.at);
        return q ? g(*q) : NAN;
      },
      a.t, g(a), b.t, g(b));
}

std::optional<GapLine> LineFit::gap_along(const AxisLine<double>& axis, double t_start,
                                          const Place<double>& start) const {
  const auto feet = walk(axis, t_start, start);
  if (feet.empty()) return {};
  GapLine line;
  const auto to_tip = [&](const GapNode& q) { return flank_.z_tip - q.z_foot; };
  const auto beyond = [&](const GapNode& q) {
    return std::max({0.0, flank_.inner_radius - q.r_foot, q.r_foot - flank_.outer_radius});
  };
  const bool reaches = feet.size() > 1 && to_tip(feet.back()) <= 0 && to_tip(feet[feet.size() - 2]) > 0;
  line.t_top = reaches ? crossing(axis, feet[feet.size() - 2], feet.back(), to_tip) : feet.back().t;
  line.beyond_ring = INFINITY;
  for (const auto& q : feet)
    if (to_tip(q) >= 0) line.beyond_ring = std::min(line.beyond_ring, beyond(q));
  if (const auto q = gap_at(axis, line.t_top, feet.back().at); q && reaches)
    line.beyond_ring = std::min(line.beyond_ring, beyond(*q));
  // The part of the axis whose feet lie in the domain, and of that the part in the ring.
  const auto part = [&](double rim, double& from, double& to) {
    const auto in = [&](const GapNode& q) { return inside(q, rim); };
    std::size_t a = 0, b = feet.size();
    while (a < feet.size() && in(feet[a]) < 0) ++a;
    while (b > a && in(feet[b - 1]) < 0) --b;
    if (a == b) return feet.end();
    from = a > 0 ? crossing(axis, feet[a - 1], feet[a], in) : feet[a].t;
    to = b < feet.size() ? crossing(axis, feet[b - 1], feet[b], in) : feet[b - 1].t;
    return feet.begin() + std::ptrdiff_t(a);
  };
  const auto first = part(kRim * flank_.module_mm, line.t_from, line.t_to);
  if (first == feet.end()) return line;
  if (part(0, line.ring_from, line.ring_to) == feet.end()) {
    // The line has a corner of the ring alone, at an end of the domain: rounding puts it outside.
    const auto from = gap_at(axis, line.t_from, first->at), to = gap_at(axis, line.t_to, feet.back().at);
    if (!from || !to) return {};
    line.ring_from = line.ring_to = inside(*from, 0) > inside(*to, 0) ? line.t_from : line.t_to;
  }
  std::vector<double> splits{line.t_from, line.ring_from, line.ring_to, line.t_to};
  const auto below_top = [&](const GapNode& q) { return strip_.top - q.z_foot; };
  if (strip_.top < flank_.z_tip - kExactEnd)
    for (std::size_t k = 1; k < feet.size(); ++k)
      if (below_top(feet[k - 1]) > 0 && below_top(feet[k]) <= 0)
        splits.push_back(std::clamp(crossing(axis, feet[k - 1], feet[k], below_top), line.t_from, line.t_to));
  if (!add_nodes(axis, std::move(splits), first->at, line) || !extremes(axis, line)) return {};
  return line;
}

/// Chebyshev points over the whole domain and, where the strip ends below the tips, over the strip; all splits are
/// nodes.
bool LineFit::add_nodes(const AxisLine<double>& axis, std::vector<double> splits, Place<double> start,
                        GapLine& line) const {
  const double top = splits.size() > 4 ? splits.back() : line.t_to;
  const auto points = [&](double a, double b, int count) {
    for (int k = 1; k + 1 < count; ++k)
      splits.push_back(0.5 * (a + b) - 0.5 * (b - a) * std::cos(kPi * k / (count - 1)));
  };
  points(line.t_from, top, kStripNodes);
  if (top < line.t_to) points(top, line.t_to, kNodesAbove);
  std::sort(splits.begin(), splits.end());
  for (const double t : splits) {
    if (!line.nodes.empty() && t - line.nodes.back().t < kExactEnd) continue;
    const auto q = gap_at(axis, t, start);
    if (!q) return false;
    start = q->at;
    line.nodes.push_back(*q);
  }
  return true;
}

/// Least and most, at the nodes and at the vertices of parabolas between them.
bool LineFit::extremes(const AxisLine<double>& axis, GapLine& line) const {
  line.least = INFINITY;
  line.most = -INFINITY;
  const auto look = [&](const GapNode& q) {
    if (q.e < line.least) {
      line.least = q.e;
      line.n_least = q.n;
    }
    if (in_strip(q)) line.most = std::max(line.most, q.e);
  };
  for (const auto& q : line.nodes) look(q);
  for (std::size_t k = 1; k + 1 < line.nodes.size(); ++k) {
    const auto &a = line.nodes[k - 1], &b = line.nodes[k], &c = line.nodes[k + 1];
    if ((b.e < a.e) != (b.e < c.e)) continue;
    const auto q = gap_at(axis, vertex(a, b, c), b.at);
    if (!q) return false;
    look(*q);
  }
  line.most = std::max(line.most, line.least);
  return true;
}

std::optional<double> LineFit::reach_bottom(const Anchor& anchor, PoseAngles<double> pose) const {
  std::optional<Place<double>> last;
  const auto height = [&](double t_m) {
    pose.t_m = t_m;
    const auto axis = axis_of<double>(anchor.P, anchor.frame, law_, pose);
    if (!last) {
      last = Place<double>{theta_at_distance(flank_.surface, anchor.at.theta, law_.rho(t_m) + pose.delta), anchor.at.B};
      for (const double share : {0.75, 0.5, 0.25})
        if (const auto q = gap_at(axis, share * t_m, *last)) last = q->at;
    }
    const auto q = gap_at(axis, 0, *last);
    if (!q) return -flank_.module_mm;  // beyond the undercut edge: too low
    last = q->at;
    return above_bottom(*q);
  };
  double low = 0, b_low = height(0), high = 1.3 * (strip_.anchor - (strip_.bottom ? *strip_.bottom : flank_.z_end)),
         b_high = height(high);
  if (b_low < 0) return {};
  for (int k = 0; k < 8 && b_high > 0; ++k) {
    low = high;
    b_low = b_high;
    b_high = height(high *= 1.4);
  }
  if (b_high > 0) return {};
  return root_between(height, low, b_low, high, b_high);
}

bool LineFit::measure(StationPose& pose) const {
  auto line = gap_along(pose.axis, std::max(pose.angles.t_m, 0.0), pose.at);
  if (!line) return false;
  pose.gap = std::move(*line);
  pose.covered =
      pose.gap.t_top > 0 ? (pose.gap.ring_to - pose.gap.ring_from) / (pose.gap.t_top + std::max(pose.lift, 0.0)) : 0;
  return true;
}

std::optional<StationPose> LineFit::posed(double r, const Anchor& anchor, PoseAngles<double> angles,
                                          double lift) const {
  const auto t_m = reach_bottom(anchor, angles);
  if (!t_m) return {};
  StationPose pose;
  pose.r = r;
  pose.lift = lift;
  angles.t_m = *t_m;
  pose.anchor = anchor.P;
  pose.angles = angles;
  pose.axis = axis_of<double>(anchor.P, anchor.frame, law_, angles);
  pose.at = {theta_at_distance(flank_.surface, anchor.at.theta, law_.rho(*t_m) + angles.delta), anchor.at.B};
  return pose;
}

/// Shifts delta until the least gap is `bias`, by Newton: moved along n, the gap at a foot changes with the cosine
/// between both normals.
void LineFit::settle(StationPose& pose, const Anchor& anchor, double bias) const {
  for (int k = 0; k < 12 && !pose.gap.nodes.empty() && std::abs(pose.gap.least - bias) > kExactEnd; ++k) {
    pose.angles.delta += (bias - pose.gap.least) / pose.gap.n_least.dot(anchor.frame.n);
    pose.axis = axis_of<double>(anchor.P, anchor.frame, law_, pose.angles);
    if (!measure(pose)) return;
  }
}

std::optional<StationPose> LineFit::start(double r) const {
  const auto at = anchor(r);
  if (!at) return {};
  PoseAngles<double> angles;
  angles.t_m = 1.2 * (strip_.anchor - (strip_.bottom ? *strip_.bottom : flank_.z_end));
  for (int k = 0; k < 2; ++k) {
    const auto psi = lean<double>(flank_.surface, flank_.side, at->at, law_.rho(angles.t_m));
    if (!psi) return {};
    angles.psi = *psi;
    const auto t_m = reach_bottom(*at, angles);
    if (!t_m) return {};
    angles.t_m = *t_m;
  }
  auto pose = posed(r, *at, angles, 0);
  if (!pose || !measure(*pose)) return {};
  return pose;
}

std::optional<StationPose> LineFit::place(double r, double psi, double eps, double delta, double lift,
                                          std::optional<double> bias) const {
  const auto at = anchor(r);
  if (!at) return {};
  auto pose = posed(r, *at, {psi, eps, delta, 0}, lift);
  if (!pose) return {};
  if (lift != 0) {
    pose->angles.t_m -= lift;
    pose->axis = axis_of<double>(at->P, at->frame, law_, pose->angles);
    pose->at = {theta_at_distance(flank_.surface, at->at.theta, law_.rho(pose->angles.t_m) + delta), at->at.B};
  }
  if (!measure(*pose)) return {};
  if (bias && pose->gap.in_ring()) settle(*pose, *at, *bias);
  return pose;
}

std::optional<double> LineFit::eps_under(double r, double psi, double t_m, const AxisCondition& condition) const {
  const auto at = anchor(r);
  if (!at) return {};
  // A cos(sigma) + C sin(sigma) = c
  const Vec3 u = std::cos(psi) * at->frame.p + std::sin(psi) * at->frame.o;
  const double A = condition.w.dot(u), C = condition.w.dot(at->frame.n), size = std::hypot(A, C);
  if (!(std::abs(condition.c) <= size)) return {};
  const double middle = std::atan2(C, A), half = std::acos(condition.c / size), of_side = std::asin(law_.slope(t_m));
  const double one = std::remainder(middle + half - of_side, 2 * kPi),
               other = std::remainder(middle - half - of_side, 2 * kPi);
  return std::abs(one) < std::abs(other) ? one : other;
}

/// One linear programme about a pose: the angles that it proposes, and how much smaller it expects the misfit to be.
std::optional<PoseAngles<double>> LineFit::step(const StationPose& pose, const Anchor& anchor,
                                                const Neighbourhood& about,
                                                const std::optional<AxisCondition>& condition, double trust,
                                                double& gain) const {
  const double psi = pose.angles.psi, sigma = std::asin(law_.slope(pose.angles.t_m)) + pose.angles.eps;
  const auto& f = anchor.frame;
  const Vec3 u = std::cos(psi) * f.p + std::sin(psi) * f.o, across = std::cos(psi) * f.o - std::sin(psi) * f.p;
  Vec3 a_psi = std::cos(sigma) * across;
  const Vec3 a_sigma = std::cos(sigma) * f.n - std::sin(sigma) * u;
  if (condition) {
    const double give = condition->w.dot(a_sigma);
    if (give == 0) return {};
    a_psi -= condition->w.dot(a_psi) / give * a_sigma;
  }
  std::vector<LinearRow> rows;
  for (const auto& q : pose.gap.nodes) {
    const double arm = q.t - pose.angles.t_m;
    const Unknowns g(arm * q.n.dot(a_psi), condition ? 0.0 : arm * q.n.dot(a_sigma), q.n.dot(f.n), 0);
    rows.push_back({g, -q.e});
    if (in_strip(q)) rows.push_back({Unknowns(-g[0], -g[1], -g[2], 1), q.e});
  }
  const auto limit = [&](int k, double value, double centre, double most) {
    for (const int sense : {1, -1}) rows.push_back({-sense * Unknowns::Unit(k), sense * (value - centre) - most});
  };
  limit(0, psi, about.psi, about.most_psi);
  if (!condition) limit(1, pose.angles.eps, about.eps, about.most_eps);
  const auto x = least_last(rows, Unknowns(trust, 0.25 * trust, flank_.module_mm, flank_.module_mm));
  if (!x) return {};
  gain = pose.gap.misfit() - (*x)[3];
  PoseAngles<double> to = pose.angles;
  to.psi += (*x)[0];
  if (!condition) to.eps += (*x)[1];
  to.delta += (*x)[2];
  return to;
}

std::optional<StationPose> LineFit::best(double r, const std::optional<AxisCondition>& condition,
                                         const std::optional<Neighbourhood>& near) const {
  const auto at = anchor(r);
  auto pose = start(r);
  if (!at || !pose) return {};
  const auto under = [&](PoseAngles<double> angles) -> std::optional<StationPose> {
    if (condition) {
      const auto eps = eps_under(r, angles.psi, angles.t_m, *condition);
      if (!eps) return {};
      angles.eps = *eps;
    }
    auto moved = posed(r, *at, angles, 0);
    if (!moved || !measure(*moved)) return {};
    return moved;
  };
  PoseAngles<double> from = pose->angles;
  const Neighbourhood about = near ? *near : Neighbourhood{from.psi, from.eps};
  from.psi = about.psi;
  from.eps = about.eps;
  pose = under(from);
  double trust = kFirstTrust;
  for (int k = 0; pose && !pose->gap.nodes.empty() && k < kLinearisations && trust > 1e-7; ++k) {
    double gain = 0;
    const auto to = step(*pose, *at, about, condition, trust, gain);
    if (!to || gain < kStandsStill) break;
    auto moved = under(*to);
    if (moved && !moved->gap.nodes.empty() && moved->gap.misfit() < pose->gap.misfit()) pose = std::move(moved);
    else trust *= 0.3;
  }
  if (pose) settle(*pose, *at, 0);
  return pose;
}

double LineFit::lift_to(const StationPose& pose, double r_most, int sense) const {
  const double step = (flank_.z_tip - flank_.z_end) / pose.axis.a.z() / kWalkSteps;
  auto last = gap_at(pose.axis, std::max(pose.angles.t_m, 0.0), pose.at);
  const auto beyond = [&](const GapNode& q) { return sense * (q.r_foot - r_most); };
  // Down to the ball end, then up to the first foot that is not beyond.
  for (double t = pose.angles.t_m; last && t > 0;) {
    t = std::max(0.0, t - step);
    last = gap_at(pose.axis, t, last->at);
  }
  if (!last || beyond(*last) <= 0) return 0;
  while (last->z_foot < flank_.z_tip) {
    const auto next = gap_at(pose.axis, last->t + step, last->at);
    if (!next) break;
    if (beyond(*next) <= 0) {
      const Place<double> near = last->at;
      return root_between(
          [&](double t) {
            const auto q = gap_at(pose.axis, t, near);
            return q ? beyond(*q) : NAN;
          },
          last->t, beyond(*last), next->t, beyond(*next));
    }
    last = next;
  }
  return last->t;
}

}  // namespace toothpath::line
