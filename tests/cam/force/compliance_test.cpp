// A mill as a cantilever: closed forms of uniform, stepped and conical beams, a sum of thin slices for any profile,
// Maxwell's exchange of places, and the table of stiffness of the specification of line contact, section 9.
#include "cam/force/compliance.h"

#include <gtest/gtest.h>

#include "cam/finger/finger_profile.h"
#include "tests/cam/force/mills.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using force::Compliance;
using force::Elasticity;

Compliance of(const tool::Profile& mill, double load, double at, const Elasticity& e = {}) {
  const auto c = force::compliance(mill, load, at, e);
  if (!c) {
    ADD_FAILURE() << c.error().message;
    return {};
  }
  return *c;
}

double inertia(double d) { return kPi * std::pow(d, 4) / 64; }

/// 1000 slices of every piece, each by Simpson: no code in common with what is tested.
Compliance slices(const tool::Profile& mill, double load, double at, const Elasticity& e) {
  Compliance sum;
  const double G = e.youngs_modulus_N_mm2 / (2 * (1 + e.poisson)), k = 6 * (1 + e.poisson) / (7 + 6 * e.poisson);
  for (const auto& [meridian, share] : {std::pair(&mill.cutting(), e.flute_share), std::pair(&mill.shank(), 1.0)})
    for (const auto& p : meridian->pieces()) {
      const double low = std::max({p.from[0], load, at}), high = p.to[0];
      if (high <= low) continue;
      const auto add = [&, share = share](double h, double weight) {
        double r = p.from[1] + (p.to[1] - p.from[1]) * (h - p.from[0]) / (p.to[0] - p.from[0]);
        if (p.bend != 0) {
          const auto c = tool::circle_of<double>(p);
          const double x = h - c.centre[0], y = std::sqrt(std::max(0.0, c.R * c.R - x * x));
          r = p.bend > 0 ? c.centre[1] + y : c.centre[1] - y;
        }
        const double d = 2 * r * share;
        sum.bending += weight * (h - load) * (h - at) / (e.youngs_modulus_N_mm2 * inertia(d));
        sum.shear += weight / (k * G * kPi * d * d / 4);
      };
      constexpr int kSlices = 1000;
      const double dh = (high - low) / kSlices;
      for (int i = 0; i < kSlices; ++i) {
        add(low + i * dh, dh / 6);
        add(low + (i + 0.5) * dh, dh * 4 / 6);
        add(low + (i + 1) * dh, dh / 6);
      }
    }
  return sum;
}

// A straight rod without flutes: L^3 / (3 E I), and L / (k G A) of shear.
TEST(Compliance, UniformBeam) {
  const tool::Profile rod(line({{0, 2}, {5, 2}}), line({{5, 2}, {30, 2}}), line({{30, 9}, {50, 9}}));
  Elasticity e;
  e.flute_share = 1;
  for (const double a : {0.5, 3.0, 12.0}) {
    const double L = 30 - a;
    const Compliance c = of(rod, a, a, e);
    EXPECT_NEAR(c.bending / (L * L * L / (3 * 600e3 * inertia(4))), 1, 1e-12);
    const double nu = 0.22, G = 600e3 / (2 * (1 + nu)), k = 6 * (1 + nu) / (7 + 6 * nu);
    EXPECT_NEAR(c.shear / (L / (k * G * kPi * 4)), 1, 1e-12);
    // Deflection beside the force: P a^2 (3 L - a) / (6 E I) of the textbook, from the clamp.
    const double x = 30 - a, y = 30 - 0.25;
    EXPECT_NEAR(of(rod, a, 0.25, e).bending / (x * x * (3 * y - x) / (6 * 600e3 * inertia(4))), 1, 1e-12);
  }
}

// Flutes bear with 0.8 of their diameter; a neck and a shank above it.
TEST(Compliance, SteppedBeam) {
  const tool::Profile mill(line({{0, 0.5}, {3, 0.5}}), line({{3, 0.4}, {8, 0.4}, {8, 2}, {20, 2}}),
                           line({{20, 5}, {30, 5}}));
  const double a = 0.5, EI = 600e3;
  const auto piece = [&](double low, double high, double d) {
    return (std::pow(high - a, 3) - std::pow(low - a, 3)) / (3 * EI * inertia(d));
  };
  EXPECT_NEAR(of(mill, a, a).bending / (piece(a, 3, 0.8) + piece(3, 8, 0.8) + piece(8, 20, 4)), 1, 1e-12);
  // Half the modulus, twice the deflection; shear and bending alike.
  Elasticity soft;
  soft.youngs_modulus_N_mm2 = 300e3;
  EXPECT_NEAR(of(mill, a, a, soft).total() / of(mill, a, a).total(), 2, 1e-12);
  // Thinner in the flutes by a tenth of the diameter: that part alone grows, by 0.8^-4/0.9^-4.
  Elasticity full;
  full.flute_share = 1;
  EXPECT_NEAR((of(mill, a, a).bending - of(mill, a, a, full).bending) / (piece(a, 3, 1.0) * (std::pow(0.8, -4) - 1)), 1,
              1e-11);
}

// A cone with the force on its small end: L^3 / (3 E I_0) (d_0/d_1)^3, I_0 of the small end.
TEST(Compliance, ConicalBeam) {
  for (const double d1 : {1.0, 1.001, 2.0, 6.0, 60.0}) {
    const double d0 = 1, L = 20, below = 1e-3;
    const double slope = (d1 - d0) / 2 / L;
    const tool::Profile cone(line({{0, d0 / 2 - slope * below}, {below, d0 / 2}}),
                             line({{below, d0 / 2}, {below + L, d1 / 2}}), line({{below + L, 40}, {60, 40}}));
    const Compliance c = of(cone, below, below);
    EXPECT_NEAR(c.bending / (L * L * L / (3 * 600e3 * inertia(d0)) * std::pow(d0 / d1, 3)), 1, 1e-9) << d1;
    const double nu = 0.22, G = 600e3 / (2 * (1 + nu)), k = 6 * (1 + nu) / (7 + 6 * nu);
    EXPECT_NEAR(c.shear / (4 * L / (k * G * kPi * d0 * d1)), 1, 1e-9) << d1;
  }
}

TEST(Compliance, AnyProfileAgainstThinSlices) {
  Random random(5);
  std::vector<tool::Profile> mills = {made(ball_data(0.25, 3.2, 0.46, 14)), made(ball_data(2, 14, 6, 25)),
                                      made(tapered_data(0.25, 7, 4, 6, 20)), made(tapered_data(1, 5, 16, 8, 32))};
  tool::CutterData barrel = tapered_data(1, 8, 4, 8, 30);
  barrel.shape = tool::CutterShape::barrel;
  barrel.meridian_radius_mm = 60;
  mills.push_back(made(barrel));
  barrel.meridian_radius_mm = -50;
  mills.push_back(made(barrel));
  tool::CutterData nose = ball_data(3, 10, 6, 30);
  nose.shape = tool::CutterShape::bull_nose;
  nose.corner_radius_mm = 0.5;
  mills.push_back(made(nose));
  for (const auto& mill : mills)
    for (int i = 0; i < 5; ++i) {
      Elasticity e;
      e.youngs_modulus_N_mm2 = random(200e3, 650e3);
      e.flute_share = random(0.6, 1);
      const double a = random(0.2, 4), b = random(0.2, 4);
      const Compliance ours = of(mill, a, b, e), theirs = slices(mill, a, b, e);
      EXPECT_NEAR(ours.bending / theirs.bending, 1, 1e-6);
      EXPECT_NEAR(ours.shear / theirs.shear, 1, 1e-6);
      // Maxwell: the places of force and deflection may be exchanged.
      EXPECT_EQ(of(mill, b, a, e).bending, ours.bending);
      // A force nearer to the holder bends less.
      EXPECT_LT(of(mill, a + 1, a + 1, e).total(), of(mill, a, a, e).total());
    }
}

// Section 9 of the specification, bending alone, to what its digits say. The table names no length of the flutes: 13 mm
// for the small mills and 16 mm for the large ones meet all its rows; half way up a line of 3.1 mm, of 12.4 mm.
TEST(Compliance, TheTableOfTheSpecification) {
  struct Row {
    double r_0, half_angle, shank, stick_out, um_N, digit;
  };
  for (const Row& row :
       {Row{0.25, 3, 4, 22, 13.3, 0.05}, Row{0.25, 5, 4, 20, 3.2, 0.05}, Row{0.25, 5, 6, 20, 3.2, 0.05},
        Row{0.25, 7, 6, 20, 1.2, 0.05}, Row{0.25, 10, 6, 16, 0.37, 0.005}, Row{1.0, 5, 8, 32, 0.21, 0.005},
        Row{1.0, 10, 12, 32, 0.03, 0.005}}) {
    const bool small = row.r_0 < 0.5;
    const auto mill = made(tapered_data(row.r_0, row.half_angle, small ? 13 : 16, row.shank, row.stick_out));
    const double h = small ? 1.55 : 6.2, um_N = 1000 * of(mill, h, h).bending;
    EXPECT_NEAR(um_N, row.um_N, row.digit + 0.03 * row.um_N) << row.r_0 << " " << row.half_angle;
  }
}

// The ball R0.25 with a neck of 0.46 over 5 mm, stick-out 14: 66 um/N in the table, which names no height; it is
// met 1.85 mm above the tip. The neck of the sample goes on to the holder: ten times as much, at the centre of the
// ball.
TEST(Compliance, TheNeckOfTheOldSample) {
  const tool::Profile neck(made(ball_data(0.25, 3.2, 0.46, 14)).cutting(),
                           line({{3.2, 0.23}, {8.2, 0.23}, {8.2, 2}, {14, 2}}), line({{14, 5}, {40, 5}}));
  EXPECT_NEAR(1000 * of(neck, 1.85, 1.85).bending, 66, 2);
  const auto sample = made(ball_data(0.25, 3.2, 0.46, 14));
  EXPECT_GT(1000 * of(sample, 0.25, 0.25).total(), 600);
}

TEST(Compliance, RefusesWhatIsNoBeam) {
  const auto mill = made(ball_data(1, 6, 4, 20));
  EXPECT_EQ(force::clamped_at(mill), 20);
  EXPECT_FALSE(force::compliance(mill, 0, 1));
  EXPECT_FALSE(force::compliance(mill, 1, 20));
  EXPECT_FALSE(force::compliance(mill, NAN, 1));
  const auto refused = force::compliance(mill, 25, 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("25.0000"), std::string::npos);
  // A waist of nothing bends without end.
  const tool::Profile waist(line({{0, 1}, {5, 0}, {10, 1}}), line({{10, 1}, {20, 1}}), line({{20, 3}, {25, 3}}));
  EXPECT_FALSE(force::compliance(waist, 1, 1));
}

}  // namespace
}  // namespace toothpath::test
