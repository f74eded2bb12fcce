// A modification as a removal over the depth plus one along the face: what a cutter whose own profile and whose own
// path can be changed, but not both together, is able to make. mm. Formulas: docs/modifications.md, section 6.
#pragma once

#include <vector>

#include "geometry/modification/modification.h"

namespace toothpath::modification {

struct Separate {
  std::vector<SmoothCurve> over_depth, over_face;  ///< empty: nothing
  /// What is left of the modification after both: most of it, and where. Only twist and grids have it.
  double mixed_mm = 0, depth_mm = 0, along_mm = 0;
};

/// Of one modification, which is not `refused`. A grid is split into the means of its rows and columns; what it takes
/// everywhere alike belongs to the face.
[[nodiscard]] Separate separate(const Modification& modification, const Rectangle& on);

}  // namespace toothpath::modification
