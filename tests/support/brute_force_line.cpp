#include "tests/support/brute_force_line.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace toothpath::test {
namespace {

BrutePose blend(const BrutePose& a, const BrutePose& b, double w) {
  return {(1 - w) * a.tip + w * b.tip, ((1 - w) * a.axis + w * b.axis).normalized()};
}

}  // namespace

std::vector<Vec3> swept_flank(const BruteForceFaceGear& brute, double r_from, double r_to,
                              const std::function<double(double)>& z_low, const std::function<double(double)>& z_high,
                              const std::function<double(double, double)>& azimuth, int columns, int rows) {
  std::vector<Vec3> out;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const double r = r_from + (r_to - r_from) * i / (columns - 1), low = z_low(r),
                   z = low + (z_high(r) - low) * j / (rows - 1);
      const auto residual = [&](double a) { return brute.least_clearance({r * std::cos(a), r * std::sin(a), z}); };
      double a = azimuth(r, z) - 1e-4, b = a + 2e-4, fa = residual(a), fb = residual(b);
      for (int k = 0; k < 30 && std::abs(fb) > 1e-11 && fb != fa;
           ++k) {  // the clearance is nearly linear in the azimuth: secants arrive at once
        const double next = b - fb * (b - a) / (fb - fa);
        a = b, fa = fb, b = next, fb = residual(b);
      }
      if (!(std::abs(fb) < 1e-10)) throw std::runtime_error("no swept surface near this place");
      out.emplace_back(r * std::cos(b), r * std::sin(b), z);
    }
  return out;
}

double BruteConicalMill::distance(const Vec3& q, const BrutePose& pose) const {
  const Vec3 from_centre = q - (pose.tip + r_0 * pose.axis);
  const double h = from_centre.dot(pose.axis), off = (from_centre - h * pose.axis).norm();
  // |q - c(t)| - rho(t) is convex in t; it is least where its slope vanishes, at t = h + off tan(tau), or at the lowest
  // t there is.
  const auto least = [&](double lowest, double extra) {
    const double t = std::max(lowest, h + off * std::tan(half_angle));
    return std::hypot(h - t, off) - r_0 - t * std::sin(half_angle) - extra;
  };
  return thicker > 0 ? std::min(least(0, 0), least(thicker_from, thicker)) : least(0, 0);
}

double least_distance(const Vec3& q, const BruteConicalMill& mill, const std::vector<BrutePose>& way) {
  std::vector<double> at(way.size());
  for (std::size_t k = 0; k < way.size(); ++k) at[k] = mill.distance(q, way[k]);
  double best = *std::min_element(at.begin(), at.end());
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  for (std::size_t k = 0; k + 1 < way.size(); ++k) {
    // A block matters only if its ends are near the best so far: distances change no faster than the tool moves.
    const double moves = (way[k + 1].tip - way[k].tip).norm() + 20 * mill.r_0 * (way[k + 1].axis - way[k].axis).norm();
    if (std::min(at[k], at[k + 1]) - moves > best) continue;
    double a = 0, b = 1, p = 1 - golden, r = golden;
    const auto f = [&](double w) { return mill.distance(q, blend(way[k], way[k + 1], w)); };
    double fp = f(p), fr = f(r);
    for (int n = 0; n < 32; ++n) {
      if (fp < fr) b = r, r = p, fr = fp, p = b - golden * (b - a), fp = f(p);
      else a = p, p = r, fp = fr, r = a + golden * (b - a), fr = f(r);
    }
    best = std::min({best, fp, fr});
  }
  return best;
}

BruteSwept swept(const std::vector<Vec3>& points, const BruteConicalMill& mill, const std::vector<BrutePose>& way) {
  BruteSwept out;
  for (const Vec3& q : points) {
    const double d = least_distance(q, mill, way);
    if (d > out.left) {
      out.left = d;
      out.left_at = q;
    }
    if (-d > out.gouge) {
      out.gouge = -d;
      out.gouge_at = q;
    }
  }
  return out;
}

}  // namespace toothpath::test
