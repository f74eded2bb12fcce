// Triangles of a finished face gear: one angular pitch, structured, every facet tied to its exact surface.
//
// The pitch runs from the middle of the top land of tooth 0 to the middle of the top land of tooth 1 and holds space 0:
//
//        tip | flank_plus \ fillet_plus | root | fillet_minus / flank_minus | tip        (seen along a circle r =
//        const)
//
// flank_plus is side +1 of tooth 0, flank_minus side -1 of tooth 1 (tooth 0 turned by one pitch). Every row of vertices
// lies on one cylinder r = const, so the end faces at the inner and outer radius of a ring are exact in r. Below:
// groove floor between the rings, inner and outer cylinder and a flat underside 2.5 modules below the lowest point of
// the teeth and the groove (`underside_z`). Gear frame, mm.
#pragma once

#include <optional>

#include "geometry/face_gear/gear.h"
#include "geometry/mesh/triangle_mesh.h"
#include "geometry/tooth_space/piece.h"

namespace toothpath::mesh {

using tooth_space::Piece;

/// What a triangle is part of, and where its corners lie on that surface: (theta, B) of flanks, (A, Z) of fillets,
/// (fraction of its width from the +1 edge, Z) of the root land, (azimuth, r) of tip surface and groove floor,
/// (azimuth, z) of end faces, (azimuth, z or r) of the underside and the cylinders below the teeth.
struct TriangleTag {
  Piece patch = Piece::body;
  std::uint8_t zone = 0;  ///< ring, from the inside; the groove floor counts to the ring inside it
  std::array<Vec2, 3> uv{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};  ///< in the order of the corners
};

/// One angular pitch. Open along the two borders in the middle of the top lands, where the next pitch joins.
struct ToothMesh {
  TriangleMesh mesh;
  std::vector<TriangleTag> tags;  ///< one a triangle
  std::vector<std::int32_t>
      turned_from;          ///< one a vertex: the vertex of which it is the copy turned by one pitch; -1: none
  int teeth = 0;            ///< N_2
  double tolerance_mm = 0;  ///< as asked
  /// Largest distance between the facets of a patch and its exact surface: measured on a dense sample, with a margin
  /// of 15 %. Index with static_cast<std::size_t>(Piece).
  std::array<double, tooth_space::kSurfaces> max_sag_mm{};

  [[nodiscard]] double max_sag() const;
  /// Vertex `index` of copy k (the pitch that holds space k). Vertices shared by neighbouring copies, also by the last
  /// and the first, come out bit for bit equal.
  [[nodiscard]] Vec3 vertex_of_copy(std::size_t index, int k) const;
};

/// Height z of the underside that bodies of ours have, mm: how thick a gear is below its teeth no job says.
[[nodiscard]] double underside_z(const face_gear::FaceGear& gear);

/// p turned by k pitches of a gear with `teeth` teeth. k is reduced modulo `teeth` first: a full turn is the identity.
[[nodiscard]] Vec3 turned_by_pitches(const Vec3& p, int k, int teeth);

/// The pitch of space 0, for collision checks. `tolerance_mm`: largest sag of a facet, 1e-4 .. 10 mm.
/// Refused: a tolerance outside that range, more than 1 million triangles in the pitch, a groove floor above the root,
/// a place where the flank does not reach the tip surface or the fillet (undercut, pointed).
[[nodiscard]] Result<ToothMesh> mesh_tooth_space(const face_gear::FaceGear& gear, double tolerance_mm);

/// The whole gear, closed: all N_2 copies of the pitch joined at their borders. With n triangles in the pitch, triangle
/// k n + t is triangle t of copy k. Refused: as above, or more than 40 million triangles.
[[nodiscard]] Result<TriangleMesh> mesh_gear(const face_gear::FaceGear& gear, double tolerance_mm = 0.01);

/// All N_2 copies of a pitch, closed; vertices shared by neighbours appear once.
[[nodiscard]] TriangleMesh join_copies(const ToothMesh& pitch);

/// Exact point and normal of a flank, fillet, root or tip patch of space 0 at patch coordinates (u, v); nothing for the
/// other patches and where the fillet is not defined.
[[nodiscard]] std::optional<face_gear::SurfacePointT<double>> exact_patch_point(const face_gear::FaceGear& gear,
                                                                                int zone, Piece patch, const Vec2& uv);

}  // namespace toothpath::mesh
