// Face gears whose meshes are tested: every shape of tooth space that the mesh has to follow.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

#include "geometry/base/angle.h"
#include "geometry/tooth_mesh.h"

namespace toothpath::test {

struct MeshSample {
  std::string name;
  FaceGearParameters gear;
};
inline void PrintTo(const MeshSample& sample, std::ostream* out) { *out << sample.name; }

inline FaceGearParameters spur_parameters() {
  FaceGearParameters g;
  g.teeth = 88;
  g.shaper_teeth = 25;
  g.module_mm = 3;
  g.module_plane = ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.zones = {{0, 130.5, 147}};
  return g;
}

inline FaceGearParameters double_helical_parameters() {
  FaceGearParameters g;
  g.teeth = 180;
  g.shaper_teeth = 30;
  g.module_mm = 5;
  g.module_plane = ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.reference_radius_mm = 472;
  g.shaper_tip_radius_mm = 1.5;
  g.groove_depth_mm = 12.5;
  g.zones = {{radians(-30), 449, 468}, {radians(30), 476, 496}};
  return g;
}

inline std::vector<MeshSample> mesh_samples() {
  std::vector<MeshSample> samples;
  const auto add = [&](const char* name, FaceGearParameters g) { samples.push_back({name, std::move(g)}); };
  FaceGearParameters g = spur_parameters();
  add("spur_sharp", g);
  g.shaper_tip_radius_mm = largest_tip_radius(g, 0);
  add("spur_full_round_tip", g);  // the root land has no width
  g = spur_parameters();
  g.offset_mm = 15;
  add("offset_sharp", g);
  g.shaper_tip_radius_mm = 0.9;
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
  g = {};
  g.teeth = 75;
  g.shaper_teeth = 22;
  g.module_mm = 2;
  g.pressure_angle_rad = radians(25);
  g.offset_mm = 6;
  g.shaft_angle_rad = radians(75);
  g.shaper_tip_radius_mm = 0.4;
  g.zones = {{radians(15), 74, 84}};
  add("gamma_75_helical_offset", g);
  return samples;
}

inline FaceGear made(const FaceGearParameters& parameters) {
  auto gear = FaceGear::make(parameters);
  if (auto* refused = std::get_if<std::vector<FaceGearRefusal>>(&gear))
    throw std::runtime_error(refused->front().key + ": " + refused->front().diagnostic.message);
  return std::get<FaceGear>(std::move(gear));
}

inline ToothMesh meshed(const FaceGear& gear, double tolerance_mm) {
  auto mesh = mesh_tooth_space(gear, tolerance_mm);
  if (!mesh) throw std::runtime_error(mesh.error().message);
  return *std::move(mesh);
}

inline bool is_exact_patch(Patch p) { return p <= Patch::tip; }

inline std::string sample_name(const testing::TestParamInfo<MeshSample>& info) { return info.param.name; }

}  // namespace toothpath::test
