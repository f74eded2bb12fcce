// Stress in the fillets of gear and pinion under the forces of a loaded cycle: largest principal value, its place, and
// how far the bricks are from it. Units N, mm, MPa. Derivation: docs/loaded_contact.md.
#pragma once

#include "geometry/elastic/brick_stress.h"
#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

/// Where a fillet is stressed most over a cycle.
struct RootPlace {
  double stress = 0;  ///< largest principal, MPa
  int position = 0;   ///< of the cycle
  int ring = 0, tooth = 0;
  double face = 0, height = 0;  ///< of the gear: radius about its axis and z; of the pinion: section and radius
};

/// The stress of one fillet is what finer bricks give; what two meshes tell of their error stands beside it.
struct RootStress {
  RootPlace gear, pinion;
  double gear_error = 0, pinion_error = 0;  ///< MPa, by the coarser mesh
};

/// Bricks of one body of a ring, with the stress of its fillet under all hats.
struct RootBody {
  ToothBody bricks;
  std::vector<int> nodes;  ///< of the fillet
  elastic::HatStress stress;
};
/// @param on_gear  the gear's body, else the pinion's
/// Refused: bricks that fold.
[[nodiscard]] Result<RootBody> root_body(const LoadedPair& pair, const PairRing& ring, bool on_gear,
                                         const elastic::SectorPlan& plan);
/// The most stressed place of the fillets of a body over a cycle.
[[nodiscard]] RootPlace most_stressed(const RootBody& body, int ring, bool on_gear, const LoadedCycle& cycle);

/// Of all rings, in parallel; the same bits on any number of threads.
/// Refused: bricks that fold; a gear whose shaper has sharp tips: its fillets have no radius.
[[nodiscard]] Result<RootStress> root_stress(const LoadedPair& pair, const LoadedCycle& cycle);

}  // namespace toothpath::loaded
