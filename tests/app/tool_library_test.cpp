// Tools out of the files of other programs: what is taken, in which unit, what is not, and what is refused where.
#include "app/tool_library/tool_library.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
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
    "T0 P0 Z0 ; the spindle is empty\n"
    "T1 P1 D6.000000 Z+121.500000 ;ball nose\n"
    "\n"
    "T12 P12 X+0.1 Z-33.2 D4 ; measured to the table\r\n"
    "  t3   p7 d0.8\n";

/// A zip archive of these files; the checksums, which nobody reads here, are 0.
std::string zip_of(const std::vector<std::pair<std::string, std::string>>& files, bool packed) {
  const auto put = [](std::string& out, std::uint32_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) out += char(value >> (8 * k) & 0xFF);
  };
  std::string out, list;
  for (const auto& [name, text] : files) {
    std::string body = text;
    if (packed) {
      uLongf size = compressBound(uLong(text.size()));
      body.resize(size);
      compress(reinterpret_cast<Bytef*>(body.data()), &size, reinterpret_cast<const Bytef*>(text.data()),
               uLong(text.size()));
      body = body.substr(2, size - 6);  // without the head and the end that zlib puts around the deflated text
    }
    const auto head = [&](std::string& to) {
      for (const std::uint32_t v : {20u, 0u, packed ? 8u : 0u, 0u, 0u}) put(to, v, 2);
      for (const std::size_t v : {std::size_t(0), body.size(), text.size()}) put(to, std::uint32_t(v), 4);
      put(to, std::uint32_t(name.size()), 2);
      put(to, 0, 2);
    };
    const auto at = std::uint32_t(out.size());
    put(out, 0x04034b50, 4);
    head(out);
    out += name + body;
    put(list, 0x02014b50, 4);
    put(list, 20, 2);
    head(list);
    for (int k = 0; k < 3; ++k) put(list, 0, 2);
    put(list, 0, 4);
    put(list, at, 4);
    list += name;
  }
  const auto at = std::uint32_t(out.size());
  out += list;
  put(out, 0x06054b50, 4);
  for (int k = 0; k < 2; ++k) put(out, 0, 2);
  for (int k = 0; k < 2; ++k) put(out, std::uint32_t(files.size()), 2);
  put(out, std::uint32_t(list.size()), 4);
  put(out, at, 4);
  put(out, 0, 2);
  return out;
}

TEST(ToolLibrary, LinuxCncTable) {
  const auto tools = read_tool_library_text(kTable, "shop.tbl");
  ASSERT_TRUE(tools) << tools.error().text();
  ASSERT_EQ(tools->size(), 3u);
  const LibraryTool& first = tools->front();
  EXPECT_EQ(first.number, 1);
  EXPECT_EQ(first.name, "ball nose");
  EXPECT_EQ(number(first, "diameter"), 6);
  EXPECT_EQ(number(first, "length"), 121.5);
  EXPECT_EQ(first.keys.find("length")->value.position.line, 3);
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
  EXPECT_EQ(refused("T0 P1\n"), "t.tbl: error: the tool table has no tool") << "T0 is no tool";
  EXPECT_EQ(refused("T0.5 P1\n"), "t.tbl:1:1: error: T0.5: a tool has a whole number above 0");
  EXPECT_EQ(refused("T1 H6\n"), "t.tbl:1:4: error: \"H6\": a word begins with one of TPXYZABCUVWDIJQ");
  EXPECT_EQ(refused("; nothing\n"), "t.tbl: error: the tool table has no tool");
  EXPECT_EQ(refused("T1 Dnan\n"), "t.tbl:1:4: error: \"Dnan\": no number behind D");
}

constexpr const char* kFusion = R"({"version": 36, "data": [
 {"type": "holder", "description": "only a holder", "unit": "millimeters", "segments": []},
 {"type": "ball end mill", "description": "6 mm ball", "unit": "millimeters", "post-process": {"number": 4},
  "geometry": {"DC": 6, "LCF": 12, "LB": 40, "OAL": 80, "SFDM": 6, "NOF": 2, "assemblyGaugeLength": 120},
  "holder": {"description": "ER16", "unit": "millimeters", "gaugeLength": 80, "segments": [
    {"height": 20, "lower-diameter": 24, "upper-diameter": 28}, {"height": 60, "lower-diameter": 40, "upper-diameter": 40}]},
  "shaft": {"segments": [{"height": 10, "lower-diameter": 5.8, "upper-diameter": 8}]}},
 {"type": "bull nose end mill", "description": "quarter inch", "unit": "inches", "post-process": {"number": 5},
  "geometry": {"DC": 0.25, "RE": 0.03, "LCF": 0.5, "LB": 1.5, "SFDM": 0.25, "NOF": 3},
  "holder": {"unit": "inches", "gaugeLength": 2, "segments": [{"height": 1, "lower-diameter": 1, "upper-diameter": 1}]}},
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

/// Kinds that no job has are told to those who ask.
TEST(ToolLibrary, WhatIsLeftOutIsTold) {
  std::vector<tool_library::OtherTool> others;
  ASSERT_TRUE(read_tool_library_text(kFusion, "lib.json", LibraryUnit::none, &others));
  ASSERT_EQ(others.size(), 2u);
  EXPECT_EQ(others[0].kind, "holder");
  EXPECT_EQ(others[0].name, "only a holder");
  EXPECT_EQ(others[1].kind, "drill");
  EXPECT_EQ(others[1].number, 8);
}

/// A neck that reaches the holder is the shank of a [[tool]]; one that ends below it is told, and the shank holds.
TEST(ToolLibrary, TheNeckOfAFusionToolUpToItsHolderIsItsShank) {
  const auto read = [](const std::string& neck) {
    const auto tools = read_tool_library_text(R"({"data": [{"type": "ball end mill", "unit": "millimeters", "geometry":
      {"DC": 1, "LCF": 1.5, "LB": 16, "SFDM": 4)" +
                                                  neck + "}}]}",
                                              "lib.json");
    EXPECT_TRUE(tools) << tools.error().text();
    return tools->front();
  };
  EXPECT_EQ(number(read(""), "shank_diameter"), 4);
  EXPECT_EQ(number(read(R"(, "shoulder-diameter": 0.95, "shoulder-length": 16)"), "shank_diameter"), 0.95);
  const LibraryTool below = read(R"(, "shoulder-diameter": 0.95, "shoulder-length": 8)");
  EXPECT_EQ(number(below, "shank_diameter"), 4);
  ASSERT_FALSE(below.notes.empty());
  EXPECT_TRUE(below.notes.front().starts_with("its neck of 0.95 mm ends 8 mm above the tip, below the holder"))
      << below.notes.front();
  EXPECT_EQ(number(read(R"(, "shoulder-diameter": 5, "shoulder-length": 16)"), "shank_diameter"), 4) << "no neck";
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
  EXPECT_EQ(number(tools->back(), "half_angle"), 7) << "TaperAngle is the included angle";

  const auto one = read_tool_library(dir / "Bit/ball.fctb");
  ASSERT_TRUE(one);
  EXPECT_TRUE(tool_of_library(*one, 77)) << "a single bit has no number";
  const auto drill = read_tool_library(dir / "Bit/drill.fctb");
  ASSERT_FALSE(drill);
  EXPECT_EQ(drill.error().message, "the tool bit is no end mill: its shape is \"drill.fcstd\"");
  test::write_file(dir / "Bit/unit.fctb", R"({"shape": "ballend.fcstd", "parameter": {"Diameter": "6 furlong"}})");
  const auto unit = read_tool_library(dir / "Bit/unit.fctb");
  ASSERT_FALSE(unit);
  EXPECT_EQ(unit.error().message, "Diameter = \"6 furlong\": no length in mm, um, cm, m or inch");
}

TEST(ToolLibrary, AHolderHasItsOwnUnit) {
  const auto read = [](const char* holder_unit, LibraryUnit said = LibraryUnit::none) {
    return read_tool_library_text(
        fmt::format(R"({{"data": [{{"type": "ball end mill", "unit": "millimeters", "geometry": {{"DC": 0.8, "LB": 14}},
          "holder": {{{} "gaugeLength": 2.2047, "segments": [
            {{"height": 1.5748, "lower-diameter": 0.3937, "upper-diameter": 0.3937}}]}}}}]}})",
                    holder_unit),
        "l.json", said);
  };
  const auto inches = read("\"unit\": \"inches\",");
  ASSERT_TRUE(inches) << inches.error().text();
  EXPECT_NEAR(number(inches->front(), "length"), 14 + 2.2047 * 25.4, 1e-9);
  EXPECT_NEAR(*inches->front().keys.find("holder")->value.array()->values[0].array()->values[2].number(), 40, 1e-3);
  EXPECT_EQ(number(inches->front(), "diameter"), 0.8);
  for (const char* unknown : {"", "\"unit\": \"ells\","}) {
    const auto none = read(unknown);
    ASSERT_TRUE(none) << none.error().text();
    EXPECT_TRUE(std::isnan(number(none->front(), "length"))) << "nobody knows the unit of its holder";
    EXPECT_FALSE(none->front().keys.find("holder"));
    ASSERT_EQ(none->front().notes.size(), 1u);
    EXPECT_NE(none->front().notes.front().find("unit of the holder"), std::string::npos);
  }
  const auto said = read("", LibraryUnit::inch);
  ASSERT_TRUE(said);
  EXPECT_NEAR(number(said->front(), "length"), 14 + 2.2047 * 25.4, 1e-9);
  EXPECT_TRUE(said->front().takes_unit && said->front().other_unit);
  // Older libraries state it as an expression.
  const auto old =
      read_tool_library_text(R"({"data": [{"type": "ball end mill", "expressions": {"tool_unit": "'inches'"},
    "geometry": {"DC": 0.25}}]})",
                             "l.json");
  ASSERT_TRUE(old) << old.error().text();
  EXPECT_NEAR(number(old->front(), "diameter"), 6.35, 1e-12);
}

TEST(ToolLibrary, ATableSaysItsUnitByTheIniBesideItOrAsks) {
  const auto error = [](const std::string& ini, const char* table, LibraryUnit said = LibraryUnit::none) {
    const test::TestDir dir;
    if (!ini.empty()) test::write_file(dir / "shop.ini", ini);
    test::write_file(dir / "shop.tbl", table);
    const auto tools = read_tool_library(dir / "shop.tbl", said);
    return tools ? std::string() : tools.error().message;
  };
  const std::string names_it = "[EMCIO]\nTOOL_TABLE = shop.tbl\n", other = "[EMCIO]\nTOOL_TABLE = mill.tbl\n";
  constexpr const char* kOne = "T1 P1 D0.5 Z+3\n";
  for (const char* word : {"inch", "imperial", "in"})
    for (const std::string& table : {names_it, other, std::string()})
      EXPECT_NE(error(table + "[TRAJ]\n# LINEAR_UNITS = mm\nLINEAR_UNITS = " + word + "\n", kOne)
                    .find(fmt::format("shop.ini beside it says LINEAR_UNITS = {}: say library_unit", word)),
                std::string::npos)
          << word << table;
  EXPECT_EQ(error(names_it + "[TRAJ]\nLINEAR_UNITS = mm\n", "T1 P1 D0.031250 ; 1/32 ball\n"), "");
  EXPECT_EQ(error("[TRAJ]\nLINEAR_UNITS = inch\n", kOne, LibraryUnit::inch), "");
  EXPECT_EQ(error("[AXIS_X]\nLINEAR_UNITS = inch\n", kOne), "") << "another section";
  // No configuration: a table that speaks of inches itself asks.
  for (const char* inches : {"T1 D0.031496 Z+3.15\n", "T1 D0.031250\n", "T1 D0.0312\n", "T1 D0.125 Z2.9\n",
                             "T1 D0.25 ; 1/4 ball\n", "T1 D0.5 ; in inches\n", "T1 D0.5 ; 1/2\" ball\n"})
    EXPECT_NE(error("", inches).find("the table states no unit: say library_unit = \"mm\" or \"inch\""),
              std::string::npos)
        << inches << error("", inches);
  for (const char* mm : {"T1 D0.8 Z+80.123456 ; 0.8 ball\n", "T1 D3.175 Z80\n", "T1 D1.5875\n", "T1 D0.79375\n",
                         "T1 D5.9876 ; R3/2 flutes, 12/4\n"})
    EXPECT_EQ(error("", mm), "") << mm;
  const auto tools = read_tool_library_text("T1 D0.03125 Z3.15\n", "t.tbl", LibraryUnit::inch);
  ASSERT_TRUE(tools);
  EXPECT_NEAR(number(tools->front(), "diameter"), 0.79375, 1e-12);
  EXPECT_NEAR(number(tools->front(), "length"), 80.01, 1e-9);
}

TEST(ToolLibrary, FreecadQuantitiesOfAllKinds) {
  const auto bit = [](const std::string& shape, const std::string& parameters, LibraryUnit said = LibraryUnit::none) {
    return read_tool_library_text("{" + shape + ", \"parameter\": {" + parameters + "}}", "b.fctb", said);
  };
  const std::string ball = R"("shape": "ballend.fcstd")";
  struct Length {
    const char* text;
    double mm;
  };
  for (const Length& one : {Length{"0.8000 mm", 0.8},
                            {"0,8000 mm", 0.8},
                            {"0.8mm", 0.8},
                            {"1/4 in", 6.35},
                            {"1/4\\\"", 6.35},
                            {"0.25 \\\"", 6.35},
                            {"1 1/2 in", 38.1},
                            {"1' 2 1/2\\\"", 368.3},
                            {"1' + 3/8\\\"", 314.325},
                            {"800 \xC2\xB5m", 0.8},
                            {"31.25 thou", 0.79375},
                            {"8e-1 mm", 0.8}}) {
    const auto tools = bit(ball, fmt::format(R"("Diameter": "{}")", one.text));
    ASSERT_TRUE(tools) << one.text << tools.error().text();
    EXPECT_NEAR(number(tools->front(), "diameter"), one.mm, 1e-9) << one.text;
  }
  for (const char* wrong : {"", "mm", "1/0 in", "1 2 in", "6 furlong", "1/ in", "1.2.3 mm", "1/4 1/4 in", "nan mm"})
    EXPECT_FALSE(bit(ball, fmt::format(R"("Diameter": "{}")", wrong))) << wrong;
  for (const char* bare : {"\"0.25\"", "0.25"}) {
    const auto asked = bit(ball, fmt::format(R"("Diameter": {})", bare));
    ASSERT_FALSE(asked);
    EXPECT_EQ(asked.error().message, fmt::format("Diameter = \"0.25\" states no unit: {}", kUnitKey));
    const auto said = bit(ball, fmt::format(R"("Diameter": {})", bare), LibraryUnit::inch);
    ASSERT_TRUE(said);
    EXPECT_NEAR(number(said->front(), "diameter"), 6.35, 1e-12);
  }
  for (const char* shape : {R"("shape": "BallEnd.FCStd")", R"("shape": "2mm_ball.fcstd", "shape-type": "Ballend")",
                            R"("shape": "ballend.fcstd", "shape-type": "Custom")", R"("shape-type": "ballend")"}) {
    const auto tools = bit(shape, R"("Diameter": "2 mm")");
    ASSERT_TRUE(tools) << shape << tools.error().text();
    EXPECT_EQ(word(tools->front(), "type"), "ball_end_mill");
  }
  const auto drill = bit(R"("shape": "ballend.fcstd", "shape-type": "Drill")", R"("Diameter": "2 mm")");
  ASSERT_FALSE(drill);
  EXPECT_EQ(drill.error().message, "the tool bit is no end mill: its shape is \"ballend.fcstd\", its type \"Drill\"");
  const std::string cone = R"("shape": "own.fcstd", "shape-type": "TaperedBallNose")";
  for (const char* angle : {"10.00 \xC2\xB0", "10 deg", "10,00 \xC2\xB0", "0.17453292519943295 rad"})
    EXPECT_NEAR(
        number(bit(cone, fmt::format(R"("Diameter": "1 mm", "TaperAngle": "{}")", angle))->front(), "half_angle"), 5,
        1e-9)
        << angle;
  const auto bare = bit(cone, R"("Diameter": "1 mm", "TaperAngle": "10")");
  ASSERT_TRUE(bare);
  EXPECT_TRUE(std::isnan(number(bare->front(), "half_angle")));
  EXPECT_EQ(bare->front().notes.size(), 1u);
  EXPECT_EQ(number(bit(R"("shape": "torus.fcstd")", R"("TorusRadius": "1.5 mm")")->front(), "corner_radius"), 1.5);
}

TEST(ToolLibrary, AnArchiveOfFusionIsReadStoredOrPacked) {
  // kFusion in tools.json, behind another file, as zip stores and deflates it.
  for (const bool packed : {false, true}) {
    const std::string archive = zip_of({{"readme.txt", "no tools"}, {"tools.json", kFusion}}, packed);
    const auto tools = read_tool_library_text(archive, "lib.tools");
    ASSERT_TRUE(tools) << tools.error().text();
    EXPECT_EQ(tools->size(), 4u);
    EXPECT_EQ(number(tools->front(), "diameter"), 6);
    // Any part of it is refused or read, and nothing beyond its end is looked at.
    for (std::size_t size = 0; size < archive.size(); size += 7)
      (void)read_tool_library_text(archive.substr(0, size), "lib.tools");
    for (std::size_t k = 0; k < archive.size(); k += 11) {
      std::string damaged = archive;
      damaged[k] = char(damaged[k] ^ 0x5A);
      (void)read_tool_library_text(damaged, "lib.tools");
    }
  }
  EXPECT_EQ(read_tool_library_text("{}", "lib.tools").error().text(), "lib.tools: error: this is no zip archive");
  EXPECT_EQ(read_tool_library_text(zip_of({{"a.txt", ""}}, false), "lib.tools").error().text(),
            "lib.tools: error: the archive has no file that ends with \".json\"");
}

TEST(ToolLibrary, FilesInUtf16AndWithOldLineEndsAreRead) {
  const test::TestDir dir;
  std::string utf16 = "\xFF\xFE";
  for (const char* c = kTable; *c != 0; ++c) utf16 += {*c, 0};
  test::write_file(dir / "wide.tbl", utf16);
  std::string old(kTable);
  std::replace(old.begin(), old.end(), '\n', '\r');
  test::write_file(dir / "old.tbl", old);
  for (const char* name : {"wide.tbl", "old.tbl"}) {
    const auto tools = read_tool_library(dir / name);
    ASSERT_TRUE(tools) << tools.error().text();
    EXPECT_EQ(tools->size(), 3u) << name;
    EXPECT_EQ(tools->front().name, "ball nose");
  }
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
  EXPECT_EQ(
      refused("{\"data\": [{\"type\": \"ball end mill\", \"geometry\": {\"DC\": 5}}]}", "a.json"),
      "a.json: error: tool 0 \"\": unit is not there: say library_unit = \"mm\" or \"inch\" in the [[tool]] (new: "
      "--library-unit)");
  EXPECT_EQ(
      refused("{\"data\": [{\"type\": \"ball end mill\", \"unit\": \"ells\", \"geometry\": {\"DC\": 5}}]}", "a.json"),
      "a.json: error: tool 0 \"\": unit = \"ells\" is neither \"millimeters\" nor \"inches\"");
  EXPECT_EQ(refused("", "a.toml"),
            "a.toml: error: tools are read from .tbl (LinuxCNC), .json or .tools (Fusion), .fctb or .fctl (FreeCAD); "
            "this ends "
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

TEST_F(JobWithLibrary, TheUnitOfAFileIsSaidOrTold) {
  const std::string rest =
      "type = \"ball_end_mill\"\nstick_out = 30\nshank_diameter = 6\nflute_length = 8\nholder = [[20, 20, 40]]";
  test::write_file(dir / "shop.tbl", "T1 P1 D0.5 Z+3.5\n");
  auto open = read("library = \"shop.tbl\"\nlength = 88\n" + rest);
  ASSERT_FALSE(open.refused()) << open.refused()->front().text();
  ASSERT_EQ(open.value().warnings.size(), 2u) << "its length, and its unit";
  EXPECT_NE(open.value().warnings.front().find("shop.tbl states no unit, and no .ini beside it does"),
            std::string::npos);
  auto inch = read("library = \"shop.tbl\"\nlibrary_unit = \"inch\"\n" + rest);
  ASSERT_FALSE(inch.refused()) << inch.refused()->front().text();
  EXPECT_NEAR(inch.value().tools.front().diameter_mm, 12.7, 1e-12);
  EXPECT_NEAR(inch.value().tools.front().length_mm, 88.9, 1e-12);
  EXPECT_TRUE(inch.value().warnings.empty());
  test::write_file(dir / "shop.ini", "[TRAJ]\nLINEAR_UNITS = inch\n[EMCIO]\nTOOL_TABLE = shop.tbl\n");
  EXPECT_EQ(refused("library = \"shop.tbl\"\n" + rest),
            "library = \"shop.tbl\": a tool table counts in the unit of its machine, and shop.ini beside it says "
            "LINEAR_UNITS = inch: say library_unit = \"mm\" or \"inch\" in the [[tool]] (new: --library-unit)");
  test::write_file(dir / "lib.json", kFusion);
  EXPECT_EQ(refused("library = \"lib.json\"\nlibrary_number = 4\nlibrary_unit = \"inch\""),
            "library_unit: lib.json states another unit for the lengths of tool 4 itself");
  EXPECT_EQ(refused("library = \"lib.json\"\nlibrary_number = 4\nlibrary_unit = \"mm\""), "read");
  EXPECT_NE(refused("library_unit = \"mm\"").find("library_unit needs library"), std::string::npos);
}

TEST_F(JobWithLibrary, AGaugeLineWithinTheHolderIsRefused) {
  const auto tool = [&](double length, const char* holder) {
    return refused(
        fmt::format("type = \"ball_end_mill\"\ndiameter = 1\nshank_diameter = 0.9\nflute_length = 6\n"
                    "stick_out = 14\nlength = {}\nholder = {}",
                    length, holder));
  };
  constexpr const char* kFlange = "[[10, 10, 40], [46, 46, 16]]";
  for (const double length : {14.0, 16.2, 30.0, 42.0, 54.0})
    EXPECT_NE(tool(length, kFlange).find("is shorter than stick_out = 14 mm and the holder of 56 mm allow"),
              std::string::npos)
        << length << tool(length, kFlange);
  for (const double length : {55.0, 65.0, 70.0, 200.0}) EXPECT_EQ(tool(length, kFlange), "read") << length;
  EXPECT_NE(tool(33, "[[12, 30, 50]]"), "read");
  EXPECT_EQ(tool(58.2, "[[12, 30, 50]]"), "read") << "its upper end stands in the spindle";
}

TEST_F(JobWithLibrary, RefusalsHaveTheirReasonOnce) {
  EXPECT_EQ(refused("library = \"none.tbl\""), "library = \"none.tbl\": cannot open: No such file or directory");
  EXPECT_EQ(refused("library = \"job.toml\""),
            "library = \"job.toml\": tools are read from .tbl (LinuxCNC), .json or .tools (Fusion), .fctb or .fctl "
            "(FreeCAD); this "
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
