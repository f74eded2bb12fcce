// Where the planner's time goes: seconds of the distance index, of every stage of the plan and of the gouge check, once
// on one thread and once on all, for a double helical gear, a spur gear and a gear that needs five axes. Beside it how
// good the result is: the largest sag of a block, the cusps that are predicted, the deepest cut measured and proven,
// the least gap of shank and holder; and whether both runs made the same records to the last bit.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <thread>
#include <utility>

#include "cam/analytic/gouge_check.h"
#include "cam/plan/milling.h"
#include "geometry/face_gear/part.h"
#include "tests/support/sample_gears.h"
#include "tests/support/sample_tools.h"
#include "tests/support/threads.h"

namespace {

using namespace toothpath;

struct Case {
  const char* name;
  face_gear::FaceGearParameters gear;
  std::vector<tool::ToolAssembly> tools;
  std::vector<path::MillingOperation> operations;
};

path::MillingOperation finishing(int tool, double scallop_mm) {
  path::MillingOperation op;
  op.tool = tool;
  op.speed_rpm = 20000;
  op.feed_mm_min = 300;
  op.scallop_mm = scallop_mm;
  op.chord_tolerance_mm = 0.002;
  return op;
}

path::MillingOperation roughing(int tool, double step_mm) {
  path::MillingOperation op = finishing(tool, 0);
  op.type = path::OperationType::roughing;
  op.step_down_mm = step_mm;
  op.step_over_mm = 1.6 * step_mm;
  op.allowance_mm = 0.08;
  return op;
}

std::vector<Case> cases() {
  auto stiff = test::ball_mill(2, 6, 7.6, 12, 40);
  stiff.holder = {{40, 40, 40}};
  return {{"double helical",
           test::quarter_dhfg(),
           {test::ball_mill(1, 3.5, 0.95, 16, 10), test::ball_mill(0.5, 3.2, 0.46, 14, 10)},
           {roughing(0, 0.25), finishing(1, 0.004)}},
          {"spur", test::small_spur(), {test::ball_mill(1, 6, 0.95, 16, 10)}, {finishing(0, 0.004)}},
          {"five axes", test::steep_gear(105, 77.5, 85.5), {stiff}, {finishing(0, 0.05)}}};
}

/// Wall time of every stage; of stages inside a stage only what is not theirs.
class Clock {
 public:
  void run(const std::string& name, const std::function<void()>& work) {
    const double before = std::exchange(inner_, 0.0);
    const auto start = std::chrono::steady_clock::now();
    work();
    const double all = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    seconds_[name] += all - inner_;
    inner_ = before + all;
  }
  [[nodiscard]] double operator[](const std::string& name) const {
    const auto it = seconds_.find(name);
    return it == seconds_.end() ? 0 : it->second;
  }

 private:
  std::map<std::string, double> seconds_;
  double inner_ = 0;
};

bool same(const path::ClRecord& a, const path::ClRecord& b) {
  return std::memcmp(a.tip.data(), b.tip.data(), sizeof(double) * 3) == 0 &&
         std::memcmp(a.axis.data(), b.axis.data(), sizeof(double) * 3) == 0 && a.feed_mm_min == b.feed_mm_min &&
         a.kind == b.kind;
}

/// One row; the records of all operations.
std::vector<path::ClRecord> row(const Case& c, int threads) {
  const face_gear::FaceGear gear = test::made(c.gear);
  Clock clock;
  std::unique_ptr<analytic::GearDistance> part;
  clock.run("distance index", [&] {
    part = std::make_unique<analytic::GearDistance>(face_gear::part_of(gear), ball::reach_of(c.tools));
  });
  plan::Options options;
  options.stage = [&](const std::string& name, const std::function<void()>& work) { clock.run(name, work); };
  plan::MillingPlan plan;
  clock.run("rest", [&] {
    auto planned = plan::plan_milling(*part, c.tools, c.operations, options);
    if (const auto* refusal = planned.refused()) {
      std::fprintf(stderr, "%s: %s\n", c.name, refusal->diagnostic.message.c_str());
      std::exit(1);
    }
    plan = std::move(planned.value());
  });
  analytic::GougeCheckOptions check_options;
  check_options.rapid_height_mm = gear.blank_top();
  const analytic::GougeCheck check(*part, c.tools, check_options);
  std::vector<path::ToolMotion> motions;
  std::vector<int> tools;
  std::vector<path::ClRecord> records;
  for (const auto& path : plan.paths) {
    const auto more = analytic::GougeCheck::motions_of(path);
    motions.insert(motions.end(), more.begin(), more.end());
    records.insert(records.end(), path.records.begin(), path.records.end());
    tools.push_back(path.tool);
  }
  proof::GougeResult proof;
  clock.run("gouge check", [&] { proof = check.check(motions, tools); });
  double chord = 0, cusp = 0, tilt_gap = INFINITY;
  for (const auto& o : plan.operations) chord = std::max(chord, o.chord_mm), cusp = std::max(cusp, o.scallop_max_mm);
  for (const auto& d : plan.directions) tilt_gap = std::min(tilt_gap, d.clearance_mm);
  std::printf("%-15s %2d %8zu %7.3f %7.3f %9.3f %11.3f %6.3f %6.3f %7.3f | %6.3f %7.2f %8.3f %7.3f %7.3f\n", c.name,
              threads, records.size(), clock["distance index"], clock["tool passes"], clock["tool direction"],
              clock["five-axis orientation"], clock["links"], clock["rest"], clock["gouge check"], chord * 1000,
              cusp * 1000, proof.measured_mm * 1000, proof.bound_mm * 1000, tilt_gap);
  std::fflush(stdout);
  return records;
}

}  // namespace

int main() {
  const int all = std::max(2, int(std::thread::hardware_concurrency()));
  std::printf("%-15s %2s %8s %7s %7s %9s %11s %6s %6s %7s | %6s %7s %8s %7s %7s\n", "seconds", "th", "records", "index",
              "passes", "direction", "orientation", "links", "rest", "check", "sag um", "cusp um", "meas. um", "bound",
              "gap mm");
  bool equal = true;
  for (const Case& c : cases()) {
    const auto one = test::on_threads(1, [&] { return row(c, 1); }),
               many = test::on_threads(all, [&] { return row(c, all); });
    const bool as_one = one.size() == many.size() && std::equal(one.begin(), one.end(), many.begin(), same);
    if (!as_one) std::printf("%s: %d threads made other records than one\n", c.name, all);
    equal = equal && as_one;
  }
  return equal ? 0 : 1;
}
