#include "postproc/numbers/fixed_point.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstring>

namespace toothpath::numbers {
namespace {

constexpr std::array<std::int64_t, kMaxDecimals + 1> kPowers = {1,      10,      100,      1000,      10000,
                                                                100000, 1000000, 10000000, 100000000, 1000000000};

constexpr std::array<char, 200> two_digits() {
  std::array<char, 200> table{};
  for (std::size_t i = 0; i < 100; ++i) {
    table[2 * i] = static_cast<char>('0' + i / 10);
    table[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return table;
}
constexpr auto kTwoDigits = two_digits();

/// Digits of `value`, most significant first, ending before `end`; returns where they begin.
char* digits_before(char* end, std::uint64_t value) {
  while (value >= 100) {
    const auto pair = static_cast<std::size_t>(value % 100) * 2;
    value /= 100;
    *--end = kTwoDigits[pair + 1];
    *--end = kTwoDigits[pair];
  }
  if (value >= 10) {
    const auto pair = static_cast<std::size_t>(value) * 2;
    *--end = kTwoDigits[pair + 1];
    *--end = kTwoDigits[pair];
  } else {
    *--end = static_cast<char>('0' + value);
  }
  return end;
}

std::uint64_t magnitude(std::int64_t value) {
  return value < 0 ? 0 - static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
}

}  // namespace

std::int64_t power_of_ten(int decimals) {
  assert(decimals >= 0 && decimals <= kMaxDecimals);
  return kPowers[static_cast<std::size_t>(decimals)];
}

std::int64_t to_fixed(double value, int decimals) {
  const double scaled = value * static_cast<double>(power_of_ten(decimals));
  assert(std::abs(scaled) < 9e15);
  return std::llround(scaled);
}

std::int64_t to_fixed_down(double value, int decimals) {
  const double scaled = value * static_cast<double>(power_of_ten(decimals));
  assert(std::abs(scaled) < 9e15);
  return static_cast<std::int64_t>(std::trunc(scaled));
}

std::int64_t ratio_to_fixed(std::int64_t numerator, std::int64_t denominator, int decimals) {
  assert(denominator > 0);
  const std::int64_t scaled = numerator * power_of_ten(decimals);
  const std::int64_t half = denominator / 2;
  return scaled >= 0 ? (scaled + half) / denominator : -((-scaled + half) / denominator);
}

void append_fixed(std::string& out, std::int64_t scaled, int decimals, bool point_always) {
  char buffer[32];
  char* const end = buffer + sizeof buffer;
  std::uint64_t rest = magnitude(scaled);
  char* begin = end;
  const auto power = static_cast<std::uint64_t>(power_of_ten(decimals));
  std::uint64_t whole = rest / power;
  std::uint64_t fraction = rest - whole * power;
  char* stop = end;
  if (fraction != 0) {
    char* const first = end - decimals;
    begin = digits_before(end, fraction);
    while (begin > first) *--begin = '0';
    while (stop[-1] == '0') --stop;
    *--begin = '.';
  } else if (point_always) {
    *--begin = '.';
  }
  begin = digits_before(begin, whole);
  if (scaled < 0) *--begin = '-';
  out.append(begin, static_cast<std::size_t>(stop - begin));
}

void append_integer(std::string& out, std::int64_t value) { append_fixed(out, value, 0, false); }

}  // namespace toothpath::numbers
