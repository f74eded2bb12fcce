// Fanuc and compatible controls, IS-B (3 decimals), without TCP: every value has a point, G43 stands with Z, G49 only in
// the block of a machine-coordinate retract, the largest F in G93 is 9999.999.
#include "postproc/nc_writer.h"

namespace toothpath {

NcDialect fanuc_dialect() {
  NcDialect d;
  d.name = "fanuc";
  d.extension = ".nc";
  d.format = {.linear_decimals = 3, .rotary_decimals = 3};
  d.point_always = true;
  d.percent_frame = true;
  d.max_inverse_time = 9999.999;
  d.max_line = 80;
  d.safe_start = {"G21 G17 G90 G94 G40 G80 G69"};
  d.compensation_with_z = true;
  d.program_end = "M30";
  return d;
}

}  // namespace toothpath
