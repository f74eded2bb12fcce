// What editors and post processors add around a right motion: it is read where it changes nothing, and else refused by
// name where it stands. Messages name the cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "tests/postproc/readback/hand_program.h"
#include "tests/support/files.h"

namespace toothpath::test::hand {
namespace {

/// Where the last cut ends; an error text where there is none.
std::string end_of(const std::string& dialect, const std::string& body) {
  const Executed e = executed(dialect, body);
  if (!e.refused.empty()) return e.refused;
  return fmt::format("{:.3f} {:.3f} {:.3f}, {} moves", e.moves.back().joints[0], e.moves.back().joints[1],
                     e.moves.back().joints[2], e.moves.size());
}

TEST(Editors, SiemensNumbersAndCapitalsChangeNothing) {
  const std::string plain =
      "R1=2\nFOR R1=1 TO 2\nG1 X=5+R1 F100\nENDFOR\nMSG(\"tooth\")\nCYCLE832(0.002,_FINISH,1)\n"
      "CYCLE832()\nG60\nG1 X9 F100\n";
  const std::string as_it_is = end_of("siemens", plain);
  EXPECT_EQ(as_it_is.find("error"), std::string::npos) << as_it_is;
  std::string numbered, small, both;
  int n = 10;
  for (std::istringstream in(plain); std::getline(in, small);) {
    numbered += fmt::format("N{} {}\n", n, small);
    std::string lower;
    for (const char c : small) lower += static_cast<char>(std::tolower(c));
    both += fmt::format(" n{}{} ; Comment\n", n++, lower);
  }
  EXPECT_EQ(end_of("siemens", numbered), as_it_is);
  EXPECT_EQ(end_of("siemens", both), as_it_is);
  EXPECT_EQ(end_of("siemens", ":20 G1 X9 F100\nN30\n"), end_of("siemens", "G1 X9 F100\n"));
  EXPECT_TRUE(holds(end_of("siemens", "/ N10 FOR R1=1 TO 2\nENDFOR\n"), "p:16:1: error: a block that may be skipped"));
  EXPECT_TRUE(holds(end_of("siemens", "/2 N10 M0\nG1 X9 F100\n"), "moves"));
}

TEST(Editors, SiemensNamesWhatItDoesNotRead) {
  const std::tuple<const char*, const char*> cases[] = {
      {"TRAORI(2)\n", "p:16:8: error: TRAORI(2): the machine file states one transformation, number 1"},
      {"TRAORI(1,5)\n", "TRAORI(1) expected"},
      {"T=\"BALL4\"\n", "p:16:1: error: T=\"BALL4\": the tools of the list are called T=\"T1\""},
      {"T=\"T1.5\"\n", "T=\"T1.5\": the tools of the list"},
      {"T1\n", "p:16:1: error: T1: the tools of the list are called T=\"T1\""},
      {"STOPRE\n", "p:16:1: error: STOPRE is not in the subset"},
      {"$P_UIFR[1]=0\n", "p:16:1: error: character '$' is no part of a word"},
      {"MSG(5)\n", "MSG is read with one text in quotes"},
      {"\x01\n", "p:16:1: error: character 0x01 is no part of a word"}};
  for (const auto& [words, expected] : cases)
    EXPECT_TRUE(holds(end_of("siemens", words), expected)) << words << end_of("siemens", words);
}

TEST(Editors, HeidenhainCommentsAndSpellings) {
  const std::string plain = "L X+7 R0 FMAX\nL X+9 F100\n", expected = end_of("heidenhain", plain);
  EXPECT_EQ(expected.find("error"), std::string::npos) << expected;
  for (const std::string body :
       {"L X+7 R0 FMAX ; over the tooth\nL X+9 F100;cut\n", "L X+7 R0 F MAX\nL X+9 F 100\n",
        "L  X+7  R0 FMAX\nL X+9 F100\n",
        "* - finishing\nL X+7 FMAX\nBLK FORM 0.1 Z X-50 Y-50 Z-20\nBLK FORM 0.2 X+50 Y+50 Z+0\nL X+9 F100\n",
        "L X+7 R0 FMAX\nCYCL DEF 247 DATUM SETTING ~\n  Q339=+1 ;DATUM NUMBER\nL X+9 F100\n"}) {
    std::string text = whole("heidenhain", body);
    const auto next = text.find("~\n");  // the line that goes on has no number
    if (next != std::string::npos) {
      const std::string head = text.substr(0, next + 2);
      std::string out = head;
      int number = static_cast<int>(std::count(head.begin(), head.end(), '\n'));
      std::istringstream in(text.substr(next + 2));
      for (auto [line, first] = std::pair{std::string(), true}; std::getline(in, line); first = false) {
        line = line.substr(line.find(' ') + 1);
        out += first ? line + "\n" : fmt::format("{} {}\n", number++, line);
      }
      text = out;
    }
    const auto control = controls::control_of(machine_with("heidenhain"), standing(), tools());
    std::vector<ExecutedMove> moves;
    const auto s = readback::execute_nc(text, "p", *control, [&](const ExecutedMove& e) { moves.push_back(e); });
    ASSERT_TRUE(s) << s.error().text() << "\n" << text;
    EXPECT_EQ(fmt::format("{:.3f} {:.3f} {:.3f}, {} moves", moves.back().joints[0], moves.back().joints[1],
                          moves.back().joints[2], moves.size()),
              expected)
        << body;
  }
}

TEST(Editors, HeidenhainTools) {
  const auto call = [](const std::string& words) {
    return end_of("heidenhain", "M5\nL Z+500 R0 FMAX M91\nTOOL CALL " + words + "\nM3\nL X+6 F100\n");
  };
  EXPECT_TRUE(holds(call("1 Z S1200"), "moves"));
  EXPECT_EQ(call("1 Z S1200"), call("1 Z  S1200 DL+0 DR+0 DR2+0.0 F500 ; ball"));
  EXPECT_TRUE(holds(call("1 Z S1200 DL+0.05"), "error: DL+0.05: the tool would have another size than in the list"));
  EXPECT_TRUE(holds(call("1 Z S1200 DR-0.1"), "error: DR-0.1: the tool would have another size"));
  EXPECT_TRUE(holds(call("\"BALL4\" Z S1200"), "error: tool \"BALL4\" is called by its name"));
  EXPECT_TRUE(holds(call("1 Z S1200 Q5"), "error: Q5 is not in the subset of TOOL CALL"));
  EXPECT_TRUE(holds(end_of("heidenhain", "TOOL DEF \"BALL4\"\n"), "error: tool \"BALL4\" is called by its name"));
  EXPECT_TRUE(holds(end_of("heidenhain", "L X+6 F AUTO\n"), "error: F AUTO is not in the subset"));
  EXPECT_TRUE(holds(end_of("heidenhain", "L X+6 RL F100\n"), "error: RL is not in the subset"));
  EXPECT_TRUE(holds(end_of("heidenhain", "L IX+6 F100\n"), "error: IX+6 is not in the subset"));
  EXPECT_TRUE(holds(end_of("heidenhain", "CC X+1 Y+1\n"), "error: CC X+1 Y+1 is not in the subset"));
}

TEST(Editors, NumbersAheadOfOWords) {
  const std::string plain = "o50 sub\nG1 X9 F100\no50 endsub\no50 call\n", expected = end_of("linuxcnc", plain);
  EXPECT_TRUE(holds(expected, "moves")) << expected;
  EXPECT_EQ(end_of("linuxcnc", "N10 o50 sub\nN20 G1 X9 F100\nn30 O50 endsub\nN40o50 call (once)\n"), expected);
  EXPECT_TRUE(
      holds(end_of("linuxcnc", "o<foo> call\n"), "p:16:1: error: o<foo> has a name: it may stand for another file"));
  EXPECT_TRUE(holds(end_of("linuxcnc", "N10 o<foo> call [1]\n"), "p:16:5: error: o<foo> has a name"));
  EXPECT_TRUE(holds(end_of("fanuc", "/2 M0\nG1 X9. F100.\n"), "moves"));
}

TEST(Editors, NumbersAheadOfAssignments) {
  for (const std::string d : {"linuxcnc", "fanuc", "haas"}) {
    const std::string expected = end_of(d, "G1 X9. F100.\n");
    EXPECT_EQ(end_of(d, "#101=9.\nG1 X#101 F100.\n"), expected) << d;
    EXPECT_EQ(end_of(d, "N10 #101=9.\nN20 G1 X#101 F100.\n"), expected) << d;
    EXPECT_TRUE(holds(end_of(d, "N10 G1 X6. F100. #101=9.\n"), "an assignment in a line of words")) << d;
  }
}

TEST(Editors, MarksAndEndsOfLinesThatAreNotPlain) {
  for (const std::string d : {"linuxcnc", "siemens", "heidenhain"}) {
    const auto control = controls::control_of(machine_with(d), standing(), tools());
    const auto refusal = [&](const std::string& text) {
      const auto r = readback::execute_nc(text, "p", *control, [](const ExecutedMove&) {});
      return r ? std::string() : r.error().text();
    };
    const std::string good = whole(d, cut(d));
    EXPECT_EQ(refusal(replaced_all(good, "\n", "\r\n")), "") << d;
    EXPECT_TRUE(holds(refusal("\xef\xbb\xbf" + good), "p:1:1: error: a byte order mark begins the text")) << d;
    EXPECT_TRUE(holds(refusal(replaced_all(good, "\n", "\r")), "error: the line ends with CR alone")) << d;
    EXPECT_TRUE(holds(refusal(good.substr(0, good.find('\n') + 1) + "ab\rc\n"), "p:2:3: error: the line ends")) << d;
  }
  const std::string text = replaced(whole("heidenhain", cut("heidenhain")), "\n", "\n\n");
  const auto control = controls::control_of(machine_with("heidenhain"), standing(), tools());
  const auto empty = readback::execute_nc(text, "p", *control, [](const ExecutedMove&) {});
  ASSERT_FALSE(empty);
  EXPECT_TRUE(holds(empty.error().text(), "p:2:1: error: block number 1 expected, the line is empty"));
}

// What is missing is said, and not what follows from it.
TEST(Editors, AMissingToolIsTheCause) {
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {"linuxcnc", "G21 G90 G94 G61\nG54\n(OP 0 finishing)\nS100 M3\nG0 A0. C0.\nG0 X5. Y5.\nG0 Z50.\nM2\n",
       "Z word in work coordinates before a tool was called"},
      {"linuxcnc",
       "G21 G90 G94 G61\nG54\n(OP 0 finishing)\nS100 M3\nG43 H1\nG0 A0. C0.\nG0 X5. Y5.\nG0 Z50.\nG1 Z40. F9\nM2\n",
       "G1 before a tool was called"},
      {"siemens", "G90 G710 G94\nG54\n;OP 0 finishing\nD1\nM30\n", "the length of a tool before a tool was called"},
      {"heidenhain", "0 BEGIN PGM P MM\n1 ; OP 0 finishing\n2 M3\n3 M30\n4 END PGM P MM\n",
       "the spindle starts before a tool was called"}};
  for (const auto& [d, text, expected] : cases) {
    const auto control = controls::control_of(machine_with(d), standing(), tools());
    const auto r = readback::execute_nc(text, "p", *control, [](const ExecutedMove&) {});
    ASSERT_FALSE(r) << text;
    EXPECT_TRUE(holds(r.error().text(), expected)) << r.error().text();
  }
}

}  // namespace
}  // namespace toothpath::test::hand
