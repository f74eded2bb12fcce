// The gap of shank and holder that is told exists at a place of the finished teeth, and dense samples of the lands show
// none that is smaller.
#include "cam/finger/clearance.h"

#include "tests/cam/finger/dense.h"
#include "tests/cam/finger/jobs.h"

namespace toothpath {
namespace {

using namespace bevel_test;

const finger::FingerCheckOptions kClearanceQuick{.columns = 2, .rows = 2, .ridge_columns = 2, .ridge_rows = 3};

/// Points of the face cone that the nominal passes leave within one pitch, by brute force.
std::vector<Vec3> land_points(const bevel_gear::BevelGear& gear, const BruteFinger& brute) {
  std::vector<Vec3> out;
  constexpr int along = 32, across = 32;
  for (const auto& half : gear.halves())
    for (int i = 0; i <= along; ++i)
      for (int j = 0; j < across; ++j) {
        const double ell = half.ell_from + (half.ell_to - half.ell_from) * i / along,
                     azimuth = gear.pitch() * j / across;
        const Vec3 p =
            bevel_gear::blank_point(ell, gear.parameters().addendum_mm, azimuth, gear.sin_delta(), gear.cos_delta());
        // The spaces wind about the cone: what the passes of the neighbours cut off is seen from there.
        bool left = true;
        for (int space = -3; space <= 3 && left; ++space)
          left = brute.material(Eigen::AngleAxisd(-space * gear.pitch(), Vec3::UnitZ()) * p) > 0;
        if (left) out.push_back(p);
      }
  return out;
}

class FingerClearances : public ::testing::TestWithParam<const char*> {};

TEST_P(FingerClearances, AgainstDenseLands) {
  const std::string name = GetParam();
  Milled job = name == "bevel_pinion"  ? mill_all(w3(), 0.9)
               : name == "bevel_wheel" ? mill_all(w4(), 0.6)
                                       : mill_trunnion();
  const BruteFinger brute(job.gear);
  const auto land = land_points(job.gear, brute);
  ASSERT_GT(land.size(), 300u);
  // As in the job, and a millimetre too deep.
  for (const bool struck : {false, true}) {
    if (struck)
      for (path::ToolMotion& m : job.motions) m.tip_from -= m.axis_from, m.tip_to -= m.axis_to;
    const finger::FingerGougeCheck check(job.gear, job.tools, job.ops, {}, kClearanceQuick);
    const proof::GougeResult v = check.verify(job.motions).gouge;
    EXPECT_GE(v.clearance_measured_mm, v.clearance_mm) << "the blank is more than the part";
    const DenseFinger dense(job.gear, job.tools[0]);
    double least = INFINITY;
    for (std::size_t n = 1; n < job.motions.size(); n += 3) {
      const path::ToolMotion& m = job.motions[n];
      if (m.rapid) continue;
      for (const double t : {0.0, 0.5, 1.0}) {
        const BrutePose pose = pose_at(m, t);
        for (int tooth = -3; tooth <= 2; ++tooth) {
          const Mat3 turn = Eigen::AngleAxisd(tooth * job.gear.pitch(), Vec3::UnitZ()).toRotationMatrix();
          const Vec3 tip = turn.transpose() * pose.tip, axis = turn.transpose() * pose.axis;
          for (std::size_t k = 0; k < land.size(); k += 2)
            for (const DenseBody body : {DenseBody::shank, DenseBody::holder})
              least = std::min(least, dense.distance(land[k], {tip, axis}, body));
        }
      }
    }
    EXPECT_LE(v.clearance_measured_mm, least + 1e-6) << struck;
    EXPECT_GE(v.clearance_measured_mm, least - 0.1) << struck << ": points of the lands are that far apart";
    EXPECT_EQ(v.clearance_measured_mm < 0, struck);
  }
}

// The place is on the part and as far from the body as is told.
TEST_P(FingerClearances, ThePlaceExists) {
  const std::string name = GetParam();
  const Milled job = name == "bevel_pinion"  ? mill_all(w3(), 0.9)
                     : name == "bevel_wheel" ? mill_all(w4(), 0.6)
                                             : mill_trunnion();
  const BruteFinger brute(job.gear);
  const DenseFinger dense(job.gear, job.tools[0]);
  const finger::FingerClearance part(job.gear);
  const double flute = job.gear.parameters().dedendum_mm + job.tools[0].profile_height_mm,
               r = job.tools[0].shank_diameter_mm / 2;
  const tool::Frustum shank{flute, job.tools[0].stick_out_mm, r, r, tool::Body::shank};
  int found = 0;
  for (std::size_t k = 3; k < job.motions.size(); k += 40) {
    const path::ToolMotion& m = job.motions[k];
    if (m.rapid) continue;
    const finger::FoundGap gap = part.least(shank, m, {});
    ASSERT_TRUE(std::isfinite(gap.gap_mm));
    EXPECT_NEAR(dense.distance(gap.place, pose_at(m, gap.t), DenseBody::shank), gap.gap_mm, 1e-9);
    if (std::string(gap.patch) != "land") continue;
    EXPECT_NEAR(bevel_gear::cone_point(gap.place, job.gear.sin_delta(), job.gear.cos_delta()).height,
                job.gear.parameters().addendum_mm, 1e-9);
    for (int tooth = -2; tooth <= 2; ++tooth)
      EXPECT_GE(brute.material(Eigen::AngleAxisd(tooth * job.gear.pitch(), Vec3::UnitZ()) * gap.place), -2e-5)
          << k << " in what is cut off, space " << tooth;
    ++found;
  }
  EXPECT_GE(found, 5);
}

INSTANTIATE_TEST_SUITE_P(Samples, FingerClearances, ::testing::Values("bevel_pinion", "bevel_wheel", "bevel_trunnion"),
                         [](const auto& c) { return std::string(c.param); });

}  // namespace
}  // namespace toothpath
