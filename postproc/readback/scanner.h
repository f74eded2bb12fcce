// Reads one line from left to right: names, numbers, expressions that are evaluated at once. For readers of controls
// with their own language; errors carry the column.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::readback {

class NcScanner {
 public:
  explicit NcScanner(std::string_view line) : line_(line) {}

  [[nodiscard]] bool done() {
    skip_blanks();
    return i_ >= line_.size();
  }
  [[nodiscard]] char at() const { return i_ < line_.size() ? line_[i_] : '\0'; }
  [[nodiscard]] char ahead() const { return i_ + 1 < line_.size() ? line_[i_ + 1] : '\0'; }
  [[nodiscard]] int column() const { return static_cast<int>(i_) + 1; }
  [[nodiscard]] std::string_view rest() const { return line_.substr(i_); }
  void advance(std::size_t n) { i_ += n; }
  void skip_blanks() {
    while (i_ < line_.size() && (line_[i_] == ' ' || line_[i_] == '\t')) ++i_;
  }
  /// Takes `text` if it stands here.
  bool take(std::string_view text) {
    if (line_.substr(i_, text.size()) != text) return false;
    i_ += text.size();
    return true;
  }
  /// Letters, A-Z and _.
  std::string_view letters() {
    const std::size_t begin = i_;
    while (is_letter(at())) ++i_;
    return line_.substr(begin, i_ - begin);
  }
  [[nodiscard]] static bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || c == '_'; }
  [[nodiscard]] static bool is_digit(char c) { return c >= '0' && c <= '9'; }

  /// A number with optional sign and point. Empty: none stands here (nothing is taken), or more than 18 digits.
  std::optional<double> number() {
    const std::size_t begin = i_;
    std::size_t k = i_, digits = 0;
    if (k < line_.size() && (line_[k] == '-' || line_[k] == '+')) ++k;
    const std::size_t first = k;
    bool point = false;
    for (; k < line_.size() && (is_digit(line_[k]) || (line_[k] == '.' && !point)); ++k) {
      if (line_[k] == '.') point = true;
      else ++digits;
    }
    if (digits == 0 || digits > 18) return std::nullopt;
    double v = 0;
    std::from_chars(line_.data() + first, line_.data() + k, v, std::chars_format::fixed);
    i_ = k;
    return line_[begin] == '-' ? -v : v;
  }

  /// The control's names for cutting off the digits behind the point, "TRUNC" or "INT", and for the amount, "ABS";
  /// empty: none.
  void set_functions(std::string_view truncation, std::string_view amount = {}) {
    truncation_ = truncation;
    amount_ = amount;
  }

  /// Sums, products, signs and brackets over numbers and parameters. `parameter(scanner)` reads a name and returns a
  /// pointer to its value, null where it has none.
  template <typename Parameter>
  Result<double> expression(const Parameter& parameter, int depth = 0) {
    auto sum = product(parameter, depth);
    while (sum) {
      skip_blanks();
      const char sign = at();
      if (sign != '+' && sign != '-') break;
      ++i_;
      const auto next = product(parameter, depth);
      if (!next) return next;
      sum = sign == '+' ? *sum + *next : *sum - *next;
    }
    return sum;
  }

 private:
  template <typename Parameter>
  Result<double> product(const Parameter& parameter, int depth) {
    auto value = primary(parameter, depth);
    while (value) {
      skip_blanks();
      const char sign = at();
      if (sign != '*' && sign != '/') break;
      ++i_;
      const auto next = primary(parameter, depth);
      if (!next) return next;
      if (sign == '/' && *next == 0) return fail("division by zero");
      value = sign == '*' ? *value * *next : *value / *next;
    }
    return value;
  }
  template <typename Parameter>
  Result<double> primary(const Parameter& parameter, int depth) {
    skip_blanks();
    if (depth > 16) return fail("expression is nested too deeply");
    if (at() == '(') {
      ++i_;
      auto inner = expression(parameter, depth + 1);
      if (!inner) return inner;
      skip_blanks();
      if (at() != ')') return fail(") expected");
      ++i_;
      return inner;
    }
    if ((at() == '-' || at() == '+') && !is_digit(ahead()) && ahead() != '.') {
      const bool negative = at() == '-';
      ++i_;
      auto inner = primary(parameter, depth + 1);
      if (inner && negative) return -*inner;
      return inner;
    }
    for (const std::string_view name : {truncation_, amount_}) {
      if (name.empty() || line_.substr(i_, name.size()) != name || is_letter(at_offset(name.size()))) continue;
      i_ += name.size();
      const auto inner = primary(parameter, depth + 1);
      if (!inner) return inner;
      return name == truncation_ ? std::trunc(*inner) : std::abs(*inner);
    }
    if (is_letter(at())) {
      const double* p = parameter(*this);
      if (p == nullptr) return fail("a parameter that was never set, or no parameter");
      return *p;
    }
    if (const auto n = number()) return *n;
    return fail("number expected");
  }

  [[nodiscard]] char at_offset(std::size_t n) const { return i_ + n < line_.size() ? line_[i_ + n] : '\0'; }

  std::string_view line_, truncation_, amount_;
  std::size_t i_ = 0;
};

/// A character for a message: itself where it can be printed, else its code.
[[nodiscard]] inline std::string shown_character(char c) {
  return c > ' ' && c <= '~' ? fmt::format("'{}'", c) : fmt::format("0x{:02x}", static_cast<unsigned char>(c));
}

/// The beginning of a text for a message: what cannot be printed as its code.
[[nodiscard]] inline std::string shown_text(std::string_view text) {
  constexpr std::size_t kMost = 60;
  std::string out;
  for (const char c : text.substr(0, kMost))
    out += c >= ' ' && c <= '~' ? std::string(1, c) : fmt::format("<{:02x}>", static_cast<unsigned char>(c));
  return text.size() > kMost ? out + ".." : out;
}

/// Lines of a text, without their ends.
[[nodiscard]] inline std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) end = text.size();
    std::string_view line = text.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back(line);
    begin = end + 1;
  }
  return lines;
}

/// The number behind "OP " or "TOOTH " in a comment; -1: another comment.
[[nodiscard]] inline int comment_label(std::string_view comment, std::string_view name) {
  while (!comment.empty() && comment.front() == ' ') comment.remove_prefix(1);
  if (comment.substr(0, name.size()) != name) return -1;
  comment.remove_prefix(name.size());
  int n = -1;
  const auto r = std::from_chars(comment.data(), comment.data() + comment.size(), n);
  return r.ec == std::errc{} && n >= 0 && n <= 30000 ? n : -1;
}

}  // namespace toothpath::readback
