// The 20-node brick: shape functions, stiffness, pressure on a face. Small displacements, isotropic.
//
// Nodes in the order of CalculiX (C3D20): corners of the face w = -1, those of w = +1, then the middles of the edges of
// w = -1, of w = +1, and of the edges between them. All compliances are for E = 1; those of a material are 1/E of them.
#pragma once

#include <Eigen/Core>
#include <array>

#include "geometry/base/vec.h"

namespace toothpath::elastic {

inline constexpr int kBrickNodes = 20, kFaceNodes = 8;

using BrickNodes = Eigen::Matrix<double, 3, kBrickNodes>;
using BrickMatrix = Eigen::Matrix<double, 3 * kBrickNodes, 3 * kBrickNodes>;

/// Corner and mid-edge places in (u, v, w), each -1, 0 or 1.
[[nodiscard]] const std::array<std::array<int, 3>, kBrickNodes>& brick_places();

/// d(shape of every node)/d(u, v, w) at a place.
[[nodiscard]] Eigen::Matrix<double, 3, kBrickNodes> brick_gradients(double u, double v, double w);

/// Stiffness of one brick for E = 1.
/// @param nu                  Poisson's ratio, 0 to 0.49
/// @param[out] least_jacobian smallest determinant of the map at the 27 Gauss points, mm^3; <= 0: the brick is folded
[[nodiscard]] BrickMatrix brick_stiffness(const BrickNodes& nodes, double nu, double& least_jacobian);

/// A face of eight nodes: corners in order, then the middles between corner n and n + 1.
using FaceNodes = Eigen::Matrix<double, 3, kFaceNodes>;

/// A place of a face at (a, b) in [-1, 1]^2.
struct FacePlace {
  Eigen::Matrix<double, kFaceNodes, 1> shape;  ///< weights of the nodes
  std::array<double, 4> hat{};                 ///< bilinear weights of the corners
  Vec3 point = Vec3::Zero();
  Vec3 area = Vec3::Zero();  ///< dP/da x dP/db
};
[[nodiscard]] FacePlace face_place(const FaceNodes& nodes, double a, double b);

/// Gauss points and weights on [-1, 1]; n = 2, 3, 4 or 6.
struct GaussRule {
  std::array<double, 6> x{}, weight{};
  int n = 0;
};
[[nodiscard]] const GaussRule& gauss_rule(int n);

}  // namespace toothpath::elastic
