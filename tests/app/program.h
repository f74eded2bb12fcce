// Runs the toothpath binary as a user would, and looks at what it leaves.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace toothpath::test {

inline const std::string kSamples = TOOTHPATH_SOURCE_DIR "/samples";
inline const std::string kQuick = kSamples + "/spur_quick.toml";
inline const std::string kMachines = TOOTHPATH_SOURCE_DIR "/machines/data";
inline const std::string kBadJobs = TOOTHPATH_SOURCE_DIR "/tests/bad_jobs";

/// spur_quick with a contour tolerance that is larger than its gouge tolerance: planned, written and not verified.
inline std::string not_verified_job() {
  return replaced(file_text(kQuick), "file = \"xyzac_large.toml\"",
                  "file = \"siemens_ac.toml\"\naccept_assumed = true") +
         "\n[program]\ncontour_tolerance = 0.01\n";
}

struct Finished {
  int exit_code = -1;  ///< -1: ended by a signal
  std::string out, err;
};

struct Launch {
  std::vector<std::string> arguments;
  std::string stdout_file;  ///< instead of the captured one: "/dev/full"
  rlim_t largest_file = RLIM_INFINITY;
  rlim_t address_space = RLIM_INFINITY;  ///< bytes
  int signal_number = 0;                 ///< sent after `signal_after_ms`
  int signal_after_ms = 0;
  bool with_progress = false;
  std::string signal_when;  ///< instead: when this file or folder is there (at most a minute is waited)
  std::function<void()> before_signal = [] {};
  std::function<void()> in_child = [] {};  ///< before the program begins: its environment, its directory
};

inline Finished run_program(const Launch& launch) {
  const TestDir dir;
  const std::string out = launch.stdout_file.empty() ? dir / "out" : launch.stdout_file, err = dir / "err";
  std::vector<std::string> words = {TOOTHPATH_BINARY};
  // What a slow machine would say beside what is looked for.
  if (!launch.arguments.empty() && !launch.with_progress) words.insert(words.end(), {"--progress", "never"});
  words.insert(words.end(), launch.arguments.begin(), launch.arguments.end());
  std::vector<char*> argv;
  for (auto& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
    if (launch.largest_file != RLIM_INFINITY) {
      const rlimit limit{launch.largest_file, launch.largest_file};
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    if (launch.address_space != RLIM_INFINITY) {
      const rlimit limit{launch.address_space, launch.address_space};
      ::setrlimit(RLIMIT_AS, &limit);
    }
    launch.in_child();
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  if (launch.signal_number != 0) {
    ::usleep(static_cast<useconds_t>(launch.signal_after_ms) * 1000);
    for (int k = 0; k < 60'000 && !launch.signal_when.empty() && ::access(launch.signal_when.c_str(), F_OK) != 0; ++k)
      ::usleep(1000);
    launch.before_signal();
    ::kill(child, launch.signal_number);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  Finished result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (launch.stdout_file.empty()) result.out = file_text(out);
  result.err = file_text(err);
  return result;
}

inline Finished run_program(std::vector<std::string> arguments) {
  Launch launch;
  launch.arguments = std::move(arguments);
  return run_program(launch);
}

/// Names in a directory, hidden ones too; empty where it does not exist.
inline std::vector<std::string> names_in(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace toothpath::test
