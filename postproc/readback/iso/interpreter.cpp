#include "postproc/readback/iso/interpreter.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "postproc/readback/iso/flow.h"
#include "postproc/readback/iso/frame_words.h"
#include "postproc/readback/iso/words.h"
#include "postproc/tool_check/lines.h"
#include "postproc/tool_check/unsaid.h"

namespace toothpath::iso {
namespace {

using readback::MoveSink, readback::NcControl, readback::NcExecution, readback::kStops, readback::group_of_m;

class Interpreter {
 public:
  Interpreter(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink,
              const IsoLanguage& language)
      : text_(text),
        file_(file),
        control_(control),
        language_(language),
        flow_(text, file, language.o_words, control),
        execution_(control, language.rules, sink),
        words_(control, language, flow_),
        frames_(control, language, flow_, execution_) {}

  Status run() {
    if (auto bad = readback::no_acting_comment(text_, file_, language_.acting_comment); !bad) return bad;
    return flow_.run([this](const NcBlock& b) { return block(b); });
  }

 private:
  using Problem = std::optional<Diagnostic>;
  Diagnostic here(int column, std::string message) const { return flow_.here(column, std::move(message)); }
  Problem placed(int column, NcExecution::Problem problem) const { return flow_.placed(column, std::move(problem)); }

  Problem block(const NcBlock& b) {
    if (b.operation >= 0) execution_.begin_operation(b.operation);
    if (b.tooth >= 0) execution_.begin_tooth(b.tooth);
    if (b.words.empty()) {
      const int checked = execution_.check_lines() > 0 ? tool_check::checked_tool(flow_.text()) : -1;
      return checked >= 0 ? check_tool(checked) : std::nullopt;
    }
    if (b.skip)
      if (auto bad = words_.skippable(b)) return bad;
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
    if (has_g(language_, 921)) modes[11] = "G92.1";
    else modes[kZeros] = "G52 with 0 of all axes";
    if (has_g(language_, 690)) modes[13] = "G69";
    unsaid_.all(std::move(modes));
    return std::nullopt;
  }

  Problem words(const NcBlock& b) {
    Request r;
    if (auto bad = words_.sort(b, r)) return bad;
    if (r.absolute) execution_.set_absolute();
    if (r.millimetres) execution_.set_unit();
    if (r.dwell) return dwell(r);
    if (r.zeros) {
      auto bad = frames_.zeros(r);
      if (!bad && frames_.clears_zeros(r)) unsaid_.said(kZeros);
      return bad;
    }
    if (r.writes) return frames_.write_offset(r);
    if (r.turn) return here(r.column, "R is read with G10 L2 alone");
    return apply(r);
  }

  /// G4 in a block of its own.
  Problem dwell(const Request& r) {
    const bool by_x = language_.dwell_x && r.move.has[0];
    if (by_x == r.p.has_value() || r.words != 2)
      return here(r.column, fmt::format("G4 stands in a block of its own, with P{}", language_.dwell_x ? " or X" : ""));
    if (by_x) return placed(r.column, execution_.dwell(r.move.axis[0] / 60));
    if (language_.dwell == DwellNumber::milliseconds && r.p_point)
      return here(r.p_column, "P of G4 is a whole number of milliseconds");
    const bool seconds =
        language_.dwell == DwellNumber::seconds || (language_.dwell == DwellNumber::by_point && r.p_point);
    return placed(r.p_column, execution_.dwell(*r.p / (seconds ? 60 : 60000)));
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

  Problem apply(Request& r) {
    if (r.extended) {
      const std::string code = g_word(language_.extended.tenths);
      const int last = language_.extended.last;
      if (!r.p || *r.p != std::floor(*r.p) || !(*r.p >= 1 && *r.p <= last))
        return here(r.column, fmt::format("{} needs P1 to P{}", code, last));
      r.offset = fmt::format("{} P{}", code, static_cast<int>(*r.p));
      r.p.reset();
    }
    if (r.plane || r.to_plane) return frames_.tilt(r);
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
    if (auto bad = frames_.select(r)) return bad;
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

  Problem length(const Request& r) {
    if (r.g49) {
      // With G43.4 in force this is the end of TCP: it stands with a machine-coordinate move of Z.
      if (has_g(language_, 434) && execution_.tcp()) {
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
    frames_.look();
    const auto& has = r.move.has;
    if (r.tcp && (has[0] || has[1] || has[3] || has[4] || motion_ != 0))
      return here(r.column, "G43.4 moves Z alone, with G0");
    if (auto bad = placed(r.column, execution_.move(r.move, flow_.line()))) return bad;
    flow_.moved();
    return r.tcp ? placed(r.column, execution_.tcp_on()) : std::nullopt;
  }

  std::string_view text_;
  const std::string& file_;
  const NcControl& control_;
  const IsoLanguage& language_;
  NcFlow flow_;
  NcExecution execution_;
  WordSorter words_;
  FrameWords frames_;
  int motion_ = -1;
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
