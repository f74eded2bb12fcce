#include "app/process/program_proof.h"

#include "app/process/program_report.h"
#include "app/process/tooth_copies.h"
#include "postproc/controls/of_machine.h"

namespace toothpath::process {
namespace {

/// Of the gouge tolerance that may go into teeth which are not quite the first one: roundings of words of two teeth,
/// with room.
constexpr double kCopyShare = 0.25;

/// The text as motions of the tool.
Result<ProgramProof> read_program(const ProgramText& program, const GearCheck& gear, app::StageClock& clock) {
  const job::Job& job = program.job;
  auto control = controls::control_of(program.machine, *job.setup, job.tools);
  if (!control) return control.error();
  ProgramProof out;
  out.control = std::move(*control);
  auto read = clock.run("read back", [&] {
    return read_back(program.text, program.file, out.control, program.machine, *job.setup,
                     {.teeth = gear.teeth(), .keep_all = job.verify.all_teeth});
  });
  if (!read) return read.error();
  out.read = std::move(read.value());
  for (const readback::OperationTrace& trace : out.read.operations) {
    if (const auto count = static_cast<int>(job.operations.size()); trace.operation >= count)
      return fail_at({program.file, trace.moves.empty() ? 0 : trace.moves.front().line, 0},
                     "operation {}: the job has the operations 0 to {}", trace.operation, count - 1);
    const auto part = clock.run("read back", [&] {
      return tool_motions(trace, out.read.copies, out.control, program.machine, *job.setup, gear.teeth(),
                          {gear.motion_tolerance(), gear.motion_tolerance()});
    });
    if (!part) {
      Diagnostic error = part.error();
      error.position.file = program.file;
      return error;
    }
    out.motions.insert(out.motions.end(), part->begin(), part->end());
  }
  return out;
}

/// Only the teeth are proven against the part: nothing may feed ahead of, between or behind them.
void judge_feeds_between(const readback::ReadBack& read, std::vector<std::string>& reasons) {
  for (const readback::OperationTrace& trace : read.between)
    for (std::size_t k = 1; k < trace.moves.size(); ++k)
      if (const readback::ExecutedMove& m = trace.moves[k]; !m.rapid) {
        reasons.push_back(fmt::format("line {}: a feed that belongs to no tooth", m.line));
        return;
      }
}

void compare(ProgramProof& proof, const AskedPaths& asked, const GearCheck& gear, app::StageClock& clock) {
  const double mm = asked.mm + 2 * gear.motion_tolerance(), rad = asked.rad + 2 * gear.motion_tolerance();
  const readback::ClComparison c = clock.run(
      "compare with the path", [&] { return readback::compare_with_cl(proof.motions, asked.paths, mm, rad); });
  if (!c.complete)
    proof.reasons.push_back(fmt::format("operation {}, record {} is not met by the program: {}", c.missed_operation,
                                        c.missed_record, c.message));
  if (c.worst_extra_mm > mm)
    proof.reasons.push_back(fmt::format("the program leaves the path by {:.4f} mm, limit {:.4f} mm, near line {}",
                                        c.worst_extra_mm, mm, c.line));
  proof.comparison = c;
  proof.path_tolerance_mm = mm;
}

}  // namespace

Result<ProgramProof> prove_program(const ProgramText& program, const AskedPaths& asked, GearCheck& gear,
                                   app::StageClock& clock) {
  auto read = read_program(program, gear, clock);
  if (!read) return read.error();
  ProgramProof proof = std::move(read.value());
  if (proof.read.mixed_rapid > 0)
    proof.reasons.push_back(fmt::format("line {}: a rapid moves more than one group of axes", proof.read.mixed_rapid));
  for (const auto* traces : {&proof.read.operations, &proof.read.between})
    for (const readback::OperationTrace& trace : *traces)
      if (const auto clear = gear.rapids_clear(trace, proof.control); !clear)
        proof.reasons.push_back(clear.error().message);
  judge_feeds_between(proof.read, proof.reasons);
  judge_travels(ranges_of(proof.read, program.machine), proof.reasons);
  gear.meet(proof);
  // Teeth that are written out one by one: what is the first tooth again, turned, need not be proven again.
  if (!proof.read.copies.copies && !program.job.verify.all_teeth)
    proof.motions = clock.run("compare the teeth", [&] {
      return without_copies(std::move(proof.motions), gear.teeth(), kCopyShare * program.job.verify.gouge_tolerance_mm);
    });
  gear.judge(proof, clock);
  if (!asked.paths.empty()) compare(proof, asked, gear, clock);
  return proof;
}

}  // namespace toothpath::process
