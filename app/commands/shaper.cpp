#include "app/commands/shaper.h"

#include "app/base/command_data.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/process/face/shaper_setup.h"
#include "app/process/opening_and_end.h"
#include "app/report/limits/json.h"
#include "app/report/run_report.h"
#include "geometry/base/angle.h"
#include "geometry/base/hash.h"
#include "machines/shaper_machine.h"
#include "postproc/shaper/control.h"
#include "postproc/shaper/gearbox_proof.h"
#include "postproc/shaper/setup.h"
#include "postproc/shaper/sheet.h"

namespace toothpath::commands {
namespace {

std::string summary_of(const shaper::ShaperSetup& s, const std::string& folder) {
  std::string out = fmt::format("shaper set-up of {} on {}\n", s.job_name, s.machine.name);
  out += fmt::format("  offset slide {:.4f} mm ({:.4f} deg by tan, {:.4f} deg by sin)\n", s.slide_mm,
                     degrees(s.angle_tan_rad), degrees(s.angle_sin_rad));
  out += fmt::format("  stroke {:.3f} mm, {:.3f} .. {:.3f}, {} double strokes/min\n", s.length_mm, s.start_mm, s.end_mm,
                     s.strokes_set);
  if (s.machine.gearbox)
    out += fmt::format("  electronic gearbox {}{}/{}, read back from the program\n", s.sense < 0 ? "-" : "",
                       s.generating.numerator, s.generating.denominator);
  else
    out += fmt::format("  index gears {}, feed gears {} ({:.5f} mm)\n", s.index_gears.text(), s.feed_gears.text(),
                       s.circular_feed_set_mm);
  out += fmt::format("  {} + {} double strokes, {:.1f} min\n", s.strokes_infeed, s.strokes_turn, s.total_min());
  for (const auto& warning : s.warnings) out += "  warning: " + warning + "\n";
  if (!s.machine.assumed_keys.empty()) {
    out += "  assumed:";
    for (const auto& name : s.machine.assumed_keys) out += " " + name;
    out += "\n";
  }
  return out + "  files in " + folder + "\n";
}

}  // namespace

constexpr const char* kPreviousShaper = "previous_shaper";

const std::vector<std::string>& shaper_outputs() {
  static const std::vector<std::string> names = {"limits.json", "shaper.json", "shaper.html", "shaper_program.",
                                                 "report.json"};
  return names;
}

/// A program by its name and bytes.
struct NamedProgram {
  const std::string &name, &bytes;
};

report::RunReport report_of(const job::Job& job, const machines::ShaperMachine& machine,
                            const shaper::ShaperSetup& setup, const NamedProgram& program) {
  report::RunReport report;
  report.command = "shaper";
  report.job_name = job.name;
  report.job_file = job.file;
  report.machine_name = machine.name;
  report.machine_file = job.machine.file;
  report.dialect = machine.dialect;
  report.assumed = machine.assumed_keys;
  report.warnings = setup.warnings;
  report.program_file = program.name;
  report.program_sha256 = sha256_hex(program.bytes);
  report.program_bytes = program.bytes.size();
  report.blocks = static_cast<std::size_t>(std::count(program.bytes.begin(), program.bytes.end(), '\n'));
  report.feed_minutes = report.total_minutes = setup.total_min();
  return report;
}

CommandOutcome run_shaper(const JobRequest& request) {
  app::Progress progress(request.quiet);
  app::StageClock clock(progress);
  auto output = app::OutputDir::open(request.out_dir, shaper_outputs(), {request.job_file}, kPreviousShaper);
  if (!output) return failed(output.error());
  auto read = process::read_face_gear_job(request.job_file, clock);
  if (auto* errors = read.refused()) return failed(std::move(*errors));
  const job::Job& job = read.value().job;
  const face_gear::FaceGear& gear = read.value().gear;
  auto loaded = clock.run("machine", [&] { return face::load_shaper_machine(job); });
  if (auto* errors = loaded.refused()) return failed(std::move(*errors));
  const machines::ShaperMachine& machine = loaded.value();
  auto planned = clock.run("shaper set-up", [&] { return face::plan_shaper(job, gear, machine); });
  if (auto* errors = planned.refused()) return failed(std::move(*errors));
  shaper::ShaperSetup& setup = planned.value();
  if (const auto aside = output->set_aside(); !aside) return failed(aside.error());
  setup.warnings.insert(setup.warnings.begin(), gear.warnings().begin(), gear.warnings().end());
  setup.warnings.insert(setup.warnings.begin(), job.warnings.begin(), job.warnings.end());
  const auto study =
      clock.run("stroke simulation", [&] { return shaper::feed_study(setup, shaper::compared_feeds(setup)); });
  const shaper::ShaperControl& control = shaper::shaper_control(machine);
  const std::string program_name = "shaper_program" + control.extension;
  const std::string program = clock.run("shaper program", [&] { return control.program(setup); });
  if (const auto written = output->write(program_name, program); !written) return failed(written.error());
  const auto bytes = output->read_back(program_name);
  if (!bytes) return failed(bytes.error());
  if (control.read) {
    const auto faults = clock.run("read back", [&] { return shaper::gearbox_program_faults(*bytes, setup); });
    std::vector<Diagnostic> errors;
    for (const auto& fault : faults)
      errors.push_back(fail_as(DiagnosticKind::verification, "{}: {}", program_name, fault));
    if (!errors.empty()) return failed(std::move(errors));
  }

  report::RunReport report = report_of(job, machine, setup, {program_name, program});
  const auto write = [&](const std::string& name, const std::string& content) -> Status {
    report.files.push_back(name);
    return output->write(name, content);
  };
  const std::string limits_text = limits::limits_json(gear), setup_text = shaper::shaper_json(setup, study);
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"limits.json", limits_text},
                                      {"shaper.json", setup_text},
                                      {"shaper.html", shaper::shaper_html(setup, study)}})
    if (const auto written = write(name, content); !written) return failed(written.error());
  report.files.push_back(program_name);
  progress.clear();
  CommandOutcome outcome = process::finished_report(*output, clock, std::move(report), request.color);
  if (outcome.exit_code == app::ExitCode::ok) outcome.summary = summary_of(setup, request.out_dir);
  app::add_data(outcome, "limits", limits_text);
  app::add_data(outcome, "set_up", setup_text);
  return outcome;
}

void add_shaper(Commands& commands) {
  commands.push_back(command_of<JobRequest>(
      "shaper", "limits and gear-shaper set-up: sheet and stroke program",
      [](OptionSet& set, JobRequest& request) {
        job_options(set, request);
        set.examples({"shaper gear.toml"});
      },
      run_shaper));
}

}  // namespace toothpath::commands
