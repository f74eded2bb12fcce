#include "postproc/shaper/gearbox_reader.h"

#include <charconv>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace toothpath::shaper {
namespace {


std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\r')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\r')) s.remove_suffix(1);
  return s;
}

/// A decimal number as micro-units, exactly; nothing if it has more than six decimals or is no number.
std::optional<std::int64_t> micro(std::string_view s) {
  const bool negative = s.starts_with('-');
  if (negative) s.remove_prefix(1);
  std::int64_t value = 0;
  int decimals = -1, digits = 0;
  for (const char c : s) {
    if (c == '.' && decimals < 0) {
      decimals = 0;
    } else if (c >= '0' && c <= '9' && digits < 15) {
      value = 10 * value + (c - '0');
      ++digits;
      if (decimals >= 0) ++decimals;
    } else {
      return {};
    }
  }
  if (digits == 0 || decimals > 6) return {};
  for (int k = std::max(decimals, 0); k < 6; ++k) value *= 10;
  return negative ? -value : value;
}

std::optional<std::int64_t> whole(std::string_view s) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (error != std::errc{} || end != s.data() + s.size()) return {};
  return value;
}

/// State of the control while it reads.
class Control {
 public:
  explicit Control(const GearboxWords& words) : w_(words) {}

  GearboxReading run(std::string_view text) {
    while (!text.empty()) {
      const auto end = text.find('\n');
      ++line_;
      block(trimmed(text.substr(0, end)));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    if (!ended_) problem("the program has no M30");
    if (coupled_) problem("the gearbox is still coupled at the end");
    if (stroking_) problem("the ram still strokes at the end");
    if (relief_) problem("the relief is still on at the end");
    if (!w_.siemens && percents_ != 2) problem("the program does not stand between two %");
    return std::move(out_);
  }

 private:
  void problem(const std::string& what) { out_.problems.push_back(fmt::format("line {}: {}", line_, what)); }

  void block(std::string_view s) {
    if (!w_.siemens && s == "%") {
      ++percents_;
      return;
    }
    if (s.empty() || s.front() == ';' || (s.front() == '(' && s.back() == ')')) return;
    if (s.front() == 'O' && !w_.siemens) return;
    if (ended_) return problem("text after M30");
    if (s == w_.relief_on) return set(relief_, true, "relief");
    if (s == w_.relief_off) {
      if (stroking_) problem("the relief goes off while the ram strokes");
      return set(relief_, false, "relief");
    }
    if (s == "M30") {
      ended_ = true;
      return;
    }
    if (s.starts_with("G17 ") || s.starts_with("G21 ")) return start(s);
    if (w_.siemens ? siemens(s) : fanuc(s)) return;
    motion(s);
  }

  void set(bool& flag, bool to, const char* what) {
    if (flag == to) problem(fmt::format("the {} is {} already", what, to ? "on" : "off"));
    flag = to;
  }

  void start(std::string_view s) {
    for (const char* word : w_.siemens ? std::vector{"G17", "G40", "G90", "G94", "G710", "G500"} : std::vector{"G21", "G17", "G90", "G94", "G40", "G49", "G80", "G69"})
      if ((" " + std::string(s) + " ").find(" " + std::string(word) + " ") == std::string::npos) problem(fmt::format("{} is missing in the safe start", word));
    started_ = true;
  }

  void couple(std::int64_t work, std::int64_t cutter) {
    if (coupled_) problem("coupled twice");
    if (stroking_) problem("the gearbox is coupled while the ram strokes");
    if (cutter_ != 0) problem("the gearbox is coupled away from zero");
    coupled_ = true;
    out_.ratio = GearboxRatio{work, cutter};
    out_.clear_before_mm = x_;
  }
  void uncouple() {
    if (!coupled_) problem("uncoupled, but not coupled");
    if (stroking_) problem("uncoupled while the ram strokes");
    coupled_ = false;
    out_.clear_after_mm = x_;
  }
  void stroke(double from, double to, double speed) {
    if (!coupled_) problem("the ram strokes without gearbox");
    if (!relief_) problem("the ram strokes without relief");
    set(stroking_, true, "ram");
    out_.stroke_start_mm = from;
    out_.stroke_end_mm = to;
    out_.strokes_per_minute = from != to ? speed / (2 * std::abs(from - to)) : 0;
    out_.slide_mm = y_;
    if (std::abs(z_ - from) > kPlace) problem("the ram does not wait at its start");
  }

  /// Words that only the one control has; false: an ordinary motion.
  bool siemens(std::string_view s) {
    const auto inside = [&](std::string_view name) -> std::optional<std::vector<std::string_view>> {
      if (!s.starts_with(name) || s.size() <= name.size() || s[name.size()] != '(' || s.back() != ')') return {};
      std::string_view arguments = s.substr(name.size() + 1, s.size() - name.size() - 2);
      std::vector<std::string_view> list;
      while (true) {
        const auto comma = arguments.find(',');
        list.push_back(arguments.substr(0, comma));
        if (comma == std::string_view::npos) return list;
        arguments.remove_prefix(comma + 1);
      }
    };
    if (const auto a = inside("EGDEF")) {
      defined_ = a->size() == 3 && (*a)[0] == w_.work_axis && (*a)[1] == w_.cutter_axis && (*a)[2] == "1";
      if (!defined_) problem("EGDEF must couple the work to the cutter's set values");
      return true;
    }
    if (const auto a = inside("EGON")) {
      const auto top = a->size() == 5 ? whole((*a)[3]) : std::nullopt, bottom = a->size() == 5 ? whole((*a)[4]) : std::nullopt;
      if (!defined_ || !top || !bottom || *bottom <= 0 || (*a)[0] != w_.work_axis || (*a)[1] != "\"FINE\"" || (*a)[2] != w_.cutter_axis)
        problem("EGON is not that of the definition before it, with a ratio of whole numbers");
      else
        couple(*top, *bottom);
      return true;
    }
    if (const auto a = inside("EGOFS")) {
      if (a->size() != 1 || (*a)[0] != w_.work_axis) problem("EGOFS of another axis");
      uncouple();
      return true;
    }
    if (const auto a = inside("EGDEL")) {
      if (coupled_ || a->size() != 1 || (*a)[0] != w_.work_axis) problem("EGDEL before EGOFS, or of another axis");
      return true;
    }
    if (s == "WAITP(Z)") {
      if (stroking_) problem("WAITP before the ram is switched off");
      return true;
    }
    if (s == "OS[Z]=1") {
      const auto get = [&](const char* name) {
        const auto it = ram_.find(name);
        if (it == ram_.end()) problem(fmt::format("{} is missing before OS[Z]=1", name));
        return it == ram_.end() ? 0.0 : it->second;
      };
      const double from = get("OSP1[Z]"), to = get("OSP2[Z]"), speed = get("FA[Z]");
      if (get("OSE[Z]") != from) problem("the ram does not end at its start");
      stroke(from, to, speed);
      return true;
    }
    if (s == "OS[Z]=0") {
      set(stroking_, false, "ram");
      return true;
    }
    if (s.starts_with("OSP1[Z]=") || s.starts_with("FA[Z]=")) {
      for (std::string_view rest = s; !rest.empty();) {
        const auto space = rest.find(' ');
        const std::string_view word = rest.substr(0, space);
        rest = space == std::string_view::npos ? std::string_view() : rest.substr(space + 1);
        const auto equals = word.find('=');
        if (equals == std::string_view::npos) {
          problem(fmt::format("\"{}\" is not understood", word));
          continue;
        }
        const auto name = word.substr(0, equals);
        if (name == "OSCTRL[Z]") continue;
        const auto value = micro(word.substr(equals + 1));
        if (value && (name == "OSP1[Z]" || name == "OSP2[Z]" || name == "FA[Z]" || name == "OSE[Z]"))
          ram_[std::string(name)] = double(*value) * 1e-6;
        else
          problem(fmt::format("\"{}\" is not understood", word));
      }
      return true;
    }
    return false;
  }

  bool fanuc(std::string_view s) {
    if (s == "G80") {
      set(stroking_, false, "ram");
      return true;
    }
    const bool couple_block = s.starts_with("G81.5 "), stroke_block = s.starts_with("G81.1 "), off_block = s.starts_with("G80.5 ");
    if (!couple_block && !stroke_block && !off_block) return false;
    std::map<char, std::string_view> word;
    for (std::string_view rest = s.substr(6); !rest.empty();) {
      const auto space = rest.find(' ');
      const std::string_view one = rest.substr(0, space);
      rest = space == std::string_view::npos ? std::string_view() : rest.substr(space + 1);
      if (!one.empty() && !word.emplace(one.front(), one.substr(1)).second) problem(fmt::format("{} stands twice", one.front()));
    }
    const char work = w_.work_axis.front();
    const auto number = [&](char letter, std::int64_t& value) {
      const auto it = word.find(letter);
      if (it == word.end()) return false;
      const auto read = micro(it->second);
      if (read) value = *read;
      return read.has_value();
    };
    if (off_block) {
      std::int64_t zero = 1;
      if (!number(work, zero) || zero != 0) problem("G80.5 of another axis");
      uncouple();
      return true;
    }
    if (stroke_block) {
      std::int64_t z = 0, q = 0, r = 1, f = 0;
      const bool whole_block = number('Z', z) && number('Q', q) && number('R', r) && number('F', f) && word.size() == 4;
      if (!whole_block || r != 0) problem("G81.1 needs Z, Q, R0. and F");
      else stroke(double(z) * 1e-6, double(z + q) * 1e-6, double(f) * 1e-6);
      return true;
    }
    std::int64_t c = 0;
    const bool has_c = number(work, c);
    if (word.count('T') && word.count('L') && word.size() == 3) {
      const auto t = whole(word['T']), l = whole(word['L']);
      if (!t || !l || !has_c || c != 0 || *t < 1 || *t > 1000 || *l == 0 || std::abs(*l) > 21) problem("G81.5 T 1..1000, L 1..21 with either sign, C0.");
      else couple(*l, *t);
    } else if (word.count('P') && word.size() == 2) {
      const auto p = whole(word['P']);
      if (!p || *p < 1 || *p > 999999999 || !has_c || w_.pulses_per_turn < 1 || *p % w_.pulses_per_turn != 0 || c % 360000000 != 0)
        problem("G81.5 P and C must be whole turns of both axes, P up to 999999999");
      else
        couple(c / 360000000, *p / w_.pulses_per_turn);
    } else {
      problem("G81.5 needs T, C and L, or P and C");
    }
    return true;
  }

  void motion(std::string_view s) {
    bool rapid = rapid_, direct = false, seen_g93 = false, seen_g94 = false, moved = false;
    double x = x_, y = y_, z = z_, feed = 0;
    std::int64_t cutter = cutter_;
    bool work_said = false;
    std::string said;
    for (std::string_view rest = s; !rest.empty();) {
      const auto space = rest.find(' ');
      const std::string_view word = rest.substr(0, space);
      rest = space == std::string_view::npos ? std::string_view() : rest.substr(space + 1);
      if (word.empty()) continue;
      if (word == "G0") rapid = true;
      else if (word == "G1") rapid = false;
      else if (word == "G93") seen_g93 = true;
      else if (word == "G94") seen_g94 = true;
      else if (word == "SUPA" || word == "G53") direct = true;
      else if (word == "D0" && w_.siemens) continue;
      else {
        std::string_view name, number;
        if (w_.siemens && word.find('=') != std::string_view::npos) {
          name = word.substr(0, word.find('='));
          number = word.substr(word.find('=') + 1);
        } else {
          name = word.substr(0, 1);
          number = word.substr(1);
        }
        const auto value = micro(number);
        if (!value || (!w_.siemens && number.find('.') == std::string_view::npos)) {
          problem(fmt::format("\"{}\" is not understood", word));
          continue;
        }
        const double v = double(*value) * 1e-6;
        if (said.find(name) != std::string::npos) problem(fmt::format("{} stands twice", name));
        said += std::string(name) + " ";
        if (name == w_.cutter_axis) cutter = *value, moved = true;
        else if (name == w_.work_axis) work_said = true;
        else if (name == "X") x = v, moved = true;
        else if (name == "Y") y = v, moved = true;
        else if (name == "Z") z = v, moved = true;
        else if (name == "F") feed = v;
        else problem(fmt::format("\"{}\" is not understood", word));
      }
    }
    if (seen_g93) inverse_ = true;
    if (seen_g94) inverse_ = false;
    if (!started_) problem("motion before the safe start");
    if (first_ && (!direct || x == x_)) problem("the first motion is not the infeed slide in machine coordinates");
    first_ = false;
    if (!moved && !work_said) problem("a block without words");
    if (!rapid && !(feed > 0)) problem("a feed move without F");
    if (rapid && (coupled_ || stroking_)) problem("a rapid while the gearbox runs");
    if (work_said && coupled_) problem("the work is moved by a word while it is coupled");
    if (stroking_ && (y != y_ || z != z_)) problem("offset slide or ram moved by a word while the ram strokes");
    if (stroking_ && coupled_) {
      const double way = x != x_ && cutter == cutter_ ? std::abs(x - x_) : std::abs(double(cutter - cutter_)) * 1e-6;
      if (x != x_ && cutter != cutter_ && !inverse_) problem("infeed and cutter together need G93");
      const double minutes = feed > 0 ? (inverse_ ? 1 / feed : way / feed) : 0;
      out_.moves.push_back({line_, x_, x, cutter_, cutter, minutes});
    }
    rapid_ = rapid;
    x_ = x;
    y_ = y;
    z_ = z;
    cutter_ = cutter;
  }

  const GearboxWords& w_;
  GearboxReading out_;
  int line_ = 0, percents_ = 0;
  bool started_ = false, first_ = true, ended_ = false, rapid_ = true, inverse_ = false;
  bool coupled_ = false, stroking_ = false, relief_ = false, defined_ = false;
  double x_ = -1e9, y_ = 0, z_ = 0;
  std::int64_t cutter_ = 0;
  std::map<std::string, double> ram_;
};

}  // namespace

GearboxReading read_gearbox_program(std::string_view text, const GearboxWords& words) { return Control(words).run(text); }

}  // namespace toothpath::shaper
