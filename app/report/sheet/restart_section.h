// The part of the set-up sheet that tells where a program can be taken up again.
#pragma once

#include "app/job/job.h"
#include "app/report/run_report.h"
#include "app/report/sheet/sheet_html.h"

namespace toothpath::sheet {

/// Start and restart points, what is run first, and where each tooth begins: "tooth k, 0 to 59: line 36 + 3 k". Nothing
/// where the report has no menu.
void restart_section(Sheet& sheet, const job::Job& job, const report::RunReport& report);

/// The line of every tooth, where lines follow no rule, and its place, where the order is spread: of at most 400 teeth,
/// of larger gears of equally spaced ones. Nothing where the table says it all.
void restart_appendix(Sheet& sheet, const report::RunReport& report);

}  // namespace toothpath::sheet
