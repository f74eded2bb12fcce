// `toothpath forces JOB`: tooth forces of a bevel pair, both members, both senses, one hand and herringbone, over R_J.
#pragma once

#include <optional>

#include "app/commands/command.h"

namespace toothpath::commands {

struct ForcesRequest : JobRequest {
  std::optional<double> torque_Nm;  ///< on the gear of the job
};

/// Torque on the gear of the job: `request.torque_Nm`, else torque in the job's [load], else refused. Writes
/// forces.csv, forces.json and forces.html. Refused: a face gear and what BevelGear::make refuses.
[[nodiscard]] CommandOutcome run_forces(const ForcesRequest& request);

}  // namespace toothpath::commands
