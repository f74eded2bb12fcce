#include "app/process/flow/parts.h"

#include "app/report/machine_moves.h"
#include "geometry/base/hash.h"
#include "postproc/controls/of_machine.h"
#include "postproc/restart/parts.h"

namespace toothpath::flow {
namespace {

/// What the part adds to the teeth of the whole program is clear of the work, of fixtures and of the machine.
void prove_ends(report::RunReport& report, const std::string& file, const restart::PartProof& proof,
                const process::ProgramText& program, const process::GearCheck& gear, const readback::NcControl& control,
                const std::function<bodies::MovesJudge()>& bodies) {
  bodies::MovesJudge judge = bodies();
  for (const readback::OperationTrace* trace : {&proof.approach, &proof.departure}) {
    for (const Status& rapids : {readback::check_axis_groups(*trace), gear.rapids_clear(*trace, control)})
      if (!rapids) report.reasons.push_back(file + ": " + rapids.error().message);
    bool from = true;  // where the first move begins is another trace's business
    for (readback::ExecutedMove move : trace->moves) {
      move.known = move.known && !from;
      from = false;
      judge.add(move);
    }
  }
  for (const std::string& reason : report::reasons_of(program.machine, judge.finish()))
    report.reasons.push_back(file + ": " + reason);
}

}  // namespace

Status note_parts(report::RunReport& report, const process::PostedProgram& posted, const process::ProgramText& program,
                  const process::GearCheck& gear, const std::function<bodies::MovesJudge()>& bodies,
                  app::StageClock& clock) {
  const auto control = controls::control_of(program.machine, *program.job.setup, program.job.tools);
  if (!control) return control.error();
  std::vector<restart::PartText> texts;
  for (const process::PostedPart& p : posted.parts) texts.push_back({p.text, p.file, p.part});
  const auto proofs = clock.run("proof of the parts", [&] {
    return restart::prove_parts(posted.text, program.file, texts, *control, posted.axes);
  });
  if (!proofs) {
    Diagnostic error = proofs.error();
    error.kind = DiagnosticKind::verification;  // our own program must be readable
    return error;
  }
  for (std::size_t n = 0; n < posted.parts.size(); ++n) {
    const process::PostedPart& p = posted.parts[n];
    const restart::PartProof& proof = (*proofs)[n];
    if (!proof.difference.empty())
      report.reasons.push_back(fmt::format("{}: {} (line {}, of the whole program {})", p.file, proof.difference,
                                           proof.line, proof.whole_line));
    if (const auto hash = readback::hash_of_program(p.text); !hash || !hash->fits())
      report.reasons.push_back(p.file + ": HASH does not fit the text");
    clock.run("proof of the parts", [&] { prove_ends(report, p.file, proof, program, gear, *control, bodies); });
    const std::string type = to_string(program.job.operations[std::size_t(p.part.operation)].type);
    report.parts.push_back({p.part, type, p.file, p.name_on_control, sha256_hex(p.text), p.text.size(), p.blocks,
                            p.tools, p.feed_minutes, p.total_minutes});
  }
  return Ok{};
}

}  // namespace toothpath::flow
