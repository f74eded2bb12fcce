// What a body of any profile has swept, against its distance at very many poses of the path.
#include <gtest/gtest.h>

#include <cmath>

#include "cam/rest/swept_body.h"
#include "tests/support/random.h"

namespace toothpath::rest {
namespace {

/// A cone that widens upwards without end: radius 1 at the tip, 0.3 more a mm.
double cone(double height, double radius) {
  const double lean = std::atan(0.3), side = (radius - 1 - 0.3 * height) * std::cos(lean);
  if (height >= 0 && side <= 0) return std::max(-height, side);
  if (height < 0 && radius <= 1) return -height;
  return side > 0 && (radius - 1) * std::sin(lean) + height * std::cos(lean) > 0 ? side
                                                                                 : std::hypot(radius - 1, height);
}

std::vector<path::ToolMotion> random_path(test::Random& random) {
  std::vector<path::ToolMotion> motions;
  path::ToolMotion m;
  m.tip_to = Vec3(-6, random(-1, 1), 3);
  m.axis_to = Vec3(0, random(-0.01, 0.01), 1).normalized();
  for (int k = 0; k < 14; ++k) {
    m.tip_from = m.tip_to;
    m.axis_from = m.axis_to;
    m.tip_to = k == 0 ? Vec3(m.tip_from - 3 * m.axis_from) : Vec3(-6 + k, random(-1.5, 1.5), 0.005 * std::sin(k));
    if (k > 0) m.axis_to = (m.axis_from + Vec3(random(-0.004, 0.004), random(-0.004, 0.004), 0)).normalized();
    m.rapid = k == 9;
    motions.push_back(m);
  }
  return motions;
}

TEST(SweptBody, IsAsFarAsItsNearestPose) {
  test::Random random(31);
  for (int trial = 0; trial < 4; ++trial) {
    const auto motions = random_path(random);
    const SweptBody swept(motions, cone, 6, 5);
    int removed = 0;
    for (int k = 0; k < 400; ++k) {
      const Vec3 p(random(-7, 8), random(-4, 4), random(-0.5, 4));
      double least = 3;
      for (const auto& m : motions)
        for (int i = 0; !m.rapid && i <= 400; ++i) {
          const Vec3 axis = path::axis_at(m, i / 400.0), d = p - path::tip_at(m, i / 400.0);
          least = std::min(least, cone(d.dot(axis), (d - d.dot(axis) * axis).norm()));
        }
      const double found = swept.excess(p, 3);
      EXPECT_GT(found, least - SweptBody::kWithin_mm - 2e-3) << p.transpose();  // of the steps of the sampling
      EXPECT_LT(found, least + 0.02) << p.transpose();
      removed += least < 0;
      EXPECT_EQ(swept.excess(p, 0), std::min(found, 0.0));
    }
    EXPECT_GT(removed, 40);
  }
}

TEST(SweptBody, OfNoMotionsRemovesNothing) { EXPECT_EQ(SweptBody({}, cone, 1, 1).excess(Vec3::Zero(), 0.5), 0.5); }

}  // namespace
}  // namespace toothpath::rest
