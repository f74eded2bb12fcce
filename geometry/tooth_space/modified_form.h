// What modifications come to on one ring, looked at on a grid of places of the plain and the modified surface.
#pragma once

#include <optional>
#include <string>

#include "geometry/base/refusal.h"
#include "geometry/tooth_space/tooth_space.h"

namespace toothpath::tooth_space {

struct ModifiedForm {
  /// A value and where it was found.
  struct Most {
    double value = 0;
    int side = 1;
    double radius_mm = 0, height_mm = 0;
  };
  Most removed_mm;    ///< greatest, along the normals of the plain flanks
  Most turned_rad;    ///< greatest angle between the normals of modified and plain flank
  Most hollow_flank;  ///< radius of the most hollow curvature, mm; infinite where nothing is hollow
  Most hollow_fillet;
  double plain_hollow_flank_mm = 0, plain_hollow_fillet_mm = 0;  ///< of the plain surfaces
  Most land_mm;                                                  ///< least top land
  double plain_land_mm = 0;                                      ///< of the plain tooth at that radius
};

/// Of a drawing: a correction does not count.
[[nodiscard]] ModifiedForm modified_form(const ToothSpace& plain, const ToothSpace& modified);

/// Modifications that are no small offsets: normals that turn by more than 0.1 rad, a pointed tooth. Key
/// "modification".
[[nodiscard]] std::optional<Refusal> refused(const ModifiedForm& form, int zone);
/// A top land that falls below the least; empty: none does.
[[nodiscard]] std::string narrow_land(const ModifiedForm& form, int zone, double least_mm);

}  // namespace toothpath::tooth_space
