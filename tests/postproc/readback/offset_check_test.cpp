// What a LinuxCNC program must find of the work offset of the shop: its turn R and the zeros of its rotaries are 0.
// LinuxCNC's own interpreter ends the program where they are not; our reader knows the lines, and tells of a program
// that has none.
#include <gtest/gtest.h>

#include <regex>

#include "postproc/readback/conditions.h"
#include "tests/postproc/joints/trunnion_post.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;
using machines::TcpMode;
using readback::ExecutedMove;

constexpr const char* kLook = "o99 while [#5224*#5224+#5226*#5226+#5230*#5230 GT 0]\n";
constexpr const char* kAbort = "(ABORT, A, C, R OF G54 MUST BE 0)\n";
constexpr const char* kEnd = "o99 endwhile\n";
const std::string kLines = std::string(kLook) + kAbort + kEnd;

std::string program(TcpMode tcp, const joints::Setup& setup = standing()) {
  const auto text = nc_text({sample_path(0.3, 0.4, 6)}, trunnion_with("linuxcnc", tcp), setup, 3);
  EXPECT_TRUE(text) << text.error().message;
  return text->text;
}
std::string without(std::string text, const std::string& lines) {
  const auto at = text.find(lines);
  EXPECT_NE(at, std::string::npos) << lines;
  return text.erase(at, lines.size());
}
std::string instead(std::string text, const std::string& of, const std::string& other) {
  const auto at = text.find(of);
  EXPECT_NE(at, std::string::npos) << of;
  return text.replace(at, of.size(), other);
}

struct Read {
  std::string refused;
  std::size_t cuts = 0, unseen = 0;
  std::vector<std::string> warnings;
};
Read read(const std::string& text, const joints::Setup& setup = standing()) {
  const machines::Machine m = trunnion_with("linuxcnc", TcpMode::angles);
  const auto control = controls::control_of(m, setup, tools());
  readback::AskedConditions asked;
  readback::ConditionJudge judge(m, *control, asked);
  Read out;
  const auto s = readback::execute_nc(text, "p", *control, [&](const ExecutedMove& e) {
    if (!e.rapid) ++out.cuts;
    if (!e.rapid && e.offset_unseen) ++out.unseen;
    judge.add(e);
  });
  if (!s) out.refused = s.error().text();
  for (const std::string& warning : judge.finish().warnings)
    if (warning.find("work offset") != std::string::npos) out.warnings.push_back(warning);
  return out;
}

/// Canonical lines of motion that LinuxCNC makes of a program (without the codes of the site) with parameters of G54.
struct Ran {
  int exit = 0;
  std::size_t motions = 0;
  std::string messages;
};
Ran run(const std::string& text, const std::string& name, const std::string& parameters) {
  const auto out = interpret(std::regex_replace(text, std::regex("M42[89]\n"), ""), name, "", parameters);
  Ran ran{out.exit, 0, out.messages};
  for (const std::string& line : out.lines) ran.motions += line.find("STRAIGHT_") != std::string::npos ? 1 : 0;
  return ran;
}

class OffsetCheck : public testing::TestWithParam<TcpMode> {};
INSTANTIATE_TEST_SUITE_P(Forms, OffsetCheck, testing::Values(TcpMode::none, TcpMode::angles));

TEST_P(OffsetCheck, StandsAheadOfTheFirstMotion) {
  const std::string text = program(GetParam());
  const auto at = text.find(kLines);
  ASSERT_NE(at, std::string::npos) << text.substr(0, 800);
  EXPECT_LT(text.find("\nG54\n"), at);
  EXPECT_LT(at, text.find("G0"));
  EXPECT_EQ(text.find("o99", at + kLines.size()), std::string::npos);
  const Read seen = read(text);
  EXPECT_EQ(seen.refused, "");
  EXPECT_GT(seen.cuts, 0u);
  EXPECT_EQ(seen.unseen, 0u);
  EXPECT_TRUE(seen.warnings.empty()) << seen.warnings.front();
}

/// A turn of 5 degrees, and one of a hundred thousandth, which EQ would take for 0; zeros of both rotaries.
TEST_P(OffsetCheck, LinuxcncEndsTheProgram) {
  const std::string text = program(GetParam());
  const Ran right = run(text, "right", "5230 0\n"), other = run(text, "other", "5221 4\n5225 7\n5250 5\n");
  EXPECT_EQ(right.exit, 0) << right.messages;
  EXPECT_GT(right.motions, 50u);
  EXPECT_EQ(other.exit, 0) << other.messages;
  EXPECT_EQ(other.motions, right.motions);
  for (const char* wrong : {"5230 5\n", "5230 0.00001\n", "5230 -5\n", "5224 0.5\n", "5226 -120\n"}) {
    const Ran ended = run(text, "wrong", wrong);
    EXPECT_NE(ended.exit, 0) << wrong;
    EXPECT_EQ(ended.motions, 0u) << wrong;
    EXPECT_NE(ended.messages.find("A, C, R OF G54 MUST BE 0"), std::string::npos) << ended.messages;
  }
  EXPECT_EQ(run(without(text, kLines), "left_out", "5230 5\n").exit, 0);  // what the lines are for
}

TEST_P(OffsetCheck, LooksAtTheOffsetOfTheJob) {
  joints::Setup setup = standing();
  setup.work_offset = "G59.1";
  const std::string text = program(GetParam(), setup);
  EXPECT_NE(text.find("o99 while [#5344*#5344+#5346*#5346+#5350*#5350 GT 0]\n(ABORT, A, C, R OF G59.1 MUST BE 0)\n"),
            std::string::npos);
  EXPECT_EQ(read(text, setup).unseen, 0u);
  EXPECT_EQ(run(text, "first", "5230 5\n").exit, 0);
  EXPECT_NE(run(text, "own", "5350 5\n").exit, 0);
}

struct Edit {
  const char* what;
  std::string of, other;
  bool seen;
};
void PrintTo(const Edit& e, std::ostream* out) { *out << e.what; }
class OffsetCheckEdits : public testing::TestWithParam<Edit> {};
INSTANTIATE_TEST_SUITE_P(
    Lines, OffsetCheckEdits,
    testing::Values(Edit{"all left out", kLines, "", false}, Edit{"the comment left out", kAbort, "", false},
                    Edit{"a message instead", "(ABORT,", "(MSG,", false},
                    Edit{"R not looked at", "+#5230*#5230", "", false},
                    Edit{"C not looked at", "+#5226*#5226", "", false}, Edit{"another limit", "GT 0]", "GT 1]", false},
                    Edit{"a difference", "+#5230*", "-#5230*", false},
                    Edit{"a product of two", "#5226*#5226", "#5224*#5226", false},
                    Edit{"no square", "+#5230*#5230", "+#5230", false},
                    Edit{"another order", "#5224*#5224+#5226*#5226", "#5226*#5226+#5224*#5224", true},
                    Edit{"a small letter", "(ABORT,", "( abort,", true},
                    Edit{"brackets", "#5224*#5224+", "[#5224*#5224]+", true}));

/// Old programs, and edited ones, are read; a warning tells of them, once an operation.
TEST_P(OffsetCheckEdits, AreToldWhereNothingLooks) {
  const Edit& e = GetParam();
  const std::string text = program(TcpMode::none);
  const Read seen = read(instead(text, e.of, e.other));
  EXPECT_EQ(seen.refused, "");
  EXPECT_GT(seen.cuts, 0u);
  EXPECT_EQ(seen.unseen, e.seen ? 0u : seen.cuts);
  ASSERT_EQ(seen.warnings.size(), e.seen ? 0u : 1u);
  if (!seen.warnings.empty()) {
    EXPECT_TRUE(std::regex_search(
        seen.warnings.front(),
        std::regex("^line \\d+: operation 0 cuts from a work offset whose turn R and zeros of the rotaries are taken "
                   "as 0, and no line of the program looks at them \\(\\d+ blocks so\\)")))
        << seen.warnings.front();
  }
}

TEST(OffsetCheckText, ComesTooLateBehindTheCuts) {
  const Read seen = read(instead(without(program(TcpMode::none), kLines), "M5\n", "M5\n" + kLines));
  EXPECT_EQ(seen.refused, "");
  EXPECT_EQ(seen.unseen, seen.cuts);
}

TEST(OffsetCheckText, RefusesWhatEndsTheProgram) {
  const std::string text = program(TcpMode::none);
  const std::string alone = instead(text, kLines, kAbort);
  EXPECT_NE(read(alone).refused.find(": error: (ABORT, ..) ends the program there"), std::string::npos);
  EXPECT_NE(run(alone, "alone", "").exit, 0);
  EXPECT_NE(read(without(text, kEnd)).refused.find("sub inside another o-word"), std::string::npos);
  EXPECT_NE(read(instead(text, "#5230*#5230", "#5250*#5250")).refused.find("parameter #5250 was never set"),
            std::string::npos);
}

/// Other controls have no such lines, and nothing to tell.
TEST(OffsetCheckText, IsLinuxcncAlone) {
  for (const char* name : {"fanuc", "siemens", "heidenhain"}) {
    const machines::Machine m = with_dialect(trunnion(), name);
    const auto text = nc_text({sample_path(0.3, 0, 6)}, m, standing(), 3);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_EQ(text->text.find("o99"), std::string::npos);
    const auto control = controls::control_of(m, standing(), tools());
    EXPECT_TRUE(readback::execute_nc(text->text, "p", *control, [](const ExecutedMove& e) {
      EXPECT_FALSE(e.offset_unseen);
    })) << name;
  }
}

}  // namespace
}  // namespace toothpath
