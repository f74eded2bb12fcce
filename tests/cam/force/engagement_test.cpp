// The surface of a cutter that is in the material, against brute force: thin chips counted on grids, volumes between
// two places of the tool.
#include "cam/force/engagement.h"

#include <gtest/gtest.h>

#include "tests/cam/force/mills.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using force::Engagement;

Engagement got(const Result<Engagement>& e) {
  if (!e) {
    ADD_FAILURE() << e.error().message;
    return {};
  }
  return *e;
}

// Side: mean chip f_z sqrt(2 q/R)/2 and engaged angle sqrt(2 q/R), and cos(angle) = 1 - q/R up to the next
// term of its series, angle^4/24.
TEST(Engagement, SideOfACylinder) {
  const Engagement e = force::side_engagement(3.1, 0.4, 1.55, 0.01);
  EXPECT_DOUBLE_EQ(e.angle_rad(), std::sqrt(2 * 0.01 / 0.4));
  EXPECT_NEAR(e.section_mm2 / e.area_mm2, std::sqrt(2 * 0.01 / 0.4) / 2, 1e-15);
  for (const double q : {0.001, 0.01, 0.05})
    EXPECT_NEAR(std::cos(force::side_engagement(3.1, 0.4, 1.55, q).angle_rad()), 1 - q / 0.4,
                1.001 * q * q / (6 * 0.16));
}

// Of a profile: the middle of a line on a cone has the radius rho(t) of its law, and is met from the height of that
// ball.
TEST(Engagement, SideOfATaperedMill) {
  const auto mill = made(tapered_data(0.25, 7, 4, 6, 20));
  const Engagement e = got(force::side_engagement(mill, 0.3, 3.4, 0.01));
  const double t = e.height_mm - 0.25;  // above the centre of the ball
  EXPECT_NEAR(e.radius_mm, mill.law()->rho(t), 1e-12);
  EXPECT_NEAR(e.edge_mm, 3.1 / std::cos(radians(7)), 1e-12);
  for (const auto& [from, to] : {std::pair(3.0, 1.0), {0.3, 4.1}, {-0.1, 2.0}})
    EXPECT_FALSE(force::side_engagement(mill, from, to, 0.01));
  EXPECT_FALSE(force::side_engagement(mill, 0.3, 3.4, 0));
  EXPECT_FALSE(force::side_engagement(mill, 0.3, 3.4, 1));
}

// Ball: a grid over the disc of contact, with what the pass before took off left out.
TEST(Engagement, BallAgainstAGrid) {
  Random random(3);
  for (int i = 0; i < 12; ++i) {
    const double R = random(0.2, 3), q = R * random(0.001, 0.05), rho = std::sqrt(2 * R * q),
                 w = rho * (i < 3 ? random(2.1, 3) : random(0.05, 1.95));
    const Engagement e = got(force::ball_engagement(R, q, w));
    constexpr int kSteps = 700;
    const double cell = 2 * rho / kSteps;
    double area = 0, section = 0, longest = 0, widest = 0, least = rho, most = -rho;
    for (int k = 0; k < kSteps; ++k) {
      const double y = -rho + (k + 0.5) * cell;
      double way = 0;
      for (int j = 0; 2 * j < kSteps; ++j) {
        const double x = (j + 0.5) * cell;
        // In the stock, and below the trough of the pass before.
        if (x * x + y * y > rho * rho || x * x + y * y > (y + w) * (y + w)) continue;
        way += cell;
        widest = std::max(widest, x);
        section += cell * cell * x / R;  // of a chip x/R thick for a feed of 1
        least = std::min(least, y);
        most = std::max(most, y);
      }
      area += way * cell;
      longest = std::max(longest, way);
    }
    EXPECT_NEAR(e.area_mm2 / area, 1, 0.01) << w / rho;
    EXPECT_NEAR(e.section_mm2 / section, 1, 0.01) << w / rho;
    EXPECT_NEAR(e.arc_mm, longest, 3 * cell) << w / rho;
    EXPECT_NEAR(e.steepest, widest / R, 3 * cell / R);
    EXPECT_NEAR(e.edge_mm, most - least, 4 * cell) << w / rho;
  }
}

// A step below and above 2 rho, where passes stop to touch.
TEST(Engagement, BallPassesThatPartMeetThoseThatOverlap) {
  const double R = 0.25, q = 0.01, rho = std::sqrt(2 * R * q);
  const Engagement below = got(force::ball_engagement(R, q, 2 * rho * (1 - 1e-12))),
                   above = got(force::ball_engagement(R, q, 2 * rho));
  EXPECT_NEAR(below.area_mm2, above.area_mm2, 1e-9);
  EXPECT_NEAR(below.edge_mm, above.edge_mm, 1e-9);
  // The circle seen as a parabola: 2 rho q against its segment of 4/3 rho q, which alone is in the material.
  EXPECT_NEAR(above.section_mm2, 4.0 / 3 * rho * q, 1e-15);
  EXPECT_FALSE(force::ball_engagement(R, 0, 0.1));
  EXPECT_FALSE(force::ball_engagement(R, 0.3, 0.1));
  EXPECT_FALSE(force::ball_engagement(R, 0.01, 0));
  // Cusps of a plane.
  const double w = force::step_of_scallop(R, 0.002);
  EXPECT_NEAR(R - std::sqrt(R * R - w * w / 4), 0.002, 1e-15);
}

// Slot: half the body's surface up to the depth, its section, and chips that add up to what a feed takes off.
TEST(Engagement, SlotOfAnyProfile) {
  tool::CutterData nose = ball_data(3, 10, 6, 30);
  nose.shape = tool::CutterShape::bull_nose;
  nose.corner_radius_mm = 0.5;
  tool::CutterData flat = ball_data(2, 10, 4, 30);
  flat.shape = tool::CutterShape::flat;
  tool::CutterData barrel = tapered_data(1, 8, 4, 8, 30);
  barrel.shape = tool::CutterShape::barrel;
  barrel.meridian_radius_mm = -50;
  for (const auto& data : {ball_data(0.5, 3.5, 0.95, 16), tapered_data(0.25, 7, 4, 6, 20), nose, flat, barrel})
    for (const double depth : {0.2, 0.45, 1.7, 3.3}) {
      const auto mill = made(data);
      const Engagement e = got(force::slot_engagement(mill, depth));
      constexpr int kSteps = 20000;
      double area = 0, section = 0, chips = 0, edge = 0, widest = 0;
      for (int k = 0; k < kSteps; ++k) {
        // Heights as cosines: a ball begins with a level tangent.
        const auto at = [&](double u) { return depth * 0.5 * (1 - std::cos(kPi * u)); };
        const double h0 = at(double(k) / kSteps), h1 = at(double(k + 1) / kSteps);
        const double r0 = mill.cutting().radius(h0), r1 = mill.cutting().radius(h1), ds = std::hypot(h1 - h0, r1 - r0);
        edge += ds;
        area += kPi * 0.5 * (r0 + r1) * ds;
        section += (r0 + r1) * (h1 - h0);
        chips += (h1 - h0) * 0.5 * (r0 + r1) * 2;  // int over half a turn of n_f r ds d(angle), n_f = cos(angle) dh/ds
        widest = std::max({widest, r0, r1});
      }
      EXPECT_NEAR(e.edge_mm / edge, 1, 1e-4);
      EXPECT_NEAR(e.area_mm2 / area, 1, 1e-4);
      EXPECT_NEAR(e.section_mm2 / section, 1, 1e-4);
      EXPECT_NEAR(e.section_mm2 / chips, 1, 1e-4);
      EXPECT_NEAR(e.radius_mm, widest, 1e-6);
      EXPECT_GT(e.steepest, 0);
      EXPECT_LE(e.steepest, 1);
      EXPECT_GT(e.height_mm, 0);
    }
  const auto ball = made(ball_data(0.5, 3.5, 0.95, 16));
  const Engagement e = got(force::slot_engagement(ball, 0.25));
  EXPECT_NEAR(e.area_mm2, kPi * 0.5 * 0.25, 1e-12);  // half a cap
  EXPECT_NEAR(e.steepest, std::sqrt(0.75), 1e-12);
  EXPECT_NEAR(e.height_mm, 0.5, 1e-12);  // every normal of a ball meets its centre
  EXPECT_FALSE(force::slot_engagement(ball, 0));
  EXPECT_FALSE(force::slot_engagement(ball, 3.6));
}

}  // namespace
}  // namespace toothpath::test
