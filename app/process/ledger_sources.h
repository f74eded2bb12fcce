// The ledger of errors, as far as it is the same for every gear: sources from the machine's joints to the words, and
// how an entry is made. Every source has the bound that was predicted and the value that was measured, um; the sum of
// the predicted bounds must cover what is measured on the cut surface: docs/proof.md.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cam/path/tool_motion.h"
#include "cam/proof/verification.h"
#include "postproc/joints/program.h"
#include "postproc/readback/reader.h"

namespace toothpath::process {

[[nodiscard]] proof::LedgerEntry entry(proof::ErrorSource source, double predicted_mm, double measured_mm,
                                       std::string note = {});

/// A source that no program shows: what the job states is predicted, nothing is measured.
/// @param missing  named as not counted where the job states nothing: the key that would
[[nodiscard]] proof::LedgerEntry stated_entry(proof::ErrorSource source, const std::optional<double>& stated_mm,
                                              std::string counted, const std::string& missing);
/// A source that is predicted by a model alone; nothing in the proof measures it.
[[nodiscard]] proof::LedgerEntry unmeasured(proof::ErrorSource source, double predicted_mm, std::string note);

/// Largest error of the tool axis from rounding the words of both rotaries, rad.
[[nodiscard]] double rotary_rounding(const joints::AxisProgram& program);

/// Axis linearisation, rounding, path blending; tool length where checks measure it.
/// @param blend_mm how far the control may round the corners of the path; 0: the dialect has no word for it
void add_machine_sources(std::vector<proof::LedgerEntry>& ledger, const joints::AxisProgram& program,
                         const std::optional<readback::ClComparison>& met, const readback::ReadBack& read,
                         double blend_mm);

/// Of a program that is safe as far as it was measured, and whose proven bound misses the limit: a larger limit, and
/// what makes the largest part of the bound smaller. Empty: the bound holds, or the tool really cuts too deep.
[[nodiscard]] std::vector<std::string> what_would_help(const std::vector<proof::LedgerEntry>& ledger,
                                                       const proof::GougeResult& gouge, double tolerance_mm);

}  // namespace toothpath::process
