// The proof of the proof: clean programs pass, every planted fault is found, and nothing between the samples is deeper than
// the bound.
#include "cam/gouge_check.h"

#include <tbb/global_control.h>

#include "geometry/tooth_mesh.h"
#include "tests/cam/face_gear_jobs.h"
#include "tests/support/brute_force_gear_solid.h"

namespace toothpath {
namespace {

using test::PlannedJob;
using test::job_named;

Vec3 centre(const ClRecord& r, double R) { return r.tip + R * r.axis; }

GougeResult check(const PlannedJob& job, const std::vector<ToolMotion>& motions, std::vector<ToolAssembly> tools = {}) {
  const GougeCheck checker(*job.part, tools.empty() ? job.tools : tools, job.check_options());
  return checker.check(motions, job.tool_of_operation());
}
bool passes(const PlannedJob& job, const GougeResult& r) { return GougeCheck(*job.part, job.tools, job.check_options()).passes(r); }

/// The deepest place of the ball on some motions, looked for at `steps` places a motion.
struct Sampled {
  double depth = -INFINITY;
  std::vector<std::pair<double, Vec3>> all;  // depth and foot, those within 0.2 um of the deepest are of interest
};
Sampled sampled(const PlannedJob& job, const std::vector<ToolMotion>& motions, double R, int steps) {
  Sampled s;
  for (const auto& m : motions)
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps;
      const Vec3 axis = ((1 - t) * m.axis_from + t * m.axis_to).normalized();
      const auto q = job.part->nearest((1 - t) * m.tip_from + t * m.tip_to + R * axis, R + 0.1);
      s.depth = std::max(s.depth, R - q.distance);
      s.all.push_back({R - q.distance, q.foot});
    }
  return s;
}

class Clean : public testing::TestWithParam<std::string> {};

TEST_P(Clean, PassesWithItsBoundAboveWhatWasMeasured) {
  const auto& job = job_named(GetParam());
  const GougeCheck checker(*job.part, job.tools, job.check_options());
  for (const auto& path : job.plan.paths) {
    const auto r = checker.check(GougeCheck::motions_of(path), job.tool_of_operation());
    EXPECT_TRUE(r.worst.empty());
    EXPECT_TRUE(checker.passes(r)) << path.operation << " measured " << r.measured_mm << " bound " << r.bound_mm << " clearance " << r.clearance_mm
                                   << " " << r.deepest.patch << " at " << r.deepest.radius_mm;
    EXPECT_GE(r.bound_mm, r.measured_mm);
    EXPECT_LE(r.bound_mm, std::max(r.measured_mm, 0.0) + 2.5e-4);
    EXPECT_TRUE(r.rapids_clear);
    EXPECT_TRUE(checker.check_path(path));
    if (job.operations[std::size_t(path.operation)].allowance_mm == 0) {
      EXPECT_GE(r.measured_mm, -1e-6);  // it does touch
    }
  }
}

TEST_P(Clean, TenfoldSamplingStaysBelowTheBound) {
  const auto& job = job_named(GetParam());
  const test::BruteForceGearSolid brute(job.gear);
  test::Random random(31);
  for (const auto& path : job.plan.paths) {
    const auto motions = GougeCheck::motions_of(path);
    const auto r = check(job, motions);
    const double R = job.tool(path.operation).radius_mm();
    // Every move at ten places; a hundred places of them against the sampled surfaces themselves.
    EXPECT_LE(sampled(job, motions, R, 10).depth, r.bound_mm + 1e-9);
    for (int k = 0; k < 60; ++k) {
      const auto& m = motions[random.index(motions.size())];
      const double t = random(0, 1);
      const Vec3 c = (1 - t) * m.tip_from + t * m.tip_to + R * ((1 - t) * m.axis_from + t * m.axis_to).normalized();
      EXPECT_LE(R - brute.nearest(c).distance, r.bound_mm + 1e-7);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Jobs, Clean, testing::Values("dhfg", "offset", "conical", "spur"), [](const auto& job_case) {
  std::string name = job_case.param;
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

/// A planted fault: the moves that it touches.
struct Planted {
  std::string what;
  std::vector<ToolMotion> motions;
  int operation = 0;
};

/// Plants faults in a job; each moves a record (or drops some) so that the ball cuts 2 um deep.
class Planter {
 public:
  Planter(const PlannedJob& job, unsigned seed) : job_(job), random_(seed) {}

  /// A record moved into the surface nearest to it.
  std::optional<Planted> moved(MoveKind kind) {
    const auto& path = job_.plan.paths[random_.index(job_.plan.paths.size())];
    const double R = job_.tool(path.operation).radius_mm();
    for (int attempt = 0; attempt < 200; ++attempt) {
      const std::size_t k = 1 + random_.index(path.records.size() - 2);
      if (path.records[k].kind != kind || path.records[k + 1].kind == MoveKind::rapid) continue;
      auto records = std::vector<ClRecord>(path.records.begin() + long(k) - 1, path.records.begin() + long(k) + 2);
      if (!push_in(records[1], R)) continue;
      return Planted{std::string("moved ") + to_string(kind), motions(path, records, k), path.operation};
    }
    return {};
  }

  /// Records of one pass dropped until the straight way between the rest cuts 2 um deep.
  std::optional<Planted> dropped() {
    const auto& path = job_.plan.paths.back();
    const double R = job_.tool(path.operation).radius_mm();
    for (int attempt = 0; attempt < 200; ++attempt) {
      const std::size_t k = 1 + random_.index(path.records.size() - 2);
      for (std::size_t j = k + 2; j < path.records.size() && j < k + 60; ++j) {
        if (path.records[j].kind != MoveKind::feed || path.records[j - 1].kind != MoveKind::feed) break;
        const std::vector<ClRecord> two{path.records[k], path.records[j]};
        const auto m = motions(path, two, k);
        const double depth = sampled(job_, m, R, 16).depth;
        if (depth < 0.0022) continue;
        if (depth > 0.05) break;
        return Planted{"dropped", m, path.operation};
      }
    }
    return {};
  }

  /// A record on a fillet or at the end of a zone moved in.
  std::optional<Planted> at_patch(const char* patch, bool at_end) {
    const auto& path = job_.plan.paths.back();
    const double R = job_.tool(path.operation).radius_mm();
    for (int attempt = 0; attempt < 3000; ++attempt) {
      const std::size_t k = 1 + random_.index(path.records.size() - 2);
      if (path.records[k].kind != MoveKind::feed || path.records[k + 1].kind != MoveKind::feed) continue;
      auto records = std::vector<ClRecord>(path.records.begin() + long(k) - 1, path.records.begin() + long(k) + 2);
      const auto q = job_.part->nearest(centre(records[1], R), R + 0.05);
      if (std::string(q.patch).find(patch) == std::string::npos) continue;
      const auto& zone = job_.gear.rings()[std::size_t(q.zone)].zone;
      const double r = q.foot.head<2>().norm();
      if (at_end && std::min(r - zone.inner_radius_mm, zone.outer_radius_mm - r) > 0.05) continue;
      if (!push_in(records[1], R)) continue;
      return Planted{std::string(patch) + (at_end ? " at an end" : ""), motions(path, records, k), path.operation};
    }
    return {};
  }

 private:
  /// Towards the nearest surface until the ball cuts 2 um deep.
  bool push_in(ClRecord& record, double R) const {
    for (int round = 0; round < 4; ++round) {
      const Vec3 c = centre(record, R);
      const auto q = job_.part->nearest(c, R + 0.1);
      if (!(q.distance < R + 0.1) || q.distance <= 0) return false;
      const Vec3 foot = FaceGearSurface<double>::turned(q.foot, std::remainder(std::atan2(c.y(), c.x()) - std::atan2(q.point.y(), q.point.x()), 2 * kPi));
      if (std::abs((foot - c).norm() - q.distance) > 1e-5) return false;  // an edge: its foot is only near
      record.tip += (foot - c).normalized() * (q.distance - (R - 0.002));
    }
    return std::abs(R - 0.002 - job_.part->nearest(centre(record, R), R + 0.1).distance) < 1e-6;
  }
  [[nodiscard]] std::vector<ToolMotion> motions(const ClPath& path, const std::vector<ClRecord>& records, std::size_t line) const {
    ClPath piece = path;
    piece.records = records;
    auto m = GougeCheck::motions_of(piece);
    for (auto& one : m) one.line += int(line) - 1;
    return m;
  }
  const PlannedJob& job_;
  test::Random random_;
};

TEST(PlantedGouges, AllAreFoundWithinAFifthOfAMicrometre) {
  int planted = 0;
  std::map<std::string, int> kinds;
  for (const char* name : {"dhfg", "offset", "conical", "spur", "spur wide"}) {
    const auto& job = job_named(name);
    Planter planter(job, 101);
    std::vector<Planted> faults;
    const auto add = [&](std::optional<Planted> f) {
      if (f) faults.push_back(std::move(*f));
    };
    for (int k = 0; k < 19; ++k) add(planter.moved(MoveKind::feed));
    for (int k = 0; k < 6; ++k) add(planter.moved(MoveKind::engage));
    for (int k = 0; k < 8; ++k) add(planter.dropped());
    for (int k = 0; k < 6; ++k) add(planter.at_patch("fillet", false));
    for (int k = 0; k < 4; ++k) add(planter.at_patch("root", false));
    for (int k = 0; k < 6; ++k) add(planter.at_patch("", true));
    for (const auto& fault : faults) {
      ++planted;
      ++kinds[fault.what];
      const double R = job.tool(fault.operation).radius_mm();
      const auto truth = sampled(job, fault.motions, R, 2000);
      const auto r = check(job, fault.motions);
      SCOPED_TRACE(fmt::format("{} {}: truth {:.6f} measured {:.6f} bound {:.6f} on {} at line {}", name, fault.what, truth.depth, r.measured_mm,
                               r.bound_mm, r.deepest.patch, r.deepest.line));
      EXPECT_GE(truth.depth, 0.002 - 1e-6);
      EXPECT_NEAR(r.measured_mm, truth.depth, 2.0e-4);
      EXPECT_GE(r.bound_mm, truth.depth - 1e-9);
      EXPECT_LE(r.bound_mm, truth.depth + 2.5e-4);
      double away = INFINITY;
      for (const auto& [depth, foot] : truth.all)
        if (depth >= truth.depth - 2e-4) away = std::min(away, (foot - r.deepest.point).norm());
      EXPECT_LE(away, 0.1);
    }
  }
  EXPECT_GE(planted, 200);
  for (const auto& [what, count] : kinds) RecordProperty(what, count);
  for (const char* what : {"moved feed", "moved engage", "dropped", "fillet", "root", " at an end"}) EXPECT_GE(kinds[what], 4) << what;
}

TEST(PlantedGouges, InAWholeProgramTheDeepestComesFirst) {
  auto job = test::planned(test::small_spur(), {test::ball_mill(1, 6, 0.95, 16, 10)}, {test::finishing(0, 0.02, 0.002)});
  auto& records = job.plan.paths[0].records;
  test::Random random(5);
  const double R = 0.5;
  for (int round = 0; round < 5; ++round) {
    std::size_t k = 0;
    do k = 1 + random.index(records.size() - 2);
    while (records[k].kind != MoveKind::feed || records[k + 1].kind != MoveKind::feed);
    const auto saved = records[k];
    const auto q = job.part->nearest(centre(saved, R), R + 0.05);
    const Vec3 foot = q.foot;
    records[k].tip += (foot - q.point).normalized() * (q.distance - R + 0.005);
    const GougeCheck checker(*job.part, job.tools, job.check_options());
    const auto r = checker.check(GougeCheck::motions_of(job.plan.paths[0]), {0});
    ASSERT_FALSE(r.worst.empty());
    EXPECT_TRUE(r.worst.front().line == int(k) || r.worst.front().line == int(k) + 1);
    EXPECT_LE((r.worst.front().point - foot).norm(), 0.1);
    const auto refused = checker.check_path(job.plan.paths[0]);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, DiagnosticKind::verification);
    EXPECT_NE(refused.error().message.find("gouge tolerance"), std::string::npos) << refused.error().message;
    records[k] = saved;
  }
}

TEST(WrongPrograms, ShiftedZone) {
  const auto& job = job_named("dhfg");
  auto path = job.plan.paths.back();
  for (auto& r : path.records)
    if (r.zone == 1) r.tip = FaceGearSurface<double>::turned(r.tip, 0.005 / 121);  // 5 um along the circle
  const auto r = check(job, GougeCheck::motions_of(path));
  EXPECT_FALSE(passes(job, r));
  EXPECT_EQ(r.deepest.zone, 1);
  EXPECT_GE(r.measured_mm, 0.002);
}

TEST(WrongPrograms, SwappedSign) {
  const auto& job = job_named("dhfg");
  for (int axis = 0; axis < 2; ++axis) {
    auto path = job.plan.paths.back();
    for (auto& r : path.records) r.tip[axis] = -r.tip[axis];
    EXPECT_FALSE(passes(job, check(job, GougeCheck::motions_of(path)))) << axis;
  }
}

TEST(WrongPrograms, WrongBallRadius) {
  const auto& job = job_named("spur");
  auto tools = job.tools;
  tools[0].diameter_mm += 0.01;
  const auto r = check(job, GougeCheck::motions_of(job.plan.paths.back()), tools);
  EXPECT_FALSE(passes(job, r));
  // The tip stays: the ball grows by 5 um and rises by 5 um, which leaves 5 (1 - n.axis) um on a flank.
  EXPECT_GE(r.measured_mm, 0.005 * (1 - std::sin(radians(20))));
}

TEST(WrongPrograms, WrongToolLength) {
  const auto& job = job_named("offset");
  auto path = job.plan.paths.back();
  for (auto& r : path.records) r.tip -= 0.005 * r.axis;
  const auto r = check(job, GougeCheck::motions_of(path));
  EXPECT_FALSE(passes(job, r));
  EXPECT_NEAR(r.measured_mm, 0.005, 5e-4);  // on the root land the whole of it
}

TEST(WrongPrograms, OneToothOnly) {
  const auto& job = job_named("spur");
  auto motions = GougeCheck::motions_of(job.plan.paths.back());
  const double pitch = job.gear.pitch();
  for (auto& m : motions) {
    m.tooth = 17;
    m.tip_from = FaceGearSurface<double>::turned(m.tip_from, 17 * pitch);
    m.tip_to = FaceGearSurface<double>::turned(m.tip_to, 17 * pitch);
  }
  EXPECT_TRUE(passes(job, check(job, motions)));
  for (auto& m : motions) {
    m.tip_from = FaceGearSurface<double>::turned(m.tip_from, 0.005 / 62);
    m.tip_to = FaceGearSurface<double>::turned(m.tip_to, 0.005 / 62);
  }
  const auto r = check(job, motions);
  EXPECT_FALSE(passes(job, r));
  ASSERT_FALSE(r.worst.empty());
  EXPECT_EQ(r.worst.front().tooth, 17);
}

TEST(WrongPrograms, RapidThroughTheBlank) {
  for (const char* name : {"dhfg", "spur", "conical"}) {
    const auto& job = job_named(name);
    const auto& path = job.plan.paths.front();
    // Back from the last place to the first one, at the clearance height: allowed. Lower, it meets the blank.
    ToolMotion rapid;
    rapid.rapid = true;
    rapid.tip_from = path.records.back().tip;
    rapid.tip_to = path.records.front().tip;
    rapid.axis_from = path.records.back().axis;
    rapid.axis_to = path.records.front().axis;
    EXPECT_TRUE(check(job, {rapid}).rapids_clear) << name;
    for (const bool first : {true, false}) {
      auto low = rapid;
      (first ? low.tip_from : low.tip_to).z() = job.gear.blank_top() - 0.02;
      const auto r = check(job, {low});
      EXPECT_FALSE(r.rapids_clear) << name;
      EXPECT_FALSE(passes(job, r));
    }
  }
}

TEST(WrongPrograms, ShankAndHolder) {
  const auto& job = job_named("spur");
  const auto motions = GougeCheck::motions_of(job.plan.paths.back());
  auto fat = job.tools;
  fat[0].shank_diameter_mm = 2.4;
  fat[0].flute_length_mm = 2.0;
  auto r = check(job, motions, fat);
  EXPECT_FALSE(passes(job, r));
  ASSERT_FALSE(r.worst.empty());
  const auto worst_is = [&](const char* body) {
    return std::any_of(r.worst.begin(), r.worst.end(), [&](const WorstPlace& w) { return w.body == body; });
  };
  EXPECT_TRUE(worst_is("shank"));
  auto stubby = job.tools;
  stubby[0].flute_length_mm = 3;
  stubby[0].stick_out_mm = 3.5;
  r = check(job, motions, stubby);
  EXPECT_FALSE(passes(job, r));
  EXPECT_TRUE(worst_is("holder"));
  const GougeCheck checker(*job.part, stubby, job.check_options());
  const auto refused = checker.check_path(job.plan.paths.back());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("holder"), std::string::npos) << refused.error().message;
}

TEST(Proof, TheSameOnOneAndTwoThreads) {
  const auto& job = job_named("spur");
  auto path = job.plan.paths.back();
  for (std::size_t k = 50; k < path.records.size(); k += 97) path.records[k].tip.z() -= 0.02;
  const auto motions = GougeCheck::motions_of(path);
  std::vector<GougeResult> results;
  for (const std::size_t threads : {1, 2}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(check(job, motions));
  }
  const auto &a = results[0], &b = results[1];
  EXPECT_EQ(a.measured_mm, b.measured_mm);
  EXPECT_EQ(a.bound_mm, b.bound_mm);
  EXPECT_EQ(a.clearance_mm, b.clearance_mm);
  EXPECT_EQ(a.distance_queries, b.distance_queries);
  ASSERT_EQ(a.worst.size(), b.worst.size());
  EXPECT_FALSE(a.worst.empty());
  for (std::size_t k = 0; k < a.worst.size(); ++k) {
    EXPECT_EQ(a.worst[k].depth_mm, b.worst[k].depth_mm);
    EXPECT_EQ(a.worst[k].line, b.worst[k].line);
    EXPECT_EQ(a.worst[k].point, b.worst[k].point);
  }
}

/// Distance from a point to a triangle, in single precision throughout.
float single_distance(const Eigen::Vector3f& c, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& d) {
  const Eigen::Vector3f n = (b - a).cross(d - a).normalized();
  const float height = (c - a).dot(n);
  const Eigen::Vector3f foot = c - n * height;
  if ((b - a).cross(foot - a).dot(n) >= 0 && (d - b).cross(foot - b).dot(n) >= 0 && (a - d).cross(foot - d).dot(n) >= 0) return std::abs(height);
  const auto edge = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& q) {
    const float t = std::clamp((c - p).dot(q - p) / (q - p).squaredNorm(), 0.0F, 1.0F);
    return (c - p - t * (q - p)).norm();
  };
  return std::min({edge(a, b), edge(b, d), edge(d, a)});
}

/// The same question put to float32 facets alone, as a mesh-based check puts it: gouges of 1 um pass for clean.
TEST(Proof, SinglePrecisionFacetsWouldMissAMicrometre) {
  const FaceGear gear = test::made(test::quarter_dhfg());
  const GearDistance part(gear, 1.0);
  const auto pitch = mesh_tooth_space(gear, 0.01);
  ASSERT_TRUE(pitch);
  std::vector<Eigen::Vector3f> v;
  for (const auto& p : pitch->mesh.vertices) v.push_back(p.cast<float>());
  const double R = 0.25, depth = 0.001;
  test::Random random(3);
  int missed = 0, asked = 0;
  for (int k = 0; k < 4000 && asked < 60; ++k) {
    const std::size_t t = random.index(pitch->tags.size());
    if (pitch->tags[t].patch != Patch::flank_plus && pitch->tags[t].patch != Patch::flank_minus) continue;
    const auto& uv = pitch->tags[t].uv;
    const auto q = exact_patch_point(gear, pitch->tags[t].zone, pitch->tags[t].patch, (uv[0] + uv[1] + uv[2]) / 3);
    if (!q) continue;
    const Vec3 c = q->p + (R - depth) * q->n;
    if (std::abs(part.nearest(c, R + 0.1).distance - (R - depth)) > 1e-9) continue;  // another surface is nearer
    ++asked;
    float least = INFINITY;
    for (const auto& triangle : pitch->mesh.triangles) {
      const auto at = [&](std::size_t n) { return v[std::size_t(triangle[n])]; };
      least = std::min(least, single_distance(c.cast<float>(), at(0), at(1), at(2)));
    }
    missed += least >= float(R);  // "no gouge"
  }
  EXPECT_GE(asked, 40);
  EXPECT_GE(missed, 1);
  RecordProperty("missed", missed);
}

}  // namespace
}  // namespace toothpath
