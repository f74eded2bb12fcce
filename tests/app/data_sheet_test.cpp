// data_sheet.html of every gear type: what stands there against printed values and against limits.json of the same run.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

struct SheetOfSample {
  std::string page;
  nlohmann::json limits;
  /// Value of the first row of a quantity, without its unit.
  [[nodiscard]] std::string value(const std::string& quantity) const {
    std::smatch found;
    const std::regex row(fmt::format("<td>{}</td><td[^>]*>([^<]*)</td>", quantity));
    return std::regex_search(page, found, row) ? found[1].str() : "no row";
  }
  [[nodiscard]] double number(const std::string& quantity) const {
    const std::string text = value(quantity);
    return text == "no row" ? NAN : std::stod(text);
  }
};

SheetOfSample sheet_of(const std::string& sample) {
  const TestDir dir;
  const auto run = run_program({"surface", TOOTHPATH_SOURCE_DIR "/samples/" + sample + ".toml", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return {file_text(dir / "out/data_sheet.html"), nlohmann::json::parse(file_text(dir / "out/limits.json"))};
}

// KHK 20/40, module 3: the blank as its catalogue prints it.
TEST(DataSheet, OfAStraightBevelGearHasThePrintedBlank) {
  const SheetOfSample sheet = sheet_of("straight_bevel");
  EXPECT_EQ(sheet.value("outside diameter"), "67.2180 mm");
  EXPECT_EQ(sheet.value("outside diameter at the small end"), "44.8425 mm");
  EXPECT_EQ(sheet.value("pitch apex to crown, along the axis"), "58.1955 mm");
  EXPECT_EQ(sheet.value("face width along the axis, crown to front crown"), "19.0029 mm");
  EXPECT_EQ(sheet.value("root angle"), "24.40602 deg");
  EXPECT_EQ(sheet.value("face angle"), "30.48699 deg");
}

TEST(DataSheet, OfCylindricalGearsHasWhatTheGearIs) {
  const SheetOfSample spur = sheet_of("cylindrical_spur");
  for (const auto& [quantity, key] : {std::pair{"reference diameter", "reference_diameter"},
                                      {"base diameter", "base_diameter"},
                                      {"tip diameter", "tip_diameter"},
                                      {"root diameter", "root_diameter"}})
    EXPECT_NEAR(spur.number(quantity), spur.limits.at(key).get<double>(), 6e-5) << quantity;
  // W_k = m cos(alpha) (pi (k - 1/2) + z inv(alpha)) + 2 x m sin(alpha): z 24, m 3, 20 deg, x 0.2.
  const double alpha = std::acos(-1.0) / 9, k = spur.number("teeth spanned");
  EXPECT_NEAR(
      spur.number("base tangent length over k teeth"),
      3 * std::cos(alpha) * (std::acos(-1.0) * (k - 0.5) + 24 * (std::tan(alpha) - alpha)) + 1.2 * std::sin(alpha),
      6e-5);
  EXPECT_GT(spur.number("dimension over two balls"), spur.number("tip diameter"));
  // A face that is too narrow for its span is told.
  EXPECT_NE(sheet_of("cylindrical_pinion").page.find("the face is too narrow: 60.1543 mm need a face of 28.6858 mm"),
            std::string::npos);
}

TEST(DataSheet, OfEveryTypeHasThicknessAndABall) {
  for (const char* sample : {"spiral_bevel", "flank_grid_spur", "dhfg_t600s", "offset_milled", "bevel_pinion",
                             "bevel_ball", "spur_modified"}) {
    const SheetOfSample sheet = sheet_of(sample);
    EXPECT_GT(sheet.number("number of teeth"), 9) << sample;
    EXPECT_GT(sheet.number("chordal tooth thickness, normal"), 0) << sample;
    EXPECT_LE(sheet.number("chordal tooth thickness, normal"), sheet.number("tooth thickness on the arc, transverse"))
        << sample;
    EXPECT_GT(sheet.number("diameter of the measuring ball"), 0) << sample;
    EXPECT_EQ(sheet.page.find("nan"), std::string::npos) << sample;
  }
  EXPECT_NE(sheet_of("spur_modified").page.find("The flanks are modified (3)"), std::string::npos);
  EXPECT_EQ(sheet_of("spur_quick").page.find("modified"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
