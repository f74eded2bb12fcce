// LinuxCNC 2.8 and later. G92.1 clears offsets that an earlier program left. G61: what G64 P leaves of a corner is more than P, does
// not hold for rotaries and saves no time (docs/dialects.md). Blocks that hardly move X, Y, Z lose their time in G93 before 2.9.0, so
// they are printed in G94 with the exact feed. The codes of TCP are remaps of the site: machine data.
#include "postproc/nc_dialect.h"

namespace toothpath {

NcDialect linuxcnc_dialect() {
  NcDialect d;
  d.name = "linuxcnc";
  d.extension = ".ngc";
  d.format = {.linear_decimals = 4, .rotary_decimals = 5};
  d.min_feed_product = 0.2;
  d.max_line = 252;
  d.safe_start = {"G21 G17 G90 G94 G40 G49 G80", "G92.1"};
  d.start = {"{safe_start}", "{offset}", "G61"};
  d.retract = {"G53 G0 Z{top}"};
  d.tool_change = {"T{tool} M6", "{safe_start}", "{offset}", "S{speed} M3"};
  d.compensation = d.tcp_compensation = {"G43 H{tool}"};
  d.operation_end = {"G94 F{free}"};
  d.end = {"G61", "G49"};
  d.frame_end = {"M2"};
  d.own_m = {{0, 6}, {19, 19}, {30, 30}, {48, 53}, {60, 73}, {98, 99}};
  d.exact_path_mm = 0.0005;  // unless the machine says otherwise
  d.loop.form = NcLoop::Form::sub_program;
  d.loop.before = {"o{label} sub"};
  d.loop.after = {"o{label} endsub"};
  d.loop.call = {"{first_tooth}", "#1={first}", "o{label+1} while [#1 LT {teeth}]", "{pick}", "o{label} call [{turns}*360/{teeth}]",
                 "#1=[#1+1]", "o{label+1} endwhile"};
  d.loop.pick = {"#2=[[#1*{stride}] MOD {teeth}]"};
  d.loop.place = "#1";
  d.loop.tooth = "#2";
  d.loop.index = "#1";
  d.loop.index_brackets = true;
  d.rollover.way = NcRollover::Way::sign;
  d.rollover.index = "[{word} MOD 360]";
  d.rollover.backwards = "[{teeth}-{tooth}]";
  d.rollover.note = "{axis} ROLLS OVER: [AXIS_{axis}] WRAPPED_ROTARY = 1";
  return d;
}

}  // namespace toothpath
