// Whole runs of the program: processor and wall time, peak memory, and beside them what they found. Every job is run on
// one thread and on all, one after the other, so that the rows of a job can be compared; both must write the same
// program.
//
//   toothpath_run_bench --stages [JOB.toml ...]   wall seconds of every stage on 1, 2, 4 .. threads, and what of it no
//   second thread takes: where a thread takes t1 and n take tn, s = (n tn - t1) / (n - 1) by Amdahl's rule; 16 threads
//   would take s + (t1 - s) / 16
//   toothpath_run_bench [JOB.toml ...]      without a job: the samples that finish with ball mills and by the line, and
//   a bevel gear whose 60 teeth stand off the C axis and are written out: as a multiple of the same gear on the axis,
//   where one tooth stands for all
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
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

constexpr int kRepeats = 3;  // the fastest counts
constexpr int kWanted = 16;
constexpr double kShownStage = 0.02;  // s

/// Seconds of the stages, in their order, and of the whole run as the last one.
using Stages = std::vector<std::pair<std::string, double>>;

Stages fastest(const std::string& job, int threads, const fs::path& dir, std::string& program) {
  Stages best;
  for (int k = 0; k < kRepeats; ++k) {
    fs::remove_all(dir);
    const Run r = run(job, threads, dir);
    if (r.exit_code != 0) return {};
    program = r.program;
    Stages now;
    // In the order in which they ran, which `Run::report` does not keep.
    const auto ordered = nlohmann::ordered_json::parse(text_of(dir / "report.json"));
    for (const auto& [name, seconds] : ordered["stages"].items()) now.emplace_back(name, seconds.get<double>());
    now.emplace_back("run", r.wall);
    if (best.empty()) best = now;
    for (std::size_t n = 0; n < best.size() && n < now.size(); ++n)
      best[n].second = std::min(best[n].second, now[n].second);
  }
  return best;
}

/// @return did all runs end well, with the same program?
bool stage_rows(const std::string& job, int all, const fs::path& dir) {
  std::vector<int> threads;
  for (int n = 1; n < all; n *= 2) threads.push_back(n);
  threads.push_back(all);
  std::vector<Stages> of;
  std::string first, program;
  for (const int n : threads) {
    of.push_back(fastest(job, n, dir, program));
    if (of.back().empty() || of.back().size() != of.front().size() || (n > 1 && program != first)) {
      std::printf("%s: no run, or another program, on %d threads\n", job.c_str(), n);
      return false;
    }
    if (n == 1) first = program;
  }
  std::printf("%-28s", fs::path(job).stem().c_str());
  for (const int n : threads) std::printf(" %4d thr", n);
  std::printf("    alone  %2d thr\n", kWanted);
  for (std::size_t k = 0; k < of.front().size(); ++k) {
    const double one = of.front()[k].second, most = of.back()[k].second;
    if (one < kShownStage) continue;
    const double alone = std::clamp((all * most - one) / (all - 1), 0.0, one);
    std::printf("  %-26s", of.front()[k].first.c_str());
    for (const Stages& stages : of) std::printf(" %8.2f", stages[k].second);
    std::printf(" %8.2f %7.2f\n", alone, alone + (one - alone) / kWanted);
  }
  std::fflush(stdout);
  return true;
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
  const bool stages = !jobs.empty() && jobs.front() == "--stages";
  if (stages) jobs.erase(jobs.begin());
  const bool own = jobs.empty();
  const std::vector<const char*> names =
      stages ? std::vector{"dhfg_paper", "dhfg_t600s", "dhfg_ball", "offset_line", "spiral_bevel"}
             : std::vector{"dhfg_ball", "dhfg_paper", "dhfg_t600s", "short_tool"};
  if (own)
    for (const char* name : names) jobs.push_back(std::string(TOOTHPATH_SAMPLES) + "/" + name + ".toml");
  const int all = std::max(2, int(std::thread::hardware_concurrency()));
  const fs::path dir = fs::temp_directory_path() / ("toothpath_run_bench." + std::to_string(getpid()));
  if (stages) {
    bool good = true;
    for (const std::string& job : jobs) good = stage_rows(job, all, dir) && good;
    fs::remove_all(dir);
    return good ? 0 : 1;
  }
  std::printf("%-28s %3s %8s %8s %8s %9s | %8s %8s %8s %9s\n", "job", "thr", "cpu s", "wall s", "cpu/wall", "peak MB",
              "gouge um", "bound um", "left um", "bytes");
  bool good = true;
  double one = 0;
  for (const std::string& job : jobs) good = rows(job, all, dir, one) && good;
  if (own) good = bevel_rows(all, dir, dir.string() + ".jobs") && good;
  fs::remove_all(dir);
  return good ? 0 : 1;
}
