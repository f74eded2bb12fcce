#include "postproc/timing/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace toothpath::timing {
namespace {

constexpr int kHalvings = 200;  // ends earlier, where the middle is one of the ends
constexpr int kNewtonSteps = 60;

/// A ramp by `change` has a piece of constant acceleration.
bool reaches_acceleration(double change, const Limits& l) { return change * l.jerk >= l.acceleration * l.acceleration; }

/// Root s > 0 of jerk s^3 + 2 v s = length: convex and growing, Newton from above falls onto it.
double short_ramp_root(double v, double length, double jerk) {
  double s = std::cbrt(length / jerk);
  for (int i = 0; i < kNewtonSteps; ++i) {
    const double next = s - (s * (jerk * s * s + 2 * v) - length) / (3 * jerk * s * s + 2 * v);
    if (!(next < s)) break;
    s = next;
  }
  return s;
}

}  // namespace

double ramp_time(double change, const Limits& l) {
  if (change <= 0 || std::isinf(l.acceleration)) return 0;
  if (!(l.jerk > 0)) return change / l.acceleration;
  return reaches_acceleration(change, l) ? change / l.acceleration + l.acceleration / l.jerk
                                         : 2 * std::sqrt(change / l.jerk);
}

double ramp_length(double from, double to, const Limits& l) {
  return 0.5 * (from + to) * ramp_time(std::abs(to - from), l);
}

double reachable(double from, double length, const Limits& l) {
  if (std::isinf(l.acceleration)) return std::numeric_limits<double>::infinity();
  if (!(l.jerk > 0)) return std::sqrt(from * from + 2 * l.acceleration * length);
  const double s = short_ramp_root(from, length, l.jerk), change = l.jerk * s * s;
  if (!reaches_acceleration(change, l)) return from + change;
  // (from + to) / 2 ((to - from) / a + a / j) = length
  const double b = l.acceleration * l.acceleration / l.jerk;
  return 0.5 * (std::sqrt(b * b + 4 * (from * from - b * from + 2 * l.acceleration * length)) - b);
}

Profile::Profile(double length, double from, double to, const Limits& l) {
  const double least = std::max(from, to), most = std::max(least, l.speed);
  const auto ramps = [&](double top) { return ramp_length(from, top, l) + ramp_length(top, to, l); };
  if (ramps(most) <= length) {
    peak_ = most;
  } else if (!(l.jerk > 0)) {
    peak_ = std::clamp(std::sqrt(0.5 * (from * from + to * to) + l.acceleration * length), least, most);
  } else {
    double low = least, high = most;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (ramps(middle) <= length ? low : high) = middle;
    }
    peak_ = low;
  }
  add_ramp(from, peak_, l);
  const double rest = length - ramps(peak_);
  if (rest > 0 && peak_ > 0) phases_[count_++] = {rest / peak_, 0, 0, peak_};
  add_ramp(peak_, to, l);
  for (std::size_t i = 0; i < count_; ++i) time_ += phases_[i].time;
}

void Profile::add_ramp(double from, double to, const Limits& l) {
  const double change = std::abs(to - from), sense = to < from ? -1 : 1;
  if (change == 0 || std::isinf(l.acceleration)) return;
  if (!(l.jerk > 0)) {
    phases_[count_++] = {change / l.acceleration, 0, sense * l.acceleration, from};
    return;
  }
  const bool whole = reaches_acceleration(change, l);
  const double rise = whole ? l.acceleration / l.jerk : std::sqrt(change / l.jerk);
  const double a = sense * l.jerk * rise, part = 0.5 * a * rise;
  phases_[count_++] = {rise, sense * l.jerk, 0, from};
  if (whole) phases_[count_++] = {change / l.acceleration - rise, 0, a, from + part};
  phases_[count_++] = {rise, -sense * l.jerk, a, to - part};
}

double Profile::time_at(double way) const {
  double before = 0, passed = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const Phase& p = phases_[k];
    const double own = p.way(p.time);
    if (passed + own < way && k + 1 < count_) {
      passed += own;
      before += p.time;
      continue;
    }
    const double left = std::min(way - passed, own);
    double low = 0, high = p.time;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high) break;
      (p.way(middle) <= left ? low : high) = middle;
    }
    return before + (left >= own ? p.time : low);
  }
  return before;
}

}  // namespace toothpath::timing
