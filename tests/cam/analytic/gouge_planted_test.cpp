// Gouges of 2 um planted with every body of the tool: the tool of a clean program leans about its ball until its flute,
// shank or holder cuts 2 um deep, at a place that the path itself decides, between two blocks. Depth and place are
// known from dense sampling of the gear (tests/support/brute_force_bodies.h).
#include "cam/analytic/cutter_sweep.h"
#include "cam/analytic/gouge_check.h"
#include "cam/path/motion_blend.h"
#include "tests/cam/ball/face_gear_jobs.h"
#include "tests/support/brute_force_bodies.h"

namespace toothpath {
namespace {

using test::BruteBody;
using test::BruteDepth;
using test::job_named;
using test::PlannedJob;

constexpr double kPlantedDepth = 0.002;

/// What is planted: which body cuts, the tool that it belongs to, one motion.
struct Fault {
  std::string body;
  tool::ToolAssembly tool;
  path::ToolMotion motion;
  BruteBody shape;
  BruteDepth truth;
};

class BodyPlanter {
 public:
  BodyPlanter(const PlannedJob& job, unsigned seed) : job_(job), brute_(job.gear), random_(seed) {}

  std::optional<Fault> plant(const std::string& body) {
    for (int attempt = 0; attempt < 60; ++attempt)
      if (auto fault = one(body)) return fault;
    return {};
  }

 private:
  std::optional<Fault> one(const std::string& body) {
    const auto& path = job_.plan.paths[random_.index(job_.plan.paths.size())];
    const std::size_t k = 1 + random_.index(path.records.size() - 2);
    const auto &a = path.records[k], &b = path.records[k + 1];
    if (b.kind != path::MoveKind::feed) return {};
    Fault f;
    f.body = body;
    f.tool = job_.tool(path.operation);
    const double R = f.tool.radius_mm();
    if (body == "shank") {
      f.tool.flute_length_mm = R + random_(0.1, 0.4);
      f.tool.shank_diameter_mm = 2 * R * random_(0.9, 1.0);
      f.shape = {f.tool.flute_length_mm, f.tool.stick_out_mm, f.tool.shank_diameter_mm / 2,
                 f.tool.shank_diameter_mm / 2, false};
    } else if (body == "holder") {
      const double depth = job_.gear.blank_top() - a.tip.z();  // of the tip below the lands
      f.tool.stick_out_mm = std::max(depth, 0.0) + random_(0.15, 0.4);
      f.tool.flute_length_mm = std::min(f.tool.flute_length_mm, f.tool.stick_out_mm);
      f.tool.shank_diameter_mm = 1.6 * R;
      const double r0 = random_(2, 6), r1 = r0 * random_(1.0, 1.3);
      f.tool.holder = {{2 * r0, 2 * r1, random_(5, 20)}};
      f.shape = {f.tool.stick_out_mm, f.tool.stick_out_mm + f.tool.holder[0].height_mm, r0, r1, false};
    } else {
      f.shape = {1.4 * R, f.tool.flute_length_mm, R, R, true};  // near the ball's centre it touches anyway
    }
    // Lean about the ball centres, the second end perhaps a little more: then the axis turns inside the block.
    const double azimuth = random_(0, 2 * kPi), more = random_.index(3) == 0 ? random_(1.0, 1.05) : 1.0;
    const auto leaning = [&](double angle) {
      path::ToolMotion m;
      const Vec3 to = a.axis.cross(Vec3(std::cos(azimuth), std::sin(azimuth), 0.1)).normalized();
      m.axis_from = Eigen::AngleAxisd(angle, to) * a.axis;
      m.axis_to = Eigen::AngleAxisd(angle * more, to) * b.axis;
      m.tip_from = a.tip + R * a.axis - R * m.axis_from;
      m.tip_to = b.tip + R * b.axis - R * m.axis_to;
      m.operation = path.operation;
      m.line = int(k) + 1;
      return m;
    };
    // The depth grows with the lean: samples tell roughly where, then it is halved.
    double low = 0, high = 1.0;
    if (brute_.sampled(f.shape, leaning(low)).depth > -0.03) return {};
    for (double angle = 0.05; angle < 1.0; angle += 0.05)
      if (brute_.sampled(f.shape, leaning(angle)).depth > -0.05) {
        high = angle;
        break;
      }
    for (; high < 1.0 && brute_.deepest(f.shape, leaning(high), 1, 2).depth <= kPlantedDepth; high += 0.02) low = high;
    if (high >= 1.0) return {};
    low = std::max(low, high - 0.05);
    BruteDepth near = brute_.deepest(f.shape, leaning(high), 4);
    for (int step = 0; step < 40 && high - low > 1e-8; ++step) {
      const double middle = 0.5 * (low + high);
      near = brute_.improved(f.shape, leaning(middle), near, 0.004);
      (near.depth > kPlantedDepth ? high : low) = middle;
    }
    f.motion = leaning(high);
    f.truth = brute_.deepest(f.shape, f.motion, 6, 6);
    if (std::abs(f.truth.depth - kPlantedDepth) > 1e-4) return {};  // another place was deeper: not what was meant
    if (body == "flute" &&
        brute_.deepest({R, f.tool.flute_length_mm, R, R, true}, f.motion, 4, 4).depth > f.truth.depth + 1e-4)
      return {};
    return f;
  }

  const PlannedJob& job_;
  test::BruteForceBodies brute_;
  test::Random random_;
};

/// Planted and found, by body and job.
class EveryBody : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(EveryBody, IsFoundWithinAFifthOfAMicrometre) {
  const auto& job = job_named(std::get<0>(GetParam()));
  const std::string body = std::get<1>(GetParam());
  BodyPlanter planter(job, 77);
  int planted = 0, found = 0, turning = 0, deeper = 0;
  const test::BruteForceGearSolid solid(job.gear);
  const int wanted = std::string(std::get<0>(GetParam())) == "spur" ? 12 : 7;
  for (int k = 0; k < wanted; ++k) {
    const auto fault = planter.plant(body);
    if (!fault) continue;
    ++planted;
    turning += fault->motion.axis_from != fault->motion.axis_to;
    auto options = job.check_options();
    options.limits.gouge_mm = 0.0015;
    std::vector<tool::ToolAssembly> tools(job.tools.size(), fault->tool);
    const analytic::GougeCheck check(*job.part, tools, options);
    const auto r = check.check({fault->motion}, job.tool_of_operation());
    EXPECT_FALSE(check.passes(r));
    const auto named = std::find_if(r.worst.begin(), r.worst.end(),
                                    [&](const proof::WorstPlace& w) { return to_string(w.body) == body; });
    const auto list = [&] {
      std::string text;
      for (const auto& w : r.worst) text += fmt::format(" {} {:.6f}", w.body, w.depth_mm);
      return text;
    };
    SCOPED_TRACE(
        fmt::format("{} {}: true depth {:.6f} on zone {} patch {} at t {:.3f}; measured {:.6f} bound {:.6f} gap {:.6f} "
                    "proven {:.6f};{}",
                    body, k, fault->truth.depth, fault->truth.zone, test::BruteForceGearSolid::name(fault->truth.patch),
                    fault->truth.t, r.measured_mm, r.bound_mm, r.clearance_measured_mm, r.clearance_mm, list()));
    if (named == r.worst.end()) {
      ADD_FAILURE() << "not reported";
      continue;
    }
    // Where the lean brings another body deeper into the gear, the planted one is judged by its own place.
    const double depth = body == "flute" ? r.measured_mm : named->depth_mm;
    const double bound = body == "flute" ? r.bound_mm : -r.clearance_mm;
    // Where the check names a deeper place than the samples showed, that place is judged: on the gear, and as deep as
    // it says.
    const auto depth_at_named = [&] {
      double best = -INFINITY;
      for (int tooth = -8; tooth <= 8; ++tooth)
        for (int step = 0; step <= 400; ++step) {
          const Vec3 p = turned(named->point, (fault->truth.tooth + tooth) * job.gear.pitch());
          best = std::max(best, test::depth_in_body(p, fault->shape, path::tip_at(fault->motion, step / 400.0),
                                                    path::axis_at(fault->motion, step / 400.0)));
        }
      return best;
    };
    double truth = fault->truth.depth;
    if (depth > truth + 2e-4) {
      EXPECT_LE(solid.nearest(named->point).distance, 2e-5) << named->patch << " r " << named->radius_mm << " z "
                                                            << named->height_mm << ", roof " << job.gear.blank_top();
      truth = depth_at_named();
      ++deeper;
    }
    EXPECT_NEAR(depth, truth, 2e-4);
    EXPECT_GE(bound, fault->truth.depth - 1e-7);
    const Vec3 truth_0 = turned(fault->truth.place, -fault->truth.tooth * job.gear.pitch());
    // Shifted by whole pitches: a place is told in tooth space 0, a land belongs to two of them.
    double away = INFINITY;
    for (int tooth = -1; tooth <= 1; ++tooth)
      away = std::min(away, (turned(named->point, tooth * job.gear.pitch()) - truth_0).norm());
    // Along a line of contact many places are equally deep: then the one that is named must be among them.
    const bool right = away <= 0.1 || depth_at_named() >= truth - 2e-4;
    EXPECT_TRUE(right) << "reported " << named->point.transpose() << " true " << truth_0.transpose();
    found += right;
  }
  EXPECT_EQ(found, planted);
  EXPECT_GE(planted, wanted - 1);
  RecordProperty("planted", planted);
  RecordProperty("found", found);
  RecordProperty("turning", turning);
  RecordProperty("deeper_than_sampled", deeper);
}

INSTANTIATE_TEST_SUITE_P(Jobs, EveryBody,
                         testing::Combine(testing::Values("spur", "conical", "offset", "double"),
                                          testing::Values("flute", "shank", "holder")),
                         [](const auto& c) { return std::string(std::get<0>(c.param)) + "_" + std::get<1>(c.param); });

}  // namespace
}  // namespace toothpath
