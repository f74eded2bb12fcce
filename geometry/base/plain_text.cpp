#include "geometry/base/plain_text.h"

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace toothpath {
namespace {

void add_utf8(std::string& out, std::uint32_t c) {
  const auto tail = [&](int shift) { out += char(0x80 | ((c >> shift) & 0x3F)); };
  if (c < 0x80) {
    out += char(c);
  } else if (c < 0x800) {
    out += char(0xC0 | (c >> 6));
    tail(0);
  } else if (c < 0x10000) {
    out += char(0xE0 | (c >> 12));
    tail(6), tail(0);
  } else {
    out += char(0xF0 | (c >> 18));
    tail(12), tail(6), tail(0);
  }
}

/// @param low  the first byte of a unit is its low one
Result<std::string> from_utf16(std::string_view bytes, bool low, const std::string& file) {
  const auto unit = [&](std::size_t i) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    return std::uint32_t(low ? a | b << 8 : a << 8 | b);
  };
  std::string out;
  int line = 1;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    if (i + 1 == bytes.size()) return fail_at({file, line, 1}, "this is UTF-16 that ends within a character");
    std::uint32_t c = unit(i);
    if (c >= 0xD800 && c < 0xE000) {
      const bool pair = c < 0xDC00 && i + 3 < bytes.size() && unit(i + 2) >= 0xDC00 && unit(i + 2) < 0xE000;
      if (!pair) return fail_at({file, line, 1}, "this is UTF-16 with half a character");
      c = 0x10000 + ((c - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
      i += 2;
    }
    line += c == '\n';
    add_utf8(out, c);
  }
  return out;
}

}  // namespace

Result<std::string> plain_text(std::string bytes, const std::string& file) {
  const auto begins = [&](std::string_view with) { return std::string_view(bytes).starts_with(with); };
  const bool zero_second = bytes.size() >= 2 && bytes[0] != 0 && bytes[1] == 0,
             zero_first = bytes.size() >= 2 && bytes[0] == 0 && bytes[1] != 0;
  const bool low = begins("\xFF\xFE"), high = begins("\xFE\xFF");
  if (low || high || zero_first || zero_second) {
    auto text = from_utf16(std::string_view(bytes).substr(low || high ? 2 : 0), low || zero_second, file);
    if (!text) return text.error();
    bytes = std::move(*text);
  }
  const std::string_view mark = "\xEF\xBB\xBF";  // of the byte order, in UTF-8: files that were joined have some inside
  std::size_t to = 0;
  for (std::size_t from = 0; from < bytes.size(); ++from) {
    if (bytes[from] == '\r') {
      bytes[to++] = '\n';
      from += from + 1 < bytes.size() && bytes[from + 1] == '\n';
    } else if (std::string_view(bytes).substr(from, mark.size()) == mark) {
      from += mark.size() - 1;
    } else {
      bytes[to++] = bytes[from];
    }
  }
  bytes.resize(to);
  return bytes;
}

}  // namespace toothpath
