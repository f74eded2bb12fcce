#include "geometry/inspection/touches.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toothpath::inspection {
namespace {

constexpr int kStations = 24;  // of a way
constexpr double kLeastApproach = 0.1, kStemShare = 0.8;
constexpr double kBeyondRim = 3;  // of a touch of the blank's rim

/// Least gap of ball and stem on the way of one touch. The stem stands straight above the ball.
double gap_of(const TouchedPart& part, const Touch& touch, double ball_radius, double allowance) {
  double least = std::numeric_limits<double>::infinity();
  const double stem = kStemShare * ball_radius;
  const auto look = [&](const Vec3& centre, bool touching) {
    least = std::min(least, part.above_root(touch, centre) - allowance - ball_radius);
    const double way = part.below_tops(touch, centre);
    for (const int side : {1, -1}) {
      const auto gap = [&](const Vec3& at) { return part.flank(touch, side, at) - allowance; };
      if (!(touching && side == touch.side)) least = std::min(least, gap(centre) - ball_radius);
      for (int k = 1; k <= kStations && way > 0; ++k)
        least = std::min(least, gap(centre + way * k / kStations * touch.up) - stem);
    }
  };
  for (int k = 0; k <= kStations; ++k) {
    const double t = double(k) / kStations;
    look(touch.centre + touch.approach_mm * t * touch.normal, true);
    const Vec3 start = touch.start();
    look(start + t * part.below_tops(touch, start) * touch.up, false);
  }
  return least;
}

/// The longest approach that keeps its gap into `touch`; @returns that gap, nothing where none does.
std::optional<double> approach(const TouchedPart& part, Touch& touch, const TouchOptions& options) {
  const double ball = 0.5 * options.ball_diameter_mm;
  touch.centre = touch.surface + (ball + options.allowance_mm) * touch.normal;
  for (double way = options.approach_mm; way >= kLeastApproach; way *= 0.8) {
    touch.approach_mm = way;
    const double gap = gap_of(part, touch, ball, options.allowance_mm);
    if (gap >= options.least_gap_mm) return gap;
  }
  return {};
}

Diagnostic too_large(const TouchedPart& part, const Touch& touch, const TouchOptions& options) {
  TouchOptions smaller = options;
  double low = 0, high = options.ball_diameter_mm;
  for (int k = 0; k < 20; ++k) {
    smaller.ball_diameter_mm = 0.5 * (low + high);
    Touch other = touch;
    (approach(part, other, smaller) ? low : high) = smaller.ball_diameter_mm;
  }
  return fail(
      "a probe's ball of {:.3f} mm does not come to flank {:+} at radius {:.3f} mm with a gap of {:g} mm and "
      "{:g} mm of approach: the largest that does is {:.3f} mm",
      options.ball_diameter_mm, touch.side, radius(touch.surface), options.least_gap_mm, kLeastApproach,
      std::floor(low * 1000) / 1000);
}

Status check_options(const TouchedPart& part, const TouchOptions& options) {
  if (!(options.ball_diameter_mm > 0)) return fail("the probe's ball has no diameter");
  if (options.spaces < 3 || options.spaces > part.teeth())
    return fail("spaces = {} to touch is outside 3 .. {}", options.spaces, part.teeth());
  return Ok{};
}

}  // namespace

Result<TouchPlan> plan_blank_touches(const TouchedPart& part, const TouchOptions& options) {
  if (const auto right = check_options(part, options); !right) return right.error();
  auto places = part.blank_places(options.spaces);
  if (!places) return places.error();
  TouchPlan plan{std::move(*places), part.reach(), options.least_gap_mm};
  int number = 0;
  for (Touch& touch : plan.touches) {
    touch.number = ++number;
    touch.approach_mm = options.approach_mm + (touch.what == Touched::rim ? kBeyondRim : 0);
    touch.centre = touch.surface + (0.5 * options.ball_diameter_mm + options.allowance_mm) * touch.normal;
  }
  return plan;
}

Result<TouchPlan> plan_touches(const TouchedPart& part, const TouchOptions& options) {
  if (const auto right = check_options(part, options); !right) return right.error();
  auto places = part.flank_places(options.spaces);
  if (!places) return places.error();
  TouchPlan plan{std::move(*places), part.reach(), std::numeric_limits<double>::infinity()};
  int number = 0;
  for (Touch& touch : plan.touches) {
    touch.number = ++number;
    if (touch.what == Touched::end) {
      touch.approach_mm = options.approach_mm;
      touch.centre = touch.surface + 0.5 * options.ball_diameter_mm * touch.normal;
      continue;
    }
    const auto gap = approach(part, touch, options);
    if (!gap) return too_large(part, touch, options);
    plan.gap_mm = std::min(plan.gap_mm, *gap);
  }
  return plan;
}

}  // namespace toothpath::inspection
