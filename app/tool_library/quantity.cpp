// Lengths and angles with their units, as programs write them for people.
#include <charconv>
#include <cmath>

#include "app/tool_library/formats.h"
#include "geometry/base/angle.h"
#include "geometry/base/length_unit.h"

namespace toothpath::tool_library {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// What is left of a text while it is read.
class Rest {
 public:
  explicit Rest(std::string_view text) : text_(text) {}
  void skip_blanks() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\t')) text_.remove_prefix(1);
    while (text_.starts_with("\xC2\xA0")) text_.remove_prefix(2);  // a blank that does not break a line
  }
  bool take(char c) {
    if (!text_.starts_with(c)) return false;
    text_.remove_prefix(1);
    return true;
  }
  [[nodiscard]] bool done() const { return text_.empty(); }
  [[nodiscard]] bool digit_ahead() const { return !text_.empty() && is_digit(text_.front()); }

  /// A decimal number, with a point or a comma.
  std::optional<double> number() {
    std::string digits;
    while (!text_.empty() && (is_digit(text_.front()) || text_.front() == '.' || text_.front() == ',')) {
      digits += text_.front() == ',' ? '.' : text_.front();
      text_.remove_prefix(1);
    }
    // 1e-3: an exponent is no unit
    if (text_.size() > 1 && (text_[0] == 'e' || text_[0] == 'E') &&
        (is_digit(text_[1]) || (text_.size() > 2 && (text_[1] == '-' || text_[1] == '+') && is_digit(text_[2])))) {
      const bool plus = text_[1] == '+';
      digits += 'e';
      text_.remove_prefix(plus ? 2 : 1);
      do {
        digits += text_.front();
        text_.remove_prefix(1);
      } while (digit_ahead());
    }
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(value)) return std::nullopt;
    return value;
  }

  /// "3.5", "1/4", "2 1/4".
  std::optional<double> number_or_fraction() {
    const auto whole = number();
    if (!whole) return whole;
    const std::string_view behind = text_;
    skip_blanks();
    std::optional<double> above = take('/') ? whole : std::nullopt;
    double sum = 0;
    if (!above && digit_ahead()) {
      sum = *whole;
      above = number();
      if (!take('/')) return std::nullopt;
    }
    if (!above) {
      text_ = behind;
      return whole;
    }
    skip_blanks();
    const auto below = number();
    if (!below || !(*below > 0)) return std::nullopt;
    return sum + *above / *below;
  }

  /// All up to a blank, a sign or a digit.
  std::string_view unit() {
    std::size_t n = 0;
    while (n < text_.size() && text_[n] != ' ' && text_[n] != '\t' && text_[n] != '+' && text_[n] != '-' &&
           !is_digit(text_[n]))
      ++n;
    const std::string_view word = text_.substr(0, n);
    text_.remove_prefix(n);
    return word;
  }

 private:
  std::string_view text_;
};

}  // namespace

std::optional<double> read_quantity(std::string_view text, std::optional<double> bare) {
  Rest rest(text);
  double sum = 0;
  int terms = 0;
  bool any_bare = false;
  for (rest.skip_blanks(); !rest.done(); rest.skip_blanks()) {
    const bool minus = terms == 0 && rest.take('-');
    if (!minus && rest.take('+')) rest.skip_blanks();
    const auto number = rest.number_or_fraction();
    if (!number) return std::nullopt;
    rest.skip_blanks();
    const std::string_view word = rest.unit();
    const auto unit = word.empty() ? bare : mm_of_unit(word);
    if (!unit) return std::nullopt;
    any_bare = any_bare || word.empty();
    sum += (minus ? -*number : *number) * *unit;
    ++terms;
  }
  if (terms == 0 || (any_bare && terms > 1) || !std::isfinite(sum)) return std::nullopt;
  return sum;
}

std::optional<double> read_angle_deg(std::string_view text) {
  Rest rest(text);
  rest.skip_blanks();
  const auto number = rest.number();
  if (!number) return std::nullopt;
  rest.skip_blanks();
  const std::string_view unit = rest.unit();
  rest.skip_blanks();
  if (!rest.done()) return std::nullopt;
  if (unit == "deg" || unit == "\xC2\xB0" || unit == "degree" || unit == "degrees") return *number;
  if (unit == "rad") return degrees(*number);
  return std::nullopt;
}

}  // namespace toothpath::tool_library
