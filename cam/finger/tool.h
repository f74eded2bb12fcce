// One finger mill in a gear, as the checks need it: its solid with quick bounds, the wall paths that belong to it, and
// the distance of points from the solid along a motion.
#pragma once

#include <array>

#include "cam/finger/reference.h"
#include "cam/path/tool_motion.h"
#include "cam/tool/assembly.h"
#include "geometry/bevel_gear/gear.h"

namespace toothpath::finger {

/// The cutter's radius by height in a table, for lower bounds of a distance that cost next to nothing.
class FingerRadiusTable {
 public:
  explicit FingerRadiusTable(const bevel_gear::FingerSolid& solid);
  /// Never above the lower surface at radius rho.
  [[nodiscard]] double floor_below(double rho) const;
  /// Never more than the distance from (x, rho) to the solid, mm.
  [[nodiscard]] double lower_bound(double x, double rho) const;

 private:
  static constexpr int kCells = 256;
  double low_ = 0, high_ = 1, shrink_ = 1, radius_end_ = 0;
  std::array<double, kCells + 1> lower_{}, radius_{};
};

struct FingerTool {
  bevel_gear::BevelGear gear;  ///< made with this tool
  bevel_gear::FingerSolid solid;
  FingerRadiusTable table;
  WallReference walls[2];                ///< L, U
  double shape_mm = 0;                   ///< how far this tool on its own paths cuts beyond the finished walls
  double depth_mm;                       ///< tip to the height h_a
  double shank_from_mm, holder_from_mm;  ///< above the tip

  /// @param own  the gear made with this tool; @param finished  made with the finishing mill
  FingerTool(const bevel_gear::BevelGear& own, const bevel_gear::BevelGear& finished, const tool::ToolAssembly& tool);
};

/// Distance from a point of the blank to the cutter, least over one motion [mm], negative inside; `best` where it is
/// not less.
[[nodiscard]] double least_distance(const Vec3& p, const path::ToolMotion& m, const FingerTool& tool, double best);

/// Height of the cutter's lower surface above the root cone on the normal of the pitch cone through `foot`, least over
/// one motion [mm]; `best` where the cutter does not come lower.
[[nodiscard]] double covering_height(const FingerTool& tool, const Vec3& foot, const Vec3& normal,
                                     const path::ToolMotion& m, double best);

}  // namespace toothpath::finger
