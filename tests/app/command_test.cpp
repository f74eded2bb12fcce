// The program from outside: exit codes, what lies in the output directory afterwards, faults of the disk, signals.
#include <nlohmann/json.hpp>

#include "program.h"

namespace toothpath::test {
namespace {

const std::string kQuick = kSamples + "/spur_quick.toml";
const std::vector<std::string> kSurfaceFiles = {"gear.stl",    "inspection.csv", "inspection.dmi", "limits.html",
                                                "limits.json", "limits.svg",     "report.json",    "tooth.vtp"};

TEST(CommandLine, UsageErrorsAreTwo) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{}, {"bogus"}, {"surface"}, {"surface", kQuick}, {"surface", kQuick, "--out", "x", "--bogus"},
        {"surface", kQuick, "--out", "x", "--threads", "nan"}, {"surface", kQuick, "--out", "x", "--threads", "0"},
        {"surface", kQuick, "--out", "x", "--color", "pink"}})
    EXPECT_EQ(run_program(arguments).exit_code, 2);
}

TEST(CommandLine, HelpAndVersion) {
  const Finished help = run_program({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("surface"), std::string::npos);
  const Finished version = run_program({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("toothpath ")) << version.out;
}

TEST(CommandLine, SurfaceWritesItsFilesAndNothingElse) {
  const TestDir dir;
  const Finished run = run_program({"surface", kQuick, "--out", dir / "a/b"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(names_in(dir / "a/b"), kSurfaceFiles);
  const auto report = nlohmann::json::parse(file_text(dir / "a/b/report.json"));
  EXPECT_EQ(report["job"], "spur-quick");
  EXPECT_TRUE(report["stages"].contains("mesh"));
  EXPECT_FALSE(report["stages"].contains("plan"));
  const auto limits = nlohmann::json::parse(file_text(dir / "a/b/limits.json"));
  ASSERT_EQ(limits["zones"].size(), 1u);
  ASSERT_EQ(limits["zones"][0]["flanks"].size(), 2u);
  // A spur gear without offset is its own mirror image.
  EXPECT_NEAR(limits["zones"][0]["flanks"][0]["pointing_radius"].get<double>(),
              limits["zones"][0]["flanks"][1]["pointing_radius"].get<double>(), 1e-9);
}

TEST(CommandLine, JsonIsOneObjectOnStdout) {
  const TestDir dir;
  const Finished good = run_program({"surface", kQuick, "--out", dir / "out", "--json"});
  ASSERT_EQ(good.exit_code, 0);
  EXPECT_EQ(nlohmann::json::parse(good.out)["exit_code"], 0);
  const Finished bad = run_program({"--json", "surface", kBadJobs + "/module_negative.toml", "--out", dir / "out"});
  EXPECT_EQ(bad.exit_code, 3);
  const auto json = nlohmann::json::parse(bad.out);
  EXPECT_EQ(json["exit_code"], 3);
  EXPECT_GT(json["errors"][0]["line"].get<int>(), 0);
}

TEST(CommandLine, QuietPrintsNothing) {
  const TestDir dir;
  const Finished run = run_program({"surface", kQuick, "--out", dir / "out", "--quiet"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out + run.err, "");
}

TEST(CommandLine, OneAndTwoThreadsGiveTheSameBytes) {
  const TestDir dir;
  ASSERT_EQ(run_program({"surface", kQuick, "--out", dir / "1", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(run_program({"surface", kQuick, "--out", dir / "2", "--threads", "2"}).exit_code, 0);
  for (const auto& name : kSurfaceFiles)
    if (name != "report.json") {
      EXPECT_EQ(file_text(dir / ("1/" + name)), file_text(dir / ("2/" + name))) << name;
    }
}

TEST(CommandLine, ARunOnOneAndTwoThreadsGivesTheSameBytes) {
  const TestDir dir;
  ASSERT_EQ(run_program({"run", kQuick, "--out", dir / "1", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(run_program({"run", kQuick, "--out", dir / "2", "--threads", "2"}).exit_code, 0);
  // The cut surface and the proof are in tooth.vtp and in the reports; those carry run times as well.
  for (const char* name : {"program.ngc", "cl.csv", "tooth.vtp", "inspection.csv", "limits.json"})
    EXPECT_EQ(file_text(dir / (std::string("1/") + name)), file_text(dir / (std::string("2/") + name))) << name;
  auto one = nlohmann::json::parse(file_text(dir / "1/report.json")), two = nlohmann::json::parse(file_text(dir / "2/report.json"));
  one.erase("stages");
  two.erase("stages");
  EXPECT_EQ(one, two);
}

TEST(CommandLine, FilesThatCannotBeReadAreFour) {
  const TestDir dir;
  EXPECT_EQ(run_program({"surface", dir / "missing.toml", "--out", dir / "out"}).exit_code, 4);
  EXPECT_EQ(run_program({"surface", dir / ".", "--out", dir / "out"}).exit_code, 4);
  EXPECT_FALSE(std::filesystem::exists(dir / "out")) << "a directory that was made for nothing is taken back";
}

TEST(CommandLine, InputsThatNeverEndAreRefused) {
  const TestDir dir;
  ASSERT_EQ(::mkfifo((dir / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(run_program({"surface", dir / "pipe", "--out", dir / "out"}).exit_code, 3);
  EXPECT_EQ(run_program({"surface", "/dev/zero", "--out", dir / "out"}).exit_code, 3);
  write_file(dir / "long.toml", "# " + std::string(10'000'000, 'x') + "\n");
  EXPECT_EQ(run_program({"surface", dir / "long.toml", "--out", dir / "out"}).exit_code, 3);
  std::filesystem::create_symlink(dir / "loop", dir / "loop");
  EXPECT_EQ(run_program({"surface", dir / "loop", "--out", dir / "out"}).exit_code, 4);
}

TEST(OutputDirectory, PlacesThatCannotBeWrittenAreFour) {
  const TestDir dir;
  write_file(dir / "file", "mine");
  for (const std::string& place : {dir / "file", dir / "file/below", std::string("/dev/null/out"), std::string("/proc/out")})
    EXPECT_EQ(run_program({"surface", kQuick, "--out", place}).exit_code, 4) << place;
  EXPECT_EQ(file_text(dir / "file"), "mine");
  std::filesystem::create_directories(dir / "out/gear.stl");
  EXPECT_EQ(run_program({"surface", kQuick, "--out", dir / "out"}).exit_code, 4) << "a directory in the place of an output";
  EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{"gear.stl"});
}

TEST(OutputDirectory, AFullDiskLeavesNothing) {
  for (const rlim_t bytes : {rlim_t{0}, rlim_t{100}, rlim_t{5000}, rlim_t{50000}}) {
    const TestDir dir;
    Launch launch;
    launch.arguments = {"surface", kQuick, "--out", dir / "out", "--quiet"};
    launch.largest_file = bytes;
    EXPECT_EQ(run_program(launch).exit_code, 4) << bytes;
    EXPECT_TRUE(names_in(dir / "out").empty()) << bytes;
  }
}

TEST(OutputDirectory, AFullStdoutIsFour) {
  const TestDir dir;
  Launch launch;
  launch.arguments = {"surface", kQuick, "--out", dir / "out"};
  launch.stdout_file = "/dev/full";
  EXPECT_EQ(run_program(launch).exit_code, 4);
}

TEST(OutputDirectory, ARefusedRunRemovesWhatAnEarlierOneLeft) {
  const TestDir dir;
  std::filesystem::create_directories(dir / "out");
  for (const char* name : {"program.ngc", "program.nc", "cl.csv", "report.json", "setup.html", "my notes.txt"}) write_file(dir / "out/" + name, "old");
  EXPECT_EQ(run_program({"run", kBadJobs + "/module_negative.toml", "--out", dir / "out"}).exit_code, 3);
  EXPECT_EQ(names_in(dir / "out"), std::vector<std::string>{"my notes.txt"});
}

TEST(OutputDirectory, ASignalLeavesNothing) {
  for (const int number : {SIGINT, SIGTERM}) {
    const TestDir dir;
    Launch launch;
    launch.arguments = {"run", kSamples + "/dhfg_paper.toml", "--out", dir / "out"};
    launch.signal_number = number;
    launch.signal_after_ms = 300;
    EXPECT_EQ(run_program(launch).exit_code, 130);
    EXPECT_TRUE(names_in(dir / "out").empty());
  }
}

TEST(Machine, APartThatDoesNotFitIsRefusedWithBothNumbers) {
  const TestDir dir;
  std::string text = replaced(file_text(kSamples + "/dhfg_paper.toml"), "file = \"xyzac_large.toml\"", "file = \"t600s.toml\"\naccept_assumed = true");
  write_file(dir / "job.toml", text);
  const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("job.toml:"), std::string::npos);
  EXPECT_NE(run.err.find("992"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("250"), std::string::npos) << run.err;
  EXPECT_TRUE(names_in(dir / "out").empty());
}

TEST(Machine, AssumedValuesMustBeAccepted) {
  const TestDir dir;
  const std::string text = file_text(kSamples + "/dhfg_t600s.toml");
  const auto line_end = text.find('\n', text.find("accept_assumed"));
  const auto line_start = text.rfind('\n', text.find("accept_assumed"));
  write_file(dir / "job.toml", text.substr(0, line_start) + text.substr(line_end));
  const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("axes.A.point"), std::string::npos) << run.err;
}

TEST(Run, ASmallGearGoesTheWholeWay) {
  const TestDir dir;
  const Finished run = run_program({"run", kQuick, "--out", dir / "1", "--threads", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const auto names = names_in(dir / "1");
  for (const char* name : {"cl.csv", "gear.stl", "inspection.csv", "limits.json", "program.ngc", "report.html", "report.json", "setup.html", "tooth.vtp"})
    EXPECT_TRUE(std::binary_search(names.begin(), names.end(), name)) << name;
  const auto report = nlohmann::json::parse(file_text(dir / "1/report.json"));
  EXPECT_EQ(report["verified"], true);
  EXPECT_LE(report["gouge_um"]["measured"].get<double>(), report["gouge_um"]["bound"].get<double>());
  EXPECT_LE(report["gouge_um"]["bound"].get<double>(), 2.0);

  ASSERT_EQ(run_program({"run", kQuick, "--out", dir / "2", "--threads", "2"}).exit_code, 0);
  for (const char* name : {"program.ngc", "cl.csv", "gear.stl", "tooth.vtp", "inspection.csv", "limits.json", "setup.html"})
    EXPECT_EQ(file_text(dir / (std::string("1/") + name)), file_text(dir / (std::string("2/") + name))) << name;
}

}  // namespace
}  // namespace toothpath::test
