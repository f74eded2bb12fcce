#include "postproc/nc_lines.h"

#include "postproc/fixed_point.h"

namespace toothpath {

std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t h = 14695981039346656037ULL;
  for (const char c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return h;
}

void NcLines::line(std::string_view text) {
  text_ += text;
  end_line(text_.size() - text.size(), true);
}

void NcLines::comment(std::string_view text) {
  const std::size_t begin = text_.size();
  text_ += dialect_.comment_open;
  text_ += text.substr(0, dialect_.max_line - dialect_.comment_open.size() - dialect_.comment_close.size());
  text_ += dialect_.comment_close;
  end_line(begin, false);
}

void NcLines::fill(const NcLinesOfText& templates, const Values& values) {
  for (const std::string& pattern : templates) {
    const std::size_t begin = text_.size();
    for (std::size_t i = 0; i < pattern.size();) {
      const std::size_t open = pattern.find('{', i);
      if (open == std::string::npos) {
        text_.append(pattern, i);
        break;
      }
      text_.append(pattern, i, open - i);
      const std::size_t close = pattern.find('}', open);
      const std::string_view name =
          close == std::string::npos ? std::string_view() : std::string_view(pattern).substr(open + 1, close - open - 1);
      const auto found = values.find(name);
      if (found == values.end()) {
        if (!error_) error_ = fail("dialect {}: \"{}\" names a value that does not exist here", dialect_.name, pattern);
        return;
      }
      text_ += found->second;
      i = close + 1;
    }
    end_line(begin, true);
  }
}

void NcLines::end_line(std::size_t begin, bool block) {
  if (text_.size() - begin > dialect_.max_line && !error_)
    error_ = fail("block of {} characters exceeds {}, the longest line of {}", text_.size() - begin, dialect_.max_line,
                  dialect_.name);
  text_ += '\n';
  if (block) ++blocks_;
}

void NcLines::number(std::int64_t scaled, int decimals) {
  if (dialect_.sign_always && scaled >= 0) text_ += '+';
  append_fixed(text_, scaled, decimals, dialect_.point_always);
}

std::string NcLines::value(std::int64_t scaled, int decimals) const {
  std::string s;
  if (dialect_.sign_always && scaled >= 0) s += '+';
  append_fixed(s, scaled, decimals, dialect_.point_always);
  return s;
}

std::string NcLines::numbered(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  std::int64_t n = 0;
  for (std::size_t begin = 0; begin < text.size(); ++n) {
    std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) end = text.size() - 1;
    append_integer(out, n);
    out += ' ';
    out += text.substr(begin, end + 1 - begin);
    begin = end + 1;
  }
  return out;
}

}  // namespace toothpath
