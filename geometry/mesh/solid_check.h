// Is an imported mesh a plausible solid? Every answer names the facet, its value and the limit.
#pragma once

#include <string>

#include "geometry/mesh/file.h"

namespace toothpath::mesh {

/// Checks, in this order: finite coordinates within the limit, plausible size, degenerate facets, edges (each used once
/// in both directions), a positive volume and, if asked, crossing facets. `name` stands in the messages. Facets count
/// from 0.
[[nodiscard]] Status check_solid(const TriangleMesh& mesh, const std::string& name, const MeshImportLimits& limits);

}  // namespace toothpath::mesh
