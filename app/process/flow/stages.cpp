#include "app/process/flow/stages.h"

#include <algorithm>

#include "app/process/cutting_force.h"
#include "app/process/flow/contour.h"
#include "app/process/flow/graphics_blank.h"
#include "app/process/flow/machine_moves.h"
#include "app/process/flow/machine_picture.h"
#include "app/process/flow/parts.h"
#include "app/process/flow/registry.h"
#include "app/process/flow/restart.h"
#include "app/process/least_values.h"
#include "app/process/ledger_sources.h"
#include "app/process/program_report.h"
#include "app/process/proof_limits.h"
#include "app/report/page/motion_charts.h"
#include "app/report/page/page_of_run.h"
#include "app/report/sections/sections.h"
#include "app/report/sheet/length_tolerance.h"

namespace toothpath::flow {
namespace {

void begin_report(Run& run) {
  run.report = process::report_of(run.gear.correction ? "correct" : "run", run.job, run.machine,
                                  run.gear.process->part().warnings);
  report::RunReport& report = run.report;
  report.modified = run.gear.process->part().modified;
  if (auto coarse = process::coarse_words(run.job, run.machine, 0.5 * run.gear.process->part().diameter_mm))
    report.warnings.push_back(std::move(*coarse));
  if (!run.gear.correction) return;
  report.correction = run.gear.correction->rows;
  report.index = run.gear.correction->index;
  report.warnings.insert(report.warnings.end(), run.gear.correction->warnings.begin(),
                         run.gear.correction->warnings.end());
  double most = 0;
  for (const auto& row : report.correction) most = std::max(most, row.fit.measured_max_mm);
  report.warnings.push_back(
      fmt::format("the flanks to cut answer measured deviations of up to {:.2f} um (correction.json): gouge and left "
                  "material are counted from them, not from the nominal flanks",
                  most * 1000));
}

/// A refusal of flanks that are compensated for a measurement: where the nominal ones are planned, the measurement is
/// the cause.
Diagnostic with_measurement(Run& run, const proof::ProofLimits& limits, const process::FlankGrid& grid,
                            Diagnostic refused) {
  if (!run.gear.correction || refused.kind != DiagnosticKind::refused_input) return refused;
  auto nominal = make_process(run.job);
  if (nominal.refused()) return refused;
  const auto milling = nominal.value()->milling(run.machine, limits, grid, run.clock);
  if (!milling->plan(run.clock, run.progress)) return refused;
  std::string files;
  double most = 0, scatter = 0;
  for (const auto& row : run.gear.correction->rows) {
    if (files.find(row.file) == std::string::npos) files += (files.empty() ? "" : ", ") + row.file;
    most = std::max(most, row.fit.measured_max_mm);
    scatter = std::max(scatter, row.fit.residual_rms_mm);
  }
  refused.message = fmt::format(
      "{}: the flanks compensated for it cannot be cut, the nominal ones can: it deviates by up to {:.2f} um, a "
      "scatter of "
      "{:.2f} um (rms) left out. Where that is the measurement, measure again; where it is the gear, let the ring "
      "begin "
      "farther from the undercut. In detail: {}",
      files, most * 1000, scatter * 1000, refused.message);
  return refused;
}

/// Plans every operation and lets the gouge check pass each path. Nothing: done.
std::optional<Diagnostic> plan_and_check(Run& run) {
  const Status planned = plan_job(run.job, *run.milling, run.clock, run.progress);
  const auto paths = run.paths();
  run.report.directions = run.milling->directions();
  run.report.passes = run.milling->passes();
  run.report.flank_ways = run.milling->flank_ways();
  run.report.engagement = run.milling->engagement();
  for (std::string& text : run.milling->advice()) run.report.warnings.push_back(std::move(text));
  for (const path::ClPath* path : paths) run.report.cl_points += path->records.size();
  if (!planned) return planned.error();
  for (const path::ClPath* path : paths) {
    auto passed = run.clock.run("gouge check", [&] { return run.milling->approve(*path); });
    if (!passed) return process::located(run.job, fmt::format("operation[{}]", path->operation), passed.error());
    run.checked.push_back(std::move(passed.value()));
  }
  return std::nullopt;
}

/// What the proof found goes to the report; what the files need later is kept.
void keep_proof(Run& run, const proof::ProofLimits& limits, process::ProgramProof& proof,
                const std::vector<const path::ClPath*>& paths, page::SceneStates states) {
  process::note_proof(run.report, proof);
  run.surface = std::move(proof.surface);
  run.motion = page::motion_charts(proof.read, proof.motions, run.machine);
  run.machine_scene = machine_picture(run.job, run.machine, *run.gear.process, std::move(states), nullptr);
  run.path_off_mm = proof.path_tolerance_mm;
  for (const path::ClPath* path : paths)
    run.lines.push_back(page::lines_of_records(*path, proof.motions, proof.path_tolerance_mm));
  run.report.length_tolerances =
      sheet::length_tolerances(run.job, limits, run.report, paths, run.surface, run.milling->beside_the_grid());
}

/// A program that was written and what the proof of its bytes says.
struct Attempt {
  process::PostedProgram posted;
  process::ProgramProof proof;
  page::SceneStates states;
};

bool leaves_allowance(const job::Job& job) {
  return std::any_of(job.operations.begin(), job.operations.end(),
                     [](const path::MillingOperation& operation) { return operation.allowance_mm > 0; });
}

/// The posts and proofs of one run.
class Attempts {
 public:
  Attempts(Run& run, const proof::ProofLimits& limits, app::OutputDir& output)
      : run_(run),
        limits_(limits),
        output_(output),
        request_{run.job,
                 run.job.name + (run.gear.correction ? ", corrected" : "") +
                     (run.job.setup->measured_file.empty() ? "" : ", as measured"),
                 run.machine,
                 run.gear.process->part().teeth,
                 run.gear.process->link_body(run.machine),
                 run.restart} {
    request_.blank = graphics_blank(*run.gear.process, *run.job.setup);
    request_.contour_mm = run.job.program.contour_tolerance_mm;
  }

  /// Axis program, NC text on the disk, proof of those bytes, with this contour tolerance.
  Result<Attempt> make(const std::optional<double>& contour_mm, bool wide_roughing = false) {
    request_.contour_mm = contour_mm;
    request_.wide_roughing = wide_roughing;
    auto posted = process::post_program(run_.checked, request_, run_.report.assumed, output_, run_.clock);
    if (!posted) return posted.error();
    auto bodies = bodies_in_machine(run_.job, run_.machine, *run_.gear.process, nullptr);
    if (!bodies) return bodies.error();
    bodies::MovesJudge moves = judge_of(run_.machine, std::move(*bodies), run_.job, limits_.clearance_mm);
    page::StateRecorder states = recorder_of(run_.job, request_.teeth);
    const joints::AxisProgram& program = posted->axes;
    const std::string file = output_.final_path(posted->file);
    const std::vector<const path::ClPath*> asked = process::paths_to_meet(program, run_.paths());
    const process::ProgramText whole{posted->text,  file,
                                     run_.job,      run_.machine,
                                     &moves,        [&](const readback::ExecutedMove& move) { states.add(move); },
                                     request_.blank};
    auto proof =
        process::prove_program(whole,
                               {asked, program.chord_bound_mm + program.rounding_bound_mm + program.pole_tip_mm,
                                program.axis_bound_rad + process::rotary_rounding(program)},
                               run_.milling->check(), run_.clock);
    if (!proof) {
      Diagnostic error = proof.error();
      error.kind = DiagnosticKind::verification;  // our own program must be readable
      return error;
    }
    auto told = states.finish(proof->read);
    return Attempt{std::move(*posted), std::move(*proof), std::move(told)};
  }

  /// What the job asks for, or what is left of the tolerance: the text that takes the least time.
  Result<Attempt> best() {
    const auto asked = run_.job.program.contour_tolerance_mm;
    std::optional<double> granted;
    {
      auto narrow = make(asked);
      if (!narrow || asked || !narrow->proof.reasons.empty()) return narrow;
      granted = contour_to_grant(request_, narrow->posted, limits_.gouge_mm - narrow->proof.gouge.bound_mm);
      if (!granted) return narrow;
    }
    const auto holds = [](const Result<Attempt>& made) { return made && made->proof.reasons.empty(); };
    if (leaves_allowance(run_.job))
      if (auto wide = make(granted, true); holds(wide)) return wide;
    if (auto wide = make(granted); holds(wide)) return wide;
    return make(std::nullopt);
  }
  /// Why the tolerance of the job is too wide; nothing: it is not.
  [[nodiscard]] std::optional<Diagnostic> refusal(const Attempt& made) const {
    const double over = made.proof.gouge.bound_mm - limits_.gouge_mm;
    if (!run_.job.program.contour_tolerance_mm || !(over > 0)) return std::nullopt;
    return contour_refusal(request_, made.posted, over);
  }

 private:
  Run& run_;
  const proof::ProofLimits& limits_;
  app::OutputDir& output_;
  process::PostRequest request_;
};

/// The programs that hold a part each, where the job asks for them.
Status prove_parts(Run& run, const proof::ProofLimits& limits, const process::PostedProgram& posted,
                   const process::ProgramText& whole) {
  if (posted.parts.empty()) return Ok{};
  const auto bodies = bodies_in_machine(run.job, run.machine, *run.gear.process, nullptr);
  if (!bodies) return bodies.error();
  const auto judge = [&] { return judge_of(run.machine, *bodies, run.job, limits.clearance_mm); };
  return note_parts(run.report, posted, whole, run.milling->check(), judge, run.clock);
}

/// The refusal of a number for which the words of this machine are too coarse, where no other reason stands. Nothing:
/// one does, or none is short.
std::optional<Diagnostic> too_fine(const Run& run, const joints::AxisProgram& program,
                                   const process::ProgramProof& proof) {
  const double radius = 0.5 * run.gear.process->part().diameter_mm;
  process::Taken taken = run.gear.process->taken(run.machine);
  if (!program.turns_in_cuts)  // the angles of the teeth alone
    taken.turns_mm = std::max(0.0, program.rounding_bound_mm - taken.words_mm);
  auto refused = process::finer_than_the_program(run.job, taken, proof.gouge, proof.excess);
  const std::size_t coarse = process::coarse_words(run.job, run.machine, radius) ? 1 : 0;  // told beside others
  if (refused.empty() || run.report.reasons.size() > refused.size() + coarse) return std::nullopt;
  return std::move(refused.front());
}

/// The program of the run, proven. Nothing: done, and `report.reasons` says whether it is safe.
std::optional<Diagnostic> post_and_prove(Run& run, const proof::ProofLimits& limits, app::OutputDir& output) {
  const auto paths = run.paths();
  Attempts attempts(run, limits, output);
  auto made = attempts.best();
  if (!made) return made.error();
  process::PostedProgram& posted = made->posted;
  process::ProgramProof& proof = made->proof;
  const joints::AxisProgram& program = posted.axes;
  process::note_axis_program(run.report, run.job, run.machine, paths, posted.restarted ? *posted.restarted : program);
  run.report.blocks = posted.blocks;
  const std::vector<const path::ClPath*> asked = process::paths_to_meet(program, paths);
  keep_proof(run, limits, proof, paths, std::move(made->states));
  const std::string file = output.final_path(posted.file);
  const process::ProgramText whole{posted.text, file, run.job, run.machine};
  if (auto done = note_restart(run.report, posted, whole, run.milling->check(), run.lines, run.clock); !done)
    return done.error();
  if (auto done = prove_parts(run, limits, posted, whole); !done) return done.error();
  if (run.restart && (run.job.program.teeth_per_program || run.job.program.split_operations))
    run.report.warnings.emplace_back("the program from the restart on is one: parts of it are not written");
  run.program_text = std::move(posted.restarted ? posted.restart_text : posted.text);
  run.report.ledger = run.milling->ledger(program, proof, posted.blend_mm);
  process::note_cutting_forces(run.report, run.job);
  run.report.sections =
      sections::sections_of({run.job, run.machine, run.report, posted.restarted ? *posted.restarted : program, paths});
  if (!run.report.reasons.empty()) {
    if (run.report.gouge)
      for (std::string& help :
           process::what_would_help(run.report.ledger, *run.report.gouge, run.report.gouge_tolerance_mm))
        run.report.would_help.push_back(std::move(help));
    if (auto refused = attempts.refusal(*made)) return refused;
    return too_fine(run, program, proof);
  }
  process::note_verified(run.report, posted.file, run.program_text);
  for (const report::PartReport& part : run.report.parts) run.report.files.push_back(part.file);
  run.report.name_on_control = posted.name_on_control;
  return std::nullopt;
}

}  // namespace

process::ValueOrErrors<GearToCut> make_gear(const job::Job& job, const job::MeasuredInput& measured,
                                            app::StageClock& clock) {
  auto made = clock.run("gear", [&] { return make_process(job); });
  if (auto* errors = made.refused()) return std::move(*errors);
  GearToCut gear{std::move(made).value(), std::nullopt};
  if (measured.files.empty()) return gear;
  auto corrected = gear.process->correct(measured, clock);
  if (!corrected) return std::vector{corrected.error()};
  gear.correction = std::move(corrected.value());
  return gear;
}

Status plan_job(job::Job& job, process::GearMilling& milling, app::StageClock& clock, app::Progress& progress) {
  const Status planned = milling.plan(clock, progress);
  process::take_ways(job.operations, milling.flank_ways());
  return planned;
}

std::vector<Diagnostic> prepare(Run& run, const RunAsked& asked) {
  if (run.job.operations.empty())
    return {fail_at(run.job.where("operation"), "the job lacks an [[operation]]: there is nothing to run")};
  std::vector<Diagnostic> errors;
  auto gear = make_gear(run.job, asked.measured, run.clock);
  if (auto* refused = gear.refused()) errors = std::move(*refused);
  else run.gear = std::move(gear).value();
  auto loaded = run.clock.run("machine", [&] {
    return process::load_machine(
        run.job, run.gear.process ? std::optional(run.gear.process->part().swing_diameter_mm) : std::nullopt);
  });
  if (auto* refused = loaded.refused()) errors.insert(errors.end(), refused->begin(), refused->end());
  else run.machine = std::move(loaded).value();
  if (!errors.empty()) return errors;
  auto restart = read_restart(asked.restart, run.job, run.gear.process->part().teeth);
  if (!restart) return {restart.error()};
  run.restart = *restart;
  if (auto bad = process::no_room_over_part(run.job, run.machine, run.gear.process->link_body(run.machine)))
    return {*bad};
  return {};
}

std::optional<Diagnostic> plan_post_and_prove(Run& run, app::OutputDir& output, const proof::ProofLimits& limits,
                                              const process::FlankGrid& grid) {
  begin_report(run);
  run.milling = run.gear.process->milling(run.machine, limits, grid, run.clock);
  if (auto stopped = plan_and_check(run)) return with_measurement(run, limits, grid, std::move(*stopped));
  return post_and_prove(run, limits, output);
}

page::ReportPage page_content(Run& run) {
  const process::GearProcess& gear = *run.gear.process;
  const std::string contact = gear.contact_section(run.surface, run.report.warnings);  // first: it may add a warning
  page::ReportPage page =
      page::page_of_run(gear.on_page(run.report.machine_name), run.report, run.paths(), run.program_text);
  page.surface = run.surface;
  page.contact = contact;
  page.gear_limits = gear.limit_charts();
  page.motion = run.motion;
  page.machine = run.machine_scene;
  for (std::size_t k = 0; k < run.lines.size(); ++k) page.paths[k].nc_lines = run.lines[k];
  return page;
}

StagesOutcome run_stages(const job::Job& job, const proof::ProofLimits& limits, app::OutputDir& scratch, bool quiet,
                         const process::FlankGrid& grid, bool with_page) {
  Run run(quiet);
  run.job = job;
  run.job.program.split_operations = false;  // the parts are for people
  run.job.program.teeth_per_program.reset();
  StagesOutcome outcome;
  outcome.errors = prepare(run, {});
  if (!outcome.errors.empty()) return outcome;
  if (const auto stopped = plan_post_and_prove(run, scratch, limits, grid)) {
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

}  // namespace toothpath::flow
