// A whole tooth space from one kernel, which says where a place lies and is written once for any scalar: dual numbers
// give derivatives, intervals of them enclosures, 50 digits the reference.
//
// A kernel has
//   template <class S> bool place(Piece, const S& u, const S& v, Vec3T<S>& p, Vec3T<S>& n) const;  false: no place;
//                                                      n over boxes, too: modified flanks are moved along it
//   template <class S> S tip(const S& s) const;        h of the tip surface
//   Outline outline() const;  Borders borders(Piece) const;  Borders active(Piece) const;
//   Vec2 about_tip(int side, double s) const;          (u, v) near the tip edge: where Newton begins
//   double v_at(Piece, double u, double s) const;      v near s
//   Vec2 longest_step(Piece) const;                    of u and v in a search
// and, where a piece is made of formulas that meet with another bend,
//   auto branches(Piece, const Interval& u, const Interval& v) const;   those that hold somewhere in a box
//   template <class S> bool place(Piece, branch, u, v, p, n) const;     by one of them
// and, where a normal costs much,
//   template <class S> bool place_alone(Piece, u, v, p) const;          without it: what enclosures ask for
#pragma once

#include <utility>

#include "geometry/tooth_space/exact_space.h"

namespace toothpath::tooth_space {

template <typename Kernel>
concept Branched = requires(const Kernel& kernel, Piece piece, Interval box) {
  kernel.branches(piece, box, box);
};

template <typename Kernel>
class KernelSpace final : public ExactSpace {
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
    return search_foot(*this, piece, c, u, v, kernel_.longest_step(piece));
  }
  [[nodiscard]] std::optional<EdgePlace> tip_edge(int side, double s,
                                                  const std::optional<EdgePlace>& near = {}) const override {
    std::optional<EdgePlace> found;
    if (near) found = search_tip_edge(*this, side, s, Vec2(near->u, near->v), near);
    return found ? found : search_tip_edge(*this, side, s, kernel_.about_tip(side, s), near);
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
    if constexpr (Branched<Kernel>) {
      std::optional<Jet> all;
      for (const auto& branch : kernel_.branches(piece, box.u.v.v, box.v.v.v)) {
        if (!kernel_.template place<BoxSecond>(piece, branch, box.u, box.v, p, n)) return {};
        Jet jet;
        jet.add(p);
        all = all ? hull_of(*all, jet) : jet;
      }
      return all;
    } else {
      bool found = false;
      if constexpr (requires { kernel_.place_alone(piece, box.u, box.v, p); })
        found = kernel_.place_alone(piece, box.u, box.v, p);
      else found = kernel_.template place<BoxSecond>(piece, box.u, box.v, p, n);
      if (!found) return {};
      Jet jet;
      jet.add(p);
      return jet;
    }
  }

  [[nodiscard]] std::optional<Skin<Second>> second(Piece piece, double u, double v) const override {
    return skin<Second>(piece, second_variable(u, 0), second_variable(v, 1));
  }
  [[nodiscard]] std::optional<Skin<BoxSecond>> boxed(Piece piece, const PatchFrame& frame, double half_a,
                                                     double half_b) const override {
    const BoxParameters box(frame, half_a, half_b);
    return skin<BoxSecond>(piece, box.u, box.v);
  }
  [[nodiscard]] Vec2 longest_steps(Piece piece) const override { return kernel_.longest_step(piece); }

 private:
  /// Nothing where formulas meet with another bend: flanks moved along such normals would have a kink there.
  template <typename S>
  [[nodiscard]] std::optional<Skin<S>> skin(Piece piece, const S& u, const S& v) const {
    if constexpr (Branched<Kernel>) {
      return {};
    } else {
      using std::sqrt;
      Skin<S> at;
      if (!kernel_.template place<S>(piece, u, v, at.p, at.n)) return {};
      const Chart& c = outline_.chart;
      const S r = sqrt(S(at.p[0] * at.p[0] + at.p[1] * at.p[1]));
      at.along = S(c.cosine) * r - S(c.sine) * at.p[2];
      at.depth = kernel_.template tip<S>(at.along) - (S(c.sine) * r + S(c.cosine) * at.p[2]);
      return at;
    }
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
