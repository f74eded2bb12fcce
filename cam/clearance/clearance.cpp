#include "cam/clearance/clearance.h"

#include <algorithm>
#include <cmath>

#include "cam/path/motion_blend.h"
#include "cam/tool/cutters.h"

namespace toothpath::clearance {
namespace {

constexpr int kMeshHalvings = 40;
constexpr double kOnAxis = 1e-3;  // mm: a draw back that leaves its axis by less

struct MeshStretch {
  Vec3 tip, axis;             ///< in its middle
  double tips = 0, axes = 0;  ///< how far tip [mm] and axis are from there at most
  const path::ToolMotion* motion = nullptr;
  [[nodiscard]] double reach(double arm) const { return tips + arm * axes; }
};

/// A piece t0..t1 of one motion.
MeshStretch stretch_of(const path::ToolMotion& m, double t0, double t1) {
  const double t = 0.5 * (t0 + t1);
  MeshStretch s{path::tip_at(m, t), path::axis_at(m, t), 0, 0, &m};
  s.tips = 0.5 * (path::tip_at(m, t1) - path::tip_at(m, t0)).norm() + m.deviation_mm;
  s.axes = std::max((path::axis_at(m, t0) - s.axis).norm(), (path::axis_at(m, t1) - s.axis).norm()) + m.axis_deviation;
  return s;
}

/// Several motions about the middle one.
MeshStretch stretch_of(std::span<const path::ToolMotion> motions) {
  const path::ToolMotion& m = motions[motions.size() / 2];
  MeshStretch s{path::tip_at(m, 0.5), path::axis_at(m, 0.5), 0, 0, &m};
  for (const auto& k : motions) {
    s.tips = std::max(s.tips, std::max((k.tip_from - s.tip).norm(), (k.tip_to - s.tip).norm()) + k.deviation_mm);
    s.axes = std::max(s.axes, std::max((k.axis_from - s.axis).norm(), (k.axis_to - s.axis).norm()) + k.axis_deviation);
  }
  return s;
}

/// One body of the tool against one mesh along some motions.
class BodyWatch {
 public:
  BodyWatch(const MeshDistance& mesh, std::size_t index, const MeshBody& body, double rule,
            const MeshClearanceOptions& o, const std::optional<Withdrawal>& withdrawal)
      : mesh_(mesh),
        index_(index),
        body_(body),
        rule_(rule),
        o_(o),
        withdrawal_(withdrawal),
        around_(body.pieces.front()) {
    for (const tool::Frustum& f : body.pieces) {
      around_.to = f.to;
      around_.radius_from = std::max({around_.radius_from, f.radius_from, f.radius_to});
    }
    around_.radius_to = around_.radius_from;
    arm_ = std::hypot(around_.to, around_.radius_to);
  }

  void motions(std::span<const path::ToolMotion> m) {
    if (m.empty()) return;
    if (m.size() == 1) return piece(m[0], 0, 1, kMeshHalvings);
    if (settled(stretch_of(m), false)) return;
    motions(m.subspan(0, m.size() / 2));
    motions(m.subspan(m.size() / 2));
  }
  std::optional<MeshMeeting> worst;

 private:
  void piece(const path::ToolMotion& m, double t0, double t1, int depth) {
    const double t = 0.5 * (t0 + t1);
    if (settled(stretch_of(m, t0, t1), depth == 0)) return;
    piece(m, t0, t, depth - 1);
    piece(m, t, t1, depth - 1);
  }
  /// Is enough known about a stretch? Notes what it proves.
  bool settled(const MeshStretch& s, bool last) {
    const double reach = s.reach(arm_), best = worst ? worst->gap_mm : INFINITY;
    const double look = rule_ + o_.look_mm + reach, within = std::min(look, std::max(best, 0.0) + reach);
    const MeshPlace place = gap(s, within);
    if (place.distance >= within && !inside(s)) return true;
    const bool hit = place.distance <= 0 || place.distance >= within;
    const double measured = place.distance >= within ? -INFINITY : place.distance, proven = measured - reach;
    if (!hit && proven >= best) return true;  // no nearer than what is known already
    if (!hit && !last && reach > o_.proof_mm && reach > 0.05 * (measured - rule_)) return false;
    if (!hit && inside(s)) return note(s, place, -INFINITY, -INFINITY), true;
    note(s, place, measured, hit ? std::min(measured, 0.0) : proven);
    return true;
  }
  void note(const MeshStretch& s, const MeshPlace& place, double measured, double proven) {
    if (worst && worst->gap_mm <= proven) return;
    worst = MeshMeeting{proven,         measured,        body_.body, s.motion->operation, s.motion->tooth,
                        s.motion->line, s.motion->rapid, index_,     place.foot};
  }
  /// A body that the surface does not come near is inside or outside as a whole.
  [[nodiscard]] bool inside(const MeshStretch& s) const {
    const double h = credited() ? around_.to : 0.5 * (around_.from + body_.ball_mm + around_.to);
    return mesh_.inside(s.tip + h * s.axis);
  }
  [[nodiscard]] bool credited() const { return withdrawal_.has_value() && body_.cuts(); }
  [[nodiscard]] MeshPlace gap(const MeshStretch& s, double within) const {
    if (body_.ball_mm > 0 && !credited()) {
      const double R = body_.ball_mm;
      MeshPlace place = mesh_.to_segment(s.tip + R * s.axis, s.axis, std::max(0.0, around_.to - R), within + R);
      place.distance = std::max(place.distance - R, 0.0);
      return place;
    }
    MeshPlace least;
    least.distance = within;
    if (body_.pieces.size() > 1 && mesh_.frustum_bound(around_, s.tip, s.axis, within) >= within) return least;
    // Drawn back, only what has come out of the room that the cutting part had: its part above the old top.
    const double from = credited() ? around_.to - std::max((s.tip - withdrawal_->tip).dot(s.axis), 0.0) : -INFINITY;
    for (tool::Frustum f : body_.pieces) {
      if (f.to < from) continue;
      if (f.from < from) {
        f.radius_from += (f.radius_to - f.radius_from) * (from - f.from) / (f.to - f.from);
        f.from = from;
      }
      const MeshPlace place = mesh_.to_frustum(f, s.tip, s.axis, least.distance);
      if (place.distance < least.distance) least = place;
    }
    return least;
  }

  const MeshDistance& mesh_;
  std::size_t index_;
  const MeshBody& body_;
  double rule_, arm_ = 0;
  const MeshClearanceOptions& o_;
  const std::optional<Withdrawal>& withdrawal_;
  tool::Frustum around_;  ///< a cylinder about all pieces
};

}  // namespace

std::vector<MeshBody> mesh_bodies(const tool::ToolAssembly& tool) { return mesh_bodies(tool::profile_of(tool)); }

std::vector<MeshBody> mesh_bodies(const tool::Profile& tool, double sag_mm) {
  MeshBody cutter{tool::Body::cutter, {}, 0};
  if (tool.plain_ball()) {
    cutter.ball_mm = tool.law()->r_0;
    cutter.pieces = {{0, tool.cutting().to(), cutter.ball_mm, cutter.ball_mm, tool::Body::cutter}};
  } else {
    cutter.pieces = tool.cutting().enclosing_frustums(sag_mm, tool::Body::cutter);
  }
  std::vector<MeshBody> bodies{std::move(cutter)};
  for (const tool::Frustum& f : tool::shank_and_holder(tool)) bodies.push_back({f.body, {f}, 0});
  return bodies;
}

std::optional<MeshMeeting> MeshClearance::nearest(std::span<const path::ToolMotion> motions,
                                                  std::span<const MeshBody> tool, const MeshRule& rule,
                                                  const std::optional<Withdrawal>& withdrawal) const {
  std::optional<MeshMeeting> worst;
  for (std::size_t k = 0; k < meshes_.size(); ++k)
    for (const MeshBody& body : tool) {
      if (!(body.cuts() ? rule.cutter : rule.others)) continue;
      const double least = body.cuts() ? rule.cutter_mm : rule.others_mm;
      BodyWatch w(*meshes_[k], k, body, least, options_, withdrawal);
      w.motions(motions);
      if (w.worst && (!worst || w.worst->gap_mm - least <
                                    worst->gap_mm - (tool::cuts(worst->body) ? rule.cutter_mm : rule.others_mm)))
        worst = w.worst;
    }
  return worst;
}

bool draws_back(const path::ToolMotion& m, const Withdrawal& w) {
  double last = -kOnAxis;
  for (const auto& [tip, axis] : {std::pair{m.tip_from, m.axis_from}, std::pair{m.tip_to, m.axis_to}}) {
    const Vec3 d = tip - w.tip;
    const double back = d.dot(w.axis);
    if (back < last || (d - back * w.axis).norm() > kOnAxis || (axis - w.axis).norm() > 1e-6) return false;
    last = back;
  }
  return true;
}

}  // namespace toothpath::clearance
