// Five-axis planning with stout tools, each planned and proven: the fourteen jobs of the tests, or with `all` all sixty
// random ones that they are taken from, or those of the fourteen whose numbers are given. A job succeeds when it is
// proven and turns no axis within 2 deg of the gear axis.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include "tests/cam/ball/stout_jobs.h"

int main(int count, char** given) {
  using namespace toothpath;
  int done = 0, number = 0, tried = 0;
  const std::vector<std::string> asked(given + 1, given + count);
  const bool all = !asked.empty() && asked.front() == "all";
  for (const auto& job : all ? test::random_stout_jobs() : test::stout_jobs()) {
    ++number;
    if (!all && !asked.empty() && std::find(asked.begin(), asked.end(), std::to_string(number)) == asked.end())
      continue;
    ++tried;
    const auto start = std::chrono::steady_clock::now();
    const auto outcome = test::plan_stout(job);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const bool good = outcome.proven && outcome.least_tilt_rad >= radians(2);
    done += good;
    fmt::print("{:2} {:8} ball {:.2f} flute {:.2f} shank {:.2f} stick-out {:.2f} holder {:.0f}: {} ({:.1f} s)\n   {}\n",
               number, job.gear, job.tool.diameter_mm, job.tool.flute_length_mm, job.tool.shank_diameter_mm,
               job.tool.stick_out_mm, job.tool.holder.front().lower_diameter_mm,
               good              ? "proven"
               : outcome.proven  ? "proven, but past the pole"
               : outcome.planned ? "planned, not proven"
                                 : "refused",
               seconds, outcome.words);
    for (auto fitting = job; const auto& tool : test::advised_tools(job, outcome.words)) {
      fitting.tool = tool;
      const auto then = test::plan_stout(fitting);
      fmt::print("   with flute {:.2f} shank {:.2f} stick-out {:.2f}: {}\n", tool.flute_length_mm,
                 tool.shank_diameter_mm, tool.stick_out_mm, then.proven ? "proven" : then.words);
    }
    std::fflush(stdout);
  }
  fmt::print("{} of {}\n", done, tried);
}
