// Blocks of the cut: subdivision of the non-linear error, proven bounds, block times.
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/joints/tooth.h"

namespace toothpath::joints {
namespace {

constexpr int kDeepestSplit = 12;  // halvings of one CL step

Vec3 slerp(const Vec3& a, const Vec3& b, double t) {
  const double angle = std::atan2(a.cross(b).norm(), a.dot(b));
  if (angle < 1e-9) return ((1 - t) * a + t * b).normalized();
  return (std::sin((1 - t) * angle) * a + std::sin(t * angle) * b) / std::sin(angle);
}

}  // namespace

void ToothBuilder::feed_to(const machines::TablePose& from, const RotaryPair& from_angles,
                           const machines::TablePose& to, const RotaryPair& to_angles, double feed, int depth) {
  if (error_) return;
  const AxisOptions& options = job_.options;
  const RotaryPair a = words_.rounded(from_angles), b = words_.rounded(to_angles);
  const double length = words_.length();
  const machines::Joints ja = chain_.linear_for(from.tip_mm, a, length), jb = chain_.linear_for(to.tip_mm, b, length);
  double tip_error = 0, axis_error = 0;
  if (a != b) {
    for (const double t : {0.25, 0.5, 0.75}) {
      machines::Joints j;
      j.linear_mm = (1 - t) * ja.linear_mm + t * jb.linear_mm;
      for (std::size_t k = 0; k < 2; ++k) j.rotary_rad[k] = (1 - t) * a[k] + t * b[k];
      const machines::TablePose p = chain_.forward(j, length);
      const Vec3 chord = (1 - t) * from.tip_mm + t * to.tip_mm;
      if (cone_ball_) {  // the centre of the ball goes straight, the tool turns about it
        const Vec3 centre = chord + *cone_ball_ * ((1 - t) * from.axis + t * to.axis), tip = tcp_ ? chord : p.tip_mm;
        tip_error = std::max(tip_error, (tip + *cone_ball_ * p.axis - centre).norm());
      } else if (!tcp_) {
        tip_error = std::max(tip_error, (p.tip_mm - chord).norm());
      }
      axis_error = std::max(axis_error, angle_between(p.axis, slerp(from.axis, to.axis, t)));
    }
  }
  if (tip_error <= options.chord_mm && axis_error <= options.axis_rad + words_.rotary_step()) {
    if (a != b) note_bounds(ja, jb, from, to, axis_error);
    push_feed(to, b, feed);
    return;
  }
  if (depth >= kDeepestSplit) {
    error_ = fail(
        "operation {} record {} (tooth {}): after {} halvings the tip still leaves the chord by {:.6f} mm (limit "
        "{:.6f}), the axis by {:.6f} deg (limit {:.6f})",
        operation_->operation, record_, tooth_, depth, tip_error, options.chord_mm, degrees(axis_error),
        degrees(options.axis_rad));
    return;
  }
  const auto middle = middle_of(from, from_angles, to, to_angles);
  if (!middle) return;
  ++program_.inserted_blocks;
  feed_to(from, from_angles, middle->pose, middle->angles, feed, depth + 1);
  feed_to(middle->pose, middle->angles, to, to_angles, feed, depth + 1);
}

/// The mean of the commands keeps a fixed tilt fixed; where its axis is too far from the great circle, the inverse of
/// that. In the cone about a pole the commands rule and the axis follows from them.
std::optional<ToothBuilder::Middle> ToothBuilder::middle_of(const machines::TablePose& from,
                                                            const RotaryPair& from_angles,
                                                            const machines::TablePose& to,
                                                            const RotaryPair& to_angles) {
  Middle m{{0.5 * (from.tip_mm + to.tip_mm), slerp(from.axis, to.axis, 0.5)},
           {0.5 * (from_angles[0] + to_angles[0]), 0.5 * (from_angles[1] + to_angles[1])}};
  const Vec3 mean_axis = chain_.forward(machines::Joints{Vec3::Zero(), m.angles}, words_.length()).axis;
  if (cone_ball_) {
    m.pose.tip_mm += *cone_ball_ * (0.5 * (from.axis + to.axis) - mean_axis);
    m.pose.axis = mean_axis;
  } else if (angle_between(mean_axis, m.pose.axis) <= 0.5 * job_.options.axis_rad) {
    m.pose.axis = mean_axis;
  } else {
    const auto angles = angles_between(m.pose.axis, from_angles, to_angles);
    if (!angles) return std::nullopt;
    m.angles = *angles;
  }
  return m;
}

/// The solution for an axis in the middle of a step, on the branch of its ends.
std::optional<RotaryPair> ToothBuilder::angles_between(const Vec3& axis, const RotaryPair& a, const RotaryPair& b) {
  const auto list = chain_.rotary_solutions(axis);
  if (!list) {
    error_ = fail("operation {} record {}: {}", operation_->operation, record_, list.error().message);
    return std::nullopt;
  }
  std::optional<RotaryPair> best;
  double best_distance = 0;
  for (const auto& s : *list) {
    RotaryPair angles{};
    double distance = 0;
    for (std::size_t k = 0; k < chain_.rotary_count(); ++k) {
      const double middle = 0.5 * (a[k] + b[k]);
      angles[k] = s.free_rotary == static_cast<int>(k) ? middle : choice::nearest_turn(s.joints.rotary_rad[k], middle);
      distance = std::max(distance, std::abs(angles[k] - middle));
    }
    if (!best || distance < best_distance) {
      best = angles;
      best_distance = distance;
    }
  }
  return best;
}

/// Section 3 of the derivation: |p''| / 8 with w the sum of the turns and R the greatest distance of the tip from a
/// rotary axis. With TCP the control keeps the tip on the chord, and only the axis has a bound.
void ToothBuilder::note_bounds(const machines::Joints& a, const machines::Joints& b, const machines::TablePose& from,
                               const machines::TablePose& to, double axis_error) {
  const double w = std::abs(b.rotary_rad[0] - a.rotary_rad[0]) + std::abs(b.rotary_rad[1] - a.rotary_rad[1]);
  program_.axis_bound_rad =
      std::max({program_.axis_bound_rad, axis_error, std::min(w * w / 4, job_.options.axis_rad * 2)});
  if (tcp_) return;
  const double dx = (b.linear_mm - a.linear_mm).norm();
  double reach = 0;
  for (std::size_t k = 0; k < chain_.table.size(); ++k) {
    const machines::RotaryAxis& axis = chain_.table[k];
    for (const auto& [pose, j] : {std::pair<const machines::TablePose&, const machines::Joints&>(from, a), {to, b}}) {
      const Vec3 p = k == 0 ? pose.tip_mm : chain_.table_to_machine(pose.tip_mm, j.rotary_rad);
      reach = std::max(reach, (p - axis.point_mm).cross(axis.direction).norm());
    }
  }
  double arm = words_.length();
  for (const auto& axis : chain_.head) arm += 2 * axis.point_mm.norm();
  if (!chain_.head.empty()) reach = std::max(reach, arm);
  program_.tip_reach_mm = std::max(program_.tip_reach_mm, reach);
  reach += 0.5 * (dx + w * reach);
  program_.chord_bound_mm = std::max(program_.chord_bound_mm, (w * w * reach + 2 * w * dx) / 8);
}

void ToothBuilder::push_feed(const machines::TablePose& target, const RotaryPair& rotaries, double feed) {
  AxisBlock b;
  b.kind = BlockKind::feed;
  if (tcp_) words_.set_tip(b, target.tip_mm, rotaries);
  else words_.set_joints(b, chain_.linear_for(target.tip_mm, rotaries, words_.length()).linear_mm, rotaries);
  b.record = record_;
  b.forced = broken_;
  if (b.words == last_.words) {
    ++program_.dropped_blocks;
    if (!blocks_->empty() && blocks_->back().kind == BlockKind::feed) blocks_->back().record = record_;
    return;
  }
  const AxisBlock before = last_;
  push(b);
  AxisBlock& pushed = blocks_->back();
  set_time(pushed, before, feed);
  if (error_) return;
  // A tool vector needs no rounding of angles; where the axis follows from the commands (about a pole) it is theirs.
  if (tcp_ && angle_between(pushed.axis, target.axis) <= 2 * words_.rotary_step()) pushed.axis = target.axis;
  const machines::Joints from = words_.joints(before), to = words_.joints(b);
  int moving = 0;
  for (int i = 0; i < 3; ++i) moving += std::abs(to.linear_mm[i] - from.linear_mm[i]) > 1e-9 ? 1 : 0;
  for (std::size_t k = 0; k < 2; ++k) moving += to.rotary_rad[k] != from.rotary_rad[k] ? 1 : 0;
  const int together = job_.machine.max_simultaneous_axes;
  if (together > 0 && moving > together) {
    error_ = fail(
        "operation {} record {}: {} axes move in one block, the control interpolates {} (keep the tilt fixed in a "
        "pass)",
        operation_->operation, record_, moving, together);
    return;
  }
  operation_->feed_minutes += pushed.minutes * copies();
  last_ = pushed;
  broken_ = false;
}

/// The greatest F that a control takes has no unit: turns of so many deg keep it in deg/min.
double ToothBuilder::turn_minutes(double turned_deg) const {
  return job_.machine.max_cutting_feed > 0 ? turned_deg / job_.machine.max_cutting_feed : 0;
}

/// Time of a block that was pushed behind `before`: the longest of what feed, axes and control ask for. With TCP its
/// feed word and axis too.
void ToothBuilder::set_time(AxisBlock& pushed, const AxisBlock& before, double feed) {
  const AxisBlock b = pushed;
  const machines::Joints from = words_.joints(before), to = words_.joints(b);
  const double tip_path = (words_.tip(b) - words_.tip(before)).norm(),
               turned =
                   degrees(std::hypot(to.rotary_rad[0] - from.rotary_rad[0], to.rotary_rad[1] - from.rotary_rad[1]));
  const bool stands = b.words[0] == before.words[0] && b.words[1] == before.words[1] && b.words[2] == before.words[2];
  const machines::Machine& machine = job_.machine;
  double times[kTimeTerms] = {tip_path / feed,
                              tcp_ && stands                 ? turn_minutes(turned)
                              : machine.max_cutting_feed > 0 ? tip_path / machine.max_cutting_feed
                                                             : 0,
                              0,
                              0,
                              machine.min_block_ms / 60000,
                              !tcp_ && job_.options.max_inverse_time > 0 ? 1 / job_.options.max_inverse_time : 0};
  if (tcp_) {
    const TipTimes tip = follow_tip(before, b);
    times[kLinearSpeed] = tip.linear;
    times[kRotarySpeed] = tip.rotary;
  } else {
    times[kLinearSpeed] = linear_time(from, to);
    times[kRotarySpeed] = rotary_time(from, to);
    note_position(to);
  }
  const auto ruler = std::max_element(times, times + kTimeTerms) - times;
  ++program_.time_ruled[static_cast<std::size_t>(ruler)];
  pushed.ruler = static_cast<std::uint8_t>(ruler);
  pushed.minutes = times[ruler];
  if (!(pushed.minutes > 0)) {
    error_ = fail("operation {} record {}: a block takes no time", operation_->operation, record_);
    return;
  }
  if (!tcp_) return;
  pushed.per_minute = (stands ? turned : tip_path) / pushed.minutes;
  pushed.axis = chain_.forward(to, words_.length()).axis;
}

}  // namespace toothpath::joints
