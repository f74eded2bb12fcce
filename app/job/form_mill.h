// The mill that makes the flanks of an equal-base-circle bevel gear.
#pragma once

#include <optional>

#include "app/job/job.h"
#include "geometry/base/result.h"

namespace toothpath::job {

struct FormMill {
  std::optional<std::size_t> tool;  ///< of the job; none: [gear.mill], or the rules
  bevel_gear::FingerCutterData data;
};
/// The tool of the last finger_finishing, without one the first finger mill; without any [gear.mill], and where a job
/// with operations lacks that the mill by the rules of docs/bevel_gear.md 4. The job must be that of a bevel gear.
/// Refused: a finger mill besides [gear.mill]; neither of them in a job without operations.
[[nodiscard]] Result<FormMill> form_mill(const Job& job);

}  // namespace toothpath::job
