// Modified walls of bevel gears: the exact wall against 50 digits and a mill built from the words of
// docs/modifications.md, the swept solid, what the words say against what is gone, and what is refused.
#include "geometry/bevel_gear/modified_walls.h"

#include <boost/multiprecision/eigen.hpp>
#include <random>

#include "geometry/bevel_gear/convex_corner.h"
#include "geometry/contact/bevel_contact.h"
#include "geometry/modification/separate.h"
#include "tests/geometry/bevel_gear/samples.h"
#include "tests/support/brute_force_bevel_gear.h"
#include "tests/support/fifty_digits.h"
#include "tests/support/modified_flank.h"

namespace toothpath {
namespace {

using namespace bevel_test;
using modification::Kind;
using modification::Law;
using modification::Modification;
using test::F50;

Modification only(Modification m, modification::Flanks flank, std::optional<int> zone = {}) {
  m.flanks = flank;
  m.zone = zone;
  return m;
}

/// Every kind that a finger mill makes.
std::vector<Modification> all_kinds() {
  auto linear = test::modification_of(Kind::tip_relief, 0.02, 1.8, Law::linear);
  linear.transition_mm = 0.6;
  auto end = test::modification_of(Kind::end_relief, 0.015, 3);
  end.ends = modification::Ends::outer;
  return {linear,
          test::modification_of(Kind::root_relief, 0.01, 1.5),
          test::modification_of(Kind::profile_crowning, 0.005),
          test::modification_of(Kind::pressure_angle_slope, -0.006),
          test::modification_of(Kind::lead_crowning, 0.012),
          only(end, modification::Flanks::right),
          only(test::modification_of(Kind::helix_angle_slope, 0.008), modification::Flanks::left)};
}

bevel_gear::BevelGearParameters with(bevel_gear::BevelGearParameters p, std::vector<Modification> modifications) {
  p.modifications = std::move(modifications);
  return p;
}

bool is_lead(Kind kind) {
  return kind == Kind::end_relief || kind == Kind::lead_crowning || kind == Kind::helix_angle_slope;
}

/// The wall from definitions alone, in 50 digits: the involute of the base circle moved along its normals by the words,
/// turned about the axis of a mill whose centre goes beside the trace by r_0 less the words; the contact is sought
/// where the velocity, by differences, is square to the normal.
class WallByTheWords {
 public:
  WallByTheWords(const bevel_gear::BevelGear& g, std::size_t half, int sigma) : g_(g), half_(half), sigma_(sigma) {
    using std::atan2, std::sin, std::cos;
    const auto& p = g.parameters();
    h_ = g.halves()[half].hand;
    sd_ = F50(g.sin_delta()), cd_ = F50(g.cos_delta()), R_0_ = F50(g.R_0()), alpha_ = F50(p.pressure_angle_rad);
    r_0_ = atan2(F50(0), F50(-1)) / 4 * F50(g.cutter_data().module_mm);
    r_v_ = 1 / F50(g.kappa_v());
    e_h_ = F50(g.e_h());
    beta_ref_ = F50(g.halves()[half].walls[0].trace.beta_ref);
  }

  /// Point of the envelope; `side` of the normal as the program's.
  [[nodiscard]] Vec3T<F50> point(const F50& beta, const F50& p) const {
    const F50 h("1e-15");
    const auto q = profile(p), a = profile(p - h), b = profile(p + h);
    const F50 dx = b[0] - a[0], dr = b[1] - a[1], length = sqrt(F50(dx * dx + dr * dr));
    const F50 n_x = -dr / length, n_rho = dx / length;
    const auto here = centre(beta), before = centre(beta - h), after = centre(beta + h);
    const auto in_blank = [&](const std::array<F50, 2>& c, const Vec3T<F50>& k) { return placed(c, k); };
    const auto off = [&](const F50& gamma) {
      const F50 y = -sigma_ * cos(gamma), z = sigma_ * sin(gamma);
      const Vec3T<F50> k(q[0], F50(q[1] * y), F50(q[1] * z)),
          m(F50(q[0] + n_x), F50((q[1] + n_rho) * y), F50((q[1] + n_rho) * z));
      const Vec3T<F50> normal = in_blank(here, m) - in_blank(here, k);
      return F50((in_blank(after, k) - in_blank(before, k)).dot(normal) / (2 * h));
    };
    F50 gamma = F50(h_) * beta, last = gamma + F50("1e-3"), f_last = off(last);
    for (int k = 0; k < 60; ++k) {  // secant
      const F50 f = off(gamma);
      if (abs(F50(gamma - last)) < F50("1e-38") || f == f_last) break;
      const F50 next = gamma - f * (gamma - last) / (f - f_last);
      last = gamma, f_last = f, gamma = next;
    }
    return placed(here, {q[0], F50(-sigma_ * q[1] * cos(gamma)), F50(sigma_ * q[1] * sin(gamma))});
  }

 private:
  [[nodiscard]] std::array<F50, 2> profile(const F50& p) const {
    const auto plain = [&](const F50& at) -> std::array<F50, 4> {  // x, rho, normal
      const auto& c = g_.cutter();
      const F50 C(c.plain_p_C);
      // The involute from its base circle: tangent length t = r_v sin(alpha) + p cos(alpha), turned by t/r_b.
      const auto involute = [&](const F50& s) -> std::array<F50, 4> {
        const F50 r_b = r_v_ * cos(alpha_), t = r_v_ * sin(alpha_) + s * cos(alpha_),
                  turn = r_0_ / r_v_ - (tan(alpha_) - alpha_) + t / r_b;
        return {F50(r_b * cos(turn) + t * sin(turn) - r_v_), F50(r_b * sin(turn) - t * cos(turn)), F50(-sin(turn)),
                F50(cos(turn))};
      };
      if (at >= C) return involute(at);
      const auto q = involute(C);
      return {F50(q[0] + (at - C) * q[3]), F50(q[1] - (at - C) * q[2]), q[2], q[3]};
    };
    const auto q = plain(p);
    const double h_a = g_.parameters().addendum_mm;
    F50 taken(0);
    for (const auto& m : g_.parameters().modifications)
      if (!is_lead(m.kind)) taken += test::taken_by_the_words<F50>(m, F50(h_a) - q[0], F50(0), 2 * h_a, 0, 1);
    return {F50(q[0] + taken * q[2]), F50(q[1] + taken * q[3])};
  }
  /// (R_c, e)
  [[nodiscard]] std::array<F50, 2> centre(const F50& beta) const {
    const auto& p = g_.parameters();
    const F50 R = R_0_ * cos(beta) * cos(beta);
    const bool herringbone = g_.herringbone();
    const double w = herringbone ? p.relief_half_width_mm : 0;
    const double from = half_ == 1 ? g_.R_ref() + w : g_.R_i(),
                 to = herringbone && half_ == 0 ? g_.R_ref() - w : g_.R_e();
    F50 d = r_0_;
    for (const auto& m : p.modifications)
      if (is_lead(m.kind) && m.meets(-sigma_, int(half_)))
        d -= test::taken_by_the_words<F50>(m, F50(0), R, 2 * p.addendum_mm, from, to) / cos(F50(alpha_ + r_0_ / r_v_));
    const F50 theta = 2 * h_ * ((tan(beta_ref_) - beta_ref_) - (tan(beta) - beta));
    // Left normal of the tangent (cos beta, h sin beta) against the ray.
    const F50 u = R - sigma_ * d * h_ * sin(beta), v = sigma_ * d * cos(beta);
    return {sqrt(F50(u * u + v * v)), F50((theta + atan2(v, u)) / sd_ - sigma_ * e_h_)};
  }
  [[nodiscard]] Vec3T<F50> placed(const std::array<F50, 2>& c, const Vec3T<F50>& k) const {
    const F50 q = k[0] * cd_ + (k[2] + c[0]) * sd_, ce = cos(c[1]), se = sin(c[1]);
    return {F50(q * ce - k[1] * se), F50(q * se + k[1] * ce), F50((k[2] + c[0]) * cd_ - k[0] * sd_)};
  }

  const bevel_gear::BevelGear& g_;
  std::size_t half_;
  int sigma_, h_ = 1;
  F50 sd_, cd_, R_0_, alpha_, r_0_, r_v_, e_h_, beta_ref_;
};

Vec3 near(const Vec3T<F50>& v) { return {double(v[0]), double(v[1]), double(v[2])}; }

TEST(ModifiedWalls, PointNormalAndCurvatureMatchFiftyDigits) {
  double point = 0, normal = 0, bend = 0, moved = 0;
  for (const auto& parameters : {w1(), w3(), w4()}) {
    const auto g = made(with(parameters, all_kinds()), parameters.teeth == 37 ? wheel_mill() : pinion_mill());
    const auto plain = made(parameters, g.cutter_data());
    for (std::size_t half = 0; half < g.halves().size(); ++half)
      for (int k = 0; k < 2; ++k) {
        const auto& wall = g.halves()[half].walls[k];
        const WallByTheWords exact(g, half, wall.sigma);
        for (int n = 0; n < 4; ++n)
          for (int r = 0; r < 5; ++r) {
            // Off the places where pieces of laws meet: there curvatures jump.
            const double from = g.halves()[half].beta_from[k], to = g.halves()[half].beta_to[k],
                         beta = from + (to - from) * (n + 0.437) / 4,
                         p = wall.cutter.p_C + (wall.cutter.p_D - wall.cutter.p_C) * (r + 0.391) / 5;
            const auto f = wall.point(beta, p);
            const F50 h("1e-9"), b(beta), q(p);
            const auto at = [&](int i, int j) { return exact.point(F50(b + i * h), F50(q + j * h)); };
            const Vec3T<F50> x = at(0, 0), u0 = at(-1, 0), u1 = at(1, 0), v0 = at(0, -1), v1 = at(0, 1);
            point = std::max(point, (near(x) - f.p).norm());
            moved = std::max(moved, (plain.halves()[half].walls[k].point(beta, p).p - f.p).norm());
            Vec3T<F50> N = Vec3T<F50>(u1 - u0).cross(Vec3T<F50>(v1 - v0));
            N = N / sqrt(F50(N.squaredNorm()));
            if (near(N).dot(f.n) < 0) N = -N;
            normal = std::max(normal, (near(N) - f.n).norm());
            // Principal curvatures: eigenvalues of the second form over the first, positive where hollow.
            const Vec3T<F50> pu = (u1 - u0) / (2 * h), pv = (v1 - v0) / (2 * h),
                             puv = (at(1, 1) - at(1, -1) - at(-1, 1) + at(-1, -1)) / (4 * h * h);
            const F50 E = pu.squaredNorm(), G = pv.squaredNorm(), F = pu.dot(pv),
                      L = Vec3T<F50>(u1 - 2 * x + u0).dot(N) / (h * h), M = puv.dot(N),
                      K = Vec3T<F50>(v1 - 2 * x + v0).dot(N) / (h * h), D = E * G - F * F;
            const F50 mean = (E * K - 2 * F * M + G * L) / (2 * D), gauss = (L * K - M * M) / D,
                      root = sqrt(F50(abs(F50(mean * mean - gauss))));
            const auto c = bevel_gear::bevel_curvature(wall, beta, p);
            ASSERT_TRUE(std::isfinite(c.kappa_1) && std::isfinite(c.kappa_2) && std::isfinite(double(root)));
            bend = std::max(
                {bend, std::abs(c.kappa_1 - double(F50(mean + root))), std::abs(c.kappa_2 - double(F50(mean - root)))});
            EXPECT_LT(c.asymmetry, 1e-12);
          }
      }
  }
  std::printf("  modified walls: point %.1e mm, normal %.1e, curvature %.1e 1/mm; %.1f um from the plain ones\n", point,
              normal, bend, 1e3 * moved);
  EXPECT_LE(point, 1e-9);
  EXPECT_LE(normal, 1e-9);
  EXPECT_LE(bend, 1e-9);
  EXPECT_GT(moved, 0.02);
}

/// Distance of the modified wall from the plain one along its normal, at a place of the plain one.
double gone(const bevel_gear::BevelGear& plain, const bevel_gear::BevelGear& modified, std::size_t half, int k,
            double ell, double height) {
  const auto& own = plain.halves()[half].walls[k];
  const auto &a = bevel_gear::bevel_inverse(own, ell, height),
             &b = bevel_gear::bevel_inverse(modified.halves()[half].walls[k], ell, height);
  EXPECT_TRUE(a && b) << ell << " " << height;
  if (!a || !b) return 0;
  const auto f = own.point(a->beta, a->p);
  const Vec3 there = bevel_gear::blank_point(ell, height, b->azimuth, plain.sin_delta(), plain.cos_delta());
  return -(there - f.p).dot(f.n);
}

TEST(ModifiedWalls, WhatIsGoneIsWhatTheWordsSay) {
  const auto plain = made(w3(), pinion_mill());
  for (const auto& m : all_kinds()) {
    const auto g = made(with(w3(), {m}), pinion_mill());
    double off = 0, most = 0;
    for (std::size_t half = 0; half < 2; ++half)
      for (int k = 0; k < 2; ++k) {
        const auto& face = plain.halves()[half];
        const auto on = bevel_gear::rectangle_of(plain.parameters(), face.ell_from, face.ell_to);
        for (const double share : {0.1, 0.5, 0.93})
          for (const double height : {-3.5, -1.0, 0.0, 3.9}) {
            if (is_lead(m.kind) && height != 0) continue;
            const double ell = face.ell_from + share * on.face();
            const auto& wall = plain.halves()[half].walls[k];
            const auto at = bevel_gear::bevel_inverse(wall, ell, height);
            ASSERT_TRUE(at);
            // Counted on the mill and on the trace: at the contact of the plain wall.
            const double y = plain.parameters().addendum_mm - wall.cutter.at(at->p).x, R = wall.trace.R(at->beta);
            const double words = m.meets(-wall.sigma, int(half))
                                     ? test::taken_by_the_words<double>(m, y, R, on.depth_mm, on.from_mm, on.to_mm)
                                     : 0;
            off = std::max(off, std::abs(gone(plain, g, half, k, ell, height) - words));
            most = std::max(most, words);
          }
      }
    std::printf("  %s: up to %.1f um are gone, %.3f um beside the words\n", to_string(m.kind), 1e3 * most, 1e3 * off);
    EXPECT_GT(most, 0.003);
    EXPECT_LT(off, 0.02 * most + 1e-5);
  }
}

/// The solid mill of the words, moved along the paths of the words, leaves these walls and nothing else.
TEST(ModifiedWalls, TheSweptMillOfTheWordsLeavesThem) {
  for (const auto& parameters : {with(w1(), all_kinds()), with(w3(), all_kinds())}) {
    const auto g = made(parameters, pinion_mill());
    const test::FingerMill mill{3.0, 0.9, 4.1, 4.8};
    const test::BruteForceBevelGear judge(parameters, mill);
    auto without = parameters;
    without.modifications.clear();
    const test::BruteForceBevelGear plain_judge(without, mill);
    std::mt19937_64 random(11);
    const auto between = [&](double a, double b) { return a + (b - a) * double(random() >> 11) * 0x1p-53; };
    double off = 0, seen = 0;
    for (std::size_t half = 0; half < g.halves().size(); ++half)
      for (int k = 0; k < 2; ++k)
        for (int n = 0; n < 12; ++n) {
          const auto& face = g.halves()[half];
          const double ell = between(face.ell_from, face.ell_to), height = between(-4.6, 4.1);
          const auto& wall = face.walls[k];
          const auto at = bevel_gear::bevel_inverse(wall, ell, height);
          ASSERT_TRUE(at) << ell << " " << height;
          const Vec3 p = wall.point(at->beta, at->p).p;
          off = std::max(off, std::abs(judge.clearance(p)));
          seen = std::max(seen, plain_judge.clearance(p));
        }
    std::printf("  swept mill: %.1e mm beside the wall; the plain one would leave %.1f um\n", off, 1e3 * seen);
    EXPECT_LT(off, 1e-7);  // the table of the judge's paths
    EXPECT_GT(seen, 0.02);
  }
}

TEST(ModifiedWalls, SolidAndProfileAreOne) {
  const auto g = made(with(w3(), all_kinds()), pinion_mill());
  const auto& c = g.cutter();
  const bevel_gear::FingerSolid solid(c);
  const test::PlainFingerMill plain({3.0, 0.9, 4.1, 4.8}, radians(20), 1 / g.kappa_v(), 5.1);
  double off = 0, grown = 0;
  for (int k = 1; k < 400; ++k) {
    const auto q = c.at(c.p_A + (c.p_D - c.p_A) * k / 400);
    off = std::max({off, std::abs(solid.signed_distance(q.x, q.rho)), std::abs(solid.radius(q.x) - q.rho)});
    for (const double d : {-0.02, 0.3})
      off = std::max(off, std::abs(solid.signed_distance(q.x - d * q.sin_psi, q.rho + d * q.cos_psi) - d));
    grown = std::max(grown, -plain.clearance(q.x, q.rho));
    EXPECT_GE(q.sin_psi, 0);
    EXPECT_LT(plain.clearance(q.x, q.rho), 0.05);
  }
  EXPECT_LT(off, 1e-9);
  const auto joints = bevel_gear::flank_joints(c);
  EXPECT_EQ(joints.front(), c.p_C);
  EXPECT_EQ(joints.back(), c.p_D);
  for (const double chord : {1e-3, 1e-5}) {
    const auto steps = bevel_gear::flank_steps(c, chord);
    double worst = 0;
    for (std::size_t k = 1; k < steps.size(); ++k) {
      const auto a = c.at(steps[k - 1]), b = c.at(steps[k]);
      for (const double t : {0.3, 0.5, 0.7}) {
        const auto q = c.at(steps[k - 1] + t * (steps[k] - steps[k - 1]));
        worst = std::max(worst, std::abs((q.x - a.x) * (b.rho - a.rho) - (q.rho - a.rho) * (b.x - a.x)) /
                                    std::hypot(b.x - a.x, b.rho - a.rho));
      }
    }
    EXPECT_LE(worst, chord);
    EXPECT_GT(worst, 0.1 * chord);
  }
}

TEST(ModifiedWalls, PathsMeetTheCornerOfTheHerringbone) {
  const auto g =
      made(with(w3(), {test::modification_of(Kind::helix_angle_slope, 0.02),
                       only(test::modification_of(Kind::lead_crowning, 0.01), modification::Flanks::both, 1)}),
           pinion_mill());
  const bevel_gear::ConvexCorner corner(g);
  EXPECT_FALSE(corner.plain());
  const int sigma = -g.corner().sigma;
  for (const bool outer : {false, true}) {
    const auto& half = g.halves()[outer ? 1 : 0];
    const auto& t = half.wall(sigma).trace;
    const auto end = t.centre(sigma, t.beta(g.R_ref())), arc = corner.at(outer ? 1 : 0);
    EXPECT_NEAR(end.R_c, arc.R_c, 1e-10);
    EXPECT_NEAR(end.theta_c, arc.theta_c, 1e-12);
  }
  for (const double t : {0.1, 0.5, 0.8}) {
    const auto c = corner.at(t);
    EXPECT_NEAR(corner.share_at(c.R_c), t, 1e-9);
    EXPECT_NEAR(corner.offset(c.R_c, c.theta_c), 0, 1e-10);
    const auto a = corner.at(t - 1e-6), b = corner.at(t + 1e-6);
    EXPECT_NEAR(std::atan2(c.R_c * (b.theta_c - a.theta_c), b.R_c - a.R_c), c.beta_c, 1e-7);
  }
}

TEST(ModifiedWalls, AmountsOfZeroAreThePlainGear) {
  const auto g = made(with(w3(), {test::modification_of(Kind::tip_relief, 0, 1), test::modification_of(Kind::twist, 0),
                                  test::modification_of(Kind::lead_crowning, 0),
                                  only(test::modification_of(Kind::profile_crowning, 0), modification::Flanks::left)}),
                      pinion_mill());
  EXPECT_FALSE(g.modified());
  EXPECT_EQ(g.cutter().law, nullptr);
  for (const auto& half : g.halves())
    for (const auto& wall : half.walls) EXPECT_TRUE(!wall.trace.lead[0] && !wall.trace.lead[1]);
}

/// A grid that is a sum is made by profile and path; any other is refused with what is left.
TEST(ModifiedWalls, GridsThatAreSumsAreMade) {
  modification::Grid grid;
  grid.depth_mm = {0, 2, 5, 8.2};
  grid.along_mm = {85, 95, 110, 125};
  for (const double row : {0.010, 0.002, 0.0, 0.006})
    for (const double column : {0.004, 0.0, 0.001, 0.009}) grid.removal_mm.push_back(row + column);
  auto m = test::modification_of(Kind::grid, 1);
  m.grid = grid;
  const auto plain = made(w1(), pinion_mill()), g = made(with(w1(), {m}), pinion_mill());
  const modification::Field field({m}, 1, 0, {8.2, 87, 123});
  double off = 0;
  for (int k = 0; k < 2; ++k)
    for (const double ell : {90.0, 104.0, 121.0}) {
      const auto& wall = plain.halves()[0].walls[k];
      const auto at = bevel_gear::bevel_inverse(wall, ell, 0);
      off = std::max(off, std::abs(gone(plain, g, 0, k, ell, 0) -
                                   field.removal(4.1 - wall.cutter.at(at->p).x, wall.trace.R(at->beta))));
    }
  EXPECT_LT(off, 1e-4);
  grid.removal_mm[5] += 0.002;
  m.grid = grid;
  const auto refused = bevel_gear::BevelGear::make(with(w1(), {m}), pinion_mill());
  ASSERT_TRUE(refused.refused());
  EXPECT_EQ(refused.refused()->front().key, "modification[0].file");
  EXPECT_NE(refused.refused()->front().diagnostic.message.find("0.001125 mm are left at depth 2.0000 mm, cone distance "
                                                               "95.0000 mm"),
            std::string::npos)
      << refused.refused()->front().diagnostic.message;
}

/// A pinion that takes c off stops by c later at every place of the wheel.
TEST(ModifiedWalls, TheContactRollsThem) {
  const auto plain = made(w3(), pinion_mill()), g = made(with(w3(), all_kinds()), pinion_mill()),
             wheel = made(w4(), wheel_mill());
  const auto before = contact::BevelPair::make(plain, wheel), after = contact::BevelPair::make(g, wheel);
  ASSERT_TRUE(before && after);
  double off = 0, most = 0;
  int places = 0;
  for (int half = 0; half < 2; ++half)
    for (const int sigma : {1, -1})
      for (const double share : {0.2, 0.5, 0.8})
        for (const double height : {-2.0, 0.0, 2.0}) {
          const auto& face = wheel.halves()[std::size_t(half)];
          const auto place =
              before->wheel_place(half, sigma, face.ell_from + share * (face.ell_to - face.ell_from), height);
          ASSERT_TRUE(place);
          bevel_gear::BevelInverse start_a, start_b;
          const auto a = before->turn_at(half, sigma, place->point, 0, start_a),
                     b = after->turn_at(half, sigma, place->point, 0, start_b);
          if (!a || !b) continue;
          const auto& wall = plain.halves()[std::size_t(half)].wall(sigma);
          const auto f = wall.point(start_a.beta, start_a.p);
          const double lever = std::abs(f.p.x() * f.n.y() - f.p.y() * f.n.x());
          const auto at = bevel_gear::cone_point(f.p, plain.sin_delta(), plain.cos_delta());
          const double c = gone(plain, g, std::size_t(half), sigma > 0 ? 0 : 1, at.ell, at.height);
          off = std::max(off, std::abs(sigma * (*b - *a) * lever - c));
          most = std::max(most, c);
          ++places;
        }
  std::printf("  contact: %d places, up to %.1f um later, %.3f um beside what is gone\n", places, 1e3 * most,
              1e3 * off);
  EXPECT_GT(places, 20);
  EXPECT_GT(most, 0.015);
  EXPECT_LT(off, 1e-5);
}

TEST(ModifiedWalls, WhatAFingerMillDoesNotMakeIsRefusedWithItsLimit) {
  const auto refusal = [](const Modification& m, const bevel_gear::BevelGearParameters& p, double rack_depth = 4.1) {
    auto mill = pinion_mill();
    mill.rack_depth_mm = rack_depth;
    auto gear = bevel_gear::BevelGear::make(with(p, {test::modification_of(Kind::lead_crowning, 0.01), m}), mill);
    return gear.refused() ? gear.refused()->front().key + ": " + gear.refused()->front().diagnostic.message
                          : std::string("accepted");
  };
  using modification::Flanks;
  const auto begins = [](const std::string& text, const std::string& with) {
    EXPECT_EQ(text.substr(0, with.size()), with) << text;
  };
  begins(refusal(test::modification_of(Kind::twist, 0.01), w1()),
         "modification[1].kind: twist of 0.01 mm changes along the face with the depth, the limit is 0");
  begins(refusal(only(test::modification_of(Kind::tip_relief, 0.01, 1), Flanks::left), w1()),
         "modification[1].flank: flank = \"left\", but tip_relief is made by the profile of the finger mill");
  begins(refusal(only(test::modification_of(Kind::profile_crowning, 0.01), Flanks::both, 1), w3()),
         "modification[1].zone: zone = 1, but profile_crowning is made by the profile of the finger mill");
  begins(refusal(only(test::modification_of(Kind::lead_crowning, 0.01), Flanks::both, 1), w1()),
         "modification[1].zone: zone = 1 is not below 1, the number of halves");
  begins(refusal(test::modification_of(Kind::tip_relief, 0.01, 9), w1()),
         "modification[1].length: length = 9 mm is not above 0 and at most 8.2 mm, the depth of the active flank");
  begins(refusal(test::modification_of(Kind::end_relief, 0.01, 16), w3()),
         "modification[1].length: length = 16 mm is not above 0");
  EXPECT_NE(
      refusal(test::modification_of(Kind::tip_relief, 0.2, 1), w1()).find("limit 0.1: a longer length or less amount"),
      std::string::npos);
  EXPECT_NE(refusal(test::modification_of(Kind::end_relief, 0.2, 1.5), w1()).find("turn wall L by"), std::string::npos);
  // Few teeth: the straight of the mill hardly leans outwards, and a deep rack begins on the base circle.
  const Designed few = design(7, 40, 4, 35, 0.2);
  const auto of_few = [&](const Modification& m, double rack_depth) {
    auto mill = few.c;
    mill.rack_depth_mm = rack_depth;
    auto gear = bevel_gear::BevelGear::make(with(few.p, {m}), mill);
    return gear.refused() ? gear.refused()->front().diagnostic.message : std::string("accepted");
  };
  const double rack = few.c.rack_depth_mm;
  EXPECT_NE(of_few(test::modification_of(Kind::root_relief, 0.05, 1), rack).find("lean inwards"), std::string::npos);
  EXPECT_EQ(of_few(test::modification_of(Kind::lead_crowning, 0.01), 1.5 * rack), "accepted");
  const auto deep = test::modification_of(Kind::pressure_angle_slope, -0.02);
  EXPECT_EQ(of_few(deep, 0.5 * rack), "accepted");
  EXPECT_NE(of_few(deep, 1.5 * rack).find("would fold"), std::string::npos) << of_few(deep, 1.5 * rack);
  // Added material narrows the space below the mill.
  modification::Grid grid;
  grid.depth_mm = {0, 4, 8.2};
  grid.along_mm = {85, 104, 125};
  grid.removal_mm.assign(9, -0.2);
  auto m = test::modification_of(Kind::grid, 1);
  m.grid = grid;
  EXPECT_NE(refusal(m, w1()).find("narrower than the mill"), std::string::npos) << refusal(m, w1());
}

}  // namespace
}  // namespace toothpath
