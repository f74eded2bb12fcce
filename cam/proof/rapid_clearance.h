// Rapids run at an unknown speed on each axis and must never meet the blank: ball, flute, shank and holder stay above
// it, below it, outside its outer or inside its inner radius, or the plane across the axis at the foot of the tool
// stays above all of it, at every moment of the motion, not only at samples.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "cam/path/tool_motion.h"
#include "cam/proof/roof.h"
#include "cam/tool/assembly.h"
#include "cam/tool/body.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::proof {

/// What a rapid must keep clear of: a ring about the gear axis, mm.
struct RapidObstacle {
  double outer_radius_mm = 0;
  double inner_radius_mm = 0;  ///< 0: a full cylinder
  double top_mm = 0;
  double bottom_mm = -std::numeric_limits<double>::infinity();
  std::optional<Roof> roof = {};  ///< the ring lies below it, too

  /// Farthest place of the full cylinder along a unit direction.
  [[nodiscard]] double farthest(const Vec3& direction) const {
    const double z = direction.z() >= 0 ? top_mm : bottom_mm;
    return z * direction.z() + outer_radius_mm * std::hypot(direction.x(), direction.y());
  }
};

struct RapidProof {
  bool clear = false;
  double t = 0;  ///< where it is not: share of the motion
  Vec3 tip = Vec3::Zero();
  tool::Body body = tool::Body::none;  ///< what is lowest there: ball, shank or holder
};

/// Proves that the whole tool keeps clear of the obstacle (touching is allowed up to 1e-6 mm). The motion is halved
/// until one of the ways of being clear holds for a whole piece, with what the bodies can move in it subtracted; a
/// piece of 1e-4 mm that is still open counts as not clear.
[[nodiscard]] RapidProof prove_rapid(const path::ToolMotion& motion, const tool::ToolAssembly& tool,
                                     const RapidObstacle& obstacle);
/// The same for any tool: its cutting part is told as "flute".
[[nodiscard]] RapidProof prove_rapid(const path::ToolMotion& motion, const tool::ProofTool& tool,
                                     const RapidObstacle& obstacle);

}  // namespace toothpath::proof
