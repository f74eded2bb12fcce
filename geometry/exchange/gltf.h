// A gear as glTF 2.0 in one binary file (GLB): the mesh of one pitch, and a node a tooth space that turns it. Metres
// and y up, as the format asks. The only file that knows tinygltf.
#pragma once

#include <string>

#include "geometry/base/result.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::exchange {

/// The bytes of the file. `pitch`: one of `teeth` equal parts of the gear, gear frame, mm. The gear's z axis becomes y;
/// the mesh itself stays in mm and in the gear frame, its root node turns and scales. Nodes: the name, and "space 0",
/// "space 1" .. below it. Refused: what tinygltf refuses.
[[nodiscard]] Result<std::string> gltf_file(const mesh::TriangleMesh& pitch, int teeth, const std::string& name);

}  // namespace toothpath::exchange
