// One half of an equal-base-circle bevel gear as a tooth space: the walls that the finger mill leaves, the fillets of
// its corner arc and the root cone, for any scalar and any tool. docs/bevel_gear.md, sections 5 and 14
//
// v = R_0 (w - 1), where w^2 = q^2 + kNear^2 q, q = sin(beta)^2, beta the spiral angle of the trace where the mill is:
// minus the cone distance R, but regular at the end of the trace, where w = 0; a path that ends straight goes on beyond
// its end. Flanks: u is the parameter p of the mill's profile above B. Fillets: the
// corner arc by cot(psi) = w_0 sinh(u), 0 at the root: near the root the contact swings from the path's normal to the
// generatrix while cot(psi) passes w_0. Where the path itself runs along the generatrix, it swings through in no
// height at all: there fillets end at cot(psi) = kFlat, 5e-5 of their radius above the root. Root: the share of the way
// between the fillets' ends. Wall L is the plus flank.
#pragma once

#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include "geometry/bevel_gear/gear.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::bevel_gear {

class WallKernel {
 public:
  using Piece = tooth_space::Piece;

  /// Where one formula holds. Of the walls L, U.
  struct Branch {
    enum class Profile : std::uint8_t { arc, straight, flank_on_line, flank } profile = Profile::arc;
    std::array<bool, 2> straight_path{};
    friend bool operator==(const Branch&, const Branch&) = default;
  };

  /// @param half  of the gear, counted from the inside
  WallKernel(const BevelGear& gear, std::size_t half);

  template <typename S>
  bool place(Piece piece, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    const double at = base_of(v);
    if (!(at > begin(piece)) || !(at < kNextToApex * begin_)) return false;
    return place(piece, branch_at(piece, base_of(u), at), u, v, p, n);
  }
  template <typename S>
  bool place(Piece piece, const Branch& branch, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    if (piece == Piece::root) return on_root(branch, u, v, p, n);
    if (!is_flank(piece) && !is_fillet(piece)) return false;
    const std::size_t k = wall_of(piece);
    const BevelWall<S>& wall = walls<S>()[k];
    const FingerProfile<S>& mill = wall.cutter;
    switch (branch.profile) {
      case Branch::Profile::straight: return touched(wall, branch.straight_path[k], mill.straight(u), v, p, n);
      case Branch::Profile::flank: return touched(wall, branch.straight_path[k], mill.flank(u, true), v, p, n);
      case Branch::Profile::flank_on_line: return touched(wall, branch.straight_path[k], mill.flank(u, false), v, p, n);
      case Branch::Profile::arc: break;
    }
    using std::atan, std::sin, std::cos;
    const S grown = exp_of(u), rest = atan(S(S(flat_) + S(0.5 * turn_[k]) * (grown - S(1) / grown)));  // 90 deg - psi
    return touched(wall, branch.straight_path[k], mill.arc(S(cos(rest)), S(sin(rest))), v, p, n);
  }
  /// Those that hold somewhere in a box.
  [[nodiscard]] std::vector<Branch> branches(Piece piece, const Interval& u, const Interval& v) const;

  template <typename S>
  [[nodiscard]] S tip(const S& /*s*/) const {
    return S(h_a_);
  }
  [[nodiscard]] tooth_space::Outline outline() const;
  [[nodiscard]] tooth_space::Borders borders(Piece piece) const;
  [[nodiscard]] tooth_space::Borders active(Piece flank) const;
  [[nodiscard]] Vec2 about_tip(int side, double s) const;
  [[nodiscard]] double v_at(Piece piece, double u, double s) const;
  [[nodiscard]] Vec2 longest_step(Piece piece) const;

  [[nodiscard]] const BevelWall<double>& wall(int side) const { return walls<double>()[side > 0 ? 0 : 1]; }
  /// beta at v, where the path is not straight.
  [[nodiscard]] double beta_at(double v) const { return beta_of(1 - v / begin_); }
  /// Smallest turn tan(beta_c) rho_A / (R_c tan(delta)) of the mill's path over the half, of either wall: where it is 0
  /// the path runs along the generatrix.
  [[nodiscard]] double least_turn() const { return least_turn_; }
  static constexpr double kLeastTurn = 1e-4;  ///< below it fillets do not end on the root itself

 private:
  static constexpr double kBeyond = 0.02;      // of R_0
  static constexpr double kNextToApex = 1e-3;  // of R_0: the trace winds without end
  using D2 = Dual<double, 2>;
  template <typename S>
  using Pair = std::array<BevelWall<S>, 2>;

  static double exp_of(double x) { return std::exp(x); }
  static Interval exp_of(const Interval& x) { return Interval::outwards(std::exp(x.low), std::exp(x.high), 4); }
  template <typename S, int N>
  static Dual<S, N> exp_of(const Dual<S, N>& x) {
    const S e = exp_of(x.v);
    return x.chain(e, e);
  }

  template <typename S>
  [[nodiscard]] const Pair<S>& walls() const {
    return std::get<Pair<S>>(walls_);
  }
  static std::size_t wall_of(Piece piece) { return piece == Piece::flank_plus || piece == Piece::fillet_plus ? 0 : 1; }
  [[nodiscard]] Branch branch_at(Piece piece, double u, double v) const;
  /// v at which a piece has no place any more. Straight paths go on; the others turn about the end of the trace.
  [[nodiscard]] double begin(Piece piece) const {
    const bool goes_on = piece == Piece::root ? flat_ > 0 : walls<double>()[wall_of(piece)].eps() > 0;
    return goes_on ? -INFINITY : (1 + kBeyond) * begin_;
  }

  template <typename S>
  static CutterCentre<S> centre(const BevelWall<S>& wall, bool straight, const S& v) {
    const BevelTrace<S>& t = wall.trace;
    if (!straight) return t.curved_centre(wall.sigma, beta_of(S(v / t.R_0 + S(1))));
    // As fast as the path is where it becomes straight: a turn in v alone.
    const S speed = t.speed_ratio(wall.sigma, t.beta_end) * speed_of(t.beta_end);
    return t.run_straight(t.curved_centre(wall.sigma, t.beta_end), S(-speed * (v - v_of(t, t.beta_end))));
  }
  static constexpr double kNear = 0.03;
  template <typename S>
  static S beta_of(const S& w) {
    using std::atan2, std::sqrt;
    constexpr double square = kNear * kNear;
    const S share = S(2.0) / (S(square) + sqrt(S(S(square * square) + S(4.0) * w * w))), sine = w * sqrt(share);
    return atan2(sine, sqrt(S(S(1) - w * w * share)));
  }
  /// Arc length of the trace for a step of -v.
  template <typename S>
  static S speed_of(const S& beta) {
    using std::sin, std::cos, std::sqrt;
    const S s = sin(beta), root = sqrt(S(s * s + S(kNear * kNear)));
    return S(2.0) * s * root / ((root * root + s * s) * cos(beta));
  }
  template <typename S>
  static S v_of(const BevelTrace<S>& t, const S& beta) {
    using std::sin, std::sqrt;
    const S s = sin(beta);
    return t.R_0 * (s * sqrt(S(s * s + S(kNear * kNear))) - S(1));
  }

  /// Where the mill touches the wall, in its frame, and the azimuth of that on the mill: BevelWall::point_at without
  /// angles.
  template <typename S>
  struct Contact {
    Vec3T<S> at;
    S cosine, sine;
  };
  template <typename S>
  static Contact<S> contact(const BevelWall<S>& wall, const ProfilePoint<S>& q, const CutterCentre<S>& c) {
    using std::sin, std::cos, std::sqrt;
    const S sd = wall.trace.sin_delta, cd = wall.trace.cos_delta, sigma(wall.sigma);
    S sg = sin(c.beta_c), cg = cos(c.beta_c);
    if (!(cd == S(0))) {
      const S d = c.R_c * sd * q.cos_psi;
      sg = sg * (d + cd * (q.x * q.cos_psi + q.rho * q.sin_psi));
      cg = cg * d;
      const S length = sqrt(S(sg * sg + cg * cg));
      sg = sg / length;
      cg = cg / length;
    }
    return {{q.x, S(-sigma * q.rho * cg), S(sigma * q.rho * sg)}, cg, sg};
  }
  template <typename S>
  static bool touched(const BevelWall<S>& wall, bool straight, const ProfilePoint<S>& q, const S& v, Vec3T<S>& p,
                      Vec3T<S>& n) {
    using std::sin, std::cos;
    const S sd = wall.trace.sin_delta, cd = wall.trace.cos_delta, sigma(wall.sigma);
    const CutterCentre<S> c = centre(wall, straight, v);
    const auto& [at, cg, sg] = contact(wall, q, c);
    p = blank_from_cutter<S>(at[0], at[1], at[2], c.R_c, c.e, sd, cd);
    const S nx = q.sin_psi, ny = sigma * q.cos_psi * cg, nz = -sigma * q.cos_psi * sg;
    const S m = nx * cd + nz * sd, ce = cos(c.e), se = sin(c.e);
    n = {S(m * ce - ny * se), S(m * se + ny * ce), S(nz * cd - nx * sd)};
    return true;
  }
  template <typename S>
  bool on_root(const Branch& branch, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const {
    using std::sin, std::cos;
    const Pair<S>& both = walls<S>();
    const S sd = both[0].trace.sin_delta, cd = both[0].trace.cos_delta;
    std::array<S, 2> azimuth, cone;
    for (std::size_t k = 0; k < 2; ++k) {
      using std::atan2, std::sqrt;
      const double length = std::sqrt(1 + flat_ * flat_);
      // Beyond the end of the trace the other edge stands still: it has no part in what the root has there.
      const bool ended = both[k].eps() < 0 && !(base_of(v) > begin_);
      const CutterCentre<S> c = centre(both[k], branch.straight_path[k], ended ? S(begin_) : v);
      const Vec3T<S> q = contact(both[k], both[k].cutter.arc(S(1 / length), S(flat_ / length)), c).at;
      const S x = q[0] * cd + (q[2] + c.R_c) * sd, r = sqrt(S(x * x + q[1] * q[1]));
      azimuth[k] = c.e + atan2(q[1], x);
      cone[k] = r * sd + ((q[2] + c.R_c) * cd - q[0] * sd) * cd;
    }
    const S at = azimuth[0] + u * (azimuth[1] - azimuth[0]), ell = cone[0] + u * (cone[1] - cone[0]), ca = cos(at),
            sa = sin(at), h = -both[0].cutter.h_f;
    p = blank_from_cutter<S>(h, S(0), S(0), ell, at, sd, cd);
    n = {S(cd * ca), S(cd * sa), S(-sd)};
    return true;
  }

  std::tuple<Pair<double>, Pair<D2>, Pair<tooth_space::BoxSecond>> walls_;
  double h_a_ = 0;
  int teeth_ = 0;
  double ell_from_ = 0, ell_to_ = 0;
  double least_turn_ = 0;
  double begin_ = 0;  ///< -R_0
  double flat_ = 0;   ///< cot(psi) where fillets end; above 0 where the path runs along the generatrix somewhere
  std::array<double, 2> turn_{};        ///< w_0 of the fillets of L, U
  std::array<double, 2> fillet_end_{};  ///< u at B
};

}  // namespace toothpath::bevel_gear
