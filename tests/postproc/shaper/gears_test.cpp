// Change gears against plain enumeration of every train.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "postproc/shaper/change_gears.h"

namespace toothpath {
namespace {

/// Every train of the set, by index into the list, so that each wheel is used once.
std::vector<shaper::GearTrain> all_trains(const shaper::WheelSet& set) {
  std::vector<shaper::GearTrain> trains;
  const auto& t = set.teeth;
  const std::size_t n = t.size();
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) {
      if (a == b) continue;
      trains.push_back({{t[a], t[b]}});
      for (std::size_t c = 0; c < n; ++c)
        for (std::size_t d = 0; d < n; ++d) {
          if (c == a || c == b || d == a || d == b || d == c) continue;
          if (t[a] + t[b] < t[c] + set.mesh_margin || t[c] + t[d] < t[b] + set.mesh_margin) continue;
          trains.push_back({{t[a], t[b], t[c], t[d]}});
        }
    }
  return trains;
}

bool equals(const shaper::GearTrain& train, machines::Ratio target) {
  const machines::Ratio r = train.ratio();
  return r.numerator * target.denominator == target.numerator * r.denominator;
}

TEST(ShaperGears, ExactTrainIsFoundWheneverOneExists) {
  std::mt19937 random(7);
  int found = 0, absent = 0;
  for (int trial = 0; trial < 60; ++trial) {
    shaper::WheelSet set;
    set.mesh_margin = 15;
    for (int k = 0; k < 9; ++k) set.teeth.push_back(20 + static_cast<int>(random() % 60));
    const auto trains = all_trains(set);
    // A ratio that some train has, or one that is only nearly one.
    machines::Ratio target = trains[random() % trains.size()].ratio();
    if (trial % 2 == 1) target = {target.numerator * 1000 + 1, target.denominator * 1000};
    bool exists = false;
    for (const auto& t : trains) exists = exists || equals(t, target);
    const auto train = shaper::exact_train(set, target);
    ASSERT_EQ(train.has_value(), exists);
    exists ? ++found : ++absent;
    if (!train) continue;
    EXPECT_TRUE(equals(*train, target));
    EXPECT_TRUE(shaper::train_fits(set, *train)) << train->text();
  }
  EXPECT_GE(found, 30);
  EXPECT_GE(absent, 10);
}

TEST(ShaperGears, NearestTrainIsNoFartherThanAnyOther) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 60; ++trial) {
    shaper::WheelSet set;
    set.mesh_margin = static_cast<int>(random() % 25);
    for (int k = 0; k < 8; ++k) set.teeth.push_back(20 + static_cast<int>(random() % 80));
    const double target = 0.2 + 3.0 * double(random() % 10000) / 10000;
    const auto train = shaper::nearest_train(set, target);
    ASSERT_TRUE(train);
    EXPECT_TRUE(shaper::train_fits(set, *train)) << train->text();
    double best = 1e9;
    for (const auto& t : all_trains(set)) best = std::min(best, std::abs(t.ratio().value() - target));
    EXPECT_EQ(std::abs(train->ratio().value() - target), best);
  }
}

TEST(ShaperGears, OrderOfTheListDoesNotMatter) {
  shaper::WheelSet set{{20, 24, 25, 30, 40, 44, 55, 60, 65, 70}, 15}, reversed = set;
  std::reverse(reversed.teeth.begin(), reversed.teeth.end());
  EXPECT_EQ(shaper::exact_train(set, {15, 22})->wheels, shaper::exact_train(reversed, {15, 22})->wheels);
  EXPECT_EQ(shaper::nearest_train(set, 0.7123)->wheels, shaper::nearest_train(reversed, 0.7123)->wheels);
}

// 15/22 with 30/44 on the shelf, and without: the two trains named in the literature's example are both legal.
TEST(ShaperGears, ExampleOfTheIndexTrain) {
  EXPECT_EQ(shaper::exact_train({{25, 30, 40, 44, 55, 60}, 15}, {15, 22})->wheels, (std::vector<int>{30, 44}));
  const shaper::WheelSet no_pair{{25, 40, 55, 60}, 15};
  const auto train = shaper::exact_train(no_pair, {15, 22});
  ASSERT_TRUE(train);
  EXPECT_EQ(train->wheels.size(), 4u);
  EXPECT_TRUE(shaper::train_fits(no_pair, {{25, 55, 60, 40}}));
  EXPECT_TRUE(equals({{25, 55, 60, 40}}, {15, 22}));
}

TEST(ShaperGears, EveryWheelOnce) {
  const shaper::WheelSet set{{30, 30, 44, 60}, 15};
  EXPECT_TRUE(shaper::train_fits(set, {{30, 30}}));
  EXPECT_FALSE(shaper::train_fits(set, {{44, 44}}));
  EXPECT_FALSE(shaper::exact_train(shaper::WheelSet{{30, 44}, 15}, {1, 1}));
  EXPECT_EQ(shaper::without(set, {{30, 44}}).teeth, (std::vector<int>{30, 60}));
}

// 20/80 * 100/25 = 1, but the wheels would not reach each other: c is too large for a and b.
TEST(ShaperGears, MeshConditionIsKept) {
  EXPECT_FALSE(shaper::train_fits({{20, 30, 60, 25}, 15}, {{20, 30, 60, 25}}));
  EXPECT_TRUE(shaper::train_fits({{20, 30, 35, 25}, 15}, {{20, 30, 35, 25}}));
  EXPECT_FALSE(shaper::train_fits({{20, 30, 36, 25}, 15}, {{20, 30, 36, 25}}));
}

}  // namespace
}  // namespace toothpath
