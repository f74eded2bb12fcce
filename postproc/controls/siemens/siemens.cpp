// Siemens 840D sl. TRAORI and TRAFOOF may drop the frames (machine data 10602), so that the work offset stands behind
// each of them. TRANS lets the words of the index rotary count from the angle of the tooth; with TRAORI, too, where the
// machine file says that it takes such an offset, and then it stands behind each of them as well. G641 ADIS is the way
// ahead of and behind a corner within which the axes may leave the path; where cuts turn a rotary the text names the
// axes whose travel is the way, and the compressor stays off. Where the proof leaves room CYCLE832 takes its place,
// with its compressor: its tolerances bound the tip, and with TRAORI the rotaries. The teeth run in a FOR loop of the
// control, counted by variables of DEF INT; with TRAORI the programmable frame ROT turns with them. The remainder of
// the spread order is made with TRUNC, half a unit away from where it could fall on the wrong side. ORIAXES: the
// rotaries are linear between the blocks, also where a block carries the tool vector A3 B3 C3.
#include "postproc/controls/control.h"
#include "postproc/controls/siemens/lines.h"
#include "postproc/controls/siemens/siemens_reader.h"
#include "postproc/controls/work_offset.h"

namespace toothpath::controls {

namespace {

text::NcPlanes planes() {
  text::NcPlanes p;
  // _MODE 39: axis by axis about Z, X and Y.
  p.on = {"CYCLE800(0,\"\",0,39,{plane_x},{plane_y},{plane_z},{turn},{tilt_x},{tilt_y},0,0,0,{pair},0,1)"};
  p.off = {"CYCLE800()"};
  p.upper = "1";
  p.lower = "-1";
  p.zero = "CYCLE800 counts {axis} from it, offset of the rotary in the swivel data set";
  p.assumed =
      "CYCLE800 has one swivel data set, whose direction 1 is {axis} above its zero and -1 below; CYCLE800() turns "
      "nothing; every rotary goes the nearer way";
  return p;
}

void add_loop(text::NcDialect& d) {
  d.loop.form = text::NcLoop::Form::in_line;
  d.loop.before = {"{first_tooth}", "FOR COUNT={first} TO {last}", "{pick}", "R2={turns}*360/{teeth}", "{zero_on}"};
  d.loop.pick = {"TOOTH=COUNT*{stride}-{teeth}*TRUNC((COUNT*{stride}+0.5)/{teeth})"};
  d.loop.place = "COUNT";
  d.loop.tooth = "TOOTH";
  d.loop.define = {"DEF INT {counters}"};
  d.loop.after = {"ENDFOR", "{zero_off}"};
  d.loop.index = "R2";
  d.rollover.way = text::NcRollover::Way::shortest;
  d.rollover.open = "DC(";
  d.rollover.close = ")";
  d.rollover.index = "ABS({word}-360*TRUNC(({word})/360))";  // ABS: the quotient may be rounded up to a whole number
  d.rollover.backwards = "({teeth}-{tooth})";
  d.rollover.note = "{axis} ROLLS OVER: MODULO AXIS, 30310=1, 30330=360";
  d.loop.zero_on = {"TRANS {index_axis}=R2"};  // with TRAORI what it does is a matter of machine data
  d.loop.zero_note = "TRAORI TAKES ROTARY OFFSETS FROM THE FRAME: MACHINE DATA 24590 (24690, ..) = 1";
  d.loop.zero_off = {"TRANS"};
  d.loop.frame_on = {"R3={frame_sign}{tooth}*360/{teeth}", "ROT Z=R3"};
  d.loop.frame_off = {"ROT"};
}

text::NcDialect words() {
  text::NcDialect d;
  d.name = "siemens";
  d.extension = ".mpf";
  d.name_begins_with_two_letters = true;
  d.format = {.linear_decimals = 5, .rotary_decimals = 6};
  d.rotary_equals = "=";
  d.comment_open = ";";
  d.comment_close = "";
  d.max_line = 240;
  d.safe_start = {"G17 G40 G90 G94 G710", "TRAFOOF", "ROT", "COMPOF"};
  // All heights are absolute; the last but two is where the machining may end.
  d.blank = {"WORKPIECE(,\"\",,\"CYLINDER\",192,{blank_top},{blank_bottom},{blank_bottom},{blank_diameter})"};
  d.blank_ring = {
      "WORKPIECE(,\"\",,\"PIPE\",448,{blank_top},{blank_bottom},{blank_bottom},{blank_diameter},{bore_diameter})"};
  d.offset_trust = "{offset} and the basic frames have no rotation, and are 0 for {rotaries}";
  d.start = {"{safe_start}", "{offset}", "{corners}"};
  d.corners = {"G641 ADIS={blend}"};
  d.message = {"MSG(\"OP {operation} {operation_type}, T{tool}\")"};
  d.retract = {"SUPA G0 Z{top} D0"};
  d.tool_call = {"T=\"T{tool}\"", "M6"};
  d.tool_next = {"T=\"T{next}\""};
  d.tool_change = {"{safe_start}", "{offset}", "S{speed} M3"};
  d.compensation = d.tcp_compensation = {"D1"};
  d.operation_end = {"G94 F{free}"};
  d.end = {"G60", "{path_group_end}", "MSG()"};
  d.frame_end = {"M30"};
  d.blend = d.blend_is_way = true;
  d.takes_smoothing = true;  // lines of the shop in place of G641
  d.contour_on = {"CYCLE832({blend},{finish})"};
  d.contour_off = {"CYCLE832()", "G60"};
  d.contour_finish = {"_{cut},1", "_ORI_{cut},{blend_axis}"};
  d.contour_trust = "what G641 and CYCLE832 say, by the manuals";
  d.path_group = "FGROUP({axes})";
  d.path_radius = "FGREF[{axis}]={radius}";
  d.path_group_end = "FGROUP()";
  d.tcp_on = {"TRAORI", "{offset}", "ORIWKS", "ORIAXES"};
  d.tcp_off = {"TRAFOOF", "{offset}"};
  d.tcp_notes = {"TCP: machine data 21104 ORI_IPO_WITH_G_CODE = 1, so that ORIAXES rules"};
  d.tcp_zero = "TRAORI counts {axis} from it, machine data 24510 (24610, ..) TRAFO5_ROT_AX_OFFSET";
  d.vector_words = {"A3=", "B3=", "C3="};
  d.planes = planes();
  add_loop(d);
  return d;
}

bool has_offset(std::string_view name) {
  const int n = !name.empty() && name[0] == 'G' ? whole_number(name.substr(1)) : -1;
  return (n >= 54 && n <= 57) || (n >= 505 && n <= 599);
}

}  // namespace

Control siemens() {
  return {words(),
          {"sinumerik"},
          {"G54 to G57 and G505 to G599 (G58 and G59 shift single axes)", has_offset},
          execute_siemens,
          std::nullopt,
          probing::meas_probing,
          siemens_acting_comment};
}

}  // namespace toothpath::controls
