// The set-up's numbers: the worked example of gear shaping, the contract's formulas, and what is refused.
#include <random>

#include "tests/postproc/shaper/case.h"

namespace toothpath::test {
namespace {

// Radii whose edges lie 122 and 147 mm along the cutter axis: a face of 25 mm, as in the worked example.
shaper::ShaperWork face_25() {
  shaper::ShaperWork w = shaper_work();
  w.gear.zones[0].inner_radius_mm = std::hypot(122.0, 15.0);
  w.gear.zones[0].outer_radius_mm = std::hypot(147.0, 15.0);
  return w;
}

TEST(ShaperSetup, WorkedExampleOfTheStroke) {
  auto w = face_25();
  auto s = shaper_setup(w, shaper_machine());
  EXPECT_NEAR(s.length_mm, 30, 1e-12);
  EXPECT_NEAR(s.strokes_wanted, 333.3, 0.05);
  EXPECT_EQ(s.strokes_set, 253);
  EXPECT_NEAR(s.speed_mean_m_min, 15.18, 1e-12);
  EXPECT_NEAR(s.speed_peak_m_min, 15.18 * kPi / 2, 1e-12);
  EXPECT_NEAR(degrees(s.cutter_per_stroke_rad), 0.152789, 5e-7);
  EXPECT_NEAR(s.strokes_per_cutter_turn, 2356.2, 0.05);
  EXPECT_NEAR(s.strokes_per_work_turn, 8293.8, 0.05);
  EXPECT_NEAR(s.generating_min, 32.8, 0.05);
  EXPECT_EQ(s.strokes_turn, 8294);
  EXPECT_NEAR(s.depth_mm, 6.75, 1e-12);
  EXPECT_EQ(s.strokes_infeed, 338);  // 337.5
  EXPECT_NEAR(s.infeed_min, 1.33, 0.01);
  EXPECT_EQ(s.generating.numerator, 25);
  EXPECT_EQ(s.generating.denominator, 88);
  EXPECT_NEAR(s.generating.value(), 0.2840909, 5e-8);
  EXPECT_EQ(s.index_target.numerator, 15);
  EXPECT_EQ(s.index_target.denominator, 22);
  EXPECT_EQ(s.index_gears.wheels, (std::vector<int>{30, 44}));
  EXPECT_EQ(s.pitch_diameter_mm, 75);

  w.shaping.speed_basis = shaper::Shaping::SpeedBasis::peak;
  s = shaper_setup(w, shaper_machine());
  EXPECT_NEAR(s.strokes_wanted, 212.2, 0.05);
  EXPECT_EQ(s.strokes_set, 179);

  w.shaping.radial_feed_mm = 0.1;
  s = shaper_setup(w, shaper_machine());
  EXPECT_EQ(s.strokes_infeed, 68);  // 67.5
}

TEST(ShaperSetup, OffsetAngleInBothForms) {
  auto w = shaper_work();
  const auto angles = [&](double reference) {
    w.shaping.offset_reference = shaper::Shaping::OffsetReference::given;
    w.shaping.offset_reference_mm = reference;
    const auto s = shaper_setup(w, shaper_machine());
    EXPECT_EQ(s.slide_mm, 15);
    EXPECT_EQ(s.offset_reference_mm, reference);
    return std::pair(degrees(s.angle_tan_rad), degrees(s.angle_sin_rad));
  };
  EXPECT_NEAR(angles(132).first, 6.4831, 5e-5);
  EXPECT_NEAR(angles(132).second, 6.525, 5e-4);
  EXPECT_NEAR(angles(150).first, 5.711, 5e-4);
  EXPECT_NEAR(angles(150).second, 5.739, 5e-4);
  EXPECT_NEAR(angles(151.5833).first, 5.6513, 5e-5);
  EXPECT_NEAR(angles(151.5833).second, 5.6790, 5e-5);
  EXPECT_NEAR(angles(140.6899).first, 6.0857, 5e-5);
  EXPECT_NEAR(angles(140.6899).second, 6.1204, 5e-5);
  w.shaping.offset_reference = shaper::Shaping::OffsetReference::mean_radius;
  EXPECT_NEAR(shaper_setup(w, shaper_machine()).offset_reference_mm, 138.75, 1e-12);
  w.shaping.offset_reference = shaper::Shaping::OffsetReference::outer_radius;
  EXPECT_EQ(shaper_setup(w, shaper_machine()).offset_reference_mm, 147);
  w.gear.offset_mm = -15;
  const auto s = shaper_setup(w, shaper_machine());
  EXPECT_EQ(s.slide_mm, -15);
  EXPECT_LT(s.angle_tan_rad, 0);
  EXPECT_LT(s.angle_sin_rad, 0);
}

// A chord of the face at the offset is longer than the face width itself.
TEST(ShaperSetup, StrokeFollowsTheCutterAxis) {
  const auto s = shaper_setup(shaper_work(), shaper_machine());
  EXPECT_NEAR(s.face_mm, 16.598, 5e-4);
  EXPECT_NEAR(s.length_mm, s.face_mm + 5, 1e-12);
  EXPECT_NEAR(std::hypot(s.start_mm - 2.5, 15), 147, 1e-12);
  EXPECT_NEAR(std::hypot(s.end_mm + 2.5, 15), 130.5, 1e-12);
  EXPECT_NEAR(s.start_mm - s.end_mm, s.length_mm, 1e-12);
  EXPECT_EQ(s.strokes_set, 359);  // 463 wanted
}

TEST(ShaperSetup, StepEqualToTheWantedStrokesIsTaken) {
  auto w = face_25();
  w.shaping.cutting_speed_m_min = 2 * 30 * 359 / 1000.0;  // 359 wanted, up to the last bits
  EXPECT_EQ(shaper_setup(w, shaper_machine()).strokes_set, 359);
}

// depth / feed = 270 on paper: not 271 because of the last bit.
TEST(ShaperSetup, WholeQuotientOfTheInfeedIsNotRoundedUp) {
  for (const int strokes : {3, 7, 45, 99, 135, 270, 999}) {
    auto w = shaper_work();
    w.shaping.radial_feed_mm = 6.75 / strokes;
    EXPECT_EQ(shaper_setup(w, shaper_machine()).strokes_infeed, strokes);
  }
}

TEST(ShaperSetup, FeedGearsGiveTheStatedFeedAndLeaveTheIndexGearsAlone) {
  for (const double feed : {0.05, 0.1, 0.13, 0.2, 0.31}) {
    auto w = shaper_work();
    w.shaping.circular_feed_mm = feed;
    const auto s = shaper_setup(w, shaper_machine());
    EXPECT_NEAR(s.feed_target, 750 * feed / 75, 1e-12);
    EXPECT_NEAR(s.circular_feed_set_mm, s.feed_gears.ratio().value() * 75 / 750, 1e-15);
    EXPECT_NEAR(s.circular_feed_set_mm, feed, 0.01 * feed);
    shaper::GearTrain both = s.index_gears;
    for (const int z : s.feed_gears.wheels) EXPECT_EQ(std::count(both.wheels.begin(), both.wheels.end(), z), 0);
  }
}

// The tooth space is widest at the full depth; there the arcs are those of the finished gear (face gear tables, r =
// 138).
TEST(ShaperSetup, PassTableEndsAtTheFinishedTooth) {
  auto w = shaper_work();
  w.gear.zones[0].inner_radius_mm = 130;
  w.gear.zones[0].outer_radius_mm = 146;  // inspection at 138
  const auto s = shaper_setup(w, shaper_machine());
  ASSERT_EQ(s.passes.size(), 5u);
  EXPECT_EQ(s.passes.back().x_mm, 0);
  EXPECT_EQ(s.passes.back().stroke, s.strokes_infeed);
  EXPECT_NEAR(s.passes.back().space_width_mm, 7.896, 6e-4);
  EXPECT_NEAR(s.passes.back().tooth_thickness_mm, 1.958, 6e-4);
  for (std::size_t k = 1; k < s.passes.size(); ++k) {
    EXPECT_GT(s.passes[k].depth_mm, s.passes[k - 1].depth_mm);
    EXPECT_GT(s.passes[k].space_width_mm, s.passes[k - 1].space_width_mm);
  }
}

// The stroke has cut all that it passed: lifted from there the edge meets at most the lift and the feed of one stroke.
TEST(ShaperSetup, BackStrokeMeetsNoMoreThanLiftAndFeed) {
  std::mt19937 random(1913);
  const auto uniform = [&](double a, double b) { return a + (b - a) * double(random() % 100000) / 100000; };
  int planned = 0;
  for (int k = 0; k < 150; ++k) {
    auto w = shaper_work();
    auto& g = w.gear;
    g.module_mm = std::exp(uniform(0, std::log(6)));
    g.shaper_teeth = 14 + static_cast<int>(random() % 20);
    g.teeth = g.shaper_teeth * 2 + static_cast<int>(random() % 60);
    const double pitch_radius = 0.5 * g.module_mm * g.teeth;
    g.zones.front().inner_radius_mm = pitch_radius * uniform(0.97, 1.05);
    g.zones.front().outer_radius_mm = g.zones.front().inner_radius_mm + g.module_mm * uniform(2, 5);
    g.offset_mm = pitch_radius * uniform(-0.35, 0.35);
    w.shaping.circular_feed_mm = uniform(0.05, 0.6);
    w.shaping.radial_feed_mm = uniform(0.01, 0.08);
    w.shaping.over_run_mm = uniform(0.5, 6);
    auto machine = shaper_machine();
    machine.relief_mm = uniform(0.05, 1);
    const auto made = face_gear::FaceGear::make(g);
    if (!made.has_value()) continue;
    const auto setup = shaper::plan_shaper_setup(w, machine);
    if (!setup.has_value()) continue;
    ++planned;
    const auto& s = setup.value();
    const double step = 2 * kPi / s.strokes_turn;  // of the work, a stroke
    const double feed = step * (s.outer_radius_mm + s.surface.shaper.r_a * s.work_teeth / s.cutter_teeth);
    EXPECT_GE(s.relief.stock_mm, -(s.machine.relief_mm + feed)) << k << " feed " << feed;
    EXPECT_GE(s.relief.flank_mm, -(s.machine.relief_mm + feed)) << k << " feed " << feed;
  }
  EXPECT_GE(planned, 20);
}

TEST(ShaperSetup, ReliefIsChecked) {
  auto w = shaper_work();
  auto machine = shaper_machine();
  // Without lift the cutter touches the flanks that it has just cut, and stands in the next chips.
  const auto s = shaper_setup(w, machine);
  const auto none = shaper::back_stroke_clearance(s, 0);
  EXPECT_NEAR(none.flank_mm, 0, 1e-6);
  EXPECT_LT(none.stock_mm, -0.01);
  EXPECT_GT(none.stock_mm, -0.2);  // the chip of one stroke is not thicker than its feed of 0.1 mm or so
  // More lift clears the flanks more, and never by more than the lift.
  double before = none.flank_mm;
  for (const double lift : {0.1, 0.25, 0.5, 1.0}) {
    const auto c = shaper::back_stroke_clearance(s, lift);
    EXPECT_GT(c.flank_mm, before);
    EXPECT_LE(c.flank_mm, lift);
    EXPECT_LE(c.stock_mm, c.flank_mm + 1e-9);
    before = c.flank_mm;
  }
  EXPECT_EQ(s.relief.flank_mm, shaper::back_stroke_clearance(s, 0.5).flank_mm);
  // A lift that is too small for the chip is stated.
  machine.relief_mm = 0.005;
  w.shaping.circular_feed_mm = 0.5;
  const auto rubbing = shaper_setup(w, machine);
  EXPECT_LT(rubbing.relief.stock_mm, 0);
  ASSERT_FALSE(rubbing.warnings.empty());
  EXPECT_NE(rubbing.warnings.back().find("stock of the next stroke"), std::string::npos);
}

TEST(ShaperSetup, WhatAStraightStrokeCannotDoIsRefused) {
  const auto machine = shaper_machine();
  auto w = shaper_work();
  w.gear.zones[0].helix_angle_rad = radians(15);
  EXPECT_NE(refusal(w, machine, "gear.zone[0].helix_angle").find("15.0000 deg"), std::string::npos);
  w = shaper_work();
  w.gear.zones.push_back({0, 148, 150});
  refusal(w, machine, "gear.zone[1]");
  w = shaper_work();
  w.gear.shaft_angle_rad = radians(80);
  EXPECT_NE(refusal(w, machine, "gear.shaft_angle").find("80.0000"), std::string::npos);
}

TEST(ShaperSetup, LimitsAreNamedWithTheirValue) {
  const auto machine = shaper_machine();
  auto w = shaper_work();
  w.shaping.over_run_mm = 60;
  EXPECT_NE(refusal(w, machine, "shaping.over_run").find("exceeds 125.0000"), std::string::npos);
  w = shaper_work();
  w.shaping.cutting_speed_m_min = 5;
  EXPECT_NE(refusal(w, machine, "shaping.cutting_speed").find("below 125.0000"), std::string::npos);
  w = shaper_work();
  w.gear.shaper_tip_radius_mm = 1.5;  // full round tip: 1.118
  refusal(w, machine, "gear.shaper_tip_radius");
  w = shaper_work();
  w.gear.addendum_coefficient = 1.9;  // the cutter's teeth come to a point
  refusal(w, machine, "gear.shaper_tip_radius");
  auto narrow = machine;
  narrow.axes['Y'].max = 14;
  EXPECT_NE(refusal(shaper_work(), narrow, "gear.offset").find("axis Y needs 15.0000"), std::string::npos);
  narrow = machine;
  narrow.axes['Z'].max = 140;
  refusal(shaper_work(), narrow, "gear.zone[0].outer_radius");
  narrow = machine;
  narrow.axes['C'].max = radians(370);
  refusal(shaper_work(), narrow, "machine.file");
  narrow = machine;
  narrow.axes['Z'].max_speed = 12000;
  EXPECT_NE(refusal(shaper_work(), narrow, "shaping.cutting_speed").find("axis Z is too slow"), std::string::npos);
}

// 89 is prime and not to be had from the wheels without a wheel of 89 or 97 teeth.
TEST(ShaperSetup, NoExactIndexGearsIsRefusedAndTheNearestNamed) {
  auto w = shaper_work();
  w.gear.teeth = 83;
  const auto text = refusal(w, shaper_machine(), "gear.shaper_teeth");
  EXPECT_NE(text.find("no exact index gears for 60/83"), std::string::npos) << text;
  EXPECT_NE(text.find("the nearest is"), std::string::npos) << text;
}

// The split of the double stroke follows slow axes, and always fills it.
TEST(ShaperSetup, TimingFitsTheAxes) {
  auto machine = shaper_machine();
  for (const double z_speed : {120000.0, 19000.0, 17500.0}) {
    machine.axes['Z'].max_speed = z_speed;
    const auto s = shaper_setup(shaper_work(), machine);
    const auto t = shaper::choose_timing(s).timing;
    EXPECT_NEAR(t.cutting + t.lift + t.back + t.approach, 1, 1e-14);
    const double n = s.strokes_set;
    EXPECT_LE(s.length_mm * n / t.cutting, z_speed * (1 + 1e-12));
    EXPECT_LE(s.length_mm * n / t.back, z_speed * (1 + 1e-12));
    EXPECT_LE((0.5 + s.infeed_per_stroke_mm) * n / t.approach, 20000 * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace toothpath::test
