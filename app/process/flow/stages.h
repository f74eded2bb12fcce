// The stages of a run, for every gear: gear and machine, plan, gouge check, axis program, NC text, read back from the
// disk, proof.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/base/output_dir.h"
#include "app/base/stage_clock.h"
#include "app/job/job.h"
#include "app/job/measured_file.h"
#include "app/process/gear_process.h"
#include "app/report/page/report_page.h"
#include "app/report/run_report.h"
#include "machines/machine.h"
#include "postproc/joints/program.h"

namespace toothpath::flow {

/// What a run is asked beside its job.
struct RunAsked {
  std::string restart;          ///< "OP:TOOTH", both from 0; empty: from the beginning
  job::MeasuredInput measured;  ///< what the flanks answer
};

/// The gear of a job, with the flanks to aim at.
struct GearToCut {
  std::unique_ptr<process::GearProcess> process;
  std::optional<process::Correction> correction;  ///< where the flanks answer measured files
};
/// Stages "gear" and "correction". Refused: what the gear and the files refuse, each with its place.
[[nodiscard]] process::ValueOrErrors<GearToCut> make_gear(const job::Job& job, const job::MeasuredInput& measured,
                                                          app::StageClock& clock);

/// Plans every operation; one of the job whose way is left open (`best_way`) becomes what the plan took. Refused: what
/// the plan refuses.
[[nodiscard]] Status plan_job(job::Job& job, process::GearMilling& milling, app::StageClock& clock,
                              app::Progress& progress);

/// What one run has made so far. Stages fill it in order.
struct Run {
  app::Progress progress;
  app::StageClock clock{progress};
  job::Job job;
  GearToCut gear;
  machines::Machine machine;
  std::optional<joints::ProgramRestart> restart;  ///< where the program begins, if not at its beginning
  std::unique_ptr<process::GearMilling> milling;
  std::vector<proof::CheckedClPath> checked;
  report::RunReport report;
  std::vector<proof::SurfaceGrid> surface;          ///< as it was cut
  std::string program_text;                         ///< as read back from the disk
  std::vector<svg::LineChart> motion;               ///< axes over time, for the page
  std::optional<page::MachineScene> machine_scene;  ///< the gear on its machine, for the page
  std::vector<std::vector<int>> lines;              ///< of the program, for every record of every path
  double path_off_mm = 0;                           ///< proven: the program is no farther from the paths

  explicit Run(bool quiet) : progress(quiet) {}
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;
  [[nodiscard]] std::vector<const path::ClPath*> paths() const {
    return milling ? milling->paths() : std::vector<const path::ClPath*>();
  }
};

/// Gear, machine and restart of `run.job`. Gear and machine are both tried: all that is wrong with either, each with
/// its place. A job without operations is refused.
[[nodiscard]] std::vector<Diagnostic> prepare(Run& run, const RunAsked& asked);

/// From the prepared inputs to the proof. Nothing: done, and `report.reasons` says whether the program is safe. A
/// diagnostic of kind verification: the job is right, its program is not safe.
[[nodiscard]] std::optional<Diagnostic> plan_post_and_prove(Run& run, app::OutputDir& output,
                                                            const proof::ProofLimits& limits,
                                                            const process::FlankGrid& grid = {});

/// What the report page shows of the run as far as it got.
[[nodiscard]] page::ReportPage page_content(Run& run);

/// What the stages of a run found out about a job.
struct StagesOutcome {
  report::RunReport report;        ///< with its stages' seconds; `reasons` says why the program is not verified
  std::vector<Diagnostic> errors;  ///< the job, gear or machine is refused: the report is not filled in
  std::vector<proof::SurfaceGrid>
      surface;                           ///< the cut surface of tooth space 0; empty where the run did not get so far
  std::optional<page::ReportPage> page;  ///< what report.html of this run shows; only when asked for
};

/// The stages of `run` on a job that has been read (and perhaps changed): the same code, without the files for people.
/// The program goes through a temporary file of `scratch`, as in a run, and is dropped afterwards.
/// @param grid     on which the flanks of the cut surface are measured
/// @param with_page whether the content of the report page is handed back, too (it holds a second copy of paths and
/// surface)
[[nodiscard]] StagesOutcome run_stages(const job::Job& job, const proof::ProofLimits& limits, app::OutputDir& scratch,
                                       bool quiet, const process::FlankGrid& grid = {}, bool with_page = false);

}  // namespace toothpath::flow
