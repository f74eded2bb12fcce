// Tool axes prescribed by keys: the curve through them, axes and ball centres of a planned job by another route,
// refusals against samples.
#include "cam/ball/prescribed_axes.h"

#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_gear_solid.h"
#include "tests/support/plain_frustum.h"

namespace toothpath {
namespace {

path::ToolAxisKey key(double radius, double outwards_deg, double aside_deg) {
  return {radius, radians(outwards_deg), radians(aside_deg)};
}

face_gear::FaceGearParameters narrow_spur() {
  face_gear::FaceGearParameters g = test::small_spur();
  g.zones = {{0, 60, 63}};
  return g;
}
tool::ToolAssembly slim_tool() { return test::ball_mill(1, 6, 0.95, 16, 10); }

path::MillingOperation with_axes(std::vector<path::ToolAxisKey> plus, std::vector<path::ToolAxisKey> minus) {
  path::MillingOperation o = test::finishing(0, 0.08, 0.002);
  o.axis_plus = std::move(plus);
  o.axis_minus = std::move(minus);
  return o;
}
test::PlannedJob planned_with(const std::vector<path::ToolAxisKey>& plus, const std::vector<path::ToolAxisKey>& minus) {
  return test::planned(narrow_spur(), {slim_tool()}, {with_axes(plus, minus)});
}
ball::PlanRefusal refused_with(const face_gear::FaceGear& gear, const tool::ToolAssembly& tool,
                               const std::vector<path::ToolAxisKey>& keys) {
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({tool}));
  const auto plan = plan::plan_milling(part, {tool}, {with_axes(keys, keys)}, {});
  const auto* refusal = plan.refused();
  return refusal != nullptr ? *refusal : ball::PlanRefusal{};
}

TEST(PrescribedLean, PassesItsKeysSmoothlyAndStaysInTheirBoxes) {
  test::Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<path::ToolAxisKey> keys;
    double r = 50;
    const auto count = 2 + random.index(6);
    for (std::size_t k = 0; k < count; ++k) keys.push_back(key(r += random(0.1, 4), random(-30, 30), random(-20, 20)));
    const ball::PrescribedLean lean(keys);
    const auto tangents = [](const path::ToolAxisKey& k) {
      return Vec2(std::tan(k.outwards_rad), std::tan(k.aside_rad));
    };
    for (const auto& k : keys) EXPECT_LT((lean.at(k.radius_mm) - tangents(k)).norm(), 1e-12);
    EXPECT_EQ(lean.at(1), tangents(keys.front()));
    EXPECT_EQ(lean.at(1e4), tangents(keys.back()));
    for (std::size_t k = 1; k < keys.size(); ++k) {
      const Vec2 a = tangents(keys[k - 1]), b = tangents(keys[k]);
      for (int s = 0; s <= 40; ++s) {
        const Vec2 q = lean.at(keys[k - 1].radius_mm + (keys[k].radius_mm - keys[k - 1].radius_mm) * s / 40.0);
        for (int i = 0; i < 2; ++i) {
          EXPECT_GE(q[i], std::min(a[i], b[i]) - 1e-12);
          EXPECT_LE(q[i], std::max(a[i], b[i]) + 1e-12);
        }
      }
    }
    constexpr double e = 1e-6;
    for (const auto& k : keys) {
      const Vec2 before = (lean.at(k.radius_mm) - lean.at(k.radius_mm - e)) / e,
                 after = (lean.at(k.radius_mm + e) - lean.at(k.radius_mm)) / e;
      EXPECT_LT((before - after).norm(), 1e-3);
    }
  }
}

TEST(PrescribedLean, TwoKeysTurnTheAxisOnTheGreatCircle) {
  const ball::PrescribedLean lean({key(60, -12, 7), key(66, 20, -4)});
  const auto axis = [&](double r) { return Vec3(lean.at(r).x(), lean.at(r).y(), 1).normalized(); };
  const Vec3 normal = axis(60).cross(axis(66)).normalized();
  for (double r = 60; r <= 66; r += 0.1) EXPECT_NEAR(axis(r).dot(normal), 0, 1e-14);
}

// A spur gear at 90 deg: up is z, outwards the radial direction in the middle of the space. The centres are those of
// the job that is left to the planner; the axis at a radius is read off two keys by hand.
TEST(PrescribedAxes, AxisFollowsTheKeysAndTheBallStaysOnItsPass) {
  const auto free = planned_with({}, {});
  const auto job = planned_with({key(60.8, -3, 0), key(62.2, 3, 0)}, {key(60.8, -3, 0), key(62.2, 3, 0)});
  const double R = job.tools[0].radius_mm(), middle = job.part->space_azimuth(0, 61.5);
  std::vector<std::pair<Vec3, Vec3>> centres;  // straight pieces of the free passes
  const auto& fixed = free.plan.paths[0].records;
  for (std::size_t k = 1; k < fixed.size(); ++k)
    if (fixed[k].kind == path::MoveKind::feed)
      centres.emplace_back(fixed[k - 1].tip + R * fixed[k - 1].axis, fixed[k].tip + R * fixed[k].axis);
  const auto off = [&](const Vec3& p) {
    double least = INFINITY;
    for (const auto& [a, b] : centres) {
      const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      least = std::min(least, (p - a - t * (b - a)).norm());
    }
    return least;
  };
  double nearest = 1, sag = 0;
  int feeds = 0;
  const auto& records = job.plan.paths[0].records;
  for (std::size_t k = 1; k < records.size(); ++k) {
    if (records[k].kind != path::MoveKind::feed) continue;
    ++feeds;
    const Vec3 c = records[k].tip + R * records[k].axis;
    EXPECT_LT(off(c), 1e-9) << k;
    const double r = std::hypot(c.x(), c.y()), t = std::clamp((r - 60.8) / 1.4, 0.0, 1.0);
    const double out = std::tan(radians(3)) * (2 * (3 * t * t - 2 * t * t * t) - 1);
    const Vec3 expected = Vec3(out * std::cos(middle), out * std::sin(middle), 1).normalized();
    EXPECT_LT(angle_between(records[k].axis, expected), 1e-9) << k;
    const double turn = angle_between(records[k - 1].axis, records[k].axis);
    EXPECT_LE(turn, ball::kMostTurnPerRecord);
    for (double s = 0; s <= 1; s += 0.125) {
      const Vec3 axis = ((1 - s) * records[k - 1].axis + s * records[k].axis).normalized();
      nearest = std::min(nearest, angle_between(axis, Vec3::UnitZ()));
      sag = std::max(sag, off((1 - s) * records[k - 1].tip + s * records[k].tip + R * axis));
    }
  }
  EXPECT_GT(feeds, 50);
  EXPECT_LT(nearest, 1e-3);
  EXPECT_GT(sag, 0);
  EXPECT_LT(sag, 2e-4);
  const auto& d = job.plan.directions.front();
  EXPECT_FALSE(d.fixed);
  EXPECT_EQ(d.turning_passes, d.passes);
  EXPECT_NEAR(degrees(d.greatest_lean_rad), 3, 1e-6);
  EXPECT_NE(d.explanation.find("prescribed: lean 0.0"), std::string::npos) << d.explanation;
  const analytic::GougeCheck check(*job.part, job.tools, job.check_options());
  EXPECT_TRUE(check.check_path(job.plan.paths[0]));
}

// Each flank has its keys: with lean aside 2 deg on flank +1 and -2 deg on flank -1 the tool leans away from the flank
// that it cuts.
TEST(PrescribedAxes, FlanksHaveTheirOwnKeys) {
  const auto job = planned_with({key(61, 0, 2)}, {key(61, 0, -2)});
  const double R = job.tools[0].radius_mm();
  int plus = 0, minus = 0;
  for (const auto& r : job.plan.paths[0].records) {
    if (r.kind != path::MoveKind::feed) continue;
    const Vec3 c = r.tip + R * r.axis;
    const auto near = job.part->nearest(c, R + 0.05);
    if (near.patch != std::string("flank +1") && near.patch != std::string("flank -1")) continue;
    const double aside = r.axis.dot(Vec3(-std::sin(std::atan2(c.y(), c.x())), std::cos(std::atan2(c.y(), c.x())), 0));
    if (near.patch == std::string("flank +1")) {
      ++plus;
      EXPECT_GT(aside, 0.03);
      EXPECT_GT((c - near.foot).normalized().dot(r.axis), std::sin(radians(15))) << "leans away from the flank";
    } else {
      ++minus;
      EXPECT_LT(aside, -0.03);
    }
  }
  EXPECT_GT(plus, 10);
  EXPECT_GT(minus, 10);
  EXPECT_EQ(job.plan.directions.front().turning_passes, 0);
  EXPECT_FALSE(job.plan.directions.front().fixed);
}

TEST(PrescribedAxes, OneKeyForBothFlanksIsAFixedDirection) {
  const auto job = planned_with({key(61, 4, 1)}, {key(61, 4, 1)});
  const auto& d = job.plan.directions.front();
  EXPECT_TRUE(d.fixed);
  EXPECT_NE(d.explanation.find("prescribed: leans 4.12 deg"), std::string::npos) << d.explanation;
  for (const auto& r : job.plan.paths[0].records) EXPECT_LT((r.axis - d.axis).norm(), 1e-12);
}

// A holder that is too low for a lean aside: the refusal names a place at which sampled points of the teeth are inside
// it.
TEST(PrescribedAxes, RefusalsNameThePlaceTheBodyAndTheLimit) {
  const face_gear::FaceGear gear = test::made(narrow_spur());
  tool::ToolAssembly low = slim_tool();
  low.holder = {{30, 30, 30}};
  low.stick_out_mm = 7;
  const auto holder = refused_with(gear, low, {key(60, 0, 0), key(63, 0, 12)});
  EXPECT_EQ(holder.key, "operation[0].tool_axis");
  EXPECT_NE(holder.diagnostic.message.find("its holder cuts in by"), std::string::npos) << holder.diagnostic.message;
  EXPECT_NE(holder.diagnostic.message.find("the clearance is 0.050 mm"), std::string::npos);
  double r = 0, height = 0, outwards = 0, aside = 0;
  ASSERT_EQ(std::sscanf(holder.diagnostic.message.c_str(),
                        "tool 1 in zone 0: with the ball at radius %lf, height %lf the prescribed axis leans %lf deg "
                        "outwards and %lf deg aside",
                        &r, &height, &outwards, &aside),
            4)
      << holder.diagnostic.message;
  EXPECT_EQ(outwards, 0);
  EXPECT_GT(aside, 5);
  const test::BruteForceGearSolid brute(gear);
  const analytic::GearDistance part(face_gear::part_of(gear), 1);
  const double a = part.space_azimuth(0, 61.5);
  const Vec3 outward(std::cos(a), std::sin(a), 0), side(-outward.y(), outward.x(), 0);
  const Vec3 axis = std::cos(radians(aside)) * Vec3::UnitZ() + std::sin(radians(aside)) * side,
             tip = r * outward + height * Vec3::UnitZ() - 0.5 * axis;
  double least = INFINITY;
  for (const auto& body : tool::shank_and_holder(low))
    for (int tooth = -6; tooth <= 6; ++tooth)
      for (int patch = 0; patch < 6; ++patch)
        for (int i = 0; i <= 10; ++i)
          for (int j = 0; j <= 10; ++j) {
            const Vec3 p = turned(brute.point(0, patch, i / 10.0, j / 10.0), tooth * gear.pitch());
            least = std::min(least, test::distance_to_frustum(p, body, tip, axis));
          }
  EXPECT_EQ(least, 0) << "it is inside";

  const auto draft = refused_with(gear, slim_tool(), {key(61, 0, 28)});
  EXPECT_NE(draft.diagnostic.message.find("0.000 deg outwards and 28.000 deg aside"), std::string::npos)
      << draft.diagnostic.message;
  EXPECT_TRUE(refused_with(gear, slim_tool(), {key(61, 0, 5)}).key.empty()) << "clear";
}

}  // namespace
}  // namespace toothpath
