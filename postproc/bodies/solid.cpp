#include "postproc/bodies/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace toothpath::bodies {
namespace {

constexpr double kSameAxis = 1e-9;  // mm and sine: axes of pieces that are one

machines::Place inverse(const machines::Place& p) { return {p.turn.transpose(), -(p.turn.transpose() * p.shift)}; }

/// Lowest vertex number of every connected part, one a vertex.
std::vector<int> parts_of(const mesh::TriangleMesh& mesh) {
  std::vector<int> part(mesh.vertices.size());
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&](int k) {
    while (part[std::size_t(k)] != k) k = part[std::size_t(k)] = part[std::size_t(part[std::size_t(k)])];
    return k;
  };
  for (const auto& t : mesh.triangles)
    for (const int corner : {t[1], t[2]}) {
      const int a = root(t[0]), b = root(corner);
      part[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  for (std::size_t k = 0; k < part.size(); ++k) part[k] = root(int(k));
  return part;
}

std::optional<std::pair<Vec3, Vec3>> common_axis(const std::vector<Convex>& pieces) {
  std::optional<std::pair<Vec3, Vec3>> axis;
  for (const Convex& piece : pieces) {
    const auto* cone = std::get_if<Cone>(&piece);
    if (!cone) return std::nullopt;
    if (!axis) axis = std::pair(cone->from, cone->axis);
    else if (axis->second.cross(cone->axis).norm() > kSameAxis ||
             axis->second.cross(cone->from - axis->first).norm() > kSameAxis)
      return std::nullopt;
  }
  return axis;
}

void add_extent(const Convex& piece, std::vector<Ball>& out) {
  if (const auto* box = std::get_if<Box>(&piece)) {
    for (int k = 0; k < 8; ++k)
      out.push_back({box->centre + Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1).cwiseProduct(box->half), 0});
  } else if (const auto* cone = std::get_if<Cone>(&piece)) {
    out.push_back({cone->from, cone->radius_from});
    out.push_back({cone->from + cone->length * cone->axis, cone->radius_to});
  }
}

}  // namespace

Solid::Solid(std::vector<Convex> pieces) : pieces_(std::move(pieces)) {
  for (const Convex& piece : pieces_) {
    add_extent(piece, extent_);
    anchors_.push_back(middle(piece));
  }
  axis_ = common_axis(pieces_);
  std::vector<int> all(pieces_.size());
  std::iota(all.begin(), all.end(), 0);
  build(all);
}

Solid::Solid(const mesh::TriangleMesh& mesh) : mesh_(std::make_shared<clearance::MeshDistance>(mesh)) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    pieces_.emplace_back(Triangle{{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)}});
  const std::vector<int> part = parts_of(mesh);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    extent_.push_back({mesh.vertices[k], 0});
    if (part[k] == int(k)) anchors_.push_back(mesh.vertices[k]);
  }
  std::vector<int> all(pieces_.size());
  std::iota(all.begin(), all.end(), 0);
  build(all);
}

void Solid::build(std::vector<int>& pieces) {
  nodes_.reserve(2 * pieces.size());
  (void)build(std::span<int>(pieces));
}

int Solid::build(std::span<int> pieces) {
  const int index = int(nodes_.size());
  nodes_.emplace_back();
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const int k : pieces) {
    const Box box = box_of(pieces_[std::size_t(k)]);
    low = low.cwiseMin(box.centre - box.half);
    high = high.cwiseMax(box.centre + box.half);
  }
  // Rounding of the middle of a box leaves none of its corners out.
  const Vec3 half = (high - low) / 2 + Vec3::Constant(1e-12 * (1 + low.norm() + high.norm()));
  nodes_[std::size_t(index)].box = Box{(low + high) / 2, half};
  if (pieces.size() == 1) {
    nodes_[std::size_t(index)].piece = pieces.front();
    return index;
  }
  Eigen::Index widest = 0;
  (high - low).maxCoeff(&widest);
  const auto half_way = pieces.begin() + std::ptrdiff_t(pieces.size() / 2);
  std::nth_element(pieces.begin(), half_way, pieces.end(), [&](int a, int b) {
    const double x = middle(pieces_[std::size_t(a)])[widest], y = middle(pieces_[std::size_t(b)])[widest];
    return x != y ? x < y : a < b;
  });
  const int left = build(pieces.first(pieces.size() / 2));
  const int right = build(pieces.subspan(pieces.size() / 2));
  nodes_[std::size_t(index)].left = left;
  nodes_[std::size_t(index)].right = right;
  return index;
}

Vec3 Solid::farthest(const Vec3& direction) const {
  Vec3 best = bodies::farthest(pieces_.front(), direction);
  for (const Convex& piece : pieces_)
    if (const Vec3 p = bodies::farthest(piece, direction); p.dot(direction) > best.dot(direction)) best = p;
  return best;
}

bool Solid::holds(const Solid& other, const machines::Place& place) const {
  if (!mesh_) return false;
  const Box& box = std::get<Box>(nodes_.front().box);
  return std::any_of(other.anchors_.begin(), other.anchors_.end(), [&](const Vec3& anchor) {
    const Vec3 p = place.of(anchor);
    return ((p - box.centre).cwiseAbs() - box.half).maxCoeff() <= 0 && mesh_->inside(p);
  });
}

Gap Solid::gap_to(const Solid& other, const machines::Place& place, double within) const {
  struct Open {
    int a, b;
    double bound;
  };
  Gap out{within, std::numeric_limits<double>::infinity()};
  double limit = within;
  std::vector<Open> open = {{0, 0, 0.0}};
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    if (next.bound >= limit) continue;
    const Node &a = nodes_[std::size_t(next.a)], &b = other.nodes_[std::size_t(next.b)];
    const Gap found = gap(shape(a), other.shape(b), place, limit);
    if (found.proven >= limit) continue;
    if (a.piece >= 0 && b.piece >= 0) {
      out.proven = std::min(out.proven, found.proven);
      out.measured = std::min(out.measured, found.measured);
      limit = std::min(limit, out.measured);
      if (out.measured <= 0) return {0, 0};
      continue;
    }
    const bool split_a =
        b.piece >= 0 || (a.piece < 0 && std::get<Box>(a.box).half.sum() >= std::get<Box>(b.box).half.sum());
    if (split_a) {
      open.push_back({a.right, next.b, found.proven});
      open.push_back({a.left, next.b, found.proven});
    } else {
      open.push_back({next.a, b.right, found.proven});
      open.push_back({next.a, b.left, found.proven});
    }
  }
  if (out.proven > 0 && (holds(other, place) || other.holds(*this, inverse(place)))) return {0, 0};
  return out;
}

Solid solid_of(const machines::MachineBody& body, const mesh::TriangleMesh* mesh) {
  if (const auto* box = std::get_if<machines::BoxShape>(&body.shape))
    return Solid(std::vector<Convex>{Box{(box->low + box->high) / 2, (box->high - box->low) / 2}});
  if (const auto* cone = std::get_if<machines::ConeShape>(&body.shape)) {
    const Vec3 way = cone->to - cone->from;
    return Solid(
        std::vector<Convex>{Cone{cone->from, way.normalized(), way.norm(), cone->radius_from, cone->radius_to}});
  }
  return Solid(*mesh);
}

Overlap overlap(const Solid& a, const Solid& b, const machines::Place& place) {
  const auto depth = [&](const Vec3& n) {  // b moved along n
    return a.farthest(n).dot(n) - place.of(b.farthest(place.turn.transpose() * -n)).dot(n);
  };
  Overlap best{std::numeric_limits<double>::infinity(), Vec3::UnitZ()};
  const auto look = [&](const Vec3& n) {
    if (const double d = depth(n); d < best.depth_mm) best = {d, n};
  };
  for (int k = 0; k < 3; ++k)
    for (const double sign : {1.0, -1.0}) look(sign * Vec3::Unit(k));
  constexpr int kDirections = 400;  // a spiral over the sphere
  for (int k = 0; k < kDirections; ++k) {
    const double z = 1 - (2 * k + 1.0) / kDirections, r = std::sqrt(1 - z * z), turn = 2.399963229728653 * k;
    look(Vec3(r * std::cos(turn), r * std::sin(turn), z));
  }
  for (double step = 0.1; step > 1e-5; step /= 2) {
    const Vec3 n = best.direction, e = n.unitOrthogonal(), f = n.cross(e);
    for (const Vec3& side : {e, f, Vec3(-e), Vec3(-f)}) look((n + step * side).normalized());
  }
  best.depth_mm = std::max(0.0, best.depth_mm);
  return best;
}

}  // namespace toothpath::bodies
