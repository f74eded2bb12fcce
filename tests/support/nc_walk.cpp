#include "tests/support/nc_walk.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace toothpath::test {
namespace {

using Variables = std::map<std::string, double>;

/// Sums and products with brackets, MOD, ABS, TRUNC, INT and variables #1, R1, Q1, COUNT, TOOTH.
class Sum {
 public:
  Sum(const std::string& text, const Variables& variables) : s_(text), variables_(variables) {}
  double value() {
    const double v = sum();
    if (!s_.empty() && skip() != s_.size()) throw std::invalid_argument("sum " + s_);
    return v;
  }

 private:
  std::size_t skip() {
    while (at_ < s_.size() && s_[at_] == ' ') ++at_;
    return at_;
  }
  bool take(const std::string& word) {
    if (s_.compare(skip(), word.size(), word) != 0) return false;
    at_ += word.size();
    return true;
  }
  double sum() {
    double v = product();
    while (true) {
      if (take("+")) v += product();
      else if (take("-")) v -= product();
      else return v;
    }
  }
  double product() {
    double v = factor();
    while (true) {
      if (take("*")) v *= factor();
      else if (take("/")) v /= factor();
      else if (take("MOD")) {
        const double by = factor();
        v -= by * std::floor(v / by);
      } else return v;
    }
  }
  double bracket() {
    const double v = sum();
    if (!take(")") && !take("]")) throw std::invalid_argument("bracket in " + s_);
    return v;
  }
  double factor() {
    if (take("-")) return -factor();
    if (take("+")) return factor();
    if (take("ABS")) return std::abs(factor());
    if (take("TRUNC") || take("INT")) return std::trunc(factor());
    if (take("(") || take("[")) return bracket();
    for (const char* name : {"COUNT", "TOOTH"})
      if (take(name)) return variables_.at(name);
    std::size_t end = skip();
    const bool variable = end < s_.size() && std::string("#RQ").find(s_[end]) != std::string::npos;
    if (variable) ++end;
    while (end < s_.size() && (std::isdigit(static_cast<unsigned char>(s_[end])) || s_[end] == '.')) ++end;
    const std::string word = s_.substr(at_, end - at_);
    at_ = end;
    if (variable) return variables_.at(word);
    std::size_t used = 0;
    const double v = std::stod(word, &used);
    if (used != word.size()) throw std::invalid_argument("number " + word);
    return v;
  }

  const std::string& s_;
  const Variables& variables_;
  std::size_t at_ = 0;
};

struct TextLine {
  int number = 0;
  std::string code;
};

std::string stripped(const std::string& s) {
  const auto from = s.find_first_not_of(" \r\t");
  return from == std::string::npos ? std::string() : s.substr(from, s.find_last_not_of(" \r\t") + 1 - from);
}

/// What is common to all controls: lines, variables, the modes that decide where the tool goes.
class Walker {
 public:
  virtual ~Walker() = default;
  NcWalk run(const std::string& text) {
    std::istringstream in(text);
    for (std::string s; std::getline(in, s);) {
      std::string code = uncommented(s);
      if (!code.empty() && code[0] == '/') code = stripped(code.substr(1));  // the switch that leaves it out is off
      lines_.push_back({int(lines_.size()) + 1, std::move(code)});
    }
    prepare();
    for (std::size_t steps = 0; at_ < lines_.size() && !walk_.ended && walk_.faults.size() < 20; ++steps) {
      const TextLine& line = lines_[at_++];
      if (steps > 50'000'000) return fault(line, "endless"), walk_;
      if (line.code.empty()) continue;
      try {
        next_ = NcMove{};
        if (!execute(line.code)) fault(line, "not understood");
        else finish(line);
      } catch (const std::exception& e) { fault(line, e.what()); }
    }
    return walk_;
  }

 protected:
  virtual std::string uncommented(const std::string& line) const = 0;
  virtual void prepare() {}
  /// One line; false where it is not understood. Words of a motion go into `next_`.
  virtual bool execute(const std::string& code) = 0;

  double number(const std::string& text) const { return Sum(text, variables_).value(); }
  bool matches(const std::string& code, const std::regex& pattern) { return std::regex_match(code, found_, pattern); }
  std::size_t line_behind(const std::string& code, std::size_t from = 0) const {
    for (std::size_t k = from; k < lines_.size(); ++k)
      if (lines_[k].code == code) return k + 1;
    throw std::invalid_argument("no line " + code);
  }
  /// X Y Z A B C by their letter.
  bool set_axis(char letter, double value) {
    if (const auto k = std::string("XYZ").find(letter); k != std::string::npos) next_.linear[k] = value;
    else if (const auto r = std::string("ABC").find(letter); r != std::string::npos) next_.rotary[r] = value;
    else return false;
    return said_ = true;
  }

  /// Whoever measures a tool may leave all modes otherwise.
  bool measured() {
    walk_.checks.push_back({lines_[at_ - 1].number, tool_, walk_.moves.size()});
    metric_ = motion_known_ = length_ = false;
    return true;
  }

  NcWalk walk_;
  NcMove next_;
  std::vector<TextLine> lines_;
  std::size_t at_ = 0;
  Variables variables_;
  std::smatch found_;
  bool said_ = false, rapid_ = false, motion_known_ = false, tip_ = false, length_ = false, metric_ = false;
  int tool_ = 0, ready_ = 0;
  double turned_ = 0, feed_ = 0;
  bool inverse_ = false;
  std::array<double, 3> zero_{};
  bool freezes_ = false;
  bool may_take_zero_ = false, zero_said_ = true;  // of a transformation that may drop it
  std::array<double, 3> tip_zero_{};               // where `tip_` began

 private:
  void fault(const TextLine& line, const std::string& what) {
    walk_.faults.push_back(std::to_string(line.number) + ": " + line.code + ": " + what);
  }
  void finish(const TextLine& line) {
    if (!said_) return;
    said_ = false;
    if (!metric_ || !motion_known_) return fault(line, "moves before units and kind of motion are known");
    next_.line = line.number;
    next_.rapid = rapid_;
    next_.tip = tip_;
    next_.turned_deg = turned_;
    next_.zero_deg = zero_;
    next_.granted = may_take_zero_ && tip_;
    if (next_.granted && (zero_ != tip_zero_ || !zero_said_))
      return fault(line, "words count from elsewhere than TRAORI has found, or TRAORI may have dropped it");
    if (!zero_said_ && !next_.machine) return fault(line, "TRAFOOF may have dropped where words count from");
    next_.frozen = freezes_ && tip_;
    next_.tool = tool_;
    next_.length = length_;
    next_.feed = feed_;
    next_.inverse = inverse_;
    walk_.moves.push_back(next_);
  }
};

/// Words with a letter and a number: LinuxCNC, and Fanuc with its kin.
class IsoWalker : public Walker {
 public:
  explicit IsoWalker(bool linuxcnc) : linuxcnc_(linuxcnc) {
    freezes_ = !linuxcnc;
    if (linuxcnc) variables_["#5403"] = 0;  // where the tip is does not matter to whoever asks for words
  }

 protected:
  std::string uncommented(const std::string& line) const override {
    std::string s;
    int depth = 0;
    for (const char c : line) {
      depth += c == '(';
      if (depth == 0) s += c;
      depth -= c == ')';
    }
    return stripped(s);
  }
  bool execute(const std::string& code) override {
    const bool flow = std::string(linuxcnc_ ? "o#" : "%OM").find(code[0]) != std::string::npos;
    if (flow && (linuxcnc_ ? linuxcnc_flow(code) : fanuc_flow(code))) return true;
    static const std::regex zero(R"((?:N\d+ )?G52 (.*))"), macro(R"(G65 P\d+( [A-Z][-0-9.]+)*)"),
        probe(R"(G91 G38\.3 Z\[0-2\*[0-9.]+\] F[0-9.]+)");
    if (matches(code, linuxcnc_ ? probe : macro)) return steps_ = linuxcnc_, measured();
    if (steps_) return code == "G90" && (steps_ = false, true);  // nothing else is meant in G91
    if (matches(code, zero)) return zeros(found_[1]);
    if (linuxcnc_ && code.rfind("G10 ", 0) == 0) return offset(code);
    for (std::size_t k = 0; k < code.size();) {
      if (code[k] == ' ') {
        ++k;
        continue;
      }
      const char letter = code[k++];
      std::size_t end = k;
      for (int depth = 0; end < code.size() && (depth > 0 || code[end] != ' '); ++end)
        depth += (code[end] == '[') - (code[end] == ']');
      if (end == k || !word(letter, code.substr(k, end - k))) return false;
      k = end;
    }
    return true;
  }

 private:
  bool linuxcnc_flow(const std::string& code) {
    static const std::regex sub(R"(o(\d+) sub)"), endsub(R"(o(\d+) endsub)"), call(R"(o(\d+) call(?: (\[.*\]))?)"),
        loop(R"(o(\d+) while \[(.*) (LT|GT) (.*)\])"), again(R"(o(\d+) endwhile)"), assign(R"((#\d+)=(.*))"),
        broken(R"(o(\d+) if \[\[#5070 EQ 0\] OR \[ABS\[#<_off>\] GT [0-9.]+\]\])"), off(R"(#<_off>=\[#5063.*\])");
    if (matches(code, off)) return true;
    if (matches(code, broken)) return at_ = line_behind("o" + found_[1].str() + " endif", at_), true;  // it is whole
    if (matches(code, sub)) {
      at_ = line_behind("o" + found_[1].str() + " endsub", at_);
    } else if (matches(code, call)) {
      Variables local;
      if (found_[2].matched) local["#1"] = number(found_[2]);
      returns_.push_back({at_, variables_});
      at_ = line_behind("o" + found_[1].str() + " sub");
      variables_ = local;
    } else if (matches(code, endsub)) {
      back();
    } else if (matches(code, loop)) {
      // A B C and R of G54, which the shop has left at 0.
      for (const char* own : {"#5224", "#5225", "#5226", "#5230"}) variables_.emplace(own, 0);
      const double left = number(found_[2]), right = number(found_[4]);
      if (found_[3] == "LT" ? left >= right : left <= right)
        at_ = line_behind("o" + found_[1].str() + " endwhile", at_);
    } else if (matches(code, again)) {
      const std::string begin = "o" + found_[1].str() + " while";
      do --at_;
      while (lines_[at_].code.rfind(begin, 0) != 0);
    } else if (matches(code, assign)) {
      variables_[found_[1]] = number(found_[2]);
    } else {
      return false;
    }
    return true;
  }
  bool fanuc_flow(const std::string& code) {
    static const std::regex begin(R"(%|O\d+)"), call(R"(M98 P(\d+))"), lines(R"(M97 P(\d+))");
    if (matches(code, lines)) {
      returns_.push_back({at_, variables_});
      at_ = line_behind("N" + found_[1].str());
      return true;
    }
    if (code == "M99") return back(), true;
    if (matches(code, call)) {
      returns_.push_back({at_, variables_});
      at_ = line_behind("O" + found_[1].str());
      return true;
    }
    return matches(code, begin);
  }
  /// The last work offset, at the origins of the first one, turned.
  bool offset(const std::string& code) {
    static const std::regex written(R"(G10 L2 P9( X#5221 Y#5222 Z#5223(?: [ABC]#522[456])+)? R(\S+))");
    if (!matches(code, written) || !(found_[1].matched || offset_turn_)) return false;
    offset_turn_ = number(found_[2]);
    return true;
  }
  /// X Y Z may only be 0.
  bool zeros(const std::string& words) {
    std::istringstream in(words);
    for (std::string w; in >> w;) {
      const double v = number(w.substr(1));
      const auto r = std::string("ABC").find(w[0]);
      if (r != std::string::npos) zero_[r] = v;
      else if (std::string("XYZ").find(w[0]) == std::string::npos || v != 0) return false;
    }
    return !tip_;
  }
  void back() {
    at_ = returns_.back().first;
    variables_ = returns_.back().second;
    returns_.pop_back();
  }
  bool word(char letter, const std::string& text) {
    if (letter == 'G') return code_g(text);
    if (letter == 'M') return code_m(text);
    if (letter == 'T') return ready_ = std::stoi(text), true;
    if (letter == 'N') return true;
    if (letter == 'F') feed_ = number(text);
    if (letter == 'H' || letter == 'F' || letter == 'S') return std::isfinite(number(text));
    return set_axis(letter, number(text));
  }
  bool code_g(const std::string& g) {
    static const std::vector<std::string> harmless = {"17", "40", "80", "90", "93", "94", "61"};
    if (g == "0" || g == "1") return rapid_ = g == "0", motion_known_ = true;
    if (g == "21") return metric_ = true;
    if (g == "93" || g == "94") inverse_ = g == "93";
    if (g == "92.1" && linuxcnc_) return zero_ = {}, true;
    if (g == "54") return turned_ = 0, true;
    if (g == "59.3" && linuxcnc_) return turned_ = offset_turn_.value(), true;
    if (g == "53") return next_.machine = true;
    if (g == "43") return length_ = true;
    if (g == "43.4" && !linuxcnc_) return length_ = tip_ = true;
    if (g == "49") {
      length_ = false;
      if (!linuxcnc_) tip_ = false;
      return true;
    }
    return (g == "69" && !linuxcnc_) || std::find(harmless.begin(), harmless.end(), g) != harmless.end();
  }
  bool code_m(const std::string& m) {
    static const std::vector<std::string> harmless = {"0", "1", "3", "5", "7", "8", "9", "19"};
    if (m == "6") return tool_ = ready_, true;
    if (m == (linuxcnc_ ? "2" : "30")) return walk_.ended = true;
    if (linuxcnc_ && (m == "428" || m == "429")) return tip_ = m == "428", true;
    for (const auto& h : harmless)
      if (m == h) return true;
    return false;
  }

  bool linuxcnc_, steps_ = false;
  std::optional<double> offset_turn_;  // of the offset that the program has written, deg
  std::vector<std::pair<std::size_t, Variables>> returns_;
};

class SiemensWalker : public Walker {
 public:
  SiemensWalker() { may_take_zero_ = true; }

 protected:
  std::string uncommented(const std::string& line) const override { return stripped(line.substr(0, line.find(';'))); }
  bool execute(const std::string& numbered) override {
    static const std::regex number_of_block("^N\\d+ "), message(R"x(MSG\(("[^"]*")?\))x");
    const std::string code = std::regex_replace(numbered, number_of_block, "", std::regex_constants::format_first_only);
    if (matches(code, message) || code.starts_with("DEF INT ")) return true;
    static const std::regex loop(R"((?:FOR) (R\d+|COUNT)=(.*) TO (.*))"), assign(R"((R\d+|TOOTH)=(.*))"),
        tool("T=\"T(\\d+)\""),
        path(R"x(FGROUP\(.*\)|FGREF\[[ABC]\]=\S+|WORKPIECE\(,"",,"(?:PIPE|CYLINDER)"(?:,[-0-9.]+)+\))x"),
        turn(R"(ROT Z=(.*))"), zero(R"(TRANS ([ABC])=(.*))"), measures(R"(TOOL_CHECK\([-0-9.,]+\))");
    if (matches(code, measures)) return measured();
    if (std::string("GXYZABC").find(code[0]) != std::string::npos) {
      return words(code);
    } else if (matches(code, loop)) {
      const std::string name = found_[1];
      const double last = number(found_[3]);
      variables_[name] = number(found_[2]);
      loops_.push_back({at_, name, last});
      if (variables_[name] > last) throw std::invalid_argument("a loop of nothing");
    } else if (code == "ENDFOR") {
      Loop& inner = loops_.back();
      if (++variables_[inner.name] <= inner.last) at_ = inner.begin;
      else loops_.pop_back();
    } else if (matches(code, assign)) {
      variables_[found_[1]] = number(found_[2]);
    } else if (matches(code, tool)) {
      ready_ = std::stoi(found_[1]);
    } else if (matches(code, turn)) {
      turned_ = number(found_[1]);
    } else if (matches(code, zero)) {
      turned_ = 0;
      zero_ = {};
      zero_said_ = true;
      zero_.at(std::size_t(found_[1].str()[0] - 'A')) = number(found_[2]);
    } else if (code == "ROT" || code == "TRANS") {
      turned_ = 0;
      zero_ = {};
      zero_said_ = true;
    } else if (code == "TRAORI" || code == "TRAFOOF") {
      tip_ = code == "TRAORI";
      tip_zero_ = zero_;
      zero_said_ = zero_ == std::array<double, 3>{};
    } else if (!matches(code, path)) {
      return words(code);
    }
    return true;
  }

 private:
  struct Loop {
    std::size_t begin;
    std::string name;
    double last;
  };
  bool words(const std::string& code) {
    static const std::regex harmless(
        R"(G(?:17|40|90|93|94|54|60|641)|COMPOF|ORIWKS|ORIAXES|CYCLE832\(.*\)|ADIS=.*|F[0-9.]+|S\d+|N\d+|M[0135789])");
    std::istringstream in(code);
    std::array<double, 3> direction{};
    int said = 0;
    for (std::string w; in >> w;) {
      if (w == "G0" || w == "G1") rapid_ = w == "G0", motion_known_ = true;
      else if (w == "G710") metric_ = true;
      else if (w == "D0" || w == "D1") length_ = w == "D1";
      else if (w == "SUPA") next_.machine = true;
      else if (w == "M6") tool_ = ready_;
      else if (w == "M30") walk_.ended = true;
      else if (w.compare(1, 2, "3=") == 0) direction.at(std::size_t(w[0] - 'A')) = number(w.substr(3)), ++said;
      else if (w.compare(1, 4, "=DC(") == 0 && w.back() == ')') set_axis(w[0], number(w.substr(4)));
      else if (w.compare(1, 1, "=") == 0) set_axis(w[0], number(w.substr(2)));
      else if (std::string("XYZ").find(w[0]) != std::string::npos) set_axis(w[0], number(w.substr(1)));
      else if (!matches(w, harmless)) return false;
      if (w == "G93" || w == "G94") inverse_ = w == "G93";
      if (w[0] == 'F') feed_ = number(w.substr(1));
    }
    if (said == 3) next_.direction = direction;
    return said == 0 || said == 3;
  }

  std::vector<Loop> loops_;
};

class HeidenhainWalker : public Walker {
 protected:
  std::string uncommented(const std::string& line) const override {
    const auto from = line.find(' ');  // behind the number of the block
    return from == std::string::npos ? std::string() : stripped(line.substr(from, line.find(';') - from));
  }
  void prepare() override { motion_known_ = true; }
  bool execute(const std::string& code) override {
    static const std::regex begin(R"(BEGIN PGM \S+ MM)"), assign(R"((Q\d+) = (.*))"),
        zero(R"(CYCL DEF 7\.1 ([ABC])(.*))"), jump(R"(FN 12: IF (.*) LT (.*) GOTO LBL (\d+))"),
        tool(R"(TOOL CALL (\d+) Z S\d+)"), other(R"(TOOL (?:CALL S|DEF )\d+)"), turn(R"(CYCL DEF 10\.1 ROT(.*))"),
        harmless(
            R"(LBL \d+|PLANE RESET STAY|BLK FORM CYLINDER Z R[-+ .0-9LDISTR]+|END PGM \S+ MM|M(?:0|1|3|5|7|8|9|126|127))"
            R"(|CYCL DEF (?:7\.0 DATUM SHIFT|10\.0 ROTATION|247 DATUM SETTING Q339=\+1|32\.0 TOLERANCE|32\.1(?: T.*)?|32\.2 HSC-MODE:0 TA.*))");
    // TCH PROBE 481 and what becomes of its Q115; the tool is whole.
    static const std::regex measures(R"(TCH PROBE 481 TOOL LENGTH Q340=\+2 Q260=[-+0-9.]+ Q341=\+0)"),
        off(R"(FN 1[12]: IF \+Q115 (?:GT|LT) [-+0-9.]+ GOTO LBL \d+)"), go(R"(FN 9: IF \+0 EQU \+0 GOTO LBL (\d+))");
    if (matches(code, measures)) return measured() && (metric_ = motion_known_ = true);
    if (matches(code, off)) return true;
    if (matches(code, go)) return at_ = line_behind("LBL " + found_[1].str()), true;
    if (code[0] == 'L' && code[1] != 'B') {
      return straight(code);
    } else if (matches(code, begin)) {
      metric_ = true;
    } else if (matches(code, zero)) {
      zero_.at(std::size_t(found_[1].str()[0] - 'A')) = number(found_[2]);
    } else if (code == "TRANS DATUM RESET") {
      zero_ = {};
    } else if (matches(code, assign)) {
      const std::string name = found_[1];
      variables_[name] = number(found_[2]);
    } else if (matches(code, jump)) {
      const std::string label = "LBL " + found_[3].str();
      if (number(found_[1]) < number(found_[2])) at_ = line_behind(label);
    } else if (matches(code, tool)) {
      tool_ = std::stoi(found_[1]);
      length_ = true;
    } else if (matches(code, turn)) {
      turned_ = number(found_[1]);
    } else if (code == "FUNCTION RESET TCPM" || code == "FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS") {
      tip_ = code != "FUNCTION RESET TCPM";
    } else if (code == "M30") {
      walk_.ended = true;
    } else if (!matches(code, other) && !matches(code, harmless)) {
      return false;
    }
    return true;
  }

 private:
  bool straight(const std::string& code) {
    static const std::regex harmless(R"(R0|F[0-9.]+)");
    std::istringstream in(code);
    std::string w;
    in >> w;
    if (w != "L" && w != "LN") return false;
    const bool with_vector = w == "LN";
    std::array<double, 3> direction{};
    int said = 0;
    rapid_ = false;
    while (in >> w) {
      if (w == "FMAX") rapid_ = true;
      else if (w == "M91") next_.machine = true;
      else if (w[0] == 'T') direction.at(std::size_t(w[1] - 'X')) = number(w.substr(2)), ++said;
      else if (std::string("XYZABC").find(w[0]) != std::string::npos) set_axis(w[0], number(w.substr(1)));
      else if (!matches(w, harmless)) return false;
      if (w[0] == 'F' && w != "FMAX") feed_ = number(w.substr(1));
    }
    if (with_vector) next_.direction = direction;
    return said == (with_vector ? 3 : 0);
  }
};

/// Cutter locations (APT, ISO 3592): no machine, the tip and its axis in work coordinates.
class AptWalker : public Walker {
 protected:
  std::string uncommented(const std::string& line) const override { return stripped(line.substr(0, line.find("$$"))); }
  /// A statement that ends with $ goes on in the next line.
  void prepare() override {
    for (std::size_t k = 0; k + 1 < lines_.size(); ++k) {
      std::string& code = lines_[k].code;
      if (code.empty() || code.back() != '$') continue;
      lines_[k + 1] = {lines_[k].number, code.substr(0, code.size() - 1) + lines_[k + 1].code};
      code.clear();
    }
    motion_known_ = true;
  }
  bool execute(const std::string& code) override {
    static const std::regex tool(R"(LOADTL/(\d+),LENGTH,[0-9.]+)"),
        harmless(
            R"(PARTNO/.*|CUTTER/[0-9.,]+|SPINDL/(?:RPM,\d+,CLW|OFF)|COOLNT/(?:ON|OFF|FLOOD|MIST)|FEDRAT/[0-9.]+,MMPM|FINI)");
    if (code == "UNITS/MM") return metric_ = true;
    if (code == "MULTAX/ON") return tip_ = true;
    if (code == "RAPID") return once_ = true;
    if (code == "END") return walk_.ended = true;
    if (code.rfind("FEDRAT/", 0) == 0) feed_ = std::stod(code.substr(7));
    if (code.rfind("GOTO/", 0) != 0) {
      if (!matches(code, tool)) return matches(code, harmless);
      tool_ = std::stoi(found_[1]);
      return length_ = true;
    }
    std::istringstream in(code.substr(5));
    std::vector<double> numbers;
    for (std::string w; std::getline(in, w, ',');) numbers.push_back(number(w));
    if (numbers.size() != 6 || !tip_) return false;
    for (std::size_t k = 0; k < 3; ++k) next_.linear[k] = numbers[k];
    next_.direction = {numbers[3], numbers[4], numbers[5]};
    rapid_ = std::exchange(once_, false);
    return said_ = true;
  }

 private:
  bool once_ = false;
};

}  // namespace

NcWalk walk_nc(const std::string& text, const std::string& control) {
  if (control == "siemens") return SiemensWalker().run(text);
  if (control == "heidenhain") return HeidenhainWalker().run(text);
  if (control == "apt") return AptWalker().run(text);
  return IsoWalker(control == "linuxcnc").run(text);
}

}  // namespace toothpath::test
