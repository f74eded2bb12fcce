// Teeth that are written out one by one: which are the first one again, and what the first one then stands for.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "app/process/tooth_copies.h"
#include "geometry/base/angle.h"

namespace toothpath {
namespace {

constexpr int kTeeth = 12;
constexpr double kTolerance = 5e-4;

Vec3 turned(const Vec3& v, double angle) { return Eigen::AngleAxisd(angle, Vec3::UnitZ()) * v; }

/// A block of a tooth in pieces of equal time along a bend.
void add_block(std::vector<path::ToolMotion>& out, int operation, int tooth, int line, int pieces,
               const Vec3& off = Vec3::Zero()) {
  const double angle = 2 * kPi * tooth / kTeeth;
  const auto at = [&](double t) -> Vec3 {
    const double u = 0.1 * line + 0.1 * t;
    return turned(Vec3(50 + u, 3 * u, -u), angle) + off;
  };
  for (int k = 0; k < pieces; ++k) {
    path::ToolMotion m;
    m.tip_from = at(static_cast<double>(k) / pieces);
    m.tip_to = at(static_cast<double>(k + 1) / pieces);
    m.axis_from = m.axis_to = turned(Vec3(0.6, 0, 0.8), angle);
    m.deviation_mm = 1e-5 * (tooth + 1);
    m.axis_deviation = 1e-6 * (tooth + 1);
    m.minutes = 0.01 / pieces;
    m.operation = operation;
    m.tooth = tooth;
    m.line = 1000 * (operation * kTeeth + tooth) + line;
    out.push_back(m);
  }
}

std::vector<path::ToolMotion> program(int operations, int pieces_of_copies) {
  std::vector<path::ToolMotion> out;
  for (int op = 0; op < operations; ++op)
    for (int tooth = 0; tooth < kTeeth; ++tooth)
      for (int line = 1; line <= 6; ++line) add_block(out, op, tooth, line, tooth == 0 ? 2 : pieces_of_copies);
  return out;
}

std::set<int> teeth_of(const std::vector<path::ToolMotion>& motions) {
  std::set<int> teeth;
  for (const auto& m : motions) teeth.insert(m.tooth);
  return teeth;
}

TEST(ToothCopies, TheFirstToothStandsForAllHoweverTheirBlocksAreCut) {
  for (const int pieces : {1, 2, 3, 7}) {
    const auto kept = process::without_copies(program(2, pieces), kTeeth, kTolerance);
    EXPECT_EQ(teeth_of(kept), std::set<int>{0}) << pieces;
    for (const auto& m : kept) {
      EXPECT_GE(m.deviation_mm, 1e-5 * kTeeth) << "as far as the last tooth may stray";
      EXPECT_LT(m.deviation_mm, 1e-5 * kTeeth + 1e-9);
      EXPECT_GE(m.axis_deviation, 1e-6 * kTeeth);
      EXPECT_LT(m.axis_deviation, 1e-6 * kTeeth + 1e-14);
    }
  }
}

TEST(ToothCopies, TheirDistanceIsAdded) {
  auto motions = program(1, 3);
  std::vector<path::ToolMotion> moved;
  for (const auto& m : motions)
    if (m.tooth != 4) moved.push_back(m);
  for (int line = 1; line <= 6; ++line) add_block(moved, 0, 4, line, 3, line == 3 ? Vec3(0, 0, 4e-4) : Vec3::Zero());
  const auto kept = process::without_copies(moved, kTeeth, kTolerance);
  EXPECT_EQ(teeth_of(kept), std::set<int>{0});
  for (const auto& m : kept) EXPECT_GE(m.deviation_mm, 4e-4 + 1e-5 * 5 - 1e-12);
}

// An axis that is turned moves what is far from the tip; the tip and the walls near it are where they were.
TEST(ToothCopies, TheTurnOfTheirAxesIsAddedToTheAxis) {
  auto motions = program(1, 3);
  for (auto& m : motions)
    if (m.tooth == 4)
      for (Vec3* axis : {&m.axis_from, &m.axis_to}) *axis = turned(*axis, 6e-7);
  const auto kept = process::without_copies(motions, kTeeth, kTolerance);
  EXPECT_EQ(teeth_of(kept), std::set<int>{0});
  for (const auto& m : kept) {
    EXPECT_LT(m.deviation_mm, 1e-5 * kTeeth + 1e-9);
    EXPECT_GE(m.axis_deviation, 0.6 * 6e-7 + 1e-6 * 5 - 1e-12);
  }
}

TEST(ToothCopies, WhatDiffersAnywhereIsKeptWithAllItsOperations) {
  const auto with_tooth_4 = [](const std::function<void(std::vector<path::ToolMotion>&)>& change) {
    std::vector<path::ToolMotion> motions;
    for (const auto& m : program(2, 3))
      if (m.tooth != 4 || m.operation != 1) motions.push_back(m);
    change(motions);
    return teeth_of(process::without_copies(motions, kTeeth, kTolerance));
  };
  const std::set<int> first{0}, both{0, 4};
  const auto blocks = [](std::vector<path::ToolMotion>& motions, int line_moved, const Vec3& off, int lines) {
    for (int line = 1; line <= lines; ++line)
      add_block(motions, 1, 4, line, 3, line == line_moved ? off : Vec3::Zero());
  };
  EXPECT_EQ(with_tooth_4([&](auto& m) { blocks(m, 0, Vec3::Zero(), 6); }), first);
  EXPECT_EQ(with_tooth_4([&](auto& m) { blocks(m, 5, Vec3(0, 6e-4, 0), 6); }), both) << "one block beside its place";
  EXPECT_EQ(with_tooth_4([&](auto& m) { blocks(m, 0, Vec3::Zero(), 5); }), both) << "a block is missing";
  EXPECT_EQ(with_tooth_4([&](auto& m) { blocks(m, 0, Vec3::Zero(), 7); }), both) << "a block more";
  EXPECT_EQ(with_tooth_4([](auto&) {}), both) << "an operation does not cut it";
  // A place between the ends of the pieces of the first tooth.
  EXPECT_EQ(with_tooth_4([&](auto& m) {
              blocks(m, 0, Vec3::Zero(), 6);
              path::ToolMotion &a = m[m.size() - 3], &b = m[m.size() - 2];
              a.tip_to.z() += 6e-4;
              b.tip_from.z() += 6e-4;
            }),
            both);
  // The axis alone: at the holder it counts a thousandfold.
  EXPECT_EQ(with_tooth_4([&](auto& m) {
              blocks(m, 0, Vec3::Zero(), 6);
              m.back().axis_to = (m.back().axis_to + Vec3(0, 1e-6, 0)).normalized();
            }),
            both);
}

// A tooth that is no copy cuts all that the first one does, or it is told what it lacks.
TEST(ToothCopies, WhatAToothLacksIsTold) {
  const auto found = [](const std::vector<path::ToolMotion>& motions) {
    return process::cuts_of_other_teeth(motions, kTeeth, kTolerance, [](const auto&) { return true; });
  };
  EXPECT_TRUE(found(program(2, 3)).empty());
  std::vector<path::ToolMotion> motions;
  for (const auto& m : program(2, 3))
    if (m.tooth != 4 || (m.operation == 0 && m.line % 1000 != 3)) motions.push_back(m);
  const auto others = found(motions);
  ASSERT_EQ(others.size(), 2U);
  EXPECT_EQ(others[0].tooth, 4);
  EXPECT_FALSE(others[0].cuts_nothing());
  EXPECT_EQ(others[0].again.missing->line, 3);
  EXPECT_EQ(others[0].again.missing->behind_line, 4002);
  EXPECT_EQ(told(others[0]).find("tooth 4: the cut of line 3, tooth 0, is not made again behind line 4002"), 0U)
      << told(others[0]);
  EXPECT_EQ(others[1].operation, 1);
  EXPECT_TRUE(others[1].cuts_nothing());
}

TEST(ToothCopies, RapidsAreKept) {
  auto motions = program(1, 2);
  for (auto& m : motions)
    if (m.line % 1000 == 1) m.rapid = true;
  const auto kept = process::without_copies(motions, kTeeth, kTolerance);
  EXPECT_EQ(teeth_of(kept).size(), std::size_t{kTeeth});
  EXPECT_EQ(kept.size(), std::size_t{2 * kTeeth + 10});
}

/// Least distance of a tip from a stretch of motions.
double off(const Vec3& tip, const std::vector<path::ToolMotion>& motions, const proof::LikeMotion& like) {
  double least = INFINITY;
  for (std::size_t k = like.like_first; k < like.like_last; ++k)
    least = std::min(least, distance_to_segment(tip, motions[k].tip_from, motions[k].tip_to));
  return least;
}

TEST(LikeMotions, AreFoundHoweverTheWayIsCut) {
  for (const int lines : {5, 6, 9, 17}) {
    // One way in any number of straight pieces, each tooth rounded a little otherwise.
    const auto way = [&](int tooth, int count) {
      std::vector<path::ToolMotion> out;
      const auto at = [&](int k) -> Vec3 {
        const double u = 2.0 * k / count, noise = 1e-3 * std::sin(17.0 * k + tooth);
        return turned(Vec3(50 + u, 0.02 * u * u + noise, -u - noise), 2 * kPi * tooth / kTeeth);
      };
      for (int k = 0; k < count; ++k) {
        path::ToolMotion m;
        m.tip_from = at(k);
        m.tip_to = at(k + 1);
        m.axis_from = m.axis_to = turned(Vec3(0.6, 0, 0.8), 2 * kPi * tooth / kTeeth);
        m.deviation_mm = 1e-5;
        m.tooth = tooth;
        m.line = 100 * tooth + k;
        out.push_back(m);
      }
      return out;
    };
    std::vector<path::ToolMotion> motions = way(0, 7);
    for (const auto& [tooth, count] : {std::pair{3, lines}, std::pair{5, lines + 1}}) {
      const auto more = way(tooth, count);
      motions.insert(motions.end(), more.begin(), more.end());
    }
    const auto likes = process::like_motions(motions, kTeeth);
    ASSERT_EQ(likes.size(), motions.size() - 7) << lines;
    double largest = 0;
    for (const auto& like : likes) {
      const path::ToolMotion& m = motions[like.motion];
      largest = std::max(largest, double(like.tip_mm));
      EXPECT_LE(like.like_last, 7u);
      for (int n = 0; n <= 20; ++n) {
        const Vec3 tip = turned(path::tip_at(m, n / 20.0), -2 * kPi * m.tooth / kTeeth);
        EXPECT_LE(off(tip, motions, like), double(like.tip_mm)) << "motion " << like.motion;
      }
    }
    EXPECT_GT(largest, 1e-4);
    EXPECT_LT(largest, 0.01) << "no more than roundings and chords";
  }
}

TEST(LikeMotions, WhatGoesElsewhereIsNot) {
  auto motions = program(1, 2);
  for (auto& m : motions)
    if (m.tooth == 4 && (m.line % 1000 == 3)) {
      m.tip_from.z() += 0.3;
      m.tip_to.z() += 0.3;
    } else if (m.tooth == 5 && m.line % 1000 == 4) {
      m.axis_to = (m.axis_to + Vec3(0, 2e-4, 0)).normalized();
    } else if (m.tooth == 6) {
      m.rapid = true;
    }
  std::set<std::pair<int, int>> others;  // tooth, line
  for (const auto& m : motions)
    if (m.tooth != 0) others.insert({m.tooth, m.line % 1000});
  for (const auto& like : process::like_motions(motions, kTeeth)) {
    EXPECT_NE(motions[like.motion].tooth, 0);
    others.erase({motions[like.motion].tooth, motions[like.motion].line % 1000});
  }
  EXPECT_EQ(others, (std::set<std::pair<int, int>>{{4, 3}, {5, 4}, {6, 1}, {6, 2}, {6, 3}, {6, 4}, {6, 5}, {6, 6}}));
}

TEST(LikeMotions, StrayingCounts) {
  auto motions = program(1, 1);
  for (auto& m : motions) {
    m.deviation_mm = m.tooth == 2 ? 5e-4 : 1e-4;
    m.axis_deviation = m.tooth == 2 ? 5e-6 : 1e-6;
  }
  for (const auto& like : process::like_motions(motions, kTeeth)) {
    const bool strays = motions[like.motion].tooth == 2;
    EXPECT_NEAR(double(like.tip_mm), strays ? 4e-4 : 0, 1e-8);
    EXPECT_NEAR(double(like.axis_rad), strays ? 4e-6 : 0, 1e-10);
  }
}

/// What is kept of a program that comes tooth by tooth, and what of it is like the first teeth.
struct Kept {
  std::vector<path::ToolMotion> motions;
  std::vector<proof::LikeMotion> likes;
  process::Stated stated;
  std::vector<process::ToothCut> others;
  int times = 0;  ///< that all teeth were seen
};
Kept one_by_one(const std::vector<path::ToolMotion>& motions, std::optional<double> tolerance_mm) {
  std::vector<std::vector<path::ToolMotion>> stretches;
  for (const auto& m : motions) {
    if (stretches.empty() || stretches.back().back().operation != m.operation ||
        stretches.back().back().tooth != m.tooth)
      stretches.emplace_back();
    stretches.back().push_back(m);
  }
  std::set<int> begun;
  std::vector<bool> first;
  for (const auto& stretch : stretches) first.push_back(begun.insert(stretch.front().operation).second);
  process::ToothByTooth teeth(kTeeth, tolerance_mm, [](const auto&) { return true; });
  Kept kept;
  do {
    for (std::size_t n = 0; n < stretches.size(); ++n)
      if (first[n]) teeth.first(stretches[n]);
      else teeth.note(teeth.seen(stretches[n]));
    ++kept.times;
  } while (!teeth.settle());
  std::size_t firsts = 0, shift = 0;
  for (std::size_t n = 0; n < stretches.size(); ++n) {
    auto& stretch = stretches[n];
    if (first[n]) {
      const auto as_kept = teeth.first_of(stretch.front().operation);
      stretch.assign(as_kept.begin(), as_kept.end());
      shift = kept.motions.size() - firsts;
      firsts += stretch.size();
    } else {
      if (teeth.left_out(stretch.front().tooth))
        std::erase_if(stretch, [](const path::ToolMotion& m) { return !m.rapid; });
      for (auto like : teeth.likes(stretch)) {
        like.motion += std::uint32_t(kept.motions.size());
        like.like_first += std::uint32_t(shift);
        like.like_last += std::uint32_t(shift);
        kept.likes.push_back(like);
      }
    }
    kept.motions.insert(kept.motions.end(), stretch.begin(), stretch.end());
  }
  kept.stated = teeth.stated();
  kept.others = teeth.other_teeth();
  return kept;
}

/// As of the whole program at once.
void expect_as_a_whole(const std::vector<path::ToolMotion>& motions, int times, const char* what,
                       std::optional<double> tolerance_mm = kTolerance) {
  const Kept kept = one_by_one(motions, tolerance_mm);
  EXPECT_EQ(kept.times, times) << what;
  const auto whole = tolerance_mm ? process::without_copies(motions, kTeeth, *tolerance_mm) : motions;
  ASSERT_EQ(kept.motions.size(), whole.size()) << what;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    ASSERT_EQ(kept.motions[k].line, whole[k].line) << what;
    ASSERT_EQ(kept.motions[k].rapid, whole[k].rapid) << what;
    ASSERT_EQ(kept.motions[k].deviation_mm, whole[k].deviation_mm) << what << ", motion " << k;
    ASSERT_EQ(kept.motions[k].axis_deviation, whole[k].axis_deviation) << what << ", motion " << k;
  }
  const auto stated = process::stated_deviation(whole);
  EXPECT_EQ(kept.stated.tip_mm, stated.tip_mm) << what;
  EXPECT_EQ(kept.stated.axis_rad, stated.axis_rad) << what;
  const auto others = process::cuts_of_other_teeth(motions, kTeeth, tolerance_mm, [](const auto&) { return true; });
  ASSERT_EQ(kept.others.size(), others.size()) << what;
  for (std::size_t k = 0; k < others.size(); ++k) {
    ASSERT_EQ(kept.others[k].operation, others[k].operation) << what;
    ASSERT_EQ(kept.others[k].tooth, others[k].tooth) << what;
    ASSERT_EQ(kept.others[k].cuts_nothing(), others[k].cuts_nothing()) << what;
    ASSERT_EQ(kept.others[k].again.away(10), others[k].again.away(10)) << what;
    ASSERT_EQ(kept.others[k].again.missing.has_value(), others[k].again.missing.has_value()) << what;
    if (others[k].again.missing) {
      ASSERT_EQ(kept.others[k].again.missing->line, others[k].again.missing->line) << what;
    }
  }
  const auto likes = process::like_motions(whole, kTeeth);
  ASSERT_EQ(kept.likes.size(), likes.size()) << what;
  for (std::size_t k = 0; k < likes.size(); ++k) {
    ASSERT_EQ(kept.likes[k].motion, likes[k].motion) << what;
    ASSERT_EQ(kept.likes[k].like_first, likes[k].like_first) << what;
    ASSERT_EQ(kept.likes[k].like_last, likes[k].like_last) << what;
    ASSERT_EQ(kept.likes[k].tip_mm, likes[k].tip_mm) << what;
    ASSERT_EQ(kept.likes[k].axis_rad, likes[k].axis_rad) << what;
  }
}

TEST(ToothByTooth, SaysWhatIsSaidOfTheWholeProgram) {
  const auto changed = [](const std::function<bool(const path::ToolMotion&)>& at,
                          const std::function<void(path::ToolMotion&)>& change) {
    auto motions = program(3, 3);
    for (auto& m : motions)
      if (at(m)) change(m);
    return motions;
  };
  const auto lifted = [](path::ToolMotion& m) { m.tip_to.z() += 0.01, m.tip_from.z() += 0.01; };
  expect_as_a_whole(program(3, 3), 1, "all are copies");
  expect_as_a_whole(program(1, 7), 1, "one operation");
  expect_as_a_whole(program(3, 3), 1, "no tooth is left out", std::nullopt);
  expect_as_a_whole(changed([](const auto& m) { return m.tooth > 0; }, lifted), 1, "none is a copy");
  expect_as_a_whole(changed([](const auto& m) { return m.tooth == 5; }, lifted), 1, "one is none");
  expect_as_a_whole(changed([](const auto& m) { return m.tooth == 5 && m.operation == 1; }, lifted), 2,
                    "one is none in one operation: what it states in the others must not count");
  expect_as_a_whole(changed([](const auto& m) { return m.tooth == 11 && m.operation == 2; },
                            [](path::ToolMotion& m) { m.tip_to.z() += 1, m.tip_from.z() += 1; }),
                    2, "one goes elsewhere");
  expect_as_a_whole(changed([](const auto& m) { return m.line % 1000 == 1 || (m.tooth == 3 && m.operation == 0); },
                            [](path::ToolMotion& m) { m.rapid = true; }),
                    2, "rapids, and a tooth that is not cut");
}

// Where no copy is left out every cut of the later teeth is followed beside the first one, and none is proven anew.
TEST(ToothByTooth, AllOfThemAreFollowedBesideTheFirst) {
  const Kept kept = one_by_one(program(2, 2), std::nullopt);
  EXPECT_EQ(kept.motions.size(), program(2, 2).size());
  EXPECT_EQ(kept.likes.size(), kept.motions.size() / kTeeth * (kTeeth - 1));
  for (const auto& like : kept.likes) EXPECT_LT(like.tip_mm, 1e-5 * kTeeth + 1e-9);  // what the motions state
}

}  // namespace
}  // namespace toothpath
