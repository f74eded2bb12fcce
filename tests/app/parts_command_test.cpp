// Programs in parts and tools that last so many minutes, from outside: which files there are, what they say, what
// `check` says of a part alone, what stays of an earlier run, what is refused.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/report.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

const std::string kSpurQuick = kSamples + "/spur_quick.toml";

/// The sample with more keys of its first tool, another machine, and a table [program].
std::string job_with(const TestDir& dir, const std::string& program, const std::string& tool = "",
                     const std::string& machine = "") {
  std::string text = file_text(kSpurQuick);
  const auto put = [&](const std::string& at, const std::string& by) {
    const std::size_t found = text.find(at);
    EXPECT_NE(found, std::string::npos) << at;
    text.replace(found, at.size(), by);
  };
  if (!tool.empty()) put("stick_out = 16.0\n", "stick_out = 16.0\n" + tool + "\n");
  if (!machine.empty()) put("file = \"xyzac_large.toml\"", "accept_assumed = true\nfile = \"" + machine + "\"");
  if (!program.empty()) text += "\n[program]\n" + program + "\n";
  write_file(dir / "job.toml", text);
  return dir / "job.toml";
}

std::set<std::string> programs_in(const std::string& folder) {
  std::set<std::string> out;
  for (const std::string& name : names_in(folder))
    if (name.starts_with("program") && !name.ends_with(".tbl")) out.insert(name);
  return out;
}

std::string said(const Json& report, const char* list) {
  std::string out;
  for (const auto& text : report[list]) out += text.get<std::string>() + "\n";
  return out;
}

TEST(PartsCommand, EveryPartIsAProgramOfItsOwnAndNoneStaysBehind) {
  const TestDir dir;
  const std::string out = dir / "out";
  const Finished run = run_program({"run", job_with(dir, "teeth_per_program = 25"), "--out", out});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const std::set<std::string> all = {"program.ngc",   "program_1.ngc", "program_2.ngc", "program_3.ngc",
                                     "program_4.ngc", "program_5.ngc", "program_6.ngc"};
  EXPECT_EQ(programs_in(out), all);
  EXPECT_NE(run.out.find("program_1.ngc to program_6.ngc"), std::string::npos) << run.out;
  const Json report = report_in(out);
  ASSERT_EQ(report["parts"].size(), 6U);
  double cutting = 0;
  for (std::size_t n = 0; n < 6; ++n) {
    const Json& part = report["parts"][n];
    EXPECT_EQ(part["file"], fmt::format("program_{}.ngc", n + 1));
    EXPECT_EQ(part["op"], n < 3 ? 0 : 1);
    EXPECT_EQ(part["places"], (Json::array({25 * (n % 3), std::min<std::size_t>(60, 25 * (n % 3) + 25)})));
    EXPECT_EQ(part["tools"], Json::array({1}));
    cutting += part["cutting_minutes"].get<double>();
    const std::string text = file_text(out + "/" + part["file"].get<std::string>());
    EXPECT_EQ(text.size(), part["bytes"].get<std::size_t>());
    EXPECT_NE(text.find(fmt::format("(PART {} OF 6: OPERATION {}, TEETH {} TO {})", n + 1, n < 3 ? 0 : 1, 25 * (n % 3),
                                    n % 3 == 2 ? 59 : 25 * (n % 3) + 24)),
              std::string::npos);
    EXPECT_NE(text.find("T1"), std::string::npos);
    EXPECT_LE(std::count(text.begin(), text.begin() + std::ptrdiff_t(text.find("G21")), '\n'), 24);
  }
  EXPECT_NEAR(cutting, report["cutting_minutes"].get<double>(), 1e-6 * cutting);
  const std::string sheet = file_text(out + "/setup.html");
  for (const char* text : {"Programs in parts", "program_4.ngc", "parts 1 to 3"})
    EXPECT_NE(sheet.find(text), std::string::npos) << text;
  // Alone a part leaves what the others cut.
  const Finished check = run_program({"check", dir / "job.toml", out + "/program_5.ngc", "--out", dir / "check"});
  EXPECT_EQ(check.exit_code, 1);
  const Json alone = report_in(dir / "check");
  EXPECT_NE(said(alone, "warnings").find("this is part 5 of 6 (operation 1, teeth 25 to 49)"), std::string::npos)
      << said(alone, "warnings");
  EXPECT_EQ(alone["conditions"]["hash"], "fits");
  // Fewer parts, then none: those of before are where the rest of that run is.
  ASSERT_EQ(run_program({"run", job_with(dir, "split = \"operations\""), "--out", out, "--quiet"}).exit_code, 0);
  EXPECT_EQ(programs_in(out), (std::set<std::string>{"program.ngc", "program_1.ngc", "program_2.ngc"}));
  EXPECT_EQ(programs_in(out + "/previous"), all);
  ASSERT_EQ(run_program({"run", kSpurQuick, "--out", out, "--quiet"}).exit_code, 0);
  EXPECT_EQ(programs_in(out), (std::set<std::string>{"program.ngc"}));
  EXPECT_EQ(programs_in(out + "/previous"), (std::set<std::string>{"program.ngc", "program_1.ngc", "program_2.ngc"}));
  // A restart is one program to the end.
  const Finished restart =
      run_program({"run", job_with(dir, "teeth_per_program = 25"), "--restart", "1:30", "--out", out});
  ASSERT_EQ(restart.exit_code, 0) << restart.err;
  EXPECT_EQ(programs_in(out), (std::set<std::string>{"program.ngc"}));
  EXPECT_NE(restart.out.find("parts of it are not written"), std::string::npos) << restart.out;
}

TEST(PartsCommand, NothingStaysOfARunThatIsNotVerified) {
  const TestDir dir;
  write_file(dir / "strict.toml", not_verified_job() + "teeth_per_program = 30\n");
  EXPECT_EQ(run_program({"run", dir / "strict.toml", "--out", dir / "out", "--quiet"}).exit_code, 1);
  EXPECT_TRUE(programs_in(dir / "out").empty());
}

TEST(PartsCommand, NumbersFollowOneAnother) {
  const TestDir dir;
  const std::string job = job_with(dir, "number = 1200\nteeth_per_program = 20", "", "fanuc_ac");
  const Finished run = run_program({"run", job, "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  std::set<std::string> numbers;
  std::size_t said = 0;
  const Json report = report_in(dir / "out");
  ASSERT_EQ(report["parts"].size(), 6U);
  for (const std::string& name : programs_in(dir / "out")) {
    std::istringstream lines(file_text(dir / ("out/" + name)));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with("O")) {
        numbers.insert(line.substr(0, 5));
        ++said;
      }
  }
  EXPECT_EQ(numbers.size(), said) << "a number stands in two programs";
  EXPECT_TRUE(numbers.contains("O1200"));
  std::string before = "O1200";
  for (const Json& part : report["parts"]) {
    EXPECT_GT(part["name_on_control"].get<std::string>(), before);
    before = part["name_on_control"].get<std::string>();
  }
  const Finished high = run_program(
      {"run", job_with(dir, "number = 7995\nteeth_per_program = 5", "", "fanuc_ac"), "--out", dir / "high"});
  EXPECT_EQ(high.exit_code, 3);
  EXPECT_NE(high.err.find("job.toml:"), std::string::npos);
  EXPECT_NE(high.err.find("above O7999"), std::string::npos) << high.err;
}

TEST(ToolLifeCommand, SistersGoOnBetweenTeeth) {
  const TestDir dir;
  const Finished plain = run_program({"run", kSpurQuick, "--out", dir / "plain", "--quiet"});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  const double minutes = report_in(dir / "plain")["cutting_minutes"].get<double>();
  const double life = 0.3 * minutes;
  const std::string job =
      job_with(dir, "tooth_order = \"spread\"", fmt::format("life = {:.4f}\nsisters = [21, 22, 23]", life));
  const Finished run = run_program({"run", job, "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const Json report = report_in(dir / "out");
  ASSERT_EQ(report["tool_life"].size(), 4U);
  double sum = 0;
  int places = 0;
  for (const Json& use : report["tool_life"]) {
    EXPECT_LE(use["minutes"].get<double>(), life);
    EXPECT_EQ(use.contains("sister_of"), use["tool"] != 1);
    sum += use["minutes"].get<double>();
    for (const Json& s : use["stretches"]) places += s["places"][1].get<int>() - s["places"][0].get<int>();
  }
  EXPECT_NEAR(sum, minutes, 1e-3 * minutes);
  EXPECT_EQ(places, 120);
  EXPECT_EQ(report["verified"], true);
  EXPECT_EQ(report["gouge_um"]["measured"], report_in(dir / "plain")["gouge_um"]["measured"]);
  const std::string program = file_text(dir / "out/program.ngc");
  EXPECT_NE(program.find("SISTER OF T1)"), std::string::npos);
  EXPECT_NE(program.find("MIN, THEN T21, T22, T23)"), std::string::npos);
  EXPECT_NE(program.find("T21 M6"), std::string::npos);
  const std::string sheet = file_text(dir / "out/setup.html");
  EXPECT_NE(sheet.find("Tool life"), std::string::npos);
  EXPECT_NE(sheet.find("T22, sister of T1"), std::string::npos);
  EXPECT_NE(file_text(dir / "out/program_tools.tbl").find("T23"), std::string::npos);
  // The same program is right for `check`; for a job whose tools last less it is a warning with its line.
  ASSERT_EQ(run_program({"check", job, dir / "out/program.ngc", "--out", dir / "check"}).exit_code, 0);
  EXPECT_EQ(said(report_in(dir / "check"), "warnings").find("has cut for its life"), std::string::npos);
  const std::string shorter =
      job_with(dir, "tooth_order = \"spread\"", fmt::format("life = {:.4f}\nsisters = [21, 22, 23]", 0.2 * minutes));
  ASSERT_EQ(run_program({"check", shorter, dir / "out/program.ngc", "--out", dir / "check"}).exit_code, 0);
  const std::string warned = said(report_in(dir / "check"), "warnings");
  EXPECT_NE(warned.find(": T1 has cut for its life of"), std::string::npos) << warned;
  EXPECT_NE(warned.find("line "), std::string::npos);
  // A tool that is no sister.
  const std::string stranger = job_with(dir, "", "life = 1000\nsisters = [31, 32, 33]");
  EXPECT_NE(run_program({"check", stranger, dir / "out/program.ngc", "--out", dir / "check"}).exit_code, 0);
}

// Teeth that are written out in TCP are looked at one by one, also those that a sister begins with.
TEST(ToolLifeCommand, WrittenOutTeethBehindAChangeAreCut) {
  const TestDir dir;
  std::string machine = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml");
  machine = replaced(replaced(machine, "\"linuxcnc\"", "\"siemens\""), "tcp = \"none\"", "tcp = \"angles\"");
  write_file(dir / "written.toml", machine + "\n[post]\nindex_loop = false\n");
  const std::string job = job_with(dir, "", "life = 20\nsisters = [21, 22, 23, 24, 25, 26, 27]", "written.toml");
  const Finished run = run_program({"run", job, "--out", dir / "out", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GE(report_in(dir / "out")["tool_life"].size(), 3U);
  // A tooth that a sister begins with, left out: from its comment to the next.
  std::string text = file_text(dir / "out/program.mpf");
  const std::size_t sister = text.find("SISTER OF T1"), tooth = text.find(";TOOTH ", sister),
                    next = text.find(";TOOTH ", tooth + 1);
  ASSERT_NE(next, std::string::npos);
  const std::string number = text.substr(tooth + 7, text.find('\n', tooth) - tooth - 7);
  text.erase(tooth, next - tooth);
  write_file(dir / "less.mpf", text);
  const Finished check = run_program({"check", job, dir / "less.mpf", "--out", dir / "check"});
  EXPECT_EQ(check.exit_code, 1) << check.err;
  EXPECT_NE(check.err.find("does not cut tooth " + number), std::string::npos) << number << check.err;
}

TEST(ToolLifeCommand, RestartCallsTheSisterOfThatTooth) {
  const TestDir dir;
  const std::string job = job_with(dir, "", "life = 20\nsisters = [21, 22, 23, 24, 25, 26, 27, 28]");
  const Finished run = run_program({"run", job, "--out", dir / "out", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Json report = report_in(dir / "out");
  ASSERT_GE(report["tool_life"].size(), 2U) << "the sample cuts for less than the life of a tool";
  const Json& use = report["tool_life"].back();
  const Json& stretch = use["stretches"].back();
  const int tooth = stretch["places"][1].get<int>() - 1;
  const Finished restart = run_program(
      {"run", job, "--restart", fmt::format("{}:{}", stretch["op"].get<int>(), tooth), "--out", dir / "restart"});
  ASSERT_EQ(restart.exit_code, 0) << restart.err << restart.out;
  const std::string program = file_text(dir / "restart/program.ngc");
  EXPECT_NE(program.find(fmt::format("T{} M6", use["tool"].get<int>())), std::string::npos);
  EXPECT_EQ(program.find("T1 M6"), std::string::npos);
}

TEST(ToolLifeCommand, WhatDoesNotLastIsRefusedWithItsPlace) {
  const TestDir dir;
  const auto refused = [&](const std::string& tool) {
    const Finished run = run_program({"run", job_with(dir, "", tool), "--out", dir / "out", "--quiet"});
    EXPECT_EQ(run.exit_code, 3) << run.err;
    return run.err;
  };
  const std::string one = refused("life = 0.01\nsisters = [21]"), none = refused("life = 20"),
                    few = refused("life = 20\nsisters = [21]");
  EXPECT_NE(one.find("job.toml:38:8: error: one tooth takes "), std::string::npos) << one;
  EXPECT_NE(none.find("job.toml:38:8: error: tool 1 lasts 20 min, the program cuts for "), std::string::npos) << none;
  EXPECT_NE(few.find("job.toml:39:11: error: tool 1 and 1 sister last 40 min"), std::string::npos) << few;
  EXPECT_NE(few.find("min are missing"), std::string::npos) << few;
}

}  // namespace
}  // namespace toothpath::test
