#include "app/commands/run.h"

#include "app/commands/surface.h"
#include "app/job/file.h"
#include "app/process/program_report.h"
#include "app/process/proof_limits.h"
#include "app/report/cl_csv.h"
#include "app/report/sheet/setup_sheet.h"
#include "postproc/controls/registry.h"

namespace toothpath::commands {
namespace {

std::vector<std::string> run_outputs() {
  std::vector<std::string> all = {
      "program.",   "program_#.",   "cl.csv",         "report.json",     "report.html",       "setup.html",
      "gear.stl",   "tooth.vtp",    "inspection.csv", "inspection.dmi",  "limits.json",       "limits.html",
      "limits.svg", "limits_0.svg", "limits_1.svg",   "correction.json", "program_tools.tbl", "data_sheet.html"};
  all.insert(all.end(), cad::file_names().begin(), cad::file_names().end());
  return all;
}

/// Job, gear and machine with everything that is wrong with them.
std::vector<Diagnostic> read_inputs(flow::Run& run, const RunRequest& request) {
  auto read = run.clock.run("job", [&] { return job::read_job_file(request.job_file); });
  if (auto* errors = read.refused()) return std::move(*errors);
  run.job = std::move(read).value();
  auto errors = flow::prepare(run, request);
  if (!errors.empty()) return errors;
  return process::finer_than_the_machine(run.job, run.gear.process->taken(run.machine));
}

/// The files for people and for other programs; the program itself is there already.
Status write_results(flow::Run& run, const RunRequest& request, app::OutputDir& output, std::string& json) {
  report::RunReport& report = run.report;
  const process::GearProcess& gear = *run.gear.process;
  const auto write = [&](const std::string& name, const std::string& content) -> Status {
    report.files.push_back(name);
    return output.write(name, content);
  };
  if (run.gear.correction)
    if (const auto s = write("correction.json", run.gear.correction->json); !s) return s;
  if (report.verified) {
    if (const auto s = gear.write_files(output, run.surface, report.assumed, run.clock, report.files); !s) return s;
    auto cad = cad::write_files(request.cad, run.job, gear, cad::Milled{*run.milling, run.path_off_mm}, output,
                                run.clock, report.files);
    if (!cad) return cad.error();
    report.cad = std::move(cad->solid);
    report.roughed = std::move(cad->roughed);
    report.warnings.insert(report.warnings.end(), cad->warnings.begin(), cad->warnings.end());
    if (const auto s = write("setup.html", sheet::setup_sheet(run.job, gear.outline(), run.machine, report)); !s)
      return s;
    const controls::Control* control = controls::find(run.machine.dialect);
    if (control && control->tool_table)
      if (const auto s = write(control->tool_table->file, control->tool_table->text(run.job.tools)); !s) return s;
  }
  const auto paths = run.paths();
  if (!paths.empty())
    if (const auto s = write("cl.csv", report::cl_csv(paths)); !s) return s;
  report.stages = run.clock.seconds();
  const auto page = run.clock.run("report page", [&] { return page::render_report_page(flow::page_content(run)); });
  if (!page) return page.error();
  if (const auto s = write("report.html", *page); !s) return s;
  report.files.push_back("report.json");
  report.stages = run.clock.seconds();
  json = report::report_json(report);
  return output.write("report.json", json);
}

/// The end of a run whose inputs were right: verified, or not and why.
CommandOutcome finish(flow::Run& run, const RunRequest& request, app::OutputDir& output,
                      const std::optional<Diagnostic>& stopped) {
  CommandOutcome outcome = process::verdict_of(run.report, stopped, run.job.file, output);
  if (const auto written = write_results(run, request, output, outcome.report_json); !written)
    return failed(process::located(run.job, "gear", written.error()));
  run.progress.clear();
  if (const auto committed = output.commit(); !committed) return failed(committed.error());
  run.report.directory = output.path();
  outcome.summary = report::summary_table(run.report, request.color);
  if (run.report.gouge) outcome.summary += process::table_of_worst(*run.report.gouge);
  return outcome;
}

}  // namespace

CommandOutcome run_job(const RunRequest& request) {
  std::vector<std::string> inputs = request.measured.files;
  inputs.push_back(request.job_file);
  auto output = app::OutputDir::open(request.out_dir, run_outputs(), inputs, app::kPrevious);
  if (!output) return failed(output.error());
  flow::Run run(request.quiet);
  if (auto errors = read_inputs(run, request); !errors.empty()) {
    run.progress.clear();
    return failed(std::move(errors));
  }
  if (const auto aside = output->set_aside(); !aside) return failed(aside.error());
  const auto stopped = flow::plan_post_and_prove(run, *output, process::proof_limits(run.job));
  if (stopped && stopped->kind != DiagnosticKind::verification) {
    run.progress.clear();
    return failed(*stopped);
  }
  CommandOutcome outcome = finish(run, request, *output, stopped);
  if (request.finished && !outcome.report_json.empty()) request.finished(run);
  return outcome;
}

void add_run(Commands& commands) {
  commands.push_back(command_of<RunRequest>(
      "run", "plans the tool paths, writes the NC program and proves it",
      [](OptionSet& set, RunRequest& request) {
        job_options(set, request);
        set.examples({"run gear.toml", "run gear.toml --restart 2:14 --out restart"});
        set.text("--restart", request.restart,
                 "operation and tooth, both from 0: the program begins there; what comes before is taken as done",
                 "OP:TOOTH");
        cad_options(set, request.cad);
      },
      run_job));
}

}  // namespace toothpath::commands
