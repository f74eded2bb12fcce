// A ball that rolls between a flank and the root surface: where it touches both, its centre, and the flank's normal
// there, over the parameter v of the flank. Kept as cubics, once continuous, which leave the true curve by less
// than rounding shows in any other place.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "geometry/flank_grid/meridian.h"
#include "geometry/flank_grid/tensor_spline.h"

namespace toothpath::flank_grid {

/// A flank and its normal, for any scalar: sign * dP/du x dP/dv.
struct Flank {
  TensorSpline spline;
  double sign = 1;
  /// Place and normal; `normal`: null where it is not asked for.
  template <typename S>
  void at(const S& u, const S& v, Vec3T<S>& p, Vec3T<S>* normal) const {
    using std::sqrt;
    const auto f = spline.partials(base_of(u), base_of(v), kDepth<S> + (normal ? 1 : 0));
    p = lifted(f, u, v, 0, 0);
    if (!normal) return;
    const Vec3T<S> a = lifted(f, u, v, 1, 0), b = lifted(f, u, v, 0, 1);
    const Vec3T<S> n = a.cross(b);
    *normal = n * S(S(sign) / sqrt(S(n.squaredNorm())));
  }
};

class RolledBall {
 public:
  RolledBall() = default;
  /// As far as the ball finds both surfaces between two places of v; nothing where it does not at `middle`.
  static std::optional<RolledBall> roll(const Flank& flank, const Meridian& root, double radius_mm, double v_from,
                                        double middle, double v_to);
  /// u of the flank where the ball touches it at v: the first such place on the way down from the last row; nothing
  /// where there is none down to half a height below the first one.
  [[nodiscard]] static std::optional<double> contact(const Flank& flank, const Meridian& root, double radius_mm,
                                                     double v);

  [[nodiscard]] double from() const { return curve_.breaks().front(); }
  [[nodiscard]] double to() const { return curve_.breaks().back(); }

  /// u of the flank where the ball touches it.
  template <typename S>
  [[nodiscard]] S contact(const S& v) const {
    return number(v, kContact);
  }
  /// x of the root's meridian where it touches that.
  template <typename S>
  [[nodiscard]] S foot(const S& v) const {
    return number(v, kFoot);
  }
  template <typename S>
  void at(const S& v, Vec3T<S>& centre, Vec3T<S>& normal) const {
    const auto f = curve_.derivatives(base_of(v), kDepth<S>, kCentre, kNumbers);
    for (std::size_t k = 0; k < 3; ++k) {
      centre[int(k)] = lifted(f, v, 0, kCentre + k);
      normal[int(k)] = lifted(f, v, 0, kNormal + k);
    }
  }

 private:
  static constexpr std::size_t kFoot = 0, kContact = 1, kCentre = 2, kNormal = 5, kNumbers = 8;
  using Numbers = Eigen::Matrix<double, kNumbers, 1>;
  struct Sample {
    double v = 0;
    Numbers value = Numbers::Zero(), slope = Numbers::Zero();
  };
  static std::optional<Sample> sample(const Flank& flank, const Meridian& root, double radius_mm, double v,
                                      const Sample* near);
  bool add(const Flank& flank, const Meridian& root, double radius_mm, const Sample& a, const Sample& b, int halvings);

  template <typename S>
  [[nodiscard]] S number(const S& v, std::size_t k) const {
    return lifted(curve_.derivatives(base_of(v), kDepth<S>, k, k + 1), v, 0, k);
  }

  CubicCurve<kNumbers> curve_;
};

}  // namespace toothpath::flank_grid
