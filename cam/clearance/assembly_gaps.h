// The gaps of a whole tool assembly to a mesh, over the successive poses of a path.
#pragma once

#include <span>
#include <vector>

#include "cam/clearance/distance.h"

namespace toothpath::clearance {

struct ToolPose {
  Vec3 tip = Vec3::Zero(), axis = Vec3::UnitZ();  ///< tip [mm] and unit axis, tip to holder, in the frame of the mesh
};

/// Follows one tool along a path. Each pose is answered exactly; what its neighbours have shown is used to find the
/// answer faster: candidates of the cutting part are gathered once for a window of poses, and a body that was proven
/// free by more than the motion since is not looked at again. One object a thread.
class MeshAssembly {
 public:
  /// `within_mm`: gaps above it are answered as it.
  MeshAssembly(const MeshDistance& mesh, const tool::ToolAssembly& tool, double within_mm);

  /// Bodies: 0 the cutting part (ball and flute), then shank and holder from below.
  [[nodiscard]] std::size_t bodies() const { return 1 + free_.size(); }
  [[nodiscard]] tool::Body body(std::size_t index) const {
    return index == 0 ? tool::Body::cutter : frustums_[index - 1].body;
  }

  /// gaps[bodies() * pose + body], mm. Cutting part: distance of its axis to the surface less its radius, so that a cut
  /// is negative and as deep as it is. Other bodies: their distance, 0 when they touch. A body wholly inside the solid:
  /// -infinity.
  void gaps(std::span<const ToolPose> poses, std::span<double> gaps);

  /// Exact questions to the tree so far (all but those that were skipped).
  [[nodiscard]] std::size_t queries() const { return queries_; }

 private:
  /// A body was at `pose` and had at least this gap.
  struct Free {
    ToolPose pose;
    double gap = -1;     ///< proven there
    double ahead = 0.5;  ///< how far beyond the limit the next question looks, mm
    ToolPose last;       ///< of the pose before, for the parity
    double last_gap = -1;
    bool inside = false;
  };
  void cutting_part(std::span<const ToolPose> poses, std::span<double> gaps);
  double other_body(std::size_t index, const ToolPose& pose);
  [[nodiscard]] bool side(Free& f, const ToolPose& pose, double gap, double motion, const Vec3& inner);

  const MeshDistance& mesh_;
  double radius_, height_, within_;
  std::vector<tool::Frustum> frustums_;
  std::vector<Free> free_;
  Free cutter_;
  MeshWindow window_;
  std::vector<std::int64_t> beside_;
  TriangleHit near_{};
  std::size_t queries_ = 0;
};

}  // namespace toothpath::clearance
