// Paths that nobody should ask for, each with its exact message or handled as said: checklist of bad inputs 74, 76, 77
// and 79 to 87. First as paths given to the axis program, then as program text where a file can bring them.
#include <gtest/gtest.h>

#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

/// "" where the path is posted, else the message.
std::string message_of(const path::ClPath& path, const machines::Machine& machine = trunnion(), int teeth = 1) {
  const auto program = axis_program({path}, machine, standing(), teeth);
  return program ? "" : program.error().message;
}

/// A path that feeds along these tips and axes, entered and left vertically above the clearance body.
path::ClPath path_along(const std::vector<std::pair<Vec3, Vec3>>& poses) {
  path::ClPath path;
  path.operation_type = "finishing";
  path.spindle_rpm = 12000;
  const auto& [first, first_axis] = poses.front();
  const auto& [last, last_axis] = poses.back();
  const auto above = [](const Vec3& tip, const Vec3& axis) {
    return Vec3(tip + (30 - tip.z()) / std::max(0.1, axis.z()) * axis);
  };
  path.records.push_back({above(first, first_axis), first_axis, 0, path::MoveKind::rapid, 0, 0});
  for (const auto& [tip, axis] : poses) path.records.push_back({tip, axis, 500, path::MoveKind::feed, 0, 0});
  path.records.push_back({above(last, last_axis), last_axis, 500, path::MoveKind::retract, 0, 0});
  return path;
}

const Vec3 kUp = Vec3::UnitZ();

TEST(PathFaults, Nr79ToolAxisOfNoLength) {
  path::ClPath path = sample_path(0.3, 0);
  path.records[5].axis = Vec3::Zero();
  EXPECT_EQ(message_of(path), "operation 0 record 5: tool axis has length 0.000000000000, not 1");
}

TEST(PathFaults, Nr80ToolAxisThatIsNoUnitVector) {
  path::ClPath path = sample_path(0.3, 0);
  path.records[5].axis *= 1.00000001;
  EXPECT_EQ(message_of(path), "operation 0 record 5: tool axis has length 1.000000010000, not 1");
  path.records[5].axis = Vec3(std::nan(""), 0, 1);
  EXPECT_EQ(message_of(path), "operation 0 record 5: position is not a number below 1e5 mm");
}

// Points that repeat are posted; every block still takes time, and the records behind them are met.
TEST(PathFaults, Nr81RepeatedPoints) {
  const path::ClPath path = path_along(
      {{{100, 0, -1}, kUp}, {{101, 0, -1}, kUp}, {{101, 0, -1}, kUp}, {{101, 0, -1}, kUp}, {{102, 0, -1}, kUp}});
  const auto program = axis_program({path}, trunnion(), standing(), 3);
  ASSERT_TRUE(program) << program.error().message;
  for (const auto& b : program->operations[0].teeth[0].blocks)
    if (b.kind == joints::BlockKind::feed) { EXPECT_GE(b.minutes * 60000, trunnion().min_block_ms * 0.999999); }
  const auto setup = standing();
  const auto text = nc_text({path}, trunnion(), setup, 3);
  ASSERT_TRUE(text) << text.error().message;
  const auto control = controls::control_of(trunnion(), setup, tools());
  const auto back = readback::read_back(text->text, "p", *control, trunnion(), setup, {.teeth = 3});
  ASSERT_TRUE(back) << back.error().text();
  const auto motions =
      readback::tool_motions(back->operations[0], back->copies, *control, trunnion(), setup, 3, {1e-3, 1e-3});
  ASSERT_TRUE(motions);
  const path::ClPath* asked[] = {&path};
  const auto met = readback::compare_with_cl(*motions, asked, 1e-3, 1e-3);
  EXPECT_TRUE(met.complete) << met.message;
}

TEST(PathFaults, Nr82SinglePoint) {
  path::ClPath path = sample_path(0.3, 0);
  path.records.resize(1);  // a rapid alone: nothing is cut, nothing is wrong
  EXPECT_EQ(message_of(path), "");
  path.records[0].kind = path::MoveKind::feed;
  path.records[0].feed_mm_min = 500;
  EXPECT_EQ(message_of(path), "operation 0: the path does not begin with a rapid");
}

TEST(PathFaults, Nr83NoPoint) {
  path::ClPath path = sample_path(0.3, 0);
  path.records.clear();
  EXPECT_EQ(message_of(path), "operation 0: the path has no records");
  const auto none = axis_program(std::vector<path::ClPath>{}, trunnion(), standing(), 3);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "there is no operation to post");
}

// Written out, 5000 records times 20000 teeth are 1e8 blocks of 100 bytes: refused by their number, before any is made.
TEST(PathFaults, Nr84HundredMillionPoints) {
  path::ClPath path = sample_path(0.3, 0);
  const path::ClRecord middle = path.records[5];
  path.records.insert(path.records.begin() + 5, 5000 - path.records.size(), middle);
  const auto program = axis_program({path}, trunnion(), standing(), 20000, true);
  ASSERT_FALSE(program);
  EXPECT_EQ(
      program.error().message,
      "the program would have at least 100000000 blocks (5000 records, 20000 teeth written out), more than 20000000");
}

const std::string kThroughThePole =
    "operation 0 record 2: the tool axis passes the pole at 0.0000 deg, C turns by 180.000 deg in one block, limit 30: "
    "post.pole = \"slow\", \"hold\", \"through\" or \"retract\" goes past it, or mount the part inclined";

// From one side of the gear to the other within one step: no control could follow the axis in between.
TEST(PathFaults, Nr85AxisThatFlips) {
  EXPECT_EQ(message_of(path_along({{{100, 0, -1}, kUp}, {{101, 0, -1}, -kUp}})),
            "operation 0 record 2: A turns by 180.000 deg in one block, limit 170");
  EXPECT_EQ(message_of(path_along({{{100, 0, -1}, leaning(0.4, 0)}, {{101, 0, -1}, leaning(0.4, kPi)}})),
            kThroughThePole);
}

TEST(PathFaults, Nr86ExactlyThroughThePole) {
  const path::ClPath path =
      path_along({{{100, 0, -1}, leaning(0.1, 0.3)}, {{101, 0, -1}, kUp}, {{102, 0, -1}, leaning(0.1, 0.3 + kPi)}});
  EXPECT_EQ(message_of(path), kThroughThePole);
}

TEST(PathFaults, Nr87StepsOfANanometreAndOfTenMetres) {
  // A nanometre is nothing in the words of the program: blocks without way are no blocks without time.
  std::vector<std::pair<Vec3, Vec3>> crawl;
  for (int i = 0; i < 200; ++i) crawl.push_back({Vec3(100 + 1e-6 * i, 0, -1), kUp});
  const auto program = axis_program({path_along(crawl)}, trunnion(), standing(), 1);
  ASSERT_TRUE(program) << program.error().message;
  for (const auto& b : program->operations[0].teeth[0].blocks)
    if (b.kind == joints::BlockKind::feed) { EXPECT_GT(b.minutes, 0); }
  EXPECT_EQ(message_of(path_along({{{100, 0, -1}, kUp}, {{10100, 0, -1}, kUp}})),
            "operation 0 record 2 (tooth 0): X = 10103.0000 mm exceeds 899.9000; "
            "operation 0 record 3 (tooth 0): X = 10103.0000 mm exceeds 899.9000 (no shift of the set-up alone fits)");
  EXPECT_EQ(message_of(path_along({{{100, 0, -1}, kUp}, {{100001, 0, -1}, kUp}})),
            "operation 0 record 2: position is not a number below 1e5 mm");
}

// 74, 76: no pose inside the limits, and a part where the travels do not go.
TEST(MachineFaults, Nr74NoSolutionForAnyPoint) {
  machines::Machine m = trunnion();
  m.chain.table[1].min_rad = radians(20);
  m.chain.table[1].max_rad = radians(30);
  EXPECT_EQ(message_of(path_along({{{100, 0, -1}, kUp}, {{101, 0, -1}, kUp}}), m),
            "operation 0 records 0 to 3: A = 0.0000 .. 0.0000 deg outside [20.0100, 29.9900]");
}

TEST(MachineFaults, Nr76PartOutOfReach) {
  machines::Machine m = trunnion();
  m.chain.linear[0] = {-50, 50, 30000};
  const std::string message = message_of(path_along({{{100, 0, -1}, kUp}, {{101, 0, -1}, kUp}}), m);
  const std::string expected =
      "operation 0 record 0 (tooth 0): X = 103.0000 mm exceeds 49.9000; operation 0 record 1 (tooth 0): X = 103.0000 "
      "mm exceeds 49.9000; operation 0 record 2 (tooth 0): X = 104.0000 mm exceeds 49.9000; and 2 more (set-up origin "
      "X "
      "-54.1000 fits)";
  EXPECT_EQ(message.substr(0, expected.size()),
            expected);  // what may follow: whether another place has room for the part
}

TEST(MachineFaults, Nr77MoreAxesThanTheControlInterpolates) {
  machines::Machine m = trunnion();
  m.max_simultaneous_axes = 4;
  EXPECT_EQ(
      message_of(path_along({{{100, 0, -1}, leaning(0.3, 0.2)}, {{101, 3, -2}, leaning(0.35, 0.25)}}), m),
      "operation 0 record 2: 5 axes move in one block, the control interpolates 4 (keep the tilt fixed in a pass)");
  m.max_simultaneous_axes = 5;
  EXPECT_EQ(message_of(path_along({{{100, 0, -1}, leaning(0.3, 0.2)}, {{101, 3, -2}, leaning(0.35, 0.25)}}), m), "");
}

// As text. APT and the vectors of Siemens and Heidenhain carry tool axes.
std::string read_error(machines::Machine machine, const std::string& dialect, const std::string& text) {
  machine.dialect = dialect;
  machine.tcp = machines::TcpMode::vectors;
  const auto control = controls::control_of(machine, standing(), tools());
  EXPECT_TRUE(control);
  const auto s = readback::execute_nc(text, "p", *control, [](const readback::ExecutedMove&) {});
  return s ? "" : s.error().text();
}

std::string apt_error(const std::string& points) {
  return read_error(trunnion(), "apt",
                    "PARTNO/P\nUNITS/MM\nMULTAX/ON\n$$ OP 0 finishing\nLOADTL/1,LENGTH,95.\nSPINDL/RPM,100,CLW\nRAPID\n"
                    "GOTO/100.,0.,300.,0.,0.,1.\nFEDRAT/500.,MMPM\n" +
                        points + "SPINDL/OFF\nEND\nFINI\n");
}

TEST(PathFaultsInText, AptPoints) {
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,0.,1.\n"), "");
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,0.,0.\n"), "p:10:1: error: a tool vector of length 0.000000");
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,0.,0.999\n"), "p:10:1: error: a tool vector of length 0.999000");
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,nan,1.\n"), "p:10:22: error: number expected");
  EXPECT_EQ(apt_error("GOTO/100.,0.,1e10,0.,0.,1.\n"), "p:10:15: error: , expected");  // no exponents
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,0.,1.\nGOTO/100.,0.,299.,0.,0.,1.\n"),
            "");  // a repeated point takes no time
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,0.,1.\nGOTO/100.000001,0.,299.,0.,0.,1.\n"), "");
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,0.,1.\nGOTO/101.,0.,299.,0.,0.,-1.\n"),
            "p:11:1: error: the tool axis turns by 180.0000 deg in one block, limit 170: which way is not said");
  EXPECT_EQ(apt_error("GOTO/100.,0.,299.,0.,0.,1.\nGOTO/101.,0.,299.,0.1736482,0.,-0.9848078\n"), "");  // exactly 170
}

// 84 as text: what has to be kept is counted first. A loop that is one tooth turned needs no more than that tooth.
TEST(PathFaultsInText, MovesAreCountedBeforeTheyAreKept) {
  const path::ClPath path = sample_path(0.3, 0, 20);
  const auto control = controls::control_of(trunnion(), standing(), tools());
  ASSERT_TRUE(control);
  const auto error = [&](bool expand, const std::string& from, const std::string& to) -> std::string {
    auto text = nc_text({path}, trunnion(), standing(), 6, expand);
    EXPECT_TRUE(text);
    if (const auto at = text->text.rfind(from); !from.empty() && at != std::string::npos)
      text->text.replace(at, from.size(), to);
    const auto back = readback::read_back(text->text, "p", *control, trunnion(), standing(),
                                          {.teeth = 6, .keep_all = false, .max_kept = 200});
    return back ? "" : back.error().text();
  };
  EXPECT_EQ(error(false, "", ""), "");
  EXPECT_EQ(error(true, "", ""), "");
  const std::string refused = error(true, "\nX", "\nX1");  // another digit before one word of the last tooth
  EXPECT_NE(
      refused.find(" moves would have to be kept, more than 200: the teeth are not turned copies of the first one ("),
      std::string::npos)
      << refused;
  EXPECT_TRUE(refused.starts_with("p:")) << refused;
}

// 84 as text: a loop without end is found where nothing changes, else it costs time up to the stated number of blocks,
// and no memory.
TEST(PathFaultsInText, EndlessLoopsEnd) {
  const auto control = *controls::control_of(trunnion(), standing(), tools());
  EXPECT_EQ(control.max_steps, 50'000'000u);
  EXPECT_EQ(control.max_idle, 2'000'000u);
  const std::string start = "G21 G17 G90 G94 G40 G49 G80\nG54\nG53 G0 Z500\n";
  const auto refusal = [&](const std::string& body, std::size_t steps, std::size_t idle) {
    readback::NcControl c = control;
    c.max_steps = steps;
    c.max_idle = idle;
    const auto s = readback::execute_nc(start + body + "M2\n", "p", c, [](const readback::ExecutedMove&) {});
    return s ? std::string("none") : s.error().text();
  };
  const std::size_t many = 1'000'000'000'000;  // no help: what follows is found by itself
  struct Loop {
    std::string body, words;
  };
  for (const Loop& c : {
           Loop{"o1 while [1]\no1 endwhile\n", "p:4:1: error: o1: the loop never ends: after 1 turns"},
           Loop{"#1=0\no1 while [#1 LT 5]\nG0 X1\nG0 X2\no1 endwhile\n", "p:5:1: error: o1: the loop never ends"},
           Loop{"#1=0\no1 while [#1 LT 5]\n#1=[#1+0]\no1 endwhile\n", "never ends"},
           Loop{"#1=0\no1 while [#1 LT 5]\n#1=[1-#1]\nG0 X#1\no1 endwhile\n", "never ends"},
           Loop{"#1=0\no1 while [#1 GE 0]\n#1=[[#1+1] MOD 1000]\no1 endwhile\n", "never ends"},
           Loop{"o9 sub\nG0 X#1\no9 endsub\n#40=1\no1 while [#40]\no9 call [2]\no9 call [3]\no1 endwhile\n",
                "never ends"},
           Loop{"#1=0\no1 while [#1 LT 5]\n#2=0\no2 while [#2 LT 1]\no2 endwhile\no1 endwhile\n",
                "o2: the loop never ends"},
       })
    EXPECT_NE(refusal(c.body, many, many).find(c.words), std::string::npos) << c.body << refusal(c.body, many, many);
  for (const std::string& good : {
           std::string("#1=0\no1 while [#1 LT 3000]\n#1=[#1+1]\no1 endwhile\n"),
           std::string(
               "#1=0\no1 while [#1 LT 3]\n#2=0\no2 while [#2 LT 3]\n#2=[#2+1]\no2 endwhile\n#1=[#1+1]\no1 endwhile\n"),
           std::string("#1=0\n#3=0\no1 while [#3 LT 9]\n#1=[1-#1]\n#3=[#3+1]\no1 endwhile\n"),
           std::string("o1 repeat [5000]\nG0 X1\no1 endrepeat\n"),
       })
    EXPECT_EQ(refusal(good, many, many), "none") << good;
  const std::string counts = "#1=0\no1 while [#1 LT 100000000]\n#1=[#1+1]\no1 endwhile\n",
                    moves = "#1=0\no1 while [#1 LT 100000000]\n#1=[#1+1]\nG0 X[#1/1000000]\no1 endwhile\n";
  EXPECT_NE(refusal(counts, 100'000, many).find("more than 100000 executed blocks"), std::string::npos);
  EXPECT_NE(refusal(counts, many, 100'000).find("more than 100000 executed blocks in a row without a move"),
            std::string::npos);
  EXPECT_NE(refusal(moves, 100'000, 1000).find("more than 100000 executed blocks"), std::string::npos);
}

// A loop that moves and counts upwards for ever is no cycle and never stands still: its text bounds it.
TEST(PathFaultsInText, AShortTextExecutesFewBlocks) {
  const auto control = *controls::control_of(trunnion(), standing(), tools());
  const std::string start = "G21 G17 G90 G94 G40 G49 G80\nG54\nG53 G0 Z500\n";
  const auto moves = [&](const std::string& body, std::string& refused) {
    std::size_t n = 0;
    const auto s =
        readback::execute_nc(start + body + "M2\n", "p", control, [&](const readback::ExecutedMove&) { ++n; });
    refused = s ? "" : s.error().text();
    return n;
  };
  std::string refused;
  EXPECT_EQ(moves("#9=0\no1 while [#9 GE 0]\n#9=[#9+1]\nG0 X[104+#9/1000000]\no1 endwhile\n", refused), 100'002u);
  EXPECT_EQ(refused, "p:8:1: error: the loop has turned more than 100000 times: a loop without end");
  EXPECT_LT(moves("o1 repeat [90000]\no2 repeat [90000]\nG0 X1\no2 endrepeat\no1 endrepeat\n", refused), 200'000u);
  EXPECT_EQ(refused, "p:7:1: error: the loop has turned more than 100000 times: a loop without end");
  std::string calls = "o1 sub\nG0 X1\no1 endsub\n";  // deep calls without a loop
  for (int level = 2; level < 8; ++level) {
    calls += fmt::format("o{} sub\n", level);
    for (int i = 0; i < 20; ++i) calls += fmt::format("o{} call\n", level - 1);
    calls += fmt::format("o{} endsub\n", level);
  }
  EXPECT_LT(moves(calls + "o7 call\n", refused), 2'000'000u);
  EXPECT_TRUE(refused.ends_with(
      "error: more than 2000000 executed blocks, the most for a program of this length: a loop without end"))
      << refused;
  EXPECT_EQ(moves("#9=0\no1 while [#9 LT 90000]\n#9=[#9+1]\nG0 X[104+#9/1000000]\no1 endwhile\n", refused), 90'001u);
  EXPECT_EQ(refused, "");
  std::string space;  // a long text whose lines are executed once a tooth, for the most teeth a job may have
  for (int i = 0; i < 3000; ++i) space += fmt::format("G0 X{}\n", 200 + i % 2);
  EXPECT_EQ(moves("o1 repeat [1000]\n" + space + "o1 endrepeat\n", refused), 3'000'001u);
  EXPECT_EQ(refused, "");
}

TEST(PathFaultsInText, LoopsThatMoveForEverEndInOtherDialectsToo) {
  const std::pair<const char*, std::string> cases[] = {
      {"siemens", "G17 G710 G90 G94\nTRAFOOF\nFOR R1=0 TO 999999999\nSUPA G0 X=R1/10000000\nENDFOR\nM30\n"},
      {"heidenhain",
       "0 BEGIN PGM P MM\n1 Q1 = 0\n2 LBL 1\n3 Q1 = Q1 + 1\n4 L X+Q1 R0 FMAX M91\n5 FN 12: IF +Q1 LT +999999999 "
       "GOTO LBL 1\n6 M30\n7 END PGM P MM\n"},
      {"heidenhain", "0 BEGIN PGM P MM\n1 LBL 1\n2 L X+1 R0 FMAX M91\n3 CALL LBL 1 REP999999\n4 M30\n5 END PGM P MM\n"},
  };
  for (const auto& [dialect, text] : cases) {
    machines::Machine m = trunnion();
    m.dialect = dialect;
    m.tcp = machines::TcpMode::vectors;
    std::size_t n = 0;
    const auto s = readback::execute_nc(text, "p", *controls::control_of(m, standing(), tools()),
                                        [&](const readback::ExecutedMove&) { ++n; });
    ASSERT_FALSE(s) << dialect;
    EXPECT_TRUE(s.error().text().ends_with("error: the loop has turned more than 100000 times: a loop without end"))
        << s.error().text();
    EXPECT_GT(n, 100'000u);
    EXPECT_LT(n, 100'010u);
  }
}

TEST(PathFaultsInText, OtherDialectsEndToo) {
  const std::pair<const char*, std::string> cases[] = {
      {"siemens", "R2=0\nFOR R1=0 TO 999999999\nR2=R2+1\nENDFOR\nM30\n"},
      {"heidenhain",
       "0 BEGIN PGM P MM\n1 Q1 = 0\n2 LBL 1\n3 Q1 = Q1 + 0\n4 FN 12: IF +Q1 LT +6 GOTO LBL 1\n5 M30\n6 END PGM P MM\n"},
  };
  for (const auto& [dialect, text] : cases) {
    machines::Machine m = trunnion();
    m.dialect = dialect;
    m.tcp = machines::TcpMode::vectors;
    auto control = *controls::control_of(m, standing(), tools());
    control.max_idle = 50'000;
    const auto s = readback::execute_nc(text, "p", control, [](const readback::ExecutedMove&) {});
    ASSERT_FALSE(s) << dialect;
    EXPECT_NE(s.error().text().find("more than 50000 executed blocks in a row without a move"), std::string::npos)
        << s.error().text();
    control.max_steps = 20'000;
    const auto steps = readback::execute_nc(text, "p", control, [](const readback::ExecutedMove&) {});
    EXPECT_NE(steps.error().text().find("more than 20000 executed blocks"), std::string::npos) << steps.error().text();
  }
}

// A block of a thousand million minutes is a wrong F.
TEST(PathFaultsInText, ABlockTakesADayAtMost) {
  const auto control = *controls::control_of(trunnion(), standing(), tools());
  const std::string start =
      "G21 G17 G90 G94 G40 G49 G80 G61\nG54\n(OP 0 finishing)\nG53 G0 Z500\nT1 M6\nS100 M3\nG43 H1\nG0 X0 Y0 Z50 A0 "
      "C0\n";
  const auto refusal = [&](const std::string& body) {
    const auto s = readback::execute_nc(start + body + "M5\nM2\n", "p", control, [](const readback::ExecutedMove&) {});
    return s ? std::string("none") : s.error().text();
  };
  EXPECT_EQ(refusal("G1 X144 F0.1\n"), "none");
  EXPECT_NE(refusal("G1 X145 F0.1\n").find("p:9:"), std::string::npos);
  EXPECT_NE(refusal("G1 X145 F0.1\n")
                .find("the block takes 1450 min, more than 1440 (a day), and X goes 0.145 m: is its F right, and is no "
                      "decimal point lost?"),
            std::string::npos)
      << refusal("G1 X145 F0.1\n");
  for (const char* body : {"G1 X1 F0.000000001\n", "G93\nG1 X0 F0.000000001\nG94\n"})
    EXPECT_NE(refusal(body).find("the block takes 1e+09 min"), std::string::npos) << body << refusal(body);
}

}  // namespace
}  // namespace toothpath
