#include "app/commands/check.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>

#include "app/process/bevel_check.h"
#include "app/process/bevel_run.h"
#include "app/process/program_report.h"
#include "app/process/proof.h"
#include "app/process/scene.h"
#include "app/process/gear_of_job.h"
#include "app/job/file.h"
#include "app/job/measured_file.h"
#include "app/base/output_dir.h"
#include "app/report/deviation_vtp.h"
#include "app/report/page/motion_charts.h"
#include "app/report/page/page_of_run.h"
#include "geometry/base/angle.h"
#include "cam/ball/plan.h"
#include "geometry/base/hash.h"

namespace toothpath::commands {
namespace {

void fill(report::RunReport& report, const process::FaceGearProof& proof, const machines::Machine& machine) {
  report.gouge = proof.gouge;
  report.reasons = proof.reasons;
  report.excess = proof.surface.operations;
  report.finished = proof.surface.finished;
  report.unreached = proof.surface.unreached;
  if (proof.surface.scallop.requested_mm > 0) report.scallop = proof.surface.scallop;
  report.blocks = proof.read.executed;
  report.feed_minutes = proof.read.feed_minutes;
  report.total_minutes = proof.read.minutes;
  report.axes = process::ranges_of(proof.read, machine);
  report.verified = report.reasons.empty();
}

}  // namespace

CommandOutcome check_program(const CheckRequest& request) {
  std::vector<std::string> inputs = {request.job_file, request.program_file};
  for (const auto* more : {&request.stock_files, &request.fixture_files, &request.measured_files}) inputs.insert(inputs.end(), more->begin(), more->end());
  auto output = app::OutputDir::open(request.out_dir, {"report.json", "report.html", "tooth.vtp"}, inputs);
  if (!output) return failed(output.error());
  if (const auto bevel = process::bevel_job(request.job_file)) return process::check_bevel_program(request, *bevel, *output);
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto read = clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job job = std::move(read).value();
  auto made = clock.run("gear", [&] { return process::make_face_gear(job); });
  if (auto* refused = made.refused()) return failed(std::move(*refused));
  face_gear::FaceGear gear = std::move(made).value();
  if (!request.measured_files.empty()) {
    auto corrected = clock.run("correction", [&] { return job::correct_gear(gear, request.measured_files); });
    if (!corrected) return failed(corrected.error());
    gear = std::move(corrected->gear);
  }
  auto loaded = clock.run("machine", [&] { return process::load_machine(job); });
  if (auto* refused = loaded.refused()) return failed(std::move(*refused));
  const machines::Machine machine = std::move(loaded).value();
  if (!job.setup) return failed(fail_at(job.where("setup"), "the job lacks a [setup]: where the gear stands is not known"));
  auto text = process::read_program_file(request.program_file);
  if (!text) return failed(text.error());

  std::optional<process::Scene> scene;
  if (process::wants_scene(request)) {
    auto meshes = clock.run("stock and fixture meshes", [&] { return process::load_scene(request, 2 * gear.outer_radius()); });
    if (!meshes) return failed(meshes.error());
    scene = std::move(meshes.value());
  }

  const analytic::GearDistance part = clock.run("distance index", [&] { return analytic::GearDistance(gear, ball::reach_of(job.tools)); });
  analytic::GougeCheckOptions options;
  options.gouge_tolerance_mm = job.verify.gouge_tolerance_mm;
  options.proof_mm = std::min(options.proof_mm, 0.1 * job.verify.gouge_tolerance_mm);
  options.clearance_mm = job.verify.clearance_mm.value_or(ball::PlanOptions{}.clearance_mm);
  options.rapid_height_mm = gear.blank_top();
  const analytic::GougeCheck gouge_check(part, job.tools, options);
  process::FaceGearCheck face(job, machine, part, gouge_check);
  auto proof = process::prove_face_gear({*text, request.program_file, job, machine}, {}, face, clock);
  if (!proof) {
    progress.clear();
    return failed(proof.error());
  }
  report::RunReport report = process::report_of("check", job, machine, gear.warnings());
  report.program_file = request.program_file;
  if (scene) {
    auto verdicts = clock.run("stock and fixture", [&] {
      return check_scene(*scene, *text, request.program_file, job, machine, proof->read,
                         process::scene_of_face_gear(job, gear.parameters().teeth, options.clearance_mm));
    });
    if (!verdicts) {
      progress.clear();
      return failed(verdicts.error());
    }
    process::add_scene(*verdicts, proof->reasons, proof->gouge, report);
  }
  report.program_sha256 = sha256_hex(*text);
  report.program_bytes = text->size();
  fill(report, *proof, machine);

  CommandOutcome outcome;
  outcome.exit_code = report.verified ? app::ExitCode::ok : app::ExitCode::unverified;
  outcome.errors = process::errors_of(report.reasons, request.program_file);
  const auto vtp = report::deviation_vtp(proof->surface.grids);
  if (!vtp) return failed(vtp.error());
  if (const auto s = output->write("tooth.vtp", *vtp); !s) return failed(s.error());
  report.files = {"tooth.vtp", "report.html", "report.json"};
  report.stages = clock.seconds();
  const auto page = clock.run("report page", [&] {
    page::ReportPage content = page::page_of_run(job, report, {}, *text);
    content.surface = proof->surface.grids;
    content.motion = page::motion_charts(proof->read, proof->motions, machine);
    return render_report_page(content);
  });
  if (!page) return failed(page.error());
  if (const auto s = output->write("report.html", *page); !s) return failed(s.error());
  report.stages = clock.seconds();
  outcome.report_json = report::report_json(report);
  if (const auto s = output->write("report.json", outcome.report_json); !s) return failed(s.error());
  progress.clear();
  if (const auto committed = output->commit(); !committed) return failed(committed.error());
  outcome.summary = report::summary_table(report, request.color) + process::table_of_worst(proof->gouge);
  return outcome;
}

void add_check(Commands& commands) {
  commands.push_back(command_of<CheckRequest>(
      "check", "proves a program that is already there against the job's gear",
      [](OptionSet& set, CheckRequest& request) {
        job_options(set, request);
        set.file("PROGRAM", request.program_file, "NC program in the dialect of the job's machine");
        set.files("--stock", request.stock_files, "closed mesh of the stock before the program (STL or OBJ, mm, gear frame); repeatable");
        set.files("--fixture", request.fixture_files,
                  "closed mesh of what holds the work and turns with it (STL or OBJ, mm, gear frame); repeatable. Facets are taken as exact: "
                  "what they leave out of the true part must lie within the clearance of the job");
        set.files("--measured", request.measured_files, "measured deviations that the program answers (see correct)");
      },
      check_program));
}

}  // namespace toothpath::commands
