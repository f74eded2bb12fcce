// The kernels of line contact: against a sweep of the solid shaper, against differences in 50 digits, and by what a
// face gear's parallel surfaces, mirror images and scaled copies must give.
#include "cam/line/contact.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/eigen.hpp>

#include "geometry/base/dual.h"
#include "tests/cam/line/line_cases.h"
#include "tests/support/brute_force_face_gear.h"
#include "tests/support/brute_force_gear_solid.h"
#include "tests/support/fifty_digits.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using namespace line;

FaceFlank task_of(const WorkedPose& w) { return {made(w.gear), w.zone, w.side}; }
/// In the frame of tooth 0.
line::AxisLine<double> axis_of(const WorkedPose& w) { return {w.tip + w.r_0 * w.axis, w.axis}; }
/// In that of the space.
line::AxisLine<double> axis_of(const WorkedPose& w, const FaceFlank& f) {
  return {f.spaced(axis_of(w).c_0), f.spaced(w.axis)};
}
/// Near the foot of the middle of the worked axis.
Place start_of(const FaceFlank& f, const WorkedPose& w) { return f.place(w.r, w.z); }

class Worked : public testing::TestWithParam<WorkedPose> {};

TEST_P(Worked, AnchorAndLeans) {
  const auto& w = GetParam();
  const auto f = task_of(w);
  const auto at = face_gear::invert_flank(f.surface, w.side, w.r, w.z);
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->theta, w.theta, 1e-9);
  EXPECT_NEAR(at->B, w.B, 1e-9);
  EXPECT_NEAR(f.surface.flank_J(w.side, at->theta, at->B), w.J, 2e-6);
  const auto on = f.at_depth(w.r, f.z_tip - w.z);
  ASSERT_TRUE(on);
  EXPECT_NEAR(on->at.u, at->theta, 1e-13);
  EXPECT_NEAR(on->at.v, at->B, 1e-13);
  const auto shape = line::shape_at(f.frame(on->on), on->on);
  EXPECT_NEAR(degrees(*line::lean<double>(shape, 0)), w.lean_surface, 1e-6);
  EXPECT_NEAR(degrees(*line::lean<double>(shape, 0.5)), w.lean_half, 1e-6);
}

TEST_P(Worked, PoseGivesItsLeanAndItsGap) {
  const auto& w = GetParam();
  const auto f = task_of(w);
  const auto law = tapered(w.r_0);
  const auto at = face_gear::invert_flank(f.surface, w.side, w.r, w.z);
  const auto frame = line::tangent_frame<double>(w.side, f.surface.flank(w.side, at->theta, at->B).n, Vec3::UnitZ());
  EXPECT_NEAR(degrees(std::atan2(w.axis.dot(frame.o), w.axis.dot(frame.p))), w.lean, 1e-4);
  EXPECT_NEAR(degrees(std::asin(w.axis.dot(frame.n))) - 5, w.eps, 1e-4);
  const line::LineFit fit(f, law, line::strips_of(f, 1)[0]);
  const auto axis = axis_of(w, f);
  for (std::size_t k = 0; k < 5; ++k) {
    const auto q = fit.gap_at(axis, 0.25 * double(k) * w.length, start_of(f, w));
    ASSERT_TRUE(q);
    EXPECT_NEAR(1e3 * q->e, w.gap[k], 1.2e-4) << "at quarter " << k;
  }
}

// The pose (2.2) with the numbers of the worked axis gives that axis back.
TEST_P(Worked, AnglesMakeTheAxis) {
  const auto& w = GetParam();
  const auto f = task_of(w);
  const auto at = face_gear::invert_flank(f.surface, w.side, w.r, w.z);
  const auto on = f.surface.flank(w.side, at->theta, at->B);
  const auto frame = line::tangent_frame<double>(w.side, on.n, Vec3::UnitZ());
  const auto law = tapered(w.r_0);
  line::PoseAngles<double> pose;
  pose.psi = std::atan2(w.axis.dot(frame.o), w.axis.dot(frame.p));
  pose.eps = std::asin(w.axis.dot(frame.n)) - radians(5);
  const Vec3 c_0 = w.tip + w.r_0 * w.axis;
  pose.t_m = ((on.p - c_0) - (on.p - c_0).dot(frame.n) * frame.n).dot(w.axis) /
             (w.axis - w.axis.dot(frame.n) * frame.n).squaredNorm();
  pose.delta = (c_0 + pose.t_m * w.axis - on.p).dot(frame.n) - law.rho(pose.t_m);
  const auto back = line::axis_of<double>(on.p, frame, law, pose);
  EXPECT_LE((back.a - w.axis).norm(), 1e-11);
  EXPECT_LE((back.c_0 - c_0).norm(),
            2e-9);  // the axis point over the anchor lies on its normal but for the printed digits
  EXPECT_LE(std::abs(pose.delta), 2e-3);
}

// L1: the gap against the least distance of the ball's centre to a surface made by sweeping the shaper. Near the fillet
// line the sweep's measure is no distance (it is taken in the shaper's transverse plane, where the rounding of its tip
// has another slope than the involute beside it), so that feet within a tenth of a module of it are judged by the next
// test alone.
TEST_P(Worked, GapAgainstTheSweptShaper) {
  const auto& w = GetParam();
  const auto f = task_of(w);
  const BruteForceFaceGear brute(w.gear, w.gear.zones[std::size_t(w.zone)].helix_angle_rad);
  const line::LineFit fit(f, tapered(w.r_0), line::strips_of(f, 1)[0]);
  const auto axis = axis_of(w, f);
  int compared = 0;
  for (int k = 0; k <= 40; ++k) {
    const double t = w.length * k / 40;
    const auto q = fit.gap_at(axis, t, start_of(f, w));
    ASSERT_TRUE(q);
    const double to_fillet = (f.theta_end - q->at.u) * f.surface.shaper.r_b / f.surface.shaper.cos_bb;
    if (to_fillet < 0.1 * f.module_mm || q->depth < 0) continue;
    // Of a point in the space the sweep tells how deep the shaper passed over it.
    const double distance = -brute.least_clearance(f.own(axis.at(t))) * brute.cos_base_helix();
    EXPECT_NEAR(q->e, distance - fit.law().rho(t), 1e-7) << "t " << t;
    ++compared;
  }
  EXPECT_GE(compared, 36);
}

// The same against the nearest place of the whole solid, found by a pattern search: fillet, root, tip and ends
// included, up to the fillet line.
TEST_P(Worked, GapAgainstTheWholeSolid) {
  const auto& w = GetParam();
  const auto gear = made(w.gear);
  const auto f = task_of(w);
  const BruteForceGearSolid solid(gear, 24, 36);
  const line::LineFit fit(f, tapered(w.r_0), line::strips_of(f, 1)[0]);
  const auto axis = axis_of(w, f);
  for (const double t : {0.0, 0.01, 0.1, 0.25 * w.length, 0.6 * w.length, 0.97 * w.length}) {
    const auto q = fit.gap_at(axis, t, start_of(f, w));
    ASSERT_TRUE(q);
    ASSERT_LE(q->at.u, f.theta_end);
    EXPECT_NEAR(q->e, solid.nearest(f.own(axis.at(t))).distance - fit.law().rho(t), 1e-7) << "t " << t;
  }
}

// (3.4) against the optimised left that the independent program found.
TEST_P(Worked, EstimateOfWhatIsLeft) {
  const auto& w = GetParam();
  const auto f = task_of(w);
  const double third = third_along(f, axis_of(w, f), 0.5 * w.length, start_of(f, w));
  EXPECT_NEAR(1e3 * left_estimate(third, 0.5 * w.length), w.estimate, 0.01 * w.estimate);
}

INSTANTIATE_TEST_SUITE_P(Section11, Worked, testing::ValuesIn(worked_poses()),
                         [](const auto& i) { return i.param.name; });

/// A random place of a flank between the limits of a task, inside of its edges.
struct RandomPlace {
  face_gear::FlankParameters<double> at;
  double r, z;
};
RandomPlace random_place(const FaceFlank& f, Random& random) {
  for (;;) {
    const double r = random(f.s_from, f.s_to), z = random(f.z_end, f.z_tip);
    const auto at = face_gear::invert_flank(f.surface, f.side, r, z);
    if (at && at->J > 0 && at->theta < f.theta_end) return {{at->theta, at->B}, r, z};
  }
}

template <typename S>
Vec3T<S> cast(const Vec3& v) {
  return {S(v[0]), S(v[1]), S(v[2])};
}

TEST(LineContact, FrameIsOrthonormalAndPointsUpAndOutwards) {
  Random random(7);
  for (const auto& c : line_cases()) {
    const auto f = c.task();
    for (int k = 0; k < 50; ++k) {
      const auto q = random_place(f, random);
      const auto on = f.surface.flank(f.side, q.at.theta, q.at.B);
      const auto frame = line::tangent_frame<double>(f.side, on.n, Vec3::UnitZ());
      EXPECT_LE(std::abs(frame.p.dot(frame.o)) + std::abs(frame.p.dot(frame.n)) + std::abs(frame.o.dot(frame.n)),
                1e-15);
      EXPECT_NEAR(frame.p.norm(), 1, 1e-15);
      EXPECT_NEAR(frame.o.norm(), 1, 1e-15);
      EXPECT_GT(frame.p.z(), 0);
      EXPECT_GT(frame.o.dot(Vec3(on.p.x(), on.p.y(), 0)), 0);
    }
  }
}

// L2: along the lean of (3.3) at distance d the second difference of the distance is zero. Differences in 50 digits,
// step 1e-8.
TEST(LineContact, LeanIsTheZeroOfASecondDifference) {
  Random random(8);
  for (const auto& c : line_cases()) {
    const auto f = c.task();
    const auto surface = face_gear::make_surface<F50>(c.gear, c.gear.zones[std::size_t(c.zone)].helix_angle_rad);
    for (int k = 0; k < 6; ++k) {
      const auto q = random_place(f, random);
      const F50 distance = F50(c.r_0) * F50(random(1, 2));
      const face_gear::FlankParameters<F50> at{F50(q.at.theta), F50(q.at.B)};
      const auto psi = closed_lean<F50>(surface, c.side, at, distance);
      ASSERT_TRUE(psi);
      const auto on = surface.flank(c.side, at.theta, at.B);
      const auto frame = line::tangent_frame<F50>(c.side, on.n, Vec3T<F50>(F50(0), F50(0), F50(1)));
      const Vec3T<F50> x = on.p + on.n * distance;
      const face_gear::FlankParameters<F50> start{face_gear::theta_at_distance(surface, at.theta, distance), at.B};
      const auto second = [&](const F50& lean_angle) {
        const F50 h("1e-8");
        const Vec3T<F50> u = line::axis_direction<F50>(frame, lean_angle, F50(0));
        const auto d = [&](const F50& t) {
          return face_gear::flank_foot<F50>(surface, c.side, Vec3T<F50>(x + u * t), start)->d;
        };
        return F50((d(h) + d(-h) - F50(2) * d(F50(0))) / (h * h));
      };
      // A secant from nearby, so that the zero is found by the differences alone.
      F50 a = *psi - F50("1e-3"), b = *psi + F50("1e-3"), fa = second(a), fb = second(b);
      for (int n = 0; n < 8 && fb != fa; ++n) {
        const F50 next = b - fb * (b - a) / (fb - fa);
        a = b, fa = fb, b = next, fb = second(b);
        if (abs(b - a) < F50("1e-12")) break;
      }
      EXPECT_LT(double(abs(b - *psi)), 1e-10) << c.name;
      const auto in_space = f.space->at(f.piece(), q.at.theta, q.at.B);
      const auto in_double = line::lean<double>(line::shape_at(f.frame(*in_space), *in_space), double(distance));
      EXPECT_NEAR(*in_double, double(*psi), 1e-12) << c.name;
    }
  }
}

// The lean by first derivatives of place and normal against the closed form of the parallel surface, which is the flank
// at another theta.
TEST(LineContact, LeanAgainstTheClosedForm) {
  Random random(13);
  double worst = 0;
  int places = 0;
  for (const auto& c : line_cases()) {
    const auto f = c.task();
    for (int k = 0; k < 800; ++k) {
      const auto q = random_place(f, random);
      const double distance = random(0, 2) * c.r_0;
      const face_gear::FaceGearSurface<double>::FlankPlace on(f.surface, c.side, q.at.theta, q.at.B),
          parallel(f.surface, c.side, face_gear::theta_at_distance(f.surface, q.at.theta, distance), q.at.B);
      if (!(parallel.curvature().J > 0)) continue;
      const auto H = parallel.shape(parallel.curvature());
      const auto b = on.basis(on.turn());
      const auto frame = line::tangent_frame<double>(c.side, on.point(on.turn()).n, Vec3::UnitZ());
      const line::TangentShape<double> there(frame, b.e, b.l, b.e * H.ee + b.l * H.el, b.e * H.el + b.l * H.ll);
      const auto at = f.space->at(f.piece(), q.at.theta, q.at.B);
      const auto psi = line::lean<double>(line::shape_at(f.frame(*at), *at), distance);
      ASSERT_TRUE(psi);
      worst = std::max(worst, std::abs(*psi - *line::lean<double>(there, 0)));
      ++places;
    }
  }
  std::printf("lean off the closed form by %.1e rad at most, %d places\n", worst, places);
  EXPECT_GT(places, 9000);
  EXPECT_LT(worst, 1e-12);
}

// L3: at the surface itself the lean of distance rho has the normal curvature |K| rho (Cayley-Hamilton), not zero. 50
// digits and double.
template <typename S>
S relative_lack(const face_gear::FaceGearParameters& gear, int zone, int side, const face_gear::FlankParameters<S>& at,
                const S& rho) {
  using std::abs, std::sqrt;
  const auto surface = face_gear::make_surface<S>(gear, gear.zones[std::size_t(zone)].helix_angle_rad);
  const S psi = *closed_lean<S>(surface, side, at, rho);
  const auto frame = line::tangent_frame<S>(side, surface.flank(side, at.theta, at.B).n, Vec3T<S>(S(0), S(0), S(1)));
  const Vec3T<S> u = line::axis_direction<S>(frame, psi, S(0));
  const auto H = closed_shape<S>(surface, side, at);
  return abs(S(line::distance_bend<S>(frame, H, S(0), u) - abs(H.gauss()) * rho)) / sqrt(S(abs(H.gauss())));
}
TEST(LineContact, CurvatureAlongTheLineIsGaussTimesRho) {
  Random random(9);
  for (const auto& c : line_cases()) {
    const auto f = c.task();
    for (int k = 0; k < 40; ++k) {
      const auto q = random_place(f, random);
      const double rho = c.r_0 * random(1, 2);
      EXPECT_LT(relative_lack<double>(c.gear, c.zone, c.side, q.at, rho), 1e-9) << c.name;
      if (k >= 5) continue;
      EXPECT_LT(double(relative_lack<F50>(c.gear, c.zone, c.side, {F50(q.at.theta), F50(q.at.B)}, F50(rho))), 1e-44)
          << c.name;
    }
  }
}

// The foot in double against 50 digits, and its gradient: the distance rises by 1 along n.
TEST(LineContact, FootAgainstFiftyDigits) {
  Random random(10);
  for (const auto& c : line_cases()) {
    const auto f = c.task();
    const auto surface = face_gear::make_surface<F50>(c.gear, c.gear.zones[std::size_t(c.zone)].helix_angle_rad);
    for (int k = 0; k < 10; ++k) {
      const auto q = random_place(f, random);
      const auto on = f.surface.flank(c.side, q.at.theta, q.at.B);
      const double distance = random(0, 2) * c.r_0;
      const Vec3 x = on.p + distance * on.n;
      const face_gear::FlankParameters<double> near{q.at.theta + random(-0.02, 0.02), q.at.B + random(-0.02, 0.02)};
      const auto foot = face_gear::flank_foot<double>(f.surface, c.side, x, near);
      ASSERT_TRUE(foot);
      const auto exact = face_gear::flank_foot<F50>(surface, c.side, cast<F50>(x), {F50(near.theta), F50(near.B)});
      EXPECT_NEAR(foot->d, double(exact->d), 1e-13 * q.r) << c.name;
      EXPECT_NEAR(foot->d, distance, 2e-13 * q.r) << c.name;
      EXPECT_NEAR(foot->theta_foot, q.at.theta, 1e-10) << c.name;
      EXPECT_LE((foot->n - on.n).norm(), 1e-11) << c.name;
    }
  }
}

using Along = Dual<double, 1>;  // value and derivative along the axis

// The second derivative along an axis by first derivatives of the flank against the closed form at the parallel
// surface, and its rate against dual numbers through that.
TEST(LineContact, BendAgainstTheClosedForms) {
  for (const auto& w : worked_poses()) {
    const auto f = task_of(w);
    const auto axis = axis_of(w), in_space = axis_of(w, f);
    const auto start = start_of(f, w);
    const double t = 0.4 * w.length;
    const auto g = face_gear::make_surface<Along>(w.gear, w.gear.zones[std::size_t(w.zone)].helix_angle_rad);
    const auto near = *face_gear::flank_foot<double>(
        f.surface, w.side, axis.at(t), {face_gear::theta_at_distance(f.surface, start.u, w.r_0), start.v});
    Vec3T<Along> moving, a;
    for (int k = 0; k < 3; ++k) {
      moving[k].v = axis.at(t)[k];
      moving[k].d[0] = axis.a[k];
      a[k] = Along(axis.a[k]);
    }
    const auto foot = *face_gear::flank_foot<Along>(g, w.side, moving, {Along(near.at.theta), Along(near.at.B)});
    const auto H = g.flank_shape(w.side, foot.at.theta, foot.at.B);
    const auto basis = g.flank_basis(w.side, foot.at.theta, foot.at.B);
    const TurnT<Along> turn(foot.turn);
    const Along e = a.dot(turn(basis.e)), l = a.dot(turn(basis.l));
    const Along bend = H.ee * e * e + Along(2) * H.el * e * l + H.ll * l * l;
    EXPECT_NEAR(bend_along(f, in_space, t, start), bend.v, 1e-13) << w.name;
    EXPECT_NEAR(third_along(f, in_space, t, start), bend.d[0], 1e-6 * std::abs(bend.d[0])) << w.name;
    // And the second one against differences of the distance itself.
    const auto d = [&](double at) { return f.space->foot(f.piece(), in_space.at(at), start.u, start.v)->distance; };
    const double h = 1e-2 * w.length;
    EXPECT_NEAR(bend.v, (d(t + h) + d(t - h) - 2 * d(t)) / (h * h), 1e-6) << w.name;
  }
}

// L9: with the helix going to 0 the lean goes to that of the spur gear of the same numbers; the steeper root never
// changes over.
TEST(LineContact, LeanIsContinuousInTheHelix) {
  for (const double offset : {0.0, 6.0}) {
    for (const int side : {1, -1}) {
      auto gear = small_spur();
      gear.offset_mm = offset;
      const auto lean_at = [&](double beta) {
        const auto surface = face_gear::make_surface<double>(gear, beta);
        const auto at = face_gear::invert_flank(surface, side, 63, -20);
        return *closed_lean<double>(surface, side, {at->theta, at->B}, 0.5);
      };
      const double spur = lean_at(0);
      for (const double beta : {1e-12, 1e-9, 1e-6, 1e-4})
        for (const int hand : {1, -1})
          EXPECT_NEAR(lean_at(hand * beta), spur, 4 * beta + 1e-12) << side << " " << offset;
      for (int k = 0; k < 200; ++k)
        EXPECT_NEAR(lean_at(0.0025 * k), lean_at(0.0025 * (k + 1)), 0.01) << side << " " << offset;
    }
  }
}

// Beyond the undercut edge, and where the ball does not fit between flank and edge, there is no lean.
TEST(LineContact, NothingBeyondTheUndercutEdge) {
  const auto gear = quarter_dhfg();
  const auto& space = kept(made(gear)).space(0);
  const auto surface = face_gear::make_surface<double>(gear, gear.zones[0].helix_angle_rad);
  const auto limits = face_gear::zone_limits(surface, gear.module_mm);
  const auto& flank = limits.flanks[1];
  ASSERT_TRUE(flank.undercut_B);
  const double theta = surface.shaper.theta_t;
  int with = 0, without = 0;
  for (const double off : {0.05, 0.01, 1e-3, 1e-5, -1e-5, -1e-3, -0.01}) {
    const face_gear::FlankParameters<double> at{theta, *flank.undercut_B - off};  // larger |B| on side -1: outwards
    const bool regular = surface.flank_J(-1, at.theta, at.B) > 0;
    EXPECT_EQ(regular, off > 0);
    const auto on = space.at(tooth_space::Piece::flank_minus, at.theta, at.B);
    EXPECT_EQ(on.has_value(), regular) << off;
    if (on) {
      const auto shape = line::shape_at(line::tangent_frame<double>(-1, on->n, Vec3::UnitZ()), *on);
      EXPECT_TRUE(line::lean<double>(shape, 0.0)) << off;
      const double hollow = 2 / (std::hypot(shape.pp - shape.oo, 2 * shape.po) - shape.trace());
      EXPECT_TRUE(line::lean<double>(shape, 0.99 * hollow)) << off;
      EXPECT_FALSE(line::lean<double>(shape, 1.01 * hollow)) << off;
      EXPECT_FALSE(line::lean<double>(shape, 1e3 * hollow)) << off;
    }
    (regular ? with : without) += 1;
  }
  EXPECT_GE(with, 3);
  EXPECT_GE(without, 3);
}

}  // namespace
}  // namespace toothpath::test
