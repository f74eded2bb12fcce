// Executes the subset of Siemens 840D text that a gear program needs: G words, TRAORI with rotary words or A3 B3 C3,
// ROT about Z, R parameters and variables of DEF INT, FOR loops. Everything else is refused where it stands.
#include "postproc/controls/siemens/siemens_reader.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

#include "geometry/base/angle.h"
#include "postproc/controls/siemens/lines.h"
#include "postproc/controls/siemens/path_group.h"
#include "postproc/controls/siemens/variables.h"
#include "postproc/readback/execution.h"
#include "postproc/readback/scanner.h"
#include "postproc/readback/turns.h"
#include "postproc/tool_check/lines.h"
#include "postproc/tool_check/unsaid.h"

namespace toothpath::controls {
namespace {

constexpr std::size_t kDeepestLoop = 8;
constexpr std::size_t kLongestSiemensLine = 512;
constexpr std::size_t kMostM = 5;                                         // in a block
constexpr unsigned kFrames = 32, kTransformation = 33, kCompressor = 34;  // beside the modal groups

class Siemens {
 public:
  Siemens(std::string_view text, const std::string& file, const readback::NcControl& control,
          const readback::MoveSink& sink)
      : text_(text),
        file_(file),
        control_(control),
        lines_(readback::lines_of(text)),
        execution_(control, {.tcp_may_take_zero = true, .reference_keeps_length = true}, sink),
        path_(control.letters) {
    unsaid_.at_begin({{kTransformation, "TRAFOOF"}});
  }

  Status run() {
    if (auto bad = readback::no_acting_comment(text_, file_, siemens_acting_comment); !bad) return bad;
    if (auto bad = find_loops()) return *bad;
    while (!ended_) {
      if (pc_ >= lines_.size()) return place(lines_.size(), 0, "the program ends without M30");
      if (auto bad = execution_.next_block()) return place(pc_ + 1, 0, std::move(*bad));
      line_ = pc_++;
      if (auto bad = execute(lines_[line_])) return *bad;
    }
    for (std::size_t i = line_ + 1; i < lines_.size(); ++i) {
      readback::NcScanner rest(lines_[i]);
      if (!rest.done() && rest.at() != ';')
        return place(i + 1, rest.column(), "text behind the end of the program is not executed");
    }
    return Ok{};
  }

 private:
  using Problem = std::optional<Diagnostic>;
  struct Loop {
    std::size_t head = 0;
    int variable = 0;
    double last = 0;
  };
  /// What one line asks for.
  struct Request {
    readback::NcExecution::Move move;
    std::optional<double> f, s, adis;
    std::vector<int> m;
    std::optional<double> fixed_point;  // FP
    int motion = -1, feed_mode = -1, column = 1, d = -1;
    bool dwell = false, g75 = false, skip = false;
    bool whole = false;  // CYCLE800, WORKPIECE: a block of its own
    bool supa = false, g641 = false, g60 = false, traori = false, trafoof = false, rot = false;
    bool oriwks = false, oriaxes = false;
    double rot_deg = 0;
    std::optional<std::size_t> trans;  // the rotary whose zero TRANS moves
    double trans_deg = 0;
    std::string offset, tool;
    std::array<double, 3> vector{};
    int vector_words = 0;
    unsigned groups = 0;
  };

  Diagnostic place(std::size_t line, int column, std::string message) const {
    return {DiagnosticKind::refused_input, {file_, static_cast<int>(line), column}, std::move(message)};
  }
  Diagnostic here(int column, std::string message) const { return place(line_ + 1, column, std::move(message)); }
  Problem placed(int column, readback::NcExecution::Problem problem) const {
    if (!problem) return std::nullopt;
    return here(column, std::move(*problem));
  }

  // Loops.
  Problem find_loops() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      readback::NcScanner s(in_capitals(siemens_code(lines_[i]), capitals_));
      (void)take_beginning(s);
      if (s.take("FOR ")) open.push_back(i);
      else if (s.take("ENDFOR")) {
        if (open.empty()) return place(i + 1, s.column(), "ENDFOR closes nothing");
        ends_[open.back()] = i;
        open.pop_back();
      }
      if (open.size() > kDeepestLoop) return place(i + 1, 1, fmt::format("loops nest deeper than {}", kDeepestLoop));
    }
    if (!open.empty()) return place(open.back() + 1, 1, "FOR is never closed");
    return std::nullopt;
  }

  Result<double> expression(readback::NcScanner& s) {
    const int column = s.column();
    s.set_functions("TRUNC", "ABS");
    auto v = s.expression([this](readback::NcScanner& p) { return parameter(p); });
    if (!v) return here(column, v.error().message);
    if (!std::isfinite(*v) || std::abs(*v) > 1e9) return here(column, "value is not a number below 1e9");
    return v;
  }
  const double* parameter(readback::NcScanner& s) const {
    const auto n = variables_.take(s);
    return n ? variables_.value(*n) : nullptr;
  }
  Problem set(int column, int variable, double value) {
    std::string bad = variables_.set(variable, value);
    return bad.empty() ? Problem() : here(column, std::move(bad));
  }

  Problem loop_head(readback::NcScanner& s) {
    const int column = s.column();
    const auto n = variables_.take(s);
    if (!n || !s.take("=")) return here(column, "FOR needs an R parameter or a variable, and its first value");
    const auto first = expression(s);
    if (!first) return first.error();
    s.skip_blanks();
    if (!s.take("TO ")) return here(s.column(), "TO expected");
    const auto last = expression(s);
    if (!last) return last.error();
    if (!s.done()) return here(s.column(), "words behind FOR");
    if (*first > *last) {
      pc_ = ends_.at(line_) + 1;
      return std::nullopt;
    }
    loops_.push_back({line_, *n, *last});
    return set(column, *n, *first);
  }
  Problem loop_end(readback::NcScanner& s) {
    if (!s.done()) return here(s.column(), "words behind ENDFOR");
    if (loops_.empty() || ends_.at(loops_.back().head) != line_) return here(1, "ENDFOR of a loop that is not running");
    Loop& l = loops_.back();
    const double next = *variables_.value(l.variable) + 1;
    if (auto bad = set(1, l.variable, next)) return bad;
    if (next > l.last) {
      loops_.pop_back();
      return std::nullopt;
    }
    pc_ = l.head + 1;
    return placed(1, turns_.back_to(l.head));
  }

  /// What the lines of a check leave is not known: all groups must be said again ahead of an axis word.
  Problem check_tool(int tool) {
    const std::size_t count = std::min(execution_.check_lines(), lines_.size() - pc_);
    if (const auto bad =
            execution_.check_tool(tool, std::span(lines_).subspan(pc_, count), static_cast<std::int32_t>(line_) + 1))
      return place(line_ + 1 + bad->line, bad->column, bad->text);
    pc_ += count;
    motion_ = -1;
    corners_said_ = false;
    unsaid_.all({{6, "G17"},
                 {7, "G40"},
                 {13, "G710"},
                 {14, "G90"},
                 {15, "G93 or G94"},
                 {kFrames, "ROT or TRANS"},
                 {kTransformation, "TRAFOOF"},
                 {kCompressor, "COMPOF"}});
    return std::nullopt;
  }
  Problem all_said(const Request& r) {
    unsaid_.said_groups(r.groups);
    if (r.rot && !r.trans && r.rot_deg == 0) unsaid_.said(kFrames);
    if (r.trafoof) unsaid_.said(kTransformation);
    const bool moves = std::any_of(r.move.has.begin(), r.move.has.end(), [](bool h) { return h; });
    if (unsaid_.none() || !(moves || r.vector_words != 0 || r.g75)) return std::nullopt;
    return here(r.column, unsaid_.text("an axis word"));
  }

  // Lines.
  Problem execute(std::string_view text) {
    if (text.size() > kLongestSiemensLine)
      return here(static_cast<int>(kLongestSiemensLine),
                  fmt::format("line of {} characters exceeds {}", text.size(), kLongestSiemensLine));
    const std::string_view code = siemens_code(text);
    if (code.size() < text.size()) {
      const std::string_view comment = text.substr(code.size() + 1);
      if (const int op = readback::comment_label(comment, "OP "); op >= 0) execution_.begin_operation(op);
      if (const int tooth = readback::comment_label(comment, "TOOTH "); tooth >= 0) execution_.begin_tooth(tooth);
      const int checked = execution_.check_lines() > 0 ? tool_check::checked_tool(text) : -1;
      if (checked >= 0) return check_tool(checked);
    }
    if (code.starts_with("%"))
      return here(1,
                  "a line %..: it says under which name the control files the text when it reads it in; leave it out");
    readback::NcScanner s(in_capitals(code, capitals_));
    Request r;
    r.skip = take_beginning(s);
    if (s.done() || (!r.skip && execution_.site_smoothing(code.substr(static_cast<std::size_t>(s.column()) - 1))))
      return std::nullopt;
    if (const auto done = statement(s, r.skip)) return *done;
    int words = 0;
    for (; !s.done(); ++words) {
      const bool number = s.at() == 'N';
      if (auto bad = word(s, r)) return bad;
      if (number) --words;
    }
    if (r.skip)
      if (auto bad = skippable(r, words)) return bad;
    if (r.whole)
      return words == 1 ? std::nullopt : Problem(here(1, "CYCLE800 or WORKPIECE with other words in a block"));
    if (r.dwell) return dwell(r, words);
    if (auto bad = all_said(r)) return bad;
    if (r.g75) return fixed_point(r, words);
    return apply(r);
  }
  /// What is no block of words: a loop, the contour cycle, an assignment. Nothing: it is one.
  std::optional<Problem> statement(readback::NcScanner& s, bool skipped) {
    const bool assigns = variables_.stands(s);
    const bool words = !assigns && !s.rest().starts_with("FOR ") && !s.rest().starts_with("ENDFOR") &&
                       !s.rest().starts_with("CYCLE832(") && !s.rest().starts_with("DEF ");
    if (words) return begun_ = true, std::nullopt;
    if (skipped) return skippable({}, 0);
    if (s.take("DEF ")) return definition(s);
    begun_ = true;
    if (s.take("FOR ")) return loop_head(s);
    if (s.take("ENDFOR")) return loop_end(s);
    if (s.take("CYCLE832(")) return contour_cycle(s);
    const int column = s.column();
    const auto n = variables_.take(s);
    if (!n || !s.take("=")) return here(1, "an R parameter or a variable must be set with =");
    const auto v = expression(s);
    if (!v) return v.error();
    if (!s.done()) return here(s.column(), "words behind an assignment");
    return set(column, *n, *v);
  }
  /// DEF INT and names, ahead of every other block.
  Problem definition(readback::NcScanner& s) {
    const int column = s.column();
    if (!s.take("INT ")) return here(column, "DEF is read with INT alone");
    if (begun_) return here(1, "DEF behind another block: variables are defined ahead of all of them");
    std::string bad = variables_.define(s);
    return bad.empty() ? Problem() : here(s.column(), std::move(bad));
  }
  /// CYCLE832(tolerance,_FINISH,1) and CYCLE832(tolerance,_ORI_FINISH,degrees), _ROUGH and _SEMIFIN alike; CYCLE832()
  /// ends it, and how far corners are left behind it must be said.
  Problem contour_cycle(readback::NcScanner& s) {
    const int column = s.column();
    if (s.take(")")) {
      execution_.set_blend(0);
      execution_.set_blend_axis({});
      corners_said_ = false;
      return s.done() ? Problem{} : here(s.column(), "words behind CYCLE832()");
    }
    const auto mm = s.number();
    if (!mm || !(*mm > 0)) return here(column, "CYCLE832 needs a tolerance above 0");
    double deg = 0;
    bool plain = false, leans = false;
    for (const char* cut : {"FINISH,", "SEMIFIN,", "ROUGH,"}) {
      plain = plain || s.take(fmt::format(",_{}1)", cut));
      leans = leans || (!plain && s.take(fmt::format(",_ORI_{}", cut)));
    }
    if (leans)
      if (const auto given = s.number(); given && s.take(")")) deg = *given;
    if (!plain && !(deg > 0 && deg <= 10))
      return here(s.column(),
                  "_FINISH,1 or _ORI_FINISH and its tolerance, up to 10 deg, expected (SEMIFIN, ROUGH alike)");
    if (!s.done()) return here(s.column(), "words behind CYCLE832");
    execution_.set_contour(*mm, plain ? std::nullopt : std::optional(radians(deg)));
    corners_said_ = true;
    return std::nullopt;
  }
  /// A block that may be left out must not matter: with others the text would be two programs.
  Problem skippable(const Request& r, int words) const {
    const bool stops = words == 1 && r.m.size() == 1 && r.m.front() <= 1;
    if (stops || (r.dwell && words == 2)) return std::nullopt;
    return here(1,
                "a block that may be skipped is read with M0, M1 or G4 alone: with others there would be two programs "
                "to prove");
  }
  /// G4 F in seconds, G4 S in turns of the spindle; feed and speed stay what they were.
  Problem dwell(const Request& r, int words) {
    if (words != 2 || r.f.has_value() == r.s.has_value())
      return here(r.column, "G4 stands in a block of its own, with F or S");
    return placed(r.column, r.f ? execution_.dwell(*r.f / 60) : execution_.dwell_turns(*r.s));
  }
  /// G75 FP=1 Z1=0: machine axes go to a fixed point, whatever offsets and lengths say; the values mean nothing.
  Problem fixed_point(Request& r, int words) {
    const auto axes = std::count(r.move.has.begin(), r.move.has.end(), true);
    if (axes == 0 || words != axes + 1 + (r.fixed_point ? 1 : 0))
      return here(r.column, "G75 stands in a block of its own, with FP and machine axes: G75 FP=1 Z1=0");
    const double n = r.fixed_point.value_or(1);
    if (n != 1 && n != 2) return here(r.column, fmt::format("G75 FP={} is not in the subset: 1 and 2 are", n));
    return placed(r.column, execution_.to_reference(r.move, n == 1 ? 0 : 1, fmt::format("G75 FP={}", n), false,
                                                    static_cast<std::int32_t>(line_) + 1));
  }

  Problem word(readback::NcScanner& s, Request& r) {
    const int column = s.column();
    const char c = s.at();
    if (!readback::NcScanner::is_letter(c))
      return here(column, fmt::format("character {} is no part of a word", readback::shown_character(c)));
    if (readback::NcScanner::is_letter(s.ahead())) return keyword(s, r);
    if (c >= 'A' && c <= 'C' && s.ahead() == '3' && s.rest().substr(2, 1) == "=") return vector_word(s, r);
    for (std::size_t a = 0; a < 5; ++a)
      if (control_.letters[a] == c) return r.g75 ? machine_axis(s, r, a) : axis_word(s, r, a);
    s.advance(1);
    if (c == 'T') return tool_word(s, r, column);
    const auto v = literal(s, column);
    if (!v) return v.error();
    switch (c) {
      case 'N': return std::nullopt;
      case 'F': return once(r.f, *v, c, column);
      case 'S': return once(r.s, *v, c, column);
      case 'G': return g_word(r, *v, column);
      case 'M': return m_word(r, *v, column);
      case 'D':
        if (*v != 0 && *v != 1) return here(column, fmt::format("D{} is not in the subset", *v));
        r.d = static_cast<int>(*v);
        return std::nullopt;
      default: return here(column, fmt::format("word {} is not in the subset or no axis of the machine", c));
    }
  }

  /// A3= B3= C3=
  Problem vector_word(readback::NcScanner& s, Request& r) {
    const int column = s.column(), k = s.at() - 'A';
    if ((r.vector_words & (1 << k)) != 0) return here(column, fmt::format("two {}3 words in a block", s.at()));
    s.advance(3);
    const auto v = expression(s);
    if (!v) return v.error();
    r.vector[static_cast<std::size_t>(k)] = *v;
    r.vector_words |= 1 << k;
    r.column = column;
    return std::nullopt;
  }

  /// Of axis `a`: X1.5, X=expression, and C=DC(expression) of a rotary that rolls over.
  Problem axis_word(readback::NcScanner& s, Request& r, std::size_t a) {
    const int column = s.column();
    const char c = s.at();
    s.advance(1);
    if (r.move.has[a]) return here(column, fmt::format("two {} words in a block", c));
    const bool equals = s.take("=");
    if (const bool direct = equals && s.rest().starts_with("DC("); direct != control_.rollover[a])
      return here(column, direct ? fmt::format("DC() of {}, which does not roll over", c)
                                 : fmt::format("{} rolls over: which way it turns is said by DC() alone", c));
    else if (direct) s.advance(2);
    const auto v = equals ? expression(s) : literal(s, column);
    if (!v) return v.error();
    if (control_.rollover[a] && !(*v >= 0 && *v < 360))
      return here(column, fmt::format("{}=DC({}) is outside 0 .. 360", c, *v));
    r.move.has[a] = true;
    r.move.axis[a] = *v;
    r.column = column;
    return std::nullopt;
  }

  /// Of G75: X1=0.
  Problem machine_axis(readback::NcScanner& s, Request& r, std::size_t a) {
    const int column = s.column();
    s.advance(1);
    if (!s.take("1="))
      return here(column, fmt::format("G75 takes the axes of the machine: {}1=0", control_.letters[a]));
    if (r.move.has[a]) return here(column, fmt::format("two {}1 words in a block", control_.letters[a]));
    if (const auto v = literal(s, column); !v) return v.error();
    r.move.has[a] = true;
    return std::nullopt;
  }

  Problem tool_word(readback::NcScanner& s, Request& r, int column) {
    const std::string_view rest = s.rest();
    const std::string_view name = s.take("=\"") ? s.rest().substr(0, s.rest().find('"')) : std::string_view();
    const auto n = name.starts_with("T") ? readback::NcScanner(name.substr(1)).number() : std::nullopt;
    if (!n || *n != std::floor(*n) || name.find_first_not_of("0123456789", 1) != std::string_view::npos)
      return here(column, fmt::format("T{}: the tools of the list are called T=\"T1\" and so on",
                                      readback::shown_text(rest.substr(0, rest.find(' ')))));
    s.advance(name.size());
    if (!s.take("\"")) return here(s.column(), "\" expected");
    if (auto bad = placed(column, execution_.choose_tool(*n))) return bad;
    r.column = column;
    return std::nullopt;
  }

  Problem m_word(Request& r, double v, int column) {
    static constexpr int known[] = {0, 1, 3, 5, 6, 7, 8, 9, 30};
    if (std::find(std::begin(known), std::end(known), v) == std::end(known) &&
        !control_.switches_coolant(fmt::format("M{}", v)) && !control_.clamped_by(fmt::format("M{}", v)))
      return here(column, fmt::format("M{} is not in the subset", v));
    if (r.m.size() >= kMostM) return here(column, fmt::format("more than {} M words in a block", kMostM));
    const int m = static_cast<int>(v);
    for (const int other : r.m)
      if (readback::clash_of_m(control_, other, m))
        return here(column, fmt::format("M{} and M{} of one group in a block", other, m));
    r.m.push_back(m);
    r.column = column;
    return std::nullopt;
  }

  Result<double> literal(readback::NcScanner& s, int column) const {
    if (const auto n = s.number(); n && std::abs(*n) < 1e9) return *n;
    return here(column, "number expected");
  }
  Problem once(std::optional<double>& slot, double v, char letter, int column) {
    if (slot) return here(column, fmt::format("two {} words in a block", letter));
    slot = v;
    return std::nullopt;
  }

  Problem keyword(readback::NcScanner& s, Request& r) {
    const int column = s.column();
    if (s.take("CYCLE800(")) {
      r.whole = true;
      return swivel(s, column);
    }
    if (s.take("WORKPIECE(,\"\",,\"")) {
      r.whole = true;
      return blank(s);
    }
    const std::string_view name = s.letters();
    if (name == "TRAORI") {
      r.traori = true;
      if (auto bad = first_transformation(s)) return bad;
    } else if (name == "TRAFOOF") r.trafoof = true;
    else if (name == "SUPA") r.supa = true;
    else if (name == "COMPOF") return unsaid_.said(kCompressor), std::nullopt;
    else if (name == "ORIWKS") r.oriwks = true;
    else if (name == "ORIAXES") r.oriaxes = true;
    else if (name == "MSG") return message(s);
    else if (name == "FGROUP" || name == "FGREF") return path_group(s, name == "FGREF");
    else if (name == "FP") {
      if (!s.take("=")) return here(s.column(), "= expected");
      const auto v = expression(s);
      if (!v) return v.error();
      return once(r.fixed_point, *v, 'F', column);
    } else if (name == "ADIS") {
      if (!s.take("=")) return here(s.column(), "= expected");
      const auto v = expression(s);
      if (!v) return v.error();
      if (!(*v >= 0)) return here(column, "ADIS must not be negative");
      r.adis = *v;
    } else if (name == "ROT") {
      r.rot = true;
      s.skip_blanks();
      if (s.take("Z=")) {
        const auto v = expression(s);
        if (!v) return v.error();
        r.rot_deg = *v;
      }
      if (!s.done()) return here(s.column(), "ROT takes an angle about Z alone");
    } else if (name == "TRANS") {
      if (auto bad = translation(s, r)) return bad;
    } else {
      return here(column, fmt::format("{} is not in the subset", name));
    }
    r.column = column;
    return std::nullopt;
  }

  /// TRAORI is TRAORI(1).
  Problem first_transformation(readback::NcScanner& s) const {
    if (!s.take("(")) return std::nullopt;
    const int column = s.column();
    const auto n = s.number();
    if (!n || !s.take(")")) return here(column, "TRAORI(1) expected: further arguments are not in the subset");
    if (*n == 1) return std::nullopt;
    return here(column, fmt::format("TRAORI({}): the machine file states one transformation, number 1", *n));
  }
  /// MSG("text") shows it, MSG() clears it.
  Problem message(readback::NcScanner& s) const {
    const int column = s.column();
    if (!s.take("(")) return here(column, "( expected behind MSG");
    if (s.take("\"")) {
      const std::size_t end = s.rest().find('"');
      if (end == std::string_view::npos) return here(column, "MSG without the second quote of its text");
      s.advance(end + 1);
    }
    return s.take(")") ? Problem() : here(s.column(), "MSG is read with one text in quotes");
  }

  /// TRANS alone ends what TRANS and ROT have set, TRANS C=angle takes its place.
  Problem translation(readback::NcScanner& s, Request& r) {
    r.rot = true;
    s.skip_blanks();
    for (std::size_t a = 3; a < 5 && !r.trans; ++a)
      if (control_.letters[a] != 0 && s.at() == control_.letters[a] && s.ahead() == '=') r.trans = a;
    if (r.trans) {
      s.advance(2);
      const auto v = expression(s);
      if (!v) return v.error();
      r.trans_deg = *v;
    }
    if (!s.done()) return here(s.column(), "TRANS takes one rotary axis of the machine alone");
    return std::nullopt;
  }

  /// A cylinder, or a pipe with its bore, all heights absolute: top, bottom, end of the machining; diameters.
  Problem blank(readback::NcScanner& s) {
    const bool pipe = s.take("PIPE\",448");
    if (!pipe && !s.take("CYLINDER\",192"))
      return here(s.column(), "WORKPIECE is read with \"CYLINDER\",192 and \"PIPE\",448");
    std::array<double, 5> v{};
    for (std::size_t i = 0; i < (pipe ? 5U : 4U); ++i) {
      if (!s.take(",")) return here(s.column(), ", expected");
      const int column = s.column();
      const auto n = literal(s, column);
      if (!n) return n.error();
      v[i] = *n;
    }
    if (!s.take(")")) return here(s.column(), ") expected");
    if (control_.blank) control_.blank({v[3] / 2, v[4] / 2, v[1], v[0]}, static_cast<std::int32_t>(line_) + 1);
    return std::nullopt;
  }

  /// CYCLE800(_FR,_TC,_ST,_MODE,_X0,_Y0,_Z0,_A,_B,_C,_X1,_Y1,_Z1,_DIR,_FR_I,_DMODE), a new plane without a retract, its
  /// angles axis by axis, the axes named by two bits each of _MODE; CYCLE800() ends it.
  Problem swivel(readback::NcScanner& s, int column) {
    if (s.take(")")) return execution_.reset_plane(), std::nullopt;
    std::array<double, 16> p{};
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (i > 0 && !s.take(",")) return here(s.column(), ", expected");
      if (i == 1) {
        const std::string_view rest = s.rest();
        const std::size_t end = rest.empty() || rest[0] != '"' ? std::string_view::npos : rest.find('"', 1);
        if (end == std::string_view::npos) return here(s.column(), "the name of a swivel data set expected");
        s.advance(end + 1);
        continue;
      }
      const auto v = expression(s);
      if (!v) return v.error();
      p[i] = *v;
    }
    if (!s.take(")")) return here(s.column(), ") expected");
    const int mode = p[3] == std::floor(p[3]) && p[3] >= 0 && p[3] < 64 ? static_cast<int>(p[3]) : 0;
    const std::array<int, 3> axes = {(mode & 3) - 1, (mode >> 2 & 3) - 1, (mode >> 4 & 3) - 1};
    const bool ordered =
        std::min({axes[0], axes[1], axes[2]}) == 0 && axes[0] + axes[1] + axes[2] == 3 && axes[0] != axes[1];
    if (p[0] != 0 || p[2] != 0 || !ordered || p[14] != 0)
      return here(column, "CYCLE800 is read with _FR = 0, _ST = 0, angles axis by axis about three axes and _FR_I = 0");
    if (p[13] != 1 && p[13] != -1)
      return here(column, "CYCLE800 without a direction, 1 or -1: which pair of angles is meant");
    Mat3 rotation = Mat3::Identity();
    for (std::size_t i = 0; i < 3; ++i)
      rotation = rotation * Eigen::AngleAxisd(radians(p[7 + i]), Vec3::Unit(axes[i])).toRotationMatrix();
    const Vec3 origin = Vec3(p[4], p[5], p[6]) + rotation * Vec3(p[10], p[11], p[12]);
    if (auto bad = placed(column, execution_.define_plane(origin, rotation, "CYCLE800"))) return bad;
    using Pair = readback::NcExecution::PlanePair;
    return placed(column, execution_.turn_to_plane(p[13] > 0 ? Pair::not_below_zero : Pair::not_above_zero, "CYCLE800",
                                                   static_cast<std::int32_t>(line_) + 1));
  }

  Problem path_group(readback::NcScanner& s, bool radius) {
    const int column = s.column();
    if (!radius) {
      if (auto bad = path_.group(s); !bad.empty()) return here(s.column(), std::move(bad));
    } else {
      const auto rotary = path_.rotary(s);
      if (!rotary) return here(column, "FGREF needs a rotary axis of the machine in brackets, and =");
      const auto v = expression(s);
      if (!v) return v.error();
      if (!(*v > 0)) return here(column, "FGREF must be above 0");
      path_.set_radius(*rotary, *v);
    }
    execution_.set_path_weights(path_.weights());
    return std::nullopt;
  }

  Problem g_word(Request& r, double v, int column) {
    unsigned group = 0;
    const int g = v == std::floor(v) ? static_cast<int>(v) : -1;
    switch (g >= 505 && g <= 599 ? 505 : g) {
      case 0:
      case 1:
        group = 1;
        r.motion = g;
        break;
      case 4:
        group = 2;
        r.dwell = true;
        break;
      case 75:
        group = 2;
        r.g75 = true;
        break;
      case 17: group = 6; break;
      case 40: group = 7; break;
      case 54:
      case 55:
      case 56:
      case 57:
      case 505:
        group = 8;
        r.offset = fmt::format("G{}", g);
        break;
      case 60:
        group = 10;
        r.g60 = true;
        break;
      case 641:
        group = 10;
        r.g641 = true;
        break;
      case 90:
        group = 14;
        execution_.set_absolute();
        break;
      case 93:
      case 94:
        group = 15;
        r.feed_mode = g;
        break;
      case 710:
        group = 13;
        execution_.set_unit();
        break;
      default: return here(column, fmt::format("G{} is not in the subset", v));
    }
    if ((r.groups & (1U << group)) != 0) return here(column, "two G words of one modal group in a block");
    r.groups |= 1U << group;
    if (r.column == 1) r.column = column;
    return std::nullopt;
  }

  Problem apply(Request& r) {
    if (r.fixed_point) return here(r.column, "FP without G75");
    if (r.adis.has_value() != r.g641) return here(r.column, "G641 and ADIS belong together");
    if (r.g641) execution_.set_corner_way(*r.adis);
    if (r.g60) execution_.set_blend(0);
    if (r.g60) execution_.set_path_mode(timing::Corners::stop, 0);
    if (r.g641 || r.g60) execution_.set_blend_axis({});
    corners_said_ = corners_said_ || r.g641 || r.g60;
    if (r.feed_mode == 93) execution_.set_feed_mode(readback::NcExecution::Feed::inverse_time);
    if (r.feed_mode == 94) execution_.set_feed_mode(readback::NcExecution::Feed::per_minute);
    if (r.f)
      if (auto bad = placed(r.column, execution_.set_feed(*r.f))) return bad;
    if (r.s)
      if (auto bad = placed(r.column, execution_.set_speed(*r.s))) return bad;
    if (r.trafoof)
      if (auto bad = placed(r.column, execution_.tcp_off())) return bad;
    if (!r.offset.empty())
      if (auto bad = placed(r.column, execution_.select_offset(r.offset))) return bad;
    if (r.d == 0 && execution_.tcp()) return here(r.column, "D0 with TRAORI on");
    if (r.d == 0) execution_.drop_length();
    if (r.d == 1)
      if (auto bad = placed(r.column, execution_.set_length(tool_))) return bad;
    if (r.traori) {
      if (auto bad = placed(r.column, execution_.tcp_on())) return bad;
      frame_said_ = axes_said_ = false;
    }
    frame_said_ = frame_said_ || r.oriwks;
    axes_said_ = axes_said_ || r.oriaxes;
    if ((r.traori || r.trafoof) && execution_.zero_is_moved()) zero_said_ = false;
    if (r.rot) {
      execution_.turn_frame(r.rot_deg);
      if (auto bad = placed(
              r.column, r.trans ? execution_.replace_zeros(*r.trans, r.trans_deg, "TRANS") : execution_.clear_zeros()))
        return bad;
      zero_said_ = true;
    }
    // The tool, the spindle, coolants; a stop and the end stand behind the motion of their block.
    std::sort(r.m.begin(), r.m.end(), [](int a, int b) { return readback::group_of_m(a) < readback::group_of_m(b); });
    const bool stops = !r.m.empty() && readback::group_of_m(r.m.back()) == readback::kStops;
    for (std::size_t i = 0; i + (stops ? 1 : 0) < r.m.size(); ++i)
      if (auto bad = machine_function(r.m[i], r)) return bad;
    if (r.motion >= 0) motion_ = r.motion;
    if (auto bad = move(r)) return bad;
    return stops ? machine_function(r.m.back(), r) : std::nullopt;
  }

  Problem machine_function(int m, const Request& r) {
    switch (m) {
      case 0:
      case 1: execution_.stop(); return std::nullopt;
      case 3: return placed(r.column, execution_.spindle_on());
      case 5: execution_.spindle_off(); return std::nullopt;
      case 6: {
        if (auto bad = placed(r.column, execution_.change_tool())) return bad;
        tool_ = execution_.tool();
        return std::nullopt;
      }
      case 30: ended_ = true; return placed(r.column, execution_.end_program(!loops_.empty()));
      default: {
        const std::string word = fmt::format("M{}", m);
        const bool clamps = control_.clamped_by(word).has_value();
        if (clamps && std::any_of(r.move.has.begin(), r.move.has.end(), [](bool h) { return h; }))
          return here(r.column, word + " with an axis word: it stands in a block of its own");
        if (!execution_.switch_clamp(word)) execution_.switch_coolant(word);
        return std::nullopt;
      }
    }
  }

  Problem move(Request& r) {
    const bool moves = std::any_of(r.move.has.begin(), r.move.has.end(), [](bool h) { return h; });
    if (r.supa && !moves) return here(r.column, "SUPA without an axis word");
    if (r.vector_words != 0 && r.vector_words != 7) return here(r.column, "A3, B3 and C3 belong together");
    if (!moves && r.vector_words == 0) return std::nullopt;
    if (r.vector_words == 7) {
      if (r.move.has[3] || r.move.has[4]) return here(r.column, "rotary words and a vector in a block");
      r.move.vector = Vec3(r.vector[0], r.vector[1], r.vector[2]);
    }
    if (!zero_said_ && !r.supa)
      return here(r.column,
                  "axis word behind TRAORI or TRAFOOF, which may drop the frames (machine data 10602): TRANS must be "
                  "said again, or ROT");
    if (execution_.tcp() && !r.supa && !(frame_said_ && axes_said_))
      return here(
          r.column,
          fmt::format("axis word behind TRAORI without {} since: how the tool turns inside a block would depend "
                      "on the last program",
                      frame_said_ ? "ORIAXES" : "ORIWKS"));
    if (motion_ < 0) return here(r.column, "axis word before G0 or G1");
    if (r.supa && motion_ != 0) return here(r.column, "SUPA with G1");
    if (motion_ == 1 && !corners_said_ && !execution_.in_site_smoothing())
      return here(
          r.column,
          "G1 without G60, G641 or CYCLE832 since the program began, a tool was checked or CYCLE832() was left: "
          "how far the control leaves corners is not said");
    r.move.rapid = motion_ == 0;
    r.move.machine_frame = r.supa;
    r.move.own_feed = r.f.has_value();
    return placed(r.column, execution_.move(r.move, static_cast<std::int32_t>(line_) + 1));
  }

  std::string_view text_;
  const std::string& file_;
  const readback::NcControl& control_;
  std::vector<std::string_view> lines_;
  std::string capitals_;  // of the line that is being read
  readback::NcExecution execution_;
  std::unordered_map<std::size_t, std::size_t> ends_;  // FOR -> ENDFOR
  readback::LoopTurns turns_;
  SiemensVariables variables_;
  std::vector<Loop> loops_;
  std::size_t pc_ = 0, line_ = 0;
  NcPathGroup path_;
  int motion_ = -1, tool_ = -1;
  tool_check::Unsaid unsaid_;
  bool ended_ = false, begun_ = false;
  bool zero_said_ = true;                        // since TRAORI or TRAFOOF, where it was moved
  bool corners_said_ = false;                    // since the program began, a tool was checked, CYCLE832() was left
  bool frame_said_ = false, axes_said_ = false;  // ORIWKS, ORIAXES, since TRAORI
};

}  // namespace

Status execute_siemens(std::string_view text, const std::string& file, const readback::NcControl& control,
                       const readback::MoveSink& sink) {
  return Siemens(text, file, control, sink).run();
}

}  // namespace toothpath::controls
