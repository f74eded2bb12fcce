// Executes the subset of Heidenhain plain text that a gear program needs: L and LN blocks, TCPM, rotation cycle, datum
// cycle, tolerance cycle, Q parameters, repeated sections, a jump to a label. Everything else is refused where it
// stands.
#include "postproc/controls/heidenhain/heidenhain_reader.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

#include "geometry/base/angle.h"
#include "postproc/controls/heidenhain/lines.h"
#include "postproc/controls/heidenhain/presets.h"
#include "postproc/readback/execution.h"
#include "postproc/readback/scanner.h"
#include "postproc/readback/turns.h"
#include "postproc/tool_check/lines.h"
#include "postproc/tool_check/unsaid.h"

namespace toothpath::controls {
namespace {

constexpr std::size_t kLongestHeidenhainLine = 256;
constexpr std::size_t kMostM = 4;  // in a block
/// Modes that a check of the tool leaves unsaid.
enum : unsigned { kRotation, kDatum, kTolerance, kTcpm, kPlane, kShift };

class Heidenhain {
 public:
  Heidenhain(std::string_view text, const std::string& file, const readback::NcControl& control,
             const readback::MoveSink& sink)
      : text_(text),
        file_(file),
        control_(control),
        lines_(readback::lines_of(text)),
        joined_(join_lines(lines_)),
        execution_(control,
                   {.turns_need_axis_blend = true,
                    .stop = readback::ProgramStop::ends_spindle,
                    .reference_keeps_length = true},
                   sink) {
    execution_.set_feed_mode(readback::NcExecution::Feed::per_minute);
  }

  Status run() {
    if (auto bad = readback::no_acting_comment(text_, file_, heidenhain_acting_comment); !bad) return bad;
    if (auto bad = find_labels()) return *bad;
    while (!ended_) {
      if (pc_ >= lines_.size()) return place(lines_.size(), 0, "the program ends without END PGM");
      if (auto bad = execution_.next_block()) return place(pc_ + 1, 0, std::move(*bad));
      line_ = pc_++;
      if (auto bad = execute(lines_[line_])) return *bad;
    }
    if (pc_ < lines_.size()) return place(pc_ + 1, 1, "text behind END PGM");
    return Ok{};
  }

 private:
  using Problem = std::optional<Diagnostic>;

  Diagnostic place(std::size_t line, int column, std::string message) const {
    const int number = line > 0 ? joined_.number(line - 1) : 0;
    return {DiagnosticKind::refused_input, {file_, number, column}, std::move(message)};
  }
  std::int32_t number() const { return joined_.number(line_); }
  Diagnostic here(int column, std::string message) const { return place(line_ + 1, column, std::move(message)); }
  Problem placed(int column, readback::NcExecution::Problem problem) const {
    if (!problem) return std::nullopt;
    return here(column, std::move(*problem));
  }

  /// Block numbers count up from 0; labels occur once.
  Problem find_labels() {
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (lines_[i].size() > kLongestHeidenhainLine)
        return place(i + 1, static_cast<int>(kLongestHeidenhainLine),
                     fmt::format("line of {} characters exceeds {}", lines_[i].size(), kLongestHeidenhainLine));
      readback::NcScanner s(heidenhain_code(lines_[i]));
      const auto n = s.number();
      if (!n || *n != static_cast<double>(i) || (s.at() != ' ' && s.at() != '\0'))
        return place(i + 1, 1,
                     fmt::format("block number {} expected{}", i, lines_[i].empty() ? ", the line is empty" : ""));
      s.skip_blanks();
      if (!s.take("LBL ")) continue;
      const auto label = s.number();
      if (!label || !s.done()) return place(i + 1, s.column(), "LBL needs a number");
      if (!labels_.emplace(*label, i).second)
        return place(i + 1, s.column(), fmt::format("LBL {} occurs twice", *label));
    }
    return std::nullopt;
  }

  Problem execute(std::string_view text) {
    readback::NcScanner s(text);
    (void)s.number();
    if (s.done() || s.at() == '*') return std::nullopt;  // * structures the text for its reader
    if (s.at() == ';') {
      const std::string_view comment = s.rest().substr(1);
      if (const int op = readback::comment_label(comment, "OP "); op >= 0) execution_.begin_operation(op);
      if (const int tooth = readback::comment_label(comment, "TOOTH "); tooth >= 0) execution_.begin_tooth(tooth);
      const int checked = execution_.check_lines() > 0 ? tool_check::checked_tool(text) : -1;
      if (checked >= 0) return check_tool(checked);
      return std::nullopt;
    }
    s = readback::NcScanner(heidenhain_code(text));
    (void)s.number();
    s.skip_blanks();
    if (started_ == s.take("BEGIN PGM "))
      return here(s.column(), started_ ? "BEGIN PGM inside the program" : "the program does not begin with BEGIN PGM");
    if (!started_) {
      started_ = true;
      name_ = s.rest();
      if (name_.size() < 4 || name_.substr(name_.size() - 3) != " MM")
        return here(s.column(), "a program in MM with a name expected");
      execution_.set_unit();
      execution_.set_absolute();  // increments have words of their own
      return std::nullopt;
    }
    if (ready_to_end_ && !s.take("END PGM ")) return here(s.column(), "END PGM expected behind M30");
    if (ready_to_end_) {
      ended_ = true;
      return s.rest() == name_ ? Problem{} : here(s.column(), "END PGM names another program");
    }
    if (s.take("/")) {
      s.skip_blanks();
      if (s.rest() != "M0" && s.rest() != "M1" && s.rest() != "STOP" && !s.rest().starts_with("FUNCTION DWELL "))
        return here(s.column(),
                    "a block that may be skipped is read with M0, M1, STOP or FUNCTION DWELL alone: with "
                    "others there would be two programs to prove");
    }
    if (s.take("LN ")) return straight(s, true);
    if (s.take("L ")) return straight(s, false);
    const int column = s.column();
    auto bad = statement(s, column);
    if (!bad && !s.done()) return here(s.column(), "words that do not belong to the block");
    return bad;
  }

  /// What the lines of a check leave is not known: all modes must be said again ahead of a straight line.
  Problem check_tool(int tool) {
    const std::size_t count = std::min(execution_.check_lines(), lines_.size() - pc_);
    std::vector<std::string_view> lines;
    for (std::size_t i = 0; i < count; ++i) lines.push_back(tool_check::without_number(lines_[pc_ + i]));
    if (const auto bad = execution_.check_tool(tool, lines, number()))
      return place(line_ + 1 + bad->line, bad->column, bad->text);
    pc_ += count;
    execution_.set_unit();  // BEGIN PGM .. MM, and words of its own for steps and feeds
    execution_.set_absolute();
    execution_.set_feed_mode(readback::NcExecution::Feed::per_minute);
    nearer_way_ = false;
    unsaid_.all({{kRotation, "CYCL DEF 10.1 ROT"},
                 {kDatum, "CYCL DEF 247 DATUM SETTING"},
                 {kTolerance, "CYCL DEF 32.1"},
                 {kTcpm, "FUNCTION RESET TCPM"},
                 {kPlane, "PLANE RESET"},
                 {kShift, "TRANS DATUM RESET"}});
    return std::nullopt;
  }
  Problem statement(readback::NcScanner& s, int column) {
    if (s.take("LBL ")) return (void)s.number(), std::nullopt;
    if (s.take("CALL LBL ")) return repeat(s);
    if (s.take("FN 12: IF ")) return jump_if_less(s);
    if (s.at() == 'Q' || s.take("FN 0: ") || s.take("FN 1: ")) return assign(s);
    if (s.take("TOOL DEF ")) {
      const auto n = tool_number(s);
      return n ? placed(column, execution_.choose_tool(*n)) : Problem(n.error());
    }
    if (s.take("TOOL CALL ")) return tool_call(s, column);
    if (s.take("CYCL DEF ")) return cycle(s, column);
    if (s.take("PLANE RESET STAY")) return unsaid_.said(kPlane), execution_.reset_plane(), std::nullopt;
    if (s.take("PLANE SPATIAL ")) return plane(s, column);
    if (s.take("TRANS DATUM RESET")) {
      unsaid_.said(kShift);
      shift_ = Vec3::Zero();
      return placed(column, execution_.clear_zeros());
    }
    if (s.take("TRANS DATUM AXIS ")) return plane_origin(s, column);
    if (s.take("BLK FORM CYLINDER Z ")) return blank(s);
    if (s.take("BLK FORM 0.1 ") || s.take("BLK FORM 0.2 "))
      return s.advance(s.rest().size()), std::nullopt;  // a picture
    if (s.take("FUNCTION RESET TCPM")) return unsaid_.said(kTcpm), placed(column, execution_.tcp_off());
    if (s.take("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS")) return placed(column, execution_.tcp_on());
    if (s.take("FUNCTION DWELL TIME")) return dwell(s, false);
    if (s.take("FUNCTION DWELL REV")) return dwell(s, true);
    if (s.take("STOP")) return execution_.stop(), s.skip_blanks(), s.done() ? std::nullopt : functions(s);
    if (s.at() == 'M') return functions(s);
    return here(column, fmt::format("{} is not in the subset", readback::shown_text(s.rest())));
  }

  // Parameters.
  std::optional<int> parameter_number(readback::NcScanner& s) const {
    if (!s.take("Q")) return std::nullopt;
    int n = 0;
    const std::string_view rest = s.rest();
    const auto r = std::from_chars(rest.data(), rest.data() + rest.size(), n);
    if (r.ec != std::errc{} || n < 0 || n > 1999) return std::nullopt;
    s.advance(static_cast<std::size_t>(r.ptr - rest.data()));
    return n;
  }
  Result<double> expression(readback::NcScanner& s) {
    const int column = s.column();
    s.set_functions("INT");
    auto v = s.expression([this](readback::NcScanner& p) -> const double* {
      const auto n = parameter_number(p);
      const auto found = n ? parameters_.find(*n) : parameters_.end();
      return found == parameters_.end() ? nullptr : &found->second;
    });
    if (!v) return here(column, v.error().message);
    if (!std::isfinite(*v) || std::abs(*v) > 1e9) return here(column, "value is not a number below 1e9");
    return v;
  }
  Problem assign(readback::NcScanner& s) {
    const int column = s.column();
    const auto n = parameter_number(s);
    s.skip_blanks();
    if (!n || !s.take("=")) return here(column, "Q parameter and = expected");
    if (*n >= 100 && *n <= 199)
      return here(column, fmt::format("Q{} belongs to the control, which fills Q100 to Q199 itself (tool, spindle, "
                                      "probe): take one below Q100",
                                      *n));
    const auto v = expression(s);
    if (!v) return v.error();
    parameters_[*n] = *v;
    return std::nullopt;
  }
  /// A signed number or a signed parameter.
  Result<double> word_value(readback::NcScanner& s) {
    const char sign = s.at();
    if ((sign == '+' || sign == '-') && s.ahead() == 'Q') {
      s.advance(1);
      const int column = s.column();
      const auto n = parameter_number(s);
      const auto found = n ? parameters_.find(*n) : parameters_.end();
      if (found == parameters_.end()) return here(column, "a parameter that was never set");
      return sign == '-' ? -found->second : found->second;
    }
    if (const auto n = s.number(); n && std::abs(*n) < 1e9) return *n;
    return here(s.column(), "number expected");
  }

  // Sections.
  Problem repeat(readback::NcScanner& s) {
    const int column = s.column();
    const auto label = s.number();
    s.skip_blanks();
    const auto found = label ? labels_.find(*label) : labels_.end();
    if (found == labels_.end()) return here(column, "CALL LBL of a label that does not exist");
    if (!s.take("REP") || found->second >= line_)
      return here(column, "only a section that stands ahead can be repeated, with REP");
    s.skip_blanks();
    const auto count = s.number();
    if (!count || *count < 1 || *count != std::floor(*count)) return here(s.column(), "REP needs a whole number");
    const auto [entry, first] = repeats_.emplace(line_, *count);
    (void)first;
    if (entry->second > 0) {
      entry->second -= 1;
      return back_to(found->second);
    }
    repeats_.erase(entry);
    return std::nullopt;
  }

  /// IF value LT value GOTO LBL number
  Problem jump_if_less(readback::NcScanner& s) {
    const auto a = word_value(s);
    if (!a) return a.error();
    s.skip_blanks();
    if (!s.take("LT ")) return here(s.column(), "LT expected");
    const auto b = word_value(s);
    if (!b) return b.error();
    s.skip_blanks();
    if (!s.take("GOTO LBL ")) return here(s.column(), "GOTO LBL expected");
    const int column = s.column();
    const auto label = s.number();
    const auto found = label ? labels_.find(*label) : labels_.end();
    if (found == labels_.end()) return here(column, "GOTO LBL of a label that does not exist");
    return *a < *b ? back_to(found->second) : std::nullopt;
  }
  Problem back_to(std::size_t label) {
    pc_ = label + 1;
    return label < line_ ? placed(1, turns_.back_to(label)) : std::nullopt;
  }

  // Modes.
  /// M words up to the end of a block.
  Problem functions(readback::NcScanner& s) {
    std::vector<MWord> list;
    while (!s.done())
      if (auto bad = take_m(s, list)) return bad;
    return perform(list);
  }
  struct MWord {
    int m = 0;
    int column = 1;
  };
  Problem take_m(readback::NcScanner& s, std::vector<MWord>& list) {
    const int column = s.column();
    if (!s.take("M")) return here(column, "an M word expected");
    const auto m = s.number();
    if (!m) return here(column, "number expected");
    static constexpr double known[] = {0, 1, 3, 5, 8, 9, 13, 30, 126, 127, 128, 129};
    if (std::find(std::begin(known), std::end(known), *m) == std::end(known) &&
        !control_.switches_coolant(fmt::format("M{}", *m)) && !control_.clamped_by(fmt::format("M{}", *m)))
      return here(column, fmt::format("M{} is not in the subset", *m));
    if (list.size() >= kMostM) return here(column, fmt::format("more than {} M words in a block", kMostM));
    const int n = static_cast<int>(*m);
    for (const MWord& other : list)
      if (n < 126 && other.m < 126 && readback::clash_of_m(control_, other.m, n))
        return here(column, fmt::format("M{} and M{} of one group in a block", other.m, n));
    list.push_back({n, column});
    return std::nullopt;
  }
  Problem perform(std::vector<MWord>& list) {
    std::stable_sort(list.begin(), list.end(), [](const MWord& a, const MWord& b) {
      return readback::group_of_m(a.m) < readback::group_of_m(b.m);
    });
    for (const MWord& word : list)
      if (auto bad = function(word.m, word.column)) return bad;
    return std::nullopt;
  }
  Problem function(int m, int column) {
    switch (m) {
      case 0:
      case 1: execution_.stop(); return std::nullopt;
      case 3: return placed(column, execution_.spindle_on());
      case 13: execution_.switch_coolant("M8"); return placed(column, execution_.spindle_on());
      case 5: execution_.spindle_off(); return std::nullopt;
      case 30: ready_to_end_ = true; return placed(column, execution_.end_program(!repeats_.empty()));
      case 126:
      case 127: nearer_way_ = m == 126; return std::nullopt;
      case 128: return placed(column, execution_.tcp_on());
      case 129: return placed(column, execution_.tcp_off());
      default: {
        const std::string word = fmt::format("M{}", m);
        if (!execution_.switch_clamp(word)) execution_.switch_coolant(word);
        return std::nullopt;
      }
    }
  }
  /// Seconds, or turns of the spindle.
  Problem dwell(readback::NcScanner& s, bool turns) {
    s.skip_blanks();
    const int column = s.column();
    const auto v = s.number();
    if (!v) return here(column, "number expected");
    return placed(column, turns ? execution_.dwell_turns(*v) : execution_.dwell(*v / 60));
  }

  /// Tools of the list have numbers.
  Result<double> tool_number(readback::NcScanner& s) const {
    s.skip_blanks();
    if (const auto n = s.number()) return *n;
    if (s.at() != '"') return here(s.column(), "number expected");
    return here(s.column(),
                fmt::format("tool {} is called by its name: the tools of the list have numbers, TOOL CALL 1",
                            readback::shown_text(s.rest().substr(0, s.rest().find('"', 1) + 1))));
  }
  /// DL+0 DR+0 DR2+0 of a TOOL CALL, and its F, which F AUTO alone would take.
  Problem further_sizes(readback::NcScanner& s) const {
    while (!s.done()) {
      const int column = s.column();
      const char* const name = s.take("DL")    ? "DL"
                               : s.take("DR2") ? "DR2"
                               : s.take("DR")  ? "DR"
                               : s.take("F")   ? "F"
                                               : "";
      const auto v = s.number();
      if (*name == '\0' || !v)
        return here(column, fmt::format("{} is not in the subset of TOOL CALL", readback::shown_text(s.rest())));
      if (*name == 'D' && *v != 0)
        return here(column,
                    fmt::format("{}{:+g}: the tool would have another size than in the list, limit 0", name, *v));
    }
    return std::nullopt;
  }

  Problem tool_call(readback::NcScanner& s, int column) {
    if (s.take("S")) {  // another speed of the tool in the spindle
      const auto speed = s.number();
      if (!speed) return here(s.column(), "number expected");
      if (execution_.tool() < 0) return here(column, "TOOL CALL S without a tool in the spindle");
      return placed(column, execution_.set_speed(*speed));
    }
    const auto n = tool_number(s);
    if (!n) return n.error();
    s.skip_blanks();
    if (!s.take("Z")) return here(s.column(), "TOOL CALL needs number, Z and S");
    s.skip_blanks();
    if (!s.take("S")) return here(s.column(), "TOOL CALL needs number, Z and S");
    const auto speed = s.number();
    if (!speed) return here(s.column(), "number expected");
    if (auto bad = further_sizes(s)) return bad;
    if (auto bad = placed(column, execution_.set_speed(*speed))) return bad;
    if (auto bad = placed(column, execution_.choose_tool(*n))) return bad;
    if (auto bad = placed(column, execution_.change_tool())) return bad;
    return placed(column, execution_.set_length(execution_.tool()));
  }

  Problem cycle(readback::NcScanner& s, int column) {
    if (s.take("9.0 DWELL TIME")) return std::nullopt;
    if (s.take("9.1 DWELL")) return dwell(s, false);
    if (s.take("7.0 DATUM SHIFT") || s.take("10.0 ROTATION") || s.take("32.0 TOLERANCE")) return std::nullopt;
    if (s.take("7.1 ")) return datum_shift(s, column);
    if (s.take("10.1 ROT")) {
      const auto v = word_value(s);
      if (!v) return v.error();
      execution_.turn_frame(*v);
      unsaid_.said(kRotation);
      return std::nullopt;
    }
    if (s.take("32.1")) {
      s.skip_blanks();
      double blend = 0;
      if (s.take("T")) {
        const auto v = s.number();
        if (!v || !(*v >= 0)) return here(s.column(), "T must not be negative");
        blend = *v;
      }
      unsaid_.said(kTolerance);
      execution_.set_blend(blend);
      execution_.set_path_mode(blend > 0 ? timing::Corners::round : timing::Corners::jump, blend);
      execution_.set_blend_axis({});  // the block that follows may say it
      return std::nullopt;
    }
    if (s.take("32.2 HSC-MODE:")) {
      if (!s.take("0 TA") && !s.take("1 TA")) return here(s.column(), "HSC-MODE:0 or 1 and TA expected");
      const auto v = s.number();
      if (!v || !(*v >= 0 && *v <= 10)) return here(s.column(), "TA must be 0 to 10 deg");
      execution_.set_blend_axis(radians(*v));
      return std::nullopt;
    }
    if (s.take("247 DATUM SETTING Q339=")) {
      const auto n = word_value(s);
      if (!n) return n.error();
      unsaid_.said(kDatum);
      for (const auto& offset : control_.work_offsets)
        if (preset_number(offset.first) == *n) return placed(column, execution_.select_offset(offset.first));
      return here(column, fmt::format("datum {} is not defined", *n));
    }
    return here(column, "the cycle is not in the subset");
  }

  /// CYCL DEF 7.1 C+Q2: of a rotary axis.
  Problem datum_shift(readback::NcScanner& s, int column) {
    for (std::size_t a = 3; a < 5; ++a) {
      if (control_.letters[a] == 0 || s.at() != control_.letters[a]) continue;
      s.advance(1);
      const auto v = word_value(s);
      return v ? placed(column, execution_.move_zero(a, *v, "CYCL DEF 7.1")) : Problem(v.error());
    }
    return here(s.column(), "a datum shift is read of a rotary axis of the machine alone");
  }

  /// TX TY TZ
  Problem component(readback::NcScanner& s, Vec3& axis, int& components) {
    const int column = s.column(), k = s.ahead() - 'X';
    s.advance(2);
    const auto v = word_value(s);
    if (!v) return v.error();
    if ((components & (1 << k)) != 0) return here(column, "a component of the vector occurs twice");
    components |= 1 << k;
    axis[k] = *v;
    return std::nullopt;
  }

  /// R of the outside, L down from DIST, RI of the bore.
  Problem blank(readback::NcScanner& s) {
    std::array<double, 4> v{};
    static constexpr std::string_view names[] = {"R", "L", "DIST", "RI"};
    for (std::size_t i = 0; i < 4; ++i) {
      s.skip_blanks();
      if (i == 3 && s.done()) break;
      if (!s.take(names[i])) return here(s.column(), fmt::format("{} expected", names[i]));
      const auto n = s.number();
      if (!n) return here(s.column(), "number expected");
      v[i] = *n;
    }
    if (control_.blank) control_.blank({v[0], v[3], v[2] - v[1], v[2]}, number());
    return std::nullopt;
  }

  // Tilted planes.
  /// Three words with these names ahead of their values.
  Problem three(readback::NcScanner& s, const std::array<std::string_view, 3>& names, Vec3& values) {
    for (std::size_t i = 0; i < 3; ++i) {
      s.skip_blanks();
      if (!s.take(names[i])) return here(s.column(), fmt::format("{} expected", names[i]));
      const auto v = word_value(s);
      if (!v) return v.error();
      values[static_cast<int>(i)] = *v;
    }
    return std::nullopt;
  }
  Problem plane_origin(readback::NcScanner& s, int column) {
    if (execution_.in_plane()) return here(column, "TRANS DATUM in a tilted plane: PLANE RESET is missing ahead of it");
    return three(s, {"X", "Y", "Z"}, shift_);
  }
  /// SPA SPB SPC about the axes of the machine X, Y, Z in this order. TURN: the rotaries go there and nothing else
  /// does. SEQ: the pair of angles, by the sign of the rotary that tilts. TABLE ROT: the table turns where it might
  /// stand.
  Problem plane(readback::NcScanner& s, int column) {
    Vec3 deg = Vec3::Zero();
    if (auto bad = three(s, {"SPA", "SPB", "SPC"}, deg)) return bad;
    s.skip_blanks();
    if (!s.take("TURN FMAX SEQ") || (s.at() != '+' && s.at() != '-'))
      return here(s.column(), "PLANE SPATIAL is read with TURN FMAX SEQ+ or SEQ- TABLE ROT: which pair is meant");
    using Pair = readback::NcExecution::PlanePair;
    const Pair pair = s.at() == '+' ? Pair::not_below_zero : Pair::not_above_zero;
    s.advance(1);
    if (!s.take(" TABLE ROT")) return here(s.column(), "TABLE ROT expected");
    Mat3 rotation = Mat3::Identity();
    for (int i = 0; i < 3; ++i)
      rotation = Eigen::AngleAxisd(radians(deg[i]), Vec3::Unit(i)).toRotationMatrix() * rotation;
    if (auto bad = placed(column, execution_.define_plane(shift_, rotation, "PLANE SPATIAL"))) return bad;
    return placed(column, execution_.turn_to_plane(pair, "PLANE SPATIAL", number()));
  }

  // Straight lines.
  /// F100, and F MAX as the control prints it.
  Problem feed_word(readback::NcScanner& s, readback::NcExecution::Move& m, bool& fmax) {
    const int column = s.column();
    s.advance(1);
    s.skip_blanks();
    if (s.take("MAX")) return fmax = true, std::nullopt;
    const auto f = s.number();
    if (!f)
      return here(column, s.rest().starts_with("AUTO") ? "F AUTO is not in the subset: F and a number, or FMAX"
                                                       : "number expected behind F");
    m.own_feed = true;
    return placed(column, execution_.set_feed(*f));
  }
  Problem straight(readback::NcScanner& s, bool vector) {
    readback::NcExecution::Move m;
    bool fmax = false, m91 = false, m92 = false;
    std::vector<MWord> functions;
    Vec3 axis = Vec3::Zero();
    int components = 0;
    const int first = s.column();
    while (!s.done()) {
      const int column = s.column();
      const char c = s.at();
      if (s.take("R0")) continue;
      if (bool* const flag = s.take("FMAX") ? &fmax : s.take("M91") ? &m91 : s.take("M92") ? &m92 : nullptr) {
        *flag = true;
        continue;
      }
      if (c == 'M') {
        if (auto bad = take_m(s, functions)) return bad;
        continue;
      }
      if (c == 'F') {
        if (auto bad = feed_word(s, m, fmax)) return bad;
        continue;
      }
      if (vector && c == 'T' && s.ahead() >= 'X' && s.ahead() <= 'Z') {
        if (auto bad = component(s, axis, components)) return bad;
        continue;
      }
      std::size_t a = 0;
      while (a < 5 && (control_.letters[a] != c || c == '\0')) ++a;
      if (a == 5)
        return here(column, fmt::format("{} is not in the subset or no axis of the machine",
                                        readback::shown_text(s.rest().substr(0, s.rest().find(' ')))));
      if (m.has[a]) return here(column, fmt::format("two {} words in a block", c));
      s.advance(1);
      const auto v = word_value(s);
      if (!v) return v.error();
      if (control_.rollover[a] && !nearer_way_)
        return here(column, fmt::format("{} rolls over: which way it turns is said by M126 alone", c));
      m.has[a] = true;
      m.axis[a] = *v;
    }
    if (vector && (components != 7 || m.has[3] || m.has[4]))
      return here(first, "LN needs TX TY TZ and no rotary words");
    if (vector) m.vector = axis;
    if (fmax && m.own_feed) return here(first, "F and FMAX in a block");
    m.rapid = fmax;
    m.machine_frame = m91 || m92;
    if (!m.machine_frame && !execution_.in_plane() && !shift_.isZero(0) && (m.has[0] || m.has[1] || m.has[2]))
      return here(first, "words behind TRANS DATUM AXIS are read in a tilted plane alone");
    if (m91 && m92) return here(first, "M91 and M92 in a block");
    if (!unsaid_.none()) return here(first, unsaid_.text("a straight line"));
    if (m92)
      if (auto bad = from_builders_zero(m, first)) return bad;
    return move_with(m, vector, functions, first);
  }
  /// M92: words from the zero of the builder, which the machine file states.
  Problem from_builders_zero(readback::NcExecution::Move& m, int column) const {
    const auto zero = execution_.reference(0, "M92");
    if (!zero) return here(column, zero.error().message);
    for (std::size_t a = 0; a < 5; ++a)
      if (m.has[a]) m.axis[a] += (*zero)[a];
    return std::nullopt;
  }
  /// Spindle and coolants that are switched on act ahead of the motion of their block, what ends them behind it.
  Problem move_with(const readback::NcExecution::Move& m, bool vector, const std::vector<MWord>& functions,
                    int column) {
    std::vector<MWord> ahead, behind;
    for (const MWord& word : functions) {
      if (word.m >= 126 || control_.clamped_by(fmt::format("M{}", word.m)))
        return here(word.column, fmt::format("M{} with a straight line", word.m));
      const bool on = word.m == 3 || word.m == 13 ||
                      std::any_of(control_.coolants.begin(), control_.coolants.end(),
                                  [&](const auto& c) { return c.second.on == fmt::format("M{}", word.m); });
      (on ? ahead : behind).push_back(word);
    }
    const bool moves = vector || std::any_of(m.has.begin(), m.has.end(), [](bool h) { return h; });
    if (!moves && functions.empty()) return here(column, "L without an axis word");
    if (auto bad = perform(ahead)) return bad;
    if (moves)
      if (auto bad = placed(column, execution_.move(m, number()))) return bad;
    return perform(behind);
  }

  std::string_view text_;
  const std::string& file_;
  const readback::NcControl& control_;
  std::vector<std::string_view> lines_;
  JoinedLines joined_;
  readback::NcExecution execution_;
  std::unordered_map<double, std::size_t> labels_;
  std::unordered_map<std::size_t, double> repeats_;  // CALL LBL -> what is left
  readback::LoopTurns turns_;
  std::unordered_map<int, double> parameters_;
  std::string_view name_;
  std::size_t pc_ = 0, line_ = 0;
  Vec3 shift_ = Vec3::Zero();  // TRANS DATUM AXIS
  bool nearer_way_ = false;    // M126
  tool_check::Unsaid unsaid_;
  bool started_ = false, ready_to_end_ = false, ended_ = false;
};

}  // namespace

Status execute_heidenhain(std::string_view text, const std::string& file, const readback::NcControl& control,
                          const readback::MoveSink& sink) {
  return Heidenhain(text, file, control, sink).run();
}

}  // namespace toothpath::controls
