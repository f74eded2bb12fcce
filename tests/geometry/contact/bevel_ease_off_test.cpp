// The ease-off of a bevel pair against solid mills swept by the words, removals that add, mirrored pairs, patterns.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/contact/bevel_pattern_place.h"
#include "tests/geometry/bevel_gear/samples.h"
#include "tests/support/brute_force_bevel_gear.h"
#include "tests/support/modified_flank.h"

namespace toothpath {
namespace {

using namespace bevel_test;
using contact::Edge;
using contact::Misalignment;
using modification::Kind;
using modification::Modification;

bevel_gear::BevelGearParameters with(bevel_gear::BevelGearParameters p, std::vector<Modification> modifications) {
  p.modifications = std::move(modifications);
  return p;
}

contact::BevelEaseOff map_of(const bevel_gear::BevelGear& pinion, const bevel_gear::BevelGear& wheel, int sigma,
                             int rows, int columns, const Misalignment& moved = {}) {
  const auto pair = contact::BevelPair::make(pinion, wheel, contact::assembly_of(moved));
  if (!pair) throw std::invalid_argument(pair.error().message);
  auto found = contact::bevel_ease_off(*pair, sigma, rows, columns);
  if (!found) throw std::invalid_argument(found.error().message);
  return std::move(*found);
}

/// A pair of solids: the wheel's wall as the azimuths that its swept mill leaves, the pinion as the mill itself along
/// its passes. The place is brought over by coordinates along pitch line, normal and tangent.
class SweptPair {
 public:
  SweptPair(const bevel_gear::BevelGearParameters& pinion, const bevel_gear::BevelGearParameters& wheel,
            const Misalignment& moved)
      : pinion_(pinion, {3.0, 0.9, 4.1, 4.8}),
        wheel_(wheel, {3.0, 0.6, 4.1, 4.8}),
        moved_(moved),
        ratio_(double(wheel.teeth) / pinion.teeth) {}

  /// Least distance of a place of the wheel's wall to the pinion's at the exact ratio, square to the pinion's; NaN
  /// where the pinion's tip ends before.
  [[nodiscard]] double least(int sigma, double ell, double height) const {
    const Vec3 p = wheel_.place(ell, wheel_.wall(sigma, ell, height), height);
    const double middle = -std::atan2(p.y(), p.x());
    constexpr double kTip = 4.1, kNothing = 1;
    const auto gap = [&](double phi_2) {
      const Vec3 q = in_space(sigma, p, phi_2);
      return pinion_.height_of(q) > kTip ? kNothing : -pinion_.clearance(q);
    };
    double at = 0;
    const double found = test::least_of(gap, middle - 1.1 * wheel_.pitch(), middle + 1.1 * wheel_.pitch(), 45, &at);
    return gap(at - 1e-4) == kNothing || gap(at + 1e-4) == kNothing ? NAN : found;
  }

 private:
  [[nodiscard]] Vec3 in_space(int sigma, const Vec3& p, double phi_2) const {
    const double s1 = std::sin(pinion_.pitch_angle()), c1 = std::cos(pinion_.pitch_angle()),
                 s2 = std::sin(wheel_.pitch_angle()), c2 = std::cos(wheel_.pitch_angle());
    const auto turned = [](const Vec3& v, double a) {
      return Vec3(std::cos(a) * v.x() - std::sin(a) * v.y(), std::sin(a) * v.x() + std::cos(a) * v.y(), v.z());
    };
    Vec3 w = turned(p, phi_2);
    w.z() += moved_.gear_axial_mm;  // away from the apex along its own axis, which does not turn
    const double along = s2 * w.x() + c2 * w.z(), out = c2 * w.x() - s2 * w.z(), across = -w.y();
    Vec3 q(s1 * along - c1 * out, across, c1 * along + s1 * out);
    // The angle between the axes grows by a turn about the tangent, the pinion's axis stands still.
    const double a = moved_.angle_rad;
    q = Vec3(std::cos(a) * q.x() + std::sin(a) * q.z(), q.y(), std::cos(a) * q.z() - std::sin(a) * q.x());
    q.y() += moved_.offset_mm;
    q.z() -= moved_.axial_mm;
    return turned(q, phi_2 * ratio_ - sigma * pinion_.pitch() / 2);
  }
  test::BruteForceBevelGear pinion_, wheel_;
  Misalignment moved_;
  double ratio_;
};

/// Plain and modified, single hand and herringbone, as drawn and misaligned: the mills as solids give the same map.
TEST(BevelEaseOff, AgreesWithTheSweptMill) {
  auto on_flank = test::modification_of(Kind::lead_crowning, 0.012);
  on_flank.flanks = modification::Flanks::right;
  const std::vector<Modification> on_pinion = {test::modification_of(Kind::tip_relief, 0.02, 2),
                                               test::modification_of(Kind::helix_angle_slope, 0.008), on_flank},
                                  on_wheel = {test::modification_of(Kind::profile_crowning, 0.01),
                                              test::modification_of(Kind::end_relief, 0.01, 4)};
  struct Case {
    bevel_gear::BevelGearParameters pinion, wheel;
    Misalignment moved;
  };
  const Case cases[] = {{w1(), w2(), {}},
                        {with(w1(), on_pinion), with(w2(), on_wheel), {0.03, 0.02, 0.0004, -0.03}},
                        {with(w3(), on_pinion), with(w4(), on_wheel), {-0.02, -0.03, -0.0003, 0.02}}};
  double worst = 0, largest = 0;
  int places = 0;
  for (const Case& c : cases)
    for (const int sigma : {1, -1}) {
      const auto pinion = made(c.pinion, pinion_mill()), wheel = made(c.wheel, wheel_mill());
      const auto map = map_of(pinion, wheel, sigma, 6, 5, c.moved);
      const SweptPair swept(c.pinion, c.wheel, c.moved);
      for (std::size_t h = 0; h < map.grids.size(); ++h)
        for (std::size_t k = 0; k < map.grids[h].places.size(); k += 2) {
          const auto& of_half = map.found.maps[h];
          if (std::isnan(of_half.gap_mm[k])) continue;
          const auto& place = map.grids[h].places[k];
          const double by_solids = swept.least(sigma, place.ell, place.height);
          if (std::isnan(by_solids)) continue;
          const double gap = of_half.gap_mm[k] + map.found.shift * of_half.lever_mm[k],
                       difference = std::abs(by_solids - gap);
          EXPECT_LT(difference, 3e-7 + 1e-3 * std::abs(gap)) << sigma << ' ' << place.ell << ' ' << place.height;
          worst = std::max(worst, difference), largest = std::max(largest, std::abs(gap));
          ++places;
        }
    }
  std::printf("  %d places, distances up to %.1f um, worst difference %.3g nm\n", places, largest * 1e3, worst * 1e6);
  EXPECT_GT(places, 70);
  EXPECT_GT(largest, 0.03);
}

/// Brought to touch by a turn: nowhere below zero, zero where it is least, and but for that turn the mismatch of the
/// roll.
TEST(BevelEaseOff, IsTheMismatchTurnedToTouch) {
  const auto pinion = made(w3(), pinion_mill()), wheel = made(w4(), wheel_mill());
  for (const int sigma : {1, -1}) {
    const auto map = map_of(pinion, wheel, sigma, 9, 7);
    const auto pair = contact::BevelPair::make(pinion, wheel);
    const auto rolled = contact::bevel_contact(*pair, sigma, {7, 9, 24, 0.006});
    ASSERT_TRUE(rolled) << rolled.error().message;
    double offset = NAN, least = 1;
    for (std::size_t h = 0; h < 2; ++h)
      for (std::size_t k = 0; k < map.grids[h].places.size(); ++k) {
        const double gap = map.found.maps[h].gap_mm[k], mismatch = rolled->patterns[h].mismatch_mm[k];
        if (std::isnan(gap) || std::isnan(mismatch)) continue;
        least = std::min(least, gap);
        const double constant = gap + map.found.shift * map.found.maps[h].lever_mm[k] - mismatch;
        if (std::isnan(offset)) offset = constant;
        // Square to which of the two walls: the slope of one against the other times the gap.
        EXPECT_NEAR(constant, offset, 5e-4) << h << ' ' << k;
        EXPECT_GT(map.found.maps[h].bend_mm[k], 0);
      }
    EXPECT_EQ(least, 0);
    EXPECT_GT(map.found.greatest.gap_mm, 0.03);
    EXPECT_LT(map.found.greatest.gap_mm, 0.15);
  }
}

/// What either gear takes adds to the map as the words say it, whoever takes it.
TEST(BevelEaseOff, RemovalsAdd) {
  const auto pinion = made(w1(), pinion_mill()), wheel = made(w2(), wheel_mill());
  for (const auto& [kind, length] : {std::pair(Kind::profile_crowning, 0.0),
                                     {Kind::tip_relief, 3.0},
                                     {Kind::lead_crowning, 0.0},
                                     {Kind::helix_angle_slope, 0.0}})
    for (const bool of_pinion : {false, true}) {
      const Modification m = test::modification_of(kind, 0.01, length);
      const auto p = of_pinion ? made(with(w1(), {m}), pinion_mill()) : made(w1(), pinion_mill());
      const auto w = of_pinion ? made(w2(), wheel_mill()) : made(with(w2(), {m}), wheel_mill());
      const auto before = map_of(pinion, wheel, 1, 9, 7), after = map_of(p, w, 1, 9, 7);
      const auto& gear = of_pinion ? pinion : wheel;
      const auto& wall = gear.halves()[0].wall(1);
      double off = 0, most = 0;
      for (std::size_t k = 0; k < before.grids[0].places.size(); ++k) {
        const auto &a = before.found.maps[0], &b = after.found.maps[0];
        if (std::isnan(a.gap_mm[k]) || std::isnan(b.gap_mm[k])) continue;
        const auto& place = before.grids[0].places[k];
        const double beta = of_pinion ? before.mates[0][k][1].beta : place.beta,
                     at = of_pinion ? before.mates[0][k][1].p : place.p;
        const double words = test::taken_by_the_words<double>(m, gear.parameters().addendum_mm - wall.cutter.at(at).x,
                                                              wall.trace.R(beta), 8.2, gear.R_i(), gear.R_e());
        const double added =
            b.gap_mm[k] + after.found.shift * b.lever_mm[k] - a.gap_mm[k] - before.found.shift * a.lever_mm[k];
        off = std::max(off, std::abs(added - words));
        most = std::max(most, words);
      }
      std::printf("  %s of the %s: up to %.2f um, %.3f um beside the words\n", to_string(kind),
                  of_pinion ? "pinion" : "wheel", 1e3 * most, 1e3 * off);
      EXPECT_GT(most, 0.002);
      // The path takes less at other heights than the pitch cone's, docs/modifications.md 6.
      EXPECT_LT(off, length > 0 || kind == Kind::profile_crowning ? 3e-4 : 1e-3);
    }
}

/// Hands exchanged, L becomes U.
TEST(BevelEaseOff, MirroredPairHasTheSameMap) {
  auto p = w3(), w = w4();
  const auto one = map_of(made(p, pinion_mill()), made(w, wheel_mill()), 1, 7, 5);
  p.hand = -p.hand, w.hand = -w.hand;
  const auto other = map_of(made(p, pinion_mill()), made(w, wheel_mill()), -1, 7, 5);
  for (std::size_t h = 0; h < 2; ++h)
    for (std::size_t k = 0; k < one.found.maps[h].gap_mm.size(); ++k) {
      const double a = one.found.maps[h].gap_mm[k], b = other.found.maps[h].gap_mm[k];
      EXPECT_EQ(std::isnan(a), std::isnan(b));
      if (std::isnan(a)) continue;
      EXPECT_NEAR(a, b, 1e-9);
    }
}

/// The plain pair bears on edges; strong reliefs of the profile and a lead crowning take it off them, and a helix angle
/// slope moves the pattern towards the end where it takes nothing.
TEST(BevelEaseOff, CrowningKeepsThePatternInsideAndSlopesMoveIt) {
  const auto rolled = [](const std::vector<Modification>& on_wheel, int sigma) {
    const auto pinion = made(w1(), pinion_mill()), wheel = made(with(w2(), on_wheel), wheel_mill());
    auto found = contact::bevel_misaligned_contact(pinion, wheel, sigma, {}, {17, 21, 16, 0.006}, 0.05);
    if (!found) throw std::invalid_argument(found.error().message);
    return *found;
  };
  const std::vector<Modification> crowned = {test::modification_of(Kind::tip_relief, 0.06, 3.3),
                                             test::modification_of(Kind::root_relief, 0.03, 5.3),
                                             test::modification_of(Kind::lead_crowning, 0.03)};
  for (const int sigma : {1, -1}) {
    EXPECT_LT(rolled({}, sigma).margin_gap_mm, 0.006);
    const auto middle = rolled(crowned, sigma);
    for (int e = 0; e < contact::kEdges; ++e) EXPECT_FALSE(middle.at_edges[0].reaches(Edge(e), 0.006)) << e;
    EXPECT_GT(middle.margin_gap_mm, 0.006);
    EXPECT_GT(middle.at_edges[0].lead, 0.3);
    EXPECT_LT(middle.at_edges[0].lead, 0.7);
    auto leaning = crowned;
    leaning.push_back(test::modification_of(Kind::helix_angle_slope, 0.02));
    EXPECT_LT(rolled(leaning, sigma).at_edges[0].lead, middle.at_edges[0].lead - 0.05);
  }
}

}  // namespace
}  // namespace toothpath
