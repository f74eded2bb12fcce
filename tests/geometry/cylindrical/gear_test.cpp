// Numbers of cylindrical gears against printed ones, and what is refused.
#include <gtest/gtest.h>

#include <functional>
#include <tuple>

#include "geometry/cylindrical/part.h"
#include "geometry/tooth_space/curvature.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

using tooth_space::Piece;

struct Printed {
  bool pinion;  // zone 1 of the double helical pinion, else the spur gear
  int side;
  bool fillet;
  double r, z, azimuth;
  Vec3 p, n;
};

/// To the printed digits: radius and height are rounded, all else belongs to the unrounded ones.
TEST(CylindricalGear, PlacesAndNormalsAreThePrintedOnes) {
  const Printed all[] = {
      {false, 1, false, 36.9, 0, -0.069275424, {36.811492298, -2.554219018, 0}, {0.461909042847, 0.886927300367, 0}},
      {false, -1, false, 36.9, 0, 0.069275424, {36.811492298, 2.554219018, 0}, {0.461909042847, -0.886927300367, 0}},
      {false,
       1,
       false,
       38.925,
       -8,
       -0.096212399,
       {38.744977964, -3.739292385, -8},
       {0.575871307835, 0.817540357910, 0}},
      {false, -1, false, 38.925, 8, 0.096212399, {38.744977964, 3.739292385, 8}, {0.575871307835, -0.817540357910, 0}},
      {false, 1, true, 33.255, 0, -0.032910138, {33.236992760, -1.094229085, 0}, {0.703663586729, 0.710533290362, 0}},
      {false, -1, true, 33.255, 0, 0.032910138, {33.236992760, 1.094229085, 0}, {0.703663586729, -0.710533290362, 0}},
      {true,
       1,
       false,
       75.5,
       14.15,
       0.053464887,
       {75.392117548, 4.034676146, 14.15},
       {0.270952540861, 0.836169124952, -0.476870962711}},
      {true,
       -1,
       false,
       75.5,
       14.15,
       0.164388615,
       {74.482153731, 12.355515997, 14.15},
       {0.445273084784, -0.757842968490, 0.476870962711}},
      {true,
       1,
       false,
       78.875,
       5.47,
       -0.032820355,
       {78.832522695, -2.588240806, 5.47},
       {0.420226729914, 0.772012681494, -0.476870962711}},
      {true,
       -1,
       false,
       78.875,
       22.83,
       0.250673857,
       {76.409800276, 19.565480999, 22.83},
       {0.577152562098, -0.662939669190, 0.476870962711}},
      {true,
       1,
       true,
       69.425,
       14.15,
       0.080643976,
       {69.199371280, 5.592641550, 14.15},
       {0.578526637437, 0.729966771104, -0.363944285377}},
      {true,
       -1,
       true,
       69.425,
       14.15,
       0.137209525,
       {68.772511358, 9.495909990, 14.15},
       {0.722623268569, -0.587673522343, 0.363944285377}},
  };
  const auto spur = made(shifted_spur()), pinion = made(double_helical_pinion());
  for (const Printed& q : all) {
    const auto& space = q.pinion ? pinion.space(1) : spur.space(0);
    const auto piece = q.fillet ? tooth_space::fillet_of(q.side) : tooth_space::flank_of(q.side);
    double u = space.kernel().theta_at(q.r);
    if (q.fillet) {
      double low = space.kernel().alpha_n, high = kPi / 2;
      for (int k = 0; k < 100; ++k) {
        u = 0.5 * (low + high);
        (radius(space.point(piece, u, q.z)->p) > q.r ? low : high) = u;
      }
    }
    const auto at = space.point(piece, u, q.z);
    ASSERT_TRUE(at);
    EXPECT_NEAR(azimuth(at->p), q.azimuth, 2e-9) << q.r;
    EXPECT_LT((at->p - q.p).norm(), 3e-9) << q.r;
    EXPECT_LT((at->n - q.n).norm(), 5e-10) << q.r;
  }
}

/// A face gear's shaper is a cylindrical gear: without its allowance the pinion of the double helical face gear is it.
TEST(CylindricalGear, ThePinionIsTheShaperOfItsFaceGear) {
  const auto face = double_helical_parameters();
  auto g = double_helical_pinion();
  g.thickness_allowance_mm = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto shaper = face_gear::make_shaper<double>(face, face.zones[k].helix_angle_rad);
    const cylindrical::InvoluteKernel<double> pinion(g, g.zones[k]);
    EXPECT_NEAR(pinion.r, shaper.r_p, 1e-13);
    EXPECT_NEAR(pinion.r_b, shaper.r_b, 1e-13);
    EXPECT_NEAR(pinion.kappa, shaper.kappa, 1e-16);
    EXPECT_NEAR(pinion.cos_bb, shaper.cos_bb, 1e-15);
    EXPECT_NEAR(pinion.eta_b, shaper.theta_0, 1e-15);
  }
}

/// Catalogue numbers of a helical pair, and a spur gear with profile shift.
TEST(CylindricalGear, DiametersAreThoseOfCatalogues) {
  cylindrical::CylindricalParameters g;
  g.teeth = 12;
  g.module_mm = 3;
  g.pressure_angle_rad = radians(20);
  g.profile_shift = 0.09809;
  g.zones = {{radians(30), 0, 20}};
  const cylindrical::InvoluteKernel<double> pinion(g, g.zones[0]);
  EXPECT_NEAR(degrees(pinion.alpha_t), 22.79588, 5e-6);
  EXPECT_NEAR(2 * pinion.r, 41.569, 5e-4);
  EXPECT_NEAR(2 * pinion.r_b, 38.322, 5e-4);
  EXPECT_NEAR(2 * pinion.r_f, 34.658, 5e-4);
  g.teeth = 60;
  g.profile_shift = 0;
  const cylindrical::InvoluteKernel<double> wheel(g, g.zones[0]);
  EXPECT_NEAR(2 * wheel.r, 207.846, 5e-4);
  EXPECT_NEAR(2 * wheel.r_b, 191.611, 5e-4);
  EXPECT_NEAR(2 * wheel.r_f, 200.346, 5e-4);
  // Without backlash the thicknesses on the working circles fill the pitch: at the printed distance of 125 mm.
  const double apart = 125.000001, working = std::acos((pinion.r_b + wheel.r_b) / apart);
  EXPECT_NEAR(degrees(working), 23.11263, 5e-6);
  const auto space_arc = [&](const auto& w) { return 2 * (w.r_b / std::cos(working)) * w.eta(std::tan(working)); };
  EXPECT_NEAR(space_arc(pinion) + space_arc(wheel), 2 * kPi * pinion.r_b / std::cos(working) / 12, 1e-6);
  g.teeth = 19;
  g.module_mm = 4;
  g.profile_shift = 0.5;
  g.zones = {{0, 0, 20}};
  EXPECT_NEAR(2 * cylindrical::InvoluteKernel<double>(g, g.zones[0]).r_b, 71.41663917973, 1e-11);
}

TEST(CylindricalGear, ThicknessOnTheReferenceCylinder) {
  for (const auto& g : {shifted_spur(), double_helical_pinion(), left_helical()})
    for (const auto& zone : g.zones) {
      const cylindrical::InvoluteKernel<double> w(g, zone);
      const double space = 2 * w.r * w.eta(w.theta_at(w.r)) * w.cos_b;  // normal
      EXPECT_NEAR(space,
                  kPi * w.m_n / 2 - 2 * g.profile_shift * g.module_mm * std::tan(w.alpha_n) - g.thickness_allowance_mm,
                  1e-12);
    }
}

TEST(CylindricalGear, BothReadingsOfTheModuleAreOneAtHelixZero) {
  auto g = shifted_spur();
  const auto normal = made(g);
  g.module_plane = ModulePlane::transverse;
  const auto transverse = made(g);
  for (const Piece piece : {Piece::flank_plus, Piece::fillet_minus, Piece::root}) {
    const auto a = normal.space(0).at(piece, 0.5, 3), b = transverse.space(0).at(piece, 0.5, 3);
    EXPECT_LT((a->p - b->p).norm(), 1e-14);
    EXPECT_LT((a->n - b->n).norm(), 1e-15);
  }
  // And a helix that vanishes leads there in proportion.
  for (const double deg : {0.1, 1e-3, 1e-6}) {
    g = shifted_spur();
    g.zones[0].helix_angle_rad = radians(deg);
    const auto leaning = made(g);
    EXPECT_NEAR(
        (leaning.space(0).at(Piece::flank_plus, 0.5, 5)->p - normal.space(0).at(Piece::flank_plus, 0.5, 5)->p).norm(),
        5 * radians(deg), 0.2 * 5 * radians(deg));
  }
}

/// Places all over a space, between its tip edges, over a few millimetres to either side of a height.
std::vector<Vec3> surface_near(const cylindrical::InvoluteSpace& space, double z, double wide, int across, int along) {
  std::vector<Vec3> out;
  for (int n = 0; n < tooth_space::kPieces; ++n) {
    const Piece piece{std::uint8_t(n)};
    tooth_space::Borders b = space.borders(piece);
    if (piece == Piece::flank_plus) b.from = space.kernel().theta_a;
    if (piece == Piece::flank_minus) b.to = space.kernel().theta_a;
    for (int i = 0; i <= across; ++i)
      for (int k = 0; k <= along; ++k)
        out.push_back(
            space.point(piece, b.from + (b.to - b.from) * i / across, z + wide * (along > 0 ? 2.0 * k / along - 1 : 0))
                ->p);
  }
  return out;
}

/// The ball on the root against all places of the space: it meets none, and a little larger it meets one.
TEST(CylindricalGear, TheRootBallJustFits) {
  for (const auto& [g, zone] : {std::pair{shifted_spur(), 0}, {double_helical_pinion(), 1}, {left_helical(), 0}}) {
    const auto gear = made(g);
    const auto& space = gear.space(zone);
    const auto& w = space.kernel();
    const double z = 0.5 * (w.z_from + w.z_to), R = limits_of(space).root_ball_radius_mm;
    const auto places = surface_near(space, z, R, 400, g.zones[0].helix_angle_rad == 0 ? 0 : 100);
    const auto depth = [&](double radius) {
      const Vec3 c = turned(Vec3(w.r_f + radius, 0, z), w.kappa * z);
      double least = INFINITY;
      for (const Vec3& p : places) least = std::min(least, (p - c).norm());
      return radius - least;
    };
    EXPECT_LT(depth(R), 1e-9);
    EXPECT_GT(depth(1.01 * R), 1e-4);
  }
}

/// Circles through three neighbouring places of the transverse curve, on the spur gear.
TEST(CylindricalGear, TheFilletIsNoTighterThanToldAndAsTight) {
  const auto gear = made(shifted_spur());
  const auto& space = gear.space(0);
  const tooth_space::Borders b = space.borders(Piece::fillet_minus);
  double least = INFINITY;
  constexpr int kPlaces = 2000;
  const auto at = [&](int k) { return space.point(Piece::fillet_minus, b.from + (b.to - b.from) * k / kPlaces, 0)->p; };
  for (int k = 1; k < kPlaces; ++k) {
    const Vec3 a = at(k) - at(k - 1), c = at(k + 1) - at(k), e = at(k + 1) - at(k - 1);
    least = std::min(least, a.norm() * c.norm() * e.norm() / (2 * std::abs(a.cross(c).z())));
  }
  EXPECT_NEAR(limits_of(space).fillet_radius_min_mm, least, 1e-4);
  EXPECT_NEAR(least, 1.2463, 1e-4);
}

TEST(CylindricalGear, TopLandsAreThePrintedOnes) {
  EXPECT_NEAR(limits_of(made(shifted_spur()).space(0)).top_land_mm, 1.945, 1e-3);
  EXPECT_NEAR(limits_of(made(double_helical_pinion()).space(1)).top_land_mm, 3.588, 1e-3);
}

struct Spoiled {
  const char* key;
  std::vector<std::string> words;
  std::function<void(cylindrical::CylindricalParameters&)> spoil;
};

TEST(CylindricalGear, RefusesWithKeyValueLimitAndWhatWouldDo) {
  const Spoiled all[] = {
      {"teeth", {"teeth = 3", "[5, 2000]"}, [](auto& g) { g.teeth = 3; }},
      {"module", {"module = 0", "[0.05, 100] mm"}, [](auto& g) { g.module_mm = 0; }},
      {"pressure_angle", {"pressure_angle = 50 deg"}, [](auto& g) { g.pressure_angle_rad = radians(50); }},
      {"thickness_allowance", {"thickness_allowance = 0.1 mm"}, [](auto& g) { g.thickness_allowance_mm = 0.1; }},
      {"zone", {"no zone"}, [](auto& g) { g.zones.clear(); }},
      {"zone[0].to", {"to = -12 mm is not above from = -10 mm"}, [](auto& g) { g.zones[0].to_mm = -12; }},
      {"zone[1].from",
       {"from = 9 mm", "at 10 mm"},
       [](auto& g) {
         g.zones.push_back({0, 9, 20});
       }},
      {"zone[1].helix_angle",
       {"reference diameter", "equal or opposite"},
       [](auto& g) {
         g.zones.push_back({0.1, 11, 20});
       }},
      {"dedendum_coefficient", {"basic rack", "or less"}, [](auto& g) { g.dedendum_coefficient = 2.9; }},
      {"root_radius_coefficient", {"exceeds 0.47", "use 0.47"}, [](auto& g) { g.root_radius_coefficient = 0.5; }},
      {"profile_shift", {"undercuts", "use -0.40"}, [](auto& g) { g.profile_shift = -0.6; }},
      {"addendum_coefficient",
       {"top land", "tip_diameter of", "or less"},
       [](auto& g) { g.addendum_coefficient = 1.8; }},
      {"tip_diameter", {"where the involute begins"}, [](auto& g) { g.tip_diameter_mm = 60; }},
      {"bore_diameter", {"bore_diameter = 70", "root diameter"}, [](auto& g) { g.bore_diameter_mm = 70; }},
      {"groove_diameter", {"one zone"}, [](auto& g) { g.groove_diameter_mm = 50; }},
  };
  for (const Spoiled& s : all) {
    auto g = shifted_spur();
    s.spoil(g);
    const auto made = cylindrical::CylindricalGear::make(g);
    ASSERT_FALSE(made.has_value()) << s.key;
    EXPECT_EQ(made.error().size(), 1u) << s.key;
    EXPECT_EQ(made.error()[0].key, s.key) << made.error()[0].diagnostic.message;
    for (const auto& word : s.words)
      EXPECT_NE(made.error()[0].diagnostic.message.find(word), std::string::npos) << made.error()[0].diagnostic.message;
  }
}

/// What a refusal proposes is taken.
TEST(CylindricalGear, WhatWouldDoDoes) {
  auto g = shifted_spur();
  g.profile_shift = std::ceil(1e4 * cylindrical::least_profile_shift(g, g.zones[0])) / 1e4;
  EXPECT_TRUE(cylindrical::CylindricalGear::make(g).has_value());
  g.profile_shift -= 1e-4;
  EXPECT_FALSE(cylindrical::CylindricalGear::make(g).has_value());
  g = shifted_spur();
  g.root_radius_coefficient = std::floor(1e4 * cylindrical::largest_root_radius_coefficient(g, g.zones[0])) / 1e4;
  EXPECT_TRUE(cylindrical::CylindricalGear::make(g).has_value());
  g.root_radius_coefficient += 1e-4;
  EXPECT_FALSE(cylindrical::CylindricalGear::make(g).has_value());
  g = shifted_spur();
  const auto most =
      cylindrical::tip_diameter_of_land(cylindrical::InvoluteKernel<double>(g, g.zones[0]), g.least_land * g.module_mm);
  ASSERT_TRUE(most);
  g.tip_diameter_mm = *most - 1e-6;
  EXPECT_TRUE(cylindrical::CylindricalGear::make(g).has_value());
  g.tip_diameter_mm = *most + 1e-6;
  EXPECT_FALSE(cylindrical::CylindricalGear::make(g).has_value());
  // Printed limits of racks with 1.25 and 0.38: pointed and least shift.
  for (const auto& [teeth, land, least] : {std::tuple{12, 0.602, 0.298}, {24, 1.095, -0.404}, {60, 2.073, -2.509}}) {
    g = shifted_spur();
    g.teeth = teeth;
    EXPECT_NEAR(cylindrical::least_profile_shift(g, g.zones[0]), least, 5e-4);
    g.profile_shift = land;
    const auto limits = limits_of(cylindrical::InvoluteSpace(cylindrical::InvoluteKernel<double>(g, g.zones[0])));
    EXPECT_NEAR(limits.top_land_mm, 0.2 * g.module_mm, 0.01 * g.module_mm);
  }
}

/// Zones as the job counts them, with rising z; a turned blank with its groove.
TEST(CylindricalPart, IsTheTurnedBlankWithItsZones) {
  const auto part = cylindrical::part_of(made(double_helical_pinion()));
  ASSERT_EQ(part->zones(), 2);
  EXPECT_LT(part->space(0).outline().s_to, 26);
  EXPECT_GT(part->space(0).outline().s_from, part->space(1).outline().s_to);  // s = -z
  EXPECT_EQ(part->blank_top(), 80);
  EXPECT_EQ(part->lowest_root(), 68.75);
  ASSERT_TRUE(part->groove_floor());
  EXPECT_EQ(*part->groove_floor(), 66);
  for (const auto& [r, z, held] : {std::tuple{79.9, 10.0, true},
                                   {80.1, 10.0, false},
                                   {79.9, 25.1, false},
                                   {79.9, -25.1, false},
                                   {66.1, 0.0, false},
                                   {65.9, 0.0, true},
                                   {30.1, 0.0, true},
                                   {29.9, -20.0, false}})
    EXPECT_EQ(part->in_blank(Vec3(0, -r, z)), held) << r << ' ' << z;
  EXPECT_FALSE(cylindrical::part_of(made(shifted_spur()))->groove_floor());
}

}  // namespace
}  // namespace toothpath::test
