#include "cam/clearance/kernels.h"

namespace toothpath::clearance {
namespace plain {
extern const MeshKernels kKernels;
}
#ifdef TOOTHPATH_AVX2_KERNELS
namespace avx2 {
extern const MeshKernels kKernels;
}
#endif

const MeshKernels& plain_mesh_kernels() { return plain::kKernels; }

const MeshKernels& mesh_kernels() {
#ifdef TOOTHPATH_AVX2_KERNELS
  static const bool fast = __builtin_cpu_supports("avx2") != 0;
  if (fast) return avx2::kKernels;
#endif
  return plain::kKernels;
}

}  // namespace toothpath::clearance
