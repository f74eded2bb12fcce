// The report page of a run, filled from what the run found out.
#pragma once

#include <string_view>
#include <vector>

#include "app/job/job.h"
#include "app/report/page/report_page.h"
#include "app/report/run_report.h"

namespace toothpath::page {

/// @param program  text of the NC program, for the lines around the worst places; may be empty
[[nodiscard]] ReportPage page_of_run(const job::Job& job, const report::RunReport& report, const std::vector<path::ClPath>& paths, std::string_view program);

}  // namespace toothpath::page
