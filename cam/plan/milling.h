// Plans every operation of a milling job for one tooth space, in the order of the job: each with the planner that its
// type asks for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cam/ball/plan.h"
#include "cam/line/plan.h"
#include "cam/plan/chip_feed.h"

namespace toothpath::plan {

/// Limits and stages hold for every planner.
struct Options : ball::PlanOptions {
  double line_bias_mm = line::kBias;  ///< least gap of line poses: coarser axes ask for more
  int simultaneous_axes = 5;          ///< that the control interpolates in a block: X, Y, Z and the rotaries that turn
};

/// What the flanks of a line-milled operation take by the side of its mill and by its ball end, and which was taken.
struct FlankChoice {
  int operation = 0;
  bool by_ball = false;               ///< where the job leaves it open
  std::vector<line::FlankWays> ways;  ///< of all flanks
  std::string refused;                ///< why the way that was not taken cannot be; empty: it is the slower one
};

struct MillingPlan {
  std::vector<path::ClPath> paths;                   ///< one an operation
  std::vector<ball::OperationPlan> operations;       ///< the same
  std::vector<std::optional<line::LinePlan>> lines;  ///< of line milling, without its path; nothing for the others
  std::vector<proof::DirectionChoice> directions;
  std::vector<FlankChoice> choices;         ///< of line milling
  std::vector<EngagementTrack> engagement;  ///< of roughing that has a `chip_load` or a `max_engagement`
};

using Progress = std::function<void(const std::string&)>;

/// Refused: what the planner of an operation refuses, with the key of the job that it belongs to.
[[nodiscard]] Expected<MillingPlan, ball::PlanRefusal> plan_milling(
    const analytic::GearDistance& part, const std::vector<tool::ToolAssembly>& tools,
    const std::vector<path::MillingOperation>& operations, const Options& options, const Progress& progress = {});

}  // namespace toothpath::plan
