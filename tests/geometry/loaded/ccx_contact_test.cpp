// CalculiX as judge of contact: a ring of a face gear and a bevel pair. Its factorisation takes a minute or two, so by
// label: ./check -C Nightly -L calculix.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "geometry/decks/bevel_deck.h"
#include "geometry/decks/rows_deck.h"
#include "tests/geometry/loaded/ccx.h"
#include "tests/geometry/loaded/trial_gear.h"
#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

/// Outer ring of trial 4, three teeth clamped, phase 0, 20 um: docs/loaded_contact.md.
TEST(CalculiXContact, OfARingOfAFaceGear) {
  ASSERT_TRUE(ccx_is_there()) << "calculix-ccx is not installed; tools/packages.sh names it";
  constexpr double kApproach = 0.02;
  const auto gear = trial_gear();
  loaded::PairOptions options;
  options.gear.teeth = options.pinion.teeth = 3;
  auto pair = loaded::make_loaded_pair(gear, 1, 30, options);
  ASSERT_TRUE(pair);
  pair->rings.erase(pair->rings.begin());
  double force = 15000, ours[2] = {0, 0};
  for (int round = 0; round < 6; ++round) {
    loaded::Load load;
    load.torque_nmm = force * pair->lever;
    const auto p = loaded::loaded_position(*pair, load, 0);
    ASSERT_TRUE(p) << p.error().message;
    ours[0] = ours[1] = 0;
    for (const auto& s : p->segments) ours[s.place.tooth + 1] += s.force;
    force += (kApproach - p->approach_mm) * p->tangent;
  }
  decks::DeckOptions deck;
  deck.approach_mm = kApproach;
  const auto text = decks::contact_deck(gear, 1, 1, deck);
  ASSERT_TRUE(text) << text.error().message;
  const auto reactions = vectors_at_nodes(run_deck(*text, "contact").dat);
  ASSERT_FALSE(reactions.empty());
  const double moment = moment_of(*text, reactions, Vec3::Zero(), Vec3::UnitZ());
  const double theirs = std::abs(moment) / pair->lever, total = ours[0] + ours[1];
  fmt::print("normal force {:.0f} N, CalculiX {:.0f} N\n", total, theirs);
  EXPECT_NEAR(total, theirs, 0.05 * theirs) << ours[0] << " + " << ours[1];
}

/// W1 with W2, wall U, three teeth clamped, the wheel turned by 40 um: docs/loaded_contact.md 8.
TEST(CalculiXContact, OfABevelPair) {
  ASSERT_TRUE(ccx_is_there()) << "calculix-ccx is not installed; tools/packages.sh names it";
  constexpr double kApproach = 0.04;
  auto options = coarse_bodies();
  for (auto* body : {&options.wheel, &options.pinion}) body->bricks = {4, 6, 3, 1, 3, 8, 20, 1};
  const auto pair = single_pair(-1, options);
  const double phi = 0.3 * pair.pair.pinion().pitch();
  loaded::Load load;
  load.torque_nmm = 1.5e6;
  double ours = 0;
  for (int round = 0; round < 5; ++round) {
    const auto p = loaded_bevel::loaded_position(pair, load, phi);
    ASSERT_TRUE(p) << p.error().message;
    ours = load.torque_nmm;
    load.torque_nmm += (kApproach - p->approach_mm) * p->tangent * pair.lever;
  }
  decks::BevelDeckOptions deck;
  deck.wheel.rim_mm = deck.pinion.rim_mm = 20;
  deck.phi_1 = phi, deck.approach_mm = kApproach;
  const auto text = decks::bevel_deck(pair, 0, deck);
  ASSERT_TRUE(text) << text.error().message;
  const auto reactions = vectors_at_nodes(run_deck(*text, "bevel").dat);
  ASSERT_FALSE(reactions.empty());
  const double theirs = std::abs(moment_of(*text, reactions, pair.pair.wheel_apex(), pair.pair.wheel_axis()));
  fmt::print("torque {:.0f} N mm, CalculiX {:.0f} N mm\n", ours, theirs);
  EXPECT_NEAR(ours, theirs, 0.1 * theirs);
}

}  // namespace
}  // namespace toothpath::test
