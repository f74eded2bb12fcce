// Strips on a half-space, Hertz, and the sharing of load: against closed forms, worked values and all sets of places.
#include "geometry/loaded/half_space.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

#include "geometry/loaded/complementarity.h"

namespace toothpath::test {
namespace {

constexpr double kSteel = 210000, kNu = 0.3;

TEST(HalfSpace, HertzLineOfTheWorkedValues) {
  const double modulus = loaded::contact_modulus(kSteel, kNu, kSteel, kNu);
  EXPECT_NEAR(modulus, 115384.615, 1e-3);
  const auto hertz = loaded::hertz_line(15.0, modulus, 1 / 40.0);
  EXPECT_NEAR(hertz.half_width, 0.0813686, 1e-6 * 0.0813686);
  EXPECT_NEAR(hertz.pressure, 117.3585, 1e-6 * 117.3585);
}

TEST(HalfSpace, StripInfluenceOfTheWorkedValues) {
  EXPECT_NEAR(loaded::strip_influence(0.0, 0.0, 1.5, 0.08, true), 8.24973, 1e-5);
  EXPECT_NEAR(loaded::strip_influence(0.0, 0.0, 1.5, 0.6, true), 4.29057, 1e-5);
  EXPECT_NEAR(loaded::strip_influence(0.0, 0.0, 0.4, 0.2, true), 3.87945, 1e-5);
  // Narrow strips: 2 ln(2 D/b) + 1.
  EXPECT_NEAR(loaded::strip_influence(0.0, 0.0, 1.5, 1e-4, true), 2 * std::log(2 * 1.5 / 1e-4) + 1, 1e-3);
}

TEST(HalfSpace, FarAndNearFormsMeet) {
  for (const double off : {0.0, 2.0, 5.0})
    for (const double along : {3.05, 4.0, 8.0}) {
      const double far = loaded::strip_influence(along, off, 1.5, 0.1, false);
      double direct = 0;  // 400 x 400 points of the semi-ellipse
      for (int i = 0; i < 400; ++i)
        for (int k = 0; k < 400; ++k) {
          const double angle = M_PI * (k + 0.5) / 400, x = 0.1 * std::cos(angle), l = 1.5 * ((i + 0.5) / 400 - 0.5);
          direct += 2 * std::sin(angle) * std::sin(angle) / 400 * (1.5 / 400) / std::hypot(along - l, off, x);
        }
      EXPECT_NEAR(far, direct, 2e-4 * direct) << along << " " << off;
    }
}

/// A roller with sharp ends, L3.
void expect_roller(double length, double middle, double approach) {
  const double c = 2 * loaded::half_space_compliance(kSteel, kNu),
               modulus = loaded::contact_modulus(kSteel, kNu, kSteel, kNu), mean = 50;
  const int n = static_cast<int>(length / 0.1);
  const double D = length / n;
  Eigen::VectorXd width = Eigen::VectorXd::Constant(n, loaded::hertz_line(mean, modulus, 1 / 10.0).half_width);
  loaded::ContactForces found;
  for (int round = 0; round < 6; ++round) {
    loaded::ContactProblem p;
    p.compliance.resize(n, n);
    for (int i = 0; i < n; ++i)
      for (int k = 0; k < n; ++k)
        p.compliance(i, k) = c / D * loaded::strip_influence((i - k) * D, 0.0, D, width(k), i == k);
    p.compliance = Eigen::MatrixXd((p.compliance + p.compliance.transpose()) / 2);
    p.gap = Eigen::VectorXd::Zero(n);
    p.approach = Eigen::MatrixXd::Ones(n, 1);
    p.support = Eigen::MatrixXd::Zero(1, 1);
    p.load = Eigen::VectorXd::Constant(1, mean * length);
    const auto solved = loaded::share_load(p);
    ASSERT_TRUE(solved);
    found = *solved;
    for (int i = 0; i < n; ++i) width(i) = loaded::hertz_line(found.force(i) / D, modulus, 1 / 10.0).half_width;
  }
  EXPECT_NEAR(found.force.sum(), mean * length, 1e-9 * mean * length);
  EXPECT_NEAR(found.force(n / 2) / D / mean, middle, 0.02);
  EXPECT_GT(approach, 0);
  EXPECT_GT(found.force(0) / D, mean) << "sharp ends carry more";
}
TEST(HalfSpace, RollerWithSharpEnds) {
  expect_roller(4, 0.887, 3.893e-4);
  expect_roller(16, 0.922, 5.052e-4);
}

/// Every set of places is tried: the one whose forces press and whose other gaps are open is the answer.
loaded::ContactForces by_enumeration(const loaded::ContactProblem& p) {
  const int n = static_cast<int>(p.gap.size());
  const auto m = static_cast<int>(p.approach.cols());
  for (int set = 1; set < (1 << n); ++set) {
    std::vector<int> in;
    for (int i = 0; i < n; ++i)
      if ((set >> i) & 1) in.push_back(i);
    const int k = static_cast<int>(in.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(k + m, k + m);
    Eigen::VectorXd right(k + m);
    for (int i = 0; i < k; ++i) {
      for (int j = 0; j < k; ++j)
        K(i, j) = p.compliance(in[static_cast<std::size_t>(i)], in[static_cast<std::size_t>(j)]);
      K.block(i, k, 1, m) = -p.approach.row(in[static_cast<std::size_t>(i)]);
      K.block(k, i, m, 1) = p.approach.row(in[static_cast<std::size_t>(i)]).transpose();
      right(i) = -p.gap(in[static_cast<std::size_t>(i)]);
    }
    K.bottomRightCorner(m, m) = p.support;
    right.tail(m) = p.load;
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(K);
    if (!lu.isInvertible()) continue;
    const Eigen::VectorXd x = lu.solve(right);
    loaded::ContactForces f;
    f.force = Eigen::VectorXd::Zero(n);
    for (int i = 0; i < k; ++i) f.force(in[static_cast<std::size_t>(i)]) = x(i);
    f.motion = x.tail(m);
    if (f.force.minCoeff() < 0) continue;
    if ((p.compliance * f.force + p.gap - p.approach * f.motion).minCoeff() < -1e-10) continue;
    return f;
  }
  return {};
}

TEST(ShareLoad, IsWhatEnumerationFinds) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> any(0, 1);
  for (const int n : {8, 10, 12})
    for (int trial = 0; trial < 6; ++trial) {
      loaded::ContactProblem p;
      Eigen::MatrixXd B = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return any(random) - 0.3; });
      p.compliance = B * B.transpose() + 0.3 * Eigen::MatrixXd::Identity(n, n);
      p.gap = Eigen::VectorXd::NullaryExpr(n, [&] { return 3 * any(random); });
      p.approach = Eigen::MatrixXd::Ones(n, 2);
      for (int i = 0; i < n; ++i) p.approach(i, 1) = i % 2 == 0 ? 0.5 : -0.5;
      p.support = Eigen::MatrixXd::Zero(2, 2);
      p.support(1, 1) = trial % 3 == 0 ? 0 : any(random);
      p.load = Eigen::Vector2d(1 + 3 * any(random), 0);
      const auto solved = loaded::share_load(p);
      ASSERT_TRUE(solved) << solved.error().message;
      const auto exact = by_enumeration(p);
      ASSERT_EQ(exact.force.size(), n);
      EXPECT_LT((solved->force - exact.force).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((solved->motion - exact.motion).cwiseAbs().maxCoeff(), 1e-9);
      const auto again = loaded::share_load(p, {0});
      ASSERT_TRUE(again) << "from one place";
      EXPECT_LT((again->force - exact.force).cwiseAbs().maxCoeff(), 1e-9);
    }
}

TEST(ShareLoad, RefusesWhatNoPressureBalances) {
  loaded::ContactProblem p;
  p.compliance = Eigen::MatrixXd::Identity(3, 3);
  p.gap = Eigen::VectorXd::Zero(3);
  p.approach = Eigen::MatrixXd::Ones(3, 1);
  p.support = Eigen::MatrixXd::Zero(1, 1);
  p.load = Eigen::VectorXd::Constant(1, -5.0);
  const auto away = loaded::share_load(p);
  ASSERT_FALSE(away);
  EXPECT_NE(away.error().message.find("separates"), std::string::npos);
  p.load(0) = 5;
  p.compliance(0, 0) = -1;
  const auto indefinite = loaded::share_load(p);
  ASSERT_FALSE(indefinite);
  EXPECT_NE(indefinite.error().message.find("eigenvalue"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
