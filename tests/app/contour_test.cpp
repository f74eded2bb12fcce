// The contour tolerance of a program: a share of what the proof leaves, or the job's own; in the text, the ledger and
// the verdict.
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/app/pole_job.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

struct ContourRun {
  int exit_code = 0;
  std::string err, text;
  Json report;
  [[nodiscard]] double blending_um() const { return report["ledger"]["path blending"]["measured"]; }
  [[nodiscard]] double bound_um() const { return report["gouge_um"]["bound"].get<double>(); }
  /// T of cycle 32, CYCLE832 or what ADIS stands for, um.
  [[nodiscard]] double said_um() const {
    std::smatch m;
    static const std::regex word(R"((?:CYCL DEF 32\.1 T|CYCLE832\()([0-9.]+))");
    return std::regex_search(text, m, word) ? 1000 * std::stod(m[1]) : -1;
  }
};

/// The machine that ships, with or without accelerations.
ContourRun run_on(const std::string& machine, const std::string& acceleration, const std::string& key,
                  const std::string& first_operation = "") {
  const TestDir dir;
  std::string file = file_text(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/" + machine + ".toml");
  file = std::regex_replace(file, std::regex("max_acceleration = [^\n]*\n"), "");
  if (!acceleration.empty())
    file = std::regex_replace(file, std::regex("(\\[axes\\.[A-Z]\\]\n(?:[^\n]+\n)*?max_speed[^\n]*\n)"),
                              "$1max_acceleration = " + acceleration + "\n");
  write_file(dir / "m.toml", file);
  PoleJob job;
  job.pole = "slow";
  job.aside_deg = 0.3;
  job.machine = "m.toml";
  std::string text = job_text(job) + key;
  text.insert(text.find("[[operation]]"), first_operation);
  write_file(dir / "job.toml", text);
  const auto done = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  ContourRun out{done.exit_code, done.err, {}, Json::parse(file_text(dir / "out/report.json"), nullptr, false)};
  if (done.exit_code == 0) out.text = file_text(dir / ("out/" + out.report["program"]["file"].get<std::string>()));
  return out;
}

class Contour : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Machines, Contour, testing::Values("siemens_ac", "heidenhain_ac"));

// More than the narrow tolerance where the time gains by it, and the bound stays below the tolerance; a time that
// depends on nothing takes the half.
TEST_P(Contour, IsAShareOfWhatIsLeft) {
  const ContourRun narrow = run_on(GetParam(), "20.0", "contour_tolerance = 0.0003\n"),
                   wide = run_on(GetParam(), "20.0", ""), usual = run_on(GetParam(), "", "");
  for (const ContourRun* run : {&narrow, &wide, &usual}) ASSERT_EQ(run->exit_code, 0) << run->err;
  EXPECT_NEAR(narrow.said_um(), 0.3, 1e-9);
  EXPECT_GT(wide.said_um(), 0.3);
  EXPECT_LT(wide.report["total_minutes"].get<double>(), narrow.report["total_minutes"].get<double>());
  for (const ContourRun* run : {&wide, &usual}) {
    EXPECT_NEAR(run->blending_um(), run->said_um(), 1e-3);
    EXPECT_LE(run->bound_um(), 3.0);
    EXPECT_GE(run->bound_um() - narrow.bound_um(), 0.5 * (run->said_um() - 0.3));
    EXPECT_NE(run->text.find("CONTOUR TOLERANCE"), std::string::npos);
  }
  // Half of the room, of which the rotaries take their part.
  const double room = 3.0 - narrow.bound_um();
  EXPECT_GT(usual.said_um(), 0.2 * room);
  EXPECT_LT(usual.bound_um() - narrow.bound_um(), 0.55 * room);
  bool listed = false;
  for (const Json& line : wide.report["assumed"])
    listed = listed || line.get<std::string>().find("contour deviation = ") != std::string::npos;
  EXPECT_TRUE(listed);
}

// What leaves an allowance is granted a share of that, in a word of its own; the ledger counts what no later one takes.
TEST_P(Contour, OfAnAllowanceIsWider) {
  const std::string first =
      "[[operation]]\ntype = \"semi_finishing\"\ntool = 1\nspeed = 20000\nfeed = 900.0\nscallop = 0.1\nchord_tolerance "
      "= "
      "0.004\nallowance = 0.2\ntool_axis = [[60.8, -3.0, 0.3], [62.2, 3.0, 0.3]]\n";
  const ContourRun run = run_on(GetParam(), "20.0", "", first);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::regex words(R"(CYCL DEF 32\.1 T([0-9.]+)\n.*HSC-MODE:1|CYCLE832\(([0-9.]+),_ORI_ROUGH)");
  std::smatch m;
  ASSERT_TRUE(std::regex_search(run.text, m, words)) << run.text.substr(0, 3000);
  EXPECT_NEAR(std::stod(m[1].matched ? m[1] : m[2]), 0.004, 1e-9);
  EXPECT_LT(run.blending_um(), 3.0);
  EXPECT_LE(run.bound_um(), 3.0);
}

// A value that does not fit names its place and what would.
TEST(ContourKey, DoesNotFitOrHasNoWords) {
  const ContourRun much = run_on("heidenhain_ac", "", "contour_tolerance = 0.01\n");
  EXPECT_NE(much.exit_code, 0);
  EXPECT_TRUE(
      std::regex_search(much.err, std::regex(R"(job\.toml:\d+:\d+: error: program\.contour_tolerance = 0\.01 mm )"
                                             R"(does not fit into \[verify\] gouge_tolerance = 0\.003 mm)")))
      << much.err;
  std::smatch m;
  ASSERT_TRUE(std::regex_search(much.err, m, std::regex(R"(leaves ([0-9.]+) mm)"))) << much.err;
  const ContourRun fits = run_on("heidenhain_ac", "", "contour_tolerance = " + m[1].str() + "\n");
  EXPECT_EQ(fits.exit_code, 0) << fits.err;
  const ContourRun none = run_on("fanuc_ac", "", "contour_tolerance = 0.001\n");
  EXPECT_EQ(none.exit_code, 3);
  EXPECT_NE(none.err.find("contour_tolerance: the text of \"fanuc\" says none; post.corner_tolerance"),
            std::string::npos)
      << none.err;
}

}  // namespace
}  // namespace toothpath::test
