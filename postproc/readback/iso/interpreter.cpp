#include "postproc/readback/iso/interpreter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "geometry/base/angle.h"
#include "postproc/readback/iso/flow.h"
#include "postproc/tool_check/lines.h"
#include "postproc/tool_check/unsaid.h"

namespace toothpath::iso {
namespace {

using readback::MoveSink, readback::NcControl, readback::NcExecution, readback::kStops, readback::group_of_m;

constexpr unsigned kOffsets = 12;  // modal group
constexpr unsigned kZeros = 32;    // beside the modal groups: G52
constexpr int kTurnBehindX = 9;    // parameters of a work offset: X Y Z A B C U V W R

class Interpreter {
 public:
  Interpreter(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink,
              const IsoLanguage& language)
      : control_(control),
        language_(language),
        flow_(text, file, language.o_words, control),
        execution_(control, language.rules, sink) {
    for (const auto& [name, at] : control.work_offsets) tell_offset(name, at, 0);
  }

  Status run() {
    return flow_.run([this](const NcBlock& b) { return block(b); });
  }

 private:
  using Problem = std::optional<Diagnostic>;
  Diagnostic here(int column, std::string message) const { return flow_.here(column, std::move(message)); }
  /// A problem of the execution, in its place.
  Problem placed(int column, NcExecution::Problem problem) const {
    if (!problem) return std::nullopt;
    return here(column, std::move(*problem));
  }

  Problem block(const NcBlock& b) {
    if (b.operation >= 0) execution_.begin_operation(b.operation);
    if (b.tooth >= 0) execution_.begin_tooth(b.tooth);
    if (b.words.empty()) {
      const int checked = execution_.check_lines() > 0 ? tool_check::checked_tool(flow_.text()) : -1;
      return checked >= 0 ? check_tool(checked) : std::nullopt;
    }
    if (b.skip)
      if (auto bad = skippable(b)) return bad;
    if (execution_.site_smoothing(flow_.text())) {
      corners_said_ =
          corners_said_ && !language_.stops_at_corners;  // what holds behind the smoothing must be said again
      return std::nullopt;
    }
    return words(b);
  }

  /// What the lines of a check leave is not known: all groups must be said again ahead of an axis word.
  Problem check_tool(int tool) {
    const auto lines = flow_.ahead(execution_.check_lines());
    if (const auto bad = execution_.check_tool(tool, lines, flow_.line()))
      return flow_.there(bad->line, bad->column, bad->text);
    flow_.leave_out(lines.size());
    flow_.moved();
    motion_ = -1;
    corners_said_ = false;
    std::map<unsigned, const char*> modes = {{2, "G17"}, {3, "G90"}, {4, "G93 or G94"}, {5, "G21"},
                                             {6, "G40"}, {8, "G80"}, {10, "G61 or G64"}};
    if (has_g(921)) modes[11] = "G92.1";
    else modes[kZeros] = "G52 with 0 of all axes";
    if (has_g(690)) modes[13] = "G69";
    unsaid_.all(std::move(modes));
    return std::nullopt;
  }

  // Words of one block, sorted by meaning before anything happens.
  struct Request {
    NcExecution::Move move;
    int motion = -1;     // G0 G1 in this block
    int feed_mode = -1;  // 93 94
    bool g53 = false, g43 = false, tcp = false, g49 = false, g64 = false, g61 = false, stops = false;
    bool extended = false;                                   // G54.1, its number in P
    bool plane = false, to_plane = false, no_plane = false;  // G68.2, G53.1, G69
    std::array<std::optional<double>, 3> euler;              // I J K
    std::string offset;
    std::vector<int> m;
    bool dwell = false;                       // G4
    bool zeros = false;                       // G52
    bool clears = false;                      // G92.1
    bool output = false;                      // M64 P, M65 P
    bool incremental = false;                 // G91
    std::optional<std::size_t> to_reference;  // 0: G28, 1: G30
    bool p_point = false;
    int switch_tcp = -1;  // 1 on, 0 off: a code of the site
    std::optional<double> f, s, h, t, p, q, l;
    bool writes = false;  // G10
    int write_column = 1;
    std::optional<double> turn;  // R
    int column = 1;
    int p_column = 1;
    unsigned groups = 0;
  };

  Problem words(const NcBlock& b) {
    Request r;
    for (const auto& w : b.words) {
      if (w.letter == '#') return here(w.column, "an assignment in a line of words");
      const auto v = flow_.value(b, w.value, w.column);
      if (!v) return v.error();
      if (auto bad = take(r, w, *v)) return bad;
    }
    if (r.dwell) return dwell(r, numbered(b) ? b.words.size() - 1 : b.words.size());
    const std::size_t words = numbered(b) ? b.words.size() - 1 : b.words.size();
    if (r.zeros) return zeros(r, words);
    if (r.writes) return write_offset(r, words);
    if (r.turn) return here(r.column, "R is read with G10 L2 alone");
    return apply(r, words);
  }
  static bool numbered(const NcBlock& b) { return b.words.front().letter == 'N'; }

  /// A block that may be left out must not matter: with others the text would be two programs.
  Problem skippable(const NcBlock& b) const {
    for (const auto& w : b.words) {
      const bool waits = (w.letter == 'G' && w.value.number == 4) || w.letter == 'P' || w.letter == 'N' ||
                         (w.letter == 'M' && w.value.count == 0 && (w.value.number == 0 || w.value.number == 1));
      if (!waits || w.value.count != 0)
        return here(w.column,
                    "a block that may be skipped is read with M0, M1 and G4 P alone: with others there would be two "
                    "programs to prove");
    }
    return std::nullopt;
  }

  /// Codes of the machine file that switch TCP.
  bool site_code(Request& r, const std::string& code) const {
    const auto is = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), code) != list.end();
    };
    if (!is(control_.tcp_on) && !is(control_.tcp_off)) return false;
    r.switch_tcp = is(control_.tcp_on) ? 1 : 0;
    return true;
  }

  Problem once(std::optional<double>& slot, const NcWord& w, double v) {
    if (slot) return here(w.column, fmt::format("two {} words in a block", w.letter));
    slot = v;
    return std::nullopt;
  }

  [[nodiscard]] bool has_m(int m) const {
    static constexpr std::array<int, 7> common = {0, 1, 2, 3, 5, 6, 30};
    const bool call = m == 98 || m == 99 || (m == 97 && language_.local_calls);
    return std::find(common.begin(), common.end(), m) != common.end() || (call && !language_.o_words) ||
           std::find(language_.coolant_m.begin(), language_.coolant_m.end(), m) != language_.coolant_m.end();
  }
  /// The machine file names outputs that clamp: M64 P, M65 P.
  [[nodiscard]] bool has_outputs() const {
    return std::any_of(control_.clamps.begin(), control_.clamps.end(),
                       [](const auto& clamp) { return clamp && clamp->on.find(' ') != std::string::npos; });
  }
  [[nodiscard]] bool has_g(int tenths) const {
    return std::find(language_.g_tenths.begin(), language_.g_tenths.end(), tenths) != language_.g_tenths.end();
  }

  Problem take(Request& r, const NcWord& w, double v) {
    switch (w.letter) {
      case 'G': return take_g(r, w, v);
      case 'M': {
        const int m = static_cast<int>(std::lround(v));
        if (v == m && language_.codes_of_site && site_code(r, fmt::format("M{}", m))) return std::nullopt;
        const std::string word = fmt::format("M{}", m);
        if (v == m && (m == 64 || m == 65) && has_outputs()) r.output = true;
        else if (v != m || !(has_m(m) || control_.switches_coolant(word) || control_.clamped_by(word)))
          return here(w.column, fmt::format("M{} is not in the subset", v));
        return take_m(r, m, w.column);
      }
      case 'N': return std::nullopt;
      case 'F': return once(r.f, w, v);
      case 'S': return once(r.s, w, v);
      case 'H': return once(r.h, w, v);
      case 'T': return once(r.t, w, v);
      case 'P':
        r.p_column = w.column;
        r.p_point = w.point;
        return once(r.p, w, v);
      case 'Q': return once(r.q, w, v);
      case 'L': return once(r.l, w, v);
      case 'R':
        if (!has_g(100)) break;
        if (!r.writes) r.column = w.column;
        return once(r.turn, w, v);
      case 'I':
      case 'J':
      case 'K':
        if (!has_g(682)) break;
        if (language_.point_needed && !w.point)
          return here(w.column, fmt::format("{} without a decimal point", w.letter));
        return once(r.euler[static_cast<std::size_t>(w.letter - 'I')], w, v);
      default: break;
    }
    for (std::size_t a = 0; a < 5; ++a) {
      if (control_.letters[a] != w.letter) continue;
      if (r.move.has[a]) return here(w.column, fmt::format("two {} words in a block", w.letter));
      if (language_.point_needed && !w.point)
        return here(w.column, fmt::format("{} without a decimal point", w.letter));
      r.move.has[a] = true;
      r.move.axis[a] = v;
      r.column = w.column;
      return std::nullopt;
    }
    return here(w.column, fmt::format("word {} is not in the subset or no axis of the machine", w.letter));
  }

  Problem take_m(Request& r, int m, int column) const {
    if (r.m.size() >= language_.most_m)
      return language_.most_m == 1 ? here(column, "two M words in a block: the control takes one")
                                   : here(column, fmt::format("more than {} M words in a block", language_.most_m));
    for (const int other : r.m)
      if (clash_of_m(control_, other, m))
        return here(column, fmt::format("M{} and M{} of one group in a block", other, m));
    r.m.push_back(m);
    return std::nullopt;
  }

  static std::string g_word(int tenths) {
    return tenths % 10 == 0 ? fmt::format("G{}", tenths / 10) : fmt::format("G{}.{}", tenths / 10, tenths % 10);
  }

  /// Takes a G code of the family and gives its modal group; 0: it is none.
  unsigned group_of(Request& r, int tenths) {
    switch (tenths) {
      case 0:
      case 10: r.motion = tenths / 10; return 1;
      case 170: return 2;
      case 900: execution_.set_absolute(); return 3;
      case 910: r.incremental = true; return 3;
      case 40: r.dwell = true; return 14;
      case 280: r.to_reference = 0; return 14;
      case 300: r.to_reference = 1; return 14;
      case 930:
      case 940: r.feed_mode = tenths / 10; return 4;
      case 210: execution_.set_unit(); return 5;
      case 400: return 6;
      case 430: r.g43 = true; return 7;
      case 434: r.g43 = r.tcp = true; return 7;
      case 490: r.g49 = true; return 7;
      case 800: return 8;
      case 100: r.writes = true; return 14;
      case 520: r.zeros = language_.moves_zeros; return r.zeros ? 14 : 0;
      case 530: r.g53 = true; return 9;
      case 610:
      case 611:
      case 640:
        r.g64 = tenths == 640;
        r.g61 = !r.g64;
        r.stops = tenths == 611;
        return 10;
      case 921: r.clears = true; return 11;
      case 690: r.no_plane = true; return 13;
      case 682: r.plane = true; return 13;
      case 531: r.to_plane = true; return 14;
      case 540:
      case 550:
      case 560:
      case 570:
      case 580:
      case 590:
      case 591:
      case 592:
      case 593: r.offset = g_word(tenths); return kOffsets;
      default: return 0;
    }
  }

  Problem take_g(Request& r, const NcWord& w, double v) {
    const int tenths = static_cast<int>(std::lround(v * 10));
    const bool extended = tenths > 0 && tenths == language_.extended.tenths;
    const unsigned group = extended ? kOffsets : group_of(r, tenths);
    r.extended = r.extended || extended;
    if (tenths == 100) r.write_column = w.column;
    if (group == 0 || std::abs(v * 10 - tenths) > 1e-6)
      return here(w.column, fmt::format("G{} is not in the subset", v));
    const bool special = tenths == 100 || tenths == 434 || tenths == 682 || tenths == 531 || tenths == 690 ||
                         tenths == 921 || tenths == 610 || tenths == 611 || tenths == 640 ||
                         (tenths > 590 && tenths < 600);
    if (special && !has_g(tenths)) return here(w.column, fmt::format("G{} is not in the dialect", v));
    if ((r.groups & (1U << group)) != 0) return here(w.column, "two G words of one modal group in a block");
    r.groups |= 1U << group;
    if (r.column == 1) r.column = w.column;
    return std::nullopt;
  }

  /// G4 in a block of its own.
  Problem dwell(Request& r, std::size_t words) {
    const bool by_x = language_.dwell_x && r.move.has[0];
    if (by_x == r.p.has_value() || words != 2)
      return here(r.column, fmt::format("G4 stands in a block of its own, with P{}", language_.dwell_x ? " or X" : ""));
    if (by_x) return placed(r.column, execution_.dwell(r.move.axis[0] / 60));
    if (language_.dwell == DwellNumber::milliseconds && r.p_point)
      return here(r.p_column, "P of G4 is a whole number of milliseconds");
    const bool seconds =
        language_.dwell == DwellNumber::seconds || (language_.dwell == DwellNumber::by_point && r.p_point);
    return placed(r.p_column, execution_.dwell(*r.p / (seconds ? 60 : 60000)));
  }

  /// G52 in a block of its own; all axes named as zero: nothing is left of an earlier one.
  Problem zeros(const Request& r, std::size_t words) {
    const auto& has = r.move.has;
    if (words != 1 + static_cast<std::size_t>(std::count(has.begin(), has.end(), true)) || !moves(r))
      return here(r.column, "G52 stands in a block of its own, with the axes that it is for");
    bool all = true;
    for (std::size_t a = 0; a < 5; ++a) {
      all = all && (has[a] || control_.letters[a] == 0) && r.move.axis[a] == 0;
      if (a < 3 && has[a] && r.move.axis[a] != 0)
        return here(r.column, fmt::format("G52 {} is not in the subset: it moves the zero of rotaries alone",
                                          control_.letters[a]));
    }
    if (all) unsaid_.said(kZeros);
    if (all) return placed(r.column, execution_.clear_zeros());
    for (std::size_t a = 3; a < 5; ++a)
      if (has[a])
        if (auto bad = placed(r.column, execution_.move_zero(a, r.move.axis[a], "G52"))) return bad;
    return std::nullopt;
  }

  /// Parameters of the control hold the origin of a work offset and its turn: X Y Z A B C, and R. Nothing: where it is
  /// they say already.
  void tell_offset(const std::string& name, const std::optional<Vec3>& at_mm, double turn_deg) {
    const int number = language_.number_of_offset == nullptr ? -1 : language_.number_of_offset(name);
    if (number < 0) return;
    for (int i = 0; at_mm && i < 6; ++i)
      flow_.tell(static_cast<std::size_t>(language_.origin_parameter(number) + i), i < 3 ? (*at_mm)[i] : 0);
    flow_.tell(static_cast<std::size_t>(language_.origin_parameter(number) + kTurnBehindX), turn_deg);
  }

  /// Has the program looked at what is taken as 0 of the work offset of the shop, its turn and the zeros of its
  /// rotaries?
  void look_at_offset() {
    if (language_.origin_parameter == nullptr || shop_offset_ < 0 || looked_ == flow_.seen_zeros()) return;
    looked_ = flow_.seen_zeros();
    const auto x = static_cast<std::size_t>(language_.origin_parameter(shop_offset_));
    bool seen = flow_.seen_zero(x + kTurnBehindX);
    for (std::size_t a = 3; a < 5; ++a)
      if (const char letter = control_.letters[a]; letter >= 'A' && letter <= 'C')
        seen = seen && flow_.seen_zero(x + 3 + static_cast<std::size_t>(letter - 'A'));
    execution_.set_offset_unseen(!seen);
  }

  /// G10 L2 P: where the work offset that the machine file leaves to programs is, and how it is turned.
  Problem write_offset(const Request& r, std::size_t words) {
    const auto& has = r.move.has;
    const auto named = static_cast<std::size_t>(std::count(has.begin(), has.end(), true));
    if (!r.l || *r.l != 2) return here(r.write_column, "G10 is read with L2 alone");
    if (control_.index_offset.empty() || !r.p || *r.p != language_.number_of_offset(control_.index_offset))
      return here(r.write_column,
                  fmt::format("G10 L2 P{} writes a work offset of the shop: {}", r.p.value_or(0),
                              control_.index_offset.empty() ? "post.index_offset of the machine file names none"
                                                            : "post.index_offset is " + control_.index_offset));
    if (!r.turn || words != 4 + named)
      return here(r.write_column, "G10 L2 stands in a block of its own, with P, R and axes");
    bool all = true;
    for (std::size_t a = 0; a < 5; ++a) {
      all = all && (has[a] || control_.letters[a] == 0);
      if (a >= 3 && has[a] && r.move.axis[a] != 0)
        return here(r.write_column, fmt::format("G10 L2 moves the zero of {} by {} deg, limit 0: G52 does that",
                                                control_.letters[a], r.move.axis[a]));
    }
    if (named != 0 && !all) return here(r.write_column, "G10 L2 names all axes of the machine or none");
    const auto at = named == 0 ? std::nullopt : std::optional(Vec3(r.move.axis[0], r.move.axis[1], r.move.axis[2]));
    if (auto bad = placed(r.write_column, execution_.write_offset(at, *r.turn))) return bad;
    tell_offset(control_.index_offset, at, *r.turn);
    return std::nullopt;
  }

  /// G28 and G30: through the place that their words name.
  Problem reference(Request& r) {
    const std::string word = *r.to_reference == 0 ? "G28" : "G30";
    if (r.g53 || r.g43 || r.motion >= 0) return here(r.column, word + " with another motion or G43 in a block");
    if (r.p && !(*r.to_reference == 1 && *r.p == 2 && !language_.bare_reference))
      return here(r.p_column, word + " with this P is not in the subset");
    const bool bare = !moves(r);
    if (bare && !language_.bare_reference) return here(r.column, word + " needs the axes that go");
    for (std::size_t a = 0; bare && a < 5; ++a) r.move.has[a] = control_.letters[a] != 0;
    if (auto bad = placed(r.column, execution_.to_reference(r.move, *r.to_reference, word, !bare, flow_.line())))
      return bad;
    flow_.moved();
    return std::nullopt;
  }

  /// G68.2 X Y Z I J K: the origin, seen from the work offset, and Euler's angles about Z, the new X and the new Z.
  /// G53.1 P1: the rotaries turn to it, the one that tilts not below its zero; P2 not above.
  Problem tilt(const Request& r, std::size_t words) {
    if (r.to_plane) {
      if (!r.p || (*r.p != 1 && *r.p != 2) || words != 2)
        return here(r.column, "G53.1 stands in a block of its own, with P1 or P2: which pair of angles is meant");
      const auto pair = *r.p == 1 ? NcExecution::PlanePair::not_below_zero : NcExecution::PlanePair::not_above_zero;
      flow_.moved();
      return placed(r.column, execution_.turn_to_plane(pair, "G53.1", flow_.line()));
    }
    const auto& has = r.move.has;
    if (words != 7 || !has[0] || !has[1] || !has[2] || !r.euler[0] || !r.euler[1] || !r.euler[2])
      return here(r.column, "G68.2 stands in a block of its own, with X Y Z I J K");
    if (execution_.in_plane()) return here(r.column, "G68.2 in a tilted plane: G69 is missing ahead of it");
    const Eigen::AngleAxisd turn(radians(*r.euler[0]), Vec3::UnitZ()), tilt(radians(*r.euler[1]), Vec3::UnitX()),
        spin(radians(*r.euler[2]), Vec3::UnitZ());
    return placed(r.column, execution_.define_plane(Vec3(r.move.axis[0], r.move.axis[1], r.move.axis[2]),
                                                    (turn * tilt * spin).toRotationMatrix(), "G68.2"));
  }

  Problem apply(Request& r, std::size_t words) {
    if (r.extended) {
      const std::string code = g_word(language_.extended.tenths);
      const int last = language_.extended.last;
      if (!r.p || *r.p != std::floor(*r.p) || !(*r.p >= 1 && *r.p <= last))
        return here(r.column, fmt::format("{} needs P1 to P{}", code, last));
      r.offset = fmt::format("{} P{}", code, static_cast<int>(*r.p));
      r.p.reset();
    }
    if (r.plane || r.to_plane) return tilt(r, words);
    if (r.euler[0] || r.euler[1] || r.euler[2]) return here(r.column, "I, J and K belong to G68.2");
    if (r.no_plane) execution_.reset_plane();
    const bool call = !r.m.empty() && (r.m.front() == 97 || r.m.front() == 98);
    if ((r.p || r.q) && !r.g64 && !r.to_reference && !r.output && !call)
      return here(r.p_column, "P or Q without G64 or M98");
    if (r.incremental) execution_.set_incremental();
    if (r.l) return here(r.column, "L is not in the subset");
    if (language_.stops_at_corners) return stop_or_flow(r);
    if (r.g64 && (!r.p || *r.p == 0))
      return here(r.column, fmt::format("G64 {} leaves the path without limit", r.p ? "P0" : "without P"));
    if (r.g64 && (*r.p < 0 || r.q.value_or(0) < 0)) return here(r.column, "P and Q of G64 must not be negative");
    // Without Q the lines that are joined may be off by P.
    corners_said_ = corners_said_ || r.g64 || r.g61;
    if (r.g64) execution_.set_blend(language_.corner_of_g64(*r.p, r.q.value_or(*r.p), control_.exact_path_mm), true);
    if (r.g61) execution_.set_blend(control_.exact_path_mm);  // a stop leaves as much
    if (r.g64) execution_.set_path_mode(timing::Corners::blend, *r.p);
    if (r.g61) execution_.set_path_mode(r.stops ? timing::Corners::stop : timing::Corners::exact, 0);
    return take_effect(r);
  }

  /// G61 and G64 of a control whose machine file says what G64 leaves of a corner.
  Problem stop_or_flow(Request& r) {
    if (r.g64 && (r.p || r.q)) return here(r.p_column, "P or Q without M98");
    if (r.g61 || r.g64) {
      corners_said_ = r.g61 || control_.corner_mm;
      execution_.set_blend(r.g64 ? control_.corner_mm.value_or(0) : 0);
      execution_.set_path_mode(r.g61 ? timing::Corners::stop : timing::Corners::jump, 0);
    }
    return take_effect(r);
  }

  Problem take_effect(Request& r) {
    if (r.feed_mode == 93) execution_.set_feed_mode(NcExecution::Feed::inverse_time);
    if (r.feed_mode == 94) execution_.set_feed_mode(NcExecution::Feed::per_minute);
    if (r.f)
      if (auto bad = placed(r.column, execution_.set_feed(*r.f))) return bad;
    if (r.s)
      if (auto bad = placed(r.column, execution_.set_speed(*r.s))) return bad;
    if (r.t)
      if (auto bad = placed(r.column, execution_.choose_tool(*r.t))) return bad;
    if (!r.offset.empty()) {
      if (auto bad = placed(r.column, execution_.select_offset(r.offset))) return bad;
      if (r.offset != control_.index_offset && language_.number_of_offset != nullptr) {
        const int before = std::exchange(shop_offset_, language_.number_of_offset(r.offset));
        if (shop_offset_ != before) looked_.reset();
      }
    }
    if (r.clears)
      if (auto bad = placed(r.column, execution_.clear_zeros())) return bad;
    if (auto bad = length(r)) return bad;
    // The tool, the spindle, coolants; a stop and the end stand behind the motion of their block.
    std::sort(r.m.begin(), r.m.end(), [](int a, int b) { return group_of_m(a) < group_of_m(b); });
    std::optional<int> last;
    for (const int m : r.m) {
      if (group_of_m(m) == kStops) last = m;
      else if (auto bad = machine_function(m, r)) return bad;
    }
    if (r.switch_tcp >= 0)
      if (auto bad = placed(r.column, r.switch_tcp == 1 ? execution_.tcp_on() : execution_.tcp_off())) return bad;
    if (r.motion >= 0) motion_ = r.motion;
    if (r.g53 && !moves(r)) return here(r.column, "G53 without an axis word");
    unsaid_.said_groups(r.groups);
    if (!unsaid_.none() && (moves(r) || r.to_reference)) return here(r.column, unsaid_.text("an axis word"));
    if (r.to_reference) {
      if (auto bad = reference(r)) return bad;
    } else if (moves(r)) {
      if (auto bad = move(r)) return bad;
    }
    return last ? machine_function(*last, r) : std::nullopt;
  }
  static bool moves(const Request& r) {
    return std::any_of(r.move.has.begin(), r.move.has.end(), [](bool h) { return h; });
  }

  Problem length(const Request& r) {
    if (r.g49) {
      // With G43.4 in force this is the end of TCP: it stands with a machine-coordinate move of Z.
      if (has_g(434) && execution_.tcp()) {
        if (!r.g53) return here(r.column, "G49 ends TCP and must stand with G53");
        if (auto bad = placed(r.column, execution_.tcp_off())) return bad;
      }
      if (execution_.tcp()) return here(r.column, "G49 with TCP on");
      execution_.drop_length();
    }
    if (r.h && !r.g43) return here(r.column, "H without G43");
    if (!r.g43) return std::nullopt;
    if (!r.h || *r.h != std::floor(*r.h) || !(*r.h >= 0 && *r.h < 1e6))
      return here(r.column, "G43 needs the H of a tool in the list");
    return placed(r.column, execution_.set_length(static_cast<int>(*r.h)));
  }

  Problem machine_function(int m, const Request& r) {
    switch (m) {
      case 3: return placed(r.column, execution_.spindle_on());
      case 5: execution_.spindle_off(); break;
      case 0:
      case 1: execution_.stop(); break;
      case 6: return placed(r.column, execution_.change_tool());
      case 2:
      case 30: flow_.end(); return placed(r.column, execution_.end_program(flow_.inside_call()));
      case 97:
        if (moves(r) || !r.p || !flow_.has_lines(*r.p))
          return here(r.column, "M97 needs the P of an N word in this file and no axis word");
        return flow_.call_lines(*r.p);
      case 98: {
        const std::int64_t p = r.p && std::abs(*r.p) < 1e9 ? static_cast<std::int64_t>(*r.p) : -1;
        if (moves(r) || !flow_.has_program(p))
          return here(r.column, "M98 needs the P of a sub-program in this file and no axis word");
        return flow_.call_program(p);
      }
      case 99: return flow_.return_from_program(r.column);
      default: return builders_word(m, r);
    }
    return std::nullopt;
  }

  /// What clamps a rotary or switches a coolant.
  Problem builders_word(int m, const Request& r) {
    const bool output = m == 64 || m == 65;
    const std::string word = output ? fmt::format("M{} P{}", m, r.p.value_or(-1)) : fmt::format("M{}", m);
    const bool clamps = control_.clamped_by(word).has_value();
    if (output && !clamps) return here(r.column, fmt::format("{} is no word of the machine file", word));
    if (clamps && moves(r))
      return here(r.column, fmt::format("{} with an axis word: whether it acts ahead of the motion is the builder's "
                                        "business, it stands in a block of its own",
                                        word));
    if (!execution_.switch_clamp(word)) execution_.switch_coolant(word);
    return std::nullopt;
  }

  Problem move(Request& r) {
    if (motion_ < 0) return here(r.column, "axis word before G0 or G1");
    if (r.g53 && motion_ != 0) return here(r.column, "G53 with G1");
    if (language_.corner_of_g64 != nullptr && motion_ == 1 && !corners_said_)
      return here(
          r.column,
          "G1 ahead of G61, G61.1 or G64 P: how far the control leaves the path would depend on the last program");
    if (language_.stops_at_corners && motion_ == 1 && !corners_said_ && !execution_.in_site_smoothing())
      return here(r.column,
                  "G1 without G61, and no post.corner_tolerance in the machine file ahead of G64: nothing says how far "
                  "the control leaves the corners");
    r.move.rapid = motion_ == 0;
    r.move.machine_frame = r.g53;
    r.move.compensation = r.g43 && !r.tcp;
    r.move.own_feed = r.f.has_value();
    look_at_offset();
    const auto& has = r.move.has;
    if (r.tcp && (has[0] || has[1] || has[3] || has[4] || motion_ != 0))
      return here(r.column, "G43.4 moves Z alone, with G0");
    if (auto bad = placed(r.column, execution_.move(r.move, flow_.line()))) return bad;
    flow_.moved();
    return r.tcp ? placed(r.column, execution_.tcp_on()) : std::nullopt;
  }

  const NcControl& control_;
  const IsoLanguage& language_;
  NcFlow flow_;
  NcExecution execution_;
  int motion_ = -1;
  int shop_offset_ = -1;               // number of the work offset of the shop that was selected last
  std::optional<std::size_t> looked_;  // parameters that were seen to be 0 when it was looked at
  tool_check::Unsaid unsaid_;
  bool corners_said_ =
      false;  // how far the control leaves corners: G61, G61.1, G64 P, or G64 with what the machine states
};

}  // namespace

Status execute_iso(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink,
                   const IsoLanguage& language) {
  return Interpreter(text, file, control, sink, language).run();
}

}  // namespace toothpath::iso
