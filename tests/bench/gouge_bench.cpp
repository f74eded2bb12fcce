// Gouge queries against CGAL's AABB_tree, as a table of ratios: the mesh engine (whole assembly, ball alone) on a ring
// of teeth of two finenesses, and the analytic engine on a face gear. One thread, its own processor time, the same mesh
// and the same poses on both sides.
//
// Both sides answer the same question: for every body of the tool, its distance to the surface up to 0.5 mm (the
// cutting part: less its radius, so that a cut is negative). We answer exactly; the tree is marched to the resolution
// in the table, and answers from above. "largest difference" is between the two answers: it may reach the resolution.
// "missed": places where the tree finds a cut or a touch and we find none, over the passes and over poses sunk by up to
// 8 mm.
#include <cstdio>
#include <memory>

#include "tests/bench/gouge_bench_analytic.h"
#include "tests/bench/gouge_bench_cgal.h"
#include "tests/bench/gouge_bench_scene.h"
#include "tests/bench/thread_seconds.h"

namespace toothpath::bench {
namespace {

constexpr double kWithin = 0.5;

void heading() {
  std::printf("%-28s %9s %8s %12s %12s %8s %11s %6s %6s\n", "question", "triangles", "march mm", "ours 1/s", "CGAL 1/s",
              "ratio", "largest dif", "hits", "missed");
}

struct Row {
  std::string question;
  std::size_t triangles = 0;
  double resolution = 0, ours = 0, theirs = 0, difference = 0;
  std::size_t hits = 0, missed = 0;
  void print() const {
    std::printf("%-28s %9zu %8g %12.0f %12.0f %7.1fx %11.2e %6zu %6zu\n", question.c_str(), triangles, resolution, ours,
                theirs, ours / theirs, difference, hits, missed);
    std::fflush(stdout);
  }
};

std::vector<double> by_marching(const CgalTree& tree, const tool::ToolAssembly& tool,
                                std::span<const clearance::ToolPose> poses, double resolution) {
  std::vector<double> gaps;
  const double R = tool.radius_mm();
  const auto bodies = tool::shank_and_holder(tool);
  for (const auto& p : poses) {
    gaps.push_back(tree.cutting_part(p.tip + R * p.axis, p.axis, tool.flute_length_mm - R, R, kWithin, resolution));
    for (const auto& body : bodies) gaps.push_back(tree.frustum(body, p.tip, p.axis, kWithin, resolution));
  }
  return gaps;
}

/// Adds what two lists of gaps tell about each other.
void compare(const std::vector<double>& ours, const std::vector<double>& theirs, Row& row) {
  for (std::size_t k = 0; k < ours.size(); ++k) {
    if (!std::isfinite(ours[k])) continue;  // wholly inside: a hit of ours that the tree cannot see
    row.difference = std::max(row.difference, std::abs(ours[k] - theirs[k]));
    const bool hit = theirs[k] < -1e-9 || (theirs[k] <= 0 && k % 4 != 0);
    row.hits += hit;
    row.missed += hit && ours[k] > 0;
  }
}

void assembly(const clearance::MeshDistance& mesh, const CgalTree& tree, bool long_tool, double resolution) {
  const tool::ToolAssembly tool = ball_mill(long_tool);
  const auto poses = flank_passes(35, false), sunk = flank_passes(2, true);
  const std::span<const clearance::ToolPose> theirs(poses.data(), poses.size());
  clearance::MeshAssembly engine(mesh, tool, kWithin);
  const std::size_t n = engine.bodies();
  std::vector<double> gaps(poses.size() * n), marched;
  Row row{long_tool ? "assembly, long" : "assembly, short", mesh.tree().triangles(), resolution};
  row.ours = double(poses.size()) / thread_seconds([&] { engine.gaps(poses, gaps); }, 5);
  // Whole passes, one in five.
  std::vector<clearance::ToolPose> few;
  std::vector<double> few_gaps;
  const std::size_t pass = poses.size() / 35;
  for (std::size_t k = 0; k < poses.size(); ++k)
    if (k / pass % 5 == k / pass / 5 % 5) {
      few.push_back(poses[k]);
      few_gaps.insert(few_gaps.end(), gaps.begin() + std::ptrdiff_t(k * n), gaps.begin() + std::ptrdiff_t((k + 1) * n));
    }
  row.theirs = double(few.size()) / thread_seconds([&] { marched = by_marching(tree, tool, few, resolution); }, 1);
  compare(few_gaps, marched, row);
  std::vector<double> sunk_gaps(sunk.size() * n);
  engine.gaps(sunk, sunk_gaps);
  compare(sunk_gaps, by_marching(tree, tool, sunk, resolution), row);
  row.print();
}

void ball(const clearance::MeshDistance& mesh, const CgalTree& tree) {
  std::vector<Vec3> centres;
  for (const auto& p : flank_passes(35, false)) centres.push_back(p.tip + 2 * p.axis);
  std::vector<double> ours(centres.size()), theirs(centres.size());
  Row row{"ball", mesh.tree().triangles(), 0};
  row.ours = double(centres.size()) / thread_seconds([&] { mesh.nearest_along(centres, 1e3, ours); }, 5);
  row.theirs = double(centres.size()) / thread_seconds(
                                            [&] {
                                              for (std::size_t k = 0; k < centres.size(); ++k)
                                                theirs[k] = tree.distance(centres[k]);
                                            },
                                            2);
  for (std::size_t k = 0; k < ours.size(); ++k) {
    row.difference = std::max(row.difference, std::abs(ours[k] - theirs[k]));
    row.hits += theirs[k] < 2 - 1e-9;
    row.missed += theirs[k] < 2 - 1e-9 && ours[k] >= 2;
  }
  row.print();
}

void run() {
  std::printf("inner loops: %s; one thread; gaps up to %g mm; poses 0.1 mm apart on flank passes, ball R2\n",
              clearance::mesh_kernels().name, kWithin);
  heading();
  for (const auto& [across, along] : {std::pair{24, 34}, std::pair{54, 77}}) {
    const mesh::TriangleMesh mesh = ring_mesh(across, along);
    const clearance::MeshDistance distance(mesh);
    const CgalTree tree(mesh);
    ball(distance, tree);
    for (const bool long_tool : {true, false}) {
      assembly(distance, tree, long_tool, 1e-2);
      assembly(distance, tree, long_tool, 1e-3);
    }
  }
  analytic_rows();
}

}  // namespace
}  // namespace toothpath::bench

int main() {
  toothpath::bench::run();
  return 0;
}
