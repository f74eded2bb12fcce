// Jobs with stout tools: a shank as thick as the tooth space is wide, short flutes, little stick-out under a wide
// holder. No fixed direction keeps them clear.
#pragma once

#include "cam/ball/finishing.h"
#include "geometry/face_gear/part.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/face_part.h"

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
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of({job.tool}));
  const auto plan = plan::plan_milling(part, {job.tool}, {finishing(0, job.scallop_mm, 0.002)}, {});
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

/// The passes of the job, as the planner lays them.
inline std::vector<ball::BallPass> stout_passes(const StoutJob& job, const analytic::GearDistance& part) {
  const double R = job.tool.radius_mm();
  const auto& ring = test::sheet_of(part.space(0)).ring().zone;
  const tooth_space::OffsetSheet sheet(part.space(0), R, ring.inner_radius_mm - R - 0.1, ring.outer_radius_mm + R + 0.1,
                                       33);
  ball::FinishingOptions options;
  options.ball_radius_mm = R;
  for (const path::Region region : path::kRegions) options.scallop_mm[region] = job.scallop_mm;
  options.chord_mm = 0.0008;
  options.run_out_mm = 0.5 * R;
  auto planned = ball::plan_finishing(sheet, options);
  if (!planned) throw std::runtime_error(planned.error().message);
  return planned->passes;
}

/// Is a place of the body's lower face or side within `clearance` of the solid, or inside of it? Asked of the exact
/// distance to the part at places 0.15 mm apart: independent of the planner's trees.
inline bool body_is_in_the_way(const analytic::GearDistance& part, const tool::Frustum& f, const Vec3& tip,
                               const Vec3& axis, double clearance) {
  constexpr double kApart = 0.15;
  const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
  const double top = part.part().blank_top() + clearance;
  double lowest = INFINITY;
  const auto ring = [&](double h, double rho) {
    const int around = std::max(12, int(2 * kPi * rho / kApart));
    lowest = INFINITY;
    for (int k = 0; k < around; ++k) {
      const double a = 2 * kPi * k / around;
      const Vec3 p = tip + h * axis + rho * (std::cos(a) * x + std::sin(a) * y);
      lowest = std::min(lowest, p.z());
      if (p.z() <= top && part.nearest(p, clearance + 0.01).distance < clearance) return true;
    }
    return false;
  };
  for (double h = f.from; h <= f.to; h += kApart) {
    if (ring(h, f.radius_from + (h - f.from) / (f.to - f.from) * (f.radius_to - f.radius_from))) return true;
    if (lowest > top) break;
  }
  for (double rho = f.radius_from;
       rho > 0 && tool::lowest_z(tool::Frustum{f.from, f.from, rho, rho, f.body}, tip, axis) <= top; rho -= kApart)
    if (ring(f.from, rho)) return true;
  return false;
}

/// Does the flute, a cylinder above the ball, reach into the solid?
inline bool flute_is_in_the_way(const analytic::GearDistance& part, const tool::ToolAssembly& tool, const Vec3& centre,
                                const Vec3& axis) {
  const double R = tool.radius_mm();
  for (double h = 0.3 * R; h <= tool.flute_length_mm - R; h += 0.2 * R)
    if (part.nearest(centre + h * axis, R + 0.01).distance < R) return true;
  return false;
}

/// The tools that a refusal says would do.
inline std::vector<tool::ToolAssembly> advised_tools(const StoutJob& job, const std::string& words) {
  std::vector<tool::ToolAssembly> out;
  const auto from = words.find("planned as a trial: ");
  const auto number = [&](const std::string& word) -> std::optional<double> {
    const auto at = from == std::string::npos ? from : words.find(word, from);
    if (at == std::string::npos) return {};
    return std::stod(words.substr(at + word.size()));
  };
  if (const auto flute = number("a flute of ")) {
    out.push_back(job.tool);
    const double more = *flute - job.tool.flute_length_mm;
    out.back().flute_length_mm = *flute;
    out.back().stick_out_mm += more;
    out.back().length_mm += more;
  }
  if (const auto stick_out = number("a stick-out of ")) {
    out.push_back(job.tool);
    out.back().length_mm += *stick_out - job.tool.stick_out_mm;
    out.back().stick_out_mm = *stick_out;
  }
  if (const auto shank = number("a shank of ")) {
    out.push_back(job.tool);
    out.back().shank_diameter_mm = *shank;
  }
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
