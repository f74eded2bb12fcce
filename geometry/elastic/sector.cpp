#include "geometry/elastic/sector.h"

#include <algorithm>
#include <cmath>

namespace toothpath::elastic {
namespace {

/// The level lines dip between the feet, so that bricks keep an angle where the fillet runs into the root.
constexpr double kDip = 0.18;  // of the width of the foot

/// The smallest determinant of the map of a brick at its 27 Gauss points; <= 0: it is folded.
double least_jacobian(const BrickNodes& nodes) {
  const GaussRule& rule = gauss_rule(3);
  double least = INFINITY;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t k = 0; k < 3; ++k) {
        const Mat3 map = nodes * brick_gradients(rule.x[i], rule.x[j], rule.x[k]).transpose();
        least = std::min(least, map.determinant());
      }
  return least;
}

class SectorBuilder {
 public:
  SectorBuilder(const SectorPlan& plan, const std::vector<ToothSection>& sections, bool load_high)
      : plan_(plan), sections_(sections), load_high_(load_high) {
    columns_ = 2 * (plan.across + 2 * plan.land);
    left_ = 2 * plan.land;
    right_ = left_ + 2 * plan.across;
    foot_ = 2 * plan.rim;
    top_ = foot_ + 2 * (plan.flank + plan.fillet);
    stations_ = 2 * plan.face;
  }

  [[nodiscard]] bool inside(int u, int v) const { return v <= foot_ || (u >= left_ && u <= right_); }

  /// (angle, height) of a lattice place of a section.
  [[nodiscard]] Vec2 at(const ToothSection& s, int u, int v) const {
    if (v >= foot_) return upper(s, u, v);
    const Vec2 start = upper(s, u, foot_);
    static constexpr double grade[4] = {0, 0.18, 0.45, 1};
    const double bottom = s.root - plan_.rim_mm, layer = double(foot_ - v) / 2;
    double depth = layer / plan_.rim;
    if (plan_.rim == 3) {
      const int k = std::min(2, static_cast<int>(layer));
      depth = grade[k] + (grade[k + 1] - grade[k]) * (layer - k);
    }
    return {start.x(), start.y() + (bottom - start.y()) * depth};
  }

  Sector build(double pitch, const Vec3& axis, const SectionMap& map) {
    Sector out;
    out.pitch = Eigen::AngleAxisd(pitch, axis).toRotationMatrix();
    out.foot = foot_;
    place_nodes(out, map);
    make_bricks(out);
    make_stations(out);
    return out;
  }

 private:
  [[nodiscard]] int& node(int u, int v, int w) {
    return ids_[static_cast<std::size_t>((w * (top_ + 1) + v) * (columns_ + 1) + u)];
  }

  /// Share of the way across at a node column between the flanks.
  [[nodiscard]] double share(int u) const {
    const auto even = [&](int k) {
      const double x = double(k) / plan_.across;
      if (plan_.grading == 1) return x;
      return load_high_ ? 1 - std::pow(1 - x, plan_.grading) : std::pow(x, plan_.grading);
    };
    const int k = u - left_;
    return k % 2 == 0 ? even(k / 2) : (even(k / 2) + even(k / 2 + 1)) / 2;
  }

  [[nodiscard]] Vec2 upper(const ToothSection& s, int u, int v) const {
    const auto level = static_cast<std::size_t>(top_ - v);
    const Vec2 &low = s.low[level], &high = s.high[level];
    if (u < left_) {
      const double x = double(u) / left_;
      return Vec2(s.angle_low, s.root) * (1 - x) + low * x;
    }
    if (u > right_) {
      const double x = double(u - right_) / left_;
      return high * (1 - x) + Vec2(s.angle_high, s.root) * x;
    }
    const double x = share(u), fillet = std::max(0.0, double(top_ - v - 2 * plan_.flank) / (2 * plan_.fillet));
    Vec2 p = low * (1 - x) + high * x;
    p.y() -= dip_ * fillet * fillet * 4 * x * (1 - x);
    return p;
  }

  void place_nodes(Sector& out, const SectionMap& map) {
    ids_.assign(static_cast<std::size_t>((stations_ + 1) * (top_ + 1) * (columns_ + 1)), -1);
    for (int w = 0; w <= stations_; ++w) {
      const ToothSection& s = sections_[static_cast<std::size_t>(w)];
      dip_ = kDip * (map(w, s.high.back()) - map(w, s.low.back())).norm();
      for (int v = 0; v <= top_; ++v)
        for (int u = 0; u <= columns_; ++u) {
          if (!inside(u, v) || (u & 1) + (v & 1) + (w & 1) > 1) continue;
          node(u, v, w) = static_cast<int>(out.nodes.size());
          out.nodes.push_back(map(w, at(s, u, v)));
          out.lattice.push_back({u, v, w});
          if (v == 0) out.held.push_back(node(u, v, w));
          if (u == 0) out.low_cut.push_back(node(u, v, w));
          if (u == columns_) out.high_cut.push_back(node(u, v, w));
        }
    }
  }

  void make_bricks(Sector& out) {
    out.least_jacobian = 1e300;
    brick_at_.assign(static_cast<std::size_t>(plan_.face * (top_ / 2) * (columns_ / 2)), -1);
    // The lattice may be left-handed in space: then its last direction is read backwards.
    const Vec3 o = out.nodes[static_cast<std::size_t>(node(left_, foot_, 0))];
    const auto from_o = [&](int u, int v, int w) {
      return Vec3(out.nodes[static_cast<std::size_t>(node(left_ + u, foot_ + v, w))] - o);
    };
    const int hand = from_o(2, 0, 0).cross(from_o(0, 2, 0)).dot(from_o(0, 0, 2)) > 0 ? 1 : -1;
    for (int w = 1; w < stations_; w += 2)
      for (int v = 1; v < top_; v += 2)
        for (int u = 1; u < columns_; u += 2) {
          if (v > foot_ && (u < left_ || u > right_)) continue;
          std::array<int, kBrickNodes> brick{};
          BrickNodes x;
          for (int n = 0; n < kBrickNodes; ++n) {
            const auto& p = brick_places()[static_cast<std::size_t>(n)];
            brick[static_cast<std::size_t>(n)] = node(u + p[0], v + p[1], w + hand * p[2]);
            x.col(n) = out.nodes[static_cast<std::size_t>(brick[static_cast<std::size_t>(n)])];
          }
          out.least_jacobian = std::min(out.least_jacobian, least_jacobian(x));
          brick_at_[static_cast<std::size_t>(((w / 2) * (top_ / 2) + v / 2) * (columns_ / 2) + u / 2)] =
              static_cast<int>(out.bricks.size());
          out.bricks.push_back(brick);
        }
  }

  void make_stations(Sector& out) {
    const int u = load_high_ ? right_ : left_;
    out.rows = plan_.flank + 1;
    out.columns = plan_.face + 1;
    for (int r = 0; r < out.rows; ++r)
      for (int c = 0; c < out.columns; ++c) out.stations.push_back(node(u, top_ - 2 * r, 2 * c));
    out.normals.assign(out.stations.size(), Vec3::Zero());
    out.flank_face = load_high_ ? 1 : -1;
    const Vec3 inside = out.nodes[static_cast<std::size_t>(node(load_high_ ? left_ : right_, top_, 0))] -
                        out.nodes[static_cast<std::size_t>(node(u, top_, 0))];
    for (int r = 0; r + 1 < out.rows; ++r)
      for (int c = 0; c + 1 < out.columns; ++c) {
        const int v = top_ - 2 * r, w = 2 * c, at = r * out.columns + c;
        // Both ways around; the one whose area points out is kept.
        StationFace one{{node(u, v, w), node(u, v, w + 2), node(u, v - 2, w + 2), node(u, v - 2, w), node(u, v, w + 1),
                         node(u, v - 1, w + 2), node(u, v - 2, w + 1), node(u, v - 1, w)},
                        {at, at + 1, at + out.columns + 1, at + out.columns}};
        const StationFace other{{one.nodes[0], one.nodes[3], one.nodes[2], one.nodes[1], one.nodes[7], one.nodes[6],
                                 one.nodes[5], one.nodes[4]},
                                {one.stations[0], one.stations[3], one.stations[2], one.stations[1]}};
        const auto area = [&](const StationFace& f, double a, double b) {
          FaceNodes x;
          for (int n = 0; n < kFaceNodes; ++n)
            x.col(n) = out.nodes[static_cast<std::size_t>(f.nodes[static_cast<std::size_t>(n)])];
          return face_place(x, a, b).area;
        };
        if (area(one, 0, 0).dot(inside) > 0) one = other;
        out.face_bricks.push_back(brick_at_[static_cast<std::size_t>(
            ((w / 2) * (top_ / 2) + (v / 2 - 1)) * (columns_ / 2) + (load_high_ ? u / 2 - 1 : u / 2))]);
        static constexpr double ca[4] = {-1, 1, 1, -1}, cb[4] = {-1, -1, 1, 1};
        for (int n = 0; n < 4; ++n)
          out.normals[static_cast<std::size_t>(one.stations[static_cast<std::size_t>(n)])] +=
              area(one, ca[n], cb[n]).normalized();
        out.faces.push_back(one);
      }
    for (auto& n : out.normals) n.normalize();
  }

  const SectorPlan& plan_;
  const std::vector<ToothSection>& sections_;
  bool load_high_;
  int columns_ = 0, left_ = 0, right_ = 0, foot_ = 0, top_ = 0, stations_ = 0;
  double dip_ = 0;
  std::vector<int> ids_, brick_at_;
};

}  // namespace

Result<Sector> make_sector(const SectorPlan& plan, const std::vector<ToothSection>& sections, bool load_high,
                           double pitch, const Vec3& axis, const SectionMap& map) {
  const auto levels = static_cast<std::size_t>(2 * (plan.flank + plan.fillet) + 1);
  if (sections.size() != static_cast<std::size_t>(2 * plan.face + 1)) return fail("sections do not fit the plan");
  for (const auto& s : sections)
    if (s.low.size() != levels || s.high.size() != levels) return fail("levels of a section do not fit the plan");
  SectorBuilder builder(plan, sections, load_high);
  Sector sector = builder.build(pitch, axis, map);
  if (!(sector.least_jacobian > 0))
    return fail(
        "a brick of the tooth is folded ({} along the fillet, least Jacobian {:.3g} mm^3): more along the "
        "fillet are needed",
        plan.fillet, sector.least_jacobian);
  return sector;
}

SectorRow sector_row(const Sector& sector, int teeth) {
  SectorRow row;
  std::vector<int> at_low(sector.nodes.size(), -1);
  for (std::size_t n = 0; n < sector.low_cut.size(); ++n)
    at_low[static_cast<std::size_t>(sector.low_cut[n])] = static_cast<int>(n);
  std::vector<char> held(sector.nodes.size(), 0);
  for (const int n : sector.held) held[static_cast<std::size_t>(n)] = 1;
  Mat3 turn = Mat3::Identity();
  for (int t = 0; t < teeth; ++t, turn = sector.pitch * turn) {
    std::vector<int> id(sector.nodes.size(), -1);
    for (std::size_t n = 0; n < sector.nodes.size(); ++n) {
      if (t > 0 && at_low[n] >= 0) {
        id[n] = row.node_of.back()[static_cast<std::size_t>(sector.high_cut[static_cast<std::size_t>(at_low[n])])];
        continue;
      }
      id[n] = static_cast<int>(row.nodes.size());
      row.nodes.push_back(turn * sector.nodes[n]);
      if (held[n]) row.held.push_back(id[n]);
    }
    for (const auto& brick : sector.bricks) {
      auto moved = brick;
      for (int& n : moved) n = id[static_cast<std::size_t>(n)];
      row.bricks.push_back(moved);
    }
    row.node_of.push_back(std::move(id));
  }
  for (const int n : sector.low_cut)
    if (!held[static_cast<std::size_t>(n)]) row.held.push_back(row.node_of.front()[static_cast<std::size_t>(n)]);
  for (const int n : sector.high_cut)
    if (!held[static_cast<std::size_t>(n)]) row.held.push_back(row.node_of.back()[static_cast<std::size_t>(n)]);
  return row;
}

}  // namespace toothpath::elastic
