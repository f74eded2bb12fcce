#include "app/commands/surface.h"

#include <optional>
#include <variant>

#include "app/base/command_data.h"
#include "app/base/new_file.h"
#include "app/job/file.h"
#include "app/process/flow/stages.h"
#include "app/process/opening_and_end.h"
#include "app/rexs/gears.h"

namespace toothpath::commands {

const std::vector<std::string>& surface_outputs() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {"limits.json",  "limits.html",    "limits.svg",     "limits_0.svg",
                                    "limits_1.svg", "inspection.csv", "inspection.dmi", "gear.stl",
                                    "tooth.vtp",    "report.json",    "data_sheet.html"};
    all.insert(all.end(), cad::file_names().begin(), cad::file_names().end());
    return all;
  }();
  return names;
}

void cad_options(OptionSet& set, cad::FilesAsked& asked) {
  set.flag("--step", asked.step, "gear.step, too: the gear as a solid for CAD (STEP AP214)");
  set.flag("--3mf", asked.three_mf, "gear.3mf, too: its mesh with unit and name");
  set.flag("--gltf", asked.gltf, "gear.glb, too: one pitch and its turned copies, for viewers");
  set.flag("--stock", asked.stock, "blank.stl, too, and from a run roughed.stl: stock for check --stock");
}

namespace {

/// The gear of a job as a REXS file. Refused, at its place: what has no components there.
Result<rexs::Written> rexs_of_job(const job::Job& job) {
  return std::visit(
      [&](const auto& gear) -> Result<rexs::Written> {
        if constexpr (requires { rexs::rexs_of(gear, job.name); }) {
          auto made = rexs::rexs_of(gear, job.name);
          if (auto* refusal = made.refused())
            return process::located(job, "gear." + refusal->key, std::move(refusal->diagnostic));
          if (!job.modifications.empty())
            made.value().notes.emplace_back("modifications of the flanks are not written; the grid has them");
          return std::move(made).value();
        } else {
          return fail_at(job.where("gear.type"),
                         "type = \"{}\" is not written as REXS: cylindrical_gear and spiral_bevel_gear are",
                         job.gear_type());
        }
      },
      job.gear);
}

}  // namespace

CommandOutcome run_surface(const SurfaceRequest& request) {
  if (!request.rexs_file.empty())
    if (auto fresh = app::check_new_file(request.rexs_file, "--rexs"); !fresh) return failed(fresh.error());
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, surface_outputs(), {request.job_file});
  if (!output) return failed(output.error());
  auto read = clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job& job = read.value();
  std::optional<rexs::Written> rexs;
  if (!request.rexs_file.empty()) {
    auto made = rexs_of_job(job);
    if (!made) return failed(made.error());
    rexs = std::move(*made);
  }
  auto made = flow::make_gear(job, {}, clock);
  if (auto* errors = made.refused()) return failed(std::move(*errors));
  const process::GearProcess& gear = *made.value().process;
  report::RunReport report = process::surface_report(job, gear.part().warnings);
  report.modified = gear.part().modified;
  if (const auto written = gear.write_files(*output, {}, {}, clock, report.files); !written)
    return failed(process::located(job, "gear", written.error()));
  auto cad = cad::write_files(request.cad, job, gear, {}, *output, clock, report.files);
  if (!cad) return failed(cad.error());
  report.cad = std::move(cad->solid);
  report.warnings.insert(report.warnings.end(), cad->warnings.begin(), cad->warnings.end());
  if (rexs) {
    const auto flanks = gear.inspected();
    if (!flanks) return failed(flanks.error());
    rexs::add_flank_grid(rexs->file, flanks->points);
    if (const Status s = app::write_new_file(request.rexs_file, rexs::rexs_text(rexs->file)); !s)
      return failed(s.error());
    for (std::string& note : rexs->notes) report.warnings.push_back(request.rexs_file + ": " + note);
  }
  const auto limits = output->read_back("limits.json");
  if (!limits) return failed(limits.error());
  progress.clear();
  CommandOutcome outcome = process::finished_report(*output, clock, std::move(report), request.color);
  app::add_data(outcome, "limits", *limits);
  return outcome;
}

void add_surface(Commands& commands) {
  commands.push_back(command_of<SurfaceRequest>(
      "surface", "limits, inspection points and meshes of the gear; plans nothing",
      [](OptionSet& set, SurfaceRequest& request) {
        job_options(set, request);
        set.examples({"surface gear.toml", "surface gear.toml --step --out cad"});
        cad_options(set, request.cad);
        set.text("--rexs", request.rexs_file,
                 "the gear and the settings of its generator as REXS 1.7, with the inspection grid; a new file",
                 "FILE");
      },
      run_surface));
}

}  // namespace toothpath::commands
