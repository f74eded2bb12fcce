// `toothpath run`: from the job to a proven NC program and everything that goes with it.
#pragma once

#include "app/commands/command.h"
#include "app/job/job.h"
#include "app/base/output_dir.h"
#include "app/report/page/report_page.h"
#include "app/report/run_report.h"
#include "cam/analytic/cut_surface.h"

namespace toothpath::commands {

/// Of `run` and `correct`.
struct RunRequest : JobRequest {
  std::string restart;                      ///< "OP:TOOTH", both from 0; empty: from the beginning
  std::vector<std::string> measured_files;  ///< measured deviations that the flanks answer, in the order of the cuts
};

/// Gear, plan, gouge check, axis program, NC text, read back from the disk, proof, report. A program that is not proven is not
/// left in the directory; the report is, and says why.
[[nodiscard]] CommandOutcome run_job(const RunRequest& request);

/// What the stages of a run found out about a face gear job.
struct StagesOutcome {
  report::RunReport report;                ///< with its stages' seconds; `reasons` says why the program is not verified
  std::vector<Diagnostic> errors;  ///< the job, gear or machine is refused: the report is not filled in
  std::vector<proof::SurfaceGrid> surface;  ///< the cut surface of tooth space 0; empty where the run did not get so far
  std::optional<page::ReportPage> page;    ///< what report.html of this run shows; only when asked for
};

/// The stages of `run` on a job that has been read (and perhaps changed): the same code, without the files for people. The program
/// goes through a temporary file of `scratch`, as in a run, and is dropped afterwards.
/// @param proof_mm how far the bound of a move may lie above what was measured at its ends (GougeCheckOptions)
/// @param grid     rows and columns of the grid on which the cut surface is measured
/// @param with_page whether the content of the report page is handed back, too (it holds a second copy of paths and surface)
[[nodiscard]] StagesOutcome run_stages(const job::Job& job, double proof_mm, app::OutputDir& scratch, bool quiet, const analytic::CutSurfaceOptions& grid = {},
                                       bool with_page = false);

}  // namespace toothpath::commands
