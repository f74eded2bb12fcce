// The gear on its machine, for the 3D view: one pitch of the gear that is drawn once a tooth, what stands around it,
// and the joints of the machine as the program moves them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/report/page/machine_states.h"
#include "geometry/base/result.h"
#include "geometry/mesh/triangle_mesh.h"
#include "machines/machine.h"

namespace toothpath::page {

/// A body of the machine, or one that stands in for what nobody stated.
struct SceneBody {
  std::string name;
  std::size_t link = 0;  ///< of machines::Links
  std::variant<machines::BoxShape, machines::ConeShape, mesh::TriangleMesh> shape;
  bool stand_in = false;  ///< drawn for orientation only
  bool work = false;      ///< a fixture: gear frame instead of machine coordinates
  int tool = -1;          ///< index in the job: drawn while this tool is in the spindle; -1: always
};

struct MachineScene {
  machines::KinematicChain chain;
  Vec3 origin_mm = Vec3::Zero();     ///< of the gear frame, machine coordinates
  Mat3 rotation = Mat3::Identity();  ///< its axes
  int teeth = 0;
  mesh::TriangleMesh pitch;  ///< gear frame
  std::vector<SceneBody> bodies;
  std::vector<double> tool_length_mm;  ///< gauge line to tip, in the job's order
  SceneStates moves;
  std::string note;  ///< what the picture is made of, one line
};

/// For the page's script.
[[nodiscard]] nlohmann::json machine_scene_json(const MachineScene& scene);

}  // namespace toothpath::page
