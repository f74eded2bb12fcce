// After every solution no place of any tooth lies inside the approach without force: judged by brute force on a roll of
// the rigid flanks that shares nothing with the lists of places but the closed form of a place's turn.
#include <gtest/gtest.h>

#include <set>

#include "geometry/contact/tooth_contact.h"
#include "tests/geometry/loaded/spur_pair.h"
#include "tests/geometry/loaded/trial_gear.h"

namespace toothpath::test {
namespace {

/// A place of a tooth that both flanks have, at one position.
struct RigidPlace {
  Vec3 point;
  double r, Z, R, gap, lever;
};

/// All places of a tooth on a grid of the gear's flank, with those where the pinion's flank ends between two rows.
std::vector<RigidPlace> places_of(const loaded::LoadedPair& pair, const loaded::PairRing& ring,
                                  const contact::ContactFlank& flank, double phi, int tooth) {
  const contact::Pinion<double>& pinion = ring.moved;
  const double turned_by = phi + tooth * 2 * kPi / pair.shaper_teeth,
               phi_1 = turned_by * pair.shaper_teeth / pair.pinion_teeth;
  const double start = pinion.r_b * std::hypot(1.0, ring.bounds.least_theta);
  const auto in_housing = [&](double row, int column) {
    const int r = std::min(static_cast<int>(row), flank.rows - 2);
    const std::size_t a = flank.index(r, column), b = flank.index(r + 1, column);
    const double u = row - r;
    const auto at = flank.at((1 - u) * flank.theta[a] + u * flank.theta[b], (1 - u) * flank.B[a] + u * flank.B[b]);
    return turned(at.p, ring.surface.i * turned_by);
  };
  const auto inside = [&](double row, int column) {
    const double radius = pinion.place(in_housing(row, column)).radius;
    return std::min(pinion.r_a - radius, radius - start);
  };
  std::vector<RigidPlace> out;
  const auto take = [&](double row, int column, bool pinion_edge) {
    RigidPlace p;
    p.point = in_housing(row, column);
    const auto place = pinion.place(p.point);
    double turn = pinion.turn_at(pair.side, place);
    turn += 2 * kPi * std::round((phi_1 - turn) / (2 * kPi));
    p.r = radius(p.point), p.Z = place.Z, p.R = place.radius;
    p.gap = pair.side * pinion.r_b * pinion.cos_bb * (phi_1 - turn) + (ring.removal ? ring.removal(p.point) : 0);
    // Of the pinion's normal; an edge of the pinion presses along that of the gear, whose lever is the pair's own.
    const double theta = std::sqrt((place.radius - pinion.r_b) * (place.radius + pinion.r_b)) / pinion.r_b,
                 B = std::atan2(place.y, place.x) + pair.side * std::atan(theta);
    const Vec3 normal = pinion.t(B) * pinion.cos_bb - pinion.a * pinion.sin_bb;
    p.lever = pinion_edge ? 1 : std::abs(p.point.cross(normal).z()) / pair.lever;
    out.push_back(p);
  };
  for (int column = 0; column < flank.columns; ++column)
    for (int row = 0; row < flank.rows; ++row) {
      const bool here = inside(row, column) >= 0;
      if (here) take(row, column, false);
      if (row + 1 == flank.rows || here == (inside(row + 1, column) >= 0)) continue;
      double in = here ? row : row + 1, out_of = here ? row + 1 : row;
      for (int k = 0; k < 50; ++k) {
        const double middle = (in + out_of) / 2;
        (inside(middle, column) >= 0 ? in : out_of) = middle;
      }
      take(in, column, true);
    }
  return out;
}

struct Judged {
  int bare = 0;      ///< teeth without force that were judged
  int corners = 0;   ///< teeth with force that no line of the rigid flanks reaches
  double worst = 0;  ///< greatest overlap without force, mm
};

/// What is left open at every place of teeth that carry nothing.
Judged judge(const loaded::LoadedPair& pair, const face_gear::FaceGear& gear, const loaded::LoadedPosition& p) {
  Judged out;
  out.worst = -1e300;
  std::set<std::pair<int, int>> carry;
  for (const auto& s : p.segments)
    if (s.force > 0) carry.emplace(s.place.ring, s.place.tooth);
  std::vector<std::tuple<const loaded::PairRing*, int, std::vector<RigidPlace>>> teeth;
  double first = 1e300;
  for (const auto& ring : pair.rings) {
    const auto flank = contact::exact_flank(gear, ring.ring, pair.side, 41, 31);
    if (!flank) throw std::invalid_argument(flank.error().message);
    std::set<int> near;
    for (const auto& s : p.segments)
      for (int j = s.place.tooth - 2; j <= s.place.tooth + 2; ++j) near.insert(j);
    for (const int j : near) {
      auto places = places_of(pair, ring, *flank, p.phi, j);
      double least = 1e300;
      for (const auto& place : places) least = std::min(least, place.gap);
      first = std::min(first, least);
      if (carry.contains({ring.ring, j}) && least > 1e-4) ++out.corners;
      teeth.emplace_back(&ring, j, std::move(places));
    }
  }
  if (first < 2e-4) first = 0;  // a line, between the places
  for (const auto& [ring, j, places] : teeth) {
    if (carry.contains({ring->ring, j})) continue;
    ++out.bare;
    for (const RigidPlace& place : places) {
      double open = place.gap - first - place.lever * p.approach_mm;
      const auto on_gear = ring->gear.weights(place.r, place.point.z()),
                 on_pinion = ring->pinion.weights(place.Z, place.R);
      if (open > 0) continue;
      for (const auto& s : p.segments) {
        if (!(s.force > 0) || s.place.ring != ring->ring) continue;
        const int offset = j - s.place.tooth;
        open += s.force * (ring->gear.remainder_at(on_gear, ring->gear.weights(s.place.r, s.place.z), offset) +
                           ring->pinion.remainder_at(on_pinion, ring->pinion.weights(s.place.Z, s.place.R), offset));
      }
      out.worst = std::max(out.worst, -open);
    }
  }
  return out;
}

TEST(NoToothLeftOut, SpurPairAtManyPositionsAndTorques) {
  const auto gear = spur_gear();
  auto pair = spur_pair();
  pair.options.segment_mm = 0.5;
  int bare = 0, corners = 0;
  for (const double torque : {1.0, 20.0, 100.0, 1000.0})
    for (int k = 0; k < 12; ++k) {
      const auto p = spur_position(pair, torque, k / 12.0);
      const Judged judged = judge(pair, gear, p);
      EXPECT_LT(judged.worst, 1e-9) << torque << " N m at " << k << "/12";
      EXPECT_LT(p.residual, 1e-9);
      EXPECT_NEAR(p.gear_torque_nmm, torque * 1e3, 1e-8 * torque * 1e3);
      bare += judged.bare, corners += judged.corners;
    }
  EXPECT_GT(bare, 50);
  EXPECT_GT(corners, 5);
}

TEST(NoToothLeftOut, OnCells) {
  const auto gear = spur_gear();
  auto pair = spur_pair();
  pair.options.cells = true;
  int corners = 0;
  for (const auto& [torque, phase] : {std::pair(100.0, 0.875), {600.0, 0.1}}) {
    const auto p = spur_position(pair, torque, phase);
    const Judged judged = judge(pair, gear, p);
    EXPECT_LT(judged.worst, 2e-6 * p.approach_mm) << torque << " N m at " << phase;
    corners += judged.corners;
  }
  EXPECT_GT(corners, 0);
}

TEST(NoToothLeftOut, TwoRingsHeldAndFloating) {
  const auto gear = trial_gear();
  loaded::PairOptions options;
  for (auto* body : {&options.gear, &options.pinion})
    body->bricks.across = 3, body->bricks.flank = 4, body->bricks.face = 5;
  const auto pair = loaded::make_loaded_pair(gear, 1, 30, options);
  ASSERT_TRUE(pair) << pair.error().message;
  loaded::Load load;
  for (const double torque : {532e3, 2e7})
    for (const double phase : {0.1, 0.6}) {
      load.torque_nmm = torque;
      const auto p = loaded::loaded_position(*pair, load, 2 * kPi / 30 * phase);
      ASSERT_TRUE(p) << p.error().message;
      EXPECT_LT(judge(*pair, gear, *p).worst, 1e-9) << torque << " at " << phase;
    }
}

/// A tooth that is just leaving, 0.06 and 3.2 um off while another carries: without it the lag is 2.5 times as much.
TEST(NoToothLeftOut, TheErrorUnderLoadDoesNotJump) {
  const auto pair = spur_pair();
  double least = 1e300, most = 0;
  for (int k = 0; k < 24; ++k) {
    const auto p = spur_position(pair, 100, k / 24.0);
    least = std::min(least, p.error_rad), most = std::max(most, p.error_rad);
    if (k == 21) { EXPECT_GE(p.pairs, 2) << "at 15.75 deg"; }
  }
  EXPECT_LT(most - least, 80e-6);
}

/// The edge of one flank presses along the normal of the other: balance about the gear's axis is by its own lever.
TEST(NoToothLeftOut, EdgesHaveTheirOwnNormal) {
  const auto pair = spur_pair();
  int edges = 0;
  for (int k = 0; k < 12; ++k)
    for (const auto& s : spur_position(pair, 300, k / 12.0).segments) {
      if (!s.place.on_edge || !(s.force > 0)) continue;
      ++edges;
      const auto on_pinion = pair.rings[0].moved.place(s.place.point);
      const double lever_1 =
                       (s.place.point - pair.rings[0].moved.foot).cross(s.place.normal).dot(pair.rings[0].moved.a),
                   own = pair.rings[0].moved.r_b * pair.rings[0].moved.cos_bb,
                   lever_2 = s.place.point.cross(s.place.normal).z();
      EXPECT_TRUE(std::abs(std::abs(lever_1) - own) < 1e-6 || std::abs(std::abs(lever_2) - pair.lever) < 1e-6);
      EXPECT_GT(on_pinion.radius, pair.rings[0].moved.r_b);
    }
  EXPECT_GT(edges, 3);
}

}  // namespace
}  // namespace toothpath::test
