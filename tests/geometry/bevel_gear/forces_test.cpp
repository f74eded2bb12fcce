// Tooth forces: against the normals of the machined flank, against the laws of mechanics, against the page's numbers.
#include "geometry/bevel_gear/forces.h"

#include "tests/geometry/bevel_gear/samples.h"

namespace toothpath {
namespace {

using namespace bevel_test;

bevel_gear::BevelForceMember member_of(const bevel_gear::BevelGear& g) {
  return {g.parameters().pressure_angle_rad, g.delta(), g.R_0()};
}
constexpr double kPinionTorque = 2e6 * 18 / 37;  // N mm

/// The force that pushes into the machined wall along its normal, torque given, as the formulas' three parts.
struct FlankForce {
  double tangential, axial, radial;
};
FlankForce from_flank(const bevel_gear::BevelGear& g, int wall, double R, double torque) {
  const auto& w = g.halves()[0].walls[wall];
  const auto at = bevel_gear::bevel_inverse(w, R, 0);
  const auto f = w.point(at->beta, at->p);
  const double r = std::hypot(f.p.x(), f.p.y()), cx = f.p.x() / r, cy = f.p.y() / r;
  const Vec3 push = -f.n;  // n points out of the material
  const double along = -push.x() * cy + push.y() * cx, size = torque / (r * std::abs(along));
  // The mesh turns a member whose wall L is loaded towards -azimuth.
  EXPECT_LT(along * w.sigma, 0);
  return {size * std::abs(along), size * push.z(), -size * (push.x() * cx + push.y() * cy)};
}

TEST(BevelForces, FollowTheNormalsOfTheMachinedFlank) {
  for (const auto& g : {made(w1(), pinion_mill()), made(w2(), wheel_mill()), gear_of(design(12, 60, 3, 45, 0.25)),
                        gear_of(design(44, 31, 2, 20, 0.3, -1))})
    for (int k = 0; k < 2; ++k)
      for (const double R : {g.R_i(), g.R_m(), g.R_e()}) {
        const int sigma = k == 0 ? 1 : -1, h = g.parameters().hand;
        const auto formula = bevel_gear::bevel_point_force(member_of(g), R, sigma * h, 1e6);
        const auto flank = from_flank(g, k, R, 1e6);
        const double size = std::hypot(flank.tangential, std::hypot(flank.axial, flank.radial));
        // The contact leaves the normal plane of the trace: 0.1 % in the middle of the face, up to 0.12 % at the
        // pinion's small end and 0.15 % with the 45 .. 52 deg of the steep gear.
        const double share = g.parameters().outer_spiral_angle_rad > radians(40) || R < g.R_m() ? 1.6e-3 : 1e-3;
        EXPECT_NEAR(formula.tangential, flank.tangential, share * size);
        EXPECT_NEAR(formula.axial(), flank.axial, share * size);
        EXPECT_NEAR(formula.radial(), flank.radial, share * size);
      }
}

/// Forces as vectors in one frame: pinion axis z, common generatrix in the x-z plane.
TEST(BevelForces, ActionAndReactionAtAnyShaftAngle) {
  for (const double shaft_deg : {60.0, 90.0, 115.0})
    for (const double R : {80.0, 110.0})
      for (const int sigma_h : {1, -1}) {
        const double Sigma = radians(shaft_deg), d1 = std::atan2(std::sin(Sigma), 37.0 / 18 + std::cos(Sigma)),
                     d2 = Sigma - d1, torque = 5e5;
        const bevel_gear::BevelForceMember one{radians(20), d1, 164}, two{radians(20), d2, 164};
        const auto a = bevel_gear::bevel_point_force(one, R, sigma_h, torque),
                   b = bevel_gear::bevel_point_force(two, R, -sigma_h, torque * std::sin(d2) / std::sin(d1));
        const Vec3 axis_2(std::sin(Sigma), 0, std::cos(Sigma)), out_2(-std::cos(Sigma), 0, std::sin(Sigma));
        // Same wall letter: both are turned towards -azimuth, which is +y for one and -y for the other.
        const Vec3 on_1 = a.axial() * Vec3(0, 0, 1) - a.radial() * Vec3(1, 0, 0) - a.tangential * Vec3(0, 1, 0);
        const Vec3 on_2 = b.axial() * axis_2 - b.radial() * out_2 - b.tangential * axis_2.cross(out_2);
        EXPECT_LT((on_1 + on_2).norm(), 1e-9 * on_1.norm());
      }
}

TEST(BevelForces, LineLoadIsTheSumOfManyNarrowFaces) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  const auto m = member_of(g);
  const auto faces = bevel_gear::herringbone_faces(g.R_i(), 104, g.R_e(), 3.2, 1);
  std::vector<bevel_gear::LoadedFace> narrow;
  for (const auto& f : faces)
    for (int k = 0; k < 400; ++k)
      narrow.push_back({f.from + (f.to - f.from) * k / 400, f.from + (f.to - f.from) * (k + 1) / 400, f.h});
  for (const int sigma : {1, -1}) {
    const auto exact = bevel_gear::bevel_total_force(m, faces, sigma, 1e6, bevel_gear::LoadSplit::line_load),
               sum = bevel_gear::bevel_total_force(m, narrow, sigma, 1e6, bevel_gear::LoadSplit::line_load_middles);
    EXPECT_NEAR(exact.axial(), sum.axial(), 1e-5 * exact.tangential);
    EXPECT_NEAR(exact.radial(), sum.radial(), 1e-5 * exact.tangential);
    EXPECT_NEAR(exact.tangential, sum.tangential, 1e-9 * exact.tangential);
  }
}

TEST(BevelForces, ThePagesNumbers) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  const auto m = member_of(g);
  const auto expect = [](const bevel_gear::BevelForce& f, double axial_kN, double radial_kN) {
    EXPECT_NEAR(f.axial() / 1000, axial_kN, 0.006);
    EXPECT_NEAR(f.radial() / 1000, radial_kN, 0.006);
  };
  expect(bevel_gear::bevel_point_force(m, g.R_m(), 1, kPinionTorque), 18.40, 1.71);
  expect(bevel_gear::bevel_point_force(m, g.R_m(), -1, kPinionTorque), -10.01, 15.54);
  const auto faces = bevel_gear::herringbone_faces(g.R_i(), 104, g.R_e(), 0, 1);
  expect(bevel_gear::bevel_total_force(m, faces, 1, kPinionTorque, bevel_gear::LoadSplit::line_load_middles), 4.76,
         8.38);
  expect(bevel_gear::bevel_total_force(m, faces, -1, kPinionTorque, bevel_gear::LoadSplit::line_load_middles), 3.66,
         8.92);
  expect(bevel_gear::bevel_total_force(m, faces, 1, kPinionTorque, bevel_gear::LoadSplit::equal_torque), 7.28, 7.39);
  expect(bevel_gear::bevel_total_force(m, faces, -1, kPinionTorque, bevel_gear::LoadSplit::equal_torque), 1.32, 10.29);
}

TEST(BevelForces, BalancedApexDistance) {
  const bevel_gear::BevelGear g = made(w1(), pinion_mill());
  const auto m = member_of(g);
  for (const double relief : {0.0, 3.2, 6.0}) {
    const auto R_J = bevel_gear::balanced_apex_distance(g.R_i(), g.R_e(), g.R_0(), relief);
    ASSERT_TRUE(R_J);
    const auto faces = bevel_gear::herringbone_faces(g.R_i(), *R_J, g.R_e(), relief, 1);
    const auto L = bevel_gear::bevel_total_force(m, faces, 1, 1e6, bevel_gear::LoadSplit::line_load),
               U = bevel_gear::bevel_total_force(m, faces, -1, 1e6, bevel_gear::LoadSplit::line_load);
    EXPECT_NEAR(L.axial(), U.axial(), 1e-9 * L.tangential);
    EXPECT_NEAR(L.radial(), U.radial(), 1e-9 * L.tangential);
    EXPECT_NEAR(L.axial_spiral, 0, 1e-9 * L.tangential);
    EXPECT_GT(L.axial_pressure, 0.1 * L.tangential);  // this part stays
  }
  EXPECT_NEAR(*bevel_gear::balanced_apex_distance(g.R_i(), g.R_e(), g.R_0()), 103.312, 6e-4);
  EXPECT_FALSE(bevel_gear::balanced_apex_distance(g.R_i(), g.R_e(), g.R_0(), 18.1));
  // Equal torque never balances: the inner half prevails at every R_J.
  for (double R_J = g.R_i() + 1; R_J < g.R_e() - 1; R_J += 2)
    EXPECT_GT(bevel_gear::bevel_total_force(m, bevel_gear::herringbone_faces(g.R_i(), R_J, g.R_e(), 0, 1), 1, 1e6,
                                            bevel_gear::LoadSplit::equal_torque)
                  .axial_spiral,
              0);
}

}  // namespace
}  // namespace toothpath
