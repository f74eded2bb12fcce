#include "geometry/loaded/line_of_tooth.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/contact/touch_search.h"

namespace toothpath::loaded {
namespace {

constexpr int kSamples = 600;         // of B over the flank
constexpr double kLeastReach = 0.01;  // mm: of differences of a removal
constexpr double kLeastTheta = 1e-4;  // of places of a flank
constexpr double kEdgeKnown = 1e-11;  // mm and rad: where a flank ends

}  // namespace

LinePlace LineOfTooth::at(double B) const {
  const double theta = line_theta(f_, side_, B, phi_);
  return at(pinion_ != nullptr ? valley(B, theta) : theta, B);
}

LinePlace LineOfTooth::at(double theta, double B) const {
  LinePlace p;
  p.B = B;
  p.theta = theta;
  const face_gear::FaceGearSurface<double>::FlankPlace place(f_, side_, p.theta, B);
  p.point = place.housing();
  p.normal = side_ * (f_.t(B) * f_.shaper.cos_bb - f_.a() * f_.shaper.sin_bb);
  const auto& w = f_.shaper;
  double theta_1 = p.theta, r_b1 = w.r_b, r_a1 = w.r_p + w.h_a;
  p.Z = place.Z();
  p.R = w.r_b * std::sqrt(1 + p.theta * p.theta);
  if (pinion_ != nullptr) {
    const double turn = f_.i * (phi_ - place.phi());
    p.point = turned(p.point, turn);
    p.normal = turned(p.normal, turn);
    const auto on_pinion = pinion_->place(p.point);
    p.R = on_pinion.radius, p.Z = on_pinion.Z;
    r_b1 = pinion_->r_b, r_a1 = pinion_->r_a;
    theta_1 = std::sqrt(std::max(0.0, (p.R - r_b1) * (p.R + r_b1))) / r_b1;
    p.gap = gap(p.theta, B);
  }
  p.r = radius(p.point);
  p.regular = theta_1 > bounds_.least_theta && p.theta > 0 && place.curvature().J > 0;
  const double z_tip = f_.z_tip(p.r);
  const double in_theta = std::min(theta_1 - bounds_.least_theta, p.theta) * r_b1, in_tip = z_tip - p.point.z(),
               in_pinion = r_a1 - p.R, in_face = std::min(p.r - bounds_.inner_mm, bounds_.outer_mm - p.r);
  p.inside = std::min({in_theta, in_tip, in_pinion, in_face});
  p.end = p.inside == in_theta    ? FlankEnd::involute
          : p.inside == in_tip    ? FlankEnd::gear_tip
          : p.inside == in_pinion ? FlankEnd::pinion_tip
                                  : FlankEnd::face;
  if (!p.regular) p.inside = std::min(in_theta, -1.0);
  // Along the flank, by the slopes of the edges in it.
  const double roll = w.cos_bb * w.cos_bb * theta_1 * theta_1 / (1 + theta_1 * theta_1);
  const Vec3& n = p.normal;
  const double n_r = (n.x() * p.point.x() + n.y() * p.point.y()) / p.r;
  const double off_pinion = -in_pinion / std::sqrt(std::max(1e-6, 1 - roll)),
               off_tip = -in_tip / std::sqrt(std::max(1e-6, 1 - n.z() * n.z())),
               off_face = -in_face / std::sqrt(std::max(1e-6, 1 - n_r * n_r));
  p.beyond = std::max({0.0, off_pinion, off_tip, off_face});
  p.nearest = p.point;
  if (p.beyond > 0) {
    Vec3 out = Vec3::UnitZ();
    if (p.beyond == off_pinion) out = from_axis(p.point);
    else if (p.beyond == off_face) out = Vec3(p.point.x(), p.point.y(), 0) * (p.r < bounds_.inner_mm ? -1 : 1);
    p.nearest -= (out - n * n.dot(out)).normalized() * p.beyond;
  }
  return p;
}

std::optional<LinePlace> LineOfTooth::nearest(double B, double& theta) const {
  const auto inside = [&](double t) { return at(t, B).inside; };
  const double most = f_.shaper.theta_t;
  if (!(inside(theta) >= 0)) {
    const double deepest = contact::highest_place(inside, kLeastTheta, most);
    if (!(inside(deepest) >= 0)) return std::nullopt;
    theta = deepest;
  }
  const auto end_towards = [&](double out) {
    return inside(out) >= 0 ? out : contact::last_inside(inside, theta, out, kEdgeKnown);
  };
  const double low = end_towards(kLeastTheta), high = end_towards(most);
  theta = (low + high) / 2;
  return at(contact::highest_place([&](double t) { return -gap(t, B); }, low, high), B);
}

Vec3 LineOfTooth::normal_over_edge(const LinePlace& p) const {
  if (p.end == FlankEnd::involute || p.end == FlankEnd::pinion_tip) return p.normal;
  const auto on_pinion = pinion_->place(p.point);
  const double theta_1 =
      std::sqrt(std::max(0.0, (on_pinion.radius - pinion_->r_b) * (on_pinion.radius + pinion_->r_b))) / pinion_->r_b;
  const double B_1 = std::atan2(on_pinion.y, on_pinion.x) + side_ * std::atan(theta_1);
  return side_ * (pinion_->t(B_1) * pinion_->cos_bb - pinion_->a * pinion_->sin_bb);
}

Vec3 LineOfTooth::from_axis(const Vec3& point) const {
  const Vec3 foot = pinion_ != nullptr ? pinion_->foot : Vec3(f_.b() * f_.E), axis = axis_of_pinion(), v = point - foot;
  return v - axis * v.dot(axis);
}

double LineOfTooth::section(const Vec3& point) const {
  return (point - (pinion_ != nullptr ? pinion_->foot : Vec3(f_.b() * f_.E))).dot(axis_of_pinion());
}

void LineOfTooth::bend(LinePlace& p) const {
  auto H = f_.flank_shape(side_, p.theta, p.B);
  if (pinion_ == nullptr) {
    p.curvature = H.ee + H.ll + f_.shaper.cos_bb / (f_.shaper.r_b * p.theta);
    return;
  }
  const double turn = f_.i * phi_;  // from the gear's frame into the housing
  const auto basis = f_.flank_basis(side_, p.theta, p.B);
  const auto on_pinion = pinion_->place(p.point);
  const double theta_1 =
      std::sqrt((on_pinion.radius - pinion_->r_b) * (on_pinion.radius + pinion_->r_b)) / pinion_->r_b;
  const Vec3 e_1 = pinion_->e(std::atan2(on_pinion.y, on_pinion.x) + side_ * std::atan(theta_1));
  const double e = turned(basis.e, turn).dot(e_1), l = turned(basis.l, turn).dot(e_1),
               k = pinion_->cos_bb / (pinion_->r_b * theta_1);
  H.ee += k * e * e, H.el += k * e * l, H.ll += k * l * l;
  if (bent_by_.removal != nullptr) bend_by_removal(p.point, turned(basis.e, turn), turned(basis.l, turn), H);
  p.curvature = H.k1();
  p.roundness = H.k2() / H.k1();
  // The eigenvector of the larger curvature, from the row that is further from zero.
  const double row_e = H.k1() - H.ll, row_l = H.k1() - H.ee;
  const Vec3 steepest = std::abs(row_e) > std::abs(row_l) ? Vec3(basis.e * row_e + basis.l * H.el)
                                                          : Vec3(basis.e * H.el + basis.l * row_l);
  if (steepest.norm() > 0) p.steepest = turned(steepest, turn).normalized();
  else p.steepest = turned(basis.e, turn);
}

void LineOfTooth::bend_by_removal(const Vec3& point, const Vec3& e, const Vec3& l,
                                  face_gear::FaceGearSurface<double>::ShapeOperator& H) const {
  const double h = std::max(kLeastReach, bent_by_.reach_mm);
  const auto at = [&](double x, double y) { return (*bent_by_.removal)(point + h * (x * e + y * l)); };
  const double here = 2 * at(0, 0);
  H.ee += (at(1, 0) + at(-1, 0) - here) / (h * h);
  H.ll += (at(0, 1) + at(0, -1) - here) / (h * h);
  H.el += (at(1, 1) + at(-1, -1) - at(1, -1) - at(-1, 1)) / (4 * h * h);
}

LineOfTooth::Moves LineOfTooth::moves(const LinePlace& p) const {
  const auto d = f_.flank_derivatives(side_, p.theta, p.B);
  const double turn = f_.i * phi_;
  return {turned(d.u, turn), turned(d.v, turn)};
}

bool LineOfTooth::find(double& from, double& to) const {
  const double step = (bounds_.most_B - bounds_.least_B) / kSamples;
  int best_from = -1, best_to = -2, start = -1, peak = 0;
  double highest = -1e300;
  for (int k = 0; k <= kSamples; ++k) {
    const double inside = at(bounds_.least_B + step * k).inside;
    if (inside > highest) highest = inside, peak = k;
    if (inside >= 0 && start < 0) start = k;
    if (start >= 0 && (inside < 0 || k == kSamples)) {
      const int last = inside < 0 ? k - 1 : k;
      if (last - start > best_to - best_from) best_from = start, best_to = last;
      start = -1;
    }
  }
  double in_from = 0, in_to = 0;
  if (best_from >= 0) in_from = bounds_.least_B + step * best_from, in_to = bounds_.least_B + step * best_to;
  else {  // a line shorter than a step: the highest place between the samples
    double low = bounds_.least_B + step * (peak - 1), high = low + 2 * step;
    for (int k = 0; k < 60; ++k) {
      const double a = low + (high - low) * 0.382, b = low + (high - low) * 0.618;
      (at(a).inside < at(b).inside ? low : high) = at(a).inside < at(b).inside ? a : b;
    }
    if (at((low + high) / 2).inside < 0) return false;
    in_from = in_to = (low + high) / 2;
  }
  from = end(in_from, in_from - step);
  to = end(in_to, in_to + step);
  return true;
}

double LineOfTooth::gap(double theta, double B) const {
  const face_gear::FaceGearSurface<double>::FlankPlace place(f_, side_, theta, B);
  const Vec3 point = turned(place.housing(), f_.i * (phi_ - place.phi()));
  auto on_pinion = pinion_->place(point);
  on_pinion.radius = std::max(on_pinion.radius, pinion_->r_b);
  const double phi_1 = phi_ * f_.i / pinion_->ratio;
  double turn = pinion_->turn_at(side_, on_pinion);
  turn += 2 * kPi * std::round((phi_1 - turn) / (2 * kPi));
  const double removed = bent_by_.removal != nullptr ? (*bent_by_.removal)(point) : 0;
  return removed + side_ * pinion_->r_b * pinion_->cos_bb * (phi_1 - turn);
}

double LineOfTooth::valley(double B, double start) const {
  constexpr double h = 1e-4;
  double theta = std::max(start, 1e-3), low = -1e300, high = 1e300;
  for (int k = 0; k < 30; ++k) {
    const double here = gap(theta, B), up = gap(theta + h, B), down = gap(theta - h, B);
    const double slope = (up - down) / (2 * h), bend = (up - 2 * here + down) / (h * h);
    if (!(bend > 0)) break;
    (slope < 0 ? low : high) = theta;
    double step = std::clamp(-slope / bend, -0.1, 0.1);
    if (!(theta + step > low && theta + step < high) && high - low < 1) step = (low + high) / 2 - theta;
    theta += step;
    if (std::abs(step) < 1e-9) break;
  }
  return theta;
}

double LineOfTooth::end(double in, double out) const {
  if (at(out).inside >= 0) return out;
  for (int k = 0; k < 60; ++k) {
    const double middle = (in + out) / 2;
    (at(middle).inside >= 0 ? in : out) = middle;
  }
  return in;
}

Segment segment_of(const LineOfTooth& line, const LinePlace& p) {
  Segment s;
  s.theta = p.theta, s.B = p.B, s.point = p.point, s.normal = p.normal;
  s.nearest = p.nearest;
  s.r = radius(p.nearest);
  s.z = p.nearest.z();
  s.Z = line.section(p.nearest);
  s.R = line.from_axis(p.nearest).norm();
  s.curvature = p.curvature;
  s.beyond = p.beyond;
  s.gap = p.gap + s.curvature * p.beyond * p.beyond / 2;
  return s;
}

}  // namespace toothpath::loaded
