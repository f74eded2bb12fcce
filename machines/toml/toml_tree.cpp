#include "machines/toml/toml_tree.h"

#include <algorithm>
#include <limits>

#include <toml++/toml.h>

namespace toothpath::toml {
namespace {

/// Looks for what could make the parser or its tree recurse without bound: brackets in brackets, keys of many parts.
/// Whatever else is wrong with the text is left to the parser.
class DepthCheck {
 public:
  DepthCheck(std::string_view text, const std::string& file, const TomlSyntax& syntax)
      : text_(text), file_(file), syntax_(syntax) {}

  Status run() {
    for (at_ = 0; at_ < text_.size(); ++at_, ++column_) {
      if (text_[at_] == '\n') new_line();
      else if (auto s = letter(text_[at_]); !s) return s;
    }
    return Ok{};
  }

 private:
  [[nodiscard]] SourcePosition here() const { return {file_, line_, column_}; }
  [[nodiscard]] bool three(char quote) const { return text_.substr(at_, 3) == std::string(3, quote); }
  void skip(std::size_t letters) {
    at_ += letters;
    column_ += static_cast<int>(letters);
  }
  void new_line() {
    ++line_;
    column_ = dots_ = 0;
    comment_ = false;
    if (!long_string_) quote_ = 0;
  }

  Status letter(char c) {
    if (c == '\r' && syntax_.one_line_strings && text_.substr(at_ + 1, 1) != "\n")
      return fail_at(here(), "a carriage return without a line feed");
    if (comment_) return Ok{};
    if (quote_ != 0) in_string(c);
    else return outside(c);
    return Ok{};
  }
  void in_string(char c) {
    if (quote_ == '"' && c == '\\') {
      if (text_.substr(at_ + 1, 1) != "\n") skip(1);
    } else if (c == quote_ && !long_string_) {
      quote_ = 0;
    } else if (c == quote_ && three(c)) {
      skip(2);
      while (text_.substr(at_ + 1, 1) == std::string(1, c)) skip(1);  // quotes at the end of the string
      quote_ = 0;
    }
  }
  Status outside(char c) {
    switch (c) {
      case '#': comment_ = true; break;
      case '"':
      case '\'':
        long_string_ = three(c);
        if (long_string_ && syntax_.one_line_strings)
          return fail_at(here(), "multi-line strings are not part of this format");
        quote_ = c;
        if (long_string_) skip(2);
        break;
      case '[':
      case '{':
        if (++depth_ > syntax_.max_nesting)
          return fail_at(here(), "brackets are nested deeper than {}", syntax_.max_nesting);
        dots_ = 0;
        break;
      case ']':
      case '}':
        depth_ = std::max(0, depth_ - 1);
        dots_ = 0;
        break;
      case ',':
      case '=': dots_ = 0; break;
      case '.':
        if (++dots_ >= syntax_.max_nesting) return fail_at(here(), "a key has more than {} parts", syntax_.max_nesting);
        break;
      default: break;
    }
    return Ok{};
  }

  std::string_view text_;
  const std::string& file_;
  const TomlSyntax& syntax_;
  std::size_t at_ = 0;
  int line_ = 1, column_ = 1, depth_ = 0, dots_ = 0;
  char quote_ = 0;
  bool long_string_ = false, comment_ = false;
};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The library would name a NUL byte as a character of TOML that is not allowed; what it means is that the file is no
/// text.
Status check_nul(std::string_view text, const std::string& file) {
  const auto nul = text.find('\0');
  if (nul == std::string_view::npos) return Ok{};
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(nul), '\n');
  const auto line_start = text.rfind('\n', nul);
  const auto column = line_start == std::string_view::npos ? nul + 1 : nul - line_start;
  return fail_at({file, static_cast<int>(line), static_cast<int>(column)}, "NUL byte; this is not a text file");
}

/// Saved by an editor of Windows as what it calls Unicode.
Status check_utf16(std::string_view text, const std::string& file) {
  if (!text.starts_with("\xff\xfe") && !text.starts_with("\xfe\xff")) return Ok{};
  return fail_at({file, 1, 1}, "this text is UTF-16; save it as UTF-8");
}

/// The first line that says something is that of an NC program.
bool begins_as_program(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r\n");
  if (begin == std::string_view::npos) return false;
  const std::string_view rest = text.substr(begin);
  const auto word = [&](char letter) { return rest[0] == letter && rest.size() > 1 && is_digit(rest[1]); };
  return rest[0] == '%' || rest[0] == '(' || rest[0] == ';' || word('O') || word('G') || word('N') ||
         rest.starts_with("0 BEGIN PGM") || rest.starts_with("PARTNO");
}

SourcePosition position_of(const ::toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

/// What stands behind the equals sign of a line, where the place of an error lies in it.
struct Written {
  std::string_view value;  ///< up to a comment, without blanks at its ends
  int column = 1;
};
std::optional<Written> value_at(std::string_view text, const SourcePosition& at) {
  for (int line = 1; line < at.line; ++line) text.remove_prefix(std::min(text.size(), text.find('\n') + 1));
  const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
  const auto equals = line.find('=');
  if (equals == std::string_view::npos || line.find_first_of("\"'#") < equals) return std::nullopt;
  const auto begin = line.find_first_not_of(" \t", equals + 1);
  if (begin == std::string_view::npos || at.column <= static_cast<int>(begin)) return std::nullopt;
  const std::string_view rest = line.substr(begin), value = rest.substr(0, rest.find('#'));
  return Written{value.substr(0, value.find_last_not_of(" \t") + 1), static_cast<int>(begin) + 1};
}

/// `key = word`: what the library says of it is about truth values or numbers; what is missing are the quotes.
std::optional<std::string> unquoted_word(std::string_view value) {
  const std::string_view word = value.substr(0, value.find_first_of(" \t"));
  const auto of_word = [](char c) { return is_letter(c) || is_digit(c) || c == '.' || c == '-'; };
  constexpr std::size_t kLongest = 60;
  for (const std::string_view known : {"true", "false", "inf", "nan"})
    if (word == known) return std::nullopt;  // what is wrong is something else
  if (word.empty() || !is_letter(word.front()) || word.size() > kLongest ||
      !std::all_of(word.begin(), word.end(), of_word))
    return std::nullopt;
  return fmt::format("{0} is text and stands in quotes: \"{0}\"", word);
}

/// `key = 2,5` and `key = 2 mm`: the library names the character that it did not expect.
std::optional<std::string> number_of_a_shop(std::string_view value) {
  std::size_t end = 0;
  while (end < value.size() && (is_digit(value[end]) || (end == 0 && (value[end] == '-' || value[end] == '+')) ||
                                value[end] == '.' || value[end] == ','))
    ++end;
  std::string number(value.substr(0, end));
  const std::string_view behind = value.substr(std::min(value.size(), value.find_first_not_of(" \t", end)));
  const auto commas = std::count(number.begin(), number.end(), ','),
             points = std::count(number.begin(), number.end(), '.');
  if (value.starts_with(',') || !std::any_of(number.begin(), number.end(), is_digit) || commas + points > 1 ||
      !is_digit(number.back()))
    return std::nullopt;
  const bool unit = !behind.empty() && (is_letter(behind.front()) || behind.front() == '%' ||
                                        static_cast<unsigned char>(behind.front()) > 0x7f);
  constexpr std::size_t kLongestUnit = 8;
  if (!behind.empty() && (!unit || behind.size() > kLongestUnit || number == "0" ||
                          behind.find_first_of(" \t,_0123456789") != std::string_view::npos))
    return std::nullopt;
  if (unit) return fmt::format("{} has a unit; write the number alone, in the unit of the key", value);
  if (commas == 0) return std::nullopt;
  std::replace(number.begin(), number.end(), ',', '.');
  return fmt::format("{} has a decimal comma; write a decimal point: {}", value, number);
}

/// Mistakes that are told in other words than those of the library.
std::optional<Diagnostic> usual_mistake(std::string_view text, const SourcePosition& at) {
  const std::optional<Written> written = value_at(text, at);
  if (!written) return std::nullopt;
  auto told = number_of_a_shop(written->value);
  if (!told) told = unquoted_word(written->value);
  if (!told) return std::nullopt;
  return fail_at({at.file, at.line, written->column}, "{}", *told);
}

/// Copies nodes of the library; remembers the first that lies too deep.
class Copier {
 public:
  Copier(const std::string& file, int max_nesting) : file_(file), max_nesting_(max_nesting) {}

  TomlValue copy(const ::toml::node& node, int depth = 0) {
    TomlValue result;
    result.position = position_of(node.source(), file_);
    if (depth > max_nesting_) {
      if (!too_deep_) too_deep_ = result.position;
    } else if (const auto* table = node.as_table()) {
      result.data = copy_table(*table, depth);
    } else if (const auto* array = node.as_array()) {
      TomlArray values;
      for (const auto& element : *array) values.values.push_back(copy(element, depth + 1));
      result.data = std::move(values);
    } else if (const auto* text = node.as_string()) {
      result.data = text->get();
    } else if (const auto* integer = node.as_integer()) {
      result.data = std::int64_t{integer->get()};
    } else if (const auto* number = node.as_floating_point()) {
      result.data = number->get();
    } else if (const auto* boolean = node.as_boolean()) {
      result.data = boolean->get();
    } else {
      result.data = TomlDate{};
    }
    return result;
  }

  [[nodiscard]] const std::optional<SourcePosition>& too_deep() const { return too_deep_; }

 private:
  TomlTable copy_table(const ::toml::table& table, int depth) {
    TomlTable result;
    for (const auto& [key, value] : table) {
      TomlEntry& entry = result.entries.emplace_back(
          TomlEntry{std::string(key.str()), position_of(key.source(), file_), copy(value, depth + 1)});
      // A table that only its sub-tables name has no place of its own.
      if (entry.value.position.line == 0) entry.value.position = entry.key_position;
    }
    std::stable_sort(result.entries.begin(), result.entries.end(), [](const TomlEntry& a, const TomlEntry& b) {
      return std::pair(a.key_position.line, a.key_position.column) <
             std::pair(b.key_position.line, b.key_position.column);
    });
    return result;
  }

  const std::string& file_;
  int max_nesting_;
  std::optional<SourcePosition> too_deep_;
};

}  // namespace

const TomlEntry* TomlTable::find(std::string_view key) const {
  for (const auto& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

std::optional<double> TomlValue::number() const {
  if (const auto* real = std::get_if<double>(&data)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&data)) return static_cast<double>(*whole);
  return std::nullopt;
}

Result<TomlValue> parse_toml(std::string_view text, const std::string& file, const TomlSyntax& syntax) {
  if (const Status one_byte = check_utf16(text, file); !one_byte) return one_byte.error();
  if (!syntax.one_line_strings)
    if (const Status text_only = check_nul(text, file); !text_only) return text_only.error();
  if (const Status bounded = DepthCheck(text, file, syntax).run(); !bounded) return bounded.error();
  try {
    const ::toml::table table = ::toml::parse(text, std::string_view{file});
    // Where the brackets have been counted, the depth is bounded already.
    Copier copier(file, syntax.one_line_strings ? std::numeric_limits<int>::max() : syntax.max_nesting);
    TomlValue root = copier.copy(table);
    if (copier.too_deep()) return fail_at(*copier.too_deep(), "nested deeper than {} levels", syntax.max_nesting);
    root.position = {file, 1, 1};
    return root;
  } catch (const ::toml::parse_error& error) {
    const SourcePosition at = position_of(error.source(), file);
    if (begins_as_program(text))
      return fail_at(
          at, "this begins as an NC program, not as a job or a machine file: `check JOB PROGRAM` reads programs");
    if (auto mistake = usual_mistake(text, at)) return std::move(*mistake);
    return fail_at(at, "{}", error.description());
  }
}

}  // namespace toothpath::toml
