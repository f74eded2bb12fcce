#include "cam/finger/clearance.h"

#include <algorithm>
#include <cmath>

#include "cam/finger/obstacles.h"
#include "cam/tool/frustum_distance.h"
#include "geometry/base/angle.h"

namespace toothpath::finger {
namespace {

constexpr int kBodyStations = 128;
constexpr int kMoments = 4, kBodyAlong = 6, kAcross = 6;  // intervals of the first look
constexpr double kWindow = kPi / 3;                       // rad: of a surface of revolution, to both sides of the body
constexpr double kBodyFinest = 1e-6;                      // mm

/// Where on a patch and a motion; all three 0 .. 1.
using At = std::array<double, 3>;

}  // namespace

FingerClearance::Edges FingerClearance::edges_of(const bevel_gear::BevelHalf& half) const {
  Edges out;
  out.half = &half;
  std::optional<bevel_gear::BevelInverse> near[2];
  for (int i = 0; i <= kBodyStations; ++i) {
    const double ell = half.ell_from + (half.ell_to - half.ell_from) * i / kBodyStations;
    std::array<double, 2> azimuth{};
    bool both = true;
    for (int k = 0; k < 2; ++k) {
      auto at = near[k] ? bevel_gear::bevel_inverse(half.walls[k], ell, gear_.parameters().addendum_mm, *near[k])
                        : std::nullopt;
      if (!at) at = bevel_gear::bevel_inverse(half.walls[k], ell, gear_.parameters().addendum_mm);
      near[k] = at;
      both = both && at;
      if (at) azimuth[std::size_t(k)] = at->azimuth;
    }
    if (!both && out.azimuth.empty()) continue;
    if (!both) break;
    if (out.azimuth.empty()) out.from = ell;
    out.to = ell;
    out.azimuth.push_back(azimuth);
  }
  return out;
}

std::array<double, 2> FingerClearance::sides(const Edges& e, double ell, bool exact) const {
  std::array<double, 2> wall{};
  if (exact) {
    for (std::size_t k = 0; k < 2; ++k) {
      const auto at = bevel_gear::bevel_inverse(e.half->walls[k], ell, gear_.parameters().addendum_mm);
      wall[k] = at ? at->azimuth : std::nan("");
    }
  } else {
    const double x = (ell - e.from) / (e.to - e.from) * double(e.azimuth.size() - 1);
    const auto i = std::min(std::size_t(std::max(x, 0.0)), e.azimuth.size() - 2);
    for (std::size_t k = 0; k < 2; ++k)
      wall[k] = e.azimuth[i][k] + (x - double(i)) * (e.azimuth[i + 1][k] - e.azimuth[i][k]);
  }
  return {wall[1], wall[0] + gear_.pitch()};
}

Vec3 FingerClearance::place(const Patch& p, double u, double w, bool exact) const {
  if (p.kind == Patch::Kind::turned) {
    const Vec2 q = p.a + u * (p.b - p.a);
    return {q.x() * std::cos(2 * kPi * w), q.x() * std::sin(2 * kPi * w), q.y()};
  }
  const Edges& e = edges_[p.half];
  const bool land = p.kind == Patch::Kind::land;
  const double ell = land ? e.from + u * (e.to - e.from) : p.a.x(), h_a = gear_.parameters().addendum_mm;
  const auto side = sides(e, ell, exact);
  const double azimuth = side[0] + w * (side[1] - side[0]) + p.tooth * gear_.pitch();
  return bevel_gear::blank_point(ell, land ? h_a : h_a - u * (h_a + gear_.parameters().dedendum_mm), azimuth,
                                 gear_.sin_delta(), gear_.cos_delta());
}

void FingerClearance::add(Patch p) {
  p.centre = place(p, 0.5, 0.5);
  if (p.kind == Patch::Kind::turned) {
    const Vec2 middle = 0.5 * (p.a + p.b);
    p.centre = Vec3(0, 0, middle.y());
    p.radius = std::max((p.a - Vec2(0, middle.y())).norm(), (p.b - Vec2(0, middle.y())).norm());
    p.size_u = (p.b - p.a).norm();
    p.size_w = 2 * kPi * std::max(p.a.x(), p.b.x());
  } else {
    for (int i = 0; i <= 8; ++i)
      for (int j = 0; j <= 8; ++j) p.radius = std::max(p.radius, 1.05 * (place(p, i / 8.0, j / 8.0) - p.centre).norm());
    p.size_u = (place(p, 1, 0.5) - place(p, 0, 0.5)).norm();
    p.size_w = std::max((place(p, 0, 1) - place(p, 0, 0)).norm(), (place(p, 1, 1) - place(p, 1, 0)).norm());
  }
  patches_.push_back(p);
}

FingerClearance::FingerClearance(const bevel_gear::BevelGear& gear) : gear_(gear) {
  for (const auto& half : gear_.halves())
    if (Edges e = edges_of(half); e.azimuth.size() > 2) edges_.push_back(std::move(e));
  for (std::size_t h = 0; h < edges_.size(); ++h)
    for (int tooth = 0; tooth < gear_.parameters().teeth; ++tooth) {
      add({.kind = Patch::Kind::land, .name = "land", .half = h, .tooth = tooth});
      if (h == 0)
        add({.kind = Patch::Kind::end, .name = "end", .half = h, .tooth = tooth, .a = Vec2(edges_[h].from, 0)});
      if (h + 1 == edges_.size())
        add({.kind = Patch::Kind::end, .name = "end", .half = h, .tooth = tooth, .a = Vec2(edges_[h].to, 0)});
    }
  for (const CoaxialBody& body : bodies_beside_teeth(gear_)) {
    add({.name = body.name, .a = body.rims[0], .b = body.rims[1]});
    for (const Vec2& rim : body.rims) add({.name = body.name, .a = Vec2(0, rim.y()), .b = rim});
  }
}

FoundGap FingerClearance::least(const tool::Frustum& body, const path::ToolMotion& m, const FoundGap& known) const {
  FoundGap best = known;
  const auto gap_at = [&](const Vec3& p, double t) {
    const Vec3 axis = path::axis_at(m, t), v = p - path::tip_at(m, t);
    const double h = v.dot(axis);
    return frustum_distance(Vec3((v - h * axis).norm(), 0, h), body);
  };
  const double arm = std::hypot(body.to, std::max(body.radius_from, body.radius_to));
  const double way = (m.tip_to - m.tip_from).norm() + arm * (m.axis_to - m.axis_from).norm();
  const Vec3 middle = path::tip_at(m, 0.5) + body.from * path::axis_at(m, 0.5);
  const double azimuth = std::atan2(middle.y(), middle.x()) / (2 * kPi);
  for (const Patch& p : patches_) {
    if (gap_at(p.centre, 0.5) - p.radius - way > best.gap_mm) continue;
    const bool turned = p.kind == Patch::Kind::turned;
    const double w_from = turned ? azimuth - kWindow / (2 * kPi) : 0, w_to = turned ? azimuth + kWindow / (2 * kPi) : 1;
    const auto gap = [&](const At& at) { return gap_at(place(p, at[1], at[2]), at[0]); };
    At step{1.0 / kMoments, 1.0 / kBodyAlong, (w_to - w_from) / kAcross}, at{};
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kMoments; ++i)
      for (int j = 0; j <= kBodyAlong; ++j)
        for (int k = 0; k <= kAcross; ++k)
          if (const At here{i * step[0], j * step[1], w_from + k * step[2]}; gap(here) < least)
            least = gap(here), at = here;
    if (least - step[0] * way - step[1] * p.size_u - step[2] * p.size_w > best.gap_mm) continue;
    const double size = std::max({step[0] * way, step[1] * p.size_u, step[2] * p.size_w});
    for (double share = 1; share * size > kBodyFinest;) {
      const At before = at;
      const double was = least;
      for (std::size_t n = 0; n < 3; ++n)
        for (const double sign : {-1.0, 1.0}) {
          At next = at;
          next[n] += sign * share * step[n];
          if (n < 2 || !turned) next[n] = std::clamp(next[n], 0.0, 1.0);
          if (const double d = gap(next); d < least) least = d, at = next;
        }
      if (least < was) {  // once more the same way
        At next = at;
        for (std::size_t n = 0; n < 3; ++n) {
          next[n] += at[n] - before[n];
          if (n < 2 || !turned) next[n] = std::clamp(next[n], 0.0, 1.0);
        }
        if (const double d = gap(next); d < least) least = d, at = next;
      }
      if (!(least < was - 1e-3 * share * size)) share *= 0.5;
    }
    const Vec3 exact = place(p, at[1], at[2], true);
    if (const double d = gap_at(exact, at[0]); d < best.gap_mm) best = {d, exact, at[0], p.name};
  }
  return best;
}

}  // namespace toothpath::finger
