// Run time with the accelerations of the axes: closed forms, and what must hold for every program.
#include <gtest/gtest.h>

#include <random>
#include <regex>

#include "machines/machine_file.h"
#include "postproc/joints/time.h"
#include "postproc/numbers/fixed_point.h"
#include "postproc/timing/profile.h"
#include "tests/postproc/readback/nc_case.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

using namespace test;

constexpr double kPerSecond2 = 3600;  // mm/min^2 of 1 mm/s^2

/// A control whose axes jump at corners; those of LinuxCNC stand in tests/postproc/timing.
machines::Machine with_acceleration(double linear_mm_s2, double rotary_deg_s2) {
  machines::Machine m = trunnion();
  m.dialect = "fanuc";
  for (auto& axis : m.chain.linear) axis.max_acceleration = linear_mm_s2 * kPerSecond2;
  for (auto& axis : m.chain.table) axis.max_acceleration = radians(rotary_deg_s2) * kPerSecond2;
  return m;
}

joints::AxisProgram empty_program(const machines::Machine& m) {
  joints::AxisProgram p;
  p.letters = {'X', 'Y', 'Z', 'C', 'A'};
  p.time_rulers.assign(6, "");
  p.time_ruled.assign(6, 0);
  p.work_offset_at_mm = Vec3::Zero();
  (void)m;
  return p;
}

joints::AxisBlock at_x(double mm, double minutes, joints::BlockKind kind = joints::BlockKind::feed) {
  joints::AxisBlock b;
  b.words[0] = numbers::to_fixed(mm, 4);
  b.minutes = minutes;
  b.kind = kind;
  return b;
}

// One axis, one block: the trapezoid and the triangle of every textbook.
TEST(TimeEstimate, TrapezoidAndTriangle) {
  const machines::Machine m = with_acceleration(500, 1000);
  const joints::AxisProgram p = empty_program(m);
  for (const double way : {0.5, 5.0, 80.0, 300.0})
    for (const double feed : {600.0, 6000.0, 24000.0}) {
      const double v = feed / 60, a = 500;  // mm/s
      const double seconds = way >= v * v / a ? way / v + v / a : 2 * std::sqrt(way / a);
      const auto t = joints::accelerated_times({at_x(way, way / feed)}, at_x(0, 0), p, 0, m);
      EXPECT_NEAR(t[0] * 60, seconds, 1e-9 * seconds) << way << " " << feed;
    }
}

// A straight way in many blocks is the straight way; a rapid between two feeds stops twice.
TEST(TimeEstimate, BlocksOfOneLineAreOneLine) {
  const machines::Machine m = with_acceleration(800, 1000);
  const joints::AxisProgram p = empty_program(m);
  const double feed = 9000, way = 60;
  const double whole = joints::accelerated_times({at_x(way, way / feed)}, at_x(0, 0), p, 0, m)[0];
  std::vector<joints::AxisBlock> many;
  for (int i = 1; i <= 60; ++i) many.push_back(at_x(i, 1 / feed));
  double sum = 0;
  for (const double t : joints::accelerated_times(many, at_x(0, 0), p, 0, m)) sum += t;
  EXPECT_NEAR(sum, whole, 1e-9 * whole);
  many[29].kind = joints::BlockKind::rapid_xy;
  double stops = 0;
  for (const double t : joints::accelerated_times(many, at_x(0, 0), p, 0, m)) stops += t;
  const double v = feed / 60, ramp = v / 800 / 60;  // min that one stop and start costs: v / a
  EXPECT_NEAR(stops,
              whole + (timing::Profile(1, 0, 0, {feed, 800 * kPerSecond2, 0}).time() - 1 / feed - ramp) + 2 * ramp,
              1e-9 * whole + ramp * 0.02);
}

// A corner is taken at the share of the speed with which the jump is a * tau: the way back has the jump 2 v.
TEST(TimeEstimate, CornerSpeed) {
  machines::Machine m = with_acceleration(1000, 1000);
  m.min_block_ms = 4;
  const joints::AxisProgram p = empty_program(m);
  const double feed = 6000, v = feed / 60, a = 1000, way = 40;  // mm/s
  double sum = 0;
  for (const double t : joints::accelerated_times({at_x(way, way / feed), at_x(0, way / feed)}, at_x(0, 0), p, 0, m))
    sum += t * 60;
  const double corner = a * 0.004 / 2;  // mm/s
  // Up to v, down to the corner, and the same backwards.
  const double one = v / a + (v - corner) / a + (way - v * v / (2 * a) - (v * v - corner * corner) / (2 * a)) / v;
  EXPECT_NEAR(sum, 2 * one, 1e-9);
  // A turn about a corner of 90 deg: no jump beyond v in either axis.
  joints::AxisBlock up = at_x(way, way / feed);
  up.words[1] = numbers::to_fixed(way, 4);
  double bend = 0;
  for (const double t : joints::accelerated_times({at_x(way, way / feed), up}, at_x(0, 0), p, 0, m)) bend += t * 60;
  const double c90 = a * 0.004;
  EXPECT_NEAR(bend, 2 * (v / a + (v - c90) / a + (way - v * v / (2 * a) - (v * v - c90 * c90) / (2 * a)) / v), 1e-9);
}

// The slowest axis rules: the same way with C along takes as long as C needs.
TEST(TimeEstimate, EveryAxisCounts) {
  const machines::Machine m = with_acceleration(1e6, 50);
  joints::AxisProgram p = empty_program(m);
  joints::AxisBlock b = at_x(10, 0.02);
  b.words[3] = numbers::to_fixed(90, 5);
  const double v = 90 / (0.02 * 60), a = 50;  // deg/s
  EXPECT_NEAR(joints::accelerated_times({b}, at_x(0, 0), p, 0, m)[0] * 60,
              90 >= v * v / a ? 90 / v + v / a : 2 * std::sqrt(90 / a), 1e-9);
}

// Whole programs: never below the feed time, monotone, and the feed time in the limit.
TEST(TimeEstimate, InvariantsOfPrograms) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> lean(0.1, 0.6), swing(-1.5, 1.5);
  for (int trial = 0; trial < 6; ++trial)
    for (const bool expand : {false, true}) {
      const std::vector<path::ClPath> paths = {sample_path(lean(random), swing(random), 25),
                                               sample_path(lean(random), 0, 15, 1)};
      const auto plain = axis_program(paths, with_dialect(trunnion(), "fanuc"), standing(), 4, expand);
      ASSERT_TRUE(plain);
      EXPECT_FALSE(plain->has_acceleration);
      double before = 1e300;
      for (const double a : {20.0, 200.0, 2000.0, 2e5, 1e10}) {
        const auto program = axis_program(paths, with_acceleration(a, a), standing(), 4, expand);
        ASSERT_TRUE(program);
        ASSERT_TRUE(program->has_acceleration);
        EXPECT_DOUBLE_EQ(program->minutes, plain->minutes) << "the program itself is the same";
        const double total = program->accelerated.feed + program->accelerated.rapid;
        EXPECT_GE(program->accelerated.feed, program->feed_minutes * (1 - 1e-12));
        EXPECT_LE(total, before * (1 + 1e-12)) << a;
        before = total;
        ASSERT_EQ(program->time_rulers.back(), "acceleration");
        std::size_t blocks = 0, ruled = 0;
        for (const auto& op : program->operations)
          for (const auto& tooth : op.teeth)
            for (const auto& b : tooth.blocks) blocks += b.kind == joints::BlockKind::feed;
        for (const auto n : program->time_ruled) ruled += n;
        EXPECT_EQ(ruled, blocks);
        if (a == 20) { EXPECT_GT(program->time_ruled.back(), blocks / 2); }
        if (a == 1e10) {
          EXPECT_EQ(program->time_ruled.back(), 0u);
          EXPECT_NEAR(program->accelerated.feed, program->feed_minutes, 1e-6 * program->minutes);
        }
      }
    }
}

// A loop and its teeth written out take the same time.
TEST(TimeEstimate, LoopAndTeethAgree) {
  const auto path = sample_path(0.3, 0.4, 30);
  const machines::Machine m = with_dialect(with_acceleration(700, 900), "linuxcnc");
  const auto loop = axis_program({path}, m, standing(), 6), teeth = axis_program({path}, m, standing(), 6, true);
  ASSERT_TRUE(loop);
  ASSERT_TRUE(teeth);
  ASSERT_TRUE(loop->loop);
  ASSERT_FALSE(teeth->loop);
  EXPECT_NEAR(loop->accelerated.feed, teeth->accelerated.feed, 1e-3 * loop->accelerated.feed);
  EXPECT_NEAR(loop->accelerated.rapid, teeth->accelerated.rapid, 0.25 * loop->accelerated.rapid);
}

// The program and its text, read back, take the same time: feed moves to what rounding the words and F costs, rapids to
// the first moves, whose beginning the text does not know.
TEST(TimeEstimate, TextAndProgramAgree) {
  const std::vector<path::ClPath> paths = {sample_path(0.3, 0.4, 30), sample_path(0.2, 0, 15, 1)};
  for (const char* dialect : {"linuxcnc", "fanuc"}) {
    const machines::Machine m = with_dialect(with_acceleration(700, 900), dialect);
    const auto program = axis_program(paths, m, standing(), 5);
    const auto text = nc_text(paths, m, standing(), 5);
    ASSERT_TRUE(program && text) << dialect;
    const auto own = tools();
    const auto control = controls::control_of(m, standing(), own);
    ASSERT_TRUE(control);
    readback::ReadBackOptions options;
    options.teeth = 5;
    const auto read = readback::read_back(text->text, "program", *control, m, standing(), options);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_GT(read->accelerated.feed, 1.02 * read->feed_minutes) << dialect;
    EXPECT_NEAR(read->accelerated.feed, program->accelerated.feed, 2e-3 * program->accelerated.feed) << dialect;
    EXPECT_NEAR(read->accelerated.rapid, program->accelerated.rapid, 0.1 * program->accelerated.rapid) << dialect;
  }
}

// Without accelerations the text says so, and with them what is assumed.
TEST(TimeEstimate, SaysWhatItHolds) {
  const auto model = [](const machines::Machine& m) {
    const auto program = axis_program({sample_path(0.2, 0, 10)}, m, standing(), 2);
    return program ? program->time_model : program.error().text();
  };
  EXPECT_EQ(model(trunnion()),
            "without accelerations, the machine file states none (max_acceleration): the machine takes longer");
  machines::Machine m = with_acceleration(700, 900);
  m.min_block_ms = 4;
  const std::string jumps =
      "with speeds, accelerations of the axes, no jerk stated, assumed: at corners every axis may jump by what it "
      "accelerates in 4 ms (min_block_ms)";
  EXPECT_EQ(model(with_dialect(m, "siemens")), jumps);
  EXPECT_EQ(model(with_dialect(m, "fanuc")),
            "with speeds, accelerations of the axes, no jerk stated, a stop at every corner (G61), its wait for the "
            "position of the axes not counted");
  m.post.corner_tolerance_mm = 0.002;
  EXPECT_EQ(model(with_dialect(m, "fanuc")), jumps) << "G64";
  m.post.corner_tolerance_mm.reset();
  EXPECT_EQ(
      model(with_dialect(m, "linuxcnc")),
      "with speeds, accelerations of the axes, no jerk stated, corners by the rules of LinuxCNC 2.9, servo period "
      "1 ms assumed");
}

std::string nutating_file() { return file_text(TOOTHPATH_SOURCE_DIR "/machines/data/nutating_table.toml"); }

// The keys of the machine file: per second squared there, per minute squared inside; every axis or none.
TEST(TimeEstimate, AccelerationsOfTheMachineFile) {
  const auto whole = machines::read_machine_text(nutating_file(), "m.toml");
  ASSERT_TRUE(whole.machine) << to_text(whole.errors);
  EXPECT_TRUE(whole.machine->has_acceleration());
  EXPECT_DOUBLE_EQ(whole.machine->chain.linear[1].max_acceleration, 5000 * kPerSecond2);
  EXPECT_DOUBLE_EQ(whole.machine->chain.table[0].max_acceleration, radians(3000) * kPerSecond2);
  const auto partly = machines::read_machine_text(replaced(nutating_file(), "max_acceleration = 1500", "#"), "m.toml");
  ASSERT_FALSE(partly.machine);
  EXPECT_NE(to_text(partly.errors)
                .find("max_acceleration stands at some axes and is missing at axes.B: every axis has one, or none"),
            std::string::npos)
      << to_text(partly.errors);
  const auto zero = machines::read_machine_text(
      replaced(nutating_file(), "max_acceleration = 1500", "max_acceleration = 0"), "m.toml");
  EXPECT_FALSE(zero.machine);
  const auto pole =
      machines::read_machine_text(nutating_file() + "\n[post]\npole = \"hold\"\npole_angle = 0.5\n", "m.toml");
  ASSERT_TRUE(pole.machine) << to_text(pole.errors);
  EXPECT_EQ(pole.machine->post.pole, machines::PoleOption::hold);
  EXPECT_DOUBLE_EQ(pole.machine->post.pole_angle_rad.value_or(0), radians(0.5));
  EXPECT_FALSE(machines::read_machine_text(nutating_file() + "\n[post]\npole_angle = 60\n", "m.toml").machine);
}

// Jerks: per second cubed there, per minute cubed inside; every axis or none, and not without accelerations. The time
// of a tool change stands with the spindle.
TEST(TimeEstimate, JerksAndToolChangeOfTheMachineFile) {
  std::string text = nutating_file();
  const auto with_jerk = [](const std::string& from) {
    return std::regex_replace(from, std::regex("(max_acceleration = [0-9]+)"), "$1\nmax_jerk = 40000");
  };
  const auto whole = machines::read_machine_text(
      replaced(with_jerk(text), "max_speed = 18000", "max_speed = 18000\ntool_change = 7.5"), "m.toml");
  ASSERT_TRUE(whole.machine) << to_text(whole.errors);
  EXPECT_TRUE(whole.machine->has_jerk());
  EXPECT_DOUBLE_EQ(whole.machine->chain.linear[2].max_jerk, 40000 * 216000.0);
  EXPECT_DOUBLE_EQ(whole.machine->chain.table[1].max_jerk, radians(40000) * 216000);
  EXPECT_DOUBLE_EQ(whole.machine->tool_change_min.value_or(0), 0.125);
  const auto partly = machines::read_machine_text(
      replaced(text, "max_acceleration = 3000", "max_acceleration = 3000\nmax_jerk = 40000"), "m.toml");
  EXPECT_NE(to_text(partly.errors).find("max_jerk stands at some axes and is missing at axes.X, axes.Y, axes.Z"),
            std::string::npos)
      << to_text(partly.errors);
  const auto alone = machines::read_machine_text(
      std::regex_replace(with_jerk(text), std::regex("max_acceleration = [0-9]+"), ""), "m.toml");
  EXPECT_NE(to_text(alone.errors).find("max_jerk stands without max_acceleration"), std::string::npos)
      << to_text(alone.errors);
  EXPECT_FALSE(
      machines::read_machine_text(replaced(text, "max_speed = 18000", "max_speed = 18000\ntool_change = 0"), "m.toml")
          .machine);
}

}  // namespace
}  // namespace toothpath
