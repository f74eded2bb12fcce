// The cutting part of a ball mill, ball and flute, along its motions: how deep it was found in the part, and how deep
// it can be anywhere between the places that were looked at.
//
// The bound needs no curvature. For any set, d(x)^2 - |x|^2 is concave along a straight line (it is a minimum of affine
// functions), so that between two points L apart, at distances d0 and d1 from the set,
//     d(s)^2 >= (1 - s/L) d0^2 + (s/L) d1^2 - s (L - s).
// Along the motion this bounds the ball centre (and every other height of the tool axis); along the tool axis, at a
// fixed time, it bounds the flute between two heights. What the true motion leaves of the straight line is added:
// docs/proof.md.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "cam/analytic/gear_distance.h"
#include "cam/path/tool_motion.h"
#include "cam/proof/roof.h"
#include "cam/tool/assembly.h"
#include "cam/tool/body.h"

namespace toothpath::analytic {

/// Least distance to any set on a straight line of length `length`, from lower bounds of the distances at its ends.
/// Negative distances (inside) are bounded by their slope of 1. mm.
[[nodiscard]] double least_between(double d0, double d1, double length);

struct CutterFinding {
  double measured_mm = -INFINITY;  ///< deepest place found; negative: the least gap
  double bound_mm = -INFINITY;     ///< proven: no place of the motion is deeper
  NearestPlace deepest;
  tool::Body body = tool::Body::ball;  ///< or the flute
};

/// What is known of a motion before it is looked at, for each part of the cutter in turn: a depth that it cannot
/// exceed.
struct KnownDepths {
  std::span<const double> of_part;  ///< mm; empty: nothing is known
  double good_mm = 0;               ///< a part that is known to be no deeper than this is not looked at
  [[nodiscard]] bool good(std::size_t part) const { return part < of_part.size() && of_part[part] <= good_mm; }
};

/// Checks motions one after another; each starts from what the one before it found, so that a chain of short motions
/// costs about two distances a motion. One object a thread.
class CutterSweep {
 public:
  /// @param proof_mm how far the bound may lie above the deepest place found so far
  /// @param tolerance_mm depth that is accepted: a motion is followed more coarsely only where it stays below
  CutterSweep(const GearDistance& part, const tool::ToolAssembly& tool, double proof_mm, double tolerance_mm);

  /// Parts: ball, flute.
  [[nodiscard]] CutterFinding check(const path::ToolMotion& motion, const KnownDepths& known = {});
  /// Something this deep was found elsewhere: what is no deeper need not be followed closely.
  void expect(double depth_mm);
  /// From now on every motion is followed closely, whatever was found in others.
  void each_by_itself() { by_itself_ = true; }
  /// Of every part, the depth that it cannot exceed in the motion that was checked last.
  [[nodiscard]] std::span<const double> part_bounds() const { return part_bounds_; }
  [[nodiscard]] std::size_t queries() const { return queries_; }

 private:
  /// A height of the tool axis above the ball centre whose distance was asked somewhere before, and the whole axis from
  /// there on.
  struct Row {
    double height = 0;
    bool known = false;
    Vec3 at = Vec3::Zero();
    double distance = 0;
    bool above_known = false;
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();  // of the axis above, where it was asked last,
    double keeps = 0;                              // and how far all of it kept from the surface
  };
  /// A distance asked to its full range: neighbouring stretches share their corners.
  struct Known {
    Vec3 at = Vec3::Constant(NAN);
    NearestPlace nearest;
  };
  [[nodiscard]] Vec3 place(double t, double height) const;
  NearestPlace query(const Vec3& p, double most);
  void note(const NearestPlace& q, tool::Body body);
  [[nodiscard]] bool settled(double least, double seen, double slack, double arm) const;
  [[nodiscard]] double height_above() const;
  [[nodiscard]] double height_from(double height, double next) const;
  bool centre(double& least);
  double ball(double t0, double t1, const NearestPlace& q0, const NearestPlace& q1, int depth);
  void flute(double least_at_centre, double ball_bound);
  [[nodiscard]] double remembered(const Row& row) const;
  double fresh(Row& row);
  [[nodiscard]] double remembered_above(const Row& row) const;
  double fresh_above(Row& row);
  bool clear_above(Row& row, double height, double low, double free_mm);
  void patch(double t0, double t1, double h0, double h1, double d00, double d10, double d01, double d11, int depth);
  double at(double t, double height);

  const GearDistance& part_;
  proof::Roof roof_;
  double R_, top_, proof_, tolerance_, within_;
  std::vector<Row> rows_;
  std::vector<Known> known_;  ///< by the bits of the place
  bool chained_ = false;
  Vec3 last_centre_ = Vec3::Zero();
  NearestPlace last_;
  double worst_ = 0;  ///< deepest found by this object so far, at least 0
  bool by_itself_ = false;
  const path::ToolMotion* m_ = nullptr;
  CutterFinding found_;
  std::array<double, 2> part_bounds_{};
  double flute_leaves_ = INFINITY;  ///< how far above the part the flute was when it was followed no higher
  std::size_t queries_ = 0, queries_before_ = 0;  ///< of all motions; of those before this one
};

}  // namespace toothpath::analytic
