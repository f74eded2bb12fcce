#include "app/commands/machine.h"

#include "app/output_dir.h"
#include "app/report/machine_sheet.h"
#include "machines/machine_file.h"

namespace toothpath {
namespace {

const std::vector<std::string> kShowOutputs = {"machine.html", "machine.svg"};

struct Shown {
  std::string text, page, drawing;
};

/// Text, page and drawing of a machine of either kind.
std::variant<Shown, std::vector<Diagnostic>> shown(const std::string& path) {
  const auto kind = machine_kind_of(path);
  if (!kind) return std::vector{kind.error()};
  if (*kind == MachineKind::gear_shaper) {
    auto reading = read_shaper_machine_file(path);
    if (!reading.machine) return std::move(reading.errors);
    return Shown{machine_text(*reading.machine), machine_page(*reading.machine), {}};
  }
  auto reading = read_machine_file(path);
  if (!reading.machine) return std::move(reading.errors);
  return Shown{machine_text(*reading.machine), machine_page(*reading.machine), machine_drawing_svg(*reading.machine)};
}

}  // namespace

CommandOutcome show_machine(const CommandRequest& request) {
  const auto path = find_machine_file(request.job_file, ".");
  if (!path) return failed(path.error());
  auto result = shown(*path);
  if (auto* errors = std::get_if<1>(&result)) return failed(std::move(*errors));
  const Shown& machine = std::get<0>(result);
  CommandOutcome outcome;
  outcome.summary = machine.text;
  if (request.out_dir.empty()) return outcome;
  auto output = OutputDir::open(request.out_dir, kShowOutputs);
  if (!output) return failed(output.error());
  if (const auto s = output->write("machine.html", machine.page); !s) return failed(s.error());
  if (!machine.drawing.empty())
    if (const auto s = output->write("machine.svg", machine.drawing); !s) return failed(s.error());
  if (const auto s = output->commit(); !s) return failed(s.error());
  return outcome;
}

}  // namespace toothpath
