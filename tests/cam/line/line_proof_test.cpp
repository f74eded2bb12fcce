// The proof of line-milled programs: what the mill is found to cut and what it is proven not to exceed, on clean plans,
// on random poses near contact and with planted errors; against dense sampling of the mill and the gear that shares no
// code with it.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <chrono>
#include <cstdio>
#include <memory>

#include "cam/analytic/gouge_check.h"
#include "cam/analytic/profile_sweep.h"
#include "cam/cut/cut_surface.h"
#include "cam/cut/swept_tool.h"
#include "cam/line/plan.h"
#include "cam/line/room.h"
#include "cam/path/motions.h"
#include "cam/tool/proof_tool.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/line/line_cases.h"
#include "tests/support/brute_force_bodies.h"
#include "tests/support/brute_force_line.h"
#include "tests/support/face_part.h"
#include "tests/support/modified_flank.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

constexpr double kFault = 2e-3;

tool::Profile profile_of(const tool::CutterData& d) {
  auto made = tool::Profile::make(d);
  if (auto* refused = std::get_if<1>(&made)) throw std::runtime_error(refused->front().diagnostic.message);
  return std::get<tool::Profile>(std::move(made));
}

/// A gear and its mill.
struct LineJob {
  std::string name;
  face_gear::FaceGearParameters parameters;
  tool::CutterData tool;
};
const std::vector<LineJob>& line_jobs() {
  static const std::vector<LineJob> jobs = {{"dhfg", quarter_dhfg(), tapered_mill(0.5, 5, 4, 4, 22)},
                                            {"dhfg_7deg", quarter_dhfg(), tapered_mill(0.5, 7, 4, 6, 20)},
                                            {"paper", double_helical_parameters(), tapered_mill(2, 5, 15, 8, 32)},
                                            {"offset", offset_gear(), tapered_mill(1.6, 5, 9, 6, 25)},
                                            {"spur", small_spur(), tapered_mill(0.8, 5, 6, 6, 20)}};
  return jobs;
}
std::ostream& operator<<(std::ostream& out, const LineJob& job) { return out << job.name; }

/// A job planned, all flanks of one space.
struct Planned {
  face_gear::FaceGear gear;
  tool::Profile tool;
  std::unique_ptr<analytic::GearDistance> part;
  line::LinePlan plan;
  [[nodiscard]] std::vector<path::ToolMotion> motions() const { return path::motions_of(plan.path); }
};
Planned planned(const LineJob& job, double bias) {
  const auto gear = made(job.parameters);
  const auto tool = profile_of(job.tool);
  auto part = std::make_unique<analytic::GearDistance>(face_gear::part_of(gear), 5);
  line::LineOperation o;
  o.speed_rpm = 20000;
  o.feed_mm_min = 300;
  o.bias_mm = bias;
  o.clearance_height_mm = gear.blank_top() + 1;
  o.room = line::room_of(*part, tool);
  auto plan = line::plan_line_milling(kept(gear), tool, o);
  if (!plan) throw std::runtime_error(plan.error().message);
  return {gear, tool, std::move(part), *plan};
}

proof::GougeResult checked(const Planned& p, const std::vector<path::ToolMotion>& motions, const tool::Profile& tool) {
  analytic::GougeCheckOptions o;
  o.rapid_height_mm = p.gear.blank_top();
  return analytic::GougeCheck(*p.part, {tool::proof_tool(tool, 1)}, o).check(motions, {0});
}

/// Flank `side` of a zone by sweeping the shaper, turned to where the path of space 0 cuts it.
std::vector<Vec3> places_on_flank(const Planned& p, const face_gear::FaceGearParameters& gear, int zone, int side,
                                  int columns, int rows) {
  const FaceFlank f(p.gear, zone, side);
  const BruteForceFaceGear brute(gear, gear.zones[std::size_t(zone)].helix_angle_rad);
  auto points = swept_flank(
      brute, f.s_from, f.s_to, [&](double r) { return *face_gear::fillet_line_height(f.surface, side, r); },
      [&](double r) { return f.surface.z_tip(r); },
      [&](double r, double z) {
        return face_gear::flank_azimuth(f.surface, side, *face_gear::invert_flank(f.surface, side, r, z));
      },
      columns, rows);
  if (side < 0)
    for (auto& q : points) q = turned(q, p.gear.pitch());
  return points;
}

/// The cutting motions of one flank, and their way.
struct Pass {
  std::vector<path::ToolMotion> motions;
  std::vector<BrutePose> way;
};
Pass pass_in(const Planned& p, int zone, int side) {
  Pass pass;
  for (std::size_t k = 1; k < p.plan.path.records.size(); ++k) {
    const auto& r = p.plan.path.records[k];
    if (r.kind != path::MoveKind::feed || r.zone != zone || (r.pass == 0 ? 1 : -1) != side) continue;
    const auto& before = p.plan.path.records[k - 1];
    if (pass.way.empty()) pass.way.push_back({before.tip, before.axis});
    pass.way.push_back({r.tip, r.axis});
    path::ToolMotion m;
    m.tip_from = before.tip, m.tip_to = r.tip, m.axis_from = before.axis, m.axis_to = r.axis;
    m.line = int(k);
    pass.motions.push_back(m);
  }
  return pass;
}
std::vector<path::ToolMotion> motions_along(const std::vector<BrutePose>& way) {
  std::vector<path::ToolMotion> out;
  for (std::size_t k = 1; k < way.size(); ++k) {
    path::ToolMotion m;
    m.tip_from = way[k - 1].tip, m.tip_to = way[k].tip, m.axis_from = way[k - 1].axis, m.axis_to = way[k].axis;
    m.line = int(k);
    out.push_back(m);
  }
  return out;
}

class LineProof : public testing::TestWithParam<LineJob> {};

// Whole plans with their leads: clean, close, and neck, shank and holder clear.
TEST_P(LineProof, CleanPlan) {
  const auto p = planned(GetParam(), line::kBias);
  const auto motions = p.motions();
  const auto start = std::chrono::steady_clock::now();
  const auto r = checked(p, motions, p.tool);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::printf(
      "%-10s %zu motions: found %.3f um, bound %.3f um, %.0f quads and %.2f ms a motion, clearance %.4f mm, deepest %s "
      "on %s\n",
      GetParam().name.c_str(), motions.size(), 1e3 * r.measured_mm, 1e3 * r.bound_mm,
      double(r.distance_queries) / double(motions.size()), 1e3 * seconds / double(motions.size()), r.clearance_mm,
      to_string(r.deepest.body), r.deepest.patch.c_str());
  const auto milliseconds = [&](auto&& sweep) {
    const auto from = std::chrono::steady_clock::now();
    for (const auto& m : motions) (void)sweep.check(m);
    return 1e3 * std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count() /
           double(motions.size());
  };
  tool::ToolAssembly ball;
  ball.diameter_mm = GetParam().tool.diameter_mm;
  ball.flute_length_mm = GetParam().tool.flute_length_mm;
  std::printf("%-10s one thread, the cutting part alone: %.3f ms a motion; a ball mill on the same way %.3f ms\n",
              GetParam().name.c_str(),
              milliseconds(analytic::ProfileSweep(*p.part, tool::proof_tool(p.tool, 1), 2e-4, 0.002)),
              milliseconds(analytic::CutterSweep(*p.part, ball, 2e-4, 0.002)));
  EXPECT_LT(r.measured_mm, 1e-4);
  EXPECT_LT(r.bound_mm, 2.5e-4);
  EXPECT_GE(r.bound_mm, r.measured_mm);
  EXPECT_LT(r.bound_mm, r.measured_mm + 5e-4);
  EXPECT_GT(r.clearance_mm, 0.05);
  EXPECT_TRUE(r.rapids_clear);
  double shortened = 0;
  for (const auto& pass : p.plan.passes) shortened += pass.shortened_mm;
  std::printf("%-10s shortened by %.3f mm\n", GetParam().name.c_str(), shortened);
  if (GetParam().name != "dhfg_7deg") { EXPECT_EQ(shortened, 0); }
}

// What the proof finds is what dense points of the flank see of the blended motion, and its bound covers that. No bias:
// depths are depths.
TEST_P(LineProof, FindsWhatTheSweptFlankShows) {
  const auto p = planned(GetParam(), 0);
  const double tau = GetParam().tool.half_angle_rad, r_0 = 0.5 * GetParam().tool.diameter_mm;
  for (int zone = 0; zone < p.part->zones(); ++zone)
    for (const int side : {1, -1}) {
      const auto pass = pass_in(p, zone, side);
      const auto truth =
          swept(places_on_flank(p, GetParam().parameters, zone, side, 31, 17), {r_0, tau, 0, 0}, pass.way);
      const auto r = checked(p, pass.motions, p.tool);
      std::printf("%-10s zone %d side %+d: swept %.3f um, found %.3f um (%s), bound %.3f um\n", GetParam().name.c_str(),
                  zone, side, 1e3 * truth.gouge, 1e3 * r.measured_mm, r.deepest.patch.c_str(), 1e3 * r.bound_mm);
      EXPECT_GE(r.bound_mm, truth.gouge);
      EXPECT_GE(r.measured_mm, truth.gouge - 1e-4);
      EXPECT_LE(r.bound_mm, std::max(r.measured_mm, 0.0) + 2.5e-4);
    }
}

/// Points of a modified flank by the words, where the path of space 0 cuts them.
std::vector<Vec3> modified_points(const Planned& p, int zone, int side, int columns, int rows) {
  const auto& f = p.gear.rings()[std::size_t(zone)].surface;
  const auto& on = p.gear.rings()[std::size_t(zone)].zone;
  std::vector<Vec3> out;
  for (int c = 0; c < columns; ++c) {
    const double r = on.inner_radius_mm + (on.outer_radius_mm - on.inner_radius_mm) * (c + 0.01) / (columns - 0.98);
    const double low = *face_gear::fillet_line_height(f, side, r), top = f.z_tip(r);
    for (int k = 0; k < rows; ++k) {
      const auto at = face_gear::invert_flank(f, side, r, top + (low - top) * (k + 0.01) / (rows - 0.98));
      if (!at) continue;
      const Vec3 q = modified_by_the_words<double>(f, p.gear.parameters(), zone, side, at->theta, at->B);
      out.push_back(side > 0 ? q : turned(q, p.gear.pitch()));
    }
  }
  return out;
}

// Flanks modified along the face are milled on the modified flank, and proven against it.
TEST(ModifiedLine, IsMilledAndProvenOnTheModifiedFlank) {
  for (LineJob job : {line_jobs()[3], line_jobs()[4]}) {
    for (const auto kind : {modification::Kind::lead_crowning, modification::Kind::helix_angle_slope}) {
      modification::Modification m;
      m.kind = kind;
      m.amount_mm = 0.012;
      job.parameters.modifications.push_back(m);
    }
    const auto p = planned(job, 0);
    const double tau = job.tool.half_angle_rad, r_0 = 0.5 * job.tool.diameter_mm;
    for (const int side : {1, -1}) {
      const auto pass = pass_in(p, 0, side);
      const auto points = modified_points(p, 0, side, 31, 17);
      const auto truth = swept(points, {r_0, tau, 0, 0}, pass.way);
      const auto r = checked(p, pass.motions, p.tool);
      double misfit = 0;
      for (const auto& one : p.plan.passes)
        if (one.side == side) misfit = std::max(misfit, one.misfit_mm);
      std::printf("%-10s side %+d modified: swept %.3f um, found %.3f um, bound %.3f um; left %.3f um, planned %.3f\n",
                  job.name.c_str(), side, 1e3 * truth.gouge, 1e3 * r.measured_mm, 1e3 * r.bound_mm, 1e3 * truth.left,
                  1e3 * misfit);
      EXPECT_GE(r.bound_mm, truth.gouge);
      EXPECT_GE(r.measured_mm, truth.gouge - 1e-4);
      EXPECT_LE(r.bound_mm, std::max(r.measured_mm, 0.0) + 2.5e-4);
      EXPECT_LT(r.bound_mm, 3e-3);
      EXPECT_LT(truth.left, misfit + 4e-3);  // the corners of the ends, where the line is short
      auto plain = job.parameters;
      plain.modifications.clear();
      const auto gone = swept(places_on_flank(p, plain, 0, side, 9, 5), {r_0, tau, 0, 0}, pass.way);
      EXPECT_GT(gone.gouge, 0.01) << "the modification is not cut";
    }
  }
}

// 2 um by the whole pass, one record, a tilt of 2 um at the tips, a half angle and a ball radius that are larger than
// stated. Every one is found.
TEST_P(LineProof, PlantedErrorsAreFound) {
  const auto& job = GetParam();
  const auto p = planned(job, 0);
  const double r_0 = 0.5 * job.tool.diameter_mm;
  Random random(5);
  for (const auto& pass : p.plan.passes) {
    const auto clean = pass_in(p, pass.zone, pass.side);
    const FaceFlank f(p.gear, pass.zone, pass.side);
    const double length = pass.contact_top_mm - r_0;
    const bool forwards = (pass.records.front().axis.a - clean.way.front().axis).norm() < 1e-12;
    const auto normal = [&](std::size_t k) {
      const Vec3& a = pass.records[forwards ? k : pass.records.size() - 1 - k].anchor;
      const auto at = f.place(a.head<2>().norm(), a.z());
      return f.spaced(f.surface.flank(f.side, at.u, at.v).n);
    };
    const auto expect = [&](const char* what, const std::vector<BrutePose>& way, const tool::Profile& tool,
                            double least) {
      const auto r = checked(p, motions_along(way), tool);
      std::printf("%-10s zone %d side %+d %-11s found %.3f um on %s, bound %.3f um\n", job.name.c_str(), pass.zone,
                  pass.side, what, 1e3 * r.measured_mm, r.deepest.patch.c_str(), 1e3 * r.bound_mm);
      EXPECT_GT(r.measured_mm, least) << what;
      EXPECT_LT(r.measured_mm, 3e-3) << what;
      EXPECT_GE(r.bound_mm, r.measured_mm) << what;
      EXPECT_LT(r.bound_mm, r.measured_mm + 2.5e-4) << what;
    };
    auto way = clean.way;
    for (std::size_t k = 0; k < way.size(); ++k) way[k].tip -= kFault * normal(k);
    expect("whole pass", way, p.tool, 1.8e-3);
    way = clean.way;
    const std::size_t one = way.size() / 4 + random.index(way.size() / 2);
    way[one].tip -= kFault * normal(one);
    expect("one record", way, p.tool, 1.8e-3);
    way = clean.way;
    for (std::size_t k = 0; k < way.size(); ++k) {
      const Vec3 centre = way[k].tip + r_0 * way[k].axis;
      way[k].axis = (way[k].axis - kFault / length * normal(k)).normalized();
      way[k].tip = centre - r_0 * way[k].axis;
    }
    expect("tilt", way, p.tool, 1.4e-3);
    auto data = job.tool;
    data.half_angle_rad += kFault / length;
    expect("half angle", clean.way, profile_of(data), 1.6e-3);
    data = job.tool;
    data.diameter_mm += 2 * kFault;
    way = clean.way;
    for (auto& q : way) q.tip -= kFault * q.axis;  // the centre stays
    expect("tip radius", way, profile_of(data), 1.8e-3);
  }
}

// The cut surface of all four flanks: what the brute force finds left, and nothing gouged.
TEST_P(LineProof, CutSurface) {
  const auto p = planned(GetParam(), line::kBias);
  path::MillingOperation op;
  op.chord_tolerance_mm = 5e-4;
  const auto start = std::chrono::steady_clock::now();
  const auto cut =
      cut::measure_cut_surface(*p.part, p.motions(), {op}, std::vector<tool::ProofTool>{tool::proof_tool(p.tool, 1)});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double tau = GetParam().tool.half_angle_rad, r_0 = 0.5 * GetParam().tool.diameter_mm;
  for (const auto& g : cut.grids) {
    const int side = flank_side(g.patch);
    if (side == 0) continue;
    double most = -INFINITY, least = INFINITY;
    for (std::size_t k = 0; k < g.points.size(); ++k) {
      if (g.normals[k] == Vec3::Zero()) continue;
      most = std::max(most, double(g.excess_um[0][k]));
      least = std::min(least, double(g.excess_um[0][k]));
    }
    const auto truth = swept(places_on_flank(p, GetParam().parameters, g.zone, side, 25, 17), {r_0, tau, 0, 0},
                             pass_in(p, g.zone, side).way);
    std::printf("%-10s zone %d %s: left %.3f um (brute force %.3f), least %.3f um (%.3f), %.2f s\n",
                GetParam().name.c_str(), g.zone, to_string(g.patch), most, 1e3 * truth.left, least, -1e3 * truth.gouge,
                seconds);
    EXPECT_NEAR(most, 1e3 * truth.left, 0.15);
    EXPECT_NEAR(least, -1e3 * truth.gouge, 0.15);
  }
}

INSTANTIATE_TEST_SUITE_P(Jobs, LineProof, testing::ValuesIn(line_jobs()), [](const auto& i) { return i.param.name; });

/// The meridian of a cutting part as dense points, written out from what it is ordered by.
std::vector<Vec2> dense_meridian(const tool::CutterData& d) {
  constexpr int kArc = 160;
  const double R = 0.5 * d.diameter_mm, tau = d.half_angle_rad;
  std::vector<Vec2> m;
  if (d.shape == tool::CutterShape::flat) {
    m = {{0, 0}, {0, R}};
  } else {
    const double r = d.shape == tool::CutterShape::bull_nose ? d.corner_radius_mm : R;
    m.push_back({0, 0});
    for (int k = 0; k <= kArc; ++k) {
      const double a = (kPi / 2 - tau) * k / kArc;  // from the tip
      m.push_back({r - r * std::cos(a), R - r + r * std::sin(a)});
    }
  }
  const Vec2 side = m.back();
  m.push_back({d.flute_length_mm, side[1] + (d.flute_length_mm - side[0]) * std::tan(tau)});
  return m;
}

struct RandomJob {
  std::string name;
  face_gear::FaceGearParameters gear;
  std::vector<tool::CutterData> tools;
};

/// Random gears of double helical, straight and offset kind, each with mills of every shape.
RandomJob random_job(Random& random, int k) {
  RandomJob job;
  const double m = random(1, 4);
  auto& g = job.gear;
  if (k % 3 == 0) {
    g = double_helical_parameters(m / 5);
    job.name = "double helical";
  } else {
    const int shaper = 20 + int(random.index(8)), teeth = int(shaper * random(2.6, 3.8));
    const double r = 0.5 * m * teeth;
    g = transverse_gear(teeth, shaper, m, 0.3 * m, {{0, 1.0 * r, 1.07 * r}});
    g.offset_mm = k % 3 == 1 ? 0 : random(1, 5) * m / 3;
    job.name = k % 3 == 1 ? "spur" : "offset";
  }
  tool::CutterData d = tapered_mill(0.4 * m, random(3, 7), 3.4 * m, 6 * m, 12 * m);
  d.length_mm = 20 * m + 60;
  job.tools.push_back(d);
  d.shape = tool::CutterShape::ball;
  d.half_angle_rad = 0;
  d.shank_diameter_mm = d.diameter_mm;
  job.tools.push_back(d);
  d.shape = tool::CutterShape::bull_nose;
  d.diameter_mm = 0.5 * m;
  d.corner_radius_mm = random(0.05, 0.2) * m;
  job.tools.push_back(d);
  d.shape = tool::CutterShape::flat;
  job.tools.push_back(d);
  return job;
}

/// A random way through a space of a random gear that nearly touches: moved aside until it does.
path::ToolMotion grazing(Random& random, const face_gear::FaceGear& gear, const analytic::GearDistance& part,
                         const BruteForceBodies& brute, const BruteBody& body, double module_mm, bool turns) {
  const int zone = int(random.index(std::size_t(part.zones())));
  const auto& ring = test::sheet_of(part.space(zone)).ring().zone;
  const double r = random(ring.inner_radius_mm, ring.outer_radius_mm), azimuth = part.space_azimuth(zone, r);
  path::ToolMotion m;
  m.axis_from = (Vec3::UnitZ() + random.vector(0.35)).normalized();
  m.axis_to = turns ? Vec3((m.axis_from + random.vector(0.02)).normalized()) : m.axis_from;
  m.tip_from = Vec3(r * std::cos(azimuth), r * std::sin(azimuth), gear.lowest_root() + random(0.3, 1.2) * module_mm) +
               random.vector(0.1 * module_mm);
  m.tip_to = m.tip_from + random.vector(0.08 * module_mm);
  const Vec3 aside = Vec3(-std::sin(azimuth), std::cos(azimuth), 0) * (random(-1, 1) > 0 ? 1 : -1);
  for (int n = 0; n < 12; ++n) {
    const double gap = -brute.deepest(body, m, 2, 4).depth;
    if (std::abs(gap) < 2e-3) return m;
    const Vec3 step = std::clamp(gap, -0.3 * module_mm, 0.3 * module_mm) * 0.9 * aside;
    m.tip_from += step;
    m.tip_to += step;
  }
  return m;
}

// Poses near contact, half of them turning, in spaces of random gears: the deepest place of dense samples stays below
// the bound, and the bound comes close to what was found.
TEST(RandomPoses, TheBoundCoversDenseSampling) {
  Random random(77);
  double widest = 0, deepest_missed = -INFINITY, most_over = 0;
  int near = 0;
  for (int k = 0; k < 6; ++k) {
    const auto job = random_job(random, k);
    const auto gear = made(job.gear);
    const analytic::GearDistance part(face_gear::part_of(gear), 5);
    const BruteForceBodies brute(gear, 14, 14);
    const double m_n = job.gear.module_mm;
    for (const auto& data : job.tools) {
      const auto tool = tool::proof_tool(profile_of(data), 1);
      const auto body = brute_body(dense_meridian(data));
      for (int run = 0; run < 3; ++run) {
        const auto m = grazing(random, gear, part, brute, body, m_n, run % 2 == 0);
        analytic::ProfileSweep sweep(part, tool, 2e-4, 0.002);
        const auto found = sweep.check(m);
        const double truth = brute.deepest(body, m, 10, 24).depth;
        near += std::abs(found.measured_mm) < 0.02;
        EXPECT_GE(found.bound_mm, truth - 1e-9) << job.name << " shape " << int(data.shape) << " run " << run;
        EXPECT_GE(found.bound_mm, found.measured_mm);
        if (std::abs(found.measured_mm) < 0.01) {
          widest = std::max(widest, found.bound_mm - std::max(found.measured_mm, 0.0));
          most_over = std::max(most_over, found.measured_mm - truth);
          if (truth > 0)
            deepest_missed =
                std::max(deepest_missed, truth - found.measured_mm);  // what is free is not followed farther
        }
      }
    }
  }
  std::printf(
      "%d near contact: bound above what was found by %.3f um at most; brute force deeper by %.3f um at most, "
      "shallower by %.3f um\n",
      near, 1e3 * widest, 1e3 * deepest_missed, 1e3 * most_over);
  EXPECT_GE(near, 30);
  EXPECT_LT(widest, 2.5e-4);
  EXPECT_LT(deepest_missed, 1.5e-4);
}

// Motions that state how far they may stray: wherever the tool then goes, it is no deeper than the bound.
TEST(RandomPoses, TheBoundCoversStatedDeviations) {
  Random random(78);
  double closest = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const auto job = random_job(random, k);
    const auto gear = made(job.gear);
    const analytic::GearDistance part(face_gear::part_of(gear), 5);
    const BruteForceBodies brute(gear, 14, 14);
    const auto& data = job.tools[0];
    const auto tool = tool::proof_tool(profile_of(data), 1);
    const auto body = brute_body(dense_meridian(data));
    for (int run = 0; run < 4; ++run) {
      auto m = grazing(random, gear, part, brute, body, job.gear.module_mm, run % 2 == 0);
      m.deviation_mm = 1e-3;
      m.axis_deviation = 5e-4;
      analytic::ProfileSweep sweep(part, tool, 2e-4, 0.002);
      const double bound = sweep.check(m).bound_mm;
      const auto straight = brute.deepest(body, m, 10, 24);
      for (int n = 0; n < 12; ++n) {
        auto strayed = m;
        const Vec3 off = m.deviation_mm * random.vector(1).normalized(),
                   lean = m.axis_deviation * random.vector(1).normalized();
        strayed.tip_from += off;
        strayed.tip_to += off;
        strayed.axis_from = (m.axis_from + lean - lean.dot(m.axis_from) * m.axis_from).normalized();
        strayed.axis_to = (m.axis_to + lean - lean.dot(m.axis_to) * m.axis_to).normalized();
        const double truth = brute.improved(body, strayed, straight).depth;
        EXPECT_GE(bound, truth) << job.name << " run " << run;
        closest = std::min(closest, bound - truth);
      }
    }
  }
  std::printf("stated deviations: the bound lies %.3f um above the deepest strayed pose at least\n", 1e3 * closest);
}

/// The mill that suits a gear of this module, 5 deg.
tool::CutterData suited(tool::CutterData mill, double module_mm) {
  mill.diameter_mm = 0.36 * module_mm;
  mill.half_angle_rad = radians(5);
  mill.flute_length_mm = 4.2 * module_mm;
  return mill;
}

/// A plan, judged: what the swept flank shows is found, and bounded as closely as on the gears of the project. Nothing:
/// it is refused, with numbers.
std::optional<Planned> judged(const LineJob& job) {
  std::optional<Planned> p;
  try {
    p.emplace(planned(job, 0));
  } catch (const std::runtime_error& refused) {
    std::printf("%s, m %.2f, shaft %.1f deg refused: %s\n", job.name.c_str(), job.parameters.module_mm,
                degrees(job.parameters.shaft_angle_rad), refused.what());
    EXPECT_NE(std::string(refused.what()).find("zone 0: flank "), std::string::npos) << refused.what();
    EXPECT_NE(std::string(refused.what()).find(" mm"), std::string::npos) << refused.what();
    return p;
  }
  for (const auto& pass_of : p->plan.passes) {
    const auto pass = pass_in(*p, pass_of.zone, pass_of.side);
    const auto truth = swept(places_on_flank(*p, job.parameters, pass_of.zone, pass_of.side, 15, 9),
                             {0.5 * job.tool.diameter_mm, job.tool.half_angle_rad, 0, 0}, pass.way);
    const auto r = checked(*p, pass.motions, p->tool);
    std::printf(
        "%-14s m %.2f shaft %.1f deg zone %d side %+d: misfit %.2f um, swept left %.3f um, gouge %.3f um, found %.3f "
        "um "
        "on %s, bound %.3f um, shortened %.3f mm\n",
        job.name.c_str(), job.parameters.module_mm, degrees(job.parameters.shaft_angle_rad), pass_of.zone, pass_of.side,
        1e3 * pass_of.misfit_mm, 1e3 * truth.left, 1e3 * truth.gouge, 1e3 * r.measured_mm, r.deepest.patch.c_str(),
        1e3 * r.bound_mm, pass_of.shortened_mm);
    EXPECT_GE(r.bound_mm, truth.gouge);
    EXPECT_GE(r.measured_mm, truth.gouge - 1e-4);
    EXPECT_LE(r.bound_mm, std::max(r.measured_mm, 0.0) + 2.5e-4);
    EXPECT_LT(r.bound_mm, 6e-4);
    if (pass_of.shortened_mm == 0) { EXPECT_LT(truth.left, pass_of.misfit_mm + pass_of.chord_mm + 3e-4); }
  }
  return p;
}

TEST(RandomGears, LinePlans) {
  Random random(31);
  int plans = 0;
  for (int k = 0; k < 9 && plans < 6; ++k) {
    const auto drawn = random_job(random, k);
    if (judged({drawn.name, drawn.gear, suited(drawn.tools.front(), drawn.gear.module_mm)})) ++plans;
  }
  EXPECT_GE(plans, 4);
}

// The tips lie on a cone, or on a surface that is nearly one: shaft angles of 62 to 115 deg, with offset and helix.
TEST(RandomGears, LinePlansAtAnyShaftAngle) {
  Random random(41);
  int plans = 0, drawn = 0;
  for (int k = 0; k < 400 && drawn < 7; ++k) {
    face_gear::FaceGearParameters g;
    g.teeth = 40 + int(random.index(60));
    g.shaper_teeth = int(g.teeth * random(0.25, 0.5));
    g.module_mm = random(1.5, 4);
    g.module_plane = face_gear::ModulePlane::transverse;
    g.pressure_angle_rad = radians(random(20, 26));
    g.shaft_angle_rad = radians(drawn % 2 == 0 ? random(62, 88) : random(92, 115));
    const double helix = k % 2 == 0 ? 0 : radians(random(-20, 20)), pitch = 0.5 * g.module_mm * g.teeth;
    g.offset_mm = k % 3 == 0 ? random(-0.1, 0.1) * pitch : 0;
    g.shaper_tip_radius_mm = random(0.1, 0.25) * g.module_mm;
    const double middle =
        pitch * (1 + double(g.shaper_teeth) / g.teeth * std::cos(g.shaft_angle_rad)) / std::sin(g.shaft_angle_rad);
    const double inner = middle - random(0, 4) * g.module_mm;
    g.zones = {{helix, inner, inner + 1.5 * g.module_mm}};
    if (face_gear::FaceGear::make(g).refused()) continue;
    ++drawn;
    auto mill = suited(tapered_mill(1, 5, 4, 6, 30), g.module_mm);
    mill.diameter_mm = 0.25 * g.module_mm;
    if (judged({fmt::format("random {}", k), g, mill})) ++plans;
  }
  EXPECT_EQ(drawn, 7);
  EXPECT_GE(plans, 4);
}

// Bodies of the proof against the dense meridian: nowhere inside of it, and no farther outside than they say.
TEST(ProofTools, ContainTheCuttingPart) {
  Random random(3);
  auto measured = tapered_mill(0.8, 5, 5, 6, 20);
  measured.meridian = tool::MeridianError{{0, 0.4, 1.1, 2.0, 3.1, 4.2}, {0.001, -0.002, 0.003, 0.0015, -0.001, 0.002}};
  auto bull = tapered_mill(3, 0, 6, 6, 20);
  bull.shape = tool::CutterShape::bull_nose;
  bull.corner_radius_mm = 0.6;
  auto flat = bull;
  flat.shape = tool::CutterShape::flat;
  auto ball = tapered_mill(2, 0, 5, 2, 20);
  ball.shape = tool::CutterShape::ball;
  auto barrel = tapered_mill(1, 6, 4, 6, 20);
  barrel.shape = tool::CutterShape::barrel;
  barrel.meridian_radius_mm = 60;
  for (const auto& data : {tapered_mill(0.5, 5, 4, 4, 22), measured, bull, flat, ball, barrel}) {
    const auto profile = profile_of(data);
    const auto tool = tool::proof_tool(profile, 1);
    double most_inside = -INFINITY, most_outside = -INFINITY;
    for (int k = 0; k < 20000; ++k) {
      const Vec3 x(random(0, profile.cutting().largest_radius() + 0.02), 0, random(-0.02, data.flute_length_mm));
      const double truth = profile.cutting_distance(x).distance;
      if (std::abs(truth) > 0.02) continue;
      double d = INFINITY;
      for (const auto& body : tool.cutting) d = std::min(d, tool::rounded_distance(x, body));
      // The discs that close the meridian are not the tool's, and above what was measured the largest error stands for
      // it.
      if (x.z() > data.flute_length_mm - 0.05 || (data.meridian && x.z() > profile.law_end())) continue;
      most_inside = std::max(most_inside, d - truth);
      most_outside = std::max(most_outside, truth - d);
    }
    std::printf("shape %d%s: bodies %zu, inside by %.4f um, outside by %.4f um at most\n", int(data.shape),
                data.meridian ? " measured" : "", tool.cutting.size(), 1e3 * most_inside, 1e3 * most_outside);
    EXPECT_LT(most_inside, data.meridian ? 1e-5 : 1e-9);
    EXPECT_LT(most_outside, data.meridian || data.shape == tool::CutterShape::barrel ? 5e-4 : 1e-9);
  }
}

// What a moving mill removes, against the union of its balls at dense moments.
TEST(SweptTools, ExcessOfRandomPoints) {
  Random random(9);
  const auto tool = tool::proof_tool(profile_of(tapered_mill(0.5, 5, 4, 4, 22)), 1);
  const BruteConicalMill mill{0.25, radians(5), 0, 0};
  double worst = 0;
  for (int k = 0; k < 300; ++k) {
    path::ToolMotion m;
    m.tip_from = random.vector(0.2);
    m.tip_to = m.tip_from + random.vector(0.3);
    m.axis_from = (Vec3::UnitZ() + random.vector(0.5)).normalized();
    m.axis_to = (m.axis_from + random.vector(k % 2 == 0 ? 0 : 0.03)).normalized();
    const Vec3 p = path::tip_at(m, 0.5) + random(0, 3.5) * path::axis_at(m, 0.5) + random.vector(0.6);
    const double truth = test::least_distance(p, mill, {{m.tip_from, m.axis_from}, {m.tip_to, m.axis_to}});
    const double found = cut::least_distance(p, tool.cutting[0], m, INFINITY);
    if (truth > 0.5 || (p - path::tip_at(m, 0.5)).dot(path::axis_at(m, 0.5)) > 3.6) continue;
    worst = std::max(worst, std::abs(found - truth));
  }
  std::printf("excess of random points against a union of balls: %.2g mm\n", worst);
  EXPECT_LT(worst, 1e-8);
}

// What is left out of a chain of motions and bodies is what cannot be the least: the same to a nanometre as all of
// them, each looked at to its end.
TEST(SweptTools, NothingThatIsLeastIsLeftOut) {
  Random random(15);
  tool::CutterData measured = tapered_mill(0.5, 5, 4, 4, 22);
  measured.meridian = tool::MeridianError{{0, 1, 2, 3, 3.6}, {0, 0.001, -0.001, 0.0005, 0.001}};
  for (const auto& mill : {tapered_mill(0.5, 5, 4, 4, 22), measured}) {
    const auto tool = tool::proof_tool(profile_of(mill), 1);
    std::vector<path::ToolMotion> motions;
    Vec3 tip = Vec3::Zero(), axis = Vec3::UnitZ();
    for (int k = 0; k < 120; ++k) {
      path::ToolMotion m;
      m.tip_from = tip, m.axis_from = axis;
      tip += k % 10 == 9 ? random.vector(0.6) : random.vector(0.1);
      axis = (axis + random.vector(k % 3 == 0 ? 0.2 : 0.01)).normalized();
      m.tip_to = tip, m.axis_to = axis;
      motions.push_back(m);
    }
    const cut::SweptTool swept(motions, tool.cutting, 100);
    std::size_t answered = SIZE_MAX, nearest = SIZE_MAX;
    int near = 0;
    for (int k = 0; k < 400; ++k) {
      const auto& m = motions[random.index(motions.size())];
      const Vec3 p = m.tip_from + random(0, 3.5) * m.axis_from + random.vector(0.5);
      const double cap = random(0.001, 0.3);
      double least = cap;
      for (const auto& motion : motions)
        for (const auto& body : tool.cutting) least = std::min(least, cut::least_distance(p, body, motion, INFINITY));
      const double found = swept.excess(p, cap);
      EXPECT_GE(found, least);
      EXPECT_LE(found, least + 1e-9) << k;
      EXPECT_EQ(swept.excess(p, cap, &nearest), found) << k;
      EXPECT_EQ(swept.comes_within(motions.size(), p, cap), found < cap) << k;
      EXPECT_EQ(swept.comes_within(motions.size(), p, cap, &answered), found < cap) << k;
      double early = INFINITY;
      for (std::size_t n = 0; n < motions.size() / 2; ++n)
        for (const auto& body : tool.cutting)
          early = std::min(early, cut::least_distance(p, body, motions[n], INFINITY));
      if (std::abs(early - cap) > 1e-9) { EXPECT_EQ(swept.comes_within(motions.size() / 2, p, cap), early < cap) << k; }
      near += least < cap;
    }
    EXPECT_GT(near, 100);
  }
}

// The feed of the contact: what is slowest limits it.
TEST(ContactFeed, LimitsOfTipAxisAndBlock) {
  const Vec3 a(0, 0, 0), b(0.4, 0, 0), z = Vec3::UnitZ(), lean(std::sin(0.01), 0, std::cos(0.01));
  line::FeedLimits none;
  EXPECT_EQ(line::contact_feed(300, none, 0.1, a, z, b, lean), 300);
  line::FeedLimits tip;
  tip.tip_mm_min = 600;  // the tip runs four times as fast
  EXPECT_NEAR(line::contact_feed(300, tip, 0.1, a, z, b, z), 150, 1e-12);
  line::FeedLimits tilt;
  tilt.tilt_rad_min = 10;
  EXPECT_NEAR(line::contact_feed(300, tilt, 0.1, a, z, b, lean), 100, 1e-9);
  line::FeedLimits azimuth;
  azimuth.azimuth_rad_min = 10;
  const Vec3 turned(std::sin(0.5) * std::cos(0.02), std::sin(0.5) * std::sin(0.02), std::cos(0.5)),
      straight(std::sin(0.5), 0, std::cos(0.5));
  EXPECT_NEAR(line::contact_feed(300, azimuth, 0.1, a, straight, b, turned), 50, 1e-9);
  line::FeedLimits block;
  block.block_s = 0.03;
  EXPECT_NEAR(line::contact_feed(300, block, 0.1, a, z, b, z), 200, 1e-9);
}

// A cone too thick for the groove: the two flanks that lean over it end early and say so, and nothing is cut.
// The same bits with one thread and with several, through the whole check and the cut surface.
TEST(LineProofThreads, SameAnswerWithOneThread) {
  const auto p = planned(line_jobs().front(), line::kBias);
  const auto motions = p.motions();
  path::MillingOperation op;
  const auto surface = [&] {
    return cut::measure_cut_surface(*p.part, motions, {op}, std::vector<tool::ProofTool>{tool::proof_tool(p.tool, 1)});
  };
  const auto many = checked(p, motions, p.tool);
  const auto cut = surface();
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const auto single = checked(p, motions, p.tool);
  EXPECT_EQ(many.measured_mm, single.measured_mm);
  EXPECT_EQ(many.bound_mm, single.bound_mm);
  EXPECT_EQ(many.clearance_mm, single.clearance_mm);
  EXPECT_EQ(many.distance_queries, single.distance_queries);
  EXPECT_EQ(many.deepest.point, single.deepest.point);
  const auto again = surface();
  for (std::size_t k = 0; k < cut.grids.size(); ++k) EXPECT_EQ(cut.grids[k].excess_um, again.grids[k].excess_um);
}

// A path is accepted, or refused with body and place.
TEST(LineProofPaths, CheckedPath) {
  auto p = planned(line_jobs().back(), line::kBias);
  analytic::GougeCheckOptions o;
  o.rapid_height_mm = p.gear.blank_top();
  const analytic::GougeCheck check(*p.part, {tool::proof_tool(p.tool, 7)}, o);
  EXPECT_TRUE(check.check_path(p.plan.path));
  for (auto& r : p.plan.path.records)
    if (r.kind == path::MoveKind::feed) r.tip.z() -= 0.02;
  const auto refused = check.check_path(p.plan.path);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(" cuts 0.0"), std::string::npos) << refused.error().message;
}

TEST(Room, IsRefusedWhereAFullStationHasNone) {
  const auto gear = made(quarter_dhfg());
  const analytic::GearDistance part(face_gear::part_of(gear), 5);
  const auto refused = [&](const tool::CutterData& data, double allowance, const char* text) {
    const auto tool = profile_of(data);
    line::LineOperation o;
    o.speed_rpm = 20000;
    o.feed_mm_min = 300;
    o.allowance_mm = allowance;
    o.clearance_height_mm = gear.blank_top() + 1;
    o.room = line::room_of(part, tool);
    const auto plan = line::plan_line_milling(kept(gear), tool, o);
    ASSERT_FALSE(plan) << text;
    EXPECT_NE(plan.error().message.find(text), std::string::npos) << plan.error().message;
  };
  refused(tapered_mill(0.8, 5, 4, 4, 22), 0, "the flute has a gap of -0.");    // the opposite flank
  refused(tapered_mill(0.5, 5, 4, 4, 22), 0.5, "the flute has a gap of -0.");  // so much stock here leans it into that
  auto low = tapered_mill(0.5, 5, 4, 4, 4.2);
  low.holder = {{30, 30, 20}};
  refused(low, 0, "the holder has a gap of");
}

TEST(Room, AThickConeEndsEarly) {
  LineJob job{"dhfg 10 deg", quarter_dhfg(), tapered_mill(0.5, 10, 4, 6, 16)};
  const auto p = planned(job, line::kBias);
  const auto r = checked(p, p.motions(), p.tool);
  for (const auto& pass : p.plan.passes)
    std::printf("10 deg, zone %d side %+d: shortened by %.3f mm\n", pass.zone, pass.side, pass.shortened_mm);
  std::printf("10 deg: found %.3f um, bound %.3f um\n", 1e3 * r.measured_mm, 1e3 * r.bound_mm);
  EXPECT_LT(r.bound_mm, 3e-4);
  for (const auto& pass : p.plan.passes) EXPECT_EQ(pass.shortened_mm > 0, pass.side > 0) << pass.zone << pass.side;
}

}  // namespace
}  // namespace toothpath::test
