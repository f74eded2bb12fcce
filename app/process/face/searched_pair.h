// A face gear and its pinion, as the tables and the search of ease_off ask for them.
#pragma once

#include <memory>
#include <string>

#include "app/process/ease_off/searched_pair.h"
#include "geometry/face_gear/gear.h"

namespace toothpath::face {

/// How tables and maps call the flanks of a face gear.
extern const ease_off::PairWords kFaceWords;

struct FacePairAsked {
  const job::Job* job = nullptr;
  const face_gear::FaceGear* gear = nullptr;  ///< of the job
  int pinion_teeth = 0;
  job::ContactSettings settings;
  std::string modify = "both";  ///< "gear", "pinion" or "both"
  contact::RollOptions roll;
  int rows = 0, columns = 0;  ///< of the flanks that are rolled
};
/// What `asked` points at must outlive it.
[[nodiscard]] std::unique_ptr<ease_off::SearchedPair> searched_pair(const FacePairAsked& asked);

}  // namespace toothpath::face
