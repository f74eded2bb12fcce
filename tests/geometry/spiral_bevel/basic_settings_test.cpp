// Settings that follow from a drawing: what they make is what the drawing says, and pinion and wheel mate.
#include "geometry/spiral_bevel/basic_settings.h"

#include <gtest/gtest.h>

#include "geometry/base/angle.h"
#include "geometry/spiral_bevel/gear.h"

namespace toothpath::test {
namespace {

using spiral_bevel::Drawing;
using spiral_bevel::SpiralBevelGear;
using tooth_space::Piece;

Drawing drawing(int teeth, int mate, double module, double face, double spiral, double cutter, bool wheel) {
  Drawing d;
  d.teeth = wheel ? mate : teeth;
  d.mate_teeth = wheel ? teeth : mate;
  d.hand = wheel ? 1 : -1;
  d.outer_transverse_module_mm = module;
  d.face_width_mm = face;
  d.spiral_angle_rad = radians(spiral);
  d.pressure_angle_rad = radians(20);
  d.cutter_radius_mm = cutter;
  return d;
}

/// On the pitch cone in the middle of the face both flanks have the pressure angle, spiral angles that are the
/// drawing's in the mean, and spaces of pinion and wheel fill one pitch. The root lies below the pitch cone by the
/// dedendum and the pitch line is the axis of the roll.
TEST(BasicSettings, MakeWhatTheDrawingSays) {
  struct {
    int teeth, mate;
    double module, face, spiral, cutter, shafts = 90;
  } pairs[] = {{12, 36, 5, 25, 35, 76.2},
               {30, 30, 2, 12, 35, 31.75},
               {25, 30, 3, 18, 35, 57.15},
               {9, 37, 5, 28, 35, 95.25},
               {17, 28, 4, 20, 35, 76.2, 60},
               {16, 31, 4, 20, 35, 76.2, 110},
               {20, 40, 3, 18, 30, 76.2, 75.5},
               // v runs three times as fast as the cone distance along the wheel's tip.
               {17, 28, 5.5, 20, 35, 76.2, 110}};
  for (const auto& [teeth, mate, module, face, spiral, cutter, shafts] : pairs) {
    double spaces = 0, pitch = 0;
    for (const bool wheel : {false, true}) {
      Drawing asked = drawing(teeth, mate, module, face, spiral, cutter, wheel);
      asked.shaft_angle_rad = radians(shafts);
      const auto settings = basic_settings(asked, 0.1 * module);
      ASSERT_TRUE(settings) << settings.error().diagnostic.message;
      // Both pitch cones roll on each other at this shaft angle, and either says it.
      Drawing other = asked;
      std::swap(other.teeth, other.mate_teeth);
      EXPECT_NEAR(pitch_angle(asked) + pitch_angle(other), radians(shafts), 1e-12);
      EXPECT_NEAR(outer_cone_distance(asked), outer_cone_distance(other), 1e-10);
      EXPECT_NEAR(spiral_bevel::shaft_angle_of(pitch_angle(asked), double(asked.mate_teeth) / asked.teeth).value(),
                  radians(shafts), 1e-12);
      const auto made = SpiralBevelGear::make(settings.value());
      ASSERT_TRUE(made) << teeth << " " << made.error().front().diagnostic.message;
      const SpiralBevelGear& gear = made.value();
      const auto& p = gear.parameters();
      EXPECT_NEAR(0.5 * (gear.spiral_angle(1) + gear.spiral_angle(-1)), radians(spiral), 1e-8);
      const auto& k = gear.space().kernel();
      for (const int side : {1, -1}) {
        const Vec2 at = k.middle[k.index(side)];
        const auto q = gear.space().point(tooth_space::flank_of(side), at.x(), at.y());
        ASSERT_TRUE(q);
        EXPECT_NEAR(q->n.dot(gear.space().outline().chart.up_at(azimuth(q->p))), std::sin(radians(20)), 1e-8);
      }
      // z_m + R k lies along the pitch line.
      const double g = p.cuts[0].root_angle_rad, d = p.pitch_angle_rad;
      EXPECT_NEAR(std::cos(g) * std::cos(d) - (p.cuts[0].ratio_of_roll - std::sin(g)) * std::sin(d), 0, 1e-12);
      spaces += gear.space_width_mm();
      pitch = kTwoPi * p.mean_cone_distance() * std::sin(d) / p.teeth;
    }
    EXPECT_NEAR(spaces, pitch, 1e-8);
  }
}

/// Shafts at which the wheel would have to be a crown or an internal gear: the angle that is named does, a little more
/// does not.
TEST(BasicSettings, ShaftsForAnInternalWheelAreRefusedWithTheirLimit) {
  Drawing d = drawing(12, 36, 5, 25, 35, 76.2, false);
  d.shaft_angle_rad = radians(120);
  const auto refused = basic_settings(d, 0.5);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().key, "shaft_angle");
  const std::string& text = refused.error().diagnostic.message;
  const std::string lead = "a shaft angle below ";
  const double limit = std::stod(text.substr(text.find(lead) + lead.size()));
  d.shaft_angle_rad = radians(limit - 1e-3);
  const auto below = basic_settings(d, 0.5);
  EXPECT_TRUE(below || below.error().key != "shaft_angle") << text;
  d.shaft_angle_rad = radians(limit + 1e-3);
  EXPECT_FALSE(basic_settings(d, 0.5)) << text;
  EXPECT_FALSE(spiral_bevel::shaft_angle_of(radians(40), 2));
}

/// Contact lines that run along the circles of the blades are no limit: gears of small spiral angles are made, down to
/// none at all. Their flanks go on past the places where the roll turns back.
TEST(BasicSettings, SmallSpiralAnglesAreMade) {
  struct {
    int teeth, mate;
    double module, face, cutter, shafts;
  } pairs[] = {{12, 36, 5, 25, 76.2, 90}, {30, 30, 2, 12, 31.75, 90}, {17, 28, 5.5, 20, 76.2, 110}};
  int by_circle = 0;
  for (const auto& [teeth, mate, module, face, cutter, shafts] : pairs)
    for (const bool wheel : {false, true})
      for (const double spiral : {0.0, 5.0, 15.0, 25.0, 28.0}) {
        Drawing d = drawing(teeth, mate, module, face, spiral, cutter, wheel);
        d.shaft_angle_rad = radians(shafts);
        const auto settings = basic_settings(d, 0.1 * module);
        ASSERT_TRUE(settings) << settings.error().diagnostic.message;
        const auto made = SpiralBevelGear::make(settings.value());
        ASSERT_TRUE(made) << teeth << " " << wheel << " " << spiral << " " << made.error().front().diagnostic.message;
        const SpiralBevelGear& gear = made.value();
        EXPECT_NEAR(0.5 * (gear.spiral_angle(1) + gear.spiral_angle(-1)), radians(spiral), 1e-8);
        for (const auto& f : gear.space().kernel().flanks) by_circle += f.by_circle ? 1 : 0;
      }
  EXPECT_GT(by_circle, 30);
}

}  // namespace
}  // namespace toothpath::test
