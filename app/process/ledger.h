// The ledger of errors: every source of deviation with the bound that was predicted and the value that was measured, um. The sum of
// the predicted bounds must cover what is measured on the cut surface: docs/proof.md.
#pragma once

#include <span>
#include <vector>

#include "app/process/bevel_proof.h"
#include "app/process/proof.h"
#include "cam/finger/milling.h"
#include "cam/ball/plan.h"
#include "postproc/joints/program.h"

namespace toothpath::process {

/// Of a ball-milled face gear. The finished surface is what the last operation leaves; the others stay above it by their allowance.
/// @param blend_mm how far the control may round the corners of the path; 0: the dialect has no word for it
/// @param proof_mm how far the bound of the gouge check may lie above what it measured
[[nodiscard]] std::vector<proof::LedgerEntry> face_gear_ledger(const analytic::GearDistance& part, const ball::FaceGearPlan& plan, std::span<const tool::ToolAssembly> tools,
                                                        const joints::AxisProgram& program, const FaceGearProof& proof, double blend_mm, double proof_mm);

/// Of a bevel gear made with a finger mill. The ridge stands on the root, not on the walls: it is listed, and no part of the sum.
[[nodiscard]] std::vector<proof::LedgerEntry> bevel_ledger(const bevel_gear::BevelGear& gear, std::span<const finger::FingerPlan> plans, const joints::AxisProgram& program,
                                                    const BevelProof& proof, double blend_mm);

/// Sum of the predicted bounds of the sources that add up on the finished flanks, um.
[[nodiscard]] double predicted_sum_um(std::span<const proof::LedgerEntry> ledger);

}  // namespace toothpath::process
