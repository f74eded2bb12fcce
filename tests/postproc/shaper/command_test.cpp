// `toothpath shaper` from job file to files on disk, and what it refuses: exit code 3, a place, no files.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "app/commands/shaper.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kJob = R"(schema = 1
name = "offset-shaped"
[gear]
type = "face_gear"
teeth = 88
module = 3.0
module_plane = "transverse"
pressure_angle = 20.0
addendum_coefficient = 1.0
clearance_coefficient = 0.25
shaft_angle = 90.0
offset = 15.0
shaper_teeth = 25
shaper_tip_radius = 0.0
[[gear.zone]]
helix_angle = 0.0
inner_radius = 130.5
outer_radius = 147.0
[machine]
file = "shaper.toml"
accept_assumed = true
[shaping]
cutting_speed = 20.0
speed_basis = "mean"
circular_feed = 0.1
radial_feed = 0.02
over_run = 2.5
offset_reference = "outer_radius"
)";
constexpr const char* kMachine = R"(schema = 1
name = "test shaper"
kind = "gear_shaper"
dialect = "linuxcnc"
assumed = ["index"]
[stroke]
steps = [125, 179, 253, 359]
max_length = 125.0
relief = 0.5
[index]
constant = [12, 5]
[feed]
constant = [750, 1]
[gears]
teeth = [20, 24, 25, 30, 32, 36, 40, 44, 45, 50, 55, 60, 65, 70, 75, 80]
mesh_margin = 15
[axes.X]
min = -5.0
max = 200.0
max_speed = 20000
[axes.Y]
min = -100.0
max = 100.0
max_speed = 5000
[axes.Z]
min = -500.0
max = 500.0
max_speed = 120000
[axes.A]
min = -360000.0
max = 360000.0
max_speed = 7200
[axes.C]
min = -36000.0
max = 36000.0
max_speed = 7200
)";

class ShaperCommand : public ::testing::Test {
 protected:
  commands::CommandOutcome run(const std::string& job, const std::string& machine = kMachine,
                               const std::string& out = "out") {
    write_file(folder_ / "job.toml", job);
    write_file(folder_ / "shaper.toml", machine);
    commands::JobRequest request;
    request.job_file = folder_ / "job.toml";
    request.out_dir = folder_ / out;
    request.quiet = true;
    return run_shaper(request);
  }
  [[nodiscard]] std::size_t files(const std::string& out = "out") const {
    const fs::path path = folder_ / out;
    return fs::exists(path)
               ? static_cast<std::size_t>(std::distance(fs::directory_iterator(path), fs::directory_iterator()))
               : 0;
  }
  TestDir folder_;
};

TEST_F(ShaperCommand, WritesEveryFileAndTheSameBytesAgain) {
  const auto outcome = run(kJob);
  ASSERT_EQ(outcome.exit_code, app::ExitCode::ok) << to_text(outcome.errors);
  ASSERT_EQ(run(kJob, kMachine, "again").exit_code, app::ExitCode::ok);
  for (const char* name : {"limits.json", "shaper.json", "shaper.html", "shaper_program.ngc"}) {
    const auto text = file_text(fs::path(folder_ / "out") / name);
    EXPECT_GT(text.size(), 100u) << name;
    EXPECT_EQ(text, file_text(fs::path(folder_ / "again") / name)) << name;
  }
  EXPECT_EQ(nlohmann::json::parse(file_text(folder_ / "out/shaper.json"))["machine"]["file"], "shaper.toml");
  // Neither planner, mesh nor check had a part in it.
  const auto report = nlohmann::json::parse(outcome.report_json);
  ASSERT_TRUE(report.contains("stages"));
  for (const auto& [stage, seconds] : report["stages"].items())
    EXPECT_TRUE(stage == "job" || stage == "gear" || stage == "machine" || stage == "shaper set-up" ||
                stage == "stroke simulation" || stage == "shaper program")
        << stage;
}

TEST_F(ShaperCommand, RefusalsHaveAPlaceAndChangeNoFile) {
  struct Case {
    const char *what, *by;
    int line;
    const char* message;
  };
  ASSERT_EQ(run(kJob).exit_code, app::ExitCode::ok);
  const auto earlier = file_text(fs::path(folder_ / "out") / "shaper_program.ngc");
  for (const auto& c : std::vector<Case>{
           {"outer_radius = 147.0", "outer_radius = 152.0", 18, "R2 = 151.5833"},
           {"inner_radius = 130.5", "inner_radius = 129.0", 17, "R1c = 129.7965 mm of flank side -1"},
           {"offset = 15.0", "offset = 45.0", 17, "R1c = 140.4391 mm of flank side -1"},
           {"helix_angle = 0.0", "helix_angle = 10.0", 16, "helical guide"},
           {"shaft_angle = 90.0", "shaft_angle = 80.0", 11, "is for 90 deg"},
           {"shaper_tip_radius = 0.0", "shaper_tip_radius = 1.5", 14, "1.1184"},
           {"addendum_coefficient = 1.0", "addendum_coefficient = 1.9", 9, "pointed"},
           {"over_run = 2.5", "over_run = 60.0", 27, "exceeds 125.0000"},
           {"cutting_speed = 20.0", "cutting_speed = 5.0", 23, "below 125.0000"},
           {"accept_assumed = true", "accept_assumed = false", 20, "assumed values (index)"},
           {"teeth = 88", "teeth = 87", 13, "no exact index gears for 20/29"},
       }) {
    const auto outcome = run(replaced(kJob, c.what, c.by));
    EXPECT_EQ(outcome.exit_code, app::ExitCode::refused) << c.by;
    EXPECT_EQ(files(), 5u) << c.by;
    EXPECT_EQ(file_text(fs::path(folder_ / "out") / "shaper_program.ngc"), earlier) << c.by;
    bool found = false;
    for (const auto& e : outcome.errors)
      found = found || (e.message.find(c.message) != std::string::npos && e.position.line == c.line);
    EXPECT_TRUE(found) << c.by << ":\n" << to_text(outcome.errors);
  }
  const auto narrow = run(kJob, replaced(kMachine, "max = 100.0", "max = 10.0"));
  EXPECT_EQ(narrow.exit_code, app::ExitCode::refused);
  EXPECT_NE(to_text(narrow.errors).find("job.toml:12:10: error: axis Y needs 15.0000"), std::string::npos)
      << to_text(narrow.errors);
}

}  // namespace
}  // namespace toothpath::test
