// Brute force for finger mills: how deep the cutter, its shank or its holder is in a bevel gear, from sampled points
// alone. Knows the meridian of the cutter as a polyline and where its nominal passes run, neither an equation of
// meshing nor anything of the check.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "cam/finger/passes.h"
#include "cam/path/tool_motion.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::bevel_test {

struct BrutePose {
  Vec3 tip = Vec3::Zero(), axis = Vec3::UnitZ();
};
inline BrutePose pose_at(const path::ToolMotion& m, double t) {
  return {m.tip_from + t * (m.tip_to - m.tip_from), ((1 - t) * m.axis_from + t * m.axis_to).normalized()};
}

struct BruteDepth {
  double depth = -1e9;
  Vec3 place = Vec3::Zero();
  double t = 0;
};

/// The cutting part against what the nominal passes leave.
class BruteFinger {
 public:
  explicit BruteFinger(const bevel_gear::BevelGear& gear) : gear_(gear), h_f_(gear.parameters().dedendum_mm) {
    const auto& c = gear.cutter();
    constexpr int n = 4000;
    for (int k = 0; k <= n; ++k) {
      const auto q = c.at(c.p_A + (c.p_D - c.p_A) * k / n);
      line_.emplace_back(q.x + h_f_, q.rho);
    }
    for (const auto& pass : finger::wall_passes(gear, true))
      for (const auto& piece : pass.pieces) {
        constexpr int stations = 400;
        std::vector<Station> row;
        for (int k = 0; k <= stations; ++k) {
          const auto centre = piece.at(double(k) / stations);
          row.push_back({gear.tip(centre.R_c, centre.e), gear.axis(centre.e)});
        }
        pieces_.push_back({piece.at, std::move(row)});
      }
  }

  /// Distance of a point of the meridian, (height above the tip, radius), from the cutting part: negative inside.
  [[nodiscard]] double meridian_distance(double height, double rho) const {
    double best = INFINITY;
    const auto n = line_.size();
    // The polyline rises all along: from the point as high as this one, downhill to both sides.
    auto at = std::size_t(
        std::lower_bound(line_.begin(), line_.end(), height, [](const Vec2& a, double x) { return a.x() < x; }) -
        line_.begin());
    at = std::clamp<std::size_t>(at, 1, n - 1);
    const auto to = [&](std::size_t k) {
      const Vec2 d = line_[k] - line_[k - 1], q = Vec2(height, rho) - line_[k - 1];
      return (q - std::clamp(q.dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm();
    };
    best = to(at);
    std::size_t near = at;
    for (const std::size_t stride : {250, 50, 10, 2, 1})
      for (bool nearer = true; nearer;) {
        nearer = false;
        for (const std::size_t k : {near > stride ? near - stride : 1, std::min(near + stride, n - 1)})
          if (const double d = to(k); d < best) best = d, near = k, nearer = true;
      }
    if (rho <= line_.front().y()) best = std::min(best, std::abs(height));
    if (height > line_.back().x()) best = std::min(best, std::abs(rho - line_.back().y()));
    const double radius =
        height > line_.back().x()
            ? line_.back().y()
            : line_[at - 1].y() +
                  (line_[at].y() - line_[at - 1].y()) *
                      std::clamp((height - line_[at - 1].x()) / std::max(1e-15, line_[at].x() - line_[at - 1].x()), 0.0,
                                 1.0);
    return height > 0 && rho < radius ? -best : best;
  }
  [[nodiscard]] double distance(const Vec3& p, const BrutePose& pose) const {
    const Vec3 w = p - pose.tip;
    const double s = w.dot(pose.axis);
    return meridian_distance(s, (w - s * pose.axis).norm());
  }

  /// How far a point lies in what the nominal passes leave: > 0 in the material. Where it lies deeper than 0.02 mm in
  /// what they have cut, any such depth.
  [[nodiscard]] double material(const Vec3& p) const {
    double best = INFINITY;
    for (const auto& piece : pieces_) {
      std::size_t at = 0;
      double nearest = INFINITY;
      for (std::size_t k = 0; k < piece.stations.size(); k += 4) {
        const Station& s = piece.stations[k];
        const Vec3 w = p - s.tip;
        const double across = (w - w.dot(s.axis) * s.axis).norm();
        if (across < nearest) nearest = across, at = k;
      }
      if (nearest > 1.6 * line_.back().y()) continue;
      // The closest axis is near the contact, but not the contact: a first look on both sides, then narrower.
      const double count = double(piece.stations.size() - 1);
      double from = std::max(0.0, (double(at) - 60) / count), to = std::min(1.0, (double(at) + 60) / count);
      const auto d = [&](double t) {
        const auto c = piece.at(t);
        return distance(p, {gear_.tip(c.R_c, c.e), gear_.axis(c.e)});
      };
      for (int level = 0; level < 6; ++level) {
        if (best < -0.02) return best;
        double least = INFINITY, where = from;
        for (int k = 0; k <= 10; ++k)
          if (const double t = from + (to - from) * k / 10, v = d(t); v < least) least = v, where = t;
        best = std::min(best, least);
        const double width = (to - from) / 10;
        from = std::max(0.0, where - width), to = std::min(1.0, where + width);
      }
    }
    return best;
  }

  /// Does the point lie where there is a wall: on the face, outside the groove, between root and tip?
  [[nodiscard]] bool on_face(const Vec3& p, double slack = 0) const {
    const bevel_gear::ConePoint c = bevel_gear::cone_point(p, gear_.sin_delta(), gear_.cos_delta());
    if (c.height > gear_.parameters().addendum_mm + slack || c.height < -h_f_ - slack) return false;
    for (const auto& half : gear_.halves())
      if (c.ell >= half.ell_from - slack && c.ell <= half.ell_to + slack) return true;
    return false;
  }

  /// Deepest point of the cutter's own surface in the material at one pose: a first look over the meridian and all
  /// around, then narrower.
  [[nodiscard]] BruteDepth in_walls(const BrutePose& pose) const {
    const Vec3 e1 = pose.axis.unitOrthogonal(), e2 = pose.axis.cross(e1);
    BruteDepth best;
    double index = 0, turn = 0;
    const auto look = [&](double i, double phi) {
      i = std::clamp(i, 0.0, double(line_.size() - 1));
      const auto k = std::min(std::size_t(i), line_.size() - 2);
      const Vec2 q = line_[k] + (i - double(k)) * (line_[k + 1] - line_[k]);
      const Vec3 p = pose.tip + q.x() * pose.axis + q.y() * (std::cos(phi) * e1 + std::sin(phi) * e2);
      if (!on_face(p)) return;
      const double depth = material(p);
      if (depth > best.depth) best.depth = depth, best.place = p, index = i, turn = phi;
    };
    for (int i = 0; i <= 12; ++i)
      for (int j = 0; j < 36; ++j) look(double(line_.size() - 1) * i / 12, 2 * M_PI * j / 36);
    double along = double(line_.size()) / 12, around = 2 * M_PI / 36;
    for (int level = 0; level < 7; ++level, along *= 0.45, around *= 0.45) {
      const double i0 = index, phi0 = turn;
      for (int a = -2; a <= 2; ++a)
        for (int b = -2; b <= 2; ++b) look(i0 + along * a / 2, phi0 + around * b / 2);
    }
    return best;
  }
  /// How deep the flat tip is below the root cone at one pose.
  [[nodiscard]] BruteDepth in_root(const BrutePose& pose) const {
    const Vec3 e1 = pose.axis.unitOrthogonal(), e2 = pose.axis.cross(e1);
    BruteDepth best;
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j < 360; ++j) {
        const double phi = M_PI * j / 180, r = line_.front().y() * i / 20;
        const Vec3 p = pose.tip + r * (std::cos(phi) * e1 + std::sin(phi) * e2);
        const bevel_gear::ConePoint c = bevel_gear::cone_point(p, gear_.sin_delta(), gear_.cos_delta());
        if (c.ell < gear_.R_i() || c.ell > gear_.R_e()) continue;
        if (-h_f_ - c.height > best.depth) best.depth = -h_f_ - c.height, best.place = p;
      }
    return best;
  }
  /// How far a point is inside the cutter over a motion: > 0 inside.
  [[nodiscard]] double inside(const Vec3& p, const path::ToolMotion& m, int samples) const {
    double best = -INFINITY;
    for (int k = 0; k <= samples; ++k) best = std::max(best, -distance(p, pose_at(m, double(k) / samples)));
    return best;
  }

 private:
  struct Station {
    Vec3 tip, axis;
  };
  struct Piece {
    std::function<bevel_gear::CutterCentre<double>(double)> at;
    std::vector<Station> stations;
  };
  const bevel_gear::BevelGear& gear_;
  double h_f_;
  std::vector<Vec2> line_;  // (height above the tip, radius), from the edge of the flat
  std::vector<Piece> pieces_;
};

/// How far two convex bodies of revolution must be moved apart: by sampled circles and a search over the directions
/// about one. Rims: the tool's as (height above the tip, radius), the part's as (r, z).
struct BruteOverlap {
  double depth = 1e9;  ///< < 0: apart
  Vec3 direction = Vec3::UnitZ(), on_part = Vec3::Zero();
};
inline BruteOverlap overlap_of(const std::vector<Vec2>& tool, const BrutePose& pose, const std::vector<Vec2>& part,
                               const Vec3& start) {
  constexpr int n = 3000;
  const Vec3 e1 = pose.axis.unitOrthogonal(), e2 = pose.axis.cross(e1);
  std::vector<Vec3> of_tool, of_part;
  for (int k = 0; k < n; ++k) {
    const double c = std::cos(2 * M_PI * k / n), s = std::sin(2 * M_PI * k / n);
    for (const Vec2& q : tool) of_tool.push_back(pose.tip + q.x() * pose.axis + q.y() * (c * e1 + s * e2));
    for (const Vec2& q : part) of_part.emplace_back(q.x() * c, q.x() * s, q.y());
  }
  const auto thin = [&](std::vector<Vec3>& points, int keep) {
    std::vector<Vec3> out;
    for (std::size_t k = 0; k < points.size(); k += std::size_t(keep)) out.push_back(points[k]);
    return out;
  };
  const auto coarse_tool = thin(of_tool, 7), coarse_part = thin(of_part, 7);
  BruteOverlap best;
  const auto look = [&](const Vec3& direction, const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    const Vec3 d = direction.normalized();
    double low = INFINITY, high = -INFINITY;
    Vec3 on = Vec3::Zero();
    for (const Vec3& p : a) low = std::min(low, d.dot(p));
    for (const Vec3& p : b)
      if (const double v = d.dot(p); v > high) high = v, on = p;
    if (high - low < best.depth) best = {high - low, d, on};
  };
  best.direction = start;
  double width = 0.6;
  for (int level = 0; level < 16; ++level, width *= 0.45) {
    const Vec3 n0 = best.direction, t1 = n0.unitOrthogonal(), t2 = n0.cross(t1);
    const bool fine = level > 6;
    if (level == 7) best.depth = 1e9;  // the fine points decide
    for (int a = -3; a <= 3; ++a)
      for (int b = -3; b <= 3; ++b)
        look(n0 + width * (a / 3.0 * t1 + b / 3.0 * t2), fine ? of_tool : coarse_tool, fine ? of_part : coarse_part);
  }
  return best;
}

}  // namespace toothpath::bevel_test
