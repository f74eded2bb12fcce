// Where a pattern lies on the flank, and which edges it reaches.
#include "geometry/contact/pattern_place.h"

#include <gtest/gtest.h>

#include "tests/support/face_gear_cases.h"
#include "tests/support/modified_flank.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

using contact::Edge;
using modification::Kind;

contact::MisalignedContact contact_of(const face_gear::FaceGear& gear, const contact::Misalignment& moved,
                                      const std::vector<modification::Modification>& on_pinion = {}) {
  auto flank = contact::exact_flank(gear, 0, 1);
  if (!flank) throw std::invalid_argument(flank.error().message);
  auto found = contact::misaligned_contact({&gear, {*flank}, 20, on_pinion}, moved, {}, 0.05);
  if (!found) throw std::invalid_argument(found.error().message);
  return *found;
}

/// The plain pair bears everywhere: on both ends of the face, on the gear's tip and on that of the pinion.
TEST(PatternPlace, ThePlainPairReachesAllEdges) {
  const auto found = contact_of(modified_spur({}), {});
  const auto& place = found.at_edges[0];
  for (const Edge edge : {Edge::inner_end, Edge::outer_end, Edge::tip, Edge::pinion_tip})
    EXPECT_TRUE(place.reaches(edge, 0.006)) << to_string(edge);
  EXPECT_NEAR(place.lead, 0.5, 0.02);
  EXPECT_NEAR(found.margin_gap_mm, 0, 1e-9);
}

/// Crowned along and across: inside, in the middle; a slope moves the pattern towards the end where nothing is taken,
/// an error of the shaft angle as a slope does.
TEST(PatternPlace, CrowningKeepsItInsideAndSlopesMoveIt) {
  const std::vector<modification::Modification> crowned = {modification_of(Kind::lead_crowning, 0.02),
                                                           modification_of(Kind::tip_relief, 0.02, 1.5)};
  const std::vector<modification::Modification> on_pinion = {modification_of(Kind::tip_relief, 0.02, 1.5)};
  const auto middle = contact_of(modified_spur(crowned), {}, on_pinion);
  for (int e = 0; e < contact::kEdges; ++e) EXPECT_FALSE(middle.at_edges[0].reaches(Edge(e), 0.006)) << e;
  EXPECT_GT(middle.margin_gap_mm, 0.006);
  EXPECT_NEAR(middle.at_edges[0].lead, 0.5, 0.03);
  // The marked band of a crowning of 20 um and a compound of 6, (2 v - 1)^2 20 = 6, and where reliefs let a pair lag.
  const double band = middle.at_edges[0].outer - middle.at_edges[0].inner;
  EXPECT_GT(band, std::sqrt(6.0 / 20) - 0.01);
  EXPECT_LT(band, std::sqrt(6.0 / 20) + 0.15);

  auto leaning = crowned;
  leaning.push_back(modification_of(Kind::helix_angle_slope, 0.02));
  const auto sloped = contact_of(modified_spur(leaning), {}, on_pinion);
  // 20 (2 v - 1)^2 + 20 v is least at v = 3/8.
  EXPECT_NEAR(sloped.at_edges[0].lead, 0.375, 0.03);
  // The same 20 um over 5 mm as an error of the shaft angle, in the plane of contact: it moves the pattern, either way.
  const auto less = contact_of(modified_spur(crowned), {0, 0, -0.003}, on_pinion),
             more = contact_of(modified_spur(crowned), {0, 0, 0.003}, on_pinion);
  EXPECT_GT(std::abs(less.at_edges[0].lead - more.at_edges[0].lead), 0.05);
  EXPECT_LT((less.at_edges[0].lead - 0.5) * (more.at_edges[0].lead - 0.5), 0);
}

/// The gap in the margin of an edge is that at its very bound, wherever the rows and columns of the grid lie.
TEST(PatternPlace, MarginsReachToTheirBoundsBetweenThePlaces) {
  constexpr int kRows = 41, kColumns = 21;
  for (const double margin : {0.0, 0.024, 0.05, 0.06, 0.11}) {
    contact::RolledGrid grid{kRows, kColumns, {}, {}, {}};
    // It falls from the edges inwards, as fast from all of them: least at the bounds.
    for (int r = 0; r < kRows; ++r)
      for (int c = 0; c < kColumns; ++c) {
        const double u = double(r) / (kRows - 1), v = double(c) / (kColumns - 1);
        grid.points.emplace_back(u, v, 0);
        grid.gap_mm.push_back(1 - std::min({u, 1 - u, v, 1 - v}));
        grid.margins.push_back(contact::beyond_own_margins(kRows, kColumns, r, c, margin));
      }
    const auto place = contact::pattern_place(grid, 0.2);
    for (const Edge edge : {Edge::inner_end, Edge::outer_end, Edge::tip, Edge::fillet_line}) {
      // Within the margin of one edge others are as far as the middle.
      const double at_bound = 1 - margin;
      EXPECT_NEAR(place.gap_mm[static_cast<std::size_t>(edge)], at_bound, 1e-12) << to_string(edge) << " " << margin;
    }
    for (const Edge edge : {Edge::pinion_tip, Edge::pinion_root})
      EXPECT_EQ(place.gap_mm[static_cast<std::size_t>(edge)], contact::kUnmet);
  }
}

/// Both ends of the pinion's involute have the same margin as its tip has.
TEST(PatternPlace, TheEndsOfThePinionHaveMargins) {
  const auto gear = modified_spur({modification_of(Kind::lead_crowning, 0.02)});
  auto flank = contact::exact_flank(gear, 0, 1, 21, 13);
  ASSERT_TRUE(flank);
  const std::vector<contact::ContactMember> members = {contact::make_member(gear, *flank, 20, {}, {})};
  const auto map = contact::ease_off(members);
  ASSERT_TRUE(map);
  const auto& pinion = members[0].pinion;
  const double depth = 2 * (pinion.r_a - pinion.r_p);
  for (int r = 0; r < 21; ++r)
    for (int c = 0; c < 13; ++c) {
      const double radius = map->maps[0].pinion_across_mm[members[0].flank.index(r, c)];
      if (std::isnan(radius)) continue;
      const auto beyond = contact::beyond_margins(members[0], map->maps[0], r, c, 0.07, 0);
      EXPECT_EQ(radius - pinion.r_b <= 0.07 * depth || beyond[int(Edge::pinion_root)] == 0,
                beyond[int(Edge::pinion_root)] <= 0);
      EXPECT_EQ(pinion.r_a - radius <= 0.07 * depth || beyond[int(Edge::pinion_tip)] == 0,
                beyond[int(Edge::pinion_tip)] <= 0);
      if (beyond[int(Edge::pinion_root)] != 0) {
        EXPECT_NEAR(beyond[int(Edge::pinion_root)], (radius - pinion.r_b) / depth - 0.07, 1e-12);
      }
    }
}

}  // namespace
}  // namespace toothpath::test
