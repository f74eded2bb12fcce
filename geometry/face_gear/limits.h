// Where a face gear flank ends: undercut, start of the involute, pointing, fillet line. Per zone and side.
#pragma once

#include <array>
#include <optional>

#include "geometry/face_gear/surface.h"

namespace toothpath::face_gear {

/// Limits of the flank of one side. Radii from the gear axis, heights z, mm.
struct FlankLimits {
  int side = 1;                           ///< +1 or -1
  std::optional<double> undercut_radius;  ///< R1c: cusp of the involute's end; none if there is no cusp on this side
  std::optional<double> undercut_height;  ///< z of that point
  std::optional<double> undercut_B;       ///< its flank parameter, rad
  std::optional<double>
      flank_start_radius;  ///< inside it the fillet reaches up to the tip surface and no involute is left
                           ///  (low teeth, many shaper teeth); none in ordinary gears
  std::optional<double>
      flank_end_radius;  ///< outside it the fillet reaches up to the tip surface again (low teeth, large
                         ///  rounding); none where the teeth are pointed first
  std::optional<double>
      involute_start_radius;  ///< R1b: theta = 0 on the tip surface; none if the tip is above the base circle
};

/// Limits of one zone.
struct ZoneLimits {
  std::array<FlankLimits, 2> flanks;      ///< side +1, then side -1
  std::optional<double> pointing_radius;  ///< R2: both flanks meet on the tip surface
  std::optional<double> land_radius;      ///< R2': top land of `practical_land_mm`
  double practical_land_mm = 0;           ///< the gear's least land, else 0.2 m
  double inner_limit = 0;  ///< R1 = the largest of the undercut and involute-start radii; M2 where there is none
  const char* inner_limit_name =
      "";  ///< which one governs: "undercut", "fillet up to the tip", "involute start" or "base cylinder"
  double hard_inner_limit = 0;  ///< the largest undercut or flank start radius (or M2): below it the zone is refused
};

/// Limits of the zone with this helix angle. Radii to 1e-9 mm.
/// Source: docs/face_gear.md 7.
[[nodiscard]] ZoneLimits zone_limits(const FaceGearSurface<double>& surface, double module_mm,
                                     std::optional<double> least_land_mm = {});

/// Arc thickness of a tooth on the tip surface at radius r: r (Theta_+ - Theta_-); negative beyond pointing.
/// Nothing where r lies at or inside M2 or the flank cannot be reached.
[[nodiscard]] std::optional<double> tip_thickness(const FaceGearSurface<double>& surface, double r);

/// Height of the fillet line (theta = theta_t) of a side at radius r on the regular sheet; none inside the undercut.
[[nodiscard]] std::optional<double> fillet_line_height(const FaceGearSurface<double>& surface, int side, double r);

/// Height z of the root surface at radius r (z = -r_a for a shaft angle of 90 deg); none for r <= |E|.
[[nodiscard]] std::optional<double> root_height(const FaceGearSurface<double>& surface, double r);

}  // namespace toothpath::face_gear
