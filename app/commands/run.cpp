#include "app/commands/run.h"

#include <algorithm>
#include <limits>

#include "app/process/bevel_run.h"
#include "app/process/ledger.h"
#include "app/process/opening_and_end.h"
#include "app/process/program_report.h"
#include "app/process/proof.h"
#include "app/process/restart.h"
#include "app/process/surface_files.h"
#include "app/process/contact_analysis.h"
#include "app/process/gear_of_job.h"
#include "app/job/file.h"
#include "app/job/measured_file.h"
#include "app/report/cl_csv.h"
#include "app/report/page/contact_figures.h"
#include "app/report/deviation_vtp.h"
#include "app/report/sheet/length_tolerance.h"
#include "app/report/limits/chart.h"
#include "app/report/page/motion_charts.h"
#include "app/report/page/page_of_run.h"
#include "app/report/sheet/setup_sheet.h"
#include "cam/ball/plan.h"
#include "geometry/base/tolerances.h"
#include "postproc/joints/pole.h"
#include "postproc/text/writer.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kRunOutputs = {"program.",       "cl.csv",         "report.json", "report.html", "setup.html", "gear.stl",     "tooth.vtp",
                                           "inspection.csv", "inspection.dmi", "limits.json", "limits.html", "limits.svg", "limits_0.svg", "limits_1.svg",
                                           "correction.json"};

/// What one run has made so far. Stages fill it in order.
struct Run {
  const RunRequest& request;
  app::Progress progress;
  app::StageClock clock{progress};
  job::Job job;
  std::optional<face_gear::FaceGear> gear;                 ///< with the flanks to aim at
  std::optional<job::CorrectedGear> correction;      ///< where they answer measured files
  machines::Machine machine;
  std::optional<joints::ProgramRestart> restart;        ///< where the program begins, if not at its beginning
  ball::FaceGearPlan plan;
  std::vector<proof::CheckedClPath> checked;
  report::RunReport report;
  double proof_mm = 0;  ///< how far the bound of the gouge check may lie above what it measured
  analytic::CutSurfaceOptions cut_surface;  ///< grid on which the cut surface is measured
  std::vector<proof::SurfaceGrid> surface;
  std::string program_text;  ///< as read back from the disk
  std::vector<svg::LineChart> motion;        ///< axes over time, for the page
  std::vector<std::vector<int>> lines;  ///< of the program, for every record of every path

  explicit Run(const RunRequest& r) : request(r), progress(r.quiet) {}
  [[nodiscard]] ball::PlanOptions plan_options() const {
    ball::PlanOptions options;
    if (job.verify.clearance_mm) options.clearance_mm = *job.verify.clearance_mm;
    options.gouge_tolerance_mm = job.verify.gouge_tolerance_mm;
    // `tilt` keeps what it asks between two records, too, where the axis dips by less than this margin.
    if (machine.post.pole == machines::PoleOption::tilt)
      options.least_tilt_rad = std::max(options.least_tilt_rad, machine.post.pole_angle_rad.value_or(joints::kLeastPoleTilt) + 1e-3);
    return options;
  }
  [[nodiscard]] std::vector<const path::ClPath*> paths() const {
    std::vector<const path::ClPath*> result;
    for (const auto& path : plan.paths) result.push_back(&path);
    return result;
  }
};

/// Gear and machine of the job with everything that is wrong with them.
std::vector<Diagnostic> prepare(Run& run) {
  const auto load = [&] { return process::load_machine(run.job, run.gear ? std::optional(2 * run.gear->outer_radius()) : std::nullopt); };
  if (auto errors = process::make_gear_and_machine(run.job, run.clock, process::make_face_gear, load, run.gear, run.machine); !errors.empty()) return errors;
  if (!run.request.measured_files.empty()) {
    auto corrected = run.clock.run("correction", [&] { return job::correct_gear(*run.gear, run.request.measured_files); });
    if (!corrected) return {corrected.error()};
    run.correction = std::move(*corrected);
    run.gear = run.correction->gear;
  }
  return {};
}

/// Job, gear and machine with everything that is wrong with them.
std::vector<Diagnostic> read_inputs(Run& run) {
  auto read = run.clock.run("job", [&] { return job::read_job_file(run.request.job_file); });
  if (auto* errors = read.refused()) return std::move(*errors);
  run.job = std::move(read).value();
  if (auto errors = prepare(run); !errors.empty()) return errors;
  auto restart = process::read_restart(run.request.restart, run.job, run.gear->parameters().teeth);
  if (!restart) return {restart.error()};
  run.restart = *restart;
  return {};
}

void begin_report(Run& run) {
  run.report = process::report_of(run.correction ? "correct" : "run", run.job, run.machine, run.gear->warnings());
  report::RunReport& report = run.report;
  if (!run.correction) return;
  double most = 0;
  for (const auto& f : run.correction->fit.flanks) {
    report.correction.push_back({f.zone, f.side, f.residual});
    most = std::max(most, f.residual.measured_max_mm);
  }
  report.warnings.push_back(fmt::format("the flanks to cut answer measured deviations of up to {:.2f} um (correction.json): gouge and left material are "
                                        "counted from them, not from the nominal flanks", most * 1000));
}

/// Plans every operation and lets the gouge check pass each path. Nothing: done.
std::optional<Diagnostic> plan_and_check(Run& run, const analytic::GearDistance& part, const analytic::GougeCheck& check) {
  ball::PlanOptions plan_options = run.plan_options();
  plan_options.stage = [&](const std::string& name, const std::function<void()>& work) { run.clock.run(name, work); };
  auto planned = run.clock.run("plan", [&] {
    return plan_face_gear(part, run.job.tools, run.job.operations, plan_options, [&](const std::string& text) { run.progress.show(text); });
  });
  if (auto* refusal = planned.refused()) return process::located(run.job, refusal->key, std::move(refusal->diagnostic));
  run.plan = std::move(planned.value());
  run.report.directions = run.plan.directions;
  for (const path::ClPath& path : run.plan.paths) run.report.cl_points += path.records.size();
  for (const path::ClPath& path : run.plan.paths) {
    auto passed = run.clock.run("gouge check", [&] { return check.check_path(path); });
    if (!passed) return process::located(run.job, fmt::format("operation[{}]", path.operation), passed.error());
    run.checked.push_back(std::move(passed.value()));
  }
  return std::nullopt;
}

/// Axis program, NC text on the disk, proof of those bytes. Nothing: done, and `report.reasons` says whether it is safe.
std::optional<Diagnostic> post_and_prove(Run& run, app::OutputDir& output, const analytic::GearDistance& part, const analytic::GougeCheck& check) {
  const joints::ClearanceBody body = process::clearance_body(*run.gear);
  const int teeth = run.gear->parameters().teeth;
  const auto paths = run.paths();
  auto posted = process::post_program(run.checked, run.job, run.job.name + (run.correction ? ", corrected" : ""), run.machine, teeth, body, run.report.assumed, output, run.clock,
                             run.restart);
  if (!posted) return posted.error();
  const joints::AxisProgram& program = posted->axes;
  process::note_axis_program(run.report, run.job, run.machine, paths, posted->restarted ? *posted->restarted : program);
  run.report.blocks = posted->blocks;

  process::FaceGearCheck face(run.job, run.machine, part, check, run.cut_surface);
  const std::vector<const path::ClPath*> asked = process::paths_to_meet(program, paths);
  const std::string file = output.final_path(posted->file);
  auto proof = process::prove_face_gear({posted->text, file, run.job, run.machine},
                               {asked, program.chord_bound_mm + program.rounding_bound_mm + program.pole_tip_mm, program.axis_bound_rad}, face, run.clock);
  if (!proof) {
    Diagnostic error = proof.error();
    error.kind = DiagnosticKind::verification;  // our own program must be readable
    return error;
  }
  run.report.gouge = proof->gouge;
  run.report.excess = proof->surface.operations;
  run.report.finished = proof->surface.finished;
  run.report.unreached = proof->surface.unreached;
  if (proof->surface.scallop.requested_mm > 0) run.report.scallop = proof->surface.scallop;
  run.surface = std::move(proof->surface.grids);
  run.motion = page::motion_charts(proof->read, proof->motions, run.machine);
  for (const path::ClPath& path : run.plan.paths) run.lines.push_back(page::lines_of_records(path, proof->motions, proof->path_tolerance_mm));
  run.report.reasons = proof->reasons;
  run.report.length_tolerances = sheet::length_tolerances(run.job, run.report, paths, run.surface, {});
  if (auto done = process::note_restart(run.report, *posted, file, run.job, run.machine, face, run.lines, run.clock); !done) return done.error();
  run.program_text = std::move(posted->restarted ? posted->restart_text : posted->text);
  run.report.ledger = process::face_gear_ledger(part, run.plan, run.job.tools, program, *proof, posted->blend_mm, run.proof_mm);
  if (!run.report.reasons.empty()) return std::nullopt;
  process::note_verified(run.report, posted->file, run.program_text);
  return std::nullopt;
}

/// From the prepared inputs to the proof. Nothing: done. A diagnostic of kind verification: the job is right, its program is not safe.
std::optional<Diagnostic> plan_post_and_prove(Run& run, app::OutputDir& output, double proof_mm) {
  begin_report(run);
  const analytic::GearDistance part = run.clock.run("distance index", [&] { return analytic::GearDistance(*run.gear, ball::reach_of(run.job.tools)); });
  analytic::GougeCheckOptions options;
  options.gouge_tolerance_mm = run.job.verify.gouge_tolerance_mm;
  options.proof_mm = run.proof_mm = std::min(proof_mm, 0.1 * run.job.verify.gouge_tolerance_mm);
  options.clearance_mm = run.plan_options().clearance_mm;
  options.rapid_height_mm = run.gear->blank_top();
  const analytic::GougeCheck check(part, run.job.tools, options);
  if (auto stopped = plan_and_check(run, part, check)) return stopped;
  return post_and_prove(run, output, part, check);
}

/// Contact with the pinion, for jobs that ask for it with [contact]: the exact flanks and those that the program cuts. Empty otherwise,
/// and where the pinion cannot run (then the report warns).
std::string contact_of(Run& run) {
  if (!run.job.contact) return {};
  process::CutFlanks cut;
  cut.route = "milled";
  cut.flanks = process::flanks_of(run.surface);
  auto analysed = process::analyse_contact(run.job, *run.gear, *run.job.contact, cut.flanks.empty() ? nullptr : &cut);
  if (const auto* errors = analysed.refused()) {
    run.report.warnings.push_back("no contact analysis: " + errors->front().message);
    return {};
  }
  auto& analysis = analysed.value();
  if (!analysis.route.empty())
    analysis.notes.emplace_back("The cut surface is taken from the report's grid, which does not resolve every cusp: for its transmission error run "
                                "`toothpath contact --as-cut`.");
  return page::contact_section_body(analysis);
}

/// What the report page shows of the run as far as it got.
page::ReportPage page_content(Run& run) {
  const std::string contact = contact_of(run);  // first: it may add a warning
  page::ReportPage page = page::page_of_run(run.job, run.report, run.plan.paths, run.program_text);
  page.surface = run.surface;
  page.contact = contact;
  page.gear_limits = limits::limit_charts(*run.gear);
  page.motion = run.motion;
  for (std::size_t k = 0; k < run.lines.size(); ++k) page.paths[k].nc_lines = run.lines[k];
  return page;
}

/// The files for people and for other programs; the program itself is there already.
Status write_results(Run& run, app::OutputDir& output, std::string& json) {
  report::RunReport& report = run.report;
  const auto write = [&](const std::string& name, const std::string& content) -> Status {
    report.files.push_back(name);
    return output.write(name, content);
  };
  if (run.correction)
    if (const auto s = write("correction.json", job::correction_json(run.correction->fit, run.correction->measurements)); !s) return s;
  if (report.verified) {
    if (const auto s = process::write_surface_files(output, *run.gear, run.job.name, run.clock, report.files, report.assumed); !s) return s;
    const auto vtp = report::deviation_vtp(run.surface);
    if (!vtp) return vtp.error();
    if (const auto s = output.write("tooth.vtp", *vtp); !s) return s;  // with the deviation, instead of the plain one
    if (const auto s = write("setup.html", sheet::setup_sheet(run.job, *run.gear, run.machine, report)); !s) return s;
  }
  const auto paths = run.paths();
  if (!paths.empty())
    if (const auto s = write("cl.csv", report::cl_csv(paths)); !s) return s;
  report.stages = run.clock.seconds();
  const auto page = run.clock.run("report page", [&] { return page::render_report_page(page_content(run)); });
  if (!page) return page.error();
  if (const auto s = write("report.html", *page); !s) return s;
  report.files.push_back("report.json");
  report.stages = run.clock.seconds();
  json = report::report_json(report);
  return output.write("report.json", json);
}

/// The end of a run whose inputs were right: verified, or not and why.
CommandOutcome finish(Run& run, app::OutputDir& output, const std::optional<Diagnostic>& stopped) {
  CommandOutcome outcome = process::verdict_of(run.report, stopped, run.job.file, output);
  if (const auto written = write_results(run, output, outcome.report_json); !written) return failed(process::located(run.job, "gear", written.error()));
  run.progress.clear();
  if (const auto committed = output.commit(); !committed) return failed(committed.error());
  outcome.summary = report::summary_table(run.report, run.request.color);
  return outcome;
}

}  // namespace

CommandOutcome run_job(const RunRequest& request) {
  std::vector<std::string> inputs = request.measured_files;
  inputs.push_back(request.job_file);
  auto output = app::OutputDir::open(request.out_dir, kRunOutputs, inputs, app::kPrevious);
  if (!output) return failed(output.error());
  if (const auto bevel = process::bevel_job(request.job_file); bevel && request.measured_files.empty()) return process::run_bevel_job(request, *bevel, *output);
  Run run(request);
  if (auto errors = read_inputs(run); !errors.empty()) {
    run.progress.clear();
    return failed(std::move(errors));
  }
  if (const auto aside = output->set_aside(); !aside) return failed(aside.error());
  const auto stopped = plan_post_and_prove(run, *output, analytic::GougeCheckOptions{}.proof_mm);
  if (stopped && stopped->kind != DiagnosticKind::verification) {
    run.progress.clear();
    return failed(*stopped);
  }
  return finish(run, *output, stopped);
}

StagesOutcome run_stages(const job::Job& job, double proof_mm, app::OutputDir& scratch, bool quiet, const analytic::CutSurfaceOptions& grid, bool with_page) {
  RunRequest request;
  request.quiet = quiet;
  Run run(request);
  run.job = job;
  run.cut_surface = grid;
  StagesOutcome outcome;
  outcome.errors = prepare(run);
  if (!outcome.errors.empty()) return outcome;
  if (const auto stopped = plan_post_and_prove(run, scratch, proof_mm)) {
    if (stopped->kind != DiagnosticKind::verification) outcome.errors.push_back(*stopped);
    run.report.reasons.push_back(stopped->message);
    run.report.verified = false;
  }
  process::discard_program(scratch);
  run.report.stages = run.clock.seconds();
  if (with_page) {
    outcome.page = page_content(run);
    outcome.page->nc_file.clear();  // dropped: the listing on the page is what stays of it
  }
  run.progress.clear();
  outcome.report = std::move(run.report);
  outcome.surface = std::move(run.surface);
  return outcome;
}

void add_run(Commands& commands) {
  commands.push_back(command_of<RunRequest>(
      "run", "the whole way from the job to a proven NC program",
      [](OptionSet& set, RunRequest& request) {
        job_options(set, request);
        set.text("--restart", request.restart, "operation and tooth, both from 0: the program begins there; what comes before is taken as done", "OP:TOOTH");
      },
      run_job));
}

}  // namespace toothpath::commands
