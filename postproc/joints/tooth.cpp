#include "postproc/joints/tooth.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::joints {
namespace {
constexpr double kTipStep =
    radians(0.5);  // a block whose tip goes straight is curved in the joints: followed in such steps
}

ToothBuilder::ToothBuilder(const AxisJob& job, AxisProgram& program, TravelRecord& travel, const Vec3& work_offset_mm)
    : job_(job),
      chain_(job.machine.chain),
      program_(program),
      travel_(travel),
      words_(chain_, program.format, work_offset_mm) {
  words_.set_planes(program.planes);
}

void ToothBuilder::begin(AxisOperation& operation, const tool::ToolAssembly& tool) {
  operation_ = &operation;
  tool_ = tool::proof_tool(tool);
  words_.set_length(tool.length_mm);
  last_.tip = false;
  at_retract_ = true;  // the rotaries stay, Z is at its top; before the first operation they stand at zero
}

void ToothBuilder::tooth(const FollowedPath& followed, const RotaryPair& next_start, int k, const Mat3& rotation,
                         std::vector<AxisBlock>& blocks) {
  const path::ClPath& path = followed.path();
  const auto& angles = followed.angles;
  blocks_ = &blocks;
  tooth_ = k;
  const auto pose = [&](std::size_t i) {
    return machines::TablePose{rotation * path.records[i].tip + job_.gear.origin, rotation * path.records[i].axis};
  };
  const bool stays_in_tcp = this->stays_in_tcp();
  start_of_tooth_ = true;
  if (stays_in_tcp && !path.records.empty()) {
    beside_ = comes_from_the_side(followed, rotation);
    Vec3 over = job_.gear.origin;
    if (const auto place = beside_ ? beside(pose(0).tip_mm, pose(0).axis, beside_radius()) : std::nullopt)
      over = *place;
    if (error_) return;
    start_at_zero(over, words_.rounded(angles.front()));
  }
  for (std::size_t i = 0; i < path.records.size() && !error_; ++i) {
    record_ = followed.record(i);
    if (path.records[i].kind == path::MoveKind::rapid) {
      if (stays_in_tcp) tip_link_to(pose(i), words_.rounded(angles[i]));
      else rapid_to(pose(i), words_.rounded(angles[i]));
    } else {
      if (program_.tcp != machines::TcpMode::none && !tcp_) tcp_on();
      cone_ball_ = followed.in_cone(i) ? std::optional(followed.ball_radius_mm) : std::nullopt;
      feed_to(pose(i - 1), angles[i - 1], pose(i), angles[i], path.records[i].feed_mm_min, 0);
    }
  }
  if (error_) return;
  if (stays_in_tcp) return leave_to_top();
  if (tcp_) tcp_off();
  // Ready to be turned to where the next tooth begins.
  rise_to(tip_height_for_turn(words_.rounded(next_start)));
}

RotaryPair ToothBuilder::start_rotaries() const {
  return stays_in_tcp() ? zero_rotaries() : words_.joints(last_).rotary_rad;
}

void ToothBuilder::take_over(const std::vector<AxisBlock>& blocks, int k) {
  tooth_ = k;
  bool set = false;  // before its first X Y block a tooth stands where the one before left it
  for (const auto& b : blocks) {
    set = set || b.kind == BlockKind::rapid_xy;
    operation_->feed_minutes += b.kind == BlockKind::feed ? b.minutes : 0;
    operation_->rapid_minutes += b.kind == BlockKind::feed ? 0 : b.minutes;
    record_ = b.record;
    last_ = b;
    if (set) note_position(words_.joints(b));
  }
}

void ToothBuilder::push(AxisBlock b) {
  blocks_->push_back(b);
  last_ = b;
}

double ToothBuilder::linear_time(const machines::Joints& a, const machines::Joints& b) const {
  double t = 0;
  for (int i = 0; i < 3; ++i)
    t = std::max(t, std::abs(b.linear_mm[i] - a.linear_mm[i]) / chain_.linear[static_cast<std::size_t>(i)].max_speed);
  return t;
}

double ToothBuilder::rotary_time(const machines::Joints& a, const machines::Joints& b) const {
  double t = 0;
  for (std::size_t k = 0; k < chain_.rotary_count(); ++k)
    t = std::max(t, std::abs(b.rotary_rad[k] - a.rotary_rad[k]) / chain_.rotary(k).max_speed);
  return t;
}

void ToothBuilder::note_position(const machines::Joints& j) {
  const bool at_top =
      last_.kind != BlockKind::feed && !last_.tip && last_.words[2] == words_.top_word(program_.retract_z_mm, last_);
  // Where the rotaries turn, X Y Z stand where the pose before left them: that one moves with the part.
  const bool turns = last_.kind == BlockKind::rapid_rotary;
  travel_.note(j, !at_top && !turns, operation_->operation, record_, tooth_, chain_, job_.machine.limit_margin);
}

ToothBuilder::TipTimes ToothBuilder::follow_tip(const AxisBlock& from, const AxisBlock& to) {
  const machines::Joints a = words_.joints(from), b = words_.joints(to);
  const Vec3 p = words_.tip(from), q = words_.tip(to);
  const double w = std::abs(b.rotary_rad[0] - a.rotary_rad[0]) + std::abs(b.rotary_rad[1] - a.rotary_rad[1]);
  const int n = w == 0 ? 1 : std::max(4, static_cast<int>(std::ceil(w / kTipStep)));
  TipTimes times;
  times.rotary = rotary_time(a, b);
  machines::Joints before = a;
  for (int i = 1; i <= n; ++i) {
    const double t = static_cast<double>(i) / n;
    RotaryPair angles{};
    for (std::size_t k = 0; k < 2; ++k) angles[k] = (1 - t) * a.rotary_rad[k] + t * b.rotary_rad[k];
    const machines::Joints j = chain_.linear_for((1 - t) * p + t * q, angles, words_.length());
    times.linear = std::max(times.linear, n * linear_time(before, j));  // the quickest piece rules
    note_position(j);
    before = j;
  }
  return times;
}

}  // namespace toothpath::joints
