// `toothpath check JOB PROGRAM --out DIR`: proves a program that is already there against the job's gear.
#pragma once

#include "app/commands/command.h"
#include "app/job/measured_file.h"
#include "app/process/scene.h"

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

}  // namespace toothpath::commands
