// A machine with assumed pivots: no program without `accept_assumed`, and with it a warning on every page and in the
// program.
#include <cctype>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

/// The quick sample on a machine of its own whose tilt axis nobody measured.
class AssumedPivot : public ::testing::Test {
 protected:
  void SetUp() override {
    write_file(dir / "m.toml", replaced(file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml"),
                                        "assumed = false", "assumed = [\"axes.A.point\"]"));
  }
  std::string job(const std::string& accept) {
    const std::string path = dir / "job.toml";
    write_file(path, replaced(file_text(kSamples + "/spur_quick.toml"), "file = \"xyzac_large.toml\"",
                              "file = \"m.toml\"\n" + accept));
    return path;
  }
  TestDir dir;
};

TEST_F(AssumedPivot, NoProgramUnlessTheJobAcceptsIt) {
  for (const char* accept : {"", "accept_assumed = false"}) {
    const std::string path = job(accept);
    const Finished run = run_program({"run", path, "--out", dir / "out"});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_EQ(run.err, path +
                           ":21:8: error: m.toml has assumed values (axes.A.point); measure them, or accept them with "
                           "accept_assumed = true\n");
    EXPECT_TRUE(names_in(dir / "out").empty());
  }
}

TEST_F(AssumedPivot, EveryPageAndTheProgramCarryTheWarning) {
  const Finished run = run_program({"run", job("accept_assumed = true"), "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("assumed             1 value of m.toml, not measured: axes\n"), std::string::npos) << run.out;
  int pages = 0;
  for (const auto& name : names_in(dir / "out")) {
    if (!name.ends_with(".html") || name == "data_sheet.html") continue;  // a drawing of the gear knows no machine
    ++pages;
    const std::string page = file_text(dir / ("out/" + name));
    const bool counts = name == "limits.html";  // no limit of the gear depends on the machine
    EXPECT_NE(page.find(counts ? "1 value of m.toml, not measured: axes" : "m.toml: axes.A: point"), std::string::npos)
        << name;
    EXPECT_NE(page.find("ssumed"), std::string::npos) << name;
  }
  EXPECT_GE(pages, 3);
  const std::string program = file_text(dir / "out/program.ngc");
  const auto warning = program.find("(WARNING, ASSUMED AND NOT MEASURED:)\n(ASSUMED M.TOML: AXES.A: POINT)\n");
  ASSERT_NE(warning, std::string::npos) << program.substr(0, 600);
  EXPECT_LT(warning, program.find("\nG"));
  const auto report = nlohmann::json::parse(file_text(dir / "out/report.json"));
  EXPECT_EQ(report["assumed"], nlohmann::json::array({"m.toml: axes.A.point"}));
}

// The dry run that is made to measure the pivots may be written, and says what is assumed.
TEST_F(AssumedPivot, TheDryRunSaysIt) {
  const Finished run = run_program({"machine", "test", dir / "m.toml", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(file_text(dir / "out/machine_test.html").find("axes.A.point"), std::string::npos);
  EXPECT_NE(file_text(dir / "out/machine_test.ngc").find("ASSUMED AXES.A: POINT"), std::string::npos);
  ASSERT_EQ(run_program({"machine", "show", dir / "m.toml", "--out", dir / "shown"}).exit_code, 0);
  const std::string shown = file_text(dir / "shown/machine.html");
  EXPECT_NE(shown.find("1 values assumed"), std::string::npos);
}

// Danger 29: the report names the bytes that lie there; danger 24: the first lines and the last ones name the same hash
// and blocks.
TEST_F(AssumedPivot, TheReportNamesTheBytesOnTheDisk) {
  ASSERT_EQ(run_program({"run", job("accept_assumed = true"), "--out", dir / "out"}).exit_code, 0);
  const auto report = nlohmann::json::parse(file_text(dir / "out/report.json"));
  const std::string program = file_text(dir / "out/program.ngc");
  const std::string command = "sha256sum '" + (dir / "out/program.ngc") + "' > '" + (dir / "sum") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(report["program"]["sha256"].get<std::string>(), file_text(dir / "sum").substr(0, 64));
  const auto first = program.find("(HASH "), last = program.rfind("(HASH ");
  ASSERT_NE(first, last);
  const auto line_of = [&](std::size_t at) { return program.substr(at, program.find('\n', at) - at); };
  EXPECT_EQ(line_of(first), line_of(last));
  EXPECT_LT(program.size() - last, 60u);
}

// Danger 32: a tilt axis that is at its zero at 90 deg. With TCP the control's data must hold that, or the file is
// refused where it says so.
TEST_F(AssumedPivot, ZeroUnderTcpIsNamedOrRefused) {
  std::string machine =
      replaced(file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml"), "sign = -1\nmin = -110.0\nmax = 60.0",
               "zero = 90.0\nsign = -1\nmin = -20.0\nmax = 150.0");
  machine = replaced(machine, "tcp = \"none\"", "tcp = \"angles\"");
  write_file(dir / "m.toml", replaced(machine, "\"linuxcnc\"", "\"siemens\""));
  const Finished run = run_program({"run", job(""), "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string zero = "axes.A.zero = 90 deg, TRAORI counts A from it";
  EXPECT_NE(file_text(dir / "out/report.json").find("m.toml: " + zero), std::string::npos);
  for (const char* page : {"out/report.html", "out/setup.html"})
    EXPECT_NE(file_text(dir / page).find(zero), std::string::npos) << page;
  EXPECT_NE(file_text(dir / "out/setup.html").find("TCP: machine data 21104 ORI_IPO_WITH_G_CODE = 1"),
            std::string::npos);
  const std::string program = file_text(dir / "out/program.mpf");
  EXPECT_LT(program.find("AXES.A.ZERO = 90 DEG"), program.find("\nG")) << program.substr(0, 900);

  write_file(dir / "m.toml", machine + "\n[post]\ntcp_on = [\"M428\"]\ntcp_off = [\"M429\"]\n");
  const Finished refused = run_program({"run", job(""), "--out", dir / "other"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(
      refused.err.find("m.toml:41:8: error: axes.A.zero = 90 deg: with TCP dialect \"linuxcnc\" takes the table as "
                       "level and straight at A = 0"),
      std::string::npos)
      << refused.err;
  EXPECT_TRUE(names_in(dir / "other").empty());
}

}  // namespace
}  // namespace toothpath::test
