#include "cam/proof/rapid_clearance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cam/path/motion_blend.h"
#include "cam/tool/body.h"

namespace toothpath::proof {
namespace {

constexpr double kBlankTouch = 1e-6;     // mm: a rapid at the very height of the blank is clear
constexpr double kSmallestRapid = 1e-4;  // mm

/// A stretch of the tool axis with the largest radius about it.
struct RapidStretch {
  double from = 0, to = 0, radius = 0;
  tool::Body body = tool::Body::ball;
};

class Rapid {
 public:
  Rapid(const path::ToolMotion& m, const tool::ToolAssembly& tool, const RapidObstacle& o) : m_(m), o_(o) {
    const double R = tool.radius_mm();
    add({R, std::max(tool.flute_length_mm, R), R, R, tool::Body::ball}, 0);
    ball_radius_ = R;
    for (const auto& body : tool::shank_and_holder(tool)) add(body, 0);
    stretches_.front().from = 0;
  }
  Rapid(const path::ToolMotion& m, const tool::ProofTool& tool, const RapidObstacle& o) : m_(m), o_(o) {
    for (const auto& body : tool.cutting) add(body.core, body.round);
    for (const auto& body : tool.bodies) add(body, 0);
  }

  RapidProof run() {
    RapidProof proof;
    proof.clear = clear(0, 1, 0, proof);
    return proof;
  }

 private:
  void add(const tool::Frustum& core, double round) {
    const double widest = std::max(core.radius_from, core.radius_to) + round;
    frustums_.push_back({core, round});
    stretches_.push_back({core.from - round, core.to + round, widest, core.body});
    arm_ = std::max(arm_, std::hypot(core.to + round, widest));
    foot_ = std::min(foot_, core.from - round);
  }
  /// How far any point of the tool strays from its place at the middle of [t0, t1] beyond the straight way of the tip.
  [[nodiscard]] double stray(double t0, double t1) const {
    return arm_ * ((path::axis_at(m_, t1) - path::axis_at(m_, t0)).norm() + m_.axis_deviation) + m_.deviation_mm;
  }

  [[nodiscard]] double lowest(const Vec3& tip, const Vec3& axis, tool::Body& body) const {
    double low = (tip + ball_radius_ * axis).z() - ball_radius_;
    body = tool::Body::ball;
    for (const auto& f : frustums_)
      if (const double z = tool::lowest_z(f, tip, axis); z < low) {
        low = z;
        body = f.core.body;
      }
    return low;
  }
  [[nodiscard]] double highest(const Vec3& tip, const Vec3& axis) const {
    double high = (tip + ball_radius_ * axis).z() + ball_radius_;
    for (const auto& f : frustums_) high = std::max(high, -tool::lowest_z(f, -tip, -axis));
    return high;
  }
  /// How far the tool stays beyond planes that touch the cone h = 0 of a chart; of each body that beside its lower end
  /// or beside the tip, whichever tells more. A body that is thin there is not taken as wide as it grows.
  [[nodiscard]] double beyond_planes(const tooth_space::Chart& chart, const Vec3& tip, const Vec3& axis) const {
    const auto beyond = [&](const tool::RoundedFrustum& f, const Vec3& beside) {
      const Vec3 up = chart.up_at(azimuth(beside));
      return tool::lowest_z(f, Vec3(0, 0, tip.dot(up)), Vec3(0, 0, axis.dot(up)));
    };
    double least = INFINITY;
    for (const auto& f : frustums_)
      least = std::min(least, std::max(beyond(f, tip), beyond(f, tip + f.core.from * axis)));
    const Vec3 centre = tip + ball_radius_ * axis;
    return ball_radius_ > 0 ? std::min(least, chart.up(centre) - ball_radius_) : least;
  }
  /// Least and greatest distance of the tool from the gear axis.
  [[nodiscard]] std::pair<double, double> radii(const Vec3& tip, const Vec3& axis) const {
    double least = INFINITY, most = 0;
    for (const auto& s : stretches_) {
      const Vec2 a = (tip + s.from * axis).head<2>(), b = (tip + s.to * axis).head<2>(), d = b - a;
      const double t = d.squaredNorm() > 0 ? std::clamp(-a.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
      least = std::min(least, (a + t * d).norm() - s.radius);
      most = std::max({most, a.norm() + s.radius, b.norm() + s.radius});
    }
    return {std::max(least, beyond_planes({0, 1}, tip, axis)), most};
  }

  [[nodiscard]] double over_roof(const Vec3& tip, const Vec3& axis) const {
    double least = INFINITY;
    for (const auto& f : frustums_) least = std::min(least, o_.roof->over(f, tip, axis));
    // The lower half of a ball is told by none of them.
    const Vec3 centre = tip + ball_radius_ * axis;
    if (ball_radius_ > 0) least = std::min(least, o_.roof->over(std::array{centre}) - ball_radius_);
    return std::max(least, beyond_planes(o_.roof->chart(), tip, axis) - o_.roof->top());
  }

  bool clear(double t0, double t1, int depth, RapidProof& proof) {
    const Vec3 tip_0 = path::tip_at(m_, t0), tip_1 = path::tip_at(m_, t1), tip = 0.5 * (tip_0 + tip_1),
               axis = path::axis_at(m_, 0.5 * (t0 + t1));
    const Vec3 half = 0.5 * (tip_1 - tip_0);
    const double turning = stray(t0, t1), rise = std::abs(half.z()) + turning, run = half.head<2>().norm() + turning;
    tool::Body body = tool::Body::none;
    const auto [least, most] = radii(tip, axis);
    if (lowest(tip, axis, body) - rise >= o_.top_mm - kBlankTouch) return true;
    if (least - run >= o_.outer_radius_mm) return true;
    if (o_.inner_radius_mm > 0 && most + run <= o_.inner_radius_mm) return true;
    if (highest(tip, axis) + rise <= o_.bottom_mm) return true;
    if (o_.roof && over_roof(tip, axis) - half.norm() - turning >= -kBlankTouch) return true;
    if (foot_ + (tip.dot(axis) - std::abs(half.dot(axis)) - turning) >= o_.farthest(axis) - kBlankTouch) return true;
    if (run + rise < kSmallestRapid + 2 * (m_.deviation_mm + arm_ * m_.axis_deviation) || depth > 40) {
      proof.t = 0.5 * (t0 + t1);
      proof.tip = tip;
      proof.body = body;
      return false;
    }
    const double t = 0.5 * (t0 + t1);
    return clear(t0, t, depth + 1, proof) && clear(t, t1, depth + 1, proof);
  }

  const path::ToolMotion& m_;
  const RapidObstacle& o_;
  std::vector<tool::RoundedFrustum> frustums_;
  std::vector<RapidStretch> stretches_;
  double arm_ = 0, ball_radius_ = 0;
  double foot_ = 0;  ///< of the whole tool, above the tip
};

}  // namespace

RapidProof prove_rapid(const path::ToolMotion& motion, const tool::ToolAssembly& tool, const RapidObstacle& obstacle) {
  return Rapid(motion, tool, obstacle).run();
}

RapidProof prove_rapid(const path::ToolMotion& motion, const tool::ProofTool& tool, const RapidObstacle& obstacle) {
  return Rapid(motion, tool, obstacle).run();
}

}  // namespace toothpath::proof
