#include "postproc/readback/iso/block.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <span>

#include "postproc/readback/scanner.h"

namespace toothpath::iso {
namespace {

constexpr std::size_t kLongestBlock = 256;
constexpr int kDeepestExpression = 16;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); }
char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

class Parser {
 public:
  Parser(std::string_view line, bool o_words) : line_(line), o_words_(o_words) {}

  Result<NcBlock> parse() {
    if (line_.size() > kLongestBlock)
      return error(kLongestBlock, fmt::format("line of {} characters exceeds {}", line_.size(), kLongestBlock));
    skip_blanks();
    if (at() == '%') {
      ++i_;
      skip_blanks();
      if (i_ < line_.size()) return error(i_, "text after %");
      block_.percent = true;
      return std::move(block_);
    }
    if (at() == '/') {
      ++i_;
      block_.skip = true;
      if (!o_words_ && is_digit(at()) && at() != '0') ++i_;  // which of the switches: /2
      skip_blanks();
    }
    if (!block_.skip) i_ = line_.size() - beginning(line_.substr(i_), o_words_).size();
    if (upper(at()) == 'O' && !block_.skip) o_line();
    while (!problem_) {
      skip_blanks();
      if (i_ >= line_.size()) break;
      const char c = at();
      if (c == '(') comment();
      else if (c == ';') break;
      else if (c == '#') assignment();
      else if (is_letter(c)) word();
      else stop(i_, fmt::format("character {} is no part of a word", readback::shown_character(c)));
    }
    if (problem_) return *problem_;
    auto& words = block_.words;
    if (words.size() > 1 && words[0].letter == 'N' && (words[1].letter == '#' || words[1].letter == '<'))
      words.erase(words.begin());  // the number of a line of assignments
    return std::move(block_);
  }

 private:
  char at() const { return i_ < line_.size() ? line_[i_] : '\0'; }
  void skip_blanks() {
    while (i_ < line_.size() && (line_[i_] == ' ' || line_[i_] == '\t')) ++i_;
  }
  static Diagnostic error(std::size_t column, std::string text) {
    return {DiagnosticKind::refused_input, {"", 0, static_cast<int>(column) + 1}, std::move(text)};
  }
  void stop(std::size_t column, std::string text) {
    if (!problem_) problem_ = error(column, std::move(text));
  }

  void comment() {
    const std::size_t begin = i_;
    const std::size_t end = line_.find(')', begin);
    if (end == std::string_view::npos) return stop(begin, "comment without its end");
    const std::string_view text = line_.substr(begin + 1, end - begin - 1);
    if (text.find('(') != std::string_view::npos) return stop(begin, "comment inside a comment");
    i_ = end + 1;
    label(text, "OP ", block_.operation);
    label(text, "TOOTH ", block_.tooth);
    block_.aborts = block_.aborts || (o_words_ && is_abort(text));
  }
  static bool is_abort(std::string_view text) {
    constexpr std::string_view kAbort = "ABORT,";
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return text.size() >= kAbort.size() && std::equal(kAbort.begin(), kAbort.end(), text.begin(),
                                                      [](char wanted, char c) { return wanted == upper(c); });
  }
  void label(std::string_view text, std::string_view name, std::int32_t& slot) {
    if (text.size() <= name.size() || !is_digit(text[name.size()])) return;
    for (std::size_t i = 0; i < name.size(); ++i)
      if (upper(text[i]) != name[i]) return;
    int n = 0;
    const auto r = std::from_chars(text.data() + name.size(), text.data() + text.size(), n);
    if (r.ec != std::errc{} || n > 30000) return stop(i_ - 1, "number of an operation or tooth out of range");
    slot = n;
  }

  std::optional<double> number(bool& point) {
    const std::size_t begin = i_;
    std::size_t digits = 0;
    if (at() == '-' || at() == '+') ++i_;
    const std::size_t unsigned_begin = i_;
    point = false;
    while (is_digit(at()) || (at() == '.' && !point)) {
      if (at() == '.') point = true;
      else ++digits;
      ++i_;
    }
    if (digits == 0 && begin > 0 && is_letter(line_[begin - 1]) && is_letter(at())) {  // POPEN
      std::size_t end = begin;
      while (end < line_.size() && is_letter(line_[end])) ++end;
      stop(begin - 1, fmt::format("{} is not in the subset", line_.substr(begin - 1, end - begin + 1)));
      return std::nullopt;
    }
    if (digits == 0 || digits > 18) {
      stop(begin, digits == 0 ? "number without digits" : "number of more than 18 digits");
      return std::nullopt;
    }
    double v = 0;
    std::from_chars(line_.data() + unsigned_begin, line_.data() + i_, v, std::chars_format::fixed);
    return line_[begin] == '-' ? -v : v;
  }

  /// Variables of macro programs: local and common ones.
  static bool is_of_programs(int n) { return n <= 33 || (n >= 100 && n <= 199) || (n >= 500 && n <= 999); }
  std::optional<std::int32_t> parameter_index() {
    ++i_;  // '#'
    const std::size_t begin = i_;
    int n = 0;
    while (is_digit(at()) && n < 100000) n = n * 10 + (line_[i_++] - '0');
    if (i_ == begin || n < 1 || (o_words_ && n > kLastParameter)) {
      stop(begin, o_words_ ? fmt::format("parameter number must be 1 to {}", kLastParameter)
                           : std::string("number of a variable expected behind #"));
      return std::nullopt;
    }
    if (!o_words_ && !is_of_programs(n)) {
      stop(begin - 1, fmt::format("#{} is a variable of the control (tool offsets, alarms, stops, outputs, modes): a "
                                  "program has #1 to #33, #100 to #199 and #500 to #999 for itself",
                                  n));
      return std::nullopt;
    }
    return n;
  }

  /// #<name>: the index of the name in the block.
  bool name_here() const { return o_words_ && i_ + 1 < line_.size() && line_[i_ + 1] == '<'; }
  std::optional<std::int32_t> parameter_name() {
    const std::size_t begin = i_, end = line_.find('>', i_);
    if (end == std::string_view::npos) {
      stop(begin, "name of a parameter without its >");
      return std::nullopt;
    }
    std::string name;
    for (std::size_t k = i_ + 2; k < end; ++k) {
      const char c = line_[k];
      if (c == ' ' || c == '\t') continue;
      if (!is_letter(c) && !is_digit(c) && c != '_' && c != '-') {
        stop(k, fmt::format("character {} in the name of a parameter", readback::shown_character(c)));
        return std::nullopt;
      }
      name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    if (name.empty()) {
      stop(begin, "a parameter without a name");
      return std::nullopt;
    }
    i_ = end + 1;
    block_.names.push_back(std::move(name));
    return static_cast<std::int32_t>(block_.names.size()) - 1;
  }

  NcValue value(bool& point) {
    skip_blanks();
    NcValue v;
    point = true;
    const char ahead = i_ + 1 < line_.size() ? line_[i_ + 1] : '\0';
    if (at() == '[' || at() == '#' || (at() == '-' && (ahead == '[' || ahead == '#'))) {
      v.first = static_cast<std::int32_t>(block_.steps.size());
      primary(0);
      v.count = static_cast<std::int32_t>(block_.steps.size()) - v.first;
    } else if (const auto n = number(point)) {
      v.number = *n;
    }
    return v;
  }

  // Expressions: relations < sums < products < primaries.
  void primary(int depth) {
    skip_blanks();
    if (depth > kDeepestExpression) return stop(i_, "expression is nested too deeply");
    if (at() == '[') {
      ++i_;
      relation(depth + 1);
      skip_blanks();
      if (at() != ']') return stop(i_, "] expected");
      ++i_;
    } else if (at() == '#' && name_here()) {
      if (const auto n = parameter_name()) push(NcStep::Kind::named, *n);
    } else if (at() == '#') {
      if (const auto n = parameter_index()) push(NcStep::Kind::parameter, *n);
    } else if (at() == '-' && i_ + 1 < line_.size() && (line_[i_ + 1] == '[' || line_[i_ + 1] == '#')) {
      ++i_;
      primary(depth + 1);
      push(NcStep::Kind::negate);
    } else {
      bool point = false;
      if (const auto n = number(point)) push(NcStep::Kind::number, *n);
    }
  }
  /// MOD binds as a product does; 0 <= r < abs(b), as LinuxCNC makes it.
  bool modulo_here() const {
    return i_ + 2 < line_.size() && upper(line_[i_]) == 'M' && upper(line_[i_ + 1]) == 'O' &&
           upper(line_[i_ + 2]) == 'D';
  }
  void product(int depth) {
    primary(depth);
    for (skip_blanks(); !problem_ && (at() == '*' || at() == '/' || modulo_here()); skip_blanks()) {
      const auto kind = at() == '*'   ? NcStep::Kind::multiply
                        : at() == '/' ? NcStep::Kind::divide
                                      : NcStep::Kind::modulo;
      i_ += kind == NcStep::Kind::modulo ? 3 : 1;
      if (kind == NcStep::Kind::multiply && at() == '*') return stop(i_, "powers are not in the subset");
      primary(depth);
      push(kind);
    }
  }
  void sum(int depth) {
    product(depth);
    for (skip_blanks(); !problem_ && (at() == '+' || at() == '-'); skip_blanks()) {
      const auto kind = at() == '+' ? NcStep::Kind::add : NcStep::Kind::subtract;
      ++i_;
      product(depth);
      push(kind);
    }
  }
  void relation(int depth) {
    sum(depth);
    skip_blanks();
    if (problem_ || !is_letter(at())) return;
    const std::size_t begin = i_;
    const char a = upper(at()), b = i_ + 1 < line_.size() ? upper(line_[i_ + 1]) : '\0';
    using K = NcStep::Kind;
    const std::string name{a, b};
    const K kind = name == "LT"   ? K::lt
                   : name == "LE" ? K::le
                   : name == "GT" ? K::gt
                   : name == "GE" ? K::ge
                   : name == "EQ" ? K::eq
                   : name == "NE" ? K::ne
                                  : K::number;
    if (kind == K::number) return stop(begin, "operator is not in the subset");
    i_ += 2;
    sum(depth);
    push(kind);
  }
  void push(NcStep::Kind kind, double v = 0) { block_.steps.push_back({kind, v}); }

  void assignment() {
    NcWord w;
    w.letter = '#';
    w.column = static_cast<std::int32_t>(i_) + 1;
    if (name_here()) w.letter = '<';
    const auto n = w.letter == '<' ? parameter_name() : parameter_index();
    if (!n) return;
    w.index = *n;
    skip_blanks();
    if (at() != '=') return stop(i_, "= expected");
    ++i_;
    w.value = value(w.point);
    block_.words.push_back(w);
  }

  void word() {
    NcWord w;
    w.letter = upper(at());
    w.column = static_cast<std::int32_t>(i_) + 1;
    ++i_;
    w.value = value(w.point);
    block_.words.push_back(w);
  }

  void o_line() {
    const std::size_t begin = i_;
    ++i_;
    skip_blanks();
    if (o_words_ && at() == '<')
      return stop(begin, fmt::format("o{} has a name: it may stand for another file or for Python of the machine. "
                                     "Sub-programs and loops of this text have numbers",
                                     readback::shown_text(line_.substr(i_, line_.find('>', i_) - i_ + 1))));
    const std::size_t first = i_;
    std::int64_t n = 0;
    while (is_digit(at()) && n < 1000000) n = n * 10 + (line_[i_++] - '0');
    if (i_ == first || n < 1 || n > 99999) return stop(begin, "o-word number must be 1 to 99999");
    block_.o_number = n;
    skip_blanks();
    std::string keyword;
    while (is_letter(at())) keyword += upper(line_[i_++]);
    if (!o_words_) {
      if (!keyword.empty()) return stop(begin, "o-words are not in this dialect");
      block_.o_word = OWord::program;
      return;
    }
    struct Named {
      const char* name;
      OWord o;
    };
    for (const Named k : {Named{"SUB", OWord::sub}, Named{"ENDSUB", OWord::endsub}, Named{"CALL", OWord::call},
                          Named{"WHILE", OWord::loop_while}, Named{"ENDWHILE", OWord::endwhile},
                          Named{"REPEAT", OWord::repeat}, Named{"ENDREPEAT", OWord::endrepeat}})
      if (keyword == k.name) block_.o_word = k.o;
    if (block_.o_word == OWord::none) return stop(begin, fmt::format("o-word \"{}\" is not in the subset", keyword));
    for (skip_blanks(); !problem_ && at() == '['; skip_blanks()) {
      bool point = false;
      block_.arguments.push_back(value(point));
    }
    const std::size_t wanted = block_.o_word == OWord::loop_while || block_.o_word == OWord::repeat ? 1 : 0;
    if (block_.arguments.size() > 30 || (block_.o_word != OWord::call && block_.arguments.size() != wanted))
      stop(begin, "wrong number of arguments of an o-word");
    if (!problem_ && at() != '\0' && at() != '(' && at() != ';') stop(i_, "words after an o-word");
  }

  std::string_view line_;
  bool o_words_;
  std::size_t i_ = 0;
  NcBlock block_;
  std::optional<Diagnostic> problem_;
};

}  // namespace

std::string_view beginning(std::string_view line, bool o_words) {
  const auto trimmed = [](std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return text;
  };
  line = trimmed(line);
  if (!o_words || line.empty() || upper(line[0]) != 'N') return line;
  std::string_view rest = trimmed(line.substr(1));
  if (rest.empty() || !is_digit(rest[0])) return line;
  rest.remove_prefix(std::min(rest.find_first_not_of("0123456789"), rest.size()));
  rest = trimmed(rest);
  return !rest.empty() && upper(rest[0]) == 'O' ? rest : line;
}

Result<NcBlock> parse_nc_block(std::string_view line, bool o_words) { return Parser(line, o_words).parse(); }

std::vector<std::size_t> squares_above_zero(const NcBlock& block, const NcValue& condition) {
  using K = NcStep::Kind;
  std::span<const NcStep> rest =
      std::span(block.steps)
          .subspan(static_cast<std::size_t>(condition.first), static_cast<std::size_t>(condition.count));
  std::vector<std::size_t> parameters;
  while (rest.size() >= 3 && rest[0].kind == K::parameter && rest[1].kind == K::parameter &&
         rest[0].value == rest[1].value && rest[2].kind == K::multiply) {
    const std::size_t used = parameters.empty() ? 3 : 4;
    if (rest.size() < used || (used == 4 && rest[3].kind != K::add)) return {};
    parameters.push_back(static_cast<std::size_t>(rest[0].value));
    rest = rest.subspan(used);
  }
  const bool ends = rest.size() == 2 && rest[0].kind == K::number && rest[0].value == 0 && rest[1].kind == K::gt;
  return ends ? parameters : std::vector<std::size_t>{};
}

}  // namespace toothpath::iso
