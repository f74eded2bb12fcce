// Roughing steps whose passes would be planned for minutes are refused before one is laid, with the least that does.
#include <regex>

#include "cam/ball/roughing.h"
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

}  // namespace
}  // namespace toothpath
