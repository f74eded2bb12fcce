#include "geometry/bevel_gear/wall_kernel.h"

#include <algorithm>

#include "geometry/base/angle.h"

namespace toothpath::bevel_gear {
namespace {

using tooth_space::Borders;
using tooth_space::Piece;

constexpr int kTurnLooks = 64;
constexpr double kFlat = 0.01;  // w_0 where the contact does not swing: any is as good

/// tan(beta_c) rho_A / (R_c tan(delta)) of a path.
double turn_at(const BevelWall<double>& w, double beta) {
  const CutterCentre<double> c = w.trace.centre(w.sigma, beta);
  return std::tan(c.beta_c) * w.cutter.rho_o * w.trace.cos_delta / (c.R_c * w.trace.sin_delta);
}

}  // namespace

WallKernel::WallKernel(const BevelGear& gear, std::size_t half)
    : h_a_(gear.parameters().addendum_mm),
      teeth_(gear.parameters().teeth),
      ell_from_(gear.halves()[half].ell_from),
      ell_to_(gear.halves()[half].ell_to) {
  const BevelHalf& of = gear.halves()[half];
  least_turn_ = INFINITY;
  begin_ = -of.walls[0].trace.R_0;
  for (std::size_t k = 0; k < 2; ++k) {
    const BevelWall<double>& wall = of.walls[k];
    std::get<Pair<double>>(walls_)[k] = wall;
    std::get<Pair<D2>>(walls_)[k] = wall_over<D2>(wall);
    std::get<Pair<tooth_space::BoxSecond>>(walls_)[k] = wall_over<tooth_space::BoxSecond>(wall);
    const double from = std::min(of.beta_from[k], of.beta_to[k]), to = std::max(of.beta_from[k], of.beta_to[k]);
    turn_[k] = INFINITY;
    for (int n = 0; n <= kTurnLooks; ++n)
      turn_[k] = std::min(turn_[k], wall.trace.h * turn_at(wall, from + (to - from) * n / kTurnLooks));
    least_turn_ = std::min(least_turn_, turn_[k]);
  }
  const bool crown_wheel = of.walls[0].trace.cos_delta == 0;  // its contacts do not swing
  if (crown_wheel) least_turn_ = INFINITY;
  else if (least_turn_ < kLeastTurn) flat_ = kFlat;
  for (std::size_t k = 0; k < 2; ++k) {
    const FingerProfile<double>& mill = of.walls[k].cutter;
    if (crown_wheel || flat_ > 0) turn_[k] = kFlat;
    fillet_end_[k] = std::asinh((mill.cos_phi / mill.sin_phi - flat_) / turn_[k]);
  }
}

WallKernel::Branch WallKernel::branch_at(Piece piece, double u, double v) const {
  Branch out;
  for (std::size_t k = 0; k < 2; ++k) {
    const BevelWall<double>& w = walls<double>()[k];
    out.straight_path[k] = w.eps() > 0 && v < v_of(w.trace, w.trace.beta_end);
  }
  if (!is_flank(piece)) return out;
  const FingerProfile<double>& mill = walls<double>()[wall_of(piece)].cutter;
  using Profile = Branch::Profile;
  if (u < mill.p_C) out.profile = Profile::straight;
  else out.profile = mill.law && u < mill.plain_p_C ? Profile::flank_on_line : Profile::flank;
  return out;
}

std::vector<WallKernel::Branch> WallKernel::branches(Piece piece, const Interval& u, const Interval& v) const {
  // Both ends, and both sides of every place between them where a formula ends.
  std::vector<double> at_u{u.low, u.high}, at_v{v.low, v.high};
  const auto both_sides = [](std::vector<double>& list, const Interval& range, double at) {
    if (!range.holds(at)) return;
    list.push_back(at);
    list.push_back(std::nextafter(at, -INFINITY));
  };
  if (is_flank(piece)) {
    const FingerProfile<double>& mill = walls<double>()[wall_of(piece)].cutter;
    both_sides(at_u, u, mill.p_C);
    if (mill.law) both_sides(at_u, u, mill.plain_p_C);
  }
  for (const BevelWall<double>& w : walls<double>())
    if (w.eps() > 0) both_sides(at_v, v, v_of(w.trace, w.trace.beta_end));
  std::vector<Branch> out;
  for (const double a : at_u)
    for (const double b : at_v) {
      const Branch one = branch_at(piece, a, b);
      if (std::find(out.begin(), out.end(), one) == out.end()) out.push_back(one);
    }
  return out;
}

tooth_space::Outline WallKernel::outline() const {
  const auto& trace = walls<double>()[0].trace;
  return tooth_space::outline_on_cone(trace.sin_delta, trace.cos_delta, teeth_, ell_from_, ell_to_);
}

Borders WallKernel::borders(Piece piece) const {
  const double B = walls<double>()[0].cutter.p_B;
  return borders_of(piece, {INFINITY, B, fillet_end_[0], 0}, {INFINITY, B, fillet_end_[1], 0});
}

Borders WallKernel::active(Piece flank) const {
  const double C = walls<double>()[0].cutter.p_C;
  return flank == Piece::flank_plus ? Borders{INFINITY, C} : Borders{C, INFINITY};
}

Vec2 WallKernel::about_tip(int side, double s) const {
  const BevelWall<double>& w = wall(side);
  const BevelTrace<double>& t = w.trace;
  // Where the cone distance turns back near the end of the trace the wall lies on the falling branch.
  const auto found = bevel_inverse(w, -s, h_a_);
  const double p = found ? found->p : w.cutter.p_D;
  auto beta = bevel_beta_at(w, -s, p);
  if (!beta && found) beta = found->beta;
  if (!beta) return {p, v_at(tooth_space::flank_of(side), p, s)};
  if (!t.straight(w.sigma, *beta)) return {p, v_of(t, *beta)};
  const double length = 2 * t.R_0 * std::sin(t.beta_end) * (t.beta_end - *beta);  // of the trace's arc
  return {p, v_of(t, t.beta_end) - length / speed_of(t.beta_end)};
}

double WallKernel::v_at(Piece /*piece*/, double /*u*/, double s) const {
  const BevelTrace<double>& t = walls<double>()[0].trace;
  return -s < t.R_0 ? v_of(t, t.beta(-s)) : s;
}

Vec2 WallKernel::longest_step(Piece piece) const {
  const FingerProfile<double>& mill = walls<double>()[0].cutter;
  return {is_flank(piece) ? 0.3 * (mill.p_D - mill.p_B) : 0.5, 0.05 * ell_to_};
}

}  // namespace toothpath::bevel_gear
