#include "cam/finger/check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/finger/clearance.h"
#include "cam/finger/deepest.h"
#include "cam/finger/finger_profile.h"
#include "cam/finger/milling.h"
#include "cam/finger/obstacles.h"
#include "cam/finger/poses.h"
#include "cam/finger/walls.h"
#include "cam/proof/gouge_merge.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"

namespace toothpath::finger {
namespace {

constexpr double kMotionsWorth = 3;  // of four parts of the check
constexpr std::size_t kChunk =
    64;  // motions that one thread checks one after another; the same on any number of threads
constexpr std::size_t kLookedAt = 16;  // motions whose deepest place is searched
constexpr double kBelievable = 1.0;    // mm: a larger bound of what is left means a path that is not run

/// A motion turned to tooth space 0.
path::ToolMotion turned(const path::ToolMotion& m, double pitch) {
  if (m.tooth == 0) return m;
  const Mat3 R = Eigen::AngleAxisd(-pitch * m.tooth, Vec3::UnitZ()).toRotationMatrix();
  path::ToolMotion out = m;
  out.tip_from = R * m.tip_from;
  out.tip_to = R * m.tip_to;
  out.axis_from = R * m.axis_from;
  out.axis_to = R * m.axis_to;
  return out;
}

proof::WorstPlace place_of(const bevel_gear::BevelGear& gear, const path::ToolMotion& m, const Vec3& point,
                           double depth, tool::Body body, const std::string& patch) {
  proof::WorstPlace w;
  w.depth_mm = depth;
  w.body = body;
  w.patch = patch;
  w.operation = m.operation;
  w.tooth = m.tooth;
  w.line = m.line;
  w.point = point;
  w.zone = gear.herringbone() && bevel_gear::cone_point(point, gear.sin_delta(), gear.cos_delta()).ell > gear.R_ref()
               ? 1
               : 0;
  w.radius_mm = std::hypot(point.x(), point.y());
  w.height_mm = point.z();
  return w;
}

void note_worst(proof::GougeResult& g, proof::WorstPlace place, double limit) {
  note_deepest(g, place);
  if (place.depth_mm > limit) proof::add_worst(g, std::move(place));
}

/// Nothing cut yet: a bevel gear's depths begin at 0.
FingerCheckResult nothing_yet(double required_clearance_mm) {
  FingerCheckResult r;
  r.gouge = proof::no_motion_yet(required_clearance_mm);
  r.gouge.measured_mm = r.gouge.bound_mm = 0;
  return r;
}

/// Gap between the tip and the blank along the axis, least over a motion and never above the true one. Everything of
/// the tool above the height x clears the blank by this gap and x.
struct AxialGap {
  double gap = std::numeric_limits<double>::infinity();
  double at = 0;  ///< where on the motion
};
AxialGap axial_gap(const bevel_gear::BevelGear& gear, const path::ToolMotion& m) {
  // Exact for a fixed axis; else sampled every half degree.
  const double swing = std::atan2(m.axis_from.cross(m.axis_to).norm(), m.axis_from.dot(m.axis_to));
  const int n = 1 + static_cast<int>(std::ceil(swing / radians(0.5)));
  AxialGap out;
  for (int k = 0; k <= n; ++k) {
    const double t = static_cast<double>(k) / n;
    const Vec3 u = path::axis_at(m, t);
    const double d = u.dot(path::tip_at(m, t)) - blank_support(gear, u);
    if (d < out.gap) out.gap = d, out.at = t;
  }
  out.gap -= m.deviation_mm + m.axis_deviation * 2 * gear.R_e() + gear.R_e() * (swing / n) * (swing / n) / 8;
  return out;
}

}  // namespace

struct FingerGougeCheck::State {
  bevel_gear::BevelGear gear;
  std::vector<tool::ToolAssembly> tools;
  std::vector<path::MillingOperation> operations;
  proof::ProofLimits tol;
  FingerCheckOptions opt;
  std::vector<std::unique_ptr<FingerTool>> states;       // by tool index, only those in use
  std::vector<std::vector<ToolHull>> hulls;              // the same
  std::vector<std::vector<tool::Frustum>> shank_holder;  // the same
  FingerClearance part;
  CoaxialBody blank;
  std::vector<CoaxialBody> beside;
  std::optional<Diagnostic> error;
  std::vector<WallPoint> points;

  State(const bevel_gear::BevelGear& g, std::span<const tool::ToolAssembly> t,
        std::span<const path::MillingOperation> o, const proof::ProofLimits& limits, const FingerCheckOptions& options)
      : gear(g),
        tools(t.begin(), t.end()),
        operations(o.begin(), o.end()),
        tol(limits),
        opt(options),
        part(g),
        blank(blank_body(g)),
        beside(bodies_beside_teeth(g)) {
    states.resize(tools.size());
    hulls.resize(tools.size());
    shank_holder.resize(tools.size());
    for (const auto& op : operations) {
      const auto index = static_cast<std::size_t>(op.tool);
      if (states[index]) continue;
      auto own = gear_for_finger_mill(gear, tools[index]);
      if (!own) {
        error = own.error();
        continue;
      }
      states[index] = std::make_unique<FingerTool>(*own, gear, tools[index]);
      const tool::Profile whole = finger_profile(own->cutter(), tools[index], kOneChord);
      hulls[index] = tool_hulls(whole);
      shank_holder[index] = tool::shank_and_holder(whole);
    }
    points = wall_points(gear, opt.rows, opt.columns);
  }

  const FingerTool* tool_of(int operation) const {
    if (operation < 0 || static_cast<std::size_t>(operation) >= operations.size()) return nullptr;
    return states[static_cast<std::size_t>(operations[static_cast<std::size_t>(operation)].tool)].get();
  }
  /// A tool whose own walls are the finished ones.
  const FingerTool* reference() const {
    for (const auto& state : states)
      if (state && state->shape_mm == 0) return state.get();
    return nullptr;
  }

  struct BodiesVerdict {
    bool among_teeth = false;                                       ///< a feed that comes lower than the tips
    double clearance_mm = std::numeric_limits<double>::infinity();  ///< proven, of shank and holder
  };

  /// Shank, holder and flute against blank, hub and shaft, one motion.
  BodiesVerdict judge_bodies(const path::ToolMotion& m, const FingerTool& tool, FingerCheckResult& result) const {
    proof::GougeResult& g = result.gouge;
    BodiesVerdict out;
    const AxialGap above = axial_gap(gear, m);
    const Vec3 tip = path::tip_at(m, above.at), axis = path::axis_at(m, above.at);
    const auto need_clearance = [&](double gap, const Vec3& place, tool::Body body, const std::string& patch) {
      if (gap < std::min(out.clearance_mm, g.clearance_mm)) g.closest = place_of(gear, m, place, -gap, body, patch);
      out.clearance_mm = std::min(out.clearance_mm, gap);
      if (gap < tol.clearance_mm) note_worst(g, place_of(gear, m, place, -gap, body, patch), -1e300);
    };
    const auto& bodies = hulls[static_cast<std::size_t>(operations[static_cast<std::size_t>(m.operation)].tool)];
    // A rapid whose blank does not lie wholly behind the tip may still pass beside it: a tool that leans goes over the
    // small end.
    if (m.rapid && above.gap < 0)
      for (const ToolHull& hull : bodies) {
        const auto [gap, place] = nearest_obstacle(hull, blank, m);
        if (gap >= 0) continue;
        g.rapids_clear = false;
        note_worst(g, place_of(gear, m, place, -gap, hull.body, "blank, by a rapid"), -1e300);
      }
    for (const ToolHull& hull : bodies) {
      if (m.rapid || hull.body == tool::Body::flute) continue;
      // Along the axis the gap costs nothing; where it is too small, an axis that leans may still leave more.
      ObstacleGap least{above.gap + (hull.body == tool::Body::shank ? tool.shank_from_mm : tool.holder_from_mm),
                        blank_place(gear, axis, tip)};
      if (least.gap < tol.clearance_mm)
        if (const ObstacleGap whole = nearest_obstacle(hull, blank, m); whole.gap > least.gap) least = whole;
      need_clearance(least.gap, least.place, hull.body, "blank");
    }
    for (const CoaxialBody& body : beside)
      for (const ToolHull& hull : bodies) {
        const auto [gap, place] = nearest_obstacle(hull, body, m);
        if (m.rapid) {
          if (gap >= 0) continue;
          g.rapids_clear = false;
          note_worst(g, place_of(gear, m, place, -gap, hull.body, std::string(body.name) + ", by a rapid"), -1e300);
        } else if (hull.body != tool::Body::flute) {
          need_clearance(gap, place, hull.body, body.name);
        } else if (gap < 0) {
          g.bound_mm = std::max(g.bound_mm, -gap);
          g.measured_mm = std::max(g.measured_mm, -gap);
          note_worst(g, place_of(gear, m, place, -gap, hull.body, body.name), tol.gouge_mm);
        }
      }
    g.clearance_mm = std::min(g.clearance_mm, out.clearance_mm);
    out.among_teeth = !m.rapid && above.gap < 0;
    return out;
  }

  /// Shank and holder against the finished part: the motions with the least proven gaps first, until no other can come
  /// nearer.
  void judge_clearance(std::span<const path::ToolMotion> local, std::span<const double> proven,
                       proof::GougeResult& g) const {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < proven.size(); ++k)
      if (std::isfinite(proven[k])) order.push_back(k);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return proven[a] < proven[b]; });
    FoundGap found;
    for (const std::size_t k : order) {
      if (proven[k] >= found.gap_mm) break;
      for (const tool::Frustum& body :
           shank_holder[static_cast<std::size_t>(operations[static_cast<std::size_t>(local[k].operation)].tool)])
        found = part.least(body, local[k], found);
    }
    g.clearance_measured_mm = found.gap_mm;
  }

  /// What one motion may do to walls and root: proven, not measured.
  struct MotionDepth {
    double bound_mm = -1e300;
    double dip_mm = 0;           ///< of the tip below the root cone
    Vec3 lowest = Vec3::Zero();  ///< the tip there
    std::string patch;
  };

  /// The cutting part against walls and root, one motion.
  MotionDepth judge_poses(const path::ToolMotion& m, const FingerTool& tool, FingerCheckResult& result) const {
    proof::GougeResult& g = result.gouge;
    const PoseSampling sampling = pose_sampling(gear, tool, m);
    PoseDepth worst;
    MotionDepth out;
    for (int k = 0; k <= sampling.intervals; ++k) {
      const double t = static_cast<double>(k) / sampling.intervals;
      const auto d = pose_depth(gear, tool, path::tip_at(m, t), path::axis_at(m, t));
      result.root_gouge_mm = std::max(result.root_gouge_mm, d.root);
      result.tilt_rad = std::max(result.tilt_rad, d.tilt);
      if (d.root > out.dip_mm) out.dip_mm = d.root, out.lowest = path::tip_at(m, t);
      if (d.depth > worst.depth) worst = d;
      ++g.distance_queries;
    }
    out.bound_mm = worst.depth + sampling.extra_mm;
    out.patch = worst.patch;
    if (out.bound_mm > g.bound_mm) g.bound_mm = out.bound_mm, g.bound_line = m.line;
    return out;
  }

  /// Bodies and cutting part along all motions, on all threads: chunks of motions are put together in the order of the
  /// program.
  void judge_motions(std::span<const path::ToolMotion> local, std::span<MotionDepth> depths,
                     std::span<double> clearances, FingerCheckResult& result) const {
    std::vector<FingerCheckResult> chunks((local.size() + kChunk - 1) / kChunk);
    WorkShare share(double(chunks.size()), kMotionsWorth);
    tbb::parallel_for(std::size_t{0}, chunks.size(), [&](std::size_t n) {
      FingerCheckResult chunk = nothing_yet(tol.clearance_mm);
      for (std::size_t k = n * kChunk; k < std::min(local.size(), (n + 1) * kChunk); ++k)
        if (const FingerTool* tool = tool_of(local[k].operation)) {
          const BodiesVerdict bodies = judge_bodies(local[k], *tool, chunk);
          clearances[k] = bodies.clearance_mm;
          if (bodies.among_teeth) depths[k] = judge_poses(local[k], *tool, chunk);
        }
      chunks[n] = std::move(chunk);
      share.add();
    });
    for (const FingerCheckResult& chunk : chunks) {
      add_result(result.gouge, chunk.gouge);
      result.root_gouge_mm = std::max(result.root_gouge_mm, chunk.root_gouge_mm);
      result.tilt_rad = std::max(result.tilt_rad, chunk.tilt_rad);
    }
  }

  /// The motions with the greatest bounds, looked at on the walls themselves.
  void judge_deepest(std::span<const path::ToolMotion> local, std::span<const MotionDepth> depths,
                     FingerCheckResult& result) const {
    proof::GougeResult& g = result.gouge;
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < depths.size(); ++k)
      if (depths[k].bound_mm > 0) order.push_back(k);
    const auto deeper = [&](std::size_t a, std::size_t b) {
      return depths[a].bound_mm != depths[b].bound_mm ? depths[a].bound_mm > depths[b].bound_mm : a < b;
    };
    const std::size_t n = std::min(order.size(), kLookedAt);
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n), order.end(), deeper);
    std::vector<DeepestCut> found(n);
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t k) {
      found[k] = deepest_cut(gear, *tool_of(local[order[k]].operation), local[order[k]]);
    });
    for (std::size_t k = 0; k < n; ++k) {
      const path::ToolMotion& m = local[order[k]];
      const MotionDepth& d = depths[order[k]];
      const bool in_wall = found[k].depth_mm >= d.dip_mm;
      const double depth = std::max(found[k].depth_mm, d.dip_mm);
      proof::WorstPlace w = place_of(gear, m, in_wall ? found[k].point : d.lowest, depth, tool::Body::flute,
                                     in_wall ? wall_name(found[k].wall) : "root");
      if (in_wall) w.zone = found[k].half;
      g.measured_mm = std::max(g.measured_mm, depth);
      note_worst(g, std::move(w), d.bound_mm > tol.gouge_mm ? -1e300 : tol.gouge_mm);
    }
  }

  /// The deepest wall point that was measured, and the motion that cut it.
  void judge_points(const WallExcess& excess, FingerCheckResult& result) const {
    proof::GougeResult& g = result.gouge;
    std::size_t at = points.size();
    for (std::size_t i = 0; i < points.size(); ++i)
      if (points[i].row >= 0 && excess.deepest[i] &&
          (at == points.size() || excess.after.back()[i] < excess.after.back()[at]))
        at = i;
    g.measured_mm = std::max(g.measured_mm, result.root_gouge_mm);
    if (at < points.size()) {
      const double depth = -excess.after.back()[at];
      g.measured_mm = std::max(g.measured_mm, depth);
      if (depth > tol.gouge_mm || depth > g.deepest.depth_mm) {
        proof::WorstPlace w =
            place_of(gear, *excess.deepest[at], points[at].p, depth, tool::Body::flute, wall_name(points[at].wall));
        w.zone = points[at].half;
        note_worst(g, std::move(w), tol.gouge_mm);
      }
    }
    g.bound_mm = std::max(g.bound_mm, g.measured_mm);
  }

  /// Why a motion of a path may not be run, and by how much [mm].
  struct MotionFault {
    enum Kind { rapid, near, cut } kind = rapid;
    double beyond_mm = 0;
    Diagnostic diagnostic;
  };
  /// Nothing: the motion may be run.
  std::optional<MotionFault> fault(const path::ToolMotion& m, const FingerTool& tool, double room_mm) const {
    FingerCheckResult one = nothing_yet(tol.clearance_mm);
    MotionDepth walls;
    if (judge_bodies(m, tool, one).among_teeth) walls = judge_poses(m, tool, one);
    const proof::GougeResult& g = one.gouge;
    const auto found = [&](MotionFault::Kind kind, double beyond_mm, const std::string& what) {
      return MotionFault{
          kind, beyond_mm,
          fail_as(DiagnosticKind::verification, "operation {} record {}: {}", m.operation, m.line, what)};
    };
    if (!g.rapids_clear)
      return found(
          MotionFault::rapid, g.worst.front().depth_mm,
          fmt::format("the rapid goes {:.4f} mm into the {}", g.worst.front().depth_mm, g.worst.front().patch));
    if (g.clearance_mm < tol.clearance_mm + room_mm)
      return found(MotionFault::near, tol.clearance_mm - g.clearance_mm,
                   fmt::format("the {} comes within {:.4f} mm of the {}, less than {:.4f}{}", g.closest.body,
                               g.clearance_mm, g.closest.patch, tol.clearance_mm,
                               room_mm > 0 ? fmt::format(" and {:.4f} for words and control", room_mm) : ""));
    if (g.bound_mm > tol.gouge_mm)
      return found(MotionFault::cut, g.bound_mm,
                   fmt::format("the cutter goes {:.4f} mm into {}, more than {:.4f}", g.bound_mm,
                               walls.bound_mm >= g.bound_mm ? walls.patch : g.deepest.patch, tol.gouge_mm));
    return std::nullopt;
  }

  std::vector<FingerCut> cuts_of_first_tooth(std::span<const path::ToolMotion> local) const {
    std::vector<FingerCut> cuts;
    int tooth = -1;
    for (const auto& m : local) {
      const FingerTool* tool = m.rapid ? nullptr : tool_of(m.operation);
      if (!tool) continue;
      if (tooth < 0) tooth = m.tooth;
      if (m.tooth == tooth) cuts.push_back({&m, tool});
    }
    return cuts;
  }

  /// Bounds of every motion of every tooth, and what is found on walls and root of the first tooth present; with marks
  /// only along the motions that have one, and no grids.
  FingerCheckResult judge(std::span<const path::ToolMotion> given, std::optional<std::span<const char>> marks) const {
    FingerCheckResult result = nothing_yet(tol.clearance_mm);
    const WorkShare all(kMotionsWorth + 1);
    std::vector<path::ToolMotion> local;
    local.reserve(given.size());
    for (const auto& m : given) local.push_back(turned(m, gear.pitch()));
    std::vector<MotionDepth> depths(local.size());
    std::vector<double> clearances(local.size(), std::numeric_limits<double>::infinity());
    judge_motions(local, depths, clearances, result);
    result.gouge.motions = given.size();
    const std::vector<FingerCut> cuts = cuts_of_first_tooth(local);
    if (const FingerTool* tool = reference()) result.wall_excess_bound_mm = left_bound(gear, *tool, cuts);
    for (std::size_t k = 0; marks && k < local.size(); ++k)
      if ((*marks)[k] == 0) depths[k] = {}, clearances[k] = std::numeric_limits<double>::infinity();
    judge_deepest(local, depths, result);
    judge_clearance(local, clearances, result.gouge);
    if (!marks) measure(cuts, result);
    return result;
  }

  /// Walls and ridges.
  void measure(std::span<const FingerCut> cuts, FingerCheckResult& result) const {
    std::vector<std::vector<FingerCut>> by_operation(operations.size());
    for (const FingerCut& cut : cuts) by_operation[static_cast<std::size_t>(cut.motion->operation)].push_back(cut);
    const WallExcess excess =
        measure_walls(points, by_operation, gear.parameters().addendum_mm + gear.parameters().dedendum_mm);
    for (std::size_t op = 0; op < by_operation.size(); ++op)
      result.operations.push_back(summary_of(points, excess.after[op], static_cast<int>(op)));
    if (!result.operations.empty()) {
      judge_points(excess, result);
      result.finished = result.operations.back();
    }
    if (result.wall_excess_bound_mm < kBelievable && !result.operations.empty()) {
      result.finished.bound_mm = std::max(result.finished.max_mm, result.wall_excess_bound_mm);
      result.operations.back().bound_mm = result.finished.bound_mm;
    }
    result.walls = wall_grids(points, excess, opt.rows, opt.columns);
    result.ridge = ridge(cuts);
  }

  RidgeResult ridge(std::span<const FingerCut> cuts) const {
    RidgeResult out;
    if (const FingerTool* tool = reference(); tool && !cuts.empty())
      out = highest_ridge(gear, cuts, *tool, opt.ridge_columns, opt.ridge_rows);
    for (const auto& op : operations)
      if (op.ridge_mm > 0)
        out.requested_mm = out.requested_mm > 0 ? std::min(out.requested_mm, op.ridge_mm) : op.ridge_mm;
    return out;
  }
};

FingerGougeCheck::FingerGougeCheck(const bevel_gear::BevelGear& gear, std::span<const tool::ToolAssembly> tools,
                                   std::span<const path::MillingOperation> operations, const proof::ProofLimits& limits,
                                   const FingerCheckOptions& options)
    : state_(std::make_unique<State>(gear, tools, operations, limits, options)) {}

FingerGougeCheck::~FingerGougeCheck() = default;

FingerCheckResult FingerGougeCheck::verify(std::span<const path::ToolMotion> given) const {
  return state_->judge(given, std::nullopt);
}

FingerCheckResult FingerGougeCheck::bounds(std::span<const path::ToolMotion> given, std::span<const char> look) const {
  return state_->judge(given, look);
}

bool FingerGougeCheck::among_teeth(const path::ToolMotion& motion) const {
  const State& s = *state_;
  if (motion.rapid || !s.tool_of(motion.operation)) return false;
  const path::ToolMotion m = turned(motion, s.gear.pitch());
  if (axial_gap(s.gear, m).gap >= 0) return false;
  const auto& bodies = s.hulls[static_cast<std::size_t>(s.operations[static_cast<std::size_t>(m.operation)].tool)];
  return std::any_of(bodies.begin(), bodies.end(),
                     [&](const ToolHull& hull) { return nearest_obstacle(hull, s.blank, m).gap < 0; });
}

proof::GougeResult FingerGougeCheck::rapids(std::span<const path::ToolMotion> given) const {
  const State& s = *state_;
  FingerCheckResult result = nothing_yet(s.tol.clearance_mm);
  for (const auto& m : given)
    if (const FingerTool* tool = m.rapid ? s.tool_of(m.operation) : nullptr)
      s.judge_bodies(turned(m, s.gear.pitch()), *tool, result);
  return result.gouge;
}

RidgeResult FingerGougeCheck::ridge(std::span<const path::ToolMotion> given) const {
  const State& s = *state_;
  std::vector<path::ToolMotion> local;
  for (const auto& m : given) local.push_back(turned(m, s.gear.pitch()));
  return s.ridge(s.cuts_of_first_tooth(local));
}

Result<proof::CheckedClPath> FingerGougeCheck::approve(path::ClPath path, double room_mm) const {
  const State& s = *state_;
  if (s.error) return *s.error;
  const FingerTool* tool = s.tool_of(path.operation);
  if (!tool) return fail("operation {} is not in the job", path.operation);
  const std::vector<path::ToolMotion> motions = path::motions_of(path);
  std::vector<std::optional<State::MotionFault>> faults(motions.size());
  tbb::parallel_for(std::size_t{0}, motions.size(),
                    [&](std::size_t k) { faults[k] = s.fault(motions[k], *tool, room_mm); });
  // What goes wrong first along the path, told where it is worst.
  const State::MotionFault* told = nullptr;
  for (const auto& fault : faults)
    if (fault && (!told || (fault->kind == told->kind && fault->beyond_mm > told->beyond_mm))) told = &*fault;
  if (told) return told->diagnostic;
  return proof::CheckedClPath(std::move(path));
}

}  // namespace toothpath::finger
