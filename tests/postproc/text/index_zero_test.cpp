// The index rotary counts from the angle of a tooth (G52, TRANS, cycle 7): one tooth stands in the text, its words are
// those of tooth 0, and what is wrong with the zero is found.
#include <gtest/gtest.h>

#include <regex>

#include "postproc/controls/of_machine.h"
#include "postproc/readback/reader.h"
#include "tests/postproc/text/post_forms.h"

namespace toothpath {
namespace {

using namespace test;

constexpr int kZeroTeeth = 7;

struct ZeroForm {
  PostForm form;
  const char* on;   ///< regular expression of the line that moves the zero; its first group is the number, where one is
  const char* off;  ///< the line that clears it
};
void PrintTo(const ZeroForm& f, std::ostream* out) { PrintTo(f.form, out); }

class IndexZero : public testing::TestWithParam<ZeroForm> {
 protected:
  void SetUp() override {
    paths = {sample_path(0.3, GetParam().form.swing, 4), sample_path(0.3, GetParam().form.swing, 5, 1)};
    const auto made = program_of(GetParam().form, paths, kZeroTeeth, 1);
    ASSERT_TRUE(made) << made.error().message;
    program = *made;
    ASSERT_TRUE(program.loop) << program.no_loop;
    text = text_of(GetParam().form, program)->text;
  }
  /// What reading it says: nothing, a refusal, or why the teeth are no copies.
  [[nodiscard]] std::string reading(const std::string& edited) const {
    const machines::Machine m = machine_of(GetParam().form);
    const auto control = controls::control_of(m, standing(), tools());
    const auto back = readback::read_back(edited, "p", *control, m, standing(), {.teeth = kZeroTeeth});
    if (!back) return back.error().text();
    return back->copies.copies ? std::string() : "no copies: " + back->copies.difference;
  }
  [[nodiscard]] std::string edited(const std::string& pattern, const std::string& to, bool all = false) const {
    const auto flags = all ? std::regex_constants::format_default : std::regex_constants::format_first_only;
    return std::regex_replace(text, std::regex(pattern), to, flags);
  }
  std::vector<path::ClPath> paths;
  joints::AxisProgram program;
  std::string text;
};

constexpr const char* kG52 = R"(G52 C(-?[\d.]+)\n)";
constexpr const char* kLoopG52 = R"(G52 C\[((?:0-)?#1)\*360/7\]\n)";
constexpr const char* kG921 = R"(G92\.1\n)";
constexpr const char* kG52Off = R"(G52 X0\. Y0\. Z0\. C0\. A0\.\n)";
INSTANTIATE_TEST_SUITE_P(
    Forms, IndexZero,
    testing::Values(
        ZeroForm{{"linuxcnc", machines::TcpMode::none, 0.1, false}, kLoopG52, kG921},
        ZeroForm{{"linuxcnc", machines::TcpMode::none, 0.1, false, 1}, kLoopG52, kG921},
        ZeroForm{{"linuxcnc", machines::TcpMode::none, 0.1, false, -1}, kLoopG52, kG921},
        ZeroForm{{"linuxcnc", machines::TcpMode::angles, 0.1, false}, kLoopG52, kG921},
        ZeroForm{{"linuxcnc", machines::TcpMode::angles, 0.1, false, -1}, kLoopG52, kG921},
        ZeroForm{{"fanuc", machines::TcpMode::none, 0.1, false}, kG52, kG52Off},
        ZeroForm{{"fanuc", machines::TcpMode::angles, 0.1, false}, kG52, kG52Off},
        ZeroForm{{"fanuc", machines::TcpMode::angles, 0.1, false, -1}, kG52, kG52Off},
        ZeroForm{{"mitsubishi_m80", machines::TcpMode::none, 0.1, false}, kG52, kG52Off},
        ZeroForm{{"haas", machines::TcpMode::none, 0.1, false}, kG52, kG52Off},
        ZeroForm{{"siemens", machines::TcpMode::none, 0.1, false}, R"(TRANS C=(R2)\n)", R"(TRANS\n)"},
        ZeroForm{{"siemens", machines::TcpMode::none, 0.1, false, 1}, R"(TRANS C=(R2)\n)", R"(TRANS\n)"},
        ZeroForm{{"siemens", machines::TcpMode::angles, 0.1, false, 0, true}, R"(TRANS C=(R2)\n)", R"(TRANS\n)"},
        ZeroForm{{"siemens", machines::TcpMode::angles, 0.1, false, 1, true}, R"(TRANS C=(R2)\n)", R"(TRANS\n)"},
        ZeroForm{{"siemens", machines::TcpMode::angles, 0.1, false, -1, true}, R"(TRANS C=(R2)\n)", R"(TRANS\n)"},
        ZeroForm{
            {"heidenhain", machines::TcpMode::none, 0, false}, R"(CYCL DEF 7.1 C(\+Q2)\n)", R"(TRANS DATUM RESET\n)"},
        ZeroForm{{"heidenhain", machines::TcpMode::angles, 0.1, false},
                 R"(CYCL DEF 7.1 C(\+Q2)\n)",
                 R"(TRANS DATUM RESET\n)"}));

// Every tooth is a turned copy, and no word holds a sum.
TEST_P(IndexZero, OneToothStandsForAll) {
  EXPECT_EQ(reading(text), "");
  const std::string words = edited("G52 [^\n]*|G10 [^\n]*", "", true);
  EXPECT_FALSE(std::regex_search(words, std::regex(R"([CA]=?(DC\(|\[|\+)?(ABS|R2\+|#1|Q5))"))) << text.substr(0, 3000);
  const auto written = program_of({GetParam().form.dialect, GetParam().form.tcp, GetParam().form.swing, true,
                                   GetParam().form.rollover, GetParam().form.granted},
                                  paths, kZeroTeeth, 1);
  ASSERT_TRUE(written);
  PostForm expanded = GetParam().form;
  expanded.expand = true;
  const auto long_text = text_of(expanded, *written);
  ASSERT_TRUE(long_text);
  EXPECT_LT(2 * text.size(), long_text->text.size());
}

// The tool stands where the written out program has it, in every cut of every tooth.
TEST_P(IndexZero, CutsWhatTheWrittenTeethCut) {
  PostForm expanded = GetParam().form;
  expanded.expand = true;
  const machines::Machine m = machine_of(expanded);
  const auto written = text_of(expanded, *program_of(expanded, paths, kZeroTeeth, 1));
  const auto control = controls::control_of(m, standing(), tools());
  const auto cuts = [&](const std::string& of) {
    std::vector<machines::TablePose> out;
    const auto done = readback::execute_nc(of, "p", *control, [&](const readback::ExecutedMove& e) {
      if (e.rapid || !e.known) return;
      const machines::Joints j{Vec3(e.joints[0], e.joints[1], e.joints[2]),
                               {radians(e.joints[3]), radians(e.joints[4])}};
      const machines::TablePose pose = m.chain.forward(j, control->tool_length_mm.at(e.tool));
      if (!out.empty() && (pose.tip_mm - out.back().tip_mm).norm() < 1e-6) out.pop_back();  // a turn, in pieces or not
      out.push_back(pose);
    });
    EXPECT_TRUE(done) << (done ? "" : done.error().text());
    return out;
  };
  const auto one = cuts(text), all = cuts(written->text);
  ASSERT_EQ(one.size(), all.size());
  const double digit =
      std::string(GetParam().form.dialect) == "fanuc" || std::string(GetParam().form.dialect) == "haas" ? 1e-3 : 1e-4;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_LT((one[i].tip_mm - all[i].tip_mm).norm(), 6 * digit) << i;
    EXPECT_LT((one[i].axis - all[i].axis).norm(), 3 * radians(digit)) << i;
  }
}

// 2 um at the rim, a zero that stays, one that is not cleared, a tooth twice.
TEST_P(IndexZero, WhatIsWrongWithItIsFound) {
  const ZeroForm& f = GetParam();
  const bool iso = f.on == kG52;
  std::smatch m;
  ASSERT_TRUE(std::regex_search(text, m, std::regex(f.on)));
  const auto digits = [&](const std::string& number) { return fmt::format("{:.4f}", std::stod(number) + 0.0012); };
  if (iso) {
    // The second tooth.
    const std::string& rest = m.suffix();
    std::smatch second;
    ASSERT_TRUE(std::regex_search(rest, second, std::regex(f.on)));
    std::string wrong =
        m.prefix().str() + m.str() + second.prefix().str() + "G52 C" + digits(second[1]) + "\n" + second.suffix().str();
    EXPECT_NE(reading(wrong).find("is turned by"), std::string::npos) << reading(wrong);
    wrong = m.prefix().str() + m.str() + second.prefix().str() + second.suffix().str();
    EXPECT_NE(reading(wrong).find("no copies: operation 0: tooth 0 twice"), std::string::npos) << reading(wrong);
    EXPECT_NE(reading(edited(kG52, "G52 X1. C$1\n")).find("it moves the zero of rotaries alone"), std::string::npos);
    EXPECT_NE(reading(edited(kG52, "G52 C$1 F10.\n")).find("G52 stands in a block of its own"), std::string::npos);
  } else {
    const std::string turned = edited(R"((360 ?/ ?)7)", "$017.0002");
    EXPECT_NE(reading(turned), "");
    EXPECT_NE(reading(edited(f.on, "")), "");
  }
  // The last line that clears it.
  const std::regex off(f.off);
  std::size_t last = std::string::npos, length = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), off), end; it != end; ++it)
    last = static_cast<std::size_t>(it->position()), length = static_cast<std::size_t>(it->length());
  ASSERT_NE(last, std::string::npos);
  std::string left = text;
  if (std::string(f.form.dialect) == "heidenhain") left.replace(last, length, "CYCL DEF 10.1 ROT+0\n");
  else left.erase(last, length);
  EXPECT_NE(reading(left).find("the next program would begin there"), std::string::npos) << reading(left);
  // Nothing clears what an earlier program has left.
  if (std::string(f.form.dialect) != "siemens") {
    const std::string never = std::string(f.form.dialect) == "heidenhain" ? edited(f.off, "CYCL DEF 10.1 ROT+0\n", true)
                                                                          : edited(f.off, "", true);
    EXPECT_NE(reading(never).find("what an earlier program has left is not known"), std::string::npos)
        << reading(never);
  }
}

// TRAORI in a moved zero is a matter of machine data: the machine file must grant it. TRAORI and TRAFOOF may drop the
// frames, so that TRANS stands behind each.
TEST(IndexZeroWithTraori, IsReadWhereItIsGrantedAndSaidAgain) {
  const PostForm form{"siemens", machines::TcpMode::angles, 0.1, false, 0, true};
  const auto program = program_of(form, {sample_path(0.3, 0.1, 4)}, 3, 1);
  ASSERT_TRUE(program && program->loop);
  const std::string text = text_of(form, *program)->text;
  const machines::Machine m = machine_of(form);
  const auto reading = [&](const std::string& of, bool granted = true) {
    auto control = controls::control_of(m, standing(), tools());
    control->transformation_takes_rotary_offset = granted;
    const auto read = readback::execute_nc(of, "p", *control, [](const readback::ExecutedMove&) {});
    return read ? std::string() : read.error().message;
  };
  EXPECT_EQ(reading(text), "");
  EXPECT_NE(text.find("TRAORI TAKES ROTARY OFFSETS FROM THE FRAME"), std::string::npos);
  EXPECT_EQ(text.find("ROT Z="), std::string::npos) << text;
  EXPECT_NE(reading(text, false).find("post.transformation_takes_rotary_offset of the machine file does not grant it"),
            std::string::npos)
      << reading(text, false);
  const auto edited = [&](const std::string& pattern, const std::string& to) {
    const std::string out = std::regex_replace(text, std::regex(pattern), to);
    EXPECT_NE(out, text) << pattern;
    return reading(out);
  };
  const std::string behind = "(TRAORI\nG54\nORIWKS\nORIAXES\n)TRANS C=R2\n";
  EXPECT_NE(edited(behind, "$1").find("TRANS must be said again"), std::string::npos) << edited(behind, "$1");
  EXPECT_NE(edited(behind, "$1TRANS C=R2+1\n").find("with TCP on"), std::string::npos);
  EXPECT_NE(edited(behind, "$1TRANS\n").find("with TCP on"), std::string::npos);
  EXPECT_NE(edited(behind, "$1TRANS A=1\n").find("with TCP on"), std::string::npos);
}

// The zero stays where it is while the control keeps the tip.
TEST(IndexZeroWithTcp, IsNotMovedWhileTheTipIsKept) {
  const PostForm form{"fanuc", machines::TcpMode::angles, 0.1, false};
  const auto program = program_of(form, {sample_path(0.3, 0.1, 4)}, 3, 1);
  ASSERT_TRUE(program && program->loop);
  const auto text = text_of(form, *program);
  const machines::Machine m = machine_of(form);
  const auto control = controls::control_of(m, standing(), tools());
  const auto wrong = std::regex_replace(text->text, std::regex("(G0 G43\\.4 [^\n]*\n)"), "$1G52 C10.\n");
  const auto read = readback::execute_nc(wrong, "p", *control, [](const readback::ExecutedMove&) {});
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("G52 moves the zero of C with TCP on"), std::string::npos);
  // Away from the zero of the words TCP does not start.
  const auto turned = std::regex_replace(text->text, std::regex("G0 C0\\. A0\\."), "G0 C1. A0.");
  const auto away = readback::execute_nc(turned, "p", *control, [](const readback::ExecutedMove&) {});
  ASSERT_FALSE(away);
  EXPECT_NE(away.error().message.find("away from zero"), std::string::npos);
}

}  // namespace
}  // namespace toothpath
