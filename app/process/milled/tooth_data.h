// What a shop measures on the teeth of any gear, from the exact flanks: the lower half of its data sheet.
#pragma once

#include <string>
#include <vector>

#include "app/report/sheet/data_sheet.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::milled {

/// A place of a ring of teeth at which its thickness is stated.
struct ThicknessPlace {
  int zone = 0;
  double s = 0, h = 0;  ///< of the chart
  std::string where;    ///< "reference circle, middle of the face"
};
/// Half way along a zone and half way up its plus flank, for gears that have no reference circle there.
[[nodiscard]] ThicknessPlace middle_of_zone(const tooth_space::ToothedSolid& solid, int zone);

/// A group a place: thickness on the arc and by a caliper, its height, top land, a measuring ball in the space with the
/// dimension over it.
[[nodiscard]] std::vector<sheet::DataGroup> tooth_data(const tooth_space::ToothedSolid& solid,
                                                       const std::vector<ThicknessPlace>& places);

}  // namespace toothpath::milled
