// Rotaries that the control counts within one turn: words of 0 to 360 deg, the way that each control takes, no step of
// half a turn.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <sstream>

#include "postproc/joints/rollover.h"
#include "postproc/self_test/self_test.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;

constexpr int kRolloverTeeth = 5;

/// Moves of a text; a refusal fails the test.
std::vector<readback::ExecutedMove> executed(const PostForm& f, const std::string& text) {
  const auto control = controls::control_of(machine_of(f), standing(), tools());
  std::vector<readback::ExecutedMove> moves;
  const auto done =
      readback::execute_nc(text, "p", *control, [&](const readback::ExecutedMove& e) { moves.push_back(e); });
  EXPECT_TRUE(done) << done.error().text() << "\n" << text;
  return moves;
}

std::string refusal(const PostForm& f, const std::string& text) {
  const auto control = controls::control_of(machine_of(f), standing(), tools());
  const auto done = readback::execute_nc(text, "p", *control, [](const readback::ExecutedMove&) {});
  return done ? "" : done.error().text();
}

std::string text_of(const PostForm& f, const std::vector<path::ClPath>& paths, int teeth = kRolloverTeeth,
                    int stride = 1) {
  const auto program = program_of(f, paths, teeth, stride);
  EXPECT_TRUE(program) << program.error().message;
  const auto text = program ? text_of(f, *program) : Result<text::NcText>(program.error());
  EXPECT_TRUE(text) << text.error().message;
  return text ? text->text : "";
}

/// A leaning tool whose azimuth goes from `from` by `swing`, so that C does; then a second pass at `second`.
path::ClPath turning_path(double from, double swing, double second, int steps = 12) {
  path::ClPath path = sample_path(0.3, 0, steps);
  std::size_t pass_begin = 0;
  for (std::size_t i = 0; i < path.records.size(); ++i) {
    auto& r = path.records[i];
    if (i > 0 && r.pass != path.records[i - 1].pass) pass_begin = i;
    const double t = std::clamp((static_cast<double>(i - pass_begin) - 1) / steps, 0.0, 1.0);
    const bool out = r.kind == path::MoveKind::rapid || r.kind == path::MoveKind::retract;
    const double lift = out ? 12 / std::cos(0.3) : 0;
    const Vec3 tip = r.tip - lift * r.axis;
    r.axis = leaning(0.3, r.pass == 0 ? from + swing * t : second);
    r.tip = tip + lift * r.axis;
  }
  // The last record stands where the one before it ended.
  path.records.back().tip = path.records[path.records.size() - 2].tip;
  path.records.back().axis = path.records[path.records.size() - 2].axis;
  return path;
}

machines::TablePose pose_of(const machines::Machine& m, const readback::ExecutedMove& e, double length) {
  return m.chain.forward({Vec3(e.joints[0], e.joints[1], e.joints[2]), {radians(e.joints[3]), radians(e.joints[4])}},
                         length);
}

class Rollover : public testing::TestWithParam<PostForm> {};
INSTANTIATE_TEST_SUITE_P(Forms, Rollover, testing::ValuesIn(rollover_forms()));

// The cuts are those of an axis that is counted on and on; no known step reaches half a turn.
TEST_P(Rollover, CutsWhatTheContinuousAxisCuts) {
  const PostForm& f = GetParam();
  machines::Machine endless = machine_of(f);
  endless.chain.table[0].rollover = false;
  endless.chain.table[0].min_rad = -1e6;
  endless.chain.table[0].max_rad = 1e6;
  const std::vector<path::ClPath> paths = {sample_path(0.3, f.swing, 8), sample_path(0.5, f.swing, 6, 1)};
  for (const int stride : {1, 2}) {
    const auto rolled = executed(f, text_of(f, paths, kRolloverTeeth, stride));
    auto dialect = controls::dialect_of(endless);
    joints::AxisOptions o = controls::axis_options(*dialect, endless);
    o.expand_teeth = f.expand;
    o.tooth_stride = stride;
    const auto program =
        joints::AxisProgramTestAccess::build(paths, tools(), standing(), endless, kRolloverTeeth, kBody, o);
    ASSERT_TRUE(program) << program.error().message;
    text::NcHeader header;
    const auto text = text::write_nc(*program, *dialect, header);
    ASSERT_TRUE(text);
    std::vector<readback::ExecutedMove> plain;
    const auto control = controls::control_of(endless, standing(), tools());
    ASSERT_TRUE(
        readback::execute_nc(text->text, "p", *control, [&](const readback::ExecutedMove& e) { plain.push_back(e); }));

    const auto cuts = [](const std::vector<readback::ExecutedMove>& moves) {
      std::vector<const readback::ExecutedMove*> out;
      for (const auto& e : moves)
        if (!e.rapid) out.push_back(&e);
      return out;
    };
    const auto a = cuts(rolled), b = cuts(plain);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      const auto p = pose_of(endless, *a[i], 95), q = pose_of(endless, *b[i], 95);
      ASSERT_LT((p.tip_mm - q.tip_mm).norm(), 1e-6) << i;
      ASSERT_LT((p.axis - q.axis).norm(), 1e-8) << i;
    }
    const bool by_sign = std::string(f.dialect) == "linuxcnc";
    for (std::size_t i = 1; i < rolled.size(); ++i) {
      if (!rolled[i].known || (by_sign && rolled[i].rapid && !f.expand))
        continue;  // a loop is entered by any way there
      ASSERT_LE(std::abs(rolled[i].joints[3] - rolled[i - 1].joints[3]), 170 + 1e-3) << rolled[i].line;
    }
  }
}

// Written rotary words lie within one turn, in the form that the control reads.
TEST_P(Rollover, WordsLieWithinOneTurn) {
  const PostForm& f = GetParam();
  const std::string text = text_of(f, {turning_path(radians(-40), f.swing == 0 ? 0 : radians(80), radians(170))});
  const bool siemens = std::string(f.dialect) == "siemens", by_sign = std::string(f.dialect) == "linuxcnc";
  const std::regex word(siemens ? R"( C=DC\(([-+]?[\d.]+)\))" : R"( C([-+]?[\d.]+))"), any(R"( C=)");
  std::istringstream in(text);
  std::size_t seen = 0;
  for (std::string l; std::getline(in, l);) {
    if (l.find(';') != std::string::npos || l.find('(') == 0) continue;
    if (std::regex_search(l, std::regex("^(N[0-9]+ )?(G52|TRANS) |DEF 7.1"))) continue;  // where words count from
    std::smatch m;
    if (!std::regex_search(l, m, word)) {
      if (siemens && std::regex_search(l, any)) { EXPECT_NE(l.find("DC("), std::string::npos) << l; }
      continue;
    }
    ++seen;
    const double v = std::stod(m[1]);
    EXPECT_LT(std::abs(v), 360) << l;
    if (!by_sign) { EXPECT_GE(v, 0) << l; }
  }
  EXPECT_TRUE(seen > 2 || !f.expand) << text;
  EXPECT_NE(text.find("C ROLLS OVER"), std::string::npos);
}

// A cut through zero, both ways: 350 to 10 and back is 20 deg, on every control, and the tool is where the path wants
// it.
TEST_P(Rollover, StepsAcrossZeroBothWays) {
  const PostForm& f = GetParam();
  if (f.swing == 0) return;  // rotaries stand in the cuts of this form
  const machines::Machine m = machine_of(f);
  for (const double sense : {1.0, -1.0}) {
    // The command of C at azimuth phi of the lean is +-(phi - 90 deg) on this trunnion: 80 to 100 deg passes zero.
    const path::ClPath path = turning_path(radians(90 - sense * 10), radians(sense * 20), radians(90 + sense * 10));
    const std::string text = text_of(f, {path}, 1);
    const auto moves = executed(f, text);
    bool below = false, above = false;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      if (moves[i].rapid) continue;
      ASSERT_LT(std::abs(moves[i].joints[3] - moves[i - 1].joints[3]), 15) << moves[i].line;
      const double place = moves[i].joints[3] - 360 * std::floor(moves[i].joints[3] / 360);
      below = below || place > 340;
      above = above || (place > 1 && place < 20);
    }
    EXPECT_TRUE(below && above) << text;
    const auto control = controls::control_of(m, standing(), tools());
    const auto read = readback::read_back(text, "p", *control, m, standing(), {.teeth = 1});
    ASSERT_TRUE(read) << read.error().text();
    const auto motions =
        readback::tool_motions(read->operations[0], read->copies, *control, m, standing(), 1, {1e-4, 1e-5});
    ASSERT_TRUE(motions);
    const std::vector<const path::ClPath*> want = {&path};
    const auto same = readback::compare_with_cl(*motions, want, 4e-3, 1e-3);
    EXPECT_TRUE(same.complete) << same.message;
  }
}

// A reposition by 180 deg goes in two blocks, so that its way is never left to the control; with TCP too.
TEST_P(Rollover, HalfATurnIsDivided) {
  const PostForm& f = GetParam();
  for (const double second : {180.0, 179.9, -175.0}) {
    const std::string text = text_of(f, {turning_path(radians(90), 0, radians(90 + second))}, 3);
    const auto moves = executed(f, text);
    double turned = 0;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      if (!moves[i].known) continue;
      const double step = std::abs(moves[i].joints[3] - moves[i - 1].joints[3]);
      if (!(std::string(f.dialect) == "linuxcnc" && moves[i].rapid && !f.expand)) {
        EXPECT_LE(step, 170 + 1e-3) << moves[i].line;
      }
      turned = std::max(turned, step);
    }
    EXPECT_GT(turned, 80);
  }
}

// A pass that turns by more than a whole turn goes on and on; an axis with ends of one turn refuses it.
TEST_P(Rollover, APassTurnsOnWithoutEnd) {
  const PostForm& f = GetParam();
  if (f.swing == 0) return;
  const path::ClPath path = turning_path(0, radians(800), 0, 60);
  const auto moves = executed(f, text_of(f, {path}, 1));
  double least = 1e9, greatest = -1e9;
  for (const auto& e : moves)
    if (!e.rapid) least = std::min(least, e.joints[3]), greatest = std::max(greatest, e.joints[3]);
  EXPECT_NEAR(greatest - least, 800, 1e-3);
  machines::Machine ends = machine_of(f);
  ends.chain.table[0].rollover = false;
  ends.chain.table[0].min_rad = 0;
  ends.chain.table[0].max_rad = radians(360);
  EXPECT_FALSE(axis_program({path}, ends, standing(), 1, f.expand));
}

// Faults of each language.
TEST_P(Rollover, PlantedFaultsAreRefused) {
  const PostForm& f = GetParam();
  const std::string dialect = f.dialect;
  const std::string text = text_of(f, {turning_path(radians(60), f.swing == 0 ? 0 : radians(60), radians(90))});
  const auto changed = [&text](const char* pattern, const char* to) {
    return std::regex_replace(text, std::regex(pattern), to, std::regex_constants::format_first_only);
  };
  if (dialect == "siemens") {
    EXPECT_NE(refusal(f, changed(R"(C=DC\()", "C=(")).find("which way it turns is said by DC() alone"),
              std::string::npos);
    EXPECT_NE(refusal(f, changed(R"(C=DC\([^ \n]*\))", "C=DC(360)")).find("outside 0 .. 360"), std::string::npos);
    EXPECT_NE(refusal(f, changed(R"(C=DC\([^ \n]*\))", "C=DC(-0.001)")).find("outside 0 .. 360"), std::string::npos);
    EXPECT_NE(refusal(f, changed(R"(A=(-?[\d.]+))", "A=DC(10)")).find("DC() of A, which does not roll over"),
              std::string::npos);
  } else if (dialect == "heidenhain") {
    EXPECT_NE(refusal(f, changed("M126", "M127")).find("which way it turns is said by M126 alone"), std::string::npos);
    EXPECT_NE(refusal(f, changed(R"(L C\+[\d.]+)", "L C+360")).find("outside 0 .. 360"), std::string::npos);
  } else {
    const std::string wrong =
        refusal(f, changed(R"((\n(?!(?:N\d+ )?G52)[^(\n]* C)-?(\[\[[^\]]*\] MOD 360\]|[\d.]+))", "$01360.0"));
    EXPECT_NE(wrong.find("rolls over is outside"), std::string::npos) << wrong << text;
  }
  if (dialect == "linuxcnc" && f.swing != 0) {
    // The sign of a word in a cut: the long way round.
    const std::regex cut(R"((\nX[^\n]* C)(-?)(\[|\d))");
    std::smatch m;
    ASSERT_TRUE(std::regex_search(text, m, cut));
    const std::string wrong =
        m.prefix().str() + m[1].str() + (m[2].length() != 0 ? "" : "-") + m[3].str() + m.suffix().str();
    EXPECT_NE(refusal(f, wrong).find("in one block, limit 180: a cut is not meant to"), std::string::npos);
  }
}

// The dry run takes all quarters without end and comes back the short way.
TEST(RolloverSelfTest, IsProvenInEveryDialect) {
  for (const auto& f : rollover_forms()) {
    if (!f.expand && f.swing == 0) continue;  // a dry run turns its rotaries
    const machines::Machine m = machine_of(f);
    const auto plan = self_test::plan_self_test(m);
    ASSERT_TRUE(plan) << plan.error().message;
    const auto dialect = self_test::in_air(*controls::dialect_of(m));
    text::NcHeader header;
    const auto text = text::write_nc(self_test::self_test_program(*plan, m, dialect), dialect, header);
    ASSERT_TRUE(text) << text.error().message;
    const auto proof = self_test::prove_self_test(text->text, "p", *plan, m);
    EXPECT_TRUE(proof) << f.dialect << " " << proof.error().text();
  }
}

// LinuxCNC's own interpreter, told by its INI file that C rolls over, stands where our reader stands after every move.
TEST(RolloverLinuxcnc, AgreesMoveByMove) {
  for (const auto& f : rollover_forms()) {
    if (std::string(f.dialect) != "linuxcnc") continue;
    for (const int stride : {1, 2}) {
      const std::string text =
          text_of(f, {turning_path(radians(60), radians(60), radians(-90)), sample_path(0.3, 0.1, 5, 1)}, 7, stride);
      const auto out = interpret(std::regex_replace(text, std::regex("M42[89]\n"), ""), "rollover",
                                 "[TRAJ]\nCOORDINATES = X Y Z A C\n[AXIS_C]\nWRAPPED_ROTARY = 1\n");
      ASSERT_EQ(out.exit, 0) << out.messages;
      const auto ours = executed(f, text);
      const std::regex motion(
          "STRAIGHT_(FEED|TRAVERSE)\\(([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+), ([-0-9.]+)\\)");
      const std::regex moved("SET_G92_OFFSET\\((?:[-0-9.]+, ){5}([-0-9.]+)");
      std::size_t i = 0;
      double zero = 0;
      std::optional<double> turns;  // whole turns between the two counts: where ours begins is not known
      for (const auto& l : out.lines) {
        std::smatch match;
        if (std::regex_search(l, match, moved)) zero = std::stod(match[1]);
        if (!std::regex_search(l, match, motion)) continue;
        ASSERT_LT(i, ours.size());
        const readback::ExecutedMove& e = ours[i++];
        if (!e.known || e.machine) continue;
        const double difference = e.joints[3] - (zero + std::stod(match[7]));
        if (!turns) turns = 360 * std::round(difference / 360);
        ASSERT_NEAR(difference, *turns, 1.2e-4) << e.line << "\n" << l;
        EXPECT_NEAR(e.joints[4], std::stod(match[5]), 6e-5);
      }
      EXPECT_EQ(i, ours.size());
    }
  }
}

TEST(RolloverWords, LieWithinTheTurn) {
  EXPECT_EQ(joints::within_turn(0, 360), 0);
  EXPECT_EQ(joints::within_turn(360, 360), 0);
  EXPECT_EQ(joints::within_turn(-1, 360), 359);
  EXPECT_EQ(joints::within_turn(-720, 360), 0);
  EXPECT_EQ(joints::within_turn(725, 360), 5);
}

}  // namespace
}  // namespace toothpath
