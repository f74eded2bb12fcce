#include "cam/proof/beside.h"

#include <algorithm>
#include <cmath>

namespace toothpath::proof {
namespace {

constexpr double kReach = 1000;      // mm: the axis also moves shank and holder, less than a metre away
constexpr double kLike = 0.1;        // mm, the same way: motions farther apart tell little of each other
constexpr double kLever = 10;        // mm: of an axis where its turn is weighed against a way of the tip
constexpr std::size_t kAhead = 48;   // motions of the other way among which the next place is looked for,
constexpr std::size_t kSettled = 4;  // and how many behind the best one decide,
constexpr double kThere = 0.003;     // mm: one where it is this near; passes may come by again
constexpr int kHalvings = 5;         // of a motion that is looked for everywhere
constexpr int kSearches = 64;        // of the whole other way, where the one that is followed has gone elsewhere
// Axes are blended in a straight line and then made unit vectors again. Where none turns by more than the first of
// these within a motion, that widens what lies between two of them by no more than the second.
constexpr double kWideTurn = 0.05, kNormalised = 1.001;

float rounded_up(double x) { return std::nextafter(float(std::max(x, 0.0)), INFINITY); }

}  // namespace

Beside::Beside(std::span<const path::ToolMotion> motions, const std::vector<std::uint32_t>& path, double turn)
    : motions_(motions), path_(path), c_(std::cos(turn)), s_(std::sin(turn)), searches_(kSearches) {}

double Beside::axis_rad() const { return kNormalised * axis_; }

Beside::Pose Beside::between(const Pose& a, const Pose& b, double t) {
  return {(1 - t) * a.tip + t * b.tip, (1 - t) * a.axis + t * b.axis};
}

double Beside::apart_squared(const Pose& a, const Pose& b) {
  return (a.tip - b.tip).squaredNorm() + kLever * kLever * (a.axis - b.axis).squaredNorm();
}

double Beside::share(const Pose& a, const Pose& b, const Pose& x) {
  const double square = apart_squared(a, b);
  if (square == 0) return 0;
  const double along = (b.tip - a.tip).dot(x.tip - a.tip) + kLever * kLever * (b.axis - a.axis).dot(x.axis - a.axis);
  return std::clamp(along / square, 0.0, 1.0);
}

bool Beside::turns_wide(const path::ToolMotion& m) { return (m.axis_to - m.axis_from).norm() > kWideTurn; }

void Beside::note(const Pose& a, const Pose& b) {
  tip_ = std::max(tip_, (a.tip - b.tip).norm());
  axis_ = std::max(axis_, (a.axis - b.axis).norm());
}

/// The place of motion n of the path that is nearest.
Beside::Pose Beside::on(std::size_t n, const Pose& x) const {
  const path::ToolMotion& own = motions_[path_[n]];
  const Pose a{own.tip_from, own.axis_from}, b{own.tip_to, own.axis_to};
  return between(a, b, share(a, b, x));
}

double Beside::off_squared(const Pose& x, std::size_t n) const { return apart_squared(x, on(n, x)); }

std::size_t Beside::nearest(const Pose& x, std::size_t first, std::size_t count) const {
  std::size_t best = first;
  double least = INFINITY;
  for (std::size_t n = first; n < std::min(first + count, path_.size()); ++n) {
    const double off = off_squared(x, n);
    if (off < least) {
      least = off;
      best = n;
    } else if (least < kThere * kThere || (n > best + kSettled && least < kLike * kLike)) {
      break;
    }
  }
  return best;
}

bool Beside::follow(const path::ToolMotion& m, const Pose& a, const Pose& b, std::size_t from, std::size_t to) {
  tip_ = axis_ = 0;
  double t = 0;
  bool wide = turns_wide(m);
  for (std::size_t n = from; n <= to; ++n) {
    const path::ToolMotion& own = motions_[path_[n]];
    if (n == from) {
      note(a, on(n, a));
    } else {  // where the motion before this one ends and this one begins
      const path::ToolMotion& before = motions_[path_[n - 1]];
      const Pose start{own.tip_from, own.axis_from};
      t = std::max(t, share(a, b, start));
      note(between(a, b, t), start);
      note(between(a, b, t), {before.tip_to, before.axis_to});
    }
    if (n == to) note(b, on(n, b));
    wide = wide || turns_wide(own);
  }
  return !wide && tip_ + kReach * axis_ <= kLike;
}

std::optional<LikeMotion> Beside::next(const path::ToolMotion& m, std::uint32_t k) {
  const Pose a{back(m.tip_from), back(m.axis_from)}, b{back(m.tip_to), back(m.axis_to)};
  const std::size_t from = nearest(a, at_, kAhead), to = nearest(b, from, kAhead);
  const bool like = follow(m, a, b, from, to);
  // Where one search found nothing near the next motions are likely to be as far: turns of a link are many motions.
  if (like || k != number_ + 1) wait_ = next_wait_ = 0;
  number_ = k;
  if (like) {
    at_ = stood_ = to;
  } else if (searches_ > 0 && wait_-- == 0) {
    at_ = nearest(b, 0, path_.size()), --searches_;
    wait_ = next_wait_;
    next_wait_ = 2 * next_wait_ + 1;
  }
  if (!like) return std::nullopt;
  double stray = INFINITY, turn = INFINITY;
  for (std::size_t n = from; n <= to; ++n) {
    stray = std::min(stray, motions_[path_[n]].deviation_mm);
    turn = std::min(turn, motions_[path_[n]].axis_deviation);
  }
  return LikeMotion{k, path_[from], path_[to] + 1, rounded_up(tip_ + m.deviation_mm - stray),
                    rounded_up(kNormalised * axis_ + m.axis_deviation - turn)};
}

/// A straight stretch is no farther from a straight motion than its ends are; halved, its halves may be near two.
bool Beside::cover(const Pose& a, const Pose& b, int halvings, std::size_t& looks) {
  if (looks == 0) return false;
  --looks;
  std::size_t best = 0;
  double least = INFINITY, nearest_a = INFINITY;
  for (std::size_t n = 0; n < path_.size(); ++n) {
    const double off_a = off_squared(a, n);
    nearest_a = std::min(nearest_a, off_a);
    if (off_a >= least) continue;
    if (const double off = std::max(off_a, off_squared(b, n)); off < least && !turns_wide(motions_[path_[n]])) {
      least = off;
      best = n;
    }
  }
  if (nearest_a > kLike * kLike) return false;
  if (least > kThere * kThere && halvings > 0) {
    const Pose middle = between(a, b, 0.5);
    return cover(a, middle, halvings - 1, looks) && cover(middle, b, halvings - 1, looks);
  }
  note(a, on(best, a));
  note(b, on(best, b));
  return tip_ + kReach * axis_ <= kLike;
}

bool Beside::anywhere(const path::ToolMotion& m, std::size_t& looks) {
  tip_ = axis_ = 0;
  const Pose a{back(m.tip_from), back(m.axis_from)}, b{back(m.tip_to), back(m.axis_to)};
  return !turns_wide(m) && cover(a, b, kHalvings, looks);
}

}  // namespace toothpath::proof
