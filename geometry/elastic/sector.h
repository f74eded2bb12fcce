// One pitch of a toothed body as bricks: a tooth, half a tooth space on either side of it, and the rim below.
//
// A body is a row of such sectors, each the last one turned about the axis by one pitch, so that what holds for one of
// them is computed once. Sections stand one behind the other along the face; a section lies in coordinates (angle,
// height) that a map brings into space: azimuth and z of a face gear at constant radius, angle and radius of a pinion
// at constant section. mm, rad.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "geometry/base/result.h"
#include "geometry/elastic/brick.h"

namespace toothpath::elastic {

/// How many bricks, and how the rim is held.
struct SectorPlan {
  int across = 4;  ///< bricks between the flanks
  int flank = 6;   ///< from the tip to the end of the flank
  int fillet = 3;  ///< along the fillet
  int land = 1;    ///< of the root, on either side
  int rim = 3;     ///< layers below the root
  int face = 8;    ///< along the tooth
  double rim_mm = 25;
  double grading = 1;  ///< > 1: bricks across become thinner towards the loaded flank, as powers of their number
};

/// One section, its boundary listed from the tip down to the foot at every node: 2 (flank + fillet) + 1 places.
struct ToothSection {
  std::vector<Vec2> low, high;           ///< flank of the smaller angle, of the larger: (angle, height)
  double angle_low = 0, angle_high = 0;  ///< middles of the tooth spaces
  double root = 0;                       ///< height of the root surface there
};

/// Faces of the loaded flank between four stations.
struct StationFace {
  std::array<int, kFaceNodes> nodes{};
  std::array<int, 4> stations{};
};

struct Sector {
  std::vector<Vec3> nodes;
  std::vector<std::array<int, 3>> lattice;  ///< of a node: doubled counts of bricks across, up and along the face
  std::vector<std::array<int, kBrickNodes>> bricks;
  std::vector<int> low_cut, high_cut;  ///< nodes in the middles of the spaces; high_cut[n] is low_cut[n] a pitch on
  int foot = 0;                        ///< lattice count up to which the rim reaches
  std::vector<int> held;               ///< back of the rim
  Mat3 pitch = Mat3::Identity();       ///< turn onto the next sector
  int columns = 0, rows = 0;           ///< of stations: along the face; from the tip down to the end of the flank
  std::vector<int> stations;           ///< nodes, row * columns + column
  std::vector<Vec3> normals;           ///< at the stations, out of the material
  std::vector<int> face_bricks;        ///< brick of each of `faces`
  int flank_face = 0;                  ///< side of those bricks that is the flank: +1 or -1 across
  std::vector<StationFace> faces;      ///< (rows - 1) x (columns - 1), row-major; corners run so that `area` points out
  double least_jacobian = 0;           ///< mm^3
};

/// Places a point of section `station` (0 to 2 face) in space.
using SectionMap = std::function<Vec3(int station, const Vec2& at)>;

/// @param sections     2 face + 1 of them
/// @param load_high    the loaded flank is that of the larger angle
/// @param pitch        angle of a pitch about `axis`, through the origin
/// Refused: bricks that fold.
[[nodiscard]] Result<Sector> make_sector(const SectorPlan& plan, const std::vector<ToothSection>& sections,
                                         bool load_high, double pitch, const Vec3& axis, const SectionMap& map);

/// A row of sectors side by side as one mesh, for other solvers and tests.
struct SectorRow {
  std::vector<Vec3> nodes;
  std::vector<std::array<int, kBrickNodes>> bricks;
  std::vector<int> held;                  ///< back of the rim and both outer cuts
  std::vector<std::vector<int>> node_of;  ///< of a sector, of its node
};
[[nodiscard]] SectorRow sector_row(const Sector& sector, int teeth);

}  // namespace toothpath::elastic
