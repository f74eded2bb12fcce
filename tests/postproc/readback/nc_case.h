// A small synthetic job: a trunnion, one tool, hand-made paths with a fixed and with a moving tool axis.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "geometry/base/angle.h"
#include "postproc/controls/of_machine.h"
#include "postproc/controls/registry.h"
#include "postproc/readback/reader.h"
#include "postproc/text/writer.h"
#include "tests/support/trunnion_kinematics.h"

namespace toothpath::test {

using controls::axis_options, controls::control_of, controls::dialect_of;

/// The words of a control, without a machine.
inline const text::NcDialect& words_of(const char* control) { return controls::find(control)->words; }

inline constexpr TrunnionGeometry kTrunnion{.px = 3, .py = -2, .pz = 0, .dy = 14.5, .z_offset = -31.25};

inline machines::Machine trunnion() {
  machines::Machine m;
  m.name = "trunnion";
  m.dialect = "linuxcnc";
  m.max_spindle_speed = 24000;
  m.max_cutting_feed = 10000;
  m.table_diameter_mm = 1200;
  m.chain.linear[0] = {-900, 900, 30000};
  m.chain.linear[1] = {-900, 900, 30000};
  m.chain.linear[2] = {-900, 600, 30000};
  machines::RotaryAxis c;
  c.letter = 'C';
  c.point_mm = Vec3(3, -2, 0);
  c.sign = -1;
  c.min_rad = radians(-36000);
  c.max_rad = radians(36000);
  c.max_speed = radians(12000);
  machines::RotaryAxis a;
  a.letter = 'A';
  a.direction = Vec3::UnitX();
  a.point_mm = Vec3(0, 12.5, -31.25);
  a.sign = -1;
  a.min_rad = radians(-110);
  a.max_rad = radians(60);
  a.max_speed = radians(6000);
  m.chain.table = {c, a};
  return m;
}

inline joints::Setup standing() {
  joints::Setup s;
  s.origin_mm = Vec3(3, -2, 150);
  s.work_offset_at_mm = Vec3(3, -2, 0);
  return s;
}

inline std::vector<tool::ToolAssembly> tools() {
  tool::ToolAssembly t;
  t.number = 1;
  t.diameter_mm = 4;
  t.length_mm = 95;
  tool::ToolAssembly u = t;
  u.number = 2;
  u.length_mm = 90.25;
  return {t, u};
}

inline const joints::ClearanceBody kBody{.radius_mm = 120, .z_min_mm = -30, .z_max_mm = 5};

/// Axis leaning by `lean` towards azimuth `azimuth` (gear frame).
inline Vec3 leaning(double lean, double azimuth) {
  return {std::sin(lean) * std::cos(azimuth), std::sin(lean) * std::sin(azimuth), std::cos(lean)};
}

/// Two passes along a curved line across the face, 100 < r < 118, at the given lean; `swing`: the azimuth of the lean
/// turns by this much along a pass (0: fixed axis).
inline path::ClPath sample_path(double lean, double swing, int steps = 40, int operation = 0) {
  path::ClPath path;
  path.operation = operation;
  path.operation_type = "finishing";
  path.spindle_rpm = 12000;
  const auto add = [&](const Vec3& tip, const Vec3& axis, path::MoveKind kind, int pass) {
    path.records.push_back({tip, axis, kind == path::MoveKind::rapid ? 0.0 : 800.0, kind, 0, pass});
  };
  for (int pass = 0; pass < 2; ++pass) {
    const auto tip = [&](double t) {
      const double r = 100 + 18 * t, phi = 0.01 * std::sin(3 * t) + 0.004 * pass;
      return Vec3(r * std::cos(phi), r * std::sin(phi), -3 + 0.5 * t * t - pass);
    };
    const auto axis = [&](double t) { return leaning(lean, 0.3 + swing * t); };
    const double out = 12 / std::cos(lean);
    add(tip(0) + out * axis(0), axis(0), path::MoveKind::rapid, pass);
    add(tip(0), axis(0), path::MoveKind::engage, pass);
    for (int i = 1; i <= steps; ++i) add(tip(1.0 * i / steps), axis(1.0 * i / steps), path::MoveKind::feed, pass);
    add(tip(1) + out * axis(1), axis(1), path::MoveKind::retract, pass);
  }
  add(path.records.back().tip, path.records.back().axis, path::MoveKind::rapid, 1);
  return path;
}

inline Result<joints::AxisProgram> axis_program(const std::vector<path::ClPath>& paths,
                                                const machines::Machine& machine, const joints::Setup& setup, int teeth,
                                                bool expand = false, double chord = 5e-4) {
  auto dialect = controls::dialect_of(machine);
  if (!dialect) return dialect.error();
  joints::AxisOptions o = controls::axis_options(*dialect, machine);
  o.expand_teeth = expand;
  o.chord_mm = chord;
  o.nc_step_mm = 2e-3;
  return joints::AxisProgramTestAccess::build(paths, tools(), setup, machine, teeth, kBody, o);
}

inline Result<text::NcText> nc_text(const std::vector<path::ClPath>& paths, const machines::Machine& machine,
                                    const joints::Setup& setup, int teeth, bool expand = false) {
  auto program = axis_program(paths, machine, setup, teeth, expand);
  if (!program) return program.error();
  text::NcHeader header;
  header.job_name = "sample";
  header.machine_name = machine.name;
  header.coolant = machines::Coolant::flood;
  header.wishes.restart_numbers = false;  // edits look for lines as they begin
  return write_nc(*program, *controls::dialect_of(machine), header);
}

inline machines::Machine with_dialect(machines::Machine m, const std::string& dialect) {
  m.dialect = dialect;
  return m;
}

}  // namespace toothpath::test
