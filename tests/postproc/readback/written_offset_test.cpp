// What a LinuxCNC program does to the places that its words count from: G52 of rotaries, and the work offset that the
// machine file leaves to it (G10 L2 P9, G59.3). What it does to the tip is told by hand; LinuxCNC's own interpreter
// compares whole programs (rs274_test).
#include <gtest/gtest.h>

#include "tests/postproc/joints/trunnion_post.h"

namespace toothpath {
namespace {

using namespace test;
using readback::ExecutedMove;

/// Tool 1 with its length at the top of the work, TCP off.
constexpr const char* kOpening =
    "G21 G17 G90 G94 G40 G49 G80 G61\nG92.1\nM429\nG54\n(OP 0 finishing)\nG53 G0 Z500\nT1 M6\nS1200 M3\nG43 H1\n"
    "G0 C0 A0\nG0 X5 Y5\nG0 Z250\n";
constexpr const char* kEnding = "G53 G0 Z500\nM5\nM2\n";
constexpr const char* kTurned = "G10 L2 P9 X#5221 Y#5222 Z#5223 A#5224 C#5226 R[90]\n";
constexpr const char* kStraight = "G10 L2 P9 R0\n";

struct Executed {
  std::string refused;
  std::vector<ExecutedMove> moves;
};

Executed executed(const std::string& body, const std::string& index_offset = "G59.3", bool rolls_over = false) {
  machines::Machine m = trunnion_with("linuxcnc", machines::TcpMode::angles);
  m.post.index_offset = index_offset;
  if (rolls_over) {
    m.chain.table[0].rollover = true;
    m.chain.table[0].max_rad = std::numeric_limits<double>::infinity();
    m.chain.table[0].min_rad = -m.chain.table[0].max_rad;
  }
  const auto control = controls::control_of(m, standing(), tools());
  Executed out;
  const auto s = readback::execute_nc(kOpening + body + kEnding, "p", *control,
                                      [&](const ExecutedMove& e) { out.moves.push_back(e); });
  if (!s) out.refused = s.error().text();
  return out;
}
/// The last move but the rise at the end.
ExecutedMove last(const Executed& e) { return e.moves.at(e.moves.size() - 2); }

/// X and Y of the words are turned about the origin of the work offset, as the tip; the rise ends in the straight one.
TEST(WrittenOffset, TurnsTheWordsOfTheTip) {
  const Executed e = executed(std::string(kTurned) + "M428\nG59.3\nG1 X20 Y3 Z240 F500\nG54\nM429\n" + kStraight);
  ASSERT_EQ(e.refused, "");
  EXPECT_LT((last(e).tip - (standing().work_offset_at_mm + Vec3(-3, 20, 240))).norm(), 1e-9);
  // It may be taken ahead of TCP as well, and X alone leaves the other word where the tip stands in it.
  const Executed one = executed(std::string(kTurned) + "G59.3\nM428\nG1 X20 F500\nM429\nG54\n" + kStraight);
  ASSERT_EQ(one.refused, "");
  EXPECT_LT((last(one).tip - (standing().work_offset_at_mm + Vec3(5, 20, 250))).norm(), 1e-9);
}

/// C of the words counts from the zero that was moved, with TCP and without; machine coordinates do not.
TEST(WrittenOffset, ZeroOfTheRotaryHoldsInEveryOffset) {
  const Executed e = executed("G52 C[2*15]\nG0 C10\n" + std::string(kTurned) +
                              "M428\nG59.3\nG1 C12 F500\nG54\nM429\nG92.1\n" + kStraight);
  ASSERT_EQ(e.refused, "");
  EXPECT_NEAR(e.moves.at(e.moves.size() - 3).joints[3], 40, 1e-12);
  EXPECT_NEAR(last(e).joints[3], 42, 1e-12);
  EXPECT_NEAR(last(executed("G52 C30\nG53 G0 C10\nG92.1\n")).joints[3], 10, 1e-12);
  EXPECT_NEAR(last(executed("G52 C30\nG52 X0 Y0 Z0 A0 C0\nG0 C10\n")).joints[3], 10, 1e-12);
  EXPECT_NEAR(last(executed("G52 C30\nG92.1\nG0 C10\n")).joints[3], 10, 1e-12);
}

/// The program may read what it has written, the turn too.
TEST(WrittenOffset, ParametersHoldWhatWasWritten) {
  const auto x = [](const std::string& ahead) {
    return last(executed(std::string(kTurned) + ahead + "G0 X[10+#5390/9]\n" + kStraight)).joints[0] - 3;
  };
  EXPECT_NEAR(x(""), 20, 1e-12);
  EXPECT_NEAR(x("G10 L2 P9 R-45\n"), 5, 1e-12);
  EXPECT_NEAR(x(kStraight), 10, 1e-12);
  EXPECT_NEAR(last(executed("G0 X[#5221+#5230]\n")).joints[0], 6, 1e-12);
}

struct RefusedProgram {
  const char *what, *body, *message;
  const char* index_offset = "G59.3";
};
void PrintTo(const RefusedProgram& r, std::ostream* out) { *out << r.what; }
class WrittenOffsetRefusals : public testing::TestWithParam<RefusedProgram> {};
INSTANTIATE_TEST_SUITE_P(
    Lines, WrittenOffsetRefusals,
    testing::Values(
        RefusedProgram{"an offset of the shop", "G10 L2 P1 X0 Y0 Z0 A0 C0 R6\n",
                       "p:13:1: error: G10 L2 P1 writes a work offset of the shop: post.index_offset is G59.3"},
        RefusedProgram{"the one in force", "G10 L2 P0 R6\n",
                       "p:13:1: error: G10 L2 P0 writes a work offset of the shop"},
        RefusedProgram{
            "none is left", "G10 L2 P9 X0 Y0 Z0 A0 C0 R6\n",
            "p:13:1: error: G10 L2 P9 writes a work offset of the shop: post.index_offset of the machine file "
            "names none",
            ""},
        RefusedProgram{"L20", "G10 L20 P9 X0 Y0 Z0 A0 C0\n", "p:13:1: error: G10 is read with L2 alone"},
        RefusedProgram{"L1", "G10 L1 P1 Z20\n", "p:13:1: error: G10 is read with L2 alone"},
        RefusedProgram{"no L", "G10 P9 R5\n", "p:13:1: error: G10 is read with L2 alone"},
        RefusedProgram{"no turn", "G10 L2 P9 X0 Y0 Z0 A0 C0\n",
                       "G10 L2 stands in a block of its own, with P, R and axes"},
        RefusedProgram{"a feed beside it", "G10 L2 P9 X0 Y0 Z0 A0 C0 R5 F100\n",
                       "p:13:1: error: G10 L2 stands in a block of its own, with P, R and axes"},
        RefusedProgram{"some axes", "G10 L2 P9 X0 Y0 R5\n",
                       "p:13:1: error: G10 L2 names all axes of the machine or none"},
        RefusedProgram{"a zero of C", "G10 L2 P9 X#5221 Y#5222 Z#5223 A#5224 C[#5226+6] R5\n",
                       "p:13:1: error: G10 L2 moves the zero of C by 6 deg, limit 0: G52 does that"},
        RefusedProgram{"turned ahead of its place", "G10 L2 P9 R5\n",
                       "p:13:1: error: G59.3 is turned ahead of the line that says where it is"},
        RefusedProgram{"taken ahead of its place", "G59.3\n", "work offset G59.3 ahead of the line that writes it"},
        RefusedProgram{"taken without a leave", "G59.3\n", "work offset G59.3 is not defined", ""},
        RefusedProgram{"written while it is in force",
                       "G10 L2 P9 X#5221 Y#5222 Z#5223 A#5224 C#5226 R0\nG59.3\nG10 L2 P9 R5\n",
                       "p:15:1: error: G59.3 is written while words count from it"},
        RefusedProgram{"joints in it", "G10 L2 P9 X#5221 Y#5222 Z#5223 A#5224 C#5226 R5\nG59.3\nG0 X10\n",
                       "p:15:4: error: a turned frame without TCP"},
        RefusedProgram{"left in force", "G10 L2 P9 X#5221 Y#5222 Z#5223 A#5224 C#5226 R0\nG59.3\n",
                       "program end in G59.3: the next program would begin there"},
        RefusedProgram{"left turned", "G10 L2 P9 X#5221 Y#5222 Z#5223 A#5224 C#5226 R5\n",
                       "program end while G59.3 is turned by 5 deg: the next program would find it so"},
        RefusedProgram{"R elsewhere", "G0 X10 R5\n", "p:13:8: error: R is read with G10 L2 alone"},
        RefusedProgram{"R of a plane", "G18 R5\n", "p:13:1: error: G18 is not in the subset"},
        RefusedProgram{"a parameter that is set", "#5221=4\n",
                       "p:13:1: error: #5221 is the control's own and cannot be set"},
        RefusedProgram{
            "a parameter that nobody knows", "G0 X#5241\n",
            "p:13:4: error: parameter #5241 was never set by the program: what the control itself puts there"},
        RefusedProgram{"G52 of X", "G52 X5 C6\n", "p:13:8: error: G52 X is not in the subset"},
        RefusedProgram{"G52 with TCP", "M428\nG52 C6\n", "p:14:5: error: G52 moves the zero of C with TCP on"},
        RefusedProgram{"G92.1 with TCP", "G52 C6\nM428\nG92.1\n", "the zero of a rotary goes back with TCP on"},
        RefusedProgram{"G52 that stays", "G52 C6\n", "program end while C counts from 6 deg"},
        RefusedProgram{"G92", "G92 C0\n", "p:13:1: error: G92 is not in the subset"},
        RefusedProgram{"G92.2", "G92.2\n", "p:13:1: error: G92.2 is not in the subset"}));

TEST_P(WrittenOffsetRefusals, NameTheirPlace) {
  const Executed e = executed(GetParam().body, GetParam().index_offset);
  EXPECT_NE(e.refused.find(GetParam().message), std::string::npos) << e.refused;
}

/// An axis that rolls over goes by the sign of its words, seen from the zero that was moved.
TEST(WrittenOffset, RollsOverFromItsZero) {
  // At 0 the zero goes to 30: the axis stands at -30 of its words, and C10 is 40 deg on.
  EXPECT_NEAR(last(executed("G52 C30\nG0 C10\nG92.1\n", "G59.3", true)).joints[3], 40, 1e-6);
  // C-340 is the place 340 downwards from there: -380, 350 deg of the machine below.
  EXPECT_NEAR(last(executed("G52 C30\nG0 C-340\nG92.1\n", "G59.3", true)).joints[3], -350, 1e-6);
  EXPECT_NE(executed("G52 C360\n", "G59.3", true).refused.find("outside -360 .. 360"), std::string::npos);
  EXPECT_NE(executed("G52 C30\nG53 G0 C10\n", "G59.3", true).refused.find("which way it turns is not known here"),
            std::string::npos);
}

}  // namespace
}  // namespace toothpath
