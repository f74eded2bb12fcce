// A face gear and the pinion that is its shaper under load: elastic teeth, all pairs and rings at once. Quasi-static,
// linear, no friction. Units N, mm, MPa, rad. Derivation: docs/loaded_contact.md.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "geometry/contact/tooth_contact.h"
#include "geometry/loaded/complementarity.h"
#include "geometry/loaded/contact_line.h"
#include "geometry/loaded/tooth_body.h"

namespace toothpath::loaded {

struct PairOptions {
  BodyPlan gear, pinion;
  double segment_mm = 1.5;
  double pinion_fillet_mm = 1.2;
  contact::Misalignment moved;
  /// What else stands between the flanks, mean over a segment, mm: deviations of cut flanks; may be empty.
  /// What modifications take off belongs into `PairRing::removal`: it moves and bends the lines.
  std::function<double(const Segment&)> gap;
  /// Pressures on cells and not on strips along lines, also for a pinion of as many teeth as the shaper.
  bool cells = false;
  double edge_radius_mm = 0;  ///< rounding of the edges of the teeth; 0: not stated
};

struct PairRing {
  int ring = 0;
  face_gear::FaceGearSurface<double> surface;
  ContactBounds bounds;
  contact::Pinion<double> moved;    ///< the pinion as it stands
  Removal removal{};                ///< by modifications of gear and pinion, where the pinion stands as `moved`
  FreeEnds gear_ends, pinion_ends;  ///< in the housing
  ToothBody gear, pinion;
};

/// Everything that does not depend on load and position.
struct LoadedPair {
  int side = 1, teeth = 0, shaper_teeth = 0, pinion_teeth = 0;
  PairOptions options;
  double modulus = 0;  ///< E*
  double lever = 0;    ///< M2: of every normal about the gear's axis
  std::vector<PairRing> rings;
};

/// A pinion of fewer teeth than the shaper touches in ellipses: found on cells.
/// Refused: a pinion of more teeth than the shaper, an undercut flank, a tooth that has no bricks.
[[nodiscard]] Result<LoadedPair> make_loaded_pair(const face_gear::FaceGear& gear, int side, int pinion_teeth,
                                                  const PairOptions& options);

/// How the pinion is held along its axis.
enum class PinionAxial { held, floating, spring };

struct Load {
  double torque_nmm = 0;  ///< on the gear; > 0
  PinionAxial axial = PinionAxial::held;
  double spring_n_mm = 0;  ///< of `spring`
  int positions = 24;      ///< over one pitch of the pinion
};

struct PressedSegment {
  Segment place;
  double force = 0, half_width = 0, pressure = 0;
};

struct LoadedPosition {
  double phi = 0;                     ///< turn of the pinion
  bool cells = false;                 ///< pressures are those of cells, `segments` their rows
  double approach_mm = 0;             ///< X, along the normals
  double error_rad = 0;               ///< loaded transmission error: by how much the gear lags
  double shift_mm = 0;                ///< of the pinion along its axis
  double stiffness = 0, tangent = 0;  ///< F/X and dF/dX, N/mm
  double line_mm = 0;                 ///< length of all lines
  int pairs = 0;                      ///< teeth that carry more than a thousandth, in any ring
  std::vector<double> ring_force;     ///< normal force of every ring, N
  double axial_n = 0;                 ///< on the pinion, along its axis away from the gear's
  double gear_axial_n = 0;            ///< on the gear, along its axis away from the pinion
  /// What the forces make about the axes of gear and pinion, N mm: what is asked for of the one that carries the
  /// torque; of the other the ratio of teeth only where flanks are conjugate.
  double gear_torque_nmm = 0, pinion_torque_nmm = 0;
  double share_per_mm = 0;  ///< change of the outermost ring's share with the pinion's place, held pinions
  double pressure = 0, end_pressure = 0;  ///< largest of the inner segments; of the first and last of a line
  double end_line_load = 0;               ///< largest load of an end segment, N/mm
  double edge_pressure = 0;               ///< largest under edges of the stated radius; 0: no edge carries, no radius
  double pressure_radius_mm = 0;          ///< least radius of relative curvature where a line presses, mm
  double residual = 0;                    ///< of balance and complementarity, part of load and approach
  std::vector<PressedSegment> segments;
};

struct LoadedCycle {
  double normal_n = 0;        ///< F
  double single_axial_n = 0;  ///< that the same torque makes on one ring
  std::vector<LoadedPosition> positions;
};

/// @param phi  turn of the shaper that stands where the gear does; a pitch is 2 pi/N_s
/// Refused: a torque that is not above 0; no pair touches at some position; a load that does not settle.
[[nodiscard]] Result<LoadedPosition> loaded_position(const LoadedPair& pair, const Load& load, double phi);
/// Positions 0 .. positions - 1 of a pitch, in parallel. Refused: as the first position that is.
[[nodiscard]] Result<std::vector<LoadedPosition>> positions_over(
    int positions, double pitch, const std::function<Result<LoadedPosition>(double phi)>& position);
/// The positions of one pitch, in parallel; the same bits on any number of threads.
[[nodiscard]] Result<LoadedCycle> loaded_cycle(const LoadedPair& pair, const Load& load);

}  // namespace toothpath::loaded
