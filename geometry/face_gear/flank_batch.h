// Many points of one flank at once: the closed form of geometry/face_gear/surface.h as a plain loop over arrays, which
// the compiler turns into vector code. Its sine and cosine are its own, because library calls would keep the loop
// scalar.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geometry/face_gear/surface.h"

namespace toothpath::face_gear {

/// Structure of arrays: positions [mm] and unit normals out of the material, gear frame.
struct FlankPoints {
  std::vector<double> x, y, z, nx, ny, nz;
  [[nodiscard]] std::size_t size() const { return x.size(); }
  void resize(std::size_t count);
};

/// `out` gets the points (theta[k], B[k]) of the flank of `side`; it is resized. theta and B have the same size, |B| <
/// 80 deg, all angles below 1e5 rad. Agrees with FaceGearSurface::flank to 4e-15 L_p (flank_batch_test). The same bytes
/// on every processor: vector widths differ, operations do not.
void evaluate_flank(const FaceGearSurface<double>& surface, int side, std::span<const double> theta,
                    std::span<const double> B, FlankPoints& out);

/// Sine and cosine of x[k], |x| <= 1e5; absolute error <= 4e-16 for |x| <= 100. The kernel of `evaluate_flank`, for its
/// test.
void sine_cosine(std::span<const double> x, std::span<double> sine, std::span<double> cosine);

}  // namespace toothpath::face_gear
