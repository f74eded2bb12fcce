// The working surface of one tooth space as one smooth sheet: flank and fillet of tooth 0, root land, fillet and flank
// of tooth 1. Every piece has two parameters (u, v), exact first derivatives of point and normal, and a nearest-point
// search.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "geometry/base/dual.h"
#include "geometry/face_gear/fillet_blend.h"
#include "geometry/face_gear/gear.h"
#include "geometry/face_gear/inverse.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::face_gear {

using tooth_space::EdgePlace;
using tooth_space::PatchFoot;
using tooth_space::PatchPoint;
class SpaceEnclosures;

/// Parameters: flanks (theta, B), fillets (A, Z), root (fraction from the plus to the minus edge, Z).
///
/// A ring with a modification or a correction gives the displaced flanks: points moved along the plain normals, with
/// their own exact normals and curvatures; the fillets carry the displacement on and let it fade.
class SpaceSheet final : public tooth_space::ToothSpace {
 public:
  explicit SpaceSheet(const FaceGearParameters& gear, const FaceGearRing& ring);

  [[nodiscard]] const FaceGearRing& ring() const { return ring_; }
  [[nodiscard]] const FaceGearSurface<double>& surface() const { return ring_.surface; }

  [[nodiscard]] const tooth_space::Outline& outline() const override { return outline_; }
  [[nodiscard]] double tip(double r) const override { return ring_.surface.z_tip(r); }
  [[nodiscard]] tooth_space::CurveBend tip_bend(double r_from, double r_to) const override;
  [[nodiscard]] tooth_space::Borders borders(tooth_space::Piece piece) const override;
  /// By a pinion equal to the shaper.
  [[nodiscard]] tooth_space::Borders active(tooth_space::Piece flank) const override;

  /// Nothing where the piece has no contact (fillet out of its domain, J <= 0 on a flank).
  [[nodiscard]] std::optional<PatchPoint> at(tooth_space::Piece piece, double u, double v) const override;
  [[nodiscard]] std::optional<PatchPoint> point(tooth_space::Piece piece, double u, double v) const override;

  /// Newton from (u, v); nothing if it does not converge (1e-12 mm) in 30 steps.
  [[nodiscard]] std::optional<PatchFoot> foot(tooth_space::Piece piece, const Vec3& c, double u,
                                              double v) const override;
  [[nodiscard]] std::optional<PatchFoot> next_foot(tooth_space::Piece piece, const Vec3& c,
                                                   const PatchFoot& near) const override;
  [[nodiscard]] std::optional<EdgePlace> tip_edge(int side, double r,
                                                  const std::optional<EdgePlace>& near = {}) const override;
  [[nodiscard]] std::optional<EdgePlace> plain_tip_edge(int side, double r,
                                                        const std::optional<EdgePlace>& near = {}) const override;
  [[nodiscard]] std::optional<double> start_v(tooth_space::Piece piece, double u, double r, double distance,
                                              const std::optional<tooth_space::Near>& near, int attempt) const override;
  [[nodiscard]] double longest_step(tooth_space::Piece piece, double r) const override;
  [[nodiscard]] std::optional<tooth_space::Jet> enclosure(tooth_space::Piece piece,
                                                          const tooth_space::PatchFrame& frame, double half_a,
                                                          double half_b) const override;
  [[nodiscard]] std::optional<tooth_space::CurveBend> tip_azimuth(int side, const EdgePlace& from, double r_from,
                                                                  const EdgePlace& to, double r_to) const override;

  /// Places of tooth 0 on both sides, as the functions of the plain surface: flank and fillet of a side, parameters of
  /// the flank's point at (r, z), B at constant theta and Z at constant A for a radius. On plain rings those functions
  /// themselves; on displaced ones Newton from them, |radius - r| <= 1e-11 r.
  [[nodiscard]] SurfacePointT<double> flank(int side, double theta, double B) const;
  [[nodiscard]] Vec3 fillet(int side, double A, double Z) const;
  [[nodiscard]] std::optional<FlankCoordinates> invert(int side, double r, double z,
                                                       const std::optional<FlankCoordinates>& start = {}) const;
  [[nodiscard]] std::optional<double> B_at_radius(int side, double theta, double r, double start_B) const;

  /// What displaces a flank; none where it is plain.
  [[nodiscard]] FlankField field(int side) const;
  /// The same of a fillet; null where it is plain.
  [[nodiscard]] const FilletBlend* blend(int side) const { return blends_[side > 0 ? 0 : 1].get(); }

 private:
  using Dual2 = Dual<double, 2>;
  using Second = Dual<Dual2, 2>;  // second derivatives, too
  template <typename S>
  [[nodiscard]] SurfacePointT<S> root_point(const FaceGearSurface<S>& f, const S& fraction, const S& Z) const;
  /// The plain piece before it is turned to its tooth.
  [[nodiscard]] std::optional<PatchPoint> plain(tooth_space::Piece piece, double u, double v) const;
  /// A displaced flank or fillet, likewise; with curvatures or without nu, nv.
  [[nodiscard]] std::optional<PatchPoint> displaced(tooth_space::Piece piece, double u, double v, bool curved) const;
  template <typename S>
  [[nodiscard]] std::optional<SurfacePointT<S>> moved(const FaceGearSurface<S>& f, tooth_space::Piece piece, const S& u,
                                                      const S& v) const;
  /// Newton in one parameter of a displaced piece to radius r, the other one fixed.
  [[nodiscard]] std::optional<double> v_at_radius(tooth_space::Piece piece, double u, double r, double v) const;
  [[nodiscard]] std::optional<PatchFoot> nominal_flank_foot(tooth_space::Piece piece, const Vec3& c, double u,
                                                            double v) const;

  FaceGearRing ring_;
  tooth_space::Outline outline_;
  double active_end_ = 0;
  FaceGearSurface<Dual2> dual_;
  FaceGearSurface<Second> second_;
  Turn to_minus_;  ///< from the minus flank of tooth 0 to that of the space 0 | 1
  std::array<std::shared_ptr<const FilletBlend>, 2> blends_;  ///< sides +1 and -1; empty: plain
  std::shared_ptr<const SpaceEnclosures> enclosures_;
};

}  // namespace toothpath::face_gear
