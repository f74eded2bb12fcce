// Every length below which two things are treated as one, by the decision that it governs. All in mm.
#pragma once

namespace toothpath {

struct Tolerances {
  double flank_mm = 1e-10;   ///< a root of a meshing equation is found: last Newton step, as a length at m = 5
  double chord_mm = 1e-3;    ///< sag of a straight block against the exact ball-centre path
  double gouge_mm = 2e-3;    ///< deepest cut into the finished surface that still counts as verified
  double proof_mm = 2e-4;    ///< how far a proven bound may lie above the worst value measured
  double mesh_mm = 2e-3;     ///< sag of the facets of a tooth mesh against the exact surface
  double weld_mm = 1e-6;     ///< two mesh corners are one
  double clearance_mm = 0.05;  ///< least gap between neck, shank or holder and the part
};

}  // namespace toothpath
