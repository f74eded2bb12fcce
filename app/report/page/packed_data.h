// Arrays inside the report page: uint16 steps of the range, differences, split bytes, deflate, base64.
//
// Only the pictures are drawn from packed arrays; every number that the page prints travels as text. A step is
// (max - min) / 65534 of the component's range, so a coordinate is off by at most half a step (0.8 um over 100 mm).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace toothpath::page {

/// Highest step; the next value up means "no value".
inline constexpr int kPackedSteps = 65534;
inline constexpr std::uint16_t kPackedNothing = 65535;

/// `components` arrays of equal length, packed. `low` and `high` give the range of each component.
struct PackedArray {
  std::size_t count = 0;
  int steps = kPackedSteps;
  std::vector<double> low, high;
  std::string base64;  ///< of a zlib stream
};

/// Packs arrays of equal length; NaN and infinities become "no value". With `steps` below kPackedSteps the values are
/// coarser and the text shorter. Layout before deflate: for each component the low bytes of the zigzag differences (mod
/// 65536), then the high bytes.
[[nodiscard]] PackedArray pack(std::span<const std::vector<double>> components, int steps = kPackedSteps);

/// The reverse of pack(), as the page's script does it; "no value" is NaN. For tests.
[[nodiscard]] std::vector<std::vector<double>> unpack(const PackedArray& packed);

[[nodiscard]] std::string base64_encode(std::span<const std::uint8_t> bytes);
/// Text made by base64_encode(); anything else ends the decoding there.
[[nodiscard]] std::vector<std::uint8_t> base64_decode(std::string_view text);

}  // namespace toothpath::page
