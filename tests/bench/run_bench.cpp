// Whole runs of the program: processor and wall time, peak memory, and beside them what they found. Every job is run on
// one thread and on all, one after the other, so that the rows of a job can be compared; both must write the same
// program.
//
//   toothpath_run_bench [JOB.toml ...]      without a job: the samples that finish with ball mills and by the line, and
//   a bevel gear whose 60 teeth stand off the C axis and are written out: as a multiple of the same gear on the axis,
//   where one tooth stands for all
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
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
/// @param one  processor seconds on one thread
bool rows(const std::string& job, int all, const fs::path& dir, double& one) {
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
  one = runs[0].cpu;
  const bool same = runs[0].exit_code == 0 && runs[1].exit_code == 0 && runs[0].program == runs[1].program;
  if (!same) std::printf("%s: not the same program on %d threads as on one\n", job.c_str(), all);
  else
    std::printf("%-28s     processor time of all threads %.2f of one, wall time %.2f\n", "", runs[1].cpu / runs[0].cpu,
                runs[1].wall / runs[0].wall);
  return same;
}

/// Writes the bevel wheel of the samples with 60 teeth. Ends the program where the sample has no such line any more.
std::string bevel_job(const char* machine, const char* origin, const fs::path& dir) {
  std::string text = text_of(fs::path(TOOTHPATH_SAMPLES) / "bevel_wheel.toml");
  const std::pair<const char*, std::string> lines[] = {
      {"teeth", "60"},
      {"mate_teeth", "29"},
      {"face_width", "58.0"},
      {"apex_cone_distance", "168.5"},
      {"origin", origin},
      {"work_offset_at", origin},
      {"file", '"' + std::string(machine) + "\"\naccept_assumed = true"}};
  for (const auto& [key, value] : lines) {
    const std::regex line("(^|\n)" + std::string(key) + " = [^\n]*");
    if (!std::regex_search(text, line)) {
      std::fprintf(stderr, "bevel_wheel.toml has no line %s\n", key);
      std::exit(1);
    }
    text = std::regex_replace(text, line, "$1" + std::string(key) + " = " + value,
                              std::regex_constants::format_first_only);
  }
  fs::create_directories(dir);
  const fs::path job = dir / ("bevel_60_" + std::string(machine) + ".toml");
  std::ofstream(job) << text;
  return job.string();
}

/// Teeth that are written out, beside the same teeth as copies of one.
bool bevel_rows(int all, const fs::path& dir, const fs::path& jobs) {
  double copies = 0;
  bool good = rows(bevel_job("xyzac_large", "[3.0, -2.0, 260.0]", jobs), all, dir, copies);
  for (const char* machine : {"fanuc_ac", "haas_ac"}) {
    double written = 0;
    good = rows(bevel_job(machine, "[43.0, -22.0, 260.0]", jobs), all, dir, written) && good;
    if (copies > 0)
      std::printf("%-28s     60 teeth one by one: %.2f times the processor time of 60 copies of one\n", "",
                  written / copies);
  }
  fs::remove_all(jobs);
  return good;
}

}  // namespace

int main(int count, char** words) {
  std::vector<std::string> jobs(words + 1, words + count);
  const bool own = jobs.empty();
  if (own)
    for (const char* name : {"dhfg_ball", "dhfg_paper", "dhfg_t600s", "short_tool"})
      jobs.push_back(std::string(TOOTHPATH_SAMPLES) + "/" + name + ".toml");
  const int all = std::max(2, int(std::thread::hardware_concurrency()));
  const fs::path dir = fs::temp_directory_path() / ("toothpath_run_bench." + std::to_string(getpid()));
  std::printf("%-28s %3s %8s %8s %8s %9s | %8s %8s %8s %9s\n", "job", "thr", "cpu s", "wall s", "cpu/wall", "peak MB",
              "gouge um", "bound um", "left um", "bytes");
  bool good = true;
  double one = 0;
  for (const std::string& job : jobs) good = rows(job, all, dir, one) && good;
  if (own) good = bevel_rows(all, dir, dir.string() + ".jobs") && good;
  fs::remove_all(dir);
  return good ? 0 : 1;
}
