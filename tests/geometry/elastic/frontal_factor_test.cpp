// The factor by fronts against dense algebra.
#include "geometry/elastic/frontal_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <numeric>

#include "tests/support/random.h"

namespace toothpath::test {
namespace {

/// The lower half of a positive definite matrix with some entries a column.
Eigen::SparseMatrix<double> sparse(Random& random, int size) {
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(size, size);
  for (int column = 0; column < size; ++column)
    for (int n = 0; n < 3; ++n) {
      const int row = std::min(size - 1, int(random(0, size)));
      if (row > column) K(row, column) = random(-1, 1);
    }
  for (int k = 0; k < size; ++k) K(k, k) = 1 + K.row(k).cwiseAbs().sum() + K.col(k).cwiseAbs().sum();
  return K.sparseView();
}

TEST(FrontalFactor, SolvesWhatDenseAlgebraSolves) {
  Random random(41);
  int alone = 0;
  for (const std::vector<int>& parts :
       std::vector<std::vector<int>>{{7}, {1, 1, 1, 1}, {4, 9, 1, 6, 3, 12, 5}, {20, 2, 2}}) {
    const int inside = std::accumulate(parts.begin(), parts.end(), 0), size = inside + 5;
    const Eigen::SparseMatrix<double> lower = sparse(random, size);
    const Eigen::MatrixXd K = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    const auto factor = elastic::FrontalFactor::make(lower, parts);
    ASSERT_TRUE(factor.has_value());
    const Eigen::MatrixXd A = K.topLeftCorner(inside, inside), B = K.bottomLeftCorner(5, inside);
    const Eigen::MatrixXd rest = K.bottomRightCorner(5, 5) - B * A.llt().solve(B.transpose());
    EXPECT_LT((factor->rest() - rest).cwiseAbs().maxCoeff(), 1e-12);
    // All of K: down, the rest, up again. Some rows are not loaded.
    Eigen::MatrixXd loads = Eigen::MatrixXd::NullaryExpr(size, 4, [&] { return random(-1, 1); });
    loads.topRows(inside / 2).setZero();
    Eigen::MatrixXd x = loads;
    factor->forward(x);
    alone += x.topRows(inside / 2).isZero(0);
    x.bottomRows(5) = factor->rest().llt().solve(Eigen::MatrixXd(x.bottomRows(5)));
    factor->backward(x);
    EXPECT_LT((K * x - loads).cwiseAbs().maxCoeff(), 1e-12);
  }
  EXPECT_EQ(alone, 4) << "what no load reaches stays 0";
}

TEST(FrontalFactor, RefusesWhatIsNotPositiveDefinite) {
  Random random(42);
  Eigen::SparseMatrix<double> K = sparse(random, 20);
  K.coeffRef(9, 9) = -1;
  EXPECT_FALSE(elastic::FrontalFactor::make(K, {6, 8, 2}).has_value());
}

}  // namespace
}  // namespace toothpath::test
