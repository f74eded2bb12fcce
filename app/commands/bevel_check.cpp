#include "app/commands/bevel_check.h"

#include "app/commands/bevel_page.h"
#include "app/commands/bevel_run.h"
#include "app/commands/program_report.h"
#include "app/commands/scene.h"
#include "app/report/deviation_vtp.h"
#include "geometry/base/hash.h"

namespace toothpath {
namespace {

void fill(RunReport& report, const BevelGear& gear, const Job& job, const Machine& machine, const BevelProof& proof) {
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

CommandOutcome check_bevel_program(const CheckRequest& request, const Job& job, OutputDir& output) {
  Progress progress(request.quiet);
  StageClock clock(progress);
  auto made = clock.run("gear", [&] { return make_bevel_gear(job); });
  if (auto* refused = std::get_if<1>(&made)) return failed(std::move(*refused));
  const BevelGear gear = std::move(std::get<0>(made));
  auto loaded = clock.run("machine", [&] { return load_machine(job); });
  if (auto* refused = std::get_if<1>(&loaded)) return failed(std::move(*refused));
  const Machine machine = std::move(std::get<0>(loaded));
  if (!job.setup) return failed(fail_at(job.where("setup"), "the job lacks a [setup]: where the gear stands is not known"));
  const auto text = read_program_file(request.program_file);
  if (!text) return failed(text.error());

  std::optional<Scene> scene;
  if (wants_scene(request)) {
    auto meshes = clock.run("stock and fixture meshes", [&] { return load_scene(request, outer_diameter(gear)); });
    if (!meshes) return failed(meshes.error());
    scene = std::move(meshes.value());
  }

  const FingerGougeCheck check(gear, job.tools, job.operations, proof_tolerances(job));
  BevelGearCheck bevel(job, machine, gear, check);
  auto proof = prove_bevel_gear({*text, request.program_file, job, machine}, {}, bevel, clock);
  if (!proof) {
    progress.clear();
    return failed(proof.error());
  }
  RunReport report = report_of("check", job, machine, gear.warnings());
  if (scene) {
    auto verdicts = clock.run("stock and fixture", [&]() -> Result<std::vector<SceneVerdict>> {
      const auto around = scene_of_bevel_gear(job, gear, proof_tolerances(job).clearance_mm);
      if (!around) return around.error();
      return check_scene(*scene, *text, request.program_file, job, machine, proof->read, *around);
    });
    if (!verdicts) {
      progress.clear();
      return failed(verdicts.error());
    }
    add_scene(*verdicts, proof->reasons, proof->result.gouge, report);
  }
  fill(report, gear, job, machine, *proof);
  report.program_file = request.program_file;
  report.program_sha256 = sha256_hex(*text);
  report.program_bytes = text->size();

  CommandOutcome outcome;
  outcome.exit_code = report.verified ? ExitCode::ok : ExitCode::unverified;
  outcome.errors = errors_of(report.reasons, request.program_file);
  const auto vtp = deviation_vtp(proof->result.walls);
  if (!vtp) return failed(vtp.error());
  if (const auto s = output.write("tooth.vtp", *vtp); !s) return failed(s.error());
  report.files = {"tooth.vtp", "report.html", "report.json"};
  report.stages = clock.seconds();
  const auto page = clock.run("report page", [&] { return render_report_page(bevel_page(job, gear, machine, report, {}, &*proof, *text)); });
  if (!page) return failed(page.error());
  if (const auto s = output.write("report.html", *page); !s) return failed(s.error());
  report.stages = clock.seconds();
  outcome.report_json = with_bevel_keys(report_json(report), gear, {}, &*proof);
  if (const auto s = output.write("report.json", outcome.report_json); !s) return failed(s.error());
  progress.clear();
  if (const auto committed = output.commit(); !committed) return failed(committed.error());
  outcome.summary = bevel_summary(report, request.color, &*proof) + table_of_worst(proof->result.gouge);
  return outcome;
}

}  // namespace toothpath
