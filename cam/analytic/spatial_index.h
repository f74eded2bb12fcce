// Which boxes can be near a point: Embree (float32) finds candidates, the caller decides in double.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "geometry/base/vec.h"

namespace toothpath::analytic {

struct Box {
  Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
};

/// A static set of boxes. Boxes are padded for the rounding to float32, so that no candidate is lost.
/// Queries may run from several threads at once.
class SpatialIndex {
 public:
  explicit SpatialIndex(const std::vector<Box>& boxes);
  ~SpatialIndex();
  SpatialIndex(SpatialIndex&&) noexcept;
  SpatialIndex& operator=(SpatialIndex&&) noexcept;

  /// Calls `visit(index)` for every box within `radius` of `p` (and perhaps a few more). `visit` returns the radius to
  /// go on with: smaller values shrink the search.
  using Visit = double (*)(void* context, std::size_t index, double radius);
  void near(const Vec3& p, double radius, Visit visit, void* context) const;

  template <typename F>
  void near(const Vec3& p, double radius, F&& visit) const {
    near(
        p, radius, [](void* context, std::size_t index, double r) { return (*static_cast<F*>(context))(index, r); },
        &visit);
  }

  /// How many indices have been built in this process: shows that a stage needed none.
  static std::size_t built();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace toothpath::analytic
