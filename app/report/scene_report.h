// What a check says about the meshes that stand around the gear: fixture and stock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cam/clearance/clearance.h"

namespace toothpath::report {

/// A mesh and where it stands, mm in the gear frame.
struct MeshInScene {
  std::string file;
  std::size_t facets = 0;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< corners of its box
  double to_gear_mm = 0;                         ///< between its surface and that of the finished gear; 0: they meet
};

/// One kind of mesh: all files given for it.
struct SceneVerdict {
  std::string name;  ///< "fixture" or "stock"
  std::vector<MeshInScene> meshes;
  double required_mm = 0;  ///< clearance that was asked for
  double look_mm = 0;      ///< gaps larger than this were not told apart
  std::optional<clearance::MeshMeeting>
      nearest;  ///< the least margin of the whole program; none: nothing comes nearer than look_mm
  std::vector<clearance::MeshMeeting> worst;  ///< what does not pass, worst first, at most 20
  std::size_t failed = 0;                     ///< stretches of the program that do not pass
  std::size_t motions = 0;                    ///< judged
  std::size_t unjudged = 0;  ///< blocks that move from an unknown position or without a tool of the job
  [[nodiscard]] bool clear() const { return failed == 0; }
};

}  // namespace toothpath::report
