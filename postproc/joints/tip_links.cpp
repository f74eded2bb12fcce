// Links while TCP stays on: straight for the tip, turns with the tip standing still, all above the clearance body as it
// lies on the table, where the tool stands above its tip, because its axis points up; or beside it, where the tool lies
// farther out than its tip, because its axis points away from the gear axis.
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/joints/rollover.h"
#include "postproc/joints/tooth.h"

namespace toothpath::joints {
namespace {
constexpr double kLeastUp =
    0.1;  // of the tool axis, seen from the table: a flatter tool would hardly rise along itself
constexpr double kUpright = 1 - 1e-9;  // of the gear axis: links go beside the part
constexpr double kLeastOut = 0.3;      // of the tool axis, square to the gear axis: a steeper tool hardly goes sideways
constexpr double kLeansIn = 1e-6;      // of the tool axis towards the gear axis, while it turns beside the part
constexpr double kBesideSlack = 0.01;  // mm: of places outside the part, which words round
constexpr int kWider = 30;             // trials of a way across that keeps clear
constexpr int kLooks = 90;             // at a turn
constexpr double kBelowTip = 1;        // mm: room over the part of what reaches below the tip

/// Words of the rotaries where they stand at their zeros.
RotaryPair at_zero(const machines::KinematicChain& chain) {
  RotaryPair zero{};
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) zero[k] = chain.rotary(k).zero_rad;
  return zero;
}
}  // namespace

double ToothBuilder::room_over_part(double up) const {
  const Vec3 axis(std::sqrt(std::max(0.0, 1 - up * up)), 0, up);
  double room = job_.options.clearance_margin_mm;
  for (const tool::RoundedFrustum& body : tool_.cutting)
    room = std::max(room, kBelowTip - tool::lowest_z(body, Vec3::Zero(), axis));
  for (const tool::Frustum& body : tool_.bodies)
    room = std::max(room, kBelowTip - tool::lowest_z(body, Vec3::Zero(), axis));
  return room;
}

double ToothBuilder::link_height(const RotaryPair& from, const RotaryPair& to) const {
  double least_up = 1;
  for (int k = 0; k <= kLooks; ++k) {
    machines::Joints j;
    for (std::size_t n = 0; n < 2; ++n) j.rotary_rad[n] = from[n] + double(k) / kLooks * (to[n] - from[n]);
    least_up = std::min(least_up, chain_.forward(j, words_.length()).axis.z());
    if (from == to) break;
  }
  return body_top(chain_, job_.gear, job_.body, at_zero(chain_)) + room_over_part(least_up);
}

/// Zero, of a rotary that rolls over the nearest whole turn.
RotaryPair ToothBuilder::zero_rotaries() const {
  std::vector<RotaryPair> zero = {at_zero(chain_)};
  roll_to(chain_, words_.joints(last_).rotary_rad, zero);
  return zero.front();
}

/// Z at its top, rotaries at zero, the tip over the gear axis or over a place beside the part, TCP on in the block that
/// lowers Z. From over the gear axis the tool leans to its `first` position there, beside the part it has room.
void ToothBuilder::start_at_zero(const Vec3& over, const RotaryPair& first) {
  const RotaryPair zero = zero_rotaries();
  const double top = link_height(zero, beside_ ? zero : first);
  if (top > retract_height() + 1e-9) return too_low(top);
  last_.words[2] = words_.joint_word(program_.retract_z_mm, 2, last_);
  last_.tip = false;
  const double swept = tip_height_for_turn(zero);
  if (swept > retract_height() + 1e-9) return too_low(swept);
  const Vec3 up = job_.gear.rotation.col(2);
  Vec3 start = over;
  if (!beside_ && std::abs(up.z()) > 0.5) start += up * ((top - start.z()) / up.z());
  start.z() = top;
  const machines::Joints j = chain_.linear_for(start, zero, words_.length());
  AxisBlock b = last_;
  b.record = -1;
  b.kind = BlockKind::rapid_rotary;
  for (std::size_t k = 0; k < 2; ++k) b.words[3 + k] = words_.rotary_word(zero[k]);
  if (chain_.rotary_count() > 0) push_rotaries(b, true);
  b.kind = BlockKind::rapid_xy;
  for (int i = 0; i < 2; ++i) b.words[static_cast<std::size_t>(i)] = words_.joint_word(j.linear_mm[i], i, b);
  push_rapid(b, true);
  b.kind = BlockKind::tcp_on;
  words_.set_tip(b, start, zero);
  push_rapid(b, true);
  at_retract_ = start_of_tooth_ = false;
  tcp_ = true;
}

/// Of a tool that stands flatter somewhere no link goes over the part: they go beside it, where the gear stands
/// upright.
bool ToothBuilder::comes_from_the_side(const FollowedPath& path, const Mat3& rotation) const {
  if (std::abs(job_.gear.rotation.col(2).z()) < kUpright) return false;
  return std::any_of(path.path().records.begin(), path.path().records.end(),
                     [&](const path::ClRecord& r) { return (rotation * r.axis).z() < kLeastUp; });
}

bool ToothBuilder::lies_down(const Vec3& axis) {
  if (axis.z() >= kLeastUp) return false;
  error_ = fail(
      "operation {} record {} (tooth {}): the tool axis rises by {:.3f} only, seen from the table, and links with TCP "
      "over a part that leans need {:.1f} at least; set the gear axis upright on the table, or write tcp = \"none\" in "
      "a copy of the machine file beside the job, and its name under [machine]",
      operation_->operation, record_, tooth_, axis.z(), kLeastUp);
  return true;
}

double ToothBuilder::from_gear_axis(const Vec3& p) const {
  return (p - job_.gear.origin).cross(job_.gear.rotation.col(2)).norm();
}

double ToothBuilder::beside_radius() const { return job_.body.radius_mm + job_.options.clearance_margin_mm; }

/// The place on the way out along the tool axis at a distance from the gear axis, or where the tip stands if that is
/// farther out.
std::optional<Vec3> ToothBuilder::beside(const Vec3& tip, const Vec3& axis, double radius) {
  const Vec3 up = job_.gear.rotation.col(2), from = tip - job_.gear.origin;
  const Vec3 p = from - from.dot(up) * up, a = axis - axis.dot(up) * up;
  const double aa = a.squaredNorm(), pa = p.dot(a), lack = radius * radius - p.squaredNorm();
  if (!(aa >= kLeastOut * kLeastOut)) {
    error_ = fail(
        "operation {} record {} (tooth {}): the tool axis leaves the gear axis sideways by {:.3f} only, and others of "
        "this tooth come in from the side: links with TCP then go out beside the part and need {:.1f} at least; cut "
        "the steep and the flat directions by operations of their own",
        operation_->operation, record_, tooth_, std::sqrt(aa), kLeastOut);
    return {};
  }
  if (lack <= 0 && pa >= 0) return tip;
  const double out = (-pa + std::sqrt(std::max(0.0, pa * pa + aa * lack))) / aa;
  return Vec3(tip + std::max(0.0, out) * axis);
}

/// The tip stands still beside the part, while the tool never leans over it.
void ToothBuilder::push_turn_beside(const RotaryPair& rotaries) {
  const RotaryPair from = words_.joints(last_).rotary_rad;
  const Vec3 up = job_.gear.rotation.col(2), tip = words_.tip(last_), at = tip - job_.gear.origin,
             outwards = (at - at.dot(up) * up).normalized();
  for (int k = 0; k <= kLooks; ++k) {
    const double t = double(k) / kLooks;
    machines::Joints j;
    for (std::size_t n = 0; n < 2; ++n) j.rotary_rad[n] = from[n] + t * (rotaries[n] - from[n]);
    const double leans = chain_.forward(j, words_.length()).axis.dot(outwards);
    if (leans > -kLeansIn) continue;
    error_ = fail(
        "operation {} record {} (tooth {}): while the rotaries turn beside the part the tool leans over it, its axis "
        "by {:.3f} towards the gear axis, limit {:g}: another tool direction, or tcp = \"none\" in a copy of the "
        "machine file beside the job, and its name under [machine]",
        operation_->operation, record_, tooth_, -leans, kLeansIn);
    return;
  }
  push_turn(rotaries);
}

std::optional<RotaryPair> ToothBuilder::one_upright(const RotaryPair& from, const RotaryPair& to) const {
  for (const std::size_t n : {0U, 1U}) {
    machines::Joints j;
    j.rotary_rad = from;
    j.rotary_rad[n] = to[n];
    if (j.rotary_rad != from && chain_.forward(j, words_.length()).axis.z() > 1 - 1e-9) return j.rotary_rad;
  }
  return {};
}

/// The tool rises beside the part to the height of links over it and stands up there. A text of tips and tool vectors,
/// about a part that stands still, says nothing of the top of Z and goes on from here straight to where the next tooth
/// starts.
void ToothBuilder::rise_beside() {
  const RotaryPair zero = zero_rotaries();
  Vec3 above = words_.tip(last_);
  above.z() = link_height(zero, zero);
  push_tip(above);
  push_turn_beside(one_upright(words_.joints(last_).rotary_rad, zero).value_or(zero));
}

/// Out along the tool axis to beside the part, turn there, across, and in along the tool axis. The first link comes
/// from above: of an upright tool the rotary that turns the gear about its axis goes first, then the tool swings out.
void ToothBuilder::link_beside(const machines::TablePose& target, const RotaryPair& rotaries) {
  const bool first = last_.kind == BlockKind::tcp_on;
  const Vec3 now = words_.tip(last_), axis = chain_.forward(words_.joints(last_), words_.length()).axis;
  std::optional<Vec3> out = now, in;
  double radius = beside_radius();
  for (int k = 0; k < kWider; ++k) {
    if (!first) out = beside(now, axis, radius);
    in = beside(target.tip_mm, target.axis, radius);
    if (!out || !in) return;
    // The way across, seen along the gear axis.
    const Vec3 way = *in - *out, up = job_.gear.rotation.col(2), flat = way - way.dot(up) * up,
               from = *out - job_.gear.origin;
    const double length2 = flat.squaredNorm(), t = length2 > 0 ? std::clamp(-from.dot(flat) / length2, 0.0, 1.0) : 0;
    const double least = from_gear_axis(*out + t * way);
    if (least >= beside_radius() - kBesideSlack) break;
    if (k + 1 == kWider || !(least > 0.1 * beside_radius())) {
      error_ = fail(
          "operation {} record {} (tooth {}): the way from pass to pass beside the part comes as near as {:.3f} mm to "
          "the gear axis, limit {:.3f} mm: passes of one tooth must lie on one side of the part",
          operation_->operation, record_, tooth_, least, beside_radius());
      return;
    }
    radius *= 1.0001 * beside_radius() / least;
  }
  if (!first) push_tip(*out);
  const RotaryPair from = words_.joints(last_).rotary_rad;
  if (from != rotaries) {
    if (const auto upright = first ? one_upright(from, rotaries) : std::nullopt) push_turn_beside(*upright);
    if (!error_ && words_.joints(last_).rotary_rad != rotaries) push_turn_beside(rotaries);
  }
  if (error_) return;
  push_tip(*in);
  push_tip(target.tip_mm);
  blocks_->back().record = record_;
  broken_ = true;
}

void ToothBuilder::tip_link_to(const machines::TablePose& target, const RotaryPair& rotaries) {
  if (error_) return;
  AxisBlock goal = last_;
  words_.set_tip(goal, target.tip_mm, rotaries);
  if (goal.words == last_.words) return;
  if (beside_) link_beside(target, rotaries);
  else link_over(target, rotaries);
}

void ToothBuilder::link_over(const machines::TablePose& target, const RotaryPair& rotaries) {
  AxisBlock goal = last_;
  words_.set_tip(goal, target.tip_mm, rotaries);
  if (lies_down(target.axis)) return;
  rise_along_tool(link_height(words_.joints(last_).rotary_rad, rotaries));
  if (error_) return;
  if (goal.words[3] != last_.words[3] || goal.words[4] != last_.words[4]) push_turn(rotaries);
  const double height = words_.tip(last_).z();
  if (target.tip_mm.z() < height) {
    Vec3 above = target.tip_mm + target.axis * ((height - target.tip_mm.z()) / target.axis.z());
    above.z() = height;
    push_tip(above);
  }
  push_tip(target.tip_mm);
  blocks_->back().record = record_;
  broken_ = true;
}

void ToothBuilder::rise_along_tool(double height) {
  const Vec3 tip = words_.tip(last_);
  if (tip.z() >= height - 1e-9) return;
  const Vec3 axis = chain_.forward(words_.joints(last_), words_.length()).axis;
  if (lies_down(axis)) return;
  Vec3 above = tip + axis * ((height - tip.z()) / axis.z());
  above.z() = height;
  push_tip(above);
}

void ToothBuilder::leave_to_top() {
  end_on_angles();
  if (beside_) {
    const auto out =
        beside(words_.tip(last_), chain_.forward(words_.joints(last_), words_.length()).axis, beside_radius());
    if (out) push_tip(*out);
    if (!error_ && job_.options.cutter_locations) rise_beside();
  } else {
    // Cutter locations go on from here straight to where the next tooth starts, upright.
    const RotaryPair stands = words_.joints(last_).rotary_rad;
    rise_along_tool(link_height(stands, job_.options.cutter_locations ? zero_rotaries() : stands));
  }
  if (error_) return;
  AxisBlock b;
  const machines::Joints j = words_.joints(last_);
  words_.set_joints(b, j.linear_mm, j.rotary_rad);
  b.words[2] = words_.joint_word(program_.retract_z_mm, 2, b);
  b.kind = BlockKind::tcp_off;
  push_rapid(b, true);
  tcp_ = false;
  at_retract_ = true;
  broken_ = true;
}

void ToothBuilder::push_tip(const Vec3& tip) {
  AxisBlock b = last_;
  words_.set_tip(b, tip, words_.joints(last_).rotary_rad);
  b.kind = BlockKind::rapid_tip;
  b.record = -1;
  b.forced = true;
  if (b.words == last_.words) return;
  const AxisBlock from = last_;
  b.axis = chain_.forward(words_.joints(b), words_.length()).axis;
  push(b);
  const TipTimes times = follow_tip(from, b);
  blocks_->back().minutes = std::max(times.linear, times.rotary);
  operation_->rapid_minutes += blocks_->back().minutes * copies();
}

void ToothBuilder::push_turn(const RotaryPair& rotaries) {
  AxisBlock to = last_;
  words_.set_tip(to, words_.tip(last_), rotaries);
  for (const AxisBlock& part : blocks_of_turn(chain_, words_, words_.joints(last_).rotary_rad, to))
    push_turn_block({words_.word_angle(part.words[3]), words_.word_angle(part.words[4])});
}

/// The control takes F in deg/min where nothing linear is named; the time is that of the slowest joint that it drags
/// along.
void ToothBuilder::push_turn_block(const RotaryPair& rotaries) {
  AxisBlock b = last_;
  words_.set_tip(b, words_.tip(last_), rotaries);
  b.kind = BlockKind::turn;
  b.record = -1;
  b.forced = true;
  const AxisBlock from = last_;
  b.axis = chain_.forward(words_.joints(b), words_.length()).axis;
  push(b);
  const TipTimes times = follow_tip(from, b);
  const machines::Joints p = words_.joints(from), q = words_.joints(b);
  const double turned = degrees(std::hypot(q.rotary_rad[0] - p.rotary_rad[0], q.rotary_rad[1] - p.rotary_rad[1]));
  AxisBlock& pushed = blocks_->back();
  pushed.minutes = std::max({times.linear, times.rotary, job_.machine.min_block_ms / 60000, turn_minutes(turned)});
  pushed.per_minute = turned / pushed.minutes;
  last_ = pushed;
  operation_->rapid_minutes += pushed.minutes * copies();
}

}  // namespace toothpath::joints
