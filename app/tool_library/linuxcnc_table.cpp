// The tool table of LinuxCNC: a line a tool, words of a letter and a number, a remark behind a semicolon.
// Source: LinuxCNC, "Tool Table Format": T number, P pocket, Z length offset, D diameter, in machine units.
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "app/tool_library/formats.h"
#include "geometry/base/printable.h"

namespace toothpath::tool_library {
namespace {

struct Words {
  std::optional<double> T, P, Z, D;
};

constexpr std::string_view kLetters = "TPXYZABCUVWDIJQ";

Status read_word(std::string_view word, const SourcePosition& at, Words& words) {
  const char letter = char(std::toupper(static_cast<unsigned char>(word.front())));
  if (kLetters.find(letter) == std::string_view::npos)
    return fail_at(at, "\"{}\": a word begins with one of {}", printable(word), kLetters);
  std::string_view digits = word.substr(1);
  if (digits.starts_with('+')) digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value))
    return fail_at(at, "\"{}\": no number behind {}", printable(word), letter);
  if (letter == 'T') words.T = value;
  if (letter == 'P') words.P = value;
  if (letter == 'Z') words.Z = value;
  if (letter == 'D') words.D = value;
  return Ok{};
}

std::string trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front()))) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.remove_suffix(1);
  return std::string(text);
}

Result<std::optional<LibraryTool>> read_line(std::string_view line, const std::string& path, int number) {
  const std::size_t remark = line.find(';');
  const std::string_view code = line.substr(0, remark);
  Words words;
  SourcePosition diameter_at, length_at;
  bool any = false;
  for (std::size_t at = 0; at < code.size();) {
    if (std::isspace(static_cast<unsigned char>(code[at]))) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < code.size() && !std::isspace(static_cast<unsigned char>(code[end]))) ++end;
    const SourcePosition place{path, number, int(at) + 1};
    if (const auto read = read_word(code.substr(at, end - at), place, words); !read) return read.error();
    const char letter = char(std::toupper(static_cast<unsigned char>(code[at])));
    if (letter == 'D') diameter_at = place;
    if (letter == 'Z') length_at = place;
    any = true;
    at = end;
  }
  if (!any) return std::optional<LibraryTool>();
  if (!words.T) return fail_at({path, number, 1}, "a line of a tool table has a T word");
  if (*words.T < 1 || *words.T > 1e6 || *words.T != std::floor(*words.T))
    return fail_at({path, number, 1}, "T{}: a tool has a whole number above 0", *words.T);
  LibraryTool tool;
  tool.number = int(*words.T);
  if (remark != std::string_view::npos) tool.name = trimmed(line.substr(remark + 1));
  if (words.D && *words.D > 0) add_key(tool, "diameter", *words.D, diameter_at);
  if (words.Z && *words.Z > 0) add_key(tool, "length", *words.Z, length_at);
  else if (words.Z && *words.Z < 0)
    tool.notes.push_back("Z is negative: measured from a reference that is not the gauge line, no length");
  return std::optional(std::move(tool));
}

}  // namespace

Result<std::vector<LibraryTool>> read_linuxcnc_table(const std::string& text, const std::string& path) {
  std::vector<LibraryTool> tools;
  int number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    auto line = read_line(std::string_view(text).substr(at, end - at), path, ++number);
    if (!line) return line.error();
    if (*line) tools.push_back(std::move(**line));
    at = end + 1;
  }
  if (tools.empty()) return fail_at({path, 0, 0}, "the tool table has no tool");
  return tools;
}

}  // namespace toothpath::tool_library
