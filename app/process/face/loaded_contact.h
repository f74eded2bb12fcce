// A job's gear and its pinion under load: both flanks over a pitch, as tables, charts, CSV and JSON.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/gear_of_job.h"
#include "app/process/opening_and_end.h"
#include "app/report/page/report_page.h"
#include "geometry/contact/tooth_contact.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::face {

struct LoadedSide {
  int side = 1;
  bool as_cut = false;  ///< with the deviation of the cut flank as gap
  loaded::LoadedCycle cycle;
};

struct LoadedContact {
  job::ContactLoad settings;
  double torque_gear_Nm = 0;
  bool floating = false;
  double segment_mm = 0, rim_mm = 0, pitch_radius_mm = 0;
  int rings = 1, pinion_teeth = 0;
  std::vector<LoadedSide> sides;  ///< +1, -1, each exact, then as cut
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

/// @param exact  the flanks of the drawing: what modifications take off them and off the pinion, mean over each piece
/// of a line, is its gap
/// @param cut    flanks as they were cut, beside them; their deviation counts in the same way. Refused, where the key
/// stands: a rim that does not fit, a pinion that floats on one ring, a position
/// where nothing touches.
[[nodiscard]] process::ValueOrErrors<LoadedContact> analyse_loaded(
    const job::Job& job, const face_gear::FaceGear& gear, const job::ContactSettings& settings, int pinion_teeth,
    const std::vector<const contact::ContactMember*>& exact, const std::vector<const contact::ContactFlank*>& cut);

/// Decks of CalculiX at the first position, the gear turned by the mean approach. Refused: as analyse_loaded.
[[nodiscard]] process::ValueOrErrors<process::NamedFiles> loaded_decks(const job::Job& job,
                                                                       const face_gear::FaceGear& gear,
                                                                       const LoadedContact& found);

[[nodiscard]] std::string loaded_csv(const LoadedContact& found);    ///< a line a position
[[nodiscard]] std::string pressure_csv(const LoadedContact& found);  ///< a line a segment
[[nodiscard]] nlohmann::ordered_json loaded_json(const LoadedContact& found);
[[nodiscard]] std::string loaded_summary(const LoadedContact& found);
[[nodiscard]] page::PageTable loaded_table(const LoadedContact& found);
[[nodiscard]] std::vector<svg::LineChart> loaded_charts(const LoadedContact& found);

}  // namespace toothpath::face
