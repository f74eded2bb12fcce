// Modified flanks under load: reliefs move and bend the lines; strips against cells and against brute force.
#include <gtest/gtest.h>

#include <random>

#include "geometry/loaded/line_of_tooth.h"
#include "tests/geometry/loaded/spur_pair.h"

namespace toothpath::test {
namespace {

const loaded::LoadedPair& plain_pair() {
  static const loaded::LoadedPair pair = spur_pair();
  return pair;
}
loaded::LoadedPair with(double crown, double tip) {
  loaded::LoadedPair pair = plain_pair();
  pair.rings[0].removal = relieved(pair.rings[0], crown, tip, 1);
  return pair;
}

/// Every place of the line has the least gap of all places of the flank with its B, searched without derivatives.
TEST(ModifiedLine, IsTheValleyThatBruteForceFinds) {
  const loaded::LoadedPair pair = with(0.008, 0.012);
  const loaded::PairRing& ring = pair.rings[0];
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0.05, 0.95);
  int shifted = 0;
  for (const double phase : {0.0, 0.35, 0.7}) {
    const double phi = 2 * kPi / 20 * phase;
    const loaded::LineOfTooth line(ring.surface, 1, phi, ring.bounds, &ring.moved, {&ring.removal, 0});
    double from = 0, to = 0;
    ASSERT_TRUE(line.find(from, to));
    for (int k = 0; k < 10; ++k) {
      const double B = from + (to - from) * share(random);
      const auto found = line.at(B);
      double best = 1e300, best_theta = 0;
      for (int n = -2000; n <= 2000; ++n) {
        const double theta = found.theta + n * 1e-4;
        if (!(theta > 1e-3)) continue;
        const double gap = line.at(theta, B).gap;
        if (gap < best) best = gap, best_theta = theta;
      }
      EXPECT_NEAR(found.theta, best_theta, 1.01e-4);
      EXPECT_LE(found.gap, best + 1e-12);
      const double plain = loaded::line_theta(ring.surface, 1, B, phi);
      if (std::abs(plain - found.theta) > 1e-3) ++shifted;
    }
  }
  EXPECT_GT(shifted, 5) << "a relief moves the line off that of the plain flanks";
}

/// A slope t across a line of curvature k makes a valley deeper by t^2/2k: the relief on the plain line is too much.
TEST(ModifiedLine, LiesDeeperThanTheReliefOnThePlainLine) {
  const loaded::LoadedPair pair = with(0, 0.012);
  const loaded::PairRing& ring = pair.rings[0];
  const loaded::LineOfTooth line(ring.surface, 1, 0.15, ring.bounds, &ring.moved, {&ring.removal, 0}),
      plain(ring.surface, 1, 0.15, ring.bounds, nullptr);
  double from = 0, to = 0;
  ASSERT_TRUE(plain.find(from, to));
  int judged = 0;
  for (int k = 1; k < 40; ++k) {
    const double B = from + (to - from) * k / 40;
    auto there = plain.at(B);
    const auto here = line.at(B);
    const double on_plain = ring.removal(there.point);
    if (on_plain < 0.001) continue;
    plain.bend(there);
    auto bent = there;
    line.bend(bent);
    // The slope square to the line, in the tangent plane, by differences.
    const Vec3 along = (plain.at(B + 1e-5).point - plain.at(B - 1e-5).point).normalized(),
               across = there.normal.cross(along).normalized();
    const double h = 1e-3,
                 slope = (ring.removal(there.point + h * across) - ring.removal(there.point - h * across)) / (2 * h);
    EXPECT_GT(bent.curvature, there.curvature) << "a relief is convex";
    EXPECT_NEAR(on_plain - here.gap, slope * slope / (2 * bent.curvature), 0.1 * slope * slope / there.curvature);
    ++judged;
  }
  EXPECT_GT(judged, 3);
}

TEST(ModifiedPair, StripsAndCellsAgree) {
  // 20 N m, tip relief of the gear and crowning. With the relief as a gap on the plain line: approach 1.6 % too large,
  // load of the relieved tooth 4 % too small, pressure 7 % too small (docs/loaded_contact.md 5).
  loaded::LoadedPair pair = with(0.008, 0.012);
  const auto strips = spur_position(pair, 20, 0.5);
  pair.options.cells = true;
  const auto cells = spur_position(pair, 20, 0.5);
  EXPECT_NEAR(strips.approach_mm, cells.approach_mm, 0.006 * cells.approach_mm);
  EXPECT_NEAR(force_of_tooth(strips, 0), force_of_tooth(cells, 0), 0.015 * force_of_tooth(cells, 0));
  EXPECT_NEAR(strips.pressure, cells.pressure, 0.03 * cells.pressure);
}

TEST(ModifiedPair, ARemovalOfNothingIsThePlainPair) {
  loaded::LoadedPair pair = plain_pair();
  pair.rings[0].removal = [](const Vec3&) { return 0.0; };
  for (const double phase : {0.1, 0.6}) {
    const auto plain = spur_position(plain_pair(), 50, phase), same = spur_position(pair, 50, phase);
    EXPECT_NEAR(same.approach_mm, plain.approach_mm, 1e-5 * plain.approach_mm);
    EXPECT_NEAR(same.pressure, plain.pressure, 1e-3 * plain.pressure);
  }
}

/// The zero of the approach is the first touch, wherever the pieces lie.
TEST(ModifiedPair, ApproachDoesNotHangOnThePieces) {
  loaded::LoadedPair pair = with(0.008, 0.012);
  const double fine = spur_position(pair, 20, 0.5).approach_mm;
  pair.options.segment_mm = 0.6;
  EXPECT_NEAR(spur_position(pair, 20, 0.5).approach_mm, fine, 0.01 * fine);
}

/// Crowning relieves the ends of the face, not the ends of lines: a line that begins in the middle of the face, where
/// the pinion's involute does, is pressed more there, on strips and on cells alike.
TEST(ModifiedPair, CrowningLoadsLineEndsInTheMiddleOfTheFace) {
  const auto near_end = [](const loaded::LoadedPosition& p) {  // the load within 0.5 mm of the start of the involute
    double from = 1e300, sum = 0;
    for (const auto& s : p.segments)
      if (s.place.tooth == 0 && s.force > 0) from = std::min(from, s.place.r);
    for (const auto& s : p.segments)
      if (s.place.tooth == 0 && s.place.r < from + 0.5) sum += s.force;
    EXPECT_NEAR(from, (kSpurInner + kSpurOuter) / 2, 1.3) << "in the middle of the face";
    return sum;
  };
  loaded::LoadedPair plain = plain_pair(), crowned = with(0.008, 0);
  const auto on_strips = spur_position(plain, 20, 10.0 / 12), crowned_strips = spur_position(crowned, 20, 10.0 / 12);
  EXPECT_GT(crowned_strips.end_pressure, 1.2 * on_strips.end_pressure);
  plain.options.cells = crowned.options.cells = true;
  const auto on_cells = spur_position(plain, 20, 10.0 / 12), crowned_cells = spur_position(crowned, 20, 10.0 / 12);
  EXPECT_GT(near_end(crowned_strips), 1.2 * near_end(on_strips));
  EXPECT_GT(near_end(crowned_cells), 1.2 * near_end(on_cells));
}

}  // namespace
}  // namespace toothpath::test
