// What `contact` is asked for: the keys of [contact], and options in their place.
#pragma once

#include "app/process/gear_process.h"

namespace toothpath::under_load {

/// Settings of [contact] with what the command line says instead.
[[nodiscard]] job::ContactSettings contact_settings(const job::Job& job, const process::ContactAsked& asked);

}  // namespace toothpath::under_load
