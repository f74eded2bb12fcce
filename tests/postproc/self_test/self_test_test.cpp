// The dry-run program's poses: the tip stands still on the machine that was described, and does not on a machine that
// differs.
#include "postproc/self_test/self_test.h"
#include "postproc/controls/of_machine.h"

#include <gtest/gtest.h>

#include "machines/machine_file.h"
#include "tests/postproc/self_test/dry_run_text.h"

namespace toothpath {
namespace {

const char* const kMachines[] = {"t600s.toml",     "xyzac_large.toml",   "xyzac_trt.toml",
                                 "xyzbc_trt.toml", "head_table_bc.toml", "head_head_ca.toml",
                                 "fanuc_ac.toml",  "siemens_ac.toml",    "heidenhain_ac.toml"};

machines::Machine shipped(const char* name) {
  return *machines::read_machine_file(machines::find_machine_file(name, ".").value()).machine;
}

/// Greatest distance of the tip from the point while another machine executes the moves, all joints linear in every
/// block.
double worst_reading(const self_test::SelfTest& test, const machines::KinematicChain& executing) {
  double worst = 0;
  for (std::size_t i = 1; i < test.moves.size(); ++i) {
    const machines::Joints &a = test.moves[i - 1].joints, &b = test.moves[i].joints;
    for (int s = 0; s <= 8; ++s) {
      const double t = s / 8.0;
      machines::Joints j;
      j.linear_mm = a.linear_mm + t * (b.linear_mm - a.linear_mm);
      for (std::size_t k = 0; k < 2; ++k) j.rotary_rad[k] = a.rotary_rad[k] + t * (b.rotary_rad[k] - a.rotary_rad[k]);
      worst = std::max(worst, (executing.forward(j, test.tool_length_mm).tip_mm - test.point_mm).norm());
    }
  }
  return worst;
}

class SelfTestOf : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Machines, SelfTestOf, testing::ValuesIn(kMachines));

TEST_P(SelfTestOf, TipStandsStill) {
  const machines::Machine m = shipped(GetParam());
  const auto test = self_test::plan_self_test(m);
  ASSERT_TRUE(test) << test.error().message;
  EXPECT_LE(test->tip_bound_mm, 0.005 + 1e-12);
  const double worst = worst_reading(*test, m.chain);
  EXPECT_LE(worst, test->tip_bound_mm + 1e-9);
  EXPECT_GT(worst, 1e-4);  // it does turn
  for (const auto& move : test->moves) EXPECT_TRUE(m.chain.violations(move.joints, m.limit_margin).empty());
  EXPECT_GE(test->stations.size(), 7u);
  EXPECT_EQ(test->moves.front().station, 0);
  EXPECT_EQ(test->moves.back().station, static_cast<int>(test->stations.size()) - 1);
}

// What a machinist must see on the indicator: at least two tenths where a sign, a pivot or the length is wrong.
TEST_P(SelfTestOf, WrongMachineIsSeen) {
  const machines::Machine m = shipped(GetParam());
  const auto test = self_test::plan_self_test(m);
  ASSERT_TRUE(test) << test.error().message;
  for (std::size_t k = 0; k < m.chain.rotary_count(); ++k) {
    machines::KinematicChain wrong = m.chain;
    machines::RotaryAxis& axis = k < wrong.table.size() ? wrong.table[k] : wrong.head[k - wrong.table.size()];
    axis.sign = -axis.sign;
    EXPECT_GT(worst_reading(*test, wrong), 1.0) << axis.letter;
    axis.sign = -axis.sign;
    // A pivot that is off by half a millimetre across its axis.
    const Vec3 across = (std::abs(axis.direction.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitZ());
    axis.point_mm += 0.5 * (across - across.dot(axis.direction) * axis.direction).normalized();
    EXPECT_GT(worst_reading(*test, wrong), 0.2) << axis.letter;
  }
  self_test::SelfTest longer = *test;
  longer.tool_length_mm += 0.5;
  if (!m.chain.head.empty()) { EXPECT_GT(worst_reading(longer, m.chain), 0.2); }
}

TEST_P(SelfTestOf, TextIsReadBackAndNeverStartsTheSpindle) {
  const machines::Machine m = shipped(GetParam());
  const auto test = self_test::plan_self_test(m);
  ASSERT_TRUE(test) << test.error().message;
  const std::string text = test::dry_run_text(*test, m);
  EXPECT_EQ(text.find("M3\n"), std::string::npos);
  EXPECT_NE(text.find("STATION 1 OF"), std::string::npos);
  const auto proof = self_test::prove_self_test(text, "t", *test, m);
  ASSERT_TRUE(proof) << proof.error().text();
  EXPECT_LE(proof->worst_mm, test->tip_bound_mm + 0.003);
  EXPECT_GE(proof->moves, test->stations.size() - 1);
}

// A machine whose second rotary turns the other way must not pass, whatever its control can do with TCP.
TEST_P(SelfTestOf, AnotherMachineFailsTheProofOfTheJoints) {
  const machines::Machine m = self_test::without_tcp(shipped(GetParam()));
  const auto test = self_test::plan_self_test(m);
  ASSERT_TRUE(test) << test.error().message;
  machines::Machine wrong = m;
  (wrong.chain.head.empty() ? wrong.chain.table.back() : wrong.chain.head.back()).sign *= -1;
  EXPECT_TRUE(self_test::prove_self_test(test::dry_run_text(*test, m), "t", *test, m));
  const auto proof = self_test::prove_self_test(test::dry_run_text(*test, m), "t", *test, wrong);
  ASSERT_FALSE(proof);
  EXPECT_EQ(proof.error().kind, DiagnosticKind::verification);
}

TEST(SelfTest, RefusesWhatItCannotTest) {
  machines::Machine m = shipped("t600s.toml");
  EXPECT_NE(self_test::plan_self_test(m, {.tool_length_mm = 0}).error().message.find("tool length 0 mm"),
            std::string::npos);
  EXPECT_NE(self_test::plan_self_test(m, {.tool_length_mm = 900}).error().message.find("Z = "), std::string::npos);
  m.chain.table.clear();
  EXPECT_NE(self_test::plan_self_test(m).error().message.find("no rotary axis"), std::string::npos);
}

}  // namespace
}  // namespace toothpath
