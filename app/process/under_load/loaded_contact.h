// A pair of gears under load, of any gear type: both flanks over a pitch, as CSV and JSON, and what is worth a word.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/job/job.h"
#include "geometry/loaded/friction.h"
#include "geometry/loaded/loaded_pair.h"
#include "geometry/loaded/root_stress.h"

namespace toothpath::under_load {

/// How a gear type calls what it loads.
struct PairWords {
  const char* gear = "gear";  ///< the one that is not the pinion
  const char* ring = "ring";  ///< one of two faces of opposite hand
  const char* rings = "rings";
  const char* columns = "r,z";
  const char* along = "radius from the gear's axis [mm]";
  /// Where the root of the gear is, along the face and in height, and that of the pinion; keys of contact.json.
  const char *gear_face = "radius", *gear_height = "z", *pinion_face = "section", *pinion_height = "radius";
};
inline constexpr PairWords kFaceWords{},
    kBevelWords{
        "wheel",  "half",          "halves", "cone_distance,height", "cone distance on the wheel [mm]", "cone_distance",
        "height", "cone_distance", "height"};

struct LoadedSide {
  int side = 1;         ///< flank of a face gear, sigma of a bevel wall
  std::string name;     ///< "flank +1, exact", "wall L", "wall L, measured"
  bool as_cut = false;  ///< with the deviation of the cut flank as gap
  loaded::LoadedCycle cycle;
  std::vector<loaded::Friction> friction = {};  ///< of every position, where the job asks for it
  std::optional<loaded::RootStress> root = {};  ///< where the job asks for it
};

struct LoadedContact {
  PairWords words;
  job::ContactLoad settings;
  double torque_gear_Nm = 0;
  bool floating = false;
  double segment_mm = 0;  ///< of lines; 0: there are none
  double rim_mm = 0, pinion_rim_mm = 0;
  double pinion_fillet_mm = 0;  ///< of face gears
  int rings = 1, pinion_teeth = 0;
  std::vector<LoadedSide> sides;  ///< +1, -1, each exact, then as cut
  std::vector<std::string> notes;
};

/// What `study dhfg` and the command ask of a cycle.
struct LoadedRange {
  double least = 0, most = 0, mean = 0;
};
[[nodiscard]] LoadedRange range_of(const loaded::LoadedCycle& cycle, double (*of)(const loaded::LoadedPosition&));
[[nodiscard]] double outer_share(const loaded::LoadedPosition& position);  ///< of the outermost ring, 0 to 1
/// On the pinion and on the gear along their axes, away from the mate, N; rounding of a balance is no force.
[[nodiscard]] double axial_of(const loaded::LoadedPosition& position);
[[nodiscard]] double gear_axial_of(const loaded::LoadedPosition& position);
[[nodiscard]] bool on_cells(const loaded::LoadedCycle& cycle);
/// Amplitude of the n-th harmonic of the transmission error over a pitch, rad.
[[nodiscard]] double harmonic(const loaded::LoadedCycle& cycle, int n);
/// As many as the positions resolve, three at most.
[[nodiscard]] int harmonics_of(const loaded::LoadedCycle& cycle);
[[nodiscard]] const char* word_of_axial(const LoadedContact& found);  ///< "floating", "spring", "held"

/// Load and support that the settings ask for. @param torque_Nm  of the gear that it counts on
[[nodiscard]] loaded::Load load_of(const LoadedContact& found, double torque_Nm);
/// Material and row of teeth of gear and pinion, and the rim of both. @param rim_mm  where the settings say none
[[nodiscard]] std::array<loaded::BodyPlan, 2> body_plans(const job::ContactLoad& load, double rim_mm);
[[nodiscard]] bool is_steel(const job::ContactLoad& load);
/// Adds a side, and what is worth a word about it. @param steel  lines of steel gears have a usual stiffness
void add_side(LoadedContact& found, LoadedSide side, bool steel);

[[nodiscard]] std::string loaded_csv(const LoadedContact& found);    ///< a line a position
[[nodiscard]] std::string pressure_csv(const LoadedContact& found);  ///< a line a segment
[[nodiscard]] nlohmann::ordered_json loaded_json(const LoadedContact& found);

}  // namespace toothpath::under_load
