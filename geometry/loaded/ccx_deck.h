// The same contact as a deck of CalculiX (Abaqus dialect), for those who want their own solver and for the test that
// takes CalculiX as judge: one ring, a row of teeth of gear and pinion in the housing, the gear's clamped nodes turned.
#pragma once

#include <string>

#include "geometry/loaded/loaded_pair.h"

namespace toothpath::loaded {

struct DeckOptions {
  elastic::SectorPlan bricks = {4, 12, 3, 1, 3, 8, 25, 2};  ///< thinner towards the loaded flank
  int teeth = 3;                                            ///< of the row, odd
  double E = 210000, nu = 0.3;
  double pinion_fillet_mm = 1.2;
  double phi = 0;          ///< turn of the pinion
  double approach_mm = 0;  ///< by which the gear is turned against the pinion, along the normals
};

/// Sets GEAR_HELD and PINION_HELD, the surfaces GEAR_T and PINION_T of tooth T (0 the first of the row), a contact pair
/// a tooth; prints the reactions of GEAR_HELD: their moment about z over M2 is the normal force. Refused: as for the
/// bricks.
[[nodiscard]] Result<std::string> contact_deck(const face_gear::FaceGear& gear, int ring, int side,
                                               const DeckOptions& options);

/// One body with a hat of force 1 on station `station` of the middle tooth; prints all displacements. For E = 1.
[[nodiscard]] std::string hat_deck(const elastic::Sector& sector, double nu, int teeth, int station);

}  // namespace toothpath::loaded
