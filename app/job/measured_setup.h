// Where a part stands as it was touched on the machine: a small file that `toothpath probe` writes, or that somebody
// types from the display of the control (docs/probing.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "app/job/job.h"
#include "geometry/base/result.h"
#include "machines/toml/table_reader.h"

namespace toothpath::job {

struct MeasuredSetup {
  Vec3 origin_mm = Vec3::Zero();  ///< of the gear frame, machine coordinates, all rotaries at zero
  double clocking_rad = 0;        ///< turn of the teeth about gear z
};

/// Reads `[measured] origin = [x, y, z]`, mm, and `clocking`, degrees (0 where it is left out); `touches` and
/// `residual_um` may stand beside them. Errors at their place.
[[nodiscard]] Result<MeasuredSetup> parse_measured_setup(std::string_view text, const std::string& file);

/// The file as text, with a comment line.
[[nodiscard]] std::string measured_setup_text(const MeasuredSetup& measured, std::size_t touches, double residual_mm);

/// Takes the file that [setup] names into the setup; the job's warnings say where the part stands. Refused, at the key:
/// what the file refuses; an origin farther than 5 mm from that of the job; teeth turned by more than half a pitch.
void take_measured(toml::TableReader& table, const std::string& name, Job& job, joints::Setup& setup);

}  // namespace toothpath::job
