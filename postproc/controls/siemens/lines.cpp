#include "postproc/controls/siemens/lines.h"

#include <algorithm>
#include <cctype>

namespace toothpath::controls {

std::string_view siemens_code(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (line[i] == ';' && !quoted) return line.substr(0, i);
  }
  return line;
}

std::string_view in_capitals(std::string_view code, std::string& room) {
  if (std::none_of(code.begin(), code.end(), [](char c) { return c >= 'a' && c <= 'z'; })) return code;
  room.assign(code);
  bool quoted = false;
  for (char& c : room) {
    if (c == '"') quoted = !quoted;
    if (!quoted && c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return room;
}

bool take_beginning(readback::NcScanner& s) {
  s.skip_blanks();
  const bool skipped = s.take("/");
  if (skipped && readback::NcScanner::is_digit(s.at())) s.advance(1);
  s.skip_blanks();
  if ((s.at() == 'N' || s.at() == ':') && readback::NcScanner::is_digit(s.ahead())) {
    s.advance(1);
    while (readback::NcScanner::is_digit(s.at())) s.advance(1);
    s.skip_blanks();
  }
  return skipped;
}

std::optional<readback::ActingComment> siemens_acting_comment(std::string_view line) {
  const std::string_view code = siemens_code(line);
  if (code.size() == line.size()) return std::nullopt;
  std::string text;
  for (const char c : line.substr(code.size() + 1))
    if (c != ' ' && c != '\t') text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (!text.starts_with("$PATH=")) return std::nullopt;
  return readback::ActingComment{static_cast<int>(code.size()) + 1,
                                 "comment ;$PATH=..: it says where the control files the text when it reads it in, and "
                                 "may so replace another program or a cycle"};
}

}  // namespace toothpath::controls
