#include "app/process/bevel_run.h"

#include <algorithm>
#include <limits>

#include "app/process/bevel_files.h"
#include "app/process/bevel_page.h"
#include "app/process/bevel_proof.h"
#include "app/process/program_report.h"
#include "app/process/restart.h"
#include "app/commands/run.h"
#include "app/process/ledger.h"
#include "app/process/opening_and_end.h"
#include "app/job/file.h"
#include "app/report/cl_csv.h"
#include "app/report/sheet/length_tolerance.h"
#include "app/report/page/motion_charts.h"
#include "app/report/sheet/setup_sheet.h"
#include "cam/finger/check.h"
#include "cam/finger/milling.h"

namespace toothpath::process {
namespace {

/// What one run has made so far. Stages fill it in order.
struct BevelRun {
  const commands::RunRequest& request;
  const job::Job& job;
  app::Progress progress;
  app::StageClock clock{progress};
  std::optional<bevel_gear::BevelGear> gear;
  machines::Machine machine;
  std::vector<finger::FingerPlan> plans;
  std::vector<proof::CheckedClPath> checked;
  std::optional<PostedProgram> program;
  std::optional<joints::ProgramRestart> restart;  ///< where the program begins, if not at its beginning
  std::vector<std::vector<int>> lines;    ///< of the file, for every record of every path; restarts only
  std::optional<BevelProof> proof;
  report::RunReport report;

  BevelRun(const commands::RunRequest& r, const job::Job& j) : request(r), job(j), progress(r.quiet) {}
  [[nodiscard]] std::vector<const path::ClPath*> paths() const {
    std::vector<const path::ClPath*> out;
    for (const auto& plan : plans) out.push_back(&plan.path);
    return out;
  }
};

constexpr double kRootShare = 1;  // the flat tip of the mill faces the root: a length error reaches it in full

/// What lies on the disk.
const std::string& text_of(const PostedProgram& program) { return program.restarted ? program.restart_text : program.text; }

std::vector<Diagnostic> read_inputs(BevelRun& run) {
  if (auto errors = make_gear_and_machine(run.job, run.clock, make_bevel_gear, [&] { return load_machine(run.job); }, run.gear, run.machine); !errors.empty())
    return errors;
  if (const auto fits = check_part_on_machine(run.job, run.machine, 2 * bevel_clearance_body(*run.gear).radius_mm); !fits) return {fits.error()};
  auto restart = read_restart(run.request.restart, run.job, run.gear->parameters().teeth);
  if (!restart) return {restart.error()};
  run.restart = *restart;
  return {};
}

std::optional<Diagnostic> plan_and_check(BevelRun& run, const finger::FingerGougeCheck& check) {
  const Tolerances tolerances = proof_tolerances(run.job);
  for (std::size_t i = 0; i < run.job.operations.size(); ++i) {
    const auto& operation = run.job.operations[i];
    const auto& tool = run.job.tools[static_cast<std::size_t>(operation.tool)];
    auto plan = run.clock.run("plan", [&] { return finger::plan_finger_operation(*run.gear, tool, operation, static_cast<int>(i), tolerances); });
    if (!plan) return located(run.job, fmt::format("operation[{}]", i), plan.error());
    run.report.cl_points += plan->path.records.size();
    run.plans.push_back(std::move(plan.value()));
  }
  for (const auto& plan : run.plans) {
    auto passed = run.clock.run("gouge check", [&] { return check.approve(plan.path); });
    if (!passed) return located(run.job, fmt::format("operation[{}]", plan.path.operation), passed.error());
    run.checked.push_back(std::move(passed.value()));
  }
  return std::nullopt;
}

/// Axis program, NC text on the disk, proof of those bytes. Nothing: done, and `report.reasons` says whether it is safe.
std::optional<Diagnostic> post_and_prove(BevelRun& run, app::OutputDir& output, const finger::FingerGougeCheck& check) {
  const auto paths = run.paths();
  auto posted = post_program(run.checked, run.job, run.job.name, run.machine, run.gear->parameters().teeth, bevel_link_body(*run.gear, run.job.tools, run.machine), run.report.assumed,
                             output, run.clock, run.restart);
  if (!posted) return posted.error();
  run.program = std::move(posted.value());
  const joints::AxisProgram& axes = run.program->axes;
  note_axis_program(run.report, run.job, run.machine, paths, run.program->restarted ? *run.program->restarted : axes);
  run.report.blocks = run.program->blocks;

  BevelGearCheck bevel(run.job, run.machine, *run.gear, check);
  const std::vector<const path::ClPath*> asked = paths_to_meet(axes, paths);
  const std::string file = output.final_path(run.program->file);
  auto proof = prove_bevel_gear({run.program->text, file, run.job, run.machine},
                                {asked, axes.chord_bound_mm + axes.rounding_bound_mm + axes.pole_tip_mm, axes.axis_bound_rad}, bevel, run.clock);
  if (!proof) {
    Diagnostic error = proof.error();
    error.kind = DiagnosticKind::verification;  // our own program must be readable
    return error;
  }
  run.proof = std::move(proof.value());
  const finger::FingerCheckResult& result = run.proof->result;
  run.report.gouge = result.gouge;
  run.report.excess = result.operations;
  const bool finishes = std::any_of(run.job.operations.begin(), run.job.operations.end(),
                                    [](const path::MillingOperation& o) { return o.type == path::OperationType::finger_finishing; });
  if (finishes) run.report.finished = result.finished;
  run.report.length_tolerances = sheet::length_tolerances(run.job, run.report, paths, result.walls, {kRootShare});
  run.report.ledger = bevel_ledger(*run.gear, run.plans, axes, *run.proof, run.program->blend_mm);
  run.report.directions = directions_of(*run.gear, run.job, *run.proof);
  run.report.reasons = run.proof->reasons;
  if (run.restart)
    for (const auto& plan : run.plans) run.lines.push_back(page::lines_of_records(plan.path, run.proof->motions, run.proof->path_tolerance_mm));
  if (auto done = note_restart(run.report, *run.program, file, run.job, run.machine, bevel, run.lines, run.clock); !done)
    return done.error();
  if (!run.report.reasons.empty()) return std::nullopt;
  note_verified(run.report, run.program->file, text_of(*run.program));
  return std::nullopt;
}

/// The files for people and for other programs; the program itself is there already.
Status write_results(BevelRun& run, app::OutputDir& output, std::string& json) {
  report::RunReport& report = run.report;
  const BevelProof* proof = run.proof ? &*run.proof : nullptr;
  const auto write = [&](const std::string& name, const std::string& content) -> Status {
    report.files.push_back(name);
    return output.write(name, content);
  };
  if (report.verified) {
    if (const auto s = write_bevel_files(output, *run.gear, run.job.name, proof->result.walls, run.clock, report.files); !s) return s;
    if (const auto s = write("setup.html", sheet::setup_sheet(run.job, bevel_outline(*run.gear), run.machine, report)); !s) return s;
  }
  const auto paths = run.paths();
  if (!paths.empty())
    if (const auto s = write("cl.csv", report::cl_csv(paths)); !s) return s;
  report.stages = run.clock.seconds();
  const auto page = run.clock.run("report page", [&] {
    page::ReportPage content = bevel_page(run.job, *run.gear, run.machine, report, run.plans, proof, run.program ? std::string_view(text_of(*run.program)) : "");
    if (run.restart)
      for (std::size_t k = 0; k < run.lines.size() && k < content.paths.size(); ++k) content.paths[k].nc_lines = run.lines[k];
    return render_report_page(content);
  });
  if (!page) return page.error();
  if (const auto s = write("report.html", *page); !s) return s;
  report.files.push_back("report.json");
  report.stages = run.clock.seconds();
  json = with_bevel_keys(report::report_json(report), *run.gear, run.plans, proof);
  return output.write("report.json", json);
}

/// The end of a run whose inputs were right: verified, or not and why.
commands::CommandOutcome finish(BevelRun& run, app::OutputDir& output, const std::optional<Diagnostic>& stopped) {
  commands::CommandOutcome outcome = verdict_of(run.report, stopped, run.job.file, output);
  if (const auto written = write_results(run, output, outcome.report_json); !written) return commands::failed(located(run.job, "gear", written.error()));
  run.progress.clear();
  if (const auto committed = output.commit(); !committed) return commands::failed(committed.error());
  const BevelProof* proof = run.proof ? &*run.proof : nullptr;
  outcome.summary = bevel_summary(run.report, run.request.color, proof);
  if (proof) outcome.summary += table_of_worst(proof->result.gouge);
  return outcome;
}

}  // namespace

std::optional<job::Job> bevel_job(const std::string& job_file) {
  auto read = job::read_job_file(job_file);
  auto* job = read.value_if();
  if (!job || !job->bevel_gear()) return std::nullopt;
  return std::move(*job);
}

ValueOrErrors<bevel_gear::BevelGear> make_bevel_gear(const job::Job& job) {
  const bevel_gear::BevelGearParameters* parameters = job.bevel_gear();
  if (!parameters) return std::vector{fail_at(job.where("gear.type"), "type = \"{}\", but a bevel gear is needed here", gear_type(job))};
  std::optional<std::size_t> tool;
  for (std::size_t i = job.tools.size(); i-- > 0;)
    if (job.tools[i].type == tool::CutterType::finger_mill) tool = i;
  for (const auto& operation : job.operations)
    if (operation.type == path::OperationType::finger_finishing) tool = static_cast<std::size_t>(operation.tool);
  if (!tool) return std::vector{fail_at(job.where("tool"), "the job lacks a [[tool]] of type \"finger_mill\": it makes the flanks of this gear")};
  auto made = bevel_gear::BevelGear::make(*parameters, finger::finger_cutter_data(job.tools[*tool]));
  if (auto* gear = made.value_if()) return std::move(*gear);
  std::vector<Diagnostic> errors;
  for (auto& refusal : made.error()) {
    const std::string key = refusal.key.starts_with("tool.") ? fmt::format("tool[{}].{}", *tool, refusal.key.substr(5)) : "gear." + refusal.key;
    errors.push_back(located(job, key, std::move(refusal.diagnostic)));
  }
  return errors;
}

commands::CommandOutcome run_bevel_job(const commands::RunRequest& request, const job::Job& job, app::OutputDir& output) {
  BevelRun run(request, job);
  if (auto errors = read_inputs(run); !errors.empty()) {
    run.progress.clear();
    return commands::failed(std::move(errors));
  }
  if (const auto aside = output.set_aside(); !aside) return commands::failed(aside.error());
  run.report = report_of("run", job, run.machine, run.gear->warnings());
  const finger::FingerGougeCheck check(*run.gear, job.tools, job.operations, proof_tolerances(job));
  auto stopped = plan_and_check(run, check);
  if (!stopped) stopped = post_and_prove(run, output, check);
  if (stopped && stopped->kind != DiagnosticKind::verification) {
    run.progress.clear();
    return commands::failed(std::move(*stopped));
  }
  return finish(run, output, stopped);
}

}  // namespace toothpath::process
