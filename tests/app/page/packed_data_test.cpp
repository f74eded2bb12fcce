#include "app/report/page/packed_data.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace toothpath {
namespace {

TEST(PackedData, ComesBackWithinHalfAStep) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> anywhere(-120, 120);
  for (const int steps : {1, 255, 1023, page::kPackedSteps}) {
    for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{5000}}) {
      std::vector<std::vector<double>> columns(3);
      for (auto& column : columns)
        for (std::size_t i = 0; i < n; ++i) column.push_back(anywhere(random));
      const auto back = page::unpack(page::pack(columns, steps));
      ASSERT_EQ(back.size(), 3U);
      for (std::size_t c = 0; c < 3; ++c) {
        ASSERT_EQ(back[c].size(), n);
        for (std::size_t i = 0; i < n; ++i) EXPECT_LE(std::abs(back[c][i] - columns[c][i]), 0.5000001 * 240 / steps);
      }
    }
  }
}

TEST(PackedData, WholeNumbersAreExactWithOneStepAUnit) {
  std::vector<double> column;
  for (int i = 0; i < 40000; ++i) column.push_back((i * 7919) % 32768);
  column.push_back(0);
  column.push_back(32767);
  const auto back = page::unpack(page::pack(std::span(&column, 1), 32767));
  for (std::size_t i = 0; i < column.size(); ++i) ASSERT_EQ(std::lround(back[0][i]), std::lround(column[i]));
}

TEST(PackedData, NothingStaysNothing) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const std::vector<std::vector<double>> columns = {{1, nan, 3, inf, -inf}, {nan, nan, nan, nan, nan}};
  const auto back = page::unpack(page::pack(columns));
  EXPECT_DOUBLE_EQ(back[0][0], 1);
  EXPECT_DOUBLE_EQ(back[0][2], 3);
  for (const std::size_t i : {std::size_t{1}, std::size_t{3}, std::size_t{4}}) EXPECT_TRUE(std::isnan(back[0][i]));
  for (const double v : back[1]) EXPECT_TRUE(std::isnan(v));
}

TEST(PackedData, SmoothPathsBecomeShort) {
  std::vector<std::vector<double>> columns(3);
  for (int i = 0; i < 100000; ++i) {
    const double t = i * 1e-3;
    columns[0].push_back(70 + 10 * std::sin(t)), columns[1].push_back(3 * std::cos(0.7 * t)),
        columns[2].push_back(-5 + 0.01 * t);
  }
  EXPECT_LT(page::pack(columns).base64.size(), 100000U * 2);  // float32 as base64 takes 16 bytes a point
}

TEST(PackedData, Base64AsInRfc4648) {
  const std::pair<const char*, const char*> cases[] = {{"", ""},
                                                       {"f", "Zg=="},
                                                       {"fo", "Zm8="},
                                                       {"foo", "Zm9v"},
                                                       {"foob", "Zm9vYg=="},
                                                       {"fooba", "Zm9vYmE="},
                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, text] : cases) {
    const std::string s = plain;
    const std::vector<std::uint8_t> bytes(s.begin(), s.end());
    EXPECT_EQ(page::base64_encode(bytes), text);
    EXPECT_EQ(page::base64_decode(text), bytes);
  }
}

}  // namespace
}  // namespace toothpath
