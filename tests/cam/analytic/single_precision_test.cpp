// Why the proof reckons in double precision: in single precision gouges of a micrometre pass for clean.
#include <gtest/gtest.h>

#include "cam/analytic/gear_distance.h"
#include "geometry/face_gear/part.h"
#include "geometry/mesh/tooth_mesh.h"
#include "tests/support/random.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

/// Distance from a point to a triangle, in single precision throughout.
float single_distance(const Eigen::Vector3f& c, const Eigen::Vector3f& a, const Eigen::Vector3f& b,
                      const Eigen::Vector3f& d) {
  const Eigen::Vector3f n = (b - a).cross(d - a).normalized();
  const float height = (c - a).dot(n);
  const Eigen::Vector3f foot = c - n * height;
  if ((b - a).cross(foot - a).dot(n) >= 0 && (d - b).cross(foot - b).dot(n) >= 0 && (a - d).cross(foot - d).dot(n) >= 0)
    return std::abs(height);
  const auto edge = [&](const Eigen::Vector3f& p, const Eigen::Vector3f& q) {
    const float t = std::clamp((c - p).dot(q - p) / (q - p).squaredNorm(), 0.0F, 1.0F);
    return (c - p - t * (q - p)).norm();
  };
  return std::min({edge(a, b), edge(b, d), edge(d, a)});
}

/// The same question put to float32 facets alone, as a mesh-based check puts it: gouges of 1 um pass for clean.
TEST(Proof, SinglePrecisionFacetsWouldMissAMicrometre) {
  const face_gear::FaceGear gear = made(quarter_dhfg());
  const analytic::GearDistance part(face_gear::part_of(gear), 1.0);
  const auto pitch = mesh::mesh_tooth_space(drawn_solid(gear), 0.01);
  ASSERT_TRUE(pitch);
  std::vector<Eigen::Vector3f> v;
  for (const auto& p : pitch->mesh.vertices) v.push_back(p.cast<float>());
  const double R = 0.25, depth = 0.001;
  Random random(3);
  int missed = 0, asked = 0;
  for (int k = 0; k < 4000 && asked < 60; ++k) {
    const std::size_t t = random.index(pitch->tags.size());
    if (!is_flank(pitch->tags[t].patch)) continue;
    const auto& uv = pitch->tags[t].uv;
    const auto q = mesh::exact_patch_point(drawn_solid(gear), pitch->tags[t].zone, pitch->tags[t].patch,
                                           (uv[0] + uv[1] + uv[2]) / 3);
    if (!q) continue;
    const Vec3 c = q->p + (R - depth) * q->n;
    if (std::abs(part.nearest(c, R + 0.1).distance - (R - depth)) > 1e-9) continue;  // another surface is nearer
    ++asked;
    float least = INFINITY;
    for (const auto& triangle : pitch->mesh.triangles) {
      const auto at = [&](std::size_t n) { return v[std::size_t(triangle[n])]; };
      least = std::min(least, single_distance(c.cast<float>(), at(0), at(1), at(2)));
    }
    missed += least >= float(R);  // "no gouge"
  }
  EXPECT_GE(asked, 40);
  EXPECT_GE(missed, 1);
  RecordProperty("missed", missed);
}

/// Distance of a ball's centre from the plane of a facet that touches the surface at the foot, all in single precision:
/// no sag of facets is left, only the arithmetic at 300 mm.
TEST(SinglePrecision, MissesAGougeAtThreeHundredMillimetres) {
  const face_gear::FaceGear gear = made(transverse_gear(200, 30, 3, 0.9, {{0, 304, 318}}));
  const analytic::GearDistance part(face_gear::part_of(gear), 1.5);
  const double R = 0.8, limit = 0.002;
  Random random(8);
  int planted = 0, missed = 0, found = 0;
  const auto& cells = part.cells(0);
  for (int k = 0; k < 4000 && planted < 200; ++k) {
    const auto& cell = cells[random.index(cells.size())];
    if (!cell.sheet) continue;
    const auto q = part.space(0).at(cell.piece, cell.u, cell.v);
    if (!q) continue;
    const double depth = limit + random(1e-6, 3e-5);  // a gouge just beyond the limit
    const double turn = gear.pitch() * double(random.index(200));
    const auto placed = [&](const Vec3& x) { return turned(x, turn); };
    const Vec3 c = placed(q->p + (R - depth) * q->n);
    if (std::abs(part.nearest(c, R + 0.1).distance - (R - depth)) > 1e-8) continue;  // another surface is nearer
    ++planted;
    found += R - part.nearest(c, R + 0.1).distance > limit;
    const Vec3 e = q->pu.normalized(), f = q->n.cross(e);
    const Eigen::Vector3f a = placed(q->p + 0.2 * e).cast<float>(), b = placed(q->p - 0.1 * e + 0.17 * f).cast<float>(),
                          d = placed(q->p - 0.1 * e - 0.17 * f).cast<float>(), ball = c.cast<float>();
    const float height = std::abs((ball - a).dot((b - a).cross(d - a).normalized()));
    missed += float(R) - height <= float(limit);
  }
  EXPECT_GE(planted, 100);
  EXPECT_EQ(found, planted);
  EXPECT_GE(missed, 1);
  RecordProperty("planted", planted);
  RecordProperty("missed_in_single_precision", missed);
}

}  // namespace
}  // namespace toothpath::test
