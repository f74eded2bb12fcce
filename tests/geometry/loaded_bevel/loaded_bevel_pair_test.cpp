// Bevel pairs under load: statics, symmetries, limits, and the same contact as a dense problem.
#include "geometry/loaded_bevel/loaded_bevel_pair.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "geometry/base/angle.h"
#include "geometry/loaded/cell_contact.h"
#include "geometry/loaded/complementarity.h"
#include "geometry/loaded/half_space.h"
#include "geometry/loaded_bevel/bevel_flanks.h"
#include "tests/geometry/loaded_bevel/bevel_pairs.h"

namespace toothpath::test {
namespace {

using loaded_bevel::LoadedBevelPair;

double sum_of(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum;
}
loaded::LoadedPosition position_of(const LoadedBevelPair& pair, const loaded::Load& load, double phase) {
  auto found = loaded_bevel::loaded_position(pair, load, pair.pair.pinion().pitch() * phase);
  if (!found) throw std::invalid_argument(found.error().message);
  return std::move(found).value();
}
loaded::Load held(double torque_Nm) {
  loaded::Load load;
  load.torque_nmm = torque_Nm * 1000;
  return load;
}

TEST(LoadedBevelPair, BalanceAndComplementarity) {
  for (const bool on_pinion : {false, true}) {
    auto options = coarse_bodies();
    options.torque_on_pinion = on_pinion;
    const auto pair = single_pair(1, options);
    for (const double torque : {1.0, 300.0}) {
      const auto p = position_of(pair, held(torque), 0.3);
      EXPECT_NEAR((on_pinion ? p.pinion_torque_nmm : p.gear_torque_nmm), torque * 1000, 1e-10 * torque * 1000);
      EXPECT_LT(p.residual, 2e-7);
      // The other torque is that of the ratio but for the mismatch of the flanks, which turns the normals a little.
      const double ratio = p.gear_torque_nmm / p.pinion_torque_nmm / pair.pair.ratio();
      EXPECT_NEAR(ratio, 1, 0.03);
      EXPECT_NE(ratio, 1);
    }
  }
}

/// The greatest overlap of a tooth that carries nothing, mm, by a roll of the rigid walls on a grid of its own, ends
/// and tips and all; and how many such teeth were judged.
std::pair<double, int> overlap_without_force(const LoadedBevelPair& pair, const loaded::LoadedPosition& p,
                                             double phi_1) {
  constexpr int kAlong = 25, kUp = 13;
  const double first = loaded_bevel::BevelFlanks(pair, phi_1).first_turn();
  std::map<std::pair<int, int>, double> force;
  for (const auto& s : p.segments) force[{s.place.ring, s.place.tooth}] += s.force;
  double worst = 0;
  int judged = 0;
  for (int h = 0; h < static_cast<int>(pair.halves.size()); ++h)
    for (int tooth = -6; tooth <= 6; ++tooth) {
      if (force[{h, tooth}] > 0) continue;
      const auto& own = pair.pair.wheel().halves()[static_cast<std::size_t>(h)];
      const double phi_2 = -phi_1 / pair.pair.ratio() + tooth * pair.pair.wheel().pitch();
      bool met_any = false;
      for (int i = 0; i < kUp; ++i)
        for (int k = 0; k < kAlong; ++k) {
          const auto place =
              pair.pair.wheel_place(h, pair.sigma, own.ell_from + (own.ell_to - own.ell_from) * k / (kAlong - 1),
                                    pair.pair.lowest(h) + (pair.pair.highest() - pair.pair.lowest(h)) * i / (kUp - 1));
          if (!place) continue;
          bevel_gear::BevelInverse start;
          const auto met = pair.pair.touch(h, pair.sigma, place->point, phi_2, start);
          if (!met || !met->on_flank) continue;
          met_any = true;
          const double turned = pair.sigma * wrapped(met->turn - pair.pair.nominal_turn(phi_2));
          const double lever = std::abs(place->point.x() * place->normal.y() - place->point.y() * place->normal.x());
          double open = (turned - first) * pair.pair.lever(*place, phi_2) - lever / pair.lever * p.approach_mm;
          if (open > 0) continue;
          const auto& half = pair.halves[static_cast<std::size_t>(h)];
          const auto on_wheel = half.wheel.weights(place->ell, place->height),
                     on_pinion = half.pinion.weights(met->ell, met->height);
          for (const auto& s : p.segments) {
            if (!(s.force > 0) || s.place.ring != h) continue;
            const int offset = tooth - s.place.tooth;
            open += s.force * (half.wheel.remainder_at(on_wheel, half.wheel.weights(s.place.r, s.place.z), offset) +
                               half.pinion.remainder_at(on_pinion, half.pinion.weights(s.place.Z, s.place.R), -offset));
          }
          worst = std::max(worst, -open);
        }
      if (met_any) ++judged;
    }
  return {worst, judged};
}

TEST(LoadedBevelPair, NoToothIsLeftOut) {
  int judged = 0;
  for (const int sigma : {1, -1}) {
    const auto pair = single_pair(sigma, coarse_bodies());
    for (const auto& [torque, phase] : {std::pair(20.0, 0.15), {200.0, 0.55}, {200.0, 0.9}, {1500.0, 0.35}}) {
      const auto p = position_of(pair, held(torque), phase);
      const auto [worst, teeth] = overlap_without_force(pair, p, pair.pair.pinion().pitch() * phase);
      EXPECT_LT(worst, 2e-6 * p.approach_mm) << sigma << ", " << torque << " N m, phase " << phase;
      judged += teeth;
    }
  }
  EXPECT_GT(judged, 8);
}

TEST(LoadedBevelPair, TheAxialForcesAreThoseOfTheNormals) {
  // The formulas of docs/bevel_gear.md 11 hold for the pitch cone in the middle of the face.
  const auto pair = single_pair(1, coarse_bodies());
  const auto p = position_of(pair, held(300), 0.25);
  const auto& wheel = pair.pair.wheel();
  const double beta = std::acos(std::sqrt(wheel.R_m() / wheel.R_0())), t = std::tan(radians(20)) / std::cos(beta),
               F_t = 300e3 / (wheel.R_m() * wheel.sin_delta());
  const double on_wheel = F_t * (t * wheel.sin_delta() + wheel.halves()[0].hand * std::tan(beta) * wheel.cos_delta());
  const auto& pinion = pair.pair.pinion();
  const double on_pinion =
      F_t * (t * pinion.sin_delta() + pinion.halves()[0].hand * std::tan(beta) * pinion.cos_delta());
  EXPECT_NEAR(p.gear_axial_n, on_wheel, 0.1 * F_t);
  EXPECT_NEAR(p.axial_n, on_pinion, 0.1 * F_t);
}

TEST(LoadedBevelPair, APitchLaterItIsTheSame) {
  const auto pair = single_pair(1, coarse_bodies());
  const auto a = position_of(pair, held(200), 0.2), b = position_of(pair, held(200), 1.2);
  EXPECT_NEAR(a.approach_mm, b.approach_mm, 1e-6 * a.approach_mm);
  EXPECT_NEAR(a.axial_n, b.axial_n, 1e-5 * std::abs(a.axial_n));
  EXPECT_NEAR(a.pressure, b.pressure, 1e-4 * a.pressure);
  EXPECT_EQ(a.pairs, b.pairs);
}

TEST(LoadedBevelPair, TheMirroredPairIsTheSame) {
  const auto pair = single_pair(1, coarse_bodies());
  const auto p = bevel_test::w1(), w = bevel_test::w2();
  auto p_m = p, w_m = w;
  p_m.hand = -p.hand, w_m.hand = -w.hand;
  const auto pinion = bevel_test::made(p_m, bevel_test::pinion_mill()),
             wheel = bevel_test::made(w_m, bevel_test::wheel_mill());
  auto options = coarse_bodies();
  const auto mirrored = loaded_bevel::make_loaded_bevel_pair(pinion, wheel, -1, options);
  ASSERT_TRUE(mirrored) << mirrored.error().message;
  const auto a = position_of(pair, held(200), 0.2), b = position_of(*mirrored, held(200), -0.2);
  EXPECT_NEAR(a.approach_mm, b.approach_mm, 1e-5 * a.approach_mm);
  EXPECT_NEAR(a.axial_n, b.axial_n, 1e-4 * std::abs(a.axial_n));
  EXPECT_NEAR(a.gear_axial_n, b.gear_axial_n, 1e-4 * std::abs(a.axial_n));
}

TEST(LoadedBevelPair, LoadAndModulusScaleTogether) {
  auto options = coarse_bodies();
  const auto pair = single_pair(-1, options);
  for (auto* body : {&options.wheel, &options.pinion}) body->E *= 8;
  const auto stiff = single_pair(-1, options);
  const auto a = position_of(pair, held(100), 0.4), b = position_of(stiff, held(800), 0.4);
  EXPECT_NEAR(a.approach_mm, b.approach_mm, 1e-7 * a.approach_mm);
  EXPECT_NEAR(8 * a.pressure, b.pressure, 1e-5 * b.pressure);
}

/// The rolled rigid pair and the flanks of the cells look on different grids; both come to the same first touch.
TEST(BevelFlanks, TouchFirstWhereTheRollDoes) {
  contact::BevelContactOptions roll;
  roll.steps = 8;
  for (const auto* gears : {&single_gears(), &herringbone_gears()})
    for (const int sigma : {1, -1}) {
      const auto pair = pair_of(*gears, sigma, coarse_bodies());
      const auto rolled = contact::bevel_contact(pair.pair, sigma, roll);
      ASSERT_TRUE(rolled) << rolled.error().message;
      for (int k = 0; k < roll.steps; ++k) {
        const loaded_bevel::BevelFlanks flanks(pair, -pair.pair.pinion().pitch() * k / roll.steps);
        EXPECT_NEAR(rolled->cycle[static_cast<std::size_t>(k)].error_rad, flanks.first_turn(), 1e-7)
            << pair.halves.size() << " halves, " << sigma << " at " << k;
      }
    }
}

TEST(LoadedBevelPair, RigidTeethTouchWhereTheRollSays) {
  auto options = coarse_bodies();
  for (auto* body : {&options.wheel, &options.pinion}) body->E *= 1e3;
  for (const int sigma : {1}) {  // wall U runs within 2 um: two pairs at once
    const auto pair = single_pair(sigma, options);
    contact::BevelContactOptions roll;
    roll.steps = 16, roll.compound_mm = 0.0007;
    const auto rolled = contact::bevel_contact(pair.pair, sigma, roll);
    ASSERT_TRUE(rolled) << rolled.error().message;
    int compared = 0;
    for (int k = 0; k < roll.steps && compared == 0; ++k) {
      const contact::BevelPosition& at = rolled->cycle[static_cast<std::size_t>(k)];
      if (at.marking > 1) continue;  // cells see a corner from their own middles on: a pair as near would do, too
      ++compared;
      // The wheel's turn of position k is the pinion's of -k/steps pitches.
      const auto p = position_of(pair, held(1), -double(k) / roll.steps);
      EXPECT_LT(p.approach_mm, 3e-4);
      EXPECT_EQ(p.pairs, 1);
      double force = 0, ell = 0, height = 0;
      for (const auto& s : p.segments) {
        EXPECT_EQ(s.place.tooth, at.tooth) << sigma;
        force += s.force, ell += s.force * s.place.r, height += s.force * s.place.z;
      }
      EXPECT_NEAR(ell / force, at.ell, 0.5) << sigma;
      EXPECT_NEAR(height / force, at.height, 0.2) << sigma;
    }
    EXPECT_EQ(compared, 1) << sigma;
  }
}

TEST(LoadedBevelPair, AFloatingHerringboneBalancesItsPinion) {
  const auto pair = herringbone_pair(1, coarse_bodies());
  auto load = held(300);
  const auto fixed = position_of(pair, load, 0.1);
  load.axial = loaded::PinionAxial::floating;
  const auto floating = position_of(pair, load, 0.1);
  const double F = sum_of(floating.ring_force);
  EXPECT_NEAR(floating.axial_n, 0, 1e-6 * F);
  EXPECT_NEAR(floating.gear_torque_nmm, 300e3, 1e-10 * 300e3);
  EXPECT_GT(std::abs(fixed.axial_n), 1e-3 * F);
  EXPECT_LT(floating.approach_mm, fixed.approach_mm + std::abs(floating.shift_mm)) << "it gives way along its axis";
  // The pressure part pushes both gears away from their apexes: that of the wheel stays.
  EXPECT_GT(floating.gear_axial_n, 0.05 * F);
  EXPECT_GT(floating.ring_force[0], 0.2 * F);
  EXPECT_GT(floating.ring_force[1], 0.2 * F);
  load.axial = loaded::PinionAxial::spring;
  load.spring_n_mm = 1e12;
  EXPECT_NEAR(position_of(pair, load, 0.1).approach_mm, fixed.approach_mm, 1e-5 * fixed.approach_mm);
  load.spring_n_mm = 1e-3;
  EXPECT_NEAR(position_of(pair, load, 0.1).shift_mm, floating.shift_mm, 1e-4 * std::abs(floating.shift_mm));
}

TEST(LoadedBevelPair, TheCellsAreADenseProblem) {
  // The cells of one position again, with the bodies' remainder place by place, by active sets.
  const auto pair = single_pair(1, coarse_bodies());
  const double phi = pair.pair.pinion().pitch() * 0.3;
  const loaded_bevel::BevelFlanks flanks(pair, phi);
  const auto p = position_of(pair, held(400), 0.3);
  struct Cell {
    loaded::CellPlace place;
    std::size_t site;
    double x, y, dx, dy;
  };
  std::vector<Cell> cells;
  constexpr int kColumns = 16, kRows = 24;
  for (std::size_t n = 0; n < flanks.sites().size(); ++n) {
    // A rectangle about what presses on this tooth.
    loaded::CellSite site = flanks.sites()[n];
    Vec2 least = Vec2::Constant(1e300), most = -least;
    for (const auto& s : p.segments) {
      if (s.place.tooth != site.tooth) continue;
      const Vec3 off = s.place.point - site.point;
      const Vec2 at(off.dot(site.across), off.dot(site.along)), reach(2 * s.half_width, s.place.length);
      least = least.cwiseMin(at - reach), most = most.cwiseMax(at + reach);
    }
    if (least.x() > most.x()) continue;
    site.x = (least.x() + most.x()) / 2, site.y = (least.y() + most.y()) / 2;
    site.half_x = (most.x() - least.x()) / 2, site.half_y = (most.y() - least.y()) / 2;
    const auto places = flanks.places(site, kColumns, kRows);
    for (std::size_t k = 0; k < places.size(); ++k)
      if (places[k].material)
        cells.push_back({places[k], n, (double(k % kColumns) + 0.5) * 2 * site.half_x / kColumns,
                         (std::floor(double(k) / kColumns) + 0.5) * 2 * site.half_y / kRows, 2 * site.half_x / kColumns,
                         2 * site.half_y / kRows});
  }
  const auto count = static_cast<Eigen::Index>(cells.size());
  loaded::ContactProblem dense;
  dense.compliance.resize(count, count), dense.gap.resize(count), dense.approach.resize(count, 1);
  dense.support = Eigen::MatrixXd::Zero(1, 1);
  dense.load = Eigen::VectorXd::Constant(1, 400e3 / pair.lever);
  const double local = 2 * loaded::half_space_compliance(210000.0, 0.3);
  const auto& half = pair.halves[0];
  for (Eigen::Index i = 0; i < count; ++i) {
    const Cell& a = cells[static_cast<std::size_t>(i)];
    dense.gap(i) = a.place.at.gap, dense.approach(i, 0) = a.place.lever;
    for (Eigen::Index k = 0; k < count; ++k) {
      const Cell& b = cells[static_cast<std::size_t>(k)];
      const int offset = a.place.at.tooth - b.place.at.tooth;
      const auto& s = a.place.at;
      const auto& t = b.place.at;
      double C = half.wheel.remainder_at(half.wheel.weights(s.r, s.z), half.wheel.weights(t.r, t.z), offset) +
                 half.pinion.remainder_at(half.pinion.weights(s.Z, s.R), half.pinion.weights(t.Z, t.R), -offset);
      if (a.site == b.site)
        C += local / (b.dx * b.dy) * loaded::rectangle_influence(a.x - b.x, a.y - b.y, b.dx / 2, b.dy / 2);
      dense.compliance(i, k) = C;
    }
  }
  dense.compliance = Eigen::MatrixXd((dense.compliance + dense.compliance.transpose()) / 2);
  const auto exact = loaded::share_load(dense);
  ASSERT_TRUE(exact) << exact.error().message;
  std::map<int, double> theirs, ours;
  for (Eigen::Index i = 0; i < count; ++i) theirs[cells[static_cast<std::size_t>(i)].place.at.tooth] += exact->force(i);
  for (const auto& s : p.segments) ours[s.place.tooth] += s.force;
  // The dense one is coarser and has no images.
  const double F = 400e3 / pair.lever;
  for (const auto& [tooth, force] : ours) EXPECT_NEAR(force, theirs[tooth], 0.03 * F) << tooth;
  EXPECT_NEAR(p.approach_mm, exact->motion(0), 0.03 * p.approach_mm);
}

TEST(LoadedBevelPair, MoreLoadIsMoreContact) {
  const auto pair = single_pair(1, coarse_bodies());
  double approach = 0;
  int pairs = 0;
  for (const double torque : {1e-6, 1.0, 30.0, 300.0, 2000.0}) {
    const auto p = position_of(pair, held(torque), 0.3);
    EXPECT_GT(p.approach_mm, approach);
    EXPECT_GE(p.pairs, pairs);
    EXPECT_GE(p.tangent, 0.99 * p.stiffness) << "gaps close, contacts widen";
    approach = p.approach_mm, pairs = p.pairs;
  }
  EXPECT_GE(pairs, 2);
}

TEST(LoadedBevelPair, TipReliefTakesTheLoadOffTheEdges) {
  auto options = coarse_bodies();
  options.edge_radius_mm = 0.3;
  const auto plain = single_pair(1, options), relieved = relieved_pair(1, options, 0.06);
  double edge[2] = {0, 0};
  for (const double phase : {0.0, 0.3, 0.6})
    for (const auto* pair : {&plain, &relieved}) {
      const auto p = position_of(*pair, held(150), phase);
      edge[pair == &relieved] = std::max(edge[pair == &relieved], p.end_line_load);
      // Under the edge: the line contact of its radius on the flank.
      const double k = 1 / 0.3;
      if (p.end_line_load > 0) {
        EXPECT_GT(p.edge_pressure, std::sqrt(p.end_line_load * pair->modulus * k / kPi));
        EXPECT_LT(p.edge_pressure, 1.1 * std::sqrt(p.end_line_load * pair->modulus * k / kPi));
      } else {
        EXPECT_EQ(p.edge_pressure, 0);
      }
    }
  EXPECT_GT(edge[0], 50);
  EXPECT_LT(edge[1], 0.5 * edge[0]);
}

/// What a modification takes off a wall at a place, as a deviation that was measured there.
double taken_off(const bevel_gear::BevelGear& plain, const bevel_gear::BevelGear& modified, int half, int sigma,
                 const bevel_gear::ConePoint& at) {
  const auto h = static_cast<std::size_t>(half);
  const auto& wall = plain.halves()[h].wall(sigma);
  const auto a = bevel_gear::bevel_inverse(wall, at.ell, at.height),
             b = bevel_gear::bevel_inverse(modified.halves()[h].wall(sigma), at.ell, at.height);
  if (!a || !b) return 0;
  const auto f = wall.point(a->beta, a->p);
  return wrapped(b->azimuth - a->azimuth) * (f.p.x() * f.n.y() - f.p.y() * f.n.x());
}

TEST(LoadedBevelPair, WhatIsLeftOnTheWallsIsAsIfTheyWereDrawnSo) {
  const auto &plain = single_gears(), &relieved = relieved_gears(0.06);
  for (const int sigma : {1, -1}) {
    auto options = coarse_bodies();
    const auto drawn = pair_of(relieved, sigma, options), ideal = pair_of(plain, sigma, options);
    const auto left = [&](int half, int side, const bevel_gear::ConePoint& on_wheel,
                          const bevel_gear::ConePoint& on_pinion) {
      return taken_off(plain.second, relieved.second, half, side, on_wheel) +
             taken_off(plain.first, relieved.first, half, side, on_pinion);
    };
    EXPECT_LT(left(0, sigma, {ideal.pair.wheel().R_m(), 4, 0}, {ideal.pair.wheel().R_m(), -4, 0}), -0.02);
    const auto measured = loaded_bevel::with_left(ideal, left);
    ASSERT_TRUE(measured) << measured.error().message;
    for (const double phase : {0.0, 0.6}) {
      const auto d = position_of(drawn, held(200), phase), m = position_of(*measured, held(200), phase),
                 i = position_of(ideal, held(200), phase);
      EXPECT_NEAR(m.approach_mm, d.approach_mm, 0.01 * d.approach_mm) << sigma << " " << phase;
      EXPECT_NEAR(m.axial_n, d.axial_n, 0.02 * std::abs(d.axial_n)) << sigma << " " << phase;
      EXPECT_GT(std::abs(i.approach_mm - d.approach_mm) + std::abs(i.end_line_load - d.end_line_load), 1e-4);
    }
  }
}

TEST(LoadedBevelPair, MisalignedPairsMoveTheirLoad) {
  auto options = coarse_bodies();
  const auto place_of = [&](const contact::BevelAssembly& moved) {
    options.moved = moved;
    const auto p = position_of(single_pair(-1, options), held(200), 0.3);
    double sum = 0, force = 0;
    for (const auto& s : p.segments) sum += s.force * s.place.r, force += s.force;
    return sum / force;
  };
  const double here = place_of({});
  contact::BevelAssembly wide, narrow;
  wide.shaft_angle_rad = 5e-4, narrow.shaft_angle_rad = -5e-4;
  const double at_wide = place_of(wide), at_narrow = place_of(narrow);
  EXPECT_GT(std::abs(at_wide - at_narrow), 1);
  EXPECT_LT((at_wide - here) * (at_narrow - here), 0) << at_wide << " " << here << " " << at_narrow;
  // Axial places: a gear that is drawn back leaves its mate without contact only on one flank of its backlash.
  contact::BevelAssembly drawn;
  drawn.pinion_axial_mm = 0.05, drawn.wheel_axial_mm = 0.05, drawn.offset_mm = 0.05;
  EXPECT_GT(place_of(drawn), 0);
}

TEST(LoadedBevelPair, Refusals) {
  auto options = coarse_bodies();
  const auto pair = single_pair(1, options);
  const auto far = loaded_bevel::loaded_position(pair, held(1e6), 0);
  ASSERT_FALSE(far);
  EXPECT_NE(far.error().message.find("beyond 0.25 mm"), std::string::npos) << far.error().message;
  for (const double torque : {0.0, -5.0, std::nan("")}) {
    const auto none = loaded_bevel::loaded_position(pair, held(torque), 0);
    ASSERT_FALSE(none) << torque;
    EXPECT_NE(none.error().message.find("N m on the wheel is not above 0"), std::string::npos) << none.error().message;
  }
  options.pinion.bricks.rim_mm = 200;
  const auto& [pinion, wheel] = single_gears();
  const auto thick = loaded_bevel::make_loaded_bevel_pair(pinion, wheel, 1, options);
  ASSERT_FALSE(thick);
  EXPECT_NE(thick.error().message.find("half 0 of the pinion: rim = 200 mm"), std::string::npos)
      << thick.error().message;
  auto floating = held(100);
  floating.axial = loaded::PinionAxial::floating;
  const auto loose = loaded_bevel::loaded_position(pair, floating, 0);
  ASSERT_FALSE(loose) << "one hand cannot balance";
}

}  // namespace
}  // namespace toothpath::test
