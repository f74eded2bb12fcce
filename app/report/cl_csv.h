// cl.csv: the cutter location data of tooth space 0 in program order.
#pragma once

#include <span>
#include <string>

#include "cam/path/cl_path.h"

namespace toothpath::report {

/// Header `op,tooth,zone,pass,x,y,z,i,j,k,feed,kind`, one row a record: tip [mm, 7 decimals] and unit axis [9 decimals]
/// in the gear frame, feed [mm/min], kind rapid, engage, feed or retract. `tooth` is 0.
[[nodiscard]] std::string cl_csv(std::span<const path::ClPath* const> paths);

}  // namespace toothpath::report
