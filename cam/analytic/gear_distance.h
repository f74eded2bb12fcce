// Exact distance from a point to the finished part: the question that every gouge check asks.
//
// The solid is the rings of teeth (each between its two ends, below its tip surface), the groove floor between two
// rings and the body below. Facets over the working sheet of one tooth space, with proven sags, find candidates; Newton
// on the analytic patches decides; both in double. Edges (ends of the ring, tip edges) are polylines whose proven sag
// is subtracted. How the cells are made: cam/analytic/gear_ring.h. All spaces are turned copies: a point is first
// turned into space 0.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cam/analytic/spatial_index.h"
#include "geometry/base/refusal.h"
#include "geometry/base/result.h"
#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::analytic {

class BodyPatches;

/// What lies nearest to a point.
struct NearestPlace {
  double distance = 0;  ///< to the solid, mm; negative inside. A proven lower bound; exact when `exact`
  bool exact = false;
  int zone = 0;
  const char* patch =
      "";  ///< "flank +1", "fillet +1", "root", "fillet -1", "flank -1", "tip", "tip edge", "end", "end edge", "groove"
  Vec3 foot = Vec3::Zero();   ///< nearest point, turned to space 0
  Vec3 point = Vec3::Zero();  ///< the asked point, turned to space 0
};

class GearDistance {
 public:
  /// `reach_mm`: largest distance that will ever be asked for (`within`).
  /// Where the surfaces of a ring cannot be followed over its whole width there is a `refusal()`; such a part has no
  /// zones, and `nearest` calls every point inside.
  GearDistance(std::shared_ptr<const tooth_space::ToothedPart> part, double reach_mm);
  ~GearDistance();
  GearDistance(GearDistance&&) noexcept;

  /// Distance from `c` (gear frame, any tooth) to the solid; distances above `within` are returned as `within`, not
  /// exact.
  [[nodiscard]] NearestPlace nearest(const Vec3& c, double within) const;

  /// How far a point keeps from the surface at least, up to `within`, on either side of it: by facets and their proven
  /// sags, so up to some micrometres less than it does. At a fraction of the cost of `nearest`.
  [[nodiscard]] double surface_keeps(const Vec3& p, double within) const;
  /// The same of every place of the straight line from `from` along the unit vector `axis`: for little more than one
  /// place costs. What stands beside the line, above its start, is taken by its distance across the axis: less than is
  /// true where the axis points away from it.
  [[nodiscard]] double surface_keeps(const Vec3& from, const Vec3& axis, double length, double within) const;

  /// Why there is no distance to this gear: key within [gear] and message; none for a gear that can be asked.
  [[nodiscard]] const std::optional<Refusal>& refusal() const;

  static constexpr int kBands = 4;  ///< a fillet may be touched at both of its ends: start places from several bands

  /// The cells and edges themselves, for bodies that are no balls: visits candidates near a point of space 0.
  struct Cell {
    std::array<Vec3, 4> corner;
    Vec3 centre = Vec3::Zero();
    double radius = 0;  ///< of the sphere about `centre` that holds the cell and its sag
    int zone = 0;
    tooth_space::Piece piece = tooth_space::Piece::root;
    double u = 0, v = 0;
    bool sheet = true;  ///< false: a piece of a top land, which has no analytic patch; for bodies only
    std::uint32_t first_triangle = 0, triangles = 0;  ///< what of the cell stands for material, in `triangles(zone)`
    int band = 0;  ///< quarter of the piece across the space: a fillet may be touched at both of its ends
  };
  [[nodiscard]] const std::vector<Cell>& cells(int zone) const;
  /// The cells cut off at the tip surface and the ends of the ring, widened there by no more than the sag.
  [[nodiscard]] const std::vector<std::array<Vec3, 3>>& triangles(int zone) const;
  [[nodiscard]] const SpatialIndex& cell_index(int zone) const;
  [[nodiscard]] const tooth_space::ToothSpace& space(int zone) const { return part().space(zone); }
  /// The same cells on the exact surface, with proven sags: what shank and holder are proven against.
  [[nodiscard]] const BodyPatches& patches(int zone) const;
  /// Bounds of sags that are measured and not proven: none on nominal gears. docs/proof.md, What a clean result means.
  [[nodiscard]] std::size_t unproven() const;
  /// Of so many in all.
  [[nodiscard]] std::size_t bounded() const;

  /// Largest distance between a facet of the cells and the exact surface as it showed when the cells were made,
  /// doubled, mm: for searches of tool directions and for the start places of Newton. What is proven rests on
  /// `patches`.
  [[nodiscard]] double cell_sag_mm() const;
  [[nodiscard]] const tooth_space::ToothedPart& part() const;
  [[nodiscard]] int zones() const;
  /// Azimuth of the middle of tooth space 0 at s of a zone.
  [[nodiscard]] double space_azimuth(int zone, double s) const;
  /// Of all cells of a zone, from the gear axis.
  [[nodiscard]] double least_radius(int zone) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Distance from a point to a triangle.
[[nodiscard]] double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace toothpath::analytic
