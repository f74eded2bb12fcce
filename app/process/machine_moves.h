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

namespace toothpath::process {

/// The bodies of its file. Refused: a mesh that cannot be read or is no closed solid, at its key `file`.
/// @param examine the whole mesh, whether facets cross too; once is enough
[[nodiscard]] ValueOrErrors<std::vector<bodies::Body>> machine_bodies(const machines::Machine& machine, bool examine);

/// With them what the job brings: the part as a cylinder, its tools, the meshes of fixture and stock. Empty where the
/// machine states no body: there is nothing to check. Errors: as above; a tool that does not fit the gear.
/// @param scene may be null
[[nodiscard]] Result<std::vector<bodies::Body>> bodies_in_machine(const job::Job& job, const machines::Machine& machine,
                                                                  const GearProcess& gear, const Scene* scene);

/// Judges every move that is read back. The clearance that the job asks of shanks and holders counts for them, too.
[[nodiscard]] bodies::MovesJudge judge_of(const machines::Machine& machine, std::vector<bodies::Body> bodies,
                                          const job::Job& job, double clearance_mm);

/// Why a program does not pass, one line a pair of bodies; empty: it does.
[[nodiscard]] std::vector<std::string> reasons_of(const machines::Machine& machine, const bodies::MovesFound& found);

/// What would free the pairs that meet, one line a kind of meeting.
[[nodiscard]] std::vector<std::string> help_for(const bodies::MovesFound& found);

}  // namespace toothpath::process
