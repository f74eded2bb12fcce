// What is told of a gear that was written as a solid, and of the part that roughing leaves.
#pragma once

#include <cstddef>
#include <string>

namespace toothpath::report {

struct CadReport {
  std::string file;                    ///< "gear.step"
  std::size_t faces = 0, patches = 0;  ///< of the solid; those of teeth, as B-splines
  std::size_t bytes = 0;
  std::size_t checked = 0;            ///< places of one pitch at which the deviation was taken
  double worst_mm = 0, asked_mm = 0;  ///< greatest deviation from the exact surface, and its limit
  std::string worst_at;               ///< "fillet +1 of zone 0"
};

/// The part after roughing: nothing that stands is missing.
struct RoughedReport {
  std::string file;  ///< "roughed.stl"
  std::size_t triangles = 0, bytes = 0;
  double cell_mm = 0;   ///< of its grid along the teeth, at most; across them a quarter
  double thick_mm = 0;  ///< proven: no place of it lies deeper inside what the program's roughing removes
};

}  // namespace toothpath::report
