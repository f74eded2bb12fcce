#include "postproc/readback/iso/flow.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "postproc/tool_check/lines.h"

namespace toothpath::iso {
namespace {
constexpr std::size_t kDeepestCall = 8;
constexpr std::size_t kMostParsed = 1 << 19;  // lines of loops and sub-programs that are kept parsed

/// Names that LinuxCNC keeps to itself: a program cannot set them.
constexpr std::string_view kOwnNames[] = {"_vmajor",
                                          "_vminor",
                                          "_line",
                                          "_motion_mode",
                                          "_plane",
                                          "_ccomp",
                                          "_metric",
                                          "_imperial",
                                          "_absolute",
                                          "_incremental",
                                          "_inverse_time",
                                          "_units_per_minute",
                                          "_units_per_rev",
                                          "_coord_system",
                                          "_tool_offset",
                                          "_retract_r_plane",
                                          "_retract_old_z",
                                          "_spindle_rpm_mode",
                                          "_spindle_css_mode",
                                          "_ijk_absolute_mode",
                                          "_lathe_diameter_mode",
                                          "_lathe_radius_mode",
                                          "_spindle_on",
                                          "_spindle_cw",
                                          "_mist",
                                          "_flood",
                                          "_speed_override",
                                          "_feed_override",
                                          "_adaptive_feed",
                                          "_feed_hold",
                                          "_feed",
                                          "_rpm",
                                          "_x",
                                          "_y",
                                          "_z",
                                          "_a",
                                          "_b",
                                          "_c",
                                          "_u",
                                          "_v",
                                          "_w",
                                          "_abs_x",
                                          "_abs_y",
                                          "_abs_z",
                                          "_abs_a",
                                          "_abs_b",
                                          "_abs_c",
                                          "_current_tool",
                                          "_current_pocket",
                                          "_selected_tool",
                                          "_selected_pocket",
                                          "_value",
                                          "_value_returned",
                                          "_task",
                                          "_call_level",
                                          "_remap_level"};
}  // namespace

NcFlow::NcFlow(std::string_view text, const std::string& file, bool o_words, const readback::NcControl& control)
    : file_(file),
      o_words_(o_words),
      check_lines_(control.tool_check ? control.tool_check->lines.size() : 0),
      max_steps_(control.max_steps),
      max_idle_(control.max_idle) {
  split(text);
  parameters_.assign(kLastParameter + 1, 0);
  parameter_set_.assign(kLastParameter + 1, false);
}

Status NcFlow::run(const Words& words) {
  if (auto bad = find_labels()) return *bad;
  std::size_t steps = 0;
  while (!ended_) {
    if (pc_ >= lines_.size())
      return at(lines_.size(), 0, o_words_ ? "the program ends without M2 or M30" : "the program ends without M30");
    if (++steps > max_steps_) return at(pc_ + 1, 0, readback::too_many_blocks(max_steps_));
    if (++idle_ > max_idle_)
      return at(pc_ + 1, 0, fmt::format("more than {} executed blocks in a row without a move", max_idle_));
    line_ = pc_++;
    const auto [block, problem] = fetch(line_);
    if (block == nullptr) return problem;
    const NcBlock& b = *block;
    std::optional<Diagnostic> bad;
    if (b.aborts) return here(1, "(ABORT, ..) ends the program there: what stands behind it is not executed");
    if (b.percent) {
      if (line_ != 0) return here(1, "the program ends without M2 or M30");
    } else if (b.o_word != OWord::none) {
      bad = o_word(b);
    } else if (!b.words.empty() && (b.words.front().letter == '#' || b.words.front().letter == '<')) {
      bad = assign(b);
    } else {
      bad = words(b);
    }
    if (bad) return *bad;
  }
  return after_end();
}

Diagnostic NcFlow::at(std::size_t line, int column, std::string message) const {
  return {DiagnosticKind::refused_input, {file_, static_cast<int>(line), column}, std::move(message)};
}

bool NcFlow::has_lines(double number) const {
  const auto found = numbers_.find(static_cast<std::int64_t>(std::abs(number) < 1e9 ? number : -1));
  return number == std::floor(number) && found != numbers_.end() && found->second < lines_.size();
}
std::optional<Diagnostic> NcFlow::call_lines(double number) {
  return enter(numbers_.at(static_cast<std::int64_t>(number)));
}
std::optional<Diagnostic> NcFlow::call_program(std::int64_t number) { return enter(labels_.at(number) + 1); }
std::optional<Diagnostic> NcFlow::enter(std::size_t line) {
  if (frames_.size() >= kDeepestCall) return here(1, fmt::format("calls nest deeper than {}", kDeepestCall));
  Frame f;
  f.kind = OWord::program;
  f.begin = pc_;
  frames_.push_back(f);
  pc_ = line;
  return std::nullopt;
}

std::optional<Diagnostic> NcFlow::return_from_program(int column) {
  if (frames_.empty()) return here(column, "M99 outside a sub-program");
  pc_ = frames_.back().begin;
  frames_.pop_back();
  return std::nullopt;
}

void NcFlow::split(std::string_view text) {
  std::size_t begin = 0;
  lines_.reserve(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')) + 1);
  while (begin < text.size()) {
    std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) end = text.size();
    std::string_view line = text.substr(begin, end - begin);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines_.push_back(line);
    begin = end + 1;
  }
}
/// Parsed line; lines of sub-programs and loops are parsed once, up to kMostParsed of them.
std::pair<const NcBlock*, Diagnostic> NcFlow::fetch(std::size_t line) {
  if (const auto found = cache_.find(line); found != cache_.end()) return {&found->second, {}};
  auto block = parse_nc_block(lines_[line], o_words_);
  if (!block) {
    Diagnostic d = block.error();
    d.position.file = file_;
    d.position.line = static_cast<int>(line) + 1;
    return {nullptr, d};
  }
  find_names(*block);
  if (frames_.empty() || cache_.size() >= kMostParsed) {
    once_ = std::move(*block);
    return {&once_, {}};
  }
  return {&cache_.emplace(line, std::move(*block)).first->second, {}};
}

/// Names become parameters behind the numbered ones; one that begins with _ is the same in all sub-programs.
void NcFlow::find_names(NcBlock& block) {
  if (block.names.empty()) return;
  const auto place = [&](std::size_t of_block) {
    const std::string& name = block.names[of_block];
    const auto [entry, fresh] = names_.emplace(name, parameters_.size());
    if (fresh) {
      parameters_.push_back(0);
      parameter_set_.push_back(false);
      if (std::find(std::begin(kOwnNames), std::end(kOwnNames), name) != std::end(kOwnNames))
        own_.insert(entry->second);
      if (name.front() != '_') locals_.push_back(entry->second);
    }
    return entry->second;
  };
  for (NcStep& step : block.steps)
    if (step.kind == NcStep::Kind::named)
      step = {NcStep::Kind::parameter, static_cast<double>(place(static_cast<std::size_t>(step.value)))};
  for (NcWord& word : block.words)
    if (word.letter == '<') {
      word.letter = '#';
      word.index = static_cast<std::int32_t>(place(static_cast<std::size_t>(word.index)));
    }
}

std::optional<Diagnostic> NcFlow::find_labels() {
  std::vector<std::pair<OWord, std::int64_t>> open;
  std::vector<std::size_t> open_line;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const std::string_view line = beginning(lines_[i], o_words_);
    if (line.empty()) continue;
    if (check_lines_ > 0 && tool_check::checked_tool(lines_[i]) >= 0) {
      i += check_lines_;
      continue;
    }
    const char c = line[0];
    if (c == '%') percents_.push_back(i);
    if (c == 'N' && !o_words_) note_number(i, line.substr(1));
    if (c != 'o' && c != 'O') continue;
    auto block = parse_nc_block(lines_[i], o_words_);
    if (!block) {
      Diagnostic d = block.error();
      d.position.file = file_;
      d.position.line = static_cast<int>(i) + 1;
      return d;
    }
    const auto closes = [&](OWord head) -> std::optional<Diagnostic> {
      if (open.empty() || open.back() != std::pair{head, block->o_number})
        return at(i + 1, 1, fmt::format("o{} closes nothing", block->o_number));
      ends_[open_line.back()] = i;
      open.pop_back();
      open_line.pop_back();
      return std::nullopt;
    };
    switch (block->o_word) {
      case OWord::program:
        if (!labels_.emplace(block->o_number, i).second)
          return at(i + 1, 1, fmt::format("O{} occurs twice", block->o_number));
        break;
      case OWord::sub:
        if (!open.empty()) return at(i + 1, 1, "sub inside another o-word");
        if (!labels_.emplace(block->o_number, i).second)
          return at(i + 1, 1, fmt::format("o{} occurs twice", block->o_number));
        [[fallthrough]];
      case OWord::loop_while:
      case OWord::repeat:
        open.emplace_back(block->o_word, block->o_number);
        open_line.push_back(i);
        break;
      case OWord::endsub:
        if (auto bad = closes(OWord::sub)) return bad;
        break;
      case OWord::endwhile:
        if (auto bad = closes(OWord::loop_while)) return bad;
        break;
      case OWord::endrepeat:
        if (auto bad = closes(OWord::repeat)) return bad;
        break;
      default: break;
    }
  }
  if (!open.empty()) return at(open_line.back() + 1, 1, fmt::format("o{} is never closed", open.back().second));
  return check_percents();
}

void NcFlow::note_number(std::size_t line, std::string_view text) {
  std::int64_t n = -1;
  if (std::from_chars(text.data(), text.data() + text.size(), n).ec != std::errc{}) return;
  const auto [entry, fresh] = numbers_.emplace(n, line);
  if (!fresh) entry->second = lines_.size();
}

std::optional<Diagnostic> NcFlow::check_percents() const {
  const bool first = !percents_.empty() && percents_.front() == 0;
  if (percents_.size() == 1 || percents_.size() > 2 || (percents_.size() == 2 && !first))
    return at(percents_.back() + 1, 1, "% must stand in the first and in the last line");
  if (!o_words_ && percents_.size() != 2) return at(1, 1, "the program does not stand between % and %");
  return std::nullopt;
}

/// Behind the end there may be comments and, on Fanuc, sub-programs.
Status NcFlow::after_end() {
  if (!o_words_) return Ok{};
  for (std::size_t i = line_ + 1; i < lines_.size(); ++i) {
    auto block = parse_nc_block(lines_[i], true);
    if (!block || !block->words.empty() || block->o_word != OWord::none)
      return at(i + 1, 1, "text behind the end of the program is not executed");
  }
  return Ok{};
}

const double* NcFlow::parameter(int n) const {
  return parameter_set_[static_cast<std::size_t>(n)] ? &parameters_[static_cast<std::size_t>(n)] : nullptr;
}
std::string NcFlow::name_of(std::size_t parameter) const {
  for (const auto& [name, place] : names_)
    if (place == parameter) return fmt::format("#<{}>", name);
  return fmt::format("#{}", parameter);
}
Result<double> NcFlow::value(const NcBlock& b, const NcValue& v, int column) const {
  int unset = -1;
  auto r = evaluate(b, v, [&](int n) {
    const double* found = parameter(n);
    if (found == nullptr) unset = n;
    return found;
  });
  if (!r && unset > kLastOfProgram)
    return here(column, fmt::format("parameter {} was never set by the program: what the control itself puts there is "
                                    "not known here",
                                    name_of(static_cast<std::size_t>(unset))));
  if (!r) return here(column, r.error().message);
  if (!std::isfinite(*r) || std::abs(*r) > 1e9) return here(column, "value is not a number below 1e9");
  return r;
}

std::optional<Diagnostic> NcFlow::assign(const NcBlock& b) {
  std::vector<double> values;  // none is set before all are known
  for (const auto& w : b.words) {
    if (w.letter != '#') return here(w.column, "a word in a line of assignments");
    const auto place = static_cast<std::size_t>(w.index);
    if (own_.count(place) != 0 || (w.index > kLastOfProgram && w.index <= kLastParameter))
      return here(w.column,
                  fmt::format("{} is the control's own and cannot be set", name_of(static_cast<std::size_t>(w.index))));
    const auto v = value(b, w.value, w.column);
    if (!v) return v.error();
    values.push_back(*v);
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    set_parameter(static_cast<std::size_t>(b.words[i].index), values[i], true);
  return std::nullopt;
}

std::optional<Diagnostic> NcFlow::o_word(const NcBlock& b) {
  switch (b.o_word) {
    case OWord::program:
      if (started_) return here(1, "the program runs into a sub-program");
      started_ = true;
      return std::nullopt;
    case OWord::sub:
      pc_ = ends_.at(line_) + 1;  // a definition is stepped over
      return std::nullopt;
    case OWord::endsub: return end_call();
    case OWord::call: return call(b);
    case OWord::loop_while:
    case OWord::repeat: return loop_head(b);
    case OWord::endwhile:
    case OWord::endrepeat:
      if (frames_.empty() || frames_.back().number != b.o_number) return here(1, "end of a loop that is not running");
      if (auto endless = turns_.back_to(frames_.back().begin)) return here(1, std::move(*endless));
      pc_ = frames_.back().begin;
      return std::nullopt;
    case OWord::none: break;
  }
  return std::nullopt;
}

std::optional<Diagnostic> NcFlow::call(const NcBlock& b) {
  const auto label = labels_.find(b.o_number);
  if (label == labels_.end()) return here(1, fmt::format("o{} is not defined", b.o_number));
  if (frames_.size() >= kDeepestCall) return here(1, fmt::format("calls and loops nest deeper than {}", kDeepestCall));
  if (label->second >= line_) return here(1, fmt::format("o{} is called before it is defined", b.o_number));
  Frame f;
  f.kind = OWord::call;
  f.number = b.o_number;
  f.begin = pc_;
  for (std::size_t i = 0; i < 30; ++i) {
    f.saved[i] = parameters_[i + 1];
    f.saved_set[i] = parameter_set_[i + 1];
  }
  std::array<double, 30> arguments{};
  for (std::size_t i = 0; i < b.arguments.size(); ++i) {
    const auto v = value(b, b.arguments[i], 1);
    if (!v) return v.error();
    arguments[i] = *v;
  }
  for (std::size_t i = 0; i < 30; ++i) { set_parameter(i + 1, arguments[i], i < b.arguments.size()); }
  for (const std::size_t n : locals_) {
    if (parameter_set_[n]) f.locals.emplace_back(n, parameters_[n]);
    set_parameter(n, 0, false);
  }
  frames_.push_back(f);
  pc_ = label->second + 1;
  return std::nullopt;
}

std::optional<Diagnostic> NcFlow::end_call() {
  if (frames_.empty() || frames_.back().kind != OWord::call) return here(1, "end of a sub-program that is not running");
  const Frame& f = frames_.back();
  for (std::size_t i = 0; i < 30; ++i) { set_parameter(i + 1, f.saved[i], f.saved_set[i]); }
  for (const std::size_t n : locals_) set_parameter(n, 0, false);
  for (const auto& [n, value] : f.locals) set_parameter(n, value, true);
  pc_ = f.begin;
  frames_.pop_back();
  return std::nullopt;
}

void NcFlow::set_parameter(std::size_t n, double value, bool set) {
  const auto print = [n](double v) {
    std::uint64_t x = std::bit_cast<std::uint64_t>(v) + 0x9E3779B97F4A7C15 * (n + 1);
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EB;
    return x ^ (x >> 31);
  };
  if (parameter_set_[n]) print_ ^= print(parameters_[n]);
  parameters_[n] = value;
  parameter_set_[n] = set;
  if (set) print_ ^= print(value);
}

/// What a program does next follows from its place and its parameters alone: a while loop that finds all of them as
/// they were some turns before goes on for ever. Compared with turn 1, 2, 4, 8 .. (Brent), so that cycles of any length
/// are found.
bool NcFlow::comes_round(Frame& loop) const {
  if (loop.turns > 0 && loop.marked_print == print_ && loop.marked_set == parameter_set_ && loop.marked == parameters_)
    return true;
  if (std::has_single_bit(++loop.turns)) {
    loop.marked = parameters_;
    loop.marked_set = parameter_set_;
    loop.marked_print = print_;
  }
  return false;
}

/// A loop that is not entered, and would have ended the program.
void NcFlow::note_zeros(const NcBlock& head) {
  if (head.o_word != OWord::loop_while) return;
  const auto parameters = squares_above_zero(head, head.arguments.front());
  const auto first = parse_nc_block(lines_[line_ + 1], o_words_);
  if (first && first->aborts) zeros_.insert(parameters.begin(), parameters.end());
}

std::optional<Diagnostic> NcFlow::loop_head(const NcBlock& b) {
  const auto v = value(b, b.arguments.front(), 1);
  if (!v) return v.error();
  const bool running = !frames_.empty() && frames_.back().kind == b.o_word && frames_.back().begin == line_;
  bool again = false;
  if (b.o_word == OWord::loop_while) {
    again = *v != 0;
  } else {
    if (!running && (*v < 0 || *v != std::floor(*v))) return here(1, "repeat needs a whole number of turns");
    again = running ? --frames_.back().repeats > 0 : *v > 0;
  }
  if (again && !running) {
    if (frames_.size() >= kDeepestCall)
      return here(1, fmt::format("calls and loops nest deeper than {}", kDeepestCall));
    Frame f;
    f.kind = b.o_word;
    f.number = b.o_number;
    f.begin = line_;
    f.repeats = *v;
    frames_.push_back(f);
  }
  if (again && b.o_word == OWord::loop_while && comes_round(frames_.back()))
    return here(1, fmt::format("o{}: the loop never ends: after {} turns no parameter has another value", b.o_number,
                               frames_.back().turns));
  if (!again) {
    if (running) frames_.pop_back();
    else note_zeros(b);
    pc_ = ends_.at(line_) + 1;
  }
  return std::nullopt;
}

}  // namespace toothpath::iso
