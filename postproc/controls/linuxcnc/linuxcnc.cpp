// LinuxCNC 2.8 and later. G92.1 clears offsets that an earlier program left. G61: what G64 P leaves of a corner is more
// than P, does not hold for rotaries and saves no time (docs/dialects.md). Blocks that hardly move X, Y, Z lose their
// time in G93 before 2.9.0, so they are printed in G94 with the exact feed. The codes of TCP are remaps of the site:
// machine data.
#include <cmath>

#include "cam/tool/cutters.h"
#include "postproc/controls/control.h"
#include "postproc/controls/linuxcnc/comments.h"
#include "postproc/controls/work_offset.h"
#include "postproc/readback/iso/interpreter.h"

namespace toothpath::controls {
namespace {

/// 1 to 9: G54 to G59, G59.1 to G59.3.
int number_of_offset(std::string_view name) {
  if (const int basic = basic_offset(name); basic > 0) return basic - 53;
  return tenth_offset(name) > 0 ? 6 + tenth_offset(name) : -1;
}
int origin_parameter(int number) { return 5201 + 20 * number; }

/// A while, which the loop of the teeth has too. Squares: EQ and NE let a difference of 0.0001 pass.
void look_at_offset(text::NcDialect& d) {
  d.offset_check = {"o99 while [{offset_squares} GT 0]", "(ABORT, {offset_words} OF {offset} MUST BE 0)",
                    "o99 endwhile"};
  d.offset_trust = "{offset_words} of {offset} must be 0: the program looks and ends if they are not";
}

text::NcDialect words() {
  text::NcDialect d;
  d.name = "linuxcnc";
  d.extension = ".ngc";
  d.format = {.linear_decimals = 4, .rotary_decimals = 5};
  d.min_feed_product = 0.2;
  d.max_line = 252;
  d.safe_start = {"G21 G17 G90 G94 G40 G49 G80", "G92.1"};
  d.start = {"{safe_start}", "{offset}", "G61"};
  look_at_offset(d);
  d.retract = {"G53 G0 Z{top}"};
  d.tool_call = {"T{tool} M6"};
  d.tool_next = {"T{next}"};
  d.tool_change = {"{safe_start}", "{offset}", "S{speed} M3"};
  d.compensation = d.tcp_compensation = {"G43 H{tool}"};
  // The length in the table (#5403) is the one that G43 takes; #5063 is where the switch was met, seen from the work.
  d.check_lines = {"G49",
                   "G53 G0 X{x} Y{y}",
                   "G53 G0 Z[{z}+#5403+{clearance}]",
                   "G91 G38.3 Z[0-2*{clearance}] F{feed}",
                   "G90",
                   "#<_off>=[#5063+#<_abs_z>-#<_z>-{z}-#5403]",
                   "o{label} if [[#5070 EQ 0] OR [ABS[#<_off>] GT {tolerance}]]",
                   "G53 G0 Z{top}",
                   "(ABORT, TOOL {tool}: LENGTH OFF BY MORE THAN {tolerance} MM, OR NOT MET)",
                   "o{label} endif"};
  d.check_trust = "the tool setter is the probe input; #5403 is the length of the tool in the spindle";
  d.operation_end = {"G94 F{free}"};
  d.end = {"G61", "G49"};
  d.frame_end = {"M2"};
  d.own_m = {{0, 6}, {19, 19}, {30, 30}, {48, 53}, {60, 73}, {98, 99}};
  d.clamp_m = {{100, 199}};  // programs of the site
  d.only_clamp_m = d.clamps_by_output = true;
  d.exact_path_mm = 0.0005;  // unless the machine says otherwise
  d.tcp_codes_of_site = true;
  d.loop.form = text::NcLoop::Form::sub_program;
  d.loop.before = {"o{label} sub"};
  d.loop.after = {"o{label} endsub"};
  d.loop.call = {"{first_tooth}", "#1={first}",          "o{label+1} while [#1 LT {end}]",
                 "{pick}",        "{zero_on}",           "o{label} call",
                 "#1=[#1+1]",     "o{label+1} endwhile", "{zero_off}"};
  d.loop.pick = {"#2=[[#1*{stride}] MOD {teeth}]"};
  d.loop.place = "#1";
  d.loop.tooth = "#2";
  d.loop.zero_on = {"G52 {index_axis}[{sign}{tooth}*360/{teeth}]"};  // of an axis that rolls over below a turn
  d.loop.zero_off = {"G92.1"};
  d.loop.zero_with_tcp = true;
  // A turn of X Y belongs to a work offset there: one that the machine file leaves to programs.
  d.loop.offset_on = {"G10 L2 P{index_datum} {origins} R[{frame_sign}{tooth}*360/{teeth}]"};
  d.loop.offset_off = {"G10 L2 P{index_datum} R0"};
  d.loop.frame_on = {"{index_offset}"};
  d.loop.frame_off = {"{offset}"};
  d.offset_number = number_of_offset;
  d.origin_parameter = origin_parameter;
  d.rollover.way = text::NcRollover::Way::sign;
  d.rollover.note = "{axis} ROLLS OVER: [AXIS_{axis}] WRAPPED_ROTARY = 1";
  return d;
}

/// What its motion controller leaves of a corner under G64 P, mm. The next block begins a servo period early at worst,
/// and the samples are smoothed and joined by chords: docs/dialects.md. The machine says what its acceleration leaves
/// under G61, a T^2 / 4.
double corner_of_g64(double p_mm, double q_mm, double exact_mm) {
  constexpr double kUnequal = 1.06;  // blocks next to a corner that is passed without a stop accelerate by a tenth less
  const double early = std::sqrt(0.5 * exact_mm);  // (T / 2) sqrt(a / 2)
  const double root = std::sqrt(kUnequal * p_mm) + early;
  return root * root + 1.2 * exact_mm + q_mm;
}

const iso::IsoLanguage& language() {
  static const iso::IsoLanguage l = [] {
    iso::IsoLanguage linuxcnc;
    linuxcnc.o_words = linuxcnc.codes_of_site = linuxcnc.moves_zeros = true;
    linuxcnc.point_needed = false;
    linuxcnc.g_tenths = {100, 591, 592, 593, 610, 611, 640, 921};
    linuxcnc.number_of_offset = number_of_offset;
    linuxcnc.origin_parameter = origin_parameter;
    linuxcnc.corner_of_g64 = corner_of_g64;
    linuxcnc.acting_comment = linuxcnc_acting_comment;
    linuxcnc.most_m = 4;
    linuxcnc.dwell = iso::DwellNumber::seconds;
    linuxcnc.bare_reference = true;
    linuxcnc.rules.stop = readback::ProgramStop::waits;
    linuxcnc.rules.reference_keeps_length = true;
    linuxcnc.rules.least_rate = 0.1;  // before 2.9.0 the rate of a G93 block is raised to this
    linuxcnc.rules.per_minute_turns = linuxcnc.rules.sign_is_sense = linuxcnc.rules.offsets_turn = true;
    return linuxcnc;
  }();
  return l;
}

Status execute(std::string_view text, const std::string& file, const readback::NcControl& control,
               const readback::MoveSink& sink) {
  return execute_iso(text, file, control, sink, language());
}

/// A line a tool; mm, as the programs.
std::string tool_table(std::span<const tool::ToolAssembly> tools) {
  std::string text;
  for (const tool::ToolAssembly& t : tools)
    text += fmt::format("T{0} P{0} Z{1:+.6f} D{2:+.6f} ;{3}\n", t.number, t.length_mm, t.diameter_mm,
                        tool::cutter_comment(t));
  return text;
}

bool has_offset(std::string_view name) { return number_of_offset(name) > 0; }

/// About the axis that its letter names: +1 as ISO says, -1 reversed.
int sense_of(const machines::RotaryAxis& axis) { return axis.sign * (axis.direction[axis.letter - 'A'] < 0 ? -1 : 1); }

/// One pin of a table of two rotaries says which way both of them turn; without it, and by default, both are reversed.
std::string directions_note(const machines::KinematicChain& chain, const std::string& module) {
  const int c = sense_of(chain.table[0]), tilt = sense_of(chain.table[1]);
  if (c != tilt)
    return fmt::format("{} turns C and {} both as ISO says or both reversed, this machine file does not", module,
                       chain.table[1].letter);
  return fmt::format("{}.conventional-directions must be {}", module, c > 0 ? "1" : "0, as by default");
}

/// Its modules know the tool by a pin alone. xyzbc-trt-kins of master had a wrong inverse for a while (PR 4546).
text::NcLinesOfText tcp_notes(const machines::KinematicChain& chain) {
  const bool trunnion = chain.head.empty() && chain.table.size() == 2 && chain.table[0].letter == 'C';
  if (trunnion && chain.table[1].letter == 'A')
    return {"TCP: motion.tooloffset.z must reach xyzac-trt-kins.tool-offset", directions_note(chain, "xyzac-trt-kins")};
  if (trunnion && chain.table[1].letter == 'B')
    return {"TCP: motion.tooloffset.z must reach xyzbc-trt-kins.tool-offset", directions_note(chain, "xyzbc-trt-kins"),
            "xyzbc-trt-kins: none of master from 2025-06-26 to 2026-09-15, it errs"};
  const bool head = chain.table.empty() && chain.rotary_index('B') && chain.rotary_index('C');
  if (head) return {"TCP: 5axiskins.pivot-length is the pivot and motion.tooloffset.z"};
  return {"TCP: motion.tooloffset.z must reach the kinematics"};
}

}  // namespace

Control linuxcnc() {
  return {words(),
          {},
          {"G54 to G59 and G59.1 to G59.3", has_offset},
          execute,
          ToolTable{"program_tools.tbl", tool_table},
          probing::g38_probing,
          linuxcnc_acting_comment,
          tcp_notes};
}

}  // namespace toothpath::controls
