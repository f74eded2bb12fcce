// Measured points put on the flanks they belong to, of a gear whose teeth stand anywhere about the axis.
#pragma once

#include <vector>

#include "app/fit/numbers.h"
#include "app/job/loose_points.h"
#include "geometry/base/angle.h"

namespace toothpath::fit {

/// How the measured part stands in the frame of the gear: turned about its axis, and moved along it.
struct Pose {
  double turn_rad = 0, shift_mm = 0;
  /// A place of the part as space 0 of the gear sees it.
  [[nodiscard]] Vec3 in_space(const Vec3& p, double azimuth_of_space) const {
    return turned(Vec3(p.x(), p.y(), p.z() - shift_mm), -turn_rad - azimuth_of_space);
  }
};

/// A point on the flank of one tooth space.
struct PlacedPoint {
  std::size_t point = 0;  ///< of the file
  int zone = 0, side = 1, space = 0;
  double u = 0, v = 0;  ///< on the flank at its own (s, h): where the search for its foot begins
};

struct Placing {
  std::vector<PlacedPoint> points;
  std::size_t below_flanks = 0;  ///< points left out: they lie beyond where their flank ends towards the fillet,
  std::size_t beside = 0;        ///< or where the gear has no flank
  double turn_rad = 0;           ///< about which the points lie nearest to the flanks
};

/// @param pose  where the part stands, as far as that is known;  @param turns  its turn is not: it is found
[[nodiscard]] Placing placed_on(const Spaces& spaces, const job::LoosePoints& points, const Pose& pose, bool turns);

}  // namespace toothpath::fit
