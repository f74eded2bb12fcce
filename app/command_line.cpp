#include "app/command_line.h"

#include <tbb/global_control.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "app/commands/check.h"
#include "app/commands/compare.h"
#include "app/commands/contact.h"
#include "app/commands/cutter.h"
#include "app/commands/forces.h"
#include "app/commands/machine.h"
#include "app/commands/shaper.h"
#include "app/commands/run.h"
#include "app/commands/study_dhfg.h"
#include "app/commands/study_stability.h"
#include "app/commands/study_trace_model.h"
#include "app/commands/study_work_precision.h"
#include "app/commands/surface.h"
#include "app/output_dir.h"
#include "app/report/html_text.h"

namespace toothpath {
namespace {

constexpr const char* kVersion = "toothpath " TOOTHPATH_VERSION;

struct GlobalOptions {
  bool json = false;
  bool quiet = false;
  int threads = 0;  ///< 0: as many as the machine has
  std::string color = "auto";
};

using Command = std::function<CommandOutcome(const CommandRequest&)>;

bool terminal_with_color(int descriptor) {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return ::isatty(descriptor) != 0 && (!no_color || !*no_color) && terminal && std::string_view(terminal) != "dumb";
}

bool wants_color(const std::string& choice, int descriptor) {
  return choice == "always" || (choice == "auto" && terminal_with_color(descriptor));
}

/// Everything that came to stdout must have arrived: a full disk behind a redirection is an error of ours too.
bool print(std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0;
}

std::string outcome_json(const std::string& command, const CommandOutcome& outcome) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["command"] = command;
  json["exit_code"] = static_cast<int>(outcome.exit_code);
  json["errors"] = nlohmann::ordered_json::array();
  for (const auto& error : outcome.errors)
    json["errors"].push_back({{"file", valid_utf8(error.position.file)},
                              {"line", error.position.line},
                              {"column", error.position.column},
                              {"message", valid_utf8(error.message)}});
  if (const std::string note = OutputDir::closing_note(); !note.empty()) json["note"] = valid_utf8(note);
  if (!outcome.report_json.empty()) json["report"] = nlohmann::ordered_json::parse(outcome.report_json);
  return json.dump() + "\n";
}

/// Errors to stderr, the result to stdout.
int present(const std::string& command, const CommandOutcome& outcome, const GlobalOptions& options) {
  const bool color = wants_color(options.color, STDERR_FILENO);
  for (const auto& error : outcome.errors)
    std::fprintf(stderr, "%s%s%s\n", color ? "\033[31m" : "", error.text().c_str(), color ? "\033[0m" : "");
  if (const std::string note = OutputDir::closing_note(); !note.empty() && (!options.quiet || outcome.exit_code != ExitCode::ok))
    std::fprintf(stderr, "note: %s\n", note.c_str());
  std::fflush(stderr);
  bool printed = true;
  if (options.json) printed = print(outcome_json(command, outcome));
  else if (!options.quiet) printed = print(outcome.summary);
  if (!printed && outcome.exit_code == ExitCode::ok) {
    std::fputs("error: cannot write to the standard output\n", stderr);
    return static_cast<int>(ExitCode::file_access);
  }
  return static_cast<int>(outcome.exit_code);
}

CommandOutcome internal_error(std::string message) {
  Diagnostic error;
  error.message = std::move(message);
  CommandOutcome outcome;
  outcome.exit_code = ExitCode::internal;
  outcome.errors.push_back(std::move(error));
  return outcome;
}

CommandOutcome guarded(const Command& command, const CommandRequest& request) {
  try {
    return command(request);
  } catch (const std::bad_alloc&) {
    return internal_error("out of memory");
  } catch (const std::exception& error) {
    return internal_error(fmt::format("internal error: {}", error.what()));
  }
}

/// A whole number in a range; the library's own check prints limits that nobody can read.
std::string check_threads(const std::string& text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && end == text.data() + text.size() && value >= 1 && value <= 1024) return {};
  return "--threads = " + text + " is not a whole number from 1 to 1024";
}

struct Subcommand {
  CLI::App* app = nullptr;
  Command command;
};

/// Adds a command of the form `name JOB --out DIR`.
Subcommand add_job_command(CLI::App& app, const char* name, const char* description, CommandRequest& request, Command command) {
  CLI::App* sub = app.add_subcommand(name, description);
  sub->fallthrough();
  sub->add_option("JOB", request.job_file, "job file (TOML)")->required()->type_name("FILE");
  sub->add_option("--out", request.out_dir, "directory for the results; made where it does not exist")->required()->type_name("DIR");
  return {sub, std::move(command)};
}

/// `study work-precision JOB` and `study stability`: commands below a command.
std::vector<Subcommand> add_studies(CLI::App& app, CommandRequest& request) {
  CLI::App* study = app.add_subcommand("study", "error against run time, extreme cases, section models, double helical gears");
  study->fallthrough();
  study->require_subcommand(1);
  auto work_precision = add_job_command(*study, "work-precision", "vary the tolerances of a job: what they cost and what they buy", request, study_work_precision);
  work_precision.app->add_flag("--quick", request.quick, "three factors a tolerance instead of five, and none for all together");
  CLI::App* stability = study->add_subcommand("stability", "extreme gears and machine poses, double against 50 digits");
  stability->fallthrough();
  stability->add_option("--out", request.out_dir, "directory for the results; made where it does not exist")->required()->type_name("DIR");
  auto trace_model = add_job_command(*study, "trace-model", "section-sweep models of a bevel gear against its envelope", request, study_trace_model);
  trace_model.app->add_flag("--quick", request.quick, "a coarser grid");
  CLI::App* dhfg = study->add_subcommand("dhfg", "nine orthogonal trials of double helical face gears: limits, contact, forces, milling time");
  dhfg->fallthrough();
  dhfg->add_option("--file", request.study_file, "study file (TOML); without it the literature's levels and no milling")->type_name("FILE");
  dhfg->add_option("--out", request.out_dir, "directory for the results; made where it does not exist")->required()->type_name("DIR");
  dhfg->add_flag("--quick", request.quick, "coarse tolerances of the planned paths");
  return {work_precision, {stability, study_stability}, trace_model, {dhfg, study_dhfg}};
}

/// `machine show MACHINE`: commands below a command.
std::vector<Subcommand> add_machine_commands(CLI::App& app, CommandRequest& request) {
  CLI::App* machine = app.add_subcommand("machine", "what a machine file says, and how to prove it");
  machine->fallthrough();
  machine->require_subcommand(1);
  CLI::App* show = machine->add_subcommand("show", "limits, chain, senses and assumed values of a machine");
  show->fallthrough();
  show->add_option("MACHINE", request.job_file, "machine file (TOML), or the name of an installed one")->required()->type_name("FILE");
  show->add_option("--out", request.out_dir, "directory for machine.html and machine.svg; without it only the text is printed")->type_name("DIR");
  CLI::App* test = machine->add_subcommand("test", "program that holds the tip of a test bar on one point while the rotary axes turn: run it in air");
  test->fallthrough();
  test->add_option("MACHINE", request.job_file, "machine file (TOML), or the name of an installed one")->required()->type_name("FILE");
  test->add_option("--out", request.out_dir, "directory for the program and its page; made where it does not exist")->required()->type_name("DIR");
  test->add_option("--tool-length", request.tool_length_mm, "gauge line to the tip of the test bar, mm (default: 100, 60 or 30, what fits)");
  return {{show, show_machine}, {test, test_machine}};
}

/// `cutter JOB` and `forces JOB`: bevel gears.
std::vector<Subcommand> add_bevel_commands(CLI::App& app, CommandRequest& request) {
  auto cutter = add_job_command(app, "cutter", "designs the finger mill of a bevel gear and judges the mills that are there", request, run_cutter);
  cutter.app->add_option("--tool", request.tool_number, "draw this tool of the job instead of the designed mill");
  cutter.app->add_option("--cutter-of", request.other_job, "judge the mills of this other job too, as they were made for its gear")->type_name("JOB");
  auto forces = add_job_command(app, "forces", "tooth forces of a bevel pair over the apex cone distance, and what balances them", request, run_forces);
  forces.app->add_option("--torque", request.torque_Nm, "torque on the gear of the job [N m]; overrides torque in its [load]")->check(CLI::Range(1e-6, 1e9));
  return {cutter, forces};
}

/// `contact JOB`: the pinion and where it stands.
Subcommand add_contact(CLI::App& app, CommandRequest& request) {
  auto contact = add_job_command(app, "contact", "gear and pinion rolled: contact pattern, transmission error, pairs", request, run_contact);
  contact.app->add_option("--pinion-teeth", request.pinion_teeth, "teeth of the pinion (default: mate_teeth, else the shaper's)");
  contact.app->add_option("--offset-error", request.offset_error_mm, "pinion axis off its place across the tooth, mm");
  contact.app->add_option("--angle-error", request.angle_error_deg, "error of the shaft angle, deg");
  contact.app->add_option("--axial-error", request.axial_error_mm, "pinion off its place along its axis, mm");
  contact.app->add_option("--compound", request.compound_um, "thickness of the marking compound, um (default 6)");
  contact.app->add_option("--mate", request.other_job, "bevel gears: job of the mate (default: by the rules of the pair, same mill)")->type_name("JOB");
  contact.app->add_option("--wheel-axial-error", request.wheel_axial_error_mm, "bevel gears: wheel off its place along its axis, mm");
  contact.app->add_flag("--as-cut", request.as_cut, "roll the surface that the job cuts, too");
  return contact;
}

/// `compare SHAPED MILLED`: one gear, two routes.
Subcommand add_compare(CLI::App& app, CommandRequest& request) {
  CLI::App* compare = app.add_subcommand("compare", "one gear shaped and milled: deviations on the same places, times");
  compare->fallthrough();
  compare->add_option("SHAPED", request.job_file, "job file with [shaping]")->required()->type_name("FILE");
  compare->add_option("MILLED", request.other_job, "job file with operations of the same gear")->required()->type_name("FILE");
  compare->add_option("--out", request.out_dir, "directory for the results; made where it does not exist")->required()->type_name("DIR");
  return {compare, run_compare};
}

void add_global_options(CLI::App& app, GlobalOptions& options) {
  app.set_version_flag("--version", kVersion);
  app.add_flag("--json", options.json, "print one JSON object on stdout");
  app.add_flag("--quiet", options.quiet, "print errors only");
  app.add_option("--threads", options.threads, "number of threads (default: all)")->check(CLI::Validator(check_threads, "N", "threads"));
  app.add_option("--color", options.color, "auto, always or never")->check(CLI::IsMember({"auto", "always", "never"}));
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app{"Tool paths for gear teeth, from gear parameters to a checked NC program.", "toothpath"};
  GlobalOptions options;
  CommandRequest request;
  add_global_options(app, options);
  app.footer("Exit codes: 0 done and verified, 1 not verified (no program is left), 2 usage, 3 an input file is refused, 4 a file cannot be read or\n"
             "written, 70 internal error, 130 interrupted. `toothpath COMMAND --help` lists the options of a command.");
  app.require_subcommand(0, 1);
  std::vector<Subcommand> commands;
  commands.push_back(add_job_command(app, "run", "the whole way from the job to a proven NC program", request, run_job));
  commands.back().app->add_option("--restart", request.restart, "operation and tooth, both from 0: the program begins there; what comes before is taken as done")->type_name("OP:TOOTH");
  commands.push_back(add_job_command(app, "check", "proves a program that is already there against the job's gear", request, check_program));
  commands.back().app->add_option("PROGRAM", request.program_file, "NC program in the dialect of the job's machine")->required()->type_name("FILE");
  commands.back().app->add_option("--stock", request.stock_files, "closed mesh of the stock before the program (STL or OBJ, mm, gear frame); repeatable")->type_name("FILE");
  commands.back().app->add_option("--fixture", request.fixture_files,
                                  "closed mesh of what holds the work and turns with it (STL or OBJ, mm, gear frame); repeatable. Facets are taken as exact: "
                                  "what they leave out of the true part must lie within the clearance of the job")
      ->type_name("FILE");
  commands.back().app->add_option("--measured", request.measured_files, "measured deviations that the program answers (see correct)")->type_name("FILE");
  commands.push_back(add_job_command(app, "correct", "the whole way again, with flanks that answer a measurement", request, run_job));
  commands.back().app->add_option("--measured", request.measured_files, "measured grid: inspection.csv with a column deviation_um; several: one after each cut")
      ->required()
      ->type_name("FILE");
  commands.push_back(add_job_command(app, "surface", "flanks, limits, inspection grid and mesh of the gear", request, run_surface));
  commands.push_back(add_job_command(app, "shaper", "limits and gear-shaper set-up: sheet and stroke program", request, run_shaper));

  for (auto& command : add_bevel_commands(app, request)) commands.push_back(std::move(command));
  commands.push_back(add_contact(app, request));
  commands.push_back(add_compare(app, request));
  for (auto& command : add_studies(app, request)) commands.push_back(std::move(command));
  for (auto& command : add_machine_commands(app, request)) commands.push_back(std::move(command));

  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::CallForHelp();
  } catch (const CLI::ParseError& error) {
    const bool help = error.get_exit_code() == 0 && argc > 1;
    app.exit(error);
    return static_cast<int>(help ? ExitCode::ok : ExitCode::usage);
  }

  request.quiet = options.quiet || options.json;
  request.color = wants_color(options.color, STDOUT_FILENO);
  std::optional<tbb::global_control> threads;
  if (options.threads > 0)
    threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
  for (const auto& [sub, command] : commands)
    if (sub->parsed()) {
      const bool top = sub->get_parent() == &app;
      return present(top ? sub->get_name() : sub->get_parent()->get_name() + " " + sub->get_name(), guarded(command, request), options);
    }
  return static_cast<int>(ExitCode::internal);
}

}  // namespace toothpath
