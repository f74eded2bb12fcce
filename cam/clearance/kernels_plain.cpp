// The kernels for any processor.
#include "cam/clearance/kernels.h"

namespace toothpath::clearance::plain {
#include "cam/clearance/kernels_body.h"
extern const MeshKernels kKernels;
const MeshKernels kKernels = {"any processor", nearest,          near,
                              gather,          nearest_in,       beside_flute,
                              along,           frustum_to_boxes, frustum_to_triangles,
                              ray_to_boxes,    ray_to_triangles};
}  // namespace toothpath::clearance::plain
