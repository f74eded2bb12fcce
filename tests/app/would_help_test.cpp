// A program that is refused for its bound alone: what the refusal offers meets it.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "app/process/ledger_sources.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

TEST(WouldHelp, StandsWhereverTheReportDoes) {
  const TestDir dir;
  write_file(dir / "job.toml", not_verified_job());
  const auto refused = run_program({"run", dir / "job.toml", "--out", dir / "out"});
  ASSERT_EQ(refused.exit_code, 1) << refused.err;
  const std::string bound = fmt::format(
      "{:.2f} um", nlohmann::json::parse(file_text(dir / "out/report.json"))["gouge_um"]["bound"].get<double>());
  const std::string larger = "a larger [verify] gouge_tolerance: this program is proven to keep " + bound,
                    part = "path blending is the largest, 10.17 um";
  for (const std::string& text :
       {refused.out, file_text(dir / "out/report.json"), file_text(dir / "out/report.html")}) {
    EXPECT_NE(text.find(larger), std::string::npos) << larger << "\n" << text.substr(0, 2000);
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text.substr(0, 2000);
  }
  const auto verified = run_program({"run", kQuick, "--out", dir / "out"});
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
  EXPECT_EQ(verified.out.find("would help"), std::string::npos);
}

TEST(WouldHelp, NamesTheLargestPartOfTheBoundAndNothingWhereTheToolCutsTooDeep) {
  using proof::ErrorSource;
  const std::vector<proof::LedgerEntry> ledger{process::entry(ErrorSource::scallop, 0.02, 0.01),
                                               process::entry(ErrorSource::chord, 0.0004, 0.0001),
                                               process::entry(ErrorSource::rounding, 0.0011, 0.0003)};
  proof::GougeResult gouge;
  gouge.measured_mm = 0.0008;
  gouge.bound_mm = 0.00231;
  const auto help = process::what_would_help(ledger, gouge, 0.002);
  ASSERT_EQ(help.size(), 2u);
  EXPECT_NE(help[0].find("proven to keep 2.31 um"), std::string::npos) << help[0];
  EXPECT_NE(help[1].find("linear_decimals"), std::string::npos) << help[1];
  EXPECT_NE(help[1].find("rounding is the largest, 1.10 um"), std::string::npos) << help[1];
  EXPECT_TRUE(process::what_would_help(ledger, gouge, 0.0024).empty());
  gouge.measured_mm = 0.0021;
  EXPECT_TRUE(process::what_would_help(ledger, gouge, 0.002).empty());
}

}  // namespace
}  // namespace toothpath::test
