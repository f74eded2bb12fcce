// How far a piece of the exact surface can leave the flat facet between its corners: proven bounds of the second
// derivatives over boxes of the parameters, from the enclosures of the tooth space.
//
// For phi = g.p and corners v_i with weights w_i of a place x of their hull in the plane of the parameters, Taylor
// about x gives
//     sum w_i phi(v_i) - phi(x) = 1/2 sum w_i (v_i - x)^T H_i (v_i - x),
// and sum w_i (a_i - a)^2 <= da^2 / 4 on an interval of length da. docs/proof.md, Facets.
#pragma once

#include <array>
#include <optional>

#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::analytic {

using tooth_space::CurveBend;
using tooth_space::PatchFrame;

/// Second derivatives by (a, b) over a box: each lies within its spread of its vector. mm
struct PatchBend {
  Vec3 aa = Vec3::Zero(), ab = Vec3::Zero(), bb = Vec3::Zero();
  double spread_aa = 0, spread_ab = 0, spread_bb = 0;

  /// The most by which the facet can lie above the surface along a unit vector g, for corners within da x db. >= 0, mm.
  [[nodiscard]] double above(const Vec3& g, double da, double db) const;
  /// The greatest distance between a place of the surface and the place of the facet with the same weights. mm
  [[nodiscard]] double sag(double da, double db) const;
  /// From intervals of the components of the three derivatives aa, ab, bb; nothing where one is not finite.
  static std::optional<PatchBend> of(const std::array<std::array<Interval, 3>, 3>& second);
};

/// Second differences that are sampled, not proven, are taken this many times.
inline constexpr double kSampleDoubt = 3;

/// A vector known up to a distance.
struct VectorBound {
  Vec3 middle = Vec3::Zero();
  double spread = 0;
};

/// Over the box |a| <= half_a, |b| <= half_b. Nothing where no bound is found.
[[nodiscard]] std::optional<PatchBend> patch_bend(const tooth_space::ToothSpace& space, tooth_space::Piece piece,
                                                  const PatchFrame& frame, double half_a, double half_b);

/// The same from slices across a, each with its own bound: where there is none over the whole box.
[[nodiscard]] std::optional<PatchBend> sliced_bend(const tooth_space::ToothSpace& space, tooth_space::Piece piece,
                                                   const PatchFrame& frame, double half_a, double half_b);

/// Second derivative by a of the curve in which a piece meets the end surface s = constant through the origin of the
/// frame, for |a| <= half_a; the curve is followed within |b| <= half_b. Proven like the other.
[[nodiscard]] std::optional<VectorBound> end_curve_bend(const tooth_space::ToothSpace& space, tooth_space::Piece piece,
                                                        const PatchFrame& frame, double half_a, double half_b);

}  // namespace toothpath::analytic
