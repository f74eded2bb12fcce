// Corrected flanks: the fit against fields that it can hold, and the displaced sheet against differences of its own
// points.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "geometry/base/angle.h"
#include "geometry/face_gear/part.h"
#include "geometry/face_gear/space_sheet.h"
#include "geometry/inspection/grid.h"
#include "geometry/modification/flank_correction.h"
#include "tests/support/sample_gears.h"

namespace toothpath {
namespace {

face_gear::FaceGear gear_of(double offset, double helix_deg, double shaft_deg) {
  auto g = test::transverse_gear(88, 25, 3, 0.7, {{radians(helix_deg), 131.5, 144}});
  g.shaft_angle_rad = radians(shaft_deg);
  g.offset_mm = offset;
  return test::made(g);
}

std::vector<modification::FlankDeviation> field_on_grid(const face_gear::FaceGear& gear, int side,
                                                        const std::function<double(double, double)>& field) {
  std::vector<modification::FlankDeviation> out;
  const auto grid = inspection::inspection_grid(drawn_solid(gear));
  EXPECT_TRUE(grid);
  for (const auto& p : *grid)
    if (p.side == side)
      out.push_back(
          {p.row, p.column, p.theta, std::hypot(p.p.x(), p.p.y()), field(double(p.row) / 4, double(p.column) / 8)});
  return out;
}

/// 20 um of crowning, slope, twist and a little waviness; x along the profile, y along the face, 0 .. 1.
double rough(double x, double y) {
  return 0.02 * (0.4 * (2 * y - 1) + 0.5 * (2 * y - 1) * (2 * y - 1) * (1 - x) - 0.3 * x * x + 0.2 * std::sin(3 * y));
}

std::shared_ptr<const modification::RingCorrection> correction_of(const face_gear::FaceGear& gear) {
  const double theta_t = gear.rings()[0].surface.shaper.theta_t;
  modification::RingCorrection both;
  both.plus = *modification::FlankCorrection::fit(field_on_grid(gear, 1, rough), theta_t);
  both.minus = *modification::FlankCorrection::fit(
      field_on_grid(gear, -1, [](double x, double y) { return -rough(y, x); }), theta_t);
  return std::make_shared<modification::RingCorrection>(both);
}

TEST(FlankCorrection, HoldsAPolynomialExactlyAndStatesWhatIsLeft) {
  const auto gear = gear_of(15, 0, 90);
  const double theta_t = gear.rings()[0].surface.shaper.theta_t;
  const auto fit = modification::FlankCorrection::fit(field_on_grid(gear, 1, rough), theta_t);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->residual().points, 45u);
  EXPECT_GT(fit->residual().measured_max_mm, 0.015);
  EXPECT_LT(fit->residual().residual_max_mm, 5e-6);  // sin(3 y) beyond the sixth degree, and a top line that is a cubic
  // Alternating noise cannot be followed: the residual says so.
  const auto noise = modification::FlankCorrection::fit(
      field_on_grid(
          gear, 1,
          [](double x, double y) { return (int(std::lround(4 * x)) + int(std::lround(8 * y))) % 2 ? 1e-3 : -1e-3; }),
      theta_t);
  ASSERT_TRUE(noise);
  EXPECT_GT(noise->residual().residual_max_mm, 5e-4);
}

TEST(FlankCorrection, NoiseIsLeftOutAndShapeStays) {
  const auto gear = gear_of(15, 0, 90);
  const double theta_t = gear.rings()[0].surface.shaper.theta_t;
  constexpr double kNoise = 1e-4;
  std::mt19937 engine(7);
  std::normal_distribution<double> noise(0, kNoise);
  const auto fit = [&](const std::function<double(double, double)>& shape) {
    const auto made = modification::FlankCorrection::fit(
        field_on_grid(gear, 1, [&](double x, double y) { return shape(x, y) + noise(engine); }), theta_t);
    EXPECT_TRUE(made);
    return *made;
  };
  // A flank that stands off by 4 um all over: the target is as smooth as the nominal flank.
  int bent = 0;
  for (int k = 0; k < 40; ++k) {
    const auto even = fit([](double, double) { return 0.004; });
    EXPECT_NEAR(even.at(theta_t, 131.5).value, -0.004, 1e-3);
    bent += even.at(theta_t, 131.5).d_theta != 0 || even.at(theta_t, 131.5).d_along != 0;
  }
  EXPECT_LE(bent, 2) << "one of a hundred is expected";
  // What is larger than the noise is followed within it.
  const auto slope = fit(rough);
  const auto exact = modification::FlankCorrection::fit(field_on_grid(gear, 1, rough), theta_t);
  double off = 0;
  for (const auto& p : field_on_grid(gear, 1, rough))
    off = std::max(off, std::abs(slope.at(p.theta, p.along_mm).value - exact->at(p.theta, p.along_mm).value));
  EXPECT_LT(off, 4 * kNoise);
}

TEST(FlankCorrection, DerivativesAreThoseOfTheValue) {
  const auto gear = gear_of(15, 0, 90);
  const auto fit =
      modification::FlankCorrection::fit(field_on_grid(gear, -1, rough), gear.rings()[0].surface.shaper.theta_t);
  ASSERT_TRUE(fit);
  for (const double theta : {-0.05, 0.02, 0.2, 0.4, 0.56, 0.7})
    for (const double r : {120.0, 131.0, 133.0, 140.0, 144.5, 150.0}) {
      const double h = 1e-5, k = 1e-4;
      const auto at = fit->at(theta, r);
      EXPECT_NEAR(at.d_theta, (fit->at(theta + h, r).value - fit->at(theta - h, r).value) / (2 * h), 1e-7);
      EXPECT_NEAR(at.d_along, (fit->at(theta, r + k).value - fit->at(theta, r - k).value) / (2 * k), 1e-8);
    }
}

TEST(FlankCorrection, TooFewPointsAndWildNumbersAreRefused) {
  const auto gear = gear_of(15, 0, 90);
  auto points = field_on_grid(gear, 1, rough);
  auto few = points;
  std::erase_if(few, [](const modification::FlankDeviation& p) { return p.row == 2; });
  EXPECT_EQ(modification::FlankCorrection::fit(few, 0.6).error().message,
            "4 rows x 9 columns are too few to fit, at least 5 x 9 are needed");
  points[7].deviation_mm = NAN;
  EXPECT_EQ(modification::FlankCorrection::fit(points, 0.6).error().message,
            "row 0, column 7: the deviation or its place is not finite");
}

class CorrectedSheet : public testing::TestWithParam<std::array<double, 3>> {};

TEST_P(CorrectedSheet, DisplacesTheGridByMinusTheDeviation) {
  const auto [E, beta, gamma] = GetParam();
  const auto nominal = gear_of(E, beta, gamma), gear = nominal.corrected({correction_of(nominal)});
  const face_gear::SpaceSheet sheet(gear.parameters(), gear.rings()[0]);
  const auto grid = inspection::inspection_grid(drawn_solid(nominal));
  for (const auto& p : *grid) {
    const auto q = sheet.at(tooth_space::flank_of(p.side), p.theta, p.B);
    ASSERT_TRUE(q);
    const Vec3 at = p.side > 0 ? q->p : turned(q->p, -nominal.pitch());
    const double x = double(p.row) / 4, y = double(p.column) / 8, wanted = p.side > 0 ? -rough(x, y) : rough(y, x);
    EXPECT_NEAR((at - p.p).dot(p.n), wanted,
                gear.rings()[0].correction->side(p.side).residual().residual_max_mm + 1e-9);
    EXPECT_LT((at - p.p - p.n * (at - p.p).dot(p.n)).norm(), 1e-10);
  }
}

TEST_P(CorrectedSheet, NormalsAndDerivativesAreThoseOfThePoints) {
  const auto [E, beta, gamma] = GetParam();
  const auto nominal = gear_of(E, beta, gamma), gear = nominal.corrected({correction_of(nominal)});
  const face_gear::SpaceSheet sheet(gear.parameters(), gear.rings()[0]);
  const auto& f = gear.rings()[0].surface;
  std::mt19937_64 random(3);
  const auto between = [&](double a, double b) { return a + (b - a) * double(random() >> 11) * 0x1p-53; };
  int seen = 0;
  for (int k = 0; k < 200; ++k) {
    const bool flank = k % 2 == 0;
    const int side = k % 4 < 2 ? 1 : -1;
    const auto piece = flank ? tooth_space::flank_of(side) : tooth_space::fillet_of(side);
    const double u = flank ? between(0.1, f.shaper.theta_t) : between(f.shaper.A_t, f.shaper.A_e);
    const double v = flank ? side * between(0.3, 0.6) : (between(132, 142) + f.shaper.r_p * f.Cg) / f.Sg;
    const double h = 1e-5, g = flank ? 1e-5 : 1e-3;
    const auto q = sheet.at(piece, u, v), u0 = sheet.at(piece, u - h, v), u1 = sheet.at(piece, u + h, v),
               v0 = sheet.at(piece, u, v - g), v1 = sheet.at(piece, u, v + g);
    if (!q || !u0 || !u1 || !v0 || !v1) continue;
    ++seen;
    EXPECT_LT(((u1->p - u0->p) / (2 * h) - q->pu).norm(), 1e-5 * q->pu.norm());
    EXPECT_LT(((v1->p - v0->p) / (2 * g) - q->pv).norm(), 1e-5 * q->pv.norm());
    EXPECT_NEAR(q->n.norm(), 1, 1e-12);
    EXPECT_NEAR(q->n.dot(q->pu.normalized()), 0, 1e-12);
    // The nearest point of a point above the sheet is the point below it.
    const auto foot =
        sheet.foot(piece, q->p + (flank ? 0.8 : 0.3) * q->n, u + (flank ? 0.01 : 0.02), v + (flank ? 0.01 : 0.3));
    ASSERT_TRUE(foot);
    EXPECT_NEAR(foot->distance, flank ? 0.8 : 0.3, 1e-10);
  }
  EXPECT_GT(seen, 150);
}

TEST_P(CorrectedSheet, FlankFilletAndRootJoinSmoothly) {
  const auto [E, beta, gamma] = GetParam();
  const auto nominal = gear_of(E, beta, gamma), gear = nominal.corrected({correction_of(nominal)});
  const face_gear::SpaceSheet sheet(gear.parameters(), gear.rings()[0]);
  const auto& f = gear.rings()[0].surface;
  for (const int side : {1, -1}) {
    const auto fillet = tooth_space::fillet_of(side);
    const auto flank = tooth_space::flank_of(side);
    for (double radius = 132; radius <= 143.5; radius += 0.77) {
      const double Z = (std::sqrt(radius * radius - f.E * f.E) + f.shaper.r_p * f.Cg) / f.Sg;
      const auto g = f.fillet(side, f.shaper.A_t, Z);
      ASSERT_TRUE(g.defined);
      const auto a = sheet.at(flank, f.shaper.theta_t, g.B), b = sheet.at(fillet, f.shaper.A_t, Z);
      ASSERT_TRUE(a && b);
      EXPECT_LT((a->p - b->p).norm(), 1e-8);
      EXPECT_LT((a->n - b->n).norm(), 1e-6);
      const auto e = sheet.at(fillet, f.shaper.A_e, Z), r = sheet.at(tooth_space::Piece::root, side > 0 ? 0.0 : 1.0, Z);
      ASSERT_TRUE(e && r);
      EXPECT_LT((e->p - r->p).norm(), 1e-9);
      EXPECT_LT((e->n - r->n).norm(), 1e-9);
    }
  }
}

TEST_P(CorrectedSheet, TipEdgeLiesOnTheTipSurface) {
  const auto [E, beta, gamma] = GetParam();
  const auto nominal = gear_of(E, beta, gamma), gear = nominal.corrected({correction_of(nominal)});
  const face_gear::SpaceSheet sheet(gear.parameters(), gear.rings()[0]),
      plain(nominal.parameters(), nominal.rings()[0]);
  for (const int side : {1, -1})
    for (const double r : {131.5, 135.0, 144.0}) {
      const auto tip = sheet.tip_edge(side, r), before = plain.tip_edge(side, r);
      ASSERT_TRUE(tip && before);
      auto p = sheet.at(tooth_space::flank_of(side), tip->u, tip->v)->p;
      if (side < 0) p = turned(p, -nominal.pitch());
      EXPECT_NEAR(std::hypot(p.x(), p.y()), r, 1e-9);
      EXPECT_NEAR(p.z(), gear.rings()[0].surface.z_tip(r), 1e-9);
      EXPECT_NEAR(std::remainder(std::atan2(p.y(), p.x()) - tip->azimuth, 2 * kPi), 0, 1e-12);
      EXPECT_LT(std::abs(tip->azimuth - before->azimuth) * r, 0.05);
    }
}

INSTANTIATE_TEST_SUITE_P(Gears, CorrectedSheet,
                         testing::Values(std::array{15.0, 0.0, 90.0}, std::array{0.0, 8.0, 90.0},
                                         std::array{-6.0, -5.0, 80.0}));

}  // namespace
}  // namespace toothpath
