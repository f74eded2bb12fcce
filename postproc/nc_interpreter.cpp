// Executes the subset of LinuxCNC and Fanuc text that we write. Everything else is refused where it stands.
#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <unordered_map>

#include "postproc/nc_block.h"
#include "postproc/nc_reader.h"

namespace toothpath {
namespace {

constexpr std::size_t kDeepestCall = 8;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
// LinuxCNC before 2.9.0 raises the rate of a G93 block to this [mm/min or deg/min].
constexpr double kLeastRate = 0.1;

struct Frame {  // of a call or a loop
  OWord kind = OWord::none;
  std::int64_t number = 0;
  std::size_t begin = 0;   // line of the loop's head, or where to go on after a call
  double repeats = 0;
  std::array<double, 30> saved{};
  std::array<bool, 30> saved_set{};
};

class Interpreter {
 public:
  Interpreter(std::string_view text, const std::string& file, const NcControl& control,
              const std::function<void(const ExecutedMove&)>& sink)
      : file_(file), control_(control), sink_(sink), linuxcnc_(control.dialect == "linuxcnc") {
    split(text);
    parameters_.assign(5001, 0);
    parameter_set_.assign(5001, false);
    joints_.fill(kUnknown);
    for (std::size_t a = 0; a < 5; ++a)
      if (control.letters[a] == 0) joints_[a] = 0;
  }

  Status run() {
    if (!linuxcnc_ && control_.dialect != "fanuc")
      return fail("dialect \"{}\" cannot be read back: \"linuxcnc\" and \"fanuc\" can", control_.dialect);
    if (auto bad = find_labels()) return *bad;
    std::size_t steps = 0;
    while (!ended_) {
      if (pc_ >= lines_.size())
        return at(lines_.size(), 0, linuxcnc_ ? "the program ends without M2 or M30" : "the program ends without M30");
      if (++steps > control_.max_steps)
        return at(pc_ + 1, 0, fmt::format("more than {} executed blocks", control_.max_steps));
      line_ = pc_++;
      auto block = fetch(line_);
      if (!block.first) return block.second;
      if (auto bad = execute(*block.first)) return *bad;
    }
    return after_end();
  }

 private:
  // Text.
  void split(std::string_view text) {
    std::size_t begin = 0;
    while (begin < text.size()) {
      std::size_t end = text.find('\n', begin);
      if (end == std::string_view::npos) end = text.size();
      std::string_view line = text.substr(begin, end - begin);
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      lines_.push_back(line);
      begin = end + 1;
    }
  }
  Diagnostic at(std::size_t line, int column, std::string message) const {
    return {DiagnosticKind::refused_input, {file_, static_cast<int>(line), column}, std::move(message)};
  }
  Diagnostic here(int column, std::string message) const { return at(line_ + 1, column, std::move(message)); }

  /// Parsed line; lines of sub-programs and loops are parsed once.
  std::pair<const NcBlock*, Diagnostic> fetch(std::size_t line) {
    if (const auto found = cache_.find(line); found != cache_.end()) return {&found->second, {}};
    auto block = parse_nc_block(lines_[line], linuxcnc_);
    if (!block) {
      Diagnostic d = block.error();
      d.position.file = file_;
      d.position.line = static_cast<int>(line) + 1;
      return {nullptr, d};
    }
    if (frames_.empty()) {
      once_ = std::move(*block);
      return {&once_, {}};
    }
    return {&cache_.emplace(line, std::move(*block)).first->second, {}};
  }

  std::optional<Diagnostic> find_labels() {
    std::vector<std::pair<OWord, std::int64_t>> open;
    std::vector<std::size_t> open_line;
    bool percent_first = false;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const auto first = lines_[i].find_first_not_of(" \t");
      if (first == std::string_view::npos) continue;
      const char c = lines_[i][first];
      if (c == '%') {
        percents_.push_back(i);
        percent_first = percent_first || i == 0;
      }
      if (c != 'o' && c != 'O') continue;
      auto block = parse_nc_block(lines_[i], linuxcnc_);
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
          if (!labels_.emplace(block->o_number, i).second) return at(i + 1, 1, fmt::format("O{} occurs twice", block->o_number));
          break;
        case OWord::sub:
          if (!open.empty()) return at(i + 1, 1, "sub inside another o-word");
          if (!labels_.emplace(block->o_number, i).second) return at(i + 1, 1, fmt::format("o{} occurs twice", block->o_number));
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
    if (percents_.size() == 1 || percents_.size() > 2 || (percents_.size() == 2 && !percent_first))
      return at(percents_.back() + 1, 1, "% must stand in the first and in the last line");
    if (!linuxcnc_ && percents_.size() != 2) return at(1, 1, "the program does not stand between % and %");
    return std::nullopt;
  }

  /// Behind the end there may be comments and, on Fanuc, sub-programs.
  Status after_end() {
    if (!linuxcnc_) return Ok{};
    for (std::size_t i = line_ + 1; i < lines_.size(); ++i) {
      auto block = parse_nc_block(lines_[i], true);
      if (!block || !block->words.empty() || block->o_word != OWord::none)
        return at(i + 1, 1, "text behind the end of the program is not executed");
    }
    return Ok{};
  }

  const double* parameter(int n) const {
    return parameter_set_[static_cast<std::size_t>(n)] ? &parameters_[static_cast<std::size_t>(n)] : nullptr;
  }
  Result<double> value(const NcBlock& b, const NcValue& v, int column) const {
    auto r = evaluate(b, v, [this](int n) { return parameter(n); });
    if (!r) return here(column, r.error().message);
    if (!std::isfinite(*r) || std::abs(*r) > 1e9) return here(column, "value is not a number below 1e9");
    return r;
  }

  // Blocks.
  std::optional<Diagnostic> execute(const NcBlock& b) {
    if (b.percent) {
      if (line_ != 0) return here(1, "the program ends without M2 or M30");
      return std::nullopt;
    }
    if (b.operation >= 0) {
      operation_ = b.operation;
      spindle_set_ = false;
      tooth_ = -1;
    }
    if (b.tooth >= 0) tooth_ = b.tooth;
    if (b.o_word != OWord::none) return o_word(b);
    if (b.words.empty()) return std::nullopt;
    if (b.words.front().letter == '#') return assign(b);
    return words(b);
  }

  std::optional<Diagnostic> assign(const NcBlock& b) {
    for (const auto& w : b.words) {
      if (w.letter != '#') return here(w.column, "a word in a line of assignments");
      const auto v = value(b, w.value, w.column);
      if (!v) return v.error();
      parameters_[static_cast<std::size_t>(w.index)] = *v;
      parameter_set_[static_cast<std::size_t>(w.index)] = true;
    }
    return std::nullopt;
  }

  std::optional<Diagnostic> o_word(const NcBlock& b) {
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
        pc_ = frames_.back().begin;
        return std::nullopt;
      case OWord::none: break;
    }
    return std::nullopt;
  }

  std::optional<Diagnostic> call(const NcBlock& b) {
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
    for (std::size_t i = 0; i < 30; ++i) {
      parameters_[i + 1] = arguments[i];
      parameter_set_[i + 1] = i < b.arguments.size();
    }
    frames_.push_back(f);
    pc_ = label->second + 1;
    return std::nullopt;
  }

  std::optional<Diagnostic> end_call() {
    if (frames_.empty() || frames_.back().kind != OWord::call) return here(1, "end of a sub-program that is not running");
    const Frame& f = frames_.back();
    for (std::size_t i = 0; i < 30; ++i) {
      parameters_[i + 1] = f.saved[i];
      parameter_set_[i + 1] = f.saved_set[i];
    }
    pc_ = f.begin;
    frames_.pop_back();
    return std::nullopt;
  }

  std::optional<Diagnostic> loop_head(const NcBlock& b) {
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
      if (frames_.size() >= kDeepestCall) return here(1, fmt::format("calls and loops nest deeper than {}", kDeepestCall));
      Frame f;
      f.kind = b.o_word;
      f.number = b.o_number;
      f.begin = line_;
      f.repeats = *v;
      frames_.push_back(f);
    }
    if (!again) {
      if (running) frames_.pop_back();
      pc_ = ends_.at(line_) + 1;
    }
    return std::nullopt;
  }

  // Words of one block, sorted by meaning before anything happens.
  struct Request {
    int motion = -1;           // G0 G1 in this block
    int feed_mode = -1;        // 93 94
    bool g53 = false, g43 = false, g49 = false, g64 = false, g61 = false;
    std::string offset;
    std::vector<int> m;
    std::array<double, 5> axis{};
    std::array<bool, 5> has{};
    std::optional<double> f, s, h, t, p, q, l;
    int column = 1;
    int p_column = 1;
    unsigned groups = 0;
  };

  std::optional<Diagnostic> words(const NcBlock& b) {
    Request r;
    for (const auto& w : b.words) {
      if (w.letter == '#') return here(w.column, "an assignment in a line of words");
      const auto v = value(b, w.value, w.column);
      if (!v) return v.error();
      if (auto bad = take(r, w, *v)) return bad;
    }
    return apply(r);
  }

  std::optional<Diagnostic> once(std::optional<double>& slot, const NcWord& w, double v) {
    if (slot) return here(w.column, fmt::format("two {} words in a block", w.letter));
    slot = v;
    return std::nullopt;
  }

  std::optional<Diagnostic> take(Request& r, const NcWord& w, double v) {
    switch (w.letter) {
      case 'G': return take_g(r, w, v);
      case 'M': {
        const int m = static_cast<int>(std::lround(v));
        static constexpr std::array<int, 9> known = {2, 3, 5, 6, 8, 9, 30, 98, 99};
        if (v != m || std::find(known.begin(), known.end(), m) == known.end() || (linuxcnc_ && m > 90))
          return here(w.column, fmt::format("M{} is not in the subset", v));
        if (!r.m.empty()) return here(w.column, "two M words in a block");
        r.m.push_back(m);
        return std::nullopt;
      }
      case 'N': return std::nullopt;
      case 'F': return once(r.f, w, v);
      case 'S': return once(r.s, w, v);
      case 'H': return once(r.h, w, v);
      case 'T': return once(r.t, w, v);
      case 'P': r.p_column = w.column; return once(r.p, w, v);
      case 'Q': return once(r.q, w, v);
      case 'L': return once(r.l, w, v);
      default: break;
    }
    for (std::size_t a = 0; a < 5; ++a) {
      if (control_.letters[a] != w.letter) continue;
      if (r.has[a]) return here(w.column, fmt::format("two {} words in a block", w.letter));
      if (!linuxcnc_ && !w.point) return here(w.column, fmt::format("{} without a decimal point", w.letter));
      r.has[a] = true;
      r.axis[a] = v;
      r.column = w.column;
      return std::nullopt;
    }
    return here(w.column, fmt::format("word {} is not in the subset or no axis of the machine", w.letter));
  }

  std::optional<Diagnostic> take_g(Request& r, const NcWord& w, double v) {
    const int tenths = static_cast<int>(std::lround(v * 10));
    if (std::abs(v * 10 - tenths) > 1e-6) return here(w.column, fmt::format("G{} is not in the subset", v));
    unsigned group = 0;
    switch (tenths) {
      case 0: case 10: group = 1; r.motion = tenths / 10; break;
      case 170: group = 2; break;
      case 900: group = 3; break;
      case 930: case 940: group = 4; r.feed_mode = tenths / 10; break;
      case 210: group = 5; break;
      case 400: group = 6; break;
      case 430: group = 7; r.g43 = true; break;
      case 490: group = 7; r.g49 = true; break;
      case 800: group = 8; break;
      case 530: group = 9; r.g53 = true; break;
      case 610: case 640: group = 10; r.g64 = tenths == 640; r.g61 = tenths == 610; break;
      case 921: group = 11; break;
      case 690: group = 13; break;
      case 540: case 550: case 560: case 570: case 580: case 590: case 591: case 592: case 593: {
        group = 12;
        r.offset = tenths % 10 == 0 ? fmt::format("G{}", tenths / 10) : fmt::format("G{}.{}", tenths / 10, tenths % 10);
        break;
      }
      default: return here(w.column, fmt::format("G{} is not in the subset", v));
    }
    const bool foreign = linuxcnc_ ? tenths == 690 : (tenths == 921 || tenths == 610 || tenths == 640 || (tenths > 590 && tenths < 600));
    if (foreign) return here(w.column, fmt::format("G{} is not in the dialect", v));
    if ((r.groups & (1U << group)) != 0) return here(w.column, "two G words of one modal group in a block");
    r.groups |= 1U << group;
    if (r.column == 1) r.column = w.column;
    return std::nullopt;
  }

  std::optional<Diagnostic> apply(const Request& r) {
    if (r.f && !(*r.f > 0)) return here(r.column, "F must be above 0");
    if ((r.p || r.q) && !r.g64 && (r.m.empty() || r.m.front() != 98)) return here(r.p_column, "P or Q without G64 or M98");
    if (r.l) return here(r.column, "L is not in the subset");
    if (r.g64 && !r.p) return here(r.column, "G64 without P leaves the path without limit");
    if (r.g64) blend_mm_ = *r.p;
    if (r.g61) blend_mm_ = 0;
    if (r.feed_mode >= 0) {
      if (feed_mode_ != r.feed_mode) feed_.reset();
      feed_mode_ = r.feed_mode;
    }
    if (r.f) feed_ = *r.f;
    if (r.s) {
      if (!(*r.s > 0)) return here(r.column, "S must be above 0");
      speed_ = *r.s;
      spindle_set_ = true;
    }
    if (r.t) {
      if (*r.t != std::floor(*r.t) || control_.tool_length_mm.count(static_cast<int>(*r.t)) == 0)
        return here(r.column, fmt::format("tool {} is not in the tool list", *r.t));
      next_tool_ = static_cast<int>(*r.t);
    }
    if (!r.offset.empty()) {
      const auto found = control_.work_offsets.find(r.offset);
      if (found == control_.work_offsets.end()) return here(r.column, fmt::format("work offset {} is not defined", r.offset));
      offset_ = found->second;
    }
    if (r.g49) tool_length_.reset();
    if (r.h && !r.g43) return here(r.column, "H without G43");
    if (r.g43) {
      const int h = r.h ? static_cast<int>(*r.h) : -1;
      if (control_.tool_length_mm.count(h) == 0) return here(r.column, "G43 needs the H of a tool in the list");
      tool_length_ = control_.tool_length_mm.at(h);
    }
    for (const int m : r.m)
      if (auto bad = machine_function(m, r)) return bad;
    const bool moves = std::any_of(r.has.begin(), r.has.end(), [](bool h) { return h; });
    if (r.motion >= 0) motion_ = r.motion;
    if (r.g53 && !moves) return here(r.column, "G53 without an axis word");
    if (moves) return move(r);
    return std::nullopt;
  }

  std::optional<Diagnostic> machine_function(int m, const Request& r) {
    const bool moves = std::any_of(r.has.begin(), r.has.end(), [](bool h) { return h; });
    switch (m) {
      case 3:
        if (!spindle_set_ || operation_ < 0) return here(r.column, "M3 without an S word of this operation");
        spindle_ = true;
        break;
      case 5: spindle_ = false; break;
      case 6:
        if (spindle_) return here(r.column, "M6 while the spindle turns");
        if (feed_mode_ == 93) return here(r.column, "M6 in G93");
        if (!retracted_) return here(r.column, "M6 without a machine retract (G53) before it");
        if (next_tool_ < 0) return here(r.column, "M6 without a T word");
        tool_ = next_tool_;
        break;
      case 2:
      case 30:
        if (feed_mode_ == 93) return here(r.column, "program end in G93");
        if (spindle_) return here(r.column, "program end while the spindle turns");
        if (!frames_.empty()) return here(r.column, "program end inside a sub-program or loop");
        ended_ = true;
        break;
      case 98: {
        const auto label = labels_.find(r.p ? static_cast<std::int64_t>(*r.p) : -1);
        if (moves || label == labels_.end()) return here(r.column, "M98 needs the P of a sub-program in this file and no axis word");
        if (frames_.size() >= kDeepestCall) return here(1, fmt::format("calls nest deeper than {}", kDeepestCall));
        Frame f;
        f.kind = OWord::program;
        f.begin = pc_;
        frames_.push_back(f);
        pc_ = label->second + 1;
        break;
      }
      case 99:
        if (frames_.empty()) return here(r.column, "M99 outside a sub-program");
        pc_ = frames_.back().begin;
        frames_.pop_back();
        break;
      default: break;  // M8 M9
    }
    return std::nullopt;
  }

  std::optional<Diagnostic> move(const Request& r) {
    if (motion_ < 0) return here(r.column, "axis word before G0 or G1");
    if (r.g53 && motion_ != 0) return here(r.column, "G53 with G1");
    if (!offset_ && !r.g53) return here(r.column, "axis word before a work offset");
    std::array<double, 5> goal = joints_;
    for (std::size_t a = 0; a < 5; ++a) {
      if (!r.has[a]) continue;
      goal[a] = r.axis[a];
      if (a < 3 && !r.g53) {
        goal[a] += (*offset_)[static_cast<int>(a)];
        if (a == 2) {
          if (!tool_length_) return here(r.column, "Z word without tool length compensation");
          goal[a] += *tool_length_;
        }
      }
    }
    ExecutedMove m;
    m.joints = goal;
    m.known = std::none_of(goal.begin(), goal.end(), [](double v) { return std::isnan(v); }) &&
              std::none_of(joints_.begin(), joints_.end(), [](double v) { return std::isnan(v); });
    m.line = static_cast<std::int32_t>(line_) + 1;
    m.operation = static_cast<std::int16_t>(operation_);
    m.tool = static_cast<std::int16_t>(tool_);
    m.rapid = motion_ == 0;
    m.blend_mm = m.rapid ? 0.0F : static_cast<float>(blend_mm_);
    for (std::size_t a = 0; a < 5; ++a)
      if (r.has[a]) m.commanded = static_cast<std::uint8_t>(m.commanded | (1U << a));
    m.tooth = static_cast<std::int16_t>(tooth_);
    m.machine = r.g53 || r.g43;
    if (m.rapid) {
      for (std::size_t a = 0; a < 5; ++a)
        if (r.has[a] && m.known && control_.rapid_speed[a] > 0)
          m.minutes = std::max(m.minutes, std::abs(goal[a] - joints_[a]) / control_.rapid_speed[a]);
    } else {
      auto minutes = feed_minutes(r, goal);
      if (!minutes) return minutes.error();
      m.minutes = *minutes;
    }
    retracted_ = r.g53 && r.has[2];
    joints_ = goal;
    sink_(m);
    return std::nullopt;
  }

  Result<double> feed_minutes(const Request& r, const std::array<double, 5>& goal) {
    if (!spindle_) return here(r.column, "G1 while the spindle stands");
    if (tool_ < 0) return here(r.column, "G1 without a tool");
    if (feed_mode_ == 93 && !r.f) return here(r.column, "G1 in G93 without F");
    double linear = 0, rotary = 0;
    for (std::size_t a = 0; a < 5; ++a) {
      const double d = goal[a] - joints_[a];
      if (std::isnan(d)) return here(r.column, "G1 from a position that the program did not set");
      (a < 3 ? linear : rotary) += d * d;
    }
    linear = std::sqrt(linear);
    rotary = std::sqrt(rotary);
    const double length = linear > 0 ? linear : rotary;
    if (feed_mode_ == 93) {
      if (length == 0) return 1 / *feed_;
      const double rate = length * *feed_;
      return length / (linuxcnc_ ? std::max(kLeastRate, rate) : rate);
    }
    if (feed_mode_ != 94 || !feed_) return here(r.column, "G1 without F");
    if (!linuxcnc_ && rotary > 0) return here(r.column, "G94 with a rotary word");
    if (linear > 0 && rotary > 0 && !r.f) return here(r.column, "G94 with rotary and linear words and no F of its own");
    return length / *feed_;
  }

  const std::string& file_;
  const NcControl& control_;
  double blend_mm_ = 0;  ///< P of G64: how far the control may leave the corners of the path
  const std::function<void(const ExecutedMove&)>& sink_;
  bool linuxcnc_;
  std::vector<std::string_view> lines_;
  std::vector<std::size_t> percents_;
  std::unordered_map<std::size_t, std::size_t> ends_;          // head line -> end line
  std::unordered_map<std::int64_t, std::size_t> labels_;       // sub-program -> line
  std::unordered_map<std::size_t, NcBlock> cache_;
  NcBlock once_;
  std::vector<Frame> frames_;
  std::size_t pc_ = 0, line_ = 0;
  bool ended_ = false, started_ = false;
  std::vector<double> parameters_;
  std::vector<bool> parameter_set_;
  // Modal state.
  std::array<double, 5> joints_{};
  int motion_ = -1, feed_mode_ = -1, operation_ = -1, tool_ = -1, next_tool_ = -1, tooth_ = -1;
  std::optional<double> feed_, tool_length_;
  std::optional<Vec3> offset_;
  double speed_ = 0;
  bool spindle_ = false, spindle_set_ = false, retracted_ = false;
};

}  // namespace

Status execute_nc(std::string_view text, const std::string& file, const NcControl& control,
                  const std::function<void(const ExecutedMove&)>& sink) {
  return Interpreter(text, file, control, sink).run();
}

}  // namespace toothpath
