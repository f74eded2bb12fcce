// How the workpiece stands in the machine: the [setup] table of a job.
#pragma once

#include <optional>
#include <string>

#include "geometry/base/vec.h"

namespace toothpath::joints {

struct Setup {
  Vec3 origin_mm = Vec3::Zero();  ///< of the gear frame, machine coordinates, all rotaries at zero
  std::optional<double>
      pivot_error_mm;         ///< stated: how far the rotary axes may stand beside where the machine file says
  bool axis_up = true;        ///< gear z along machine +Z, x along +X; else turned by 180 deg about X
  double clocking_rad = 0;    ///< the gear stands turned by this about its own z, with the teeth that it has already
  std::string measured_file;  ///< from which origin and clocking are; empty: the job alone states them
  std::string work_offset = "G54";
  Vec3 work_offset_at_mm = Vec3::Zero();  ///< origin of the work coordinate system, machine coordinates

  /// Directions of the gear frame's axes in the machine, as columns.
  [[nodiscard]] Mat3 rotation() const {
    Mat3 r = Mat3::Identity();
    if (!axis_up) r.diagonal() = Vec3(1, -1, -1);
    return clocking_rad == 0 ? r : Mat3(r * Eigen::AngleAxisd(clocking_rad, Vec3::UnitZ()));
  }
};

/// The turned body ahead of the cut as a ring about Z of the work offset, for the graphics of controls; mm.
struct GraphicsBlank {
  double radius_mm = 0, bore_mm = 0;  ///< radii; a bore of 0: it is solid
  double bottom_mm = 0, top_mm = 0;   ///< seen from the work offset
};

}  // namespace toothpath::joints
