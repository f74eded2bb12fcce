// Shank and holder along their motions: the least gap to the part that was found, and the gap that is proven for every
// moment between the blocks.
//
// The signed distance to a convex body is a convex function. Seen from the tool, a quad of the part that moves past
// lies in the hull of its corners at both ends of the motion, up to the sag of its patch and the arc of an axis that
// turns; a tangent plane of the distance at any point of the hull therefore bounds the gap of the whole quad over the
// whole motion. Quads and motions are halved, the quads on their exact patches, until the bound is close to what was
// found. Every gap that is told is that of a place of the surface.
//
// A body that is meant to touch is asked for with `touching`: the tangent plane is then laid where the body comes
// nearest to the hull, so that its roundness costs nothing, and the place of the surface there tells what is found.
#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <span>

#include "cam/analytic/gear_distance.h"
#include "cam/path/tool_motion.h"
#include "cam/proof/limits.h"
#include "cam/tool/rounded_frustum.h"

namespace toothpath::analytic {

struct SweptGap {
  double proven_mm = 0;    ///< no place of the motion comes nearer; negative: a cut
  double measured_mm = 0;  ///< least gap found, at a place of the finished surface
  int zone = 0;
  const char* patch = "tooth";
  Vec3 place = Vec3::Zero();  ///< where, turned to tooth space 0
  double height_mm = 0;       ///< of that place above the tip, along the tool axis
  std::size_t pieces = 0;     ///< quads that were looked at
};

struct SweptGapOptions {
  double enough_mm = 0.5;                                   ///< gaps above this are returned as this
  double contact_mm = 0;                                    ///< below this ...
  double contact_proof_mm = proof::ProofLimits{}.proof_mm;  ///< ... the bound lies within this of the least gap that
                                                            ///< was found, but for the motion's own deviations
  double proof_mm = 0.01;                                   ///< else within this
  double asked_mm =
      -INFINITY;             ///< where the least gap found is no less, the bound is followed until it is no less, too
  bool touching = false;     ///< the body may touch: tangent planes where it comes nearest
  bool flanks_only = false;  ///< gaps to flanks; everything else is not looked at
  double settled_mm = INFINITY;  ///< a bound above this is good enough, however much larger the least gap is
};

/// What of the part may come near some bodies of a tool along one motion: found once for all of them.
class NearCells {
 public:
  /// @param enough_mm  the greatest `SweptGapOptions::enough_mm` of the bodies
  NearCells(const GearDistance& part, std::span<const tool::RoundedFrustum> bodies, const path::ToolMotion& motion,
            double enough_mm);
  NearCells(NearCells&&) noexcept;
  NearCells& operator=(NearCells&&) noexcept;
  ~NearCells();
  struct Found;
  [[nodiscard]] const Found& found() const { return *found_; }

 private:
  std::unique_ptr<Found> found_;
};

/// Least gap of one body over one motion. All teeth are seen. @param near  made for this body, and perhaps others, and
/// the same motion
[[nodiscard]] SweptGap swept_gap(const GearDistance& part, const tool::RoundedFrustum& body,
                                 const path::ToolMotion& motion, const SweptGapOptions& options, const NearCells& near);
[[nodiscard]] SweptGap swept_gap(const GearDistance& part, const tool::RoundedFrustum& body,
                                 const path::ToolMotion& motion, const SweptGapOptions& options);
[[nodiscard]] SweptGap swept_gap(const GearDistance& part, const tool::Frustum& body, const path::ToolMotion& motion,
                                 const SweptGapOptions& options);

}  // namespace toothpath::analytic
