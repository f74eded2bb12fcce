// Measures of teeth against closed forms of ISO 21771, printed values, and by brute force on the flanks of every gear
// that stands on tooth spaces.
#include "geometry/tooth_space/tooth_size.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/cylindrical/part.h"
#include "geometry/cylindrical/span.h"
#include "geometry/face_gear/part.h"
#include "geometry/tooth_space/limits.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/geometry/straight_bevel/samples.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

using cylindrical::CylindricalGear;
using tooth_space::Piece;
using tooth_space::ToothSpace;

double inv(double angle) { return std::tan(angle) - angle; }

/// Angle of an involute function, by halving.
double angle_of_inv(double value) {
  double low = 0, high = 1.5;
  for (int k = 0; k < 100; ++k) (inv(0.5 * (low + high)) < value ? low : high) = 0.5 * (low + high);
  return 0.5 * (low + high);
}

std::vector<CylindricalGear> cylinders() {
  std::vector<CylindricalGear> out;
  for (const auto& p : {shifted_spur(), left_helical(), double_helical_pinion()})
    out.push_back(std::move(CylindricalGear::make(p)).value());
  return out;
}

/// Normal tooth thickness on the reference circle as ISO 21771 has it.
double normal_thickness(const cylindrical::CylindricalParameters& p, const cylindrical::InvoluteKernel<double>& w) {
  return 0.5 * kPi * w.m_n + 2 * p.profile_shift * p.module_mm * std::tan(w.alpha_n) + p.thickness_allowance_mm;
}

TEST(ToothSize, OfCylindricalGearsIsThatOfTheStandard) {
  for (const CylindricalGear& gear : cylinders())
    for (int zone = 0; zone < gear.zones(); ++zone) {
      const auto& w = gear.space(zone).kernel();
      const double s = -0.5 * (w.z_from + w.z_to), s_n = normal_thickness(gear.parameters(), w), s_t = s_n / w.cos_b;
      const auto t = tooth_space::tooth_thickness(gear.space(zone), s, w.r);
      ASSERT_TRUE(t);
      EXPECT_NEAR(t->arc_mm, s_t, 1e-11);
      // The chord between two helices on the reference cylinder, shortest by a fine walk.
      double least = INFINITY, half = 0;
      for (int k = -200000; k <= 200000; ++k) {
        const double z = 1e-5 * w.m_n * k, phi = s_t / w.r - w.kappa * z,
                     chord = std::hypot(2 * w.r * std::sin(0.5 * phi), z);
        if (chord < least) least = chord, half = 0.5 * phi;
      }
      EXPECT_NEAR(t->chord_mm, least, 1e-9);
      EXPECT_NEAR(t->height_mm, w.r_a - w.r * std::cos(half), 1e-5);
      // Over balls: the centre where the involute of the ball's parallel surface meets the middle of the space.
      const auto ball = tooth_space::measuring_ball(gear.space(zone), s, w.r);
      ASSERT_TRUE(ball);
      const double z = gear.parameters().teeth,
                   alpha_k = angle_of_inv(inv(w.alpha_t) + ball->diameter_mm / (z * w.m_n * std::cos(w.alpha_n)) -
                                          kPi / z + s_t / (2 * w.r));
      EXPECT_NEAR(radius(ball->centre), w.r_b / std::cos(alpha_k), 1e-9);
      EXPECT_NEAR(ball->touch_h[0], ball->touch_h[1], 1e-9);
      EXPECT_GT(ball->touch_h[0], w.r_b * std::hypot(1, w.theta_f));
      EXPECT_LT(ball->touch_h[0], w.r_a);
      EXPECT_GT(radius(ball->centre) + 0.5 * ball->diameter_mm, w.r_a) << "an anvil does not find the ball";
    }
}

// KHK, spur gear m 3, z 24, 20 deg, x 0.4: 32.8266 mm over 4 teeth.
TEST(ToothSize, SpanIsThePrintedOne) {
  auto p = shifted_spur();
  p.profile_shift = 0.4;
  const auto gear = CylindricalGear::make(p).value();
  EXPECT_NEAR(cylindrical::span_over(gear.space(0).kernel(), 4).length_mm, 32.8266, 5e-5);
}

// Two parallel planes, square to the normal where the span touches, moved up to the flanks.
TEST(ToothSize, SpanIsThatOfTwoPlanes) {
  for (const CylindricalGear& gear : cylinders()) {
    const auto& space = gear.space(gear.zones() - 1);
    const auto& w = space.kernel();
    const auto span = cylindrical::usual_span(w);
    EXPECT_GT(span.touch_radius_mm, w.r_b * std::hypot(1, w.theta_f));
    EXPECT_LT(span.touch_radius_mm, w.r_a);
    // Teeth 1 to k: from the minus flank of space 0 to the plus flank of space k.
    const double z_touch = 0.5 * span.least_face_mm, turn = span.teeth * kTwoPi / w.teeth;
    const auto walls = [&](Piece piece, double by, double theta, double z) {
      const auto q = space.point(piece, theta, z);
      const double c = std::cos(by), s = std::sin(by);
      return std::pair<Vec3, Vec3>{{c * q->p.x() - s * q->p.y(), s * q->p.x() + c * q->p.y(), q->p.z()},
                                   {c * q->n.x() - s * q->n.y(), s * q->n.x() + c * q->n.y(), q->n.z()}};
    };
    // One plane touches above the middle of the face, the other one as far below it, on whichever side they are
    // parallel.
    const double theta = w.theta_at(span.touch_radius_mm);
    const auto at = [&](double z) { return walls(Piece::flank_minus, 0, theta, z); };
    const auto opposite = [&](double z) { return walls(Piece::flank_plus, turn, theta, -z); };
    const double side = (at(z_touch).second + opposite(z_touch).second).norm() < 1e-9 ? 1 : -1;
    const Vec3 n = at(side * z_touch).second;
    EXPECT_LT((n + opposite(side * z_touch).second).norm(), 1e-9) << w.teeth;
    double high = -INFINITY, low = -INFINITY;
    for (int i = 0; i <= 200; ++i)
      for (int j = 0; j <= 200; ++j) {
        const double u = w.theta_f + (w.theta_a - w.theta_f) * i / 200, z = (z_touch + 1) * (j - 100) / 100;
        high = std::max(high, n.dot(walls(Piece::flank_minus, 0, u, z).first));
        low = std::max(low, -n.dot(walls(Piece::flank_plus, turn, u, z).first));
      }
    EXPECT_NEAR(high + low, span.length_mm, 5e-4) << w.teeth;
    EXPECT_LE(high + low, span.length_mm + 1e-9) << w.teeth;
  }
}

// more_gears 7 and the tests of its section 10: thickness by (3.2), width of the space 7.431745786.
TEST(ToothSize, OfBevelGearsIsThatOfTheirSpaces) {
  const auto khk = khk_pinion();
  const auto straight = straight_bevel::StraightBevelGear::make(khk).value();
  const auto outer = tooth_space::tooth_thickness(straight.space(), straight.space().outline().s_from, 0);
  ASSERT_TRUE(outer);
  const double m = khk.outer_transverse_module_mm,
               arc = 0.5 * kPi * m + 2 * khk.thickness_shift * m - 0.5 * khk.backlash_mm, r = 0.5 * m * khk.teeth;
  EXPECT_NEAR(outer->arc_mm, arc, 1e-10);
  EXPECT_NEAR(outer->chord_mm, 2 * r * std::sin(0.5 * arc / r), 1e-9);
  const auto spiral = spiral_bevel::SpiralBevelGear::make(nasa_gear()).value();
  const auto& ring = spiral.space().outline();
  const double s = 0.5 * (ring.s_from + ring.s_to);
  const auto mean = tooth_space::tooth_thickness(spiral.space(), s, 0);
  ASSERT_TRUE(mean);
  EXPECT_NEAR(ring.chart.r(s, 0) * ring.pitch - mean->arc_mm, 7.431745786, 1e-8);
  // Near cos(35 deg) of the arc: the chord lies across the tooth.
  EXPECT_NEAR(mean->chord_mm / mean->arc_mm, std::cos(spiral.spiral_angle(1)), 0.01);
}

/// Least distance of a place from a flank between fillet and tip: a grid, closed in on.
double brute_distance(const ToothSpace& space, int side, double s, const Vec3& c) {
  const Piece piece = tooth_space::flank_of(side);
  const auto b = space.borders(piece);
  const double from = std::isfinite(b.from) ? b.from : b.to, to = space.tip_edge(side, s)->u;
  double u = 0.5 * (from + to), at = s, step_u = 0.5 * (to - from), step_s = 2, least = INFINITY;
  for (int round = 0; round < 14; ++round) {
    const double middle_u = u, middle_s = at;
    for (int i = -8; i <= 8; ++i)
      for (int j = -8; j <= 8; ++j) {
        const double tried_u = std::clamp(middle_u + step_u * i / 8, std::min(from, to), std::max(from, to)),
                     tried_s = middle_s + step_s * j / 8;
        const auto q = tooth_space::place_at(space, piece, tried_u, tried_s);
        if (q && (q->p - c).norm() < least) least = (q->p - c).norm(), u = tried_u, at = tried_s;
      }
    step_u *= 0.3;
    step_s *= 0.3;
  }
  return least;
}

TEST(ToothSize, BallsTouchBothFlanksOfEveryGear) {
  const auto cylinder = CylindricalGear::make(left_helical()).value();
  const auto straight = straight_bevel::StraightBevelGear::make(khk_pinion()).value();
  const auto spiral = spiral_bevel::SpiralBevelGear::make(nasa_gear()).value();
  const auto face = face_gear::FaceGear::make(offset_gear()).value();
  for (const auto& part :
       {cylindrical::part_of(cylinder), part_of(straight), part_of(spiral), face_gear::part_of(face)}) {
    const ToothSpace& space = part->space(0);
    const auto& ring = space.outline();
    const double s = 0.5 * (ring.s_from + ring.s_to);
    const auto middle = tooth_space::middle_of_flank(space, 1, s);
    const auto ball = tooth_space::measuring_ball(space, s, ring.chart.up(middle->p));
    ASSERT_TRUE(ball) << ring.along << " " << part->teeth();
    EXPECT_NEAR(ring.chart.along(ball->centre), s, 1e-9);
    for (const int side : {1, -1})
      EXPECT_NEAR(brute_distance(space, side, s, ball->centre), 0.5 * ball->diameter_mm, 1e-6)
          << ring.along << " " << part->teeth() << " " << side;
    // Balls that would touch fillet or tip edge are none.
    EXPECT_FALSE(tooth_space::ball_in_space(space, s, 0.3 * ball->diameter_mm));
    EXPECT_FALSE(tooth_space::ball_in_space(space, s, 3 * ball->diameter_mm));
    // Above the tips and below the fillets there is no thickness.
    EXPECT_FALSE(tooth_space::tooth_thickness(space, s, space.tip(s) + 0.1));
    EXPECT_FALSE(tooth_space::flank_at(space, 1, s, space.tip(s) - 4 * part->module_mm()));
  }
}

}  // namespace
}  // namespace toothpath::test
