#include "cam/finger/reference.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::finger {
namespace {

constexpr int kNodes = 240;
constexpr int kEdgePoints = 2048;
constexpr double kClear = 1e9;           // "no tooth in reach"
constexpr int kEngagedProfile = 64;      // places of the profile at which the end of the engagement is looked for
constexpr double kBesideJoint = 1e-6;    // mm: where the bend of a modified path is looked at on both sides of a jump
constexpr double kEngagedMargin = 0.01;  // of the cutter's radius: what the contact may reach between them

/// dR_c/dbeta on the path of a wall.
double slope(const bevel_gear::BevelTrace<double>& t, int sigma, double beta, double beta_c) {
  const double b = t.straight(sigma, beta) ? t.beta_end : beta;
  return -2 * t.R_0 * std::sin(b) * t.speed_ratio(sigma, b) * std::cos(beta_c);
}

}  // namespace

// A shift of the centre in the crown plane is a turn about the gear's axis and a way along the generator. The way moves
// every point alike, the turn by its distance from the axis: the farthest point of a circle of radius rho about the
// cutter axis, square to it, at the height h_a or h_f.
double centre_leverage(const bevel_gear::BevelGear& gear) {
  const double sd = gear.sin_delta(), cd = gear.cos_delta(), rho = gear.cutter().rho_D;
  const double from_axis = std::max(1e-9, gear.R_i() - rho) * sd,
               height = std::max(gear.parameters().addendum_mm, gear.parameters().dedendum_mm);
  const double centre = from_axis + height * cd;
  const bool outermost = centre * sd >= rho * cd * cd;  // the circle's point in the axial plane
  const double farthest = outermost ? centre + rho * sd : std::hypot(centre / cd, rho);
  return std::max(1.0, farthest / from_axis);
}

ConePose cone_pose(const bevel_gear::BevelGear& g, const Vec3& tip, const Vec3& axis, double index) {
  const double sd = g.sin_delta(), cd = g.cos_delta();
  // A vertical axis has no azimuth; then the tip's own counts (the tilt says what is wrong).
  const double radial = std::hypot(axis.x(), axis.y());
  const double e = radial > 1e-9 ? std::atan2(axis.y(), axis.x()) : std::atan2(tip.y(), tip.x());
  const Vec3 q = bevel_gear::cutter_from_blank<double>(tip, 0.0, e, sd, cd);
  ConePose pose;
  pose.lift = q.x() + g.parameters().dedendum_mm;
  const double aside = std::atan2(q.y(), q.z() * sd);
  pose.R_c = q.z();
  double azimuth = std::remainder(e + aside - index, 2 * kPi);
  pose.theta = azimuth * sd;
  const Vec3 normal = g.axis(e + aside);
  pose.tilt = std::atan2(normal.cross(axis).norm(), normal.dot(axis));
  return pose;
}

/// Points of a wall at one cone distance, from root to tip. The fillet leaves the root at a tangent: its points need
/// heights that begin in squares.
WallReference::Edge WallReference::edge_points(const bevel_gear::BevelGear& g,
                                               const bevel_gear::BevelWall<double>& wall, double ell) {
  Edge edge;
  const double low = -g.parameters().dedendum_mm, high = g.parameters().addendum_mm;
  std::optional<bevel_gear::BevelInverse> at;
  for (int i = 0; i <= kEdgePoints; ++i) {
    const double t = (i + 0.02) / (kEdgePoints + 0.02), height = low + (high - low) * t * t * (2 - t);
    auto next = at ? bevel_gear::bevel_inverse(wall, ell, height, *at) : bevel_gear::bevel_inverse(wall, ell, height);
    if (!next && at) next = bevel_gear::bevel_inverse(wall, ell, height);
    at = next;
    if (!at) continue;
    const Vec3 p = bevel_gear::blank_point(ell, height, at->azimuth, g.sin_delta(), g.cos_delta());
    const double gap = edge.points.empty() ? 0 : (p - edge.points.back()).norm();
    if (!edge.points.empty()) edge.gap.back() = std::max(edge.gap.back(), gap);
    edge.points.push_back(p);
    edge.gap.push_back(gap);
    edge.spacing = std::max(edge.spacing, gap);
  }
  return edge;
}

WallReference::WallReference(const bevel_gear::BevelGear& gear, int sigma)
    : sigma_(sigma), solid_(gear.cutter()), sin_delta_(gear.sin_delta()), cos_delta_(gear.cos_delta()) {
  inner_edge_ = edge_points(gear, gear.halves().front().wall(sigma), gear.R_i());
  // Before the very end of the trace the envelope turns back: the face that is measured ends at ell_to.
  outer_edge_ = edge_points(gear, gear.halves().back().wall(sigma), gear.halves().back().ell_to);
  const auto& first = gear.halves().front().wall(sigma);
  reach_ = first.cutter.rho_D;
  r_0_ = first.cutter.r_0;
  near_ = gear.R_i() - reach_ - 0.5;
  far_ = gear.R_e() + reach_ + 0.5;
  const int k = sigma > 0 ? 0 : 1;
  for (const auto& half : gear.halves()) {
    Curve c;
    c.trace = half.walls[k].trace;
    for (int i = 0; i <= kNodes; ++i) {
      const double beta = half.beta_from[k] + (half.beta_to[k] - half.beta_from[k]) * i / kNodes;
      c.beta.push_back(beta);
      c.R_c.push_back(c.trace.centre(sigma, beta).R_c);
      if (!c.trace.straight(sigma, beta))
        curvature_ = std::max(curvature_, std::abs(c.trace.turn(sigma, beta) / c.trace.speed_ratio(sigma, beta)));
    }
    curvature_ = std::max(curvature_, curvature_at_joints(c));
    halves_.push_back(std::move(c));
  }
  end_ = halves_.back().trace.centre(sigma, halves_.back().beta.back());
  if (gear.herringbone()) {
    convex_ = sigma != gear.corner().sigma;
    split_ = gear.corner().R_c;
    if (convex_) {
      corner_R_ = gear.R_ref();
      corner_theta_ = -sigma * gear.e_h() * gear.sin_delta();
      arc_from_ = halves_[0].R_c.back();
      arc_to_ = halves_[1].R_c.front();
      corner_.emplace(gear);
      curvature_ = std::max(curvature_, 1 / corner_->least_radius());
    }
  }
  engaged_from_ = first_engaged(gear, sigma, halves_.front());
  leverage_ = centre_leverage(gear);
}

double WallReference::first_engaged(const bevel_gear::BevelGear& gear, int sigma, const Curve& first) {
  const bevel_gear::BevelWall<double>& wall = gear.halves().front().wall(sigma);
  const double high = gear.parameters().addendum_mm, low = wall.cutter.p_A,
               step = (wall.cutter.p_D - low) / kEngagedProfile;
  for (std::size_t i = 0; i < first.beta.size(); ++i)
    for (int k = 0; k <= kEngagedProfile; ++k) {
      const auto at = wall.generatrix(first.beta[i], low + k * step);
      if (at[0] >= gear.R_i() - kEngagedMargin * wall.cutter.rho_D) return first.R_c[i > 0 ? i - 1 : 0];
      if (at[1] > high) break;
    }
  return first.R_c.back();
}

double WallReference::curvature_at_joints(const Curve& c) const {
  double most = 0;
  const auto* law = c.trace.lead_of(sigma_);
  if (!law) return most;
  for (const auto& curve : law->removed.curves)
    for (const double R : curve.knots())
      for (const double side : {-kBesideJoint, kBesideJoint}) {
        const double beta = c.trace.beta(R + side);
        if (!c.trace.straight(sigma_, beta) && beta > 0)
          most = std::max(most, std::abs(c.trace.turn(sigma_, beta) / c.trace.speed_ratio(sigma_, beta)));
      }
  return most;
}

std::size_t WallReference::half_of(double R_c) const {
  if (halves_.size() == 1) return 0;
  const double split = convex_ ? 0.5 * (arc_from_ + arc_to_) : split_;
  return R_c < split ? 0 : 1;
}

bevel_gear::CutterCentre<double> WallReference::on_curve(const Curve& c, double R_c) const {
  const auto it = std::lower_bound(c.R_c.begin(), c.R_c.end(), R_c);
  const std::size_t i = std::clamp<std::size_t>(static_cast<std::size_t>(it - c.R_c.begin()), 1, c.R_c.size() - 1);
  double beta = c.beta[i - 1] + (c.beta[i] - c.beta[i - 1]) * (R_c - c.R_c[i - 1]) / (c.R_c[i] - c.R_c[i - 1]);
  beta = std::min(beta, kPi / 2 - 1e-3);
  bevel_gear::CutterCentre<double> at;
  // Newton on R_c(beta); the table starts it within 1e-5 inside the pass.
  for (int n = 0; n < 30; ++n) {
    at = c.trace.centre(sigma_, beta);
    const double step = (at.R_c - R_c) / slope(c.trace, sigma_, beta, at.beta_c);
    beta = std::min(beta - std::clamp(step, -0.1, 0.1), kPi / 2 - 1e-3);
    if (std::abs(at.R_c - R_c) < 1e-12 * R_c) break;
  }
  return at;
}

double WallReference::theta_at(double R_c) const { return on_curve(halves_[half_of(R_c)], R_c).theta_c; }

bevel_gear::CutterCentre<double> WallReference::place_at(double R_c) const {
  bevel_gear::CutterCentre<double> c;
  if (R_c > end_.R_c) {
    // A straight line keeps its distance from the apex.
    c.R_c = R_c;
    c.beta_c = std::asin(end_.R_c * std::sin(end_.beta_c) / R_c);
    c.theta_c = end_.theta_c + end_.beta_c - c.beta_c;
  } else if (convex_ && R_c > arc_from_ && R_c < arc_to_ && !corner_->plain()) {
    c = corner_->at(corner_->share_at(R_c));
  } else if (convex_ && R_c > arc_from_ && R_c < arc_to_) {
    const double turn =
        sigma_ *
        std::acos(std::clamp((R_c * R_c + corner_R_ * corner_R_ - r_0_ * r_0_) / (2 * R_c * corner_R_), -1.0, 1.0));
    const double u = R_c - corner_R_ * std::cos(turn),
                 v = corner_R_ * std::sin(turn);  // from the corner, seen along the ray of the place
    c.R_c = R_c;
    c.theta_c = corner_theta_ + turn;
    c.beta_c = std::atan2(-sigma_ * u, sigma_ * v);
  } else {
    c = on_curve(halves_[half_of(R_c)], R_c);
  }
  c.e = c.theta_c / sin_delta_;
  return c;
}

std::vector<double> WallReference::joints() const {
  std::vector<double> at;
  for (const Curve& c : halves_) {
    if (halves_.size() > 1 && &c == &halves_.front()) at.push_back(c.R_c.back());
    if (halves_.size() > 1 && &c == &halves_.back()) at.push_back(c.R_c.front());
    if (c.trace.straight(sigma_, c.beta.back()) && !c.trace.straight(sigma_, c.beta.front()))
      at.push_back(c.trace.centre(sigma_, c.trace.beta_end).R_c);
  }
  at.push_back(end_.R_c);
  std::sort(at.begin(), at.end());
  return at;
}

double WallReference::edge_clearance(const Edge& edge, double R_c, double theta) const {
  if (edge.points.empty()) return -kClear;
  double least = kClear;
  // The nearest place is at half a gap from a point, with room for the bend of the edge. A distance changes by no more
  // than the way along the edge: far points let the next ones be passed over.
  for (std::size_t i = 0; i < edge.points.size();) {
    const double d = solid_.signed_distance(
        bevel_gear::cutter_from_blank<double>(edge.points[i], R_c, theta / sin_delta_, sin_delta_, cos_delta_));
    least = std::min(least, d - 0.51 * edge.gap[i]);
    i += 1 + static_cast<std::size_t>(std::max(0.0, (d - least) / edge.spacing - 1.51));
  }
  return least;
}

double WallReference::offset(double R_c, double theta) const {
  if (R_c > end_.R_c) {
    const double turn = theta - end_.theta_c;
    const double u = R_c * std::cos(turn) - end_.R_c, v = R_c * std::sin(turn);
    return sigma_ * (v * std::cos(end_.beta_c) - u * std::sin(end_.beta_c));
  }
  if (convex_ && R_c > arc_from_ && R_c < arc_to_) { return corner_->offset(R_c, theta); }
  const auto at = on_curve(halves_[half_of(R_c)], R_c);
  return sigma_ * (theta - at.theta_c) * R_c * std::cos(at.beta_c);
}

double WallReference::side(double R_c, double theta) const {
  if (R_c <= near_ || R_c >= far_) return kClear;
  const double on_path = offset(R_c, theta);
  if (on_path >= 0) return on_path;
  if (R_c > end_.R_c) return std::max(on_path, edge_clearance(outer_edge_, R_c, theta));
  if (R_c < engaged_from_) return std::max(on_path, edge_clearance(inner_edge_, R_c, theta));
  return on_path;
}

}  // namespace toothpath::finger
