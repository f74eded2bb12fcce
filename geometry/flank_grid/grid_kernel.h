// The tooth space between two splines, with a ball rolled between each and the root: flank, fillet and root for any
// scalar. docs/flank_grid_gear.md
//
// Flank: u is the way up from where the ball touches it, v runs along the teeth as s does in the middle of its grid.
// Fillet: u is the share of the arc from the root, 0, to the flank, 1, at the v of the flank. Root: u is the share from
// where one ball touches it to where the other does, both at v.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/base/angle.h"
#include "geometry/flank_grid/rolled_ball.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::flank_grid {

struct GridKernel {
  using Piece = tooth_space::Piece;

  tooth_space::Outline ring;
  Flank plus, minus;
  RolledBall ball_plus, ball_minus;
  Meridian root;
  double radius_mm = 0;  ///< of the ball
  double middle = 0;     ///< azimuth in the middle of the root: angles are told from there
  RoundedLine tip_line;  ///< h(s) of the tip surface

  [[nodiscard]] const Flank& flank(int side) const { return side > 0 ? plus : minus; }
  [[nodiscard]] const RolledBall& ball(int side) const { return side > 0 ? ball_plus : ball_minus; }

  template <typename S>
  bool place(Piece piece, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    if (!rolled_at(v)) return false;
    if (piece == Piece::root) return root_place(u, v, p, n);
    const int side = tooth_space::side_of(piece);
    if (tooth_space::is_fillet(piece)) return fillet_place(ball(side), u, v, p, n);
    if (!tooth_space::is_flank(piece)) return false;
    flank(side).at<S>(S(u + ball(side).contact(v)), v, p, &n);
    return true;
  }
  /// The normal of a flank takes one more derivative of its spline.
  template <typename S>
  bool place_alone(Piece piece, const S& u, const S& v, Vec3T<S>& p) const {
    Vec3T<S> n;
    if (!tooth_space::is_flank(piece)) return place(piece, u, v, p, n);
    if (!rolled_at(v)) return false;
    const int side = tooth_space::side_of(piece);
    flank(side).at<S>(S(u + ball(side).contact(v)), v, p, nullptr);
    return true;
  }

  // What KernelSpace asks besides.
  template <typename S>
  [[nodiscard]] S tip(const S& s) const {
    return tip_line.at(s);
  }
  [[nodiscard]] const tooth_space::Outline& outline() const { return ring; }
  [[nodiscard]] tooth_space::Borders borders(Piece piece) const {
    const tooth_space::WallBorders wall{INFINITY, 0, 1, 0};
    return borders_of(piece, wall, wall);
  }
  /// Of any mate: down to the fillet.
  [[nodiscard]] tooth_space::Borders active(Piece flank) const { return borders(flank); }
  [[nodiscard]] Vec2 about_tip(int side, double s) const {
    const double v = std::clamp(s, ball(side).from(), ball(side).to()),
                 u = flank(side).spline.u().back() - ball(side).contact(v);
    return {u, v_at(tooth_space::flank_of(side), u, s)};
  }
  [[nodiscard]] double v_at(Piece piece, double u, double s) const {
    const double from = std::max(ball_plus.from(), ball_minus.from()), to = std::min(ball_plus.to(), ball_minus.to()),
                 v = std::clamp(s, from, to);
    Vec3 p, n;
    if (!place<double>(piece, u, v, p, n)) return v;
    return std::clamp(v + s - ring.chart.along(p), from, to);
  }
  [[nodiscard]] Vec2 longest_step(Piece piece) const {
    const double along = 0.1 * (ring.s_to - ring.s_from);
    if (tooth_space::is_flank(piece)) return {0.25 * plus.spline.height(), along};
    return {piece == Piece::root ? 0.5 : 0.1, along};
  }

 private:
  /// Do both balls reach all of v?
  template <typename S>
  [[nodiscard]] bool rolled_at(const S& v) const {
    return low_of(base_of(v)) >= std::max(ball_plus.from(), ball_minus.from()) &&
           high_of(base_of(v)) <= std::min(ball_plus.to(), ball_minus.to());
  }
  template <typename S>
  [[nodiscard]] static S radius_of(const Vec3T<S>& p) {
    using std::sqrt;
    return sqrt(S(p[0] * p[0] + p[1] * p[1]));
  }
  template <typename S>
  bool fillet_place(const RolledBall& rolled, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    using std::acos, std::sin;
    Vec3T<S> c, flank_normal;
    rolled.at(v, c, flank_normal);
    const auto [outwards, up] = root.outwards(rolled.foot(v));
    const S out = outwards / radius_of(c);
    const Vec3T<S> root_normal(c[0] * out, c[1] * out, up);
    const S arc = acos(S(root_normal.dot(flank_normal))), whole = S(1.0) / sin(arc);
    n = root_normal * S(sin(S((S(1.0) - u) * arc)) * whole) + flank_normal * S(sin(S(u * arc)) * whole);
    p = c - n * S(radius_mm);
    return true;
  }
  template <typename S>
  bool root_place(const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    using std::atan2, std::cos, std::sin;
    const TurnT<S> turn{S(middle)};
    // Where each ball touches it: azimuth from the middle, and the place on the meridian.
    std::array<S, 2> angle, foot;
    for (const std::size_t k : {0U, 1U}) {
      const RolledBall& rolled = k == 0 ? ball_plus : ball_minus;
      Vec3T<S> c, unused;
      rolled.at(v, c, unused);
      const Vec3T<S> from_middle = turn.back(c);
      angle[k] = atan2(from_middle[1], from_middle[0]);
      foot[k] = rolled.foot(v);
    }
    const S x = foot[0] + u * (foot[1] - foot[0]), a = angle[0] + u * (angle[1] - angle[0]), c = cos(a), s = sin(a);
    const auto [r, z] = root.place(x);
    const auto [outwards, up] = root.outwards(x);
    p = turn(Vec3T<S>(r * c, r * s, z));
    n = turn(Vec3T<S>(outwards * c, outwards * s, up));
    return true;
  }
};

}  // namespace toothpath::flank_grid
