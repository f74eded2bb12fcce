// `run --restart` and the order of the teeth from outside: what the files say, what `check` says of the part alone,
// what is refused.
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

std::string with_program_table(const TestDir& dir, const std::string& table) {
  const std::string job = dir / "job.toml";
  std::ofstream(job, std::ios::binary) << file_text(kQuick) << "\n[program]\n" << table << "\n";
  return job;
}

TEST(RestartCommand, SpreadProgramFromTheMiddleIsProven) {
  const TestDir dir;
  const std::string job = with_program_table(dir, "tooth_order = \"spread\"");
  const Finished run = run_program({"run", job, "--restart", "1:7", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_NE(run.out.find("this program begins at operation 1, tooth 7"), std::string::npos) << run.out;
  const std::string program = file_text(dir / "out/program.ngc");
  EXPECT_NE(program.find("(TOOTH ORDER SPREAD: PLACE N CUTS TOOTH N * 23 MOD 60)\n(RESTART AT OPERATION 1 TOOTH 7)\n"
                         "(WHAT THE WHOLE PROGRAM CUTS BEFORE THAT IS TAKEN AS DONE)\n"),
            std::string::npos);
  EXPECT_NE(program.find("(RUN TIME "), std::string::npos);
  EXPECT_EQ(program.find("(OP 0"), std::string::npos);
  EXPECT_NE(program.find("(OP 1 finishing)"), std::string::npos);
  const auto report = nlohmann::json::parse(file_text(dir / "out/report.json"));
  EXPECT_EQ(report["verified"], true);
  EXPECT_EQ(report["restart"]["op"], 1);
  EXPECT_EQ(report["restart"]["tooth"], 7);
  EXPECT_EQ(report["tooth_order"]["stride"], 23);
  EXPECT_EQ(report["operations"].size(), 1u);
  // Its own times and axis ranges, which the whole program exceeds.
  const Finished all = run_program({"run", job, "--out", dir / "whole"});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  const auto whole = nlohmann::json::parse(file_text(dir / "whole/report.json"));
  EXPECT_LT(report["total_minutes"].get<double>(), 0.8 * whole["total_minutes"].get<double>());
  bool narrower = false;
  for (const auto& [letter, axis] : report["axes"].items()) {
    EXPECT_GE(axis["min"].get<double>(), whole["axes"][letter]["min"].get<double>() - 1e-6) << letter;
    EXPECT_LE(axis["max"].get<double>(), whole["axes"][letter]["max"].get<double>() + 1e-6) << letter;
    narrower =
        narrower || axis["max"].get<double>() - axis["min"].get<double>() <
                        whole["axes"][letter]["max"].get<double>() - whole["axes"][letter]["min"].get<double>() - 1e-3;
  }
  EXPECT_TRUE(narrower);
  EXPECT_EQ(report["excess_um"]["operations"].size(), 2u) << "judged as if the earlier part was done";
  EXPECT_NE(report["warnings"][0].get<std::string>().find("taken as done"), std::string::npos);
  // 23 n mod 60 = 7: n = 29. The menu names the line where that number stands.
  const std::size_t at = program.find("(FIRST TOOTH");
  ASSERT_NE(at, std::string::npos);
  const auto line = 2 + std::count(program.begin(), program.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  EXPECT_EQ(program.substr(program.find('\n', at) + 1, 6), "#1=29\n");
  const std::string sheet = file_text(dir / "out/setup.html");
  EXPECT_NE(sheet.find("set place in line " + std::to_string(line)), std::string::npos);
  EXPECT_NE(sheet.find("taken as done"), std::string::npos);
  EXPECT_NE(file_text(dir / "out/report.html").find("taken as done"), std::string::npos);
  // Lengths: a longer tool may use what the gouge tolerance leaves, never less.
  for (const auto& t : report["length_tolerance"]) {
    EXPECT_GT(t["share"].get<double>(), 0);
    EXPECT_LE(t["share"].get<double>(), 1);
    EXPECT_LE(t["flank_share"], t["share"]);
    EXPECT_GE(t["too_long_um"].get<double>(), 2.0 - report["gouge_um"]["bound"].get<double>() - 1e-9);
  }
  EXPECT_EQ(report["length_tolerance"].size(), 2u);
  // Alone it is safe, but leaves what the earlier part cuts: an operation and teeth are not in it.
  const Finished check = run_program({"check", job, dir / "out/program.ngc", "--out", dir / "check"});
  EXPECT_EQ(check.exit_code, 1);
  const auto alone = nlohmann::json::parse(file_text(dir / "check/report.json"));
  ASSERT_GE(alone["reasons"].size(), 2u) << alone["reasons"];
  EXPECT_EQ(alone["reasons"][0], "operation 0 of the job is not in the program");
  EXPECT_NE(alone["reasons"].dump().find("operation 1 does not cut tooth 0, "), std::string::npos) << alone["reasons"];
  for (const auto& reason : alone["reasons"])
    EXPECT_EQ(reason.get<std::string>().find("gouge"), std::string::npos) << reason;
}

TEST(RestartCommand, WhatDoesNotExistIsUsage) {
  const TestDir dir;
  const std::pair<const char*, const char*> cases[] = {
      {"2:0", "--restart = 2:0: the job has the operations 0 to 1"},
      {"0:60", "--restart = 0:60: the gear has the teeth 0 to 59"},
      {"1", "--restart = 1 is not OP:TOOTH, two whole numbers from 0"},
      {"1:x", "--restart = 1:x is not OP:TOOTH, two whole numbers from 0"},
      {"1:-2", "--restart = 1:-2 is not OP:TOOTH, two whole numbers from 0"}};
  for (const auto& [restart, message] : cases) {
    const Finished run = run_program({"run", kQuick, "--restart", restart, "--out", dir / "out"});
    EXPECT_EQ(run.exit_code, 2) << restart;
    EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace toothpath::test
