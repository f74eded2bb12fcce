#include "app/commands/machine.h"

#include "app/base/command_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/base/output_dir.h"
#include "app/process/opening_and_end.h"
#include "app/report/sheet/dry_run_sheet.h"
#include "app/report/sheet/machine_sheet.h"
#include "geometry/base/angle.h"
#include "geometry/base/json_text.h"
#include "machines/machine_file.h"
#include "machines/machine_table.h"
#include "postproc/bodies/of_machine.h"
#include "postproc/controls/of_machine.h"
#include "postproc/controls/registry.h"
#include "postproc/self_test/self_test.h"
#include "postproc/shaper/control.h"
#include "postproc/text/writer.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kShowOutputs = {"machine.html", "machine.svg"};

struct Shown {
  std::string text, page, drawing, json;
};

/// The keys of the file, and where it lies.
std::string json_of_file(const machines::MachineFileText& file, const nlohmann::ordered_json& bodies = {}) {
  const auto tree = machines::parse_machine_toml(file.text, file.path);
  CommandOutcome outcome;
  outcome.report_json =
      json_text(nlohmann::ordered_json{{"schema", 1}, {"command", "machine show"}, {"file", file.path}});
  if (tree) app::add_data(outcome, "machine", app::json_of_toml(*tree));
  if (bodies.is_array()) app::add_data(outcome, "bodies", json_text(bodies));
  return outcome.report_json;
}

/// The bodies of the machine, meshes among them read and examined: a box around each, in the order of the file.
Expected<std::vector<sheet::BodyBox>, std::vector<Diagnostic>> boxes_of(const machines::Machine& machine) {
  auto bodies = bodies::bodies_of(machine, true);
  if (auto* errors = bodies.refused()) return std::move(*errors);
  std::vector<sheet::BodyBox> boxes;
  for (const bodies::Body& body : bodies.value()) {
    sheet::BodyBox& box = boxes.emplace_back();
    for (int k = 0; k < 3; ++k) {
      box.low[k] = body.solid.farthest(-Vec3::Unit(k))[k];
      box.high[k] = body.solid.farthest(Vec3::Unit(k))[k];
    }
  }
  return boxes;
}

nlohmann::ordered_json json_of_bodies(const machines::Machine& machine, const std::vector<sheet::BodyBox>& boxes) {
  const machines::Links links(machine.chain);
  auto json = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const sheet::BodyBox& box = boxes[k];
    json.push_back({{"name", machine.bodies[k].name},
                    {"on", sheet::link_name(links, machine.bodies[k].link)},
                    {"low", {box.low.x(), box.low.y(), box.low.z()}},
                    {"high", {box.high.x(), box.high.y(), box.high.z()}}});
  }
  return json;
}

/// Text, page and drawing of a machine of either kind.
Expected<Shown, std::vector<Diagnostic>> show(const std::string& path) {
  const auto file = machines::open_machine_file(path);
  if (!file) return std::vector{file.error()};
  if (file->kind == machines::MachineKind::gear_shaper) {
    auto reading = shaper::read_shaper_machine_of_text(file->text, path);
    if (!reading.machine) return std::move(reading.errors);
    return Shown{sheet::machine_text(*reading.machine), sheet::machine_page(*reading.machine), {}, json_of_file(*file)};
  }
  auto reading = controls::read_machine_of_text(file->text, path);
  if (!reading.machine) return std::move(reading.errors);
  auto boxes = boxes_of(*reading.machine);
  if (auto* errors = boxes.refused()) return std::move(*errors);
  return Shown{sheet::machine_text(*reading.machine, boxes.value()),
               sheet::machine_page(*reading.machine, boxes.value()), sheet::machine_drawing_svg(*reading.machine),
               json_of_file(*file, json_of_bodies(*reading.machine, boxes.value()))};
}

}  // namespace

CommandOutcome show_machine(const MachineRequest& request) {
  std::optional<app::OutputDir> output;
  if (!request.out_dir.empty()) {
    auto opened = app::OutputDir::open(request.out_dir, kShowOutputs, {request.machine_file});
    if (!opened) return failed(opened.error());
    output.emplace(std::move(opened).value());
  }
  const auto path = machines::find_machine_file(request.machine_file, ".");
  if (!path) return failed(path.error());
  auto result = show(*path);
  if (auto* errors = result.refused()) return failed(std::move(*errors));
  const Shown& machine = result.value();
  CommandOutcome outcome;
  outcome.summary = machine.text;
  outcome.report_json = machine.json;
  if (!output) return outcome;
  process::NamedFiles files = {{"machine.html", machine.page}};
  if (!machine.drawing.empty()) files.emplace_back("machine.svg", machine.drawing);
  return process::finished(*output, files, std::move(outcome));
}

namespace {

const std::vector<std::string> kTestOutputs = {"machine_test.", "machine_test_tcp.", "machine_test.html"};
constexpr const char* kPreviousTest = "previous_machine_test";
constexpr int kTestProgram = 7990;  // O number; the part with TCP has the next

/// Plans one part, writes its text and proves what lies on the disk.
Result<sheet::DryRunPart> make_part(const machines::Machine& machine, const MachineRequest& request,
                                    app::OutputDir& output) {
  const bool tcp = machine.tcp != machines::TcpMode::none;
  const auto dialect = controls::dialect_of(machine);
  if (!dialect) return dialect.error();
  self_test::SelfTestOptions options;
  options.tool_length_mm = request.tool_length_mm;
  const auto test = self_test::plan_self_test(machine, options);
  if (!test) return test.error();
  text::NcHeader header;
  header.job_name = (tcp ? "self test tcp " : "self test ") + machine.name;
  header.machine_name = machine.name;
  header.assumed = controls::trusted_zeros(machine, false);
  header.assumed.insert(header.assumed.end(), machine.assumed_keys.begin(), machine.assumed_keys.end());
  header.program_number = kTestProgram + (tcp ? 1 : 0);
  const auto text =
      text::write_nc(self_test::self_test_program(*test, machine, *dialect), self_test::in_air(*dialect), header);
  if (!text) return text.error();
  const std::string name = (tcp ? "machine_test_tcp" : "machine_test") + dialect->extension;
  if (const auto s = output.write(name, text->text); !s) return s.error();
  const auto bytes = output.read_back(name);
  if (!bytes) return bytes.error();
  auto proof = self_test::prove_self_test(*bytes, output.final_path(name), *test, machine);
  if (!proof) return proof.error();
  return sheet::DryRunPart{name, tcp, *test, std::move(*proof)};
}

std::string test_json(const machines::Machine& machine, const std::vector<sheet::DryRunPart>& parts) {
  const self_test::SelfTest& test = parts.front().test;
  nlohmann::ordered_json json = {{"schema", 1},
                                 {"command", "machine test"},
                                 {"machine", machine.name},
                                 {"stations", test.stations.size()},
                                 {"tool_length", test.tool_length_mm},
                                 {"tilt_deg", degrees(test.tilt_rad)},
                                 {"point", {test.point_mm.x(), test.point_mm.y(), test.point_mm.z()}},
                                 {"programs", nlohmann::ordered_json::array()}};
  for (const sheet::DryRunPart& part : parts)
    json["programs"].push_back({{"file", part.program},
                                {"tcp", part.tcp},
                                {"tip_leaves_um", 1000 * part.proof.worst_mm},
                                {"moves", part.proof.moves},
                                {"minutes", part.proof.minutes}});
  return json_text(json, 2) + "\n";
}

/// A text of places of the tool would show nothing of the machine's axes.
Status has_axes(const machines::Machine& machine) {
  const controls::Control* control = controls::find(machine.dialect);
  if (control == nullptr || !control->words.cutter_locations) return Ok{};
  return fail_at(
      machine.where("dialect"),
      "dialect = \"{}\" has places of the tool and no axes: its text shows nothing of senses and pivots; the "
      "dry run is that of a machine file with the dialect of the control itself",
      machine.dialect);
}

std::string summary_of(const machines::Machine& machine, const std::vector<sheet::DryRunPart>& parts,
                       const std::string& directory) {
  const self_test::SelfTest& test = parts.front().test;
  std::string out = fmt::format(
      "{}: {} stations, bar of {:g} mm, tilt up to {:g} deg\n  point X {:g} Y {:g} Z {:g} mm machine (G54)\n",
      machine.name, test.stations.size(), test.tool_length_mm, degrees(test.tilt_rad), test.point_mm.x(),
      test.point_mm.y(), test.point_mm.z());
  std::string files;
  for (const sheet::DryRunPart& part : parts) {
    out += fmt::format(
        "  {}: TCP {}, proves the {}; read back: the tip leaves the point by at most {:.4f} mm over {} "
        "moves, {:.1f} min; the spindle stands\n",
        part.program, part.tcp ? "on" : "off", part.tcp ? "data of the control" : "machine file", part.proof.worst_mm,
        part.proof.moves, part.proof.minutes);
    files += part.program + " ";
  }
  return out + fmt::format("  seen of the machine file: {}\n  files {}machine_test.html in {}\n",
                           sheet::dry_run_sight(machine, parts.front()), files, directory);
}

}  // namespace

CommandOutcome test_machine(const MachineRequest& request) {
  auto output = app::OutputDir::open(request.out_dir, kTestOutputs, {request.machine_file}, kPreviousTest);
  if (!output) return failed(output.error());
  const auto path = machines::find_machine_file(request.machine_file, ".");
  if (!path) return failed(path.error());
  auto reading = controls::read_machine(*path);
  if (!reading.machine) return failed(std::move(reading.errors));
  const machines::Machine& machine = *reading.machine;
  if (const auto axes = has_axes(machine); !axes) return failed(axes.error());
  if (const auto aside = output->set_aside(); !aside) return failed(aside.error());
  std::vector<sheet::DryRunPart> parts;
  for (const bool tcp : {false, true}) {
    if (tcp && machine.tcp == machines::TcpMode::none) continue;
    auto part = make_part(tcp ? machine : self_test::without_tcp(machine), request, *output);
    if (!part) {
      Diagnostic error = part.error();
      if (error.position.file.empty()) error.position.file = *path;
      return failed(std::move(error));
    }
    parts.push_back(std::move(*part));
  }
  if (const auto s = output->write("machine_test.html", sheet::dry_run_page(machine, parts)); !s)
    return failed(s.error());
  if (const auto s = output->commit(); !s) return failed(s.error());
  CommandOutcome outcome;
  outcome.summary = summary_of(machine, parts, request.out_dir);
  outcome.report_json = test_json(machine, parts);
  return outcome;
}

void add_machine(Commands& commands) {
  constexpr const char* kMachine = "machine file (TOML), or the name of an installed one";
  commands.push_back(command_of<MachineRequest>(
      "show", "limits, chain, senses and assumed values of a machine",
      [](OptionSet& set, MachineRequest& request) {
        set.examples({"machine show xyzac_trt", "machine show mine.toml --out machine"});
        set.file("MACHINE", request.machine_file, kMachine);
        set.out_dir_or_none(request.out_dir,
                            "directory for machine.html and machine.svg; without it only the text is printed");
      },
      show_machine, &kMachines));
  commands.push_back(command_of<MachineRequest>(
      "test", "programs that hold the tip of a test bar on one point while the rotary axes turn: run them in air",
      [](OptionSet& set, MachineRequest& request) {
        set.examples({"machine test mine.toml", "machine test mine.toml --tool-length 80"});
        set.file("MACHINE", request.machine_file, kMachine);
        set.out_dir(request.out_dir);
        set.number("--tool-length", request.tool_length_mm,
                   "gauge line to the tip of the test bar (default: 100, 60 or 30, what fits)", {1, 5000, " mm"});
      },
      test_machine, &kMachines));
}

}  // namespace toothpath::commands
