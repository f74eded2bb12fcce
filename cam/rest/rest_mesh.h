// The part as a mesh that holds it: turned blank, or what operations have left of it.
//
// A place has the coordinates (s, h, azimuth): s runs along the teeth from the inner to the outer end (radius, or cone
// distance), h up from the roots (z, or height over the pitch cone). Every cell of a grid of s and azimuth is looked at
// in small parts: how deep is each free of material, at its worst place? A corner of the mesh begins as high as the
// highest of the parts of all cells that meet there and is lowered as far as the facets about it stay on or above every
// part; everything below counts as material (docs/exchange.md).
#pragma once

#include <functional>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/mesh/triangle_mesh.h"

namespace toothpath::rest {

/// One ring of teeth.
struct BlankRing {
  double from = 0, to = 0;                ///< s of its ends, mm
  std::function<double(double s)> top;    ///< h of the blank, mm
  std::function<double(double s)> begin;  ///< azimuth where tooth space 0 begins: the middle of a land
  double floor = 0;                       ///< h below which nothing is removed
};

struct Blank {
  int teeth = 0;
  int outward = 1;  ///< +1: s, azimuth, h are right-handed; -1: left-handed
  std::vector<BlankRing> rings;
  /// (s, h) behind each ring, in the order of s: the groove's floor; behind the last ring the underside, back to the
  /// first.
  std::vector<std::vector<Vec2>> corners;
  std::function<Vec3(double s, double h, double azimuth)> place;
};

/// Distance from a place to what was removed in tooth space 0, > 0 outside, negative inside; values above `cap` (>= 0)
/// are returned as `cap`. At most 1 mm a mm.
using Excess = std::function<double(const Vec3& place, double cap)>;

/// Of all of them together; empty of none.
[[nodiscard]] Excess excess_of(std::vector<Excess> removed);

struct RestOptions {
  double cell_mm = 0.3;                  ///< of the grid along the teeth, at most; across them a quarter
  double within_mm = 0;                  ///< what `Excess` may be wrong by, and the tool off its path
  std::size_t most_triangles = 600'000;  ///< of all teeth: coarser cells then
};

struct RestMesh {
  mesh::TriangleMesh mesh;
  double cell_mm = 0;   ///< of its grid along the teeth, at most; across them a quarter
  double thick_mm = 0;  ///< proven: no place of it lies deeper inside what was removed
};

/// What stands of the blank, closed, outward; all teeth. Without `removed` the blank itself. Never smaller than the
/// part but by the sag of 1 um of arcs.
[[nodiscard]] Result<RestMesh> rest_mesh(const Blank& blank, const Excess& removed, const RestOptions& options = {});

}  // namespace toothpath::rest
