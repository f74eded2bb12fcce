// Places of the finished surface on which nearly as much stands as may: the others of a tooth that is cut nearly so
// need not be looked at again.
#pragma once

#include <span>
#include <vector>

#include "cam/path/operation.h"
#include "cam/path/tool_motion.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::cut {

/// A place in tooth space 0.
struct LeftPlace {
  Vec3 p = Vec3::Zero();
  double limit_mm = 0;  ///< what may stand there
};

/// What stands on the places of one tooth, after more and more of its cuts, mm; infinite ahead of the first.
class LeftOnTooth {
 public:
  explicit LeftOnTooth(std::span<const LeftPlace> places);
  /// Cuts of one operation, turned to tooth space 0. Runs on all threads; @param top_mm  as of `SweptTool`
  void add(std::vector<path::ToolMotion> cuts, const tool::ProofTool& tool, double top_mm);
  /// Nowhere more than may.
  [[nodiscard]] bool within() const;

 private:
  std::span<const LeftPlace> places_;
  std::vector<float> left_;
};

}  // namespace toothpath::cut
