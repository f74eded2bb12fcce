#include "geometry/base/printable.h"

#include <fmt/format.h>

namespace toothpath {
namespace {

/// The character of a valid sequence.
char32_t code_point(std::string_view sequence) {
  const auto lead = static_cast<unsigned char>(sequence[0]);
  if (sequence.size() == 1) return lead;
  char32_t code = lead & (0x7FU >> sequence.size());
  for (const char c : sequence.substr(1)) code = code << 6U | (static_cast<unsigned char>(c) & 0x3FU);
  return code;
}

/// Beyond ASCII: second control set, line and paragraph separator, marks that change the direction, byte order mark.
bool hidden(char32_t code) {
  return (code >= 0x80 && code <= 0x9F) || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

/// Length of a sequence ESC [ digits and ; m at `i`, 0 where there is none.
std::size_t color_length(std::string_view text, std::size_t i) {
  if (text.substr(i, 2) != "\033[") return 0;
  const std::size_t end = text.find_first_not_of("0123456789;", i + 2);
  return end != std::string_view::npos && text[end] == 'm' ? end + 1 - i : 0;
}

std::string escaped(std::string_view text, bool lines, bool color) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    std::size_t length = color ? color_length(text, i) : 0;
    if (length > 0) {
      out += text.substr(i, length);
      i += length;
      continue;
    }
    length = utf8_length(text, i);
    if (byte == '\n') out += lines ? "\n" : "\\n";
    else if (byte == '\t') out += "\\t";
    else if (length == 0 || byte < 0x20 || byte == 0x7F) out += fmt::format("\\x{:02X}", byte);
    else if (const char32_t code = code_point(text.substr(i, length)); hidden(code))
      out += fmt::format("\\u{{{:04X}}}", static_cast<unsigned>(code));
    else out += text.substr(i, length);
    i += length == 0 ? 1 : length;
  }
  return out;
}

}  // namespace

bool is_hidden(std::string_view sequence) { return hidden(code_point(sequence)); }

std::size_t utf8_length(std::string_view s, std::size_t i) {
  const auto at = [&](std::size_t k) { return k < s.size() ? static_cast<unsigned char>(s[k]) : 0U; };
  const auto tail = [&](std::size_t k) { return (at(k) & 0xC0U) == 0x80U; };
  const unsigned a = at(i), b = at(i + 1);
  if (a < 0x80U) return 1;
  if (a >= 0xC2U && a <= 0xDFU) return tail(i + 1) ? 2 : 0;
  if (a >= 0xE0U && a <= 0xEFU) {
    if ((a == 0xE0U && b < 0xA0U) || (a == 0xEDU && b > 0x9FU)) return 0;
    return tail(i + 1) && tail(i + 2) ? 3 : 0;
  }
  if (a >= 0xF0U && a <= 0xF4U) {
    if ((a == 0xF0U && b < 0x90U) || (a == 0xF4U && b > 0x8FU)) return 0;
    return tail(i + 1) && tail(i + 2) && tail(i + 3) ? 4 : 0;
  }
  return 0;
}

std::string printable(std::string_view text) { return escaped(text, false, false); }

std::string printable_lines(std::string_view text, bool color) { return escaped(text, true, color); }

}  // namespace toothpath
