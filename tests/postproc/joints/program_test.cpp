#include "postproc/joints/program.h"

#include <gtest/gtest.h>

#include <random>

#include "postproc/numbers/fixed_point.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

/// Joints of a block in mm and degrees, from the words alone.
std::array<double, 5> joints_of(const joints::AxisProgram& p, const joints::AxisOperation& op,
                                const joints::AxisBlock& b, double index_deg = 0) {
  std::array<double, 5> j{};
  for (std::size_t i = 0; i < 3; ++i)
    j[i] = static_cast<double>(b.words[i]) / static_cast<double>(numbers::power_of_ten(p.format.linear_decimals)) +
           p.work_offset_at_mm[static_cast<int>(i)] + (i == 2 ? op.tool_length_mm : 0);
  for (std::size_t i = 3; i < 5; ++i)
    j[i] = static_cast<double>(b.words[i]) / static_cast<double>(numbers::power_of_ten(p.format.rotary_decimals));
  j[3] += index_deg;
  return j;
}

TrunnionPose pose(const std::array<double, 5>& j, const toothpath::joints::Setup& setup, double length) {
  TrunnionPose t = trunnion_forward(kTrunnion, j[0], j[1], j[2], j[4], j[3], length);
  t.tip = setup.rotation().transpose() * (t.tip - setup.origin_mm);
  t.axis = setup.rotation().transpose() * t.axis;
  return t;
}

Vec3 about_z(const Vec3& v, double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitZ()) * v; }

// The published kinematics of LinuxCNC, values from its binaries.
TEST(TrunnionKinematics, GoldenValues) {
  const TrunnionGeometry g{.px = 1.5, .py = -2.5, .pz = -40, .dy = 3.25, .z_offset = -7.5};
  const auto p = trunnion_forward(g, 10, 20, 30, 25, -40, 101.2);
  EXPECT_LT((p.tip + Vec3(0, 0, 101.2) - Vec3(1.1461669155887146, 11.145334377839344, 24.085103908722928)).norm(),
            1e-11);
}

// Every record of every tooth is met at the end of a block, by kinematics that the builder does not know.
TEST(AxisProgram, EndsOfBlocksAreTheTurnedRecords) {
  for (const double swing : {0.0, 0.4})
    for (const bool expand : {false, true}) {
      const auto path = sample_path(0.35, swing);
      const int z = 7;
      const auto program = axis_program({path}, trunnion(), standing(), z, expand);
      ASSERT_TRUE(program) << program.error().message;
      EXPECT_EQ(program->loop, !expand);
      for (int k = 0; k < z; ++k) {
        const auto& op = program->operations[0];
        const auto& blocks = op.teeth[expand ? static_cast<std::size_t>(k) : 0].blocks;
        std::vector<int> met(path.records.size(), 0);
        for (std::size_t i = 0; i < blocks.size(); ++i) {
          const auto& b = blocks[i];
          if (b.record < 0 || (i + 1 < blocks.size() && blocks[i + 1].record == b.record)) continue;
          const auto& r = path.records[static_cast<std::size_t>(b.record)];
          const double index = expand ? 0 : program->index_sign * 360.0 * k / z;
          const auto p = pose(joints_of(*program, op, b, index), standing(), op.tool_length_mm);
          ASSERT_LT((p.tip - about_z(r.tip, 2 * kPi * k / z)).norm(), program->rounding_bound_mm)
              << k << " " << b.record;
          ASSERT_LT((p.axis - about_z(r.axis, 2 * kPi * k / z)).norm(), 2e-7);
          met[static_cast<std::size_t>(b.record)] = 1;
        }
        for (std::size_t i = 0; i + 1 < met.size(); ++i) EXPECT_EQ(met[i], 1) << i;
      }
    }
}

// C in [0, 360] and a tool along its axis: C is free there and stands where it may, whichever way the teeth turn it.
TEST(AxisProgram, AFreeRotaryStandsInsideItsLimits) {
  for (const int sign : {1, -1})
    for (const bool expand : {false, true}) {
      machines::Machine m = trunnion();
      m.chain.table[0].sign = sign;
      m.chain.table[0].min_rad = 0;
      m.chain.table[0].max_rad = radians(360);
      const auto path = sample_path(0.0, 0.0);
      const int z = 40;
      const auto program = axis_program({path}, m, standing(), z, expand);
      ASSERT_TRUE(program) << program.error().message;
      EXPECT_EQ(program->loop, !expand);
      const auto& c = program->ranges[3];
      EXPECT_GE(c.min, m.limit_margin.rotary_rad);
      EXPECT_LE(c.max, radians(360) - m.limit_margin.rotary_rad);
      EXPECT_NEAR(c.max - c.min, radians(351), 1e-9);
    }
}

// C of +-190 deg and a tooth that sways it by more than 20: no whole turn of its commands fits some teeth, the other
// pair of angles does. Every record is met all the same, and neither rotary leaves its limits.
TEST(AxisProgram, OtherPairServesTeethThatTheFirstDoesNotReach) {
  machines::Machine m = trunnion();
  m.chain.table[0].min_rad = radians(-190);
  m.chain.table[0].max_rad = radians(190);
  const auto path = sample_path(0.35, 0.7);
  const int z = 60;
  const auto program = axis_program({path}, m, standing(), z, true);
  ASSERT_TRUE(program) << program.error().message;
  const auto& op = program->operations[0];
  ASSERT_EQ(op.teeth.size(), std::size_t(z));
  std::array<int, 2> tilts{};
  for (int k = 0; k < z; ++k) {
    const auto& blocks = op.teeth[static_cast<std::size_t>(k)].blocks;
    std::vector<int> met(path.records.size(), 0);
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const auto& b = blocks[i];
      const auto j = joints_of(*program, op, b, 0);
      ASSERT_LE(std::abs(j[3]), 190) << k;
      if (b.record < 0 || (i + 1 < blocks.size() && blocks[i + 1].record == b.record)) continue;
      const auto& r = path.records[static_cast<std::size_t>(b.record)];
      const auto p = pose(j, standing(), op.tool_length_mm);
      ASSERT_LT((p.tip - about_z(r.tip, 2 * kPi * k / z)).norm(), program->rounding_bound_mm) << k << " " << b.record;
      ASSERT_LT((p.axis - about_z(r.axis, 2 * kPi * k / z)).norm(), 2e-7);
      met[static_cast<std::size_t>(b.record)] = 1;
      if (b.kind == joints::BlockKind::feed) ++tilts[j[4] > 0 ? 1 : 0];
    }
    for (std::size_t i = 0; i + 1 < met.size(); ++i) EXPECT_EQ(met[i], 1) << k << " " << i;
  }
  EXPECT_GT(tilts[0], 0);
  EXPECT_GT(tilts[1], 0);
  // Without the other pair it is refused.
  m.chain.table[1].min_rad = tilts[1] > tilts[0] ? radians(-1) : m.chain.table[1].min_rad;
  m.chain.table[1].max_rad = tilts[1] > tilts[0] ? m.chain.table[1].max_rad : radians(1);
  const auto one_pair = axis_program({path}, m, standing(), z, true);
  ASSERT_FALSE(one_pair);
  EXPECT_NE(one_pair.error().message.find("tooth "), std::string::npos) << one_pair.error().message;
  EXPECT_NE(one_pair.error().message.find("outside [-189.99"), std::string::npos) << one_pair.error().message;
}

// Danger 22: inside the blocks, densely sampled, the tip stays on the chord.
TEST(AxisProgram, StaysOnTheChordInsideBlocks) {
  const auto path = sample_path(0.5, 0.9, 6);  // long steps: many halvings
  for (const double chord : {5e-3, 5e-4}) {
    const auto program = axis_program({path}, trunnion(), standing(), 5, false, chord);
    ASSERT_TRUE(program) << program.error().message;
    EXPECT_GT(program->inserted_blocks, 10u);
    const auto& op = program->operations[0];
    const auto& blocks = op.teeth[0].blocks;
    double worst = 0;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      if (blocks[i].kind != joints::BlockKind::feed) continue;
      const auto& r = path.records;
      const auto n = static_cast<std::size_t>(blocks[i].record);
      const Vec3 a = r[n - 1].tip, d = r[n].tip - a;
      const auto ja = joints_of(*program, op, blocks[i - 1]), jb = joints_of(*program, op, blocks[i]);
      for (int s = 0; s <= 20; ++s) {
        std::array<double, 5> j{};
        for (std::size_t x = 0; x < 5; ++x) j[x] = ja[x] + (jb[x] - ja[x]) * s / 20.0;
        const Vec3 p = pose(j, standing(), op.tool_length_mm).tip;
        const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
        worst = std::max(worst, (p - a - t * d).norm());
      }
    }
    EXPECT_LE(worst, chord * 1.03 + program->rounding_bound_mm);
    EXPECT_LE(worst, program->chord_bound_mm + 2 * program->rounding_bound_mm);
  }
}

// Danger 6 and 28: no axis beyond its speed, no block beyond the control.
TEST(AxisProgram, AxisSpeedsAndBlockTime) {
  for (const double lean : {0.02, 0.3, 0.8}) {
    machines::Machine m = trunnion();
    m.chain.table[0].max_speed = radians(300);  // slow C: it must rule
    const auto path = sample_path(lean, 1.2);
    const auto program = axis_program({path}, m, standing(), 3);
    ASSERT_TRUE(program) << program.error().message;
    const auto& op = program->operations[0];
    const auto& blocks = op.teeth[0].blocks;
    std::size_t ruled_by_rotary = 0;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      const auto a = joints_of(*program, op, blocks[i - 1]), b = joints_of(*program, op, blocks[i]);
      for (std::size_t x = 0; x < 5; ++x) {
        const double limit = x < 3 ? 30000 : degrees(m.chain.rotary(x - 3).max_speed);
        ASSERT_LE(std::abs(b[x] - a[x]) / blocks[i].minutes, limit * (1 + 1e-9));
      }
      if (blocks[i].kind == joints::BlockKind::feed) {
        EXPECT_GE(blocks[i].minutes, m.min_block_ms / 60000 * (1 - 1e-12));
      }
    }
    ruled_by_rotary = program->time_ruled[3];
    EXPECT_GT(ruled_by_rotary, 0u);
  }
}

// The tip moves at the feed that the path asks for, unless an axis or the block time rules.
TEST(AxisProgram, FeedIsThatOfTheTip) {
  const auto path = sample_path(0.35, 0.0);
  const auto program = axis_program({path}, trunnion(), standing(), 3);
  ASSERT_TRUE(program);
  const auto& op = program->operations[0];
  const auto& blocks = op.teeth[0].blocks;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    if (blocks[i].kind != joints::BlockKind::feed) continue;
    const Vec3 a = pose(joints_of(*program, op, blocks[i - 1]), standing(), 95).tip,
               b = pose(joints_of(*program, op, blocks[i]), standing(), 95).tip;
    EXPECT_NEAR((b - a).norm() / blocks[i].minutes, 800, 0.01);
  }
}

// Danger 20: random axis paths across C = 180 deg, no flip and no jump inside a pass.
// The machine's largest cutting feed rules where the path asks for more; where it asks for less nothing changes.
TEST(AxisProgram, NoTipIsFasterThanTheLargestCuttingFeed) {
  const auto path = sample_path(0.35, 0.4);  // asks for 800
  for (const double largest : {300.0, 900.0}) {
    machines::Machine m = trunnion();
    m.max_cutting_feed = largest;
    const auto program = axis_program({path}, m, standing(), 3);
    ASSERT_TRUE(program) << program.error().message;
    const auto& op = program->operations[0];
    const auto& blocks = op.teeth[0].blocks;
    double fastest = 0;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      if (blocks[i].kind != joints::BlockKind::feed) continue;
      const Vec3 a = pose(joints_of(*program, op, blocks[i - 1]), standing(), 95).tip,
                 b = pose(joints_of(*program, op, blocks[i]), standing(), 95).tip;
      fastest = std::max(fastest, (b - a).norm() / blocks[i].minutes);
    }
    EXPECT_NEAR(fastest, std::min(largest, 800.0), 0.01);
  }
}

// Records that fall on the same words make no block of their own; their time is not lost.
TEST(AxisProgram, RecordsWithoutABlockKeepTheirTime) {
  path::ClPath path = sample_path(0, 0, 1);  // upright: the way is along Y of the machine
  path.records.resize(2);
  const int steps = 4000;
  const double feed = 0.5;    // so slow that nothing else rules
  const Vec3 way(0, 0.1, 0);  // a step is a quarter of the last digit of a word
  const path::ClRecord start = path.records.back();
  for (int i = 1; i <= steps; ++i)
    path.records.push_back({start.tip + way * i / steps, start.axis, feed, path::MoveKind::feed, 0, 0});
  const auto program = axis_program({path}, trunnion(), standing(), 1);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_GT(program->dropped_blocks, 1000u);
  double minutes = 0;
  for (const joints::AxisBlock& b : program->operations[0].teeth[0].blocks)
    minutes += b.kind == joints::BlockKind::feed ? b.minutes : 0;
  EXPECT_NEAR(minutes, (start.tip - path.records[0].tip).norm() / 800 + way.norm() / feed, 0.01 * way.norm() / feed);
}

TEST(AxisProgram, NoFlipInsideAPass) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> lean(0.15, 0.7), start(-kPi, kPi), swing(-4, 4);
  for (int trial = 0; trial < 40; ++trial) {
    path::ClPath path = sample_path(0.3, 0, 60);
    const double l = lean(random), a0 = start(random), s = swing(random);
    for (std::size_t i = 0; i < path.records.size(); ++i)
      path.records[i].axis = leaning(l, a0 + s * static_cast<double>(i % 63) / 63);
    for (auto& r : path.records)
      if (r.kind == path::MoveKind::rapid || r.kind == path::MoveKind::retract) r.tip.z() = 60;
    const auto program = axis_program({path}, trunnion(), standing(), 1);
    ASSERT_TRUE(program) << program.error().message;
    const auto& blocks = program->operations[0].teeth[0].blocks;
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      if (blocks[i].kind != joints::BlockKind::feed) continue;
      for (std::size_t x = 3; x < 5; ++x)
        ASSERT_LT(std::abs(blocks[i].words[x] - blocks[i - 1].words[x]), 15 * 100000) << "jump in trial " << trial;
      ASSERT_GE(blocks[i].words[4] * blocks[i - 1].words[4], 0) << "sign of A changes";
    }
  }
}

// Tool parallel to C: the index angle itself, tooth 0 at C = 0; sense of the index by machine sign and set-up.
TEST(AxisProgram, PoleAndIndexSense) {
  for (const bool up : {true, false})
    for (const int sign : {1, -1}) {
      machines::Machine m = trunnion();
      m.chain.table[0].sign = m.chain.table[1].sign = sign;
      toothpath::joints::Setup s = standing();
      s.axis_up = up;
      auto path = sample_path(0, 0);
      if (!up)
        for (auto& r : path.records) {
          r.tip.z() = -r.tip.z();
          r.axis = -r.axis;
        }
      const auto program =
          joints::AxisProgramTestAccess::build(std::vector{path}, tools(), s, m, 9, joints::ClearanceBody{120, -5, 5},
                                               controls::axis_options(words_of("linuxcnc"), m));
      ASSERT_TRUE(program) << program.error().message;
      EXPECT_TRUE(program->loop);
      EXPECT_EQ(program->index_sign, sign * (up ? 1 : -1));
      for (const auto& b : program->operations[0].teeth[0].blocks) {
        EXPECT_EQ(b.words[3], 0);
        EXPECT_EQ(b.words[4], 0);
      }
    }
}

// An origin beside the C axis cannot loop; all teeth are written out and still right (checked above for expand = true).
TEST(AxisProgram, EccentricGearIsWrittenOut) {
  toothpath::joints::Setup s = standing();
  s.origin_mm += Vec3(4, -3, 0);
  const auto path = sample_path(0.2, 0.1);
  const auto program = axis_program({path}, trunnion(), s, 5);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_FALSE(program->loop);
  ASSERT_EQ(program->operations[0].teeth.size(), 5u);
  const auto& op = program->operations[0];
  for (int k = 0; k < 5; ++k) {
    const auto& blocks = op.teeth[static_cast<std::size_t>(k)].blocks;
    for (std::size_t i = 0; i + 1 < blocks.size(); ++i) {
      if (blocks[i].kind != joints::BlockKind::feed || blocks[i + 1].record == blocks[i].record) continue;
      const auto p = pose(joints_of(*program, op, blocks[i]), s, 95);
      ASSERT_LT((p.tip - about_z(path.records[static_cast<std::size_t>(blocks[i].record)].tip, 2 * kPi * k / 5)).norm(),
                1e-4);
    }
  }
}

// Danger 12: one group of axes a rapid; rotaries turn only above everything that the part sweeps.
TEST(AxisProgram, RapidsKeepTheSequence) {
  std::vector<path::ClPath> paths = {sample_path(0.3, 0), sample_path(0.6, 0.3, 20, 1)};
  paths[1].tool = 1;
  const auto program = axis_program(paths, trunnion(), standing(), 4, true);
  ASSERT_TRUE(program) << program.error().message;
  for (const auto& op : program->operations)
    for (const auto& tooth : op.teeth) {
      const auto& b = tooth.blocks;
      EXPECT_EQ(b[0].kind, joints::BlockKind::rapid_rotary);
      EXPECT_EQ(b[1].kind, joints::BlockKind::rapid_xy);
      EXPECT_EQ(b[2].kind, joints::BlockKind::rapid_z);
      for (std::size_t i = 1; i < b.size(); ++i) {
        const auto changed = [&](std::size_t a) { return b[i].words[a] != b[i - 1].words[a]; };
        if (b[i].kind == joints::BlockKind::rapid_z) {
          EXPECT_FALSE(changed(0) || changed(1) || changed(3) || changed(4));
        }
        if (b[i].kind == joints::BlockKind::rapid_xy) { EXPECT_FALSE(changed(2) || changed(3) || changed(4)); }
        if (b[i].kind == joints::BlockKind::rapid_rotary) { EXPECT_FALSE(changed(0) || changed(1) || changed(2)); }
      }
    }
}

// Danger 21: travel beyond a limit names record, tooth, axis, value, limit and the shift that fits.
TEST(AxisProgram, TravelIsRefusedWithTheShiftThatFits) {
  machines::Machine m = trunnion();
  m.chain.linear[2].max_mm = 330;
  m.chain.linear[2].min_mm = 243;
  const auto path = sample_path(0, 0);  // tip down to z = -4: Z = 150 - 4 + 95 = 241
  const auto refused = axis_program({path}, m, standing(), 3);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, DiagnosticKind::verification);
  EXPECT_NE(refused.error().message.find("Z = "), std::string::npos) << refused.error().message;
  EXPECT_NE(refused.error().message.find("(tooth 0)"), std::string::npos);
  const auto at = refused.error().message.find("set-up origin Z +");
  ASSERT_NE(at, std::string::npos) << refused.error().message;
  const double shift = std::stod(refused.error().message.substr(at + 16));
  toothpath::joints::Setup s = standing();
  s.origin_mm.z() += shift;
  EXPECT_TRUE(axis_program({path}, m, s, 3)) << shift;
  s.origin_mm.z() -= 0.01;
  EXPECT_FALSE(axis_program({path}, m, s, 3));
}

TEST(AxisProgram, RotaryLimitsAndTurns) {
  machines::Machine m = trunnion();
  m.chain.table[1].max_rad = radians(-0.5);  // only one sign of A is left
  m.chain.table[0].min_rad = radians(-200);
  m.chain.table[0].max_rad = radians(200);  // no room for a whole loop of teeth: each tooth finds its own turn
  const auto path = sample_path(0.3, 0.2);
  const auto program = axis_program({path}, m, standing(), 12);
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_FALSE(program->loop);
  for (const auto& r : program->ranges) {
    EXPECT_GE(r.min, r.lower_limit) << r.letter;
    EXPECT_LE(r.max, r.upper_limit) << r.letter;
  }
  m.chain.table[1].min_rad = radians(-5);
  const auto refused = axis_program({path}, m, standing(), 12);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("A = "), std::string::npos) << refused.error().message;
}

// Danger 13: forty turns of C in one pass run into the limit or are posted continuously, never wrapped.
TEST(AxisProgram, FortyTurnsOfC) {
  path::ClPath path = sample_path(0.3, 0, 2);
  path.records.clear();
  const int n = 40 * 36;
  const auto rec = [&](int i, path::MoveKind kind, double lift) {
    const double phi = 2 * kPi * i / 36.0;
    const Vec3 axis = leaning(0.3, phi);
    path.records.push_back({Vec3(100 * std::cos(phi), 100 * std::sin(phi), -3) + lift * axis, axis, 800, kind, 0, 0});
  };
  rec(0, path::MoveKind::rapid, 15);
  rec(0, path::MoveKind::engage, 0);
  for (int i = 1; i <= n; ++i) rec(i, path::MoveKind::feed, 0);
  rec(n, path::MoveKind::retract, 15);
  const auto program = axis_program({path}, trunnion(), standing(), 1);
  ASSERT_TRUE(program) << program.error().message;
  const auto& r = program->ranges[3];
  EXPECT_NEAR(degrees(r.max - r.min), 40 * 360, 1e-3);
  machines::Machine m = trunnion();
  m.chain.table[0].min_rad = radians(-3600);
  m.chain.table[0].max_rad = radians(3600);
  EXPECT_FALSE(axis_program({path}, m, standing(), 1));
}

TEST(AxisProgram, PathThroughThePoleIsRefused) {
  path::ClPath path = sample_path(0.3, 0, 40);
  for (std::size_t i = 0; i < path.records.size(); ++i) {
    const double t = std::clamp((static_cast<double>(i % 43) - 1) / 40, 0.0, 1.0);
    path.records[i].axis = Vec3(0.2 - 0.4 * t, 0.001, 1).normalized();
  }
  for (auto& r : path.records)
    if (r.kind == path::MoveKind::rapid || r.kind == path::MoveKind::retract) r.tip.z() = 60;
  const auto refused = axis_program({path}, trunnion(), standing(), 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("record"), std::string::npos);
  EXPECT_NE(refused.error().message.find("C turns by"), std::string::npos) << refused.error().message;
}

TEST(AxisProgram, BadInputsAreNamed) {
  const auto good = sample_path(0.3, 0);
  const auto refused = [&](auto change, const std::string& text, machines::Machine m = trunnion()) {
    path::ClPath path = good;
    change(path);
    const auto r = axis_program({path}, m, standing(), 3);
    ASSERT_FALSE(r) << text;
    EXPECT_NE(r.error().message.find(text), std::string::npos) << r.error().message;
  };
  refused([](path::ClPath& p) { p.records[5].axis *= 1.001; }, "record 5: tool axis has length");
  refused([](path::ClPath& p) { p.records[5].tip.x() = std::nan(""); }, "record 5: position");
  refused([](path::ClPath& p) { p.records[5].feed_mm_min = 0; }, "record 5: feed");
  refused([](path::ClPath& p) { p.records.clear(); }, "no records");
  refused([](path::ClPath& p) { p.records[0].kind = path::MoveKind::feed; }, "does not begin with a rapid");
  refused([](path::ClPath& p) { p.spindle_rpm = 30000; }, "spindle speed 30000 exceeds 24000");
  refused([](path::ClPath& p) { p.tool = 2; }, "tool 2 of 2");
  machines::Machine low = trunnion();
  low.chain.linear[2].max_mm = 250;
  refused([](path::ClPath&) {}, "rises to", low);
  machines::Machine four = trunnion();
  four.max_simultaneous_axes = 4;
  const auto r = axis_program({sample_path(0.3, 0.4)}, four, standing(), 3);
  EXPECT_EQ(r.has_value(), true) << "tilt stays, four axes move";
  four.max_simultaneous_axes = 3;
  EXPECT_FALSE(axis_program({sample_path(0.3, 0.4)}, four, standing(), 3));
  EXPECT_FALSE(machines::check_part_fits(trunnion(), 1200.5));
  EXPECT_TRUE(machines::check_part_fits(trunnion(), 992));
}

}  // namespace
}  // namespace toothpath
