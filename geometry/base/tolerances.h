// Every length below which two things are treated as one, by the decision that it governs. All in mm. What a program
// must keep: cam/proof/limits.h.
#pragma once

namespace toothpath {

struct Tolerances {
  double flank_mm = 1e-10;  ///< a root of a meshing equation is found: last Newton step, as a length at m = 5
  double chord_mm = 1e-3;   ///< sag of a straight block against the exact ball-centre path
  double mesh_mm = 2e-3;    ///< sag of the facets of a tooth mesh against the exact surface
  double weld_mm = 1e-6;    ///< two mesh corners are one
};

}  // namespace toothpath
