// A tool as proofs ask for it: the convex bodies of its cutting part, which may touch, and those of shank and holder,
// which may not.
#pragma once

#include <optional>
#include <vector>

#include "cam/tool/assembly.h"
#include "cam/tool/rounded_frustum.h"

namespace toothpath::tool {

class Profile;

struct ProofTool {
  int number = 0;                       ///< T word
  std::vector<RoundedFrustum> cutting;  ///< their union contains the cutting part; names "flute"
  double ball_top_mm = 0;       ///< what touches below this height above the tip is the ball end; 0: there is none
  std::vector<Frustum> bodies;  ///< "shank" and "holder", from below
  std::optional<ToolAssembly> ball_mill;  ///< a plain ball mill: its ball and flute are followed by distances of points
};

/// Of a plain ball mill everything in `ball_mill`, and the same as bodies; any other end mill by its profile.
[[nodiscard]] ProofTool proof_tool(const ToolAssembly& tool);
[[nodiscard]] std::vector<ProofTool> proof_tools(const std::vector<ToolAssembly>& tools);

/// The tool of a profile. Ball, tapered ball, flat and bull nose cutters: one rounded frustum, exact up to the end of
/// the flutes; above them it goes on by the ball's or corner's radius times 1 + sin(half angle), where the shank is.
/// Barrels, measured meridians and profiles without a law: chains of bodies that contain the cutting part and stand out
/// of it by no more than `sag_mm` between their nodes, and by as much as the steeper of two neighbours stands out of
/// the other where they meet. Where a measured meridian ends below the flutes its largest error is taken above.
[[nodiscard]] ProofTool proof_tool(const Profile& profile, int number, double sag_mm = 1e-4);

}  // namespace toothpath::tool
