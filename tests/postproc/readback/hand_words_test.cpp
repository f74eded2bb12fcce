// Words that people add to a program by hand, in every dialect: waits, stops, several M words in a block, reference
// positions, named parameters. What they do is told by hand, and for LinuxCNC by its own interpreter.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <regex>

#include "tests/postproc/readback/hand_program.h"
#include "tests/support/rs274.h"

namespace toothpath::test::hand {
namespace {

TEST(HandWords, TheOpeningsCut) {
  for (const auto& d : kDialects) {
    const Executed e = executed(d, cut(d));
    EXPECT_EQ(e.refused + e.reasons + e.warnings, "") << d;
    EXPECT_NEAR(e.moves.back().joints[0], 6 + 3, 1e-9) << d;
    EXPECT_NEAR(e.moves.back().joints[2], 40 + 95, 1e-9) << d;
  }
}

// 1.5 s and 30 turns at 1200/min.
TEST(HandWords, WaitsCountInTheClock) {
  const std::tuple<const char*, const char*, double> waits[] = {
      {"linuxcnc", "G4 P1.5\n", 1.5},
      {"fanuc", "G4 P1500\n", 1.5},
      {"fanuc", "G4 X1.5\n", 1.5},
      {"mitsubishi_m80", "N7 G4 P1500\n", 1.5},
      {"haas", "G4 P1.5\n", 1.5},
      {"haas", "G4 P1500\n", 1.5},
      {"siemens", "G4 F1.5\n", 1.5},
      {"siemens", "G4 S30\n", 1.5},
      {"heidenhain", "CYCL DEF 9.0 DWELL TIME\nCYCL DEF 9.1 DWELL 1.5\n", 1.5},
      {"heidenhain", "FUNCTION DWELL TIME1.5\n", 1.5},
      {"heidenhain", "FUNCTION DWELL REV30\n", 1.5}};
  for (const auto& [d, words, seconds] : waits) {
    const Executed without = executed(d, cut(d)), with = executed(d, words + cut(d));
    EXPECT_EQ(with.refused, "") << d << words;
    EXPECT_NEAR((with.minutes - without.minutes) * 60, seconds, 1e-6) << d << words;
    EXPECT_EQ(with.reasons, "") << d;
    EXPECT_TRUE(holds(with.warnings, "waits 1.5 s in a cut: the tool rubs")) << d << with.warnings;
    EXPECT_EQ(with.moves.size(), without.moves.size());
    // In the air, and behind the last move.
    const Executed air = executed(d, up(d) + words + up(d));
    EXPECT_EQ(air.refused + air.warnings, "") << d;
    const Executed last = executed(d, up(d) + words);
    EXPECT_NEAR((last.minutes - executed(d, up(d)).minutes) * 60, seconds, 1e-6) << d;
  }
}

TEST(HandWords, WaitsThatMeanSomethingElseAreRefused) {
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {"linuxcnc", "G4 P90000\n", "a dwell of 1500 min, more than 1440 (a day): is its unit right?"},
      {"linuxcnc", "G4 X1\n", "p:16:4: error: G4 stands in a block of its own, with P"},
      {"linuxcnc", "G4 P-1\n", "a dwell must not be negative"},
      {"fanuc", "G4 P1.5\n", "P of G4 is a whole number of milliseconds"},
      {"fanuc", "G4 X1\n", "X without a decimal point"},
      {"fanuc", "G4 P500 Z1.\n", "G4 stands in a block of its own, with P or X"},
      {"siemens", "G4 F1 X3\n", "G4 stands in a block of its own, with F or S"},
      {"siemens", "G4\n", "G4 stands in a block of its own"},
      {"heidenhain", "FUNCTION DWELL TIME\n", "number expected"},
      {"heidenhain", "M5\nFUNCTION DWELL REV3\n", "in turns of the spindle, which stands"}};
  for (const auto& [d, words, expected] : cases) {
    const Executed e = executed(d, words + cut(d));
    EXPECT_TRUE(holds(e.refused, expected)) << d << ": " << words << " gave " << e.refused;
  }
}

// LinuxCNC's spindle goes on behind a stop; Haas and Heidenhain end it; of the others the builder decides.
TEST(HandWords, StopsAndWhatTheyEnd) {
  for (const auto& d : kDialects)
    for (const std::string stop : {"M0\n", "M1\n"}) {
      const Executed e = executed(d, stop + cut(d));
      const Executed again = executed(d, stop + "M3\nM8\n" + cut(d));
      EXPECT_EQ(again.refused + again.reasons + again.warnings, "") << d;
      EXPECT_EQ(executed(d, stop).refused, "") << d;
      if (d == "linuxcnc") {
        EXPECT_EQ(e.refused + e.reasons + e.warnings, "");
      } else if (d == "haas" || d == "heidenhain") {
        EXPECT_TRUE(holds(e.refused, "G1 while the spindle stands")) << d << e.refused;
        EXPECT_TRUE(holds(executed(d, stop + "M3\n" + cut(d)).reasons, "cuts without flood")) << d;
      } else {
        EXPECT_EQ(e.refused + e.reasons, "") << d;
        EXPECT_TRUE(holds(e.warnings, "cuts behind an M0 or M1 that may have ended spindle or coolant")) << d;
      }
    }
  EXPECT_EQ(executed("heidenhain", "STOP\nM3\nM8\n" + cut("heidenhain")).refused, "");
  EXPECT_TRUE(holds(executed("heidenhain", "STOP\n" + cut("heidenhain")).refused, "G1 while the spindle stands"));
}

TEST(HandWords, CoolantThatIsSwitchedOffInACut) {
  for (const auto& d : kDialects) {
    EXPECT_TRUE(holds(executed(d, "M9\n" + cut(d)).reasons, "cuts without flood, the coolant of the job")) << d;
    EXPECT_EQ(executed(d, "M9\nM8\n" + cut(d)).reasons, "") << d;
    EXPECT_TRUE(holds(executed(d, "M5\n" + cut(d)).refused, "G1 while the spindle stands")) << d;
  }
}

TEST(HandWords, SeveralMWordsInABlock) {
  for (const auto& d : kDialects) {
    const Executed on = executed(d, "M5 M9\nM3 M8\n" + cut(d));
    if (d == "haas") {
      EXPECT_TRUE(holds(on.refused, "two M words in a block: the control takes one")) << on.refused;
      continue;
    }
    EXPECT_EQ(on.refused + on.reasons, "") << d;
    EXPECT_TRUE(holds(executed(d, "M3 M5\n").refused, "M3 and M5 of one group in a block")) << d;
    EXPECT_TRUE(holds(executed(d, "M8 M9\n").refused, "M8 and M9 of one group in a block")) << d;
    EXPECT_TRUE(holds(executed(d, "M9 M5\n" + cut(d)).refused, "G1 while the spindle stands")) << d;
  }
  EXPECT_EQ(executed("linuxcnc", "M7 M8 M3\n" + cut("linuxcnc")).refused, "");
  EXPECT_TRUE(holds(executed("fanuc", "M7 M8 M3 M1\n").refused, "more than 3 M words in a block"));
  // Of a straight line: on ahead of the motion, off behind it.
  EXPECT_EQ(executed("heidenhain", "M5\nL X+6 F100 M3 M8\n").refused, "");
  EXPECT_EQ(executed("heidenhain", "L X+6 F100 M5 M9\n").refused, "");
  EXPECT_TRUE(holds(executed("heidenhain", "L X+6 F100 M5 M9\nL X+7\n").refused, "G1 while the spindle stands"));
  EXPECT_EQ(executed("heidenhain", "M5\nM9\nM13\n" + cut("heidenhain")).reasons, "");
}

TEST(HandWords, ReferencePositions) {
  const std::tuple<const char*, const char*, std::size_t, double> cases[] = {
      {"linuxcnc", "G91 G28 Z0\nG90\n", 2, 480},
      {"linuxcnc", "G28 Z400\n", 2, 480},
      {"linuxcnc", "G30 Z400\n", 2, 510},
      {"fanuc", "G91 G28 Z0.\nG90\n", 2, 480},
      {"fanuc", "G91 G30 P2 Z0.\nG90\n", 2, 510},
      {"haas", "G91 G28 Z0.\nG90\n", 2, 480},
      {"mitsubishi_m80", "G28 Z400.\n", 2, 480},
      {"siemens", "G75 FP=1 Z1=0\n", 2, 480},
      {"siemens", "G75 FP=2 Z1=0\n", 2, 510},
      {"siemens", "G75 Z1=0\n", 2, 480},
      {"heidenhain", "L Z+0 R0 FMAX M92\n", 2, 480},
      {"heidenhain", "L Z-10.5 R0 FMAX M92\n", 2, 469.5}};
  for (const auto& [d, words, axis, goal] : cases) {
    const Executed e = executed(d, words);
    ASSERT_EQ(e.refused, "") << d << words;
    const ExecutedMove& last = e.moves.back();
    EXPECT_TRUE(last.rapid && last.machine && last.known) << d;
    EXPECT_NEAR(last.joints[axis], goal, 1e-9) << d << words;
    EXPECT_NEAR(last.joints[0], 8, 1e-9) << d;
    EXPECT_GT(last.minutes, 0);
    const Executed unsaid = executed(d, words, false);
    EXPECT_TRUE(holds(unsaid.refused, "nothing says where it goes: post.") &&
                holds(unsaid.refused, "reference_position = [X, Y, Z, rotaries] in the machine file does"))
        << unsaid.refused;
  }
  // Through the place that the words name, in two rapids.
  const Executed by_way = executed("fanuc", "G28 Z100.\n");
  ASSERT_GE(by_way.moves.size(), 2U);
  EXPECT_NEAR(by_way.moves[by_way.moves.size() - 2].joints[2], 195, 1e-9);
  const Executed steps = executed("linuxcnc", "G91 G28 Z7.5\nG90\n");
  EXPECT_NEAR(steps.moves[steps.moves.size() - 2].joints[2], 135 + 7.5, 1e-9);
  // All axes at once move more than one group: the proof of the rapids refuses that.
  const Executed all = executed("linuxcnc", "G28\n");
  EXPECT_TRUE(readback::mixes_axis_groups(all.moves[all.moves.size() - 2], all.moves.back()));
}

TEST(HandWords, ReferencePositionsThatWouldGoElsewhere) {
  const std::tuple<const char*, const char*, const char*> cases[] = {
      {"fanuc", "G91 G28 Z0.\nG0 X1.\n", "axis words in G91: steps are read with G28 and G30 alone"},
      {"linuxcnc", "G91\nG1 X1\n", "axis words in G91"},
      {"fanuc", "G28\n", "G28 needs the axes that go"},
      {"fanuc", "G91 G28 Z0.\nG90\nG0 Z300.\n", "Z word without tool length compensation"},
      {"haas", "G30 P2 Z400.\n", "G30 with this P is not in the subset"},
      {"linuxcnc", "G28.1\n", "G28.1 is not in the subset"},
      {"linuxcnc", "G53 G28 Z0\n", "G28 with another motion or G43 in a block"},
      {"siemens", "G75 FP=3 Z1=0\n", "G75 FP=3 is not in the subset: 1 and 2 are"},
      {"siemens", "G75 FP=1\n", "G75 stands in a block of its own"},
      {"siemens", "G75 FP=1 Z0\n", "G75 takes the axes of the machine: Z1=0"},
      {"heidenhain", "L Z+0 FMAX M91 M92\n", "M91 and M92 in a block"},
      {"heidenhain", "L M140 MB MAX FMAX\n", "M140 is not in the subset"}};
  for (const auto& [d, words, expected] : cases) {
    const Executed e = executed(d, words);
    EXPECT_TRUE(holds(e.refused, expected)) << d << ": " << words << " gave " << e.refused;
    EXPECT_EQ(e.refused.rfind("p:", 0), 0U) << e.refused;
  }
  EXPECT_EQ(executed("linuxcnc", "G91 G28 Z0\nG90\nG0 Z300\n").refused, "");
}

// A block that may be left out is proven where it does not matter.
TEST(HandWords, BlocksThatMayBeSkipped) {
  for (const auto& d : kDialects) {
    EXPECT_EQ(executed(d, up(d) + "/M0\n").refused, "") << d;
    EXPECT_EQ(executed(d, up(d) + "/M1\n").refused, "") << d;
    const std::string motion = executed(d, "/" + cut(d)).refused;
    EXPECT_TRUE(holds(motion, "a block that may be skipped is read with M0, M1")) << d << motion;
    EXPECT_TRUE(holds(executed(d, "/M8\n").refused, "a block that may be skipped is read with")) << d;
  }
}

TEST(HandWords, NamedParametersOfLinuxCnc) {
  const auto end_x = [](const std::string& body) {
    const Executed e = executed("linuxcnc", body);
    EXPECT_EQ(e.refused, "") << body;
    return e.moves.back().joints[0] - 3;
  };
  EXPECT_NEAR(end_x("#<depth> = 6.5\nG1 X#<depth> F100\n"), 6.5, 1e-12);
  EXPECT_NEAR(end_x("#<My Depth> = 6\nG1 X[#<mydepth>/2+#<MYDEPTH>] F100\n"), 9, 1e-12);
  EXPECT_NEAR(end_x("#1=2\n#1=5 #<a>=#1\nG1 X#<a> F100\n"), 2, 1e-12);  // none is set before all are known
  // A global one is seen by the sub-program; a local one of the same name is its own.
  const std::string sub = "o9 sub\n#<a>=[#<_g>+1]\nG1 X#<a> F100\no9 endsub\n#<_g>=10\n#<a>=4\no9 call\n";
  EXPECT_NEAR(end_x(sub), 11, 1e-12);
  EXPECT_NEAR(end_x(sub + "G1 X#<a>\n"), 4, 1e-12);
  const auto refused = [](const std::string& body) { return executed("linuxcnc", body).refused; };
  EXPECT_TRUE(
      holds(refused("G1 X#<_feed> F100\n"),
            "p:16:4: error: parameter #<_feed> was never set by the program: what the control itself puts there"))
      << refused("G1 X#<_feed> F100\n");
  EXPECT_TRUE(holds(refused("o9 sub\nG1 X#<a> F100\no9 endsub\n#<a>=4\no9 call\n"), "parameter #<a> was never set"));
  EXPECT_TRUE(holds(refused("#<_c>=4\n"), "p:16:1: error: #<_c> is the control's own and cannot be set"));
  EXPECT_TRUE(holds(refused("#<a=4\n"), "name of a parameter without its >"));
  EXPECT_TRUE(holds(refused("#<>=4\n"), "a parameter without a name"));
  EXPECT_TRUE(holds(executed("fanuc", "#<a>=4\n").refused, "number of a variable expected behind #"));
}

// Tool offsets, outputs, alarms, what stops do, modal words: a text that writes them is no longer the one that is read.
TEST(HandWords, VariablesOfTheControlAreNotOfAProgram) {
  for (const char* d : {"fanuc", "haas", "mitsubishi_m80"}) {
    for (const int n : {34, 99, 200, 499, 1000, 1100, 2001, 3000, 3004, 3006, 4001, 5000, 5221, 10001})
      for (const std::string line : {"#{}=1\n", "#100=#{}\n", "G1 X#{} F100.\n", "G1 X[#{}+1] F100.\n"}) {
        const std::string refused = executed(d, fmt::format(fmt::runtime(line), n)).refused;
        EXPECT_TRUE(holds(refused, fmt::format("#{} is a variable of the control", n))) << d << line << refused;
      }
    for (const int n : {1, 33, 100, 199, 500, 999})
      EXPECT_EQ(executed(d, fmt::format("#{}=1\n", n) + cut(d)).refused, "") << d << n;
    for (const char* name : {"POPEN", "DPRNT[X]", "SETVN 100[A]"})
      EXPECT_TRUE(holds(executed(d, std::string(name) + "\n").refused, " is not in the subset")) << d << name;
  }
}

// A tool call puts the radius of the tool in Q108, whatever the program wrote there.
TEST(HandWords, HeidenhainFillsItsOwnParameters) {
  for (const int n : {100, 108, 114, 199})
    for (const char* form : {"Q{} = +1\n", "FN 0: Q{} = +1\n"}) {
      const std::string refused = executed("heidenhain", fmt::format(fmt::runtime(form), n)).refused;
      EXPECT_TRUE(holds(refused, fmt::format("Q{} belongs to the control", n))) << refused;
    }
  for (const int n : {1, 99, 200, 1999})
    EXPECT_EQ(executed("heidenhain", fmt::format("Q{} = +1\n", n) + cut("heidenhain")).refused, "") << n;
}

// LinuxCNC's own interpreter goes where our reader says, move by move, and waits as long.
TEST(HandWords, LinuxCncAgrees) {
  const std::string body =
      "G4 P1.5\nM9 M5\nM3 M8\nM1\n#<a b>=6\n#1=2\n#1=5 #<_g>=#1\nG1 X#<AB> F100\nG1 Y[#<_g>+#1] F100\no9 sub\n"
      "#<ab>=[#1*#<_g>]\nG1 X#<ab> F100\no9 endsub\no9 call [3.5]\nG1 Y#<ab> F100\n/M0\nG91 G28 Z7.5\nG90\nG30 Z400\n"
      "G28 X1 Y2\nG30 A5\n";
  machines::Machine m = machine_with("linuxcnc");
  const auto control = controls::control_of(m, standing(), tools());
  const std::string text = whole("linuxcnc", body);
  std::vector<ExecutedMove> ours;
  const auto s = readback::execute_nc(text, "p", *control, [&](const ExecutedMove& e) { ours.push_back(e); });
  ASSERT_TRUE(s) << s.error().text();
  // The interpreter has no offsets and lengths: its words are joints less 3, -2 and 95. Its positions are stored by
  // G28.1 and G30.1 where it stands.
  std::string theirs = "G21 G90\nG0 X7 Y22 Z385 A0 C0\nG28.1\nG0 X-303 Y252 Z415 A-30 C90\nG30.1\n";
  const std::size_t stored = 2;
  const auto out = interpret(theirs + text, "hand_words");
  ASSERT_EQ(out.exit, 0) << out.messages;
  const std::regex motion(
      "STRAIGHT_(FEED|TRAVERSE)\\(([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\\)");
  std::size_t i = 0, seen = 0, waits = 0, stops = 0;
  for (const auto& l : out.lines) {
    waits += holds(l, "DWELL(1.5") ? 1 : 0;
    stops += holds(l, "PROGRAM_STOP") ? 1 : 0;
    std::smatch match;
    if (!std::regex_search(l, match, motion) || seen++ < stored) continue;
    ASSERT_LT(i, ours.size()) << l;
    const ExecutedMove& e = ours[i++];
    EXPECT_EQ(e.rapid, match[1] == "TRAVERSE") << l;
    if (!e.known || e.line < 17) continue;
    EXPECT_NEAR(e.joints[0] - 3, std::stod(match[2]), 6e-5) << l;
    EXPECT_NEAR(e.joints[1] + 2, std::stod(match[3]), 6e-5) << l;
    EXPECT_NEAR(e.joints[2] - 95, std::stod(match[4]), 6e-5) << l;
    EXPECT_NEAR(e.joints[4], std::stod(match[5]), 6e-5) << l;
    EXPECT_NEAR(e.joints[3], std::stod(match[7]), 6e-5) << l;
  }
  EXPECT_EQ(i, ours.size());
  EXPECT_EQ(waits, 1U);
  EXPECT_GE(stops, 1U);
}

TEST(HandWords, ReferencePositionsOfTheMachineFileAreJudged) {
  const auto complaint = [](const char* dialect, std::vector<double> place) {
    machines::Machine m = with_dialect(trunnion(), dialect);
    m.post.reference_positions[0] = std::move(place);
    const auto errors = controls::judge(m);
    return errors.empty() ? std::string() : errors.front().message;
  };
  EXPECT_EQ(complaint("fanuc", {0, 0, 500, 0, 0}), "");
  EXPECT_EQ(complaint("fanuc", {0, 0, 500}),
            "post.reference_position has 3 numbers, must have 5: X Y Z and the rotaries");
  EXPECT_EQ(complaint("fanuc", {0, 0, 601, 0, 0}),
            "post.reference_position: Z = 601 is outside its travel, -900 to 600");
}

}  // namespace
}  // namespace toothpath::test::hand
