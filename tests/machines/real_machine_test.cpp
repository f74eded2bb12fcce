// A machine with errors against its own chain, by hand, and against homogeneous transforms written out here.
#include "machines/real_machine.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/machines/chains.h"

namespace toothpath::machines {
namespace {

constexpr double kLength = 120;
const Vec3 kTouched(3, -2, 140);

std::vector<KinematicChain> chains() {
  std::vector<KinematicChain> all = {test::ac_table({3, -2, 0}, {0, 5, 40}), test::bc_table({1, 2, 3}, {4, 5, 6}),
                                     test::head_table('B'), test::head_head('A')};
  for (auto* axes : {&all[2].head, &all[3].head})
    for (auto& axis : *axes) axis.point_mm = Vec3(0.1, -0.2, 180);
  all[0].table[1].zero_rad = 0.1;
  all[1].table[0].sign = -1;
  return all;
}

MachineErrors random_errors(std::mt19937& generator, double mm, double rad) {
  std::uniform_real_distribution<double> any(-1, 1);
  const auto vector = [&](double size) {
    return Vec3(size * any(generator), size * any(generator), size * any(generator));
  };
  MachineErrors e;
  for (auto& r : e.rotary)
    r = {vector(mm), vector(rad), rad * any(generator), rad * any(generator), rad * any(generator), 3 * any(generator)};
  e.square_xy_rad = rad * any(generator);
  e.square_xz_rad = rad * any(generator);
  e.square_yz_rad = rad * any(generator);
  e.spindle_tilt_rad = vector(rad);
  return e;
}

Joints random_joints(std::mt19937& generator) {
  std::uniform_real_distribution<double> way(-300, 300), turn(-2, 2);
  return {Vec3(way(generator), way(generator), way(generator)), {turn(generator), turn(generator)}};
}

Joints at_zero(const KinematicChain& chain) {
  Joints j;
  for (std::size_t k = 0; k < chain.rotary_count(); ++k) j.rotary_rad[k] = chain.rotary(k).zero_rad;
  return chain.linear_for(kTouched, j.rotary_rad, kLength);
}

TEST(RealMachine, WithoutErrorsTheBitsOfTheChain) {
  std::mt19937 generator(1);
  for (const KinematicChain& chain : chains()) {
    const RealMachine machine(chain, {}, kTouched);
    const auto tool = machine.touched_off(kLength, 0);
    for (int k = 0; k < 100; ++k) {
      const Joints j = random_joints(generator);
      const TablePose a = machine.forward(j, tool), b = chain.forward(j, kLength);
      EXPECT_EQ(a.tip_mm, b.tip_mm);
      EXPECT_EQ(a.axis, b.axis);
    }
  }
}

/// Whatever is wrong with the machine: at the touched point the tip is where the control believes it.
TEST(RealMachine, TouchedOffAtItsPoint) {
  std::mt19937 generator(2);
  for (const KinematicChain& chain : chains())
    for (int k = 0; k < 50; ++k) {
      const RealMachine machine(chain, random_errors(generator, 1, 0.02), kTouched);
      const auto tip = [&](double longer) {
        return machine.forward(at_zero(chain), machine.touched_off(kLength, longer));
      };
      EXPECT_LT((tip(0).tip_mm - kTouched).norm(), 1e-11);
      const TablePose longer = tip(0.5);
      EXPECT_LT((longer.tip_mm - (kTouched - 0.5 * longer.axis)).norm(), 1e-11);
    }
}

/// The same machine as a product of transforms about lines, from the work outwards.
TEST(RealMachine, TransformsWrittenOut) {
  using Move = Eigen::Affine3d;
  std::mt19937 generator(3);
  for (const KinematicChain& chain : chains())
    for (int n = 0; n < 50; ++n) {
      const MachineErrors e = random_errors(generator, 0.1, 1e-3);
      const RealMachine machine(chain, e, kTouched);
      const auto tool = machine.touched_off(kLength, 0.02);
      const auto about = [&](std::size_t k, double command) {
        const RotaryAxis& axis = chain.rotary(k);
        const RotaryErrors& r = e.rotary[k];
        const double motion = axis.sign * (command - axis.zero_rad);
        const double angle = motion * (1 + r.scale) + r.zero_rad +
                             r.wave_rad * (std::sin(motion + r.wave_phase_rad) - std::sin(r.wave_phase_rad));
        const Vec3 direction = Eigen::AngleAxisd(r.tilt_rad.norm(), r.tilt_rad.normalized()) * axis.direction;
        const Vec3 point = axis.point_mm + r.point_mm;
        return Move(Eigen::Translation3d(point) * Eigen::AngleAxisd(angle, direction.normalized()) *
                    Eigen::Translation3d(-point));
      };
      const Joints j = random_joints(generator);
      const Vec3 way = j.linear_mm - at_zero(chain).linear_mm;
      Eigen::Matrix3d square = Eigen::Matrix3d::Identity();
      square(0, 1) = e.square_xy_rad, square(0, 2) = e.square_xz_rad, square(1, 2) = e.square_yz_rad;
      Move all = Move::Identity();
      for (std::size_t k = 0; k < chain.table.size(); ++k) all = all * about(k, j.rotary_rad[k]);
      all = all * Eigen::Translation3d(at_zero(chain).linear_mm + square * way + tool.shift_mm);
      for (std::size_t k = chain.table.size(); k < chain.rotary_count(); ++k) all = all * about(k, j.rotary_rad[k]);
      const Vec3 tilt(e.spindle_tilt_rad.x(), e.spindle_tilt_rad.y(), 0);
      const Vec3 spindle = Eigen::AngleAxisd(tilt.norm(), tilt.normalized()) * Vec3::UnitZ();
      const TablePose pose = machine.forward(j, tool);
      EXPECT_LT((pose.tip_mm - all * Vec3(-(kLength + 0.02) * spindle)).norm(), 1e-9);
      EXPECT_LT((pose.axis - all.linear() * spindle).norm(), 1e-12);
    }
}

/// A table that turns beside its place carries the part round a circle: (1 - R) e off where it was touched off.
TEST(RealMachine, APivotShowsByTheTurn) {
  for (const KinematicChain& chain : chains()) {
    if (chain.table.empty()) continue;
    MachineErrors e;
    e.rotary[0].point_mm = Vec3(0.01, 0.02, 0);
    const RealMachine machine(chain, e, kTouched);
    for (const double turn : {0.5, 2.0, -3.0}) {
      Joints j = at_zero(chain);
      j.rotary_rad[0] += turn;
      const Mat3 r = chain.table[0].rotation(j.rotary_rad[0]);
      const Vec3 off = machine.forward(j, machine.touched_off(kLength, 0)).tip_mm - chain.forward(j, kLength).tip_mm;
      EXPECT_LT((off - (e.rotary[0].point_mm - r * e.rotary[0].point_mm)).norm(), 1e-11);
    }
  }
}

TEST(RealMachine, SquarenessByTheWay) {
  for (const KinematicChain& chain : chains()) {
    MachineErrors e;
    e.square_xy_rad = 1e-3, e.square_xz_rad = 2e-3, e.square_yz_rad = 3e-3;
    const RealMachine machine(chain, e, kTouched);
    Joints j = at_zero(chain);
    j.linear_mm += Vec3(7, 10, 100);
    const Vec3 off = machine.forward(j, machine.touched_off(kLength, 0)).tip_mm - chain.forward(j, kLength).tip_mm;
    EXPECT_LT((off - Vec3(0.01 + 0.2, 0.3, 0)).norm(), 1e-11);
  }
}

}  // namespace
}  // namespace toothpath::machines
