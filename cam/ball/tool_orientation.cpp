#include "cam/ball/tool_orientation.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "cam/ball/orientation_way.h"
#include "geometry/base/angle.h"

namespace toothpath::ball {
namespace {

std::atomic<std::size_t> runs{0};

constexpr double kGapResolution = 0.01;  // mm, of gaps
constexpr double kStation = 0.7;         // mm between stations, at most
constexpr int kSweeps = 16;              // of the relaxation
constexpr double kSettled = 0.002;       // tangent: the relaxation ends when no direction moves by more
constexpr int kRounds = 3;               // halvings of the stations of a pass that is not clear between them
constexpr double kFarthestGap = 2.0;     // mm: gaps beyond are not measured
constexpr double kLongestStickOut = 60;  // mm: how much longer a tool is looked for, when a job is refused

class Orienter {
 public:
  Orienter(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone, const tool::ToolAssembly& tool,
           const OrientationOptions& o, std::vector<BallPass>& passes)
      : tree_(tree),
        tool_(tool),
        o_(o),
        passes_(passes),
        check_(part, tree, zone, tool, o),
        grid_(std::tan(o.widest_lean_rad)) {}

  Expected<Orientation, OrientationRefusal> run() {
    for (const auto& pass : passes_) {
      tracks_.emplace_back(pass);
      ways_.push_back(make_way(tracks_.back(), kStation));
    }
    find_neighbours();
    for (std::size_t p = 0; p < ways_.size(); ++p)
      if (!solve(p)) return *refusal_;
    relax();
    for (std::size_t p = 0; p < ways_.size(); ++p)
      if (!make_axes(p)) return *refusal_;
    return take_axes(std::move(made_), check_, tree_, tool_, passes_);
  }

 private:
  OrientationWay make_way(const PassTrack& track, double spacing) const {
    OrientationWay way;
    const double length = track.at().back();
    const int count = std::max(2, int(std::ceil(length / spacing)));
    for (int k = 0; k <= count; ++k) {
      way.s.push_back(length * k / count);
      way.points.push_back(track.point(way.s.back()));
      way.r.push_back(radius(way.points.back().centre));
      way.lean.emplace_back(0, 0);
    }
    return way;
  }

  /// The passes nearest to each, at most four; by the middle of their ways.
  void find_neighbours() {
    const auto middle = [&](std::size_t p) { return ways_[p].points[ways_[p].points.size() / 2].centre; };
    for (std::size_t p = 0; p < ways_.size(); ++p) {
      std::vector<std::pair<double, std::size_t>> list;
      for (std::size_t q = 0; q < ways_.size(); ++q)
        if (q != p) list.emplace_back((middle(p) - middle(q)).norm(), q);
      std::sort(list.begin(), list.end());
      for (std::size_t k = 0; k < std::min<std::size_t>(list.size(), 4); ++k) ways_[p].near.push_back(list[k].second);
    }
  }

  [[nodiscard]] bool clear_at(const BallPass::Point& point, const Vec2& lean, double margin) const {
    return check_.clear(point, check_.frame().axis(lean.x(), lean.y()), o_.clearance_mm + margin);
  }

  /// A start for one pass: like the nearest pass that has its way already.
  bool solve(std::size_t p) {
    OrientationWay& way = ways_[p];
    const OrientationWay* like = nullptr;
    for (const auto q : way.near)
      if (like == nullptr && ways_[q].solved) like = &ways_[q];
    const auto reference = [&](std::size_t station) {
      return like != nullptr ? like->lean_at(way.r[station]) : Vec2(0, 0);
    };
    const auto clear = [&](std::size_t station, const Vec2& lean) {
      return clear_at(way.points[station], lean, o_.margin_mm);
    };
    if (find_constant(way, grid_, reference, clear)) return true;
    const auto between = [&](std::size_t station, const Vec2& a, const Vec2& b) {
      return clear_at(blend_points(way.points[station], way.points[station + 1], 0.5), 0.5 * (a + b),
                      0.5 * o_.margin_mm);
    };
    if (find_way(way, grid_, reference, clear, between).found) return true;
    // A narrow way may slip through a grid of 2 deg.
    if (!fine_) fine_.emplace(std::tan(o_.widest_lean_rad), 0.5 * grid_.step);
    if (find_constant(way, *fine_, reference, clear)) return true;
    const auto found = find_way(way, *fine_, reference, clear, between);
    if (found.found) return true;
    refusal_ = found.none_clear ? blocked(way, found.blocked_at) : parted(way, found.blocked_at);
    return false;
  }

  /// Takes the steps of the grid out: every direction towards the mean of its neighbours along and across the passes
  /// and of upright, as long as it stays clear. Passes are moved at once, each against the state before the sweep.
  void relax() {
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      const std::vector<OrientationWay> before = ways_;
      std::vector<double> moved(ways_.size(), 0);
      tbb::parallel_for(std::size_t(0), ways_.size(), [&](std::size_t p) { moved[p] = relax_one(ways_[p], before); });
      if (*std::max_element(moved.begin(), moved.end()) < kSettled) break;
    }
  }

  [[nodiscard]] double relax_one(OrientationWay& way, const std::vector<OrientationWay>& all) const {
    const std::size_t n = way.s.size();
    if (way.constant) {
      Vec2 sum(0, 0);
      double weight = 0;
      for (std::size_t k = 0; k < n; ++k) add_neighbours(way, k, all, 1, sum, weight);
      const Vec2 from = way.lean.front(), to = sum / weight;
      for (const double step : {1.0, 0.5, 0.25}) {
        const Vec2 lean = from + step * (to - from);
        bool good = true;
        for (std::size_t k = 0; k < n && good; ++k) good = clear_at(way.points[k], lean, o_.margin_mm);
        if (!good) continue;
        std::fill(way.lean.begin(), way.lean.end(), lean);
        return (lean - from).norm();
      }
      return 0;
    }
    double most = 0;
    for (std::size_t k = 0; k < n; ++k) {
      Vec2 sum(0, 0);
      double weight = 0;
      const double ds = way.s[1] - way.s[0];
      add_neighbours(way, k, all, ds, sum, weight);
      for (const std::size_t j : {k - 1, k + 1})
        if (j < n) {
          sum += kTurnWeight / ds * way.lean[j];
          weight += kTurnWeight / ds;
        }
      const Vec2 from = way.lean[k], to = sum / weight;
      for (const double step : {1.0, 0.5, 0.25}) {
        const Vec2 lean = from + step * (to - from);
        if (!clear_at(way.points[k], lean, o_.margin_mm)) continue;
        bool good = true;
        for (const std::size_t j : {k - 1, k + 1})
          if (j < n && good)
            good = clear_at(blend_points(way.points[k], way.points[j], 0.5), 0.5 * (lean + way.lean[j]),
                            0.5 * o_.margin_mm);
        if (!good) continue;
        way.lean[k] = lean;
        most = std::max(most, (lean - from).norm());
        break;
      }
    }
    return most;
  }

  static void add_neighbours(const OrientationWay& way, std::size_t k, const std::vector<OrientationWay>& all,
                             double ds, Vec2& sum, double& weight) {
    weight += kLeanWeight * ds;
    for (const auto q : way.near) {
      sum += kNearWeight * ds / double(way.near.size()) * all[q].lean_at(way.r[k]);
      weight += kNearWeight * ds / double(way.near.size());
    }
  }

  /// Records of one pass: its points, and more where the axis turns. Each is looked at again with the axis it got.
  bool make_axes(std::size_t p) {
    double spacing = kStation;
    for (int round = 0;; ++round) {
      for (const bool smooth : {true, false}) {
        AxisRecords records = records_of(p, smooth);
        std::vector<char> good(records.points.size());
        tbb::parallel_for(std::size_t(0), good.size(), [&](std::size_t k) {
          good[k] = check_.clear(records.points[k], records.axes[k], o_.clearance_mm);
        });
        const auto bad = std::find(good.begin(), good.end(), 0);
        if (bad == good.end()) {
          made_.push_back(std::move(records));
          return true;
        }
        if (!smooth && round == kRounds) {
          const auto& c = records.points[std::size_t(bad - good.begin())].centre;
          refusal_ = OrientationRefusal{fmt::format(
              "the axis is not clear between its stations at radius {:.3f}, height {:.3f}", radius(c), c.z())};
          return false;
        }
      }
      // Something narrow lies between the stations: look closer at this pass.
      spacing /= 2;
      const auto near = ways_[p].near;
      ways_[p] = make_way(tracks_[p], spacing);
      ways_[p].near = near;
      if (!solve(p)) return false;
    }
  }

  [[nodiscard]] AxisRecords records_of(std::size_t p, bool smooth) const {
    const OrientationWay& way = ways_[p];
    const auto axis = [&](double s) {
      const Vec2 q = way.lean_along(s, smooth);
      return check_.frame().axis(q.x(), q.y());
    };
    return records_with_axes(tracks_[p], axis, o_.chord_mm, tool_.radius_mm());
  }

  // Refusals.
  [[nodiscard]] OrientationRefusal parted(const OrientationWay& way, std::size_t station) const {
    const Vec3 c = way.points[station].centre;
    return {
        fmt::format("no five-axis motion either: on one pass the clear directions up to radius {:.3f}, height {:.3f} "
                    "do not join those behind it",
                    radius(c), c.z())};
  }

  /// A place where no direction is clear: the body in the way in the best one, and what more reach would do.
  [[nodiscard]] OrientationRefusal blocked(const OrientationWay& way, std::size_t station) const {
    const auto& point = way.points[station];
    double best = -INFINITY, lean = 0;
    tool::Body body = tool::Body::flute;
    std::vector<Vec3> usable;  // directions in which the ball cuts, whatever stands above it
    for (const auto& q : grid_.leans) {
      const Vec3 axis = check_.frame().axis(q.x(), q.y());
      if (!check_.cutting(point, axis)) continue;
      usable.push_back(axis);
      double gap = o_.clearance_mm;
      tool::Body worst = tool::Body::none;
      for (const auto& f : check_.bodies()) {
        const double g = tree_.gap(f, point.centre - tool_.radius_mm() * axis, axis, gap, kGapResolution);
        if (g < gap) gap = g, worst = f.body;
      }
      if (gap > best) best = gap, lean = angle_between(axis, check_.frame().up), body = worst;
    }
    const std::string where = fmt::format("no five-axis motion either: with the ball at radius {:.3f}, height {:.3f}",
                                          radius(point.centre), point.centre.z());
    if (usable.empty()) return {where + " its flute would cut in every direction"};
    const std::string how = best < 0 ? "cuts in" : fmt::format("keeps {:.3f} mm", best);
    return {fmt::format("{} the best direction leans {:.1f} deg and its {} {}, the clearance is {:.3f} mm; {}", where,
                        degrees(lean), body, how, o_.clearance_mm, advice(point, usable))};
  }

  [[nodiscard]] std::string advice(const BallPass::Point& point, const std::vector<Vec3>& usable) const {
    const auto helps = [&](double by, bool flute) {
      tool::ToolAssembly longer = tool_;
      longer.stick_out_mm += by;
      longer.length_mm += by;
      if (flute) longer.flute_length_mm += by;
      const auto bodies = tool::shank_and_holder(longer);
      return std::any_of(usable.begin(), usable.end(), [&](const Vec3& axis) {
        return tree_.clear(bodies, point.centre - tool_.radius_mm() * axis, axis, o_.clearance_mm + o_.margin_mm,
                           kGapResolution);
      });
    };
    for (const bool flute : {false, true}) {
      if (!helps(kLongestStickOut, flute)) continue;
      double short_by = 0, enough = kLongestStickOut;
      while (enough - short_by > 0.05) {
        const double middle = 0.5 * (short_by + enough);
        (helps(middle, flute) ? enough : short_by) = middle;
      }
      return flute ? fmt::format("a flute of {:.1f} mm (now {:.1f}) with as much more stick-out would clear this place",
                                 tool_.flute_length_mm + enough, tool_.flute_length_mm)
                   : fmt::format("a stick-out of {:.1f} mm (now {:.1f}) would clear this place",
                                 tool_.stick_out_mm + enough, tool_.stick_out_mm);
    }
    return "a slimmer shank is needed";
  }

  const analytic::BodyTree& tree_;
  const tool::ToolAssembly& tool_;
  const OrientationOptions& o_;
  std::vector<BallPass>& passes_;
  OrientationCheck check_;
  LeanGrid grid_;
  std::optional<LeanGrid> fine_;  ///< made when the coarse one does not do
  std::vector<PassTrack> tracks_;
  std::vector<OrientationWay> ways_;
  std::vector<AxisRecords> made_;
  std::optional<OrientationRefusal> refusal_;
};

}  // namespace

OrientationCheck::OrientationCheck(const analytic::GearDistance& part, const analytic::BodyTree& tree, int zone,
                                   const tool::ToolAssembly& tool, const OrientationOptions& options)
    : part_(part),
      tree_(tree),
      tool_(tool),
      o_(options),
      frame_(pitch_frame(part, zone)),
      bodies_(tool::shank_and_holder(tool)) {}

bool OrientationCheck::cutting(const BallPass::Point& point, const Vec3& axis) const {
  return stands_right(point, axis) && flute_is_free(point, axis);
}

bool OrientationCheck::stands_right(const BallPass::Point& point, const Vec3& axis) const {
  if (std::atan2(std::hypot(axis.x(), axis.y()), axis.z()) < o_.least_tilt_rad) return false;
  const Vec3 normal = point.centre - point.contact;
  return !point.touching || normal.norm() <= 0.1 * tool_.radius_mm() || normal.normalized().dot(axis) >= o_.least_draft;
}

bool OrientationCheck::flute_is_free(const BallPass::Point& point, const Vec3& axis) const {
  const double R = tool_.radius_mm();
  const double top = tool_.flute_length_mm - R;
  for (double h = std::min(0.4 * R, top); h > 0; h = h < top ? std::min(h + R, top) : -1) {
    const Vec3 c = point.centre + h * axis;
    if (c.z() - R > part_.gear().blank_top()) break;
    if (part_.nearest(c, R + 0.01).distance < R) return false;
  }
  return true;
}

bool OrientationCheck::clear(const BallPass::Point& point, const Vec3& axis, double clearance_mm) const {
  return stands_right(point, axis) &&
         tree_.clear(bodies_, point.centre - tool_.radius_mm() * axis, axis, clearance_mm, kGapResolution) &&
         flute_is_free(point, axis);
}

Orientation take_axes(std::vector<AxisRecords> made, const OrientationCheck& check, const analytic::BodyTree& tree,
                      const tool::ToolAssembly& tool, std::vector<BallPass>& passes) {
  Orientation out;
  out.least_lean_rad = INFINITY;
  out.clearance_mm = kFarthestGap;
  for (std::size_t p = 0; p < made.size(); ++p) {
    auto& points = made[p].points;
    auto& axes = made[p].axes;
    std::vector<double> gaps(points.size(), kFarthestGap);
    tbb::parallel_for(std::size_t(0), points.size(), [&](std::size_t k) {
      for (const auto& body : check.bodies())
        gaps[k] = std::min(
            gaps[k], tree.gap(body, points[k].centre - tool.radius_mm() * axes[k], axes[k], gaps[k], kGapResolution));
    });
    double turned = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      out.clearance_mm = std::min(out.clearance_mm, gaps[k]);
      const double lean = angle_between(axes[k], check.frame().up);
      out.least_lean_rad = std::min(out.least_lean_rad, lean);
      out.greatest_lean_rad = std::max(out.greatest_lean_rad, lean);
      if (k == 0) continue;
      const double step = angle_between(axes[k - 1], axes[k]), way = (points[k].centre - points[k - 1].centre).norm();
      turned += step;
      out.greatest_step_rad = std::max(out.greatest_step_rad, step);
      if (way > 1e-6) out.greatest_turn_rad_per_mm = std::max(out.greatest_turn_rad_per_mm, step / way);
    }
    if (turned > 1e-6) ++out.turning_passes;
    passes[p].points = std::move(points);
    out.axes.push_back(std::move(axes));
  }
  return out;
}

Expected<Orientation, OrientationRefusal> orient_passes(const analytic::GearDistance& part,
                                                        const analytic::BodyTree& tree, int zone,
                                                        const tool::ToolAssembly& tool,
                                                        const OrientationOptions& options,
                                                        std::vector<BallPass>& passes) {
  ++runs;
  passes.erase(std::remove_if(passes.begin(), passes.end(), [](const BallPass& p) { return p.points.empty(); }),
               passes.end());
  return Orienter(part, tree, zone, tool, options, passes).run();
}

std::size_t orientation_runs() { return runs; }

}  // namespace toothpath::ball
