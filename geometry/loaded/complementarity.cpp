#include "geometry/loaded/complementarity.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace toothpath::loaded {
namespace {

struct Trial {
  Eigen::VectorXd force, motion;
  Eigen::MatrixXd yield;
};

/// Forces and motions with these places in touch.
Result<Trial> solve_with(const ContactProblem& p, const std::vector<int>& active) {
  const auto n = static_cast<Eigen::Index>(active.size()), m = p.approach.cols();
  Eigen::MatrixXd C(n, n), A(n, m);
  Eigen::VectorXd g(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int a = active[static_cast<std::size_t>(i)];
    g(i) = p.gap(a);
    A.row(i) = p.approach.row(a);
    for (Eigen::Index j = 0; j < n; ++j) C(i, j) = p.compliance(a, active[static_cast<std::size_t>(j)]);
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(C);
  if (factor.info() != Eigen::Success)
    return fail("the compliance of the flanks is not positive definite: smallest eigenvalue {:.3g} of largest {:.3g}",
                Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(C, Eigen::EigenvaluesOnly).eigenvalues().minCoeff(),
                C.diagonal().maxCoeff());
  const Eigen::MatrixXd CA = factor.solve(A);
  const Eigen::VectorXd Cg = factor.solve(g);
  const Eigen::LDLT<Eigen::MatrixXd> outer(A.transpose() * CA + p.support);
  if (outer.info() != Eigen::Success || !(outer.vectorD().minCoeff() > 1e-14 * outer.vectorD().maxCoeff()))
    return fail("the places that touch do not hold the bodies");
  Trial t;
  t.motion = outer.solve(Eigen::VectorXd(p.load + A.transpose() * Cg));
  t.force = CA * t.motion - Cg;
  t.yield = outer.solve(Eigen::MatrixXd::Identity(m, m));
  return t;
}

}  // namespace

Result<ContactForces> share_load(const ContactProblem& p, const std::vector<int>& start) {
  const int n = static_cast<int>(p.gap.size());
  std::vector<int> active = start;
  if (active.empty())
    for (int i = 0; i < n; ++i) active.push_back(i);
  std::sort(active.begin(), active.end());
  ContactForces out;
  const int most = 20 * n + 100;
  int careful = 5 * n;
  for (out.rounds = 1; out.rounds <= most; ++out.rounds) {
    Result<Trial> trial = active.empty()
                              ? Result<Trial>(fail("the load separates the flanks: it asks for the other side"))
                              : solve_with(p, active);
    if (!trial) {
      // Too few are left: once more from all of them, one at a time.
      if (out.rounds > careful || static_cast<int>(active.size()) == n) return trial.error();
      careful = out.rounds;
      active.resize(static_cast<std::size_t>(n));
      std::iota(active.begin(), active.end(), 0);
      continue;
    }
    std::vector<int> keep;
    for (std::size_t k = 0; k < active.size(); ++k) {
      const bool drop = trial->force(static_cast<Eigen::Index>(k)) < 0;
      // In the careful part one place at a time, that of the lowest number.
      if (!drop || (out.rounds > careful && keep.size() < k)) keep.push_back(active[k]);
    }
    if (keep.size() < active.size()) {
      active = std::move(keep);
      continue;
    }
    out.force = Eigen::VectorXd::Zero(n);
    for (std::size_t k = 0; k < active.size(); ++k) out.force(active[k]) = trial->force(static_cast<Eigen::Index>(k));
    out.motion = trial->motion;
    out.yield = trial->yield;
    const Eigen::VectorXd gaps = p.compliance * out.force + p.gap - p.approach * out.motion;
    const double small = 1e-12 * std::max((p.approach * out.motion).cwiseAbs().maxCoeff(), p.gap.cwiseAbs().maxCoeff());
    int worst = -1;
    for (int i = 0; i < n; ++i) {
      if (out.force(i) > 0 || !(gaps(i) < -small)) continue;
      if (worst < 0 || (out.rounds <= careful && gaps(i) < gaps(worst))) worst = i;
    }
    if (worst < 0) return out;
    active.insert(std::lower_bound(active.begin(), active.end(), worst), worst);
  }
  return fail("the load does not settle on the flanks after {} rounds", most);
}

}  // namespace toothpath::loaded
