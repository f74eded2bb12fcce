// `surface` and `shaper` do nothing that they do not need: the stages that ran, and no spatial index was built in this
// process.
#include <nlohmann/json.hpp>
#include <set>

#include "app/commands/shaper.h"
#include "app/commands/surface.h"
#include "cam/analytic/spatial_index.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

std::set<std::string> stages_of(const commands::CommandOutcome& outcome) {
  std::set<std::string> names;
  const auto report = nlohmann::json::parse(outcome.report_json);
  for (const auto& [name, seconds] : report["stages"].items()) names.insert(name);
  return names;
}

commands::JobRequest request_for(const std::string& job, const std::string& out) {
  commands::JobRequest request;
  request.job_file = job;
  request.out_dir = out;
  request.quiet = true;
  return request;
}

TEST(LightCommands, SurfaceRunsGeometryOnly) {
  const TestDir dir;
  const auto before = analytic::SpatialIndex::built();
  const commands::SurfaceRequest request{request_for(kSamples + "/spur_quick.toml", dir / "out"), {}, {}};
  const auto outcome = commands::run_surface(request);
  ASSERT_EQ(outcome.exit_code, app::ExitCode::ok) << to_text(outcome.errors);
  EXPECT_EQ(stages_of(outcome), (std::set<std::string>{"job", "gear", "inspection grid", "mesh"}));
  EXPECT_EQ(analytic::SpatialIndex::built(), before);
}

TEST(LightCommands, ShaperPlansNoPathAndBuildsNoMesh) {
  const TestDir dir;
  const auto before = analytic::SpatialIndex::built();
  const auto outcome = commands::run_shaper(request_for(kSamples + "/offset_shaped.toml", dir / "out"));
  ASSERT_EQ(outcome.exit_code, app::ExitCode::ok) << to_text(outcome.errors);
  EXPECT_EQ(stages_of(outcome),
            (std::set<std::string>{"job", "gear", "machine", "shaper set-up", "stroke simulation", "shaper program"}));
  EXPECT_EQ(analytic::SpatialIndex::built(), before);
}

/// The same job on the two shapers with an electronic gearbox: program by dialect, read back before it is kept.
TEST(LightCommands, ShaperWithElectronicGearboxReadsItsProgramBack) {
  for (const auto& [machine, program] :
       {std::pair{"shaper_siemens.toml", "shaper_program.mpf"}, std::pair{"shaper_fanuc.toml", "shaper_program.nc"}}) {
    const TestDir dir;
    std::string job = file_text(kSamples + "/offset_shaped.toml");
    job.replace(job.find("y514.toml"), 9, machine);
    write_file(dir / "job.toml", job);
    const auto outcome = commands::run_shaper(request_for(dir / "job.toml", dir / "out"));
    ASSERT_EQ(outcome.exit_code, app::ExitCode::ok) << to_text(outcome.errors);
    EXPECT_TRUE(stages_of(outcome).count("read back"));
    EXPECT_EQ(names_in(dir / "out"),
              (std::vector<std::string>{"limits.json", "report.json", "shaper.html", "shaper.json", program}));
    const auto json = nlohmann::json::parse(file_text(dir / "out/shaper.json"));
    EXPECT_EQ(json["generating"]["ratio"], nlohmann::json::array({25, 88}));
    EXPECT_EQ(json["assumed"].size(), 3u);
    // A file of another dialect that lay there goes.
    write_file(dir / "out/shaper_program.ngc", "old");
    ASSERT_EQ(commands::run_shaper(request_for(dir / "job.toml", dir / "out")).exit_code, app::ExitCode::ok);
    EXPECT_FALSE(std::filesystem::exists(dir / "out/shaper_program.ngc"));
  }
}

}  // namespace
}  // namespace toothpath::test
