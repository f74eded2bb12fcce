// Names for the small fixed-size vectors, double or any other scalar.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace toothpath {

template <typename S>
using Vec2T = Eigen::Matrix<S, 2, 1>;
template <typename S>
using Vec3T = Eigen::Matrix<S, 3, 1>;
using Vec2 = Vec2T<double>;
using Vec3 = Vec3T<double>;
using Mat3 = Eigen::Matrix3d;

}  // namespace toothpath
