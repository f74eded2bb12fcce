// What a motion controller executed against what we read back: two lists of joints, compared as curves in order.
#pragma once

#include <array>
#include <istream>
#include <span>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::test {

/// X Y Z in mm, tilt (A or B) and C in degrees: the joints of LinuxCNC's trt kinematics in their order.
using JointVector = std::array<double, 5>;

/// A degree of a rotary joint counts as much as 1.75 mm: what it moves at a radius of 100 mm.
inline constexpr double kMmPerDegree = 1.7453292519943295;

/// Euclidean distance with the rotaries weighed by kMmPerDegree [mm].
double joint_distance(const JointVector& a, const JointVector& b);

/// A corner of the path that we expect, with the line of the program that ends there.
struct PathCorner {
  JointVector joints{};
  int line = 0;
};

struct CurveComparison {
  bool followed = false;  ///< the record runs along the path from its first corner to its last, in order
  double worst = 0;    ///< greatest distance of the record from the path and of the path's corners from the record [mm]
  int line = 0;        ///< of the program, where that is
  int stuck_line = 0;  ///< not followed: the last line that was reached
  std::size_t samples = 0;  ///< of the record between the first corner and the last
};

/// Which distances `worst` is made of.
enum class Counted {
  both,
  samples,  ///< of the record from the path: the motion left its path
  corners,  ///< of the path's corners from the record: the motion did not come so far
};

/// The smallest d for which the record can be walked along the path, never backwards over a corner, with every sample
/// within d of the path and every corner within d of the record (a Frechet distance for sampled curves).
/// @param give_up [mm] a record farther off than this does not follow the path, whatever is counted
CurveComparison compare_curves(std::span<const PathCorner> path, std::span<const JointVector> record, double give_up,
                               Counted counted = Counted::both);

/// Samples as LinuxCNC's halsampler prints them: five numbers a line. Errors: a line with "overrun" (samples were lost)
/// or anything else that is not five finite numbers; no line at all.
Result<std::vector<JointVector>> read_samples(std::istream& in);

}  // namespace toothpath::test
