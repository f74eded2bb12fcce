// LinuxCNC 2.8 and later, joint output without TCP. G92.1 clears offsets that an earlier program left; G64 needs P, or
// the control leaves the path as far as it likes; blocks that hardly move X, Y, Z lose their time in G93 before 2.9.0,
// so they are printed in G94 with the exact feed.
#include "postproc/nc_writer.h"

namespace toothpath {

NcDialect linuxcnc_dialect() {
  NcDialect d;
  d.name = "linuxcnc";
  d.extension = ".ngc";
  d.format = {.linear_decimals = 4, .rotary_decimals = 5};
  d.o_words = true;
  d.min_feed_product = 0.2;
  d.max_line = 252;
  d.safe_start = {"G21 G17 G90 G94 G40 G49 G80", "G92.1"};
  d.blend = true;
  d.program_end = "M2";
  return d;
}

}  // namespace toothpath
