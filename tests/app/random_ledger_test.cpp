// The ledger of errors covers what is measured on jobs that nobody chose: random face gears and bevel gears with fixed
// seeds, the whole way from the job to the report. Every source must have been predicted at least as high as it was
// measured.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/commands/run.h"
#include "tests/support/files.h"
#include "tests/support/random_jobs.h"

namespace toothpath {
namespace {

constexpr int kMostTries = 40;  // of one seed, until a job is not refused

/// Runs jobs of one seed until one is not refused, and asks its ledger.
void expect_covered(std::uint64_t seed, std::string (*make_job)(test::Random&),
                    const std::vector<const char*>& sources) {
  test::Random random(seed);
  const test::TestDir dir;
  commands::RunRequest request;
  request.job_file = dir / "job.toml";
  request.out_dir = dir / "out";
  request.quiet = true;
  for (int k = 0; k < kMostTries; ++k) {
    const std::string job = make_job(random);
    test::write_file(request.job_file, job);
    const auto outcome = commands::run_job(request);
    if (outcome.report_json.empty()) continue;
    const auto report = nlohmann::json::parse(outcome.report_json);
    // A ball far too wide may leave active flank: that program is refused with this reason, and its ledger holds all
    // the same.
    for (const auto& reason : report["reasons"])
      EXPECT_TRUE(reason.get<std::string>().starts_with("unreached: ")) << reason << "\n" << job;
    for (const char* source : sources) EXPECT_TRUE(report["ledger"].contains(source)) << source;
    for (const auto& [source, entry] : report["ledger"].items()) {
      if (source == "deflection") continue;  // a model: nothing measures it
      EXPECT_LE(entry["measured"].get<double>(), entry["predicted"].get<double>())
          << source << ": " << entry["note"] << "\n"
          << job;
    }
    // The plan itself keeps what was asked; the rest of the prediction is what chords and rounding make of it.
    if (report.contains("scallop_um")) {
      EXPECT_LE(report["excess_um"]["finished"]["max"].get<double>(),
                report["scallop_um"]["requested"].get<double>() + report["ledger"]["chord"]["predicted"].get<double>() +
                    report["ledger"]["rounding"]["predicted"].get<double>() + 0.2)
          << job;
    }
    return;
  }
  FAIL() << "every job of the seed was refused";
}

class RandomFaceGears : public testing::TestWithParam<int> {};
TEST_P(RandomFaceGears, EverySourceIsCovered) {
  expect_covered(std::uint64_t(GetParam()), test::random_face_job,
                 {"flank solve", "chord", "scallop", "orientation", "axis linearisation", "rounding", "verification"});
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomFaceGears, testing::Range(0, 12));

class RandomBevelGears : public testing::TestWithParam<int> {};
TEST_P(RandomBevelGears, EverySourceIsCovered) {
  expect_covered(std::uint64_t(GetParam()), test::random_bevel_job,
                 {"flank solve", "chord", "ridge", "orientation", "axis linearisation", "rounding", "verification"});
}
INSTANTIATE_TEST_SUITE_P(Seeds, RandomBevelGears, testing::Range(0, 4));

}  // namespace
}  // namespace toothpath
