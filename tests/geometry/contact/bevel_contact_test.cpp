// Contact of the bevel pair against a search that knows no closed form, and against what must be true of any pair.
#include "geometry/contact/bevel_contact.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;

constexpr contact::BevelContactOptions kCoarse{9, 7, 16, 0.006};

/// Turn of the pinion at which the clearance to the wheel vanishes: points of the pinion's wall (not of the wheel's),
/// the wheel's wall as azimuths over (ell, height), bisection over the turn. Other role, other frame, other search.
double turn_by_bisection(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel, int sigma,
                         double phi_2, double near, int density) {
  const auto &wall = pinion.halves()[0].wall(sigma), &mate = wheel.halves()[0].wall(sigma);
  std::vector<Vec3> points;
  const double from = pinion.halves()[0].ell_from, to = pinion.halves()[0].ell_to;
  for (int i = 0; i <= 5 * density; ++i)
    for (int j = 0; j <= 4 * density; ++j) {
      const double ell = from + (to - from) * i / (5 * density), height = -3.9 + 8.0 * j / (4 * density);
      const auto q = bevel_gear::bevel_inverse(wall, ell, height);
      if (q) points.push_back(wall.point(q->beta, q->p).p);
    }
  const double s1 = pinion.sin_delta(), c1 = pinion.cos_delta(), s2 = wheel.sin_delta(), c2 = wheel.cos_delta();
  const auto clearance = [&](double phi_1) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& p : points) {
      // Pinion tooth to azimuth 0, turned; then by coordinates along pitch line, normal and tangent into the wheel's
      // frame.
      const double turn = phi_1 + sigma * pinion.pitch() / 2;
      const Vec3 q(std::cos(turn) * p.x() - std::sin(turn) * p.y(), std::sin(turn) * p.x() + std::cos(turn) * p.y(),
                   p.z());
      const double along = s1 * q.x() + c1 * q.z(), out = c1 * q.x() - s1 * q.z(), across = q.y();
      const Vec3 w(s2 * along - c2 * out, -across, c2 * along + s2 * out);
      const bevel_gear::ConePoint c = bevel_gear::cone_point(w, s2, c2);
      if (c.ell < wheel.halves()[0].ell_from || c.ell > wheel.halves()[0].ell_to ||
          c.height > wheel.parameters().addendum_mm)
        continue;
      const auto found = bevel_gear::bevel_inverse(mate, c.ell, c.height);
      if (!found) continue;
      // The wheel's wall L faces its growing azimuth, which is the pinion's falling one: room is where the pinion's
      // point lies beyond.
      least = std::min(least, sigma * std::remainder(c.azimuth - phi_2 - found->azimuth, 2 * kPi));
    }
    return least;
  };
  double low = near - 2e-3, high = near + 2e-3;  // clearance falls with sigma * turn
  for (int k = 0; k < 40; ++k) {
    const double middle = (low + high) / 2;
    ((clearance(middle) > 0) == (sigma > 0) ? low : high) = middle;
  }
  return (low + high) / 2;
}

class BevelContactOf : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Walls, BevelContactOf, testing::Values(1, -1));

TEST_P(BevelContactOf, TurnOfThePairIsThatOfASearch) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  const auto pair = contact::BevelPair::make(pinion, wheel);
  ASSERT_TRUE(pair) << pair.error().message;
  const auto contact = bevel_contact(*pair, GetParam(), kCoarse);
  ASSERT_TRUE(contact) << contact.error().message;
  for (const std::size_t k : {std::size_t{1}, std::size_t{9}}) {
    const contact::BevelPosition& at = contact->cycle[k];
    // The pair that touches, brought to where pair 0 is.
    const double phi_2 = at.phi_2 + at.tooth * wheel.pitch(), phi_1 = at.phi_1 - at.tooth * pinion.pitch();
    // The search sees the wall at its places only: it stops no earlier than the first contact, and comes nearer with
    // more of them.
    const auto excess = [&](int density) {
      return GetParam() * (turn_by_bisection(pinion, wheel, GetParam(), phi_2, phi_1, density) - phi_1);
    };
    const double coarse = excess(6), fine = excess(24);
    EXPECT_GE(coarse, -2e-7) << k;
    EXPECT_GE(fine, -2e-7) << k;
    EXPECT_LE(fine, std::max(0.6 * coarse, 2e-5)) << k;
    EXPECT_LE(fine, 1.5e-4) << k;
  }
}

TEST_P(BevelContactOf, MirroredPairRunsTheSameWay) {
  auto p = w1(), w = w2();
  const auto contact_of = [&](int sigma) {
    const auto pinion = made(p, pinion_mill()), wheel = made(w, wheel_mill());
    return bevel_contact(*contact::BevelPair::make(pinion, wheel), sigma, kCoarse).value();
  };
  const contact::BevelContact one = contact_of(GetParam());
  p.hand = -p.hand;
  w.hand = -w.hand;
  const contact::BevelContact other = contact_of(-GetParam());
  EXPECT_NEAR(one.error_range_rad, other.error_range_rad, 1e-9);
  EXPECT_NEAR(one.mismatch_rms_mm, other.mismatch_rms_mm, 1e-9);
  EXPECT_NEAR(one.mismatch_max_mm, other.mismatch_max_mm, 1e-8);
}

TEST_P(BevelContactOf, GapsAreNeverNegativeAndSomePlaceTouches) {
  const auto pinion = made(w3(), pinion_mill()), wheel = made(w4(), wheel_mill());
  const auto pair = contact::BevelPair::make(pinion, wheel);
  const auto contact = bevel_contact(*pair, GetParam(), kCoarse);
  ASSERT_TRUE(contact) << contact.error().message;
  double least = 1;
  for (const auto& g : contact->patterns)
    for (const double gap : g.gap_mm)
      if (!std::isnan(gap)) {
        EXPECT_GE(gap, 0);
        least = std::min(least, gap);
      }
  EXPECT_LT(least, 0.002);
  ASSERT_EQ(contact->patterns.size(), 2u);
  for (const auto& at : contact->cycle) EXPECT_GE(at.marking, 1);
}

// What is found about W1/W2 and W3/W4: tens of micrometres of mismatch, so not conjugate; the numbers stand in
// docs/bevel_gear.md.
TEST(BevelContact, ThePairIsNotConjugate) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  const auto pair = contact::BevelPair::make(pinion, wheel);
  const auto L = bevel_contact(*pair, 1, kCoarse), U = bevel_contact(*pair, -1, kCoarse);
  ASSERT_TRUE(L && U);
  EXPECT_GT(L->mismatch_rms_mm, 0.005);
  EXPECT_LT(L->mismatch_rms_mm, 0.030);
  EXPECT_GT(L->error_range_rad, 10 * U->error_range_rad);
}

TEST(BevelContact, MisalignmentMovesThePairByWhatItMust) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  // Two members drawn back by equal parts of play: the pinion turns further by play over the lever on both walls.
  const auto mean = [&](const contact::BevelAssembly& a, int sigma) {
    return bevel_contact(*contact::BevelPair::make(pinion, wheel, a), sigma, kCoarse).value().error_mean_rad;
  };
  contact::BevelAssembly away;
  away.wheel_axial_mm =
      0.1;  // away from the apex: towards more play, about 0.1 sin(delta_2) 2 tan(alpha_n)/cos(beta) in all
  const double play = mean(away, 1) + mean(away, -1) - mean({}, 1) - mean({}, -1);
  const double expected =
      0.1 * wheel.sin_delta() * 2 * std::tan(radians(20)) / (std::cos(radians(37)) * pinion.R_m() * pinion.sin_delta());
  EXPECT_GT(play, 0.5 * expected);
  EXPECT_LT(play, 2.0 * expected);
}

TEST(BevelContact, ChangesLowerTheMismatchWhenRolledAgain) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  const auto changes = contact::mismatch_changes(pinion, wheel, {5, 7, 12, 0.006});
  ASSERT_TRUE(changes) << changes.error().message;
  ASSERT_EQ(changes->size(), 22u);
  for (const auto& c : *changes) EXPECT_LE(c.rms_after_mm, c.rms_before_mm * (c.measured ? 1.02 : 1 + 1e-9)) << c.name;
  EXPECT_TRUE(changes->back().measured);
  EXPECT_LT(changes->back().rms_after_mm, 0.6 * changes->back().rms_before_mm);
}

TEST(BevelContact, WhatIsNoPairIsRefused) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill()),
             herringbone = made(w4(), wheel_mill());
  EXPECT_NE(contact::BevelPair::make(pinion, pinion).error().message.find("add up to the shaft angle"),
            std::string::npos);
  EXPECT_NE(contact::BevelPair::make(pinion, herringbone).error().message.find("herringbone"), std::string::npos);
  auto same = w2();
  same.hand = 1;
  const auto same_hand = made(same, wheel_mill());
  EXPECT_NE(contact::BevelPair::make(pinion, same_hand).error().message.find("opposite hands"), std::string::npos);
  EXPECT_NE(bevel_contact(*contact::BevelPair::make(pinion, wheel), 1, {2, 2, 2, 0.006}).error().message.find("3 x 3"),
            std::string::npos);
  const auto mate = contact::bevel_mate(made(w2(), wheel_mill()));
  ASSERT_TRUE(mate) << mate.error().message;
  EXPECT_EQ(mate->parameters().teeth, 18);
  EXPECT_EQ(mate->parameters().hand, 1);
}

}  // namespace
}  // namespace toothpath
