#include "geometry/mesh/stl_scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

namespace toothpath::mesh {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50, kMostName = 1000;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }
bool is_line_end(char c) { return c == '\n' || c == '\r'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
/// As importers read it: no capitals; form feeds and vertical tabs are blanks.
char plain(char c) { return c == '\f' || c == '\v' ? ' ' : lower(c); }

/// A word of the file, cut short for a message and without control characters.
std::string shown(std::string_view word) {
  std::string text(word.substr(0, 30));
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text;
}

/// Words of a text STL with the line they stand in. What stands ahead of a word that does not begin a statement
/// becomes blanks in the text: importers look for it in the same line.
class Words {
 public:
  Words(std::string& text, const std::string& name) : text_(text), name_(name) {}

  std::string_view next() {
    skip_space();
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return std::string_view(text_).substr(from, at_ - from);
  }
  std::string_view next_in_statement() {
    const std::size_t from = at_;
    const std::string_view word = next();
    std::fill(text_.begin() + std::ptrdiff_t(from), text_.begin() + std::ptrdiff_t(at_ - word.size()), ' ');
    return word;
  }
  std::string_view rest_of_line() {
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
    return std::string_view(text_).substr(from, at_ - from);
  }
  template <typename... Args>
  Diagnostic refuse(fmt::format_string<Args...> text, Args&&... args) const {
    return fail_at({name_, line_, 0}, text, std::forward<Args>(args)...);
  }
  Status expect(std::string_view word) { return same(next(), word); }
  Status expect_in_statement(std::string_view word) { return same(next_in_statement(), word); }
  Status same(std::string_view found, std::string_view word) const {
    if (found == word) return Ok{};
    if (found.empty()) return refuse("the file ends where \"{}\" is expected", word);
    return refuse("\"{}\" stands where \"{}\" is expected", shown(found), word);
  }
  Status expect_number(std::size_t facet) {
    const std::string_view word = next_in_statement();
    if (word.empty()) return refuse("the file ends inside facet {}", facet);
    const std::string_view digits = word.starts_with('+') && !word.starts_with("+-") ? word.substr(1) : word;
    float value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (word.find(',') != std::string_view::npos)
      return refuse("facet {}: \"{}\" has a decimal comma", facet, shown(word));
    if (error == std::errc::result_out_of_range && std::abs(exponent_of(digits)) > 60)
      return refuse("facet {}: {} does not fit a 32-bit number", facet, shown(word));
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size())
      return refuse("facet {}: \"{}\" is not a number", facet, shown(word));
    if (!std::isfinite(value)) return refuse("facet {}: coordinate {} is not finite", facet, shown(word));
    return Ok{};
  }

 private:
  void skip_space() {
    while (at_ < text_.size() && is_space(text_[at_])) {
      const bool pair = text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n';
      if (is_line_end(text_[at_]) && !pair) ++line_;
      ++at_;
    }
  }
  static int exponent_of(std::string_view digits) {
    const std::size_t e = digits.find('e');
    int value = e == std::string_view::npos ? 99 : 0;
    if (e != std::string_view::npos) {
      const char* from = digits.data() + e + 1;
      if (e + 1 < digits.size() && *from == '+') ++from;
      if (std::from_chars(from, digits.data() + digits.size(), value).ec == std::errc::result_out_of_range) value = 99;
    }
    return value;
  }

  std::string& text_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_ = 1;
};

Status scan_facet(Words& words, std::size_t facet) {
  if (auto s = words.expect_in_statement("normal"); !s) return s;
  for (int k = 0; k < 3; ++k)
    if (auto s = words.expect_number(facet); !s) return s;
  if (auto s = words.expect("outer"); !s) return s;
  if (auto s = words.expect_in_statement("loop"); !s) return s;
  for (int corner = 0; corner < 3; ++corner) {
    if (auto s = words.expect("vertex"); !s) return s;
    for (int k = 0; k < 3; ++k)
      if (auto s = words.expect_number(facet); !s) return s;
  }
  const std::string_view end = words.next();
  if (end == "vertex") return words.refuse("facet {} has more than 3 corners", facet);
  if (end != "endloop") return words.refuse("\"{}\" stands where \"endloop\" is expected", shown(end));
  return words.expect("endfacet");
}

Result<StlScan> scan_text(std::string_view bytes, const std::string& name, std::size_t most_facets) {
  StlScan scan;
  scan.lower_case.resize(bytes.size());
  std::transform(bytes.begin(), bytes.end(), scan.lower_case.begin(), plain);
  Words words(scan.lower_case, name);
  bool inside = false;
  for (std::string_view word = words.next();; word = words.next()) {
    if (!inside) {
      if (word.empty()) break;
      if (word != "solid") return words.refuse("\"{}\" stands where \"solid\" is expected", shown(word));
      const std::size_t length = words.rest_of_line().size();
      if (length > kMostName)
        return words.refuse("the name of the solid has {} characters; the limit is {}", length, kMostName);
      inside = true;
    } else if (word == "facet") {
      if (scan.facets == most_facets) return words.refuse("more than {} facets, the limit", most_facets);
      if (auto s = scan_facet(words, scan.facets); !s) return s.error();
      ++scan.facets;
    } else if (word == "endsolid") {
      words.rest_of_line();
      inside = false;
    } else if (word.empty()) {
      return words.refuse("the file ends without \"endsolid\"");
    } else {
      return words.refuse("\"{}\" stands where \"facet\" or \"endsolid\" is expected", shown(word));
    }
  }
  return scan;
}

bool begins_as_text(std::string_view bytes) {
  const auto start = std::find_if_not(bytes.begin(), bytes.end(), is_space);
  constexpr std::string_view kSolid = "solid";
  if (std::size_t(bytes.end() - start) < kSolid.size()) return false;
  if (!std::equal(kSolid.begin(), kSolid.end(), start, [](char a, char b) { return a == lower(b); })) return false;
  const std::string_view head = bytes.substr(0, 512);
  return head.find('\0') == std::string_view::npos;
}

}  // namespace

Result<StlScan> scan_stl(std::string_view bytes, const std::string& name, std::size_t most_facets) {
  const SourcePosition at{name, 0, 0};
  if (bytes.empty()) return fail_at(at, "the file is empty");
  std::uint32_t stated = 0;
  if (bytes.size() >= kHeader) std::memcpy(&stated, bytes.data() + 80, 4);
  const std::size_t needed = kHeader + kFacet * std::size_t(stated);
  StlScan scan;
  if (bytes.size() >= kHeader && needed == bytes.size()) {
    scan.binary = true;
    scan.facets = stated;
  } else if (begins_as_text(bytes)) {
    auto text = scan_text(bytes, name, most_facets);
    if (!text) return text.error();
    scan = std::move(*text);
  } else if (bytes.size() < kHeader) {
    return fail_at(at, "{} bytes are neither a text STL nor the {} bytes of a binary header", bytes.size(), kHeader);
  } else {
    return fail_at(at, "binary STL states {} facets, which need {} bytes; the file has {}", stated, needed,
                   bytes.size());
  }
  if (scan.facets == 0) return fail_at(at, "the file has 0 facets");
  if (scan.facets > most_facets)
    return fail_at(at, "the file has {} facets; the limit is {}", scan.facets, most_facets);
  return scan;
}

}  // namespace toothpath::mesh
