// The library that app/fit/least_squares.cpp opens: the only file that knows Ceres.
#include <ceres/cost_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <glog/logging.h>

#include <cstddef>

#include "app/fit/least_squares.h"

namespace {

using toothpath::fit::LeastSquares;

class Cost final : public ceres::CostFunction {
 public:
  explicit Cost(const LeastSquares& problem) : problem_(problem) {
    set_num_residuals(problem.residuals);
    mutable_parameter_block_sizes()->push_back(problem.parameters);
  }
  bool Evaluate(const double* const* x, double* residuals, double** jacobians) const override {
    return problem_.evaluate(problem_.who, x[0], residuals, jacobians != nullptr ? jacobians[0] : nullptr);
  }

 private:
  const LeastSquares& problem_;
};

}  // namespace

extern "C" __attribute__((visibility("default"))) void toothpath_minimise(LeastSquares* problem) {
  FLAGS_minloglevel = google::GLOG_FATAL;  // a step that cannot be evaluated is no news: the next one is shorter
  ceres::Problem least;
  least.AddResidualBlock(new Cost(*problem), nullptr, problem->x);
  for (int k = 0; k < problem->parameters; ++k) {
    least.SetParameterLowerBound(problem->x, k, problem->low[k]);
    least.SetParameterUpperBound(problem->x, k, problem->high[k]);
  }
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = problem->most_steps;
  options.function_tolerance = 1e-13;
  options.gradient_tolerance = 1e-18;
  options.parameter_tolerance = 1e-12;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &least, &summary);
  problem->settled = summary.termination_type == ceres::CONVERGENCE;
  problem->steps = static_cast<int>(summary.iterations.size());
}
