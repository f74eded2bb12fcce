// `toothpath check JOB PROGRAM --out DIR`: proves a program that is already there against the job's gear.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/commands/command.h"
#include "app/job/measured_file.h"
#include "app/process/scene.h"
#include "app/report/run_report.h"

namespace toothpath::commands {

struct CheckRequest : JobRequest, process::SceneFiles {
  std::string program_file;
  job::MeasuredInput measured;  ///< what the flanks that the program cuts answer
};

/// Reads any NC program in the dialect of the job's machine back and checks it: gouges, clearance, rapids, left
/// material, and feeds, speeds, tools, coolant and the line HASH against what the job asks and the machine can. Writes
/// report.json, report.html, tooth.vtp and a set-up sheet of its own (setup_check.html), verified or not; the program
/// itself is never touched. Exit: verified or unverified.
[[nodiscard]] CommandOutcome check_program(const CheckRequest& request);

struct ProgramCheck;

/// A job, its machine and meshes, read once for programs that are checked one after another; nothing is written.
class ProgramChecker {
 public:
  /// @param request  without a program; its directory is not asked for
  explicit ProgramChecker(const CheckRequest& request);
  ~ProgramChecker();
  /// What of the job, the machine or the meshes is refused; without errors programs may be proven.
  [[nodiscard]] std::vector<Diagnostic> read();
  /// What `check_program` reports of this text. Errors: what the reader refuses, located in `file`.
  [[nodiscard]] Result<report::RunReport> prove(std::string text, const std::string& file);

 private:
  std::unique_ptr<ProgramCheck> check_;
};

}  // namespace toothpath::commands
