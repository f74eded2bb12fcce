// Mitsubishi M80: the Fanuc words with four decimals, a larger greatest F in G93, F behind every return to G94, no TCP. Made
// as docs/dialects.md tells: a copy of fanuc.cpp with what the manual of the control says differently.
#include "postproc/nc_dialect.h"

namespace toothpath {

NcDialect mitsubishi_m80_dialect() {
  NcDialect d = fanuc_dialect();
  d.name = "mitsubishi_m80";
  d.format = {.linear_decimals = 4, .rotary_decimals = 4};
  d.max_inverse_time = 999999.999;
  d.tcp_on.clear();
  d.tcp_off.clear();
  d.tcp_starts_at_zero = false;
  d.tcp_note.clear();
  d.rollover.note = "{axis} ROLLS OVER: SHORTCUT OF THE ROTARY AXIS VALID, 8213=1";
  return d;
}

}  // namespace toothpath
