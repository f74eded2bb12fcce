// Paths of blocks: closed forms at corners, invariances, and LinuxCNC's rule in steps of a period.
#include "postproc/timing/path_timer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

namespace toothpath {
namespace {

using timing::AxisLimits, timing::Block, timing::Corners, timing::PathControl;

constexpr double kSecondInMinutes = 1.0 / 60;  // min
constexpr double kMinute = 60;                 // per minute of 1 per second
constexpr double kMinute2 = 3600;              // per min^2 of 1 per s^2
constexpr double kMinute3 = 216000;
constexpr double kPeriod = 0.001 * kSecondInMinutes;

AxisLimits limits(double acceleration, double jerk = 0, double speed = 1000) {
  AxisLimits l;
  l.speed.fill(speed * kMinute);
  l.acceleration.fill(acceleration * kMinute2);
  l.jerk.fill(jerk * kMinute3);
  return l;
}

PathControl linuxcnc(Corners corners, double tolerance = 0) { return {corners, kPeriod, 0, tolerance, true}; }

PathControl jumping(double ms) { return {Corners::jump, 0, 0.001 * ms * kSecondInMinutes, 0, false}; }

double seconds(const std::vector<Block>& blocks, const AxisLimits& l, const PathControl& control) {
  const auto times = timing::times_of(blocks, l, control);
  EXPECT_EQ(times.size(), blocks.size());
  return 60 * std::accumulate(times.begin(), times.end(), 0.0);
}

/// A block at this speed, mm/s of its Euclidean length.
Block block(std::array<double, 5> step, double speed) {
  double square = 0;
  for (const double s : step) square += s * s;
  return {step, std::sqrt(square) / speed * kSecondInMinutes, false};
}

double from_rest(double length, double v, double a) {
  return length >= v * v / a ? length / v + v / a : 2 * std::sqrt(length / a);
}

TEST(PathTimer, ExactStops) {
  const double v = 50, a = 1000;
  const std::vector<Block> blocks = {block({10, 0, 0, 0, 0}, v), block({10, 0, 0, 0, 0}, v),
                                     block({0, 0.5, 0, 0, 0}, v)};
  EXPECT_NEAR(seconds(blocks, limits(a), linuxcnc(Corners::stop)), 2 * from_rest(10, v, a) + from_rest(0.5, v, a),
              3e-3);
  // Under G61 the first two are one line, and the block before the sharp corner loses a tenth of its acceleration.
  const double one = from_rest(20, v, a), both = seconds(blocks, limits(a), linuxcnc(Corners::exact));
  EXPECT_GT(both, one + from_rest(0.5, v, a) - 1e-9);
  EXPECT_LT(both, one + from_rest(0.5, v, 0.9 * a) + v / (0.9 * a) - v / a + 3e-3);
}

// The slowest axis rules: speed and acceleration of a rotary, as of a linear axis.
TEST(PathTimer, RotaryLimits) {
  AxisLimits l = limits(1e6);
  l.speed[4] = 20 * kMinute;  // deg/s
  l.acceleration[4] = 100 * kMinute2;
  EXPECT_NEAR(seconds({block({3, 0, 0, 0, 40}, 1e6)}, l, jumping(1)), from_rest(40, 20, 100), 1e-9);
  EXPECT_NEAR(seconds({block({0, 0, 0, 0, 1}, 1e6)}, l, jumping(1)), from_rest(1, 20, 100), 1e-9);
}

// A corner of 90 deg that is rounded with the tolerance P: the arc has the radius P cos / (1 - sin) tan of half the
// angle, and the acceleration across it is sqrt(3) / 2 of that of the axes.
TEST(PathTimer, BlendedCorner) {
  const double v = 100, a = 1000, way = 40, p = 0.05;
  const std::vector<Block> blocks = {block({way, 0, 0, 0, 0}, v), block({0, way, 0, 0, 0}, v)};
  const double radius = p * std::sqrt(0.5) / (1 - std::sqrt(0.5)), c = std::sqrt(0.86603 * a * radius);
  const double one = v / a + (v - c) / a + (way - v * v / (2 * a) - (v * v - c * c) / (2 * a)) / v;
  EXPECT_NEAR(seconds(blocks, limits(a), linuxcnc(Corners::blend, p)), 2 * one, 1.1e-3);
  // More tolerance, less time; none at all is a stop.
  double before = seconds(blocks, limits(a), linuxcnc(Corners::exact));
  for (const double tolerance : {0.001, 0.01, 0.1, 1.0}) {
    const double now = seconds(blocks, limits(a), linuxcnc(Corners::blend, tolerance));
    EXPECT_LT(now, before);
    before = now;
  }
}

// A corner of 90 deg that is rounded by a parabola: with the change of direction D it takes v / a, leaves the corner by
// v^2 |D| / 8a, and begins v^2 / 2a ahead of it. Followed in small steps it does.
TEST(PathTimer, CornersWithinATolerance) {
  const double v = 100, a = 1000, way = 40, size = std::sqrt(2.0);
  const std::vector<Block> blocks = {block({way, 0, 0, 0, 0}, v), block({0, way, 0, 0, 0}, v)};
  const auto expected = [&](double c) {
    return 2 * (v / a + (v - c) / a + (way - v * v / (2 * a) - (v * v - c * c) / (2 * a)) / v);
  };
  const auto control = [](Corners corners, double mm) {
    PathControl out = jumping(1e-6);
    out.corners = corners;
    out.tolerance_mm = mm;
    return out;
  };
  for (const double mm : {0.001, 0.02}) {
    const double round = std::sqrt(8 * mm * a / size), within = std::sqrt(2 * mm * a);
    EXPECT_NEAR(seconds(blocks, limits(a), control(Corners::round, mm)), expected(round), 1e-9);
    EXPECT_NEAR(seconds(blocks, limits(a), control(Corners::way, mm)), expected(within), 1e-9);
    // From (-s, 0) with (c, 0) to (0, s) with (0, c): the nearest point to the corner.
    const double time = round / a, s = round * time / 2;
    double nearest = 1e9;
    for (int i = 0; i <= 10000; ++i) {
      const double t = time * i / 10000;
      nearest = std::min(nearest, std::hypot(-s + round * t - a * t * t / 2, a * t * t / 2));
    }
    EXPECT_NEAR(nearest, mm, 1e-9);
  }
  // None is the jump, more takes less time, and no more than half of a block is rounded.
  double before = seconds(blocks, limits(a), jumping(1e-6));
  EXPECT_EQ(seconds(blocks, limits(a), control(Corners::round, 0)), before);
  for (const double mm : {1e-4, 1e-3, 1e-2}) {
    const double now = seconds(blocks, limits(a), control(Corners::round, mm));
    EXPECT_LT(now, before);
    before = now;
  }
  const std::vector<Block> small = {block({0.01, 0, 0, 0, 0}, v), block({0, 0.01, 0, 0, 0}, v)};
  const double half = std::sqrt(0.01 * a), most = std::sqrt(0.01 * a + half * half / 2);
  EXPECT_NEAR(seconds(small, limits(a), control(Corners::round, 10)), 2 * (2 * most - half) / a, 1e-9);
  // A jump that is greater than what the tolerance lets pass stays.
  PathControl jumps = jumping(10);
  const double jumped = seconds(blocks, limits(a), jumps);
  jumps.corners = Corners::round;
  jumps.tolerance_mm = 1e-5;
  EXPECT_EQ(seconds(blocks, limits(a), jumps), jumped);
}

// Two blocks that turn under G64: each has half of its acceleration, and the second begins when the first has braked to
// the speed that keeps the tolerance.
TEST(PathTimer, BlendOfTurningBlocks) {
  const double v = 30, a = 1000, p = 0.02;
  const std::vector<Block> blocks = {block({10, 0, 0, 0, 10}, v), block({0, 10, 0, 0, 10}, v)};
  const double along = a * std::sqrt(2.0),
               half = 0.5 * along;  // of the path: the greatest share of an axis is 1 / sqrt(2)
  const double overlap = 2 * std::sqrt(0.5 * a * p / std::sqrt(0.5)) / (0.5 * a);
  EXPECT_NEAR(seconds(blocks, limits(a), linuxcnc(Corners::blend, p)),
              2 * from_rest(10 * std::sqrt(2.0), v, half) - overlap, 2.1e-3);
}

/// A path of random blocks that turn by little from one to the next.
std::vector<Block> random_path(std::mt19937_64& random, int blocks, bool rotary) {
  std::uniform_real_distribution<double> unit(-1, 1), length(0.05, 2);
  std::array<double, 5> u{1, 0, 0, 0, 0};
  std::vector<Block> path;
  for (int i = 0; i < blocks; ++i) {
    for (std::size_t j = 0; j < (rotary ? 5U : 3U); ++j) u[j] += (i % 9 ? 0.05 : 1) * unit(random);
    double norm = 0;
    for (const double c : u) norm += c * c;
    std::array<double, 5> step{};
    const double l = length(random);
    for (std::size_t j = 0; j < 5; ++j) u[j] /= std::sqrt(norm), step[j] = l * u[j];
    path.push_back(block(step, i / 20 % 2 ? 40 : 15));
    path.back().rapid = i % 37 == 36;
  }
  return path;
}

// A straight block in two halves is the same motion wherever the path does not stop at the joint.
TEST(PathTimer, SplittingChangesNothing) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> share(0.1, 0.9);
  const auto split = [&](const std::vector<Block>& path) {
    std::vector<Block> out;
    for (const Block& b : path) {
      if (b.rapid) {
        out.push_back(b);
        continue;
      }
      // Halves of halves of the length: exact, so that the direction is.
      Block part = b;
      const double s = std::ldexp(std::round(8 * share(random)), -3);
      for (double& c : part.step) c *= s;
      part.minutes *= s;
      out.push_back(part);
      for (std::size_t j = 0; j < 5; ++j) part.step[j] = b.step[j] - part.step[j];
      part.minutes = b.minutes - part.minutes;
      out.push_back(part);
    }
    return out;
  };
  for (int trial = 0; trial < 30; ++trial) {
    const auto path = random_path(random, 80, true);
    for (const double jerk : {0.0, 8000.0}) {
      const double whole = seconds(path, limits(600, jerk), jumping(4));
      EXPECT_NEAR(seconds(split(path), limits(600, jerk), jumping(4)), whole, 1e-7 * whole) << trial << " " << jerk;
    }
    // LinuxCNC's arcs at corners are no longer than the blocks beside them: there it counts how a line is divided. On a
    // line alone it does not.
    const std::vector<Block> line = {block({30 * share(random), 20, -8 * share(random), 0, 0}, 40)};
    auto parts = line;
    for (int k = 0; k < 2; ++k) parts = split(parts);  // each still takes many periods
    for (const Corners corners : {Corners::exact, Corners::blend}) {
      const PathControl control = linuxcnc(corners, 0.01);
      EXPECT_NEAR(seconds(parts, limits(600), control), seconds(line, limits(600), control), 1.1e-3) << trial;
    }
  }
}

// Never below what the program asks; no limit that grows costs time; it goes to what the program asks.
TEST(PathTimer, MonotoneInEveryLimit) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const auto path = random_path(random, 120, true);
    double asked = 0;
    for (const Block& b : path) asked += 60 * b.minutes;
    const AxisLimits base = limits(300, trial % 2 ? 9000 : 0, 30);
    const double now = seconds(path, base, jumping(3));
    EXPECT_GE(now, asked);
    for (std::size_t j = 0; j < 5; ++j) {
      AxisLimits more = base;
      more.acceleration[j] *= 1.7;
      EXPECT_LE(seconds(path, more, jumping(3)), now * (1 + 1e-9)) << trial << " " << j;
      more = base;
      more.speed[j] *= 1.7;
      EXPECT_LE(seconds(path, more, jumping(3)), now * (1 + 1e-9)) << trial << " " << j;
      more = base;
      more.jerk[j] *= 1.7;
      EXPECT_LE(seconds(path, more, jumping(3)), now * (1 + 1e-9)) << trial << " " << j;
    }
    EXPECT_NEAR(seconds(path, limits(1e12, 0, 1e9), jumping(3)), asked, 1e-6 * asked);
  }
}

/// LinuxCNC's trapezoid (tp.c, tpCalculateTrapezoidalAccel and tcUpdateDistFromAccel) period by period: one block from
/// rest to rest, seconds.
double periods_of(double length, double v_max, double a) {
  const double t = 0.001;
  double progress = 0, v = 0;
  int periods = 0;
  while (length - progress > 1e-12 && ++periods < 1000000) {
    const double left = length - progress;
    const double square = a * (2 * left - v * t) + 0.25 * a * a * t * t;
    const double wanted = -0.5 * a * t + (square > 0.25 * a * a * t * t ? std::sqrt(square) : 0);
    const double next = v + std::clamp((std::min(wanted, v_max) - v) / t, -a, a) * t;
    if (next < 0) {
      if (left < v * t) progress = length;
      v = 0;
    } else {
      progress = std::min(length, progress + 0.5 * (next + v) * t);
      v = next;
    }
  }
  return periods * t;
}

/// Time of blocks that turn under G61, by the rule in periods.
double simulated(const std::vector<Block>& blocks, double a) {
  double sum = 0;
  for (const Block& b : blocks) {
    double square = 0, greatest = 0;
    for (const double s : b.step) square += s * s, greatest = std::max(greatest, std::abs(s));
    const double length = std::sqrt(square);
    sum += periods_of(length, std::min(length / (60 * b.minutes), length / 0.00102), a * length / greatest);
  }
  return sum;
}

// Every block that turns stops under G61 and takes whole periods. That the accelerations count is seen at once: without
// them the time would be wrong by far more than 5 %.
TEST(PathTimer, AsLinuxcncInPeriods) {
  std::mt19937_64 random(8);
  for (const double a : {300.0, 2000.0}) {
    auto path = random_path(random, 400, true);
    for (Block& b : path) b.rapid = false;
    const double real = simulated(path, a);
    EXPECT_NEAR(seconds(path, limits(a), linuxcnc(Corners::exact)), real, 0.01 * real) << a;
    EXPECT_LT(seconds(path, limits(1e9), linuxcnc(Corners::exact)), 0.95 * real) << "acceleration ignored, " << a;
  }
}

// Lines that turn by less than a tenth of what the axes can in a period go on; the speed there is that of both.
TEST(PathTimer, GentleCornersUnderG61) {
  const double v = 10, a = 2000, bend = 0.1 * a * 0.001 / (v + a * 0.001);  // rad, where the stop begins
  for (const double share : {0.5, 0.95, 1.05}) {
    const double angle = share * bend;
    const std::vector<Block> blocks = {block({5, 0, 0, 0, 0}, v),
                                       block({5 * std::cos(angle), 5 * std::sin(angle), 0, 0, 0}, v)};
    const double slower = (1 - std::min(share, 1.0) * 0.1) * a;
    const double expected = share < 1 ? from_rest(10, v, slower) : 2 * from_rest(5, v, 0.9 * a);
    EXPECT_NEAR(seconds(blocks, limits(a), linuxcnc(Corners::exact)), expected, 2.1e-3) << share;
  }
}

}  // namespace
}  // namespace toothpath
