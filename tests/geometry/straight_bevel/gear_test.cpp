// The straight bevel gear against printed numbers, against the sweep of its crown gear, and what is refused.
#include <gtest/gtest.h>

#include <functional>

#include "geometry/tooth_space/curvature.h"
#include "tests/geometry/straight_bevel/samples.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using straight_bevel::Form;
using straight_bevel::StraightBevelGear;
using straight_bevel::StraightBevelParameters;
using tooth_space::Piece;

StraightBevelGear made(const StraightBevelParameters& g) { return StraightBevelGear::make(g).value(); }
double polar(const Vec3& p) { return std::atan2(radius(p), p.z()); }

/// Outer cone distance, angles and the blank of the example, to the printed digit.
TEST(StraightBevel, NumbersAreThePrintedOnes) {
  const auto g = khk_pinion();
  const straight_bevel::CrownKernel<double> w(g);
  EXPECT_NEAR(g.pitch_angle_rad, 0.463647609001, 1e-12);
  EXPECT_NEAR(w.R_e, 67.082039325, 1e-9);
  EXPECT_NEAR(w.theta_f, 0.037682260288, 1e-12);
  EXPECT_NEAR(w.eta, 0.013415602967, 1e-12);
  EXPECT_NEAR(w.psi, 0.029805213293, 1e-12);
  EXPECT_NEAR(w.eps, -0.024266657321, 1e-12);
  EXPECT_NEAR(w.chi, 0.006688716807, 1e-12);
  const auto& chart = w.outline().chart;
  const double s_e = -w.R_e, s_i = -w.R_i;
  EXPECT_NEAR(2 * chart.r(s_e, w.tip<double>(s_e)), 67.2180, 5e-5);
  EXPECT_NEAR(chart.z(s_e, w.tip<double>(s_e)), 58.1955, 5e-5);
  EXPECT_NEAR(2 * chart.r(s_i, w.tip<double>(s_i)), 44.8425, 5e-5);
  EXPECT_NEAR(degrees(made(g).root_angle()), 24.40602, 5e-6);
}

struct PrintedPlace {
  int side;
  bool fillet;
  double r, z, azimuth;
  Vec3 n;
};

TEST(StraightBevel, PlacesAndNormalsAreThePrintedOnes) {
  const PrintedPlace all[] = {
      {1, false, 26.084912068, 49.659170090, -0.085117587, {0.454802881162, 0.868012318367, -0.199271057731}},
      {-1, false, 26.084912068, 49.659170090, 0.085117587, {0.454802881162, -0.868012318367, -0.199271057731}},
      {1, false, 23.141125544, 41.292364251, -0.115660789, {0.542882676410, 0.801620378377, -0.250366069237}},
      {-1, false, 31.924046578, 56.578301936, 0.119230168, {0.550941102355, -0.794524079722, -0.255333876479}},
      {1, true, 23.479098882, 50.962076683, -0.042712262, {0.592797856518, 0.762956131706, -0.257853916782}},
      {-1, true, 23.479098882, 50.962076683, 0.042712262, {0.592797856518, -0.762956131706, -0.257853916782}},
  };
  const auto gear = made(khk_pinion());
  for (const PrintedPlace& q : all) {
    const Piece piece =
        q.fillet ? (q.side > 0 ? Piece::fillet_plus : Piece::fillet_minus) : tooth_space::flank_of(q.side);
    // The place of the piece with the printed polar angle.
    const auto& w = gear.space().kernel();
    double a = q.fillet ? 0 : w.u_F, b = q.fillet ? w.b_F : -0.6;
    const double R = std::hypot(q.r, q.z);
    for (int k = 0; k < 80; ++k) {
      const double m = 0.5 * (a + b);
      (polar(gear.space().point(piece, m, -R)->p) < std::atan2(q.r, q.z) ? a : b) = m;
    }
    const auto at = gear.space().point(piece, a, -R);
    ASSERT_TRUE(at);
    EXPECT_NEAR(azimuth(at->p), q.azimuth, 2e-9);
    EXPECT_LT((at->n - q.n).norm(), 2e-9);
  }
}

/// Pieces join with the same point and normal, and the normal stands square on both derivatives.
TEST(StraightBevel, PiecesJoinSmoothly) {
  for (const Form form : {Form::octoid, Form::spherical_involute}) {
    const auto gear = made(khk_pinion(form));
    const auto& w = gear.space().kernel();
    for (const double v : {-67.0, -50.0}) {
      const auto flank = gear.space().at(Piece::flank_minus, w.u_F, v),
                 join = gear.space().at(Piece::fillet_minus, w.b_F, v);
      ASSERT_TRUE(flank && join);
      EXPECT_LT((flank->p - join->p).norm(), 1e-11) << int(form);
      EXPECT_LT((flank->n - join->n).norm(), 1e-12);
      const auto root = gear.space().at(Piece::root, 1, v), end = gear.space().at(Piece::fillet_minus, 0, v);
      EXPECT_LT((root->p - end->p).norm(), 1e-11);
      EXPECT_LT((root->n - end->n).norm(), 1e-12);
      for (const auto& q : {*flank, *join, *root}) {
        EXPECT_NEAR(q.n.norm(), 1, 1e-14);
        EXPECT_LT(std::abs(q.n.dot(q.pu)) + std::abs(q.n.dot(q.pv)), 1e-12 * 67);
        EXPECT_NEAR(tooth_space::principal_curvatures(q).least * tooth_space::principal_curvatures(q).most, 0, 1e-12);
      }
    }
  }
}

/// Signed distance from a direction to the crown gear's tooth, negative inside, as an angle: flanks that are planes
/// through the apex, the tip cone, and a circular cone between them.
double crown_distance(const straight_bevel::CrownKernel<double>& w, const Vec3& crown) {
  const double v = std::abs(crown.y());
  const Vec3 x(crown.x(), v, crown.z());
  const Vec3 n(-std::sin(w.psi) * w.cos_a, std::cos(w.psi) * w.cos_a, -w.sin_a);
  const double flank = std::asin(x.dot(n)), tip = -w.theta_f - std::asin(x.z());
  const Vec3 c(std::cos(w.eps) * std::cos(w.chi), std::cos(w.eps) * std::sin(w.chi), std::sin(w.eps));
  // In the corner between the places where the rounding leaves the flank and the tip.
  const Vec3 tip_place(std::cos(w.eps - w.eta) * std::cos(w.chi), std::cos(w.eps - w.eta) * std::sin(w.chi),
                       std::sin(w.eps - w.eta)),
      across = c.cross(n);
  const bool corner = std::atan2(x.y(), x.x()) > w.chi && x.dot(across) * tip_place.dot(across) > 0;
  const double round = std::acos(std::min(1.0, c.dot(x))) - w.eta;
  const double sharp = std::max(flank, tip);
  return corner ? round : sharp;
}

/// The octoid gear is what its crown gear leaves: no place of it lies inside a tooth of the crown at any turn, and each
/// touches it at one.
TEST(StraightBevel, IsWhatItsCrownGearLeaves) {
  const auto gear = made(khk_pinion());
  const auto& w = gear.space().kernel();
  Random random(7);
  for (int k = 0; k < 200; ++k) {
    const bool fillet = k % 2 == 0;
    const Piece piece = fillet ? Piece::fillet_minus : Piece::flank_minus;
    const double u = fillet ? random(0.05, 0.95) * w.b_F : w.u_F - random(0.02, 0.98) * (w.u_F + 0.25);
    const Vec3 p = gear.space().point(piece, u, -1)->p;
    double least = INFINITY;
    for (int i = -4000; i <= 4000; ++i) {
      const double omega = 0.4 * i / 4000;
      const Vec3 q = turned(p, omega / w.sin_d);
      const Vec3 crown(q.x() * w.sin_d + q.z() * w.cos_d, q.y(), q.x() * w.cos_d - q.z() * w.sin_d);
      least = std::min(least, crown_distance(w, turned(crown, -omega)));
    }
    EXPECT_GT(least, -1e-9) << k << " " << u;
    EXPECT_LT(least, 2e-7) << k << " " << u;  // turns are 1e-4 apart
  }
}

TEST(StraightBevel, InvoluteHasAConstantMoment) {
  const auto gear = made(khk_pinion(Form::spherical_involute));
  const auto& w = gear.space().kernel();
  for (const double u : {w.u_F, w.u_F + 0.05, w.u_F + 0.1}) {
    const auto q = gear.space().point(Piece::flank_plus, u, -1.0);
    EXPECT_NEAR(q->p.cross(q->n).z(), w.sin_db, 1e-14);
  }
  // Both forms have the same thickness on the pitch cone, and differ by micrometres at the tip.
  const auto octoid = made(khk_pinion());
  const auto& o = octoid.space().kernel();
  const auto at = [](const auto& g, double u, double R) {
    return azimuth(g.space().point(Piece::flank_minus, u, -R)->p);
  };
  const double pitch = khk_pinion().pitch_angle_rad;
  EXPECT_NEAR(at(gear, w.flank_at(pitch), 54), at(octoid, o.flank_at(pitch), 54), 1e-12);
}

/// Second derivatives at random places lie in the enclosures of boxes around them.
TEST(StraightBevel, EnclosuresHold) {
  for (const Form form : {Form::octoid, Form::spherical_involute}) {
    const auto gear = made(khk_pinion(form));
    const auto& w = gear.space().kernel();
    Random random(3);
    for (int k = 0; k < 60; ++k) {
      const Piece piece = k % 3 == 0 ? Piece::flank_plus : k % 3 == 1 ? Piece::fillet_minus : Piece::root;
      const double u = k % 3 == 0   ? w.u_F + (form == Form::octoid ? -1 : 1) * random(0, 0.1)
                       : k % 3 == 1 ? random(0, 1) * w.b_F
                                    : random(0, 1);
      tooth_space::PatchFrame frame;
      frame.origin = {u, random(-67, -46)};
      const double ha = 0.01, hb = 0.3, step = 1e-4;
      const auto jet = gear.space().enclosure(piece, frame, ha, hb);
      ASSERT_TRUE(jet);
      const Vec2 at = frame.origin + Vec2(random(-0.9, 0.9) * ha, random(-0.9, 0.9) * hb);
      const auto a = gear.space().at(piece, at.x() - step, at.y()), b = gear.space().at(piece, at.x() + step, at.y());
      const Vec3 puu = (b->pu - a->pu) / (2 * step), puv = (b->pv - a->pv) / (2 * step);
      for (std::size_t i = 0; i < 3; ++i) {
        const double slack = 1e-4 * (1 + std::abs(puu[int(i)]));
        EXPECT_GT(puu[int(i)], jet->second[0][i].low - slack);
        EXPECT_LT(puu[int(i)], jet->second[0][i].high + slack);
        EXPECT_GT(puv[int(i)], jet->second[1][i].low - slack);
        EXPECT_LT(puv[int(i)], jet->second[1][i].high + slack);
      }
    }
  }
}

TEST(StraightBevel, EveryLimitIsRefusedByItsKey) {
  const std::pair<const char*, std::function<void(StraightBevelParameters&)>> all[] = {
      {"teeth", [](auto& g) { g.teeth = 3; }},
      {"pitch_angle", [](auto& g) { g.pitch_angle_rad = radians(90); }},
      {"outer_transverse_module", [](auto& g) { g.outer_transverse_module_mm = -1; }},
      {"pressure_angle", [](auto& g) { g.pressure_angle_rad = radians(50); }},
      {"face_width", [](auto& g) { g.face_width_mm = 65; }},
      {"addendum", [](auto& g) { g.addendum_mm = 0; }},
      {"addendum", [](auto& g) { g.addendum_mm = 7; }},
      {"addendum", [](auto& g) { g.tip_angle_rad.reset(), g.addendum_mm = 4.9, g.least_land = 0.6; }},
      {"dedendum", [](auto& g) { g.dedendum_mm = 35; }},
      {"dedendum", [](auto& g) { g.dedendum_mm = NAN; }},
      {"dedendum", [](auto& g) { g.dedendum_mm = 8; }},
      {"tip_angle", [](auto& g) { g.tip_angle_rad = radians(44); }},
      {"fillet_radius", [](auto& g) { g.fillet_radius_mm = 1.6; }},
      {"thickness_shift", [](auto& g) { g.thickness_shift = 0.9; }},
      {"thickness_shift", [](auto& g) { g.thickness_shift = 0.5; }},
      {"backlash", [](auto& g) { g.backlash_mm = -0.1; }},
      {"bore_diameter", [](auto& g) { g.bore_diameter_mm = 60; }},
      {"hub_length", [](auto& g) { g.hub_length_mm = -1; }},
      {"dedendum",
       [](auto& g) { g.form = Form::spherical_involute, g.pressure_angle_rad = radians(5), g.dedendum_mm = 6; }},
  };
  for (const auto& [key, change] : all) {
    auto g = khk_pinion();
    change(g);
    const auto gear = StraightBevelGear::make(g);
    ASSERT_TRUE(gear.refused()) << key;
    EXPECT_EQ(gear.refused()->front().key, key) << gear.refused()->front().diagnostic.message;
  }
}

/// A tooth that leaves the crown gear's no tip is refused with the thickness that leaves one.
TEST(StraightBevel, AThicknessThatLeavesNoTipIsToldWithOneThatDoes) {
  auto g = khk_pinion();
  g.thickness_shift = 0.5;
  const std::string message = StraightBevelGear::make(g).refused()->front().diagnostic.message,
                    before = "a thickness_shift of ";
  ASSERT_NE(message.find(before), std::string::npos) << message;
  const double most = std::stod(message.substr(message.find(before) + before.size()));
  const auto rounded = [&](double shift) {
    g.thickness_shift = shift;
    const auto made = StraightBevelGear::make(g);
    if (!made.refused()) return true;
    const Refusal& refusal = made.refused()->front();
    return refusal.key != "fillet_radius" && refusal.diagnostic.message.find("rounding") == std::string::npos;
  };
  EXPECT_TRUE(rounded(most));
  EXPECT_FALSE(rounded(most + 2e-4));
}

/// A quarter turn beyond the pitch line the octoid's flank stands upright in the meridian, R / tan(alpha) above the
/// pitch cone: a face cone that lies higher is refused by so much.
TEST(StraightBevel, FlanksThatEndBelowTheFaceConeAreToldByHowMuch) {
  auto g = khk_pinion();
  g.pressure_angle_rad = radians(30);
  g.fillet_radius_mm = 0.1;
  g.dedendum_mm = 1;
  g.addendum_mm = 120;
  const auto made = StraightBevelGear::make(g);
  ASSERT_TRUE(made.refused());
  const std::string message = made.refused()->front().diagnostic.message, before = "the flanks end ";
  ASSERT_NE(message.find(before), std::string::npos) << message;
  const double R_e = 0.5 * g.outer_transverse_module_mm * g.teeth / std::sin(g.pitch_angle_rad),
               lack = 120 - R_e / std::tan(radians(30));
  EXPECT_GT(lack, 1);
  EXPECT_NEAR(std::stod(message.substr(message.find(before) + before.size())), lack, 1e-4) << message;
}

/// Flanks that go on far beyond where they meet come round the axis again: that is no land.
TEST(StraightBevel, FlanksThatComeRoundAgainArePointed) {
  auto g = khk_pinion();
  g.pressure_angle_rad = radians(30);
  g.fillet_radius_mm = 0.1;
  g.dedendum_mm = 1;
  for (g.addendum_mm = 8; g.addendum_mm < 100; g.addendum_mm += 4) {
    const auto made = StraightBevelGear::make(g);
    ASSERT_TRUE(made.refused()) << g.addendum_mm;
    EXPECT_NE(made.refused()->front().diagnostic.message.find("the tooth is pointed"), std::string::npos)
        << g.addendum_mm << made.refused()->front().diagnostic.message;
  }
}

}  // namespace
}  // namespace toothpath::test
