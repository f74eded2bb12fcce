#include "cam/finger/finger_profile.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/angle.h"

namespace toothpath::finger {
namespace {

using tool::Meridian, tool::MeridianPiece, tool::Profile, tool::ToolAssembly;

constexpr int kTangents = 16;  // around the corner arc

Vec2 place(const bevel_gear::FingerProfile<double>& c, double p) {
  const auto q = c.at(p);
  return {q.x + c.h_f, q.rho};
}

/// The arc through three points of the profile, or the line where they do not bend.
MeridianPiece through(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a, bc = c - b;
  const double twice_area = ab[0] * ac[1] - ab[1] * ac[0];
  return {a, c,
          -2 * twice_area / (ab.norm() * ac.norm() * bc.norm())};  // b to the left of the way from a to c: bulging
}

/// Arcs from p0 to p1, halved until the quarter points lie within the sag.
void flank_arcs(const bevel_gear::FingerProfile<double>& c, double p0, double p1, double sag_mm,
                std::vector<MeridianPiece>& out) {
  const auto arc = through(place(c, p0), place(c, 0.5 * (p0 + p1)), place(c, p1));
  double off = 0;
  for (const double share : {0.2, 0.8}) {
    const Vec2 q = place(c, p0 + share * (p1 - p0));
    off = std::max(off, (tool::nearest_on_piece<double>(arc, q) - q).norm());
  }
  if (off <= 0.5 * sag_mm) {  // the greatest lies near the quarter points; half is kept for what lies between
    out.push_back(arc);
    return;
  }
  flank_arcs(c, p0, 0.5 * (p0 + p1), sag_mm, out);
  flank_arcs(c, 0.5 * (p0 + p1), p1, sag_mm, out);
}

}  // namespace

Meridian finger_meridian(const bevel_gear::FingerProfile<double>& c, double flute_end_mm, double sag_mm) {
  std::vector<MeridianPiece> pieces;
  const Vec2 A(0, c.rho_o), B(c.x_B + c.h_f, c.rho_B), C = place(c, c.p_C), D = place(c, c.p_D);
  if (A[1] > 0) pieces.push_back({Vec2::Zero(), A, 0});
  pieces.push_back({A, B, 1 / c.r_t});
  pieces.push_back({B, C, 0});
  const std::vector<double> joints = bevel_gear::flank_joints(c);
  for (std::size_t k = 1; k < joints.size(); ++k) flank_arcs(c, joints[k - 1], joints[k], sag_mm, pieces);
  if (flute_end_mm > D[0]) pieces.push_back({Vec2(D[0], c.rho_D), Vec2(flute_end_mm, c.rho_D), 0});
  return Meridian(std::move(pieces));
}

double finger_flute_end(const bevel_gear::FingerProfile<double>& c, const ToolAssembly& tool) {
  return tool.flute_length_mm > 0 ? tool.flute_length_mm : c.h_f + c.x_D;
}

Profile finger_profile(const bevel_gear::FingerProfile<double>& c, const ToolAssembly& tool, double sag_mm) {
  std::vector<Vec2> line;
  // Corners of tangents around the arc, from the flat (psi = 90 deg) to the straight (phi).
  const double step = (kPi / 2 - c.phi) / kTangents, out = c.r_t / std::cos(0.5 * step);
  for (int k = 0; k < kTangents; ++k) {
    const double psi = kPi / 2 - (k + 0.5) * step;
    line.emplace_back(std::max(0.0, c.x_o - out * std::sin(psi) + c.h_f), c.rho_o + out * std::cos(psi));
  }
  // A hollow flank is enclosed by its chords; where a modification makes it round they stand out by their sag.
  double grown = 0;
  const std::vector<double> steps = bevel_gear::flank_steps(c, sag_mm);
  if (c.law)
    for (const double p : steps)
      if (const auto q = c.flank(p); q.dpsi < 0) grown = std::max(grown, sag_mm / q.cos_psi);
  for (const double p : steps) {
    const auto q = c.flank(p);
    line.emplace_back(q.x + c.h_f, q.rho + grown);
  }
  ToolAssembly whole = tool;
  whole.flute_length_mm = finger_flute_end(c, tool);
  if (whole.flute_length_mm > line.back().x()) line.emplace_back(whole.flute_length_mm, c.rho_D + grown);
  std::vector<MeridianPiece> pieces;
  for (std::size_t k = 1; k < line.size(); ++k) pieces.push_back({line[k - 1], line[k], 0});
  return {Meridian(std::move(pieces)), shank_of(whole), holder_of(whole)};
}

}  // namespace toothpath::finger
