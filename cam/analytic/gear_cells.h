// What of the cells of a tooth space stands for material: facets cut off at the tip surface and at the ends of the
// ring, and the end faces below the profile. For bodies (shank, holder), whose gap is asked to a few thousandths of a
// millimetre.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::analytic {

/// A corner of a flat polygon, with the parameters of its place on a patch. `stands`: it is a place of the ring's
/// surface.
struct FacetCorner {
  Vec3 p = Vec3::Zero();
  Vec2 at = Vec2::Zero();
  bool stands = true;
};
/// A flat convex polygon that was a triangle and has been cut off at most three times.
struct Facet {
  std::array<FacetCorner, 6> corner;
  std::size_t count = 0;
  void add(const FacetCorner& c) { corner[count++] = c; }
};

/// Does a place lie between the two ends of the ring and not above its tip surface?
[[nodiscard]] bool on_ring(const tooth_space::ToothSpace& space, const Vec3& p, double slack_mm = 0);

/// The part of a triangle (gear frame, mm) that may stand for material of the ring: every point of the surface between
/// the two ends and below the tip surface that lies within `sag_mm` of the triangle lies within `sag_mm` of what is
/// returned. Nothing else is kept beyond the ends or above the tip, but for `sag_mm` and what a plane lacks of a
/// round surface over one facet.
[[nodiscard]] Facet on_ring(const tooth_space::ToothSpace& space, const Facet& triangle, double sag_mm);

/// Which end of the ring.
struct EndFace {
  tooth_space::Chart chart;
  double s_mm = 0;
  bool outer = false;
  double tip_mm = 0;           ///< height of the tip surface there
  double from = 0, pitch = 0;  ///< the face is covered over the azimuths [from, from + pitch], rad
  double base_mm = 0;          ///< lower border
};

/// The upper border of an end face over one pitch: from the middle of a land, along the profile of the tooth space
/// (azimuth, h), from tip to tip, to the middle of the next land.
[[nodiscard]] std::vector<Vec2> end_border(const EndFace& face, const std::vector<Vec2>& profile);

/// A flat quad of an end face. `from`, `to`: places on its border, by index and share; `low`, `high`: shares of the
/// height.
struct EndQuad {
  std::array<Vec3, 4> corner;  ///< low, low, high, high
  double from = 0, to = 0, low = 0, high = 0;
};

/// Flat quads that cover an end face from its base up to its border. No quad lies inside the material, and none stands
/// out of the face by more than a few 1e-4 mm.
[[nodiscard]] std::vector<EndQuad> end_face_quads(const EndFace& face, const std::vector<Vec2>& profile);

/// How far a stretch of a border leaves the straight line between its ends: upwards, downwards, and to both sides.
struct BorderStretch {
  Vec2 from = Vec2::Zero(), to = Vec2::Zero();
  double above = 0, below = 0, least_azimuth = 0, most_azimuth = 0;
};
[[nodiscard]] BorderStretch border_stretch(const std::vector<Vec2>& border, double from, double to);
/// The place of a border at index and share.
[[nodiscard]] Vec2 border_place(const std::vector<Vec2>& border, double at);

}  // namespace toothpath::analytic
