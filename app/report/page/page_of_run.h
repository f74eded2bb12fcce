// The report page of a run, filled from what the run found out.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/report/page/report_page.h"
#include "app/report/run_report.h"

namespace toothpath::page {

/// What the gear type says on the page.
struct GearOnPage {
  std::string subtitle;         ///< the gear in the words of its drawing, and the machine
  std::vector<PageTool> tools;  ///< in the job's order
};

/// @param program  text of the NC program, for the lines around the worst places; may be empty
[[nodiscard]] ReportPage page_of_run(const GearOnPage& gear, const report::RunReport& report,
                                     std::span<const path::ClPath* const> paths, std::string_view program);

}  // namespace toothpath::page
