// How far a piece of the exact surface can leave the flat facet between its corners: proven bounds of the second
// derivatives of the analytic patches over boxes of their parameters, by interval arithmetic in the kernels that make
// the surface.
//
// For phi = g.p and corners v_i with weights w_i of a place x of their hull in the plane of the parameters, Taylor
// about x gives
//     sum w_i phi(v_i) - phi(x) = 1/2 sum w_i (v_i - x)^T H_i (v_i - x),
// and sum w_i (a_i - a)^2 <= da^2 / 4 on an interval of length da. docs/proof.md, Facets.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "geometry/base/interval.h"
#include "geometry/face_gear/space_sheet.h"

namespace toothpath::analytic {

/// Affine coordinates (a, b) in the plane of the parameters (u, v) of a piece: the cells of a sheet are oblique in (u,
/// v).
struct PatchFrame {
  Vec2 origin = Vec2::Zero(), along_a = Vec2::UnitX(), along_b = Vec2::UnitY();
  [[nodiscard]] Vec2 uv(const Vec2& ab) const { return origin + ab.x() * along_a + ab.y() * along_b; }
  [[nodiscard]] Vec2 ab(const Vec2& uv) const {
    const Vec2 d = uv - origin;
    const double det = along_a.x() * along_b.y() - along_a.y() * along_b.x();
    return {(d.x() * along_b.y() - d.y() * along_b.x()) / det, (along_a.x() * d.y() - along_a.y() * d.x()) / det};
  }
};

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

/// Derivatives of a function over an interval.
struct CurveBend {
  Interval slope, bend;  ///< first and second
};

class PatchBounds {
 public:
  PatchBounds(const face_gear::FaceGearParameters& gear, const face_gear::SpaceSheet& space);
  ~PatchBounds();
  PatchBounds(PatchBounds&&) noexcept;

  /// Over the box |a| <= half_a, |b| <= half_b. Nothing where no bound is found. Proven, of displaced rings, too.
  [[nodiscard]] std::optional<PatchBend> over(tooth_space::Piece piece, const PatchFrame& frame, double half_a,
                                              double half_b) const;

  /// The azimuth of the tip edge of `side` as a function of the radius, between two places of it. Proven: the edge
  /// cannot leave a box about the two places in which its slope is bounded. Nothing where no such box is found.
  [[nodiscard]] std::optional<CurveBend> tip_azimuth(int side, const face_gear::TipPlace& from, double r_from,
                                                     const face_gear::TipPlace& to, double r_to) const;

  /// Second derivative by a of the curve in which a piece meets the cylinder through the origin of the frame, for |a|
  /// <= half_a; the curve is followed within |b| <= half_b. Proven like the others.
  [[nodiscard]] std::optional<VectorBound> bend_at_radius(tooth_space::Piece piece, const PatchFrame& frame,
                                                          double half_a, double half_b) const;

  /// Second derivative of the height of the tip surface by the radius.
  [[nodiscard]] Interval tip_surface_bend(double r_from, double r_to) const;

 private:
  struct Kernels;
  const face_gear::SpaceSheet& space_;
  std::unique_ptr<Kernels> kernels_;
};

}  // namespace toothpath::analytic
