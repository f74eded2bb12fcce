// Jobs that nobody chose, with fixed seeds, the whole way: each is verified, with bounds that hold and the same bytes
// on any number of threads, or it is refused, and a calculation that shares nothing with the refusal says so too.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands/run.h"
#include "app/job/file.h"
#include "geometry/base/hash.h"
#include "tests/app/refusals.h"
#include "tests/support/files.h"
#include "tests/support/random_jobs.h"
#include "tests/support/threads.h"

namespace toothpath::test {
namespace {

constexpr int kFaceJobs = 24, kBevelJobs = 4;

struct Trial {
  std::string job;
  commands::CommandOutcome outcome;
};

std::string job_of(int seed) {
  Random random(std::uint64_t(1000 + seed));
  return seed < kFaceJobs ? random_face_job(random) : random_bevel_job(random);
}

Trial run_in(const TestDir& dir, const std::string& name, int seed) {
  Trial run{job_of(seed), {}};
  commands::RunRequest request;
  request.job_file = dir / "job.toml";
  request.out_dir = dir / name;
  request.quiet = true;
  write_file(request.job_file, run.job);
  run.outcome = commands::run_job(request);
  return run;
}

void expect_refused_for_a_reason(const Trial& run) {
  const auto job = job::parse_job(run.job, "job.toml");
  ASSERT_TRUE(job) << to_text(job.error());
  ASSERT_FALSE(run.outcome.errors.empty());
  for (const Diagnostic& error : run.outcome.errors) {
    EXPECT_EQ(error.kind, DiagnosticKind::refused_input);
    EXPECT_TRUE(refused_for_a_reason(error.message, job.value())) << error.text() << "\n" << run.job;
  }
}

void expect_verified(const Trial& run, const std::string& out) {
  const auto report = nlohmann::json::parse(run.outcome.report_json);
  EXPECT_EQ(report["verified"], true) << report["reasons"] << "\n" << run.job;
  const auto& gouge = report["gouge_um"];
  EXPECT_LE(gouge["measured"].get<double>(), gouge["bound"].get<double>()) << run.job;
  EXPECT_LE(gouge["bound"].get<double>(), gouge["tolerance"].get<double>()) << run.job;
  const auto& clearance = report["clearance"];
  EXPECT_GE(clearance["least"].get<double>(), clearance["required"].get<double>()) << run.job;
  if (!clearance["measured"].is_null()) {
    EXPECT_GE(clearance["measured"].get<double>(), clearance["least"].get<double>()) << run.job;
  }
  for (const auto& [source, entry] : report["ledger"].items())
    if (source != "deflection") {  // a model: nothing measures it
      EXPECT_LE(entry["measured"].get<double>(), entry["predicted"].get<double>()) << source << "\n" << run.job;
    }
  EXPECT_EQ(report["program"]["sha256"], sha256_hex(file_text(out + "/program.ngc")));
}

class RandomJobs : public ::testing::TestWithParam<int> {};

TEST_P(RandomJobs, AreVerifiedOrRefusedForAReason) {
  const TestDir dir;
  const Trial run = run_in(dir, "out", GetParam());
  EXPECT_EQ(std::filesystem::exists(dir / "out/program.ngc"), run.outcome.exit_code == app::ExitCode::ok);
  if (run.outcome.exit_code == app::ExitCode::refused) expect_refused_for_a_reason(run);
  else expect_verified(run, dir / "out");
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomJobs, ::testing::Range(0, kFaceJobs + kBevelJobs));

// What confirms a refusal denies a wrong one: those of a gear that can be made.
TEST(RandomJobsJudge, DeniesRefusalsOfAGoodGear) {
  const auto job = job::parse_job(file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml"), "job.toml");
  ASSERT_TRUE(job);
  const FaceRefusals refusals(*job.value().face_gear());
  for (const char* message :
       {"shaper tip rounding 0.6000 mm is too large: the full round tip has 0.5000 mm",
        "inner_radius = 60.0000 mm lies inside the undercut limit R1c = 61.0000 mm of flank side +1",
        "inner_radius = 60.0000 mm is not above the gear's base radius 61.0000 mm: no flank",
        "outer_radius = 65.0000 mm exceeds the pointing limit R2 = 64.0000 mm", "no"})
    EXPECT_FALSE(refusals.confirm(message)) << message;
}

TEST(RandomJobsJudge, DeniesRefusalsOfAGoodBevelGear) {
  const auto job = job::parse_job(file_text(TOOTHPATH_SOURCE_DIR "/samples/bevel_trunnion.toml"), "job.toml");
  ASSERT_TRUE(job);
  for (const char* message :
       {"relief_half_width = 1.1000 is below 1.2000, the reach of the corner fillet at the tip",
        "relief_half_width = 1.1000 is below 0.7794, the reach of the corner fillet at the tip",
        "apex_cone_distance = 25.4500 leaves a half narrower than 1.5589, twice the reach of the corner fillet",
        "module = 0.7200 exceeds 0.7351 (0.99 of the normal module 0.7426 at the small end)",
        "tip_radius = 0.1200 exceeds 0.1605, where the cutter gets pointed", "no"})
    EXPECT_FALSE(refused_for_a_reason(message, job.value())) << message;
}

class RandomThreads : public ::testing::TestWithParam<int> {};

TEST_P(RandomThreads, OneAndEightGiveTheSameBytes) {
  const TestDir dir;
  for (const int threads : {1, 8}) {
    const Trial run = on_threads(threads, [&] { return run_in(dir, std::to_string(threads), GetParam()); });
    ASSERT_EQ(run.outcome.exit_code, app::ExitCode::ok) << to_text(run.outcome.errors) << run.job;
  }
  for (const char* name : {"program.ngc", "cl.csv", "gear.stl", "inspection.csv", "setup.html", "tooth.vtp"})
    EXPECT_EQ(file_text(dir / (std::string("1/") + name)), file_text(dir / (std::string("8/") + name))) << name;
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomThreads, ::testing::Values(0, 1, kFaceJobs));

}  // namespace
}  // namespace toothpath::test
