// `toothpath forces JOB`: tooth forces of a bevel pair, both members, both senses, one hand and herringbone, over R_J.
#pragma once

#include "app/commands/command.h"

namespace toothpath {

/// Torque on the gear of the job: `request.torque_Nm`, else torque in the job's [load], else refused. Writes forces.csv,
/// forces.json and forces.html. Refused: a face gear and what BevelGear::make refuses.
[[nodiscard]] CommandOutcome run_forces(const CommandRequest& request);

}  // namespace toothpath
