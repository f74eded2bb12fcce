#include "geometry/loaded/tooth_body.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "geometry/loaded/half_space.h"

namespace toothpath::loaded {
namespace {

using elastic::ToothSection;

constexpr int kMostFilletBricks = 6;

/// Angles are followed, not cut at pi.
double near_to(double angle, double reference) { return angle - 2 * kPi * std::round((angle - reference) / (2 * kPi)); }

/// Boundary of one side of the gear's tooth at radius r, from the tip to the root.
Result<std::vector<Vec2>> gear_boundary(const face_gear::FaceGearSurface<double>& f, int side, double r,
                                        const elastic::SectorPlan& plan) {
  const auto low = face_gear::fillet_line_height(f, side, r);
  if (!low) return fail("the flank of side {:+} is undercut at radius {:.4f} mm", side, r);
  std::vector<Vec2> out;
  std::optional<face_gear::FlankCoordinates> near;
  const double top = f.z_tip(r);
  for (int k = 0; k <= 2 * plan.flank; ++k) {
    const double z = top + (*low - top) * k / (2 * plan.flank);
    const auto at = face_gear::invert_flank(f, side, r, z, near);
    if (!at) return fail("no point of the flank of side {:+} at radius {:.4f} mm, height {:.4f} mm", side, r, z);
    near = at;
    out.emplace_back(face_gear::flank_azimuth(f, side, *at), z);
  }
  const auto& w = f.shaper;
  double Z = f.flank_Z(side, near->theta, near->B);
  for (int k = 1; k <= 2 * plan.fillet; ++k) {
    const double A = w.A_t + (w.A_e - w.A_t) * k / (2 * plan.fillet);
    const auto at = face_gear::fillet_Z_at_radius(f, side, A, r, Z);
    if (!at) return fail("the fillet of side {:+} does not reach radius {:.4f} mm", side, r);
    Z = *at;
    const auto p = f.fillet(side, A, Z);
    out.emplace_back(near_to(std::atan2(p.p[1], p.p[0]), out.back().x()), p.p[2]);
  }
  return out;
}

Result<std::vector<ToothSection>> gear_sections(const face_gear::FaceGearSurface<double>& f, double inner, double outer,
                                                const elastic::SectorPlan& plan) {
  std::vector<ToothSection> sections;
  double before = 0;
  for (int w = 0; w <= 2 * plan.face; ++w) {
    const double r = inner + (outer - inner) * w / (2 * plan.face);
    auto low = gear_boundary(f, -1, r, plan), high = gear_boundary(f, 1, r, plan);
    if (!low) return low.error();
    if (!high) return high.error();
    // Tooth 0 of both flanks, next to the section before.
    const double shift_high = near_to(high->front().x(), before) - high->front().x();
    for (auto& p : *high) p.x() += shift_high;
    const double shift_low = near_to(low->front().x(), high->front().x()) - low->front().x();
    for (auto& p : *low) p.x() += shift_low;
    before = high->front().x();
    ToothSection s;
    s.low = std::move(*low), s.high = std::move(*high);
    const double middle = (s.low.back().x() + s.high.back().x()) / 2;
    s.angle_low = middle - f.pitch / 2, s.angle_high = middle + f.pitch / 2;
    s.root = face_gear::root_height(f, r).value_or((s.low.back().y() + s.high.back().y()) / 2);
    if (s.high.back().x() - s.low.back().x() > 0.999 * f.pitch) {  // round tip of the shaper: no land
      s.low.back().x() = middle - 0.4995 * f.pitch;
      s.high.back().x() = middle + 0.4995 * f.pitch;
    }
    sections.push_back(std::move(s));
  }
  return sections;
}

/// Places of the fillet of the pinion: (half angle from the middle of the tooth, radius).
Vec2 pinion_fillet(const PinionProfile& p, double share) {
  const Vec2 centre = (p.r_f + p.fillet) * Vec2(std::cos(p.centre), std::sin(p.centre)),
             start = p.start * Vec2(std::cos(p.half_angle(p.start)), std::sin(p.half_angle(p.start)));
  const Vec2 from = start - centre;
  const double a = std::atan2(from.y(), from.x()), b = near_to(p.centre + kPi, a), angle = a + (b - a) * share;
  const Vec2 at = centre + p.fillet * Vec2(std::cos(angle), std::sin(angle));
  return {std::atan2(at.y(), at.x()), at.norm()};
}

ToothSection pinion_section(const PinionProfile& profile, int teeth, const elastic::SectorPlan& plan) {
  ToothSection s;
  for (int k = 0; k <= 2 * plan.flank; ++k) {
    const double R = profile.r_a + (profile.start - profile.r_a) * k / (2 * plan.flank);
    s.high.emplace_back(profile.half_angle(R), R);
  }
  for (int k = 1; k <= 2 * plan.fillet; ++k) s.high.push_back(pinion_fillet(profile, double(k) / (2 * plan.fillet)));
  for (const Vec2& p : s.high) s.low.emplace_back(-p.x(), p.y());
  s.angle_low = -kPi / teeth, s.angle_high = kPi / teeth;
  s.root = profile.r_f;
  return s;
}

}  // namespace

Vec3 FreeEnds::mirrored(const Vec3& p, std::size_t end) const {
  const Vec3 v = p - origin;
  const double along = v.dot(axis);
  if (kind == Kind::planes) return p + axis * (2 * (at[end] - along));
  const Vec3 out = v - axis * along;
  const double r = out.norm();
  if (kind == Kind::cones)
    return p + (out * (sin_delta / r) + axis * cos_delta) * (2 * (at[end] - r * sin_delta - along * cos_delta));
  return p + out * (2 * (at[end] - r) / r);
}

double PinionProfile::half_angle(double R) const {
  if (R <= r_b) return half_base;
  const double theta = std::sqrt((R - r_b) * (R + r_b)) / r_b;
  return half_base - theta + std::atan(theta);
}

PinionProfile pinion_profile(const contact::Pinion<double>& pinion, double dedendum_mm, double fillet_mm) {
  PinionProfile p;
  p.r_b = pinion.r_b, p.r_a = pinion.r_a, p.r_f = pinion.r_p - dedendum_mm;
  p.half_base = kPi / pinion.teeth - pinion.theta_0;
  for (p.fillet = fillet_mm;; p.fillet *= 0.9) {
    const double to_centre = p.r_f + p.fillet, root = (to_centre - p.r_b) * (to_centre + p.r_b);
    const double tangent = root > 0 ? std::sqrt(root) : 0;
    if (tangent > p.fillet) {
      p.least_theta = (tangent - p.fillet) / p.r_b;
      p.start = p.r_b * std::sqrt(1 + p.least_theta * p.least_theta);
      p.centre = p.half_base - p.least_theta + std::atan(tangent / p.r_b);
    } else {
      p.least_theta = 0;
      p.start = std::sqrt(p.r_f * (p.r_f + 2 * p.fillet));
      p.centre = p.half_base + std::asin(p.fillet / to_centre);
    }
    if (p.centre < 0.995 * kPi / pinion.teeth || p.fillet < 1e-3 * fillet_mm) return p;
  }
}

ToothBody::Weights ToothBody::weights(double face, double height) const {
  const int columns = sector.columns, rows = sector.rows;
  const double across = std::clamp((face - face_from) / (face_to - face_from), 0.0, 1.0) * (columns - 1);
  const int c = std::min(columns - 2, static_cast<int>(across));
  const double x = across - c;
  const auto k = static_cast<std::size_t>(c);
  const double high = top[k] * (1 - x) + top[k + 1] * x, low = foot[k] * (1 - x) + foot[k + 1] * x;
  const double down = std::clamp((high - height) / (high - low), 0.0, 1.0) * (rows - 1);
  const int r = std::min(rows - 2, static_cast<int>(down));
  const double y = down - r;
  const int at = r * columns + c;
  return {{at, at + 1, at + columns, at + columns + 1}, {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y}};
}

double ToothBody::remainder_at(const Weights& place, const Weights& force, int offset) const {
  if (std::abs(offset) > reach) return 0;
  const Eigen::MatrixXd& R = remainder[static_cast<std::size_t>(offset + reach)];
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k)
      sum += place.weight[i] * force.weight[k] * R(place.station[i], force.station[k]);
  return sum;
}

Result<ToothBody> gear_bricks(const face_gear::FaceGearSurface<double>& f, int side, double inner_mm, double outer_mm,
                              const elastic::SectorPlan& plan) {
  ToothBody body;
  body.ends.at = {inner_mm, outer_mm};
  body.face_from = inner_mm, body.face_to = outer_mm;
  elastic::SectorPlan bricks = plan;
  for (;; ++bricks.fillet) {
    auto sections = gear_sections(f, inner_mm, outer_mm, bricks);
    if (!sections) return sections.error();
    auto made = elastic::make_sector(bricks, *sections, side > 0, f.pitch, Vec3::UnitZ(), [&](int w, const Vec2& at) {
      const double r = inner_mm + (outer_mm - inner_mm) * w / (2 * bricks.face);
      return Vec3(r * std::cos(at.x()), r * std::sin(at.x()), at.y());
    });
    if (!made && bricks.fillet < kMostFilletBricks) continue;
    if (!made) return made.error();
    body.sector = std::move(*made);
    for (int c = 0; c <= bricks.face; ++c) {
      const auto& s = (*sections)[static_cast<std::size_t>(2 * c)];
      const auto& boundary = side > 0 ? s.high : s.low;
      body.top.push_back(boundary.front().y());
      body.foot.push_back(boundary[static_cast<std::size_t>(2 * bricks.flank)].y());
    }
    break;
  }
  body.fillet_bricks = bricks.fillet;
  return body;
}

Result<ToothBody> pinion_bricks(const contact::Pinion<double>& pinion, const PinionProfile& profile, int side,
                                double Z_from, double Z_to, const elastic::SectorPlan& plan) {
  ToothBody body;
  body.ends.kind = FreeEnds::Kind::planes, body.ends.at = {Z_from, Z_to};
  body.face_from = Z_from, body.face_to = Z_to;
  elastic::SectorPlan bricks = plan;
  bricks.rim_mm = std::min(bricks.rim_mm, 0.75 * profile.r_f);
  for (;; ++bricks.fillet) {
    const std::vector<ToothSection> sections(static_cast<std::size_t>(2 * bricks.face + 1),
                                             pinion_section(profile, pinion.teeth, bricks));
    // Side +1 of the gear runs in the space before the pinion's tooth, on its flank of smaller angle.
    auto made = elastic::make_sector(bricks, sections, side < 0, 2 * kPi / pinion.teeth, Vec3::UnitZ(),
                                     [&](int w, const Vec2& at) {
                                       const double Z = Z_from + (Z_to - Z_from) * w / (2 * bricks.face),
                                                    turn = at.x() + pinion.kappa * (Z - pinion.L0);
                                       return Vec3(at.y() * std::cos(turn), at.y() * std::sin(turn), Z);
                                     });
    if (!made && bricks.fillet < kMostFilletBricks) continue;
    if (!made) return made.error();
    body.sector = std::move(*made);
    break;
  }
  body.top.assign(static_cast<std::size_t>(bricks.face + 1), profile.r_a);
  body.foot.assign(static_cast<std::size_t>(bricks.face + 1), profile.start);
  body.fillet_bricks = bricks.fillet;
  return body;
}

Status add_remainder(ToothBody& body, const BodyPlan& plan) {
  auto C = elastic::tooth_compliance(body.sector, plan.nu, plan.teeth);
  if (!C) return C.error();
  body.reach = C->reach;
  body.reciprocity = C->reciprocity;
  const Eigen::MatrixXd H = hat_influence(body.sector, body.ends) * half_space_compliance(plan.E, plan.nu);
  for (int o = -C->reach; o <= C->reach; ++o) {
    const auto at = static_cast<std::size_t>(o + C->reach), other = static_cast<std::size_t>(C->reach - o);
    Eigen::MatrixXd R = (C->at_offset[at] + C->at_offset[other].transpose()) / (2 * plan.E);
    if (o == 0) R -= (H + H.transpose()) / 2;
    body.remainder.push_back(std::move(R));
  }
  return Ok{};
}

Result<ToothBody> gear_body(const face_gear::FaceGearSurface<double>& f, int side, double inner_mm, double outer_mm,
                            const BodyPlan& plan) {
  auto body = gear_bricks(f, side, inner_mm, outer_mm, plan.bricks);
  if (!body) return body;
  if (const auto done = add_remainder(*body, plan); !done) return done.error();
  return body;
}

Result<ToothBody> pinion_body(const contact::Pinion<double>& pinion, const PinionProfile& profile, int side,
                              double Z_from, double Z_to, const BodyPlan& plan) {
  auto body = pinion_bricks(pinion, profile, side, Z_from, Z_to, plan.bricks);
  if (!body) return body;
  if (const auto done = add_remainder(*body, plan); !done) return done.error();
  return body;
}

Eigen::MatrixXd hat_influence(const elastic::Sector& s, const FreeEnds& ends) {
  const auto n = static_cast<Eigen::Index>(s.stations.size());
  const std::vector<double> areas = elastic::hat_areas(s);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  const elastic::GaussRule& rule = elastic::gauss_rule(6);
  struct Point {
    std::array<Vec3, 3> places;  // itself and its images
    std::array<double, 4> hat{};
    double area = 0;
  };
  const auto point_at = [&](const elastic::FaceNodes& x, double a, double b, double weight) {
    const elastic::FacePlace place = elastic::face_place(x, a, b);
    return Point{{place.point, ends.mirrored(place.point, 0), ends.mirrored(place.point, 1)},
                 place.hat,
                 place.area.norm() * weight};
  };
  static constexpr double corner_a[4] = {-1, 1, 1, -1}, corner_b[4] = {-1, -1, 1, 1};
  for (const auto& face : s.faces) {
    elastic::FaceNodes x;
    for (int k = 0; k < elastic::kFaceNodes; ++k)
      x.col(k) = s.nodes[static_cast<std::size_t>(face.nodes[static_cast<std::size_t>(k)])];
    std::vector<Point> plain;
    std::array<std::vector<Point>, 4> at_corner;  // dense towards one corner: two triangles each, after Duffy
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j) {
        plain.push_back(point_at(x, rule.x[i], rule.x[j], rule.weight[i] * rule.weight[j]));
        const double far = (1 + rule.x[i]), across = (1 + rule.x[j]) / 2;  // in [0, 2], [0, 1]
        const double weight = rule.weight[i] * rule.weight[j] / 2 * far;
        for (std::size_t c = 0; c < 4; ++c)
          for (const bool first : {true, false}) {
            const double da = first ? far : far * across, db = first ? far * across : far;
            at_corner[c].push_back(point_at(x, corner_a[c] * (1 - da), corner_b[c] * (1 - db), weight));
          }
      }
    for (Eigen::Index i = 0; i < n; ++i) {
      const Vec3 here = s.nodes[static_cast<std::size_t>(s.stations[static_cast<std::size_t>(i)])];
      const std::vector<Point>* points = &plain;
      for (std::size_t c = 0; c < 4; ++c)
        if (face.stations[c] == static_cast<int>(i)) points = &at_corner[c];
      for (const Point& p : *points) {
        double near = 0;
        for (const Vec3& place : p.places) near += p.area / (place - here).norm();
        for (std::size_t c = 0; c < 4; ++c)
          H(i, face.stations[c]) += near * p.hat[c] / areas[static_cast<std::size_t>(face.stations[c])];
      }
    }
  }
  return H;
}

}  // namespace toothpath::loaded
