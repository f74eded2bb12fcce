// Equal-base-circle bevel gears by ball mills: a whole run; what mills may stand in one job is in tests/bad_jobs.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

TEST(BevelByBallMills, IsVerifiedAndNamesTheMillThatDefinesIt) {
  const TestDir dir;
  std::string job = file_text(kSamples + "/bevel_ball.toml");
  const auto mill = job.find("\n[gear.mill]"), machine = job.find("\n[machine]");
  job.replace(mill, machine - mill, "");  // the mill of the rules, then
  job = replaced(job, "scallop = 0.02", "scallop = 0.04");
  write_file(dir / "job.toml", job);
  const auto done = run_program({"run", dir / "job.toml", "--out", dir / "out", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const Json report = Json::parse(done.out).at("report");
  EXPECT_TRUE(report.at("verified").get<bool>());
  const Json& gouge = report.at("gouge_um");
  EXPECT_LE(gouge.at("measured").get<double>(), 1);
  EXPECT_LE(gouge.at("bound").get<double>(), 2);
  EXPECT_LT(report.at("excess_um").at("finished").at("max").get<double>(), 40 + 5 + 1);
  EXPECT_GT(report.at("excess_um").at("finished").at("max").get<double>(), 20);
  bool named = false;
  for (const auto& warning : report.at("warnings"))
    named =
        named || warning.get<std::string>().starts_with("the flanks are those that a finger mill by the rules leaves");
  EXPECT_TRUE(named);
  const std::string points = file_text(dir / "out/inspection.csv");
  EXPECT_NE(points.find("\n0,L,0,0,"), std::string::npos);
  EXPECT_NE(points.find("\n0,U,"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
