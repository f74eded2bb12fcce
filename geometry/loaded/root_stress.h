// Stress in the fillets of gear and pinion under the forces of a loaded cycle: largest principal value, its place, and
// how far the bricks are from it; of any gear type, and of face gears. Units N, mm, MPa. Derivation:
// docs/loaded_contact.md 10.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geometry/elastic/brick_stress.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

/// Where a fillet is stressed most over a cycle.
struct RootPlace {
  double stress = 0;  ///< largest principal, MPa
  int position = 0;   ///< of the cycle
  int ring = 0, tooth = 0;
  /// Of a face gear radius about its axis and z, of its pinion section and radius; of bevel gears cone distance and
  /// height over the pitch cone.
  double face = 0, height = 0;
};

/// The stress of one fillet is what finer bricks give; what two meshes tell of their error stands beside it.
struct RootStress {
  RootPlace gear, pinion;
  double gear_error = 0, pinion_error = 0;  ///< MPa, by the coarser mesh
};

/// Bricks of one body of a ring, with the stress of its fillet under all hats.
struct RootBody {
  ToothBody bricks;
  bool on_gear = true;                       ///< else the pinion's
  int next = 1;                              ///< its tooth of the next pair stands a pitch on, +1, or a pitch back, -1
  std::function<Vec2(const Vec3&)> place{};  ///< of a point of its frame: `face` and `height` of RootPlace
  std::vector<int> nodes{};                  ///< of the fillet
  elastic::HatStress stress{};
};
/// Fills in nodes and stress. Refused: a stiffness that is not positive definite.
[[nodiscard]] Result<RootBody> with_stress(RootBody body, const BodyPlan& of);
/// @param on_gear  the gear's body, else the pinion's
/// Refused: bricks that fold.
[[nodiscard]] Result<RootBody> root_body(const LoadedPair& pair, const PairRing& ring, bool on_gear,
                                         const elastic::SectorPlan& plan);
/// The most stressed place of the fillets of a body over a cycle.
[[nodiscard]] RootPlace most_stressed(const RootBody& body, int ring, const LoadedCycle& cycle);

/// What a gear type tells of its roots.
struct RootBodies {
  std::vector<int> rings;           ///< their numbers in the results
  std::array<double, 2> rim_mm{};   ///< of gear and pinion
  std::array<int, 2> across{4, 6};  ///< bricks across the tooth on the two meshes
  /// The body of a ring (by its index) on these bricks. Refused: bricks that fold.
  std::function<Result<RootBody>(std::size_t ring, bool on_gear, const elastic::SectorPlan& plan)> make;
};
/// Of all rings on two meshes, in parallel; the same bits on any number of threads. Refused: as `make`.
[[nodiscard]] Result<RootStress> root_stress(const RootBodies& bodies, const LoadedCycle& cycle);

/// Of all rings, in parallel; the same bits on any number of threads.
/// Refused: bricks that fold; a gear whose shaper has sharp tips: its fillets have no radius.
[[nodiscard]] Result<RootStress> root_stress(const LoadedPair& pair, const LoadedCycle& cycle);

}  // namespace toothpath::loaded
