// What a body of revolution of any profile has removed along a path: the signed distance to the volume that it sweeps.
//
// A mill as wide as the tooth space is near every place of it all along its path, so that boxes about its motions tell
// nothing. Here space is cut in cubes, and every cube that is asked about keeps the motions of which one is nearest
// somewhere in it. Whatever is said to be removed, a pose of the path removes it.
#pragma once

#include <tbb/concurrent_unordered_map.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "cam/path/tool_motion.h"

namespace toothpath::rest {

class SweptBody {
 public:
  /// Signed distance to the body, mm, negative inside, at a height above its tip and a radius >= 0; at most 1 mm a mm,
  /// not falling with the radius, never deeper inside than the body is.
  using Body = std::function<double(double height, double radius)>;

  /// `motions`: of the path, in any order; rapids among them remove nothing. Distances of places up to `height_mm`
  /// above the tip and `radius_mm` from the axis are interpolated in a table; others cost what the body asks.
  SweptBody(std::vector<path::ToolMotion> motions, Body body, double height_mm, double radius_mm);

  /// min over the path of the distance to the body, of every motion at the pose whose axis is nearest, and at its ends
  /// where it is not level: never less than what is true but for kWithin_mm. Values above `cap` are returned as `cap`.
  [[nodiscard]] double excess(const Vec3& p, double cap) const;
  static constexpr double kWithin_mm = 0.005;

 private:
  [[nodiscard]] double distance(double height, double radius) const;
  [[nodiscard]] double of_motion(const Vec3& p, const path::ToolMotion& m) const;
  /// Motions of which one is the nearest to some place of the cube about `middle`.
  [[nodiscard]] std::vector<std::uint32_t> near(const Vec3& middle) const;

  std::vector<path::ToolMotion> motions_;
  Body body_;
  std::size_t rows_, columns_;  ///< of the table
  std::vector<double> table_;
  mutable tbb::concurrent_unordered_map<std::uint64_t, std::vector<std::uint32_t>> cubes_;
};

}  // namespace toothpath::rest
