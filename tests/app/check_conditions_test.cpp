// `toothpath check` of a program that somebody edited: feeds, speeds, coolant, tool and the line HASH, in the verdict,
// on the sheet and in report.json.
#include <regex>

#include "tests/app/check_scene.h"

namespace toothpath::test {
namespace {

class CheckConditions : public CheckScene {
 protected:
  static void SetUpTestSuite() {
    run_sample("spur_quick.toml");
    text_ = file_text(*dir_ / "run/program.ngc");
  }
  /// The text with the first (or `nth`) find of the pattern replaced.
  static std::string edited(const std::string& pattern, const std::string& by, int nth = 0) {
    const std::regex look(pattern);
    auto at = std::sregex_iterator(text_.begin(), text_.end(), look);
    for (int n = 0; n < nth && at != std::sregex_iterator(); ++n) ++at;
    EXPECT_NE(at, std::sregex_iterator()) << pattern;
    if (at == std::sregex_iterator()) return text_;
    return text_.substr(0, static_cast<std::size_t>(at->position())) + at->format(by) +
           text_.substr(static_cast<std::size_t>(at->position() + at->length()));
  }
  Finished check_text(const std::string& text) {
    write_file(*dir_ / "edited.ngc", text);
    const auto done = run_program({"check", job_, *dir_ / "edited.ngc", "--out", *dir_ / "edited", "--quiet"});
    report_ = Json::parse(file_text(*dir_ / "edited/report.json"));
    return done;
  }
  [[nodiscard]] std::string said(const char* list) const {
    std::string out;
    for (const auto& text : report_[list]) out += text.get<std::string>() + "\n";
    return out;
  }
  static inline std::string text_;
};

TEST_F(CheckConditions, TheProgramOfARunIsWhatItsJobAsks) {
  EXPECT_EQ(check_text(text_).exit_code, 0);
  EXPECT_TRUE(report_["verified"].get<bool>());
  EXPECT_EQ(said("warnings").find("line "), std::string::npos) << said("warnings");
  const Json& found = report_["conditions"];
  EXPECT_EQ(found["hash"], "fits");
  ASSERT_GE(found["operations"].size(), 2U);
  for (const Json& o : found["operations"]) {
    EXPECT_GT(o["cut_feed"]["value"].get<double>(), 0);
    EXPECT_GT(o["greatest_speed"]["line"].get<int>(), 0);
  }
  EXPECT_TRUE(found["axis_speed"].contains("C"));
  const std::string sheet = file_text(*dir_ / "edited/setup_check.html");
  EXPECT_NE(sheet.find("Feeds, speeds, tool and coolant"), std::string::npos);
  EXPECT_NE(sheet.find("The line HASH fits the text"), std::string::npos);
  const Json of_run = Json::parse(file_text(*dir_ / "run/report.json"));
  EXPECT_EQ(of_run["conditions"], found) << "run and check are judged by the same";
  EXPECT_EQ(of_run["program"]["blocks"], report_["program"]["blocks"]);
  EXPECT_EQ(of_run["program"]["blocks"], of_run["blocks"]);
}

TEST_F(CheckConditions, AFeedThatIsTooQuick) {
  // A block in the middle of the teeth: inverse time, 100 times as quick.
  const auto done = check_text(edited(R"(\n(X[^\n]* F)([0-9]+)(\.[0-9]+)?\n)", "\n$01$0200\n", 40));
  EXPECT_EQ(done.exit_code, 1) << done.out;
  EXPECT_NE(said("reasons").find("line "), std::string::npos) << said("reasons");
  EXPECT_TRUE(std::regex_search(said("reasons"), std::regex("limits\\.|max_speed|limits.cutting_feed")))
      << said("reasons");
  EXPECT_NE(done.err.find("line "), std::string::npos) << done.err;
  EXPECT_NE(said("warnings").find("HASH does not fit the text, the blocks were edited"), std::string::npos);
  EXPECT_EQ(report_["conditions"]["hash"], "does not fit");
  EXPECT_NE(file_text(*dir_ / "edited/setup_check.html").find("does not fit the text"), std::string::npos);
}

TEST_F(CheckConditions, ASpindleThatIsNotTheJobs) {
  const auto most = check_text(edited("S[0-9]+ M3", "S90000 M3"));
  EXPECT_EQ(most.exit_code, 1);
  EXPECT_NE(said("reasons").find("above spindle.max_speed"), std::string::npos) << said("reasons");
  EXPECT_NE(said("reasons").find("S 90000, the job says"), std::string::npos) << said("reasons");
}

TEST_F(CheckConditions, AnEditThatIsHarmlessIsAWarning) {
  const auto done = check_text(edited("\nG49\n", "\nG49\nG49\n"));
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(said("reasons"), "");
  EXPECT_NE(said("warnings").find("HASH does not fit the text"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
