// Do the motions of a tool keep their distance from a mesh: a fixture, the stock? Proven between the samples.
//
// No point of a body moves farther than r from where it is at the middle of a stretch of motion; a gap g there proves g
// - r on all of it, whatever the mesh. Stretches are halved until that is enough, or within `proof_mm` of what was
// measured.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cam/clearance/distance.h"
#include "cam/path/tool_motion.h"
#include "cam/tool/profile.h"

namespace toothpath::clearance {

/// Where a tool comes near a mesh.
struct MeshMeeting {
  double gap_mm = 0;  ///< proven there: nothing on that stretch of the program is nearer; <= 0: touches or may touch
  double measured_mm = 0;              ///< found there; -infinity: the body is wholly inside
  tool::Body body = tool::Body::none;  ///< cutter, shank or holder
  int operation = 0, tooth = 0, line = 0;
  bool rapid = false;
  std::size_t mesh = 0;       ///< index of the mesh
  Vec3 place = Vec3::Zero();  ///< on the mesh, W
};

/// One body of a tool: a union of truncated cones about its axis, or a ball mill's cutting part.
struct MeshBody {
  tool::Body body = tool::Body::cutter;  ///< or shank, holder
  std::vector<tool::Frustum>
      pieces;          ///< joined, from below; of a ball mill's cutting part: the cylinder over its whole length
  double ball_mm = 0;  ///< > 0: the lower end is a ball of this radius that touches the tip
  [[nodiscard]] bool cuts() const { return tool::cuts(body); }
  [[nodiscard]] double top_mm() const { return pieces.back().to; }
};
/// Cutting part, shank and holder of any cutter, from below. A plain ball mill keeps its ball; else the cutting part is
/// enclosed in cones that stand out of it by no more than `sag_mm`.
[[nodiscard]] std::vector<MeshBody> mesh_bodies(const tool::Profile& tool, double sag_mm = 1e-3);
/// The same of a ball mill.
[[nodiscard]] std::vector<MeshBody> mesh_bodies(const tool::ToolAssembly& tool);

/// Which bodies must keep which distance.
struct MeshRule {
  double cutter_mm = 0, others_mm = 0;  ///< least proven gap that passes
  bool cutter = true, others = true;    ///< false: that body may go where it likes
};

struct MeshClearanceOptions {
  double look_mm = 2;       ///< gaps more than this above the rule are not told apart
  double proof_mm = 0.005;  ///< how far the proven gap may lie below a measured one that matters
};

/// A tool that is drawn back along its own axis from where it has cut: the room of its cutting part there is empty.
struct Withdrawal {
  Vec3 tip = Vec3::Zero(), axis = Vec3::UnitZ();  ///< where the cut ended
};

/// Least gap of a stretch of motions; `motions` follow one another without a jump.
class MeshClearance {
 public:
  MeshClearance(std::span<const MeshDistance* const> meshes, MeshClearanceOptions options)
      : meshes_(meshes), options_(options) {}

  /// The nearest meeting of these motions, of all bodies and meshes; nothing where all gaps exceed the rule by
  /// `look_mm`. `withdrawal`: see above; the motions must draw the tool back along that axis.
  [[nodiscard]] std::optional<MeshMeeting> nearest(std::span<const path::ToolMotion> motions,
                                                   std::span<const MeshBody> tool, const MeshRule& rule,
                                                   const std::optional<Withdrawal>& withdrawal = {}) const;
  /// The same for a ball mill.
  [[nodiscard]] std::optional<MeshMeeting> nearest(std::span<const path::ToolMotion> motions,
                                                   const tool::ToolAssembly& tool, const MeshRule& rule,
                                                   const std::optional<Withdrawal>& withdrawal = {}) const {
    return nearest(motions, mesh_bodies(tool), rule, withdrawal);
  }

 private:
  std::span<const MeshDistance* const> meshes_;
  MeshClearanceOptions options_;
};

/// Is this motion a draw back along the tool's own axis from `w`, within a micrometre?
[[nodiscard]] bool draws_back(const path::ToolMotion& m, const Withdrawal& w);

}  // namespace toothpath::clearance
