#include "cam/clearance/tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace toothpath::clearance {
namespace {

constexpr double kRounding = 1e-9;  // mm: added to the half widths of the blocks' own boxes
constexpr double kFar = 1e150;      // mm: where empty lanes stand; its square is finite

Vec3 any_normal_to(const Vec3& u) {
  Vec3 e = Vec3::Zero();
  Eigen::Index least = 0;
  u.cwiseAbs().minCoeff(&least);
  e[least] = 1;
  return u.cross(e).normalized();
}

/// Directions along which the corners of some triangles lie flat: mean normal, then the longest reach across it.
std::array<Vec3, 3> directions(const mesh::TriangleMesh& mesh, const std::uint32_t* triangle, std::size_t count) {
  Vec3 n = Vec3::Zero(), longest = Vec3::Zero();
  for (std::size_t k = 0; k < count; ++k) n += mesh.area_normal(triangle[k]);
  n = n.norm() > 1e-12 ? Vec3(n.normalized()) : Vec3(Vec3::UnitZ());
  const Vec3& first = mesh.corner(triangle[0], 0);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t c = 0; c < 3; ++c) {
      Vec3 d = mesh.corner(triangle[k], c) - first;
      d -= d.dot(n) * n;
      if (d.squaredNorm() > longest.squaredNorm()) longest = d;
    }
  const Vec3 u = longest.norm() > 1e-12 ? Vec3(longest.normalized()) : any_normal_to(n);
  return {n, u, n.cross(u).normalized()};
}

}  // namespace

MeshTree::MeshTree(const mesh::TriangleMesh& mesh) : mesh_(&mesh), count_(mesh.triangles.size()) {
  if (count_ == 0) return;
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  centroids_.resize(count_);
  for (std::size_t t = 0; t < count_; ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      low = low.cwiseMin(mesh.corner(t, c));
      high = high.cwiseMax(mesh.corner(t, c));
    }
    centroids_[t] = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
  }
  origin_ = 0.5 * (low + high);
  sorted_.resize(count_);
  std::iota(sorted_.begin(), sorted_.end(), 0U);
  blocks_.reserve(count_ / kLanes + 1);
  boxes_.reserve(count_ / kLanes + 1);
  if (count_ <= std::size_t(kLanes)) {  // the root is always a node
    nodes_.emplace_back();
    MeshNode node;
    for (int lane = 0; lane < kLanes; ++lane) {
      node.child[lane] = 0;
      for (auto* side : {node.low, node.high})
        for (int k = 0; k < 3; ++k) side[k][lane] = kFar;
    }
    Vec3 l, h;
    node.child[0] = block_of({0, count_}, l, h);
    for (int k = 0; k < 3; ++k) {
      node.low[k][0] = l[k];
      node.high[k][0] = h[k];
    }
    nodes_[0] = node;
  } else {
    build({0, count_}, low, high);
  }
  centroids_ = {};
  sorted_ = {};
  mesh_ = nullptr;
}

/// Halves a range at the median of the centroids along their longest extent; the left part fills whole blocks.
std::size_t MeshTree::split(Range range) {
  Vec3 low = Vec3::Constant(INFINITY), high = -low;
  for (std::size_t k = range.from; k < range.to; ++k) {
    low = low.cwiseMin(centroids_[sorted_[k]]);
    high = high.cwiseMax(centroids_[sorted_[k]]);
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const std::size_t blocks = (range.to - range.from + kLanes - 1) / kLanes;
  const std::size_t middle = range.from + kLanes * (blocks / 2);
  std::nth_element(sorted_.begin() + std::ptrdiff_t(range.from), sorted_.begin() + std::ptrdiff_t(middle),
                   sorted_.begin() + std::ptrdiff_t(range.to), [&](std::uint32_t x, std::uint32_t y) {
                     const double a = centroids_[x][axis], b = centroids_[y][axis];
                     return a != b ? a < b : x < y;
                   });
  return middle;
}

std::int32_t MeshTree::build(Range range, Vec3& low, Vec3& high) {
  if (range.to - range.from <= std::size_t(kLanes)) return block_of(range, low, high);
  std::vector<Range> parts = {range};
  while (parts.size() < std::size_t(kLanes)) {  // always the largest part
    const auto largest = std::max_element(parts.begin(), parts.end(),
                                          [](const Range& a, const Range& b) { return a.to - a.from < b.to - b.from; });
    const Range part = *largest;
    if (part.to - part.from <= std::size_t(kLanes)) break;
    const std::size_t middle = split(part);
    *largest = {part.from, middle};
    parts.push_back({middle, part.to});
  }
  const std::size_t index = nodes_.size();
  nodes_.emplace_back();
  MeshNode node;
  low = Vec3::Constant(INFINITY);
  high = -low;
  for (int lane = 0; lane < kLanes; ++lane) {
    Vec3 l = Vec3::Constant(kFar), h = l;
    node.child[lane] = 0;
    if (std::size_t(lane) < parts.size()) {
      node.child[lane] = build(parts[std::size_t(lane)], l, h);
      low = low.cwiseMin(l);
      high = high.cwiseMax(h);
    }
    for (int k = 0; k < 3; ++k) {
      node.low[k][lane] = l[k];
      node.high[k][lane] = h[k];
    }
  }
  nodes_[index] = node;
  return std::int32_t(index);
}

std::int32_t MeshTree::block_of(Range range, Vec3& low, Vec3& high) {
  const std::size_t index = blocks_.size(), count = range.to - range.from;
  TriangleBlock block;
  low = Vec3::Constant(INFINITY);
  high = -low;
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::uint32_t t = sorted_[range.from + (std::size_t(lane) < count ? std::size_t(lane) : 0)];
    order_.push_back(t);
    const Vec3 a = mesh_->corner(t, 0) - origin_, b = mesh_->corner(t, 1) - origin_, c = mesh_->corner(t, 2) - origin_;
    low = low.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    high = high.cwiseMax(a).cwiseMax(b).cwiseMax(c);
    const Vec3 ab = b - a, ac = c - a;
    for (int k = 0; k < 3; ++k) {
      block.a[k][lane] = a[k];
      block.ab[k][lane] = ab[k];
      block.ac[k][lane] = ac[k];
    }
    const auto inverse = [](double x) { return x > 1e-200 ? 1 / x : 0.0; };
    const double g11 = ab.squaredNorm(), g12 = ab.dot(ac), g22 = ac.squaredNorm(), det = ab.cross(ac).squaredNorm();
    block.g11[lane] = g11;
    block.g12[lane] = g12;
    block.g22[lane] = g22;
    block.inverse_ab[lane] = inverse(g11);
    block.inverse_ac[lane] = inverse(g22);
    block.inverse_bc[lane] = inverse((ac - ab).squaredNorm());
    block.inverse_det[lane] = det > 1e-24 * g11 * g22 ? inverse(det) : 0.0;
  }
  blocks_.push_back(block);

  const auto axes = directions(*mesh_, &sorted_[range.from], count);
  BlockBox box{};
  Vec3 centre = Vec3::Zero();
  for (int d = 0; d < 3; ++d) {
    const Vec3& axis = axes[std::size_t(d)];
    double least = INFINITY, greatest = -INFINITY;
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < 3; ++c) {
        const double x = axis.dot(mesh_->corner(sorted_[range.from + k], c) - origin_);
        least = std::min(least, x);
        greatest = std::max(greatest, x);
      }
    centre += 0.5 * (least + greatest) * axis;
    box.half[d] = 0.5 * (greatest - least) + kRounding;
    for (int k = 0; k < 3; ++k) box.axis[d][k] = axis[k];
  }
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      box.radius =
          std::max(box.radius, (mesh_->corner(sorted_[range.from + k], c) - origin_ - centre).norm() + kRounding);
  for (int k = 0; k < 3; ++k) box.centre[k] = centre[k];
  boxes_.push_back(box);
  return ~std::int32_t(index);
}

}  // namespace toothpath::clearance
