// Where on the flank a contact pattern lies, and which edges it reaches: ends of the face, tips of gear and pinion, the
// fillet line, the end of the pinion's involute.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/contact/ease_off.h"

namespace toothpath::contact {

enum class Edge : std::uint8_t { inner_end, outer_end, tip, fillet_line, pinion_tip, pinion_root };
inline constexpr int kEdges = 6;
/// "inner end", "pinion tip".
[[nodiscard]] const char* to_string(Edge edge);

inline constexpr double kUnmet = 1e300;  ///< gap of a place that the pinion never comes to

/// How far beyond the margin of every edge a place lies, in shares of the face, of the flank's height, of the pinion's
/// active depth; not above 0: within it, or the last place before the edge.
using BeyondMargins = std::array<double, kEdges>;

/// Of the edges of the flank itself, at a place of its grid. @param margin  0 to 0.4
[[nodiscard]] BeyondMargins beyond_own_margins(int rows, int columns, int row, int column, double margin);
/// Is one of the four places beside this one without a common normal?
[[nodiscard]] bool beside_the_end(const EaseOffMap& map, int rows, int columns, int row, int column);

/// Of all edges at a place of a face gear's grid: those of the flank, and those of the pinion.
/// @param pinion_radius_mm  of the pinion where it is nearest to a place without a common normal
[[nodiscard]] BeyondMargins beyond_margins(const ContactMember& member, const EaseOffMap& map, int row, int column,
                                           double margin, double pinion_radius_mm);

/// Where a line of the grid crosses the bound of a margin: between a place within it and its neighbour beyond.
struct MarginBound {
  std::size_t within = 0, beyond = 0;  ///< places
  double share = 0;                    ///< of the way between them
  Edge edge = Edge::inner_end;
};
/// All of a grid, row by row or column by column. @param across, along  places of a line, lines
[[nodiscard]] std::vector<MarginBound> margin_bounds(int across, int along, const std::vector<BeyondMargins>& places);

/// Shares of the flank: profile 0 at the fillet line, 1 at the tip; lead 0 at the inner end of the ring, 1 at the
/// outer.
struct PatternPlace {
  bool any = false;                                ///< is there a mark at all?
  double profile = 0, lead = 0;                    ///< centre of the marked area
  double low = 0, high = 0, inner = 0, outer = 0;  ///< its extent: profile, lead; between the places of the grid
  /// Least gap at each edge, its margin and all, up to its bound between the places; kUnmet: the pinion never comes.
  std::array<double, kEdges> gap_mm{};
  [[nodiscard]] bool reaches(Edge edge, double compound_mm) const {
    return gap_mm[static_cast<std::size_t>(edge)] <= compound_mm;
  }
};
/// What a roll left on a flank, whatever the gear: its grid row by row, row 0 at the fillet line, column 0 at the inner
/// end.
struct RolledGrid {
  int rows = 0, columns = 0;
  std::vector<Vec3> points;    ///< of tooth 0; their areas weigh the marks
  std::vector<double> gap_mm;  ///< least gap; beyond 1e100: the pinion never comes
  std::vector<BeyondMargins> margins;
};
[[nodiscard]] PatternPlace pattern_place(const RolledGrid& rolled, double compound_mm);
/// Of a face gear.
[[nodiscard]] PatternPlace pattern_place(const ContactMember& member, const EaseOffMap& map,
                                         const FlankPattern& pattern, double compound_mm, double margin);

/// One side of a pair that stands off its place.
struct MisalignedContact {
  Misalignment moved;
  double error_mean_rad = 0, error_range_rad = 0;  ///< transmission error
  std::vector<PatternPlace> at_edges;              ///< one a ring; edges without a margin
  std::vector<PatternPlace> in_margin;             ///< edges with the margin
  /// Least gap in the margin of any edge of any ring, and where.
  double margin_gap_mm = 0;
  Edge nearest = Edge::inner_end;
  int nearest_zone = 0;

  /// Off its place, nothing rolled yet.
  [[nodiscard]] static MisalignedContact at(const Misalignment& moved);
  /// A ring with its pattern, rings in their order. @param edges, margin  its place without margin and with it
  void add_ring(int zone, PatternPlace edges, PatternPlace margin);
};

/// What the pair of a face gear is: flanks of one side, exact or cut, and the pinion.
struct PairSide {
  const face_gear::FaceGear* gear = nullptr;
  std::vector<ContactFlank> flanks;  ///< one a ring
  int pinion_teeth = 0;
  std::vector<modification::Modification> on_pinion;
};
/// Rolls it. Refused: a pinion out of reach; no place with a common normal.
[[nodiscard]] Result<MisalignedContact> misaligned_contact(const PairSide& pair, const Misalignment& moved,
                                                           const RollOptions& options, double margin);

}  // namespace toothpath::contact
