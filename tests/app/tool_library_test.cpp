// Tools out of the files of other programs: what is taken, in which unit, what is not, and what is refused where.
#include "app/tool_library/tool_library.h"

#include <gtest/gtest.h>

#include <cmath>

#include "app/job/file.h"
#include "tests/support/files.h"

namespace toothpath::tool_library {
namespace {

double number(const LibraryTool& tool, std::string_view key) {
  const toml::TomlEntry* found = nullptr;
  for (const auto& entry : tool.keys.entries)
    if (entry.key == key) found = &entry;
  return found && found->value.number() ? *found->value.number() : NAN;
}
std::string word(const LibraryTool& tool, std::string_view key) {
  const toml::TomlEntry* found = tool.keys.find(key);
  return found && found->value.text() ? *found->value.text() : "";
}

constexpr const char* kTable =
    "; the shop's tools\n"
    "T1 P1 D6.000000 Z+121.500000 ;ball nose\n"
    "\n"
    "T12 P12 X+0.1 Z-33.2 D4 ; measured to the table\r\n"
    "  t3   p7 d0.8\n";

TEST(ToolLibrary, LinuxCncTable) {
  const auto tools = read_tool_library_text(kTable, "shop.tbl");
  ASSERT_TRUE(tools) << tools.error().text();
  ASSERT_EQ(tools->size(), 3u);
  const LibraryTool& first = tools->front();
  EXPECT_EQ(first.number, 1);
  EXPECT_EQ(first.name, "ball nose");
  EXPECT_EQ(number(first, "diameter"), 6);
  EXPECT_EQ(number(first, "length"), 121.5);
  EXPECT_EQ(first.keys.find("length")->value.position.line, 2);
  EXPECT_EQ(first.keys.find("length")->value.position.column, 17);
  const LibraryTool& negative = (*tools)[1];
  EXPECT_EQ(negative.number, 12);
  EXPECT_TRUE(std::isnan(number(negative, "length"))) << "an offset to another reference is no length";
  ASSERT_EQ(negative.notes.size(), 1u);
  EXPECT_EQ((*tools)[2].number, 3);
  EXPECT_EQ(number((*tools)[2], "diameter"), 0.8);
}

TEST(ToolLibrary, DamagedTables) {
  const auto refused = [](const char* text) {
    const auto tools = read_tool_library_text(text, "t.tbl");
    return tools ? "read" : tools.error().text();
  };
  EXPECT_EQ(refused("T1 D6\nT2 D4,5\n"), "t.tbl:2:4: error: \"D4,5\": no number behind D");
  EXPECT_EQ(refused("D6 P1\n"), "t.tbl:1:1: error: a line of a tool table has a T word");
  EXPECT_EQ(refused("T0 P1\n"), "t.tbl:1:1: error: T0: a tool has a whole number above 0");
  EXPECT_EQ(refused("T1 H6\n"), "t.tbl:1:4: error: \"H6\": a word begins with one of TPXYZABCUVWDIJQ");
  EXPECT_EQ(refused("; nothing\n"), "t.tbl: error: the tool table has no tool");
  EXPECT_EQ(refused("T1 Dnan\n"), "t.tbl:1:4: error: \"Dnan\": no number behind D");
}

constexpr const char* kFusion = R"({"version": 36, "data": [
 {"type": "holder", "description": "only a holder", "unit": "millimeters", "segments": []},
 {"type": "ball end mill", "description": "6 mm ball", "unit": "millimeters", "post-process": {"number": 4},
  "geometry": {"DC": 6, "LCF": 12, "LB": 40, "OAL": 80, "SFDM": 6, "NOF": 2, "assemblyGaugeLength": 120},
  "holder": {"description": "ER16", "gaugeLength": 80, "segments": [
    {"height": 20, "lower-diameter": 24, "upper-diameter": 28}, {"height": 60, "lower-diameter": 40, "upper-diameter": 40}]},
  "shaft": {"segments": [{"height": 10, "lower-diameter": 5.8, "upper-diameter": 8}]}},
 {"type": "bull nose end mill", "description": "quarter inch", "unit": "inches", "post-process": {"number": 5},
  "geometry": {"DC": 0.25, "RE": 0.03, "LCF": 0.5, "LB": 1.5, "SFDM": 0.25, "NOF": 3},
  "holder": {"gaugeLength": 2, "segments": [{"height": 1, "lower-diameter": 1, "upper-diameter": 1}]}},
 {"type": "tapered mill", "description": "conical ball nose, 11 deg included", "unit": "inches", "post-process": {"number": 6},
  "geometry": {"DC": 0.0568, "RE": 0.03125, "TA": 5.5, "LCF": 0.8, "LB": 1.2, "SFDM": 0.25, "NOF": 2}},
 {"type": "tapered mill", "description": "rounded, no ball", "unit": "millimeters", "post-process": {"number": 7},
  "geometry": {"DC": 3, "RE": 0.5, "TA": 7, "LCF": 10, "LB": 20, "SFDM": 6, "NOF": 2}},
 {"type": "drill", "unit": "millimeters", "post-process": {"number": 8}, "geometry": {"DC": 5}}
]})";

TEST(ToolLibrary, FusionLibrary) {
  const auto tools = read_tool_library_text(kFusion, "lib.json");
  ASSERT_TRUE(tools) << tools.error().text();
  ASSERT_EQ(tools->size(), 4u) << "holders and drills are none of ours";
  const LibraryTool& ball = (*tools)[0];
  EXPECT_EQ(ball.number, 4);
  EXPECT_EQ(word(ball, "type"), "ball_end_mill");
  EXPECT_EQ(number(ball, "diameter"), 6);
  EXPECT_EQ(number(ball, "flute_length"), 12);
  EXPECT_EQ(number(ball, "stick_out"), 40);
  EXPECT_EQ(number(ball, "length"), 120);
  EXPECT_EQ(number(ball, "teeth"), 2);
  EXPECT_EQ(number(ball, "shank_diameter"), 8) << "one diameter stands for the whole shaft";
  const toml::TomlArray* holder = ball.keys.find("holder")->value.array();
  ASSERT_TRUE(holder && holder->values.size() == 2);
  EXPECT_EQ(*holder->values[0].array()->values[1].number(), 28) << "lower, upper, height";
  EXPECT_EQ(*holder->values[0].array()->values[2].number(), 20);

  const LibraryTool& bull = (*tools)[1];
  EXPECT_NEAR(number(bull, "diameter"), 6.35, 1e-12);
  EXPECT_NEAR(number(bull, "corner_radius"), 0.762, 1e-12);
  EXPECT_NEAR(number(bull, "length"), 3.5 * 25.4, 1e-9) << "gauge length of the holder and what is below it";
  EXPECT_NEAR(*bull.keys.find("holder")->value.array()->values[0].array()->values[0].number(), 25.4, 1e-12);

  const LibraryTool& cone = (*tools)[2];
  EXPECT_EQ(word(cone, "type"), "tapered_ball_end_mill");
  EXPECT_NEAR(number(cone, "diameter"), 1.5875, 1e-9) << "of the ball, not of the corner";
  EXPECT_EQ(number(cone, "half_angle"), 5.5);
  EXPECT_TRUE(std::isnan(number(cone, "length"))) << "no holder, no gauge length";

  const LibraryTool& rounded = (*tools)[3];
  EXPECT_EQ(word(rounded, "type"), "");
  EXPECT_TRUE(std::isnan(number(rounded, "diameter")));
  ASSERT_FALSE(rounded.notes.empty());
  EXPECT_NE(rounded.notes.front().find("no ball end"), std::string::npos);
}

TEST(ToolLibrary, TheAngleOfATaperedMillIsTakenOnlyWhereTheFormAgrees) {
  // The ball whose side has the half angle a meets the end plane at 2 r tan(45 - a / 2).
  for (const double angle : {3.0, 7.0, 15.0})
    for (const double r : {0.25, 0.8, 3.0}) {
      const double DC = 2 * r * std::tan((45 - angle / 2) * M_PI / 180);
      const auto read = [&](double stated) {
        return read_tool_library_text(
            fmt::format(
                R"({{"data": [{{"type": "tapered mill", "unit": "millimeters", "geometry": {{"DC": {:.4f}, "RE": {:.4f}, "TA": {}}}}}]}})",
                DC, r, stated),
            "l.json");
      };
      const auto right = read(angle), included = read(2 * angle), radians = read(angle * M_PI / 180);
      ASSERT_TRUE(right && included && radians);
      EXPECT_EQ(number(right->front(), "half_angle"), angle);
      EXPECT_NEAR(number(right->front(), "diameter"), 2 * r, 1e-4);
      EXPECT_EQ(word(included->front(), "type"), "");
      EXPECT_EQ(word(radians->front(), "type"), "");
    }
}

TEST(ToolLibrary, FreecadBitsAndLibraries) {
  const test::TestDir dir;
  std::filesystem::create_directories(dir / "Library");
  std::filesystem::create_directories(dir / "Bit");
  test::write_file(dir / "Bit/ball.fctb",
                   R"({"version": 2, "name": "6mm Ball", "shape": "ballend.fcstd", "attribute": {"Flutes": "2"},
    "parameter": {"CuttingEdgeHeight": "12.0000 mm", "Diameter": "0.25 in", "Length": "50 mm", "ShankDiameter": "6.0000 mm"}})");
  test::write_file(dir / "Bit/cone.fctb", R"({"shape": "taperedballnose.fcstd", "name": "cone",
    "parameter": {"Diameter": "2 mm", "TaperAngle": "14 deg", "CuttingEdgeHeight": "20 mm", "ShankDiameter": "6 mm"}})");
  test::write_file(dir / "Bit/drill.fctb", R"({"shape": "drill.fcstd", "parameter": {"Diameter": "2 mm"}})");
  test::write_file(
      dir / "Library/shop.fctl",
      R"({"version": 1, "tools": [{"nr": 3, "path": "ball.fctb"}, {"nr": 8, "path": "drill.fctb"}, {"nr": "9", "path": "x/cone.fctb"}]})");
  const auto tools = read_tool_library(dir / "Library/shop.fctl");
  ASSERT_TRUE(tools) << tools.error().text();
  ASSERT_EQ(tools->size(), 2u);
  EXPECT_EQ(tools->front().number, 3);
  EXPECT_NEAR(number(tools->front(), "diameter"), 6.35, 1e-12);
  EXPECT_EQ(number(tools->front(), "teeth"), 2);
  EXPECT_TRUE(std::isnan(number(tools->front(), "length"))) << "its Length is no gauge length";
  EXPECT_EQ(tools->back().number, 9);
  EXPECT_TRUE(std::isnan(number(tools->back(), "half_angle"))) << "half or included is not said";
  EXPECT_EQ(tools->back().notes.size(), 1u);

  const auto one = read_tool_library(dir / "Bit/ball.fctb");
  ASSERT_TRUE(one);
  EXPECT_TRUE(tool_of_library(*one, 77)) << "a single bit has no number";
  const auto drill = read_tool_library(dir / "Bit/drill.fctb");
  ASSERT_FALSE(drill);
  EXPECT_EQ(drill.error().message, "the tool bit is no end mill: its shape is \"drill.fcstd\"");
  test::write_file(dir / "Bit/unit.fctb", R"({"shape": "ballend.fcstd", "parameter": {"Diameter": "6 furlong"}})");
  const auto unit = read_tool_library(dir / "Bit/unit.fctb");
  ASSERT_FALSE(unit);
  EXPECT_EQ(unit.error().message, "Diameter = \"6 furlong\": no length in mm, um, cm or in");
}

TEST(ToolLibrary, WhichToolIsMeant) {
  const auto tools = read_tool_library_text(kFusion, "lib.json");
  ASSERT_TRUE(tools);
  EXPECT_EQ(tool_of_library(*tools, 5)->name, "quarter inch");
  const auto none = tool_of_library(*tools, 1);
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().message, "there is no tool 1, but 4, 5, 6, 7");
  auto twice = *tools;
  twice.push_back(twice.front());
  EXPECT_EQ(tool_of_library(twice, 4).error().message, "two tools have the number 4");
}

TEST(ToolLibrary, WhatIsNoLibraryIsRefusedWithItsPlace) {
  const auto refused = [](const char* text, const char* name) {
    const auto tools = read_tool_library_text(text, name);
    return tools ? "read" : tools.error().text();
  };
  EXPECT_EQ(refused("{\n \"data\": [,]}", "a.json"), "a.json:2:11: error: this is no JSON");
  EXPECT_EQ(refused("[]", "a.json"), "a.json:1:1: error: the outermost value is no object");
  EXPECT_EQ(refused("{}", "a.json"), "a.json: error: a tool library of Fusion has an array \"data\"");
  EXPECT_EQ(refused("{\"data\": [7, null, {\"type\": 3}]}", "a.json"),
            "a.json: error: the library has no end mill: 3 entries");
  EXPECT_EQ(refused("{\"data\": [{\"type\": \"ball end mill\", \"geometry\": {\"DC\": 5}}]}", "a.json"),
            "a.json: error: tool 0 \"\": unit = \"\" is neither \"millimeters\" nor \"inches\"");
  EXPECT_EQ(refused("", "a.toml"),
            "a.toml: error: tools are read from .tbl (LinuxCNC), .json (Fusion), .fctb or .fctl (FreeCAD); this ends "
            "with \".toml\"");
}

/// The quick sample with its tool told by a library.
class JobWithLibrary : public testing::Test {
 protected:
  job::JobOrErrors read(const std::string& tool) {
    const std::string sample = test::file_text(TOOTHPATH_SOURCE_DIR "/samples/spur_quick.toml");
    const std::size_t from = sample.find("[[tool]]"), to = sample.find("[[operation]]");
    test::write_file(dir / "job.toml",
                     sample.substr(0, from) + "[[tool]]\nnumber = 1\n" + tool + "\n" + sample.substr(to));
    return job::read_job_file(dir / "job.toml");
  }
  std::string refused(const std::string& tool) {
    const auto job = read(tool);
    if (!job.refused()) return "read";
    std::string text;
    for (const auto& error : *job.refused()) text += (text.empty() ? "" : "\n") + error.message;
    return text;
  }
  const test::TestDir dir;
};

TEST_F(JobWithLibrary, TheFileSaysWhatTheJobDoesNot) {
  test::write_file(dir / "lib.json", kFusion);
  auto job = read("library = \"lib.json\"\nlibrary_number = 4");
  ASSERT_FALSE(job.refused()) << job.refused()->front().text();
  const tool::ToolAssembly& tool = job.value().tools.front();
  EXPECT_EQ(tool.number, 1);
  EXPECT_EQ(tool.diameter_mm, 6);
  EXPECT_EQ(tool.length_mm, 120);
  EXPECT_EQ(tool.shank_diameter_mm, 8);
  ASSERT_EQ(tool.holder.size(), 2u);
  EXPECT_EQ(tool.holder[0].lower_diameter_mm, 24);
  EXPECT_EQ(tool.holder[1].height_mm, 60);
  EXPECT_TRUE(job.value().warnings.empty());
}

TEST_F(JobWithLibrary, WhatStandsInTheJobHoldsAndIsTold) {
  test::write_file(dir / "lib.json", kFusion);
  auto job = read("library = \"lib.json\"\nlibrary_number = 4\nstick_out = 38.5\nflute_length = 12");
  ASSERT_FALSE(job.refused()) << job.refused()->front().text();
  EXPECT_EQ(job.value().tools.front().stick_out_mm, 38.5);
  ASSERT_EQ(job.value().warnings.size(), 1u) << "12 mm is what the file says";
  EXPECT_NE(job.value().warnings.front().find("stick_out is taken from here; lib.json says 40"), std::string::npos)
      << job.value().warnings.front();
}

TEST_F(JobWithLibrary, WhatTheFileDoesNotSayIsAskedForByName) {
  test::write_file(dir / "shop.tbl", kTable);
  EXPECT_EQ(refused("library = \"shop.tbl\""),
            "tool 1 of shop.tbl does not say type, shank_diameter, stick_out, holder: state them here");
  EXPECT_EQ(refused("library = \"shop.tbl\"\ntype = \"ball_end_mill\"\nstick_out = 30\nshank_diameter = 6\n"
                    "holder = [[20, 20, 40]]"),
            "tool 1 of shop.tbl does not say flute_length: state it here");
  test::write_file(dir / "lib.json", kFusion);
  EXPECT_EQ(refused("library = \"lib.json\"\nlibrary_number = 6"),
            "tool 6 of lib.json does not say length, holder: state them here (no holder)");
}

TEST_F(JobWithLibrary, RefusalsHaveTheirReasonOnce) {
  EXPECT_EQ(refused("library = \"none.tbl\""), "library = \"none.tbl\": cannot open: No such file or directory");
  EXPECT_EQ(
      refused("library = \"job.toml\""),
      "library = \"job.toml\": tools are read from .tbl (LinuxCNC), .json (Fusion), .fctb or .fctl (FreeCAD); this "
      "ends with \".toml\"");
  test::write_file(dir / "shop.tbl", "T1 D6\nT2 D4,5\n");
  EXPECT_EQ(refused("library = \"shop.tbl\""), "library = \"shop.tbl\": line 2: \"D4,5\": no number behind D");
  test::write_file(dir / "shop.tbl", kTable);
  EXPECT_EQ(refused("library = \"shop.tbl\"\nlibrary_number = 2"),
            "library = \"shop.tbl\": there is no tool 2, but 1, 3, 12");
  EXPECT_NE(refused("library_number = 2").find("library_number needs library, the file with that tool"),
            std::string::npos);
}

}  // namespace
}  // namespace toothpath::tool_library
