// tooth.vtp: the surfaces of one tooth space with the deviation that the program leaves, for ParaView and the like.
#pragma once

#include <string>
#include <vector>

#include "cam/proof/verification.h"
#include "geometry/base/result.h"

namespace toothpath::report {

/// VTK PolyData text of all grids, mm. Point data: "deviation_um" (after the last operation), "deviation_um_op<n>" for
/// every operation, "reachable" (1, or 0 where the finishing ball does not come) and "zone".
[[nodiscard]] Result<std::string> deviation_vtp(const std::vector<proof::SurfaceGrid>& grids);

}  // namespace toothpath::report
