// Programs with TCP: safe entering and leaving, the tip on its chord, travels inside the blocks.
#include <gtest/gtest.h>

#include <random>
#include <regex>
#include <sstream>

#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

machines::Machine tcp_machine(const std::string& dialect) {
  machines::Machine m = with_dialect(trunnion(), dialect);
  m.tcp = machines::TcpMode::angles;
  if (dialect == "linuxcnc") {
    m.post.tcp_on = {"M428"};
    m.post.tcp_off = {"M429"};
  }
  return m;
}

struct TcpOutcome {
  readback::ReadBack back;
  std::vector<path::ToolMotion> motions;
  readback::ClComparison comparison;
};

Result<TcpOutcome> examine(const std::string& text, const std::vector<path::ClPath>& paths, const machines::Machine& m,
                           const toothpath::joints::Setup& setup, int teeth, double tolerance) {
  TcpOutcome out;
  const auto control = controls::control_of(m, setup, tools());
  if (!control) return control.error();
  auto back = readback::read_back(text, "p.nc", *control, m, setup, {.teeth = teeth});
  if (!back) return back.error();
  out.back = std::move(*back);
  for (const auto& trace : out.back.operations) {
    auto motions = readback::tool_motions(trace, out.back.copies, *control, m, setup, teeth, {2e-4, 1e-4});
    if (!motions) return motions.error();
    out.motions.insert(out.motions.end(), motions->begin(), motions->end());
    if (const auto clear = readback::check_rapids(trace, *control, m, setup, kBody); !clear) return clear.error();
  }
  std::vector<const path::ClPath*> list;
  for (const auto& p : paths) list.push_back(&p);
  out.comparison = readback::compare_with_cl(out.motions, list, tolerance, 1e-3);
  return out;
}

struct TcpCase {
  const char* dialect;
  double lean, swing;
  bool eccentric;
};

class TcpRoundTrip : public testing::TestWithParam<TcpCase> {};
INSTANTIATE_TEST_SUITE_P(Cases, TcpRoundTrip,
                         testing::Values(TcpCase{"linuxcnc", 0.3, 0, false}, TcpCase{"linuxcnc", 0.3, 0.6, false},
                                         TcpCase{"linuxcnc", 0.0, 0.0, true}, TcpCase{"fanuc", 0.3, 0, false},
                                         TcpCase{"fanuc", 0.3, 0.6, false}, TcpCase{"fanuc", 0.25, 0.5, true}));

// Every record is met to the rounding of the words, tip blocks leave their chord by nothing but the blending, times
// agree.
TEST_P(TcpRoundTrip, MeetsEveryRecord) {
  const TcpCase v = GetParam();
  const machines::Machine m = tcp_machine(v.dialect);
  toothpath::joints::Setup s = standing();
  if (v.eccentric) s.origin_mm += Vec3(2, 1, 0);
  const std::vector<path::ClPath> paths = {sample_path(v.lean, v.swing), sample_path(v.lean, v.swing, 25, 1)};
  const auto program = axis_program(paths, m, s, 4);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(program->chord_bound_mm, 0);
  const auto text = text::write_nc(*program, *controls::dialect_of(m), {});
  ASSERT_TRUE(text) << text.error().message;
  const auto o = examine(text->text, paths, m, s, 4, 1.5e-3);
  ASSERT_TRUE(o) << o.error().text();
  EXPECT_TRUE(o->comparison.complete) << o->comparison.message;
  EXPECT_LE(o->comparison.worst_mm, program->rounding_bound_mm + 1e-9);
  EXPECT_LE(o->comparison.worst_extra_mm, program->rounding_bound_mm + 1e-9) << "inserted points lie on the chord";
  EXPECT_LT(o->comparison.fastest_ratio, 1.03);
  EXPECT_GT(o->comparison.fastest_ratio, 0.9);
  for (const auto& motion : o->motions)
    if (!motion.rapid) {
      EXPECT_LE(motion.deviation_mm, words_of("linuxcnc").exact_path_mm + 1e-8);
      const bool cuts =
          (motion.tip_to - motion.tip_from).norm() > 1e-6;  // a turn above the part is cut by the bound of its whole
      EXPECT_LE(motion.axis_deviation, cuts ? 1.05e-4 : 1e-3);
    }
  for (std::size_t a = 0; a < program->ranges.size(); ++a) {
    const auto& r = program->ranges[a];
    const double scale = r.rotary ? degrees(1) : 1;
    EXPECT_NEAR(o->back.least[a], r.min * scale, 2e-3) << r.letter;
    EXPECT_NEAR(o->back.greatest[a], r.max * scale, 2e-3) << r.letter;
  }
  EXPECT_NEAR(o->back.feed_minutes / program->feed_minutes, 1, std::string(v.dialect) == "fanuc" ? 0.2 : 2e-3);
}

// The tool as the machine moves it under TCP, by kinematics that share nothing with the reader: tip linear, rotaries
// linear.
TEST(TcpMotions, BoundHoldsForTheStraightTip) {
  const machines::Machine m = tcp_machine("linuxcnc");
  const auto control = controls::control_of(m, standing(), tools());
  std::mt19937 random(12);
  std::uniform_real_distribution<double> u(-1, 1);
  for (int trial = 0; trial < 100; ++trial) {
    readback::OperationTrace trace;
    readback::ExecutedMove a, b;
    a.known = b.known = true;
    a.tool = b.tool = 1;
    a.joints = {100 * u(random), 100 * u(random), 250 + 50 * u(random), 360 * u(random), 50 * u(random)};
    b.tcp = true;
    b.tip =
        m.chain.forward({Vec3(a.joints[0], a.joints[1], a.joints[2]), {radians(a.joints[3]), radians(a.joints[4])}}, 95)
            .tip_mm +
        Vec3(u(random), u(random), u(random));
    const double r0 = a.joints[3] + 6 * u(random), r1 = a.joints[4] + 6 * u(random);
    const Vec3 x = m.chain.linear_for(b.tip, {radians(r0), radians(r1)}, 95).linear_mm;
    b.joints = {x.x(), x.y(), x.z(), r0, r1};
    trace.moves = {a, b};
    const auto motions = readback::tool_motions(trace, {}, *control, m, standing(), 1, {1e-4, 2e-4});
    ASSERT_TRUE(motions);
    const auto n = static_cast<int>(motions->size());
    for (int i = 0; i < n; ++i) {
      const path::ToolMotion& mo = (*motions)[static_cast<std::size_t>(i)];
      EXPECT_LE(mo.deviation_mm, 1e-8);
      for (const double t : {0.0, 0.3, 0.5, 0.8, 1.0}) {
        const double s = (i + t) / n;
        // Axis of xyzac-trt from the angles alone.
        const double C = radians(a.joints[3] + s * (r0 - a.joints[3])),
                     A = radians(a.joints[4] + s * (r1 - a.joints[4]));
        const Vec3 axis(std::sin(C) * std::sin(A), std::cos(C) * std::sin(A), std::cos(A));
        const Vec3 blend = ((1 - t) * mo.axis_from + t * mo.axis_to).normalized();
        ASSERT_LE(std::atan2(blend.cross(axis).norm(), blend.dot(axis)), mo.axis_deviation + 1e-9);
      }
    }
    const Vec3 start = motions->front().tip_from, end = motions->back().tip_to;
    for (int i = 0; i < n; ++i)
      ASSERT_LT(((*motions)[static_cast<std::size_t>(i)].tip_to - (start + (end - start) * ((i + 1.0) / n))).norm(),
                1e-9);
  }
}

// Fanuc: TCP starts at rotary zero with Z alone, ends with the machine retract; no joint rapid in between.
TEST(TcpText, FanucStartsAtZeroAndLeavesByRetract) {
  const machines::Machine m = tcp_machine("fanuc");
  const auto text = nc_text({sample_path(0.3, 0.4)}, m, standing(), 3);
  ASSERT_TRUE(text) << text.error().message;
  std::istringstream in(text->text);
  bool tcp = false, at_zero = false;
  int starts = 0, calls = 0;
  for (std::string l; std::getline(in, l);) {
    if (l.rfind("M98", 0) == 0) ++calls;
    if (l[0] == '(' || l.rfind("G52", 0) == 0) continue;
    if (l.find("G43.4") != std::string::npos) {
      EXPECT_TRUE(std::regex_match(l, std::regex("G0 G43\\.4 H1 Z-?[0-9.]+"))) << l;
      EXPECT_FALSE(tcp);
      EXPECT_TRUE(at_zero);
      tcp = true;
      ++starts;
    } else if (l.find("G49") != std::string::npos) {
      EXPECT_TRUE(std::regex_match(l, std::regex("G0 G49 G53 Z-?[0-9.]+"))) << l;
      tcp = at_zero = false;
    } else if (std::regex_search(l, std::regex("^G0.* [AC]"))) {
      EXPECT_FALSE(tcp) << l;
      at_zero = l == "G0 C0. A0.";
    }
    EXPECT_EQ(l.find("G43 "), std::string::npos) << "plain G43 in a TCP program: " << l;
    EXPECT_EQ(l.find("G93"), std::string::npos) << l;
  }
  EXPECT_EQ(starts, 1);
  EXPECT_EQ(calls, 3);
  EXPECT_FALSE(tcp);
}

// LinuxCNC: off before every rapid and every G53, on before the cut.
TEST(TcpText, LinuxcncSwitchesAroundTheCut) {
  const auto text = nc_text({sample_path(0.3, 0.4)}, tcp_machine("linuxcnc"), standing(), 3);
  ASSERT_TRUE(text) << text.error().message;
  std::istringstream in(text->text);
  bool tcp = false;
  int cuts = 0, motion = -1;
  for (std::string l; std::getline(in, l);) {
    if (l == "M428") tcp = true;
    if (l == "M429") tcp = false;
    if (l.rfind("G0", 0) == 0 || l.rfind("G53 G0", 0) == 0) motion = 0;
    if (l.rfind("G1 ", 0) == 0) motion = 1;
    if (!std::regex_search(l, std::regex("^(G[01] |G53 G0 )?[XYZAC]"))) continue;
    EXPECT_EQ(tcp, motion == 1) << l;
    cuts += motion;
  }
  EXPECT_GT(cuts, 3 * 80);
}

// Danger 21: with TCP the joints are curved inside a block. The program's ranges hold what lies between the ends.
TEST(TcpTravel, InsideABlockIsChecked) {
  const machines::Machine m = tcp_machine("fanuc");
  const auto program = axis_program({sample_path(0.5, 0.2)}, m, standing(), 3);
  ASSERT_TRUE(program) << program.error().message;
  // The turn at the start: the tip stands on the table, Y and Z are dragged along a circle.
  double ends_least = 1e9, least = 1e9;
  for (const auto& tooth : program->operations[0].teeth)
    for (std::size_t i = 1; i < tooth.blocks.size(); ++i) {
      const joints::AxisBlock &a = tooth.blocks[i - 1], &b = tooth.blocks[i];
      if (b.kind != joints::BlockKind::turn) continue;
      const Vec3 tip(static_cast<double>(b.words[0]) / 1e3 + 3, static_cast<double>(b.words[1]) / 1e3 - 2,
                     static_cast<double>(b.words[2]) / 1e3);
      for (int s = 0; s <= 100; ++s) {
        std::array<double, 2> r{};
        for (std::size_t k = 0; k < 2; ++k)
          r[k] = radians((static_cast<double>(a.words[3 + k]) * (100 - s) + static_cast<double>(b.words[3 + k]) * s) /
                         1e5);
        const double y = m.chain.linear_for(tip, r, 95).linear_mm.y();
        least = std::min(least, y);
        if (s == 0 || s == 100) ends_least = std::min(ends_least, y);
      }
    }
  EXPECT_LE(program->ranges[1].min, least + 1e-3);
  EXPECT_LT(least, 1e8);
}

// A program that leaves TCP on, or starts it off zero, is refused where it does so.
TEST(TcpReader, Refusals) {
  const auto refusal = [](const std::string& dialect, const std::string& body) {
    const machines::Machine m = tcp_machine(dialect);
    const auto control = controls::control_of(m, standing(), tools());
    const std::string start =
        dialect == "fanuc"
            ? "%\nO1 (X)\nG21 G17 G90 G94 G40 G80 G69\nG61\nG54\n(OP 0 finishing)\nG0 G49 G53 Z500.\nT1 M6\nS100 M3\n"
            : "G21 G17 G90 G94 G40 G49 G80 G61\nG54\n(OP 0 finishing)\nG53 G0 Z500\nT1 M6\nS100 M3\nG43 H1\n";
    const auto r = readback::execute_nc(start + body + (dialect == "fanuc" ? "M30\n%\n" : "M2\n"), "p", *control,
                                        [](const readback::ExecutedMove&) {});
    return r ? std::string("none") : r.error().text();
  };
  EXPECT_EQ(
      refusal("fanuc",
              "G0 C0. A0.\nG0 X0. Y0.\nG0 G43.4 H1 Z300.\nG1 A10. F100.\nG0 X1. Y1. Z301.\nG0 G49 G53 Z500.\nM5\n"),
      "none");
  EXPECT_NE(refusal("fanuc", "G0 C10. A0.\nG0 X0. Y0.\nG0 G43.4 H1 Z300.\n").find("away from zero"), std::string::npos);
  EXPECT_NE(refusal("fanuc", "G0 C0. A0.\nG0 X0. Y0.\nG0 G43.4 H1 Z300. X1.\n").find("Z alone"), std::string::npos);
  EXPECT_NE(refusal("fanuc", "G0 C0. A0.\nG0 X0. Y0.\nG0 G43.4 H1 Z300.\nG49\n").find("must stand with G53"),
            std::string::npos);
  EXPECT_NE(refusal("fanuc", "G0 C0. A0.\nG0 X0. Y0.\nG0 G43.4 H1 Z300.\nM5\n").find("end with TCP on"),
            std::string::npos);
  EXPECT_NE(refusal("linuxcnc", "M428\n").find("did not set"), std::string::npos);
  EXPECT_NE(
      refusal("linuxcnc", "G0 C0 A0\nG0 X0 Y0\nG0 Z300\nM428\nG53 G0 Z500\n").find("machine coordinates with TCP on"),
      std::string::npos);
  // What says how Siemens turns the tool between the ends of a block: not left to the last program.
  const std::string text = nc_text({sample_path(0.3, 0.6)}, tcp_machine("siemens"), standing(), 9)->text;
  const auto siemens = controls::control_of(tcp_machine("siemens"), standing(), tools());
  for (const char* word : {"none", "ORIWKS", "ORIAXES"})
    for (std::size_t at = text.find("\nTRAORI\n"); at != std::string::npos; at = text.find("\nTRAORI\n", at + 1)) {
      std::string edited = text;
      if (const auto line = text.find(std::string("\n") + word + "\n", at); line != std::string::npos)
        edited.erase(line, std::string(word).size() + 1);
      const auto r = readback::execute_nc(edited, "p", *siemens, [](const readback::ExecutedMove&) {});
      EXPECT_EQ(bool(r), edited == text) << word;
      if (edited != text) {
        EXPECT_NE(r.error().text().find(std::string("behind TRAORI without ") + word), std::string::npos)
            << r.error().text();
      }
    }
  EXPECT_NE(refusal("linuxcnc", "M430\n").find("M430 is not in the subset"), std::string::npos);
  machines::Machine without = trunnion();
  without.post.tcp_on = {"M428"};
  const auto control = controls::control_of(without, standing(), tools());
  const auto r = readback::execute_nc("G21\nG54\nM428\nM2\n", "p", *control, [](const readback::ExecutedMove&) {});
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().text(), "p:3:1: error: TCP on a machine without TCP (tcp = \"none\")");
}

// Links over the part take the whole tool: a holder that hangs below the tip while the tool leans stays above it.
TEST(LinksWithTcp, TakeTheWholeToolOverThePart) {
  tool::ToolAssembly stubby = tools()[0];
  stubby.flute_length_mm = 10;
  stubby.shank_diameter_mm = 4;
  stubby.stick_out_mm = 18;
  stubby.holder = {{40, 50, 25}};
  const std::vector<tool::ToolAssembly> list{stubby};
  const auto apt = controls::read_machine(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/apt_free.toml");
  ASSERT_TRUE(apt.machine);
  for (const machines::Machine& m : {tcp_machine("fanuc"), *apt.machine}) {
    const auto dialect = controls::dialect_of(m);
    ASSERT_TRUE(dialect);
    const auto control = controls::control_of(m, standing(), list);
    ASSERT_TRUE(control);
    double start[2];
    for (const double lean : {0.3, 1.4}) {
      const std::vector<path::ClPath> paths{sample_path(lean, 0.2)};
      const auto program = joints::AxisProgramTestAccess::build(paths, list, standing(), m, 3, kBody,
                                                                controls::axis_options(*dialect, m));
      ASSERT_TRUE(program) << program.error().message;
      const auto text = text::write_nc(*program, *dialect, {});
      ASSERT_TRUE(text) << text.error().message;
      const auto back = readback::read_back(text->text, "p", *control, m, standing(), {.teeth = 3, .keep_all = true});
      ASSERT_TRUE(back) << back.error().text();
      const auto clear = readback::check_rapids(back->operations[0], *control, m, standing(), kBody, list);
      EXPECT_TRUE(clear) << m.dialect << " " << lean << ": " << (clear ? "" : clear.error().message);
      const auto& blocks = program->operations[0].teeth[0].blocks;
      const auto on =
          std::find_if(blocks.begin(), blocks.end(), [](const auto& b) { return b.kind == joints::BlockKind::tcp_on; });
      ASSERT_NE(on, blocks.end());
      start[lean > 1 ? 1 : 0] = double(on->words[2]) * std::pow(10.0, -program->format.linear_decimals);
    }
    // Of a tool that hardly leans the tip is what is low: 5 mm over the part. The holder hangs
    // 25 sin(lean) - 43 cos(lean) below it at its upper end, and keeps 1 mm.
    EXPECT_NEAR(start[0], 150 + kBody.z_max_mm + 5, 1e-3) << m.dialect;
    const double hangs = 25 * std::sin(1.4) - 43 * std::cos(1.4);
    EXPECT_NEAR(start[1], 150 + kBody.z_max_mm + 1 + hangs, 1e-3) << m.dialect;
  }
}

}  // namespace
}  // namespace toothpath
