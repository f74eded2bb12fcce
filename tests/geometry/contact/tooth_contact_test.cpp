// Rolling a pinion on a face gear: closed-form path, transmission error, pattern, edges, deviations, forces.
#include "geometry/contact/tooth_contact.h"

#include <gtest/gtest.h>

#include "geometry/contact/face_gear_forces.h"
#include "geometry/contact/touch_search.h"
#include "tests/support/brute_force_contact.h"
#include "tests/support/face_gear_cases.h"
#include "tests/support/fifty_digits.h"

namespace toothpath::test {
namespace {

const std::vector<contact::Misalignment>& moves() {
  static const std::vector<contact::Misalignment> list = {
      {0, 0, 0},       {0.1, 0, 0},         {0, 0.15, 0},         {0, 0, 0.0004},
      {0, 0, -0.0008}, {0.1, 0.15, 0.0004}, {-0.05, 0.1, -0.0006}};
  return list;
}

face_gear::FaceGear gear_of(const FaceGearCase& c, double inner, double outer) {
  face_gear::FaceGearParameters p = c.parameters();
  p.zones = {{c.beta(), inner, outer}};
  auto made = face_gear::FaceGear::make(p);
  if (auto* refused = made.refused()) throw std::invalid_argument(refused->front().diagnostic.message);
  return std::move(made).value();
}

contact::ContactMember member_of(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                                 const contact::Misalignment& moved = {}, int rows = 31, int columns = 41) {
  auto flank = contact::exact_flank(gear, 0, side, rows, columns);
  if (!flank) throw std::invalid_argument(flank.error().message);
  return {std::move(flank.value()), contact::make_pinion(gear.rings()[0].surface, pinion_teeth, moved)};
}

/// Both flanks at the point of the path: distance of the points and of the normals.
template <typename S>
std::pair<S, S> misfit(const face_gear::FaceGearSurface<S>& f, const contact::Pinion<S>& pinion,
                       const contact::ContactPath<S>& path, const S& theta_1) {
  const int s = path.side;
  const auto gear = f.flank(s, path.theta(theta_1), path.B);
  const auto mate = pinion.flank(s, theta_1, path.section(theta_1, pinion.T), path.phi_1(theta_1));
  const S turn = path.phi_2(theta_1);
  const Vec3T<S> dp = turned(gear.p, turn) - mate.p, dn = turned(gear.n, turn) - mate.n;
  const Vec3T<S> on_path = path.point(theta_1) - mate.p;
  using std::sqrt;
  return {S(sqrt(S(dp.dot(dp))) + sqrt(S(on_path.dot(on_path)))), S(sqrt(S(dn.dot(dn))))};
}

/// An error of the shaft angle turns the pinion's axis about its own foot of the common perpendicular of both axes,
/// also where the pinion has fewer teeth than the shaper and its axis lies lower.
TEST(Pinion, ShaftAngleErrorTurnsAboutTheFoot) {
  for (const char* name : {"offset_15", "gamma_75_mixed", "gamma_120"}) {
    const auto c = case_named(name);
    const auto f = face_gear::make_surface<double>(c.parameters(), c.beta());
    // Where an axis comes nearest to the z axis: both directions lie in the plane of x and z.
    const auto foot = [](const contact::Pinion<double>& pinion) {
      return Vec3(pinion.foot - pinion.a * (pinion.foot.x() / pinion.a.x()));
    };
    const int teeth = f.shaper.teeth - 4;
    const auto stands = contact::make_pinion(f, teeth), turned = contact::make_pinion(f, teeth, {0, 0, 0.02});
    EXPECT_NEAR((foot(stands) - foot(turned)).norm(), 0, 1e-12) << name;
    EXPECT_NEAR(std::acos(stands.a.dot(turned.a)), 0.02, 1e-9);
    // Sections are counted from there on, as before.
    EXPECT_NEAR((foot(stands) - stands.foot).dot(stands.a), (foot(turned) - turned.foot).dot(turned.a), 1e-12);
  }
}

template <typename S>
void expect_common_points(double tolerance) {
  using std::abs;
  for (const char* name : {"offset_15", "dhfg_normal", "gamma_75_mixed", "gamma_120", "beta_45", "gamma_110_mixed"}) {
    const auto c = case_named(name);
    const auto f = c.surface<S>();
    const double m = c.module_mm / 5;
    for (const auto& moved : moves()) {
      const auto pinion =
          contact::make_pinion(f, c.shaper_teeth - 2, {moved.offset_mm * m, moved.axial_mm * m, moved.angle_rad});
      for (const int s : {1, -1}) {
        SCOPED_TRACE(
            fmt::format("{} side {} dE {} dL {} dgamma {}", name, s, moved.offset_mm, moved.axial_mm, moved.angle_rad));
        const auto path = contact::contact_path(f, pinion, s);
        ASSERT_TRUE(path.has_value());
        EXPECT_FALSE(path->line_contact);
        for (const double theta_1 : {0.05, 0.2, 0.364, 0.55}) {
          const auto [dp, dn] = misfit<S>(f, pinion, *path, S(theta_1));
          EXPECT_LT(static_cast<double>(dp), tolerance * static_cast<double>(f.L_p)) << theta_1;
          EXPECT_LT(static_cast<double>(dn), tolerance * 10) << theta_1;
          const S error = path->phi_2(S(theta_1)) - path->phi_1(S(theta_1)) * pinion.ratio;
          EXPECT_LT(static_cast<double>(abs(S(error - path->error()))), tolerance);
        }
        if (moved.offset_mm == 0 && moved.axial_mm == 0 && moved.angle_rad == 0) {
          EXPECT_LT(static_cast<double>(abs(path->error())), tolerance * 10);
          EXPECT_LT(static_cast<double>(abs(S(path->B - S(s) * f.shaper.alpha_t))), tolerance * 100);
        }
      }
    }
  }
}

TEST(ContactPath, FlanksShareEveryPointAndNormal) { expect_common_points<double>(2e-13); }
TEST(ContactPath, FlanksShareEveryPointAndNormalIn50Digits) { expect_common_points<F50>(1e-44); }

/// A pinion that is the shaper touches along lines: every B is a common normal.
TEST(ContactPath, AsManyTeethAsTheShaperGivesLineContact) {
  for (const char* name : {"offset_15", "dhfg_transverse", "gamma_75_mixed"}) {
    const auto f = case_named(name).surface();
    for (const int s : {1, -1}) {
      const auto path = contact::contact_path(f, contact::make_pinion(f, f.shaper.teeth), s);
      ASSERT_TRUE(path.has_value());
      EXPECT_TRUE(path->line_contact) << name;
      EXPECT_NEAR(path->error(), 0, 1e-13);
      EXPECT_FALSE(contact::contact_path(f, contact::make_pinion(f, f.shaper.teeth - 1), s)->line_contact);
    }
  }
}

/// Printed radii of the aligned path, gear tip and pinion tip; and 0.1 mm of offset moves it from 20 to 21.996 deg.
TEST(ContactPath, RadiiOfTheOffsetGear) {
  const face_gear::FaceGear gear = gear_of(case_named("offset_15"), 130.5, 147);
  struct Row {
    int side;
    double tip, pinion_tip;
  };
  for (const Row& row : {Row{1, 134.031, 132.266}, Row{-1, 132.173, 133.759}}) {
    const auto member = member_of(gear, row.side, 23);
    const auto path = contact::contact_path(member.flank.surface, member.pinion, row.side);
    const auto range = contact::path_on_flanks(*path, member);
    ASSERT_TRUE(range.has_value());
    const auto radius = [&](double theta_1) { return path->point(theta_1).head<2>().norm(); };
    EXPECT_NEAR(radius(range->theta_1_from), row.tip, 6e-4);
    EXPECT_NEAR(radius(range->theta_1_to), row.pinion_tip, 6e-4);
    EXPECT_NEAR(radius(0.5 * (range->theta_1_from + range->theta_1_to)), 132.85, 1.0);
  }
  const auto f = gear.rings()[0].surface;
  EXPECT_NEAR(degrees(contact::contact_path(f, contact::make_pinion(f, 23, {0.1, 0, 0}), 1)->B), 21.996, 6e-4);
}

/// Inside the flank the rolled transmission error is the closed form's constant, aligned and not: ripple below 1e-12
/// rad.
TEST(Roll, TransmissionErrorIsConstantInsideTheFlank) {
  const face_gear::FaceGear gear = gear_of(case_named("offset_15"), 130.5, 147);
  for (const auto& moved : {contact::Misalignment{}, contact::Misalignment{0.05, 0, 0},
                            contact::Misalignment{0, 0.08, 0}, contact::Misalignment{0.04, 0.05, -0.0002}})
    for (const int side : {1, -1}) {
      SCOPED_TRACE(fmt::format("side {} dE {}", side, moved.offset_mm));
      const auto member = member_of(gear, side, 23, moved);
      const auto path = contact::contact_path(member.flank.surface, member.pinion, side);
      const auto range = contact::path_on_flanks(*path, member);
      ASSERT_TRUE(range && range->ratio > 1.2);
      const auto rolled = contact::roll({member}, {.steps = 12});
      ASSERT_TRUE(rolled) << rolled.error().message;
      EXPECT_LT(rolled->error_range_rad, 1e-12);
      EXPECT_NEAR(rolled->error_mean_rad, path->error(), 1e-12);
      EXPECT_NEAR(rolled->contact_ratio, range->ratio, 1.01 / 12);
      EXPECT_EQ(rolled->least_touching, 1);
      EXPECT_EQ(rolled->most_touching, 2);
      int on_path = 0;
      for (const auto& place : rolled->patterns[0].path) {
        // On the line of the closed form: its radius at this turn of the pinion. Just beyond its ends the edges still
        // touch.
        const double theta_1 = (path->phi_1_0 - place.phi_1) / path->per_theta;
        if (theta_1 < range->theta_1_from || theta_1 > range->theta_1_to) continue;
        ++on_path;
        EXPECT_NEAR(place.radius_mm, path->point(theta_1).head<2>().norm(), 1e-4);
        EXPECT_NEAR(place.height_mm, path->point(theta_1).z(), 1e-4);
      }
      EXPECT_GE(on_path, 14);
    }
}

/// The double helical gear with its pinion: line contact on all of both halves, no transmission error, two to three
/// pairs.
TEST(Roll, DoubleHelicalGearHasLineContact) {
  const auto c = case_named("dhfg_transverse");
  face_gear::FaceGearParameters p = c.parameters();
  p.reference_radius_mm = 472;
  p.shaper_tip_radius_mm = 1.5;
  p.zones = {{-c.beta(), 449, 468}, {c.beta(), 476, 496}};
  auto made = face_gear::FaceGear::make(p);
  ASSERT_TRUE(made.has_value());
  const face_gear::FaceGear& gear = made.value();
  for (const int side : {1, -1}) {
    std::vector<contact::ContactMember> members;
    for (const int zone : {0, 1}) {
      auto flank = contact::exact_flank(gear, zone, side, 17, 21);
      ASSERT_TRUE(flank);
      members.push_back({*flank, contact::make_pinion(gear.rings()[std::size_t(zone)].surface, 30)});
    }
    const auto rolled = contact::roll(members, {.steps = 12});
    ASSERT_TRUE(rolled) << rolled.error().message;
    EXPECT_LT(rolled->error_range_rad, 1e-12);
    EXPECT_NEAR(rolled->error_mean_rad, 0, 1e-12);
    EXPECT_GE(rolled->least_touching, 2);
    EXPECT_LE(rolled->most_touching, 4);
    for (std::size_t m = 0; m < 2; ++m) {
      const auto& pattern = rolled->patterns[m];
      for (std::size_t k = 0; k < pattern.gap_mm.size(); ++k) EXPECT_GT(pattern.gap_mm[k], -1e-9);
      EXPECT_GT(pattern.marked_share, 0.8);
    }
  }
}

/// A path that has left the flank: contact on edges, an error that is not constant, and the same as two dense clouds of
/// points give.
TEST(Roll, EdgeContactAgreesWithPointClouds) {
  const face_gear::FaceGear gear =
      gear_of(case_named("offset_15"), 137, 147);  // the aligned path runs at 132 to 134 mm
  for (const int side : {1, -1}) {
    const auto member = member_of(gear, side, 23);
    const auto path = contact::contact_path(member.flank.surface, member.pinion, side);
    EXPECT_FALSE(contact::path_on_flanks(*path, member).has_value());
    const auto rolled = contact::roll({member}, {.steps = 10});
    ASSERT_TRUE(rolled) << rolled.error().message;
    EXPECT_GT(rolled->error_range_rad, 1e-6);
    const BruteForceContact brute(gear, 0, side, 23);
    for (const auto& position : rolled->cycle) {
      EXPECT_LT(position.radius_mm, 137.3);  // at the inner end
      EXPECT_NEAR(brute.gear_turn(position.phi_1), position.phi_2, 4e-7);
    }
  }
}

/// The same clouds where contact is inside: aligned and misaligned.
TEST(Roll, InnerContactAgreesWithPointClouds) {
  const face_gear::FaceGear gear = gear_of(case_named("offset_15"), 130.5, 147);
  for (const auto& moved : {contact::Misalignment{}, contact::Misalignment{0.05, 0.05, -0.0002}}) {
    const auto member = member_of(gear, 1, 23, moved);
    const auto rolled = contact::roll({member}, {.steps = 6});
    ASSERT_TRUE(rolled);
    const BruteForceContact brute(gear, 0, 1, 23, moved);
    for (const auto& position : rolled->cycle) EXPECT_NEAR(brute.gear_turn(position.phi_1), position.phi_2, 4e-7);
  }
}

/// Modified flanks of both, line contact turned into a patch, and the same by clouds that know the words only.
TEST(Roll, ModifiedContactAgreesWithPointClouds) {
  auto p = gear_of(case_named("offset_15"), 130.5, 147).parameters();
  const auto of = [](modification::Kind kind, double amount, double length = 0) {
    modification::Modification m;
    m.kind = kind;
    m.amount_mm = amount;
    m.length_mm = length;
    return m;
  };
  using modification::Kind;
  p.modifications = {of(Kind::tip_relief, 0.02, 2), of(Kind::lead_crowning, 0.015), of(Kind::twist, 0.01),
                     of(Kind::pressure_angle_slope, -0.006)};
  const std::vector<modification::Modification> on_pinion = {
      of(Kind::tip_relief, 0.012, 1.5), of(Kind::profile_crowning, 0.008), of(Kind::helix_angle_slope, 0.01)};
  auto made = face_gear::FaceGear::make(p);
  ASSERT_TRUE(made.value_if());
  const face_gear::FaceGear& gear = *made.value_if();
  for (const int side : {1, -1})
    for (const int teeth : {25, 23}) {
      auto member = member_of(gear, side, teeth);
      const auto plain = member;
      member.on_pinion = std::make_shared<const modification::Field>(
          on_pinion, side, 0, contact::rectangle_of(member.pinion, gear.rings()[0]));
      const auto rolled = contact::roll({member}, {.steps = 6});
      ASSERT_TRUE(rolled) << rolled.error().message;
      EXPECT_LT(rolled->patterns[0].marked_share, 0.9);
      const BruteForceContact brute(gear, 0, side, teeth, {}, on_pinion);
      for (const auto& position : rolled->cycle) EXPECT_NEAR(brute.gear_turn(position.phi_1), position.phi_2, 4e-7);
      // The pinion's share is seen.
      const auto without = contact::roll({plain}, {.steps = 6});
      ASSERT_TRUE(without);
      EXPECT_GT(std::abs(without->error_mean_rad - rolled->error_mean_rad) + rolled->error_range_rad, 1e-6);
    }
}

/// Stock all over a flank is a turn of it by stock / M2; a planted hump shows with its height where the path crosses
/// it.
TEST(Roll, DeviationsShowInTheTransmissionError) {
  const face_gear::FaceGear gear = gear_of(case_named("offset_15"), 130.5, 147);
  for (const int side : {1, -1}) {
    const auto exact = member_of(gear, side, 23);
    const double M2 = exact.flank.surface.M2;
    auto moved = exact;
    for (double& d : moved.flank.deviation_mm) d = 0.004;
    const auto even = contact::roll({moved}, {.steps = 10});
    ASSERT_TRUE(even);
    EXPECT_LT(even->error_range_rad * M2, 1e-7);
    EXPECT_NEAR(even->error_mean_rad * M2, -side * 0.004, 1e-6);

    auto humped = exact;
    for (int r = 0; r < humped.flank.rows; ++r)
      for (int c = 0; c < humped.flank.columns; ++c)
        if (std::abs(r - humped.flank.rows / 2) <= 1) humped.flank.deviation_mm[humped.flank.index(r, c)] = 0.003;
    const auto ripple = contact::roll({humped}, {.steps = 48});
    ASSERT_TRUE(ripple);
    EXPECT_NEAR(ripple->error_range_rad * M2, 0.003, 3e-5);
  }
}

/// Measured places in another order of rows, of another tooth: the same flank.
TEST(MeasuredFlank, OrderOfRowsAndToothDoNotMatter) {
  const face_gear::FaceGear gear = gear_of(case_named("offset_15"), 130.5, 147);
  const auto exact = contact::exact_flank(gear, 0, -1, 9, 11);
  ASSERT_TRUE(exact);
  std::vector<Vec3> points;
  std::vector<double> deviation;
  for (int r = 8; r >= 0; --r)
    for (int c = 0; c < 11; ++c) {
      points.push_back(turned(exact->points[exact->index(r, c)], exact->surface.pitch));
      deviation.push_back(1e-3 * r + 1e-4 * c);
    }
  const auto measured = contact::measured_flank(gear, 0, -1, 9, 11, points, deviation);
  ASSERT_TRUE(measured) << measured.error().message;
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_LT((measured->points[k] - exact->points[k]).norm(), 1e-9);
  EXPECT_NEAR(measured->deviation_mm[measured->index(2, 3)], 2.3e-3, 1e-15);
  EXPECT_FALSE(contact::measured_flank(gear, 0, -1, 9, 10, points, deviation));
  points[5].z() = -60;
  EXPECT_FALSE(contact::measured_flank(gear, 0, -1, 9, 11, points, deviation));
}

/// More compound colours more; offset to the other side with the other flank gives the same pattern; the pinion's
/// places lie on its flank.
TEST(Pattern, GrowsWithTheCompoundAndMirrors) {
  const auto c = case_named("offset_15");
  const face_gear::FaceGear gear = gear_of(c, 130.5, 147);
  face_gear::FaceGearParameters mirrored = c.parameters();
  mirrored.offset_mm = -c.offset_mm;
  mirrored.zones = {{0, 130.5, 147}};
  const face_gear::FaceGear other = face_gear::FaceGear::make(mirrored).value();
  double last = 0;
  for (const double compound : {0.002, 0.006, 0.02}) {
    const auto a = contact::roll({member_of(gear, 1, 23)}, {.steps = 24, .compound_mm = compound});
    const auto b = contact::roll({member_of(other, -1, 23)}, {.steps = 24, .compound_mm = compound});
    ASSERT_TRUE(a && b);
    const auto &p = a->patterns[0], &q = b->patterns[0];
    EXPECT_GT(p.marked_share, last);
    EXPECT_LT(p.marked_share, 0.9);
    EXPECT_NEAR(p.marked_share, q.marked_share, 1e-9);
    EXPECT_NEAR(p.inclination_rad, q.inclination_rad, 1e-6);
    last = p.marked_share;
    const auto pinion = contact::make_pinion(gear.rings()[0].surface, 23);
    for (std::size_t k = 0; k < p.gap_mm.size(); ++k) {
      if (p.gap_mm[k] > compound) continue;
      EXPECT_GE(p.gap_mm[k], -1e-9);
      EXPECT_GE(p.pinion_radius_mm[k], pinion.r_b);
      EXPECT_LE(p.pinion_radius_mm[k], pinion.r_a);
    }
  }
}

/// Half width of the pattern across the path from the relative curvature of both flanks: gap = x^2 / 2 times its least
/// value.
TEST(Pattern, WidthFollowsTheRelativeCurvature) {
  const face_gear::FaceGear gear = gear_of(case_named("offset_15"), 130.5, 147);
  const auto member = member_of(gear, 1, 22, {}, 61, 121);
  const auto& f = member.flank.surface;
  const double compound = 0.004;
  const auto rolled = contact::roll({member}, {.steps = 40, .compound_mm = compound});
  ASSERT_TRUE(rolled);
  const auto path = contact::contact_path(f, member.pinion, 1);
  const double theta_1 = std::tan(f.shaper.alpha_t), theta = path->theta(theta_1);
  // Curvatures in (e, l): the pinion's only across its generators (spur), 1/(r_b1 theta_1), and convex towards the
  // gear.
  const auto H = f.flank_shape(1, theta, path->B);
  const double ee = H.ee + 1 / (member.pinion.r_b * theta_1), el = H.el, ll = H.ll;
  ASSERT_GT(ee * ll - el * el, 0);
  // While rolling, each place is met at the best moment: what is left across is the Schur complement along the
  // direction in which the contact line sweeps. For a spur pinion the sweep moves contact across the generators (e),
  // the pattern's width is along l.
  const double across = ll - el * el / ee, half_width = std::sqrt(2 * compound / across);
  double low = 1e9, high = -1e9;
  const auto& p = rolled->patterns[0];
  for (int c = 0; c < member.flank.columns; ++c) {
    const auto k = member.flank.index(member.flank.rows / 2, c);
    if (p.gap_mm[k] > compound) continue;
    const double r = member.flank.points[k].head<2>().norm();
    low = std::min(low, r);
    high = std::max(high, r);
  }
  EXPECT_NEAR((high - low) / (2 * half_width), 1, 0.25);
}

TEST(PinionCheck, NamesTheLimit) {
  const auto p = case_named("offset_15").parameters();
  EXPECT_TRUE(contact::check_pinion(p, 25));
  EXPECT_NE(contact::check_pinion(p, 26).error().message.find("26 exceeds the shaper's 25"), std::string::npos);
  EXPECT_FALSE(contact::check_pinion(p, 4));
}

/// Statics: torques in the ratio of the teeth, components that add up to the normal force, halves that cancel.
TEST(FaceGearForces, BalanceOfTorqueAndAxialForce) {
  const auto c = case_named("dhfg_normal");
  FaceGearCase opposite = c;
  opposite.beta_deg = -c.beta_deg;
  const auto outer = c.surface(), inner = opposite.surface();
  const auto p_out = contact::make_pinion(outer, 30), p_in = contact::make_pinion(inner, 30);
  const double torque = 532e3;
  for (const int s : {1, -1}) {
    const auto f = contact::mesh_force(outer, p_out, s, torque);
    EXPECT_NEAR(f.pinion_torque_nmm, torque * 30 / 180, 1e-6);
    EXPECT_NEAR(f.pinion_axial_n, -s * f.pinion_torque_nmm / p_out.r_p * std::tan(c.beta()), 1e-9 * torque);
    EXPECT_GT(f.pinion_radial_n, 0);
    EXPECT_LT(f.gear_axial_n, 0);
    // About the gear's axis at an actual point of the path: force times lever is the torque.
    const auto path = contact::contact_path(outer, p_out, s);
    const Vec3 P = path->point(0.3), F = -f.normal_n * path->normal;
    EXPECT_NEAR(std::abs(P.x() * F.y() - P.y() * F.x()), torque, 1e-6 * torque);
    const auto both = contact::double_mesh_force(inner, outer, p_in, p_out, s, torque, 0.5);
    EXPECT_NEAR(both.axial_n, 0, 1e-9);
    EXPECT_NEAR(both.single_axial_n, f.pinion_axial_n, 1e-9);
    EXPECT_NEAR(contact::double_mesh_force(inner, outer, p_in, p_out, s, torque, 0.65).axial_n / both.single_axial_n,
                0.3, 1e-12);
  }
}

/// The lines of contact that pages draw are lines of equal flank_phi: there, and only at that turn, the shaper as
/// pinion touches.
TEST(LineContact, EveryPlaceIsTouchedAtItsOwnTurn) {
  for (const char* name : {"offset_15", "dhfg_normal", "beta_45"}) {
    const auto c = case_named(name);
    const auto& f = c.surface<double>();
    const auto pinion = contact::make_pinion(f, c.parameters().shaper_teeth, {});
    for (const int side : {1, -1})
      for (const double theta : {0.25, 0.4, 0.5})
        for (const double from : {-0.04, 0.0, 0.03}) {
          const double B = side * (f.shaper.theta_0 + theta) + from;
          const Vec3 place = f.flank(side, theta, B).p;
          const double phi = f.flank_phi(side, theta, B);
          const auto gap_at = [&](double turn) {  // of the pinion that stands where the ratio wants it
            return pinion.gap(side, pinion.place(Turn(turn * pinion.ratio)(place)), turn);
          };
          EXPECT_NEAR(gap_at(phi), 0, 1e-9) << name << side << theta;
          EXPECT_GT(std::abs(gap_at(phi + 0.02)), 1e-6) << name << side << theta;
          EXPECT_GT(std::abs(gap_at(phi - 0.02)), 1e-6) << name << side << theta;
        }
  }
}

}  // namespace
}  // namespace toothpath::test
