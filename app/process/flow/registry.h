// The gear types: from a job to the process of its gear.
#pragma once

#include <memory>

#include "app/process/gear_process.h"

namespace toothpath::flow {

/// The gear that the job asks for; the job must outlive it. Refused: what the gear refuses, each with its place.
[[nodiscard]] process::ValueOrErrors<std::unique_ptr<process::GearProcess>> make_process(const job::Job& job);

}  // namespace toothpath::flow
