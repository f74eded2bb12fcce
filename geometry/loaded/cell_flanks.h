// What a pair of gears tells the cells: where its flanks come near at one position, every place about there, and the
// bodies below. One implementation a gear type; `cell_position` works on this alone. Housing frame; mm, N, rad.
// Derivation: docs/loaded_contact.md 5, 8.
#pragma once

#include <limits>
#include <vector>

#include "geometry/loaded/contact_line.h"
#include "geometry/loaded/tooth_body.h"

namespace toothpath::loaded {

/// The two bodies of one ring of a face gear, of one half of a bevel gear.
struct CellRing {
  int ring = 0;  ///< its number in the results
  const ToothBody *gear = nullptr, *pinion = nullptr;
  const FreeEnds *gear_ends = nullptr, *pinion_ends = nullptr;  ///< in the housing
  int pinion_next = 1;  ///< the pinion's tooth of the next pair stands a pitch on, +1, or a pitch back, -1
};

/// The pair, whatever its gears are.
struct CellBodies {
  BodyPlan gear, pinion;
  double modulus = 0;         ///< E*
  double lever = 0;           ///< > 0; the torque over it is F, the approach over it the turn against that torque
  double gear_lever = 0;      ///< > 0; the approach over it is the lag of the gear
  double edge_radius_mm = 0;  ///< rounding of the edges of the teeth; 0: not stated
  /// Lever and direction are equal at all places of a ring: that of its site counts.
  bool even = false;
  bool from_touch = false;  ///< gaps count from the first touch of the rigid flanks; else the first cell's is the zero
  Vec3 gear_axis = Vec3::UnitZ(), pinion_axis = Vec3::UnitZ();    ///< away from the mate
  Vec3 gear_origin = Vec3::Zero(), pinion_origin = Vec3::Zero();  ///< on the axes
  std::vector<CellRing> rings;
};

/// Where the flanks of one pair of teeth come near: a tangent plane there, and a rectangle in it.
struct CellSite {
  std::size_t ring = 0;  ///< index into CellBodies::rings
  int tooth = 0;
  std::size_t id = 0;                                 ///< of the one who made it
  Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();  ///< out of the gear
  Vec3 across = Vec3::Zero(),
       along = Vec3::Zero();  ///< sides of the rectangle: of the larger relative curvature; n x across
  double curvature = 0;       ///< relative, across, 1/mm
  double x = 0, y = 0, half_x = 0, half_y = 0;  ///< the rectangle: its middle from `point`, half its sides
  /// Where its flanks touch first, (x, y) in the plane: its gap, counted as those of the places, and its lever.
  Vec2 first = Vec2::Zero();
  double first_gap = std::numeric_limits<double>::infinity();  ///< infinite: not known beside the cells
  double first_lever = 1;
};

/// A place of the gear's flank above a point of the plane.
struct CellPlace {
  Segment at;             ///< without length; `gap` with all that modifications leave
  bool material = false;  ///< on both flanks; else nothing can press
  double lever = 1;       ///< of its normal, part of CellBodies::lever
};

/// The flanks of all teeth at one position.
class CellFlanks {
 public:
  CellFlanks() = default;
  CellFlanks(const CellFlanks&) = delete;
  CellFlanks& operator=(const CellFlanks&) = delete;
  virtual ~CellFlanks() = default;
  [[nodiscard]] virtual const CellBodies& bodies() const = 0;
  /// Those that may press; empty: no pair touches.
  [[nodiscard]] virtual const std::vector<CellSite>& sites() const = 0;
  [[nodiscard]] virtual double line_mm() const = 0;  ///< length of all lines of contact; 0: not known
  /// The places above the middles of columns x rows cells of a site's rectangle, row after row.
  [[nodiscard]] virtual std::vector<CellPlace> places(const CellSite& site, int columns, int rows) const = 0;
};

}  // namespace toothpath::loaded
