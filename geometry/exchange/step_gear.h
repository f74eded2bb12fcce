// A gear as a STEP solid: one MANIFOLD_SOLID_BREP with one CLOSED_SHELL, every tooth of B-spline faces, the body of
// planes, cylinders and cones.
#pragma once

#include <string>
#include <string_view>

#include "geometry/exchange/shell_fit.h"

namespace toothpath::exchange {

/// What stands in the file.
struct StepCounts {
  std::size_t faces = 0, edges = 0, vertices = 0, bounds = 0;
};
struct StepFile {
  std::string text;
  StepCounts counts;
};

/// The whole gear, mm: neighbours share their EDGE_CURVE, once in each direction; edges of teeth are the boundary
/// curves of their patches, with the same control points. The uncertainty in the file is the tolerance of the fit.
/// Faces are named after strip and tooth: 'flank +1 of tooth 12'; teeth count from 0. `fitted`: of the same shell.
/// Refused: what the rows of the shell refuse.
[[nodiscard]] Result<StepFile> step_gear(const GearShell& shell, const FittedShell& fitted, std::string_view name);

}  // namespace toothpath::exchange
