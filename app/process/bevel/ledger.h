// The ledger of errors of a bevel gear made with a finger mill: docs/proof.md.
#pragma once

#include <span>
#include <vector>

#include "app/process/program_proof.h"
#include "cam/finger/check.h"
#include "cam/finger/milling.h"
#include "postproc/joints/program.h"

namespace toothpath::bevel {

/// The ridge stands on the root, not on the walls: it is listed, and no part of the sum.
/// @param found    by the check of the same program
/// @param blend_mm how far the control may round the corners of the path; 0: the dialect has no word for it
[[nodiscard]] std::vector<proof::LedgerEntry> ledger(const bevel_gear::BevelGear& gear,
                                                     std::span<const finger::FingerPlan> plans,
                                                     const joints::AxisProgram& program,
                                                     const process::ProgramProof& proof,
                                                     const finger::FingerCheckResult& found, double blend_mm);

}  // namespace toothpath::bevel
