// Chains for tests: the classes of the closed-form table, and random ones.
#pragma once

#include <random>

#include "geometry/base/angle.h"
#include "machines/kinematic_chain.h"

namespace toothpath::test {

inline machines::RotaryAxis rotary(char letter, const Vec3& direction, const Vec3& point = Vec3::Zero()) {
  machines::RotaryAxis axis;
  axis.letter = letter;
  axis.direction = direction;
  axis.point_mm = point;
  axis.min_rad = -100 * kPi, axis.max_rad = 100 * kPi, axis.max_speed = 100;
  return axis;
}

inline machines::KinematicChain with_linear(machines::KinematicChain chain = {}) {
  for (auto& axis : chain.linear) axis = {-1e5, 1e5, 10000};
  return chain;
}

/// T1 = C, T2 = A.
inline machines::KinematicChain ac_table(const Vec3& on_c = Vec3::Zero(), const Vec3& on_a = Vec3::Zero()) {
  machines::KinematicChain chain = with_linear();
  chain.table = {rotary('C', Vec3::UnitZ(), on_c), rotary('A', Vec3::UnitX(), on_a)};
  return chain;
}

/// T1 = C, T2 = B.
inline machines::KinematicChain bc_table(const Vec3& on_c = Vec3::Zero(), const Vec3& on_b = Vec3::Zero()) {
  machines::KinematicChain chain = with_linear();
  chain.table = {rotary('C', Vec3::UnitZ(), on_c), rotary('B', Vec3::UnitY(), on_b)};
  return chain;
}

/// T1 = A, T2 = B.
inline machines::KinematicChain ab_table() {
  machines::KinematicChain chain = with_linear();
  chain.table = {rotary('A', Vec3::UnitX()), rotary('B', Vec3::UnitY())};
  return chain;
}

/// C in the table, `tilt` ('A' or 'B') in the head.
inline machines::KinematicChain head_table(char tilt) {
  machines::KinematicChain chain = with_linear();
  chain.table = {rotary('C', Vec3::UnitZ())};
  chain.head = {rotary(tilt, tilt == 'A' ? Vec3::UnitX() : Vec3::UnitY())};
  return chain;
}

/// H1 = C, H2 = `tilt`.
inline machines::KinematicChain head_head(char tilt) {
  machines::KinematicChain chain = with_linear();
  chain.head = {rotary('C', Vec3::UnitZ()), rotary(tilt, tilt == 'A' ? Vec3::UnitX() : Vec3::UnitY())};
  return chain;
}

inline Vec3 random_axis(std::mt19937_64& rng) {
  std::normal_distribution<double> g;
  return Vec3(g(rng), g(rng), g(rng)).normalized();
}

/// Every class in turn: two, one or no rotary axis; axes orthogonal or at any angle; random points, signs and zeros.
inline machines::KinematicChain random_chain_kinds(std::mt19937_64& rng, int i) {
  std::uniform_real_distribution<double> mm(-200, 200), angle(-3, 3);
  machines::KinematicChain chain;
  switch (i % 7) {
    case 0: chain = ac_table(); break;
    case 1: chain = bc_table(); break;
    case 2: chain = ab_table(); break;
    case 3: chain = head_table(i % 2 ? 'A' : 'B'); break;
    case 4: chain = head_head(i % 2 ? 'A' : 'B'); break;
    case 5: chain = i % 2 ? ac_table() : head_head('A'); break;  // below: directions at any angle
    default:
      chain = i % 3 == 0 ? with_linear() : (i % 3 == 1 ? head_table('B') : ac_table());
      if (i % 3 == 1) chain.table.clear();
      if (i % 3 == 2) chain.table.pop_back();
  }
  for (auto* side : {&chain.table, &chain.head})
    for (machines::RotaryAxis& axis : *side) {
      axis.point_mm = Vec3(mm(rng), mm(rng), mm(rng));
      axis.sign = mm(rng) > 0 ? 1 : -1;
      axis.zero_rad = angle(rng);
    }
  if (i % 7 == 5) do {
      for (auto* side : {&chain.table, &chain.head})
        for (machines::RotaryAxis& axis : *side) axis.direction = random_axis(rng);
    } while (chain.rotary(0).direction.cross(chain.rotary(1).direction).norm() < 0.3);
  return chain;
}

}  // namespace toothpath::test
