#include "app/report/svg/plot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "app/report/svg/canvas.h"
#include "app/report/svg/contact_pattern.h"
#include "app/report/svg/turned_text.h"

namespace toothpath {
namespace {

/// Greatest height of any point of the curves above the bottom of the view box, read from the path data.
std::pair<double, double> vertical_extent(const std::string& svg) {
  double low = 1e9, high = -1e9;
  const std::regex curve("<path d=\"([^\"]*)\""), pair("[ML]([-0-9.]+) ([-0-9.]+)");
  for (std::sregex_iterator c(svg.begin(), svg.end(), curve), end; c != end; ++c) {
    const std::string d = (*c)[1];
    for (std::sregex_iterator p(d.begin(), d.end(), pair); p != end; ++p) {
      const double y = std::stod((*p)[2]);
      low = std::min(low, y), high = std::max(high, y);
    }
  }
  return {low, high};
}

TEST(SvgPlot, TicksAreRoundAndInside) {
  for (const auto& [low, high] : {std::pair{0.0, 1.0}, std::pair{-3.7, 18.2}, std::pair{1e-7, 3e-7},
                                  std::pair{999.2, 1003.9}, std::pair{-5e6, 2e6}}) {
    const auto ticks = svg::nice_ticks(low, high, 5);
    ASSERT_GE(ticks.size(), 2U);
    ASSERT_LE(ticks.size(), 11U);
    for (const double t : ticks) EXPECT_TRUE(t >= low - 1e-9 * (high - low) && t <= high + 1e-9 * (high - low));
    const double step = ticks[1] - ticks[0], digit = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-6 || std::abs(digit - 2) < 1e-6 || std::abs(digit - 5) < 1e-6) << step;
  }
  EXPECT_TRUE(svg::nice_ticks(1, 1, 5).empty());
}

TEST(SvgPlot, FarTurnsAreToldApart) {
  EXPECT_EQ(svg::turned_text(-127440.74), "-0.740 (-354 turns)");
  EXPECT_EQ(svg::turned_text(725, 1), "5.0 (+2 turns)");
  EXPECT_EQ(svg::turned_text(-372.5), "-372.500");
}

TEST(SvgPlot, ALogarithmicScaleTurnsRatiosIntoLengths) {
  const svg::Scale s{0.01, 100, 0, 400, true};
  EXPECT_NEAR(s(0.1) - s(0.01), 100, 1e-9);
  EXPECT_NEAR(s(100) - s(10), 100, 1e-9);
}

// One sample in a hundred thousand is a peak: thinning must not lose it.
TEST(SvgPlot, ThinningKeepsEveryPeak) {
  for (const std::size_t place : {std::size_t{1}, std::size_t{4711}, std::size_t{50000}, std::size_t{99998}}) {
    svg::LineChart chart{"t", "time [s]", "v", {{"v", {}, {}}}, {}, false, false, false, ""};
    for (std::size_t i = 0; i < 100000; ++i) {
      chart.series[0].x.push_back(static_cast<double>(i));
      chart.series[0].y.push_back(i == place ? 10 : 0);
    }
    const std::string svg = svg::svg_line_chart(chart);
    EXPECT_LT(svg.size(), 40000U);
    const auto [low, high] = vertical_extent(svg);
    EXPECT_GT(high - low, 150) << place;  // the peak spans most of the 200 px of the plot
  }
}

TEST(SvgPlot, NothingToDrawIsEmpty) {
  EXPECT_TRUE(svg::svg_line_chart({}).empty());
  svg::LineChart chart{"t", "x", "y", {{"a", {1, 2}, {-1, std::nan("")}}}, {}, true, true, false, ""};
  EXPECT_TRUE(svg::svg_line_chart(chart).empty());
  EXPECT_TRUE(svg::svg_histogram({}).empty());
  EXPECT_TRUE(svg::svg_paired_bars({}).empty());
  EXPECT_TRUE(svg::svg_direction_map({}).empty());
  EXPECT_TRUE(svg::svg_bars({}, "s").empty());
}

TEST(SvgPlot, NoNumberIsNan) {
  svg::LineChart chart{"t",
                       "x",
                       "y",
                       {{"a", {0, 1, 2, 3}, {1, std::nan(""), 1e308, -1e308}}, {"b", {1}, {1}}},
                       {{"l", std::nan("")}},
                       false,
                       false,
                       true,
                       ""};
  svg::PairedBarChart bars{"t", "x", "p", "m", {{"a", 0, 0}, {"b", -1, std::nan("")}}};
  for (const std::string& svg :
       {svg::svg_line_chart(chart), svg::svg_paired_bars(bars), svg::svg_bars({{"a", std::nan("")}, {"b", 0}}, "s")}) {
    EXPECT_FALSE(svg.empty());
    EXPECT_EQ(svg.find("\"nan"), std::string::npos);
    EXPECT_EQ(svg.find("\"-nan"), std::string::npos);
    EXPECT_EQ(svg.find("inf\""), std::string::npos);
  }
}

/// The words for the colours of a flank field are those of its fills.
TEST(SvgPlot, ColoursOfAFlankFieldAreThoseOfItsWords) {
  for (const double value : {1.0, -1.0}) {
    const svg::FlankFieldDrawing field{
        "f", "x", "y", "um", 2, 2, {0, 1, 0, 1}, {0, 0, 1, 1}, std::vector<double>(4, value), 1};
    const std::string svg = svg::svg_flank_field(field);
    // Behind the key: one cell, the largest path.
    const auto at = svg.rfind("fill=\"#");
    ASSERT_NE(at, std::string::npos);
    const int rgb = std::stoi(svg.substr(at + 7, 6), nullptr, 16), red = rgb >> 16, blue = rgb & 255;
    const std::string word = value > 0 ? svg::kAboveZero : svg::kBelowZero;
    EXPECT_EQ(word, red > blue ? "red" : "blue") << svg;
    EXPECT_GT(std::abs(red - blue), 50);
  }
}

TEST(SvgPlot, NamesAreEscaped) {
  svg::LineChart chart{"<t>", "x<", "y&", {{"<a>", {0, 1}, {0, 1}}, {"b", {0, 1}, {1, 0}}}, {}, false, false, true, ""};
  const std::string svg = svg::svg_line_chart(chart);
  EXPECT_EQ(svg.find("<a>"), std::string::npos);
  EXPECT_NE(svg.find("&lt;a&gt;"), std::string::npos);
}

}  // namespace
}  // namespace toothpath
