// One move of a program as it was read back: straight in the tip and in the axis between two poses of the workpiece
// frame, up to a stated deviation. Made by postproc from the bytes on disk; checked by cam.
#pragma once

#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::path {

struct ToolMotion {
  Vec3 tip_from = Vec3::Zero(), tip_to = Vec3::Zero();      ///< W, mm
  Vec3 axis_from = Vec3::UnitZ(), axis_to = Vec3::UnitZ();  ///< W, unit, tip to holder
  double deviation_mm =
      0;  ///< proven: the true tip stays this close to the straight line tip_from..tip_to (same parameter)
  double axis_deviation = 0;  ///< proven: the true axis stays this close to the normalised linear blend, rad
  double minutes = 0;         ///< time that the machine takes
  bool rapid = false;         ///< G0
  int operation = 0;          ///< index in the job
  int tooth = 0;              ///< tooth space that the program was at (its index angle), from 0
  int line = 0;               ///< of the NC file, from 1
};

/// The pose at the share t of a motion, in [0, 1]: linear in the tip, normalised linear in the axis.
[[nodiscard]] inline Vec3 tip_at(const ToolMotion& m, double t) { return (1 - t) * m.tip_from + t * m.tip_to; }
[[nodiscard]] inline Vec3 axis_at(const ToolMotion& m, double t) {
  if (t == 0) return m.axis_from;
  if (t == 1) return m.axis_to;
  return ((1 - t) * m.axis_from + t * m.axis_to).normalized();
}

}  // namespace toothpath::path
