// A gear as 3MF (core specification 1.x): one closed mesh object, unit millimetre, name and a colour. The only file
// that knows lib3mf.
#pragma once

#include <string>
#include <string_view>

#include "geometry/base/result.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::exchange {

/// The bytes of the package; the same mesh gives the same bytes. Coordinates to 32 bits and 1e-6 mm. `mesh`: closed.
/// Refused: what lib3mf refuses.
[[nodiscard]] Result<std::string> three_mf_file(const mesh::TriangleMesh& mesh, const std::string& name);

}  // namespace toothpath::exchange
