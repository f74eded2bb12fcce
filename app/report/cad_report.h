// What is told of a gear that was written as a solid.
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

}  // namespace toothpath::report
