// Roughing steps and cusps whose passes would be planned for minutes are refused before one is laid, with the least
// that does.
#include <regex>

#include "cam/ball/roughing.h"
#include "cam/ball/small_cusps.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath {
namespace {

class StepsThatDo : public ::testing::Test {
 protected:
  [[nodiscard]] std::optional<Refusal> refused(double down, double over) const {
    ball::RoughingOptions o;
    o.ball_radius_mm = kBall;
    o.allowance_mm = kAllowance;
    o.step_down_mm = down;
    o.step_over_mm = over;
    o.chord_mm = 0.003;
    o.overrun_mm = 0.3;
    o.blank_top_mm = part_.part().blank_top();
    o.end_centre_mm = kBall;
    return ball::steps_too_small(sheet_, o);
  }
  /// The least that the message names.
  static double named(const Refusal& refusal) {
    std::smatch m;
    if (std::regex_search(refusal.diagnostic.message, m, std::regex("([0-9.e-]+) mm or more does")))
      return std::stod(m[1].str());
    ADD_FAILURE() << refusal.diagnostic.message;
    return 0;
  }

  static constexpr double kBall = 0.5, kAllowance = 0.1;
  const face_gear::FaceGear gear_ = test::made(test::small_spur());
  const analytic::GearDistance part_{face_gear::part_of(gear_), 1.5};
  const tooth_space::OffsetSheet sheet_{part_.space(0), kBall + kAllowance,
                                        gear_.parameters().zones[0].inner_radius_mm - 0.7,
                                        gear_.parameters().zones[0].outer_radius_mm + 0.7, 33};
};

TEST_F(StepsThatDo, TheSmallerOneIsNamedWithWhatDoes) {
  EXPECT_FALSE(refused(0.8, 0.5));
  EXPECT_FALSE(refused(0.05, 0.05)) << "some thousand passes are planned in seconds";
  for (const auto& [down, over, key] : {std::tuple(0.001, 0.02, "step_down"), {0.03, 0.001, "step_over"}}) {
    const auto refusal = refused(down, over);
    ASSERT_TRUE(refusal) << key;
    EXPECT_EQ(refusal->key, key);
    const double least = named(*refusal);
    const bool lower = refusal->key == "step_down";
    EXPECT_FALSE(lower ? refused(least, over) : refused(down, least)) << least;
    EXPECT_TRUE(lower ? refused(0.9 * least, over) : refused(down, 0.9 * least)) << least;
  }
}

TEST_F(StepsThatDo, WhereOneAloneHasToBeLargeBothAreNamed) {
  const auto refusal = refused(0.0005, 0.001);
  ASSERT_TRUE(refusal);
  std::smatch m;
  ASSERT_TRUE(std::regex_search(refusal->diagnostic.message, m, std::regex("([0-9.e-]+) mm for both does")))
      << refusal->diagnostic.message;
  const double both = std::stod(m[1].str());
  EXPECT_FALSE(refused(both, both)) << both;
  EXPECT_TRUE(refused(0.9 * both, 0.9 * both)) << both;
}

class CuspsThatDo : public StepsThatDo {
 protected:
  [[nodiscard]] ball::FinishingOptions asked(const path::ByRegion<double>& scallop_mm) const {
    ball::FinishingOptions o;
    o.ball_radius_mm = kBall;
    o.allowance_mm = kAllowance;
    o.scallop_mm = scallop_mm;
    o.chord_mm = 0.0005;
    o.run_out_mm = 0.25;
    return o;
  }
  [[nodiscard]] std::optional<Refusal> cusps_refused(const path::ByRegion<double>& scallop_mm) const {
    return ball::cusps_too_small(sheet_, asked(scallop_mm));
  }
};

TEST_F(CuspsThatDo, OneForAllRegions) {
  const auto everywhere = path::ByRegion<double>::everywhere;
  EXPECT_FALSE(cusps_refused(everywhere(0.004)));
  const auto refusal = cusps_refused(everywhere(1e-7));
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->key, "scallop");
  const double least = named(*refusal);
  EXPECT_FALSE(cusps_refused(everywhere(least))) << least;
  EXPECT_TRUE(cusps_refused(everywhere(0.9 * least))) << least;
}

TEST_F(CuspsThatDo, TheRegionWithTheMostPassesIsNamed) {
  path::ByRegion<double> does{{1e-8, 0.006, 0.006}};
  const auto refusal = cusps_refused(does);
  ASSERT_TRUE(refusal);
  EXPECT_EQ(refusal->key, "scallop.flank");
  does[path::Region::flank] = named(*refusal);
  EXPECT_FALSE(cusps_refused(does));
  does[path::Region::flank] *= 0.9;
  EXPECT_TRUE(cusps_refused(does));
}

// What is counted is what the planner lays, but for the passes that it puts where cusps are higher than the curvature
// tells: beside corners that is as many again.
TEST_F(CuspsThatDo, TheCountIsThatOfThePlan) {
  ball::FinishingOptions o = asked(path::ByRegion<double>::everywhere(0.0005));
  const auto planned = ball::plan_finishing(sheet_, o);
  ASSERT_TRUE(planned) << planned.error().message;
  std::size_t places = 0;
  for (const auto& pass : planned->passes) places += pass.points.size();
  const double counted = ball::finishing_places(sheet_, o);
  EXPECT_LE(counted, 1.05 * double(places));
  EXPECT_GE(counted, 0.33 * double(places));
}

}  // namespace
}  // namespace toothpath
