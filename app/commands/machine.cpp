#include "app/commands/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "app/base/output_dir.h"
#include "app/process/opening_and_end.h"
#include "app/report/page/study_page.h"
#include "app/report/sheet/machine_sheet.h"
#include "geometry/base/angle.h"
#include "machines/machine_file.h"
#include "postproc/controls/of_machine.h"
#include "postproc/self_test/self_test.h"
#include "postproc/shaper/control.h"
#include "postproc/text/writer.h"

namespace toothpath::commands {
namespace {

const std::vector<std::string> kShowOutputs = {"machine.html", "machine.svg"};

struct Shown {
  std::string text, page, drawing;
};

/// Text, page and drawing of a machine of either kind.
Expected<Shown, std::vector<Diagnostic>> show(const std::string& path) {
  const auto file = machines::open_machine_file(path);
  if (!file) return std::vector{file.error()};
  if (file->kind == machines::MachineKind::gear_shaper) {
    auto reading = shaper::read_shaper_machine_of_text(file->text, path);
    if (!reading.machine) return std::move(reading.errors);
    return Shown{sheet::machine_text(*reading.machine), sheet::machine_page(*reading.machine), {}};
  }
  auto reading = controls::read_machine_of_text(file->text, path);
  if (!reading.machine) return std::move(reading.errors);
  return Shown{sheet::machine_text(*reading.machine), sheet::machine_page(*reading.machine),
               sheet::machine_drawing_svg(*reading.machine)};
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
  if (!output) return outcome;
  process::NamedFiles files = {{"machine.html", machine.page}};
  if (!machine.drawing.empty()) files.emplace_back("machine.svg", machine.drawing);
  return process::finished(*output, files, std::move(outcome));
}

namespace {

/// What the machinist reads beside the machine.
std::string test_page(const machines::Machine& machine, const self_test::SelfTest& test,
                      const self_test::SelfTestProof& proof, const std::string& program) {
  page::StudyPage page;
  page.title = machine.name + ": dry run of signs and pivots";
  page.subtitle = fmt::format("{}, {}", program, machine.file);
  page.good = machine.assumed_keys.empty();
  page.verdict = page.good ? "nothing assumed" : fmt::format("{} values assumed", machine.assumed_keys.size());
  const Vec3& p = test.point_mm;
  page.introduction = {
      fmt::format("The spindle does not turn. A test bar of {:g} mm (gauge line to the tip) is tool 1; its length must "
                  "stand in the tool table. The work offset {} is X {:g} Y {:g} Z {:g} in machine coordinates: the "
                  "program keeps the tip of the bar there while the table and the head turn.",
                  test.tool_length_mm, "G54", p.x(), p.y(), p.z()),
      "1. Set the offset and the length, remove part and fixture, feed override at zero. 2. Start; open the override "
      "slowly. The program stops at every station. 3. At station 1 bring a dial indicator on the table to the tip and "
      "set it to zero. 4. At every further station the indicator turns with the table: read it. Watch that each axis "
      "turns the way that the table of `machine show` says.",
      fmt::format(
          "Read back from the text: the tip leaves the point by at most {:.4f} mm. What the indicator shows beyond "
          "that is the error of a sign, a pivot or a length: a wrong sign shows millimetres, a pivot that is off by "
          "half a millimetre more than two tenths. A reading that grows with one axis alone belongs to its pivot.",
          proof.worst_mm)};
  for (const auto& key : machine.assumed_keys) page.introduction.push_back("Assumed and not measured: " + key);
  page::PageTable stations{"Stations",
                           {"station", "axes", "indicator mm", "direction right"},
                           {},
                           "The last two columns are filled in at the machine."};
  for (std::size_t k = 0; k < test.stations.size(); ++k)
    stations.rows.push_back({fmt::format("{}", k + 1), test.stations[k].remark, "", ""});
  page::PageTable senses{"What a positive command turns", {"axis", "seen"}, {}, ""};
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
    senses.rows.push_back({std::string(1, machine.chain.rotary(k).letter), sheet::positive_turn(machine.chain, k)});
  page.tables = {senses, stations};
  return study_page_html(page);
}

const std::vector<std::string> kTestOutputs = {"machine_test.", "machine_test.html"};
constexpr const char* kPreviousTest = "previous_machine_test";

}  // namespace

CommandOutcome test_machine(const MachineRequest& request) {
  auto output = app::OutputDir::open(request.out_dir, kTestOutputs, {request.machine_file}, kPreviousTest);
  if (!output) return failed(output.error());
  const auto path = machines::find_machine_file(request.machine_file, ".");
  if (!path) return failed(path.error());
  auto reading = controls::read_machine(*path);
  if (!reading.machine) return failed(std::move(reading.errors));
  const machines::Machine& machine = *reading.machine;
  const auto at_file = [&](Diagnostic error) {
    if (error.position.file.empty()) error.position.file = *path;
    return failed(std::move(error));
  };
  const auto dialect = controls::dialect_of(machine);
  if (!dialect) return at_file(dialect.error());
  if (const auto aside = output->set_aside(); !aside) return failed(aside.error());
  self_test::SelfTestOptions options;
  options.tool_length_mm = request.tool_length_mm;
  const auto test = self_test::plan_self_test(machine, options);
  if (!test) return at_file(test.error());
  text::NcHeader header;
  header.job_name = "self test " + machine.name;
  header.machine_name = machine.name;
  for (const auto& key : machine.assumed_keys) header.assumed.push_back(key);
  header.program_number = 1900;
  const auto text =
      text::write_nc(self_test::self_test_program(*test, machine, *dialect), self_test::in_air(*dialect), header);
  if (!text) return at_file(text.error());
  const std::string name = "machine_test" + dialect->extension;
  if (const auto s = output->write(name, text->text); !s) return failed(s.error());
  const auto bytes = output->read_back(name);
  if (!bytes) return failed(bytes.error());
  const auto proof = self_test::prove_self_test(*bytes, output->final_path(name), *test, machine);
  if (!proof) return failed(proof.error());
  if (const auto s = output->write("machine_test.html", test_page(machine, *test, *proof, name)); !s)
    return failed(s.error());
  if (const auto s = output->commit(); !s) return failed(s.error());
  CommandOutcome outcome;
  outcome.summary = fmt::format(
      "{}: {} stations, bar of {:g} mm, tilt up to {:g} deg, {:.1f} min\n  point X {:g} Y {:g} Z {:g} mm machine "
      "(G54)\n  read back: the tip leaves it by at most {:.4f} mm over {} moves; the spindle stands\n  files "
      "machine_test{} machine_test.html in {}\n",
      machine.name, test->stations.size(), test->tool_length_mm, degrees(test->tilt_rad), proof->minutes,
      test->point_mm.x(), test->point_mm.y(), test->point_mm.z(), proof->worst_mm, proof->moves, dialect->extension,
      request.out_dir);
  return outcome;
}

void add_machine(Commands& commands) {
  constexpr const char* kMachine = "machine file (TOML), or the name of an installed one";
  commands.push_back(command_of<MachineRequest>(
      "show", "limits, chain, senses and assumed values of a machine",
      [](OptionSet& set, MachineRequest& request) {
        set.file("MACHINE", request.machine_file, kMachine);
        set.out_dir_or_none(request.out_dir,
                            "directory for machine.html and machine.svg; without it only the text is printed");
      },
      show_machine, &kMachines));
  commands.push_back(command_of<MachineRequest>(
      "test", "program that holds the tip of a test bar on one point while the rotary axes turn: run it in air",
      [](OptionSet& set, MachineRequest& request) {
        set.file("MACHINE", request.machine_file, kMachine);
        set.out_dir(request.out_dir, "directory for the program and its page; made where it does not exist");
        set.number("--tool-length", request.tool_length_mm,
                   "gauge line to the tip of the test bar (default: 100, 60 or 30, what fits)", {1, 5000, " mm"});
      },
      test_machine, &kMachines));
}

}  // namespace toothpath::commands
