#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "geometry/base/angle.h"
#include "tests/geometry/mesh/samples.h"
#include "tests/support/brute_force_face_gear.h"

namespace toothpath::test {
namespace {

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double length2 = d.squaredNorm(), t = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  const bool over = n.allFinite() && (b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 &&
                    (a - c).cross(p - c).dot(n) >= 0;
  if (over) return std::abs((p - a).dot(n));
  return std::min({distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

class MeshTooth : public testing::TestWithParam<MeshSample> {
 protected:
  face_gear::FaceGear gear_ = made(GetParam().gear);
  mesh::ToothMesh mesh_ = meshed(gear_, 0.03);
};

TEST_P(MeshTooth, CornersLieOnTheSurfaceThatTheirTagNames) {
  const auto& rings = gear_.rings();
  for (std::size_t t = 0; t < mesh_.tags.size(); ++t) {
    const mesh::TriangleTag& tag = mesh_.tags[t];
    const face_gear::FaceGearZone& zone = rings[tag.zone].zone;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh_.mesh.corner(t, k);
      const double r = std::hypot(p.x(), p.y());
      if (is_exact_patch(tag.patch)) {
        const auto exact = mesh::exact_patch_point(drawn_solid(gear_), tag.zone, tag.patch, tag.uv[k]);
        ASSERT_TRUE(exact) << to_string(tag.patch);
        ASSERT_LE((exact->p - p).norm(), 1e-9) << to_string(tag.patch) << " uv " << tag.uv[k].transpose();
        ASSERT_GE(r, zone.inner_radius_mm - 1e-9);
        ASSERT_LE(r, zone.outer_radius_mm + 1e-9);
      } else {
        ASSERT_NEAR(std::remainder(tag.uv[k].x() - std::atan2(p.y(), p.x()), 2 * kPi), 0, 1e-12);
        const double to_end = std::min(std::abs(r - zone.inner_radius_mm), std::abs(r - zone.outer_radius_mm));
        if (tag.patch == tooth_space::Piece::end) {
          ASSERT_LE(to_end, 1e-9);
          ASSERT_NEAR(tag.uv[k].y(), p.z(), 0);
        } else if (tag.patch == tooth_space::Piece::groove) {
          ASSERT_NEAR(p.z(), gear_.groove_floor(), 1e-9);
        }
      }
    }
  }
}

// The oracle sweeps the solid shaper past each point and shares no formula with the surfaces.
TEST_P(MeshTooth, SweptShaperTouchesTheVerticesAndCutsJustAboveThem) {
  std::vector<BruteForceFaceGear> oracles;
  for (const auto& ring : gear_.rings()) oracles.emplace_back(gear_.parameters(), ring.zone.helix_angle_rad);
  std::size_t tested = 0;
  for (std::size_t t = 0; t < mesh_.tags.size(); t += 13) {
    const mesh::TriangleTag& tag = mesh_.tags[t];
    if (!is_exact_patch(tag.patch) || tag.patch == tooth_space::Piece::tip) continue;
    // Inside the base circle the tip corner belongs to no involute.
    const bool flank = is_flank(tag.patch);
    if (flank && tag.uv[0].x() < 1e-3) continue;
    const BruteForceFaceGear& oracle = oracles[tag.zone];
    const Vec3& p = mesh_.mesh.corner(t, 0);
    const Vec3 normal = mesh_.mesh.area_normal(t).normalized();
    EXPECT_NEAR(oracle.least_clearance(p), 0, 1e-7) << to_string(tag.patch) << " at " << p.transpose();
    const Vec3 centre = (p + mesh_.mesh.corner(t, 1) + mesh_.mesh.corner(t, 2)) / 3;
    const double step = mesh_.max_sag_mm[std::size_t(tag.patch)] + 0.02;
    EXPECT_LT(oracle.least_clearance(centre + step * normal), 0) << to_string(tag.patch);
    EXPECT_GT(oracle.least_clearance(centre - step * normal), 0) << to_string(tag.patch);
    ++tested;
  }
  EXPECT_GT(tested, 8u);
}

TEST_P(MeshTooth, FacetNormalsFollowTheExactNormals) {
  for (std::size_t t = 0; t < mesh_.tags.size(); ++t) {
    const mesh::TriangleTag& tag = mesh_.tags[t];
    if (!is_exact_patch(tag.patch)) continue;
    // A facet thinner than the sag says nothing about direction.
    const Vec3 area = mesh_.mesh.area_normal(t);
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, (mesh_.mesh.corner(t, k) - mesh_.mesh.corner(t, (k + 1) % 3)).norm());
    if (area.norm() / longest < 4 * mesh_.max_sag_mm[std::size_t(tag.patch)]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto exact = mesh::exact_patch_point(drawn_solid(gear_), tag.zone, tag.patch, tag.uv[k]);
      ASSERT_GT(area.normalized().dot(exact->n), 0.8) << to_string(tag.patch) << " uv " << tag.uv[k].transpose();
    }
  }
}

// Ten times as many points in each direction as the mesh has, at parameters that the mesher never looked at.
TEST_P(MeshTooth, SagStaysBelowTheStatedBound) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::array<double, tooth_space::kSurfaces> seen{};
  const auto& m = mesh_.mesh;
  for (std::size_t t = 0; t < mesh_.tags.size(); t += 3) {
    const mesh::TriangleTag& tag = mesh_.tags[t];
    if (!is_exact_patch(tag.patch)) continue;
    const face_gear::FaceGearRing& ring = gear_.rings()[tag.zone];
    std::vector<std::size_t> near;
    const Vec3 low = m.corner(t, 0).cwiseMin(m.corner(t, 1)).cwiseMin(m.corner(t, 2)).array() - 0.1;
    const Vec3 high = m.corner(t, 0).cwiseMax(m.corner(t, 1)).cwiseMax(m.corner(t, 2)).array() + 0.1;
    for (std::size_t o = 0; o < mesh_.tags.size(); ++o) {
      const Vec3 o_low = m.corner(o, 0).cwiseMin(m.corner(o, 1)).cwiseMin(m.corner(o, 2));
      const Vec3 o_high = m.corner(o, 0).cwiseMax(m.corner(o, 1)).cwiseMax(m.corner(o, 2));
      if (is_exact_patch(mesh_.tags[o].patch) && (o_low.array() <= high.array()).all() &&
          (o_high.array() >= low.array()).all())
        near.push_back(o);
    }
    for (int n = 0; n < 50; ++n) {
      double a = unit(random), b = unit(random);
      if (a + b > 1) a = 1 - a, b = 1 - b;
      const Vec2 uv = tag.uv[0] + a * (tag.uv[1] - tag.uv[0]) + b * (tag.uv[2] - tag.uv[0]);
      const auto exact = mesh::exact_patch_point(drawn_solid(gear_), tag.zone, tag.patch, uv);
      ASSERT_TRUE(exact);
      const double r = std::hypot(exact->p.x(), exact->p.y());
      if (r < ring.zone.inner_radius_mm || r > ring.zone.outer_radius_mm) continue;
      if (tag.patch != tooth_space::Piece::tip && exact->p.z() > ring.surface.z_tip(r))
        continue;  // beyond the tip edge
      double best = INFINITY;
      for (const std::size_t o : near)
        best = std::min(best, distance_to_triangle(exact->p, m.corner(o, 0), m.corner(o, 1), m.corner(o, 2)));
      seen[std::size_t(tag.patch)] = std::max(seen[std::size_t(tag.patch)], best);
    }
  }
  for (std::size_t p = 0; p < tooth_space::kSurfaces; ++p) {
    EXPECT_LE(seen[p], mesh_.max_sag_mm[p] + 1e-12) << to_string(tooth_space::Piece(p));
    EXPECT_LE(mesh_.max_sag_mm[p], mesh_.tolerance_mm) << to_string(tooth_space::Piece(p));
  }
  const double worst_seen = *std::max_element(seen.begin(), seen.end());
  EXPECT_GT(worst_seen, 0.3 * mesh_.max_sag()) << "the bound is far above what is there";
}

TEST_P(MeshTooth, NeighboursShareTheirBorderBitForBit) {
  std::size_t border = 0;
  for (std::size_t v = 0; v < mesh_.mesh.vertices.size(); ++v) {
    const auto from = mesh_.turned_from[v];
    if (from < 0) continue;
    ++border;
    EXPECT_EQ(mesh_.mesh.vertices[v], mesh::turned_by_pitches(mesh_.mesh.vertices[std::size_t(from)], 1, mesh_.teeth));
    for (const int k : {0, 1, mesh_.teeth / 2, mesh_.teeth - 1})
      EXPECT_EQ(mesh_.vertex_of_copy(v, k), mesh_.vertex_of_copy(std::size_t(from), k + 1));
  }
  EXPECT_GT(border, 5u);
}

INSTANTIATE_TEST_SUITE_P(Samples, MeshTooth, testing::ValuesIn(mesh_samples()), sample_name);

TEST(MeshToothRefuses, ToleranceOutsideItsRange) {
  const face_gear::FaceGear gear = made(spur_parameters());
  for (const double t :
       {0.0, -1.0, 1e-5, 11.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const auto mesh = mesh::mesh_tooth_space(drawn_solid(gear), t);
    ASSERT_FALSE(mesh) << t;
    EXPECT_EQ(mesh.error().message, fmt::format("mesh tolerance = {:g} mm is outside 0.0001 .. 10 mm", t));
  }
}

TEST(MeshToothSpace, FinerToleranceGivesMoreTrianglesAndLessSag) {
  const face_gear::FaceGear gear = made(double_helical_parameters());
  const mesh::ToothMesh coarse = meshed(gear, 0.02), fine = meshed(gear, 0.002);
  EXPECT_LE(fine.max_sag(), 0.002);
  EXPECT_GT(fine.mesh.triangles.size(), 4 * coarse.mesh.triangles.size());
}

TEST(MeshToothSpace, CoarseGridsAreRefinedUntilTheyHoldTheTolerance) {
  // On so short a ring most steps of refinement change no cell: it takes 13 of them.
  auto p = offset_gear();
  p.teeth = 160;
  p.shaper_teeth = 23;
  p.module_mm = 0.87;
  p.module_plane = face_gear::ModulePlane::normal;
  p.offset_mm = 9.28;
  p.shaper_tip_radius_mm = 0.0559;
  p.zones = {{0, 75.556, 76.426}};
  const auto gear = made(p);
  const auto mesh = mesh::mesh_tooth_space(drawn_solid(gear), 0.002);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_LE(mesh->max_sag(), 0.002);
}

TEST(MeshToothSpace, SameInputSameBits) {
  const face_gear::FaceGear gear = made(spur_parameters());
  const mesh::ToothMesh a = meshed(gear, 0.02), b = meshed(gear, 0.02);
  EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
}

TEST(MeshToothSpace, DisplayMeshOfTheLargeGearStaysSmall) {
  const mesh::ToothMesh pitch = meshed(made(double_helical_parameters()), 0.01);
  EXPECT_LT(pitch.mesh.triangles.size() * 180, 1'500'000u);
}

}  // namespace
}  // namespace toothpath::test
