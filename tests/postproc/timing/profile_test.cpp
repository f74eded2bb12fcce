// Motion on a straight stretch: closed forms, and brute force over time.
#include "postproc/timing/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace toothpath {
namespace {

using timing::Limits, timing::Profile;

TEST(Profile, TrapezoidAndTriangle) {
  for (const double length : {0.01, 0.5, 5.0, 300.0})
    for (const double v : {1.0, 20.0, 200.0})
      for (const double a : {50.0, 2000.0}) {
        const double t = length >= v * v / a ? length / v + v / a : 2 * std::sqrt(length / a);
        EXPECT_NEAR(Profile(length, 0, 0, {v, a, 0}).time(), t, 1e-12 * t);
      }
}

// From rest to rest: with cruise, with constant acceleration but no cruise, with jerk alone.
TEST(Profile, SCurve) {
  const double v = 100, a = 500, j = 4000;
  for (const double length : {200.0, 60.0}) {  // v (v / a + a / j) = 32.5 mm is the least with cruise
    EXPECT_NEAR(Profile(length, 0, 0, {v, a, j}).time(), length / v + v / a + a / j, 1e-12);
  }
  const double least = 2 * a * a * a / (j * j);  // 15.6 mm: the acceleration is just reached
  for (const double length : {20.0, 30.0}) {
    ASSERT_GT(length, least);
    const double t = a / j + std::sqrt(a / j * a / j + 4 * length / a);
    EXPECT_NEAR(Profile(length, 0, 0, {v, a, j}).time(), t, 1e-9);
  }
  for (const double length : {0.001, 1.0, 15.0})
    EXPECT_NEAR(Profile(length, 0, 0, {v, a, j}).time(), 4 * std::cbrt(length / (2 * j)), 1e-9);
}

// A great jerk is none.
TEST(Profile, JerkInTheLimit) {
  for (const double length : {0.1, 3.0, 80.0})
    EXPECT_NEAR(Profile(length, 3, 5, {100, 500, 1e12}).time(), Profile(length, 3, 5, {100, 500, 0}).time(), 1e-6);
}

TEST(Profile, ReachableIsTheInverseOfTheRamp) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (int trial = 0; trial < 400; ++trial) {
    const Limits l{1e9, std::exp(10 * share(random)), trial % 2 ? std::exp(15 * share(random)) : 0};
    const double from = trial % 5 ? 50 * share(random) : 0, length = std::exp(12 * share(random) - 6);
    const double to = timing::reachable(from, length, l);
    EXPECT_NEAR(timing::ramp_length(from, to, l), length, 1e-7 * length) << trial;
  }
}

// What the profile does is followed in small steps: every limit is kept, both speeds are those asked for, and the place
// is the length at the end.
TEST(Profile, KeepsItsLimits) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> share(0, 1);
  for (int trial = 0; trial < 40; ++trial) {
    const Limits l{20 + 100 * share(random), 200 + 800 * share(random), trial % 2 ? 3000 + 5000 * share(random) : 0};
    const double from = 15 * share(random), to = 15 * share(random);
    const double length = timing::ramp_length(from, to, l) + (trial % 3 == 0 ? 0.01 : 30 * share(random));
    const Profile p(length, from, to, l);
    const int n = 4000;
    double before = 0, speed = from, greatest_speed = 0, greatest_acceleration = 0;
    for (int i = 1; i <= n; ++i) {
      const double t = p.time_at(length * i / n), v = length / n / (t - before);
      const double a = std::abs(v - speed) / (t - before);
      greatest_speed = std::max(greatest_speed, v);
      if (i > 40 && i < n - 40) greatest_acceleration = std::max(greatest_acceleration, a);
      ASSERT_GT(t, before);
      if (i == 1) { EXPECT_NEAR(v, from, 0.2 * (from + 10)) << trial; }
      if (i == n) { EXPECT_NEAR(v, to, 0.2 * (to + 10)) << trial; }
      before = t, speed = v;
    }
    EXPECT_LE(greatest_speed, l.speed * (1 + 1e-6));
    EXPECT_LE(greatest_acceleration, l.acceleration * 1.02) << trial;
    EXPECT_NEAR(before, p.time(), 1e-9);
    EXPECT_GE(p.time(), length / l.speed);
  }
}

}  // namespace
}  // namespace toothpath
