// What a mill of any profile has removed: the volume swept by its cutting bodies along a path. Exact in double on
// candidates of a spatial index.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "cam/analytic/spatial_index.h"
#include "cam/cut/swept_path.h"
#include "cam/path/tool_motion.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::cut {

/// How far a motion takes what it moves: `way` of the tip [mm], and turn [mm for each mm from it].
struct MotionReach {
  explicit MotionReach(const path::ToolMotion& motion);
  double way = 0, turn = 0;
};

/// Least signed distance from a point to a body over all moments of a motion (straight in the tip, normalised linear in
/// the axis), negative inside. The distance is convex along a motion whose axis stands and, up to the square of the
/// turn, along one that turns; its least is found to 1e-9 mm from the middle and both ends. Where `enough` is not
/// undercut anything above it may be returned, and as soon as `near` is undercut what was found.
[[nodiscard]] double least_distance(const Vec3& point, const tool::RoundedFrustum& body, const path::ToolMotion& motion,
                                    const MotionReach& reach, double enough, double near = -INFINITY);
[[nodiscard]] inline double least_distance(const Vec3& point, const tool::RoundedFrustum& body,
                                           const path::ToolMotion& motion, double enough) {
  return least_distance(point, body, motion, MotionReach(motion), enough);
}

class SweptTool {
 public:
  /// `motions`: those that cut; each is taken up to the end of the cutting bodies. Parts above z = `top_mm` are left
  /// out of the index.
  SweptTool(std::vector<path::ToolMotion> motions, std::vector<tool::RoundedFrustum> cutting, double top_mm);

  /// min over the path of the distance to the cutting part: > 0 material left at p, < 0 removed that deep. Values above
  /// `cap` are returned as `cap`. mm.
  /// @param answered  kept by who asks of one place after another: the motion that answered last, asked first with
  ///                  those beside it. It makes the answer cheaper, not another one. SIZE_MAX: none yet.
  [[nodiscard]] double excess(const Vec3& p, double cap, std::size_t* answered = nullptr) const;
  /// Is it less than `near_mm` after the first `count` motions? Any of them that comes so near answers.
  [[nodiscard]] bool comes_within(std::size_t count, const Vec3& p, double near_mm,
                                  std::size_t* answered = nullptr) const;

 private:
  [[nodiscard]] double distance_from(std::size_t owner, const Vec3& p, double enough, double near = -INFINITY) const {
    const std::size_t k = owner / cutting_.size();
    return least_distance(p, cutting_[owner % cutting_.size()], motions_[k], reaches_[k], enough, near);
  }

  std::vector<path::ToolMotion> motions_;
  std::vector<tool::RoundedFrustum> cutting_;
  std::vector<MotionReach> reaches_;  ///< of the motions
  std::vector<std::size_t> owners_;   ///< of the boxes of the index: motion times the number of bodies, and body
  analytic::SpatialIndex index_;
};

/// What one operation has removed, with a ball mill or any other, and what others have beside it.
class Removed {
 public:
  Removed(std::vector<BallMove> moves, double ball_radius_mm)
      : balls_(std::make_unique<SweptPath>(std::move(moves), ball_radius_mm)) {}
  /// @param motions  rapids among them remove nothing;  @param top_mm  as of `SweptTool`
  Removed(std::vector<path::ToolMotion> motions, const tool::ProofTool& tool, double top_mm);
  /// Counts another one in; it must outlive this one.
  void also(const Removed* other) { others_.push_back(other); }
  /// As `SweptTool::excess`.
  [[nodiscard]] double excess(const Vec3& p, double cap, std::size_t* answered = nullptr) const;
  /// Is it less than `near_mm`?
  [[nodiscard]] bool comes_within(const Vec3& p, double near_mm, std::size_t* answered = nullptr) const;

 private:
  std::unique_ptr<SweptPath> balls_;  // one of the two
  std::unique_ptr<SweptTool> tool_;
  std::vector<const Removed*> others_;
};

}  // namespace toothpath::cut
