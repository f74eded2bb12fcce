#include "app/report/page/packed_data.h"

#include <zlib.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace toothpath::page {
namespace {

constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Small differences of either sign become small numbers: 0, -1, 1, -2, ... -> 0, 1, 2, 3, ...
std::uint16_t zigzag(std::uint16_t difference) {
  const auto negative = static_cast<std::uint16_t>((difference & 0x8000U) != 0 ? 0xFFFFU : 0U);
  return static_cast<std::uint16_t>(static_cast<std::uint16_t>(difference << 1U) ^ negative);
}

std::uint16_t unzigzag(std::uint16_t code) {
  const auto negative = static_cast<std::uint16_t>((code & 1U) != 0 ? 0xFFFFU : 0U);
  return static_cast<std::uint16_t>((code >> 1U) ^ negative);
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  [[maybe_unused]] const int status = compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), 9);
  assert(status == Z_OK);  // the buffer has the size that zlib asks for
  out.resize(size);
  return out;
}

}  // namespace

PackedArray pack(std::span<const std::vector<double>> components, int steps) {
  assert(steps >= 1 && steps <= kPackedSteps);
  PackedArray packed;
  packed.steps = steps;
  packed.count = components.empty() ? 0 : components.front().size();
  const std::size_t n = packed.count;
  std::vector<std::uint8_t> bytes(components.size() * n * 2);
  for (std::size_t c = 0; c < components.size(); ++c) {
    assert(components[c].size() == n);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double v : components[c])
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
    if (low > high) low = high = 0;
    packed.low.push_back(low);
    packed.high.push_back(high);
    const double per_mm = high > low ? steps / (high - low) : 0;
    std::uint16_t previous = 0;
    std::uint8_t* const low_bytes = bytes.data() + c * n * 2;
    for (std::size_t i = 0; i < n; ++i) {
      const double v = components[c][i];
      const auto level =
          std::isfinite(v) ? static_cast<std::uint16_t>(std::lround((v - low) * per_mm)) : kPackedNothing;
      const std::uint16_t code = zigzag(static_cast<std::uint16_t>(level - previous));
      previous = level;
      low_bytes[i] = static_cast<std::uint8_t>(code & 0xFFU);
      low_bytes[n + i] = static_cast<std::uint8_t>(code >> 8U);
    }
  }
  packed.base64 = base64_encode(deflated(bytes));
  return packed;
}

std::vector<std::vector<double>> unpack(const PackedArray& packed) {
  const std::size_t n = packed.count, components = packed.low.size();
  std::vector<std::uint8_t> bytes(components * n * 2);
  const std::vector<std::uint8_t> stream = base64_decode(packed.base64);
  auto size = static_cast<uLongf>(bytes.size());
  std::vector<std::vector<double>> out(components);
  if (uncompress(bytes.data(), &size, stream.data(), static_cast<uLong>(stream.size())) != Z_OK || size != bytes.size())
    return out;
  for (std::size_t c = 0; c < components; ++c) {
    const std::uint8_t* const low_bytes = bytes.data() + c * n * 2;
    std::uint16_t level = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const auto code = static_cast<std::uint16_t>(low_bytes[i] | (low_bytes[n + i] << 8U));
      level = static_cast<std::uint16_t>(level + unzigzag(code));
      const double share = static_cast<double>(level) / packed.steps;
      out[c].push_back(level == kPackedNothing ? std::numeric_limits<double>::quiet_NaN()
                                               : packed.low[c] + share * (packed.high[c] - packed.low[c]));
    }
  }
  return out;
}

std::string base64_encode(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t rest = bytes.size() - i;
    const unsigned word = static_cast<unsigned>(bytes[i]) << 16U |
                          (rest > 1 ? static_cast<unsigned>(bytes[i + 1]) << 8U : 0U) |
                          (rest > 2 ? static_cast<unsigned>(bytes[i + 2]) : 0U);
    text += kAlphabet[word >> 18U & 63U];
    text += kAlphabet[word >> 12U & 63U];
    text += rest > 1 ? kAlphabet[word >> 6U & 63U] : '=';
    text += rest > 2 ? kAlphabet[word & 63U] : '=';
  }
  return text;
}

std::vector<std::uint8_t> base64_decode(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  unsigned word = 0;
  int bits = 0;
  for (const char c : text) {
    const std::size_t digit = kAlphabet.find(c);
    if (digit == std::string_view::npos) break;
    word = (word << 6U | static_cast<unsigned>(digit)) & 0xFFFFFFU;
    bits += 6;
    if (bits >= 8) {
      bits -= 8;
      bytes.push_back(static_cast<std::uint8_t>(word >> static_cast<unsigned>(bits) & 0xFFU));
    }
  }
  return bytes;
}

}  // namespace toothpath::page
