// What a command is: its name, its options, what it does with them and what it gives back. Commands print nothing:
// app/command_line.cpp does.
//
// A command stands in one file of this folder, which ends with
//
//     void add_surface(Commands& commands) {
//       commands.push_back(command_of<JobRequest>("surface", "limits, inspection points and meshes of the gear",
//       job_options, run_surface));
//     }
//
// and in the list of commands in app/CMakeLists.txt, where `surface` stands for commands/surface.cpp and add_surface().
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "app/base/outcome.h"
#include "app/base/stage_clock.h"
#include "app/commands/option_set.h"

namespace toothpath::commands {

/// What every command gets, whatever its own options.
struct CommonRequest {
  bool quiet = false;
  bool color = false;  ///< of the summary
};

/// Of the commands `name JOB [--out DIR]`; others build theirs on it.
struct JobRequest : CommonRequest {
  std::string job_file;
  std::string out_dir;
};

using app::CommandOutcome;
using app::failed;

/// A refused input without a place is something in the job: what found it knew no file.
inline void name_file(std::vector<Diagnostic>& errors, const std::string& job_file) {
  for (Diagnostic& error : errors)
    if (error.position.file.empty() && error.kind == DiagnosticKind::refused_input) error.position.file = job_file;
}

/// A standard folder that cannot be written: its user gave no --out, and may not know that there is one.
inline void name_out(std::vector<Diagnostic>& errors, const std::string& out_dir) {
  for (Diagnostic& error : errors)
    if (error.kind == DiagnosticKind::file_access && error.position.file == out_dir)
      error.message += "; --out DIR gives another folder";
}

/// Commands below a command: `study stability`.
struct CommandGroup {
  const char* name;
  const char* description;
};
inline constexpr CommandGroup kStudies = {"study",
                                          "error against run time, milling strategies, extreme cases, section models, "
                                          "double helical gears, errors of the machine"};
inline constexpr CommandGroup kReferences = {"reference", "all keys of job files and machine files"};
inline constexpr CommandGroup kMachines = {"machine", "what a machine file says, and programs that test it"};

struct Command {
  using Action = std::function<CommandOutcome(const CommonRequest&)>;
  const CommandGroup* group = nullptr;
  const char* name = "";
  const char* description = "";
  /// Adds the options; the action is called after they have been read.
  std::function<Action(OptionSet&)> set_up;
};
using Commands = std::vector<Command>;

/// A command whose request is a `Request` (a CommonRequest with more).
/// @param options  void(OptionSet&, Request&): what the command line fills in;  @param run  CommandOutcome(const
/// Request&)
template <typename Request, typename Options, typename Run>
[[nodiscard]] Command command_of(const char* name, const char* description, Options options, Run run,
                                 const CommandGroup* group = nullptr) {
  return {group, name, description, [options, run](OptionSet& set) -> Command::Action {
            auto request = std::make_shared<Request>();
            options(set, *request);
            return [request, run, out = set.out_dir()](const CommonRequest& common) {
              static_cast<CommonRequest&>(*request) = common;
              std::string job_file;
              if constexpr (std::is_base_of_v<JobRequest, Request>) job_file = request->job_file;
              const bool standard = out.value && out.value->empty();
              if (standard) *out.value = standard_out_dir(job_file, out.below);
              CommandOutcome outcome = run(*request);
              if (standard) name_out(outcome.errors, *out.value);
              if constexpr (std::is_base_of_v<JobRequest, Request>) name_file(outcome.errors, request->job_file);
              return outcome;
            };
          }};
}

/// JOB and --out.
inline void job_options(OptionSet& set, JobRequest& request) {
  set.file("JOB", request.job_file, "job file (TOML)");
  set.out_dir(request.out_dir);
}

/// All commands in the order of the list in app/CMakeLists.txt, which makes the text of this function.
[[nodiscard]] Commands all_commands();

}  // namespace toothpath::commands
