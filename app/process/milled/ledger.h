// The ledger of errors of a ball-milled gear: every source of deviation with the bound that was predicted and the
// value that was measured, um. The sum of the predicted bounds must cover what is measured on the cut surface:
// docs/proof.md.
#pragma once

#include <span>
#include <vector>

#include "app/process/program_proof.h"
#include "cam/analytic/gear_distance.h"
#include "cam/cut/cut_surface.h"
#include "cam/plan/milling.h"
#include "postproc/joints/program.h"

namespace toothpath::milled {

/// A gear, what was planned for it, and what that cut.
struct MilledGear {
  const analytic::GearDistance& part;
  const plan::MillingPlan& plan;
  std::span<const tool::ToolAssembly> tools;
  const std::vector<path::MillingOperation>& operations;
  const cut::CutSurface& surface;  ///< with the cusps and residuals found on it
};

struct LedgerTerms {
  double blend_mm = 0;  ///< how far the control may round the corners of the path; 0: the dialect has no word for it
  double proof_mm = 0;  ///< how far the bound of the gouge check may lie above what it measured
  double bias_mm = 0;   ///< gap that line poses keep
  const joints::Setup& setup;
};

/// The finished surface is what the finishing operations leave; the others stay above it by their allowance.
[[nodiscard]] std::vector<proof::LedgerEntry> ledger(const MilledGear& milled, const joints::AxisProgram& program,
                                                     const process::ProgramProof& proof, const LedgerTerms& terms);

}  // namespace toothpath::milled
