// The gouge check of mills on a toothed part: what every body of the tool was found to do along every motion, and a
// proven bound for every moment between the blocks. Ball and flute: cam/analytic/cutter_sweep.h. Cutting parts of any
// profile: cam/analytic/profile_sweep.h. Shank and holder: cam/analytic/body_sweep.h. Rapids:
// cam/proof/rapid_clearance.h. Why the bounds hold: docs/proof.md.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cam/analytic/gear_distance.h"
#include "cam/path/tool_motion.h"
#include "cam/proof/checked_cl_path.h"
#include "cam/proof/like_motion.h"
#include "cam/proof/limits.h"
#include "cam/proof/verification.h"
#include "cam/tool/assembly.h"
#include "cam/tool/proof_tool.h"
#include "geometry/base/result.h"

namespace toothpath::analytic {

struct GougeCheckOptions {
  proof::ProofLimits limits;   ///< what stands against them is refused
  double rapid_height_mm = 0;  ///< rapids must keep every body above this h of the chart, or beside the rings
};

class GougeCheck {
 public:
  /// Ball mills.
  GougeCheck(const GearDistance& part, const std::vector<tool::ToolAssembly>& tools, GougeCheckOptions options);
  /// Any mills.
  GougeCheck(const GearDistance& part, std::vector<tool::ProofTool> tools, GougeCheckOptions options);

  /// Checks motions; `tool_of_operation[op]` is an index into the tools. Runs on all threads; same bytes on any number.
  /// Those of `likes` (in order, like motions that are not among them) are looked at where what is proven of the
  /// others, and the way from there, does not tell that they are as good.
  [[nodiscard]] proof::GougeResult check(const std::vector<path::ToolMotion>& motions,
                                         const std::vector<int>& tool_of_operation,
                                         std::span<const proof::LikeMotion> likes = {}) const;

  /// Is everything within the options?
  [[nodiscard]] bool passes(const proof::GougeResult& result) const;

  /// The only maker of a CheckedClPath. On failure a verification diagnostic with the deepest of the places that were
  /// found: a path that is refused is not followed to its end.
  [[nodiscard]] Result<proof::CheckedClPath> check_path(path::ClPath path) const;

  /// The motions of a CL path in the order of its records.
  static std::vector<path::ToolMotion> motions_of(const path::ClPath& path);

 private:
  friend class GougeStream;
  [[nodiscard]] proof::GougeResult until_fault(const std::vector<path::ToolMotion>& motions, std::size_t tool) const;
  const GearDistance& part_;
  std::vector<tool::ProofTool> tools_;
  GougeCheckOptions options_;
};

/// The check of motions that are never held as a whole: first those that are like no others, then the others, both in
/// the order of the program. The same result as of one list.
class GougeStream {
 public:
  /// Both must outlive it. @param likes_follow  some are like others
  GougeStream(const GougeCheck& check, const std::vector<int>& tool_of_operation, bool likes_follow);
  GougeStream(const GougeStream&) = delete;
  GougeStream& operator=(const GougeStream&) = delete;
  ~GougeStream();

  /// @param number  by which others are like it, greater than any before; none: no other is
  void own(const path::ToolMotion& motion, std::optional<std::uint32_t> number);
  /// No own() behind it.
  void like(const path::ToolMotion& motion, const proof::LikeMotion& as);
  [[nodiscard]] proof::GougeResult finish();

 private:
  class Proven;
  struct Waiting;
  void work();

  const GougeCheck& check_;
  const std::vector<int>& tool_of_operation_;
  bool likes_follow_;
  std::vector<std::vector<double>> arms_;  ///< of the tools
  std::unique_ptr<Proven> proven_;
  std::vector<Waiting> waiting_;                    ///< for all threads
  std::optional<proof::GougeResult> before_likes_;  ///< once they follow
  proof::GougeResult out_;
};

}  // namespace toothpath::analytic
