// Gouges of 2 um planted in planned programs, one record or a few at a time: all are found, with their depth and their
// place.
#include <map>
#include <optional>

#include "tests/cam/analytic/gouge_case.h"

namespace toothpath::test {
namespace {

/// A planted fault: the moves that it touches.
struct Planted {
  std::string what;
  std::vector<path::ToolMotion> motions;
  int operation = 0;
};

/// Plants faults in a job; each moves a record (or drops some) so that the ball cuts 2 um deep.
class Planter {
 public:
  Planter(const PlannedJob& job, unsigned seed) : job_(job), random_(seed) {}

  /// A record moved into the surface nearest to it.
  std::optional<Planted> moved(path::MoveKind kind) {
    const auto& path = job_.plan.paths[random_.index(job_.plan.paths.size())];
    const double R = job_.tool(path.operation).radius_mm();
    for (int attempt = 0; attempt < 200; ++attempt) {
      const std::size_t k = 1 + random_.index(path.records.size() - 2);
      if (path.records[k].kind != kind || path.records[k + 1].kind == path::MoveKind::rapid) continue;
      auto records =
          std::vector<path::ClRecord>(path.records.begin() + long(k) - 1, path.records.begin() + long(k) + 2);
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
        if (path.records[j].kind != path::MoveKind::feed || path.records[j - 1].kind != path::MoveKind::feed) break;
        const std::vector<path::ClRecord> two{path.records[k], path.records[j]};
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
      if (path.records[k].kind != path::MoveKind::feed || path.records[k + 1].kind != path::MoveKind::feed) continue;
      auto records =
          std::vector<path::ClRecord>(path.records.begin() + long(k) - 1, path.records.begin() + long(k) + 2);
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
  bool push_in(path::ClRecord& record, double R) const {
    for (int round = 0; round < 4; ++round) {
      const Vec3 c = centre(record, R);
      const auto q = job_.part->nearest(c, R + 0.1);
      if (!(q.distance < R + 0.1) || q.distance <= 0) return false;
      const Vec3 foot =
          turned(q.foot, std::remainder(std::atan2(c.y(), c.x()) - std::atan2(q.point.y(), q.point.x()), 2 * kPi));
      if (std::abs((foot - c).norm() - q.distance) > 1e-5) return false;  // an edge: its foot is only near
      record.tip += (foot - c).normalized() * (q.distance - (R - 0.002));
    }
    return std::abs(R - 0.002 - job_.part->nearest(centre(record, R), R + 0.1).distance) < 1e-6;
  }
  [[nodiscard]] std::vector<path::ToolMotion> motions(const path::ClPath& path,
                                                      const std::vector<path::ClRecord>& records,
                                                      std::size_t line) const {
    path::ClPath piece = path;
    piece.records = records;
    auto m = analytic::GougeCheck::motions_of(piece);
    for (auto& one : m) one.line += int(line) - 1;
    return m;
  }
  const PlannedJob& job_;
  Random random_;
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
    for (int k = 0; k < 19; ++k) add(planter.moved(path::MoveKind::feed));
    for (int k = 0; k < 6; ++k) add(planter.moved(path::MoveKind::engage));
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
      SCOPED_TRACE(fmt::format("{} {}: truth {:.6f} measured {:.6f} bound {:.6f} on {} at line {}", name, fault.what,
                               truth.depth, r.measured_mm, r.bound_mm, r.deepest.patch, r.deepest.line));
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
  for (const char* what : {"moved feed", "moved engage", "dropped", "fillet", "root", " at an end"})
    EXPECT_GE(kinds[what], 4) << what;
}

TEST(PlantedGouges, InAWholeProgramTheDeepestComesFirst) {
  auto job = planned(small_spur(), {ball_mill(1, 6, 0.95, 16, 10)}, {finishing(0, 0.02, 0.002)});
  auto& records = job.plan.paths[0].records;
  Random random(5);
  const double R = 0.5;
  for (int round = 0; round < 5; ++round) {
    std::size_t k = 0;
    do k = 1 + random.index(records.size() - 2);
    while (records[k].kind != path::MoveKind::feed || records[k + 1].kind != path::MoveKind::feed);
    const auto saved = records[k];
    const auto q = job.part->nearest(centre(saved, R), R + 0.05);
    const Vec3 foot = q.foot;
    records[k].tip += (foot - q.point).normalized() * (q.distance - R + 0.005);
    const analytic::GougeCheck checker(*job.part, job.tools, job.check_options());
    const auto r = checker.check(analytic::GougeCheck::motions_of(job.plan.paths[0]), {0});
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

}  // namespace
}  // namespace toothpath::test
