// The dry-run program's poses: the tip stands still on the machine that was described, and does not on a machine that
// differs.
#include "postproc/self_test/self_test.h"
#include "postproc/controls/of_machine.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "machines/machine_file.h"
#include "tests/postproc/self_test/dry_run_text.h"
#include "tests/support/files.h"
#include "tests/support/plain_machine.h"

namespace toothpath {
namespace {

using test::file_text;

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

/// Places of the tip on the table in the moves of one part of the text, by readers of the tests' own.
std::vector<Vec3> tips_behind(const std::string& text, const std::string& remark, const std::string& machine_file,
                              const self_test::SelfTest& test) {
  const test::PlainMachine machine(machine_file);
  test::NcWalk walk = test::walk_nc(text, machine.control());
  const test::PlainSetup setup{test.point_mm, {0, test.tool_length_mm}};
  const auto moves = test::moves_on(machine, walk, setup);
  for (const auto& fault : walk.faults) ADD_FAILURE() << fault;
  const auto line_of = [&](std::size_t at) { return 1 + int(std::count(text.begin(), text.begin() + long(at), '\n')); };
  const int first = line_of(text.find(remark)), last = line_of(text.find("\nM0\n", text.find(remark)));
  std::vector<Vec3> out;
  for (const auto& move : moves)
    if (move.line > first && move.line <= last) out.push_back(test::place_on(machine, move, setup, 1).tip);
  return out;
}

// The dials see whether TRAORI takes the offset: a wrong grant moves the tip by about a millimetre, a right one not at
// all.
TEST(SelfTest, AWrongGrantOfTheRotaryOffsetIsSeen) {
  const std::string file = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/siemens_ac.toml");
  const std::string granted = file + "\n[post]\ntransformation_takes_rotary_offset = true\n";
  for (const char* c : {"sign = 1\nmin = -36000", "sign = -1\nmin = -36000", "rollover = true"}) {
    SCOPED_TRACE(c);
    const auto with_c = [&](const std::string& text) {
      const std::string range = "sign = 1\nmin = -36000.0\nmax = 36000.0";
      if (std::string(c) == "rollover = true") return test::replaced(text, range, "sign = 1\nrollover = true");
      return test::replaced(text, "sign = 1\nmin = -36000", c);
    };
    const auto read = [&](const std::string& text) {
      const auto result = machines::read_machine_text(with_c(text), "m.toml");
      EXPECT_TRUE(result.machine);
      return *result.machine;
    };
    const machines::Machine m = read(granted), plain = read(file);
    const auto test = self_test::plan_self_test(m), without = self_test::plan_self_test(plain);
    ASSERT_TRUE(test && without);
    ASSERT_EQ(test->stations.size(), without->stations.size() + 1);
    ASSERT_NE(test->stations.back().zero_deg, 0);
    EXPECT_EQ(test::dry_run_text(*without, plain).find("TRANS"), std::string::npos);

    const std::string text = test::dry_run_text(*test, m);
    const auto proof = self_test::prove_self_test(text, "t", *test, m);
    ASSERT_TRUE(proof) << proof.error().text() << text;
    ASSERT_EQ(proof->readings_mm.size(), test->stations.size());
    EXPECT_LT(proof->readings_mm.back().norm(), 1e-4);
    const auto right = tips_behind(text, "COUNTS FROM", with_c(granted), *test);
    const auto wrong = tips_behind(text, "COUNTS FROM", with_c(file), *test);
    ASSERT_FALSE(right.empty() || wrong.empty());
    for (const Vec3& tip : right) EXPECT_LT((tip - test->point_mm).norm(), 1e-4) << text;
    EXPECT_GT((wrong.back() - test->point_mm).norm(), 0.9);
    EXPECT_LT((wrong.back() - test->point_mm).norm(), 1.1);
    // With TCP off nothing asks.
    EXPECT_EQ(self_test::plan_self_test(self_test::without_tcp(m))->stations.back().zero_deg, 0);
  }
}

// The tip stands above the table's face, wherever the file names the point of the axis.
TEST(SelfTest, StandsAboveTheFaceOfTheTable) {
  machines::Machine m = shipped("xyzac_trt.toml");
  m.table_face_mm.reset();
  const auto before = self_test::plan_self_test(m);
  ASSERT_TRUE(before) << before.error().message;
  m.table_face_mm = m.chain.table[0].point_mm.z();
  m.chain.table[0].point_mm.z() -= 900;  // another point of the same axis
  const auto stated = self_test::plan_self_test(m);
  ASSERT_TRUE(stated) << stated.error().message;
  EXPECT_EQ(stated->point_mm, before->point_mm);
  EXPECT_EQ(stated->tool_length_mm, before->tool_length_mm);
  m.table_face_mm.reset();
  const auto none = self_test::plan_self_test(m);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("axes.C.point: if it is not, state limits.table_face"), std::string::npos)
      << none.error().message;
}

// A file that states the bodies of its machine has its table where its plate is.
TEST(SelfTest, ShippedTablesAreWhereTheirPlatesAre) {
  int plates = 0;
  for (const char* file : kMachines) {
    const machines::Machine m = shipped(file);
    if (m.chain.table.empty()) continue;
    const Vec3 middle = m.table_middle_mm();
    const auto top = m.top_under(Vec3(middle.x(), middle.y(), INFINITY));
    if (!top) continue;
    EXPECT_EQ(*top, middle.z()) << file;
    ++plates;
  }
  EXPECT_GE(plates, 5);
}

// C in [0, 360]: zero itself is nearer to the limit than the margin.
TEST(SelfTest, BeginsInsideTheLimits) {
  machines::Machine m = shipped("xyzac_trt.toml");
  m.chain.table[0].min_rad = 0;
  m.chain.table[0].max_rad = radians(360);
  const auto test = self_test::plan_self_test(m);
  ASSERT_TRUE(test) << test.error().message;
  EXPECT_NEAR(test->stations.front().rotary_rad[0], radians(1), 1e-12);
  for (const auto& move : test->moves) EXPECT_TRUE(m.chain.violations(move.joints, m.limit_margin).empty());
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
