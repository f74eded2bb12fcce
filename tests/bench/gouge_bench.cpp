// Gouge queries per second against CGAL's AABB_tree: the whole assembly (ball, flute, shank, holder) at one pose, where the
// tree can only be marched along the bodies, and the ball alone, where it is asked for the closest point. One core, same
// poses; the mesh is the whole ring of the same gear. `deviation_mm` is the largest difference between the two answers.
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <random>

#include "cam/tool_body.h"
#include "geometry/base/angle.h"
#include "geometry/tooth_mesh.h"

namespace {

using namespace toothpath;
using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

FaceGear quarter_dhfg() {
  FaceGearParameters g;
  g.teeth = 180;
  g.shaper_teeth = 30;
  g.module_mm = 1.25;
  g.module_plane = ModulePlane::transverse;
  g.pressure_angle_rad = radians(20);
  g.reference_radius_mm = 118;
  g.shaper_tip_radius_mm = 0.375;
  g.groove_depth_mm = 3.125;
  g.zones = {{radians(-30), 112.25, 117}, {radians(30), 119, 124}};
  return std::get<FaceGear>(FaceGear::make(g));
}

ToolAssembly mill() {
  ToolAssembly t;
  t.diameter_mm = 0.5;
  t.flute_length_mm = 3.2;
  t.shank_diameter_mm = 0.46;
  t.length_mm = 88;
  t.holder = {{10, 10, 30}, {32, 32, 30}};
  t.stick_out_mm = 14;
  return t;
}

/// A pose: ball centre in contact with a flank or fillet of some tooth, tool upright or nearly so.
struct Pose {
  Vec3 centre, axis;
};

struct Scene {
  FaceGear gear = quarter_dhfg();
  ToolAssembly tool = mill();
  GearDistance part{gear, 1.0};
  std::vector<Pose> poses;
  std::map<double, std::pair<std::unique_ptr<Triangles>, std::unique_ptr<Tree>>> trees;
  double sag = 0;

  Scene() {
    std::mt19937_64 generator(1);
    const auto uniform = [&](double a, double b) { return a + (b - a) * double(generator() >> 11) * 0x1p-53; };
    while (poses.size() < 2000) {
      const int zone = int(generator() % 2);
      const auto& cells = part.cells(zone);
      const auto& cell = cells[generator() % cells.size()];
      if (!cell.sheet) continue;
      const auto q = part.space(zone).point(cell.piece, cell.u, cell.v);
      if (!q) continue;
      const double lean = uniform(0, 0.05), to = uniform(0, 6.28), turn = gear.pitch() * double(generator() % 180);
      const Vec3 axis(std::sin(lean) * std::cos(to), std::sin(lean) * std::sin(to), std::cos(lean));
      poses.push_back({FaceGearSurface<double>::turned(Vec3(q->p + (tool.radius_mm() + 1e-4) * q->n), turn), axis});
    }
  }
  const Tree& tree(double tolerance) {
    auto& slot = trees[tolerance];
    if (!slot.second) {
      const auto mesh = *mesh_gear(gear, tolerance);
      slot.first = std::make_unique<Triangles>();
      const auto p = [&](const Vec3& v) { return Kernel::Point_3(v.x(), v.y(), v.z()); };
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        slot.first->push_back(Kernel::Triangle_3(p(mesh.corner(t, 0)), p(mesh.corner(t, 1)), p(mesh.corner(t, 2))));
      slot.second = std::make_unique<Tree>(slot.first->begin(), slot.first->end());
      slot.second->build();
      slot.second->accelerate_distance_queries();
    }
    return *slot.second;
  }
};
Scene& scene() {
  static Scene s;
  return s;
}

double tree_distance(const Tree& tree, const Vec3& c) { return std::sqrt(tree.squared_distance(Kernel::Point_3(c.x(), c.y(), c.z()))); }

/// What both sides answer: how deep the cutting part lies, and the gap of shank and holder (no more than 0.5 mm is asked for).
struct Answer {
  double depth = -INFINITY, gap = 0.5;
};

/// Marches a segment of the axis: the least distance to it, to 1e-3 mm, by steps as long as the distance allows.
double march(const Tree& tree, const Vec3& a, const Vec3& axis, double length, double radius, double enough) {
  double best = INFINITY;
  for (double h = 0; h <= length;) {
    const double d = tree_distance(tree, a + h * axis);
    best = std::min(best, d - radius);
    h += std::max(1e-3, d - radius - std::min(best, enough) + 1e-3);
    if (h > length && h < length + 1e-3) h = length;
  }
  return best;
}

Answer by_marching(const Tree& tree, const ToolAssembly& tool, const Pose& pose) {
  const double R = tool.radius_mm();
  Answer a;
  a.depth = -march(tree, pose.centre, pose.axis, tool.flute_length_mm - R, R, 0.0);
  for (const auto& body : shank_and_holder(tool))  // as capsules: what a distance query can march
    a.gap = std::min(a.gap, march(tree, pose.centre + (body.from - R) * pose.axis, pose.axis, body.to - body.from, body.radius_from, a.gap));
  return a;
}

Answer exact(const GearDistance& part, const ToolAssembly& tool, const Pose& pose) {
  const double R = tool.radius_mm();
  Answer a;
  const Vec3 tip = pose.centre - R * pose.axis;
  const double top = tool.flute_length_mm - R, proof = 1e-3;
  for (double h = 0; h <= top;) {
    const double d = part.nearest(pose.centre + h * pose.axis, R + 0.5).distance;
    a.depth = std::max(a.depth, R - d);
    if ((pose.centre + h * pose.axis).z() - R > part.gear().blank_top()) break;
    h += std::max(proof, d - R + a.depth + proof);
  }
  for (const auto& body : shank_and_holder(tool)) a.gap = std::min(a.gap, body_gap(part, body, tip, pose.axis, a.gap, 0.02).gap);
  return a;
}

void assembly_exact(benchmark::State& state) {
  auto& s = scene();
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(exact(s.part, s.tool, s.poses[k++ % s.poses.size()]));
  state.counters["poses/s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(assembly_exact);

void assembly_cgal(benchmark::State& state) {
  auto& s = scene();
  const auto& tree = s.tree(double(state.range(0)) * 1e-4);
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(by_marching(tree, s.tool, s.poses[k++ % s.poses.size()]));
  double deviation = 0;
  for (std::size_t n = 0; n < 40; ++n)
    deviation = std::max(deviation, std::abs(exact(s.part, s.tool, s.poses[n]).depth - by_marching(tree, s.tool, s.poses[n]).depth));
  state.counters["poses/s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["triangles"] = double(tree.size());
  state.counters["deviation_mm"] = deviation;
}
BENCHMARK(assembly_cgal)->Arg(50)->Arg(5)->Unit(benchmark::kMicrosecond);

void ball_exact(benchmark::State& state) {
  auto& s = scene();
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(s.part.nearest(s.poses[k++ % s.poses.size()].centre, s.tool.radius_mm() + 0.12));
  state.counters["balls/s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(ball_exact);

void ball_cgal(benchmark::State& state) {
  auto& s = scene();
  const auto& tree = s.tree(double(state.range(0)) * 1e-4);
  std::size_t k = 0;
  for (auto _ : state) {
    const auto& c = s.poses[k++ % s.poses.size()].centre;
    benchmark::DoNotOptimize(tree.closest_point(Kernel::Point_3(c.x(), c.y(), c.z())));
  }
  double deviation = 0;
  for (const auto& pose : s.poses)
    deviation = std::max(deviation, std::abs(tree_distance(tree, pose.centre) - s.part.nearest(pose.centre, s.tool.radius_mm() + 0.12).distance));
  state.counters["balls/s"] = benchmark::Counter(double(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["triangles"] = double(tree.size());
  state.counters["deviation_mm"] = deviation;
}
BENCHMARK(ball_cgal)->Arg(50)->Arg(5);

}  // namespace

BENCHMARK_MAIN();
