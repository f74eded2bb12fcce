#include "app/commands/shaper.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "app/commands/opening_and_end.h"
#include "app/report/limits_json.h"
#include "app/report/run_report.h"
#include "geometry/base/angle.h"
#include "geometry/base/hash.h"
#include "machines/machine_file.h"
#include "machines/shaper_machine.h"
#include "postproc/shaper_gearbox_program.h"
#include "postproc/shaper_gearbox_proof.h"
#include "postproc/shaper_program.h"
#include "postproc/shaper_setup.h"
#include "postproc/shaper_sheet.h"

namespace toothpath {
namespace {

/// The gear shaper of the job; refusals carry the place of the key that caused them.
ValueOrErrors<ShaperMachine> load_shaper_machine(const Job& job) {
  if (job.machine.file.empty()) return std::vector{fail_at(job.where(""), "the job lacks the table [machine]")};
  const auto path = find_machine_file(job.machine.file, std::filesystem::path(job.file).parent_path().string());
  if (!path) return std::vector{located(job, "machine.file", path.error())};
  const auto kind = machine_kind_of(*path);
  if (!kind) return std::vector{located(job, "machine.file", kind.error())};
  if (*kind != MachineKind::gear_shaper)
    return std::vector{fail_at(job.where("machine.file"), "{} is a milling machine, but this command needs a gear shaper", job.machine.file)};
  auto reading = read_shaper_machine_file(*path);
  if (!reading.machine) return std::move(reading.errors);
  if (reading.machine->assumed && !job.machine.accept_assumed) {
    std::string names;
    for (const auto& name : reading.machine->assumed_keys) names += (names.empty() ? "" : ", ") + name;
    return std::vector{fail_at(job.where("machine.file"),
                               "{} has assumed values ({}); measure them, or accept them with accept_assumed = true", job.machine.file, names)};
  }
  return std::move(*reading.machine);
}

ValueOrErrors<ShaperSetup> plan_setup(const Job& job, const FaceGear& gear, const ShaperMachine& machine) {
  if (!job.shaping) return std::vector{fail_at(job.where(""), "the job lacks the table [shaping]")};
  ShaperWork work;
  work.job_name = job.name;
  work.machine_file = job.machine.file;
  work.gear = gear.parameters();
  work.shaping = *job.shaping;
  auto planned = plan_shaper_setup(work, machine);
  if (auto* setup = std::get_if<ShaperSetup>(&planned)) return std::move(*setup);
  std::vector<Diagnostic> errors;
  for (auto& refusal : std::get<1>(planned)) errors.push_back(located(job, refusal.key, std::move(refusal.diagnostic)));
  return errors;
}

std::string summary_of(const ShaperSetup& s, const std::string& folder) {
  std::string out = fmt::format("shaper set-up of {} on {}\n", s.job_name, s.machine.name);
  out += fmt::format("  offset slide {:.4f} mm ({:.4f} deg by tan, {:.4f} deg by sin)\n", s.slide_mm, degrees(s.angle_tan_rad),
                     degrees(s.angle_sin_rad));
  out += fmt::format("  stroke {:.3f} mm, {:.3f} .. {:.3f}, {} double strokes/min\n", s.length_mm, s.start_mm, s.end_mm, s.strokes_set);
  if (s.machine.gearbox)
    out += fmt::format("  electronic gearbox {}{}/{}, read back from the program\n", s.sense < 0 ? "-" : "", s.generating.numerator, s.generating.denominator);
  else
    out += fmt::format("  index gears {}, feed gears {} ({:.5f} mm)\n", s.index_gears.text(), s.feed_gears.text(), s.circular_feed_set_mm);
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
  static const std::vector<std::string> names = {"limits.json", "shaper.json", "shaper.html", "shaper_program.", "report.json"};
  return names;
}

CommandOutcome run_shaper(const JobRequest& request) {
  Progress progress(request.quiet);
  StageClock clock(progress);
  auto output = OutputDir::open(request.out_dir, shaper_outputs(), {request.job_file}, kPreviousShaper);
  if (!output) return failed(output.error());
  auto read = read_face_gear_job(request.job_file, clock);
  if (auto* errors = std::get_if<1>(&read)) return failed(std::move(*errors));
  const auto& [job, gear] = std::get<0>(read);
  auto loaded = clock.run("machine", [&] { return load_shaper_machine(job); });
  if (auto* errors = std::get_if<1>(&loaded)) return failed(std::move(*errors));
  const ShaperMachine& machine = std::get<0>(loaded);
  auto planned = clock.run("shaper set-up", [&] { return plan_setup(job, gear, machine); });
  if (auto* errors = std::get_if<1>(&planned)) return failed(std::move(*errors));
  ShaperSetup& setup = std::get<0>(planned);
  if (const auto aside = output->set_aside(); !aside) return failed(aside.error());
  setup.warnings.insert(setup.warnings.begin(), gear.warnings().begin(), gear.warnings().end());
  setup.warnings.insert(setup.warnings.begin(), job.warnings.begin(), job.warnings.end());
  const auto study = clock.run("stroke simulation", [&] { return feed_study(setup, compared_feeds(setup)); });
  const std::string program_name = std::string("shaper_program") + shaper_program_extension(machine);
  const std::string program = clock.run("shaper program", [&] { return machine.gearbox ? shaper_gearbox_text(setup) : shaper_program_text(setup); });
  if (const auto written = output->write(program_name, program); !written) return failed(written.error());
  const auto bytes = output->read_back(program_name);
  if (!bytes) return failed(bytes.error());
  if (machine.gearbox) {
    const auto faults = clock.run("read back", [&] { return gearbox_program_faults(*bytes, setup); });
    std::vector<Diagnostic> errors;
    for (const auto& fault : faults) errors.push_back(fail_as(DiagnosticKind::verification, "{}: {}", program_name, fault));
    if (!errors.empty()) return failed(std::move(errors));
  }

  RunReport report;
  report.command = "shaper";
  report.job_name = job.name;
  report.job_file = job.file;
  report.machine_name = machine.name;
  report.machine_file = job.machine.file;
  report.dialect = machine.dialect;
  report.assumed = machine.assumed_keys;
  report.warnings = setup.warnings;
  report.program_file = program_name;
  report.program_sha256 = sha256_hex(program);
  report.program_bytes = program.size();
  report.blocks = static_cast<std::size_t>(std::count(program.begin(), program.end(), '\n'));
  report.feed_minutes = report.total_minutes = setup.total_min();
  const auto write = [&](const std::string& name, const std::string& content) -> Status {
    report.files.push_back(name);
    return output->write(name, content);
  };
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"limits.json", limits_json(gear)},
                                      {"shaper.json", shaper_json(setup, study)},
                                      {"shaper.html", shaper_html(setup, study)}})
    if (const auto written = write(name, content); !written) return failed(written.error());
  report.files.push_back(program_name);
  progress.clear();
  CommandOutcome outcome = finished_report(*output, clock, std::move(report), request.color);
  if (outcome.exit_code == ExitCode::ok) outcome.summary = summary_of(setup, request.out_dir);
  return outcome;
}

ValueOrErrors<ShaperSetup> shaper_setup_of(const Job& job, const FaceGear& gear) {
  auto loaded = load_shaper_machine(job);
  if (auto* errors = std::get_if<1>(&loaded)) return std::move(*errors);
  return plan_setup(job, gear, std::get<0>(loaded));
}

void add_shaper(Commands& commands) {
  commands.push_back(command_of<JobRequest>("shaper", "limits and gear-shaper set-up: sheet and stroke program", job_options, run_shaper));
}

}  // namespace toothpath
