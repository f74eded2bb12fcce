// From the bytes of an NC program to what is proven about it: read back through the machine's kinematics, compared with the
// path that was asked for, checked for gouges and clear rapids.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/job.h"
#include "app/stage_clock.h"
#include "cam/cut_surface.h"
#include "cam/gouge_check.h"
#include "machines/machine.h"
#include "postproc/nc_reader.h"

namespace toothpath {

struct ProgramProof {
  std::vector<ToolMotion> motions;  ///< in program order; all teeth that were kept
  ReadBack read;
  GougeResult gouge;
  CutSurface surface;               ///< what the program leaves on the finished surface
  std::optional<ClComparison> comparison;  ///< only where there is a path to compare with
  std::vector<std::string> reasons;        ///< why the program is not proven; empty: it is
};

struct ProofOptions {
  double gouge_tolerance_mm = 2e-3;
  double motion_tolerance_mm = 1e-4;   ///< largest proven distance of a motion from its straight line
  double motion_tolerance_rad = 1e-4;  ///< the same for the axis
  double path_tolerance_mm = 2e-3;     ///< how far a CL record may lie from the motion that meets it
  double path_tolerance_rad = 2e-3;
  CutSurfaceOptions cut_surface;       ///< grid on which the cut surface is measured
};

/// Reads `text` back and checks it. `paths` may be empty (a program that somebody else wrote).
/// Errors: what the reader refuses, located in `file`. A program that is read but not safe is no error: see `reasons`.
[[nodiscard]] Result<ProgramProof> prove_program(std::string_view text, const std::string& file, const Job& job, const Machine& machine,
                                                 const GearDistance& part, const GougeCheck& check, const ClearanceBody& body, int teeth,
                                                 std::span<const ClPath* const> paths, const ProofOptions& options, StageClock& clock);

/// The blank as a cylinder about the gear axis: from the underside of the mesh to the top of the stock.
[[nodiscard]] ClearanceBody clearance_body(const FaceGear& gear);

}  // namespace toothpath
