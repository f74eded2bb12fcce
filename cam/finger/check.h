// Proof of a finger-milled bevel gear: gouge, clearance, rapids, material left on the walls, ridges on the root. Works
// on the motions that were read back from the program, in double, with the real (hollow) cutter profile and the exact
// walls.
//
// Measured: points of the exact walls against the solid cutter along every motion (finger_walls), ridges
// (finger_ridge). Proven: the centre of the cutter against the nominal wall paths (finger_poses), with everything that
// lies between samples added; shank, holder and flute against blank, hub and shaft (finger_obstacles).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "cam/finger/ridge.h"
#include "cam/path/motions.h"
#include "cam/path/operation.h"
#include "cam/proof/checked_cl_path.h"
#include "cam/proof/limits.h"
#include "cam/proof/verification.h"
#include "cam/tool/assembly.h"

namespace toothpath::finger {

struct FingerCheckResult {
  proof::GougeResult gouge;
  std::vector<proof::ExcessResult> operations;  ///< after each operation, on the walls
  proof::ExcessResult finished;
  RidgeResult ridge;
  std::vector<proof::SurfaceGrid> walls;
  double root_gouge_mm = 0;         ///< deepest the tip goes below the root cone
  double tilt_rad = 0;              ///< largest angle between a cutting axis and the normal of the pitch cone
  double wall_excess_bound_mm = 0;  ///< what may stand on a wall anywhere, from the distance of the paths
};

struct FingerCheckOptions {
  int columns = 25;        ///< of a wall grid, along the face of a half
  int rows = 21;           ///< along the profile
  int ridge_columns = 41;  ///< along the face of the gear
  int ridge_rows = 33;     ///< across the space
};

class FingerGougeCheck {
 public:
  /// @param gear made with the finishing mill; operations in the order of the job, their tools are indices into `tools`
  FingerGougeCheck(const bevel_gear::BevelGear& gear, std::span<const tool::ToolAssembly> tools,
                   std::span<const path::MillingOperation> operations, const proof::ProofLimits& limits,
                   const FingerCheckOptions& options = {});
  ~FingerGougeCheck();
  FingerGougeCheck(const FingerGougeCheck&) = delete;
  FingerGougeCheck& operator=(const FingerGougeCheck&) = delete;

  /// Passes a path whose poses and straight moves cut no wall and no root deeper than the gouge tolerance, whose shank
  /// and holder keep their clearance, and `room_mm` more for what words and control take, and whose rapids are clear of
  /// the blank. Else a verification diagnostic that names place and depth. The walls that the path ought to cut are not
  /// judged here.
  [[nodiscard]] Result<proof::CheckedClPath> approve(path::ClPath path, double room_mm = 0) const;

  /// Everything, from motions of any tooth space; runs on all threads, same bytes on any number. The wall and ridge
  /// measurements use those of the first tooth present.
  [[nodiscard]] FingerCheckResult verify(std::span<const path::ToolMotion> motions) const;

  /// What is proven, with the same numbers; on the walls themselves only the motions that are marked are looked at, and
  /// there are no grids. @param look one a motion
  [[nodiscard]] FingerCheckResult bounds(std::span<const path::ToolMotion> motions, std::span<const char> look) const;

  /// Does it feed where the tool may be within the blank?
  [[nodiscard]] bool among_teeth(const path::ToolMotion& motion) const;

  /// The rapids among these motions against blank, hub and shaft; the places that are met stand in `worst`.
  [[nodiscard]] proof::GougeResult rapids(std::span<const path::ToolMotion> motions) const;

  /// Highest ridge left between the walls by these motions.
  [[nodiscard]] RidgeResult ridge(std::span<const path::ToolMotion> motions) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace toothpath::finger
