// Bricks, sectors and rows of them: against beams, against the whole row, rigid motions.
#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>

#include "geometry/elastic/tooth_compliance.h"
#include "tests/geometry/elastic/plain_sector.h"

namespace toothpath::test {
namespace {

using Sparse = Eigen::SparseMatrix<double>;

/// The whole stiffness, with the held unknowns fixed.
Sparse assemble(const std::vector<Vec3>& nodes, const std::vector<std::array<int, elastic::kBrickNodes>>& bricks,
                const std::vector<int>& held, double nu) {
  std::vector<char> fixed(nodes.size(), 0);
  for (const int n : held) fixed[static_cast<std::size_t>(n)] = 1;
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& brick : bricks) {
    elastic::BrickNodes x;
    for (int n = 0; n < elastic::kBrickNodes; ++n)
      x.col(n) = nodes[static_cast<std::size_t>(brick[static_cast<std::size_t>(n)])];
    double jacobian = 0;
    const auto K = elastic::brick_stiffness(x, nu, jacobian);
    EXPECT_GT(jacobian, 0);
    for (int m = 0; m < elastic::kBrickNodes; ++m)
      for (int n = 0; n < elastic::kBrickNodes; ++n) {
        const int a = brick[static_cast<std::size_t>(m)], b = brick[static_cast<std::size_t>(n)];
        if (fixed[static_cast<std::size_t>(a)] != 0 || fixed[static_cast<std::size_t>(b)] != 0) continue;
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) entries.emplace_back(3 * a + i, 3 * b + j, K(3 * m + i, 3 * n + j));
      }
  }
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (fixed[n] != 0)
      for (int i = 0; i < 3; ++i) entries.emplace_back(3 * int(n) + i, 3 * int(n) + i, 1.0);
  const auto size = static_cast<Eigen::Index>(3 * nodes.size());
  Sparse K(size, size);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

/// A bar of bricks; x along, y across, z up.
struct Bar {
  std::vector<Vec3> nodes;
  std::vector<std::array<int, elastic::kBrickNodes>> bricks;
  std::vector<int> held, end;
  std::vector<std::array<int, 8>> end_faces;
};
Bar bar_of(const Vec3& size, int nx, int ny, int nz) {
  Bar bar;
  std::vector<int> ids(static_cast<std::size_t>((2 * nx + 1) * (2 * ny + 1) * (2 * nz + 1)), -1);
  const auto id = [&](int u, int v, int w) -> int& {
    return ids[static_cast<std::size_t>((w * (2 * ny + 1) + v) * (2 * nx + 1) + u)];
  };
  for (int w = 0; w <= 2 * nz; ++w)
    for (int v = 0; v <= 2 * ny; ++v)
      for (int u = 0; u <= 2 * nx; ++u) {
        if ((u & 1) + (v & 1) + (w & 1) > 1) continue;
        id(u, v, w) = static_cast<int>(bar.nodes.size());
        bar.nodes.emplace_back(size.x() * u / (2 * nx), size.y() * v / (2 * ny), size.z() * w / (2 * nz));
        if (u == 0) bar.held.push_back(id(u, v, w));
        if (u == 2 * nx) bar.end.push_back(id(u, v, w));
      }
  for (int w = 1; w < 2 * nz; w += 2)
    for (int v = 1; v < 2 * ny; v += 2) {
      for (int u = 1; u < 2 * nx; u += 2) {
        std::array<int, elastic::kBrickNodes> brick{};
        for (std::size_t n = 0; n < elastic::kBrickNodes; ++n) {
          const auto& p = elastic::brick_places()[n];
          brick[n] = id(u + p[0], v + p[1], w + p[2]);
        }
        bar.bricks.push_back(brick);
      }
      const int u = 2 * nx;
      bar.end_faces.push_back({id(u, v - 1, w - 1), id(u, v + 1, w - 1), id(u, v + 1, w + 1), id(u, v - 1, w + 1),
                               id(u, v, w - 1), id(u, v + 1, w), id(u, v, w + 1), id(u, v - 1, w)});
    }
  return bar;
}

double cantilever(int nx, int ny, int nz) {
  const Bar bar = bar_of({50, 4, 5}, nx, ny, nz);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * bar.nodes.size()));
  const auto& rule = elastic::gauss_rule(3);
  for (const auto& face : bar.end_faces) {
    elastic::FaceNodes x;
    for (int n = 0; n < 8; ++n) x.col(n) = bar.nodes[static_cast<std::size_t>(face[static_cast<std::size_t>(n)])];
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) {
        const auto place = elastic::face_place(x, rule.x[i], rule.x[j]);
        for (int n = 0; n < 8; ++n)
          f(3 * face[static_cast<std::size_t>(n)] + 2) +=
              place.shape(n) * place.area.norm() * rule.weight[i] * rule.weight[j] * 100 / 20;
      }
  }
  EXPECT_NEAR(f.sum(), 100, 1e-10);
  Eigen::SimplicialLLT<Sparse> solver(assemble(bar.nodes, bar.bricks, bar.held, 0.3));
  const Eigen::VectorXd u = solver.solve(f) / 210000;
  double mean = 0;
  for (const int n : bar.end) mean += u(3 * n + 2) / static_cast<double>(bar.end.size());
  return mean;
}

TEST(Brick, CantileverOfTheWorkedValues) {
  EXPECT_NEAR(cantilever(4, 1, 1), 0.458262, 2e-5);
  EXPECT_NEAR(cantilever(8, 2, 2), 0.471774, 2e-5);
  EXPECT_NEAR(cantilever(16, 2, 3), 0.475172, 2e-5);
}

TEST(Brick, RigidMotionsStoreNoEnergy) {
  elastic::BrickNodes x;
  for (int n = 0; n < elastic::kBrickNodes; ++n) {
    const auto& p = elastic::brick_places()[static_cast<std::size_t>(n)];
    x.col(n) = Vec3(p[0] + 0.2 * p[1] * p[2], 2 * p[1] + 0.1 * p[0] * p[0], 1.5 * p[2] + 0.15 * p[0] * p[1]);
  }
  double jacobian = 0;
  const auto K = elastic::brick_stiffness(x, 0.3, jacobian);
  EXPECT_GT(jacobian, 0);
  for (int mode = 0; mode < 6; ++mode) {
    Eigen::Matrix<double, 60, 1> u;
    for (int n = 0; n < elastic::kBrickNodes; ++n)
      u.segment<3>(3 * n) = mode < 3 ? Vec3::Unit(mode) : Vec3(Vec3::Unit(mode - 3).cross(x.col(n)));
    EXPECT_LT(std::abs(u.dot(K * u)), 1e-10 * K.diagonal().maxCoeff());
  }
  EXPECT_LT((K - K.transpose()).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
}

TEST(ToothCompliance, ChainedSectorsAreTheWholeRow) {
  elastic::SectorPlan plan;
  plan.across = 2, plan.flank = 2, plan.fillet = 1, plan.face = 2, plan.rim = 2, plan.rim_mm = 6;
  for (const bool high : {false, true}) {
    const elastic::Sector sector = plain_sector(plan, high);
    const int teeth = 5, middle = 2;
    const auto chained = elastic::tooth_compliance(sector, 0.3, teeth);
    ASSERT_TRUE(chained);
    const elastic::SectorRow row = elastic::sector_row(sector, teeth);
    Eigen::SimplicialLLT<Sparse> solver(assemble(row.nodes, row.bricks, row.held, 0.3));
    const Eigen::MatrixXd loads = elastic::hat_loads(sector);
    Mat3 turn[5];
    turn[0].setIdentity();
    for (int t = 1; t < teeth; ++t) turn[t] = sector.pitch * turn[t - 1];
    double worst = 0, largest = 0;
    for (Eigen::Index k = 0; k < loads.cols(); ++k) {
      Eigen::VectorXd f = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * row.nodes.size()));
      for (std::size_t n = 0; n < sector.nodes.size(); ++n)
        f.segment<3>(3 * row.node_of[middle][n]) +=
            turn[middle] * loads.block<3, 1>(static_cast<Eigen::Index>(3 * n), k);
      const Eigen::VectorXd u = solver.solve(f);
      for (int o = -2; o <= 2; ++o)
        for (std::size_t i = 0; i < sector.stations.size(); ++i) {
          const int node =
              row.node_of[static_cast<std::size_t>(middle + o)][static_cast<std::size_t>(sector.stations[i])];
          const double direct = -(turn[middle + o] * sector.normals[i]).dot(u.segment<3>(3 * node));
          const double value = chained->at_offset[static_cast<std::size_t>(o + 2)](static_cast<Eigen::Index>(i), k);
          worst = std::max(worst, std::abs(direct - value));
          largest = std::max(largest, std::abs(direct));
        }
    }
    EXPECT_LT(worst, 1e-11 * largest);
    EXPECT_GT(largest, 0);
    EXPECT_GT(chained->at_offset[2].diagonal().minCoeff(), 0);
  }
}

TEST(ToothCompliance, HatsAddUpToTheFlank) {
  const elastic::Sector sector = plain_sector({}, true);
  double area = 0;
  for (const double a : elastic::hat_areas(sector)) area += a;
  EXPECT_GT(area, 0);
  const Eigen::MatrixXd loads = elastic::hat_loads(sector);
  for (Eigen::Index k = 0; k < loads.cols(); ++k) {
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index n = 0; n < loads.rows() / 3; ++n) sum += loads.block<3, 1>(3 * n, k);
    EXPECT_NEAR(sum.norm(), 1, 0.02) << "a hat presses with force 1, but for the turn of the normals under it";
    EXPECT_LT(sum.dot(sector.normals[static_cast<std::size_t>(k)]), -0.97);
  }
}

}  // namespace
}  // namespace toothpath::test
