// A small spur face gear whose flanks the side of a tapered mill finishes, operation by operation, for runs of the
// whole program.
#pragma once

#include <string>

#include "tests/app/program.h"

namespace toothpath::test {

/// Gear, machine and three mills: 1 tapered, 2 ball, 3 bull nose.
inline const std::string kLineGear = R"(schema = 1
name = "spur-line"
[gear]
type = "face_gear"
teeth = 60
module = 2.0
module_plane = "transverse"
pressure_angle = 20.0
shaper_teeth = 20
shaper_tip_radius = 0.6
[[gear.zone]]
helix_angle = 0.0
inner_radius = 60.0
outer_radius = 65.0
[machine]
file = "xyzac_large.toml"
[setup]
origin = [3.0, -2.0, 120.0]
axis = "up"
work_offset = "G54"
work_offset_at = [3.0, -2.0, 0.0]
[verify]
gouge_tolerance = 0.002
[[tool]]
number = 1
type = "tapered_ball_end_mill"
diameter = 0.8
half_angle = 5.0
flute_length = 6.5
shank_diameter = 6.0
length = 92.0
holder = [[10.0, 10.0, 30.0]]
stick_out = 40.0
[[tool]]
number = 2
type = "ball_end_mill"
diameter = 1.0
flute_length = 6.0
shank_diameter = 0.95
length = 80.0
holder = [[10.0, 10.0, 40.0]]
stick_out = 16.0
[[tool]]
number = 3
type = "bull_nose_end_mill"
diameter = 1.0
corner_radius = 0.2
flute_length = 6.0
shank_diameter = 0.95
length = 80.0
holder = [[10.0, 10.0, 40.0]]
stick_out = 16.0
)";

/// An operation of that kind with a tool; `lines` are its other keys, one a line.
inline std::string operation(const std::string& type, int tool, const std::string& lines) {
  return "[[operation]]\ntype = \"" + type + "\"\ntool = " + std::to_string(tool) + "\nspeed = 18000\nfeed = 300.0\n" +
         lines + "\n";
}

/// Roughing of what stands.
inline std::string roughing(int tool) {
  return operation("roughing", tool, "step_down = 0.8\nstep_over = 0.5\nallowance = 0.1");
}

/// Fillet and root by the ball end of the tapered mill.
inline const std::string kFilletAndRoot =
    operation("finishing", 1, "regions = [\"fillet\", \"root\"]\nscallop = 0.008\nchord_tolerance = 0.001");

/// The shipped machine of that job with a change, or with lines at its end.
inline std::string changed_machine(const std::string& from, const std::string& to, const std::string& end = {}) {
  const std::string text = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/xyzac_large.toml") + end;
  return from.empty() ? text : replaced(text, from, to);
}

/// Writes the job (and its machine where one is given) and runs it. Files are in dir / "out".
inline Finished run_line_job(const TestDir& dir, std::string text, const std::string& machine = {}) {
  if (!machine.empty()) {
    write_file(dir / "machine.toml", machine);
    text = replaced(text, "\"xyzac_large.toml\"", "\"machine.toml\"");
  }
  write_file(dir / "job.toml", text);
  return run_program({"run", dir / "job.toml", "--out", dir / "out"});
}

}  // namespace toothpath::test
