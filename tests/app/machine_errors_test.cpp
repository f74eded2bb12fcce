// `study machine-errors`: what single errors do to the flanks, by hand; the study cut into shards, killed and merged.
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "app/job/file.h"
#include "app/process/program_report.h"
#include "app/process/proof_limits.h"
#include "app/studies/errors/real_flanks.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;
constexpr process::FlankGrid kGrid{10, 7};
constexpr double kScallop_mm = 0.001;

/// A job planned, posted and proven, and its program on machines with errors.
struct Made {
  TestDir dir;
  flow::Run run{true};
  std::unique_ptr<errors::RealFlanks> flanks;

  explicit Made(const std::string& job_text) {
    const std::string file = dir / "job.toml";
    write_file(file, job_text);
    auto job = job::read_job_file(file);
    if (!job) return;
    run.job = std::move(job).value();
    if (!flow::prepare(run, {}).empty()) return;
    auto scratch = app::OutputDir::open(dir / "scratch", {"program."});
    if (!scratch) return;
    const auto limits = process::proof_limits(run.job);
    if (flow::plan_post_and_prove(run, *scratch, limits, kGrid)) return;
    auto made = errors::RealFlanks::make(run, limits, kGrid);
    EXPECT_TRUE(made) << made.error().text();
    if (made) flanks = std::move(*made);
  }
};

/// The gear of spur_quick finished finely.
class Flanks : public ::testing::Test {
 protected:
  static Made* made;

  static void SetUpTestSuite() {
    made = new Made(replaced(replaced(file_text(kSamples + "/spur_quick.toml"), "scallop = 0.02",
                                      "scallop = " + std::to_string(kScallop_mm)),
                             "chord_tolerance = 0.002", "chord_tolerance = 0.0005"));
    ASSERT_TRUE(made->flanks);
  }
  static void TearDownTestSuite() {
    delete made;
    made = nullptr;
  }

  static std::vector<proof::SurfaceGrid> surface(const errors::Drawn& drawn, int tooth) {
    auto grids = made->flanks->surface(drawn, tooth);
    EXPECT_TRUE(grids) << grids.error().text();
    return std::move(*grids);
  }
  /// Every point of the flanks changes by what `expected` says of its normal (out of the material), um.
  /// @param cusp_um how much a cusp may change with where it stands
  template <typename Expected>
  static void expect_change(const errors::Drawn& drawn, int tooth, double cusp_um, Expected expected) {
    const auto nominal = surface({}, 0), real = surface(drawn, tooth);
    ASSERT_EQ(nominal.size(), real.size());
    int points = 0;
    for (std::size_t g = 0; g < real.size(); ++g) {
      if (path::region_of(real[g].patch) != path::Region::flank) continue;
      for (std::size_t k = 0; k < real[g].points.size(); ++k) {
        if (real[g].reachable[k] == 0) continue;
        const double change = double(real[g].excess_um.back()[k]) - double(nominal[g].excess_um.back()[k]);
        EXPECT_NEAR(change, expected(real[g].normals[k]), cusp_um) << to_string(real[g].patch) << " point " << k;
        ++points;
      }
    }
    EXPECT_GT(points, 50);
  }
  /// The lean of a cusp's sides: what a shift along the surface can do to the excess, as a share of the shift.
  static double cusp_slope() { return std::sqrt(2 * 1.3 * kScallop_mm / made->run.job.tools[0].radius_mm()); }
};
Made* Flanks::made = nullptr;

/// The numbers of a run's own proof, to the last bit.
TEST_F(Flanks, WithoutErrorsTheNumbersOfTheProof) {
  const report::RunReport& report = made->run.report;
  ASSERT_TRUE(report.verified) << report.reasons.front();
  const errors::Cost& nominal = made->flanks->nominal();
  EXPECT_EQ(nominal.shift_um, 0);
  EXPECT_EQ(nominal.rms_um, 0);
  EXPECT_EQ(nominal.gouge_um, report.gouge->measured_mm * 1000);
  EXPECT_EQ(nominal.gouge_bound_um, report.gouge->bound_mm * 1000);
  EXPECT_TRUE(nominal.within);
  double least = INFINITY, most = -INFINITY;
  for (const auto& grid : made->run.surface)
    for (std::size_t k = 0; k < grid.points.size(); ++k)
      if (path::region_of(grid.patch) == path::Region::flank && grid.reachable[k] != 0) {
        least = std::min(least, double(grid.excess_um.back()[k]));
        most = std::max(most, double(grid.excess_um.back()[k]));
      }
  EXPECT_EQ(nominal.deepest_um, -least);
  EXPECT_EQ(nominal.left_um, most);
}

TEST_F(Flanks, WithoutErrorsEveryToothIsTheSame) {
  for (const int tooth : {1, 17, 59}) {
    const auto cost = made->flanks->cost({}, tooth);
    ASSERT_TRUE(cost) << cost.error().text();
    EXPECT_LT(cost->shift_um, 1e-3);
    EXPECT_NEAR(cost->gouge_um, made->flanks->nominal().gouge_um, 1e-2);
  }
}

/// A tool that is longer by 10 um cuts deeper by 10 um times the cosine between the normal and its axis.
TEST_F(Flanks, ALongerTool) {
  errors::Drawn drawn;
  drawn.longer_mm[1] = 0.01;
  expect_change(drawn, 0, 10 * cusp_slope(), [](const Vec3& normal) { return -10 * normal.z(); });
  EXPECT_GT(10 * std::sin(radians(15)), 10 * cusp_slope());  // the test can see it
}

/// A ball whose radius is larger by 3 um, its tip where it was: its centre is higher by as much.
TEST_F(Flanks, ALargerBall) {
  errors::Drawn drawn;
  drawn.radius_mm[1] = 0.003;
  expect_change(drawn, 0, 3 * cusp_slope() + 0.05, [](const Vec3& normal) { return 3 * normal.z() - 3; });
}

/// C beside its place by 10 um along X: the tooth spaces run out as sine and cosine of their angle.
TEST_F(Flanks, APivotRunsOut) {
  errors::Drawn drawn;
  drawn.machine.rotary[0].point_mm = Vec3(0.01, 0, 0);
  ASSERT_EQ(made->run.machine.chain.table[0].letter, 'C');
  double most = 0;
  for (const int tooth : {0, 7, 15, 30, 45}) {
    const double angle = 2 * kPi * tooth / 60;
    // The tool stands off by (1 - R) e over the part, seen in the space's own frame R^-1 (1 - R) e = (R^-1 - 1) e.
    const Vec3 off(10 * (std::cos(angle) - 1), -10 * std::sin(angle), 0);
    expect_change(drawn, tooth, off.norm() * cusp_slope() + 0.01, [&](const Vec3& normal) { return off.dot(normal); });
    const auto cost = made->flanks->cost(drawn, tooth);
    ASSERT_TRUE(cost);
    most = std::max(most, cost->shift_um);
  }
  EXPECT_GT(most, 9);
}

/// X and Z out of square: the head stands off by the way along Z from where the tool was touched off. The table alone
/// turns the spaces under it, so that all of them change alike.
TEST_F(Flanks, SquarenessByTheHeightOfThePlace) {
  errors::Drawn drawn;
  drawn.machine.square_xz_rad = 1e-3;
  const auto one = made->flanks->cost(drawn, 0), other = made->flanks->cost(drawn, 23);
  ASSERT_TRUE(one && other);
  EXPECT_NEAR(one->shift_um, other->shift_um, 1e-3);
  double most = 0;  // of X by z, across the flanks: by hand, um
  for (const auto& grid : made->run.surface)
    for (std::size_t k = 0; k < grid.points.size(); ++k)
      if (path::region_of(grid.patch) == path::Region::flank && grid.reachable[k] != 0)
        most = std::max(most, std::abs(grid.points[k].z() * grid.normals[k].x()));
  EXPECT_GT(one->shift_um, 0.01);
  EXPECT_LT(one->shift_um, most + 8 * cusp_slope());
}

/// A head that tilts; axes that turn while they cut. Zero errors are those of the proof, on every tooth space.
TEST(OtherMachines, WithoutErrorsTheNumbersOfTheProof) {
  for (const char* sample : {"/spur_head_table.toml", "/tool_axis.toml"}) {
    Made made(file_text(kSamples + sample));
    ASSERT_TRUE(made.flanks) << sample;
    EXPECT_EQ(made.flanks->nominal().gouge_um, made.run.report.gouge->measured_mm * 1000) << sample;
    EXPECT_EQ(made.flanks->nominal().gouge_bound_um, made.run.report.gouge->bound_mm * 1000) << sample;
    const auto other = made.flanks->cost({}, 13);
    ASSERT_TRUE(other) << sample;
    EXPECT_LT(other->shift_um, 1e-3) << sample;
  }
}

/// A gear beside the table's axis: every tooth space has joints of its own. A pivot does there what it does elsewhere.
TEST(OtherMachines, TeethThatAreWrittenOut) {
  Made made(replaced(file_text(kSamples + "/spur_quick.toml"), "origin = [3.0, -2.0, 120.0]",
                     "origin = [13.0, -2.0, 120.0]"));
  ASSERT_TRUE(made.flanks);
  ASSERT_NE(made.run.machine.chain.table[0].point_mm.x(), 13);
  const auto nominal = made.flanks->cost({}, 15);
  ASSERT_TRUE(nominal) << nominal.error().text();
  EXPECT_LT(nominal->shift_um, 0.1);  // words are rounded
  errors::Drawn drawn;
  drawn.machine.rotary[0].point_mm = Vec3(0.01, 0, 0);
  const auto there = made.flanks->cost(drawn, 0), quarter = made.flanks->cost(drawn, 15);
  ASSERT_TRUE(there && quarter);
  EXPECT_LT(there->shift_um, 0.1);
  EXPECT_GT(quarter->shift_um, 7);  // 10 um along the flank and 10 across it
  EXPECT_LT(quarter->shift_um, 14.2);
}

TEST(ErrorList, NamesAndSizes) {
  auto job = job::read_job_file(kSamples + "/spur_quick.toml");
  ASSERT_TRUE(job);
  auto machine = process::load_machine(*job);
  ASSERT_TRUE(machine);
  const auto all = errors::errors_of(*machine, *job);
  std::vector<std::string> names;
  for (const auto& error : all) names.push_back(error.name);
  EXPECT_EQ(names, (std::vector<std::string>{"C.pivot", "C.tilt", "C.wave", "A.pivot", "A.tilt", "A.zero", "A.scale",
                                             "A.wave", "square.XY", "square.XZ", "square.YZ", "spindle.tilt",
                                             "tool.length", "tool.radius"}));
  const auto refusal = [&](const std::vector<std::string>& given, bool only) {
    auto errors = all;
    const auto set = errors::set_sizes(errors, given, only);
    return set ? fmt::format("{} left", errors.size()) : set.error().message;
  };
  EXPECT_EQ(refusal({"C.pivot=3"}, true), "1 left");
  EXPECT_EQ(refusal({"C.pivot=0"}, false), "13 left");
  EXPECT_NE(
      refusal({"B.pivot=3"}, false).find("--error B.pivot=3: not NAME=SIZE of an error of this machine: C.pivot, "),
      std::string::npos);
  EXPECT_NE(refusal({"C.pivot"}, false).find("not NAME=SIZE"), std::string::npos);
  EXPECT_NE(refusal({"C.pivot=-1"}, false).find("--error"), std::string::npos);
  EXPECT_NE(refusal({"C.pivot=nan"}, false).find("--error"), std::string::npos);
  EXPECT_NE(refusal({}, true).find("no error is left"), std::string::npos);
}

/// What one error draws is the same whatever others are there; both components of a pivot have its size.
TEST(ErrorList, DrawsStandAlone) {
  auto job = job::read_job_file(kSamples + "/spur_quick.toml");
  ASSERT_TRUE(job);
  auto machine = process::load_machine(*job);
  ASSERT_TRUE(machine);
  const auto all = errors::errors_of(*machine, *job);
  double x = 0, y = 0;
  constexpr int kMany = 4000;
  for (int k = 0; k < kMany; ++k) {
    const samples::Numbers numbers(9, std::uint64_t(k));
    const auto together = errors::draw(all, std::nullopt, machine->chain, *job, numbers);
    const auto alone = errors::draw(all, 0, machine->chain, *job, numbers);
    const Vec3 pivot = alone.machine.rotary[0].point_mm;
    EXPECT_EQ(together.machine.rotary[0].point_mm, pivot);
    EXPECT_EQ(alone.machine.rotary[1].point_mm, Vec3::Zero());
    EXPECT_TRUE(alone.longer_mm.empty());
    EXPECT_NEAR(alone.magnitude, pivot.norm() * 1000, 1e-9);
    EXPECT_LT(std::abs(pivot.dot(machine->chain.table[0].direction)), 1e-15);
    x += pivot.x() * pivot.x(), y += pivot.y() * pivot.y();
  }
  EXPECT_NEAR(std::sqrt(x / kMany) * 1000, 5, 0.3);
  EXPECT_NEAR(std::sqrt(y / kMany) * 1000, 5, 0.3);
}

std::vector<std::string> study(const std::string& out, std::vector<std::string> more = {}) {
  std::vector<std::string> words = {"study",
                                    "machine-errors",
                                    kSamples + "/spur_quick.toml",
                                    "--out",
                                    out,
                                    "--samples",
                                    "3",
                                    "--only",
                                    "--error",
                                    "C.pivot=5",
                                    "--error",
                                    "tool.length=5",
                                    "--error",
                                    "tool.radius=3"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}
const std::vector<std::string> kMerged = {"machine_errors.csv", "machine_errors.html", "machine_errors.json",
                                          "samples.jsonl"};

/// The bytes of all that merging writes.
std::vector<std::string> merged_in(const std::string& out) {
  std::vector<std::string> texts;
  for (const auto& name : kMerged) texts.push_back(file_text(out + "/" + name));
  return texts;
}

TEST(StudyMachineErrors, TheSameBytesInOneTwoAndEightShards) {
  const TestDir dir;
  const auto whole = run_program(study(dir / "1"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(names_in(dir / "1"),
            (std::vector<std::string>{"machine_errors.csv", "machine_errors.html", "machine_errors.json",
                                      "samples.1of1.jsonl", "samples.jsonl"}));
  const auto bytes = merged_in(dir / "1");
  const Json json = Json::parse(bytes[2]);
  ASSERT_EQ(json.at("rows").size(), 4u);
  for (const auto& row : json.at("rows")) {
    EXPECT_EQ(row.at("samples"), 3);
    EXPECT_GT(row.at("largest_um").get<double>(), 0.01) << row;
    EXPECT_GE(row.at("largest_um").get<double>(), row.at("mean_um").get<double>());
  }
  EXPECT_NE(bytes[1].find("What each error costs"), std::string::npos);
  for (const int count : {2, 8}) {
    const std::string out = dir / std::to_string(count);
    for (int i = count; i >= 1; --i) {
      const auto done = run_program(study(out, {"--shard", fmt::format("{}/{}", i, count), "--threads", "1"}));
      ASSERT_EQ(done.exit_code, 0) << done.err;
    }
    const auto merged = run_program({"study", "merge", out});
    ASSERT_EQ(merged.exit_code, 0) << merged.err;
    EXPECT_EQ(merged_in(out), bytes) << count;
  }
}

TEST(StudyMachineErrors, KilledAndTakenUp) {
  const TestDir dir;
  ASSERT_EQ(run_program(study(dir / "whole")).exit_code, 0);
  const std::string out = dir / "killed", file = out + "/samples.1of1.jsonl";
  const auto lines = [&] {
    const std::string text = std::filesystem::exists(file) ? file_text(file) : "";
    return std::count(text.begin(), text.end(), '\n');
  };
  Launch launch;
  launch.arguments = study(out);
  launch.signal_number = SIGKILL;
  launch.signal_when = file;
  launch.before_signal = [&] {
    for (int k = 0; k < 60'000 && lines() < 4; ++k) ::usleep(1000);
  };
  EXPECT_EQ(run_program(launch).exit_code, -1);
  const auto stood = lines();
  EXPECT_GE(stood, 4);
  ASSERT_LT(stood, 13);
  const auto early = run_program({"study", "merge", out});
  EXPECT_EQ(early.exit_code, 3);
  EXPECT_NE(early.err.find("of 12 samples are missing"), std::string::npos) << early.err;
  write_file(file, file_text(file) + R"({"sample":11,"err)");  // as if it had been killed within a line
  const auto again = run_program(study(out));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find(fmt::format("{} of them new", 13 - stood)), std::string::npos) << again.out;
  EXPECT_EQ(merged_in(out), merged_in(dir / "whole"));
}

TEST(StudyMachineErrors, RefusesAnotherStudyAndWrongWords) {
  const TestDir dir;
  const std::string out = dir / "out";
  ASSERT_EQ(run_program(study(out, {"--shard", "1/12"})).exit_code, 0);
  const std::string before = file_text(out + "/samples.1of12.jsonl");
  const auto other = run_program(study(out, {"--shard", "1/12", "--seed", "2"}));
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("samples.1of12.jsonl:1:1: error: this file is of another study (they differ in: key, seed)"),
            std::string::npos)
      << other.err;
  EXPECT_EQ(file_text(out + "/samples.1of12.jsonl"), before);
  EXPECT_EQ(run_program(study(dir / "a", {"--shard", "3/2"})).exit_code, 2);
  EXPECT_EQ(run_program(study(dir / "a", {"--error", "D.pivot=1"})).exit_code, 2);
  EXPECT_EQ(run_program({"study", "merge", dir / "none"}).exit_code, 4);
  EXPECT_TRUE(names_in(dir / "a").empty());
}

/// Lines as the study writes them: one error and all together, two samples of each.
std::string small_study() {
  std::string text =
      R"({"study":"machine-errors","version":1,"key":"abc","samples":4,"seed":1,"job":"j","machine":"m","teeth":60,)"
      R"("fine":false,"verified":true,"nominal":{"shift_um":0,"rms_um":0,"deepest_um":1.0,"left_um":2.0,"gouge_um":0.5,)"
      R"("gouge_bound_um":0.6,"within":true},"errors":[{"error":"A.pivot","size":1.0,"unit":"um","source":"assumed",)"
      R"("meaning":"x"}]})"
      "\n";
  for (int k = 0; k < 4; ++k)
    text += fmt::format(
        R"({{"sample":{},"error":"{}","tooth":{},"magnitude":1.5,"shift_um":1.0,"rms_um":0.5,"deepest_um":1.0,)"
        R"("left_um":1.0,"gouge_um":1.0,"gouge_bound_um":1.0,"within":true}})"
        "\n",
        k, k % 2 == 0 ? "A.pivot" : "all together", k);
  return text;
}

TEST(StudyMachineErrors, DamagedSamplesAreRefusedWithTheirPlace) {
  const TestDir dir;
  const auto merged = [&](const std::string& text) {
    write_file(dir / "samples.1of1.jsonl", text);
    return run_program({"study", "merge", dir.path()});
  };
  EXPECT_EQ(merged(small_study()).exit_code, 0);
  struct Case {
    std::string from, to, place, says;
  };
  const std::string sample = "\"sample\":2,\"error\":\"A.pivot\"";
  for (const Case& c :
       {Case{"\"version\":1", "\"version\":2", "1:1", "version = 2 of study machine-errors, and this program has"},
        Case{"\"version\":1,", "", "1:1", "not the head of a study"},
        Case{"\"seed\":1", "\"seed\":\"one\"", "1:1", "\"seed\" is string; a whole number"},
        Case{"\"left_um\":2.0,", "", "1:1", "\"nominal.left_um\" is missing"},
        Case{"\"size\":1.0,", "", "1:1", "\"errors[0].size\" is missing"},
        Case{"\"size\":1.0,", "\"size\":-1.0,", "1:1", "\"errors[0].size\" is not above 0"},
        Case{"\"teeth\":60", "\"teeth\":0", "1:1", "\"teeth\" is not above 0"},
        Case{"\"errors\":[{", "\"errors\":[{},{", "1:1", "\"errors[0].error\" is missing"},
        Case{sample, "\"sample\":2,\"error\":7", "4:1", "\"error\" is number; a text is needed"},
        Case{sample, "\"sample\":2,\"error\":\"B.pivot\"", "4:1", "\"error\" of sample 2 is not \"A.pivot\""},
        Case{"\"magnitude\":1.5,\"shift_um\":1.0", "\"magnitude\":1.5,\"shift_um\":1e300", "2:1",
             "\"shift_um\" = 1e+300 is beyond 1e+12"},
        Case{"\"magnitude\":1.5,\"shift_um\":1.0", "\"magnitude\":1.5,\"shift_um\":\"x\"", "2:1",
             "\"shift_um\" is string; a number is needed"}}) {
    const auto refused = merged(replaced(small_study(), c.from, c.to));
    EXPECT_EQ(refused.exit_code, 3) << c.to;
    EXPECT_NE(refused.err.find(dir / "samples.1of1.jsonl" + ":" + c.place + ": error: " + c.says), std::string::npos)
        << refused.err;
    EXPECT_EQ(refused.err.find("json.exception"), std::string::npos);
  }
}

}  // namespace
}  // namespace toothpath::test
