// The kernels for processors with AVX2. This file alone is compiled for them.
#include "cam/clearance/kernels.h"

namespace toothpath::clearance::avx2 {
#include "cam/clearance/kernels_body.h"
extern const MeshKernels kKernels;
const MeshKernels kKernels = {"AVX2",       nearest,          near,
                              gather,       nearest_in,       beside_flute,
                              along,        frustum_to_boxes, frustum_to_triangles,
                              ray_to_boxes, ray_to_triangles};
}  // namespace toothpath::clearance::avx2
