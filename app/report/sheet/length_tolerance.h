// How wrong the length of a tool may be before a program that is proven leaves its limits.
//
// A length error d moves the whole tool by d along its axis u. Where the tool makes the surface with normal n (out of
// the material) that moves the surface by d (u . n) along its normal, to first order; the tool's path is a translation
// of itself, so that nowhere is it more than |d| max |u . n|. A tool that is too long may then use what the gouge
// tolerance leaves beyond the proven bound (and the stock that its operation leaves); one that is too short what a
// finishing operation may leave beyond what it is proven to leave. docs/setup_sheet.md has the derivation.
#pragma once

#include <span>
#include <vector>

#include "app/job/job.h"
#include "app/report/run_report.h"
#include "cam/path/cl_path.h"
#include "cam/proof/limits.h"

namespace toothpath::sheet {

/// Directions at which a surface that no grid of the cut surface holds meets the tool: a share for it, with the patch
/// it stands for.
struct OtherSurface {
  double share = 0;  ///< largest |u . n|; 0: there is none
};

/// One an operation that cuts. The axes are those of the feed records of each zone; the normals those of the reachable
/// grid points of the cut surface of that zone. Axes within `kSameAxis` are taken as one, and that angle is added: the
/// share is an upper bound. `report` must hold gouge, excess and finished of the proven program. Empty where it lacks
/// them.
[[nodiscard]] std::vector<report::LengthTolerance> length_tolerances(const job::Job& job,
                                                                     const proof::ProofLimits& limits,
                                                                     const report::RunReport& report,
                                                                     std::span<const path::ClPath* const> paths,
                                                                     const std::vector<proof::SurfaceGrid>& grids,
                                                                     const OtherSurface& other);

}  // namespace toothpath::sheet
