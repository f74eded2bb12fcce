// The tooth space of a spiral bevel gear, as a face mill on a cradle cuts it: flank and fillet as envelopes of the
// cutter's cone and of its rounded edge, for any scalar. docs/spiral_bevel_gear.md
//
// A point of the cutter's profile describes a circle, on which the normal keeps its angle to the cutter's axis. So the
// equation of meshing is linear in the cosine and the sine of the place on that circle: at a given point of the profile
// and a given turn of the cradle it has a closed form, whatever tilt and roll are.
//
// Flank: u is the way along the blade from the sharp tip, mm. Fillet: u is the angle of its normal to the tip plane
// from the blade (its pressure angle) to the root (a quarter turn). Root: the share of its width from the plus to the
// minus edge. v is about s: the roll grows with it evenly, or the place on the circle does: without a roll, and where
// the roll turns back along the face, because contact lines run along the circles there (small spiral angles).
//
// Everything is computed for a left-hand gear; a right-hand one is its mirror image.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <type_traits>

#include "geometry/base/dual.h"
#include "geometry/base/vec.h"
#include "geometry/spiral_bevel/parameters.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::spiral_bevel {

/// What one flank and its fillet come from.
struct CutFlank {
  double out = 1;  ///< 1: outside blade, -1: inside
  double rho_0 = 0, sin_a = 0, cos_a = 0, edge = 0;
  double rho_c = 0;  ///< radius on which the rounding's centre turns
  double u_F = 0;    ///< way along the blade where the flank begins
  double alpha = 0;
  bool generated = true, tilted = false;
  double S = 0, q = 0, sin_g = 0, cos_g = 0;
  Vec3 centre = Vec3::Zero();     ///< of the machine, gear frame
  Vec3 moment = Vec3::Zero();     ///< of the gear's axis about it, machine frame
  std::array<double, 8> roll{};   ///< turn of the work: coefficients of powers of the cradle's, from the first
  std::size_t rolls = 1;          ///< how many there are
  Mat3 tilt = Mat3::Identity();   ///< of the cutter, cradle frame
  double branch = 1;              ///< which of two places on the circle
  bool by_circle = false;         ///< of a generated flank: the place on the circle grows with v, not the roll
  double at_mean = 0, per_s = 1;  ///< of what grows with v: its value at v_mean, and its growth by v
  double v_mean = 0;
  double turn = 0;  ///< of the finished flank, so that space 0 has its place

  /// Roll or place on the circle, whichever grows with v.
  template <typename S_>
  [[nodiscard]] S_ parameter(const S_& v) const {
    return S_(at_mean) + S_(per_s) * (v - S_(v_mean));
  }
  template <typename S_>
  struct Turned {
    S_ angle, ratio;  ///< of the work, and by the cradle's
  };
  template <typename S_>
  [[nodiscard]] Turned<S_> work(const S_& t) const {
    Turned<S_> sum{S_(0.0), S_(0.0)};
    for (std::size_t k = rolls; k-- > 0;) {
      sum.angle = (sum.angle + S_(roll[k])) * t;
      sum.ratio = sum.ratio * t + S_(double(k + 1) * roll[k]);
    }
    return sum;
  }

  /// A point of the profile: radius and height above the tip plane; its normal, out of the cutter; the slope of that
  /// against the tip plane, and where it meets that plane, as a radius.
  template <typename S_>
  struct ProfilePoint {
    S_ rho, zeta, across, down, slope, foot;
  };
  template <typename S_>
  [[nodiscard]] ProfilePoint<S_> profile(bool fillet, const S_& u) const {
    using std::cos, std::sin;
    if (fillet) {
      const S_ c = cos(u), down = sin(u), slope = S_(out) * c / down;
      return {S_(rho_c) + S_(out * edge) * c, S_(edge) * (S_(1.0) - down), S_(out) * c, down, slope,
              S_(rho_c) + S_(edge) * slope};
    }
    return {S_(rho_0) + S_(out * sin_a) * u, S_(cos_a) * u, S_(out * cos_a), S_(sin_a), S_(out * cos_a / sin_a),
            S_(rho_0) + S_(out / sin_a) * u};
  }

  /// The cutter in the machine: the centre of its tip circle, two directions square to its axis, and the axis.
  template <typename S_>
  struct Cradled {
    Vec3T<S_> Q, e_1, e_2, axis;
  };
  template <typename S_>
  [[nodiscard]] Cradled<S_> cradled(const S_& phi) const {
    using std::cos, std::sin;
    using V = Vec3T<S_>;
    const S_ c = cos(phi), s = sin(phi);
    const V Q(S_(S) * c, S_(S) * s, S_(0.0));
    if (!tilted) return {Q, V(S_(1.0), S_(0.0), S_(0.0)), V(S_(0.0), S_(1.0), S_(0.0)), V(S_(0.0), S_(0.0), S_(1.0))};
    // Rz(phi) tilt Rz(-phi), multiplied out: over boxes only what the tilt turns away spreads, which is little.
    const double mean = 0.5 * (tilt(0, 0) + tilt(1, 1)), part = 0.5 * (tilt(0, 0) - tilt(1, 1)), mixed = tilt(0, 1);
    const S_ twice = phi + phi, c_2 = cos(twice), s_2 = sin(twice);
    const S_ off = S_(part) * c_2 - S_(mixed) * s_2, across = S_(part) * s_2 + S_(mixed) * c_2;
    const S_ lean_x = S_(tilt(0, 2)) * c - S_(tilt(1, 2)) * s, lean_y = S_(tilt(0, 2)) * s + S_(tilt(1, 2)) * c;
    return {Q, V(S_(mean) + off, across, -lean_x), V(across, S_(mean) - off, -lean_y),
            V(lean_x, lean_y, S_(tilt(2, 2)))};
  }

  /// Cosine and sine of the angle with A cos + B sin + D = 0, of two the one of `branch`; nothing: there is none.
  template <typename S_>
  [[nodiscard]] std::optional<std::array<S_, 2>> angle_of(const S_& A, const S_& B, const S_& D) const {
    using std::sqrt;
    const S_ size = A * A + B * B, rest = size - D * D;
    if (rest < S_(0.0) || size <= S_(0.0)) return {};
    const S_ root = S_(branch) * sqrt(rest);
    return std::array<S_, 2>{-(D * A + root * B) / size, (root * A - D * B) / size};
  }
  /// Roll at which a point of the profile touches the gear at a place of its circle; nothing: at none. Only for an
  /// upright cutter and an even roll: the equation of meshing is linear in cosine and sine of the cradle's angle, too.
  template <typename S_>
  [[nodiscard]] std::optional<S_> roll_of_place(const ProfilePoint<S_>& point, const std::array<S_, 2>& place) const {
    using std::atan2, std::cos, std::sin;
    const S_ ratio(roll[0]), W_x = ratio * S_(cos_g), W_z = S_(1.0) - ratio * S_(sin_g);
    const auto& [c, s] = place;
    const S_ A = S_(S) * W_z * point.slope * s, B = S_(-S) * (W_z * point.slope * c + W_x),
             D = ratio * (point.slope * (S_(moment.x()) * c + S_(moment.y()) * s) - S_(moment.z())) -
                 W_x * point.foot * s;
    const auto cradle = angle_of(A, B, D);
    if (!cradle) return {};
    const S_ c_q = cos(S_(q)), s_q = sin(S_(q));  // from q on: no box of interest holds half a turn
    return atan2((*cradle)[1] * c_q - (*cradle)[0] * s_q, (*cradle)[0] * c_q + (*cradle)[1] * s_q);
  }

  /// Cosine and sine of the place on its circle at which a point of the profile touches the gear; nothing: nowhere.
  template <typename S_>
  [[nodiscard]] std::optional<std::array<S_, 2>> touching(const ProfilePoint<S_>& point, const Cradled<S_>& at,
                                                          const S_& ratio) const {
    using V = Vec3T<S_>;
    // Velocity of the cutter against the gear: W x P + V, of its tip circle's centre: G.
    const S_ W_x = ratio * S_(cos_g), W_z = S_(1.0) - ratio * S_(sin_g);
    const V G(ratio * S_(moment.x()) - W_z * at.Q[1], ratio * S_(moment.y()) + W_z * at.Q[0],
              ratio * S_(moment.z()) + W_x * at.Q[1]);
    S_ A, B, D;  // n.v = 0, by the part of the normal along the axis
    if (tilted) {
      // F = slope G + foot W x axis; e_1, e_2 and axis stand square to each other.
      const auto along_W = [&](const V& e) { return W_x * e[0] + W_z * e[2]; };
      A = point.slope * G.dot(at.e_1) + point.foot * along_W(at.e_2);
      B = point.slope * G.dot(at.e_2) - point.foot * along_W(at.e_1);
      D = -at.axis.dot(G);
    } else {
      A = point.slope * G[0];
      B = point.slope * G[1] - point.foot * W_x;
      D = -G[2];
    }
    return angle_of(A, B, D);
  }

  /// Place and normal out of the gear. False: the profile touches nowhere at this roll.
  template <typename S_>
  bool place(bool fillet, const S_& u, const S_& v, Vec3T<S_>& p, Vec3T<S_>& n) const {
    using std::cos, std::sin;
    using V = Vec3T<S_>;
    const ProfilePoint<S_> point = profile(fillet, u);
    S_ t = parameter(v);
    std::array<S_, 2> on_circle{S_(0.0), S_(0.0)};
    if (!generated || by_circle) on_circle = {cos(t), sin(t)};
    if (by_circle) {
      const auto there = roll_of_place(point, on_circle);
      if (!there) return false;
      t = *there;
    }
    const Turned<S_> turned_by = generated ? work(t) : Turned<S_>{S_(0.0), S_(0.0)};
    const Cradled<S_> cutter = cradled(generated ? S_(S_(q) + t) : S_(q));
    if (generated && !by_circle) {
      const auto touches = touching(point, cutter, turned_by.ratio);
      if (!touches) return false;
      on_circle = *touches;
    }
    const V outwards = cutter.e_1 * on_circle[0] + cutter.e_2 * on_circle[1];
    const V at = cutter.Q + outwards * point.rho + cutter.axis * point.zeta,
            normal = cutter.axis * point.down - outwards * point.across;
    const TurnT<S_> back(S_(turned_by.angle + S_(turn)));
    const auto in_gear = [&](const V& x) {
      return V(S_(sin_g) * x[0] + S_(cos_g) * x[2], -x[1], S_(cos_g) * x[0] - S_(sin_g) * x[2]);
    };
    const V in_housing = in_gear(at);
    p = back(V(in_housing[0] + S_(centre.x()), in_housing[1] + S_(centre.y()), in_housing[2] + S_(centre.z())));
    n = back(in_gear(normal));
    return true;
  }
};

/// What lies between the fillets: the root cone; of Formate the tip plane of the cutter; else a surface that leaves
/// both fillets smoothly.
enum class RootForm : std::uint8_t { cone, plane, woven };

struct CutterKernel {
  using Piece = tooth_space::Piece;

  int teeth = 0;
  int hand = 1;
  double sin_d = 0, cos_d = 0;  ///< of the pitch angle
  double R_e = 0, R_i = 0;
  double tip_0 = 0, tip_slope = 0;  ///< h of the face cone at s = 0, and its slope along s
  std::array<CutFlank, 2> flanks;   ///< concave, convex
  RootForm root = RootForm::cone;
  std::array<Vec2, 2> middle{};  ///< (u, v) of both flanks on the pitch cone in the middle of the face
  /// Of a flank at even steps from the large end: u of the tip edge; v at the fillet, half way and at the tip.
  struct Rail {
    double u_tip = 0;
    std::array<double, 3> v{};
  };
  static constexpr std::size_t kRails = 9;
  std::array<std::array<Rail, kRails>, 2> rails{};

  /// 0: concave. The left hand has it on the side of positive azimuth.
  [[nodiscard]] std::size_t index(int side) const { return side * hand > 0 ? 0 : 1; }
  [[nodiscard]] const CutFlank& flank(int side) const { return flanks[index(side)]; }

  template <typename S>
  bool place(Piece piece, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    if (piece == Piece::root) return place_root(u, v, p, n);
    const int side = tooth_space::side_of(piece);
    if (side == 0 || int(piece) >= tooth_space::kPieces) return false;
    if (!flank(side).template place<S>(is_fillet(piece), u, v, p, n)) return false;
    if (hand > 0) {
      p[1] = -p[1];
      n[1] = -n[1];
    }
    return true;
  }

  // What KernelSpace asks besides. s = -R along the pitch cone, h out of it.
  template <typename S>
  [[nodiscard]] S tip(const S& s) const {
    return S(tip_0) + S(tip_slope) * s;
  }
  [[nodiscard]] tooth_space::Outline outline() const;
  [[nodiscard]] tooth_space::Borders borders(Piece piece) const;
  /// Of any mate: down to the fillet.
  [[nodiscard]] tooth_space::Borders active(Piece piece) const { return borders(piece); }
  [[nodiscard]] Vec2 about_tip(int side, double s) const;
  [[nodiscard]] double v_at(Piece piece, double u, double s) const;
  [[nodiscard]] Vec2 longest_step(Piece piece) const;

  /// (u, v) of the place of a flank or a fillet at (s, h), from a place nearby; nothing where it is not found.
  [[nodiscard]] std::optional<Vec2> solve(Piece piece, double s, double h, Vec2 near) const;
  /// v of the place of a piece at u and s, from one nearby.
  [[nodiscard]] std::optional<double> solve_v(Piece piece, double u, double s, double near) const;

 private:
  [[nodiscard]] Rail rail(std::size_t flank, double s) const;
  template <typename S>
  bool place_root(const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    using std::atan2, std::cos, std::sin, std::sqrt;
    Vec3T<S> a, b, n_a, n_b;
    const S end(kQuarter);
    if (!place(Piece::fillet_plus, end, v, a, n_a) || !place(Piece::fillet_minus, end, v, b, n_b)) return false;
    if (root == RootForm::cone) {
      const S r_a = sqrt(S(a[0] * a[0] + a[1] * a[1])), r_b = sqrt(S(b[0] * b[0] + b[1] * b[1]));
      const S from = atan2(a[1], a[0]), r = r_a + u * (r_b - r_a), at = from + u * (atan2(b[1], b[0]) - from);
      const S c = cos(at), s = sin(at);
      const CutFlank& f = flanks[0];
      p = Vec3T<S>(r * c, r * s, a[2] + u * (b[2] - a[2]));
      n = Vec3T<S>(S(f.cos_g) * c, S(f.cos_g) * s, S(-f.sin_g));
      return true;
    }
    if (root == RootForm::plane) {
      p = a + (b - a) * u;
      n = n_a;
      return true;
    }
    p = woven(u, a, n_a, b, n_b);
    n = woven_normal(u, v);
    return true;
  }
  /// Hermite's cubic between two places, square to the normal at either end.
  template <typename S>
  static Vec3T<S> woven(const S& u, const Vec3T<S>& a, const Vec3T<S>& n_a, const Vec3T<S>& b, const Vec3T<S>& n_b) {
    const Vec3T<S> way = b - a, out = way - n_a * S(n_a.dot(way)), in = way - n_b * S(n_b.dot(way));
    const S w = S(1.0) - u, uu = u * u;
    return a + way * S(uu * (S(3.0) - u - u)) + out * S(w * w * u) - in * S(uu * w);
  }
  template <typename S>
  [[nodiscard]] Vec3T<S> woven_normal(const S& u, const S& v) const {
    using std::sqrt;
    if constexpr (std::is_same_v<S, double> || std::is_same_v<S, Dual<double, 2>>) {
      using D = Dual<S, 2>;
      const D u_d = D::variable(u, 0), v_d = D::variable(v, 1), end(kQuarter);
      Vec3T<D> a, b, n_a, n_b;
      if (!place(Piece::fillet_plus, end, v_d, a, n_a) || !place(Piece::fillet_minus, end, v_d, b, n_b)) return {};
      const Vec3T<D> q = woven(u_d, a, n_a, b, n_b);
      const Vec3T<S> n = derivative(q, 1).cross(derivative(q, 0));
      return n / S(sqrt(S(n.dot(n))));
    } else {
      return Vec3T<S>(S(0.0), S(0.0), S(0.0));  // enclosures ask for places alone
    }
  }
  static constexpr double kQuarter = 1.5707963267948966192313216916398;
};

}  // namespace toothpath::spiral_bevel
