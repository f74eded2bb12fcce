// The bodies of a machine, of what stands on its table and of the tools of a job: what the moves of a program are
// checked against beside the part (docs/proof.md, The bodies of the machine).
#pragma once

#include <string>
#include <vector>

#include "app/job/job.h"
#include "app/process/gear_process.h"
#include "app/process/scene.h"
#include "machines/machine.h"
#include "postproc/bodies/moves.h"

namespace toothpath::flow {

/// The bodies of the machine with what the job brings: the part as a cylinder, its tools, the meshes of fixture and
/// stock. Empty where the machine states no body: there is nothing to check. Errors: a mesh of the machine that cannot
/// be read; a tool that does not fit the gear.
/// @param scene may be null
[[nodiscard]] Result<std::vector<bodies::Body>> bodies_in_machine(const job::Job& job, const machines::Machine& machine,
                                                                  const process::GearProcess& gear,
                                                                  const process::Scene* scene);

/// Judges every move that is read back. The clearance that the job asks of shanks and holders counts for them, too.
[[nodiscard]] bodies::MovesJudge judge_of(const machines::Machine& machine, std::vector<bodies::Body> bodies,
                                          const job::Job& job, double clearance_mm);

}  // namespace toothpath::flow
