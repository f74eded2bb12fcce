#include "cam/analytic/body_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include "cam/analytic/body_patches.h"
#include "cam/path/motion_blend.h"
#include "geometry/base/angle.h"

namespace toothpath::analytic {
namespace {

constexpr double kWreckDepth = 0.05;     // mm: deeper cuts are followed more coarsely
constexpr double kSmallestQuad = 1e-5;  // mm: smaller quads are not halved
constexpr std::size_t kMostPieces = 200000;
constexpr int kTeeth = 1 << 20;       // a gear has fewer
constexpr double kRoundOff = 1 + 1e-9;


/// A quad of the part during a stretch of the motion.
struct Piece {
  BodyQuad quad;
  std::uint32_t target = 0;
  double t0 = 0, t1 = 1;
};

/// A cell of the part at one tooth, and the best place found on it.
struct Target {
  int zone = 0, tooth = 0;
  std::size_t cell = 0;
  double cosine = 1, sine = 0;  ///< of the turn from space 0
  double found = INFINITY;
  Vec3 at = Vec3::Zero();  ///< in space 0

  [[nodiscard]] Vec3 placed(const Vec3& p) const { return {cosine * p.x() - sine * p.y(), sine * p.x() + cosine * p.y(), p.z()}; }
  [[nodiscard]] Vec3 back(const Vec3& p) const { return {cosine * p.x() + sine * p.y(), cosine * p.y() - sine * p.x(), p.z()}; }
};

/// The frame of the tool at one moment: two directions across the axis, and the axis.
struct View {
  Vec3 tip, across, beside, axis;
  [[nodiscard]] Vec3 operator()(const Vec3& p_W) const {
    const Vec3 d = p_W - tip;
    return {d.dot(across), d.dot(beside), d.dot(axis)};
  }
  [[nodiscard]] Vec3 direction(const Vec3& g_T) const { return g_T.x() * across + g_T.y() * beside + g_T.z() * axis; }
};

class Sweep {
 public:
  Sweep(const GearDistance& part, const tool::Frustum& body, const path::ToolMotion& m, const SweptGapOptions& options)
      : part_(part), f_(body), m_(m), o_(options), widest_(std::max(body.radius_from, body.radius_to)), arm_(std::hypot(body.to, widest_)) {
    const Vec3 cross = m.axis_from.cross(m.axis_to);
    turns_ = m.axis_from != m.axis_to;
    normal_ = cross.norm() > 0 ? Vec3(cross.normalized()) : Vec3(m.axis_from.unitOrthogonal());
    side_ = m.axis_from.cross(normal_);
    travel_ = (m.tip_to - m.tip_from).norm();
    const double half = std::min(0.5 * (m.axis_to - m.axis_from).norm(), 0.9999);
    turn_rate_ = 2 * half / std::sqrt(1 - half * half);
  }

  SweptGap run() {
    SweptGap out{o_.enough_mm, o_.enough_mm, 0, "tooth", m_.tip_to};
    const double above = least_height() - part_.gear().blank_top();
    if (above >= o_.enough_mm) return out;
    gather();
    prove();
    out.proven_mm = std::max(std::min(o_.enough_mm, proven_), above);
    const Target* best = nullptr;
    for (const auto& t : targets_)
      if (t.found < (best ? best->found : o_.enough_mm)) best = &t;
    if (!best) return out;
    out.measured_mm = std::max(best->found, out.proven_mm);
    out.zone = best->zone;
    out.place = best->at;
    out.patch = part_.patches(best->zone).name(best->cell);
    return out;
  }

 private:
  /// Lowest height of the body over the whole motion.
  [[nodiscard]] double least_height() const {
    const double ends = std::min(tool::lowest_z(f_, m_.tip_from, m_.axis_from), tool::lowest_z(f_, m_.tip_to, m_.axis_to));
    return ends - arm_ * ((m_.axis_to - m_.axis_from).norm() + m_.axis_deviation) - m_.deviation_mm;
  }
  [[nodiscard]] View view(double t) const {
    if (!turns_) return {path::tip_at(m_, t), normal_, side_, m_.axis_from};
    const Vec3 a = path::axis_at(m_, t);
    return {path::tip_at(m_, t), normal_, a.cross(normal_), a};
  }
  /// What a place at distance `arm` from the tip may leave of the straight line between its two places, seen from the tool.
  [[nodiscard]] double slack(double arm, double dt) const {
    const double T = turn_rate_;
    return m_.deviation_mm + m_.axis_deviation * arm + (T * T * std::sqrt(1 + T * T) * arm + 2 * T * travel_) * dt * dt / 8;
  }

  /// Cells that may come near at any moment, each once: zone, tooth, cell in order.
  [[nodiscard]] std::vector<std::uint64_t> near_cells(double enough) const {
    const double way = travel_ + arm_ * (m_.axis_to - m_.axis_from).norm();
    const int parts = std::clamp(int(std::ceil(way / (widest_ + o_.enough_mm))), 1, 4096);
    const int links = std::max(1, int(std::ceil((f_.to - f_.from) / std::max(widest_, 0.5))));
    const double half = 0.5 * (f_.to - f_.from) / links, pitch = part_.gear().pitch();
    std::vector<std::uint64_t> keys;
    for (int zone = 0; zone < part_.zones(); ++zone) {
      const auto& ring = part_.space(zone).ring().zone;
      const double reach = std::hypot(widest_, half) + enough + 0.5 * way / parts + part_.patches(zone).search_margin();
      const double end = zone + 1 < part_.zones() ? part_.space(zone + 1).ring().zone.inner_radius_mm : ring.outer_radius_mm;
      for (int q = 0; q < parts; ++q)
        for (int k = 0; k < links; ++k) {
          const double t = (q + 0.5) / parts;
          const Vec3 x = path::tip_at(m_, t) + path::axis_at(m_, t) * (f_.from + (2 * k + 1) * half);
          if (x.z() - reach > part_.gear().blank_top()) continue;
          const double r = std::hypot(x.x(), x.y());
          if (r + reach < ring.inner_radius_mm || r - reach > end) continue;
          const double azimuth = std::remainder(std::atan2(x.y(), x.x()) - part_.space_azimuth(zone, std::max(r, 1.0)), kTwoPi);
          const int index = int(std::lround(azimuth / pitch)), wide = 1 + int(std::ceil(reach / (pitch * ring.inner_radius_mm)));
          for (int tooth = index - wide; tooth <= index + wide; ++tooth)
            part_.cell_index(zone).near(turned(x, -tooth * pitch), reach, [&](std::size_t c, double radius) {
              keys.push_back(std::uint64_t(zone) << 56 | std::uint64_t(tooth + kTeeth) << 32 | c);
              return radius;
            });
        }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return keys;
  }

  void gather() {
    const double enough = o_.enough_mm + m_.deviation_mm + m_.axis_deviation * arm_, pitch = part_.gear().pitch();
    const View first = view(0), last = view(1);
    const tool::PlacedFrustum in_T(f_, Vec3::Zero(), Vec3::UnitZ());
    std::vector<std::pair<double, Target>> order;
    Target cell{-1, 0, 0, 1, 0};
    for (const auto& key : near_cells(enough)) {
      const int zone = int(key >> 56), tooth = int(key >> 32 & 0xffffff) - kTeeth;
      if (zone != cell.zone || tooth != cell.tooth) cell = {zone, tooth, 0, std::cos(tooth * pitch), std::sin(tooth * pitch)};
      cell.cell = std::size_t(key & 0xffffffff);
      const auto& patches = part_.patches(zone);
      const Vec3 c = cell.placed(patches.centre(cell.cell)), a = first(c), b = last(c);
      const double arm = std::sqrt(std::max(a.squaredNorm(), b.squaredNorm()));
      const double away = 0.5 * (b - a).norm() + slack(arm, 1) + patches.radius(cell.cell);
      const Vec3 middle = 0.5 * (a + b);
      if (in_T.beyond(middle, (enough + away) * kRoundOff)) continue;
      const double least = tool::frustum_distance(middle, f_) - away;
      if (least <= enough) order.push_back({least, cell});
    }
    // The nearest comes last and is looked at first.
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [least, target] : order) {
      pieces_.push_back({part_.patches(target.zone).quad(target.cell), std::uint32_t(targets_.size()), 0, 1});
      targets_.push_back(target);
    }
  }

  void note(Target& target, double gap, const Vec3& place) {
    best_ = std::min(best_, gap);
    if (gap >= target.found) return;
    target.found = gap;
    target.at = place;
  }

  /// How far below a gap that was found the bound of a piece may lie.
  [[nodiscard]] double leeway(double gap) const {
    return gap >= o_.contact_mm ? o_.proof_mm : std::max(0.5 * o_.contact_proof_mm, -0.1 * (gap + kWreckDepth));
  }

  void prove() {
    best_ = o_.enough_mm;
    std::size_t examined = 0;
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      Target& target = targets_[piece.target];
      const auto& patches = part_.patches(target.zone);
      const BodyHull hull = patches.outline(target.cell, piece.quad);
      if (hull.count == 0) continue;  // wholly beyond the ring
      const double t = 0.5 * (piece.t0 + piece.t1), dt = piece.t1 - piece.t0;
      const View from = view(piece.t0), to = view(piece.t1);
      std::array<Vec3, 2 * std::tuple_size_v<decltype(hull.corner)>> x;
      double arm = 0, moved = 0;
      Vec3 centre = Vec3::Zero();
      for (std::size_t k = 0; k < hull.count; ++k) {
        const Vec3 p = target.placed(hull.corner[k].p);
        const Vec3 &a = x[2 * k] = from(p), &b = x[2 * k + 1] = to(p);
        arm = std::max({arm, a.squaredNorm(), b.squaredNorm()});
        moved = std::max(moved, (b - a).squaredNorm());
        centre += a + b;
      }
      arm = std::sqrt(arm);
      moved = std::sqrt(moved);
      centre /= double(2 * hull.count);
      // The tangent plane at the middle, under every corner, less what the surface and the motion leave of the hull.
      const auto [d, g] = tool::frustum_slope(centre, f_);
      double least = INFINITY;
      for (std::size_t k = 0; k < 2 * hull.count; ++k) least = std::min(least, g.dot(x[k] - centre));
      const double sag = turns_ ? patches.sag(target.cell, piece.quad) : 0;  // g turns with the tool
      const double above = patches.above(target.cell, piece.quad, target.back(view(t).direction(g))) + 0.5 * dt * turn_rate_ * sag;
      least += d - above - slack(arm + sag, dt);
      if (least >= std::min(best_, o_.enough_mm)) {
        proven_ = std::min(proven_, least);
        continue;
      }
      for (std::size_t k = 0; k < 2 * hull.count; ++k) look(target, patches, hull.corner[k / 2], x[k], k % 2 == 0 ? from : to);
      if (best_ < -std::max(0.25, 0.1 * widest_)) {
        proven_ = -widest_;  // no place lies deeper in a body than its radius
        return;
      }
      const double fixed = m_.deviation_mm + m_.axis_deviation * arm;
      double size = 0;
      for (std::size_t k = 0; k < 4; ++k) size = std::max(size, (piece.quad.corner[k] - piece.quad.corner[(k + 1) % 4]).norm());
      if (least + fixed >= best_ - leeway(std::min(best_, least + fixed)) || std::max(size, moved) < kSmallestQuad || ++examined > kMostPieces ||
          !std::isfinite(least)) {
        proven_ = std::min(proven_, std::isfinite(least) ? least : -widest_);
        continue;
      }
      halve(piece, patches, target.cell, moved + dt * turn_rate_ * arm > size);
    }
  }

  /// The gap of a corner, where it can be the least: of a place of the surface only.
  void look(Target& target, const BodyPatches& patches, const FacetCorner& corner, const Vec3& seen, const View& at) {
    const double gap = tool::frustum_distance(seen, f_);
    if (corner.stands) {
      note(target, gap, corner.p);
    } else if (gap < best_) {
      const auto p = patches.settled(target.cell, corner.at);
      if (p) note(target, tool::frustum_distance(at(target.placed(*p)), f_), *p);
    }
  }

  void halve(const Piece& piece, const BodyPatches& patches, std::size_t cell, bool in_time) {
    Piece a = piece, b = piece;
    if (in_time) {
      a.t1 = b.t0 = 0.5 * (piece.t0 + piece.t1);
    } else {
      const auto halves = patches.halved(cell, piece.quad);
      a.quad = halves[0];
      b.quad = halves[1];
    }
    pieces_.push_back(b);
    pieces_.push_back(a);
  }

  const GearDistance& part_;
  const tool::Frustum& f_;
  const path::ToolMotion& m_;
  const SweptGapOptions& o_;
  double widest_, arm_, travel_ = 0, turn_rate_ = 0;
  bool turns_ = false;
  Vec3 normal_, side_;
  std::vector<Target> targets_;
  std::vector<Piece> pieces_;
  double proven_ = INFINITY;
  double best_ = INFINITY;  // least gap found
};

}  // namespace

SweptGap swept_gap(const GearDistance& part, const tool::Frustum& body, const path::ToolMotion& motion, const SweptGapOptions& options) {
  return Sweep(part, body, motion, options).run();
}

}  // namespace toothpath::analytic
