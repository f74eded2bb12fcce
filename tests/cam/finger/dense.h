// Cutter, shank and holder of a finger mill sampled at the same moments of a motion, ten times as many as the check
// looks at: the least signed distance of each body from what it must not meet, in points of the exact walls and of the
// surfaces of revolution of blank, hub and shaft. Knows none of the bounds of cam.
#pragma once

#include <string>

#include "cam/finger/poses.h"
#include "cam/tool/assembly.h"
#include "tests/cam/finger/brute.h"

namespace toothpath::bevel_test {

constexpr double kFar = 2.0;  // mm: what keeps farther away is not looked at

enum class DenseBody { cutter, shank, holder };
inline const char* name_of(DenseBody b) {
  return b == DenseBody::cutter ? "flute" : b == DenseBody::shank ? "shank" : "holder";
}

struct DenseGap {
  double gap = INFINITY;  ///< < 0: the place is so deep inside the body; never above kFar
  Vec3 place = Vec3::Zero();
  double t = 0;
  std::string part;
};

class DenseFinger {
 public:
  DenseFinger(const bevel_gear::BevelGear& gear, const tool::ToolAssembly& tool)
      : gear_(gear), tool_(gear, gear, tool), brute_(gear), flute_(tool_.shank_from_mm) {
    const double z = tool.stick_out_mm;
    shank_ = {Vec2(flute_, tool.shank_diameter_mm / 2), Vec2(z, tool.shank_diameter_mm / 2)};
    for (double from = z; const auto& part : tool.holder) {
      holder_.push_back(
          {Vec2(from, part.lower_diameter_mm / 2), Vec2(from + part.height_mm, part.upper_diameter_mm / 2)});
      from += part.height_mm;
    }
    sample_walls();
    lay_edges();
  }

  /// Ten times the moments at which the check looks at this motion: at the poses of the cutter or at the pieces of
  /// shank and holder, whichever are more.
  [[nodiscard]] int moments(const path::ToolMotion& m) const {
    const double length = (m.tip_to - m.tip_from).norm();
    int pieces = 1;
    while (pieces < 128 && length / pieces >= 0.05) pieces *= 2;
    return 10 * std::max(pieces, m.rapid ? 1 : finger::pose_sampling(gear_, tool_, m).intervals);
  }

  /// Least distance at all moments. A cutter that feeds must keep out of walls, root, hub and shaft; everything else
  /// out of the blank too.
  [[nodiscard]] DenseGap least(const path::ToolMotion& m, DenseBody body) const {
    const int n = moments(m);
    DenseGap best;
    best.gap = kFar;
    const bool cuts = body == DenseBody::cutter && !m.rapid;
    if (cuts) against_walls(m, n, best);
    for (const Edge& edge : edges_)
      if (edge.part == "root" ? cuts : edge.part != "blank" || !cuts) against_edge(edge, m, n, body, best);
    return best;
  }

  /// Signed distance of a place from one body at one pose.
  [[nodiscard]] double distance(const Vec3& p, const BrutePose& pose, DenseBody body) const {
    const Vec3 w = p - pose.tip;
    const double h = w.dot(pose.axis), rho = (w - h * pose.axis).norm();
    if (body == DenseBody::shank) return from_cone(shank_, h, rho);
    if (body == DenseBody::holder) {
      double d = INFINITY;
      for (const Cone& part : holder_) d = std::min(d, from_cone(part, h, rho));
      return d;
    }
    if (h > flute_) return std::hypot(h - flute_, std::max(0.0, rho - gear_.cutter().rho_D));
    const double d = brute_.meridian_distance(h, rho);
    return d < 0 ? std::max(d, h - flute_) : d;
  }

  /// How far body and part must be moved apart where they are nearest to each other.
  [[nodiscard]] BruteOverlap overlap(const DenseGap& at, const path::ToolMotion& m, DenseBody body) const {
    std::vector<Vec2> tool, part;
    if (body == DenseBody::shank) tool.assign(shank_.begin(), shank_.end());
    else if (body == DenseBody::holder)
      for (const Cone& piece : holder_) tool.insert(tool.end(), piece.begin(), piece.end());
    for (const Edge& edge : edges_)
      if (edge.part == at.part) part.insert(part.end(), {edge.a, edge.b});
    const BrutePose pose = pose_at(m, at.t);
    return overlap_of(tool, pose, part, pose.axis);
  }

 private:
  using Cone = std::array<Vec2, 2>;  // (height above the tip, radius) below and above
  /// A line (r, z) that is turned about the gear axis.
  struct Edge {
    std::string part;
    Vec2 a, b;
    [[nodiscard]] Vec3 at(double s, double azimuth) const {
      const Vec2 q = a + s * (b - a);
      return {q.x() * std::cos(azimuth), q.x() * std::sin(azimuth), q.y()};
    }
  };

  static double from_cone(const Cone& c, double h, double rho) {
    const Vec2 q(h, rho);
    const auto to = [&](const Vec2& a, const Vec2& b) {
      const Vec2 d = b - a;
      return (q - a - std::clamp((q - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm();
    };
    const double border = std::min({to(Vec2(c[0].x(), 0), c[0]), to(c[0], c[1]), to(c[1], Vec2(c[1].x(), 0))});
    const bool inside =
        h > c[0].x() && h < c[1].x() && rho < c[0].y() + (c[1].y() - c[0].y()) * (h - c[0].x()) / (c[1].x() - c[0].x());
    return inside ? -border : border;
  }

  void sample_walls() {
    for (const auto& half : gear_.halves())
      for (const auto& wall : half.walls)
        for (int i = 0; i <= 160; ++i)
          for (int j = 0; j <= 40; ++j) {
            const auto& c = wall.cutter;
            const std::size_t w = wall.sigma > 0 ? 0 : 1;
            const Vec3 p = wall.point(half.beta_from[w] + (half.beta_to[w] - half.beta_from[w]) * i / 160,
                                      c.p_A + (c.p_D - c.p_A) * (j + 0.01) / 40.01)
                               .p;
            if (brute_.on_face(p)) walls_.push_back(p);
          }
  }

  void lay_edges() {
    const auto& p = gear_.parameters();
    const auto at = [&](double ell, double height) {
      return Vec2(ell * gear_.sin_delta() + height * gear_.cos_delta(),
                  ell * gear_.cos_delta() - height * gear_.sin_delta());
    };
    const double h_a = p.addendum_mm, h_f = p.dedendum_mm, R_i = gear_.R_i(), R_e = gear_.R_e();
    edges_ = {{"root", at(R_i, -h_f), at(R_e, -h_f)},
              {"blank", at(R_i, h_a), at(R_e, h_a)},
              {"blank", at(R_i, h_a), at(R_i, -h_f)},
              {"blank", at(R_e, h_a), at(R_e, -h_f)}};
    const auto cylinder = [&](const char* name, double radius, double from, double to) {
      if (!(radius > 0)) return;
      edges_.push_back({name, Vec2(radius, from), Vec2(radius, to)});
      for (const double z : {from, to}) edges_.push_back({name, Vec2(0, z), Vec2(radius, z)});
    };
    const double back = at(R_e, -h_f).y(), front = at(R_i, -h_f).y();
    cylinder("hub", p.hub_diameter_mm / 2, back, back + p.hub_length_mm);
    cylinder("shaft", p.shaft_diameter_mm / 2, front - p.shaft_length_mm, front);
  }

  /// No point of a body that reaches `arm` from the tip moves farther than this between two of n moments.
  static double step(const path::ToolMotion& m, double arm, int n) {
    return ((m.tip_to - m.tip_from).norm() + 1.01 * arm * (m.axis_to - m.axis_from).norm()) / n;
  }

  /// Moments at which a point cannot be nearer than the least so far are passed over: the least of all moments is the
  /// same.
  void against_walls(const path::ToolMotion& m, int n, DenseGap& best) const {
    const BrutePose middle = pose_at(m, 0.5);
    const double reach = 0.5 * (m.tip_to - m.tip_from).norm() +
                         1.5 * (gear_.cutter().rho_D + gear_.parameters().addendum_mm + gear_.parameters().dedendum_mm);
    for (const Vec3& p : walls_) {
      if ((p - middle.tip).norm() > reach + best.gap) continue;
      const double way = step(m, 2 * reach, n);
      for (int k = 0; k <= n;) {
        const double d = distance(p, pose_at(m, double(k) / n), DenseBody::cutter);
        if (d < best.gap) best = {d, p, double(k) / n, "wall"};
        k += std::max(1, int(std::min(1e6, way > 0 ? (d - best.gap) / way : 1e6)));
      }
    }
  }

  struct Found {
    double gap = INFINITY, s = 0, azimuth = 0;
  };
  /// Downhill on a turned line from a start, or from the best of a look all around. Where no place can be nearer than
  /// `enough`: a gap that is not above the true one.
  [[nodiscard]] Found downhill(const Edge& edge, const BrutePose& pose, DenseBody body, Found start, double first_mm,
                               double enough) const {
    const auto gap = [&](double s, double azimuth) { return distance(edge.at(s, azimuth), pose, body); };
    const double length = (edge.b - edge.a).norm(), radius = std::max({edge.a.x(), edge.b.x(), 1e-3});
    start.gap = std::isfinite(start.gap) ? gap(start.s, start.azimuth) : INFINITY;
    if (!std::isfinite(start.gap)) {
      for (int i = 0; i <= 8; ++i)
        for (int j = 0; j < 48; ++j)
          if (const double d = gap(i / 8.0, 2 * M_PI * j / 48); d < start.gap) start = {d, i / 8.0, 2 * M_PI * j / 48};
      first_mm = std::max(length / 8, 2 * M_PI * radius / 48);
      if (const double beyond = std::hypot(length / 16, M_PI * radius / 48); start.gap - beyond > enough)
        return {start.gap - beyond, 0, 0};
    }
    for (double mm = first_mm; mm > 2e-6;) {
      const Found from = start;
      for (const auto& [u, v] : {std::pair{1.0, 0.0},
                                 {-1.0, 0.0},
                                 {0.0, 1.0},
                                 {0.0, -1.0},
                                 {0.7, 0.7},
                                 {-0.7, 0.7},
                                 {0.7, -0.7},
                                 {-0.7, -0.7}}) {
        if (u * v != 0 && start.gap < from.gap) break;
        const double s = std::clamp(from.s + u * mm / length, 0.0, 1.0), azimuth = from.azimuth + v * mm / radius;
        if (const double d = gap(s, azimuth); d < start.gap) start = {d, s, azimuth};
      }
      if (!(start.gap < from.gap - 1e-3 * mm)) mm *= 0.5;
    }
    return start;
  }

  void against_edge(const Edge& edge, const path::ToolMotion& m, int n, DenseBody body, DenseGap& best) const {
    const double arm = body == DenseBody::cutter  ? flute_ + gear_.cutter().rho_D
                       : body == DenseBody::shank ? shank_[1].norm()
                                                  : holder_.back()[1].norm();
    const double way = step(m, arm, n);
    Found at;
    for (int k = 0, looked = 0; k <= n; ++looked) {
      const BrutePose pose = pose_at(m, double(k) / n);
      if (looked % 16 == 0) at.gap = INFINITY;  // all around again
      at = downhill(edge, pose, body, at, std::max(way, 5e-4), best.gap);
      if (at.gap < best.gap) best = {at.gap, edge.at(at.s, at.azimuth), double(k) / n, edge.part};
      const int skip = std::max(1, int(std::min(1e6, way > 0 ? (at.gap - best.gap) / way : 1e6)));
      if (skip > 1) looked = 15;
      k += skip;
    }
  }

  const bevel_gear::BevelGear& gear_;
  finger::FingerTool tool_;
  BruteFinger brute_;
  double flute_;
  Cone shank_;
  std::vector<Cone> holder_;
  std::vector<Vec3> walls_;
  std::vector<Edge> edges_;
};

}  // namespace toothpath::bevel_test
