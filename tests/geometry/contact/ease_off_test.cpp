// Ease-off: against the words of pinion and gear, swept; what removals and misalignments must do to it.
#include "geometry/contact/ease_off.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/brute_force_contact.h"
#include "tests/support/face_gear_cases.h"
#include "tests/support/modified_flank.h"

namespace toothpath::test {
namespace {

using modification::Kind;

face_gear::FaceGear gear_offset(const std::vector<modification::Modification>& modifications = {}) {
  const FaceGearCase c = case_named("offset_15");
  face_gear::FaceGearParameters p = c.parameters();
  p.zones = {{c.beta(), 130.5, 147}};
  p.modifications = modifications;
  auto made = face_gear::FaceGear::make(p);
  if (auto* refused = made.refused()) throw std::invalid_argument(refused->front().diagnostic.message);
  return std::move(made).value();
}

contact::ContactMember mated(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                             const contact::Misalignment& moved = {},
                             const std::vector<modification::Modification>& on_pinion = {}, int zone = 0) {
  auto flank = contact::exact_flank(gear, zone, side, 15, 19);
  if (!flank) throw std::invalid_argument(flank.error().message);
  return contact::make_member(gear, std::move(*flank), pinion_teeth, moved, on_pinion);
}

/// A place of the gear by the words against its pinion by the words: how far the pinion's flank stays away while
/// both turn at the exact ratio. Where the line through the place meets the flank is found by
/// Newton's steps on differences; the least over the turn by a scan. No closed-form turn, no parallel surfaces.
class SweptPinion {
 public:
  SweptPinion(const face_gear::FaceGear& gear, int side, int teeth, const contact::Misalignment& moved,
              const std::vector<modification::Modification>& on_pinion, int zone = 0)
      : gear_(gear), side_(side), zone_(zone), teeth_(teeth), pinion_(gear, zone, side, teeth, moved, on_pinion) {}

  /// NaN where the least lies at the end of the scan or of the pinion's flank.
  [[nodiscard]] double least(double theta, double B) const {
    const auto& f = gear_.rings()[std::size_t(zone_)].surface;
    const Vec3 point = modified_by_the_words<double>(f, gear_.parameters(), zone_, side_, theta, B),
               normal = f.flank(side_, theta, B).n;
    const double pitch = 2 * kPi / gear_.parameters().teeth, middle = f.i * f.flank_phi(side_, theta, B);
    constexpr int kScan = 120;
    std::vector<double> gaps;
    Vec3 start(0.5 * (pinion_.r_b() + pinion_.r_a()), f.L_p, 0);
    for (int k = -kScan; k <= kScan; ++k) gaps.push_back(gap(point, normal, middle + 0.5 * pitch * k / kScan, start));
    int best = -1;
    for (int k = 1; k < 2 * kScan; ++k)
      if (const auto at = std::size_t(k); !std::isnan(gaps[at]) && (best < 0 || gaps[at] < gaps[std::size_t(best)]))
        best = k;
    if (best < 0) return NAN;
    const double g0 = gaps[std::size_t(best - 1)], g1 = gaps[std::size_t(best)], g2 = gaps[std::size_t(best + 1)];
    const double bend = g0 - 2 * g1 + g2;  // NaN at an end
    return bend > 0 ? g1 - (g2 - g0) * (g2 - g0) / (8 * bend) : NAN;
  }

 private:
  [[nodiscard]] Vec3 place(double R, double Z, double phi_1) const {
    const Vec3 q = pinion_.own(R, Z);
    const double c = std::cos(phi_1), s = std::sin(phi_1);
    const auto& at = pinion_.placed();
    return at.foot + q.z() * at.a + (c * q.x() - s * q.y()) * at.d + (s * q.x() + c * q.y()) * at.b;
  }
  /// Along the normal from the place to the flank; NaN where the line does not meet it.
  [[nodiscard]] double gap(const Vec3& point, const Vec3& normal, double phi_2, Vec3& start) const {
    const double phi_1 = phi_2 * gear_.parameters().teeth / teeth_;
    const auto turned = [&](const Vec3& v) { return toothpath::turned(v, phi_2); };
    const Vec3 p = turned(point), n = turned(normal);
    Vec3 x = start;  // R, Z, gap
    const auto miss = [&](const Vec3& at) { return Vec3(place(at[0], at[1], phi_1) - p - at[2] * n); };
    for (int k = 0; k < 40; ++k) {
      Mat3 slope;
      constexpr double h = 1e-5;
      for (int c = 0; c < 3; ++c) slope.col(c) = (miss(x + h * Vec3::Unit(c)) - miss(x - h * Vec3::Unit(c))) / (2 * h);
      Vec3 way = slope.fullPivLu().solve(miss(x));
      way = way.cwiseMax(-Vec3(0.3, 3, 3)).cwiseMin(Vec3(0.3, 3, 3));
      x -= way;
      if (!(x[0] > pinion_.r_b() + 0.01)) x[0] = pinion_.r_b() + 0.01;
      if (way.norm() < 1e-10) break;
    }
    if (!(miss(x).norm() < 1e-9) || x[0] > pinion_.r_a()) return NAN;
    start = x;
    constexpr double h = 1e-5;
    const Vec3 flank = (place(x[0] + h, x[1], phi_1) - place(x[0] - h, x[1], phi_1))
                           .cross(place(x[0], x[1] + h, phi_1) - place(x[0], x[1] - h, phi_1))
                           .normalized();
    return x[2] * std::abs(flank.dot(n));  // square to the pinion's flank
  }

  const face_gear::FaceGear& gear_;
  int side_, zone_, teeth_;
  PinionByTheWords pinion_;
};

/// A gear and the pinion that is its shaper: no ease-off anywhere.
TEST(EaseOff, ConjugateFlanksStandNothingApart) {
  const face_gear::FaceGear gear = gear_offset();
  for (const int side : {1, -1}) {
    const auto found = contact::ease_off({mated(gear, side, 25)});
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_GT(found->places, 15u * 19u * 7 / 10);
    EXPECT_LT(found->greatest.gap_mm, 1e-10);
    EXPECT_NEAR(found->shift_mm, 0, 1e-10);
  }
}

/// Modified members, misaligned, of as many teeth as the shaper and fewer: the words, swept, give the same map.
TEST(EaseOff, AgreesWithTheSweptPinion) {
  const std::vector<modification::Modification> on_gear = {modification_of(Kind::tip_relief, 0.02, 2),
                                                           modification_of(Kind::lead_crowning, 0.015),
                                                           modification_of(Kind::twist, 0.01),
                                                           modification_of(Kind::pressure_angle_slope, -0.006)},
                                                on_pinion = {modification_of(Kind::tip_relief, 0.012, 1.5),
                                                             modification_of(Kind::profile_crowning, 0.008),
                                                             modification_of(Kind::helix_angle_slope, 0.01)};
  const face_gear::FaceGear gear = gear_offset(on_gear);
  double worst = 0;
  int places = 0;
  for (const int side : {1, -1})
    for (const int teeth : {25, 23})
      for (const contact::Misalignment& moved :
           {contact::Misalignment{}, contact::Misalignment{0.05, 0.04, -0.0003, 0.03}}) {
        const auto member = mated(gear, side, teeth, moved, on_pinion);
        const auto found = contact::ease_off({member});
        ASSERT_TRUE(found) << found.error().message;
        const SweptPinion swept(gear, side, teeth, moved, on_pinion);
        const auto& map = found->maps[0];
        for (int row = 1; row < member.flank.rows; row += 4)
          for (int column = 0; column < member.flank.columns; column += 3) {
            const auto k = member.flank.index(row, column);
            const double by_words = swept.least(member.flank.theta[k], member.flank.B[k]);
            if (std::isnan(by_words) || std::isnan(map.gap_mm[k])) continue;
            // Square to which of the two flanks, that is all the difference: their slopes against each other, squared.
            const double gap = map.gap_mm[k] + found->shift_mm, difference = std::abs(by_words - gap);
            EXPECT_LT(difference, 1e-7 + 5e-4 * std::abs(gap)) << row << ' ' << column;
            worst = std::max(worst, difference);
            ++places;
          }
        EXPECT_GT(found->greatest.gap_mm, 0.01);
      }
  EXPECT_GT(places, 150);
  std::printf("  %d places, worst difference %.3g nm\n", places, worst * 1e6);
}

/// What is taken off the gear stands off as much; so do deviations.
TEST(EaseOff, RemovalsAddUnchanged) {
  const face_gear::FaceGear gear = gear_offset();
  const auto plain = mated(gear, 1, 25);
  auto humped = plain;
  for (std::size_t k = 0; k < humped.flank.deviation_mm.size(); ++k)
    humped.flank.deviation_mm[k] = -1e-3 * double(k % 17);
  const auto before = contact::ease_off({plain}), after = contact::ease_off({humped});
  ASSERT_TRUE(before && after);
  for (std::size_t k = 0; k < plain.flank.points.size(); ++k) {
    const double a = before->maps[0].gap_mm[k], b = after->maps[0].gap_mm[k];
    if (std::isnan(a) || std::isnan(b)) continue;
    EXPECT_NEAR(b + after->shift_mm - a - before->shift_mm, 1e-3 * double(k % 17), 1e-9) << k;
  }
}

/// The shift is the constant transmission error of the closed form, as a distance: where plain flanks touch in a point.
TEST(EaseOff, ShiftIsTheTransmissionError) {
  const face_gear::FaceGear gear = gear_offset();
  for (const int side : {1, -1})
    for (const contact::Misalignment& moved :
         {contact::Misalignment{0.03, 0.04, -0.0002, 0.02}, contact::Misalignment{0, 0, 0, 0.05}}) {
      const auto member = mated(gear, side, 23, moved);
      const auto found = contact::ease_off({member});
      const auto path = contact::contact_path(member.flank.surface, member.pinion, side);
      ASSERT_TRUE(found && path && contact::path_on_flanks(*path, member));
      const double lever = member.pinion.r_b * member.pinion.cos_bb / member.pinion.ratio;
      // Between the places of the grid the flanks come a little nearer.
      EXPECT_NEAR(found->shift_mm, side * path->error() * lever, 3e-4);
      EXPECT_GE(found->shift_mm, side * path->error() * lever - 1e-9);
    }
}

}  // namespace
}  // namespace toothpath::test
