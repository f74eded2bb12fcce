// What only a bevel gear has in its reports: the finger mill in the 3D view, passes, ridge, tilt.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/commands/bevel_proof.h"
#include "app/report/report_page.h"
#include "cam/finger_milling.h"

namespace toothpath {

/// The report page of a run or a check. `plans` may be empty (a program that somebody else wrote).
[[nodiscard]] ReportPage bevel_page(const Job& job, const BevelGear& gear, const Machine& machine, const RunReport& report,
                                    const std::vector<FingerPlan>& plans, const BevelProof* proof, std::string_view program);

/// report.json with the keys that only bevel gears have: ridge_mm, tilt.lean_deg, tilt.simultaneous_axes, passes.
[[nodiscard]] std::string with_bevel_keys(const std::string& json, const BevelGear& gear, const std::vector<FingerPlan>& plans, const BevelProof* proof);

/// The table on the screen; the highest ridge stands among the results where there is one.
[[nodiscard]] std::string bevel_summary(const RunReport& report, bool color, const BevelProof* proof);

}  // namespace toothpath
