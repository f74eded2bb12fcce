// Do the meshes of a scene stand where they should? A stock must hold the finished gear; a fixture in inches or far
// from the gear would prove nothing.
#pragma once

#include <functional>
#include <vector>

#include "app/process/scene.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::process {

/// The finished gear as a closed mesh in W. How thick it is below the teeth the job does not say: there the mesh is an
/// example.
struct FinishedGear {
  mesh::TriangleMesh mesh;
  std::vector<bool> teeth;                       ///< one a vertex: of the teeth and their ends, not of the body below
  std::function<bool(const Vec3&)> above_roots;  ///< is a place of W as high as the teeth?
};

/// Measures every mesh of the scene against the gear: `Scene::fixture_places` and `stock_places`. Refused, at the file:
/// - stock: the teeth reach out of all its solids, or a hole lies within them, by more than the clearance and the sag
/// of
///   our own facets;
/// - a fixture that lies near the origin of W or far from the gear and touches neither gear nor stock nor a fixture
/// that
///   does: its unit or its place is wrong.
[[nodiscard]] Status place_scene(Scene& scene, const FinishedGear& gear, double clearance_mm);

}  // namespace toothpath::process
