// Meshes for tests: scattered triangles, boxes, balls.
#pragma once

#include <cmath>

#include "geometry/mesh/triangle_mesh.h"
#include "tests/support/random.h"

namespace toothpath::test {

/// Triangles of sides up to about `side` in a cube of half width `room`; an open soup.
inline mesh::TriangleMesh scattered(Random& random, std::size_t count, double room, double side) {
  mesh::TriangleMesh mesh;
  for (std::size_t k = 0; k < count; ++k) {
    const Vec3 a = random.vector(room);
    const auto n = std::int32_t(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, a + random.vector(side), a + random.vector(side)});
    mesh.triangles.push_back({n, n + 1, n + 2});
  }
  return mesh;
}

inline void append(mesh::TriangleMesh& mesh, const mesh::TriangleMesh& other) {
  const auto n = std::int32_t(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
}

inline mesh::TriangleMesh box(const Vec3& low, const Vec3& high) {
  mesh::TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back({k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z()});
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

/// A ball as n bands from pole to pole, closed, normals outwards.
inline mesh::TriangleMesh ball(const Vec3& centre, double radius, int n) {
  mesh::TriangleMesh mesh;
  const int m = 2 * n;
  mesh.vertices.push_back(centre - radius * Vec3::UnitZ());
  for (int i = 1; i < n; ++i)
    for (int k = 0; k < m; ++k) {
      const double polar = M_PI * i / n, turn = 2 * M_PI * k / m;
      mesh.vertices.push_back(
          centre + radius * Vec3(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), -std::cos(polar)));
    }
  mesh.vertices.push_back(centre + radius * Vec3::UnitZ());
  const auto at = [&](int i, int k) { return std::int32_t(1 + (i - 1) * m + k % m); };
  const auto top = std::int32_t(mesh.vertices.size() - 1);
  for (int k = 0; k < m; ++k) {
    mesh.triangles.push_back({0, at(1, k + 1), at(1, k)});
    for (int i = 1; i + 1 < n; ++i) {
      mesh.triangles.push_back({at(i, k), at(i, k + 1), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i + 1, k)});
    }
    mesh.triangles.push_back({top, at(n - 1, k), at(n - 1, k + 1)});
  }
  return mesh;
}

}  // namespace toothpath::test
