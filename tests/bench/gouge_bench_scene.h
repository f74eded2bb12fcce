// What the gouge bench works on: a closed ring of teeth of any fineness, flank passes of a ball mill, two stick-outs.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "cam/clearance/assembly_gaps.h"

namespace toothpath::bench {

inline constexpr double kInner = 250, kOuter = 300, kDepth = 7, kPi2 = 6.283185307179586;
inline constexpr int kTeeth = 120;

/// Point of the working surface: u in [0, 1) runs over one pitch from the middle of a tooth's tip, r is the radius.
/// Flanks of about 20 deg that grow flatter outwards and bulge a little, round roots. The middle of the space is at u =
/// 0.5.
inline Vec3 ring_point(double u, double r, int tooth) {
  const double side = u < 0.5 ? -1 : 1, x = std::abs(u - 0.5) * 2;  // 0 middle of the space, 1 middle of the tip
  const double root = 0.33, tip = 0.72;
  double z = 0, w = x;  // w: share of half the pitch
  if (x < root) z = -kDepth - 0.4 * (1 - (x / root) * (x / root));
  else if (x < tip) z = -kDepth * (1 - (x - root) / (tip - root));
  const double lean = std::tan(0.35 + 0.07 * (r - 275) / 25), t = -z / kDepth;
  const double half = kPi2 * r / kTeeth / 2;
  if (x < tip) {
    const double foot = 2.5, top = foot + kDepth * lean;  // half widths of the space
    w = x < root ? x / root * foot / half : (top - std::min(t, 1.0) * (top - foot) - 0.15 * t * (1 - t)) / half;
  } else {
    const double top = (2.5 + kDepth * lean) / half;
    w = top + (1 - top) * (x - tip) / (1 - tip);
  }
  const double angle = (tooth + 0.5 + side * w / 2) * kPi2 / kTeeth;
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// The closed ring: `across` facets over a pitch, `along` over the width; the underside is a flat ring 12 mm below the
/// roots.
inline mesh::TriangleMesh ring_mesh(int across, int along) {
  mesh::TriangleMesh mesh;
  const int n = kTeeth * across;
  const auto at = [&](int i, int k) { return std::int32_t(i * n + (k % n)); };
  for (int i = 0; i <= along; ++i)
    for (int k = 0; k < n; ++k)
      mesh.vertices.push_back(
          ring_point(double(k % across) / across, kInner + (kOuter - kInner) * i / along, k / across));
  for (const double r : {kOuter, kInner})
    for (int k = 0; k < n; ++k) {
      Vec3 p = ring_point(double(k % across) / across, r, k / across);
      p.z() = -kDepth - 12;
      mesh.vertices.push_back(p);
    }
  for (int i = 0; i < along + 3; ++i) {
    const int next = i == along + 2 ? 0 : i + 1;
    for (int k = 0; k < n; ++k) {
      mesh.triangles.push_back({at(i, k), at(next, k), at(next, k + 1)});
      mesh.triangles.push_back({at(i, k), at(next, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

inline tool::ToolAssembly ball_mill(bool long_tool) {
  tool::ToolAssembly t;
  t.diameter_mm = 4;
  t.flute_length_mm = 8;
  t.shank_diameter_mm = 3.8;
  t.length_mm = 100;
  t.stick_out_mm = long_tool ? 25 : 10;
  t.holder = long_tool ? std::vector<tool::HolderSegment>{{10, 40, 8}, {40, 40, 40}}
                       : std::vector<tool::HolderSegment>{{8, 24, 6}, {24, 24, 30}};
  return t;
}

/// Flank passes, poses 0.1 mm apart along the width; the ball's gap to the surface differs from pass to pass, some cut.
/// `planted`: each pose is sunk along the axis by up to 8 mm, so that every body strikes somewhere.
inline std::vector<clearance::ToolPose> flank_passes(int passes, bool planted) {
  std::mt19937_64 generator(7);
  const auto uniform = [&](double a, double b) { return a + (b - a) * double(generator() >> 11) * 0x1p-53; };
  const double R = 2, gaps[] = {0, 0.05, -0.003, 0.3, 0.0005};
  std::vector<clearance::ToolPose> poses;
  for (int pass = 0; pass < passes; ++pass) {
    const int tooth = int(generator() % kTeeth);
    const double u = 0.5 + (pass % 2 ? 0.5 : -0.5) * (0.36 + 0.34 * (pass % 7) / 6.0), gap = gaps[pass % 5],
                 lean = uniform(0, 0.06);
    for (double r = kInner + 1; r < kOuter - 1; r += 0.1) {
      const double e = 1e-4;
      const Vec3 p = ring_point(u, r, tooth);
      Vec3 n = (ring_point(u, r + e, tooth) - p).cross(ring_point(u + e, r, tooth) - p).normalized();
      if (n.z() < 0) n = -n;
      const double angle = std::atan2(p.y(), p.x()), way = lean + 0.02 * std::sin((r - kInner) / 20);
      const Vec3 axis = Vec3(way * std::cos(angle + 0.3), way * std::sin(angle + 0.3), 1).normalized();
      const double sink = planted ? std::pow(10.0, uniform(-3, 0.9)) : 0;
      poses.push_back({p + (R + gap) * n - (R + sink) * axis, axis});
    }
  }
  return poses;
}

}  // namespace toothpath::bench
