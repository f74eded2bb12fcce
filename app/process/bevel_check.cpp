#include "app/process/bevel_check.h"

#include "app/process/bevel_page.h"
#include "app/process/bevel_run.h"
#include "app/process/program_report.h"
#include "app/process/scene.h"
#include "app/report/deviation_vtp.h"
#include "geometry/base/hash.h"

namespace toothpath::process {
namespace {

void fill(report::RunReport& report, const bevel_gear::BevelGear& gear, const job::Job& job, const machines::Machine& machine, const BevelProof& proof) {
  report.gouge = proof.result.gouge;
  report.excess = proof.result.operations;
  report.finished = proof.result.finished;
  report.directions = directions_of(gear, job, proof);
  report.blocks = proof.read.executed;
  report.feed_minutes = proof.read.feed_minutes;
  report.total_minutes = proof.read.minutes;
  report.axes = ranges_of(proof.read, machine);
  report.reasons = proof.reasons;
  report.verified = report.reasons.empty();
}

}  // namespace

commands::CommandOutcome check_bevel_program(const commands::CheckRequest& request, const job::Job& job, app::OutputDir& output) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto made = clock.run("gear", [&] { return make_bevel_gear(job); });
  if (auto* refused = made.refused()) return commands::failed(std::move(*refused));
  const bevel_gear::BevelGear gear = std::move(made).value();
  auto loaded = clock.run("machine", [&] { return load_machine(job); });
  if (auto* refused = loaded.refused()) return commands::failed(std::move(*refused));
  const machines::Machine machine = std::move(loaded).value();
  if (!job.setup) return commands::failed(fail_at(job.where("setup"), "the job lacks a [setup]: where the gear stands is not known"));
  const auto text = read_program_file(request.program_file);
  if (!text) return commands::failed(text.error());

  std::optional<Scene> scene;
  if (wants_scene(request)) {
    auto meshes = clock.run("stock and fixture meshes", [&] { return load_scene(request, outer_diameter(gear)); });
    if (!meshes) return commands::failed(meshes.error());
    scene = std::move(meshes.value());
  }

  const finger::FingerGougeCheck check(gear, job.tools, job.operations, proof_tolerances(job));
  BevelGearCheck bevel(job, machine, gear, check);
  auto proof = prove_bevel_gear({*text, request.program_file, job, machine}, {}, bevel, clock);
  if (!proof) {
    progress.clear();
    return commands::failed(proof.error());
  }
  report::RunReport report = report_of("check", job, machine, gear.warnings());
  if (scene) {
    auto verdicts = clock.run("stock and fixture", [&]() -> Result<std::vector<report::SceneVerdict>> {
      const auto around = scene_of_bevel_gear(job, gear, proof_tolerances(job).clearance_mm);
      if (!around) return around.error();
      return check_scene(*scene, *text, request.program_file, job, machine, proof->read, *around);
    });
    if (!verdicts) {
      progress.clear();
      return commands::failed(verdicts.error());
    }
    add_scene(*verdicts, proof->reasons, proof->result.gouge, report);
  }
  fill(report, gear, job, machine, *proof);
  report.program_file = request.program_file;
  report.program_sha256 = sha256_hex(*text);
  report.program_bytes = text->size();

  commands::CommandOutcome outcome;
  outcome.exit_code = report.verified ? app::ExitCode::ok : app::ExitCode::unverified;
  outcome.errors = errors_of(report.reasons, request.program_file);
  const auto vtp = report::deviation_vtp(proof->result.walls);
  if (!vtp) return commands::failed(vtp.error());
  if (const auto s = output.write("tooth.vtp", *vtp); !s) return commands::failed(s.error());
  report.files = {"tooth.vtp", "report.html", "report.json"};
  report.stages = clock.seconds();
  const auto page = clock.run("report page", [&] { return page::render_report_page(bevel_page(job, gear, machine, report, {}, &*proof, *text)); });
  if (!page) return commands::failed(page.error());
  if (const auto s = output.write("report.html", *page); !s) return commands::failed(s.error());
  report.stages = clock.seconds();
  outcome.report_json = with_bevel_keys(report::report_json(report), gear, {}, &*proof);
  if (const auto s = output.write("report.json", outcome.report_json); !s) return commands::failed(s.error());
  progress.clear();
  if (const auto committed = output.commit(); !committed) return commands::failed(committed.error());
  outcome.summary = bevel_summary(report, request.color, &*proof) + table_of_worst(proof->result.gouge);
  return outcome;
}

}  // namespace toothpath::process
