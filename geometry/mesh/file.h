// Mesh files: binary STL and VTP are written, STL and OBJ are read. Nothing is repaired on the way in.
#pragma once

#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

#include "geometry/base/result.h"
#include "geometry/mesh/tooth_mesh.h"

namespace toothpath::mesh {

/// What a binary STL holds: facets written, and facets left out because two of their corners are equal in the 32-bit
/// numbers of the format.
struct StlCounts {
  std::size_t facets = 0, collapsed = 0;
};

/// Binary STL of a whole gear, all copies of the pitch, without building the whole mesh. mm; facet normals as computed
/// from the corners; attribute bytes 0. Corners shared by neighbouring copies are written bit for bit equal. `title`:
/// at most 80 bytes, must not begin with "solid". Refused: more than 2^32 - 1 facets; file access: the stream fails.
Result<StlCounts> write_stl(std::ostream& out, const ToothMesh& pitch, std::string_view title);

/// The same for any mesh.
Result<StlCounts> write_stl(std::ostream& out, const TriangleMesh& mesh, std::string_view title);

/// One number a vertex, for the VTP writer.
struct PointField {
  std::string name;  ///< e.g. "deviation_um"
  std::span<const double> values;
};

/// VTK XML PolyData: points and fields as raw 64-bit numbers, triangles. mm. Refused: a field whose length is not the
/// number of vertices; file access: the stream fails.
Status write_vtp(std::ostream& out, const TriangleMesh& mesh, std::span<const PointField> fields);

/// What an imported mesh may be.
struct MeshImportLimits {
  std::size_t most_bytes = std::size_t(1) << 30;  ///< of the file
  std::size_t most_facets = 10'000'000;
  double least_size_mm = 1;     ///< longest side of the bounding box: below it the file is probably in inches or metres
  double most_size_mm = 5000;   ///< above it, in micrometres or off by a scale
  double expected_size_mm = 0;  ///< known longest side, for the hint about the unit; 0: unknown
  double most_coordinate_mm = 1e5;  ///< farther from the origin, 32-bit coordinates are coarser than 8 um
  bool self_intersections = true;   ///< examine with exact predicates
};

/// Reads a closed solid from `path` (.stl binary or ASCII, .obj with triangles), mm, 32-bit coordinates (error up to
/// 3e-5 mm at 500 mm). Corners with equal bits become one vertex. Refused, each with file, facet number from 0, value
/// and limit: damaged or truncated files, more facets than the limit, coordinates that are not finite, degenerate,
/// duplicate, flipped or crossing facets, an open or non-manifold surface, a solid turned inside out, an implausible
/// size. File access: the file is missing, not a regular file, or cannot be read.
[[nodiscard]] Result<TriangleMesh> load_mesh(const std::string& path, const MeshImportLimits& limits = {});

/// The same from bytes in memory. `name` stands in the messages; its ending (.stl, .obj) tells the format.
[[nodiscard]] Result<TriangleMesh> parse_mesh(std::string_view bytes, const std::string& name,
                                              const MeshImportLimits& limits = {});

}  // namespace toothpath::mesh
