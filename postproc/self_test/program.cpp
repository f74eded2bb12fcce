#include <algorithm>
#include <cmath>
#include <span>

#include "cam/tool/assembly.h"
#include "postproc/controls/of_machine.h"
#include "postproc/joints/words.h"
#include "postproc/numbers/fixed_point.h"
#include "postproc/readback/reader.h"
#include "postproc/self_test/self_test.h"

namespace toothpath::self_test {
namespace {

constexpr double kFeed = 500;       // mm/min of the tip on the way down and up
constexpr double kTurnSpeed = 720;  // deg/min: slow enough to watch

class SelfTestBuilder {
 public:
  SelfTestBuilder(const SelfTest& test, const machines::Machine& machine, const text::NcDialect& dialect)
      : test_(test), machine_(machine), words_(machine.chain, dialect.format, test.point_mm) {
    words_.set_length(test.tool_length_mm);
    joints::AxisProgram& p = program_;
    p.format = dialect.format;
    p.letters = {'X', 'Y', 'Z', 0, 0};
    for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) {
      p.letters[3 + k] = machine.chain.rotary(k).letter;
      p.rollover[3 + k] = machine.chain.rotary(k).rollover;
    }
    p.tcp = machine.tcp == machines::TcpMode::none ? machines::TcpMode::none : machines::TcpMode::angles;
    p.tcp_starts_at_zero = dialect.tcp_starts_at_zero;
    const double unit = static_cast<double>(numbers::power_of_ten(dialect.format.linear_decimals));
    p.retract_z_mm = std::floor(machine.top_mm() * unit + 1e-6) / unit;
    p.work_offset_at_mm = test.point_mm;
    if (machine.post.transformation_takes_rotary_offset) p.index_axis = 3;
    p.assumed = machine.assumed_keys;
  }

  joints::AxisProgram build() && {
    program_.turns_in_cuts = !test_.lifts;
    for (std::size_t k = 0; k < machine_.chain.rotary_count(); ++k)
      program_.tip_reach_mm = std::max(
          program_.tip_reach_mm, (machine_.chain.rotary(k).point_mm - test_.point_mm).norm() + test_.tool_length_mm);
    joints::AxisOperation op;
    op.type = "self_test";
    op.tool_number = 1;
    op.tool_length_mm = test_.tool_length_mm;
    op.tool_name = "TEST BAR";
    op.spindle_rpm = 100;  // stands where a control wants it with the tool; nothing starts the spindle
    std::size_t next = 1;
    for (std::size_t s = 0; s < test_.stations.size(); ++s) {
      if (test_.stations[s].zero_deg != 0) op.teeth.push_back(tcp_off_at(s));
      zero_deg_ = test_.stations[s].zero_deg;
      joints::ToothBlocks part;
      part.tooth = static_cast<int>(s);
      part.remark = fmt::format("STATION {} OF {}: {}", s + 1, test_.stations.size(), test_.stations[s].remark);
      part.pause = true;
      if (zero_deg_ != 0) ask_for_zero(part, test_.stations[s].rotary_rad), ++next;
      if (s == 0) approach(part);
      if (s > 0 && test_.lifts) come_down(part, test_.stations[s - 1].rotary_rad, test_.stations[s].rotary_rad);
      for (; next < test_.moves.size() && s > 0 && !test_.lifts && zero_deg_ == 0; ++next) {
        turn(part, test_.moves[next].joints);
        if (test_.moves[next].station >= 0) {
          ++next;
          break;
        }
      }
      if (!part.blocks.empty()) part.blocks.front().forced = true;
      op.teeth.push_back(std::move(part));
    }
    joints::ToothBlocks last;
    last.tooth = static_cast<int>(test_.stations.size());
    last.remark = "AWAY FROM THE POINT";
    leave(last);
    if (zero_deg_ != 0) last.zero_deg = zero_deg_;
    op.teeth.push_back(std::move(last));
    program_.operations.push_back(std::move(op));
    return std::move(program_);
  }

 private:
  [[nodiscard]] bool tcp() const { return program_.tcp != machines::TcpMode::none; }
  /// The point, or a place above it, with the rotaries as given.
  joints::AxisBlock at(joints::BlockKind kind, double height, const std::array<double, 2>& rotaries, bool tip) const {
    joints::AxisBlock b;
    b.kind = kind;
    const Vec3 place = test_.point_mm + Vec3(0, 0, height);
    if (tip && zero_deg_ != 0) words_.set_tip(b, as_counted(place), {rotaries[0] - radians(zero_deg_), rotaries[1]});
    else if (tip) words_.set_tip(b, place, rotaries);
    else words_.set_joints(b, machine_.chain.linear_for(place, rotaries, test_.tool_length_mm).linear_mm, rotaries);
    b.axis = machine_.chain.forward({Vec3::Zero(), rotaries}, test_.tool_length_mm).axis;
    return b;
  }
  /// A place of the table where the words see it whose rotary counts from elsewhere: the table that is turned by that
  /// stands for the one at zero.
  [[nodiscard]] Vec3 as_counted(const Vec3& place) const {
    const machines::RotaryAxis& axis = machine_.chain.table.front();
    const Mat3 turn = Eigen::AngleAxisd(-axis.sign * radians(zero_deg_), axis.direction).toRotationMatrix();
    return axis.point_mm + turn * (place - axis.point_mm);
  }
  [[nodiscard]] joints::ToothBlocks tcp_off_at(std::size_t station) const {
    joints::ToothBlocks part;
    part.tooth = static_cast<int>(station);
    part.remark = "TCP OFF: NOTHING MOVES";
    part.blocks.push_back(at(joints::BlockKind::tcp_off, 0, test_.stations[station].rotary_rad, false));
    return part;
  }
  /// TCP again, and the words of the place at which the axes stand.
  void ask_for_zero(joints::ToothBlocks& part, const std::array<double, 2>& rotaries) const {
    part.zero_deg = zero_deg_;
    part.blocks.push_back(at(joints::BlockKind::tcp_on, 0, rotaries, true));
    straight(part, 0, test_.approach_mm, rotaries);
    part.blocks.back().forced = true;
  }
  void straight(joints::ToothBlocks& part, double height, double length, const std::array<double, 2>& rotaries) const {
    joints::AxisBlock b = at(joints::BlockKind::feed, height, rotaries, tcp());
    b.minutes = length / kFeed;
    b.per_minute = kFeed;
    part.blocks.push_back(b);
  }
  void approach(joints::ToothBlocks& part) const {
    const auto& zero = test_.stations.front().rotary_rad;
    for (const joints::BlockKind kind :
         {joints::BlockKind::rapid_rotary, joints::BlockKind::rapid_xy, joints::BlockKind::rapid_z}) {
      // Where TCP starts at its own block with Z, that block comes down.
      if (kind == joints::BlockKind::rapid_z && tcp() && program_.tcp_starts_at_zero) continue;
      joints::AxisBlock b = at(kind, test_.approach_mm, zero, false);
      b.forced = true;
      part.blocks.push_back(b);
    }
    if (tcp()) part.blocks.push_back(at(joints::BlockKind::tcp_on, test_.approach_mm, zero, true));
    straight(part, 0, test_.approach_mm, zero);
  }
  /// The point, Z higher by `up`, joint words.
  joints::AxisBlock over(joints::BlockKind kind, double up, const std::array<double, 2>& rotaries) const {
    joints::AxisBlock b = at(kind, 0, rotaries, false);
    words_.set_joints(b, words_.joints(b).linear_mm + Vec3(0, 0, up), rotaries);
    return b;
  }
  /// Up from one station, Z to its top, the rotaries, down upon the next.
  void come_down(joints::ToothBlocks& part, const std::array<double, 2>& from, const std::array<double, 2>& to) const {
    const auto push = [&](joints::AxisBlock b) {
      b.minutes = test_.approach_mm / kFeed;
      b.per_minute = kFeed;
      b.forced = true;
      part.blocks.push_back(b);
    };
    push(over(joints::BlockKind::feed, test_.approach_mm, from));
    joints::AxisBlock top = over(joints::BlockKind::rapid_z, 0, from);
    top.words[2] = words_.joint_word(program_.retract_z_mm, 2, top);
    push(top);
    for (const joints::BlockKind kind :
         {joints::BlockKind::rapid_rotary, joints::BlockKind::rapid_xy, joints::BlockKind::rapid_z})
      push(over(kind, test_.approach_mm, to));
    push(over(joints::BlockKind::feed, 0, to));
  }
  /// To the next pose; with TCP the control itself keeps the tip on the point.
  void turn(joints::ToothBlocks& part, const machines::Joints& to) {
    const auto before = words_.rounded(at_);
    const auto after = words_.rounded(to.rotary_rad);
    at_ = to.rotary_rad;
    const double angle = std::max(std::abs(degrees(after[0] - before[0])), std::abs(degrees(after[1] - before[1])));
    if (angle == 0) return;
    joints::AxisBlock b = at(tcp() ? joints::BlockKind::turn : joints::BlockKind::feed, 0, after, tcp());
    b.minutes = angle / kTurnSpeed;
    b.per_minute = kTurnSpeed;
    part.blocks.push_back(b);
  }
  void leave(joints::ToothBlocks& part) const {
    const auto& zero = test_.stations.back().rotary_rad;
    straight(part, test_.approach_mm, test_.approach_mm, zero);
    part.blocks.front().forced = true;
    if (tcp()) part.blocks.push_back(at(joints::BlockKind::tcp_off, test_.approach_mm, zero, false));
  }

  const SelfTest& test_;
  const machines::Machine& machine_;
  joints::AxisWords words_;
  joints::AxisProgram program_;
  double zero_deg_ = 0;  ///< the words of the first rotary count from here
  std::array<double, 2> at_ = test_.stations.front().rotary_rad;
};

/// Watches the executed moves of a self test: travel, the tip on its point, the stations in their order.
class SelfTestWatch {
 public:
  SelfTestWatch(const std::string& file, const SelfTest& test, const machines::Machine& machine)
      : file_(file), test_(test), machine_(machine) {}

  void operator()(const readback::ExecutedMove& m) {
    proof_.minutes += m.minutes;
    if (!m.known || error_) return;
    const machines::Joints now = joints_of(m);
    const auto outside = machine_.chain.violations(now, machine_.limit_margin);
    if (!outside.empty()) fault(m, outside.front().text());
    if (test_.lifts) {
      on_point_ = !m.rapid && distance(now) <= kOnPoint;
      if (on_point_) proof_.worst_mm = std::max(proof_.worst_mm, distance(now));
      ++proof_.moves;
    } else {
      if (on_point_ && next_ < test_.stations.size()) stay(m, now);
      if (!on_point_ && !m.rapid && distance(now) <= kOnPoint) on_point_ = true;
    }
    if (on_point_ && next_ < test_.stations.size() && at_station(now, test_.stations[next_])) {
      proof_.readings_mm.push_back(tip_of(now));
      ++next_;
    }
    before_ = now;
  }

  Result<SelfTestProof> finish() const {
    if (error_) return *error_;
    if (next_ < test_.stations.size())
      return fail_as(DiagnosticKind::verification, "station {} of {} ({}) is not met", next_ + 1, test_.stations.size(),
                     test_.stations[next_].remark);
    SelfTestProof proof = proof_;
    for (Vec3& reading : proof.readings_mm) reading -= proof_.readings_mm.front();
    return proof;
  }

 private:
  static constexpr double kOnPoint = 0.003;  // mm

  static machines::Joints joints_of(const readback::ExecutedMove& m) {
    machines::Joints j;
    for (int i = 0; i < 3; ++i) j.linear_mm[i] = m.joints[static_cast<std::size_t>(i)];
    for (std::size_t k = 0; k < 2; ++k) j.rotary_rad[k] = radians(m.joints[3 + k]);
    return j;
  }
  [[nodiscard]] Vec3 tip_of(const machines::Joints& j) const {
    return machine_.chain.forward(j, test_.tool_length_mm).tip_mm;
  }
  [[nodiscard]] double distance(const machines::Joints& j) const { return (tip_of(j) - test_.point_mm).norm(); }
  void fault(const readback::ExecutedMove& m, std::string what) {
    if (error_) return;
    error_ = fail_as(DiagnosticKind::verification, "{}", what);
    error_->position = {file_, m.line, 0};
  }
  /// With TCP the control holds the tip on its chord; else every joint is linear.
  void stay(const readback::ExecutedMove& m, const machines::Joints& now) {
    const double allowed = test_.tip_bound_mm + kOnPoint;
    ++proof_.moves;
    for (int s = 1; s <= 4; ++s) {
      machines::Joints j;
      const double t = s / 4.0;
      j.linear_mm = before_.linear_mm + t * (now.linear_mm - before_.linear_mm);
      for (std::size_t k = 0; k < 2; ++k)
        j.rotary_rad[k] = before_.rotary_rad[k] + t * (now.rotary_rad[k] - before_.rotary_rad[k]);
      proof_.worst_mm = std::max(proof_.worst_mm, distance(m.tcp ? now : j));
    }
    if (proof_.worst_mm > allowed)
      fault(m, fmt::format("the tip leaves the point by {:.4f} mm, allowed {:.4f}", proof_.worst_mm, allowed));
  }
  [[nodiscard]] bool at_station(const machines::Joints& now, const SelfTestStation& station) const {
    double turn = 0;
    for (std::size_t k = 0; k < machine_.chain.rotary_count(); ++k) {
      const double off = now.rotary_rad[k] - station.rotary_rad[k];
      turn = std::max(turn, std::abs(machine_.chain.rotary(k).rollover ? std::remainder(off, 2 * kPi) : off));
    }
    return turn <= radians(0.001);
  }

  const std::string& file_;
  const SelfTest& test_;
  const machines::Machine& machine_;
  SelfTestProof proof_;
  std::size_t next_ = 0;  ///< station that comes next
  bool on_point_ = false;
  std::optional<Diagnostic> error_;
  machines::Joints before_;
};

}  // namespace

joints::AxisProgram self_test_program(const SelfTest& test, const machines::Machine& machine,
                                      const text::NcDialect& dialect) {
  return SelfTestBuilder(test, machine, dialect).build();
}

text::NcDialect in_air(text::NcDialect dialect) {
  // Everything but the start of the spindle: the machinist stands beside the indicator.
  std::erase_if(dialect.tool_change, [](const std::string& line) { return line == "M3" || line.ends_with(" M3"); });
  dialect.smoothing_on.clear();  // nothing is cut
  dialect.smoothing_off.clear();
  return dialect;
}

Result<SelfTestProof> prove_self_test(std::string_view text, const std::string& file, const SelfTest& test,
                                      const machines::Machine& machine) {
  tool::ToolAssembly bar;
  bar.number = 1;
  bar.length_mm = test.tool_length_mm;
  joints::Setup setup;
  setup.work_offset_at_mm = test.point_mm;
  auto control = controls::control_of(machine, setup, std::span(&bar, 1));
  if (!control) return control.error();
  control->dry_run = true;
  SelfTestWatch watch(file, test, machine);
  const auto status = readback::execute_nc(text, file, *control, [&](const readback::ExecutedMove& m) { watch(m); });
  if (!status) {
    Diagnostic refused = status.error();
    refused.kind = DiagnosticKind::verification;
    return refused;
  }
  return watch.finish();
}

}  // namespace toothpath::self_test
