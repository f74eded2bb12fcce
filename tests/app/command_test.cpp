// The program from outside: exit codes, what lies in the output directory afterwards, faults of the disk, signals.
#include <fmt/format.h>
#include <sys/inotify.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <thread>
#include <tuple>

#include "app/job/file.h"
#include "app/tool_library/tool_library.h"
#include "geometry/base/hash.h"
#include "tests/app/program.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

const std::vector<std::string> kSurfaceFiles = {"data_sheet.html", "gear.stl",    "inspection.csv",
                                                "inspection.dmi",  "limits.html", "limits.json",
                                                "limits.svg",      "report.json", "tooth.vtp"};

TEST(CommandLine, UsageErrorsAreTwo) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"bogus"},
                                                    {"surface"},
                                                    {"surface", kQuick, "--out", "x", "--bogus"},
                                                    {"surface", kQuick, "--out", "x", "--threads", "nan"},
                                                    {"surface", kQuick, "--out", "x", "--threads", "0"},
                                                    {"surface", kQuick, "--out", "x", "--color", "pink"}})
    EXPECT_EQ(run_program(arguments).exit_code, 2);
}

// What was typed is told as it was typed, with what was meant.
TEST(CommandLine, UsageErrorsNameTheWord) {
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"rnu", kQuick}, "unknown command \"rnu\"; did you mean \"run\"?; commands are: new, fit, run, check, "},
      {{"study", "stabilty"}, "unknown command \"stabilty\"; did you mean \"stability\"?; study commands are: "},
      {{"study"}, "a command is missing; study commands are: "},
      {{"run", kQuick, "--ot", "x"}, "unknown option --ot; did you mean \"--out\"?"},
      {{"run", kQuick, "--outt=x"}, "unknown option --outt; did you mean \"--out\"?"},
      {{"run", kQuick, "two", "--out", "x"}, "\"two\" is one word too many"},
      {{"--jsn", "run", kQuick, "--out", "x"}, "unknown option --jsn; did you mean \"--json\"?"},
      {{"run"}, "JOB is required"},
      {{"correct"}, "JOB and --measured are required"},
      {{"check", "--threads", "1"}, "JOB and PROGRAM are required"},
      {{"fit", kQuick}, "--points is required"},
      {{"completion"}, "WHAT is required"},
      {{"r\x1b[31m"}, "unknown command \"r\\x1B[31m\"; commands are: "},
  };
  for (const auto& [arguments, words] : cases) {
    const auto run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(run.err.starts_with(words)) << run.err;
  }
}

// What is missing is not told one option at a time.
TEST(CommandLine, NamesAllThatIsMissingAtOnce) {
  const TestDir dir;
  const std::pair<std::vector<std::string>, std::string> cases[] = {
      {{"probe", kQuick}, "error: probe needs --ball-diameter, --probe-length and --tool\n"},
      {{"probe", kQuick, "--tool", "9"}, "error: probe needs --ball-diameter and --probe-length\n"},
      {{"probe", kQuick, "--results", "touches.txt"}, "error: probe needs --ball-diameter\n"},
  };
  for (auto [arguments, words] : cases) {
    arguments.insert(arguments.end(), {"--out", dir / "out"});
    const auto run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.err, words);
  }
}

// Without --out a run writes into out/ beside its job, every other command into a folder of its own there.
TEST(CommandLine, WithoutOutResultsGoBesideTheJob) {
  const TestDir dir;
  const std::string shop = dir / "shop";
  std::filesystem::create_directory(shop);
  std::filesystem::copy(kSamples + "/offset_shaped.toml", shop + "/gear.toml");
  const auto run = [&](std::vector<std::string> words, const std::string& from) {
    Launch launch;
    launch.arguments = std::move(words);
    launch.in_child = [from] { (void)!::chdir(from.c_str()); };
    return run_program(launch);
  };
  const auto surface = run({"surface", "shop/gear.toml"}, dir.path());
  EXPECT_EQ(surface.exit_code, 0) << surface.err;
  EXPECT_EQ(names_in(shop + "/out"), std::vector<std::string>{"surface"});
  EXPECT_TRUE(std::filesystem::exists(shop + "/out/surface/limits.json"));
  const auto shaper = run({"shaper", "gear.toml"}, shop);
  EXPECT_EQ(shaper.exit_code, 0) << shaper.err;
  EXPECT_EQ(names_in(shop + "/out"), (std::vector<std::string>{"shaper", "surface"}));
  const auto machine = run({"machine", "test", "xyzac_trt"}, dir.path());
  EXPECT_EQ(machine.exit_code, 0) << machine.err;
  EXPECT_TRUE(std::filesystem::exists(dir / "out/machine_test/machine_test.html"));
  // What the help says of it.
  EXPECT_NE(run_program({"run", "--help"}).out.find("(default: out/ beside the job)"), std::string::npos);
  EXPECT_NE(run_program({"check", "--help"}).out.find("(default: out/check/ beside the job)"), std::string::npos);
  EXPECT_NE(run_program({"study", "stability", "--help"}).out.find("(default: out/study_stability/)"),
            std::string::npos);
}

// Nobody who gave no --out must guess what cannot be written.
TEST(CommandLine, AFolderBesideTheJobThatCannotBeMadeNamesOut) {
  const TestDir dir;
  std::filesystem::copy(kQuick, dir / "gear.toml");
  write_file(dir / "out", "mine");
  const auto refused = run_program({"run", dir / "gear.toml"});
  EXPECT_EQ(refused.exit_code, 4);
  EXPECT_NE(refused.err.find("; --out DIR gives another folder\n"), std::string::npos) << refused.err;
  EXPECT_EQ(file_text(dir / "out"), "mine");
  const auto named = run_program({"run", dir / "gear.toml", "--out", dir / "out"});
  EXPECT_EQ(named.exit_code, 4);
  EXPECT_EQ(named.err.find("--out DIR"), std::string::npos) << named.err;
}

// Every number of every command goes through one reader.
TEST(CommandLine, NumbersAreNumbersOfTheirRange) {
  const TestDir dir;
  const std::string pinion = kSamples + "/bevel_pinion.toml";
  struct Case {
    std::vector<std::string> words;
    std::string option, least, most, beyond;
    bool whole = false;
  };
  const std::vector<Case> cases = {
      {{"forces", pinion}, "--torque", "1e-06", "1000000000 N m", "0"},
      {{"contact", kQuick}, "--pinion-teeth", "5", "1000", "0", true},
      {{"contact", kQuick}, "--pinion-teeth", "5", "1000", "-5", true},
      {{"contact", kQuick}, "--offset-error", "-5", "5 mm", "5.01"},
      {{"contact", kQuick}, "--axial-error", "-5", "5 mm", "-5.01"},
      {{"contact", kQuick}, "--wheel-axial-error", "-5", "5 mm", "1e9"},
      {{"contact", kQuick}, "--angle-error", "-1", "1 deg", "1.1"},
      {{"contact", kQuick}, "--compound", "0.1", "100 um", "0"},
      {{"cutter", pinion}, "--tool", "1", "9999", "0", true},
      {{"machine", "test", "t600s"}, "--tool-length", "1", "5000 mm", "-30"},
      {{"study", "strategies", kQuick}, "--strips", "1", "24", "0", true},
      {{"surface", kQuick}, "--threads", "1", "1024", "0", true},
  };
  for (const Case& c : cases) {
    std::vector<std::string> texts = {"nan", "inf",  "-inf", "1e999", "",      "x",
                                      "1,5", "0x10", " 20",  "20 ",   "20abc", c.beyond};
    if (c.whole) texts.insert(texts.end(), {"20.0", "2e1", "99999999999999999999"});
    for (const std::string& text : texts) {
      std::vector<std::string> words = c.words;
      words.insert(words.end(), {"--out", dir / "out", c.option + "=" + text});
      if (text.empty()) {
        words.pop_back();
        words.insert(words.end(), {c.option, ""});
      }
      const Finished refused = run_program(words);
      EXPECT_EQ(refused.exit_code, 2) << c.option << " " << text;
      const std::string said = fmt::format("{} = {} is not a {}number from {} to {}", c.option,
                                           text.empty() ? "\"\"" : text, c.whole ? "whole " : "", c.least, c.most);
      EXPECT_NE(refused.err.find(said), std::string::npos) << refused.err << said;
      EXPECT_FALSE(std::filesystem::exists(dir / "out"));
    }
  }
  EXPECT_EQ(run_program({"forces", pinion, "--torque", "+2.5e1", "--out", dir / "out"}).exit_code, 0);
  EXPECT_EQ(run_program({"surface", kQuick, "--threads", "+1", "--out", dir / "out"}).exit_code, 0);
}

// An unset variable of a script must not mean "all of it".
TEST(CommandLine, EmptyTextsAreRefused) {
  const TestDir dir;
  const std::string pinion = kSamples + "/bevel_pinion.toml", out = dir / "out";
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", kQuick, "--restart", "", "--out", out},
                                                {"run", kQuick, "--restart=", "--out", out},
                                                {"run", "", "--out", out},
                                                {"run", kQuick, "--out", ""},
                                                {"check", kQuick, "", "--out", out},
                                                {"check", kQuick, "x", "--stock", "", "--out", out},
                                                {"check", kQuick, "x", "--fixture", "", "--out", out},
                                                {"correct", kQuick, "--measured", "", "--out", out},
                                                {"contact", pinion, "--mate", "", "--out", out},
                                                {"cutter", pinion, "--cutter-of", "", "--out", out},
                                                {"machine", "show", ""},
                                                {"machine", "show", "t600s", "--out", ""},
                                                {"study", "dhfg", "--file", "", "--out", out}}) {
    const Finished refused = run_program(words);
    EXPECT_EQ(refused.exit_code, 2) << words[0] << " " << words[1] << "\n" << refused.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

TEST(CommandLine, HelpAndVersion) {
  const Finished help = run_program({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.out.find("surface"), std::string::npos);
  const Finished version = run_program({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_TRUE(version.out.starts_with("toothpath ")) << version.out;
}

TEST(CommandLine, HelpThatDoesNotArriveIsFour) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--help"}, {"--version"}, {"run", "--help"}, {"machine", "list"}}) {
    Launch launch;
    launch.arguments = words;
    launch.stdout_file = "/dev/full";
    const Finished full = run_program(launch);
    EXPECT_EQ(full.exit_code, 4) << words.front();
    EXPECT_NE(full.err.find("error: cannot write to the standard output: No space left"), std::string::npos);
    // A reader who has seen enough: there is nobody at the other end of the pipe.
    launch.stdout_file.clear();
    launch.in_child = [] {
      int ends[2];
      if (::pipe(ends) == 0) ::close(ends[0]), ::dup2(ends[1], STDOUT_FILENO);
    };
    const Finished gone = run_program(launch);
    EXPECT_EQ(gone.exit_code, 0) << words.front();
    EXPECT_EQ(gone.err, "");
  }
}

// Places that cannot be used are told as files that cannot be read or written.
TEST(CommandLine, OddPlacesAreThreeOrFourWithAPlace) {
  const TestDir dir;
  const std::string loop = dir / "loop", deep = dir / std::string(300, 'x'), job = dir / "job.toml", long_path = [&] {
    std::string path = dir.path();
    while (path.size() < 5000) path += "/a";
    return path;
  }();
  std::filesystem::create_symlink(loop, loop);
  std::filesystem::copy_file(kQuick, job);
  using Words = std::vector<std::string>;
  const Words kind = {"--gear", "face", "--cut", "shaped", "--machine", "y514", "--teeth", "53", "--module", "2"};
  for (const std::string& place : {loop, loop + "/file", deep, deep + "/file", long_path, dir / "job.toml/file"}) {
    Words made = {"new", "-o", place};
    made.insert(made.end(), kind.begin(), kind.end());
    for (const Words& words :
         {Words{"run", place, "--out", dir / "out"}, Words{"surface", job, "--out", place},
          Words{"machine", "show", place}, Words{"machine", "show", "y514", "--out", place},
          Words{"contact", job, "--out", dir / "out", "--optimise", "--write", place}, Words{"study", "merge", place},
          Words{"check", job, place, "--out", dir / "out"}, made}) {
      if (words.front() == "machine" && place == loop) continue;  // "loop" is no file of a machine either way
      const Finished run = run_program(words);
      const bool taken = words.front() == "new" && place == loop;  // something stands there: usage
      EXPECT_TRUE(run.exit_code == 3 || run.exit_code == 4 ||
                  (run.exit_code == 2 && (taken || words.front() == "contact")))
          << fmt::format("{} {}: {} ", words.front(), place.substr(0, 100), run.exit_code) << run.err;
      EXPECT_NE(run.err.find(": "), std::string::npos);
    }
  }
  EXPECT_EQ(names_in(dir.path()), (std::vector<std::string>{"job.toml", "loop"}));
}

TEST(CommandLine, AFolderOfBytesThatAreNoTextServes) {
  const TestDir dir;
  const std::string folder = dir / "G\xfcnter", job = folder + "/sp\xe4t.toml";
  std::filesystem::create_directory(folder);
  std::filesystem::copy_file(kQuick, job);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", job, "--out", folder + "/out"},
                                                {"surface", job, "--out", folder + "/out"},
                                                {"check", job, folder + "/out/program.ngc", "--out", folder + "/check"},
                                                {"machine", "show", "y514", "--out", folder + "/machine"}}) {
    auto with_json = words;
    with_json.push_back("--json");
    const Finished run = run_program(with_json);
    EXPECT_EQ(run.exit_code, 0) << words.front() << run.err;
    EXPECT_TRUE(nlohmann::json::accept(run.out)) << words.front();
  }
}

// A directory that was removed under the feet of a shell.
TEST(CommandLine, WithoutACurrentDirectoryNothingIsWritten) {
  const TestDir dir;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"surface", kQuick, "--out", "out"},
                                                {"run", "job.toml", "--out", dir / "out"},
                                                {"new", "-o", "job.toml", "--gear", "face", "--cut", "shaped",
                                                 "--machine", "y514", "--teeth", "53", "--module", "2"}}) {
    Launch launch;
    launch.arguments = words;
    launch.in_child = [&] {
      const std::string gone = dir / "gone";
      ::mkdir(gone.c_str(), 0700);
      if (::chdir(gone.c_str()) == 0) ::rmdir(gone.c_str());
    };
    const Finished run = run_program(launch);
    EXPECT_EQ(run.exit_code, 4) << words.front() << run.err;
    EXPECT_NE(run.err.find(words.front() == "surface" ? "out: error: " : "job.toml: error: "), std::string::npos)
        << run.err;
    EXPECT_TRUE(names_in(dir.path()).empty());
  }
  Launch whole;  // nothing is looked up there where all paths are whole
  whole.arguments = {"surface", kQuick, "--out", dir / "out"};
  whole.in_child = [&] {
    ::mkdir((dir / "gone").c_str(), 0700);
    if (::chdir((dir / "gone").c_str()) == 0) ::rmdir((dir / "gone").c_str());
  };
  const Finished run = run_program(whole);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("open " + (dir / "out/limits.html")), std::string::npos) << run.out;
}

// nohup, and jobs that a shell starts in the background.
TEST(CommandLine, ASignalThatTheCallerIgnoresStaysIgnored) {
  for (const int number : {SIGHUP, SIGINT}) {
    const TestDir dir;
    Launch launch;
    launch.arguments = {"run", kQuick, "--out", dir / "out", "--quiet"};
    launch.in_child = [number] { ::signal(number, SIG_IGN); };
    launch.signal_number = number;
    launch.signal_when = dir / "out/.toothpath-lock";
    const Finished run = run_program(launch);
    EXPECT_EQ(run.exit_code, 0) << number << run.err;
  }
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
  const Finished refused = run_program({"surface", kBadJobs + "/module_negative.toml", "--out", dir / "a/b"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(names_in(dir / "a/b"), kSurfaceFiles);
  EXPECT_NE(refused.err.find("note: " + (dir / "a/b") + " stays as it was: surface \"spur-quick\" of 20"),
            std::string::npos)
      << refused.err;
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
    if (name != "report.json") { EXPECT_EQ(file_text(dir / ("1/" + name)), file_text(dir / ("2/" + name))) << name; }
}

TEST(CommandLine, ARunOnOneAndTwoThreadsGivesTheSameBytes) {
  const TestDir dir;
  ASSERT_EQ(run_program({"run", kQuick, "--out", dir / "1", "--threads", "1"}).exit_code, 0);
  ASSERT_EQ(run_program({"run", kQuick, "--out", dir / "2", "--threads", "2"}).exit_code, 0);
  // The cut surface and the proof are in tooth.vtp and in the reports; those carry run times as well.
  for (const char* name : {"program.ngc", "cl.csv", "tooth.vtp", "inspection.csv", "limits.json"})
    EXPECT_EQ(file_text(dir / (std::string("1/") + name)), file_text(dir / (std::string("2/") + name))) << name;
  auto one = nlohmann::json::parse(file_text(dir / "1/report.json")),
       two = nlohmann::json::parse(file_text(dir / "2/report.json"));
  one.erase("stages");
  two.erase("stages");
  EXPECT_EQ(one, two);
}

// The two files of `check` in the wrong order, or one of them twice.
TEST(CommandLine, AJobIsNoProgramAndAProgramNoJob) {
  const TestDir dir;
  const std::string job = std::string(TOOTHPATH_SOURCE_DIR) + "/samples/spur_quick.toml",
                    program = std::string(TOOTHPATH_SOURCE_DIR) + "/tests/golden/samples/spur_quick/linuxcnc.ngc";
  const auto twice = run_program({"check", job, job, "--out", dir / "out"});
  EXPECT_EQ(twice.exit_code, 3);
  EXPECT_NE(twice.err.find("error: this is a job or a machine file, not an NC program"), std::string::npos)
      << twice.err;
  const auto swapped = run_program({"check", program, job, "--out", dir / "out"});
  EXPECT_EQ(swapped.exit_code, 3);
  EXPECT_NE(swapped.err.find("error: this begins as an NC program"), std::string::npos) << swapped.err;
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
  EXPECT_EQ(run_program({"check", kSamples + "/spur_quick.toml", dir / "pipe", "--out", dir / "out"}).exit_code, 3);
  EXPECT_EQ(run_program({"check", kSamples + "/spur_quick.toml", "/dev/zero", "--out", dir / "out"}).exit_code, 3);
  write_file(dir / "long.toml", "# " + std::string(10'000'000, 'x') + "\n");
  EXPECT_EQ(run_program({"surface", dir / "long.toml", "--out", dir / "out"}).exit_code, 3);
  std::filesystem::create_symlink(dir / "loop", dir / "loop");
  EXPECT_EQ(run_program({"surface", dir / "loop", "--out", dir / "out"}).exit_code, 4);
}

TEST(OutputDirectory, PlacesThatCannotBeWrittenAreFour) {
  const TestDir dir;
  write_file(dir / "file", "mine");
  for (const std::string& place :
       {dir / "file", dir / "file/below", std::string("/dev/null/out"), std::string("/proc/out")})
    EXPECT_EQ(run_program({"surface", kQuick, "--out", place}).exit_code, 4) << place;
  EXPECT_EQ(file_text(dir / "file"), "mine");
  std::filesystem::create_directories(dir / "out/gear.stl");
  EXPECT_EQ(run_program({"surface", kQuick, "--out", dir / "out"}).exit_code, 4)
      << "a directory in the place of an output";
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

/// What an earlier run of a face gear may have left, and a file of somebody else.
const std::vector<std::string> kEarlier = {"cl.csv",      "my notes.txt", "program.nc",
                                           "program.ngc", "report.json",  "setup.html"};

void leave_earlier_results(const std::string& out) {
  std::filesystem::create_directories(out);
  for (const auto& name : kEarlier) write_file(out + "/" + name, "old");
}

TEST(OutputDirectory, ARefusedRunLeavesItAsItWas) {
  const TestDir dir;
  leave_earlier_results(dir / "out");
  const std::string missing = dir / "missing.csv";
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"run", kBadJobs + "/module_negative.toml"},
                                                    {"run", kQuick, "--restart", "9:0"},
                                                    {"run", dir / "none.toml"},
                                                    {"shaper", kQuick},
                                                    {"correct", kQuick, "--measured", missing},
                                                    {"contact", kBadJobs + "/module_negative.toml"}}) {
    auto words = arguments;
    words.insert(words.end(), {"--out", dir / "out"});
    EXPECT_NE(run_program(words).exit_code, 0) << arguments.front();
    EXPECT_EQ(names_in(dir / "out"), kEarlier) << arguments.front();
    for (const auto& name : kEarlier)
      EXPECT_EQ(file_text(dir / ("out/" + name)), "old") << arguments.front() << " " << name;
  }
}

TEST(OutputDirectory, AnotherRunMovesTheEarlierOneToPrevious) {
  const TestDir dir;
  leave_earlier_results(dir / "out");
  const Finished run = run_program({"run", kQuick, "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(run.err.starts_with("note: what stood in " + (dir / "out") + " is in " + (dir / "out/previous") +
                                  ": program.ngc of 20"))
      << run.err;
  EXPECT_EQ(names_in(dir / "out/previous"),
            (std::vector<std::string>{"cl.csv", "program.nc", "program.ngc", "report.json", "setup.html"}));
  EXPECT_EQ(file_text(dir / "out/my notes.txt"), "old");
  const auto first = file_text(dir / "out/program.ngc");

  // Not verified: the program moves, the report of the new one stands there alone.
  write_file(dir / "job.toml", not_verified_job());
  const Finished second = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  EXPECT_EQ(second.exit_code, 1) << second.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "out/program.ngc"));
  EXPECT_EQ(nlohmann::json::parse(file_text(dir / "out/report.json"))["verified"], false);
  EXPECT_EQ(file_text(dir / "out/previous/program.ngc"), first);
  EXPECT_FALSE(std::filesystem::exists(dir / "out/previous/program.nc")) << "one generation";
  EXPECT_NE(second.err.find("note: what stood in "), std::string::npos) << second.err;

  // Commands that make no program leave it where it is.
  EXPECT_EQ(run_program({"surface", kQuick, "--out", dir / "out", "--quiet"}).exit_code, 0);
  EXPECT_EQ(file_text(dir / "out/previous/program.ngc"), first);
}

TEST(OutputDirectory, CommandsThatShareItKeepTheProgram) {
  const TestDir dir;
  leave_earlier_results(dir / "out");
  ASSERT_EQ(run_program({"surface", kQuick, "--out", dir / "out", "--quiet"}).exit_code, 0);
  EXPECT_EQ(run_program({"shaper", kSamples + "/offset_shaped.toml", "--out", dir / "out", "--quiet"}).exit_code, 0);
  const auto stroke = file_text(dir / "out/shaper_program.ngc");
  EXPECT_EQ(run_program({"shaper", kSamples + "/offset_shaped.toml", "--out", dir / "out", "--quiet"}).exit_code, 0);
  EXPECT_EQ(file_text(dir / "out/previous_shaper/shaper_program.ngc"), stroke);
  for (const char* name : {"program.nc", "program.ngc", "setup.html", "cl.csv"})
    EXPECT_EQ(file_text(dir / (std::string("out/") + name)), "old") << name;
}

TEST(OutputDirectory, ASignalLeavesNothing) {
  for (const int number : {SIGINT, SIGTERM}) {
    const TestDir dir;
    Launch launch;
    launch.arguments = {"run", kSamples + "/dhfg_paper.toml", "--out", dir / "out"};
    launch.signal_number = number;
    launch.signal_when = dir / "out/.toothpath-lock";
    const Finished run = run_program(launch);
    EXPECT_EQ(run.exit_code, 130);
    EXPECT_TRUE(names_in(dir / "out").empty());
    // Before it looked into the directory it says the first, and both are true.
    EXPECT_TRUE(run.err == "interrupted: nothing was written\n" ||
                run.err == "interrupted: " + (dir / "out") + " holds no results of this command\n")
        << run.err;
  }
}

// In the middle of planning no program stands there any more, and nothing is lost.
TEST(OutputDirectory, ASignalLeavesEarlierResultsInPrevious) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGKILL}) {
    const TestDir dir;
    leave_earlier_results(dir / "out");
    Launch launch;
    launch.arguments = {"run", kSamples + "/dhfg_paper.toml", "--out", dir / "out"};
    launch.signal_number = number;
    launch.signal_when = dir / "out/previous";
    const Finished run = run_program(launch);
    EXPECT_EQ(run.exit_code, number == SIGKILL ? -1 : 130);
    for (const auto& name : kEarlier)
      EXPECT_EQ(file_text(dir / ((name == "my notes.txt" ? "out/" : "out/previous/") + name)), "old") << name;
    const auto names = names_in(dir / "out");
    if (number == SIGKILL) {
      EXPECT_FALSE(std::filesystem::exists(dir / "out/program.ngc"));
      continue;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"my notes.txt", "previous"}));
    EXPECT_TRUE(run.err.starts_with("interrupted: what stood in " + (dir / "out") + " is in " + (dir / "out/previous") +
                                    ": program.n"))
        << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
}

// Whenever it comes: what stands in the directory is a whole run, this one or the one before, and never a mixture.
TEST(OutputDirectory, ASignalAtAnyMomentLeavesAWholeRun) {
  Random random(15);
  const TestDir earlier;
  ASSERT_EQ(run_program({"run", kSamples + "/bevel_trunnion.toml", "--out", earlier / "out", "--quiet"}).exit_code, 0);
  const auto begun = std::chrono::steady_clock::now();
  ASSERT_EQ(run_program({"run", kQuick, "--out", earlier / "quick", "--quiet"}).exit_code, 0);
  const std::chrono::duration<double, std::milli> whole_run = std::chrono::steady_clock::now() - begun;
  int interrupted = 0, done = 0;
  for (int trial = 0; trial < 10; ++trial) {
    const TestDir dir;
    std::filesystem::copy(earlier / "out", dir / "out", std::filesystem::copy_options::recursive);
    Launch launch;
    launch.arguments = {"run", kQuick, "--out", dir / "out", "--quiet"};
    launch.signal_number = trial % 2 == 0 ? SIGINT : SIGTERM;
    launch.signal_after_ms = int(random(0, whole_run.count()));
    const Finished run = run_program(launch);
    ASSERT_TRUE(run.exit_code == 0 || run.exit_code == 130 || run.exit_code == -1) << run.exit_code << run.err;
    ++(run.exit_code == 0 ? done : interrupted);
    int whole = 0;
    for (const std::string folder : {"out", "out/previous"}) {
      const bool program = std::filesystem::exists(dir / (folder + "/program.ngc"));
      if (!program) continue;
      ++whole;
      const auto report = nlohmann::json::parse(file_text(dir / (folder + "/report.json")));
      EXPECT_EQ(report["program"]["sha256"], sha256_hex(file_text(dir / (folder + "/program.ngc")))) << trial;
    }
    EXPECT_EQ(whole, run.exit_code == 0 ? 2 : 1) << trial << ": " << launch.signal_after_ms << " ms";
  }
  std::printf("%d interrupted, %d done\n", interrupted, done);
  EXPECT_GT(interrupted, 0);
}

TEST(OutputDirectory, ASecondRunAtTheSameTimeIsFour) {
  const TestDir dir;
  const Finished second = [&] {
    Launch first;
    first.arguments = {"run", kSamples + "/dhfg_paper.toml", "--out", dir / "out"};
    first.signal_number = SIGTERM;
    first.signal_when = dir / "out/.toothpath-lock";
    Finished other;
    first.before_signal = [&] { other = run_program({"surface", kQuick, "--out", dir / "out"}); };
    EXPECT_EQ(run_program(first).exit_code, 130);
    return other;
  }();
  EXPECT_EQ(second.exit_code, 4);
  EXPECT_NE(second.err.find("another run is writing into this directory"), std::string::npos) << second.err;
}

// Many at once, each with its own name for the job: whoever is told 0 left all of it, and a program with its own
// report.
TEST(OutputDirectory, RunsAtOnceNeverMix) {
  const TestDir dir;
  constexpr int kRuns = 6;
  const std::string job = file_text(kQuick), out = dir / "out";
  for (int round = 0; round < 2; ++round) {
    std::vector<int> codes(kRuns);
    std::vector<std::thread> all;
    for (int k = 0; k < kRuns; ++k) {
      const std::string file = dir / fmt::format("job{}.toml", k);
      write_file(file, replaced(job, "spur-quick", fmt::format("run {}", k)));
      all.emplace_back([&, k, file] {
        codes[std::size_t(k)] = run_program({"run", file, "--out", out, "--threads", "1"}).exit_code;
      });
    }
    for (auto& thread : all) thread.join();
    EXPECT_GE(std::count(codes.begin(), codes.end(), 0), 1);
    EXPECT_EQ(std::count(codes.begin(), codes.end(), 0) + std::count(codes.begin(), codes.end(), 4), kRuns);
    const auto report = nlohmann::json::parse(file_text(out + "/report.json"));
    const std::string name = report["job"];
    EXPECT_EQ(codes[std::size_t(name.back() - '0')], 0) << name;
    const std::string program = file_text(out + "/program.ngc");
    EXPECT_EQ(sha256_hex(program), report["program"]["sha256"]) << name;
    for (const auto& file : report["files"]) EXPECT_TRUE(std::filesystem::exists(out + "/" + std::string(file)));
    for (const auto& file : names_in(out)) EXPECT_FALSE(file.starts_with(".toothpath-")) << file;
  }
}

// The program appears after everything else, and goes before everything else.
TEST(OutputDirectory, AProgramStandsWithAllTheRestOnly) {
  const TestDir dir;
  const std::string out = dir / "out";
  ASSERT_EQ(run_program({"run", kQuick, "--out", out, "--quiet"}).exit_code, 0);
  auto whole = names_in(out);
  const int queue = ::inotify_init1(IN_NONBLOCK);
  ASSERT_GE(::inotify_add_watch(queue, out.c_str(), IN_MOVE | IN_DELETE), 0);
  ASSERT_EQ(run_program({"run", kQuick, "--out", out, "--quiet"}).exit_code, 0);
  std::set<std::string> there(whole.begin(), whole.end());
  int without = 0;
  alignas(inotify_event) char bytes[1 << 16];
  for (ssize_t got = 0; (got = ::read(queue, bytes, sizeof bytes)) > 0;)
    for (const char* at = bytes; at < bytes + got;) {
      const auto* event = reinterpret_cast<const inotify_event*>(at);
      at += sizeof *event + event->len;
      const std::string name = event->len > 0 ? event->name : "";
      if (name.starts_with(".toothpath-") || name == "previous") continue;
      if (there.contains("program.ngc")) EXPECT_EQ(there, std::set<std::string>(whole.begin(), whole.end())) << name;
      else ++without;
      if ((event->mask & IN_MOVED_TO) != 0) there.insert(name);
      else there.erase(name);
    }
  ::close(queue);
  EXPECT_EQ(there, std::set<std::string>(whole.begin(), whole.end()));
  EXPECT_GT(without, int(whole.size()));
}

// The measurement lies where the run would write its own inspection points.
TEST(OutputDirectory, AnInputThatTheRunWouldReplaceIsRefused) {
  const TestDir dir;
  ASSERT_EQ(run_program({"surface", kQuick, "--out", dir / "out", "--quiet"}).exit_code, 0);
  std::string measured = file_text(dir / "out/inspection.csv");
  measured = std::regex_replace(measured, std::regex("\n"), ",1.0\n");
  measured.replace(0, measured.find('\n'), "zone,flank,row,column,x,y,z,i,j,k,deviation_um");
  write_file(dir / "out/inspection.csv", measured);
  const Finished run = run_program({"correct", kQuick, "--measured", dir / "out/inspection.csv", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find("inspection.csv: error: this input lies where the command writes its own inspection.csv"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(file_text(dir / "out/inspection.csv"), measured);
  EXPECT_EQ(names_in(dir / "out"), kSurfaceFiles);
}

TEST(Machine, APartThatDoesNotFitIsRefusedWithBothNumbers) {
  const TestDir dir;
  std::string text = replaced(file_text(kSamples + "/dhfg_paper.toml"), "file = \"xyzac_large.toml\"",
                              "file = \"t600s.toml\"\naccept_assumed = true");
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
  const std::string text = file_text(kSamples + "/dhfg_ball.toml");
  const auto line_end = text.find('\n', text.find("accept_assumed"));
  const auto line_start = text.rfind('\n', text.find("accept_assumed"));
  write_file(dir / "job.toml", text.substr(0, line_start) + text.substr(line_end));
  const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("axes.A.point"), std::string::npos) << run.err;
}

TEST(Run, LinuxCncGetsTheLinesOfItsToolTable) {
  const TestDir dir;
  ASSERT_EQ(run_program({"run", kQuick, "--out", dir / "out"}).exit_code, 0);
  const auto tools = tool_library::read_tool_library(dir / "out/program_tools.tbl");
  ASSERT_TRUE(tools) << tools.error().text();
  const auto job = job::read_job_file(kQuick);
  ASSERT_TRUE(job);
  ASSERT_EQ(tools->size(), job.value().tools.size());
  for (const auto& tool : job.value().tools) {
    const auto line = tool_library::tool_of_library(*tools, tool.number);
    ASSERT_TRUE(line);
    EXPECT_EQ(*line->keys.find("length")->value.number(), tool.length_mm);
    EXPECT_EQ(*line->keys.find("diameter")->value.number(), tool.diameter_mm);
  }
  // A control whose tools are entered by hand gets no such file.
  const std::string siemens = std::regex_replace(file_text(kQuick), std::regex("file = \"[^\"]*\""),
                                                 "file = \"siemens_ac.toml\"\naccept_assumed = true");
  write_file(dir / "siemens.toml", siemens);
  const Finished other = run_program({"run", dir / "siemens.toml", "--out", dir / "siemens"});
  EXPECT_EQ(other.exit_code, 0) << other.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "siemens/program_tools.tbl"));
}

TEST(Run, ASmallGearGoesTheWholeWay) {
  const TestDir dir;
  const Finished run = run_program({"run", kQuick, "--out", dir / "1", "--threads", "1"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const auto names = names_in(dir / "1");
  for (const char* name : {"cl.csv", "gear.stl", "inspection.csv", "limits.json", "program.ngc", "report.html",
                           "report.json", "setup.html", "tooth.vtp"})
    EXPECT_TRUE(std::binary_search(names.begin(), names.end(), name)) << name;
  EXPECT_TRUE(run.out.starts_with("spur-quick\n  verified            yes\n  results             open " +
                                  (dir / "1/report.html") + " first; for the machine: " + (dir / "1/setup.html") +
                                  " and program.ngc\n"))
      << run.out;
  const auto report = nlohmann::json::parse(file_text(dir / "1/report.json"));
  EXPECT_EQ(report["verified"], true);
  EXPECT_LE(report["gouge_um"]["measured"].get<double>(), report["gouge_um"]["bound"].get<double>());
  EXPECT_LE(report["gouge_um"]["bound"].get<double>(), 2.0);

  ASSERT_EQ(run_program({"run", kQuick, "--out", dir / "2", "--threads", "2"}).exit_code, 0);
  for (const char* name :
       {"program.ngc", "cl.csv", "gear.stl", "tooth.vtp", "inspection.csv", "limits.json", "setup.html"})
    EXPECT_EQ(file_text(dir / (std::string("1/") + name)), file_text(dir / (std::string("2/") + name))) << name;

  EXPECT_NE(file_text(dir / "2/setup.html").find("<td>face gear, z 60, shaper z 20, "), std::string::npos);
  EXPECT_NE(file_text(dir / "2/setup.html")
                .find("<td>work offset, besides</td><td>A, C, R of G54 must be 0: the program looks and ends if they "
                      "are not</td>"),
            std::string::npos);

  // A refused run into the same directory leaves every one of its files, and says whose they are.
  const auto text_before = file_text(dir / "2/report.json");
  const Finished refused = run_program({"run", kBadJobs + "/module_negative.toml", "--out", dir / "2", "--quiet"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(names_in(dir / "2"), names);
  EXPECT_EQ(file_text(dir / "2/report.json"), text_before);
  const std::string sha = report["program"]["sha256"].get<std::string>().substr(0, 12);
  EXPECT_TRUE(std::regex_search(
      refused.err,
      std::regex("\nnote: .*/2 stays as it was: run \"spur-quick\" of 20.*, program.ngc \\(sha256 " + sha + "\\)\n$")))
      << refused.err;
}

// Every control has its own names of work offsets: written, read back, and refused where the control has none of that
// name.
// The page holds proven deviations and estimated bending against the tolerance that is asked, and names the class: one
// more for every factor sqrt(2).
TEST(Run, ThePageTellsWhatTheAccuracyIsMadeOf) {
  const TestDir dir;
  for (const double asked_um : {40.0, 400.0, 2000.0}) {
    write_file(dir / "job.toml",
               file_text(kQuick) + fmt::format("form_tolerance = {}\niso_class = 7\n", asked_um / 1000));
    const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
    if (asked_um > 1000) {
      EXPECT_EQ(run.exit_code, 3);
      EXPECT_NE(run.err.find("form_tolerance = 2"), std::string::npos) << run.err;
      continue;
    }
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const std::string page = file_text(dir / "out/report.html");
    const auto value = [&](const std::string& part) {
      std::smatch m;
      const std::regex row("<td[^>]*>" + part + "</td><td[^>]*>([0-9.]+)</td>");
      EXPECT_TRUE(std::regex_search(page, m, row)) << part;
      return m.empty() ? 0.0 : std::stod(m[1]);
    };
    const double deep = value("cut too deep"), left = value("left on the flanks"), bends = value("bending"),
                 sum = value("together");
    const auto report = nlohmann::json::parse(file_text(dir / "out/report.json"));
    EXPECT_NEAR(deep, std::max(0.0, report["gouge_um"]["bound"].get<double>()), 0.006);
    EXPECT_LE(left, report["excess_um"]["finished"]["bound"].get<double>() + 0.006);
    EXPECT_NEAR(sum, deep + left + bends, 0.02 + 0.06 * bends);  // bending is told in few digits
    std::smatch m;
    ASSERT_TRUE(std::regex_search(page, m, std::regex("class 7 asked, (none|[0-9]+) reached")));
    const bool none = m[1] == "none";
    const int reached = none ? 12 : std::stoi(m[1]);
    EXPECT_TRUE(none || reached <= 11);
    if (!none) { EXPECT_LE(sum, asked_um * std::pow(2, 0.5 * (reached - 7)) * 1.001); }
    EXPECT_GT(sum, asked_um * std::pow(2, 0.5 * (reached - 8)) * 0.999);
    EXPECT_EQ(page.find(": reached; class") != std::string::npos, sum <= asked_um);
  }
}

TEST(WorkOffset, IsThatOfTheControl) {
  const std::string quick = file_text(kQuick);
  const auto job_on = [&](const std::string& machine, const std::string& offset) {
    std::string job = std::regex_replace(quick, std::regex("file = \"xyzac_large.toml\""),
                                         "file = \"" + machine + "\"\naccept_assumed = true");
    job = std::regex_replace(job, std::regex("origin = .*"), "origin = [1.0, 2.0, 40.0]");
    job = std::regex_replace(job, std::regex("work_offset_at = .*"), "work_offset_at = [1.0, 2.0, 30.0]");
    return std::regex_replace(job, std::regex("work_offset = .*"), "work_offset = \"" + offset + "\"");
  };
  struct Case {
    std::string machine, offset, extension, written;
  };
  for (const auto& [machine, offset, extension, written] :
       {Case{"fanuc_ac.toml", "G54.1 P3", "nc", "\nG54.1 P3\n"}, Case{"siemens_ac.toml", "G505", "mpf", "\nG505\n"},
        Case{"heidenhain_ac.toml", "12", "h", "Q339=+12\n"}, Case{"heidenhain_ac.toml", "G55", "h", "Q339=+2\n"}}) {
    const TestDir dir;
    write_file(dir / "job.toml", job_on(machine, offset));
    const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << machine << " " << offset << " " << run.err;
    if (run.exit_code != 0) continue;
    EXPECT_NE(file_text(dir / ("out/program." + extension)).find(written), std::string::npos)
        << machine << " " << offset;
  }
  for (const auto& [machine, offset, named] :
       {std::tuple{"siemens_ac.toml", "G58", "G505 to G599"}, std::tuple{"fanuc_ac.toml", "G59.1", "G54.1 P1 to P300"},
        std::tuple{"xyzac_large.toml", "G54.1 P3", "G59.1 to G59.3"},
        std::tuple{"heidenhain_ac.toml", "G505", "presets 1 to 99"}}) {
    const TestDir dir;
    write_file(dir / "job.toml", job_on(machine, offset));
    const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out"});
    EXPECT_EQ(run.exit_code, 3) << machine << " " << offset;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
  }
}

// The pitch angle of 15 deg lays the tool almost flat over the small end of the pinion. With the tip in control, links
// keep its height: the thick flute reaches 10 mm below it.
TEST(BevelLinks, AFlatToolPassesOverTheSmallEnd) {
  const TestDir dir;
  write_file(dir / "job.toml", R"(schema = 1
name = "steep-pinion"

[gear]
type = "equal_base_circle_bevel_gear"
teeth = 7
pitch_angle = 15.0
outer_transverse_module = 6.0
pressure_angle = 22.5
outer_spiral_angle = 5.0
face_width = 6.0
form = "single"
hand = "right"
addendum = 4.125
dedendum = 5.156

[machine]
file = "fanuc_ac.toml"
accept_assumed = true

[setup]
origin = [0.0, 0.0, 30.0]
axis = "down"
work_offset = "G54"
work_offset_at = [0.0, 0.0, 0.0]

[verify]
gouge_tolerance = 0.003
teeth = "one"

[[tool]]
number = 3
type = "finger_mill"
module = 3.938
tip_radius = 0.681
rack_depth = 4.125
profile_height = 5.221
length = 102.61
shank_diameter = 28.871
holder = [[32.0, 32.0, 40.0]]
stick_out = 25.38
flute_length = 13.377

[[operation]]
type = "finger_finishing"
tool = 3
speed = 5000
feed = 100.0
chord_tolerance = 0.005
)");
  const Finished run = run_program({"run", dir / "job.toml", "--out", dir / "out", "--quiet"});
  const auto report = nlohmann::json::parse(file_text(dir / "out/report.json"));
  EXPECT_TRUE(report["clearance"]["rapids_clear"].get<bool>()) << run.err;
}

}  // namespace
}  // namespace toothpath::test
