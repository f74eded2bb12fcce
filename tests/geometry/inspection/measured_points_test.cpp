// Measured points read and put on their flanks; pitch and run-out of planted errors found again.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/face_gear/inverse.h"
#include "geometry/inspection/dmis.h"
#include "geometry/inspection/flank_points.h"
#include "geometry/inspection/tooth_index.h"
#include "geometry/modification/flank_correction.h"
#include "tests/geometry/inspection/measured_teeth.h"
#include "tests/support/inspection_points.h"
#include "tests/support/sample_gears.h"

namespace toothpath {
namespace {

using inspection::PointFile;
using test::PlantedErrors;

PointFile file_of(const std::vector<test::SeenPoint>& seen, bool normals) {
  PointFile file;
  int line = 0;
  for (const auto& s : seen)
    file.points.push_back({{"m.txt", ++line, 1}, "", s.p, normals ? std::optional(s.n) : std::nullopt});
  return file;
}

struct Gears {
  const char* name;
  face_gear::FaceGearParameters parameters;
};

std::vector<Gears> gears() {
  return {{"spur", test::small_spur()},
          {"offset", test::offset_gear()},
          {"double helical", test::quarter_dhfg()},
          {"conical", test::conical_gear()}};
}

TEST(MeasuredPoints, EveryPointIsPutOnTheFlankItWasMadeOn) {
  for (const auto& [name, parameters] : gears()) {
    const auto gear = test::made(parameters);
    const auto grid = test::grid_of(gear, 7, 9);
    PlantedErrors errors;
    test::Random random(5);
    for (int k = 0; k < parameters.teeth; ++k) errors.index.push_back(random(-0.05, 0.05));
    errors.shape = [](const auto& p) { return 0.01 * std::sin(3.0 * p.row + p.column); };
    const std::vector<int> teeth = {0, 1, parameters.teeth / 2, parameters.teeth - 1};
    for (const double ball : {0.0, 0.2 * parameters.module_mm})
      for (const bool normals : {false, true}) {
        const auto seen = test::seen(grid, teeth, gear.pitch(), gear.rings()[0].surface.M2, errors, ball);
        // Without normals a ball that touches one flank may nearly touch the other: the file must then say which.
        if (ball > 0 && !normals) continue;
        const auto placed = inspection::place_on_flanks(drawn_solid(gear), file_of(seen, normals), ball);
        ASSERT_TRUE(placed) << name << ": " << placed.error().text();
        ASSERT_EQ(placed->size(), seen.size());
        double worst = 0, worst_theta = 0, worst_B = 0;
        for (std::size_t k = 0; k < seen.size(); ++k) {
          const auto& is = (*placed)[k];
          const auto& p = *seen[k].nominal;
          ASSERT_EQ(is.zone, p.zone) << name;
          ASSERT_EQ(is.side, p.side) << name;
          ASSERT_EQ(is.tooth, seen[k].tooth) << name;
          const auto& f = gear.rings()[std::size_t(p.zone)].surface;
          // M2 differs between rings of other hand only by rounding; the turn is that of the first.
          const double turn = errors.index[std::size_t(seen[k].tooth)] / gear.rings()[0].surface.M2;
          worst = std::max(worst, std::abs(is.deviation_mm - errors.shape(p) - p.side * f.M2 * turn));
          worst_theta = std::max(worst_theta, std::abs(is.theta - p.theta));
          worst_B = std::max(worst_B, std::abs(is.B - p.B));
        }
        EXPECT_LT(worst, 1e-9) << name;
        EXPECT_LT(worst_B, 1e-9) << name;
        // A turned tooth is met at the foot of its parallel surface: theta moves with the turn, not with the shape.
        EXPECT_LT(worst_theta, 0.06 / gear.rings()[0].surface.shaper.r_b) << name;
      }
  }
}

TEST(MeasuredPoints, PointsOnNoFlankAreRefusedAtTheirPlaceWithWhatIsWrong) {
  const auto gear = test::made(test::small_spur());
  const auto grid = test::grid_of(gear, 5, 9);
  const auto seen = test::seen(grid, {0, 7}, gear.pitch(), gear.rings()[0].surface.M2, {});
  const auto refused = [&](const std::function<Vec3(const test::SeenPoint&, std::size_t)>& moved, bool normals = true) {
    auto copy = seen;
    for (std::size_t k = 0; k < copy.size(); ++k) copy[k].p = moved(seen[k], k);
    const auto placed = inspection::place_on_flanks(drawn_solid(gear), file_of(copy, normals));
    return placed ? std::string("taken") : placed.error().text();
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(refused([](const auto& s, std::size_t k) { return k == 13 ? Vec3(s.p + 0.7 * s.n) : s.p; }),
      "m.txt:14:1: error: (");
  has(refused([](const auto& s, std::size_t k) { return k == 13 ? Vec3(s.p + 0.7 * s.n) : s.p; }),
      "lies 0.7000 mm off the nearest flank (zone 0, tooth 0, flank +1), at most 0.5 mm: a point of another surface, "
      "or "
      "of another job, gear frame or unit");
  has(refused([](const auto& s, std::size_t) { return Vec3(s.p / 25.4); }), "; all places are in inch: mm are needed");
  has(refused([](const auto& s, std::size_t) { return Vec3(s.p * 1000); }), "; all places are in um: mm are needed");
  has(refused([](const auto& s, std::size_t) { return Vec3(s.p / 1000); }), "; all places are in m: mm are needed");
  has(refused([](const auto& s, std::size_t) { return Vec3(s.p + 0.75 * s.n); }),
      "; all points stand about 0.75 mm off their flanks: are they the centres of a ball of that radius?");
  const auto& f = gear.rings()[0].surface;
  const auto on_flank = [&](double r, double z) {
    const auto at = face_gear::invert_flank(f, 1, r, z);
    return f.flank(1, at->theta, at->B).p;
  };
  const Vec3 above = on_flank(63, f.z_tip(63) + 0.3), outside = on_flank(65.4, seen[8].p.z());
  has(refused([&](const auto& s, std::size_t k) { return k == 5 ? above : s.p; }),
      "lies 0.3000 mm beyond the tip (zone 0, tooth 0, flank +1), at most 0.05 mm");
  has(refused([&](const auto& s, std::size_t k) { return k == 8 ? outside : s.p; }),
      "lies 0.4000 mm beyond the outer end of the teeth (zone 0, tooth 0, flank +1), at most 0.05 mm");
  has(refused([](const auto&, std::size_t) { return Vec3(0, 0, 0); }),
      "lies where no flank of the gear can be measured");
  // Half-way between the flanks of a thin tooth two answers are alike.
  const auto& a = grid[4 * 9 + 8];
  const inspection::InspectionPoint* b = nullptr;
  for (const auto& p : grid)
    if (p.side == -1 && p.row == 4 && p.column == 8) b = &p;
  const Vec3 middle = 0.5 * (a.p + b->p);
  if ((a.p - middle).norm() < 0.45)
    has(refused([&](const auto& s, std::size_t k) { return k == 0 ? middle : s.p; }, false), "state the normals i j k");
}

Result<modification::ScatteredFit> fit_of(const face_gear::FaceGear& gear,
                                          const std::vector<inspection::InspectionPoint>& grid,
                                          const std::vector<inspection::FlankPoint>& placed, int zone, int side) {
  std::vector<modification::FlankDeviation> nominal;
  for (const auto& p : grid)
    if (p.zone == zone && p.side == side) nominal.push_back({p.row, p.column, p.theta, radius(p.p), 0});
  std::vector<modification::ScatteredDeviation> points;
  for (const auto& p : placed)
    if (p.zone == zone && p.side == side) points.push_back({p.tooth, p.theta, radius(p.foot), p.deviation_mm});
  return modification::FlankCorrection::fit_scattered(points, nominal,
                                                      gear.rings()[std::size_t(zone)].surface.shaper.theta_t);
}

TEST(MeasuredPoints, PitchAndRunOutOfPlantedErrorsAreFoundAgain) {
  for (const auto& [name, parameters] : gears()) {
    const auto gear = test::made(parameters);
    const int N = parameters.teeth;
    const auto grid = test::grid_of(gear, 6, 9);
    test::Random random(11);
    PlantedErrors errors;
    for (int k = 0; k < N; ++k) {
      errors.index.push_back(0.015 * std::cos(kTwoPi * k / N) + random(-0.004, 0.004));
      errors.thick.push_back(random(-0.003, 0.003));
    }
    errors.shape = [](const auto& p) { return 0.004 + 0.002 * p.row - 0.0002 * p.column * p.column; };
    errors.noise = 0.0005;
    const auto seen = test::seen(grid, test::teeth_of(N), gear.pitch(), gear.rings()[0].surface.M2, errors);
    const auto placed = inspection::place_on_flanks(drawn_solid(gear), file_of(seen, false));
    ASSERT_TRUE(placed) << name << placed.error().text();
    std::vector<inspection::ToothPlace> places;
    for (int zone = 0; zone < int(gear.rings().size()); ++zone)
      for (const int side : {1, -1}) {
        const auto fit = fit_of(gear, grid, *placed, zone, side);
        ASSERT_TRUE(fit) << name << fit.error().message;
        ASSERT_EQ(int(fit->teeth.size()), N);
        // The shape without the teeth's own places: what was planted, with the mean of all teeth.
        double mean = 0;
        for (int k = 0; k < N; ++k) mean += (side * errors.index[std::size_t(k)] + errors.thick[std::size_t(k)]) / N;
        double worst = 0;
        for (const auto& p : grid)
          if (p.zone == zone && p.side == side)
            worst = std::max(worst, std::abs(fit->field.at(p.theta, radius(p.p)).value + errors.shape(p) + mean));
        EXPECT_LT(worst, 0.0003) << name;  // noise of 0.5 um over all teeth
        for (const auto& t : fit->teeth) places.push_back({zone, side, t.tooth, t.middle_mm});
      }
    const auto index = inspection::index_of_teeth(drawn_solid(gear), places);
    ASSERT_TRUE(index);
    ASSERT_EQ(index->pitch.size(), 2 * gear.rings().size());
    const double within = 0.0005;  // the noise of one point; a mean has less
    for (const auto& p : index->pitch) {
      const auto& ring = gear.rings()[std::size_t(p.zone)];
      const double r = 0.5 * (ring.zone.inner_radius_mm + ring.zone.outer_radius_mm), arc = r / ring.surface.M2;
      std::vector<double> at;
      for (int k = 0; k < N; ++k)
        at.push_back(arc * (errors.index[std::size_t(k)] + p.side * errors.thick[std::size_t(k)]));
      double single = 0;
      for (int k = 0; k < N; ++k)
        single = std::max(single, std::abs(at[std::size_t((k + 1) % N)] - at[std::size_t(k)]));
      EXPECT_TRUE(p.complete);
      EXPECT_EQ(p.pairs, N);
      EXPECT_NEAR(p.radius_mm, r, 1e-12);
      EXPECT_NEAR(p.single_mm, single, 2 * within * arc) << name;
      EXPECT_NEAR(p.total_mm, *std::max_element(at.begin(), at.end()) - *std::min_element(at.begin(), at.end()),
                  2 * within * arc)
          << name;
    }
    ASSERT_EQ(index->run_out.size(), gear.rings().size());
    EXPECT_TRUE(index->run_out[0].complete);
  }
}

/// A ball lowered into a space until it touches both flanks, by bisection on exact distances: nothing of the code that
/// computes F_r.
double height_of_ball(const face_gear::FaceGear& gear, double ball, double r,
                      const std::function<Vec3(const Vec3&)>& to_gear, double azimuth) {
  const auto& f = gear.rings()[0].surface;
  const auto free_of = [&](double along, double z) {
    const Vec3 x = to_gear(turned({r, 0, z}, azimuth + along / r));
    const auto plus = face_gear::flank_distance(f, 1, x),
               minus = face_gear::flank_distance(f, -1, turned(x, -gear.pitch()));
    return std::pair(plus->distance - ball, minus->distance - ball);
  };
  double low = f.z_tip(r) - 4, high = f.z_tip(r) + 3;
  const auto least = [&](double z) {  // the best place along the circle at this height
    double a = -2, b = 2;
    for (int k = 0; k < 60; ++k) {
      const double m = 0.5 * (a + b);
      const auto [p, q] = free_of(m, z);
      (p < q ? a : b) = m;
    }
    const auto [p, q] = free_of(0.5 * (a + b), z);
    return std::min(p, q);
  };
  for (int k = 0; k < 60; ++k) {
    const double m = 0.5 * (low + high);
    (least(m) < 0 ? low : high) = m;
  }
  return 0.5 * (low + high);
}

TEST(MeasuredPoints, RunOutOfAGearBesideItsAxisIsThatOfABallInItsSpaces) {
  const auto gear = test::made(test::small_spur());
  const int N = 60;
  const auto grid = test::grid_of(gear, 5, 9);
  const Vec3 beside(0.030, -0.012, 0);
  PlantedErrors errors;
  errors.shifted = beside;
  const auto seen = test::seen(grid, test::teeth_of(N), gear.pitch(), gear.rings()[0].surface.M2, errors);
  const auto placed = inspection::place_on_flanks(drawn_solid(gear), file_of(seen, false));
  ASSERT_TRUE(placed) << placed.error().text();
  std::vector<inspection::ToothPlace> places;
  for (const int side : {1, -1}) {
    const auto fit = fit_of(gear, grid, *placed, 0, side);
    ASSERT_TRUE(fit);
    for (const auto& t : fit->teeth) places.push_back({0, side, t.tooth, t.middle_mm});
  }
  const auto index = inspection::index_of_teeth(drawn_solid(gear), places);
  ASSERT_TRUE(index && index->run_out.size() == 1);
  // The ball that touches both flanks in their middles: its centre lies above one and in the middle of the space.
  const inspection::InspectionPoint* middle = nullptr;
  for (const auto& p : grid)
    if (p.side == 1 && p.row == 2 && p.column == 4) middle = &p;
  double ball = 0, ball_high = 5;
  for (int k = 0; k < 60; ++k) {
    const double m = 0.5 * (ball + ball_high);
    (azimuth(middle->p + m * middle->n) < 0.5 * gear.pitch() ? ball : ball_high) = m;
  }
  const double r = radius(middle->p + ball * middle->n);
  double low = INFINITY, high = -INFINITY;
  for (int k = 0; k < N; ++k) {
    const double space = (k + 0.5) * gear.pitch();
    // The gear stands beside the axis of measuring: a place of the room is one of the gear less the shift; the space k
    // of the gear is space 0 after k pitches back.
    const double z = height_of_ball(
        gear, ball, r, [&](const Vec3& x) { return turned(x - beside, -k * gear.pitch()); }, space);
    low = std::min(low, z);
    high = std::max(high, z);
  }
  std::printf("  F_r %.3f um, a ball of radius %.3f mm in the spaces %.3f um\n", index->run_out[0].run_out_mm * 1000,
              ball, (high - low) * 1000);
  EXPECT_GT(high - low, 0.003);
  EXPECT_NEAR(index->run_out[0].run_out_mm, high - low, 0.05 * (high - low));
}

TEST(MeasuredPoints, FewTeethSayHowFew) {
  const auto gear = test::made(test::small_spur());
  const auto index = inspection::index_of_teeth(
      drawn_solid(gear),
      {{0, 1, 4, 0.010}, {0, 1, 5, 0.004}, {0, 1, 20, -0.010}, {0, -1, 5, 0.001}, {0, -1, 6, 0.001}});
  ASSERT_TRUE(index);
  ASSERT_EQ(index->pitch.size(), 2u);
  const double arc = 62.5 / gear.rings()[0].surface.M2;
  EXPECT_EQ(index->pitch[0].teeth, 3);
  EXPECT_EQ(index->pitch[0].pairs, 1);
  EXPECT_EQ(index->pitch[0].single_tooth, 4);
  EXPECT_FALSE(index->pitch[0].complete);
  EXPECT_NEAR(index->pitch[0].single_mm, 0.006 * arc, 1e-12);
  EXPECT_NEAR(index->pitch[0].total_mm, 0.020 * arc, 1e-12);
  ASSERT_EQ(index->run_out.size(), 1u);
  EXPECT_EQ(index->run_out[0].spaces, 2);
  EXPECT_FALSE(index->run_out[0].complete);
}

TEST(ScatteredCorrection, SaysWhatIsMissing) {
  const auto gear = test::made(test::small_spur());
  const auto grid = test::grid_of(gear, 5, 9), fine = test::grid_of(gear, 20, 20);
  const double theta_t = gear.rings()[0].surface.shaper.theta_t;
  std::vector<modification::FlankDeviation> nominal;
  for (const auto& p : grid)
    if (p.side > 0) nominal.push_back({p.row, p.column, p.theta, radius(p.p), 0});
  const auto fit = [&](const std::function<bool(const inspection::InspectionPoint&)>& kept) {
    std::vector<modification::ScatteredDeviation> points;
    for (const auto& p : fine)
      if (p.side > 0 && kept(p)) points.push_back({0, p.theta, radius(p.p), 0.01});
    const auto f = modification::FlankCorrection::fit_scattered(points, nominal, theta_t);
    return f ? std::string("fits") : f.error().message;
  };
  EXPECT_EQ(fit([](const auto&) { return true; }), "fits");
  EXPECT_EQ(fit([](const auto& p) { return p.row < 2; }).substr(0, 23), "40 points are too few t");
  EXPECT_EQ(fit([](const auto& p) { return p.column < 8; }),
            "the points cover 37 % of the face width, at least 50 % are needed");
  EXPECT_EQ(fit([](const auto& p) { return p.row < 9; }).substr(0, 17), "the points cover ");
  EXPECT_EQ(fit([](const auto& p) { return p.row % 6 == 0; }),
            "the points lie at 4 heights and 20 radii, at least 5 and 9 are needed");
  // A profile in the middle and a lead at half height, as gear testers trace them.
  EXPECT_EQ(fit([](const auto& p) { return p.row == 0 || p.row == 19 || (p.column == 10); }).substr(0, 46),
            "the points leave part of the flank open: a fit");
}

}  // namespace
}  // namespace toothpath
