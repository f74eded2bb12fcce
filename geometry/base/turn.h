// A turn about the z axis, the axis of every gear, for any scalar.
#pragma once

#include <cmath>
#include <type_traits>

#include "geometry/base/vec.h"

namespace toothpath {

/// By an angle [rad]: its cosine and sine, for what is turned by it more than once.
template <typename S>
struct TurnT {
  S c{}, s{};
  explicit TurnT(const S& angle) {
    using std::cos, std::sin;
    c = cos(angle);
    s = sin(angle);
  }
  [[nodiscard]] Vec3T<S> operator()(const Vec3T<S>& v) const {
    return {S(c * v[0] - s * v[1]), S(s * v[0] + c * v[1]), v[2]};
  }
  [[nodiscard]] Vec3T<S> back(const Vec3T<S>& v) const {
    return {S(c * v[0] + s * v[1]), S(c * v[1] - s * v[0]), v[2]};
  }
};
using Turn = TurnT<double>;

/// p turned about the z axis; of doubles: vec.h.
template <typename S>
[[nodiscard]] Vec3T<S> turned(const Vec3T<S>& p, const std::type_identity_t<S>& angle) {
  return TurnT<S>(angle)(p);
}

}  // namespace toothpath
