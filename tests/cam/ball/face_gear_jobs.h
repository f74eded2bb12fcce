// Gears, tools and planned programs that the tests of cam speak of.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "cam/analytic/gouge_check.h"
#include "cam/plan/milling.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/part.h"
#include "tests/support/face_part.h"
#include "tests/support/random.h"
#include "tests/support/sample_gears.h"
#include "tests/support/sample_tools.h"

namespace toothpath::test {

inline const std::vector<std::string>& gear_names() {
  static const std::vector<std::string> names = {"dhfg", "offset", "spur", "conical"};
  return names;
}
inline face_gear::FaceGearParameters gear_named(const std::string& name) {
  return name == "dhfg"     ? quarter_dhfg()
         : name == "offset" ? offset_gear()
         : name == "spur"   ? small_spur()
                            : conical_gear();
}

inline path::MillingOperation roughing(int tool, double step_down, double step_over, double allowance) {
  path::MillingOperation o;
  o.type = path::OperationType::roughing;
  o.tool = tool;
  o.speed_rpm = 18000;
  o.feed_mm_min = 500;
  o.step_down_mm = step_down;
  o.step_over_mm = step_over;
  o.allowance_mm = allowance;
  return o;
}
inline path::MillingOperation finishing(int tool, double scallop, double chord, double allowance = 0) {
  path::MillingOperation o;
  o.type = allowance > 0 ? path::OperationType::semi_finishing : path::OperationType::finishing;
  o.tool = tool;
  o.speed_rpm = 20000;
  o.feed_mm_min = 300;
  o.scallop_mm = scallop;
  if (chord > 0) o.chord_tolerance_mm = chord;
  o.allowance_mm = allowance;
  return o;
}

/// The number after a word of a message.
inline double number_after(const std::string& text, const std::string& word) {
  const auto at = text.find(word);
  return at == std::string::npos ? NAN : std::stod(text.substr(at + word.size()));
}

/// A gear with its distance query and one planned job.
struct PlannedJob {
  face_gear::FaceGear gear;
  std::vector<tool::ToolAssembly> tools;
  std::vector<path::MillingOperation> operations;
  std::unique_ptr<analytic::GearDistance> part;
  plan::MillingPlan plan;

  [[nodiscard]] std::vector<path::ToolMotion> motions() const {
    std::vector<path::ToolMotion> all;
    for (const auto& p : plan.paths) {
      const auto m = analytic::GougeCheck::motions_of(p);
      all.insert(all.end(), m.begin(), m.end());
    }
    return all;
  }
  [[nodiscard]] std::vector<int> tool_of_operation() const {
    std::vector<int> out;
    for (const auto& o : operations) out.push_back(o.tool);
    return out;
  }
  [[nodiscard]] analytic::GougeCheckOptions check_options() const {
    analytic::GougeCheckOptions o;
    o.rapid_height_mm = gear.blank_top();
    return o;
  }
  [[nodiscard]] const tool::ToolAssembly& tool(int operation) const {
    return tools[std::size_t(operations[std::size_t(operation)].tool)];
  }
};

inline PlannedJob planned(const face_gear::FaceGearParameters& p, std::vector<tool::ToolAssembly> tools,
                          std::vector<path::MillingOperation> operations) {
  PlannedJob job{made(p), std::move(tools), std::move(operations), nullptr, {}};
  job.part = std::make_unique<analytic::GearDistance>(face_gear::part_of(job.gear), ball::reach_of(job.tools));
  auto plan = plan::plan_milling(*job.part, job.tools, job.operations, {});
  if (auto* refusal = plan.refused()) throw std::runtime_error(refusal->key + ": " + refusal->diagnostic.message);
  job.plan = std::move(plan).value();
  return job;
}

/// Planned once a program: "dhfg" (all four operations), "offset", "spur", "conical" (finishing), "double" (a narrow
/// double helical gear, finishing), and "spur wide": a ball larger than the fillet.
inline const PlannedJob& job_named(const std::string& name) {
  static std::map<std::string, PlannedJob> jobs;
  const auto it = jobs.find(name);
  if (it != jobs.end()) return it->second;
  const auto make = [&]() -> PlannedJob {
    if (name == "dhfg")
      return planned(quarter_dhfg(), {ball_mill(1, 3.5, 0.95, 16, 10), ball_mill(0.5, 3.2, 0.46, 14, 10)},
                     {roughing(0, 0.25, 0.4, 0.08), roughing(1, 0.12, 0.2, 0.05), finishing(1, 0.008, 0, 0.02),
                      finishing(1, 0.002, 7e-4)});
    if (name == "double") {
      auto gear = quarter_dhfg();
      gear.zones[0].inner_radius_mm = 114;
      gear.zones[1].outer_radius_mm = 121.5;
      return planned(gear, {ball_mill(0.5, 3.2, 0.46, 14, 10)}, {finishing(0, 0.01, 0.002)});
    }
    if (name == "offset") return planned(offset_gear(), {ball_mill(1.6, 8, 1.5, 14, 10)}, {finishing(0, 0.003, 0.001)});
    if (name == "conical")
      return planned(conical_gear(), {ball_mill(0.7, 6, 0.65, 14, 10)}, {finishing(0, 0.004, 0.001)});
    if (name == "spur wide")
      return planned(small_spur(), {ball_mill(1.6, 6, 1.5, 16, 10)},
                     {roughing(0, 0.8, 0.5, 0.1), finishing(0, 0.02, 0.002)});
    return planned(small_spur(), {ball_mill(1, 6, 0.95, 16, 10)},
                   {roughing(0, 0.8, 0.5, 0.1), finishing(0, 0.02, 0.004, 0.05), finishing(0, 0.01, 0.002)});
  };
  return jobs.emplace(name, make()).first->second;
}

}  // namespace toothpath::test
