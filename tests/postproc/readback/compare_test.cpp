// The comparison of a program with its path, on motions made by hand: what is met, what is left out, what nobody asked
// for.
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "postproc/readback/reader.h"

namespace toothpath {
namespace {

constexpr double kTolerance = 1e-3;
const Vec3 kAbove(0, 0, 5), kStart(0, 0, 0), kMiddle(5, 0, 0), kEnd(10, 0, 0);

path::ClPath path() {
  path::ClPath p;
  p.records.push_back({kAbove, Vec3::UnitZ(), 0, path::MoveKind::rapid, 0, 0});
  p.records.push_back({kStart, Vec3::UnitZ(), 500, path::MoveKind::engage, 0, 0});
  p.records.push_back({kEnd, Vec3::UnitZ(), 500, path::MoveKind::feed, 0, 0});
  return p;
}

path::ToolMotion motion(const Vec3& from, const Vec3& to, bool rapid = false) {
  path::ToolMotion m;
  m.tip_from = from;
  m.tip_to = to;
  m.axis_from = m.axis_to = Vec3::UnitZ();
  m.rapid = rapid;
  m.minutes = rapid ? 0 : (to - from).norm() / 500;
  m.operation = 0;
  m.tooth = 0;
  return m;
}

/// The program of the path, its last pass by way of `middle`.
std::vector<path::ToolMotion> program(const Vec3& middle = kMiddle) {
  return {motion(Vec3(-20, 0, 5), kAbove, true), motion(kAbove, kStart), motion(kStart, middle), motion(middle, kEnd)};
}

readback::ClComparison compared(const std::vector<path::ToolMotion>& motions) {
  const path::ClPath p = path();
  const std::vector<const path::ClPath*> list = {&p};
  return readback::compare_with_cl(motions, list, kTolerance, 1e-3);
}

TEST(CompareWithCl, BlocksBetweenRecordsStayOnTheChord) {
  for (const double off : {0.0, 0.2, 0.9}) {
    const auto met = compared(program(kMiddle + Vec3(0, off * kTolerance, 0)));
    EXPECT_TRUE(met.complete) << met.message;
    EXPECT_NEAR(met.worst_extra_mm, off * kTolerance, 1e-12);
  }
  for (const double off : {1.1, 2.0, 100.0}) {
    const auto left = compared(program(kMiddle + Vec3(0, off * kTolerance, 0)));
    EXPECT_FALSE(left.complete) << off;
    EXPECT_EQ(left.missed_record, 2u);
    EXPECT_NE(left.message.find("a block leaves the path before this record"), std::string::npos) << left.message;
  }
}

TEST(CompareWithCl, EveryRecordIsMetWithinTheTolerance) {
  for (std::size_t k = 0; k < 4; ++k)
    for (const double off : {0.9, 1.1}) {
      if (k == 2) continue;  // the middle is no record
      auto motions = program();
      motions[k].tip_to += Vec3(0, 0, off * kTolerance);
      const auto met = compared(motions);
      EXPECT_EQ(met.complete, off < 1) << k << " " << met.message;
      EXPECT_NEAR(met.worst_mm, off < 1 || k > 0 ? off * kTolerance : 0, 1e-12) << k;
    }
  const auto whole = program();
  auto turned = whole;
  turned[3].axis_to = Vec3(2e-3, 0, 1).normalized();
  EXPECT_FALSE(compared(turned).complete);
  EXPECT_FALSE(compared(std::vector<path::ToolMotion>(whole.begin(), whole.begin() + 3)).complete);
}

TEST(CompareWithCl, NothingIsCutBehindTheLastRecord) {
  auto motions = program();
  motions.push_back(motion(kEnd, kAbove, true));
  EXPECT_TRUE(compared(motions).complete);
  motions.push_back(motion(kAbove, kStart));
  const auto more = compared(motions);
  EXPECT_FALSE(more.complete);
  EXPECT_NE(more.message.find("the program feeds on behind the last record"), std::string::npos) << more.message;
}

TEST(CompareWithCl, TheFastestBlockIsTold) {
  EXPECT_NEAR(compared(program()).fastest_ratio, 1, 1e-12);
  auto motions = program();
  for (std::size_t k : {2, 3}) motions[k].minutes /= 3;
  EXPECT_NEAR(compared(motions).fastest_ratio, 3, 1e-12);
}

/// A path whose steps are about as long as the last digit of its words: the program of it, rounded, with blocks left
/// out that change no word.
struct FineWalk {
  path::ClPath path;
  std::vector<path::ToolMotion> motions;
};
FineWalk fine_walk(std::mt19937_64& random, bool back_and_forth) {
  constexpr double kGrid = 1e-3;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share(0, 1);
  FineWalk w;
  w.path.records.push_back({kAbove, Vec3::UnitZ(), 0, path::MoveKind::rapid, 0, 0});
  w.motions.push_back(motion(Vec3(-20, 0, 5), kAbove, true));
  Vec3 at = kStart, last(0, 0, 0);
  for (int k = 0; k < 60; ++k) {
    const Vec3 step = Vec3(normal(random), normal(random), normal(random)) * 1e-3;
    const bool back = back_and_forth && k > 1 && share(random) < 0.4;
    if (back) at = w.path.records[w.path.records.size() - 2].tip + 0.2 * step;
    else at += share(random) < 0.1 ? Vec3(50 * step) : step;
    w.path.records.push_back({at, Vec3::UnitZ(), 500, path::MoveKind::feed, 0, 0});
    const Vec3 word = (at / kGrid).array().round() * kGrid;
    if (k > 0 && word == w.motions.back().tip_to) continue;
    w.motions.push_back(motion(w.motions.back().tip_to, word));
  }
  return w;
}

// Records nearer to each other than the last digit: each is met by the block that was made for it, not by a later one
// that comes as near.
TEST(CompareWithCl, PathsAsFineAsTheirRoundingAreMet) {
  constexpr double kHalfDigit = 0.8661e-3;  // half a digit in each of three words
  std::mt19937_64 random(7);
  int sharp = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const FineWalk w = fine_walk(random, trial % 2 == 1);
    const std::vector<const path::ClPath*> list = {&w.path};
    const auto met = readback::compare_with_cl(w.motions, list, kHalfDigit, 1e-3);
    ASSERT_TRUE(met.complete) << trial << ": " << met.message;
    EXPECT_LE(met.worst_mm, kHalfDigit);
    // A block that is 4 um off is seen, whatever lies around it.
    auto wrong = w.motions;
    const std::size_t k = 1 + random() % (wrong.size() - 1);
    wrong[k].tip_to += Vec3(0, 0, 4e-3);
    if (k + 1 < wrong.size()) wrong[k + 1].tip_from = wrong[k].tip_to;
    sharp += readback::compare_with_cl(wrong, list, kHalfDigit, 1e-3).complete ? 0 : 1;
  }
  EXPECT_GT(sharp, 3900);
}

}  // namespace
}  // namespace toothpath
