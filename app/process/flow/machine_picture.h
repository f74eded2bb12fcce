// The gear on its machine, for the 3D view of the report.
#pragma once

#include "app/job/job.h"
#include "app/process/gear_process.h"
#include "app/process/scene.h"
#include "app/report/page/machine_scene.h"
#include "machines/machine.h"

namespace toothpath::flow {

/// Records the moves of the job's program while it is read back.
[[nodiscard]] page::StateRecorder recorder_of(const job::Job& job, int teeth);

/// What the machine file states, or a plain table and a spindle that stand in for it; the gear, what holds it, and the
/// program as it was read back. Nothing where the gear cannot be drawn. @param scene meshes of fixtures; may be null
[[nodiscard]] std::optional<page::MachineScene> machine_picture(const job::Job& job, const machines::Machine& machine,
                                                                const process::GearProcess& gear,
                                                                page::SceneStates states, const process::Scene* scene);

}  // namespace toothpath::flow
