// The same contact as a deck of CalculiX (Abaqus dialect), for those who want their own solver and for the test that
// takes CalculiX as judge: one ring, a row of teeth of gear and pinion in the housing, the gear's clamped nodes turned.
#pragma once

#include <string>

#include "geometry/loaded/loaded_pair.h"

namespace toothpath::decks {

struct DeckOptions {
  elastic::SectorPlan bricks = {4, 12, 3, 1, 3, 8, 25, 2};  ///< thinner towards the loaded flank
  int teeth = 3;                                            ///< of the row, odd
  double E = 210000, nu = 0.3;
  double pinion_fillet_mm = 1.2;
  double phi = 0;          ///< turn of the pinion
  double approach_mm = 0;  ///< by which the gear is turned against the pinion, along the normals
};

/// Two rows of teeth where they stand, the middle tooth of each in contact, and how the gear is turned.
struct DeckRows {
  std::string head;  ///< a line, without the stars of a remark
  const elastic::Sector *gear = nullptr, *pinion = nullptr;
  Mat3 gear_turn = Mat3::Identity(), pinion_turn = Mat3::Identity();  ///< from a sector's frame, of the middle tooth
  Vec3 gear_at = Vec3::Zero(), pinion_at = Vec3::Zero();              ///< where the origins of the sectors go
  int pinion_next = 1;                                                ///< as in loaded::CellRing
  Vec3 axis = Vec3::UnitZ();                                          ///< of the gear, through gear_at
  double turn = 0;                                                    ///< of its clamped nodes about it, rad
  int teeth = 3;                                                      ///< of the rows, odd
  double E = 210000, nu = 0.3;
};
/// Sets GEAR_HELD and PINION_HELD, the surfaces GEAR_T and PINION_T of tooth T (0 the first of the row), a contact pair
/// a tooth; prints the reactions of GEAR_HELD.
[[nodiscard]] std::string rows_deck(const DeckRows& rows);

/// Rows of teeth of one ring in the housing: the moment of the reactions about z over M2 is the normal force. Refused:
/// as for the bricks.
[[nodiscard]] Result<std::string> contact_deck(const face_gear::FaceGear& gear, int ring, int side,
                                               const DeckOptions& options);

/// One body with a hat of force 1 on station `station` of the middle tooth; prints all displacements. For E = 1.
[[nodiscard]] std::string hat_deck(const elastic::Sector& sector, double nu, int teeth, int station);

}  // namespace toothpath::decks
