// `contact` with a box of misalignments, and `contact --optimise`, run as a user would.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/report.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

/// The spur sample without its modifications, with this behind its [contact].
std::string plain_job(const TestDir& dir, const std::string& name, const std::string& contact) {
  const std::string text = file_text(kSamples + "/spur_quick.toml");
  const auto at = text.find("[machine]");
  const std::string path = dir / name;
  write_file(path, text.substr(0, at) + "[contact]\npinion_teeth = 20\n" + contact + "\n" + text.substr(at));
  return path;
}

constexpr const char* kCrowned = R"(
[[contact.modification]]
kind = "lead_crowning"
amount = 0.02

[[contact.modification]]
kind = "tip_relief"
amount = 0.015
length = 1.0

[[contact.modification]]
kind = "root_relief"
amount = 0.015
length = 1.0
)";

/// A row a quantity and way, as the pair that stands there by keys is: errors, extent, edges, one by one.
TEST(MisalignmentTable, RowsAreThePairThatStandsThere) {
  const TestDir dir;
  const std::string box =
      "compound = 0.0063\n[contact.misalignment]\noffset = 0.02\nangle = 0.03\npinion_axial = 0.01\ngear_axial = "
      "0.02\n";
  const Json report = report_of({"contact", plain_job(dir, "box.toml", box + kCrowned), "--out", dir / "box"});
  const Json& table = report.at("misalignments");
  EXPECT_NEAR(table.at("box").at("angle_deg").get<double>(), 0.03, 1e-12);
  const Json& rows = table.at("rows");
  ASSERT_EQ(rows.size(), 9u);
  EXPECT_EQ(rows[0].at("name"), "as it stands");
  EXPECT_EQ(rows[3].at("name"), "angle -0.03 deg");
  EXPECT_EQ(rows[8].at("name"), "gear axial +0.02 mm");
  const std::pair<std::size_t, const char*> keys[] = {{0, ""},
                                                      {2, "offset_error = 0.02\n"},
                                                      {3, "angle_error = -0.03\n"},
                                                      {6, "axial_error = 0.01\n"},
                                                      {8, "gear_axial_error = 0.02\n"}};
  for (const auto& [row, key] : keys) {
    SCOPED_TRACE(key);
    const Json alone =
        report_of({"contact", plain_job(dir, "alone.toml", std::string("compound = 0.0063\n") + key + kCrowned),
                   "--out", dir / "alone"});
    for (const std::size_t s : {0u, 1u}) {
      const Json &flank = rows[row].at("flanks")[s], &same = alone.at("flanks")[s];
      EXPECT_EQ(flank.at("transmission_error"), same.at("transmission_error"));
      const Json &zone = flank.at("zones")[0], &pattern = same.at("zones")[0].at("pattern");
      EXPECT_EQ(zone.at("lead"), pattern.at("lead"));
      EXPECT_EQ(zone.at("profile"), pattern.at("profile"));
      for (const auto& [edge, at] : {std::pair("inner end", "at_inner_end"),
                                     {"outer end", "at_outer_end"},
                                     {"tip", "at_tip"},
                                     {"fillet line", "at_fillet_line"},
                                     {"pinion tip", "at_pinion_tip"}}) {
        const Json& reaches = zone.at("reaches");
        EXPECT_EQ(std::find(reaches.begin(), reaches.end(), edge) != reaches.end(), pattern.at(at).get<bool>()) << edge;
      }
      EXPECT_LE(zone.at("lead_extent")[0].get<double>(), zone.at("lead").get<double>());
      EXPECT_GE(zone.at("lead_extent")[1].get<double>(), zone.at("lead").get<double>());
    }
  }
  // An error of the shaft angle moves the pattern along the face, as much either way.
  const double less = rows[3].at("flanks")[0].at("zones")[0].at("lead"),
               stands = rows[0].at("flanks")[0].at("zones")[0].at("lead"),
               more = rows[4].at("flanks")[0].at("zones")[0].at("lead");
  EXPECT_GT(std::abs(more - less), 0.005);
  EXPECT_LT((less - stands) * (more - stands), 0);
  const std::string page = file_text(dir / "box/contact.html");
  for (const char* words : {"Misaligned", "Way of the pattern", "gear axial +0.02 mm"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

/// What is found keeps the pattern inside; the job that is written gives the same numbers; threads change no byte.
TEST(ContactOptimise, WritesAJobThatDoesWhatWasPromised) {
  const TestDir dir;
  const std::string job = plain_job(dir, "plain.toml", "[contact.misalignment]\nangle = 0.03\n");
  const std::string found_job = dir / "found.toml";
  const auto run = [&](const std::string& out, const std::string& threads, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"contact", job, "--optimise", "--out", dir / out, "--threads", threads};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return report_of(arguments);
  };
  const Json report = run("one", "1", {"--write", found_job}), again = run("two", "2", {});
  EXPECT_EQ(file_text(dir / "one/contact.json"), file_text(dir / "two/contact.json"));
  const Json& found = report.at("optimised");
  ASSERT_TRUE(found.at("found").get<bool>()) << found.dump(1);
  EXPECT_FALSE(found.at("modifications").empty());
  const Json& rows = found.at("misalignments").at("rows");
  // The proof rolls places inside the box, too, that no search saw.
  int random = 0;
  for (const Json& row : rows) {
    if (row.at("name").get<std::string>().find("at random") == std::string::npos) continue;
    ++random;
    EXPECT_LT(std::abs(row.at("angle_deg").get<double>()), 0.03);
  }
  EXPECT_EQ(random, 4);
  double worst = 0;
  for (const Json& row : rows)
    for (const Json& flank : row.at("flanks")) {
      worst = std::max(worst, flank.at("transmission_error").at("range_um").get<double>());
      EXPECT_TRUE(flank.at("zones")[0].at("reaches").empty()) << row.dump(1);
      for (const char* extent : {"profile_extent", "lead_extent"}) {  // off the edges by the margin of 5 %
        EXPECT_GT(flank.at("zones")[0].at(extent)[0].get<double>(), 0.05 - 1e-9) << row.dump(1);
        EXPECT_LT(flank.at("zones")[0].at(extent)[1].get<double>(), 0.95 + 1e-9) << row.dump(1);
      }
      EXPECT_GT(flank.at("margin_gap_um").get<double>(), 6);
    }
  EXPECT_NEAR(found.at("transmission_error_um").at("worst").get<double>(), worst, 1e-12);
  std::printf("  transmission error %.4f um, the search said %.4f um, %ld candidates\n", worst,
              found.at("transmission_error_um").at("of_the_search").get<double>(), found.at("candidates").get<long>());
  EXPECT_NEAR(found.at("transmission_error_um").at("of_the_search").get<double>(), worst, 0.05 + 0.05 * worst);

  // As a job: the rows of the table are those of the proof, number by number.
  EXPECT_NE(file_text(found_job).find(found.at("keys").get<std::string>()), std::string::npos);
  const Json as_job = report_of({"contact", found_job, "--out", dir / "job"});
  const Json& table = as_job.at("misalignments").at("rows");
  ASSERT_EQ(table.size(), 3u);
  for (std::size_t k = 0; k < table.size(); ++k) EXPECT_EQ(table[k], rows[k]) << k;
  // The plain pair is worse: it reaches edges.
  EXPECT_FALSE(report.at("misalignments").at("rows")[0].at("flanks")[0].at("zones")[0].at("reaches").empty());
}

/// Each key is needed: without it the error is not nearly equal to the least, or the margins lack; and what is said of
/// the pair without it is what the pair does when its job does not have it.
TEST(ContactOptimise, EveryKeyIsNeeded) {
  const TestDir dir;
  const std::string job = plain_job(dir, "plain.toml", "[contact.misalignment]\nangle = 0.03\n");
  const std::string found_job = dir / "found.toml";
  const Json found =
      report_of({"contact", job, "--optimise", "--write", found_job, "--out", dir / "out"}).at("optimised");
  ASSERT_TRUE(found.at("found").get<bool>());
  const Json& errors = found.at("transmission_error_um");
  const double most = errors.at("nearly_equal_up_to"), least = errors.at("least_of_the_search");
  EXPECT_NEAR(most, least + std::max(0.1, 0.05 * least), 1e-9);
  EXPECT_LE(errors.at("of_the_search").get<double>(), most + 1e-9);
  ASSERT_FALSE(found.at("without").empty());
  const std::string text = file_text(found_job);
  int rolled = 0;
  for (const Json& without : found.at("without")) {
    const double error = without.at("transmission_error_um"), gap = without.at("margin_gap_um");
    EXPECT_TRUE(error > most || gap < without.at("wanted_gap_um").get<double>() + 1e-5) << without.dump();
    EXPECT_LT(without.at("wanted_gap_um").get<double>(), 7);
    // The job without the first key of that kind and flank.
    const std::string kind = "kind = \"" + without.at("kind").get<std::string>() + "\"";
    std::string less = text;
    for (std::size_t at = text.find("\n[[", text.find("# Found by")); at != std::string::npos;) {
      const std::size_t end = std::min(text.find("\n[[", at + 1), text.size());
      const std::string key = text.substr(at, end - at);
      const bool of_pinion = key.find("[[contact") != std::string::npos;
      if (key.find(kind) != std::string::npos && of_pinion == (without.at("member") == "pinion") &&
          (key.find("flank") == std::string::npos ||
           key.find(without.at("flank").get<std::string>()) != std::string::npos))
        less = text.substr(0, at) + "\n" + text.substr(end);
      at = end < text.size() ? end : std::string::npos;
    }
    ASSERT_NE(less, text) << without.dump();
    write_file(dir / "less.toml", less);
    const Json rows = report_of({"contact", dir / "less.toml", "--out", dir / "less"}).at("misalignments").at("rows");
    const std::size_t side = without.at("flank") == "left" ? 1 : 0;
    double worst = 0, narrowest = 1e300;
    for (const Json& row : rows) {
      const Json& flank = row.at("flanks")[side];
      worst = std::max(worst, flank.at("transmission_error").at("range_um").get<double>());
      narrowest = std::min(narrowest, flank.at("margin_gap_um").get<double>());
    }
    EXPECT_NEAR(worst, error, 0.06 + 0.1 * worst) << without.dump();
    EXPECT_NEAR(narrowest, gap, 0.6) << without.dump();
    ++rolled;
  }
  EXPECT_GE(rolled, 3);
  EXPECT_LT(found.at("removal_um").get<double>(), 70);  // the margin holds at every edge
}

/// Where there is none it says so, with what is in the way, and writes no job.
TEST(ContactOptimise, SaysWhenThereIsNone) {
  const TestDir dir;
  const std::string job = plain_job(dir, "plain.toml", "compound = 0.09\n[contact.misalignment]\nangle = 0.5\n");
  const auto run = run_program({"contact", job, "--optimise", "--out", dir / "out", "--write", dir / "found.toml"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.out.find("none was found: at best the gap within 5 % of the edges is"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("no job was written"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir / "found.toml"));
}

TEST(ContactOptimise, Refusals) {
  const TestDir dir;
  const std::string boxed = plain_job(dir, "boxed.toml", "[contact.misalignment]\nangle = 0.03\n"),
                    bare = plain_job(dir, "bare.toml", ""), there = dir / "there.toml";
  write_file(there, "something");
  const auto refused = [&](int code, const std::string& words, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "contact");
    arguments.insert(arguments.end(), {"--out", dir / "out"});
    const auto run = run_program(arguments);
    EXPECT_EQ(run.exit_code, code) << words;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  refused(3, "--optimise needs a box of misalignments: [contact.misalignment]", {bare, "--optimise"});
  refused(2, "--write belongs to --optimise", {boxed, "--write", dir / "new.toml"});
  refused(2, "--modify belongs to --optimise", {boxed, "--modify", "gear"});
  refused(2, "exists already, and is not replaced", {boxed, "--optimise", "--write", there});
  refused(2, "--compound and --write contradict each other",
          {boxed, "--optimise", "--compound", "5", "--write", dir / "new.toml"});
  EXPECT_EQ(file_text(there), "something");
}

}  // namespace
}  // namespace toothpath::test
