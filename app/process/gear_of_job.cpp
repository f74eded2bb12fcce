#include "app/process/gear_of_job.h"

#include <filesystem>

#include "app/job/form_mill.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/part.h"
#include "machines/machine_file.h"
#include "postproc/bodies/of_machine.h"
#include "postproc/controls/of_machine.h"

namespace toothpath::process {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

void check_speeds(const job::Job& job, const machines::Machine& machine, std::vector<Diagnostic>& errors) {
  for (std::size_t i = 0; i < job.operations.size(); ++i) {
    const auto& operation = job.operations[i];
    const std::string path = fmt::format("operation[{}]", i);
    if (operation.speed_rpm > machine.max_spindle_speed)
      errors.push_back(fail_at(job.where(path + ".speed"), "speed = {} 1/min exceeds {} 1/min, the spindle of {}",
                               operation.speed_rpm, machine.max_spindle_speed, machine.name));
    if (operation.feed_mm_min > machine.max_cutting_feed)
      errors.push_back(fail_at(job.where(path + ".feed"), "feed = {} mm/min exceeds {} mm/min, the cutting feed of {}",
                               operation.feed_mm_min, machine.max_cutting_feed, machine.name));
  }
}

/// The side of a mill cuts while one rotary turns at least.
void check_axes_at_once(const job::Job& job, const machines::Machine& machine, std::vector<Diagnostic>& errors) {
  const int axes = machine.max_simultaneous_axes;
  for (std::size_t i = 0; i < job.operations.size(); ++i) {
    const auto& operation = job.operations[i];
    if (operation.type != path::OperationType::line_milling) continue;
    const std::string path = fmt::format("operation[{}]", i);
    if (axes < 4)
      errors.push_back(
          fail_at(job.where(path + ".type"),
                  "line_milling moves X, Y, Z and one rotary at least, but {} interpolates {} axes at once "
                  "(max_simultaneous_axes): finish the flanks with a ball end whose axis stands, "
                  "type = \"finishing\"",
                  machine.name, axes));
    else if (axes < 5 && operation.rotaries == path::MovingRotaries::both)
      errors.push_back(fail_at(job.where(path + ".rotaries"),
                               "rotaries = \"both\" moves 5 axes at once, but {} interpolates {} "
                               "(max_simultaneous_axes): rotaries = \"one\" moves 4",
                               machine.name, axes));
  }
}

}  // namespace

Diagnostic located(const job::Job& job, std::string_view key, Diagnostic diagnostic) {
  if (diagnostic.position.file.empty()) diagnostic.position = job.where(key);
  return diagnostic;
}

Diagnostic needs_face_gear(const job::Job& job) {
  return fail_at(job.where("gear.type"), "type = \"{}\", but this command needs a face_gear", job.gear_type());
}

ValueOrErrors<face_gear::FaceGear> make_face_gear(const job::Job& job) {
  const face_gear::FaceGearParameters* parameters = job.face_gear();
  if (!parameters) return std::vector{needs_face_gear(job)};
  auto made = face_gear::FaceGear::make(*parameters);
  if (auto* gear = made.value_if()) {
    if (auto bad = face_gear::body_refusal(*gear, job.face_body))
      return std::vector{located(job, bad->key, std::move(bad->diagnostic))};
    return std::move(*gear);
  }
  std::vector<Diagnostic> errors;
  for (auto& refusal : made.error()) {
    // The stock of the blank stands in its own table.
    const bool stock = refusal.key.starts_with("stock.");
    errors.push_back(located(job, (stock ? "" : "gear.") + refusal.key, std::move(refusal.diagnostic)));
  }
  return errors;
}

ValueOrErrors<bevel_gear::BevelGear> make_bevel_gear(const job::Job& job) {
  const bevel_gear::BevelGearParameters* parameters = job.bevel_gear();
  if (!parameters)
    return std::vector{
        fail_at(job.where("gear.type"), "type = \"{}\", but a bevel gear is needed here", job.gear_type())};
  const auto mill = job::form_mill(job);
  if (!mill) return std::vector{mill.error()};
  auto made = bevel_gear::BevelGear::make(*parameters, mill->data);
  if (auto* gear = made.value_if()) return std::move(*gear);
  std::vector<Diagnostic> errors;
  for (auto& refusal : made.error()) {
    std::string key = "gear." + refusal.key;
    if (refusal.key.starts_with("tool."))
      key = mill->tool ? fmt::format("tool[{}].{}", *mill->tool, refusal.key.substr(5))
                       : "gear.mill." + refusal.key.substr(5);
    errors.push_back(located(job, key, std::move(refusal.diagnostic)));
  }
  return errors;
}

namespace {

/// The gear that a type makes of its parameters, or each of its refusals at its place in the job.
template <typename Gear, typename Parameters>
ValueOrErrors<Gear> made_of(const job::Job& job, const Parameters* parameters, const char* type) {
  if (!parameters)
    return std::vector{
        fail_at(job.where("gear.type"), "type = \"{}\", but this command needs a {}", job.gear_type(), type)};
  auto made = Gear::make(*parameters);
  if (auto* gear = made.value_if()) return std::move(*gear);
  std::vector<Diagnostic> errors;
  for (auto& refusal : made.error())
    errors.push_back(located(job, "gear." + refusal.key, std::move(refusal.diagnostic)));
  return errors;
}

}  // namespace

ValueOrErrors<cylindrical::CylindricalGear> make_cylindrical_gear(const job::Job& job) {
  return made_of<cylindrical::CylindricalGear>(job, job.cylindrical_gear(), "cylindrical_gear");
}

ValueOrErrors<straight_bevel::StraightBevelGear> make_straight_bevel_gear(const job::Job& job) {
  return made_of<straight_bevel::StraightBevelGear>(job, job.straight_bevel_gear(), "straight_bevel_gear");
}

ValueOrErrors<spiral_bevel::SpiralBevelGear> make_spiral_bevel_gear(const job::Job& job) {
  return made_of<spiral_bevel::SpiralBevelGear>(job, job.spiral_bevel_gear(), "spiral_bevel_gear");
}

ValueOrErrors<flank_grid::FlankGridGear> make_flank_grid_gear(const job::Job& job) {
  return made_of<flank_grid::FlankGridGear>(job, job.flank_grid(), "flank_grid");
}

namespace {

/// What has no tilted planes, and what can be done instead.
void refuse_planes(const job::Job& job, const machines::Machine& machine, const text::NcDialect& dialect,
                   std::vector<Diagnostic>& errors) {
  const SourcePosition at = job.where("program.tilted_planes");
  if (dialect.planes.on.empty())
    errors.push_back(
        fail_at(at,
                "tilted_planes: dialect \"{}\" has no words for them that can be proven, leave it out: the "
                "rotaries then turn by words of their own",
                dialect.name));
  else if (const auto planes = joints::plane_form_of(machine.chain, dialect.format); !planes)
    errors.push_back(fail_at(at, "tilted_planes: {}; this is {}. Leave it out{}", planes.error().message, machine.name,
                             machine.tcp == machines::TcpMode::none ? ": the rotaries then turn by words of their own"
                                                                    : ": the program is then written with TCP"));
  else if (dialect.planes.zero.empty())
    for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
      if (const machines::RotaryAxis& axis = machine.chain.rotary(k); axis.zero_rad != 0)
        errors.push_back(fail_at(at,
                                 "tilted_planes: dialect \"{}\" counts {} from 0 in them, axes.{}.zero = {:g} deg of "
                                 "{}. Leave it out, or home the axis so that its zero is 0",
                                 dialect.name, axis.letter, axis.letter, degrees(axis.zero_rad), machine.name));
}

/// What a machine cannot check, and what its file lacks for it.
void refuse_checks(const job::Job& job, const machines::Machine& machine, const text::NcDialect& dialect,
                   std::vector<Diagnostic>& errors) {
  if (job.program.text.checks == text::ToolChecks::none) return;
  const SourcePosition at = job.where("program.tool_check");
  if (dialect.write != nullptr) {
    errors.push_back(fail_at(at, "tool_check: dialect \"{}\" has no words for it, leave it out", dialect.name));
    return;
  }
  if (!dialect.tool_check) {
    errors.push_back(
        fail_at(at,
                "tool_check: {} states no tool setter: [tool_check] with its position{} in the machine file "
                "does",
                machine.name, dialect.check_lines.empty() ? " and the lines of its builder" : ""));
    return;
  }
  const machines::ToolCheck& check = *dialect.tool_check;
  const bool named = std::any_of(check.lines.begin(), check.lines.end(),
                                 [](const std::string& line) { return line.find("{tolerance}") != std::string::npos; });
  const double last_digit = std::pow(10.0, -dialect.format.linear_decimals);
  const double top = machine.top_mm();
  for (std::size_t k = 0; k < job.tools.size(); ++k) {
    const tool::ToolAssembly& tool = job.tools[k];
    if (tool.sister_of != 0) continue;
    const auto place = [&](const char* key) { return job.where(fmt::format("tool[{}].{}", k, key)); };
    const double stated = tool.check_tolerance_mm, tolerance = stated > 0 ? stated : check.tolerance_mm.value_or(0);
    if (tolerance <= 0)
      errors.push_back(fail_at(place("number"),
                               "tool {} is checked, and nothing says how far its length may be off: check_tolerance of "
                               "the tool, or tool_check.tolerance in the machine file",
                               tool.number));
    else if (named && tolerance < last_digit)
      errors.push_back(fail_at(stated > 0 ? place("check_tolerance") : at,
                               "tool {}: a tolerance of {:g} mm is below {:g}, the last digit of this control",
                               tool.number, tolerance, last_digit));
    else if (stated > 0 && !named)
      errors.push_back(
          fail_at(place("check_tolerance"),
                  "check_tolerance = {:g}: the lines of tool_check in the machine file name no {{tolerance}}, "
                  "they let {:g} mm pass",
                  stated, check.tolerance_mm.value_or(0)));
    if (const double above = check.position_mm.z() + tool.length_mm + check.clearance_mm; above > top)
      errors.push_back(
          fail_at(place("length"),
                  "tool {} is too long for the tool setter: with its tip {:g} mm above it Z would be {:.4f}, "
                  "its top is {:.4f}",
                  tool.number, check.clearance_mm, above, top));
  }
}

}  // namespace

ValueOrErrors<machines::Machine> load_machine(const job::Job& job, std::optional<double> part_diameter_mm) {
  if (job.machine.file.empty()) return std::vector{fail_at(job.where(""), "the job lacks the table [machine]")};
  const std::string directory = std::filesystem::path(job.file).parent_path().string();
  const auto path = machines::find_machine_file(job.machine.file, directory, job.file);
  if (!path) return std::vector{located(job, "machine.file", path.error())};
  const auto file = machines::open_machine_file(*path);
  if (!file) return std::vector{located(job, "machine.file", file.error())};
  if (file->kind != machines::MachineKind::five_axis)
    return std::vector{fail_at(job.where("machine.file"),
                               "{} is a gear shaper, but this command needs a milling machine", job.machine.file)};
  auto reading = controls::read_machine_of_text(file->text, file->path);
  if (!reading.machine) return reading.errors;
  machines::Machine machine = std::move(*reading.machine);
  if (job.program.pole) machine.post.pole = *job.program.pole;
  if (job.program.pole_angle_rad) machine.post.pole_angle_rad = *job.program.pole_angle_rad;
  std::vector<Diagnostic> errors;
  auto bodies = bodies::bodies_of(machine, true);
  if (auto* refused = bodies.refused()) errors = std::move(*refused);
  if (part_diameter_mm)
    if (const auto fits = machines::check_part_fits(machine, *part_diameter_mm); !fits) {
      errors.push_back(fits.error());
      errors.back().position = job.where("machine.file");
    }
  if (machine.assumed && !job.machine.accept_assumed)
    errors.push_back(fail_at(job.where("machine.file"),
                             "{} has assumed values ({}); measure them, or accept them with accept_assumed = true",
                             job.machine.file, joined(machine.assumed_keys)));
  check_speeds(job, machine, errors);
  check_axes_at_once(job, machine, errors);
  if (job.setup)
    if (const auto others = controls::other_work_offsets(machine, job.setup->work_offset))
      errors.push_back(fail_at(job.where("setup.work_offset"), "work_offset = \"{}\" is none of {}: it has {}",
                               job.setup->work_offset, machine.name, *others));
  const auto dialect = controls::dialect_of(machine);
  if (!dialect) errors.push_back(located(job, "machine.file", dialect.error()));
  else if (job.coolant != machines::Coolant::off)
    if (const auto words = text::coolant_words(*dialect, job.coolant); !words)
      errors.push_back(located(job, "coolant.mode", words.error()));
  if (dialect && job.program.number && !text::has_program_number(*dialect))
    errors.push_back(fail_at(job.where("program.number"),
                             "number = {}: programs of dialect \"{}\" have no number, leave it out: they are known by "
                             "the name of their file",
                             *job.program.number, dialect->name));
  if (dialect && job.program.text.stops != text::Stops::none && dialect->write != nullptr)
    errors.push_back(
        fail_at(job.where("program.stop"), "stop: dialect \"{}\" has no word for it, leave it out", dialect->name));
  if (dialect && job.program.text.stop_at_first_cut && dialect->write != nullptr)
    errors.push_back(fail_at(job.where("program.stop_at_first_cut"),
                             "stop_at_first_cut: dialect \"{}\" has no word for it, leave it out", dialect->name));
  if (dialect && job.positions.contains("program.restart_numbers") && job.program.text.restart_numbers &&
      (dialect->write != nullptr || dialect->block_numbers))
    errors.push_back(fail_at(job.where("program.restart_numbers"),
                             "restart_numbers: dialect \"{}\" has {}, leave it out", dialect->name,
                             dialect->block_numbers ? "a number in every block" : "no numbers of blocks"));
  if (dialect) refuse_checks(job, machine, *dialect, errors);
  if (dialect && job.program.tilted_planes) refuse_planes(job, machine, *dialect, errors);
  if (!errors.empty()) return errors;
  return machine;
}

}  // namespace toothpath::process
