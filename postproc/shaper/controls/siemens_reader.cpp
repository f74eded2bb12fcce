#include "postproc/shaper/controls/siemens_reader.h"

#include <fmt/format.h>

namespace toothpath::shaper {
namespace {

using Arguments = std::vector<std::string_view>;

/// The arguments of NAME(..), if the block is that.
std::optional<Arguments> arguments_of(std::string_view name, std::string_view s) {
  if (!s.starts_with(name) || s.size() <= name.size() || s[name.size()] != '(' || s.back() != ')') return {};
  std::string_view rest = s.substr(name.size() + 1, s.size() - name.size() - 2);
  Arguments list;
  while (true) {
    const auto comma = rest.find(',');
    list.push_back(rest.substr(0, comma));
    if (comma == std::string_view::npos) return list;
    rest.remove_prefix(comma + 1);
  }
}

class SiemensGearbox : public GearboxReader {
 public:
  using GearboxReader::GearboxReader;

 private:
  [[nodiscard]] std::vector<std::string_view> safe_start() const override {
    return {"G17", "G40", "G90", "G94", "G710", "G500"};
  }
  [[nodiscard]] bool idle_word(std::string_view word) const override { return word == "D0"; }
  /// C1=5 and X5.
  [[nodiscard]] std::optional<MotionWord> split(std::string_view word) const override {
    const auto equals = word.find('=');
    if (equals != std::string_view::npos) return MotionWord{word.substr(0, equals), word.substr(equals + 1)};
    return MotionWord{word.substr(0, 1), word.substr(1)};
  }

  bool own_block(std::string_view s) override {
    static constexpr struct {
      std::string_view name;
      void (SiemensGearbox::*read)(const Arguments&);
    } kCalls[] = {{"EGDEF", &SiemensGearbox::define},
                  {"EGON", &SiemensGearbox::couple_on},
                  {"EGOFS", &SiemensGearbox::couple_off},
                  {"EGDEL", &SiemensGearbox::forget},
                  {"WAITP", &SiemensGearbox::wait}};
    for (const auto& call : kCalls)
      if (const auto arguments = arguments_of(call.name, s)) {
        (this->*call.read)(*arguments);
        return true;
      }
    if (s == "OS[Z]=1") {
      ram_on();
    } else if (s == "OS[Z]=0") {
      stroke_off();
    } else if (s.starts_with("OSP1[Z]=") || s.starts_with("FA[Z]=")) {
      ram_words(s);
    } else {
      return false;
    }
    return true;
  }

  void define(const Arguments& a) {
    defined_ = a.size() == 3 && a[0] == w_.work_axis && a[1] == w_.cutter_axis && a[2] == "1";
    if (!defined_) problem("EGDEF must couple the work to the cutter's set values");
  }
  void couple_on(const Arguments& a) {
    const auto top = a.size() == 5 ? whole(a[3]) : std::nullopt, bottom = a.size() == 5 ? whole(a[4]) : std::nullopt;
    if (!defined_ || !top || !bottom || *bottom <= 0 || a[0] != w_.work_axis || a[1] != "\"FINE\"" ||
        a[2] != w_.cutter_axis)
      problem("EGON is not that of the definition before it, with a ratio of whole numbers");
    else couple(*top, *bottom);
  }
  void couple_off(const Arguments& a) {
    if (a.size() != 1 || a[0] != w_.work_axis) problem("EGOFS of another axis");
    uncouple();
  }
  void forget(const Arguments& a) {
    if (coupled() || a.size() != 1 || a[0] != w_.work_axis) problem("EGDEL before EGOFS, or of another axis");
  }
  void wait(const Arguments& a) {
    if (a.size() != 1 || a[0] != "Z") problem("WAITP of another axis");
    if (stroking()) problem("WAITP before the ram is switched off");
  }

  void ram_on() {
    const auto get = [&](const char* name) {
      const auto it = ram_.find(name);
      if (it == ram_.end()) problem(fmt::format("{} is missing before OS[Z]=1", name));
      return it == ram_.end() ? 0.0 : it->second;
    };
    const double from = get("OSP1[Z]"), to = get("OSP2[Z]"), speed = get("FA[Z]");
    if (get("OSE[Z]") != from) problem("the ram does not end at its start");
    stroke(from, to, speed);
  }
  void ram_words(std::string_view s) {
    for (const std::string_view word : words_of_block(s)) {
      const auto equals = word.find('=');
      const std::string_view name = word.substr(0, equals);
      if (equals != std::string_view::npos && name == "OSCTRL[Z]") continue;
      const auto value = equals == std::string_view::npos ? std::nullopt : micro(word.substr(equals + 1));
      if (value && (name == "OSP1[Z]" || name == "OSP2[Z]" || name == "FA[Z]" || name == "OSE[Z]"))
        ram_[std::string(name)] = double(*value) * 1e-6;
      else problem(fmt::format("\"{}\" is not understood", word));
    }
  }

  bool defined_ = false;
  std::map<std::string, double> ram_;
};

}  // namespace

GearboxReading read_siemens_gearbox(std::string_view text, const GearboxWords& words) {
  return SiemensGearbox(words).run(text);
}

}  // namespace toothpath::shaper
