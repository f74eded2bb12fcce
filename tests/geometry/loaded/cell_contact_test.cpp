// Cells against the ellipse of Hertz, a flat punch, two bodies at once, and brute force over dense matrices.
#include "geometry/loaded/cell_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/loaded/complementarity.h"
#include "geometry/loaded/half_space.h"
#include "tests/geometry/loaded/hertz_ellipse.h"

namespace toothpath::test {
namespace {

using loaded::CellProblem, loaded::CellWindow;

/// Steel on steel.
const double kModulus = loaded::contact_modulus(210000.0, 0.3, 210000.0, 0.3),
             kCompliance = 2 * loaded::half_space_compliance(210000.0, 0.3);

/// A paraboloid x^2 k1/2 + y^2 k2/2 over windows of these half sides.
CellWindow paraboloid(double k1, double k2, double half_x, double half_y, int columns, int rows, double lift = 0) {
  CellWindow w{columns, rows, 2 * half_x / columns, 2 * half_y / rows, {}};
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double x = (c + 0.5) * w.dx - half_x, y = (r + 0.5) * w.dy - half_y;
      w.gap.push_back(lift + k1 * x * x / 2 + k2 * y * y / 2);
    }
  return w;
}
double most_of(const std::vector<double>& v) { return *std::max_element(v.begin(), v.end()); }

TEST(CellContact, RectangleIsItsIntegral) {
  for (const auto& [x, y, a, b] : {std::array{0.3, -0.2, 0.5, 0.7}, std::array{2.0, 1.0, 0.1, 0.4},
                                   std::array{0.0, 0.0, 1.0, 0.25}, std::array{0.5, 0.1, 0.5, 0.3}}) {
    double sum = 0;  // polar about (x, y): the integral of 1/rho over the area is that of the reach over the angle
    constexpr int kAngles = 400000;
    for (int k = 0; k < kAngles; ++k) {
      const double angle = 2 * M_PI * (k + 0.5) / kAngles, c = std::cos(angle), s = std::sin(angle);
      double in = 0, out = 1e300;
      for (const auto& [at, direction, half] : {std::array{x, c, a}, std::array{y, s, b}}) {
        const double t1 = (-half - at) / direction, t2 = (half - at) / direction;
        in = std::max(in, std::min(t1, t2)), out = std::min(out, std::max(t1, t2));
      }
      sum += std::max(0.0, out - in) * 2 * M_PI / kAngles;
    }
    EXPECT_NEAR(loaded::rectangle_influence(x, y, a, b), sum, 2e-5 * sum);
  }
}

/// Windows of cells of any size, gaps large beside what the force presses: few cells carry, the search lets go all
/// others. Against active sets on the dense matrix.
TEST(CellContact, StiffWindowsOfUnequalCellsShareLikeBruteForce) {
  std::mt19937 random(20);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int trial = 0; trial < 300; ++trial) {
    CellProblem problem;
    problem.compliance = kCompliance * std::pow(10.0, -4 * unit(random));
    problem.force = 30;
    for (int w = 0; w < 2; ++w) {
      const double side = std::pow(10.0, -3 * unit(random)), tilt = 0.02 * unit(random);
      CellWindow window{6, 5, side, side * (0.5 + unit(random)), {}};
      for (int k = 0; k < 30; ++k) window.gap.push_back(tilt * window.dx * (k % 6) + 1e-3 * unit(random));
      problem.windows.push_back(window);
    }
    loaded::ContactProblem dense;
    constexpr Eigen::Index kCells = 60;
    dense.compliance = Eigen::MatrixXd::Zero(kCells, kCells), dense.gap.resize(kCells);
    dense.approach = Eigen::MatrixXd::Ones(kCells, 1), dense.support = Eigen::MatrixXd::Zero(1, 1);
    dense.load = Eigen::VectorXd::Constant(1, problem.force);
    for (Eigen::Index i = 0; i < kCells; ++i) {
      const auto& w = problem.windows[static_cast<std::size_t>(i / 30)];
      dense.gap(i) = w.gap[static_cast<std::size_t>(i % 30)];
      for (Eigen::Index k = i / 30 * 30; k < i / 30 * 30 + 30; ++k)
        dense.compliance(i, k) =
            problem.compliance / (w.dx * w.dy) *
            loaded::rectangle_influence(double(i % 6 - k % 6) * w.dx, double(i % 30 / 6 - k % 30 / 6) * w.dy, w.dx / 2,
                                        w.dy / 2);
    }
    const auto exact = loaded::share_load(dense);
    ASSERT_TRUE(exact) << exact.error().message;
    const auto found = loaded::press_cells(problem);
    ASSERT_TRUE(found) << trial << ": " << found.error().message;
    EXPECT_LT(found->residual, 1e-6) << trial;
    EXPECT_NEAR(found->approach, exact->motion(0), 1e-5 * exact->motion(0)) << trial;
    for (std::size_t i = 0; i < static_cast<std::size_t>(kCells); ++i) {
      const auto& w = problem.windows[i / 30];
      EXPECT_NEAR(found->pressure[i] * w.dx * w.dy, exact->force(static_cast<Eigen::Index>(i)), 1e-4 * problem.force)
          << trial << " " << i;
    }
  }
}

TEST(CellContact, IsTheEllipseOfHertz) {
  // Worked values: pressure and approach of a sphere of 10 mm, and of two ellipses.
  const struct {
    double k1, k2, force, pressure, approach, a, b;
  } cases[] = {{0.1, 0.1, 100, 1370.88, 3.48291e-3, .186626, .186626},
               {0.1, 0.025, 100, 908.582, 2.69338e-3, .362510, .144963},
               {1.0 / 40, 1.0 / 4000, 500, 301.982, 2.34058e-3, 3.791813, .208489}};
  for (const auto& c : cases) {
    double last = 1;
    for (const int n : {16, 32, 64}) {
      CellProblem problem;
      problem.windows = {paraboloid(c.k1, c.k2, 1.3 * c.b, 1.3 * c.a, n, n)};
      problem.compliance = kCompliance, problem.force = c.force;
      const auto found = loaded::press_cells(problem);
      ASSERT_TRUE(found) << found.error().message;
      const double error = std::abs(most_of(found->pressure) / c.pressure - 1);
      const auto h = hertz_ellipse(c.force, kModulus, c.k1, c.k2);
      EXPECT_NEAR(h.pressure, c.pressure, 1e-3 * c.pressure);
      EXPECT_LT(error, n == 16 ? 8e-3 : n == 32 ? 3e-3 : 1.5e-3) << n;
      EXPECT_NEAR(found->approach, c.approach, (n == 16 ? 3e-3 : 5e-4) * c.approach) << n;
      EXPECT_LT(found->residual, 1e-5);
      last = error;
    }
    EXPECT_LT(last, 1.5e-3);
  }
}

TEST(CellContact, AFlatPunchCarriesMostOnItsRim) {
  // A square of 2 mm, even approach: the stiffness is F/X = 1.1523 sqrt(A) times the modulus, within the cells' reach.
  CellProblem problem;
  problem.windows = {paraboloid(0, 0, 1, 1, 80, 80)};
  problem.compliance = kCompliance, problem.force = 1000;
  const auto found = loaded::press_cells(problem);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(1000 / found->approach / (kModulus * 2), 1.1523, 0.01);
  EXPECT_GT(found->pressure.front(), 5 * found->pressure[40 * 80 + 40]);
}

TEST(CellContact, TwoWindowsShareLikeBruteForce) {
  // Two small windows with a random smooth remainder: the same problem as a dense one, by active sets.
  std::mt19937 random(71);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 6; ++trial) {
    CellProblem problem;
    problem.windows = {paraboloid(0.1, 0.05, 0.3, 0.4, 7, 8), paraboloid(0.08, 0.02, 0.3, 0.5, 6, 9, 4e-4 * trial)};
    problem.windows[0].gap[20] = loaded::kNoMaterial;
    problem.windows[1].dy *= 1.1;
    if (trial % 2 == 1)  // places that near each by their own share of the motion, as those of bevel gears
      for (auto& w : problem.windows)
        for (std::size_t k = 0; k < w.size(); ++k) w.lever.push_back(1 + 0.1 * std::tanh(normal(random)));
    problem.compliance = kCompliance, problem.force = 150;
    const auto n0 = problem.windows[0].size(), n = n0 + problem.windows[1].size();
    constexpr int m = 5;
    Eigen::MatrixXd half(m, m);
    for (int i = 0; i < m; ++i)
      for (int k = 0; k < m; ++k) half(i, k) = normal(random) * 1e-3;
    problem.remainder = half * half.transpose();
    problem.stations.resize(m, static_cast<Eigen::Index>(n));
    Eigen::MatrixXd S(m, static_cast<Eigen::Index>(n));
    for (Eigen::Index i = 0; i < m; ++i)
      for (Eigen::Index k = 0; k < S.cols(); ++k) S(i, k) = std::abs(normal(random));
    problem.stations = S.sparseView();
    const auto found = loaded::press_cells(problem);
    ASSERT_TRUE(found) << found.error().message;

    std::vector<int> cells;  // with material
    std::vector<double> gaps, levers;
    for (const auto& w : problem.windows) {
      gaps.insert(gaps.end(), w.gap.begin(), w.gap.end());
      for (std::size_t k = 0; k < w.size(); ++k) levers.push_back(w.lever_of(k));
    }
    for (std::size_t k = 0; k < n; ++k)
      if (std::isfinite(gaps[k])) cells.push_back(static_cast<int>(k));
    const auto count = static_cast<Eigen::Index>(cells.size());
    loaded::ContactProblem dense;
    dense.compliance.resize(count, count), dense.gap.resize(count);
    dense.approach = Eigen::MatrixXd::Ones(count, 1);
    dense.support = Eigen::MatrixXd::Zero(1, 1);
    dense.load = Eigen::VectorXd::Constant(1, problem.force);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int a = cells[static_cast<std::size_t>(i)];
      dense.gap(i) = gaps[static_cast<std::size_t>(a)];
      dense.approach(i, 0) = levers[static_cast<std::size_t>(a)];
      for (Eigen::Index k = 0; k < count; ++k) {
        const int b = cells[static_cast<std::size_t>(k)];
        double C = S.col(a).dot(problem.remainder * S.col(b));
        const bool first = static_cast<std::size_t>(a) < n0;
        if (first == (static_cast<std::size_t>(b) < n0)) {
          const CellWindow& w = problem.windows[first ? 0 : 1];
          const int from = first ? 0 : static_cast<int>(n0), p = a - from, q = b - from;
          C += kCompliance / (w.dx * w.dy) *
               loaded::rectangle_influence((p % w.columns - q % w.columns) * w.dx,
                                           (p / w.columns - q / w.columns) * w.dy, w.dx / 2, w.dy / 2);
        }
        dense.compliance(i, k) = C;
      }
    }
    const auto exact = loaded::share_load(dense);
    ASSERT_TRUE(exact) << exact.error().message;
    EXPECT_NEAR(found->approach, exact->motion(0), 1e-5 * exact->motion(0)) << trial;
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(cells[static_cast<std::size_t>(i)]);
      const CellWindow& w = problem.windows[k < n0 ? 0 : 1];
      EXPECT_NEAR(found->pressure[k] * w.dx * w.dy, exact->force(i), 1e-4 * problem.force) << trial;
    }
  }
}

TEST(CellContact, OneCellCarriesAll) {
  CellProblem problem;
  problem.windows = {paraboloid(0.1, 0.1, 0.3, 0.2, 1, 1, 0.001)};
  problem.compliance = kCompliance;
  problem.force = 50;
  const auto found = loaded::press_cells(problem);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_NEAR(found->pressure[0], 50 / (0.6 * 0.4), 1e-9);
  EXPECT_NEAR(found->approach, 0.001 + kCompliance * 50 / (0.6 * 0.4) * loaded::rectangle_influence(0, 0, 0.3, 0.2),
              1e-12);
}

TEST(CellContact, RefusesWhatCannotPress) {
  CellProblem problem;
  problem.windows = {paraboloid(0.1, 0.1, 1, 1, 4, 4)};
  problem.compliance = kCompliance;
  EXPECT_NE(loaded::press_cells(problem).error().message.find("a force above 0"), std::string::npos);
  problem.force = 1;
  for (double& g : problem.windows[0].gap) g = loaded::kNoMaterial;
  EXPECT_EQ(loaded::press_cells(problem).error().message, "no cell of the contact has material");
}

}  // namespace
}  // namespace toothpath::test
