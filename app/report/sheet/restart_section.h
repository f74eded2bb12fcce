// The part of the set-up sheet that tells where a program can be taken up again.
#pragma once

#include "app/job/job.h"
#include "app/report/run_report.h"
#include "app/report/sheet/sheet_html.h"

namespace toothpath::sheet {

/// Start and restart points with their lines and what is active from there. Nothing where the report has no menu.
void restart_section(Sheet& sheet, const job::Job& job, const report::RunReport& report);

/// The line of every tooth, of at most 400; of larger gears of equally spaced ones. Nothing where teeth are set by
/// their number.
void restart_appendix(Sheet& sheet, const report::RunReport& report);

}  // namespace toothpath::sheet
