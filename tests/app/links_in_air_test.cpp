// Moves under feed that are faster than the job's cut run through air: brute force on the stock that stands when they
// are made. Points all over the cutting part, along every such move, are above the blank, beside its rings, or where an
// earlier move has been.
#include <gtest/gtest.h>

#include "app/job/file.h"
#include "app/process/gear_of_job.h"
#include "app/process/proof_limits.h"
#include "cam/analytic/gouge_check.h"
#include "cam/cut/swept_tool.h"
#include "cam/plan/milling.h"
#include "cam/tool/cutters.h"
#include "geometry/face_gear/part.h"

namespace toothpath {
namespace {

constexpr double kFast = 1.3;    // times the job's feed: the tip may be that much faster than the contact
constexpr double kStep = 0.1;    // mm along a move
constexpr double kTouch = 0.02;  // mm of stock that may be brushed: no chip that bends a tool

struct Stock {
  const face_gear::FaceGear& gear;
  std::vector<std::unique_ptr<cut::Removed>> removed;  // by the operations before

  [[nodiscard]] bool in_blank(const Vec3& p) const {
    const double r = std::hypot(p.x(), p.y());
    if (p.z() > gear.blank_top()) return false;
    for (const auto& zone : gear.parameters().zones)
      if (r > zone.inner_radius_mm && r < zone.outer_radius_mm) return true;
    return false;
  }
  [[nodiscard]] double standing(const Vec3& p, double cap) const {
    double least = cap;
    for (const auto& r : removed) least = std::min(least, r->excess(p, least));
    return least;
  }
};

/// Points of the cutting part in the frame of its tip, axis z.
std::vector<Vec3> points_of(const tool::Profile& mill) {
  std::vector<Vec3> out{Vec3::Zero()};
  const double to = mill.cutting().to();
  for (double h = 0.02 * to; h <= to; h += 0.02 * to)
    for (int k = 0; k < 12; ++k) {
      const double r = mill.cutting().radius(h), a = k * M_PI / 6;
      out.emplace_back(r * std::cos(a), r * std::sin(a), h);
    }
  return out;
}

struct Worst {
  double depth = 0;
  std::size_t record = 0, fast = 0;
  Vec3 at = Vec3::Zero();
};

Worst worst_of(const path::ClPath& path, const path::MillingOperation& op, const tool::ToolAssembly& tool,
               const Stock& stock) {
  Worst out;
  const auto motions = analytic::GougeCheck::motions_of(path);
  const auto cutting = tool::proof_tool(tool).cutting;
  const auto points = points_of(tool::profile_of(tool));
  for (std::size_t k = 1; k < path.records.size(); ++k) {
    const auto& to = path.records[k];
    if (to.kind == path::MoveKind::rapid || to.feed_mm_min <= kFast * op.feed_mm_min) continue;
    ++out.fast;
    const auto& m = motions[k - 1];
    const int steps = int(std::ceil((m.tip_to - m.tip_from).norm() / kStep));
    for (int step = 0; step <= steps; ++step) {
      const double t = double(step) / std::max(steps, 1);
      const Vec3 axis = path::axis_at(m, t), tip = path::tip_at(m, t);
      const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), axis);
      for (const Vec3& q : points) {
        const Vec3 p = tip + turn * q;
        if (!stock.in_blank(p)) continue;
        double stands = stock.standing(p, 1.0);
        for (std::size_t i = k - 1; i-- > 0 && stands > out.depth;)
          if (!motions[i].rapid)
            for (const auto& body : cutting)
              stands = std::min(stands, cut::least_distance(p, body, motions[i], stands));
        if (stands > out.depth) out.depth = stands, out.record = k, out.at = p;
      }
    }
  }
  return out;
}

/// `operations`: those of the job that are kept; empty: all of them.
void expect_links_in_air(const std::string& file, const std::vector<std::size_t>& operations = {}) {
  auto read = job::read_job_file(std::string(TOOTHPATH_SOURCE_DIR) + file);
  ASSERT_FALSE(read.refused()) << read.refused()->front().text();
  job::Job job = std::move(read).value();
  if (!operations.empty()) {
    std::vector<path::MillingOperation> kept;
    for (const std::size_t n : operations) kept.push_back(job.operations.at(n));
    job.operations = kept;
  }
  auto made = process::make_face_gear(job);
  ASSERT_FALSE(made.refused());
  const analytic::GearDistance part(face_gear::part_of(made.value()), ball::reach_of(job.tools));
  plan::Options options;
  options.limits = process::proof_limits(job, 1);
  options.link_feed_mm_min = 6000;
  const auto plan = plan::plan_milling(part, job.tools, job.operations, options);
  ASSERT_TRUE(plan.has_value()) << plan.refused()->diagnostic.message;
  Stock stock{made.value(), {}};
  std::size_t fast = 0;
  for (std::size_t n = 0; n < job.operations.size(); ++n) {
    const auto& op = job.operations[n];
    const auto& tool = job.tools[std::size_t(op.tool)];
    const Worst worst = worst_of(plan.value().paths[n], op, tool, stock);
    EXPECT_LE(worst.depth, kTouch) << "operation " << n << " (" << to_string(op.type) << "), record " << worst.record
                                   << " of " << plan.value().paths[n].records.size() << " at " << worst.at.transpose();
    fast += worst.fast;
    stock.removed.push_back(std::make_unique<cut::Removed>(analytic::GougeCheck::motions_of(plan.value().paths[n]),
                                                           tool::proof_tool(tool), made.value().blank_top()));
  }
  EXPECT_GT(fast, 50u);
}

TEST(Links, RunThroughAirOnTheLineMilledSample) { expect_links_in_air("/samples/dhfg_t600s.toml"); }
TEST(Links, RunThroughAirOnTheBallMilledSample) { expect_links_in_air("/samples/dhfg_ball.toml"); }
TEST(Links, AreSlowWhereALargerBallStayedAbove) { expect_links_in_air("/samples/dhfg_ball.toml", {0, 3}); }
TEST(Links, RunThroughAirAfterRoughingAlone) { expect_links_in_air("/samples/dhfg_ball.toml", {1, 3}); }
TEST(Links, RunThroughAirOnASpurGear) { expect_links_in_air("/samples/spur_quick.toml"); }
TEST(Links, RunThroughAirOnALineMilledSpurGear) { expect_links_in_air("/samples/spur_line.toml"); }
TEST(Links, RunThroughAirOnAnOffsetGear) { expect_links_in_air("/samples/offset_milled.toml"); }

}  // namespace
}  // namespace toothpath
