// What a program does at one tooth, against the path turned to that tooth.
#pragma once

#include <vector>

#include "geometry/base/angle.h"
#include "postproc/readback/reader.h"

namespace toothpath::test {

/// @param motions read back with every tooth kept, tolerances as compare_with_cl takes them
inline readback::ClComparison compare_tooth(const std::vector<path::ToolMotion>& motions, int tooth, int teeth,
                                            const path::ClPath& path, double tolerance_mm, double axis_tolerance_rad) {
  path::ClPath turned = path;
  const Mat3 turn = Eigen::AngleAxisd(2 * kPi * tooth / teeth, Vec3::UnitZ()).toRotationMatrix();
  for (auto& r : turned.records) {
    r.tip = turn * r.tip;
    r.axis = turn * r.axis;
  }
  std::vector<path::ToolMotion> of_tooth;
  for (path::ToolMotion motion : motions)
    if (motion.tooth == tooth) {
      motion.tooth = 0;
      of_tooth.push_back(motion);
    }
  const std::vector<const path::ClPath*> list = {&turned};
  return readback::compare_with_cl(of_tooth, list, tolerance_mm, axis_tolerance_rad);
}

}  // namespace toothpath::test
