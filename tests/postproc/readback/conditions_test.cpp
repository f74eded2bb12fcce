// Feed, speed, tool, coolant and hash of programs that somebody edited, in every dialect: what must be found is, what
// is harmless passes. What is what is told by an oracle of the test's own: published kinematics of the trunnion, and
// the executed moves with and without the edit.
#include "postproc/readback/conditions.h"

#include <gtest/gtest.h>

#include <random>
#include <regex>
#include <sstream>

#include "postproc/readback/program_hash.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;
using machines::TcpMode;
using readback::ExecutedMove;

constexpr double kAskedFeed = 800, kAskedSpeed = 12000;
constexpr int kFewTeeth = 3;

readback::AskedConditions asked_of_job() { return {{{1, kAskedSpeed, kAskedFeed}}, machines::Coolant::flood}; }

struct Judged {
  std::string refused;  ///< by the reader
  readback::ConditionsFound found;
  std::vector<ExecutedMove> moves;
};

Judged judged(const std::string& text, const machines::Machine& m,
              const readback::AskedConditions& asked = asked_of_job()) {
  const auto control = control_of(m, standing(), tools());
  EXPECT_TRUE(control) << control.error().message;
  Judged out;
  readback::ConditionJudge judge(m, *control, asked);
  const auto status = readback::execute_nc(text, "p", *control, [&](const ExecutedMove& move) {
    judge.add(move);
    out.moves.push_back(move);
  });
  if (!status) out.refused = status.error().text();
  out.found = judge.finish();
  return out;
}

std::string all_of(const std::vector<std::string>& texts) {
  std::string out;
  for (const auto& t : texts) out += t + "\n";
  return out;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}
std::string joined(const std::vector<std::string>& lines) {
  std::string out;
  for (const auto& l : lines) out += l + "\n";
  return out;
}

/// Tip and tool axis in the table frame.
TrunnionPose pose_of(const ExecutedMove& m, const machines::Machine& machine) {
  const double c = -machine.chain.table[0].sign * m.joints[3];
  return trunnion_forward(kTrunnion, m.joints[0], m.joints[1], m.joints[2], m.joints[4], c, m.tool == 2 ? 90.25 : 95.0);
}

/// The worst that the moves of an edited program do; moves that last as long as before the edit do nothing.
struct Deeds {
  bool changed = false;
  double sideways = 0, down = 0, any = 0;  ///< mm/min
  double linear = 0, c = 0, a = 0;         ///< mm/min, deg/min
};
Deeds deeds_of(const std::vector<ExecutedMove>& before, const std::vector<ExecutedMove>& after,
               const machines::Machine& machine) {
  Deeds d;
  EXPECT_EQ(before.size(), after.size());
  for (std::size_t i = 1; i < after.size() && i < before.size(); ++i) {
    const ExecutedMove &m = after[i], &from = after[i - 1];
    if (m.rapid || !m.known || !from.known || m.minutes == before[i].minutes) continue;
    d.changed = true;
    const TrunnionPose p = pose_of(from, machine), q = pose_of(m, machine);
    const Vec3 way = q.tip - p.tip;
    const double speed = way.norm() / m.minutes;
    for (std::size_t k = 0; k < 3; ++k)
      d.linear = std::max(d.linear, std::abs(m.joints[k] - from.joints[k]) / m.minutes);
    d.c = std::max(d.c, std::abs(m.joints[3] - from.joints[3]) / m.minutes);
    d.a = std::max(d.a, std::abs(m.joints[4] - from.joints[4]) / m.minutes);
    if (way.norm() < 1e-6) continue;
    d.any = std::max(d.any, speed);
    const double along = way.dot(q.axis) / way.norm();
    if (along < -0.999) d.down = std::max(d.down, speed);  // the sample comes down to its cut in one move
    else if (along < 0.999) d.sideways = std::max(d.sideways, speed);
  }
  return d;
}

class Conditions : public testing::TestWithParam<PostForm> {
 protected:
  void SetUp() override {
    machine_ = machine_of(GetParam());
    const auto program = program_of(GetParam(), {sample_path(0.3, GetParam().swing, 8)}, kFewTeeth, 1);
    ASSERT_TRUE(program) << program.error().message;
    const auto made = text_of(GetParam(), *program);
    ASSERT_TRUE(made) << made.error().message;
    text_ = made->text;
  }
  /// The first line in which the pattern is found, replaced there.
  [[nodiscard]] std::string edited(const std::string& pattern, const std::string& by) const {
    const std::regex look(pattern);
    std::vector<std::string> lines = lines_of(text_);
    for (auto& line : lines)
      if (std::regex_search(line, look)) {
        line = std::regex_replace(line, look, by);
        return joined(lines);
      }
    ADD_FAILURE() << pattern << " is not in the text";
    return text_;
  }
  [[nodiscard]] bool is(const char* dialect) const { return std::string(GetParam().dialect) == dialect; }

  machines::Machine machine_;
  std::string text_;
};
INSTANTIATE_TEST_SUITE_P(Forms, Conditions, testing::ValuesIn(post_forms()));

TEST_P(Conditions, OurOwnTextsAreClean) {
  const Judged own = judged(text_, machine_);
  EXPECT_EQ(own.refused, "");
  EXPECT_EQ(all_of(own.found.reasons), "");
  EXPECT_EQ(all_of(own.found.warnings), "");
  ASSERT_EQ(own.found.operations.count(0), 1U);
  const auto& o = own.found.operations.at(0);
  EXPECT_EQ(o.tool, 1);
  EXPECT_EQ(o.greatest_rpm.value, kAskedSpeed);
  EXPECT_GT(o.cut_mm_min.value, 0.5 * kAskedFeed);
  EXPECT_LT(o.cut_mm_min.value, 1.05 * kAskedFeed);
  const auto hash = readback::hash_of_program(text_);
  ASSERT_TRUE(hash);
  EXPECT_TRUE(hash->fits());
}

/// A program with one F changed, and what was changed.
struct FeedEdit {
  std::string text, told;
};

/// F of some lines ten and a hundred times as great; and such an F in some lines that have none.
std::vector<FeedEdit> raised_feeds(const std::string& text, bool apt) {
  const std::regex feed(R"((^| )F([0-9]+\.?[0-9]*)( |$)|FEDRAT/([0-9.]+))");
  const std::regex bare(apt ? R"(^GOTO/.*)" : R"(^[^(;]*[XYZ]=?[+-]?[0-9][^F]*$)");
  const std::vector<std::string> lines = lines_of(text);
  std::vector<std::size_t> with, without;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (std::regex_search(lines[i], feed)) with.push_back(i);
    else if (std::regex_match(lines[i], bare)) without.push_back(i);
  }
  std::mt19937 random(18);
  std::vector<FeedEdit> out;
  for (auto* places : {&with, &without}) {
    std::shuffle(places->begin(), places->end(), random);
    places->resize(std::min<std::size_t>(places->size(), 10));
    for (const std::size_t place : *places)
      for (const double factor : {10.0, 100.0}) {
        std::vector<std::string> changed = lines;
        std::string& line = changed[place];
        std::smatch word;
        if (std::regex_search(lines[place], word, feed)) {
          const std::size_t group = word[4].matched ? 4 : 2;
          line.replace(static_cast<std::size_t>(word.position(group)), static_cast<std::size_t>(word.length(group)),
                       fmt::format("{:.6f}", std::stod(word[group]) * factor));
        } else if (apt) {
          line = fmt::format("FEDRAT/{:.6f},MMPM\n", factor * kAskedFeed) + line;
        } else {
          line += fmt::format(" F{:.3f}", factor * kAskedFeed);
        }
        out.push_back({joined(changed), fmt::format("line {}: {} -> {}", place + 1, lines[place], line)});
      }
  }
  return out;
}

TEST_P(Conditions, FeedsThatSomebodyRaised) {
  const Judged own = judged(text_, machine_);
  const double c_most = degrees(machine_.chain.table[0].max_speed), a_most = degrees(machine_.chain.table[1].max_speed);
  int dangerous = 0, harmless = 0;
  for (const FeedEdit& edit : raised_feeds(text_, is("apt"))) {
    SCOPED_TRACE(edit.told);
    const Judged now = judged(edit.text, machine_);
    if (!now.refused.empty()) continue;  // F in a rapid of its own kind: not read
    const Deeds d = deeds_of(own.moves, now.moves, machine_);
    const auto beyond = [&](double share) {
      return d.sideways > 2 * share * kAskedFeed || d.down > 2 * share * kAskedFeed ||
             d.any > share * machine_.max_cutting_feed || d.c > share * c_most || d.a > share * a_most ||
             d.linear > share * machine_.chain.linear[0].max_speed;
    };
    if (beyond(1.02)) {
      ++dangerous;
      EXPECT_NE(all_of(now.found.reasons), "");
    }
    if (!beyond(0.9)) {
      ++harmless;
      EXPECT_EQ(all_of(now.found.reasons), "");
    }
    for (const std::string& reason : now.found.reasons) EXPECT_TRUE(reason.starts_with("line ")) << reason;
    const auto hash = readback::hash_of_program(edit.text);
    EXPECT_TRUE(hash && !hash->fits());
  }
  EXPECT_GE(dangerous, 4);
  RecordProperty("harmless", harmless);
}

TEST_P(Conditions, SpindleSpeeds) {
  const std::string pattern = is("apt") ? "RPM,12000" : "S12000", word = is("apt") ? "RPM," : "S";
  const auto with = [&](const char* speed) { return judged(edited(pattern, word + speed), machine_).found; };
  EXPECT_NE(all_of(with("30000").reasons).find("above spindle.max_speed = 24000"), std::string::npos);
  EXPECT_NE(all_of(with("20000").reasons).find("S 20000, the job says 12000"), std::string::npos);
  EXPECT_NE(all_of(with("6000").reasons).find("S 6000, the job says 12000"), std::string::npos);
  const auto near = with("13000");
  EXPECT_EQ(all_of(near.reasons), "");
  EXPECT_NE(all_of(near.warnings).find("S 13000, the job says 12000"), std::string::npos);
  EXPECT_EQ(all_of(with("12000").warnings), "");
}

TEST_P(Conditions, AStandingSpindleCutsNothing) {
  const std::string text = is("apt") ? edited("^SPINDL/RPM.*$", "$$$$ NO SPINDLE") : edited("M3$", "M5");
  EXPECT_NE(judged(text, machine_).refused.find("G1 while the spindle stands"), std::string::npos)
      << text.substr(0, 900);
}

TEST_P(Conditions, AnotherToolThanTheJobs) {
  std::string text;
  if (is("heidenhain")) text = edited("TOOL CALL 1", "TOOL CALL 2");
  else if (is("siemens")) text = edited("T=\"T1\"", "T=\"T2\"");
  else if (is("apt")) text = edited("LOADTL/1,LENGTH,95\\.?0*", "LOADTL/2,LENGTH,90.25");
  else {
    // The length of the one with the body of the other cuts nothing.
    text = edited("T1 M6", "T2 M6");
    EXPECT_NE(judged(text, machine_).refused.find("with the length of tool 1 while tool 2 is in the spindle"),
              std::string::npos);
    text = std::regex_replace(text, std::regex("H1( |\n)"), "H2$1");
  }
  const Judged now = judged(text, machine_);
  EXPECT_EQ(now.refused, "");
  EXPECT_NE(all_of(now.found.reasons).find("cuts with T2, the job says T1"), std::string::npos)
      << all_of(now.found.reasons);
}

TEST_P(Conditions, CoolantOfTheJob) {
  const std::string off = is("apt") ? edited("COOLNT/FLOOD", "COOLNT/OFF") : edited("M8$", "M9");
  EXPECT_NE(all_of(judged(off, machine_).found.reasons).find("cuts without flood, the coolant of the job"),
            std::string::npos);
  readback::AskedConditions dry = asked_of_job();
  dry.coolant = machines::Coolant::off;
  const auto wet = judged(text_, machine_, dry).found;
  EXPECT_EQ(all_of(wet.reasons), "");
  EXPECT_NE(all_of(wet.warnings).find("cuts with flood on, the coolant of the job is off"), std::string::npos);
  dry.coolant.reset();  // the job does not say
  EXPECT_EQ(all_of(judged(off, machine_, dry).found.reasons), "");
  EXPECT_EQ(all_of(judged(text_, machine_, dry).found.warnings), "");
}

TEST_P(Conditions, LimitsOfTheMachineFile) {
  machines::Machine slow = machine_;
  slow.max_cutting_feed = 0.5 * kAskedFeed;
  EXPECT_NE(all_of(judged(text_, slow).found.reasons).find("above limits.cutting_feed = 400"), std::string::npos);
  slow = machine_;
  slow.chain.linear[0].max_speed = 100;
  EXPECT_NE(all_of(judged(text_, slow).found.reasons).find("asks X for "), std::string::npos);
  slow = machine_;
  slow.min_block_ms = 1000;
  const auto starved = judged(text_, slow).found;
  EXPECT_EQ(all_of(starved.reasons), "");
  EXPECT_NE(all_of(starved.warnings).find("(limits.min_block_ms)"), std::string::npos);
  readback::AskedConditions gentle = asked_of_job();
  gentle.operations[0].feed_mm_min = 0.6 * kAskedFeed;  // the text is 1.67 times as fast
  const auto told = judged(text_, machine_, gentle).found;
  EXPECT_EQ(all_of(told.reasons), "");
  EXPECT_NE(all_of(told.warnings).find("times the 480 of the job"), std::string::npos);
  machines::Machine strict = machine_;
  strict.feed_factor = 1.2;
  EXPECT_NE(all_of(judged(text_, strict, gentle).found.reasons).find("limit 1.2 times"), std::string::npos);
  strict = machine_;
  strict.speed_factor = 3;
  gentle = asked_of_job();
  gentle.operations[0].speed_rpm = 0.5 * kAskedSpeed;
  EXPECT_EQ(all_of(judged(text_, strict, gentle).found.reasons), "");
}

// Comments at the top, carriage returns and other block numbers change nothing that is executed.
TEST_P(Conditions, TheHashIsThatOfTheBlocks) {
  std::string windows;
  for (const char c : text_) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_TRUE(readback::hash_of_program(windows)->fits());
  std::vector<std::string> lines = lines_of(text_);
  const auto hash = readback::hash_of_program(text_);
  ASSERT_GT(hash->end_line, hash->line + 10);
  std::vector<std::string> half(lines.begin(), lines.begin() + hash->end_line - 5);
  EXPECT_FALSE(readback::hash_of_program(joined(half))->fits()) << "the end is missing";
  std::vector<std::string> less = lines;
  less.erase(less.begin() + (hash->line + hash->end_line) / 2);
  EXPECT_FALSE(readback::hash_of_program(joined(less))->fits());
  std::vector<std::string> named = lines;
  named[static_cast<std::size_t>(hash->line)] += " ";
  EXPECT_TRUE(readback::hash_of_program(joined(named))->fits()) << "a comment at the top";
}

TEST(ProgramHash, NoneWhereNobodyMadeOne) {
  EXPECT_FALSE(readback::hash_of_program("G21\nG1 X1 F2\n"));
  EXPECT_FALSE(readback::hash_of_program(""));
  EXPECT_FALSE(readback::hash_of_program("(HASH)\n(HASH 12)\n(HASH QQQQQQQQQQQQQQQQ)\n"));
}

// A link may be quick where it goes out of the work and in again, the cut that follows may not: whatever F stands
// where.
TEST(ConditionJudge, LinksAreQuickCutsAreNot) {
  machines::Machine m = trunnion();
  const auto text = [](const char* lift, const char* across, const char* down, const char* cut) {
    return fmt::format(
        "G21 G17 G90 G94 G40 G49 G80\nG54\nG61\nG53 G0 Z600\nT1 M6\n(OP 0 finishing)\nS12000 M3\nG43 H1\n"
        "G0 A0 C0\nG0 X100 Y0\nG0 Z200\n"
        "G1 Z150 F800\nX110\nZ151 {}\nX115 {}\nZ150 {}\nX120 {}\nZ160 F6000\nM5\nG53 G0 Z600\nG49\nM2\n",
        lift, across, down, cut);
  };
  readback::AskedConditions asked{{{1, kAskedSpeed, kAskedFeed}}, {}};
  const auto reasons = [&](const std::string& t) {
    const Judged now = judged(t, m, asked);
    EXPECT_EQ(now.refused, "");
    return all_of(now.found.reasons);
  };
  EXPECT_EQ(reasons(text("F6000", "", "F800", "")), "");
  EXPECT_EQ(reasons(text("", "", "", "")), "");
  EXPECT_NE(reasons(text("F6000", "", "", "F800")).find("line 16: operation 0 goes down to its cut with 6000"),
            std::string::npos);
  EXPECT_NE(reasons(text("F6000", "", "F800", "F8000")).find("line 17: operation 0 cuts with 8000 mm/min, 10 times"),
            std::string::npos);
  EXPECT_NE(reasons(text("F6000", "", "", "")).find("line 17: operation 0 cuts with 6000"), std::string::npos);
  EXPECT_NE(reasons(text("F20000", "", "F800", "")).find("above limits.cutting_feed = 10000"), std::string::npos);
}

// Blocks of a link that are as short as the control takes them are slow, and the link goes on behind them.
TEST(ConditionJudge, ALinkGoesOnBehindItsShortestBlocks) {
  machines::Machine m = trunnion();
  const auto reasons = [&](const char* start, const std::string& across, bool fanuc = false) {
    static const std::regex whole("([XYZAC][0-9]+)(?![.0-9])");  // Fanuc takes places with a point alone
    const std::string text = fmt::format(
        "G21 G17 G90 G94 G40 G49 G80\nG54\nG61\nG53 G0 Z600\nT1 M6\n(OP 0 finishing)\nS12000 M3\nG43 H1\n"
        "G0 A0 C0\nG0 X100 Y0\nG0 Z200\n{}\n{}\nG94\nG1 Z160 F6000\nM5\nG53 G0 Z600\nG49\nM2\n",
        start, across);
    const Judged now = judged(fanuc ? "%\nO1\n" + std::regex_replace(text, whole, "$1.") + "%\n" : text, m,
                              {{{1, kAskedSpeed, kAskedFeed}}, {}});
    EXPECT_EQ(now.refused, "");
    return all_of(now.found.reasons);
  };
  const char *up = "G1 Z150 F800\nX110\nZ151 F6000", *quick_cut = "line 17: operation 0 cuts with 6000";
  const auto across = [](double way, double feed) {  // slow between quick blocks
    return fmt::format("X115 F6000\nX{} F{}\nX120 F6000\nZ150 F800\nX121", 115 + way, feed);
  };
  EXPECT_NE(reasons(up, across(0.05, 500)).find(quick_cut), std::string::npos) << "it could be quicker";
  m.min_block_ms = 6;
  EXPECT_EQ(reasons(up, across(0.05, 500)), "");
  EXPECT_NE(reasons(up, across(0.5, 500)).find(quick_cut), std::string::npos) << "60 ms: somebody wanted it slow";
  EXPECT_NE(reasons("G1 Z150 F800\nX110", across(0.05, 500)).find("cuts with 6000"), std::string::npos) << "no link";
  m = trunnion();
  const auto rotaries = [&](double deg_min) {
    for (machines::RotaryAxis& axis : m.chain.table) axis.max_speed = radians(deg_min);
  };
  const std::string turning = "X115 F6000\nG93\nX115.1 C6 F33.33\nG94\nX120 F6000\nZ150 F800\nX121";
  EXPECT_NE(reasons(up, turning).find("cuts with 6000"), std::string::npos);
  rotaries(200);  // 6 deg take 1.8 s
  EXPECT_EQ(reasons(up, turning), "");
  m = trunnion_with("fanuc", TcpMode::none);
  const std::string largest_f = "G93\nX115 F1200\nX115.05 F9999.999\nX120 F1200\nG94\nZ150 F800\nX121";
  EXPECT_EQ(reasons(up, largest_f, true), "");
  EXPECT_NE(reasons(up, replaced(largest_f, "F9999.999", "F8000"), true).find("cuts with 5940"), std::string::npos);
}

// What a rotary is asked for, as it is executed.
TEST(ConditionJudge, RotariesBeyondTheirSpeed) {
  machines::Machine m = trunnion();
  m.tcp = TcpMode::angles;
  m.post.tcp_on = {"M428"};
  m.post.tcp_off = {"M429"};
  const std::string text =
      "G21 G17 G90 G94 G40 G49 G80\nG54\nG61\nG53 G0 Z600\nT1 M6\n(OP 0 finishing)\nS12000 M3\nG43 H1\n"
      "G0 A0 C0\nG0 X100 Y0\nG0 Z200\nM428\nG1 X100 Y0 Z150 A0 C0 F800\nX100.1 C12 F783\nC20 F94000\nM429\nM5\nG53 G0 "
      "Z600\nG49\nM2\n";
  const Judged now = judged(text, m, {{{1, kAskedSpeed, kAskedFeed}}, {}});
  EXPECT_EQ(now.refused, "");
  const std::string all = all_of(now.found.reasons);
  EXPECT_NE(all.find("asks C for 94000 deg/min in a feed, above its max_speed = 12000 (2 blocks so)"),
            std::string::npos)
      << all;
}

}  // namespace
}  // namespace toothpath
