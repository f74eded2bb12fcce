// The tooth space of a face gear behind the interface that planners and proofs see.
#pragma once

#include "geometry/face_gear/space_sheet.h"

namespace toothpath::test {

inline const face_gear::SpaceSheet& sheet_of(const tooth_space::ToothSpace& space) {
  return dynamic_cast<const face_gear::SpaceSheet&>(space);
}

}  // namespace toothpath::test
