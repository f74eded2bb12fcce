// Shank and holder along their motions: the least gap to the part that was found, and the gap that is proven for every moment
// between the blocks.
//
// The signed distance to a convex body is a convex function. Seen from the tool, a flat facet of the part that moves past is
// the hull of its corners at both ends of the motion, up to the arc of an axis that turns; a tangent plane of the distance at
// any point of the hull therefore bounds the gap of the whole facet over the whole motion. Facets and motions are halved until
// the bound is close to what was found. The sag of facets is subtracted from the bound; what is found near contact is
// measured on the analytic patches themselves.
#pragma once

#include "cam/tool_body.h"
#include "cam/tool_motion.h"

namespace toothpath {

/// Signed distance from a point to the boundary of a solid frustum about the z axis of T (tip at the origin), negative inside.
/// The axis is no boundary. Convex in the point where both radii are positive.
[[nodiscard]] double frustum_distance(const Vec3& point_T, const Frustum& body);

struct SweptGap {
  double proven_mm = 0;    ///< no place of the motion comes nearer; negative: a cut
  double measured_mm = 0;  ///< least gap found
  int zone = 0;
  const char* patch = "tooth";
  Vec3 place = Vec3::Zero();  ///< where, turned to tooth space 0
};

struct SweptGapOptions {
  double enough_mm = 0.5;         ///< gaps above this are returned as this
  double contact_mm = 0;          ///< below this the least gap is measured on the analytic patches ...
  double contact_proof_mm = 2e-4; ///< ... and the bound of the facets (without their sag) lies within this of it
  double proof_mm = 0.01;         ///< else: how far the bound may lie below what was found
};

/// Least gap of one body over one motion. All teeth are seen.
[[nodiscard]] SweptGap swept_gap(const GearDistance& part, const Frustum& body, const ToolMotion& motion, const SweptGapOptions& options);

}  // namespace toothpath
