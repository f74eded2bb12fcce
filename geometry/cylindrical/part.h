// A cylindrical gear as planners and proofs ask for it. Zones are numbered as in the job, with rising z; s = -z falls.
#pragma once

#include <memory>

#include "geometry/cylindrical/gear.h"
#include "geometry/tooth_space/toothed_part.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::cylindrical {

/// The blank is turned: tip cylinder, end faces, bore, and the groove between two zones. The gear is copied.
[[nodiscard]] std::shared_ptr<const tooth_space::ToothedPart> part_of(const CylindricalGear& gear);

/// The finished gear, which must outlive it: rings stand in falling z; without a bore the body reaches to the axis.
[[nodiscard]] tooth_space::ToothedSolid drawn_solid(const CylindricalGear& gear);

}  // namespace toothpath::cylindrical
