// A ball that rolls between a flank and the root surface: where it touches the flank, its centre, and the flank's
// normal there, over the parameter v of the flank. Kept as cubics, once continuous, which leave the true curve by less
// than rounding shows in any other place.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "geometry/flank_grid/lifted.h"
#include "geometry/flank_grid/tensor_spline.h"

namespace toothpath::flank_grid {

/// The meridian of a surface of revolution that is a cone, a cylinder or a plane.
struct Meridian {
  Vec2 start = Vec2::Zero();                           ///< (r, z)
  Vec2 along = Vec2::UnitX(), normal = Vec2::UnitY();  ///< of length 1; normal: out of the body
  template <typename S>
  [[nodiscard]] S height(const S& r, const S& z) const {
    return S(normal[0]) * (r - S(start[0])) + S(normal[1]) * (z - S(start[1]));
  }
  template <typename S>
  [[nodiscard]] S way(const S& r, const S& z) const {
    return S(along[0]) * (r - S(start[0])) + S(along[1]) * (z - S(start[1]));
  }
};

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

  [[nodiscard]] double from() const { return breaks_.front(); }
  [[nodiscard]] double to() const { return breaks_.back(); }

  /// u of the flank where the ball touches it.
  template <typename S>
  [[nodiscard]] S contact(const S& v) const {
    return lifted(derivatives(base_of(v), kDepth<S>, 0, 1), v, 0, 0);
  }
  template <typename S>
  void at(const S& v, Vec3T<S>& centre, Vec3T<S>& normal) const {
    const auto f = derivatives(base_of(v), kDepth<S>, 1, kNumbers);
    for (std::size_t k = 0; k < 3; ++k) {
      centre[int(k)] = lifted(f, v, 0, 1 + k);
      normal[int(k)] = lifted(f, v, 0, 4 + k);
    }
  }

 private:
  static constexpr std::size_t kNumbers = 7;  // contact, centre, normal
  using Numbers = Eigen::Matrix<double, kNumbers, 1>;
  struct Sample {
    double v = 0;
    Numbers value = Numbers::Zero(), slope = Numbers::Zero();
  };
  static std::optional<Sample> sample(const Flank& flank, const Meridian& root, double radius_mm, double v,
                                      const Sample* near);
  bool add(const Flank& flank, const Meridian& root, double radius_mm, const Sample& a, const Sample& b, int halvings);

  /// Of the numbers from one to before another.
  template <typename B>
  [[nodiscard]] CurveDerivatives<B, kNumbers> derivatives(const B& v, int order, std::size_t begin,
                                                          std::size_t end) const {
    CurveDerivatives<B, kNumbers> out;
    const auto piece = [&](double x) {
      const auto k = std::upper_bound(breaks_.begin(), breaks_.end(), x) - breaks_.begin();
      return std::size_t(std::clamp<std::ptrdiff_t>(k, 1, std::ptrdiff_t(breaks_.size()) - 1)) - 1;
    };
    const std::size_t first = piece(low_of(v)), last = piece(high_of(v));
    for (std::size_t i = first; i <= last; ++i) {
      const B x = within(v, i == first ? -INFINITY : breaks_[i], i == last ? INFINITY : breaks_[i + 1]) - B(breaks_[i]);
      for (std::size_t k = begin; k < end; ++k) {
        const auto& c = cubics_[i][k];
        for (int a = 0; a <= order; ++a) {
          const B y = cubic_derivative<B>({B(c[0]), B(c[1]), B(c[2]), B(c[3])}, x, a);
          if (i == first) out.d[std::size_t(a)][k] = y;
          else widen(out.d[std::size_t(a)][k], y);
        }
      }
    }
    return out;
  }

  std::vector<double> breaks_;
  std::vector<std::array<std::array<double, 4>, kNumbers>> cubics_;
};

}  // namespace toothpath::flank_grid
