#include "cam/finger_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "cam/finger_milling.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr double kUntouched = 1e6;       // mm of "excess" where nothing came near
constexpr double kBetween = 5e-5;        // mm: what the centre may do between two poses at which it is judged
constexpr int kMostSamples = 2000;
constexpr double kEndSlack = 2e-3;       // mm along a pass
constexpr std::size_t kWorstPlaces = 20;

/// Largest n . p of the blank in direction u: the rings of its cone surfaces.
double blank_support(const BevelGear& g, const Vec3& u) {
  const double h_a = g.parameters().addendum_mm, low = -g.parameters().dedendum_mm - 2 * g.parameters().outer_transverse_module_mm;
  double top = -1e300;
  for (const double ell : {g.R_i(), g.R_e()})
    for (const double height : {h_a, low}) {
      const double r = std::max(0.0, ell * g.sin_delta() + height * g.cos_delta()), z = ell * g.cos_delta() - height * g.sin_delta();
      top = std::max(top, r * std::hypot(u.x(), u.y()) + z * u.z());
    }
  return top;
}

Vec3 blend_axis(const ToolMotion& m, double t) { return ((1 - t) * m.axis_from + t * m.axis_to).normalized(); }
Vec3 blend_tip(const ToolMotion& m, double t) { return m.tip_from + t * (m.tip_to - m.tip_from); }

/// A motion turned to tooth space 0.
ToolMotion turned(const ToolMotion& m, double pitch) {
  if (m.tooth == 0) return m;
  const Mat3 R = Eigen::AngleAxisd(-pitch * m.tooth, Vec3::UnitZ()).toRotationMatrix();
  ToolMotion out = m;
  out.tip_from = R * m.tip_from;
  out.tip_to = R * m.tip_to;
  out.axis_from = R * m.axis_from;
  out.axis_to = R * m.axis_to;
  return out;
}

/// The cutter's radius by height in a table, for quick lower bounds of a distance.
class RadiusTable {
 public:
  explicit RadiusTable(const FingerSolid& solid) : low_(solid.profile().x_B), high_(solid.profile().x_D) {
    for (int i = 0; i <= kCells; ++i) radius_[static_cast<std::size_t>(i)] = solid.radius(low_ + (high_ - low_) * i / kCells);
    slope_ = 0;
    for (int i = 0; i < kCells; ++i)
      slope_ = std::max(slope_, std::atan((radius_[static_cast<std::size_t>(i) + 1] - radius_[static_cast<std::size_t>(i)]) / ((high_ - low_) / kCells)));
    shrink_ = std::cos(slope_);
    for (int i = 0; i <= kCells; ++i) lower_[static_cast<std::size_t>(i)] = solid.lower_surface(solid.largest_radius() * i / kCells);
    radius_end_ = solid.largest_radius();
  }
  /// Never above the lower surface at radius rho.
  [[nodiscard]] double floor_below(double rho) const {
    return lower_[static_cast<std::size_t>(std::clamp(rho / radius_end_, 0.0, 1.0) * kCells)];
  }
  /// Never more than the distance from (x, rho) to the solid.
  [[nodiscard]] double lower_bound(double x, double rho) const {
    const double s = std::clamp((x - low_) / (high_ - low_), 0.0, 1.0) * kCells;
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(s), kCells - 1);
    return (rho - radius_[i + 1]) * shrink_;  // the next node: the radius never falls with x
  }

 private:
  static constexpr int kCells = 256;
  double low_, high_, slope_, shrink_ = 1, radius_end_ = 0;
  std::array<double, kCells + 1> lower_{};
  std::array<double, kCells + 1> radius_{};
};

struct ToolState {
  BevelGear gear;           // made with this tool
  FingerSolid solid;
  RadiusTable table;
  WallReference walls[2];   // L, U
  double shape_mm = 0;      // how far this tool on its own paths cuts beyond the gear's walls
  double depth_mm;          // tip to the height h_a
  double shank_from_mm, holder_from_mm;  // above the tip

  ToolState(const BevelGear& own, const ToolAssembly& tool)
      : gear(own), solid(own.cutter()), table(solid), walls{WallReference(own, 1), WallReference(own, -1)},
        depth_mm(own.parameters().dedendum_mm + own.parameters().addendum_mm),
        shank_from_mm(tool.flute_length_mm > 0 ? tool.flute_length_mm : own.parameters().dedendum_mm + tool.profile_height_mm),
        holder_from_mm(tool.holder.empty() ? 1e6 : tool.stick_out_mm) {}
};

struct WallPoint {
  int half = 0, wall = 0, row = 0, column = 0;
  Vec3 p = Vec3::Zero(), n = Vec3::Zero();
};

/// Signed distance from a point to the cutter along one motion, least over the motion.
double least_distance(const Vec3& p, const ToolMotion& m, const ToolState& tool, double best) {
  const double h_f = tool.gear.parameters().dedendum_mm;
  const auto meridian = [&](double t) {
    const Vec3 u = blend_axis(m, t), w = p - blend_tip(m, t);
    const double s = w.dot(u);
    return Vec2(s - h_f, (w - s * u).norm());
  };
  const double length = (m.tip_to - m.tip_from).norm() + (m.axis_to - m.axis_from).norm() * tool.depth_mm;
  const Vec2 mid = meridian(0.5);
  if (tool.table.lower_bound(mid[0], mid[1]) - 0.5 * length > best) return best;
  const auto distance = [&](double t) {
    const Vec2 q = meridian(t);
    return tool.solid.signed_distance(q[0], q[1]);
  };
  const double middle = tool.solid.signed_distance(mid[0], mid[1]);
  if (middle - 0.5 * length > best) return best;
  // Near the contact the distance is a smooth bowl: successive parabolas through the best three.
  double a = 0, fa = distance(0), c = 1, fc = distance(1), b = 0.5, fb = middle;
  double least = std::min({best, fa, fb, fc});
  for (int k = 0; k < 6; ++k) {
    const double d1 = (fb - fa) / (b - a), d2 = (fc - fb) / (c - b), bend = (d2 - d1) / (c - a);
    if (!(bend > 0)) break;
    const double t = std::clamp(0.5 * (a + b) - 0.5 * d1 / bend, a, c);
    const double expected = fb + (t - b) * (d1 + bend * (t - a));
    if (expected > least - 1e-9 || std::abs(t - b) < 1e-6) break;
    const double f = distance(t);
    least = std::min(least, f);
    if (t < b) {
      if (f < fb) c = b, fc = fb, b = t, fb = f;
      else a = t, fa = f;
    } else {
      if (f < fb) a = b, fa = fb, b = t, fb = f;
      else c = t, fc = f;
    }
    if (!(b > a) || !(c > b)) break;
  }
  return least;
}

/// Height of the cutter's lower surface above the root cone on the normal of the pitch cone at (ell, azimuth), least over
/// one motion; `best` where it does not reach it.
double covering_height(const ToolState& tool, const Vec3& foot, const Vec3& normal, const ToolMotion& m, double best) {
  const double h_f = tool.gear.parameters().dedendum_mm, rho_max = tool.solid.largest_radius();
  // Closest approach of the axis to the foot point.
  const Vec3 u = blend_axis(m, 0.5), w = foot - m.tip_from, d = m.tip_to - m.tip_from;
  const Vec3 wp = w - w.dot(u) * u, dp = d - d.dot(u) * u;
  const double d2 = dp.squaredNorm();
  // Down moves: the lower end.
  double t = d2 > 1e-16 ? std::clamp(wp.dot(dp) / d2, 0.0, 1.0) : (d.dot(u) < 0 ? 1.0 : 0.0);
  const double nearest = (wp - t * dp).norm();
  if (nearest > rho_max + 1) return best;
  // Even straight above the nearest place the cutter is higher than what is left already. The normal leans by rho/r_v
  // against the axis, which shifts the radius by less than 0.2 mm over the depth of a tooth.
  if (tool.table.floor_below(std::max(0.0, nearest - 0.2)) + h_f - 0.05 > best) return best;
  const Vec3 axis = blend_axis(m, t), tip = blend_tip(m, t);
  double h = 0;
  for (int k = 0; k < 12; ++k) {
    const Vec3 v = foot + h * normal - tip;
    const double s = v.dot(axis), rho = (v - s * axis).norm();
    if (rho > rho_max) return best;
    const double step = tool.solid.lower_surface(rho) - (s - h_f);
    h += step / std::max(0.2, axis.dot(normal));
    if (std::abs(step) < 1e-9) break;
  }
  return std::min(best, h);
}

}  // namespace

std::vector<ToolMotion> motions_of(const ClPath& path) {
  std::vector<ToolMotion> out;
  for (std::size_t i = 1; i < path.records.size(); ++i) {
    const ClRecord &a = path.records[i - 1], &b = path.records[i];
    ToolMotion m;
    m.tip_from = a.tip;
    m.tip_to = b.tip;
    m.axis_from = a.axis;
    m.axis_to = b.axis;
    m.rapid = b.kind == MoveKind::rapid;
    m.operation = path.operation;
    m.line = static_cast<int>(i);
    if (b.feed_mm_min > 0) m.minutes = (b.tip - a.tip).norm() / b.feed_mm_min;
    out.push_back(m);
  }
  return out;
}

struct FingerGougeCheck::State {
  BevelGear gear;
  std::vector<ToolAssembly> tools;
  std::vector<MillingOperation> operations;
  Tolerances tol;
  FingerCheckOptions opt;
  std::vector<std::unique_ptr<ToolState>> states;  // by tool index, only those in use
  std::optional<Diagnostic> error;
  std::vector<WallPoint> points;

  State(const BevelGear& g, std::span<const ToolAssembly> t, std::span<const MillingOperation> o, const Tolerances& tolerances,
        const FingerCheckOptions& options)
      : gear(g), tools(t.begin(), t.end()), operations(o.begin(), o.end()), tol(tolerances), opt(options) {
    states.resize(tools.size());
    for (const auto& op : operations) {
      auto& state = states[static_cast<std::size_t>(op.tool)];
      if (state) continue;
      auto own = gear_for_finger_mill(gear, tools[static_cast<std::size_t>(op.tool)]);
      if (!own) {
        error = own.error();
        continue;
      }
      state = std::make_unique<ToolState>(*own, tools[static_cast<std::size_t>(op.tool)]);
      state->shape_mm = shape_difference(*own);
    }
    wall_points();
  }

  const ToolState* tool_of(int operation) const {
    if (operation < 0 || static_cast<std::size_t>(operation) >= operations.size()) return nullptr;
    return states[static_cast<std::size_t>(operations[static_cast<std::size_t>(operation)].tool)].get();
  }
  std::string patch(int wall) const { return wall == 0 ? "wall L" : "wall U"; }

  /// Tooth flanks of another mill on its own paths: how far it cuts beyond ours.
  double shape_difference(const BevelGear& own) const {
    const auto &a = own.cutter_data(), &b = gear.cutter_data();
    if (a.module_mm == b.module_mm && a.tip_radius_mm == b.tip_radius_mm && a.rack_depth_mm == b.rack_depth_mm) return 0;
    double worst = 0;
    const double low = -gear.parameters().dedendum_mm, high = gear.parameters().addendum_mm;
    for (std::size_t i = 0; i < gear.halves().size(); ++i)
      for (int k = 0; k < 2; ++k)
        for (int c = 0; c <= 16; ++c)
          for (int r = 0; r <= 32; ++r) {
            const auto& half = gear.halves()[i];
            const double ell = half.ell_from + (half.ell_to - half.ell_from) * c / 16.0;
            const double height = low + (high - low) * (r + 0.05) / 32.05;
            const auto ours = bevel_inverse(half.walls[k], ell, height), theirs = bevel_inverse(own.halves()[i].walls[k], ell, height);
            if (!ours || !theirs) continue;
            const double lateral = half.walls[k].sigma * (ours->azimuth - theirs->azimuth) * (ell * gear.sin_delta() + height * gear.cos_delta());
            worst = std::max(worst, lateral);
          }
    return worst;
  }

  /// Grid of a wall: equal steps of the profile parameter, equal steps along the face up to both ends.
  void wall_points() {
    for (std::size_t i = 0; i < gear.halves().size(); ++i)
      for (int k = 0; k < 2; ++k) {
        const auto& half = gear.halves()[i];
        const auto& w = half.walls[k];
        double p_top = w.cutter.p_D, lo = w.cutter.p_A;
        // Profile parameter that reaches h_a at the middle of the half; rows end there.
        const double h_a = gear.parameters().addendum_mm, mid = 0.5 * (half.ell_from + half.ell_to);
        if (const auto at = bevel_inverse(w, mid, h_a)) p_top = at->p;
        for (int r = 0; r < opt.rows; ++r)
          for (int c = 0; c < opt.columns; ++c) {
            const double ell = half.ell_from + (half.ell_to - half.ell_from) * c / (opt.columns - 1);
            const double p = lo + (p_top - lo) * (r + 0.25) / (opt.rows - 0.75);
            WallPoint q;
            q.half = static_cast<int>(i), q.wall = k, q.row = r, q.column = c;
            std::optional<BevelFlankPoint<double>> f;
            if (r + 1 == opt.rows) {
              if (const auto at = bevel_inverse(w, ell, h_a)) f = w.point(at->beta, at->p);
            } else if (const auto beta = bevel_beta_at(w, ell, p)) {
              f = w.point(*beta, p);
            }
            if (f) q.p = f->p, q.n = f->n;
            else q.row = -1;
            points.push_back(q);
          }
      }
  }

  // Poses.
  struct Depth {
    double depth = -1e9;  // > 0: into the part
    std::string patch;
    double root = 0, side = 1e9;
  };
  Depth pose_depth(const ToolState& tool, const Vec3& tip, const Vec3& axis) const {
    Depth out;
    const ConePose pose = cone_pose(gear, tip, axis, 0.0);
    const double lean = 2 * std::sin(0.5 * pose.tilt) * (tool.depth_mm + tool.solid.largest_radius());
    if (pose.lift - lean >= tool.depth_mm) {
      out.depth = tool.depth_mm + lean - pose.lift;
      out.patch = "tip";
      return out;
    }
    const bool over_blank = pose.R_c > gear.R_i() - tool.solid.largest_radius() && pose.R_c < gear.R_e() + tool.solid.largest_radius();
    const double dip = over_blank ? std::max(0.0, -pose.lift) : 0.0;
    out.root = dip;
    for (int k = 0; k < 2; ++k) {
      const WallReference& wall = tool.walls[k];
      const double side = wall.side(pose.R_c, pose.theta);
      out.side = std::min(out.side, side);
      const double depth = (side < 0 ? -side * wall.leverage() + dip : -side + dip) + lean + tool.shape_mm;
      if (depth > out.depth) out.depth = depth, out.patch = patch(k);
    }
    if (over_blank && dip + lean > out.depth) out.depth = dip + lean, out.patch = "root";
    return out;
  }

  /// Number of intervals at whose ends a motion is judged, and what may happen between them: the centre's distance from a
  /// wall path bends by no more than both curvatures together.
  struct Sampling {
    int intervals = 1;
    double extra_mm = 0;
  };
  Sampling sampling(const ToolState& tool, const ToolMotion& m) const {
    const ConePose a = cone_pose(gear, m.tip_from, m.axis_from, 0.0), b = cone_pose(gear, m.tip_to, m.axis_to, 0.0);
    const double s = std::sin(0.5 * (b.theta - a.theta));
    const double shift = std::sqrt((b.R_c - a.R_c) * (b.R_c - a.R_c) + 4 * a.R_c * b.R_c * s * s);
    const double curvature = std::max(tool.walls[0].largest_curvature(), tool.walls[1].largest_curvature()) +
                             1 / (gear.R_i() * gear.sin_delta());
    Sampling out;
    out.intervals = std::clamp(static_cast<int>(std::ceil(shift * std::sqrt(curvature / (8 * kBetween)))), 1, kMostSamples);
    const double step = shift / out.intervals;
    out.extra_mm = curvature * step * step / 8 * tool.walls[0].leverage() + m.deviation_mm + m.axis_deviation * tool.depth_mm;
    return out;
  }
};

FingerGougeCheck::FingerGougeCheck(const BevelGear& gear, std::span<const ToolAssembly> tools,
                                   std::span<const MillingOperation> operations, const Tolerances& tolerances,
                                   const FingerCheckOptions& options)
    : state_(new State(gear, tools, operations, tolerances, options)) {}

FingerGougeCheck::~FingerGougeCheck() { delete state_; }

namespace {

void note_worst(GougeResult& g, WorstPlace place, double limit) {
  if (place.depth_mm > g.deepest.depth_mm || g.deepest.body.empty()) g.deepest = place;
  if (place.depth_mm <= limit) return;
  g.worst.push_back(std::move(place));
  std::sort(g.worst.begin(), g.worst.end(), [](const WorstPlace& a, const WorstPlace& b) { return a.depth_mm > b.depth_mm; });
  if (g.worst.size() > kWorstPlaces) g.worst.resize(kWorstPlaces);
}

}  // namespace

FingerCheckResult FingerGougeCheck::verify(std::span<const ToolMotion> given) const {
  const State& s = *state_;
  FingerCheckResult result;
  GougeResult& g = result.gouge;
  g.required_clearance_mm = s.tol.clearance_mm;
  g.clearance_mm = std::numeric_limits<double>::infinity();
  g.motions = given.size();

  // Bounds from the poses, every motion of every tooth.
  std::vector<ToolMotion> local;
  local.reserve(given.size());
  for (const auto& m : given) local.push_back(turned(m, s.gear.pitch()));
  for (std::size_t i = 0; i < local.size(); ++i) {
    const ToolMotion& m = local[i];
    const ToolState* tool = s.tool_of(m.operation);
    if (!tool) continue;
    const auto place_of = [&](double depth, const char* body, const std::string& patch, double t) {
      WorstPlace w;
      w.depth_mm = depth;
      w.body = body;
      w.patch = patch;
      w.operation = m.operation;
      w.tooth = m.tooth;
      w.line = m.line;
      w.point = blend_tip(m, t);
      const ConePoint at = cone_point(w.point, s.gear.sin_delta(), s.gear.cos_delta());
      w.zone = s.gear.herringbone() && at.ell > s.gear.R_ref() ? 1 : 0;
      w.radius_mm = std::hypot(w.point.x(), w.point.y());
      w.height_mm = w.point.z();
      return w;
    };
    // All bodies above the tip: gap to the blank along the axis. Exact for a fixed axis; else sampled every half degree.
    const double swing = std::atan2(m.axis_from.cross(m.axis_to).norm(), m.axis_from.dot(m.axis_to));
    const int n = 1 + static_cast<int>(std::ceil(swing / radians(0.5)));
    double gap = std::numeric_limits<double>::infinity(), at = 0;
    for (int k = 0; k <= n; ++k) {
      const double t = static_cast<double>(k) / n;
      const Vec3 u = blend_axis(m, t);
      const double d = u.dot(blend_tip(m, t)) - blank_support(s.gear, u);
      if (d < gap) gap = d, at = t;
    }
    gap -= m.deviation_mm + m.axis_deviation * 2 * s.gear.R_e() + s.gear.R_e() * (swing / n) * (swing / n) / 8;
    if (m.rapid) {
      if (gap < 0) {
        g.rapids_clear = false;
        note_worst(g, place_of(-gap, "flute", "blank, by a rapid", at), -1e300);
      }
      continue;
    }
    for (const auto& [from, body] : {std::pair{tool->shank_from_mm, "shank"}, std::pair{tool->holder_from_mm, "holder"}}) {
      if (gap + from < g.clearance_mm) g.clearance_mm = gap + from;
      if (gap + from < s.tol.clearance_mm) note_worst(g, place_of(-(gap + from), body, "blank", at), -1e300);
    }
    if (gap >= 0) continue;
    const State::Sampling sampling = s.sampling(*tool, m);
    const double extra = sampling.extra_mm;
    State::Depth worst;
    double where = 0;
    for (int k = 0; k <= sampling.intervals; ++k) {
      const double t = static_cast<double>(k) / sampling.intervals;
      const auto d = s.pose_depth(*tool, blend_tip(m, t), blend_axis(m, t));
      result.root_gouge_mm = std::max(result.root_gouge_mm, d.root);
      if (d.depth > worst.depth) worst = d, where = t;
      result.tilt_rad = std::max(result.tilt_rad, cone_pose(s.gear, blend_tip(m, t), blend_axis(m, t), 0.0).tilt);
      ++g.distance_queries;
    }
    const double bound = worst.depth + extra;
    if (i == 0 || bound > g.bound_mm) g.bound_mm = bound;
    note_worst(g, place_of(bound, "flute", worst.patch, where), s.tol.gouge_mm);
  }

  // Measured on the walls, first tooth present.
  int tooth = 0;
  for (const auto& m : local)
    if (!m.rapid) {
      tooth = m.tooth;
      break;
    }
  const std::size_t n_ops = s.operations.size();
  std::vector<std::vector<const ToolMotion*>> by_op(n_ops);
  for (const auto& m : local)
    if (!m.rapid && m.tooth == tooth && m.operation >= 0 && static_cast<std::size_t>(m.operation) < n_ops)
      by_op[static_cast<std::size_t>(m.operation)].push_back(&m);
  std::vector<std::vector<double>> excess(n_ops, std::vector<double>(s.points.size(), kUntouched));
  tbb::parallel_for(std::size_t{0}, s.points.size(), [&](std::size_t i) {
    if (s.points[i].row < 0) return;
    for (std::size_t op = 0; op < n_ops; ++op) {
      double best = op > 0 ? excess[op - 1][i] : kUntouched;
      const ToolState* tool = s.tool_of(static_cast<int>(op));
      if (tool)
        for (const ToolMotion* m : by_op[op]) best = least_distance(s.points[i].p, *m, *tool, best);
      excess[op][i] = best;
    }
  });
  for (std::size_t op = 0; op < n_ops; ++op) {
    ExcessResult e;
    e.operation = static_cast<int>(op);
    e.max_mm = -kUntouched;
    e.min_mm = kUntouched;
    double sum = 0;
    for (std::size_t i = 0; i < s.points.size(); ++i) {
      if (s.points[i].row < 0) continue;
      const double d = excess[op][i];
      e.max_mm = std::max(e.max_mm, d);
      e.min_mm = std::min(e.min_mm, d);
      sum += d * d;
      ++e.points;
    }
    if (e.points > 0) e.rms_mm = std::sqrt(sum / static_cast<double>(e.points));
    const double span = e.max_mm - e.min_mm;
    e.histogram_from_mm = e.min_mm;
    e.histogram_step_mm = span > 0 ? span / 32 : 1e-6;
    e.histogram.assign(32, 0);
    for (std::size_t i = 0; i < s.points.size(); ++i)
      if (s.points[i].row >= 0)
        ++e.histogram[std::min<std::size_t>(31, static_cast<std::size_t>((excess[op][i] - e.min_mm) / e.histogram_step_mm))];
    e.bound_mm = e.max_mm;
    result.operations.push_back(std::move(e));
  }

  // Gouge measured: the deepest wall point, the root.
  g.measured_mm = result.root_gouge_mm;
  if (n_ops > 0 && !s.points.empty()) {
    result.finished = result.operations.back();
    double least = kUntouched;
    std::size_t at = 0;
    for (std::size_t i = 0; i < s.points.size(); ++i)
      if (s.points[i].row >= 0 && excess.back()[i] < least) least = excess.back()[i], at = i;
    g.measured_mm = std::max(g.measured_mm, -least);
    if (-least > g.deepest.depth_mm || -least > s.tol.gouge_mm) {
      WorstPlace w;
      w.depth_mm = -least;
      w.body = "flute";
      w.patch = s.patch(s.points[at].wall);
      w.zone = s.points[at].half;
      w.point = s.points[at].p;
      w.radius_mm = std::hypot(w.point.x(), w.point.y());
      w.height_mm = w.point.z();
      w.tooth = tooth;
      note_worst(g, w, s.tol.gouge_mm);
    }
    g.bound_mm = std::max(g.bound_mm, g.measured_mm);
  }

  // Material left, proven: how far the nominal wall paths are from the motions.
  double left = 0;
  for (int k = 0; k < 2; ++k)
    for (std::size_t half = 0; half < s.gear.halves().size(); ++half) {
      const ToolState* tool = nullptr;
      for (const auto& st : s.states)
        if (st && st->shape_mm == 0) tool = st.get();
      if (!tool) continue;
      const WallReference& wall = tool->walls[k];
      constexpr std::size_t kBins = 1500;
      const double from = wall.R_c_from(half), to = wall.R_c_to(half), width = (to - from) / kBins;
      std::vector<double> bin(kBins, kUntouched);
      for (std::size_t op = 0; op < n_ops; ++op) {
        if (s.tool_of(static_cast<int>(op)) != tool) continue;
        for (const ToolMotion* m : by_op[op]) {
          double low = 1e300, high = -1e300, side = 0;
          const State::Sampling sampling = s.sampling(*tool, *m);
          for (int j = 0; j <= sampling.intervals; ++j) {
            const double t = static_cast<double>(j) / sampling.intervals;
            const ConePose pose = cone_pose(s.gear, blend_tip(*m, t), blend_axis(*m, t), 0.0);
            if (pose.lift > 0.05 || pose.R_c < from - 1 || pose.R_c > to + 1) {
              side = kUntouched;
              break;
            }
            low = std::min(low, pose.R_c);
            high = std::max(high, pose.R_c);
            side = std::max(side, std::abs(wall.offset(pose.R_c, pose.theta)) * wall.leverage() + std::abs(pose.lift));
          }
          if (side > 0.2) continue;
          side += sampling.extra_mm;
          // Rounded words may end a pass short of its last point; there the wall differs by the square of that.
          const double first = std::ceil((low - kEndSlack - from) / width), last = std::floor((high + kEndSlack - from) / width);
          for (double b = std::max(0.0, first); b <= std::min(last, static_cast<double>(kBins - 1)); b += 1)
            bin[static_cast<std::size_t>(b)] = std::min(bin[static_cast<std::size_t>(b)], side);
        }
      }
      for (const double b : bin) left = std::max(left, b);
    }
  result.wall_excess_bound_mm = left;
  if (left < 1.0) {
    result.finished.bound_mm = std::max(result.finished.max_mm, left);
    if (!result.operations.empty()) result.operations.back().bound_mm = result.finished.bound_mm;
  }

  // Fields for the report.
  const auto per_wall = static_cast<std::size_t>(s.opt.rows) * static_cast<std::size_t>(s.opt.columns);
  for (std::size_t begin = 0; begin + per_wall <= s.points.size(); begin += per_wall) {
    SurfaceGrid grid;
    grid.zone = s.points[begin].half;
    grid.patch = s.patch(s.points[begin].wall);
    grid.rows = s.opt.rows;
    grid.columns = s.opt.columns;
    grid.excess_um.resize(n_ops);
    for (std::size_t i = begin; i < begin + per_wall; ++i) {
      grid.points.push_back(s.points[i].p);
      grid.normals.push_back(s.points[i].n);
      grid.reachable.push_back(s.points[i].row >= 0 ? 1 : 0);
      for (std::size_t op = 0; op < n_ops; ++op) grid.excess_um[op].push_back(static_cast<float>(1000 * excess[op][i]));
    }
    result.walls.push_back(std::move(grid));
  }
  result.ridge = ridge(given);
  return result;
}

RidgeResult FingerGougeCheck::ridge(std::span<const ToolMotion> given) const {
  const State& s = *state_;
  RidgeResult out;
  for (const auto& op : s.operations)
    if (op.ridge_mm > 0) out.requested_mm = out.requested_mm > 0 ? std::min(out.requested_mm, op.ridge_mm) : op.ridge_mm;
  std::vector<ToolMotion> cutting;
  int tooth = -1;
  for (const auto& m : given) {
    if (m.rapid || !s.tool_of(m.operation)) continue;
    if (tooth < 0) tooth = m.tooth;
    if (m.tooth == tooth) cutting.push_back(turned(m, s.gear.pitch()));
  }
  if (cutting.empty() || s.error) return out;
  // Floor between the lines under both wall paths; the fillets begin there.
  const ToolState* reference = nullptr;
  for (const auto& st : s.states)
    if (st && st->shape_mm == 0) reference = st.get();
  if (!reference) return out;
  const double sd = s.gear.sin_delta(), cd = s.gear.cos_delta(), h_f = s.gear.parameters().dedendum_mm;
  struct Row {
    double height = 0, azimuth = 0, ell = 0;
    std::size_t points = 0;
  };
  std::vector<double> stations;
  for (const auto& half : s.gear.halves()) {
    const int n = std::max(2, static_cast<int>(s.opt.ridge_columns / s.gear.halves().size()));
    for (int i = 0; i < n; ++i) stations.push_back(half.ell_from + (half.ell_to - half.ell_from) * i / (n - 1));
  }
  std::vector<Row> rows(stations.size());
  tbb::parallel_for(std::size_t{0}, stations.size(), [&](std::size_t i) {
    const double ell = stations[i];
    std::vector<const ToolMotion*> near;
    for (const auto& m : cutting) {
      const double a = cone_pose(s.gear, m.tip_from, m.axis_from, 0.0).R_c;
      const double b = cone_pose(s.gear, m.tip_to, m.axis_to, 0.0).R_c;
      if (std::min(a, b) < ell + reference->solid.largest_radius() && std::max(a, b) > ell - reference->solid.largest_radius())
        near.push_back(&m);
    }
    const double e_L = reference->walls[0].theta_at(ell) / sd, e_U = reference->walls[1].theta_at(ell) / sd;
    const auto left = [&](double e) {
      const Vec3 foot = blank_point(ell, -h_f, e, sd, cd), normal = s.gear.axis(e);
      double best = s.gear.parameters().addendum_mm + h_f;
      for (const ToolMotion* m : near) best = covering_height(*s.tool_of(m->operation), foot, normal, *m, best);
      return best;
    };
    Row& row = rows[i];
    row.ell = ell;
    double at = 0;
    const int n = s.opt.ridge_rows;
    for (int j = 0; j < n; ++j) {
      const double e = e_L + (e_U - e_L) * j / (n - 1), h = left(e);
      ++row.points;
      if (j == 0 || h > row.height) row.height = h, at = j;
    }
    // A ridge is a kink: narrow down on it.
    double a = e_L + (e_U - e_L) * std::max(0.0, at - 1) / (n - 1), b = e_L + (e_U - e_L) * std::min(n - 1.0, at + 1) / (n - 1);
    constexpr double gold = 0.6180339887498949;
    double x1 = b - gold * (b - a), x2 = a + gold * (b - a), f1 = left(x1), f2 = left(x2);
    row.azimuth = e_L + (e_U - e_L) * at / (n - 1);
    for (int k = 0; k < 22; ++k) {
      if (f1 > f2) b = x2, x2 = x1, f2 = f1, x1 = b - gold * (b - a), f1 = left(x1);
      else a = x1, x1 = x2, f1 = f2, x2 = a + gold * (b - a), f2 = left(x2);
    }
    if (std::max(f1, f2) > row.height) row.height = std::max(f1, f2), row.azimuth = f1 > f2 ? x1 : x2;
    row.points += 24;
  });
  for (const auto& row : rows) {
    out.points += row.points;
    if (row.height > out.reached_mm) out.reached_mm = row.height, out.cone_distance_mm = row.ell, out.azimuth_rad = row.azimuth;
  }
  return out;
}

Result<CheckedClPath> FingerGougeCheck::approve(ClPath path) const {
  const State& s = *state_;
  if (s.error) return *s.error;
  const ToolState* tool = s.tool_of(path.operation);
  if (!tool) return fail("operation {} is not in the job", path.operation);
  for (const ToolMotion& m : motions_of(path)) {
    const auto located = [&](const std::string& what) {
      return fail_as(DiagnosticKind::verification, "operation {} record {}: {}", path.operation, m.line, what);
    };
    const State::Sampling sampling = s.sampling(*tool, m);
    for (int k = 0; k <= sampling.intervals; ++k) {
      const double t = static_cast<double>(k) / sampling.intervals;
      const Vec3 tip = blend_tip(m, t), u = blend_axis(m, t);
      const double gap = u.dot(tip) - blank_support(s.gear, u);
      if (m.rapid) {
        if (gap < 0) return located(fmt::format("the rapid goes {:.4f} mm into the blank", -gap));
        continue;
      }
      const double clearance = std::min(gap + tool->shank_from_mm, gap + tool->holder_from_mm);
      if (clearance < s.tol.clearance_mm)
        return located(fmt::format("the {} comes within {:.4f} mm of the blank, less than {:.4f}",
                                   tool->shank_from_mm < tool->holder_from_mm ? "shank" : "holder", clearance, s.tol.clearance_mm));
      if (gap >= 0) continue;
      const auto d = s.pose_depth(*tool, tip, u);
      const double bound = d.depth + sampling.extra_mm;
      if (bound > s.tol.gouge_mm)
        return located(fmt::format("the cutter goes up to {:.4f} mm into {}, more than {:.4f}", bound, d.patch, s.tol.gouge_mm));
    }
  }
  return CheckedClPath(std::move(path));
}

}  // namespace toothpath
