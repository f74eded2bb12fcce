#include "geometry/elastic/brick.h"

#include <algorithm>
#include <cassert>

namespace toothpath::elastic {
namespace {

using ShapeGradients = Eigen::Matrix<double, 3, kBrickNodes>;

GaussRule rule_of(int n) {
  GaussRule r;
  r.n = n;
  if (n == 2) r.x = {-0.57735026918962576, 0.57735026918962576}, r.weight = {1, 1};
  else if (n == 3) r.x = {-0.77459666924148338, 0, 0.77459666924148338}, r.weight = {5. / 9, 8. / 9, 5. / 9};
  else if (n == 4)
    r.x = {-0.86113631159405258, -0.33998104358485626, 0.33998104358485626, 0.86113631159405258},
    r.weight = {0.34785484513745386, 0.65214515486254614, 0.65214515486254614, 0.34785484513745386};
  else
    r.x = {-0.93246951420315203, -0.66120938646626451, -0.23861918608319691,
           0.23861918608319691,  0.66120938646626451,  0.93246951420315203},
    r.weight = {0.17132449237917035, 0.36076157304813861, 0.46791393457269105,
                0.46791393457269105, 0.36076157304813861, 0.17132449237917035};
  return r;
}

}  // namespace

const std::array<std::array<int, 3>, kBrickNodes>& brick_places() {
  static const std::array<std::array<int, 3>, kBrickNodes> places = {
      {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1},
       {-1, 1, 1},   {0, -1, -1}, {1, 0, -1},  {0, 1, -1},  {-1, 0, -1}, {0, -1, 1}, {1, 0, 1},
       {0, 1, 1},    {-1, 0, 1},  {-1, -1, 0}, {1, -1, 0},  {1, 1, 0},   {-1, 1, 0}}};
  return places;
}

const GaussRule& gauss_rule(int n) {
  assert(n == 2 || n == 3 || n == 4 || n == 6);
  static const GaussRule two = rule_of(2), three = rule_of(3), four = rule_of(4), six = rule_of(6);
  return n == 2 ? two : n == 3 ? three : n == 4 ? four : six;
}

ShapeGradients brick_gradients(double u, double v, double w) {
  ShapeGradients g;
  const double x[3] = {u, v, w};
  for (int n = 0; n < kBrickNodes; ++n) {
    const auto& p = brick_places()[static_cast<std::size_t>(n)];
    // One factor a coordinate: 1 + p x, or 1 - x^2 where the node lies in the middle.
    double f[3], df[3], sum = -2, dsum[3];
    bool corner = true;
    for (int k = 0; k < 3; ++k) {
      const int pk = p[static_cast<std::size_t>(k)];
      f[k] = pk == 0 ? 1 - x[k] * x[k] : 1 + pk * x[k];
      df[k] = pk == 0 ? -2 * x[k] : pk;
      sum += pk * x[k];
      dsum[k] = pk;
      corner &= pk != 0;
    }
    for (int k = 0; k < 3; ++k) {
      const double others = f[(k + 1) % 3] * f[(k + 2) % 3];
      g(k, n) = corner ? (df[k] * others * sum + f[0] * f[1] * f[2] * dsum[k]) / 8 : df[k] * others / 4;
    }
  }
  return g;
}

BrickMatrix brick_stiffness(const BrickNodes& nodes, double nu, double& least_jacobian) {
  const double mu = 1 / (2 * (1 + nu)), lambda = nu / ((1 + nu) * (1 - 2 * nu));
  const GaussRule& rule = gauss_rule(3);
  BrickMatrix K = BrickMatrix::Zero();
  least_jacobian = 1e300;
  for (int a = 0; a < 27; ++a) {
    const auto i = static_cast<std::size_t>(a % 3), j = static_cast<std::size_t>(a / 3 % 3),
               k = static_cast<std::size_t>(a / 9);
    const ShapeGradients local = brick_gradients(rule.x[i], rule.x[j], rule.x[k]);
    const Mat3 map = nodes * local.transpose();  // d(x)/d(u, v, w)
    const double det = map.determinant();
    least_jacobian = std::min(least_jacobian, det);
    if (!(det > 0)) continue;
    const double weight = rule.weight[i] * rule.weight[j] * rule.weight[k] * det;
    const ShapeGradients g = map.inverse().transpose() * local;
    for (int m = 0; m < kBrickNodes; ++m)
      for (int n = 0; n <= m; ++n) {
        const Vec3 gm = g.col(m), gn = g.col(n);
        Mat3 block = gm * gn.transpose() * (lambda * weight) + gn * gm.transpose() * (mu * weight);
        block.diagonal().array() += gm.dot(gn) * mu * weight;
        K.block<3, 3>(3 * m, 3 * n) += block;
      }
  }
  for (int m = 0; m < kBrickNodes; ++m)
    for (int n = 0; n < m; ++n) K.block<3, 3>(3 * n, 3 * m) = K.block<3, 3>(3 * m, 3 * n).transpose();
  return K;
}

FacePlace face_place(const FaceNodes& nodes, double a, double b) {
  static constexpr int corner_a[4] = {-1, 1, 1, -1}, corner_b[4] = {-1, -1, 1, 1};
  FacePlace place;
  Eigen::Matrix<double, kFaceNodes, 2> slope;
  for (int n = 0; n < 4; ++n) {
    const double fa = 1 + corner_a[n] * a, fb = 1 + corner_b[n] * b, sum = corner_a[n] * a + corner_b[n] * b - 1;
    place.hat[static_cast<std::size_t>(n)] = fa * fb / 4;
    place.shape(n) = fa * fb * sum / 4;
    slope(n, 0) = corner_a[n] * fb * (sum + fa) / 4;
    slope(n, 1) = corner_b[n] * fa * (sum + fb) / 4;
    const int pa = (corner_a[n] + corner_a[(n + 1) % 4]) / 2, pb = (corner_b[n] + corner_b[(n + 1) % 4]) / 2;
    if (pa == 0) {  // the middle of an edge along a
      place.shape(4 + n) = (1 - a * a) * (1 + pb * b) / 2;
      slope(4 + n, 0) = -a * (1 + pb * b);
      slope(4 + n, 1) = (1 - a * a) * pb / 2;
    } else {
      place.shape(4 + n) = (1 - b * b) * (1 + pa * a) / 2;
      slope(4 + n, 0) = (1 - b * b) * pa / 2;
      slope(4 + n, 1) = -b * (1 + pa * a);
    }
  }
  place.point = nodes * place.shape;
  const Vec3 along_a = nodes * slope.col(0), along_b = nodes * slope.col(1);
  place.area = along_a.cross(along_b);
  return place;
}

}  // namespace toothpath::elastic
