// The cuts of one tooth looked for on another: however either is cut into blocks, in whatever order, there and back.
#include "cam/proof/cuts_again.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/base/angle.h"

namespace toothpath::cuts_again_cases {
namespace {

constexpr double kPitch = radians(6);

/// Passes of a tooth, 0.15 mm from each other, there and back with a lift at the end, in so many blocks a pass.
std::vector<path::ToolMotion> tooth(int number, int blocks, double rounding, int line) {
  std::mt19937 random(unsigned(100 + number));
  std::uniform_real_distribution<double> off(-rounding, rounding);
  std::vector<Vec3> way;
  for (int pass = 0; pass < 12; ++pass) {
    const double y = 0.15 * pass;
    for (int k = 0; k <= blocks; ++k) {
      const double share = double(k) / blocks, t = pass % 2 == 0 ? share : 1 - share;
      way.emplace_back(60 + 5 * t, y, -1 - 0.2 * t * (1 - t));
    }
    way.emplace_back(way.back() + Vec3(0, 0, 0.22));
    if (pass % 3 == 0) way.emplace_back(way[way.size() - 2]);  // down again, and back on the same way
  }
  std::vector<path::ToolMotion> out;
  for (std::size_t k = 1; k < way.size(); ++k) {
    path::ToolMotion m;
    m.tip_from = k > 1 ? out.back().tip_to : turned(way[0], number * kPitch);
    m.tip_to = turned(way[k] + Vec3(off(random), off(random), off(random)), number * kPitch);
    m.axis_from = m.axis_to = turned(Vec3(0.6, 0, 0.8), number * kPitch);
    m.tooth = number;
    m.line = line++;
    out.push_back(m);
  }
  return out;
}

proof::CutsAgain again(std::vector<path::ToolMotion> first, const std::vector<path::ToolMotion>& later) {
  const proof::FirstTooth known(std::move(first), [](const path::ToolMotion&) { return true; });
  return proof::cuts_again(known, later, 3 * kPitch);
}

/// Greatest distance of a place of the first tooth's way from that of the later one: by dense samples.
double sampled(const std::vector<path::ToolMotion>& first, const std::vector<path::ToolMotion>& later) {
  double most = 0;
  for (const path::ToolMotion& m : first)
    for (int k = 0; k <= 20; ++k) {
      const Vec3 p = turned(path::tip_at(m, k / 20.0), 3 * kPitch);
      double least = INFINITY;
      for (const path::ToolMotion& n : later) least = std::min(least, distance_to_segment(p, n.tip_from, n.tip_to));
      most = std::max(most, least);
    }
  return most;
}

TEST(CutsAgain, AreFoundHoweverTheWayIsCut) {
  const auto first = tooth(0, 40, 5e-4, 1);
  for (const int blocks : {7, 39, 40, 41, 133}) {
    const auto later = tooth(3, blocks, 5e-4, 1001);
    const auto found = again(first, later);
    ASSERT_FALSE(found.missing) << blocks;
    const double chord = 0.2 / (blocks * blocks) + 0.2 / (40 * 40);
    EXPECT_LE(found.tip_mm, 2e-3 + chord + 1e-3) << blocks;
    EXPECT_GE(found.tip_mm + 1e-9, sampled(first, later)) << blocks;
  }
}

TEST(CutsAgain, TheOrderIsFree) {
  const auto first = tooth(0, 40, 5e-4, 1);
  auto later = tooth(3, 40, 5e-4, 1001);
  std::rotate(later.begin(), later.begin() + std::ptrdiff_t(later.size() / 2), later.end());
  const auto found = again(first, later);
  EXPECT_FALSE(found.missing);
  EXPECT_LE(found.tip_mm, 4e-3);
}

TEST(CutsAgain, WhatIsMissingIsToldWithItsLines) {
  const auto first = tooth(0, 40, 5e-4, 1);
  const auto whole = tooth(3, 40, 5e-4, 1001);
  for (const std::size_t at : {50U, 170U, 333U}) {
    auto later = whole;
    later.erase(later.begin() + std::ptrdiff_t(at), later.begin() + std::ptrdiff_t(at) + 10);
    const auto found = again(first, later);
    // The pass beside it is 0.15 mm away; a longer block that leaves them out goes where they went.
    ASSERT_TRUE(found.missing || found.tip_mm > 0.005) << at;
    if (!found.missing) continue;
    EXPECT_NEAR(found.missing->line, int(at), 12);
    EXPECT_NEAR(found.missing->behind_line, 1000 + int(at), 12);
    EXPECT_GT(found.missing->off_mm, 0.1);
    EXPECT_LE(found.missing->off_mm, 0.2);
  }
  // Into another space.
  auto later = whole;
  for (std::size_t k = 100; k < 130; ++k)
    for (Vec3* v : {&later[k].tip_from, &later[k].tip_to}) *v = turned(*v, kPitch);
  const auto found = again(first, later);
  ASSERT_TRUE(found.missing);
  EXPECT_NEAR(found.missing->line, 101, 12);
  EXPECT_EQ(again(first, {}).missing->behind_line, 0) << "nothing is cut";
}

TEST(CutsAgain, ABlockThatIsMovedCountsByHowMuch) {
  const auto first = tooth(0, 40, 0, 1);
  for (const double um : {2.0, 5.0, 20.0, 60.0}) {
    auto later = tooth(3, 40, 0, 1001);
    later[70].tip_to.z() += 1e-3 * um;
    later[71].tip_from.z() += 1e-3 * um;
    const auto found = again(first, later);
    ASSERT_FALSE(found.missing);
    EXPECT_GE(found.tip_mm + 1e-9, sampled(first, later));
    EXPECT_GE(found.tip_mm, 0.9e-3 * um) << "across the way to the moved block, which leans";
    EXPECT_LE(found.tip_mm, 1.01e-3 * um + 1e-9);
  }
}

TEST(CutsAgain, WhatCannotCutNeedNotBeMadeAgain) {
  const auto first = tooth(0, 40, 5e-4, 1);
  auto later = tooth(3, 40, 5e-4, 1001);
  later.resize(later.size() / 2);
  const double half = turned(later.back().tip_to, -3 * kPitch).y();
  const proof::FirstTooth known(first, [&](const path::ToolMotion& m) { return m.tip_to.y() < half - 0.05; });
  EXPECT_FALSE(proof::cuts_again(known, later, 3 * kPitch).missing);
}

}  // namespace
}  // namespace toothpath::cuts_again_cases
