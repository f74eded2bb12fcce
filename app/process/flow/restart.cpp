#include "app/process/flow/restart.h"

#include <limits>

#include "app/base/option_number.h"
#include "geometry/base/angle.h"
#include "postproc/controls/of_machine.h"
#include "postproc/joints/tooth_order.h"
#include "postproc/restart/proof.h"

namespace toothpath::flow {
namespace {

Diagnostic of_our_own(Diagnostic d) {
  d.kind = DiagnosticKind::verification;  // our own program must be readable
  return d;
}

int line_in(const std::map<int, int>& line_of, int line) {
  const auto found = line_of.find(line);
  return found == line_of.end() ? 0 : found->second;
}

/// The restart against the whole program; what it says goes to the report.
Status prove(report::RunReport& report, const process::PostedProgram& posted, const std::string& file,
             const readback::NcControl& control, const process::GearCheck& gear, std::vector<std::vector<int>>& lines,
             app::StageClock& clock) {
  const joints::ProgramRestart at = *posted.restarted->restart;
  const int place = joints::place_of_tooth(at.tooth, posted.axes.tooth_stride, posted.axes.teeth);
  const auto proof = clock.run("proof of the restart", [&] {
    return restart::prove_restart(posted.text, posted.restart_text, file, control,
                                  {at.operation, at.tooth, place, posted.axes.teeth});
  });
  if (!proof) return of_our_own(proof.error());
  if (!proof->same)
    report.reasons.push_back(fmt::format("restart at operation {} tooth {}: {} (line {}, of the whole program {})",
                                         at.operation, at.tooth, proof->difference, proof->line, proof->whole_line));
  for (const Status& rapids :
       {readback::check_axis_groups(proof->approach), gear.rapids_clear(proof->approach, control)})
    if (!rapids) report.reasons.push_back("restart: " + rapids.error().message);
  for (auto& path : lines)
    for (int& line : path) line = line_in(proof->line_of, line);
  if (report.gouge) {
    for (auto& place_of_gouge : report.gouge->worst) place_of_gouge.line = line_in(proof->line_of, place_of_gouge.line);
    report.gouge->deepest.line = line_in(proof->line_of, report.gouge->deepest.line);
    report.gouge->bound_line = line_in(proof->line_of, report.gouge->bound_line);
  }
  report.restart = at;
  for (std::size_t k = 0, rotary = 3; k < report.axes.size(); ++k) {  // where this program goes, not the whole one
    joints::AxisRange& axis = report.axes[k];
    const std::size_t a = axis.rotary ? rotary++ : k;
    axis.min = axis.rotary ? radians(proof->least[a]) : proof->least[a];
    axis.max = axis.rotary ? radians(proof->greatest[a]) : proof->greatest[a];
  }
  process::judge_travels(report.axes, report.reasons);
  report.warnings.insert(
      report.warnings.begin(),
      fmt::format("this program begins at operation {}, tooth {}: what the whole program cuts before that is taken as "
                  "done. Proven is the whole program, and that this one makes its {} last moves; gouge and left "
                  "material are those of all teeth of the whole program, times those of this one",
                  at.operation, at.tooth, proof->moves));
  return Ok{};
}

}  // namespace

Result<std::optional<joints::ProgramRestart>> read_restart(const std::string& text, const job::Job& job, int teeth) {
  if (text.empty()) return std::optional<joints::ProgramRestart>{};
  const std::size_t colon = text.find(':');
  const toml::Range numbers{0, std::numeric_limits<int>::max()};
  const auto part = [&](std::string_view digits) { return app::read_whole_number("--restart", digits, numbers); };
  const auto operation = part(std::string_view(text).substr(0, colon));
  const auto tooth = part(colon == std::string::npos ? std::string_view() : std::string_view(text).substr(colon + 1));
  if (!operation || !tooth)
    return fail_as(DiagnosticKind::usage, "--restart = {} is not OP:TOOTH, two whole numbers from 0", text);
  const auto count = static_cast<int>(job.operations.size());
  if (*operation >= count)
    return fail_as(DiagnosticKind::usage, "--restart = {}: the job has the operations 0 to {}", text, count - 1);
  if (*tooth >= teeth)
    return fail_as(DiagnosticKind::usage, "--restart = {}: the gear has the teeth 0 to {}", text, teeth - 1);
  return std::optional(joints::ProgramRestart{*operation, *tooth});
}

Status note_restart(report::RunReport& report, const process::PostedProgram& posted,
                    const process::ProgramText& program, const process::GearCheck& gear,
                    std::vector<std::vector<int>>& lines, app::StageClock& clock) {
  const auto control = controls::control_of(program.machine, *program.job.setup, program.job.tools);
  if (!control) return control.error();
  report.teeth = posted.axes.teeth;
  report.tooth_stride = posted.axes.tooth_stride;
  if (posted.restarted)
    if (auto done = prove(report, posted, program.file, *control, gear, lines, clock); !done) return done;
  const bool part = posted.restarted.has_value();
  auto menu = clock.run("restart points", [&] {
    return restart::restart_menu(part ? posted.restart_text : posted.text, program.file, *control,
                                 part ? *posted.restarted : posted.axes);
  });
  if (!menu) return of_our_own(menu.error());
  report.restart_menu = std::move(menu.value());
  return Ok{};
}

}  // namespace toothpath::flow
