// The report page of a run, filled from what the run found out.
#pragma once

#include <string_view>
#include <vector>

#include "app/job.h"
#include "app/report/report_page.h"
#include "app/report/run_report.h"

namespace toothpath {

/// @param program  text of the NC program, for the lines around the worst places; may be empty
[[nodiscard]] ReportPage page_of_run(const Job& job, const RunReport& report, const std::vector<ClPath>& paths, std::string_view program);

}  // namespace toothpath
