// `study dhfg` in one piece, in shards, and taken up after a kill: the same numbers.
#include <csignal>
#include <nlohmann/json.hpp>

#include "app/studies/trials/dhfg_samples.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kSmallStudy = R"(schema = 1
name = "small"
[study]
module = 5.0
module_plane = "normal"
pressure_angle = 20.0
half_face = 6.0
pinion_teeth = [25, 26, 27]
ratio = [4, 5, 6]
helix_angle = [20.0, 22.0, 24.0]
)";
const std::vector<std::string> kDhfgMerged = {"dhfg.csv", "dhfg.html", "dhfg.json", "samples.jsonl"};

std::vector<std::string> dhfg_of(const std::string& file, const std::string& out, const std::string& shard = "") {
  std::vector<std::string> words = {"study", "dhfg", "--quick", "--file", file, "--out", out};
  if (!shard.empty()) words.insert(words.end(), {"--shard", shard});
  return words;
}

/// Line for line the same but for the table that tells run times and the sentence about them.
void expect_same_page(const std::string& one, const std::string& other) {
  std::istringstream a(one), b(other);
  std::string x, y;
  int differences = 0;
  while (std::getline(a, x) && std::getline(b, y)) differences += x != y ? 1 : 0;
  EXPECT_LE(differences, 2);  // two rows of a quick study
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), std::count(other.begin(), other.end(), '\n'));
}

TEST(StudyDhfg, InShardsAndAfterAKillTheSameAsInOnePiece) {
  const TestDir dir;
  const std::string file = dir / "study.toml", whole = dir / "whole", cut = dir / "cut";
  write_file(file, kSmallStudy);
  ASSERT_EQ(run_program(dhfg_of(file, whole)).exit_code, 0);
  EXPECT_EQ(names_in(whole), (std::vector<std::string>{"dhfg.csv", "dhfg.html", "dhfg.json"}));

  const std::string second = cut + "/samples.2of3.jsonl";
  const auto lines = [&] {
    const std::string text = std::filesystem::exists(second) ? file_text(second) : "";
    return std::count(text.begin(), text.end(), '\n');
  };
  Launch launch;
  launch.arguments = dhfg_of(file, cut, "2/3");
  launch.signal_number = SIGKILL;
  launch.signal_when = second;
  launch.before_signal = [&] {
    for (int k = 0; k < 60'000 && lines() < 2; ++k) ::usleep(1000);
  };
  EXPECT_EQ(run_program(launch).exit_code, -1);
  const auto stood = lines();
  ASSERT_LT(stood, 8);  // a head and seven samples
  const auto again = run_program(dhfg_of(file, cut, "2/3"));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.out.find(fmt::format("{} of them new", 8 - stood)), std::string::npos) << again.out;

  auto words = dhfg_of(file, cut, "1/3");
  words.insert(words.end(), {"--threads", "1"});
  ASSERT_EQ(run_program(words).exit_code, 0);
  const auto early = run_program({"study", "merge", cut});
  EXPECT_EQ(early.exit_code, 3);
  EXPECT_NE(early.err.find("6 of 20 samples are missing: 2, 5, 8, 11, 14, 17;"), std::string::npos) << early.err;
  ASSERT_EQ(run_program(dhfg_of(file, cut, "3/3")).exit_code, 0);
  const auto merged = run_program({"study", "merge", cut});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  for (const std::string name : {"dhfg.csv", "dhfg.json"})
    EXPECT_EQ(file_text(cut + "/" + name), file_text(whole + "/" + name)) << name;
  expect_same_page(file_text(whole + "/dhfg.html"), file_text(cut + "/dhfg.html"));

  // Cut otherwise, of the same samples: the same bytes.
  const std::string one = dir / "one";
  std::filesystem::create_directory(one);
  write_file(one + "/samples.1of1.jsonl", file_text(cut + "/samples.jsonl"));
  const auto nothing = run_program(dhfg_of(file, one, "1/1"));
  ASSERT_EQ(nothing.exit_code, 0) << nothing.err;
  EXPECT_NE(nothing.out.find("20 samples in " + one + "/samples.1of1.jsonl, 0 of them new"), std::string::npos);
  for (const std::string& name : kDhfgMerged)
    EXPECT_EQ(file_text(one + "/" + name), file_text(cut + "/" + name)) << name;

  // Levels point into lists: they must be those of the trial.
  const std::string samples = file_text(cut + "/samples.jsonl");
  const auto merged_as = [&](const std::string& from, const std::string& to) {
    write_file(one + "/samples.1of1.jsonl", replaced(samples, from, to));
    const auto refused = run_program({"study", "merge", one});
    EXPECT_EQ(refused.exit_code, 3);
    return refused.err;
  };
  EXPECT_NE(merged_as("\"teeth\":0}", "\"teeth\":7}").find("samples.1of1.jsonl:2:1: error: \"found.levels\" are not"),
            std::string::npos);
  EXPECT_NE(merged_as("\"version\":2", "\"version\":3")
                .find("samples.1of1.jsonl:1:1: error: version = 3 of study dhfg, and this program has version 2"),
            std::string::npos);

  write_file(file, replaced(kSmallStudy, "half_face = 6.0", "half_face = 6.5"));
  const auto other = run_program(dhfg_of(file, cut, "2/3"));
  EXPECT_EQ(other.exit_code, 3);
  EXPECT_NE(other.err.find("this file is of another study (they differ in: key)"), std::string::npos) << other.err;
}

samples::Merged merged_of(const std::string& facts, const std::vector<std::string>& lines, int count) {
  samples::Merged merged{
      {trials::kDhfg, count, R"({"facts":)" + facts + "}", trials::kDhfgVersion}, {"a.jsonl", 1, 1}, {}, ""};
  for (const auto& line : lines) merged.lines.push_back({line, {"a.jsonl", int(merged.lines.size()) + 2, 1}});
  return merged;
}

TEST(StudyDhfg, SamplesThatItDoesNotWriteAreRefused) {
  const std::string facts =
      R"({"name":"a","quick":false,"milled":false,"module_mm":5,"normal_module":true,"pinion_teeth":[25,30,35],)"
      R"("ratio":[6,8,10],"helix_angle_rad":[0.3,0.4,0.5],"torque_nmm":1,"held_share":0.5,"rapid_mm_min":1,)"
      R"("equal_half_mm":0,"efforts":0})";
  const std::vector<std::string> nine(9, R"({"sample":0,"found":{}})");
  const auto message = [](const samples::Merged& merged) {
    const auto study = trials::study_of(merged);
    EXPECT_FALSE(study);
    return study ? "" : study.error().text();
  };
  const auto head = [&](const std::string& from, const std::string& to, int count) {
    return message(merged_of(replaced(facts, from, to), nine, count));
  };
  const std::string at = "a.jsonl:1:1: error: ";
  EXPECT_TRUE(message(merged_of("{}", {}, 0)).starts_with(at + "\"facts.efforts\" is missing:"));
  EXPECT_TRUE(message(merged_of(facts, {}, 8)).starts_with(at + "\"samples\" = 8, and the facts of the study make 9"));
  EXPECT_TRUE(head("\"efforts\":0", "\"efforts\":-5", 9).starts_with(at + "\"facts.efforts\" = -5 of 9 samples"));
  EXPECT_TRUE(head("\"efforts\":0", "\"efforts\":2147483647", 9).starts_with(at + "\"facts.efforts\" = 2147483647"));
  EXPECT_TRUE(head("\"efforts\":0", "\"efforts\":1e9", 9)
                  .starts_with(at + "\"facts.efforts\" is number; a whole number that fits 32 bits is needed"));
  EXPECT_TRUE(head("[6,8,10]", "[6,8]", 9).starts_with(at + "\"facts.ratio\" has 2 entries, not 3"));
  EXPECT_TRUE(head("\"torque_nmm\":1", "\"torque_nmm\":\"1\"", 9)
                  .starts_with(at + "\"facts.torque_nmm\" is string; a number is needed"));

  const auto line = [&](const std::string& text) {
    std::vector<std::string> lines = nine;
    lines[0] = text;
    return message(merged_of(facts, lines, 9));
  };
  EXPECT_TRUE(message(merged_of(facts, nine, 9)).starts_with("a.jsonl:2:1: error: \"found.L_p_mm\" is missing:"));
  EXPECT_TRUE(line("{}").starts_with("a.jsonl:2:1: error: \"found\" is missing"));
}

}  // namespace
}  // namespace toothpath::test
