// Memory that is not there: one message and one exit code, wherever it happens; nothing half-written. Programs that
// would take more than is good are refused by number. (Not for sanitizers, which map terabytes.)
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

constexpr rlim_t kMiB = rlim_t(1) << 20;

TEST(Memory, WhereItEndsTheProgramSaysSo) {
  const TestDir dir;
  const std::string quick = kSamples + "/spur_quick.toml", out = dir / "out";
  ASSERT_EQ(run_program({"run", quick, "--out", dir / "made", "--quiet"}).exit_code, 0);
  int ended = 0, done = 0;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", quick},
                                                {"surface", quick},
                                                {"run", kSamples + "/bevel_trunnion.toml"},
                                                {"check", quick, dir / "made/program.ngc", "--json"}})
    for (rlim_t mib = 85; mib <= 400; mib += mib / 5) {
      Launch launch;
      launch.arguments = words;
      launch.arguments.insert(launch.arguments.end(), {"--out", out, "--threads", "2"});
      launch.address_space = mib * kMiB;
      const Finished run = run_program(launch);
      if (run.exit_code == 127) continue;  // not even the libraries fit
      if (run.exit_code == 0) {
        ++done;
        std::filesystem::remove_all(out);
        continue;
      }
      ++ended;
      EXPECT_EQ(run.exit_code, 70) << words[0] << " " << mib << " MiB: " << run.err;
      EXPECT_NE(run.err.find("error: out of memory: nothing was written"), std::string::npos) << run.err;
      EXPECT_EQ(names_in(out), std::vector<std::string>{}) << words[0] << " " << mib << " MiB";
      if (words.back() == "--json") { EXPECT_EQ(nlohmann::json::parse(run.out)["exit_code"], 70) << run.out; }
    }
  EXPECT_GT(ended, 4);
  EXPECT_GT(done, 4);
}

// Where memory ends at the very end of a run, the results are all there or none is, and what is said is true.
TEST(Memory, TheExchangeOfResultsIsNeverCutInTwo) {
  const TestDir dir;
  const std::string quick = kSamples + "/spur_quick.toml", out = dir / "out";
  ASSERT_EQ(run_program({"run", quick, "--out", dir / "made", "--quiet"}).exit_code, 0);
  const std::vector<std::string> whole = names_in(dir / "made");
  int ended = 0, done = 0;
  const auto run_within = [&](rlim_t mib) {
    std::filesystem::remove_all(out);
    std::filesystem::copy(dir / "made", out, std::filesystem::copy_options::recursive);
    Launch launch;
    launch.arguments = {"run", quick, "--out", out, "--threads", "2"};
    launch.address_space = mib * kMiB;
    const Finished run = run_program(launch);
    std::vector<std::string> names = names_in(out);
    const std::string when = fmt::format("{} MiB: {} {}", mib, run.exit_code, run.err);
    if (run.exit_code == 0) {
      ++done;
      EXPECT_EQ(std::erase(names, "previous"), 1u) << when;
      EXPECT_EQ(names, whole) << when;
      return true;
    }
    ++ended;
    EXPECT_TRUE(run.exit_code == 70 || run.exit_code == 127) << when;
    const bool moved = std::erase(names, "previous") == 1;
    EXPECT_EQ(moved ? names_in(out + "/previous") : names, whole) << when;
    if (moved) {
      EXPECT_EQ(names, std::vector<std::string>{}) << when;
      EXPECT_NE(run.err.find("out of memory: nothing was written"), std::string::npos) << when;
      EXPECT_NE(run.err.find("note: what stood in " + out + " is in " + out + "/previous"), std::string::npos) << when;
    }
    return false;
  };
  rlim_t no = 85, yes = 400;
  while (yes - no > 8) (run_within((no + yes) / 2) ? yes : no) = (no + yes) / 2;
  for (rlim_t mib = no - 4; mib < yes + 12; mib += 2) run_within(mib);  // near the end of memory both happen
  EXPECT_GT(ended, 2);
  EXPECT_GT(done, 2);
}

/// A program of some lines that would fill the memory by its loops.
Finished check_of(const TestDir& dir, const std::string& body) {
  write_file(dir / "p.ngc", "G21 G17 G90 G94 G40 G49 G80\nG92.1\nG54\nG61\nG53 G0 Z0\n" + body + "M5\nM2\n");
  Launch launch;
  launch.arguments = {"check", kSamples + "/spur_quick.toml", dir / "p.ngc", "--out", dir / "out"};
  launch.address_space = 2500 * kMiB;
  return run_program(launch);
}

const std::string kStart = "T1 M6\nS1000 M3\nG53 G0 Z0\nG0 C0 A0\nG0 X80 Y0\nG43 H1 Z120\nG94 F600\n";

TEST(Memory, ProgramsThatWouldFillItAreRefusedByNumber) {
  const TestDir dir;
  // As many blocks as a text of this length may execute, and a loop may turn.
  const auto loop = [](const std::string& begin, const std::string& a, const std::string& b) {
    std::string pairs;
    for (int k = 0; k < 600; ++k) pairs += a + b;
    return "o1 repeat [7100]\n" + begin + pairs + "o1 endrepeat\n";
  };
  struct Case {
    const char* what;
    std::string body, words;
  };
  for (const Case& c : {
           Case{"moves of no operation", loop("", "G53 G0 X1\n", "G53 G0 X0\n"),
                "moves of one tooth and beside the teeth would have to be kept, more than 8388608"},
           Case{"machine moves ahead of a tooth",
                "(OP 0 roughing)\n" + loop("", "G53 G0 Z-1\n", "G53 G0 Z0\n") + kStart,
                "moves of one tooth and beside the teeth would have to be kept, more than 8388608"},
           Case{"teeth that are no copies",
                "(OP 0 roughing)\n" + kStart + "#1=0\n" + loop("#1=[#1+0.0001]\n", "G1 X[80+#1]\n", "G1 X80\n"),
                "moves would have to be kept, more than 8388608"},
           Case{"long ways round",
                "(OP 0 roughing)\n" + kStart +
                    "G93\no1 repeat [4000]\nG1 X80 C300 F1\nG1 X80.5 C0 F1\no1 endrepeat\nG94 F600\n",
                "motions of the tool, 136 bytes each, would have to be kept"},
       }) {
    const Finished refused = check_of(dir, c.body);
    EXPECT_EQ(refused.exit_code, 3) << c.what << ": " << refused.err.substr(0, 300);
    EXPECT_NE(refused.err.find(c.words), std::string::npos) << c.what << ": " << refused.err.substr(0, 300);
    EXPECT_NE(refused.err.find("p.ngc"), std::string::npos) << refused.err.substr(0, 300);
  }
}

// 230 000 blocks of teeth that are no copies: they were 250 bytes each above what a run takes anyhow.
TEST(Memory, TeethOffTheAxisAreNotHeld) {
  const TestDir dir;
  write_file(dir / "machine.toml", file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml") +
                                       "\n[post]\nlinear_decimals = 3\nrotary_decimals = 4\n");
  std::string job = file_text(kSamples + "/spur_quick.toml");
  const auto change = [&job](const std::string& from, const std::string& to) {
    ASSERT_NE(job.find(from), std::string::npos) << from;
    job.replace(job.find(from), from.size(), to);
  };
  change("\"xyzac_large.toml\"", "\"machine.toml\"");
  change("origin = [3.0, -2.0, 120.0]", "origin = [14.0, -9.0, 120.0]");
  change("\nscallop = 0.02", "\nscallop = 0.004");
  change("chord_tolerance = 0.002", "chord_tolerance = 0.0004");
  write_file(dir / "off.toml", job);
  Launch launch;
  launch.arguments = {"run", dir / "off.toml", "--out", dir / "out", "--threads", "1", "--quiet"};
  launch.address_space = 310 * kMiB;
  const Finished run = run_program(launch);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto report = nlohmann::json::parse(file_text(dir / "out/report.json"));
  EXPECT_GT(report["blocks"].get<int>(), 200'000);
}

}  // namespace
}  // namespace toothpath::test
