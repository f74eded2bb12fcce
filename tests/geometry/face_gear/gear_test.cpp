// FaceGear::make: sound gears pass, everything else is refused with its key, value and limit.
#include <gtest/gtest.h>

#include <functional>

#include "geometry/face_gear/gear.h"
#include "tests/support/face_gear_cases.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

TEST(FaceGearMake, AcceptsBothSamples) {
  const auto offset = face_gear::FaceGear::make(offset_gear());
  ASSERT_TRUE(offset.has_value());
  const auto& o = offset.value();
  EXPECT_EQ(o.rings().size(), 1u);
  EXPECT_TRUE(o.warnings().empty());
  EXPECT_NEAR(o.blank_top(), -34.5, 1e-12);
  EXPECT_NEAR(o.lowest_root(), -41.25, 1e-12);
  EXPECT_DOUBLE_EQ(o.inner_radius(), 130.5);
  EXPECT_DOUBLE_EQ(o.outer_radius(), 147);
  EXPECT_NEAR(o.pitch() * 88, 2 * kPi, 1e-14);

  const auto helical = face_gear::FaceGear::make(double_helical_parameters());
  ASSERT_TRUE(helical.has_value());
  const auto& d = helical.value();
  EXPECT_EQ(d.rings().size(), 2u);
  EXPECT_TRUE(d.warnings().empty());
  EXPECT_NEAR(d.blank_top(), -70, 1e-12);
  EXPECT_NEAR(d.lowest_root(), -81.25, 1e-12);
  EXPECT_NEAR(d.groove_floor(), -82.5, 1e-12);
  // Both halves share limits and phase; the undercut side changes.
  EXPECT_EQ(d.rings()[0].surface.L0, 472);
  EXPECT_EQ(d.rings()[1].surface.L0, 472);
  EXPECT_NEAR(*d.rings()[0].limits.flanks[1].undercut_radius, *d.rings()[1].limits.flanks[0].undercut_radius, 1e-9);
  EXPECT_FALSE(d.rings()[0].limits.flanks[0].undercut_radius);
}

TEST(FaceGearMake, TheBlankFollowsTheTips) {
  auto p = steep_gear(105, 77.5, 85.5);
  p.allowance_top_mm = 0.5;
  const auto gear = face_gear::FaceGear::make(p);
  ASSERT_TRUE(gear.has_value());
  const auto& surface = gear.value().rings()[0].surface;
  EXPECT_GT(std::abs(surface.z_tip(77.6) - surface.z_tip(85.4)), 2);
  for (const double r : {77.6, 81.5, 85.4}) {
    EXPECT_TRUE(gear.value().in_blank({r, 0, surface.z_tip(r) + 0.499}));
    EXPECT_FALSE(gear.value().in_blank({r, 0, surface.z_tip(r) + 0.501}));
  }
  EXPECT_FALSE(gear.value().in_blank({77.4, 0, -40}));
}

TEST(FaceGearMake, TracesOfBothHalvesMeetAtTheReferenceRadius) {
  const auto made = face_gear::FaceGear::make(double_helical_parameters());
  const auto& gear = made.value();
  const auto middle = [](const face_gear::FaceGearSurface<double>& f, double Z) {
    return 0.5 * (f.root_edge_azimuth(1, Z) + f.root_edge_azimuth(-1, Z));
  };
  const auto &inner = gear.rings()[0].surface, &outer = gear.rings()[1].surface;
  EXPECT_NEAR(middle(inner, 472), kPi / 180, 1e-13);
  EXPECT_NEAR(middle(outer, 472), kPi / 180, 1e-13);
  EXPECT_GT(middle(outer, 480), middle(outer, 476));  // right hand leans to +azimuth outwards
  EXPECT_LT(middle(inner, 468), middle(inner, 460));
}

TEST(FaceGearMake, GrooveFloor) {
  auto g = double_helical_parameters();
  g.groove_depth_mm = -1;
  const auto made = face_gear::FaceGear::make(g);
  EXPECT_NEAR(made.value().groove_floor(), -81.25 - 0.25 * 5, 1e-12);
  // Conical: measured from the tip surface at mid-groove.
  g.shaft_angle_rad = radians(100);
  g.reference_radius_mm.reset();
  g.groove_depth_mm = 13;
  g.zones = {{radians(-20), 445, 455}, {radians(20), 463, 470}};
  const auto cone = face_gear::FaceGear::make(g);
  ASSERT_TRUE(cone.has_value()) << cone.error().front().diagnostic.message;
  const auto& c = cone.value();
  EXPECT_NEAR(c.groove_floor(), c.rings()[0].surface.z_tip(459) - 13, 1e-12);
  EXPECT_EQ(c.rings()[0].surface.L0, c.rings()[1].surface.L0);
  EXPECT_GT(std::abs(c.rings()[0].surface.z_tip(445) - c.rings()[0].surface.z_tip(455)), 1);
  // The root is a cone too: the floor is flat and must lie below it at both edges of the groove, not at its middle
  // only.
  double lowest = INFINITY;
  for (const auto& ring : c.rings())
    for (const double r : {455.0, 463.0}) lowest = std::min(lowest, face_gear::root_height(ring.surface, r).value());
  const double least = c.rings()[0].surface.z_tip(459) - lowest;
  EXPECT_GT(least, c.rings()[0].surface.z_tip(459) - face_gear::root_height(c.rings()[0].surface, 459).value() + 0.5);
  g.groove_depth_mm = least - 1e-6;
  const auto shallow = face_gear::FaceGear::make(g);
  ASSERT_TRUE(!shallow.has_value());
  EXPECT_EQ(shallow.error().front().key, "stock.groove_depth");
  g.groove_depth_mm = least + 1e-6;
  EXPECT_TRUE(face_gear::FaceGear::make(g).has_value());
}

struct RefusedGear {
  const char* name;
  const char* key;
  std::vector<std::string> words;  // all of them in the message: quantity, value, limit
  std::function<void(face_gear::FaceGearParameters&)> spoil;
  bool helical = false;
};

const std::vector<RefusedGear>& refusals() {
  static const std::vector<RefusedGear> list = {
      {"undercut",
       "zone[0].inner_radius",
       {"129.0000", "undercut", "R1c = 129.5097", "side -1"},
       [](auto& g) { g.zones[0].inner_radius_mm = 129; }},
      {"undercut_other_side",
       "zone[0].inner_radius",
       {"R1c = 129.5097", "side +1"},
       [](auto& g) {
         g.zones[0].inner_radius_mm = 129;
         g.offset_mm = -15;
       }},
      {"pointing",
       "zone[0].outer_radius",
       {"152.0000", "pointing", "R2 = 151.5833"},
       [](auto& g) { g.zones[0].outer_radius_mm = 152; }},
      {"inverted_zone", "zone[0].outer_radius", {"130", "130.5"}, [](auto& g) { g.zones[0].outer_radius_mm = 130; }},
      {"empty_zone", "zone[0].outer_radius", {"130.5"}, [](auto& g) { g.zones[0].outer_radius_mm = 130.5; }},
      {"inside_base",
       "zone[0].inner_radius",
       {"120.0000", "124.0394"},
       [](auto& g) { g.zones[0].inner_radius_mm = 120; }},
      {"inside_offset", "zone[0].inner_radius", {"130.5", "135"}, [](auto& g) { g.offset_mm = -135; }},
      {"rounding",
       "shaper_tip_radius",
       {"1.3000", "too large", "1.1184"},
       [](auto& g) { g.shaper_tip_radius_mm = 1.3; }},
      {"negative_rounding", "shaper_tip_radius", {"-0.1", "below 0"}, [](auto& g) { g.shaper_tip_radius_mm = -0.1; }},
      {"pointed_shaper",
       "addendum_coefficient",
       {"pointed", "half pitch"},
       [](auto& g) {
         g.addendum_coefficient = 1.9;
         g.shaper_tip_radius_mm = 0;
       }},
      {"reference_zero", "reference_radius", {"0 mm", "(0,"}, [](auto& g) { g.reference_radius_mm = 0; }},
      {"reference_negative", "reference_radius", {"-5"}, [](auto& g) { g.reference_radius_mm = -5; }},
      {"few_teeth", "teeth", {"3", "[4, 10000]"}, [](auto& g) { g.teeth = 3; }},
      {"few_shaper_teeth", "shaper_teeth", {"0", "[4, 1000]"}, [](auto& g) { g.shaper_teeth = 0; }},
      {"inverted_ratio", "teeth", {"20", "25"}, [](auto& g) { g.teeth = 20; }},
      {"large_mate", "mate_teeth", {"26", "25"}, [](auto& g) { g.mate_teeth = 26; }},
      {"module_zero", "module", {"0 mm", "[0.05, 100]"}, [](auto& g) { g.module_mm = 0; }},
      {"module_nan", "module", {"nan"}, [](auto& g) { g.module_mm = NAN; }},
      {"pressure_angle", "pressure_angle", {"50 deg", "45"}, [](auto& g) { g.pressure_angle_rad = radians(50); }},
      {"addendum", "addendum_coefficient", {"0", "[0.1, 2]"}, [](auto& g) { g.addendum_coefficient = 0; }},
      {"clearance", "clearance_coefficient", {"-0.1"}, [](auto& g) { g.clearance_coefficient = -0.1; }},
      {"shaft_angle_low", "shaft_angle", {"59", "[60, 120]"}, [](auto& g) { g.shaft_angle_rad = radians(59); }},
      {"shaft_angle_high", "shaft_angle", {"121", "[60, 120]"}, [](auto& g) { g.shaft_angle_rad = radians(121); }},
      {"backlash", "backlash", {"-0.01"}, [](auto& g) { g.backlash_mm = -0.01; }},
      {"offset", "offset", {"nan"}, [](auto& g) { g.offset_mm = NAN; }},
      {"allowance", "stock.allowance_top", {"-1"}, [](auto& g) { g.allowance_top_mm = -1; }},
      {"no_zone", "zone", {"no zone"}, [](auto& g) { g.zones.clear(); }},
      {"helix", "zone[0].helix_angle", {"61", "60"}, [](auto& g) { g.zones[0].helix_angle_rad = radians(61); }},
      {"overlap",
       "zone[1].inner_radius",
       {"467", "468", "zone 0"},
       [](auto& g) { g.zones[1].inner_radius_mm = 467; },
       true},
      {"out_of_order",
       "zone[1].inner_radius",
       {"449", "496"},
       [](auto& g) { std::swap(g.zones[0], g.zones[1]); },
       true},
      {"touching",
       "zone[1].inner_radius",
       {"468.0000", "groove"},
       [](auto& g) { g.zones[1].inner_radius_mm = 468; },
       true},
      {"three_zones",
       "zone",
       {"3", "2"},
       [](auto& g) {
         g.zones.push_back({0, 500, 501});
       },
       true},
      {"shallow_groove", "stock.groove_depth", {"11.0000", "11.2500"}, [](auto& g) { g.groove_depth_mm = 11; }, true},
      {"inner_half_undercut",
       "zone[0].inner_radius",
       {"440.0000", "R1c = 446.8556", "side -1"},
       [](auto& g) { g.zones[0].inner_radius_mm = 440; },
       true},
  };
  return list;
}

TEST(FaceGearMake, RefusesWithKeyValueAndLimit) {
  for (const auto& r : refusals()) {
    SCOPED_TRACE(r.name);
    auto g = r.helical ? double_helical_parameters() : offset_gear();
    r.spoil(g);
    const auto made = face_gear::FaceGear::make(g);
    const auto* list = made.refused();
    ASSERT_TRUE(list);
    ASSERT_FALSE(list->empty());
    bool found = false;
    for (const auto& said : *list) {
      EXPECT_EQ(said.diagnostic.kind, DiagnosticKind::refused_input);
      if (said.key != r.key) continue;
      bool all = true;
      for (const auto& word : r.words) all = all && said.diagnostic.message.find(word) != std::string::npos;
      found = found || all;
    }
    std::string texts;
    for (const auto& said : *list) texts += said.key + ": " + said.diagnostic.message + "\n";
    EXPECT_TRUE(found) << texts;
  }
}

/// Several faults are all told at once.
TEST(FaceGearMake, TellsEveryFault) {
  auto g = double_helical_parameters();
  g.zones[0].inner_radius_mm = 440;
  g.zones[1].outer_radius_mm = 520;
  g.groove_depth_mm = 1;
  const auto made = face_gear::FaceGear::make(g);
  const auto& list = made.error();
  std::vector<std::string> keys;
  for (const auto& r : list) keys.push_back(r.key);
  EXPECT_EQ(keys, (std::vector<std::string>{"zone[0].inner_radius", "zone[1].outer_radius", "stock.groove_depth"}));
}

TEST(FaceGearMake, WarnsWhereAGearIsPossibleButPoor) {
  const auto warnings = [](const face_gear::FaceGearParameters& g) {
    const auto made = face_gear::FaceGear::make(g);
    std::string all;
    if (const auto* gear = made.value_if())
      for (const auto& w : gear->warnings()) all += w + "\n";
    return all;
  };
  auto g = offset_gear();
  EXPECT_EQ(warnings(g), "");
  g.zones[0].outer_radius_mm = 150;
  EXPECT_NE(warnings(g).find("R2' = 147.7549"), std::string::npos);
  g = offset_gear();
  g.shaper_tip_radius_mm = 0;
  EXPECT_NE(warnings(g).find("r = 145.97"), std::string::npos) << warnings(g);
  g = offset_gear();
  g.groove_depth_mm = 8;
  EXPECT_NE(warnings(g).find("groove_depth = 8.0000"), std::string::npos);
  auto n = case_named("dhfg_normal").parameters();
  n.shaper_tip_radius_mm = 2.5;
  n.zones = {{radians(30), 520, 580}};
  EXPECT_NE(warnings(n).find("2.4046"), std::string::npos) << warnings(n);
  auto few = case_named("few_teeth").parameters();
  few.zones = {{0, 33, 34.5}};
  EXPECT_NE(warnings(few).find("R1b = 33.4783"), std::string::npos) << warnings(few);
}

/// Whatever the numbers: a gear or reasons, never an exception, a hang or a NaN in a limit.
TEST(FaceGearMake, AnyNumbersGiveAGearOrReasons) {
  std::mt19937_64 generator(99);
  const auto pick = [&](std::initializer_list<double> values) { return values.begin()[generator() % values.size()]; };
  int gears = 0;
  for (int n = 0; n < 3000; ++n) {
    face_gear::FaceGearParameters g;
    g.teeth = int(pick({-1, 0, 4, 5, 30, 88, 88, 88, 180, 10000}));
    g.shaper_teeth = int(pick({-1, 0, 4, 10, 25, 25, 25, 30, 1000}));
    g.module_mm = pick({-1, 0, 0.05, 3, 3, 3, 3, 100, NAN, INFINITY});
    g.module_plane = generator() % 2 ? face_gear::ModulePlane::normal : face_gear::ModulePlane::transverse;
    g.pressure_angle_rad = radians(pick({5, 14.5, 20, 20, 20, 25, 45, -20}));
    g.addendum_coefficient = pick({0.1, 0.6, 1, 1, 1, 2});
    g.clearance_coefficient = pick({0, 0.25, 0.25, 1});
    g.shaft_angle_rad = radians(pick({60, 75, 90, 90, 90, 110, 120, 180}));
    g.offset_mm = pick({0, 0, 15, -15, 45, 90, 1e9, -1e-300});
    g.shaper_tip_radius_mm = pick({0, 0, 0.5, 0.9, 100});
    g.backlash_mm = pick({0, 0, 0.05, 2.9});
    if (generator() % 3 == 0) g.reference_radius_mm = pick({1e-9, 132, 450, 1e300});
    const double inner = pick({1e-3, 100, 128, 131, 135, 140, 450});
    g.zones = {{radians(pick({0, 0, 1e-9, 20, -30, 60})), inner, inner + pick({0.001, 3, 8, 1000})}};
    const auto made = face_gear::FaceGear::make(g);
    if (const auto* list = made.refused()) {
      ASSERT_FALSE(list->empty());
      for (const auto& r : *list) {
        EXPECT_FALSE(r.key.empty());
        EXPECT_FALSE(r.diagnostic.message.empty());
      }
      continue;
    }
    ++gears;
    const auto& gear = made.value();
    const auto& limits = gear.rings()[0].limits;
    EXPECT_TRUE(std::isfinite(gear.blank_top()) && std::isfinite(gear.lowest_root()));
    EXPECT_LT(gear.lowest_root(), gear.blank_top());
    EXPECT_TRUE(std::isfinite(limits.inner_limit) && std::isfinite(*limits.pointing_radius));
    EXPECT_LE(limits.hard_inner_limit, gear.inner_radius());
  }
  EXPECT_GT(gears, 3);
}

}  // namespace
}  // namespace toothpath::test
