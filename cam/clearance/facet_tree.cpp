#include "cam/clearance/facet_tree.h"

namespace toothpath::clearance {
namespace {

mesh::TriangleMesh mesh_of(std::span<const Facet> facets) {
  mesh::TriangleMesh mesh;
  mesh.vertices.reserve(3 * facets.size());
  mesh.triangles.reserve(facets.size());
  for (const auto& facet : facets) {
    const auto first = std::int32_t(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), facet.corner.begin(), facet.corner.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace

FacetTree::FacetTree(std::span<const Facet> facets) : tree_(mesh_of(facets)) {
  owner_.reserve(facets.size());
  for (const auto& facet : facets) owner_.push_back(facet.owner);
}

std::span<const BlockHit> FacetTree::gather(const Vec3& p, double within, double slack, std::span<BlockHit> few,
                                            std::vector<BlockHit>& many) const {
  if (owner_.empty() || !(within > 0)) return {};
  const Vec3 at = p - tree_.origin();
  const auto& kernels = mesh_kernels();
  const std::size_t count = kernels.near(view(), at.data(), within * within, slack, few.data(), few.size());
  if (count <= few.size()) return few.first(count);
  many.resize(count);
  (void)kernels.near(view(), at.data(), within * within, slack, many.data(), many.size());
  return many;
}

double FacetTree::least(const Vec3& p, double within) const {
  if (owner_.empty() || !(within > 0)) return within;
  const Vec3 at = p - tree_.origin();
  return std::sqrt(mesh_kernels().nearest(view(), at.data(), within * within, {}).squared);
}

double FacetTree::least_along(const Vec3& from, const Vec3& axis, double length, double within) const {
  if (owner_.empty() || !(within > 0)) return within;
  const Vec3 at = from - tree_.origin();
  const CapsuleView line{{at.x(), at.y(), at.z()}, {axis.x(), axis.y(), axis.z()}, length};
  return std::sqrt(mesh_kernels().along(view(), line, within * within));
}

}  // namespace toothpath::clearance
