#include "postproc/shaper/simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

#include "geometry/base/angle.h"
#include "geometry/base/golden_section.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/face_gear/limits.h"
#include "postproc/shaper/setup.h"

namespace toothpath::shaper {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
/// Beyond the tip circle by this much [mm] only "not near" matters.
constexpr double kNear = 2.0;

struct Plane {
  double x = 0, y = 0;
};

/// A work-fixed point as seen from the cutter axis when the work has turned by `work`; before the cutter's own turn.
struct Seen {
  double Z = 0;
  Plane at;
};
Seen seen_from_cutter(const face_gear::FaceGearSurface<double>& gear, const Vec3& point, double work, double x_lift) {
  const Vec3 p = turned(point, work);
  return {p.x() * gear.Sg - p.z() * gear.Cg, {-p.x() * gear.Cg - p.z() * gear.Sg + x_lift, p.y() - gear.E}};
}

/// Distance of a point of the transverse plane to the cutter turned by `turn`.
double turned_cutter_distance(const face_gear::InvoluteShaper<double>& cutter, const Plane& p, double turn) {
  const double beyond = std::hypot(p.x, p.y) - cutter.r_a;
  if (beyond > kNear) return beyond;
  const double c = std::cos(turn), s = std::sin(turn);
  return cutter_distance(cutter, c * p.x + s * p.y, -s * p.x + c * p.y);
}

/// Range of work turns, either side of 0, outside of which a tooth at azimuth 0 is out of the cutter's reach.
double reach(const face_gear::FaceGearSurface<double>& gear, double inner_radius) {
  const double sine = (std::abs(gear.E) + gear.shaper.r_a) / inner_radius;
  return (sine < 1 ? std::asin(sine) : kPi / 2) + gear.pitch;
}

template <typename F>
double golden_minimum(F&& f, double lo, double hi) {
  auto search = golden_section<std::less<>>(lo, hi, std::ref(f));
  for (int k = 0; k < 48; ++k) search.step();
  return search.best().second;
}

}  // namespace

double cutter_distance(const face_gear::InvoluteShaper<double>& k, double x, double y) {
  const double R = std::hypot(x, y), pitch = 2 * kPi / k.teeth;
  double w = std::atan2(y, x);
  w = std::abs(w - pitch * std::round(w / pitch));  // from the nearest space centre, 0 .. pi/N_s
  if (R < k.r_b) return R * std::sin(k.theta_0 - w);
  const double reach = std::sqrt((R - k.r_b) * (R + k.r_b));
  const double theta_foot = w + std::atan2(reach, k.r_b) - k.theta_0;  // roll angle of the tangent through the point
  const double beyond_tip = R - k.r_a;
  if (theta_foot <= k.theta_t) return std::max(reach - k.r_b * theta_foot, beyond_tip);
  if (w >= k.psi_c) return beyond_tip;
  // The rounding, or the sharp edge for rho = 0.
  const double across = std::hypot(R * std::cos(w - k.psi_c) - k.r_c, R * std::sin(w - k.psi_c));
  return across - k.rho;
}

std::optional<double> stroke_distance(const face_gear::FaceGearSurface<double>& gear, const ShaperStroke& stroke,
                                      const Vec3& point) {
  const double length = stroke.z_to_mm - stroke.z_from_mm;
  const auto work_at = [&](double t) { return stroke.work_from + t * (stroke.work_to - stroke.work_from); };
  // The section of the point hardly moves while the work turns by one feed: each step wins two digits or more.
  double t = 0.5;
  Seen seen;
  for (int k = 0; k < 16; ++k) {
    seen = seen_from_cutter(gear, point, work_at(t), stroke.x_mm);
    const double before = t;
    t = (seen.Z - stroke.z_from_mm) / length;
    if (std::abs(t - before) < 1e-13) break;
    // Far from the cutter the last digits of the moment do not matter.
    if (std::hypot(seen.at.x, seen.at.y) > gear.shaper.r_a + 2 * kNear) break;
  }
  if (!(t >= 0 && t <= 1)) return std::nullopt;
  return turned_cutter_distance(gear.shaper, seen.at, stroke.cutter_from + t * (stroke.cutter_to - stroke.cutter_from));
}

double swept_distance(const face_gear::FaceGearSurface<double>& gear, const std::vector<ShaperStroke>& strokes,
                      const Vec3& point) {
  double least = kFar;
  for (const auto& stroke : strokes)
    if (const auto d = stroke_distance(gear, stroke, point)) least = std::min(least, *d);
  return least;
}

double generated_distance(const face_gear::FaceGearSurface<double>& gear, const Vec3& point) {
  const double r = std::hypot(point.x(), point.y()), azimuth = std::atan2(point.y(), point.x());
  const double top = (gear.E + gear.shaper.r_a) / r, bottom = (gear.E - gear.shaper.r_a) / r;
  const double hi = std::asin(std::min(1.0, top)), lo = std::asin(std::max(-1.0, bottom));
  const double from = (lo - azimuth) / gear.i, to = (hi - azimuth) / gear.i;
  const auto distance = [&](double phi) {
    const Seen seen = seen_from_cutter(gear, point, gear.i * phi, 0);
    return turned_cutter_distance(gear.shaper, seen.at, phi + gear.shaper.kappa * (seen.Z - gear.L0));
  };
  const int n = std::max(8, static_cast<int>(std::ceil(48 * (to - from) * gear.shaper.teeth / (2 * kPi))));
  const double step = (to - from) / n;
  double before = kFar, here = distance(from), best = here;
  for (int k = 0; k <= n; ++k) {
    const double after = k < n ? distance(from + step * (k + 1)) : kFar;
    if (here <= before && here <= after && here < kNear)
      best = std::min(best, golden_minimum(distance, from + step * (k - 1), from + step * (k + 1)));
    best = std::min(best, here);
    before = here;
    here = after;
  }
  return best;
}

std::vector<FlankSample> flank_samples(const face_gear::FaceGearSurface<double>& gear, double inner_radius,
                                       double outer_radius, int rows, int columns, int tooth) {
  std::vector<FlankSample> samples;
  for (const int side : {1, -1})
    for (int c = 0; c < columns; ++c) {
      const double r = inner_radius + (outer_radius - inner_radius) * c / (columns - 1);
      const auto z_low = face_gear::fillet_line_height(gear, side, r);
      if (!z_low) continue;
      for (int k = 0; k < rows; ++k) {
        const double z = *z_low + (gear.z_tip(r) - *z_low) * k / (rows - 1);
        const auto at = face_gear::invert_flank(gear, side, r, z);
        if (!at) continue;
        const auto p = gear.flank(side, at->theta, at->B);
        const double turn = gear.pitch * tooth;
        samples.push_back({side, at->theta, at->B, turned(p.p, turn), turned(p.n, turn)});
      }
    }
  return samples;
}

ShapedDeviation shaped_deviation(const face_gear::FaceGearSurface<double>& gear,
                                 const std::vector<ShaperStroke>& strokes, const std::vector<FlankSample>& samples) {
  ShapedDeviation result;
  result.points = samples.size();
  if (samples.empty()) return result;
  double squares = 0;
  result.max_left_um = -kFar;
  result.deepest_um = kFar;
  for (const auto& sample : samples) {
    const double um = 1000 * swept_distance(gear, strokes, sample.point);
    result.max_left_um = std::max(result.max_left_um, um);
    result.deepest_um = std::min(result.deepest_um, um);
    squares += um * um;
  }
  result.rms_um = std::sqrt(squares / static_cast<double>(samples.size()));
  return result;
}

namespace {

/// Strokes first..last of an even generating motion; stroke j ends at work turn j * per_stroke.
std::vector<ShaperStroke> even_strokes(const ShaperSetup& s, int first, int last, int strokes_turn, bool with_infeed) {
  std::vector<ShaperStroke> strokes;
  const double direction = s.machine.axes.at('A').sign;
  const auto work = [&](int j) { return direction * 2 * kPi * j / strokes_turn; };
  const double ratio = double(s.work_teeth) / s.cutter_teeth;
  for (int j = first; j <= last; ++j)
    strokes.push_back({with_infeed ? s.x_at_stroke(j) : 0.0, s.start_mm, s.end_mm, ratio * work(j - 1), ratio * work(j),
                       work(j - 1), work(j)});
  return strokes;
}

}  // namespace

std::vector<ShaperStroke> planned_strokes(const ShaperSetup& setup, int first, int last) {
  return even_strokes(setup, first, last, setup.strokes_turn, true);
}

std::vector<FeedStudyRow> feed_study(const ShaperSetup& setup, const std::vector<double>& feeds_mm) {
  auto samples = flank_samples(setup.surface, setup.inner_radius_mm, setup.outer_radius_mm, 9, 13);
  // Inside of the involute start the generating itself takes the tip corner away, whatever the feed.
  std::erase_if(samples, [](const FlankSample& sample) { return sample.theta < 0; });
  const double window = reach(setup.surface, setup.inner_radius_mm);
  std::vector<FeedStudyRow> rows;
  for (const double feed : feeds_mm) {
    const double per_turn = kPi * setup.pitch_diameter_mm / feed * setup.work_teeth / setup.cutter_teeth;
    const int turn = static_cast<int>(std::ceil(per_turn));
    const int half = static_cast<int>(std::ceil(window / (2 * kPi) * turn));
    FeedStudyRow row;
    row.circular_feed_mm = feed;
    row.minutes = (setup.strokes_infeed + turn) / setup.strokes_set;
    row.deviation = shaped_deviation(setup.surface, even_strokes(setup, -half, half, turn, false), samples);
    rows.push_back(row);
  }
  return rows;
}

BackStrokeClearance back_stroke_clearance(const ShaperSetup& s, double relief_mm) {
  const auto& gear = s.surface;
  const auto& cutter = gear.shaper;
  const int now = s.strokes_infeed + s.strokes_turn / 2;
  const int past = static_cast<int>(std::ceil(2 * reach(gear, s.inner_radius_mm) / (2 * kPi) * s.strokes_turn));
  const auto strokes = planned_strokes(s, std::max(1, now - past), now);
  const double phi = strokes.back().cutter_to, work = strokes.back().work_to, tooth = 2 * kPi / cutter.teeth;
  BackStrokeClearance clearance{kFar, kFar};
  const auto probe = [&](double x, double y) {
    for (const double r : {s.inner_radius_mm, s.outer_radius_mm}) {
      const double across = gear.E + y;
      if (std::abs(across) >= r) continue;
      const double Z = std::sqrt((r - across) * (r + across));
      // Where the edge does not come, it does not rub.
      if (Z > std::max(s.start_mm, s.end_mm) || Z < std::min(s.start_mm, s.end_mm)) continue;
      const Vec3 housing = gear.b() * across + gear.a() * Z + gear.d() * (x - relief_mm);
      const double above = housing.z() - gear.z_tip(r);
      const Vec3 point = turned(housing, -work);
      if (above >= std::min(clearance.flank_mm, clearance.stock_mm)) continue;
      clearance.flank_mm = std::min(clearance.flank_mm, std::max(above, -generated_distance(gear, point)));
      clearance.stock_mm = std::min(clearance.stock_mm, std::max(above, -swept_distance(gear, strokes, point)));
    }
  };
  constexpr int kSteps = 10;
  for (int k = 0; k < cutter.teeth; ++k)
    for (const int side : {1, -1}) {
      const double centre = phi + k * tooth;
      // Teeth that point away from the work are not in question.
      if (std::cos(centre) < 0) continue;
      for (int step = 0; step <= kSteps; ++step) {
        const double theta = cutter.theta_t * step / kSteps, x = side * (cutter.theta_0 + theta) + centre;
        probe(cutter.r_b * (std::cos(x) + side * theta * std::sin(x)),
              cutter.r_b * (std::sin(x) - side * theta * std::cos(x)));
      }
      for (const double part : {0.0, 0.5, 1.0}) {
        const double psi = centre + side * (cutter.psi_c + part * (tooth / 2 - cutter.psi_c));
        probe(cutter.r_a * std::cos(psi), cutter.r_a * std::sin(psi));
      }
    }
  return clearance;
}

std::optional<TipArcs> tip_arcs_at_depth(const face_gear::FaceGearSurface<double>& gear, double r, double x) {
  // A cutter lifted by x leaves the finished surface shifted by x: its tip surface shows the section x further down.
  const double z = gear.z_tip(r) - x;
  const auto distance = [&](double azimuth) {
    return generated_distance(gear, Vec3(r * std::cos(azimuth), r * std::sin(azimuth), z));
  };
  const auto crossing = [&](double inside, double outside) {
    for (int k = 0; k < 60; ++k) {
      const double middle = (inside + outside) / 2;
      (distance(middle) > 0 ? inside : outside) = middle;
    }
    return (inside + outside) / 2;
  };
  constexpr int kSteps = 96;
  const double start = std::asin(std::clamp(gear.E / r, -1.0, 1.0)), step = gear.pitch / kSteps;
  std::array<bool, kSteps> solid{};
  for (int k = 0; k < kSteps; ++k) solid[std::size_t(k)] = distance(start + k * step) > 0;
  const auto at = [&](int k) { return solid[std::size_t((k + kSteps) % kSteps)]; };
  std::optional<double> rise, fall;
  for (int k = 0; k < kSteps && !rise; ++k)
    if (!at(k) && at(k + 1)) {
      rise = crossing(start + (k + 1) * step, start + k * step);
      for (int n = k + 1; n <= k + kSteps && !fall; ++n)
        if (at(n) && !at(n + 1)) fall = crossing(start + n * step, start + (n + 1) * step);
    }
  if (!rise || !fall) return std::nullopt;
  const double tooth = r * (*fall - *rise);
  return TipArcs{tooth, r * gear.pitch - tooth};
}

}  // namespace toothpath::shaper
