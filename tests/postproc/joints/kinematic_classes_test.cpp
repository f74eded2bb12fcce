// Every class of five-axis kinematics, end to end: path -> joints -> text -> reader -> forward kinematics -> path; and
// which of the solutions a path takes.
#include <gtest/gtest.h>

#include <random>

#include "postproc/choice/solution.h"
#include "postproc/choice/ways.h"
#include "postproc/joints/words.h"
#include "tests/postproc/readback/nc_case.h"
#include "tests/postproc/restart/tooth_comparison.h"

namespace toothpath {
namespace {

using namespace test;

struct Class {
  const char* name;
  char first, second;
  Vec3 d1, d2;
  int in_table;  // how many of the two
  Vec3 lean;     // about which the tool leans in the test
};
void PrintTo(const Class& c, std::ostream* out) { *out << c.name; }

const Vec3 kX = Vec3::UnitX(), kY = Vec3::UnitY(), kZ = Vec3::UnitZ();
const Vec3 kSlanted = Vec3(0, 1, 1).normalized();

std::vector<Class> classes() {
  return {{"table_AC", 'C', 'A', kZ, kX, 2, kZ},
          {"table_BC", 'C', 'B', kZ, kY, 2, kZ},
          {"table_AB", 'A', 'B', kX, kY, 2, kZ},
          {"table_BA", 'B', 'A', kY, kX, 2, kZ},
          {"mixed_C_A", 'C', 'A', kZ, kX, 1, kZ},
          {"mixed_C_B", 'C', 'B', kZ, kY, 1, kZ},
          {"mixed_A_B", 'A', 'B', kX, kY, 1, kZ},
          {"head_CA", 'C', 'A', kZ, kX, 0, kZ},
          {"head_CB", 'C', 'B', kZ, kY, 0, kZ},
          {"head_AB", 'A', 'B', kX, kY, 0, kZ},
          {"nutating_table", 'C', 'B', kZ, kSlanted, 2, kZ},
          {"nutating_mixed", 'C', 'B', kZ, kSlanted, 1, kZ},
          {"nutating_head", 'C', 'B', kZ, kSlanted, 0, kZ}};
}

machines::Machine machine_of(const Class& c, int sign) {
  machines::Machine m = trunnion();
  m.name = c.name;
  machines::RotaryAxis first = m.chain.table[0], second = m.chain.table[1];
  first.letter = c.first;
  second.letter = c.second;
  first.direction = c.d1;
  second.direction = c.d2;
  first.sign = sign;
  second.sign = -sign;
  first.min_rad = second.min_rad = radians(-720);
  first.max_rad = second.max_rad = radians(720);
  second.zero_rad = radians(3);
  m.chain.table.clear();
  for (int k = 0; k < 2; ++k) {
    machines::RotaryAxis axis = k == 0 ? first : second;
    if (k < c.in_table) {
      axis.point_mm = k == 0 ? Vec3(3, -2, 40) : Vec3(1, 12.5, -31.25);
      m.chain.table.push_back(axis);
    } else {
      axis.point_mm = Vec3(2, -1.5, 160 - 20 * k);
      m.chain.head.push_back(axis);
    }
  }
  m.chain.linear[2].max_mm = 900;
  return m;
}

class KinematicClass : public testing::TestWithParam<Class> {};
INSTANTIATE_TEST_SUITE_P(All, KinematicClass, testing::ValuesIn(classes()),
                         [](const auto& c) { return std::string(c.param.name); });

TEST_P(KinematicClass, EndToEnd) {
  for (const int sign : {1, -1})
    for (const double swing : {0.0, 0.6}) {
      const machines::Machine m = machine_of(GetParam(), sign);
      ASSERT_TRUE(machines::check_chain(m.chain));
      const auto dialect = controls::dialect_of(m);
      ASSERT_TRUE(dialect);
      const path::ClPath path = sample_path(0.3, swing, 12);
      const auto program = axis_program({path}, m, standing(), 3);
      ASSERT_TRUE(program) << program.error().message;
      const auto text = text::write_nc(*program, *dialect, {});
      ASSERT_TRUE(text) << text.error().message;
      const auto control = controls::control_of(m, standing(), tools());
      ASSERT_TRUE(control);
      const auto back = readback::read_back(text->text, "p", *control, m, standing(), {.teeth = 3, .keep_all = true});
      ASSERT_TRUE(back) << back.error().text();
      const auto motions =
          readback::tool_motions(back->operations[0], back->copies, *control, m, standing(), 3, {1e-4, 1e-4});
      ASSERT_TRUE(motions);
      for (int k = 0; k < 3; ++k) {
        const auto met =
            compare_tooth(*motions, k, 3, path, program->rounding_bound_mm + program->chord_bound_mm + 1e-4, 2e-3);
        ASSERT_TRUE(met.complete) << "tooth " << k << ": " << met.message;
        EXPECT_LE(met.worst_mm, program->rounding_bound_mm + 1e-6);
        EXPECT_LE(met.worst_axis_rad, 4e-7);
      }
      const auto rapids = readback::check_rapids(back->operations[0], *control, m, standing(), kBody);
      EXPECT_TRUE(rapids) << (rapids ? "" : rapids.error().message);
    }
}

// forward(inverse) of random poses, also next to the pole.
TEST_P(KinematicClass, ForwardOfInverse) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> mm(-400, 400), turn(-kPi, kPi), decade(-14, 0.3);
  for (const int sign : {1, -1}) {
    const machines::KinematicChain chain = machine_of(GetParam(), sign).chain;
    for (int i = 0; i < 4000; ++i) {
      machines::Joints j{
          Vec3(mm(random), mm(random), mm(random)),
          {turn(random), chain.rotary(1).zero_rad + (i % 2 == 0 ? turn(random) : std::pow(10.0, decade(random)))}};
      const machines::TablePose pose = chain.forward(j, 110);
      const auto found = chain.inverse(pose, 110);
      ASSERT_TRUE(found) << found.error().message;
      for (const auto& s : *found) {
        const machines::TablePose back = chain.forward(s.joints, 110);
        ASSERT_LE((back.axis - pose.axis).norm(), 1e-12);
        ASSERT_LE((back.tip_mm - pose.tip_mm).norm(), 1e-9);
      }
    }
  }
}

/// Classes whose pole lies along the gear axis.
std::vector<Class> classes_with_upright_pole() {
  std::vector<Class> out;
  for (const Class& c : classes())
    if (c.d1.z() == 1) out.push_back(c);
  return out;
}
class KinematicPole : public testing::TestWithParam<Class> {};
INSTANTIATE_TEST_SUITE_P(All, KinematicPole, testing::ValuesIn(classes_with_upright_pole()),
                         [](const auto& c) { return std::string(c.param.name); });

// The pole is passed by every option that changes axes, within its bound.
TEST_P(KinematicPole, ThroughIt) {
  const machines::Machine base = machine_of(GetParam(), 1);
  for (const machines::PoleOption option : {machines::PoleOption::slow, machines::PoleOption::hold,
                                            machines::PoleOption::through, machines::PoleOption::retract}) {
    machines::Machine m = base;
    m.post.pole = option;
    path::ClPath path = sample_path(0.0, 0, 9);
    path.records.resize(12);  // one pass
    for (std::size_t i = 0; i < path.records.size(); ++i) {
      const double t = std::clamp((static_cast<double>(i) - 1) / 9, 0.0, 1.0);
      path.records[i].axis = Vec3(0.05 - 0.1 * t, 1e-4, 1).normalized();
    }
    const auto program = axis_program({path}, m, standing(), 1);
    ASSERT_TRUE(program) << static_cast<int>(option) << program.error().message;
    EXPECT_EQ(program->pole_passages, 1u);
    joints::AxisWords words(m.chain, program->format, program->work_offset_at_mm);
    words.set_length(95);
    const auto& blocks = program->operations[0].teeth[0].blocks;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      if (blocks[i].kind != joints::BlockKind::feed) continue;
      const machines::Joints a = words.joints(blocks[i - 1]), b = words.joints(blocks[i]);
      for (std::size_t k = 0; k < 2; ++k)
        ASSERT_LE(std::abs(b.rotary_rad[k] - a.rotary_rad[k]) / blocks[i].minutes,
                  m.chain.rotary(k).max_speed * (1 + 1e-9));
      // On the great circle x-z, but for the bound.
      for (int s = 0; s <= 10; ++s) {
        machines::Joints j;
        j.linear_mm = a.linear_mm + (b.linear_mm - a.linear_mm) * s / 10.0;
        for (std::size_t k = 0; k < 2; ++k)
          j.rotary_rad[k] = a.rotary_rad[k] + (b.rotary_rad[k] - a.rotary_rad[k]) * s / 10.0;
        const Vec3 u = m.chain.forward(j, 95).axis;
        ASSERT_LE(std::abs(u.y()), 1e-4 + program->pole_axis_rad + 1e-3) << static_cast<int>(option);
      }
    }
  }
}

// Which solution a path takes: postproc 2.5.
choice::RotaryRange range(double low, double high) { return {radians(low), radians(high)}; }

path::ClPath around(double from_deg, double to_deg, int steps) {
  path::ClPath path = sample_path(0.3, 0, 1);
  path.records.clear();
  for (int i = 0; i <= steps; ++i) {
    const Vec3 axis = leaning(0.3, radians(from_deg + (to_deg - from_deg) * i / steps));
    if (i == 0) path.records.push_back({Vec3(100, 0, 30), axis, 0, path::MoveKind::rapid, 0, 0});
    path.records.push_back({Vec3(100, 0, -3 + 0.01 * i), axis, 500, path::MoveKind::feed, 0, 0});
  }
  return path;
}

// 1, 2: across C = 180 deg, 359 -> 1 and 1 -> 359, for both pairs: no jump, the tilt keeps its sign.
TEST(SolutionChoice, NoFlipAcrossHalfOrWholeTurns) {
  const machines::Machine m = trunnion();
  for (const auto& [from, to] : {std::pair{170.0, 190.0},
                                 {190.0, 170.0},
                                 {-190.0, -170.0},
                                 {350.0, 370.0},
                                 {370.0, 350.0},
                                 {80.0, 100.0},
                                 {260.0, 280.0},
                                 {-10.0, 10.0}})
    for (const bool positive : {true, false}) {
      const std::array<choice::RotaryRange, 2> ranges = {range(-3600, 3600), positive ? range(1, 60) : range(-110, -1)};
      const auto angles =
          choice::choose_rotaries(around(from, to, 20), Mat3::Identity(), m.chain, ranges, machines::PoleOption::error);
      ASSERT_TRUE(angles) << angles.error().message;
      for (std::size_t i = 1; i < angles->size(); ++i) {
        EXPECT_LE(std::abs((*angles)[i][0] - (*angles)[i - 1][0]), radians(1.01));
        EXPECT_EQ((*angles)[i][1] > 0, positive);
      }
      EXPECT_NEAR(std::abs((*angles).back()[0] - (*angles).front()[0]), radians(20), 1e-9);
    }
}

// 1: no candidate: both solutions and the range are named.
TEST(SolutionChoice, NoCandidateNamesBoth) {
  const auto refused = choice::choose_rotaries(around(0, 10, 5), Mat3::Identity(), trunnion().chain,
                                               {range(-3600, 3600), range(-10, 10)}, machines::PoleOption::error);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("A = "), std::string::npos);
  EXPECT_NE(refused.error().message.find("limits.limit_margin_angle = 100 deg; the other solution A = "),
            std::string::npos)
      << refused.error().message;
}

// The ways from tooth to tooth that take the least time, against all there are.
TEST(SolutionChoice, WaysFromToothToToothTakeTheLeastTime) {
  std::mt19937 random(190);
  std::uniform_real_distribution<double> angle(-kPi, kPi), minutes(0, 0.001);
  for (int trial = 0; trial < 50; ++trial) {
    machines::Machine m = trunnion();
    m.chain.table[0].rollover = trial % 3 == 0;
    std::vector<std::vector<choice::ToothWay>> teeth(5);
    std::size_t all = 1;
    for (auto& ways : teeth) {
      ways.resize(1 + random() % 4);
      all *= ways.size();
      for (auto& way : ways) way = {{angle(random), angle(random)}, {angle(random), angle(random)}, minutes(random)};
    }
    const choice::RotaryPair from = {angle(random), angle(random)};
    const auto time = [&](const std::vector<std::size_t>& chosen) {
      double sum = 0;
      choice::RotaryPair at = from;
      for (std::size_t n = 0; n < teeth.size(); ++n) {
        const auto& way = teeth[n][chosen[n]];
        double turn = 0;
        for (std::size_t k = 0; k < 2; ++k) {
          double d = std::abs(way.begin[k] - at[k]);
          if (m.chain.table[k].rollover) d = std::min(std::fmod(d, kTwoPi), kTwoPi - std::fmod(d, kTwoPi));
          turn = std::max(turn, d / m.chain.table[k].max_speed);
        }
        sum += turn + way.minutes;
        at = way.end;
      }
      return sum;
    };
    double least = 1e300;
    for (std::size_t code = 0; code < all; ++code) {
      std::vector<std::size_t> chosen;
      std::size_t rest = code;
      for (const auto& ways : teeth) {
        chosen.push_back(rest % ways.size());
        rest /= ways.size();
      }
      least = std::min(least, time(chosen));
    }
    EXPECT_NEAR(time(choice::choose_ways(teeth, from, m.chain)), least, 1e-12);
  }
}

// 2: between passes the quicker of both pairs: a half turn of C costs more than twice the tilt.
TEST(SolutionChoice, PairsMayChangeBetweenPasses) {
  machines::Machine m = trunnion();
  m.chain.table[0].max_speed = radians(100);
  m.chain.table[1].max_speed = radians(100000);
  path::ClPath path = around(0, 20, 10);
  const path::ClPath opposite = around(180, 200, 10);
  path.records.insert(path.records.end(), opposite.records.begin(), opposite.records.end());
  const auto angles = choice::choose_rotaries(path, Mat3::Identity(), m.chain, {range(-3600, 3600), range(-110, 60)},
                                              machines::PoleOption::error);
  ASSERT_TRUE(angles);
  EXPECT_LT((*angles)[5][1] * (*angles)[17][1], 0) << "A goes to the other side, C hardly moves";
  EXPECT_LT(std::abs((*angles)[12][0] - (*angles)[11][0]), radians(25));
}

// 3, danger 13: forty turns of C in forty passes, limits of ten turns: unwound between passes alone, by whole turns, as
// little as it takes.
TEST(SolutionChoice, FortyTurnsAreUnwoundAtRetracts) {
  path::ClPath path;
  path.operation_type = "finishing";
  path.spindle_rpm = 8000;
  for (int pass = 0; pass < 40; ++pass) {
    const path::ClPath turn = around(0, 360, 36);
    path.records.insert(path.records.end(), turn.records.begin(), turn.records.end());
  }
  const std::array<choice::RotaryRange, 2> ranges = {range(-1800, 1800),
                                                     range(-110, -1)};  // one pair alone: whole turns
  const auto angles =
      choice::choose_rotaries(path, Mat3::Identity(), trunnion().chain, ranges, machines::PoleOption::error);
  ASSERT_TRUE(angles) << angles.error().message;
  int unwound = 0;
  double way = 0;
  for (std::size_t i = 1; i < angles->size(); ++i) {
    const double step = (*angles)[i][0] - (*angles)[i - 1][0];
    ASSERT_LE(std::abs((*angles)[i][0]), radians(1800) + 1e-9);
    if (path.records[i].kind == path::MoveKind::rapid) {
      EXPECT_NEAR(std::remainder(step, 2 * kPi), 0, 1e-9);
      unwound += std::abs(step) > 1;
      way += std::abs(step);
    } else {
      ASSERT_LE(std::abs(step), radians(10.1));
    }
  }
  // As many whole turns fit as the first angle leaves room for; the rest of the forty must be unwound somewhere.
  const double first = degrees(std::remainder((*angles)[0][0], 2 * kPi));
  const double fits = std::floor((1800 - first) / 360) + std::floor((1800 + first) / 360);
  EXPECT_GE(unwound, 3);
  EXPECT_NEAR(way, (40 - fits) * 2 * kPi, 1e-6);
}

// 5: the angle of tooth k from integers: no drift after 997 teeth.
TEST(SolutionChoice, IndexDoesNotDrift) {
  for (const int z : {89, 997}) {
    const auto program = axis_program({sample_path(0.2, 0, 2)}, trunnion(), standing(), z, true);
    ASSERT_TRUE(program) << program.error().message;
    const auto& teeth = program->operations[0].teeth;
    ASSERT_EQ(teeth.size(), static_cast<std::size_t>(z));
    for (int k = 0; k < z; ++k) {
      const auto& b = teeth[static_cast<std::size_t>(k)].blocks.back();
      const double index = static_cast<double>(b.words[3] - teeth[0].blocks.back().words[3]) * 1e-5;
      ASSERT_LE(std::abs(std::remainder(index - program->index_sign * 360.0 * k / z, 360)), 0.5e-5 + 1e-9) << k;
    }
  }
}

}  // namespace
}  // namespace toothpath
