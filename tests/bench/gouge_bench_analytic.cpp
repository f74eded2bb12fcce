#include "tests/bench/gouge_bench_analytic.h"

#include <tbb/global_control.h>

#include <cstdio>
#include <random>

#include "cam/analytic/body_tree.h"
#include "cam/analytic/gouge_check.h"
#include "geometry/base/angle.h"
#include "geometry/face_gear/part.h"
#include "geometry/mesh/tooth_mesh.h"
#include "tests/bench/gouge_bench_cgal.h"
#include "tests/bench/thread_seconds.h"
#include "tests/support/sample_gears.h"
#include "tests/support/sample_tools.h"

namespace toothpath::bench {
namespace {

struct Pose {
  Vec3 centre, axis;
};

/// Ball centres 0.1 um off flanks and fillets of any tooth, tool upright or nearly so.
std::vector<Pose> poses_of(const face_gear::FaceGear& gear, const analytic::GearDistance& part,
                           const tool::ToolAssembly& tool) {
  std::mt19937_64 generator(1);
  const auto uniform = [&](double a, double b) { return a + (b - a) * double(generator() >> 11) * 0x1p-53; };
  std::vector<Pose> poses;
  while (poses.size() < 2000) {
    const int zone = int(generator() % 2);
    const auto& cells = part.cells(zone);
    const auto& cell = cells[generator() % cells.size()];
    if (!cell.sheet) continue;
    const auto q = part.space(zone).point(cell.piece, cell.u, cell.v);
    if (!q) continue;
    const double lean = uniform(0, 0.05), to = uniform(0, 6.28), turn = gear.pitch() * double(generator() % 180);
    const Vec3 axis(std::sin(lean) * std::cos(to), std::sin(lean) * std::sin(to), std::cos(lean));
    poses.push_back({turned(Vec3(q->p + (tool.radius_mm() + 1e-4) * q->n), turn), axis});
  }
  return poses;
}

constexpr double kAnalyticWithin = 0.5, kMarch = 1e-3, kBodies = 0.02;

struct Answer {
  double cutter = kAnalyticWithin, gap = kAnalyticWithin;
};

Answer exact(const analytic::GearDistance& part, const analytic::BodyTree& tree, const tool::ToolAssembly& tool,
             const Pose& pose) {
  const double R = tool.radius_mm(), top = tool.flute_length_mm - R;
  Answer a;
  for (double h = 0; h <= top;) {
    const double d = part.nearest(pose.centre + h * pose.axis, R + kAnalyticWithin).distance - R;
    a.cutter = std::min(a.cutter, d);
    if ((pose.centre + h * pose.axis).z() - R > part.part().blank_top()) break;
    h += std::max(d - a.cutter, 0.0) + kMarch;
  }
  for (const auto& body : tool::shank_and_holder(tool))
    a.gap = std::min(a.gap, tree.gap(body, pose.centre - R * pose.axis, pose.axis, a.gap, kBodies));
  return a;
}

Answer marched(const CgalTree& tree, const tool::ToolAssembly& tool, const Pose& pose) {
  const double R = tool.radius_mm();
  Answer a;
  a.cutter = tree.cutting_part(pose.centre, pose.axis, tool.flute_length_mm - R, R, kAnalyticWithin, kMarch);
  for (const auto& body : tool::shank_and_holder(tool))
    a.gap = std::min(a.gap, tree.frustum(body, pose.centre - R * pose.axis, pose.axis, a.gap, kBodies));
  return a;
}

/// Whole assemblies a second as the proof asks them: ball, flute, shank and holder, each pose a motion that stands
/// still.
double proven(const analytic::GearDistance& part, const tool::ToolAssembly& tool, const std::vector<Pose>& poses,
              proof::GougeResult& found) {
  std::vector<path::ToolMotion> motions;
  for (const auto& pose : poses) {
    path::ToolMotion m;
    m.tip_from = m.tip_to = pose.centre - tool.radius_mm() * pose.axis;
    m.axis_from = m.axis_to = pose.axis;
    motions.push_back(m);
  }
  analytic::GougeCheckOptions options;
  options.limits.gouge_mm = 0.002;
  options.limits.proof_mm = 0.0002;
  options.limits.clearance_mm = 0.1;
  const analytic::GougeCheck check(part, {tool}, options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  return double(poses.size()) / thread_seconds([&] { found = check.check(motions, {0}); }, 3);
}

}  // namespace

void analytic_rows() {
  const face_gear::FaceGear gear = test::made(test::quarter_dhfg());
  const tool::ToolAssembly tool = test::ball_mill(0.5, 3.2, 0.46, 14, 10);
  const analytic::GearDistance part(face_gear::part_of(gear), 1.0);
  const analytic::BodyTree bodies(part);
  const auto poses = poses_of(gear, part, tool);
  std::printf(
      "\nanalytic engine of a face gear (180 teeth, two rings; ball R0.25; random poses in contact), the mesh is its "
      "own within the sag\n");
  std::printf("%-28s %9s %8s %12s %12s %8s %11s\n", "question", "triangles", "sag mm", "ours 1/s", "CGAL 1/s", "ratio",
              "largest dif");
  const double balls = double(poses.size()) / thread_seconds(
                                                  [&] {
                                                    for (const auto& p : poses)
                                                      keep(part.nearest(p.centre, tool.radius_mm() + 0.12).distance);
                                                  },
                                                  3);
  const double tools = double(poses.size()) / thread_seconds(
                                                  [&] {
                                                    for (const auto& p : poses) keep(exact(part, bodies, tool, p).gap);
                                                  },
                                                  2);
  proof::GougeResult found;
  const double proofs = proven(part, tool, poses, found);
  for (const double sag : {5e-3, 5e-4}) {
    const auto mesh = mesh::mesh_gear(drawn_solid(gear), sag);
    if (!mesh) continue;
    const CgalTree tree(*mesh);
    double ball_difference = 0, difference = 0;
    const double cgal_balls = double(poses.size()) / thread_seconds(
                                                         [&] {
                                                           for (const auto& p : poses) keep(tree.distance(p.centre));
                                                         },
                                                         2);
    const std::size_t few = 200;
    const double cgal_tools = double(few) / thread_seconds(
                                                [&] {
                                                  for (std::size_t k = 0; k < few; ++k)
                                                    keep(marched(tree, tool, poses[k]).gap);
                                                },
                                                1);
    for (const auto& p : poses)
      ball_difference = std::max(ball_difference, std::abs(tree.distance(p.centre) -
                                                           part.nearest(p.centre, tool.radius_mm() + 0.12).distance));
    for (std::size_t k = 0; k < few; ++k)
      difference = std::max(
          difference, std::abs(marched(tree, tool, poses[k]).cutter - exact(part, bodies, tool, poses[k]).cutter));
    std::printf("%-28s %9zu %8g %12.0f %12.0f %7.1fx %11.2e\n", "ball, analytic", mesh->triangles.size(), sag, balls,
                cgal_balls, balls / cgal_balls, ball_difference);
    std::printf("%-28s %9zu %8g %12.0f %12.0f %7.1fx %11.2e\n", "assembly, analytic", mesh->triangles.size(), sag,
                tools, cgal_tools, tools / cgal_tools, difference);
    std::printf("%-28s %9zu %8g %12.0f %12.0f %7.1fx %11.2e\n", "assembly, as it is proven", mesh->triangles.size(),
                sag, proofs, cgal_tools, proofs / cgal_tools, found.bound_mm - found.measured_mm);
    std::fflush(stdout);
  }
}

}  // namespace toothpath::bench
