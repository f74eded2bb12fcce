// The worked bevel pairs W1 with W2 and W3 with W4 as elastic bodies of few bricks.
#pragma once

#include <stdexcept>
#include <utility>

#include "geometry/loaded_bevel/loaded_bevel_pair.h"
#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath::test {

inline loaded_bevel::BevelPairOptions coarse_bodies() {
  loaded_bevel::BevelPairOptions options;
  for (auto* body : {&options.wheel, &options.pinion}) {
    body->bricks.across = 3, body->bricks.flank = 4, body->bricks.face = 5;
    body->bricks.rim_mm = 20;
    body->teeth = 3;
  }
  return options;
}

using BevelGears = std::pair<bevel_gear::BevelGear, bevel_gear::BevelGear>;  // pinion, wheel

/// A single hand; a herringbone.
inline const BevelGears& single_gears() {
  static const BevelGears gears{bevel_test::made(bevel_test::w1(), bevel_test::pinion_mill()),
                                bevel_test::made(bevel_test::w2(), bevel_test::wheel_mill())};
  return gears;
}
inline const BevelGears& herringbone_gears() {
  static const BevelGears gears{bevel_test::made(bevel_test::w3(), bevel_test::pinion_mill()),
                                bevel_test::made(bevel_test::w4(), bevel_test::wheel_mill())};
  return gears;
}
/// The single hand with a tip relief of both gears.
inline const BevelGears& relieved_gears(double amount_mm) {
  const auto relieved = [&](bevel_gear::BevelGearParameters p) {
    modification::Modification tip;
    tip.kind = modification::Kind::tip_relief;
    tip.amount_mm = amount_mm, tip.length_mm = 3;
    p.modifications = {tip};
    return p;
  };
  static const BevelGears gears{bevel_test::made(relieved(bevel_test::w1()), bevel_test::pinion_mill()),
                                bevel_test::made(relieved(bevel_test::w2()), bevel_test::wheel_mill())};
  return gears;
}

inline loaded_bevel::LoadedBevelPair pair_of(const BevelGears& gears, int sigma,
                                             const loaded_bevel::BevelPairOptions& options) {
  auto made = loaded_bevel::make_loaded_bevel_pair(gears.first, gears.second, sigma, options);
  if (!made) throw std::invalid_argument(made.error().message);
  return std::move(made).value();
}
inline loaded_bevel::LoadedBevelPair single_pair(int sigma, const loaded_bevel::BevelPairOptions& options) {
  return pair_of(single_gears(), sigma, options);
}
inline loaded_bevel::LoadedBevelPair herringbone_pair(int sigma, const loaded_bevel::BevelPairOptions& options) {
  return pair_of(herringbone_gears(), sigma, options);
}
inline loaded_bevel::LoadedBevelPair relieved_pair(int sigma, const loaded_bevel::BevelPairOptions& options,
                                                   double amount_mm) {
  return pair_of(relieved_gears(amount_mm), sigma, options);
}

}  // namespace toothpath::test
