// What LinuxCNC's trajectory planner does at a corner between two straight blocks, written from its description in
// docs/dialects.md, against the bounds that stand there: with a stop at the corner (G61, G61.1) and with a parabolic
// blend (G64 P).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace toothpath {
namespace {

struct Point {
  double x = 0, y = 0;
};

struct Corner {
  double before_mm = 0, behind_mm = 0;  ///< lengths of the blocks
  double turn_rad = 0;                  ///< between them
  double feed_mm_s = 0;
  double acceleration = 0, period_s = 0;
  double tolerance_mm = 0;  ///< P; 0: stops at the corner
  double slower = 0;        ///< the first block accelerates by this part less
};

/// A block under the trapezoidal planner: the speed of the next sample is the largest from which it can still stop at
/// the end.
struct Block {
  double length = 0, acceleration = 0, at = 0, speed = 0;
  bool braking = false;  ///< on its last deceleration

  void step(double feed, double period) {
    const double half = acceleration * period / 2, left = length - at;
    const double under = acceleration * (2 * left - speed * period) + half * half;
    const double reachable = -half + (under > half * half ? std::sqrt(under) : 0);
    const double change = std::clamp((std::min(reachable, feed) - speed) / period, -acceleration, acceleration);
    const double next = speed + change * period;
    if (next < 0) {
      if (left < speed * period) at = length;
      speed = 0;
    } else {
      at = std::min(length, at + (next + speed) / 2 * period);
      speed = next;
    }
    braking = std::abs(reachable - speed) < 1e-8 && change < 0;
  }

  /// The end falls inside the next period.
  [[nodiscard]] bool ends_soon(double period) const {
    const double left = length - at;
    if (left <= 1e-12) return true;
    if (speed / 2 <= 1e-8) return false;
    double time = left / (speed / 2);
    if (speed / time > acceleration) {
      const double under = speed / acceleration * (speed / acceleration) - 2 / acceleration * left;
      if (under < 0) return false;
      time = speed / acceleration - std::sqrt(under);
    }
    return time < period;
  }
};

/// The speed below which the second block begins.
double blend_speed(const Corner& c, const Block& first, const Block& second) {
  const auto reachable = [&](const Block& b) { return std::min(std::sqrt(b.acceleration * b.length), c.feed_mm_s); };
  const double v1 = reachable(first), v2 = reachable(second);
  const double time = std::min(std::min(first.length / v1, second.length / v2),
                               std::max(v1 / first.acceleration, v2 / second.acceleration));
  return std::min(
      {v1, time * first.acceleration, 2 * std::sqrt(first.acceleration * c.tolerance_mm / std::sin(c.turn_rad / 2))});
}

/// The points that the joints are sent, the corner in the origin.
std::vector<Point> executed(const Corner& c) {
  const bool stops = c.tolerance_mm == 0;
  const double half = stops ? 1 : 0.5;
  Block first{c.before_mm, half * c.acceleration * (1 - c.slower)}, second{c.behind_mm, half * c.acceleration};
  std::vector<Point> planned;
  bool done = false, blending = false;
  while (second.at < 0.6 * c.behind_mm && planned.size() < 100000) {
    if (done) {
      second.step(c.feed_mm_s, c.period_s);
    } else if (!stops && first.ends_soon(c.period_s)) {
      first.at = first.length;
      done = true;
      second.step(c.feed_mm_s, c.period_s);
    } else {
      first.step(c.feed_mm_s, c.period_s);
      if (stops) {
        done = first.length - first.at <= 1e-12;
      } else {
        blending = blending || (first.braking && first.speed < blend_speed(c, first, second));
        if (blending) second.step(c.feed_mm_s, c.period_s);
      }
    }
    planned.push_back({first.at - first.length + std::cos(c.turn_rad) * second.at, std::sin(c.turn_rad) * second.at});
  }
  std::vector<Point> out;
  for (std::size_t k = 1; k + 1 < planned.size(); ++k)
    out.push_back({(planned[k - 1].x + 4 * planned[k].x + planned[k + 1].x) / 6,
                   (planned[k - 1].y + 4 * planned[k].y + planned[k + 1].y) / 6});
  return out;
}

double distance(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
  const double t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0;
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

struct Left {
  double corner = 0;  ///< distance of the corner from the polyline of the points
  double off = 0;     ///< greatest distance of a point from the two blocks
};

Left left_of(const Corner& c) {
  const auto points = executed(c);
  Left out{1e9, 0};
  const Point begin{-c.before_mm, 0}, end{std::cos(c.turn_rad) * c.behind_mm, std::sin(c.turn_rad) * c.behind_mm};
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (k > 0) out.corner = std::min(out.corner, distance({}, points[k - 1], points[k]));
    out.off = std::max(out.off, std::min(distance(points[k], begin, {}), distance(points[k], {}, end)));
  }
  return out;
}

/// The worst of many corners, blocks and speeds.
Left worst(double acceleration, double period, double tolerance) {
  std::mt19937_64 rng(29);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(rng); };
  Left most;
  for (int i = 0; i < 3000; ++i) {
    const Left l = left_of({uniform(0.02, 1), uniform(0.02, 1), uniform(0.05, 3.1), uniform(1, 60), acceleration,
                            period, tolerance, i % 2 ? 0.1 : 0});
    most.corner = std::max(most.corner, l.corner);
    most.off = std::max(most.off, l.off);
  }
  return most;
}

struct Servo {
  double acceleration, period, tolerance;
};
constexpr Servo kServos[] = {{2000, 1e-3, 3e-4}, {2000, 5e-4, 3e-4}, {500, 1e-3, 3e-4},
                             {5000, 1e-3, 3e-4}, {2000, 1e-3, 2e-3}, {300, 2.5e-4, 1e-3}};

TEST(CornerModel, AStopLeavesASixthAndIsOffByATwelfth) {
  for (const auto& [a, t, tolerance] : kServos) {
    const Left l = worst(a, t, 0);
    const double unit = a * t * t;
    EXPECT_LE(l.corner, unit / 6 * (1 + 1e-9)) << a << " " << t;
    EXPECT_GT(l.corner, 0.9 * unit / 6) << a << " " << t;
    EXPECT_LE(l.off, unit / 12 * (1 + 1e-9)) << a << " " << t;
    EXPECT_GT(l.off, 0.9 * unit / 12) << a << " " << t;
  }
}

TEST(CornerModel, AParabolaLeavesMoreThanItsTolerance) {
  for (const auto& [a, t, tolerance] : kServos) {
    const Left l = worst(a, t, tolerance);
    const double early = std::sqrt(1.06 * tolerance) + t / 2 * std::sqrt(a / 2),
                 bound = early * early + 0.3 * a * t * t;
    EXPECT_LE(std::max(l.corner, l.off), bound) << a << " " << t << " " << tolerance;
    EXPECT_GT(l.corner, 0.7 * bound) << a << " " << t << " " << tolerance;  // the bound is not far off
    EXPECT_GT(l.corner, 1.05 * tolerance) << a << " " << t << " " << tolerance;
  }
}

}  // namespace
}  // namespace toothpath
