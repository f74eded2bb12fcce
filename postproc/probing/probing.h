// A program that touches places of a part one after the other and logs where the ball's centre stood.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::probing {

/// One touch; places of the ball's centre in the work offset, mm, while the rotaries stand.
struct ProbeTouch {
  int number = 0;
  std::string remark;                             ///< ASCII, upper case
  Vec3 start = Vec3::Zero();                      ///< straight below the clear height; the ball goes from here
  Vec3 meets = Vec3::Zero();                      ///< where it should touch, on the way to
  Vec3 past = Vec3::Zero();                       ///< here, where it has met nothing: then the program stops
  std::vector<std::pair<char, double>> rotaries;  ///< letter and degrees; they turn with the probe at its top
};

struct ProbeProgram {
  std::string job_name, machine_name;
  std::string work_offset;                ///< its name
  std::vector<std::string> offset_check;  ///< lines that end the program where it turns; empty: the control has none
  int datum = 0;                          ///< its number, on controls that know presets
  int tool = 0;
  int number = 0;                                    ///< of the program, where the control wants one
  double ball_diameter_mm = 0, probe_length_mm = 0;  ///< gauge line to the centre of the ball
  double feed = 0;                                   ///< of a touch, mm/min
  double guarded_feed = 0;                           ///< of the ways between, mm/min
  double top_mm = 0;                                 ///< machine Z at which the probe comes and goes
  double clear_mm = 0;                               ///< Z of the ball's centre above everything, work offset
  std::vector<ProbeTouch> touches;
};

/// The program as text of a control: ways to and from a touch stop where the probe meets something, a touch that meets
/// nothing ends it, and every touch logs "number x y z".
/// Errors: more touches than the control has room for their results.
using ProbingWords = Result<std::string> (*)(const ProbeProgram& program);
[[nodiscard]] Result<std::string> g38_probing(const ProbeProgram& program);  ///< G38.3, G38.2, LOG
[[nodiscard]] Result<std::string> g31_probing(const ProbeProgram& program);  ///< G31, DPRNT
/// MEAS; CYCLE978 where the way lies along Z or across it: its way ends as far behind `meets` as it begins ahead of it.
[[nodiscard]] Result<std::string> meas_probing(const ProbeProgram& program);
[[nodiscard]] Result<std::string> touch_probe_probing(const ProbeProgram& program);  ///< TCH PROBE

}  // namespace toothpath::probing
