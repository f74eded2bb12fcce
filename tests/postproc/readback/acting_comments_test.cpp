// Comments that a control executes, or that do something else than tell people: refused by name wherever they stand, in
// programs and in lines of a machine file. What LinuxCNC executes is asked of its interpreter.
#include <gtest/gtest.h>

#include <cctype>
#include <functional>

#include "tests/postproc/readback/hand_program.h"
#include "tests/support/rs274.h"

namespace toothpath::test::hand {
namespace {

// Its interpreter moves the axes where our reader, before it knew them, saw a comment.
TEST(ActingComments, LinuxcncExecutesPython) {
  const std::string python = ";py,from interpreter import *; this.execute(\"G53 G0 Z-3\",0)\n";
  const auto moved = interpret("G21 G90 G94 F100\nG0 X1\n" + python + "M2\n", "py_comment");
  std::string all;
  for (const std::string& line : moved.lines) all += line + "\n";
  EXPECT_TRUE(holds(all, "STRAIGHT_TRAVERSE(1.0000, 0.0000, -3.0000")) << all;
  EXPECT_EQ(interpret("G21 G90 G94 F100\nG0 X2 (a)(py,x=1/0)\nM2\n", "py_behind").exit, 1);
  EXPECT_EQ(executed("linuxcnc", python).refused,
            "p:16:1: error: comment ;PY, ..: LinuxCNC runs Python in the interpreter, which may move the machine and "
            "write files");
}

TEST(ActingComments, LinuxcncRefusesThemByName) {
  for (const char* name : {"PY,", "PYRUN,", "PYRELOAD", "LOGOPEN,", "LOGAPPEND,", "LOG,", "LOGCLOSE", "PROBEOPEN ",
                           "PROBECLOSE", "RPY ", "AXIS,hide", "AXIS, stop", "PREVIEW,hide"}) {
    const std::string word = name, small = [&] {
      std::string out;
      for (const char c : word) out += static_cast<char>(std::tolower(c));
      return out;
    }();
    const std::string shown = word.substr(0, word.find_first_of(", "));
    for (const std::string& comment :
         {"(" + word + "x)", "(" + small + "x)", "( \t" + word + " x)", ";" + word + "x", ";  " + small + "x",
          "(first)(" + word + "x)", "(" + word + "x)(last)", "(no end ;" + word + "x"}) {
      for (const std::string& line :
           {comment, "N10 " + comment, "/" + comment, "G1 X6. F100. " + comment, "#1=3 " + comment}) {
        const std::string refused = executed("linuxcnc", line + "\n").refused;
        EXPECT_TRUE(holds(refused, "p:16:")) << line << ": " << refused;
        EXPECT_TRUE(holds(refused, shown) && holds(refused, "LinuxCNC ")) << line << ": " << refused;
      }
    }
  }
  // A loop that our reading does not enter, a sub-program that nobody calls, behind the end.
  for (const std::string where : {"o50 while [#5224 GT 0]\n(py,x)\no50 endwhile\n", "o50 sub (py,x)\no50 endsub\n"})
    EXPECT_TRUE(holds(executed("linuxcnc", where).refused, "comment (PY, ..)")) << where;
  const std::string text = whole("linuxcnc", cut("linuxcnc")) + "(py,x)\n";
  const auto control = controls::control_of(machine_with("linuxcnc"), standing(), tools());
  const auto behind = readback::execute_nc(text, "p", *control, [](const ExecutedMove&) {});
  ASSERT_FALSE(behind);
  EXPECT_TRUE(holds(behind.error().text(), "comment (PY, ..)"));
}

TEST(ActingComments, LinuxcncReadsWhatOnlyTellsPeople) {
  for (const char* comment : {"(MSG, look)", "(DEBUG, x = #1)", "(PRINT, x)", "(PYTHON, no)", "(see py, docs)",
                              "(LOGO)", "(LOG OF CHANGES)", "(AXIS, C IS UP)", "(PYRAMID)", ";plain", "()"})
    EXPECT_EQ(executed("linuxcnc", std::string(comment) + "\n" + cut("linuxcnc")).refused, "") << comment;
}

// ; ends a block there: text behind it is the next one.
TEST(ActingComments, TextBehindTheEndOfABlock) {
  for (const char* d : {"fanuc", "mitsubishi_m80", "haas"}) {
    for (const char* line : {"G1 X6. F100. ; G53 G0 Z0.", "; G53 G0 Z0.", ";M5", "(a) ;M5", "G1 X6. F100.;;M5"})
      EXPECT_TRUE(holds(executed(d, std::string(line) + "\n").refused, "text behind ; which ends a block"))
          << d << line;
    for (const char* line : {"(50%)", "G1 X6. F100. (A % B)", "/ (%", "N10 (A) (%)"})
      EXPECT_TRUE(holds(executed(d, std::string(line) + "\n").refused, "% in a comment: this control takes it"))
          << d << line;
    for (const char* line : {"G1 X6. F100. ;", "G1 X6. F100. (A; B)", ";", "(A; B) ; "})
      EXPECT_EQ(executed(d, std::string(line) + "\n").refused, "") << d << line;
  }
}

TEST(ActingComments, SiemensSaysWhereTheTextIsFiled) {
  EXPECT_TRUE(holds(executed("siemens", ";$PATH=/_N_CMA_DIR\n").refused, "p:16:1: error: comment ;$PATH="));
  EXPECT_TRUE(
      holds(executed("siemens", "G1 X6 F100 ; $path = /_N_CMA_DIR\n").refused, "p:16:12: error: comment ;$PATH="));
  EXPECT_TRUE(
      holds(executed("siemens", "%_N_L6_SPF\n").refused, "p:16:1: error: a line %..: it says under which name"));
  EXPECT_EQ(executed("siemens", "MSG(\"a; b\") ; $PATHS\n" + cut("siemens")).refused, "");
}

TEST(ActingComments, HeidenhainGoesOnInTheNextLine) {
  for (const auto& [line, column] : {std::pair{"L X+6 F100 ; text ~", 15}, {"; text ~ ", 4}, {"* - text ~", 4}})
    EXPECT_TRUE(holds(executed("heidenhain", std::string(line) + "\nL Z-9 F100\n").refused,
                      fmt::format(":{}: error: comment that ends with ~: the control takes the next line", column)))
        << executed("heidenhain", std::string(line) + "\nL Z-9 F100\n").refused;
  EXPECT_EQ(executed("heidenhain", "; a ~ b\n" + cut("heidenhain")).refused, "");
}

TEST(ActingComments, AptHandsNoTextOn) {
  machines::Machine m = with_dialect(trunnion(), "apt");
  m.tcp = machines::TcpMode::vectors;
  const auto control = controls::control_of(m, standing(), tools());
  const auto refusal = [&](const std::string& text) {
    const auto r = readback::execute_nc(text, "p", *control, [](const ExecutedMove&) {});
    return r ? std::string() : r.error().text();
  };
  EXPECT_TRUE(holds(refusal("PARTNO/GEAR) G53 G0 Z0 (\n"), "p:1:12: error: PARTNO with ')'"));
  EXPECT_TRUE(holds(refusal("PARTNO/GEAR\nINSERT/G53 G0 Z0\n"), "p:2:1: error: INSERT hands its text"));
  EXPECT_TRUE(holds(refusal("PARTNO/GEAR\nPPRINT/(G53 G0 Z0\n"), "p:2:1: error: PPRINT hands its text"));
  EXPECT_TRUE(holds(refusal("UNITS/MM $$ of the gear\nMULTAX/ON\nEND\nCYCLE/1\n"), "p:4:1: error: CYCLE is not in"));
}

TEST(ActingComments, LinesOfAMachineFileHaveNone) {
  const auto complaints = [](const char* dialect, const std::function<void(machines::Machine&)>& change) {
    machines::Machine m = with_dialect(trunnion(), dialect);
    change(m);
    std::string all;
    for (const auto& e : controls::judge(m)) all += e.message + "\n";
    return all;
  };
  const std::string line = "( Py , this.execute('G53 G0 Z-300'))";
  const std::vector<std::string> lines = {"M9", line};
  const std::pair<const char*, std::function<void(machines::Machine&)>> keys[] = {
      {"post.start", [&](auto& m) { m.post.own_lines.start = lines; }},
      {"post.tool_change",
       [&](auto& m) {
         m.post.own_lines.tool_change = {"T{tool} M6", line};
       }},
      {"post.between_teeth", [&](auto& m) { m.post.own_lines.between_teeth = lines; }},
      {"post.end", [&](auto& m) { m.post.own_lines.end = lines; }},
      {"post.tcp_on", [&](auto& m) { m.post.tcp_on = lines; }},
      {"post.tcp_off", [&](auto& m) { m.post.tcp_off = lines; }},
      {"tool_check.lines", [&](auto& m) {
         m.tool_check.emplace();
         m.tool_check->lines = {"G65 H{tolerance}", line};
       }}};
  for (const auto& [key, change] : keys)
    EXPECT_TRUE(
        holds(complaints("linuxcnc", change), std::string(key) + ": \"" + line + "\", column 1: comment (PY, ..)"))
        << key << complaints("linuxcnc", change);
  for (const char* d : {"fanuc", "mitsubishi_m80", "haas"}) {
    EXPECT_TRUE(holds(complaints(d, [](auto& m) { m.post.own_lines.end = {"M9 ; G53 G0 Z0."}; }),
                      "post.end: \"M9 ; G53 G0 Z0.\", column 4: text behind ;"))
        << d;
    EXPECT_EQ(complaints(d, [](auto& m) { m.post.own_lines.end = {"M9 (A; B)"}; }), "") << d;
  }
  EXPECT_TRUE(holds(complaints("heidenhain", [](auto& m) { m.post.own_lines.start = {"; text ~"}; }),
                    "post.start: \"; text ~\", column 1: comment that ends with ~"));
  EXPECT_TRUE(holds(complaints("siemens", [](auto& m) { m.post.own_lines.start = {";$PATH=/_N_MPF_DIR"}; }),
                    "post.start: \";$PATH=/_N_MPF_DIR\", column 1: comment ;$PATH="));
}

}  // namespace
}  // namespace toothpath::test::hand
