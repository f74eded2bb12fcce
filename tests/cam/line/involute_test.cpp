// Line milling of flanks that are no saddles: an involute is straight along its generators, which run along the tooth.
// A mill laid along one touches it exactly, spur or helical; a tool that stands upright in the space cuts it in strips.
#include <gtest/gtest.h>

#include <cstdio>
#include <memory>

#include "cam/analytic/body_sweep.h"
#include "cam/analytic/gear_distance.h"
#include "cam/line/plan.h"
#include "cam/path/motions.h"
#include "cam/proof/rapid_clearance.h"
#include "cam/tool/proof_tool.h"
#include "geometry/base/angle.h"
#include "geometry/cylindrical/part.h"
#include "tests/cam/line/line_cases.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/straight_bevel/samples.h"
#include "tests/support/brute_force_line.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using tooth_space::ToothedPart;

std::shared_ptr<const ToothedPart> part_of(const cylindrical::CylindricalParameters& gear) {
  return cylindrical::part_of(made(gear));
}

struct InvoluteCase {
  const char* name;
  std::shared_ptr<const ToothedPart> part;
};
const std::vector<InvoluteCase>& involute_cases() {
  static const std::vector<InvoluteCase> cases = {{"spur", part_of(shifted_spur())},
                                                  {"left_helical", part_of(left_helical())},
                                                  {"pinion", part_of(double_helical_pinion())}};
  return cases;
}

/// Least distance from x to places of a flank, by a pattern search over its parameters: no normals, no derivatives.
double nearest(const line::FlankTask& f, const Vec3& x, double u, double v) {
  const auto off = [&](double a, double b) { return (f.space->point(f.piece(), a, b)->p - x).norm(); };
  double best = off(u, v);
  for (double step = 0.05; step > 1e-11;) {
    bool moved = false;
    for (const auto& [du, dv] : {std::pair{1.0, 0.0},
                                 {-1.0, 0.0},
                                 {0.0, 1.0},
                                 {0.0, -1.0},
                                 {1.0, 1.0},
                                 {-1.0, -1.0},
                                 {1.0, -1.0},
                                 {-1.0, 1.0}})
      if (const double d = off(u + du * step / f.module_mm, v + dv * step); d < best) {
        best = d;
        u += du * step / f.module_mm;
        v += dv * step;
        moved = true;
      }
    if (!moved) step *= 0.5;
  }
  return best;
}

// The wanted axis lies along the generator, the gear axis projected on the tangent plane, whichever sign rounding gives
// to K. There a cylinder and a cone touch along a whole line, far beyond the ring.
TEST(Involute, MillsLieAlongTheGenerator) {
  Random random(12);
  double off = 0, gap = 0, bend = 0;
  for (const auto& c : involute_cases())
    for (int zone = 0; zone < c.part->zones(); ++zone)
      for (const int side : {1, -1}) {
        const auto f = *line::flank_task(*c.part, zone, side);
        for (int k = 0; k < 60; ++k) {
          const auto place = f.at_depth(random(f.s_from, f.s_to), random(0, f.depth));
          ASSERT_TRUE(place);
          const auto& on = place->on;
          const auto frame = f.frame(on);
          const auto shape = line::shape_at(frame, on);
          const double r_0 = random(0.3, 2);
          const auto psi = line::lean<double>(shape, r_0);
          ASSERT_TRUE(psi) << c.name;
          const Vec3 u = line::axis_direction<double>(frame, *psi, 0);
          const Vec3 generator = (Vec3::UnitZ() - on.n.z() * on.n).normalized();
          off = std::max(off, u.cross(generator).norm());
          bend = std::max(bend, std::abs(line::distance_bend<double>(frame, shape, r_0, u)));
          for (const double half_angle : {0.0, 7.0}) {
            const auto law = tapered(r_0, half_angle);
            const line::LineFit fit(f, law, line::strips_of(f, 1)[0]);
            const auto axis = line::axis_of<double>(on.p, frame, law, {*psi, 0, 0, 2.0});
            for (double t = 0; t <= 12; t += 3) {
              const auto q = fit.gap_at(axis, t, place->at);
              ASSERT_TRUE(q) << c.name;
              gap = std::max(gap, std::abs(q->e));
              if (k % 20 == 0) { EXPECT_NEAR(nearest(f, axis.at(t), q->at.u, q->at.v), law.rho(t), 1e-8) << c.name; }
            }
          }
        }
      }
  std::printf("lean off the generator %.1e rad, gap along it %.1e mm, second derivative %.1e /mm\n", off, gap, bend);
  EXPECT_LT(off, 1e-7);
  EXPECT_LT(gap, 1e-11);
  EXPECT_LT(bend, 1e-12);
}

// A generator lies flat in the space, so that passes are of an upright tool: one strip of height h leaves k h^2 / 8 of
// an involute that bends by k along its profile, and all strips of a flank leave alike, though its foot bends more.
// Against places of the flank, looked at densely.
TEST(Involute, UprightStripsLeaveTheSagOfTheProfile) {
  for (const auto& c : involute_cases()) {
    const auto f = *line::flank_task(*c.part, 0, 1);
    for (const int strips : {1, 2, 4, 8}) {
      double worst = 0, least_of_all = INFINITY, sag = 0;
      for (const auto& strip : line::strips_of(f, strips)) {
        const line::LineFit fit(f, tapered(0.15 * f.module_mm), strip);
        const auto p = fit.best(0.5 * (f.s_from + f.s_to));
        ASSERT_TRUE(p) << c.name;
        EXPECT_LT(p->from_upright(), line::kMostTilt);
        worst = std::max(worst, p->gap.misfit());
        least_of_all = std::min(least_of_all, p->gap.misfit());
        const auto on = f.at_depth(p->s, 0.5 * (strip.top + strip.bottom.value_or(f.depth)));
        const auto shape = line::shape_at(f.frame(on->on), on->on);
        const double height = (strip.bottom.value_or(f.depth) - strip.top) / f.frame(on->on).p.dot(f.up(on->on.p));
        sag = std::max(sag, shape.along(std::cos(p->angles.psi), std::sin(p->angles.psi)) * height * height / 8 /
                                std::pow(std::cos(p->angles.psi), 2));
        double least = INFINITY;
        for (int k = 0; k <= 40; ++k) {
          const double t = p->gap.t_to * k / 40;
          const auto q = fit.gap_at(p->axis, t, p->at);
          ASSERT_TRUE(q);
          if (k % 8 == 0) { EXPECT_NEAR(nearest(f, p->axis.at(t), q->at.u, q->at.v) - fit.law().rho(t), q->e, 1e-8); }
          if (t >= p->gap.t_from) least = std::min(least, q->e);
        }
        EXPECT_GT(least, -2e-9 - 0.01 * p->gap.misfit());
      }
      std::printf("%-12s %d strips: misfit %.2f um, sag of the profile %.2f um\n", c.name, strips, 1e3 * worst,
                  1e3 * sag);
      EXPECT_NEAR(worst, sag, 0.2 * sag) << c.name << " " << strips;
      if (strips > 1) { EXPECT_GT(least_of_all, 0.7 * worst) << c.name << " " << strips; }
      EXPECT_EQ(line::strips_for(f, 1.05 * worst), strips) << c.name;
    }
  }
}

// Of teeth that taper the strips do, too: at every station each leaves about its share of the profile, which grows with
// the cone distance, and no strip is left with what the others do not reach.
TEST(Involute, StripsTaperWithTheTeeth) {
  const auto gear = straight_bevel::StraightBevelGear::make(khk_pinion()).value();
  const auto part = straight_bevel::part_of(gear);
  for (const int side : {1, -1}) {
    const auto f = *line::flank_task(*part, 0, side);
    EXPECT_TRUE(f.upright);
    for (const double s : {f.s_from, f.s_to})
      EXPECT_NEAR(f.above_fillet(f.at_depth(s, f.depth)->at.u), 0, 1e-6);  // the same share of the depth everywhere
    const double left_mm = 0.006;
    const int n = line::strips_for(f, left_mm);
    EXPECT_EQ(n, 8);
    double worst = 0;
    for (const double s : {f.s_from + 4, 0.5 * (f.s_from + f.s_to), f.s_to - 4}) {
      double least = INFINITY, most = 0;
      for (const auto& strip : line::strips_of(f, n)) {
        const auto p = line::LineFit(f, tapered(0.45), strip).best(s);
        ASSERT_TRUE(p);
        least = std::min(least, p->gap.misfit());
        most = std::max(most, p->gap.misfit());
      }
      std::printf("cone distance %.2f mm, side %+d: %d strips leave %.2f to %.2f um\n", -s, side, n, 1e3 * least,
                  1e3 * most);
      EXPECT_GT(least, 0.4 * most);
      worst = std::max(worst, most);
    }
    EXPECT_LT(worst, 1.15 * left_mm);
  }
}

// A whole operation on a spur and a helical gear, in as many strips as `left` asks for, as the moving mill leaves them.
TEST(Involute, PassesByBruteForce) {
  auto spur = shifted_spur(), helical = left_helical();
  spur.zones = {{0, -2, 2}};
  helical.zones = {{radians(-18), 4, 7}};
  for (const auto& [gear, left_mm, strips] : {std::tuple(spur, 0.0305, 4), {spur, 0.009, 7}, {helical, 0.01, 4}}) {
    const auto part = part_of(gear);
    const double m = gear.module_mm;
    line::LineOperation o;
    o.speed_rpm = 16000;
    o.feed_mm_min = 400;
    o.left_mm = left_mm;
    o.rotaries = {line::Rotaries::both};
    o.clearance_height_mm = part->blank_top() + 1;
    o.chord_tolerance_mm = 1e-3;
    const auto tool = std::get<tool::Profile>(tool::Profile::make(tapered_mill(0.3 * m, 5, 4 * m, 6, 30)));
    const auto plan = line::plan_line_milling(*part, tool, o);
    ASSERT_TRUE(plan) << plan.error().message;
    EXPECT_EQ(plan->strips, strips);
    EXPECT_LE(plan->misfit_mm, left_mm);
    ASSERT_EQ(int(plan->passes.size()), 2 * strips);
    // What the ways would take: fewer strips leave too much, and the ball many passes.
    ASSERT_EQ(plan->ways.size(), 2u);
    double worst = 0;
    for (const line::FlankWays& flank : plan->ways) {
      ASSERT_FALSE(flank.strips.empty());
      EXPECT_EQ(flank.strips.back().strips, strips);
      worst = std::max(worst, flank.strips.back().misfit_mm);
      for (std::size_t k = 0; k + 1 < flank.strips.size(); ++k) EXPECT_GT(flank.strips[k].misfit_mm, left_mm);
    }
    EXPECT_EQ(worst, plan->misfit_mm);
    if (gear.zones[0].helix_angle_rad == 0) {
      const cylindrical::InvoluteKernel<double> w(gear, gear.zones[0]);
      constexpr int kSteps = 2000;
      double sum = 0;  // along the involute, whose radius of curvature is r_b theta
      const double step = (w.theta_a - w.theta_f) / kSteps;
      for (int k = 0; k < kSteps; ++k) {
        const double bend = w.r_b * (w.theta_f + (k + 0.5) * step);
        sum += std::sqrt(1 / (0.15 * m) + 1 / bend) * bend * step;
      }
      const double face = gear.zones[0].to_mm - gear.zones[0].from_mm;
      for (const line::FlankWays& flank : plan->ways) {
        EXPECT_NEAR(flank.ball_passes, std::ceil(sum / std::sqrt(8 * left_mm)), 1);
        EXPECT_GT(flank.ball_passes, 3 * strips);
        // At the feed of the contact, which goes straight along a spur tooth and a little beyond its ends.
        EXPECT_NEAR(flank.ball_minutes, flank.ball_passes * face / o.feed_mm_min, 1e-9);
        EXPECT_GE(flank.minutes, strips * face / o.feed_mm_min);
        EXPECT_LE(flank.minutes, strips * (face + 2 * m) / o.feed_mm_min);
      }
    }
    for (const auto& r : plan->path.records)
      if (r.kind == path::MoveKind::rapid) { EXPECT_GE(radius(r.tip), part->blank_top()); }
    for (const int side : {1, -1}) {
      const auto f = *line::flank_task(*part, 0, side);
      std::vector<Vec3> points;
      for (int i = 0; i <= 12; ++i)
        for (int j = 0; j <= 24; ++j)
          points.push_back(f.at_depth(f.s_from + (f.s_to - f.s_from) * i / 12, f.depth * j / 24)->on.p);
      double chord = 0, gouge = -INFINITY;
      std::vector<double> least(points.size(), INFINITY);
      for (const auto& pass : plan->passes) {
        if (pass.side != side) continue;
        std::vector<BrutePose> way;
        for (const auto& r : pass.records) way.push_back({r.axis.c_0 - 0.15 * m * r.axis.a, r.axis.a});
        for (std::size_t k = 0; k < points.size(); ++k)
          least[k] = std::min(least[k], least_distance(points[k], {0.15 * m, radians(5), 0, 0}, way));
        chord = std::max(chord, pass.chord_mm);
      }
      double left = -INFINITY;
      for (const double d : least) {
        left = std::max(left, d);
        gouge = std::max(gouge, -d);
      }
      std::printf("z %d, %d strips, side %+d: swept left %.2f um, gouge %.3f um, planned %.2f um\n", gear.teeth, strips,
                  side, 1e3 * left, 1e3 * gouge, 1e3 * plan->misfit_mm);
      EXPECT_LT(left, plan->misfit_mm + chord + o.bias_mm + 1e-4);
      EXPECT_LT(left, plan->left_mm());
      EXPECT_GT(left, 0.96 * plan->left_mm());
      EXPECT_LT(gouge, -o.bias_mm + 0.25 * chord + 5e-5);
    }
    o.left_mm = 2e-5;
    const auto none = line::plan_line_milling(*part, tool, o);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("left = 0.020 um asks for "), std::string::npos) << none.error().message;
    EXPECT_NE(none.error().message.find("at most 24 are planned"), std::string::npos) << none.error().message;
  }
}

// A ball that just does not touch a flank at the very end of its ring: that end is bounded as closely as the flank, at
// every helix angle. On some, two points of the end's border are one but for rounding.
TEST(Involute, EndsAreBoundAsCloselyAsFlanks) {
  constexpr double kGap = 4e-4, kRadius = 0.3, kProof = 1e-4;
  double worst = 0;
  for (const int teeth : {24, 30})
    for (const double helix : {0.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0}) {
      auto gear = double_helical_pinion();
      gear.teeth = teeth;
      gear.tip_diameter_mm = gear.groove_diameter_mm = std::nullopt;
      gear.zones = {{radians(helix), 3.3, 4.3}};
      const auto part = part_of(gear);
      const analytic::GearDistance distance(part, 1);
      for (const int side : {1, -1}) {
        const auto f = *line::flank_task(*part, 0, side);
        for (const double s : {f.s_from, f.s_to})
          for (int k = 0; k <= 100; ++k) {
            const auto on = f.at_depth(s, f.depth * k / 100)->on;
            path::ToolMotion stands;
            stands.tip_from = stands.tip_to = on.p + (kRadius + kGap) * on.n;
            stands.axis_from = stands.axis_to = f.up(on.p);
            analytic::SweptGapOptions o;
            o.touching = true;
            o.enough_mm = o.contact_mm = 0.01;
            o.contact_proof_mm = kProof;
            const auto gap = analytic::swept_gap(
                distance, tool::RoundedFrustum{{0, 1e-3, 0, 0, tool::Body::ball}, kRadius}, stands, o);
            worst = std::max(worst, std::min(kGap, gap.measured_mm) - gap.proven_mm);
          }
      }
    }
  std::printf("proven %.2f um below what is there\n", 1e3 * worst);
  EXPECT_LE(worst, kProof);
}

// The lowest strip of a helical flank leaves the ring aslant and before the strips above it: what its passes leave does
// not depend on whether a station lies just there.
TEST(Involute, PassesDoNotDependOnWhereTheirStationsLie) {
  auto gear = shifted_spur();
  gear.profile_shift = 0;
  line::PassOptions o;
  o.rotaries = line::Rotaries::tilt_stands;
  o.enough_mm = 0.005;
  for (const double half : {9.0, 10.1, 12.0}) {
    gear.zones = {{radians(20), -half, half}};
    const auto part = part_of(gear);
    const auto f = *line::flank_task(*part, 0, 1);
    const auto pass = line::plan_pass(line::LineFit(f, tapered(1.25), line::strips_of(f, 8).back()), o, 100);
    ASSERT_TRUE(pass) << pass.error().message;
    EXPECT_LT(pass->misfit_mm, 0.005) << half;
  }
}

// Axes that differ in their last digits alone do not turn the frame in which the tool sees the gear: the gap stays what
// it is.
TEST(Involute, ATurnOfRoundingIsNone) {
  constexpr double kGap = 3e-4, kRadius = 1.25;
  const std::shared_ptr<const ToothedPart> part = involute_cases().front().part;
  const analytic::GearDistance distance(part, 4);
  Random random(41);
  for (const int side : {1, -1}) {
    const auto f = *line::flank_task(*part, 0, side);
    for (int k = 0; k < 20; ++k) {
      const auto on = f.at_depth(0.5 * (f.s_from + f.s_to), 0.05 * f.depth)->on;
      path::ToolMotion m;
      m.tip_from = on.p + (kRadius + kGap) * on.n;
      m.tip_to = m.tip_from - Vec3(0, 0, 0.3);
      m.axis_from = m.axis_to = (f.up(on.p) + Vec3(0, 0, random(-0.3, 0.3))).normalized();
      for (int n = 0; n < 3; ++n) m.axis_to[n] += 3e-16 * random(-1, 1);
      analytic::SweptGapOptions o;
      o.touching = true;
      o.enough_mm = o.contact_mm = 0.01;
      const auto gap =
          analytic::swept_gap(distance, tool::RoundedFrustum{{0, 8, 0, 0, tool::Body::flute}, kRadius}, m, o);
      EXPECT_NEAR(gap.measured_mm, kGap, 1e-5) << k;
      EXPECT_GT(gap.proven_mm, kGap - 2 * o.contact_proof_mm) << k;
    }
  }
}

// From flank to flank over a gear that is long and thin: a straight way between two places above its blank would pass
// through it.
TEST(Involute, RapidsGoRoundTheBlank) {
  auto gear = shifted_spur();
  gear.module_mm = 1;
  gear.bore_diameter_mm = 0;
  gear.zones = {{radians(-25), -15, 15}};
  const auto part = part_of(gear);
  line::LineOperation o;
  o.speed_rpm = 16000;
  o.feed_mm_min = 400;
  o.strips = 2;
  o.rotaries = {line::Rotaries::both};
  o.clearance_height_mm = part->blank_top() + 1;
  o.chord_tolerance_mm = 5e-3;
  const auto tool = std::get<tool::Profile>(tool::Profile::make(tapered_mill(0.3, 5, 4, 3, 20)));
  const auto plan = line::plan_line_milling(*part, tool, o);
  ASSERT_TRUE(plan) << plan.error().message;
  const proof::RapidObstacle blank{part->blank_top(), 0, 15, -15};
  double turn = 0;
  int rapids = 0;
  for (path::ToolMotion m : path::motions_of(plan->path)) {
    if (!m.rapid) continue;
    ++rapids;
    turn = std::max(turn, std::abs(angle_from_to(m.tip_from, m.tip_to)));
    EXPECT_TRUE(proof::prove_rapid(m, tool::proof_tool(tool, 1), blank).clear) << "record " << m.line;
  }
  std::printf("%d rapids, they turn by %.2f rad at most\n", rapids, turn);
  EXPECT_GT(rapids, 4);
}

}  // namespace
}  // namespace toothpath::test
