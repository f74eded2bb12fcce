#include "geometry/spiral_bevel/cutter_kernel.h"

#include <algorithm>

namespace toothpath::spiral_bevel {

using tooth_space::Borders;
using tooth_space::Outline;

Outline CutterKernel::outline() const { return tooth_space::outline_on_cone(sin_d, cos_d, teeth, R_i, R_e); }

Borders CutterKernel::borders(Piece piece) const {
  const auto wall = [&](int side) {
    return tooth_space::WallBorders{INFINITY, flank(side).u_F, flank(side).alpha, kQuarter};
  };
  return borders_of(piece, wall(1), wall(-1));
}

/// Of a narrow face more than the face: the cutter sweeps over the same flanks.
Vec2 CutterKernel::longest_step(Piece piece) const {
  const double v = 0.25 * std::max(R_e - R_i, 0.25 * R_e);
  const double u = is_flank(piece) ? v : piece == Piece::root ? 0.5 : 0.2;
  return {u, v};
}

CutterKernel::Rail CutterKernel::rail(std::size_t flank, double s) const {
  const double x = (s + R_e) / (R_e - R_i) * double(kRails - 1);
  const auto first = std::size_t(std::clamp(std::floor(x), 0.0, double(kRails) - 2));
  const double share = x - double(first);
  const Rail &a = rails[flank][first], &b = rails[flank][first + 1];
  Rail out{a.u_tip + share * (b.u_tip - a.u_tip), {}};
  for (std::size_t k = 0; k < 3; ++k) out.v[k] = a.v[k] + share * (b.v[k] - a.v[k]);
  return out;
}

Vec2 CutterKernel::about_tip(int side, double s) const {
  const Rail at = rail(index(side), s);
  return {at.u_tip, at.v[2]};
}

double CutterKernel::v_at(Piece piece, double u, double s) const {
  if (!is_flank(piece)) return s;
  const Rail at = rail(index(side_of(piece)), s);
  const double u_F = flank(side_of(piece)).u_F, x = (u - u_F) / (at.u_tip - u_F);
  return at.v[0] * (1 - x) * (1 - 2 * x) + at.v[1] * 4 * x * (1 - x) + at.v[2] * x * (2 * x - 1);
}

std::optional<double> CutterKernel::solve_v(Piece piece, double u, double s, double near) const {
  using D = Dual<double, 2>;
  constexpr int kSteps = 30;
  const tooth_space::Chart chart{-sin_d, cos_d};
  const double most = longest_step(piece)[1];
  for (int k = 0; k < kSteps; ++k) {
    Vec3T<D> p, n;
    if (!place<D>(piece, D(u), D::variable(near, 1), p, n)) return {};
    const double lack = s - chart.along(value(p));
    if (std::abs(lack) < 1e-12 * R_e) return near;
    near += std::clamp(lack / chart.along(value(p), derivative(p, 1)), -most, most);
  }
  return {};
}

std::optional<Vec2> CutterKernel::solve(Piece piece, double s, double h, Vec2 near) const {
  using D = Dual<double, 2>;
  constexpr int kSteps = 30;
  const tooth_space::Chart chart{-sin_d, cos_d};
  const Vec2 most = longest_step(piece);
  for (int k = 0; k < kSteps; ++k) {
    Vec3T<D> p, n;
    if (!place<D>(piece, D::variable(near[0], 0), D::variable(near[1], 1), p, n)) return {};
    const Vec3 at = value(p), by_u = derivative(p, 0), by_v = derivative(p, 1);
    const double lack_s = s - chart.along(at), lack_h = h - chart.up(at);
    if (std::abs(lack_s) + std::abs(lack_h) < 1e-13 * (1 + R_e)) return near;
    const double su = chart.along(at, by_u), sv = chart.along(at, by_v), hu = chart.up(at, by_u),
                 hv = chart.up(at, by_v), det = su * hv - sv * hu;
    Vec2 step((lack_s * hv - sv * lack_h) / det, (su * lack_h - lack_s * hu) / det);
    if (!step.allFinite()) return {};
    step /= std::max({1.0, std::abs(step[0]) / most[0], std::abs(step[1]) / most[1]});
    near += step;
    if (step.norm() < 1e-14 * (1 + R_e)) return near;
  }
  return {};
}

}  // namespace toothpath::spiral_bevel
