#include "postproc/readback/reader.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "tests/postproc/readback/nc_case.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;

struct Outcome {
  std::string error;
  readback::ReadBack back;
  readback::ClComparison comparison;
  std::string rapids;
  std::vector<path::ToolMotion> motions;
};

Outcome examine(const std::string& text, const std::vector<path::ClPath>& paths, const machines::Machine& machine,
                const toothpath::joints::Setup& setup, int teeth, const machines::Machine* reading_machine = nullptr,
                double tolerance = 1.5e-3, const std::vector<tool::ToolAssembly>& tool_list = tools()) {
  const machines::Machine& m = reading_machine != nullptr ? *reading_machine : machine;
  Outcome out;
  auto control = controls::control_of(m, setup, tool_list);
  auto back = readback::read_back(text, "p.nc", *control, m, setup, {.teeth = teeth});
  if (!back) {
    out.error = back.error().text();
    return out;
  }
  out.back = std::move(*back);
  for (const auto& trace : out.back.operations) {
    auto motions = readback::tool_motions(trace, out.back.copies, *control, m, setup, teeth, {2e-4, 1e-4});
    if (!motions) {
      out.error = motions.error().text();
      return out;
    }
    out.motions.insert(out.motions.end(), motions->begin(), motions->end());
    const auto r = readback::check_rapids(trace, *control, m, setup, kBody);
    if (!r) out.rapids = r.error().message;
  }
  std::vector<const path::ClPath*> list;
  for (const auto& p : paths) list.push_back(&p);
  out.comparison = readback::compare_with_cl(out.motions, list, tolerance, 1e-3);
  return out;
}

bool clean(const Outcome& o) {
  return o.error.empty() && o.comparison.complete && o.comparison.fastest_ratio < 1.05 && o.rapids.empty();
}

struct Variant {
  const char* dialect;
  double lean, swing;
  bool expand, eccentric;
};

class RoundTrip : public testing::TestWithParam<Variant> {};
INSTANTIATE_TEST_SUITE_P(
    Variants, RoundTrip,
    testing::Values(Variant{"linuxcnc", 0, 0, false, false}, Variant{"linuxcnc", 0.3, 0, false, false},
                    Variant{"linuxcnc", 0.3, 0.4, false, false}, Variant{"linuxcnc", 0.3, 0.4, true, false},
                    Variant{"linuxcnc", 0.3, 0.4, false, true}, Variant{"fanuc", 0, 0, false, false},
                    Variant{"fanuc", 0.3, 0, false, false}, Variant{"fanuc", 0.3, 0.4, false, false},
                    Variant{"fanuc", 0.2, 0.1, true, true}));

// Text -> joints -> poses: every record of the path met in order, teeth proven to be copies, times those of the
// program.
TEST_P(RoundTrip, MeetsEveryRecord) {
  const Variant v = GetParam();
  const machines::Machine m = with_dialect(trunnion(), v.dialect);
  toothpath::joints::Setup s = standing();
  if (v.eccentric) s.origin_mm += Vec3(2, 1, 0);
  const std::vector<path::ClPath> paths = {sample_path(v.lean, v.swing), sample_path(v.lean, v.swing, 25, 1)};
  const auto program = axis_program(paths, m, s, 6, v.expand);
  ASSERT_TRUE(program) << program.error().message;
  const auto text = text::write_nc(*program, *controls::dialect_of(m), {});
  ASSERT_TRUE(text) << text.error().message;
  const Outcome o = examine(text->text, paths, m, s, 6);
  ASSERT_EQ(o.error, "");
  EXPECT_TRUE(o.comparison.complete) << o.comparison.message;
  EXPECT_LE(o.comparison.worst_mm, program->rounding_bound_mm + 1e-9);
  EXPECT_LE(o.comparison.worst_extra_mm, 5e-4 * 1.1 + program->rounding_bound_mm);
  EXPECT_LT(o.comparison.fastest_ratio, 1.03);
  EXPECT_GT(o.comparison.fastest_ratio, 0.9);
  EXPECT_EQ(o.rapids, "");
  if (program->loop) { EXPECT_TRUE(o.back.copies.copies) << o.back.copies.difference; }
  EXPECT_NEAR(o.back.feed_minutes, program->feed_minutes, 2e-3 * program->feed_minutes);
  for (std::size_t a = 0; a < program->ranges.size(); ++a) {
    const auto& r = program->ranges[a];
    const double scale = r.rotary ? degrees(1) : 1;
    EXPECT_NEAR(o.back.least[a], r.min * scale, 1e-3) << r.letter;
    EXPECT_NEAR(o.back.greatest[a], r.max * scale, 1e-3) << r.letter;
  }
  for (const auto& motion : o.motions) {
    EXPECT_LE(motion.deviation_mm,
              (motion.rapid ? 50 : 1) * 2e-4 * 1.2 + (motion.rapid ? 0 : words_of("linuxcnc").exact_path_mm) + 1e-8);
    EXPECT_GE(motion.tooth, 0);
    EXPECT_LT(motion.tooth, 6);
  }
}

// 360/7 deg does not end after three decimals: the other teeth stand off by the rounding, and the kept one answers for
// them.
TEST(ToolMotions, RoundedIndexAnglesCountAsDeviation) {
  const machines::Machine m = with_dialect(trunnion(), "fanuc");
  const std::vector<path::ClPath> paths = {sample_path(0.3, 0)};
  for (const int teeth : {7, 6}) {
    const auto program = axis_program(paths, m, standing(), teeth, false);
    ASSERT_TRUE(program) << program.error().message;
    const auto text = text::write_nc(*program, *controls::dialect_of(m), {});
    ASSERT_TRUE(text) << text.error().message;
    const Outcome o = examine(text->text, paths, m, standing(), teeth);
    ASSERT_EQ(o.error, "");
    ASSERT_TRUE(o.back.copies.copies) << o.back.copies.difference;
    const double shift = radians(o.back.copies.worst_shift_deg);
    if (teeth == 7) {
      EXPECT_GT(shift, radians(1e-4));
    } else {
      EXPECT_LT(shift, 1e-12);
    }
    for (const auto& motion : o.motions) EXPECT_GE(motion.deviation_mm, shift * motion.tip_to.head<2>().norm());
  }
}

// The proven bound of a motion holds: the true tip, sampled with other kinematics, stays within it.
TEST(ToolMotions, DeviationIsABound) {
  const machines::Machine m = trunnion();
  const auto control = controls::control_of(m, standing(), tools());
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  double largest_share = 0;
  for (int trial = 0; trial < 200; ++trial) {
    readback::OperationTrace trace;
    readback::ExecutedMove a, b;
    a.known = b.known = true;
    a.tool = b.tool = 1;
    a.joints = {200 * u(random), 200 * u(random), 250 + 50 * u(random), 360 * u(random), 50 * u(random)};
    for (std::size_t i = 0; i < 5; ++i) b.joints[i] = a.joints[i] + (i < 3 ? 5 : 4) * u(random);
    trace.moves = {a, b};
    for (const double tolerance : {0.05, 1e-3}) {
      const auto motions = readback::tool_motions(trace, {}, *control, m, standing(), 1, {tolerance, 1e-3});
      ASSERT_TRUE(motions);
      const auto n = static_cast<int>(motions->size());
      for (int i = 0; i < n; ++i) {
        const path::ToolMotion& mo = (*motions)[static_cast<std::size_t>(i)];
        for (const double t : {0.0, 0.2, 0.5, 0.7, 1.0}) {
          const double s = (i + t) / n;
          std::array<double, 5> j{};
          for (std::size_t x = 0; x < 5; ++x) j[x] = a.joints[x] + s * (b.joints[x] - a.joints[x]);
          const auto p = trunnion_forward(kTrunnion, j[0], j[1], j[2], j[4], j[3], 95);
          const double d = (p.tip - standing().origin_mm - ((1 - t) * mo.tip_from + t * mo.tip_to)).norm();
          ASSERT_LE(d, mo.deviation_mm);
          largest_share = std::max(largest_share, d / mo.deviation_mm);
          const Vec3 blend = ((1 - t) * mo.axis_from + t * mo.axis_to).normalized();
          ASSERT_LE(std::atan2(blend.cross(p.axis).norm(), blend.dot(p.axis)), mo.axis_deviation + 1e-9);
        }
        ASSERT_LE(mo.deviation_mm, tolerance * 1.05 + 1e-8);
      }
    }
  }
  EXPECT_GT(largest_share, 0.3) << "the bound is far too wide";
}

// Planted faults of the text: the check must see each of them.
class PlantedFault : public testing::Test {
 protected:
  PlantedFault() : machine_(trunnion()), paths_{sample_path(0.3, 0.2), sample_path(0.3, 0.2, 20, 1)} {
    const auto t = nc_text(paths_, machine_, standing(), 5, true);  // all teeth as text: a fault can sit in any of them
    text_ = t->text;
    const auto loop = nc_text(paths_, machine_, standing(), 5);
    loop_text_ = loop->text;
  }
  /// Start of the n-th line that begins like this, behind `after`.
  std::size_t find_line(const std::string& begin, int n, const std::string& after = "(TOOTH 0)") const {
    std::size_t at = text_.find(after);
    for (int i = 0; i < n; ++i) at = text_.find("\n" + begin, at + 1);
    return at + 1;
  }
  std::string line_at(std::size_t at) const { return text_.substr(at, text_.find('\n', at) - at); }
  std::string with_line(std::size_t at, const std::string& line) const {
    std::string t = text_;
    t.replace(at, text_.find('\n', at) - at, line);
    return t;
  }
  Outcome outcome(const std::string& text) const { return examine(text, paths_, machine_, standing(), 5); }
  static std::string replaced_word(const std::string& line, char letter, const std::function<double(double)>& f) {
    const auto at = line.find(letter);
    std::size_t used = 0;
    const double v = std::stod(line.substr(at + 1), &used);
    return line.substr(0, at + 1) + fmt::format("{:.5f}", f(v)) + line.substr(at + 1 + used);
  }

  machines::Machine machine_;
  std::vector<path::ClPath> paths_;
  std::string text_, loop_text_;
};

TEST_F(PlantedFault, NoneInTheOriginal) {
  EXPECT_TRUE(clean(outcome(text_))) << outcome(text_).error << outcome(text_).comparison.message
                                     << outcome(text_).rapids;
  EXPECT_TRUE(clean(outcome(loop_text_)));
}
TEST_F(PlantedFault, OneWordChanged) {
  // Two units of the last digit: seen as distance at a tight tolerance, and as a difference of the turned copies in a
  // loop.
  const auto at = find_line("X", 12);
  const auto o = examine(with_line(at, replaced_word(line_at(at), 'X', [](double v) { return v + 2e-4; })), paths_,
                         machine_, standing(), 5, nullptr, 6e-4);
  const auto untouched = examine(text_, paths_, machine_, standing(), 5, nullptr, 6e-4);
  ASSERT_TRUE(untouched.comparison.complete) << untouched.comparison.message;
  EXPECT_GT(o.comparison.worst_mm, untouched.comparison.worst_mm + 1e-4);
  EXPECT_GT(o.comparison.worst_mm, 0.5e-4 * std::sqrt(3.0)) << "beyond the rounding bound";
  const auto big = outcome(with_line(at, replaced_word(line_at(at), 'X', [](double v) { return v + 0.01; })));
  EXPECT_FALSE(big.comparison.complete);
}
TEST_F(PlantedFault, WholeTurnOfC) {
  std::size_t at = find_line("X", 12);
  while (line_at(at).find('C') == std::string::npos) at = text_.find('\n', at) + 1;
  const auto o = outcome(with_line(at, replaced_word(line_at(at), 'C', [](double v) { return v + 360; })));
  EXPECT_FALSE(clean(o));
}
TEST_F(PlantedFault, SignOfA) {
  std::string t = text_;
  for (std::size_t at = 0; (at = t.find(" A1", at)) != std::string::npos;) t.replace(at, 3, " A-1");
  EXPECT_FALSE(clean(outcome(t)));
  EXPECT_TRUE(t != text_);
}
TEST_F(PlantedFault, SwappedRotaries) {
  std::string t = text_;
  for (std::size_t i = 0; i + 1 < t.size(); ++i)
    if (t[i] == ' ' && (t[i + 1] == 'A' || t[i + 1] == 'C') && (std::isdigit(t[i + 2]) != 0 || t[i + 2] == '-'))
      t[i + 1] = t[i + 1] == 'A' ? 'C' : 'A';
  EXPECT_FALSE(clean(outcome(t)));
}
TEST_F(PlantedFault, WrongSenseOfTheMachine) {  // danger 15
  for (std::size_t k = 0; k < 2; ++k) {
    machines::Machine wrong = machine_;
    wrong.chain.table[k].sign = 1;
    EXPECT_FALSE(clean(examine(text_, paths_, machine_, standing(), 5, &wrong))) << k;
  }
}
TEST_F(PlantedFault, ToolLongerByAQuarter) {  // danger 16: appears as 0.25 mm along the axis
  auto longer = tools();
  longer[0].length_mm += 0.25;
  // A control that adds the true length and a program that was made for another: the gauge line does not move, the tip
  // does.
  auto control = controls::control_of(machine_, standing(), tools());
  const auto back = readback::read_back(text_, "p", *control, machine_, standing(), {.teeth = 5});
  auto other = controls::control_of(machine_, standing(), longer);
  const auto a =
      readback::tool_motions(back->operations[0], back->copies, *control, machine_, standing(), 5, {1e-3, 1e-3});
  const auto b =
      readback::tool_motions(back->operations[0], back->copies, *other, machine_, standing(), 5, {1e-3, 1e-3});
  ASSERT_EQ(a->size(), b->size());
  for (std::size_t i = 0; i < a->size(); ++i)
    EXPECT_NEAR(((*a)[i].tip_to - (*b)[i].tip_to).dot((*a)[i].axis_to), 0.25, 1e-9);
  std::vector<const path::ClPath*> list = {&paths_[0]};
  const auto c = readback::compare_with_cl(*b, list, 1.5e-3, 1e-3);
  EXPECT_FALSE(c.complete);
}
TEST_F(PlantedFault, DroppedBlock) {
  const auto at = find_line("X", 12);
  std::string t = text_;
  t.erase(at, line_at(at).size() + 1);
  const auto o = outcome(t);
  EXPECT_FALSE(o.comparison.complete);
  EXPECT_EQ(o.comparison.missed_operation, 0);
}
TEST_F(PlantedFault, FeedTimesSixty) {
  const auto at = find_line("X", 12);
  const auto o = outcome(with_line(at, replaced_word(line_at(at), 'F', [](double v) { return v * 60; })));
  EXPECT_GT(o.comparison.fastest_ratio, 1.5);
  EXPECT_FALSE(clean(o));
}
TEST_F(PlantedFault, MissingG94) {
  std::string t = text_;
  for (std::size_t at; (at = t.find("G94 F1000\n")) != std::string::npos;) t.erase(at, 10);
  const auto o = outcome(t);
  EXPECT_FALSE(clean(o)) << "G93 is still on";
}
TEST_F(PlantedFault, RetractDeleted) {
  const auto up = find_line("G0", 4);  // rise behind the first pass: the block before it is the retract of the path
  const auto retract = text_.rfind('\n', up - 2) + 1;
  std::string t = text_;
  t.erase(retract, up - retract);
  EXPECT_FALSE(clean(outcome(t)));
}
TEST_F(PlantedFault, RotaryBeforeTheRetract) {
  const auto up = find_line("G0", 4);
  const auto retract = text_.rfind('\n', up - 2) + 1;
  std::string t = text_;
  t.insert(retract, "G0 C100\n");
  EXPECT_FALSE(clean(outcome(t)));
  EXPECT_NE(outcome(t).rapids, "");
}
TEST_F(PlantedFault, SecondToothDiffers) {
  const auto at = find_line("X", 12, "(TOOTH 3)");
  const auto t = with_line(at, replaced_word(line_at(at), 'Y', [](double v) { return v + 1e-4; }));
  const auto o = outcome(t);
  EXPECT_FALSE(o.back.copies.copies);
  EXPECT_EQ(o.back.copies.line,
            1 + static_cast<int>(std::count(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(at), '\n')));
}

// What is not in the subset is refused where it stands.
TEST(NcReader, RefusalsNameLineAndColumn) {
  const machines::Machine m = trunnion();
  const auto control = controls::control_of(m, standing(), tools());
  const std::string start =
      "G21 G17 G90 G94 G40 G49 G80 G61\nG54\n(OP 0 finishing)\nG53 G0 Z500\nT1 M6\nS100 M3\nG43 H1\n";
  const auto error = [&](const std::string& text) {
    readback::NcControl c = *control;
    c.max_steps = 10000;
    const auto r = readback::execute_nc(start + text, "p.ngc", c, [](const readback::ExecutedMove&) {});
    return r ? std::string("none") : r.error().text();
  };
  EXPECT_EQ(error("G0 X1\nM5\nM2\n"), "none");
  const std::pair<const char*, const char*> cases[] = {
      {"G2 X1 Y1 I1\n", "p.ngc:8:1: error: G2 is not in the subset"},
      {"G0 X1 G91\n",
       "p.ngc:8:4: error: axis words in G91: steps are read with G28 and G30 alone, G90 must be said again"},
      {"G0 X1 X2\n", "p.ngc:8:7: error: two X words in a block"},
      {"G0 X1 (a (b) c)\n", "p.ngc:8:7: error: comment inside a comment"},
      {"G0 X1e3\n", "p.ngc:8:6: error: word E is not in the subset"},
      {"G0 X.\n", "p.ngc:8:5: error: number without digits"},
      {"G93\nG1 X1\n", "p.ngc:9:4: error: G1 in G93 without F"},
      {"G0 U1\n", "p.ngc:8:4: error: word U is not in the subset or no axis of the machine"},
      {"G0 X#7\n", "p.ngc:8:4: error: parameter #7 was never set"},
      {"G0 X[1/0]\n", "p.ngc:8:4: error: division by zero"},
      {"o100 call [1]\n", "p.ngc:8:1: error: o100 is not defined"},
      {"o100 while [1]\n", "p.ngc:8:1: error: o100 is never closed"},
      {"o100 while [1]\no100 endwhile\n",
       "p.ngc:8:1: error: o100: the loop never ends: after 1 turns no parameter has another value"},
      {"G49\nG0 Z1\n", "p.ngc:9:4: error: Z word without tool length compensation"},
      {"T1 M6\n", "p.ngc:8:1: error: tool change while the spindle turns"},
      {"G64\n", "G64 without P leaves the path without limit"},
      {"G64 P0 Q0\n", "G64 P0 leaves the path without limit"},
      {"G64 P-0.001\n", "P and Q of G64 must not be negative"},
      {"G64 P0.001 Q-1\n", "P and Q of G64 must not be negative"},
      {"G64 P0.001 Q0\nG0 A0 C0\nG0 X1 Y1\nG0 Z1\nG1 X2 F100\nG1 X1 C5\n",
       "p.ngc:13:7: error: G64 bounds X, Y and Z alone, this G1 turns a rotary axis: G61 or G61.1 is needed"},
      {"T9 M6\n", "tool 9 is not in the tool list"},
      {"G55\n", "work offset G55 is not defined"},
      {"M2\n", "program end while the spindle turns"},
      {"G0 X1\n", "the program ends without M2 or M30"},
      {"G0 X1\nM5\nM2\nG0 X2\n", "p.ngc:11:1: error: text behind the end"},
      {"G0 X\xC3\xA9\n", "p.ngc:8:5: error: number without digits"},
      {"o1 sub\no1 call\no1 endsub\n", ""},
  };
  for (const auto& [text, expected] : cases) {
    const std::string e = error(text);
    EXPECT_NE(e, "none") << text;
    EXPECT_NE(e.find(expected), std::string::npos) << text << " gave " << e;
  }
  std::string unsaid = start + "G1 X1 F100\n";
  unsaid.erase(unsaid.find(" G61"), 4);
  const auto r = readback::execute_nc(unsaid, "p.ngc", *control, [](const readback::ExecutedMove&) {});
  ASSERT_FALSE(r);
  EXPECT_EQ(r.error().text(),
            "p.ngc:8:4: error: G1 ahead of G61, G61.1 or G64 P: how far the control leaves the path would depend on "
            "the last program");
}

// Any bytes give an answer: mutations of a good program neither crash nor hang.
TEST(NcReader, SurvivesMutations) {
  const machines::Machine m = trunnion();
  auto control = controls::control_of(m, standing(), tools());
  control->max_steps = 20000;
  const auto good = nc_text({sample_path(0.3, 0.2, 4)}, m, standing(), 3)->text;
  std::mt19937 random(99);
  int refused = 0;
  for (int i = 0; i < 3000; ++i) {
    const std::string t = damaged(good, random, 1 + i % 4, "GMXYZACFo#[]0123456789.-");
    const auto r = readback::read_back(t, "p", *control, m, standing(), {.teeth = 3});
    refused += r ? 0 : 1;
    if (!r) { EXPECT_FALSE(r.error().message.empty()); }
  }
  EXPECT_GT(refused, 1000);
}

TEST(NcReader, MotionsThatCannotBeFollowedNameTheirLine) {
  const machines::Machine m = trunnion();
  const auto control = controls::control_of(m, standing(), tools());
  const std::string text = nc_text({sample_path(0.3, 0.2, 4)}, m, standing(), 3)->text;
  const auto back = readback::read_back(text, "p", *control, m, standing(), {.teeth = 3});
  ASSERT_TRUE(back);
  const auto motions =
      readback::tool_motions(back->operations[0], back->copies, *control, m, standing(), 3, {1e-14, 1e-14});
  ASSERT_FALSE(motions);
  EXPECT_GT(motions.error().position.line, 1);
  EXPECT_EQ(motions.error().message, "this move turns too far to be followed within 1e-14 mm");
}

// A long index loop is executed without keeping it: only one tooth stays in memory.
TEST(NcReader, KeepsOneToothOfALongLoop) {
  const std::vector<path::ClPath> paths = {sample_path(0.3, 0.0, 1500)};
  const auto t = nc_text(paths, trunnion(), standing(), 180);
  ASSERT_TRUE(t) << t.error().message;
  const Outcome o = examine(t->text, paths, trunnion(), standing(), 180);
  ASSERT_EQ(o.error, "");
  EXPECT_TRUE(o.back.copies.copies) << o.back.copies.difference;
  EXPECT_GT(o.back.executed, 180u * 3000u);
  EXPECT_LT(o.back.operations[0].moves.size(), 3200u);
  EXPECT_TRUE(o.comparison.complete) << o.comparison.message;
  ASSERT_EQ(o.back.copies.operations[0].turns.size(), 180u);
  for (int k = 0; k < 180; ++k) EXPECT_EQ(o.back.copies.operations[0].turns[static_cast<std::size_t>(k)], k);
}

}  // namespace
}  // namespace toothpath
