// What only a bevel gear has in its reports: the finger mill in the 3D view, passes, ridge, tilt.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "app/process/bevel_proof.h"
#include "app/report/page/report_page.h"
#include "cam/finger/milling.h"

namespace toothpath::process {

/// The report page of a run or a check. `plans` may be empty (a program that somebody else wrote).
[[nodiscard]] page::ReportPage bevel_page(const job::Job& job, const bevel_gear::BevelGear& gear, const machines::Machine& machine, const report::RunReport& report,
                                    const std::vector<finger::FingerPlan>& plans, const BevelProof* proof, std::string_view program);

/// report.json with the keys that only bevel gears have: ridge_mm, tilt.lean_deg, tilt.simultaneous_axes, passes.
[[nodiscard]] std::string with_bevel_keys(const std::string& json, const bevel_gear::BevelGear& gear, const std::vector<finger::FingerPlan>& plans, const BevelProof* proof);

/// The table on the screen; the highest ridge stands among the results where there is one.
[[nodiscard]] std::string bevel_summary(const report::RunReport& report, bool color, const BevelProof* proof);

}  // namespace toothpath::process
