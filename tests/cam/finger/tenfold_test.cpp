// Cutter, shank and holder of the finger-milled samples at ten times as many moments as the check looks at, all three
// at the same ones: no body is deeper, or nearer, than what is proven of it; faults of 2 um by each of them are seen by
// the samples and by the check.
#include <fmt/format.h>

#include <map>
#include <random>

#include "tests/cam/finger/dense.h"
#include "tests/cam/finger/jobs.h"

namespace toothpath {
namespace {

using namespace bevel_test;

constexpr double kTenfoldDepth = 0.002, kTenfoldWithin = 2e-4;
constexpr std::size_t kEvery =
    16;  // of the motions of a program: the quick form has fewer motions, each as densely sampled
constexpr DenseBody kBodies[] = {DenseBody::cutter, DenseBody::shank, DenseBody::holder};
const finger::FingerCheckOptions kTenfoldQuick{.columns = 2, .rows = 2, .ridge_columns = 2, .ridge_rows = 3};

/// A program with the tool that is checked and sampled.
struct Sample {
  Sample(Milled milled, double stick_out_mm)
      : job(with_stick_out(std::move(milled), stick_out_mm)),
        dense(job.gear, job.tools[0]),
        check(job.gear, job.tools, job.ops, {}, kTenfoldQuick) {}
  [[nodiscard]] proof::GougeResult verdict(const path::ToolMotion& m) const {
    return check.verify(std::span(&m, 1)).gouge;
  }
  static Milled with_stick_out(Milled milled, double stick_out_mm) {
    milled.tools[0].stick_out_mm = stick_out_mm;
    return milled;
  }
  Milled job;
  DenseFinger dense;
  finger::FingerGougeCheck check;
};

const Sample& sample(const std::string& name) {
  static std::map<std::string, std::unique_ptr<Sample>> made_once;
  auto& s = made_once[name];
  if (s) return *s;
  Milled job = name == "bevel_pinion"  ? mill_all(w3(), 0.9)
               : name == "bevel_wheel" ? mill_all(w4(), 0.6)
                                       : mill_trunnion();
  // Drawn in until the holder comes as near to the teeth as the shank.
  const double flute = job.gear.parameters().dedendum_mm + job.tools[0].profile_height_mm;
  s = std::make_unique<Sample>(std::move(job), flute + 0.5);
  return *s;
}

class FingerTenfold : public ::testing::TestWithParam<const char*> {
 protected:
  const Sample& s_ = sample(GetParam());
  std::mt19937 random_{2027};
  double uniform(double a, double b) { return a + (b - a) * double(random_()) / 4294967295.0; }
  Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

  /// From one record of the finishing operation to another.
  [[nodiscard]] path::ToolMotion block(std::size_t from, std::size_t to) const {
    const auto& r = s_.job.plans[1].path.records;
    path::ToolMotion m;
    m.tip_from = r[from].tip, m.tip_to = r[to].tip, m.axis_from = r[from].axis, m.axis_to = r[to].axis;
    m.operation = 1, m.line = int(to);
    return m;
  }
  /// A block of the walls.
  [[nodiscard]] path::ToolMotion some_block(std::size_t length) {
    const auto& r = s_.job.plans[1].path.records;
    for (;;) {
      const std::size_t k = 1 + random_() % (r.size() - 2 - length);
      bool feeds = true;
      for (std::size_t i = k + 1; i <= k + length; ++i) feeds = feeds && r[i].kind == path::MoveKind::feed;
      const double R_c = finger::cone_pose(s_.job.gear, r[k].tip, r[k].axis, 0).R_c;
      if (feeds && R_c > s_.job.gear.R_i() && R_c < s_.job.gear.R_e()) return block(k, k + length);
    }
  }
  /// No sample of any body may contradict what is said of the motion. Counts the bodies that came nearer than what is
  /// looked at.
  void expect_covered(const path::ToolMotion& m, std::map<std::string, int>& near) const {
    const proof::GougeResult v = s_.verdict(m);
    for (const DenseBody body : kBodies) {
      const DenseGap g = s_.dense.least(m, body);
      const auto where = [&] {
        return fmt::format("{} against {} at {:.4f} of the motion to record {}, {} moments", name_of(body), g.part, g.t,
                           m.line, s_.dense.moments(m));
      };
      if (g.gap < kFar) ++near[name_of(body)];
      if (m.rapid) EXPECT_TRUE(g.gap >= 0 || !v.rapids_clear) << where();
      else if (body == DenseBody::cutter) EXPECT_GE(g.gap, -v.bound_mm - 1e-7) << where();
      else EXPECT_GE(g.gap, std::min(v.clearance_mm, kFar) - 1e-7) << where();
    }
  }
};

TEST_P(FingerTenfold, TheProgram) {
  std::map<std::string, int> near;
  for (std::size_t k = 2; k < s_.job.motions.size(); k += kEvery) expect_covered(s_.job.motions[k], near);
  for (std::size_t k = 0; k < s_.job.motions.size(); ++k)
    if (s_.job.motions[k].rapid) expect_covered(s_.job.motions[k], near);
  for (const DenseBody body : kBodies) EXPECT_GE(near[name_of(body)], 10) << name_of(body);
}

// A little beside the path, where the cutter decides, and leaning by up to 0.1 rad, where shank and holder do.
TEST_P(FingerTenfold, MotionsThatStray) {
  std::map<std::string, int> near;
  for (int n = 0; n < 16; ++n) {
    path::ToolMotion m = some_block(1 + std::size_t(n) % 3);
    const double aside = n % 2 == 0 ? 0.01 : 0.3, lean = n % 2 == 0 ? 3e-4 : 0.06;
    m.tip_from += vector(aside), m.tip_to += vector(aside);
    m.axis_from = (m.axis_from + vector(lean)).normalized(), m.axis_to = (m.axis_to + vector(lean)).normalized();
    expect_covered(m, near);
  }
  for (const DenseBody body : kBodies) EXPECT_GE(near[name_of(body)], 10) << name_of(body);
}

TEST_P(FingerTenfold, AFaultOfTheCutterIsFound) {
  for (int n = 0; n < 3; ++n) {
    path::ToolMotion m = some_block(1);
    const Vec3 aside = vector(1).normalized();
    double size = kTenfoldDepth;
    for (int round = 0; round < 4; ++round) {
      path::ToolMotion planted = m;
      planted.tip_to += size * aside;
      const DenseGap g = s_.dense.least(planted, DenseBody::cutter);
      if (round < 3) {
        size *= std::clamp(kTenfoldDepth / std::max(-g.gap, 1e-5), 0.2, 3.0);
        continue;
      }
      EXPECT_NEAR(g.gap, -kTenfoldDepth, 5e-4);
      const proof::GougeResult v = s_.verdict(planted);
      EXPECT_GE(v.bound_mm, -g.gap - 1e-7) << n;
      EXPECT_GE(v.measured_mm, -g.gap - 2e-5) << n << " " << g.part;
      EXPECT_LE(v.measured_mm, -g.gap + kTenfoldWithin) << n << " " << g.part << ": wall points are 0.2 mm apart";
    }
  }
}

// The tool leans and sinks along its axis until one body alone is 2 um deep somewhere on the motion.
TEST_P(FingerTenfold, AFaultOfShankOrHolderIsFound) {
  for (const DenseBody body : {DenseBody::shank, DenseBody::holder}) {
    const Sample far(s_.job, s_.job.tools[0].stick_out_mm + 20);
    const Sample& tool = body == DenseBody::shank ? far : s_;
    int found = 0;
    for (int n = 0; n < 3; ++n) {
      path::ToolMotion m = some_block(1);
      const Vec3 lean = vector(0.1);
      m.axis_from = (m.axis_from + lean).normalized(), m.axis_to = (m.axis_to + lean + vector(0.002)).normalized();
      const path::ToolMotion start = m;
      double sunk = 0, step = 0;
      DenseGap g = tool.dense.least(m, body), before;
      for (int round = 0; round < 12 && std::abs(g.gap + kTenfoldDepth) > 1e-6; ++round) {
        const double slope = round == 0 ? 1 : std::clamp((before.gap - g.gap) / step, 0.1, 2.0);
        sunk += step = (g.gap + kTenfoldDepth) / slope;
        before = g;
        m.tip_from = start.tip_from - sunk * start.axis_from, m.tip_to = start.tip_to - sunk * start.axis_to;
        g = tool.dense.least(m, body);
      }
      ASSERT_NEAR(g.gap, -kTenfoldDepth, 1e-4) << name_of(body) << " " << n;
      const proof::GougeResult v = tool.verdict(m);
      EXPECT_LE(v.clearance_mm, g.gap + 1e-7);
      const auto named = std::find_if(v.worst.begin(), v.worst.end(), [&](const proof::WorstPlace& w) {
        return std::string(to_string(w.body)) == name_of(body) && w.patch == g.part;
      });
      if (named == v.worst.end()) {
        ADD_FAILURE() << name_of(body) << " in " << g.part << " is not named, case " << n;
        continue;
      }
      // The check tells how far both must be moved apart, which is more than the depth of a place where edges meet, and
      // may be most at another moment.
      double apart = tool.dense.overlap(g, m, body).depth;
      EXPECT_GE(named->depth_mm, apart - 5e-5) << "sampled circles and directions are that coarse";
      for (int k = 0; k <= 16 && named->depth_mm > apart + kTenfoldWithin; ++k) {
        DenseGap at = g;
        at.t = k / 16.0;
        apart = std::max(apart, tool.dense.overlap(at, m, body).depth);
      }
      EXPECT_LE(named->depth_mm, apart + kTenfoldWithin) << name_of(body) << " " << n;
      ++found;
    }
    EXPECT_EQ(found, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, FingerTenfold, ::testing::Values("bevel_pinion", "bevel_wheel", "bevel_trunnion"),
                         [](const auto& c) { return std::string(c.param); });

}  // namespace
}  // namespace toothpath
