#include "cam/analytic/spatial_index.h"

#if __has_include(<embree4/rtcore.h>) && !defined(TOOTHPATH_FORCE_EMBREE3)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <tbb/task_arena.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

namespace toothpath::analytic {
namespace {

std::atomic<std::size_t> indices_built{0};

// Rounding of a coordinate below 2^11 mm to float32 and of the distance computed from it, with room to spare.
constexpr double kBoxPad = 1e-3;

struct Query {
  SpatialIndex::Visit visit;
  void* context;
};

bool on_candidate(RTCPointQueryFunctionArguments* args) {
  auto* query = static_cast<Query*>(args->userPtr);
  const double radius = double(args->query->radius);
  const double next = query->visit(query->context, args->primID, radius);
  if (next + kBoxPad < radius) {
    args->query->radius = float(next + kBoxPad);
    return true;
  }
  return false;
}

}  // namespace

struct SpatialIndex::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Box> boxes;
  Vec3 centre = Vec3::Zero();

  void build() {
    device = rtcNewDevice(nullptr);
    if (!device) give_up(rtcGetDeviceError(nullptr));
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, unsigned(boxes.size()));
    rtcSetGeometryUserData(geometry, this);
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* args) {
          const auto& self = *static_cast<const Impl*>(args->geometryUserPtr);
          const Box& b = self.boxes[args->primID];
          const Vec3 low = b.low - self.centre, high = b.high - self.centre;
          args->bounds_o->lower_x = float(low.x() - kBoxPad);
          args->bounds_o->lower_y = float(low.y() - kBoxPad);
          args->bounds_o->lower_z = float(low.z() - kBoxPad);
          args->bounds_o->upper_x = float(high.x() + kBoxPad);
          args->bounds_o->upper_y = float(high.y() + kBoxPad);
          args->bounds_o->upper_z = float(high.z() + kBoxPad);
        },
        nullptr);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) give_up(error);
  }

  /// A tree that is not whole would find too little. What makes the library fail on a processor that it knows is
  /// memory.
  [[noreturn]] static void give_up(RTCError error) {
    if (error == RTC_ERROR_UNSUPPORTED_CPU) throw std::runtime_error("Embree does not know this processor");
    throw std::bad_alloc();
  }

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

/// A device that is told a number of threads ("threads=1") holds the whole process to it as long as it lives. So it is
/// told none, and the tree is built in an arena of one thread: the same tree on any machine, and every thread for those
/// who ask.
SpatialIndex::SpatialIndex(const std::vector<Box>& boxes) : impl_(std::make_unique<Impl>()) {
  ++indices_built;
  impl_->boxes = boxes;
  Box all;
  for (const auto& b : boxes) {
    all.add(b.low);
    all.add(b.high);
  }
  if (!boxes.empty()) impl_->centre = 0.5 * (all.low + all.high);
  tbb::task_arena(1).execute([&] { impl_->build(); });
}

SpatialIndex::~SpatialIndex() = default;
SpatialIndex::SpatialIndex(SpatialIndex&&) noexcept = default;
SpatialIndex& SpatialIndex::operator=(SpatialIndex&&) noexcept = default;

void SpatialIndex::near(const Vec3& p, double radius, Visit visit, void* context) const {
  if (impl_->boxes.empty()) return;
  const Vec3 local = p - impl_->centre;
  RTCPointQuery query;
  query.x = float(local.x());
  query.y = float(local.y());
  query.z = float(local.z());
  query.time = 0;
  query.radius = float(radius + kBoxPad);
  RTCPointQueryContext stack;
  rtcInitPointQueryContext(&stack);
  Query q{visit, context};
  rtcPointQuery(impl_->scene, &query, &stack, on_candidate, &q);
}

std::size_t SpatialIndex::built() { return indices_built; }

}  // namespace toothpath::analytic
