// How the gouge check grows: CL records from 1e4 to 1e6 on one gear, and 20 against 200 teeth. Prints, for each,
// records, seconds, distances asked, the worst cut measured and proven, and the greatest memory of the process so far.
//
// usage: toothpath_scale_bench [largest number of records, 1000000]
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <variant>

#include "cam/analytic/gouge_check.h"
#include "cam/plan/milling.h"
#include "geometry/face_gear/part.h"
#include "tests/support/sample_gears.h"
#include "tests/support/sample_tools.h"

namespace {

using namespace toothpath;

face_gear::FaceGearParameters spur(int teeth) {
  return test::transverse_gear(teeth, 18, 2, 0.6, {{0, teeth + 1.3, teeth + 3.3}});
}

tool::ToolAssembly mill() { return test::ball_mill(1, 6, 0.95, 16, 10); }

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) / 1024;
}

struct Planned {
  face_gear::FaceGear gear;
  std::vector<tool::ToolAssembly> tools{mill()};
  analytic::GearDistance part{face_gear::part_of(gear), ball::reach_of(tools)};
  path::ClPath path;
};

/// A finishing path of about `records` records: the cusp height decides. Passes repeat where the planner's own number
/// is not reached.
std::unique_ptr<Planned> plan(int teeth, std::size_t records) {
  auto job = std::make_unique<Planned>(Planned{
      test::made(spur(teeth)), {mill()}, analytic::GearDistance(face_gear::part_of(test::made(spur(teeth))), 1.3), {}});
  path::MillingOperation op;
  op.type = path::OperationType::finishing;
  op.speed_rpm = 20000;
  op.feed_mm_min = 300;
  // Both spacings shrink alike: twice as many passes, twice as many points on each.
  double share = 1;
  for (int round = 0; round < 4; ++round) {
    op.scallop_mm = 0.01 * share;
    op.chord_tolerance_mm = 5e-4 * share;
    auto planned = plan::plan_milling(job->part, job->tools, {op}, {});
    if (auto* refusal = planned.refused()) {
      std::fprintf(stderr, "%s\n", refusal->diagnostic.message.c_str());
      std::exit(1);
    }
    job->path = std::move(planned.value().paths.front());
    const double ratio = double(job->path.records.size()) / double(records);
    if (ratio > 0.9 && ratio < 1.15) break;
    share *= ratio;
  }
  return job;
}

/// One row; returns the seconds a record.
double row(const char* what, int teeth, std::size_t records) {
  const auto start = std::chrono::steady_clock::now();
  const auto job = plan(teeth, records);
  const double planning = seconds_since(start);
  analytic::GougeCheckOptions options;
  options.rapid_height_mm = job->gear.blank_top();
  const analytic::GougeCheck check(job->part, job->tools, options);
  const auto begin = std::chrono::steady_clock::now();
  const auto r = check.check(analytic::GougeCheck::motions_of(job->path), {0});
  const double spent = seconds_since(begin), each = spent / double(job->path.records.size());
  std::printf(
      "%-14s %4d teeth %8zu records  plan %7.2f s  check %7.2f s  %6.2f us/record  %5.2f distances/record  measured "
      "%7.3f um  bound %7.3f um  %s  peak %6.0f MB\n",
      what, teeth, job->path.records.size(), planning, spent, each * 1e6,
      double(r.distance_queries) / double(r.motions), r.measured_mm * 1000, r.bound_mm * 1000,
      check.passes(r) ? "clean" : "REFUSED", peak_megabytes());
  std::fflush(stdout);
  return each;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t most = argc > 1 ? std::size_t(std::atoll(argv[1])) : 1000000;
  double first = 0, last = 0;
  for (std::size_t records = 10000; records <= most; records *= 10) {
    last = row("scale", 60, records);
    if (first == 0) first = last;
    std::printf("  time a record against 1e4 records: %.2f\n", last / first);
  }
  const double few = row("teeth", 20, 20000), many = row("teeth", 200, 20000);
  std::printf("  time a record, 200 teeth against 20: %.2f\n", many / few);
}
