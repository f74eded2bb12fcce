// Unloaded contact of a face gear with an involute pinion, also misaligned (T14): the five contact equations are solved
// numerically; the transmission error must be a constant, and the contact must stay on one B.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

using Vec5 = Eigen::Matrix<double, 5, 1>;
using Mat5 = Eigen::Matrix<double, 5, 5>;

struct Misalignment {
  double offset_mm = 0, axial_mm = 0, angle_rad = 0;
};

/// Pinion of N_p teeth on an axis parallel to the shaper's, pitch cylinders tangent, then moved by the misalignment.
class Pair {
 public:
  Pair(const FaceGearCase& c, int pinion_teeth, const Misalignment& moved) : f_(c.surface()), moved_(moved) {
    const double alpha = f_.shaper.alpha_t;
    r_p1_ = 0.5 * f_.shaper.m_t * pinion_teeth;
    r_b1_ = r_p1_ * std::cos(alpha);
    kappa_1_ = f_.shaper.kappa * f_.shaper.r_p / r_p1_;
    theta_01_ = kPi / (2 * pinion_teeth) - (std::tan(alpha) - alpha);
    const double gamma = radians(c.gamma_deg) + moved.angle_rad;
    a_ = {std::sin(gamma), 0, -std::cos(gamma)};
    d_ = {-std::cos(gamma), 0, -std::sin(gamma)};
    ratio_ = double(pinion_teeth) / c.teeth;
  }

  /// Unknowns: theta, B, theta_1, Z_1, phi_2. Zero: same point (3), same normal (2 of its components).
  [[nodiscard]] Vec5 residual(int s, double phi_1, const Vec5& x) const {
    const auto gear = f_.flank(s, x[0], x[1]);
    const Vec3 P = turned(gear.p, x[4]), n = turned(gear.n, x[4]);
    const double B_1 = s * (theta_01_ + x[2]) + kappa_1_ * (x[3] - f_.L0) + phi_1;
    const Vec3 b(0, 1, 0), e = std::cos(B_1) * d_ + std::sin(B_1) * b, t = -std::sin(B_1) * d_ + std::cos(B_1) * b;
    const Vec3 axis_point =
        (f_.E + moved_.offset_mm) * b + (f_.shaper.r_p - r_p1_) * f_.d() + (x[3] + moved_.axial_mm) * a_;
    const Vec3 P_1 = axis_point + r_b1_ * (e - s * x[2] * t);
    const Vec3 n_1 = s * (t * f_.shaper.cos_bb - a_ * f_.shaper.sin_bb);
    Vec5 out;
    out << P - P_1, f_.L_p * (n - n_1).x(), f_.L_p * (n - n_1).z();
    return out;
  }

  /// Newton with central differences; false where it does not arrive.
  bool solve(int s, double phi_1, Vec5& x) const {
    for (int k = 0; k < 60; ++k) {
      const Vec5 F = residual(s, phi_1, x);
      if (F.norm() < 2e-12 * f_.L_p) return true;
      Mat5 J;
      for (int c = 0; c < 5; ++c) {
        const double h = c == 3 ? 1e-4 : 1e-6;
        Vec5 up = x, down = x;
        up[c] += h;
        down[c] -= h;
        J.col(c) = (residual(s, phi_1, up) - residual(s, phi_1, down)) / (2 * h);
      }
      Vec5 step = J.fullPivLu().solve(F);
      const double size = std::max({std::abs(step[0]), std::abs(step[1]), std::abs(step[2]), std::abs(step[4])});
      if (size > 0.1) step *= 0.1 / size;
      x -= step;
    }
    return false;
  }

  /// Start: the aligned contact at the pitch point.
  [[nodiscard]] std::pair<Vec5, double> pitch_contact(int s) const {
    const double alpha = f_.shaper.alpha_t, th = std::tan(alpha), B = s * alpha, Z = f_.flank_Z(s, th, B);
    const double phi_1 = B - s * (theta_01_ + th) - kappa_1_ * (Z - f_.L0);
    Vec5 x;
    x << th, B, th, Z, f_.i * f_.flank_phi(s, th, B);
    return {x, phi_1};
  }
  [[nodiscard]] double ratio() const { return ratio_; }
  [[nodiscard]] const face_gear::FaceGearSurface<double>& surface() const { return f_; }

 private:
  face_gear::FaceGearSurface<double> f_;
  Misalignment moved_;
  double r_p1_, r_b1_, kappa_1_, theta_01_, ratio_;
  Vec3 a_, d_;
};

TEST(FaceGearContact, TransmissionErrorIsConstantUnderEveryMisalignment) {
  // A pinion lifted by an angle error about the gear's centre soon has no contact left on the flank, so those are
  // small.
  const std::vector<Misalignment> moves = {{0, 0, 0},       {0.1, 0, 0},         {0, 0.15, 0},         {0, 0, 0.0004},
                                           {0, 0, -0.0008}, {0.1, 0.15, 0.0004}, {-0.05, 0.1, -0.0006}};
  for (const char* name : {"offset_15", "dhfg_normal", "gamma_75_mixed", "gamma_120"}) {
    const auto c = case_named(name);
    for (const auto& moved : moves) {
      const double m = c.module_mm / 5;  // lengths as fractions of the tooth
      const Pair pair(c, c.shaper_teeth - 2, {moved.offset_mm * m, moved.axial_mm * m, moved.angle_rad});
      for (const int s : {1, -1}) {
        SCOPED_TRACE(
            fmt::format("{} side {} dE {} dL {} dgamma {}", name, s, moved.offset_mm, moved.axial_mm, moved.angle_rad));
        auto [x, phi_0] = pair.pitch_contact(s);
        double low = 1e9, high = -1e9, B_low = 1e9, B_high = -1e9, theta_low = 1e9, theta_high = -1e9;
        for (int k = 0; k <= 20; ++k) {
          const double phi_1 = phi_0 + 0.01 * k;
          x[4] += k == 0 ? 0 : 0.01 * pair.ratio();
          ASSERT_TRUE(pair.solve(s, phi_1, x));
          const double error = x[4] - phi_1 * pair.ratio();
          low = std::min(low, error);
          high = std::max(high, error);
          B_low = std::min(B_low, x[1]);
          B_high = std::max(B_high, x[1]);
          theta_low = std::min(theta_low, x[0]);
          theta_high = std::max(theta_high, x[0]);
        }
        EXPECT_LT(high - low, 1e-11);
        EXPECT_GT(theta_high - theta_low, 0.05);  // it did move
        EXPECT_LT(B_high - B_low, 1e-8);
        const bool aligned = moved.offset_mm == 0 && moved.axial_mm == 0 && moved.angle_rad == 0;
        if (aligned) {
          EXPECT_NEAR(low, 0, 1e-12);
          EXPECT_NEAR(B_low, s * pair.surface().shaper.alpha_t, 1e-10);
        }
      }
    }
  }
}

/// The printed shift of the path: offset gear, 23 pinion teeth, 0.1 mm more offset, side +1: from 20 to 21.996 deg.
TEST(FaceGearContact, OffsetErrorMovesThePath) {
  const Pair pair(case_named("offset_15"), 23, {0.1, 0, 0});
  auto [x, phi_1] = pair.pitch_contact(1);
  ASSERT_TRUE(pair.solve(1, phi_1, x));
  EXPECT_NEAR(degrees(x[1]), 21.996, 6e-4);
}

/// Radii of the aligned path at gear tip, pitch point and pinion tip.
TEST(FaceGearContact, PathOfContact) {
  struct Row {
    const char* name;
    int pinion_teeth, side;
    double tip, pitch, root;
  };
  for (const Row& row : std::vector<Row>{{"offset_15", 23, 1, 134.031, 132.850, 132.266},
                                         {"offset_15", 23, -1, 132.173, 132.850, 133.759},
                                         {"dhfg_transverse", 30, 1, 442.282, 450, 456.765},
                                         {"dhfg_transverse", 30, -1, 458.137, 450, 443.527},
                                         {"dhfg_normal", 30, 1, 512.885, 519.615, 525.764},
                                         {"dhfg_normal", 30, -1, 526.618, 519.615, 513.678}}) {
    const auto c = case_named(row.name);
    const auto f = c.surface();
    const double alpha = f.shaper.alpha_t, B = row.side * alpha;
    const auto radius = [&](double theta) {
      const Vec3 P = f.flank_housing(row.side, theta, B);
      return std::hypot(P.x(), P.y());
    };
    // Gear tip: height of the path reaches z_tip. Pinion tip: the pinion's roll parameter ends.
    double lo = -0.2, hi = std::tan(alpha);
    for (int k = 0; k < 80; ++k) {
      const double th = 0.5 * (lo + hi);
      (f.flank_housing(row.side, th, B).z() > f.z_tip(radius(th)) ? lo : hi) = th;
    }
    const double r_p1 = 0.5 * f.shaper.m_t * row.pinion_teeth, r_b1 = r_p1 * std::cos(alpha),
                 r_a1 = r_p1 + f.shaper.h_a;
    const double th_1 = std::sqrt(r_a1 * r_a1 - r_b1 * r_b1) / r_b1;
    const double th_end = std::tan(alpha) + (th_1 - std::tan(alpha)) * r_b1 / f.shaper.r_b;
    EXPECT_NEAR(radius(lo), row.tip, 6e-4) << row.name << " " << row.side;
    EXPECT_NEAR(radius(std::tan(alpha)), row.pitch, 6e-4) << row.name << " " << row.side;
    EXPECT_NEAR(radius(th_end), row.root, 6e-4) << row.name << " " << row.side;
  }
}

}  // namespace
}  // namespace toothpath::test
