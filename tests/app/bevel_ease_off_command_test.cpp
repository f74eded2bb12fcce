// `contact` of a bevel pair with a box of misalignments, and `contact --optimise`, run as a user would.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/report.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

const std::string kBevelWheel = kSamples + "/bevel_wheel.toml";

/// A sample of one hand, which rolls in half the time.
std::string of_one_hand(std::string text) {
  text = replaced(text, "form = \"herringbone\"", "form = \"single\"");
  text = replaced(text, "apex_cone_distance = 104.0", "apex_cone_distance = 108.0");
  return replaced(text, "relief_half_width = 3.2", "# of a herringbone: 3.2");
}

/// The pinion sample with this as its [contact]; of one hand, or as it is.
std::string bevel_job_with(const TestDir& dir, const std::string& name, const std::string& contact,
                           bool single = true) {
  std::string text = file_text(kSamples + "/bevel_pinion.toml");
  if (single) text = of_one_hand(text);
  const auto at = text.find("\n[machine]");
  const std::string path = dir / name;
  write_file(path, text.substr(0, at) + "\n[contact]\n" + contact + "\n" + text.substr(at));
  return path;
}

/// The wheel of one hand.
std::string mate_of(const TestDir& dir) {
  const std::string path = dir / "wheel.toml";
  write_file(path, of_one_hand(file_text(kBevelWheel)));
  return path;
}

/// A row a quantity and way, as the pair that stands there by keys is; maps, motion curves and drawings beside them.
TEST(BevelMisalignmentTable, RowsAreThePairThatStandsThere) {
  const TestDir dir;
  const Json report = report_of({"contact",
                                 bevel_job_with(dir, "box.toml",
                                                "[contact.misalignment]\noffset = 0.02\nangle = 0.03\npinion_axial = "
                                                "0.01\ngear_axial = 0.02\n",
                                                false),
                                 "--mate", kBevelWheel, "--out", dir / "box"});
  const Json& rows = report.at("misalignments").at("rows");
  ASSERT_EQ(rows.size(), 9u);
  EXPECT_EQ(rows[0].at("name"), "as it stands");
  EXPECT_EQ(rows[8].at("name"), "gear axial +0.02 mm");
  const std::pair<std::size_t, const char*> keys[] = {{0, ""},
                                                      {1, "offset_error = -0.02\n"},
                                                      {4, "angle_error = 0.03\n"},
                                                      {6, "axial_error = 0.01\n"},
                                                      {8, "gear_axial_error = 0.02\n"}};
  for (const auto& [row, key] : keys) {
    SCOPED_TRACE(key);
    const Json alone = report_of(
        {"contact", bevel_job_with(dir, "alone.toml", key, false), "--mate", kBevelWheel, "--out", dir / "alone"});
    for (const std::size_t s : {0u, 1u}) {
      const Json &flank = rows[row].at("flanks")[s], &same = alone.at("walls")[s];
      EXPECT_EQ(flank.at("wall"), same.at("wall"));
      EXPECT_EQ(flank.at("transmission_error").at("range_urad"), same.at("transmission_error_urad"));
      ASSERT_EQ(flank.at("zones").size(), 2u);
      EXPECT_EQ(flank.at("zones"), same.at("zones"));
    }
  }
  for (const Json& wall : report.at("walls")) {
    EXPECT_EQ(wall.at("ease_off").at("least").at("um"), 0);
    EXPECT_EQ(wall.at("ease_off").at("zones").size(), 2u);
    const Json& curve = wall.at("motion_curve").at("urad");
    EXPECT_GT(curve.size(), 20u);
    EXPECT_EQ(curve.size(), wall.at("motion_curve").at("pitches").size());
  }
  const std::string csv = file_text(dir / "box/ease_off.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')),
            "wall,half,row,column,cone_distance,height,ease_off_um,phi_2_deg,pinion_height,pinion_cone_distance");
  const std::string page = file_text(dir / "box/contact.html");
  for (const char* words : {"Ease-off: wall L, half 1", "Motion curves of the pairs", "Misaligned",
                            "Way of the pattern", "gear axial +0.02 mm"})
    EXPECT_NE(page.find(words), std::string::npos) << words;
}

/// What is found keeps the pattern of both walls inside; the job that is written gives the same numbers.
TEST(BevelContactOptimise, WritesAJobThatDoesWhatWasPromised) {
  const TestDir dir;
  const std::string job = bevel_job_with(dir, "plain.toml", "[contact.misalignment]\noffset = 0.01\n"),
                    found_job = dir / "found.toml";
  const Json report =
      report_of({"contact", job, "--mate", mate_of(dir), "--optimise", "--write", found_job, "--out", dir / "out"});
  const Json& found = report.at("optimised");
  ASSERT_TRUE(found.at("found").get<bool>()) << found.dump(1);
  EXPECT_EQ(found.at("modify"), "pinion");
  double crowning = 0;
  for (const Json& m : found.at("modifications")) {
    EXPECT_EQ(m.at("member"), "pinion");
    if (m.at("kind") == "profile_crowning") crowning = m.at("amount");
  }
  const Json& rows = found.at("misalignments").at("rows");
  double worst = 0;
  for (const Json& row : rows)
    for (const Json& flank : row.at("flanks")) {
      worst = std::max(worst, flank.at("transmission_error").at("range_um").get<double>());
      EXPECT_TRUE(flank.at("zones")[0].at("reaches").empty()) << row.dump(1);
      EXPECT_GT(flank.at("margin_gap_um").get<double>(), 6);
    }
  EXPECT_NEAR(found.at("transmission_error_um").at("worst").get<double>(), worst, 1e-9);
  EXPECT_NEAR(found.at("transmission_error_um").at("of_the_search").get<double>(), worst, 0.3 + 0.05 * worst);
  std::printf("  transmission error %.3f um, the search said %.3f; profile crowning %.1f um\n", worst,
              found.at("transmission_error_um").at("of_the_search").get<double>(), crowning * 1e3);
  EXPECT_NE(file_text(found_job).find(found.at("keys").get<std::string>()), std::string::npos);
  const Json as_job = report_of({"contact", found_job, "--mate", mate_of(dir), "--out", dir / "job"});
  const Json& table = as_job.at("misalignments").at("rows");
  ASSERT_EQ(table.size(), 3u);
  for (std::size_t k = 0; k < table.size(); ++k) EXPECT_EQ(table[k], rows[k]) << k;
  EXPECT_FALSE(report.at("misalignments").at("rows")[0].at("flanks")[0].at("zones")[0].at("reaches").empty());
}

/// Where there is none it says so, with what is in the way, and writes no job.
TEST(BevelContactOptimise, SaysWhenThereIsNone) {
  const TestDir dir;
  const std::string job = bevel_job_with(dir, "plain.toml", "[contact.misalignment]\nmargin = 0.4\noffset = 0.01\n");
  const auto run = run_program(
      {"contact", job, "--mate", mate_of(dir), "--optimise", "--out", dir / "out", "--write", dir / "found.toml"});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  EXPECT_NE(run.out.find("none was found: at best the gap within 40 % of the edges is"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find(", wall "), std::string::npos);
  EXPECT_NE(run.out.find("no job was written"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(dir / "found.toml"));
}

TEST(BevelContactOptimise, Refusals) {
  const TestDir dir;
  const std::string boxed = bevel_job_with(dir, "boxed.toml", "[contact.misalignment]\noffset = 0.01\n"),
                    bare = bevel_job_with(dir, "bare.toml", "");
  const auto refused = [&](const std::string& words, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "contact");
    arguments.insert(arguments.end(), {"--mate", mate_of(dir), "--out", dir / "out"});
    const auto run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 3) << words;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  refused("--optimise needs a box of misalignments: [contact.misalignment]", {bare, "--optimise"});
  for (const char* who : {"gear", "both"})
    refused(
        std::string("--write writes the job of the gear that it makes, the pinion of the pair, but --modify ") + who,
        {boxed, "--optimise", "--modify", who, "--write", dir / "new.toml"});
  EXPECT_FALSE(std::filesystem::exists(dir / "new.toml"));
}

}  // namespace
}  // namespace toothpath::test
