// Flank modifications: the laws against their words, the modified flank against 50 digits, intervals against places.
#include "geometry/modification/modification.h"

#include <gtest/gtest.h>

#include <boost/multiprecision/eigen.hpp>
#include <cmath>
#include <random>

#include "geometry/base/angle.h"
#include "geometry/face_gear/limits.h"
#include "geometry/face_gear/space_sheet.h"
#include "tests/support/fifty_digits.h"
#include "tests/support/modified_flank.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

using modification::Ends;
using modification::Flanks;
using modification::Kind;
using modification::Law;
using modification::Modification;

constexpr modification::Rectangle kOn{4, 60, 65};

double removed(const Modification& m, double depth, double along, int side = 1, int zone = 0) {
  return modification::Field({m}, side, zone, kOn).removal(depth, along);
}

TEST(Modification, EveryKindIsWhatItsWordsSay) {
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::tip_relief, 0.02, 1), 0, 61), 0.02);
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::tip_relief, 0.02, 1), 0.5, 61), 0.005);
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::tip_relief, 0.02, 1), 1, 61), 0);
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::root_relief, 0.02, 1), 4, 61), 0.02);
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::root_relief, 0.02, 1), 2, 61), 0);
  EXPECT_NEAR(removed(modification_of(Kind::root_relief, 0.02, 1), 4.5, 61), 0.04,
              1e-16);  // the tangent beyond the end
  auto linear = modification_of(Kind::tip_relief, 0.02, 1, Law::linear);
  linear.transition_mm = 0.2;
  EXPECT_DOUBLE_EQ(removed(linear, 0, 61), 0.02);
  EXPECT_DOUBLE_EQ(removed(linear, 0.5, 61), 0.01);
  EXPECT_NEAR(removed(linear, 0.9, 61), 0.002, 1e-17);
  EXPECT_NEAR(removed(linear, 1, 61), 0.02 * 0.2 / 8, 1e-17);  // the rounded kink
  EXPECT_DOUBLE_EQ(removed(linear, 1.1, 61), 0);
  auto end = modification_of(Kind::end_relief, 0.03, 2);
  for (const double x : {60.0, 65.0}) EXPECT_NEAR(removed(end, 1, x), 0.03, 1e-15);
  EXPECT_DOUBLE_EQ(removed(end, 1, 62.5), 0);
  end.ends = Ends::outer;
  EXPECT_DOUBLE_EQ(removed(end, 1, 60), 0);
  EXPECT_NEAR(removed(end, 1, 64), 0.0075, 1e-15);
  end.ends = Ends::inner;
  EXPECT_NEAR(removed(end, 1, 61), 0.0075, 1e-15);
  EXPECT_DOUBLE_EQ(removed(end, 1, 65), 0);
  for (const double y : {0.0, 4.0}) {
    EXPECT_DOUBLE_EQ(removed(modification_of(Kind::profile_crowning, 0.01), y, 61), 0.01);
    EXPECT_NEAR(removed(modification_of(Kind::profile_crowning, -0.01), y, 61), 0, 1e-17);
  }
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::profile_crowning, 0.01), 2, 61), 0);
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::profile_crowning, -0.01), 2, 61), 0.01);
  for (const double x : {60.0, 65.0})
    EXPECT_NEAR(removed(modification_of(Kind::lead_crowning, 0.01), 1, x), 0.01, 1e-15);
  EXPECT_NEAR(removed(modification_of(Kind::lead_crowning, 0.01), 1, 62.5), 0, 1e-17);
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::pressure_angle_slope, 0.01), 0, 61), 0.01);
  EXPECT_NEAR(removed(modification_of(Kind::pressure_angle_slope, 0.01), 4, 61), 0, 1e-17);
  EXPECT_DOUBLE_EQ(removed(modification_of(Kind::pressure_angle_slope, -0.01), 4, 61), 0.01);
  EXPECT_NEAR(removed(modification_of(Kind::helix_angle_slope, 0.01), 1, 65), 0.01, 1e-15);
  EXPECT_NEAR(removed(modification_of(Kind::helix_angle_slope, 0.01), 1, 60), 0, 1e-15);
  EXPECT_NEAR(removed(modification_of(Kind::helix_angle_slope, -0.01), 1, 60), 0.01, 1e-15);
  const auto twist = modification_of(Kind::twist, 0.01);
  EXPECT_NEAR(removed(twist, 0, 65), 0.01, 1e-15);
  EXPECT_NEAR(removed(twist, 4, 60), 0.01, 1e-15);
  EXPECT_NEAR(removed(twist, 0, 60), 0, 1e-15);
  EXPECT_NEAR(removed(twist, 4, 65), 0, 1e-15);
  EXPECT_NEAR(removed(modification_of(Kind::twist, -0.01), 0, 60), 0.01, 1e-15);
}

/// The thickness that a tooth loses along its face, and which way its middle leans.
TEST(Modification, ASlopeOfBothFlanksIsATaperTwoOfOppositeSignsAHelix) {
  const auto slope = [](double amount, Flanks flanks) {
    auto m = modification_of(Kind::helix_angle_slope, amount);
    m.flanks = flanks;
    return m;
  };
  const auto taken = [](const std::vector<Modification>& list, int side, double along) {
    return modification::Field(list, side, 0, kOn).removal(1.0, along);
  };
  const std::vector<Modification> both = {slope(0.01, Flanks::both)},
                                  two = {slope(0.01, Flanks::right), slope(-0.01, Flanks::left)};
  for (const double along : {60.0, 61.3, 65.0}) {
    const double share = (along - 60) / 5;
    EXPECT_NEAR(taken(both, 1, along) + taken(both, -1, along), 0.02 * share, 1e-15);
    EXPECT_NEAR(taken(both, 1, along) - taken(both, -1, along), 0, 1e-15);
    EXPECT_NEAR(taken(two, 1, along) + taken(two, -1, along), 0.01, 1e-15) << "as thick all along";
    EXPECT_NEAR(taken(two, 1, along) - taken(two, -1, along), 0.02 * share - 0.01, 1e-15);
  }
}

TEST(Modification, FlanksAndZonesAreChosen) {
  auto m = modification_of(Kind::tip_relief, 0.02, 1);
  m.flanks = Flanks::right;
  EXPECT_GT(removed(m, 0, 61, 1), 0);
  EXPECT_EQ(removed(m, 0, 61, -1), 0);
  m.flanks = Flanks::left;
  EXPECT_EQ(removed(m, 0, 61, 1), 0);
  EXPECT_GT(removed(m, 0, 61, -1), 0);
  m.zone = 1;
  EXPECT_EQ(removed(m, 0, 61, -1, 0), 0);
  EXPECT_GT(removed(m, 0, 61, -1, 1), 0);
  EXPECT_TRUE(modification::Field({modification_of(Kind::tip_relief, 0, 1), modification_of(Kind::twist, 0)}, 1, 0, kOn)
                  .empty());
}

TEST(Modification, AGridGoesThroughItsValuesAndIsSmooth) {
  Modification m = modification_of(Kind::grid, 1);
  m.grid = modification::Grid{{0, 1, 2.5, 4}, {60, 61, 63, 64, 65}, {}};
  for (const double y : m.grid->depth_mm)
    for (const double x : m.grid->along_mm) m.grid->removal_mm.push_back(0.01 * std::sin(y) * std::cos(0.7 * x));
  const modification::Field field({m}, 1, 0, kOn);
  std::size_t k = 0;
  for (const double y : m.grid->depth_mm)
    for (const double x : m.grid->along_mm) EXPECT_NEAR(field.removal(y, x), m.grid->removal_mm[k++], 1e-16);
  using Dual2 = Dual<double, 2>;
  for (const double y : {-0.5, 0.0, 1.0, 1.3, 2.5, 4.0, 4.4})  // slopes agree on both sides of every knot
    for (const double x : {59.0, 60.0, 61.0, 62.2, 65.0}) {
      const double h = 1e-7;
      const auto slope = [&](double dy, double dx) {
        return field.removal(Dual2::variable(y + dy, 0), Dual2::variable(x + dx, 1));
      };
      EXPECT_NEAR(slope(-h, 0).d[0], slope(h, 0).d[0], 1e-8);
      EXPECT_NEAR(slope(0, -h).d[1], slope(0, h).d[1], 1e-8);
    }
}

/// All kinds at once, 10 um each.
std::vector<Modification> all_kinds(double depth, double from, double to) {
  auto linear = modification_of(Kind::tip_relief, 0.012, 0.3 * depth, Law::linear);
  auto end = modification_of(Kind::end_relief, 0.01, 0.2 * (to - from), Law::linear);
  end.transition_mm = 0.1 * (to - from);
  auto left = modification_of(Kind::twist, -0.008);
  left.flanks = Flanks::left;
  Modification grid = modification_of(Kind::grid, 1);
  grid.grid = modification::Grid{{0, 0.4 * depth, depth}, {from, 0.5 * (from + to), to}, {}};
  for (int k = 0; k < 9; ++k) grid.grid->removal_mm.push_back(0.003 * ((k * 7) % 5));
  return {linear,
          modification_of(Kind::root_relief, 0.009, 0.25 * depth),
          end,
          modification_of(Kind::profile_crowning, 0.006),
          modification_of(Kind::lead_crowning, -0.01),
          modification_of(Kind::pressure_angle_slope, 0.005),
          modification_of(Kind::helix_angle_slope, -0.007),
          left,
          grid};
}

face_gear::FaceGearParameters modified(face_gear::FaceGearParameters g) {
  const auto& zone = g.zones.front();
  g.modifications = all_kinds(2 * g.addendum_coefficient * g.module_mm, zone.inner_radius_mm, zone.outer_radius_mm);
  return g;
}

const std::vector<face_gear::FaceGearParameters>& modified_faces() {
  static const std::vector<face_gear::FaceGearParameters> list{modified(small_spur()), modified(offset_gear()),
                                                               modified(conical_gear())};
  return list;
}

/// Places of both flanks, off the lines where pieces of laws meet: there curvatures jump. visit(sheet, side, theta, B).
template <typename Visit>
void on_flanks(const face_gear::FaceGear& gear, Visit visit) {
  const auto& ring = gear.rings()[0];
  const auto& f = ring.surface;
  const face_gear::SpaceSheet sheet(gear.parameters(), ring);
  for (const int side : {1, -1})
    for (int k = 0; k <= 10; ++k) {
      const double r =
          ring.zone.inner_radius_mm + (ring.zone.outer_radius_mm - ring.zone.inner_radius_mm) * (k + 0.43) / 11;
      const auto low = face_gear::fillet_line_height(f, side, r);
      ASSERT_TRUE(low);
      for (int n = 0; n <= 12; ++n) {
        const auto at = face_gear::invert_flank(f, side, r, f.z_tip(r) + (*low - f.z_tip(r)) * (n + 0.37) / 13);
        if (at) visit(sheet, side, at->theta, at->B);
      }
    }
}

/// Point, normal and curvatures of the flank as the drawing says it, without the program's fields.
TEST(ModifiedFlank, ValueNormalAndCurvatureMatchFiftyDigits) {
  for (const auto& parameters : modified_faces()) {
    auto p = parameters;
    p.modifications.pop_back();  // the grid has a test of its own
    const auto gear = made(p);
    const auto f = face_gear::make_surface<F50>(gear.parameters(), p.zones[0].helix_angle_rad);
    double point = 0, normal = 0, bend = 0;
    on_flanks(gear, [&](const face_gear::SpaceSheet& sheet, int side, double theta, double B) {
      const auto exact = [&](const F50& t, const F50& b) {
        return modified_by_the_words<F50>(f, gear.parameters(), 0, side, t, b);
      };
      const F50 h("1e-12"), t(theta), b(B);
      const Vec3T<F50> x = exact(t, b), u0 = exact(t - h, b), u1 = exact(t + h, b), v0 = exact(t, b - h),
                       v1 = exact(t, b + h),
                       uv = exact(t + h, b + h) - exact(t + h, b - h) - exact(t - h, b + h) + exact(t - h, b - h);
      Vec3T<F50> n = Vec3T<F50>(u1 - u0).cross(Vec3T<F50>(v1 - v0));
      n = n / sqrt(F50(n.squaredNorm()));
      const auto q = sheet.at(tooth_space::flank_of(side), theta, B);
      ASSERT_TRUE(q);
      const double turn = side > 0 ? 0 : -gear.pitch();
      const Vec3 at = turned(q->p, turn), out = turned(q->n, turn);
      const auto near = [](const Vec3T<F50>& v) { return Vec3(double(v[0]), double(v[1]), double(v[2])); };
      if (near(n).dot(out) < 0) n = -n;
      point = std::max(point, (at - near(x)).norm());
      normal = std::max(normal, (out - near(n)).norm());
      // Second fundamental form: -p_ij n = n_i p_j.
      const F50 e = -(u1 - 2 * x + u0).dot(n) / (h * h), g = -(v1 - 2 * x + v0).dot(n) / (h * h),
                m = -uv.dot(n) / (4 * h * h);
      for (const auto& [mine, theirs] : {std::pair(q->nu.dot(q->pu), double(e)),
                                         {q->nv.dot(q->pv), double(g)},
                                         {q->nu.dot(q->pv), double(m)},
                                         {q->nv.dot(q->pu), double(m)}})
        bend = std::max(bend, std::abs(mine - theirs) / (1 + std::abs(theirs)));
    });
    std::printf("  modified flank: point %.1e mm, normal %.1e, curvature %.1e of itself\n", point, normal, bend);
    EXPECT_LE(point, 1e-9);
    EXPECT_LE(normal, 1e-9);
    EXPECT_LE(bend, 1e-9);
  }
}

TEST(ModifiedFlank, GridInDoubleIsTheGridInFiftyDigits) {
  const auto gear = made(modified_faces().front());
  const auto& field = gear.rings()[0].modification->side(1);
  std::mt19937_64 random(5);
  for (int k = 0; k < 200; ++k) {
    const double y = -0.5 + 5 * double(random() >> 11) * 0x1p-53, x = 59 + 7 * double(random() >> 11) * 0x1p-53;
    EXPECT_NEAR(field.removal(y, x), double(field.removal(F50(y), F50(x))), 1e-16);
  }
}

TEST(ModifiedFlank, FilletAndRootJoinSmoothlyAndTheFootIsFound) {
  for (const auto& p : modified_faces()) {
    const auto gear = made(p);
    const auto& ring = gear.rings()[0];
    const auto& f = ring.surface;
    const face_gear::SpaceSheet sheet(gear.parameters(), ring);
    for (const int side : {1, -1})
      for (int k = 1; k < 20; ++k) {
        const double r = ring.zone.inner_radius_mm + (ring.zone.outer_radius_mm - ring.zone.inner_radius_mm) * k / 20;
        const double Z = (std::sqrt(r * r - f.E * f.E) + f.shaper.r_p * f.Cg) / f.Sg;
        const auto g = f.fillet(side, f.shaper.A_t, Z);
        ASSERT_TRUE(g.defined);
        using tooth_space::Piece;
        const auto flank = side > 0 ? Piece::flank_plus : Piece::flank_minus,
                   fillet = side > 0 ? Piece::fillet_plus : Piece::fillet_minus;
        const auto a = sheet.at(flank, f.shaper.theta_t, g.B), b = sheet.at(fillet, f.shaper.A_t, Z);
        ASSERT_TRUE(a && b);
        EXPECT_LT((a->p - b->p).norm(), 1e-8);
        EXPECT_LT((a->n - b->n).norm(), 1e-5);
        const auto q = sheet.at(flank, 0.7 * f.shaper.theta_t, g.B);
        ASSERT_TRUE(q);
        const auto foot = sheet.foot(flank, q->p + 0.3 * q->n, 0.7 * f.shaper.theta_t + 0.01, g.B - 0.01);
        ASSERT_TRUE(foot);
        EXPECT_NEAR(foot->distance, 0.3, 1e-10);
      }
  }
}

TEST(ModifiedFlank, NothingModifiedIsThePlainGear) {
  auto p = small_spur();
  p.modifications = {modification_of(Kind::tip_relief, 0, 1), modification_of(Kind::twist, 0)};
  EXPECT_EQ(made(p).rings()[0].modification, nullptr);
}

TEST(ModifiedFlank, WhatDoesNotFitIsRefusedWithItsLimit) {
  const auto refusal = [](const Modification& m) {
    auto p = small_spur();
    p.modifications = {modification_of(Kind::lead_crowning, 0.01), m};
    auto gear = face_gear::FaceGear::make(p);
    return gear.refused() ? gear.refused()->front().key + ": " + gear.refused()->front().diagnostic.message
                          : std::string("accepted");
  };
  EXPECT_EQ(refusal(modification_of(Kind::tip_relief, 0.01, 5)),
            "modification[1].length: length = 5 mm is not above 0 and at most 4 mm, the depth of the active flank");
  EXPECT_EQ(refusal(modification_of(Kind::end_relief, 0.01, 3)),
            "modification[1].length: length = 3 mm is not above 0 and at most 2.5 mm, half the face, as both ends are "
            "relieved");
  EXPECT_EQ(refusal(modification_of(Kind::twist, 0.5)),
            "modification[1].amount: amount = 0.5 mm exceeds a tenth of the depth of the flank, 0.4 mm");
  EXPECT_EQ(refusal(modification_of(Kind::tip_relief, -0.01, 1)),
            "modification[1].amount: amount = -0.01 mm is below 0: a relief takes material");
  auto zone = modification_of(Kind::twist, 0.01);
  zone.zone = 1;
  EXPECT_EQ(refusal(zone), "modification[1].zone: zone = 1 is not below 1, the number of zones");
  EXPECT_NE(refusal(modification_of(Kind::tip_relief, 0.2, 1)).find("limit 0.1: a longer length"), std::string::npos)
      << refusal(modification_of(Kind::tip_relief, 0.2, 1));
  auto pointed = small_spur();
  pointed.zones = {{0, 60, 68.5}};
  ASSERT_TRUE(face_gear::FaceGear::make(pointed).value_if());
  pointed.modifications = {modification_of(Kind::pressure_angle_slope, 0.39)};
  auto gear = face_gear::FaceGear::make(pointed);
  ASSERT_TRUE(gear.refused());
  EXPECT_EQ(gear.refused()->front().key, "modification");
  EXPECT_NE(gear.refused()->front().diagnostic.message.find("limit 0: the tooth is pointed"), std::string::npos)
      << gear.refused()->front().diagnostic.message;
}

/// An interval holds every value and both derivatives at all places in it.
TEST(SmoothCurve, IntervalsHoldWhatTheyCover) {
  const auto gear = made(modified_faces().front());
  const auto& field = gear.rings()[0].modification->side(-1);
  using D = Dual<double, 2>;
  using D2 = Dual<D, 2>;
  using I = Dual<Interval, 2>;
  using I2 = Dual<I, 2>;
  const auto variable = [](auto one, const auto& x, std::size_t k) {
    decltype(one) s;
    s.v.v = x;
    s.v.d[k] = typename std::decay_t<decltype(s.v.d[k])>(1.0);
    s.d[k] = std::decay_t<decltype(s.d[k])>(1.0);
    return s;
  };
  std::mt19937_64 random(9);
  const auto between = [&](double a, double b) { return a + (b - a) * double(random() >> 11) * 0x1p-53; };
  for (int k = 0; k < 300; ++k) {
    const double y = between(-0.3, 4.3), x = between(59.5, 65.5), w = between(0, 0.6);
    const auto box = field.removal(variable(I2{}, Interval(y, y + w), 0), variable(I2{}, Interval(x, x + w), 1));
    for (int n = 0; n < 20; ++n) {
      const auto at = field.removal(variable(D2{}, between(y, y + w), 0), variable(D2{}, between(x, x + w), 1));
      EXPECT_TRUE(box.v.v.holds(at.v.v));
      for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(box.v.d[i].holds(at.v.d[i]));
        for (std::size_t j = 0; j < 2; ++j) EXPECT_TRUE(box.d[i].d[j].holds(at.d[i].d[j]));
      }
    }
  }
}

}  // namespace
}  // namespace toothpath::test
