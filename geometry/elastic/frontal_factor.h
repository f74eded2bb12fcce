// Cholesky factor of a sparse symmetric matrix whose unknowns are ordered by dissection. Unknowns are eliminated a part
// at a time, each in one dense matrix with all that it touches (fronts; Duff and Reid 1983): dense products run several
// times as fast as columns one by one, and many loads are driven through them at once.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <optional>
#include <vector>

namespace toothpath::elastic {

/// The leading unknowns of K are eliminated; `rest` is what remains of K on those behind them (its Schur complement).
class FrontalFactor {
 public:
  /// @param K      its lower half
  /// @param parts  how many unknowns each part has, in their order
  /// Nothing: K is not positive definite.
  [[nodiscard]] static std::optional<FrontalFactor> make(const Eigen::SparseMatrix<double>& K,
                                                         const std::vector<int>& parts);

  [[nodiscard]] const Eigen::MatrixXd& rest() const { return rest_; }
  /// Columns of loads: the leading rows become L^-1 of them, the rows behind lose what these drive there.
  void forward(Eigen::MatrixXd& columns) const;
  /// The leading rows, as `forward` leaves them, become what K asks for, given the rows behind.
  void backward(Eigen::MatrixXd& columns) const;

 private:
  struct Front {
    Eigen::Index first = 0, size = 0;
    std::vector<int> behind;  ///< rows that the part touches, in order
    Eigen::MatrixXd L;        ///< of the part's own rows, then of those behind
  };
  FrontalFactor() = default;
  std::vector<Front> fronts_;
  Eigen::MatrixXd rest_;
};

}  // namespace toothpath::elastic
