// Whole runs in tilted planes of the controls, with clamps on both rotaries and the blank for the graphics: from the
// job to the proven bytes, and `check` of what somebody edits.
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

struct PlaneCase {
  const char* machine;
  const char* extension;
  const char* plane;       ///< words of a plane
  const char* pair;        ///< that say which pair of angles ..
  const char* other_pair;  ///< .. and the other
  const char* blank;       ///< of the graphics, ahead of its first number; empty: none
};
std::ostream& operator<<(std::ostream& out, const PlaneCase& c) { return out << c.machine; }

class TiltedPlanesRun : public ::testing::TestWithParam<PlaneCase> {};
INSTANTIATE_TEST_SUITE_P(
    Run, TiltedPlanesRun,
    ::testing::Values(PlaneCase{"fanuc_ac", "nc", "\nG68.2 X0. Y0. Z30. I", "G53.1 P2", "G53.1 P1", ""},
                      PlaneCase{"m80_ac", "nc", "\nG68.2 X0. Y0. Z30. I", "G53.1 P2", "G53.1 P1", ""},
                      PlaneCase{"siemens_ac", "mpf", "\nCYCLE800(0,\"\",0,39,0,0,30,R2", ",0,0,0,-1,0,1)",
                                ",0,0,0,1,0,1)", "WORKPIECE(,\"\",,\"PIPE\",448,"},
                      PlaneCase{"heidenhain_ac", "h", " PLANE SPATIAL SPA-", "SEQ- TABLE", "SEQ+ TABLE",
                                "BLK FORM CYLINDER Z R"}));

/// A machine that ships, both rotaries with clamps.
std::string machine_text(const std::string& machine) {
  std::string text = file_text(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/" + machine + ".toml");
  text = replaced(text, "[axes.C]\n", "[axes.C]\nclamp = [\"M10\", \"M11\"]\nclamp_time = [0.5, 0.25]\n");
  text = replaced(text, "max = 60.0", "max = 2.0");  // of A: one pair of angles is within the travel
  return replaced(text, "[axes.A]\n", "[axes.A]\nclamp = [\"M68\", \"M69\"]\n");
}

std::string planes_job(bool planes) {
  std::string text = file_text(kSamples + "/spur_quick.toml");
  text = replaced(text, "#:schema ../docs/schema/job.schema.json\n", "");
  text = replaced(text, "\"xyzac_large.toml\"", "\"machine.toml\"\naccept_assumed = true");
  text = replaced(text, "[3.0, -2.0, 120.0]", "[0.0, 0.0, 30.0]");
  text = replaced(text, "[3.0, -2.0, 0.0]", "[0.0, 0.0, 0.0]");
  text = replaced(text, "chord_tolerance = 0.002\n", "chord_tolerance = 0.002\ntool_axis = [[62.5, 6.0, 0.0]]\n");
  return text + (planes ? "\n[program]\ntilted_planes = true\n" : "");
}

TEST_P(TiltedPlanesRun, IsVerifiedAndWhatIsEditedIsFound) {
  const PlaneCase& c = GetParam();
  const TestDir dir;
  write_file(dir / "machine.toml", machine_text(c.machine));
  write_file(dir / "job.toml", planes_job(true));
  const auto run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const Json report = Json::parse(file_text(dir / "out/report.json"));
  EXPECT_EQ(report["verified"], true);
  EXPECT_NE(report["assumed"].dump().find("program.tilted_planes"), std::string::npos);
  EXPECT_EQ(report["warnings"].dump().find("clamp"), std::string::npos) << report["warnings"];

  const std::string program = file_text(dir / (std::string("out/program.") + c.extension));
  EXPECT_NE(program.find(c.plane), std::string::npos) << program.substr(0, 3000);
  EXPECT_NE(program.find(c.pair), std::string::npos);
  EXPECT_EQ(program.find("G93"), std::string::npos);
  EXPECT_EQ(times_in(program, c.other_pair), 0U);
  EXPECT_NE(program.find(c.blank), std::string::npos);
  const std::string sheet = file_text(dir / "out/setup.html");
  EXPECT_NE(sheet.find("M10 clamps, M11 releases"), std::string::npos);

  const auto checked = [&](const std::string& text) {
    write_file(dir / "edited", text);
    return run_program({"check", dir / "job.toml", dir / "edited", "--out", dir / "checked"});
  };
  const auto as_it_is = checked(program);
  EXPECT_EQ(as_it_is.exit_code, 0) << as_it_is.err << as_it_is.out;
  const auto other = checked(replaced_all(program, c.pair, c.other_pair));
  EXPECT_EQ(other.exit_code, 1) << other.out;
  EXPECT_NE(other.err.find("travel: A = "), std::string::npos) << other.err;
  if (*c.blank == 0) return;
  const std::string blank = c.blank;
  const auto graphics = checked(replaced(program, blank, blank + "1"));
  EXPECT_EQ(graphics.exit_code, 0) << graphics.err;
  EXPECT_NE((graphics.out + graphics.err).find("the blank of the graphics has the"), std::string::npos)
      << graphics.out << graphics.err;
}

// The same job without the key: the times differ by the feeds alone, and the clamps are there.
TEST(TiltedPlanesRun, AJobWithoutThemHasClampsToo) {
  const TestDir dir;
  write_file(dir / "machine.toml", machine_text("siemens_ac"));
  write_file(dir / "job.toml", planes_job(false));
  const auto run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const std::string program = file_text(dir / "out/program.mpf");
  EXPECT_GT(times_in(program, "\nM11\n"), 1U);
  const auto edited = [&](const std::string& text) {
    write_file(dir / "edited.mpf", text);
    return run_program({"check", dir / "job.toml", dir / "edited.mpf", "--out", dir / "checked"});
  };
  const auto loose = edited(replaced(program, "\nM10\n", "\n"));
  EXPECT_EQ(loose.exit_code, 0) << loose.err;
  EXPECT_NE((loose.out + loose.err).find("C stands and is not clamped"), std::string::npos) << loose.out << loose.err;
  const auto held = edited(replaced_all(program, "\nM11\n", "\n"));
  EXPECT_EQ(held.exit_code, 3) << held.out;
  EXPECT_NE(held.err.find("edited.mpf:"), std::string::npos) << held.err;
  EXPECT_NE(held.err.find("C turns, and nothing has released it"), std::string::npos) << held.err;
}

// A gear beside the axis that turns it: every tooth has its own place in the machine, and the graphics have no ring.
TEST(TiltedPlanesRun, AGearBesideTheAxisOfTheTable) {
  for (const auto& [machine, extension] : {std::pair{"heidenhain_ac", "h"}, std::pair{"siemens_ac", "mpf"}}) {
    const TestDir dir;
    write_file(dir / "machine.toml", machine_text(machine));
    write_file(dir / "job.toml", replaced(planes_job(true), "[0.0, 0.0, 30.0]", "[20.0, 10.0, 30.0]"));
    const auto run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
    ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
    const std::string program = file_text(dir / (std::string("out/program.") + extension));
    EXPECT_NE(program.find("NO BLANK FOR THE GRAPHICS: THE GEAR AXIS IS NOT Z OF THE WORK OFFSET"), std::string::npos);
  }
}

TEST(TiltedPlanesRun, TheDryRunReleasesItsRotaries) {
  for (const char* machine : {"fanuc_ac", "siemens_ac", "heidenhain_ac"}) {
    const TestDir dir;
    write_file(dir / "machine.toml", machine_text(machine));
    const auto run = run_program({"machine", "test", dir / "machine.toml", "--out", dir / "out"});
    EXPECT_EQ(run.exit_code, 0) << machine << run.err << run.out;
  }
}

}  // namespace
}  // namespace toothpath::test
