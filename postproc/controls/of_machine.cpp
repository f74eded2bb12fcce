#include "postproc/controls/of_machine.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "geometry/base/angle.h"
#include "postproc/controls/registry.h"
#include "postproc/text/tool_checks.h"
#include "postproc/timing/path_timer.h"

namespace toothpath::controls {
namespace {

/// n of "Mn", one to three digits without a leading zero; -1: another text.
int m_number(std::string_view word) {
  int n = -1;
  if (word.size() < 2 || word.size() > 4 || word[0] != 'M' || (word[1] == '0' && word.size() > 2)) return -1;
  const auto [end, error] = std::from_chars(word.data() + 1, word.data() + word.size(), n);
  return error == std::errc() && end == word.data() + word.size() && n >= 0 ? n : -1;
}

/// n of "M64 Pn" and "M65 Pn", 0 to 63; -1: another text.
int output_of(std::string_view word) {
  int n = -1;
  if (!word.starts_with("M64 P") && !word.starts_with("M65 P")) return -1;
  const auto [end, error] = std::from_chars(word.data() + 5, word.data() + word.size(), n);
  return error == std::errc() && end == word.data() + word.size() && word[5] != '-' && n < 64 ? n : -1;
}

/// Every rotary is at its zero at 0.
bool counts_from_zero(const machines::KinematicChain& chain) {
  for (std::size_t k = 0; k < chain.rotary_count(); ++k)
    if (chain.rotary(k).zero_rad != 0) return false;
  return true;
}

/// Judges a machine file by the words of its control, key by key.
class Judge {
 public:
  Judge(const machines::Machine& machine, const Control& control)
      : machine_(machine), control_(control), words_(control.words) {}

  std::vector<Diagnostic> errors() && {
    digits();
    corners();
    tcp();
    index_offset();
    rotary_offset();
    rollover();
    coolants();
    clamps();
    references();
    own_lines();
    tool_check();
    comments();
    return std::move(errors_);
  }

 private:
  template <typename... Args>
  void refuse(std::string_view key, fmt::format_string<Args...> text, Args&&... args) {
    errors_.push_back(fail_at(machine_.where(key), text, std::forward<Args>(args)...));
  }

  /// Where that line of a list stands.
  template <typename... Args>
  void refuse_line(const char* key, std::size_t line, fmt::format_string<Args...> text, Args&&... args) {
    const std::string element = fmt::format("{}[{}]", key, line);
    refuse(machine_.positions.contains(element) ? std::string_view(element) : key, text, std::forward<Args>(args)...);
  }

  void digits() {
    const auto look = [this](const char* key, const std::optional<int>& given) {
      if (given && (*given < 1 || *given > 7))
        refuse(key, "{} = {}: 1 to 7 decimals are possible in a word", key, *given);
    };
    look("post.linear_decimals", machine_.post.linear_decimals);
    look("post.rotary_decimals", machine_.post.rotary_decimals);
  }

  void corners() {
    const machines::PostSettings& post = machine_.post;
    const auto takes = [](const text::NcDialect& words) {
      return words.exact_path_mm > 0 || !words.corner_flow.empty();
    };
    if (post.corner_tolerance_mm && !takes(words_)) {
      std::string takers;
      for (const Control* c : all())
        if (takes(c->words)) takers += fmt::format("{}\"{}\"", takers.empty() ? "" : ", ", c->words.name);
      refuse("post.corner_tolerance", "post.corner_tolerance belongs to dialect {}, this is \"{}\"", takers,
             words_.name);
    }
    if (!post.smoothing_on.empty() && !words_.takes_smoothing)
      refuse("post.smoothing_on", "post.smoothing_on: dialect \"{}\" has its own words for what may be left of corners",
             words_.name);
  }

  void tcp() {
    if (machine_.tcp == machines::TcpMode::none) {
      if (words_.cutter_locations)
        refuse("tcp", "dialect \"{}\" carries tips and tool axes, no joints: tcp = \"vectors\" is supported",
               words_.name);
      return;
    }
    const machines::PostSettings& post = machine_.post;
    const bool on = !post.tcp_on.empty() || !words_.tcp_on.empty(),
               off = !post.tcp_off.empty() || !words_.tcp_off.empty();
    if (words_.tcp_codes_of_site && !(on && off))
      refuse("tcp", "tcp with dialect \"{}\" needs post.tcp_on and post.tcp_off: its codes are site data", words_.name);
    else if (!(on && off))
      refuse("tcp", "dialect \"{}\" has no TCP: tcp = \"none\" (joint output) is supported", words_.name);
    else if (words_.tcp_zero.empty() && words_.write == nullptr) zeros();
    if (on && off && machine_.tcp == machines::TcpMode::vectors && words_.vector_words[0].empty())
      refuse("tcp", "dialect \"{}\" has no tool vectors: tcp = \"none\" and \"angles\" are supported", words_.name);
  }

  /// TCP of a control that counts its rotaries from 0 alone.
  void zeros() {
    for (std::size_t k = 0; k < machine_.chain.rotary_count(); ++k)
      if (const machines::RotaryAxis& axis = machine_.chain.rotary(k); axis.zero_rad != 0)
        refuse(fmt::format("axes.{}.zero", axis.letter),
               "axes.{0}.zero = {1:g} deg: with TCP dialect \"{2}\" takes the {3} as {4} at {0} = 0; home {0} so that "
               "it is, with zero = 0, or take tcp = \"none\"",
               axis.letter, degrees(axis.zero_rad), words_.name, machine_.chain.in_table(k) ? "table" : "head",
               machine_.chain.in_table(k) ? "level and straight" : "upright");
  }

  void index_offset() {
    const std::string& name = machine_.post.index_offset;
    if (name.empty()) return;
    if (words_.loop.offset_on.empty())
      refuse("post.index_offset", "post.index_offset: dialect \"{}\" turns no work offset, leave it out", words_.name);
    else if (const Control* control = find(words_.name); control != nullptr && !control->offsets.has(name))
      refuse("post.index_offset", "post.index_offset = \"{}\" is none of {}", name, control->offsets.names);
  }

  void rotary_offset() {
    constexpr const char* kKey = "post.transformation_takes_rotary_offset";
    if (!machine_.post.transformation_takes_rotary_offset) return;
    if (words_.loop.zero_note.empty())
      refuse(kKey, "{}: dialect \"{}\" has no such machine data, leave it out", kKey, words_.name);
    else if (machine_.tcp != machines::TcpMode::angles)
      refuse(kKey, "{}: tcp = \"{}\" has no words that it changes, \"angles\" has; leave it out", kKey,
             machine_.tcp == machines::TcpMode::none ? "none" : "vectors");
    else if (machine_.chain.table.empty()) refuse(kKey, "{}: no rotary turns the work, leave it out", kKey);
  }

  void rollover() {
    if (words_.rollover.way != text::NcRollover::Way::none || words_.write != nullptr) return;
    for (std::size_t k = 0; k < machine_.chain.rotary_count(); ++k)
      if (const machines::RotaryAxis& axis = machine_.chain.rotary(k); axis.rollover)
        refuse(fmt::format("axes.{}.rollover", axis.letter),
               "axes.{}.rollover: dialect \"{}\" has no words for an axis that rolls over", axis.letter, words_.name);
  }

  /// What is wrong with a word of the builder; nothing: it can switch a coolant.
  [[nodiscard]] std::optional<std::string> fault_of(const std::string& word) const {
    const int n = m_number(word);
    if (n < 0) return fmt::format("\"{}\" is no M word such as M7", word);
    for (const auto& [first, last] : words_.own_m)
      if (n >= first && n <= last) return fmt::format("{} means something else to dialect \"{}\"", word, words_.name);
    const machines::PostSettings& post = machine_.post;
    for (const auto* codes : {&post.tcp_on, &post.tcp_off, &post.smoothing_on, &post.smoothing_off})
      if (std::find(codes->begin(), codes->end(), word) != codes->end())
        return fmt::format("{} is a code of TCP or smoothing in this file", word);
    return std::nullopt;
  }

  void coolants() {
    auto merged = words_.coolant;
    for (const auto& [coolant, given] : machine_.post.coolant) merged[coolant] = given;
    for (const auto& [coolant, given] : machine_.post.coolant) {
      const std::string key = fmt::format("post.coolant_{}", to_string(coolant));
      if (!words_.takes_coolant) {
        refuse(key, "{}: dialect \"{}\" has words of its own and no others", key, words_.name);
        continue;
      }
      for (const std::string& word : {given.on, given.off})
        if (const auto fault = fault_of(word)) refuse(key, "{}: {}", key, *fault);
      for (const auto& [other, used] : merged)
        if (given.on == used.off) {
          refuse(key, "{}: {} switches {} off", key, given.on, to_string(other));
          break;
        }
    }
  }

  /// What is wrong with a word that shall hold a rotary.
  [[nodiscard]] std::optional<std::string> fault_of_clamp(const std::string& word) const {
    if (words_.clamps_by_output && output_of(word) >= 0) return std::nullopt;
    const int n = m_number(word);
    const bool own = std::any_of(words_.clamp_m.begin(), words_.clamp_m.end(),
                                 [n](const auto& range) { return n >= range.first && n <= range.second; });
    if (own) return std::nullopt;
    if (words_.only_clamp_m)
      return fmt::format(
          "\"{}\" is none of M100 to M199, \"M64 P0\" and \"M65 P0\", which dialect \"{}\" leaves to the "
          "builder",
          word, words_.name);
    return fault_of(word);
  }
  /// Every word holds or releases one rotary, and is no other.
  void clamps() {
    std::map<std::string, std::string, std::less<>> taken;  // word -> what it switches
    for (const auto& list : {words_.coolant, machine_.post.coolant})
      for (const auto& [coolant, used] : list)
        for (const std::string& word : {used.on, used.off}) taken.emplace(word, to_string(coolant));
    for (std::size_t k = 0; k < machine_.chain.rotary_count(); ++k) {
      const machines::RotaryAxis& axis = machine_.chain.rotary(k);
      if (!axis.clamp) continue;
      const std::string key = fmt::format("axes.{}.clamp", axis.letter);
      if (words_.write != nullptr) {
        refuse(key, "{}: dialect \"{}\" has no words of a builder", key, words_.name);
        continue;
      }
      for (const std::string& word : {axis.clamp->on, axis.clamp->off}) {
        if (const auto fault = fault_of_clamp(word)) refuse(key, "{}: {}", key, *fault);
        else if (const auto [at, first] = taken.emplace(word, fmt::format("axes.{}", axis.letter)); !first)
          refuse(key, "{}: {} switches {}", key, word, at->second);
      }
    }
  }

  /// Lines of the shop name values that there are.
  void own_lines() {
    const machines::OwnLines& own = machine_.post.own_lines;
    const auto look = [&](const char* key, const std::vector<std::string>& lines, bool tool) {
      if (lines.empty()) return;
      if (words_.write != nullptr)
        return refuse(key, "{}: dialect \"{}\" takes no lines of the shop", key, words_.name);
      const auto names = text::names_of_own_lines(words_, tool);
      for (std::size_t k = 0; k < lines.size(); ++k)
        if (const auto name = text::unknown_name(lines[k], names))
          refuse_line(key, k, "{}: \"{}\" names {{{}}}, which is none of {{{}}}", key, lines[k], *name,
                      fmt::join(names, "} {"));
    };
    look("post.start", own.start, false);
    look("post.between_teeth", own.between_teeth, true);
    look("post.end", own.end, false);
    if (!own.tool_change) return;
    look("post.tool_change", *own.tool_change, true);
    const bool named = std::any_of(own.tool_change->begin(), own.tool_change->end(),
                                   [](const std::string& line) { return line.find("{tool}") != std::string::npos; });
    if (!named) refuse("post.tool_change", "post.tool_change names {{tool}} in no line: it must fetch the tool");
  }

  /// No line of the file has a comment that the control executes: nothing of it could be proven.
  void comments() {
    if (control_.acting_comment == nullptr) return;
    const machines::PostSettings& post = machine_.post;
    const auto look = [this](const char* key, const std::vector<std::string>& lines) {
      for (std::size_t k = 0; k < lines.size(); ++k)
        if (const auto found = control_.acting_comment(lines[k]))
          refuse_line(key, k, "{}: \"{}\", column {}: {}; leave it out", key, lines[k], found->column, found->text);
    };
    look("post.start", post.own_lines.start);
    look("post.tool_change", post.own_lines.tool_change.value_or(std::vector<std::string>{}));
    look("post.between_teeth", post.own_lines.between_teeth);
    look("post.end", post.own_lines.end);
    look("post.tcp_on", post.tcp_on);
    look("post.tcp_off", post.tcp_off);
    look("post.smoothing_on", post.smoothing_on);
    look("post.smoothing_off", post.smoothing_off);
    if (machine_.tool_check) look("tool_check.lines", machine_.tool_check->lines);
  }

  /// The setter stands within the travel, and the lines name values that there are; what they let pass is said.
  void tool_check() {
    if (!machine_.tool_check) return;
    const machines::ToolCheck& check = *machine_.tool_check;
    if (words_.write != nullptr)
      return refuse("tool_check", "tool_check: dialect \"{}\" has no words for it, leave the table out", words_.name);
    const std::vector<std::string>& lines = check.lines.empty() ? words_.check_lines : check.lines;
    if (lines.empty())
      refuse("tool_check",
             "tool_check: dialect \"{}\" has no documented cycle for it: tool_check.lines = [..] says what the control "
             "of this machine is called with",
             words_.name);
    const auto names = text::names_of_check_lines();
    bool tolerance = false;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      tolerance = tolerance || lines[k].find("{tolerance}") != std::string::npos;
      if (const auto name = text::unknown_name(lines[k], names))
        refuse_line("tool_check.lines", k, "tool_check.lines: \"{}\" names {{{}}}, which is none of {{{}}}", lines[k],
                    *name, fmt::join(names, "} {"));
    }
    if (!tolerance && !lines.empty() && !check.tolerance_mm)
      refuse("tool_check.lines",
             "tool_check.lines name no {{tolerance}}: tool_check.tolerance must say what they let pass");
    for (std::size_t a = 0; a < 2; ++a)
      if (const auto& axis = machine_.chain.linear[a];
          check.position_mm[static_cast<int>(a)] < axis.min_mm || check.position_mm[static_cast<int>(a)] > axis.max_mm)
        refuse("tool_check.position", "tool_check.position: {} = {:g} is outside its travel, {:g} to {:g}", "XY"[a],
               check.position_mm[static_cast<int>(a)], axis.min_mm, axis.max_mm);
  }

  /// G28 in the place of G53.
  void retract() {
    constexpr const char* kKey = "post.retract";
    if (words_.reference_retract.empty()) {
      std::string takers;
      for (const Control* c : all())
        if (!c->words.reference_retract.empty())
          takers += fmt::format("{}\"{}\"", takers.empty() ? "" : ", ", c->words.name);
      refuse(kKey, "post.retract = \"reference\" belongs to dialect {}, this is \"{}\"", takers, words_.name);
    } else if (machine_.post.reference_positions[0].empty()) {
      refuse(kKey,
             "post.retract = \"reference\": nothing says how high Z goes: post.reference_position = [X, Y, Z, "
             "rotaries] does");
    }
  }

  /// Every axis has a place, within its travel; Z that goes up to there has it at its top.
  void references() {
    const machines::KinematicChain& chain = machine_.chain;
    if (machine_.post.retracts_to_reference) retract();
    for (std::size_t n = 0; n < 2; ++n) {
      const std::vector<double>& place = machine_.post.reference_positions[n];
      if (place.empty()) continue;
      const char* const key = n == 0 ? "post.reference_position" : "post.second_reference_position";
      if (words_.write != nullptr) refuse(key, "{}: dialect \"{}\" has no words for it", key, words_.name);
      if (place.size() != 3 + chain.rotary_count()) {
        refuse(key, "{} has {} numbers, must have {}: X Y Z and the rotaries", key, place.size(),
               3 + chain.rotary_count());
        continue;
      }
      for (std::size_t a = 0; a < place.size(); ++a) {
        const bool linear = a < 3;
        const bool rolls = !linear && chain.rotary(a - 3).rollover;
        const double least = linear ? chain.linear[a].min_mm : rolls ? 0 : degrees(chain.rotary(a - 3).min_rad);
        const double most = linear ? chain.linear[a].max_mm : rolls ? 360 : degrees(chain.rotary(a - 3).max_rad);
        if (place[a] < least || place[a] > most || (rolls && place[a] == 360))
          refuse(key, "{}: {} = {:g} is outside its travel, {:g} to {:g}", key,
                 linear ? "XYZ"[a] : chain.rotary(a - 3).letter, place[a], least, most);
      }
    }
  }

  const machines::Machine& machine_;
  const Control& control_;
  const text::NcDialect& words_;
  std::vector<Diagnostic> errors_;
};

}  // namespace

std::vector<Diagnostic> judge(const machines::Machine& machine) {
  if (const Control* control = find(machine.dialect)) return Judge(machine, *control).errors();
  return {fail_at(machine.where("dialect"), "dialect = \"{}\" is not one of {}", machine.dialect, list_of_names())};
}

machines::MachineReading read_machine(const std::string& path) { return machines::read_machine_file(path, judge); }

machines::MachineReading read_machine_of_text(std::string_view text, const std::string& file) {
  return machines::read_machine_text(text, file, judge);
}

namespace {

/// Corners of a control that stops at them or states nothing: it flows where the machine file says by how much, and
/// around its own smoothing.
void apply_corners(text::NcDialect& d, const machines::PostSettings& post) {
  if (d.corner_flow.empty()) return;
  const std::string& usual = post.corner_tolerance_mm ? d.corner_flow : d.corner_stop;
  d.corner_mm = post.corner_tolerance_mm.value_or(0);
  std::replace(d.safe_start.begin(), d.safe_start.end(), d.corner_stop, usual);
  if (d.smoothing_on.empty()) return;
  d.smoothing_on.insert(d.smoothing_on.begin(), d.corner_flow);
  d.smoothing_off.push_back(usual);
}

/// The check of the machine, with lines of the control where the file has none.
std::optional<machines::ToolCheck> check_of(const machines::Machine& machine, const text::NcDialect& words) {
  auto check = machine.tool_check;
  if (check && check->lines.empty()) check->lines = words.check_lines;
  return check;
}

/// A control that states how far it leaves an exact path is one that stops there.
timing::Corners corners_of(const text::NcDialect& words, const machines::PostSettings& post) {
  if (words.exact_path_mm > 0) return timing::Corners::exact;
  const bool flows = words.corner_stop.empty() || post.corner_tolerance_mm || !post.smoothing_on.empty();
  return flows ? timing::Corners::jump : timing::Corners::stop;
}

}  // namespace

Result<text::NcDialect> dialect_of(const machines::Machine& machine) {
  if (auto errors = judge(machine); !errors.empty()) return std::move(errors.front());
  text::NcDialect d = find(machine.dialect)->words;
  const machines::PostSettings& post = machine.post;
  d.format.linear_decimals = post.linear_decimals.value_or(d.format.linear_decimals);
  d.format.rotary_decimals = post.rotary_decimals.value_or(d.format.rotary_decimals);
  if (d.exact_path_mm > 0) d.exact_path_mm = machine.exact_corner_mm();
  if (!d.loop.offset_on.empty() && post.index_offset.empty()) d.loop.frame_on = d.loop.frame_off = {};
  d.loop.index_offset = post.index_offset;
  if (!post.tcp_on.empty()) d.tcp_on = post.tcp_on;
  if (const Control* control = find(machine.dialect); control->tcp_notes != nullptr)
    d.tcp_notes = control->tcp_notes(machine.chain);
  if (!post.tcp_off.empty()) {
    d.tcp_off = post.tcp_off;
    if (!d.tcp_starts_at_zero) d.safe_start.insert(d.safe_start.end(), d.tcp_off.begin(), d.tcp_off.end());
  }
  if (post.transformation_takes_rotary_offset) {
    d.loop.zero_with_tcp = d.loop.zero_turns_frame = true;
    d.loop.frame_on = d.loop.frame_off = {};
    d.tcp_on.emplace_back("{zero_on}");  // behind the work offset: frames may be dropped
    d.tcp_off.emplace_back("{zero_on}");
  }
  if (!post.smoothing_on.empty()) {
    if (post.smoothing_off.empty() || !post.smoothing_tolerance_mm)  // a file without them is refused by its reader
      return fail_at(machine.where("post.smoothing_on"),
                     "post.smoothing_on needs post.smoothing_off and post.smoothing_tolerance");
    d.smoothing_on = post.smoothing_on;
    d.smoothing_off = post.smoothing_off;
    d.smoothing_mm = *post.smoothing_tolerance_mm;
    d.smoothing_axis_rad = post.smoothing_axis_tolerance_rad;
    d.blend = false;
    std::erase(d.start, "{corners}");
  }
  if (post.retracts_to_reference) d.retract = d.reference_retract;
  d.own_start = post.own_lines.start;
  d.own_between_teeth = post.own_lines.between_teeth;
  d.own_end = post.own_lines.end;
  if (post.own_lines.tool_change) d.tool_call = *post.own_lines.tool_change;
  apply_corners(d, post);
  d.tool_check = check_of(machine, d);
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) d.clamps[k] = machine.chain.rotary(k).clamp;
  for (const auto& [coolant, words] : post.coolant) d.coolant[coolant] = words;
  return d;
}

std::vector<std::string> trusted_zeros(const machines::Machine& machine, bool planes) {
  const Control* control = find(machine.dialect);
  if (control == nullptr || (!planes && machine.tcp == machines::TcpMode::none)) return {};
  const std::string& trust = planes ? control->words.planes.zero : control->words.tcp_zero;
  std::vector<std::string> out;
  for (std::size_t k = 0; k < machine.chain.rotary_count() && !trust.empty(); ++k)
    if (const machines::RotaryAxis& axis = machine.chain.rotary(k); axis.zero_rad != 0)
      out.push_back(fmt::format("axes.{}.zero = {:g} deg, {}", axis.letter, degrees(axis.zero_rad),
                                text::expanded(trust, {{"axis", std::string(1, axis.letter)}}).value_or(trust)));
  return out;
}

std::array<char, 5> axis_letters(const machines::Machine& machine) {
  std::array<char, 5> letters{'X', 'Y', 'Z', 0, 0};
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) letters[3 + k] = machine.chain.rotary(k).letter;
  return letters;
}

joints::AxisOptions axis_options(const text::NcDialect& words, const machines::Machine& machine) {
  joints::AxisOptions options;
  options.format = words.format;
  options.max_inverse_time = words.max_inverse_time;
  options.index_is_rounded = words.loop.form == text::NcLoop::Form::called;
  options.expand_teeth = !machine.post.index_loop.value_or(true) || words.loop.form == text::NcLoop::Form::none;
  options.tcp_starts_at_zero = words.tcp_starts_at_zero;
  options.cutter_locations = words.cutter_locations;
  options.corners = corners_of(words, machine.post);
  options.tcp_frame_is_table = words.loop.zero_turns_frame || (words.tcp_starts_at_zero && words.loop.zero_with_tcp);
  options.tcp_loop = !words.loop.frame_on.empty() || options.tcp_frame_is_table;
  if (!words.loop.offset_on.empty())
    options.no_tcp_loop =
        "with TCP this control turns a work offset, and post.index_offset names none that programs may overwrite";
  return options;
}

Result<readback::NcControl> control_of(const machines::Machine& machine, const joints::Setup& setup,
                                       std::span<const tool::ToolAssembly> tools) {
  const Control* control = find(machine.dialect);
  if (control == nullptr) return fail("dialect \"{}\" cannot be read back: {} can", machine.dialect, list_of_names());
  readback::NcControl c;
  c.execute = control->execute;
  c.cutter_locations = control->words.cutter_locations;
  c.corners = corners_of(control->words, machine.post);
  c.rotary_rounding_deg =
      0.5 * std::pow(10.0, -machine.post.rotary_decimals.value_or(control->words.format.rotary_decimals));
  if (control->words.max_inverse_time > 0) c.shortest_feed_minutes = 1 / control->words.max_inverse_time;
  if (machine.tcp != machines::TcpMode::none) c.chain = machine.chain;
  if (const text::NcPlanes& planes = control->words.planes; !planes.on.empty())
    if (!planes.zero.empty() || counts_from_zero(machine.chain)) c.plane_chain = machine.chain;
  c.top_mm = machine.top_mm();
  c.exact_path_mm = machine.exact_corner_mm();
  c.corner_mm = machine.post.corner_tolerance_mm;
  c.index_offset = machine.post.index_offset;
  c.transformation_takes_rotary_offset = machine.post.transformation_takes_rotary_offset;
  c.tcp_on = machine.post.tcp_on;
  c.tcp_off = machine.post.tcp_off;
  c.smoothing_on = machine.post.smoothing_on;
  c.smoothing_off = machine.post.smoothing_off;
  c.smoothing_mm = machine.post.smoothing_tolerance_mm.value_or(0);
  c.smoothing_axis_rad = machine.post.smoothing_axis_tolerance_rad;
  for (std::size_t n = 0; n < 2; ++n) {
    const std::vector<double>& place = machine.post.reference_positions[n];
    if (place.empty()) continue;
    c.reference[n].emplace();
    std::copy_n(place.begin(), std::min<std::size_t>(place.size(), 5), c.reference[n]->begin());
  }
  c.tool_check = check_of(machine, control->words);
  c.coolants = control->words.coolant;
  for (const auto& [coolant, words] : machine.post.coolant) {
    c.coolants[coolant] = words;
    c.coolant_words.insert(c.coolant_words.end(), {words.on, words.off});
  }
  c.letters = axis_letters(machine);
  for (std::size_t i = 0; i < 3; ++i) c.rapid_speed[i] = machine.chain.linear[i].max_speed;
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) {
    c.rapid_speed[3 + k] = degrees(machine.chain.rotary(k).max_speed);
    c.rollover[3 + k] = machine.chain.rotary(k).rollover;
    c.clamps[3 + k] = machine.chain.rotary(k).clamp;
  }
  for (const auto& t : tools) {
    if (!c.tool_length_mm.emplace(t.number, t.length_mm).second) return fail("tool number {} occurs twice", t.number);
    if (c.tool_check)
      c.check_tolerance_mm[t.number] =
          t.check_tolerance_mm > 0 ? t.check_tolerance_mm : c.tool_check->tolerance_mm.value_or(0);
    if (const auto cutter = tool::apt_cutter(t)) c.cutters[t.number] = *cutter;
  }
  c.work_offsets[setup.work_offset] = setup.work_offset_at_mm;
  return c;
}

std::optional<std::string> other_work_offsets(const machines::Machine& machine, std::string_view name) {
  const Control* control = find(machine.dialect);
  if (control == nullptr)
    return fmt::format("none that is known: \"{}\" is not one of {}", machine.dialect, list_of_names());
  if (!control->offsets.has(name)) return control->offsets.names;
  if (name != machine.post.index_offset) return std::nullopt;
  return fmt::format("{} without {}, which post.index_offset lets programs overwrite", control->offsets.names, name);
}

}  // namespace toothpath::controls
