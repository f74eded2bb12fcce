// The ledger of errors of a ball-milled face gear: every source of deviation with the bound that was predicted and the
// value that was measured, um. The sum of the predicted bounds must cover what is measured on the cut surface:
// docs/proof.md.
#pragma once

#include <span>
#include <vector>

#include "app/process/program_proof.h"
#include "cam/analytic/gear_distance.h"
#include "cam/ball/plan.h"
#include "cam/cut/cut_surface.h"
#include "postproc/joints/program.h"

namespace toothpath::face {

/// A gear, what was planned for it, and what that cut.
struct MilledGear {
  const analytic::GearDistance& part;
  const ball::FaceGearPlan& plan;
  std::span<const tool::ToolAssembly> tools;
  const cut::CutSurface& surface;  ///< with the cusps and residuals found on it
};

/// The finished surface is what the last operation leaves; the others stay above it by their allowance.
/// @param blend_mm how far the control may round the corners of the path; 0: the dialect has no word for it
/// @param proof_mm how far the bound of the gouge check may lie above what it measured
[[nodiscard]] std::vector<proof::LedgerEntry> ledger(const MilledGear& milled, const joints::AxisProgram& program,
                                                     const process::ProgramProof& proof, double blend_mm,
                                                     double proof_mm);

}  // namespace toothpath::face
