// What the tests of the gouge check share: a check of motions of a planned job, and the same depth from dense sampling.
#pragma once

#include <utility>
#include <vector>

#include "cam/analytic/gouge_check.h"
#include "tests/cam/ball/face_gear_jobs.h"

namespace toothpath::test {

inline Vec3 centre(const path::ClRecord& r, double R) { return r.tip + R * r.axis; }

inline proof::GougeResult check(const PlannedJob& job, const std::vector<path::ToolMotion>& motions,
                                std::vector<tool::ToolAssembly> tools = {}) {
  const analytic::GougeCheck checker(*job.part, tools.empty() ? job.tools : tools, job.check_options());
  return checker.check(motions, job.tool_of_operation());
}
inline bool passes(const PlannedJob& job, const proof::GougeResult& r) {
  return analytic::GougeCheck(*job.part, job.tools, job.check_options()).passes(r);
}

/// The deepest place of the ball on some motions, looked for at `steps` places a motion.
struct Sampled {
  double depth = -INFINITY;
  std::vector<std::pair<double, Vec3>> all;  ///< depth and foot of every place
};
inline Sampled sampled(const PlannedJob& job, const std::vector<path::ToolMotion>& motions, double R, int steps) {
  Sampled s;
  for (const auto& m : motions)
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps;
      const Vec3 axis = ((1 - t) * m.axis_from + t * m.axis_to).normalized();
      const auto q = job.part->nearest((1 - t) * m.tip_from + t * m.tip_to + R * axis, R + 0.1);
      s.depth = std::max(s.depth, R - q.distance);
      s.all.push_back({R - q.distance, q.foot});
    }
  return s;
}

}  // namespace toothpath::test
