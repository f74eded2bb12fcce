// What of the cells of a tooth space stands for material: facets cut off at the tip surface and at the ends of the ring, and the end
// faces below the profile. For bodies (shank, holder), whose gap is asked to a few thousandths of a millimetre.
#pragma once

#include <array>
#include <vector>

#include "geometry/space_sheet.h"

namespace toothpath {

/// The part of a flat convex polygon (gear frame, mm) that may stand for material of the ring: every point of the surface between the
/// two radii and below the tip surface that lies within `sag_mm` of the polygon lies within `sag_mm` of what is returned. Nothing
/// else is kept beyond the ends or above the tip, but for `sag_mm` and what a plane lacks of a cylinder over one facet.
[[nodiscard]] std::vector<Vec3> on_ring(const SpaceSheet& space, std::vector<Vec3> polygon, double sag_mm);

/// Which end of the ring.
struct EndFace {
  double radius_mm = 0;
  bool outer = false;
  double z_tip_mm = 0;         ///< height of the tip surface there
  double from = 0, pitch = 0;  ///< the face is covered over the azimuths [from, from + pitch], rad
  double base_mm = 0;          ///< lower border
};

/// Flat quads (corners: low, low, high, high) that cover an end face from its base up to the profile of the tooth space and the tip
/// surface. The profile is a polygon of (azimuth, z) from tip to tip. No quad lies inside the material, and none stands out of the
/// face by more than a few 1e-4 mm.
[[nodiscard]] std::vector<std::array<Vec3, 4>> end_face_quads(const EndFace& face, const std::vector<Vec2>& profile);

}  // namespace toothpath
