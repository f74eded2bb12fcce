#include "app/studies/stability_exact.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

namespace toothpath::studies {
namespace {

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;
using Vec3X = Vec3T<Exact>;

constexpr int kMostSteps = 60;
const Exact kSettled("1e-40");

Vec3X exact(const Vec3& v) { return {Exact(v.x()), Exact(v.y()), Exact(v.z())}; }
double gap(const Vec3X& a, const Vec3& b) {
  const Vec3X d = a - exact(b);
  return static_cast<double>(sqrt(Exact(d.dot(d))));
}
Exact radius_of(const Vec3X& p) { return sqrt(Exact(p[0] * p[0] + p[1] * p[1])); }

/// d(r, z)/d(theta, B) of the housing point.
struct Meridian {
  Exact r, z, r_theta, z_theta, r_B, z_B;
};
Meridian meridian(const face_gear::FaceGearSurface<Exact>& f, int side, const Exact& theta, const Exact& B) {
  const Vec3X P = f.flank_housing(side, theta, B);
  const Vec3X n = (f.t(B) * f.shaper.cos_bb - f.a() * f.shaper.sin_bb) * Exact(side);
  const Vec3X Pt = n * Exact(-f.shaper.r_b / f.shaper.cos_bb);
  const Vec3X PB = f.a() * f.flank_Z_B(B) + f.t(B) * f.shaper.r_b + f.e(B) * Exact(Exact(side) * f.shaper.r_b * theta);
  const Exact r = radius_of(P);
  return {r, P[2], (P[0] * Pt[0] + P[1] * Pt[1]) / r, Pt[2], (P[0] * PB[0] + P[1] * PB[1]) / r, PB[2]};
}

double condition_of(const face_gear::FaceGearSurface<Exact>& f, const Meridian& m) {
  const double a = static_cast<double>(Exact(m.r_theta / f.shaper.r_b)), b = static_cast<double>(Exact(m.r_B / m.r));
  const double c = static_cast<double>(Exact(m.z_theta / f.shaper.r_b)), d = static_cast<double>(Exact(m.z_B / m.r));
  const double sum = a * a + b * b + c * c + d * d;
  const double det =
      std::abs(static_cast<double>(Exact((m.r_theta * m.z_B - m.r_B * m.z_theta) / (f.shaper.r_b * m.r))));
  const double large = std::sqrt(0.5 * (sum + std::sqrt(std::max(0.0, (sum - 2 * det) * (sum + 2 * det)))));
  return large * large / det;  // largest over smallest: smallest = det / largest
}

/// Newton for (theta, B) at (r, z). Short steps: the start is the double solution.
bool solve(const face_gear::FaceGearSurface<Exact>& f, int side, const Exact& r, const Exact& z, Exact& theta,
           Exact& B) {
  for (int k = 0; k < kMostSteps; ++k) {
    const Meridian m = meridian(f, side, theta, B);
    const Exact er = r - m.r, ez = z - m.z, det = m.r_theta * m.z_B - m.r_B * m.z_theta;
    if (det == 0) return false;
    const Exact dt = (er * m.z_B - m.r_B * ez) / det, dB = (m.r_theta * ez - er * m.z_theta) / det;
    if (abs(dt) > 1 || abs(dB) > 1) return false;
    theta += dt;
    B += dB;
    if (abs(er) + abs(ez) <= kSettled * r) return true;
  }
  return false;
}

/// Azimuth of the flank point, unwrapped.
Exact azimuth(const face_gear::FaceGearSurface<Exact>& f, int side, const Exact& theta, const Exact& B) {
  const Vec3X P = f.flank_housing(side, theta, B);
  return atan2(P[1], P[0]) - f.i * f.flank_phi(side, theta, B);
}

/// Rodrigues' turn of v about the unit direction d.
Vec3X turn(const Vec3X& d, const Exact& angle, const Vec3X& v) {
  const Exact c = cos(angle), s = sin(angle);
  return v * c + d.cross(v) * s + d * Exact(d.dot(v) * (Exact(1) - c));
}

}  // namespace

struct ExactFaceGear::Impl {
  face_gear::FaceGearSurface<Exact> f;
};

ExactFaceGear::ExactFaceGear(const face_gear::FaceGearParameters& gear, double helix_angle_rad)
    : impl_(new Impl{face_gear::make_surface<Exact>(gear, helix_angle_rad)}) {}
ExactFaceGear::~ExactFaceGear() = default;
ExactFaceGear::ExactFaceGear(ExactFaceGear&&) noexcept = default;

ExactComparison ExactFaceGear::kernel(const face_gear::FaceGearSurface<double>& surface, int side, double theta,
                                      double B) const {
  const auto q = surface.flank(side, theta, B);
  const auto x = impl_->f.flank(side, Exact(theta), Exact(B));
  const Meridian m = meridian(impl_->f, side, Exact(theta), Exact(B));
  return {gap(x.p, q.p), gap(x.n, q.n), condition_of(impl_->f, m),
          static_cast<double>(impl_->f.flank_J(side, Exact(theta), Exact(B))), theta};
}

std::optional<ExactComparison> ExactFaceGear::inverse(const face_gear::FaceGearSurface<double>& surface, int side,
                                                      double r, double z,
                                                      const face_gear::FlankCoordinates& found) const {
  Exact theta(found.theta), B(found.B);
  if (!solve(impl_->f, side, Exact(r), Exact(z), theta, B)) return {};
  const auto q = surface.flank(side, found.theta, found.B);
  const auto x = impl_->f.flank(side, theta, B);
  return ExactComparison{gap(x.p, q.p), gap(x.n, q.n), condition_of(impl_->f, meridian(impl_->f, side, theta, B)),
                         static_cast<double>(impl_->f.flank_J(side, theta, B)), static_cast<double>(theta)};
}

double ExactFaceGear::residual_mm(int side, double r, double z, const face_gear::FlankCoordinates& found) const {
  const Meridian m = meridian(impl_->f, side, Exact(found.theta), Exact(found.B));
  const Exact dr = m.r - Exact(r), dz = m.z - Exact(z);
  return static_cast<double>(sqrt(Exact(dr * dr + dz * dz)));
}

std::optional<ExactComparison> ExactFaceGear::fillet(const face_gear::FaceGearSurface<double>& surface, int side,
                                                     double A, double r, double Z) const {
  // The double A lies within rounding of [A_t, A_e]; the exact ends are a hair away, which the closed form does not
  // mind.
  const Exact Ax(A), rx(r);
  const auto radius = [&](const Exact& section) {
    const auto p = impl_->f.fillet(side, Ax, section);
    return p.defined ? radius_of(p.p) : Exact(-1);
  };
  Exact Z0 = Exact(Z) * (Exact(1) + Exact("1e-12")), Z1(Z), e0 = radius(Z0) - rx, e1 = radius(Z1) - rx;
  for (int k = 0; k < kMostSteps && abs(e1) > kSettled * rx && e1 != e0; ++k) {
    const Exact Z2 = Z1 - e1 * (Z1 - Z0) / (e1 - e0);
    Z0 = Z1, e0 = e1;
    Z1 = Z2, e1 = radius(Z1) - rx;
  }
  if (abs(e1) > Exact("1e-30") * rx) return {};
  const auto q = surface.fillet(side, A, Z);
  const auto x = impl_->f.fillet(side, Ax, Z1);
  return ExactComparison{gap(x.p, q.p), gap(x.n, q.n), 0, 0, 0};
}

std::optional<double> ExactFaceGear::undercut_error(int side, double B, double radius) const {
  const auto& f = impl_->f;
  Exact B0 = Exact(B) + Exact("1e-9"), B1(B);
  Exact J0 = f.flank_J(side, f.shaper.theta_t, B0), J1 = f.flank_J(side, f.shaper.theta_t, B1);
  for (int k = 0; k < kMostSteps && abs(Exact(B1 - B0)) > kSettled && J1 != J0; ++k) {
    const Exact B2 = B1 - J1 * (B1 - B0) / (J1 - J0);
    B0 = B1, J0 = J1;
    B1 = B2, J1 = f.flank_J(side, f.shaper.theta_t, B1);
  }
  if (abs(Exact(B1 - Exact(B))) > Exact(1e-6)) return {};
  return static_cast<double>(Exact(radius_of(f.flank_housing(side, f.shaper.theta_t, B1)) - Exact(radius)));
}

std::optional<double> ExactFaceGear::land_minus(double r, double land, const face_gear::FlankCoordinates& plus,
                                                const face_gear::FlankCoordinates& minus) const {
  const auto& f = impl_->f;
  const Exact rx(r), z = f.z_tip(rx);
  Exact both[2];
  for (const int k : {0, 1}) {
    const face_gear::FlankCoordinates& start = k == 0 ? plus : minus;
    Exact theta(start.theta), B(start.B);
    if (!solve(f, k == 0 ? 1 : -1, rx, z, theta, B)) return {};
    both[k] = azimuth(f, k == 0 ? 1 : -1, theta, B);
  }
  return static_cast<double>(Exact(rx * (both[0] - both[1]) - Exact(land)));
}

ExactComparison exact_bevel_point(const bevel_gear::BevelGear& gear, const bevel_gear::BevelWall<double>& wall,
                                  double beta, double p) {
  const auto& t = wall.trace;
  const auto& c = wall.cutter;
  bevel_gear::BevelWall<Exact> x;
  x.sigma = wall.sigma;
  x.trace = {Exact(t.R_0), Exact(t.sin_delta), Exact(t.cos_delta),    Exact(t.beta_ref), Exact(t.r_0), Exact(t.e_h),
             t.h,          Exact(t.beta_end),  {t.lead[0], t.lead[1]}};
  const bevel_gear::FingerCutterData& data = gear.cutter_data();
  x.cutter = bevel_gear::make_finger_profile<Exact>(
      {Exact(c.alpha_n), Exact(c.kappa_v), Exact(c.h_f), Exact(data.module_mm), Exact(data.tip_radius_mm),
       Exact(data.rack_depth_mm), Exact(data.profile_height_mm)},
      c.law);
  const auto q = wall.point(beta, p);
  const auto e = x.point(Exact(beta), Exact(p));
  return {gap(e.p, q.p), gap(e.n, q.n), 0, 0, 0};
}

ExactComparison exact_pose(const machines::KinematicChain& chain, const machines::Joints& joints, double tool_length_mm,
                           const machines::TablePose& wanted) {
  const auto turned = [&](std::size_t k, const Vec3X& v) {
    const machines::RotaryAxis& axis = chain.rotary(k);
    return turn(exact(axis.direction), Exact(axis.sign) * (Exact(joints.rotary_rad[k]) - Exact(axis.zero_rad)), v);
  };
  const auto about = [&](std::size_t k, const Vec3X& p) {
    const Vec3X at = exact(chain.rotary(k).point_mm);
    return Vec3X(at + turned(k, Vec3X(p - at)));
  };
  Vec3X u(Exact(0), Exact(0), Exact(1)), g(Exact(0), Exact(0), Exact(0));
  for (std::size_t k = chain.rotary_count(); k-- > chain.table.size();) {
    u = turned(k, u);
    g = about(k, g);
  }
  Vec3X p = exact(joints.linear_mm) + g - u * Exact(tool_length_mm);
  for (std::size_t k = chain.table.size(); k-- > 0;) {
    p = about(k, p);
    u = turned(k, u);
  }
  return {gap(p, wanted.tip_mm), gap(u, wanted.axis), 0, 0, 0};
}

}  // namespace toothpath::studies
