// Tool axes through and near the pole of the rotary that carries the work: every named option, on random paths, densely
// sampled.
#include <gtest/gtest.h>

#include <random>

#include "postproc/joints/pole.h"
#include "postproc/joints/words.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

Vec3 blend(const Vec3& a, const Vec3& b, double t) {
  const double w = angle_between(a, b);
  return w < 1e-12 ? a : Vec3((std::sin((1 - t) * w) * a + std::sin(t * w) * b) / std::sin(w));
}

/// One pass whose axis goes on a great circle past the z axis at `miss` rad, from -`before` to `after` rad along it.
path::ClPath passing(double azimuth, double miss, double before, double after, int steps) {
  path::ClPath path;
  path.operation_type = "finishing";
  path.spindle_rpm = 12000;
  const Vec3 along(std::cos(azimuth), std::sin(azimuth), 0), aside = Vec3::UnitZ().cross(along);
  const Vec3 middle = std::cos(miss) * Vec3::UnitZ() + std::sin(miss) * aside;
  const auto axis = [&](double t) {
    const double w = -before + t * (before + after);
    return Vec3((std::cos(w) * middle + std::sin(w) * along).normalized());
  };
  const auto tip = [](double t) { return Vec3(100 + 15 * t, 0.4 * std::sin(3 * t), -3 + 0.5 * t); };
  path.records.push_back({tip(0) + 12 * axis(0), axis(0), 0, path::MoveKind::rapid, 0, 0});
  path.records.push_back({tip(0), axis(0), 800, path::MoveKind::engage, 0, 0});
  for (int i = 1; i <= steps; ++i)
    path.records.push_back({tip(1.0 * i / steps), axis(1.0 * i / steps), 800, path::MoveKind::feed, 0, 0});
  path.records.push_back({tip(1) + 12 * axis(1), axis(1), 800, path::MoveKind::retract, 0, 0});
  return path;
}

machines::Machine pole_machine(machines::PoleOption option, double angle_deg = 0) {
  machines::Machine m = trunnion();
  m.post.pole = option;
  if (angle_deg > 0) m.post.pole_angle_rad = radians(angle_deg);
  return m;
}

struct Followed {
  double centre_mm = 0, axis_rad = 0,
         slowest_ratio = 0;  ///< worst: ball centre and axis against the plan, axis speed against its limit
  double c_turn = 0, a_least = 1e9, a_greatest = -1e9, minutes = 0;
  bool finite = true;
};

/// Every feed block of the program at 40 places, against the planned step that it belongs to.
Followed sampled(const joints::AxisProgram& p, const path::ClPath& plan, const machines::Machine& m) {
  Followed out;
  const auto& op = p.operations[0];
  joints::AxisWords words(m.chain, p.format, p.work_offset_at_mm);
  words.set_length(op.tool_length_mm);
  const double r = 2;
  const auto& blocks = op.teeth[0].blocks;
  const Mat3 turn = standing().rotation();
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const machines::Joints a = words.joints(blocks[i - 1]), b = words.joints(blocks[i]);
    out.finite = out.finite && b.linear_mm.allFinite() && std::isfinite(blocks[i].minutes) && blocks[i].minutes >= 0;
    if (blocks[i].kind != joints::BlockKind::feed) continue;
    out.minutes += blocks[i].minutes;
    for (int k = 0; k < 3; ++k)
      out.slowest_ratio = std::max(out.slowest_ratio, std::abs(b.linear_mm[k] - a.linear_mm[k]) / blocks[i].minutes /
                                                          m.chain.linear[static_cast<std::size_t>(k)].max_speed);
    for (std::size_t k = 0; k < 2; ++k)
      out.slowest_ratio = std::max(out.slowest_ratio, std::abs(b.rotary_rad[k] - a.rotary_rad[k]) / blocks[i].minutes /
                                                          m.chain.rotary(k).max_speed);
    out.c_turn += std::abs(b.rotary_rad[0] - a.rotary_rad[0]);
    out.a_least = std::min(out.a_least, b.rotary_rad[1]);
    out.a_greatest = std::max(out.a_greatest, b.rotary_rad[1]);
    const auto n = static_cast<std::size_t>(blocks[i].record);
    if (plan.records[n].kind != path::MoveKind::feed) continue;
    const path::ClRecord &u = plan.records[n - 1], &v = plan.records[n];
    for (int s = 0; s <= 40; ++s) {
      const double t = s / 40.0;
      machines::Joints j;
      j.linear_mm = (1 - t) * a.linear_mm + t * b.linear_mm;
      for (std::size_t k = 0; k < 2; ++k) j.rotary_rad[k] = (1 - t) * a.rotary_rad[k] + t * b.rotary_rad[k];
      const machines::TablePose pose = m.chain.forward(j, op.tool_length_mm);
      const Vec3 axis = turn.transpose() * pose.axis,
                 centre = turn.transpose() * (pose.tip_mm - standing().origin_mm) + r * axis;
      // The place on the planned step: by the tip's way along it, the axis there from the great circle.
      const Vec3 from = u.tip + r * u.axis, way = v.tip + r * v.axis - from;
      const double at = std::clamp((centre - from).dot(way) / way.squaredNorm(), 0.0, 1.0);
      out.centre_mm = std::max(out.centre_mm, (centre - (from + at * way)).norm());
      // Out of the cut on the way out and back in, the place does not change.
      if ((centre - (from + at * way)).norm() < 0.05)
        out.axis_rad = std::max(out.axis_rad, angle_between(axis, blend(u.axis, v.axis, at)));
    }
  }
  return out;
}

// Dangers 6 and 20: whatever the path near the pole, all axes within their speeds, numbers finite, deviation within the
// bound.
TEST(Pole, RandomPathsThroughAndNearIt) {
  std::mt19937 random(71);
  std::uniform_real_distribution<double> azimuth(-kPi, kPi), reach(0.01, 0.12), share(0, 0.99);
  std::uniform_int_distribution<int> steps(3, 40);
  std::array<int, 6> handled{};
  for (int trial = 0; trial < 60; ++trial)
    for (const machines::PoleOption option :
         {machines::PoleOption::slow, machines::PoleOption::hold, machines::PoleOption::through}) {
      const double c = option == machines::PoleOption::slow ? 1e-3 : radians(trial % 2 == 0 ? 0.0573 : 0.6);
      const double miss = trial % 5 == 0 ? 0 : trial % 5 == 1 ? 1e-9 : share(random) * c / 2;
      const path::ClPath path = passing(azimuth(random), miss, reach(random), reach(random), steps(random));
      machines::Machine m = pole_machine(option, option == machines::PoleOption::slow ? 0 : degrees(c));
      m.chain.table[0].max_speed = radians(trial % 3 == 0 ? 600 : 12000);
      const auto program = axis_program({path}, m, standing(), 1);
      ASSERT_TRUE(program) << trial << ": " << program.error().message;
      const Followed f = sampled(*program, path, m);
      ASSERT_TRUE(f.finite);
      ASSERT_LE(f.slowest_ratio, 1 + 1e-9) << trial;
      if (program->pole_passages > 0) {
        ++handled[static_cast<std::size_t>(option)];
        EXPECT_EQ(program->pole_axis_rad, c);
      }
      // Ball centre: the subdivision, the rounding, and what slerp about a tip on its chord lets the centre leave its
      // own.
      const double step = 0.24 / 3;
      ASSERT_LE(f.centre_mm, program->chord_bound_mm + program->rounding_bound_mm + 2 * step * step / 8 + 1e-3)
          << trial;
      // Axis: c, the tolerance inside a block, and the step that its place along the path is uncertain by.
      ASSERT_LE(f.axis_rad, program->pole_axis_rad + 1e-3 + 4e-4)
          << trial << " option " << static_cast<int>(option) << " miss " << miss;
    }
  for (const machines::PoleOption option :
       {machines::PoleOption::slow, machines::PoleOption::hold, machines::PoleOption::through})
    EXPECT_GT(handled[static_cast<std::size_t>(option)], 40);
}

// The same paths one after another: exact without a pole, refused by `error`, with what helps.
TEST(Pole, ErrorNamesRecordAngleTurnAndWaysOut) {
  const auto refused =
      axis_program({passing(0.3, 1e-5, 0.1, 0.1, 10)}, pole_machine(machines::PoleOption::error), standing(), 1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message.find(
                "operation 0 record 6: the tool axis passes the pole at 0.0006 deg, C turns by 179.9"),
            0u)
      << refused.error().message;
  EXPECT_NE(refused.error().message.find("or mount the part inclined"), std::string::npos);
  EXPECT_TRUE(
      axis_program({passing(0.3, 0.2, 0.1, 0.1, 10)}, pole_machine(machines::PoleOption::error), standing(), 1));
}

// Records so dense that no single block turns C by much: the way through the cone is seen as a whole.
TEST(Pole, DensePathIsSeen) {
  const path::ClPath path = passing(0.3, 1e-4, 2e-3, 2e-3, 400);  // 1e-5 rad a record
  const auto refused = axis_program({path}, pole_machine(machines::PoleOption::error), standing(), 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("passes the pole at 0.0057 deg"), std::string::npos)
      << refused.error().message;
}

TEST(Pole, TiltSaysHowNearThePlanComes) {
  const path::ClPath path = passing(0.3, radians(3), 0.1, 0.1, 40);
  const auto refused = axis_program({path}, pole_machine(machines::PoleOption::tilt), standing(), 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("comes to 3.0000 deg of the pole of C, post.pole = \"tilt\" keeps 5.0000"),
            std::string::npos)
      << refused.error().message;
  EXPECT_TRUE(axis_program({path}, pole_machine(machines::PoleOption::tilt, 2.9), standing(), 1));
  // A direction that stays has no pole to pass, whatever its tilt.
  EXPECT_TRUE(axis_program({sample_path(0.0, 0)}, pole_machine(machines::PoleOption::tilt), standing(), 1));
  EXPECT_TRUE(axis_program({sample_path(0.02, 0)}, pole_machine(machines::PoleOption::tilt), standing(), 1));
}

// The axis of a finger mill follows from its flank: what serves it instead is named, and runs.
TEST(Pole, TiltAndErrorNameWhatServesFingerMills) {
  std::vector<tool::ToolAssembly> finger = tools();
  finger[0].type = tool::CutterType::finger_mill;
  const auto built = [&](const path::ClPath& path, machines::PoleOption option) {
    const machines::Machine m = pole_machine(option);
    return joints::AxisProgramTestAccess::build(std::vector{path}, finger, standing(), m, 1, kBody,
                                                controls::axis_options(*controls::dialect_of(m), m));
  };
  const auto tilt = built(passing(0.3, radians(3), 0.1, 0.1, 40), machines::PoleOption::tilt);
  ASSERT_FALSE(tilt);
  EXPECT_NE(
      tilt.error().message.find("keeps 5.0000: the axis of a finger mill follows from its flank and is not moved; "
                                "\"slow\" (follows it exactly, at the speed of the rotary) and \"retract\" (turns "
                                "outside the part) serve finger mills, or mount the part inclined"),
      std::string::npos)
      << tilt.error().message;
  const path::ClPath through = passing(0.3, 1e-4, 0.1, 0.1, 10);
  const auto error = built(through, machines::PoleOption::error);
  ASSERT_FALSE(error);
  EXPECT_NE(
      error.error().message.find(
          "limit 30: post.pole = \"slow\" or \"retract\" goes past it with a finger mill, or mount the part inclined"),
      std::string::npos)
      << error.error().message;
  EXPECT_TRUE(built(through, machines::PoleOption::slow));
  EXPECT_TRUE(built(through, machines::PoleOption::retract));
}

// Straight through: A changes its sign, C stands but for the bend. Held: A keeps its sign, C makes the half turn.
TEST(Pole, ThroughChangesTheSideHoldDoesNot) {
  const path::ClPath path = passing(0.7, 1e-5, 0.1, 0.1, 12);
  const auto through = axis_program({path}, pole_machine(machines::PoleOption::through), standing(), 1);
  const auto hold = axis_program({path}, pole_machine(machines::PoleOption::hold), standing(), 1);
  ASSERT_TRUE(through);
  ASSERT_TRUE(hold);
  const Followed t = sampled(*through, path, pole_machine(machines::PoleOption::through)),
                 h = sampled(*hold, path, pole_machine(machines::PoleOption::hold));
  EXPECT_LT(t.a_least, -0.09);
  EXPECT_GT(t.a_greatest, 0.09);
  EXPECT_LT(degrees(t.c_turn),
            0.1 + 4 * degrees(std::asin(1e-5 / 5e-4)));  // to the cone and out of it, and the bend in it
  EXPECT_GT(std::max(h.a_least, -h.a_greatest), -1e-6) << "one side only";
  EXPECT_NEAR(degrees(h.c_turn), 180, 3);
  EXPECT_EQ(through->pole_passages, 1u);
  EXPECT_LT(t.minutes, h.minutes);
}

// What holds the surface is the centre of the ball: other tools are refused, and so is a path that passes too far away
// to be moved.
TEST(Pole, LimitsOfHoldAndThrough) {
  for (const machines::PoleOption option : {machines::PoleOption::hold, machines::PoleOption::through}) {
    const machines::Machine m = pole_machine(option);
    std::vector<tool::ToolAssembly> finger = tools();
    finger[0].type = tool::CutterType::finger_mill;
    const auto dialect = controls::dialect_of(m);
    const auto refused =
        joints::AxisProgramTestAccess::build(std::vector{passing(0.3, 1e-5, 0.1, 0.1, 10)}, finger, standing(), m, 1,
                                             kBody, controls::axis_options(*dialect, m));
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("move the axis of ball tools only"), std::string::npos)
        << refused.error().message;
    const path::ClPath beside = passing(0.3, radians(0.3), 0.1, 0.1, 4);
    const auto far = axis_program({beside}, m, standing(), 1);
    ASSERT_FALSE(far);
    EXPECT_NE(far.error().message.find(
                  "post.pole_angle = 0.0573 deg moves the axis from a path within 0.0286 deg of the pole only"),
              std::string::npos)
        << far.error().message;
    EXPECT_TRUE(axis_program({beside}, pole_machine(option, 0.7), standing(), 1));
    EXPECT_TRUE(axis_program({beside}, pole_machine(machines::PoleOption::slow), standing(), 1)) << "exact, and slow";
  }
}

/// Text of the program, read back, as motions of the tool; compared with the path that was followed.
struct ReadAgain {
  std::vector<path::ToolMotion> motions;
  readback::ClComparison met;
  bool rapids_clear = false;
  double feed_minutes = 0;
};
ReadAgain read_again(const joints::AxisProgram& program, const machines::Machine& m, const path::ClPath& plan) {
  ReadAgain out;
  const auto dialect = controls::dialect_of(m);
  const auto text = text::write_nc(program, *dialect, {});
  EXPECT_TRUE(text);
  const auto control = controls::control_of(m, standing(), tools());
  const auto back = readback::read_back(text->text, "p", *control, m, standing(), {.teeth = 1});
  EXPECT_TRUE(back) << (back ? "" : back.error().text());
  if (!back) return out;
  out.feed_minutes = back->feed_minutes;
  out.motions = *readback::tool_motions(back->operations[0], back->copies, *control, m, standing(), 1, {1e-4, 1e-4});
  const path::ClPath& followed = program.followed.empty() ? plan : program.followed[0];
  const std::vector<const path::ClPath*> list = {&followed};
  out.met = readback::compare_with_cl(
      out.motions, list, program.rounding_bound_mm + program.chord_bound_mm + program.pole_tip_mm + 1e-4, 2e-3);
  const auto rapids = readback::check_rapids(back->operations[0], *control, m, standing(), kBody);
  EXPECT_TRUE(rapids) << (rapids ? "" : rapids.error().message);
  out.rapids_clear = rapids.has_value();
  return out;
}

// Out along the tool, up, turn, down, in along the tool: feed moves next to the part, C turns in no block of the cut.
TEST(Pole, RetractTurnsOutsideThePart) {
  const path::ClPath path = passing(0.3, 2e-4, 0.1, 0.08, 10);
  const machines::Machine m = pole_machine(machines::PoleOption::retract);
  const auto program = axis_program({path}, m, standing(), 1);
  ASSERT_TRUE(program) << program.error().message;
  ASSERT_EQ(program->followed.size(), 1u);
  int retracts = 0, engages = 0;
  for (const auto& r : program->followed[0].records) {
    retracts += r.kind == path::MoveKind::retract;
    engages += r.kind == path::MoveKind::engage;
  }
  EXPECT_EQ(retracts, 2);
  EXPECT_EQ(engages, 2);
  const auto& blocks = program->operations[0].teeth[0].blocks;
  double turned_in_cut = 0, turned_above = 0;
  for (std::size_t i = 1; i < blocks.size(); ++i) {
    const double turn =
        degrees(std::abs(static_cast<double>(blocks[i].words[3] - blocks[i - 1].words[3])) * radians(1e-5));
    (blocks[i].kind == joints::BlockKind::feed ? turned_in_cut : turned_above) += turn;
  }
  const ReadAgain again = read_again(*program, m, path);
  EXPECT_TRUE(again.met.complete) << again.met.message;
  EXPECT_TRUE(again.rapids_clear);
  // The turn about the pole that is left to the cut is what the path makes outside the cone: two times asin(miss /
  // cone) at most.
  EXPECT_LT(turned_in_cut, 2 * degrees(std::asin(2e-4 / 5e-4)) + 3);
  EXPECT_LT(turned_above, 140);  // the other pair may be nearer than a half turn
  const Followed f = sampled(*program, path, m);
  EXPECT_LE(f.axis_rad, 1e-3 + 1e-3 + 4e-4);
}

// What every check downstream gets is read from the text: the changed axes, not the planned ones.
TEST(Pole, ReadBackSeesTheChangedAxes) {
  const path::ClPath path = passing(0.3, radians(0.25), 0.03, 0.03, 60);
  for (const machines::PoleOption option :
       {machines::PoleOption::hold, machines::PoleOption::through, machines::PoleOption::slow}) {
    const machines::Machine m = pole_machine(option, 0.8);
    path::ClPath steep = path;
    const auto program = axis_program({steep}, m, standing(), 1);
    ASSERT_TRUE(program) << program.error().message;
    const ReadAgain again = read_again(*program, m, steep);
    EXPECT_TRUE(again.met.complete) << static_cast<int>(option) << again.met.message;
    double nearest = 1, from_plan = 0;
    for (const auto& motion : again.motions) {
      if (motion.rapid) continue;
      nearest = std::min(nearest, angle_between(motion.axis_to, Vec3::UnitZ()));
      double d = 1;
      for (std::size_t i = 1; i < steep.records.size(); ++i)
        for (int s = 0; s <= 10; ++s)
          d = std::min(
              d, angle_between(motion.axis_to, blend(steep.records[i - 1].axis, steep.records[i].axis, s / 10.0)));
      from_plan = std::max(from_plan, d);
    }
    if (option == machines::PoleOption::through) {
      EXPECT_LT(nearest, 1e-5);
      EXPECT_NEAR(from_plan, radians(0.25), radians(0.02));  // the planned axes pass the pole at this distance
    }
    if (option == machines::PoleOption::slow) {
      EXPECT_NEAR(nearest, radians(0.25), 1e-3);
      EXPECT_LT(from_plan, 1.5e-3);
    }
    EXPECT_NEAR(again.feed_minutes, program->feed_minutes, 0.02 * program->feed_minutes);
  }
}

// Exactly through the pole, slowly: C makes half a turn at its full speed and no faster.
TEST(Pole, SlowGivesCItsTime) {
  const path::ClPath path = passing(0.3, 0, 0.1, 0.1, 11);
  machines::Machine m = pole_machine(machines::PoleOption::slow);
  m.chain.table[0].max_speed = radians(360);
  const auto program = axis_program({path}, m, standing(), 1);
  ASSERT_TRUE(program) << program.error().message;
  const Followed f = sampled(*program, path, m);
  EXPECT_NEAR(degrees(f.c_turn), 180, 2);
  EXPECT_GT(f.minutes, 0.5);
  EXPECT_LE(f.slowest_ratio, 1 + 1e-9);
  EXPECT_GT(program->time_ruled[3], 5u);
}

// The turn goes where the chain has its pole: nutating tables, heads; none where the tool never comes parallel.
TEST(Pole, PolesOfTheClasses) {
  EXPECT_EQ(joints::poles_of(trunnion().chain).size(), 2u);
  machines::KinematicChain nutating = trunnion().chain;
  nutating.table[1].direction = Vec3(0, 1, 1).normalized();
  ASSERT_EQ(joints::poles_of(nutating).size(), 1u);
  EXPECT_LT((joints::poles_of(nutating)[0] - Vec3::UnitZ()).norm(), 1e-12);
  nutating.table[1].direction = Vec3(0, std::sin(0.6), std::cos(0.6));
  nutating.table[0].direction = Vec3(0, std::sin(0.3), std::cos(0.3));
  EXPECT_TRUE(joints::poles_of(nutating).empty());
  machines::KinematicChain three;
  EXPECT_TRUE(joints::poles_of(three).empty());
}

}  // namespace
}  // namespace toothpath
