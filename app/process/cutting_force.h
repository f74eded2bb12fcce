// Force and deflection of every operation of a job, on any gear: an estimate beside the proof. docs/force.md.
#pragma once

#include "app/job/job.h"
#include "app/report/run_report.h"

namespace toothpath::process {

/// Every operation of the report gets its load, the run a warning for each slender tool and for chips and engagements
/// beyond those asked for, and the ledger the row of the operation that finishes. @param report has its operations and
/// the rest of its ledger
void note_cutting_forces(report::RunReport& report, const job::Job& job);

}  // namespace toothpath::process
