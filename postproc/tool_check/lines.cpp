#include "postproc/tool_check/lines.h"

#include <charconv>

namespace toothpath::tool_check {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\t' || s.back() == '\r')) s.remove_suffix(1);
  return s;
}

/// Characters of the number at the beginning; a point at its end belongs to it unless the template goes on with one.
std::size_t length_of_number(std::string_view s, bool point_behind) {
  std::size_t i = !s.empty() && (s[0] == '-' || s[0] == '+') ? 1 : 0;
  const std::size_t first = i;
  while (i < s.size() && is_digit(s[i])) ++i;
  const std::size_t whole = i - first;
  if (i < s.size() && s[i] == '.') {
    std::size_t end = i + 1;
    while (end < s.size() && is_digit(s[end])) ++end;
    if (end > i + 1 || (whole > 0 && !point_behind)) return end;
  }
  return whole > 0 ? i : 0;
}

}  // namespace

std::optional<std::vector<SaidNumber>> numbers_of(std::string_view pattern, std::string_view line) {
  std::vector<SaidNumber> found;
  pattern = trimmed(pattern);
  const std::string_view rest = trimmed(line);
  const auto ahead = static_cast<std::size_t>(rest.data() - line.data());
  std::size_t at = 0;
  for (std::size_t i = 0; i < pattern.size();) {
    if (pattern[i] != '{') {
      if (at >= rest.size() || rest[at++] != pattern[i++]) return std::nullopt;
      continue;
    }
    const std::size_t close = pattern.find('}', i);
    if (close == std::string_view::npos) return std::nullopt;
    const bool point = close + 1 < pattern.size() && pattern[close + 1] == '.';
    std::size_t size = length_of_number(rest.substr(at), point);
    if (size == 0) return std::nullopt;
    SaidNumber number{std::string(pattern.substr(i + 1, close - i - 1)), 0, static_cast<int>(ahead + at) + 1};
    const std::size_t sign = rest[at] == '+' ? 1 : 0;
    const char* const first = rest.data() + at + sign;
    if (std::from_chars(first, rest.data() + at + size, number.value, std::chars_format::fixed).ec != std::errc{})
      return std::nullopt;
    found.push_back(std::move(number));
    at += size;
    i = close + 1;
  }
  return at == rest.size() ? std::optional(std::move(found)) : std::nullopt;
}

std::string_view without_number(std::string_view line) {
  std::size_t i = 0;
  while (i < line.size() && is_digit(line[i])) ++i;
  return i > 0 && i < line.size() && line[i] == ' ' ? trimmed(line.substr(i)) : trimmed(line);
}

int checked_tool(std::string_view line) {
  line = without_number(line);
  if (line.empty() || (line.front() != '(' && line.front() != ';')) return -1;
  line = trimmed(line.substr(1));
  constexpr std::string_view words = "TOOL CHECK T";
  if (!line.starts_with(words)) return -1;
  int n = -1;
  const char* const first = line.data() + words.size();
  return std::from_chars(first, line.data() + line.size(), n).ec == std::errc{} ? n : -1;
}

}  // namespace toothpath::tool_check
