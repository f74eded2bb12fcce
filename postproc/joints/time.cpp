#include "postproc/joints/time.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/base/angle.h"
#include "postproc/joints/tooth_order.h"
#include "postproc/joints/words.h"
#include "postproc/timing/model_text.h"
#include "postproc/timing/path_timer.h"

namespace toothpath::joints {
namespace {

constexpr const char* kAcceleration = "acceleration";
constexpr double kRuled = 1.01;  // a feed block that takes longer than this share of its time is ruled by acceleration
constexpr double kLeastIndex = 1e-12;  // min: less is the rounding of a sum

/// Where the axes stand, and their steps from block to block.
class Walk {
 public:
  Walk(const AxisProgram& program, double tool_length_mm, const machines::Machine& machine)
      : words_(machine.chain, program.format, program.work_offset_at_mm),
        plans_words_(timing::control_of(machine, program.corners).plans_words),
        tcp_moves_z_(program.tcp_starts_at_zero) {
    words_.set_length(tool_length_mm);
    words_.set_planes(program.planes);
  }

  [[nodiscard]] machines::Joints end_of(const AxisBlock& b) const { return words_.joints(b); }
  void stand(const machines::Joints& at) {
    at_ = at;
    tip_.reset();
  }
  [[nodiscard]] const machines::Joints& at() const { return at_; }

  /// mm and deg; links move the axes of their kind alone, whatever the other words say.
  std::array<double, 5> go_to(const AxisBlock& b) {
    const machines::Joints from = at_, to = words_.joints(b);
    const bool tcp_switch = b.kind == BlockKind::tcp_on || b.kind == BlockKind::tcp_off;
    const bool z_alone = b.kind == BlockKind::rapid_z || (tcp_switch && tcp_moves_z_);
    const bool all = b.kind == BlockKind::feed || b.kind == BlockKind::rapid_tip || b.kind == BlockKind::turn;
    if (all || b.kind == BlockKind::rapid_xy) at_.linear_mm.head<2>() = to.linear_mm.head<2>();
    if (all || z_alone) at_.linear_mm.z() = to.linear_mm.z();
    if (all || b.kind == BlockKind::rapid_rotary) at_.rotary_rad = to.rotary_rad;
    Vec3 linear = at_.linear_mm - from.linear_mm;
    const std::optional<Vec3> tip_from = tip_;
    tip_.reset();
    if (b.tip) tip_ = words_.tip(b);
    if (plans_words_ && tip_ && tip_from) linear = *tip_ - *tip_from;
    return {linear.x(), linear.y(), linear.z(), degrees(at_.rotary_rad[0] - from.rotary_rad[0]),
            degrees(at_.rotary_rad[1] - from.rotary_rad[1])};
  }

 private:
  AxisWords words_;
  bool plans_words_ = false, tcp_moves_z_ = false;
  machines::Joints at_;
  std::optional<Vec3> tip_;
};

timing::PathControl control_of(const AxisProgram& program, const machines::Machine& machine) {
  timing::PathControl control = timing::control_of(machine, program.corners);
  control.tolerance_mm = program.corner_tolerance_mm;
  return control;
}
timing::PathControl control_of(const AxisProgram& program, const AxisOperation& op, const machines::Machine& machine) {
  timing::PathControl control = control_of(program, machine);
  if (op.corner_tolerance_mm > 0) control.tolerance_mm = op.corner_tolerance_mm;
  return control;
}

std::vector<double> walk(Walk& place, const std::vector<AxisBlock>& blocks, const timing::PathControl& control,
                         const machines::Machine& machine) {
  std::vector<double> times;
  times.reserve(blocks.size());
  timing::PathTimer timer(timing::limits_of(machine), control, [&times](double minutes) { times.push_back(minutes); });
  for (const AxisBlock& b : blocks) {
    // The way of a link, and so its time, depends on where the tooth before has ended.
    const bool link =
        b.kind == BlockKind::rapid_z || b.kind == BlockKind::rapid_xy || b.kind == BlockKind::rapid_rotary;
    timer.add({place.go_to(b), link ? 0 : b.minutes, b.kind != BlockKind::feed});
  }
  timer.finish();
  return times;
}

/// Of its G1, the turns of TCP among them.
double cutting_minutes(const std::vector<AxisBlock>& blocks, const std::vector<double>& times) {
  double sum = 0;
  for (std::size_t i = 0; i < times.size(); ++i)
    if (blocks[i].kind == BlockKind::feed || blocks[i].kind == BlockKind::turn) sum += times[i];
  return sum;
}

/// Z alone up to the height of tool changes, behind every operation.
double retract(machines::Joints& at, double top_mm, const timing::PathControl& control,
               const machines::Machine& machine) {
  const double way = top_mm - at.linear_mm.z();
  if (way <= 0) return 0;
  at.linear_mm.z() = top_mm;
  const timing::Block rise{{0, 0, way, 0, 0}, way / machine.chain.linear[2].max_speed, true};
  return timing::times_of(std::span(&rise, 1), timing::limits_of(machine), control).front();
}

/// What the operation's rapids hold beside those of the blocks: the turns of the index, min.
double index_minutes(const AxisOperation& op, int copies) {
  double blocks = 0;
  for (const auto& tooth : op.teeth)  // one
    for (const auto& b : tooth.blocks) blocks += b.kind == BlockKind::feed ? 0 : copies * b.minutes;
  const double index = op.rapid_minutes - blocks;
  return index > kLeastIndex ? index : 0;
}

/// Times of the blocks of one operation into `op`; `stands`: where the axes stand before and behind it.
/// @returns how many feed blocks the accelerations rule
std::size_t time_operation(AxisProgram& program, AxisOperation& op, std::optional<machines::Joints>& stands,
                           const machines::Machine& machine) {
  Walk place(program, op.tool_length_mm, machine);
  std::size_t ruled = 0;
  op.accelerated = {};
  op.tooth_minutes.clear();
  const int copies = program.loop ? op.places(program.teeth) : 1;
  const std::size_t index_rotary = program.index_axis == 4 ? 1 : 0;
  const double pitch_rad = copies > 1 ? program.index_sign * index_minutes(op, copies) / (copies - 1) *
                                            machine.chain.rotary(index_rotary).max_speed
                                      : 0;
  // In a loop the words are those of tooth 0.
  const double first_rad = program.loop ? program.index_sign * 2 * kPi / program.teeth *
                                              tooth_of_place(op.first_place, program.tooth_stride, program.teeth)
                                        : 0;
  if (stands) stands->rotary_rad[index_rotary] -= first_rad;
  std::vector<AxisBlock> room;
  for (auto& tooth : op.teeth) {
    const std::vector<AxisBlock>& blocks = tooth.all(room);
    if (blocks.empty()) continue;
    place.stand(stands ? *stands : place.end_of(blocks.front()));
    const auto first = walk(place, blocks, control_of(program, op, machine), machine);
    auto times = first;
    if (copies > 1) {
      // In a loop the other teeth begin where the one before has ended, a pitch behind.
      machines::Joints behind = place.at();
      behind.rotary_rad[index_rotary] -= pitch_rad;
      place.stand(behind);
      times = walk(place, blocks, control_of(program, op, machine), machine);
    }
    op.tooth_minutes.push_back(std::max(cutting_minutes(blocks, first), cutting_minutes(blocks, times)));
    for (std::size_t i = 0; i < times.size(); ++i) {
      const AxisBlock& b = blocks[i];
      if (tooth.packed.empty()) tooth.blocks[i].run_minutes = times[i];
      (b.kind == BlockKind::feed ? op.accelerated.feed : op.accelerated.rapid) += first[i] + (copies - 1) * times[i];
      if (b.kind != BlockKind::feed) continue;
      if (times[i] > kRuled * b.minutes) ++ruled;
      else ++program.time_ruled[b.ruler];
    }
    stands = place.at();
    stands->rotary_rad[index_rotary] += first_rad + (copies - 1) * pitch_rad;
  }
  if (stands) op.accelerated.rapid += retract(*stands, program.retract_z_mm, control_of(program, machine), machine);
  return ruled;
}

}  // namespace

std::vector<double> accelerated_times(const std::vector<AxisBlock>& blocks, const AxisBlock& start,
                                      const AxisProgram& program, double tool_length_mm,
                                      const machines::Machine& machine) {
  Walk place(program, tool_length_mm, machine);
  place.stand(place.end_of(start));
  return walk(place, blocks, control_of(program, machine), machine);
}

void estimate_times(AxisProgram& program, const machines::Machine& machine) {
  program.time_model = timing::model_text(machine, program.corners);
  if (!machine.has_acceleration()) return;
  program.has_acceleration = true;
  program.accelerated = {};
  std::size_t ruled = 0;
  std::fill(program.time_ruled.begin(), program.time_ruled.end(), std::size_t{0});
  std::optional<machines::Joints> stands;  // the first moves of the program are not known
  for (auto& op : program.operations) {
    ruled += time_operation(program, op, stands, machine);
    program.accelerated.feed += op.accelerated.feed;
    program.accelerated.rapid += op.accelerated.rapid;
  }
  if (program.time_rulers.empty() ||
      program.time_rulers.back() != kAcceleration) {  // else the program is part of one that has been timed
    program.time_rulers.emplace_back(kAcceleration);
    program.time_ruled.push_back(0);
  }
  program.time_ruled.back() = ruled;
}

}  // namespace toothpath::joints
