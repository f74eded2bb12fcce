// Jobs with stout tools: a shank as thick as the tooth space is wide, short flutes, little stick-out under a wide
// holder. No fixed direction keeps them clear.
#pragma once

#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath::test {

struct StoutJob {
  const char* gear;
  tool::ToolAssembly tool;
  double scallop_mm;
};

inline face_gear::FaceGearParameters stout_gear(const std::string& name) {
  if (name == "short") return steep_gear(105, 77.5, 85.5);  // samples/short_tool.toml
  if (name == "acute") return steep_gear(70, 80, 84);
  if (name == "axis") {  // samples/tool_axis.toml
    auto g = small_spur();
    g.zones = {{0, 60, 63}};
    return g;
  }
  if (name == "offset") {  // samples/offset_milled.toml, a narrower ring
    auto g = offset_gear();
    g.zones = {{0, 134, 140}};
    return g;
  }
  if (name == "dhfg") {  // samples/dhfg_ball.toml, its outer half
    auto g = quarter_dhfg();
    g.zones = {g.zones[1]};
    return g;
  }
  return gear_named(name);
}

/// Random tools, each in proportion to its gear.
inline StoutJob random_stout_job(Random& random) {
  static constexpr const char* kGears[] = {"short", "acute", "axis", "offset", "dhfg", "conical"};
  static constexpr double kBalls[] = {2, 1.6, 1, 1.6, 0.5, 0.7};
  const std::size_t k = random.index(6);
  const auto gear = made(stout_gear(kGears[k]));
  const double m = gear.parameters().module_mm, depth = 2.25 * m;
  StoutJob job{kGears[k], {}, 0};
  const double ball = kBalls[k] * random(0.7, 1.1);
  const double flute = depth * random(0.35, 0.7), shank = std::max(1.1 * ball, m * random(0.8, 1.7)),
               stick_out = depth * random(1.02, 1.5), holder = random(20, 50);
  job.tool = ball_mill(ball, std::max(flute, 0.6 * ball), shank, stick_out, holder);
  job.tool.holder = {{holder, holder, 40}};
  job.scallop_mm = 0.06 * ball;
  return job;
}

struct StoutOutcome {
  bool planned = false, proven = false, fixed = false;
  std::string words;
  double least_tilt_rad = INFINITY;  ///< of axes that turn in a block that cuts, hops too, from the gear axis
};

/// Least angle between the gear axis and the great circles of blocks that are no rapids and in which the axis turns.
inline double least_turning_tilt(const path::ClPath& path) {
  double least = INFINITY;
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const auto &a = path.records[k - 1], &b = path.records[k];
    if (b.kind == path::MoveKind::rapid || a.axis == b.axis) continue;
    for (int n = 0; n <= 20; ++n) {
      const Vec3 u = ((1 - n * 0.05) * a.axis + n * 0.05 * b.axis).normalized();
      least = std::min(least, std::atan2(std::hypot(u.x(), u.y()), u.z()));
    }
  }
  return least;
}

inline StoutOutcome plan_stout(const StoutJob& job) {
  StoutOutcome out;
  const face_gear::FaceGear gear = made(stout_gear(job.gear));
  const analytic::GearDistance part(gear, ball::reach_of({job.tool}));
  const auto plan = plan::plan_face_gear(part, {job.tool}, {finishing(0, job.scallop_mm, 0.002)}, {});
  if (const auto* refusal = plan.refused()) {
    out.words = refusal->diagnostic.message;
    return out;
  }
  out.planned = true;
  const auto& planned = plan.value();
  out.fixed = planned.directions.front().fixed;
  out.words = planned.directions.front().explanation;
  const auto& path = planned.paths.front();
  out.least_tilt_rad = least_turning_tilt(path);
  analytic::GougeCheckOptions options;
  options.rapid_height_mm = gear.blank_top();
  const analytic::GougeCheck check(part, {job.tool}, options);
  const auto result = check.check(analytic::GougeCheck::motions_of(path), {0});
  out.proven = check.passes(result);
  if (!out.proven)
    out.words += fmt::format("; gouge {:.5f} mm, clearance {:.4f} mm", result.bound_mm, result.clearance_mm);
  if (out.least_tilt_rad < INFINITY)
    out.words += fmt::format("; turns at {:.2f} deg of the gear axis", degrees(out.least_tilt_rad));
  return out;
}

/// Sixty random ones; for most of them a fixed direction does.
inline std::vector<StoutJob> random_stout_jobs() {
  Random random(14);
  std::vector<StoutJob> jobs;
  for (int k = 0; k < 60; ++k) jobs.push_back(random_stout_job(random));
  return jobs;
}

/// The first fourteen of them that no fixed direction clears.
inline std::vector<StoutJob> stout_jobs() {
  const auto all = random_stout_jobs();
  std::vector<StoutJob> jobs;
  for (const int k : {1, 3, 4, 5, 6, 7, 11, 12, 16, 17, 18, 19, 20, 21}) jobs.push_back(all[std::size_t(k - 1)]);
  return jobs;
}

}  // namespace toothpath::test
