// Everything that the commands want of a gear that stands on its tooth spaces alone: what a gear type adds are its
// numbers and words.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/process/gear_process.h"
#include "app/process/milled/body.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::milled {

/// A gear type as the commands see it.
struct ToothedGear {
  std::shared_ptr<const tooth_space::ToothedPart> part;
  tooth_space::ToothedSolid solid;  ///< its spaces live as long as `owner`
  std::shared_ptr<const void> owner;
  process::PartFacts facts;
  GearBody body;
  sheet::PartOutline outline;
  std::string subtitle;  ///< of the page, without the machine
  std::function<std::string()> limits_json;
  std::vector<svg::LineChart> limit_charts;  ///< one a zone
};

/// The job must outlive it.
[[nodiscard]] std::unique_ptr<process::GearProcess> toothed_process(const job::Job& job, ToothedGear gear);

}  // namespace toothpath::milled
