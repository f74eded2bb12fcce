// The gears of a REXS file, one at a time, as parameters of a job's [gear].
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/rexs/quantities.h"
#include "app/rexs/rexs_file.h"
#include "geometry/base/refusal.h"
#include "geometry/cylindrical/parameters.h"
#include "geometry/inspection/grid.h"
#include "geometry/spiral_bevel/parameters.h"

namespace toothpath::rexs {

/// What REXS does not say, or what a file may leave out.
struct Said {
  std::optional<bool> left_is_concave = {};  ///< of a bevel gear whose flanks have a set-up each
  std::optional<bool> work_per_cradle = {};  ///< sense of ratio_of_roll; false: its reciprocal
  std::optional<double> dedendum_coefficient = {}, root_radius_coefficient = {};  ///< of a gear without its tool
};

/// A question that only somebody who knows the file can answer.
enum class Open { left_flank, ratio_of_roll };

struct GearOfFile {
  std::variant<cylindrical::CylindricalParameters, spiral_bevel::SpiralBevelParameters> gear;
  std::vector<std::string> left_out;  ///< components that change its flanks and were not taken over
};

/// What stands in the way: refusals with their places, and questions.
struct Obstacles {
  std::vector<Diagnostic> errors;
  std::vector<std::pair<Open, std::string>> questions;  ///< with why they are asked
};

/// Cylindrical and bevel gears of a file, in its order.
[[nodiscard]] std::vector<const Component*> gears_of(const RexsFile& file);

[[nodiscard]] Expected<GearOfFile, Obstacles> gear_of(const RexsFile& file, const Component& gear, const Said& said);

/// What of a gear has no place in a file, or stands there otherwise: told to whoever writes it.
struct Written {
  RexsFile file;
  std::vector<std::string> notes = {};
};
/// Gear, flanks, tools and settings of one gear, as gear_of() reads them back; a bevel gear with two cuts has its
/// concave flank as the left one. Refused, with the key within [gear]: what REXS has no components for.
[[nodiscard]] Expected<Written, Refusal> rexs_of(const cylindrical::CylindricalParameters& gear,
                                                 const std::string& name);
[[nodiscard]] Expected<Written, Refusal> rexs_of(const spiral_bevel::SpiralBevelParameters& gear,
                                                 const std::string& name);
/// Puts the points and normals of inspection.csv to the flanks, under names of our own ("custom_.."): the schema has
/// none for them.
void add_flank_grid(RexsFile& file, const std::vector<inspection::InspectionPoint>& points);

// Parts of it, a file each.
[[nodiscard]] cylindrical::CylindricalParameters cylindrical_of(const RexsFile& file, const Component& gear,
                                                                const Said& said, Refused& refused);
[[nodiscard]] spiral_bevel::SpiralBevelParameters spiral_bevel_of(const RexsFile& file, const Component& gear,
                                                                  const Said& said, Refused& refused,
                                                                  Obstacles& obstacles);

/// The last step in which a flank is made.
struct Step {
  const Component* tool = nullptr;
  const Component* settings = nullptr;
};
struct Flanks {
  const Component *left = nullptr, *right = nullptr;
};
/// Refused: a gear without them. Both are there, or neither.
[[nodiscard]] Flanks flanks_of(const RexsFile& file, const Component& gear, Refused& refused);
[[nodiscard]] Step step_of(const RexsFile& file, const Component& flank);

}  // namespace toothpath::rexs
