#include "postproc/numbers/fixed_point.h"

#include <gtest/gtest.h>

#include <charconv>
#include <clocale>
#include <cmath>
#include <random>

namespace toothpath {
namespace {

std::string printed(std::int64_t scaled, int decimals, bool point = false) {
  std::string s;
  numbers::append_fixed(s, scaled, decimals, point);
  return s;
}

/// The exact decimal by to_chars from the integer's digits: no floating point in between.
std::string by_to_chars(std::int64_t scaled, int decimals) {
  char buffer[40];
  const bool negative = scaled < 0;
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, negative ? -scaled : scaled).ptr;
  std::string digits(buffer, end);
  while (static_cast<int>(digits.size()) <= decimals) digits.insert(digits.begin(), '0');
  std::string whole = digits.substr(0, digits.size() - static_cast<std::size_t>(decimals)),
              part = digits.substr(whole.size());
  while (!part.empty() && part.back() == '0') part.pop_back();
  return (negative ? "-" : "") + whole + (part.empty() ? "" : "." + part);
}

TEST(FixedPoint, EqualsToCharsOnAMillionValues) {
  std::mt19937_64 random(20260801);
  std::uniform_int_distribution<int> decimals(0, 7), bits(1, 52);
  for (int i = 0; i < 1'000'000; ++i) {
    const int d = decimals(random);
    const auto magnitude = static_cast<std::int64_t>(random() & ((std::uint64_t{1} << bits(random)) - 1));
    const std::int64_t v = (i & 1) != 0 ? magnitude : -magnitude;
    ASSERT_EQ(printed(v, d), by_to_chars(v, d)) << v << " with " << d;
  }
}

TEST(FixedPoint, ReadsBackWithinHalfADigit) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> value(-1000, 1000);
  for (int i = 0; i < 200'000; ++i) {
    const double v = value(random);
    const std::string s = printed(numbers::to_fixed(v, 4), 4);
    double back = 0;
    std::from_chars(s.data(), s.data() + s.size(), back);
    ASSERT_LE(std::abs(back - v), 0.5e-4 * (1 + 1e-9)) << s;
    const std::string down = printed(numbers::to_fixed_down(std::abs(v), 3), 3);
    std::from_chars(down.data(), down.data() + down.size(), back);
    ASSERT_LE(back, std::abs(v));
    ASSERT_GT(back, std::abs(v) - 1e-3);
  }
}

TEST(FixedPoint, MinusZeroPointAndExtremes) {
  EXPECT_EQ(printed(numbers::to_fixed(-0.0, 4), 4), "0");
  EXPECT_EQ(printed(numbers::to_fixed(-0.00004, 4), 4), "0");
  EXPECT_EQ(printed(0, 3, true), "0.");
  EXPECT_EQ(printed(10000, 3, true), "10.");
  EXPECT_EQ(printed(-1, 4), "-0.0001");
  EXPECT_EQ(printed(1, 7), "0.0000001");
  EXPECT_EQ(printed(INT64_MIN, 0), "-9223372036854775808");
}

// Index angles come from integers: the error never grows with the tooth.
TEST(FixedPoint, IndexAnglesOfPrimeToothNumbers) {
  for (const int z : {7, 89, 180, 997})
    for (int k = -z; k <= z; ++k) {
      const std::int64_t word = numbers::ratio_to_fixed(std::int64_t{360} * k, z, 5);
      // |word / 1e5 - 360 k / z| <= 0.5e-5, in integers.
      ASSERT_LE(std::abs(2 * (word * z - std::int64_t{360} * k * 100000)), z) << z << " " << k;
    }
}

TEST(FixedPoint, DoesNotReadTheLocale) {
  const char* old = std::setlocale(LC_ALL, nullptr);
  const std::string saved = old != nullptr ? old : "C";
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    std::setlocale(LC_ALL, name);
    EXPECT_EQ(printed(123456, 4), "12.3456");
  }
  std::setlocale(LC_ALL, saved.c_str());
}

}  // namespace
}  // namespace toothpath
