// What differs between controls, as data: numbers, words and the lines that stand at certain places of every program.
// Made in the folder of the control, postproc/controls; docs/dialects.md says how to add one.
//
// Lines are templates: {offset} G54 .., {datum} 1 for G54 and so on, {tool} number, {speed} 1/min, {top} machine Z of
// the retract, {work_top} the same as a Z word with this tool's length, {z} Z word of the block that switches TCP on,
// {blend} mm, {blend_axis} deg, {finish}, {cut} FINISH or ROUGH and {roughs} 0 or 1 of an operation, {free} a feed
// where nothing is cut, {teeth}, {label} and {label+1} numbers that belong to the operation alone, {sign} and
// {frame_sign} "-" or nothing, {turns} the teeth that the index is turned by, {number} and {name} of the program, {id}
// its name in letters and digits. In the loop over the teeth: {first} place of the order that it begins with, {last}
// one, {end} the one behind it, {stride} of the order, {tooth} the variable that holds the tooth, {index_axis} letter
// of the index rotary, {angle} its turn to the tooth where calls stand one by one, {zeros} all axes at 0, {program}
// number of the sub-program, {operation}, {operation_type}. The line "{safe_start}" stands for all lines of
// `safe_start`, "{corners}" for those of `corners`, "{pick}" for those of `pick` where the order is spread,
// "{first_tooth}" for the comment that names the line behind it, "{zero_on}" and "{zero_off}" for those of the loop
// that move the zero of the index rotary. Values are printed in the format of the dialect.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/base/result.h"
#include "postproc/joints/program.h"

namespace toothpath::text {

using NcLinesOfText = std::vector<std::string>;
struct NcDialect;
struct NcHeader;
struct NcText;

/// The teeth of an operation as a loop of the control.
struct NcLoop {
  enum class Form : std::uint8_t {
    none,         ///< every tooth is written out
    in_line,      ///< `before`, the blocks of the tooth, `after`
    sub_program,  ///< `before`, the blocks, `after` ahead of the operation; `call` in its place
    called,       ///< `before`, the blocks, `after` behind the main program; `call` for every tooth in its order
  };
  Form form = Form::none;
  NcLinesOfText before, after, call;
  NcLinesOfText pick;  ///< the tooth from its place in the order, by whole numbers; in sequence the place is the tooth
  std::string place, tooth;  ///< the variables of place and picked tooth
  NcLinesOfText define;      ///< ahead of all blocks: the variables, {counters}: `place`, in another order `tooth` too
  std::string index;         ///< ahead of the number of the index rotary: "R2" prints C=R2+12.5
  /// The words of the index rotary count from the angle of the tooth, ahead of it, and from the machine's zero, behind
  /// the operation: they are then those of tooth 0. Empty: `index` stands in every word.
  NcLinesOfText zero_on, zero_off;
  bool zero_with_tcp = false;  ///< while TCP is on, too; else `index` stands in the words then
  /// The control can be set so that TCP takes the moved zero as the table's own, and the frame turns with it; the
  /// machine file says whether it is: `zero_turns_frame`, and no other frame then. A comment of programs that do it;
  /// empty: it cannot.
  std::string zero_note;
  bool zero_turns_frame = false;
  NcLinesOfText frame_on, frame_off;  ///< around TCP: turns the frame by the index; empty: no loop with TCP
  /// The frame is a work offset of the control, {index_offset}, which has the number {index_datum}, which the machine
  /// file leaves to programs: beside `zero_on` and `zero_off`, with TCP. {origins}: the axes at the origins of the work
  /// offset. Empty: the frame is none.
  NcLinesOfText offset_on, offset_off;
  std::string index_offset;  ///< of the machine file
};

/// Rotaries that the control counts within one turn (`rollover` in the machine file): words of 0 to 360 deg, and the
/// way that is taken.
struct NcRollover {
  enum class Way : std::uint8_t {
    none,      ///< the dialect does not know such axes
    shortest,  ///< the nearer way
    sign,      ///< the sense of the sign: -10 goes to 10 backwards
  };
  Way way = Way::none;
  std::string open, close;  ///< around the number: "DC(" and ")"
  std::string index;  ///< in a loop, between these: the place within the turn, from {word}, a sum that is not below 0
  std::string backwards;  ///< in a loop whose index falls, instead of {sign}{tooth}: not below 0 either
  std::string note;       ///< comment at the top, with {axis}: what the control must be set to
};

/// Tilted planes of a control: {plane_x} {plane_y} {plane_z} the origin, seen from the work offset; {turn} deg about Z,
/// then {tilt_x} or {tilt_y} about the turned X or Y. As Euler's angles: {euler_turn} about Z, {tilt} about the new X,
/// {euler_spin} about the new Z. {pair}: which pair of rotary angles.
struct NcPlanes {
  NcLinesOfText on;          ///< the plane, and the turn of the rotaries to it; empty: the dialect has none
  NcLinesOfText shift;       ///< ahead of `on`, where the origin is not that of the work offset
  NcLinesOfText off;         ///< stands in every safe start, too
  std::string upper, lower;  ///< {pair}: the rotary that tilts above its zero, or below
  /// In a loop whose control takes no arithmetic in a word: this line ahead of `on`, with the {angle} that is added to
  /// that of the tooth, and the variable that holds the sum. Empty: `NcLoop::index` and the angle.
  std::string index_line, index;
  std::string assumed;  ///< of the control, with {axis} that tilts
  std::string zero;     ///< as NcDialect::tcp_zero
};

/// What a control wants to read.
struct NcDialect {
  std::string name;                           ///< as in a machine file
  std::string extension;                      ///< ".ngc"
  bool name_begins_with_two_letters = false;  ///< of programs known by the name of their file
  joints::WordFormat format;

  // Words.
  bool point_always = false;  ///< "10." and never "10"
  bool sign_always = false;   ///< "+10"
  std::string rotary_equals;  ///< between the letter of a rotary and its number
  std::string rapid = "G0", feed = "G1";
  bool motion_is_modal = true;  ///< G0 and G1 on change only
  std::string rapid_end;        ///< behind the words of a rapid
  std::size_t max_line = 252;   ///< characters

  // Feed.
  bool inverse_time = true;     ///< G93 exists; else joint blocks that turn cannot be timed and are refused
  double max_inverse_time = 0;  ///< greatest F in G93; 0: no limit
  double min_feed_product = 0;  ///< G93 blocks with F * path below it are printed in G94 (mm/min); 0: none

  // Comments and block numbers.
  std::string comment_open = "(", comment_close = ")";
  bool block_numbers = false;  ///< every line, from 0

  // Lines.
  NcLinesOfText frame_begin, frame_end;  ///< first and last lines of the file
  NcLinesOfText safe_start;              ///< modal groups reset before anything moves
  /// For the graphics, ahead of `start`: {blank_top} {blank_bottom} {blank_length} {blank_radius} {blank_diameter}, of
  /// a ring also {bore_radius} {bore_diameter}. Empty: the control has no such words.
  NcLinesOfText blank, blank_ring;
  NcLinesOfText start, end;  ///< of the program
  /// Behind `start`, once: end the program where the work offset turns, or moves a rotary. {offset_squares}: the sum of
  /// the squares of all that must be 0; {offset_words}: what it is, "A, C, R". Empty: the control has no such words.
  NcLinesOfText offset_check;
  /// What must hold of the work offset beside X Y Z, for who sets the machine up: {offset}, {datum}, and {rotaries},
  /// "A, C".
  std::string offset_trust;
  NcLinesOfText message;              ///< ahead of an operation: what the control shows meanwhile; {operation_type}
  NcLinesOfText body_end;             ///< ahead of sub-programs that stand behind the main program
  NcLinesOfText retract;              ///< Z to its top, machine coordinates
  NcLinesOfText reference_retract;    ///< the same by the reference position; empty: the machine file cannot ask for it
  NcLinesOfText tool_call;            ///< behind the retract, where the tool changes: fetches it
  NcLinesOfText tool_keep;            ///< in their place where it stays
  NcLinesOfText tool_change;          ///< behind these: safe start, spindle
  NcLinesOfText tool_next;            ///< behind a change: the changer makes {next} ready; not where none follows
  NcLinesOfText spindle_on = {"M3"};  ///< with the speed that was said
  /// Lines of the shop (post.start, ..): behind `start`, behind every tooth, behind `end`; its tool change stands in
  /// `tool_call`.
  NcLinesOfText own_start, own_between_teeth, own_end;
  /// Check the tool in the spindle at the setter (tool_checks.h says the names in braces); empty: the control has no
  /// documented cycle, the machine file says the lines. What they trust the control with, for those who list it.
  NcLinesOfText check_lines;
  std::string check_trust;
  NcLinesOfText tool_recall;                      ///< behind a check: the length is said again
  std::optional<machines::ToolCheck> tool_check;  ///< of the machine, with its lines or these
  NcLinesOfText compensation;                     ///< tool length, programs without TCP
  NcLinesOfText tcp_compensation;                 ///< the same with TCP
  NcLinesOfText pause = {"M0"};                   ///< waits for the start button
  NcLinesOfText operation_end;                    ///< ahead of coolant and spindle off
  NcLinesOfText spindle_off = {"M5"};
  std::map<machines::Coolant, machines::CoolantWords> coolant = {
      {machines::Coolant::mist, {"M7", "M9"}}, {machines::Coolant::flood, {"M8", "M9"}}};  ///< those of ISO 6983
  bool takes_coolant = true;  ///< the machine file may name M words of its builder
  std::vector<std::pair<int, int>> own_m = {
      {0, 6}, {19, 19}, {30, 30}, {96, 99}};  ///< M words, first to last, that can be no coolant
  /// M words, first to last, that may hold a rotary although `own_m` has them; `only_clamp_m`: no others may.
  std::vector<std::pair<int, int>> clamp_m;
  bool only_clamp_m = false;
  bool clamps_by_output = false;  ///< "M64 P0" and "M65 P0" may, too: outputs of the control
  std::array<std::optional<machines::RotaryClamp>, 2> clamps;  ///< of the rotaries of the machine
  NcLinesOfText corners;     ///< "{corners}" of `start`, and ahead of an operation that has others than the one before
  bool blend = false;        ///< `corners` lets the control leave corners by {blend}: counts as deviation
  double exact_path_mm = 0;  ///< without `blend`: the tip is off a corner by up to this all the same
  /// Codes of a control that stops at every corner or leaves corners by what nobody states: `corner_stop` stands in
  /// `safe_start`; `corner_flow` in its place where the machine file states `corner_mm`, and around smoothing. Empty:
  /// the dialect has other words for it.
  std::string corner_stop, corner_flow;
  double corner_mm = 0;  ///< the tip is off a corner by no more under `corner_flow`; 0: not stated
  /// {blend} is not a distance from the path but the way ahead of and behind a corner within which every axis may leave
  /// it (G641 ADIS).
  bool blend_is_way = false;
  /// With it, where cuts turn a rotary without TCP: all {axes} are the path, a rotary {axis} at the {radius} mm; at the
  /// end none is named.
  std::string path_group, path_radius, path_group_end;
  /// In place of `corners` where the tolerance is a share of what the proof leaves: ahead of the teeth of
  /// an operation and behind them; {finish} is one of `contour_finish`, without TCP and with it. Empty: the same line.
  NcLinesOfText contour_on, contour_off;
  std::array<std::string, 2> contour_finish{};
  std::string contour_trust;     ///< what that trusts the control with, for those who list what is assumed
  bool blend_axis = false;       ///< `corners` lets the control lean the tool by {blend_axis} deg while TCP is on
  bool takes_smoothing = false;  ///< the machine file may state lines that switch the control's own smoothing
  NcLinesOfText smoothing_on,
      smoothing_off;        ///< those lines, ahead of the teeth of an operation and behind them; instead of `blend`
  double smoothing_mm = 0;  ///< what the machine file states: the tip leaves the path by no more
  std::optional<double> smoothing_axis_rad;  ///< the tool axis; not stated: no cut may turn a rotary

  int (*datum)(std::string_view work_offset) =
      nullptr;  ///< {datum}, the number of a work offset; null: the lines do not use it
  /// {index_datum}, the same for `NcLoop::index_offset`, and the parameter that holds the origin of such a number in X;
  /// those of Y Z A B C follow, and that of its turn about Z is the ninth behind it.
  int (*offset_number)(std::string_view work_offset) = nullptr;
  int (*origin_parameter)(int number) = nullptr;

  // TCP.
  bool tcp_codes_of_site = false;   ///< the codes are those of the machine file, there are none else
  NcLinesOfText tcp_on, tcp_off;    ///< empty: the dialect has no TCP (or its codes are site data)
  bool tcp_starts_at_zero = false;  ///< the table frame is frozen where TCP starts
  /// The text has places of the tool alone, tip and axis. What lies between two of them, in which order the axes move
  /// and where the top of Z is, is the business of a post processor.
  bool cutter_locations = false;
  std::array<std::string, 3> vector_words{};  ///< ahead of the components of the tool axis; empty: no vectors
  std::string vector_feed;                    ///< instead of `feed` in blocks with a vector
  /// What the control must be set to for TCP, lines for the top of programs and the set-up sheet.
  NcLinesOfText tcp_notes;
  /// {axis}, whose `zero` in the machine file is not 0: which data of the control must say so for TCP. Empty: it counts
  /// from 0 whatever they say, and machines with another zero are refused.
  std::string tcp_zero;

  NcLoop loop;
  NcRollover rollover;
  NcPlanes planes;

  /// A dialect whose text is not made of blocks with words: prints everything. Null: the common writer.
  Result<NcText> (*write)(const joints::AxisProgram&, const NcDialect&, const NcHeader&) = nullptr;
};

/// The control knows its programs by numbers: {number}.
[[nodiscard]] bool has_program_number(const NcDialect& dialect);

/// The names that a line of the shop may have in braces. @param tool it stands where a tool is known
[[nodiscard]] std::vector<std::string> names_of_own_lines(const NcDialect& dialect, bool tool);
/// The first name in braces that is none of them; nothing: all are.
[[nodiscard]] std::optional<std::string> unknown_name(std::string_view pattern, const std::vector<std::string>& names);

/// `NcDialect::offset_check` and `offset_trust` for a work offset and the axes of a machine, 0: none. Empty where the
/// dialect says nothing.
[[nodiscard]] NcLinesOfText offset_check_lines(const NcDialect& dialect, const std::string& work_offset,
                                               const std::array<char, 5>& letters);
[[nodiscard]] std::string offset_trust(const NcDialect& dialect, const std::string& work_offset,
                                       const std::array<char, 5>& letters);

/// Words for a coolant that is not off.
/// Errors: the control has none and the machine file names none. The message says which ones there are.
[[nodiscard]] Result<machines::CoolantWords> coolant_words(const NcDialect& dialect, machines::Coolant coolant);

}  // namespace toothpath::text
