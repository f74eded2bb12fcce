// Whole passes: what the moving mill leaves of a flank and how deep it cuts, by brute force on a surface made by
// sweeping the shaper; planted errors of 2 um that it must find; ends, feeds, choices and refusals.
#include "cam/line/passes.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <map>
#include <set>

#include "cam/line/plan.h"
#include "cam/line/smooth.h"
#include "tests/cam/line/line_cases.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/support/brute_force_bodies.h"
#include "tests/support/brute_force_line.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using namespace line;

line::PassOptions options_of(const LineCase& c, line::Rotaries rotaries = line::Rotaries::both) {
  line::PassOptions o;
  o.rotaries = rotaries;
  o.lift_from = c.zone > 0;
  o.lift_to = c.zone + 1 < int(c.gear.zones.size());
  o.chord_mm = 5e-4 * std::max(1.0, c.gear.module_mm / 2);
  return o;
}

line::LinePass pass_of(const LineCase& c, const line::PassOptions& o) {
  const auto task = c.task();
  const auto pass = line::plan_pass(line::LineFit(task, tapered(c.r_0), line::strips_of(task, 1)[0]), o, 100);
  if (!pass) throw std::runtime_error(pass.error().message);
  return *pass;
}

/// Past tooth 0.
std::vector<BrutePose> way_of(const line::LinePass& pass, const LineCase& c) {
  const double turn = pass.side > 0 ? 0 : -2 * kPi / c.gear.teeth;
  std::vector<BrutePose> way;
  for (const auto& r : pass.records)
    way.push_back({turned(r.axis.c_0 - c.r_0 * r.axis.a, turn), turned(r.axis.a, turn)});
  return way;
}

std::vector<Vec3> points_between(const LineCase& c, double r_from, double r_to, int columns, int rows) {
  const auto f = c.task();
  const BruteForceFaceGear brute(c.gear, c.gear.zones[std::size_t(c.zone)].helix_angle_rad);
  return swept_flank(
      brute, std::max(r_from, f.s_from), std::min(r_to, f.s_to),
      [&](double r) { return *face_gear::fillet_line_height(f.surface, c.side, r); },
      [&](double r) { return f.surface.z_tip(r); },
      [&](double r, double z) {
        return face_gear::flank_azimuth(f.surface, c.side, *face_gear::invert_flank(f.surface, c.side, r, z));
      },
      columns, rows);
}

/// The flank of a case as swept points: 25 radii by 17 heights, borders included.
const std::vector<Vec3>& flank_points(const LineCase& c) {
  static std::map<std::string, std::vector<Vec3>> known;
  const auto it = known.find(c.name);
  return it != known.end() ? it->second : known.emplace(c.name, points_between(c, 0, INFINITY, 25, 17)).first->second;
}

BruteConicalMill mill_of(const LineCase& c) { return {c.r_0, radians(5)}; }

class LinePasses : public testing::TestWithParam<LineCase> {};

// L8 without NC text, against the table of the study (its records a tenth of a module apart, its leans smoothed by a
// polynomial).
TEST_P(LinePasses, SweptFlank) {
  const auto& c = GetParam();
  const auto pass = pass_of(c, options_of(c));
  const auto result = swept(flank_points(c), mill_of(c), way_of(pass, c));
  std::printf(
      "%-18s left %.3f um (study %.2f), gouge %.3f um (study %.2f); planned %.3f + chord %.3f um, %zu records\n",
      c.name.c_str(), 1e3 * result.left, c.left, 1e3 * result.gouge, c.gouge, 1e3 * pass.misfit_mm, 1e3 * pass.chord_mm,
      pass.records.size());
  EXPECT_LT(1e3 * result.left, c.left + 0.3);
  EXPECT_LT(1e3 * result.gouge, c.gouge + 0.3);
  // And by its own figures, which a ledger adds up.
  EXPECT_LT(result.left, pass.misfit_mm + pass.chord_mm + 1e-4);
  EXPECT_LT(result.gouge, 0.25 * pass.chord_mm + 2e-5);
}

// A bias lifts the whole pass off by that, no more and no less.
TEST_P(LinePasses, BiasIsKept) {
  const auto& c = GetParam();
  auto o = options_of(c);
  o.chord_mm = 1e-4;
  o.bias_mm = 5e-4;
  const auto pass = pass_of(c, o);
  const auto result = swept(flank_points(c), mill_of(c), way_of(pass, c));
  EXPECT_LT(1e3 * result.gouge, -0.45);
  EXPECT_GT(1e3 * result.gouge, -0.53);
}

INSTANTIATE_TEST_SUITE_P(Study, LinePasses, testing::ValuesIn(line_cases()),
                         [](const auto& i) { return i.param.name; });

const LineCase& case_of(const std::string& name) {
  const auto& cases = line_cases();
  return *std::find_if(cases.begin(), cases.end(), [&](const LineCase& c) { return c.name == name; });
}

/// A clean pass of a flank, to plant errors in. The clean gouge is below 0.3 um.
class Planted : public testing::TestWithParam<const char*> {
 protected:
  const LineCase& c = case_of(GetParam());
  line::LinePass pass = pass_of(c, options_of(c));
  std::vector<BrutePose> way = way_of(pass, c);
  FaceFlank task = c.task();
  BruteSwept measured(const BruteConicalMill& mill) const { return swept(flank_points(c), mill, way); }
  /// Out of the material at the anchor of a record.
  [[nodiscard]] Vec3 normal(std::size_t k) const {
    const Vec3& p = pass.records[k].anchor;
    const auto at = task.place(p.head<2>().norm(), p.z());
    return task.surface.flank(c.side, at.u, at.v).n;
  }
  static constexpr double kFault = 2e-3;
};

TEST_P(Planted, Nothing) { EXPECT_LT(measured(mill_of(c)).gouge, 3e-4); }

TEST_P(Planted, WholePass) {
  for (std::size_t k = 0; k < way.size(); ++k) way[k].tip -= kFault * normal(k);
  const double gouge = measured(mill_of(c)).gouge;
  EXPECT_GT(gouge, 1.7e-3);
  EXPECT_LT(gouge, 2.4e-3);
}

TEST_P(Planted, WholePassStandsOff) {
  const double clean = measured(mill_of(c)).left;
  for (std::size_t k = 0; k < way.size(); ++k) way[k].tip += kFault * normal(k);
  EXPECT_NEAR(measured(mill_of(c)).left, clean + kFault, 4e-4);
}

TEST_P(Planted, OneRecord) {
  Random random(11);
  for (int run = 0; run < 4; ++run) {
    const std::size_t k = way.size() / 4 + random.index(way.size() / 2);
    const double r = pass.records[k].s, reach = 0.1 * c.gear.module_mm;
    // The fault is two blocks wide: seen on a grid that is fine enough for it.
    const auto points = points_between(c, r - reach, r + reach, 15, 9);
    const double clean = swept(points, mill_of(c), way).gouge;
    way[k].tip -= kFault * normal(k);
    const double gouge = swept(points, mill_of(c), way).gouge;
    EXPECT_GT(gouge, 1.7e-3) << "record " << k;
    EXPECT_LT(clean, 1e-4) << "record " << k;
    way[k].tip += kFault * normal(k);
  }
}

TEST_P(Planted, SideThickerThanItsBall) {
  auto mill = mill_of(c);
  mill.thicker = kFault;
  mill.thicker_from = 1.2 * c.gear.module_mm;
  EXPECT_GT(measured(mill).gouge, 1.7e-3);
}

TEST_P(Planted, BallTooLarge) {
  auto mill = mill_of(c);
  mill.r_0 += kFault;
  for (auto& p : way) p.tip -= kFault * p.axis;  // the centre stays
  EXPECT_GT(measured(mill).gouge, 1.7e-3);
}

TEST_P(Planted, HalfAngle) {
  const double length = pass.contact_top_mm - c.r_0;
  auto mill = mill_of(c);
  mill.half_angle += kFault / length;  // 2 um at the tips
  EXPECT_GT(measured(mill).gouge, 1.6e-3);
}

TEST_P(Planted, Tilt) {
  // The axis falls towards the flank by 2 um over the line, its ball end stays.
  const double length = pass.contact_top_mm - c.r_0;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const Vec3 centre = way[k].tip + c.r_0 * way[k].axis;
    way[k].axis = (way[k].axis - kFault / length * normal(k)).normalized();
    way[k].tip = centre - c.r_0 * way[k].axis;
  }
  EXPECT_GT(measured(mill_of(c)).gouge, 1.4e-3);
}

TEST_P(Planted, PassEndsEarly) {
  const double clean = measured(mill_of(c)).left;
  way.resize(2 * way.size() / 3);
  EXPECT_GT(measured(mill_of(c)).left, clean + kFault);
}

INSTANTIATE_TEST_SUITE_P(Faults, Planted, testing::Values("inner_plus", "outer_minus", "spur_plus"),
                         [](const auto& i) { return i.param; });

// Everything else of the finished gear: opposite flank, fillets, root, tips, ends, the other ring across the groove.
// Ball, side and shank.
TEST(LinePassRoom, NothingElseIsCut) {
  for (const char* name : {"inner_plus", "inner_minus", "outer_plus", "outer_minus"}) {
    const auto& c = case_of(name);
    const auto gear = made(c.gear);
    const auto pass = pass_of(c, options_of(c));
    const auto way = way_of(pass, c);
    const BruteForceBodies bodies(gear, 12, 12);
    const double tau = radians(5), low = c.r_0 * (1 - std::sin(tau)), r_low = c.r_0 * std::cos(tau), top = 22;
    const BruteBody ball{c.r_0, c.r_0, c.r_0, c.r_0, true},
        cone{low, top, r_low, r_low + (top - low) * std::tan(tau), false};
    double deepest = -INFINITY;
    for (std::size_t k = 0; k + 1 < way.size(); k += 3) {
      path::ToolMotion m;
      m.tip_from = way[k].tip;
      m.tip_to = way[k + 1].tip;
      m.axis_from = way[k].axis;
      m.axis_to = way[k + 1].axis;
      for (const auto& body : {ball, cone}) deepest = std::max(deepest, bodies.sampled(body, m).depth);
    }
    std::printf("%-12s deepest anywhere %.3f um\n", name, 1e3 * deepest);
    EXPECT_LT(deepest, 3e-4) << name;
  }
}

// One rotary: the standing tilt stands at every record and between records; what the poses leave is that of the study:
// 0.23 .. 0.28 um on the outer flanks, 1.3 and 3.3 um on the inner ones; the spur gear with the azimuth standing 2.8
// um.
TEST(LinePassRotaries, TheTiltStands) {
  const std::map<std::string, double> study = {
      {"inner_plus", 1.3}, {"inner_minus", 3.3}, {"outer_plus", 0.28}, {"outer_minus", 0.28}};
  for (const auto& [name, best] : study) {
    const auto& c = case_of(name);
    const auto pass = pass_of(c, options_of(c, line::Rotaries::tilt_stands));
    for (const auto& r : pass.records) EXPECT_NEAR(r.axis.a.z(), pass.records.front().axis.a.z(), 1e-12);
    EXPECT_LT(1e3 * pass.best_mm, 1.1 * best) << name;
    const auto result = swept(flank_points(c), mill_of(c), way_of(pass, c));
    std::printf("%-12s tilt stands: poses %.3f um, swept left %.3f, gouge %.3f um\n", name.c_str(), 1e3 * pass.best_mm,
                1e3 * result.left, 1e3 * result.gouge);
    EXPECT_LT(result.left, pass.misfit_mm + pass.chord_mm + 1e-4);
    EXPECT_LT(result.gouge, 0.25 * pass.chord_mm + 2e-5);
  }
  const auto& spur = case_of("spur_plus");
  const auto pass = pass_of(spur, options_of(spur, line::Rotaries::azimuth_stands));
  const Vec3 first = pass.records.front().axis.a;
  for (const auto& r : pass.records)
    EXPECT_NEAR(std::remainder(std::atan2(r.axis.a.y(), r.axis.a.x()) - std::atan2(first.y(), first.x()), 2 * kPi), 0,
                1e-12);
  EXPECT_LT(1e3 * pass.best_mm, 1.1 * 2.8);
}

TEST(LinePassShape, ContactGoesOnSteadilyAndLiftsAreGradual) {
  for (const auto& c : line_cases()) {
    const auto pass = pass_of(c, options_of(c));
    ASSERT_GE(pass.records.size(), 20u);
    double contact = 0;
    for (std::size_t k = 1; k < pass.records.size(); ++k) {
      const auto &a = pass.records[k - 1], &b = pass.records[k];
      const double way = (b.anchor - a.anchor).norm(),
                   tip = (b.axis.c_0 - c.r_0 * b.axis.a - a.axis.c_0 + c.r_0 * a.axis.a).norm();
      contact += way;
      EXPECT_GT(b.s, a.s);
      EXPECT_LE(b.s - a.s, 0.1001 * c.gear.module_mm);
      EXPECT_NEAR(b.contact_ratio, tip / way, 1e-9);
      EXPECT_LE(std::abs(b.lift - a.lift), 1.05 * way + 1e-9);
    }
    EXPECT_NEAR(pass.contact_mm, contact, 1e-9);
    // Both ends lie beyond the ring with every foot.
    const auto task = c.task();
    const line::LineFit fit(task, tapered(c.r_0), line::strips_of(task, 1)[0]);
    for (const auto* r : {&pass.records.front(), &pass.records.back()}) {
      const auto gap =
          fit.gap_along(r->axis, 0.5 * pass.contact_top_mm, task.place(r->anchor.head<2>().norm(), r->anchor.z()));
      ASSERT_TRUE(gap);
      EXPECT_GT(gap->beyond_ring, 0.1 * c.gear.module_mm);
    }
  }
}

// Where a pose is not clear beyond the full stations the pass ends, and says by how much.
TEST(LinePassShape, EndsWhereItIsNotClear) {
  const auto& c = case_of("inner_plus");
  auto o = options_of(c);
  const auto whole = pass_of(c, o);
  const double limit = whole.records.back().axis.c_0.head<2>().norm() - 0.4;
  o.room = [limit](const line::AxisLine<double>& axis) {
    return axis.c_0.head<2>().norm() < limit ? std::nullopt : std::optional(line::Blocked{"flute", "tip", -1, 0});
  };
  const auto cut = pass_of(c, o);
  EXPECT_LT(cut.records.back().s, whole.records.back().s - 0.1);
  EXPECT_GT(cut.shortened_mm, 0);
  EXPECT_EQ(whole.shortened_mm, 0);
}

// Full stations must be clear: what would give them room is told by the body that lacks it. A shank begins where the
// flute ends, a holder at the stick-out.
TEST(LinePassShape, RefusedRoomNamesWhatHelpsByTheBody) {
  const auto& c = case_of("inner_plus");
  const auto task = c.task();
  for (const auto& [body, helps, not_this] :
       {std::array{"shank", "a larger flute_length", "stick_out"}, {"holder", "a larger stick_out", "flute_length"}}) {
    auto o = options_of(c);
    o.room = [body = body](const line::AxisLine<double>&) {
      return std::optional(line::Blocked{body, "tip", 0.046, 0.05});
    };
    const auto pass = line::plan_pass(line::LineFit(task, tapered(c.r_0), line::strips_of(task, 1)[0]), o, 100);
    ASSERT_FALSE(pass);
    const std::string& text = pass.error().message;
    EXPECT_NE(text.find(helps), std::string::npos) << text;
    EXPECT_EQ(text.find(not_this), std::string::npos) << text;
  }
}

tool::Profile mill(double diameter, double half_angle_deg, double flute, double shank, double stick_out) {
  return std::get<tool::Profile>(tool::Profile::make(tapered_mill(diameter, half_angle_deg, flute, shank, stick_out)));
}

line::LineOperation finishing() {
  line::LineOperation o;
  o.speed_rpm = 20000;
  o.feed_mm_min = 300;
  o.clearance_height_mm = -15;
  return o;
}

// The path of one space: four flanks, all clear at rapids, the contact at the job's feed, both flanks of the space cut
// as one shape.
TEST(LinePlans, PathOfTheQuarterGear) {
  const auto gear = made(quarter_dhfg());
  const auto tool = mill(0.5, 5, 4, 4, 22);
  auto o = finishing();
  o.left_mm = 0.002;
  const auto plan = line::plan_line_milling(kept(gear), tool, o);
  ASSERT_TRUE(plan) << plan.error().message;
  EXPECT_EQ(plan->strips, 1);
  EXPECT_EQ(plan->rotaries, line::Rotaries::both);  // the inner flank -1 leaves more than 2 um with the tilt standing
  EXPECT_LE(plan->misfit_mm, 0.002);
  ASSERT_EQ(plan->passes.size(), 4u);
  EXPECT_EQ(plan->path.operation_type, "line_milling");
  const auto& records = plan->path.records;
  int rapids = 0, engages = 0;
  std::size_t k = 0;
  std::set<std::pair<int, int>> seen;  // the path may order the flanks
  for (std::size_t n_pass = 0; n_pass < plan->passes.size(); ++n_pass) {
    ASSERT_LT(k + 1, records.size());
    const auto found = std::find_if(plan->passes.begin(), plan->passes.end(), [&](const line::LinePass& p) {
      return p.zone == records[k].zone && p.number == records[k].pass;
    });
    ASSERT_NE(found, plan->passes.end());
    const line::LinePass& pass = *found;
    EXPECT_TRUE(seen.insert({records[k].zone, records[k].pass}).second) << "cut twice";
    ASSERT_EQ(records[k].kind, path::MoveKind::rapid);
    ASSERT_EQ(records[k + 1].kind, path::MoveKind::engage);
    EXPECT_GE(records[k].tip.z(), -15);
    EXPECT_LE((records[k].axis - records[k + 1].axis).norm(), 0);
    EXPECT_LE((records[k + 1].tip - records[k].tip).cross(records[k].axis).norm(), 1e-9);  // in along the axis
    ++rapids, ++engages;
    const std::size_t first = k + 1, count = pass.records.size();
    EXPECT_EQ(records[first].zone, pass.zone);
    const bool forwards = (pass.records.front().axis.a - records[first].axis).norm() < 1e-12;
    double minutes = 0, contact = 0;
    for (std::size_t n = 1; n < count; ++n) {
      const auto& r = records[first + n];
      EXPECT_EQ(r.kind, path::MoveKind::feed);
      minutes += (r.tip - records[first + n - 1].tip).norm() / r.feed_mm_min;
      const auto& a = pass.records[forwards ? n : count - 1 - n];
      const auto& b = pass.records[forwards ? n - 1 : count - n];
      contact += (a.anchor - b.anchor).norm();
      EXPECT_LE((a.axis.c_0 - 0.25 * a.axis.a - r.tip).norm(), 1e-12);
    }
    EXPECT_NEAR(contact / minutes, 300, 1e-6);
    k = first + count;
    EXPECT_EQ(records[k].kind, path::MoveKind::retract);
    EXPECT_GE(records[k].tip.z(), -15);
    ++k;
  }
  EXPECT_EQ(k, records.size());
}

// Material to the right of the feed seen from the holder, and to the left when it is not to climb.
TEST(LinePlans, ClimbMilling) {
  const auto gear = made(small_spur());
  const auto tool = mill(0.8, 5, 6, 6, 20);
  for (const bool climb : {true, false}) {
    auto o = finishing();
    o.climb = climb;
    const auto plan = line::plan_line_milling(kept(gear), tool, o);
    ASSERT_TRUE(plan) << plan.error().message;
    for (std::size_t k = 2; k + 1 < plan->path.records.size(); ++k) {
      const auto &a = plan->path.records[k - 1], &b = plan->path.records[k];
      if (b.kind != path::MoveKind::feed) continue;
      // The space's middle lies on the other side of the flank: the material is away from the azimuth half a pitch on.
      const double azimuth = std::atan2(b.tip.y(), b.tip.x());
      const Vec3 material = (azimuth < 0.5 * gear.pitch() ? -1 : 1) * Vec3(-std::sin(azimuth), std::cos(azimuth), 0);
      const Vec3 right = (b.tip - a.tip).cross(b.axis);
      EXPECT_EQ(right.dot(material) > 0, climb) << k;
    }
  }
}

TEST(LinePlans, AllowanceStandsParallel) {
  const auto gear = made(quarter_dhfg());
  const auto tool = mill(0.5, 5, 4, 4, 22);
  auto o = finishing();
  const auto clean = line::plan_line_milling(kept(gear), tool, o);
  o.allowance_mm = 0.05;
  const auto stock = line::plan_line_milling(kept(gear), tool, o);
  ASSERT_TRUE(clean && stock);
  for (const char* name : {"inner_plus", "outer_minus"}) {
    const auto& c = case_of(name);
    for (std::size_t k = 0; k < 4; ++k) {
      if (clean->passes[k].zone != c.zone || clean->passes[k].side != c.side) continue;
      const auto without = swept(flank_points(c), mill_of(c), way_of(clean->passes[k], c));
      const auto with = swept(flank_points(c), mill_of(c), way_of(stock->passes[k], c));
      EXPECT_NEAR(with.left - without.left, 0.05, 1e-4);
      EXPECT_NEAR(without.gouge - with.gouge, 0.05, 1e-4);
    }
  }
}

/// What stands along the normals of a flank after all passes, above the allowance: from its places outwards until the
/// mill has been there.
double standing(const line::FlankTask& f, const BruteConicalMill& mill, const std::vector<BrutePose>& way, int columns,
                int rows) {
  double most = 0;
  for (int i = 0; i <= columns; ++i)
    for (int j = 0; j <= rows; ++j) {
      const double s = f.s_from + (f.s_to - f.s_from) * i / columns, u = f.space->tip_edge(f.side, s)->u;
      const auto on = f.at_u(s, u + (f.u_end - u) * j / rows);
      double h = most;
      for (double step = 1; step > 1e-8; h += std::max(step, 0.0))
        step = least_distance(on->p + (f.allowance_mm + h) * on->n, mill, way);
      most = h;
    }
  return most;
}

// The number of an operation is what stands where it stands highest: at the fillet line under a ball end that is
// lifted, in a corner of the ring, between two records.
TEST(LinePlans, WhatIsLeftBoundsWhatStandsAlongTheNormal) {
  auto gear = small_spur();
  gear.zones[0].outer_radius_mm = 62;
  const auto& part = kept(made(gear));
  const double r_0 = 0.4;
  for (const auto& [allowance, chord, factor] : {std::tuple(0.05, 0.005, 1.5), {0.0, 0.001, 1.0}}) {
    auto o = finishing();
    o.clearance_height_mm = part.blank_top() + 1;
    o.allowance_mm = allowance;
    o.left_mm = 0.006;
    o.chord_tolerance_mm = chord;
    if (allowance > 0) o.base_lift_mm = std::sqrt(r_0 * chord);
    const auto plan = line::plan_line_milling(part, mill(2 * r_0, 5, 8, 4, 22), o);
    ASSERT_TRUE(plan) << plan.error().message;
    const auto& pass = plan->passes[0];
    std::vector<BrutePose> way;
    for (const auto& r : pass.records) way.push_back({r.axis.c_0 - r_0 * r.axis.a, r.axis.a});
    const double stands =
        standing(*line::flank_task(part, 0, pass.side, allowance), {r_0, radians(5), 0, 0}, way, 40, 20);
    std::printf("allowance %.2f mm: %.3f um stand along the normal, told %.3f um, planned %.3f um\n", allowance,
                1e3 * stands, 1e3 * plan->left_mm(), 1e3 * plan->misfit_mm);
    EXPECT_GE(pass.left_mm, stands);
    EXPECT_LE(pass.left_mm, 1.01 * stands);
    EXPECT_GE(stands, factor * plan->misfit_mm);
  }
}

TEST(LinePlans, ChoosesFewestRotariesThenFewestStrips) {
  const auto gear = made(quarter_dhfg());
  const auto tool = mill(0.5, 5, 4, 4, 22);
  auto o = finishing();
  o.left_mm = 0.008;
  const auto loose = line::plan_line_milling(kept(gear), tool, o);
  ASSERT_TRUE(loose) << loose.error().message;
  EXPECT_EQ(loose->rotaries, line::Rotaries::tilt_stands);
  EXPECT_EQ(loose->strips, 1);
  o.left_mm = 0.0011;
  const auto tight = line::plan_line_milling(kept(gear), tool, o);
  ASSERT_TRUE(tight) << tight.error().message;
  EXPECT_EQ(tight->strips, 2);
  EXPECT_LE(tight->misfit_mm, 0.0011);
  o.left_mm = 1e-6;
  o.strips = 1;
  const auto none = line::plan_line_milling(kept(gear), tool, o);
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("left = 0.001 um cannot be met"), std::string::npos) << none.error().message;
}

TEST(LinePlans, Refusals) {
  const auto gear = made(quarter_dhfg());
  const auto refused = [&](const Result<line::LinePlan>& plan, const char* text) {
    ASSERT_FALSE(plan) << text;
    EXPECT_NE(plan.error().message.find(text), std::string::npos) << plan.error().message;
  };
  refused(line::plan_line_milling(kept(gear), mill(0.5, 5, 2.5, 4, 22), finishing()), "flute_length must be");
  tool::CutterData flat;
  flat.shape = tool::CutterShape::flat;
  flat.diameter_mm = 1;
  flat.flute_length_mm = 4;
  flat.shank_diameter_mm = 4;
  flat.stick_out_mm = flat.length_mm = 20;
  refused(line::plan_line_milling(kept(gear), std::get<tool::Profile>(tool::Profile::make(flat)), finishing()),
          "needs a tool with a ball end");
  auto o = finishing();
  o.strips = 25;
  refused(line::plan_line_milling(kept(gear), mill(0.5, 5, 4, 4, 22), o), "strips = 25 lies outside 1 .. 24");
}

// The same bits with one thread and with several; the time is printed, for busy machines cannot promise it.
TEST(LinePlans, SameAnswerWithOneThread) {
  const auto gear = made(double_helical_parameters());
  const auto tool = mill(2, 5, 15, 8, 32);
  auto o = finishing();
  o.clearance_height_mm = -60;
  o.rotaries = {line::Rotaries::both};
  const auto start = std::chrono::steady_clock::now();
  const auto a = line::plan_line_milling(kept(gear), tool, o);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto b = line::plan_line_milling(kept(gear), tool, o);
  ASSERT_TRUE(a && b);
  std::printf("paper's gear planned in %.2f s, %zu records\n", seconds, a->path.records.size());
  ASSERT_EQ(a->path.records.size(), b->path.records.size());
  for (std::size_t k = 0; k < a->path.records.size(); ++k) {
    EXPECT_EQ(a->path.records[k].tip, b->path.records[k].tip);
    EXPECT_EQ(a->path.records[k].axis, b->path.records[k].axis);
  }
}

TEST(Smooth, KeepsParabolasAndCalmsNoise) {
  Random random(2);
  std::vector<double> parabola, noisy;
  for (int k = 0; k < 40; ++k) {
    parabola.push_back(1 + 0.3 * k - 0.01 * k * k);
    noisy.push_back(parabola.back() + random(-0.1, 0.1));
  }
  const auto same = line::smoothed(parabola, 1e4), calm = line::smoothed(noisy, 1e4);
  double off = 0, before = 0;
  for (std::size_t k = 0; k < parabola.size(); ++k) {
    EXPECT_NEAR(same[k], parabola[k], 1e-8);
    off += std::pow(calm[k] - parabola[k], 2);
    before += std::pow(noisy[k] - parabola[k], 2);
  }
  EXPECT_LT(off, 0.3 * before);
  EXPECT_EQ(line::smoothed(noisy, 0), noisy);
  const line::StationCurve curve(5, 0.5, parabola);
  for (int k = 2; k < 30; ++k) {
    EXPECT_DOUBLE_EQ(curve.at(5 + 0.5 * k), parabola[std::size_t(k)]);
    EXPECT_NEAR(curve.at(5 + 0.5 * (k + 0.5)), 1 + 0.3 * (k + 0.5) - 0.01 * (k + 0.5) * (k + 0.5), 1e-12);
  }
  EXPECT_NEAR(curve.at(4.5), 1 - (parabola[1] - parabola[0]), 1e-12);
}

/// Teeth on a cone taper, and so do their strips: the anchors of the lowest stay on the flank beyond the small end. A
/// mill that leans over such a tooth comes near the gear's axis: blocks are short where its azimuth turns fast.
TEST(LinePassesOnACone, LowStripsReachTheSmallEndAndTurnInShortBlocks) {
  const auto part = part_of(spiral_bevel::SpiralBevelGear::make(nasa_gear()).value());
  for (const int side : {1, -1}) {
    const auto task = line::flank_task(*part, 0, side).value();
    const auto pass = line::plan_pass(line::LineFit(task, tapered(0.6, 4), line::strips_of(task, 4)[3]), {}, 100);
    ASSERT_TRUE(pass) << pass.error().message;
    EXPECT_LT(pass->records.front().s, task.s_from);
    EXPECT_GT(pass->records.back().s, task.s_to);
    EXPECT_LT(pass->misfit_mm, 0.006);
    for (std::size_t k = 1; k < pass->records.size(); ++k)
      EXPECT_LT(
          std::abs(std::remainder(azimuth(pass->records[k].axis.a) - azimuth(pass->records[k - 1].axis.a), 2 * kPi)),
          radians(21));
  }
}

/// Of the wheel the concave flank has a zero direction that an axis can take, the convex one has none: each has its own
/// number of strips, and the convex one does not make the concave one take more.
TEST(LinePassesOnACone, EveryFlankHasItsOwnStrips) {
  const auto part = part_of(spiral_bevel::SpiralBevelGear::make(nasa_gear()).value());
  line::LineOperation o;
  o.speed_rpm = 12000;
  o.feed_mm_min = 500;
  o.left_mm = 0.005;
  o.rotaries = {line::Rotaries::both};
  o.clearance_height_mm = part->blank_top() + 1;
  const auto plan = line::plan_line_milling(*part, mill(1.2, 4, 20, 6, 40), o);
  ASSERT_TRUE(plan) << plan.error().message;
  ASSERT_EQ(plan->ways.size(), 2u);
  std::vector<int> strips;
  for (const line::FlankWays& flank : plan->ways) {
    strips.push_back(flank.strips.back().strips);
    EXPECT_LE(flank.strips.back().misfit_mm, 0.005);
    for (std::size_t k = 0; k + 1 < flank.strips.size(); ++k) EXPECT_GT(flank.strips[k].misfit_mm, 0.005);
    std::printf("flank %+d: %d strips, %.3f min, ball %d passes, %.3f min\n", flank.side, strips.back(), flank.minutes,
                flank.ball_passes, flank.ball_minutes);
    EXPECT_LT(flank.minutes, 0.5 * flank.ball_minutes);
  }
  EXPECT_LT(strips[0], strips[1]);
  ASSERT_EQ(int(plan->passes.size()), strips[0] + strips[1]);
  // Passes of the zone count on from flank to flank, in the path as in the report.
  std::set<int> numbers;
  for (const auto& r : plan->path.records) numbers.insert(r.pass);
  EXPECT_EQ(int(numbers.size()), strips[0] + strips[1]);
  for (std::size_t k = 0; k < plan->passes.size(); ++k) EXPECT_EQ(plan->passes[k].number, int(k));
}

/// The zero direction of the pinion's flanks leans beyond 60 deg towards the large end: all of their strips are cut by
/// an upright tool.
TEST(LinePassesOnACone, FlanksThatAskForTooMuchTiltAreCutUpright) {
  const auto part = part_of(spiral_bevel::SpiralBevelGear::make(nasa_pinion()).value());
  for (const int side : {1, -1}) {
    const auto task = line::flank_task(*part, 0, side).value();
    EXPECT_TRUE(task.upright) << side;
    const auto pass = line::plan_pass(line::LineFit(task, tapered(0.75, 4), line::strips_of(task, 10)[4]), {}, 100);
    ASSERT_TRUE(pass) << pass.error().message;
    EXPECT_LT(pass->misfit_mm, 0.006);
  }
}

}  // namespace
}  // namespace toothpath::test
