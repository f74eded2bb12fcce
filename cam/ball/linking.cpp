#include "cam/ball/linking.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cam/path/motion_blend.h"

namespace toothpath::ball {
namespace {

constexpr double kFirstLift = 1, kFarthestLift = 1e6;  // mm
constexpr int kLiftHalvings = 60;

class Linker {
 public:
  Linker(const std::vector<BallPass>& passes, const LinkingOptions& o, const HopMeets& meets,
         const BodiesAreClear& bodies, std::vector<path::ClRecord>& out)
      : passes_(passes), o_(o), meets_(meets), bodies_are_clear_(bodies), out_(out) {}

  void run() {
    int number = 0;
    for (std::size_t p = 0; p < passes_.size(); ++p) {
      const auto& points = passes_[p].points;
      if (points.empty()) continue;
      const auto axis = [&](std::size_t k) { return axis_at(p, k); };
      pass_ = number++;
      approach(points.front().centre, axis(0));
      for (std::size_t k = 1; k < points.size(); ++k) feed(points[k - 1], axis(k - 1), points[k], axis(k));
      last_ = points.back().centre;
      last_axis_ = axis(points.size() - 1);
      before_ = p;
      engaged_ = true;
    }
    if (engaged_) leave();
  }

 private:
  [[nodiscard]] Vec3 tip(const Vec3& centre, const Vec3& axis) const { return centre - o_.centre_mm * axis; }
  /// The centre lifted along the axis until tip, shank and holder are above the clearance height.
  [[nodiscard]] Vec3 above(const Vec3& centre, const Vec3& axis) const {
    if (!o_.clearance.flat()) return above_round(centre, axis);
    double lowest = -o_.centre_mm * axis.z();  // under the centre
    for (const auto& f : o_.bodies) lowest = std::min(lowest, tool::lowest_z(f, -o_.centre_mm * axis, axis));
    const double lift = (o_.clearance.top() - lowest - centre.z()) / axis.z();
    return centre + std::max(lift, 0.0) * axis;
  }
  /// The same where that height is a surface about the gear axis: the height of all of the tool grows along an axis
  /// that points outwards.
  [[nodiscard]] Vec3 above_round(const Vec3& centre, const Vec3& axis) const {
    const auto over = [&](double lift) {
      const Vec3 foot = tip(centre + lift * axis, axis);
      double least = o_.clearance.over(std::array{foot});
      for (const auto& f : o_.bodies) least = std::min(least, o_.clearance.over(f, foot, axis));
      return least;
    };
    if (over(0) >= 0) return centre;
    double low = 0, high = kFirstLift;
    while (over(high) < 0 && high < kFarthestLift) high *= 2;
    for (int k = 0; k < kLiftHalvings; ++k) {
      const double middle = 0.5 * (low + high);
      (over(middle) < 0 ? low : high) = middle;
    }
    return centre + high * axis;
  }
  void add(const Vec3& centre, const Vec3& axis, path::MoveKind kind, double feed) {
    out_.push_back({tip(centre, axis), axis, kind == path::MoveKind::rapid ? 0.0 : feed, kind, o_.zone, pass_});
  }

  void approach(const Vec3& start, const Vec3& axis) {
    if (engaged_) {
      if (hops_to(start, axis) || returns_to(start, axis)) return;
      leave();
    }
    const Vec3 high = above(start, axis);
    if (engaged_) around(high, axis);
    add(high, axis, path::MoveKind::rapid, 0);
    if ((high - start).norm() > o_.slow_mm)
      add(start + o_.slow_mm * axis, axis, path::MoveKind::engage, o_.link_feed_mm_min);
    add(start, axis, path::MoveKind::engage, o_.feed_mm_min);
  }

  /// Rapids towards a place above the clearance height, so short that none dips below it by much where it is round.
  void around(const Vec3& to, const Vec3& axis) {
    if (o_.clearance.flat()) return;
    const Vec3 from = above(last_, last_axis_);
    const int steps = path::pieces_about_axis(from, to, o_.most_dip_mm);
    for (int k = 1; k < steps; ++k) {
      const double t = double(k) / steps;
      const Vec3 way = from + t * (to - from), a = blended(axis, t);
      add(above(way, a), a, path::MoveKind::rapid, 0);
    }
  }

  /// The hop from the end of the pass before, where there is one and it is the shorter way in time.
  bool hops_to(const Vec3& start, const Vec3& axis) {
    const auto feed = hop_feed(start, axis);
    if (!feed || way(start, axis) / *feed > minutes_over_the_top(start, axis)) return false;
    add(lifted(last_, last_axis_), last_axis_, path::MoveKind::retract, o_.link_feed_mm_min);
    hop(start, axis, *feed);
    return true;
  }
  /// Back along the pass before, lifted along its axes, then a hop to a start beside its own. A tool that nowhere
  /// narrows upwards is in its own track there: nothing stands in it.
  bool returns_to(const Vec3& start, const Vec3& axis) {
    const auto& points = passes_[before_].points;
    const Vec3 end = last_, end_axis = last_axis_;
    double back = 0;
    for (std::size_t k = 1; k < points.size(); ++k) back += (points[k].centre - points[k - 1].centre).norm();
    const double top = minutes_over_the_top(start, axis);
    last_ = points.front().centre;
    last_axis_ = axis_at(before_, 0);
    const auto feed = hop_feed(start, axis);
    if (!feed || back / o_.link_feed_mm_min + way(start, axis) / *feed > top) {
      last_ = end;
      last_axis_ = end_axis;
      return false;
    }
    add(lifted(end, end_axis), end_axis, path::MoveKind::retract, o_.link_feed_mm_min);
    for (std::size_t k = points.size() - 1; k-- > 0;)
      add(lifted(points[k].centre, axis_at(before_, k)), axis_at(before_, k), path::MoveKind::engage,
          o_.link_feed_mm_min);
    hop(start, axis, *feed);
    return true;
  }
  [[nodiscard]] Vec3 axis_at(std::size_t pass, std::size_t k) const {
    return o_.axes.empty() ? o_.axis : o_.axes[pass][k];
  }
  [[nodiscard]] Vec3 lifted(const Vec3& centre, const Vec3& axis) const { return centre + o_.hop_mm * axis; }
  [[nodiscard]] double way(const Vec3& start, const Vec3& axis) const {
    return (lifted(start, axis) - lifted(last_, last_axis_)).norm();
  }
  /// Feed of a hop from where the tool is; nothing where there is none.
  [[nodiscard]] std::optional<double> hop_feed(const Vec3& start, const Vec3& axis) const {
    const Vec3 a = lifted(last_, last_axis_), b = lifted(start, axis);
    const auto clear = [&](const HopEnd& from, const HopEnd& to) { return meets_(from, to) != Meets::part; };
    if ((b - a).norm() > o_.longest_hop_mm || !clear({last_, last_axis_}, {a, last_axis_}) ||
        !clear({b, axis}, {start, axis}) || !turns_clear(a, b, axis))
      return {};
    const Meets across = meets_({a, last_axis_}, {b, axis});
    if (across == Meets::part) return {};
    return across == Meets::air ? o_.link_feed_mm_min : o_.feed_mm_min;
  }
  /// Up, aside and down again, but for what a hop takes too.
  [[nodiscard]] double minutes_over_the_top(const Vec3& start, const Vec3& axis) const {
    const Vec3 from = above(last_, last_axis_), to = above(start, axis);
    const double down = (to - start).norm(), slow = std::min(down, o_.slow_mm);
    return ((from - last_).norm() + (to - from).norm() + down - slow) / o_.link_feed_mm_min +
           (slow - o_.hop_mm) / o_.feed_mm_min;
  }

  void leave() { add(above(last_, last_axis_), last_axis_, path::MoveKind::retract, o_.link_feed_mm_min); }

  // Hops between two directions: even steps, the centre straight.
  [[nodiscard]] double turn_to(const Vec3& axis) const {
    return std::atan2(last_axis_.cross(axis).norm(), last_axis_.dot(axis));
  }
  [[nodiscard]] int steps_of(const Vec3& axis) const {
    return std::max(1, int(std::ceil(turn_to(axis) / (0.95 * kMostTurnOfHopRecord))));
  }
  [[nodiscard]] Vec3 blended(const Vec3& axis, double t) const {
    return ((1 - t) * last_axis_ + t * axis).normalized();
  }
  [[nodiscard]] bool turns_clear(const Vec3& a, const Vec3& b, const Vec3& axis) const {
    if (axis == last_axis_) return true;
    if (!bodies_are_clear_ || turn_to(axis) > kMostTurnOfHop) return false;
    const int checks = std::max(2 * steps_of(axis), int(std::ceil((b - a).norm() / 0.5)));
    for (int k = 0; k <= checks; ++k) {
      const double t = double(k) / checks;
      if (!bodies_are_clear_(a + t * (b - a), blended(axis, t))) return false;
    }
    return true;
  }
  /// Across between the lifted places, then down.
  void hop(const Vec3& start, const Vec3& axis, double feed) {
    const Vec3 a = lifted(last_, last_axis_), b = lifted(start, axis);
    const int steps = axis == last_axis_ ? 1 : steps_of(axis);
    for (int k = 1; k < steps; ++k) {
      const double t = double(k) / steps;
      add(a + t * (b - a), blended(axis, t), path::MoveKind::engage, feed);
    }
    add(b, axis, path::MoveKind::engage, feed);
    add(start, axis, path::MoveKind::engage, o_.feed_mm_min);
  }

  void feed(const BallPass::Point& from, const Vec3& from_axis, const BallPass::Point& to, const Vec3& to_axis) {
    const double way = from_axis == to_axis ? (to.centre - from.centre).norm()
                                            : (tip(to.centre, to_axis) - tip(from.centre, from_axis)).norm();
    const double contact = (to.contact - from.contact).norm();
    double speed = o_.feed_mm_min;
    if (from.touching && to.touching && contact > 0) speed *= std::min(way / contact, 1.2);
    add(to.centre, to_axis, path::MoveKind::feed, speed);
  }

  const std::vector<BallPass>& passes_;
  const LinkingOptions& o_;
  const HopMeets& meets_;
  const BodiesAreClear& bodies_are_clear_;
  std::vector<path::ClRecord>& out_;
  int pass_ = 0;
  std::size_t before_ = 0;  // index of the pass that was cut last
  bool engaged_ = false;
  Vec3 last_ = Vec3::Zero(), last_axis_ = Vec3::UnitZ();
};

}  // namespace

void link_passes(const std::vector<BallPass>& passes, const LinkingOptions& options, const HopMeets& hop_meets,
                 std::vector<path::ClRecord>& records, const BodiesAreClear& bodies_are_clear) {
  Linker(passes, options, hop_meets, bodies_are_clear, records).run();
}

}  // namespace toothpath::ball
