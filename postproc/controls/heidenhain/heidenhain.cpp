// Heidenhain TNC 640, plain text. There is no inverse time feed, so that blocks in which rotaries move need TCPM;
// without it the tilt is fixed in every pass. Cycle 32 bounds the blending of the corners (T: the tip, TA: the rotaries
// with TCPM). The teeth run in a section that is jumped back to (a count of repetitions would not follow a changed
// first tooth), under a datum shift of the index rotary; with TCPM cycle 10 turns X Y Z with it, which the shift alone
// does not. The remainder of the spread order is made with INT, half a unit away from where it could fall on the wrong
// side.
#include "postproc/controls/control.h"
#include "postproc/controls/heidenhain/heidenhain_reader.h"
#include "postproc/controls/heidenhain/lines.h"
#include "postproc/controls/heidenhain/presets.h"
#include "postproc/controls/work_offset.h"

namespace toothpath::controls {

namespace {

text::NcPlanes planes() {
  text::NcPlanes p;
  p.shift = {"TRANS DATUM AXIS X{plane_x} Y{plane_y} Z{plane_z}"};
  p.on = {"PLANE SPATIAL SPA{tilt_x} SPB{tilt_y} SPC{turn} TURN FMAX SEQ{pair} TABLE ROT"};
  p.off = {"PLANE RESET STAY", "TRANS DATUM RESET"};
  p.index_line = "FN 1: Q5 = +Q2 + {angle}";
  p.index = "Q5";
  p.upper = "+";
  p.lower = "-";
  p.zero = "PLANE SPATIAL counts {axis} from it, in the kinematics of the control";
  p.assumed =
      "SEQ+ of PLANE SPATIAL takes the pair with {axis} above its zero, SEQ- below; the preset is that of the part "
      "with all rotaries at zero; every rotary goes the nearer way";
  return p;
}

void checks_of_tools(text::NcDialect& d) {
  // Q340 = 2 compares and changes no table; Q115 is what the length is off by. Whoever goes on behind the stop is
  // stopped again.
  d.check_lines = {"TCH PROBE 481 TOOL LENGTH Q340=+2 Q260={work_top} Q341=+0",
                   "FN 11: IF +Q115 GT +{tolerance} GOTO LBL {label}",
                   "FN 12: IF +Q115 LT -{tolerance} GOTO LBL {label}",
                   "FN 9: IF +0 EQU +0 GOTO LBL {label+1}",
                   "LBL {label}",
                   "STOP",
                   "FN 9: IF +0 EQU +0 GOTO LBL {label}",
                   "LBL {label+1}"};
  d.check_trust =
      "cycle 481 with Q340 = 2 compares the length with TOOL.T and changes nothing, Q115 is what it is off by; LBREAK "
      "of the tool is above the tolerance, and an LTOL that is exceeded locks the tool";
  d.tool_recall = {"TOOL CALL {tool} Z S{speed}"};
}

text::NcDialect words() {
  text::NcDialect d;
  d.name = "heidenhain";
  d.extension = ".h";
  d.format = {.linear_decimals = 4, .rotary_decimals = 4};
  d.sign_always = true;
  d.rapid = d.feed = "L";
  d.motion_is_modal = false;
  d.rapid_end = " R0 FMAX";
  d.max_line = 120;
  d.inverse_time = false;
  d.comment_open = "; ";
  d.comment_close = "";
  d.block_numbers = true;
  d.frame_begin = {"BEGIN PGM {id} MM"};
  d.frame_end = {"M30", "END PGM {id} MM"};
  d.safe_start = {"PLANE RESET STAY", "FUNCTION RESET TCPM", "TRANS DATUM RESET", "CYCL DEF 10.0 ROTATION",
                  "CYCL DEF 10.1 ROT+0"};
  d.blank = {"BLK FORM CYLINDER Z R{blank_radius} L{blank_length} DIST{blank_top}"};
  d.blank_ring = {"BLK FORM CYLINDER Z R{blank_radius} L{blank_length} DIST{blank_top} RI{bore_radius}"};
  d.start = {"{safe_start}", "CYCL DEF 247 DATUM SETTING Q339=+{datum}", "M126", "{corners}"};
  d.corners = {"CYCL DEF 32.0 TOLERANCE", "CYCL DEF 32.1 T{blend}", "CYCL DEF 32.2 HSC-MODE:{roughs} TA{blend_axis}"};
  d.datum = preset_number;
  d.retract = {"L Z{top} R0 FMAX M91"};
  d.tool_call = {"TOOL CALL {tool} Z S{speed}"};
  d.tool_keep = {"TOOL CALL S{speed}"};
  d.tool_next = {"TOOL DEF {next}"};
  d.offset_trust = "preset {datum} has no basic rotation (SPA, SPB, SPC), and is 0 for {rotaries} and their offsets";
  d.tool_change = {"{safe_start}", "CYCL DEF 247 DATUM SETTING Q339=+{datum}", "M3"};
  checks_of_tools(d);
  d.coolant = {{machines::Coolant::flood, {"M8", "M9"}}};  // M7 is none of its own
  d.own_m = {{0, 6}, {13, 14}, {19, 19}, {30, 30}, {89, 299}};
  d.end = {"CYCL DEF 32.0 TOLERANCE", "CYCL DEF 32.1", "M127"};
  d.blend = d.blend_axis = true;
  d.contour_trust = "what cycle 32 says, by the manuals";
  d.tcp_on = {"FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS"};
  d.tcp_off = {"FUNCTION RESET TCPM"};
  d.tcp_zero = "TCPM counts {axis} from it, in the kinematics of the control";
  d.vector_words = {"TX", "TY", "TZ"};
  d.vector_feed = "LN";
  d.planes = planes();
  d.loop.form = text::NcLoop::Form::in_line;
  d.loop.before = {"{first_tooth}", "Q1 = {first}", "LBL {label}", "{pick}", "Q2 = {turns} * 360 / {teeth}",
                   "{zero_on}"};
  d.loop.after = {"Q1 = Q1 + 1", "FN 12: IF +Q1 LT +{end} GOTO LBL {label}", "{zero_off}"};
  d.loop.pick = {"Q6 = ( Q1 * {stride} + 0.5 ) / {teeth}", "Q6 = INT Q6", "Q4 = Q1 * {stride} - Q6 * {teeth}"};
  d.loop.place = "Q1";
  d.loop.tooth = "Q4";
  d.loop.zero_on = {"CYCL DEF 7.0 DATUM SHIFT", "CYCL DEF 7.1 {index_axis}+Q2"};
  d.loop.zero_off = {"TRANS DATUM RESET"};
  d.loop.zero_with_tcp = true;
  d.rollover.way = text::NcRollover::Way::shortest;  // M126
  d.rollover.backwards = "( {teeth} - {tooth} )";
  d.rollover.note = "{axis} ROLLS OVER: MODULO AXIS, DISPLAY BELOW 360";
  d.loop.frame_on = {"Q3 = {frame_sign}{tooth} * 360 / {teeth}", "CYCL DEF 10.0 ROTATION", "CYCL DEF 10.1 ROT+Q3"};
  d.loop.frame_off = {"CYCL DEF 10.0 ROTATION", "CYCL DEF 10.1 ROT+0"};
  return d;
}

bool has_offset(std::string_view name) {
  const int preset = whole_number(name);
  return basic_offset(name) > 0 || tenth_offset(name) > 0 || (preset >= 1 && preset <= 99);
}

}  // namespace

Control heidenhain() {
  return {words(),
          {},
          {"the presets 1 to 99, or G54 for preset 1 to G59 for 6, G59.1 for 7 to G59.3 for 9", has_offset},
          execute_heidenhain,
          std::nullopt,
          probing::touch_probe_probing,
          heidenhain_acting_comment};
}

}  // namespace toothpath::controls
