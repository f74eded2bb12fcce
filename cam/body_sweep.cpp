#include "cam/body_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

#include "cam/cutter_sweep.h"

namespace toothpath {
namespace {

constexpr double kTwoPi = 6.283185307179586476925286766559;
constexpr double kFacetProof = 1e-3;      // mm: of facets that stand for a curved patch; their sag is of this size anyway
constexpr double kWreck = 0.05;           // mm: deeper cuts are told as the facets show them
constexpr double kSmallest = 1e-5;        // mm: smaller pieces are not halved
constexpr std::size_t kMostPieces = 200000;
constexpr std::size_t kMostRefined = 12;  // facets near the deepest one that are measured on their patch
constexpr double kFirstStep = 0.1, kLastStep = 1e-5;  // mm: of the search on a patch

Vec3 turned(const Vec3& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y(), p.z()};
}

/// Signed distance in the half plane through the axis, and its gradient there.
struct HalfPlane {
  double distance = 0, d_rho = 0, d_h = 0;
};
HalfPlane half_plane(double rho, double h, const Frustum& f) {
  const double dr = f.radius_to - f.radius_from, dh = f.to - f.from;
  const double side = (rho - f.radius_from) * dh - (h - f.from) * dr;  // times the length of the generator
  const double below = f.from - h, above = h - f.to;
  if (side <= 0 && below <= 0 && above <= 0) {
    const double slant = std::sqrt(dr * dr + dh * dh);
    if (side >= below * slant && side >= above * slant) return {side / slant, dh / slant, -dr / slant};
    return below >= above ? HalfPlane{below, 0, -1} : HalfPlane{above, 0, 1};
  }
  double best = INFINITY, best_x = 0, best_y = 0;
  const auto segment = [&](double r0, double h0, double er, double eh) {
    const double l2 = er * er + eh * eh;
    const double t = l2 > 0 ? std::clamp(((rho - r0) * er + (h - h0) * eh) / l2, 0.0, 1.0) : 0.0;
    const double x = rho - r0 - t * er, y = h - h0 - t * eh, d2 = x * x + y * y;
    if (d2 >= best) return;
    best = d2;
    best_x = x;
    best_y = y;
  };
  if (below > 0) segment(0, f.from, f.radius_from, 0);
  segment(f.radius_from, f.from, dr, dh);
  if (above > 0) segment(0, f.to, f.radius_to, 0);
  const double d = std::sqrt(best);
  return d > 0 ? HalfPlane{d, best_x / d, best_y / d} : HalfPlane{0, 0, 0};
}

/// Distance and a subgradient in T.
std::pair<double, Vec3> slope(const Vec3& x, const Frustum& f) {
  const double rho = std::sqrt(x.x() * x.x() + x.y() * x.y());
  const auto q = half_plane(rho, x.z(), f);
  const Vec3 radial = rho > 1e-12 ? Vec3(x.x() / rho, x.y() / rho, 0) : Vec3(0, 0, 0);
  return {q.distance, Vec3(q.d_rho * radial + Vec3(0, 0, q.d_h))};
}

/// A triangle of a facet during a part of the motion.
struct Piece {
  std::array<Vec3, 3> p;
  std::uint32_t target = 0;
  double t0 = 0, t1 = 1;
};
/// A cell of the part at one tooth, and the best place found on it.
struct Target {
  int zone = 0, tooth = 0;
  std::size_t cell = 0;
  double found = INFINITY, t = 0;
  Vec3 at = Vec3::Zero();  ///< turned to space 0
};

class Sweep {
 public:
  Sweep(const GearDistance& part, const Frustum& body, const ToolMotion& m, const SweptGapOptions& options)
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
    if (best->found < o_.contact_mm && best->found > -kWreck) best = refine();
    if (best->found > o_.enough_mm) return out;
    out.measured_mm = std::max(best->found, out.proven_mm);
    out.zone = best->zone;
    out.place = best->at;
    const auto& cell = part_.cells(best->zone)[best->cell];
    if (cell.sheet) out.patch = to_string(cell.piece);
    return out;
  }

 private:
  /// Lowest height of the body over the whole motion.
  [[nodiscard]] double least_height() const {
    const double ends = std::min(lowest_z(f_, m_.tip_from, m_.axis_from), lowest_z(f_, m_.tip_to, m_.axis_to));
    return ends - arm_ * ((m_.axis_to - m_.axis_from).norm() + m_.axis_deviation) - m_.deviation_mm;
  }
  /// A place of the part as the tool sees it at time t.
  [[nodiscard]] Vec3 seen(const Vec3& p_W, double t) const {
    const Vec3 d = p_W - tip_at(m_, t);
    if (!turns_) return {d.dot(normal_), d.dot(side_), d.dot(m_.axis_from)};
    const Vec3 a = axis_at(m_, t);
    return {d.dot(normal_), d.dot(a.cross(normal_)), d.dot(a)};
  }
  /// What a place at distance `arm` from the tip may leave of the straight line between its two places, seen from the tool.
  [[nodiscard]] double slack(double arm, double dt) const {
    const double T = turn_rate_;
    return m_.deviation_mm + m_.axis_deviation * arm + (T * T * std::sqrt(1 + T * T) * arm + 2 * T * travel_) * dt * dt / 8;
  }

  void gather() {
    const double enough = o_.enough_mm + part_.cell_sag_mm() + m_.deviation_mm + m_.axis_deviation * arm_;
    const double way = travel_ + arm_ * (m_.axis_to - m_.axis_from).norm();
    const int parts = std::clamp(int(std::ceil(way / (widest_ + o_.enough_mm))), 1, 4096);
    const int links = std::max(1, int(std::ceil((f_.to - f_.from) / std::max(widest_, 0.5))));
    const double half = 0.5 * (f_.to - f_.from) / links, pitch = part_.gear().pitch();
    const double reach = std::hypot(widest_, half) + enough + 0.5 * way / parts;
    struct Key {
      int zone, tooth;
      std::size_t cell;
      auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    for (int zone = 0; zone < part_.zones(); ++zone) {
      const auto& ring = part_.space(zone).ring().zone;
      const double end = zone + 1 < part_.zones() ? part_.space(zone + 1).ring().zone.inner_radius_mm : ring.outer_radius_mm;
      for (int q = 0; q < parts; ++q)
        for (int k = 0; k < links; ++k) {
          const double t = (q + 0.5) / parts;
          const Vec3 x = tip_at(m_, t) + axis_at(m_, t) * (f_.from + (2 * k + 1) * half);
          if (x.z() - reach > part_.gear().blank_top()) continue;
          const double r = std::hypot(x.x(), x.y());
          if (r + reach < ring.inner_radius_mm || r - reach > end) continue;
          const double azimuth = std::remainder(std::atan2(x.y(), x.x()) - part_.space_azimuth(zone, std::max(r, 1.0)), kTwoPi);
          const int index = int(std::lround(azimuth / pitch)), wide = 1 + int(std::ceil(reach / (pitch * ring.inner_radius_mm)));
          for (int tooth = index - wide; tooth <= index + wide; ++tooth)
            part_.cell_index(zone).near(turned(x, -tooth * pitch), reach, [&](std::size_t c, double radius) {
              keys.push_back({zone, tooth, c});
              return radius;
            });
        }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<std::pair<double, Key>> order;
    for (const auto& key : keys) {
      const auto& cell = part_.cells(key.zone)[key.cell];
      const Vec3 c = turned(cell.centre, key.tooth * pitch), a = seen(c, 0), b = seen(c, 1), mid = 0.5 * (a + b);
      const double arm = std::max(a.norm(), b.norm());
      const double least = frustum_distance(mid, f_) - 0.5 * (b - a).norm() - slack(arm, 1) - cell.radius;
      if (least <= enough) order.push_back({least, key});
    }
    std::sort(order.begin(), order.end(), std::greater<>());  // the nearest comes last and is looked at first
    for (const auto& [least, key] : order) {
      const auto& cell = part_.cells(key.zone)[key.cell];
      const auto target = std::uint32_t(targets_.size());
      targets_.push_back({key.zone, key.tooth, key.cell});
      for (const std::size_t first : {0, 1}) {
        const auto polygon = on_ring(cell, {cell.corner[first], cell.corner[first + 1], cell.corner[first + 2]});
        for (std::size_t n = 1; n + 1 < polygon.size(); ++n)
          pieces_.push_back({{turned(polygon[0], key.tooth * pitch), turned(polygon[n], key.tooth * pitch), turned(polygon[n + 1], key.tooth * pitch)}, target, 0, 1});
      }
    }
  }

  /// The sheet goes on above the tip and beyond the ends of the ring: what of a facet may stand for material, widened by the sag.
  [[nodiscard]] std::vector<Vec3> on_ring(const GearDistance::Cell& cell, std::vector<Vec3> polygon) const {
    if (!cell.sheet) return polygon;
    const auto& space = part_.space(cell.zone);
    const double r_in = space.ring().zone.inner_radius_mm, r_out = space.ring().zone.outer_radius_mm, sag = part_.cell_sag_mm();
    const Vec3 outwards = Vec3(cell.centre.x(), cell.centre.y(), 0).normalized();
    double across = 0, low = INFINITY, high = 0;
    const auto radius = [&](const Vec3& p) { return std::clamp(std::hypot(p.x(), p.y()), r_in, r_out); };
    for (const auto& p : cell.corner) {
      across = std::max(across, p.cross(outwards).z() * p.cross(outwards).z());
      low = std::min(low, radius(p));
      high = std::max(high, radius(p));
    }
    // The tip surface over the cell lies below a plane that slopes as it does.
    const auto z_tip = [&](double r) { return space.surface().z_tip(r); };
    const double slope = high - low > 1e-9 ? (z_tip(high) - z_tip(low)) / (high - low) : 0;
    double tip = -INFINITY;
    for (const double r : {low, 0.5 * (low + high), high}) tip = std::max(tip, z_tip(r) - slope * r);
    polygon = cut(polygon, Vec3(Vec3::UnitZ() - slope * outwards), tip + std::abs(slope) * (across / r_in + sag) + sag);
    polygon = cut(polygon, outwards, r_out + sag);
    return cut(polygon, -outwards, -r_in + across / r_in + sag);
  }
  /// The part of a convex polygon where n.p <= limit.
  static std::vector<Vec3> cut(const std::vector<Vec3>& polygon, const Vec3& n, double limit) {
    std::vector<Vec3> out;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vec3 &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      const double da = n.dot(a) - limit, db = n.dot(b) - limit;
      if (da <= 0) out.push_back(a);
      if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + (b - a) * (da / (da - db)));
    }
    return out;
  }

  void note(Target& target, double d, const Vec3& p, double t, bool curved) {
    best_ = std::min(best_, d);
    if (!curved) best_flat_ = std::min(best_flat_, d);
    if (d >= target.found) return;
    target.found = d;
    target.t = t;
    target.at = turned(p, -target.tooth * part_.gear().pitch());
  }

  /// How far below the least gap found so far the bound of a piece may lie.
  [[nodiscard]] double leeway(bool curved) const {
    if (best_ >= o_.contact_mm) return o_.proof_mm;
    return std::max(curved ? kFacetProof : 0.5 * o_.contact_proof_mm, -0.1 * (best_ + kWreck));
  }

  void prove() {
    const double sag = part_.cell_sag_mm();
    best_ = o_.enough_mm;
    std::size_t examined = 0;
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      Target& target = targets_[piece.target];
      const bool curved = part_.cells(target.zone)[target.cell].sheet;
      std::array<Vec3, 6> x;
      double arm = 0, size = 0, moved = 0;
      Vec3 centre = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        x[k] = seen(piece.p[k], piece.t0);
        x[k + 3] = seen(piece.p[k], piece.t1);
        arm = std::max({arm, x[k].norm(), x[k + 3].norm()});
        moved = std::max(moved, (x[k + 3] - x[k]).norm());
        centre += (x[k] + x[k + 3]) / 6;
      }
      for (std::size_t k = 0; k < 3; ++k) size = std::max(size, (piece.p[k] - piece.p[(k + 1) % 3]).norm());
      const auto [d, g] = slope(centre, f_);
      double least = INFINITY;
      for (const auto& v : x) least = std::min(least, g.dot(v - centre));
      least += d - slack(arm, piece.t1 - piece.t0) - (curved ? sag : 0);
      // A curved facet is of interest where it lowers the bound; a flat one also where its own least gap is not known yet.
      const bool contact = best_ < o_.contact_mm;
      const double told = least - (curved ? 0 : sag);  // lands of a conical tip surface and their edges have a sag, too
      const bool flat_contact = contact && !curved;
      if ((flat_contact ? least >= std::min(best_flat_, o_.contact_mm) : told >= std::min(proven_, o_.enough_mm)) && (!contact || least >= best_)) {
        proven_ = std::min(proven_, std::max(told, flat_contact ? -INFINITY : proven_));
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        note(target, frustum_distance(x[k], f_), piece.p[k], piece.t0, curved);
        note(target, frustum_distance(x[k + 3], f_), piece.p[k], piece.t1, curved);
      }
      if (best_ < -std::max(0.25, 0.1 * widest_)) {
        proven_ = -widest_;  // no place lies deeper in a body than its radius
        return;
      }
      if (curved && least >= proven_) continue;
      const double fixed = m_.deviation_mm + m_.axis_deviation * arm + (curved ? sag : 0);
      const double reached = contact && !curved ? std::min(best_flat_, o_.contact_mm) : best_;
      if (least + fixed >= reached - leeway(curved) || std::max(size, moved) < kSmallest || ++examined > kMostPieces) {
        proven_ = std::min(proven_, told);
        continue;
      }
      halve(piece, size, moved + (piece.t1 - piece.t0) * turn_rate_ * arm);
    }
  }

  void halve(const Piece& piece, double size, double moved) {
    Piece a = piece, b = piece;
    if (moved > size) {
      a.t1 = b.t0 = 0.5 * (piece.t0 + piece.t1);
    } else {
      std::size_t longest = 0;
      double most = -1;
      for (std::size_t k = 0; k < 3; ++k)
        if (const double l = (piece.p[k] - piece.p[(k + 1) % 3]).norm(); l > most) {
          most = l;
          longest = k;
        }
      const std::size_t next = (longest + 1) % 3;
      const Vec3 middle = 0.5 * (piece.p[longest] + piece.p[next]);
      a.p[next] = middle;
      b.p[longest] = middle;
    }
    pieces_.push_back(b);
    pieces_.push_back(a);
  }

  /// Measures the facets that may hold the deepest place on their patches.
  const Target* refine() {
    std::vector<Target*> order;
    const double window = 2 * part_.cell_sag_mm() + 2 * kFacetProof;
    for (auto& t : targets_)
      if (t.found <= best_ + window) order.push_back(&t);
    std::stable_sort(order.begin(), order.end(), [](const Target* a, const Target* b) { return a->found < b->found; });
    std::size_t measured = 0;
    const Target* best = nullptr;
    for (Target* t : order) {
      if (part_.cells(t->zone)[t->cell].sheet) {
        if (measured++ >= kMostRefined) continue;
        measure(*t);
      }
      if (!best || t->found < best->found) best = t;
    }
    return best;
  }

  /// The gap of one place of a patch at time t; the place is kept between the ends of the ring.
  struct Sight {
    double gap = INFINITY;
    Vec3 p = Vec3::Zero();
    double u = 0, v = 0, t = 0;
  };
  [[nodiscard]] Sight look(const Target& target, double u, double v, double t) const {
    const auto& space = part_.space(target.zone);
    const auto piece = part_.cells(target.zone)[target.cell].piece;
    const auto& zone = space.ring().zone;
    Sight s{INFINITY, Vec3::Zero(), u, v, std::clamp(t, 0.0, 1.0)};
    auto q = space.point(piece, u, v);
    const auto stands = [&](const Vec3& p) {
      const double r = std::hypot(p.x(), p.y()), inside = std::clamp(r, zone.inner_radius_mm, zone.outer_radius_mm);
      return Vec2(inside - r, std::min(0.0, space.surface().z_tip(inside) - p.z()));  // what it lacks in r and z
    };
    for (int k = 0; q && k < 8; ++k) {
      const Vec2 lack = stands(q->p);
      if (std::abs(lack.x()) < 1e-10 && std::abs(lack.y()) < 1e-10) break;
      const auto d = space.at(piece, s.u, s.v);
      if (!d) return s;
      const double r = std::hypot(d->p.x(), d->p.y());
      const double ru = (d->p.x() * d->pu.x() + d->p.y() * d->pu.y()) / r, rv = (d->p.x() * d->pv.x() + d->p.y() * d->pv.y()) / r;
      if (std::abs(lack.y()) < 1e-10) {
        s.v += lack.x() / rv;
      } else {  // to the tip edge, at the radius where it stands or at the end
        const double det = ru * d->pv.z() - rv * d->pu.z();
        s.u += (lack.x() * d->pv.z() - rv * lack.y()) / det;
        s.v += (ru * lack.y() - lack.x() * d->pu.z()) / det;
      }
      q = space.point(piece, s.u, s.v);
    }
    if (!q || stands(q->p).cwiseAbs().maxCoeff() > 1e-7) return s;
    const auto& w = space.surface().shaper;
    const bool flank = piece == SpacePiece::flank_plus || piece == SpacePiece::flank_minus;
    const double low = flank ? -INFINITY : piece == SpacePiece::root ? 0 : w.A_t, high = flank ? w.theta_t : piece == SpacePiece::root ? 1 : w.A_e;
    if (s.u < low || s.u > high) return s;
    s.p = q->p;
    s.gap = frustum_distance(seen(turned(q->p, target.tooth * part_.gear().pitch()), s.t), f_);
    return s;
  }

  /// Search with shrinking steps along the patch and in time, from the place found on the facet.
  void measure(Target& target) const {
    const auto& cell = part_.cells(target.zone)[target.cell];
    const auto& space = part_.space(target.zone);
    Sight best = look(target, cell.u, cell.v, target.t);
    if (const auto foot = space.foot(cell.piece, target.at, cell.u, cell.v))
      if (const Sight s = look(target, foot->u, foot->v, target.t); s.gap < best.gap) best = s;
    target.found = INFINITY;
    if (!(best.gap < INFINITY)) return;  // the facet stands for a piece beyond an end or above the tip
    const double per_t = std::max(travel_ + turn_rate_ * arm_, 1e-9);
    for (double step = kFirstStep; step >= kLastStep;) {
      const auto q = space.at(cell.piece, best.u, best.v);
      if (!q) break;
      const double du = step / std::max(q->pu.norm(), 1e-9), dv = step / std::max(q->pv.norm(), 1e-9), dt = step / per_t;
      Sight next = best;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
          for (int k = -1; k <= 1; ++k) {
            if (i == 0 && j == 0 && k == 0) continue;
            const Sight s = look(target, best.u + i * du, best.v + j * dv, best.t + k * dt);
            if (s.gap < next.gap - 1e-12) next = s;
          }
      if (next.gap < best.gap - 1e-10) best = next;
      else step *= 0.5;
    }
    target.found = best.gap;
    target.t = best.t;
    target.at = best.p;
  }

  const GearDistance& part_;
  const Frustum& f_;
  const ToolMotion& m_;
  const SweptGapOptions& o_;
  double widest_, arm_, travel_ = 0, turn_rate_ = 0;
  bool turns_ = false;
  Vec3 normal_, side_;
  std::vector<Target> targets_;
  std::vector<Piece> pieces_;
  double proven_ = INFINITY;
  double best_ = INFINITY, best_flat_ = INFINITY;  // least gap found: on any facet, on flat ones
};

}  // namespace

double frustum_distance(const Vec3& x, const Frustum& f) { return half_plane(std::sqrt(x.x() * x.x() + x.y() * x.y()), x.z(), f).distance; }

SweptGap swept_gap(const GearDistance& part, const Frustum& body, const ToolMotion& motion, const SweptGapOptions& options) {
  return Sweep(part, body, motion, options).run();
}

}  // namespace toothpath
