// The tooth space of a cylindrical gear against the rack that sweeps it: no equation of meshing here. And what a tooth
// space promises: exact derivatives, enclosures that hold, feet, tip edges, ball centres.
#include <gtest/gtest.h>

#include <boost/multiprecision/eigen.hpp>
#include <functional>
#include <tuple>

#include "geometry/tooth_space/curvature.h"
#include "geometry/tooth_space/offset_sheet.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/support/fifty_digits.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using cylindrical::InvoluteSpace;
using tooth_space::Piece;

struct SpaceSample {
  const char* name;
  cylindrical::CylindricalParameters parameters;
  int zone;
};
std::vector<SpaceSample> samples() {
  return {{"spur", shifted_spur(), 0},
          {"pinion, left", double_helical_pinion(), 0},
          {"pinion, right", double_helical_pinion(), 1},
          {"helical, left", left_helical(), 0}};
}

/// Calls check(space, piece, u, v) on places all over the five pieces.
void on_every_piece(const InvoluteSpace& space, int count, const std::function<void(Piece, double, double)>& check) {
  Random random(11);
  const auto& w = space.kernel();
  for (int n = 0; n < count; ++n) {
    const Piece piece{std::uint8_t(n % tooth_space::kPieces)};
    tooth_space::Borders b = space.borders(piece);
    if (piece == Piece::flank_plus) b.from = w.theta_a;
    if (piece == Piece::flank_minus) b.to = w.theta_a;
    check(piece, b.from + random(0, 1) * (b.to - b.from), random(w.z_from, w.z_to));
  }
}

/// Signed distance to what the tooth of a rack sweeps past the turning gear: below 0 in the air.
class SweptRack {
 public:
  SweptRack(const cylindrical::CylindricalParameters& g, const cylindrical::CylindricalZone& zone) {
    beta_ = zone.helix_angle_rad;
    const bool normal = g.module_plane == ModulePlane::normal;
    const double m_n = normal ? g.module_mm : g.module_mm * std::cos(beta_), m_t = m_n / std::cos(beta_);
    alpha_ = normal ? g.pressure_angle_rad : std::atan(std::tan(g.pressure_angle_rad) * std::cos(beta_));
    r_ = 0.5 * m_t * g.teeth;
    tip_ = r_ + g.module_mm * (g.profile_shift - g.dedendum_coefficient);
    rho_ = g.root_radius_coefficient * g.module_mm;
    // Half width on the datum line, at radius r + x m, and down to the sharp tip.
    half_ = kPi * m_n / 4 - 0.5 * g.thickness_allowance_mm - g.dedendum_coefficient * g.module_mm * std::tan(alpha_);
  }

  [[nodiscard]] double operator()(const Vec3& p) const {
    constexpr int kMoments = 241;
    const auto at = [](int k) { return -1.2 + 2.4 * k / (kMoments - 1); };
    std::vector<double> d;
    for (int k = 0; k < kMoments; ++k) d.push_back(to_rack(p, at(k)));
    double least = *std::min_element(d.begin(), d.end());
    for (int k = 1; k + 1 < kMoments; ++k) {
      if (d[std::size_t(k)] > d[std::size_t(k - 1)] || d[std::size_t(k)] > d[std::size_t(k + 1)]) continue;
      double low = at(k - 1), high = at(k + 1);
      for (int n = 0; n < 80; ++n) {
        const double a = low + 0.382 * (high - low), b = low + 0.618 * (high - low);
        (to_rack(p, a) < to_rack(p, b) ? high : low) = to_rack(p, a) < to_rack(p, b) ? b : a;
      }
      least = std::min(least, to_rack(p, 0.5 * (low + high)));
    }
    return least;
  }

 private:
  /// To the rack's tooth when the gear has turned by t and the rack has moved with its pitch line.
  [[nodiscard]] double to_rack(const Vec3& p, double t) const {
    const double c = std::cos(t), s = std::sin(t), x = c * p.x() - s * p.y(), y = s * p.x() + c * p.y() - r_ * t;
    const double across = std::abs((y - p.z() * std::tan(beta_)) * std::cos(beta_)), up = x - tip_;
    // A wedge of flank and tip line, moved inwards by the rounding.
    const double to_flank = (across - half_ - up * std::tan(alpha_)) * std::cos(alpha_) + rho_, to_tip = -up + rho_;
    const double sine = std::sin(alpha_), square = std::cos(alpha_) * std::cos(alpha_),
                 of_flank = (to_flank - to_tip * sine) / square, of_tip = (to_tip - to_flank * sine) / square;
    if (of_flank <= 0 || of_tip <= 0) return std::max(to_flank, to_tip) - rho_;
    return std::sqrt(of_flank * of_flank + of_tip * of_tip + 2 * of_flank * of_tip * sine) - rho_;
  }

  double beta_ = 0, alpha_ = 0, r_ = 0, tip_ = 0, rho_ = 0, half_ = 0;
};

TEST(InvoluteSpace, IsWhatTheRackSweeps) {
  for (const SpaceSample& s : samples()) {
    const auto gear = made(s.parameters);
    const auto& space = gear.space(s.zone);
    const SweptRack rack(s.parameters, s.parameters.zones[std::size_t(s.zone)]);
    const double off = 0.1 * s.parameters.module_mm;
    double on = 0, beside = 0;
    on_every_piece(space, 120, [&](Piece piece, double u, double v) {
      const auto q = space.point(piece, u, v);
      ASSERT_TRUE(q);
      on = std::max(on, std::abs(rack(q->p)));
      beside = std::max({beside, std::abs(rack(q->p + off * q->n) + off), std::abs(rack(q->p - off * q->n) - off)});
    });
    EXPECT_LT(on, 1e-9) << s.name;
    EXPECT_LT(beside, 1e-9) << s.name;
  }
}

TEST(InvoluteSpace, PiecesJoin) {
  for (const SpaceSample& s : samples()) {
    const auto gear = made(s.parameters);
    const auto& space = gear.space(s.zone);
    for (const double v : {space.kernel().z_from, space.kernel().z_to})
      for (int k = 0; k + 1 < tooth_space::kPieces; ++k) {
        const Piece one{std::uint8_t(k)}, next{std::uint8_t(k + 1)};
        const auto a = space.at(one, space.borders(one).to, v), b = space.at(next, space.borders(next).from, v);
        ASSERT_TRUE(a && b);
        EXPECT_LT((a->p - b->p).norm(), 1e-12) << s.name << " " << k;
        EXPECT_LT((a->n - b->n).norm(), 1e-13) << s.name << " " << k;
      }
  }
}

/// The involute helicoid: constant moment, one principal curvature is 0, the other cos(beta_b) / (r_b theta).
TEST(InvoluteSpace, FlanksAreInvoluteHelicoids) {
  for (const SpaceSample& s : samples()) {
    const auto gear = made(s.parameters);
    const auto& space = gear.space(s.zone);
    const auto& w = space.kernel();
    on_every_piece(space, 60, [&](Piece piece, double u, double v) {
      const auto q = space.at(piece, u, v);
      ASSERT_TRUE(q);
      EXPECT_NEAR(q->n.norm(), 1, 1e-14);
      EXPECT_LT(std::abs(q->n.dot(q->pu)) / q->pu.norm() + std::abs(q->n.dot(q->pv)) / q->pv.norm(), 1e-13);
      if (!is_flank(piece)) return;
      EXPECT_NEAR(q->p.cross(q->n).z(), side_of(piece) * w.r_b * w.cos_bb, 1e-12 * w.r_b);
      const auto k = tooth_space::principal_curvatures(*q);
      EXPECT_NEAR(k.least, 0, 1e-9);
      EXPECT_NEAR(k.most, w.cos_bb / (w.r_b * u), 1e-9);
      EXPECT_NEAR(radius(q->p), w.r_b * std::sqrt(1 + u * u), 1e-12 * w.r_b);
    });
  }
}

TEST(InvoluteSpace, AgreesWithFiftyDigits) {
  for (const SpaceSample& s : samples()) {
    const auto gear = made(s.parameters);
    const auto& space = gear.space(s.zone);
    const cylindrical::InvoluteKernel<F50> exact(s.parameters, s.parameters.zones[std::size_t(s.zone)]);
    on_every_piece(space, 60, [&](Piece piece, double u, double v) {
      Vec3T<F50> p, n, along, beside, unused;
      ASSERT_TRUE(exact.place<F50>(piece, F50(u), F50(v), p, n));
      const auto near = space.point(piece, u, v);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(double(F50(p[k] - near->p[k])), 0, 1e-13 * near->p.norm());
        EXPECT_NEAR(double(F50(n[k] - near->n[k])), 0, 1e-14);
      }
      // The normal by differences of 1e-20.
      const F50 step("1e-20");
      exact.place<F50>(piece, F50(u) + step, F50(v), along, unused);
      exact.place<F50>(piece, F50(u), F50(v) + step, beside, unused);
      EXPECT_LT(std::abs(double(F50(Vec3T<F50>(along - p).dot(n) / step))), 1e-16);
      EXPECT_LT(std::abs(double(F50(Vec3T<F50>(beside - p).dot(n) / step))), 1e-16);
    });
    // The rack's flank and rounding share their place.
    Vec3T<F50> a, b, n_a, n_b;
    exact.place<F50>(Piece::flank_minus, exact.theta_f, F50(3), a, n_a);
    exact.place<F50>(Piece::fillet_minus, exact.alpha_n, F50(3), b, n_b);
    EXPECT_LT(double(F50(Vec3T<F50>(a - b).norm())), 1e-45);
    EXPECT_LT(double(F50(Vec3T<F50>(n_a - n_b).norm())), 1e-46);
  }
}

TEST(InvoluteSpace, EnclosuresHold) {
  for (const SpaceSample& s : samples()) {
    const auto gear = made(s.parameters);
    const auto& space = gear.space(s.zone);
    Random random(5);
    // Half the width of a second derivative, of its size: in the fillet two long levers are subtracted.
    double widest = 0, widest_fillet = 0;
    on_every_piece(space, 200, [&](Piece piece, double u, double v) {
      const double hu = 0.01, hv = 0.3, e = 1e-5;
      const tooth_space::PatchFrame frame{Vec2(u, v), Vec2(0.8, 0.1), Vec2(-0.05, 1.2)};
      const auto jet = space.enclosure(piece, frame, hu, hv);
      ASSERT_TRUE(jet);
      const Vec2 ab(random(-hu, hu), random(-hv, hv));
      const auto at = [&](const Vec2& x) {
        const Vec2 uv = frame.uv(x);
        return *space.at(piece, uv.x(), uv.y());
      };
      const auto by = [&](const tooth_space::PatchPoint& q, const Vec2& d) {
        return Vec3(q.pu * d.x() + q.pv * d.y());
      };
      const auto q = at(ab);
      const Vec3 first_a = by(q, frame.along_a), first_b = by(q, frame.along_b);
      const Vec2 da(e, 0), db(0, e);
      const Vec3 aa = (by(at(ab + da), frame.along_a) - by(at(ab - da), frame.along_a)) / (2 * e),
                 ba = (by(at(ab + db), frame.along_a) - by(at(ab - db), frame.along_a)) / (2 * e),
                 bb = (by(at(ab + db), frame.along_b) - by(at(ab - db), frame.along_b)) / (2 * e);
      const auto held = [&](const Interval& x, double value, double slack) {
        EXPECT_TRUE(x.low - slack <= value && value <= x.high + slack)
            << s.name << " " << to_string(piece) << " " << value << " in " << x.low << " .. " << x.high;
      };
      for (std::size_t k = 0; k < 3; ++k) {
        held(jet->place[k], q.p[int(k)], 0);
        held(jet->first[0][k], first_a[int(k)], 1e-12);
        held(jet->first[1][k], first_b[int(k)], 1e-12);
        held(jet->second[0][k], aa[int(k)], 1e-6);
        held(jet->second[1][k], ba[int(k)], 1e-6);
        held(jet->second[2][k], bb[int(k)], 1e-6);
        double& most = is_fillet(piece) ? widest_fillet : widest;
        most = std::max(most, jet->second[0][k].radius() / (1 + aa.norm()));
      }
    });
    EXPECT_LT(widest, 0.5) << s.name;
    EXPECT_LT(widest_fillet, 2) << s.name;
  }
}

TEST(InvoluteSpace, FeetLieUnderTheirPlaces) {
  for (const SpaceSample& s : samples()) {
    const auto gear = made(s.parameters);
    const auto& space = gear.space(s.zone);
    on_every_piece(space, 100, [&](Piece piece, double u, double v) {
      const auto q = space.at(piece, u, v);
      const double d = 0.2 * s.parameters.module_mm;
      const auto foot = space.foot(piece, q->p + d * q->n, u + 0.02, v - 0.4);
      ASSERT_TRUE(foot) << s.name << " " << to_string(piece);
      EXPECT_NEAR(foot->distance, d, 1e-11);
      EXPECT_LT((foot->at.p - q->p).norm(), 1e-9);
    });
  }
}

TEST(InvoluteSpace, TipEdgesFollowTheHelix) {
  for (const SpaceSample& s : samples()) {
    const auto gear = made(s.parameters);
    const auto& space = gear.space(s.zone);
    const auto& w = space.kernel();
    const double pitch = space.outline().pitch, s0 = space.outline().s_from, s1 = space.outline().s_to;
    for (const int side : {1, -1}) {
      const auto a = space.tip_edge(side, s0), b = space.tip_edge(side, s1, a);
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->u, w.theta_a, 1e-12);
      EXPECT_NEAR(a->azimuth, -w.kappa * s0 - side * w.eta(w.theta_a) - (side > 0 ? 0 : pitch), 1e-12);
      EXPECT_NEAR(b->azimuth - a->azimuth, -w.kappa * (s1 - s0), 1e-12);
      const double next = s0 + 0.5;
      const auto near = space.tip_edge(side, next, a);
      const auto bend = space.tip_azimuth(side, *a, s0, *near, next);
      ASSERT_TRUE(bend) << s.name;
      EXPECT_TRUE(bend->slope.holds(-w.kappa)) << bend->slope.low + w.kappa << " " << bend->slope.high + w.kappa;
      EXPECT_TRUE(bend->bend.holds(0));
      EXPECT_LT(bend->slope.radius(), 0.01);
    }
  }
}

/// Balls on the trimmed sheet touch and never cut: also where the ball is too large for the fillet.
TEST(InvoluteSpace, BallCentresKeepTheirRadius) {
  for (const SpaceSample& s : samples())
    for (const double share : {0.15, 0.4}) {
      const auto gear = made(s.parameters);
      const auto& space = gear.space(s.zone);
      const double R = share * s.parameters.module_mm;
      const tooth_space::OffsetSheet sheet(space, R, space.outline().s_from, space.outline().s_to, 5);
      ASSERT_EQ(sheet.stations().size(), 5u) << s.name;
      double least = INFINITY;
      const auto& station = sheet.stations()[2];
      for (std::size_t k = 0; k < station.nodes.size(); k += 4) {
        const auto& node = station.nodes[k];
        const bool hidden = std::any_of(station.gaps.begin(), station.gaps.end(), [&](const tooth_space::SheetGap& g) {
          return node.sigma > g.from + 1e-6 && node.sigma < g.to - 1e-6;
        });
        if (hidden) continue;
        for (int n = 0; n < tooth_space::kPieces; ++n) {
          const Piece piece{std::uint8_t(n)};
          tooth_space::Borders b = space.borders(piece);
          if (piece == Piece::flank_plus) b.from = space.kernel().theta_a;
          if (piece == Piece::flank_minus) b.to = space.kernel().theta_a;
          for (int i = 0; i <= 4; ++i) {
            const auto foot = space.foot(piece, node.at.centre, b.from + (b.to - b.from) * i / 4, node.at.v);
            if (foot && foot->distance > 0 && b.hold(foot->u, 1e-9)) least = std::min(least, foot->distance - R);
          }
        }
      }
      EXPECT_GT(least, -1e-10) << s.name << " " << R;
      EXPECT_LT(least, 1e-10);
      EXPECT_NEAR(radius(sheet.at(2.5, station.r)->centre), space.kernel().r_f + R, share < 0.3 ? 1e-9 : 1.0);
    }
}

}  // namespace
}  // namespace toothpath::test
