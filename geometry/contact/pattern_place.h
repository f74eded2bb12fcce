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

/// A set of edges, a bit each.
using Edges = std::uint8_t;
[[nodiscard]] constexpr Edges bit(Edge edge) { return static_cast<Edges>(1u << static_cast<unsigned>(edge)); }

/// Edges of the flank itself that a place of its grid lies at: within the margin of them, and always the last places.
/// @param margin  share of the face and of the flank's height, 0 to 0.4
[[nodiscard]] Edges own_edges(int rows, int columns, int row, int column, double margin);
/// Is one of the four places beside this one without a common normal?
[[nodiscard]] bool beside_the_end(const EaseOffMap& map, int rows, int columns, int row, int column);

/// Which edges a place of a face gear's grid lies at: those of the flank, and those of the pinion.
/// @param margin  share of the face, of the flank's height and of the pinion's active depth, 0 to 0.4
/// @param pinion_radius_mm  of the pinion where it is nearest to a place without a common normal
[[nodiscard]] Edges edges_at(const ContactMember& member, const EaseOffMap& map, int row, int column, double margin,
                             double pinion_radius_mm);

/// Shares of the flank: profile 0 at the fillet line, 1 at the tip; lead 0 at the inner end of the ring, 1 at the
/// outer.
struct PatternPlace {
  bool any = false;                                ///< is there a mark at all?
  double profile = 0, lead = 0;                    ///< centre of the marked area
  double low = 0, high = 0, inner = 0, outer = 0;  ///< its extent: profile, lead; between the places of the grid
  std::array<double, kEdges> gap_mm{};  ///< least gap at each edge, its margin and all; kUnmet: the pinion never comes
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
  std::vector<Edges> edges;    ///< that each place lies at
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
