// Both studies, run as a user would.
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

std::vector<std::vector<std::string>> csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, std::vector<std::string>(1));
  bool quoted = false;
  for (const char c : text) {
    if (c == '"') quoted = !quoted;
    else if (c == ',' && !quoted) rows.back().emplace_back();
    else if (c == '\n' && !quoted) rows.emplace_back(1);
    else rows.back().back() += c;
  }
  rows.pop_back();
  return rows;
}

/// Every case is fine, and the study did look at what it says.
TEST(StudyStability, EveryVerdictIsFine) {
  const TestDir dir;
  const std::string out = dir / "out";
  const auto done = run_program({"study", "stability", "--out", out, "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"stability.csv", "stability.html", "stability.json"}));
  const Json report = Json::parse(done.out).at("report");
  EXPECT_EQ(report, Json::parse(file_text(out + "/stability.json")));
  EXPECT_TRUE(report.at("fine").get<bool>());
  std::map<std::string, int> groups;
  std::set<std::string> verdicts;
  for (const auto& row : report.at("cases")) {
    const std::string name = row.at("group").get<std::string>() + ", " + row.at("case").get<std::string>(),
                      verdict = row.at("verdict");
    ++groups[row.at("group")];
    verdicts.insert(verdict);
    EXPECT_TRUE(row.at("fine").get<bool>()) << name;
    ASSERT_TRUE(row.at("error_mm").is_number()) << name;  // NaN would be null
    if (row.at("points").get<int>() > 0) {
      EXPECT_LE(row.at("error_mm").get<double>(), row.at("limit_mm").get<double>()) << name;
      EXPECT_LT(row.at("limit_mm").get<double>(), 1e-7)
          << name;  // a limit that forgives everything would prove nothing
    }
    if (verdict == "refused") {
      EXPECT_NE(row.at("reason").get<std::string>().find_first_of("0123456789"), std::string::npos) << name;
    }
  }
  EXPECT_EQ(verdicts, (std::set<std::string>{"pass", "refused"}));
  EXPECT_EQ(groups["face gear flank"], 22);
  EXPECT_EQ(groups["face gear fillet"], 22);
  EXPECT_EQ(groups["near undercut"], 4);
  EXPECT_GE(groups["bevel gear"], 15);
  EXPECT_EQ(groups["pole"], 36);
  EXPECT_GE(groups["non-linear error"], 5);

  // Conditions say what is hard: they grow as the cusp comes near, and the error does not follow them.
  double last = 0;
  for (const auto& row : report.at("cases")) {
    if (row.at("group") != "near undercut") continue;
    EXPECT_GT(row.at("condition").get<double>(), 50 * last);
    EXPECT_LT(row.at("error_mm").get<double>(), 1e-11);
    last = row.at("condition").get<double>();
  }
  EXPECT_EQ(csv(file_text(out + "/stability.csv")).size(), report.at("cases").size() + 1);
}

/// Finer tolerances give more points and less deviation; the numbers of all three files agree.
TEST(StudyWorkPrecision, QuickSweepOfTheSpurSample) {
  const TestDir dir;
  const std::string out = dir / "out";
  const auto done =
      run_program({"study", "work-precision", kSamples + "/spur_quick.toml", "--out", out, "--quick", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(names_in(out), (std::vector<std::string>{"report.html", "work_precision.csv", "work_precision.html",
                                                     "work_precision.json", "work_precision.svg"}));
  const Json report = Json::parse(done.out).at("report");
  EXPECT_EQ(report, Json::parse(file_text(out + "/work_precision.json")));
  std::map<std::pair<std::string, double>, Json> runs;
  for (const auto& run : report.at("runs")) runs[{run.at("varied"), run.at("factor")}] = run;
  ASSERT_EQ(runs.size(), 7u);
  const Json& job = runs.at({"job", 1});
  EXPECT_TRUE(job.at("verified").get<bool>()) << job.at("reason");
  EXPECT_NEAR(job.at("chord_um").get<double>(), 2, 1e-9);
  EXPECT_NEAR(job.at("scallop_um").get<double>(), 20, 1e-9);

  const auto number = [&](const std::string& varied, double factor, const char* key) {
    return runs.at({varied, factor}).at(key).get<double>();
  };
  // The scallop is a decade finer: the step-over shrinks by sqrt(10), and the deviation by nearly ten.
  EXPECT_GT(number("scallop", 0.1, "cl_points"), 1.5 * job.at("cl_points").get<double>());
  EXPECT_LT(number("scallop", 0.1, "worst_um"), 0.4 * job.at("worst_um").get<double>());
  EXPECT_LT(number("scallop", 0.1, "rms_um"), 0.4 * job.at("rms_um").get<double>());
  EXPECT_GT(number("scallop", 10, "rms_um"), job.at("rms_um").get<double>());
  EXPECT_LT(number("scallop", 10, "cutting_minutes"), job.at("cutting_minutes").get<double>());
  EXPECT_GE(number("chord", 0.1, "cl_points"), job.at("cl_points").get<double>());
  EXPECT_LE(number("chord", 10, "cl_points"), job.at("cl_points").get<double>());
  // The proof changes nothing of the path, only how close its bound comes.
  for (const double factor : {0.1, 10.0}) {
    EXPECT_EQ(number("verification", factor, "cl_points"), job.at("cl_points").get<double>());
    EXPECT_EQ(number("verification", factor, "worst_um"), job.at("worst_um").get<double>());
  }
  EXPECT_LE(number("verification", 0.1, "gouge_bound_um") - number("verification", 0.1, "gouge_um"),
            number("verification", 10, "gouge_bound_um") - number("verification", 10, "gouge_um"));
  for (const auto& run : report.at("runs")) {
    double sum = 0;
    for (const auto& [key, value] : run.items())
      if (key.ends_with("_s")) sum += value.get<double>();
    EXPECT_NEAR(sum, run.at("seconds").get<double>(), 0.001 * 20);
    if (run.at("gouge_um").is_number()) {
      EXPECT_GE(run.at("gouge_bound_um").get<double>(), run.at("gouge_um").get<double>());
    }
  }
  const auto rows = csv(file_text(out + "/work_precision.csv"));
  EXPECT_EQ(rows.size(), 8u);
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows.front().size());
  const std::string svg = file_text(out + "/work_precision.svg");
  EXPECT_EQ(svg.rfind("<svg xmlns=", 0), 0u);
  EXPECT_NE(file_text(out + "/work_precision.html").find("Error against run time"), std::string::npos);
  const std::string page = file_text(out + "/report.html");  // of the job's own run, the study's plots in it
  for (const char* part :
       {"<section id=\"work-precision\">", "Sharpness of the proof against its time", "<section id=\"motion\">",
        "<section id=\"deviation\">", "tolerance 2.00", "<p class=\"verdict good\">"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

TEST(Study, RefusesWhatItCannotDo) {
  const TestDir dir;
  EXPECT_EQ(run_program({"study"}).exit_code, 2);
  EXPECT_EQ(run_program({"study", "speed", "--out", dir / "a"}).exit_code, 2);
  EXPECT_EQ(run_program({"study", "work-precision", "--out", dir / "a"}).exit_code, 2);
  EXPECT_EQ(run_program({"study", "work-precision", dir / "none.toml", "--out", dir / "b"}).exit_code, 4);
  const auto bevel = run_program({"study", "work-precision", kSamples + "/bevel_pinion.toml", "--out", dir / "c"});
  EXPECT_EQ(bevel.exit_code, 3);
  EXPECT_NE(bevel.err.find("error: "), std::string::npos);
  EXPECT_TRUE(names_in(dir / "c").empty());
}

}  // namespace
}  // namespace toothpath::test
