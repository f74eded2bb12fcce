// What every command gets and what it gives back. Commands print nothing: app/command_line.cpp does.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/exit_code.h"
#include "app/stage_clock.h"

namespace toothpath {

struct CommandRequest {
  std::string job_file;
  std::string out_dir;
  std::string program_file;  ///< of `check`
  std::string restart;       ///< of `run`: "OP:TOOTH", both from 0; empty: from the beginning
  std::vector<std::string> stock_files, fixture_files;  ///< of `check`: meshes in the gear frame
  std::vector<std::string> measured_files;  ///< of `correct` and `check`: measured deviations, in the order of the cuts
  bool quiet = false;
  bool color = false;  ///< of the summary
  std::optional<int> pinion_teeth;  ///< of `contact`, as the next four: instead of the keys of [contact]
  std::optional<double> offset_error_mm, angle_error_deg, axial_error_mm, compound_um;
  bool as_cut = false;        ///< of `contact`: the surface that the job's operations cut, too
  std::string study_file;     ///< of `study dhfg`
  bool quick = false;  ///< studies: the short form
  int tool_number = 0;      ///< of `cutter`: draw this tool of the job; 0: the designed mill
  std::string other_job;    ///< of `cutter`: judge the mills of this job too; of `contact`: the mate of a bevel gear
  std::optional<double> wheel_axial_error_mm;  ///< of `contact` for bevel gears
  std::optional<double> tool_length_mm;  ///< of `machine test`: gauge line to the tip of the test bar
  std::optional<double> torque_Nm;  ///< of `forces`: on the gear of the job
};

struct CommandOutcome {
  ExitCode exit_code = ExitCode::ok;
  std::vector<Diagnostic> errors;
  std::string summary;      ///< for people, on stdout
  std::string report_json;  ///< the report as one JSON object; empty where there is none
};

/// An outcome from refusals: the exit code is that of the first.
[[nodiscard]] inline CommandOutcome failed(std::vector<Diagnostic> errors) {
  CommandOutcome outcome;
  outcome.exit_code = errors.empty() ? ExitCode::internal : exit_code_of(errors.front().kind);
  outcome.errors = std::move(errors);
  return outcome;
}
[[nodiscard]] inline CommandOutcome failed(Diagnostic error) { return failed(std::vector{std::move(error)}); }

}  // namespace toothpath
