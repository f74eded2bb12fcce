// The lines along which a face gear touches the pinion that is its shaper, in closed form, and their segments.
//
// For a gear turn phi the line of tooth 0 is theta(B): linear, as phi is linear in theta. Housing frame; mm, rad.
// Derivation: docs/loaded_contact.md 2.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/contact/pinion.h"

namespace toothpath::loaded {

/// theta of the place with this B at which tooth 0 touches while the shaper stands at phi.
template <typename S>
S line_theta(const face_gear::FaceGearSurface<S>& f, int side, const S& B, const S& phi) {
  const S s(side), Z_0 = f.flank_Z(side, S(0), B), cos_bb = f.shaper.cos_bb;
  return s * cos_bb * cos_bb * (B - s * f.shaper.theta_0 - f.shaper.kappa * (Z_0 - f.L0) - phi);
}

/// Relative curvature of flank and pinion in the tangent basis (e, l) of the flank; of rank one along a contact line.
template <typename S>
typename face_gear::FaceGearSurface<S>::ShapeOperator relative_curvature(const face_gear::FaceGearSurface<S>& f,
                                                                         int side, const S& theta, const S& B) {
  auto H = f.flank_shape(side, theta, B);
  H.ee += f.shaper.cos_bb / (f.shaper.r_b * theta);
  return H;
}

/// The part of a flank and of its pinion that can touch.
struct ContactBounds {
  double inner_mm = 0, outer_mm = 0;  ///< radii of the gear's ring
  double least_theta = 0;             ///< where the pinion's involute starts; > 0
  double least_B = 0, most_B = 0;     ///< that hold the whole flank of the side
  double least_Z = 0, most_Z = 0;     ///< sections of the pinion that it can touch
};

/// What modifications take off both flanks at a place of the plain ones, housing, mm along the normals; empty: nothing.
using Removal = std::function<double(const Vec3&)>;

/// A place where a flank can press, with the strip around it.
struct Segment {
  int ring = 0, tooth = 0;  ///< tooth that stands where tooth 0 stands `tooth` pitches later
  double theta = 0, B = 0;
  Vec3 point = Vec3::Zero(), normal = Vec3::Zero(), along = Vec3::Zero();  ///< housing; normal out of the gear
  double length = 0;
  double curvature = 0;  ///< relative, across the line, 1/mm
  double gap = 0;        ///< of the unloaded flanks, mm; mean over the piece
  double beyond = 0;     ///< > 0: the centre lies off the flank, the nearest material is so far away
  bool at_end = false;   ///< first or last segment on the flank
  bool on_edge = false;  ///< on an edge of one flank, over the other: gap and normal are those of the other flank
  Vec3 nearest = Vec3::Zero();  ///< the point itself; beyond the ends the nearest material, housing
  /// Of `nearest`: radius about the gear's axis and height along it; section and radius of the pinion. Of a bevel pair
  /// cone distance and height over the pitch cone, of the wheel and of the pinion.
  double r = 0, z = 0, Z = 0, R = 0;
};

/// The line of one tooth. Of a tooth whose line misses its flank: the edge where its flanks come nearest.
struct ContactLine {
  int tooth = 0;
  double length = 0;  ///< on the flank, mm; 0: an edge alone
  double from_B = 0, to_B = 0;
  double least_gap = 0;           ///< of the unloaded flanks along the line, mm; 0 where the pinion is the shaper
  std::vector<Segment> segments;  ///< those on the flank, in the order of B; then those beyond its ends, on edges
};

/// Which edges are listed.
struct EdgeOptions {
  double gap_mm = -std::numeric_limits<double>::infinity();  ///< up to this gap
  const contact::Pinion<double>* pinion = nullptr;           ///< as it stands; null: no edges
  /// What else stands between the flanks, mm; null or empty: nothing.
  const std::function<double(const Segment&)>* more = nullptr;
};

struct LineOptions {
  double segment_mm = 1.5;
  /// Of the loaded flanks, about: 0 lists no segment beyond the ends. So far off the material segments still are
  /// listed, at curvature k: sqrt(2 approach/k) + half_width.
  double approach_mm = 0;
  double half_width_mm = 0;  ///< of the pressed strip, about
  /// A pinion that touches in a point, or stands off its place: the line is then the valley of least gap, a place for
  /// every B, and segments carry that gap. Null: the pinion is the shaper, the gap 0.
  const contact::Pinion<double>* pinion = nullptr;
  /// What is taken off the flanks; null: nothing. With a pinion: the valley is that of the modified flanks.
  const Removal* removal = nullptr;
  EdgeOptions edges;
};

/// Lines of all teeth that touch while the shaper stands at phi, by their numbers; those shorter than 0.2 mm count as
/// none. Their edges, where a line ends with its surface, go on to the gap that is asked for.
[[nodiscard]] std::vector<ContactLine> contact_lines(const face_gear::FaceGearSurface<double>& f, int ring, int side,
                                                     double phi, const ContactBounds& bounds,
                                                     const LineOptions& options);
/// Every other tooth that comes near, with its edge: one that is just leaving the mesh, or just coming, stands with an
/// edge of one flank over the other. @param options  with a pinion for edges; lines: those of the same position
[[nodiscard]] std::vector<ContactLine> edges_near(const face_gear::FaceGearSurface<double>& f, int ring, int side,
                                                  double phi, const ContactBounds& bounds, const LineOptions& options,
                                                  const std::vector<ContactLine>& lines);

/// What of a flank can touch. @param least_theta as in ContactBounds
/// Refused: an undercut flank.
[[nodiscard]] Result<ContactBounds> contact_bounds(const face_gear::FaceGearSurface<double>& f, int side,
                                                   double inner_mm, double outer_mm, double least_theta);

}  // namespace toothpath::loaded
