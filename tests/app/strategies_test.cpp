// `study strategies`: the rows of one line-milled gear, against `run` and against each other.
#include <map>
#include <nlohmann/json.hpp>

#include "app/job/file.h"
#include "app/studies/strategy_jobs.h"
#include "geometry/base/angle.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

/// One narrow ring of the double helical gear of the literature at quarter scale, by one tapered mill. The pole option
/// refuses axes that turn nearer than 20 deg to the gear axis: leans aside do, the lines do not.
const std::string kJob = R"(schema = 1
name = "strategies"
[gear]
type = "face_gear"
teeth = 180
module = 1.25
module_plane = "transverse"
pressure_angle = 20.0
reference_radius = 118.0
shaper_teeth = 30
shaper_tip_radius = 0.375
[[gear.zone]]
helix_angle = 30.0
inner_radius = 119.0
outer_radius = 121.0
[machine]
file = "xyzac_large.toml"
[setup]
origin = [3.0, -2.0, 120.0]
axis = "up"
work_offset = "G54"
work_offset_at = [0.0, 0.0, 0.0]
[[tool]]
number = 1
type = "tapered_ball_end_mill"
diameter = 0.5
half_angle = 5.0
flute_length = 4.0
shank_diameter = 4.0
helix = 30.0
length = 92.0
holder = [[10.0, 10.0, 30.0], [32.0, 32.0, 30.0]]
stick_out = 22.0
teeth = 2
[[operation]]
type = "roughing"
tool = 1
speed = 20000
feed = 350.0
step_down = 0.3
step_over = 0.25
allowance = 0.2
[[operation]]
type = "line_milling"
tool = 1
speed = 20000
feed = 300.0
allowance = 0.12
left = 0.04
chord_tolerance = 0.004
[[operation]]
type = "line_milling"
tool = 1
speed = 20000
feed = 280.0
left = 0.03
chord_tolerance = 0.004
[[operation]]
type = "finishing"
tool = 1
speed = 20000
feed = 300.0
regions = ["fillet", "root"]
scallop = 0.04
chord_tolerance = 0.004
[verify]
gouge_tolerance = 0.003
[program]
pole = "tilt"
pole_angle = 20.0
)";

std::map<std::string, Json> rows_of(const Json& report) {
  std::map<std::string, Json> rows;
  for (const auto& row : report.at("strategies")) rows[row.at("strategy")] = row;
  return rows;
}

TEST(StudyStrategies, LineStripsBallAndTiltedBall) {
  const TestDir dir;
  const std::string job = dir / "job.toml", out = dir / "out";
  write_file(job, kJob);
  const auto done = run_program({"study", "strategies", job, "--out", out, "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"strategies.html", "strategies.json"}));
  const Json report = Json::parse(done.out).at("report");
  EXPECT_EQ(report, Json::parse(file_text(out + "/strategies.json")));
  const auto rows = rows_of(report);
  ASSERT_EQ(rows.size(), 4u);
  for (const char* name : {"line", "2 strips", "ball", "tilted ball"}) {
    ASSERT_TRUE(rows.contains(name)) << name;
    EXPECT_TRUE(rows.at(name).at("verified").get<bool>()) << name << ": " << rows.at(name).at("reason");
  }
  const auto number = [&](const char* row, const char* key) { return rows.at(row).at(key).get<double>(); };
  const auto left = [&](const char* row, const char* key) {
    return rows.at(row).at("flank_left_um").at(key).get<double>();
  };
  for (const char* time : {"total_minutes", "flank_minutes", "finishing_minutes"}) {
    EXPECT_LT(number("line", time), number("2 strips", time)) << time;
    EXPECT_LT(number("2 strips", time), number("ball", time)) << time;
  }
  // Nothing but the flanks differs, and that fillets are cut beside poses of a side where there are some.
  const double rest = number("line", "total_minutes") - number("line", "flank_minutes");
  for (const auto& [row, share] : {std::pair{"2 strips", 0.02}, {"ball", 0.1}})
    EXPECT_NEAR(number(row, "total_minutes") - number(row, "flank_minutes"), rest, share * rest) << row;
  EXPECT_EQ(number("line", "passes"), 2);
  EXPECT_EQ(number("2 strips", "passes"), 4);
  EXPECT_GT(number("ball", "passes"), 10);
  // Cusps of 30 um: seen by the grid, and no higher than scallop, chord and the margin of a micrometre.
  EXPECT_GT(left("ball", "max"), 20);
  EXPECT_LT(left("ball", "max"), 30 + 4 + 1.5);
  EXPECT_LT(left("line", "max"), left("ball", "max"));
  for (const auto& [name, row] : rows) {
    EXPECT_LT(left(name.c_str(), "rms"), left(name.c_str(), "max")) << name;
    EXPECT_LE(row.at("gouge_um").at("bound").get<double>(), 3) << name;
    EXPECT_GT(row.at("deflection_um").get<double>(), 0) << name;
  }
  // Leans aside turn near the pole; the lean outwards alone is one direction, and taken.
  const std::string remark = rows.at("tilted ball").at("remark");
  EXPECT_EQ(remark.rfind("lean: outwards 10 deg; refused: outwards 10 deg, aside 10 deg: ", 0), 0u) << remark;
  EXPECT_NE(remark.find("pole"), std::string::npos) << remark;
  EXPECT_EQ(rows.at("tilted ball").at("tool_axis"), "still in every pass, 10.0 deg");
  const std::string page = file_text(out + "/strategies.html");
  for (const char* part : {"Line against ball", "4 of 4 verified", "tilted ball", "<svg ", "cusps of 0.1 of it"})
    EXPECT_NE(page.find(part), std::string::npos) << part;

  const std::string as_run = dir / "run";
  ASSERT_EQ(run_program({"run", job, "--out", as_run}).exit_code, 0);
  const Json run = Json::parse(file_text(as_run + "/report.json"));
  const Json &line = rows.at("line"), &finish = run.at("operations").at(2);
  for (const char* key : {"total_minutes", "cutting_minutes", "cl_points", "blocks"})
    EXPECT_EQ(line.at(key), run.at(key)) << key;
  EXPECT_EQ(line.at("finishing_minutes"), finish.at("minutes"));
  EXPECT_EQ(line.at("deflection_um"), finish.at("deflection_um"));
  EXPECT_EQ(line.at("force_n"), finish.at("force_n"));
  for (const char* key : {"max", "min", "rms"})
    EXPECT_EQ(line.at("finished_um").at(key), run.at("excess_um").at("finished").at(key)) << key;
  for (const char* key : {"measured", "bound"})
    EXPECT_EQ(line.at("gouge_um").at(key), run.at("gouge_um").at(key)) << key;
}

/// Gears of every type are compared; a lean that is prescribed is one of face gears.
TEST(StudyStrategies, TakesOtherGearsThanFaceGears) {
  job::Job job = job::read_job_file(kSamples + "/spiral_bevel.toml").value();
  EXPECT_NE(studies::line_milled_flanks(job).error().message.find("finishes the flanks and is a finishing"),
            std::string::npos);
  job.operations.back().type = path::OperationType::line_milling;
  job.operations.back().left_mm = 0.005;
  const auto flanks = studies::line_milled_flanks(job);
  ASSERT_TRUE(flanks) << flanks.error().message;
  EXPECT_EQ(studies::with_strips(job, *flanks, 9).operations.back().strips, 9);
  const auto ball = studies::with_ball(job, *flanks, nullptr);
  ASSERT_TRUE(ball) << ball.error().message;
  EXPECT_EQ(ball->operations.back().type, path::OperationType::finishing);
  EXPECT_DOUBLE_EQ(ball->operations.back().scallop_mm, 0.005);
  const studies::PrescribedLean lean{0.1, 0};
  const auto tilted = studies::with_ball(job, *flanks, &lean);
  ASSERT_FALSE(tilted);
  EXPECT_NE(tilted.error().message.find("belongs to face gears; this gear is a spiral_bevel_gear"), std::string::npos)
      << tilted.error().message;
}

/// The ring is too narrow for the four stations of a line; balls do not mind.
TEST(StudyStrategies, WhatIsRefusedSaysWhyAndStopsNothing) {
  const TestDir dir;
  const std::string job = dir / "job.toml", out = dir / "out";
  write_file(job,
             replaced(replaced(kJob, "outer_radius = 121.0", "outer_radius = 120.0"), "left = 0.03", "left = 0.1"));
  const auto done = run_program({"study", "strategies", job, "--out", out, "--strips", "1", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const auto rows = rows_of(Json::parse(done.out).at("report"));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_FALSE(rows.at("line").at("verified").get<bool>());
  EXPECT_NE(rows.at("line").at("reason").get<std::string>().find("stations"), std::string::npos)
      << rows.at("line").at("reason");
  EXPECT_FALSE(rows.at("line").contains("total_minutes"));
  EXPECT_TRUE(rows.at("ball").at("verified").get<bool>()) << rows.at("ball").at("reason");
  EXPECT_NE(file_text(out + "/strategies.html").find("2 of 3 verified"), std::string::npos);
}

TEST(StudyStrategies, RefusedJobsAndASignalLeaveWhatStoodThere) {
  const TestDir dir;
  const std::string job = dir / "job.toml", out = dir / "out";
  write_file(job, kJob);
  std::filesystem::create_directory(out);
  write_file(out + "/strategies.json", "earlier");
  const auto untouched = [&] {
    return names_in(out) == std::vector<std::string>{"strategies.json"} &&
           file_text(out + "/strategies.json") == "earlier";
  };
  const auto ball = run_program({"study", "strategies", kSamples + "/spur_quick.toml", "--out", out});
  EXPECT_EQ(ball.exit_code, 3);
  EXPECT_NE(ball.err.find("spur_quick.toml:48:1: error: operation 1 finishes the flanks and is a finishing"),
            std::string::npos)
      << ball.err;
  EXPECT_TRUE(untouched());
  EXPECT_EQ(run_program({"study", "strategies", kSamples + "/bevel_pinion.toml", "--out", out}).exit_code, 3);
  EXPECT_EQ(run_program({"study", "strategies", job, "--out", out, "--strips", "25"}).exit_code, 2);
  const std::string no_machine = dir / "no_machine.toml";
  write_file(no_machine, replaced(kJob, "xyzac_large", "xyzac_none"));
  EXPECT_NE(run_program({"study", "strategies", no_machine, "--out", out}).exit_code, 0);
  EXPECT_TRUE(untouched());
  Launch launch;
  launch.arguments = {"study", "strategies", job, "--out", out};
  launch.signal_number = SIGTERM;
  launch.signal_after_ms = 300;
  EXPECT_EQ(run_program(launch).exit_code, 130);
  EXPECT_TRUE(untouched());
}

/// The rules of the page, on the job itself.
TEST(StudyStrategies, JobsDifferInTheFlanksAlone) {
  const TestDir dir;
  write_file(dir / "job.toml", kJob);
  auto read = job::read_job_file(dir / "job.toml");
  ASSERT_TRUE(read);
  const job::Job& job = read.value();
  const auto flanks = studies::line_milled_flanks(job);
  ASSERT_TRUE(flanks);
  EXPECT_EQ(flanks->finisher, 2u);
  EXPECT_EQ(flanks->operations, (std::vector<std::size_t>{1, 2}));

  const studies::PrescribedLean lean{radians(10.0), radians(5.0)};
  const auto ball = studies::with_ball(job, *flanks, &lean);
  ASSERT_TRUE(ball);
  const path::MillingOperation &semi = ball->operations[1], &finish = ball->operations[2];
  EXPECT_EQ(semi.type, path::OperationType::semi_finishing);
  EXPECT_EQ(semi.allowance_mm, 0.12);
  EXPECT_DOUBLE_EQ(semi.scallop_mm, 0.012);
  EXPECT_EQ(finish.type, path::OperationType::finishing);
  EXPECT_EQ(finish.allowance_mm, 0);
  EXPECT_EQ(finish.scallop_mm, 0.03);
  EXPECT_EQ(finish.chord_tolerance_mm, 0.004);
  EXPECT_EQ(finish.feed_mm_min, 280);
  for (const auto* o : {&semi, &finish}) {
    EXPECT_TRUE(o->regions[path::Region::flank]);
    EXPECT_FALSE(o->regions[path::Region::fillet] || o->regions[path::Region::root]);
    ASSERT_EQ(o->axis_plus.size(), 1u);
    EXPECT_EQ(o->axis_plus[0].aside_rad, radians(5.0));  // away from flank +1
    EXPECT_EQ(o->axis_minus[0].aside_rad, -radians(5.0));
    EXPECT_EQ(o->axis_minus[0].outwards_rad, radians(10.0));
  }
  EXPECT_EQ(ball->operations[0].type, job.operations[0].type);
  EXPECT_EQ(ball->operations[3].scallop_mm, job.operations[3].scallop_mm);
  // Every region still has an operation that finishes it.
  for (const path::Region region : path::kRegions)
    EXPECT_EQ(path::finisher_of(ball->operations, region), path::finisher_of(job.operations, region));

  EXPECT_EQ(studies::with_strips(job, *flanks, 3).operations[2].strips, 3);
  EXPECT_FALSE(studies::with_strips(job, *flanks, 3).operations[1].strips);

  job::Job thin = job;  // a tenth of the allowance would be finer than anything the line leaves
  thin.operations[1].allowance_mm = 0.01;
  EXPECT_EQ(studies::with_ball(thin, *flanks, nullptr)->operations[1].scallop_mm, path::kLeastCusp_mm);
  EXPECT_TRUE(studies::with_ball(thin, *flanks, nullptr)->operations[1].axis_plus.empty());
  job::Job coarse = job;
  coarse.operations[2].left_mm = 0.3;
  const auto refused = studies::with_ball(coarse, *flanks, nullptr);
  ASSERT_FALSE(refused);
  EXPECT_GT(refused.error().position.line, 0);
  EXPECT_NE(refused.error().message.find("0.25 mm, the radius of tool 1"), std::string::npos)
      << refused.error().message;
}

}  // namespace
}  // namespace toothpath::test
