#include "geometry/inspection/bevel_touches.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath::inspection {
namespace {

constexpr int kSteps = 200;
constexpr double kStill = 1e-13;  // of a step along the wall, of its cone distance

/// Foot of a place on a wall from a start near it, by Gauss and Newton; every step comes nearer.
std::optional<bevel_gear::BevelFlankPoint<double>> foot_of(const bevel_gear::BevelWall<double>& wall, double beta,
                                                           double p, const Vec3& x) {
  constexpr double kBetaStep = 1e-6, kProfileStep = 1e-5;
  const auto point = [&](double b, double q) { return wall.point(b, q); };
  auto at = point(beta, p);
  for (int k = 0; k < kSteps; ++k) {
    Eigen::Matrix<double, 3, 2> J;
    J.col(0) = (point(beta + kBetaStep, p).p - point(beta - kBetaStep, p).p) / (2 * kBetaStep);
    J.col(1) = (point(beta, p + kProfileStep).p - point(beta, p - kProfileStep).p) / (2 * kProfileStep);
    const Vec2 step = J.colPivHouseholderQr().solve(x - at.p);
    if (!step.allFinite()) return {};
    double share = 1;
    const double off = (x - at.p).squaredNorm();
    for (; share > 1e-6; share /= 2) {
      const auto next = point(beta + share * step[0], p + share * step[1]);
      if (!next.p.allFinite() || (x - next.p).squaredNorm() > off) continue;
      beta += share * step[0];
      p += share * step[1];
      at = next;
      break;
    }
    if (share * (J * step).norm() < kStill * wall.trace.R_0 || share <= 1e-6) return at;
  }
  return {};
}

}  // namespace

bevel_gear::ConePoint TouchedBevelGear::on_cone(const Vec3& x) const {
  return bevel_gear::cone_point(x, gear_.sin_delta(), gear_.cos_delta());
}
Vec3 TouchedBevelGear::place(double ell, double height, double azimuth) const {
  return bevel_gear::blank_point(ell, height, azimuth, gear_.sin_delta(), gear_.cos_delta());
}

PartReach TouchedBevelGear::reach() const {
  const auto& p = gear_.parameters();
  const Vec3 inner_root = place(gear_.R_i(), -p.dedendum_mm, 0), inner_tip = place(gear_.R_i(), p.addendum_mm, 0);
  const Vec3 outer_root = place(gear_.R_e(), -p.dedendum_mm, 0), outer_tip = place(gear_.R_e(), p.addendum_mm, 0);
  return {std::min(inner_tip.z(), inner_root.z() - p.shaft_length_mm), outer_root.z() + p.hub_length_mm,
          std::max({outer_tip.x(), 0.5 * p.hub_diameter_mm, 0.5 * p.shaft_diameter_mm})};
}

Result<std::vector<Touch>> TouchedBevelGear::flank_places(int spaces) const {
  const double height = 0.5 * (gear_.cutter().x_C + gear_.parameters().addendum_mm);
  std::vector<Touch> out;
  for (int k = 0; k < spaces; ++k)
    for (int zone = 0; zone < int(gear_.halves().size()); ++zone) {
      const auto& half = gear_.halves()[std::size_t(zone)];
      const std::vector<double> shares =
          gear_.herringbone() ? std::vector<double>{0.5} : std::vector<double>{0.25, 0.75};
      for (const double share : shares)
        for (const int sigma : {1, -1}) {
          const double ell = half.ell_from + share * (half.ell_to - half.ell_from);
          const auto& wall = half.wall(sigma);
          const auto there = bevel_inverse(wall, ell, height);
          if (!there)
            return fail(
                "half {}, wall {}: the mill forms no wall at cone distance {:.3f} mm, {:.3f} mm above the pitch "
                "cone",
                zone, sigma > 0 ? 'L' : 'U', ell, height);
          const auto f = wall.point(there->beta, there->p);
          Touch touch;
          touch.zone = zone;
          touch.side = sigma;
          touch.space = int(std::lround(double(k) * teeth() / spaces));
          touch.remark = fmt::format("HALF {} SPACE {} WALL {}", zone, touch.space % teeth(), sigma > 0 ? 'L' : 'U');
          const double turn = touch.space * gear_.pitch();
          touch.surface = turned(f.p, turn);
          touch.normal = turned(f.n, turn);
          touch.up = gear_.axis(f.centre.e + turn);
          out.push_back(std::move(touch));
        }
    }
  return out;
}

Result<std::vector<Touch>> TouchedBevelGear::blank_places(int spaces) const {
  std::vector<Touch> out;
  const double height = gear_.parameters().addendum_mm;
  for (int k = 0; k < spaces; ++k)
    for (const double share : {0.25, 0.75}) {
      const double ell = gear_.R_i() + share * (gear_.R_e() - gear_.R_i()), azimuth = kTwoPi * k / spaces;
      Touch touch;
      touch.what = Touched::top;
      touch.remark = "FACE CONE OF THE BLANK";
      touch.up = touch.normal = gear_.axis(azimuth);
      touch.surface = place(ell, height, azimuth);
      out.push_back(std::move(touch));
    }
  return out;
}

std::optional<double> TouchedBevelGear::wall_distance(int half, int sigma, const Vec3& x) const {
  const auto& wall = gear_.halves()[std::size_t(half)].wall(sigma);
  const auto at = on_cone(x);
  // Above the tips the wall goes on as far as its involute, below the straight as far as the fillet.
  const double lowest = wall.cutter.x_B, step = 0.05 * gear_.parameters().outer_transverse_module_mm;
  for (double height = std::max(at.height, lowest); height >= lowest; height -= step)
    if (const auto start = bevel_inverse(wall, at.ell, height)) {
      const auto foot = foot_of(wall, start->beta, start->p, x);
      if (foot) return (x - foot->p).dot(foot->n);
    }
  return {};
}

std::optional<double> TouchedBevelGear::distance(const Touch& touch, const Vec3& x) const {
  if (touch.what != Touched::flank) return on_cone(x).height - gear_.parameters().addendum_mm;
  return wall_distance(touch.zone, touch.side, turned(x, -touch.space * gear_.pitch()));
}

double TouchedBevelGear::flank(const Touch& touch, int side, const Vec3& x) const {
  // Beyond the groove of a herringbone the teeth of the other half begin.
  const auto& half = gear_.halves()[std::size_t(touch.zone)];
  const double ell = on_cone(x).ell, groove = gear_.parameters().relief_half_width_mm;
  if (gear_.herringbone() && (touch.zone == 0 ? ell > half.ell_to + groove : ell < half.ell_from - groove))
    return -std::numeric_limits<double>::infinity();
  return wall_distance(touch.zone, side, turned(x, -touch.space * gear_.pitch()))
      .value_or(-std::numeric_limits<double>::infinity());
}

/// The root is round: its fillet begins there.
double TouchedBevelGear::above_root(const Touch&, const Vec3& x) const {
  return on_cone(x).height + gear_.parameters().dedendum_mm - gear_.cutter().r_t;
}
double TouchedBevelGear::below_tops(const Touch&, const Vec3& x) const {
  return std::max(gear_.parameters().addendum_mm - on_cone(x).height, 0.0);
}

}  // namespace toothpath::inspection
