#include "machines/real_machine.h"

#include <cmath>

namespace toothpath::machines {
namespace {

Vec3 turned_by(const Vec3& direction, const Vec3& small_turn_rad) {
  const double angle = small_turn_rad.norm();
  return angle == 0 ? direction : Vec3((Eigen::AngleAxisd(angle, small_turn_rad / angle) * direction).normalized());
}

}  // namespace

double RotaryErrors::added_rad(double angle_rad) const {
  return zero_rad + scale * angle_rad + wave_rad * (std::sin(angle_rad + wave_phase_rad) - std::sin(wave_phase_rad));
}

RealMachine::RealMachine(const KinematicChain& chain, const MachineErrors& errors, const Vec3& touched_mm)
    : chain_(chain), stated_(chain), errors_(errors), touched_mm_(touched_mm) {
  for (std::size_t k = 0; k < chain_.rotary_count(); ++k) {
    RotaryAxis& axis = chain_.in_table(k) ? chain_.table[k] : chain_.head[k - chain_.table.size()];
    axis.point_mm += errors_.rotary[k].point_mm;
    axis.direction = turned_by(axis.direction, errors_.rotary[k].tilt_rad);
  }
  spindle_ = turned_by(Vec3::UnitZ(), Vec3(errors_.spindle_tilt_rad.x(), errors_.spindle_tilt_rad.y(), 0));
}

Mat3 RealMachine::turned(std::size_t k, double command_rad) const {
  const RotaryAxis& axis = chain_.rotary(k);
  const double angle = axis.sign * (command_rad - axis.zero_rad);
  return axis.rotation(command_rad + axis.sign * errors_.rotary[k].added_rad(angle));
}

RealMachine::Tool RealMachine::touched_off(double length_mm, double error_mm) const {
  Joints zeros;
  for (std::size_t k = 0; k < chain_.rotary_count(); ++k) zeros.rotary_rad[k] = chain_.rotary(k).zero_rad;
  zeros = stated_.linear_for(touched_mm_, zeros.rotary_rad, length_mm);
  Tool tool{length_mm, zeros.linear_mm, Vec3::Zero()};
  const Vec3 off = forward(zeros, tool).tip_mm - stated_.forward(zeros, length_mm).tip_mm;
  Mat3 table = Mat3::Identity();
  for (std::size_t k = 0; k < chain_.table.size(); ++k) table *= turned(k, zeros.rotary_rad[k]);
  tool.shift_mm = -(table.transpose() * off);
  tool.length_mm += error_mm;
  return tool;
}

TablePose RealMachine::forward(const Joints& joints, const Tool& tool) const {
  const auto& theta = joints.rotary_rad;
  Vec3 u = spindle_, head = Vec3::Zero();
  for (std::size_t k = chain_.rotary_count(); k-- > chain_.table.size();) {
    const Mat3 r = turned(k, theta[k]);
    u = r * u;
    head = chain_.rotary(k).point_mm + r * (head - chain_.rotary(k).point_mm);
  }
  const Vec3 way = joints.linear_mm - tool.at_mm;
  const Vec3 stands =
      joints.linear_mm + tool.shift_mm +
      Vec3(errors_.square_xy_rad * way.y() + errors_.square_xz_rad * way.z(), errors_.square_yz_rad * way.z(), 0);
  Vec3 p = stands + head - tool.length_mm * u;
  for (std::size_t k = chain_.table.size(); k-- > 0;) {
    const Mat3 r = turned(k, theta[k]);
    p = chain_.table[k].point_mm + r * (p - chain_.table[k].point_mm);
    u = r * u;
  }
  return {p, u};
}

}  // namespace toothpath::machines
