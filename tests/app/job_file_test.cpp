// The job reader: every sample is read with the numbers that it states, and nothing that is wrong is read at all.
#include "app/job/file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "geometry/base/angle.h"
#include "tests/app/program.h"

namespace toothpath::test {
namespace {

job::Job read(const std::string& name) {
  auto result = job::read_job_file(kSamples + "/" + name);
  if (auto* errors = result.refused()) {
    ADD_FAILURE() << to_text(*errors);
    return {};
  }
  return std::move(result).value();
}

std::vector<Diagnostic> errors_of(const std::string& text) {
  auto result = job::parse_job(text, "job.toml");
  if (auto* errors = result.refused()) return *errors;
  return {};
}

TEST(JobFile, EverySampleIsRead) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSamples)) {
    if (entry.path().extension() != ".toml") continue;
    const auto result = job::read_job_file(entry.path().string());
    EXPECT_TRUE(result.has_value()) << to_text(result.refused() ? result.error() : std::vector<Diagnostic>{});
    ++count;
  }
  EXPECT_GE(count, 5);
}

// A file that is wrong in a million places is refused in few words, and soon.
TEST(JobFile, TooManyTablesKeysAndEntriesAreFewRefusals) {
  std::string tables = "tool = [", keys;
  for (int k = 0; k < 200'000; ++k) tables += "{},", keys += fmt::format("k{} = 1\n", k);
  const auto many_tables = errors_of(tables + "]\n");
  EXPECT_LT(many_tables.size(), 30u);
  EXPECT_NE(to_text(many_tables).find("job.toml:1:8: error: tool = 200000 tables exceeds 1000"), std::string::npos)
      << to_text(many_tables);
  EXPECT_LT(errors_of(keys).size(), 40u);
}

TEST(JobFile, GridsHaveALimitTogether) {
  const TestDir dir;
  std::string grid = "along,depth,removal\n", job = file_text(kSamples + "/spur_quick.toml");
  for (int depth = 0; depth < 100; ++depth)
    for (int along = 0; along < 3; ++along) grid += fmt::format("{},{},0.001\n", 60 + 2.5 * along, 0.04 * depth);
  write_file(dir / "grid.csv", grid);
  for (int k = 0; k < 5; ++k) {
    job += "\n[[gear.modification]]\nkind = \"grid\"\nfile = \"grid.csv\"\n";
    const auto read = job::parse_job(job, dir / "job.toml");
    EXPECT_EQ(read.has_value(), k < 4) << k;
    if (!read) {
      EXPECT_NE(to_text(read.error()).find("the grids have 500 depths up to here, which exceeds 400"),
                std::string::npos)
          << to_text(read.error());
    }
  }
}

TEST(JobFile, NumbersAreThoseOfTheFile) {
  const job::Job job = read("dhfg_paper.toml");
  const auto* gear = job.face_gear();
  ASSERT_NE(gear, nullptr);
  EXPECT_EQ(gear->teeth, 180);
  EXPECT_EQ(gear->shaper_teeth, 30);
  EXPECT_EQ(gear->module_plane, face_gear::ModulePlane::transverse);
  EXPECT_EQ(gear->reference_radius_mm, 472.0);
  ASSERT_EQ(gear->zones.size(), 2u);
  EXPECT_EQ(gear->zones[0].helix_angle_rad, radians(-30.0));
  EXPECT_EQ(gear->zones[1].outer_radius_mm, 496.0);
  EXPECT_EQ(gear->groove_depth_mm, 12.5);
  ASSERT_EQ(job.tools.size(), 2u);
  EXPECT_EQ(job.tools[0].holder.size(), 2u);
  EXPECT_EQ(job.tools[0].holder[1].height_mm, 30.0);
  ASSERT_EQ(job.operations.size(), 4u);
  EXPECT_EQ(job.operations[3].type, path::OperationType::finishing);
  EXPECT_EQ(job.operations[3].tool, 1);
  EXPECT_EQ(job.operations[3].chord_tolerance_mm, 0.001);
  EXPECT_TRUE(job.setup->axis_up);
  EXPECT_EQ(job.setup->origin_mm, Vec3(3, -2, 150));
  EXPECT_EQ(job.coolant, machines::Coolant::flood);
}

TEST(JobFile, ShapingIsRead) {
  const job::Job job = read("offset_shaped.toml");
  ASSERT_TRUE(job.shaping.has_value());
  EXPECT_EQ(job.shaping->cutting_speed_m_min, 20.0);
  EXPECT_EQ(job.shaping->offset_reference, shaper::Shaping::OffsetReference::outer_radius);
  EXPECT_TRUE(job.machine.accept_assumed);
  EXPECT_EQ(job.face_gear()->offset_mm, 15.0);
}

TEST(JobFile, BevelGearIsRead) {
  const std::string text = R"(schema = 1
name = "b"
[gear]
type = "equal_base_circle_bevel_gear"
teeth = 18
mate_teeth = 37
outer_transverse_module = 6.0
pressure_angle = 20.0
outer_spiral_angle = 30.0
face_width = 36.0
form = "herringbone"
hand = "left"
apex_cone_distance = 104.0
relief_half_width = 3.2
addendum = 4.1
dedendum = 5.1
)";
  const auto result = job::parse_job(text, "b.toml");
  ASSERT_TRUE(result.has_value()) << to_text(result.error());
  const auto* gear = result.value().bevel_gear();
  ASSERT_NE(gear, nullptr);
  EXPECT_EQ(gear->hand, -1);
  EXPECT_NEAR(std::tan(gear->pitch_angle_rad), 18.0 / 37.0, 1e-15);  // shaft angle 90 deg: tan delta = z1 / z2
}

TEST(JobFile, KeysKeepTheirPlace) {
  const job::Job job = read("dhfg_paper.toml");
  const std::string text = file_text(kSamples + "/dhfg_paper.toml");
  std::istringstream lines(text);
  std::string line;
  int number = 0, wanted = 0, zone = 0;
  while (std::getline(lines, line)) {
    ++number;
    if (line.starts_with("[[gear.zone]]")) ++zone;
    if (zone == 2 && line.starts_with("inner_radius")) wanted = number;
  }
  const auto position = job.where("gear.zone[1].inner_radius");
  EXPECT_EQ(position.line, wanted);
  EXPECT_EQ(position.column, 16);
  EXPECT_EQ(job.where("operation[2].climb").line, job.where("operation[2]").line)
      << "an absent key is located at its table";
  EXPECT_EQ(job.where("nowhere").line, 1) << "what belongs to no table is located at the file";
}

TEST(JobFile, EveryFindingIsReportedInTheOrderOfTheFile) {
  std::string text = file_text(kSamples + "/spur_quick.toml");
  text = replaced(text, "module = 2.0", "module = -2.0");
  text = replaced(text, "diameter = 1.0", "diametr = 1.0");
  text = replaced(text, "scallop = 0.02", "scallop = 0");
  const auto errors = errors_of(text);
  ASSERT_EQ(errors.size(), 4u) << to_text(errors);  // the misspelt key is unknown, and the right one is missing
  for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_LE(errors[i - 1].position.line, errors[i].position.line);
  for (const auto& error : errors) {
    EXPECT_GT(error.position.line, 0);
    EXPECT_GT(error.position.column, 0);
  }
}

TEST(JobFile, NegativeZeroIsZero) {
  const auto result = job::parse_job(
      replaced(file_text(kSamples + "/spur_quick.toml"), "helix_angle = 0.0", "helix_angle = -0.0"), "j.toml");
  ASSERT_TRUE(result.has_value());
  EXPECT_FALSE(std::signbit(result.value().face_gear()->zones[0].helix_angle_rad));
}

TEST(JobFile, LineEndsAndByteOrderMarkDoNotMatter) {
  const std::string text = file_text(kSamples + "/spur_quick.toml");
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_TRUE(errors_of(crlf).empty());
  EXPECT_TRUE(errors_of("\xEF\xBB\xBF" + text).empty());
  EXPECT_TRUE(errors_of(text.substr(0, text.size() - 1)).empty()) << "no line feed at the end";
}

TEST(JobFile, BytesThatAreNoJobAreRefused) {
  const std::string text = file_text(kSamples + "/spur_quick.toml");
  std::string utf16;
  for (const char c : text) utf16 += {c, '\0'};
  std::string cr = text;
  for (char& c : cr)
    if (c == '\n') c = '\r';
  for (const auto& bad : {std::string(), utf16, "\xFF\xFE" + utf16, cr, text + '\0', text + "\xFF", text + "# \xE9\n",
                          std::string(1000, '\x01')})
    EXPECT_FALSE(errors_of(bad).empty());
}

TEST(JobFile, ResourceBombsAreRefused) {
  const int deep = 100000;
  EXPECT_FALSE(errors_of("a = " + std::string(deep, '[') + std::string(deep, ']')).empty());
  std::string dotted = "a", inline_tables = "a = ";
  for (int i = 0; i < deep; ++i) dotted += ".a";
  for (int i = 0; i < deep; ++i) inline_tables += "{a=";
  EXPECT_FALSE(errors_of("[" + dotted + "]").empty());
  EXPECT_FALSE(errors_of(dotted + " = 1").empty());
  EXPECT_FALSE(errors_of(inline_tables).empty());
  EXPECT_FALSE(errors_of("a = \"\"\"\n# \"\"\"\nb.\"#\"." + dotted + " = 1").empty());
}

TEST(JobFile, FilesThatAreNoFilesAreRefused) {
  for (const char* path : {"/dev/zero", "/dev/null", "/", "/nonexistent/job.toml"}) {
    const auto result = job::read_job_file(path);
    ASSERT_FALSE(result.has_value()) << path;
  }
}

/// Any damage to a job gives a job or located findings, never anything else.
TEST(JobFile, DamagedTextGivesAJobOrFindings) {
  const std::string text = file_text(kSamples + "/dhfg_paper.toml");
  std::mt19937 random(42);
  for (int i = 0; i < 3000; ++i) {
    const auto result = job::parse_job(damaged(text, random, 1, "0123456789.-=[]\"\n"), "d.toml");
    if (const auto* errors = result.refused()) {
      ASSERT_FALSE(errors->empty());
      for (const auto& error : *errors) ASSERT_EQ(error.text().find('\n'), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace toothpath::test
