// A whole tooth space from one kernel, which says where a place lies and is written once for any scalar: dual numbers
// give derivatives, intervals of them enclosures, 50 digits the reference.
//
// A kernel has
//   template <class S> bool place(Piece, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const;  false: no place
//   template <class S> S tip(const S& s) const;        h of the tip surface
//   Outline outline() const;  Borders borders(Piece) const;  Borders active(Piece) const;
//   Vec2 about_tip(int side, double s) const;          (u, v) near the tip edge: where Newton begins
//   double v_at(Piece, double u, double s) const;      v near s
//   Vec2 longest_step(Piece) const;                    of u and v in a search
// and, where a piece is made of formulas that meet with another bend,
//   auto branches(Piece, const Interval& u, const Interval& v) const;   those that hold somewhere in a box
//   template <class S> bool place(Piece, branch, u, v, p, n) const;     by one of them
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "geometry/base/angle.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

template <typename Kernel>
class KernelSpace final : public ToothSpace {
 public:
  explicit KernelSpace(Kernel kernel) : kernel_(std::move(kernel)), outline_(kernel_.outline()) {}
  [[nodiscard]] const Kernel& kernel() const { return kernel_; }

  [[nodiscard]] const Outline& outline() const override { return outline_; }
  [[nodiscard]] double tip(double s) const override { return kernel_.template tip<double>(s); }
  [[nodiscard]] CurveBend tip_bend(double s_from, double s_to) const override {
    const BoxSecond h = kernel_.template tip<BoxSecond>(box_variable(Interval(s_from, s_to), 1, 0));
    return {h.v.d[0], h.d[0].d[0]};
  }
  [[nodiscard]] Borders borders(Piece piece) const override { return kernel_.borders(piece); }
  [[nodiscard]] Borders active(Piece flank) const override { return kernel_.active(flank); }

  [[nodiscard]] std::optional<PatchPoint> at(Piece piece, double u, double v) const override {
    using D = Dual<double, 2>;
    Vec3T<D> p, n;
    if (!kernel_.template place<D>(piece, D::variable(u, 0), D::variable(v, 1), p, n)) return {};
    return PatchPoint{value(p), value(n), derivative(p, 0), derivative(p, 1), derivative(n, 0), derivative(n, 1)};
  }
  [[nodiscard]] std::optional<PatchPoint> point(Piece piece, double u, double v) const override {
    PatchPoint q;
    if (!kernel_.template place<double>(piece, u, v, q.p, q.n)) return {};
    return q;
  }
  [[nodiscard]] std::optional<PatchFoot> foot(Piece piece, const Vec3& c, double u, double v) const override {
    constexpr int kSteps = 30;
    PatchFoot f{u, v, 0, {}};
    double before = INFINITY;
    for (int k = 0; k < kSteps; ++k) {
      const auto q = at(piece, f.u, f.v);
      if (!q) return {};
      if (k == 0) f.distance = (c - q->p).dot(q->n);
      const Vec3 lack = c - q->p - q->n * f.distance;
      const double error = lack.norm();
      f.at = *q;
      if (error < 2e-13 * (1 + c.norm()) || (error < 1e-11 && error >= 0.5 * before)) {
        f.distance = (c - q->p).dot(q->n);
        return f;
      }
      before = error;
      Mat3 J;
      J << q->pu + q->nu * f.distance, q->pv + q->nv * f.distance, q->n;
      Vec3 step = J.inverse() * lack;
      if (!step.allFinite()) return {};
      const Vec2 most = kernel_.longest_step(piece);
      step /= std::max({1.0, std::abs(step[0]) / most[0], std::abs(step[1]) / most[1]});
      f.u += step[0];
      f.v += step[1];
      f.distance += step[2];
    }
    return {};
  }
  [[nodiscard]] std::optional<EdgePlace> tip_edge(int side, double s,
                                                  const std::optional<EdgePlace>& near = {}) const override {
    std::optional<EdgePlace> found;
    if (near) found = edge_from(side, s, Vec2(near->u, near->v));
    if (!found) found = edge_from(side, s, kernel_.about_tip(side, s));
    if (found && near) found->azimuth = near->azimuth + std::remainder(found->azimuth - near->azimuth, kTwoPi);
    return found;
  }
  [[nodiscard]] std::optional<double> start_v(Piece piece, double u, double s, double, const std::optional<Near>& near,
                                              int attempt) const override {
    const double plain = kernel_.v_at(piece, u, s);
    if (attempt == 0 && near) return near->v + plain - kernel_.v_at(piece, u, near->s);
    return attempt == 1 ? std::optional(plain) : std::nullopt;
  }
  [[nodiscard]] double longest_step(Piece piece, double) const override { return kernel_.longest_step(piece)[1]; }

  [[nodiscard]] std::optional<Jet> enclosure(Piece piece, const PatchFrame& frame, double half_a,
                                             double half_b) const override {
    const BoxParameters box(frame, half_a, half_b);
    Vec3T<BoxSecond> p, n;
    if constexpr (requires { kernel_.branches(piece, box.u.v.v, box.v.v.v); }) {
      std::optional<Jet> all;
      for (const auto& branch : kernel_.branches(piece, box.u.v.v, box.v.v.v)) {
        if (!kernel_.template place<BoxSecond>(piece, branch, box.u, box.v, p, n)) return {};
        Jet jet;
        jet.add(p);
        all = all ? hull_of(*all, jet) : jet;
      }
      return all;
    } else {
      if (!kernel_.template place<BoxSecond>(piece, box.u, box.v, p, n)) return {};
      Jet jet;
      jet.add(p);
      return jet;
    }
  }

 private:
  /// By Newton from (u, v); the azimuth is not unwrapped.
  [[nodiscard]] std::optional<EdgePlace> edge_from(int side, double s, Vec2 x) const {
    constexpr int kSteps = 30;
    for (int k = 0; k < kSteps; ++k) {
      const auto q = at(flank_of(side), x[0], x[1]);
      if (!q) return {};
      const Chart& c = outline_.chart;
      const double lack_s = s - c.along(q->p), lack_h = tip(s) - c.up(q->p);
      if (std::abs(lack_s) + std::abs(lack_h) < 1e-12 * q->p.norm()) {
        // Of the flank's own tooth: the minus flank of the space belongs to the next one.
        const double own = azimuth(turned(q->p, side > 0 ? 0.0 : -outline_.pitch));
        return EdgePlace{x[0], x[1], own};
      }
      const double su = c.along(q->p, q->pu), sv = c.along(q->p, q->pv), hu = c.up(q->p, q->pu), hv = c.up(q->p, q->pv),
                   det = su * hv - sv * hu;
      if (det == 0) return {};
      x += Vec2(lack_s * hv - sv * lack_h, su * lack_h - lack_s * hu) / det;
    }
    return {};
  }
  static Jet hull_of(Jet a, const Jet& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      a.place[k] = hull(a.place[k], b.place[k]);
      for (std::size_t n = 0; n < 2; ++n) a.first[n][k] = hull(a.first[n][k], b.first[n][k]);
      for (std::size_t n = 0; n < 3; ++n) a.second[n][k] = hull(a.second[n][k], b.second[n][k]);
    }
    return a;
  }

  Kernel kernel_;
  Outline outline_;
};

}  // namespace toothpath::tooth_space
