// Pairs of gears that stand on tooth spaces: those that are conjugate by theory show rounding, others what clouds of
// points give.
#include "geometry/contact/toothed_pair.h"

#include <gtest/gtest.h>

#include "geometry/cylindrical/part.h"
#include "geometry/face_gear/part.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/flank_grid/samples.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/geometry/straight_bevel/samples.h"

namespace toothpath::test {
namespace {

using contact::MatePlace;
using contact::OutsideShafts;
using contact::RollResult;
using contact::ToothedMember;
using straight_bevel::Form;
using Part = std::shared_ptr<const tooth_space::ToothedPart>;

constexpr double kRounding = 1e-12;  // rad

std::vector<ToothedMember> members(const Part& gear, const Part& mate, const MatePlace& place, int side) {
  return contact::toothed_members({gear.get(), mate.get(), place}, side, {13, 17, 17, 33}).value();
}
RollResult rolled(const std::vector<ToothedMember>& of, int steps = 8) {
  contact::RollOptions options;
  options.steps = steps;
  return contact::roll(of, options).value();
}
RollResult rolled(const Part& gear, const Part& mate, const MatePlace& place, int side) {
  return rolled(members(gear, mate, place, side));
}

Part straight(int teeth, Form form) {
  auto g = khk_pinion(form);
  if (teeth == 40) {
    g.teeth = 40;
    g.pitch_angle_rad = straight_bevel::pitch_angle(40, 20, radians(90));
    g.addendum_mm = 1.965, g.dedendum_mm = 4.599, g.tip_angle_rad = radians(65.59398), g.thickness_shift = -0.1256;
  }
  return straight_bevel::part_of(straight_bevel::StraightBevelGear::make(g).value());
}
Part spiral(const spiral_bevel::SpiralBevelParameters& g) {
  return spiral_bevel::part_of(spiral_bevel::SpiralBevelGear::make(g).value());
}
MatePlace square_shafts(double pinion_axial_mm = 0, const contact::Misalignment& moved = {}) {
  OutsideShafts shafts;
  shafts.angle_rad = radians(90);
  shafts.mate_axial_mm = pinion_axial_mm;
  return contact::outside_place(shafts, moved);
}
cylindrical::CylindricalParameters helical(int teeth, double degrees_, double shift) {
  auto g = shifted_spur();
  g.teeth = teeth, g.profile_shift = shift, g.zones = {{radians(degrees_), -10, 10}};
  return g;
}
MatePlace parallel(double distance_mm, const contact::Misalignment& moved = {}) {
  OutsideShafts shafts;
  shafts.distance_mm = distance_mm;
  return contact::outside_place(shafts, moved);
}

/// The pinion that mills the double helical face gear's mate: both halves, both flanks, line contact.
TEST(ToothedPair, FaceGearAndItsMilledPinion) {
  face_gear::FaceGearParameters f;
  f.teeth = 180, f.shaper_teeth = 30, f.module_mm = 5, f.module_plane = ModulePlane::transverse;
  f.pressure_angle_rad = radians(20), f.shaper_tip_radius_mm = 1.5, f.reference_radius_mm = 472;
  f.zones = {{radians(-30), 449, 468}, {radians(30), 476, 496}};
  const auto face = face_gear::FaceGear::make(f).value();
  const Part gear = face_gear::part_of(face), pinion = cylindrical::part_of(made(double_helical_pinion()));
  const MatePlace place = contact::pinion_place(face.rings().front().surface, 30);
  for (const int side : {1, -1}) {
    const RollResult r = rolled(gear, pinion, place, side);
    EXPECT_LT(r.error_range_rad, kRounding);
    ASSERT_EQ(r.patterns.size(), 2u);
    for (const auto& pattern : r.patterns) EXPECT_GT(pattern.marked_share, 0.95);
    EXPECT_GE(r.least_touching, 2);
  }
  // The place of the pinion that the closed form knows, misaligned, too.
  const contact::Misalignment moved{0.1, 0.2, 0.001, 0.05};
  const auto closed = contact::make_pinion(face.rings().front().surface, 30, moved);
  const MatePlace off = contact::pinion_place(face.rings().front().surface, 30, moved);
  EXPECT_LT((off.to_mate(closed.foot + closed.a * (closed.L0 + 7)) - Vec3(0, 0, 7)).norm(), 1e-10);
}

TEST(ToothedPair, InvoluteGearsAtAnyDistance) {
  for (const double beta : {0.0, 20.0}) {
    const Part gear = cylindrical::part_of(made(helical(37, -beta, -0.1))),
               pinion = cylindrical::part_of(made(helical(24, beta, 0.2)));
    const double least = 1.5 * (24 + 37) / std::cos(radians(beta)) + 0.3;
    for (const double more : {0.0, 0.4, 1.0}) {
      const RollResult r = rolled(gear, pinion, parallel(least + more), more == 0 ? 1 : -1);
      EXPECT_LT(r.error_range_rad, kRounding) << beta << " " << more;
      EXPECT_GT(r.contact_ratio, 1.2);
    }
  }
}

/// Shafts that are neither parallel nor cross: teeth touch in a point that runs along a line, at any distance and
/// beside the angle at which they lie along each other.
TEST(ToothedPair, InvoluteGearsOnCrossedShafts) {
  for (const auto& [gear_helix, mate_helix] : {std::pair(30.0, 15.0), {-20.0, -25.0}}) {
    const Part gear = cylindrical::part_of(made(helical(37, gear_helix, 0))),
               pinion = cylindrical::part_of(made(helical(24, mate_helix, 0)));
    const double touching = 1.5 * (37 / std::cos(radians(gear_helix)) + 24 / std::cos(radians(mate_helix)));
    for (const double more : {0.1, 0.5})
      for (const double beside : {0.0, 0.5}) {
        contact::OutsideShafts shafts;
        shafts.angle_rad = radians(-(gear_helix + mate_helix) + beside);
        shafts.distance_mm = touching + more, shafts.skew = true;
        const RollResult r = rolled(gear, pinion, contact::outside_place(shafts), beside == 0 ? 1 : -1);
        EXPECT_LT(r.error_range_rad, kRounding) << gear_helix << " " << more << " " << beside;
        EXPECT_GT(r.contact_ratio, 1.2);
        EXPECT_TRUE(beside != 0 || !(r.patterns[0].at_inner_end || r.patterns[0].at_outer_end)) << gear_helix;
      }
  }
}

TEST(ToothedPair, StraightBevelGearsAtTheirApex) {
  for (const Form form : {Form::octoid, Form::spherical_involute})
    EXPECT_LT(rolled(straight(40, form), straight(20, form), square_shafts(), 1).error_range_rad, kRounding);
  // Another form is another tooth: 3 um at the tips.
  EXPECT_GT(
      rolled(straight(40, Form::octoid), straight(20, Form::spherical_involute), square_shafts(), 1).error_range_rad,
      1e-6);
}

/// Axes askew: the mate's teeth bear on one end of the face, flanks of the other side on the other.
TEST(ToothedPair, AxesAskewBearOnAnEnd) {
  const Part gear = cylindrical::part_of(made(helical(37, 0, -0.1))),
             pinion = cylindrical::part_of(made(helical(24, 0, 0.2)));
  for (const int side : {1, -1})
    for (const double angle : {0.001, -0.001}) {
      contact::Misalignment moved;
      moved.angle_rad = angle;
      const RollResult r = rolled(gear, pinion, parallel(92, moved), side);
      EXPECT_GT(side * angle * r.patterns[0].centre_radius_mm, 0);
      EXPECT_EQ(r.patterns[0].at_outer_end, side * angle > 0);
      EXPECT_EQ(r.patterns[0].at_inner_end, side * angle < 0);
    }
}

/// Material that is left evenly turns an involute pair by its thickness over the base radius, and adds no error.
TEST(ToothedPair, EvenDeviationTurnsByItsLever) {
  const Part gear = cylindrical::part_of(made(helical(37, 0, -0.1))),
             pinion = cylindrical::part_of(made(helical(24, 0, 0.2)));
  auto of = members(gear, pinion, parallel(92), 1);
  const double plain = rolled(of).error_mean_rad, left = 0.01, r_b = 0.5 * 37 * 3 * std::cos(radians(20));
  std::vector<Vec3> places = of[0].flank.points;
  std::reverse(places.begin(), places.end());
  of[0].flank = contact::measured_flank(of[0].flank, 13, 17, places, std::vector<double>(places.size(), left)).value();
  const RollResult r = rolled(of);
  EXPECT_NEAR(r.error_mean_rad, plain - left / r_b, 1e-9);
  EXPECT_LT(r.error_range_rad, 1e-9);
}

/// The gear's turn at which it lies on the pinion, from its flank as columns of azimuths and a cloud of the pinion's.
double turn_of_clouds(const ToothedMember& of, const contact::SpaceFlank& gear, const contact::SpaceFlank& mate,
                      double phi_1) {
  const auto& chart = gear.space->outline().chart;
  double least = 1e300;
  for (int tooth = -2; tooth <= 2; ++tooth) {
    const double turn = of.place.sense * (phi_1 + of.turned_rad + kTwoPi * tooth / of.mate_teeth);
    for (const Vec3& p : mate.points) {
      const Vec3 q = of.place.axes * turned(p, turn) + of.place.origin;
      const Vec2 share = gear.shares(chart.along(q), chart.up(q));
      if (share.minCoeff() < 0 || share.maxCoeff() > 1) continue;
      const double x = share.x() * (gear.columns - 1), y = share.y() * (gear.rows - 1);
      const int c = std::min(int(x), gear.columns - 2), r = std::min(int(y), gear.rows - 2);
      const auto at = [&](int row, int column) { return azimuth(gear.points[gear.index(row, column)]); };
      const double low = at(r, c) + (x - c) * (at(r, c + 1) - at(r, c)),
                   high = at(r + 1, c) + (x - c) * (at(r + 1, c + 1) - at(r + 1, c));
      const double asked = azimuth(q) - (low + (y - r) * (high - low)) - kTwoPi * tooth / of.gear_teeth;
      least = std::min(least, gear.side * asked);
    }
  }
  return gear.side * least;
}

/// The published spiral bevel pair, and one that somebody knows as points, where they stand and off their place: as two
/// clouds of points meet.
TEST(ToothedPair, AgreesWithPointClouds) {
  flank_grid::FlankGridParameters points = sampled(spiral(nasa_gear())->space(0), 36, {9, 17, 0.8});
  const Part gear = spiral(nasa_gear()), pinion = spiral(nasa_pinion()),
             grid = flank_grid::part_of(flank_grid::FlankGridGear::make(points).value());
  const contact::Misalignment moved{0.1, 0.05, 0.001, -0.04};
  for (const auto& [part, place, side] : {std::tuple(gear, square_shafts(0.55), -1),
                                          {gear, square_shafts(0.5, moved), 1},
                                          {grid, square_shafts(0.5), -1}}) {
    const auto of = members(part, pinion, place, side);
    const RollResult r = rolled(of, 4);
    EXPECT_GT(r.error_range_rad, 1e-5);
    const auto table = contact::space_flank(part->space(0), 0, side, 81, 161).value(),
               cloud = contact::space_flank(pinion->space(0), 0, side, 61, 121).value();
    for (const auto& at : r.cycle) EXPECT_NEAR(turn_of_clouds(of[0], table, cloud, at.phi_1), at.phi_2, 2e-6);
  }
}

/// Either gear may carry the grid: the error of its turn is that of the other's by the ratio.
TEST(ToothedPair, EitherGearCarriesTheGrid) {
  const Part gear = spiral(nasa_gear()), pinion = spiral(nasa_pinion());
  const contact::Misalignment moved{0.1, 0.05, 0.001, -0.04}, other_way{0.1, -0.04, 0.001, 0.05};
  const MatePlace place = square_shafts(0, moved), back = contact::seen_from_mate(place),
                  written = square_shafts(0, other_way);
  EXPECT_LT((back.axes - written.axes).norm(), 1e-14);
  EXPECT_LT((back.origin - written.origin).norm(), 1e-14);
  const double of_gear = rolled(gear, pinion, place, -1).error_range_rad,
               of_pinion = rolled(pinion, gear, back, -1).error_range_rad;
  EXPECT_GT(of_gear, 1e-5);
  EXPECT_NEAR(of_pinion / 3, of_gear, 0.02 * of_gear);  // positions differ: eight a pitch of either
}

}  // namespace
}  // namespace toothpath::test
