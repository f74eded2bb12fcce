// Stress in bricks: fields that are known, and the fields of a row behind its compliance.
#include "geometry/elastic/brick_stress.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/geometry/elastic/plain_sector.h"

namespace toothpath::test {
namespace {

/// Stress of the displacement gradient G (du_i/dx_j) for E = 1.
elastic::Stress stress_of(const Mat3& G, double nu) {
  const Mat3 e = (G + G.transpose()) / 2;
  const double mu = 1 / (2 * (1 + nu)), lambda = nu / ((1 + nu) * (1 - 2 * nu));
  const Mat3 s = 2 * mu * e + lambda * e.trace() * Mat3::Identity();
  elastic::Stress out;
  out << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0);
  return out;
}

TEST(BrickStress, IsExactForEvenStrainInABentBrick) {
  elastic::BrickNodes x;
  for (int n = 0; n < elastic::kBrickNodes; ++n) {
    const auto& p = elastic::brick_places()[static_cast<std::size_t>(n)];
    x.col(n) = Vec3(p[0] + 0.2 * p[1] * p[2], 2 * p[1] + 0.1 * p[0] * p[0], 1.5 * p[2] + 0.15 * p[0] * p[1]);
  }
  Mat3 G;
  G << 0.3, -0.7, 0.2, 0.5, 0.1, -0.4, 0.9, 0.6, -0.8;
  Eigen::Matrix<double, 60, 1> u;
  for (int n = 0; n < elastic::kBrickNodes; ++n) u.segment<3>(3 * n) = G * x.col(n) + Vec3(1, 2, 3);
  const elastic::Stress exact = stress_of(G, 0.3);
  for (const auto& S : elastic::nodal_stress(x, 0.3)) EXPECT_LT((S * u - exact).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(BrickStress, IsExactForBendingOfAStraightBrick) {
  // u = quadratic: strain and stress are linear, which the extrapolation from the Gauss points carries to the nodes.
  const Vec3 half(2, 0.7, 1.1);
  elastic::BrickNodes x;
  Eigen::Matrix<double, 60, 1> u;
  const auto gradient = [](const Vec3& p) {
    Mat3 G;
    G << p.y(), p.x() + 0.2 * p.z(), 0.2 * p.y(), -p.x(), 0.6 * p.y(), 0, p.z(), 0, p.x();
    return G;
  };
  for (int n = 0; n < elastic::kBrickNodes; ++n) {
    const auto& at = elastic::brick_places()[static_cast<std::size_t>(n)];
    const Vec3 p = half.cwiseProduct(Vec3(at[0], at[1], at[2]));
    x.col(n) = p;
    u.segment<3>(3 * n) =
        Vec3(p.x() * p.y() + 0.2 * p.y() * p.z(), -p.x() * p.x() / 2 + 0.3 * p.y() * p.y(), p.x() * p.z());
  }
  const auto S = elastic::nodal_stress(x, 0.28);
  for (std::size_t n = 0; n < elastic::kBrickNodes; ++n)
    EXPECT_LT((S[n] * u - stress_of(gradient(x.col(static_cast<Eigen::Index>(n))), 0.28)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(BrickStress, LargestPrincipalDoesNotTurn) {
  const Mat3 turn = Eigen::AngleAxisd(0.8, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const Mat3 s = turn * Vec3(-90, 20, 35).asDiagonal() * turn.transpose();
  elastic::Stress six;
  six << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0);
  EXPECT_NEAR(elastic::largest_principal(six), 35, 1e-12);
}

/// Displacements of all nodes, read at the stations, are the compliance; the cuts of neighbours meet.
TEST(ToothFields, AreWhatTheComplianceReads) {
  elastic::SectorPlan plan;
  plan.across = 2, plan.flank = 2, plan.fillet = 2, plan.face = 2, plan.rim = 2, plan.rim_mm = 6;
  for (const bool high : {false, true}) {
    const elastic::Sector s = plain_sector(plan, high);
    const auto C = elastic::tooth_compliance(s, 0.3, 5);
    const auto fields = elastic::tooth_fields(s, 0.3, 5);
    ASSERT_TRUE(C);
    ASSERT_TRUE(fields);
    ASSERT_EQ(fields->at_offset.size(), 5u);
    const double largest = C->at_offset[2].cwiseAbs().maxCoeff();
    for (std::size_t o = 0; o < 5; ++o) {
      const Eigen::MatrixXd& u = fields->at_offset[o];
      for (std::size_t i = 0; i < s.stations.size(); ++i)
        for (Eigen::Index k = 0; k < u.cols(); ++k)
          EXPECT_NEAR(-s.normals[i].dot(u.block<3, 1>(3 * s.stations[i], k)),
                      C->at_offset[o](static_cast<Eigen::Index>(i), k), 1e-11 * largest);
      if (o == 4) break;
      for (std::size_t n = 0; n < s.low_cut.size(); ++n)
        EXPECT_LT(
            (u.middleRows<3>(3 * s.high_cut[n]) - s.pitch * fields->at_offset[o + 1].middleRows<3>(3 * s.low_cut[n]))
                .cwiseAbs()
                .maxCoeff(),
            1e-11 * largest);
    }
    for (const int n : s.held) EXPECT_EQ(fields->at_offset[2].middleRows<3>(3 * n).cwiseAbs().maxCoeff(), 0);
  }
}

TEST(HatStress, FilletOfTheLoadedFlankIsPulled) {
  elastic::SectorPlan plan;
  plan.across = 2, plan.flank = 3, plan.fillet = 2, plan.face = 2, plan.rim = 2, plan.rim_mm = 6;
  const elastic::Sector s = plain_sector(plan, true);
  const auto nodes = elastic::fillet_nodes(s);
  EXPECT_EQ(nodes.size(), 11u) << "3 middles, 5 corners, 3 middles: two bricks without both ends";
  const auto fields = elastic::tooth_fields(s, 0.3, 5);
  ASSERT_TRUE(fields);
  const auto stress = elastic::hat_stress(s, 0.3, *fields, nodes);
  // Forces along the tip bend the tooth: the fillet under them is pulled, most of all along the tooth's height.
  const Eigen::MatrixXd& own = stress.at_offset[static_cast<std::size_t>(stress.reach)];
  const Eigen::VectorXd sum = own.leftCols(s.columns).rowwise().sum();
  const auto u_of = [&](int n) { return s.lattice[static_cast<std::size_t>(n)]; };
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const elastic::Stress here = sum.segment<6>(static_cast<Eigen::Index>(6 * n));
    const Vec3& p = s.nodes[static_cast<std::size_t>(nodes[n])];
    const Vec3 up = Vec3(p.x(), p.y(), 0).normalized();
    Mat3 m;
    m << here(0), here(3), here(5), here(3), here(1), here(4), here(5), here(4), here(2);
    EXPECT_GT(up.dot(m * up), 0.5 * elastic::largest_principal(here)) << u_of(nodes[n])[1];
    EXPECT_GT(elastic::largest_principal(here), 0);
  }
}

}  // namespace
}  // namespace toothpath::test
