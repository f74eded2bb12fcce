// LinuxCNC without kinematics: every stroke is written out, change gears couple the work.
#include "postproc/shaper/control.h"
#include "postproc/shaper/program.h"

namespace toothpath::shaper {

ShaperControl linuxcnc() {
  ShaperControl c;
  c.dialect = {"linuxcnc", machines::ShaperGears::change_gears};
  c.extension = ".ngc";
  c.program = shaper_program_text;
  return c;
}

}  // namespace toothpath::shaper
