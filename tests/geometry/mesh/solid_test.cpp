#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "geometry/mesh/cgal_check.h"
#include "tests/geometry/mesh/samples.h"
#include "tests/support/brute_force_face_gear.h"

namespace toothpath::test {
namespace {

class MeshSolid : public testing::TestWithParam<MeshSample> {};

TEST_P(MeshSolid, WholeGearIsOneClosedBodyWithoutCrossings) {
  const mesh::ToothMesh pitch = meshed(made(GetParam().gear), 0.08);
  const mesh::TriangleMesh gear = mesh::join_copies(pitch);
  EXPECT_EQ(gear.triangles.size(), pitch.mesh.triangles.size() * std::size_t(pitch.teeth));
  const auto check = mesh::check_mesh(gear);
  ASSERT_TRUE(check) << check.error().message;
  EXPECT_TRUE(check->manifold);
  EXPECT_TRUE(check->closed);
  EXPECT_TRUE(check->outward);
  EXPECT_EQ(check->components, 1u);
  EXPECT_EQ(check->self_intersections, 0u);
  EXPECT_NEAR(check->volume_mm3, mesh::signed_volume(gear), 1e-9 * check->volume_mm3);
}

INSTANTIATE_TEST_SUITE_P(Samples, MeshSolid, testing::ValuesIn(mesh_samples()), sample_name);

/// Volume of one pitch of a ring above z_base: height of the material left by the swept shaper, by bisection in every
/// column, integrated over the sector. Columns must not overhang.
double swept_volume(const face_gear::FaceGear& gear, const face_gear::FaceGearRing& ring, double z_base) {
  const BruteForceFaceGear oracle(gear.parameters(), ring.zone.helix_angle_rad);
  constexpr std::array<double, 5> kNode{-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                                        0.906179845938664};
  constexpr std::array<double, 5> kWeight{0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                          0.236926885056189};
  constexpr int kColumns = 240;
  const double r0 = ring.zone.inner_radius_mm, r1 = ring.zone.outer_radius_mm;
  double volume = 0;
  for (std::size_t g = 0; g < kNode.size(); ++g) {
    const double r = 0.5 * (r0 + r1) + 0.5 * (r1 - r0) * kNode[g], z_tip = ring.surface.z_tip(r);
    double area = 0;
    for (int k = 0; k < kColumns; ++k) {
      const double azimuth = gear.pitch() * (k + 0.5) / kColumns;
      const auto solid = [&](double z) {
        return oracle.least_clearance({r * std::cos(azimuth), r * std::sin(azimuth), z}) > 0;
      };
      double low = gear.lowest_root() - 0.1, high = z_tip;
      if (solid(high)) {
        low = high;
      } else {
        for (int step = 0; step < 16; ++step) (solid(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
      }
      area += (low - z_base) * r * gear.pitch() / kColumns;
    }
    volume += area * kWeight[g] * 0.5 * (r1 - r0);
  }
  return volume;
}

void expect_volume_of_sweep(const face_gear::FaceGearParameters& parameters) {
  const face_gear::FaceGear gear = made(parameters);
  const mesh::ToothMesh pitch = meshed(gear, 0.002);
  const double meshed_volume = mesh::signed_volume(mesh::join_copies(pitch)) / gear.parameters().teeth;
  double z_base = INFINITY;
  for (const Vec3& v : pitch.mesh.vertices) z_base = std::min(z_base, v.z());
  double expected = 0, groove = 0;
  for (const auto& ring : gear.rings()) expected += swept_volume(gear, ring, z_base);
  for (std::size_t k = 0; k + 1 < gear.rings().size(); ++k) {
    const double r0 = gear.rings()[k].zone.outer_radius_mm, r1 = gear.rings()[k + 1].zone.inner_radius_mm;
    groove += 0.5 * gear.pitch() * (r1 * r1 - r0 * r0) * (gear.groove_floor() - z_base);
  }
  // Measured against the toothed layer alone: 2e-4 of it is far below what a missing fillet or a wrong side would
  // change.
  const double face = gear.outer_radius() - gear.inner_radius();
  const double layer =
      gear.pitch() * 0.5 * (gear.inner_radius() + gear.outer_radius()) * face * 2 * gear.parameters().module_mm;
  EXPECT_NEAR(meshed_volume, expected + groove, 2e-4 * layer) << "layer " << layer;
}

TEST(MeshVolume, SpurEqualsTheSweep) { expect_volume_of_sweep(spur_parameters()); }
TEST(MeshVolume, OffsetEqualsTheSweep) {
  face_gear::FaceGearParameters g = spur_parameters();
  g.offset_mm = 15;
  g.shaper_tip_radius_mm = 0.9;
  expect_volume_of_sweep(g);
}
TEST(MeshVolume, DoubleHelicalEqualsTheSweep) { expect_volume_of_sweep(double_helical_parameters()); }

// Planted faults: each must be seen, and only as what it is.
class MeshCheckFaults : public testing::Test {
 protected:
  static mesh::TriangleMesh coarse() { return mesh::join_copies(meshed(made(spur_parameters()), 1.0)); }
  static mesh::MeshCheck checked(const mesh::TriangleMesh& mesh) {
    const auto check = mesh::check_mesh(mesh);
    EXPECT_TRUE(check);
    return *check;
  }
};

TEST_F(MeshCheckFaults, SoundMeshPasses) { EXPECT_TRUE(checked(coarse()).is_solid()); }

TEST_F(MeshCheckFaults, MissingTriangleIsAHole) {
  mesh::TriangleMesh mesh = coarse();
  mesh.triangles.erase(mesh.triangles.begin() + 100);
  const mesh::MeshCheck check = checked(mesh);
  EXPECT_TRUE(check.manifold);
  EXPECT_FALSE(check.closed);
}

TEST_F(MeshCheckFaults, FlippedTriangleIsNotManifold) {
  mesh::TriangleMesh mesh = coarse();
  std::swap(mesh.triangles[100][0], mesh.triangles[100][1]);
  EXPECT_FALSE(checked(mesh).manifold);
}

TEST_F(MeshCheckFaults, MeshTurnedInsideOutIsNotOutward) {
  mesh::TriangleMesh mesh = coarse();
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  const mesh::MeshCheck check = checked(mesh);
  EXPECT_TRUE(check.closed);
  EXPECT_FALSE(check.outward);
  EXPECT_LT(check.volume_mm3, 0);
}

TEST_F(MeshCheckFaults, VertexPushedThroughTheUndersideCrosses) {
  mesh::TriangleMesh mesh = coarse();
  for (Vec3& v : mesh.vertices)
    if (std::hypot(v.x(), v.y()) > 135 && std::hypot(v.x(), v.y()) < 140) {
      v.z() -= 50;
      break;
    }
  EXPECT_GT(checked(mesh).self_intersections, 0u);
}

TEST_F(MeshCheckFaults, BadIndexAndBadNumberAreRefused) {
  mesh::TriangleMesh mesh = coarse();
  mesh.triangles[3][1] = std::int32_t(mesh.vertices.size());
  EXPECT_FALSE(mesh::check_mesh(mesh));
  mesh = coarse();
  mesh.vertices[5].y() = NAN;
  EXPECT_FALSE(mesh::check_mesh(mesh));
  EXPECT_FALSE(mesh::check_mesh(mesh::TriangleMesh{}));
}

}  // namespace
}  // namespace toothpath::test
