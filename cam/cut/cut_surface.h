// What a program leaves on the finished surface: excess or gouge at a dense grid of every patch, after every operation,
// computed from the path as it was read back. Exact in double on candidates of a spatial index.
#pragma once

#include <memory>
#include <vector>

#include "cam/analytic/gear_distance.h"
#include "cam/cut/left_places.h"
#include "cam/path/operation.h"
#include "cam/path/tool_motion.h"
#include "cam/proof/verification.h"
#include "cam/tool/assembly.h"
#include "cam/tool/proof_tool.h"

namespace toothpath::cut {

struct CutSurfaceOptions {
  int flank_rows = 40, fillet_rows = 14, root_rows = 7, columns = 33;
  int scallop_lines = 9;  ///< lines across each flank on which cusps are counted
  double cap_mm = 0;      ///< excess above this is reported as this; 0: one module
  double watch_mm = 0;    ///< places are kept where no more than this is missing to what may stand; 0: none
};

/// The cut surface of tooth space 0.
struct CutSurface {
  std::vector<proof::SurfaceGrid> grids;        ///< every patch of every zone
  std::vector<proof::ExcessResult> operations;  ///< after each operation, over all points
  proof::ExcessResult finished;                 ///< after the last one, over the points that its ball can reach
  proof::UnreachedResult unreached;
  /// Greatest and least excess in each region: after each operation, and of the finished surface where its tools reach.
  std::vector<path::ByRegion<double>> most_in_mm, least_in_mm;
  path::ByRegion<double> finished_in_mm;
  double solve_residual_mm =
      0;  ///< greatest difference between a radius and the distance from a centre that far above the grid
  std::vector<LeftPlace> watched;  ///< places on which no more stands than may, but nearly as much
  proof::ScallopResult scallop;    ///< cusps of the last operation; requested 0: it has none
};

class MeasuredPlaces;
class RegionJudges;

/// Measures what one program after another, or one tooth after another, leaves of a job. Where it measures, and what
/// the balls of the job reach there, is found at the first measurement.
class SurfaceMeter {
 public:
  /// Holds references to all but `options`. The tools as in `measure_cut_surface`.
  SurfaceMeter(const analytic::GearDistance& part, const std::vector<path::MillingOperation>& operations,
               const std::vector<tool::ProofTool>& tools, const CutSurfaceOptions& options);
  ~SurfaceMeter();

  /// What `measure_cut_surface` says. @param watch_mm  instead of that of the options
  [[nodiscard]] CutSurface measure(const std::vector<path::ToolMotion>& motions, double watch_mm);

 private:
  const analytic::GearDistance& part_;
  const std::vector<path::MillingOperation>& operations_;
  const std::vector<tool::ProofTool>& tools_;
  CutSurfaceOptions options_;
  std::unique_ptr<RegionJudges> judges_;
  std::unique_ptr<MeasuredPlaces> places_;  // none before the first measurement
};

/// `motions`: those of tooth 0 are used. Excess at a point p: the least, over all moves so far, of (distance from p to
/// the ball-centre path - ball radius); > 0 material left, < 0 a gouge. `finished.bound_mm` adds to the greatest value
/// seen what a cusp can rise between two samples of a scallop line and the asked chord tolerance, and is meant along
/// the normal: a crest h of a ball of radius R stands h^2 / R higher there than its distance from the ball.
[[nodiscard]] CutSurface measure_cut_surface(const analytic::GearDistance& part,
                                             const std::vector<path::ToolMotion>& motions,
                                             const std::vector<path::MillingOperation>& operations,
                                             const std::vector<tool::ToolAssembly>& tools,
                                             const CutSurfaceOptions& options = {});

/// The same for any mills: the excess is that of their cutting bodies. Operations that finish different regions (the
/// same allowance as the last one) count together where cusps are looked for. A place counts as reachable where the
/// ball end of the last tool fits, or a ball of the corner radius of a bull nose; everywhere for a flat cutter.
[[nodiscard]] CutSurface measure_cut_surface(const analytic::GearDistance& part,
                                             const std::vector<path::ToolMotion>& motions,
                                             const std::vector<path::MillingOperation>& operations,
                                             const std::vector<tool::ProofTool>& tools,
                                             const CutSurfaceOptions& options = {});

}  // namespace toothpath::cut
