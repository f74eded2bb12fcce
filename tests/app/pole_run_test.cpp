// Whole runs whose prescribed tool axis comes to the pole of C: every option of `[program] pole`, from the job to the
// proven bytes, and those bytes against the planned path by kinematics of their own.
#include <nlohmann/json.hpp>

#include <cstdlib>

#include "geometry/base/angle.h"
#include "tests/app/pole_job.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;
// The ball centre: the tip inside a block (0.5 um) and the axis there (0.001 rad at the ball radius of 0.5 mm), the
// rounding of words (0.09 um), and the sag between two records of the plan whose axis turns (0.12 um).
constexpr double kCentreBound = 5e-4 + 1e-3 * kBall + 9e-5 + 1.2e-4;

struct PoleRun {
  Finished run;
  Json report;
  std::string program;
  std::vector<PlannedStep> plan;
};
PoleRun run_pole(const TestDir& dir, const PoleJob& job, const std::string& extension = "ngc") {
  write_file(dir / "job.toml", job_text(job));
  PoleRun out;
  out.run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  const std::string report = file_text(dir / "out/report.json");
  if (!report.empty()) out.report = Json::parse(report);
  out.program = file_text(dir / ("out/program." + extension));
  out.plan = planned_steps(file_text(dir / "out/cl.csv"));
  return out;
}

/// The feeds of tooth 0 at five places each, against the plan.
struct Sampled {
  double centre_mm = 0, axis_rad = 0, c_speed = 0, c_turn = 0, a_least = INFINITY, a_greatest = -INFINITY,
         nearest_pole = INFINITY, minutes = 0;
  std::size_t away = 0;  ///< motions off the plan
};
Sampled sampled(const PoleRun& r) {
  Sampled s;
  for (const auto& m : joint_feeds(r.program)) {
    const double dc = std::abs(m.to.at('C') - m.from.at('C'));
    s.c_speed = std::max(s.c_speed, dc / m.minutes);
    s.c_turn += dc;
    s.minutes += m.minutes;
    bool on_plan = true;
    for (int k = 0; k <= 4; ++k) {
      std::map<char, double> w;
      for (const auto& [letter, value] : m.from) w[letter] = value + (m.to.at(letter) - value) * k / 4;
      const auto pose = pose_of(w);
      s.nearest_pole = std::min(s.nearest_pole, angle_of(pose.axis, Vec3::UnitZ()));
      const auto off = from_plan(r.plan, pose.tip + kBall * pose.axis, pose.axis);
      if (off.centre_mm > 0.02) {
        on_plan = false;
        continue;
      }
      s.centre_mm = std::max(s.centre_mm, off.centre_mm);
      s.axis_rad = std::max(s.axis_rad, off.axis_rad);
    }
    s.a_least = std::min(s.a_least, m.to.at('A'));
    s.a_greatest = std::max(s.a_greatest, m.to.at('A'));
    if (on_plan) continue;
    ++s.away;
    EXPECT_EQ(dc, 0) << "rotaries stand where the tool leaves the plan";
    EXPECT_EQ(m.to.at('A'), m.from.at('A'));
  }
  return s;
}

void print(const char* name, const PoleRun& r, const Sampled& s) {
  std::printf(
      "%-22s gouge %.3f um, bound %.3f um, %.2f min, C at most %.0f deg/min, %.1f deg a tooth, centre within %.3f um, "
      "axis within %.4f deg, pole at %.4f deg\n",
      name, r.report["gouge_um"]["measured"].get<double>(), r.report["gouge_um"]["bound"].get<double>(),
      r.report["cutting_minutes"].get<double>(), s.c_speed, s.c_turn, s.centre_mm * 1000, s.axis_rad / kDegree,
      s.nearest_pole / kDegree);
}

/// report.json, page and set-up sheet tell the poles that are passed, with the option of the job and what it may move.
void expect_poles_told(const PoleRun& r, const PoleJob& job, const TestDir& dir) {
  ASSERT_TRUE(r.report.contains("poles"));
  const Json& poles = r.report["poles"];
  const int passages = poles["passages_per_tooth"];
  const double axis_deg = poles["axis_change_deg"], tip_um = poles["tip_change_um"];
  EXPECT_GE(passages, 10) << "one in each of some twenty passes";
  EXPECT_LE(passages, 40);
  EXPECT_EQ(poles["option"], job.pole);
  EXPECT_GE(axis_deg, 0);
  EXPECT_LE(axis_deg, job.angle_deg.value_or(0.0573) * (1 + 1e-3));
  // The tip turns about the centre of the ball with the axis.
  EXPECT_NEAR(tip_um, 1000 * kBall * axis_deg * kDegree, 0.01 + 1e-3 * tip_um);
  for (const char* name : {"report.html", "setup.html"}) {
    const std::string page = file_text(dir / (std::string("out/") + name));
    const auto at = page.find("Poles passed: ");
    ASSERT_NE(at, std::string::npos) << name;
    EXPECT_EQ(page.find("Poles passed: ", at + 1), std::string::npos) << name << " tells them twice";
    const std::string line = page.substr(at, 300);
    EXPECT_TRUE(line.starts_with(
        fmt::format("Poles passed: {} a tooth (pole = &quot;{}&quot;); the tool axis moves by at most {:.4f} deg",
                    passages, job.pole, axis_deg)))
        << line;
  }
}

struct PoleCase {
  const char* pole;
  double aside_deg;
  std::optional<double> angle_deg;
};
std::ostream& operator<<(std::ostream& out, const PoleCase& c) {
  return out << c.pole << (c.aside_deg > 0 ? ", past the pole" : ", through the pole");
}
class PoleOptions : public ::testing::TestWithParam<PoleCase> {};
INSTANTIATE_TEST_SUITE_P(Run, PoleOptions,
                         ::testing::Values(PoleCase{"slow", 0, {}}, PoleCase{"hold", 0, {}}, PoleCase{"through", 0, {}},
                                           PoleCase{"retract", 0, {}}, PoleCase{"slow", 0.3, {}},
                                           PoleCase{"hold", 0.3, 1.0}, PoleCase{"through", 0.3, 1.0},
                                           PoleCase{"retract", 0.3, 1.0}));

TEST_P(PoleOptions, GoesTheWholeWayOnATrunnion) {
  const PoleCase& c = GetParam();
  const TestDir dir;
  PoleJob job;
  job.pole = c.pole;
  job.aside_deg = c.aside_deg;
  job.angle_deg = c.angle_deg;
  const PoleRun r = run_pole(dir, job);
  ASSERT_EQ(r.run.exit_code, 0) << r.run.err << r.run.out;
  EXPECT_EQ(r.report["verified"], true);
  EXPECT_LE(r.report["gouge_um"]["bound"].get<double>(), 3.0);
  EXPECT_LE(r.report["gouge_um"]["measured"].get<double>(), r.report["gouge_um"]["bound"].get<double>());
  if (std::string(c.pole) == "slow" && c.aside_deg > 0) {
    EXPECT_FALSE(r.report.contains("poles")) << "the path keeps outside the cone: nothing is changed there";
  } else {
    expect_poles_told(r, job, dir);
  }
  const Sampled s = sampled(r);
  print(fmt::format("{} aside {}", c.pole, c.aside_deg).c_str(), r, s);
  EXPECT_LT(s.centre_mm, kCentreBound);
  EXPECT_LT(s.axis_rad, c.angle_deg.value_or(0.0573) * kDegree + 1.5e-3);
  EXPECT_LE(s.c_speed, 12000 * (1 + 1e-6));
  const std::string pole = c.pole;
  EXPECT_EQ(s.away > 0, pole == "retract");
  if (pole == "through") {
    EXPECT_LT(s.a_least, -2.5);
    EXPECT_GT(s.a_greatest, 2.5);
    EXPECT_LT(s.nearest_pole, 1e-4);
  }
  if (pole == "slow") { EXPECT_LT(s.axis_rad, 2.5e-3); }
  if (pole == "slow" || pole == "hold") { EXPECT_GT(s.c_turn, 100) << "C turns to the other side in the cut"; }
}

// LinuxCNC's own interpreter on tooth 0 of every program: as many feeds as were counted here, and each ends on the
// plan.
TEST(PoleRun, LinuxCncExecutesThem) {
  const char* given = std::getenv("TOOTHPATH_RS274");
  const std::string rs274 = given != nullptr ? given : std::string(TOOTHPATH_SOURCE_DIR) + "/.deps/rs274/rs274";
  if (!std::filesystem::exists(rs274)) FAIL() << rs274 << " is missing: run tools/get_rs274.sh";
  for (const char* pole : {"slow", "hold", "through", "retract"}) {
    const TestDir dir;
    PoleJob job;
    job.pole = pole;
    const PoleRun r = run_pole(dir, job);
    ASSERT_EQ(r.run.exit_code, 0) << r.run.err;
    std::string text = r.program;
    const auto loop = text.find("[#1 LT 60]");
    ASSERT_NE(loop, std::string::npos);
    text.replace(loop, 10, "[#1 LT 1]");
    write_file(dir / "p.ngc", text);
    write_file(dir / "t.tbl", "T1 P1 Z0 D1 ;\n");
    write_file(dir / "v.var", "");
    const std::string command = "cd '" + (dir / "") + "' && HOME=. timeout 60 '" + rs274 +
                                "' -g -t t.tbl -v v.var p.ngc out.txt > log.txt 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << file_text(dir / "log.txt");
    std::istringstream in(file_text(dir / "out.txt"));
    std::size_t feeds = 0, on_plan = 0;
    for (std::string line; std::getline(in, line);) {
      const auto at = line.find("STRAIGHT_FEED(");
      if (at == std::string::npos) continue;
      double x = 0, y = 0, z = 0, a = 0, b = 0, c = 0;
      ASSERT_EQ(std::sscanf(line.c_str() + at, "STRAIGHT_FEED(%lf, %lf, %lf, %lf, %lf, %lf", &x, &y, &z, &a, &b, &c), 6)
          << line;
      ++feeds;
      const auto pose = pose_of({{'X', x}, {'Y', y}, {'Z', z}, {'A', a}, {'C', c}});
      const auto off = from_plan(r.plan, pose.tip + kBall * pose.axis, pose.axis);
      if (off.centre_mm > 0.02) continue;  // on the way out of a retract
      ++on_plan;
      EXPECT_LT(off.centre_mm, kCentreBound);
      EXPECT_LT(off.axis_rad, 0.0573 * kDegree + 1.5e-3);
    }
    EXPECT_EQ(feeds, joint_feeds(r.program).size()) << pole;
    EXPECT_GT(on_plan, feeds - 100) << pole;
  }
}

TEST(PoleRun, ErrorNamesBlockAngleAndLimit) {
  const TestDir dir;
  PoleJob job;
  const PoleRun r = run_pole(dir, job);
  EXPECT_EQ(r.run.exit_code, 3) << r.run.err;
  EXPECT_NE(r.run.err.find("operation 0 record "), std::string::npos) << r.run.err;
  EXPECT_NE(r.run.err.find("the tool axis passes the pole at 0.0000 deg, C turns by "), std::string::npos) << r.run.err;
  EXPECT_NE(r.run.err.find("limit 30: post.pole = \"slow\", \"hold\", \"through\" or \"retract\" goes past it"),
            std::string::npos)
      << r.run.err;
  EXPECT_TRUE(r.program.empty());
}

TEST(PoleRun, TiltMovesNoPrescribedAxis) {
  const TestDir dir;
  PoleJob job;
  job.pole = "tilt";
  const PoleRun r = run_pole(dir, job);
  EXPECT_EQ(r.run.exit_code, 3) << r.run.err;
  EXPECT_NE(r.run.err.find("comes to 0.0000 deg of the pole of C, post.pole = \"tilt\" keeps 5.0000: directions that "
                           "are fixed or prescribed by tool_axis are not moved"),
            std::string::npos)
      << r.run.err;
  EXPECT_TRUE(r.program.empty());
  // Keys that keep the distance are as good as a plan that does.
  const TestDir other;
  job.inner_deg = 6;
  job.outer_deg = 9;
  const PoleRun far = run_pole(other, job);
  ASSERT_EQ(far.run.exit_code, 0) << far.run.err;
  EXPECT_FALSE(far.report.contains("poles")) << "there is none to pass";
  for (const char* name : {"report.html", "setup.html"})
    EXPECT_EQ(file_text(other / (std::string("out/") + name)).find("Poles passed"), std::string::npos) << name;
  EXPECT_GT(sampled(far).nearest_pole, 5.9 * kDegree);
}

// What TCP controls get; the proof reads the bytes back through the kinematics of the machine.
class PoleControls : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};
INSTANTIATE_TEST_SUITE_P(Run, PoleControls,
                         ::testing::Combine(::testing::Values("fanuc_ac.toml", "siemens_ac.toml", "heidenhain_ac.toml"),
                                            ::testing::Values("slow", "hold", "through", "retract")));

TEST_P(PoleControls, GoesTheWholeWayWithTcp) {
  const auto& [machine, pole] = GetParam();
  const TestDir dir;
  PoleJob job;
  job.machine = machine;
  job.pole = pole;
  job.aside_deg = 0.3;
  if (job.pole != "slow") job.angle_deg = 1;
  const PoleRun r = run_pole(dir, job,
                             job.machine == "fanuc_ac.toml"     ? "nc"
                             : job.machine == "siemens_ac.toml" ? "mpf"
                                                                : "h");
  ASSERT_EQ(r.run.exit_code, 0) << r.run.err << r.run.out;
  EXPECT_EQ(r.report["verified"], true);
  EXPECT_LE(r.report["gouge_um"]["bound"].get<double>(), 3.0);
  EXPECT_FALSE(r.program.empty());
  std::printf("%s %s: gouge %.3f um, bound %.3f um, %.2f min\n", machine.c_str(), pole.c_str(),
              r.report["gouge_um"]["measured"].get<double>(), r.report["gouge_um"]["bound"].get<double>(),
              r.report["cutting_minutes"].get<double>());
}

// C stands while it should turn: from the middle of the turn on, 40 deg of it are left out of one block.
TEST(PoleRun, ACThatStaysBehindIsCaught) {
  const TestDir dir;
  PoleJob job;
  job.pole = "slow";
  const PoleRun r = run_pole(dir, job);
  ASSERT_EQ(r.run.exit_code, 0) << r.run.err;
  std::istringstream in(r.program);
  std::string text, line, held;
  int changed = 0;
  for (bool inside = false; std::getline(in, line);) {
    const auto at = line.find(" C");
    if (line.rfind("G0", 0) == 0 || line.rfind("o", 0) == 0) inside = false;
    if (at != std::string::npos && line.rfind("G0", 0) != 0 && changed < 4) {
      const auto end = std::min(line.find(' ', at + 1), line.size());
      if (inside) {
        line.replace(at, end - at, held);
        ++changed;
      } else if (changed == 0) {
        held = line.substr(at, end - at);
        inside = true;
      }
    }
    text += line + "\n";
  }
  ASSERT_GT(changed, 0);
  write_file(dir / "stays.ngc", text);
  const Finished check = run_program({"check", dir / "job.toml", dir / "stays.ngc", "--out", dir / "check"});
  EXPECT_EQ(check.exit_code, 1) << check.err << check.out;
  const Finished whole = run_program({"check", dir / "job.toml", dir / "out/program.ngc", "--out", dir / "whole"});
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
}

// A key list that the planner cannot prove is refused at its place in the job.
TEST(PoleRun, RefusedAxesAreLocatedInTheJob) {
  const TestDir dir;
  std::string text = job_text({});
  const auto at = text.find("tool_axis = ");
  text.replace(at, text.find('\n', at) - at, "tool_axis = [[61.0, 0.0, 28.0]]");
  write_file(dir / "job.toml", text);
  const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  const std::string place = fmt::format("job.toml:{}:13: error: tool 1 in zone 0: with the ball at radius",
                                        1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n'));
  EXPECT_NE(run.err.find(place), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("28.000 deg aside"), std::string::npos) << run.err;
}

/// A cylinder is cut from the side: links with TCP go beside the part, and what goes over it is seen. In the axes of
/// the machine the same job is cut, too.
TEST(LinksWithTcp, AToolFromTheSideGoesBesideThePart) {
  const TestDir dir;
  const std::string data = std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/fanuc_ac.toml", job = dir / "job.toml";
  const std::string text = R"(schema = 1
name = "from_the_side"
[gear]
type = "cylindrical_gear"
teeth = 20
module = 2.0
module_plane = "normal"
pressure_angle = 20.0
[[gear.zone]]
helix_angle = 0.0
from = -1.0
to = 1.0
[machine]
file = "fanuc_ac"
accept_assumed = true
[setup]
origin = [0.0, 0.0, 200.0]
axis = "up"
work_offset = "G54"
work_offset_at = [0.0, 0.0, 200.0]
[[tool]]
number = 1
type = "ball_end_mill"
diameter = 1.2
flute_length = 8.0
shank_diameter = 1.1
length = 100.0
holder = [[10.0, 10.0, 30.0], [32.0, 32.0, 30.0]]
stick_out = 28.0
[[operation]]
type = "finishing"
tool = 1
speed = 14000
feed = 500.0
scallop = 0.08
chord_tolerance = 0.002
[verify]
gouge_tolerance = 0.005
)";
  write_file(job, text);
  const Finished beside = run_program({"run", job, "--out", dir / "out", "--quiet"});
  EXPECT_EQ(beside.exit_code, 0) << beside.out << beside.err;
  const std::string program = file_text(dir / "out/program.nc");
  // The start over the gear axis instead: from there the tool swings over the part.
  const std::size_t on = program.find("G0 G43.4"), line = program.rfind("G0 X", on);
  ASSERT_NE(on, std::string::npos);
  ASSERT_NE(line, std::string::npos);
  write_file(dir / "over.nc", program.substr(0, line) + "G0 X0. Y0.\n" + program.substr(on));
  const Finished over = run_program({"check", job, dir / "over.nc", "--out", dir / "over"});
  EXPECT_EQ(over.exit_code, 1);
  EXPECT_NE(over.err.find("a rapid passes through the part: the holder of the tool"), std::string::npos) << over.err;
  write_file(dir / "fanuc_axes.toml", replaced(file_text(data), "tcp = \"angles\"", "tcp = \"none\""));
  write_file(job, replaced(text, "\"fanuc_ac\"", "\"fanuc_axes\""));
  const Finished made = run_program({"run", job, "--out", dir / "out", "--quiet"});
  EXPECT_EQ(made.exit_code, 0) << made.out << made.err;
  // Cutter locations say nothing of the top of Z: from tooth to tooth the tool goes upright over the part.
  write_file(job, replaced(text, "\"fanuc_ac\"", "\"apt_free\""));
  const Finished places = run_program({"run", job, "--out", dir / "places", "--quiet"});
  EXPECT_EQ(places.exit_code, 0) << places.out << places.err;
  std::string apt = file_text(dir / "places/program.apt");
  const std::size_t tooth = apt.find("$$ TOOTH 1"), risen = apt.rfind("RAPID\nGOTO/", tooth);
  ASSERT_NE(risen, std::string::npos);
  // Upright, but below the top of the part and to its other side.
  write_file(dir / "low.apt", apt.replace(risen, tooth - risen, "RAPID\nGOTO/-27.,0.,1.,0.,0.,1.\n"));
  const Finished low = run_program({"check", job, dir / "low.apt", "--out", dir / "low"});
  EXPECT_EQ(low.exit_code, 1);
  EXPECT_NE(low.err.find("a rapid passes through the part"), std::string::npos) << low.err;
}

}  // namespace
}  // namespace toothpath::test
