#include "app/commands/program_motions.h"
#include "postproc/controls/of_machine.h"

namespace toothpath {

Result<ProgramMotions> motions_of_program(std::string_view text, const std::string& file, const Job& job, const Machine& machine, int teeth, double tolerance_mm,
                                          double tolerance_rad, StageClock& clock) {
  auto control = controls::control_of(machine, *job.setup, job.tools);
  if (!control) return control.error();
  ProgramMotions out;
  out.control = std::move(*control);
  auto read = clock.run("read back", [&] {
    return read_back(text, file, out.control, machine, *job.setup, {.teeth = teeth, .keep_all = job.verify.all_teeth});
  });
  if (!read) return read.error();
  out.read = std::move(read.value());
  for (const OperationTrace& trace : out.read.operations) {
    const auto part = clock.run("read back", [&] {
      return tool_motions(trace, out.read.copies, out.control, machine, *job.setup, teeth, tolerance_mm, tolerance_rad);
    });
    if (!part) return part.error();
    out.motions.insert(out.motions.end(), part->begin(), part->end());
  }
  return out;
}

ClComparison compare_with_paths(const std::vector<ToolMotion>& motions, std::span<const ClPath* const> paths, double tolerance_mm, double tolerance_rad,
                                StageClock& clock, std::vector<std::string>& reasons) {
  ClComparison c = clock.run("compare with the path", [&] { return compare_with_cl(motions, paths, tolerance_mm, tolerance_rad); });
  if (!c.complete)
    reasons.push_back(fmt::format("operation {}, record {} is not met by the program: {}", c.missed_operation, c.missed_record, c.message));
  if (c.worst_extra_mm > tolerance_mm)
    reasons.push_back(fmt::format("the program leaves the path by {:.4f} mm, limit {:.4f} mm, near line {}", c.worst_extra_mm, tolerance_mm, c.line));
  return c;
}

}  // namespace toothpath
