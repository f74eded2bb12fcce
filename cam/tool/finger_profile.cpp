#include "cam/tool/finger_profile.h"

#include <cmath>

namespace toothpath::tool {
namespace {

Vec2 place(const bevel_gear::FingerProfile<double>& c, double p) {
  const auto q = c.at(p);
  return {q.x + c.h_f, q.rho};
}

/// The arc through three points of the profile, or the line where they do not bend.
MeridianPiece through(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 ab = b - a, ac = c - a, bc = c - b;
  const double twice_area = ab[0] * ac[1] - ab[1] * ac[0];
  return {a, c, -2 * twice_area / (ab.norm() * ac.norm() * bc.norm())};  // b to the left of the way from a to c: bulging
}

/// Arcs from p0 to p1, halved until the quarter points lie within the sag.
void involute_arcs(const bevel_gear::FingerProfile<double>& c, double p0, double p1, double sag_mm, std::vector<MeridianPiece>& out) {
  const auto arc = through(place(c, p0), place(c, 0.5 * (p0 + p1)), place(c, p1));
  double off = 0;
  for (const double share : {0.2, 0.8}) {
    const Vec2 q = place(c, p0 + share * (p1 - p0));
    off = std::max(off, (nearest_on_piece<double>(arc, q) - q).norm());
  }
  if (off <= 0.5 * sag_mm) {  // the greatest lies near the quarter points; half is kept for what lies between
    out.push_back(arc);
    return;
  }
  involute_arcs(c, p0, 0.5 * (p0 + p1), sag_mm, out);
  involute_arcs(c, 0.5 * (p0 + p1), p1, sag_mm, out);
}

}  // namespace

Meridian finger_meridian(const bevel_gear::FingerProfile<double>& c, double flute_end_mm, double sag_mm) {
  std::vector<MeridianPiece> pieces;
  const Vec2 A(0, c.rho_o), B(c.x_B + c.h_f, c.rho_B), C = place(c, c.p_C), D = place(c, c.p_D);
  if (A[1] > 0) pieces.push_back({Vec2::Zero(), A, 0});
  pieces.push_back({A, B, 1 / c.r_t});
  pieces.push_back({B, C, 0});
  involute_arcs(c, c.p_C, c.p_D, sag_mm, pieces);
  if (flute_end_mm > D[0]) pieces.push_back({Vec2(D[0], c.rho_D), Vec2(flute_end_mm, c.rho_D), 0});
  return Meridian(std::move(pieces));
}

}  // namespace toothpath::tool
