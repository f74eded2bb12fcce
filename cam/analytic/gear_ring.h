// One ring of a finished part as it is searched: cells over the working sheet of one tooth space, lands, end faces and
// groove floor, the polylines of its edges, and tables along the teeth. Made once; `GearDistance` and the bodies ask
// it.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "cam/analytic/body_patches.h"
#include "cam/analytic/gear_distance.h"
#include "cam/analytic/spatial_index.h"
#include "cam/clearance/facet_tree.h"
#include "geometry/base/result.h"
#include "geometry/tooth_space/offset_sheet.h"
#include "geometry/tooth_space/toothed_part.h"

namespace toothpath::analytic {

/// A piece of an edge, between two places of it.
struct EdgeSegment {
  Vec3 a, b;
  const char* patch;
  double sag = 0;  ///< how far the edge may leave the segment: proven, or as it showed where that is not possible
};

/// A quad of the sheet that its two facets leave by no more than `GearRing::facet_sag`: where Newton starts.
struct SheetQuad {
  tooth_space::Piece piece = tooth_space::Piece::root;
  std::uint8_t band = 0;  ///< quarter of the piece across the space
  bool border = false;    ///< partly beyond an end of the ring or the tip
  double u = 0, v = 0;    ///< its middle
};

struct GearRing {
  using Cell = GearDistance::Cell;
  const tooth_space::ToothSpace& space;
  tooth_space::Chart chart;
  tooth_space::OffsetSheet sheet;
  double s_from = 0, s_to = 0;
  double base_mm = 0;       ///< height at which the cells of the ends stop
  double least_radius = 0;  ///< of all cells
  std::vector<Cell> cells;
  std::unique_ptr<SpatialIndex> index;
  std::vector<SheetQuad> quads;                      ///< of the sheet
  clearance::FacetTree whole_facets, border_facets;  ///< of `quads`: those wholly on the ring, and the others
  clearance::FacetTree other_facets;                 ///< lands and ends of all teeth within the reach of a question
  double facet_sag = 0;                              ///< proven: how far the surface may leave all these facets
  std::vector<EdgeSegment> edges;
  clearance::FacetTree edge_facets;  ///< the segments
  double sag = 0;                    ///< of the facets, as it showed, doubled
  double edge_sag = 0;               ///< greatest of the edges
  std::size_t unproven_edges = 0;    ///< stretches of an edge for which only the sag that showed is known
  double tip_sag = 0;                ///< of the tip surface's meridian against the straight line between its ends
  double tip_from = 0, tip_to = 0;   ///< its heights there
  double tip_slope = 0;              ///< the most by which it rises or falls, mm/mm
  std::vector<double> table_s, mid, tip_plus, tip_minus;  ///< azimuths over s
  std::vector<double> opening;                            ///< azimuth of the middle between the tip edges, over s
  double opening_slope = 0;                               ///< the most by which it turns, rad/mm
  std::vector<std::vector<Vec2>> profiles;                ///< (azimuth, h) of the sheet at every station
  std::vector<std::vector<Vec2>> profile_steps;  ///< from there to the next station, the azimuth the short way round
  std::vector<Vec2> end_from, end_to;            ///< the same at the ends, tip to tip
  std::vector<std::array<Vec3, 3>> triangles;    ///< of the cells, for bodies
  std::unique_ptr<BodyPatches> patches;          ///< the same cells on the exact surface

  /// The sheet of the surface itself at `stations` places along the teeth.
  GearRing(const tooth_space::ToothSpace& t, double sheet_from, double sheet_to, int stations)
      : space(t), chart(t.outline().chart), sheet(space, 0.0, sheet_from, sheet_to, stations) {}
  GearRing(const GearRing&) = delete;
  GearRing& operator=(const GearRing&) = delete;

  /// Ring `zone` of the part, for distances up to `reach_mm`; a refusal where its surfaces cannot be followed over its
  /// whole width. The part must outlive it.
  static Expected<std::unique_ptr<GearRing>, Refusal> make(const tooth_space::ToothedPart& part, int zone,
                                                           double reach_mm);

  [[nodiscard]] bool on_ring(const Vec3& p) const;
  /// Is the azimuth over the top land at s?
  [[nodiscard]] bool over_land(double azimuth, double s) const;
  /// Distance to the tip surface's meridian in the plane (s, h), from below; `foot` is s of its foot.
  [[nodiscard]] double to_tip_meridian(double s, double h, double& foot) const;
  /// Is the place at s inside the material? By the profile across the space there: between the stations, since a root
  /// may rise along the tooth.
  [[nodiscard]] bool in_material_at(double s, double azimuth, double h, double tip) const;
  /// A table over s.
  [[nodiscard]] double lookup(const std::vector<double>& y, double s) const;
};

/// Is (azimuth, h) at this profile inside the material? The profile runs from tip to tip.
[[nodiscard]] bool in_material(const std::vector<Vec2>& profile, double azimuth, double h, double tip);

}  // namespace toothpath::analytic
