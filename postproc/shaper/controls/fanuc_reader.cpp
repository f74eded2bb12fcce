#include "postproc/shaper/controls/fanuc_reader.h"

#include <cstdlib>

#include <fmt/format.h>

namespace toothpath::shaper {
namespace {

class FanucGearbox : public GearboxReader {
 public:
  using GearboxReader::GearboxReader;

 private:
  using Letters = std::map<char, std::string_view>;

  bool frame(std::string_view s) override {
    if (s == "%") ++percents_;
    return s == "%" || s.front() == 'O';
  }
  void close() override {
    if (percents_ != 2) problem("the program does not stand between two %");
  }
  [[nodiscard]] std::vector<std::string_view> safe_start() const override {
    return {"G21", "G17", "G90", "G94", "G40", "G49", "G80", "G69", "G54"};
  }
  /// X5. with its point.
  [[nodiscard]] std::optional<MotionWord> split(std::string_view word) const override {
    if (word.find('.') == std::string_view::npos) return {};
    return MotionWord{word.substr(0, 1), word.substr(1)};
  }

  bool own_block(std::string_view s) override {
    if (s == "G80") {
      stroke_off();
      return true;
    }
    const bool on = s.starts_with("G81.5 "), ram = s.starts_with("G81.1 "), off = s.starts_with("G80.5 ");
    if (!on && !ram && !off) return false;
    Letters words;
    for (const std::string_view word : words_of_block(s.substr(6)))
      if (!words.emplace(word.front(), word.substr(1)).second) problem(fmt::format("{} stands twice", word.front()));
    if (on) couple_on(words);
    else if (ram) ram_on(words);
    else couple_off(words);
    return true;
  }

  [[nodiscard]] char work() const { return w_.work_axis.front(); }
  static bool number(const Letters& words, char letter, std::int64_t& value) {
    const auto it = words.find(letter);
    const auto read = it == words.end() ? std::nullopt : micro(it->second);
    if (read) value = *read;
    return read.has_value();
  }

  void couple_off(const Letters& words) {
    std::int64_t zero = 1;
    if (!number(words, work(), zero) || zero != 0) problem("G80.5 of another axis");
    uncouple();
  }
  void ram_on(const Letters& words) {
    std::int64_t z = 0, q = 0, r = 1, f = 0;
    const bool all = number(words, 'Z', z) && number(words, 'Q', q) && number(words, 'R', r) && number(words, 'F', f) &&
                     words.size() == 4;
    if (!all || r != 0) problem("G81.1 needs Z, Q, R0. and F");
    else stroke(double(z) * 1e-6, double(z + q) * 1e-6, double(f) * 1e-6);
  }
  void couple_on(const Letters& words) {
    std::int64_t c = 0;
    const bool has_c = number(words, work(), c);
    if (words.contains('T') && words.contains('L') && words.size() == 3) {
      const auto t = whole(words.at('T')), l = whole(words.at('L'));
      if (!t || !l || !has_c || c != 0 || *t < 1 || *t > 1000 || *l == 0 || std::abs(*l) > 21)
        problem("G81.5 T 1..1000, L 1..21 with either sign, C0.");
      else couple(*l, *t);
    } else if (words.contains('P') && words.size() == 2) {
      const auto p = whole(words.at('P'));
      if (!p || *p < 1 || *p > 999999999 || !has_c || w_.pulses_per_turn < 1 || *p % w_.pulses_per_turn != 0 ||
          c % 360000000 != 0)
        problem("G81.5 P and C must be whole turns of both axes, P up to 999999999");
      else couple(c / 360000000, *p / w_.pulses_per_turn);
    } else {
      problem("G81.5 needs T, C and L, or P and C");
    }
  }

  int percents_ = 0;
};

}  // namespace

GearboxReading read_fanuc_gearbox(std::string_view text, const GearboxWords& words) {
  return FanucGearbox(words).run(text);
}

}  // namespace toothpath::shaper
