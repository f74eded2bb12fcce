// Whole runs of the program: processor and wall time, peak memory, and beside them what they found. Every job is run on
// one thread and on all, one after the other, so that the rows of a job can be compared; both must write the same
// program.
//
//   toothpath_run_bench [JOB.toml ...]      without a job: the samples that finish with ball mills and by the line
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

struct Run {
  int exit_code = -1;
  double wall = 0, cpu = 0, peak_mb = 0;
  nlohmann::json report;
  std::string program;
};

double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

Run run(const std::string& job, int threads, const fs::path& dir) {
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    const std::string count = std::to_string(threads);
    execl(TOOTHPATH_PROGRAM, TOOTHPATH_PROGRAM, "run", job.c_str(), "--out", dir.c_str(), "--threads", count.c_str(),
          "--quiet", nullptr);
    _exit(127);
  }
  Run out;
  int status = 0;
  rusage used{};
  if (child < 0 || wait4(child, &status, 0, &used) != child) return out;
  out.wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  out.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  out.cpu = seconds(used.ru_utime) + seconds(used.ru_stime);
  out.peak_mb = double(used.ru_maxrss) / 1024;
  out.report = nlohmann::json::parse(text_of(dir / "report.json"), nullptr, false);
  if (out.exit_code == 0) out.program = text_of(dir / out.report["program"]["file"].get<std::string>());
  return out;
}

/// @return did both runs end well, with the same program?
bool rows(const std::string& job, int all, const fs::path& dir) {
  std::vector<Run> runs;
  for (const int threads : {1, all}) {
    fs::remove_all(dir);
    runs.push_back(run(job, threads, dir));
    const Run& r = runs.back();
    std::printf("%-28s %3d %8.2f %8.2f %8.2f %9.0f", fs::path(job).stem().c_str(), threads, r.cpu, r.wall,
                r.cpu / r.wall, r.peak_mb);
    if (r.exit_code == 0)
      std::printf(" | %8.2f %8.2f %8.2f %9zu", r.report["gouge_um"]["measured"].get<double>(),
                  r.report["gouge_um"]["bound"].get<double>(), r.report["excess_um"]["finished"]["max"].get<double>(),
                  r.program.size());
    else std::printf(" | exit code %d", r.exit_code);
    std::printf("\n");
    std::fflush(stdout);
  }
  const bool same = runs[0].exit_code == 0 && runs[1].exit_code == 0 && runs[0].program == runs[1].program;
  if (!same) std::printf("%s: not the same program on %d threads as on one\n", job.c_str(), all);
  else
    std::printf("%-28s     processor time of all threads %.2f of one, wall time %.2f\n", "", runs[1].cpu / runs[0].cpu,
                runs[1].wall / runs[0].wall);
  return same;
}

}  // namespace

int main(int count, char** words) {
  std::vector<std::string> jobs(words + 1, words + count);
  if (jobs.empty())
    for (const char* name : {"dhfg_ball", "dhfg_paper", "dhfg_t600s", "short_tool"})
      jobs.push_back(std::string(TOOTHPATH_SAMPLES) + "/" + name + ".toml");
  const int all = std::max(2, int(std::thread::hardware_concurrency()));
  const fs::path dir = fs::temp_directory_path() / ("toothpath_run_bench." + std::to_string(getpid()));
  std::printf("%-28s %3s %8s %8s %8s %9s | %8s %8s %8s %9s\n", "job", "thr", "cpu s", "wall s", "cpu/wall", "peak MB",
              "gouge um", "bound um", "left um", "bytes");
  bool good = true;
  for (const std::string& job : jobs) good = rows(job, all, dir) && good;
  fs::remove_all(dir);
  return good ? 0 : 1;
}
