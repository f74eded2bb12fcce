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
    double module, face, spiral, cutter;
  } pairs[] = {
      {12, 36, 5, 25, 35, 76.2}, {30, 30, 2, 12, 35, 31.75}, {25, 30, 3, 18, 35, 57.15}, {9, 37, 5, 28, 35, 95.25}};
  for (const auto& [teeth, mate, module, face, spiral, cutter] : pairs) {
    double spaces = 0, pitch = 0;
    for (const bool wheel : {false, true}) {
      const auto settings = basic_settings(drawing(teeth, mate, module, face, spiral, cutter, wheel), 0.1 * module);
      ASSERT_TRUE(settings) << settings.error().diagnostic.message;
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

}  // namespace
}  // namespace toothpath::test
