// One line of NC text as a list of words, expressions kept as a short program for a stack. Knows no meaning of a word.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::iso {

/// Step of an expression in postfix order.
struct NcStep {
  enum class Kind : std::uint8_t {
    number,
    parameter,
    named,  ///< `value`: index in NcBlock::names; whoever runs the block makes a parameter of it
    negate,
    add,
    subtract,
    multiply,
    divide,
    modulo,
    lt,
    le,
    gt,
    ge,
    eq,
    ne
  };
  Kind kind = Kind::number;
  double value = 0;  ///< of a number; index of a parameter
};

/// A value: a plain number or an expression.
struct NcValue {
  double number = 0;
  std::int32_t first = 0, count = 0;  ///< steps in NcBlock::steps; count 0: the plain number
};

struct NcWord {
  char letter = '?';   ///< upper case; '#': an assignment to the parameter `index`; '<': to the name at that index
  bool point = false;  ///< the number was written with a decimal point
  std::int32_t index = 0;
  std::int32_t column = 0;
  NcValue value;
};

/// The keyword of an o-word line.
enum class OWord : std::uint8_t { none, sub, endsub, call, loop_while, endwhile, repeat, endrepeat, program };

struct NcBlock {
  std::vector<NcWord> words;
  std::vector<NcStep> steps;
  std::vector<NcValue> arguments;  ///< of an o-word
  OWord o_word = OWord::none;
  std::int64_t o_number = 0;
  std::int32_t operation = -1;     ///< n of the comment (OP n type); -1: no such comment
  std::int32_t tooth = -1;         ///< k of the comment (TOOTH k)
  std::vector<std::string> names;  ///< of parameters, #<name>: lower case without blanks
  bool percent = false;
  bool skip = false;    ///< begins with a slash: left out where the switch of the control is on
  bool aborts = false;  ///< has the comment (ABORT, ..), with which LinuxCNC ends a program
};

/// Parses one line without its end.
/// Errors: message and column in the diagnostic's position (file and line are the caller's); unbalanced or nested
/// comments, a character that is no part of a word, a number without digits or with an exponent, lines of more than
/// 256 characters, expressions nested deeper than 16.
[[nodiscard]] Result<NcBlock> parse_nc_block(std::string_view line, bool o_words);

/// The line without blanks at its beginning, and without its N word ahead of an o-word.
[[nodiscard]] std::string_view beginning(std::string_view line, bool o_words);

/// The parameters of a condition "#1*#1+#2*#2 GT 0", which holds where one of them is not 0. Empty: it is another one.
[[nodiscard]] std::vector<std::size_t> squares_above_zero(const NcBlock& block, const NcValue& condition);

/// Numbered parameters of a program; behind them those of the control itself, which LinuxCNC's programs may read.
inline constexpr int kLastOfProgram = 5000, kLastParameter = 5999;

/// Value of an expression. `parameter(index)` returns a pointer to the value or null if it was never set.
template <typename Parameters>
[[nodiscard]] Result<double> evaluate(const NcBlock& block, const NcValue& value, const Parameters& parameter) {
  if (value.count == 0) return value.number;
  double stack[64];  // three pending operands a level of nesting at most
  int n = 0;
  for (std::int32_t i = value.first; i < value.first + value.count; ++i) {
    const NcStep& s = block.steps[static_cast<std::size_t>(i)];
    using K = NcStep::Kind;
    if (s.kind == K::number) {
      stack[n++] = s.value;
    } else if (s.kind == K::parameter) {
      const double* p = parameter(static_cast<int>(s.value));
      if (p == nullptr) return fail("parameter #{} was never set", static_cast<int>(s.value));
      stack[n++] = *p;
    } else if (s.kind == K::negate) {
      stack[n - 1] = -stack[n - 1];
    } else {
      const double b = stack[--n];
      double& a = stack[n - 1];
      switch (s.kind) {
        case K::add: a = a + b; break;
        case K::subtract: a = a - b; break;
        case K::multiply: a = a * b; break;
        case K::divide:
          if (b == 0) return fail("division by zero");
          a = a / b;
          break;
        case K::modulo:
          if (b == 0) return fail("remainder of a division by zero");
          a = std::fmod(a, b);
          if (a < 0) a += std::abs(b);
          break;
        case K::lt: a = a < b ? 1 : 0; break;
        case K::le: a = a <= b ? 1 : 0; break;
        case K::gt: a = a > b ? 1 : 0; break;
        case K::ge: a = a >= b ? 1 : 0; break;
        case K::eq: a = a == b ? 1 : 0; break;
        default: a = a != b ? 1 : 0; break;
      }
    }
  }
  return stack[0];
}

}  // namespace toothpath::iso
