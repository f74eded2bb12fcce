// All threads are used, and the result is the same bytes on any number of them.
#include <gtest/gtest.h>

#include <cstring>

#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/threads.h"

namespace toothpath::test {
namespace {

bool same_bytes(const Vec3& a, const Vec3& b) { return std::memcmp(a.data(), b.data(), 3 * sizeof(double)) == 0; }

void expect_the_same(const plan::MillingPlan& a, const plan::MillingPlan& b) {
  ASSERT_EQ(a.paths.size(), b.paths.size());
  for (std::size_t p = 0; p < a.paths.size(); ++p) {
    const auto &x = a.paths[p].records, &y = b.paths[p].records;
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t k = 0; k < x.size(); ++k)
      ASSERT_TRUE(same_bytes(x[k].tip, y[k].tip) && same_bytes(x[k].axis, y[k].axis) &&
                  x[k].feed_mm_min == y[k].feed_mm_min && x[k].kind == y[k].kind)
          << "path " << p << " record " << k;
  }
  ASSERT_EQ(a.directions.size(), b.directions.size());
  for (std::size_t d = 0; d < a.directions.size(); ++d) {
    const auto &x = a.directions[d], &y = b.directions[d];
    EXPECT_EQ(x.explanation, y.explanation);
    EXPECT_EQ(x.clearance_mm, y.clearance_mm);
    ASSERT_EQ(x.candidates.size(), y.candidates.size());
    for (std::size_t c = 0; c < x.candidates.size(); ++c) {
      EXPECT_EQ(x.candidates[c].gap_mm, y.candidates[c].gap_mm) << "direction " << c;
      EXPECT_EQ(x.candidates[c].worst_body, y.candidates[c].worst_body) << "direction " << c;
    }
  }
}

// Embree can hold a whole process to the threads that one of its devices was asked for.
TEST(Threads, AnIndexLeavesThemToEverybody) {
  const auto allowed = [] { return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism); };
  const tbb::global_control two(tbb::global_control::max_allowed_parallelism, 2);
  ASSERT_EQ(allowed(), 2u);
  analytic::Box box;
  box.add(Vec3(0, 0, 0));
  box.add(Vec3(1, 1, 1));
  const analytic::SpatialIndex index(std::vector<analytic::Box>{box});
  EXPECT_EQ(allowed(), 2u);
}

TEST(Threads, PlansAreTheSameBytes) {
  auto stiff = ball_mill(2, 6, 7.6, 12, 40);
  stiff.holder = {{40, 40, 40}};
  const auto check = [](const face_gear::FaceGearParameters& gear, const std::vector<tool::ToolAssembly>& tools,
                        const std::vector<path::MillingOperation>& operations) {
    const auto plan_on = [&](int threads) {
      return on_threads(threads, [&] { return planned(gear, tools, operations); });
    };
    const auto one = plan_on(1);
    expect_the_same(one.plan, plan_on(3).plan);
  };
  auto narrow = quarter_dhfg();  // two rings
  narrow.zones[0].inner_radius_mm = 115;
  narrow.zones[1].outer_radius_mm = 121;
  check(narrow, {ball_mill(0.5, 3.2, 0.46, 14, 10)}, {roughing(0, 0.5, 0.4, 0.05), finishing(0, 0.03, 0.004)});
  check(small_spur(), {ball_mill(1.6, 6, 1.5, 16, 10)}, {finishing(0, 0.05, 0.004)});
  check(steep_gear(105, 77.5, 85.5), {stiff}, {finishing(0, 0.5, 0.004)});
}

TEST(Threads, ProofsAreTheSameBytes) {
  const auto& job = job_named("spur");
  auto path = job.plan.paths.back();
  for (std::size_t k = 50; k < path.records.size(); k += 97) path.records[k].tip.z() -= 0.02;
  const analytic::GougeCheck checker(*job.part, job.tools, job.check_options());
  const auto prove_on = [&](int threads) {
    return on_threads(threads,
                      [&] { return checker.check(analytic::GougeCheck::motions_of(path), job.tool_of_operation()); });
  };
  const auto a = prove_on(1);
  EXPECT_FALSE(a.worst.empty());
  for (const int threads : {2, 5}) {
    const auto b = prove_on(threads);
    EXPECT_EQ(a.measured_mm, b.measured_mm);
    EXPECT_EQ(a.bound_mm, b.bound_mm);
    EXPECT_EQ(a.clearance_mm, b.clearance_mm);
    EXPECT_EQ(a.distance_queries, b.distance_queries);
    ASSERT_EQ(a.worst.size(), b.worst.size());
    for (std::size_t k = 0; k < a.worst.size(); ++k) {
      EXPECT_EQ(a.worst[k].depth_mm, b.worst[k].depth_mm);
      EXPECT_EQ(a.worst[k].line, b.worst[k].line);
      EXPECT_EQ(a.worst[k].point, b.worst[k].point);
    }
  }
}

}  // namespace
}  // namespace toothpath::test
