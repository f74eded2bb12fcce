// Makes the folder from which LinuxCNC's motion controller runs a program of a job, and compares what it executed with
// our read-back of the same text.
//   toothpath_controller_case prepare JOB PROGRAM FOLDER TEETH CORNERS ACCELERATION PERIOD
//   toothpath_controller_case times JOB FOLDER ACCELERATION PERIOD        a row of docs/times.md: what we say and what
//   was needed toothpath_controller_case compare JOB FOLDER ACCELERATION PERIOD      FOLDER/samples.txt: what
//   halsampler recorded
// TEETH: teeth per operation, "1,1". CORNERS: "written", or a line like "G61.1" or "G64 P0.0003 Q0" in the place of the
// program's own. ACCELERATION: of every axis, mm/s^2 and deg/s^2. PERIOD: of the servo thread and of the record,
// microseconds.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>

#include "app/job/file.h"
#include "app/process/gear_of_job.h"
#include "postproc/controls/of_machine.h"
#include "postproc/readback/reader.h"
#include "postproc/readback/run_time.h"
#include "tests/controller/joint_record.h"
#include "tests/controller/short_program.h"

namespace toothpath {
namespace {

namespace fs = std::filesystem;
using test::JointVector, test::PathCorner, test::short_program;

// The record is printed with six digits after the point.
constexpr double kPrinted = 1e-6;    // mm and deg
constexpr double kGiveUp = 1.0;      // mm: beyond this the record does not follow the path
constexpr double kPiece = 0.02;      // deg: moves with TCP are cut into pieces that turn by no more than this
constexpr double kRapidPiece = 0.1;  // deg: of a rapid, whose joints are straight: 0.04 um of the tip at 100 mm

struct Case {
  job::Job job;
  machines::Machine machine;
  char tilt = 'A';
};

std::string read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

Result<Case> read_case(const std::string& job_file) {
  auto read = job::read_job_file(job_file);
  if (auto* errors = read.refused()) return errors->front();
  Case c{std::move(read).value(), {}, 'A'};
  auto machine = process::load_machine(c.job);
  if (auto* errors = machine.refused()) return errors->front();
  c.machine = std::move(machine).value();
  const machines::KinematicChain& chain = c.machine.chain;
  if (c.machine.dialect != "linuxcnc" || chain.table.size() != 2 || chain.table[0].letter != 'C' ||
      chain.table[0].sign != -1 || chain.table[1].sign != -1)
    return fail(
        "{} is no machine for xyzac-trt or xyzbc-trt: C on A or B in the table, both senses reversed, dialect linuxcnc",
        c.machine.file);
  c.tilt = chain.table[1].letter;
  return c;
}

std::string kinematics(const Case& c) { return c.tilt == 'A' ? "xyzac-trt-kins" : "xyzbc-trt-kins"; }

/// What the controller is set to.
struct Settings {
  double acceleration = 0;  ///< of every axis [mm/s^2, deg/s^2]
  int period_us = 0;        ///< of the servo thread
};

std::string ini(const Case& c, const Settings& settings) {
  const machines::KinematicChain& chain = c.machine.chain;
  struct Joint {
    double least, greatest, speed;
    bool angular;
  };
  std::vector<Joint> joints;
  for (const machines::LinearAxis& a : chain.linear) joints.push_back({a.min_mm, a.max_mm, a.max_speed / 60, false});
  for (const std::size_t k : {1u, 0u}) {
    const machines::RotaryAxis& a = chain.rotary(k);
    joints.push_back({degrees(a.min_rad), degrees(a.max_rad), degrees(a.max_speed) / 60, true});
  }
  double fastest = 0;
  for (const Joint& j : joints) fastest = std::max(fastest, j.speed);
  std::string text =
      fmt::format(R"([EMC]
VERSION = 1.1
MACHINE = toothpath
NML_FILE = linuxcnc.nml
[DISPLAY]
DISPLAY = none
MAX_FEED_OVERRIDE = 1
[RS274NGC]
PARAMETER_FILE = offsets.var
SUBROUTINE_PATH = .
HAL_PIN_VARS = 1
REMAP = M428  modalgroup=10  ngc=428remap
REMAP = M429  modalgroup=10  ngc=429remap
[KINS]
KINEMATICS = {} sparm=identityfirst
JOINTS = 5
[TRAJ]
COORDINATES = XYZ{}C
LINEAR_UNITS = mm
ANGULAR_UNITS = deg
DEFAULT_LINEAR_VELOCITY = {}
MAX_LINEAR_VELOCITY = {}
MAX_LINEAR_ACCELERATION = {}
[EMCMOT]
EMCMOT = motmod
SERVO_PERIOD = {}
COMM_TIMEOUT = 30
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.100
TOOL_TABLE = tools.tbl
)",
                  kinematics(c), c.tilt, fastest, fastest, settings.acceleration, settings.period_us * 1000);
  // With TCP the words of an axis are not its joint: only the joints have limits.
  for (std::size_t i = 0; i < 5; ++i)
    text +=
        fmt::format("[AXIS_{}]\nMIN_LIMIT = -100000\nMAX_LIMIT = 100000\nMAX_VELOCITY = {}\nMAX_ACCELERATION = {}\n",
                    i == 3 ? c.tilt : "XYZ?C"[i], joints[i].speed, settings.acceleration);
  for (std::size_t i = 0; i < 5; ++i)
    text += fmt::format(
        "[JOINT_{}]\nTYPE = {}\nHOME = 0\nHOME_SEARCH_VEL = 0\nHOME_SEQUENCE = 0\nMIN_LIMIT = {}\nMAX_LIMIT = "
        "{}\nMAX_VELOCITY = {}\n"
        "MAX_ACCELERATION = {}\nFERROR = 1\nMIN_FERROR = 1\n",
        i, joints[i].angular ? "ANGULAR" : "LINEAR", joints[i].least, joints[i].greatest, joints[i].speed,
        settings.acceleration);
  return text;
}

std::string hal(const Case& c, const Settings& settings) {
  const std::string kins = kinematics(c);
  const Vec3 &on_c = c.machine.chain.table[0].point_mm, &on_tilt = c.machine.chain.table[1].point_mm;
  std::string text = fmt::format(
      "loadrt {} sparm=identityfirst coordinates=XYZ{}C\nloadrt motmod servo_period_nsec={} num_joints=5\n"
      "loadrt sampler depth=60000 cfg=fffff\naddf motion-command-handler servo-thread\n"
      "addf motion-controller servo-thread\naddf sampler.0 servo-thread\n",
      kins, c.tilt, settings.period_us * 1000);
  for (int i = 0; i < 5; ++i)
    text += fmt::format("net joint{} joint.{}.motor-pos-cmd => joint.{}.motor-pos-fb sampler.0.pin.{}\n", i, i, i, i);
  text += fmt::format(
      "setp {0}.x-rot-point {1}\nsetp {0}.y-rot-point {2}\nsetp {0}.z-rot-point 0\nsetp {0}.{3}-offset {4}\nsetp "
      "{0}.z-offset {5}\n",
      kins, on_c.x(), on_c.y(), c.tilt == 'A' ? 'y' : 'x',
      c.tilt == 'A' ? on_tilt.y() - on_c.y() : on_tilt.x() - on_c.x(), on_tilt.z());
  text += fmt::format(
      "net tool-offset motion.tooloffset.z => {}.tool-offset\nnet kinstype motion.analog-out-03 => "
      "motion.switchkins-type\n"
      "net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in\n"
      "net tool-prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared\n"
      "net tool-change iocontrol.0.tool-change => iocontrol.0.tool-changed\n",
      kins);
  return text;
}

/// M428 and M429 of the site: the kinematics follow an analog output, and the interpreter waits for them.
std::string remap(int code, int kinematics_type) {
  return fmt::format("o<{0}remap> sub\nM68 E3 Q{1}\nM66 E0 L0\no<{0}remap> endsub\nM2\n", code, kinematics_type);
}

Status write(const fs::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::binary);
  out << text;
  out.close();
  if (!out) return fail("{} cannot be written", file.string());
  return Ok{};
}

Status prepare(const Case& c, const std::string& program, const fs::path& folder, const std::string& teeth,
               const std::string& corners, const Settings& settings) {
  const std::string text = read(program);
  if (text.empty()) return fail("{} is missing or empty", program);
  const auto part = short_program(text, teeth, corners);
  if (!part) return part.error();
  std::string tools, offsets;
  for (const tool::ToolAssembly& t : c.job.tools)
    tools += fmt::format("T{0} P{0} Z{1} D{2}\n", t.number, t.length_mm, t.diameter_mm);
  if (!c.job.setup || c.job.setup->work_offset != "G54") return fail("the job must stand in G54");
  const Vec3 at = c.job.setup->work_offset_at_mm;
  offsets = fmt::format("5220\t1\n5221\t{}\n5222\t{}\n5223\t{}\n", at.x(), at.y(), at.z());
  const auto as_written = short_program(text, teeth, "written");
  if (!as_written) return as_written.error();
  const std::pair<const char*, std::string> files[] = {
      {"as_written.ngc", *as_written},   {"machine.ini", ini(c, settings)},
      {"machine.hal", hal(c, settings)}, {"tools.tbl", tools},
      {"offsets.var", offsets},          {"428remap.ngc", remap(428, 1)},
      {"429remap.ngc", remap(429, 0)},   {"program.ngc", *part}};
  for (const auto& [name, content] : files)
    if (const Status s = write(folder / name, content); !s) return s;
  return Ok{};
}

/// What we read of the program.
struct Expected {
  std::vector<PathCorner> path;  ///< in LinuxCNC's order of joints, from the first place where all joints are known
  double blend_mm = 0;           ///< how far the tip may leave a corner, as the reader counts it
  double tool_length_mm = 0;     ///< of the tool that moves last
  std::size_t blocks = 0;
};

/// Blocks that turn are cut into pieces: with TCP the tip goes straight and not the joints, without it the other way
/// round.
Result<Expected> expected_path(const Case& c, const std::string& text) {
  const auto control = controls::control_of(c.machine, *c.job.setup, c.job.tools);
  if (!control) return control.error();
  const machines::KinematicChain& chain = c.machine.chain;
  Expected out;
  const auto add = [&out](const std::array<double, 5>& j, int line) {
    out.path.push_back({{j[0], j[1], j[2], j[4], j[3]}, line});
  };
  bool begun = false;
  readback::ExecutedMove last;
  const Status s = readback::execute_nc(text, "program.ngc", *control, [&](const readback::ExecutedMove& e) {
    if (std::any_of(e.joints.begin(), e.joints.end(), [](double v) { return std::isnan(v); })) return;
    out.blend_mm = std::max(out.blend_mm, static_cast<double>(e.blend_mm));
    ++out.blocks;
    if (begun) {
      const double length = out.tool_length_mm = control->tool_length_mm.at(e.tool);
      const auto tip_of = [&](const readback::ExecutedMove& m) {
        return chain
            .forward({{m.joints[0], m.joints[1], m.joints[2]}, {radians(m.joints[3]), radians(m.joints[4])}}, length)
            .tip_mm;
      };
      const Vec3 from = tip_of(last), to = tip_of(e);
      const double turn = std::max(std::abs(e.joints[3] - last.joints[3]), std::abs(e.joints[4] - last.joints[4]));
      const int pieces = static_cast<int>(std::ceil(turn / (e.rapid ? kRapidPiece : kPiece)));
      for (int i = 1; i < pieces; ++i) {
        const double t = static_cast<double>(i) / pieces;
        std::array<double, 5> j{};
        for (std::size_t a = 0; a < 5; ++a) j[a] = std::lerp(last.joints[a], e.joints[a], t);
        if (e.tcp) {  // the other joints from our own inverse
          const Vec3 x = chain.linear_for(from + t * (to - from), {radians(j[3]), radians(j[4])}, length).linear_mm;
          for (int a = 0; a < 3; ++a) j[static_cast<std::size_t>(a)] = x[a];
        }
        add(j, e.line);
      }
    }
    add(e.joints, e.line);
    last = e;
    begun = true;
  });
  if (!s) return s.error();
  if (out.path.size() < 2) return fail("the program moves nothing");
  return out;
}

/// Tip in the table frame [mm] and the two small components of the tool axis [degrees], in the place of joints.
JointVector pose_of(const Case& c, const JointVector& j, double tool_length_mm, bool with_axis) {
  const machines::TablePose pose =
      c.machine.chain.forward({{j[0], j[1], j[2]}, {radians(j[4]), radians(j[3])}}, tool_length_mm);
  return {pose.tip_mm.x(), pose.tip_mm.y(), pose.tip_mm.z(), with_axis ? degrees(pose.axis.x()) : 0,
          with_axis ? degrees(pose.axis.y()) : 0};
}

/// Greatest acceleration of a point of this space while LinuxCNC runs a block so that every joint keeps its own: of a
/// block with the steps d_i the joints accelerate by d_i / max(d_i / a_i), the point by its own step in the same
/// proportion.
double greatest_acceleration(std::span<const PathCorner> joints, std::span<const PathCorner> points,
                             double of_every_axis) {
  double most = 0;
  for (std::size_t k = 1; k < joints.size(); ++k) {
    double least_time_squared = 0;
    for (std::size_t i = 0; i < 5; ++i)
      least_time_squared =
          std::max(least_time_squared, std::abs(joints[k].joints[i] - joints[k - 1].joints[i]) / of_every_axis);
    if (least_time_squared > 0)
      most = std::max(most, test::joint_distance(points[k - 1].joints, points[k].joints) / least_time_squared);
  }
  return most;
}

/// One line of the result: greatest distances in one space, with their bound; none: there is none to hold.
bool judge(const char* what, std::span<const PathCorner> path, std::span<const JointVector> record,
           std::optional<double> bound) {
  using test::Counted;
  const auto both = test::compare_curves(path, record, kGiveUp);
  if (!both.followed) {
    fmt::print("  {:<12} {}: more than {} mm away near line {} of the program, or stopped there\n", what,
               bound ? "NOT FOLLOWED" : "not followed", kGiveUp, both.stuck_line);
    return !bound;
  }
  const auto samples = test::compare_curves(path, record, kGiveUp, Counted::samples),
             corners = test::compare_curves(path, record, kGiveUp, Counted::corners);
  const bool good = !bound || both.worst <= *bound;
  fmt::print(
      "  {:<12} off the path {:.3g} um at line {}, corner not reached {:.3g} um at line {}, together {:.3g} um, {}\n",
      what, samples.worst * 1e3, samples.line, corners.worst * 1e3, corners.line, both.worst * 1e3,
      bound ? fmt::format("bound {:.3g} um: {}", *bound * 1e3, good ? "agree" : "DIFFER") : "no bound");
  return good;
}

/// What LinuxCNC leaves of a corner under the last G6x line of the program: docs/dialects.md.
double corner_bound(const std::string& text, double acceleration, double period) {
  double tolerance = 0;
  std::smatch m;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (std::regex_match(line, m, std::regex(R"(G64 P([0-9.]+) Q0)"))) tolerance = std::stod(m[1]);
  const double filter = acceleration * period * period / 4,
               late = tolerance > 0 ? period / 2 * std::sqrt(acceleration / 2) : 0;
  return std::pow(std::sqrt(tolerance) + late, 2) + filter;
}

Result<bool> compare(const Case& c, const fs::path& folder, const Settings& settings) {
  const std::string text = read(folder / "program.ngc");
  auto expected = expected_path(c, text);
  const bool refused = !expected;
  if (refused) {  // corners that our reader does not let pass: the path is that of the program as it was written
    fmt::print("  refused by the reader: {}\n", expected.error().message);
    expected = expected_path(c, read(folder / "as_written.ngc"));
    if (!expected) return expected.error();
  }
  std::ifstream in(folder / "samples.txt");
  if (!in) return fail("{} is missing", (folder / "samples.txt").string());
  const auto samples = test::read_samples(in);
  if (!samples) return samples.error();
  const double digits = 0.5 * kPrinted * std::sqrt(3 + 2 * test::kMmPerDegree * test::kMmPerDegree);
  fmt::print("{} moves, {} samples of {} us, {:g} mm/s^2 and deg/s^2; counted for corners {:.3g} um\n",
             expected->blocks, samples->size(), settings.period_us, settings.acceleration, expected->blend_mm * 1e3);
  bool good = true;
  const auto look = [&](const char* what, std::span<const PathCorner> path, std::span<const JointVector> record) {
    const double acceleration = greatest_acceleration(expected->path, path, settings.acceleration);
    fmt::print("  {:<12} greatest acceleration {:.4g} mm/s^2\n", what, acceleration);
    const double bound = corner_bound(text, acceleration, settings.period_us * 1e-6) + digits;
    good = judge(what, path, record, refused ? std::nullopt : std::optional(bound)) && good;
  };
  look("joints", expected->path, *samples);
  for (const bool with_axis : {false, true}) {
    std::vector<PathCorner> path = expected->path;
    for (PathCorner& corner : path) corner.joints = pose_of(c, corner.joints, expected->tool_length_mm, with_axis);
    std::vector<JointVector> record;
    record.reserve(samples->size());
    for (const JointVector& j : *samples) record.push_back(pose_of(c, j, expected->tool_length_mm, with_axis));
    look(with_axis ? "tip and axis" : "tip", path, record);
  }
  return good;
}

/// The machine with the accelerations that the controller was set to.
machines::Machine accelerated(machines::Machine machine, double of_every_axis) {
  for (auto& axis : machine.chain.linear) axis.max_acceleration = of_every_axis * 3600;
  for (auto* rotaries : {&machine.chain.table, &machine.chain.head})
    for (auto& axis : *rotaries) axis.max_acceleration = radians(of_every_axis) * 3600;
  return machine;
}

/// Times from the first place where all joints are known to the end: asked by the text, predicted, executed.
Status print_times(const Case& c, const fs::path& folder, const Settings& settings) {
  const std::string text = read(folder / "program.ngc");
  const auto expected = expected_path(c, text);
  if (!expected) {  // refused: nothing is predicted
    fmt::print("not predicted: {}\n", expected.error().message);
    return Ok{};
  }
  const auto control = controls::control_of(c.machine, *c.job.setup, c.job.tools);
  if (!control) return control.error();
  double asked = 0, predicted = 0, in_cuts = 0;
  const machines::Machine machine = accelerated(c.machine, settings.acceleration);
  readback::RunTimer timer(machine, control->corners, [&](bool rapid, double minutes) {
    predicted += minutes;
    in_cuts += rapid ? 0 : minutes;
  });
  const Status s = readback::execute_nc(text, "program.ngc", *control, [&](const readback::ExecutedMove& e) {
    if (!e.known) return;
    asked += e.minutes;
    timer.add(e);
  });
  if (!s) return s;
  timer.finish();
  std::ifstream in(folder / "samples.txt");
  const auto samples = test::read_samples(in);
  if (!samples) return samples.error();
  const auto walk = test::compare_curves(expected->path, *samples, kGiveUp);
  if (!walk.followed) return fail("the record does not follow the program near its line {}", walk.stuck_line);
  const double executed = static_cast<double>(walk.samples) * settings.period_us * 1e-6;
  fmt::print("{} moves | asked {:.1f} s | predicted {:.1f} s, {:.1f} s of it cutting | executed {:.1f} s | {:+.2f} %\n",
             expected->blocks, asked * 60, predicted * 60, in_cuts * 60, executed,
             100 * (predicted * 60 / executed - 1));
  return Ok{};
}

int run(const std::vector<std::string>& args) {
  const bool timing = args.size() == 5 && args[0] == "times";
  const bool preparing = args.size() == 8 && args[0] == "prepare", comparing = args.size() == 5 && args[0] == "compare";
  Settings settings;
  if (preparing || comparing || timing)
    settings = {std::atof(args[args.size() - 2].c_str()), std::atoi(args.back().c_str())};
  if (!(settings.acceleration > 0) || settings.period_us <= 0) {
    fmt::print(stderr,
               "usage: toothpath_controller_case prepare JOB PROGRAM FOLDER TEETH CORNERS ACCELERATION PERIOD\n"
               "       toothpath_controller_case compare JOB FOLDER ACCELERATION PERIOD\n"
               "       toothpath_controller_case times JOB FOLDER ACCELERATION PERIOD\n");
    return 2;
  }
  const auto c = read_case(args[1]);
  if (!c) {
    fmt::print(stderr, "{}\n", c.error().text());
    return 3;
  }
  if (preparing) {
    const Status s = prepare(*c, args[2], args[3], args[4], args[5], settings);
    if (!s) fmt::print(stderr, "{}\n", s.error().text());
    return s ? 0 : 3;
  }
  if (timing) {
    const Status s = print_times(*c, args[2], settings);
    if (!s) fmt::print(stderr, "{}\n", s.error().text());
    return s ? 0 : 3;
  }
  const auto same = compare(*c, args[2], settings);
  if (!same) fmt::print(stderr, "{}\n", same.error().text());
  return same && *same ? 0 : 1;
}

}  // namespace
}  // namespace toothpath

int main(int argc, char** argv) { return toothpath::run(std::vector<std::string>(argv + 1, argv + argc)); }
