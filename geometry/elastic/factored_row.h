// A clamped row of equal sectors, factored once for all loads on the tooth in its middle.
//
// One sector is factored with its two cuts last; what remains of it at the cuts (its Schur complement) is chained from
// sector to sector. Unknowns of a sector: those inside, of its low cut, of its high cut. Derivation:
// docs/loaded_contact.md 4.
#pragma once

#include <Eigen/Cholesky>
#include <optional>
#include <vector>

#include "geometry/elastic/frontal_factor.h"
#include "geometry/elastic/sector.h"

namespace toothpath::elastic {

class FactoredRow {
 public:
  /// @param nu     Poisson's ratio; E is 1
  /// @param teeth  sectors of the row, odd, >= 3; its outer cuts and the back of the rim are clamped
  /// Refused: a stiffness that is not positive definite.
  [[nodiscard]] static Result<FactoredRow> make(const Sector& sector, double nu, int teeth);

  /// Neighbours on either side that can be read.
  [[nodiscard]] int reach() const { return reach_; }

  /// Columns of loads (or of what reads displacements) driven through the inside; what arrives at the cuts.
  struct Forward {
    Eigen::MatrixXd inside, cuts;
  };
  /// @param at_nodes  3 rows a node of the sector, in its frame; none on its cuts
  [[nodiscard]] Forward forward(const Eigen::MatrixXd& at_nodes) const;
  /// Motions of all free cuts of the row. @param pushed  what arrives at the cuts of the middle sector
  [[nodiscard]] Eigen::MatrixXd motions(const Eigen::MatrixXd& pushed) const;
  /// Those of the two cuts of the sector `offset` pitches on from the middle one, in its frame and in the next one's.
  [[nodiscard]] Eigen::MatrixXd cuts_of(const Eigen::MatrixXd& motions, int offset) const;
  /// Displacements of all nodes of a sector in its own frame, 3 rows a node.
  /// @param inside  of `forward` for the loaded sector; null: its inside is not loaded
  [[nodiscard]] Eigen::MatrixXd nodes_of(const Eigen::MatrixXd& at_cuts, const Eigen::MatrixXd* inside) const;

 private:
  FactoredRow() = default;
  std::vector<int> first_;  ///< unknown of a node, -1: held
  std::vector<int> high_cut_;
  Mat3 pitch_ = Mat3::Identity();
  int inside_ = 0, cut_ = 0, teeth_ = 0, reach_ = 0;
  std::optional<FrontalFactor> sector_;
  Eigen::LLT<Eigen::MatrixXd> chain_;
};

}  // namespace toothpath::elastic
