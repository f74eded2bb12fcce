#include "postproc/controls/heidenhain/lines.h"

#include <algorithm>

namespace toothpath::controls {
namespace {

std::string_view trimmed(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

bool goes_on(std::string_view line) {
  if (line.find('~') == std::string_view::npos) return false;
  return heidenhain_code(line).ends_with("~");
}

}  // namespace

std::string_view heidenhain_code(std::string_view line) {
  const std::size_t comment = line.find(';');
  if (comment == std::string_view::npos) return line;
  const std::string_view code = line.substr(0, line.find_last_not_of(" \t", comment - 1) + 1);
  const bool block = comment > 0 && code.find_first_not_of("0123456789 \t") != std::string_view::npos;
  return block ? code : line;
}

std::optional<readback::ActingComment> heidenhain_acting_comment(std::string_view line) {
  const std::size_t last = line.find_last_not_of(" \t\r");
  if (last == std::string_view::npos || line[last] != '~') return std::nullopt;
  const std::size_t word = line.find_first_not_of("0123456789 \t"), begin = line[word] == '*' ? word : line.find(';');
  if (begin == std::string_view::npos) return std::nullopt;
  return readback::ActingComment{static_cast<int>(begin) + 1,
                                 "comment that ends with ~: the control takes the next line for a part of this block"};
}

JoinedLines join_lines(std::vector<std::string_view>& lines) {
  JoinedLines out;
  if (std::none_of(lines.begin(), lines.end(), goes_on)) return out;
  std::vector<std::string_view> joined;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    out.numbers.push_back(static_cast<std::int32_t>(i) + 1);
    if (!goes_on(lines[i])) {
      joined.push_back(lines[i]);
      continue;
    }
    std::string text;
    for (bool more = true; more && i < lines.size(); ++i) {
      more = goes_on(lines[i]);
      std::string_view part = heidenhain_code(lines[i]);
      if (more) part.remove_suffix(1);
      text += (text.empty() ? "" : " ") + std::string(trimmed(part));
    }
    --i;
    joined.push_back(out.texts.emplace_back(std::move(text)));
  }
  lines = std::move(joined);
  return out;
}

}  // namespace toothpath::controls
