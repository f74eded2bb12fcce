// What the machine does with a program: docs/dangers.md, rows 7, 8, 11 to 13, 15, 16, 21. Programs are read back and
// then followed with the kinematics of tests/support/trunnion_kinematics.h, which shares nothing with the machine
// model.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/postproc/dangers/danger_case.h"

namespace toothpath {
namespace {

using namespace test;
using JointValues = std::array<double, 5>;  // X Y Z C A

double length_of(int tool) { return tool == 1 ? tools()[0].length_mm : tools()[1].length_mm; }

/// Tip and axis in the gear frame.
TrunnionPose pose(const JointValues& j, double length) {
  TrunnionPose t = trunnion_forward(kTrunnion, j[0], j[1], j[2], j[4], j[3], length);
  t.tip -= standing().origin_mm;
  return t;
}

/// Does the tool, a cylinder of its diameter up to the gauge line, stay outside the clearance body?
bool outside_body(const TrunnionPose& p, double length) {
  for (int i = 0; i <= 24; ++i) {
    const Vec3 at = p.tip + length * i / 24.0 * p.axis;
    if (at.head<2>().norm() < kBody.radius_mm && at.z() < kBody.z_max_mm && at.z() > kBody.z_min_mm) return false;
  }
  return true;
}

class DangerMotion : public EveryPost {
 protected:
  [[nodiscard]] bool apt() const { return std::string(post().dialect) == "apt"; }
};

// 7, 8: the time that the control needs for every cutting block is the time that the program was made for, 1/F where F
// is inverse time.
TEST_F(DangerMotion, EveryBlockTakesItsTime) {
  every_post([&] {
    const Post& p = post();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> u(0, 1);
    for (int trial = 0; trial < 5; ++trial) {
      // Near the axis of C the linear steps are tiny while the rotary turns: trial 0 stands still but for the last
      // digits.
      path::ClPath path = sample_path(0.1 + 0.5 * u(random), may_turn(p) ? u(random) : 0, 6 + 2 * trial);
      const double nearer = trial == 0 ? 1e-4 : u(random);
      if (may_turn(p))
        for (auto& r : path.records) {
          r.tip.head<2>() *= nearer;
          r.feed_mm_min *= r.feed_mm_min > 0 ? 0.2 + u(random) : 0;
        }
      machines::Machine m = machine_of(p);
      m.chain.table[0].max_speed = radians(300 + 6000 * u(random));
      for (auto& r : path.records)
        if (r.kind == path::MoveKind::rapid || r.kind == path::MoveKind::retract) r.tip += 10 * r.axis;
      const auto program = axis_program({path}, m, standing(), kDangerTeeth, p.expand);
      ASSERT_TRUE(program) << p.name << ": " << program.error().message;
      const auto text = text::write_nc(*program, *controls::dialect_of(m), {});
      ASSERT_TRUE(text) << p.name << ": " << text.error().message;
      std::vector<double> asked, needed;
      for (int k = 0; k < kDangerTeeth; ++k) {
        if (!program->loop && k > 0) break;
        for (const auto& tooth : program->operations[0].teeth)
          for (const auto& b : tooth.blocks)
            if (b.kind == joints::BlockKind::feed || b.kind == joints::BlockKind::turn) asked.push_back(b.minutes);
      }
      for (const auto& e : executed(p, text->text, m))
        if (!e.rapid) needed.push_back(e.minutes);
      if (apt()) continue;  // CLDATA has FEDRAT alone; a GOTO that turns is timed by the post processor of the control
      ASSERT_EQ(needed.size(), asked.size()) << p.name;
      for (std::size_t i = 0; i < asked.size(); ++i)
        ASSERT_NEAR(needed[i] / asked[i], 1, 0.01) << p.name << " trial " << trial << " block " << i;
      if (p.tcp != machines::TcpMode::none || std::string(p.dialect) == "heidenhain") continue;
      // The same from the text alone: F of the inverse-time blocks.
      std::vector<double> rates;
      for (const auto& b : simulate_modes(text->text, p.dialect).blocks)
        if (b.moves && !b.rapid) rates.push_back(b.mode("feed") == "inverse time" ? std::stod(b.words.at("F")) : 0);
      const std::size_t once = program->operations[0].teeth.size() == 1 ? asked.size() / kDangerTeeth : asked.size();
      ASSERT_GE(rates.size(), once);
      std::size_t checked = 0;
      for (std::size_t i = 0; i < once; ++i) {
        if (rates[i] <= 0) continue;  // LinuxCNC: printed per minute, timed above by its rule
        ASSERT_NEAR(rates[i] * asked[i], 1, 0.01) << p.name << " block " << i;
        ++checked;
      }
      EXPECT_GT(checked, once / 4);
    }
  });
}

// 11, 12: on rapids the whole tool stays outside the body that part and fixture sweep, whether the axes of a group run
// together or one after the other, and while rotaries turn at paces of their own.
TEST_F(DangerMotion, RapidsStayOutsideTheBlank) {
  every_post([&] {
    const Post& p = post();
    for (const auto& [name, paths] : jobs_for(p)) {
      const auto moves = executed(p, text_of(p, paths));
      std::size_t looked_at = 0;
      for (std::size_t i = 1; i < moves.size(); ++i) {
        const readback::ExecutedMove &a = moves[i - 1], &b = moves[i];
        if (!b.rapid || !b.known) continue;
        const double length = length_of(b.tool);
        ++looked_at;
        for (int s = 0; s <= 12; ++s) {
          const double t = s / 12.0;
          if (b.tcp) {  // the tip goes straight, the rotaries stand
            const TrunnionPose from = pose(a.joints, length), to = pose(b.joints, length);
            // (A turn of the rotaries at rest would show as a change of the axis.)
            ASSERT_LT((from.axis - to.axis).norm(), apt() ? 2.0 : 1e-9) << name << " line " << b.line;
            if (!apt()) {
              ASSERT_TRUE(outside_body({from.tip + t * (to.tip - from.tip), to.axis}, length))
                  << name << " line " << b.line;
            }
            continue;
          }
          JointValues together = a.joints, first = a.joints, second = a.joints;
          for (std::size_t x = 0; x < 5; ++x) together[x] += t * (b.joints[x] - a.joints[x]);
          // Dog legs: of X Y, and of the two rotaries.
          const bool rotary = a.joints[3] != b.joints[3] || a.joints[4] != b.joints[4];
          const std::size_t one = rotary ? 3 : 0, other = rotary ? 4 : 1;
          first = second = b.joints;
          first[one] = a.joints[one] + t * (b.joints[one] - a.joints[one]);
          first[other] = a.joints[other];
          second[other] = a.joints[other] + t * (b.joints[other] - a.joints[other]);
          second[one] = a.joints[one];
          ASSERT_TRUE(outside_body(pose(together, length), length)) << name << " line " << b.line;
          ASSERT_TRUE(outside_body(pose(first, length), length)) << name << " line " << b.line;
          ASSERT_TRUE(outside_body(pose(second, length), length)) << name << " line " << b.line;
        }
      }
      EXPECT_GT(looked_at, 10u) << name;
    }
  });
}

// 13: five passes of eight turns of C on an axis with nine: each unwinds above the part, in a block of its own, not
// inside a cut.
TEST_F(DangerMotion, FortyTurnsAreUnwoundAboveThePart) {
  every_post([&] {
    const Post& p = post();
    if (!may_turn(p) || apt()) return;  // CLDATA names no turn of an axis
    machines::Machine m = machine_of(p);
    m.chain.table[0].min_rad = radians(-1640);
    m.chain.table[0].max_rad = radians(1640);
    path::ClPath path = sample_path(0.3, 0, 2);
    path.records.clear();
    for (int pass = 0; pass < 5; ++pass) {
      const auto add = [&](int i, path::MoveKind kind, double lift) {
        const double phi = 2 * kPi * i / 30.0;
        const Vec3 axis = leaning(0.3, phi);
        path.records.push_back({Vec3(100 * std::cos(phi), 100 * std::sin(phi), -3) + lift * axis, axis,
                                kind == path::MoveKind::rapid ? 0.0 : 800.0, kind, 0, pass});
      };
      add(240 * pass, path::MoveKind::rapid, 15);
      add(240 * pass, path::MoveKind::engage, 0);
      for (int i = 1; i <= 240; ++i) add(240 * pass + i, path::MoveKind::feed, 0);
      add(240 * (pass + 1), path::MoveKind::retract, 15);
    }
    path.records.push_back(path.records.back());
    path.records.back().kind = path::MoveKind::rapid;
    const auto program = axis_program({path}, m, standing(), 1, p.expand);
    ASSERT_TRUE(program) << p.name << ": " << program.error().message;
    const auto text = text::write_nc(*program, *controls::dialect_of(m), {});
    ASSERT_TRUE(text) << text.error().message;
    EXPECT_NE(text->text.find(" UNWINDS BY "), std::string::npos) << p.name;
    const auto moves = executed(p, text->text, m);
    double cut = 0, unwound = 0;
    for (std::size_t i = 1; i < moves.size(); ++i) {
      const readback::ExecutedMove &a = moves[i - 1], &b = moves[i];
      if (!b.known) continue;
      // (A tool vector names no turn: which one it is, is the business of the control.)
      if (p.tcp != machines::TcpMode::vectors) {
        ASSERT_LE(std::abs(b.joints[3]), 1640) << p.name << " line " << b.line;
      }
      const double turn = std::abs(b.joints[3] - a.joints[3]);
      const bool cutting = !b.rapid && (b.commanded & 7) != 0;
      if (cutting) {
        ASSERT_LT(turn, 30) << p.name << " line " << b.line;
        cut += turn;
      } else if (turn > 200) {
        unwound += turn;
        const TrunnionPose from = pose(a.joints, 95), to = pose(b.joints, 95);
        EXPECT_TRUE(outside_body(from, 95) && outside_body(to, 95)) << p.name << " line " << b.line;
        if (!b.tcp) {
          EXPECT_EQ((Vec3(a.joints[0], a.joints[1], a.joints[2]) - Vec3(b.joints[0], b.joints[1], b.joints[2])).norm(),
                    0)
              << p.name << " line " << b.line;
        }
      }
    }
    EXPECT_NEAR(cut, 40 * 360, 40) << p.name;
    EXPECT_GE(unwound, 4 * 2000) << p.name;
    for (auto* limit : {&m.chain.table[0].min_rad, &m.chain.table[0].max_rad})
      *limit *= 0.8;  // no room for the eight turns of one pass
    EXPECT_FALSE(axis_program({path}, m, standing(), 1, p.expand));
  });
}

/// Motions of one operation from the joints by the other kinematics, for a tool that is longer than the program
/// believes.
std::vector<path::ToolMotion> motions_of(const std::vector<readback::ExecutedMove>& moves, double longer,
                                         const machines::KinematicChain* other_chain = nullptr) {
  std::vector<path::ToolMotion> out;
  const auto at = [&](const readback::ExecutedMove& e) {
    const double length = length_of(e.tool);
    TrunnionPose t;
    if (other_chain != nullptr) {
      const auto q = other_chain->forward(
          {Vec3(e.joints[0], e.joints[1], e.joints[2]), {radians(e.joints[3]), radians(e.joints[4])}}, length);
      t.tip = q.tip_mm - standing().origin_mm;
      t.axis = q.axis;
    } else {
      t = pose(e.joints, length);
    }
    t.tip -= longer * t.axis;
    return t;
  };
  for (std::size_t i = 1; i < moves.size(); ++i) {
    const readback::ExecutedMove &a = moves[i - 1], &b = moves[i];
    if (!b.known || b.operation != 0) continue;  // known: before and after the move
    const TrunnionPose from = at(a), to = at(b);
    path::ToolMotion m;
    m.tip_from = from.tip;
    m.tip_to = to.tip;
    m.axis_from = from.axis;
    m.axis_to = to.axis;
    m.minutes = b.minutes;
    m.rapid = b.rapid;
    m.line = b.line;
    m.operation = 0;
    m.tooth = 0;
    out.push_back(m);
  }
  return out;
}

// 15: a rotary whose sense or pivot differs from the machine file: the program does not meet the path any more. (Tool
// vectors name no rotary: there the dry-run program of `toothpath machine test` shows it,
// SelfTestOf.WrongMachineIsSeen.)
TEST_F(DangerMotion, WrongSenseOrPivotFailsTheRoundTrip) {
  every_post([&] {
    const Post& p = post();
    if (p.tcp == machines::TcpMode::vectors) return;
    const path::ClPath path = sample_path(0.3, may_turn(p) ? 0.1 : 0, 8);
    const auto moves = executed(p, text_of(p, {path}, 1));
    const std::vector<const path::ClPath*> list = {&path};
    EXPECT_TRUE(readback::compare_with_cl(motions_of(moves, 0), list, 3e-3, 1e-3).complete) << p.name;
    for (std::size_t k = 0; k < 2; ++k) {
      machines::KinematicChain wrong = trunnion().chain;
      wrong.table[k].sign = 1;
      EXPECT_FALSE(readback::compare_with_cl(motions_of(moves, 0, &wrong), list, 3e-3, 1e-3).complete)
          << p.name << " sense of " << wrong.table[k].letter;
      wrong.table[k].sign = -1;
      EXPECT_TRUE(readback::compare_with_cl(motions_of(moves, 0, &wrong), list, 3e-3, 1e-3).complete) << p.name;
      wrong.table[k].point_mm += Vec3(0.05, 0.05, 0);
      EXPECT_FALSE(readback::compare_with_cl(motions_of(moves, 0, &wrong), list, 3e-3, 1e-3).complete)
          << p.name << " pivot of " << wrong.table[k].letter;
    }
  });
}

// 16: a tool that is 0.25 mm longer than the list says cuts 0.25 mm too deep along its axis, and the comparison says
// so.
TEST_F(DangerMotion, AToolAQuarterTooLongIsSeen) {
  every_post([&] {
    const Post& p = post();
    const path::ClPath path = sample_path(0.3, may_turn(p) ? 0.1 : 0, 8);
    const auto moves = executed(p, text_of(p, {path}, 1));
    const std::vector<const path::ClPath*> list = {&path};
    EXPECT_TRUE(readback::compare_with_cl(motions_of(moves, 0), list, 3e-3, 1e-3).complete) << p.name;
    const auto wrong = readback::compare_with_cl(motions_of(moves, 0.25), list, 3e-3, 1e-3);
    EXPECT_FALSE(wrong.complete) << p.name;
    if (p.tcp == machines::TcpMode::angles && std::string(p.dialect) == "fanuc")
      return;  // its turn about the tip is one about another point now
    const auto deep = readback::compare_with_cl(motions_of(moves, 0.25), list, 0.26, 1e-3);
    EXPECT_TRUE(deep.complete) << p.name << ": " << deep.message;
    EXPECT_NEAR(deep.worst_mm, 0.25, 0.005) << p.name;
  });
}

// 16: what the lengths refer to stands in the text with the length of every tool; another reference is refused, not
// guessed.
TEST_F(DangerMotion, LengthReferenceIsSaid) {
  every_post([&] {
    const Post& p = post();
    const std::string text = text_of(p, jobs_for(p).at("three operations"));
    for (const char* length : {"95", "90.25"}) EXPECT_NE(text.find(length), std::string::npos) << length;
    machines::Machine m = machine_of(p);
    m.post.length_reference = machines::LengthReference::centre;
    const auto refused = axis_program({sample_path(0.3, 0)}, m, standing(), 1);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("length_reference"), std::string::npos);
  });
}

// 21: with TCP the joints are curved inside a block. Ends inside the travel, middle outside: refused.
TEST_F(DangerMotion, LimitsHoldInsideABlockToo) {
  every_post([&] {
    const Post& p = post();
    if (p.tcp == machines::TcpMode::none) return;
    path::ClPath path;
    path.operation_type = "finishing";
    path.spindle_rpm = 12000;
    // The tip hardly moves while C turns by 23 degrees about it: X goes through its greatest value in the middle.
    const auto add = [&](double t, double lift, path::MoveKind kind) {
      const Vec3 u = leaning(0.015, kPi / 2 + 0.2 * t);
      path.records.push_back({Vec3(110, t, 0) + lift * u, u, kind == path::MoveKind::rapid ? 0.0 : 500.0, kind, 0, 0});
    };
    add(-1, 20, path::MoveKind::rapid);
    add(-1, 0, path::MoveKind::engage);
    add(1, 0, path::MoveKind::feed);
    add(1, 20, path::MoveKind::retract);
    add(1, 20, path::MoveKind::rapid);
    machines::Machine m = machine_of(p);
    m.limit_margin = {0, 0};
    const auto free = axis_program({path}, m, standing(), 1);
    ASSERT_TRUE(free) << p.name << ": " << free.error().message;
    const auto text = text::write_nc(*free, *controls::dialect_of(m), {});
    ASSERT_TRUE(text);
    double ends = -1e9;
    for (const auto& e : executed(p, text->text))
      if (e.known) ends = std::max(ends, e.joints[0]);
    const double middle = free->ranges[0].max;
    ASSERT_GT(middle, ends + 0.1) << p.name << ": the block must bulge for the test to mean anything";
    m.chain.linear[0].max_mm = 0.5 * (ends + middle);
    const auto refused = axis_program({path}, m, standing(), 1);
    ASSERT_FALSE(refused) << p.name;
    EXPECT_EQ(refused.error().kind, DiagnosticKind::verification);
    EXPECT_NE(refused.error().message.find("X = "), std::string::npos) << refused.error().message;
    m.chain.linear[0].max_mm = middle + 0.01;
    EXPECT_TRUE(axis_program({path}, m, standing(), 1)) << p.name;
  });
}

}  // namespace
}  // namespace toothpath
