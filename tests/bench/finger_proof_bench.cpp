// The two proofs that a finger mill does not gouge, on the plans of jobs: the finger mill's own (distance of its path
// to the wall paths) and that of any mill (cutting part as convex bodies against the exact surface).
//   toothpath_finger_proof_bench MOVES JOB..
// of each job as many moves, from the middle of its last operation.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "app/job/file.h"
#include "app/process/gear_of_job.h"
#include "app/process/proof_limits.h"
#include "cam/analytic/gouge_check.h"
#include "cam/finger/check.h"
#include "cam/finger/finger_profile.h"
#include "cam/finger/milling.h"
#include "geometry/bevel_gear/part.h"

namespace {

using namespace toothpath;

constexpr double kSag = 1e-3;  // mm: of the bodies that stand for the flank of the mill

template <typename Work>
auto timed(double& seconds, const Work& work) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = work();
  seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

int compare(const char* file, std::size_t moves) {
  auto read = job::read_job_file(file);
  if (const auto* errors = read.refused()) return fmt::print("{}: {}\n", file, errors->front().message), 1;
  const job::Job& job = *read.value_if();
  auto made = process::make_bevel_gear(job);
  if (const auto* errors = made.refused()) return fmt::print("{}: {}\n", file, errors->front().message), 1;
  const bevel_gear::BevelGear& gear = *made.value_if();
  const proof::ProofLimits limits = process::proof_limits(job);

  std::vector<path::ToolMotion> motions;
  std::vector<tool::ProofTool> tools(job.tools.size());
  std::vector<int> tool_of;
  for (std::size_t i = 0; i < job.operations.size(); ++i) {
    const auto& operation = job.operations[i];
    const auto k = std::size_t(operation.tool);
    auto plan = finger::plan_finger_operation(gear, job.tools[k], operation, int(i), limits);
    if (!plan) return fmt::print("{}: {}\n", file, plan.error().message), 1;
    for (const auto& m : path::motions_of(plan->path)) motions.push_back(m);
    tool_of.push_back(operation.tool);
    const auto own = finger::gear_for_finger_mill(gear, job.tools[k]);
    if (!own) return fmt::print("{}: {}\n", file, own.error().message), 1;
    tools[k] = tool::proof_tool(finger::finger_profile(own->cutter(), job.tools[k], kSag), job.tools[k].number, kSag);
  }
  std::erase_if(motions, [&](const path::ToolMotion& m) { return m.operation + 1 != int(job.operations.size()); });
  const std::size_t first = motions.size() > moves ? (motions.size() - moves) / 2 : 0;
  motions.assign(motions.begin() + std::ptrdiff_t(first),
                 motions.begin() + std::ptrdiff_t(std::min(motions.size(), first + moves)));
  double own_s = 0, index_s = 0, any_s = 0;
  const finger::FingerGougeCheck own(gear, job.tools, job.operations, limits);
  const auto by_paths = timed(own_s, [&] { return own.verify(motions); });
  const auto part = timed(index_s, [&] {
    return std::make_unique<analytic::GearDistance>(std::make_shared<bevel_gear::BevelPart>(gear), 40.0);
  });
  if (const auto& refused = part->refusal())
    return fmt::print("{}: the other proof refuses it: {}\n", file, refused->diagnostic.message), 1;
  analytic::GougeCheckOptions options;
  options.limits = limits;
  options.rapid_height_mm = gear.parameters().addendum_mm;
  const analytic::GougeCheck any(*part, tools, options);
  const auto by_bodies = timed(any_s, [&] { return any.check(motions, tool_of); });
  fmt::print("{:<40} {:>6} | {:8.3f} {:8.3f} {:7.2f} | {:8.3f} {:8.3f} {:7.2f} {:7.2f}\n", file, motions.size(),
             by_paths.gouge.measured_mm * 1000, by_paths.gouge.bound_mm * 1000, own_s, by_bodies.measured_mm * 1000,
             by_bodies.bound_mm * 1000, index_s, any_s);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  fmt::print("{:<40} {:>6} | {:>25} | {:>33}\n{:<40} {:>6} | {:>8} {:>8} {:>7} | {:>8} {:>8} {:>7} {:>7}\n", "job", "",
             "own proof", "proof of any mill", "", "moves", "um", "bound", "s", "um", "bound", "index s", "s");
  int failed = 0;
  const int moves = argc > 1 ? std::atoi(argv[1]) : 0;
  for (int k = 2; k < argc; ++k) failed += compare(argv[k], std::size_t(moves));
  return failed > 0;
}
