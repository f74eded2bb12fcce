// The order of the teeth: every tooth once, far from the last one, angles from integers, the same in every dialect.
#include <gtest/gtest.h>

#include <numeric>
#include <regex>
#include <set>
#include <tuple>

#include "tests/postproc/text/post_forms.h"
#include "tests/support/rs274.h"

namespace toothpath {
namespace {

using namespace test;

/// Largest gap between cut teeth, as a multiple of the mean gap, at the worst moment.
double worst_gap(int teeth, int stride) {
  std::set<int> cut;
  double worst = 0;
  for (int n = 0; n + 1 < teeth; ++n) {
    cut.insert(joints::tooth_of_place(n, stride, teeth));
    if (n == 0) continue;
    int gap = *cut.begin() + teeth - *cut.rbegin();
    for (auto a = cut.begin(), b = std::next(a); b != cut.end(); ++a, ++b) gap = std::max(gap, *b - *a);
    worst = std::max(worst, static_cast<double>(gap) * static_cast<double>(cut.size()) / teeth);
  }
  return worst;
}

TEST(ToothOrder, MeetsEveryToothOnce) {
  for (int z = 1; z <= 400; ++z) {
    const int s = joints::spread_stride(z);
    std::vector<bool> met(static_cast<std::size_t>(z), false);
    for (int n = 0; n < z; ++n) {
      const int k = joints::tooth_of_place(n, s, z);
      ASSERT_FALSE(met[static_cast<std::size_t>(k)]) << z;
      met[static_cast<std::size_t>(k)] = true;
      ASSERT_EQ(joints::place_of_tooth(k, s, z), n);
    }
  }
  for (const int z : {1, 2, 3, 4, 6}) EXPECT_EQ(joints::spread_stride(z), 1) << z;
}

TEST(ToothOrder, CutTeethDivideTheCircleEvenly) {
  for (int z = 5; z <= 130; ++z) {
    if (z == 6) continue;
    EXPECT_LE(worst_gap(z, joints::spread_stride(z)), 2.5) << z;
    if (z > 12) { EXPECT_GT(worst_gap(z, 1), 2.5) << z; }
  }
}

/// Largest partial quotient of teeth / stride, in the continued fraction that ends with a 1.
int largest_partial_quotient(int teeth, int stride) {
  int largest = 0;
  for (int a = teeth, b = stride; b != 0;) {
    const int quotient = a / b, rest = a % b;
    largest = std::max(largest, rest == 0 && quotient > 1 ? quotient - 1 : quotient);
    a = b;
    b = rest;
  }
  return largest;
}

// Among all strides up to half a turn that meet every tooth: the least largest quotient, and of those the nearest to
// the golden section.
TEST(ToothOrder, StrideIsTheBestOfAll) {
  const double golden = (3 - std::sqrt(5.0)) / 2;
  for (int z = 5; z <= 400; ++z) {
    std::vector<std::tuple<int, double, int>> all;
    for (int s = 1; 2 * s <= z; ++s)
      if (std::gcd(s, z) == 1) all.emplace_back(largest_partial_quotient(z, s), std::abs(s - golden * z), s);
    EXPECT_EQ(joints::spread_stride(z), std::get<2>(*std::min_element(all.begin(), all.end()))) << z;
  }
}

TEST(ToothOrder, TurnsAreCounted) {
  for (const int z : {2, 7, 60, 88}) {
    EXPECT_EQ(joints::pitches_turned(0, z, 1, z), z - 1);
    const int s = joints::spread_stride(z);
    double sum = 0;
    for (int n = 1; n < z; ++n) sum += std::abs(n * s % z - (n - 1) * s % z);
    EXPECT_EQ(joints::pitches_turned(0, z, s, z), sum);
    EXPECT_EQ(joints::pitches_turned(z - 1, z, s, z), 0);
  }
}

class SpreadOrder : public testing::TestWithParam<PostForm> {};
INSTANTIATE_TEST_SUITE_P(Forms, SpreadOrder, testing::ValuesIn(post_forms()));

// The text, executed, cuts the teeth in the spread order; every record of the path is met; the index is off by half a
// digit at most.
TEST_P(SpreadOrder, IsExecutedInEveryDialect) {
  const PostForm& f = GetParam();
  const machines::Machine m = machine_of(f);
  const int teeth = 7, stride = joints::spread_stride(teeth);
  ASSERT_EQ(stride, 3);
  const std::vector<path::ClPath> paths = {sample_path(0.3, f.swing, 3), sample_path(0.3, f.swing, 4, 1)};
  const auto program = program_of(f, paths, teeth, stride);
  ASSERT_TRUE(program) << program.error().message;
  const auto sequence = program_of(f, paths, teeth, 1);
  ASSERT_TRUE(sequence);
  EXPECT_EQ(program->loop, sequence->loop);
  EXPECT_EQ(program->rounding_bound_mm, sequence->rounding_bound_mm);
  EXPECT_NEAR(program->feed_minutes, sequence->feed_minutes, 1e-12);
  const auto text = text_of(f, *program);
  ASSERT_TRUE(text) << text.error().message;

  const auto control = controls::control_of(m, standing(), tools());
  ASSERT_TRUE(control);
  const auto back = readback::read_back(text->text, "p", *control, m, standing(), {.teeth = teeth});
  ASSERT_TRUE(back) << back.error().text();
  ASSERT_EQ(back->operations.size(), 2u);
  std::vector<path::ToolMotion> all;
  for (const auto& trace : back->operations) {
    const auto motions = readback::tool_motions(trace, back->copies, *control, m, standing(), teeth, {2e-4, 1e-4});
    ASSERT_TRUE(motions) << motions.error().message;
    const auto clear = readback::check_rapids(trace, *control, m, standing(), kBody);
    EXPECT_TRUE(clear) << (clear ? "" : clear.error().message);
    all.insert(all.end(), motions->begin(), motions->end());
  }
  const std::vector<const path::ClPath*> list = {&paths[0], &paths[1]};
  const auto met =
      readback::compare_with_cl(all, list, program->rounding_bound_mm + program->chord_bound_mm + 1e-3, 2e-3);
  EXPECT_TRUE(met.complete) << met.message << "; copies: " << back->copies.line << ": " << back->copies.difference;

  std::vector<int> expected;
  for (int n = 0; n < teeth; ++n) expected.push_back(n * stride % teeth);
  if (back->copies.copies) {
    EXPECT_LE(back->copies.worst_shift_deg, control->rotary_rounding_deg * (1 + 1e-6));
    for (const auto& op : back->copies.operations) EXPECT_EQ(op.turns, expected) << op.operation;
  } else {
    std::vector<int> order;
    for (const auto& motion : all)
      if (motion.operation == 0 && !motion.rapid && (order.empty() || order.back() != motion.tooth))
        order.push_back(motion.tooth);
    EXPECT_EQ(order, expected);
  }
}

// The remainder is exact for whole numbers, also where the quotient is a whole number.
TEST(ToothOrder, RemaindersOfTheControlsAreExact) {
  const int teeth = 997, stride = joints::spread_stride(teeth);
  for (const char* dialect : {"linuxcnc", "siemens", "heidenhain"}) {
    const PostForm f{dialect, machines::TcpMode::none, 0, false};
    const auto program = program_of(f, {sample_path(0.3, 0, 1)}, teeth, stride);
    ASSERT_TRUE(program) << program.error().message;
    ASSERT_TRUE(program->loop);
    const auto text = text_of(f, *program);
    const machines::Machine m = machine_of(f);
    const auto control = controls::control_of(m, standing(), tools());
    const auto back = readback::read_back(text->text, "p", *control, m, standing(), {.teeth = teeth});
    ASSERT_TRUE(back) << back.error().text();
    ASSERT_TRUE(back->copies.copies) << back->copies.difference;
    for (int n = 0; n < teeth; ++n)
      ASSERT_EQ(back->copies.operations[0].turns[static_cast<std::size_t>(n)], n * stride % teeth) << dialect;
    EXPECT_LE(back->copies.worst_shift_deg, control->rotary_rounding_deg) << dialect;
  }
}

// LinuxCNC's own interpreter (tools/get_rs274.sh) turns C to the same teeth, also from an edited first place on.
TEST(ToothOrder, LinuxcncAgrees) {
  const int teeth = 31, stride = joints::spread_stride(teeth);
  const auto program = axis_program({sample_path(0.3, 0, 1)}, trunnion(), standing(), teeth);
  ASSERT_TRUE(program && program->loop);
  joints::AxisProgram spread = *program;
  spread.tooth_stride = stride;
  const auto written = text::write_nc(spread, words_of("linuxcnc"), {});
  ASSERT_TRUE(written);
  for (const int first : {0, 17}) {
    const auto out =
        interpret(std::regex_replace(written->text, std::regex("\n#1=0\n"), fmt::format("\n#1={}\n", first)), "order");
    ASSERT_EQ(out.exit, 0) << out.messages;
    std::vector<double> turns;  // C of each first rotary rapid of a tooth, from the one of tooth 0
    const std::regex traverse("STRAIGHT_TRAVERSE\\(([^)]*)\\)"), moved("SET_G92_OFFSET\\((?:[-0-9.]+, ){5}([-0-9.]+)");
    double last = 0, zero = 0;
    for (const std::string& l : out.lines) {
      std::smatch m;
      if (std::regex_search(l, m, moved)) zero = std::stod(m[1]);
      if (!std::regex_search(l, m, traverse)) continue;
      const std::string words = m[1];
      const double c = zero + std::stod(words.substr(words.rfind(',') + 1));
      if (std::abs(c - last) > 1e-3) turns.push_back(c);
      last = c;
    }
    const double base = static_cast<double>(spread.operations[0].teeth[0].blocks[0].words[3]) / 1e5;
    ASSERT_EQ(turns.size(), static_cast<std::size_t>(teeth - first));
    for (int n = first; n < teeth; ++n)
      EXPECT_NEAR(turns[static_cast<std::size_t>(n - first)],
                  base + spread.index_sign * 360.0 * (n * stride % teeth) / teeth, 1.5e-4)
          << n;
  }
}

// The new words of the readers, and what they refuse.
TEST(ToothOrder, ReadersRefuseWhatIsNoRemainder) {
  const auto refusal = [](const char* dialect, const std::string& text) {
    const machines::Machine m = with_dialect(trunnion(), dialect);
    auto control = controls::control_of(m, standing(), tools());
    control->max_steps = 1000;
    const auto r = readback::execute_nc(text, "p", *control, [](const readback::ExecutedMove&) {});
    return r ? std::string("none") : r.error().text();
  };
  EXPECT_EQ(refusal("linuxcnc", "#1=[[-7] MOD 3]\no1 while [#1 LT 2]\n#1=[#1+1]\no1 endwhile\nM2\n"), "none");
  EXPECT_EQ(refusal("linuxcnc", "#1=[7 MOD 0]\nM2\n"), "p:1:1: error: remainder of a division by zero");
  EXPECT_EQ(refusal("linuxcnc", "#1=[7 MOX 3]\nM2\n"), "p:1:7: error: operator is not in the subset");
  EXPECT_EQ(refusal("siemens", "R1=7-3*TRUNC((7+0.5)/3)\nFOR R2=R1 TO 1\nENDFOR\nM30\n"), "none");
  EXPECT_EQ(refusal("siemens", "R1=INT(3.5)\nM30\n"), "p:1:4: error: a parameter that was never set, or no parameter");
  EXPECT_EQ(refusal("siemens", "R1=TRUNC(3.5\nM30\n"), "p:1:4: error: ) expected");
  const auto plain = [&](const std::string& body) {
    return refusal("heidenhain", "0 BEGIN PGM P MM\n" + body + "9 END PGM P MM\n");
  };
  EXPECT_EQ(refusal("heidenhain",
                    "0 BEGIN PGM P MM\n1 Q1 = 7.9\n2 Q1 = INT Q1\n3 LBL 1\n4 Q1 = Q1 - 1\n5 FN 12: IF +6 LT +Q1 GOTO "
                    "LBL 1\n6 M30\n7 END PGM P MM\n"),
            "none");
  EXPECT_NE(plain("1 FN 12: IF +Q1 LT +5 GOTO LBL 1\n").find("error"), std::string::npos);
  EXPECT_EQ(refusal("heidenhain", "0 BEGIN PGM P MM\n1 FN 12: IF +1 LT +5 GOTO LBL 1\n2 M30\n3 END PGM P MM\n"),
            "p:2:31: error: GOTO LBL of a label that does not exist");
  EXPECT_EQ(
      refusal("heidenhain", "0 BEGIN PGM P MM\n1 LBL 1\n2 FN 12: IF +1 LT +5 GOTO LBL 1\n3 M30\n4 END PGM P MM\n"),
      "p:3: error: more than 1000 executed blocks, the most for a program of this length: a loop without end");
}

}  // namespace
}  // namespace toothpath
