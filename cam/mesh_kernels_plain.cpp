// The kernels for any processor.
#include "cam/mesh_kernels.h"

namespace toothpath::plain {
#include "cam/mesh_kernels_body.h"
extern const MeshKernels kKernels;
const MeshKernels kKernels = {"any processor", nearest, gather, nearest_in, beside_flute, frustum_to_boxes, frustum_to_triangles};
}  // namespace toothpath::plain
