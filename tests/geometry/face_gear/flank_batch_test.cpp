// The vectorised flank against the plain one, its sine and cosine against 50 digits.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "geometry/face_gear/flank_batch.h"
#include "tests/support/face_gear_cases.h"

namespace toothpath::test {
namespace {

TEST(FlankBatch, SineAndCosineAreGoodToRounding) {
  using Reference = boost::multiprecision::cpp_bin_float_50;
  std::vector<double> x;
  for (int k = -2000; k <= 2000; ++k) x.push_back(0.05 * k + 1e-3 * (k % 7));
  for (int k = -40; k <= 40; ++k)
    for (const double off : {-1e-9, 0.0, 1e-9, 0.25 * kPi}) x.push_back(k * 0.5 * kPi + off);
  x.insert(x.end(), {0.0, 1e-300, -1e-300, 1e-17});
  std::vector<double> s(x.size()), c(x.size());
  face_gear::sine_cosine(x, s, c);
  double worst = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    worst = std::max(worst, std::abs(static_cast<double>(sin(Reference(x[k])) - Reference(s[k]))));
    worst = std::max(worst, std::abs(static_cast<double>(cos(Reference(x[k])) - Reference(c[k]))));
  }
  EXPECT_LT(worst, 4e-16);
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
  const std::vector<double> large = {1e3, -1e4, 99999.5};
  std::vector<double> sl(3), cl(3);
  face_gear::sine_cosine(large, sl, cl);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(sl[k], std::sin(large[k]), 1e-15);
    EXPECT_NEAR(cl[k], std::cos(large[k]), 1e-15);
  }
}

TEST(FlankBatch, AgreesWithTheFlank) {
  auto cases = extreme_cases();
  for (const auto& c : random_cases(8, 10)) cases.push_back(c);
  for (const auto& c : cases) {
    const auto f = c.surface();
    for (const int side : {1, -1}) {
      std::vector<double> theta, B;
      for (int j = 0; j < 23; ++j)
        for (int k = 0; k < 29; ++k) {
          theta.push_back(-0.1 + 0.04 * j);
          B.push_back(side * (-0.2 + 0.04 * k));
        }
      face_gear::FlankPoints out;
      evaluate_flank(f, side, theta, B, out);
      ASSERT_EQ(out.size(), theta.size());
      for (std::size_t k = 0; k < theta.size(); ++k) {
        const auto q = f.flank(side, theta[k], B[k]);
        const double scale = std::max(f.L_p, q.p.norm());
        EXPECT_LT((Vec3(out.x[k], out.y[k], out.z[k]) - q.p).norm(), 4e-15 * scale) << c.name;
        EXPECT_LT((Vec3(out.nx[k], out.ny[k], out.nz[k]) - q.n).norm(), 4e-15) << c.name;
      }
    }
  }
}

TEST(FlankBatch, NothingGivesNothing) {
  face_gear::FlankPoints out;
  out.resize(3);
  evaluate_flank(case_named("offset_15").surface(), 1, {}, {}, out);
  EXPECT_EQ(out.size(), 0u);
}

}  // namespace
}  // namespace toothpath::test
