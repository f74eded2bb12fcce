// Where the part has the most room in the travels: against brute force, against programs that are built there.
#include <gtest/gtest.h>

#include <random>

#include "postproc/choice/travel_offer.h"
#include "postproc/numbers/small_linear_program.h"
#include "tests/postproc/readback/nc_case.h"

namespace toothpath {
namespace {

using namespace test;

double least(const std::array<double, 3>& room) { return std::min({room[0], room[1], room[2]}); }

TEST(SmallLinearProgram, AgainstAllVertices) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> right(0.5, 3);
  for (int trial = 0; trial < 200; ++trial) {
    const int n = 1 + trial % 4;
    std::vector<numbers::LinearRow> rows(60);
    for (auto& r : rows) {
      for (int i = 0; i < n; ++i) r.a[static_cast<std::size_t>(i)] = normal(random);
      r.b = right(random);
    }
    numbers::LinearPoint objective{};
    for (int i = 0; i < n; ++i) objective[static_cast<std::size_t>(i)] = normal(random);
    const auto dot = [](const std::array<double, 4>& a, const numbers::LinearPoint& x) {
      return a[0] * x[0] + a[1] * x[1] + a[2] * x[2] + a[3] * x[3];
    };
    const auto x = numbers::maximize(n, objective, 50, [&](const numbers::LinearPoint& p) {
      return *std::max_element(rows.begin(), rows.end(), [&](const numbers::LinearRow& a, const numbers::LinearRow& b) {
        return dot(a.a, p) - a.b < dot(b.a, p) - b.b;
      });
    });
    ASSERT_TRUE(x);
    for (const auto& r : rows) ASSERT_LE(dot(r.a, *x) - r.b, 1e-8);
    // No feasible random point is better: walks from the optimum and from the origin.
    std::uniform_real_distribution<double> step(-0.3, 0.3);
    for (int k = 0; k < 300; ++k) {
      numbers::LinearPoint p = *x;
      for (int i = 0; i < n; ++i) p[static_cast<std::size_t>(i)] += step(random) * std::pow(0.1, k % 4);
      const bool inside =
          std::all_of(rows.begin(), rows.end(), [&](const numbers::LinearRow& r) { return dot(r.a, p) <= r.b; });
      if (inside) { ASSERT_LE(dot(objective, p), dot(objective, *x) + 1e-7); }
    }
  }
  // Nothing keeps both rows.
  const std::vector<numbers::LinearRow> none = {{{1, 0, 0, 0}, -1}, {{-1, 0, 0, 0}, -1}};
  EXPECT_FALSE(numbers::maximize(
      1, {1, 0, 0, 0}, 50, [&](const numbers::LinearPoint& p) { return p[0] + 1 > -p[0] + 1 ? none[0] : none[1]; }));
}

machines::Joints at(double x, double y, double z, double c, double a) { return {Vec3(x, y, z), {c, a}}; }

// Random poses of a trunnion: the joints move with the part as their angles say, and no random shift has more room.
TEST(PartOffset, BruteForceNeverBeatsIt) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> mm(-120, 120), turn(-kPi, kPi), tilt(-1.2, 0.6), shift(-900, 900);
  for (int trial = 0; trial < 12; ++trial) {
    const machines::Machine m = trunnion();
    const std::optional<Vec3> axis = trial % 3 == 2 ? std::optional(Vec3(Vec3::UnitZ())) : std::nullopt;
    choice::TravelPoses poses(m.chain, m.limit_margin, axis);
    std::vector<machines::Joints> list;
    const int n = 3 + 40 * (trial % 4);
    for (int i = 0; i < n; ++i) {
      const double c = trial % 2 == 0 ? turn(random) : 0, a = trial < 6 ? tilt(random) : -0.4;
      list.push_back(at(200 + mm(random), -150 + mm(random), mm(random), c, a));
      poses.note(list.back());
    }
    const auto offer = poses.best();
    ASSERT_TRUE(offer);
    // The rooms are those of the poses themselves, placed again by the kinematics.
    const auto room_by_kinematics = [&](const Vec3& d) {
      std::array<double, 3> room = {1e9, 1e9, 1e9};
      for (const auto& j : list) {
        const machines::TablePose pose = m.chain.forward(j, 95);
        const machines::Joints moved = m.chain.linear_for(pose.tip_mm + d, j.rotary_rad, 95);
        for (int k = 0; k < 3; ++k) {
          const auto i = static_cast<std::size_t>(k);
          room[i] = std::min({room[i], moved.linear_mm[k] - m.chain.linear[i].min_mm - m.limit_margin.linear_mm,
                              m.chain.linear[i].max_mm - m.limit_margin.linear_mm - moved.linear_mm[k]});
        }
      }
      return room;
    };
    const auto then = room_by_kinematics(offer->shift_mm), now = room_by_kinematics(Vec3::Zero());
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(then[i], offer->room_then_mm[i], 1e-9);
      EXPECT_NEAR(now[i], offer->room_now_mm[i], 1e-9);
    }
    EXPECT_GE(least(then), least(now) - 2e-3);
    if (axis) { EXPECT_LT(offer->shift_mm.cross(*axis).norm(), 1e-9); }
    for (int k = 0; k < 3000; ++k) {
      const double scale = std::pow(0.1, k % 5);
      Vec3 d = offer->shift_mm + scale * Vec3(shift(random), shift(random), shift(random));
      if (axis) d = d.dot(*axis) * *axis;
      if (least(offer->room_then_mm) >= 0) d.z() = std::abs(d.z());  // a lower seat is offered only where no other fits
      ASSERT_LE(least(poses.room(d)), least(offer->room_then_mm) + 2e-3)
          << trial;  // 1 um of rounding in each coordinate
    }
  }
}

// What is left free by the tightest axis goes to the others: without rotaries each axis stands in the middle of its
// travel.
TEST(PartOffset, EveryAxisIsCentred) {
  machines::Machine m = trunnion();
  m.chain.table.clear();
  m.chain.linear = {machines::LinearAxis{-300, 300, 1000}, machines::LinearAxis{-200, 200, 1000},
                    machines::LinearAxis{-400, 0, 1000}};
  choice::TravelPoses poses(m.chain, m.limit_margin, std::nullopt);
  for (const Vec3& p : {Vec3(10, -60, -350), Vec3(110, 60, -320), Vec3(40, 0, -390)}) poses.note({p, {0, 0}});
  const auto offer = poses.best();
  ASSERT_TRUE(offer);
  EXPECT_LT((offer->shift_mm - Vec3(-60, 0, 155)).norm(), 2e-3);
  EXPECT_NEAR(offer->room_then_mm[0], 300 - 0.1 - 50, 2e-3);
  EXPECT_NEAR(offer->room_then_mm[1], 200 - 0.1 - 60, 2e-3);
  EXPECT_NEAR(offer->room_then_mm[2], 200 - 0.1 - 35, 2e-3);
}

// A job that is refused for its travel is accepted where the message says, and has the room there that it says.
TEST(PartOffset, RefusedJobIsAcceptedAtTheOffer) {
  for (const bool eccentric : {false, true}) {
    machines::Machine m = trunnion();
    toothpath::joints::Setup s = standing();
    const auto path = sample_path(0.15, 0.1);
    if (eccentric) {
      s.origin_mm += Vec3(6, -4, 0);
      const auto wide = axis_program({path}, m, s, 5);
      ASSERT_TRUE(wide);
      // The gear swings about the axis of C: with less travel than it needs there it must stand nearer to it.
      m.chain.linear[0].min_mm = wide->ranges[0].min + 2;
      m.chain.linear[0].max_mm = wide->ranges[0].max - 2;
    } else {
      m.chain.linear[2].max_mm = 420;
      m.chain.linear[2].min_mm = 260;  // deepest at 241
    }
    const auto refused = axis_program({path}, m, s, 5);
    ASSERT_FALSE(refused) << eccentric;
    const std::string& text = refused.error().message;
    const auto from = text.find("most room: set-up origin [");
    ASSERT_NE(from, std::string::npos) << text;
    double x = 0, y = 0, z = 0, wx = 0, wy = 0, wz = 0, rx = 0, ry = 0, rz = 0;
    ASSERT_EQ(std::sscanf(text.c_str() + from,
                          "most room: set-up origin [%lf, %lf, %lf] with work_offset_at [%lf, %lf, %lf] leaves X %lf, "
                          "Y %lf, Z %lf mm",
                          &x, &y, &z, &wx, &wy, &wz, &rx, &ry, &rz),
              9)
        << text;
    toothpath::joints::Setup there = s;
    there.origin_mm = Vec3(x, y, z);
    there.work_offset_at_mm = Vec3(wx, wy, wz);
    EXPECT_LT((there.work_offset_at_mm - s.work_offset_at_mm - (there.origin_mm - s.origin_mm)).norm(), 1e-9);
    const auto accepted = axis_program({path}, m, there, 5);
    ASSERT_TRUE(accepted) << accepted.error().message;
    if (!eccentric) {
      EXPECT_LT((there.origin_mm - s.origin_mm).head<2>().norm(), 1e-9) << "the gear stays on the axis that turns it";
    }
    // The room that was promised, from the joints of the program that was built there.
    const std::array<double, 3> promised = {rx, ry, rz};
    for (std::size_t i = 0; i < 3; ++i) {
      double room = 1e9;
      bool positioned = false;  // before its first block in X and Y the machine stands anywhere
      for (const auto& op : accepted->operations)
        for (const auto& tooth : op.teeth)
          for (const auto& b : tooth.blocks) {
            positioned = positioned || b.kind == joints::BlockKind::rapid_xy;
            if (!positioned) continue;
            const bool top = i == 2 && b.kind != joints::BlockKind::feed;
            const double j = static_cast<double>(b.words[i]) * 1e-4 + accepted->work_offset_at_mm[static_cast<int>(i)] +
                             (i == 2 ? op.tool_length_mm : 0);
            if (!top) room = std::min({room, j - m.chain.linear[i].min_mm - 0.1, m.chain.linear[i].max_mm - 0.1 - j});
          }
      EXPECT_GE(room, promised[i] - 0.01) << i;
    }
    ASSERT_TRUE(accepted->offer);
    EXPECT_LT(least(accepted->offer->room_then_mm), least(accepted->offer->room_now_mm) + 0.01)
        << "nothing better from there";
  }
}

// Downwards only where nothing else fits.
TEST(PartOffset, LowerOnlyWhereItMust) {
  machines::Machine m = trunnion();
  m.chain.table.clear();
  m.chain.linear = {machines::LinearAxis{-300, 300, 1000}, machines::LinearAxis{-200, 200, 1000},
                    machines::LinearAxis{-400, 0, 1000}};
  for (const double top : {-20.0, 12.0}) {
    choice::TravelPoses poses(m.chain, m.limit_margin, std::nullopt);
    poses.note({Vec3(0, 0, top), {0, 0}});
    poses.note({Vec3(0, 0, top - 40), {0, 0}});
    const auto offer = poses.best();
    ASSERT_TRUE(offer);
    EXPECT_NEAR(offer->shift_mm.z(), top < 0 ? 0 : -192, 2e-3);
    EXPECT_NEAR(offer->room_then_mm[2], top < 0 ? 19.9 : 179.9, 2e-3);
  }
}

TEST(PartOffset, NowhereIsSaid) {
  machines::Machine m = trunnion();
  m.chain.linear[2] = {240, 300, 30000};
  m.chain.linear[0] = {-5, 5, 30000};  // the pass alone is longer
  toothpath::joints::Setup s = standing();
  s.origin_mm += Vec3(1, 0, 0);
  const auto refused = axis_program({sample_path(0, 0)}, m, s, 1);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("nowhere does the part have room: at best X -"), std::string::npos)
      << refused.error().message;
}

// Links over a part that stands too high: the error says what is short, and what it names helps.
TEST(PartOffset, PartTooHighForItsLinksFitsFartherDownAndWithAShorterTool) {
  machines::Machine m = trunnion();
  m.chain.linear[2].max_mm = 275;
  const auto path = sample_path(0.3, 0.1);
  const auto options = controls::axis_options(*controls::dialect_of(m), m);
  const auto build = [&](const toothpath::joints::Setup& s, double length) {
    auto list = tools();
    list[0].length_mm = length;
    return toothpath::joints::AxisProgramTestAccess::build(std::vector{path}, list, s, m, 5, kBody, options);
  };
  const auto refused = build(standing(), 95);
  ASSERT_FALSE(refused);
  const std::string text = refused.error().message;
  double needed = 0, rises = 0, shorter = 0, lower = 0;
  const auto number = [&](const char* behind, double& out) {
    const auto at = text.find(behind);
    ASSERT_NE(at, std::string::npos) << text;
    out = std::stod(text.substr(at + std::string(behind).size()));
  };
  number("links need the tip of T1 at ", needed);
  number("it rises to ", rises);
  number("shorter by ", shorter);
  number("or the part ", lower);
  EXPECT_NEAR(rises, 275 - 0.1 - 95, 1e-9);
  EXPECT_GT(needed, rises);
  EXPECT_NEAR(shorter, needed - rises, 2e-3);
  EXPECT_TRUE(build(standing(), 95 - shorter));
  EXPECT_FALSE(build(standing(), 95 - shorter + 0.01));
  toothpath::joints::Setup s = standing();
  s.origin_mm.z() -= lower;
  s.work_offset_at_mm.z() -= lower;
  EXPECT_TRUE(build(s, 95));
  EXPECT_NE(
      text.find(fmt::format("setup.origin = [3.000, -2.000, {:.3f}] with work_offset_at = [3.000, -2.000, {:.3f}] "
                            "fits",
                            s.origin_mm.z(), s.work_offset_at_mm.z())),
      std::string::npos)
      << text;
}

}  // namespace
}  // namespace toothpath
