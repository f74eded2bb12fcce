// Points of exact gears in any order come back as the grids that they were; what is no grid is refused at its place.
#include "geometry/flank_grid/point_order.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "geometry/base/angle.h"
#include "tests/geometry/flank_grid/samples.h"

namespace toothpath::test {
namespace {

using flank_grid::LoosePoint;
using Loose = std::vector<LoosePoint>;

/// All points in the order flank 1, flank -1, row, column; line k + 1 is that of point k.
Loose loose(const flank_grid::FlankGridParameters& gear, bool normals) {
  Loose out;
  for (const int side : {1, -1})
    for (std::size_t k = 0; k < gear.points(side).place.size(); ++k) {
      out.push_back({gear.points(side).place[k], {}, {"p.csv", int(out.size()) + 1, 1}, 0});
      if (normals) out.back().n = gear.points(side).normal[k];
    }
  return out;
}

Loose shuffled(Loose points, unsigned seed) {
  std::mt19937 random(seed);
  std::shuffle(points.begin(), points.end(), random);
  return points;
}

flank_grid::FlankGridParameters bevel(const Sampling& ask) { return sampled(khk_pinion(), ask); }

void expect_same(const flank_grid::FlankGridParameters& gear, unsigned seed) {
  for (const bool normals : {true, false}) {
    const auto ordered = order_points(shuffled(loose(gear, normals), seed));
    ASSERT_TRUE(ordered) << ordered.error().text();
    for (const int side : {1, -1}) {
      const auto& found = side > 0 ? ordered->plus : ordered->minus;
      EXPECT_EQ(found.rows, gear.points(side).rows);
      EXPECT_EQ(found.place, gear.points(side).place) << normals;
      EXPECT_EQ(found.normal.size(), normals ? found.place.size() : 0u);
      EXPECT_EQ(found.line[1], side > 0 ? 2 : 2 + int(found.place.size()));
    }
  }
}

TEST(PointOrder, FindsTheGridsOfExactGears) {
  for (const auto& [rows, columns] : {std::pair(4, 4), {5, 9}, {9, 17}, {33, 65}, {25, 5}}) {
    SCOPED_TRACE(rows);
    // Stations of bevels run from the large end, columns of the grid from the small one.
    expect_same(bevel({rows, columns, 0.8, true, 0.3}), unsigned(rows));
    expect_same(sampled(shifted_spur(), {rows, columns, 1.2, true}), unsigned(columns));
  }
  expect_same(sampled(left_helical(), {9, 13, 1.2, true, -2}), 3);
}

TEST(PointOrder, RefusesWhatIsNoGridAtItsPlace) {
  const Loose good = loose(bevel({7, 9, 0.8, true}), true);
  constexpr std::size_t kFlank = 63, kColumns = 9;
  const double pitch = kTwoPi / khk_pinion().teeth;
  struct Spoilt {
    std::function<void(Loose&)> spoil;
    const char* with_normals;  ///< a part of the refusal; null: it is none
    const char* without;
  };
  const auto gone = [](std::size_t from, std::size_t count = 1) {
    return [=](Loose& p) { p.erase(p.begin() + std::ptrdiff_t(from), p.begin() + std::ptrdiff_t(from + count)); };
  };
  constexpr const char *kInner =
                           "flank 1: row 2, column 3 of 7 rows x 9 columns, which count from 0, is missing, next to",
                       *kCorner = "flank -1: row 6, column 8 of 7 rows x 9 columns",
                       *kRow = "of flank 1 the row next to row 3 of the other",
                       *kLess = "of flank 1 the row next to row 0 of the other", *kTwice = "the point (",
                       *kTooth = "they bound a tooth, not a space";
  const Spoilt cases[] = {
      {gone(2 * kColumns + 3), kInner, kInner},
      {gone(2 * kFlank - 1), kCorner, kCorner},
      {gone(3 * kColumns, kColumns), kRow, kRow},
      {gone(0, kColumns), kLess, kLess},
      {[](Loose& p) { p.push_back(p[20]); }, kTwice, kTwice},
      {[](Loose& p) {
         p.push_back(p[20]);
         p.back().p.z() += 0.01;
       },
       "doubled, or off its row", "doubled, or off its row"},
      {[](Loose& p) { p[30].p += 0.8 * (p[31].p - p[30].p) + 0.8 * (p[30 + kColumns].p - p[30].p); },
       "flank 1: ", "flank 1: "},
      {[](Loose& p) { p[30].p = turned(p[30].p, 0.02); }, "of the space's width beside both flanks",
       "of the space's width beside both flanks"},
      {[](Loose& p) {
         for (LoosePoint& one : p)
           if (one.n) one.n = -*one.n;
       },
       "point into the material", nullptr},
      {[pitch](Loose& p) {
         for (std::size_t k = kFlank; k < 2 * kFlank; ++k) {
           p[k].p = turned(p[k].p, -pitch);
           if (p[k].n) p[k].n = turned(*p[k].n, -pitch);
         }
       },
       "the flanks bound a tooth, not a space", kTooth},
      {gone(kFlank, kFlank), "flank -1 has no grid", "beside both flanks"},
      {[](Loose& p) {
         for (std::size_t k = 0; k < p.size(); ++k) p[k].flank = k < kFlank ? -1 : 1;
       },
       "the two are swapped", "the two are swapped"},
      {[](Loose& p) { p.resize(18); }, "18 points are no two flanks", "18 points are no two flanks"},
  };
  unsigned seed = 0;
  for (const Spoilt& one : cases)
    for (const bool normals : {true, false}) {
      SCOPED_TRACE(testing::Message() << "case " << &one - cases << " normals " << normals);
      Loose points = good;
      one.spoil(points);
      if (!normals)
        for (LoosePoint& point : points) point.n.reset();
      const auto ordered = order_points(shuffled(points, ++seed));
      const char* wanted = normals ? one.with_normals : one.without;
      ASSERT_EQ(ordered.has_value(), wanted == nullptr);
      if (!wanted) continue;
      EXPECT_NE(ordered.error().text().find(wanted), std::string::npos) << ordered.error().text();
      EXPECT_GT(ordered.error().position.line, 0);
    }
}

TEST(PointOrder, TeethMayPointEitherWayAlongTheAxis) {
  flank_grid::FlankGridParameters gear = bevel({6, 8, 0.8, true});
  for (const int side : {1, -1}) {
    auto& grid = side > 0 ? gear.plus : gear.minus;
    for (Vec3& p : grid.place) p.z() = 150 - p.z();
    for (Vec3& n : grid.normal) n.z() = -n.z();
  }
  for (const bool normals : {true, false}) {
    const auto ordered = order_points(shuffled(loose(gear, normals), 5));
    ASSERT_TRUE(ordered) << ordered.error().text();
    EXPECT_GT(radius(ordered->plus.place[ordered->plus.index(5, 0)]), radius(ordered->plus.place[0]));
  }
}

TEST(PointOrder, ARowThatBothFlanksLackIsSeenByTheStepsBesideIt) {
  Loose points = loose(sampled(left_helical(), {9, 7, 1.2, true}), false);
  for (const int from : {9 * 7 + 3, 3})  // column 3 of both
    for (int row = 8; row >= 0; --row) points.erase(points.begin() + from + 7 * row);
  const auto ordered = order_points(points);
  ASSERT_FALSE(ordered);
  EXPECT_NE(ordered.error().message.find("columns 2 and 3 are "), std::string::npos) << ordered.error().text();
  EXPECT_NE(ordered.error().message.find("a column is missing between them"), std::string::npos);
}

TEST(PointOrder, ThreeRowsAreNoGrid) {
  const auto three = order_points(loose(sampled(shifted_spur(), {3, 17, 1.2, true}), true));
  ASSERT_FALSE(three);
  EXPECT_NE(three.error().message.find("3 rows and 17 columns of points, 4 to 400"), std::string::npos)
      << three.error().text();
}

TEST(PointOrder, TipAndRootFollowFromThePoints) {
  const auto gear = sampled(shifted_spur(), {9, 7, 1.2, true});
  const auto ordered = order_points(loose(gear, true));
  ASSERT_TRUE(ordered);
  const flank_grid::MeridianProposal meridians(*ordered);
  for (std::size_t end = 0; end < 2; ++end) EXPECT_LT((meridians.tip()[end] - gear.tip[end]).norm(), 1e-9);
  // A ball that touches the first rows stands on the root that is proposed for it.
  for (const double rho : {0.5, 1.2}) EXPECT_NEAR(meridians.fillet_radius_mm(meridians.root(rho)), rho, 1e-9);
}

/// Ends that are no parallels are proposed as their columns lean; grids over lines that bend are put into order.
TEST(PointOrder, EndsFollowTheOutermostColumns) {
  const auto part = straight_bevel::part_of(straight_bevel::StraightBevelGear::make(khk_pinion()).value());
  for (const auto& [rows, columns] : {std::pair{5, 9}, {9, 17}}) {
    const auto gear =
        sampled(part->space(0), khk_pinion().teeth, {rows, columns, 0.75, true}, {0.12, -0.1, 0.03, 0, 0});
    expect_same(gear, 5);
    const auto ordered = order_points(loose(gear, true));
    ASSERT_TRUE(ordered) << ordered.error().text();
    const flank_grid::MeridianProposal meridians(*ordered);
    EXPECT_LT((meridians.tip().front() - gear.tip.front()).norm(), 1e-6);
    EXPECT_LT((meridians.tip().back() - gear.tip.back()).norm(), 1e-6);
    const auto root = meridians.root(0.75);
    const Vec2 a = meridians.tip().front() - root.front(), b = gear.tip.front() - gear.root.front();
    EXPECT_LT(std::abs(a.normalized().dot(Vec2(-b.y(), b.x()).normalized())), 1e-6);
  }
}

}  // namespace
}  // namespace toothpath::test
