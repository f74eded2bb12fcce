// Two facets that certainly do not meet: a quick answer for most pairs, ahead of exact predicates.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::mesh {

/// Is it certain that two facets meet nowhere except in the corners and the edge that they share? False: unknown.
/// Facets are indices into `points`; equal indices are one corner. Their planes and, seen along each axis, the lines
/// through their edges are tried as what parts them; the sign of a determinant counts only above its rounding.
[[nodiscard]] bool surely_apart(const std::vector<Vec3>& points, const std::array<std::size_t, 3>& a,
                                const std::array<std::size_t, 3>& b);

}  // namespace toothpath::mesh
