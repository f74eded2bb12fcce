// The bodies of a machine file as solids.
#pragma once

#include <vector>

#include "geometry/base/result.h"
#include "machines/machine.h"
#include "postproc/bodies/scene.h"

namespace toothpath::bodies {

/// Every body of the machine. Refused, each at its key `file`: a mesh that cannot be read or is no closed solid.
/// @param examine the whole mesh, whether facets cross too; once is enough
[[nodiscard]] Expected<std::vector<Body>, std::vector<Diagnostic>> bodies_of(const machines::Machine& machine,
                                                                             bool examine);

}  // namespace toothpath::bodies
