// Extreme bevel pairs and loads end in a result that balances, or in a refusal that names position, quantity and limit.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/loaded_bevel/bevel_flanks.h"
#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

using loaded_bevel::LoadedBevelPair;

loaded_bevel::BevelPairOptions stiff_bodies(double times) {
  auto options = coarse_bodies();
  for (auto* body : {&options.wheel, &options.pinion}) body->E *= times;
  return options;
}
Result<loaded::LoadedPosition> try_position(const LoadedBevelPair& pair, double torque_Nm, double phase) {
  loaded::Load load;
  load.torque_nmm = torque_Nm * 1000;
  return loaded_bevel::loaded_position(pair, load, pair.pair.pinion().pitch() * phase);
}

/// Balance and complementarity.
void expect_sound(const loaded::LoadedPosition& p, double torque_Nm, const std::string& what) {
  EXPECT_TRUE(std::isfinite(p.approach_mm) && p.approach_mm > 0) << what << ": " << p.approach_mm;
  EXPECT_NEAR(p.gear_torque_nmm, torque_Nm * 1000, 1e-9 * torque_Nm * 1000) << what;
  EXPECT_LT(p.residual, 1e-6) << what;
  EXPECT_GT(p.tangent, 0) << what;
  ASSERT_FALSE(p.segments.empty()) << what;
  double sum = 0;
  for (const auto& s : p.segments) {
    EXPECT_GT(s.force, 0) << what;
    EXPECT_GT(s.pressure, 0) << what;
    sum += s.force;
  }
  double of_halves = 0;
  for (const double f : p.ring_force) of_halves += f;
  EXPECT_NEAR(sum, of_halves, 1e-9 * sum) << what;
}
/// The same, or words of a refusal.
bool sound_or_refused(const LoadedBevelPair& pair, double torque_Nm, double phase,
                      const std::vector<std::string>& words) {
  const auto p = try_position(pair, torque_Nm, phase);
  const std::string what = fmt::format("{:+d}, {} N m, phase {}", pair.sigma, torque_Nm, phase);
  if (p) {
    expect_sound(*p, torque_Nm, what);
    return true;
  }
  for (const auto& w : words) EXPECT_NE(p.error().message.find(w), std::string::npos) << what << p.error().message;
  return false;
}

/// A herringbone whose pinion has a crowning.
const BevelGears& crowned_gears() {
  static const BevelGears gears = [] {
    auto p = bevel_test::w3();
    modification::Modification crowning;
    crowning.kind = modification::Kind::lead_crowning, crowning.amount_mm = 0.03;
    p.modifications = {crowning};
    return BevelGears{bevel_test::made(p, bevel_test::pinion_mill()),
                      bevel_test::made(bevel_test::w4(), bevel_test::wheel_mill())};
  }();
  return gears;
}

/// First touch of the rigid flanks is the least gap there is: no cell of any size sees less, small ones come to it.
TEST(BevelExtremes, NoCellSeesLessThanFirstTouch) {
  for (const auto* gears : {&single_gears(), &crowned_gears()})
    for (const int sigma : {1, -1}) {
      const auto pair = pair_of(*gears, sigma, coarse_bodies());
      for (int k = 0; k < 8; ++k) {
        const loaded_bevel::BevelFlanks flanks(pair, pair.pair.pinion().pitch() * k / 8);
        ASSERT_FALSE(flanks.sites().empty());
        double first = 1e300;
        for (const loaded::CellSite& site : flanks.sites()) {
          const std::string what = fmt::format("{} halves, {:+d} at {}, half {} tooth {}", pair.halves.size(), sigma, k,
                                               site.ring, site.tooth);
          EXPECT_GE(site.first_gap, 0) << what;
          first = std::min(first, site.first_gap);
          double least = 1e300;
          for (const double half : {20.0, 1.0, 0.01}) {
            loaded::CellSite around = site;
            around.x = site.first.x(), around.y = site.first.y(), around.half_x = around.half_y = half;
            for (const auto& cell : flanks.places(around, 24, 32))
              if (cell.material) least = std::min(least, cell.at.gap);
            ASSERT_GT(least, -1e-8) << what << ", cells around " << half;
          }
          EXPECT_LT(least, site.first_gap + 1e-3) << what;
        }
        EXPECT_EQ(first, 0) << "the first tooth is the zero";
      }
    }
}

/// A thousand times stiffer than steel: the tooth that touches first carries, where it does, at every position.
TEST(BevelExtremes, StiffTeethCarryWhereTheyTouchFirst) {
  for (const int sigma : {1, -1}) {
    const auto pair = single_pair(sigma, stiff_bodies(1e3));
    int alone = 0;
    for (int k = 0; k < 16; ++k) {
      const std::string what = fmt::format("{:+d} at {}", sigma, k);
      const auto p = try_position(pair, 1, k / 16.0);
      ASSERT_TRUE(p) << what << ": " << p.error().message;
      expect_sound(*p, 1, what);
      EXPECT_LT(p->approach_mm, 1.5e-4) << what;
      const loaded_bevel::BevelFlanks flanks(pair, pair.pair.pinion().pitch() * k / 16);
      const auto first = std::min_element(flanks.sites().begin(), flanks.sites().end(),
                                          [](const auto& a, const auto& b) { return a.first_gap < b.first_gap; });
      const auto near = std::count_if(flanks.sites().begin(), flanks.sites().end(),
                                      [&](const auto& s) { return s.first_gap < 2 * p->approach_mm; });
      if (near > 1) continue;
      ++alone;
      for (const auto& s : p->segments) {
        EXPECT_EQ(s.place.tooth, first->tooth) << what;
        const Vec3 at = first->point + first->across * first->first.x() + first->along * first->first.y();
        EXPECT_LT((s.place.point - at).norm(), 0.3) << what;
      }
    }
    EXPECT_GT(alone, 8) << sigma;
  }
}

/// Ever stiffer: the contact shrinks to a corner, until cells or first touch itself no longer tell where it is.
TEST(BevelExtremes, StifferAndStifferIsANumberOrSaysWhyNot) {
  for (const int sigma : {1, -1}) {
    double last = 1e300;
    for (const double times : {1e1, 1e2, 1e3, 1e4, 1e6, 1e9}) {
      const auto pair = single_pair(sigma, stiff_bodies(times));
      const auto p = try_position(pair, 10, 0.4);
      if (p) {
        expect_sound(*p, 10, fmt::format("{:+d} {}", sigma, times));
        EXPECT_LT(p->approach_mm, last);
        last = p->approach_mm;
      } else {
        EXPECT_GE(times, 1e6) << p.error().message;
        for (const char* words : {" deg", " mm", "softer teeth are needed"})
          EXPECT_NE(p.error().message.find(words), std::string::npos) << p.error().message;
      }
    }
  }
}

TEST(BevelExtremes, TorquesFromNothingToAMillion) {
  for (const int sigma : {1, -1}) {
    const auto pair = single_pair(sigma, coarse_bodies());
    int found = 0;
    for (const double torque : {1e-6, 1e-3, 1.0, 1e3})
      for (const double phase : {0.0, 0.3, 0.7}) found += sound_or_refused(pair, torque, phase, {});
    EXPECT_EQ(found, 12);
    EXPECT_FALSE(sound_or_refused(pair, 1e6, 0.3, {" deg", "1e+06 N m", "beyond 0.25 mm"}));
    EXPECT_FALSE(sound_or_refused(pair, 0, 0.3, {"torque = 0 N m on the wheel is not above 0"}));
    EXPECT_FALSE(sound_or_refused(pair, std::numeric_limits<double>::infinity(), 0.3, {"torque = inf N m"}));
  }
}

/// A pinion whose teeth are all but pointed at their small end.
TEST(BevelExtremes, NearlyPointedTeethCarry) {
  auto p = bevel_test::w1();
  auto mill = bevel_test::pinion_mill();
  const auto fits = [&](double addendum) {
    p.addendum_mm = mill.rack_depth_mm = addendum, mill.profile_height_mm = addendum + 0.7;
    return bevel_gear::BevelGear::make(p, mill).refused() == nullptr;
  };
  double low = 4.1, high = 12;
  ASSERT_TRUE(fits(low) && !fits(high));
  while (high - low > 1e-6) (fits((low + high) / 2) ? low : high) = (low + high) / 2;
  ASSERT_TRUE(fits(low));
  const BevelGears gears{bevel_test::made(p, mill), bevel_test::made(bevel_test::w2(), bevel_test::wheel_mill())};
  for (const int sigma : {1, -1}) {
    const auto pair = loaded_bevel::make_loaded_bevel_pair(gears.first, gears.second, sigma, coarse_bodies());
    ASSERT_TRUE(pair) << pair.error().message;
    for (const double phase : {0.0, 0.5}) EXPECT_TRUE(sound_or_refused(*pair, 100, phase, {}));
  }
}

/// Shafts so far out of line that only the ends of the teeth bear.
TEST(BevelExtremes, EdgesAloneCarry) {
  auto options = coarse_bodies();
  options.edge_radius_mm = 0.2;
  for (const double angle : {0.01, -0.01}) {
    options.moved.shaft_angle_rad = angle;
    const auto pair = single_pair(1, options);
    for (const double torque : {0.1, 1.0}) {
      const auto p = try_position(pair, torque, 0.2);
      ASSERT_TRUE(p) << p.error().message;
      expect_sound(*p, torque, fmt::format("{} rad", angle));
      EXPECT_GT(p->end_line_load, 0);
      EXPECT_GT(p->edge_pressure, 0);
    }
  }
}

}  // namespace
}  // namespace toothpath::test
