// Hard finishing from outside: a probing program, its touches on a gear that stands elsewhere, and a job that is cut
// where the gear stands.
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "app/job/file.h"
#include "app/process/gear_of_job.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/inverse.h"
#include "tests/app/program.h"
#include "tests/support/siemens_probe.h"
#include "tests/support/touching_ball.h"
#include "tests/support/trunnion_kinematics.h"

namespace toothpath::test {
namespace {

struct ProbedTouch {
  int number = 0, zone = 0, tooth = 0, side = 1;  ///< of a bevel gear: half and space
  Vec3 start = Vec3::Zero(), past = Vec3::Zero();
  double A = 0, C = 0;
};

/// Touches as they stand in the text of LinuxCNC.
std::vector<ProbedTouch> touches_of(const std::string& text) {
  static const std::regex touch(
      R"(\(TOUCH (\d+) (?:ZONE|HALF) (\d) (?:TOOTH|SPACE) (\d+) (?:FLANK|WALL) (\+1|-1|L|U)\))"),
      pose(R"(G0 C(\S+) A(\S+))"), way(R"(o7001 call \[(\S+)\] \[(\S+)\] \[(\S+)\] \[\S+\])"),
      probed(R"(G38\.2 X(\S+) Y(\S+) Z(\S+) F\S+)");
  std::vector<ProbedTouch> out;
  std::istringstream in(text);
  std::smatch m;
  double A = 0, C = 0;
  for (std::string line; std::getline(in, line);) {
    if (std::regex_match(line, m, touch)) {
      out.push_back({std::stoi(m[1]), std::stoi(m[2]), std::stoi(m[3]), m[4] == "+1" || m[4] == "L" ? 1 : -1});
    } else if (std::regex_match(line, m, pose)) {
      C = std::stod(m[1]);
      A = std::stod(m[2]);
    } else if (std::regex_match(line, m, way)) {
      out.back().start = {std::stod(m[1]), std::stod(m[2]), std::stod(m[3])};
    } else if (std::regex_match(line, m, probed)) {
      out.back().past = {std::stod(m[1]), std::stod(m[2]), std::stod(m[3])};
      out.back().A = A;
      out.back().C = C;
    }
  }
  return out;
}

TEST(ProbeCommand, AGearThatStandsElsewhereIsCutWhereItStands) {
  const TestDir dir;
  const std::string job_text = file_text(kSamples + "/spur_quick.toml");
  write_file(dir / "job.toml", job_text);
  const auto probe = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {
        "probe", dir / "job.toml", "--ball-diameter", "1", "--probe-length", "90", "--tool",
        "9",     "--out",          dir / "probe"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program({words});
  };
  const auto written = probe({});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  const std::string text = file_text(dir / "probe/probe_setup.ngc");
  const auto look =
      text.find("\nG54\no99 while [#5224*#5224+#5226*#5226+#5230*#5230 GT 0]\n(ABORT, A, C, R OF G54 MUST BE 0)\n");
  ASSERT_NE(look, std::string::npos);
  EXPECT_LT(look, text.find("G53 G0"));
  const auto touches = touches_of(text);
  ASSERT_EQ(touches.size(), 16u);

  // It is no program that cuts: the reader says where it stops to understand it.
  const auto checked = run_program({"check", dir / "job.toml", dir / "probe/probe_setup.ngc", "--out", dir / "check"});
  EXPECT_NE(checked.exit_code, 0);
  EXPECT_NE(checked.err.find("probe_setup.ngc:"), std::string::npos) << checked.err;

  // The gear on the machine: moved and turned.
  auto job = job::read_job_file(dir / "job.toml");
  ASSERT_TRUE(job.has_value());
  const auto gear = process::make_face_gear(job.value()).value();
  const auto& f = gear.rings()[0].surface;
  const joints::Setup setup = *job.value().setup;
  const Vec3 moved(0.12, -0.08, 0.05);
  const double turn = 0.0011;
  const Stands stands{Mat3(Eigen::AngleAxisd(turn, Vec3::UnitZ())), moved};
  const auto in_gear = [&](const Vec3& w) -> Vec3 { return w + setup.work_offset_at_mm - setup.origin_mm; };
  std::string results = "# number x y z\n";
  for (const auto& t : touches) {
    const Vec3 from = in_gear(t.start), to = in_gear(t.past);
    const auto foot = face_gear::flank_distance(f, t.side, turned(0.5 * (from + to), -t.tooth * gear.pitch()));
    ASSERT_TRUE(foot);
    const auto centre = touching_centre(f, t.side, t.tooth, 0.5, stands, from, to, foot->foot.theta, foot->foot.B);
    ASSERT_TRUE(centre) << t.number;
    const Vec3 w = *centre - setup.work_offset_at_mm + setup.origin_mm;
    results += fmt::format("{} {:.6f} {:.6f} {:.6f}\n", t.number, w.x(), w.y(), w.z());
  }
  write_file(dir / "results.txt", results);
  const auto solved = probe({"--results", dir / "results.txt", "--json"});
  ASSERT_EQ(solved.exit_code, 0) << solved.err;
  const auto found = nlohmann::json::parse(solved.out)["report"];
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(found["moved"][k].get<double>(), moved[Eigen::Index(k)], 5e-6) << solved.out;
  EXPECT_NEAR(found["clocking_deg"].get<double>(), degrees(turn), 1e-5);
  EXPECT_LT(found["residual_um"].get<double>(), 0.01);

  // The job with the file: its program is proven where the gear stands, and is a gouge where it was meant to stand.
  write_file(dir / "part.measured.toml", file_text(dir / "probe/part.measured.toml"));
  write_file(dir / "hard.toml", replaced(job_text, "[setup]\n", "[setup]\nmeasured = \"part.measured.toml\"\n"));
  const auto run = run_program({"run", dir / "hard.toml", "--out", dir / "hard"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_NE(run.out.find("the part stands as measured in part.measured.toml"), std::string::npos) << run.out;
  EXPECT_NE(file_text(dir / "hard/program.ngc").find("AS MEASURED"), std::string::npos);
  EXPECT_NE(file_text(dir / "hard/setup.html").find("stands as measured in part.measured.toml"), std::string::npos);
  EXPECT_EQ(run_program({"check", dir / "hard.toml", dir / "hard/program.ngc", "--out", dir / "again"}).exit_code, 0);
  EXPECT_EQ(run_program({"check", dir / "job.toml", dir / "hard/program.ngc", "--out", dir / "nominal"}).exit_code, 1);
}

/// The kinematics of the sample's trunnion.
constexpr TrunnionGeometry kTrunnion{3, -2, 0, 14.5, -31.25};

TEST(ProbeCommand, ABevelGearIsFoundInTheTiltOfItsMill) {
  const TestDir dir;
  const std::string job_text = file_text(kSamples + "/bevel_wheel.toml");
  write_file(dir / "job.toml", job_text);
  const auto probe = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {
        "probe", dir / "job.toml", "--ball-diameter", "1.5", "--probe-length", "120", "--tool",
        "9",     "--out",          dir / "probe"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program({words});
  };
  const auto written = probe({});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  const auto touches = touches_of(file_text(dir / "probe/probe_setup.ngc"));
  ASSERT_EQ(touches.size(), 16u);

  auto job = job::read_job_file(dir / "job.toml");
  ASSERT_TRUE(job.has_value());
  const auto gear = process::make_bevel_gear(job.value()).value();
  const joints::Setup setup = *job.value().setup;
  const Vec3 moved(0.11, -0.07, 0.09);
  const double turn = -0.0009;
  const Stands stands{Mat3(Eigen::AngleAxisd(turn, Vec3::UnitZ())), moved};
  const Vec3 flip(1, -1, -1);  // axis = "down"
  std::string results;
  for (const auto& t : touches) {
    const auto table = [&](const Vec3& w) -> Vec3 {
      const Vec3 at = w + setup.work_offset_at_mm;
      const Vec3 tip = trunnion_forward(kTrunnion, at.x(), at.y(), at.z() + 120, t.A, t.C, 120).tip;
      return flip.cwiseProduct(tip - setup.origin_mm);
    };
    // The stem stands along the mill at this place of the wall.
    const Vec3 from = table(t.start), to = table(t.past), middle = 0.5 * (from + to);
    const Vec3 stem = flip.cwiseProduct(trunnion_forward(kTrunnion, 0, 0, 0, t.A, t.C, 120).axis);
    EXPECT_LT((stem - gear.axis(std::atan2(middle.y(), middle.x()))).norm(), 0.06) << t.number;
    const auto centre = touching_centre(gear, t.zone, t.side, t.tooth, 0.75, stands, from, to);
    ASSERT_TRUE(centre) << t.number;
    // The same share of the way in the words: the rotaries stand.
    const double share = (*centre - from).norm() / (to - from).norm();
    const Vec3 w = t.start + share * (t.past - t.start);
    results += fmt::format("{} {:.6f} {:.6f} {:.6f}\n", t.number, w.x(), w.y(), w.z());
  }
  write_file(dir / "results.txt", results);
  const auto solved = probe({"--results", dir / "results.txt", "--json"});
  ASSERT_EQ(solved.exit_code, 0) << solved.err;
  const auto found = nlohmann::json::parse(solved.out)["report"];
  const Vec3 in_machine = flip.cwiseProduct(moved);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(found["moved"][k].get<double>(), moved[Eigen::Index(k)], 1e-5) << solved.out;
    EXPECT_NEAR(found["origin"][k].get<double>(), setup.origin_mm[Eigen::Index(k)] + in_machine[Eigen::Index(k)], 1e-5);
  }
  EXPECT_NEAR(found["clocking_deg"].get<double>(), degrees(turn), 1e-5);
  EXPECT_LT(found["residual_um"].get<double>(), 0.2);

  write_file(dir / "part.measured.toml", file_text(dir / "probe/part.measured.toml"));
  write_file(dir / "hard.toml", replaced(job_text, "[setup]\n", "[setup]\nmeasured = \"part.measured.toml\"\n"));
  const auto run = run_program({"run", dir / "hard.toml", "--out", dir / "hard"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_EQ(run_program({"check", dir / "hard.toml", dir / "hard/program.ngc", "--out", dir / "again"}).exit_code, 0);
  const auto blank = probe({"--blank"});
  ASSERT_EQ(blank.exit_code, 0) << blank.err;
  EXPECT_NE(file_text(dir / "probe/probe_setup.ngc").find("(TOUCH 8 FACE CONE OF THE BLANK)"), std::string::npos);
}

/// Signed distance from a cylinder about the vertical through `axis`, its top at `top`.
double from_cylinder(const Vec3& x, const Vec3& axis, double radius, double top) {
  const double beside = (x - axis).head<2>().norm() - radius, above = x.z() - top;
  return beside > 0 && above > 0 ? std::hypot(beside, above) : std::max(beside, above);
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(ProbeCommand, ABlankIsFoundByTheMeasuringCycleOfSiemens) {
  for (const char* spaces : {"4", "5", "3"}) {
    const TestDir dir;
    write_file(dir / "job.toml", replaced(file_text(kSamples + "/spur_quick.toml"), "\"xyzac_large.toml\" ",
                                          "\"siemens_ac\"\naccept_assumed = true #"));
    const auto probe = [&](std::vector<std::string> more) {
      std::vector<std::string> words = {
          "probe",    dir / "job.toml", "--ball-diameter", "3",     "--probe-length", "90", "--tool", "9",
          "--spaces", spaces,           "--blank",         "--out", dir / "probe"};
      words.insert(words.end(), more.begin(), more.end());
      return run_program({words});
    };
    const auto written = probe({});
    ASSERT_EQ(written.exit_code, 0) << written.err;
    const std::string text = file_text(dir / "probe/probe_setup.mpf");
    const auto n = std::size_t(std::stoi(spaces));
    EXPECT_EQ(count_of(text, "CYCLE978(0,"), 2 * n) << text;
    EXPECT_EQ(text.find("NOTHING_MET"), std::string::npos) << text;
    EXPECT_EQ(text.find("ROT Z=") == std::string::npos, n == 4) << text;

    auto job = job::read_job_file(dir / "job.toml");
    ASSERT_TRUE(job.has_value());
    const auto gear = process::make_face_gear(job.value()).value();
    const joints::Setup setup = *job.value().setup;
    const Vec3 moved(0.31, -0.24, 0.17), stands = setup.origin_mm + moved - setup.work_offset_at_mm;
    const SiemensProbe machine{
        [&](int, const Vec3& centre) {
          return from_cylinder(centre, stands, gear.outer_radius(), stands.z() + gear.blank_top()) - 1.5;
        },
        1.5, 0.008};
    const SiemensProbing ran = run_siemens_probing(text, machine);
    ASSERT_EQ(ran.alarm, "") << text;
    EXPECT_EQ(ran.touches.size(), 2 * n);
    write_file(dir / "results.txt", ran.log);
    const auto solved = probe({"--results", dir / "results.txt", "--json"});
    ASSERT_EQ(solved.exit_code, 0) << solved.err << ran.log;
    const auto found = nlohmann::json::parse(solved.out)["report"];
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(found["moved"][k].get<double>(), moved[Eigen::Index(k)], 2e-5) << solved.out;
  }
}

TEST(ProbeCommand, SiemensTouchesTheFaceConeOfABevelBlankAlongZAndFlanksAslant) {
  const TestDir dir;
  write_file(dir / "job.toml", replaced(replaced(file_text(kSamples + "/bevel_wheel.toml"), "\"xyzac_large.toml\"",
                                                 "\"siemens_ac\"\naccept_assumed = true"),
                                        "260.0]      # the apex", "260.0]"));
  const auto probe = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {
        "probe", dir / "job.toml", "--ball-diameter", "1.5", "--probe-length", "60", "--tool",
        "9",     "--out",          dir / "probe"};
    words.insert(words.end(), more.begin(), more.end());
    const auto written = run_program({words});
    EXPECT_EQ(written.exit_code, 0) << written.err;
    return file_text(dir / "probe/probe_setup.mpf");
  };
  const std::string blank = probe({"--blank"}), flanks = probe({});
  EXPECT_EQ(count_of(blank, "CYCLE978(0,,,1,"), 8u) << blank;
  EXPECT_EQ(count_of(blank, ",3,2,1,\"\",,0,1.0100,1.0100,-1.0100,,,,,1,1)"), 8u) << blank;
  EXPECT_EQ(count_of(flanks, "CYCLE978"), 0u) << flanks;
  EXPECT_EQ(count_of(flanks, "GOTOF NOTHING_MET"), 16u) << flanks;
}

TEST(ProbeCommand, WhatIsWrongIsRefusedAtItsPlace) {
  const TestDir dir;
  const std::string job_text = file_text(kSamples + "/spur_quick.toml");
  write_file(dir / "job.toml", job_text);
  const auto run = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"probe", dir / "job.toml", "--out", dir / "out"};
    words.insert(words.end(), more.begin(), more.end());
    return run_program({words});
  };
  EXPECT_EQ(run({}).exit_code, 2);
  EXPECT_EQ(run({"--ball-diameter", "1", "--tool", "9"}).err, "error: probe needs --probe-length\n");
  const auto large = run({"--ball-diameter", "5", "--probe-length", "90", "--tool", "9"});
  EXPECT_EQ(large.exit_code, 3);
  EXPECT_NE(large.err.find("the largest that does is"), std::string::npos) << large.err;
  const auto far = run({"--ball-diameter", "1", "--probe-length", "900", "--tool", "9"});
  EXPECT_EQ(far.exit_code, 3);
  EXPECT_NE(far.err.find("the gauge point would stand beyond the travels, Z = "), std::string::npos) << far.err;
  write_file(dir / "r.txt", "1 2 3\n");
  const auto short_line = run({"--ball-diameter", "1", "--results", dir / "r.txt"});
  EXPECT_EQ(short_line.exit_code, 3);
  EXPECT_EQ(short_line.err, (dir / "r.txt") + ":1:1: error: 3 columns, must be 4: number x y z\n");

  const auto with = [&](const std::string& measured) {
    write_file(dir / "m.toml", measured);
    write_file(dir / "hard.toml", replaced(job_text, "[setup]\n", "[setup]\nmeasured = \"m.toml\"\n"));
    return run_program({"surface", dir / "hard.toml", "--out", dir / "surface"}).err;
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  has(with("[measured]\n"), "measured = \"m.toml\", line 1, column ");
  has(with("[measured]\norigin = [1, 2]\n"), "measured = \"m.toml\", line 2, column ");
  has(with("[measured]\norigin = [500, 0, 0]\n"), "mm from that of the job, at most 5 mm: another set-up or unit");
  const auto job = job::read_job_file(dir / "job.toml");
  ASSERT_TRUE(job.has_value());
  const Vec3 o = job.value().setup->origin_mm;
  has(with(fmt::format("[measured]\norigin = [{}, {}, {}]\nclocking = 3.1\n", o.x(), o.y(), o.z())),
      "clocking = 3.1 deg exceeds 3 deg, half a pitch of 60 teeth");
  has(with(fmt::format("[measured]\norigin = [{}, {}, {}]\nturn = 3.1\n", o.x(), o.y(), o.z())),
      "unknown key \"turn\"");
  const auto blank = run({"--ball-diameter", "4", "--probe-length", "90", "--tool", "9", "--blank"});
  EXPECT_EQ(blank.exit_code, 0) << blank.err;
  EXPECT_NE(file_text(dir / "out/probe_setup.ngc").find("(TOUCH 8 RIM OF THE BLANK)"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
