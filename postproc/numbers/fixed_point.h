// Numbers of NC text: integers counted in the last printed digit. No locale, no exponent, no "-0", always the same
// bytes. An integer division by 100 gives two digits at a time.
#pragma once

#include <cstdint>
#include <string>

namespace toothpath::numbers {

inline constexpr int kMaxDecimals = 9;

/// 10^decimals, 0 <= decimals <= kMaxDecimals.
[[nodiscard]] std::int64_t power_of_ten(int decimals);

/// value * 10^decimals, rounded to the nearest integer, ties away from zero.
/// @param value finite, |value| * 10^decimals < 9e15 (beyond that the digits are not there); asserted
[[nodiscard]] std::int64_t to_fixed(double value, int decimals);

/// The same rounded towards zero.
[[nodiscard]] std::int64_t to_fixed_down(double value, int decimals);

/// numerator * 10^decimals / denominator, rounded to nearest (ties away from zero), in integers throughout.
/// @param denominator > 0; |numerator| * 10^decimals < 4e18; asserted
[[nodiscard]] std::int64_t ratio_to_fixed(std::int64_t numerator, std::int64_t denominator, int decimals);

/// Appends scaled * 10^-decimals with trailing zeros removed: "12.5", "-0.0001", "3", or "3." with `point_always`.
void append_fixed(std::string& out, std::int64_t scaled, int decimals, bool point_always);

/// Appends an integer.
void append_integer(std::string& out, std::int64_t value);

}  // namespace toothpath::numbers
