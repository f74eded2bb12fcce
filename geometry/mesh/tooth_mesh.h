// Triangles of a finished gear: one angular pitch, structured, every facet tied to its exact surface.
//
// The pitch runs from the middle of the top land of tooth 0 to the middle of the top land of tooth 1 and holds space 0:
//
//        tip | flank_plus \ fillet_plus | root | fillet_minus / flank_minus | tip        (seen along s = const)
//
// flank_plus is side +1 of tooth 0, flank_minus side -1 of tooth 1 (tooth 0 turned by one pitch). Every row of vertices
// lies at one station s = const, so the end faces of a ring are exact in s: cylinders, planes or cones. Below: groove
// floor between the rings, and the body. Gear frame, mm.
#pragma once

#include <optional>

#include "geometry/base/result.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/tooth_space/piece.h"
#include "geometry/tooth_space/toothed_solid.h"

namespace toothpath::mesh {

using tooth_space::Piece;
using tooth_space::ToothedSolid;

/// What a triangle is part of, and where its corners lie on that surface: parameters of the piece, (azimuth, s) of the
/// tip surface, (azimuth, z or r) of what is turned: r where the surface is nearer to a plane than to a cylinder.
struct TriangleTag {
  Piece patch = Piece::body;
  std::uint8_t zone = 0;  ///< ring, in the order of the solid; the groove floor counts to the ring before it
  std::array<Vec2, 3> uv{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};  ///< in the order of the corners
};

/// One angular pitch. Open along the two borders in the middle of the top lands, where the next pitch joins.
struct ToothMesh {
  TriangleMesh mesh;
  std::vector<TriangleTag> tags;          ///< one a triangle
  std::vector<std::int32_t> turned_from;  ///< one a vertex: the vertex of which it is the copy turned by one pitch; -1:
                                          ///< none; itself: it stands on the axis
  int teeth = 0;
  double tolerance_mm = 0;  ///< as asked
  /// Largest distance between the facets of a patch and its exact surface: measured on a dense sample, with a margin
  /// of 15 %. Index with static_cast<std::size_t>(Piece).
  std::array<double, tooth_space::kSurfaces> max_sag_mm{};

  [[nodiscard]] double max_sag() const;
  /// Vertex `index` of copy k (the pitch that holds space k). Vertices shared by neighbouring copies, also by the last
  /// and the first, come out bit for bit equal.
  [[nodiscard]] Vec3 vertex_of_copy(std::size_t index, int k) const;
};

/// p turned by k pitches of a gear with `teeth` teeth. k is reduced modulo `teeth` first: a full turn is the identity.
[[nodiscard]] Vec3 turned_by_pitches(const Vec3& p, int k, int teeth);

/// The pitch of space 0, for collision checks. `tolerance_mm`: largest sag of a facet, 1e-4 .. 10 mm.
/// Refused: a tolerance outside that range, more than 1 million triangles in the pitch, a groove floor above the root,
/// a place where the flank does not reach the tip surface or the fillet (undercut, pointed).
[[nodiscard]] Result<ToothMesh> mesh_tooth_space(const ToothedSolid& gear, double tolerance_mm);

/// The whole gear, closed: all copies of the pitch joined at their borders. With n triangles in the pitch, triangle
/// k n + t is triangle t of copy k. Refused: as above, or more than 40 million triangles.
[[nodiscard]] Result<TriangleMesh> mesh_gear(const ToothedSolid& gear, double tolerance_mm = 0.01);

/// All copies of a pitch, closed; vertices shared by neighbours appear once.
[[nodiscard]] TriangleMesh join_copies(const ToothMesh& pitch);

/// Number of the patch that the first triangle at each vertex belongs to.
[[nodiscard]] std::vector<double> patch_of_vertices(const ToothMesh& pitch);

/// Exact place and normal of a flank, fillet, root or tip patch of space 0 at patch coordinates (u, v); derivatives may
/// be unset. Nothing for the other patches and where a piece is not defined. @param ring in the order of the solid
[[nodiscard]] std::optional<tooth_space::PatchPoint> exact_patch_point(const ToothedSolid& gear, int ring, Piece patch,
                                                                       const Vec2& uv);

}  // namespace toothpath::mesh
