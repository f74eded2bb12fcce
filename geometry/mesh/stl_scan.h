// A look at the bytes of an STL file before an importer sees them: what it silently accepts is refused here, with the
// place.
#pragma once

#include <string>
#include <string_view>

#include "geometry/base/result.h"

namespace toothpath::mesh {

/// What the bytes are.
struct StlScan {
  bool binary = false;
  std::size_t facets = 0;
  std::string lower_case;  ///< text only: the file in lower case, each statement in one line, as importers expect it
};

/// Binary: the size must be 84 + 50 n for the count n that the file states. Text: strict grammar `solid name, facet
/// normal i j k, outer loop, 3 x vertex x y z, endloop, endfacet, endsolid`, in any case, any number of solids; numbers
/// with a decimal point, finite as 32-bit numbers. Refused with line number: anything else, and more than
/// `most_facets`.
[[nodiscard]] Result<StlScan> scan_stl(std::string_view bytes, const std::string& name, std::size_t most_facets);

}  // namespace toothpath::mesh
