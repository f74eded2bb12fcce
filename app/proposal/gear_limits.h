// The limits of the gear while it is chosen: where its teeth end, and which mills reach all of it.
#pragma once

#include <memory>
#include <string>

#include "app/proposal/wishes.h"
#include "geometry/bevel_gear/parameters.h"
#include "geometry/cylindrical/gear.h"
#include "geometry/face_gear/gear.h"
#include "geometry/flank_grid/gear.h"
#include "geometry/spiral_bevel/basic_settings.h"
#include "geometry/spiral_bevel/gear.h"
#include "geometry/straight_bevel/gear.h"

namespace toothpath::proposal {

/// Radii between which teeth can stand, mm.
struct FaceRange {
  double inner = 0;        ///< undercut, or where the involute begins
  double outer = 0;        ///< the top land is a fifth of a module
  double pointing = 0;     ///< the teeth are pointed; 0: they are not
  const char* inner_name;  ///< which limit governs
};

/// Parameters of a face gear without its ends. Precondition: every number of the gear but those is known.
[[nodiscard]] face_gear::FaceGearParameters face_parameters(const Wishes& wishes);
/// The same with its ends; a double helical gear has a groove in its middle.
[[nodiscard]] face_gear::FaceGearParameters whole_face_parameters(const Wishes& wishes);
[[nodiscard]] bevel_gear::BevelGearParameters bevel_parameters(const Wishes& wishes);
/// Those of a file, or one zone about z = 0.
[[nodiscard]] cylindrical::CylindricalParameters cylindrical_parameters(const Wishes& wishes);

/// What a drawing says of a spiral bevel gear, as far as it is known; shafts at 90 deg where nothing is said.
[[nodiscard]] spiral_bevel::Drawing drawing_of(const Wishes& wishes);
/// Of the settings of a file, or of a drawing with the largest rounding of the blades that makes a gear. Refused, with
/// keys of a job: what makes none; of a drawing with the least spiral angle that does.
[[nodiscard]] Expected<spiral_bevel::SpiralBevelGear, std::vector<Refusal>> spiral_bevel_gear(const Wishes& wishes);

/// Gleason proportions for shafts at 90 deg, the largest rounding up to 0.3 modules that the crown gear's teeth carry.
[[nodiscard]] straight_bevel::StraightBevelParameters straight_bevel_parameters(const Wishes& wishes);

/// Nothing: no tooth has room, or numbers are missing.
[[nodiscard]] std::optional<FaceRange> face_range(const Wishes& wishes);

/// Of a gear that ball mills can make, mm.
struct FaceFacts {
  double depth = 0;         ///< of the tooth spaces, the deepest
  double largest_ball = 0;  ///< diameter of the largest ball that reaches all; 0: none, the fillet is sharp
  double first_ball = 0;    ///< diameter of the largest first roughing ball

  /// Widest mill that is taken to finish, and to rough first.
  [[nodiscard]] double most_finishing_mm() const { return 0.97 * largest_ball; }
  [[nodiscard]] double most_roughing_mm() const { return 0.95 * first_ball; }
};
[[nodiscard]] FaceFacts facts_of(std::shared_ptr<const tooth_space::ToothedPart> gear, double depth_mm);

}  // namespace toothpath::proposal
