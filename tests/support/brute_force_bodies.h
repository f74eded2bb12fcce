// How deep a body of a tool cuts into a face gear, the plain way: signed distances at a dense set of boundary points of
// the gear and at many moments of the motion, the deepest improved by a pattern search. Shares nothing with the bounds
// of cam.
#pragma once

#include <vector>

#include "cam/path/tool_motion.h"
#include "tests/support/brute_force_gear_solid.h"

namespace toothpath::test {

/// A body about the tool axis: a truncated cone, a capsule (cylinder with round ends) where `round`, or what lies below
/// a meridian of many points.
struct BruteBody {
  double from = 0, to = 0;  ///< heights above the tip, mm
  double radius_from = 0, radius_to = 0;
  bool round = false;
  std::vector<Vec2> meridian =
      {};  ///< (height, radius) from the tip upwards, dense; then the other numbers only say how far it reaches
};
/// The body of a meridian.
[[nodiscard]] BruteBody brute_body(std::vector<Vec2> meridian);

struct BruteDepth {
  double depth = -INFINITY;   ///< > 0: cuts; < 0: the least gap
  Vec3 place = Vec3::Zero();  ///< gear frame
  int tooth = 0, zone = 0, patch = 0;
  double x = 0, y = 0, t = 0;
};

class BruteForceBodies {
 public:
  /// `rows` x `columns` boundary points a patch.
  explicit BruteForceBodies(const face_gear::FaceGear& gear, int rows = 16, int columns = 16);

  /// Deepest place over the whole motion, over `moments` + 1 moments and the teeth near the tool; the pattern search
  /// starts from up to `most_starts` places.
  [[nodiscard]] BruteDepth deepest(const BruteBody& body, const path::ToolMotion& motion, int moments = 6,
                                   std::size_t most_starts = 8) const;
  /// Only the deepest sample, at `moments` + 1 moments: quick, and too shallow by what lies between the samples.
  [[nodiscard]] BruteDepth sampled(const BruteBody& body, const path::ToolMotion& motion, int moments = 1) const;
  /// The same from one place on: only the pattern search.
  [[nodiscard]] BruteDepth improved(const BruteBody& body, const path::ToolMotion& motion, BruteDepth start,
                                    double first_step = 0.05) const;
  [[nodiscard]] const BruteForceGearSolid& solid() const { return solid_; }

 private:
  struct Sample {
    Vec3 p;
    int zone, patch;
    double x, y;
  };
  /// The deepest samples of every zone, patch, tooth and moment.
  [[nodiscard]] std::vector<BruteDepth> seeds(const BruteBody& body, const path::ToolMotion& motion, int moments) const;
  const face_gear::FaceGear& gear_;
  BruteForceGearSolid solid_;
  std::vector<Sample> samples_;
};

/// Depth of one point of space in a body whose tip and axis are given.
[[nodiscard]] double depth_in_body(const Vec3& p, const BruteBody& body, const Vec3& tip, const Vec3& axis);

}  // namespace toothpath::test
