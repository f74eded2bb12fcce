// Bicubic B-spline patches for the teeth of a gear, close enough to its exact surfaces.
#pragma once

#include <string>
#include <vector>

#include "geometry/exchange/bspline.h"
#include "geometry/exchange/shell.h"

namespace toothpath::exchange {

/// Greatest distance of a patch from the exact surface, mm: 0.1 um.
inline constexpr double kFitTolerance_mm = 1e-4;

/// Pitch 0 of one ring.
struct FittedRing {
  std::vector<SplineSurface> strips;  ///< one a strip; u is common to all, so that edges have one curve
  std::vector<double> worst_mm;       ///< one a strip: greatest distance seen
};
struct FittedShell {
  std::vector<FittedRing> rings;
  std::size_t patches = 0;  ///< of all teeth
  std::size_t checked = 0;  ///< places of one pitch at which the distance was taken
  double worst_mm = 0;      ///< greatest of them
  std::string worst_at;     ///< "fillet +1 of zone 0"
};

/// Patches within `tolerance_mm`. Knots are put where they are needed, first along, then across, until the distance at
/// places that no patch was led through (`kChecksPerPiece` squared on every piece, and the lines between) is small
/// enough. The distance is that between points of the same parameters, which no distance along the normal exceeds.
/// Refused: a surface that bends too much for `kMostPieces` pieces, with its place and what is left; what the rows of
/// the shell refuse.
[[nodiscard]] Result<FittedShell> fit_shell(const GearShell& shell, double tolerance_mm = kFitTolerance_mm);

inline constexpr std::size_t kMostPieces = 256, kChecksPerPiece = 4;

}  // namespace toothpath::exchange
