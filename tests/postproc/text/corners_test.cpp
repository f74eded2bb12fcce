// What a control may leave of the path at corners, as the readers of Siemens and Heidenhain count it: against brute
// force over everything that the axes may do there, against the writer's bound, and with planted faults.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <regex>

#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

machines::Machine machine_for(const std::string& dialect, machines::TcpMode tcp) {
  machines::Machine m = with_dialect(trunnion(), dialect);
  m.tcp = tcp;
  return m;
}

std::string regex_replaced(std::string text, const std::string& what, const std::string& by) {
  return std::regex_replace(text, std::regex(what), by);
}

std::vector<readback::ExecutedMove> moves_of(const std::string& text, const machines::Machine& m, std::string& error) {
  const auto control = controls::control_of(m, standing(), tools());
  std::vector<readback::ExecutedMove> moves;
  const auto s =
      readback::execute_nc(text, "p", *control, [&](const readback::ExecutedMove& e) { moves.push_back(e); });
  error = s ? "" : s.error().message;
  return moves;
}

std::vector<path::ToolMotion> motions_of(const std::vector<readback::ExecutedMove>& moves, const machines::Machine& m) {
  readback::OperationTrace trace;
  trace.tool = 1;
  trace.kept_teeth = 1;
  trace.moves = moves;
  const auto motions = readback::tool_motions(trace, {}, *controls::control_of(m, standing(), tools()), m, standing(),
                                              1, {1e4, 10});  // coarse: one motion a move
  return motions ? *motions : std::vector<path::ToolMotion>{};
}

/// A first number behind `name` in the text.
double value_in(const std::string& text, const std::string& name) {
  const std::size_t at = text.find(name);
  return at == std::string::npos ? 0 : std::stod(text.substr(at + name.size()));
}

/// X Y Z A C and the tool length -> tip in the table frame and axis.
TrunnionPose pose_of(const std::array<double, 5>& j) {
  return trunnion_forward(kTrunnion, j[0], j[1], j[2], j[4], j[3], 95);
}

double angle(const Vec3& a, const Vec3& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// The text's own words: how far every axis may be off the corner behind move i.
struct Box {
  std::array<double, 5> least{}, greatest{};
};

class CornerBox {
 public:
  explicit CornerBox(const std::string& text)
      : adis_(value_in(text, "ADIS=")),
        c_(value_in(text, "FGREF[C]=") * kPi / 180),
        a_(value_in(text, "FGREF[A]=") * kPi / 180) {}
  Box at(const std::vector<readback::ExecutedMove>& moves, std::size_t i) const {
    Box b;
    for (const std::size_t k : {i, i + 1}) {
      const auto &from = moves[k - 1].joints, &to = moves[k].joints;
      if (moves[k].rapid) continue;
      double way = 0;
      for (std::size_t a = 0; a < 5; ++a) way += std::pow((to[a] - from[a]) * (a < 3 ? 1 : a == 3 ? c_ : a_), 2);
      const double share = std::min(0.5, adis_ / std::sqrt(way));
      for (std::size_t a = 0; a < 5; ++a) {
        const double off = share * (k == i ? from[a] - to[a] : to[a] - from[a]);
        b.least[a] = std::min(b.least[a], off);
        b.greatest[a] = std::max(b.greatest[a], off);
      }
    }
    return b;
  }

 private:
  double adis_, c_, a_;
};

// Joints: whatever the axes do inside the pieces of both blocks, the tip stays within what is counted, and that within
// what is granted.
TEST(Corners, SiemensJointsBoundTipAndAxis) {
  const machines::Machine m = machine_for("siemens", machines::TcpMode::none);
  for (const double blend : {0.0003, 0.02}) {
    const auto p = axis_program({sample_path(0.3, 1.2, 12)}, m, standing(), 1, false, 0.2);
    ASSERT_TRUE(p) << p.error().message;
    EXPECT_GT(p->tip_reach_mm, 50);
    text::NcHeader header;
    header.blend_mm = blend;
    const auto text = write_nc(*p, *controls::dialect_of(m), header);
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_NE(text->text.find("FGROUP(X,Y,Z,C,A)\nFGREF[C]="), std::string::npos);
    EXPECT_NE(text->text.find("G60\nFGROUP()\n"), std::string::npos);
    const double granted = text::granted_blend_mm(*p, *controls::dialect_of(m), header);
    EXPECT_LE(granted, blend);
    EXPECT_GT(granted, 0.9 * blend);
    std::string error;
    const auto moves = moves_of(text->text, m, error);
    ASSERT_EQ(error, "");
    auto straight = moves;  // the same without corners: what else the motions state
    for (auto& e : straight) e.corner_share = 0;
    const auto counted = motions_of(moves, m), rest = motions_of(straight, m);
    ASSERT_EQ(counted.size(), rest.size());
    const CornerBox box(text->text);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(0, 1);
    double most = 0, most_counted = 0;
    std::size_t n = 0, corners = 0;
    for (std::size_t i = 1; i + 1 < moves.size(); ++i) {
      if (!moves[i].known) continue;
      const std::size_t k = n++;
      if (moves[i].rapid) continue;
      ASSERT_EQ(counted[k].line, moves[i].line);
      const double tip_bound = counted[k].deviation_mm - rest[k].deviation_mm,
                   axis_bound = counted[k].axis_deviation - rest[k].axis_deviation;
      EXPECT_LE(tip_bound, granted * (1 + 1e-5)) << moves[i].line;
      most_counted = std::max(most_counted, tip_bound);
      const TrunnionPose corner = pose_of(moves[i].joints);
      const Box b = box.at(moves, i);
      ++corners;
      for (int trial = 0; trial < 60; ++trial) {
        std::array<double, 5> j = moves[i].joints;
        for (std::size_t a = 0; a < 5; ++a) {
          const double t = trial < 32 ? double((trial >> a) & 1) : u(random);
          j[a] += (1 - t) * b.least[a] + t * b.greatest[a];
        }
        const TrunnionPose off = pose_of(j);
        ASSERT_LE((off.tip - corner.tip).norm(), tip_bound + 1e-9) << moves[i].line;
        ASSERT_LE(angle(off.axis, corner.axis), axis_bound + 1e-9) << moves[i].line;
        most = std::max(most, (off.tip - corner.tip).norm());
      }
    }
    EXPECT_GT(corners, 20u);
    EXPECT_GT(most, 0.3 * most_counted);  // the bound is no empty one
  }
}

// A block that turns one rotary alone: its way is the turn at the radius that the text names.
TEST(Corners, SiemensCountsBlocksThatTurnOnly) {
  const machines::Machine m = machine_for("siemens", machines::TcpMode::none);
  const std::string start =
      "G17 G40 G90 G94 G710\nTRAFOOF\nG54\nFGROUP(X,Y,Z,C,A)\nFGREF[C]=120\nFGREF[A]=120\nG641 ADIS=0.01\n;OP 0 "
      "finishing\nSUPA G0 Z500 D0\nT=\"T1\"\nM6\nS100 M3\nD1\n"
      "G0 C=0 A=0\nG0 X100 Y0\nG0 Z100\nG93\n";
  const std::string end = "G94 F100\nM5\nSUPA G0 Z500 D0\nG60\nFGROUP()\nM30\n";
  std::string error;
  const auto moves = moves_of(start + "G1 C=2 F10\nG1 C=2.002 F10\nG1 C=2.004 X100.5 F10\n" + end, m, error);
  ASSERT_EQ(error, "");
  std::vector<double> shares;
  for (const auto& e : moves)
    if (!e.rapid) shares.push_back(e.corner_share);
  ASSERT_EQ(shares.size(), 3u);
  EXPECT_NEAR(shares[0], 0.01 / (120 * radians(2)), 1e-6);
  EXPECT_EQ(shares[1], 0.5);  // the whole block is 4 um
  EXPECT_NEAR(shares[2], 0.01 / std::hypot(120 * radians(0.002), 0.5), 1e-6);
  for (const auto& motion : motions_of(moves, m))
    if (!motion.rapid) {
      EXPECT_LT(motion.deviation_mm, 0.02 + 0.0162 * 100);  // |d| + w R, and what the chord of 2 deg leaves
      EXPECT_LT(motion.axis_deviation, 1e-9);               // the tool stands along C
    }
  // A tool that leans by 30 deg: C moves its axis by the half of its turn.
  bool seen = false;
  for (const auto& motion : motions_of(
           moves_of(regex_replaced(start, "A=0", "A=30") + "G1 C=2 F10\nG1 C=2.002 F10\nG1 C=2.004 X100.5 F10\n" + end,
                    m, error),
           m))
    if (!motion.rapid && motion.line == 18) {
      seen = true;
      EXPECT_GE(motion.axis_deviation, 0.5 * 0.01 / 120);
      EXPECT_LE(motion.axis_deviation, 0.51 * 0.01 / 120 + 2e-4);  // and the arc of 2 deg
    }
  EXPECT_TRUE(seen);
  // What is not said is not guessed.
  const std::string turn = "G1 C=2 F10\n";
  (void)moves_of(regex_replaced(start, "FGROUP[^\n]*\n", "") + turn + end, m, error);
  EXPECT_EQ(error, "this G1 turns a rotary axis and no FGROUP says what ADIS is measured over");
  (void)moves_of(start + "FGROUP()\n" + turn + end, m, error);
  EXPECT_NE(error.find("no FGROUP"), std::string::npos) << error;
  (void)moves_of(regex_replaced(start, "FGROUP\\(X,Y,Z,C,A\\)", "FGROUP(X,Y,Z,B)") + turn + end, m, error);
  EXPECT_NE(error.find("FGROUP names every axis"), std::string::npos) << error;
  (void)moves_of(regex_replaced(start, "FGREF\\[C\\]=120", "FGREF[C]=0") + turn + end, m, error);
  EXPECT_EQ(error, "FGREF must be above 0");
  // A rotary that is left out of the group may be anywhere inside a half of its block.
  const auto left_out = moves_of(regex_replaced(start, "X,Y,Z,C,A", "X,Y,Z,A") + turn + end, m, error);
  ASSERT_EQ(error, "");
  for (const auto& e : left_out)
    if (!e.rapid) { EXPECT_EQ(e.corner_share, 0.5F); }
  // Without FGREF the control counts 1 mm for a degree.
  const auto unnamed = moves_of(regex_replaced(start, "FGREF\\[C\\]=120\n", "") + turn + end, m, error);
  ASSERT_EQ(error, "");
  for (const auto& e : unnamed)
    if (!e.rapid) { EXPECT_NEAR(e.corner_share, 0.01 / 2, 1e-6); }
  // Exact stop needs none of it.
  const auto stops = moves_of(
      regex_replaced(regex_replaced(start, "FGROUP[^\n]*\nFGREF[^\n]*\nFGREF[^\n]*\n", ""), "G641 ADIS=0.01", "G60") +
          turn + end,
      m, error);
  ASSERT_EQ(error, "");
  for (const auto& e : stops) EXPECT_EQ(e.corner_share, 0.0F);
}

// TRAORI: the way is that of the tip; the rotaries may be off by the same share of their turn, which is the deviation
// of the tool axis.
TEST(Corners, SiemensTraoriCountsTheToolAxis) {
  for (const machines::TcpMode tcp : {machines::TcpMode::angles, machines::TcpMode::vectors}) {
    const machines::Machine m = machine_for("siemens", tcp);
    const auto p = axis_program({sample_path(0.3, 1.2, 12)}, m, standing(), 1);
    ASSERT_TRUE(p);
    text::NcHeader header;
    const auto text = write_nc(*p, *controls::dialect_of(m), header);
    ASSERT_TRUE(text);
    EXPECT_EQ(text->text.find("FGROUP"), std::string::npos);
    std::string error;
    const auto moves = moves_of(text->text, m, error);
    ASSERT_EQ(error, "");
    auto straight = moves;
    for (auto& e : straight) e.corner_share = 0;
    const auto counted = motions_of(moves, m), rest = motions_of(straight, m);
    const double adis = value_in(text->text, "ADIS=");
    EXPECT_GT(adis, 0.0002);
    double most = 0;
    std::size_t n = 0;
    for (std::size_t i = 1; i + 1 < moves.size(); ++i) {
      if (!moves[i].known) continue;
      const std::size_t k = n++;
      if (moves[i].rapid || !moves[i - 1].tcp) continue;
      EXPECT_LE(counted[k].deviation_mm - rest[k].deviation_mm, std::sqrt(2) * adis * (1 + 1e-5) + 1e-12);
      const double way = (moves[i].tip - moves[i - 1].tip).norm(), share = std::min(0.5, adis / way);
      // C, which carries the work, moves the tool axis by the sine of the tilt.
      const double sine = std::min(std::abs(std::sin(radians(moves[i].joints[4]))),
                                   std::abs(std::sin(radians(moves[i - 1].joints[4]))));
      const double turn = radians(sine * std::abs(moves[i].joints[3] - moves[i - 1].joints[3]) +
                                  std::abs(moves[i].joints[4] - moves[i - 1].joints[4]));
      const double axis = counted[k].axis_deviation - rest[k].axis_deviation;
      EXPECT_GE(axis, share * turn * (1 - 1e-6) - 1e-12);
      most = std::max(most, axis);
    }
    EXPECT_GT(most, 1e-7);
    EXPECT_LT(most, 1e-3);
  }
}

// TA of cycle 32: what it lets each rotary do is the deviation of the tool axis; without it a block that turns a rotary
// is refused.
TEST(Corners, HeidenhainCountsTheToleranceOfTheRotaries) {
  const machines::Machine m = machine_for("heidenhain", machines::TcpMode::angles);
  const auto build = [&](double swing, double ta) {
    const auto p = axis_program({sample_path(0.3, swing, 8)}, m, standing(), 1);
    EXPECT_TRUE(p);
    text::NcHeader header;
    header.blend_axis_deg = ta;
    EXPECT_NEAR(text::granted_blend_rad(*p, *controls::dialect_of(m), header), 2 * radians(ta), 1e-9);
    return write_nc(*p, *controls::dialect_of(m), header)->text;
  };
  for (const double ta : {0.002, 0.05}) {
    const std::string text = build(1.0, ta);
    EXPECT_NE(text.find(fmt::format("CYCL DEF 32.1 T0.0003\n")), std::string::npos);
    EXPECT_NE(text.find(fmt::format("CYCL DEF 32.2 HSC-MODE:0 TA{}\n", ta)), std::string::npos);
    std::string error;
    const auto moves = moves_of(text, m, error);
    ASSERT_EQ(error, "");
    int cuts = 0;
    for (const auto& motion : motions_of(moves, m))
      if (!motion.rapid) {
        ++cuts;
        EXPECT_GE(motion.axis_deviation, 2 * radians(ta) * (1 - 1e-6));
        EXPECT_LE(motion.axis_deviation, 2 * radians(ta) + 2e-3);
      }
    EXPECT_GT(cuts, 15);
    // Without the block, and with a T behind it that resets it.
    for (const auto& [what, by] :
         {std::pair<const char*, const char*>{"CYCL DEF 32\\.2[^\n]*", "CYCL DEF 32.0 TOLERANCE"},
          {"CYCL DEF 32\\.2[^\n]*", "CYCL DEF 32.1 T0.0003"}}) {
      (void)moves_of(regex_replaced(text, what, by), m, error);
      EXPECT_NE(error.find("no TA says how far"), std::string::npos) << error;
    }
    (void)moves_of(regex_replaced(text, "HSC-MODE:0 TA[0-9.]+", "HSC-MODE:2 TA1"), m, error);
    EXPECT_NE(error.find("HSC-MODE:0 or 1"), std::string::npos) << error;
    (void)moves_of(regex_replaced(text, "HSC-MODE:0 TA[0-9.]+", "HSC-MODE:0 TA11"), m, error);
    EXPECT_NE(error.find("TA must be 0 to 10 deg"), std::string::npos) << error;
  }
  // Rotaries that stand in every cut need none.
  std::string error;
  (void)moves_of(regex_replaced(build(0, 0.002), "CYCL DEF 32\\.2[^\n]*", "CYCL DEF 32.0 TOLERANCE"), m, error);
  EXPECT_EQ(error, "");
}

// Lines of the machine file in place of the dialect's own: written around every operation, read as what is stated, no
// word otherwise.
struct Stated {
  const char* dialect;
  machines::TcpMode tcp;
  const char *on, *off;
};
void PrintTo(const Stated& s, std::ostream* out) {
  *out << s.dialect << (s.tcp == machines::TcpMode::none ? "" : "_tcp");
}
class StatedSmoothing : public testing::TestWithParam<Stated> {};
INSTANTIATE_TEST_SUITE_P(
    Controls, StatedSmoothing,
    testing::Values(Stated{"fanuc", machines::TcpMode::none, "G5.1 Q1", "G5.1 Q0"},
                    Stated{"fanuc", machines::TcpMode::angles, "G5.1 Q1 R5", "G5.1 Q0"},
                    Stated{"mitsubishi_m80", machines::TcpMode::none, "G61.4", "G64"},
                    Stated{"siemens", machines::TcpMode::none, "CYCLE832(0.002,_FINISH,1)", "CYCLE832()"},
                    Stated{"siemens", machines::TcpMode::angles, "CYCLE832(0.002,_ORI_FINISH,0.01)", "CYCLE832()"}));

TEST_P(StatedSmoothing, IsWrittenAndCountedAsStated) {
  const Stated& s = GetParam();
  machines::Machine m = machine_for(s.dialect, s.tcp);
  m.post.smoothing_on = {s.on};
  m.post.smoothing_off = {s.off};
  m.post.smoothing_tolerance_mm = 0.002;
  const std::vector<path::ClPath> paths = {sample_path(0.3, 0.3, 6), sample_path(0.3, 0.3, 4, 1)};
  const auto p = axis_program(paths, m, standing(), 2, true);
  ASSERT_TRUE(p) << p.error().message;
  ASSERT_TRUE(p->turns_in_cuts);
  const auto refused = write_nc(*p, *controls::dialect_of(m), {});
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("post.smoothing_axis_tolerance"), std::string::npos);
  m.post.smoothing_axis_tolerance_rad = radians(0.01);
  const auto text = write_nc(*p, *controls::dialect_of(m), {});
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_EQ(text::granted_blend_mm(*p, *controls::dialect_of(m), {}), 0.002);
  EXPECT_EQ(text->text.find("G641"), std::string::npos);
  const auto count = [&](const std::string& line) {
    std::size_t n = 0;
    for (std::size_t at = text->text.find(line + "\n"); at != std::string::npos;
         at = text->text.find(line + "\n", at + 1))
      ++n;
    return n;
  };
  EXPECT_EQ(count(s.on), 2u);
  EXPECT_EQ(count(s.off),
            s.off == std::string("G64") ? 4u : 2u);  // G64 stands ahead of the smoothing of Fanuc's family
  std::string error;
  const auto moves = moves_of(text->text, m, error);
  ASSERT_EQ(error, "");
  int cuts = 0;
  for (const auto& e : moves) {
    if (e.rapid) continue;
    ++cuts;
    EXPECT_EQ(e.blend_mm, 0.002F);
    EXPECT_EQ(e.corner_share, 0.0F);
    EXPECT_EQ(e.blend_axis_rad, static_cast<float>(radians(0.01)));
  }
  EXPECT_GT(cuts, 20);
  for (const auto& motion : motions_of(moves, m))
    if (!motion.rapid) {
      EXPECT_GE(motion.deviation_mm, 0.002);
      EXPECT_GE(motion.axis_deviation, radians(0.01) * (1 - 1e-6));
    }
  // Another word is no such line, and a machine that states nothing knows none of them.
  std::string other = text->text;
  other.replace(other.find(s.on), std::string(s.on).size(), std::string(s.on) + " P1");
  (void)moves_of(other, m, error);
  EXPECT_NE(error, "");
  machines::Machine plain = machine_for(s.dialect, s.tcp);
  (void)moves_of(text->text, plain, error);
  const bool says_itself = std::string(s.on).find("_ORI_FINISH") != std::string::npos;
  EXPECT_EQ(error == "", says_itself) << error;
  // Read with a statement that lacks the tool axis.
  m.post.smoothing_axis_tolerance_rad.reset();
  (void)moves_of(text->text, m, error);
  EXPECT_NE(error.find("without post.smoothing_axis_tolerance"), std::string::npos) << error;
}

// A granted contour tolerance in the words of the control, as the writer grants it and the reader counts it.
struct Granted {
  const char* dialect;
  machines::TcpMode tcp;
  double swing;
  const char* words;  ///< regular expression
};
void PrintTo(const Granted& g, std::ostream* out) {
  *out << g.dialect << (g.tcp == machines::TcpMode::none ? "" : "_tcp") << (g.swing == 0 ? "" : "_turning");
}
class ContourTolerance : public testing::TestWithParam<Granted> {};
INSTANTIATE_TEST_SUITE_P(
    Controls, ContourTolerance,
    testing::Values(
        Granted{"siemens", machines::TcpMode::none, 0, R"(CYCLE832\(0\.0025,_FINISH,1\)\n)"},
        Granted{"siemens", machines::TcpMode::none, 0.3, R"(FGROUP\(.*\n(FGREF.*\n)+G641 ADIS=0\.001\d+\n)"},
        Granted{"siemens", machines::TcpMode::angles, 0.3, R"(CYCLE832\(0\.0025,_ORI_FINISH,0\.008\)\n)"},
        Granted{"siemens", machines::TcpMode::vectors, 0.3, R"(CYCLE832\(0\.0025,_ORI_FINISH,0\.008\)\n)"},
        Granted{"heidenhain", machines::TcpMode::angles, 0.3, R"(CYCL DEF 32\.1 T0\.0025\n.*HSC-MODE:0 TA0\.008\n)"},
        Granted{"heidenhain", machines::TcpMode::none, 0, R"(CYCL DEF 32\.1 T0\.0025\n)"}));

TEST_P(ContourTolerance, IsWrittenAndCounted) {
  const Granted& g = GetParam();
  const machines::Machine m = machine_for(g.dialect, g.tcp);
  const auto dialect = controls::dialect_of(m);
  const auto p = axis_program({sample_path(0.3, g.swing, 6), sample_path(0.3, g.swing, 4, 1)}, m, standing(), 2, true);
  ASSERT_TRUE(p) << p.error().message;
  text::NcHeader header;
  header.blend_mm = 0.0025;
  header.blend_axis_deg = 0.008;
  header.contour_granted = true;
  const auto text = write_nc(*p, *dialect, header);
  ASSERT_TRUE(text) << text.error().message;
  EXPECT_TRUE(std::regex_search(text->text, std::regex(g.words))) << text->text.substr(0, 1500);
  EXPECT_NE(text->text.find("CONTOUR TOLERANCE 0.002"), std::string::npos);
  const double granted = text::granted_blend_mm(*p, *dialect, header);
  EXPECT_LE(granted, 0.0025 + 1e-12);
  EXPECT_GT(granted, 0.0022);
  std::string error;
  const auto moves = moves_of(text->text, m, error);
  ASSERT_EQ(error, "");
  joints::AxisProgram timed = *p;
  text::note_corners(timed, *dialect, header);
  const bool way = text->text.find("G641") != std::string::npos;
  EXPECT_EQ(timed.corners, way ? timing::Corners::way : timing::Corners::round);
  std::size_t cuts = 0;
  for (const auto& e : moves) {
    if (e.rapid) continue;
    ++cuts;
    EXPECT_EQ(e.corners, timed.corners);
    EXPECT_FLOAT_EQ(e.tolerance_mm, static_cast<float>(timed.corner_tolerance_mm));
    if (!way) { EXPECT_FLOAT_EQ(e.blend_mm, 0.0025F); }
    if (g.tcp != machines::TcpMode::none) {
      EXPECT_FLOAT_EQ(e.blend_axis_rad, static_cast<float>(text::granted_blend_rad(*p, *dialect, header)));
      EXPECT_NEAR(e.blend_axis_rad, 2 * radians(0.008), 1e-8);
    }
  }
  EXPECT_GT(cuts, 20U);
  double least = 1;
  for (const auto& motion : motions_of(moves, m))
    if (!motion.rapid) least = std::min(least, motion.deviation_mm);
  if (!way) { EXPECT_GE(least, 0.0025 * (1 - 1e-6)); }
}

// An operation that leaves an allowance is granted more, and the one behind it no more than before.
TEST_P(ContourTolerance, OfRoughingEndsBehindIt) {
  const Granted& g = GetParam();
  const machines::Machine m = machine_for(g.dialect, g.tcp);
  const auto dialect = controls::dialect_of(m);
  auto p =
      axis_program({sample_path(0.3, g.swing, 6), sample_path(0.3, g.swing, 6, 1), sample_path(0.3, g.swing, 4, 2)}, m,
                   standing(), 2, true);
  ASSERT_TRUE(p) << p.error().message;
  p->operations[1].wide_corners = joints::CornerGrant{0.006, 0.01};
  text::NcHeader header;
  header.blend_mm = 0.0025;
  header.blend_axis_deg = 0.008;
  header.contour_granted = true;
  text::note_corners(*p, *dialect, header);
  const auto text = write_nc(*p, *dialect, header);
  ASSERT_TRUE(text) << text.error().message;
  const bool way = text->text.find("G641 ADIS=0.001") != std::string::npos;  // no word bounds rotaries that turn
  EXPECT_EQ(text->text.find("0.006") == std::string::npos, way);
  EXPECT_EQ(std::regex_search(text->text, std::regex("_ROUGH,|_ORI_ROUGH,|HSC-MODE:1")), !way);
  std::string error;
  const auto moves = moves_of(text->text, m, error);
  ASSERT_EQ(error, "");
  std::array<std::size_t, 3> cuts{};
  for (const auto& e : moves) {
    if (e.rapid || e.operation < 0) continue;
    const auto n = static_cast<std::size_t>(e.operation);
    ++cuts.at(n);
    const double tolerance = n == 1 && !way ? p->operations[1].corner_tolerance_mm : p->corner_tolerance_mm;
    EXPECT_FLOAT_EQ(e.tolerance_mm, static_cast<float>(tolerance)) << n;
    if (!way) { EXPECT_FLOAT_EQ(e.blend_mm, n == 1 ? 0.006F : 0.0025F) << n; }
    if (!way && g.tcp != machines::TcpMode::none) {
      EXPECT_NEAR(e.blend_axis_rad, 2 * radians(n == 1 ? 0.01 : 0.008), 1e-8);
    }
  }
  for (const std::size_t n : cuts) EXPECT_GT(n, 5U);
  EXPECT_NEAR(text::granted_blend_mm(*p, *dialect, header), 0.0025, way ? 3e-4 : 1e-12);
}

// What the text must say for it.
TEST(ContourTolerance, IsRefusedWhereItSaysTooLittle) {
  const machines::Machine m = machine_for("siemens", machines::TcpMode::angles);
  const auto p = axis_program({sample_path(0.3, 0.3, 6)}, m, standing(), 1);
  ASSERT_TRUE(p);
  text::NcHeader header;
  header.blend_mm = 0.0025;
  header.contour_granted = true;
  const std::string text = write_nc(*p, *controls::dialect_of(m), header)->text;
  const auto refusal = [&](const std::string& what, const std::string& by) {
    std::string error;
    (void)moves_of(regex_replaced(text, what, by), m, error);
    return error;
  };
  EXPECT_EQ(refusal("x{9}", ""), "");
  EXPECT_NE(refusal("_ORI_FINISH,0.002", "_FINISH,1").find("bounds X, Y and Z alone"), std::string::npos);
  EXPECT_NE(refusal("_ORI_FINISH", "_ORI_FAST").find("_FINISH,1 or _ORI_FINISH"), std::string::npos);
  EXPECT_NE(refusal("CYCLE832\\(0.0025", "CYCLE832(0").find("a tolerance above 0"), std::string::npos);
  EXPECT_NE(refusal("CYCLE832\\(0.0025[^\n]*\n", "CYCLE832()\n").find("how far the control leaves corners"),
            std::string::npos);
  EXPECT_NE(refusal(",0.002\\)", ",11)").find("up to 10 deg"), std::string::npos);
}

TEST(StatedSmoothingKeys, NeedItsBoundAndADialectWithoutItsOwn) {
  machines::Machine m = machine_for("fanuc", machines::TcpMode::none);
  m.post.smoothing_on = {"G5.1 Q1"};
  EXPECT_NE(controls::dialect_of(m).error().message.find("needs post.smoothing_off and post.smoothing_tolerance"),
            std::string::npos);
  m.post.smoothing_off = {"G5.1 Q0"};
  EXPECT_FALSE(controls::dialect_of(m));
  m.post.smoothing_tolerance_mm = 0.01;
  EXPECT_TRUE(controls::dialect_of(m));
  for (const char* dialect : {"linuxcnc", "heidenhain"}) {
    m.dialect = dialect;
    ASSERT_FALSE(controls::dialect_of(m));
    EXPECT_NE(controls::dialect_of(m).error().message.find("has its own words"), std::string::npos);
  }
}

}  // namespace
}  // namespace toothpath
