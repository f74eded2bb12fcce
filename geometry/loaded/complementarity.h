// Load sharing among places that can only press: which of them touch, with which forces, and how far the bodies move.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath::loaded {

/// C f + gap - A q >= 0, f >= 0, f.(C f + gap - A q) = 0, A^T f + K q = load. Lengths mm, forces N.
struct ContactProblem {
  Eigen::MatrixXd compliance;  ///< C, n x n, symmetric, positive definite
  Eigen::VectorXd gap;         ///< of the unloaded bodies
  Eigen::MatrixXd approach;    ///< A, n x m: by which place i nears when motion j is 1
  Eigen::MatrixXd support;     ///< K, m x m: springs against the motions; 0: free
  Eigen::VectorXd load;        ///< against the motions
};

struct ContactForces {
  Eigen::VectorXd force;   ///< of every place
  Eigen::VectorXd motion;  ///< q
  Eigen::MatrixXd yield;   ///< dq/dload with the places that touch held
  int rounds = 0;
};

/// Active sets: what would pull is let go, then the place that would overlap most is added.
/// @param start  the places to begin with, e.g. those of the last position; empty: all
/// Refused: C not positive definite; a load that no pressing forces balance; no end within 20 n + 100 rounds.
[[nodiscard]] Result<ContactForces> share_load(const ContactProblem& problem, const std::vector<int>& start = {});

}  // namespace toothpath::loaded
