#include "geometry/inspection/touches.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/inspection/grid.h"

namespace toothpath::inspection {
namespace {

constexpr int kStations = 24;  // of a way
constexpr double kLeastApproach = 0.1, kAboveTops = 5, kStemShare = 0.8;
constexpr double kBelowTop = 1, kBeyondRim = 3;  // of a touch of the blank's rim

/// Distances of a place of space to what stands around one tooth space.
class Space {
 public:
  Space(const face_gear::FaceGear& gear, int zone, int space, double allowance)
      : gear_(gear), f_(gear.rings()[std::size_t(zone)].surface), space_(space), allowance_(allowance) {}

  /// Signed distance to the flank of side +1 of the tooth before the space, or of -1 of the tooth behind it.
  [[nodiscard]] double flank(int side, const Vec3& x) const {
    const int tooth = side > 0 ? space_ : space_ + 1;
    // Above the tops the flank goes on as far as its involute; from what is higher it stands farther off.
    Vec3 q = turned(x, -tooth * gear_.pitch());
    for (int k = 0; k < 200; ++k, q.z() -= 0.05 * f_.shaper.m_t)
      if (const auto d = face_gear::flank_distance(f_, side, q)) return d->distance - allowance_;
    return -std::numeric_limits<double>::infinity();
  }
  [[nodiscard]] double root(const Vec3& x) const { return x.z() - gear_.lowest_root() - allowance_; }

 private:
  const face_gear::FaceGear& gear_;
  const face_gear::FaceGearSurface<double>& f_;
  int space_;
  double allowance_;
};

/// Least gap of ball and stem on the way of one touch. The stem stands straight above the ball.
double gap_of(const Space& space, const Touch& touch, double ball_radius, double tops) {
  double least = std::numeric_limits<double>::infinity();
  const double stem = kStemShare * ball_radius;
  const auto look = [&](const Vec3& centre, bool touching) {
    least = std::min(least, space.root(centre) - ball_radius);
    for (const int side : {1, -1}) {
      if (!(touching && side == touch.side)) least = std::min(least, space.flank(side, centre) - ball_radius);
      for (int k = 1; k <= kStations; ++k) {
        const Vec3 above = centre + Vec3(0, 0, (tops - centre.z()) * k / kStations);
        if (above.z() > centre.z()) least = std::min(least, space.flank(side, above) - stem);
      }
    }
  };
  for (int k = 0; k <= kStations; ++k) {
    const double t = double(k) / kStations;
    look(touch.centre + touch.approach_mm * t * touch.normal, true);
    const Vec3 start = touch.start();
    look(start + Vec3(0, 0, t * std::max(tops - start.z(), 0.0)), false);
  }
  return least;
}

const InspectionPoint* point_of(const std::vector<InspectionPoint>& grid, int zone, int side, int row, int column) {
  for (const auto& p : grid)
    if (p.zone == zone && p.side == side && p.row == row && p.column == column) return &p;
  return nullptr;
}

/// The touch at a point of the grid, with the longest approach that keeps its gap; none fits: approach 0.
Touch touch_at(const face_gear::FaceGear& gear, const InspectionPoint& p, int space, const TouchOptions& options,
               double& gap) {
  const double ball = 0.5 * options.ball_diameter_mm, tops = gear.blank_top();
  Touch touch;
  touch.zone = p.zone;
  touch.side = p.side;
  touch.tooth = (p.side > 0 ? space : space + 1) % gear.parameters().teeth;
  const double turn = (p.side > 0 ? space : space + 1) * gear.pitch();
  touch.normal = turned(p.n, turn);
  touch.centre = turned(p.p, turn) + (ball + options.allowance_mm) * touch.normal;
  const Space around(gear, p.zone, space, options.allowance_mm);
  for (double way = options.approach_mm; way >= kLeastApproach; way *= 0.8) {
    touch.approach_mm = way;
    gap = gap_of(around, touch, ball, tops);
    if (gap >= options.least_gap_mm) return touch;
  }
  touch.approach_mm = 0;
  return touch;
}

Diagnostic too_large(const face_gear::FaceGear& gear, const InspectionPoint& p, const TouchOptions& options) {
  TouchOptions smaller = options;
  double gap = 0, low = 0, high = options.ball_diameter_mm;
  for (int k = 0; k < 20; ++k) {
    smaller.ball_diameter_mm = 0.5 * (low + high);
    (touch_at(gear, p, 0, smaller, gap).approach_mm > 0 ? low : high) = smaller.ball_diameter_mm;
  }
  return fail(
      "a probe's ball of {:.3f} mm does not come to flank {:+} at radius {:.3f} mm with a gap of {:g} mm and "
      "{:g} mm of approach: the largest that does is {:.3f} mm",
      options.ball_diameter_mm, p.side, radius(p.p), options.least_gap_mm, kLeastApproach,
      std::floor(low * 1000) / 1000);
}

Status check_options(const face_gear::FaceGear& gear, const TouchOptions& options) {
  if (!(options.ball_diameter_mm > 0)) return fail("the probe's ball has no diameter");
  if (options.spaces < 3 || options.spaces > gear.parameters().teeth)
    return fail("spaces = {} to touch is outside 3 .. {}", options.spaces, gear.parameters().teeth);
  return Ok{};
}

}  // namespace

Result<TouchPlan> plan_blank_touches(const face_gear::FaceGear& gear, const TouchOptions& options) {
  if (const auto right = check_options(gear, options); !right) return right.error();
  if (std::abs(gear.rings().front().surface.Cg) > 1e-12)
    return fail("shaft_angle = {:g} deg: the blank has no flat top to touch, 90 deg has",
                degrees(gear.parameters().shaft_angle_rad));
  const double ball = 0.5 * options.ball_diameter_mm, above = ball + options.allowance_mm, top = gear.blank_top();
  const auto& outer = gear.rings().back().zone;
  const double middle = 0.5 * (outer.inner_radius_mm + outer.outer_radius_mm);
  TouchPlan plan;
  plan.clear_z_mm = top + kAboveTops;
  plan.gap_mm = options.least_gap_mm;
  for (int k = 0; k < options.spaces; ++k)
    for (const Touched what : {Touched::top, Touched::rim}) {
      const Vec3 outward = turned(Vec3::UnitX(), kTwoPi * k / options.spaces);
      Touch touch;
      touch.what = what;
      touch.number = int(plan.touches.size()) + 1;
      touch.approach_mm = options.approach_mm + (what == Touched::rim ? kBeyondRim : 0);
      touch.normal = what == Touched::top ? Vec3(Vec3::UnitZ()) : outward;
      touch.centre = what == Touched::top
                         ? Vec3(middle * outward + Vec3(0, 0, top + above))
                         : Vec3((outer.outer_radius_mm + above) * outward + Vec3(0, 0, top - kBelowTop));
      plan.touches.push_back(touch);
    }
  return plan;
}

Result<TouchPlan> plan_touches(const face_gear::FaceGear& gear, const TouchOptions& options) {
  if (const auto right = check_options(gear, options); !right) return right.error();
  const int teeth = gear.parameters().teeth;
  const auto grid = inspection_grid(gear, {5, 9, 0.05});
  if (!grid) return grid.error();
  const std::vector<int> columns = gear.rings().size() > 1 ? std::vector<int>{4} : std::vector<int>{2, 6};
  TouchPlan plan;
  plan.clear_z_mm = gear.blank_top() + kAboveTops;
  plan.gap_mm = std::numeric_limits<double>::infinity();
  for (int k = 0; k < options.spaces; ++k) {
    const int space = int(std::lround(double(k) * teeth / options.spaces));
    for (int zone = 0; zone < int(gear.rings().size()); ++zone)
      for (const int column : columns)
        for (const int side : {1, -1}) {
          const InspectionPoint& p = *point_of(*grid, zone, side, 2, column);
          double gap = 0;
          Touch touch = touch_at(gear, p, space, options, gap);
          if (touch.approach_mm == 0) return too_large(gear, p, options);
          touch.number = int(plan.touches.size()) + 1;
          plan.gap_mm = std::min(plan.gap_mm, gap);
          plan.touches.push_back(touch);
        }
  }
  return plan;
}

}  // namespace toothpath::inspection
