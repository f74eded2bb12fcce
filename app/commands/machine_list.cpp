// `toothpath machine list`: the installed machines, a line each.
#include <nlohmann/json.hpp>

#include "app/commands/command.h"
#include "app/report/page/study_page.h"
#include "app/report/svg/html_text.h"
#include "geometry/base/json_text.h"
#include "machines/machine_file.h"
#include "postproc/shaper/control.h"

namespace toothpath::commands {
namespace {

std::string letters_of(const std::vector<machines::RotaryAxis>& axes) {
  std::string letters;
  for (const auto& axis : axes) letters += std::string(letters.empty() ? "" : " ") + axis.letter;
  return letters.empty() ? "-" : letters;
}

/// One machine: its cells, the same in JSON, or what is wrong with its file.
struct Listed {
  std::vector<std::string> cells;
  nlohmann::ordered_json json;
  std::vector<Diagnostic> errors;
};

Listed listed(const std::string& file, const std::string& name, const char* kind, const std::string& control,
              const std::string& table, const std::string& head, std::size_t assumed) {
  Listed out;
  out.cells = {file, name, kind, table, head, control, assumed == 0 ? "-" : std::to_string(assumed)};
  out.json = {{"file", file},      {"name", svg::valid_utf8(name)},
              {"kind", kind},      {"table", table},
              {"head", head},      {"dialect", control},
              {"assumed", assumed}};
  return out;
}

Listed read_installed(const std::string& file) {
  const auto path = machines::find_machine_file(file, "/");
  if (!path) return {{}, {}, {path.error()}};
  const auto opened = machines::open_machine_file(*path);
  if (!opened) return {{}, {}, {opened.error()}};
  if (opened->kind == machines::MachineKind::gear_shaper) {
    auto reading = shaper::read_shaper_machine_of_text(opened->text, *path);
    if (!reading.machine) return {{}, {}, std::move(reading.errors)};
    return listed(file, reading.machine->name, "gear_shaper", reading.machine->dialect, "-", "-",
                  reading.machine->assumed_keys.size());
  }
  auto reading = machines::read_machine_text(opened->text, *path);
  if (!reading.machine) return {{}, {}, std::move(reading.errors)};
  const machines::Machine& m = *reading.machine;
  return listed(file, m.name, "five_axis", m.dialect, letters_of(m.chain.table), letters_of(m.chain.head),
                m.assumed_keys.size());
}

/// Every machine that can be read is listed; the files that cannot are errors.
CommandOutcome list_machines(const CommonRequest&) {
  page::PageTable table{"", {"file", "machine", "kind", "table", "head", "control", "assumed"}, {}, ""};
  nlohmann::ordered_json json = {
      {"schema", 1}, {"command", "machine list"}, {"machines", nlohmann::ordered_json::array()}};
  std::vector<Diagnostic> errors;
  for (const auto& file : machines::installed_machines()) {
    Listed machine = read_installed(file);
    errors.insert(errors.end(), machine.errors.begin(), machine.errors.end());
    if (!machine.errors.empty()) continue;
    table.rows.push_back(std::move(machine.cells));
    json["machines"].push_back(std::move(machine.json));
  }
  CommandOutcome outcome;
  if (!errors.empty()) outcome = failed(std::move(errors));
  outcome.summary = page::table_text(table);
  outcome.report_json = json_text(json, 2) + "\n";
  return outcome;
}

}  // namespace

void add_machine_list(Commands& commands) {
  commands.push_back(command_of<CommonRequest>(
      "list", "the installed machines, a line each",
      [](OptionSet& set, CommonRequest&) { set.examples({"machine list"}); }, list_machines, &kMachines));
}

}  // namespace toothpath::commands
