// Links while TCP stays on: straight for the tip, turns with the tip standing still, all above the clearance body as it
// lies on the table. The tool stands above its tip there, because its axis points up.
#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/joints/rollover.h"
#include "postproc/joints/tooth.h"

namespace toothpath::joints {
namespace {
constexpr double kLeastUp =
    0.1;  // of the tool axis, seen from the table: a flatter tool would hardly rise along itself

/// Words of the rotaries where they stand at their zeros.
RotaryPair at_zero(const machines::KinematicChain& chain) {
  RotaryPair zero{};
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) zero[k] = chain.rotary(k).zero_rad;
  return zero;
}
}  // namespace

/// Height over the part, table frame.
double ToothBuilder::link_height() const {
  return body_top(chain_, job_.gear, job_.body, at_zero(chain_)) + job_.options.clearance_margin_mm;
}

/// Zero, of a rotary that rolls over the nearest whole turn.
RotaryPair ToothBuilder::zero_rotaries() const {
  std::vector<RotaryPair> zero = {at_zero(chain_)};
  roll_to(chain_, words_.joints(last_).rotary_rad, zero);
  return zero.front();
}

/// Z at its top, rotaries at zero, the tip over the gear axis, TCP on in the block that lowers Z.
void ToothBuilder::start_at_zero() {
  const double top = link_height();
  if (top > retract_height() + 1e-9) return too_low(top);
  last_.words[2] = words_.joint_word(program_.retract_z_mm, 2, last_);
  last_.tip = false;
  const RotaryPair zero = zero_rotaries();
  const double swept = tip_height_for_turn(zero);
  if (swept > retract_height() + 1e-9) return too_low(swept);
  const Vec3 up = job_.gear.rotation.col(2);
  Vec3 start = job_.gear.origin;
  if (std::abs(up.z()) > 0.5) start += up * ((top - start.z()) / up.z());
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

/// Links with TCP go over the part: a tool that comes in from the side does not.
bool ToothBuilder::lies_down(const Vec3& axis) {
  if (axis.z() >= kLeastUp) return false;
  error_ = fail(
      "operation {} record {} (tooth {}): the tool axis rises by {:.3f} only, seen from the table, and links with TCP "
      "need {:.1f} at least; where the tool comes in from the side write tcp = \"none\" in a copy of the machine file "
      "beside the job, and its name under [machine]: the program then carries the axes of the machine, and its links "
      "need no such axis",
      operation_->operation, record_, tooth_, axis.z(), kLeastUp);
  return true;
}

void ToothBuilder::tip_link_to(const machines::TablePose& target, const RotaryPair& rotaries) {
  if (error_) return;
  AxisBlock goal = last_;
  words_.set_tip(goal, target.tip_mm, rotaries);
  if (goal.words == last_.words) return;
  if (lies_down(target.axis)) return;
  rise_along_tool();
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

void ToothBuilder::rise_along_tool() {
  const double height = link_height();
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
  rise_along_tool();
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
  pushed.minutes = std::max({times.linear, times.rotary, job_.machine.min_block_ms / 60000});
  pushed.per_minute = turned / pushed.minutes;
  last_ = pushed;
  operation_->rapid_minutes += pushed.minutes * copies();
}

}  // namespace toothpath::joints
