// Teeth that are written out: what one of them lacks, or has in another space, is found although nothing is gouged.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "app/commands/run.h"
#include "app/job/file.h"
#include "app/process/load_judge.h"
#include "cam/tool/cutters.h"
#include "tests/app/checker.h"
#include "tests/app/judged.h"
#include "tests/app/line_job.h"
#include "tests/support/files.h"
#include "tests/support/sample_tools.h"
#include "tests/support/threads.h"

namespace toothpath::test {
namespace {

using Lines = std::vector<std::string>;

struct Verdict {
  bool verified = false;
  std::string reasons;
  double left_um = 0;
};

/// A job and its program, made once.
class Made {
 public:
  /// Any job, on the machine that it names.
  explicit Made(const std::string& job) { run(job); }
  /// A job of xyzac_large.toml, with this for the post processor.
  Made(std::string job, const std::string& post) {
    const std::string machine = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml");
    write_file(dir_ / "machine.toml", machine + "\n[post]\n" + post + "\n");
    replace_once(job, "\"xyzac_large.toml\"", "\"machine.toml\"\naccept_assumed = true");
    run(job);
  }
  [[nodiscard]] const Lines& lines() const { return lines_; }
  /// What `check` says of a text; the job is read and planned once for all of them.
  [[nodiscard]] Verdict check(const Lines& lines) const {
    if (!checker_) checker_ = checker_of(dir_ / "job.toml");
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    const auto proven = checker_->prove(text, dir_ / "edited.ngc");
    if (!proven) return {false, proven.error().text() + "\n", NAN};
    Verdict out{proven->verified, "", NAN};
    for (const auto& reason : proven->reasons) out.reasons += reason + "\n";
    const auto report = nlohmann::json::parse(report::report_json(*proven));
    if (report.contains("excess_um")) out.left_um = report["excess_um"]["finished"]["max"].get<double>();
    return out;
  }
  /// samples/bevel_pinion.toml with its teeth written out.
  static const Made& bevel_pinion() {
    static const Made made(file_text(TOOTHPATH_SOURCE_DIR "/samples/bevel_pinion.toml"), "index_loop = false");
    return made;
  }
  /// samples/spur_quick.toml at a place of the table, its teeth written out or in loops.
  static const Made& of(const std::string& place, const std::string& post) {
    static std::map<std::string, std::unique_ptr<Made>> made;
    auto& one = made[place + post];
    if (!one) {
      std::string job = file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml");
      replace_once(job, "[3.0, -2.0, 120.0]", "[" + place + ", 120.0]");
      replace_once(job, "[3.0, -2.0, 0.0]", "[" + place + ", 0.0]");
      one = std::make_unique<Made>(job, post);
    }
    return *one;
  }

 private:
  void run(const std::string& job) {
    write_file(dir_ / "job.toml", job);
    commands::RunRequest request;
    request.job_file = dir_ / "job.toml";
    request.out_dir = dir_ / "out";
    request.quiet = true;
    EXPECT_EQ(commands::run_job(request).exit_code, app::ExitCode::ok);
    std::istringstream in(file_text(dir_ / "out/program.ngc"));
    for (std::string line; std::getline(in, line);) lines_.push_back(line);
  }

  TestDir dir_;
  Lines lines_;
  mutable std::unique_ptr<commands::ProgramChecker> checker_;
};

class ToothSpaces : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    made_ = &Made::of(GetParam(), "index_loop = false");
    lines_ = made_->lines();
  }
  Verdict check(const Lines& lines) { return made_->check(lines); }
  /// Index of the line (TOOTH k) of an operation.
  [[nodiscard]] std::size_t tooth(int operation, int k) const {
    const auto from = std::find_if(lines_.begin(), lines_.end(), [&](const std::string& line) {
      return line.starts_with("(OP " + std::to_string(operation));
    });
    return std::size_t(std::find(from, lines_.end(), "(TOOTH " + std::to_string(k) + ")") - lines_.begin());
  }
  /// Indices of the links of a tooth that name C: a pass begins there.
  [[nodiscard]] std::vector<std::size_t> links(int operation, int k) const {
    std::vector<std::size_t> out;
    for (std::size_t n = tooth(operation, k) + 1; n < lines_.size() && !lines_[n].starts_with("(TOOTH"); ++n)
      if (lines_[n].starts_with("G1 ") && lines_[n].find(" C") != std::string::npos) out.push_back(n);
    return out;
  }
  /// The first pass behind a link, without the way down to it: [first, last).
  [[nodiscard]] std::pair<std::size_t, std::size_t> pass(std::size_t link) const {
    std::size_t first = link + 1;
    while (lines_[first].starts_with("Z")) ++first;
    std::size_t last = first;
    while (lines_[last].starts_with("X")) ++last;
    return {first, last};
  }
  const Made* made_ = nullptr;
  Lines lines_;
};
INSTANTIATE_TEST_SUITE_P(Place, ToothSpaces, testing::Values("3.0, -2.0", "14.0, -9.0"), [](const auto& place) {
  return std::string(place.param[0] == '3' ? "OnTheAxis" : "OffTheAxis");
});

void expect_told(const Verdict& found, const std::vector<std::string>& words) {
  EXPECT_FALSE(found.verified) << found.reasons;
  for (const std::string& word : words)
    EXPECT_TRUE(std::regex_search(found.reasons, std::regex(word))) << word << " in: " << found.reasons;
}

TEST_P(ToothSpaces, AsMadeEveryToothIsCut) { EXPECT_TRUE(check(lines_).verified); }

TEST_P(ToothSpaces, APassThatIsLeftOut) {
  for (const int operation : {0, 1})
    for (const int k : {1, 37}) {
      Lines lines = lines_;
      const auto [first, last] = pass(links(operation, k).at(3));
      ASSERT_GT(last - first, 4U);
      lines.erase(lines.begin() + std::ptrdiff_t(first), lines.begin() + std::ptrdiff_t(last));
      const auto found = check(lines);
      const std::string name = "tooth " + std::to_string(k);
      expect_told(found, {name + ": the cut of line [0-9]+, tooth 0, is not made again behind line [0-9]+"});
      std::smatch line;
      ASSERT_TRUE(std::regex_search(found.reasons, line, std::regex("behind line ([0-9]+)")));
      EXPECT_NEAR(std::stod(line[1]), double(first), 4);
      if (operation == 1) expect_told(found, {name + ": left material: [0-9.]+ um on the "});
    }
}

// The sign of C, or another tooth's C: the cut is made in an open space and gouges nothing.
TEST_P(ToothSpaces, APassInAnotherSpace) {
  for (const int operation : {0, 1}) {
    const std::vector<std::size_t> begin = links(operation, 2);
    Lines lines = lines_;
    // All of the tooth from a link on stands in space 58 instead of 2.
    for (std::size_t n = begin.at(4) - 4; n < begin.at(5); ++n)
      lines[n] = std::regex_replace(lines[n], std::regex(" C-12\\b"), " C12");
    ASSERT_NE(lines, lines_);
    // It turns there and back above the part, behind the rise of the link.
    lines.insert(lines.begin() + std::ptrdiff_t(begin.at(5)) - 2, "G0 C-12");
    lines.insert(lines.begin() + std::ptrdiff_t(begin.at(4)) - 2, "G0 C12");
    expect_told(check(lines), {"tooth 2: the cut of line [0-9]+, tooth 0, is not made again behind line [0-9]+"});
  }
}

TEST_P(ToothSpaces, AToothThatIsLeftOut) {
  for (const int operation : {0, 1}) {
    Lines lines = lines_;
    lines.erase(lines.begin() + std::ptrdiff_t(tooth(operation, 5)),
                lines.begin() + std::ptrdiff_t(tooth(operation, 6)));
    expect_told(check(lines), {"operation " + std::to_string(operation) + " does not cut tooth 5: "});
  }
}

TEST_P(ToothSpaces, AnOperationThatIsLeftOut) {
  Lines lines = lines_;
  lines.erase(lines.begin() + std::ptrdiff_t(tooth(0, 0)), lines.begin() + std::ptrdiff_t(tooth(1, 0)));
  const auto roughing = std::find_if(lines.begin(), lines.end(), [](const auto& l) { return l.starts_with("(OP 0"); });
  ASSERT_NE(roughing, lines.end());
  expect_told(check(lines),
              {"operation 1 of the job is not in the program|operation 0 of the job is not in the program"});
}

// Cuts off the flank, on a later tooth: what is measured there decides.
TEST_P(ToothSpaces, ACutThatIsRaised) {
  const auto [first, last] = pass(links(1, 3).at(5));
  for (const double um : {2.0, 60.0}) {
    Lines lines = lines_;
    for (std::size_t n = first; n < last; ++n) {
      std::smatch z;
      if (!std::regex_search(lines_[n], z, std::regex(" Z([-0-9.]+)"))) continue;
      lines[n] = z.prefix().str() + fmt::format(" Z{:.4f}", std::stod(z[1]) + 1e-3 * um) + z.suffix().str();
    }
    ASSERT_NE(lines, lines_);
    const Verdict found = check(lines);
    if (um < 5) EXPECT_TRUE(found.verified) << found.reasons;
    else expect_told(found, {"tooth 3: left material: "});
  }
}

// What is no copy but cuts the same is right: the order of passes, teeth that begin elsewhere.
TEST_P(ToothSpaces, TheOrderIsFree) {
  Lines lines = lines_;
  for (const int operation : {1, 0}) {  // tooth 0 behind tooth 29
    const auto a = lines.begin() + std::ptrdiff_t(tooth(operation, 0)),
               b = lines.begin() + std::ptrdiff_t(tooth(operation, 1)),
               c = lines.begin() + std::ptrdiff_t(tooth(operation, 30));
    std::rotate(a, b, c);
  }
  const Verdict found = check(lines);
  EXPECT_TRUE(found.verified) << found.reasons;
}

TEST_P(ToothSpaces, AnyNumberOfThreadsSaysTheSame) {
  Lines lines = lines_;
  for (const int k : {4, 9, 21}) {
    const auto [first, last] = pass(links(1, k).at(3));
    for (std::size_t n = first + 2; n < last; ++n) lines[n] = "G4 P0";
  }
  std::string said[2];
  for (const int threads : {1, 4}) said[threads / 4] = on_threads(threads, [&] { return check(lines).reasons; });
  EXPECT_NE(said[0], "");
  EXPECT_EQ(said[0], said[1]);
}

// A name is a comment: the space is known by where the tool cuts.
TEST_P(ToothSpaces, NamesAreFree) {
  Lines counted = lines_, lost = lines_;
  for (std::string& line : counted)
    if (std::smatch name; std::regex_match(line, name, std::regex("\\(TOOTH ([0-9]+)\\)")))
      line = fmt::format("(TOOTH {})", std::stoi(name[1]) + 1);
  lost.erase(lost.begin() + std::ptrdiff_t(tooth(1, 5)));
  const double left_um = check(lines_).left_um;
  for (const Lines& lines : {counted, lost}) {
    const Verdict found = check(lines);
    EXPECT_TRUE(found.verified) << found.reasons;
    EXPECT_NEAR(found.left_um, left_um, 0.05);
  }
}

// One tooth gets a cut more than the others: right through what stands, three layers deep. Nothing is gouged by it.
TEST_P(ToothSpaces, WhatOneToothTakesOffIsJudgedThere) {
  const auto [first, last] = pass(links(0, 5).front());
  const std::string start =
      std::regex_replace(lines_[links(0, 5).front()], std::regex(".*(X[-0-9.]+ Y[-0-9.]+).*"), "$1");
  const double z = std::stod(lines_[first - 1].substr(1));
  Lines more{fmt::format("Z{:.3f} F400", z - 1.4)};
  more.insert(more.end(), lines_.begin() + std::ptrdiff_t(first), lines_.begin() + std::ptrdiff_t(last));
  more.insert(more.end(), {fmt::format("Z{:.3f} F3000", z), start + " F150"});
  lines_.insert(lines_.begin() + std::ptrdiff_t(first), more.begin(), more.end());
  const Verdict found = check(lines_);
  expect_told(found,
              {"tooth 5: operation 0: at line [0-9]+ the chip reaches [0-9.]+ mm or more above the lowest place"});
  EXPECT_EQ(found.reasons.find("gouge"), std::string::npos) << found.reasons;
}

// Loops whose teeth are not quite turned copies: all cuts of a space count, however the text comes to it.
class LoopsThatDiffer : public testing::Test {
 protected:
  [[nodiscard]] static const Made& made() { return Made::of("3.0, -2.0", "index_loop = true"); }
  /// The index of one operation, or of both, says something else.
  [[nodiscard]] static Lines indexed(const std::string& by, std::vector<int> operations) {
    Lines lines = made().lines();
    int loop = 0;
    for (std::string& line : lines)
      if (line.starts_with("G52 C[") && std::find(operations.begin(), operations.end(), loop++) != operations.end())
        line = "G52 C[" + by + "]";
    EXPECT_EQ(loop, 2);
    return lines;
  }
};

TEST_F(LoopsThatDiffer, AreJudgedWithAllCutsOfASpace) {
  const Verdict as_made = made().check(made().lines());
  ASSERT_TRUE(as_made.verified) << as_made.reasons;
  const std::pair<const char*, std::vector<int>> edits[] = {
      {"0-#1*360.0001/60", {0}},   {"0-#1*360.0001/60", {1}},   {"0.0001-#1*360/60", {1}}, {"0-[#1+7]*360/60", {1}},
      {"0-[#1+7]*360/60", {0, 1}}, {"0-#1*7*360.0001/60", {0}}, {"#1*360/60", {1}}};
  for (const auto& [index, operations] : edits) {
    const Verdict found = made().check(indexed(index, operations));
    EXPECT_TRUE(found.verified) << index << ": " << found.reasons;
    EXPECT_NEAR(found.left_um, as_made.left_um, 0.1) << index;
  }
}

TEST_F(LoopsThatDiffer, AndWhatIsMissingIsFound) {
  expect_told(made().check(indexed("0-#1*2*360.0001/60", {1})), {"operation 1 does not cut tooth 1, 3, 5"});
}

using Passes = std::vector<std::pair<std::ptrdiff_t, std::ptrdiff_t>>;

/// Runs of lines that go across, [first, last), from one line to another.
Passes passes_between(const Lines& lines, const std::string& from, const std::string& to) {
  const auto cut = [](const std::string& line) { return line.starts_with("X") || line.starts_with("Y"); };
  const auto begin = std::find(lines.begin(), lines.end(), from), end = std::find(begin, lines.end(), to);
  Passes out;
  for (auto at = begin; at != end;) {
    const auto first = std::find_if(at, end, cut);
    at = std::find_if_not(first, end, cut);
    if (at - first > 2) out.emplace_back(first - lines.begin(), at - lines.begin());
  }
  return out;
}

std::string tooth_line(int k) { return fmt::format("(TOOTH {})", k); }

/// Those of the first operation, a sub-program.
Passes roughing_passes(const Lines& lines) { return passes_between(lines, "o100 sub", "o100 endsub"); }

// The passes of the first layers are dropped: nothing is gouged, the finished surface is right, the tool runs through
// what stands.
TEST(PassesThatAreMissing, AreFoundByTheirLoad) {
  const Made& made = Made::of("3.0, -2.0", "index_loop = true");
  const auto passes = roughing_passes(made.lines());
  for (const std::size_t count : {passes.size() / 2, passes.size() - 1}) {
    Lines lines = made.lines();
    for (std::size_t pass = count; pass-- > 0;)
      lines.erase(lines.begin() + passes[pass].first, lines.begin() + passes[pass].second);
    const Verdict found = made.check(lines);
    expect_told(found, {"operation 0: at line [0-9]+ "});
    EXPECT_EQ(found.reasons.find("left material"), std::string::npos) << found.reasons;
  }
}

// The finger mill that finishes a bevel gear goes into the full space where the only roughing pass of a half is
// missing: the walls come out right, and no ridge is left. What it should meet tells a plan made anew. (That the whole
// text is verified: BevelCommand.CheckSaysTheSameOfTheProgram.)
TEST(PassesThatAreMissing, OfABevelGearAreFoundByTheStock) {
  const Made& made = Made::bevel_pinion();
  Lines lines = made.lines();
  for (int k = 17; k >= 0; --k) {
    const auto [first, last] = passes_between(lines, tooth_line(k), tooth_line(k + 1)).at(3);
    lines.erase(lines.begin() + first, lines.begin() + last);
  }
  expect_told(made.check(lines), {"operation 1: at line [0-9]+ the chip lies [0-9.]+ mm or more below what was free"});
}

// One tooth of it gets a pass more than the others: its second one is made ahead of all, half a millimetre higher and
// nearly twice as quick.
TEST(PassesThatAreMore, OnOneToothOfABevelGearAreJudgedThere) {
  const Made& made = Made::bevel_pinion();
  Lines lines = made.lines();
  const auto [first, last] = passes_between(lines, tooth_line(5), tooth_line(6)).at(1);
  Lines more{"G93"};
  for (auto at = first - 4; at <= last + 1; ++at) {  // with its links
    std::string line = lines[std::size_t(at)];
    std::smatch word;
    if (std::regex_search(line, word, std::regex("Z([-0-9.]+)")))
      line = word.prefix().str() + fmt::format("Z{:.4f}", std::stod(word[1]) + 0.5) + word.suffix().str();
    if (at >= first && std::regex_search(line, word, std::regex("F([0-9.]+)")))
      line = word.prefix().str() + fmt::format("F{:.3f}", 1.9 * std::stod(word[1])) + word.suffix().str();
    more.push_back(line);
  }
  lines.insert(std::find(lines.begin(), lines.end(), tooth_line(5)) + 1, more.begin(), more.end());
  expect_told(made.check(lines), {"tooth 5: operation 0: at line [0-9]+ the tool runs through what stands there with a "
                                  "chip of 1\\.[6-9][0-9]* times"});
}

// A ball that is smaller than the one before it: nothing but a plan tells what it meets. Six passes are missing, with
// the ways to them, and what roughs meets no more than its layers.
TEST(PassesThatAreMissing, AheadOfASmallerBallAreFoundByTheStock) {
  std::string job = file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml");
  replace_once(job, "[[operation]]\ntype = \"finishing\"\ntool = 1",
               "[[tool]]\nnumber = 2\ntype = \"ball_end_mill\"\ndiameter = 0.8\nflute_length = 6.0\n"
               "shank_diameter = 0.75\nlength = 80.0\nholder = [[10.0, 10.0, 40.0]]\nstick_out = 16.0\n\n"
               "[[operation]]\ntype = \"finishing\"\ntool = 2");
  const Made made(job);
  const Verdict whole = made.check(made.lines());
  EXPECT_TRUE(whole.verified) << whole.reasons;
  Lines lines = made.lines();
  const auto passes = roughing_passes(lines);
  lines.erase(lines.begin() + passes.at(27).second + 1, lines.begin() + passes.at(33).second + 1);
  const Verdict found = made.check(lines);
  expect_told(found, {"^operation 1: at line [0-9]+ the chip lies [0-9.]+ mm or more below what was free"});
}

// The side of a tapered mill goes into the bottom of a space that the roughing ball, which is wider, has not opened:
// what it should meet tells a plan of the operations ahead.
TEST(PassesThatAreMissing, AheadOfTheSideOfAMillAreFoundByTheStock) {
  std::string job = kLineGear + roughing(2) + operation("line_milling", 1, "left = 0.01\nchord_tolerance = 0.005") +
                    operation("finishing", 1, "regions = [\"fillet\", \"root\"]\nscallop = 0.02");
  replace_once(job, "outer_radius = 65.0", "outer_radius = 61.5");
  const Made made(job);
  const Verdict whole = made.check(made.lines());
  EXPECT_TRUE(whole.verified) << whole.reasons;
  Lines lines = made.lines();
  const auto end = std::find(lines.begin(), lines.end(), "o100 endsub");
  std::vector<Lines::iterator> up;  // where the tool is above the teeth, and the next passes begin
  for (auto at = lines.begin(); at != end; ++at)
    if (at->starts_with("G0 X")) up.push_back(at);
  ASSERT_GT(up.size(), 3U);
  lines.erase(up.back(), end - 1);
  expect_told(made.check(lines), {"^operation 1: at line [0-9]+ the chip lies [0-9.]+ mm or more below what was free"});
}

// Through a block: a plan goes 0.85 mm beside the slot that was cut before. Where its ball is 1 mm wide or more and
// cuts half a feed per tooth, teeth are in the material over acos(1 - 0.85 / 1) = 82 deg at most. The text goes 0.6 mm
// below the slot, which is less stock, but all around.
TEST(PassesThatAreMissing, AreFoundByTheAngleWhereTheStockIsNoMore) {
  const auto job = job::parse_job(file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml"), "job.toml");
  ASSERT_TRUE(job);
  const auto tool = ball_mill(4, 12, 4, 24, 10);
  const auto cuts = [](double y, double z) {
    std::vector<path::ToolMotion> both(2);
    for (int n = 0; n < 2; ++n) {
      path::ToolMotion& m = both[std::size_t(n)];
      m.operation = n;
      m.line = 7 + n;
      m.minutes = 1;
      m.tip_from = {-20, n * y, n == 0 ? -3 : z};
      m.tip_to = {20, n * y, n == 0 ? -3 : z};
    }
    return both;
  };
  process::LoadQuery query{.job = job.value(),
                           .mills = {tool::profile_of(tool), tool::profile_of(tool)},
                           .bodies = {tool::proof_tool(tool), tool::proof_tool(tool)},
                           .in_blank = [](const Vec3& p) { return p.z() <= 0 && std::abs(p.x()) < 10; },
                           .stock_before_mm = {INFINITY, INFINITY}};
  query.plan = process::planned_once([&](std::size_t operations) -> process::PlannedMotions {
    EXPECT_EQ(operations, 2U);
    return cuts(0.85, -3);
  });
  const process::LoadJudge judge(std::move(query));
  for (const auto& [y, z] : {std::pair(0.0, -3.6), {0.85, -3.0}}) {
    std::vector<std::string> reasons, warnings;
    judge.judge_by_plan(cuts(y, z), reasons, warnings);
    EXPECT_TRUE(warnings.empty());
    if (y > 0) EXPECT_TRUE(reasons.empty()) << reasons.front();
    else
      expect_told({false, reasons.empty() ? "" : reasons.front()},
                  {"^operation 1: at line 8 its teeth are in the material over 1[0-9][0-9] deg, in a plan of this job "
                   "over [89][0-9] deg"});
  }
}

// Every tooth is proven, beside the first one: sixty of them cost a few times what one costs.
TEST(AllTeeth, CostAFewTimesWhatOneCosts) {
  const TestDir dir;
  const std::string job = file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml");
  nlohmann::json reports[2];
  for (const bool all : {false, true}) {
    write_file(dir / "job.toml", all ? job + "teeth = \"all\"\n" : job);
    commands::RunRequest request;
    request.job_file = dir / "job.toml";
    request.out_dir = dir / (all ? "all" : "one");
    request.quiet = true;
    ASSERT_EQ(commands::run_job(request).exit_code, app::ExitCode::ok);
    reports[all] = nlohmann::json::parse(file_text(request.out_dir + "/report.json"));
  }
  const auto seconds = [](const nlohmann::json& report) {
    return report["stages"]["proof of the program"].get<double>();
  };
  EXPECT_LT(seconds(reports[1]), 30 * seconds(reports[0]));  // 8 times; each tooth by itself: 60 times
  for (const char* what : {"measured", "bound"})
    EXPECT_NEAR(reports[1]["gouge_um"][what].get<double>(), reports[0]["gouge_um"][what].get<double>(), 0.05) << what;
}

// A decimal point is lost, and an axis goes for hundreds of metres: it is told with its line, and nothing else is
// asked.
TEST(LostDecimalPoint, IsToldBeforeAnythingIsSwept) {
  const Made& made = Made::of("3.0, -2.0", "index_loop = true");
  for (const char axis : {'X', 'Y', 'Z'}) {
    Lines lines = made.lines();
    const auto at = std::find(lines.begin(), lines.end(), "o102 sub") + 6;
    *at = std::regex_replace(*at, std::regex(fmt::format("({}[0-9]+)\\.", axis)), "$1");
    const Verdict found = made.check(lines);
    const auto line = at - lines.begin() + 1;
    const std::string travel = fmt::format("travel: {} = [0-9.]+ exceeds [0-9.]+, line {}\\n", axis, line);
    // down at a feed in mm/min the block would take days, and no further line is read
    const std::string days = fmt::format("edited.ngc:{}:.*the block takes .* and {} goes [0-9]+ m:", line, axis);
    expect_told(found, {axis == 'Z' ? days : travel});
    EXPECT_EQ(found.reasons.find("gouge"), std::string::npos) << found.reasons;
  }
}

}  // namespace
}  // namespace toothpath::test
