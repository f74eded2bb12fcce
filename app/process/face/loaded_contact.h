// A job's gear and its pinion under load: both flanks over a pitch, as tables, charts, CSV and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/gear_of_job.h"
#include "app/report/page/report_page.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::face {

struct LoadedSide {
  int side = 1;
  loaded::LoadedCycle cycle;
};

struct LoadedContact {
  job::ContactLoad settings;
  double torque_gear_Nm = 0;
  bool floating = false;
  double segment_mm = 0, rim_mm = 0, pitch_radius_mm = 0;
  int rings = 1;
  std::vector<LoadedSide> sides;  ///< +1, -1
  std::vector<std::string> notes;
};

/// What `study dhfg` and the command ask of a cycle.
struct LoadedRange {
  double least = 0, most = 0, mean = 0;
};
[[nodiscard]] LoadedRange range_of(const loaded::LoadedCycle& cycle, double (*of)(const loaded::LoadedPosition&));

/// Options of the pair for a gear of this module. Refused: a rim that does not fit the gear.
[[nodiscard]] Result<loaded::PairOptions> pair_options(const job::ContactLoad& load, const face_gear::FaceGear& gear,
                                                       const contact::Misalignment& moved);

/// Refused, where the key stands: a pinion of other teeth than the shaper's, a rim that does not fit, a pinion that
/// floats on one ring, a position where nothing touches.
[[nodiscard]] process::ValueOrErrors<LoadedContact> analyse_loaded(const job::Job& job,
                                                                   const face_gear::FaceGear& gear,
                                                                   const job::ContactSettings& settings,
                                                                   int pinion_teeth);

[[nodiscard]] std::string loaded_csv(const LoadedContact& found);    ///< a line a position
[[nodiscard]] std::string pressure_csv(const LoadedContact& found);  ///< a line a segment
[[nodiscard]] nlohmann::ordered_json loaded_json(const LoadedContact& found);
[[nodiscard]] std::string loaded_summary(const LoadedContact& found);
[[nodiscard]] page::PageTable loaded_table(const LoadedContact& found);
[[nodiscard]] std::vector<svg::LineChart> loaded_charts(const LoadedContact& found);

}  // namespace toothpath::face
