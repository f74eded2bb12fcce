// Face gears whose meshes are tested: every shape of tooth space that the mesh has to follow.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/face_gear/part.h"
#include "geometry/mesh/tooth_mesh.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {

struct MeshSample {
  std::string name;
  face_gear::FaceGearParameters gear;
};
inline void PrintTo(const MeshSample& sample, std::ostream* out) { *out << sample.name; }

inline std::vector<MeshSample> mesh_samples() {
  std::vector<MeshSample> samples;
  const auto add = [&](const char* name, face_gear::FaceGearParameters g) { samples.push_back({name, std::move(g)}); };
  face_gear::FaceGearParameters g = spur_parameters();
  add("spur_sharp", g);
  g.shaper_tip_radius_mm = largest_tip_radius(g, 0);
  add("spur_full_round_tip", g);  // the root land has no width
  g = spur_parameters();
  g.offset_mm = 15;
  add("offset_sharp", g);
  g = offset_gear();
  g.zones = {{0, 129.6, 147}};  // 0.1 mm outside the undercut radius
  add("offset_near_undercut", g);
  g = double_helical_parameters();
  add("double_helical", g);
  g.groove_depth_mm = 11.25;
  add("double_helical_groove_level_with_root", g);
  g = double_helical_parameters();
  g.shaper_tip_radius_mm = 0;
  g.zones = {{radians(30), 470, 507.5}};
  add("helical_sharp_thin_land", g);
  add("gamma_75_helical_offset", conical_gear());
  return samples;
}

inline mesh::ToothMesh meshed(const face_gear::FaceGear& gear, double tolerance_mm) {
  auto mesh = mesh::mesh_tooth_space(drawn_solid(gear), tolerance_mm);
  if (!mesh) throw std::runtime_error(mesh.error().message);
  return *std::move(mesh);
}

inline bool is_exact_patch(tooth_space::Piece p) { return p <= tooth_space::Piece::tip; }

inline std::string sample_name(const testing::TestParamInfo<MeshSample>& info) { return info.param.name; }

}  // namespace toothpath::test
