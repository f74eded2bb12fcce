#include "app/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <thread>

#include "app/base/listed.h"
#include "app/base/out_of_memory.h"
#include "app/base/output_dir.h"
#include "app/command_tree.h"
#include "app/commands/command.h"
#include "app/help/completion.h"
#include "app/help/man_page.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/json_text.h"
#include "geometry/base/printable.h"
#include "machines/machine_file.h"
#include "machines/toml/near_name.h"

namespace toothpath {
namespace {

constexpr const char* kVersion = "toothpath " TOOTHPATH_VERSION;

struct GlobalOptions {
  bool json = false;
  bool quiet = false;
  std::optional<int> threads;  ///< none: as many as the machine has
  std::string color = "auto", progress = "auto";
};

bool terminal_with_color(int descriptor) {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return ::isatty(descriptor) != 0 && (!no_color || !*no_color) && terminal && std::string_view(terminal) != "dumb";
}

bool wants_color(const std::string& choice, int descriptor) {
  return choice == "always" || (choice == "auto" && terminal_with_color(descriptor));
}

/// Everything that came to stdout must have arrived: a full disk behind a redirection is an error of ours too. A reader
/// who has seen enough and went away (head) is none.
app::ExitCode print(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0)
    return app::ExitCode::ok;
  if (errno == EPIPE) return app::ExitCode::ok;
  std::fprintf(stderr, "error: cannot write to the standard output: %s\n", std::strerror(errno));
  return app::ExitCode::file_access;
}

constexpr std::size_t kMostErrors = 100;

/// The first of them, and how many there are beside them: a file may be wrong in every line.
std::vector<Diagnostic> shown(const std::vector<Diagnostic>& errors) {
  std::vector<Diagnostic> all(errors.begin(), errors.begin() + std::ptrdiff_t(std::min(errors.size(), kMostErrors)));
  if (errors.size() > kMostErrors) all.push_back(fail("{} more of them are not shown", errors.size() - kMostErrors));
  return all;
}

std::string outcome_json(const std::string& command, const commands::CommandOutcome& outcome) {
  nlohmann::ordered_json json;
  json["schema"] = 1;
  json["command"] = command;
  json["exit_code"] = static_cast<int>(outcome.exit_code);
  json["errors"] = nlohmann::ordered_json::array();
  for (const auto& error : shown(outcome.errors))
    json["errors"].push_back({{"file", svg::valid_utf8(error.position.file)},
                              {"line", error.position.line},
                              {"column", error.position.column},
                              {"message", svg::valid_utf8(error.message)}});
  if (const std::string note = app::OutputDir::closing_note(); !note.empty()) json["note"] = svg::valid_utf8(note);
  if (!outcome.report_json.empty()) json["report"] = nlohmann::ordered_json::parse(outcome.report_json);
  return json_text(json) + "\n";
}

/// Errors to stderr, the result to stdout.
int present(const std::string& command, const commands::CommandOutcome& outcome, const GlobalOptions& options) {
  const bool color = wants_color(options.color, STDERR_FILENO);
  for (const auto& error : shown(outcome.errors))
    std::fprintf(stderr, "%s%s%s\n", color ? "\033[31m" : "", error.text().c_str(), color ? "\033[0m" : "");
  if (const std::string note = app::OutputDir::closing_note();
      !note.empty() && (!options.quiet || outcome.exit_code != app::ExitCode::ok))
    std::fprintf(stderr, "note: %s\n", printable(note).c_str());
  std::fflush(stderr);
  app::ExitCode printed = app::ExitCode::ok;
  if (options.json) printed = print(outcome_json(command, outcome));
  else if (!options.quiet) printed = print(printable_lines(outcome.summary, wants_color(options.color, STDOUT_FILENO)));
  return static_cast<int>(outcome.exit_code == app::ExitCode::ok ? printed : outcome.exit_code);
}

commands::CommandOutcome internal_error(std::string message) {
  Diagnostic error;
  error.message = std::move(message);
  commands::CommandOutcome outcome;
  outcome.exit_code = app::ExitCode::internal;
  outcome.errors.push_back(std::move(error));
  return outcome;
}

commands::CommandOutcome guarded(const commands::Command::Action& action, const commands::CommonRequest& request) {
  try {
    return action(request);
  } catch (const std::bad_alloc&) { return internal_error(app::kOutOfMemory); } catch (const std::exception& error) {
    return internal_error(app::words_of(error));
  }
}

/// A command on the command line, below its group where it has one.
struct Subcommand {
  CLI::App* app = nullptr;
  std::string name;  ///< as the user writes it: "study stability"
  commands::Command::Action action;
};

CLI::App* add_group(CLI::App& app, const commands::CommandGroup& group) {
  CLI::App* added = app.add_subcommand(group.name, group.description);
  added->fallthrough();
  added->require_subcommand(1);
  return added;
}

std::vector<Subcommand> add_commands(CLI::App& app) {
  std::vector<Subcommand> added;
  std::map<std::string, CLI::App*> groups;
  for (const commands::Command& command : commands::all_commands()) {
    CLI::App* parent = &app;
    std::string name = command.name;
    if (command.group) {
      CLI::App*& group = groups[command.group->name];
      if (!group) group = add_group(app, *command.group);
      parent = group;
      name = command.group->name + (" " + name);
    }
    CLI::App* sub = parent->add_subcommand(command.name, command.description);
    sub->fallthrough();
    commands::OptionSet options(*sub);
    added.push_back({sub, std::move(name), command.set_up(options)});
  }
  return added;
}

std::string installed_names() {
  std::string names;
  for (const std::string& file : machines::installed_machines()) names += file.substr(0, file.rfind('.')) + "\n";
  return names;
}

/// Commands that print what is made of all the others: scripts of the shells, the manual page.
void add_self_description(CLI::App& app, std::vector<Subcommand>& commands) {
  const auto printing = [](std::function<std::string()> text) {
    return [text = std::move(text)](const commands::CommonRequest&) {
      commands::CommandOutcome outcome;
      outcome.summary = text();
      return outcome;
    };
  };
  const auto add = [&app](const char* name, const char* description, std::initializer_list<const char*> examples) {
    CLI::App* sub = app.add_subcommand(name, description);
    sub->fallthrough();
    commands::OptionSet(*sub).examples(examples);
    return sub;
  };
  CLI::App* manual = add("man-page", "prints the manual page as roff", {"man-page | man -l -"});
  commands.push_back({manual, manual->get_name(),
                      printing([&app] { return help::man_page(describe_program(app, kVersion), TOOTHPATH_DATE); })});
  CLI::App* completion = add("completion", "prints a script that completes commands and options in a shell",
                             {"completion bash > ~/.local/share/bash-completion/completions/toothpath"});
  auto what = std::make_shared<std::string>();
  completion->add_option("WHAT", *what, "the shell; machines: the names of the installed ones, for the scripts")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish", "machines"}));
  commands.push_back({completion, completion->get_name(), printing([&app, what] {
                        if (*what == "machines") return installed_names();
                        const help::Program program = describe_program(app, kVersion);
                        if (*what == "bash") return help::bash_completion(program);
                        return *what == "zsh" ? help::zsh_completion(program) : help::fish_completion(program);
                      })});
}

void add_global_options(CLI::App& app, GlobalOptions& options) {
  app.set_version_flag("--version", kVersion);
  app.add_flag("--json", options.json, "print one JSON object on stdout");
  app.add_flag("--quiet", options.quiet, "print errors only");
  commands::OptionSet(app).whole_number("--threads", options.threads, "number of threads (default: all)", {1, 1024});
  app.add_option("--color", options.color, "auto, always or never")->check(CLI::IsMember({"auto", "always", "never"}));
  app.add_option("--progress", options.progress, "auto: what a long run is at, on stderr; or never")
      ->check(CLI::IsMember({"auto", "never"}));
}

bool is_option(std::string_view word) { return word.starts_with('-') && word != "-"; }

/// The innermost command that the words reached.
const CLI::App& reached(const CLI::App& app) {
  const auto inner = app.get_subcommands();
  return inner.empty() ? app : reached(*inner.front());
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); }))
    names.push_back(command->get_name());
  return names;
}

/// Of the options and arguments that the command needs.
std::vector<std::string> missing_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options())
    if (option->get_required() && option->count() == 0) names.push_back(option->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* level = &app; level; level = level->get_parent())
    for (const CLI::Option* option : level->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// What is wrong with the words, as they were typed.
std::string usage_error(const CLI::App& app, const CLI::Error& error) {
  const auto kind = static_cast<CLI::ExitCodes>(error.get_exit_code());
  if (kind != CLI::ExitCodes::ExtrasError && kind != CLI::ExitCodes::RequiredError) return error.what();
  const CLI::App& at = reached(app);
  const std::vector<std::string> commands = command_names(at), left = app.remaining(true);
  const auto option = std::find_if(left.begin(), left.end(), is_option);
  if (option != left.end()) {
    const std::string name = option->substr(0, option->find('='));
    return fmt::format("unknown option {}{}", name, toml::did_you_mean(name, option_names(at)));
  }
  const std::string known =
      fmt::format("{}commands are: {}", &at == &app ? "" : at.get_name() + " ", fmt::join(commands, ", "));
  if (!commands.empty())
    return left.empty() ? "a command is missing; " + known
                        : fmt::format("unknown command \"{}\"{}; {}", left.front(),
                                      toml::did_you_mean(left.front(), commands), known);
  if (!left.empty()) return fmt::format("\"{}\" is one word too many", left.front());
  const std::vector<std::string> missing = missing_names(at);
  return missing.empty() ? error.what()
                         : fmt::format("{} {} required", app::listed(missing), missing.size() == 1 ? "is" : "are");
}

}  // namespace

int run_command_line(int argc, char** argv) {
  CLI::App app{"Tool paths for gear teeth, from gear parameters to a checked NC program.", "toothpath"};
  GlobalOptions options;
  add_global_options(app, options);
  app.footer(
      "Exit codes: 0 done and verified, 1 not verified (no program is left), 2 usage, 3 an input file is refused, 4 a "
      "file cannot be read or\n"
      "written, 70 internal error or out of memory, 130 interrupted. `toothpath COMMAND --help` lists the options of a "
      "command.");
  app.failure_message([](const CLI::App* at, const CLI::Error& error) {
    return printable(usage_error(*at, error)) + "\nRun with --help for more information.\n";
  });
  app.require_subcommand(0, 1);
  auto commands = add_commands(app);
  add_self_description(app, commands);

  try {
    app.parse(argc, argv);
    if (app.get_subcommands().empty()) throw CLI::CallForHelp();
  } catch (const CLI::ParseError& error) {
    const bool help = error.get_exit_code() == 0 && argc > 1;
    std::ostringstream text;
    app.exit(error, text, std::cerr);
    const app::ExitCode printed = print(text.str());
    return static_cast<int>(help ? printed : app::ExitCode::usage);
  }

  const commands::CommonRequest request{options.quiet || options.json || options.progress == "never",
                                        wants_color(options.color, STDOUT_FILENO)};
  std::optional<tbb::global_control> threads;
  if (options.threads)
    threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(*options.threads));
  for (const auto& [sub, name, action] : commands)
    if (sub->parsed()) {
      if (options.json)
        app::set_out_of_memory_answers(outcome_json(name, internal_error(app::kOutOfMemory)),
                                       outcome_json(name, internal_error(app::kOutOfMemoryAtTheEnd)));
      return present(name, guarded(action, request), options);
    }
  return static_cast<int>(app::ExitCode::internal);
}

}  // namespace toothpath
