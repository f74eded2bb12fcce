#include "geometry/bevel_gear/forces.h"

#include <algorithm>
#include <cmath>

namespace toothpath::bevel_gear {
namespace {

/// Spiral angle at cone distance R.
double spiral(double R, double R_0) {
  return std::atan2(std::sqrt(std::max(0.0, (R_0 - R) / R_0)), std::sqrt(R / R_0));
}

/// The integral of tan(beta) dR is -R_0 G(beta).
double G(double beta) { return beta - std::sin(beta) * std::cos(beta); }

BevelForce at(const BevelForceMember& m, double F_t, double inverse_cos, double tan_beta, int sigma_h) {
  const double sd = std::sin(m.delta_rad), cd = std::cos(m.delta_rad), t = std::tan(m.alpha_n_rad) * inverse_cos;
  return {F_t, F_t * t * sd, sigma_h * F_t * tan_beta * cd, F_t * t * cd, -sigma_h * F_t * tan_beta * sd};
}

}  // namespace

BevelForce& BevelForce::operator+=(const BevelForce& o) {
  tangential += o.tangential;
  axial_pressure += o.axial_pressure;
  axial_spiral += o.axial_spiral;
  radial_pressure += o.radial_pressure;
  radial_spiral += o.radial_spiral;
  return *this;
}

BevelForce bevel_point_force(const BevelForceMember& m, double R, int sigma_h, double torque) {
  const double beta = spiral(R, m.R_0);
  return at(m, torque / (R * std::sin(m.delta_rad)), 1 / std::cos(beta), std::tan(beta), sigma_h);
}

std::vector<BevelForce> bevel_face_forces(const BevelForceMember& m, const std::vector<LoadedFace>& faces, int sigma,
                                          double torque, LoadSplit split) {
  std::vector<BevelForce> forces;
  if (split == LoadSplit::equal_torque) {
    for (const auto& f : faces)
      forces.push_back(
          bevel_point_force(m, 0.5 * (f.from + f.to), sigma * f.h, torque / static_cast<double>(faces.size())));
    return forces;
  }
  double moment = 0;  // of a unit line load
  for (const auto& f : faces) moment += 0.5 * (f.to - f.from) * (f.to + f.from) * std::sin(m.delta_rad);
  const double load = torque / moment;
  for (const auto& f : faces) {
    const double width = f.to - f.from, F_t = load * width;
    if (split == LoadSplit::line_load_middles) {
      const double beta = spiral(0.5 * (f.from + f.to), m.R_0);
      forces.push_back(at(m, F_t, 1 / std::cos(beta), std::tan(beta), sigma * f.h));
    } else {
      const double inverse_cos = 2 * std::sqrt(m.R_0) * (std::sqrt(f.to) - std::sqrt(f.from)) / width;
      const double tan_beta = m.R_0 * (G(spiral(f.from, m.R_0)) - G(spiral(f.to, m.R_0))) / width;
      forces.push_back(at(m, F_t, inverse_cos, tan_beta, sigma * f.h));
    }
  }
  return forces;
}

BevelForce bevel_total_force(const BevelForceMember& m, const std::vector<LoadedFace>& faces, int sigma, double torque,
                             LoadSplit split) {
  BevelForce sum;
  for (const auto& force : bevel_face_forces(m, faces, sigma, torque, split)) sum += force;
  return sum;
}

std::vector<LoadedFace> herringbone_faces(double R_i, double R_J, double R_e, double relief, int hand) {
  std::vector<LoadedFace> faces;
  if (R_J - relief > R_i) faces.push_back({R_i, std::min(R_J - relief, R_e), hand});
  if (R_J + relief < R_e) faces.push_back({std::max(R_J + relief, R_i), R_e, -hand});
  return faces;
}

std::optional<double> balanced_apex_distance(double R_i, double R_e, double R_0, double relief) {
  double lo = R_i + relief, hi = R_e - relief;
  if (!(lo < hi)) return std::nullopt;
  const double ends = G(spiral(R_i, R_0)) + G(spiral(R_e, R_0));
  const auto excess = [&](double R) { return ends - G(spiral(R - relief, R_0)) - G(spiral(R + relief, R_0)); };
  if (excess(lo) > 0 || excess(hi) < 0) return std::nullopt;
  for (int k = 0; k < 200; ++k) {  // excess rises with R
    const double mid = 0.5 * (lo + hi);
    if (mid <= lo || mid >= hi) break;
    (excess(mid) < 0 ? lo : hi) = mid;
  }
  return 0.5 * (lo + hi);
}

}  // namespace toothpath::bevel_gear
