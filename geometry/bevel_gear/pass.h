// Places on the pass of a finger mill along one wall of a bevel gear.
#pragma once

#include <optional>

#include "geometry/bevel_gear/trace.h"

namespace toothpath::bevel_gear {

/// Spiral angle at which the path of wall `sigma` has the cone distance R_c [mm]; R_c falls with beta along a whole
/// pass. By bisection, to the last digits. Nothing where the pass has no such place.
[[nodiscard]] std::optional<double> beta_at_centre(const BevelTrace<double>& trace, int sigma, double R_c);

}  // namespace toothpath::bevel_gear
