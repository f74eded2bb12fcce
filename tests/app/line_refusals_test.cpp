// Jobs with line milling that only planning, the machine or the proof can refuse: each names quantity, value, limit and
// what would help.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <regex>

#include "tests/app/line_job.h"

namespace toothpath::test {
namespace {

const std::string kDoubleHelical = file_text(TOOTHPATH_SOURCE_DIR "/tests/jobs/dhfg_line.toml");

/// A job with these operations instead of its own.
std::string with(const std::string& job, const std::string& operations) {
  const auto from = job.find("[[operation]]"), to = job.find("[coolant]");
  return job.substr(0, from) + operations + job.substr(to);
}
std::string line(int tool, const std::string& lines) { return operation("line_milling", tool, lines); }

/// Refused before anything is cut: the text stands in the message, whose place is a line of the job.
std::string refused(const std::string& job, const std::string& machine = {}) {
  const TestDir dir;
  const auto run = run_line_job(dir, job, machine);
  EXPECT_EQ(run.exit_code, 3) << run.err;
  EXPECT_TRUE(std::regex_search(run.err, std::regex("job\\.toml:[1-9][0-9]*:[1-9][0-9]*: error: "))) << run.err;
  EXPECT_FALSE(std::filesystem::exists(dir / "out/program.ngc"));
  std::printf("%s", run.err.substr(run.err.find("job.toml")).c_str());
  return run.err;
}
void expect_words(const std::string& text, std::initializer_list<const char*> words) {
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << "\n in " << text;
}

// The length that the message names is enough, and a tenth of a millimetre less is not.
TEST(LineRefusals, FluteTooShortNamesTheLengthNeeded) {
  const auto job = [](double flute) {
    return replaced(kLineGear, "flute_length = 6.5", fmt::format("flute_length = {}", flute)) +
           line(1, "allowance = 0.05\nleft = 0.004");
  };
  const std::string text = refused(job(2));
  expect_words(text, {"is touched up to ", "the teeth end at 2.000 mm", "flute_length must be "});
  std::smatch found;
  ASSERT_TRUE(std::regex_search(text, found, std::regex("flute_length must be ([0-9.]+) mm at least")));
  const double needed = std::stod(found[1]);
  expect_words(refused(job(needed - 0.1)), {"flute_length must be "});
  const TestDir dir;
  EXPECT_EQ(run_line_job(dir, job(needed + 0.1)).exit_code, 0);
}

TEST(LineRefusals, TooThickForTheSpace) {
  expect_words(
      refused(replaced(with(kDoubleHelical, line(3, "allowance = 0.012\nleft = 0.003")), "diameter = 0.5",
                       "diameter = 0.9")),
      {"the flute has a gap of -", " mm is the least: the space between the flanks, or the groove, is too narrow",
       "a smaller diameter or half_angle"});
}

// So much stock leans the mill into what stands on the flank across.
TEST(LineRefusals, StockOnTheOtherFlank) {
  expect_words(
      refused(with(kDoubleHelical, line(3, "allowance = 0.25\nleft = 0.003"))),
      {"the flute has a gap of 0.",
       "to the flank -1, 0.2125 mm is the least, the stock that stands there: it would rub", "a smaller allowance"});
}

// The mill leans over the groove: where that is too narrow its pass ends before the flank does, and nothing is written.
TEST(LineRefusals, GrooveTooNarrow) {
  const TestDir dir;
  std::string job =
      with(kDoubleHelical, line(3, "left = 0.002\nchord_tolerance = 0.001") +
                               operation("finishing", 3, "regions = [\"fillet\", \"root\"]\nscallop = 0.02"));
  job = replaced(replaced(job, "inner_radius = 119.0", "inner_radius = 118.2"), "outer_radius = 124.0",
                 "outer_radius = 123.2");
  const auto run = run_line_job(dir, job);
  EXPECT_EQ(run.exit_code, 1) << run.err;
  expect_words(run.err, {"the pass on zone 0, flank +1 ends early: beyond its end the flute has a gap of -",
                         "mm is the least; a wider groove, or a mill of smaller diameter or half_angle",
                         "um on the flank after the last operation, limit "});
  EXPECT_FALSE(std::filesystem::exists(dir / "out/program.ngc"));
}

// Near the undercut limit of a steep ring the direction turns fast.
TEST(LineRefusals, TiltAboveTheLimit) {
  std::string job = with(kDoubleHelical, line(3, "allowance = 0.02\nleft = 0.05\nrotaries = \"both\""));
  const auto second = job.rfind("[[gear.zone]]"), after = job.find("[machine]");
  job = job.substr(0, second) + job.substr(after);
  for (const auto& [from, to] : {std::pair{"helix_angle = -30.0", "helix_angle = 60.0"},
                                 {"inner_radius = 112.25", "inner_radius = 115.6"},
                                 {"outer_radius = 117.0", "outer_radius = 124.0"},
                                 {"pressure_angle = 20.0", "pressure_angle = 25.0"},
                                 {"addendum_coefficient = 1.0", "addendum_coefficient = 0.8"},
                                 {"half_angle = 5.0", "half_angle = 1.0"},
                                 {"diameter = 0.5", "diameter = 0.3"}})
    job = replaced(job, from, to);
  const std::size_t third = job.find("number = 3"), flute = job.find("flute_length = 4.0", third);
  job.replace(flute, std::string("flute_length = 4.0").size(), "flute_length = 8.0");
  job = job.substr(0, job.find("reference_radius")) + job.substr(job.find('\n', job.find("reference_radius")));
  expect_words(refused(job), {"asks for a tool tilted by 6", " deg from the gear axis; at most 60 deg are planned",
                              "farther from the undercut limit, or a smaller helix angle"});
}

TEST(LineRefusals, MisfitThatCannotBeMet) {
  const std::string any = refused(kLineGear + line(1, "allowance = 0.05\nleft = 0.00001"));
  expect_words(
      any, {"left = 0.010 um cannot be met: the side of this tool leaves ", " um at best on flank +1 of zone 0, with ",
            "tried: 1 to 4 strips while the tilt stands or the azimuth stands or both rotaries move",
            "what helps: left = 0.00", "more strips (at most 24)", "regions = [\"flank\"]"});
  expect_words(refused(kLineGear + line(1, "allowance = 0.05\nleft = 0.00001\nstrips = 2\nrotaries = \"one\"")),
               {"with 2 strips while the ", "tried: 2 strips while the tilt stands or the azimuth stands;",
                "more strips (at most 24), rotaries = \"both\""});
}

// Controls that interpolate fewer axes at once.
TEST(LineRefusals, FourAxesTakeOneRotary) {
  const std::string four = changed_machine("max_simultaneous_axes = 5", "max_simultaneous_axes = 4");
  expect_words(
      refused(kLineGear + line(1, "allowance = 0.05\nleft = 0.004\nrotaries = \"both\""), four),
      {"rotaries = \"both\" moves 5 axes at once", "interpolates 4 (max_simultaneous_axes): rotaries = \"one\""});
  const std::string least = refused(kLineGear + line(1, "allowance = 0.05\nleft = 0.00001"), four);
  expect_words(least,
               {"left = 0.010 um cannot be met", "tried: 1 to 4 strips while the tilt stands or the azimuth stands;",
                "the control interpolates 4 axes at once: rotaries = \"one\"", "larger left"});
  EXPECT_EQ(least.find("rotaries = \"both\""), std::string::npos) << "offers what the control cannot do";
  const TestDir dir;
  const auto run = run_line_job(dir, kLineGear + line(1, "allowance = 0.05\nleft = 0.02"), four);
  EXPECT_EQ(run.exit_code, 0) << run.err;
}
TEST(LineRefusals, ThreeAxesTakeNone) {
  const std::string three = changed_machine("max_simultaneous_axes = 5", "max_simultaneous_axes = 3");
  expect_words(refused(kLineGear + line(1, "allowance = 0.05\nleft = 0.004"), three),
               {"line_milling moves X, Y, Z and one rotary at least",
                "interpolates 3 axes at once (max_simultaneous_axes)", "type = \"finishing\""});
}
TEST(LineRefusals, BallWhoseAxisTurns) {
  const std::string prescribed =
      kLineGear + operation("finishing", 2, "scallop = 0.05\ntool_axis = [[60.5, 6.0, 0.0], [64.0, 9.0, 2.0]]");
  for (const char* axes : {"3", "4"}) {
    const std::string machine =
        changed_machine("max_simultaneous_axes = 5", "max_simultaneous_axes = " + std::string(axes));
    expect_words(refused(prescribed, machine),
                 {"its axis turns while it cuts in zone 0, ", " axes at once, but the control interpolates ", axes,
                  "a larger stick_out"});
  }
  const TestDir dir;  // an axis that stands in every pass needs three
  const auto run = run_line_job(dir, kLineGear + operation("finishing", 2, "scallop = 0.05"),
                                changed_machine("max_simultaneous_axes = 5", "max_simultaneous_axes = 3"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
}

// What rounding costs at the radius of the gear is told: as a warning, and beside a verdict that fails.
TEST(LineRefusals, CoarseIncrements) {
  const std::string coarse = changed_machine("", "", "\n[post]\nlinear_decimals = 3\nrotary_decimals = 3\n");
  const std::string words = "words rounded to 0.001 mm and 0.001 deg cost up to ";
  const TestDir small;
  const auto run = run_line_job(small, kLineGear + line(1, "allowance = 0.05\nleft = 0.004"), coarse);
  const std::string told = run.out + run.err;
  expect_words(told, {words.c_str(), "1.07 um at radius 65.0 mm", "post.rotary_decimals"});
  const TestDir fine;
  const auto exact = run_line_job(fine, kLineGear + line(1, "allowance = 0.05\nleft = 0.004"));
  EXPECT_EQ((exact.out + exact.err).find("words rounded"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
