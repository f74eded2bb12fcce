// The cutting part of a mill with any convex profile along its motions: how deep it was found in the part, and how deep
// it can be between.
//
// Ball end, side, corner and flat are one convex body or a few (cam/tool/proof_tool.h), and each may touch. Seen from
// the tool the part moves past in the hulls of its quads (cam/analytic/body_sweep.h); the tangent plane of the body's
// signed distance is laid where it comes nearest, so that the bound stands above what was found by what surface and
// motion bend within a quad, and by nothing that the body's roundness does. All of the part is seen alike: flanks,
// fillets, roots, lands, ends, neighbours, the other ring. docs/proof.md.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "cam/analytic/body_sweep.h"
#include "cam/analytic/cutter_sweep.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::analytic {

/// Checks motions one after another: a motion that stays in what was proven free before needs no look. One object a
/// thread.
class ProfileSweep {
 public:
  /// @param proof_mm how far the bound may lie above the deepest place found so far, but for the deviations that the
  /// motions state
  /// @param tolerance_mm depth that is accepted: only beyond it the depth of every motion by itself is wanted
  ProfileSweep(const GearDistance& part, const tool::ProofTool& tool, double proof_mm, double tolerance_mm);

  /// `body` is "ball" or "flute". Depths below -`kProfileLook` (gaps beyond that) are told as that. Parts: the cutting
  /// bodies of the tool.
  [[nodiscard]] CutterFinding check(const path::ToolMotion& motion, const KnownDepths& known = {});
  /// Something this deep was found elsewhere: what is no deeper need not be followed closely.
  void expect(double depth_mm);
  /// From now on every motion is followed closely, whatever was found in others.
  void each_by_itself() { by_itself_ = true; }
  /// Of every part, the depth that it cannot exceed in the motion that was checked last.
  [[nodiscard]] std::span<const double> part_bounds() const { return part_bounds_; }
  [[nodiscard]] std::size_t queries() const { return queries_; }

 private:
  struct Body {
    tool::RoundedFrustum shape;
    double arm = 0;
    bool known = false;
    Vec3 tip = Vec3::Zero(), axis = Vec3::UnitZ();  // where it was looked at last,
    double gap = 0;                                 // and its proven gap there
  };
  [[nodiscard]] double left_of(const Body& body, const path::ToolMotion& m) const;
  [[nodiscard]] static double look_ahead(const Body& body);
  [[nodiscard]] NearCells near_all(const path::ToolMotion& m, const KnownDepths& known) const;
  double look(Body& body, const path::ToolMotion& m, const NearCells& near);

  const GearDistance& part_;
  double ball_top_, proof_, tolerance_;
  std::vector<Body> bodies_;
  std::vector<double> part_bounds_;
  CutterFinding found_;
  double worst_ = 0;  ///< deepest found by this object so far, at least 0
  bool by_itself_ = false;
  std::size_t queries_ = 0;
};

inline constexpr double kProfileLook = 0.12;  // mm: gaps of the cutting part are followed so far

}  // namespace toothpath::analytic
