// Forward and inverse kinematics: LinuxCNC's own numbers, closed-form table rows, round trips, poles, planted faults.
#include "machines/kinematic_chain.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/machines/chains.h"

namespace toothpath {
namespace {

using test::ac_table, test::bc_table, test::random_axis, test::random_chain_kinds;

/// LinuxCNC's trunnion, written as 2.2 reads it: rotation point, offsets, both rotaries reversed.
machines::KinematicChain linuxcnc_trunnion(char tilt) {
  const Vec3 point(1.5, -2.5, -40.0);
  const Vec3 offset = tilt == 'A' ? Vec3(0, 3.25, -7.5) : Vec3(3.25, 0, -7.5);
  machines::KinematicChain chain = tilt == 'A' ? ac_table(point, point + offset) : bc_table(point, point + offset);
  for (machines::RotaryAxis& axis : chain.table) axis.sign = -1;
  return chain;
}

/// Pose that LinuxCNC reports: the tool offset is still in its z.
Vec3 linuxcnc_pose(const machines::KinematicChain& chain, const Vec3& xyz, double tilt_deg, double c_deg) {
  const double tool_offset = 101.2;
  const machines::TablePose pose = chain.forward({xyz, {radians(c_deg), radians(tilt_deg)}}, tool_offset);
  return pose.tip_mm + Vec3(0, 0, tool_offset);
}

TEST(LinuxcncKinematics, GoldenPosesOfTheShippedBinaries) {
  const auto near = [](const Vec3& a, const Vec3& b) { return (a - b).norm() <= 1e-12 * (1 + b.norm()); };
  EXPECT_TRUE(near(linuxcnc_pose(linuxcnc_trunnion('A'), {10, 20, 30}, 25, -40),
                   {1.1461669155887146, 11.145334377839344, 24.085103908722928}));
  EXPECT_TRUE(near(linuxcnc_pose(linuxcnc_trunnion('B'), {10, 20, 30}, 25, -40),
                   {0.84459304518711775, 26.321712275921751, 34.439251321370065}));
  EXPECT_TRUE(near(linuxcnc_pose(linuxcnc_trunnion('A'), {-120.5, 33.25, -80}, -95, 370),
                   {-95.445643889080969, 150.263931264246, 97.729050493343635}));
  EXPECT_TRUE(near(linuxcnc_pose(linuxcnc_trunnion('B'), {-120.5, 33.25, -80}, -95, 370),
                   {-109.50879519600169, 53.37534706391066, 190.12610874135305}));
}

// The printed formulas of xyzac-trt / xyzbc-trt (dz = z-offset + tool-offset) against forward().
TEST(LinuxcncKinematics, PrintedFormulasOnRandomJoints) {
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<double> mm(-500, 500), angle(-10, 10);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 q(mm(rng), mm(rng), mm(rng));
    const double lateral = mm(rng) / 10, up = mm(rng) / 10, L = std::abs(mm(rng)), dz = up + L;
    const double t = angle(rng), c = angle(rng);
    const Vec3 j(mm(rng), mm(rng), mm(rng));
    const double X = j.x(), Y = j.y(), Z = j.z(), S = std::sin(t), C = std::cos(t), s = std::sin(c), k = std::cos(c);
    const double w = Z - dz - q.z();
    const double v = Y - lateral - q.y(), h = X - lateral - q.x();
    const Vec3 ac(k * (X - q.x()) + s * C * v + s * S * w + s * lateral + q.x(),
                  -s * (X - q.x()) + k * C * v + k * S * w + k * lateral + q.y(), -S * v + C * w + dz + q.z());
    const Vec3 bc(k * C * h + s * (Y - q.y()) - k * S * w + k * lateral + q.x(),
                  -s * C * h + k * (Y - q.y()) + s * S * w - s * lateral + q.y(), S * h + C * w + dz + q.z());
    machines::KinematicChain a = ac_table(q, q + Vec3(0, lateral, up)), b = bc_table(q, q + Vec3(lateral, 0, up));
    for (auto* chain : {&a, &b})
      for (machines::RotaryAxis& axis : chain->table) axis.sign = -1;
    ASSERT_LE((a.forward({j, {c, t}}, L).tip_mm + Vec3(0, 0, L) - ac).norm(), 1e-11 * 2000);
    ASSERT_LE((b.forward({j, {c, t}}, L).tip_mm + Vec3(0, 0, L) - bc).norm(), 1e-11 * 2000);
  }
}

double wrapped(double angle) { return std::remainder(angle, 2 * kPi); }

void expect_row(const machines::KinematicChain& chain, const Vec3& u, double first, double second, int pair) {
  const auto solutions = chain.rotary_solutions(u);
  ASSERT_TRUE(solutions);
  ASSERT_EQ(solutions->size(), 2u);
  const machines::JointSolution& s = (*solutions)[static_cast<std::size_t>(pair - 1)];
  EXPECT_EQ(s.pair, pair);
  EXPECT_EQ(s.free_rotary, -1);
  EXPECT_NEAR(wrapped(s.joints.rotary_rad[0] - first), 0, 1e-12) << u.transpose();
  EXPECT_NEAR(wrapped(s.joints.rotary_rad[1] - second), 0, 1e-12) << u.transpose();
}

// The closed forms of AC, BC and AB, in each of the three classes that share them.
TEST(RotarySolutions, TableRows) {
  std::mt19937_64 rng(2);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 u = random_axis(rng);
    const double a = std::atan2(std::hypot(u.x(), u.y()), u.z());
    for (const machines::KinematicChain& chain : {test::ac_table(), test::head_table('A'), test::head_head('A')}) {
      expect_row(chain, u, std::atan2(u.x(), -u.y()), a, 1);
      expect_row(chain, u, std::atan2(u.x(), -u.y()) + kPi, -a, 2);
    }
    for (const machines::KinematicChain& chain : {test::bc_table(), test::head_table('B'), test::head_head('B')}) {
      expect_row(chain, u, std::atan2(u.y(), u.x()), a, 1);
      expect_row(chain, u, std::atan2(u.y(), u.x()) + kPi, -a, 2);
    }
    const double b = std::atan2(u.x(), std::hypot(u.y(), u.z()));
    expect_row(test::ab_table(), u, std::atan2(-u.y(), u.z()), b, 1);
    expect_row(test::ab_table(), u, std::atan2(-u.y(), u.z()) + kPi, kPi - b, 2);
  }
}

// Close to the pole C keeps its relative digits: acos(u_z) would lose it all below 1e-8 rad.
TEST(RotarySolutions, DigitsNearThePole) {
  for (double tilt = 1e-1; tilt > 2e-13; tilt /= 10)
    for (double c = -3.0; c <= 3.0; c += 0.25) {
      const Vec3 u(std::sin(tilt) * std::sin(c), -std::sin(tilt) * std::cos(c), std::cos(tilt));
      expect_row(ac_table(), u, c, tilt, 1);
      const auto s = ac_table().rotary_solutions(u);
      EXPECT_NEAR(s->front().joints.rotary_rad[1] / tilt, 1.0, 1e-12);
    }
}

TEST(RotarySolutions, PoleLeavesTheFirstRotaryFree) {
  for (const auto& [chain, pole, tilt] :
       {std::tuple{ac_table(), Vec3(0, 0, 1), 0.0}, std::tuple{ac_table(), Vec3(0, 0, -1), kPi},
        std::tuple{test::head_table('B'), Vec3(0, 0, 1), 0.0}, std::tuple{test::ab_table(), Vec3(1, 0, 0), kPi / 2}}) {
    const auto s = chain.rotary_solutions(pole);
    ASSERT_TRUE(s);
    ASSERT_EQ(s->size(), 1u);
    EXPECT_EQ(s->front().free_rotary, 0);
    EXPECT_NEAR(s->front().joints.rotary_rad[1], tilt, 1e-12);
    for (const double any : {-2.0, 0.3, 3.0}) {  // every angle of the free axis gives the same tool axis
      const machines::TablePose pose = chain.forward({Vec3::Zero(), {any, s->front().joints.rotary_rad[1]}}, 100);
      EXPECT_LE((pose.axis - pole).norm(), 1e-15 * 4);
    }
  }
}

// A rotary that a pole leaves free stands at its zero; asked for with limits, it takes the wanted angle or the limit
// nearest to it.
TEST(RotarySolutions, FreeRotaryStandsAtItsZeroAndInsideItsLimits) {
  for (machines::KinematicChain chain : {ac_table(), bc_table(), test::head_table('B'), test::head_head('A')}) {
    machines::RotaryAxis& first = chain.table.empty() ? chain.head.front() : chain.table.front();
    first.zero_rad = 0.7;
    const auto s = chain.rotary_solutions(Vec3::UnitZ());
    ASSERT_TRUE(s);
    ASSERT_EQ(s->front().free_rotary, 0);
    EXPECT_EQ(s->front().joints.rotary_rad[0], 0.7);
    first.min_rad = -1;
    first.max_rad = 2;
    const machines::LimitMargin margin{0, 0.25};
    for (const double wanted : {-9.0, -1.0, 0.1, 1.9, 40.0}) {
      const auto found = chain.candidates({Vec3(10, 20, 30), Vec3::UnitZ()}, 100, margin, wanted);
      ASSERT_TRUE(found) << found.error().message;
      for (const auto& one : *found) {
        EXPECT_TRUE(chain.violations(one.joints, margin).empty()) << wanted;
        EXPECT_EQ(one.joints.rotary_rad[0], std::max(-0.75, std::min(1.75, wanted)));
      }
    }
  }
}

// An axis beyond the reach is served by the nearest one as far as text rounds it, and no farther.
TEST(RotarySolutions, ReachEndsWithTheRoundingOfText) {
  machines::KinematicChain nutating = bc_table();
  nutating.table[1].direction = Vec3(0, 1, 1).normalized();
  machines::KinematicChain tilt_only = test::head_table('B');
  tilt_only.table.clear();
  machines::KinematicChain turntable = ac_table();
  turntable.table.pop_back();
  for (const double beyond : {5e-11, 1e-9, 1e-6}) {
    const bool served = beyond < 1e-10;
    EXPECT_EQ(bool(nutating.rotary_solutions({std::cos(beyond), 0, -std::sin(beyond)})), served) << beyond;
    EXPECT_EQ(bool(tilt_only.rotary_solutions(Vec3(std::sin(0.4), std::sin(beyond), std::cos(0.4)).normalized())),
              served)
        << beyond;
    EXPECT_EQ(bool(turntable.rotary_solutions({std::sin(beyond), 0, std::cos(beyond)})), served) << beyond;
    EXPECT_EQ(bool(test::with_linear().rotary_solutions({std::sin(beyond), 0, std::cos(beyond)})), served) << beyond;
  }
}

// Nutating table at 45 deg: the tilt reaches 90 deg and no further; at the end of reach both pairs meet.
TEST(RotarySolutions, NutatingAxisEndsAtItsCone) {
  machines::KinematicChain chain = bc_table();
  chain.table[1].direction = Vec3(0, 1, 1).normalized();
  for (const double tilt : {0.0, 1e-7, 0.3, 1.0, kPi / 2 - 1e-9}) {
    const Vec3 u(std::sin(tilt), 0, std::cos(tilt));
    const auto s = chain.inverse({Vec3(10, 20, 30), u}, 100);
    ASSERT_TRUE(s) << tilt;
    for (const auto& one : *s) EXPECT_LE((chain.forward(one.joints, 100).axis - u).norm(), 1e-12) << tilt;
  }
  const auto beyond = chain.rotary_solutions({std::sin(1.6), 0, std::cos(1.6)});
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().message,
            "tool axis (0.999574, 0.000000, -0.029200) is out of reach of axis B by 1.673247 deg");
}

// 79, 80: an axis without direction or of another length is no axis, on any chain.
TEST(RotarySolutions, AxisMustBeAUnitVector) {
  for (const machines::KinematicChain& chain : {ac_table(), test::with_linear(), test::head_head('B')}) {
    EXPECT_EQ(chain.rotary_solutions(Vec3::Zero()).error().message,
              "tool axis (0.000000, 0.000000, 0.000000) has length 0.000000000, must be 1");
    EXPECT_EQ(chain.rotary_solutions({0, 0, 1.5}).error().message,
              "tool axis (0.000000, 0.000000, 1.500000) has length 1.500000000, must be 1");
    EXPECT_FALSE(chain.rotary_solutions({std::nan(""), 0, 1}));
  }
}

// forward(inverse) is the identity: every class, random directions, points, signs and zeros; also next to the pole.
TEST(Inverse, RoundTripOverRandomChains) {
  std::mt19937_64 rng(3);
  std::uniform_real_distribution<double> mm(-500, 500), length(10, 300), small(-14, 0);
  int tested = 0, two = 0;
  for (int i = 0; i < 60000; ++i) {
    const machines::KinematicChain chain = random_chain_kinds(rng, i);
    std::uniform_real_distribution<double> turn(-kPi, kPi);
    // A pose that the chain reaches, sometimes next to a pole: second angle 10^-14 .. 1 rad.
    const double second = i % 3 == 0 ? std::pow(10.0, small(rng)) : turn(rng);
    const double L = length(rng);
    machines::Joints start{Vec3(mm(rng), mm(rng), mm(rng)), {0, 0}};
    for (std::size_t k = 0; k < chain.rotary_count(); ++k)
      start.rotary_rad[k] = chain.rotary(k).zero_rad + (k == 1 ? second : turn(rng));
    const machines::TablePose pose = chain.forward(start, L);
    const auto solutions = chain.inverse(pose, L);
    ASSERT_TRUE(solutions) << solutions.error().message;
    bool found = false;
    for (const machines::JointSolution& s : *solutions) {
      const machines::TablePose back = chain.forward(s.joints, L);
      ASSERT_LE((back.axis - pose.axis).norm(), 1e-12) << i;
      ASSERT_LE((back.tip_mm - pose.tip_mm).norm(), 1e-9) << i;
      double off = 0;
      for (std::size_t k = 0; k < chain.rotary_count(); ++k)
        off = std::max(off, std::abs(wrapped(s.joints.rotary_rad[k] - start.rotary_rad[k])));
      // Joints themselves come back, except at a pole and where both pairs meet.
      found = found || off < 1e-9 || s.free_rotary >= 0;
    }
    const bool well_apart = std::abs(second) > 1e-5;
    if (well_apart && solutions->size() == 2) {
      const auto& a = (*solutions)[0].joints.rotary_rad;
      const auto& b = (*solutions)[1].joints.rotary_rad;
      if (std::abs(wrapped(a[1] - b[1])) > 1e-4) { EXPECT_TRUE(found) << i; }
      ++two;
    }
    ++tested;
  }
  EXPECT_EQ(tested, 60000);
  EXPECT_GT(two, 20000);
}

TEST(Inverse, ThreeAxesReachOnlyTheVertical) {
  machines::KinematicChain chain;
  for (auto& axis : chain.linear) axis = {-100, 100, 1000};
  const auto up = chain.inverse({Vec3(1, 2, 3), Vec3::UnitZ()}, 50);
  ASSERT_TRUE(up);
  EXPECT_EQ(up->front().joints.linear_mm, Vec3(1, 2, 53));
  const auto leaning = chain.inverse({Vec3(1, 2, 3), Vec3(0, std::sin(0.1), std::cos(0.1))}, 50);
  ASSERT_FALSE(leaning);
  EXPECT_EQ(leaning.error().message,
            "tool axis (0.000000, 0.099833, 0.995004) leans 5.729578 deg; this machine has no rotary axis");
}

TEST(Inverse, TurntableIsFreeAndCannotTilt) {
  machines::KinematicChain chain = ac_table(Vec3(5, 0, 0));
  chain.table.pop_back();
  const auto up = chain.inverse({Vec3(1, 2, 3), Vec3::UnitZ()}, 50);
  ASSERT_TRUE(up);
  EXPECT_EQ(up->front().free_rotary, 0);
  EXPECT_FALSE(chain.inverse({Vec3(1, 2, 3), Vec3(0, std::sin(0.1), std::cos(0.1))}, 50));
}

// A swapped sign, a moved point and a longer tool must all show in the forward result.
TEST(Forward, PlantedFaultsShow) {
  std::mt19937_64 rng(4);
  for (int i = 0; i < 200; ++i) {
    machines::KinematicChain chain = random_chain_kinds(rng, i);
    if (chain.rotary_count() == 0) continue;
    const machines::Joints joints{Vec3(40, -30, 20), {0.7, 0.4}};
    const machines::TablePose good = chain.forward(joints, 100);
    for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
      machines::KinematicChain bad = chain;
      (bad.in_table(k) ? bad.table[k] : bad.head[k - bad.table.size()]).sign *= -1;
      const machines::TablePose pose = bad.forward(joints, 100);
      EXPECT_GT((pose.tip_mm - good.tip_mm).norm() + 100 * (pose.axis - good.axis).norm(), 1e-3) << i << ' ' << k;
    }
    const machines::TablePose longer = chain.forward(joints, 100.25);
    EXPECT_LE((longer.tip_mm - (good.tip_mm - 0.25 * good.axis)).norm(), 1e-12);
  }
}

// One head axis: the nose swings on a circle of the pivot length (h = P e_z - P u_M).
TEST(Forward, HeadAxisSwingsAboutItsPivot) {
  machines::KinematicChain chain = test::head_table('B');
  chain.head[0].point_mm = Vec3(0, 0, 180);
  for (const double b : {-1.2, 0.0, 0.5}) {
    const Vec3 u(std::sin(b), 0, std::cos(b));
    const Vec3 expected = Vec3(10, 20, 30) + 180 * Vec3::UnitZ() - 180 * u - 75 * u;
    const machines::TablePose pose = chain.forward({Vec3(10, 20, 30), {0, b}}, 75);
    EXPECT_LE((pose.tip_mm - expected).norm(), 1e-12 * 300);
    EXPECT_LE((pose.axis - u).norm(), 1e-15 * 4);
  }
}

// A positive command turns the tool positively about the axis relative to the work, in table and head alike.
TEST(Forward, SenseOfIso841) {
  for (const machines::KinematicChain& chain : {ac_table(), test::head_head('A')}) {
    const machines::TablePose a = chain.forward({Vec3::Zero(), {0, 0.1}}, 100);
    EXPECT_NEAR(a.axis.y(), -std::sin(0.1), 1e-15);  // Rot(x, +0.1) e_z
    const machines::TablePose c = chain.forward({Vec3::Zero(), {0.2, 0.1}}, 100);
    EXPECT_NEAR(std::atan2(c.axis.y(), c.axis.x()) - std::atan2(a.axis.y(), a.axis.x()), 0.2, 1e-14);
  }
}

TEST(Windings, EveryTurnInsideTheLimits) {
  machines::RotaryAxis c;
  c.min_rad = radians(-720);
  c.max_rad = radians(370);
  const auto all = machines::windings(c, radians(5));
  ASSERT_EQ(all.size(), 4u);
  for (std::size_t k = 0; k < all.size(); ++k)
    EXPECT_NEAR(degrees(all[k]), -715 + 360.0 * static_cast<double>(k), 1e-9);
  EXPECT_EQ(machines::windings(c, radians(5), radians(6)).size(), 2u);  // -715 and 365 lie within 6 deg of a limit
  EXPECT_TRUE(machines::windings(c, std::nan("")).empty());
  c.max_rad = radians(-721);
  EXPECT_TRUE(machines::windings(c, 0.0).empty());
}

TEST(Candidates, AllBranchesAndTurnsInsideTheLimitsAndNoOther) {
  std::mt19937_64 rng(5);
  machines::KinematicChain chain = ac_table(Vec3(3, -2, 0), Vec3(0, 12.5, -31.25));
  chain.table[0].min_rad = radians(-800), chain.table[0].max_rad = radians(700);
  chain.table[1].min_rad = radians(-110), chain.table[1].max_rad = radians(30);
  for (int i = 0; i < 2000; ++i) {
    const machines::TablePose pose{Vec3(20, 10, 5), random_axis(rng)};
    const auto found = chain.candidates(pose, 90);
    std::size_t expected = 0;
    const auto branches = chain.inverse(pose, 90);
    for (const machines::JointSolution& s : *branches)
      for (int p = -5; p <= 5; ++p)
        for (int q = -5; q <= 5; ++q) {
          machines::Joints j = s.joints;
          j.rotary_rad[0] += 2 * kPi * p, j.rotary_rad[1] += 2 * kPi * q;
          if (chain.violations(j).empty()) ++expected;
        }
    ASSERT_EQ(found ? found->size() : 0u, expected);
    if (found)
      for (const machines::JointSolution& s : *found) {
        EXPECT_TRUE(chain.violations(s.joints).empty());
        EXPECT_LE((chain.forward(s.joints, 90).tip_mm - pose.tip_mm).norm(), 1e-9);
      }
  }
}

// What no branch reaches is named with value and limits, for both pairs.
TEST(Candidates, UnreachablePoseNamesAxisValueAndLimit) {
  machines::KinematicChain chain = ac_table();
  chain.table[0].min_rad = radians(-360), chain.table[0].max_rad = radians(360);
  chain.table[1].min_rad = radians(-120), chain.table[1].max_rad = radians(30);
  const double a = radians(131.2);
  const auto none = chain.candidates({Vec3::Zero(), Vec3(0, -std::sin(a), std::cos(a))}, 100);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message,
            "no solution inside the limits: pair 1: A = 131.2000 deg outside [-119.9900, 29.9900]; pair 2: A = "
            "-131.2000 deg outside [-119.9900, 29.9900]");
  chain.linear[1] = {-200, 200, 1000};
  const auto far = chain.candidates({Vec3(0, 212.4183, 0), Vec3::UnitZ()}, 100, {0, 0});
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().message, "no solution inside the limits: pair 1: Y = 212.4183 mm exceeds 200.0000");
}

// What the margin alone excludes says which key keeps it.
TEST(Candidates, TheMarginIsNamed) {
  machines::KinematicChain chain = ac_table();
  chain.table[0].min_rad = 0, chain.table[0].max_rad = radians(360);
  chain.table[1].min_rad = radians(-120), chain.table[1].max_rad = radians(0);
  const auto none = chain.candidates({Vec3::Zero(), Vec3(0, std::sin(0.3), std::cos(0.3))}, 100);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("C = 0.0000 deg outside [0.0100, 359.9900]: inside the limit, but nearer to it "
                                      "than limits.limit_margin_angle = 0.01 deg"),
            std::string::npos)
      << none.error().message;
  const auto found = chain.violations({Vec3::Zero(), {radians(359.995), radians(-121)}});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(
      found[0].text(),
      "C = 359.9950 deg exceeds 359.9900: inside the limit, but nearer to it than limits.limit_margin_angle = 0.01 "
      "deg");
  EXPECT_EQ(found[1].text(), "A = -121.0000 deg is below -119.9900");
}

TEST(CheckChain, RefusesWhatNoInverseCanServe) {
  machines::KinematicChain chain = ac_table();
  EXPECT_TRUE(machines::check_chain(chain));
  chain.table[1].direction = Vec3(0, 0, 2);
  EXPECT_EQ(machines::check_chain(chain).error().message, "direction of axis A has length 2, must be 1");
  chain.table[1].direction = Vec3(0, 1e-9, -1).normalized();
  EXPECT_EQ(machines::check_chain(chain).error().message,
            "rotary axes C and A are parallel: the angle between them is 0.000000 deg, must be above 0.000057 deg");
  std::swap(chain.table[0], chain.table[1]);
  chain.table[0].direction = Vec3::UnitX();
  EXPECT_EQ(machines::check_chain(chain).error().message,
            "rotary axis C is parallel to the spindle and cannot tilt the tool: its angle to Z is 0.000000 deg, must "
            "be above 0.000057 deg");
  chain.head = {machines::RotaryAxis{}};
  EXPECT_EQ(machines::check_chain(chain).error().message, "a chain has at most 2 rotary axes, this one has 3");
}

}  // namespace
}  // namespace toothpath
