#include "geometry/elastic/brick_stress.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace toothpath::elastic {
namespace {

constexpr double kGauss = 0.57735026918962576;  // 1/sqrt(3)

/// Corner k of the cube, -1 or 1 in each coordinate.
std::array<int, 3> corner(int k) { return {2 * (k & 1) - 1, (k & 2) - 1, (k & 4) / 2 - 1}; }

BrickNodes nodes_of(const Sector& s, const std::array<int, kBrickNodes>& brick) {
  BrickNodes x;
  for (int n = 0; n < kBrickNodes; ++n)
    x.col(n) = s.nodes[static_cast<std::size_t>(brick[static_cast<std::size_t>(n)])];
  return x;
}

}  // namespace

StressOfBrick brick_stress(const BrickNodes& nodes, double nu, double u, double v, double w) {
  const double mu = 1 / (2 * (1 + nu)), lambda = nu / ((1 + nu) * (1 - 2 * nu));
  const auto local = brick_gradients(u, v, w);
  const Mat3 map = nodes * local.transpose();
  const Eigen::Matrix<double, 3, kBrickNodes> g = map.inverse().transpose() * local;
  StressOfBrick S = StressOfBrick::Zero();
  for (int n = 0; n < kBrickNodes; ++n)
    for (int i = 0; i < 3; ++i) {
      const int column = 3 * n + i, next = (i + 1) % 3, last = (i + 2) % 3;
      for (int k = 0; k < 3; ++k) S(k, column) = lambda * g(i, n);
      S(i, column) += 2 * mu * g(i, n);
      S(3 + i, column) = mu * g(next, n);     // of i with the next
      S(3 + last, column) = mu * g(last, n);  // of the last with i
    }
  return S;
}

std::vector<StressOfBrick> nodal_stress(const BrickNodes& nodes, double nu) {
  std::array<StressOfBrick, 8> inner;
  for (int k = 0; k < 8; ++k) {
    const auto c = corner(k);
    inner[static_cast<std::size_t>(k)] = brick_stress(nodes, nu, kGauss * c[0], kGauss * c[1], kGauss * c[2]);
  }
  std::vector<StressOfBrick> out(kBrickNodes, StressOfBrick::Zero());
  for (std::size_t n = 0; n < kBrickNodes; ++n)
    for (int k = 0; k < 8; ++k) {
      double weight = 1;
      for (std::size_t d = 0; d < 3; ++d) weight *= (1 + brick_places()[n][d] * corner(k)[d] / kGauss) / 2;
      out[n] += weight * inner[static_cast<std::size_t>(k)];
    }
  return out;
}

double largest_principal(const Stress& s) {
  Mat3 m;
  m << s(0), s(3), s(5), s(3), s(1), s(4), s(5), s(4), s(2);
  return Eigen::SelfAdjointEigenSolver<Mat3>(m, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

std::vector<int> fillet_nodes(const Sector& s) {
  const auto& end = s.lattice[static_cast<std::size_t>(s.stations.back())];
  std::vector<int> out;
  for (std::size_t n = 0; n < s.lattice.size(); ++n)
    if (s.lattice[n][0] == end[0] && s.lattice[n][1] < end[1] && s.lattice[n][1] > s.foot)
      out.push_back(static_cast<int>(n));
  return out;
}

HatStress hat_stress(const Sector& s, double nu, const ToothFields& fields, const std::vector<int>& nodes) {
  std::vector<int> row(s.nodes.size(), -1), meet(s.nodes.size(), 0);
  for (std::size_t k = 0; k < nodes.size(); ++k) row[static_cast<std::size_t>(nodes[k])] = static_cast<int>(6 * k);
  const auto wanted = [&](int n) { return row[static_cast<std::size_t>(n)] >= 0; };
  for (const auto& brick : s.bricks)
    for (const int n : brick) ++meet[static_cast<std::size_t>(n)];
  HatStress out;
  out.reach = fields.reach;
  for (const auto& u : fields.at_offset)
    out.at_offset.push_back(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(6 * nodes.size()), u.cols()));
  for (const auto& brick : s.bricks) {
    if (std::none_of(brick.begin(), brick.end(), wanted)) continue;
    const auto stress = nodal_stress(nodes_of(s, brick), nu);
    for (std::size_t o = 0; o < fields.at_offset.size(); ++o) {
      Eigen::MatrixXd u(3 * kBrickNodes, fields.at_offset[o].cols());
      for (std::size_t n = 0; n < kBrickNodes; ++n)
        u.middleRows<3>(static_cast<Eigen::Index>(3 * n)) = fields.at_offset[o].middleRows<3>(3 * brick[n]);
      for (std::size_t n = 0; n < kBrickNodes; ++n)
        if (wanted(brick[n]))
          out.at_offset[o].middleRows<6>(row[static_cast<std::size_t>(brick[n])]) +=
              stress[n] * u / meet[static_cast<std::size_t>(brick[n])];
    }
  }
  return out;
}

}  // namespace toothpath::elastic
