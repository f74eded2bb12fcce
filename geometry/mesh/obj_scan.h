// Triangles of an OBJ text. Every byte is looked at here: a library's reader of this format ran out of its memory on
// damaged files.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::mesh {

struct ObjScan {
  std::vector<std::array<float, 3>> vertices;       ///< finite
  std::vector<std::array<std::int32_t, 3>> facets;  ///< indices of vertices that are there
};

/// Vertices and triangles; normals, textures, groups, names and materials are passed over. Refused, with the line: a
/// coordinate that is no finite 32-bit number, facets that are no triangles, vertices that are not there, lines that
/// no mesh has, more than `most_facets`.
[[nodiscard]] Result<ObjScan> scan_obj(std::string_view text, const std::string& name, std::size_t most_facets);

}  // namespace toothpath::mesh
