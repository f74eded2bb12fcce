// Lines of contact of a face gear and the pinion that is its shaper: closed form, curvature of rank one, worked
// lengths.
#include "geometry/loaded/contact_line.h"

#include <gtest/gtest.h>

#include "geometry/contact/pinion.h"
#include "tests/geometry/loaded/trial_gear.h"
#include "tests/support/fifty_digits.h"

namespace toothpath::test {
namespace {

std::vector<loaded::ContactLine> lines_of(const face_gear::FaceGear& gear, int ring, int side, double phase,
                                          double approach = 0) {
  const auto& r = gear.rings()[static_cast<std::size_t>(ring)];
  const auto bounds = loaded::contact_bounds(r.surface, side, r.zone.inner_radius_mm, r.zone.outer_radius_mm, 0.05);
  if (!bounds) throw std::invalid_argument(bounds.error().message);
  loaded::LineOptions options;
  options.approach_mm = approach;
  return loaded::contact_lines(r.surface, ring, side, 2 * kPi / r.surface.shaper.teeth * phase, *bounds, options);
}

TEST(ContactLine, LengthsOfTrialFour) {
  const auto gear = trial_gear();
  const auto whole = lines_of(gear, 1, 1, 0);
  ASSERT_EQ(whole.size(), 2u);
  EXPECT_EQ(whole[0].tooth, -1);
  EXPECT_NEAR(whole[0].length, 2.885, 2e-3);
  EXPECT_NEAR(whole[1].length, 37.083, 2e-3);
  const auto half = lines_of(gear, 1, 1, 0.5);
  ASSERT_EQ(half.size(), 2u);
  EXPECT_NEAR(half[0].length, 38.315, 2e-3);
  EXPECT_NEAR(half[1].length, 14.822, 2e-3);
}

TEST(ContactLine, PlacesTouchThePinionAtTheirTurn) {
  const auto gear = trial_gear();
  for (const int ring : {0, 1})
    for (const int side : {1, -1}) {
      const auto& f = gear.rings()[static_cast<std::size_t>(ring)].surface;
      const auto pinion = contact::make_pinion(f, f.shaper.teeth);
      int places = 0;
      for (const auto& line : lines_of(gear, ring, side, 0.3))
        for (const auto& s : line.segments) {
          ++places;
          const double phi = 2 * kPi / f.shaper.teeth * (0.3 + line.tooth);
          EXPECT_NEAR(f.flank_phi(side, s.theta, s.B), phi, 1e-12);
          EXPECT_NEAR(pinion.gap(side, pinion.place(s.point), phi), 0, 1e-9);
          EXPECT_NEAR(s.normal.dot(s.along), 0, 1e-3);
        }
      EXPECT_GT(places, 20);
    }
}

TEST(ContactLine, RelativeCurvatureHasRankOneIn50Digits) {
  const auto gear = trial_gear();
  const auto wide = face_gear::make_surface<F50>(gear.parameters(), gear.parameters().zones[1].helix_angle_rad);
  for (const auto& line : lines_of(gear, 1, 1, 0))
    for (const auto& s : line.segments) {
      const auto H = loaded::relative_curvature(gear.rings()[1].surface, 1, s.theta, s.B);
      const double trace = H.ee + H.ll;
      EXPECT_LT(std::abs(H.gauss()), 1e-15 * trace * trace);
      EXPECT_GT(1 / trace, 28 - 1);
      EXPECT_LT(1 / trace, 48 + 1);
      const auto exact = loaded::relative_curvature(wide, 1, F50(s.theta), F50(s.B));
      const F50 sum = exact.ee + exact.ll;
      EXPECT_LT(static_cast<double>(abs(exact.gauss())), 1e-45 * static_cast<double>(sum * sum));
      // The line runs where nothing bends: its direction has no relative curvature.
      const auto basis = gear.rings()[1].surface.flank_basis(1, s.theta, s.B);
      const double turn = gear.rings()[1].surface.i * gear.rings()[1].surface.flank_phi(1, s.theta, s.B);
      const double e = turned(basis.e, turn).dot(s.along), l = turned(basis.l, turn).dot(s.along);
      EXPECT_LT(std::abs(H.ee * e * e + 2 * H.el * e * l + H.ll * l * l), 3e-4 * trace);
    }
}

TEST(ContactLine, GoesOnBeyondItsEnds) {
  const auto gear = trial_gear();
  const auto plain = lines_of(gear, 1, 1, 0), more = lines_of(gear, 1, 1, 0, 0.02);
  ASSERT_EQ(plain.size(), more.size());
  for (std::size_t n = 0; n < plain.size(); ++n) {
    EXPECT_GT(more[n].segments.size(), plain[n].segments.size());
    EXPECT_EQ(more[n].length, plain[n].length);
    for (const auto& s : more[n].segments) {
      EXPECT_GE(s.gap, 0);
      EXPECT_LE(s.gap, 0.0201);
    }
  }
}

TEST(ContactLine, AnUndercutFlankIsRefused) {
  const auto gear = trial_gear();
  const auto bounds = loaded::contact_bounds(gear.rings()[1].surface, 1, 480, 520, 0.05);
  ASSERT_FALSE(bounds);
  EXPECT_NE(bounds.error().message.find("undercut"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
