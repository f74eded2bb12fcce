#include "cam/line/pose.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>
#include <cmath>

#include "cam/line/minimax.h"
#include "geometry/base/angle.h"

namespace toothpath::line {
namespace {

constexpr int kStripNodes = 25, kNodesAbove = 11;   // Chebyshev points of the strip, and of what lies above it
constexpr int kWalkSteps = 14;                      // over the height of the flank
constexpr std::size_t kMostFeet = 16 * kWalkSteps;  // of a walk
constexpr double kLeastRise = 0.1;                  // of an axis, as far as steps follow it
constexpr int kDepthSteps = 3, kNewtonSteps = 25;   // from the tip edge to a depth; and to a place in all
constexpr double kLastStep = 1e-7;                  // of the module: the step after one is exact, the search quadratic
constexpr double kExactEnd = 1e-9;                  // mm: ends of the domain and heights of the ball end
constexpr double kStandsStill = 1e-8;               // mm: predicted gain at which the best pose is found
constexpr int kLinearisations = 30;
constexpr int kLengthSteps = 24;
constexpr int kSagSteps = 64;        // over the height of a flank
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

/// Where the foot at t is to be expected: on the line through two others.
Place expected(const GapNode& a, const GapNode& b, double t) { return between(a.at, b.at, (t - a.t) / (b.t - a.t)); }

}  // namespace

Vec3 FlankTask::up(const Vec3& p) const {
  const auto& c = chart();
  if (c.sine == 0) return {0, 0, c.cosine};
  const double out = c.sine / radius(p);
  return {out * p.x(), out * p.y(), c.cosine};
}

std::optional<FlankPlace> FlankTask::at_depth(double s, double asked) const {
  const auto edge = space->tip_edge(side, s);
  if (!edge) return {};
  FlankPlace f{{edge->u, edge->v}, {}};
  const double tip_height = space->tip(s);
  asked *= deep.share(s);
  bool arrived = false;
  for (int k = 0; k < kNewtonSteps; ++k) {
    const auto q = space->at(piece(), f.at.u, f.at.v);
    if (!q) return {};
    f.on = *q;
    if (arrived) return f;
    // Down in a few steps, then on to the place.
    const double height = tip_height - asked * std::min(1.0, double(k + 1) / kDepthSteps);
    const double ds = s - along(q->p), dh = height - chart().up(q->p);
    const double su = chart().along(q->p, q->pu), sv = chart().along(q->p, q->pv), hu = chart().up(q->p, q->pu),
                 hv = chart().up(q->p, q->pv), det = su * hv - sv * hu;
    if (det == 0) return {};
    f.at.u += (ds * hv - sv * dh) / det;
    f.at.v += (su * dh - ds * hu) / det;
    arrived = k >= kDepthSteps && std::abs(ds) + std::abs(dh) < kLastStep * module_mm;
  }
  return {};
}

std::optional<tooth_space::PatchPoint> FlankTask::at_u(double s, double u) const {
  const auto edge = space->tip_edge(side, s);
  const auto near = edge ? std::optional(tooth_space::Near{edge->v, s}) : std::nullopt;
  for (int attempt = 0; attempt < tooth_space::ToothSpace::kStarts; ++attempt) {
    auto v = space->start_v(piece(), u, s, 0, near, attempt);
    bool arrived = false;
    for (int k = 0; v && k < kNewtonSteps; ++k) {
      const auto q = space->at(piece(), u, *v);
      if (!q) break;
      if (arrived) return q;
      const double lack = s - along(q->p), most = space->longest_step(piece(), s);
      arrived = std::abs(lack) < kLastStep * module_mm;
      *v += std::clamp(lack / chart().along(q->p, q->pv), -most, most);
    }
  }
  return {};
}

namespace {

/// Does the flank itself want an axis there that is tilted farther than that from the height of the teeth?
bool wants_beyond(const FlankTask& t, double s, double depth, double tilt_rad) {
  const auto place = t.at_depth(s, depth);
  if (!place) return false;
  const auto frame = t.frame(place->on);
  const auto psi = lean(shape_at(frame, place->on), 0.0);
  return psi && axis_direction<double>(frame, *psi, 0).dot(t.up(place->on.p)) < std::cos(tilt_rad);
}

/// Along the tooth, or on a cylinder or a cone beyond what is planned: one way for the whole flank.
bool wants_upright(const FlankTask& t) {
  const double middle = 0.5 * (t.s_from + t.s_to);
  if (wants_beyond(t, middle, 0.5 * t.depth, kAlongTheTooth)) return true;
  if (t.chart().sine == 0) return false;
  for (const double s : {t.s_from, middle, t.s_to})
    for (const double share : {0.1, 0.5, 0.9})
      if (wants_beyond(t, s, share * t.depth, kMostTilt)) return true;
  return false;
}

/// From the tip down to every depth, in even steps: the integral of sqrt(bend of the profile) over its length, with
/// what bends towards it, 1/mm. A strip with the share w of it sags by w^2/8. Empty where the flank has no such places.
std::vector<double> sags_of(const FlankTask& flank, double s, double against_per_mm = 0) {
  std::vector<double> sum{0};
  const double step = flank.depth / kSagSteps;
  for (int k = 0; k < kSagSteps; ++k) {
    const auto place = flank.at_depth(s, (k + 0.5) * step);
    if (!place) return {};
    const auto frame = flank.frame(place->on);
    sum.push_back(sum.back() + std::sqrt(std::abs(shape_at(frame, place->on).pp + against_per_mm)) * step *
                                   flank.deep.share(s) / frame.p.dot(flank.up(place->on.p)));
  }
  return sum;
}

/// The same of a flank whose tool leans: the least bend at every place, over the length along it. 0 on saddles.
double least_sag(const FlankTask& flank, double s) {
  double sum = 0;
  const double step = flank.depth / kSagSteps;
  for (int k = 0; k < kSagSteps; ++k) {
    const auto place = flank.at_depth(s, (k + 0.5) * step);
    if (!place) return 0;
    const auto frame = flank.frame(place->on);
    const auto shape = shape_at(frame, place->on);
    const auto psi = lean(shape, 0.0);
    if (!psi || !(std::cos(*psi) > std::cos(kMostTilt))) return 0;
    sum += std::sqrt(std::abs(shape.along(std::cos(*psi), std::sin(*psi)))) * step * flank.deep.share(s) /
           (frame.p.dot(flank.up(place->on.p)) * std::cos(*psi));
  }
  return sum;
}

/// Passes of which each leaves about `left_mm`, as far as the bends tell.
int passes_for(const FlankTask& flank, double against_per_mm, double left_mm) {
  double most = 0;
  for (const double s : {flank.s_from, 0.5 * (flank.s_from + flank.s_to), flank.s_to})
    if (const auto sags = sags_of(flank, s, against_per_mm); !sags.empty()) most = std::max(most, sags.back());
  return std::max(1, int(std::ceil(most / std::sqrt(8 * left_mm))));
}

}  // namespace

Result<FlankTask> flank_task(const tooth_space::ToothedPart& part, int zone, int side, double allowance_mm) {
  FlankTask t;
  t.space = &part.space(zone);
  t.zone = zone;
  t.side = side;
  t.module_mm = part.module_mm();
  t.allowance_mm = allowance_mm;
  const auto& outline = t.space->outline();
  t.s_from = outline.s_from;
  t.s_to = outline.s_to;
  const auto borders = t.space->borders(t.piece());
  t.u_end = side > 0 ? borders.to : borders.from;
  const double middle = 0.5 * (t.s_from + t.s_to);
  const auto end = t.at_u(middle, t.u_end);
  if (end) t.depth = t.depth_of(end->p);
  if (!(t.depth > 0))
    return fail("zone {}: flank {:+d} has no fillet line below the tips at {} {:.3f} mm", zone, side, outline.along,
                outline.sign * middle);
  t.mm_per_u = std::copysign(end->pu.norm(), (side > 0 ? borders.from : borders.to) - t.u_end);
  t.upright = wants_upright(t);
  const bool on_a_cone = t.chart().sine != 0 && t.chart().cosine != 0;
  if (t.upright || on_a_cone)
    if (const auto depth = tooth_space::flank_depth(*t.space, side)) t.deep = *depth;
  return t;
}

std::vector<Strip> strips_of(const FlankTask& flank, int n) {
  const std::vector<double> sags =
      flank.upright && n > 1 ? sags_of(flank, 0.5 * (flank.s_from + flank.s_to)) : std::vector<double>{};
  const auto top = [&](int k) {
    if (sags.empty() || !(sags.back() > 0) || k == 0) return k * flank.depth / n;
    const double asked = sags.back() * k / n;
    const auto after = std::lower_bound(sags.begin() + 1, sags.end() - 1, asked);
    return flank.depth / kSagSteps * (double(after - sags.begin()) - (*after - asked) / (*after - *(after - 1)));
  };
  std::vector<Strip> out;
  for (int k = 0; k < n; ++k) {
    Strip s;
    s.top = top(k);
    const bool lowest = k + 1 == n;
    const double height = (lowest ? flank.depth : top(k + 1)) - s.top;
    if (!lowest) s.bottom = s.top + height;
    s.anchor = s.top + (n > 1 && lowest ? 0.15 : 0.5) * height;
    out.push_back(s);
  }
  return out;
}

int strips_for(const FlankTask& flank, double left_mm) { return flank.upright ? passes_for(flank, 0, left_mm) : 1; }
int strips_about(const FlankTask& flank, double left_mm) {
  if (flank.upright) return strips_for(flank, left_mm);
  double most = 0;
  for (const double s : {flank.s_from, 0.5 * (flank.s_from + flank.s_to), flank.s_to})
    most = std::max(most, least_sag(flank, s));
  return std::max(1, int(std::ceil(most / std::sqrt(8 * left_mm))));
}
int ball_passes_for(const FlankTask& flank, double ball_radius_mm, double left_mm) {
  return passes_for(flank, 1 / ball_radius_mm, left_mm);
}
double length_along(const FlankTask& flank) {
  double length = 0;
  Vec3 before = Vec3::Zero();
  bool joins = false;
  for (int k = 0; k <= kLengthSteps; ++k) {
    const auto place = flank.at_depth(flank.s_from + (flank.s_to - flank.s_from) * k / kLengthSteps, 0.5 * flank.depth);
    if (place && joins) length += (place->on.p - before).norm();
    joins = place.has_value();
    if (joins) before = place->on.p;
  }
  return length;
}

std::optional<LineFit::Anchor> LineFit::anchor(double s) const {
  auto place = flank_.at_depth(s, strip_.anchor);
  if (!place) return {};
  const auto& on = place->on;
  return Anchor{*place, on.p + flank_.allowance_mm * on.n, flank_.frame(on)};
}

std::optional<GapNode> LineFit::gap_at(const AxisLine<double>& axis, double t, const Place& start) const {
  const double touches = law_.rho(t) + flank_.allowance_mm;
  const auto foot = flank_.space->next_foot(flank_.piece(), axis.at(t), {start.u, start.v, touches, {}});
  if (!foot) return {};
  const auto& q = foot->at;
  GapNode node;
  node.t = t;
  node.e = foot->distance - touches;
  node.s = flank_.along(q.p);
  node.depth = flank_.depth_of(node.s, q.p);
  node.above_fillet = flank_.above_fillet(foot->u);
  node.at = {foot->u, foot->v};
  node.n = q.n;
  return node;
}

/// How far a foot lies inside the trimmed flank and a rim beyond the ends of the ring; negative outside. mm
double LineFit::inside(const GapNode& q, double rim) const {
  return std::min({q.above_fillet, q.depth, q.s - flank_.s_from + rim, flank_.s_to + rim - q.s});
}

double LineFit::above_bottom(const GapNode& q) const {
  return strip_.bottom ? *strip_.bottom - q.depth : q.above_fillet;
}

/// Does a foot count for what is left: within the strip and the ring?
bool LineFit::in_strip(const GapNode& q) const {
  return q.depth >= strip_.top - 10 * kExactEnd && above_bottom(q) >= -10 * kExactEnd &&
         q.s >= flank_.s_from - 10 * kExactEnd && q.s <= flank_.s_to + 10 * kExactEnd;
}

/// Of a walk along an axis, mm.
double LineFit::step_along(const AxisLine<double>& axis) const {
  return flank_.depth / std::max(kLeastRise, axis.a.dot(flank_.up(axis.c_0))) / kWalkSteps;
}

/// Feet from the ball end up to the first above the tips, in even steps; fewer where the regular sheet ends.
std::vector<GapNode> LineFit::walk(const AxisLine<double>& axis, double t_start, const Place& start) const {
  const double step = step_along(axis);
  const auto first = gap_at(axis, t_start, start);
  if (!first) return {};
  std::vector<GapNode> out{*first};
  const auto to = [&](double t) {
    const std::size_t n = out.size();
    return gap_at(axis, t, n < 2 ? out.back().at : expected(out[n - 2], out[n - 1], t));
  };
  while (out.back().t > 0) {
    const auto q = to(std::max(0.0, out.back().t - step));
    if (!q) break;
    out.push_back(*q);
  }
  std::reverse(out.begin(), out.end());
  while (out.back().depth > 0 && out.size() < kMostFeet) {
    const auto q = to(out.back().t + step);
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
        const auto q = gap_at(axis, t, expected(a, b, t));
        return q ? g(*q) : NAN;
      },
      a.t, g(a), b.t, g(b));
}

std::optional<GapLine> LineFit::gap_along(const AxisLine<double>& axis, double t_start, const Place& start) const {
  const auto feet = walk(axis, t_start, start);
  if (feet.empty()) return {};
  GapLine line;
  const auto to_tip = [&](const GapNode& q) { return q.depth; };
  const auto beyond = [&](const GapNode& q) { return std::max({0.0, flank_.s_from - q.s, q.s - flank_.s_to}); };
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
  const auto below_top = [&](const GapNode& q) { return q.depth - strip_.top; };
  line.strip_to = line.t_top;
  if (strip_.top > kExactEnd)
    for (std::size_t k = 1; k < feet.size(); ++k)
      if (below_top(feet[k - 1]) > 0 && below_top(feet[k]) <= 0) {
        line.strip_to = crossing(axis, feet[k - 1], feet[k], below_top);
        splits.push_back(std::clamp(line.strip_to, line.t_from, line.t_to));
      }
  if (!add_nodes(axis, std::move(splits), first->at, line) || !extremes(axis, line)) return {};
  return line;
}

/// Chebyshev points over the whole domain and, where the strip ends below the tips, over the strip; all splits are
/// nodes.
bool LineFit::add_nodes(const AxisLine<double>& axis, std::vector<double> splits, Place start, GapLine& line) const {
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
    const std::size_t n = line.nodes.size();
    const auto q = gap_at(axis, t, n < 2 ? start : expected(line.nodes[n - 2], line.nodes[n - 1], t));
    if (!q) return false;
    if (n == 0) start = q->at;
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
    if (!in_strip(q)) return;
    line.strip_in_ring = true;
    line.most = std::max(line.most, q.e);
  };
  for (const auto& q : line.nodes) look(q);
  for (std::size_t k = 1; k + 1 < line.nodes.size(); ++k) {
    const auto &a = line.nodes[k - 1], &b = line.nodes[k], &c = line.nodes[k + 1];
    if ((b.e < a.e) != (b.e < c.e)) continue;
    const double t = vertex(a, b, c);
    const auto q = gap_at(axis, t, expected(a, c, t));
    if (!q) return false;
    look(*q);
  }
  line.most = std::max(line.most, line.least);
  return true;
}

std::optional<double> LineFit::reach_bottom(const Anchor& anchor, PoseAngles<double> pose) const {
  std::optional<Place> last;
  const auto height = [&](double t_m) {
    pose.t_m = t_m;
    const auto axis = axis_of<double>(anchor.P, anchor.frame, law_, pose);
    if (!last) {
      last = anchor.place.at;
      for (const double share : {0.75, 0.5, 0.25})
        if (const auto q = gap_at(axis, share * t_m, *last)) last = q->at;
    }
    const auto q = gap_at(axis, 0, *last);
    if (!q) return -flank_.module_mm;  // beyond the undercut edge: too low
    last = q->at;
    return above_bottom(*q);
  };
  double low = 0, b_low = height(0), high = 1.3 * (bottom_depth() - strip_.anchor), b_high = height(high);
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
  const GapLine& gap = pose.gap;
  const auto share = [&](double top) {
    return top > 0 ? (std::min(gap.ring_to, top) - gap.ring_from) / (top + std::max(pose.lift, 0.0)) : 0;
  };
  pose.covered = std::max(0.0, std::min(share(gap.t_top), share(gap.strip_to)));
  return true;
}

std::optional<StationPose> LineFit::posed(double s, const Anchor& anchor, PoseAngles<double> angles,
                                          double lift) const {
  const auto t_m = reach_bottom(anchor, angles);
  if (!t_m) return {};
  StationPose pose;
  pose.s = s;
  pose.lift = lift;
  angles.t_m = *t_m;
  pose.at = anchor.place.at;
  pose.anchor = anchor.P;
  pose.up = flank_.up(anchor.P);
  pose.angles = angles;
  pose.axis = axis_of<double>(anchor.P, anchor.frame, law_, angles);
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

/// Of an axis that touches at t_m, eps = 0: along the wanted direction, upright where that lies along the tooth and on
/// upright flanks.
std::optional<double> LineFit::wanted_lean(const Anchor& at, double t_m) const {
  const auto psi = lean(shape_at(at.frame, at.place.on), law_.rho(t_m) + flank_.allowance_mm);
  if (!psi) return {};
  if (flank_.upright) return 0.0;
  const Vec3 a = axis_direction<double>(at.frame, *psi, std::asin(law_.slope(t_m)));
  return a.dot(flank_.up(at.P)) < std::cos(kAlongTheTooth) ? 0 : *psi;
}

std::optional<StationPose> LineFit::start(double s) const {
  const auto at = anchor(s);
  if (!at) return {};
  PoseAngles<double> angles;
  angles.t_m = 1.2 * (bottom_depth() - strip_.anchor);
  for (int k = 0; k < 2; ++k) {
    const auto psi = wanted_lean(*at, angles.t_m);
    if (!psi) return {};
    angles.psi = *psi;
    const auto t_m = reach_bottom(*at, angles);
    if (!t_m) return {};
    angles.t_m = *t_m;
  }
  auto pose = posed(s, *at, angles, 0);
  if (!pose || !measure(*pose)) return {};
  pose->about.psi = angles.psi;
  if (angles.psi == 0) pose->about.most_psi = 0;  // upright strips gain nothing by a lean
  // Where the flank bends along the line a strip that is anchored near its top turns by as much as it bends.
  const double bend = shape_at(at->frame, at->place.on).along(std::cos(angles.psi), std::sin(angles.psi));
  pose->about.most_eps = std::max(pose->about.most_eps, std::abs(bend) * pose->gap.t_top);
  return pose;
}

std::optional<StationPose> LineFit::place(double s, double psi, double eps, double delta, double lift,
                                          std::optional<double> bias) const {
  const auto at = anchor(s);
  if (!at) return {};
  auto pose = posed(s, *at, {psi, eps, delta, 0}, lift);
  if (!pose) return {};
  if (lift != 0) {
    pose->angles.t_m -= lift;
    pose->axis = axis_of<double>(at->P, at->frame, law_, pose->angles);
  }
  if (!measure(*pose)) return {};
  if (!bias || !pose->gap.in_ring()) return pose;
  auto settled = *pose;
  settle(settled, *at, *bias);
  // What is left in the ring lies beside the strip, and may stand far off.
  const bool whole = strip_.top == 0 && !strip_.bottom;
  if (!whole && !settled.gap.strip_in_ring && settled.angles.delta < delta) return pose;
  return settled;
}

std::optional<double> LineFit::eps_under(double s, double psi, double t_m, const AxisCondition& condition) const {
  const auto at = anchor(s);
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

std::optional<StationPose> LineFit::best(double s, const std::optional<AxisCondition>& condition,
                                         const std::optional<Neighbourhood>& near) const {
  const auto at = anchor(s);
  auto pose = start(s);
  if (!at || !pose) return {};
  const auto under = [&](PoseAngles<double> angles) -> std::optional<StationPose> {
    if (condition) {
      const auto eps = eps_under(s, angles.psi, angles.t_m, *condition);
      if (!eps) return {};
      angles.eps = *eps;
    }
    auto moved = posed(s, *at, angles, 0);
    if (!moved || !measure(*moved)) return {};
    return moved;
  };
  PoseAngles<double> from = pose->angles;
  Neighbourhood about = near ? *near : pose->about;
  if (condition && !near) about.most_psi = Neighbourhood{}.most_psi;
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

double LineFit::lift_to(const StationPose& pose, double s_most, int sense) const {
  const double step = step_along(pose.axis);
  auto last = gap_at(pose.axis, std::max(pose.angles.t_m, 0.0), pose.at);
  const auto beyond = [&](const GapNode& q) { return sense * (q.s - s_most); };
  // Down to the ball end, then up to the first foot that is not beyond.
  for (double t = pose.angles.t_m; last && t > 0;) {
    t = std::max(0.0, t - step);
    last = gap_at(pose.axis, t, last->at);
  }
  if (!last || beyond(*last) <= 0) return 0;
  for (std::size_t k = 0; last->depth > 0 && k < kMostFeet; ++k) {
    const auto above = gap_at(pose.axis, last->t + step, last->at);
    if (!above) break;
    if (beyond(*above) <= 0) return crossing(pose.axis, *last, *above, beyond);
    last = above;
  }
  return last->t;
}

}  // namespace toothpath::line
