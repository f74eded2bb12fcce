// Points of flanks as spreadsheets save them, and what is refused with its line and column.
#include "app/job/flank_points.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/files.h"

namespace toothpath::test {
namespace {

std::string plain(bool normals) {
  std::string text = normals ? "flank,row,column,x,y,z,i,j,k\n" : "flank,row,column,x,y,z\n";
  for (const int side : {1, -1})
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 5; ++column)
        text += fmt::format("{},{},{},{},{},{}{}\n", side, row, column, 30.125 + row, -1.5 * side, 0.25 * column,
                            normals ? fmt::format(",0.0,{}.0,0.0", side) : "");
  return text;
}

TEST(FlankPoints, AreReadAsSpreadsheetsSaveThem) {
  for (const bool normals : {true, false}) {
    const auto good = job::parse_flank_points(plain(normals), "p.csv");
    ASSERT_TRUE(good) << good.error().text();
    EXPECT_EQ(good->plus.rows, 4);
    EXPECT_EQ(good->minus.columns, 5);
    EXPECT_EQ(good->minus.normal.size(), normals ? 20u : 0u);
    EXPECT_EQ(good->minus.place[good->minus.index(2, 3)], Vec3(32.125, 1.5, 0.75));
    EXPECT_EQ(good->plus.line[0], 2);
    const auto saved = [&](const std::string& separator, bool commas, bool quotes) {
      std::string out = quotes ? "\"" : "";
      for (const char letter : plain(normals))
        if (letter == ',') out += quotes ? "\"" + separator + "\"" : separator;
        else if (letter == '\n') out += quotes ? "\"\n\"" : "\n";
        else out += letter == '.' && commas ? ',' : letter;
      return quotes ? out.substr(0, out.size() - 1) : out;
    };
    for (const std::string& text :
         {saved(";", true, false), saved(";", true, true), saved("\t", false, false), saved(" ", false, true),
          saved(",", true, true), "sep=;\n" + saved(";", true, false), saved(";", false, false) + ";;;;;\n",
          replaced_all(plain(normals), "\n", ",,,\n")}) {
      const auto read = job::parse_flank_points(text, "p.csv");
      ASSERT_TRUE(read) << text.substr(0, 60) << read.error().text();
      EXPECT_EQ(read->plus.place, good->plus.place);
      EXPECT_EQ(read->minus.normal, good->minus.normal);
    }
  }
}

TEST(FlankPoints, FaultsStandAtTheirPlace) {
  const auto changed = [](const std::string& what, const std::string& by) {
    std::string text = plain(false);
    return text.replace(text.find(what), what.size(), by);
  };
  const std::pair<std::string, const char*> cases[] = {
      {"", "p.csv:1:1: error: flank 1 has no point"},
      {changed("flank,row", "side,row"), "p.csv:1:1: error: the header is \"side,row"},
      {changed("1,0,1,30.125", "1,0,1,thirty"), "p.csv:3:7: error: x = \"thirty\" is no finite number"},
      {changed("1,0,1,30.125", "1,0,1,nan"), "p.csv:3:7: error: x = \"nan\" is no finite number"},
      {changed("1,0,1,30.125", "2,0,1,30.125"), "p.csv:3:1: error: flank = 2 must be 1 or -1"},
      {changed("1,0,1,30.125", "1,0.5,1,30.125"), "p.csv:3:3: error: row = 0.5 is no whole number"},
      {changed("1,0,1,30.125", "1,0,1000,30.125"), "p.csv:3:5: error: column = 1000 is no whole number"},
      {changed("1,0,1,30.125", "1,0,30.125"), "p.csv:3:1: error: 5 columns, must be 6"},
      {changed("1,0,1,30.125", "1,0,0,30.125"), "p.csv:3:1: error: flank 1, row 0, column 0 stands in line 2 already"},
      {changed("1,0,1,30.125,-1.5,0.25\n", ""), "flank 1, row 0, column 1 is missing of 4 rows x 5 columns"},
  };
  for (const auto& [text, message] : cases) {
    const auto read = job::parse_flank_points(text, "p.csv");
    ASSERT_FALSE(read) << message;
    EXPECT_NE(read.error().text().find(message), std::string::npos) << read.error().text();
  }
}

}  // namespace
}  // namespace toothpath::test
