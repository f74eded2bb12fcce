#include "cam/analytic/body_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cam/analytic/body_patches.h"
#include "cam/path/motion_blend.h"
#include "cam/proof/roof.h"
#include "geometry/base/angle.h"

namespace toothpath::analytic {
struct NearCells::Found {
  /// A cell of the part at one tooth, and the best place found on it.
  struct Target {
    int zone = 0, tooth = 0;
    std::size_t cell = 0;
    Turn turn{0};  ///< from space 0
    double found = INFINITY;
    Vec3 at = Vec3::Zero();  ///< in space 0
    double height = 0;       ///< above the tip

    [[nodiscard]] Vec3 placed(const Vec3& p) const { return turn(p); }
    [[nodiscard]] Vec3 back(const Vec3& p) const { return turn.back(p); }
  };
  /// As the tool sees it.
  struct Cell {
    Target target;
    Vec3 middle, step;  ///< of its centre: half way between both ends of the motion, and from one to the other
    double strays = 0;  ///< from the straight line between them
  };
  std::vector<Cell> cells;
};

namespace {

constexpr double kWreckDepth = 0.05;    // mm: deeper cuts are followed more coarsely
constexpr double kSmallestQuad = 1e-5;  // mm: smaller quads are not halved
constexpr std::size_t kMostPieces = 400000;
constexpr double kPatience = 2000;  // pieces after which a gap that is too small anyway is followed half as closely
constexpr int kTeeth = 1 << 20;     // a gear has fewer
constexpr double kRoundOff = 1 + 1e-9;
constexpr double kRounding = 1e-9;    // mm: of the bound of a whole cell, with room to spare
constexpr int kTangents = 8;          // planes by which a touching body is brought near to a hull
constexpr int kSecants = 4;           // of the way to each
constexpr int kShareSteps = 3;        // rounds over the directions of a cell
constexpr double kFlat = 0.02;        // share of the first slope at which a way ends
constexpr double kTimeMatters = 0.1;  // of the contact's proof
constexpr double kLongWay = 4;        // sizes of a quad that it may pass by undivided
constexpr double kLeastTurn = 1e-8;   // rad: the normal of a smaller turn is rounding, and any frame turns with it

using Target = NearCells::Found::Target;
using NearCell = NearCells::Found::Cell;

/// A quad of the part during a stretch of the motion.
struct Piece {
  BodyQuad quad;
  std::uint32_t target = 0;
  double t0 = 0, t1 = 1;
  double least = -INFINITY;         ///< it comes no nearer than this
  const NearCell* whole = nullptr;  ///< the cell, where the piece is all of it
};

/// The frame of the tool at one moment: two directions across the axis, and the axis.
struct View {
  Vec3 tip, across, beside, axis;
  [[nodiscard]] Vec3 operator()(const Vec3& p_W) const {
    const Vec3 d = p_W - tip;
    return {d.dot(across), d.dot(beside), d.dot(axis)};
  }
  [[nodiscard]] Vec3 turned(const Vec3& d_W) const { return {d_W.dot(across), d_W.dot(beside), d_W.dot(axis)}; }
  [[nodiscard]] Vec3 direction(const Vec3& g_T) const { return g_T.x() * across + g_T.y() * beside + g_T.z() * axis; }
};

/// A motion as the tool sees the part pass by.
class Course {
 public:
  explicit Course(const path::ToolMotion& motion) : m_(motion) {
    const Vec3 cross = m_.axis_from.cross(m_.axis_to);
    turns_ = m_.axis_from != m_.axis_to;
    normal_ = cross.norm() > kLeastTurn ? Vec3(cross.normalized()) : Vec3(m_.axis_from.unitOrthogonal());
    side_ = m_.axis_from.cross(normal_);
    travel_ = (m_.tip_to - m_.tip_from).norm();
    const double half = std::min(0.5 * (m_.axis_to - m_.axis_from).norm(), 0.9999);
    turn_rate_ = 2 * half / std::sqrt(1 - half * half);
  }
  [[nodiscard]] View view(double t) const {
    if (!turns_) return {path::tip_at(m_, t), normal_, side_, m_.axis_from};
    const Vec3 a = path::axis_at(m_, t), across = (normal_ - a * a.dot(normal_)).normalized();
    return {path::tip_at(m_, t), across, a.cross(across), a};
  }
  /// What a place at distance `arm` from the tip may leave of the straight line between its two places, seen from the
  /// tool.
  [[nodiscard]] double slack(double arm, double dt) const {
    const double T = turn_rate_;
    return m_.deviation_mm + m_.axis_deviation * arm +
           (T * T * std::sqrt(1 + T * T) * arm + 2 * T * travel_) * dt * dt / 8;
  }
  /// No point h from the tip goes farther than this.
  [[nodiscard]] double way(double h) const { return travel_ + h * (m_.axis_to - m_.axis_from).norm(); }
  [[nodiscard]] bool turns() const { return turns_; }
  [[nodiscard]] double turn_rate() const { return turn_rate_; }

 private:
  const path::ToolMotion& m_;
  double travel_ = 0, turn_rate_ = 0;
  bool turns_ = false;
  Vec3 normal_, side_;
};

/// How far the body reaches from its tip.
double arm_of(const tool::RoundedFrustum& body) { return std::hypot(body.core.to + body.round, body.widest()); }

/// Largest radius between two heights.
double widest_between(const tool::RoundedFrustum& body, double low, double high) {
  const tool::Frustum& f = body.core;
  const auto at = [&](double h) {
    return f.radius_from + std::clamp((h - f.from) / (f.to - f.from), 0.0, 1.0) * (f.radius_to - f.radius_from);
  };
  return std::max(at(low - body.round), at(high + body.round)) + body.round;
}

/// Spheres about stretches of some bodies at some moments of a motion, and the cells in them.
class CellSearch {
 public:
  CellSearch(const GearDistance& part, std::span<const tool::RoundedFrustum> bodies, const path::ToolMotion& m,
             double enough)
      : part_(part), bodies_(bodies), m_(m), course_(m), enough_(enough) {
    for (const auto& body : bodies) {
      low_ = std::min(low_, body.core.from - body.round);
      high_ = std::max(high_, body.core.to + body.round);
      widest_ = std::max(widest_, body.widest());
      arm_ = std::max(arm_, arm_of(body));
    }
    enough_ += m.deviation_mm + m.axis_deviation * arm_;
  }

  /// Each once: zone, tooth, cell in order.
  [[nodiscard]] std::vector<NearCell> cells() const {
    const double pitch = part_.part().pitch();
    const View first = course_.view(0), last = course_.view(1);
    std::vector<NearCell> out;
    Target cell{-1, 0, 0};
    for (const auto& key : keys()) {
      const int zone = int(key >> 56), tooth = int(key >> 32 & 0xffffff) - kTeeth;
      if (zone != cell.zone || tooth != cell.tooth) cell = {zone, tooth, 0, Turn(tooth * pitch)};
      cell.cell = std::size_t(key & 0xffffffff);
      const Vec3 c = cell.placed(part_.patches(zone).box(cell.cell).centre), a = first(c), b = last(c);
      out.push_back(
          {cell, 0.5 * (a + b), b - a, course_.slack(std::sqrt(std::max(a.squaredNorm(), b.squaredNorm())), 1)});
    }
    return out;
  }

 private:
  [[nodiscard]] std::vector<std::uint64_t> keys() const {
    const double way = course_.way(arm_), length = high_ - low_;
    const int parts = std::clamp(int(std::ceil(way / (widest_ + enough_))), 1, 4096);
    const int links = std::max(1, int(std::ceil(length / std::max(widest_, 0.5))));
    const double half = 0.5 * length / links;
    std::vector<std::uint64_t> keys;
    for (int k = 0; k < links; ++k) {
      const double from = low_ + 2 * k * half, to = from + 2 * half;
      double widest = -1;
      for (const auto& body : bodies_)
        if (body.core.from - body.round <= to && body.core.to + body.round >= from)
          widest = std::max(widest, widest_between(body, from, to));
      if (widest < 0) continue;
      for (int q = 0; q < parts; ++q) {
        const double t = (q + 0.5) / parts;
        add(path::tip_at(m_, t) + path::axis_at(m_, t) * (0.5 * (from + to)),
            std::hypot(widest, half) + enough_ + 0.5 * way / parts, keys);
      }
    }
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    return keys;
  }

  /// The cells within a sphere.
  void add(const Vec3& x, double radius_mm, std::vector<std::uint64_t>& keys) const {
    const tooth_space::ToothedPart& part = part_.part();
    const double pitch = part.pitch(), s = part.chart().along(x);
    for (int zone = 0; zone < part_.zones(); ++zone) {
      const auto& ring = part.space(zone).outline();
      const double reach = radius_mm + part_.patches(zone).search_margin();
      double from = ring.s_from, to = ring.s_to;
      if (const auto groove = part.groove(); groove && zone == 0) {  // its floor is told with the first zone
        from = std::min(from, groove->from);
        to = std::max(to, groove->to);
      }
      if (part.chart().up(x) - reach > part.blank_top()) continue;
      if (s + reach < from || s - reach > to) continue;
      const double away = std::remainder(azimuth(x) - part_.space_azimuth(zone, s), kTwoPi);
      const int index = int(std::lround(away / pitch)),
                wide = 1 + int(std::ceil(reach / (pitch * part_.least_radius(zone))));
      for (int tooth = index - wide; tooth <= index + wide; ++tooth)
        part_.cell_index(zone).near(turned(x, -tooth * pitch), reach, [&](std::size_t c, double within) {
          keys.push_back(std::uint64_t(zone) << 56 | std::uint64_t(tooth + kTeeth) << 32 | c);
          return within;
        });
    }
  }

  const GearDistance& part_;
  std::span<const tool::RoundedFrustum> bodies_;
  const path::ToolMotion& m_;
  Course course_;
  double enough_, low_ = INFINITY, high_ = -INFINITY, widest_ = 0, arm_ = 0;
};

}  // namespace

NearCells::NearCells(const GearDistance& part, std::span<const tool::RoundedFrustum> bodies,
                     const path::ToolMotion& motion, double enough_mm)
    : found_(std::make_unique<Found>(Found{CellSearch(part, bodies, motion, enough_mm).cells()})) {}
NearCells::NearCells(NearCells&&) noexcept = default;
NearCells& NearCells::operator=(NearCells&&) noexcept = default;
NearCells::~NearCells() = default;

namespace {

/// A cell along the whole motion as the tool sees it half way: within x a + y b + z c, |x|, |y|, |z| <= 1, of its
/// middle, but for `off`.
class FlatCell {
 public:
  /// @param turned  how far the tool turns from half way on, rad
  FlatCell(const NearCell& near, const BodyBox& box, const View& half_way, double turned)
      : middle_(near.middle),
        along_{half_way.turned(near.target.placed(box.a)), half_way.turned(near.target.placed(box.b)),
               Vec3(0.5 * near.step)},
        off_(box.off + box.radius * turned + near.strays + kRounding) {}

  /// The tangent plane of a convex distance at x, where it is d and has the slope g, under all of it.
  [[nodiscard]] double under(const Vec3& x, double d, const Vec3& g) const {
    double least = d + g.dot(middle_ - x) - off_;
    for (const Vec3& e : along_) least -= std::abs(g.dot(e));
    return least;
  }

  /// The same where a round body about as thick as there comes nearest, or not far from it.
  [[nodiscard]] double under(const tool::RoundedFrustum& body) const {
    const Vec3 g = tool::rounded_slope(middle_, body).gradient;
    const double rho = std::max(std::hypot(middle_.x(), middle_.y()), 1e-6);
    const Vec3 around(-middle_.y() / rho, middle_.x() / rho, 0);
    std::array<double, 3> share{}, slope{}, round{};
    for (std::size_t k = 0; k < 3; ++k) {
      slope[k] = g.dot(along_[k]);
      round[k] = around.dot(along_[k]);
    }
    for (int n = 0; n < kShareSteps; ++n)
      for (std::size_t k = 0; k < 3; ++k) {
        const double rest = round[0] * share[0] + round[1] * share[1] + round[2] * share[2] - round[k] * share[k];
        const double down = slope[k] + round[k] * rest / rho, bend = round[k] * round[k] / rho;
        share[k] = std::abs(down) >= bend ? (down > 0 ? -1.0 : 1.0) : -down / bend;
      }
    const Vec3 x = middle_ + share[0] * along_[0] + share[1] * along_[1] + share[2] * along_[2];
    const auto [d, there] = tool::rounded_slope(x, body);
    return under(x, d, there);
  }

 private:
  const Vec3& middle_;
  std::array<Vec3, 3> along_;
  double off_;
};

class Sweep {
 public:
  Sweep(const GearDistance& part, const tool::RoundedFrustum& body, const path::ToolMotion& m,
        const SweptGapOptions& options)
      : part_(part),
        body_(body),
        f_(body.core),
        m_(m),
        o_(options),
        widest_(body.widest()),
        arm_(arm_of(body)),
        course_(m),
        turns_(course_.turns()),
        turn_rate_(course_.turn_rate()),
        roof_(part.part()),
        half_way_(course_.view(0.5)),
        turned_(0.5 * turn_rate_ + m.axis_deviation) {}

  /// @param near  none: found here
  SweptGap run(const NearCells* near) {
    SweptGap out{o_.enough_mm, o_.enough_mm, 0, "tooth", m_.tip_to};
    const double above = least_height();
    if (above >= o_.enough_mm) return out;
    std::vector<NearCell> own;
    if (!near) own = CellSearch(part_, std::span(&body_, 1), m_, o_.enough_mm).cells();
    gather(near ? near->found().cells : own);
    prove();
    out.pieces = examined_;
    out.proven_mm = std::max({std::min(o_.enough_mm, proven_), above, -widest_});  // no place lies deeper in a body
    const Target* best = nullptr;
    for (const auto& t : targets_)
      if (t.found < (best ? best->found : o_.enough_mm)) best = &t;
    if (!best) return out;
    out.measured_mm = std::max(best->found, out.proven_mm);
    out.zone = best->zone;
    out.place = best->at;
    out.height_mm = best->height;
    out.patch = to_string(part_.patches(best->zone).surface(best->cell).piece);
    return out;
  }

 private:
  /// How far the body stays above the part over the whole motion.
  [[nodiscard]] double least_height() const {
    return roof_.over(body_, m_.tip_from, m_.axis_from, m_.tip_to, m_.axis_to) -
           arm_ * ((m_.axis_to - m_.axis_from).norm() + m_.axis_deviation) - m_.deviation_mm;
  }
  [[nodiscard]] View view(double t) const { return course_.view(t); }
  [[nodiscard]] double slack(double arm, double dt) const { return course_.slack(arm, dt); }

  void gather(const std::vector<NearCell>& cells) {
    const double enough = o_.enough_mm + m_.deviation_mm + m_.axis_deviation * arm_;
    const tool::PlacedFrustum in_T(f_, Vec3::Zero(), Vec3::UnitZ());
    struct Near {
      double about, least;  ///< gap of a sphere about the cell, which tells the order, and of the cell
      const NearCell* cell;
    };
    std::vector<Near> order;
    for (const NearCell& near : cells) {
      const auto& patches = part_.patches(near.target.zone);
      if (o_.flanks_only && !is_flank(patches.surface(near.target.cell).piece)) continue;
      const BodyBox& box = patches.box(near.target.cell);
      const double away = 0.5 * near.step.norm() + near.strays + box.radius;
      if (in_T.beyond(near.middle, (enough + away + body_.round) * kRoundOff)) continue;
      const auto [d, g] = tool::rounded_slope(near.middle, body_);
      if (d - away > enough) continue;
      const double least = std::max(d - away, FlatCell(near, box, half_way_, turned_).under(near.middle, d, g));
      if (least <= enough) order.push_back({d - away, least, &near});
    }
    // The nearest comes last and is looked at first.
    std::stable_sort(order.begin(), order.end(), [](const Near& x, const Near& y) { return x.about > y.about; });
    for (const auto& [about, least, cell] : order) {
      const Target& target = cell->target;
      pieces_.push_back(
          {part_.patches(target.zone).quad(target.cell), std::uint32_t(targets_.size()), 0, 1, least, cell});
      targets_.push_back(target);
    }
  }

  void note(Target& target, double gap, const Vec3& place, double height) {
    best_ = std::min(best_, gap);
    if (gap >= target.found) return;
    target.found = gap;
    target.at = place;
    target.height = height;
  }

  /// How far below a gap that was found the bound of a piece may lie: the farther the longer it takes, where less was
  /// found than is asked for.
  [[nodiscard]] double leeway(double gap) const {
    const double close =
        gap >= o_.contact_mm ? o_.proof_mm : std::max(0.5 * o_.contact_proof_mm, -0.1 * (gap + kWreckDepth));
    return best_ < o_.asked_mm ? close * std::exp2(double(examined_) / kPatience) : close;
  }
  /// Is this bound near enough to the least gap found? One that says less than what is asked for, where what was found
  /// is as much, is followed as closely as a contact.
  [[nodiscard]] bool near_enough(double bound) const {
    const bool undecided = bound < o_.asked_mm && best_ >= o_.asked_mm;
    return bound >= best_ - (undecided ? 0.5 * o_.contact_proof_mm : leeway(std::min(best_, bound)));
  }

  /// The corners of a piece at both ends of its time, as the tool sees them.
  struct Seen {
    BodyHull hull;
    View from, to;
    std::array<Vec3, 2 * std::tuple_size_v<decltype(BodyHull::corner)>> x;
    double arm = 0, moved = 0;
    Vec3 centre = Vec3::Zero();
    [[nodiscard]] std::size_t count() const { return 2 * hull.count; }
  };
  [[nodiscard]] Seen seen(const Piece& piece, const Target& target, const BodyHull& hull) const {
    Seen s{hull, view(piece.t0), view(piece.t1), {}, 0, 0, Vec3::Zero()};
    for (std::size_t k = 0; k < hull.count; ++k) {
      const Vec3 p = target.placed(hull.corner[k].p);
      const Vec3 &a = s.x[2 * k] = s.from(p), &b = s.x[2 * k + 1] = s.to(p);
      s.arm = std::max({s.arm, a.squaredNorm(), b.squaredNorm()});
      s.moved = std::max(s.moved, (b - a).squaredNorm());
      s.centre += a + b;
    }
    s.arm = std::sqrt(s.arm);
    s.moved = std::sqrt(s.moved);
    s.centre /= double(s.count());
    return s;
  }

  /// A tangent plane of the signed distance at a place of the hull, and the corner that lies deepest under it.
  struct Tangent {
    Vec3 at = Vec3::Zero(), gradient = Vec3::Zero();
    double distance = 0, fall = INFINITY;  ///< there, and from there to the deepest corner
    std::size_t deepest = 0;
    /// Bound over the hull, less what it may stand above the surface and what the motion leaves of it.
    [[nodiscard]] double least(double over = 0, double lost = 0) const { return fall + (distance - over - lost); }
  };
  [[nodiscard]] Tangent tangent(const Seen& s, const Vec3& at) const {
    const auto [d, g] = tool::rounded_slope(at, body_);
    Tangent t{at, g, d, INFINITY, 0};
    for (std::size_t k = 0; k < s.count(); ++k)
      if (const double fall = g.dot(s.x[k] - at); fall < t.fall) {
        t.fall = fall;
        t.deepest = k;
      }
    return t;
  }

  /// Shares of the corners in a place of the hull.
  using Shares = std::array<double, 2 * std::tuple_size_v<decltype(BodyHull::corner)>>;

  /// Nearer to where the body comes nearest to the hull (Frank and Wolfe: towards the corner that lies deepest under
  /// the tangent, as far as the distance falls), until the plane there bounds enough, or nothing could. The best plane
  /// met; `shares` of the last place.
  [[nodiscard]] Tangent nearest_tangent(const Seen& s, const Tangent& first, double enough, Tangent& last,
                                        Shares& shares) const {
    Tangent best = first;
    last = first;
    for (std::size_t k = 0; k < s.count(); ++k) shares[k] = 1.0 / double(s.count());
    for (int k = 0; k < kTangents && best.least() < enough && last.distance >= enough; ++k) {
      const Vec3 from = last.at, way = s.x[last.deepest] - from;
      const double slope = last.gradient.dot(way);
      if (!(slope < 0)) break;
      const std::size_t corner = last.deepest;
      // The zero of the slope along the way, by false position that keeps its bracket (Illinois).
      double a = 0, fa = slope, b = 1, x = 1;
      Tangent t = tangent(s, s.x[corner]);
      if (t.least() > best.least()) best = t;
      double fb = t.gradient.dot(way);
      for (int n = 0; n < kSecants && fb > 0; ++n) {
        x = a + (b - a) * fa / (fa - fb);
        t = tangent(s, from + x * way);
        if (t.least() > best.least()) best = t;
        const double f = t.gradient.dot(way);
        if (std::abs(f) < kFlat * -slope) break;
        if (f < 0) {
          a = x, fa = f, fb *= 0.5;
        } else {
          b = x, fb = f, fa *= 0.5;
        }
      }
      last = t;
      for (std::size_t n = 0; n < s.count(); ++n) shares[n] *= 1 - x;
      shares[corner] += x;
    }
    return best;
  }

  /// What surface and motion may leave of the hull along the gradient of a plane.
  [[nodiscard]] double above(const Piece& piece, const Target& target, const Vec3& g) const {
    const auto& patches = part_.patches(target.zone);
    const double sag = turns_ ? patches.sag(target.cell, piece.quad) : 0;  // g turns with the tool
    return patches.above(target.cell, piece.quad, target.back(view(0.5 * (piece.t0 + piece.t1)).direction(g))) +
           0.5 * (piece.t1 - piece.t0) * turn_rate_ * sag;
  }

  void prove() {
    best_ = o_.enough_mm;
    while (!pieces_.empty()) {
      const Piece piece = pieces_.back();
      pieces_.pop_back();
      if (piece.least >= std::min(best_, o_.enough_mm)) continue;
      Target& target = targets_[piece.target];
      const auto& patches = part_.patches(target.zone);
      if (piece.whole && o_.touching &&
          FlatCell(*piece.whole, patches.box(target.cell), half_way_, turned_).under(body_) >=
              std::min(best_, o_.enough_mm))
        continue;
      const BodyHull hull = patches.outline(target.cell, piece.quad);
      if (hull.count == 0) continue;  // wholly beyond the ring
      const double dt = piece.t1 - piece.t0;
      const Seen s = seen(piece, target, hull);
      // The tangent plane at the middle, under every corner, less what the surface and the motion leave of the hull.
      const Tangent middle = tangent(s, s.centre);
      const double sag = turns_ ? patches.sag(target.cell, piece.quad) : 0, lost = slack(s.arm + sag, dt);
      double over = above(piece, target, middle.gradient), least = middle.least(over, lost);
      const double fixed = m_.deviation_mm + m_.axis_deviation * s.arm;
      if (o_.touching && least < std::min(best_, o_.enough_mm))
        least = std::max(least, touched(piece, target, s, middle, over, lost, fixed));
      if (least >= std::min(best_, o_.enough_mm)) {
        proven_ = std::min(proven_, least);
        continue;
      }
      for (std::size_t k = 0; k < s.count(); ++k)
        look(target, patches, s.hull.corner[k / 2], s.x[k], k % 2 == 0 ? s.from : s.to);
      if (best_ < -std::max(0.25, 0.1 * widest_)) {
        proven_ = -INFINITY;
        return;
      }
      const double size = patches.size(target.cell, piece.quad);
      if (near_enough(least + fixed) || least + fixed >= o_.settled_mm ||
          std::max(size, s.moved) < std::max(kSmallestQuad, patches.stays(target.cell, piece.quad)) ||
          ++examined_ > kMostPieces || !std::isfinite(least)) {
        proven_ = std::min(proven_, std::isfinite(least) ? least : -INFINITY);
        continue;
      }
      halve(piece, patches, target.cell,
            o_.touching ? in_time(piece, s, size, over) : s.moved + dt * turn_rate_ * s.arm > size);
    }
  }

  /// The bound of a piece by planes where the body comes nearest, and what is found there. @param over what the surface
  /// leaves along the first plane
  double touched(const Piece& piece, Target& target, const Seen& s, const Tangent& middle, double& over, double lost,
                 double fixed) {
    const double wanted = std::min(best_ - leeway(best_), o_.settled_mm) - fixed;
    Tangent last;
    Shares shares{};
    const Tangent best = nearest_tangent(s, middle, wanted + over + lost, last, shares);
    if (last.distance - over < best_) look_between(piece, target, s, shares);
    over = above(piece, target, best.gradient);
    return best.least(over, lost);
  }

  /// The place of the surface with these shares of the corners, at the moment with the shares of both ends.
  void look_between(const Piece& piece, Target& target, const Seen& s, const Shares& shares) {
    Vec2 at = Vec2::Zero();
    double later = 0;
    for (std::size_t k = 0; k < s.count(); ++k) {
      at += shares[k] * s.hull.corner[k / 2].at;
      if (k % 2 == 1) later += shares[k];
    }
    const auto p = part_.patches(target.zone).settled(target.cell, at);
    if (!p) return;
    const Vec3 x = view(piece.t0 + later * (piece.t1 - piece.t0))(target.placed(*p));
    note(target, tool::rounded_distance(x, body_), *p, x.z());
  }

  /// Is time halved, or the quad? Time where the arc of the axis or the turn between the corners loses more than the
  /// bend of the surface, and enough to matter; and where the quad passes by far. What else a bound lacks, corners
  /// beyond the ring or a plane that is not the best, goes with the quad.
  [[nodiscard]] bool in_time(const Piece& piece, const Seen& s, double size, double over) const {
    const double dt = piece.t1 - piece.t0, arcs = slack(s.arm, dt) - m_.deviation_mm - m_.axis_deviation * s.arm;
    const double twist = 0.25 * dt * turn_rate_ * size;  // between the corners, out of one plane
    return arcs + twist > std::max(over, kTimeMatters * o_.contact_proof_mm) || s.moved > kLongWay * size;
  }

  /// The gap of a corner, where it can be the least: of a place of the surface only.
  void look(Target& target, const BodyPatches& patches, const FacetCorner& corner, const Vec3& seen, const View& at) {
    const double gap = tool::rounded_distance(seen, body_);
    if (corner.stands) {
      note(target, gap, corner.p, seen.z());
    } else if (gap < best_) {
      const auto p = patches.settled(target.cell, corner.at);
      if (!p) return;
      const Vec3 x = at(target.placed(*p));
      note(target, tool::rounded_distance(x, body_), *p, x.z());
    }
  }

  void halve(const Piece& piece, const BodyPatches& patches, std::size_t cell, bool in_time) {
    Piece a = piece;
    a.whole = nullptr;
    Piece b = a;
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
  const tool::RoundedFrustum& body_;
  const tool::Frustum& f_;
  const path::ToolMotion& m_;
  const SweptGapOptions& o_;
  double widest_, arm_;
  Course course_;
  bool turns_;
  double turn_rate_;
  proof::Roof roof_;
  View half_way_;
  double turned_;  // from half way on
  std::vector<Target> targets_;
  std::vector<Piece> pieces_;
  double proven_ = INFINITY;
  double best_ = INFINITY;  // least gap found
  std::size_t examined_ = 0;
};

}  // namespace

SweptGap swept_gap(const GearDistance& part, const tool::RoundedFrustum& body, const path::ToolMotion& motion,
                   const SweptGapOptions& options) {
  return Sweep(part, body, motion, options).run(nullptr);
}

SweptGap swept_gap(const GearDistance& part, const tool::RoundedFrustum& body, const path::ToolMotion& motion,
                   const SweptGapOptions& options, const NearCells& near) {
  return Sweep(part, body, motion, options).run(&near);
}

SweptGap swept_gap(const GearDistance& part, const tool::Frustum& body, const path::ToolMotion& motion,
                   const SweptGapOptions& options) {
  return swept_gap(part, tool::RoundedFrustum{body, 0}, motion, options);
}

}  // namespace toothpath::analytic
