// Links in the joints: rapids of one group of axes each, above the clearance body; TCP is off.
#include <algorithm>
#include <cmath>

#include "postproc/joints/rollover.h"
#include "postproc/joints/tooth.h"

namespace toothpath::joints {

/// Machine Z of the tip.
double ToothBuilder::height_of(const AxisBlock& b) const {
  return chain_.table_to_machine(words_.tip(b), words_.joints(b).rotary_rad).z();
}

/// Tip height from which the rotaries may go to `to`. With a swinging head that is only the top of Z.
double ToothBuilder::tip_height_for_turn(const RotaryPair& to) const {
  const RotaryPair from = words_.joints(last_).rotary_rad;
  const double margin = job_.options.clearance_margin_mm;
  if (from == to && !program_.loop) return body_top(chain_, job_.gear, job_.body, to) + margin;
  if (!chain_.head.empty() && from[1] != to[1]) return retract_height();
  return std::max(swept_top(chain_, job_.gear, job_.body, from, to, job_.coincident),
                  body_top(chain_, job_.gear, job_.body, to)) +
         margin;
}

void ToothBuilder::rapid_to(const machines::TablePose& target, const RotaryPair& rotaries) {
  if (tcp_) tcp_off();
  AxisBlock goal;
  const machines::Joints j = chain_.linear_for(target.tip_mm, rotaries, words_.length());
  words_.set_joints(goal, j.linear_mm, rotaries);
  const double goal_height = height_of(goal);
  const bool turns = goal.words[3] != last_.words[3] || goal.words[4] != last_.words[4];
  double needed = body_top(chain_, job_.gear, job_.body, rotaries) + job_.options.clearance_margin_mm;
  needed = std::max(needed, goal_height);
  const bool first = start_of_tooth_;
  start_of_tooth_ = false;
  if (!first && goal.words == last_.words) return;
  if (first && at_retract_) {
    const double swept = turns ? tip_height_for_turn(rotaries) : needed;
    if (std::max(swept, needed) > retract_height() + 1e-9) return too_low(std::max(swept, needed));
    // Z stands at the top: the words of the axes that do not move yet.
    AxisBlock top = last_;
    top.words[2] = words_.top_word(program_.retract_z_mm, top);
    last_ = top;
    at_retract_ = false;
  } else if (turns) {
    rise_to(std::max(needed, tip_height_for_turn(rotaries)));
  } else {
    rise_to(needed);
  }
  if (error_) return;
  if (turns || first) {
    AxisBlock b = words_.turned(last_, {goal.words[3], goal.words[4]});
    b.record = -1;
    b.kind = BlockKind::rapid_rotary;
    if (chain_.rotary_count() > 0) push_rotaries(b, first || turns);
  }
  if (first || turns || goal.words[0] != last_.words[0] || goal.words[1] != last_.words[1]) {
    AxisBlock b = last_;
    b.record = -1;
    b.kind = BlockKind::rapid_xy;
    b.words[0] = goal.words[0];
    b.words[1] = goal.words[1];
    push_rapid(b, first || turns);
  }
  if (first || turns || goal.words[2] != last_.words[2]) {
    AxisBlock b = last_;
    b.kind = BlockKind::rapid_z;
    b.words[2] = goal.words[2];
    b.record = record_;
    push_rapid(b, first || turns);
  }
  broken_ = true;
}

/// Z alone, upwards only.
void ToothBuilder::rise_to(double height) {
  const double now = height_of(last_);
  if (height > retract_height() + 1e-9) return too_low(height);
  if (height <= now) return;
  AxisBlock b = last_;
  b.kind = BlockKind::rapid_z;
  const machines::Joints j = words_.joints(last_);
  b.words[2] = std::min(words_.joint_word(j.linear_mm.z() + height - now, 2, last_) + 1,
                        words_.top_word(program_.retract_z_mm, last_));
  b.record = -1;
  push_rapid(b, true);
  broken_ = true;
}

void ToothBuilder::too_low(double height) {
  lack_ = height - retract_height();
  error_ =
      fail_as(DiagnosticKind::verification,
              "operation {} record {} (tooth {}): links need the tip of T{} at {:.3f} mm above the machine zero, "
              "over all that the part sweeps while the rotaries turn, with {:.1f} mm of room; {:.3f} mm long, with "
              "Z at {:.3f}, it rises to {:.3f} only",
              operation_->operation, record_, tooth_, tool_.number, height, job_.options.clearance_margin_mm,
              words_.length(), program_.retract_z_mm, retract_height());
}

/// The rotaries, in parts where one that rolls over would go half a turn.
void ToothBuilder::push_rotaries(const AxisBlock& b, bool forced) {
  if (program_.planes) return push_rapid(b, forced);  // the control takes the nearer way to a plane by itself
  for (const AxisBlock& part : blocks_of_turn(chain_, words_, words_.joints(last_).rotary_rad, b))
    push_rapid(part, forced);
}

void ToothBuilder::push_rapid(AxisBlock b, bool forced) {
  b.forced = forced;
  const machines::Joints from = words_.joints(last_), to = words_.joints(b);
  b.minutes = std::max(linear_time(from, to), rotary_time(from, to));
  operation_->rapid_minutes += b.minutes * copies();
  push(b);
  positioned_ = positioned_ || b.kind == BlockKind::rapid_xy;
  if (positioned_) note_position(to);
}

/// Nothing moves: the same place, now as the tip. Its words are not printed, the next block names every axis.
void ToothBuilder::tcp_on() {
  AxisBlock b;
  const machines::Joints j = words_.joints(last_);
  words_.set_tip(b, chain_.forward(j, words_.length()).tip_mm, j.rotary_rad);
  b.kind = BlockKind::tcp_on;
  push(b);
  tcp_ = true;
  broken_ = true;
}

/// What follows counts from the rounded angles: the last tool vector is theirs.
void ToothBuilder::end_on_angles() {
  if (blocks_->empty() || blocks_->back().kind != BlockKind::feed) return;
  last_.axis = blocks_->back().axis = chain_.forward(words_.joints(last_), words_.length()).axis;
}

void ToothBuilder::tcp_off() {
  end_on_angles();
  AxisBlock b;
  const machines::Joints j = words_.joints(last_);
  words_.set_joints(b, j.linear_mm, j.rotary_rad);
  b.kind = BlockKind::tcp_off;
  push(b);
  tcp_ = false;
  broken_ = true;
}

}  // namespace toothpath::joints
