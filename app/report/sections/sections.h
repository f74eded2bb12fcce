// The sections of the report that are tables, in one list that page and set-up sheet walk. One file a section and its
// line in registry.inl.
#pragma once

#include <span>
#include <vector>

#include "app/job/job.h"
#include "app/report/run_report.h"
#include "app/report/section.h"
#include "cam/path/cl_path.h"
#include "machines/machine.h"
#include "postproc/joints/program.h"

namespace toothpath::sections {

/// What a section may look at: a run that got as far as its proof.
struct SectionInput {
  const job::Job& job;
  const machines::Machine& machine;
  const report::RunReport& report;             ///< complete but for its sections and files
  const joints::AxisProgram& program;          ///< what lies on the disk
  std::span<const path::ClPath* const> paths;  ///< one an operation, one tooth space
};

/// Those that have something to say, in the order of registry.inl.
[[nodiscard]] std::vector<report::Section> sections_of(const SectionInput& input);

/// Teeth of the places [first, end) of the order: "all teeth", "tooth 3", "teeth 12 to 23", spread "teeth 0, 31, 2".
[[nodiscard]] std::string teeth_words(const report::RunReport& report, int first_place, int end_place);

/// Meshes of stock and fixture: which, where, how far from the finished gear. Of `check`, which has no axis program.
[[nodiscard]] report::Section scene(const report::RunReport& report);
/// How near the bodies of the machine come to each other; empty where it states none. Of `check`.
[[nodiscard]] report::Section machine_moves_of(const machines::Machine& machine, const report::RunReport& report);
/// Feeds, speeds, tools and coolant as they were read, beside what the job asks. Of `check`.
[[nodiscard]] report::Section conditions(const job::Job& job, const machines::Machine& machine,
                                         const report::RunReport& report);

}  // namespace toothpath::sections
