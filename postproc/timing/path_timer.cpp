#include "postproc/timing/path_timer.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/angle.h"

namespace toothpath::timing {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kLeastShare = 1e-9;   // of the speed at a corner: below it the path stops
constexpr double kOneLine = 1e-9;      // of a direction, of a speed: no more lies between blocks on one line
constexpr double kLeastBlockMs = 1.0;  // of a control that states none

// LinuxCNC 2.9, as delivered.
constexpr double kServoPeriodMs = 1.0;    // INI: SERVO_PERIOD
constexpr double kKinkRatio = 0.1;        // INI: ARC_BLEND_KINK_RATIO
constexpr double kLeastPeriods = 1.02;    // TP_MIN_SEGMENT_CYCLES: of a block
constexpr double kSharpCorner = 2.0;      // deg: nearer to a reversal than this the path stops
constexpr double kNormalShare = 0.86603;  // BLEND_ACC_RATIO_NORMAL: of the acceleration, across an arc
constexpr double kBlendShare = 0.25;      // of a block: the greatest tolerance that it gets (tcFindBlendTolerance)
constexpr double kFlatAngle = 1e-3;       // rad, TP_MIN_ARC_ANGLE
constexpr double kWholePeriods = 1e-6;    // of a period: rounding of the sum

double dot_linear(const std::array<double, 5>& a, const std::array<double, 5>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

double norm_linear(const std::array<double, 5>& a) { return std::sqrt(dot_linear(a, a)); }

bool turns(const std::array<double, 5>& direction) { return direction[3] != 0 || direction[4] != 0; }

/// Least limit_j / |u_j| over the axes that move.
double along(const std::array<double, 5>& limit, const std::array<double, 5>& u) {
  double least = kInfinite;
  for (std::size_t j = 0; j < 5; ++j)
    if (u[j] != 0) least = std::min(least, limit[j] / std::abs(u[j]));
  return least;
}

std::array<double, 5> difference(const std::array<double, 5>& a, const std::array<double, 5>& b) {
  std::array<double, 5> d{};
  for (std::size_t j = 0; j < 5; ++j) d[j] = b[j] - a[j];
  return d;
}

double whole_periods(double minutes, double period) {
  return period > 0 ? std::ceil(minutes / period - kWholePeriods) * period : minutes;
}

}  // namespace

bool AxisLimits::has_jerk() const {
  return std::any_of(jerk.begin(), jerk.end(), [](double j) { return j > 0; });
}

AxisLimits limits_of(const machines::Machine& machine) {
  const machines::KinematicChain& chain = machine.chain;
  AxisLimits out;
  out.speed.fill(kInfinite);
  out.acceleration.fill(kInfinite);
  out.jerk.fill(kInfinite);
  for (std::size_t i = 0; i < 3; ++i) {
    out.speed[i] = chain.linear[i].max_speed;
    out.acceleration[i] = chain.linear[i].max_acceleration;
    out.jerk[i] = chain.linear[i].max_jerk;
  }
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) {
    const machines::RotaryAxis& axis = chain.rotary(k);
    out.speed[3 + k] = degrees(axis.max_speed);
    out.acceleration[3 + k] = degrees(axis.max_acceleration);
    out.jerk[3 + k] = degrees(axis.max_jerk);
  }
  if (!machine.has_jerk()) out.jerk.fill(0);
  return out;
}

PathControl control_of(const machines::Machine& machine, Corners corners) {
  PathControl out;
  out.corners = corners;
  if (corners == Corners::exact || corners == Corners::blend) {
    out.period_min = kServoPeriodMs / 60000;
    out.plans_words = true;
  } else {
    out.jump_min = (machine.min_block_ms > 0 ? machine.min_block_ms : kLeastBlockMs) / 60000;
  }
  return out;
}

PathTimer::PathTimer(const AxisLimits& limits, const PathControl& control, Sink sink)
    : limits_(limits), control_(control), sink_(std::move(sink)), jerk_(limits.has_jerk()) {}

void PathTimer::set_corners(Corners corners, double tolerance_mm) {
  if (corners == control_.corners && tolerance_mm == control_.tolerance_mm) return;
  finish();
  control_.corners = corners;
  control_.tolerance_mm = tolerance_mm;
}

PathTimer::Piece PathTimer::piece_of(const Block& block) const {
  Piece p;
  double square = 0;
  for (const double s : block.step) square += s * s;
  p.length = std::sqrt(square);
  for (std::size_t j = 0; j < 5; ++j) p.direction[j] = block.step[j] / p.length;
  const double asked = block.minutes > 0 ? p.length / block.minutes : kInfinite;
  p.limits.speed = std::min(asked, along(limits_.speed, p.direction));
  if (control_.period_min > 0)
    p.limits.speed = std::min(p.limits.speed, p.length / (kLeastPeriods * control_.period_min));
  p.limits.acceleration = along(limits_.acceleration, p.direction);
  p.limits.jerk = jerk_ ? along(limits_.jerk, p.direction) : 0;
  p.ends = {p.length};
  return p;
}

bool PathTimer::on_one_line(const Piece& a, const Piece& b) const {
  if (control_.corners == Corners::stop) return false;
  if (control_.corners != Corners::jump && !is_bounded(control_.corners) && (turns(a.direction) || turns(b.direction)))
    return false;
  for (const double d : difference(a.direction, b.direction))
    if (std::abs(d) > kOneLine) return false;
  return std::abs(a.limits.speed - b.limits.speed) <= kOneLine * a.limits.speed;
}

PathTimer::Corner PathTimer::exact_corner(const Piece& a, const Piece& b) const {
  if (turns(a.direction) || turns(b.direction)) return {};
  if (dot_linear(a.direction, b.direction) < -std::cos(radians(kSharpCorner))) return {};
  const double v = std::min(a.limits.speed, b.limits.speed);
  const double change = v / control_.period_min + b.limits.acceleration;
  const double share = change / along(limits_.acceleration, difference(a.direction, b.direction));
  // A corner that is too sharp stops the path and takes its tenth of the acceleration all the same.
  return share < kKinkRatio ? Corner{v, share, 0} : Corner{0, kKinkRatio, 0};
}

PathTimer::Corner PathTimer::blended_corner(const Piece& a, const Piece& b) const {
  const double wa = norm_linear(a.direction), wb = norm_linear(b.direction);
  const double cosine = wa > 0 && wb > 0 ? std::clamp(dot_linear(a.direction, b.direction) / (wa * wb), -1.0, 1.0) : 0;
  const double half = 0.5 * std::acos(-cosine);  // of the angle between both lines: pi / 2 where they are one
  if (!turns(a.direction) && !turns(b.direction)) {
    const Corner exact = exact_corner(a, b);
    if (exact.speed > 0 || exact.shortened == 0) return exact;
    const double v = std::min(a.limits.speed, b.limits.speed), least = std::min(a.length, b.length);
    const double kink = v * kKinkRatio /
                        ((v / control_.period_min + b.limits.acceleration) /
                         along(limits_.acceleration, difference(a.direction, b.direction)));
    const double tolerance = std::min(control_.tolerance_mm, kBlendShare * least);
    const double reach = std::min(std::cos(half) * tolerance / (1 - std::sin(half)), 0.5 * least);
    const double radius = reach * std::tan(half), arc = radius * (kPi - 2 * half);
    const double across =
        kNormalShare * std::min({limits_.acceleration[0], limits_.acceleration[1], limits_.acceleration[2]});
    const double round = std::min({v, std::sqrt(across * radius), arc / control_.period_min});
    return round > kink ? Corner{round, 0, 0} : Corner{kink, kKinkRatio, 0};
  }
  // Two parabolas: both blocks have half of their acceleration, and the next begins where this one has braked to the
  // speed that keeps the tolerance. Speeds are those of X Y Z where these move.
  const double sa = wa > 0 ? wa : 1, sb = wb > 0 ? wb : 1;
  const double aa = 0.5 * a.limits.acceleration * sa, ab = 0.5 * b.limits.acceleration * sb;
  const double va = std::min(a.limits.speed * sa, std::sqrt(aa * a.length * sa)),
               vb = std::min(b.limits.speed * sb, std::sqrt(ab * b.length * sb));
  const double time = std::min({a.length * sa / va, b.length * sb / vb, std::max(va / aa, vb / ab)});
  double v = std::min(va, time * aa);
  if (std::cos(half) > std::sin(kFlatAngle) && control_.tolerance_mm > 0)
    v = std::min(v, 2 * std::sqrt(aa * control_.tolerance_mm / std::cos(half)));
  return {0, 0.5, v / aa};
}

PathTimer::Corner PathTimer::corner_of(const Piece& a, const Piece& b) const {
  switch (control_.corners) {
    case Corners::stop: return {};
    case Corners::exact: return exact_corner(a, b);
    case Corners::blend: return blended_corner(a, b);
    default: return jumped_corner(a, b);
  }
}

/// A change of speed v D in the time v / r, r the quickest that the axes can, is a parabola. It begins and ends v^2 /
/// 2r from the corner, which it passes at v^2 |D| / 8r; no more than half of a block is its own.
PathTimer::Corner PathTimer::jumped_corner(const Piece& a, const Piece& b) const {
  const double least = std::min(a.limits.speed, b.limits.speed);
  const auto change = difference(a.direction, b.direction);
  const double rate = along(limits_.acceleration, change);
  double v = control_.jump_min * rate;
  if (is_bounded(control_.corners) && control_.tolerance_mm > 0 && std::isfinite(rate)) {
    double square = 0;
    for (const double d : change) square += d * d;
    const double within = control_.corners == Corners::way
                              ? std::sqrt(2 * control_.tolerance_mm * rate)
                              : std::sqrt(8 * control_.tolerance_mm * rate / std::sqrt(square));
    v = std::max(v, std::min(within, std::sqrt(std::min(a.length, b.length) * rate)));
  }
  v = std::min(v, least);
  return {v < kLeastShare * least ? 0 : v, 0, 0};
}

void PathTimer::add(const Block& block) {
  const bool moves = std::any_of(block.step.begin(), block.step.end(), [](double s) { return s != 0; });
  if (!moves || block.rapid) flush(0);
  if (!moves) {
    sink_(block.minutes);
    return;
  }
  Piece piece = piece_of(block);
  if (!pieces_.empty()) {
    Piece& last = pieces_.back();
    if (jerk_ && on_one_line(last, piece)) {
      last.length += piece.length;
      last.ends.push_back(last.length);
      return;
    }
    const Corner corner = corner_of(last, piece);
    last.shortened = std::max(last.shortened, corner.shortened);
    last.leaves = corner.speed;
    piece.shortened = corner.shortened;
    if (corner.speed == 0) flush(corner.overlap_min);
  }
  pieces_.push_back(std::move(piece));
  if (block.rapid) flush(0);
}

void PathTimer::finish() { flush(0); }

void PathTimer::flush(double overlap_min) {
  if (pieces_.empty()) return;
  pieces_.back().leaves = 0;
  for (Piece& p : pieces_) p.limits.acceleration *= 1 - p.shortened;
  double before = 0;
  for (Piece& p : pieces_) before = p.leaves = std::min(p.leaves, reachable(before, p.length, p.limits));
  for (std::size_t i = pieces_.size(); i-- > 1;)
    pieces_[i - 1].leaves =
        std::min(pieces_[i - 1].leaves, reachable(pieces_[i].leaves, pieces_[i].length, pieces_[i].limits));
  std::vector<double> times;
  double total = 0, enters = 0;
  for (const Piece& p : pieces_) {
    const Profile profile(p.length, enters, p.leaves, p.limits);
    double passed = 0;
    for (std::size_t k = 0; k < p.ends.size(); ++k) {
      const double at = k + 1 == p.ends.size() ? profile.time() : profile.time_at(p.ends[k]);
      times.push_back(at - passed);
      passed = at;
    }
    total += profile.time();
    enters = p.leaves;
  }
  pieces_.clear();
  const double overlap = std::min(overlap_min, times.back());
  times.back() += whole_periods(total - overlap, control_.period_min) - total;
  for (const double t : times) sink_(t);
}

std::vector<double> times_of(std::span<const Block> blocks, const AxisLimits& limits, const PathControl& control) {
  std::vector<double> times;
  times.reserve(blocks.size());
  PathTimer timer(limits, control, [&times](double minutes) { times.push_back(minutes); });
  for (const Block& b : blocks) timer.add(b);
  timer.finish();
  return times;
}

}  // namespace toothpath::timing
